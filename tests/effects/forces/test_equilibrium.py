"""Equilibria against closed forms, to 1e-9: 1e-12 of the range is refined, and the force is exact to rounding."""

import jax
import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.effects.forces.vanishing import refined_sign_changes
from reference.energies import FOURBAR_MASSES, fourbar
from reference.mechanisms import Z, planar_fourbar
from reference.planar import fourbar as fourbar_angles

TURN = np.linspace(0, 2 * np.pi, 73)


def askew(turn: np.ndarray) -> jk.Mechanism:
    """The planar four-bar, turned in space."""
    joints = [
        jk.revolute(each.name, *each.parts, point=turn @ each.frames_1[0][:3, 3], axis=turn @ Z)
        for each in planar_fourbar().all_joints
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints, unit="mm")


def pendulum() -> jk.Mechanism:
    hinge = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z)
    return jk.Mechanism.build(fixed=["base"], joints=[hinge], unit="m")


@pytest.mark.long
def test_a_pendulum_hangs_or_stands():
    mechanism = pendulum()
    own = jk.masses(mechanism, given={"arm": jk.Mass(2.0, (0.3, 0.4, 0.0))})
    found = jk.equilibrium(mechanism, {"A": np.linspace(-3.0, 3.0, 25)}, own, gravity=(0, -9.81, 0))
    start = np.arctan2(0.4, 0.3)
    np.testing.assert_allclose(found.values, [-np.pi / 2 - start, np.pi / 2 - start], atol=1e-9)
    assert found.stable.tolist() == [True, False] and found.unstable.tolist() == [False, True]
    assert found.name == "A.phi" and "2 equilibria of A.phi from -3 to 3 rad" in str(found) and "unstable" in str(found)
    np.testing.assert_allclose(found.motion.inputs["A.phi"], found.values)


def test_friction_has_no_equilibria_and_the_advice_finds_where_it_holds():
    """A pendulum stays where |m g l cos| is at most mu r times the force in its hinge, which is its weight."""
    mechanism, friction = pendulum(), jk.joint_friction("A", 0.2, radius=0.5)
    own = jk.masses(mechanism, given={"arm": jk.Mass(2.0, (0.5, 0.0, 0.0))})
    given = {"masses": own, "gravity": (0, -9.81, 0), "applied": friction}
    with pytest.raises(ValueError, match="friction in 'A' has no direction at rest"):
        jk.equilibrium(mechanism, {"A": np.linspace(0.0, 3.0, 25)}, **given)
    inputs = np.linspace(0.0, 3.0, 301)
    motion = mechanism.sweep({"A": inputs})
    up, down = (jk.drive_forces(motion, rates={"A": rate}, **given).forces["A.phi"] for rate in (1e-6, -1e-6))
    held = np.asarray(up) * np.asarray(down) < 0
    np.testing.assert_array_equal(held, np.abs(0.5 * np.cos(inputs)) < 0.2 * 0.5)


@pytest.mark.long
def test_a_freedom_without_a_drive_is_told_or_held():
    """A double pendulum bent by a right angle: where its first hinge needs no torque, the second one would move.

    V = m g (3/2 sin a + 1/2 cos(a + b)) for arms of one metre and bodies of one kilogram.
    """
    hinges = [
        jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "arm", "hand", point=(1, 0, 0), axis=Z),
    ]
    mechanism = jk.Mechanism.build(fixed=["base"], joints=hinges, unit="m")
    own = jk.masses(mechanism, given={"arm": jk.Mass(1.0, (0.5, 0, 0)), "hand": jk.Mass(1.0, (1, 0.5, 0))})
    turns, weight = {"A": np.linspace(-3.0, 3.0, 25)}, (0, -9.81, 0)
    alone = jk.equilibrium(mechanism, turns, own, gravity=weight)
    expected = [np.arctan(3.0) - np.pi, np.arctan(3.0)]
    np.testing.assert_allclose(alone.values, expected, atol=1e-9)
    np.testing.assert_allclose(alone.out_of_balance["B.phi"], 9.81 / 2 * 3 / np.sqrt(10), rtol=1e-9)
    assert not alone.stable.any() and not alone.unstable.any()
    assert "but no equilibria of the mechanism" in str(alone) and "{'A.phi': ..., 'B.phi': 0.0}" in str(alone)
    held = jk.equilibrium(mechanism, turns | {"B": 0.0}, own, gravity=weight)
    np.testing.assert_allclose(held.values, expected, atol=1e-9)
    assert held.stable.tolist() == [True, False] and not held.out_of_balance


