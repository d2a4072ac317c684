"""Faces that a joint was read from and that it leaves: solids of known length, swept beyond their ends."""

from dataclasses import replace
from itertools import pairwise

import jax
import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path
from jaxkin.geometry.pose import apply, rotation
from jaxkin.io.long_motion import write_stream
from jaxkin.mechanism.lost_contacts import joined

STEP = 0.5
RANGE = np.arange(-100.0, 100.0 + STEP, STEP)


def prism(section, low, high):
    """A prism along x; its section (y, z), anticlockwise, is seen whole from its first corner."""
    corners = np.array([[x, y, z] for x in (low, high) for y, z in section], float)
    n = len(section)
    sides = [t for k, j in pairwise([*range(n), 0]) for t in ([k, j, n + j], [k, n + j, n + k])]
    caps = [t for k in range(1, n - 1) for t in ([0, k + 1, k], [n, n + k, n + k + 1])]
    mesh = trimesh.Trimesh(corners, sides + caps)
    mesh.fix_normals()
    return mesh


def box(low, high):
    return trimesh.creation.box(bounds=[low, high])


def assembly(folder, parts, pose=None, scale=1.0):
    """The parts as an assembly of STL files, placed by a pose and then scaled."""
    files = {}
    for name, mesh in parts.items():
        mesh = mesh.copy()
        mesh.apply_transform(np.eye(4) if pose is None else pose)
        mesh.apply_scale(scale)
        files[name] = folder / f"{name}.stl"
        mesh.export(files[name])
    return jk.load(files, unit="mm")


GUIDE = prism([(10, 10), (10, 30), (0, 30), (0, 0), (40, 0), (40, 10)], -20, 80)
"""An angle along x, from -20 to 80."""
SLIDER = box([0, 10, 10], [40, 30, 20])
"""Lies in the angle, from 0 to 40."""
PLACED = np.eye(4)
PLACED[:3, :3], PLACED[:3, 3] = rotation(np.array([0.48, -0.6, 0.64]), 1.1), [30.0, -20.0, 50.0]


def slide(folder, parts, **placing):
    return assembly(folder, parts, **placing).mechanism(fixed=[name for name in parts if name != "slider"])


@pytest.mark.parametrize(("pose", "scale"), [(None, 1.0), (PLACED, 1e-3), (PLACED, 1e3)])
def test_a_slider_leaves_its_guide_where_the_guide_ends(tmp_path, pose, scale):
    """Its last edge is on the guide up to a displacement of 80 and of -60, in any place and unit."""
    motion = slide(tmp_path, {"guide": GUIDE, "slider": SLIDER}, pose=pose, scale=scale).sweep(
        {"guide-slider": scale * RANGE}
    )
    assert np.all(motion.closed)
    forwards = np.asarray(motion.points("slider", apply(np.eye(4) if pose is None else pose, np.zeros(3)) * scale))
    along = np.array([1.0, 0, 0]) if pose is None else pose[:3, 0]
    x = (forwards - forwards[np.abs(RANGE).argmin()]) @ along / scale
    expected = np.maximum(np.maximum(x - 80, -60 - x), 0)
    assert len(motion.lost_contacts) == 2
    for lost in motion.lost_contacts:
        assert (lost.joint, lost.contact.state, lost.left) == ("guide-slider", "a", "")
        # corners in single precision, and placements by it: 1e-5 of the size, which is what counts as touching
        np.testing.assert_allclose(lost.gaps / scale, expected, atol=2e-3)
        np.testing.assert_array_equal(lost.loose, expected > 0.1)


def test_what_is_printed_says_which_joint_where_and_how_far(tmp_path):
    motion = slide(tmp_path, {"guide": GUIDE, "slider": SLIDER}).sweep({"guide-slider": np.linspace(0, 100, 101)})
    report = str(motion)
    assert "lost contact: joint 'guide-slider' leaves its faces at 20 of 101 poses: poses 81 to 100" in report
    assert "(guide-slider.z = 81 to 100 mm)" in report and "up to 20 mm apart" in report
    assert report.count("(a) guide face") == 2 and "nothing else holds it there" in report
    assert "lost" not in str(motion.mechanism.sweep({"guide-slider": np.linspace(-60, 80, 11)}))


