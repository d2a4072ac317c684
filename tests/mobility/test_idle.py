"""Idle motions: passive parts that move about themselves while all others rest; no motor is called idle."""

from dataclasses import replace

import numpy as np
import pytest

from jaxkin.geometry.pose import frame
from jaxkin.joints.joint import Joint
from jaxkin.joints.pairs import cylindrical, fixed, planar, prismatic, revolute, spherical, universal
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mobility.body_graph import BodyGraph
from jaxkin.mobility.idle import IdleMotion, IdleMotions
from jaxkin.mobility.loop_freedoms import loop_freedoms
from reference import catalogue
from reference.cassie import cassie_leg
from reference.mechanisms import Z, planar_fourbar, rssr_linkage

X = (1.0, 0.0, 0.0)
BALLS = (np.eye(3), np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0])
"""Axes of the three hinges that make a ball, in rows: along the world's axes, and as they come."""


def hinges(name: str, part1: str, part2: str, *, point, axes=BALLS[1]) -> list[Joint]:
    """A ball as files of robots write it: three hinges that meet, with two small links between them."""
    parts = [part1, f"{name} link 1", f"{name} link 2", part2]
    return [
        revolute(f"{name}{k}", parts[k], parts[k + 1], point=point, axis=axis) for k, axis in enumerate(np.array(axes))
    ]


def as_hinges(mechanism: Mechanism, axes=BALLS[1], names=()) -> Mechanism:
    """The same with its balls, or some of them, as three hinges each."""
    joints = []
    for joint in mechanism.all_joints:
        is_written = joint.kind == "spherical" and (not names or joint.name in names)
        point = np.asarray(joint.frames_1)[0, :3, 3]
        joints += hinges(joint.name, *joint.parts, point=point, axes=axes) if is_written else [joint]
    return Mechanism.build(fixed=list(mechanism.fixed), joints=joints)


def placed(mechanism: Mechanism, seed: int) -> Mechanism:
    """The same somewhere else in another unit, its joints in another order."""
    random = np.random.default_rng(seed)
    pose = frame(random.normal(size=3), random.normal(size=3), random.normal(size=3))
    scale = 10.0 ** random.uniform(-3, 3)
    joints = []
    for index in random.permutation(len(mechanism.all_joints)):
        joint = mechanism.all_joints[index]
        sides = pose @ np.asarray(joint.frames_1), pose @ np.asarray(joint.frames_2)
        for side in sides:
            side[:, :3, 3] *= scale
        joints.append(replace(joint, frames_1=sides[0], frames_2=sides[1]))
    return Mechanism.build(fixed=list(mechanism.fixed), joints=joints)


def leg(tail=True) -> Mechanism:
    """The axis of the thigh's motor M goes through the ball of the rod that holds the shin: M turns all three."""
    return Mechanism.build(
        fixed=["base"] if tail else ["hip"],
        joints=[
            *([revolute("yaw", "base", "hip", point=(0, 0, 0), axis=X)] if tail else []),
            revolute("M", "hip", "thigh", point=(0, 0, 0), axis=Z),
            revolute("K", "thigh", "shin", point=(1, 0, 0), axis=Z),
            spherical("ball", "hip", "rod", point=(0, 0, 0.1)),
            universal("cross", "rod", "shin", point=(1.2, 0.2, 0.1), axis1=Z, axis2=X),
        ],
    )


def left_free(mechanism: Mechanism, drive) -> list[str]:
    return [note for note in mechanism.plan(drive).notes if note.startswith("undetermined")]


def rates_of(mechanism: Mechanism) -> list[IdleMotions]:
    return [IdleMotions(mechanism.linkage, found) for found in loop_freedoms(mechanism.linkage)]


LEGS = {
    "a ball": leg(),
    "hinges along the world's axes": as_hinges(leg(), BALLS[0]),  # the last one on M's axis
    "three hinges": as_hinges(leg()),
    "hip fixed": leg(tail=False),
}


