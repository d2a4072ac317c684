"""What is drawn over the parts of an inspection: lines and points of contact, axes of joints, and their names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.contact import Contact
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.view.illustration import INK
from jaxkin.view.regions import DrawnRegion
from jaxkin.view.sheet import MARGIN, Place, Sheet

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

COLORS = {
    "surface": (0.84, 0.15, 0.16),
    "line": (0.50, 0.10, 0.60),
    "circle": (0.00, 0.35, 0.75),
    "point": (0.05, 0.05, 0.05),
}
CHAIN = {"color": INK, "linewidth": 1.3, "linestyle": (0, (9, 2, 1.5, 2))}
"""The line of an axis."""
MAX_CALLOUTS = 24
"""Labels at most: more hide what they name."""


def draw_contacts(sheet: Sheet, regions: Sequence[tuple[DrawnRegion, Contact]], corner: Place) -> None:
    """Draw lines, circles and points of contact; areas belong to the image, whose place is `corner`."""
    for region, contact in regions:
        if not len(region.line):
            continue
        x, y = _pixels(sheet, region.line, corner).T
        style = {"color": COLORS[contact.region], "zorder": 4}
        if len(region.line) == 1:
            sheet.axes.plot(x, y, "o", markersize=9, markeredgecolor="white", **style)
        else:
            sheet.axes.plot(x, y, color="white", linewidth=5.0, zorder=3, solid_capstyle="round")
            sheet.axes.plot(x, y, linewidth=3.0, solid_capstyle="round", **style)


def draw_axes(sheet: Sheet, mechanism: Mechanism, size: float, corner: Place) -> None:
    """Draw a chain line along the z axis of each joint; a dot for a ball, and no line for what cannot move at all."""
    taken: list[np.ndarray] = []
    for joint in mechanism.all_joints:
        if not joint.freedoms:
            continue
        pose = np.asarray(joint.frames_1, float)[0]
        half = 0.0 if MOVEMENTS[joint.movements[0]].ball else 0.09 * size
        ends = _pixels(sheet, pose[:3, 3] + np.outer([-half, half], pose[:3, 2]), corner)
        sheet.axes.plot(*ends.T, color="white", linewidth=3.0, zorder=5)
        sheet.axes.plot(*ends.T, zorder=6, **CHAIN)
        sheet.axes.plot(*ends.mean(axis=0), "o", color=INK, markersize=3.5, zorder=6)
        if len(taken) < MAX_CALLOUTS:
            _label(sheet, ends[1] if ends[1][1] < ends[0][1] else ends[0], f"{joint.name}  {joint.kind}", taken)


def draw_states(sheet: Sheet, contacts: Sequence[Contact], corner: Place) -> None:
    """Draw the letter of each contact state, in the middle of its region."""
    taken: list[np.ndarray] = []
    for contact in contacts[:MAX_CALLOUTS]:
        place = _pixels(sheet, contact.centre[None], corner)[0]
        _label(sheet, place, f"({contact.state})", taken)


def _pixels(sheet: Sheet, points: Float[np.ndarray, "points 3"], corner: Place) -> np.ndarray:
    return sheet.canvas.pixels(points)[:, :2] + corner


def _label(sheet: Sheet, place: np.ndarray, text: str, taken: list[np.ndarray]) -> None:
    """Write a text above a place, and above the labels that are there already; `taken` are their boxes."""
    half = np.array([4.6 * len(text) + 10, 13.0])  # letters of the size below, and the box around them
    centre = np.array([np.clip(place[0], MARGIN + half[0], sheet.width - MARGIN - half[0]), place[1] - 16])
    while any(np.all(np.abs(centre - other[0]) < half + other[1]) for other in taken):
        centre[1] -= 2.0
    taken.append(np.array([centre, half]))
    box = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "none", "alpha": 0.75}
    style = {"size": 8, "color": INK, "ha": "center", "va": "center", "bbox": box, "zorder": 7}
    sheet.axes.text(float(centre[0]), float(centre[1]), text, parse_math=False, **style)
