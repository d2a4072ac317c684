"""The uncertainty of a surface that was fitted to rounded vertices."""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.part import Face
from jaxkin.geometry.surfaces import Cone, Plane

_FREE_MOVEMENT = 1e-9
"""Eigenvalues of the normal equations below this, relative to the largest, belong to movements of the surface in
itself (a cylinder about its axis): roundings of vertices of six digits and more, squared, are below 1e-12."""


def fit_uncertainty(face: Face, vertex_resolution: float) -> tuple[float, float]:
    """Estimate how far the surface of a face may be turned, in radians, and be off at the middle of the face, a length.

    `vertex_resolution` is the largest rounding error of the vertices. The estimate is that length times the roots of
    the largest eigenvalues of the covariance of the least-squares fit: a rotation w and a translation t of the surface
    change the distance of a vertex at r from the mean of all by n . (w x r + t), with n the normal there; so does a
    change of its radius, or half-angle. The surfaces of short pins and narrow planes are uncertain in direction;
    movements of a surface in itself do not count.
    """
    points = np.unique(face.triangles.reshape(-1, 3), axis=0)
    normals = face.surface.normals(points)
    offset = points - points.mean(axis=0)
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    columns = [np.cross(offset, normals) / extent, normals]
    match face.surface:
        case Plane():
            pass
        case Cone(apex=apex):
            columns.append(np.linalg.norm(points - apex, axis=-1, keepdims=True) / extent)
        case _:
            columns.append(np.ones((len(points), 1)))
    table = np.concatenate(columns, axis=-1)
    known = np.linalg.pinv(table.T @ table, rcond=_FREE_MOVEMENT, hermitian=True)
    turn, shift = (float(np.linalg.eigvalsh(known[k : k + 3, k : k + 3])[-1]) for k in (0, 3))
    return vertex_resolution * np.sqrt(max(turn, 0.0)) / extent, vertex_resolution * np.sqrt(max(shift, 0.0))
