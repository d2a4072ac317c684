"""Forces and torques in the joints, from the balance of every part."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin._grouped import MAX_LINES
from jaxkin._guesses import Result
from jaxkin._named import Named
from jaxkin._names import counted, listed, nearest
from jaxkin.effects.angle_locks import not_determined
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
from jaxkin.effects.forces.balance import balance, group_size, solve
from jaxkin.effects.forces.changes import ORDER, Changes, changes, unmoved
from jaxkin.effects.forces.friction import with_friction
from jaxkin.effects.forces.friction_result import Friction
from jaxkin.effects.forces.given import Applied
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.moving_parts import MovingParts
from jaxkin.effects.forces.pose_groups import by_groups, on_cores
from jaxkin.effects.forces.screws import Scale, cross
from jaxkin.effects.forces.undetermined import Undetermined, undetermined
from jaxkin.effects.forces.wrenches import Loads, acting_on, loads, units_of
from jaxkin.effects.pose_axis import drive_axis, pose_names
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import Inputs, KnownDrive, KnownMotion, known_motion
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.status import is_closed_on_branch

MAX_HELD = 4
"""Coordinates without a drive that a printed result names at most: one idle freedom may show in several."""
HELD = 1e-6
"""Force that would hold a coordinate without a drive, over the largest reaction, above which a printed result names it:
far above rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class Reactions(Result):
    """What each joint transmits from part 1 to part 2 in each pose. A pytree; NaN at poses that are not closed
    (`motion.closed`).

    Along the freedoms of a joint it is what drives, joint springs and couplings transmit there, and what is `held`.
    """

    motion: Motion
    points: Mapping[str, Float[Array, "poses 3"]]
    """For each joint the origin of its last frame, on part 2: world coordinates, unit of the mechanism."""
    forces: Mapping[str, Float[Array, "poses 3"]]
    """For each joint the force on part 2, world axes, newtons."""
    torques: Mapping[str, Float[Array, "poses 3"]]
    """For each joint the torque on part 2 about its point, world axes, newton metres."""
    drives: dict[str, Float[Array, " poses"]]
    """Forces of the drives, from the same balance: those of `jk.drive_forces` where nothing is `held`."""
    held: Mapping[str, Float[Array, "poses _"]]
    """For each joint the load that would hold its coordinates without a drive, newton metres or newtons: zero to
    rounding unless a freedom that nothing drives, an idle one too, is out of balance, or a pose is singular. It is part
    of `forces` and `torques`. Of a ball without a drive they are the torques about x, y, z of the world."""
    friction: Friction | None = None
    """What friction does, which is part of `forces` and `torques`; None where no joint has any."""

    @cached_property
    def undetermined(self) -> tuple[Undetermined, ...]:
        """The joints in which the reactions do not follow from the balance of the parts, and which components.

        There the mechanism is overconstrained, and the reactions are those of least norm: as if all joints were equally
        stiff, and the parts rigid. Raises ValueError inside `jit`, `vmap` and `grad`.
        """
        return undetermined(self.motion)

    def __str__(self) -> str:
        closed = np.asarray(self.motion.closed)
        lines = [f"Reactions of {counted(len(self.forces), 'joint')} in {closed.sum()} closed poses of {len(closed)}"]
        forces = {name: np.linalg.norm(np.asarray(rows), axis=1) for name, rows in self.forces.items()}
        if not closed.any():
            return lines[0]
        unknown = [name for name, each in forces.items() if not np.isfinite(each).any()]
        if len(unknown) == len(forces):
            return f"{lines[0]}\n  unknown: a load or a rate is no finite number in any of them"
        order = sorted(set(forces).difference(unknown), key=lambda name: -float(np.nanmax(forces[name])))
        width, at = max(map(len, order[:MAX_LINES])), pose_names(self.motion)
        for name in order[:MAX_LINES]:
            torque = np.linalg.norm(np.asarray(self.torques[name]), axis=1)
            lines.append(
                f"  {name:<{width}}  force up to {np.nanmax(forces[name]):.4g} N at {at(np.nanargmax(forces[name]))}, "
                f"torque up to {np.nanmax(torque):.4g} N m at {at(np.nanargmax(torque))}"
            )
        if len(order) > MAX_LINES:
            lines.append(f"  and {len(order) - MAX_LINES} more: see .forces and .torques")
        if unknown:
            lines.append(f"  unknown in {listed(unknown)}: a load there is no finite number in any of them")
        lines += self._what_is_held(float(np.nanmax(forces[order[0]])))
        lines += [f"  {line}" for line in not_determined(self.motion, ORDER)]
        lines += [f"  {line}" for line in (self.friction.lines() if self.friction else ())]
        lines += [f"  {each}" for each in self.undetermined[:MAX_LINES]]
        return "\n".join(lines)

    def _what_is_held(self, most: float) -> list[str]:
        """Say which coordinates without a drive would have to be held, for forces up to `most`."""
        lever = float(Scale.of(self.motion.mechanism.linkage, np).size) * METRES[self.motion.mechanism.unit]
        found = []
        for name, joint in self.motion.mechanism.joints.items():
            for k, full_name in enumerate(joint.full_names):
                load = float(np.nanmax(np.abs(np.asarray(self.held[name][:, k])), initial=0.0))
                if load > HELD * most * (1.0 if is_length(joint.coordinates[k]) else lever):
                    unit = units_of(self.motion, full_name)[0]
                    found.append(f"  {full_name} has no drive: up to {load:.3g} {unit} would hold it")
        more = [f"  and {len(found) - MAX_HELD} more without a drive: see .held"] if len(found) > MAX_HELD else []
        return [*found[:MAX_HELD], *more]

    def plot(self, path: str | Path, joints: Sequence[str] | None = None, times: Any = None) -> Path:
        """Draw the size of the forces of some joints over the drive or `times`, by default of all; returns the path."""
        forces = {name: np.linalg.norm(np.asarray(rows), axis=1) for name, rows in self.forces.items()}
        for name in joints or ():
            if name not in forces:
                raise ValueError(f"there is no joint {name!r}{nearest(str(name), forces)}")
        order = list(joints or forces)
        rows, axis = np.stack([forces[name] for name in order]), drive_axis(self.motion, times)
        return draw_lines(order, rows, "force (N)", "joint reactions", Path(path), axis=axis)

    def save(self, path: str | Path) -> Path:
        """Write forces, torques and the points that these are about as comma-separated values, one row a pose; returns
        the path."""
        names, rows, length = [], [], self.motion.mechanism.unit or "m"
        for name in self.forces:
            for what, unit, values in (
                ("force", "N", self.forces),
                ("torque", "N m", self.torques),
                ("point", length, self.points),
            ):
                names += [f"{name} {what} {axis} [{unit}]" for axis in "xyz"]
                rows.append(np.asarray(values[name], float).T)
        return save_rows(names, np.concatenate(rows), Path(path))


