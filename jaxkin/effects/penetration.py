"""Measure how deep two solids are in each other, where their triangles cross or the one is inside of the other.

The depth is the largest distance from the surface of one solid of a point of the surface of the other that is inside of
it, or less: the points are corners, and the middles of those pieces of edges that are cut out by the triangles they go
through: two bars that cross have no corner in each other.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from jaxkin.effects.clash_shapes import ClashShape
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.tree_crossings import Crossings, Slack
from jaxkin.geometry.triangle_distance import edge_places


def depths(
    one: ClashShape, other: ClashShape, displaced: Displaced, crossed: Crossings, slack: Slack
) -> Float[np.ndarray, " poses"]:
    """Measure the depth at each displacement, a length; 0 where no point is deeper than the slack of where it is."""
    back = displaced.inverse()
    turned = Crossings(crossed.pose, crossed.second, crossed.first)
    exchanged = Slack(slack.least, slack.second, slack.first, slack.ignored.T)
    return np.maximum(
        _of_first(one, other, back, displaced, crossed, slack),
        _of_first(other, one, displaced, back, turned, exchanged),
    )


def _of_first(
    one: ClashShape, other: ClashShape, displaced: Displaced, back: Displaced, crossed: Crossings, slack: Slack
) -> Float[np.ndarray, " poses"]:
    """Measure how deep points of shape 1, which is displaced relative to shape 2, are in shape 2."""
    count = len(displaced.shift)
    corners, index = one.corners
    of_corner = np.zeros(len(corners))
    np.maximum.at(of_corner, index.ravel(), np.repeat(slack.first, 3))
    every = np.repeat(np.arange(count), len(corners))
    points, pose, allowed = displaced.of(every, np.tile(corners, (count, 1))), every, np.tile(of_corner, count)
    middles, pose2, triangle = _middles_of_edges(one, other, back, crossed)
    points = np.concatenate([points, displaced.of(pose2, middles)])
    pose, allowed = np.concatenate([pose, pose2]), np.concatenate([allowed, slack.first[triangle]])
    low, high = other.tree.low[0] + slack.least, other.tree.high[0] - slack.least
    (inside,) = np.nonzero(np.all((points > low) & (points < high), axis=-1))
    height, nearest = other.tree.signed_distances(points[inside])
    deep = -height > slack.least + allowed[inside] + slack.second[nearest]
    found = np.zeros(count)
    np.maximum.at(found, pose[inside][deep], -height[deep])
    return found


def _middles_of_edges(
    one: ClashShape, other: ClashShape, back: Displaced, crossed: Crossings
) -> tuple[Float[np.ndarray, "_ 3"], Int[np.ndarray, " _"], Int[np.ndarray, " _"]]:
    """Find the middles of the pieces into which triangles of shape 2 cut edges of shape 1.

    Returns the points, the displacement of each, and its triangle of shape 1.
    """
    own = one.tree.triangles[crossed.first]
    place = edge_places(own, back.of(crossed.pose, other.tree.triangles[crossed.second]))
    row, edge = np.nonzero(~np.isnan(place))
    place = place[row, edge]
    key = (crossed.pose[row] * len(one.tree.triangles) + crossed.first[row]) * 3 + edge
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
    return start + middle[:, None] * (end - start), crossed.pose[row], crossed.first[row]
