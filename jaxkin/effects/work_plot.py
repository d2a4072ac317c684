"""Draw time against error."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from jaxkin._files import whole

if TYPE_CHECKING:
    from jaxkin.effects.accuracy import WorkPrecision

MARKERS = "osD^vPX"
"""Markers of matplotlib, one a method and precision in turn."""


def draw(work: WorkPrecision, path: Path) -> Path:
    """Draw the points, one line a method and precision, into a picture file; returns its path."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter

    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    axes = figure.add_subplot()
    series: dict[tuple[str, str], list] = {}
    for point in work.points:
        series.setdefault((point.method, point.precision), []).append(point)
    for number, ((method, precision), points) in enumerate(series.items()):
        label = method if precision == "float64" else f"{method}, {precision}"
        shown = [point for point in points if point.error > 0]
        axes.plot(
            [point.error for point in shown],
            [point.seconds / work.poses * 1e6 for point in shown],
            marker=MARKERS[number % len(MARKERS)],
            linestyle="-" if precision == "float64" else "--",
            label=label,
        )
    axes.set(
        xscale="log", yscale="log", xlabel="largest error (rad, characteristic lengths)", ylabel="time a pose (µs)"
    )
    for formatted in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        formatted(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.invert_xaxis()
    axes.grid(which="major", alpha=0.3)
    figure.legend(fontsize="small", frameon=False, loc="outside right center")  # lines may end in any corner
    axes.set_title(f"{work.poses} poses: farther right is more accurate, lower is faster", fontsize="medium")
    with whole(path) as draft:
        figure.savefig(draft, dpi=150, format=path.suffix.lstrip(".") or "png")
    return path
