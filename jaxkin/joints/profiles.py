"""Check the points of a profile, and find where a point, a line or another profile touches it (host code)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._traced import traced
from jaxkin.geometry.curves import Curve, CurvePoint, Spline, sampled_pieces

Vector2 = Float[np.ndarray, "2"]

LEAST_POINTS = 4
"""Points of a profile at least: as many as a cubic has coefficients."""
SAMPLES = 16
"""Samples of each piece of a spline from which contacts are searched: the tangent of a piece turns little between."""
_STEPS = 50
"""Newton steps at most from the nearest sample to a contact: a handful suffice."""
_CONVERGED = 1e-15
"""Step over the length of the curve at which a contact is found: rounding."""


class PlacedProfile(NamedTuple):
    """A profile in coordinates (x, y) of its plane."""

    curve: Curve
    """The curve, its frame being the axes of the plane."""
    spline: Spline

    @property
    def size(self) -> float:
        """Diagonal of the box around the points."""
        return float(np.linalg.norm(np.ptp(np.asarray(self.curve.points), axis=0)))

    def samples(self) -> tuple[Float[np.ndarray, " samples"], CurvePoint]:
        """Sample the curve evenly within each piece: parameters from its first point, and points."""
        s = sampled_pieces(self.spline.knots, self.spline.closed, SAMPLES)
        return s, self.spline.at(s)


def placed_profile(name: str, label: str, given: Any, place: Float[np.ndarray, "3"], closed: bool) -> PlacedProfile:
    """Check the points of a profile (ValueError), and place its axes at a pose (x, y, angle) of the plane.

    `label` is the name of the argument, for messages. Whether the profile crosses itself is not checked here.
    """
    if traced(given):
        raise ValueError(
            f"joint {name!r}: {label} is traced, and where the parts touch is found from numbers: make the joint "
            "outside of jit and grad, and give traced points by "
            f"mechanism.with_points({{({name!r}, {label!r}): points}})"
        )
    try:
        points = np.array(given, float)
    except (TypeError, ValueError):
        points = np.zeros(0)
    if points.ndim != 2 or points.shape[-1] != 2:
        raise ValueError(
            f"joint {name!r}: {label} must be points (x, y) in the plane of the joint, an array of shape (n, 2), got "
            + (f"shape {points.shape}" if points.size else f"{given!r}")
        )
    if not isinstance(closed, bool | np.bool_):
        raise ValueError(f"joint {name!r}: whether a curve is closed must be True or False, got {closed!r}")
    if len(points) < LEAST_POINTS:
        raise ValueError(f"joint {name!r}: {label} needs {LEAST_POINTS} points at least, got {len(points)}")
    if (bad := np.flatnonzero(~np.isfinite(points).all(axis=1))).size:
        raise ValueError(f"joint {name!r}: point {bad[0]} of {label} is not finite: {points[bad[0]].tolist()}")
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    following = np.roll(points, -1, axis=0) if closed else points[1:]
    near = np.flatnonzero(np.linalg.norm(following - points[: len(following)], axis=1) <= 1e-12 * size)
    if near.size:
        one, other = int(near[0]), (int(near[0]) + 1) % len(points)
        said = "the last point repeats the first one, which a closed profile does by itself: leave it out"
        if other:
            said = f"points {one} and {other} are the same, {points[one].tolist()}: leave one out"
        raise ValueError(f"joint {name!r}: {label}: {said}")
    curve = Curve(points, np.zeros(()), np.asarray(place, float), bool(closed))
    return PlacedProfile(curve, curve.spline())


def check_simple(name: str, label: str, placed: PlacedProfile) -> None:
    """Raise ValueError where a profile crosses itself, with the place of the crossing in its own coordinates."""
    from scipy.spatial import KDTree

    _, at = _in_own_axes(placed).samples()
    ends = np.stack([at.x, at.y], axis=1)
    begin, end = (ends, np.roll(ends, -1, axis=0)) if placed.spline.closed else (ends[:-1], ends[1:])
    reach = float(np.linalg.norm(end - begin, axis=1).max())
    pairs = KDTree((begin + end) / 2).query_pairs(reach, output_type="ndarray")
    apart = np.abs(pairs[:, 0] - pairs[:, 1])
    pairs = pairs[(apart > 1) & (apart < len(begin) - 1 if placed.spline.closed else True)]
    (a, b), (c, d) = ((begin[side], end[side]) for side in pairs.T)

    def across(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
        return (q[:, 0] - p[:, 0]) * (r[:, 1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (r[:, 0] - p[:, 0])

    crossing = (across(a, b, c) * across(a, b, d) < 0) & (across(c, d, a) * across(c, d, b) < 0)
    if crossing.any():
        first = int(np.argmax(crossing))
        x, y = (a[first] + b[first]) / 2
        pieces = " and ".join(str(int(k) // SAMPLES) for k in sorted(pairs[first]))
        raise ValueError(
            f"joint {name!r}: {label} crosses itself near ({x:.6g}, {y:.6g}), behind its points {pieces}; give the "
            f"points in order along the profile, more of them where it bends, or leave out its loops"
        )


def _in_own_axes(placed: PlacedProfile) -> PlacedProfile:
    """Return the profile in its own axes."""
    curve = Curve(placed.curve.points, placed.curve.start, np.zeros(3), placed.curve.closed)
    return PlacedProfile(curve, curve.spline())


def nearest_to(placed: PlacedProfile, point: Vector2) -> float:
    """Find the parameter of the point of a profile that is nearest to a point of the plane."""
    s, at = placed.samples()
    q = float(s[np.argmin((at.x - point[0]) ** 2 + (at.y - point[1]) ** 2)])
    for _ in range(_STEPS):
        at = placed.spline.at(np.array(q))
        away = np.array([at.x - point[0], at.y - point[1]])
        speed = float(np.hypot(at.dx, at.dy))
        normal = -at.sin * away[0] + at.cos * away[1]
        slope = speed**2 + normal * at.turning * speed
        step = float(at.dx * away[0] + at.dy * away[1]) / (slope if slope > 1e-3 * speed**2 else speed**2)
        q = _within(placed, q - step)
        if abs(step) <= _CONVERGED * float(placed.spline.knots[-1]):
            break
    return q


def tangent_to(placed: PlacedProfile, direction: Vector2, point: Vector2) -> float | None:
    """Find the parameter at which a profile has a direction, where its tangent is nearest to a point of the plane.

    None where the profile nowhere has the direction.
    """
    from scipy.optimize import brentq

    def across(q: float) -> float:
        at = placed.spline.at(np.array(q))
        return float(at.cos * direction[1] - at.sin * direction[0])

    s, at = placed.samples()
    values = at.cos * direction[1] - at.sin * direction[0]
    following, ends = np.roll(values, -1), np.append(s[1:], placed.spline.knots[-1])
    if not placed.spline.closed:
        values, following, ends, s = values[:-1], following[:-1], ends[:-1], s[:-1]
    found = []
    for k in np.flatnonzero(values * following <= 0):
        begin, end = float(s[k]), float(ends[k])
        if across(begin) * across(end) < 0:
            found.append(float(brentq(across, begin, end, xtol=1e-300)))  # type: ignore[arg-type]
        else:  # at a sample, to rounding
            found.append(min(begin, end, key=lambda q: abs(across(q))))

    def away(q: float) -> float:
        at = placed.spline.at(np.array(q))
        return abs(float((at.x - point[0]) * direction[1] - (at.y - point[1]) * direction[0]))

    return min(found, key=away, default=None)


def touching(one: PlacedProfile, other: PlacedProfile, near: Vector2 | None) -> tuple[float, float] | None:
    """Find the parameters at which two profiles have a common normal, near a point, or where they are nearest.

    None where there is none near.
    """
    from scipy.spatial import KDTree

    (s1, at1), (s2, at2) = one.samples(), other.samples()
    points1, points2 = (np.stack([at.x, at.y], axis=1) for at in (at1, at2))
    if near is None:
        gaps, which = KDTree(points2).query(points1)
        first = int(np.argmin(gaps))
        q = np.array([s1[first], s2[np.asarray(which)[first]]])
    else:
        q = np.array([s[np.argmin(np.linalg.norm(p - near, axis=1))] for s, p in ((s1, points1), (s2, points2))])
    whole = np.array([one.spline.knots[-1], other.spline.knots[-1]])
    scale, misfit = np.array([1.0, whole.max()]), np.full(2, np.inf)  # turns over the length of the curve are lengths
    for _ in range(_STEPS):
        a, b = one.spline.at(np.array(q[0])), other.spline.at(np.array(q[1]))
        apart = np.array([b.x - a.x, b.y - a.y])
        sine, cosine = a.cos * b.sin - a.sin * b.cos, a.cos * b.cos + a.sin * b.sin
        misfit = np.array([a.cos * apart[0] + a.sin * apart[1], sine])
        normal = -a.sin * apart[0] + a.cos * apart[1]
        slopes = np.array(
            [
                [normal * a.turning - np.hypot(a.dx, a.dy), a.cos * b.dx + a.sin * b.dy],
                [-cosine * a.turning, cosine * b.turning],
            ]
        )
        step = np.linalg.lstsq(scale[:, None] * slopes, scale * misfit, rcond=1e-12)[0]
        step *= min(1.0, 0.02 * whole.min() / max(float(np.abs(step).max()), 1e-300))
        q = np.array([_within(placed, value) for placed, value in zip((one, other), q - step, strict=True)])
        if np.all(np.abs(step) <= 4 * _CONVERGED * whole):
            return float(q[0]), float(q[1])
    return (float(q[0]), float(q[1])) if np.all(np.abs(scale * misfit) <= 1e-12 * whole.max()) else None


def _within(placed: PlacedProfile, q: float) -> float:
    whole = float(placed.spline.knots[-1])
    return q % whole if placed.spline.closed else min(max(q, 0.0), whole)
