"""Project states of open loops onto the nearest closed poses, all poses at once, with derivatives.

Nearest means least `|W (x - y)|` over the coordinates `x` of closed poses, for given coordinates `y` and weights `W`;
the rotations of balls count by the angle between them. Each step solves the quadratic problem at the present state,

    delta = e - (J W^-1)^+ (r + J W^-1 e),    e = W (y - x),

whose limit is closed and stationary: `e` lies in the row space of the Jacobian. The steps shrink by a factor that is
about the distance over the radius of curvature of the closed poses. Where they do not settle, the damped corrector
closes the loops from the given state.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.solve.closure.closure import Geometry, closure, free_jacobian, scaled_geometry
from jaxkin.solve.closure.joint_coordinates import as_state, ball_rotations, joint_coordinates
from jaxkin.solve.correctors.levenberg_marquardt import MAX_DAMPED_STEP, levenberg_marquardt
from jaxkin.solve.correctors.problem import ClosureProblem
from jaxkin.solve.linear.least_norm import damping_floor, solve_least_norm, solve_least_norm_refined
from jaxkin.solve.lockstep import any_in_lockstep
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import ClosureTolerance, classify
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import Coordinates, State, is_driven, matrix, multiply, rate, retract, select_poses

MAX_NEWTON_STEPS = 40
"""Steps towards the nearest pose, at most. Random states of Cassie's loops, 0.3 rad to either side, settle in 14."""

CLOSED_SHARE = 0.1
"""Residual of a settled pose over the tolerance, at most: its last step changes nothing that could be seen in it."""

SETTLED = 1e-9
"""Length of a step, in radians or characteristic lengths, after which a closed pose counts as the nearest: the error
that is left is of the same size, a thousandth of what sensors of joints resolve."""


class NearestPoses(NamedTuple):
    """Closed poses nearest to given coordinates."""

    displacements: Coordinates
    """Of all joints, in radians and in the unit of the mechanism."""
    status: Int[Array, " poses"]
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""
    square: Float[Array, " poses"]
    """Squared weighted distance from the given coordinates, lengths over the characteristic length."""
    nearest: Bool[Array, " poses"]
    """Which poses are stationary: no closed pose beside them is nearer."""


def nearest_poses(
    system: LoopSystem,
    options: SolverOptions,
    joints: Joints,
    given: Float[Array, "columns poses"],
    weights: Float[Array, " columns"],
    tolerance: ClosureTolerance,
) -> NearestPoses:
    """Find the closed poses nearest to `given` coordinates, in radians and in the unit of the mechanism.

    Driven columns of the system keep their values. Balls at which loops are cut follow, and count nothing in the
    distance. `weights` are the factors of the differences of the columns.
    """
    geometry, lengths = scaled_geometry(system, joints)
    begun = as_state(system, joints.frames_1, joints.frames_2, given)
    begun = begun._replace(x=begun.x / lengths)
    fixed, start, factors = lax.stop_gradient((geometry, begun, weights))
    found = _search(ClosureProblem(system, fixed, options), start, factors, tolerance)
    state = _attach_derivative(system, geometry, begun, weights, found.state, found.settled)
    square = jnp.sum(_offset(system, begun, state, weights) ** 2, axis=0)
    rotations = ball_rotations(system, geometry, state)
    moved = joint_coordinates(system, joints.frames_1, joints.frames_2, state.x * lengths, rotations)
    return NearestPoses(moved, found.status, found.residual_norm, square, found.settled)


class _Found(NamedTuple):
    state: State
    status: Int[Array, " poses"]
    residual_norm: Float[Array, " poses"]
    settled: Bool[Array, " poses"]


class _Iterate(NamedTuple):
    count: Array
    state: State
    residual_norm: Float[Array, " poses"]
    settled: Bool[Array, " poses"]


def _search(
    problem: ClosureProblem, begun: State, weights: Float[Array, " columns"], tolerance: ClosureTolerance
) -> _Found:
    """Find the closed states nearest to those where the search has `begun`; nothing is to be differentiated."""
    system, geometry = problem.system, problem.geometry
    poses, dtype = begun.x.shape[-1], begun.x.dtype

    def running(at: _Iterate) -> Array:
        return (at.count < MAX_NEWTON_STEPS) & any_in_lockstep(~at.settled)

    def step(at: _Iterate) -> _Iterate:
        evaluation = closure(system, geometry, at.state)
        jacobian = free_jacobian(system, evaluation) / weights[:, None]
        off = _offset(system, begun, at.state, weights)
        right = evaluation.residual + jnp.sum(jacobian * off[None], axis=1)
        delta = off - solve_least_norm(jacobian, right, damping_floor(dtype), system.used)
        delta = delta / weights[:, None]
        length = jnp.sqrt(jnp.sum(delta * delta, axis=0))
        closes = evaluation.residual_norm <= CLOSED_SHARE * tolerance.max_residual
        settled = at.settled | (closes & (length <= SETTLED))
        shorter = MAX_DAMPED_STEP / jnp.maximum(length, MAX_DAMPED_STEP)
        delta = delta * jnp.where(settled, 0.0, shorter)
        norm = jnp.where(at.settled, at.residual_norm, evaluation.residual_norm)
        return _Iterate(at.count + 1, retract(system, at.state, delta), norm, settled)

    start = _Iterate(jnp.asarray(0), begun, jnp.full(poses, jnp.inf, dtype), jnp.zeros(poses, bool))
    last = lax.while_loop(running, step, start)
    yes = jnp.ones(poses, bool)

    def closed() -> _Found:
        """Close the loops of the poses that did not settle."""
        steps = jnp.where(last.settled, 0, problem.options.rescue_steps)
        other = levenberg_marquardt(problem, begun, steps, tolerance.target_residual)
        state, norm = select_poses(last.settled, (last.state, last.residual_norm), (other.state, other.residual_norm))
        status = classify(norm, other.stationary, yes, tolerance.max_residual)
        return _Found(state, status, norm, last.settled)

    def done() -> _Found:
        status = classify(last.residual_norm, yes, yes, tolerance.max_residual)
        return _Found(last.state, status, last.residual_norm, last.settled)

    return lax.cond(any_in_lockstep(~last.settled), closed, done)


