"""A picture of an assembly as it was found: its contact regions, and the axes of its joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._files import whole
from jaxkin._names import counted
from jaxkin.contacts.contact import Contact
from jaxkin.contacts.tolerance import outline_length
from jaxkin.geometry.units import unit_name
from jaxkin.view.callouts import CHAIN, COLORS, draw_axes, draw_contacts, draw_states
from jaxkin.view.drawing import DISTINCT, FIXED_COLOR, body_colors, body_label, drawn_solids, told_apart
from jaxkin.view.glass import WIDTH, canvas_of, pale, see_through
from jaxkin.view.illustration import INK
from jaxkin.view.regions import DrawnRegion, region_of
from jaxkin.view.sheet import CAPTION, GREY, MARGIN, Color, clip, draw_legend, draw_scale, fitted, make_sheet

if TYPE_CHECKING:
    from matplotlib.artist import Artist

    from jaxkin.assembly.assembly import Assembly
    from jaxkin.geometry.part import Part
from jaxkin.mechanism.mechanism import Mechanism


def draw_inspection(
    assembly: Assembly,
    path: Path | str,
    *,
    contacts: Sequence[Contact] | None = None,
    mechanism: Mechanism | None = None,
    width: int = WIDTH,
) -> None:
    """Write a picture (PNG) of an assembly with the regions of its contacts, seen through the parts.

    With a mechanism, fixed parts are grey and the axes of its joints are drawn. Parts have the colours of the file, or
    those of their bodies where these tell more apart. `contacts` are `assembly.contacts()` by
    default, `width` the pixels of the longer side of the drawing. The file appears whole or not at all.
    """
    contacts = assembly.contacts() if contacts is None else contacts
    fixed = mechanism.fixed if mechanism else ()
    bodies = _bodies(assembly, mechanism)
    by_body = body_colors(bodies, fixed)
    drawn = {part.name: part for part in drawn_solids(mechanism)} if mechanism else {}
    solids = [drawn.get(part.name, part) for part in assembly.parts]
    parts = [replace(part, color=part.color or by_body[part.name]) for part in solids]
    colors = {part.name: part.color or FIXED_COLOR for part in told_apart(parts, bodies, fixed)}
    canvas = canvas_of(solids, fixed, width)
    regions = _regions(assembly, contacts)
    entries = _legend(contacts, colors, bodies, mechanism, solids)
    sheet = make_sheet(canvas, 1, 1, entries)
    left, top = sheet.place(0)
    areas = [region.triangles for region, contact in regions if contact.region == "surface"]
    image = see_through(canvas, solids, list(colors.values()), areas, COLORS["surface"])
    sheet.figure.figimage(image, xo=left, yo=sheet.height - top - CAPTION - canvas.height)
    corner = left, top + CAPTION
    draw_contacts(sheet, regions, corner)
    if mechanism:
        draw_axes(sheet, mechanism, _size(assembly), corner)
    else:
        draw_states(sheet, contacts, corner)
    sheet.write((MARGIN, 50), fitted(assembly.source, sheet.width - 2 * MARGIN, 13, "bold"), 13, INK, weight="bold")
    facts = [counted(len(assembly.parts), "part", "no"), counted(len(contacts), "contact", "no")]
    facts += [counted(len(mechanism.all_joints), "joint", "no")] if mechanism else []
    sheet.write((MARGIN, 87), "  ·  ".join([*facts, f"lengths in {unit_name(assembly.unit)}"]), 9, GREY)
    draw_legend(sheet, entries)
    draw_scale(sheet, assembly.unit)
    with whole(Path(path)) as draft:
        sheet.save(draft)


def _size(assembly: Assembly) -> float:
    boxes = np.concatenate([part.box for part in assembly.parts])
    return float(np.linalg.norm(np.ptp(boxes, axis=0)))


def _regions(assembly: Assembly, contacts: Sequence[Contact]) -> list[tuple[DrawnRegion, Contact]]:
    faces = {(part.name, face.name): face for part in assembly.parts for face in part.faces}
    tolerance = outline_length(assembly.parts)
    found = []
    for contact in contacts:
        face1, face2 = (faces[side] for side in zip(contact.parts, contact.faces, strict=True))
        found.append((region_of(contact, face1, face2, tolerance), contact))
    return found


def _bodies(assembly: Assembly, mechanism: Mechanism | None) -> dict[str, tuple[str, ...]]:
    """Group the parts of an assembly by the bodies of a mechanism, by the first of each; others are by themselves."""
    there = {part.name: (part.name,) for part in assembly.parts}
    bodies = mechanism.bodies.values() if mechanism else ()
    drawn = [kept for parts in bodies if (kept := tuple(part for part in parts if part in there))]
    known = {part for parts in drawn for part in parts}
    return {parts[0]: parts for parts in drawn} | {name: own for name, own in there.items() if name not in known}


def _legend(
    contacts: Sequence[Contact],
    colors: dict[str, Color],
    bodies: Mapping[str, Sequence[str]],
    mechanism: Mechanism | None,
    solids: Sequence[Part],
) -> list[tuple[Artist, str]]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: list[tuple[Artist, str]] = []
    for name, parts in list(bodies.items())[:DISTINCT]:
        fixed = " (fixed)" if mechanism is not None and name in mechanism.fixed else ""
        patch = Patch(facecolor=pale(colors[name]), edgecolor=INK, linewidth=0.8)
        entries.append((patch, clip(body_label(parts, solids), 40) + fixed))
    if (left := len(bodies) - DISTINCT) > 0:
        what = "parts" if mechanism is None else "bodies"
        entries.append((Patch(facecolor="white", edgecolor=INK, linewidth=0.8), f"{left} more {what}"))
    entries += legend_of_regions(contacts)
    if mechanism:
        entries.append((Line2D([], [], **CHAIN), "axis of a joint"))
    return entries


def legend_of_regions(contacts: Sequence[Contact]) -> list[tuple[Artist, str]]:
    """Tell what the regions of contacts look like: of those kinds that are there."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    dot = Line2D([], [], color=COLORS["point"], marker="o", linestyle="", markersize=8)
    entries: dict[str, tuple[Artist, str]] = {
        "surface": (Patch(facecolor=COLORS["surface"]), "contact over an area"),
        "line": (Line2D([], [], color=COLORS["line"], linewidth=3.0), "contact on a line"),
        "circle": (Line2D([], [], color=COLORS["circle"], linewidth=3.0), "contact on a circle"),
        "point": (dot, "contact at a point"),
    }
    present = {contact.region for contact in contacts}
    return [entry for region, entry in entries.items() if region in present]
