"""Joints by a frame on each part: the same mechanism wherever the axes of its parts are, open ones closed."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from reference.mechanisms import planar_fourbar

BARS = {"A": ("ground", "crank"), "B": ("crank", "coupler"), "C": ("coupler", "rocker"), "D": ("ground", "rocker")}


def rigid(rng) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    return pose


def turned(angle, z=0.0) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3], pose[2, 3] = Rotation.from_euler("z", angle).as_matrix(), z
    return pose


def on_frames(seed):
    """The four-bar of the closed forms, its parts with axes at random, each frame turned about its hinge at random."""
    rng = np.random.default_rng(seed)
    whole = planar_fourbar()
    places = {part: rigid(rng) for part in whole.parts}
    joints = []
    for name, parts in BARS.items():
        at = np.asarray(whole.joints[name].frames_1)[0]
        frames = [np.linalg.inv(places[part]) @ at @ turned(rng.uniform(-3, 3)) for part in parts]
        joints.append(
            jk.joint_on_frames(name, *parts, kind="revolute", frame1=frames[0], frame2=frames[1], places=places)
        )
    return whole, jk.Mechanism.build(fixed=["ground"], joints=joints), places


@pytest.mark.long
def test_axes_of_parts_do_not_matter():
    whole, mechanism, places = on_frames(3)
    angles = np.linspace(0, 2 * np.pi, 13)
    motion, expected = (each.sweep({"A": angles}, throw=True) for each in (mechanism, whole))
    for name in BARS:  # of lengths of 100, with rounding of two products of poses
        np.testing.assert_allclose(motion.coordinates[name], expected.coordinates[name], atol=1e-11)
    poses = motion.poses(places)
    relative = motion.poses(places, relative_to="crank")
    for part, place in places.items():
        np.testing.assert_allclose(poses[part], expected.transforms[part] @ place, atol=1e-9)
        np.testing.assert_allclose(relative[part], np.linalg.inv(poses["crank"]) @ poses[part], atol=1e-9)


def test_limits_count_from_where_the_frames_agree():
    made = jk.joint_on_frames(
        "A", "a", "b", kind="cylindrical", frame1=np.eye(4), frame2=turned(0.3, z=2.0), limits={"phi": (-1, 1)}
    )
    np.testing.assert_allclose(made.limits[1], (-1.3, 0.7), atol=1e-15)
    assert made.limits[0] == (-np.inf, np.inf)
    mechanism = jk.Mechanism.build(fixed=["a"], joints=[made])
    assert mechanism.mobility().freedoms == 2  # closed: the frames differ only in what the joint leaves free


def test_limits_of_a_plate_count_from_where_the_frames_agree():
    """A plate that stands a turn and two slides away from its frame has so much less to go."""
    away = turned(0.3)
    away[:3, 3] = (2.0, -1.0, 0.0)
    made = jk.joint_on_frames(
        "P", "a", "b", kind="planar", frame1=np.eye(4), frame2=away, limits={"x": (-1, 3), "y": (-1, 1), "phi": (0, 1)}
    )
    np.testing.assert_allclose(made.limits, [(-3, 1), (0, 2), (-0.3, 0.7)], atol=1e-15)  # one difference each
    np.testing.assert_allclose(made.frames_1, made.frames_2, atol=1e-15)  # closed


def test_an_open_pose_is_closed():
    """The rocker stands a little off its hinge."""
    whole, _, drawn = on_frames(4)
    places = drawn | {"rocker": drawn["rocker"] @ turned(0.02)}
    joints = []
    for name, parts in BARS.items():
        at = np.asarray(whole.joints[name].frames_1)[0]
        first, second = (np.linalg.inv(place) @ at for place in (drawn[part] for part in parts))
        joints.append(jk.joint_on_frames(name, *parts, kind="revolute", frame1=first, frame2=second, places=places))
    open_one = jk.Mechanism.build(fixed=["ground"], joints=joints)
    closed = open_one.close().mechanism
    assert closed.mobility().freedoms == 1
    for key, length in whole.lengths.items():
        if len(key) == 3 and length > 1:
            np.testing.assert_allclose(closed.lengths[key], length, rtol=1e-9)


@pytest.mark.parametrize(
    ("kind", "limits", "left"),
    [
        ("rectangular", {"x": (-1, 3), "y": (-1, 1)}, [(-3, 1), (0, 2)]),
        ("cartesian", {"x": (-1, 3), "z": (0, 5)}, [(-3, 1), (-np.inf, np.inf), (-3, 2)]),
        ("schoenflies", {"y": (0, 1), "phi": (0, 1)}, [(-np.inf, np.inf), (1, 2), (-np.inf, np.inf), (-0.3, 0.7)]),
    ],
)
def test_limits_of_slides_count_from_where_the_frames_agree(kind, limits, left):
    away = turned(0.3 if kind == "schoenflies" else 0.0)
    away[:3, 3] = (2.0, -1.0, 0.0 if kind == "rectangular" else 3.0)
    made = jk.joint_on_frames("P", "a", "b", kind=kind, frame1=np.eye(4), frame2=away, limits=limits)
    np.testing.assert_allclose(made.limits, left, atol=1e-15)  # one difference each
    np.testing.assert_allclose(made.frames_1, made.frames_2, atol=1e-15)  # closed


def test_an_arm_is_closed_where_no_loop_has_to_be():
    """The forearm is drawn 2 beside the pin of the elbow and tilted; it is put there, and the hand goes along."""
    tilted = np.eye(4)
    tilted[:3, :3], tilted[:3, 3] = Rotation.from_euler("x", 0.4).as_matrix(), (2.0, 0.0, 0.0)
    frames = {"frame1": np.eye(4), "frame2": np.eye(4)}
    joints = [
        jk.joint_on_frames("elbow", "arm", "forearm", kind="revolute", frame1=np.eye(4), frame2=tilted),
        jk.joint_on_frames("wrist", "forearm", "hand", kind="revolute", **frames),
    ]
    found = jk.Mechanism.build(fixed=["arm"], joints=joints).close()
    assert found.closed
    for part in ("forearm", "hand"):
        np.testing.assert_allclose(found.places[part] @ tilted, np.eye(4), atol=1e-15)
    assert all(joint.coincides for joint in found.mechanism.all_joints)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"kind": "revolut"}, "no kind 'revolut'.*'revolute'"),
        ({"frame1": np.eye(3)}, "frame1 must be a rigid 4x4 pose"),
        ({"frame2": 2 * np.eye(4)}, "frame2 must be a rigid"),
        ({"places": {"a": np.zeros((4, 4))}}, "the place of 'a' must be a rigid"),
        ({"kind": "universal"}, "perpendicular"),
        ({"kind": "screw", "pitch": np.nan}, "pitch must be a finite number"),
    ],
)
def test_what_makes_no_joint_is_refused(more, message):
    given = {"kind": "revolute", "frame1": np.eye(4), "frame2": np.eye(4)} | more
    with pytest.raises(ValueError, match=message):
        jk.joint_on_frames("A", "a", "b", **given)


@pytest.mark.parametrize("pitch", [1.0, -0.5])
def test_limits_of_a_screw_count_the_turns_that_its_advance_tells(pitch):
    """A nut two and a tenth turns along its thread has so much less to go."""
    turns = 2.1
    made = jk.joint_on_frames(
        "S",
        "bolt",
        "nut",
        kind="screw",
        frame1=np.eye(4),
        frame2=np.eye(4),
        places={"nut": turned(2 * np.pi * turns, z=pitch * turns)},
        pitch=pitch,
        limits=(0, 20 * np.pi),
    )
    np.testing.assert_allclose(made.limits[0], np.array([0, 20 * np.pi]) - 2 * np.pi * turns, atol=1e-13)


@pytest.mark.parametrize(("kind", "pitch"), [("screw", np.inf), ("screw", 0.0), ("revolute", 1.0)])
def test_a_pitch_is_the_number_of_a_screw(kind, pitch):
    with pytest.raises(ValueError, match=r"joint 'S'.*pitch"):
        jk.joint_on_frames("S", "a", "b", kind=kind, frame1=np.eye(4), frame2=np.eye(4), pitch=pitch)
