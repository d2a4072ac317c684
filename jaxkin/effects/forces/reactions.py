"""Forces and torques in the joints, from the balance of every part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._named import Named
from jaxkin._names import nearest
from jaxkin.effects.forces.balance import Balance, balance, driven_coordinates, size_and_middle, solve
from jaxkin.effects.forces.changes import changes
from jaxkin.effects.forces.given import Applied
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.undetermined import Undetermined, undetermined
from jaxkin.effects.forces.wrenches import STANDARD_GRAVITY, Acting, Loads, check, loads, nan_unless_closed, units_of
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES
from jaxkin.mechanism.motion import Motion

MAX_LINES = 12
"""Joints that a printed result or a picture names at most: more do not fit on a screen."""
MAX_HELD = 4
"""Coordinates without a drive that a printed result names at most: one idle freedom may show in several."""
HELD = 1e-6
"""Force that holds a freedom, over the largest force, above which it is told: far above rounding."""


@dataclass(frozen=True, eq=False)
class Reactions:
    """What each joint transmits from part 1 to part 2 in each pose. A pytree; NaN at poses that are not CLOSED.

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
    """Forces of the drives, as those of `jk.drive_forces`, found from the same balance."""
    held: Mapping[str, Float[Array, "poses _"]]
    """For each joint the load that would hold its coordinates without a drive, newton metres or newtons: zero to
    rounding unless a freedom that nothing drives, an idle one too, is out of balance, or a pose is singular. It is part
    of `forces` and `torques`. Of a ball without a drive they are the torques about x, y, z of the world."""

    @cached_property
    def undetermined(self) -> tuple[Undetermined, ...]:
        """The joints in which the reactions do not follow from the balance of the parts, and which components.

        There the mechanism is overconstrained, and the reactions are those of least norm: as if all joints were equally
        stiff, and the parts rigid. Raises ValueError inside `jit`, `vmap` and `grad`.
        """
        return undetermined(self.motion)

    def __str__(self) -> str:
        closed = np.asarray(self.motion.closed)
        lines = [f"Reactions of {len(self.forces)} joints in {closed.sum()} closed poses of {len(closed)}"]
        if not closed.any():
            return lines[0]
        forces = {name: np.linalg.norm(np.asarray(rows), axis=1) for name, rows in self.forces.items()}
        order = sorted(forces, key=lambda name: -float(np.nanmax(forces[name])))
        width = max(map(len, order[:MAX_LINES]))
        for name in order[:MAX_LINES]:
            torque = np.linalg.norm(np.asarray(self.torques[name]), axis=1)
            lines.append(
                f"  {name:<{width}}  force up to {np.nanmax(forces[name]):.4g} N at pose {np.nanargmax(forces[name])}, "
                f"torque up to {np.nanmax(torque):.4g} N m at pose {np.nanargmax(torque)}"
            )
        if len(order) > MAX_LINES:
            lines.append(f"  and {len(order) - MAX_LINES} more: see .forces and .torques")
        lines += self._what_is_held(max(float(np.nanmax(each)) for each in forces.values()))
        lines += [f"  {each}" for each in self.undetermined[:MAX_LINES]]
        return "\n".join(lines)

    def _what_is_held(self, most: float) -> list[str]:
        """Say which coordinates without a drive would have to be held, for forces up to `most`."""
        lever = float(size_and_middle(self.motion.mechanism.linkage)[0]) * METRES[self.motion.mechanism.unit]
        found = []
        for name, joint in self.motion.mechanism.joints.items():
            for k, own in enumerate(joint.coordinates):
                load = np.abs(np.asarray(self.held[name][:, k]))
                if np.nanmax(load) > HELD * most * (1.0 if is_length(own) else lever):
                    unit = units_of(self.motion, f"{name}.{own}")[0]
                    found.append(f"  {name}.{own} has no drive: up to {np.nanmax(load):.3g} {unit} would hold it")
        more = [f"  and {len(found) - MAX_HELD} more without a drive: see .held"] if len(found) > MAX_HELD else []
        return [*found[:MAX_HELD], *more]

    def plot(self, path: str | Path, joints: Sequence[str] | None = None) -> Path:
        """Draw the size of the forces of some joints, by default of the most loaded ones; returns the path."""
        forces = {name: np.linalg.norm(np.asarray(rows), axis=1) for name, rows in self.forces.items()}
        for name in joints or ():
            if name not in forces:
                raise ValueError(f"there is no joint {name!r}{nearest(str(name), forces)}")
        order = list(joints or sorted(forces, key=lambda name: -np.nan_to_num(forces[name]).max())[:MAX_LINES])
        return draw_lines(order, np.stack([forces[name] for name in order]), "force (N)", "joint reactions", Path(path))

    def save(self, path: str | Path) -> Path:
        """Write forces and torques as comma-separated values, one row a pose; returns the path."""
        names, rows = [], []
        for name in self.forces:
            for what, unit, values in (("force", "N", self.forces), ("torque", "N m", self.torques)):
                names += [f"{name} {what} {axis} [{unit}]" for axis in "xyz"]
                rows.append(np.asarray(values[name], float).T)
        return save_rows(names, np.concatenate(rows), Path(path))


