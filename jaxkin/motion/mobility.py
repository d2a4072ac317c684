"""Mobility from the rank of the closure Jacobian, beside what counting gives (Gruebler 1917, Kutzbach 1929).

Counting alone is wrong for every overconstrained mechanism; with the equations of each loop's displacement subgroup in
place of six it is right for planar and spherical ones, and still wrong for Bennett's.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from jaxkin.joints.subgroups import Subgroup
from jaxkin.motion.freedoms import LoopFreedoms
from jaxkin.motion.mechanism import Mechanism
from jaxkin.motion.spinning import spinning
from jaxkin.solve.system import EQUATIONS
from jaxkin.topology.names import listed
from jaxkin.topology.rates import independent


@dataclass(frozen=True)
class Mobility:
    """Freedoms of a mechanism at its assembled pose and beside it."""

    freedoms: int
    """Independent displacements that all loops allow together."""
    idle: tuple[str, ...]
    """Coordinates "joint.coordinate" in which a single part moves within its loops while all others rest."""
    redundant: int
    """Closure equations, six a loop, that follow from the others."""
    idle_freedoms: int
    """How many of the freedoms are of that kind."""
    spinning: tuple[str, ...]
    """Parts that only spin, such as screws and washers: all that they can do is idle. They are left at rest."""
    spins: int
    """Freedoms that belong to the parts that only spin; they are not among the idle ones."""
    counted: int
    """Coordinates less six a loop: negative or too small where equations are redundant."""
    counted_in_subgroups: int
    """Coordinates less the equations of each loop's displacement subgroup: three a planar loop, and so on."""
    subgroups: tuple[Subgroup, ...]
    """The displacement subgroup of each loop."""
    drivable: tuple[str, ...]
    """Coordinates whose displacements, given together, leave nothing but idle freedoms; one choice of several, joints
    at the fixed parts first."""

    @property
    def useful(self) -> int:
        """Freedoms that are neither idle nor those of parts that only spin."""
        return self.freedoms - self.idle_freedoms - self.spins

    @property
    def counting(self) -> str:
        """What counting gives, in words; empty where there are no loops to count."""
        if not self.subgroups:
            return ""
        text = f"counting gives {self.counted} with six equations a loop"
        if all(subgroup.dimension == EQUATIONS for subgroup in self.subgroups):
            return text
        kinds = dict.fromkeys(f"{kind.name}: {kind.dimension}" for kind in self.subgroups)
        return f"{text}, {self.counted_in_subgroups} with those of its subgroup ({', '.join(kinds)})"

    def __str__(self) -> str:
        idle = f", {self.idle_freedoms} of them idle: {listed(self.idle)}" if self.idle else ""
        freedoms = f"{self.freedoms} freedom{'' if self.freedoms == 1 else 's'}"
        if self.spinning:
            freedoms += f" ({self.spins} of them of parts that only spin: {listed(self.spinning)})"
        return f"{freedoms}{idle}, {self.redundant} redundant equation{'' if self.redundant == 1 else 's'}"


def mobility(mechanism: Mechanism) -> Mobility:
    """Freedoms from the rank of the closure Jacobian: the larger rank of the assembled pose and a closed one beside it.

    At a singular pose (a parallelogram lying flat) the rank falls without a freedom being gained.
    """
    blocks = mechanism.loop_freedoms
    spins = spinning(mechanism)
    in_loops = {joint for block in mechanism.structure.blocks for joint in block.joints}
    outside = [
        f"{joint.name}.{coordinate}"
        for index, joint in enumerate(mechanism.all_joints)
        if index not in in_loops and not spins.keys() & set(joint.parts)
        for coordinate in joint.coordinates
    ]
    kinds = tuple(found.subgroup(dict(loop)) for found in blocks for loop in found.block.loops)
    at_ends = sum(joint.freedoms for index, joint in enumerate(mechanism.all_joints) if index not in in_loops)
    coordinates = sum(joint.freedoms for joint in mechanism.all_joints)
    idle = [found.idle(spins) for found in blocks]
    return Mobility(
        freedoms=at_ends + sum(len(found.motions) for found in blocks),
        idle=tuple(
            name
            for found, motions in zip(blocks, idle, strict=True)
            for name in names(mechanism, found, moving_columns(found, motions))
        ),
        redundant=sum(EQUATIONS * len(found.block.loops) - found.rank for found in blocks),
        idle_freedoms=sum(map(len, idle)),
        spinning=tuple(spins),
        spins=sum(spin.freedoms for spin in spins.values()),
        counted=coordinates - EQUATIONS * len(kinds),
        counted_in_subgroups=coordinates - sum(kind.dimension for kind in kinds),
        subgroups=kinds,
        drivable=(
            *outside,
            *(name for found in blocks for name in names(mechanism, found, drivable(found, [], spins))),
        ),
    )


def names(mechanism: Mechanism, found: LoopFreedoms, columns: Iterable[int]) -> list[str]:
    """The full names of coordinates by their columns."""
    chosen = (found.columns[column] for column in columns)
    return [f"{mechanism.all_joints[joint].name}.{mechanism.all_joints[joint].coordinates[k]}" for joint, k in chosen]


def moving_columns(found: LoopFreedoms, motions: Float[np.ndarray, "n columns"]) -> list[int]:
    """The columns that some of the motions move."""
    return np.flatnonzero(np.abs(motions).max(axis=0, initial=0.0) > found.noise.rate).tolist()


def drivable(found: LoopFreedoms, driven: Sequence[int], spins: Collection[str]) -> list[int]:
    """Columns that can be driven besides some others, until nothing is left but idle freedoms and parts that spin."""
    idle = moving_columns(found, found.idle())
    order = [column for column in range(len(found.columns)) if column not in idle]
    order = [column for column in order if not set(spins) & set(found.ends[found.columns[column][0]])]
    order.sort(key=lambda column: found.fixed not in found.ends[found.columns[column][0]])
    return largest(found, order, driven)


def largest(found: LoopFreedoms, columns: Iterable[int], given: Sequence[int] = ()) -> list[int]:
    """Those of the columns, each in turn, that can be given besides the ones before."""
    taken: list[int] = []
    for column in columns:
        together = [*given, *taken, column]
        if independent(found.motions, together, found.noise) == len(together):
            taken.append(column)
    return taken
