"""Draw time against error."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from jaxkin._files import save_figure

MARKERS = "osD^vPX"
"""Markers of matplotlib, one a method and precision in turn."""


def draw(points: Iterable[tuple[str, str, float, float]], poses: int, path: Path) -> Path:
    """Draw points (method, precision, error, seconds of a sweep), one line a method and precision, into a picture file.

    Returns its path.
    """
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter

    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    axes = figure.add_subplot()
    series: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for method, precision, error, seconds in points:
        if error > 0:
            series.setdefault((method, precision), []).append((error, seconds / poses * 1e6))
    for number, ((method, precision), shown) in enumerate(series.items()):
        label = method if precision == "float64" else f"{method}, {precision}"
        axes.plot(
            *zip(*shown, strict=True),
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
    axes.set_title(f"{poses} poses: farther right is more accurate, lower is faster", fontsize="medium")
    return save_figure(figure, path)
