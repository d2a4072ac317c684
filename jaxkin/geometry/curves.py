"""Smooth plane curves through points: cubic splines over the chords, closed (periodic) or open (not-a-knot).

The parameter of a curve is the length of the chords from point to point, in the unit of the points: about the length of
the arc. A cubic spline over it has an error of the fourth order in the distance of the points, however they are spaced.
A curve is given in axes of its own; the frame of its joint lies at the contact of the assembled pose, with x along the
tangent, and all that is computed here is in that frame.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax.lax import linalg
from jaxtyping import Array, Float

from jaxkin._pytree import register_leaves

ROUNDING = 1e-12
"""Distance over the size of a curve, and angle, that are rounding: some thousand roundings of float64, since the points
of a curve may lie far from the origin of their axes."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve of a joint, in the unit of the mechanism. A pytree: all but `closed` are leaves, each of which may have
    the axis of a batch of designs."""

    points: Float[Array | np.ndarray, "... points 2"]
    """The points that the curve passes, in the axes in which they were given."""
    start: Float[Array | np.ndarray, "..."]
    """Where the contact of the assembled pose is: number of the point before it, and the fraction of the chord."""
    place: Float[Array | np.ndarray, "... 3"]
    """Pose (x, y, angle) of the axes of the points in the frame of the joint: at the contact, x along the tangent."""
    closed: bool
    """Whether the last point is joined to the first one."""

    def over(self, length: Any) -> Curve:
        """Divide all lengths by a length."""
        scale = np.array([1.0, 1.0, 0.0]) / length + np.array([0.0, 0.0, 1.0])
        if isinstance(length, jax.Array):
            scale = jnp.where(np.array([True, True, False]), 1.0 / length, 1.0)
        return replace(self, points=self.points / length, place=self.place * scale)

    def spline(self, xp: Any = np) -> Spline:
        """Compute the spline, in numpy or in JAX (`xp`)."""
        points = xp.asarray(self.points, float)
        x, y, angle = xp.asarray(self.place, float)
        cos, sin = xp.cos(angle), xp.sin(angle)
        local = xp.stack([x + cos * points[:, 0] - sin * points[:, 1], y + sin * points[:, 0] + cos * points[:, 1]], 1)
        if self.closed:
            local = xp.concatenate([local, local[:1]])
        chords = local[1:] - local[:-1]
        widths = xp.sqrt(xp.sum(chords**2, axis=1))
        knots = xp.concatenate([xp.zeros_like(widths[:1]), xp.cumsum(widths)])
        rise = chords / widths[:, None]
        table = hermite_cubics(local, rise, slopes_at_knots(xp, widths, rise, self.closed), widths[:, None])
        number = xp.asarray(self.start, float)
        start = length_at(xp, number, knots, self.closed)
        return Spline(knots, xp.stack(table), xp.asarray(start), self.closed)

    def counted_from(self, q: float) -> Curve:
        """Return the same curve for the frame that stands at parameter `q` of this one: host numbers."""
        spline = self.spline()
        at = spline.at(np.array([q]))
        x, y, angle = np.asarray(self.place, float)
        cos, sin = float(at.cos[0]), float(at.sin[0])
        dx, dy = x - float(at.x[0]), y - float(at.y[0])
        place = np.array([cos * dx + sin * dy, cos * dy - sin * dx, angle - np.arctan2(sin, cos)])
        start = number_at(float(spline.start + q), spline.knots, self.closed)
        return replace(self, start=np.asarray(start), place=place)


register_leaves(Curve, leaves=("points", "start", "place"), static=("closed",))


class CurvePoint(NamedTuple):
    """A point of a curve at each parameter, in the frame of the joint; lengths in the unit of the spline."""

    x: Any
    y: Any
    cos: Any
    """Cosine of the angle from the x axis to the tangent."""
    sin: Any
    dx: Any
    """Derivative of x with respect to the parameter."""
    dy: Any
    turning: Any
    """Derivative of the angle of the tangent with respect to the parameter."""


@dataclass(frozen=True, eq=False)
class Spline:
    """A curve as cubic pieces, in the frame of the joint. A pytree: all but `closed` are leaves."""

    knots: Float[Array | np.ndarray, " knots"]
    """Length of the chords up to each point; a closed curve ends with its first point."""
    table: Float[Array | np.ndarray, "4 pieces 2"]
    """Coefficients of the powers 0 to 3 of the parameter behind the beginning of each piece."""
    start: Float[Array | np.ndarray, ""]
    """Parameter of the contact in the assembled pose, from which `at` counts."""
    closed: bool

    @property
    def periods(self) -> tuple[Any, ...]:
        """For its only coordinate the length after which the curve repeats; None where it is open."""
        return (self.knots[-1] if self.closed else None,)

    @property
    def begins_at_contact(self) -> bool:
        """Whether the curve is at the origin for the parameter 0, along x, to rounding: numbers only."""
        at = self.at(0.0)
        size = float(np.abs(self.table[0]).max()) + float(self.knots[-1])
        return bool(max(abs(at.x) / size, abs(at.y) / size, abs(at.sin)) <= ROUNDING and at.cos > 0)

    def at(self, q: Float[Array | np.ndarray | float, "*poses"], xp: Any = np) -> CurvePoint:
        """Evaluate the curve at parameters counted from the assembled pose.

        A closed curve repeats. Beyond the ends of an open one its first and last cubic go on.
        """
        s = self.start + q
        if self.closed:
            s = s - self.knots[-1] * xp.floor(s / self.knots[-1])
        piece = xp.clip(xp.searchsorted(self.knots, s, side="right") - 1, 0, self.table.shape[1] - 1)
        coefficients = xp.moveaxis(self.table[:, piece], -1, 1)
        return curve_point(coefficients, s - self.knots[piece], xp.sqrt)


def curve_point(coefficients: Any, t: Any, sqrt: Any) -> CurvePoint:
    """Evaluate cubics: `coefficients[power][axis]` at `t` behind the beginning of their pieces, in any arithmetic."""
    (x, dx, ddx), (y, dy, ddy) = (cubic([coefficients[power][axis] for power in range(4)], t) for axis in (0, 1))
    square = dx * dx + dy * dy
    speed = sqrt(square)
    return CurvePoint(x, y, dx / speed, dy / speed, dx, dy, (dx * ddy - dy * ddx) / square)


def cubic(c: Any, t: Any) -> tuple[Any, Any, Any]:
    """Evaluate a cubic, its first and its second derivative, in any arithmetic; `c` are its coefficients by power."""
    return c[0] + t * (c[1] + t * (c[2] + t * c[3])), c[1] + t * (2 * c[2] + 3 * t * c[3]), 2 * c[2] + 6 * t * c[3]


def hermite_cubics(values: Any, rise: Any, slopes: Any, width: Any) -> list[Any]:
    """Compute the coefficients, by power, of the cubics with given values and derivatives at successive knots.

    `rise` are the quotients of the differences of the values and of the knots, `width` the latter.
    """
    begin, end = slopes[:-1], slopes[1:]
    return [values[:-1], begin, (3 * rise - 2 * begin - end) / width, (begin + end - 2 * rise) / width**2]


jax.tree_util.register_dataclass(Spline, data_fields=["knots", "table", "start"], meta_fields=["closed"])


def length_at(xp: Any, number: Any, knots: Any, closed: bool) -> Any:
    """Compute the length of the chords up to a number of points, beyond an end in lengths of the last chord."""
    last = len(knots) - 1
    found = xp.interp(number, xp.arange(last + 1, dtype=knots.dtype), knots)
    if closed:
        return found
    return found + xp.minimum(number, 0.0) * knots[1] + xp.maximum(number - last, 0.0) * (knots[-1] - knots[-2])


def sampled_pieces(knots: Any, closed: bool, each: int) -> Float[np.ndarray, " samples"]:
    """Sample the lengths of the chords at `each` even places between two knots, an open curve also at its end: host
    numbers."""
    knots = np.asarray(knots, float)
    s = (knots[:-1, None] + np.diff(knots)[:, None] * np.arange(each) / each).ravel()
    return s if closed else np.append(s, knots[-1])


def number_at(s: float, knots: Any, closed: bool) -> float:
    """Compute the number of points at a length of the chords, the inverse of `length_at`: host numbers."""
    if closed:
        s = s % float(knots[-1])
    number = float(np.interp(s, knots, np.arange(len(knots))))
    if closed:
        return number
    return number + min(s, 0.0) / float(knots[1]) + max(s - float(knots[-1]), 0.0) / float(knots[-1] - knots[-2])


def slopes_at_knots(xp: Any, widths: Any, rise: Any, closed: bool) -> Any:
    """Compute the derivatives of cubic splines at all knots, (knots, splines), from the rise on each chord."""
    return (_periodic_slopes if closed else _open_slopes)(xp, widths, rise)


def _periodic_slopes(xp: Any, widths: Any, rise: Any) -> Any:
    """Compute the derivatives at all knots of a closed spline, those of the last knot being those of the first.

    At knot i, between chords a (before) and b (behind): `b m[i-1] + 2 (a + b) m[i] + a m[i+1] = 3 (b r_a + a r_b)`.
    The corners of the cyclic matrix are a product of two vectors, taken off and put back by Sherman and Morrison.
    """
    before, behind = xp.concatenate([widths[-1:], widths[:-1]]), widths
    right = 3 * (behind[:, None] * xp.concatenate([rise[-1:], rise[:-1]]) + before[:, None] * rise)
    diagonal = 2 * (before + behind)
    corner = diagonal[0]
    ones = xp.ones_like(widths)
    first, last = (xp.arange(len(ones)) == number for number in (0, len(ones) - 1))
    u = xp.where(first, -corner, xp.where(last, before[-1], 0.0))
    v_last = -behind[0] / corner
    diagonal = diagonal + xp.where(first, corner, xp.where(last, before[-1] * behind[0] / corner, 0.0))
    lower, upper = xp.where(first, 0.0, behind), xp.where(last, 0.0, before)
    solved = _tridiagonal(xp, lower, diagonal, upper, xp.concatenate([right, u[:, None]], axis=1))
    y, z = solved[:, :-1], solved[:, -1:]
    slopes = y - z * (y[:1] + v_last * y[-1:]) / (1.0 + z[0] + v_last * z[-1])
    return xp.concatenate([slopes, slopes[:1]])


def _open_slopes(xp: Any, widths: Any, rise: Any) -> Any:
    """Compute the derivatives at all knots of an open spline, whose first and last two pieces are one cubic each."""
    a, b = widths[:-1, None], widths[1:, None]
    inner = 3 * (b * rise[:-1] + a * rise[1:])
    # both ends together: the outer chord, the one beside it, and what they rise
    outer, beside = (xp.concatenate([widths[k : k + 1], widths[-1 - k :][:1]])[:, None] for k in (0, 1))
    r_outer, r_beside = (xp.concatenate([rise[k : k + 1], rise[-1 - k :][:1]]) for k in (0, 1))
    both = outer + beside
    ends = ((outer + 2 * both) * beside * r_outer + outer**2 * r_beside) / both
    none = xp.zeros_like(widths[:1])
    diagonal = xp.concatenate([widths[1:2], 2 * (widths[:-1] + widths[1:]), widths[-2:-1]])
    lower = xp.concatenate([none, widths[1:], both[1]])
    upper = xp.concatenate([both[0], widths[:-1], none])
    right = xp.concatenate([ends[:1], inner, ends[1:]])
    return _tridiagonal(xp, lower, diagonal, upper, right)


def _tridiagonal(xp: Any, lower: Any, diagonal: Any, upper: Any, right: Any) -> Any:
    """Solve tridiagonal equations; the first entry of `lower` and the last one of `upper` must be zero."""
    if xp is jnp:
        return linalg.tridiagonal_solve(lower, diagonal, upper, right)
    from scipy.linalg import solve_banded  # half of the time of importing jaxkin

    banded = np.stack([np.roll(upper, 1), diagonal, np.roll(lower, -1)])
    return solve_banded((1, 1), banded, right)
