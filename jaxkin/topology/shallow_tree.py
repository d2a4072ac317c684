"""A spanning tree for formats that hold a tree and close loops beside it: as shallow as the graph allows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Branch(NamedTuple):
    """A part, and the joint by which it hangs on another one."""

    part: str
    parent: str
    joint: int
    sign: int
    """+1 where the parent is part 1 of the joint, else -1."""


def shallow_tree(
    joint_parts: Sequence[tuple[str, str]], roots: Sequence[str], costs: Sequence[int]
) -> tuple[Branch, ...]:
    """Hang each part on the roots over as few joints as lead there; parents come before their children.

    Of several joints that lead to a part over as few, the one of the least cost is in the tree, such as its number of
    freedoms: what is left to close the loops is then what constrains least.
    """
    around: dict[str, list[tuple[int, int]]] = {}
    for number, parts in enumerate(joint_parts):
        for sign, part in zip((1, -1), parts, strict=True):
            around.setdefault(part, []).append((number, sign))
    placed = set(roots)
    level, tree = list(dict.fromkeys(roots)), []
    while level:
        reached: dict[str, Branch] = {}
        for parent in level:
            for number, sign in around.get(parent, ()):
                part = joint_parts[number][1 if sign > 0 else 0]
                if part not in placed and (part not in reached or costs[number] < costs[reached[part].joint]):
                    reached[part] = Branch(part, parent, number, sign)
        tree += reached.values()
        placed |= reached.keys()
        level = list(reached)
    return tuple(tree)
