"""Newton's method for poses that begin near closure, block after block, without the caution of the damped corrector.

It costs a fraction of that, and is all that most poses need. What it does not close is left to `correct`.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import Closure, Geometry, closure
from jaxkin.solve.correctors.levenberg_marquardt import choose, floor
from jaxkin.solve.execution.lockstep import any_in_lockstep
from jaxkin.solve.linear.least_norm import UNROLLED, solve_blocks
from jaxkin.solve.status import Scalar
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import State, retract

STEPS = 4
"""At most: from where the knots put a pose the gap falls to its square, and again."""
QUADRATIC = 1e-2
"""A step that leaves less of the gap than this was Newton's: where a motion ends a step leaves a quarter at best."""


class _Iterate(NamedTuple):
    count: Array
    state: State
    closure: Closure
    foreseen: Float[Array, " poses"]
    """Gap of the trial as the last two gaps tell; infinite if they do not."""
    trial: State


def newton(
    system: LoopSystem, geometry: Geometry, state: State, enough: Scalar | float, *, foresee: bool = False
) -> tuple[State, Closure, Float[Array, " poses"]]:
    """States after as many steps as bring all of them to the gap `enough`, or after the most; their closure and gap.

    With `foresee` the last step is not looked back at where convergence is quadratic: the states then are one step
    ahead of the closure returned.
    """
    poses, dtype = state.x.shape[-1], state.x.dtype
    infinite = jnp.full(poses, jnp.inf, dtype)
    costly = any(len(block.rows) > UNROLLED for block in equation_blocks(system))

    def running(at: _Iterate) -> Array:
        return (at.count <= STEPS) & any_in_lockstep((at.closure.gap > enough) & (at.foreseen > enough))

    def step(at: _Iterate) -> _Iterate:
        # the closure is evaluated at one place only: the compiled program holds its code once
        closed = closure(system, geometry, at.trial)

        def solved() -> Array:
            return solve_blocks(closed.jacobian, closed.residual, floor(dtype), equation_blocks(system), regular=True)

        if costly:  # not a last time, when all are closed: to ask costs as much as to solve small systems
            delta = lax.cond(any_in_lockstep(closed.gap > enough), solved, lambda: jnp.zeros_like(at.trial.x))
        else:
            delta = solved()
        foreseen = infinite
        if foresee:
            # Newton's gaps go as the squares of those before: the next is this one times the square of the last ratio
            shrunk = closed.gap / at.closure.gap
            foreseen = jnp.where((shrunk < QUADRATIC) & (at.count > 0), shrunk**2 * closed.gap, jnp.inf)
        # what is closed rests: near a singular pose more steps would lead away, and no pose depends on the others
        delta = jnp.where(closed.gap > enough, -delta, 0.0)
        return _Iterate(at.count + 1, at.trial, closed, foreseen, retract(system, at.trial, delta))

    nothing = jnp.zeros((system.equations, system.columns, poses), dtype)
    start = Closure(nothing[:, 0], nothing, infinite, infinite)
    last = lax.while_loop(running, step, _Iterate(jnp.asarray(0), state, start, infinite, state))
    state, gap = last.state, last.closure.gap
    if foresee:
        ahead = (gap > enough) & (last.foreseen <= enough)
        state, gap = choose(ahead, (last.trial, last.foreseen), (state, gap))
    return state, last.closure, gap
