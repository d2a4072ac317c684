"""How the joints move: derivatives of a motion by each driven displacement, and by time."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.mechanism.known_motion import Follow, Inputs, JointRates, KnownDrive, KnownMotion, derivatives, follow
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.topology.components import connected

ByCoordinate = dict[JointCoordinate, Float[Array, " poses"]]
"""One number a pose for each of some coordinates (joint, coordinate)."""
ORDER = 2
"""Order of the derivatives of the motion from which forces follow: the accelerations of masses."""


class Changes(NamedTuple):
    """A motion and its derivatives: for virtual work by each driven displacement, for motion by time."""

    displacements: JointDisplacements
    along: dict[str, ByCoordinate]
    """First derivatives by each driven displacement, by its name, of the coordinates that it moves: those of a robot
    move a few of many."""
    velocity: JointRates | None = None
    """None at rest."""
    acceleration: JointRates | None = None


@partial(whole_program, static=(0,))
def changes(drive: KnownDrive, known: KnownMotion, inputs: Inputs, rates: tuple[Inputs, Inputs] | None) -> Changes:
    """Differentiate a motion by each input, and where rates are given also by time.

    `rates` are first and second derivatives of the inputs. With u the one input and q what it moves, q' = dq/du u', and
    q'' is the derivative of dq/du along u', times u', plus dq/du u'': one pass yields all of them.
    """
    parts, moves = _independent(drive, known), _moved(drive)

    def along(inputs: Inputs) -> tuple[JointDisplacements, dict[str, ByCoordinate]]:
        rest = follow(drive._replace(loop_groups=()), known._replace(numbers=()))(inputs)
        here = {(joint, k): rows[:, k] for joint, rows in enumerate(rest) for k in range(rows.shape[1])}
        found = {name: {at: jnp.ones_like(inputs[name])} for name, (at, *more) in moves.items() if not more}
        for names, place in parts:
            own = {name: inputs[name] for name in names}

            def by(times: Any, own=own, place=place) -> tuple[JointDisplacements, JointRates]:
                """Evaluate, and differentiate along the inputs, each at the rate `times`."""
                ones = {name: time * jnp.ones_like(own[name]) for name, time in zip(own, times, strict=True)}
                return jax.jvp(place, (own,), (ones,))

            if len(names) == 1:  # without a further axis
                rows, change = by([1.0])
                every = [change]
            else:
                rows, stacked = jax.vmap(by, out_axes=(None, 0))(jnp.eye(len(names)))
                every = [tuple(row[k] for row in stacked) for k in range(len(names))]
            for name, change in zip(names, every, strict=True):
                found[name] = {(joint, k): change[joint][:, k] for joint, k in moves[name]}
                here |= {(joint, k): rows[joint][:, k] for joint, k in moves[name]}
        return by_joint(here, rest), {name: found[name] for name in inputs}

    if rates is None:
        return Changes(*along(inputs))
    first, second = rates
    if len(inputs) > 1:
        return Changes(*along(inputs), *derivatives(follow(drive, known), (inputs, first, second)))
    (here, each), (_, again) = jax.jvp(along, (inputs,), (first,))
    (name,) = inputs
    velocity = {at: column * first[name] for at, column in each[name].items()}
    acceleration = {at: again[name][at] * first[name] + column * second[name] for at, column in each[name].items()}
    return Changes(here, each, by_joint(velocity, here), by_joint(acceleration, here))


def _independent(drive: KnownDrive, known: KnownMotion) -> list[tuple[list[str], Follow]]:
    """Cut a motion into parts that do not depend on each other: the inputs of each, and its displacements by these.

    Inputs of one loop group belong together. Those that move no loop are left out.
    """
    ties = [(each.inputs[0], other) for each in drive.loop_groups for other in each.inputs]
    found = []
    for names in connected([name for each in drive.loop_groups for name in each.inputs], ties):
        own = [number for number, each in enumerate(drive.loop_groups) if {*names} & {*each.inputs}]
        driven = tuple(each for each in drive.driven if each[0] in names)
        part = drive._replace(driven=driven, loop_groups=tuple(drive.loop_groups[number] for number in own))
        found.append((sorted(names), follow(part, known._replace(numbers=tuple(known.numbers[n] for n in own)))))
    return found


def _moved(drive: KnownDrive) -> dict[str, list[JointCoordinate]]:
    """List the coordinates (joint, coordinate) that each driven displacement moves, itself first."""
    return {
        name: list(
            dict.fromkeys(
                [(joint, k), *(at for each in drive.loop_groups if name in each.inputs for at in each.columns)]
            )
        )
        for name, joint, k in drive.driven
    }


def by_joint(columns: ByCoordinate, like: JointDisplacements) -> tuple[Float[Array, "poses _"], ...]:
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
