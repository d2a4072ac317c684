"""Derivatives of planar dyads: by the screws of a pose that is known, and not by the operations of its formula.

A planar loop stays closed while the twists of its motions add up to zero. A twist of the plane is a rate of turn w and
the velocity v of the origin, a complex number. With p for the centre of a turn and R for the rotation of what lies
before it, both in the pose, and e for the turn itself, the rates of

    the turn               w = q',   v = -i p q'
    a slide                w = 0,    v = R d q'            d its direction
    the centre of a turn   w = 0,    v = R (1 - e) c'      c in the assembled pose
    the direction          w = 0,    v = R q d'
    what is left open      w = Im(conj(m) m'), v = R t'    a turn m and a shift t

are added, and the three unknown rates of a loop are the solution of three linear equations. That takes a tenth of the
operations of the derivative of the formula, which has as many poses to add up for each number of the geometry; all of
these are added by one product of matrices.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.solve.closed_form.arithmetic import Number
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.chain_motions import moving_rows, planar_place
from jaxkin.solve.closed_form.complex_numbers import Complex, add, cross, scale, subtract, times
from jaxkin.solve.closed_form.group_formulas import GroupFormula, group_formulas
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem


class _Screw(NamedTuple):
    """The twist of a row of a chain for a rate of its coordinate of one."""

    turns: bool
    """Whether the rate of turn is one; else it is zero."""
    velocity: Complex


class _Chain(NamedTuple):
    """The twists of a chain in its poses."""

    screws: dict[int, _Screw]
    """Of each row that moves."""
    turn: Float[Array, ""]
    """Rate of turn that the rates of the geometry make."""
    velocity: Complex
    """Velocity of the origin that they make."""


def planar_slopes(
    system: LoopSystem,
    axes: AssembledAxes,
    rows: Sequence[Float[Array, " poses"]],
    d_axes: AssembledAxes | None,
    d_inputs: Float[Array, "driven poses"],
) -> list[Float[Array, " poses"]]:
    """Compute the derivatives of all coordinates of closed poses, along derivatives of the axes and of the inputs.

    `rows` are the coordinates, radians and characteristic lengths; `d_axes` is None where the axes rest. Where the
    equations are singular, at a limit, the derivatives of the unknowns are zero. Linear in derivatives, and
    differentiable again in all else.
    """
    table, poses = chain_tables(system), d_inputs.shape[1:]
    found: dict[int, Any] = dict(zip(system.driven, d_inputs, strict=True))
    moving = [(row, chain) for chain in range(len(system.loops)) for row in moving_rows(system, chain)]
    turning = sorted({int(table.column[place]) for place in moving if table.turn[place]})
    # all in one array: a few operations of the program, not a few each; of three unknowns one turns at least
    cos, sin = cos_sin(jnp.stack([rows[column] for column in turning]))
    turns = {column: Complex(cos[n], sin[n]) for n, column in enumerate(turning)}
    for formula in group_formulas(system):
        if not isinstance(formula, GroupFormula):
            raise ValueError(f"a group has no formula: {formula}")
        chain = formula.chain
        twists = _twists(system, axes, chain, rows, turns, d_axes)
        turn, velocity = jnp.broadcast_to(twists.turn, poses), twists.velocity
        for row, screw in twists.screws.items():
            if row not in formula.rows:
                rate = axes.sense[row, chain] * found[int(table.column[row, chain])]
                turn = turn + rate if screw.turns else turn
                velocity = add(velocity, scale(rate, screw.velocity))
        rates = _closing_rates([twists.screws[row] for row in formula.rows], turn, velocity)
        for row, column, rate in zip(formula.rows, formula.columns, rates, strict=True):
            found[column] = axes.sense[row, chain] * rate
    return [found.get(column, jnp.zeros(poses)) for column in range(system.columns)]


def _twists(
    system: LoopSystem,
    axes: AssembledAxes,
    chain: int,
    rows: Sequence[Float[Array, " poses"]],
    turns: dict[int, Complex],
    d_axes: AssembledAxes | None,
) -> _Chain:
    """Compute the twists of a chain: travel along it, and note the rotation and the shift of what lies before."""
    table = chain_tables(system)
    one, zero = jnp.ones_like(rows[0]), jnp.zeros_like(rows[0])
    rotation, shift = Complex(one, zero), Complex(zero, zero)
    screws: dict[int, _Screw] = {}
    by: list[Complex] = []
    for row in moving_rows(system, chain):
        place = planar_place(system, axes, row, chain)
        column, sense = int(table.column[row, chain]), axes.sense[row, chain]
        if table.turn[row, chain]:
            cos, sin = turns[column]
            centre = add(shift, times(rotation, place))
            screws[row] = _Screw(True, Complex(centre.imag, -centre.real))
            turned = times(rotation, Complex(cos, sense * sin))
            by.append(subtract(rotation, turned))
            rotation, shift = turned, subtract(centre, times(turned, place))
        else:
            along = times(rotation, place)
            slide = sense * rows[column]
            screws[row] = _Screw(False, along)
            by.append(scale(slide, rotation))
            shift = add(shift, scale(slide, along))
    if d_axes is None:
        nothing = jnp.zeros(())
        return _Chain(screws, nothing, Complex(nothing, nothing))
    (cos, _), (sin, _) = axes.open_turn[chain]
    (d_cos, _), (d_sin, _) = d_axes.open_turn[chain]
    by.append(rotation)
    changes = [planar_place(system, d_axes, row, chain) for row in moving_rows(system, chain)]
    changes.append(Complex(*d_axes.open_shift[chain]))
    # complex products as those of real matrices: one product adds up all, and so its transpose does with the poses
    parts = jnp.stack([number for each in by for number in each])
    numbers = [jnp.stack([jnp.stack([x, -y]), jnp.stack([y, x])]) for x, y in changes]
    velocity = jnp.concatenate(numbers, axis=1) @ parts
    return _Chain(screws, cos * d_sin - sin * d_cos, Complex(velocity[0], velocity[1]))


def _closing_rates(unknowns: Sequence[_Screw], turn: Float[Array, " poses"], velocity: Complex) -> list[Number]:
    """Solve for the rates of three screws that, with a twist that is known, add up to zero.

    One of them turns at least: its rate is what turn is left, and the others move its centre.
    """
    last = max(k for k, screw in enumerate(unknowns) if screw.turns)
    pivot = unknowns[last].velocity
    first, second = (k for k in range(3) if k != last)
    one, other = (_beside(unknowns[k], pivot) for k in (first, second))
    wanted = subtract(scale(turn, pivot), velocity)
    area = cross(one, other)
    regular = area != 0
    share = jnp.where(regular, 1.0, 0.0) / jnp.where(regular, area, 1.0)
    rates = {first: cross(wanted, other) * share, second: cross(one, wanted) * share}
    left = -jnp.where(regular, turn, 0.0)
    for k, rate in tuple(rates.items()):
        left = left - rate if unknowns[k].turns else left
    rates[last] = left
    return [rates[k] for k in range(3)]


def _beside(screw: _Screw, pivot: Complex) -> Complex:
    """Compute the velocity of a screw while the pivot turns back as much."""
    return subtract(screw.velocity, pivot) if screw.turns else screw.velocity
