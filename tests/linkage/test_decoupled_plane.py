"""Loops that keep to a plane though joints could leave it: which they are, and that six equations move them alike."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.pose import rotation, unit

Z = (0, 0, 1)
IN_PLANE = {"boom.phi", "foot.phi", "cylinder.z", "eye.phi"}
STROKES = np.linspace(-1.0, 1.5, 41)


def crane(height=0.0, last=None):
    """A boom that a hydraulic cylinder from (3, -4) lifts at its point (4, 0)."""
    along = unit(np.array([1.0, 4.0, 0.0]))
    joints = [
        jk.revolute("boom", "ground", "boom", point=(0, 0, 0), axis=Z),
        jk.revolute("foot", "ground", "tube", point=(3, -4, height), axis=Z),
        jk.cylindrical("cylinder", "tube", "rod", point=(3, -4, height), axis=along),
        last or jk.revolute("eye", "rod", "boom", point=(4, 0, height), axis=Z),
    ]
    return jk.Mechanism.build(joints=joints, fixed=["ground"])


def boom_angle(stroke):
    """By the law of cosines: sides 4 (boom) and 5 (ground) about the hinge, and the cylinder of length sqrt(17) + z."""
    length = np.sqrt(17.0) + stroke
    return np.arccos((16 + 25 - length**2) / (2 * 4 * 5)) - np.arctan2(4, 3)


def in_space(mechanism):
    """The same mechanism, solved by six equations a loop (four where all turn about one direction)."""
    linkage = mechanism.linkage
    classes = tuple(each._replace(plane=None, decoupled_plane=None) for each in linkage.classes)
    return replace(mechanism, linkage=replace(linkage, classes=classes))


def in_plane(mechanism):
    """The names of the coordinates in the plane of the only loop group; None where there is no plane."""
    (found,), (loop_group,) = mechanism.linkage.classes, mechanism.structure.loop_groups
    joints = [mechanism.all_joints[joint] for joint in loop_group.joints]
    names = [f"{joint.name}.{name}" for joint in joints for name in joint.coordinates]
    assert found.plane is None
    return None if found.decoupled_plane is None else {names[column] for column in found.decoupled_plane}


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


def test_a_drive_out_of_the_plane_is_solved_in_space():
    """The pin slides in both holes of the boom by what is asked for; the boom rests."""
    pin = jk.cylindrical("eye", "rod", "boom", point=(4, 0, 0), axis=Z)
    foot = jk.cylindrical("foot", "ground", "tube", point=(3, -4, 0), axis=Z)
    first, _, cylinder, _ = crane().all_joints
    mechanism = jk.Mechanism.build(joints=[first, foot, cylinder, pin], fixed=["ground"])
    assert in_plane(mechanism) == IN_PLANE
    slide = np.linspace(0, 1, 5)
    motion = mechanism.sweep({"eye.z": slide, "cylinder.z": np.zeros(5)})
    assert np.all(np.asarray(motion.closed))
    np.testing.assert_allclose(motion.coordinates["foot"][:, 0], -slide, atol=1e-12)
    np.testing.assert_allclose(motion.coordinates["boom"][:, 0], 0.0, atol=1e-12)


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


def test_poses_that_are_given_out_of_the_plane_are_projected_there():
    along = unit(np.array([1.0, 4.0, 0.0]))
    swivel = jk.revolute("swivel", "rod", "head", point=(4, 0, 0), axis=along)
    eye = jk.revolute("eye", "head", "boom", point=(4, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(joints=[*crane().all_joints[:3], swivel, eye], fixed=["ground"])
    found = jk.project(mechanism, {"cylinder": np.array([[0.0, 0.4]]), "swivel": np.array([-0.4])})
    assert float(found.distance[0]) < 1e-9  # the rod turned by 0.4 closes the loop
    np.testing.assert_allclose(found.motion.coordinates["cylinder"], [[0.0, 0.4]], atol=1e-9)


def test_gradients_are_those_in_space():
    mechanism = crane()

    def squares(mechanism):
        return jnp.sum(mechanism.sweep({"cylinder.z": STROKES}).coordinates["boom"] ** 2)

    one, other = (jax.grad(squares)(each).linkage.joints for each in (mechanism, in_space(mechanism)))
    plane = [0, 1]  # changes that keep the loops closed: hinges moved in the plane, on both sides
    for a, b in zip(one, other, strict=True):
        for side in ("frames_1", "frames_2"):
            mine, theirs = (np.asarray(getattr(each, side))[:, plane, 3] for each in (a, b))
            np.testing.assert_allclose(mine, theirs, rtol=1e-9, atol=1e-9)
    assert np.abs(np.asarray(one[1].frames_1)[:, :2, 3]).max() > 0.1


def test_a_freedom_out_of_the_plane_that_is_not_idle_is_not_left_out():
    """Tube and boom hang in swivels beside their hinges: they tilt together, and the eye then comes nearer."""
    along = unit(np.array([1.0, 4.0, 0.0]))
    joints = [
        jk.revolute("boom", "ground", "ring", point=(0, 0, 0), axis=Z),
        jk.revolute("tilt", "ring", "boom", point=(0, 0, 0), axis=unit(np.array([4.0, 3.0, 0.0]))),
        jk.revolute("foot", "ground", "other ring", point=(3, -4, 0), axis=Z),
        jk.revolute("tilt of tube", "other ring", "tube", point=(3, -4, 0), axis=unit(np.array([-4.0, 1.0, 0.0]))),
        jk.prismatic("slide", "tube", "rod", axis=along),
        jk.spherical("eye", "rod", "boom", point=(4, 0, 0)),
    ]
    assert in_plane(jk.Mechanism.build(joints=joints, fixed=["ground"])) is None


def drawn(rng):
    """A four-bar, or a crane, of any joints: mechanism and drive.

    Hinges, pins, balls, crosses and swivels at any height; tubes, and plates across the plane, where parts slide.
    """
    places = rng.normal(size=(4, 2)) * 2

    def level(place):
        return (*place, rng.choice([0.0, 0.0, rng.normal()]))

    def hinge(name, one, other, place):
        point, angle = level(place), rng.uniform(0, np.pi)
        across = (np.cos(angle), np.sin(angle), 0.0)
        match rng.choice(["hinge", "pin", "ball", "cross", "swivel"], p=[0.4, 0.2, 0.2, 0.1, 0.1]):
            case "hinge":
                return [jk.revolute(name, one, other, point=point, axis=Z)]
            case "pin":
                return [jk.cylindrical(name, one, other, point=point, axis=Z)]
            case "ball":
                return [jk.spherical(name, one, other, point=point)]
            case "cross":
                return [jk.universal(name, one, other, point=point, axis1=Z, axis2=across)]
        swivel = jk.revolute(f"{name} swivel", f"{name} ring", other, point=point, axis=across)
        return [jk.revolute(name, one, f"{name} ring", point=point, axis=Z), swivel]

    if rng.integers(2):
        ends = [("ground", "a"), ("a", "b"), ("b", "c"), ("c", "ground")]
        joints = [hinge(name, *pair, place) for name, pair, place in zip("ABCD", ends, places, strict=True)]
        drive = "A"
    else:
        along = (*unit(places[2] - places[1]), 0.0)
        slide = jk.cylindrical("S", "tube", "rod", point=level(places[1]), axis=along)
        if rng.integers(2):
            slide = jk.planar("S", "tube", "rod", point=level(places[1]), normal=np.cross(along, Z))
        ends = [("ground", "boom"), ("ground", "tube"), ("rod", "boom")]
        joints = [hinge(name, *pair, place) for name, pair, place in zip("ABC", ends, places, strict=False)]
        joints, drive = [*joints, [slide]], "S"
    return jk.Mechanism.build(joints=[each for some in joints for each in some], fixed=["ground"]), drive


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
