"""Least squares within limits, for many poses at once, by active sets: coordinates stop at limits and are let go again.

Of a sum of squares the negative gradient g is projected on the movements that keep the limits,

    min |d - P g|    where P d = d, d_j >= 0 at a lowest and d_j <= 0 at a highest displacement,

with the projector P on the movements that are free. By the theorem of Moreau `d = P g + P m`, where m has a multiplier
for each limit that holds a coordinate, found by nonnegative least squares. No movement lessens the sum, to first order,
exactly where d is zero: the condition of Karush, Kuhn and Tucker, also where limits and loops say the same thing twice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

RANK = 1e-7
"""Singular values below it, for equations of order one, are zero: the tolerance that decides the rank of mobility."""
ROUNDING = 1e-14
"""How far a coordinate may be beyond a limit, radians or sizes; a slope that is rounding."""
ROUNDS = 100
"""Faces of the limits on which a sum of squares is made least, at most: none is visited twice, and the sum falls from
each to the next. Of 5,000 random problems with six limited columns none took more than sixteen."""


class Bounds(NamedTuple):
    """Limits of the columns, infinite where there are none."""

    low: Float[np.ndarray, "*#poses columns"]
    high: Float[np.ndarray, "*#poses columns"]


def fit(
    matrix: Float[np.ndarray, "poses rows columns"],
    values: Float[np.ndarray, "poses rows"],
    damping: Float[np.ndarray, " poses"],
    free: Float[np.ndarray, "poses columns columns"],
    begun: Float[np.ndarray, "poses columns"],
    bounds: Bounds,
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, "poses columns columns"]]:
    """Minimise `|matrix x - values|^2 + damping^2 |x - begun|^2` within bounds, moving only what is free.

    `begun` is within the bounds, and x nearest to it where the least sum is within them and leaves a choice. `free` is
    the projector on the movements that are free; also returns that on those which the sum leaves free.
    """
    more, range_of = least(matrix @ free, values - _times(matrix, begun), damping)
    found = begun + more
    beyond = ((found < bounds.low - ROUNDING) | (found > bounds.high + ROUNDING)).any(axis=1)
    if beyond.any():
        ends = Bounds(*(end[beyond] for end in bounds))
        found[beyond] = _fit_by_active_sets(
            matrix[beyond], values[beyond], damping[beyond], free[beyond], begun[beyond], ends
        )
    return np.clip(found, *bounds), free - range_of


def least(
    matrix: Float[np.ndarray, "poses rows columns"],
    values: Float[np.ndarray, "poses rows"],
    damping: Float[np.ndarray, " poses"] | float = 0.0,
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, "poses columns columns"]]:
    """Solve `matrix x = values` by the least x that fits best; also the projector on the range of x."""
    u, sigma, vt = np.linalg.svd(matrix, full_matrices=False)
    kept = sigma > RANK
    inverse = np.where(kept, sigma / np.where(kept, sigma**2 + np.reshape(damping, (-1, 1)) ** 2, 1.0), 0.0)
    x = _times(vt.swapaxes(1, 2), inverse * _times(u.swapaxes(1, 2), values))
    return x, (vt * kept[:, :, None]).swapaxes(1, 2) @ vt


def without(
    free: Float[np.ndarray, "poses columns columns"], stopped: Float[np.ndarray, "poses columns"] | np.ndarray
) -> Float[np.ndarray, "poses columns columns"]:
    """Project on the movements of `free` in which the coordinates that are `stopped` do not move."""
    return free - least(stopped[:, :, None] * free, np.zeros(stopped.shape))[1]


def downhill(
    free: Float[np.ndarray, "poses columns columns"],
    falls: Float[np.ndarray, "poses columns"],
    x: Float[np.ndarray, "poses columns"],
    bounds: Bounds,
) -> tuple[Float[np.ndarray, "poses columns"], Float[np.ndarray, "poses columns"]]:
    """Project negative gradients `falls` on the movements that are free and keep limits; also the multipliers.

    Zero where no movement lessens the sum of squares to first order. A multiplier is positive at a lowest displacement.
    """
    from scipy.optimize import nnls

    down, held = _times(free, falls), np.zeros_like(x)
    low, high = (x <= bounds.low), (x >= bounds.high)
    for pose in np.flatnonzero(((low & (down < 0)) | (high & (down > 0))).any(axis=1)):
        walls = np.concatenate([np.flatnonzero(low[pose]), np.flatnonzero(high[pose])])
        signs = np.repeat([1.0, -1.0], [low[pose].sum(), high[pose].sum()])
        np.add.at(held[pose], walls, signs * nnls(free[pose][:, walls] * signs, -down[pose])[0])
        down[pose] += free[pose] @ held[pose]
    return np.clip(down, np.where(low, 0.0, -np.inf), np.where(high, 0.0, np.inf)), held


def _fit_by_active_sets(
    matrix: Float[np.ndarray, "poses rows columns"],
    values: Float[np.ndarray, "poses rows"],
    damping: Float[np.ndarray, " poses"],
    free: Float[np.ndarray, "poses columns columns"],
    begun: Float[np.ndarray, "poses columns"],
    bounds: Bounds,
) -> Float[np.ndarray, "poses columns"]:
    """Minimise as `fit` does: on the face of the limits that are met, then downhill off it, until nothing is lower."""
    matrix = np.concatenate([matrix, damping[:, None, None] * np.eye(begun.shape[1])], axis=1)
    values = np.concatenate([values, damping[:, None] * begun], axis=1)
    x, left = begun.copy(), np.arange(len(begun))
    for _ in range(ROUNDS):
        rows, wanted, movable = matrix[left], values[left], free[left]
        ends = Bounds(*(end[left] for end in bounds))
        stopped = (x[left] <= ends.low) | (x[left] >= ends.high)
        along, _ = least(rows @ without(movable, stopped), wanted - _times(rows, x[left]))
        x[left], whole = _moved(x[left], np.where(stopped, 0.0, along), np.ones(len(left)), ends)
        off = wanted - _times(rows, x[left])
        down, _ = downhill(movable, _times(rows.swapaxes(1, 2), off), x[left], ends)
        squared = np.sum(down**2, axis=1)
        falls = np.sqrt(squared) > RANK * np.linalg.norm(off, axis=1) + ROUNDING
        length = squared / np.where(falls, np.sum(_times(rows, down) ** 2, axis=1), 1.0)
        lower, _ = _moved(x[left], down, length, ends)
        x[left] = np.where((whole & falls)[:, None], lower, x[left])
        left = left[~whole | falls]
        if not len(left):
            break
    return x


def _moved(
    x: Float[np.ndarray, "poses columns"],
    along: Float[np.ndarray, "poses columns"],
    length: Float[np.ndarray, " poses"],
    bounds: Bounds,
) -> tuple[Float[np.ndarray, "poses columns"], np.ndarray]:
    """Move along a direction by a length, or up to the first limit; also which poses went the whole length."""
    end = np.where(along > 0, bounds.high, bounds.low)
    moves = np.abs(along) > ROUNDING
    far = np.where(moves, np.abs(end - x) / np.where(moves, np.abs(along), 1.0), np.inf)
    gone = np.minimum(length, far.min(axis=1, initial=np.inf))
    x = np.clip(x + gone[:, None] * along, *bounds)
    return np.where(far <= gone[:, None], end, x), gone >= length


def _times(
    matrix: Float[np.ndarray, "poses rows columns"], x: Float[np.ndarray, "poses columns"]
) -> Float[np.ndarray, "poses rows"]:
    return (matrix @ x[:, :, None])[:, :, 0]
