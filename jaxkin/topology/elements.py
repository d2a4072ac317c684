"""Structure elements and their tree (Fig. 4).

An element is one closed loop, several loops that share joints, or a part that is in no loop. The element stands in the
tree below the joint or the part that connects the element to the fixed parts. Parts are rows of the incidence matrix: a
row is one part, or all fixed parts together.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from jaxkin.topology.graph import Graph, WalkStep


@dataclass(frozen=True)
class StructureElement:
    """A structure element, a node of the tree: one closed loop, several loops that share joints, or a part."""

    kind: Literal["single loop", "multiple loop", "part"]
    """"part": a part in no loop, or a part that several elements hang on and that no element above contains."""
    parts: tuple[str, ...]
    """Names of the parts of the element (rows of the incidence matrix), the upper adjacent part first."""
    loops: tuple[int, ...]
    """Numbers of the loops of the element, in `Structure.loops`."""
    upper: str
    """Name of the upper adjacent part, which ties the element to the element above; of the root, the fixed parts."""
    lower: tuple[str, ...]
    """Names of the lower adjacent parts, which other elements hang on."""
    joint: str | None
    """Name of the joint node above; None for the root, and where `upper` is itself a part of the element above."""
    above: int | None
    """Number of the element above, in `Structure.elements`; None for the root."""


class ElementNode(NamedTuple):
    """A structure element by indices: of parts as rows of the incidence matrix, of joints as its columns."""

    joints: tuple[int, ...]
    """Joints of the loops of the element, in rising order; none for a part."""
    rows: tuple[int, ...]
    """Parts of the element, the upper adjacent part first."""
    step: WalkStep | None
    """The step over the joint above, downwards; None where there is no such joint."""
    above: int | None
    """Index of the element above; None for the root."""
    depth: int
    """Number of elements on the way from the root to the element."""
    lower: tuple[int, ...] = ()
    """Lower adjacent parts."""

    @property
    def loops(self) -> int:
        """Number of independent loops of the element: its joints less its parts plus one; 0 for a part."""
        return len(self.joints) - len(self.rows) + 1


def element_tree(graph: Graph, root: int) -> tuple[ElementNode, ...]:
    """Build the tree of elements, level by level from the element that contains the part `root`, a row.

    In the paper a joint always connects two elements. Here elements that share a part are connected too: they hang
    below the element that contains the part first. Where no element does (the fixed parts, or the part below a joint,
    in several loops), the part becomes an element by itself, with those loops below it. The tree does not depend on
    the order of parts and joints.
    """
    children = _Children.of(graph)
    nodes = [children.over_joint(root, None, None, 0)]
    placed = set(nodes[0].joints)
    number = 0
    while number < len(nodes):
        below: list[ElementNode] = []
        lower: list[int] = []
        for row in nodes[number].rows:
            new = children.at_row(row, placed, number, nodes[number].depth + 1)
            for child in new:
                placed.update(child.joints)
                placed.update(() if child.step is None else (child.step.joint,))
            lower += [row] if new else []
            below += new
        nodes[number] = nodes[number]._replace(lower=tuple(sorted(lower)))
        nodes += sorted(below, key=lambda child: (child.rows[0], child.joints))
        number += 1
    return tuple(nodes)


class _Children(NamedTuple):
    """What is needed to find the elements that hang below a part of the graph."""

    graph: Graph
    groups_at: Mapping[int, Sequence[tuple[int, ...]]]
    """Part (row) -> the loop groups that contain the part, each as its joints."""
    in_loops: frozenset[int]
    """Joints of all loops."""

    @staticmethod
    def of(graph: Graph) -> _Children:
        groups_at: dict[int, list[tuple[int, ...]]] = defaultdict(list)
        for loop_group in graph.loop_groups:
            for row in {row for joint in loop_group for row in graph.ends[joint]}:
                groups_at[row].append(loop_group)
        return _Children(graph, groups_at, frozenset(joint for loop_group in graph.loop_groups for joint in loop_group))

    def at_row(self, row: int, placed: Container[int], above: int, depth: int) -> list[ElementNode]:
        """Find the elements below a part: loops that contain the part, and what joints outside of loops hang on it.

        Joints that were `placed` in the tree before are left out.
        """
        loops = [
            _node(self.graph, row, loop_group, None, above, depth)
            for loop_group in self.groups_at.get(row, ())
            if loop_group[0] not in placed
        ]
        return loops + [
            self.over_joint(other, step, above, depth)
            for step, other in self.graph.around[row]
            if step.joint not in self.in_loops and step.joint not in placed
        ]

    def over_joint(self, row: int, step: WalkStep | None, above: int | None, depth: int) -> ElementNode:
        """Make the element whose upper adjacent part is `row`: the loops through this part if they are one group, else
        the part alone."""
        groups = self.groups_at.get(row, ())
        return _node(self.graph, row, groups[0] if len(groups) == 1 else (), step, above, depth)


def named(nodes: Sequence[ElementNode], rows: Sequence[str], joints: Sequence[str]) -> tuple[StructureElement, ...]:
    """Replace the indices of nodes by the names of parts (`rows`) and `joints`; number loops element by element."""
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
