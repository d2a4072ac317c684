"""What is told of mechanisms with new lengths, such as limits, modes and plans: that of mechanisms built with these.

The assembled pose is open then. Displacements count from it all the same, as those of a sweep do: the crank of the
mechanism that is built anew stands at the same angle, and the joints behind it stand elsewhere.
"""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.assembly.wheels import wheels_last
from jaxkin.io.study_drives import can_drive
from jaxkin.mobility.open_loops import left_open, opening
from reference import planar
from reference.catalogue import fivebar, stephenson, watt
from reference.mechanisms import planar_fourbar, rssr_linkage, slider_crank

BARS = {
    "crank": ("crank", "A", "B"),
    "coupler": ("coupler", "B", "C"),
    "rocker": ("rocker", "C", "D"),
    "ground": ("ground", "A", "D"),
}
DRAWN = {"ground": 100.0, "crank": 90.0, "coupler": 60.0, "rocker": 60.0}


def changed(theta: float, **lengths: float) -> tuple[jk.Mechanism, jk.Mechanism]:
    """A four-bar that is given new lengths, and the one that is built with them."""
    new = DRAWN | lengths
    drawn = planar_fourbar(theta, **DRAWN)
    return drawn.with_lengths({BARS[name]: value for name, value in lengths.items()}), planar_fourbar(theta, **new)


def home_of(mechanism: jk.Mechanism, drive: str) -> dict[str, np.ndarray]:
    """Displacements of all joints where the drive is at zero."""
    motion = mechanism.sweep({drive: [0.0]})
    assert motion.closed.all()
    return {name: np.asarray(rows)[0] for name, rows in motion.coordinates.items()}


@pytest.mark.parametrize("lengths", [{"coupler": 70.0}, {"rocker": 50.0}, {"crank": 80.0, "ground": 95.0}])
def test_limits_are_those_of_the_mechanism_built_anew(lengths):
    new, built = changed(1.0, **lengths)
    found, expected = jk.limits(new, "A"), jk.limits(built, "A")
    # limits are found to 1e-13
    np.testing.assert_allclose(found.range, expected.range, rtol=0, atol=1e-12)
    assert found.upper.reason == expected.upper.reason and found.upper.kind is jk.LimitKind.LOCKS
    home = home_of(new, "A")
    for name, at in home.items():  # angles of joints count from where they were drawn
        there = np.asarray(expected.upper.coordinates[name])
        # the pose of a limit is right to the root of rounding
        np.testing.assert_allclose(found.upper.coordinates[name] - at, there, atol=1e-6)
    assert found.motion.closed.all() and np.asarray(found.motion.residual).max() < 1e-13
    np.testing.assert_allclose(found.motion.coordinates["C"][1], home["C"], atol=1e-12)


def test_ranges_of_joints_count_from_where_they_were_drawn():
    """A stop of the rocker stays where it is on the ground: 0.2 beyond its drawn angle, in the design as drawn.

    By the closed form of the rocker, which is at that angle where the crank is at the limit."""
    theta = 1.0
    drawn, lengths = planar.fourbar(np.array([theta])).rocker[0], {"coupler": 125.0}
    new = planar_fourbar(theta).with_lengths({BARS["coupler"]: 125.0})
    found = jk.limits(new, "A", ranges={"D": (-np.inf, 0.2)})
    for limit in (found.lower, found.upper):
        assert limit.kind is jk.LimitKind.RANGE and limit.coordinates["D"] == pytest.approx(0.2, abs=1e-12)
        at = planar.fourbar(np.array([theta + limit.value]), **lengths).rocker[0]
        assert at - drawn == pytest.approx(0.2, abs=1e-11)
    motion = new.sweep({"A": np.linspace(*found.range, 33)})
    assert motion.closed.all() and np.asarray(motion.coordinates["D"]).max() < 0.2 + 1e-11
    # and of a mechanism assembled in the closed pose they count from there
    again = jk.limits(new.close(hold=["A"]).mechanism, "A", ranges={"D": (-np.inf, 0.2 - home_of(new, "A")["D"][0])})
    np.testing.assert_allclose(again.range, found.range, rtol=0, atol=1e-11)


def test_full_turns_are_full_turns():
    assert jk.limits(planar_fourbar().with_lengths({BARS["coupler"]: 125.0}), "A").full_turn
    gone = jk.limits(planar_fourbar().with_lengths({BARS["coupler"]: 125.0}), "A", ranges={"B": (-9.0, np.inf)})
    assert gone.upper.coordinates["B"] == pytest.approx(-9.0, abs=1e-9) and gone.lower.value == -np.inf


def test_a_crank_that_cannot_stand_where_it_was_drawn_begins_where_it_can():
    """A coupler of a third: the crank was drawn beyond the range of the design, by the law of cosines."""
    new = planar_fourbar(1.0, **DRAWN).with_lengths({BARS["coupler"]: 20.0})
    found = jk.limits(new, "A")
    cosines = [(100.0**2 + 90.0**2 - reach**2) / (2 * 100.0 * 90.0) for reach in (40.0, 80.0)]
    angles = np.arccos(cosines)
    np.testing.assert_allclose(found.range, angles - 1.0, rtol=0, atol=1e-12)
    assert found.upper.value < 0  # not even 0 is within
    inside = np.linspace(*found.range, 9)[1:-1]
    assert new.sweep({"A": inside}).closed.all()
    with pytest.raises(
        ValueError, match=r"the pose in which the loops close, -0\.\d+, is not in the range -0.1 to 1 of A.phi"
    ):
        jk.limits(new, "A", ranges={"A": (-0.1, 1.0)})


