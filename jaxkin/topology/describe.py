"""The text of `print(structure)`: the tree of structure elements with their loops."""

from __future__ import annotations

from collections.abc import Sequence

from jaxkin.topology.elements import StructureElement
from jaxkin.topology.loops import Loop


def describe(elements: Sequence[StructureElement], loops: Sequence[Loop]) -> str:
    """Write the tree of Fig. 4: one line an element, indented below the element above it, then the loops it has."""
    below: dict[int | None, list[int]] = {}
    for number, element in enumerate(elements):
        below.setdefault(element.above, []).append(number)
    lines: list[str] = []
    stack = [(0, 0)]
    while stack:
        number, depth = stack.pop()
        element = elements[number]
        lines.append("  " * depth + _line(element))
        lines += ["  " * depth + f"    l{loop + 1}: {loops[loop]}" for loop in element.loops]
        stack += [(child, depth + 1) for child in reversed(below.get(number, []))]
    return "\n".join(lines)


def _line(element: StructureElement) -> str:
    what = element.kind if element.kind == "part" else f"{element.kind} of"
    if element.above is None:
        tie = "fixed"
    elif element.joint is None:
        tie = f"at {element.upper}"
    else:
        tie = f"by {element.joint}"
    return f"{what} {', '.join(element.parts)} ({tie})"
