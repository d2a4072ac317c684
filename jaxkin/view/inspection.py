"""A picture of an assembly as it was found: its contact regions, and the axes of its joints."""

from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, UInt8

from jaxkin.contacts.contact import Contact
from jaxkin.contacts.tolerance import default_length
from jaxkin.geometry.pose import frame
from jaxkin.motion.assembly import Assembly
from jaxkin.motion.drawing import GREY as STILL
from jaxkin.motion.drawing import PALETTE
from jaxkin.motion.mechanism import Mechanism
from jaxkin.view.camera import THUMBNAIL, View, choose_view
from jaxkin.view.illustration import FINE, INK, Canvas, draw
from jaxkin.view.raster import rasterise
from jaxkin.view.regions import Region, region_of
from jaxkin.view.sheet import CAPTION, GREY, MARGIN, Sheet, clip, draw_legend, draw_scale, make_sheet

if TYPE_CHECKING:
    from matplotlib.artist import Artist

WIDTH = 1300
"""Pixels of the longer side of the drawing."""
AIR = 0.06
"""Around the parts, over the larger side: axes reach beyond them."""
PALE = 0.62
"""Share of white in the parts, so that the contacts are seen."""
COLORS = {
    "surface": (0.84, 0.15, 0.16),
    "line": (0.50, 0.10, 0.60),
    "circle": (0.00, 0.35, 0.75),
    "point": (0.05, 0.05, 0.05),
}
MOST = 24
"""Labels at most: more hide what they name."""
THROUGH = 12
"""Parts at most whose hidden edges are drawn too."""


