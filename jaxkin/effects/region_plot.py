"""Draw over two inputs how many poses each region of connected assembly modes has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from jaxkin._files import save_figure
from jaxkin.geometry.headings import coordinate_label

MAX_PANELS = 12
"""Regions that are drawn at most: those with the most poses."""
COLUMNS = 3
"""Regions beside each other."""


def draw_regions(
    inputs: Mapping[str, Float[np.ndarray, " values"]],
    counts: Int[np.ndarray, "regions first second"],
    titles: Sequence[str],
    marked: tuple[float, float],
    unit: str,
    path: Path,
) -> Path:
    """Draw a panel a region, coloured by its number of poses at each node of two inputs; returns the path.

    `titles` are those of the regions; the inputs `marked`, radians or lengths, are drawn as a cross.
    `unit` is that of lengths, "" where it is not known.
    """
    from matplotlib.colors import BoundaryNorm
    from matplotlib.figure import Figure

    order = sorted(range(len(counts)), key=lambda k: -int(counts[k].sum()))[:MAX_PANELS]
    order.sort()
    columns = min(COLUMNS, len(order))
    rows = -(-len(order) // columns)
    figure = Figure(figsize=(4.2 * columns + 0.8, 3.8 * rows), layout="constrained")
    (one, first), (other, second) = inputs.items()
    most = int(counts.max())
    norm = BoundaryNorm(np.arange(0.5, most + 1.5), 256)
    every, drawn = [], None
    for place, number in enumerate(order, start=1):
        axes = figure.add_subplot(rows, columns, place)
        every.append(axes)
        poses = np.where(counts[number] > 0, counts[number], np.nan)
        drawn = axes.pcolormesh(first, second, poses.T, cmap="viridis", norm=norm, shading="nearest")
        axes.plot(*marked, "+", color="crimson", markersize=10)
        axes.set(xlabel=coordinate_label(one, unit), ylabel=coordinate_label(other, unit))
        axes.set_title(titles[number], fontsize="medium")
    if drawn is not None:
        figure.colorbar(drawn, ax=every, label="poses for the same inputs", ticks=np.arange(1, most + 1))
    return save_figure(figure, path)
