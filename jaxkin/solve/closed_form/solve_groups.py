"""All groups of a loop system by their formulas, one after another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.closed_form import planar_dyad, rod, spherical_triangle
from jaxkin.solve.closed_form.arithmetic import Number, namespace
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.chain_motions import (
    OPENING,
    ChainSection,
    displace,
    moving_rows,
    planar_link,
    planar_place,
)
from jaxkin.solve.closed_form.complex_numbers import Complex
from jaxkin.solve.closed_form.coordinate import REST, Coordinate, FormulaCoordinates, found, given
from jaxkin.solve.closed_form.group_formulas import GroupFormula, group_formulas
from jaxkin.solve.closed_form.vectors import Rotation, Vector, carry, cross, dot, subtract
from jaxkin.solve.lockstep import computed_once
from jaxkin.solve.system.loop_system import LoopSystem

_UNTURNED = Rotation.of(np.eye(3))
"""Takes each axis of coordinates to itself."""


class Solved(NamedTuple):
    """Poses by formulas."""

    coordinates: tuple[Coordinate, ...]
    """Of every column, one for each pose; zero for balls."""
    discriminants: tuple[Float[Array | np.ndarray, " poses"], ...]
    """Of every group, over its largest possible value."""

    @property
    def x(self) -> Float[Array | np.ndarray, "columns poses"]:
        """Radians, those of unknowns in (-pi, pi], and characteristic lengths."""
        rows = [coordinate.value for coordinate in self.coordinates]
        return namespace(*rows).stack(rows)


def _plainly(function: Callable[..., Any], *args: Any) -> Any:
    """Call a function, where what it computes may be differentiated, or is NumPy's."""
    return function(*args)


def assembled_roots(system: LoopSystem, axes: AssembledAxes) -> list[Number]:
    """Compute the signed root of the discriminant of every group in the assembled pose: its sign is that of the branch.

    All coordinates are taken as zero there.
    """
    rest: FormulaCoordinates = [REST] * system.columns
    return [_signed_root(system, axes, formula, rest) for formula in _formulas(system)]


def solve_groups(
    system: LoopSystem,
    axes: AssembledAxes,
    signs: Sequence[Number],
    inputs: Float[Array | np.ndarray, "driven poses"],
    call: Callable[..., Any] = _plainly,
) -> Solved:
    """Compute all coordinates for inputs in radians and characteristic lengths, on the branches of these signs.

    `call` calls the two functions of arrays that each group is made of: the links that are known, and its formula.
    """
    xp = namespace(inputs, axes.centre)
    x: list[Coordinate | None] = [None] * system.columns
    for column, row in zip(system.driven, inputs, strict=True):
        x[column] = given(row, is_length=system.is_length[column])
    discriminants = []
    for formula, sign in zip(_formulas(system), signs, strict=True):

        def known_parts(axes: AssembledAxes, x: FormulaCoordinates, formula=formula) -> Any:
            return _known_parts(system, axes, formula, x)

        def solved(axes: AssembledAxes, known: Any, sign: Number, formula=formula):
            coordinates, discriminant = _solve(axes, formula, known, sign)
            return jax.tree.map(lambda row: xp.broadcast_to(row, inputs.shape[1:]), (coordinates, discriminant))

        coordinates, discriminant = call(solved, axes, call(known_parts, axes, x), sign)
        for column, coordinate in zip(formula.columns, coordinates, strict=True):
            x[column] = coordinate
        discriminants.append(discriminant)
    rest = Coordinate(xp.zeros_like(inputs[0]), REST.turn)
    return Solved(tuple(rest if each is None else each for each in x), tuple(discriminants))


def solve_once(
    system: LoopSystem,
    axes: AssembledAxes,
    signs: Float[Array | np.ndarray, "groups 1"],
    inputs: Float[Array | np.ndarray, "driven poses"],
) -> Solved:
    """Compute the same as `solve_groups`, in a program so that links and unknowns of each group are computed once.

    One chain of cheap operations from the input to the last group would be computed anew for each of its coordinates.
    """
    if namespace(inputs, axes.centre) is np:
        return solve_groups(system, axes, list(signs), inputs)

    def once(function: Callable[..., Any], *args: Any) -> Any:
        return computed_once(lambda *args: jax.tree.map(jnp.asarray, function(*args)), *args)

    return jax.tree.map(jnp.asarray, solve_groups(system, axes, list(signs), inputs, once))


def _formulas(system: LoopSystem) -> list[GroupFormula]:
    """List the formulas of all groups; ValueError where a group has none."""
    found = [formula for formula in group_formulas(system) if isinstance(formula, GroupFormula)]
    if len(found) < len(group_formulas(system)):
        raise ValueError(f"a group has no formula: {group_formulas(system)}")
    return found


def _known_parts(system: LoopSystem, axes: AssembledAxes, formula: GroupFormula, x: FormulaCoordinates) -> Any:
    """Find the arguments of the formula of a group, a tuple, but for the sign of its branch."""
    if formula.name == "planar dyad":
        return _planar(system, axes, formula, x)
    if formula.name == "spherical triangle":
        return _spherical(system, axes, formula, x)
    axis, centre = _axis(axes, formula)
    known = _rod(system, axes, formula, x)
    return (axis, centre, *known) if formula.letters == "R" else (axis, *known)


def _solve(axes: AssembledAxes, formula: GroupFormula, known: Any, sign: Number) -> tuple[list[Coordinate], Number]:
    """Compute the coordinates of a group, and its discriminant."""
    if formula.name == "planar dyad":
        motions, discriminant = planar_dyad.planar_dyad(formula.letters, *known, sign=sign)
    elif formula.name == "spherical triangle":
        motions, discriminant = spherical_triangle.spherical_triangle(*known, sign=sign)
    else:
        *motions, discriminant = (rod.rod_turn if formula.letters == "R" else rod.rod_slide)(*known, sign=sign)
    senses = [axes.sense[row, formula.chain] for row in formula.rows]
    return [found(motion).times(sense) for motion, sense in zip(motions, senses, strict=True)], discriminant


