"""Structure elements and their tree (Fig. 4): loops and parts in no loop, each below the joint or part it hangs on."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from jaxkin.topology.graph import Graph, WalkStep


@dataclass(frozen=True)
class StructureElement:
    """A structure element node of the tree: one closed loop, several that share joints, or a part."""

    kind: Literal["single loop", "multiple loop", "part"]
    """"part": a part in no loop, or one that several elements hang on and that none above holds."""
    parts: tuple[str, ...]
    """Its rows, the upper adjacent part first."""
    loops: tuple[int, ...]
    """Numbers of its loops."""
    upper: str
    """Upper adjacent part, which ties the element to the one above; of the root, the fixed parts."""
    lower: tuple[str, ...]
    """Lower adjacent parts, which other elements hang on."""
    joint: str | None
    """The joint node above; None for the root, and where `upper` is itself a part of the element above."""
    above: int | None
    """Number of the element above; None for the root."""


class ElementNode(NamedTuple):
    """A structure element in numbers."""

    joints: tuple[int, ...]
    """Joints of its loops, rising."""
    rows: tuple[int, ...]
    """The upper adjacent part first."""
    step: WalkStep | None
    """Over the joint above, downwards."""
    above: int | None
    depth: int
    """Number of elements above it."""
    lower: tuple[int, ...] = ()

    @property
    def loops(self) -> int:
        """Number of its independent loops."""
        return len(self.joints) - len(self.rows) + 1


def element_tree(graph: Graph, root: int) -> tuple[ElementNode, ...]:
    """The elements, level by level from the one that holds the root row.

    The paper ties elements by joints only. Here those that share a part hang below the one that holds the part first;
    where none does (the fixed parts, or the part below a joint, in several loops), the part is an element of its own
    and they hang on it. So the tree does not depend on the order of parts and joints.
    """
    loop_groups = graph.loop_groups
    groups_at: dict[int, list[tuple[int, ...]]] = defaultdict(list)
    for loop_group in loop_groups:
        for row in {row for joint in loop_group for row in graph.ends[joint]}:
            groups_at[row].append(loop_group)
    in_loops = {joint for loop_group in loop_groups for joint in loop_group}

    def below_joint(row: int, step: WalkStep | None, above: int | None, depth: int) -> ElementNode:
        loop_group = groups_at[row][0] if len(groups_at[row]) == 1 else ()
        return _node(graph, row, loop_group, step, above, depth)

    nodes = [below_joint(root, None, None, 0)]
    placed = set(nodes[0].joints)
    number = 0
    while number < len(nodes):
        node = nodes[number]
        below: list[ElementNode] = []
        lower: list[int] = []
        for row in node.rows:
            new = [
                _node(graph, row, loop_group, None, number, node.depth + 1)
                for loop_group in groups_at[row]
                if loop_group[0] not in placed
            ]
            new += [
                below_joint(other, step, number, node.depth + 1)
                for step, other in graph.around[row]
                if step.joint not in in_loops and step.joint not in placed
            ]
            for child in new:
                placed.update(child.joints)
                placed.update(() if child.step is None else (child.step.joint,))
            lower += [row] if new else []
            below += new
        nodes[number] = node._replace(lower=tuple(sorted(lower)))
        nodes += sorted(below, key=lambda child: (child.rows[0], child.joints))
        number += 1
    return tuple(nodes)


def named(nodes: Sequence[ElementNode], rows: Sequence[str], joints: Sequence[str]) -> tuple[StructureElement, ...]:
    """The elements by the names of rows and joints; loops are numbered element by element."""
    elements: list[StructureElement] = []
    first = 0
    for node in nodes:
        elements.append(
            StructureElement(
                kind="part" if node.loops == 0 else "single loop" if node.loops == 1 else "multiple loop",
                parts=tuple(rows[row] for row in node.rows),
                loops=tuple(range(first, first + node.loops)),
                upper=rows[node.rows[0]],
                lower=tuple(rows[row] for row in node.lower),
                joint=None if node.step is None else joints[node.step.joint],
                above=node.above,
            )
        )
        first += node.loops
    return tuple(elements)


def _node(
    graph: Graph, row: int, loop_group: tuple[int, ...], step: WalkStep | None, above: int | None, depth: int
) -> ElementNode:
    others = {other for joint in loop_group for other in graph.ends[joint]} - {row}
    return ElementNode(loop_group, (row, *sorted(others)), step, above, depth)
