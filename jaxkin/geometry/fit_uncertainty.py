"""How well a surface that was fitted to the corners of triangles is known, where rounding moved them."""

from __future__ import annotations

import numpy as np

from jaxkin.geometry.part import Face
from jaxkin.geometry.surfaces import Cone, Plane

_FREE = 1e-9
"""Of the largest: what the corners say less about, squared, is a movement of the surface in itself."""


def doubt(face: Face, grain: float) -> tuple[float, float]:
    """Radians and length by which the surface of a face may be turned, and be off at the middle of the face.

    `grain` is the length by which its corners are rounded at most. From the covariance of the least squares fit: the
    distance of a corner changes with a turn w and a shift t of the surface by n.(w x r + t), and with its size. A short
    pin and a narrow plane are turned easily; movements of a surface in itself do not count.
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
    known = np.linalg.pinv(table.T @ table, rcond=_FREE, hermitian=True)
    turn, shift = (float(np.linalg.eigvalsh(known[k : k + 3, k : k + 3])[-1]) for k in (0, 3))
    return grain * np.sqrt(max(turn, 0.0)) / extent, grain * np.sqrt(max(shift, 0.0))
