"""How the joints move: derivatives of a motion by each driven displacement, and by time."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.mechanism.known_motion import Inputs, KnownDrive, KnownMotion, derivatives, follow
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.topology.components import connected

Rows = tuple[Float[Array, "poses _"], ...]
"""Of all joints, in the order of `mechanism.joints`: radians, or the unit of the mechanism."""
Columns = dict[tuple[int, int], Float[Array, " poses"]]
"""By (joint, coordinate), of some coordinates."""


class Changes(NamedTuple):
    """A motion and its derivatives: for virtual work by each driven displacement, for motion by time."""

    displacements: Rows
    along: dict[str, Columns]
    """First derivatives by each driven displacement, by its name, of the coordinates that it moves: those of a robot
    move a few of many."""
    velocity: Rows | None = None
    """None at rest."""
    acceleration: Rows | None = None


@partial(whole_program, static=(0,))
def changes(drive: KnownDrive, known: KnownMotion, inputs: Inputs, rates: tuple[Inputs, Inputs] | None) -> Changes:
    """Differentiate a motion by each input, and where rates are given also by time.

    `rates` are first and second derivatives of the inputs. With u the one input and q what it moves, q' = dq/du u', and
    q'' is the derivative of dq/du along u', times u', plus dq/du u'': one pass yields all of them.
    """
    place, moves = follow(drive, known), _moved(drive)

    def along(inputs: Inputs) -> tuple[Rows, dict[str, Columns]]:
        def by(chosen: dict[str, Any]) -> tuple[Rows, Rows]:
            """The derivative by those of `chosen`, each so many times."""
            own = {name: inputs[name] for name in chosen}
            ones = {name: times * jnp.ones_like(inputs[name]) for name, times in chosen.items()}
            return jax.jvp(lambda own: place(inputs | own), (own,), (ones,))

        def columns(name: str, rows: Rows) -> Columns:
            return {(joint, k): rows[joint][:, k] for joint, k in moves[name]}

        if len(inputs) == 1:
            (name,) = inputs
            here, change = by({name: 1.0})
            return here, {name: columns(name, change)}
        found = {name: {at: jnp.ones_like(inputs[name])} for name, (at, *more) in moves.items() if not more}
        ties = [(each.inputs[0], other) for each in drive.loop_groups for other in each.inputs[1:]]
        for group in connected([name for name in inputs if name not in found], ties):
            names = sorted(group)
            every = jax.vmap(lambda chosen, names=names: by(dict(zip(names, chosen, strict=True)))[1])(
                jnp.eye(len(names))
            )
            found |= {name: columns(name, tuple(rows[k] for rows in every)) for k, name in enumerate(names)}
        return place(inputs), {name: found[name] for name in inputs}

    if rates is None:
        return Changes(*along(inputs))
    first, second = rates
    if len(inputs) > 1:
        return Changes(*along(inputs), *derivatives(place, (inputs, first, second)))
    (here, each), (_, again) = jax.jvp(along, (inputs,), (first,))
    (name,) = inputs
    velocity = {at: column * first[name] for at, column in each[name].items()}
    bent = {at: again[name][at] * first[name] + column * second[name] for at, column in each[name].items()}
    return Changes(here, each, _rows(velocity, here), _rows(bent, here))


def _moved(drive: KnownDrive) -> dict[str, list[tuple[int, int]]]:
    """List the coordinates (joint, coordinate) that each driven displacement moves, itself first."""
    return {
        name: list(
            dict.fromkeys(
                [(joint, k), *(at for each in drive.loop_groups if name in each.inputs for at in each.columns)]
            )
        )
        for name, joint, k in drive.driven
    }


def _rows(columns: Columns, like: Rows) -> Rows:
    """Put columns together by joint; zero of the coordinates that have none."""
    return tuple(
        jnp.stack([columns.get((joint, k), jnp.zeros_like(rows[:, 0])) for k in range(rows.shape[1])], axis=1)
        if rows.shape[1]
        else rows
        for joint, rows in enumerate(like)
    )


@partial(whole_program, static=(0,))
def unmoved(drive: KnownDrive, known: KnownMotion, inputs: Inputs) -> Changes:
    """Take the poses of a motion alone, without derivatives by inputs and time."""
    return Changes(follow(drive, known)(inputs), {})
