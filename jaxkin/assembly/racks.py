"""Racks proposed from solids: teeth in a row along a slide, at the pitch circle of a wheel on the same carrier."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from jaxkin.assembly.gear_proposal import GearProposal
from jaxkin.assembly.toothed_parts import MODULE, PARALLEL_AXES, Slide, Turn, is_around
from jaxkin.geometry.part import Part, box_corners
from jaxkin.geometry.pose import Points
from jaxkin.geometry.teeth import BINS, MAX_TEETH, along_segments, find_teeth, section, section_heights
from jaxkin.geometry.tooth_rows import MIN_ROW, ToothRow, row_of_teeth
from jaxkin.joints.coupling import rack

_CANDIDATES = 40
"""Modules from which a row of teeth is searched, evenly by their ratios: 12 % apart."""
_SHIFT = 0.6
"""How far the pitch line of a rack may be from the pitch circle of its wheel, in modules: profiles are shifted by up to
half a module."""


def rack_proposal(wheel: Part, row: Part, turn: Turn, slide: Slide) -> GearProposal | None:
    """Propose a wheel and a rack about an axis and along a slide; None where they do not mesh.

    The distance p of the teeth of the rack times the N teeth of the wheel is the circumference of the pitch circle.
    """
    across = np.cross(turn.axis, slide.direction)
    if turn.carrier != slide.carrier or abs(turn.axis @ slide.direction) > PARALLEL_AXES or not is_around(wheel, turn):
        return None
    shared = np.stack([np.maximum(wheel.box[0], row.box[0]), np.minimum(wheel.box[1], row.box[1])])
    heights = box_corners(shared) @ turn.axis
    between = (float(heights.min()), float(heights.max()))
    teeth = [each for each in find_teeth(wheel.triangles, turn.point, turn.axis, between) if each.side == "outer"]
    if not teeth:
        return None
    for side in (1.0, -1.0):
        for found in _rows(row, turn, slide, side * across, between):
            for own in teeth:
                module = found.spacing / np.pi
                radius = own.number * module / 2
                if (
                    abs(2 * own.pitch_radius / own.number - module) < MODULE * module
                    and abs(-found.level - radius) < _SHIFT * module
                    and found.begin - found.spacing < 0 < found.end + found.spacing
                ):
                    # at the contact, side * across from the axis, the wheel moves against the slide for positive turns
                    coupling = rack(turn.coordinate, slide.coordinate, -side * radius)
                    counts = (own.number, found.count), (own.counted, found.count)
                    return GearProposal((wheel.name, row.name), counts[0], "rack", module, coupling, counts[1])
    return None


def _rows(part: Part, turn: Turn, slide: Slide, towards: Points, between: tuple[float, float]) -> Iterator[ToothRow]:
    """Find rows of teeth that point to an axis, in sections across it; `towards` is the direction from it to the part.

    Positions are along the slide from the axis; heights are distances from the axis times -1.
    """
    levels = part.triangles @ turn.axis
    for height in section_heights(levels, between):
        cut = (levels.min(axis=1) < height) & (height < levels.max(axis=1))
        x, y = section(part.triangles[cut], turn.point, turn.axis, levels[cut] - height, slide.direction)
        y = y * np.sign(towards @ np.cross(turn.axis, slide.direction))
        if not len(x) or not np.ptp(x):
            continue
        begin, step = float(x.min()), float(np.ptp(x)) / BINS
        count = np.ceil(np.abs(np.diff(x, axis=1))[:, 0] / step).astype(int) + 1
        along, away = along_segments(x, y, count)
        heights = np.full(BINS, -np.inf)
        before = away > 0  # what is on this side of the axis
        bins = np.minimum(((along - begin) / step).astype(int), BINS - 1)
        np.maximum.at(heights, bins[before], -away[before])
        modules = np.geomspace(1.0 / MIN_ROW, 1.0 / MAX_TEETH, _CANDIDATES) * float(np.ptp(x)) / np.pi
        if found := row_of_teeth(heights, step, modules, lambda spacing, _: spacing / np.pi):
            shift = begin + 0.5 * step
            yield found._replace(begin=found.begin + shift, end=found.end + shift)
