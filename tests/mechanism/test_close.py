"""Mechanisms whose given pose is open: told as such, and closed without a drive."""

from dataclasses import astuple

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.joints.pairs import revolute
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.open_loops import opening
from reference.catalogue import delta, hexapod
from reference.mechanisms import cam, cardan_shafts, planar_fourbar, rssr_linkage
from reference.open_poses import assert_same_lengths, pushed, rounded
from reference.planar import fourbar

Array = np.ndarray


OPEN = {
    "four-bar, lengths changed": lambda: planar_fourbar().with_lengths({("coupler", "B", "C"): 125.0}),
    "four-bar, a gap of 4 mm": lambda: pushed(planar_fourbar(), ("rocker", "C"), (3.0, -2.5, 0.0)),
    "RSSR, a gap of 20 mm": lambda: pushed(rssr_linkage(), ("rod", "C"), (10.0, -15.0, 9.0)),
    "delta, a gap of 40 mm": lambda: pushed(delta(), ("platform", "wrist forearm 1+"), (0.0, 4.0, 40.0)),
    "hexapod, a gap of 30 mm": lambda: pushed(hexapod(), ("platform", "top 2"), (20.0, -10.0, 20.0)),
    "cam": lambda: pushed(cam(), ("follower", "touch"), (0.0, 0.7, 0.0)),
}


LONG = [name for name in OPEN if name.startswith(("delta", "hexapod"))]


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in LONG)) for name in OPEN])
def test_an_open_pose_is_told_and_closed(name):
    mechanism = OPEN[name]()
    first, told = mechanism.all_joints[0], str(mechanism)
    assert "Not closed in this pose: the loop over" in told and "is open by" in told and "mechanism.close()" in told
    found = mechanism.close()
    assert found.closed and found.residual < 1e-12 < found.residual_before
    assert opening(found.mechanism.linkage) is None
    assert all(np.array_equal(joint.frames_1, joint.frames_2) for joint in found.mechanism.all_joints)
    # freedoms are those of the pose in which the loops close, whether it is assembled there or not
    freedoms = {each.mobility().freedoms for each in (mechanism, found.mechanism, mechanism_as_drawn(name))}
    assert len(freedoms) == 1 and f"Mobility: {freedoms.pop()} freedom" in told
    drive = [f"{first.name}.{first.coordinates[0]}"]
    assert str(mechanism.plan(drive)) == str(found.mechanism.plan(drive))
    assert_same_lengths(found.mechanism, mechanism)


def mechanism_as_drawn(name: str) -> Mechanism:
    drawn = {"four": planar_fourbar, "RSSR": rssr_linkage, "delta": delta, "hexapod": hexapod, "cam": cam}
    return next(build() for begin, build in drawn.items() if name.startswith(begin))


def test_a_closed_mechanism_stays_where_it_is():
    found = planar_fourbar().close()
    assert found.closed and not any(move.length or move.angle for move in found.moves.values())
    assert "closed as given" in str(found)
    assert all(
        np.array_equal(one.frames_1, other.frames_1)
        for one, other in zip(found.mechanism.all_joints, planar_fourbar().all_joints, strict=True)
    )


@pytest.mark.parametrize(
    "call",
    [
        "jk.limits({}, 'A')",
        "jk.assembly_modes({}, drive)",
        "jk.workspace({}, grid, 'coupler', (0, 0, 0))",
        "{}.mobility()",
        "{}.plan(['A'])",
    ],
)
def test_what_is_advised_of_an_open_pose_can_be_called(call):
    """Numbers of six digits keep the loops from closing; `close` takes that for what it is."""
    mechanism, drive = rounded(OPEN["four-bar, a gap of 4 mm"](), 6), {"A": 0.3}
    names = {"jk": jk, "mechanism": mechanism, "drive": drive, "grid": {"A": [0, 1], "D": [0, 1]}}
    with pytest.raises(ValueError, match=r"cannot be assembled: .* the loop over .* is open by") as said:
        eval(call.format("mechanism"), names)
    advised = str(said.value).rpartition("write ")[2]
    assert advised.startswith(call.partition("{")[0] + "mechanism.close().mechanism")
    if "..." not in advised:
        assert str(eval(advised, names))


