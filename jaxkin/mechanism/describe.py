"""A mechanism as a table to read: joints, loops, mobility, notes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._grouped import SCREEN, grouped, kind_of, shortened
from jaxkin._names import counted, listed
from jaxkin._traced import traced
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.part import body_name
from jaxkin.geometry.units import unit_name
from jaxkin.joints.evidence import Doubt, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.doubts import doubts
from jaxkin.mobility.infeasible_drive import InfeasibleDrive
from jaxkin.mobility.loop_freedoms import loop_freedoms
from jaxkin.mobility.open_loops import opening
from jaxkin.topology.bodies import body_of_parts

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.topology.loops import Loop


_WIDE = 140
"""Letters of the path of a loop from which on only its bodies are named, in place of all its parts and joints."""
_NAMED = 8
"""Fixed parts that are named: a frame of an assembly has dozens, with all its screws."""
_NOT_ALWAYS = ("bodies", "limits", "known from")
"""Headings of the columns of the table of joints that are left out where nothing is in them."""


def describe_mechanism(mechanism: Mechanism, verbose: bool = False) -> str:
    """Tell joints with their parts and freedoms, loops as paths, mobility, and what was noted on the way from solids.

    Of mechanisms with more joints than a screen has lines, the bodies are told in place of the joints that hold them
    together, and of many loops and notes the first of a kind, unless `verbose`. Nor are more than a few fixed parts
    named then, nor all parts and joints of a long loop.
    """
    if traced(mechanism):
        parts = counted(len(mechanism.parts), "part")
        return f"Mechanism of {parts}: traced by JAX, its numbers are known outside of jit, vmap and grad"
    brief = len(mechanism.all_joints) > SCREEN and not verbose
    unit = f", lengths in {unit_name(mechanism.unit)}" if mechanism.unit else ""
    moving = len(mechanism.parts) - len(mechanism.fixed)
    few = 1 if brief else _NAMED  # bodies are listed below
    named = _named_bodies(mechanism)
    base = mechanism.fixed if verbose else _first(named[mechanism.fixed[0]], mechanism.fixed)
    fixed = ", ".join(base) if verbose else listed(base, few)
    lines = [f"Mechanism of {counted(len(mechanism.parts), 'part')} ({moving} moving), fixed: {fixed}{unit}", ""]
    lines += [*_bodies(mechanism, named), ""] if brief else []
    joints = [joint for joint in mechanism.all_joints if joint.freedoms or not brief]
    lines += _joints(joints, named)
    if couplings := [f"  {coupling.name}: {coupling}" for coupling in mechanism.linkage.couplings]:
        lines += ["", "Couplings:", *(shortened(couplings) if brief else couplings)]
    lines += ["", f"Motors: {(listed if brief else ', '.join)(mechanism.motors)}"] if mechanism.motors else []
    loops = [_loop(loop, mechanism, named, verbose) for loop in mechanism.structure.loops]
    lines += ["", f"Loops: {len(loops)}", *(f"  {loop}" for loop in (shortened(loops) if brief else loops))]
    lines += ["", *describe_mobility(mechanism, verbose)]
    if doubtful := doubts(mechanism.linkage):
        rows = [f"  {each.name} is taken as {each.kind}, and {_doubt(each, doubt)}" for each, doubt in doubtful]
        head = f"Doubtful: {len(rows)} of {len(joints)} joints, the least certain first"
        lines += ["", f"{head}; jaxkin inspect --study tries the other readings", *(shortened(rows) if brief else rows)]
    if mechanism.notes:
        notes = grouped(((kind_of(note.rpartition(": ")[2]), note) for note in mechanism.notes), verbose)
        lines += ["", "Notes:", *(f"  {note}" for note in notes)]
    return "\n".join(lines)


def _doubt(joint: Joint, doubt: Doubt) -> str:
    """Tell what else a joint may be, how often such joints were right, and how to say that its parts are one body."""
    one_body = f": rigid=[{list(joint.parts)!r}]" if doubt.kind is JointKind.FIXED else ""
    return f"{doubt} (right in {doubt.seen.right} of {doubt.seen.of} such joints){one_body}"


def _named_bodies(mechanism: Mechanism) -> dict[str, str]:
    """Map each part to what its body is called: as in pictures, by its heaviest part."""
    solids = {part.name: part for part in mechanism.solids}
    return body_of_parts({body_name(parts, solids): parts for parts in mechanism.bodies.values()})


def _first(part: str, parts: Sequence[str]) -> list[str]:
    """List parts with one of them first."""
    return [part, *(other for other in parts if other != part)]


def _loop(loop: Loop, mechanism: Mechanism, body: Mapping[str, str], verbose: bool) -> str:
    """Write a loop as its path, or, of a long one, as the bodies along it, unless `verbose`."""
    if verbose or len(str(loop)) <= _WIDE:
        return str(loop)
    rows = [body[mechanism.fixed[0]] if row not in body else body[row] for row in loop.path[::2]]
    told = [row for row, after in pairwise([*rows, rows[0]]) if row != after]
    return f"over the bodies {' - '.join([*told, told[0]])}" if told else str(loop)


def _bodies(mechanism: Mechanism, named: Mapping[str, str]) -> list[str]:
    """List the bodies of more than one part, after a line with the number of all bodies."""
    several = [parts for parts in mechanism.bodies.values() if len(parts) > 1]
    bodies = [_first(named[parts[0]], parts) for parts in several]
    rows = [f"{name}: {len(others) + 1} parts, with {listed(others)}" for name, *others in bodies]
    return [f"Bodies: {len(mechanism.bodies)}", *(f"  {row}" for row in shortened(rows))]


def _joints(joints: Sequence[Joint], body: Mapping[str, str]) -> list[str]:
    """Write a table of joints: the bodies that a joint moves, by what they are called, if it joins other parts of them,
    as a bush and a pin; limits if any joint has some, and what a joint is known from if that is in doubt."""
    rows = [("joint", "parts", "bodies", "kind", "coordinates", "limits", "known from")]
    for joint in joints:
        evidence = joint.evidence
        told = evidence is not None and (evidence.kind not in (EvidenceKind.CONTACT, EvidenceKind.USER))
        told = told or (evidence is not None and evidence.kind is EvidenceKind.USER and bool(evidence.text))
        known = str(evidence) if told else ""
        coordinates = ", ".join(joint.coordinates) or "none"
        owners = tuple(body[part] for part in joint.parts)
        bodies = " - ".join(owners) if joint.freedoms and owners != joint.parts else ""
        rows.append((joint.name, " - ".join(joint.parts), bodies, joint.kind, coordinates, _limits(joint), known))
    columns = [column for column in zip(*rows, strict=True) if any(column[1:]) or column[0] not in _NOT_ALWAYS]
    widths = [max(map(len, column)) for column in columns]
    rows = list(zip(*columns, strict=True))
    return ["  " + "  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def _limits(joint: Joint) -> str:
    """Write the limits of a joint, radians or lengths from the assembled pose: "-0.5 to 1 rad"; empty without any."""
    return ", ".join(
        f"{low:.4g} to {high:.4g}{'' if is_length(name) else ' rad'}" if np.isfinite([low, high]).any() else "none"
        for name, (low, high) in zip(joint.coordinates, joint.limits, strict=bool(joint.limits))
    )


def describe_mobility(mechanism: Mechanism, verbose: bool = False) -> list[str]:
    """Tell the freedoms of a mechanism in lines, of many idle ones the first unless `verbose`; where nothing can move,
    why not, and where it is open, by how much."""
    told: list[str] = []
    if (gap := opening(mechanism.linkage, mechanism.unit)) is not None:
        closes = all(each.closes for each in loop_freedoms(mechanism.linkage))
        told = [f"Not closed in this pose: {gap}; mechanism.close() {'closes it' if closes else 'tries to close it'}"]
        if not closes:
            return told
    mobility = mechanism.mobility()
    head, *idle = str(mobility).splitlines()
    idle = [f"  idle: {each}" for each in mobility.idle_motions] if verbose else idle
    lines = [*told, f"Mobility: {head}", *([f"  {mobility.counting}"] if mobility.counting else []), *idle]
    if len(mechanism.bodies) == 1 < len(mechanism.parts):
        return [*lines, f"It cannot move: all its parts are one body.{_what_makes_it_one(mechanism)}"]
    moving = len(mechanism.parts) > len(mechanism.fixed)
    return lines if mobility.useful or not moving else [*lines, *_why_it_cannot_move(mechanism, mobility.freedoms)]


def _what_makes_it_one(mechanism: Mechanism) -> str:
    """Say how to see, and take back, the inferences that make one body of all parts, or that their file does; empty
    where the user does."""
    kinds = [each.evidence.kind for each in mechanism.bonds]
    inferred = [kind for kind in kinds if kind not in (EvidenceKind.USER, EvidenceKind.EXPORT)]
    if not inferred:
        return " Its file has them so: see the notes." if EvidenceKind.EXPORT in kinds else ""
    if all(kind is EvidenceKind.NEAREST for kind in inferred):
        return (
            " Nothing ties them: none touches another, so all stay at rest. Put them together in the CAD system, as "
            "they touch when assembled, or write the joints: joints=[jk.revolute(...)]."
        )
    count = f"{counted(len(inferred), 'inference')} {'makes' if len(inferred) == 1 else 'make'} it so"
    return (
        f" {count}: see the notes. ignore=[(part, part)] takes back that of two parts, infer=False all; "
        "assembly.proposals(fixed=...) tries which of them frees something."
    )


def _why_it_cannot_move(mechanism: Mechanism, freedoms: int) -> list[str]:
    said = "It cannot move."
    if freedoms:
        what = "its freedom is" if freedoms == 1 else f"its {freedoms} freedoms are"
        said = f"Nothing can move but parts by themselves: {what} idle or of parts that move nothing else."
    ways = mechanism.blocking_contacts()
    if not ways:
        if not mechanism.contacts:
            return [said if freedoms else f"{said} No single joint is the reason."]
        inferred = any(each.evidence.kind not in (EvidenceKind.USER, EvidenceKind.EXPORT) for each in mechanism.bonds)
        which = " assembly.proposals(fixed=...) tries which inference is." if inferred else ""
        return [f"{said} No single contact is the reason, nor are several between the same two parts.{which}"]
    how = " (leave a contact out with ignore=)" if mechanism.contacts else ""
    return [f"{said} It could without one of these{how}:", *(f"  {way}" for way in ways)]


def why_infeasible(mechanism: Mechanism, drive: InfeasibleDrive) -> str:
    """Tell why the loops cannot follow a drive; where nothing moves, also which contacts or joints are to blame."""
    if not drive.immobile:
        return drive.why
    row_of = mechanism.structure.row_of
    every = mechanism.blocking_contacts()
    ways = [way for way in every if not {row_of[part] for part in way.parts}.isdisjoint(drive.immobile)]
    if not ways:
        return f"{drive.why}; no single contact or joint is the reason"
    return f"{drive.why}; without one of these it would have some: {'; '.join(map(str, ways))}"
