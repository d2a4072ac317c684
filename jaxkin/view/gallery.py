"""A sheet with a picture of each contact: the two parts alone, and the region in which they touch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._files import whole
from jaxkin._names import counted
from jaxkin.contacts.contact import Contact
from jaxkin.contacts.tolerance import outline_length
from jaxkin.geometry.part import Part
from jaxkin.view.callouts import COLORS, draw_contacts
from jaxkin.view.drawing import PALETTE
from jaxkin.view.glass import canvas_of, see_through
from jaxkin.view.illustration import INK, Canvas
from jaxkin.view.inspection import legend_of_regions
from jaxkin.view.regions import DrawnRegion, region_of
from jaxkin.view.sheet import CAPTION, GREY, MARGIN, draw_legend, fitted, make_sheet

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly

PANEL = 340
"""Pixels of a side of a panel."""
GALLERY_COLUMNS = 4
"""Pictures beside each other."""


def draw_gallery(assembly: Assembly, path: Path | str, *, contacts: Sequence[Contact] | None = None) -> None:
    """Write a picture (PNG) with a panel for each of some contacts of an assembly, by default of all.

    A panel shows the two parts seen through, and over it the state, what it is and its freedoms. The file appears whole
    or not at all. Raises ValueError where there are no contacts.
    """
    contacts = assembly.contacts() if contacts is None else contacts
    if not contacts:
        raise ValueError(f"{assembly.source} has no contacts to draw")
    faces = {(part.name, face.name): face for part in assembly.parts for face in part.faces}
    parts = {part.name: part for part in assembly.parts}
    tolerance = outline_length(assembly.parts)
    entries = legend_of_regions(contacts)
    columns = min(GALLERY_COLUMNS, len(contacts))
    pairs = [[parts[name] for name in contact.parts] for contact in contacts]
    canvases = [_square(canvas_of(pair, (), PANEL)) for pair in pairs]
    sheet = make_sheet(canvases[0], columns, -(-len(contacts) // columns), entries)
    for number, (contact, pair, canvas) in enumerate(zip(contacts, pairs, canvases, strict=True)):
        face1, face2 = (faces[side] for side in zip(contact.parts, contact.faces, strict=True))
        region = region_of(contact, face1, face2, tolerance)
        left, top = sheet.place(number)
        image = _image(canvas, pair, region)
        sheet.figure.figimage(image, xo=left, yo=sheet.height - top - CAPTION - PANEL)
        draw_contacts(sheet._replace(canvas=canvas), [(region, contact)], (left, top + CAPTION))
        state = contact.contact_state
        sheet.write((left, top + 6), f"({contact.state})  {state.name}", 9, INK, weight="bold")
        freedoms = counted(state.freedoms, "freedom")
        sheet.write((left, top + 29), f"{contact.region}, {freedoms}", 7, GREY)
    sheet.write((MARGIN, 50), fitted(assembly.source, sheet.width - 2 * MARGIN, 13, "bold"), 13, INK, weight="bold")
    sheet.write((MARGIN, 87), counted(len(contacts), "contact"), 9, GREY)
    draw_legend(sheet, entries)
    with whole(Path(path)) as draft:
        sheet.save(draft)


def _square(canvas: Canvas) -> Canvas:
    """Grow the canvas by as much paper around as a panel has."""
    room = np.array([canvas.width - PANEL, PANEL - canvas.height, 0]) / (2 * canvas.scale)
    return replace(canvas, corner=canvas.corner + room, width=PANEL, height=PANEL)


def _image(canvas: Canvas, pair: Sequence[Part], region: DrawnRegion) -> np.ndarray:
    areas = [region.triangles] if len(region.triangles) else []
    return see_through(canvas, pair, [PALETTE[0], PALETTE[1]], areas, COLORS["surface"])
