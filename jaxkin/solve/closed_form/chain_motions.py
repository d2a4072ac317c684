"""Products of the motions of a chain, of which the coordinates are known: in the plane, and applied to points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.solve.closed_form import vectors
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.complex_numbers import Complex, add, scale, subtract, times
from jaxkin.solve.closed_form.coordinate import Coordinate, FormulaCoordinates
from jaxkin.solve.closed_form.planar_dyad import PlanarLink
from jaxkin.solve.closed_form.vectors import Vector, rotate
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem

OPENING = -1
"""Stands for what a chain leaves open in the assembled pose, at its end, among the rows of a section in the plane."""


def moving_rows(system: LoopSystem, chain: int, begin: int = 0, end: int | None = None) -> list[int]:
    """List the rows of a chain that move, from `begin` to before `end`, by default all."""
    column = chain_tables(system).column[:, chain]
    return [row for row in range(begin, len(column) if end is None else end) if column[row] < system.columns]


class ChainSection(NamedTuple):
    """Rows of a chain, one after another in order of travel."""

    system: LoopSystem
    axes: AssembledAxes
    chain: int
    rows: Sequence[int]

    @staticmethod
    def of(system: LoopSystem, axes: AssembledAxes, chain: int, begin: int = 0, end: int | None = None) -> ChainSection:
        """Take the rows that move, from `begin` to before `end`, by default all."""
        return ChainSection(system, axes, chain, moving_rows(system, chain, begin, end))


def planar_place(system: LoopSystem, axes: AssembledAxes, row: int, chain: int) -> Complex:
    """Find the centre of a row that turns, or the direction of one that slides."""
    x, y = (axes.centre if chain_tables(system).turn[row, chain] else axes.direction)[row, chain]
    return Complex(x, y)


def planar_link(section: ChainSection, x: FormulaCoordinates, begin: Complex, end: Complex) -> PlanarLink:
    """Compute the turn of the motions of a section of a chain at the coordinates `x`, and the vector from the point
    `begin` to where they take the point `end`; both are points of the assembled pose.

    What is the same in all poses is added up by itself: the vector costs one product of complex numbers a turn.
    """
    system, axes, chain, rows = section
    table = chain_tables(system)
    turn: Complex | None = None
    moving: Complex | None = None
    fixed = end  # the point is the sum of `moving` and `fixed`
    for row in reversed(rows):
        if row == OPENING:
            (cos, _), (sin, _) = axes.open_turn[chain]
            rotation = Complex(cos, sin)
            fixed = add(times(rotation, fixed), Complex(*axes.open_shift[chain]))
            moving = None if moving is None else times(rotation, moving)
        else:
            place = planar_place(system, axes, row, chain)
            q = _known(x, int(table.column[row, chain])).times(axes.sense[row, chain])
            if not table.turn[row, chain]:
                slide = scale(q.value, place)
                moving = slide if moving is None else add(slide, moving)
                continue
            rotation, lever = q.turn, subtract(fixed, place)
            moving, fixed = times(rotation, lever if moving is None else add(moving, lever)), place
        turn = rotation if turn is None else times(rotation, turn)
    rest = subtract(fixed, begin)
    return PlanarLink(turn or Complex(np.ones(1), np.zeros(1)), rest if moving is None else add(moving, rest))


def displace(
    section: ChainSection, x: FormulaCoordinates, vector: Vector, *, inverse: bool = False, free: bool = False
) -> Vector:
    """Displace a point by the product of the motions of a section, or its inverse; a `free` vector is only turned."""
    system, axes, chain, rows = section
    table = chain_tables(system)
    for row in rows if inverse else reversed(rows):
        axis, centre = Vector.of(axes.direction[row, chain]), Vector.of(axes.centre[row, chain])
        q = _known(x, int(table.column[row, chain])).times(axes.sense[row, chain])
        q = q.back() if inverse else q
        if table.turn[row, chain]:
            lever = rotate(axis, q.turn, vector if free else vectors.subtract(vector, centre))
            vector = lever if free else vectors.add(centre, lever)
        if not free and (table.slide[row, chain] or table.screw[row, chain]):
            vector = vectors.add(vector, vectors.scale(axes.advance[row, chain] * q.value, axis))
    return vector


def _known(x: FormulaCoordinates, column: int) -> Coordinate:
    """Look up the coordinate of a column; ValueError where it is not solved yet."""
    found = x[column]
    if found is None:
        raise ValueError(f"column {column} is not known yet: the groups must be in the order of solution")
    return found
