"""Divide triangles that join smoothly into faces by region growing, where faces that are tangent show no edge.

A surface is fitted to a seed of a few neighbouring facets: a facet with all facets that share a corner with it, or a
facet between two neighbours, as in a band of strips. The region grows from the seed over all connected facets whose
corners lie on the surface, the surface is fitted anew to the region, and so on until the region no longer changes.
A facet is a set of connected triangles in one plane (see `facets`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from jaxkin.geometry.components import components, grouped
from jaxkin.geometry.facets import FACET_SHARE, Facets, TriangleIndices
from jaxkin.geometry.surfaces import Plane, Surface
from jaxkin.geometry.tessellation_test import CHORD_ANGLE, MAX_WIDTH_RATIO, arcs, on, surface_of
from jaxkin.geometry.torus import Torus

TIGHT_TOLERANCE = 0.5
"""Largest distance of corners from their surface in the first pass over all seeds, in units of `Facets.tolerance`.

Small, because within `LOOSE_TOLERANCE` a cylinder also takes in a few facets of a torus next to it."""

LOOSE_TOLERANCE = 5.0
"""Largest distance of corners from their surface in the second pass, in units of `Facets.tolerance`.

Larger than 1, because CAD kernels compute the edges of faces less exactly than they write the coordinates."""

_MIN_LOOSE_CORNERS = 14
"""Smallest number of corners of a region some of which are farther than `TIGHT_TOLERANCE` from its surface.

Fewer lie by chance within `LOOSE_TOLERANCE` of some surface: a small patch of a free-form face lies on a cylinder."""

MAX_FAILURES = 300
"""Number of seeds tried in a row without finding a face, after which a pass over the seeds ends.

Bounds the time that free-form faces take, on which every seed fails."""

MAX_WORK = 100_000_000
"""Number of tests of one triangle against one surface, in all, after which no more seeds are tried.

Bounds the time of any mesh."""

_MAX_ROUNDS = 8
"""Largest number of alternations between growing a region and fitting its surface anew.

A few are enough: only the fit to the seed, which is small, is inexact at the far end of the face."""

_MAX_AREA_RATIO = 100.0
"""Largest ratio of the areas of two facets of one seed.

Beyond it one facet is most likely a flat face next to the curved one, and the seed is not worth a fit."""

_MAX_STRIP_NEIGHBOURS = 8
"""Number of neighbours of a facet, the largest ones, of which two may make a strip of three facets with it.

Strips that grew into faces had 2 to 4. The fan of triangles at the pole of a sphere is one facet with 89 neighbours;
its 3,741 pairs took nine tenths of the time of the mesh, and none of them grew."""

_SMALL_TRIANGLE_RATIO = 10.0
"""Where no surface fits a grown region, its triangles smaller than the median area divided by this are left out.

Small triangles of the next face may lie by chance within the tolerance of the surface."""

_FLAT_FACE_RATIO = 4.0
"""A remaining facet larger than this many times its largest remaining neighbour is a flat face of its own.