def draw_inspection(
    assembly: Assembly,
    path: Path | str,
    *,
    contacts: Sequence[Contact] | None = None,
    mechanism: Mechanism | None = None,
) -> None:
    """Write a picture (PNG) of an assembly with the regions of its contacts, seen through the parts.

    With a mechanism, fixed parts are grey and the axes of its joints are drawn. `contacts` are `assembly.contacts()` by
    default. The file appears whole or not at all.
    """
    contacts = assembly.contacts() if contacts is None else contacts
    fixed = mechanism.fixed if mechanism else ()
    moving = [part.name for part in assembly.parts if part.name not in fixed]
    colors = {
        part.name: part.color or (STILL if part.name in fixed else PALETTE[moving.index(part.name) % len(PALETTE)])
        for part in assembly.parts
    }
    canvas = _canvas(assembly, _view(assembly, fixed))
    regions = _regions(assembly, contacts)
    entries = _legend(contacts, colors, mechanism)
    sheet = make_sheet(canvas, 1, 1, entries)
    left, top = sheet.place(0)
    image = _image(assembly, canvas, colors, [region for region, contact in regions if contact.region == "surface"])
    sheet.figure.figimage(image, xo=left, yo=sheet.height - top - CAPTION - canvas.height)
    _lines(sheet, regions, left, top + CAPTION)
    if mechanism:
        _axes(sheet, mechanism, _size(assembly), left, top + CAPTION)
    else:
        _letters(sheet, contacts, left, top + CAPTION)
    sheet.write((MARGIN, 50), clip(assembly.source, sheet.width // 18), 13, INK, weight="bold")
    facts = [f"{len(assembly.parts)} parts", f"{len(contacts)} contact{'' if len(contacts) == 1 else 's'}"]
    facts += [f"{len(mechanism.all_joints)} joints"] if mechanism else []
    sheet.write((MARGIN, 87), "  ·  ".join([*facts, f"lengths in {assembly.unit}"]), 9, GREY)
    draw_legend(sheet, entries)
    draw_scale(sheet, assembly.unit)
    target = Path(path)
    with TemporaryDirectory(prefix=".", dir=target.parent) as folder:
        draft = Path(folder) / "picture.png"
        sheet.save(draft)
        os.replace(draft, target)


def _size(assembly: Assembly) -> float:
    boxes = np.concatenate([part.box for part in assembly.parts])
    return float(np.linalg.norm(np.ptp(boxes, axis=0)))


def _view(assembly: Assembly, fixed: Sequence[str]) -> View:
    """Obliquely on the plane of most flat faces, from the corner that hides least of any part."""
    still = {part.name: np.eye(4)[None] for part in assembly.parts}
    right, up, out = choose_view(assembly.parts, fixed, still).axes
    views = []
    for above, beside, before in product((1, -1), (1, -1), (-1, 1)):
        towards = 0.62 * above * out + 0.35 * beside * right + 0.7 * before * up
        views.append(View(frame(np.zeros(3), towards, np.cross(above * out, towards))[:3, :3].T, False))
    merits = [_seen(assembly, view) for view in views]
    best = int(np.argmax(merits))
    return views[best] if merits[best] > merits[0] + 0.1 * len(assembly.parts) else views[0]


def _seen(assembly: Assembly, view: View) -> float:
    """The sum over the parts of the logarithm of what a small picture shows of each."""
    points = view.project(np.concatenate([part.triangles for part in assembly.parts]))
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    pixels = (points - low) * (THUMBNAIL / (high - low)[:2].max())
    owners = np.repeat(np.arange(len(assembly.parts)), [len(part.triangles) for part in assembly.parts])
    front = rasterise(pixels, THUMBNAIL, THUMBNAIL).triangle
    return float(np.log1p(np.bincount(owners[front[front >= 0]], minlength=len(assembly.parts))).sum())


def _canvas(assembly: Assembly, view: View) -> Canvas:
    points = view.project(np.concatenate([part.triangles.reshape(-1, 3) for part in assembly.parts]))
    low, high = points.min(axis=0), points.max(axis=0)
    margin = AIR * (high - low)[:2].max()
    extent, centre = (high - low)[:2] + 2 * margin, (low + high) / 2
    scale = WIDTH / extent.max()
    width, height = (int(np.ceil(side * scale)) for side in extent)
    corner = np.append(centre[:2] + np.array([-width, height]) / (2 * scale), centre[2])
    return Canvas(view, corner, scale, height, width)


def _regions(assembly: Assembly, contacts: Sequence[Contact]) -> list[tuple[Region, Contact]]:
    faces = {(part.name, face.name): face for part in assembly.parts for face in part.faces}
    tolerance = default_length(assembly.parts)
    found = []
    for contact in contacts:
        face1, face2 = (faces[side] for side in zip(contact.parts, contact.faces, strict=True))
        found.append((region_of(contact, face1, face2, tolerance), contact))
    return found


def _image(
    assembly: Assembly, canvas: Canvas, colors: dict[str, tuple[float, float, float]], areas: Sequence[Region]
) -> UInt8[np.ndarray, "height width 3"]:
    """The parts in pale colours, and over them the areas of contact: strong where they are in front, else through."""
    from PIL import Image

    parts = draw(canvas, [part.triangles for part in assembly.parts], [colors[part.name] for part in assembly.parts])
    image = PALE + (1 - PALE) * parts.color
    image[~parts.present] = 1.0
    image[parts.crease] *= 0.8
    image[parts.outline] *= 0.45
    if len(assembly.parts) <= THROUGH:
        for part in assembly.parts:
            alone = draw(canvas, [part.triangles], [colors[part.name]])
            hidden = (alone.outline | alone.crease) & (alone.depth < parts.depth - 1.0)
            image[hidden] *= 0.8
    if areas:
        layer = draw(canvas, [area.triangles for area in areas], [COLORS["surface"]] * len(areas))
        front = layer.depth >= parts.depth - 1e-3 * canvas.width * FINE
        strength = np.where(front, 0.8, 0.42)[..., None]
        image = np.where(layer.present[..., None], (1 - strength) * image + strength * layer.color, image)
        rim = layer.outline & ~layer.present
        image[rim] = 0.4 * image[rim] + 0.6 * np.array(COLORS["surface"])
    return np.asarray(Image.fromarray((255 * np.clip(image, 0, 1) + 0.5).astype(np.uint8)).reduce(FINE))


def _pixels(sheet: Sheet, points: Float[np.ndarray, "points 3"], left: int, top: int) -> np.ndarray:
    return sheet.canvas.pixels(points)[:, :2] + [left, top]


def _lines(sheet: Sheet, regions: Sequence[tuple[Region, Contact]], left: int, top: int) -> None:
    for region, contact in regions:
        if not len(region.line):
            continue
        x, y = _pixels(sheet, region.line, left, top).T
        style = {"color": COLORS[contact.region], "zorder": 4}
        if len(region.line) == 1:
            sheet.axes.plot(x, y, "o", markersize=9, markeredgecolor="white", **style)
        else:
            sheet.axes.plot(x, y, color="white", linewidth=5.0, zorder=3, solid_capstyle="round")
            sheet.axes.plot(x, y, linewidth=3.0, solid_capstyle="round", **style)


def _axes(sheet: Sheet, mechanism: Mechanism, size: float, left: int, top: int) -> None:
    """A chain line along the z axis of each joint; a dot for a ball, and no line for what cannot move at all."""
    taken: list[np.ndarray] = []
    for index, joint in enumerate(mechanism.all_joints):
        if joint.movements == ("I",):
            continue
        pose = np.asarray(joint.before, float)[0]
        half = 0.0 if joint.movements[0] == "T_theta_phi_psi" else 0.09 * size
        ends = _pixels(sheet, pose[:3, 3] + np.outer([-half, half], pose[:3, 2]), left, top)
        sheet.axes.plot(*ends.T, color="white", linewidth=3.0, zorder=5)
        sheet.axes.plot(*ends.T, color=INK, linewidth=1.3, linestyle=(0, (9, 2, 1.5, 2)), zorder=6)
        sheet.axes.plot(*ends.mean(axis=0), "o", color=INK, markersize=3.5, zorder=6)
        if index < MOST:
            _label(sheet, ends[1] if ends[1][1] < ends[0][1] else ends[0], f"{joint.name}  {joint.kind}", taken)


def _letters(sheet: Sheet, contacts: Sequence[Contact], left: int, top: int) -> None:
    taken: list[np.ndarray] = []
    for contact in contacts[:MOST]:
        place = _pixels(sheet, contact.centre[None], left, top)[0]
        _label(sheet, place, f"({contact.state})", taken)


def _label(sheet: Sheet, place: np.ndarray, text: str, taken: list[np.ndarray]) -> None:
    """A text above a place, and above the labels that are there already; `taken` are their boxes."""
    half = np.array([4.6 * len(text) + 10, 13.0])  # letters of the size below, and the box around them
    centre = np.array([np.clip(place[0], MARGIN + half[0], sheet.width - MARGIN - half[0]), place[1] - 16])
    while any(np.all(np.abs(centre - other[0]) < half + other[1]) for other in taken):
        centre[1] -= 2.0
    taken.append(np.array([centre, half]))
    box = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "none", "alpha": 0.75}
    style = {"size": 8, "color": INK, "ha": "center", "va": "center", "bbox": box, "zorder": 7}
    sheet.axes.text(float(centre[0]), float(centre[1]), text, parse_math=False, **style)


def _legend(
    contacts: Sequence[Contact], colors: dict[str, tuple[float, float, float]], mechanism: Mechanism | None
) -> list[tuple[Artist, str]]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: list[tuple[Artist, str]] = []
    for name, color in list(colors.items())[:MOST]:
        red, green, blue = (PALE + (1 - PALE) * channel for channel in color)
        still = mechanism is not None and name in mechanism.fixed
        entries.append(
            (
                Patch(facecolor=(red, green, blue), edgecolor=INK, linewidth=0.8),
                clip(name, 40) + (" (fixed)" if still else ""),
            )
        )
    present = {contact.region for contact in contacts}
    if "surface" in present:
        entries.append((Patch(facecolor=COLORS["surface"]), "contact over an area"))
    for region in ("line", "circle"):
        if region in present:
            entries.append((Line2D([], [], color=COLORS[region], linewidth=3.0), f"contact on a {region}"))
    if "point" in present:
        entries.append(
            (Line2D([], [], color=COLORS["point"], marker="o", linestyle="", markersize=8), "contact at a point")
        )
    if mechanism:
        entries.append((Line2D([], [], color=INK, linewidth=1.3, linestyle=(0, (9, 2, 1.5, 2))), "axis of a joint"))
    return entries
