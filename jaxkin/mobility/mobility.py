"""Mobility from the rank of the closure Jacobian, beside what counting gives (Gruebler 1917, Kutzbach 1929).

Counting alone is wrong for every overconstrained mechanism; with the equations of each loop's displacement subgroup in
place of six it is right for planar and spherical ones, and still wrong for Bennett's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from jaxkin._names import listed
from jaxkin.joints.subgroups import Subgroup
from jaxkin.linkage.first_order import EQUATIONS, independent, without
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.idle import IdleMotion, IdleMotions
from jaxkin.mobility.loop_freedoms import LoopFreedoms, loop_freedoms
from jaxkin.mobility.open_loops import check_closed


@dataclass(frozen=True)
class Mobility:
    """Freedoms of a mechanism at its assembled pose and beside it."""

    freedoms: int
    """Independent displacements that all loops allow together."""
    idle_motions: tuple[IdleMotion, ...]
    """Passive parts that move about themselves while all others rest, one entry a freedom."""
    redundant: int
    """Closure equations, six a loop, that follow from the others."""
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
    at the fixed parts first, or at the part by which loops hang on the others."""

    @property
    def idle_freedoms(self) -> int:
        """How many of the freedoms are idle."""
        return len(self.idle_motions)

    @property
    def idle(self) -> tuple[str, ...]:
        """Coordinates "joint.coordinate" in which idle motions show: more than there are idle freedoms."""
        return tuple(dict.fromkeys(name for motion in self.idle_motions for name in motion.coordinates))

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
        idle = f", {self.idle_freedoms} of them idle: {listed(list(map(str, self.idle_motions)))}" if self.idle else ""
        freedoms = f"{self.freedoms} freedom{'' if self.freedoms == 1 else 's'}"
        if self.spinning:
            freedoms += f" ({self.spins} of them of parts that only spin: {listed(self.spinning)})"
        return f"{freedoms}{idle}, {self.redundant} redundant equation{'' if self.redundant == 1 else 's'}"


def mobility(linkage: Linkage, unit: str = "") -> Mobility:
    """Freedoms from the rank of the closure Jacobian: the larger rank of the assembled pose and a closed one beside it.

    At a singular pose (a parallelogram lying flat) the rank falls without a freedom being gained. ValueError where the
    given pose is open: see `Mechanism.close`.
    """
    check_closed(linkage, unit, "mobility", "mobility()")
    every = loop_freedoms(linkage)
    mobile = [found for found in every if len(found.motions)]
    spins = {part.name: part.freedoms for part in linkage.spinning}
    in_loops = {joint for loop_group in linkage.structure.loop_groups for joint in loop_group.joints}
    outside = [
        f"{joint.name}.{coordinate}"
        for index, joint in enumerate(linkage.joints)
        if index not in in_loops and not spins.keys() & set(joint.parts)
        for coordinate in joint.coordinates
    ]
    kinds = tuple(found.subgroup(dict(loop)) for found in every for loop in found.loop_group.loops)
    at_ends = sum(joint.freedoms for index, joint in enumerate(linkage.joints) if index not in in_loops)
    coordinates = sum(joint.freedoms for joint in linkage.joints)
    return Mobility(
        freedoms=at_ends + sum(len(found.motions) for found in every),
        idle_motions=tuple(motion for found in mobile for motion in IdleMotions(linkage, found, spins).motions),
        redundant=sum(EQUATIONS * len(found.loop_group.loops) - found.rank for found in every),
        spinning=tuple(spins),
        spins=sum(spins.values()),
        counted=coordinates - EQUATIONS * len(kinds),
        counted_in_subgroups=coordinates - sum(kind.dimension for kind in kinds),
        subgroups=kinds,
        drivable=(
            *outside,
            *(name for found in mobile for name in names(linkage, found, drivable(linkage, found, [], spins))),
        ),
    )


def names(linkage: Linkage, found: LoopFreedoms, columns: Iterable[int]) -> list[str]:
    """The full names of coordinates by their columns."""
    chosen = (found.columns[column] for column in columns)
    return [f"{linkage.joints[joint].name}.{linkage.joints[joint].coordinates[k]}" for joint, k in chosen]


def moving_columns(found: LoopFreedoms, motions: Float[np.ndarray, "n columns"]) -> list[int]:
    """The columns that some of the motions move."""
    return np.flatnonzero(np.abs(motions).max(axis=0, initial=0.0) > found.thresholds.rate).tolist()


def drivable(linkage: Linkage, found: LoopFreedoms, driven: Sequence[int], spins: Collection[str]) -> list[int]:
    """Columns that can be driven besides some others, until nothing is left but idle freedoms and parts that spin.

    Joints at the part that carries the element come first, of these hinges and slides before balls. Columns in which
    idle motions show are taken only where all others leave something: to give one may move nothing but what idles.
    """
    idle = IdleMotions(linkage, found, spins)
    order = [k for k, (joint, _) in enumerate(found.columns) if not set(spins) & set(found.ends[joint])]
    owner = [joint for joint, _ in found.columns]
    of_joint = Counter(owner)
    order.sort(key=lambda column: (idle.carrier.isdisjoint(found.ends[owner[column]]), of_joint[owner[column]]))
    showing = set(moving_columns(found, idle.rates))
    taken = independent_subset(found, [column for column in order if column not in showing], driven)
    for column in (column for column in order if column in showing):
        left = without(found.motions, [*driven, *taken], found.thresholds)
        if independent(np.concatenate([idle.rates, left]), order, found.thresholds) == len(idle.rates):
            break
        if column not in taken:
            taken += independent_subset(found, found.driven_together[column], [*driven, *taken])
    return taken


def independent_subset(found: LoopFreedoms, columns: Iterable[int], given: Sequence[int] = ()) -> list[int]:
    """Those of the columns, each in turn, that can be given besides the ones before; the angles of a ball are given
    together."""
    taken: list[int] = []
    offered = list(columns)
    for column in offered:
        group = found.driven_together[column]
        together = [*given, *taken, *group]
        if column in taken or not set(group) <= set(offered):
            continue
        if independent(found.motions, together, found.thresholds) == len(together):
            taken += group
    return taken
