"""Bores and pins: the round faces of a part, one for each axis, radius and side, with where they lie on the axis."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.outline import widest_gap
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Vector, cross
from jaxkin.geometry.surfaces import Cylinder

SAME_ANGLE = 1e-4
"""Radians between axes of one part that are one axis: what files in single precision leave of short faces."""
SAME_LENGTH = 1e-3
"""Over the radius: the same of their distance, and of radii."""
NEAR_ANGLE = 1e-3
"""Radians between axes of different parts that are meant to be one axis."""
NEAR_LENGTH = 0.01
"""Over the radius: the same of their distance."""
MAX_OPEN_ARC = np.deg2rad(200.0)
"""The widest gap around a bore that still holds what is in it: a half-shell with its tessellation. Fillets are open by
270 degrees."""
MIN_HALF_ARC = np.deg2rad(150.0)
"""The widest angle that a bore which is open by half leaves so, at least: it is tessellated by less than 30 degrees."""
MAX_HOLE_ARC = np.deg2rad(60.0)
"""The widest angle that a hole or a pin which goes all the way round leaves open, at most: holes are tessellated by
less, the end of a slot is open by half, and leaves its pin a stroke."""


@dataclass(frozen=True, eq=False)
class Bore:
    """Round faces of one part that have one axis, one radius and one side."""

    part: str
    faces: tuple[str, ...]
    point: Vector
    """On the axis, at the middle of the bore."""
    axis: Vector
    radius: float
    hole: bool
    """Whether the material is outside, as in a hole; otherwise the faces are those of a pin."""
    half: float
    """Half the length along the axis."""
    spans: tuple[tuple[float, float], ...]
    """Where the faces are along the axis, from `point`: two lugs of one part have one bore of two spans."""
    open_arc: float = 0.0
    """The widest angle about the axis that the faces leave open, radians."""

    @property
    def is_half_open(self) -> bool:
        """Whether half of the way around the axis is open, as in a groove or a half-shell."""
        return bool(self.open_arc >= MIN_HALF_ARC)

    def on_axis_of(self, other: Bore, angle: float = NEAR_ANGLE, length: float = NEAR_LENGTH) -> bool:
        """Tell whether the axis is that of another bore, within `angle` (radians) and `length` (over the other's
        radius)."""
        offset = self.point - other.point
        if np.linalg.norm(offset - (offset @ other.axis) * other.axis) > length * other.radius:
            return False  # before the costlier cross product
        return bool(np.linalg.norm(cross(self.axis, other.axis)) <= angle)

    def reach(self, along: Vector) -> tuple[float, float]:
        """Find where the bore begins and ends, along a direction that is parallel to its axis."""
        middle = float(self.point @ along)
        return middle - self.half, middle + self.half

    def spans_along(self, along: Vector) -> tuple[tuple[float, float], ...]:
        """Find the spans along a direction that is parallel to its axis, from the origin."""
        middle, way = float(self.point @ along), 1.0 if self.axis @ along > 0 else -1.0
        spans = ((middle + way * low, middle + way * high) for low, high in self.spans)
        return tuple((min(span), max(span)) for span in spans)


def near_axis(points: Float[np.ndarray, "points 3"], axis: Bore) -> list[int]:
    """Find which points are on the axis of a bore, to `NEAR_LENGTH` over its radius: of a plate with hundreds of holes
    all at once, in place of one after another."""
    offsets = points - axis.point
    away = offsets - np.outer(offsets @ axis.axis, axis.axis)
    return np.flatnonzero(np.linalg.norm(away, axis=1) <= NEAR_LENGTH * axis.radius).tolist()


def bores(part: Part) -> list[Bore]:
    """Find the bores and pins of a part; faces that go round by less than a half-shell together are left out."""
    groups: list[tuple[Cylinder, list[Face]]] = []
    for face in part.faces:
        surface = face.surface
        if isinstance(surface, Cylinder):
            group = next((faces for first, faces in groups if _same(first, surface)), None)
            if group is None:
                groups.append((surface, [face]))
            else:
                group.append(face)
    found = [_bore(part.name, surface, faces) for surface, faces in groups]
    return [bore for bore in found if bore is not None]


def _same(one: Cylinder, other: Cylinder) -> bool:
    if one.side != other.side or abs(one.radius - other.radius) > SAME_LENGTH * one.radius:
        return False
    offset = other.point - one.point
    along = float(offset @ one.axis)
    if float(offset @ offset) - along**2 > (SAME_LENGTH * one.radius) ** 2:  # before the costlier cross product
        return False
    return bool(np.linalg.norm(cross(one.axis, other.axis)) <= SAME_ANGLE)


def _bore(part: str, surface: Cylinder, faces: Sequence[Face]) -> Bore | None:
    corners = np.concatenate([face.triangles for face in faces]).reshape(-1, 3) - surface.point
    along = corners @ surface.axis
    open_arc = _open_arc(corners, surface.axis)
    if open_arc > MAX_OPEN_ARC:
        return None
    low, high = float(along.min()), float(along.max())
    middle = (low + high) / 2
    point = surface.point + middle * surface.axis
    heights = along.reshape(-1, 3) - middle
    spans = zip(heights.min(axis=1), heights.max(axis=1), strict=True)  # a face may be in two lugs, a triangle not
    names = tuple(face.name for face in faces)
    return Bore(
        part,
        names,
        point,
        surface.axis,
        surface.radius,
        surface.side < 0,
        (high - low) / 2,
        merged(spans, SAME_LENGTH * surface.radius),
        open_arc,
    )


def _open_arc(corners: Float[np.ndarray, "corners 3"], axis: Vector) -> float:
    """Measure the widest angle about an axis through the origin in which there is no corner, radians."""
    x = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    return widest_gap(np.arctan2(corners @ np.cross(axis, x), corners @ x))


def merged(spans: Iterable[tuple[float, float]], apart: float = 0.0) -> tuple[tuple[float, float], ...]:
    """Unite spans that overlap or are no farther than `apart` from each other."""
    result: list[tuple[float, float]] = []
    for low, high in sorted((float(low), float(high)) for low, high in spans):
        if result and low <= result[-1][1] + apart:
            result[-1] = result[-1][0], max(high, result[-1][1])
        else:
            result.append((low, high))
    return tuple(result)


def shared(one: Sequence[tuple[float, float]], other: Sequence[tuple[float, float]]) -> float:
    """Measure the length that two sets of spans share; where there is none, less the least gap between them."""
    lengths = [min(high1, high2) - max(low1, low2) for low1, high1 in one for low2, high2 in other]
    return sum(length for length in lengths if length > 0) or max(lengths)
