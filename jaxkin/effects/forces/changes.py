"""How parts and joints move: derivatives of the sweep by each driven displacement, and by time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.rates import placing, tangents_of
from jaxkin.mechanism.motion import Motion


class Change(NamedTuple):
    """A derivative of the sweep, of one order."""

    displacements: tuple[Float[Array, "poses _"], ...]
    """Of all joints, in the order of `mechanism.joints`: radians, or the unit of the mechanism."""
    transforms: Float[Array, "poses parts 3 4"]
    """Of the displacement matrices of all parts, in the order of `mechanism.parts`."""


class Changes(NamedTuple):
    """Derivatives of the sweep: for virtual work by each driven displacement, for motion by time."""

    along: dict[str, Change]
    """First derivatives by each driven displacement, by its name."""
    inputs: dict[str, Float[Array, " poses"]] | None = None
    """The given rates, by name; None at rest."""
    velocity: Change | None = None
    acceleration: Change | None = None


def changes(motion: Motion, rates: Mapping[str, Any] | None, accelerations: Mapping[str, Any] | None) -> Changes:
    """Differentiate the sweep by each input, and where rates are given also by time; ValueError as `jk.accelerations`.

    With u_i the inputs and T what they place, T' = sum of dT/du_i u_i', and T'' is the derivative of all dT/du_i along
    the rates, times u_i', plus dT/du_i u_i''. So one pass yields all of them.
    """
    place = placing(motion, None)
    names = list(motion.inputs)

    def placed(inputs: dict[str, Array]) -> Change:
        displacements, transforms = place(inputs)
        return Change(displacements, jnp.stack([each[:, :3] for each in transforms], axis=1))

    def along(inputs: dict[str, Array]) -> dict[str, Change]:
        def by(chosen: Any) -> Change:
            ones = {name: chosen[k] * jnp.ones_like(inputs[name]) for k, name in enumerate(names)}
            return jax.jvp(placed, (inputs,), (ones,))[1]

        if len(names) == 1:
            return {names[0]: by((1.0,))}
        every = jax.vmap(by)(jnp.eye(len(names)))
        return {name: jax.tree.map(lambda rows, k=k: rows[k], every) for k, name in enumerate(names)}

    if rates is None:
        return Changes(along(motion.inputs))
    first, second = tangents_of(motion, rates), tangents_of(motion, accelerations or {})
    each, again = jax.jvp(along, (motion.inputs,), (first,))
    velocity = [jax.tree.map(lambda rows, name=name: _times(rows, first[name]), each[name]) for name in names]
    bent = [jax.tree.map(lambda rows, name=name: _times(rows, first[name]), again[name]) for name in names]
    pushed = [jax.tree.map(lambda rows, name=name: _times(rows, second[name]), each[name]) for name in names]
    return Changes(each, first, _sum(velocity), _sum(bent + pushed))


def _times(rows: Array, factors: Float[Array, " poses"]) -> Array:
    return rows * factors.reshape(len(factors), *[1] * (rows.ndim - 1))


def _sum(every: list[Change]) -> Change:
    return jax.tree.map(lambda *rows: sum(rows[1:], rows[0]), *every)
