"""Find the pose in which a coordinate turns back along the motion, and how it moves with the constants of the loops.

The closed poses of loops with one freedom are a curve, along which another coordinate u leads. A coordinate d turns
back where its rate along u, d' = -[J+ J_u]_d, is zero, with the columns J_u of u and J of all that are not given. The
pose of such a turning point (a fold of the curve) is the solution of r = 0 and d' = 0, so that it moves with the
constants as the implicit function theorem says. The value of d there moves by r = 0 alone, since a shift along u
changes it by its square.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.closure.closure import Closure, Geometry, closure
from jaxkin.solve.linear.least_norm import damping_floor
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import Coordinates, State, rate, retract

STEPS_TO_CLOSE = 20
"""Steps in which open loops are closed, of equal parts of how far they are open."""
LAST_STEPS = 8
"""Steps with the loops closed: a pose that the steps before have led to is right after four."""
LONGEST_STEP = 0.2
"""Longest of these steps, radians or characteristic lengths: farther away a parabola is no model of d along u."""


class TurningPoint(NamedTuple):
    """Which coordinate is followed, and along which (static)."""

    system: LoopSystem
    """The loops. Driven columns are those of d, of u, and of coordinates that rest."""
    column: int
    """The column of d."""
    along: int
    """The column of u."""
    turns: bool
    """Whether d turns back; if not, the pose is that in which u has its given value."""


class FirstOrder(NamedTuple):
    """The closure of one pose to first order."""

    closure: Closure
    inverse: Float[Array, "columns equations"]
    """Pseudoinverse of the Jacobian, whose rows are zero for u and for coordinates that rest."""
    tangent: Coordinates
    """Derivatives of the columns by u."""


class Followed(NamedTuple):
    """Where a pose was led."""

    state: State
    residual_norm: Float[Array, ""]
    """That before the last step."""
    step: Float[Array, ""]
    """Length of the last step along u, radians or characteristic lengths."""
    curvature: Float[Array, ""]
    """Second derivative of d by u before the last step; zero where u is given."""


def first_order(point: TurningPoint, geometry: Geometry, state: State) -> FirstOrder:
    """Solve the closure of one pose to first order."""
    evaluation = closure(point.system, geometry, state)
    given = np.isin(np.arange(point.system.columns), [k for k in point.system.driven if k != point.column])
    jacobian = evaluation.jacobian[..., 0]
    inverse = jnp.linalg.pinv(jnp.where(given, 0.0, jacobian), rtol=damping_floor(jacobian.dtype) ** 0.5)
    tangent = (-inverse @ jacobian[:, point.along]).at[point.along].set(1.0)
    return FirstOrder(evaluation, inverse, tangent[:, None])


def slope(point: TurningPoint, geometry: Geometry, state: State) -> Float[Array, ""]:
    """Compute the rate of d along u, which is zero where d turns back."""
    return first_order(point, geometry, state).tangent[point.column, 0]


def follow_turning_point(point: TurningPoint, geometry: Geometry, begun: State) -> Followed:
    """Lead a pose in which the loops may be open to the turning point, or to where they close with u as it is.

    The loops are closed by equal parts. Each step is one of Newton's method for that, and at a turning point another
    one along u. The iteration is not to be differentiated.
    """
    system = point.system
    start = Followed(begun, *jnp.zeros((3,), begun.x.dtype))
    unknown = jnp.zeros((system.equations, 1), begun.x.dtype)

    def onward(carry: tuple[Followed, Array], share: Array) -> tuple[tuple[Followed, Array], None]:
        at, opened = carry
        here = first_order(point, geometry, at.state)
        opened = jnp.where(share == first, here.closure.residual, opened)
        step, curvature = jnp.zeros_like(at.step), jnp.zeros_like(at.curvature)
        delta = here.inverse @ ((1.0 - share) * opened - here.closure.residual)
        if point.turns:
            along = rate(system, at.state, here.tangent)
            tilt, curvature = jax.jvp(partial(slope, point, geometry), (at.state,), (along,))
            step = jnp.clip(jnp.nan_to_num(-tilt / curvature), -LONGEST_STEP, LONGEST_STEP)
            delta = delta + step * here.tangent
        delta = delta * jnp.minimum(1.0, LONGEST_STEP / jnp.max(jnp.abs(delta)))
        norm = here.closure.residual_norm[0]
        return (Followed(retract(system, at.state, delta), norm, jnp.abs(step), curvature), opened), None

    shares = np.concatenate([np.arange(1, STEPS_TO_CLOSE) / STEPS_TO_CLOSE, np.ones(LAST_STEPS)])
    shares = shares.astype(begun.x.dtype)
    first = shares[0]
    return lax.scan(onward, (start, unknown), jnp.asarray(shares))[0][0]


def rate_with_geometry(point: TurningPoint, geometry: Geometry, state: State, d_geometry: Geometry) -> State:
    """Differentiate the pose of the turning point along a change of the constants of the loops."""
    here = first_order(point, geometry, state)
    _, opened = jax.jvp(lambda own: closure(point.system, own, state).residual, (geometry,), (d_geometry,))
    change = -here.inverse @ opened
    if point.turns:
        at_rest = jax.tree.map(jnp.zeros_like, geometry)
        along, aside = (rate(point.system, state, each) for each in (here.tangent, change))
        _, curvature = jax.jvp(partial(slope, point), (geometry, state), (at_rest, along))
        _, tilt = jax.jvp(partial(slope, point), (geometry, state), (d_geometry, aside))
        change = change - tilt / curvature * here.tangent
    return rate(point.system, state, change)
