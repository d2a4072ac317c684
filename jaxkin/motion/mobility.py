"""Mobility from the rank of the closure Jacobian: counting alone is wrong for every overconstrained mechanism."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin.motion.mechanism import Mechanism
from jaxkin.motion.spinning import spinning
from jaxkin.motion.systems import block_joints, block_system
from jaxkin.solve.quality import jacobian_near
from jaxkin.topology.structure import Block

_STEP = 0.05
"""How far the second look is taken from the assembled pose, in radians or characteristic lengths: far enough to leave a
singular pose behind, near enough to close."""


@dataclass(frozen=True)
class Mobility:
    """Freedoms of a mechanism at its assembled pose and beside it."""

    freedoms: int
    """Independent displacements that all loops allow together."""
    idle: tuple[str, ...]
    """Coordinates "joint.coordinate" in which a single part moves within its loops while all others rest."""
    redundant: int
    """Closure equations, six a loop, that follow from the others."""
    spinning: tuple[str, ...] = ()
    """Parts that only spin, such as screws and washers: all that they can do is idle. They are left at rest."""
    spins: int = 0
    """Freedoms that belong to the parts that only spin."""

    @property
    def useful(self) -> int:
        """Freedoms that are not those of parts that only spin."""
        return self.freedoms - self.spins

    def __str__(self) -> str:
        idle = f", idle: {', '.join(self.idle)}" if self.idle else ""
        freedoms = f"{self.freedoms} freedom{'' if self.freedoms == 1 else 's'}"
        if self.spinning:
            freedoms += f" ({self.spins} of them of parts that only spin: {', '.join(self.spinning)})"
        return f"{freedoms}{idle}, {self.redundant} redundant equation{'' if self.redundant == 1 else 's'}"


_near = partial(jax.jit, static_argnums=0)(jacobian_near)


def mobility(mechanism: Mechanism) -> Mobility:
    """Freedoms from the rank of the closure Jacobian: the larger rank of the assembled pose and a closed one beside it.

    At a singular pose (a parallelogram lying flat) the rank falls without a freedom being gained.
    """
    in_loops = {joint for block in mechanism.structure.blocks for joint in block.joints}
    freedoms = sum(joint.freedoms for i, joint in enumerate(mechanism.all_joints) if i not in in_loops)
    idle: list[str] = []
    redundant = 0
    for block in mechanism.structure.blocks:
        system = block_system(mechanism, block, ())
        jacobians = np.asarray(_near(system, *block_joints(mechanism, block, jnp.zeros(0).dtype), _STEP))
        least = 1e-9 if jacobians.dtype == np.float64 else 1e-4
        decompositions = [np.linalg.svd(jacobian) for jacobian in jacobians]
        ranks = [int((values > least * values[0]).sum()) if values.size else 0 for _, values, _ in decompositions]
        best = int(np.argmax(ranks))
        motions = decompositions[best][2][ranks[best] :]
        freedoms += len(motions)
        redundant += system.equations - ranks[best]
        idle += _idle(mechanism, block, motions)
    spins = spinning(mechanism)
    idle = [name for name in idle if not spins.keys() & set(mechanism.joints[name.rpartition(".")[0]].parts)]
    return Mobility(freedoms, tuple(idle), redundant, tuple(spins), sum(spin.freedoms for spin in spins.values()))


def _idle(mechanism: Mechanism, block: Block, motions: np.ndarray) -> list[str]:
    """Coordinates of the freedoms in which only one part of the loops moves, a part that is held by several others."""
    owners = [(joint, name) for joint in block.joints for name in mechanism.all_joints[joint].coordinates]
    idle: list[str] = []
    for part in mechanism.parts:
        around = {joint for joint in block.joints if part in mechanism.all_joints[joint].parts}
        neighbours = {p for joint in around for p in mechanism.all_joints[joint].parts} - {part}
        if part in mechanism.fixed or len(neighbours) < 2:
            continue
        elsewhere = [i for i, (joint, _) in enumerate(owners) if joint not in around]
        _, values, combinations = (
            np.linalg.svd(motions[:, elsewhere].T) if elsewhere else (0, np.zeros(0), np.eye(len(motions)))
        )
        alone = combinations[int((values > 1e-6).sum()) :] @ motions
        for column, (joint, name) in enumerate(owners):
            if np.any(np.abs(alone[:, column]) > 1e-6):
                idle.append(f"{mechanism.all_joints[joint].name}.{name}")
    return list(dict.fromkeys(idle))