jax.tree_util.register_dataclass(
    Reactions,
    data_fields=["motion", "points", "forces", "torques", "drives", "held", "friction"],
    meta_fields=[],
)


class _JointReactions(NamedTuple):
    """The fields of `Reactions` of these names, of all joints in the order of the linkage."""

    points: tuple[Float[Array, "poses 3"], ...]
    forces: tuple[Float[Array, "poses 3"], ...]
    torques: tuple[Float[Array, "poses 3"], ...]
    drives: Inputs
    """By full name of the driven coordinate."""
    held: tuple[Float[Array, "poses _"], ...]


def reactions(
    motion: Motion,
    masses: Masses | None = None,
    *,
    gravity: Any = STANDARD_GRAVITY,
    applied: Iterable[Applied] | Applied = (),
    rates: Mapping[str, Any] | None = None,
    accelerations: Mapping[str, Any] | None = None,
) -> Reactions:
    """Find what each joint transmits in each pose, from the balance of all parts: at rest, or in motion with `rates`.

    Arguments are those of `jk.drive_forces`. For every part that moves, six equations: what its joints transmit, what
    acts on it, and its inertia add up to zero. Where they leave reactions open, those of least norm are found, and
    `undetermined` names them; the norm takes torques about the points of the joints, over the size of the mechanism.

    Works inside `jit`, `vmap` and `grad`. Poses that are not closed (`motion.closed`) are NaN. Raises ValueError as
    `jk.drive_forces`.
    """
    acting = Acting(masses, gravity, all_applied(applied), rates, accelerations)
    check(motion, acting)
    mechanism = motion.mechanism
    drive, known = known_motion(motion)
    speeds = given_rates(motion, acting)
    linkage, numbers, result = mechanism.linkage, acting_numbers(acting), None
    if frictions := loads_and_frictions(acting.applied)[1]:
        found = _moved(drive, known, motion.inputs, speeds)
        moving, all_loads = acting_on(drive.unit, True, linkage, found, numbers)
        all_loads, result = with_friction(motion, drive, moving, all_loads, frictions)
        rows = _balanced(drive, linkage, known.status, moving, all_loads)
        if result is not None:
            rows = jax.tree.map(partial(_nan_where, result.locked), rows)._replace(points=rows.points)
    else:

        def of_poses(
            known: KnownMotion, inputs: Mapping[str, Any], speeds: tuple[Inputs, Inputs] | None, acting: ActingNumbers
        ) -> _JointReactions:
            found = _moved(drive, known, inputs, speeds)
            return _without_friction(drive, linkage, known.status, found, acting)

        rows = on_cores(of_poses, known, motion.inputs, speeds, numbers)

    def named(of_joints: Sequence[Array]) -> Named[Array]:
        return Named("joint", zip(mechanism.joints, of_joints, strict=True))

    return Reactions(
        motion, named(rows.points), named(rows.forces), named(rows.torques), rows.drives, named(rows.held), result
    )


