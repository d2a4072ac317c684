"""The structure of a mechanism: incidence, independent loops, and the order in which parts are placed (Section 4)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Int

from jaxkin.topology.checks import check_chords, check_connected, check_names, merged_name
from jaxkin.topology.describe import describe
from jaxkin.topology.elements import ElementNode, StructureElement, element_tree, named
from jaxkin.topology.graph import Circuit, Graph
from jaxkin.topology.loops import Loop, loop_data

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class LoopGroup:
    """The loops of one structure element: they share joints and are solved together."""

    joints: tuple[int, ...]
    """Columns of the joints of its loops, rising."""
    loops: tuple[Circuit, ...]
    """Each loop as (joint, sign) in order of travel: +1 where a joint is travelled from part 1 to part 2, else -1."""


@dataclass(frozen=True)
class Structure:
    """Parts, joints, loops and structure elements of a mechanism, by name; made by `structure`.

    The fields are the arguments of `structure`, and alone determine equality and hash. All else is computed from them
    once, when it is first asked for.
    """

    part_names: tuple[str, ...]
    """All parts."""
    joints: tuple[str, ...]
    """Names of the joints: the columns of `incidence` and `cycles`."""
    joint_parts: tuple[tuple[str, str], ...]
    """For each joint part 1 and part 2."""
    fixed: tuple[str, ...]
    """The parts that do not move."""
    chords: tuple[str, ...] | None
    """The joints that the spanning tree leaves out, one for each loop; None for short loops."""

    @cached_property
    def row_of(self) -> Mapping[str, str]:
        """For each part the name of its row in `incidence`: its own name, or that of the row of all fixed parts."""
        merged = merged_name(self.part_names, self.fixed)
        return {part: merged if part in self.fixed else part for part in self.part_names}

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """Names of the rows of `incidence`: the parts; the fixed ones are one row, "p1&p9", where the first is."""
        return tuple(dict.fromkeys(self.row_of.values()))

    @property
    def incidence(self) -> Int[np.ndarray, "parts joints"]:
        """Eq. (2): +1 for part 1, -1 for part 2. A joint between two fixed parts has a column of zeros."""
        matrix = np.zeros((len(self.parts), len(self.joints)), int)
        for joint, (row1, row2) in enumerate(self._graph.ends):
            matrix[row1, joint] += 1
            matrix[row2, joint] -= 1
        return matrix

    @property
    def cycles(self) -> Int[np.ndarray, "loops joints"]:
        """Eq. (5): +1 where a loop travels a joint from part 1 to part 2, -1 against it. No column holds both."""
        matrix = np.zeros((len(self.loops), len(self.joints)), int)
        for row, loop in zip(matrix, self.loops, strict=True):
            for joint, sign in loop.joints:
                row[joint] = sign
        return matrix

    @cached_property
    def loops(self) -> tuple[Loop, ...]:
        """The independent loops, element by element: the rows of `cycles` (Tables 3, 5 and 7)."""
        return tuple(self._loop(circuit) for circuits in self._circuits for circuit in circuits)

    @cached_property
    def elements(self) -> tuple[StructureElement, ...]:
        """The tree of Fig. 4, level by level from the element that holds the fixed parts."""
        return named(self._nodes, self.parts, self.joints)

    @cached_property
    def loop_groups(self) -> tuple[LoopGroup, ...]:
        """The elements with loops, in the order of `elements`."""
        return tuple(
            LoopGroup(node.joints, loops) for node, loops in zip(self._nodes, self._circuits, strict=True) if loops
        )

    @cached_property
    def tree(self) -> tuple[tuple[str, str, int, int], ...]:
        """(part, parent, joint, sign) for each part that is not fixed, each after its parent: P_part = P_parent J^sign.

        P is the displacement of a part and J that of the joint, given by its column. The order is that of Section 5.2,
        level by level of `elements`: first the parts below the joints of the level, then those of its loops.
        """
        steps = []
        for _, level in groupby(zip(self._nodes, self._circuits, strict=True), key=lambda pair: pair[0].depth):
            level = list(level)
            steps += [node.step for node, _ in level if node.step is not None]
            steps += [step for _, circuits in level for circuit in circuits for step in circuit]
        placed = set(self.fixed)
        tree = []
        for joint, sign in steps:
            parent, part = self.joint_parts[joint][::sign]
            if part not in placed:
                placed.add(part)
                tree.append((part, parent, joint, sign))
        return tuple(tree)

    def plot(self) -> Figure:
        """Draw the parts and joints with the loops on them, and the tree of Fig. 4: a matplotlib figure.

        `plot().savefig("loops.png")` writes it. Raises ValueError for more parts than a drawing can show.
        """
        from jaxkin.view.structure import plot_structure

        return plot_structure(self)

    def __str__(self) -> str:
        return describe(self.elements, self.loops)

    @cached_property
    def _graph(self) -> Graph:
        number = {row: i for i, row in enumerate(self.parts)}
        ends = tuple((number[self.row_of[part1]], number[self.row_of[part2]]) for part1, part2 in self.joint_parts)
        return Graph(len(self.parts), ends)

    @cached_property
    def _nodes(self) -> tuple[ElementNode, ...]:
        return element_tree(self._graph, self.parts.index(self.row_of[self.fixed[0]]))

    @cached_property
    def _circuits(self) -> tuple[tuple[Circuit, ...], ...]:
        chords = None if self.chords is None else [self.joints.index(chord) for chord in self.chords]
        return loop_data(self._graph, self._nodes, chords)

    def _loop(self, circuit: Circuit) -> Loop:
        places = ((self.parts[self._graph.tail(step)], self.joints[step.joint]) for step in circuit)
        return Loop(tuple(name for place in places for name in place), circuit)


def structure(
    parts: Sequence[str],
    joints: Sequence[tuple[str, str, str]],
    fixed: Sequence[str],
    chords: Sequence[str] | None = None,
) -> Structure:
    """Make the structure of a mechanism from its parts, joints (name, part 1, part 2) and fixed parts.

    `chords` names the joints that a spanning tree leaves out. Each chord closes one loop with the tree (Eq. 3), which
    travels it from part 1 to part 2; some loops are reversed so that all travel each joint in one direction. By default
    the loops are short, found in one direction (`cycle_basis`), the last joint of each element from part 1 to part 2.

    A joint between two fixed parts is a loop by itself: it is closed at rest only. Raises ValueError for names that
    repeat or are unknown, a joint between a part and itself, no fixed part, parts that no chain of joints ties to the
    fixed ones, and chords that belong to no spanning tree or whose loops cannot have one direction.
    """
    check_names(parts, joints, fixed)
    names = tuple(name for name, _, _ in joints)
    check_chords(names, chords)
    ends = tuple((part1, part2) for _, part1, part2 in joints)
    result = Structure(tuple(parts), names, ends, tuple(fixed), None if chords is None else tuple(chords))
    check_connected(result._graph, result.parts, result.parts.index(result.row_of[fixed[0]]))
    try:
        result.loops  # noqa: B018  so that chords are refused here, not later
    except ValueError as error:
        raise ValueError(f"chords [{', '.join(map(repr, result.chords or ()))}]: {error}") from None
    return result