@pytest.mark.parametrize("name", LEGS)
@pytest.mark.parametrize("seed", [None, 1, 2])
def test_a_motor_whose_axis_goes_through_a_ball_is_no_idle_spin(name, seed):
    """Thigh, shin and rod turn together on the hip: of use, as between two bearings in one and the same part."""
    mechanism = LEGS[name] if seed is None else placed(LEGS[name], seed)
    found = mechanism.mobility()
    tail = ("yaw.phi",) if name != "hip fixed" else ()
    assert (found.freedoms, found.useful, found.idle) == (len(tail) + 1, len(tail) + 1, ())
    assert len(found.drivable) == found.useful
    if "hinges" not in name:  # else one of those may come first, by the order of joints
        assert found.drivable == (*tail, "M.phi")
    assert mechanism.plan([*tail, "M.phi"]).notes == ()


@pytest.mark.long
def test_the_leg_follows_its_motors():
    """K can never move, so what hangs on M goes with it as one body."""
    mechanism = leg()
    assert mechanism.mobility().drivable == ("yaw.phi", "M.phi")
    angles = np.linspace(0.0, 1.0, 5)
    motion = mechanism.sweep({"yaw": 0.5 * angles, "M": angles})
    assert isinstance(motion, Motion) and np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["K"], 0.0, atol=1e-9)  # closed to 1e-11, lever arms near 1
    np.testing.assert_allclose(motion.transforms["shin"], motion.transforms["thigh"], atol=1e-9)


def test_no_motor_of_a_leg_of_cassie_is_idle():
    """Seven freedoms of use: five motors, and the springs at shin and heel; the rod at the heel spins."""
    mechanism = cassie_leg()
    found = mechanism.mobility()
    (rod,) = found.idle_motions
    assert (rod.parts, rod.between) == (("rod",), ("hip-pitch", "heel"))
    assert (found.freedoms, found.useful) == (8, 7)
    motors = ["hip-roll", "hip-yaw", "hip-pitch", "knee", "foot"]
    assert not {f"{motor}.phi" for motor in motors} & set(found.idle)
    assert not [note for note in mechanism.plan(motors).notes if note.startswith("infeasible drive")]
    springs = ["shin", "tarsus"]  # that of the heel follows
    assert not left_free(mechanism, [*motors, *springs])


@pytest.mark.long
@pytest.mark.parametrize("names", [("B",), ("B", "C")])
@pytest.mark.parametrize("axes", BALLS, ids=["along the axes", "skew"])
def test_a_rod_spins_where_its_balls_are_hinges(names, axes):
    """The small links of the balls go along; the crank is what can be driven."""
    mechanism = as_hinges(rssr_linkage(), axes, names)
    found = mechanism.mobility()
    (motion,) = found.idle_motions
    links = {f"{name} link {k}" for name in names for k in (1, 2)}
    assert set(motion.parts) == {"rod", *links} and motion.between == ("crank", "rocker")
    assert (found.freedoms, found.useful, found.drivable) == (2, 1, ("A.phi",))
    for seed in (1, 2):
        again = placed(mechanism, seed).mobility()
        assert [set(one.parts) for one in again.idle_motions] == [set(motion.parts)]
        assert (again.freedoms, set(again.idle)) == (2, set(found.idle))


@pytest.mark.long
def test_rods_of_parallel_robots_spin_where_their_balls_are_hinges():
    for robot in (catalogue.delta(), catalogue.hexapod()):
        plain, written = robot.mobility(), as_hinges(robot).mobility()
        assert (written.freedoms, written.idle_freedoms) == (plain.freedoms, 6)
        assert set(written.drivable) == set(plain.drivable)
        for one, other in zip(plain.idle_motions, written.idle_motions, strict=True):
            assert set(one.parts) <= set(other.parts) and one.between == other.between


