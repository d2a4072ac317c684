"""Steps off poses whose errors are stationary and not least, as where a straight arm is to become shorter."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.mechanism.inverse.bounded import Bounds, least, without
from jaxkin.mechanism.inverse.problem import InverseProblem
from jaxkin.mechanism.inverse.step import is_stationary, scale, slope, tangent

HOLDS = 1e-9
"""Multiplier of a limit, over errors and their derivatives, above which errors grow with a movement off the limit."""
DIFFERENCE = 1e-4
"""Half the step of the differences that tell curvatures, radians and sizes: they are right to 1e-8."""
CURVED = 1e-6
"""Curvature, over errors and their derivatives, that is not zero."""
BESIDE = 1e-2
"""Length of a step, radians and sizes: Newton's method has slopes of a hundred there."""


def step_off(
    problem: InverseProblem, x: Float[np.ndarray, "poses columns"], bounds: Bounds, share: float, enough: float
) -> tuple[Float[np.ndarray, "poses columns"], Bool[np.ndarray, " poses"]]:
    """Step off poses with errors above `enough` that are stationary and not least; also tell which these are.

    Among the movements that keep loops and limits, the step is along the one of most negative curvature, to the side on
    which its largest coordinate grows unless a limit is there. Loops bend movements, so the curvature is that of the
    function of Lagrange.
    """
    now, _ = problem.equations(x, share)
    closed = tangent(now)
    stuck = is_stationary(now, closed, x, bounds) & (np.linalg.norm(now.targets, axis=1) > enough)
    if not stuck.any():
        return x, stuck
    _, held = slope(now, closed, x, bounds)
    movable = without(closed, np.abs(held) > HOLDS * scale(now)[:, None])
    falls = np.einsum("pij,pi->pj", now.targets_jacobian, now.targets) + held
    forces, _ = least(now.closure_jacobian.swapaxes(1, 2), falls)

    def gradient(x: np.ndarray) -> np.ndarray:
        there, _ = problem.equations(x, share)
        of_loops = np.einsum("pij,pi->pj", there.closure_jacobian, forces)
        return of_loops - np.einsum("pij,pi->pj", there.targets_jacobian, there.targets)

    steps = DIFFERENCE * np.moveaxis(movable, 2, 0)
    rates = np.stack([gradient(x + each) - gradient(x - each) for each in steps], axis=2) / (2 * DIFFERENCE)
    curvature = movable @ (rates + rates.swapaxes(1, 2)) @ movable / 2
    axes = _signed(np.linalg.eigh(curvature)[1])
    ways = np.clip(
        np.concatenate([axes, -axes], axis=2),
        np.where(x <= bounds.low, 0.0, -np.inf)[:, :, None],
        np.where(x >= bounds.high, 0.0, np.inf)[:, :, None],
    )
    bent = np.einsum("pik,pij,pjk->pk", ways, curvature, ways, optimize=True)
    chosen = bent.argmin(axis=1)
    stuck &= bent.min(axis=1) < -CURVED * scale(now)
    along = np.take_along_axis(ways, chosen[:, None, None], axis=2)[:, :, 0]
    return np.clip(x + BESIDE * stuck[:, None] * along, *bounds), stuck


def _signed(axes: Float[np.ndarray, "poses columns axes"]) -> Float[np.ndarray, "poses columns axes"]:
    """Point axes to the side of their largest coordinate, that of the first one where several are as large."""
    largest = np.argmax(np.round(np.abs(axes), 6), axis=1)
    sign = np.sign(np.take_along_axis(axes, largest[:, None, :], axis=1))
    return axes * np.where(sign == 0, 1.0, sign)
