"""A mechanism as a table to read: joints, loops, mobility, notes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from jaxkin.mobility.infeasible_drive import InfeasibleDrive
from jaxkin.mobility.open_loops import opening

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


def describe_mechanism(mechanism: Mechanism) -> str:
    """Joints with their parts and freedoms, loops as paths, mobility, and what was noted on the way from solids."""
    unit = f", lengths in {mechanism.unit}" if mechanism.unit else ""
    moving = len(mechanism.parts) - len(mechanism.fixed)
    lines = [
        f"Mechanism of {len(mechanism.parts)} parts ({moving} moving), fixed: {', '.join(mechanism.fixed)}{unit}",
        "",
    ]
    rows = [("joint", "parts", "kind", "coordinates")]
    rows += [
        (joint.name, " - ".join(joint.parts), joint.kind, ", ".join(joint.coordinates) or "none")
        for joint in mechanism.all_joints
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    lines += [
        "  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    ]
    lines += ["", f"Loops: {len(mechanism.structure.loops)}"]
    lines += [f"  {' - '.join((*loop.path, loop.path[0]))}" for loop in mechanism.structure.loops]
    if (gap := opening(mechanism.linkage, mechanism.unit)) is not None:
        lines += ["", f"Not closed in this pose: {gap}; mechanism.close() closes it"]
    else:
        lines += ["", *_mobility(mechanism, moving)]
    if mechanism.notes:
        lines += ["", "Notes:", *(f"  {note}" for note in mechanism.notes)]
    return "\n".join(lines)


def _mobility(mechanism: Mechanism, moving: int) -> list[str]:
    mobility = mechanism.mobility()
    lines = [f"Mobility: {mobility}", *([f"  {mobility.counting}"] if mobility.counting else [])]
    return lines if mobility.useful or not moving else [*lines, *_why_it_cannot_move(mechanism, mobility.freedoms)]


def _why_it_cannot_move(mechanism: Mechanism, freedoms: int) -> list[str]:
    said = "It cannot move."
    if freedoms:
        what = "its freedom is" if freedoms == 1 else f"its {freedoms} freedoms are"
        said = f"Nothing can move but parts about themselves: {what} idle or of parts that only spin."
    ways = mechanism.blocking_contacts()
    if not ways:
        return [f"{said} No single contact is the reason, nor are several between the same two parts."]
    return [f"{said} It could without one of these (leave a contact out with ignore=):", *(f"  {way}" for way in ways)]


def why_infeasible(mechanism: Mechanism, drive: InfeasibleDrive) -> str:
    """Why the loops cannot follow a drive, with the contacts or joints without which they could, where none moves."""
    if not drive.immobile:
        return drive.why
    row_of = mechanism.structure.row_of
    every = mechanism.blocking_contacts()
    ways = [way for way in every if not {row_of[part] for part in way.parts}.isdisjoint(drive.immobile)]
    if not ways:
        return f"{drive.why}; no single contact or joint is the reason"
    return f"{drive.why}; without one of these it would have some: {'; '.join(map(str, ways))}"
