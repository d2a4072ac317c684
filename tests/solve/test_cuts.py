"""Loops cut at a ball against the same loops whole, and rods without spin against trying all spins."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from jaxkin.joints.pairs import revolute, spherical
from jaxkin.linkage.loop_class import LoopClass
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.closure.closure import closure, scaled_geometry
from jaxkin.solve.closure.rod_spin import remove_spin_from_rotations, turn_between
from jaxkin.solve.execution.programs import solve
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import ClosureTolerance, Status
from jaxkin.solve.system.chain_tables import ChainRow, chain_tables
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import assembled, retract
from reference.catalogue import delta, hexapod
from reference.mechanisms import ball_in_bore, rssr_linkage
from reference.systems import loop_system


def systems(mechanism, drive, **changed):
    """The one structure element of a mechanism, cut and whole, and its joints; in space, also what keeps to a plane."""
    cut, joints = loop_system(mechanism, [(name, 0) for name in drive], decoupled_plane=None, **changed)
    return cut, cut.uncut, joints


def test_a_cut_leaves_three_equations_and_takes_three_unknowns_at_a_rod_one_and_six():
    cut, whole, _ = systems(ball_in_bore(), ["A"])
    assert (whole.equations, len(whole.used)) == (6, 5) and (cut.equations, len(cut.used)) == (3, 2)
    cut, whole, _ = systems(rssr_linkage(), ["A"])
    assert (whole.equations, len(whole.used)) == (6, 7) and (cut.equations, len(cut.used)) == (1, 1)
    # of six legs one stays as it is, to say where the platform is
    cut, whole, _ = systems(hexapod(), [f"leg {i}" for i in range(6)])
    assert (whole.equations, len(whole.used)) == (30, 36) and (cut.equations, len(cut.used)) == (5, 6)


def test_chains_with_the_same_rows_are_one_of_the_distinct():
    """Of a platform on six legs five rods are closed through the sixth: one chain, and one through each of them."""
    table = chain_tables(systems(hexapod(), [f"leg {i}" for i in range(6)])[0])
    assert (len(table.same_rows_as), len(table.distinct)) == (10, 6)
    for chain, number in enumerate(table.same_rows_as):
        first = table.distinct[number]
        for name in ChainRow._fields:
            np.testing.assert_array_equal(getattr(table, name)[:, chain], getattr(table, name)[:, first])
    assert (
        len(
            {
                int(table.begin[chain])
                for chain in np.flatnonzero(np.bincount(table.same_rows_as)[table.same_rows_as] > 1)
            }
        )
        == 5
    )
    alone = chain_tables(systems(rssr_linkage(), ["A"])[0])
    assert [*alone.distinct] == [*alone.same_rows_as] == [0, 1]


def test_only_balls_of_one_loop_that_nothing_drives_are_cut():
    cut, _, _ = systems(delta(), [f"motor {i}" for i in range(3)])
    inside = [{ball for joint, _ in loop for *_, ball in cut.chains[joint]} for loop in cut.loops]
    rods = {(one, other) for one, other, *_ in cut.spins}
    for number, balls in enumerate(cut.cuts):
        others = set().union(*inside[:number], *inside[number + 1 :])
        assert inside[number] >= set(balls) and others.isdisjoint(balls)
        assert len(balls) < 2 or balls in rods
    assert {len(balls) for balls in cut.cuts} == {0, 2}
    for mechanism in (ball_in_bore(), rssr_linkage()):
        driven, _, _ = systems(mechanism, ["A"])
        ball, *_ = driven.cuts[0]
        free = LoopSystem(driven.movements, driven.loops, driven.balls[ball], driven.loop_class)
        assert ball not in free.cuts[0] and len(free.cuts[0]) == len(driven.cuts[0]) - 1


@pytest.mark.long
def test_a_loop_whose_only_unknowns_are_those_of_a_cut_ball_is_followed():
    """There is no block of equations to solve, and no determinant: the ball turns back what the arm turns."""
    mechanism = Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("A", "ground", "arm", point=(0, 0, 0), axis=(0, 0, 1)),
            spherical("S", "arm", "ground", point=(0, 0, 1)),
        ],
    )
    angle = np.linspace(0.0, 3.0, 5)
    motion = mechanism.sweep({"A": angle}, throw=True)
    np.testing.assert_allclose(motion.coordinates["S"], [(0, 0, -a) for a in angle], atol=1e-14)


@pytest.mark.long
@pytest.mark.parametrize(
    "make, drive, spins",
    [(rssr_linkage, {"A": 3.0}, True), (rssr_linkage, {"A": 3.0}, False), (ball_in_bore, {"A": 3.0}, True)]
    # legs of one platform are closed the same way, through one of them
    + [(hexapod, {f"leg {i}": 0.02 * (i - 3) ** 2 for i in range(6)}, True)]
    + [pytest.param(delta, {"motor 0": 0.2, "motor 1": -0.1, "motor 2": 0.15}, True, marks=pytest.mark.study)],
)
def test_cut_loops_move_as_whole_ones_do(make, drive, spins):
    """The same displacements of all joints; without spins taken out, of all but the balls of the rods."""
    mechanism = make()
    cut, whole, joints = systems(mechanism, drive, **({} if spins else {"spins": ()}))
    range_ = np.linspace(0.0, 1.0, 32)
    inputs = jnp.asarray([upto * range_ for upto in drive.values()])
    tolerance = ClosureTolerance(np.asarray(1e-12), np.asarray(0.0))
    one, other = (solve(system, SolverOptions(), joints, inputs, tolerance) for system in (cut, whole))
    for _, outcome in (one, other):
        assert np.all(np.asarray(outcome.status) == Status.CLOSED.value)
    turning = {column for columns in cut.balls for column in columns}
    compared = [column for column in range(cut.columns) if spins or column not in turning]
    # residuals of 1e-15 over singular values of some 0.1, lengths of some 100
    np.testing.assert_allclose(np.asarray(one[0])[compared], np.asarray(other[0])[compared], atol=1e-11)


@pytest.mark.parametrize(
    "make, drive",
    [
        (ball_in_bore, ["A"]),
        pytest.param(rssr_linkage, ["A"], marks=pytest.mark.long),
        pytest.param(hexapod, ["leg 0", "leg 3"], marks=pytest.mark.long),
    ],
)
def test_the_jacobian_of_a_cut_loop_is_the_derivative_of_its_residual(make, drive):
    cut, _, joints = systems(make(), drive)
    geometry, _ = jax.jit(scaled_geometry, static_argnums=0)(cut, joints)
    rng = np.random.default_rng(3)
    away = 0.3 * rng.normal(size=(cut.columns, 1))
    state = jax.jit(lambda away: retract(cut, assembled(cut, 1, jnp.float64), away))(away)
    along = jnp.asarray(rng.normal(size=(cut.columns, 1)))

    def residual(t):
        return closure(cut, geometry, retract(cut, state, t * along)).residual[:, 0]

    found = jax.jit(closure, static_argnums=0)(cut, geometry, state).jacobian[..., 0] @ along[:, 0]
    # anywhere, not only where the loop closes: the rows are of a point, or of the way between two
    np.testing.assert_allclose(found, jax.jit(jax.jacfwd(residual))(0.0), atol=1e-14)


@pytest.mark.long
def test_of_two_directions_one_is_turned_into_the_other():
    """Right angles, opposites and all between; the turn and its derivative are finite."""
    rng = np.random.default_rng(7)
    one = np.concatenate([np.eye(3), -np.eye(3), rng.normal(size=(40, 3))])
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    near = one + 1e-9 * rng.normal(size=one.shape)
    for other in (one, -one, near, -near, np.roll(one, 1, axis=1), rng.normal(size=one.shape)):
        other = other / np.linalg.norm(other, axis=1, keepdims=True)
        turn = np.asarray(jax.jit(turn_between)(3.0 * one.T, 0.1 * other.T))
        # products of a few numbers below one, each right to 1e-16
        np.testing.assert_allclose(np.einsum("crp,pc->pr", turn, one), other, atol=2e-15)
        np.testing.assert_allclose(
            np.einsum("crp,drp->pcd", turn, turn), np.tile(np.eye(3), (len(one), 1, 1)), atol=2e-15
        )
        np.testing.assert_allclose(np.linalg.det(turn.T), 1.0, atol=2e-15)
        slope = jax.jit(partial(jax.jvp, turn_between))((one.T, other.T), (np.ones((3, len(one))),) * 2)[1]
        assert np.all(np.isfinite(slope))


@pytest.mark.parametrize("sides", [(1, -1), (1, 1), (-1, -1)])
def test_rods_are_spun_to_where_their_balls_turn_least(sides):
    system = LoopSystem(
        (("T_theta_phi_psi",), ("T_theta_phi_psi",)), (((0, 1), (1, 1)),), (), LoopClass(spins=((0, 1, *sides),))
    )
    rng = np.random.default_rng(5 + sum(sides))
    turns = Rotation.random(2, rng)
    lines = rng.normal(size=(2, 3))
    lines /= np.linalg.norm(lines, axis=1, keepdims=True)

    def spun(phi):
        both = (Rotation.from_rotvec(phi * line) for line in lines)
        return [t * s if side > 0 else s * t for t, s, side in zip(turns, both, sides, strict=True)]

    def turned(rotations):
        return sum(1 - r.as_quat()[3] ** 2 for r in rotations)

    least = min(turned(spun(phi)) for phi in np.linspace(-np.pi, np.pi, 2001))
    given = {ball: jnp.asarray(turn.as_matrix())[..., None] for ball, turn in enumerate(turns)}
    found = jax.jit(remove_spin_from_rotations, static_argnums=0)(system, jnp.asarray(lines)[None], given)
    rested = [Rotation.from_matrix(np.asarray(found[ball])[..., 0]) for ball in (0, 1)]
    # the best of 2001 is off by (pi / 1000)^2 at most, and never better
    assert least - 1e-5 < turned(rested) <= least + 1e-14
    for ball in (0, 1):  # and nothing but a spin was added
        changed = (turns[ball].inv() * rested[ball]) if sides[ball] > 0 else (rested[ball] * turns[ball].inv())
        np.testing.assert_allclose(np.cross(changed.as_rotvec(), lines[ball]), 0.0, atol=1e-14)


@pytest.mark.long
def test_a_rod_that_is_too_short_is_told_from_one_that_was_not_closed():
    """The rocker driven beyond where crank and rod reach, to either side: the least residual is found there."""
    motion = rssr_linkage().sweep({"D": np.linspace(-np.pi, np.pi, 65)})
    status = np.asarray(motion.status)
    assert {Status.CLOSED.value, Status.UNREACHABLE.value} <= set(status)
    assert Status.STALLED.value not in status  # on the other side it is closed again, but JUMPED
    residual = np.asarray(motion.residual)
    assert np.max(residual[status == Status.CLOSED.value]) < 1e-14 < 1e-3 < np.max(residual)
