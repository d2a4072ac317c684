"""Tell whether loops move as far as their first-order freedoms promise, or close at the assembled pose only.

Rounded numbers leave the closure Jacobian of an overconstrained mechanism with singular values that are neither zero
nor of the size of the others. At first order in the assembled pose, the tolerance of the rank then decides whether the
mechanism seems to move. A pose at a finite distance decides it without a tolerance: the coordinates are displaced along
all freedoms that the noise may hide, and the loops are closed by steps without the directions whose singular values may
come from the noise. The residual that is left is the misfit of the loops.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from jaxkin.linkage.first_order import LARGEST_UNCERTAIN, SPREAD, null_space
from jaxkin.linkage.host_closure import ClosedLoops, ClosureResidual, LoopCoordinates

STEPS = (0.3, 0.1, 0.03)
"""Displacements from the assembled pose, radians or characteristic lengths, tried in turn until the loops nearly close.
The longest shows a misfit best, and loops that cannot move so far are tried nearer."""
STILL = 0.1
"""Distance from the assembled pose, over the displacement, below which loops have not moved: closing them led back."""
_ITERATIONS = 25
"""Largest number of Gauss-Newton steps from a pose to the nearest pose of least residual: convergence is quadratic, so
loops that close need fewer."""
_FAR = 0.03
"""Residual over the displacement above which the pose is too far away: noise leaves misfits that are smaller."""


class Beside(NamedTuple):
    """A pose at a finite distance from the assembled one."""

    coordinates: LoopCoordinates
    residual: ClosureResidual
    """Misfits of the loops (`Travel.residual`, six rows a loop) that only directions due to noise could reduce."""
    moved: float
    """Largest change of a coordinate from the assembled pose, over the displacement that was tried (`STEPS`)."""


def cutoff(noise: float) -> float:
    """Return the singular value, over the largest, below which the rank is uncertain for frames that are `noise` off.

    `noise` is in radians, or lengths over the characteristic length.
    """
    return min(SPREAD * noise, LARGEST_UNCERTAIN)


def rounding(loops: ClosedLoops) -> float:
    """Return the residual that rounding leaves of closed loops: of the products of joints, and of far origins."""
    eps = float(np.finfo(float).eps)
    return eps * (10.0 * np.sqrt(len(loops.loop_group.loops)) + 16.0 * float(np.abs(loops.centre).max()) / loops.length)


def nearest_closed(loops: ClosedLoops, q: LoopCoordinates, least: float) -> tuple[LoopCoordinates, ClosureResidual]:
    """Find the coordinates of least residual near `q`; returns them with the residual there (`Travel.residual`).

    The steps are Gauss-Newton steps of least norm, without the directions whose singular values are below `least` times
    the largest.
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
    """Displace the loops along all freedoms that frames with an error of `noise` may hide, and close them there.

    `noise` is in radians, or lengths over the characteristic length. The direction among the freedoms is generic, and
    the same for the same `seed`. None if there are no freedoms, or if the assembled pose itself does not nearly close.
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
