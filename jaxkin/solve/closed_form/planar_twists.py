"""Twists of the motions of planar loops in a pose that is known.

A planar loop stays closed while the twists of its motions add up to zero. A twist of the plane is a rate of turn w and
the velocity v of the origin, a complex number. With p for the centre of a turn and R for the rotation of what lies
before it, both in the pose, and e for the turn itself, the rates of

    the turn               w = q',   v = -i p q'
    a slide                w = 0,    v = R d q'            d its direction
    the centre of a turn   w = 0,    v = R (1 - e) c'      c in the assembled pose
    the direction          w = 0,    v = R q d'
    what is left open      w = Im(conj(m) m'), v = R t'    a turn m and a shift t

are added. What numbers of the geometry add, in many poses, is one product of matrices.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.chain_motions import moving_rows, planar_place
from jaxkin.solve.closed_form.complex_numbers import Complex, add, conj, scale, subtract, times
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.loop_system import LoopSystem


class Screw(NamedTuple):
    """The twist of a row of a chain for a rate of one, in the direction of travel."""

    turns: bool
    """Whether the rate of turn is one; else it is zero."""
    velocity: Complex


class LoopTwists(NamedTuple):
    """The twists of the motions of a loop, in its poses."""

    screws: dict[int, Screw]
    """Of each row that moves."""
    turn: Float[Array, "*#poses"]
    """Rate of turn of what is known."""
    velocity: Complex
    """Velocity of the origin of what is known."""

    def with_rates(self, rates: Mapping[int, Float[Array, " poses"]]) -> LoopTwists:
        """Add the rates of rows, in the direction of travel, to what is known."""
        turn, velocity = self.turn, self.velocity
        for row, rate in rates.items():
            turn = turn + rate if self.screws[row].turns else turn
            velocity = add(velocity, scale(rate, self.screws[row].velocity))
        return LoopTwists(self.screws, turn, velocity)


def loop_twists(
    system: LoopSystem,
    axes: AssembledAxes,
    chain: int,
    rows: Sequence[Float[Array, " poses"]],
    turns: Mapping[int, Complex],
    d_axes: AssembledAxes | None,
) -> LoopTwists:
    """Compute the twists of a closed loop: travel along it, and note the rotation and the shift of what lies before.

    `rows` are the coordinates of all columns, radians and characteristic lengths, and `turns` those that turn as
    complex numbers. What is known are the rates `d_axes` of the axes, None where these rest.
    """
    table = chain_tables(system)
    one, zero = jnp.ones_like(rows[0]), jnp.zeros_like(rows[0])
    moving = moving_rows(system, chain)
    screws: dict[int, Screw] = {}
    by: dict[int, Complex] = {}

    def travel(travelled: Iterable[int], rotation: Complex, shift: Complex, back: bool) -> None:
        for row in travelled:
            place = planar_place(system, axes, row, chain)
            column, sense = int(table.column[row, chain]), axes.sense[row, chain]
            if table.turn[row, chain]:
                turn = Complex(turns[column].real, sense * turns[column].imag)
                centre = add(shift, times(rotation, place))
                screws[row] = Screw(True, Complex(centre.imag, -centre.real))
                turned = times(rotation, conj(turn) if back else turn)
                by[row] = subtract(turned, rotation) if back else subtract(rotation, turned)
                rotation, shift = turned, subtract(centre, times(turned, place))
            else:
                along = times(rotation, place)
                screws[row] = Screw(False, along)
                by[row] = scale(sense * rows[column], rotation)
                slide = scale(sense * rows[column], along)
                shift = subtract(shift, slide) if back else add(shift, slide)

    # from both ends, which meet as the loop is closed: what lies before a motion takes half of the operations
    half = len(moving) // 2
    (cos, _), (sin, _) = axes.open_turn[chain]
    last = Complex(cos * one, -sin * one)
    travel(moving[:half], Complex(one, zero), Complex(zero, zero), back=False)
    travel(reversed(moving[half:]), last, scale(-one, times(last, Complex(*axes.open_shift[chain]))), back=True)
    if d_axes is None:
        return LoopTwists(screws, zero, Complex(zero, zero))
    (d_cos, _), (d_sin, _) = d_axes.open_turn[chain]
    changes = [planar_place(system, d_axes, row, chain) for row in moving] + [Complex(*d_axes.open_shift[chain])]
    # complex products as those of real matrices: one product adds up all, and so its transpose does with the poses
    parts = jnp.stack([number for row in moving for number in by[row]] + list(last))
    numbers = [jnp.stack([jnp.stack([x, -y]), jnp.stack([y, x])]) for x, y in changes]
    velocity = jnp.concatenate(numbers, axis=1) @ parts
    return LoopTwists(screws, (cos * d_sin - sin * d_cos) * one, Complex(velocity[0], velocity[1]))