def test_the_pose_is_the_one_that_sweeps_begin_from():
    """A drive of zero, the trick of before, with the input that `close` found; then the same motion, counted anew."""
    mechanism = OPEN["four-bar, a gap of 4 mm"]()
    closed = mechanism.close().mechanism
    begin = angle_between(mechanism.joints["A"].frames_1[0], closed.joints["B"], mechanism.joints["B"])
    angles = np.linspace(-0.4, 0.4, 5)
    again = mechanism.sweep({"A": begin + angles})
    motion = closed.sweep({"A": angles})
    assert np.all(motion.closed) and np.all(again.closed)
    found = np.asarray(again.coordinates["D"] - again.coordinates["D"][2])
    np.testing.assert_allclose(motion.coordinates["D"] - motion.coordinates["D"][2], found, atol=1e-11)


def angle_between(frame: Array, now, then) -> float:
    """By how much the pin of the crank has been turned about the crank's axis."""
    x, y = (frame[:3, k] for k in (0, 1))
    there, here = (joint.frames_1[0, :3, 3] - frame[:3, 3] for joint in (now, then))
    turned = np.arctan2(there @ y, there @ x) - np.arctan2(here @ y, here @ x)
    return float(np.remainder(turned + np.pi, 2 * np.pi) - np.pi)


@pytest.mark.long
@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_what_is_found_depends_on_neither_place_nor_unit(scale):
    mechanism = OPEN["RSSR, a gap of 20 mm"]()
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_rotvec([0.3, -1.0, 0.7]).as_matrix()
    pose[:3, 3] = 40.0, -70.0, 25.0
    moved = []
    for joint in mechanism.all_joints:
        sides = []
        for side in (joint.frames_1, joint.frames_2):
            frames = pose @ side
            frames[:, :3, 3] *= scale
            sides.append(frames)
        moved.append(type(joint)(joint.name, joint.parts, joint.kind, joint.movements, *sides, joint.pitch))
    one, other = mechanism.close(), Mechanism(Linkage.of(moved, mechanism.structure)).close()
    assert other.residual_before == pytest.approx(one.residual_before)
    for part, move in one.moves.items():
        assert other.moves[part].angle == pytest.approx(move.angle, abs=1e-6)
        assert other.moves[part].length == pytest.approx(scale * move.length, abs=1e-6 * scale)


def test_moves_are_those_of_the_parts():
    """A rocker arm whose end is drawn a quarter turn away: it turns by what the law of cosines says."""
    found = OPEN["four-bar, a gap of 4 mm"]().close()
    assert found.moves["ground"].length == 0.0 and found.moves["ground"].angle == 0.0
    crank = found.moves["crank"]
    # the pin of the crank, 40 mm from its axis, moves along a chord
    assert crank.length == pytest.approx(2 * 40.0 * np.sin(crank.angle / 2))
    assert "moved: " in str(found) and "mm" not in str(found)  # no unit was given


def drawn_flat(tilt: float) -> Mechanism:
    """Norton's four-bar, whose two circuits are two assembly modes, drawn with coupler and rocker nearly in line."""
    mechanism, pin, pivot = planar_fourbar(), 40.0 * np.array([np.cos(1.0), np.sin(1.0), 0.0]), np.array([100.0, 0, 0])
    along = Rotation.from_rotvec([0.0, 0.0, tilt]).apply((pivot - pin) / np.linalg.norm(pivot - pin))
    points = {("coupler", "C"): pin + 120.0 * along, ("rocker", "C"): pivot + 80.0 * along}
    return mechanism.with_points(points)


@pytest.mark.long
def test_other_assembly_modes_are_tried():
    """Of the two modes between which the four-bar is drawn one is found, and some other starts lead to the other."""
    for tilt in (0.05, -0.05):
        found = drawn_flat(tilt).close()
        assert found.closed and found.others and "led to another assembly mode" in str(found)
        crank, pin = (found.mechanism.joints[name].frames_1[0, :3, 3] for name in "BC")
        angle = np.arctan2(crank[1], crank[0])
        modes = [fourbar(np.array([angle]), side=side).rocker_pin[0] for side in (1, -1)]
        here = [np.linalg.norm(pin[:2] - mode) for mode in modes]
        assert min(here) < 1e-9 < max(here)
        # no crank angle of the other circuit takes the pin of the rocker to where it is
        assert min(found.others) > 0.3
    far = pushed(planar_fourbar(), ("rocker", "C"), (0.01, 0.0, 0.0)).close()
    assert far.closed and not far.others and "no other assembly mode" in str(far)