@pytest.mark.parametrize("make", [slider_crank, watt, stephenson, rssr_linkage])
@pytest.mark.parametrize("share", [0.9, 1.15])
def test_other_linkages_as_when_they_are_assembled_in_the_closed_pose(make, share):
    """Limits of the last joint at the ground, which locks, and freedoms and plan of the first one."""
    mechanism = make()
    key = next(key for key in mechanism.lengths if len(key) == 3 and key[0] not in mechanism.fixed)
    new = mechanism.with_lengths({key: share * float(mechanism.lengths[key])})
    drive = mechanism.all_joints[0].full_names[0]
    closed = new.close(hold=[drive])
    assert closed.closed and closed.residual_before > 1e-3
    assert str(new.mobility()) == str(closed.mechanism.mobility()) and new.mobility().drivable
    assert str(new.plan([drive])) == str(closed.mechanism.plan([drive]))
    last = next(each for each in reversed(mechanism.all_joints) if set(each.parts) & {*mechanism.fixed}).full_names[0]
    joint, _, coordinate = last.rpartition(".")
    assert coordinate in mechanism.joints[joint].coordinates
    found, expected = jk.limits(new, last), jk.limits(closed.mechanism, last)
    size = 1.0 if coordinate == "phi" else 100.0
    shifted = np.array(expected.range) + closed.coordinates[joint][0]
    np.testing.assert_allclose(found.range, shifted, rtol=0, atol=1e-10 * size)


def test_inverse_is_driven_by_the_crank_alone():
    """As the mechanism that is built anew: a pose of the sweep is found again, by the displacement of its crank."""
    new, _ = changed(1.0, coupler=70.0)
    motion = new.sweep({"A": [0.25]})
    found = jk.inverse(new, {jk.point("coupler", (60.0, 80.0, 0.0)): motion.points("coupler", (60.0, 80.0, 0.0))})
    assert [*found.motion.inputs] == ["A.phi"] == [*new.mobility().drivable]
    # errors up to 1e-9 of the size are reached
    np.testing.assert_allclose(found.motion.inputs["A.phi"], 0.25, atol=1e-8)


def test_what_drives_is_known_where_the_loops_can_be_closed():
    """As the command line and studies ask: with a coupler longer than all other bars nothing closes, or can drive."""
    new, built = changed(1.0, coupler=70.0)
    assert opening(new.linkage) is not None and left_open(new.linkage) is None
    assert wheels_last(new) == wheels_last(built) == ("A.phi",) and can_drive(new, ["D.phi"])
    gone = planar_fourbar(1.0).with_lengths({BARS["coupler"]: 300.0})
    assert "the loop over D, C, B, A is open by" in str(left_open(gone.linkage))
    assert wheels_last(gone) == () and not can_drive(gone, ["A.phi"])
    # all coordinates are inputs then, and no pose closes
    found = jk.inverse(gone, {jk.point("crank", (0.0, 0.0, 0.0)): np.zeros((1, 3))})
    assert len(found.motion.inputs) == 4 and not found.motion.closed.any()


@pytest.mark.long
def test_modes_are_those_of_the_mechanism_built_anew():
    """Signs and places of the coupler, and the pose to which the drive leads is the first one."""
    new, built = changed(1.0, coupler=70.0)
    for drive in ({"A": 0.0}, {"A": -0.4}):
        found, expected = jk.assembly_modes(new, drive), jk.assembly_modes(built, drive)
        assert found.complete and found.assembled and found.signs == expected.signs and len(found) == 2
        for motion in (found.motion, expected.motion):
            assert np.asarray(motion.residual).max() < 1e-13
        places = [np.asarray(each.transforms["rocker"]) for each in (found.motion, expected.motion)]
        home = np.asarray(new.sweep({"A": [0.0]}).transforms["rocker"])[0]
        np.testing.assert_allclose(places[0], places[1] @ home, atol=1e-11)
        other = found[1].mechanism()
        assert other.sweep({"A": [0.0]}).closed.all() and other.lengths == pytest.approx(new.lengths, abs=1e-9)


@pytest.mark.long
def test_a_workspace_is_that_of_the_mechanism_assembled_in_the_closed_pose():
    mechanism = fivebar()
    new = mechanism.with_lengths({("b", "B", "C"): 1.2 * float(mechanism.lengths["b", "B", "C"])})
    grid = {"A": np.linspace(-1, 1, 9), "E": np.linspace(-1, 1, 9)}
    closed = new.close(hold=["A", "E"]).mechanism
    found, expected = (jk.workspace(each, grid, "a", (0.0, 0.0, 0.0)) for each in (new, closed))
    np.testing.assert_array_equal(found.status, expected.status)
    assert 0 < found.reached.sum() < found.reached.size
    limits = jk.singularities(found).values, jk.singularities(expected).values
    assert len(limits[0]) > 5
    np.testing.assert_allclose(*limits, atol=1e-10)
    with pytest.raises(ValueError, match=r"with A.phi, E.phi at 0 the loops cannot be closed: .*, the loop over"):
        jk.workspace(mechanism.with_lengths({("b", "B", "C"): 0.4}), grid, "a", (0.0, 0.0, 0.0))
