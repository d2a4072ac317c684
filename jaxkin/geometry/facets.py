"""Group the triangles of a solid into flat facets, and find which neighbouring facets may belong to one curved face.

A facet is a set of connected triangles in one plane. A tessellation replaces a curved face by facets that meet at small
angles; only the corners of the facets lie on the true surface.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.components import components
from jaxkin.geometry.pose import Points
from jaxkin.geometry.triangles import double_areas

COPLANAR_ANGLE = 1e-3
"""Angle between the normals of neighbouring triangles, radians, below which they belong to one facet.

Facets of curved faces meet at 1e-2 and more."""

SMOOTH_ANGLE = 0.65
"""Angle between the normals of neighbouring facets, radians, below which they may belong to one curved face.

A little above 2 pi / 10, the angle in a cylinder of ten facets."""

SLIVER_HEIGHT = 20.0
"""Height of a triangle, in units of `Facets.tolerance`, below which it is a sliver, whose own normal is not used."""

FLAT_TOLERANCE = 5.0
"""Largest distance of the corners of a facet from its mean plane, in units of `Facets.tolerance`.

Larger than 1, because CAD kernels compute the edges of faces less exactly than they write the coordinates."""

FACET_SHARE = 0.9
"""Smallest share of the area of a set of triangles on one surface for which its other triangles are split off.

