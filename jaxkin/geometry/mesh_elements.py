"""Corners, edges and faces of meshes in JAX: distances and crossings of one element and many, for many displacements.

Vectors have their three components as first axis, then the displacements, then the elements of the fixed mesh: what is
computed of them is loops over long rows.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

_PARALLEL = 1e-24
"""Square of the sine of an angle below which two segments count as parallel, far below any angle of a solid."""


class Mesh(NamedTuple):
    """Corners, and what is between them. A bar is one edge, a ball an edge between two equal corners."""

    corners: Float[Array | np.ndarray, "corners 3"]
    edges: Int[Array | np.ndarray, "edges 2"]
    """At least one."""
    faces: Int[Array | np.ndarray, "faces 3"]
    """Triangles that enclose a volume, wound outwards; or none."""
    samples: Points
    """Points that tell how deep the mesh is in another one."""


class Points(NamedTuple):
    """Points by the corners of a mesh: sum of `weights` times corners."""

    corners: Int[Array | np.ndarray, "*points 3"]
    weights: Float[Array | np.ndarray, "*points 3"]

    def of(self, mesh: Mesh) -> Float[Array, "*points 3"]:
        """Compute where the points are."""
        return jnp.einsum("...k,...ki->...i", self.weights, jnp.asarray(mesh.corners)[self.corners])


def _dot(a: Array, b: Array) -> Array:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _ratio(above: Array, below: Array) -> Array:
    """Divide, 0 where the divisor is 0."""
    return jnp.where(below == 0, 0.0, above / jnp.where(below == 0, 1.0, below))


class Edges(NamedTuple):
    """Edges by their start, and from there to their end; components first."""

    start: Array
    along: Array

    @staticmethod
    def of(mesh: Mesh) -> Edges:
        """Lay the edges of the fixed mesh out as (3, 1, edges), for rows of displacements."""
        start, end = (mesh.corners[mesh.edges[:, k]].T[:, None] for k in (0, 1))
        return Edges(start, end - start)

    @staticmethod
    def moved(here: Float[Array, "3 corners poses"], edge: Int[Array | np.ndarray, "*poses 2"]) -> Edges:
        """Take one edge of the moved mesh, the same at all displacements or one for each: (3, poses, 1)."""
        start, end = (corner_of(here, edge[..., k]) for k in (0, 1))
        return Edges(start, end - start)

    def at(self, index: Int[Array, " poses"]) -> Edges:
        """Take one edge for each displacement, (3, poses, 1)."""
        return Edges(*(each[:, 0, index, None] for each in self))


def corner_of(
    here: Float[Array, "3 corners poses"], index: Int[Array | np.ndarray, "*poses"]
) -> Float[Array, "3 poses 1"]:
    """Take one corner, the same at all displacements or one for each."""
    return here[:, index, :, None] if index.ndim == 0 else here[:, index, jnp.arange(here.shape[-1]), None]


def nearest_of_edges(one: Edges, other: Edges) -> tuple[Array, Array, Array]:
    """Compute the square of the distance of edges, and where on each the nearest points are, as its share."""
    off = one.start - other.start
    square1, square2, mixed = _dot(one.along, one.along), _dot(other.along, other.along), _dot(one.along, other.along)
    on1, on2 = _dot(one.along, off), _dot(other.along, off)
    determinant = square1 * square2 - mixed**2
    skew = determinant > _PARALLEL * square1 * square2
    s = jnp.where(skew, jnp.clip(_ratio(mixed * on2 - on1 * square2, determinant), 0.0, 1.0), 0.0)
    t = jnp.clip(_ratio(mixed * s + on2, square2), 0.0, 1.0)
    s = jnp.clip(_ratio(mixed * t - on1, square1), 0.0, 1.0)
    gap = off + s * one.along - t * other.along
    return _dot(gap, gap), s, t + 0 * s


def nearest_on_edges(points: Float[Array, "3 poses 1"], edges: Edges) -> tuple[Array, Array]:
    """Compute the square of the distance of points from edges, and where on each the nearest point is, as its share."""
    off = points - edges.start
    place = jnp.clip(_ratio(_dot(edges.along, off), _dot(edges.along, edges.along)), 0.0, 1.0)
    gap = off - place * edges.along
    return _dot(gap, gap), place


class Planes(NamedTuple):
    """Faces by their first corner, and by vectors whose products with what is beside it are its two other weights and
    its height; components first."""

    origin: Array
    second: Array
    third: Array
    height: Array

    @staticmethod
    def of(mesh: Mesh, ray: np.ndarray | None = None) -> Planes:
        """Make the planes of the faces, (3, 1, faces). With a ray heights are counted along it, not along the
        normal."""
        origin, *tips = (mesh.corners[mesh.faces[:, k]].T[:, None] for k in range(3))
        edge1, edge2 = (tip - origin for tip in tips)
        normal = jnp.cross(edge1, edge2, axis=0)
        upward = _ratio(normal, jnp.sqrt(_dot(normal, normal))) if ray is None else jnp.asarray(ray)[:, None, None]
        upward = jnp.broadcast_to(upward, normal.shape)
        second, third = jnp.cross(edge2, upward, axis=0), jnp.cross(upward, edge1, axis=0)
        return Planes(origin, *(_ratio(each, _dot(normal, upward)) for each in (second, third, normal)))

    def at(self, index: Int[Array, " poses"]) -> Planes:
        """Take one plane for each displacement, (3, poses, 1)."""
        return Planes(*(each[:, 0, index, None] for each in self))

    def of_points(self, points: Array) -> tuple[Array, Array, Array]:
        """Compute the weights of the second and the third corner, and the height, of points (3, poses, 1)."""
        off = points - self.origin
        return _dot(off, self.second), _dot(off, self.third), _dot(off, self.height)


def inside_face(second: Array, third: Array) -> Array:
    """Tell whether points are above or below a face, by the weights of its second and its third corner."""
    return (second >= 0) & (third >= 0) & (second + third <= 1)


def height_squares(planes: Planes, points: Float[Array, "3 poses 1"]) -> Float[Array, "poses faces"]:
    """Compute the square of the distance of points to faces above or below which they are; infinite elsewhere."""
    second, third, height = planes.of_points(points)
    return jnp.where(inside_face(second, third), height**2, jnp.inf)


def through_faces(edge: Edges, planes: Planes) -> Float[Array, "poses faces"]:
    """Compute, with a minus, the square of how far edges go through faces; 1 where they do not."""
    one, other = planes.of_points(edge.start), planes.of_points(edge.start + edge.along)
    place = _ratio(one[2], one[2] - other[2])
    second, third = (first + place * (last - first) for first, last in zip(one[:2], other[:2], strict=True))
    through = (one[2] * other[2] < 0) & inside_face(second, third)
    return jnp.where(through, -jnp.minimum(one[2] ** 2, other[2] ** 2), 1.0)
