"""All poses over a grid of two inputs to which steps lead past no singular pose: several a node, on several sheets.

No step leads to a pose beyond the limits of joints, nor from one.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np
from jaxtyping import Float, Int

from jaxkin.effects.grid_steps import GridSteps, NodeInputs, neighbours
from jaxkin.effects.mode_limits import WithinLimits
from jaxkin.effects.mode_search import SAME_POSE, SAME_POSE_SINGLE
from jaxkin.mechanism.motion import Motion

MAX_POSES = 256
"""Most poses of a node: a mechanism with more than Dietmaier's forty is not known, and what is a continuum is refused
before memory is full."""


class Sheets:
    """The poses that were found, in the order in which they were, and which of them a step connects."""

    def __init__(self, steps: GridSteps, inputs: NodeInputs, shape: tuple[int, int], within: WithinLimits) -> None:
        self.steps, self.inputs, self.shape, self.within = steps, inputs, shape, within
        self.node: list[int] = []
        """The node of each pose."""
        self.pairs: list[tuple[int, int]] = []
        """Poses that a step connects."""
        self._states: list[list[np.ndarray]] = []
        """For each pose the arrays of its states, loop group after loop group."""
        self._at: dict[int, list[int]] = defaultdict(list)
        """The poses of each node."""
        self._features: list[np.ndarray] = []
        single = inputs.dtype == np.float32
        self._same = SAME_POSE_SINGLE if single else SAME_POSE

    def begin(self, node: int, modes: Motion) -> None:
        """Put the modes at a node: poses 0, 1 and so on. Raises ValueError for modes that are one pose."""
        every = [part for state in self.steps.states_of(modes.displacements) for part in state]
        for mode in range(len(modes)):
            if self._add(node, [part[..., mode] for part in every]) != mode:
                raise ValueError(f"mode {mode + 1} is another one, but for a full turn: it is there twice")

    def spread(self) -> None:
        """Step from all poses to the neighbours of their nodes, and on from these, until no more poses are found."""
        newest = np.arange(len(self.node))
        every = [np.stack(part, axis=-1) for part in zip(*self._states, strict=True)]
        newest = newest[self.within.of(np.array(self.node, int), every)]
        while len(newest):
            which, end = neighbours(np.array(self.node)[newest], self.shape)
            begin = newest[which]
            arrays = [np.stack(part, axis=-1) for part in zip(*(self._states[k] for k in begin), strict=True)]
            states = list(zip(arrays[::2], arrays[1::2], strict=True))
            there = np.array(self.node)[begin]
            found = self.steps.follow(states, self.inputs[:, there], self.inputs[:, end])
            parts, known = [np.asarray(part) for state in found.states for part in state], len(self.node)
            for number in np.flatnonzero(np.asarray(found.taken) & self.within.of(end, parts)):
                pose = self._add(int(end[number]), [part[..., number] for part in parts])
                self.pairs.append((int(begin[number]), pose))
            newest = np.arange(known, len(self.node))

    def regions(self, modes: int) -> tuple[tuple[tuple[int, ...], ...], Int[np.ndarray, "regions first second"]]:
        """Collect the modes of each region, the first poses, and how many poses a region has at each node."""
        from scipy.sparse.csgraph import connected_components

        _, label = connected_components(self._graph(), directed=False)
        found = list(dict.fromkeys(label[:modes].tolist()))
        counts = np.zeros((len(found), self.shape[0] * self.shape[1]), int)
        for number, each in enumerate(found):
            np.add.at(counts[number], np.array(self.node)[label == each], 1)
        members = tuple(tuple(np.flatnonzero(label[:modes] == each).tolist()) for each in found)
        return members, counts.reshape(-1, *self.shape)

    def path(self, one: int, other: int) -> Int[np.ndarray, " nodes"]:
        """Find the nodes of a shortest path from one pose to another, which steps connect."""
        from scipy.sparse.csgraph import breadth_first_order

        _, before = breadth_first_order(self._graph(), one, directed=False)
        poses = [other]
        while poses[-1] != one:
            poses.append(int(before[poses[-1]]))
        return np.array(self.node)[poses[::-1]]

    def _graph(self):
        """Make the graph of all poses: a sparse matrix with an entry for each pair that a step connects."""
        from scipy.sparse import coo_array

        count = len(self.node)
        begin, end = np.array(self.pairs, int).reshape(-1, 2).T
        return coo_array((np.ones(len(begin)), (begin, end)), shape=(count, count)).tocsr()

    def _add(self, node: int, state: list[np.ndarray]) -> int:
        """Add a pose to a node unless it is there; returns its number."""
        own = self._feature(state)
        for pose in self._at[node]:
            if np.max(np.abs(self._features[pose] - own)) <= self._same:
                return pose
        if len(self._at[node]) == MAX_POSES:
            raise ValueError(f"{MAX_POSES} poses for one pair of inputs: the modes are no separate poses")
        self._at[node].append(len(self.node))
        self.node.append(node)
        self._states.append(state)
        self._features.append(own)
        return len(self.node) - 1

    def _feature(self, state: list[np.ndarray]) -> Float[np.ndarray, " _"]:
        """Compute lengths, cosines and sines of angles, rotations of balls: the same for poses full turns apart."""
        found = []
        for system, x, turns in zip(self.steps.systems, state[::2], state[1::2], strict=True):
            length = np.array(system.is_length, bool)
            found += [x[length], np.cos(x[~length]), np.sin(x[~length])]
            found += [np.outer(turn, turn)[np.triu_indices(4)] for turn in turns]
        return np.concatenate(found)
