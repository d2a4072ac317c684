"""Draw and save numbers that belong to the poses of a motion, one row each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxkin._files import save_figure, whole


def draw_lines(
    names: Sequence[str],
    rows: Float[np.ndarray, "rows poses"],
    label: str,
    title: str,
    path: Path,
    *,
    at: Float[np.ndarray, " poses"] | None = None,
    along: str = "pose",
    marks: Sequence[tuple[float, str]] = (),
) -> Path:
    """Draw one line a row over the poses into a picture file; returns its path. `label` says what the numbers are.

    With `at` they are drawn over these numbers instead, which `along` names. `marks` are places on the line of zero,
    each with a marker of matplotlib.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    axes = figure.add_subplot()
    for name, row in zip(names, rows, strict=True):
        axes.plot(np.arange(len(row)) if at is None else at, np.where(np.isfinite(row), row, np.nan), label=name)
    # zero is where parts touch and where forces change sign: it is always seen
    axes.axhline(0.0, color="0.6", linewidth=0.8, zorder=1)
    for place, marker in marks:
        axes.plot(place, 0.0, marker, color="black")
    axes.set(xlabel=along, ylabel=label)
    axes.set_title(title, fontsize="medium")
    axes.grid(alpha=0.3)
    if names:
        figure.legend(fontsize="small", frameon=False, loc="outside lower center", ncols=min(len(names), 3))
    return save_figure(figure, path)


def save_rows(names: Sequence[str], rows: Float[np.ndarray, "rows poses"], path: Path) -> Path:
    """Write rows as columns of comma-separated values, one line a pose, below a line of names; returns the path."""
    heading = ",".join(["pose", *(f'"{name}"' for name in names)])
    table = np.column_stack([np.arange(rows.shape[1]), rows.T])
    with whole(path) as draft:
        np.savetxt(draft, table, ["%d"] + ["%.9g"] * len(names), ",", header=heading, comments="")
    return path
