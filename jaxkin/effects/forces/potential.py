"""The potential energy of the weights of all parts, along the tree from the fixed parts.

The height of a point of a part against gravity g is one number, -g . (R x + t). It takes only the row (g^T R, g^T t) of
the displacement (R, t) of the part, which passes through the joints of the tree as frames do: from the fixed parts on,
each joint multiplies it by its own displacement from the right. Four numbers a part in place of twelve, and no twists:
at rest the drive forces of weights are derivatives of this sum.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.screws import Scale
from jaxkin.geometry.elementary_motions import amount, displaced_columns
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.rigid import as_rigid, inverse
from jaxkin.geometry.trig import cos_sin
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage

Row = Sequence[Float[Array, "#poses"]]
"""A row of four numbers in each pose: three in the axes of a body, and one for its origin."""


def potential(
    linkage: Linkage, scale: Scale, masses: Masses, gravity: Any, displacements: Sequence[Float[Array, "poses _"]]
) -> Float[Array, " poses"]:
    """Compute the potential energy of all weights, in newtons times the unit of the mechanism; zero at the middle."""
    fixed: Row = [*(number[None] for number in jnp.asarray(gravity, float)), jnp.zeros(1)]
    rows: dict[str, Row] = {}
    total = jnp.zeros(displacements[0].shape[0])
    for part, parent, number, sign in linkage.structure.tree:
        through = _through if sign > 0 else _back_through
        row = through(linkage.joints[number], displacements[number], scale, rows.get(parent, fixed))
        # found once: XLA would find the whole chain anew wherever it is used
        rows[part] = lax.optimization_barrier(row)
        own = masses.parts.index(part)
        centre = masses.centre[own] - scale.middle
        height = -(sum(r * x for r, x in zip(rows[part], centre, strict=False)) + rows[part][3])
        total = total + masses.mass[own] * height
    return total


def _through(joint: Joint, q: Float[Array, "poses _"], scale: Scale, row: Row) -> Row:
    """Multiply a row by the displacement of a joint."""
    for number, motions in enumerate(_motions(joint, q)):
        row = _times(row, _centred(joint.frames_1[number], scale))
        for axis, how_far in motions:
            row = displaced_columns(row, axis, *how_far)
        row = _times(row, inverse(_centred(joint.frames_2[number], scale)))
    return row


def _back_through(joint: Joint, q: Float[Array, "poses _"], scale: Scale, row: Row) -> Row:
    """Multiply a row by the inverse of the displacement of a joint."""
    for number, motions in reversed(list(enumerate(_motions(joint, q)))):
        row = _times(row, _centred(joint.frames_2[number], scale))
        for axis, (advance, turn) in reversed(motions):
            back = None if turn is None else (turn[0], -turn[1])
            row = displaced_columns(row, axis, None if advance is None else -advance, back)
        row = _times(row, inverse(_centred(joint.frames_1[number], scale)))
    return row


def _motions(joint: Joint, q: Float[Array, "poses _"]) -> list[list[tuple[int, tuple[Any, Any]]]]:
    """For each movement of a joint its elementary motions: the axis, and how far along it and about it."""
    found, first, pitch = [], 0, jnp.asarray(joint.pitch, float)
    for number, movement in enumerate(joint.movements):
        curve = joint.curves[number] if joint.curves else None
        spline = None if curve is None else curve.spline(jnp)
        count = len(MOVEMENTS[movement].coordinates)
        point = None if spline is None else spline.at(*q[:, first : first + count].T, xp=jnp)
        own = []
        for element in MOVEMENTS[movement].elements:
            own.append((element.axis, amount(element, q[:, first + element.coordinate], pitch, point, cos_sin)))
        found.append(own)
        first += count
    return found


def _centred(frame: Any, scale: Scale) -> Float[Array, "3 4 1"]:
    """A frame whose origin is counted from the middle of the mechanism: far from the world's, digits would be lost."""
    rigid = as_rigid(jnp.asarray(frame, float))
    return rigid.at[:, 3].add(-scale.middle[:, None])


def _times(row: Row, frame: Float[Array, "3 4 1"]) -> Row:
    """Multiply a row by a frame from the right."""
    found = [row[0] * frame[0, j] + row[1] * frame[1, j] + row[2] * frame[2, j] for j in range(4)]
    return [*found[:3], found[3] + row[3]]
