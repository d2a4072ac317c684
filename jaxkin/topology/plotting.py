"""Where the drawing of a structure comes from: a floor above registers it, so that this one needs no pictures."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from jaxkin.topology.structure import Structure

Plotter = Callable[["Structure"], "Figure"]

_plotters: list[Plotter] = []


def register(plotter: Plotter) -> Plotter:
    """Decorator: the function `(structure) -> figure` draws a structure from now on."""
    _plotters[:] = [plotter]
    return plotter


def plot(structure: Structure) -> Figure:
    """The drawing of a structure; RuntimeError where nothing draws it, which `import jaxkin` mends."""
    if not _plotters:
        raise RuntimeError("nothing is registered to draw a structure: import jaxkin first")
    return _plotters[0](structure)
