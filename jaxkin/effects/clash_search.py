"""Measure the clearances of many pairs of meshes, each at displacements of its own, in pieces that bound the memory."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.effects.clash_cases import ClashCase
from jaxkin.effects.clash_shapes import ClashShape
from jaxkin.effects.invariant_faces import invariant
from jaxkin.effects.penetration import Cuts, depths
from jaxkin.effects.sampled_depths import sampled_depths
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.solid_pairs import Forest, SolidPairs, forest
from jaxkin.geometry.tree_crossings import Crossings, crossings, may_overlap
from jaxkin.geometry.tree_distances import distances

_AT_ONCE = 1 << 12
"""Displacements of all pairs that are searched at once: what bounds the memory of their intervals, and how often it is
told how far the search has come."""
_AT_FIRST = 1 << 9
"""Displacements that are searched before the others, and tell how long these will take."""


def clearances(
    cases: Sequence[ClashCase], within: float, still: float, told: Callable[[int, int], None] | None = None
) -> list[Float[np.ndarray, " poses"]]:
    """Measure the clearance of each case at each of its displacements; infinite beyond `within`.

    Less than 0 is the depth of a clash. Faces that all displacements of joined meshes leave in place, to `still`, may
    touch; where joined meshes do not clash, the clearance is 0. `told(done, total)` is called after each piece of the
    displacements.
    """
    shapes: dict[int, ClashShape] = {}
    for case in cases:
        shapes[case.one.number], shapes[case.other.number] = case.one, case.other
    if not shapes:
        return []
    solids, at = forest([shape.tree for shape in shapes.values()]), {number: k for k, number in enumerate(shapes)}
    found, done, total = [], 0, sum(len(case.moved.shift) for case in cases)
    for some in _pieces(cases):
        found += _Piece(some, solids, at, still).clearances(within)
        done += sum(len(case.moved.shift) for case in some)
        if told:
            told(done, total)
    return found


def _pieces(cases: Sequence[ClashCase]) -> Iterator[Sequence[ClashCase]]:
    """Divide cases into pieces with so many displacements, fewer in the first, or with one case."""
    total = np.cumsum([len(case.moved.shift) for case in cases]) + _AT_ONCE - _AT_FIRST
    for piece in np.split(np.arange(len(cases)), np.flatnonzero(np.diff(total // _AT_ONCE)) + 1):
        yield [cases[k] for k in piece]


class _Piece:
    """Cases that are searched together."""

    def __init__(self, cases: Sequence[ClashCase], solids: Forest, at: dict[int, int], still: float):
        self.cases, self.solids = list(cases), solids
        self.numbers = [(at[case.one.number], at[case.other.number]) for case in cases]
        self._ignore_invariant(still)
        self.pairs = self._pairs(range(len(cases)), [case.moved for case in cases])

    def _pairs(self, which: Sequence[int], moved: Sequence[Displaced]) -> SolidPairs:
        """Join some of the cases, each at displacements that are given."""
        return SolidPairs.of(self.solids, [self.numbers[k] for k in which], moved)

    def _ignore_invariant(self, still: float) -> None:
        """Let faces of joined meshes that stay in place touch, if nothing clashes at the first displacement."""
        joined = [k for k, case in enumerate(self.cases) if case.joined]
        if not joined:
            return
        pairs = self._pairs(joined, [self.cases[k].moved.at(np.array([0])) for k in joined])
        clash = set(crossings(pairs, [self.cases[k].slack for k in joined]).place.tolist())
        for place, k in enumerate(joined):
            case = self.cases[k]
            if place not in clash:
                ignored = case.slack.ignored | invariant(case.one, case.other, case.moved, still)
                self.cases[k] = case._replace(slack=case.slack._replace(ignored=ignored))

    def clearances(self, within: float) -> list[np.ndarray]:
        """Measure the clearances of each case."""
        pairs, slacks = self.pairs, [case.slack for case in self.cases]
        crossed = crossings(pairs, slacks)
        crossed = Crossings(*np.stack(crossed)[:, np.argsort(crossed.place, kind="stable")])
        near = may_overlap(pairs, slacks[0].least)
        result = np.zeros(len(pairs.pair))
        ends = np.append(pairs.begin[1:], len(result))
        for k in np.unique(pairs.pair[near]):
            here = slice(pairs.begin[k], ends[k])
            result[here] = -self._depths(k, crossed, np.flatnonzero(near[here]))
        joined = np.array([case.joined for case in self.cases])
        (free,) = np.nonzero((result == 0) & ~joined[pairs.pair])
        if len(free):
            result[free] = distances(pairs.at(free), within) if within else np.inf
        return np.split(result, pairs.begin[1:])

    def _depths(self, k: int, crossed: Crossings, near: np.ndarray) -> np.ndarray:
        """Measure how deep the meshes of a case are in each other; `near` are the displacements where they may be."""
        one, other, slack, _, moved = self.cases[k]
        begin = self.pairs.begin[k]
        own = slice(*np.searchsorted(crossed.place, [begin, begin + len(moved.shift)]))
        place, *triangles = (each[own] for each in crossed)
        first, second = (
            each - self.solids.first[number] for each, number in zip(triangles, self.numbers[k], strict=True)
        )
        on_faces, amid = sampled_depths(one, other, moved, slack, near)
        suspects = np.union1d(place - begin, np.flatnonzero(np.maximum(on_faces, amid)))
        result = np.zeros(len(moved.shift))
        if len(suspects):
            cuts = Cuts(np.searchsorted(suspects, place - begin), first, second)
            deep = np.maximum(depths(one, other, moved.at(suspects), cuts, slack), on_faces[suspects])
            # two solids that coincide have no point of their surfaces in each other
            result[suspects] = np.where(deep > 0, deep, amid[suspects])
        return result