def _signed_root(system: LoopSystem, axes: AssembledAxes, formula: GroupFormula, rest: FormulaCoordinates) -> Number:
    """Compute the signed root of the discriminant of a group, whose unknowns are zero, at the coordinates `rest`."""
    known = _known_parts(system, axes, formula, rest)
    if formula.name == "planar dyad":
        return planar_dyad.signed_root(formula.letters, *known)
    if formula.name == "spherical triangle":
        return spherical_triangle.signed_root(*known)
    return (rod.signed_root_of_turn if formula.letters == "R" else rod.signed_root_of_slide)(*known[:-1])


def _planar(system: LoopSystem, axes: AssembledAxes, formula: GroupFormula, x: FormulaCoordinates):
    """Find the places and known links of a dyad: the arguments of `planar_dyad`."""
    chain, (one, two, three) = formula.chain, formula.rows
    places = [planar_place(system, axes, row, chain) for row in formula.rows]
    rows = [
        moving_rows(system, chain, one + 1, two),
        moving_rows(system, chain, two + 1, three),
        [*moving_rows(system, chain, three + 1), OPENING, *moving_rows(system, chain, 0, one)],
    ]
    return places, [
        planar_link(ChainSection(system, axes, chain, between), x, *ends)
        for between, ends in zip(rows, planar_dyad.link_ends(formula.letters, places), strict=True)
    ]


def _spherical(system: LoopSystem, axes: AssembledAxes, formula: GroupFormula, x: FormulaCoordinates):
    """Find the axes and known rotations of a spherical triangle: the arguments of `spherical_triangle`."""
    chain, (one, two, three) = formula.chain, formula.rows
    found = [Vector.of(axes.direction[row, chain]) for row in formula.rows]

    def turned(begin: int, end: int | None, rotation: Rotation) -> Rotation:
        section = ChainSection.of(system, axes, chain, begin, end)
        return Rotation(*(displace(section, x, column, free=True) for column in rotation))

    behind = turned(three + 1, None, Rotation.of(axes.open_turn[chain]))
    before = turned(0, one, _UNTURNED)
    return found, [
        turned(one + 1, two, _UNTURNED),
        turned(two + 1, three, _UNTURNED),
        Rotation(*(carry(behind, column) for column in before)),
    ]


def _rod(system: LoopSystem, axes: AssembledAxes, formula: GroupFormula, x: FormulaCoordinates):
    """Find the balls of a rod as seen from the unknown, and the length of the rod: arguments of the formulas of `rod`.

    The chain begins in the first ball, at the origin of its coordinates, and ends in the second; the rod is the other
    chain, or whatever lies on the other side.
    """
    chain, (row,) = formula.chain, formula.rows
    near = displace(ChainSection.of(system, axes, chain, 0, row), x, Vector.of(np.zeros(3)), inverse=True)
    far = displace(ChainSection.of(system, axes, chain, row + 1), x, Vector.of(axes.open_shift[chain]))
    other = formula.other_chain
    if other is None:
        raise ValueError(f"the loop of {formula} is not cut at a rod")
    end = _end(system, axes, other, x)
    return near, far, namespace(*end).sqrt(dot(end, end))


def _axis(axes: AssembledAxes, formula: GroupFormula):
    """Find the direction of the axis of the unknown, and a point on it."""
    here = formula.rows[0], formula.chain
    return Vector.of(axes.direction[here]), Vector.of(axes.centre[here])


def residual_norm(
    system: LoopSystem, axes: AssembledAxes, rows: FormulaCoordinates
) -> Float[Array | np.ndarray, " poses"]:
    """Compute the square root of Eq. 12 over all loops, as `closure` does, of systems whose groups are formulas.

    `rows` are the coordinates of all columns.
    """
    xp = namespace(*jax.tree.leaves(rows), axes.centre)
    if system.planar:
        square, origin = axes.off_plane, Complex(np.zeros(1), np.zeros(1))
        for chain in range(len(system.loops)):
            whole = ChainSection(system, axes, chain, [*moving_rows(system, chain), OPENING])
            turn, shift = planar_link(whole, rows, origin, origin)
            # a turn changes four of the nine entries of a rotation matrix
            square = square + 2 * ((turn.real - 1) ** 2 + turn.imag**2) + shift.real**2 + shift.imag**2
        return xp.sqrt(square)
    square = xp.zeros(())
    for formula in _formulas(system):
        if formula.other_chain is None:
            continue
        ends = (_end(system, axes, chain, rows) for chain in (formula.chain, formula.other_chain))
        lengths = [xp.sqrt(dot(end, end)) for end in ends]
        square = square + (lengths[0] - lengths[1]) ** 2
    for chain in system.sections.spherical:
        whole = ChainSection.of(system, axes, chain)
        end = _end(system, axes, chain, rows)
        square = square + dot(end, end)
        one, other, _ = Rotation.of(axes.open_turn[chain])
        first, second = (displace(whole, rows, column, free=True) for column in (one, other))
        # two columns of a rotation tell the third one, without a displacement of its own
        for column, own in zip((first, second, cross(first, second)), _UNTURNED, strict=True):
            left = subtract(column, own)
            square = square + dot(left, left)
    return xp.sqrt(square)


def _end(system: LoopSystem, axes: AssembledAxes, chain: int, x: FormulaCoordinates) -> Vector:
    """Find where a chain ends."""
    return displace(ChainSection.of(system, axes, chain), x, Vector.of(axes.open_shift[chain]))
