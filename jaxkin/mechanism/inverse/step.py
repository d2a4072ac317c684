"""One step of Gauss and Newton's method for targets under constraints, for many poses at once.

With coordinates x (radians, and lengths over the size), the step solves, in this order of precedence,

    A x = -c             the closure equations, and coordinates that stop at their limits,
    min |B x - r|        the targets, weighted,
    min |D x - d|        the movement of the inputs from where they rest,

each by the singular value decomposition, within the null space of those above it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

RANK = 1e-7
"""Singular values below it, for equations of order one, are zero: the tolerance that decides the rank of mobility."""
ROUNDING = 1e-14
"""How far a coordinate may be beyond a limit, radians or sizes."""
ROUNDS = 6
"""How often coordinates that a step takes beyond their limits are stopped, and the step computed anew."""


class Equations(NamedTuple):
    """What a step is to solve, at some coordinates of each pose."""

    closure: Float[np.ndarray, "poses equations"]
    closure_jacobian: Float[np.ndarray, "poses equations columns"]
    targets: Float[np.ndarray, "poses rows"]
    """Weighted errors r, of the target less what is there."""
    targets_jacobian: Float[np.ndarray, "poses rows columns"]
    """Weighted derivatives B of what is there."""
    rest: Float[np.ndarray, "poses columns"]
    """How far each column is from where it rests."""


class Step(NamedTuple):
    """A step, and what becomes of the squared errors of the targets if they are linear."""

    move: Float[np.ndarray, "poses columns"]
    to_rest: Float[np.ndarray, " poses"]
    """Norm of the part that moves the inputs towards where they rest, and changes errors in the second order only."""
    foreseen: Float[np.ndarray, " poses"]
    """Squared errors after it."""


class Bounds(NamedTuple):
    """Limits of the columns, infinite where there are none."""

    low: Float[np.ndarray, " columns"]
    high: Float[np.ndarray, " columns"]


def step(
    equations: Equations,
    x: Float[np.ndarray, "poses columns"],
    bounds: Bounds,
    damping: Float[np.ndarray, " poses"],
    inputs: Bool[np.ndarray, "#poses columns"],
) -> Step:
    """Compute the step of each pose, which keeps limits; `damping` is that of Levenberg and Marquardt."""
    limited = np.flatnonzero(np.isfinite(bounds.low) | np.isfinite(bounds.high))
    stopped = np.zeros((len(x), len(limited)), bool)
    move, to_rest = np.zeros_like(x), np.zeros(len(x))
    for _ in range(ROUNDS):
        rows = np.zeros((len(x), len(limited), x.shape[1]))
        rows[:, np.arange(len(limited)), limited] = stopped
        nearest = np.clip(x[:, limited] + move[:, limited], bounds.low[limited], bounds.high[limited])
        values = np.where(stopped, x[:, limited] - nearest, 0.0)
        jacobian = np.concatenate([equations.closure_jacobian, rows], axis=1)
        values = np.concatenate([equations.closure, values], axis=1)
        move, to_rest = _solved(equations, jacobian, values, damping, inputs)
        there = x[:, limited] + move[:, limited]
        beyond = (there < bounds.low[limited] - ROUNDING) | (there > bounds.high[limited] + ROUNDING)
        if not (beyond & ~stopped).any():
            break
        stopped |= beyond
    left = equations.targets - np.einsum("pij,pj->pi", equations.targets_jacobian, move)
    return Step(move, to_rest, np.sum(left**2, axis=1))


def _solved(
    equations: Equations,
    jacobian: Float[np.ndarray, "poses _ columns"],
    values: Float[np.ndarray, "poses _"],
    damping: Float[np.ndarray, " poses"],
    inputs: Bool[np.ndarray, "#poses columns"],
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, " poses"]]:
    """The step for closure and stopped coordinates together, and the norm of its part to where the inputs rest."""
    columns = jacobian.shape[2]
    move, range_of = _least(jacobian, -values, np.zeros(len(jacobian)))
    free = np.eye(columns) - range_of
    aims = equations.targets_jacobian
    more, range_of = _least(aims @ free, equations.targets - np.einsum("pij,pj->pi", aims, move), damping)
    move = move + more
    free = free - range_of
    back = -(equations.rest + move) * inputs
    less, _ = _least(free * inputs[:, :, None], back, damping)
    return move + less, np.linalg.norm(less, axis=1)


def _least(
    matrix: Float[np.ndarray, "poses rows columns"],
    values: Float[np.ndarray, "poses rows"],
    damping: Float[np.ndarray, " poses"],
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, "poses columns columns"]]:
    """Solve `matrix x = values` by the least x that fits best; also the projector on the range of x."""
    u, sigma, vt = np.linalg.svd(matrix, full_matrices=False)
    kept = sigma > RANK
    inverse = np.where(kept, sigma / np.where(kept, sigma**2 + damping[:, None] ** 2, 1.0), 0.0)
    x = np.einsum("pkj,pk,pik,pi->pj", vt, inverse, u, values, optimize=True)
    return x, np.einsum("pki,pk,pkj->pij", vt, kept.astype(float), vt, optimize=True)
