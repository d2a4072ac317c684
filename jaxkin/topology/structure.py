"""The structure of a mechanism (Section 4 of the paper), from its parts and joints alone, without any geometry.

`Structure` holds the incidence matrix, independent loops, the tree of structure elements, and the order in which parts
are placed. In this module a row means a row of the incidence matrix: a part, or all fixed parts together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import numpy as np
from jaxtyping import Int

from jaxkin._arguments import several
from jaxkin._files import save_figure
from jaxkin._guesses import Result, no_function
from jaxkin.topology.checks import check_chords, check_connected, check_letters, check_names, merged_name
from jaxkin.topology.components import connected
from jaxkin.topology.describe import describe
from jaxkin.topology.elements import ElementNode, StructureElement, element_tree, named
from jaxkin.topology.graph import Circuit, Graph
from jaxkin.topology.loops import Loop, loop_data

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from jaxkin.view.structure import Diagram


@dataclass(frozen=True)
class LoopGroup:
    """Loops that are solved as one system.

    Without couplings they are those of one structure element, which have joints in common. Couplings between joints
    make one group of all loops that they tie, together with tied joints in no loop.
    """

    joints: tuple[int, ...]
    """Columns in `incidence` of the joints, rising."""
    loops: tuple[Circuit, ...]
    """Each loop as (joint, sign) in order of travel: +1 where a joint is travelled from part 1 to part 2, else -1."""
    couplings: tuple[int, ...] = ()
    """Numbers of the couplings between its joints."""


@dataclass(frozen=True, repr=False)
class Structure(Result):
    """Parts, joints, loops and structure elements of a mechanism, by name; made by `structure`.

    The fields hold the arguments of `structure`; equality and hash depend on them only. The properties are computed
    from the fields on first use.
    """

    part_names: tuple[str, ...]
    """Names of all parts, the fixed ones too, in the given order."""
    joints: tuple[str, ...]
    """Names of the joints: the columns of `incidence` and `cycles`."""
    joint_parts: tuple[tuple[str, str], ...]
    """For each joint the names of part 1 and part 2."""
    fixed: tuple[str, ...]
    """The parts that do not move."""
    chords: tuple[str, ...] | None
    """Names of the joints that the spanning tree leaves out, one for each loop; None to use the basis of short loops
    that `cycle_basis` finds, without a spanning tree."""
    coupled: tuple[tuple[str, ...], ...] = ()
    """For each coupling the names of the joints whose coordinates it ties, such as those of two gear wheels."""

    def __call__(self, *_: object, **__: object) -> NoReturn:
        raise no_function(self, "mechanism.structure")

    @cached_property
    def row_of(self) -> Mapping[str, str]:
        """Map each part to the name of its row in `incidence`: its own name, or that of the row of all fixed parts."""
        merged = merged_name(self.part_names, self.fixed)
        return {part: merged if part in self.fixed else part for part in self.part_names}

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """Names of the rows of `incidence`, in the order of `part_names`.

        All fixed parts share one row, such as "p1&p9", which stands at the place of the first of them.
        """
        return tuple(dict.fromkeys(self.row_of.values()))

    @property
    def incidence(self) -> Int[np.ndarray, "parts joints"]:
        """The incidence matrix, Eq. (2): +1 for part 1 of a joint, -1 for part 2, 0 for other rows.

        A joint between two fixed parts has a column of zeros.
        """
        matrix = np.zeros((len(self.parts), len(self.joints)), int)
        for joint, (row1, row2) in enumerate(self._graph.ends):
            matrix[row1, joint] += 1
            matrix[row2, joint] -= 1
        return matrix

    @property
    def cycles(self) -> Int[np.ndarray, "loops joints"]:
        """The loop matrix, Eq. (5): +1 where a loop travels a joint from part 1 to part 2, -1 from part 2 to part 1.

        No column holds both +1 and -1, since any two loops travel a common joint in the same direction.
        """
        matrix = np.zeros((len(self.loops), len(self.joints)), int)
        for row, loop in zip(matrix, self.loops, strict=True):
            for joint, sign in loop.joints:
                row[joint] = sign
        return matrix

    @cached_property
    def loops(self) -> tuple[Loop, ...]:
        """The independent loops in the order of `loop_groups`: the rows of `cycles` (Tables 3, 5 and 7)."""
        return tuple(self._loop(circuit) for circuits in self._circuits for circuit in circuits)

    @cached_property
    def elements(self) -> tuple[StructureElement, ...]:
        """The structure elements: the tree of Fig. 4, level by level from the element that holds the fixed parts."""
        return named(self._nodes, self.parts, self.joints)

    @cached_property
    def uncoupled_groups(self) -> tuple[LoopGroup, ...]:
        """The loops of each structure element that has loops, in the order of `elements`, without couplings."""
        return tuple(
            LoopGroup(node.joints, loops) for node, loops in zip(self._nodes, self._circuits, strict=True) if loops
        )

    @cached_property
    def loop_groups(self) -> tuple[LoopGroup, ...]:
        """The `uncoupled_groups`, merged where couplings tie them, then the couplings of joints in no loop."""
        return merged_by_couplings(
            self.uncoupled_groups, [tuple(map(self.joints.index, names)) for names in self.coupled]
        )

    @cached_property
    def tree(self) -> tuple[tuple[str, str, int, int], ...]:
        """Rows (part, parent, joint, sign) by which all parts that are not fixed are placed: P_part = P_parent J^sign.

        P is the 4x4 displacement of a part, J that of the joint, whose column in `incidence` is given; sign is +1 where
        the parent is part 1 of the joint, else -1. A parent is fixed or comes in an earlier row. The order is that of
        Section 5.2, by the levels of the element tree: within a level, first the part that hangs on each bridge joint
        (a joint in no loop), then the parts along each loop.
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

    def plot(self, path: str | Path | None = None) -> Figure:
        """Draw the parts and joints with the loops on them, and the tree of Fig. 4: a matplotlib figure, which is
        written into a picture file where a path is given. Raises ValueError for more parts than a drawing can show.
        """
        from jaxkin.view.structure import plot_structure

        figure = plot_structure(diagram(self))
        if path is not None:
            save_figure(figure, Path(path))
        return figure

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
        """The loops of each element of `_nodes`, none for a part in no loop; ValueError for unsuitable chords."""
        chords = None if self.chords is None else [self.joints.index(chord) for chord in self.chords]
        return loop_data(self._graph, self._nodes, chords)

    def _loop(self, circuit: Circuit) -> Loop:
        places = ((self.parts[self._graph.tail(step)], self.joints[step.joint]) for step in circuit)
        return Loop(tuple(name for place in places for name in place), circuit)


