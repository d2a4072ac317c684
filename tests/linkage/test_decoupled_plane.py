"""Loops that keep to a plane though joints could leave it: which they are, and that six equations move them alike."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.pose import rotation, unit
from reference.cranes import IN_PLANE, STROKES, Z, boom_angle, crane, drawn, in_plane, in_space


def test_a_hydraulic_cylinder_turns_in_its_plane_and_its_rod_does_not():
    mechanism = crane()
    assert in_plane(mechanism) == IN_PLANE
    motion = mechanism.sweep({"cylinder.z": STROKES})
    assert np.all(np.asarray(motion.closed))
    # rounding, over the sine of the angle between boom and cylinder, 0.5 at least
    np.testing.assert_allclose(motion.coordinates["boom"][:, 0], boom_angle(STROKES), atol=1e-13)
    np.testing.assert_array_equal(np.asarray(motion.coordinates["cylinder"])[:, 1], 0.0)
    assert str(mechanism.plan(["cylinder.z"])).count("formula") == 1


def test_the_height_of_the_cylinder_does_not_matter():
    """Its rod cannot turn: the hinges on both of its ends are parallel."""
    motion = crane(height=2.5).sweep({"cylinder.z": STROKES})
    np.testing.assert_allclose(motion.coordinates["boom"][:, 0], boom_angle(STROKES), atol=1e-13)


@pytest.mark.long
def test_rods_that_turn_idly_rest_where_they_are_in_one_line():
    """The eye turns on a swivel in the line of the rod: swivel and cylinder turn together, and move nothing."""
    along = unit(np.array([1.0, 4.0, 0.0]))
    swivel = jk.revolute("swivel", "rod", "head", point=(4, 0, 0), axis=along)
    eye = jk.revolute("eye", "head", "boom", point=(4, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(joints=[*crane().all_joints[:3], swivel, eye], fixed=["ground"])
    assert in_plane(mechanism) == IN_PLANE
    motion = mechanism.sweep({"cylinder.z": STROKES})
    np.testing.assert_allclose(motion.coordinates["boom"][:, 0], boom_angle(STROKES), atol=1e-13)
    expected = in_space(mechanism).sweep({"cylinder.z": STROKES})
    for one, other in zip(motion.displacements, expected.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("normal", range(3))
def test_balls_and_crosses_turn_in_the_plane_like_hinges(normal):
    """A boom, a tube on a cross and a rod on a ball, with the hinge of the boom along x, y or z."""
    turned = np.roll(np.eye(3), normal + 1, axis=0)  # carries z to the axis of that number

    def at(*point):
        return turned @ np.array(point, float)

    joints = [
        jk.revolute("boom", "ground", "boom", point=at(0, 0, 0), axis=at(0, 0, 1)),
        jk.universal("foot", "ground", "tube", point=at(3, -4, 0), axis1=at(0, 0, 1), axis2=unit(at(4, -1, 0))),
        jk.cylindrical("cylinder", "tube", "rod", point=at(3, -4, 0), axis=at(1, 4, 0)),
        jk.spherical("eye", "rod", "boom", point=at(4, 0, 0)),
    ]
    mechanism = jk.Mechanism.build(joints=joints, fixed=["ground"])
    about = ("theta", "phi", "psi")[normal]
    assert in_plane(mechanism) == {"boom.phi", "foot.phi", "cylinder.z", f"eye.{about}"}
    motion = mechanism.sweep({"cylinder.z": STROKES})
    np.testing.assert_allclose(motion.coordinates["boom"][:, 0], boom_angle(STROKES), atol=1e-13)
    expected = in_space(mechanism).sweep({"cylinder.z": STROKES})
    for one, other in zip(motion.displacements, expected.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-11)
    np.testing.assert_allclose(motion.transforms["rod"], expected.transforms["rod"], atol=1e-11)


@pytest.mark.parametrize("along", [(1, 0, 0), (0, 1, 0)], ids=["x", "y"])
def test_a_plate_across_the_plane_slides_along_one_line(along):
    """The rod of a slider-crank of lengths 1 and 3 is hinged to a plate on a wall that is parallel to its hinge."""
    across = np.cross((0, 0, 1), along)
    point = 3 * np.array(along)
    joints = [
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "crank", "rod", point=-np.array(along, float), axis=Z),
        jk.revolute("C", "rod", "plate", point=point - np.array(along), axis=Z),
        jk.planar("D", "ground", "plate", point=point, normal=across),
    ]
    mechanism = jk.Mechanism.build(joints=joints, fixed=["ground"])
    names = in_plane(mechanism)
    assert names is not None and len(names) == 4 and {"A.phi", "B.phi", "C.phi"} < names
    angle = np.linspace(-1.0, 1.0, 21)
    motion = mechanism.sweep({"A": angle})
    moved = motion.transforms["plate"][:, :3, 3] @ np.array(along, float)
    np.testing.assert_allclose(moved, np.sqrt(9 - np.sin(angle) ** 2) - np.cos(angle) - 2, atol=1e-13)


def test_a_turn_that_carries_parts_in_the_plane_is_not_left_out():
    """Two swivels one above the other, as in a crank across the plane: their turns move the eye along the plane."""
    along = unit(np.array([1.0, 4.0, 0.0]))
    swivel = jk.revolute("swivel", "rod", "head", point=(4, 0, 1), axis=along)
    eye = jk.revolute("eye", "head", "boom", point=(4, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(joints=[*crane().all_joints[:3], swivel, eye], fixed=["ground"])
    assert in_plane(mechanism) is None


@pytest.mark.parametrize(
    "last",
    [
        jk.revolute("eye", "rod", "boom", point=(4, 0, 0), axis=(0, 0.5, 1)),  # a hinge that is tilted
        jk.screw("eye", "rod", "boom", point=(4, 0, 0), axis=Z, pitch=0.1),
        jk.planar("eye", "rod", "boom", point=(4, 0, 0), normal=(1, 1, 1)),  # its slides are oblique to the plane
    ],
    ids=lambda joint: joint.kind,
)
def test_other_joints_leave_loops_in_space(last):
    assert in_plane(crane(last=last)) is None


@pytest.mark.long
def test_a_coupling_in_the_plane_leaves_the_plane_as_it_is():
    """A wheel on the ground turns twice as far as the boom that the cylinder lifts."""
    wheel = jk.revolute("wheel", "ground", "wheel", point=(-3, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(
        joints=[*crane().all_joints, wheel], fixed=["ground"], couplings=[jk.gear("boom", "wheel", ratio=2)]
    )
    assert in_plane(mechanism) == IN_PLANE | {"wheel.phi"}
    motion = mechanism.sweep({"cylinder.z": STROKES})
    expected = in_space(mechanism).sweep({"cylinder.z": STROKES})
    np.testing.assert_allclose(motion.coordinates["boom"][:, 0], boom_angle(STROKES), atol=1e-12)
    for one, other in zip(motion.displacements, expected.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)


def test_placed_and_numbered_anywhere_the_plane_is_the_same():
    mechanism = crane(height=0.3)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation(unit(np.array([1.0, 2.0, -0.5])), 1.1), (300.0, -20.0, 70.0)
    joints = [
        replace(joint, frames_1=pose @ joint.frames_1, frames_2=pose @ joint.frames_2)
        for joint in mechanism.all_joints[::-1]
    ]
    placed = jk.Mechanism.build(joints=joints, fixed=["ground"])
    assert in_plane(placed) == IN_PLANE
    angle = placed.sweep({"cylinder.z": STROKES}).coordinates["boom"][:, 0]
    np.testing.assert_allclose(angle, boom_angle(STROKES), atol=1e-12)  # lengths of 300 about one of 5


def test_a_freedom_out_of_the_plane_that_is_not_idle_is_not_left_out():
    """Tube and boom hang in swivels beside their hinges: they tilt together, and the eye then comes nearer."""
    along = unit(np.array([1.0, 4.0, 0.0]))
    slides = [
        jk.prismatic("slide", "tube", "rod", axis=along),
        jk.cylindrical("slide", "tube", "rod", point=(3, -4, 0), axis=along),  # beside a rod that spins idly
    ]
    joints = [
        jk.revolute("boom", "ground", "ring", point=(0, 0, 0), axis=Z),
        jk.revolute("tilt", "ring", "boom", point=(0, 0, 0), axis=unit(np.array([4.0, 3.0, 0.0]))),
        jk.revolute("foot", "ground", "other ring", point=(3, -4, 0), axis=Z),
        jk.revolute("tilt of tube", "other ring", "tube", point=(3, -4, 0), axis=unit(np.array([-4.0, 1.0, 0.0]))),
        jk.spherical("eye", "rod", "boom", point=(4, 0, 0)),
    ]
    for slide in slides:
        assert in_plane(jk.Mechanism.build(joints=[*joints, slide], fixed=["ground"])) is None


@pytest.mark.long
@pytest.mark.parametrize("seed", range(5))
def test_cranes_and_four_bars_of_any_joints_move_in_the_plane_as_in_space(seed):
    rng = np.random.default_rng(seed)
    while True:
        mechanism, drive = drawn(rng)
        if mechanism.linkage.classes[0].decoupled_plane is not None:
            break
    names = in_plane(mechanism)
    assert names is not None
    inputs = {next(name for name in sorted(names) if name.startswith(f"{drive}.")): np.linspace(-0.5, 0.5, 9)}
    motion, expected = (each.sweep(inputs) for each in (mechanism, in_space(mechanism)))
    np.testing.assert_array_equal(motion.status, expected.status)
    closed = np.asarray(motion.closed)
    for part in mechanism.parts:
        one, other = (np.asarray(each.transforms[part])[closed] for each in (motion, expected))
        np.testing.assert_allclose(one, other, atol=1e-9)  # closure to 1e-12, over the distance to a limit
