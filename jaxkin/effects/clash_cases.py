"""Find what of a search for clashes is the same for several pairs of parts, or at several poses: it is searched once.

Assemblies repeat: two hinges of a door have the same screws at the same places, and a crank that turns twice is
everywhere twice. Two meshes in the same places relative to each other are as near as two others of the same kind.
"""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import blake2b
from typing import NamedTuple

import numpy as np
from jaxtyping import Int

from jaxkin.effects.clash_shapes import ClashShape
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.tree_crossings import Slack

_SAME = 1e-9
"""Share of the size of a mechanism by which two places may differ and be one: so little are clearances off by it."""


class ClashCase(NamedTuple):
    """Two meshes that may clash."""

    one: ClashShape
    other: ClashShape
    slack: Slack
    joined: bool
    """Whether faces of theirs are in contact by design."""
    moved: Displaced
    """The displacements of the other mesh relative to the one."""

    def exchanged(self) -> ClashCase:
        """Say the same with the other mesh first."""
        return ClashCase(self.other, self.one, self.slack.exchanged(), self.joined, self.moved.inverse())


class DistinctCases(NamedTuple):
    """Cases that differ, each at displacements that differ."""

    cases: list[ClashCase]
    which: list[int]
    """The case of each one that was given."""
    poses: list[Int[np.ndarray, " poses"]]
    """For each displacement of each one that was given its displacement in that case."""


def distinct_cases(given: Sequence[ClashCase], size: float) -> DistinctCases:
    """Leave out cases and displacements that repeat others; `size` is that of the mechanism."""
    found = DistinctCases([], [], [])
    known: dict[bytes, int] = {}
    for case in given:
        case, key, first, inverse = _oriented(case, size)
        if key not in known:
            known[key] = len(found.cases)
            found.cases.append(case._replace(moved=case.moved.at(first)))
        found.which.append(known[key])
        found.poses.append(inverse)
    return found


def _oriented(case: ClashCase, size: float) -> tuple[ClashCase, bytes, np.ndarray, np.ndarray]:
    """Put the mesh of the smaller number first, or else the one whose key is less.

    Returns the case, its key, its distinct displacements in the order of their first appearance, and the number among
    these of each displacement.
    """
    if case.one.number > case.other.number:
        case = case.exchanged()
    found = (case, *_key(case, size))
    if case.one.number == case.other.number:
        exchanged = case.exchanged()
        found = min(found, (exchanged, *_key(exchanged, size)), key=lambda each: each[1])
    return found


def _key(case: ClashCase, size: float) -> tuple[bytes, np.ndarray, np.ndarray]:
    """Make the key of a case, find its distinct displacements, and the number of each displacement among these."""
    rows = np.column_stack([case.moved.rotation.reshape(-1, 9), case.moved.shift / size])
    rows = np.round(rows / _SAME).astype(np.int64)
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), int)
    rank[order] = np.arange(len(order))
    first, inverse = first[order], rank[inverse.ravel()]
    key = blake2b(np.array([case.one.number, case.other.number, case.joined, len(first)]).tobytes())
    key.update(rows[first].tobytes())
    for each in (case.slack.first, case.slack.second, np.packbits(case.slack.ignored)):
        key.update(np.ascontiguousarray(each).tobytes())
    return key.digest(), first, inverse