def _offset(system: LoopSystem, begun: State, at: State, weights: Float[Array, " columns"]) -> Coordinates:
    """Compute `e`, the weighted displacement from a state to where it began; zero in columns that do not move."""
    off = begun.x - at.x
    for number, ball in enumerate(system.turned_balls):
        columns = system.balls[ball]
        if columns[0] in system.driven:
            continue
        turn = multiply(begun.turns[number], at.turns[number] * jnp.array([1.0, -1.0, -1.0, -1.0])[:, None])
        vector = _rotation_vector(turn)
        if len(columns) == 2:  # the line between two balls is turned about its own axes
            vector = jnp.einsum("jip,jp->ip", matrix(at.turns[number]), vector)[:2]
        off = off.at[np.array(columns)].set(vector)
    moves = np.isin(np.arange(system.columns), system.used)
    return jnp.where(moves[:, None], off * weights[:, None], 0.0)


def _rotation_vector(turn: Float[Array, "4 poses"]) -> Float[Array, "3 poses"]:
    """Compute the rotation vector of a unit quaternion, of at most half a turn."""
    turn = jnp.where(turn[0] < 0, -turn, turn)
    square = jnp.sum(turn[1:] ** 2, axis=0)
    small = square < 1e-12
    sine = jnp.sqrt(jnp.where(small, 1.0, square))  # sqrt has no derivative at zero: the other branch is the series
    factor = jnp.where(small, 2.0 + square / 3.0, 2.0 * jnp.arctan2(sine, jnp.where(small, 1.0, turn[0])) / sine)
    return factor * turn[1:]


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _attach_derivative(
    system: LoopSystem,
    geometry: Geometry,
    begun: State,
    weights: Float[Array, " columns"],
    found: State,
    settled: Bool[Array, " poses"],
) -> State:
    """Return the states that were found, with their derivatives where they settled; zero elsewhere."""
    del geometry, begun, weights, settled
    return found


@_attach_derivative.defjvp
def _nearest_jvp(system: LoopSystem, primals, tangents):
    """Differentiate `W e = J^T lambda, r = 0`.

    With `v` the displacement of the state it is `v = b - (J W^-1)^+ (J W^-1 b + dr)`, `b = v + de - d(J W^-1)^T lambda`
    where `de` and `dJ` depend on `v` again: a linear equation that is iterated as the states were. Driven columns move
    as they are given, which moves the loops as a change of the geometry does.
    """
    geometry, begun, weights, found, settled = primals
    state = _attach_derivative(system, geometry, begun, weights, found, settled)
    d_geometry, d_begun, d_weights, _, _ = tangents

    def over_weights(jacobian: Array, weights: Array) -> Array:
        return jacobian / weights[:, None]

    evaluation = closure(system, geometry, found)
    jacobian = over_weights(free_jacobian(system, evaluation), weights)
    floor = damping_floor(jacobian.dtype)
    off = _offset(system, begun, found, weights)
    # J^T lambda = e: lambda is the least-norm solution for the transposed system, (J J^T)^-1 J e
    multipliers = _multipliers(jacobian, off, floor)

    def parts(geometry: Geometry, begun: State, weights: Array, at: State):
        there = closure(system, geometry, at)
        rows = over_weights(free_jacobian(system, there), weights)
        return there.residual, _offset(system, begun, at, weights) - jnp.sum(rows * multipliers[:, None], axis=0)

    _, linear = jax.linearize(parts, geometry, begun, weights, found)
    held = _of_driven(system, d_begun)
    d_residual, fixed = linear(d_geometry, d_begun, d_weights, held)
    zeros = jax.tree.map(jnp.zeros_like, (geometry, begun, weights))

    def onward(v: Array, _: None) -> tuple[Array, None]:
        _, follows = linear(*zeros, rate(system, found, v / weights[:, None]))
        b = v + fixed + follows
        right = d_residual + jnp.sum(jacobian * b[None], axis=1)
        b = b - solve_least_norm_refined(jacobian, right, floor, system.used)
        return jnp.where(settled, b, 0.0), None

    v, _ = lax.scan(onward, jnp.zeros_like(off), None, length=MAX_NEWTON_STEPS)
    moves = rate(system, found, v / weights[:, None])
    d_state = jax.tree.map(jnp.add, moves, held)
    return state, jax.tree.map(lambda d: jnp.where(settled, d, 0.0), d_state)


def _of_driven(system: LoopSystem, d_begun: State) -> State:
    """Select of the tangent of a state that of its driven columns and balls; zero elsewhere."""
    balls = np.array([system.balls[ball][0] in system.driven for ball in system.turned_balls], bool)
    return State(jnp.where(is_driven(system), d_begun.x, 0.0), jnp.where(balls[:, None, None], d_begun.turns, 0.0))


def _multipliers(jacobian: Array, off: Array, floor: float) -> Array:
    """Find lambda of least norm with `J^T lambda = off`, for an offset in the row space of J."""
    rows = jnp.moveaxis(jacobian, -1, 0)
    return jnp.einsum("pec,cp->ep", jnp.linalg.pinv(rows.mT, rtol=floor**0.5), off)