def test_a_face_that_is_left_while_the_others_hold_is_told_apart(tmp_path):
    """A lid over the slider's first 20: beyond it floor and fence hold the slider as before."""
    parts = {"guide": GUIDE, "slider": SLIDER, "lid": box([-20, 10, 20], [20, 30, 25])}
    mechanism = slide(tmp_path, parts)
    motion = mechanism.sweep({mechanism.joints_between("guide", "slider")[0]: np.linspace(0, 60, 61)})
    (lost,) = motion.lost_contacts
    assert set(lost.contact.parts) == {"slider", "lid"} and lost.left == "prismatic"
    assert lost.gap == pytest.approx(40, abs=1e-3) and not lost.loose.any()
    assert "lost contact" not in str(motion)
    assert "lost where other contacts of the same joint still make it what it is: (a)" in str(motion)


def test_faces_that_go_on_in_one_plane_hold_on(tmp_path):
    """The guide in two parts, end to end, both fixed: the slider comes from the one onto the other."""
    longer = GUIDE.copy()
    longer.apply_translation([100, 0, 0])
    motion = slide(tmp_path, {"guide": GUIDE, "more": longer, "slider": SLIDER}).sweep({"guide-slider": RANGE})
    expected = np.maximum(-60 - RANGE, 0)
    for lost in motion.lost_contacts:
        np.testing.assert_allclose(lost.gaps, expected, atol=2e-3)
    assert len(motion.lost_contacts) == 2


def pin_in_bush():
    pin = trimesh.creation.cylinder(5, segment=[[0, 0, 0], [0, 0, 60]], sections=48)
    bush = trimesh.creation.annulus(5, 10, segment=[[0, 0, 20], [0, 0, 30]], sections=48)
    return {"bush": bush, "pin": pin}


def test_a_pin_leaves_its_bush(tmp_path):
    """The pin, from 0 to 60, is out of the bush, from 20 to 30, beyond 30 and -40, however it turns."""
    mechanism = assembly(tmp_path, pin_in_bush()).mechanism(fixed=["bush"])
    motion = mechanism.sweep({"bush-pin.z": RANGE, "bush-pin.phi": 0.05 * RANGE})
    (lost,) = motion.lost_contacts
    assert lost.contact.state == "e"
    np.testing.assert_allclose(lost.gaps, np.maximum(np.maximum(RANGE - 30, -40 - RANGE), 0), atol=2e-3)
    assert "bush-pin.z = -100 to -40.5 mm, bush-pin.phi = -286.5 to -116 deg" in str(motion)


def fork_and_eye():
    """Two cheeks of a fork, an eye between them, which touches both, and turns and slides there."""
    fork = trimesh.util.concatenate([box([0, -10, 5], [30, 10, 9]), box([0, -10, -9], [30, 10, -5])])
    return {
        "fork": trimesh.util.concatenate([fork, box([-8, -10, -9], [-0.5, 10, 9])]),
        "eye": box([5, -4, -5], [45, 4, 5]),
    }


def test_an_eye_leaves_its_fork(tmp_path):
    """A planar joint: the eye, 40 by 8, is pulled out along x, turned by a quarter at the far end."""
    mechanism = assembly(tmp_path, fork_and_eye()).mechanism(fixed=["fork"])
    (name,) = mechanism.joints
    joint = mechanism.joints[name]
    assert joint.kind == "planar"
    x = joint.frames_1[0, :3, :3].T @ [1.0, 0, 0]
    shift = np.linspace(0, 60, 121)
    drive = {f"{name}.{axis}": x[k] * shift for k, axis in enumerate("xy")}
    motion = mechanism.sweep(drive | {f"{name}.phi": 0 * shift})
    for lost in motion.lost_contacts:
        np.testing.assert_allclose(lost.gaps, np.maximum(shift - 25, 0), atol=2e-3)
    assert len(motion.lost_contacts) == 2


@pytest.mark.parametrize(
    "name", ["fourbar", *(pytest.param(name, marks=pytest.mark.long) for name in ("slider_crank", "cam"))]
)
def test_an_assembly_that_stays_on_its_faces_says_nothing(name):
    example = EXAMPLES[name]
    mechanism = jk.load(path(name)).mechanism(fixed=example.fixed)
    (driven,) = mechanism.joints_between(*example.drive)
    motion = mechanism.sweep({driven: np.linspace(0, 2 * np.pi, 73)})
    assert np.all(motion.closed) and motion.lost_contacts == ()