jax.tree_util.register_dataclass(
    Reactions, data_fields=["motion", "points", "forces", "torques", "drives", "held"], meta_fields=[]
)


def reactions(
    motion: Motion,
    masses: Masses | None = None,
    *,
    gravity: Any = STANDARD_GRAVITY,
    applied: Sequence[Applied] | Applied = (),
    rates: Mapping[str, Any] | None = None,
    accelerations: Mapping[str, Any] | None = None,
) -> Reactions:
    """Find what each joint transmits in each pose, from the balance of all parts: at rest, or in motion with `rates`.

    Arguments are those of `jk.drive_forces`. For every part that moves, six equations: what its joints transmit, what
    acts on it, and its inertia add up to zero. Where they leave reactions open, those of least norm are found, and
    `undetermined` names them; the norm takes torques about the points of the joints, over the size of the mechanism.

    Works inside `jit`, `vmap` and `grad`. Poses that are not CLOSED are NaN. Raises ValueError as `jk.drive_forces`.
    """
    acting = Acting(masses, gravity, applied, rates, accelerations)
    check(motion, acting)
    moving = None if rates is None else changes(motion, rates, accelerations)
    places, forces, torques, drives, held = _balanced(motion, loads(motion, acting, moving))
    joints = list(motion.mechanism.joints)

    def named(rows: Sequence[Array], known: bool = False) -> Named[Array]:
        return Named("joint", zip(joints, rows if known else (nan_unless_closed(motion, x) for x in rows), strict=True))

    drives = {name: nan_unless_closed(motion, drives[name]) for name in motion.inputs}
    return Reactions(motion, named(places, known=True), named(forces), named(torques), drives, named(held))


Rows = tuple[Float[Array, "poses _"], ...]


@jax.jit
def _balanced(motion: Motion, acting: Loads) -> tuple[Rows, Rows, Rows, dict[str, Float[Array, " poses"]], Rows]:
    """Points of the joints, forces, torques about the points, forces of the drives, and what holds the rest."""
    linkage, metre = motion.mechanism.linkage, METRES[motion.mechanism.unit]
    found = balance(motion)
    loaded: dict[int, Array] = {}
    for (joint, k), load in acting.joints.items():
        if k in found.pulls[joint]:
            scaled = load / _lever_arm(motion, found, joint, k)
            loaded[joint] = loaded.get(joint, 0.0) + scaled[:, None] * found.pulls[joint][k]
    sent = solve(linkage, found, _wrenches(motion, found, acting, metre), loaded)
    driven = driven_coordinates(motion)
    drives = {}
    for (joint, k), name in driven.items():
        along = jnp.einsum("pi,pi->p", sent.wrenches[joint], found.screws[joint][:, :, k])
        for gradient, strength in zip(found.gradients, sent.couplings, strict=True):
            along = along - strength * gradient.get((joint, k), 0.0)
        drives[name] = along * _lever_arm(motion, found, joint, k) - acting.joints.get((joint, k), 0.0)
    held = []
    for joint, (wrench, screws) in enumerate(zip(sent.held, found.screws, strict=True)):
        arms = [0.0 if (joint, k) in driven else _lever_arm(motion, found, joint, k) for k in range(screws.shape[2])]
        held.append(jnp.einsum("pi,pik->pk", wrench, screws) * jnp.asarray(arms))
    forces = tuple(wrench[:, 3:] for wrench in sent.wrenches)
    torques = tuple(found.size * metre * wrench[:, :3] for wrench in sent.wrenches)
    return found.places, forces, torques, drives, tuple(held)


def _lever_arm(motion: Motion, found: Balance, joint: int, k: int) -> Any:
    """Metres by which a force of the balance makes the load in a coordinate: the size for angles, 1 for lengths."""
    own = motion.mechanism.all_joints[joint]
    if is_length(own.coordinates[k]):
        return 1.0
    return found.size * METRES[motion.mechanism.unit]


def _wrenches(motion: Motion, found: Balance, acting: Loads, metre: float) -> Float[Array, "poses parts 6"]:
    """What acts on each part about the middle of the mechanism: torque over size, force.

    With the matrix C of `wrenches` and the displacement (R, t) of the part, force and torque about the origin are
    F = C_4 / metre and the vector of C R^T - R C^T, plus t cross C_4.
    """
    middle = size_and_middle(motion.mechanism.linkage)[1]
    place = jnp.stack([motion.transforms[part][:, :3] for part in motion.mechanism.parts], axis=1)
    turning = jnp.einsum("npij,npkj->npik", acting.works[..., :3], place[..., :3])
    skew = jnp.stack(
        [
            turning[..., 2, 1] - turning[..., 1, 2],
            turning[..., 0, 2] - turning[..., 2, 0],
            turning[..., 1, 0] - turning[..., 0, 1],
        ],
        axis=-1,
    )
    torque = skew + jnp.cross(place[..., 3] - middle, acting.works[..., 3])
    return jnp.concatenate([torque / found.size, acting.works[..., 3]], axis=-1) / metre