def rod_with(*joints: Joint) -> Mechanism:
    return Mechanism.build(fixed=["ground"], joints=[*rssr_linkage().all_joints, *joints])


def test_what_takes_another_part_along_is_not_idle():
    """A tool hinged to the rod goes round with it; a sleeve on the rod's line may stay, and a weld makes one body."""
    ends = [np.asarray(rssr_linkage().joints[name].frames_1)[0, :3, 3] for name in "BC"]
    tool = rod_with(revolute("tool", "rod", "tool", point=ends[0] + [5.0, 0, 0], axis=X))
    assert (tool.mobility().freedoms, tool.mobility().idle_motions) == (3, ())
    sleeve = rod_with(revolute("sleeve", "rod", "sleeve", point=ends[0], axis=ends[1] - ends[0]))
    assert [motion.parts for motion in sleeve.mobility().idle_motions] == [("rod",)]
    eye = rod_with(fixed("weld", "rod", "eye"))
    assert [motion.parts for motion in eye.mobility().idle_motions] == [("rod", "eye")]


def test_what_the_idle_coordinates_show_in_is_driven_only_if_nothing_else_will_do():
    """A platform on three rods between balls: every coordinate takes part in the spin of a rod."""
    random = np.random.default_rng(2)
    joints = [
        spherical(f"{end}{k}", *parts, point=point)
        for k in range(3)
        for end, parts, point in (
            ("a", ("ground", f"rod {k}"), random.normal(size=3)),
            ("b", (f"rod {k}", "platform"), random.normal(size=3) + [0, 0, 5.0]),
        )
    ]
    mechanism = Mechanism.build(fixed=["ground"], joints=joints)
    found = mechanism.mobility()
    assert (found.freedoms, found.idle_freedoms, found.useful) == (6, 3, 3)
    assert 3 <= len(found.drivable) <= 6
    assert not left_free(mechanism, found.drivable)


def hinge_pin(pin=cylindrical) -> Mechanism:
    """A four-bar with a loose pin at B, in a hole of the crank and one of the coupler."""
    bars = {joint.name: joint for joint in planar_fourbar().all_joints}
    place = np.asarray(bars["B"].frames_1)[0, :3, 3]
    holes = [pin("B1", "crank", "pin", point=place, axis=Z), pin("B2", "pin", "coupler", point=place, axis=Z)]
    return Mechanism.build(fixed=["ground"], joints=[bars["A"], *holes, bars["C"], bars["D"]])


def test_a_pin_in_two_holes_turns_and_slides():
    found = hinge_pin().mobility()
    assert [(motion.parts, motion.kind) for motion in found.idle_motions] == [(("pin",), "turns"), (("pin",), "slides")]
    assert (found.freedoms, found.drivable) == (3, ("A.phi",))
    assert "2 of them idle: pin turns between crank and coupler, pin slides between crank and coupler" in str(found)


def test_a_washer_between_two_plates_has_three_idle_freedoms():
    """A block on a slide, a washer between the block and the table below."""
    joints = [
        prismatic("slide", "table", "block", axis=X),
        planar("under", "table", "washer", normal=Z, point=(1.0, 2.0, 0)),
        planar("over", "washer", "block", normal=Z, point=(1.0, 2.0, 0.5)),
    ]
    found = Mechanism.build(fixed=["table"], joints=joints).mobility()
    assert [motion.kind for motion in found.idle_motions] == ["turns", "slides", "slides"]
    assert (found.freedoms, found.drivable) == (4, ("slide.z",))


def test_of_two_coaxial_parts_one_is_of_use():
    """A shaft, and a sleeve in its second bearing: one of them idles, whichever, and not both."""
    shaft, inner, outer = (
        revolute(name, *parts, point=(0, 0, z), axis=Z)
        for name, parts, z in (
            ("front", ("ground", "shaft"), 0.0),
            ("inner", ("shaft", "sleeve"), 1.0),
            ("outer", ("ground", "sleeve"), 1.0),
        )
    )
    found = Mechanism.build(fixed=["ground"], joints=[shaft, inner, outer]).mobility()
    assert (found.freedoms, found.idle_freedoms, found.useful) == (2, 1, 1)


