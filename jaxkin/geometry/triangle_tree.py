"""Order triangles of a solid into a binary tree of boxes, in which near ones are found quickly.

The triangles of a face lie in one subtree, so that boxes of flat faces are flat where an axis of the coordinates is
normal to them: `aligned_axes` finds such axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.pose import perpendicular, unit
from jaxkin.geometry.triangle_distance import Points, point_distances
from jaxkin.geometry.triangles import Triangles, double_areas

if TYPE_CHECKING:
    from scipy.spatial import KDTree

_SAME_DIRECTION = 1e-6
"""Difference of the components of two normals below which they count as one direction: rounding of corners."""
_LEVEL_DISTANCE = 1e-9
"""Share of its distance by which a triangle may be farther from a point than the nearest one and still decide on which
side the point lies: rounding, where the nearest place is an edge that several triangles share."""
_ROUNDING = 1e-12
"""Share of the size of a solid below which two lengths are one: rounding of coordinates and of their products."""
_SQUARINGS = 4
"""How often a matrix of edges is squared to find their main direction: a bound needs it to a few degrees only."""
_MAX_POINTS = 1 << 14
"""Points whose distances are measured at once: each is compared with some 60 boxes at a time, 100 MB in all."""


@dataclass(frozen=True, eq=False)
class TriangleTree:
    """Triangles and a binary tree of their bounding boxes; node 0 holds all of them."""

    triangles: Triangles
    """Wound outwards."""
    low: Float[np.ndarray, "nodes 3"]
    """Lowest corner of the box of each node."""
    high: Float[np.ndarray, "nodes 3"]
    """Highest corner."""
    children: Int[np.ndarray, "nodes 2"]
    """The two nodes that a node is split into; both are the node itself where it holds one triangle only."""
    triangle: Int[np.ndarray, " nodes"]
    """The first triangle of each node, the only one of a leaf."""
    label: Int[np.ndarray, " nodes"]
    """The label that all triangles of a node have; -1 where they have several."""
    own_axes: Float[np.ndarray, "3 3 nodes"]
    """Axes of each node, in rows: along its longest edges in its mean plane, across them, and normal to it. Boxes of
    what is slanted to the axes of the solid, such as long thin triangles that fan out over a face, are thick; those
    along their own axes are thin."""
    own_middles: Float[np.ndarray, "3 nodes"]
    """The middle of the box along its own axes, along these, from the middle of the other box."""
    own_halves: Float[np.ndarray, "3 nodes"]
    """Half the size of that box."""

    @cached_property
    def is_leaf(self) -> np.ndarray:
        """Which nodes hold one triangle only, (nodes,)."""
        return self.children[:, 0] == np.arange(len(self.children))

    @cached_property
    def middles(self) -> Float[np.ndarray, "3 nodes"]:
        """The middles of the boxes, one coordinate a row."""
        return np.ascontiguousarray((self.low + self.high).T) / 2

    @cached_property
    def halves(self) -> Float[np.ndarray, "3 nodes"]:
        """Half the sizes of the boxes, one coordinate a row."""
        return np.ascontiguousarray((self.high - self.low).T) / 2

    @cached_property
    def sizes(self) -> Float[np.ndarray, " nodes"]:
        """The length of half a diagonal of the own box of each node, -1 for single triangles, which are not split."""
        return np.where(self.is_leaf, -1.0, np.linalg.norm(self.own_halves, axis=0))

    @cached_property
    def _centroids(self) -> KDTree:
        """The centroids of the triangles, ordered for search."""
        from scipy.spatial import KDTree

        return KDTree(self.triangles.mean(axis=1))

    def signed_distances(self, points: Points) -> tuple[Float[np.ndarray, " _"], Int[np.ndarray, " _"]]:
        """Measure how far points are from the surface of the solid, and which of its triangles is nearest.

        The distances are lengths, negative inside. The nearest triangle tells the side; of several that are equally
        near, at an edge or a corner, the one over whose plane the point is highest.
        """
        found, nearest = np.zeros(len(points)), np.zeros(len(points), int)
        for start in range(0, len(points), _MAX_POINTS):
            some = slice(start, start + _MAX_POINTS)
            found[some], nearest[some] = self._signed(points[some])
        return found, nearest

    def _signed(self, points: Points) -> tuple[np.ndarray, np.ndarray]:
        """Compute what `signed_distances` returns, for points at once.

        A triangle whose centroid is near bounds each distance. Boxes nearer than that are split level by level, all
        points together, down to single triangles, which are measured.
        """
        which, node = np.arange(len(points)), np.zeros(len(points), int)
        guess = self._centroids.query(points)[1]
        level = _ROUNDING * float(np.abs(self.high - self.low).max())
        limit = point_distances(points, self.triangles[guess])[0] * (1 + _LEVEL_DISTANCE) + level
        while not np.all(self.is_leaf[node]):
            both = self.children[node]
            twice = both[:, 0] != both[:, 1]
            which, node = np.concatenate([which, which[twice]]), np.concatenate([both[:, 0], both[twice, 1]])
            apart = np.maximum(np.maximum(self.low[node] - points[which], points[which] - self.high[node]), 0.0)
            near = np.sum(apart**2, axis=-1) <= limit[which] ** 2
            which, node = which[near], node[near]
        distance, height = point_distances(points[which], self.triangles[self.triangle[node]])
        least = np.full(len(points), np.inf)
        np.minimum.at(least, which, distance)
        alike = distance <= least[which] * (1 + _LEVEL_DISTANCE) + level
        which, node, height = which[alike], node[alike], height[alike]
        order = np.lexsort((np.abs(height), which))
        last = order[np.flatnonzero(np.diff(which[order], append=-1))]
        return np.where(height[last] < 0, -1.0, 1.0) * least, self.triangle[node[last]]


def triangle_tree(triangles: Triangles, labels: Int[np.ndarray, " triangles"]) -> TriangleTree:
    """Order triangles, with the label of its face each, into a tree: faces by their centres, then triangles by theirs.

    Nodes are split in the middle along the axis along which their centres lie farthest apart, level by level.
    """
    count = len(triangles)
    middles = (triangles.min(axis=1) + triangles.max(axis=1)) / 2
    label = np.unique(labels, return_inverse=True)[1]
    of_faces = np.stack([np.bincount(label, middles[:, k]) for k in range(3)], axis=-1)
    of_faces /= np.bincount(label)[:, None]
    # triangles in the order of the leaves; each node is a range of them, which later splits reorder within
    order, ids = np.arange(count), np.array([0])
    begin, end = np.zeros(2 * count - 1, int), np.full(2 * count - 1, count)
    children = np.repeat(np.arange(2 * count - 1)[:, None], 2, axis=1)
    total, levels = 1, [ids]
    while len(ids) < count:
        starts, ends = begin[ids], end[ids]
        here = label[order]
        mixed = np.minimum.reduceat(here, starts) != np.maximum.reduceat(here, starts)
        segment = np.repeat(np.arange(len(ids)), ends - starts)
        place = np.where(mixed[segment, None], of_faces[here], middles[order])
        widths = np.maximum.reduceat(place, starts) - np.minimum.reduceat(place, starts)
        along = place[np.arange(count), np.argmax(widths, axis=1)[segment]]
        order = order[np.lexsort((here, along, segment))]
        cuts = (starts + ends) // 2
        cuts[mixed] = _face_ends(label[order], starts[mixed], ends[mixed], cuts[mixed])
        split = ends - starts > 1
        new = total + np.arange(2 * split.sum()).reshape(-1, 2)
        children[ids[split]] = new
        begin[new], end[new] = (
            np.stack(pair, axis=-1) for pair in ((starts[split], cuts[split]), (cuts[split], ends[split]))
        )
        total += new.size
        levels.append(new.ravel())
        ids = np.repeat(ids, np.where(split, 2, 1))
        ids[np.repeat(split, np.where(split, 2, 1))] = new.ravel()
    ranges = np.stack([begin, end], axis=-1).ravel()
    corners = np.concatenate([triangles[order], triangles[order][-1:]])
    low = np.minimum.reduceat(corners.min(axis=1), ranges)[::2]
    high = np.maximum.reduceat(corners.max(axis=1), ranges)[::2]
    first, last = (
        reduce.reduceat(np.append(labels[order], labels[order][-1]), ranges)[::2] for reduce in (np.minimum, np.maximum)
    )
    label = np.where(first == last, first, -1)
    own = _own_boxes(triangles[order], begin, end, levels, (low + high) / 2)
    return TriangleTree(triangles, low, high, children, order[begin], label, *own)


def _own_boxes(
    triangles: Triangles, begin: np.ndarray, end: np.ndarray, levels: list[np.ndarray], middles: Points
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find axes of nodes, ranges of triangles, and the middles and halves of their boxes along these axes.

    `levels` are the nodes of each level, and `middles` those of the boxes along the axes of the solid.
    """
    areas = double_areas(triangles)
    edges = np.roll(triangles, -1, axis=1) - triangles
    products = edges.swapaxes(1, 2) @ edges
    axes = np.zeros((len(middles), 3, 3))
    low, high = np.zeros_like(middles), np.zeros_like(middles)
    for nodes in levels:
        counts = end[nodes] - begin[nodes]
        first = np.cumsum(counts) - counts
        own = np.repeat(np.arange(len(nodes)), counts)
        held = np.arange(len(own)) + (begin[nodes] - first)[own]
        axes[nodes] = _axes_along(np.add.reduceat(areas[held], first), np.add.reduceat(products[held], first))
        off = triangles[held] - middles[nodes][own, None]
        places = off @ axes[nodes][own].swapaxes(1, 2)
        low[nodes] = np.minimum.reduceat(places.min(axis=1), first)
        high[nodes] = np.maximum.reduceat(places.max(axis=1), first)
    return (
        np.ascontiguousarray(np.moveaxis(axes, 0, -1)),
        np.ascontiguousarray((low + high).T) / 2,
        np.ascontiguousarray((high - low).T) / 2,
    )


