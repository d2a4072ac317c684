"""Forces and torques that a drive needs, by virtual work along the derivatives of the motion."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

from jaxkin.effects.forces.acting import (
    STANDARD_GRAVITY,
    Acting,
    ActingNumbers,
    acting_numbers,
    all_applied,
    check,
    given_rates,
    loads_and_frictions,
)
from jaxkin.effects.forces.balance import tree_wrenches
from jaxkin.effects.forces.changes import Changes, by_joint, changes
from jaxkin.effects.forces.drive_result import DriveForces
from jaxkin.effects.forces.friction import with_friction
from jaxkin.effects.forces.given import Applied
from jaxkin.effects.forces.joint_screws import coordinates_of_motions
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.moving_parts import MovingParts
from jaxkin.effects.forces.pose_groups import by_groups, on_cores
from jaxkin.effects.forces.potential import CarriedWeights, potential, weights_along_tree
from jaxkin.effects.forces.screws import Wrench
from jaxkin.effects.forces.wrenches import Loads, acting_on, loads, metres_of
from jaxkin.geometry.units import METRES
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import Inputs, KnownDrive, KnownMotion, known_motion
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.status import is_closed_on_branch


def drive_forces(
    motion: Motion,
    masses: Masses | None = None,
    *,
    gravity: Any = STANDARD_GRAVITY,
    applied: Iterable[Applied] | Applied = (),
    rates: Mapping[str, Any] | None = None,
    accelerations: Mapping[str, Any] | None = None,
) -> DriveForces:
    """Find the force or torque in each driven coordinate that holds a mechanism, or moves it as prescribed.

    At rest without `rates`: along a small change of a driven coordinate its force does the work that all that acts does
    not: minus the sum over parts of wrench times twist, the twist for a unit rate of the coordinate. With `rates` and
    `accelerations` of the driven displacements (none: zero) as in `jk.accelerations`, the inertia of the parts and
    dampers act too.

    `masses` are those of `jk.masses`, None for parts without mass; `gravity` is in m/s^2, world axes; `applied` are
    made by `jk.force`, `jk.torque`, `jk.spring`, `jk.joint_spring`, `jk.joint_load` and, with rates,
    `jk.joint_friction`; other joints are without friction. Where friction locks the mechanism, forces are NaN.
    Freedoms without a drive move as the sweep moves them: the forces are right where nothing does work along them.

    Works inside `jit`, `vmap` and `grad`. Poses that are not closed (`motion.closed`) are NaN. Raises ValueError where
    nothing acts, for parts and coordinates that are not there, and for masses of another mechanism.
    """
    acting = Acting(masses, gravity, all_applied(applied), rates, accelerations)
    check(motion, acting)
    drive, known = known_motion(motion)
    speeds = given_rates(motion, acting)
    linkage, numbers = motion.mechanism.linkage, acting_numbers(acting)
    if speeds is None:  # without friction, which `check` refuses at rest
        of_parts = None if numbers.masses is None else weights_along_tree(linkage, numbers.masses)
        others = numbers._replace(masses=None)
        found = changes(drive, known, motion.inputs, None) if len(drive.loop_groups) > 1 else None
        return DriveForces(motion, *_at_rest(drive, linkage, known, motion.inputs, others, of_parts, found))
    if not (frictions := loads_and_frictions(acting.applied)[1]):

        def of_poses(
            known: KnownMotion, inputs: Mapping[str, Any], speeds: tuple[Inputs, Inputs], acting: ActingNumbers
        ) -> tuple[Inputs, Inputs]:
            found = changes(drive, known, inputs, speeds)
            return _in_motion(drive, linkage, known.status, found, speeds[0], acting)

        return DriveForces(motion, *on_cores(of_poses, known, motion.inputs, speeds, numbers))
    found = changes(drive, known, motion.inputs, speeds)
    moving, all_loads = acting_on(drive.unit, True, linkage, found, numbers)
    all_loads, result = with_friction(motion, drive, moving, all_loads, frictions)
    forces, powers = _forces(drive, linkage, known.status, moving, all_loads, speeds[0])
    if result is not None:
        forces, powers = (jax.tree.map(partial(jnp.where, result.locked, jnp.nan), each) for each in (forces, powers))
    return DriveForces(motion, forces, powers, result)


@partial(whole_program, static=(0,))
def _at_rest(
    drive: KnownDrive,
    linkage: Linkage,
    known: KnownMotion,
    inputs: Inputs,
    acting: ActingNumbers,
    of_parts: CarriedWeights | None,
    found: Changes | None,
) -> tuple[Inputs, Inputs]:
    """Compute force and power of each driven coordinate at rest, in one program, by groups of poses.

    The force of the weights `of_parts` is the derivative of their potential energy; the loads `acting` are placed in
    each pose. Derivatives by the drive, unless they are `found`, stay in the cache.
    """

    def of_group(
        given: tuple[JointDisplacements, Int[Array, " poses"], Inputs, Changes | None], acting: ActingNumbers
    ) -> Inputs:
        displacements, status, inputs, found = given
        if found is None:
            own = known._replace(displacements=displacements, status=status)
            # else XLA computes derivatives anew wherever they are used
            found = lax.optimization_barrier(changes(drive, own, inputs, None))
        forces: Inputs = dict.fromkeys(found.along, jnp.zeros(len(status)))
        if acting.applied:
            moving, all_loads = acting_on(drive.unit, False, linkage, found, acting)
            forces, _ = _forces(drive, linkage, status, moving, all_loads, None)
        if of_parts is not None:
            slopes = _slopes(partial(potential, linkage, of_parts, acting.gravity), found)
            for name, joint, index in drive.driven:
                metre = METRES[drive.unit] / metres_of(linkage.joints[joint].coordinates[index], drive.unit)
                forces[name] = forces[name] + metre * slopes[name]
        return forces

    forces = by_groups(of_group, (known.displacements, known.status, inputs, found), acting)
    closed = is_closed_on_branch(known.status)
    powers: Inputs = dict.fromkeys(forces, jnp.where(closed, 0.0, jnp.nan))
    return {name: jnp.where(closed, force, jnp.nan) for name, force in forces.items()}, powers


def _slopes(energy: Callable[[JointDisplacements], Float[Array, " poses"]], found: Changes) -> Inputs:
    """Differentiate an energy by each driven displacement."""
    if len(found.along) == 1:  # forwards nothing is kept for a way back, which takes three fifths of the time
        ((name, along),) = found.along.items()
        return {name: jax.jvp(energy, (found.displacements,), (by_joint(along, found.displacements),))[1]}
    # backwards once, for any number of drives: forwards, each of them would be as long a program
    each = jax.grad(lambda rows: jnp.sum(energy(rows)))(found.displacements)
    return {
        name: sum((each[joint][:, k] * change for (joint, k), change in along.items()), jnp.zeros(len(each[0])))
        for name, along in found.along.items()
    }


@partial(whole_program, static=(0,))
def _in_motion(
    drive: KnownDrive,
    linkage: Linkage,
    status: Int[Array, " poses"],
    found: Changes,
    rates: Inputs,
    acting: ActingNumbers,
) -> tuple[Inputs, Inputs]:
    """Compute force and power of each driven coordinate without friction, by groups of poses."""

    def of_group(given: tuple[Int[Array, " poses"], Changes, Inputs], acting: ActingNumbers) -> tuple[Inputs, Inputs]:
        status, found, rates = given
        moving = MovingParts.of(linkage, found, chords=False)
        return _forces(drive, linkage, status, moving, loads(linkage, drive.unit, acting, moving), rates)

    return by_groups(of_group, (status, found, rates), acting)


@partial(whole_program, static=(0,))
def _forces(
    drive: KnownDrive,
    linkage: Linkage,
    status: Int[Array, " poses"],
    moving: MovingParts,
    all_loads: Loads,
    rates: Inputs | None,
) -> tuple[Inputs, Inputs]:
    """Compute force and power of each driven coordinate u.

    With W_k of `_by_coordinate`, the force is the sum of dq_k/du W_k over the coordinates q_k that u moves; the dq_k/du
    are `moving.along`. `rates` are the du/dt of powers, which are zero without.
    """
    closed = is_closed_on_branch(status)
    sent = tree_wrenches(linkage, all_loads.parts, len(status))
    work = _by_coordinate(linkage, drive.unit, all_loads, moving, sent)
    forces, powers = {}, {}
    for name, joint, index in drive.driven:
        force = sum(
            (change * work[at] for at, change in moving.along[name].items() if at in work), jnp.zeros(len(status))
        )
        power = force * rates[name] if rates is not None else jnp.zeros_like(force)
        metre = metres_of(linkage.joints[joint].coordinates[index], drive.unit)
        forces[name] = jnp.where(closed, force / metre, jnp.nan)
        powers[name] = jnp.where(closed, power, jnp.nan)
    return forces, powers


def _by_coordinate(
    linkage: Linkage, unit: str, all_loads: Loads, moving: MovingParts, sent: dict[int, Wrench]
) -> dict[JointCoordinate, Float[Array, " poses"]]:
    """Compute the generalised force that balances all loads for each (joint, coordinate): joules per radian, or per
    unit of length of the mechanism.

    What acts on the parts is carried by the joints of the tree, by the wrenches `sent`.
    """
    scale, found = moving.at.scale, {}
    for sign, wrenches in ((1, sent), (-1, all_loads.friction)):
        for number, wrench in wrenches.items():
            joint = linkage.joints[number]
            units = scale.of_coordinates(joint)
            for k, twist in zip(coordinates_of_motions(joint), moving.at.joints[number].twists, strict=True):
                term = sign * scale.size * METRES[unit] / units[k] * jnp.sum(wrench * twist, axis=0)
                found[number, k] = found.get((number, k), 0.0) + term
    for (number, k), load in all_loads.joints.items():
        metre = metres_of(linkage.joints[number].coordinates[k], unit)
        found[number, k] = found.get((number, k), 0.0) - metre * load
    return found