def test_halves_joined_by_a_pin_that_is_held_float_together():
    """Only A and C slide: crank and coupler float along the pins as one, the hinge between them is carried along."""
    bars = {joint.name: joint for joint in planar_fourbar().all_joints}
    loose = {joint.name: joint for joint in planar_fourbar(pin=cylindrical).all_joints}
    joints = [loose["A"], bars["B"], loose["C"], bars["D"]]
    (motion,) = Mechanism.build(fixed=["ground"], joints=joints).mobility().idle_motions
    assert (motion.parts, motion.kind, motion.coordinates) == (("crank", "coupler"), "slides", ("A.z", "C.z"))


MANY = {
    "RSSR": rssr_linkage(),
    "Delta": catalogue.delta(),
    "hexapod": catalogue.hexapod(),
    "cylinders": planar_fourbar(pin=cylindrical),
    "pin": hinge_pin(),
    "hinges": as_hinges(rssr_linkage()),
    "Cassie": cassie_leg(),
    "Jansen": catalogue.jansen(),
}


@pytest.mark.parametrize("name", MANY)
def test_numbers_and_names_fit_together(name):
    """One phrase a freedom, the first eight of many; the coordinates are those that move."""
    mechanism = MANY[name]
    found = mechanism.mobility()
    assert found.idle_freedoms == len(found.idle_motions) == sum(len(idle.rates) for idle in rates_of(mechanism))
    if found.idle_motions:
        first, *lines = str(found).splitlines()
        assert f"{found.idle_freedoms} of them idle" in first
        assert all(any(str(motion) in line for line in [first, *lines]) for motion in found.idle_motions[:8])
        assert len(first) < 160, "long names have lines of their own"
    assert {name for motion in found.idle_motions for name in motion.coordinates} == set(found.idle)
    assert not set(found.drivable) & set(found.idle)


@pytest.mark.parametrize("name", MANY)
def test_idle_motions_keep_the_loops_closed_and_rest_elsewhere(name):
    mechanism = MANY[name]
    for found, idle in zip(loop_freedoms(mechanism.linkage), rates_of(mechanism), strict=True):
        np.testing.assert_allclose(found.jacobian @ idle.rates.T, 0.0, atol=1e-9)  # Jacobians with entries near 1
        moving = {part for motion in idle.motions for part in motion.parts}
        resting = [k for k, (joint, _) in enumerate(found.columns) if not moving & set(found.ends[joint])]
        np.testing.assert_array_equal(idle.rates[:, resting], 0.0)


@pytest.mark.parametrize("name", ["hexapod", "cylinders", "hinges"])
def test_the_basis_of_the_motions_does_not_matter(name):
    mechanism = MANY[name]
    before = [idle.motions for idle in rates_of(mechanism)]
    for found in loop_freedoms(mechanism.linkage):
        mix = np.linalg.qr(np.random.default_rng(3).normal(size=[len(found.motions)] * 2))[0]
        found.__dict__["_decomposed"] = found.rank, mix @ found.motions
        found.__dict__.pop("motions")
    assert [idle.motions for idle in rates_of(mechanism)] == before


def test_the_body_that_carries_the_loops_is_known():
    mechanism = leg()
    (found,) = loop_freedoms(mechanism.linkage)
    assert BodyGraph(mechanism.linkage, found).carrier == "hip"


def test_of_many_parts_that_move_idly_together_the_first_are_named():
    motion = IdleMotion(tuple(f"screw {k}" for k in range(40)), "slides", ("base", "lid"), ())
    assert str(motion).endswith("screw 4 + 35 more slide together between base and lid")
