"""A chain of elementary motions as a product of displacements about axes of the assembled pose.

The closure of a loop is E_1(q_1) E_2(q_2) ... E_n(q_n) M = 1. Every E is a turn about, or a slide along, its axis where
that is in the assembled pose, in world coordinates; M is what is left open there, and 1 unless dimensions were changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.solve.closed_form.planar_dyad import Complex, PlanarDisplacement, about, compose, scale
from jaxkin.solve.closed_form.spherical_triangle import Vector, cross, dot
from jaxkin.solve.closure.spatial import Spatial
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem

Coordinates = Sequence[Float[Array, " poses"] | None]
"""For each column of the system its coordinate; None where it is not known yet."""


class Axes(NamedTuple):
    """Axes of all rows of all chains in the assembled pose, and what the chains leave open there."""

    poses: Float[Array, "rows chains 4 4"]
    """Frames of the rows; the axis is z."""
    last: Float[Array, "chains 4 4"]
    pitch: Float[Array, " joints"]


class Plane(NamedTuple):
    """The plane of a planar system: its first two axes, and its normal."""

    along: Float[Array, "2 3"]
    normal: Float[Array, "3"]


def assembled_axes(geometry: Spatial) -> Axes:
    """Multiply the constant poses between the rows of the chains."""

    def onward(pose: Array, between: Array) -> tuple[Array, Array]:
        pose = pose @ between
        return pose, pose

    eye = jnp.broadcast_to(jnp.eye(4, dtype=geometry.end.dtype), geometry.end.shape)
    last, poses = lax.scan(onward, eye, geometry.between)
    return Axes(poses, last @ geometry.end, geometry.pitch)


def plane_of(system: LoopSystem, axes: Axes) -> Plane:
    """The plane of the first row that turns."""
    table = chain_tables(system)
    row, chain = np.argwhere((table.column < system.columns) & (table.turn > 0))[0]
    basis = axes.poses[row, chain, :3, :3].T
    return Plane(basis[:2], basis[2])


def known_rows(system: LoopSystem, chain: int, begin: int, end: int) -> list[int]:
    """The rows of a chain from `begin` to before `end` that move."""
    column = chain_tables(system).column[:, chain]
    return [row for row in range(begin, end) if column[row] < system.columns]


def planar_sense(system: LoopSystem, axes: Axes, plane: Plane, row: int, chain: int) -> Float[Array, ""]:
    """The sign of a coordinate that turns: +1 where it turns about the normal, and is travelled forwards."""
    sign = float(chain_tables(system).sign[row, chain])
    return sign * jnp.sign(axes.poses[row, chain, :3, 2] @ plane.normal)


def planar_place(system: LoopSystem, axes: Axes, plane: Plane, row: int, chain: int) -> Complex:
    """The centre of a row that turns, the direction of one that slides."""
    turns = bool(chain_tables(system).turn[row, chain])
    x, y = plane.along @ axes.poses[row, chain, :3, 3 if turns else 2]
    return Complex(x, y)


def planar_product(
    system: LoopSystem, axes: Axes, plane: Plane, chain: int, rows: Sequence[int], x: Coordinates
) -> PlanarDisplacement:
    """Multiply the motions of some rows, whose coordinates are known."""
    table = chain_tables(system)
    zero, one = jnp.zeros(1, axes.last.dtype), jnp.ones(1, axes.last.dtype)
    product = PlanarDisplacement(Complex(one, zero), Complex(zero, zero))
    for row in rows:
        place, q = planar_place(system, axes, plane, row, chain), _known(x, table.column[row, chain])
        if table.turn[row, chain]:
            cos, sin = cos_sin(planar_sense(system, axes, plane, row, chain) * q)
            moved = about(place, Complex(cos, sin))
        else:
            moved = PlanarDisplacement(Complex(one, zero), scale(float(table.sign[row, chain]) * q, place))
        product = compose(product, moved)
    return product


def planar_rest(axes: Axes, plane: Plane, chain: int) -> PlanarDisplacement:
    """What a chain leaves open in the assembled pose."""
    last = axes.last[chain]
    turned, (x, y) = plane.along @ last[:3, :3] @ plane.along[0], plane.along @ last[:3, 3]
    size = jnp.sqrt(turned @ turned)
    return PlanarDisplacement(Complex(turned[0] / size, turned[1] / size), Complex(x, y))


def carried(
    system: LoopSystem,
    axes: Axes,
    chain: int,
    rows: Sequence[int],
    x: Coordinates,
    vector: Vector,
    *,
    inverse: bool = False,
    free: bool = False,
) -> Vector:
    """Carry a point by the product of the motions of some rows, or by its inverse; a `free` vector is only turned."""
    table = chain_tables(system)
    for row in rows if inverse else reversed(rows):
        frame, sign = axes.poses[row, chain, :3, :, None], float(table.sign[row, chain])
        axis, centre = frame[:, 2], frame[:, 3]
        q = (-sign if inverse else sign) * _known(x, table.column[row, chain])
        if table.turn[row, chain]:
            lever = vector if free else vector - centre
            along = axis * dot(axis, lever)
            cos, sin = cos_sin(q)
            lever = along + cos * (lever - along) + sin * cross(axis, lever)
            vector = lever if free else centre + lever
        if not free and (table.slide[row, chain] or table.screw[row, chain]):
            pitch = axes.pitch[table.joint[row, chain]] / (2 * np.pi) if table.screw[row, chain] else 1.0
            vector = vector + axis * (pitch * q)
    return vector


def _known(x: Coordinates, column: int) -> Float[Array, " poses"]:
    found = x[column]
    if found is None:
        raise ValueError(f"column {column} is not known yet: the groups must be in the order of solution")
    return found
