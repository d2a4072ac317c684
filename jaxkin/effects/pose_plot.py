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
    across = np.arange(rows.shape[1]) if at is None else at
    for name, row in zip(names, rows, strict=True):
        known = np.pad(np.isfinite(row), 1)
        alone = known[1:-1] & ~known[:-2] & ~known[2:]  # no line goes through these: they are dots
        marker = {"marker": "o", "markersize": 4, "markevery": np.flatnonzero(alone).tolist()} if alone.any() else {}
        axes.plot(across, np.where(known[1:-1], row, np.nan), label=name, **marker)
    if len(across):  # all poses are seen, also those of which nothing is known
        axes.update_datalim([(np.nanmin(across), 0.0), (np.nanmax(across), 0.0)])
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
