"""Region growing: separates faces that are tangent to each other, one after the other.

A seed of a few neighbouring facets (a facet with all around it, or with two neighbours in a band) gives a first
surface; all connected facets whose corners lie on it are added, and the surface is fitted anew, until nothing changes.
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

TIGHT_TOLERANCE = 0.5
"""Distance of corners from a surface, as a multiple of the rounding, that is tried first: within `LOOSE_TOLERANCE` of a
cylinder there are also a few facets of a torus."""

LOOSE_TOLERANCE = 5.0
"""The distance that is tried second: CAD kernels cut faces less exactly than their numbers are written."""

MAX_FAILURES = 300
"""Number of seeds in a row without a face after which a search ends: bounds the time that free-form faces take."""

MAX_WORK = 100_000_000
"""Number of comparisons of a triangle with a surface after which all search ends: bounds the time of any mesh."""

_MAX_ROUNDS = 8
"""Largest number of times that one surface is fitted anew: the fit to a seed is off far from it, later fits are not."""

_FACET_SHARE = 0.9
"""Share of the area of a facet that has to lie on a surface for the facet to be divided: the rest is small triangles
of the next face that happen to lie in the same plane."""

_MAX_AREA_RATIO = 100.0
"""Largest ratio of the areas of two facets of one seed."""

_SMALL_TRIANGLE_RATIO = 10.0
"""Ratio of the median area of the triangles of a face to that of triangles left out of it, where no surface fits with
them."""

_FLAT_FACE_RATIO = 4.0
"""Ratio of the area of a flat face to the largest facet of a free-form face next to it, at least."""


@dataclass(frozen=True, eq=False)
class Region:
    """Triangles that make up one face."""

    surface: Surface | Torus | None
    """None where they lie on none of these surfaces."""
    rows: Rows
    """Indices of the triangles, rising."""

    @property
    def is_round(self) -> bool:
        return self.surface is not None and not isinstance(self.surface, Plane)


class RegionGrowing:
    """Divides smoothly joined triangles into faces; holds their facets, and which facets belong to no face yet."""

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
        """Set the facet of each triangle, and what follows from it; facets that are new are free."""
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
        """Divide all triangles into faces."""
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
        """Seed of a facet with all that share a corner with it."""
        near = self.at_corner[:, self.corners[facet].indices].indices
        near = np.unique(near[self.free[near]])
        if len(near) >= 4 and self._alike(near):
            yield near.tolist()

    def _strips(self, facet: int) -> Iterator[list[int]]:
        """Seeds of a facet between two of its neighbours that are no neighbours of each other."""
        near = [n for n in self.neighbours[facet] if self.free[n]]
        for a, b in combinations(near, 2):
            if b not in self.neighbours[a] and self._alike([a, facet, b]):
                yield [a, facet, b]

    def _alike(self, which: list[int] | np.ndarray) -> bool:
        """Whether facets are about equally large: a seed with a flat face among them is not worth a fit."""
        return bool(self.area[which].max() < _MAX_AREA_RATIO * self.area[which].min())

    def _triangles(self, which: list[int] | np.ndarray) -> Rows:
        return self.rows[np.sort(np.concatenate([self.members[k] for k in which]))]

    def _grown(self, seed: list[int], within: float) -> Region | None:
        """Grow a face from a seed, its corners within a length of its surface; None for a seed without a surface."""
        self.failures += 1
        surface = surface_of(self.mesh, self._triangles(seed), within, torus=True)
        if surface is None or isinstance(surface, Plane) or not self._even(surface, seed):
            return None
        taken = np.zeros(self.count, bool)
        taken[seed] = True
        for _ in range(_MAX_ROUNDS):
            good = on(self.mesh, surface, self.rows, 4 * within, CHORD_ANGLE)
            self.work += len(self.rows)
            taken = np.append(taken, np.zeros(self._split_off(good), bool))
            now = self._around(seed, good)
            better = surface_of(self.mesh, self._triangles(np.flatnonzero(now)), within, torus=True)
            if better is None:  # a triangle of the next face may happen to be near
                areas = self.mesh.areas[self.rows]
                good &= areas * _SMALL_TRIANGLE_RATIO > np.median(areas[now[self.facet_of]])
                taken = np.append(taken, np.zeros(self._split_off(good), bool))
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

    def _split_off(self, good: np.ndarray) -> int:
        """Split small triangles that are not `good` off facets that otherwise are; return the number of new facets.

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
        """The free facets that have only `good` triangles and are connected to the seed through such facets."""
        whole = self.free.copy()
        whole[self.facet_of[~good]] = False
        whole[seed] = True
        label = components(self.count, self.pairs[np.all(whole[self.pairs], axis=1)])
        return whole & (label == label[seed[0]])

    def _even(self, surface: Surface | Torus, seed: list[int]) -> bool:
        """Whether the facets of a seed span about equal arcs of a surface.

        A flat face between two fillets, with a facet of each, lies on a cylinder too, but spans most of its arc.
        """
        wide = np.array([arcs(self.mesh, surface, self._triangles([k])).max() for k in seed])
        return bool(wide.max() <= MAX_WIDTH_RATIO * (wide.min() if len(wide) == 3 else np.median(wide)))

    def _flat_and_rough(self) -> list[Region]:
        """Divide the facets that are left into flat faces and connected regions on no surface."""
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