@pytest.mark.long
@pytest.mark.parametrize(
    "mechanism",
    [
        # the elbow passes through the dead points: one circuit, on which other starts stand elsewhere
        pushed(planar_fourbar(), ("rocker", "C"), (0.0, -60.0, 0.0)),
        # rods and legs that only spin about themselves
        pushed(rssr_linkage(), ("rod", "C"), (40.0, -50.0, 30.0)),
        pushed(hexapod(), ("platform", "top 2"), (60.0, -40.0, 70.0)),
    ],
    ids=["non-Grashof four-bar", "RSSR", "hexapod"],
)
def test_poses_that_freedoms_lead_to_are_no_other_mode(mechanism):
    found = mechanism.close()
    assert found.closed and not found.others


@pytest.mark.parametrize(
    "name", ["four-bar, lengths changed", pytest.param("RSSR, a gap of 20 mm", marks=pytest.mark.long)]
)
def test_what_is_held_stays_as_by_a_drive_of_zero(name):
    """The crank stays as it is drawn; the rocker goes where a sweep that drives the crank by zero takes it."""
    mechanism = OPEN[name]()
    found, motion = mechanism.close(hold=["A"]), mechanism.sweep({"A": [0.0]})
    assert found.closed and max(astuple(found.moves["crank"])) < 1e-12  # rounding of products of frames
    assert found.moves["rocker"].angle == pytest.approx(abs(float(motion.coordinates["D"][0, 0])), abs=1e-9)
    with pytest.raises(ValueError, match=r"write hold=\['A'\]"):
        mechanism.close(hold="A")
    with pytest.raises(ValueError, match="no joint 'Q'"):
        mechanism.close(hold=["Q"])


@pytest.mark.long
def test_what_cannot_be_closed_says_which_loop():
    """A coupler of a tenth of its length; both cranks are too short to meet."""
    mechanism = planar_fourbar().with_lengths({("coupler", "B", "C"): 900.0})
    found = mechanism.close()
    assert not found.closed and found.mechanism is mechanism and found.left is not None
    assert set(found.left.joints) == set("ABCD") and found.residual > 0.1
    assert "cannot be closed from the given pose" in str(found) and "Mobility" not in str(mechanism)
    for what in (mechanism.mobility, lambda: mechanism.plan(["A"]), lambda: jk.limits(mechanism, "A")):
        with pytest.raises(ValueError, match=r"cannot be assembled: .*open by .* 'C'; give it lengths with which"):
            what()
    # a drive is not refused for what is not known: its poses say themselves what they are
    assert not np.any(mechanism.sweep({"A": np.linspace(0, 1, 3)}).closed)


@pytest.mark.long
def test_joints_with_several_axes_go_along():
    """A universal joint: the axis on part 1 stays there, the one on part 2 with part 2."""
    exact, lean = cardan_shafts(), (0.1, 0.2, 0.0)
    place = exact.joints["out"].frames_1[0, :3, 3]  # leans about the centre of the cross, as the shaft does
    found = pushed(exact, ("output", "out"), Rotation.from_rotvec(lean).apply(place) - place, lean).close()
    assert found.closed and found.moves["output"].angle > 0.1
    motion = found.mechanism.sweep({"in": np.linspace(-0.5, 0.5, 5)})
    assert np.all(motion.closed)


def test_traced_numbers_are_refused():
    with pytest.raises(ValueError, match="inside jit, vmap and grad sweep the mechanism"):
        jax.jit(lambda angle: hinge(angle).close().residual)(0.1)


def hinge(angle) -> Mechanism:
    axis = jnp.array([0.0, 0.0, 1.0]).at[1].set(angle)
    joints = [revolute(name, "ground", "arm", point=(0, 0, k), axis=axis) for k, name in enumerate("AB")]
    return Mechanism.build(fixed=["ground"], joints=joints)
