"""Triangles prepared for a graphics card: shared corners, smooth normals where a surface is smooth, and its edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

CREASE = np.deg2rad(35)  # more than a tessellated round face turns from one triangle to the next


@dataclass(frozen=True, eq=False)
class Mesh:
    """An indexed mesh whose corners are doubled along its edges, so that each copy has the normal of its side."""

    points: Float[np.ndarray, "points 3"]
    normals: Float[np.ndarray, "points 3"]
    triangles: Int[np.ndarray, "triangles 3"]
    edges: Float[np.ndarray, "edges 2 3"]
    """Ends of the lines where the surface turns sharply or ends."""


def shaded_mesh(triangles: Float[np.ndarray, "triangles 3 3"]) -> Mesh:
    """The mesh of some triangles of about unit size: corners nearer than 1e-8 are one."""
    from trimesh import Trimesh
    from trimesh.graph import smooth_shade
    from trimesh.grouping import group_rows

    mesh = Trimesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), process=True)
    smooth = smooth_shade(mesh, angle=CREASE)
    turned = mesh.face_adjacency_edges[mesh.face_adjacency_angles > CREASE]
    rims = mesh.edges_sorted[group_rows(mesh.edges_sorted, require_count=1)]
    ends = np.concatenate([turned, rims])
    return Mesh(
        np.asarray(smooth.vertices), np.asarray(smooth.vertex_normals), np.asarray(smooth.faces), mesh.vertices[ends]
    )
