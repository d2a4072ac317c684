"""The surface on which a function that is sampled on a grid is zero, as a closed mesh of triangles.

Each cell of the grid is six tetrahedra about its diagonal, alike in all cells, so that neighbours share their faces. In
a tetrahedron the function is linear: it is zero on a triangle or on a quadrangle (marching tetrahedra). Its corners lie
on edges of the grid, one a sign change, so that the mesh is closed wherever the function is positive on the border.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
from jaxtyping import Float, Int

TETRAHEDRA = np.array(
    [np.cumsum([np.zeros(3, int), *(np.eye(3, dtype=int)[list(order)])], axis=0) for order in permutations(range(3))]
)
"""Corners (6, 4, 3) of the tetrahedra of a cell: from its lowest corner to its highest one along three edges."""
SMALLEST = 1e-6
"""Least size of a value, over the largest one, that a value is taken for: corners at zero would make triangles without
an area, and the surface moves by this share of a cell at most."""


def zero_surface(
    values: Float[np.ndarray, "x y z"],
) -> tuple[Float[np.ndarray, "corners 3"], Int[np.ndarray, "triangles 3"]]:
    """Find corners, in steps of the grid from its first point, and triangles, wound outwards from where it is negative.

    The function must be positive on the border of the grid for the mesh to be closed.
    """
    least = SMALLEST * float(np.abs(values).max())
    values = np.where(np.abs(values) < least, least, values)
    negative = values < 0
    every = [
        negative[tuple(slice(a, a + n - 1) for a, n in zip(c, values.shape, strict=True))] for c in np.ndindex(2, 2, 2)
    ]
    cells = np.argwhere(np.any(every, axis=0) & ~np.all(every, axis=0))
    if not len(cells):
        return np.zeros((0, 3)), np.zeros((0, 3), int)
    flat, signs = values.ravel(), negative.ravel()
    edges, outward = [], []
    for tetrahedron in TETRAHEDRA:
        corners = np.ravel_multi_index(np.moveaxis(cells[:, None] + tetrahedron, -1, 0), values.shape)
        inside = signs[corners]
        # a tetrahedron whose edges turn the other way has its triangles wound the other way
        turn = np.linalg.det(np.diff(tetrahedron, axis=0))
        order = np.argsort(~inside, axis=1, kind="stable")  # negative corners first
        count = inside.sum(axis=1)
        corners = np.take_along_axis(corners, order, axis=1)
        turn = turn * _parity(order)
        a, b, c, d = corners.T
        for n, faces in (
            (1, [((a, b), (a, c), (a, d))]),
            (2, [((a, c), (a, d), (b, d)), ((a, c), (b, d), (b, c))]),
            (3, [((a, d), (b, d), (c, d))]),
        ):
            chosen = count == n
            for face in faces:
                edges.append(np.stack([np.stack([one[chosen], other[chosen]], axis=-1) for one, other in face], axis=1))
                outward.append(turn[chosen] > 0)
    ends, wound = np.concatenate(edges), np.concatenate(outward)
    ends[~wound] = ends[~wound][:, ::-1]
    ends = np.sort(ends, axis=-1)
    keys, triangles = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    one, other = (flat[keys[:, k]] for k in (0, 1))
    share = (one / (one - other))[:, None]
    starts, stops = (np.stack(np.unravel_index(keys[:, k], values.shape), axis=1) for k in (0, 1))
    return starts + share * (stops - starts), triangles.reshape(-1, 3)


def _parity(orders: Int[np.ndarray, "rows 4"]) -> Int[np.ndarray, " rows"]:
    """Return 1 for even permutations, -1 for odd ones."""
    found = np.ones(len(orders), int)
    for i in range(4):
        for j in range(i + 1, 4):
            found *= np.where(orders[:, i] > orders[:, j], -1, 1)
    return found
