"""The damped corrector: brings poses onto closed loops by least-norm Gauss-Newton steps, many poses at once.

Levenberg-Marquardt with a damping that vanishes with the residual (Fan and Yuan 2005), so that convergence stays
quadratic where the Jacobian is singular but the equations consistent. A step that does not lessen the merit is refused
and the damping raised; each pose is accepted, refused and finished on its own.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax, tree
from jaxtyping import Array, Bool, Float, Int

from jaxkin.linkage.first_order import DOUBLE, SINGLE
from jaxkin.solve.closure.closure import Closure, Geometry, closure
from jaxkin.solve.execution.lockstep import any_in_lockstep
from jaxkin.solve.linear.least_norm import least_norm
from jaxkin.solve.status import Scalar
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, is_driven, retract

LONGEST_STEP = 0.5
"""Radians, or characteristic lengths: what a linear model of a rotation is good for."""
STAGNANT = 1e-9
"""Relative decrease of the merit in one step below which it has reached its least value."""


class Corrected(NamedTuple):
    state: State
    closure: Closure
    gap: Float[Array, " poses"]
    stationary: Bool[Array, " poses"]
    """The residual cannot be lessened any more to first order."""


class _Iterate(NamedTuple):
    count: Array
    state: State
    closure: Closure
    trust: Float[Array, " poses"]
    done: Bool[Array, " poses"]
    trial: State


def free_jacobian(system: LoopSystem, closed: Closure) -> Float[Array, "equations columns poses"]:
    """The Jacobian with zeros for what is given: least-norm steps leave that alone."""
    return jnp.where(is_driven(system), 0.0, closed.jacobian)


def floor(dtype) -> float:
    """Least damping, over the mean square of the rows of J: what it leaves out is what counts as zero for the rank."""
    return (DOUBLE if jnp.finfo(dtype).bits == 64 else SINGLE).rank ** 2


def correct(
    system: LoopSystem,
    geometry: Geometry,
    state: State,
    iterations: Int[Array, " poses"] | int,
    enough: Scalar | float = 0.0,
) -> Corrected:
    """Poses brought as near to closure as the damped steps get, or to a gap of `enough`; ends when all are done."""
    dtype = state.x.dtype
    eps = float(jnp.finfo(dtype).eps)

    def running(iterate: _Iterate) -> Array:
        return any_in_lockstep((iterate.count <= iterations) & ~iterate.done)

    def step(iterate: _Iterate) -> _Iterate:
        # the closure is evaluated at one place only: the compiled program holds its code once
        trial = closure(system, geometry, iterate.trial)
        first = iterate.count == 0
        better = (trial.merit < iterate.closure.merit) & ~iterate.done
        taken = better | first
        chosen_state, chosen = choose(taken, (iterate.trial, trial), (iterate.state, iterate.closure))
        lower, higher = jnp.maximum(0.3 * iterate.trust, 1e-2), jnp.minimum(8 * iterate.trust, 1e12)
        trust = jnp.where(first, iterate.trust, jnp.where(better, lower, higher))
        jacobian = free_jacobian(system, chosen)
        damping = trust * jnp.minimum(2 * chosen.merit, 1.0) + floor(dtype)
        delta = -least_norm(jacobian, chosen.residual, damping, system.used)
        length = jnp.sqrt(jnp.sum(delta * delta, axis=0))
        delta = delta * jnp.minimum(1.0, LONGEST_STEP / jnp.maximum(length, LONGEST_STEP))
        # below 32 eps^2 of the merit only rounding is left, as it is in long loops where a step gains nothing
        exhausted = ~taken & ((length < 4 * eps) | (chosen.merit < 0.5 * (64 * eps) ** 2))
        # a residual that nothing lessens any more, though no damping is in the way: the loops cannot close
        least = better & (iterate.trust <= 1) & (trial.merit > (1 - STAGNANT) * iterate.closure.merit)
        done = (
            iterate.done
            | (chosen.gap <= enough)
            | (chosen.merit < 32 * eps**2)
            | exhausted
            | least
            | ~jnp.isfinite(chosen.merit)
            | (iterate.count == iterations)
        )
        return _Iterate(iterate.count + 1, chosen_state, chosen, trust, done, retract(system, chosen_state, delta))

    poses = state.x.shape[-1]
    nothing = Closure(
        jnp.zeros((system.equations, poses), dtype),
        jnp.zeros((system.equations, system.columns, poses), dtype),
        jnp.full(poses, jnp.inf, dtype),
        jnp.full(poses, jnp.inf, dtype),
    )
    no = jnp.zeros(poses, bool)
    start = _Iterate(jnp.asarray(0), state, nothing, jnp.ones(poses, dtype), no, state)
    last = lax.while_loop(running, step, start)
    return Corrected(last.state, last.closure, last.closure.gap, _stationary(system, last.closure))


def _stationary(system: LoopSystem, closed: Closure) -> Bool[Array, " poses"]:
    """Whether what is left of the residual cannot be reached by the free coordinates, to first order.

    At a least residual J^T r = 0. Gauss-Newton gets there linearly where the residual is large, so the test is on the
    angle between the residual and the range of J, which a pose that is still under way does not meet. J of a rod is
    without the turn of its ball, to which its residual is at right angles: that counts as one.
    """
    jacobian = free_jacobian(system, closed)
    reach = jnp.sum(jacobian * closed.residual[:, None], axis=0)
    square = jnp.sum(jacobian**2, axis=(0, 1)) + sum(len(cut) > 1 for cut in system.cuts)
    cosine = jnp.sqrt(jnp.sum(reach**2, axis=0) / (square * 2 * closed.merit + 1e-300))
    return cosine < 1e-3


def choose(mask: Bool[Array, " poses"], yes, no):
    """Pose by pose the arrays of `yes` where the mask holds, else those of `no`."""
    return tree.map(lambda a, b: jnp.where(mask, a, b), yes, no)
