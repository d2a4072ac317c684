"""Minimise a sum of squares whose unknowns the data may not tell all: Gauss-Newton steps of least norm, damped.

Directions of the unknowns that change no residual get no step at all (a truncated singular value decomposition), so
that the fit ends at the nearest of all solutions that are as good.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

Residuals = Float[np.ndarray, " rows"]
Jacobian = Float[np.ndarray, "rows unknowns"]
Evaluate = Callable[[Float[np.ndarray, " unknowns"]], tuple[Residuals, Jacobian, bool]]
"""Residuals, their derivatives, and whether the residuals are valid there."""

RANK = {64: 1e-9, 32: 1e-4}
"""Singular values of the Jacobian, over the largest, below which nothing is told, by the bits of its numbers: a hundred
times the error of derivatives, which are right to 1e-11, and in single precision to 1e-6 (of arms with up to five
joints)."""
STEP = 1e-12
"""Steps so small, in scaled unknowns, end the fit."""
GAIN = 1e-10
"""A decrease of the sum of squares so small, relative to it, ends the fit."""
DAMPING = 1e-6
"""First damping, over the square of the largest singular value, after a step that was refused."""
MAX_DAMPING = 1e9
"""Damping at which the fit gives up: no step is left that decreases the sum."""


class Fit(NamedTuple):
    """Where the fit ended."""

    unknowns: Float[np.ndarray, " unknowns"]
    residuals: Residuals
    jacobian: Jacobian
    iterations: int
    converged: bool


def told(jacobian: Jacobian, bits: int = 64) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Decompose a Jacobian: singular values that count, their directions (rows), and the directions that do not.

    `bits` are those of the numbers that it was computed in, 64 or 32.
    """
    _, values, directions = np.linalg.svd(jacobian, full_matrices=True)
    count = int(np.sum(values > RANK[bits] * values.max(initial=0.0)))
    return values[:count], directions[:count], directions[count:]


def fit(evaluate: Evaluate, start: Float[np.ndarray, " unknowns"], iterations: int, bits: int = 64) -> Fit:
    """Minimise the sum of squares from a start that is valid; unknowns are of similar size.

    `bits` are those of the numbers in which residuals and derivatives are computed.
    """
    unknowns = start
    residuals, jacobian, _ = evaluate(unknowns)
    damping = 0.0
    for number in range(iterations):
        values, directions, _ = told(jacobian, bits)
        if not len(values):
            return Fit(unknowns, residuals, jacobian, number, True)
        slope = directions @ (jacobian.T @ residuals)
        cost = residuals @ residuals
        while True:
            step = -(slope / (values**2 + damping * values[0] ** 2)) @ directions
            if np.linalg.norm(step) < STEP:
                return Fit(unknowns, residuals, jacobian, number, True)
            new_residuals, new_jacobian, valid = evaluate(unknowns + step)
            new_cost = new_residuals @ new_residuals
            if valid and new_cost < cost:
                break
            damping = max(10 * damping, DAMPING)
            # what a full step would gain tells a minimum from a fit that is stuck
            if damping > MAX_DAMPING:
                gain = np.sum((slope / values) ** 2)
                return Fit(unknowns, residuals, jacobian, number, bool(gain <= GAIN * cost))
        unknowns, residuals, jacobian = unknowns + step, new_residuals, new_jacobian
        damping = 0.0 if damping <= DAMPING else damping / 10
        if cost - new_cost <= GAIN * cost and not damping:
            return Fit(unknowns, residuals, jacobian, number + 1, True)
    return Fit(unknowns, residuals, jacobian, iterations, False)


def readable(directions: Float[np.ndarray, "directions unknowns"]) -> Float[np.ndarray, "directions unknowns"]:
    """Combine directions of a space so that each has few unknowns (reduced row echelon form), the largest being 1."""
    rows = np.array(directions, float)
    for number in range(len(rows)):
        rest = np.abs(rows[number:])
        pivot_row, pivot = np.unravel_index(np.argmax(rest), rest.shape)
        rows[[number, number + pivot_row]] = rows[[number + pivot_row, number]]
        rows[number] /= rows[number, pivot]
        for other in range(len(rows)):
            if other != number:
                rows[other] -= rows[other, pivot] * rows[number]
    return rows
