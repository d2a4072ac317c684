"""Unroll cylinders and cones: a chart of angle about the axis (times a radius) and height along it."""

from __future__ import annotations

import numpy as np

from jaxkin.contacts.overlap import Flat
from jaxkin.geometry.pose import Points, Vector, perpendicular
from jaxkin.geometry.triangles import Triangles


def unrolled(triangles: Triangles, origin: Vector, axis: Vector, radius: float) -> Flat:
    """Map triangles to the chart: angle about `axis` times `radius`, and height along it from `origin`, both lengths.

    The first corner of a triangle has an angle in [-pi, pi], the others are within half a turn of the first. A triangle
    with a corner at the apex of a cone, where all angles meet, is a rectangle in the chart and becomes two triangles;
    the second ones come last.
    """
    x = perpendicular(axis)
    offset = triangles - origin
    height, a, b = offset @ axis, offset @ x, offset @ np.cross(axis, x)
    distance = np.hypot(a, b)
    theta = np.arctan2(b, a)
    pointed = distance < 1e-6 * distance.max(initial=0.0)
    apex = np.flatnonzero(pointed.any(axis=1))
    for row in apex:
        roll = -int(np.argmax(pointed[row]))
        theta[row], height[row] = np.roll(theta[row], roll), np.roll(height[row], roll)
        theta[row, 0] = theta[row, 1]
    theta[:, 1:] = theta[:, :1] + shorter_way(theta[:, 1:] - theta[:, :1])
    chart = np.stack([theta * radius, height], axis=-1)
    second = chart[apex][:, [0, 2, 2]]
    second[:, 2, 1] = second[:, 0, 1]
    return np.concatenate([chart, second])


def turned(chart: Flat, radius: float) -> Flat:
    """Add copies of unrolled triangles one turn back and one turn ahead, so that overlaps across +-pi are found."""
    turn = np.array([2 * np.pi * radius, 0.0])
    return np.concatenate([chart - turn, chart, chart + turn])


def unrolled_difference(ends: Points, starts: Points, origin: Vector, axis: Vector, radius: float) -> np.ndarray:
    """Compute the vectors (_, 2) in the chart from each start to its end, the shorter way round the axis."""
    x = perpendicular(axis)
    y = np.cross(axis, x)
    theta_start, theta_end = (np.arctan2((p - origin) @ y, (p - origin) @ x) for p in (starts, ends))
    return np.stack([radius * shorter_way(theta_end - theta_start), (ends - starts) @ axis], axis=-1)


def shorter_way(angle: np.ndarray) -> np.ndarray:
    """Wrap angles to [-pi, pi]."""
    return np.angle(np.exp(1j * angle))