@pytest.mark.long
def test_the_slider_of_the_slider_crank_leaves_its_rails():
    """Without its rod. Drawn: rails from 54 to 182, plate from -34 to 190; flanks of the slider 15 long to either
    side of its pin, its sole 18."""
    size = EXAMPLES["slider_crank"].dimensions
    b = size["crank"] * np.array([np.cos(size["angle"]), np.sin(size["angle"])])
    middle = b[0] + np.sqrt(size["rod"] ** 2 - (b[1] - size["offset"]) ** 2)
    mechanism = jk.load(path("slider_crank")).mechanism(fixed=["ground"], ignore=[["rod", "slider"]])
    axis = mechanism.joints["ground-slider"].frames_1[0, :3, 2] @ EXAMPLES["slider_crank"].placement[:3, 0]
    x = middle + RANGE
    motion = mechanism.sweep({"ground-slider": np.sign(axis) * RANGE})
    flanks = np.maximum(np.maximum(x - 15 - 182, 54 - x - 15), 0)
    sole = np.maximum(np.maximum(x - 18 - 190, -34 - x - 18), 0)
    found = sorted((lost.gaps for lost in motion.lost_contacts), key=np.max)
    assert len(found) == 3
    for gaps, expected in zip(found, (sole, flanks, flanks), strict=True):
        # chords of rounded corners are given to the face: a hair is missing, never too much is told
        assert np.all(gaps <= expected + 1e-3) and np.all(gaps >= expected - 0.1)


@pytest.mark.long
def test_the_piston_of_the_air_cylinder_leaves_its_bore():
    """Drawn: the piston is 68 to 72 behind the eye, which is `stretch` from the trunnion; the bore is from 13 to 60."""
    size = EXAMPLES["air_cylinder"].dimensions
    q = size["link"] * np.array([np.cos(size["angle"]), np.sin(size["angle"])])
    stretch = np.hypot(*(q + [size["base"] / 2 - size["trunnion"], 0]))
    parts = jk.load(path("air_cylinder"))
    alone = replace(parts, parts=tuple(part for part in parts.parts if part.name in ("p2", "p10")))
    motion = alone.mechanism(fixed=["p10"]).sweep({"p2-p10.z": RANGE})
    (lost,) = motion.lost_contacts
    below, beyond = (np.maximum(np.maximum(13 - (s - 68), s - 72 - 60), 0) for s in (stretch + RANGE, stretch - RANGE))
    assert min(np.abs(lost.gaps - each).max() for each in (below, beyond)) < 1e-3
    assert "joint 'p2-p10' leaves its faces" in str(motion)


def test_a_joint_by_hand_and_sticks_have_no_faces_to_leave(tmp_path):
    files = assembly(tmp_path, {"guide": GUIDE, "slider": SLIDER})
    by_hand = jk.prismatic("slide", "guide", "slider", axis=(1, 0, 0))
    motion = files.mechanism(fixed=["guide"], joints=[by_hand]).sweep({"slide": RANGE})
    assert motion.lost_contacts == ()
    bare = replace(files.mechanism(fixed=["guide"]), solids=())
    assert bare.sweep({"guide-slider": RANGE}).lost_contacts == ()


@pytest.mark.long
def test_a_long_range_says_what_a_short_one_does(tmp_path):
    """Chunk by chunk as all at once, in the report of a file that is written piece by piece too."""
    mechanism = slide(tmp_path, {"guide": GUIDE, "slider": SLIDER})
    drive = {"guide-slider": np.linspace(-100, 100, 801)}
    whole = mechanism.sweep(drive)
    pieces = [(motion.lost_contacts, len(motion)) for motion in mechanism.stream(drive, 200)]
    for one, other in zip(whole.lost_contacts, joined(pieces), strict=True):
        assert one.contact is other.contact and one.left == other.left
        np.testing.assert_allclose(one.gaps, other.gaps, atol=1e-12)
        np.testing.assert_array_equal(one.loose, other.loose)
    assert write_stream(mechanism.stream(drive, 200), tmp_path / "motion.npz") == str(whole)


def test_what_is_left_of_a_joint_is_told_of_the_chunk_in_which_its_faces_are_farthest_apart(tmp_path):
    motion = slide(tmp_path, {"guide": GUIDE, "slider": SLIDER}).sweep({"guide-slider": np.array([90.0, 99.0])})
    whole = motion.lost_contacts[0]
    pieces = [replace(whole, gaps=gap * np.ones(1), loose=np.ones(1, bool), left=f"{gap}") for gap in (1.0, 3.0, 2.0)]
    (one,) = joined([((piece,), 1) for piece in pieces])
    assert one.left == "3.0" and one.gaps.tolist() == [1.0, 3.0, 2.0]


def test_poses_that_are_not_closed_are_not_judged(tmp_path):
    motion = slide(tmp_path, {"guide": GUIDE, "slider": SLIDER}).sweep({"guide-slider": np.array([0.0, 90.0, 95.0])})
    cut = replace(motion, status=jax.numpy.array([0, 0, 1]) + motion.status[0])
    assert [lost.gap for lost in cut.lost_contacts] == pytest.approx([10.0, 10.0], abs=1e-3)
