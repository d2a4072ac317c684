"""Estimate by how much a surface may be wrong that was fitted to the rounded vertices of a triangulated face."""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.part import Face
from jaxkin.geometry.surfaces import Cone, Plane

_SYMMETRY_EIGENVALUE = 1e-9
"""Largest eigenvalue of the normal matrix, relative to its largest, that belongs to a displacement of the surface along
itself, such as the rotation of a cylinder about its axis.

Exact vertices would make such eigenvalues zero. Vertices with six digits or more have relative rounding errors below
1e-6, and these enter squared: below 1e-12."""


def fit_uncertainty(face: Face, vertex_resolution: float) -> tuple[float, float]:
    """Estimate the errors of the direction (radians) and of the position (a length) of the surface of a face.

    `vertex_resolution`, a length, is the largest rounding error of a vertex coordinate. The position is that of the
    surface at the mean of the vertices. The surfaces of short pins and narrow planes are uncertain in direction.

    The errors follow from the covariance C = (A^T A)^-1 of the least-squares fit of the surface to the vertices. A row
    of A says how the distance d of a vertex from the surface depends on the parameters of the fit,

        dd = n . (w x r + t) + s dp,

    with r the vertex relative to the mean of all vertices, n the normal of the surface there, w and t a small rotation
    and translation of the surface, dp the change of its radius (s = 1) or of the half-angle of a cone (s = distance
    from the apex); a plane has no dp. An error is `vertex_resolution` times the root of the largest eigenvalue of the
    3x3 block of C for w, or for t. Displacements of the surface along itself do not count.
    """
    points = np.unique(face.triangles.reshape(-1, 3), axis=0)
    normals = face.surface.normals(points)
    offset = points - points.mean(axis=0)
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    columns = [np.cross(offset, normals) / extent, normals]  # w and dp of a cone times the extent: all unknowns lengths
    match face.surface:
        case Plane():
            pass
        case Cone(apex=apex):
            columns.append(np.linalg.norm(points - apex, axis=-1, keepdims=True) / extent)
        case _:
            columns.append(np.ones((len(points), 1)))
    design = np.concatenate(columns, axis=-1)  # (vertices, 6 or 7): A
    # the pseudo-inverse leaves out displacements along the surface, whose eigenvalues are zero but for rounding
    covariance = np.linalg.pinv(design.T @ design, rcond=_SYMMETRY_EIGENVALUE, hermitian=True)
    rotation, translation = (float(np.linalg.eigvalsh(covariance[k : k + 3, k : k + 3])[-1]) for k in (0, 3))
    return (
        vertex_resolution * np.sqrt(max(rotation, 0.0)) / extent,
        vertex_resolution * np.sqrt(max(translation, 0.0)),
    )
