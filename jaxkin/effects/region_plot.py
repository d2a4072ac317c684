"""Draw over two inputs how many poses each region of connected assembly modes has."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._files import whole

if TYPE_CHECKING:
    from jaxkin.effects.mode_regions import ModeRegions

MAX_PANELS = 12
"""Regions that are drawn at most: those with the most poses."""
COLUMNS = 3
"""Regions beside each other."""


def draw_regions(found: ModeRegions, path: Path) -> Path:
    """Draw a panel a region, coloured by its number of poses at each node; returns the path.

    The inputs of the modes are marked.
    """
    from matplotlib.colors import BoundaryNorm
    from matplotlib.figure import Figure

    order = sorted(range(len(found.regions)), key=lambda k: -int(found.poses[k].sum()))[:MAX_PANELS]
    order.sort()
    columns = min(COLUMNS, len(order))
    rows = -(-len(order) // columns)
    figure = Figure(figsize=(4.2 * columns + 0.8, 3.8 * rows), layout="constrained")
    (one, first), (other, second) = found.inputs.items()
    most = int(found.poses.max())
    norm = BoundaryNorm(np.arange(0.5, most + 1.5), 256)
    every, drawn = [], None
    for place, number in enumerate(order, start=1):
        axes = figure.add_subplot(rows, columns, place)
        every.append(axes)
        poses = np.where(found.poses[number] > 0, found.poses[number], np.nan)
        drawn = axes.pcolormesh(first, second, poses.T, cmap="viridis", norm=norm, shading="nearest")
        axes.plot(found.modes.inputs[one], found.modes.inputs[other], "+", color="crimson", markersize=10)
        modes = ", ".join(found.modes.names[k].removeprefix("mode ") for k in found.regions[number])
        axes.set(xlabel=one, ylabel=other)
        axes.set_title(f"mode{'' if len(found.regions[number]) == 1 else 's'} {modes}", fontsize="medium")
    if drawn is not None:
        figure.colorbar(drawn, ax=every, label="poses for the same inputs", ticks=np.arange(1, most + 1))
    with whole(path) as draft:
        figure.savefig(draft, dpi=150, format=path.suffix.lstrip(".") or "png")
    return path
