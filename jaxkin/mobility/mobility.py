"""Compute the mobility from the rank of the closure Jacobian, and by counting (Gruebler 1917, Kutzbach 1929).

Counting six equations a loop is wrong for every overconstrained mechanism. Counting the equations of each loop's
displacement subgroup is right for planar and spherical mechanisms, and still wrong for Bennett's linkage.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import check_known
from jaxkin._guesses import Result
from jaxkin._memory import once_for_each
from jaxkin._names import counted, listed
from jaxkin.joints.subgroups import Subgroup
from jaxkin.linkage.first_order import EQUATIONS, independent, without
from jaxkin.linkage.linkage import Linkage
from jaxkin.mobility.idle import IdleMotion, IdleMotions
from jaxkin.mobility.loop_freedoms import LoopFreedoms, loop_freedoms
from jaxkin.mobility.open_loops import check_assembles

_LETTERS = 80
"""Letters of idle motions that stand in the line on mobility: of more, each has a line of its own below."""
SHARE = 0.3
"""Rate that a coordinate proposed as a drive adds to those before it, over the largest that any adds, at least. Of 60
random loops of one to four freedoms, 26 had sets of drives in which some motion of unit norm has rates below 0.1; with
this share 1 has. A larger share gives up joints at the fixed parts for little: half of the sets change with this one,
three quarters with 0.5."""
_MOST_IDLE = 8
"""Idle motions that are named at most."""


@dataclass(frozen=True, repr=False)
class Mobility(Result):
    """Freedoms of a mechanism at its assembled pose and beside it."""

    freedoms: int
    """Independent displacements that all loops allow together."""
    idle_motions: tuple[IdleMotion, ...]
    """The idle freedoms, one entry each: passive parts that move about themselves while all others rest."""
    redundant: int
    """Closure equations, six a loop and one a coupling, that follow from the others."""
    spinning: tuple[str, ...]
    """Parts that only spin, such as screws and washers: all their freedoms are idle, and they are left at rest."""
    spins: int
    """Number of freedoms of the parts in `spinning`; these are not among `idle_motions`."""
    counted: int
    """Coordinates less six a loop and one a coupling: negative or too small where equations are redundant."""
    counted_in_subgroups: int
    """Coordinates less the equations of each loop's displacement subgroup, three a planar loop and so on, and of the
    couplings."""
    subgroups: tuple[Subgroup, ...]
    """The displacement subgroup of each loop."""
    drivable: tuple[str, ...]
    """Coordinates that, driven together, leave only idle freedoms. Of several choices this one prefers joints at the
    fixed parts, or at the part that connects the loops to the fixed parts, unless others move far more."""

    @property
    def idle_freedoms(self) -> int:
        """Number of idle freedoms."""
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
        """The results of counting in words; empty where there are no loops."""
        if not self.subgroups:
            return ""
        text = f"counting gives {self.counted} with six equations a loop"
        if all(subgroup.dimension == EQUATIONS for subgroup in self.subgroups):
            return text
        kinds = dict.fromkeys(f"{kind.name}: {kind.dimension}" for kind in self.subgroups)
        return f"{text}, {self.counted_in_subgroups} with those of its subgroup ({', '.join(kinds)})"

    def __str__(self) -> str:
        told = list(map(str, self.idle_motions))
        inline = len(told) == 1 or len(", ".join(told)) <= _LETTERS
        idle = f", {self.idle_freedoms} of them idle{f': {listed(told)}' if inline else ''}" if told else ""
        below = [] if inline else [f"  idle: {each}" for each in told[:_MOST_IDLE]]
        freedoms = counted(self.freedoms, "freedom")
        if self.spinning:
            only = "only spin" if self.spins == len(self.spinning) else "only turn or slide by themselves"
            freedoms += f" ({self.spins} of them of parts that {only}: {listed(self.spinning)})"
        if not inline and len(told) > _MOST_IDLE:
            below.append(f"  and {len(told) - _MOST_IDLE} more: see .idle_motions")
        return "\n".join([f"{freedoms}{idle}, {counted(self.redundant, 'redundant equation')}", *below])


def mobility(linkage: Linkage, unit: str = "") -> Mobility:
    """Compute the mobility from the rank of the closure Jacobian at the assembled pose and at a closed pose beside it.

    The larger of the two ranks counts: at a singular pose (a parallelogram lying flat) the rank is lower although the
    mechanism has no further freedom. Where the assembled pose is open, as after a change of lengths, it is that of the
    pose in which the loops close from there. `unit` is the name of the unit of length, for messages. Raises ValueError
    where they cannot be closed: see `Mechanism.close`, and inside `jit`, `vmap` and `grad`.
    """
    check_known("freedoms", "mobility()", linkage)
    check_assembles(linkage, unit, "mobility", "{}.mobility()")
    return _of_closed(linkage)


def outside_loops(linkage: Linkage) -> list[str]:
    """Name the coordinates of joints outside of loops, "joint.coordinate", without those of parts that only spin."""
    spinning, in_loops = {part.name for part in linkage.spinning}, joints_in_loops(linkage)
    return [
        name
        for index, joint in enumerate(linkage.joints)
        if index not in in_loops and not spinning & {*joint.parts}
        for name in joint.full_names
    ]


def moving_coordinates(linkage: Linkage) -> set[str]:
    """Name the coordinates, "joint.coordinate", in which more moves than idle parts."""
    in_loops, found = joints_in_loops(linkage), set[str]()
    for each in loop_freedoms(linkage):
        found |= {*names(linkage, each, moving_columns(each, each.motions))}
    outside = (joint for k, joint in enumerate(linkage.joints) if k not in in_loops)
    found |= {name for joint in outside for name in joint.full_names}
    return found - {*mobility(linkage).idle}


def joints_in_loops(linkage: Linkage) -> set[int]:
    """Number the joints that are in loops."""
    return {joint for loop_group in linkage.structure.loop_groups for joint in loop_group.joints}


@once_for_each
def _of_closed(linkage: Linkage) -> Mobility:
    """Compute the mobility of a linkage whose loops are closed in the assembled pose."""
    every = loop_freedoms(linkage)
    mobile = [found for found in every if len(found.motions)]
    spins = {part.name: part.freedoms for part in linkage.spinning}
    in_loops = joints_in_loops(linkage)
    outside = outside_loops(linkage)
    kinds = tuple(found.subgroup(dict(loop)) for found in every for loop in found.loop_group.loops)
    at_ends = sum(joint.freedoms for index, joint in enumerate(linkage.joints) if index not in in_loops)
    coordinates = sum(joint.freedoms for joint in linkage.joints)
    return Mobility(
        freedoms=at_ends + sum(len(found.motions) for found in every),
        idle_motions=tuple(motion for found in mobile for motion in IdleMotions(linkage, found, spins).motions),
        redundant=sum(len(found.jacobian) - found.rank for found in every),
        spinning=tuple(spins),
        spins=sum(spins.values()),
        counted=coordinates - len(linkage.couplings) - EQUATIONS * len(kinds),
        counted_in_subgroups=coordinates - len(linkage.couplings) - sum(kind.dimension for kind in kinds),
        subgroups=kinds,
        drivable=(
            *outside,
            *(name for found in mobile for name in names(linkage, found, drivable(linkage, found, [], spins))),
        ),
    )


def names(linkage: Linkage, found: LoopFreedoms, columns: Iterable[int]) -> list[str]:
    """Return the full names "joint.coordinate" of these columns."""
    chosen = (found.columns[column] for column in columns)
    return [linkage.joints[joint].full_names[k] for joint, k in chosen]


def moving_columns(found: LoopFreedoms, motions: Float[np.ndarray, "n columns"]) -> list[int]:
    """List the columns that move in at least one of the motions."""
    return np.flatnonzero(np.abs(motions).max(axis=0, initial=0.0) > found.thresholds.rate).tolist()


def drivable(linkage: Linkage, found: LoopFreedoms, driven: Sequence[int], spins: Collection[str]) -> list[int]:
    """Select columns to drive besides those `driven`, until only idle freedoms and spins of parts are left.

    Joints at the part that connects the loop group to the fixed parts come first, and among these joints with fewer
    coordinates (hinges and slides before balls); but a column that moves little beside what others move is passed over,
    since all else would move far for little of it (`SHARE`). Columns in which idle motions show are selected only if
    all other columns leave a freedom that is not idle: driving such a column may move nothing but an idle part.
    """
    idle = IdleMotions(linkage, found, spins)
    order = [k for k, (joint, _) in enumerate(found.columns) if not set(spins) & set(found.ends[joint])]
    owner = [joint for joint, _ in found.columns]
    of_joint = Counter(owner)
    order.sort(key=lambda column: (idle.carrier.isdisjoint(found.ends[owner[column]]), of_joint[owner[column]]))
    showing = set(moving_columns(found, idle.rates))
    taken = independent_subset(found, [column for column in order if column not in showing], driven, SHARE)
    for column in (column for column in order if column in showing):
        left = without(found.motions, [*driven, *taken], found.thresholds)
        if independent(np.concatenate([idle.rates, left]), order, found.thresholds) == len(idle.rates):
            break
        if column not in taken:
            taken += independent_subset(found, found.driven_together[column], [*driven, *taken])
    return taken


def independent_subset(
    found: LoopFreedoms, columns: Iterable[int], given: Sequence[int] = (), share: float = 0.0
) -> list[int]:
    """Select columns whose rates are linearly independent of each other and of the columns `given`.

    Each time the first one is taken that adds at least `share` of the largest rate that any of them adds, with 0 the
    first one at all. The angles of a ball are selected together or not at all, unless some of them are given.
    """
    taken: list[int] = []
    offered = list(columns)
    groups = dict.fromkeys(_together(found, column, given) for column in offered)
    left = [group for group in groups if set(group) <= set(offered)]
    while left and len(given) + len(taken) < len(found.motions):
        group = left.pop(_first_of_share(found, left, [*given, *taken], share))
        together = [*given, *taken, *group]
        if independent(found.motions, together, found.thresholds) == len(together):
            taken += group
    return sorted(taken, key=offered.index)


def _together(found: LoopFreedoms, column: int, given: Sequence[int]) -> tuple[int, ...]:
    """Return the columns to be driven together with one: by itself, if it is of a ball of which some are `given`."""
    group = found.driven_together[column]
    return group if set(group).isdisjoint(given) else (column,)


def _first_of_share(found: LoopFreedoms, groups: Sequence[tuple[int, ...]], taken: Sequence[int], share: float) -> int:
    """Find the first group that adds at least a share of the largest rate that any adds to the columns `taken`.

    What a group adds is the least of its rates in the motions of unit norm that are orthogonal to those of `taken`, at
    the generic pose and at the assembled pose, unless that has further freedoms: the pivot of a QR decomposition with
    column pivoting.
    """
    if not share:
        return 0
    poses = [found.motions]
    if len(found.assembled_motions) == len(found.motions):
        poses.append(found.assembled_motions)
    added = np.full(len(groups), np.inf)
    for motions in poses:
        basis = np.linalg.qr(motions[:, list(taken)])[0]
        rest = motions - basis @ (basis.T @ motions)
        rates = [np.linalg.svd(rest[:, list(group)], compute_uv=False)[-1] for group in groups]
        added = np.minimum(added, rates)
    return int(np.argmax(added >= share * added.max()))