@pytest.mark.long
@pytest.mark.parametrize("poses", [2, 3, 11])
def test_equilibria_at_the_poses_of_the_range_are_found(poses):
    """The weight has no lever at -pi/2 and pi/2, where rounding leaves some 1e-16 of it, and one between."""
    mechanism = pendulum()
    own = jk.masses(mechanism, given={"arm": jk.Mass(1.0, (1.0, 0.0, 0.0))})
    found = jk.equilibrium(mechanism, {"A": np.linspace(-np.pi / 2, np.pi / 2, poses)}, own, gravity=(0, -9.81, 0))
    np.testing.assert_allclose(found.values, [-np.pi / 2, np.pi / 2], atol=1e-9)
    assert found.stable.tolist() == [True, False] and len(found.indifferent) == 0


@pytest.mark.long
def test_a_spring_against_a_weight(tmp_path):
    """k q = m g r cos(q), stable; and with a soft spring there may be none in the range."""
    mechanism = pendulum()
    own = jk.masses(mechanism, given={"arm": jk.Mass(2.0, (0.5, 0.0, 0.0))})
    given = {"gravity": (0, -9.81, 0), "applied": jk.joint_spring("A", 4.0)}
    found = jk.equilibrium(mechanism, {"A": np.linspace(-1.5, 1.0, 7)}, own, **given)
    expected = brentq(lambda q: 4.0 * q + 2 * 9.81 * 0.5 * np.cos(q), -1.5, 0.0, xtol=1e-14)
    np.testing.assert_allclose(found.values, [expected], atol=1e-9)
    assert found.stable.tolist() == [True]
    assert found.plot(tmp_path / "equilibrium.png").stat().st_size > 10_000
    assert found.save(tmp_path / "equilibrium.csv").read_text().splitlines()[0] == 'pose,"A.phi [rad]","stable"'
    none = jk.equilibrium(mechanism, {"A": np.linspace(0.0, 1.0, 7)}, own, **given)
    assert len(none.values) == 0 and str(none) == "No equilibrium of A.phi from 0 to 1 rad"
    none.plot(tmp_path / "none.png")


