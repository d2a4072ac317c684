"""Draw and save lengths that belong to the poses of a motion, one row each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxkin._files import whole


def draw_lines(names: Sequence[str], rows: Float[np.ndarray, "rows poses"], label: str, title: str, path: Path) -> Path:
    """Draw one line a row over the poses into a picture file; returns its path. `label` says what the lengths are."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    axes = figure.add_subplot()
    for name, row in zip(names, rows, strict=True):
        axes.plot(np.where(np.isfinite(row), row, np.nan), label=name)
    axes.set(xlabel="pose", ylabel=label)
    axes.set_title(title, fontsize="medium")
    axes.grid(alpha=0.3)
    if names:
        figure.legend(fontsize="small", frameon=False, loc="outside lower center")
    with whole(path) as draft:
        figure.savefig(draft, dpi=150, format=path.suffix.lstrip(".") or "png")
    return path


def save_rows(names: Sequence[str], rows: Float[np.ndarray, "rows poses"], path: Path) -> Path:
    """Write rows as columns of comma-separated values, one line a pose, below a line of names; returns the path."""
    heading = ",".join(["pose", *(f'"{name}"' for name in names)])
    table = np.column_stack([np.arange(rows.shape[1]), rows.T])
    with whole(path) as draft:
        np.savetxt(draft, table, ["%d"] + ["%.9g"] * len(names), ",", header=heading, comments="")
    return path
