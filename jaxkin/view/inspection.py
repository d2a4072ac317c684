"""A picture of an assembly as it was found: its contact regions, and the axes of its joints."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._files import whole
from jaxkin.contacts.contact import Contact
from jaxkin.contacts.tolerance import default_length
from jaxkin.geometry.units import unit_name
from jaxkin.view.callouts import CHAIN, COLORS, MAX_CALLOUTS, draw_axes, draw_contacts, draw_states
from jaxkin.view.drawing import FIXED_COLOR, PALETTE
from jaxkin.view.glass import WIDTH, canvas_of, pale, see_through
from jaxkin.view.illustration import INK
from jaxkin.view.regions import Region, region_of
from jaxkin.view.sheet import CAPTION, GREY, MARGIN, Color, clip, draw_legend, draw_scale, fitted, make_sheet

if TYPE_CHECKING:
    from matplotlib.artist import Artist

    from jaxkin.assembly.assembly import Assembly
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

    With a mechanism, fixed parts are grey and the axes of its joints are drawn. `contacts` are `assembly.contacts()` by
    default, `width` the pixels of the longer side of the drawing. The file appears whole or not at all.
    """
    contacts = assembly.contacts() if contacts is None else contacts
    fixed = mechanism.fixed if mechanism else ()
    moving = [part.name for part in assembly.parts if part.name not in fixed]
    colors = {
        part.name: part.color
        or (FIXED_COLOR if part.name in fixed else PALETTE[moving.index(part.name) % len(PALETTE)])
        for part in assembly.parts
    }
    canvas = canvas_of(assembly.parts, fixed, width)
    regions = _regions(assembly, contacts)
    entries = _legend(contacts, colors, mechanism)
    sheet = make_sheet(canvas, 1, 1, entries)
    left, top = sheet.place(0)
    areas = [region.triangles for region, contact in regions if contact.region == "surface"]
    image = see_through(canvas, assembly.parts, list(colors.values()), areas, COLORS["surface"])
    sheet.figure.figimage(image, xo=left, yo=sheet.height - top - CAPTION - canvas.height)
    corner = left, top + CAPTION
    draw_contacts(sheet, regions, corner)
    if mechanism:
        draw_axes(sheet, mechanism, _size(assembly), corner)
    else:
        draw_states(sheet, contacts, corner)
    sheet.write((MARGIN, 50), fitted(assembly.source, sheet.width - 2 * MARGIN, 13, "bold"), 13, INK, weight="bold")
    facts = [f"{len(assembly.parts)} parts", f"{len(contacts)} contact{'' if len(contacts) == 1 else 's'}"]
    facts += [f"{len(mechanism.all_joints)} joints"] if mechanism else []
    sheet.write((MARGIN, 87), "  ·  ".join([*facts, f"lengths in {unit_name(assembly.unit)}"]), 9, GREY)
    draw_legend(sheet, entries)
    draw_scale(sheet, assembly.unit)
    with whole(Path(path)) as draft:
        sheet.save(draft)


def _size(assembly: Assembly) -> float:
    boxes = np.concatenate([part.box for part in assembly.parts])
    return float(np.linalg.norm(np.ptp(boxes, axis=0)))


def _regions(assembly: Assembly, contacts: Sequence[Contact]) -> list[tuple[Region, Contact]]:
    faces = {(part.name, face.name): face for part in assembly.parts for face in part.faces}
    tolerance = default_length(assembly.parts)
    found = []
    for contact in contacts:
        face1, face2 = (faces[side] for side in zip(contact.parts, contact.faces, strict=True))
        found.append((region_of(contact, face1, face2, tolerance), contact))
    return found


def _legend(
    contacts: Sequence[Contact], colors: dict[str, Color], mechanism: Mechanism | None
) -> list[tuple[Artist, str]]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: list[tuple[Artist, str]] = []
    for name, color in list(colors.items())[:MAX_CALLOUTS]:
        fixed = " (fixed)" if mechanism is not None and name in mechanism.fixed else ""
        entries.append((Patch(facecolor=pale(color), edgecolor=INK, linewidth=0.8), clip(name, 40) + fixed))
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
