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
from jaxkin.effects.forces.balance import Balance, Wrenches, balance, driven_coordinates, size_and_middle, solve
from jaxkin.effects.forces.changes import changes
from jaxkin.effects.forces.given import Applied
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.undetermined import Undetermined, undetermined
from jaxkin.effects.forces.wrenches import STANDARD_GRAVITY, Acting, Loads, check, loads, nan_unless_closed
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES
from jaxkin.mechanism.motion import Motion

MAX_LINES = 12
"""Joints that a printed result or a picture names at most: more do not fit on a screen."""
OUT_OF_BALANCE = 1e-6
"""Imbalance over the largest force, above which it is told: far above rounding, which is 1e-10 even near a dead point.
"""


@dataclass(frozen=True, eq=False)
class Reactions:
    """What each joint transmits from part 1 to part 2 in each pose. A pytree; NaN at poses that are not CLOSED.

    Along the freedoms of a joint it is what drives, joint springs and couplings transmit there, and nothing otherwise.
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
    imbalance: Float[Array, " poses"]
    """What no joint can hold, newtons (torques over the size of the mechanism): zero to rounding unless a freedom
    without a drive is out of balance, or the pose is singular."""

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
        most = max(float(np.nanmax(each)) for each in forces.values())
        if (left := float(np.nanmax(np.asarray(self.imbalance)))) > OUT_OF_BALANCE * most:
            pose = int(np.nanargmax(np.asarray(self.imbalance)))
            lines.append(
                f"  out of balance by up to {left:.3g} N, at pose {pose}: a freedom without a drive, or singular"
            )
        lines += [f"  {each}" for each in self.undetermined[:MAX_LINES]]
        return "\n".join(lines)

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
    Reactions, data_fields=["motion", "points", "forces", "torques", "drives", "imbalance"], meta_fields=[]
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
    places, wrenches, drives, imbalance = _balanced(motion, loads(motion, acting, moving))
    size = size_and_middle(motion.mechanism.linkage)[0]
    metre = METRES[motion.mechanism.unit]
    names = list(motion.mechanism.joints)
    return Reactions(
        motion,
        Named("joint", zip(names, places, strict=True)),
        Named("joint", ((name, nan_unless_closed(motion, w[:, 3:])) for name, w in zip(names, wrenches, strict=True))),
        Named(
            "joint",
            (
                (name, nan_unless_closed(motion, size * metre * w[:, :3]))
                for name, w in zip(names, wrenches, strict=True)
            ),
        ),
        {name: nan_unless_closed(motion, drives[name]) for name in motion.inputs},
        nan_unless_closed(motion, imbalance),
    )


@jax.jit
def _balanced(
    motion: Motion, acting: Loads
) -> tuple[tuple[Float[Array, "poses 3"], ...], tuple[Wrenches, ...], dict[str, Array], Float[Array, " poses"]]:
    """Points, wrenches of the joints about them, forces of the drives, and imbalance."""
    linkage, metre = motion.mechanism.linkage, METRES[motion.mechanism.unit]
    found = balance(motion)
    loaded: dict[int, Array] = {}
    for (joint, k), load in acting.joints.items():
        if k in found.pulls[joint]:
            scaled = load / _lever_arm(motion, found, joint, k)
            loaded[joint] = loaded.get(joint, 0.0) + scaled[:, None] * found.pulls[joint][k]
    wrenches, strengths, imbalance = solve(linkage, found, _wrenches(motion, found, acting, metre), loaded)
    drives = {}
    for (joint, k), name in driven_coordinates(motion).items():
        along = jnp.einsum("pi,pi->p", wrenches[joint], found.screws[joint][:, :, k])
        for gradient, strength in zip(found.gradients, strengths, strict=True):
            along = along - strength * gradient.get((joint, k), 0.0)
        drives[name] = along * _lever_arm(motion, found, joint, k) - acting.joints.get((joint, k), 0.0)
    return found.places, wrenches, drives, imbalance


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
