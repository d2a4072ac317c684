"""Measure how deep sample points of a solid are in another one, for many displacements at once."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from jaxkin.effects.clash_shapes import ClashShape
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.tree_crossings import Slack
from jaxkin.geometry.triangle_distance import Points

_STRIDES = (16, 1)
"""Successive displacements that are looked at together, by the one in their middle: a point that is farther from the
other solid there than it moves among them is in it at none of them."""
_AT_ONCE = 1 << 20
"""Places of points that are held at once, some 100 MB."""


def sampled_depths(
    one: ClashShape, other: ClashShape, displaced: Displaced, slack: Slack
) -> Float[np.ndarray, "2 poses"]:
    """Measure the depth at each displacement of points of the surfaces, and of points amid the solids, in two rows.

    It is 0 where no point is deeper than the slack of where it is.
    """
    exchanged = Slack(slack.least, slack.second, slack.first, slack.ignored.T)
    return np.maximum(
        _of_first(one, other, displaced.inverse(), slack),
        _of_first(other, one, displaced, exchanged),
    )


def _of_first(one: ClashShape, other: ClashShape, displaced: Displaced, slack: Slack) -> Float[np.ndarray, "2 poses"]:
    """Measure how deep points of the surface of shape 1, which is displaced, and points amid it are in shape 2."""
    surface, cores = one.surface_points, one.core_points
    points = np.concatenate([surface.points, cores])
    on_surface = np.repeat([True, False], [len(surface.points), len(cores)])
    allowed = slack.least + np.concatenate([slack.first[surface.triangle], np.zeros(len(cores))])
    # faces that the motion maps onto themselves are as near the other solid as at the first displacement
    invariant = np.asarray(np.all(slack.ignored, axis=1))[one.labels[surface.triangle]]
    once = np.concatenate([invariant, np.zeros(len(cores), bool)])
    _, _, lasting = _inside(points[once], allowed[once], displaced.at(np.array([0])), other, slack.second)
    points, allowed, on_surface = points[~once], allowed[~once], on_surface[~once]
    count, size = len(displaced.shift), max(1, _AT_ONCE // max(1, len(points)))
    found = np.zeros((2, count))
    found[0] = lasting.max(initial=0.0)
    for begin in range(0, count, size):
        some = displaced.at(np.arange(begin, min(begin + size, count)))
        point, pose, depth = _inside(points, allowed, some, other, slack.second)
        np.maximum.at(found, (np.where(on_surface[point], 0, 1), begin + pose), depth)
    return found


def _inside(
    points: Points, allowed: Float[np.ndarray, " points"], displaced: Displaced, other: ClashShape, slack: np.ndarray
) -> tuple[Int[np.ndarray, " _"], Int[np.ndarray, " _"], Float[np.ndarray, " _"]]:
    """Find where displaced points are deeper in a shape, whose triangles have slacks, than what is allowed.

    Returns the point, the displacement and the depth of each place.
    """
    count = len(displaced.shift)
    # one coordinate a row: comparisons of long rows are quick
    places = displaced.rotation.transpose(1, 0, 2) @ points.T + displaced.shift.T[:, :, None]
    near = np.ones((count, len(points)), bool)
    for along, low, high in zip(places, other.tree.low[0], other.tree.high[0], strict=True):
        near &= (along > low + allowed) & (along < high - allowed)
    for stride in _STRIDES:
        begin = np.arange(0, count, stride)
        group, point = np.nonzero(np.logical_or.reduceat(near, begin, axis=0))
        if not len(point):
            break
        place = places[:, np.minimum(begin + stride // 2, count - 1)[group], point]
        height, nearest = other.tree.signed_distances(np.ascontiguousarray(place.T))
        if stride == 1:
            deep = -height > allowed[point] + slack[nearest]
            return point[deep], group[deep], -height[deep]
        among = np.minimum(begin[group] + np.arange(stride)[:, None], count - 1)
        moved = np.linalg.norm(places[:, among, point] - place[:, None], axis=0).max(axis=0)
        within = np.zeros((len(begin), len(points)), bool)
        deep = moved - height > allowed[point]
        within[group[deep], point[deep]] = True
        near &= np.repeat(within, stride, axis=0)[:count]
    return np.zeros(0, int), np.zeros(0, int), np.zeros(0)
