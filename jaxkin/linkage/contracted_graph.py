"""Contract the graph of a loop group: parts whose displacements relative to each other are known count as one.

Parts are nodes and joints are edges. A joint whose coordinates are all known is contracted: its two parts get the same
representative. Circuits of what is left are the loops that are still to be solved.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from heapq import heappop, heappush

from jaxkin.topology.graph import Circuit, WalkStep

Ends = Mapping[int, tuple[str, str]]
"""For each joint its part 1 and part 2."""


class ContractedGraph:
    """The graph of a loop group (parts are nodes, joints are edges) in which known joints are contracted."""

    def __init__(self, ends: Ends) -> None:
        self.ends = ends
        self.representative = {part: part for pair in ends.values() for part in pair}
        """For each part the representative of all parts that are known relative to it."""
        self._known: dict[str, list[tuple[int, int, str]]] = {part: [] for part in self.representative}
        """For each part its known joints: (joint, +1 if the part is part 1 of the joint, else -1; other part)."""
        self._group_of: dict[int, int | None] = {}
        """For each known joint the number of the group that was solved for it; None if it is driven."""

    def contract(self, joint: int, group: int | None) -> None:
        """Contract a joint whose coordinates are known from now on: solved by `group`, or driven (None)."""
        part1, part2 = self.ends[joint]
        self._known[part1].append((joint, 1, part2))
        self._known[part2].append((joint, -1, part1))
        self._group_of[joint] = group
        kept, gone = self.representative[part1], self.representative[part2]
        if kept != gone:
            self.representative = {part: kept if own == gone else own for part, own in self.representative.items()}

    def known_joints(self, circuits: Iterable[Circuit]) -> dict[int, int | None]:
        """Return the known joints on closed circuits, each with the group that was solved for it (None: driven)."""
        return {joint: self._group_of[joint] for loop in circuits for joint, _ in loop if joint in self._group_of}

    def known_path(self, start: str, end: str) -> Circuit:
        """Find the path of fewest known joints between two parts of one representative."""
        came: dict[str, tuple[int, int, str] | None] = {start: None}
        queue = deque([start])
        while end not in came:
            part = queue.popleft()
            for joint, sign, other in self._known[part]:
                if other not in came:
                    came[other] = joint, sign, part
                    queue.append(other)
        path: list[WalkStep] = []
        while (step := came[end]) is not None:
            joint, sign, end = step
            path.append(WalkStep(joint, sign))
        return tuple(reversed(path))

    def closed(self, circuit: Circuit) -> Circuit:
        """Turn a circuit of representatives into a closed circuit of parts, by inserting paths of known joints."""
        left = dict(circuit)
        (joint, sign), *_ = circuit
        start = part = self.ends[joint][0 if sign > 0 else 1]
        travelled: list[WalkStep] = []
        while left:
            joint, sign = self._onward(part, left, travelled)
            entered, left_by = self.ends[joint][::sign]
            travelled += [*self.known_path(part, entered), WalkStep(joint, sign)]
            del left[joint]
            part = left_by
        return tuple([*travelled, *self.known_path(part, start)])

    def _onward(self, part: str, left: Mapping[int, int], travelled: Sequence[WalkStep]) -> tuple[int, int]:
        """Find the next joint of a circuit, and its sign: a joint at the representative of `part` among those
        `left`."""
        here = self.representative[part]
        if not travelled:
            return next(iter(left.items()))
        for joint, sign in left.items():
            if self.representative[self.ends[joint][0 if sign > 0 else 1]] == here:
                return joint, sign
        raise AssertionError("the joints are no circuit")

    def _around(self, joints: Iterable[int]) -> dict[str, list[tuple[int, int, str]]]:
        """List for each representative its joints: (joint, sign, other representative)."""
        around: dict[str, list[tuple[int, int, str]]] = {}
        for joint in joints:
            part1, part2 = (self.representative[part] for part in self.ends[joint])
            around.setdefault(part1, []).append((joint, 1, part2))
            around.setdefault(part2, []).append((joint, -1, part1))
        return around

    def lightest(self, weights: Mapping[int, int]) -> set[frozenset[int]]:
        """Find the circuit of least weight through each joint: the joint alone if its ends have one representative."""
        around = self._around(weights)
        return {self._lightest(around, weights, joint) for joint in weights}

    def _lightest(
        self, around: Mapping[str, Sequence[tuple[int, int, str]]], weights: Mapping[int, int], joint: int
    ) -> frozenset[int]:
        """Find the circuit of least weight through one joint, by Dijkstra's algorithm between its two ends."""
        start, end = (self.representative[part] for part in self.ends[joint])
        queue: list[tuple[int, str, tuple[int, ...]]] = [(0, start, ())]
        done: set[str] = set()
        while queue:
            weight, part, path = heappop(queue)
            if part == end:
                return frozenset((joint, *path))
            if part in done:
                continue
            done.add(part)
            for other, _, to in around[part]:
                if other != joint and to not in done:
                    heappush(queue, (weight + weights[other], to, (*path, other)))
        raise AssertionError("every joint of a loop group lies in a circuit")

    def circuits(self, joints: Sequence[int]) -> list[Circuit]:
        """Find independent circuits of representatives through these joints, one for each joint outside a spanning
        tree.

        Each circuit is (joint, sign) with the joint outside the tree first and the others in any order. It holds no
        known joints: `closed` inserts them.
        """
        around = self._around(joints)
        came: dict[str, tuple[int, int, str] | None] = {}
        closing = set(joints)
        for root in around:
            stack = [] if root in came else [root]
            came.setdefault(root, None)
            while stack:
                part = stack.pop()
                for joint, sign, other in around[part]:
                    if other not in came:
                        came[other] = joint, sign, part
                        closing.discard(joint)
                        stack.append(other)

        def to_root(part: str) -> dict[int, int]:
            signs = {}
            while (step := came[part]) is not None:
                joint, sign, part = step
                signs[joint] = sign
            return signs

        circuits = []
        for joint in sorted(closing):
            there, back = (to_root(self.representative[part]) for part in self.ends[joint])
            signs = {j: there.get(j, 0) - back.get(j, 0) for j in {**there, **back}}
            circuits.append((WalkStep(joint, 1), *(WalkStep(j, sign) for j, sign in signs.items() if sign)))
        return circuits


class CycleSpace:
    """A set of linearly independent circuits, kept in row echelon form over the field of two elements.

    Circuits that are independent over this field are independent over the real numbers too.
    """

    def __init__(self) -> None:
        self._rows: dict[int, int] = {}
        """Sums of circuits, one bit a joint, by their highest bit."""

    def add(self, circuit: Circuit) -> bool:
        """Add a circuit; False where it is a sum of circuits that were added before."""
        row = sum(1 << joint for joint, _ in circuit)
        while row:
            top = row.bit_length()
            if top not in self._rows:
                self._rows[top] = row
                return True
            row ^= self._rows[top]
        return False