Such a set belongs to the surface but for small triangles of the next face that happen to lie in the same plane."""

_MAX_PLANE_FITS = 8
"""Largest number of times that triangles off the mean plane are left out and the mean plane is computed anew."""

TriangleIndices = Int[np.ndarray, "_"]
"""Indices of triangles."""


@dataclass(frozen=True, eq=False)
class Facets:
    """The triangles of a solid, grouped into facets."""

    points: Float[np.ndarray, "points 3"]
    """Corners of all triangles, each point once, in the unit of the assembly."""
    triangles: Int[np.ndarray, "triangles 3"]
    """Indices into `points`, wound outwards."""
    tolerance: float
    """Rounding of the points, a length: how far a corner may lie from its true surface."""
    normals: Float[np.ndarray, "triangles 3"]
    """Outward unit normals; a sliver has the normal of its facet."""
    areas: Float[np.ndarray, "triangles"]
    """Areas, in the unit of the assembly squared."""
    facet_of: Int[np.ndarray, "triangles"]
    """Number of the facet of each triangle."""
    pairs: Int[np.ndarray, "pairs 2"]
    """Pairs of triangles that share an edge."""
    smooth: Int[np.ndarray, "_ 2"]
    """The pairs of triangles in `pairs` that belong to different facets, at an angle below `SMOOTH_ANGLE`."""

    @property
    def count(self) -> int:
        """Number of facets."""
        return int(self.facet_of.max(initial=-1)) + 1

    def angles(self, one: TriangleIndices, other: TriangleIndices) -> Float[np.ndarray, "_"]:
        """Compute the angles between the normals of triangles, pair by pair, 0 to pi."""
        return _angles(self.normals[one], self.normals[other])

    def corner_normals(self, rows: TriangleIndices) -> Float[np.ndarray, "_ 3 3"]:
        """Estimate the normals of the true surface at the three corners of each of the triangles `rows`.

        A normal is the mean of those of all triangles in `rows` that meet at the corner, weighted by their angles
        there. Returns unit vectors (rows, 3 corners, 3).
        """
        corners = self.triangles[rows]
        edges = self.points[np.roll(corners, -1, axis=1)] - self.points[corners]
        before = -np.roll(edges, 1, axis=1)
        lengths = np.linalg.norm(edges, axis=-1) * np.linalg.norm(before, axis=-1)
        angles = np.arccos(np.clip(np.sum(edges * before, axis=-1) / np.where(lengths > 0, lengths, 1.0), -1, 1))
        _, at = np.unique(corners, return_inverse=True)
        at = at.reshape(-1)
        parts = angles.reshape(-1, 1) * np.repeat(self.normals[rows], 3, axis=0)
        total = np.stack([np.bincount(at, part) for part in parts.T], axis=-1)
        length = np.linalg.norm(total, axis=-1, keepdims=True)
        return (total / np.where(length > 0, length, 1.0))[at].reshape(-1, 3, 3)


def facets(points: Points, triangles: np.ndarray, pairs: Int[np.ndarray, "_ 2"], tolerance: float) -> Facets:
    """Group welded triangles into facets.

    `points` and `triangles` are as in `Welded`; `pairs` are the pairs of triangles that share an edge; `tolerance` is
    the rounding of the points, a length.
    """
    corners = points[triangles]
    cross = double_areas(corners)
    double = np.linalg.norm(cross, axis=-1)
    normals = cross / np.where(double > 0, double, 1.0)[:, None]
    edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=-1)
    heights = double / edges.max(axis=1)
    leader = _leaders(triangles, pairs, edges, heights < SLIVER_HEIGHT * tolerance)
    # a sliver of a round face at the sharp rim of a flat one is not in the plane of the flat one
    off = np.abs(np.einsum("nki,ni->nk", corners - corners[leader][:, :1], normals[leader])).max(axis=1)
    leader = np.where(off <= FLAT_TOLERANCE * tolerance, leader, np.arange(len(leader)))
    normals = normals[leader]

    i, j = pairs.T
    angle = _angles(normals[i], normals[j])
    noise = tolerance * (1 / heights[leader[i]] + 1 / heights[leader[j]])
    flat = (angle < np.maximum(COPLANAR_ANGLE, noise)) | (leader[i] == leader[j])
    flat_pairs = np.concatenate([pairs[flat], np.stack([np.arange(len(leader)), leader], axis=-1)])
    label = components(len(triangles), flat_pairs)
    # triangles at angles below COPLANAR_ANGLE may together be a curved strip, which is no facet
    single = _off_plane(label, normals, corners, double, FLAT_TOLERANCE * tolerance)
    if single.any():
        label = components(len(triangles), flat_pairs[~single[flat_pairs].any(axis=1)])
    smooth = (angle < SMOOTH_ANGLE) & (label[i] != label[j])
    return Facets(points, triangles, tolerance, normals, double / 2, label, pairs, pairs[smooth])


def _leaders(triangles: np.ndarray, pairs: np.ndarray, edges: np.ndarray, sliver: np.ndarray) -> TriangleIndices:
    """Find for each triangle the one whose normal it gets (triangles,): itself, unless it is a sliver.

    A sliver gets the normal of the neighbour across its longest edge; if that is a sliver too, of the neighbour across
    the longest edge of that, and so on. `edges` (triangles, 3) are the lengths of the edges, `sliver` is a mask.
    """
    leader = np.arange(len(triangles))
    if not sliver.any():
        return leader
    longest = np.argmax(edges, axis=1)
    rows = np.arange(len(triangles))
    edge = np.sort(np.stack([triangles[rows, longest], triangles[rows, (longest + 1) % 3]], axis=-1), axis=1)
    for one, other in (pairs.T, pairs.T[::-1]):
        shares = sliver[one] & np.all((triangles[other][:, :, None] == edge[one][:, None]).any(axis=1), axis=-1)
        leader[one[shares]] = other[shares]
    for _ in range(32):  # each pass doubles the length of the chains followed: 2^32 in all
        leader = leader[leader]
    return leader


def _off_plane(
    label: TriangleIndices, normals: Points, corners: np.ndarray, weights: np.ndarray, tolerance: float
) -> np.ndarray:
    """Mark the triangles that are in no plane with their group: each of them is a facet of its own.

    `label` (triangles,) numbers the groups, `corners` are (triangles, 3, 3), `weights` are proportional to areas. A
    triangle is in the plane if its corners are within `tolerance` (a length) of the mean plane of its group, which is
    computed anew without the triangles off it. Where the plane has less than `FACET_SHARE` of the area of the group,
    the group is a curved strip, and all its triangles are marked. Returns a mask (triangles,).
    """
    marked = np.zeros(len(label), bool)
    open_groups = np.ones(int(label.max(initial=0)) + 1, bool)
    for _ in range(_MAX_PLANE_FITS):
        off = _heights(label, normals, corners, np.where(marked, 0.0, weights)) > tolerance
        changed = np.bincount(label, off != marked, len(open_groups)) > 0
        open_groups &= changed
        marked = np.where(open_groups[label], off, marked)
        if not open_groups.any():
            break
    area = np.bincount(label, weights)
    strip = np.bincount(label, np.where(marked, 0.0, weights)) < FACET_SHARE * area
    return marked | strip[label]


def _heights(label: TriangleIndices, normals: Points, corners: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Compute for each triangle the largest distance of its corners from the mean plane of its group (triangles,)."""
    total = np.bincount(label, weights)
    normal = np.stack([np.bincount(label, weights * n) for n in normals.T], axis=-1)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = normal / np.where(length > 0, length, 1.0)
    middle = np.stack([np.bincount(label, weights * c) for c in corners.mean(axis=1).T], axis=-1)
    middle = middle / np.where(total > 0, total, 1.0)[:, None]
    return np.abs(np.einsum("nki,ni->nk", corners - middle[label][:, None], normal[label])).max(axis=1)


def _angles(a: Points, b: Points) -> np.ndarray:
    """Compute the angles between unit vectors `a` and `b`, pair by pair, 0 to pi, accurate for small angles."""
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))
