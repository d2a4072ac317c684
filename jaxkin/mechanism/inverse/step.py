"""One step of Gauss and Newton's method for targets under constraints and limits, for many poses at once.

With coordinates x (radians, and lengths over the size), the step solves, in this order of precedence,

    min |A x + c|        the closure equations,
    min |B x - r|        the targets, weighted,
    min |D x - d|        the movement of the inputs from where they rest,

each within the limits, and among all that solves those above it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.mechanism.inverse.bounded import Bounds, downhill, fit, least

STATIONARY = 1e-4
"""Cosine between the errors and what a movement changes of them, up to which no movement lessens the errors: they are
within about its square of the least ones."""


class StepEquations(NamedTuple):
    """What a step is to solve, at some coordinates of each pose."""

    closure: Float[np.ndarray, "poses equations"]
    closure_jacobian: Float[np.ndarray, "poses equations columns"]
    targets: Float[np.ndarray, "poses rows"]
    """Weighted errors r, of the target less what is there."""
    targets_jacobian: Float[np.ndarray, "poses rows columns"]
    """Weighted derivatives B of what is there."""
    rest: Float[np.ndarray, "poses columns"]
    """How far each column is from where it rests."""

    def at(self, poses: np.ndarray) -> StepEquations:
        """Select the equations of some poses, by their numbers."""
        return StepEquations(*(each[poses] for each in self))


class InverseStep(NamedTuple):
    """A step, and what becomes of the squared errors of the targets if they are linear."""

    move: Float[np.ndarray, "poses columns"]
    to_rest: Float[np.ndarray, " poses"]
    """Norm of the part that moves the inputs towards where they rest, and changes errors in the second order only."""
    foreseen: Float[np.ndarray, " poses"]
    """Squared errors after it."""
    tangent: Float[np.ndarray, "poses columns columns"]
    """The projector on the movements that keep the loops closed: see `tangent`."""


def step(
    equations: StepEquations,
    x: Float[np.ndarray, "poses columns"],
    bounds: Bounds,
    damping: Float[np.ndarray, " poses"],
    inputs: Bool[np.ndarray, "#poses columns"],
) -> InverseStep:
    """Compute the step of each pose, which keeps limits; `damping` is that of Levenberg and Marquardt."""
    room = Bounds(bounds.low - x, bounds.high - x)
    free = np.broadcast_to(np.eye(x.shape[1]), (*x.shape, x.shape[1]))
    move, closed = fit(equations.closure_jacobian, -equations.closure, 0 * damping, free, np.zeros_like(x), room)
    move, free = fit(equations.targets_jacobian, equations.targets, damping, closed, move, room)
    left = equations.targets - np.einsum("pij,pj->pi", equations.targets_jacobian, move)
    inputs, rows = np.broadcast_to(inputs, x.shape), np.flatnonzero(inputs.any(axis=0))
    chosen = np.eye(x.shape[1])[rows] * inputs[:, rows, None]
    rested, _ = fit(chosen, -(equations.rest * inputs)[:, rows], damping, free, move, room)
    return InverseStep(rested, np.linalg.norm(rested - move, axis=1), np.sum(left**2, axis=1), closed)


def slope(
    equations: StepEquations,
    closed: Float[np.ndarray, "poses columns columns"],
    x: Float[np.ndarray, "poses columns"],
    bounds: Bounds,
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, "poses columns"]]:
    """Find the movement of steepest descent of half the squared errors that keeps loops and limits, and multipliers.

    `closed` is the `tangent`. The movement is zero where the condition of Karush, Kuhn and Tucker holds; the
    multipliers are those of the limits.
    """
    falls = np.einsum("pij,pi->pj", equations.targets_jacobian, equations.targets)
    return downhill(closed, falls, x, bounds)


def tangent(equations: StepEquations) -> Float[np.ndarray, "poses columns columns"]:
    """Project on the movements that keep the loops closed, to first order."""
    columns = equations.closure_jacobian.shape[2]
    return np.eye(columns) - least(equations.closure_jacobian, equations.closure)[1]


def scale(equations: StepEquations) -> Float[np.ndarray, " poses"]:
    """Multiply the norm of the errors by that of their derivatives: the measure of slopes and curvatures."""
    return np.linalg.norm(equations.targets, axis=1) * np.linalg.norm(equations.targets_jacobian, axis=(1, 2))


def is_stationary(
    equations: StepEquations,
    closed: Float[np.ndarray, "poses columns columns"],
    x: Float[np.ndarray, "poses columns"],
    bounds: Bounds,
    cosine: float = STATIONARY,
) -> Bool[np.ndarray, " poses"]:
    """Tell at which poses no movement within loops and limits lessens the errors, to first order.

    `closed` is the `tangent`.
    """
    down, _ = slope(equations, closed, x, bounds)
    return np.linalg.norm(down, axis=1) <= cosine * scale(equations)
