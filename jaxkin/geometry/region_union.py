"""Unite regions that are pieces of one round face.

The corners of a face may lie farther from its surface than `TIGHT_TOLERANCE`, as along the curve in which two cylinders
intersect, which CAD kernels compute less exactly than they write coordinates. Region growing then finds several pieces
of the face, each on a surface of its own, and facets between them on no surface.
"""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.facets import Facets, TriangleIndices
from jaxkin.geometry.region_growing import LOOSE_TOLERANCE, TIGHT_TOLERANCE, MeshRegion
from jaxkin.geometry.surfaces import Plane
from jaxkin.geometry.tessellation_test import arcs, on, surface_of

_ROUGH_TOLERANCE = 50.0
"""Largest distance of corners at the rim of a face from its surface, in units of `Facets.tolerance`.

CAD kernels compute the curve in which two surfaces intersect to some 5e-5 of the size of a part."""

_MAX_ROUGHNESS = 5e-4
"""Largest distance of corners at the rim of a face from its surface, over the extent of the face."""

_FEW_CORNERS = 14
"""Largest number of corners of a region that may lie on its surface by chance, and be a piece of a face of any kind."""

_MAX_TILT_RATIO = 2.0
"""Largest angle between a triangle and the surface of the face that takes it in, over the largest one in that face."""

_MAX_UNION_TRIALS = 1000
"""Largest number of fits to two neighbouring regions.

Bounds the time that free-form faces take, on which many small regions are found by chance."""


def rough_tolerance(mesh: Facets, rows: TriangleIndices) -> float:
    """Return how far corners of the triangles `rows` may lie from their surface, a length, where a face ends there."""
    extent = float(np.linalg.norm(np.ptp(mesh.points[mesh.triangles[rows]].reshape(-1, 3), axis=0)))
    return min(_ROUGH_TOLERANCE * mesh.tolerance, _MAX_ROUGHNESS * extent)


def united(mesh: Facets, found: list[MeshRegion]) -> tuple[list[MeshRegion], int]:
    """Unite neighbouring round regions to which one surface fits within `LOOSE_TOLERANCE`, the largest regions first.

    The surface of the union must be of the kind of the larger region: a piece of a torus, taken alone, may lie on a
    cone. Returns the regions, the united ones in the places of their largest members, and how many pairs of neighbours
    were not tried, `_MAX_UNION_TRIALS` having been.
    """
    rows: list[TriangleIndices] = [region.rows for region in found]
    surfaces = [region.surface for region in found]
    owner = np.full(len(mesh.triangles), -1)
    for k, region in enumerate(found):
        if region.is_round:
            owner[region.rows] = k
    tried: set[tuple[int, int, int, int]] = set()
    while True:
        left = 0
        met = owner[mesh.smooth]
        met = np.unique(np.sort(met[np.all(met >= 0, axis=1) & (met[:, 0] != met[:, 1])], axis=1), axis=0)
        pairs = [sorted(pair, key=lambda k: -len(rows[k])) for pair in met.tolist()]
        for large, small in sorted(pairs, key=lambda pair: -len(rows[pair[0]])):
            key = (large, len(rows[large]), small, len(rows[small]))
            if key in tried or len(tried) >= _MAX_UNION_TRIALS:
                left += key not in tried
                continue
            tried.add(key)
            both = np.sort(np.concatenate([rows[large], rows[small]]))
            surface = surface_of(mesh, both, LOOSE_TOLERANCE * mesh.tolerance, torus=True)
            if type(surface) is type(surfaces[large]) and not isinstance(surface, Plane):
                owner[both], rows[large], surfaces[large] = large, both, surface
                break
        else:
            kept = (k for k, region in enumerate(found) if not region.is_round or owner[region.rows[0]] == k)
            return [MeshRegion(surfaces[k], rows[k]) for k in kept], left


def absorbed(mesh: Facets, found: list[MeshRegion]) -> list[MeshRegion]:
    """Give the leftovers of a round face to it: small neighbouring regions that lie on its surface and are tangent.

    Such a region is free-form, a single triangle, of the kind of the face, or has up to `_FEW_CORNERS` corners. It is
    smaller than the face, and all its corners are within `rough_tolerance` of the surface. A facet that two round faces
    share, since they are tangent to each other in the middle of it, is divided between them.
    """
    rows: list[TriangleIndices] = [region.rows for region in found]
    owner = np.empty(len(mesh.triangles), int)
    for k, region in enumerate(found):
        owner[region.rows] = k
    tilts = [_MAX_TILT_RATIO * arcs(mesh, r.surface, r.rows).max() if r.surface and r.is_round else 0.0 for r in found]
    within = [rough_tolerance(mesh, r.rows) if r.is_round else 0.0 for r in found]
    changed = True
    while changed:
        changed = False
        met = owner[mesh.pairs]
        met = met[met[:, 0] != met[:, 1]]
        met = np.unique(np.concatenate([met, met[:, ::-1]]), axis=0)
        for small, large in met.tolist():
            surface = found[large].surface
            if not found[large].is_round or len(rows[small]) >= len(rows[large]) or not len(rows[small]):
                continue
            if _is_leftover(mesh, found[small], type(surface)) and np.all(
                on(mesh, surface, rows[small], within[large], tilts[large])
            ):
                rows[large] = np.sort(np.concatenate([rows[large], rows[small]]))
                owner[rows[small]], rows[small], changed = large, rows[small][:0], True
    for k, region in enumerate(found):
        if isinstance(region.surface, Plane) and len(rows[k]) > 1:
            beside = mesh.pairs[np.sum(owner[mesh.pairs] == k, axis=1) == 1]
            near = [n for n in np.unique(owner[beside]).tolist() if found[n].is_round]
            share = np.full(len(rows[k]), -1)
            for n in near:
                share[on(mesh, found[n].surface, rows[k], TIGHT_TOLERANCE * mesh.tolerance, tilts[n])] = n
            if len(np.unique(share)) > 1 and np.all(share >= 0):
                for n in np.unique(share).tolist():
                    rows[n] = np.sort(np.concatenate([rows[n], rows[k][share == n]]))
                owner[rows[k]], rows[k] = share, rows[k][:0]
    return [MeshRegion(region.surface, rows[k]) for k, region in enumerate(found) if len(rows[k])]


def _is_leftover(mesh: Facets, region: MeshRegion, kind: type) -> bool:
    """Check whether a region may be a piece of a face of a given kind of surface."""
    few = len(np.unique(mesh.triangles[region.rows])) <= _FEW_CORNERS
    if isinstance(region.surface, Plane):
        return len(region.rows) == 1
    return region.surface is None or few or isinstance(region.surface, kind)
