"""Measure how deep sample points of a solid are in another one, for many displacements at once."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.effects.clash_shapes import Shape
from jaxkin.geometry.displaced import Displaced
from jaxkin.geometry.tree_crossings import Slack

_STRIDES = (16, 1)
"""Successive displacements that are looked at together, by the one in their middle: a point that is farther from the
other solid there than it moves among them is in it at none of them."""
_AT_ONCE = 1 << 20
"""Places of points that are held at once, some 100 MB."""


def sampled_depths(one: Shape, other: Shape, displaced: Displaced, slack: Slack) -> Float[np.ndarray, "2 poses"]:
    """Measure the depth at each displacement of points of the surfaces, and of points amid the solids, in two rows.

    It is 0 where no point is deeper than the slack of where it is.
    """
    exchanged = Slack(slack.least, slack.second, slack.first, slack.ignored.T)
    return np.maximum(
        _of_first(one, other, displaced.inverse(), slack),
        _of_first(other, one, displaced, exchanged),
    )


def _of_first(one: Shape, other: Shape, displaced: Displaced, slack: Slack) -> Float[np.ndarray, "2 poses"]:
    """Measure how deep points of the surface of shape 1, which is displaced, and points amid it are in shape 2."""
    surface, cores = one.surface_points, one.core_points
    points = np.concatenate([surface.points, cores])
    on_surface = np.repeat([True, False], [len(surface.points), len(cores)])
    allowed = slack.least + np.concatenate([slack.first[surface.triangle], np.zeros(len(cores))])
    # faces that the motion maps onto themselves are as near the other solid as at the first displacement
    invariant = np.asarray(np.all(slack.ignored, axis=1))[one.labels[surface.triangle]]
    once = np.concatenate([invariant, np.zeros(len(cores), bool)])
    count, size = len(displaced.shift), max(1, _AT_ONCE // len(points))
    found, lasting = np.zeros((2, count)), 0.0
    for begin in range(0, count, size):
        some = displaced.at(np.arange(begin, min(begin + size, count)))
        places = np.swapaxes(points @ np.swapaxes(some.rotation, 1, 2) + some.shift[:, None], 0, 1)
        looked_at = ~once[:, None] | (np.arange(begin, begin + len(some.shift)) == 0)
        point, pose, depth = _inside(places, looked_at, allowed, other, slack.second)
        np.maximum.at(found, (np.where(on_surface[point], 0, 1), begin + pose), depth)
        lasting = max(lasting, float(depth[once[point]].max(initial=0.0)))
    found[0] = np.maximum(found[0], lasting)
    return found


def _inside(
    places: Float[np.ndarray, "points poses 3"],
    looked_at: Bool[np.ndarray, "points poses"],
    allowed: Float[np.ndarray, " points"],
    other: Shape,
    slack: Float[np.ndarray, " triangles"],
) -> tuple[Int[np.ndarray, " _"], Int[np.ndarray, " _"], Float[np.ndarray, " _"]]:
    """Find the places of points that are deeper in a shape than what is allowed: point, displacement and depth."""
    count = places.shape[1]
    inset = allowed[:, None, None]
    in_box = np.all((places > other.tree.low[0] + inset) & (places < other.tree.high[0] - inset), axis=-1)
    near = in_box & looked_at
    for stride in _STRIDES:
        begin = np.arange(0, count, stride)
        middle = np.minimum(begin + stride // 2, count - 1)
        point, group = np.nonzero(np.logical_or.reduceat(near, begin, axis=1))
        if not len(point):
            break
        place = places[point, middle[group]]
        height, nearest = other.tree.signed_distances(place)
        if stride == 1:
            deep = -height > allowed[point] + slack[nearest]
            return point[deep], group[deep], -height[deep]
        moved = [
            np.linalg.norm(places[point, np.minimum(begin[group] + k, count - 1)] - place, axis=-1)
            for k in range(stride)
        ]
        deep = np.max(moved, axis=0) - height > allowed[point]
        within = np.zeros((len(places), len(begin)), bool)
        within[point[deep], group[deep]] = True
        near &= np.repeat(within, stride, axis=1)[:, :count]
    return np.zeros(0, int), np.zeros(0, int), np.zeros(0)
