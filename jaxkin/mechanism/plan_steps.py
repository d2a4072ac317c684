"""Describe the steps of a plan, the blocks of the solver's equations, by names of joints, parts and coordinates."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from jaxkin._names import counted, listed
from jaxkin._traced import traced
from jaxkin.joints.subgroups import Subgroup, subgroup
from jaxkin.linkage.joint_pattern import letter, loop_name
from jaxkin.linkage.linkage import Linkage
from jaxkin.linkage.solve_order import Group
from jaxkin.mechanism.drive_plan import DrivenLoopGroup, ranked_groups
from jaxkin.mobility.loop_freedoms import LoopFreedoms, loop_freedoms
from jaxkin.solve.closed_form.group_formulas import group_formulas, why_not_all
from jaxkin.solve.system.equation_blocks import EquationBlock, blocks_of_groups
from jaxkin.solve.system.loop_system import LoopSystem

RANK_OF_CUT = {0: 0, 1: 3, 2: 5}
"""Independent equations that a cut takes away, by the number of balls: three rotations; both rotations of a rod but its
idle spin."""


@dataclass(frozen=True)
class Step:
    """Loops and couplings that are solved together, once those of some steps before are: one block of equations."""

    joints: tuple[str, ...]
    """The joints whose unknown coordinates are determined here."""
    parts: tuple[str, ...]
    """The parts that these joints connect."""
    loops: int
    """Number of loops."""
    couplings: tuple[str, ...]
    """Names of the couplings."""
    loop_class: str
    """What the loops are: "planar dyad RRP", "spherical dyad RRR", "spatial loop RSSR", or of several "2 planar loops".
    The letters are those of `jaxkin.linkage.joint_pattern`."""
    subgroup: Subgroup | None
    """The smallest displacement subgroup that holds the loops: planar, spherical, Schoenflies, ... None where the joint
    frames are traced, and of couplings alone."""
    unknowns: tuple[str, ...]
    """Coordinates for which the equations are solved."""
    equations: int
    """Number of equations that are solved."""
    redundant: int
    """Number of equations that follow from the others."""
    free: int
    """Number of unknowns that no equation determines, idle or for want of a drive: they move as little as they can."""
    follow: tuple[str, ...]
    """Balls at which the loops are cut: their turns are no unknowns, and follow when the others are known."""
    after: tuple[int, ...]
    """Numbers of the steps that must be solved before."""
    merged: int
    """Number of groups of loops that are one step because they share what is undetermined; 1 where none is."""

    method: str
    """"formula" or "Newton". See `SolverOptions.formulas` for sweeps that are left to Newton's method all the same."""
    why: str
    """Which formula it is, or why there is none."""

    def __str__(self) -> str:
        after = f"after {listed([str(other + 1) for other in self.after])}: " if self.after else ""
        of_joints = ", ".join(joint for joint in self.joints if joint not in self.follow)
        redundant = f", {self.redundant} of them redundant" if self.redundant else ""
        free = f"; {self.free} undetermined" if self.free else ""
        follow = f"; the turns of {', '.join(self.follow)} follow" if self.follow else ""
        merged = f"; {self.merged} groups in one step: they share what is undetermined" if self.merged > 1 else ""
        count = "1 " if self.loops == 1 else ""
        coupled = f"{' with ' if self.loops else ''}{listed(self.couplings)}" if self.couplings else ""
        what = f"{count}{self.loop_class}{coupled} over {', '.join(self.parts)}"
        equations = f"{counted(len(self.unknowns), 'unknown')} of {of_joints}, {counted(self.equations, 'equation')}"
        return f"{after}{what}: {equations}{redundant}{free}{follow}{merged}; {self.method} ({self.why})"


def loop_group_steps(linkage: Linkage, loop_group: DrivenLoopGroup, first: int) -> list[Step]:
    """List the steps of a loop group, numbered from `first` on: one for each group that has unknowns."""
    freedoms = None if traced(linkage) else _freedoms(linkage, loop_group)
    groups = _ranked(linkage, loop_group, freedoms)
    blocks = blocks_of_groups(loop_group.system)
    solved = [k for k, block in enumerate(blocks) if block.columns]
    number = {k: first + place for place, k in enumerate(solved)}
    steps = []
    for k in solved:
        after = tuple(sorted(number[other] for other in _solved_before(groups, k, solved)))
        steps.append(_step(linkage, loop_group, k, groups[k], freedoms, after))
    return steps


def _freedoms(linkage: Linkage, loop_group: DrivenLoopGroup) -> LoopFreedoms:
    """Look up the freedoms of the loops of a loop group."""
    return loop_freedoms(linkage)[linkage.structure.loop_groups.index(loop_group.members)]


def _ranked(linkage: Linkage, loop_group: DrivenLoopGroup, freedoms: LoopFreedoms | None) -> tuple[Group, ...]:
    """Find the groups of a loop group with their ranks, which `plan_drive` does not find for a single loop."""
    several = len(loop_group.members.loops) + len(loop_group.members.couplings) > 1
    if freedoms is None or not freedoms.closes or several:
        return loop_group.groups
    driven = tuple(loop_group.columns[column] for column in loop_group.system.driven)
    loop_class = linkage.classes[linkage.structure.loop_groups.index(loop_group.members)]
    return ranked_groups(linkage, loop_group.members, driven, loop_class, freedoms) or loop_group.groups


