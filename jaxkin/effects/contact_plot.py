"""Draw how far the faces of contacts are apart over the poses of a motion."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxkin._files import whole


def draw_gaps(names: Sequence[str], gaps: Float[np.ndarray, "contacts poses"], unit: str, path: Path) -> Path:
    """Draw one line a contact into a picture file; returns its path."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    axes = figure.add_subplot()
    for name, row in zip(names, gaps, strict=True):
        axes.plot(row, label=name)
    axes.set(xlabel="pose", ylabel=f"gap between the faces ({unit})" if unit else "gap between the faces")
    axes.set_title("contacts that are lost" if names else "no contact is lost", fontsize="medium")
    axes.grid(alpha=0.3)
    if names:
        figure.legend(fontsize="small", frameon=False, loc="outside lower center")
    with whole(path) as draft:
        figure.savefig(draft, dpi=150, format=path.suffix.lstrip(".") or "png")
    return path