Neighbouring facets of one free-form face are taken to differ less."""


@dataclass(frozen=True, eq=False)
class MeshRegion:
    """Triangles that make up one face."""

    surface: Surface | Torus | None
    """The surface that the corners of the triangles lie on; None for a free-form face."""
    rows: TriangleIndices
    """Indices of the triangles in `Facets.triangles`, rising."""

    @property
    def is_round(self) -> bool:
        """Whether the surface is known and curved."""
        return self.surface is not None and not isinstance(self.surface, Plane)


class RegionGrowing:
    """Divides the triangles `rows` of a mesh, which join smoothly, into faces; `regions` does all the work.

    Triangles are numbered by their position in `rows` (n in all), facets from 0 to `count` - 1. A facet is free while
    it belongs to no face.
    """

    def __init__(self, mesh: Facets, rows: TriangleIndices) -> None:
        self.mesh = mesh
        self.rows = rows  # (n,) indices into mesh.triangles
        number = np.full(len(mesh.triangles), -1)
        number[rows] = np.arange(len(rows))
        flat = mesh.pairs[mesh.facet_of[mesh.pairs[:, 0]] == mesh.facet_of[mesh.pairs[:, 1]]]
        smooth = number[np.concatenate([mesh.smooth, flat])]
        self.smooth = smooth[np.all(smooth >= 0, axis=1)]  # (pairs, 2) triangles that join smoothly or lie in one plane
        self.free = np.ones(0, bool)
        self.failures = 0  # seeds tried since the last face was found
        self.work = 0  # tests of one triangle against one surface so far
        self.skipped = np.zeros(len(rows), bool)  # triangles of facets that a pass did not try, having met its bounds
        self._set_facets(np.unique(mesh.facet_of[rows], return_inverse=True)[1])

    def _set_facets(self, facet_of: np.ndarray) -> None:
        """Set the facet of each triangle, an array (n,), and all tables of facets; new facets are free."""
        from scipy.sparse import coo_matrix

        self.facet_of = facet_of
        self.members = grouped(facet_of)  # for each facet its triangles
        self.count = len(self.members)
        pairs = facet_of[self.smooth]
        self.pairs = np.unique(np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1), axis=0)  # (pairs, 2) facets
        corners = np.unique(self.mesh.triangles[self.rows], return_inverse=True)[1].reshape(-1)
        entries = (np.repeat(facet_of, 3), corners)
        self.corners = coo_matrix((np.ones(corners.size, bool), entries)).tocsr()  # (count, corners): facet has corner
        self.at_corner = self.corners.tocsc()
        self.area = np.bincount(facet_of, self.mesh.areas[self.rows])  # (count,)
        self.free = np.append(self.free, np.ones(self.count - len(self.free), bool))  # (count,)
        self.neighbours: list[list[int]] = [[] for _ in range(self.count)]
        for a, b in self.pairs.tolist():
            self.neighbours[a].append(b)
            self.neighbours[b].append(a)

    def regions(self) -> list[MeshRegion]:
        """Divide all triangles into faces, each triangle in exactly one region."""
        found = []
        order = np.argsort(-self.area, kind="stable")  # large facets first: rounding of corners tilts them least
        for within, seeds in product((TIGHT_TOLERANCE, LOOSE_TOLERANCE), (self._stars, self._strips)):
            self.failures = 0
            for facet in order[self.free[order]].tolist():
                if self.free[facet] and (self.failures >= MAX_FAILURES or self.work >= MAX_WORK):
                    self.skipped[self.members[facet]] = True
                elif self.free[facet]:
                    grown = (self._grown(seed, within * self.mesh.tolerance) for seed in seeds(facet))
                    region = next((region for region in grown if region is not None), None)
                    found += [region] if region is not None else []
        return found + self._flat_and_free_form()

    def untried(self) -> TriangleIndices:
        """List the triangles in no round face that a pass over the seeds did not try before it met its bounds."""
        return self.rows[self.skipped & self.free[self.facet_of]]

    def _stars(self, facet: int) -> Iterator[list[int]]:
        """Yield the seed of a facet with all free facets that share a corner with it, if it is worth a fit."""
        near = self.at_corner[:, self.corners[facet].indices].indices
        near = np.unique(near[self.free[near]])
        if len(near) >= 4 and self._alike(near):
            yield near.tolist()

    def _strips(self, facet: int) -> Iterator[list[int]]:
        """Yield the seeds of a facet between two of its free neighbours that are no neighbours of each other."""
        near = [n for n in self.neighbours[facet] if self.free[n]]
        if len(near) > _MAX_STRIP_NEIGHBOURS:
            near = sorted(near, key=lambda n: -self.area[n])[:_MAX_STRIP_NEIGHBOURS]
        for a, b in combinations(near, 2):
            if b not in self.neighbours[a] and self._alike([a, facet, b]):
                yield [a, facet, b]

    def _alike(self, facets: list[int] | np.ndarray) -> bool:
        """Check that the areas of facets differ by less than the factor `_MAX_AREA_RATIO`."""
        return bool(self.area[facets].max() < _MAX_AREA_RATIO * self.area[facets].min())

    def _triangles(self, facets: list[int] | np.ndarray) -> TriangleIndices:
        """Collect the triangles of some facets, as rising indices into `Facets.triangles`."""
        return self.rows[np.sort(np.concatenate([self.members[k] for k in facets]))]

    def _grown(self, seed: list[int], within: float) -> MeshRegion | None:
        """Grow a face from the facets `seed`; None where no curved surface fits the seed.

        `within`, a length, is the largest distance of corners from the fitted surface. While the region grows, corners
        up to 4 `within` are taken in, since the surface of the round before is inexact far from its region.
        """
        self.failures += 1
        surface = surface_of(self.mesh, self._triangles(seed), within, torus=True)
        if surface is None or isinstance(surface, Plane) or not self._even(surface, seed):
            return None
        taken = np.zeros(self.count, bool)
        taken[seed] = True
        for _ in range(_MAX_ROUNDS):
            on_surface = on(self.mesh, surface, self.rows, 4 * within, CHORD_ANGLE)
            self.work += len(self.rows)
            taken = np.append(taken, np.zeros(self._split_off(on_surface), bool))
            grown = self._around(seed, on_surface)
            better = surface_of(self.mesh, self._triangles(np.flatnonzero(grown)), within, torus=True)
            if better is None:  # perhaps for small triangles of the next face that lie near the surface by chance
                areas = self.mesh.areas[self.rows]
                on_surface &= areas * _SMALL_TRIANGLE_RATIO > np.median(areas[grown[self.facet_of]])
                taken = np.append(taken, np.zeros(self._split_off(on_surface), bool))
                grown = self._around(seed, on_surface)
                better = surface_of(self.mesh, self._triangles(np.flatnonzero(grown)), within, torus=True)
            if better is None or type(better) is not type(surface):
                break
            surface, same, taken = better, np.array_equal(grown, taken), grown
            if same:
                break
        rows = self._triangles(np.flatnonzero(taken))
        corners = np.unique(self.mesh.triangles[rows])
        off = float(np.abs(surface.distance(self.mesh.points[corners])).max())
        if len(corners) < _MIN_LOOSE_CORNERS and off > TIGHT_TOLERANCE * self.mesh.tolerance:
            return None
        self.failures = 0
        self.free &= ~taken
        return MeshRegion(surface, rows)

    def _split_off(self, on_surface: np.ndarray) -> int:
        """Make triangles off the surface facets of their own where nearly all of their facet is on the surface.

        `on_surface` is a mask of the triangles (n,). Returns the number of new facets. The last facet of a face may lie
        in one plane with a small triangle of the next face.
        """
        share = np.bincount(self.facet_of, on_surface * self.mesh.areas[self.rows]) / self.area
        split = np.flatnonzero(~on_surface & (self.free & (share > FACET_SHARE))[self.facet_of])
        if len(split):
            facet_of = self.facet_of.copy()
            facet_of[split] = self.count + np.arange(len(split))
            self._set_facets(facet_of)
        return len(split)

    def _around(self, seed: list[int], on_surface: np.ndarray) -> np.ndarray:
        """Find the free facets with all triangles on the surface that are connected to the seed through such facets.

        `on_surface` is a mask of the triangles (n,); returns a mask of the facets (count,). The seed is always in it.
        """
        allowed = self.free.copy()
        allowed[self.facet_of[~on_surface]] = False
        allowed[seed] = True
        label = components(self.count, self.pairs[np.all(allowed[self.pairs], axis=1)])
        return allowed & (label == label[seed[0]])

    def _even(self, surface: Surface | Torus, seed: list[int]) -> bool:
        """Check that the facets of a seed span about equal arcs of a surface (`MAX_WIDTH_RATIO`).

        A flat face between two fillets lies on a cylinder with one facet of each fillet, but spans most of its arc.
        """
        half_arcs = np.array([arcs(self.mesh, surface, self._triangles([k])).max() for k in seed])
        # in a strip, of three facets, each counts; in a star a few narrow facets do not
        usual = half_arcs.min() if len(half_arcs) == 3 else np.median(half_arcs)
        return bool(half_arcs.max() <= MAX_WIDTH_RATIO * usual)

    def _flat_and_free_form(self) -> list[MeshRegion]:
        """Divide the facets that are still free into flat faces, one facet each, and connected free-form faces."""
        found = []
        free_form = self.free.copy()
        for k in np.argsort(-self.area, kind="stable").tolist():
            # facets between flat faces, such as the bevels of a nut, are flat faces too
            near = [n for n in self.neighbours[k] if (free_form if len(self.members[k]) > 1 else self.free)[n]]
            if free_form[k] and (not near or self.area[k] > _FLAT_FACE_RATIO * np.max(self.area[near])):
                rows = self._triangles([k])
                found.append(
                    MeshRegion(surface_of(self.mesh, rows, LOOSE_TOLERANCE * self.mesh.tolerance, one_facet=True), rows)
                )
                free_form[k] = False
        label = components(self.count, self.pairs[np.all(free_form[self.pairs], axis=1)])
        left = np.flatnonzero(free_form)
        return found + [MeshRegion(None, self._triangles(left[group])) for group in grouped(label[left]) if len(group)]
