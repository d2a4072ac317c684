"""Smooth surfaces through points: patches of bicubic splines over the chords, closed or open along u and along v.

The points are a grid. A coordinate of a patch is the length of the chords from one row of points to the next, the mean
over all of them, in the unit of the points; an error of the spline is of the fourth order in their distance. The frame
of its joint has the axes in which the points are given, and lies at the contact of the assembled pose; all that is
computed here is in that frame.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from jaxkin._pytree import register_leaves
from jaxkin.geometry.curves import (
    ROUNDING,
    Curve,
    CurvePoint,
    Spline,
    cubic,
    hermite_cubics,
    length_at,
    number_at,
    slopes_at_knots,
)


@dataclass(frozen=True, eq=False)
class Patch:
    """A surface of a joint, in the unit of the mechanism. A pytree: all but `closed` are leaves, each of which may have
    the axis of a batch of designs."""

    points: Float[Array | np.ndarray, "... m n 3"]
    """The points that the surface passes, in the axes in which they were given: u along the first axis of the array."""
    start: Float[Array | np.ndarray, "... 2"]
    """Where the contact of the assembled pose is, along u and v: number of the point before it, and the fraction of the
    chord."""
    place: Float[Array | np.ndarray, "... 3"]
    """Origin of the axes of the points in the frame of the joint, which has the same directions."""
    height: Float[Array | np.ndarray, "..."] | float | None
    """How far what follows is from the surface along its normal, the direction of u x v; None for a point on it."""
    closed: tuple[bool, bool]
    """Whether the last row of points is joined to the first one, along u and along v."""

    def over(self, length: Any) -> Patch:
        """Divide all lengths by a length."""
        height = None if self.height is None else self.height / length
        return replace(self, points=self.points / length, place=self.place / length, height=height)

    def spline(self, xp: Any = np) -> BicubicSpline:
        """Compute the spline, in numpy or in JAX (`xp`)."""
        local = xp.asarray(self.points, float) + xp.asarray(self.place, float)
        knots = []
        for axis, closed in enumerate(self.closed):
            if closed:
                local = xp.concatenate([local, local[:1] if axis == 0 else local[:, :1]], axis=axis)
            widths = xp.mean(xp.sqrt(xp.sum(xp.diff(local, axis=axis) ** 2, axis=2)), axis=1 - axis)
            knots.append(xp.concatenate([xp.zeros_like(widths[:1]), xp.cumsum(widths)]))
        (knots_u, knots_v), (closed_u, closed_v) = knots, self.closed
        by_v = xp.swapaxes(_slopes(xp, knots_v, xp.swapaxes(local, 0, 1), closed_v), 0, 1)
        along_u = xp.stack([local, by_v], axis=1)
        powers_u = xp.stack(_cubics(knots_u, along_u, _slopes(xp, knots_u, along_u, closed_u)))
        values, slopes = (xp.moveaxis(powers_u[:, :, k], 2, 0) for k in (0, 1))
        powers = xp.transpose(xp.stack(_cubics(knots_v, values, slopes)), (2, 0, 3, 1, 4))
        start = [length_at(xp, *each) for each in zip(xp.asarray(self.start, float), knots, self.closed, strict=True)]
        height = None if self.height is None else xp.asarray(self.height, float)
        return BicubicSpline(knots_u, knots_v, powers, xp.stack(start), height, self.closed)

    def counted_from(self, u: float, v: float) -> Patch:
        """Return the same patch for the frame that stands at the coordinates `u` and `v` of this one: host numbers."""
        spline = self.spline()
        at = spline.at(u, v)
        start = [
            number_at(float(begin) + q, knots, closed)
            for begin, q, knots, closed in zip(spline.start, (u, v), spline.knots, self.closed, strict=True)
        ]
        place = np.asarray(self.place, float) - np.array([at.x, at.y, at.z], float)
        return replace(self, start=np.array(start), place=place)


register_leaves(Patch, leaves=("points", "start", "place", "height"), static=("closed",))


class PatchPoint(NamedTuple):
    """Where what follows a surface is at each pair of coordinates, in the frame of the joint."""

    x: Any
    y: Any
    z: Any
    dx: Any
    """Derivatives of x, y, z with respect to u."""
    dy: Any
    dz: Any
    dx_v: Any
    """Derivatives of x, y, z with respect to v."""
    dy_v: Any
    dz_v: Any


class PatchDerivatives(NamedTuple):
    """A point of the surface itself, its first and its second derivatives, each the components x, y, z: an array
    (3, ...), or a sequence of three."""

    point: Any
    u: Any
    v: Any
    uu: Any
    uv: Any
    vv: Any


@dataclass(frozen=True, eq=False)
class BicubicSpline:
    """A surface as bicubic pieces, in the frame of the joint. A pytree: all but `closed` are leaves."""

    knots_u: Float[Array | np.ndarray, " knots_u"]
    """Mean length of the chords up to each row of points; a closed one ends with its first row."""
    knots_v: Float[Array | np.ndarray, " knots_v"]
    table: Float[Array | np.ndarray, "4 4 pieces_u pieces_v 3"]
    """Coefficients of the powers 0 to 3 of u, then of v, behind the beginning of each piece."""
    start: Float[Array | np.ndarray, "2"]
    """Coordinates of the contact in the assembled pose, from which `at` counts."""
    height: Float[Array | np.ndarray, ""] | float | None
    closed: tuple[bool, bool]

    @property
    def knots(self) -> tuple[Any, Any]:
        """The knots along u and along v."""
        return self.knots_u, self.knots_v

    @property
    def periods(self) -> tuple[Any, ...]:
        """For each coordinate the length after which the surface repeats; None where it does not."""
        return tuple(knots[-1] if closed else None for knots, closed in zip(self.knots, self.closed, strict=True))

    @property
    def begins_at_contact(self) -> bool:
        """Whether what follows is at the origin for the coordinates 0, to rounding: numbers only."""
        at = self.at(0.0, 0.0)
        size = float(np.abs(self.table[0, 0]).max()) + float(self.knots_u[-1]) + float(self.knots_v[-1])
        return bool(max(abs(at.x), abs(at.y), abs(at.z)) <= ROUNDING * size)

    def at(self, u: Any, v: Any, xp: Any = np) -> PatchPoint:
        """Evaluate where what follows is, at coordinates counted from the assembled pose.

        A closed coordinate repeats. Beyond the edges of an open one the first and the last cubic go on.
        """
        return patch_point(self.derivatives(u, v, xp), self.height, xp.sqrt)

    def derivatives(self, u: Any, v: Any, xp: Any = np) -> PatchDerivatives:
        """Evaluate the surface itself and its derivatives, at coordinates counted from the assembled pose."""
        pieces, behind = [], []
        for k, (q, knots, closed) in enumerate(zip((u, v), self.knots, self.closed, strict=True)):
            s = self.start[k] + q
            if closed:
                s = s - knots[-1] * xp.floor(s / knots[-1])
            pieces.append(xp.clip(xp.searchsorted(knots, s, side="right") - 1, 0, len(knots) - 2))
            behind.append(s - knots[pieces[-1]])
        coefficients = xp.moveaxis(self.table[:, :, pieces[0], pieces[1]], -1, 2)
        return bicubic(coefficients, behind[0], behind[1])


jax.tree_util.register_dataclass(
    BicubicSpline, data_fields=["knots_u", "knots_v", "table", "start", "height"], meta_fields=["closed"]
)

Followed = Curve | Patch
"""What a movement of a joint may follow."""
FollowedSpline = Spline | BicubicSpline
FollowedPoint = CurvePoint | PatchPoint


def bicubic(coefficients: Any, s: Any, t: Any) -> PatchDerivatives:
    """Evaluate bicubics, `coefficients[power of s, power of t, axis]`, and their derivatives, in any arithmetic.

    All three components are computed together: `coefficients` is an array, of objects for numbers of other libraries.
    """
    value, slope, bend = cubic([coefficients[:, power] for power in range(4)], t)
    (f, f_s, f_ss), (f_t, f_st, _), (f_tt, _, _) = (cubic(each, s) for each in (value, slope, bend))
    return PatchDerivatives(f, f_s, f_t, f_ss, f_st, f_tt)


def patch_point(at: PatchDerivatives, height: Any, sqrt: Any) -> PatchPoint:
    """Compute where what follows is, a height h along the unit normal n: p + h n, and its derivatives p_u + h n_u."""
    if height is None:
        return PatchPoint(*at.point, *at.u, *at.v)
    at = PatchDerivatives(*map(tuple, at))
    across = cross(at.u, at.v)
    length = sqrt(dot(across, across))
    normal = tuple(each / length for each in across)
    slides = []
    for change in (add(cross(at.uu, at.v), cross(at.u, at.uv)), add(cross(at.uv, at.v), cross(at.u, at.vv))):
        along = dot(normal, change)
        slides.append(tuple((c - along * n) / length for c, n in zip(change, normal, strict=True)))
    moved = zip((at.point, at.u, at.v), (normal, *slides), strict=True)
    return PatchPoint(*(p + height * n for one, other in moved for p, n in zip(one, other, strict=True)))


def dot(a: Any, b: Any) -> Any:
    """Multiply vectors of components in any arithmetic."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Any, b: Any) -> tuple[Any, ...]:
    """Compute the cross product of vectors of components in any arithmetic."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def add(a: Any, b: Any) -> tuple[Any, ...]:
    """Add vectors of components in any arithmetic."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _slopes(xp: Any, knots: Any, values: Any, closed: bool) -> Any:
    """Compute the derivatives of splines along the first axis at all knots: as many rows as `values` has."""
    flat = values.reshape(len(values), -1)
    widths = knots[1:] - knots[:-1]
    rise = (flat[1:] - flat[:-1]) / widths[:, None]
    return slopes_at_knots(xp, widths, rise, closed).reshape(values.shape)


def _cubics(knots: Any, values: Any, slopes: Any) -> list[Any]:
    """Compute the coefficients of the pieces along the first axis, from values and derivatives at the knots."""
    width = (knots[1:] - knots[:-1]).reshape(-1, *(1,) * (values.ndim - 1))
    return hermite_cubics(values, (values[1:] - values[:-1]) / width, slopes, width)
