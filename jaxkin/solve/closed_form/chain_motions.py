"""Products of the motions of a chain, of which the coordinates are known: in the plane, and applied to points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.closed_form.assembled_axes import Axes
from jaxkin.solve.closed_form.equations import cos_sin
from jaxkin.solve.closed_form.planar_dyad import Complex, PlanarDisplacement, about, compose, scale
from jaxkin.solve.closed_form.spherical_triangle import Vector, cross, dot
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem

Coordinates = Sequence[Float[Array | np.ndarray, " #poses"] | None]
"""For each column of the system its coordinate; None where it is not known yet."""


def moving_rows(system: LoopSystem, chain: int, begin: int = 0, end: int | None = None) -> list[int]:
    """List the rows of a chain that move, from `begin` to before `end`, by default all."""
    column = chain_tables(system).column[:, chain]
    return [row for row in range(begin, len(column) if end is None else end) if column[row] < system.columns]


def planar_place(system: LoopSystem, axes: Axes, row: int, chain: int) -> Complex:
    """Find the centre of a row that turns, or the direction of one that slides."""
    x, y = (axes.centre if chain_tables(system).turn[row, chain] else axes.direction)[row, chain]
    return Complex(x, y)


def planar_product(
    system: LoopSystem, axes: Axes, chain: int, rows: Sequence[int], x: Coordinates
) -> PlanarDisplacement:
    """Multiply the motions of some rows."""
    table = chain_tables(system)
    zero, one = np.zeros(1), np.ones(1)
    product = None
    for row in rows:
        place = planar_place(system, axes, row, chain)
        q = axes.sense[row, chain] * _known(x, int(table.column[row, chain]))
        if table.turn[row, chain]:
            cos, sin = cos_sin(q)
            moved = about(place, Complex(cos, sin))
        else:
            moved = PlanarDisplacement(Complex(one, zero), scale(q, place))
        product = moved if product is None else compose(product, moved)
    return product or PlanarDisplacement(Complex(one, zero), Complex(zero, zero))


def planar_rest(axes: Axes, chain: int) -> PlanarDisplacement:
    """Compute what a chain leaves open in the assembled pose."""
    (cos, _), (sin, _) = axes.open_turn[chain]
    return PlanarDisplacement(Complex(cos, sin), Complex(*axes.open_shift[chain]))


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
        axis, centre = axes.direction[row, chain, :, None], axes.centre[row, chain, :, None]
        q = axes.sense[row, chain] * _known(x, int(table.column[row, chain])) * (-1.0 if inverse else 1.0)
        if table.turn[row, chain]:
            lever = vector if free else vector - centre
            along = axis * dot(axis, lever)
            cos, sin = cos_sin(q)
            lever = along + cos * (lever - along) + sin * cross(axis, lever)
            vector = lever if free else centre + lever
        if not free and (table.slide[row, chain] or table.screw[row, chain]):
            vector = vector + axis * (axes.advance[row, chain] * q)
    return vector


def _known(x: Coordinates, column: int) -> Float[Array | np.ndarray, " #poses"]:
    found = x[column]
    if found is None:
        raise ValueError(f"column {column} is not known yet: the groups must be in the order of solution")
    return found
