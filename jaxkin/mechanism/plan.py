"""The plan of a drive: which loops it moves, in which order they can be solved, and what is skipped and why."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from jaxkin._names import listed
from jaxkin.joints.subgroups import Subgroup
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.linkage import Linkage
from jaxkin.linkage.solve_order import Group, solve_order
from jaxkin.mechanism.describe import why_infeasible
from jaxkin.mobility.infeasible_drive import infeasible_drive, undriven_freedoms
from jaxkin.mobility.loop_freedoms import LoopFreedoms, loop_freedoms
from jaxkin.mobility.mobility import names
from jaxkin.mobility.open_loops import check_closed
from jaxkin.topology.elements import Element
from jaxkin.topology.moving import moving

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


@dataclass(frozen=True)
class Step:
    """Loops that can be solved together, once those of some steps before are."""

    joints: tuple[str, ...]
    """The joints that are solved here."""
    parts: tuple[str, ...]
    """The parts that these join."""
    loops: int
    subgroup: Subgroup
    """The smallest displacement subgroup that holds the loops: planar, spherical, Schoenflies, ..."""
    unknowns: tuple[str, ...]
    """Coordinates that are solved."""
    equations: int
    """One for each freedom of the subgroup and each loop."""
    redundant: int
    """How many of them follow from the others."""
    free: int
    """Unknowns that no equation settles, idle or for want of a drive: the solver moves them as little as it can."""
    after: tuple[int, ...]
    """Numbers of the steps that it needs."""

    def __str__(self) -> str:
        after = f"after {listed([str(other + 1) for other in self.after])}: " if self.after else ""
        loops = _count(self.loops, f"{self.subgroup.name} loop")
        redundant = f", {self.redundant} of them redundant" if self.redundant else ""
        free = f"; {self.free} left free" if self.free else ""
        return (
            f"{after}{loops} over {', '.join(self.parts)}: {_count(len(self.unknowns), 'unknown')} of "
            f"{', '.join(self.joints)}, {_count(self.equations, 'equation')}{redundant}{free}"
        )


@dataclass(frozen=True)
class Plan:
    """What a drive moves, in the order in which it can be solved. `print` it.

    The plan describes the structure. The solver of today solves all loops of a structure element together; the steps
    say into what they fall apart.
    """

    drive: tuple[str, ...]
    """Driven coordinates by their full names."""
    steps: tuple[Step, ...]
    skipped: tuple[str, ...]
    """What is not solved, and why, a sentence each."""
    notes: tuple[str, ...]
    """Dead ends, and freedoms that the drive leaves."""

    def __str__(self) -> str:
        lines = [f"Plan of a drive of {', '.join(self.drive)}"]
        for number, step in enumerate(self.steps, 1):
            lines.append(f"  {number}. {step}")
        if not self.steps:
            lines.append("  nothing is to be solved")
        lines += [f"  not solved: {text}" for text in self.skipped]
        return "\n".join([*lines, *(f"  {text}" for text in self.notes)])


def plan(mechanism: Mechanism, drive: Iterable[str]) -> Plan:
    """The plan of a drive by the names of coordinates, as in `sweep`; a drive with its values will do as well.

    Raises ValueError for names that are not there, for none, and where the given pose is open: see `Mechanism.close`.
    """
    linkage = mechanism.linkage
    if isinstance(drive, str):
        raise ValueError(f"the drive must be a list of coordinates, got the text {drive!r}; write [{drive!r}]")
    driven = list(dict.fromkeys(coordinate(linkage, key) for key in drive))
    if not driven:
        raise ValueError("the drive is empty: name at least one joint, as in plan(['A'])")
    check_closed(linkage, mechanism.unit, "the plan of a drive", f"plan({[str(key) for key in drive]})")
    structure, joints = linkage.structure, linkage.joints
    moved = moving(structure, {joints[joint].name for joint, _ in driven})
    steps: list[Step] = []
    for found in loop_freedoms(linkage):
        if found.block in moved.blocks:
            columns = [column for column, owner in enumerate(found.columns) if owner in driven]
            groups = solve_order(found.ends, found.columns, found.screws, columns, found.noise)
            first = len(steps)
            steps += [_step(linkage, found, group, first) for group in groups]
    dead = infeasible_drive(linkage, driven)
    free = undriven_freedoms(linkage, driven)
    notes = [f"dead end: {why_infeasible(mechanism, dead)}"] if dead else []
    if free:
        notes.append(f"left free: {listed(free)} could be driven as well; without, all move as little as they can")
    elif not dead and any(step.free for step in steps):
        notes.append("what is left free is idle: it moves as little as it can")
    return Plan(
        tuple(f"{joints[joint].name}.{joints[joint].coordinates[k]}" for joint, k in driven),
        tuple(steps),
        tuple(_skipped(linkage, driven, moved.parts)),
        tuple(notes),
    )


def _step(linkage: Linkage, found: LoopFreedoms, group: Group, first: int) -> Step:
    joints = linkage.joints
    kind = found.subgroup({*group.joints, *group.passed})
    ends = {part for joint in group.joints for part in found.ends[joint]}
    return Step(
        joints=tuple(joints[joint].name for joint in group.joints),
        parts=tuple(part for part in linkage.structure.parts if part in ends),
        loops=group.loops,
        subgroup=kind,
        unknowns=tuple(names(linkage, found, group.unknowns)),
        equations=kind.dimension * group.loops,
        redundant=kind.dimension * group.loops - group.rank,
        free=group.free,
        after=tuple(first + number for number in group.after),
    )


def _skipped(linkage: Linkage, driven: Sequence[tuple[int, int]], moved: Sequence[str]) -> list[str]:
    """Elements without a driven joint, and coordinates outside of loops."""
    structure = linkage.structure
    rows = {structure.row_of[part] for part in moved}
    given = {linkage.joints[joint].name for joint, _ in driven}
    texts = []
    for element in structure.elements:
        held = {joint for loop in element.loops for joint in structure.loops[loop].path[1::2]}
        if element.loops and not held & given:
            texts.append(
                f"{_loops(element)} of {listed(element.parts)}: none of its joints is driven, it keeps its shape"
            )
            texts[-1] += f" and is carried along by {element.upper}" if element.upper in rows else " and rests"
    for element in structure.elements:
        if element.joint is None:
            continue
        if element.joint in given:
            texts.append(f"{element.joint} is in no loop: its displacement is given, and moves {element.upper}")
    still = [element.joint for element in structure.elements if element.joint and element.joint not in given]
    if still:
        texts.append(f"{listed(still)}: in no loop and not driven, at rest")
    return texts


def _loops(element: Element) -> str:
    return "the loop" if len(element.loops) == 1 else f"the {len(element.loops)} loops"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
