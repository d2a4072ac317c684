"""Faces that are tangent to each other, grown one after the other out of smoothly joined facets.

From a facet with those around it, or with its two neighbours in a band, to all facets around whose corners lie on the
same surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from jaxkin.geometry.components import components, grouped
from jaxkin.geometry.facets import Facets, Rows
from jaxkin.geometry.surfaces import Plane, Surface
from jaxkin.geometry.tessellation_test import CHORD_ANGLE, MAX_WIDTH_RATIO, arcs, on, surface_of
from jaxkin.geometry.torus import Torus

TIGHT_TOLERANCE, LOOSE_TOLERANCE = 0.5, 5.0
"""Times the rounding: kernels cut faces less exactly than their numbers are written, but a few facets of a torus are
within the looser one of a cylinder."""

MAX_FAILURES = 300
"""Seeds in a row from which no face could be grown, after which the search for such ends: free forms take no longer."""

MAX_WORK = 100_000_000
"""Triangles compared with a surface, each time counted, after which all search ends: bounds the time of any mesh."""

_MAX_ROUNDS = 8
"""From few facets to the whole face in fewer: the surface of a few is off farther away."""

_FACET_SHARE = 0.9
"""Of the area of a facet: the surface that it is of, but for a small triangle of the next face in the same plane."""

_MAX_AREA_RATIO = 100.0
"""How many times as large as another one the facets of one seed may be."""

_SMALL_TRIANGLE_RATIO = 10.0
"""So many times as small as the triangles of a face is what is left out of it, if the face fits without."""

_FLAT_FACE_RATIO = 4.0
"""A flat face is so many times as large as the facets of the free form around it."""


@dataclass(frozen=True, eq=False)
class Region:
    """Triangles that make up one face."""

    surface: Surface | Torus | None
    """None where they lie on none of these surfaces."""
    rows: Rows
    """Which triangles, in order."""

    @property
    def is_round(self) -> bool:
        return self.surface is not None and not isinstance(self.surface, Plane)


class RegionGrowing:
    """The facets that some triangles make up, and which are left."""

    def __init__(self, mesh: Facets, rows: Rows) -> None:
        self.mesh = mesh
        self.rows = rows
        number = np.full(len(mesh.triangles), -1)
        number[rows] = np.arange(len(rows))
        flat = mesh.pairs[mesh.facet_of[mesh.pairs[:, 0]] == mesh.facet_of[mesh.pairs[:, 1]]]
        smooth = number[np.concatenate([mesh.smooth, flat])]
        self.smooth = smooth[np.all(smooth >= 0, axis=1)]
        self.free = np.ones(0, bool)
        self.failures = self.work = 0
        self._divide(np.unique(mesh.facet_of[rows], return_inverse=True)[1])

    def _divide(self, facet_of: np.ndarray) -> None:
        """Take the triangles as these facets; those beyond the number that there were are free."""
        from scipy.sparse import coo_matrix

        self.facet_of = facet_of
        self.members = grouped(facet_of)
        self.count = len(self.members)
        pairs = facet_of[self.smooth]
        self.pairs = np.unique(np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1), axis=0)
        corners = np.unique(self.mesh.triangles[self.rows], return_inverse=True)[1].reshape(-1)
        place = (np.repeat(facet_of, 3), corners)
        self.corners = coo_matrix((np.ones(corners.size, bool), place)).tocsr()
        self.at_corner = self.corners.tocsc()
        self.area = np.bincount(facet_of, self.mesh.areas[self.rows])
        self.free = np.append(self.free, np.ones(self.count - len(self.free), bool))
        self.neighbours: list[list[int]] = [[] for _ in range(self.count)]
        for a, b in self.pairs.tolist():
            self.neighbours[a].append(b)
            self.neighbours[b].append(a)

    def regions(self) -> list[Region]:
        """All triangles by faces."""
        found = []
        order = np.argsort(-self.area, kind="stable")  # the noise of the corners matters least in the largest facets
        for within, seeds in product((TIGHT_TOLERANCE, LOOSE_TOLERANCE), (self._stars, self._strips)):
            self.failures = 0
            for facet in order[self.free[order]].tolist():
                if self.free[facet] and self.failures < MAX_FAILURES and self.work < MAX_WORK:
                    grown = (self._grown(seed, within * self.mesh.tolerance) for seed in seeds(facet))
                    region = next((region for region in grown if region is not None), None)
                    found += [region] if region is not None else []
        return found + self._flat_and_rough()

    def _stars(self, facet: int) -> Iterator[list[int]]:
        """A facet with all that share a corner with it."""
        near = self.at_corner[:, self.corners[facet].indices].indices
        near = np.unique(near[self.free[near]])
        if len(near) >= 4 and self._alike(near):
            yield near.tolist()

    def _strips(self, facet: int) -> Iterator[list[int]]:
        """A facet between two neighbours."""
        near = [n for n in self.neighbours[facet] if self.free[n]]
        for a, b in combinations(near, 2):
            if b not in self.neighbours[a] and self._alike([a, facet, b]):
                yield [a, facet, b]

    def _alike(self, which: list[int] | np.ndarray) -> bool:
        """Whether facets are about as large: a flat face among them, or a part of the next face, costs no fit."""
        return bool(self.area[which].max() < _MAX_AREA_RATIO * self.area[which].min())

    def _triangles(self, which: list[int] | np.ndarray) -> Rows:
        return self.rows[np.sort(np.concatenate([self.members[k] for k in which]))]

    def _grown(self, seed: list[int], within: float) -> Region | None:
        self.failures += 1
        surface = surface_of(self.mesh, self._triangles(seed), within, torus=True)
        if surface is None or isinstance(surface, Plane) or not self._even(surface, seed):
            return None
        taken = np.zeros(self.count, bool)
        taken[seed] = True
        for _ in range(_MAX_ROUNDS):
            good = on(self.mesh, surface, self.rows, 4 * within, CHORD_ANGLE)
            self.work += len(self.rows)
            taken = np.append(taken, np.zeros(self._rid(good), bool))
            now = self._around(seed, good)
            better = surface_of(self.mesh, self._triangles(np.flatnonzero(now)), within, torus=True)
            if better is None:  # a triangle of the next face may happen to be near
                areas = self.mesh.areas[self.rows]
                good &= areas * _SMALL_TRIANGLE_RATIO > np.median(areas[now[self.facet_of]])
                taken = np.append(taken, np.zeros(self._rid(good), bool))
                now = self._around(seed, good)
                better = surface_of(self.mesh, self._triangles(np.flatnonzero(now)), within, torus=True)
            if better is None or type(better) is not type(surface):
                break
            surface, same, taken = better, np.array_equal(now, taken), now
            if same:
                break
        self.failures = 0
        self.free &= ~taken
        return Region(surface, self._triangles(np.flatnonzero(taken)))

    def _rid(self, good: np.ndarray) -> int:
        """Part small triangles that are not good from the facets that are good else; the number of facets that adds.

        The last facet of a face may lie in one plane with a small triangle of the next face.
        """
        share = np.bincount(self.facet_of, good * self.mesh.areas[self.rows]) / self.area
        apart = np.flatnonzero(~good & (self.free & (share > _FACET_SHARE))[self.facet_of])
        if len(apart):
            facet_of = self.facet_of.copy()
            facet_of[apart] = self.count + np.arange(len(apart))
            self._divide(facet_of)
        return len(apart)

    def _around(self, seed: list[int], good: np.ndarray) -> np.ndarray:
        """The free facets all of whose triangles are good and that a chain of such ones joins to the seed."""
        whole = self.free.copy()
        whole[self.facet_of[~good]] = False
        whole[seed] = True
        label = components(self.count, self.pairs[np.all(whole[self.pairs], axis=1)])
        return whole & (label == label[seed[0]])

    def _even(self, surface: Surface | Torus, seed: list[int]) -> bool:
        """Whether the facets of a seed turn about as much each.

        A flat face between two roundings and the facets next to it lie on one cylinder too, by symmetry.
        """
        wide = np.array([arcs(self.mesh, surface, self._triangles([k])).max() for k in seed])
        return bool(wide.max() <= MAX_WIDTH_RATIO * (wide.min() if len(wide) == 3 else np.median(wide)))

    def _flat_and_rough(self) -> list[Region]:
        """What is left: facets that are flat faces, and what is on no surface."""
        found = []
        rough = self.free.copy()
        for k in np.flatnonzero(self.free).tolist():
            near = [n for n in self.neighbours[k] if self.free[n]]
            if not near or self.area[k] > _FLAT_FACE_RATIO * np.max(self.area[near]):
                rows = self._triangles([k])
                found.append(
                    Region(surface_of(self.mesh, rows, LOOSE_TOLERANCE * self.mesh.tolerance, one_facet=True), rows)
                )
                rough[k] = False
        label = components(self.count, self.pairs[np.all(rough[self.pairs], axis=1)])
        left = np.flatnonzero(rough)
        return found + [Region(None, self._triangles(left[group])) for group in grouped(label[left]) if len(group)]