def _axes_along(normals: Points, products: Float[np.ndarray, "_ 3 3"]) -> Float[np.ndarray, "_ 3 3"]:
    """Choose axes, in rows, by sums of normals, and of products of edges with themselves: along the longest edges."""
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    z = np.where(length > 0, normals / np.where(length > 0, length, 1.0), [0.0, 0.0, 1.0])
    for _ in range(_SQUARINGS):  # the largest eigenvalue comes to outweigh the others
        products = products @ products
        trace = np.trace(products, axis1=1, axis2=2)[:, None, None]
        products = products / np.where(trace > 0, trace, 1.0)
    rows = np.arange(len(z))
    along = products[rows, np.argmax(np.einsum("nii->ni", products), axis=1)]
    along = along - np.sum(along * z, axis=1, keepdims=True) * z
    length = np.linalg.norm(along, axis=1, keepdims=True)
    across = np.cross(z, np.eye(3)[np.argmin(np.abs(z), axis=1)])
    x = np.where(length > _SAME_DIRECTION, along, across)
    x = x / np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _face_ends(label: np.ndarray, starts: np.ndarray, ends: np.ndarray, cuts: np.ndarray) -> np.ndarray:
    """Move cuts of ranges of triangles, which hold several faces each, to the nearest place where a face ends."""
    edges = np.flatnonzero(np.diff(label)) + 1
    if not len(cuts):
        return cuts
    after = np.searchsorted(edges, cuts)
    above, below = edges[np.minimum(after, len(edges) - 1)], edges[np.maximum(after - 1, 0)]
    above_fits, below_fits = (above > starts) & (above < ends), (below > starts) & (below < ends)
    return np.where(below_fits & (~above_fits | (cuts - below < above - cuts)), below, above)


def aligned_axes(triangles: Triangles) -> Float[np.ndarray, "3 3"]:
    """Choose axes for a solid, in rows: the normal of most of its area, and of most of the area upright to that."""
    normals = double_areas(triangles)
    areas = np.linalg.norm(normals, axis=-1)
    normals, areas = normals[areas > 0] / areas[areas > 0, None], areas[areas > 0]
    if not len(areas):
        return np.eye(3)
    z = _main_direction(normals, areas)
    upright = np.abs(normals @ z) < _SAME_DIRECTION
    x = _main_direction(normals[upright], areas[upright]) if upright.any() else perpendicular(z)
    x = unit(x - (x @ z) * z)
    return np.stack([x, np.cross(z, x), z])


def _main_direction(normals: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """Find the unit direction that the largest area has as normal, either way."""
    main = np.take_along_axis(normals, np.abs(normals).argmax(axis=1)[:, None], axis=1)
    keys = np.round(normals * np.sign(main) / _SAME_DIRECTION).astype(int)
    _, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return normals[first[np.argmax(np.bincount(which.ravel(), areas))]]
