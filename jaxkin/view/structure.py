"""The drawing of a structure: the graph of parts and joints with its loops, and the tree of Fig. 4 beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from jaxkin._files import DPI
from jaxkin._names import counted
from jaxkin.view.graph import Diagram, colors, draw_graph, lines_of, places, reach_of_names
from jaxkin.view.illustration import INK
from jaxkin.view.sheet import GREY, Place, clip
from jaxkin.view.tree import LEVELS, WIDE, boxes, draw_tree

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEGEND = 12
"""Loops that the legend lists at most."""
LETTERS_PER_INCH = 16
"""Of the legend, on an inch."""
AROUND, TITLE_HEIGHT, LEGEND_LINE = 0.45, 0.5, 0.19
"""In inches: around the drawings, for the title, and a line of the legend."""


def plot_structure(diagram: Diagram) -> Figure:
    """Draw a figure with two drawings: every loop has one colour in both, and runs the way its arrows point.

    A tree too deep or too wide to be read is left out. Raises ValueError for more parts than a drawing can show.
    """
    from matplotlib.figure import Figure

    at = places(diagram, width=min(10.0, 1.6 + 0.3 * len(diagram.parts)))
    lines = lines_of(diagram, at)
    points = np.concatenate([np.array(list(at.values())), *lines.values()])
    tree = boxes(diagram)
    left, right = min(box.x - box.width / 2 for box in tree), max(box.x + box.width / 2 for box in tree)
    bottom = min(box.y - box.height for box in tree)
    drawn = right - left <= WIDE and len({box.y for box in tree}) <= LEVELS
    beside = max(AROUND, reach_of_names(diagram))
    across = [np.ptp(points[:, 0]) + 2 * beside, (right - left if drawn else 1.5) + 2 * AROUND]
    high = max(np.ptp(points[:, 1]), -bottom if drawn else 0.0, 1.0) + 2 * AROUND
    listed = min(len(diagram.loops), LEGEND) + (len(diagram.loops) > LEGEND)
    foot = 0.1 + LEGEND_LINE * listed
    width, height = sum(across), TITLE_HEIGHT + high + foot
    figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")

    def drawing(x: float, wide: float, centre: Place) -> Axes:
        """Make axes in inches, with a point in their middle."""
        axes = figure.add_axes((x / width, foot / height, wide / width, high / height))
        axes.set_xlim(centre[0] - wide / 2, centre[0] + wide / 2)
        axes.set_ylim(centre[1] - high / 2, centre[1] + high / 2)
        axes.set_axis_off()
        return axes

    palette = colors(len(diagram.loops))
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    draw_graph(drawing(0.0, across[0], (centre[0], centre[1])), diagram, at, lines, palette)
    if drawn:
        draw_tree(drawing(across[0], across[1], ((left + right) / 2, bottom / 2)), diagram, tree, palette)

    def write(x: float, y: float, text: str, size: int, color: object, weight: str = "normal") -> None:
        figure.text(x / width, y / height, text, size=size, color=color, weight=weight, va="center", parse_math=False)

    loops = counted(len(diagram.loops), "loop")
    write(0.2, height - 0.3, f"{len(diagram.parts)} parts, {len(diagram.joints)} joints, {loops}", 11, INK, "bold")
    if not drawn:
        write(across[0], TITLE_HEIGHT + high / 2, f"a tree of {len(tree)} elements:\nprint the structure", 7, GREY)
    for k in range(listed):
        more = k == LEGEND
        text = f"and {len(diagram.loops) - LEGEND} more" if more else f"l{k + 1}   {diagram.loops[k]}"
        write(
            0.2,
            foot - LEGEND_LINE * (k + 0.5),
            clip(text, int(LETTERS_PER_INCH * width)),
            7,
            GREY if more else palette[k],
        )
    return figure
