"""Find the faces of a triangulated solid: regions of facets whose corners lie on one analytic surface.

Facets that meet smoothly belong to one face, or to several faces that are tangent to each other. So one surface is
fitted to all of them first; where none fits, they are divided by region growing (`region_growing.py`). Tori are
recognised too, though no contact state has one, since a band of facets of a torus, taken alone, lies on a cone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool

from jaxkin.geometry.components import components, grouped
from jaxkin.geometry.facets import SMOOTH_ANGLE, Facets, TriangleIndices
from jaxkin.geometry.region_growing import LOOSE_TOLERANCE, TIGHT_TOLERANCE, MeshRegion, RegionGrowing
from jaxkin.geometry.region_union import absorbed, rough_tolerance, united
from jaxkin.geometry.surfaces import Plane, Surface
from jaxkin.geometry.tessellation_test import MAX_FACET_CORNERS, MAX_WIDTH_RATIO, arcs, on, surface_of
from jaxkin.geometry.torus import Torus

_STRAY_ANGLE = 0.8
"""Largest angle, radians, between a lone triangle and the surface of the neighbouring face that its corners lie on."""

_CREASE_ANGLES = (0.45, 0.3, 0.2)
"""Angles, radians, at edges along which triangles that join smoothly are cut, where no surface fits all of them.

Two round faces meet at angles from a right one to a small one, as where a bore goes out through the side of a shaft.
The smallest is above the angle between the facets of a usual tessellation."""

_SHARP_SHARE = 0.6
"""Smallest share of sharp edges in the rim of a face that is cut out so.

