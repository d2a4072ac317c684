"""How the joints move: derivatives of a motion by each driven displacement, and by time."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._traced import traced
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.mechanism.known_motion import (
    Inputs,
    JointRates,
    KnownDrive,
    KnownLoopGroup,
    KnownMotion,
    derivatives,
    follow,
)
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.status import Status

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


def changes(
    drive: KnownDrive,
    known: KnownMotion,
    inputs: Mapping[str, Any],
    rates: tuple[Inputs, Inputs] | None,
    along: bool = True,
) -> Changes:
    """Differentiate a motion by each input where `along`, and by time where rates are given.

    `rates` are first and second derivatives of the inputs. Several loop groups are differentiated by a program each,
    which those of equal loops share: the legs of a robot are compiled once.
    """
    if len(drive.loop_groups) < 2:
        # those of one input by time follow from those by the input: the program is the same
        return _changes(drive, known, inputs, rates, along or (rates is not None and len(inputs) == 1))
    rows: dict[int, list[Array]] = {}
    moved: dict[str, ByCoordinate] = {}
    for some in _independent(drive, known):
        own = None if rates is None else (some.renamed(rates[0]), some.renamed(rates[1]))
        found = changes(some.drive, some.known, some.renamed(inputs), own, along)
        by_order = [each for each in (found.displacements, found.velocity, found.acceleration) if each is not None]
        rows |= {joint: [each[place] for each in by_order] for place, joint in enumerate(some.joints)}
        for number, each in found.along.items():
            moved[some.names[int(number)]] = {(some.joints[joint], k): row for (joint, k), row in each.items()}
    displacements, *by_time = (tuple(each) for each in zip(*(rows[joint] for joint in sorted(rows)), strict=True))
    return Changes(displacements, {name: moved[name] for name in inputs if name in moved}, *by_time)


@partial(whole_program, static=(0, 4))
def _changes(
    drive: KnownDrive, known: KnownMotion, inputs: Inputs, rates: tuple[Inputs, Inputs] | None, along: bool
) -> Changes:
    """Compute what `changes` returns for at most one loop group, in one program.

    With u the one input and q what it moves, q' = dq/du u', and q'' is the derivative of dq/du along u', times u', plus
    dq/du u'': one pass yields all of them.
    """
    moves, place = _moved(drive), follow(drive, known)

    def by_inputs(inputs: Inputs) -> tuple[JointDisplacements, dict[str, ByCoordinate]]:
        def by(times: Any) -> tuple[JointDisplacements, JointRates]:
            """Evaluate, and differentiate along the inputs, each at the rate `times`."""
            ones = {name: time * jnp.ones_like(own[name]) for name, time in zip(own, times, strict=True)}
            return jax.jvp(lambda own: place(inputs | own), (own,), (ones,))

        found = {name: {at: jnp.ones_like(inputs[name])} for name, (at, *more) in moves.items() if not more}
        own = {name: inputs[name] for each in drive.loop_groups for name in each.inputs}
        if not own:
            return place(inputs), found
        if len(own) == 1:  # without a further axis
            rows, change = by([1.0])
            every = [change]
        else:
            rows, stacked = jax.vmap(by, out_axes=(None, 0))(jnp.eye(len(own)))
            every = [tuple(row[k] for row in stacked) for k in range(len(own))]
        for name, change in zip(own, every, strict=True):
            found[name] = {(joint, k): change[joint][:, k] for joint, k in moves[name]}
        return rows, {name: found[name] for name in inputs}

    if rates is None:
        return Changes(*by_inputs(inputs)) if along else Changes(place(inputs), {})
    first, second = rates
    if len(inputs) != 1:
        here, each = by_inputs(inputs) if along else (place(inputs), {})
        return Changes(here, each, *derivatives(place, (inputs, first, second)))
    (here, each), (_, again) = jax.jvp(by_inputs, (inputs,), (first,))
    (name,) = inputs
    velocity = {at: column * first[name] for at, column in each[name].items()}
    acceleration = {at: again[name][at] * first[name] + column * second[name] for at, column in each[name].items()}
    return Changes(here, each, by_joint(velocity, here), by_joint(acceleration, here))


class IndependentJoints(NamedTuple):
    """Joints of a motion that move by inputs of their own, numbered from 0, as inputs are."""

    drive: KnownDrive
    known: KnownMotion
    joints: tuple[int, ...]
    """The numbers of its joints in the mechanism."""
    names: tuple[str, ...]
    """The names of its inputs."""

    def renamed(self, inputs: Mapping[str, Any]) -> Inputs:
        """Select its own inputs, named by their numbers."""
        return {str(number): inputs[name] for number, name in enumerate(self.names)}


def _independent(drive: KnownDrive, known: KnownMotion) -> list[IndependentJoints]:
    """Sort joints by what they depend on: those of each loop group, and all in none."""
    groups = [
        (tuple(sorted({joint for joint, _ in each.columns})), each, own)
        for each, own in zip(drive.loop_groups, known.numbers, strict=True)
    ]
    alone = sorted(set(range(len(drive.freedoms))).difference(*(joints for joints, *_ in groups)))
    found = []
    for joints, *loop_group in [*groups, *([(tuple(alone),)] if alone else [])]:
        number = {joint: place for place, joint in enumerate(joints)}
        driven = [each for each in drive.driven if each[1] in number]
        names = tuple(name for name, *_ in driven)
        own = known._replace(numbers=(), displacements=tuple(known.displacements[joint] for joint in joints))
        loops: tuple[KnownLoopGroup, ...] = ()
        if loop_group:
            one, numbers = loop_group
            columns = tuple((number[joint], k) for joint, k in one.columns)
            inputs = tuple(str(names.index(name)) for name in one.inputs)
            loops, own = (one._replace(columns=columns, inputs=inputs),), own._replace(numbers=(numbers,))
        places = tuple((str(place), number[joint], k) for place, (_, joint, k) in enumerate(driven))
        freedoms = tuple(drive.freedoms[joint] for joint in joints)
        found.append(IndependentJoints(KnownDrive(freedoms, places, loops, drive.unit), own, joints, names))
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


def unmoved(drive: KnownDrive, known: KnownMotion, inputs: Mapping[str, Any]) -> Changes:
    """Take the poses of a motion alone, without derivatives by inputs and time."""
    plain = not (traced((known, inputs)) or any(each.refined for each in drive.loop_groups))
    if plain and not np.any(np.asarray(known.status) == Status.NONFINITE.value):
        return Changes(known.displacements, {})
    return changes(drive, known, inputs, None, along=False)