def _solved_before(groups: tuple[Group, ...], number: int, solved: Sequence[int]) -> set[int]:
    """Find the groups with unknowns that group `number` needs, directly or over groups without unknowns."""
    return {
        k
        for other in groups[number].after
        for k in ({other} if other in solved else _solved_before(groups, other, solved))
    }


def _step(
    linkage: Linkage,
    loop_group: DrivenLoopGroup,
    number: int,
    group: Group,
    freedoms: LoopFreedoms | None,
    after: tuple[int, ...],
) -> Step:
    """Describe the step of group `number`, once those of `after` are solved.

    Ranks are those of all its loops: what a cut at balls takes away (`RANK_OF_CUT`) is no equation of the block.
    """
    system, block = loop_group.system, blocks_of_groups(loop_group.system)[number]
    joints, loops = linkage.joints, _loops(loop_group, number)
    cuts = [system.cuts[loop] for loop in loops]
    rank = group.rank - sum(RANK_OF_CUT[len(cut)] for cut in cuts)
    cut = {ball for balls in cuts for ball in balls}
    method, why = _method(loop_group, number)
    joint_of_ball = {ball: joint for (joint, _), (ball, _) in system.places.items()}
    rows = linkage.structure.row_of
    ends = {rows[part] for joint in group.joints for part in joints[joint].parts}
    return Step(
        joints=tuple(joints[joint].name for joint in group.joints),
        parts=tuple(part for part in linkage.structure.parts if part in ends),
        loops=len(loops),
        couplings=tuple(linkage.couplings[coupling].name for coupling in group.couplings),
        loop_class=_loop_class(loop_group, number, group),
        subgroup=None if freedoms is None or not loops else _subgroup(loop_group, group, freedoms),
        unknowns=_names(linkage, loop_group, block),
        equations=len(block.rows),
        redundant=len(block.rows) - rank,
        free=len(block.columns) - rank,
        follow=tuple(joints[loop_group.members.joints[joint_of_ball[ball]]].name for ball in sorted(cut)),
        after=after,
        merged=group.merged,
        method=method,
        why=why,
    )


def _method(loop_group: DrivenLoopGroup, number: int) -> tuple[str, str]:
    """Tell how a group is solved, "formula" or "Newton", and why."""
    blocks = blocks_of_groups(loop_group.system)
    found = group_formulas(loop_group.system)[sum(bool(block.columns) for block in blocks[:number])]
    if isinstance(found, str):
        return "Newton", found
    if (missing := why_not_all(loop_group.system)) is not None:
        return "Newton", f"the {found.name} {found.letters} has a formula, but {missing}"
    return "formula", f"{found.name} {found.letters}"


def _names(linkage: Linkage, loop_group: DrivenLoopGroup, block: EquationBlock) -> tuple[str, ...]:
    """List the full names of the coordinates that a block is solved for."""
    places = (loop_group.columns[column] for column in block.columns)
    return tuple(linkage.joints[joint].full_names[k] for joint, k in places)


def _subgroup(loop_group: DrivenLoopGroup, group: Group, freedoms: LoopFreedoms) -> Subgroup:
    """Find the smallest subgroup that holds the moving coordinates of the loops of a group."""
    held = {joint for loop in group.loops for joint, _ in loop}
    columns = [freedoms.columns.index(place) for place in loop_group.columns if place[0] in held]
    return subgroup(freedoms.assembled_screws[:, columns], 10 * freedoms.thresholds.rank)


def _loop_class(loop_group: DrivenLoopGroup, number: int, group: Group) -> str:
    """Name what the loops of a group are to the solver, and for a single loop the pattern of its joints."""
    loops = _loops(loop_group, number)
    kinds = [_kind(loop_group.system, loop) for loop in loops]
    if len(loops) != 1:
        return " and ".join(counted(times, f"{kind} loop") for kind, times in Counter(kinds).items())
    letters = {}
    for place, movements in enumerate(loop_group.system.movements):
        unknown = set(loop_group.system.span(place)) - set(loop_group.system.driven)
        columns = unknown or set(loop_group.system.span(place))
        first = loop_group.system.span(place).start
        letters[loop_group.members.joints[place]] = letter(movements, {column - first for column in columns})
    return loop_name(group, letters, kinds[0])


def _loops(loop_group: DrivenLoopGroup, number: int) -> tuple[int, ...]:
    """List the numbers of the loops of a group, without its couplings."""
    return tuple(each for each in loop_group.system.order[number] if each < len(loop_group.system.loops))


def _kind(system: LoopSystem, loop: int) -> str:
    """Name the class of a loop by the equations that the solver needs for it."""
    if system.planar:
        return "planar"
    if loop in system.sections.spherical:
        return "spherical"
    return "Schoenflies" if loop in system.sections.one_rotation else "spatial"
