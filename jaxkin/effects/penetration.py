"""Measure how deep two solids are in each other, where their triangles cross or the one is inside of the other.

The depth is the largest distance from the surface of one solid of a point of the surface of the other that is inside of
it, or less: the points are corners, and the middles of those pieces of edges that are cut out by the triangles they go
through: two bars that cross have no corner in each other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from jaxkin.effects.clash_shapes import ClashShape
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.enclosed import may_be_inside
from jaxkin.geometry.tree_crossings import Slack
from jaxkin.geometry.triangle_distance import edge_places

_AT_ONCE = 1 << 18
"""Places of points that are held at once."""


class Cuts(NamedTuple):
    """Triangles of two shapes that cross."""

    pose: Int[np.ndarray, " _"]
    """Index of the displacement."""
    first: Int[np.ndarray, " _"]
    """Triangle of shape 1."""
    second: Int[np.ndarray, " _"]
    """Triangle of shape 2."""


def depths(
    one: ClashShape, other: ClashShape, displaced: Displaced, cuts: Cuts, slack: Slack
) -> Float[np.ndarray, " poses"]:
    """Measure the depth at each displacement, a length; 0 where no point is deeper than the slack of where it is."""
    back, turned = displaced.inverse(), Cuts(cuts.pose, cuts.second, cuts.first)
    return np.maximum(
        _of_first(one, other, back, displaced, cuts, slack),
        _of_first(other, one, displaced, back, turned, slack.exchanged()),
    )


def _of_first(
    one: ClashShape, other: ClashShape, displaced: Displaced, back: Displaced, cuts: Cuts, slack: Slack
) -> Float[np.ndarray, " poses"]:
    """Measure how deep points of shape 1, which is displaced relative to shape 2, are in shape 2."""
    count = len(displaced.shift)
    found = np.zeros(count)
    of_triangle = slack.first[one.labels]
    corners, index = one.corners
    of_corner = np.zeros(len(corners))
    np.maximum.at(of_corner, index.ravel(), np.repeat(of_triangle, 3))
    reached = other.reached(corners, back)
    corners, of_corner = corners[reached], of_corner[reached]
    size = max(1, _AT_ONCE // max(1, len(corners)))
    for begin in range(0, count, size):
        some = np.arange(begin, min(begin + size, count))
        places = (corners @ displaced.rotation[some].swapaxes(1, 2) + displaced.shift[some, None]).reshape(-1, 3)
        _deepen(found, other, places, np.repeat(some, len(corners)), np.tile(of_corner, len(some)), slack)
    middles, pose, triangle = _middles_of_edges(one, other, back, cuts)
    _deepen(found, other, displaced.of(pose, middles), pose, of_triangle[triangle], slack)
    return found


def _deepen(
    found: np.ndarray, other: ClashShape, points: np.ndarray, pose: np.ndarray, allowed: np.ndarray, slack: Slack
) -> None:
    """Raise the depth of each pose to that of its deepest point in a shape, if it is deeper than what is allowed."""
    low, high = other.tree.low[0] + slack.least, other.tree.high[0] - slack.least
    (inside,) = np.nonzero(np.all((points > low) & (points < high), axis=-1))
    inside = inside[may_be_inside(other.tree, points[inside])]
    height, nearest = other.tree.signed_distances(points[inside])
    deep = -height > slack.least + allowed[inside] + slack.second[other.labels[nearest]]
    np.maximum.at(found, pose[inside][deep], -height[deep])


def _middles_of_edges(
    one: ClashShape, other: ClashShape, back: Displaced, cuts: Cuts
) -> tuple[Float[np.ndarray, "_ 3"], Int[np.ndarray, " _"], Int[np.ndarray, " _"]]:
    """Find the middles of the pieces into which triangles of shape 2 cut edges of shape 1.

    Returns the points, the displacement of each, and its triangle of shape 1.
    """
    own = one.tree.triangles[cuts.first]
    place = edge_places(own, back.of(cuts.pose, other.tree.triangles[cuts.second]))
    row, edge = np.nonzero(~np.isnan(place))
    place = place[row, edge]
    key = (cuts.pose[row] * len(one.tree.triangles) + cuts.first[row]) * 3 + edge
    _, first = np.unique(key, return_index=True)
    # the two ends of each edge beside the places at which it is cut
    row, edge, key = (np.concatenate([each, each[first], each[first]]) for each in (row, edge, key))
    place = np.concatenate([place, np.zeros(len(first)), np.ones(len(first))])
    order = np.lexsort((place, key))
    row, edge, key, place = row[order], edge[order], key[order], place[order]
    same = key[1:] == key[:-1]
    middle = ((place[1:] + place[:-1]) / 2)[same]
    row, edge = row[1:][same], edge[1:][same]
    start, end = own[row, edge], own[row, (edge + 1) % 3]
    return start + middle[:, None] * (end - start), cuts.pose[row], cuts.first[row]
