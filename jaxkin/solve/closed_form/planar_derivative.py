"""Derivatives of planar loops by the screws of a pose that is known, and not by the operations of its formula.

The twists of the motions of a loop add up to zero (`planar_twists`). Of a dyad the three unknown rates of its loop are
the solution of three linear equations, in cross products. That takes a tenth of the operations of the derivative of the
formula, which has as many poses to add up for each number of the geometry. Rates of groups of loops that have no
formula, or in poses that may be singular, are found with least norm (`planar_least_norm`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.geometry.trig import cos_sin
from jaxkin.linkage.first_order import IN_SUBGROUP
from jaxkin.solve.closed_form.arithmetic import Number
from jaxkin.solve.closed_form.assembled_axes import AssembledAxes
from jaxkin.solve.closed_form.chain_motions import moving_rows
from jaxkin.solve.closed_form.complex_numbers import Complex, cross, scale, subtract
from jaxkin.solve.closed_form.group_formulas import GroupFormula, group_formulas
from jaxkin.solve.closed_form.planar_least_norm import least_norm_rates
from jaxkin.solve.closed_form.planar_twists import LoopTwists, Screw, loop_twists
from jaxkin.solve.system.chain_tables import chain_tables
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem


def has_planar_slopes(system: LoopSystem) -> bool:
    """Tell whether `planar_slopes` serves a system: loops in one plane, each coordinate one turn or slide of a loop."""
    if not system.planar or system.couplings or system.curves:
        return False
    table = chain_tables(system)
    travelled = [
        [int(table.column[row, loop]) for row in moving_rows(system, loop)] for loop in range(len(system.loops))
    ]
    return all(len(columns) == len(set(columns)) for columns in travelled)


def planar_slopes(
    system: LoopSystem,
    axes: AssembledAxes,
    rows: Sequence[Float[Array, " poses"]],
    d_axes: AssembledAxes | None,
    d_inputs: Float[Array, "driven poses"],
    *,
    turns: Mapping[int, Complex] | None = None,
    regular: bool = True,
) -> list[Float[Array, " poses"]]:
    """Compute the derivatives of all coordinates of closed poses, along derivatives of the axes and of the inputs.

    `rows` are the coordinates, radians and characteristic lengths, `turns` those of columns that turn as complex
    numbers, where they are known; `d_axes` is None where the axes rest. In `regular` poses groups with a formula have
    its derivatives, which are zero at a limit, where the equations are singular. All others have those of least norm.
    Linear in derivatives, and differentiable again in all else.
    """
    table, poses = chain_tables(system), d_inputs.shape[1:]
    found: dict[int, Any] = dict(zip(system.driven, d_inputs, strict=True))
    moving = [(row, chain) for chain in range(len(system.loops)) for row in moving_rows(system, chain)]
    turning = sorted({int(table.column[place]) for place in moving if table.turn[place]})
    if turns is None and turning:  # all in one array: a few operations of the program, not a few each
        cos, sin = cos_sin(jnp.stack([rows[column] for column in turning]))
        turns = {column: Complex(cos[n], sin[n]) for n, column in enumerate(turning)}
    turns = turns or {}
    for block, formula in zip(equation_blocks(system), group_formulas(system), strict=True):
        loops: dict[int, LoopTwists] = {}
        for chain in sorted({row // IN_SUBGROUP for row in block.rows}):
            twists = loop_twists(system, axes, chain, rows, turns, d_axes)
            columns = {row: int(table.column[row, chain]) for row in twists.screws}
            known = {row: column for row, column in columns.items() if column not in block.columns}
            loops[chain] = twists.with_rates({row: axes.sense[row, chain] * found[at] for row, at in known.items()})
        if regular and isinstance(formula, GroupFormula):
            chain = formula.chain
            rates = _closing_rates(formula, loops[chain])
            found |= {
                column: axes.sense[row, chain] * rate
                for row, column, rate in zip(formula.rows, formula.columns, rates, strict=True)
            }
        else:
            found |= least_norm_rates(system, axes, block.columns, loops)
    return [found.get(column, jnp.zeros(poses)) for column in range(system.columns)]


def _closing_rates(formula: GroupFormula, loop: LoopTwists) -> list[Number]:
    """Solve for the rates of three screws that, with a twist that is known, add up to zero.

    One of them turns at least: its rate is what turn is left, and the others move its centre.
    """
    unknowns, turn = [loop.screws[row] for row in formula.rows], loop.turn
    last = max(k for k, screw in enumerate(unknowns) if screw.turns)
    pivot = unknowns[last].velocity
    first, second = (k for k in range(3) if k != last)
    one, other = (_beside(unknowns[k], pivot) for k in (first, second))
    wanted = subtract(scale(turn, pivot), loop.velocity)
    area = cross(one, other)
    regular = area != 0
    share = jnp.where(regular, 1.0, 0.0) / jnp.where(regular, area, 1.0)
    rates = {first: cross(wanted, other) * share, second: cross(one, wanted) * share}
    left = -jnp.where(regular, turn, 0.0)
    for k, rate in tuple(rates.items()):
        left = left - rate if unknowns[k].turns else left
    rates[last] = left
    return [rates[k] for k in range(3)]


def _beside(screw: Screw, pivot: Complex) -> Complex:
    """Compute the velocity of a screw while the pivot turns back as much."""
    return subtract(screw.velocity, pivot) if screw.turns else screw.velocity
