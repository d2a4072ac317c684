"""Unite regions that are pieces of one round face.

The corners of a face may lie farther from its surface than `TIGHT_TOLERANCE`, as along the curve in which two cylinders
intersect, which CAD kernels compute less exactly than they write coordinates. Region growing then finds several pieces
of the face, each on a surface of its own.
"""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.facets import Facets, Rows
from jaxkin.geometry.region_growing import LOOSE_TOLERANCE, Region
from jaxkin.geometry.surfaces import Plane
from jaxkin.geometry.tessellation_test import surface_of

_MAX_UNION_TRIALS = 1000
"""Largest number of fits to two neighbouring regions.

Bounds the time that free-form faces take, on which many small regions are found by chance."""


def united(mesh: Facets, found: list[Region]) -> list[Region]:
    """Unite neighbouring round regions to which one surface fits within `LOOSE_TOLERANCE`, the largest regions first.

    The surface of the union must be of the kind of the larger region: a piece of a torus, taken alone, may lie on a
    cone. Returns the regions, the united ones in the places of their largest members.
    """
    rows: list[Rows] = [region.rows for region in found]
    surfaces = [region.surface for region in found]
    owner = np.full(len(mesh.triangles), -1)
    for k, region in enumerate(found):
        if region.is_round:
            owner[region.rows] = k
    tried: set[tuple[int, int, int, int]] = set()
    while True:
        met = owner[mesh.smooth]
        met = np.unique(np.sort(met[np.all(met >= 0, axis=1) & (met[:, 0] != met[:, 1])], axis=1), axis=0)
        pairs = [sorted(pair, key=lambda k: -len(rows[k])) for pair in met.tolist()]
        for large, small in sorted(pairs, key=lambda pair: -len(rows[pair[0]])):
            key = (large, len(rows[large]), small, len(rows[small]))
            if key in tried or len(tried) >= _MAX_UNION_TRIALS:
                continue
            tried.add(key)
            both = np.sort(np.concatenate([rows[large], rows[small]]))
            surface = surface_of(mesh, both, LOOSE_TOLERANCE * mesh.tolerance, torus=True)
            if type(surface) is type(surfaces[large]) and not isinstance(surface, Plane):
                owner[both], rows[large], surfaces[large] = large, both, surface
                break
        else:
            kept = (k for k, region in enumerate(found) if not region.is_round or owner[region.rows[0]] == k)
            return [Region(surfaces[k], rows[k]) for k in kept]
