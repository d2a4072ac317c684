"""Check the points of a surface, and find where a point or a ball touches it (host code)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._traced import traced
from jaxkin.geometry.curves import sampled_pieces
from jaxkin.geometry.patches import BicubicSpline, Patch
from jaxkin.geometry.pose import Vector
from jaxkin.joints.profiles import LEAST_POINTS

SAMPLES = 4
"""Samples of each piece along u and along v from which the nearest point is searched: the normal turns
little between."""
_STEPS = 50
"""Newton steps at most from the nearest sample to the contact: a handful suffice."""
_CONVERGED = 1e-15
"""Step over the size of the surface at which a contact is found: rounding."""
_DEGENERATE = 1e-9
"""Sine of the angle between the directions u and v up to which there is no normal: far above rounding, and far below
what a grid of points has that is meant as one."""


class PlacedPatch(NamedTuple):
    """A surface in the axes in which its points are given."""

    patch: Patch
    """The surface, its frame being its axes."""
    spline: BicubicSpline

    @property
    def size(self) -> float:
        """Diagonal of the box around the points."""
        return float(np.linalg.norm(np.ptp(np.asarray(self.patch.points).reshape(-1, 3), axis=0)))

    @property
    def between(self) -> float:
        """Estimate how far the spline is off between its points, as h^4 / 384 times the fourth derivative.

        The fourth derivative is the jump of the third one at a knot, over the distance of the knots.
        """
        found = 0.0
        table = np.asarray(self.spline.table)
        for axis, knots in enumerate(map(np.asarray, self.spline.knots)):
            third = 6 * (table[3, 0] if axis == 0 else table[0, 3])
            jump = np.linalg.norm(np.diff(third, axis=axis), axis=2)
            width = np.minimum(np.diff(knots)[1:], np.diff(knots)[:-1]) ** 3 / 384
            found += float((jump * (width[:, None] if axis == 0 else width)).max())
        return found


def placed_patch(name: str, given: Any, closed: Any) -> PlacedPatch:
    """Check the points of a surface (ValueError), and make its patch; whether it passes itself is not checked."""
    if traced(given):
        raise ValueError(
            f"joint {name!r}: surface is traced, and where the parts touch is found from numbers: make the joint "
            "outside of jit and grad, and give traced points by "
            f"mechanism.with_points({{({name!r}, 'surface'): points}})"
        )
    try:
        points = np.array(given, float)
    except (TypeError, ValueError):
        points = np.zeros(0)
    if points.ndim != 3 or points.shape[-1] != 3:
        raise ValueError(
            f"joint {name!r}: surface must be a grid of points (x, y, z), an array of shape (m, n, 3), such as that of "
            "jk.surface_points, got " + (f"shape {points.shape}" if points.size else f"{given!r}")
        )
    pair = check_closed(f"joint {name!r}", closed)
    if min(points.shape[:2]) < LEAST_POINTS:
        raise ValueError(
            f"joint {name!r}: surface needs {LEAST_POINTS} points at least along u and along v, got {points.shape[:2]}"
        )
    if (bad := np.argwhere(~np.isfinite(points).all(axis=2))).size:
        i, j = bad[0]
        raise ValueError(f"joint {name!r}: point ({i}, {j}) of surface is not finite: {points[i, j].tolist()}")
    size = float(np.linalg.norm(np.ptp(points.reshape(-1, 3), axis=0)))
    for axis, along in enumerate("uv"):
        following = np.roll(points, -1, axis=axis)
        same = np.linalg.norm(following - points, axis=2) <= 1e-12 * size
        if not pair[axis]:
            np.moveaxis(same, axis, 0)[-1] = False
        if same.any():
            _refuse_same(name, along, points, same, axis)
    patch = Patch(points, np.zeros(2), np.zeros(3), None, pair)
    placed = PlacedPatch(patch, patch.spline())
    knots_u, knots_v = map(np.asarray, placed.spline.knots)
    at = placed.spline.derivatives(knots_u[:, None], knots_v[None])
    u, v = (np.stack(np.broadcast_arrays(*each), axis=-1) for each in (at.u, at.v))
    sine = np.linalg.norm(np.cross(u, v), axis=2)
    flat = sine <= _DEGENERATE * np.linalg.norm(u, axis=2) * np.linalg.norm(v, axis=2)
    if flat.any():
        i, j = np.argwhere(flat)[0]
        raise ValueError(
            f"joint {name!r}: the surface has no normal at its point ({i}, {j}), where u and v have one direction; "
            "give a grid that spans a surface there, or leave these points out"
        )
    return placed


def check_closed(what: str, closed: Any) -> tuple[bool, bool]:
    """Check that `closed` is a pair (along u, along v) of True and False; ValueError otherwise."""
    pair = tuple(closed) if isinstance(closed, list | tuple | np.ndarray) else ()
    if len(pair) != 2 or not all(isinstance(each, bool | np.bool_) for each in pair):
        raise ValueError(
            f"{what}: whether a surface is closed must be a pair (along u, along v), such as (True, False), "
            f"got {closed!r}"
        )
    return bool(pair[0]), bool(pair[1])


def _refuse_same(name: str, along: str, points: np.ndarray, same: np.ndarray, axis: int) -> None:
    """Raise the ValueError about neighbours along u or v that are one point."""
    i, j = np.argwhere(same)[0]
    last = np.moveaxis(same, axis, 0)[-1].all()
    if last:
        raise ValueError(
            f"joint {name!r}: surface: the last row of points along {along} repeats the first one, which a closed "
            "surface does by itself: leave it out"
        )
    raise ValueError(
        f"joint {name!r}: surface: point ({i}, {j}) and the next one along {along} are the same, "
        f"{points[i, j].tolist()}: a pole, where {along} has no direction; leave its row out, and "
        "end the surface before"
    )


class PatchContact(NamedTuple):
    """A point of a surface, in its axes."""

    u: float
    v: float
    """Coordinates from the first point of the surface."""
    point: Vector
    normal: Vector
    """Unit vector in the direction of u x v."""


def nearest_on(placed: PlacedPatch, point: Vector) -> PatchContact:
    """Find the point of a surface that is nearest to a point in its axes: Newton steps from the nearest sample."""
    spline = placed.spline
    u, v = (sampled_pieces(knots, closed, SAMPLES) for knots, closed in zip(spline.knots, spline.closed, strict=True))
    points = np.stack(spline.derivatives(u[:, None], v[None]).point, axis=-1)
    i, j = np.unravel_index(np.argmin(np.sum((points - point) ** 2, axis=2)), points.shape[:2])
    q = np.array([u[i], v[j]])
    whole = np.array([float(knots[-1]) for knots in spline.knots])
    for _ in range(_STEPS):
        at = spline.derivatives(*q)
        away = np.array(at.point, float) - point
        slopes = np.array([at.u, at.v], float)
        square = slopes @ slopes.T
        bent = square + np.einsum("ijk,k->ij", np.array([[at.uu, at.uv], [at.uv, at.vv]], float), away)
        usable = np.linalg.eigvalsh(bent)[0] > 1e-3 * np.linalg.eigvalsh(square)[0]
        moved = _within(spline, q - np.linalg.solve(bent if usable else square, slopes @ away), whole)
        step, q = np.abs(moved - q), moved
        if np.all(np.minimum(step, whole - step) <= _CONVERGED * whole):
            break
    at = spline.derivatives(*q)
    normal = np.cross(np.array(at.u, float), np.array(at.v, float))
    return PatchContact(float(q[0]), float(q[1]), np.array(at.point, float), normal / np.linalg.norm(normal))


def _within(spline: BicubicSpline, q: Float[np.ndarray, "2"], whole: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    return np.where(np.array(spline.closed), q % whole, np.clip(q, 0.0, whole))
