"""The faces of a triangulated solid: regions of facets whose corners lie on one plane, cylinder, cone or sphere.

Facets that meet smoothly are of one face, or of faces that are tangent to each other: the first is tried at once, else
they are grown (`growth.py`). Tori are told apart, since a band of facets of a torus, taken alone, lies on a cone.
"""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.components import components, grouped
from jaxkin.geometry.facets import Facets
from jaxkin.geometry.region_growing import LOOSE_TOLERANCE, TIGHT_TOLERANCE, Region, RegionGrowing
from jaxkin.geometry.tessellation_test import MAX_WIDTH_RATIO, arcs, on, surface_of

_STRAY_ANGLE = 0.8
"""Radians between a lone triangle and the surface that holds its corners, next to facets of that surface."""

_MAX_LEFTOVER = 4
"""Triangles left over between faces: each may be of one of them."""


def regions(mesh: Facets) -> list[Region]:
    """All triangles of a solid, by faces, in the order of their first triangles."""
    found: list[Region] = []
    _, first = np.unique(mesh.facet_of, return_index=True)
    within = np.stack([np.arange(len(mesh.triangles)), first[mesh.facet_of]], axis=-1)
    for rows in grouped(components(len(mesh.triangles), np.concatenate([mesh.smooth, within]))):
        one = bool(np.all(mesh.facet_of[rows] == mesh.facet_of[rows[0]]))
        surface = surface_of(mesh, rows, LOOSE_TOLERANCE * mesh.tolerance, one_facet=one)
        found += [Region(surface, rows)] if surface is not None else RegionGrowing(mesh, rows).regions()
    found = [piece for region in found for piece in _without_flats(mesh, region)]
    return sorted(_with_strays(mesh, found), key=lambda region: region.rows[0])


def _without_flats(mesh: Facets, region: Region) -> list[Region]:
    """A round face, and the flats cut into it that could be facets of it but for their width."""
    if region.surface is None or not region.is_round:
        return [region]
    arc = arcs(mesh, region.surface, region.rows)
    facet = np.unique(mesh.facet_of[region.rows], return_inverse=True)[1]
    widths = np.zeros(int(facet.max()) + 1)
    np.maximum.at(widths, facet, arc)
    # a lone triangle may be as wide as the mesher liked, where the face has a jagged rim
    wide_ones = np.flatnonzero((np.bincount(facet) > 1) & (widths > MAX_WIDTH_RATIO * np.median(widths)))
    wide = [region.rows[facet == k] for k in wide_ones]
    flats = [Region(surface_of(mesh, rows, LOOSE_TOLERANCE * mesh.tolerance, one_facet=True), rows) for rows in wide]
    return [Region(region.surface, np.setdiff1d(region.rows, np.concatenate([[], *wide]))), *flats]


def _with_strays(mesh: Facets, found: list[Region]) -> list[Region]:
    """The same with lone triangles that span too much of a round face for their direction to tell given to that face.

    Meshers leave such triangles along jagged rims. Their corners are on the surface, and they share an edge with it.
    """
    owner = np.full(len(mesh.triangles), -1)
    for k, region in enumerate(found):
        if region.is_round:
            owner[region.rows] = k
    lone = np.bincount(mesh.facet_of)[mesh.facet_of] == 1
    for region in found:
        if len(region.rows) == 1 or (region.surface is None and len(region.rows) <= _MAX_LEFTOVER):
            lone[region.rows] = True
    left = len(owner) + 1
    while np.sum(owner < 0) < left:
        left = int(np.sum(owner < 0))
        for one, other in (mesh.pairs.T, mesh.pairs.T[::-1]):
            edge = (owner[one] < 0) & lone[one] & (owner[other] >= 0)
            one, beyond = one[edge], owner[other[edge]]
            for k in np.unique(beyond).tolist():
                rows = np.unique(one[beyond == k])
                owner[rows[on(mesh, found[k].surface, rows, TIGHT_TOLERANCE * mesh.tolerance, _STRAY_ANGLE)]] = k
    result = []
    for k, region in enumerate(found):
        rows = np.flatnonzero(owner == k) if region.is_round else region.rows[owner[region.rows] < 0]
        result += [Region(region.surface, rows)] if len(rows) else []
    return result
