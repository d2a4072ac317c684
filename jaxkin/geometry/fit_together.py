"""Fit one surface to several faces of a solid that a file holds as splines: pieces of one bore, the chamfer of a nut.

A narrow piece leaves the axis of its surface uncertain, and a piece with one strip of triangles leaves all of it. What
all pieces say together is exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from jaxkin.geometry.fit import fit_surface
from jaxkin.geometry.pose import Points
from jaxkin.geometry.surfaces import Plane, Surface

_ALIKE = 1e-3
"""Distance of a piece from the surface of another one, over the extent of both, up to which one surface is fitted to
them: pieces of a nut's chamfer, six of them a turn, are off by 1e-4."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A face by the corners of its triangles, and the surface that was fitted to it alone, if one fits."""

    corners: Points
    normals: Points
    """Of the true surface at the corners, outwards."""
    surface: Surface | None


def fit_together(pieces: Sequence[Piece], tolerance: float, accuracy: float, angle: float) -> list[Surface | None]:
    """Find the surface of each of some faces, the same one for those that lie on one; None where there is none.

    All corners are to be within `tolerance` (a length), or `accuracy` times the extent of the pieces, of the surface,
    and the normals within `angle` (radians), as for `fit_surface`. Planes stay as they are.
    """
    found = [piece.surface for piece in pieces]
    curved = [k for k, surface in enumerate(found) if surface is not None and not isinstance(surface, Plane)]
    left = sorted(curved, key=lambda k: -len(pieces[k].corners))
    while left:
        group = [k for k in left if k == left[0] or _alike(pieces[left[0]], pieces[k])]
        left = [k for k in left if k not in group]
        if len(group) > 1:
            corners = np.concatenate([pieces[k].corners for k in group])
            normals = np.concatenate([pieces[k].normals for k in group])
            within = max(tolerance, accuracy * _extent(corners))
            common = fit_surface(corners, normals, within, angle, thorough=True)
            if type(common) is type(found[group[0]]):
                for k in group:
                    found[k] = common
    known = [surface for surface in {id(found[k]): found[k] for k in curved}.values() if surface is not None]
    for k, piece in enumerate(pieces):
        if found[k] is None:
            found[k] = next((surface for surface in known if _lies_on(piece, surface, tolerance, angle)), None)
    return found


def _alike(one: Piece, other: Piece) -> bool:
    """Tell whether a piece may lie on the surface of a larger one, as far as that is known, on the same side of it."""
    if one.surface is None or type(one.surface) is not type(other.surface):
        return False
    near = _ALIKE * (_extent(one.corners) + _extent(other.corners))
    off = float(np.abs(one.surface.distance(other.corners)).max())
    return off <= near and float(np.sum(one.surface.normals(other.corners) * other.normals)) > 0


def _lies_on(piece: Piece, surface: Surface, tolerance: float, angle: float) -> bool:
    """Tell whether all corners of a piece lie on a surface, with its normals there."""
    if float(np.abs(surface.distance(piece.corners)).max()) > tolerance:
        return False
    return bool(np.all(np.sum(surface.normals(piece.corners) * piece.normals, axis=-1) >= np.cos(angle)))


def _extent(corners: Points) -> float:
    return float(np.linalg.norm(np.ptp(corners, axis=0)))
