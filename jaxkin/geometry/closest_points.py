"""Find the closest points of two rigid meshes for many relative displacements at once, in JAX.

The points are found without derivatives, as weights of corners. What is computed of these corners with the weights held
has the value and the first derivatives of the distance: by the envelope theorem, points that are nearest to each other
change the distance to second order only.

All pairs are compared, one element of the moved mesh at a time with all of the fixed one.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.mesh_elements import (
    Edges,
    Mesh,
    Planes,
    Points,
    corner_of,
    height_squares,
    inside_face,
    nearest_of_edges,
    nearest_on_edges,
    through_faces,
)
from jaxkin.geometry.rigid import Rigid, inverse
from jaxkin.geometry.root import root

_RAY = np.array([0.36241, 0.48107, 0.79825])
"""Direction of the rays that tell whether a point is inside: along no face or edge that somebody would draw."""


class Closest(NamedTuple):
    """For each displacement two points whose distance is that of two meshes, or how deep they are in each other."""

    one: Points
    other: Points
    sign: Float[Array, " poses"]
    """1 where the meshes are apart, -1 where they cross, or the one is in the other."""


class _Found(NamedTuple):
    """The best pair so far at each displacement: square of the distance, and the two points."""

    square: Float[Array, " poses"]
    one: Points
    other: Points


@jax.jit
def closest_points(one: Mesh, other: Mesh, displacements: Rigid) -> Closest:
    """Find the closest points of a mesh and of another one, which `displacements` move relative to it.

    Where no corner, edge or face of the one crosses the other, and none is inside of it, these are the points that are
    nearest to each other. Otherwise the first point is the sample that is deepest in the other mesh, and the second the
    point of the surface that is nearest to it; where no sample is inside, it is an end of an edge that goes through a
    face, and its foot on the plane of that face.
    """
    one, other, displacements = jax.lax.stop_gradient(jax.tree.map(jnp.asarray, (one, other, displacements)))
    back = inverse(displacements)
    here = _moved(other.corners, displacements)  # in the axes of the one
    there = _moved(one.corners, back)  # in the axes of the other
    apart = _best(
        jnp.less,
        _edges_apart(other, here, one),
        _swapped(_corners_over_faces(one, there, other)),
        _corners_over_faces(other, here, one),
    )
    deep = [_deepest(other, _moved(other.samples.of(other), displacements), one)]
    deep.append(_swapped(_deepest(one, _moved(one.samples.of(one), back), other)))
    pierced = [_pierced(other, here, one), _swapped(_pierced(one, there, other))]
    inside, through = _best(jnp.greater, *deep), _best(jnp.greater, *pierced)
    overlap = _chosen(inside.square >= 0, inside, through)
    found = _chosen(overlap.square >= 0, overlap, apart)
    # the function of each pair of elements has the moved mesh first
    return Closest(found.other, found.one, jnp.where(overlap.square >= 0, -1.0, 1.0))


def signed_distance(one: Mesh, other: Mesh, places: tuple[Rigid, Rigid], closest: Closest) -> Float[Array, " poses"]:
    """Compute the distance of closest points of two displaced meshes, times their sign, with its first derivatives.

    The derivative is zero where the distance is.
    """
    points = [
        jnp.einsum("ijp,pj->ip", place[:, :3], each.of(mesh)) + place[:, 3]
        for mesh, place, each in zip((one, other), places, (closest.one, closest.other), strict=True)
    ]
    return closest.sign * root(jnp.sum((points[0] - points[1]) ** 2, axis=0))


def _moved(points: Float[Array | np.ndarray, "n 3"], displacements: Rigid) -> Float[Array, "3 n poses"]:
    """Move points by each displacement."""
    x, y, z = (displacements[:, k, None] * jnp.asarray(points)[None, :, k, None] for k in range(3))
    return x + y + z + displacements[:, 3, None]


def _chosen(which: Bool[Array, " poses"], first: _Found, second: _Found) -> _Found:
    """Take the first where it is wanted."""

    def either(a: Array, b: Array) -> Array:
        return jnp.where(which.reshape(-1, *(1,) * (a.ndim - 1)), a, b)

    return jax.tree.map(either, first, second)


def _best(better: Callable[[Array, Array], Array], *found: _Found) -> _Found:
    """Take at each displacement the one whose square is better, the first of equal ones."""
    return reduce(lambda best, each: _chosen(better(each.square, best.square), each, best), found)


def _swapped(found: _Found) -> _Found:
    return _Found(found.square, found.other, found.one)


def _nothing(poses: int, square: float) -> _Found:
    none = Points(jnp.zeros((poses, 3), int), jnp.zeros((poses, 3)))
    return _Found(jnp.full(poses, square), none, none)


class _Pair(NamedTuple):
    """For each displacement an element of the moved mesh and one of the fixed mesh."""

    moved: Int[Array, " poses"]
    fixed: Int[Array, " poses"]


def _least(squares: Callable[[Any], Float[Array, "poses n"]], count: int) -> _Pair:
    """Find the least of the squares of `count` elements of the moved mesh with all elements of the fixed one.

    What is kept from one element to the next is so for each element of the fixed mesh: to find the least one of these
    once is a loop over long rows, where to find it each time would take most of the time.
    """

    def step(best, element):
        found = squares(element)
        nearer = found < best[0]
        return (jnp.where(nearer, found, best[0]), jnp.where(nearer, element, best[1])), None

    first = squares(jnp.array(0))
    best, element = first, jnp.zeros(first.shape, int)
    if count > 1:
        (best, element), _ = jax.lax.scan(step, (best, element), jnp.arange(1, count))
    fixed = jnp.argmin(best, axis=1)
    return _Pair(jnp.take_along_axis(element, fixed[:, None], axis=1)[:, 0], fixed)


def _points(corners: Int[Array | np.ndarray, "poses 3"], *weights: Float[Array, " poses"]) -> Points:
    return Points(corners, jnp.stack(weights, axis=-1))


def _on_edges(edges: Int[Array | np.ndarray, "poses 2"], place: Float[Array, " poses"]) -> Points:
    """Make points of edges, at a share of each."""
    return _points(edges[:, [0, 1, 1]], 1 - place, place, 0 * place)


def _on_faces(
    faces: Int[Array | np.ndarray, "poses 3"], second: Float[Array, " poses"], third: Float[Array, " poses"]
) -> Points:
    return _points(faces, 1 - second - third, second, third)


def _edges_apart(moved: Mesh, here: Float[Array, "3 corners poses"], fixed: Mesh) -> _Found:
    """Find the nearest points of edges of both meshes."""
    edges = Edges.of(fixed)

    def squares(element: Any) -> Array:
        return nearest_of_edges(Edges.moved(here, moved.edges[element]), edges)[0]

    pair = _least(squares, len(moved.edges))
    own = moved.edges[pair.moved]
    square, s, t = (each[:, 0] for each in nearest_of_edges(Edges.moved(here, own), edges.at(pair.fixed)))
    return _Found(square, _on_edges(own, s), _on_edges(fixed.edges[pair.fixed], t))


def _corners_over_faces(moved: Mesh, here: Float[Array, "3 corners poses"], fixed: Mesh) -> _Found:
    """Find the corners of the moved mesh that are nearest to faces of the fixed one, with their feet in these."""
    poses = here.shape[-1]
    if not len(fixed.faces):
        return _nothing(poses, jnp.inf)
    planes = Planes.of(fixed)
    pair = _least(lambda corner: height_squares(planes, corner_of(here, corner)), len(moved.corners))
    point, plane = corner_of(here, pair.moved), planes.at(pair.fixed)
    second, third, _ = (each[:, 0] for each in plane.of_points(point))
    own = _on_edges(jnp.stack([pair.moved, pair.moved], axis=-1), jnp.zeros(poses))
    return _Found(height_squares(plane, point)[:, 0], own, _on_faces(fixed.faces[pair.fixed], second, third))


def _deepest(moved: Mesh, samples: Float[Array, "3 samples poses"], fixed: Mesh) -> _Found:
    """Find the samples of the moved mesh that are deepest in the fixed one, and the nearest points of its surface.

    The square is -1 where no sample is inside.
    """
    poses = samples.shape[-1]
    if not len(fixed.faces):
        return _nothing(poses, -1.0)
    planes, rays, edges = Planes.of(fixed), Planes.of(fixed, _RAY), Edges.of(fixed)

    def is_inside(sample: Array) -> Bool[Array, " poses"]:
        second, third, ahead = rays.of_points(corner_of(samples, sample))
        return jnp.sum(inside_face(second, third) & (ahead < 0), axis=1) % 2 == 1

    inside = jax.lax.map(is_inside, jnp.arange(samples.shape[1]))
    somewhere = jnp.any(inside, axis=1)
    order, count = jnp.argsort(~somewhere), jnp.sum(somewhere)

    def deeper(best: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        depth, of, number = best
        sample = order[number]
        point = corner_of(samples, sample)
        on_faces = jnp.min(height_squares(planes, point), axis=1)
        on_edges = jnp.min(nearest_on_edges(point, edges)[0], axis=1)
        found = jnp.where(inside[sample], jnp.minimum(on_faces, on_edges), -1.0)
        return jnp.maximum(found, depth), jnp.where(found > depth, sample, of), number + 1

    # samples that are inside nowhere cost no distances
    begun = jnp.full(poses, -1.0), jnp.zeros(poses, int), jnp.array(0)
    depth, sample, _ = jax.lax.while_loop(lambda best: best[2] < count, deeper, begun)
    point = corner_of(samples, sample)
    face = jnp.argmin(height_squares(planes, point), axis=1)
    edge = jnp.argmin(nearest_on_edges(point, edges)[0], axis=1)
    plane = planes.at(face)
    second, third, _ = (each[:, 0] for each in plane.of_points(point))
    square, place = (each[:, 0] for each in nearest_on_edges(point, edges.at(edge)))
    own = Points(*(each[sample] for each in moved.samples))
    foot = _Found(height_squares(plane, point)[:, 0], own, _on_faces(fixed.faces[face], second, third))
    on_edge = _Found(square, own, _on_edges(fixed.edges[edge], place))
    return _best(jnp.less, foot, on_edge)._replace(square=depth)


def _pierced(moved: Mesh, here: Float[Array, "3 corners poses"], fixed: Mesh) -> _Found:
    """Find the edges of the moved mesh that go farthest through faces of the fixed one: the end that is nearer to the
    plane of the face, and its foot there. The square is -1 where no edge goes through a face."""
    poses = here.shape[-1]
    if not len(fixed.faces):
        return _nothing(poses, -1.0)
    planes = Planes.of(fixed)

    def squares(element: Any) -> Array:
        return through_faces(Edges.moved(here, moved.edges[element]), planes)

    pair = _least(squares, len(moved.edges))
    edge, plane = moved.edges[pair.moved], planes.at(pair.fixed)
    both = Edges.moved(here, edge)
    ends = [tuple(each[:, 0] for each in plane.of_points(point)) for point in (both.start, both.start + both.along)]
    first_nearer = jnp.abs(ends[0][2]) <= jnp.abs(ends[1][2])
    second, third, _ = (jnp.where(first_nearer, *each) for each in zip(*ends, strict=True))
    own = _on_edges(edge, jnp.where(first_nearer, 0.0, 1.0))
    return _Found(-through_faces(both, plane)[:, 0], own, _on_faces(fixed.faces[pair.fixed], second, third))
