"""Triangles prepared for a graphics card: shared corners, smooth normals where a surface is smooth, and its edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

PAGE_CREASE = np.deg2rad(35)
"""An edge is sharp where faces turn by more: beyond what a tessellated round face turns between triangles."""
MAX_PAGE_TRIANGLES = 80_000
"""Triangles of a page at most: some 4 MB, which open within seconds without a graphics card, too."""
FINEST = 1.0 / 4000
"""The first cells that are tried, over half the size of all: less than a pixel."""
DOUBLED = 7
"""How often cells are doubled at most: parts smaller than the last ones, a sixtieth, would be dots."""


@dataclass(frozen=True, eq=False)
class ShadedMesh:
    """An indexed mesh whose corners are doubled along its edges, so that each copy has the normal of its side."""

    points: Float[np.ndarray, "points 3"]
    normals: Float[np.ndarray, "points 3"]
    triangles: Int[np.ndarray, "triangles 3"]
    edges: Float[np.ndarray, "edges 2 3"]
    """Ends of the lines where the surface turns sharply or ends."""


def shaded_mesh(triangles: Float[np.ndarray, "triangles 3 3"]) -> ShadedMesh:
    """Make the mesh of some triangles of about unit size: corners nearer than 1e-8 are one."""
    from trimesh import Trimesh
    from trimesh.graph import smooth_shade
    from trimesh.grouping import group_rows

    mesh = Trimesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), process=True)
    smooth = smooth_shade(mesh, angle=PAGE_CREASE)
    turned = mesh.face_adjacency_edges[mesh.face_adjacency_angles > PAGE_CREASE]
    rims = mesh.edges_sorted[group_rows(mesh.edges_sorted, require_count=1)]
    ends = np.concatenate([turned, rims])
    return ShadedMesh(
        np.asarray(smooth.vertices), np.asarray(smooth.vertex_normals), np.asarray(smooth.faces), mesh.vertices[ends]
    )


def lightened(
    solids: Sequence[Float[np.ndarray, "_ 3 3"]], most: int = MAX_PAGE_TRIANGLES
) -> list[Float[np.ndarray, "_ 3 3"]]:
    """Merge near corners of solids of about unit size until no more than `most` triangles are left in all.

    Corners within one cell of a grid become their mean, and triangles without area go. The cells are as small as they
    can be; solids that have few triangles together stay as they are. With the largest cells more may be left.
    """
    found, cell = list(solids), FINEST
    for _ in range(DOUBLED):
        if sum(map(len, found)) <= most:
            break
        found = [_clustered(triangles, cell) for triangles in solids]
        cell *= 2
    return found


def _clustered(triangles: Float[np.ndarray, "_ 3 3"], cell: float) -> Float[np.ndarray, "_ 3 3"]:
    """Put all corners in a cell at their mean; drop triangles that have lost their area or are there twice."""
    corners = triangles.reshape(-1, 3)
    _, owner = np.unique(np.floor(corners / cell).astype(np.int64) @ (1, 2**20, 2**40), return_inverse=True)
    count = np.bincount(owner)
    means = np.stack([np.bincount(owner, weights=column) / count for column in corners.T], axis=1)
    faces = owner.reshape(-1, 3)
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return means[faces[np.sort(first)]]
