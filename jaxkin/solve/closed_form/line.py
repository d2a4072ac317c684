"""The line of nodes through the assembled pose: what is known of a drive before any pose is asked for.

A full turn of an input that is an angle is one line for all ranges, so that it is computed once for a mechanism, with
NumPy. Where the geometry is traced, the line is part of the program.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closed_form.assembled_axes import Axes
from jaxkin.solve.closed_form.equations import namespace
from jaxkin.solve.closed_form.solve_groups import assembled_roots, solve_groups
from jaxkin.solve.closed_form.way import LEAST_DISCRIMINANT, way
from jaxkin.solve.system.loop_system import LoopSystem

NODES = 129
"""Inputs at which the discriminants are computed, 2.8 degrees apart on a full turn: they cost as much as 129 poses."""
CLOSED_START = 1e-9
"""Largest coordinate that the formulas give for the assembled input, radians or characteristic lengths, of loops that
are closed there: rounding, and what files were rounded to."""
LEAST_ASSEMBLED_ROOT = 0.05
"""Least absolute value of the signed root in the assembled pose (such as the sine of an elbow) of loops that changed
dimensions leave open there: nearer to zero, its sign does not tell which branch the pose is on."""

Numbers = Array | np.ndarray


class Line(NamedTuple):
    """The nodes, equally spaced, and what they say."""

    signs: Float[Numbers, "groups 1"]
    """The sign of the branch of every group."""
    begin: Float[Numbers, ""]
    """Input of the first node."""
    spacing: Float[Numbers, ""]
    """From node to node."""
    begins: Bool[Numbers, ""]
    """Whether the assembled pose is without doubt on a branch that can be followed."""
    passes: Bool[Numbers, ""]
    """Whether the motion passes the whole line."""
    limited: Bool[Numbers, ""]
    """Whether there surely is a limit on the line."""
    table: Float[Numbers, "rows intervals"]
    """What `reach` reads of each interval."""
    begun: Float[Numbers, "columns 1"]
    """Full turns of the unknowns on the line at the assembled pose, radians."""
    ended: Float[Numbers, "columns 1"]
    """The same at the assembled pose a full turn of the input later."""


def full_turn(system: LoopSystem, axes: Axes) -> Line:
    """Compute the line of an input that is an angle: from the assembled pose a full turn on."""
    xp = namespace(axes.centre)
    return _line(system, axes, xp.linspace(0.0, TURN, NODES), 0, NODES - 1)


def to_either_side(system: LoopSystem, axes: Axes, farthest: Float[Numbers, ""] | float) -> Line:
    """Compute the line as far as the input `farthest` (radians or characteristic lengths) on either side."""
    xp = namespace(axes.centre, farthest)
    nodes = xp.maximum(farthest, np.finfo(float).tiny) * np.linspace(-1.0, 1.0, NODES)
    return _line(system, axes, nodes, NODES // 2, NODES // 2)


def unknown_angles(system: LoopSystem) -> Float[np.ndarray, "columns 1"]:
    """Mark columns that are angles and not driven by 1, others by 0."""
    is_angle = [not length and column not in system.driven for column, length in enumerate(system.is_length)]
    return np.array(is_angle, float)[:, None]


def _line(system: LoopSystem, axes: Axes, nodes: Float[Numbers, " nodes"], first: int, last: int) -> Line:
    xp, angles = namespace(axes.centre, nodes), unknown_angles(system)
    roots = xp.stack([xp.ravel(root)[:1] for root in assembled_roots(system, axes)])
    signs = xp.sign(roots)
    solved = solve_groups(system, axes, list(signs), nodes[None])
    found = way(solved.x, solved.discriminant, angles, first, last)
    start = solved.x[:, first]
    is_open = xp.max(xp.abs(start)) > CLOSED_START
    clear = xp.min(xp.abs(roots)) > LEAST_ASSEMBLED_ROOT
    begins = (xp.min(solved.discriminant[:, first]) > LEAST_DISCRIMINANT) & (clear | ~is_open)
    # the line is unwrapped from its first node on
    begun, ended = (angles * TURN * xp.round((found.x[:, node] - start)[:, None] / TURN) for node in (first, last))
    return Line(signs, nodes[0], nodes[1] - nodes[0], begins, found.passes, found.limited, found.table, begun, ended)