A band of facets of a torus, which alone lies on a cone, has at most a half."""

_FLAT_NEIGHBOUR_RATIO = 10.0
"""Smallest ratio of the area of a facet to that of the facets of a round face for the facet to be a flat face next to
it, as the side of a nut is next to its chamfer."""

_MIN_ROUGH_CORNERS = 12
"""Smallest number of corners of a face between sharp edges."""

_MAX_BEND_RATIO = 2.0
"""Largest angle between neighbouring facets of one face, over the largest in the round faces of the same solid: meshers
bound this angle, and exceed their bound by less on free-form faces."""

_MORE_CORNERS = 2.0
"""Corners of a facet over those of the facets beside it, from which on it is a flat face: strips of one curved face
have about as many."""

_MAX_LEFTOVER = 4
"""Largest number of triangles of a region on no surface, each of which is then tried as part of a neighbouring face."""


class FoundRegions(NamedTuple):
    """The faces of a solid, and what was left of the search for them when it met its bounds."""

    regions: list[MeshRegion]
    """In the order of their first triangles; each triangle is in one."""
    untried: TriangleIndices
    """Triangles in no round face that no such face was looked for at."""
    pairs: int
    """Neighbouring pieces of round faces of which it was not looked whether they are one."""


def regions(mesh: Facets) -> FoundRegions:
    """Divide all triangles of a solid into faces."""
    found: list[MeshRegion] = []
    untried = [np.zeros(0, int)]
    _, first = np.unique(mesh.facet_of, return_index=True)
    within = np.stack([np.arange(len(mesh.triangles)), first[mesh.facet_of]], axis=-1)
    for rows in grouped(components(len(mesh.triangles), np.concatenate([mesh.smooth, within]))):
        found += _divided(mesh, rows, within, untried)
    found, pairs = united(mesh, found)
    found = [piece for region in absorbed(mesh, found) for piece in _without_flats(mesh, region)]
    found = [_named(mesh, region) for region in _with_strays(mesh, found)]
    bend = max((_largest_bend(mesh, region) for region in found if region.is_round), default=np.inf)
    found = [piece for region in found for piece in _flat_pieces(mesh, region, bend)]
    return FoundRegions(sorted(found, key=lambda region: region.rows[0]), np.concatenate(untried), pairs)


def _named(mesh: Facets, region: MeshRegion) -> MeshRegion:
    """Fit a surface to a free-form region, which may have lost the triangles that were off its surface."""
    if region.surface is not None:
        return region
    surface = surface_of(mesh, region.rows, LOOSE_TOLERANCE * mesh.tolerance, torus=True, thorough=True)
    return region if surface is None or isinstance(surface, Plane) else MeshRegion(surface, region.rows)


def _divided(
    mesh: Facets, rows: TriangleIndices, within: np.ndarray, untried: list[TriangleIndices]
) -> list[MeshRegion]:
    """Divide triangles that join smoothly into faces.

    One surface is fitted to all of them first, then to what is left of them when they are cut along edges of smaller
    and smaller angles (`_CREASE_ANGLES`). `within` (triangles, 2) pairs each triangle with the first of its facet.
    Those at which region growing did not look, having met its bounds, are added to `untried`.
    """
    one = bool(np.all(mesh.facet_of[rows] == mesh.facet_of[rows[0]]))
    surface = surface_of(mesh, rows, LOOSE_TOLERANCE * mesh.tolerance, one_facet=one, thorough=True)
    if surface is not None:
        return [MeshRegion(surface, rows)]
    found: list[MeshRegion] = []
    i, j = mesh.smooth.T
    angles = mesh.angles(i, j)
    for angle in (np.inf, *_CREASE_ANGLES):
        number = np.full(len(mesh.triangles), -1)
        number[rows] = np.arange(len(rows))
        links = number[np.concatenate([mesh.smooth[angles < angle], within])]
        pieces = grouped(components(len(rows), links[np.all(links >= 0, axis=1)]))
        taken = np.zeros(len(rows), bool)
        for piece in pieces:
            if np.isinf(angle) or _is_bounded(mesh, rows[piece], angle):
                surface = _rough_surface(mesh, rows[piece])
                if surface is not None:
                    found.append(MeshRegion(surface, rows[piece]))
                    taken[piece] = True
        rows = rows[~taken]
        if not len(rows):
            return found
    number = np.full(len(mesh.triangles), -1)
    number[rows] = np.arange(len(rows))
    links = number[np.concatenate([mesh.smooth, within])]
    for piece in grouped(components(len(rows), links[np.all(links >= 0, axis=1)])):
        one = bool(np.all(mesh.facet_of[rows[piece]] == mesh.facet_of[rows[piece[0]]]))
        surface = surface_of(mesh, rows[piece], LOOSE_TOLERANCE * mesh.tolerance, one_facet=one) if found else None
        if surface is not None:
            found.append(MeshRegion(surface, rows[piece]))
        else:
            growing = RegionGrowing(mesh, rows[piece])
            found += growing.regions()
            untried.append(growing.untried())
    return found


def _rough_surface(mesh: Facets, rows: TriangleIndices) -> Surface | Torus | None:
    """Find the round surface of triangles that are bounded by sharp edges, whose corners may be less exact."""
    points = mesh.points[np.unique(mesh.triangles[rows])]
    if len(points) < _MIN_ROUGH_CORNERS:
        return None
    for tolerance in (LOOSE_TOLERANCE * mesh.tolerance, rough_tolerance(mesh, rows)):
        surface = surface_of(mesh, rows, tolerance, torus=True, thorough=True)
        if surface is not None:
            return None if isinstance(surface, Plane) else surface
    return None


def _is_bounded(mesh: Facets, rows: TriangleIndices, angle: float) -> bool:
    """Check that most of the rim of some triangles, by length, is an edge of a face.

    Such an edge has an angle of `SMOOTH_ANGLE` or more, or more than `angle` (radians) with a flat face next to it: a
    facet much larger than those of the triangles `rows`.
    """
    inside = np.zeros(len(mesh.triangles), bool)
    inside[rows] = True
    rim = mesh.pairs[inside[mesh.pairs[:, 0]] != inside[mesh.pairs[:, 1]]]
    if not len(rim):
        return True
    outer = np.where(inside[rim[:, 0]], rim[:, 1], rim[:, 0])
    area = np.bincount(mesh.facet_of, mesh.areas)[mesh.facet_of]
    flat = area[outer] > _FLAT_NEIGHBOUR_RATIO * area[rows].max()
    bend = mesh.angles(*rim.T)
    sharp = (bend >= SMOOTH_ANGLE) | (flat & (bend >= angle))
    shared = [np.intersect1d(*mesh.triangles[pair]) for pair in rim]
    lengths = np.array([np.linalg.norm(np.ptp(mesh.points[edge], axis=0)) for edge in shared])
    return bool(lengths[sharp].sum() > _SHARP_SHARE * lengths.sum())


def _without_flats(mesh: Facets, region: MeshRegion) -> list[MeshRegion]:
    """Split off a round face the flats that are cut into it; returns all pieces, the round one first.

    A flat is a facet with its corners on the surface that spans a far larger arc than other facets (`MAX_WIDTH_RATIO`).
    """
    if region.surface is None or not region.is_round:
        return [region]
    arc = arcs(mesh, region.surface, region.rows)
    facet = np.unique(mesh.facet_of[region.rows], return_inverse=True)[1]
    widths = np.zeros(int(facet.max()) + 1)
    np.maximum.at(widths, facet, arc)
    # a facet of one triangle is no flat: meshers leave wide triangles along a jagged rim of the round face
    wide_ones = np.flatnonzero((np.bincount(facet) > 1) & (widths > MAX_WIDTH_RATIO * np.median(widths)))
    wide = [region.rows[facet == k] for k in wide_ones]
    flats = [
        MeshRegion(surface_of(mesh, rows, LOOSE_TOLERANCE * mesh.tolerance, one_facet=True), rows) for rows in wide
    ]
    return [MeshRegion(region.surface, np.setdiff1d(region.rows, np.concatenate([[], *wide]))), *flats]


def _largest_bend(mesh: Facets, region: MeshRegion) -> float:
    """Find the largest angle, radians, between neighbouring facets of a region."""
    inside = _within(mesh, region.rows)
    return float(mesh.angles(*mesh.smooth[inside].T).max(initial=0.0))


def _within(mesh: Facets, rows: TriangleIndices) -> Bool[np.ndarray, "_"]:
    """Mark the pairs of `Facets.smooth` both of whose triangles are among `rows`."""
    inside = np.zeros(len(mesh.triangles), bool)
    inside[rows] = True
    return np.all(inside[mesh.smooth], axis=1)


def _flat_pieces(mesh: Facets, region: MeshRegion, bend: float) -> list[MeshRegion]:
    """Split off a free-form region the flat faces that meet at angles so small that they could be one curved face.

    They are flat where the angle is more than a tessellation with bends of `bend` radians in its round faces leaves
    (`_MAX_BEND_RATIO`), where a facet has many corners, and far more than those beside it, and where only two facets
    are left.
    """
    if region.surface is not None:
        return [region]
    facets, facet = np.unique(mesh.facet_of[region.rows], return_inverse=True)
    number = np.full(mesh.count, -1)
    number[facets] = np.arange(len(facets))
    pairs = mesh.smooth[_within(mesh, region.rows)]
    pairs = number[mesh.facet_of[pairs[mesh.angles(*pairs.T) <= _MAX_BEND_RATIO * bend]]]
    entries = np.unique(np.stack([np.repeat(facet, 3), mesh.triangles[region.rows].ravel()]), axis=1)
    corners = np.bincount(entries[0])
    beside = np.zeros(len(facets))
    for one, other in (pairs.T, pairs.T[::-1]):
        np.maximum.at(beside, one, corners[other])
    flat = (corners > MAX_FACET_CORNERS) & (corners > _MORE_CORNERS * beside)
    label = components(len(facets), pairs[~flat[pairs].any(axis=1)])
    alone = (np.bincount(label)[label] <= 2) & (np.bincount(facet) > 1)
    planes = [region.rows[facet == k] for k in np.flatnonzero(alone)]
    rest = [region.rows[group] for group in grouped(np.where(alone, -1, label)[facet]) if not alone[facet[group[0]]]]
    found = [
        MeshRegion(surface_of(mesh, rows, LOOSE_TOLERANCE * mesh.tolerance, one_facet=True), rows) for rows in planes
    ]
    return [*found, *(MeshRegion(None, rows) for rows in rest)]


def _with_strays(mesh: Facets, found: list[MeshRegion]) -> list[MeshRegion]:
    """Give lone triangles to neighbouring round faces on whose surface their corners lie.

    A triangle is lone if it is a facet by itself, or in a region of few triangles on no surface. Meshers leave such
    triangles along jagged rims; they span so large an arc of the round face that they are far from tangent to it.
    """
    owner = np.full(len(mesh.triangles), -1)
    within = np.full(len(found), TIGHT_TOLERANCE * mesh.tolerance)  # or as far as the corners of the face itself are
    for k, region in enumerate(found):
        if region.surface is not None and region.is_round:
            owner[region.rows] = k
            off = np.abs(region.surface.distance(mesh.points[mesh.triangles[region.rows]]))
            within[k] = max(within[k], float(off.max()))
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
                owner[rows[on(mesh, found[k].surface, rows, float(within[k]), _STRAY_ANGLE)]] = k
    result = []
    for k, region in enumerate(found):
        rows = np.flatnonzero(owner == k) if region.is_round else region.rows[owner[region.rows] < 0]
        result += [MeshRegion(region.surface, rows)] if len(rows) else []
    return result
