"""How the joints move: derivatives of a motion by each driven displacement, and by time."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.mechanism.known_motion import Inputs, KnownDrive, KnownMotion, derivatives, follow
from jaxkin.solve.execution.compiler import whole_program

Rows = tuple[Float[Array, "poses _"], ...]
"""Of all joints, in the order of `mechanism.joints`: radians, or the unit of the mechanism."""


class Changes(NamedTuple):
    """A motion and its derivatives: for virtual work by each driven displacement, for motion by time."""

    displacements: Rows
    along: dict[str, Rows]
    """First derivatives by each driven displacement, by its name."""
    velocity: Rows | None = None
    """None at rest."""
    acceleration: Rows | None = None


@partial(whole_program, static=(0,))
def changes(drive: KnownDrive, known: KnownMotion, inputs: Inputs, rates: tuple[Inputs, Inputs] | None) -> Changes:
    """Differentiate a motion by each input, and where rates are given also by time.

    `rates` are first and second derivatives of the inputs. With u the one input and q what it moves, q' = dq/du u', and
    q'' is the derivative of dq/du along u', times u', plus dq/du u'': one pass yields all of them.
    """
    names, place = list(inputs), follow(drive, known)

    def along(inputs: Inputs) -> tuple[Rows, dict[str, Rows]]:
        def by(chosen: Any) -> tuple[Rows, Rows]:
            ones = {name: chosen[k] * jnp.ones_like(inputs[name]) for k, name in enumerate(names)}
            return jax.jvp(place, (inputs,), (ones,))

        if len(names) == 1:
            here, change = by((1.0,))
            return here, {names[0]: change}
        every = jax.vmap(lambda chosen: by(chosen)[1])(jnp.eye(len(names)))
        return place(inputs), {name: tuple(rows[k] for rows in every) for k, name in enumerate(names)}

    if rates is None:
        return Changes(*along(inputs))
    first, second = rates
    if len(names) > 1:
        return Changes(*along(inputs), *derivatives(place, (inputs, first, second)))
    (here, each), (_, again) = jax.jvp(along, (inputs,), (first,))
    (name,) = names
    once, twice = first[name][:, None], second[name][:, None]
    velocity = tuple(rows * once for rows in each[name])
    bent = tuple(rows * once + own * twice for rows, own in zip(again[name], each[name], strict=True))
    return Changes(here, each, velocity, bent)


@partial(whole_program, static=(0,))
def unmoved(drive: KnownDrive, known: KnownMotion, inputs: Inputs) -> Changes:
    """Take the poses of a motion alone, without derivatives by inputs and time."""
    return Changes(follow(drive, known)(inputs), {})