def _moved(
    drive: KnownDrive, known: KnownMotion, inputs: Mapping[str, Any], speeds: tuple[Inputs, Inputs] | None
) -> Changes:
    """Differentiate a motion by time; at rest, without `speeds`, nothing is differentiated."""
    if speeds is None:
        return unmoved(drive, known, inputs)
    return changes(drive, known, inputs, speeds, along=False)


def _nan_where(locked: Array, rows: Array) -> Array:
    """Set the rows of the `locked` poses to NaN."""
    return jnp.where(locked.reshape(-1, *[1] * (rows.ndim - 1)), jnp.nan, rows)


@partial(whole_program, static=(0,))
def _without_friction(
    drive: KnownDrive, linkage: Linkage, status: Int[Array, " poses"], found: Changes, acting: ActingNumbers
) -> _JointReactions:
    """Compute what `_balanced` returns, by groups of poses that are placed and solved one after another."""

    def of_group(given: tuple[Int[Array, " poses"], Changes], acting: ActingNumbers) -> _JointReactions:
        status, found = given
        moving = MovingParts.of(linkage, found, chords=True)
        return _balanced(drive, linkage, status, moving, loads(linkage, drive.unit, acting, moving))

    return by_groups(of_group, (status, found), acting, group_size(linkage))


@partial(whole_program, static=(0,))
def _balanced(
    drive: KnownDrive,
    linkage: Linkage,
    status: Int[Array, " poses"],
    moving: MovingParts,
    all_loads: Loads,
) -> _JointReactions:
    """Balance all parts in each pose, and compute what joints transmit: NaN at poses that are not closed."""
    metre, closed = METRES[drive.unit], is_closed_on_branch(status)
    driven = {(joint, k): name for name, joint, k in drive.driven}
    found = balance(linkage, moving.at, moving.displacements, list(driven))
    size, middle = moving.at.scale

    def lever(joint: int, k: int) -> Any:
        """Return the load in a coordinate over that of the balance, newtons: the size in metres for angles, else 1."""
        return 1.0 if is_length(linkage.joints[joint].coordinates[k]) else size * metre

    loads = {at: load / lever(*at) for at, load in all_loads.joints.items()}
    for joint, wrench in all_loads.friction.items():
        for k, screw in enumerate(found.screws[joint]):
            loads[joint, k] = loads.get((joint, k), 0.0) + jnp.sum(wrench * screw, axis=0)
    loaded = {at: load for at, load in loads.items() if at not in driven}
    sent = solve(linkage, found, list(driven), all_loads.parts, loaded)
    drives = {}
    for (joint, k), name in driven.items():
        along = jnp.sum(sent.wrenches[joint] * found.screws[joint][k], axis=0)
        for gradient, strength in zip(found.gradients, sent.couplings, strict=True):
            along = along - strength * gradient.get((joint, k), 0.0)
        drives[name] = jnp.where(closed, (along - loads.get((joint, k), 0.0)) * lever(joint, k), jnp.nan)

    def rows(values: Array) -> Float[Array, "poses _"]:
        return jnp.where(closed, values, jnp.nan).T

    held = tuple(
        rows(jnp.stack([row * lever(joint, k) for k, row in enumerate(each)]) if len(each) else each)
        for joint, each in enumerate(sent.held)
    )
    forces = tuple(rows(wrench[3:]) for wrench in sent.wrenches)
    torques = tuple(
        rows(size * metre * (wrench[:3] - cross(arm, wrench[3:])))
        for arm, wrench in zip(found.arms, sent.wrenches, strict=True)
    )
    points = tuple((size * arm + middle[:, None]).T for arm in found.arms)
    return _JointReactions(points, forces, torques, drives, held)