@pytest.mark.long
def test_a_fourbar_stands_where_its_potential_is_extreme():
    mechanism = fourbar()
    own = jk.masses(mechanism, given=FOURBAR_MASSES)
    found = jk.equilibrium(mechanism, {"A": TURN}, own, gravity=(0, -9.81, 0))

    def slope(q):
        """Derivative of the height of all masses, by the turns of the three parts from the closed form."""
        at, home = (fourbar_angles(np.array([angle])) for angle in (1.0 + q, 1.0))
        speeds = {
            "crank": 1.0,
            "coupler": 40 * np.sin(1.0 + q - at.rocker[0]) / (120 * np.sin(at.rocker[0] - at.coupler[0])),
            "rocker": 40 * np.sin(1.0 + q - at.coupler[0]) / (80 * np.sin(at.rocker[0] - at.coupler[0])),
        }
        turns = {"crank": q, "coupler": (at.coupler - home.coupler)[0], "rocker": (at.rocker - home.rocker)[0]}
        pins = {"crank": np.zeros(2), "coupler": home.crank_pin[0], "rocker": np.array([100.0, 0.0])}
        total = 0.0
        for part, mass in FOURBAR_MASSES.items():
            x, y = np.asarray(mass.centre)[:2] - pins[part]
            across = x * np.cos(turns[part]) - y * np.sin(turns[part])
            lifted = 40 * np.cos(1.0 + q) if part == "coupler" else 0.0
            total += mass.mass * (lifted + across * speeds[part])
        return total

    expected = [brentq(slope, value - 0.01, value + 0.01, xtol=1e-13) for value in found.values]
    assert len(expected) == 2 and found.stable.sum() == 1
    np.testing.assert_allclose(found.values, expected, atol=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("tilt", [0.0, 1.0])
def test_a_linkage_in_a_horizontal_plane_is_indifferent(tilt, tmp_path):
    """Also where it is drawn askew, so that rounding decides of what sign its forces are."""
    turn = Rotation.from_rotvec([tilt, 0.3 * tilt, 0.0]).as_matrix()
    mechanism = askew(turn)
    given = {name: jk.Mass(own.mass, turn @ own.centre) for name, own in FOURBAR_MASSES.items()}
    own = jk.masses(mechanism, given=given)
    found = jk.equilibrium(mechanism, {"A": np.linspace(0, 1, 11)}, own, gravity=turn @ [0.0, 0.0, -9.81])
    assert len(found.values) == 0 and found.indifferent.tolist() == [[0.0, 1.0]]
    assert "everywhere from 0 to 1" in str(found)
    assert found.save(tmp_path / "all.csv").read_text().splitlines()[1:] == ["0,0,nan", "1,1,nan"]
    found.plot(tmp_path / "all.png")


@pytest.mark.long
def test_beside_a_limit_it_is_not_known_whether_an_equilibrium_is_stable():
    """A crank that only rocks, whose torque vanishes so near to its limit that a pose beside it is beyond."""
    rocking = planar_fourbar(1.0, ground=40.0, crank=20.0, coupler=25.0, rocker=30.0)
    end = jk.limits(rocking, "A").upper.value
    spring = jk.joint_spring("A", 1.0, rest=end - 1e-9)
    found = jk.equilibrium(rocking, {"A": np.linspace(0.0, end - 1e-10, 20)}, applied=spring)
    np.testing.assert_allclose(found.values, [end - 1e-9], atol=1e-10)
    assert not found.stable[0] and not found.unstable[0] and "not known" in str(found)


@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
@pytest.mark.parametrize("poses", [25, 400])
def test_float32_finds_the_same(poses):
    """The force is off by some 1e-7 of itself, and its zeros by as much: 1e-5 allows for a hundred roundings."""
    with jax.enable_x64(False):
        own = jk.masses(pendulum(), given={"arm": jk.Mass(2.0, (0.3, 0.4, 0.0))})
        found = jk.equilibrium(pendulum(), {"A": np.linspace(-3.0, 3.0, poses)}, own, gravity=(0, -9.81, 0))
    start = np.arctan2(0.4, 0.3)
    np.testing.assert_allclose(found.values, [-np.pi / 2 - start, np.pi / 2 - start], atol=1e-5)
    assert found.stable.tolist() == [True, False]


def test_where_a_force_goes_to_infinity_it_does_not_vanish():
    """At 0.4 there is a pole, at 1.3 a zero; an end of the range may lie beside the pole as nearly as it likes."""
    ends = np.array([0.0, 0.4 - 1e-15, 1.0])
    values, vanishes = refined_sign_changes(
        lambda x: (x - 1.3) / (x - 0.4),
        ends,
        ends + 0.5,
        (ends - 1.3) / (ends - 0.4),
        (ends - 0.8) / (ends + 0.1),
        1e-12,
    )
    assert vanishes.tolist() == [False, False, True]
    np.testing.assert_allclose(values[2], 1.3, atol=1e-12)


def test_bad_ranges_are_refused():
    mechanism = planar_fourbar()
    with pytest.raises(ValueError, match="along one driven coordinate, got ranges of 2"):
        jk.equilibrium(mechanism, {"A": np.arange(3.0), "D": np.arange(3.0)})
    for given, got in ((np.zeros(1), "got 1"), (np.array([0.0, np.nan, 1.0]), "got some that are not finite")):
        with pytest.raises(ValueError, match=f"must be two displacements or more, all finite, .*{got}"):
            jk.equilibrium(mechanism, {"A": given})
    with pytest.raises(ValueError, match="at which 'D' is held must be one number, got none"):
        jk.equilibrium(mechanism, {"A": np.arange(3.0), "D": []})
    with pytest.raises(ValueError, match="nothing acts"):
        jk.equilibrium(pendulum(), {"A": np.linspace(0, 1, 3)})


def test_loads_with_one_row_a_pose_are_refused():
    """The poses of an equilibrium are sought, so that rows of a range belong to none of them."""
    angles = np.linspace(-3.0, 3.0, 25)
    own = jk.masses(pendulum(), given={"arm": jk.Mass(2.0, (0.3, 0.4, 0.0))})
    with pytest.raises(ValueError, match="the same in all poses, and JointLoad has load with one row a pose"):
        jk.equilibrium(pendulum(), {"A": angles}, own, applied=jk.joint_load("A", np.cos(angles)))


@pytest.mark.parametrize(
    ("applied", "told"),
    [(["weight"], "applied loads are made by jk.force"), (jk.joint_friction("A", 0.1, radius=0.1), "rates")],
)
def test_loads_that_are_none_are_told(applied, told):
    own = jk.masses(pendulum(), given={"arm": jk.Mass(2.0, (0.3, 0.4, 0.0))})
    with pytest.raises(ValueError, match=told):
        jk.equilibrium(pendulum(), {"A": np.linspace(-3.0, 3.0, 25)}, own, applied=applied)


@pytest.mark.long
def test_poses_of_which_nothing_is_known_are_told():
    """A rocker asked over its full turn moves over a part of it only: of the rest no equilibrium is denied."""
    mechanism = planar_fourbar()
    found = jk.equilibrium(mechanism, {"D": np.linspace(-3.0, 3.0, 9)}, applied=jk.joint_spring("D", 2.0, rest=9.0))
    unknown = int(np.sum(~np.asarray(mechanism.sweep({"D": np.linspace(-3.0, 3.0, 9)}).closed)))
    assert 0 < unknown < 9
    assert str(found) == (
        f"No equilibrium of D.phi from -3 to 3 rad; at {unknown} of its 9 poses, which are not closed, nothing is known"
    )


@pytest.mark.long
@pytest.mark.parametrize("tilt", [0.0, 1.0])
def test_loads_across_the_plane_of_a_linkage_leave_it_indifferent(tilt):
    """No force along its axes and no torque across them does any work, of whatever sign rounding is."""
    turn = Rotation.from_rotvec([tilt, 0.3 * tilt, 0.0]).as_matrix()
    mechanism = askew(turn)
    across = [
        jk.force("coupler", turn @ [60.0, 50.0, 0.0], turn @ [0.0, 0.0, 1000.0]),
        jk.torque("coupler", turn @ [1000.0, 0.0, 0.0]),
    ]
    for load in across:
        found = jk.equilibrium(mechanism, {"A": TURN}, applied=load)
        assert len(found.values) == 0 and found.indifferent.tolist() == [[0.0, TURN[-1]]]


@pytest.mark.long
@pytest.mark.parametrize("offset", [0.0, 1e4])
def test_an_arm_that_a_spring_balances_is_indifferent(offset):
    """A spring of no length from a point above the hinge: k a b = m g l balances the arm at every angle."""
    hinge = jk.revolute("A", "base", "arm", point=(offset, offset, 0), axis=Z)
    mechanism = jk.Mechanism.build(fixed=["base"], joints=[hinge], unit="mm")
    own = jk.masses(mechanism, given={"arm": jk.Mass(2.0, (offset + 200.0, offset, 0.0))})
    spring = jk.spring(
        "base", (offset, offset + 300.0, 0), "arm", (offset + 100.0, offset, 0), 2.0 * 9.81 * 0.2 / (0.3 * 0.1)
    )
    found = jk.equilibrium(mechanism, {"A": TURN}, own, gravity=(0, -9.81, 0), applied=spring)
    assert len(found.values) == 0 and found.indifferent.tolist() == [[0.0, TURN[-1]]]


@pytest.mark.long
def test_what_a_drive_does_not_move_hides_no_equilibrium():
    """A pendulum of a gram beside a thousand tonnes on a hinge that is held, a hundred metres away."""
    hinges = [
        jk.revolute("A", "base", "bob", point=(0, 0, 0), axis=Z),
        jk.revolute("E", "base", "block", point=(1e5, 0, 0), axis=Z),
    ]
    mechanism = jk.Mechanism.build(fixed=["base"], joints=hinges, unit="mm")
    own = jk.masses(mechanism, given={"bob": jk.Mass(1e-3, (1.0, 0, 0)), "block": jk.Mass(1e6, (1e5, 0, 0))})
    found = jk.equilibrium(mechanism, {"A": TURN, "E": 0.0}, own, gravity=(0, -9.81, 0))
    np.testing.assert_allclose(found.values, [np.pi / 2, 3 * np.pi / 2], atol=1e-9)
    assert found.stable.tolist() == [False, True] and len(found.indifferent) == 0


def test_where_rounding_hides_how_a_force_grows_it_is_not_known_whether_it_is_stable():
    """An arm that stands on a spring with k = m g l: the force grows by the third power of the angle."""
    own = jk.masses(pendulum(), given={"arm": jk.Mass(2.0, (0.0, 0.2, 0.0))})
    spring = jk.joint_spring("A", 2.0 * 9.81 * 0.2)
    found = jk.equilibrium(
        pendulum(), {"A": np.linspace(-1, 1, 22)}, own, gravity=(0, -9.81, 0), applied=(each for each in [spring])
    )
    # the third root of rounding
    np.testing.assert_allclose(found.values, [0.0], atol=1e-4)
    assert not found.stable[0] and not found.unstable[0]
