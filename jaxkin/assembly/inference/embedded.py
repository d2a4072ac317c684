"""How much of a pin is in the material of another part, as of one that ends in a lug without a hole for it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin._memory import once_for_each
from jaxkin.assembly.inference.bores import Bore
from jaxkin.geometry.part import Part

STATIONS = 24
"""Places along a pin at which it is looked for in the material of others."""
AROUND = 0.9
"""Radius of the circle of points at each of these places, over that of the pin: a hole through which it goes is wider,
and a pin that is hollow may be thinner still."""
MIN_DEPTH = 0.5
"""Length of a pin in the material of another part, over its radius, from which on it is embedded there: a screw drawn a
little too long is not."""
_RAYS = ((0.5773, 0.2113, 0.7887), (-0.7071, 0.6533, 0.2706), (0.1951, -0.9239, 0.3289))
"""Directions that are askew to the faces and edges of what people draw, so that few rays meet an edge."""


def depth_inside(pin: Bore, other: Part) -> float:
    """Measure the length of a pin that lies in the material of a part."""
    x = np.cross(pin.axis, np.eye(3)[np.argmin(np.abs(pin.axis))])
    x /= np.linalg.norm(x)
    angles = 2 * np.pi * np.arange(3)[:, None] / 3
    circle = AROUND * pin.radius * (np.cos(angles) * x + np.sin(angles) * np.cross(pin.axis, x))
    places = pin.half * ((2 * np.arange(STATIONS) + 1) / STATIONS - 1)
    points = pin.point + places[:, None, None] * pin.axis + circle
    low, high = other.box
    near = np.all((points > low) & (points < high), axis=2)
    if not near.any():
        return 0.0
    within = np.zeros(near.shape, bool)
    within[near] = inside(points[near], other)
    return float(np.sum(within.all(axis=1)) * 2 * pin.half / STATIONS)


def inside(points: Float[np.ndarray, "points 3"], part: Part) -> Bool[np.ndarray, " points"]:
    """Tell whether points lie in a part: most of three rays from each go through its surface an odd number of times."""
    votes = np.zeros(len(points), int)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    apart = _spheres(part).middles - middle
    reach = _spheres(part).radii + np.linalg.norm(points - middle, axis=1).max()
    for ray in _RAYS:
        turn = np.linalg.qr(np.column_stack([ray, np.eye(3)[:, :2]]))[0]
        away = np.sum(apart**2, axis=1) - (apart @ turn[:, 0]) ** 2
        seen, corners = points @ turn, part.triangles[away <= reach**2] @ turn  # the first coordinate is along the ray
        flat, at = corners[:, :, 1:], seen[:, 1:]
        met = np.all((flat.max(axis=1) >= at.min(axis=0)) & (flat.min(axis=1) <= at.max(axis=0)), axis=1)
        votes += _crossed(seen, corners[met]) % 2
    return votes >= 2


class _Spheres(NamedTuple):
    """A sphere around each triangle of a part: what misses it misses the triangle."""

    middles: Float[np.ndarray, "triangles 3"]
    radii: Float[np.ndarray, " triangles"]


@once_for_each
def _spheres(part: Part) -> _Spheres:
    """Find spheres around the triangles of a part, from their centroids, once for all that is looked for in it."""
    middles = part.triangles.mean(axis=1)
    return _Spheres(middles, np.linalg.norm(part.triangles - middles[:, None], axis=2).max(axis=1))


def _crossed(
    points: Float[np.ndarray, "points 3"], triangles: Float[np.ndarray, "triangles 3 3"]
) -> Int[np.ndarray, " points"]:
    """Count how many triangles lie ahead of each point along the first coordinate."""
    start, edges = triangles[None, :, :, 1:], np.roll(triangles, -1, axis=1)[None, :, :, 1:] - triangles[None, :, :, 1:]
    offset = points[:, None, None, 1:] - start
    turns = edges[..., 0] * offset[..., 1] - edges[..., 1] * offset[..., 0]
    over = np.all(turns > 0, axis=-1) | np.all(turns < 0, axis=-1)
    total = turns.sum(axis=-1)
    weights = np.roll(turns, -1, axis=-1) / np.where(total == 0, 1.0, total)[..., None]
    height = np.sum(weights * triangles[None, :, :, 0], axis=-1)
    return np.sum(over & (height > points[:, None, 0]), axis=1)
