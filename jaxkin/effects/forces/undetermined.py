"""Name the reactions that the balance of the parts leaves open: those of an overconstrained mechanism (host code)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from jaxkin._traced import traced
from jaxkin.effects.forces.balance import Balance, balance
from jaxkin.effects.forces.places import places
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import known_motion, some_poses
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.execution.compiler import whole_program

COMPONENTS = ("torque x", "torque y", "torque z", "force x", "force y", "force z")
MAX_POSES = 3
"""Poses at which the balance is looked at: a singular one leaves more reactions open than its neighbours."""


class _Told(NamedTuple):
    """From which sizes on numbers are told from rounding, in one precision."""

    rank: float
    """Singular value of the balance over its largest one, at which equations count as dependent: the closure of the
    pose over the sines of the angles between its axes."""
    share: float
    """Share in the open reactions, from which a component counts as open: above what rounding leaves of none."""


TOLD = {"float64": _Told(1e-9, 1e-6), "float32": _Told(1e-5, 1e-3)}
"""By the precision of the poses, which close to 1e-12 and to 1e-6. Shares of none are up to 1e-5 in float32 where
singular values are a tenth of the largest one."""


@dataclass(frozen=True)
class Undetermined:
    """A joint in which some reactions do not follow from the balance of the parts."""

    joint: str
    parts: tuple[str, str]
    components: tuple[str, ...]
    """Which ones, in the axes of the joint's last frame, whose z axis is that of a hinge or a slide: "force z"."""

    def __str__(self) -> str:
        return f"not determined in {self.joint} ({' - '.join(self.parts)}): {', '.join(self.components)}"


def undetermined(motion: Motion) -> tuple[Undetermined, ...]:
    """Find the joints whose reactions are not determined: see `Reactions.undetermined`."""
    if traced(motion):
        raise ValueError("which reactions are determined is found on the host: ask outside of jit, vmap and grad")
    closed = np.flatnonzero(np.asarray(motion.closed))
    if not len(closed):
        return ()
    chosen = closed[np.unique(np.linspace(0, len(closed) - 1, MAX_POSES + 2)[1:-1].astype(int))]
    some = some_poses(motion, chosen)
    drive, known = known_motion(some)
    driven = tuple((joint, k) for _, joint, k in drive.driven)
    system = jax.tree.map(np.asarray, _placed(driven, motion.mechanism.linkage, known.displacements))
    found = [_at(some, system, driven, pose) for pose in range(len(chosen))]
    return min(found, key=lambda each: each[0])[1]


@partial(whole_program, static=(0,))
def _placed(driven: tuple[JointCoordinate, ...], linkage: Linkage, displacements: JointDisplacements) -> Balance:
    """Place all joints in one program: each operation by itself would be compiled, too."""
    return balance(linkage, places(linkage, displacements, chords=True), displacements, driven)


def _told(system: Balance) -> _Told:
    """Return what is told from rounding in the precision in which the joints were placed."""
    return TOLD[str(system.arms[0].dtype)]


def _joint_at(system: Balance, joint: int, free: list[int], pose: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Decompose the wrenches at the point of a joint in a pose of a `Balance`.

    Returns a basis (6, n) of those that it transmits, the wrench of a unit load in each free coordinate (6, free), and
    the matrix (6, 6) that refers wrenches at the point to the middle.
    """
    x, y, z = system.arms[joint][:, pose]
    lever = np.eye(6)
    lever[:3, 3:] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    screws = lever.T @ np.stack([system.screws[joint][k][:, pose] for k in free] or [np.zeros(6)], axis=1)
    left, values, right = np.linalg.svd(screws, full_matrices=True)
    rank = int((values > _told(system).rank * values.max(initial=0.0)).sum())
    loads = left[:, :rank] / values[:rank] @ right[:rank]
    return left[:, rank:], loads, lever


def _at(
    motion: Motion, system: Balance, driven: tuple[JointCoordinate, ...], pose: int
) -> tuple[int, tuple[Undetermined, ...]]:
    """Count the open reactions at a pose of a `Balance`, and tell in which joints they are."""
    linkage = motion.mechanism.linkage
    moving = [part for part in linkage.parts if part not in linkage.fixed]
    columns, owner, bases, levers = [], [], [], []
    pulls: dict[JointCoordinate, np.ndarray] = {}
    for number, joint in enumerate(linkage.joints):
        free = [k for k in range(joint.freedoms) if (number, k) not in driven]
        basis, loads, lever = _joint_at(system, number, free, pose)
        pulls |= {(number, k): loads[:, column] for column, k in enumerate(free)}
        columns.append(_on_parts(joint.parts, moving, lever @ basis))
        owner += [number] * basis.shape[1]
        bases.append(basis)
        levers.append(lever)
    for gradient in system.gradients:
        column = np.zeros((6 * len(moving), 1))
        for (number, k), slope in gradient.items():
            if (number, k) in pulls:
                wrench = slope[pose] * levers[number] @ pulls[number, k]
                column += _on_parts(linkage.joints[number].parts, moving, wrench[:, None])
        columns.append(column)
        owner.append(-1)
    matrix = np.concatenate([np.zeros((6 * len(moving), 0)), *columns], axis=1)
    _, values, directions = np.linalg.svd(matrix, full_matrices=True)
    open_ones = directions[int((values > _told(system).rank * values.max(initial=0.0)).sum()) :]
    found = []
    for number, joint in enumerate(linkage.joints):
        wrench = bases[number] @ open_ones[:, np.array(owner, int) == number].T
        axes = (
            np.asarray(motion.transforms[joint.parts[1]], float)[pose, :3, :3] @ np.asarray(joint.frames_2[-1])[:3, :3]
        )
        own = np.concatenate([axes.T @ wrench[:3], axes.T @ wrench[3:]])
        which = np.linalg.norm(own, axis=1) > _told(system).share
        if which.any():
            names = tuple(name for name, chosen in zip(COMPONENTS, which, strict=True) if chosen)
            found.append(Undetermined(joint.name, joint.parts, names))
    return len(open_ones), tuple(found)


def _on_parts(
    parts: tuple[str, str], moving: list[str], wrenches: Float[np.ndarray, "6 _"]
) -> Float[np.ndarray, "rows _"]:
    """Write wrenches of a joint about the middle as columns of the balance of all moving parts, six rows a part."""
    rows = np.zeros((6 * len(moving), wrenches.shape[1]))
    for part, sign in zip(parts, (-1.0, 1.0), strict=True):
        if part in moving:
            first = 6 * moving.index(part)
            rows[first : first + 6] += sign * wrenches
    return rows
