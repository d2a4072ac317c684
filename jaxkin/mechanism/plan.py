"""The plan of a drive in words: which loops are solved, in which order, by which equations, and what is skipped."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from jaxkin._guesses import Result
from jaxkin._names import listed
from jaxkin._traced import traced
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.describe import why_infeasible
from jaxkin.mechanism.drive_plan import DrivePlan, plan_drive
from jaxkin.mechanism.plan_steps import Step, loop_group_steps
from jaxkin.mechanism.targets import DriveKey, names_with_targets
from jaxkin.mobility.infeasible_drive import undriven_freedoms
from jaxkin.mobility.open_loops import check_assembles
from jaxkin.topology.elements import StructureElement
from jaxkin.topology.moving import moving

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


@dataclass(frozen=True, repr=False)
class Plan(Result):
    """What a drive moves, in the order in which the solver of `sweep` solves it. `print` it.

    Every step is a block of equations of the solver (`jaxkin.solve.system.equation_blocks`), in the same order.
    """

    drive: tuple[str, ...]
    """Driven coordinates by their full names."""
    steps: tuple[Step, ...]
    skipped: tuple[str, ...]
    """What is not solved, and why, a sentence each."""
    notes: tuple[str, ...]
    """Why the loops cannot follow the drive, what the drive leaves free, and where the order is not found by ranks."""

    def __str__(self) -> str:
        lines = [f"Plan of a drive of {', '.join(self.drive)}"]
        for number, step in enumerate(self.steps, 1):
            lines.append(f"  {number}. {step}")
        if not self.steps:
            lines.append("  nothing is to be solved")
        lines += [f"  not solved: {text}" for text in self.skipped]
        return "\n".join([*lines, *(f"  {text}" for text in self.notes)])


def plan(mechanism: Mechanism, drive: Iterable[DriveKey]) -> Plan:
    """Plan a drive, given by the names of coordinates as in `sweep`; a drive with its values will do as well.

    Raises ValueError for names that are not there, for none, and where the loops cannot be closed: see
    `Mechanism.close`.
    """
    if isinstance(drive, str):
        raise ValueError(f"the drive must be a list of coordinates, got the text {drive!r}; write [{drive!r}]")
    if not isinstance(drive, Iterable):
        raise ValueError(f"the drive must be a list of coordinates, such as plan(['A']), got {drive!r}")
    mechanism, drive = names_with_targets(mechanism, drive)
    linkage = mechanism.linkage
    keys = {coordinate(linkage, key): key for key in drive}
    if not keys:
        raise ValueError("the drive is empty: name at least one joint, as in plan(['A'])")
    check_assembles(linkage, mechanism.unit, "the plan of a drive", f"{{}}.plan({[str(key) for key in keys.values()]})")
    found = plan_drive(linkage, tuple(keys.values()))
    steps: list[Step] = []
    for loop_group in found.loop_groups:
        steps += loop_group_steps(linkage, loop_group, len(steps))
    dead = [f"infeasible drive: {why_infeasible(mechanism, found.infeasible)}"] if found.infeasible else []
    skipped = (*_skipped(linkage, keys, found), *_at_rest(linkage, found))
    return Plan(tuple(found.driven), tuple(steps), skipped, (*dead, *_notes(linkage, keys, found, steps)))


def _notes(
    linkage: Linkage, driven: Collection[JointCoordinate], found: DrivePlan, steps: Collection[Step]
) -> list[str]:
    """Tell what the drive leaves undetermined, and where the order is found by counting and not by ranks."""
    notes = []
    free = () if traced(linkage) else undriven_freedoms(linkage, list(driven))
    if free:
        notes.append(f"undetermined: {listed(free)} could be driven as well; without, all move as little as they can")
    elif not found.infeasible and any(step.free for step in steps):
        notes.append("what is undetermined is idle: it moves as little as it can")
    for loop_group in found.loop_groups:
        if loop_group.by_counting and len(loop_group.members.loops) > 1:
            why = "its joint frames are traced" if traced(linkage) else "its loops do not close"
            parts = _parts(linkage, loop_group.members.joints)
            notes.append(f"the loops of {listed(parts)} are put in order by counting unknowns, since {why}")
    return notes


def _skipped(linkage: Linkage, driven: Collection[JointCoordinate], found: DrivePlan) -> list[str]:
    """Tell of the structure elements without a driven joint, whose loops rest, and of coordinates outside of loops."""
    structure = linkage.structure
    given = {linkage.joints[joint].name for joint, _ in driven}
    rows = {structure.row_of[part] for part in moving(structure, given).parts}
    solved = {joint for loop_group in found.loop_groups for joint in loop_group.members.joints}
    texts = []
    for element in structure.elements:
        if element.loops and structure.loops[element.loops[0]].joints[0].joint not in solved:
            texts.append(
                f"{_loops(element)} of {listed(element.parts)}: none of its joints is driven, it keeps its shape"
            )
            texts[-1] += f" and is carried along by {element.upper}" if element.upper in rows else " and rests"
    for element in structure.elements:
        if element.joint in given:
            texts.append(f"{element.joint} is in no loop: its displacement is given, and moves {element.upper}")
    given |= {structure.joints[joint] for joint in solved}
    still = [element.joint for element in structure.elements if element.joint and element.joint not in given]
    if still:
        texts.append(f"{listed(still)}: in no loop and not driven, at rest")
    return texts


def _at_rest(linkage: Linkage, found: DrivePlan) -> list[str]:
    """Tell of coordinates out of the planes of planar loops, and of loops in which all coordinates are given."""
    texts = []
    for loop_group in found.loop_groups:
        own = set(loop_group.columns)
        resting = [
            name
            for index in loop_group.members.joints
            for k, name in enumerate(linkage.joints[index].full_names)
            if (index, k) not in own
        ]
        if resting:
            texts.append(f"{listed(resting)}: out of the plane of the loops, at rest")
        checked = sum(len(group.loops) for group in loop_group.groups if not group.unknowns)
        if checked:
            what = "the loop" if checked == 1 else f"{checked} loops"
            parts = listed(_parts(linkage, loop_group.members.joints))
            texts.append(f"{what} of {parts} in which all coordinates are given: the status says whether it closes")
    return texts


def _parts(linkage: Linkage, joints: Iterable[int]) -> list[str]:
    """List the parts that some joints connect, as rows of the incidence matrix."""
    rows: Mapping[str, str] = linkage.structure.row_of
    held = {rows[part] for joint in joints for part in linkage.joints[joint].parts}
    return [part for part in linkage.structure.parts if part in held]


def _loops(element: StructureElement) -> str:
    return "the loop" if len(element.loops) == 1 else f"the {len(element.loops)} loops"
