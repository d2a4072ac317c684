"""Measure how deep sample points of a solid are in another one, for many displacements at once."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from jaxkin.effects.clash_shapes import ClashShape
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.enclosed import may_be_inside
from jaxkin.geometry.tree_crossings import Slack
from jaxkin.geometry.triangle_distance import Points

_STRIDES = (16, 1)
"""Successive displacements that are looked at together, by the one in their middle: a point that is farther from the
other solid there than it moves among them is in it at none of them."""
_AT_ONCE = 1 << 20
"""Places of points that are held at once, some 100 MB."""


def sampled_depths(
    one: ClashShape, other: ClashShape, displaced: Displaced, slack: Slack, near: Int[np.ndarray, " _"]
) -> Float[np.ndarray, "2 poses"]:
    """Measure the depth at each displacement of points of the surfaces, and of points amid the solids, in two rows.

    It is 0 where no point is deeper than the slack of where it is. `near` are the displacements at which the boxes of
    the solids overlap by more than the least slack: at the others no point is deeper.
    """
    return np.maximum(
        _of_first(one, other, displaced.inverse(), displaced, slack, near),
        _of_first(other, one, displaced, displaced.inverse(), slack.exchanged(), near),
    )


def _of_first(
    one: ClashShape, other: ClashShape, displaced: Displaced, back: Displaced, slack: Slack, near: np.ndarray
) -> Float[np.ndarray, "2 poses"]:
    """Measure how deep points of the surface of shape 1, which is displaced, and points amid it are in shape 2."""
    found = np.zeros((2, len(displaced.shift)))
    if not len(near):
        return found
    surface, cores = one.surface_points, one.core_points
    points = np.concatenate([surface.points, cores])
    on_surface = np.repeat([True, False], [len(surface.points), len(cores)])
    labels = one.labels[surface.triangle]
    allowed = slack.least + np.concatenate([slack.first[labels], np.zeros(len(cores))])
    # faces that the motion maps onto themselves are as near the other solid as at the first displacement
    once = np.concatenate([np.asarray(np.all(slack.ignored, axis=1))[labels], np.zeros(len(cores), bool)])
    if near[0] == 0:
        _, _, lasting = _inside(points[once], allowed[once], displaced.at(np.array([0])), other, slack.second)
        found[0] = lasting.max(initial=0.0)
    often = ~once & other.reached(points, back.at(near))
    points, allowed, on_surface = points[often], allowed[often], on_surface[often]
    size = max(1, _AT_ONCE // max(1, len(points)))
    for begin in range(0, len(near), size):
        some = near[begin : begin + size]
        point, pose, depth = _inside(points, allowed, displaced.at(some), other, slack.second)
        np.maximum.at(found, (np.where(on_surface[point], 0, 1), some[pose]), depth)
    return found


def _inside(
    points: Points, allowed: Float[np.ndarray, " points"], displaced: Displaced, other: ClashShape, slack: np.ndarray
) -> tuple[Int[np.ndarray, " _"], Int[np.ndarray, " _"], Float[np.ndarray, " _"]]:
    """Find where displaced points are deeper in a shape, whose labels have slacks, than what is allowed.

    Returns the point, the displacement and the depth of each place.
    """
    count = len(displaced.shift)
    # one coordinate a row: comparisons of long rows are quick
    places = displaced.rotation.transpose(1, 0, 2) @ points.T + displaced.shift.T[:, :, None]
    near = np.ones((count, len(points)), bool)
    for along, low, high in zip(places, other.tree.low[0], other.tree.high[0], strict=True):
        near &= (along > low + allowed) & (along < high - allowed)
    for stride in _STRIDES if count > _STRIDES[0] else (1,):
        begin = np.arange(0, count, stride)
        group, point = np.nonzero(np.logical_or.reduceat(near, begin, axis=0))
        if not len(point):
            break
        place = places[:, np.minimum(begin + stride // 2, count - 1)[group], point]
        if stride == 1:
            inside = may_be_inside(other.tree, np.ascontiguousarray(place.T))
            group, point, place = group[inside], point[inside], place[:, inside]
        height, nearest = other.tree.signed_distances(np.ascontiguousarray(place.T))
        if stride == 1:
            deep = -height > allowed[point] + slack[other.labels[nearest]]
            return point[deep], group[deep], -height[deep]
        among = np.minimum(begin[group] + np.arange(stride)[:, None], count - 1)
        moved = np.linalg.norm(places[:, among, point] - place[:, None], axis=0).max(axis=0)
        within = np.zeros((len(begin), len(points)), bool)
        deep = moved - height > allowed[point]
        within[group[deep], point[deep]] = True
        near &= np.repeat(within, stride, axis=0)[:count]
    return np.zeros(0, int), np.zeros(0, int), np.zeros(0)
