"""The tree of structure elements (Fig. 4): what hangs on what, and by which joint or part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from jaxkin.topology.elements import StructureElement
from jaxkin.view.graph import MAX_LETTERS, STILL, Diagram, write
from jaxkin.view.illustration import INK
from jaxkin.view.sheet import GREY, Color, Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HIGH, BESIDE, LEVEL_DISTANCE = 0.22, 0.36, 0.62
"""In inches: a name in its long circle, between elements of a level, and between levels."""
LOOPS = 8
"""Loops that an element names at most."""
LEVELS, WIDE = 30, 24.0
"""Levels and inches up to which a tree is drawn."""


@dataclass(frozen=True)
class Box:
    """An element in the drawing, in inches."""

    x: float
    """Of its middle."""
    y: float
    """Of its upper side."""
    width: float
    height: float
    lower: tuple[str, ...]
    """The lower adjacent parts in the order of what hangs on them, so that no lines cross."""


def boxes(diagram: Diagram) -> tuple[Box, ...]:
    """Place the elements: leaves side by side, all others over the middle of what hangs on them."""
    elements = diagram.elements
    hanging: list[dict[str, list[int]]] = [{} for _ in elements]
    level = [0] * len(elements)
    for number, element in enumerate(elements):  # an element stands behind the one above
        if element.above is not None:
            hanging[element.above].setdefault(_holder(diagram, element), []).append(number)
            level[number] = level[element.above] + 1
    below = [[child for children in parts.values() for child in children] for parts in hanging]
    widths, heights = [_width(element) for element in elements], [_height(element) for element in elements]
    span = [0.0] * len(elements)
    """What an element needs with all below it."""
    for number in reversed(range(len(elements))):
        own = max(widths[number] + BESIDE, _name_width(_tied(elements[number])) + BESIDE / 3)
        span[number] = max(own, sum(span[child] for child in below[number]))
    middle, top = [0.0] * len(elements), [0.0] * (max(level) + 2)
    for number, depth in enumerate(level):
        top[depth + 1] = min(top[depth + 1], top[depth] - heights[number] - LEVEL_DISTANCE)
    for number, children in enumerate(below):
        left = middle[number] - sum(span[child] for child in children) / 2
        for child in children:
            middle[child] = left + span[child] / 2
            left += span[child]
    return tuple(map(Box, middle, (top[depth] for depth in level), widths, heights, map(tuple, hanging)))


def draw_tree(axes: Axes, diagram: Diagram, places: Sequence[Box], palette: Sequence[Color]) -> None:
    """Draw the elements; a unit of the axes is an inch."""
    for number, (element, box) in enumerate(zip(diagram.elements, places, strict=True)):
        if element.above is not None:
            over = places[element.above]
            holder = _holder(diagram, element) if diagram.elements[element.above].loops else None
            _tie(axes, (over.x if holder is None else _lower(over, holder), over.y - over.height), box, element)
        _element(axes, box, number, element, palette)


def _holder(diagram: Diagram, element: StructureElement) -> str:
    """Find the part of the element above that an element hangs on."""
    if element.joint is None:
        return element.upper
    ends = diagram.ends[diagram.joints.index(element.joint)]
    return next(part for part in ends if part not in element.parts)


def _name_width(name: str) -> float:
    return 0.2 + 0.075 * min(len(name), MAX_LETTERS)


def _width(element: StructureElement) -> float:
    lower = sum(_name_width(part) + 0.06 for part in element.lower)
    if not element.loops:
        return _name_width(element.upper)
    return 0.2 + max(_name_width(element.upper), 0.85, 0.2 * min(len(element.loops), LOOPS), lower)


def _height(element: StructureElement) -> float:
    return HIGH if not element.loops else 2.9 * HIGH + (HIGH + 0.06 if element.lower else 0.0)


def _lower(box: Box, part: str) -> float:
    """Find where a lower adjacent part stands in its element, across."""
    widths = [_name_width(name) + 0.06 for name in box.lower]
    k = box.lower.index(part)
    return box.x - sum(widths) / 2 + sum(widths[:k]) + widths[k] / 2


def _tie(axes: Axes, start: Place, box: Box, element: StructureElement) -> None:
    """Draw the line from the part above, with the joint node on it; the name of the part where they share one."""
    middle = (box.x, box.y + 0.24)
    axes.plot([start[0], middle[0], box.x], [start[1], middle[1], box.y], color=INK, linewidth=0.9, zorder=1)
    style = {"boxstyle": "square,pad=0.3", "facecolor": "white", "edgecolor": "white" if element.joint is None else INK}
    write(axes, middle, _tied(element), size=7, bbox=style | {"linewidth": 0.8}, zorder=3)


def _tied(element: StructureElement) -> str:
    """Name what an element hangs by on the one above."""
    return element.joint or f"at {element.upper}"


def _element(axes: Axes, box: Box, number: int, element: StructureElement, palette: Sequence[Color]) -> None:
    """Draw an element with its loops, its upper adjacent part above them and the lower adjacent ones below."""
    root = element.above is None
    write(axes, (box.x - box.width / 2 - 0.05, box.y - 0.11), f"N{number + 1}", size=6, color=GREY, ha="right")
    if not element.loops:
        _pill(axes, (box.x, box.y - HIGH / 2), element.upper, root, strong=True)
        return
    _frame(axes, (box.x, box.y - box.height / 2), (box.width, box.height), 0.16, "white", 1.2)
    _pill(axes, (box.x, box.y - 0.07 - HIGH / 2), element.upper, root)
    line = box.y - 0.07 - HIGH - 0.12
    write(axes, (box.x, line), element.kind, MAX_LETTERS, size=7, color=GREY, zorder=4)
    shown = element.loops[:LOOPS]
    for k, loop in enumerate(shown):
        more = k == LOOPS - 1 and len(element.loops) > LOOPS
        place, color = (box.x + 0.2 * (k - (len(shown) - 1) / 2), line - 0.14), GREY if more else palette[loop]
        write(axes, place, "…" if more else f"l{loop + 1}", size=6.5, color=color, weight="bold", zorder=4)
    for part in box.lower:
        _pill(axes, (_lower(box, part), box.y - box.height + 0.07 + HIGH / 2), part, False)


def _pill(axes: Axes, at: Place, name: str, fixed: bool, strong: bool = False) -> None:
    """Draw a part in its long circle, as in Fig. 4."""
    _frame(axes, at, (_name_width(name), HIGH), HIGH / 2, STILL if fixed else "white", 1.2 if strong else 0.7)
    write(axes, at, name, size=7.5, zorder=4)


def _frame(axes: Axes, at: Place, size: tuple[float, float], rounding: float, color: object, line_width: float) -> None:
    """Draw a box with round corners about a place."""
    from matplotlib.patches import FancyBboxPatch

    corner = at[0] - size[0] / 2, at[1] - size[1] / 2
    style = f"round,pad=0,rounding_size={rounding}"
    patch = FancyBboxPatch(corner, *size, style, facecolor=color, edgecolor=INK, linewidth=line_width, zorder=2)
    axes.add_patch(patch)
