"""Teeth: sections of a solid across an axis whose outline repeats, and how often it does on a full turn."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Points
from jaxkin.geometry.tooth_rows import DEPTH, ToothRow, row_of_teeth
from jaxkin.geometry.triangles import Triangles, plane_cut

ToothSide = Literal["outer", "inner"]

BINS = 4096
"""Angles at which an outline is sampled: ten on each tooth of a wheel with `MAX_TEETH`."""
POINTS = 2
"""Points that are taken on a segment for each angle that it passes: with one, the flank of a saw tooth, whose radius
changes by a sixth, passed some angles without a point, and the bore was seen there."""
MIN_TEETH, MAX_TEETH = 6, 400
"""Pinions have 6 teeth at least (with fewer, they are screws); a wheel with more than 400 is drawn as a disc."""
PURITY = 0.75
"""Least share of the power of an outline that is in the harmonics of its teeth. Drawn wheels have 0.97 to 1; keyways,
bores, and triangles that do not repeat with the teeth take the rest."""
_CANDIDATES = 40
"""Numbers of teeth from which a sector is searched, evenly by their ratios: 11 % apart."""
_WHOLE = 0.2
"""How far the teeth of a full turn, from the distance of those of a sector, may be from a whole number."""
MAX_SECTIONS = 9
"""Sections that are made of a part at most: teeth are seen in all sections between two faces of a rim."""


class Teeth(NamedTuple):
    """A toothed outline about an axis."""

    number: int
    """Teeth on a full turn."""
    side: ToothSide
    """Whether the teeth stand out from a rim, or into a ring."""
    pitch_radius: float
    """Radius halfway between the tips and the roots: about that of the pitch circle."""
    height: float
    """Where on the axis the section is, measured from the origin."""
    counted: int
    """Teeth that are there: fewer on a sector."""


def find_teeth(triangles: Triangles, point: Points, axis: Points, between: tuple[float, float]) -> list[Teeth]:
    """Find the toothed outlines of a solid, in sections across the axis between two heights on it.

    `point` (3,) is on the axis, a unit vector (3,); heights are measured along it from the origin of the world.
    Several sections of one rim give one outline each.
    """
    found = []
    levels = triangles @ axis
    lowest, highest = levels.min(axis=1), levels.max(axis=1)
    for height in section_heights(levels, between):
        cut = (lowest < height) & (height < highest)
        x, y = section(triangles[cut], point, axis, levels[cut] - height)
        far: dict[ToothSide, np.ndarray] = {side: _farthest(x, y, side) for side in ("outer", "inner")}
        outer, inner = (_outline(far[side], side) for side in far)
        if outer is None or inner is None:
            found += [teeth for side in far if (teeth := _on_sector(far[side], side, height))]
            continue
        # a wheel without a bore has one outline, with the material inside; in bins on steep flanks its ends differ
        single = np.median(outer - inner) < 0.1 * np.ptp(outer)
        outlines: dict[ToothSide, np.ndarray] = {"outer": outer}
        if not single:
            outlines["inner"] = inner
        for side, radii in outlines.items():
            if teeth := _counted(radii, side, height) or _on_sector(far[side], side, height):
                found.append(teeth)
    return found


def section_heights(levels: Float[np.ndarray, "triangles 3"], between: tuple[float, float]) -> list[float]:
    """Choose heights between those of corners, where a section cuts triangles and does not touch them."""
    low, high = between
    if not high > low:
        return []
    slack = 1e-6 * (high - low)
    inside = levels[(levels > low) & (levels < high)]
    ordered = np.unique(np.concatenate([[low], inside, [high]]))
    apart = np.diff(ordered) > slack
    middles = ((ordered[:-1] + ordered[1:]) / 2)[apart]
    if len(middles) <= MAX_SECTIONS:
        return middles.tolist()
    wanted = np.linspace(low, high, MAX_SECTIONS + 2)[1:-1]
    return np.unique(middles[np.abs(middles[:, None] - wanted).argmin(axis=0)]).tolist()


def section(
    corners: Triangles,
    point: Points,
    axis: Points,
    above: Float[np.ndarray, "triangles 3"],
    along: Points | None = None,
) -> tuple[Float[np.ndarray, "segments 2"], Float[np.ndarray, "segments 2"]]:
    """Cut triangles by a plane across the axis: coordinates x, y of both ends of each segment, from the axis.

    `above` are heights of corners over the plane, which goes through all the triangles; x is along `along`, by default
    some direction across the axis.
    """
    ends = plane_cut(corners, above)
    along = np.eye(3)[np.argmin(np.abs(axis))] if along is None else along
    e1 = along - (along @ axis) * axis
    e1 /= np.linalg.norm(e1)
    e2 = np.cross(axis, e1)
    return (ends - point) @ e1, (ends - point) @ e2


def _counted(radii: Float[np.ndarray, " bins"], side: ToothSide, height: float) -> Teeth | None:
    """Count the teeth of an outline; None where it has none."""
    tip, root = np.quantile(radii, [0.99, 0.01])
    middle = (tip + root) / 2
    power = np.abs(np.fft.rfft(radii - radii.mean())) ** 2
    if not power.any():
        return None
    number = MIN_TEETH + int(np.argmax(power[MIN_TEETH : MAX_TEETH + 1]))
    pure = power[number::number].sum() > PURITY * power.sum()
    if not pure or not DEPTH[0] < (tip - root) * number / (2 * middle) < DEPTH[1]:
        return None
    return Teeth(number, side, float(middle), height, number)


def _farthest(
    x: Float[np.ndarray, "segments 2"], y: Float[np.ndarray, "segments 2"], side: ToothSide
) -> Float[np.ndarray, " bins"]:
    """Sample the largest distance (outer) of a section from the axis, or the smallest one (inner) times -1, by angle.

    -inf where there is no section.
    """
    far = np.full(BINS, -np.inf)
    if not len(x):
        return far
    # points on the segments, closer than the bins are: along a flank that is far from radial, equal steps are unequal
    # angles
    turn = np.abs(np.angle((x[:, 1] + 1j * y[:, 1]) * (x[:, 0] - 1j * y[:, 0])))
    count = np.minimum(np.ceil(POINTS * turn * BINS / (2 * np.pi)).astype(int) + 1, POINTS * BINS)
    px, py = along_segments(x, y, count)
    bins = ((np.arctan2(py, px) / (2 * np.pi) + 1.0) * BINS).astype(int) % BINS
    np.maximum.at(far, bins, (1.0 if side == "outer" else -1.0) * np.hypot(px, py))
    return far


def along_segments(
    x: Float[np.ndarray, "segments 2"], y: Float[np.ndarray, "segments 2"], count: np.ndarray
) -> tuple[Float[np.ndarray, " points"], Float[np.ndarray, " points"]]:
    """Sample segments evenly, each at as many points as `count` says."""
    segment = np.repeat(np.arange(len(x)), count)
    place = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
    share = (place + 0.5) / count[segment]
    px, py = (each[segment, 0] + share * (each[segment, 1] - each[segment, 0]) for each in (x, y))
    return px, py


def _outline(far: Float[np.ndarray, " bins"], side: ToothSide) -> Float[np.ndarray, " bins"] | None:
    """Complete the distances of `_farthest` over a full turn; None where the axis is outside, or the section open."""
    known = np.flatnonzero(np.isfinite(far))
    if len(known) < BINS // 2 or np.diff(np.append(known, known[0] + BINS)).max() > BINS // (2 * MIN_TEETH):
        return None
    return (1.0 if side == "outer" else -1.0) * np.interp(np.arange(BINS), known, far[known], period=BINS)


def _on_sector(far: Float[np.ndarray, " bins"], side: ToothSide, height: float) -> Teeth | None:
    """Count the teeth of a sector, and how many a full turn would have, from their distance; None where it has none.

    A sector has a whole number of teeth on a full turn, since it is a piece of a wheel.
    """
    sign = 1.0 if side == "outer" else -1.0
    turned = np.roll(far, -int(np.argmin(far)))  # begin where no teeth are
    tip = sign * float(far.max())

    def module_of(spacing: float, level: float) -> float:
        return sign * level * spacing / np.pi

    modules = 2 * tip / (np.geomspace(MIN_TEETH, MAX_TEETH, _CANDIDATES) + 2 * sign)
    row: ToothRow | None = row_of_teeth(turned, 2 * np.pi / BINS, modules, module_of) if np.isfinite(tip) else None
    if row is None:
        return None
    whole = 2 * np.pi / row.spacing
    number = round(whole)
    if not MIN_TEETH <= number <= MAX_TEETH or abs(whole - number) > _WHOLE:
        return None
    return Teeth(number, side, sign * row.level, height, row.count)
