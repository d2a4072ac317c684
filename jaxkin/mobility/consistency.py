"""Tell whether loops move as far as their first-order freedoms promise, or close at the assembled pose only.

Numbers that were rounded leave an overconstrained mechanism with singular values of the closure Jacobian that are
neither zero nor of the size of the others. To first order, and at the assembled pose, such a mechanism seems to move or
not to move, as the tolerance of the rank is chosen. What tells is a pose at a finite distance: the loops are brought
there along all freedoms that the noise may hide, and closed without the directions that the noise may have brought
about. What is left of the residual is the misfit of the mechanism.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from jaxkin.linkage.first_order import LARGEST_UNCERTAIN, SPREAD, null_space
from jaxkin.mobility.host_closure import ClosedLoops, Row, Rows

STEPS = (0.3, 0.1, 0.03)
"""Radians, or characteristic lengths, from the assembled pose: the first that closes is taken."""
STILL = 0.1
"""Part of the step: loops that come back nearer than this to the assembled pose have not moved."""
_ITERATIONS = 25
"""Gauss-Newton steps at most from a pose to the one of least residual near it."""
_FAR = 0.03
"""Residual over the step that is no misfit any more: the loops cannot be followed so far."""


class Beside(NamedTuple):
    """A pose at a finite distance from the assembled one."""

    coordinates: Row
    residual: Rows
    """What the joints cannot undo but by directions that the noise may have brought about."""
    moved: float
    """Distance of the coordinates from those of the assembled pose, over the step that was taken."""


def cutoff(noise: float) -> float:
    """Singular values, over the largest, below which the rank is in doubt for frames that are `noise` radians off."""
    return min(SPREAD * noise, LARGEST_UNCERTAIN)


def rounding(loops: ClosedLoops) -> float:
    """The residual of closed loops that rounding leaves: of the products of the joints, and of far origins."""
    eps = float(np.finfo(float).eps)
    return eps * (10.0 * np.sqrt(len(loops.loop_group.loops)) + 16.0 * float(np.abs(loops.centre).max()) / loops.length)


def nearest_closed(loops: ClosedLoops, q: Row, least: float) -> tuple[Row, Rows]:
    """The coordinates of least residual near to the given ones, and that residual.

    Gauss-Newton steps of least norm without the directions whose singular values are below `least` of the largest.
    """
    residual, jacobian, *_ = loops.travel(q)
    enough = rounding(loops) / 8
    for _ in range(_ITERATIONS):
        step = np.linalg.pinv(jacobian, rcond=least) @ residual
        length = float(np.linalg.norm(step))
        q = q - step * min(1.0, 0.5 / max(length, 0.5))
        before, (residual, jacobian, *_) = float(np.linalg.norm(residual)), loops.travel(q)
        if np.linalg.norm(residual) < enough or (length < 1e-9 and np.linalg.norm(residual) > 0.5 * before):
            break
    return q, residual


def beside(loops: ClosedLoops, noise: float, seed: int = 0) -> Beside | None:
    """A pose that all freedoms lead to which frames that are `noise` radians off may hide; None without freedoms.

    The direction is generic, and the same for the same `seed`.
    """
    least = cutoff(noise)
    home, residual = nearest_closed(loops, np.zeros(len(loops.columns)), least)
    _, free = null_space(loops.jacobian(home), least)
    if not len(free) or np.linalg.norm(residual) > _FAR:
        return None
    generic = np.sin(1.0 + 2.7 * np.arange(free.shape[1]) + 1.3 * seed)
    along = free.T @ (free @ generic)
    along /= max(float(np.abs(along).max()), 1e-12)
    found = None
    for step in STEPS:
        q, residual = nearest_closed(loops, home + step * along, least)
        moved = float(np.abs(q - home).max()) / step
        found = Beside(q, residual, moved)
        if np.linalg.norm(residual) <= _FAR * step:
            return found
    return found
