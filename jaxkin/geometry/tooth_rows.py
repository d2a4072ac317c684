"""Rows of teeth with ends: those of a rack, and of a sector of a wheel, along an outline that is sampled evenly."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._runs import runs

MIN_ROW = 4
"""Teeth of a row at least: three distances that are alike are no chance of steps or holes."""
ALIKE = 0.06
"""How far distances of teeth may be apart, over their middle one: an outline is sampled ten times a tooth or more."""
WIDTH = (0.25, 0.75)
"""Width of a tooth at the pitch line over the distance of teeth: standard ones have 0.5."""
DEPTH = (1.2, 3.2)
"""Depth of teeth, in modules. Standard teeth are 2.25 deep and stub teeth 1.8; the corners of a hexagon 0.4, the lobes
of a knob less than 1."""
_STEPS = 4
"""Times that the pitch line is placed anew, a module below the tips: two suffice from a module that is near."""
_NEAR = (0.6, 1.6)
"""A module that is found from distances, over the one that placed the pitch line, from which it is placed anew."""
_SETTLED = 0.01
"""Change of the module at which the pitch line is where it belongs."""


class ToothRow(NamedTuple):
    """Teeth in a row."""

    count: int
    spacing: float
    """Distance from one tooth to the next, in the unit of the positions."""
    level: float
    """Height of the pitch line, a module below the tips."""
    module: float
    begin: float
    """Position of the middle of the first tooth."""
    end: float


def row_of_teeth(
    heights: Float[np.ndarray, " samples"],
    step: float,
    modules: Iterable[float],
    module_of: Callable[[float, float], float],
) -> ToothRow | None:
    """Find the longest row of equal teeth that are the highest of an outline; None where there is none.

    `heights` are sampled at positions `step` apart, -inf where there is no outline; `modules` are those to begin with,
    and `module_of(spacing, level)` is the one that teeth so far apart have at a pitch line.
    """
    tip = float(heights.max(initial=-np.inf))
    if not np.isfinite(tip):
        return None
    for module in modules:
        for _ in range(_STEPS):
            found = _runs(heights, step, tip - module)
            if found is None:
                break
            row, depth = found
            changed = module_of(row.spacing, row.level) / module
            if abs(changed - 1) < _SETTLED:
                if DEPTH[0] < depth / module < DEPTH[1]:
                    return row._replace(module=changed * module)
                break
            if not _NEAR[0] < changed < _NEAR[1]:
                break
            module *= changed
    return None


def _runs(heights: Float[np.ndarray, " samples"], step: float, level: float) -> tuple[ToothRow, float] | None:
    """Find the longest stretch of outline with crossings of a level alike, and how deep its teeth are."""
    change = np.diff((heights > level).astype(int))
    rises, falls = np.flatnonzero(change > 0), np.flatnonzero(change < 0)
    if not len(rises) or not len(falls):
        return None
    falls = falls[falls > rises[0]]
    rises = rises[: len(falls)]
    if len(rises) < MIN_ROW:
        return None
    begins, ends = (_crossing(heights, index, level) for index in (rises, falls))
    middles = (begins + ends) / 2
    apart = np.diff(middles)
    share = (ends - begins) / np.median(apart)
    alike = (np.abs(apart / np.median(apart) - 1) < ALIKE) & (WIDTH[0] < share[1:]) & (share[1:] < WIDTH[1])
    alike &= (WIDTH[0] < share[:-1]) & (share[:-1] < WIDTH[1])
    stretches = runs(alike)
    if not len(stretches):
        return None
    first, last = stretches[np.argmax(stretches[:, 1] - stretches[:, 0])]
    if last - first + 1 < MIN_ROW:
        return None
    roots = [
        float(heights[fall : rise + 2].min()) for fall, rise in zip(falls[first:last], rises[first + 1 :], strict=False)
    ]
    spacing = float(middles[last] - middles[first]) * step / (last - first)
    row = ToothRow(
        int(last - first + 1), spacing, level, 0.0, float(middles[first]) * step, float(middles[last]) * step
    )
    return row, float(heights.max()) - float(np.median(roots))


def _crossing(heights: np.ndarray, index: np.ndarray, level: float) -> Float[np.ndarray, " crossings"]:
    """Place the crossing behind each sample, linearly; in the middle where the next sample has no outline."""
    low, high = heights[index], heights[index + 1]
    known = np.isfinite(low) & np.isfinite(high)
    rise = np.where(known, high - low, 1.0)
    return index + np.where(known, (level - np.where(known, low, 0.0)) / rise, 0.5)