def diagram(found: Structure) -> Diagram:
    """Collect what is drawn of a structure."""
    from jaxkin.view.structure import Diagram

    ends = tuple((found.row_of[part1], found.row_of[part2]) for part1, part2 in found.joint_parts)
    return Diagram(found.parts, found.joints, ends, found.row_of[found.fixed[0]], found.loops, found.elements)


def merged_by_couplings(groups: Sequence[LoopGroup], couplings: Sequence[tuple[int, ...]]) -> tuple[LoopGroup, ...]:
    """Merge loop groups that share a coupling; `couplings` are the joints of each, in a loop or not.

    A merged group stands at the place of its first part; groups without loops come last.
    """
    if not couplings:
        return tuple(groups)
    group_of = {joint: ("group", k) for k, group in enumerate(groups) for joint in group.joints}
    ties = [
        (("coupling", number), group_of.get(joint, ("joint", joint)))
        for number, joints in enumerate(couplings)
        for joint in joints
    ]
    alone = [("group", k) for k in range(len(groups))] + [("coupling", k) for k in range(len(couplings))]
    found = []
    for nodes in connected(dict.fromkeys([*alone, *(node for _, node in ties)]), ties):
        own = {kind: sorted(k for each, k in nodes if each == kind) for kind in ("group", "coupling", "joint")}
        joints = sorted({joint for k in own["group"] for joint in groups[k].joints} | set(own["joint"]))
        loops = tuple(loop for k in own["group"] for loop in groups[k].loops)
        place = min(own["group"], default=len(groups) + min(own["coupling"], default=0))
        found.append((place, LoopGroup(tuple(joints), loops, tuple(own["coupling"]))))
    return tuple(group for _, group in sorted(found, key=lambda each: each[0]))


def structure(
    parts: Sequence[str],
    joints: Sequence[tuple[str, str, str]],
    fixed: Sequence[str],
    chords: Sequence[str] | None = None,
) -> Structure:
    """Make the structure of a mechanism from its parts, joints (name, part 1, part 2) and fixed parts.

    Parts are a list of names, or one text if its letters are their names, as "ABCD" for four parts.

    `chords` names the joints that a spanning tree leaves out. Each chord closes one loop with the tree (Eq. 3). The
    loop travels its chord from part 1 to part 2, or is reversed where that makes all loops travel a common joint in
    the same direction. Without `chords`, a basis of short loops of that kind is found (`cycle_basis`), in which the
    last joint of each loop group is travelled from part 1 to part 2.

    A joint between two fixed parts is a loop of one joint, which closes only while the joint stays at rest. Raises
    ValueError for names that repeat or are unknown, a joint between a part and itself, no fixed part, parts that no
    chain of joints connects to a fixed one, chords that do not leave a spanning tree, and chords whose loops no
    reversal gives common directions.
    """
    parts = parts if isinstance(parts, str) else several(parts, "parts", "part names")
    fixed = several(fixed, "fixed", "part names")
    joints = several(joints, "joints", "joints (name, part 1, part 2)", "[('A', 'base', 'crank')]")
    if wrong := [joint for joint in joints if not isinstance(joint, tuple | list) or len(joint) != 3]:
        raise ValueError(f"a joint is given as (name, part 1, part 2), got {wrong[0]!r}")
    if isinstance(parts, str):
        check_letters(parts, joints, fixed)
    check_names(tuple(parts), joints, fixed)
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
