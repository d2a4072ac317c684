"""What is measured of the solids of an assembly: once, whatever is then fixed, left out or said of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from jaxtyping import Float

from jaxkin.assembly.inference.axes import CommonAxis, common_axes, far_axes
from jaxkin.assembly.inference.bearings import Bearing, Ring, bearings
from jaxkin.assembly.inference.bores import Bore, bores
from jaxkin.assembly.inference.closed_bearings import closed_bearings
from jaxkin.assembly.inference.embedded import depth_inside
from jaxkin.assembly.inference.linear_bearings import linear_bearings
from jaxkin.assembly.inference.slotted_pins import SlottedPin, slotted_pins
from jaxkin.assembly.inference.solid_motors import SolidMotor, solid_motors
from jaxkin.assembly.inference.stop_faces import StopFace, slanted_stops, stops
from jaxkin.contacts.tolerance import default_length
from jaxkin.geometry.part import Part

CORNERS = 12
"""Corners of a part, the nearest to the box of the other one, from which distances are measured."""


class Measured:
    """Solids with what was measured of them so far: several mechanisms are tried for one assembly."""

    def __init__(self, parts: Sequence[Part], metre: float = 1e-3) -> None:
        """Take the parts; `metre` is one unit of their lengths in metres."""
        self.parts, self._metre = tuple(parts), metre
        self._axes: dict[float | None, list[CommonAxis]] = {}
        self._slotted: dict[float | None, list[SlottedPin]] = {}
        self._stops: dict[tuple[str, int], list[StopFace]] = {}
        self._slanted: dict[tuple[str, int], list[StopFace]] = {}
        self._inside: dict[tuple[str, str, float], float] = {}
        self._middles: dict[str, Float[np.ndarray, "bores 3"]] = {}
        self._distances: dict[frozenset[str], float] = {}

    @cached_property
    def bores(self) -> dict[str, list[Bore]]:
        """Bores and pins of each part."""
        return {part.name: bores(part) for part in self.parts}

    def middles(self, part: str) -> Float[np.ndarray, "bores 3"]:
        """Give the middles of the bores and pins of a part."""
        if part not in self._middles:
            self._middles[part] = np.array([bore.point for bore in self.bores[part]]).reshape(-1, 3)
        return self._middles[part]

    @cached_property
    def bearings(self) -> list[Bearing]:
        """Bearings among the parts: see `bearings`."""
        return bearings(self.parts, self.bores)

    @cached_property
    def closed_bearings(self) -> list[Ring]:
        """Bearings that are one part each: see `closed_bearings`."""
        taken = {name for each in self.bearings for name in (each.outer, each.inner, *each.between)}
        return [each for each in closed_bearings(self.parts, self.bores, self._metre) if each.part.name not in taken]

    @cached_property
    def linear_bearings(self) -> set[str]:
        """Linear ball bearings that are one part each: see `linear_bearings`."""
        return linear_bearings(self.parts, self.bores, self._metre)

    @cached_property
    def motors(self) -> list[SolidMotor]:
        """Motors that are one part with their shaft: see `solid_motors`."""
        return solid_motors(self.parts, self.bores, self._metre)

    def axes(self, clearance: float | None) -> list[CommonAxis]:
        """Find the common axes of different parts: see `common_axes`."""
        if clearance not in self._axes:
            self._axes[clearance] = common_axes([bore for own in self.bores.values() for bore in own], clearance)
        return self._axes[clearance]

    @cached_property
    def far_axes(self) -> list[CommonAxis]:
        """Axes of parts that nothing else ties: see `far_axes`."""
        return far_axes([bore for own in self.bores.values() for bore in own], self.axes(None))

    def slotted_pins(self, clearance: float | None) -> list[SlottedPin]:
        """Find the pins with play in slots: see `slotted_pins`."""
        if clearance not in self._slotted:
            self._slotted[clearance] = slotted_pins(self.parts, self.bores, self.beside, clearance)
        return self._slotted[clearance]

    @cached_property
    def boxes(self) -> Float[np.ndarray, "parts 2 3"]:
        """Lowest and highest corner of each part."""
        return np.stack([part.box for part in self.parts])

    @cached_property
    def _touching(self) -> float:
        """Distance of boxes that touch but for rounding."""
        return default_length(self.parts)

    def beside(self, part: Part) -> list[Part]:
        """Find the other parts whose boxes overlap or touch that of a part."""
        low, high = part.box[0] - self._touching, part.box[1] + self._touching
        meet = np.all((self.boxes[:, 0] <= high) & (low <= self.boxes[:, 1]), axis=1)
        return [self.parts[index] for index in np.flatnonzero(meet) if self.parts[index] is not part]

    def stops(self, part: Part, axis: Bore) -> list[StopFace]:
        """Find the plane faces of a part that stand across the axis of a bore among `bores`, near to it."""
        key = part.name, id(axis)  # no other bore gets its number: those of `bores` live as long
        if key not in self._stops:
            self._stops[key] = stops(part, axis)
        return self._stops[key]

    def slanted_stops(self, part: Part, axis: Bore) -> list[StopFace]:
        """Find what else of a part stops slides along the axis of a bore among `bores`: see `slanted_stops`."""
        key = part.name, id(axis)
        if key not in self._slanted:
            self._slanted[key] = slanted_stops(part, axis)
        return self._slanted[key]

    def depth_inside(self, part: Part, other: Part, widest: float = np.inf) -> float:
        """Measure the length of the pins of a part, of radii up to `widest`, that lies in the material of another
        one."""
        key = part.name, other.name, widest
        if key not in self._inside:
            pins = [bore for bore in self.bores[part.name] if not bore.hole and bore.radius <= widest]
            self._inside[key] = float(sum(depth_inside(pin, other) for pin in pins))
        return self._inside[key]

    def distance(self, one: Part, other: Part) -> float:
        """Measure the distance between two parts: of some corners of either from the triangles of the other."""
        key = frozenset((one.name, other.name))
        if key not in self._distances:
            self._distances[key] = min(_from_corners(one, other), _from_corners(other, one))
        return self._distances[key]


def _from_corners(one: Part, other: Part) -> float:
    from trimesh.triangles import closest_point

    corners = one.triangles.reshape(-1, 3)
    away = np.linalg.norm(np.maximum(np.maximum(other.box[0] - corners, corners - other.box[1]), 0.0), axis=1)
    corners = corners[np.argsort(away, kind="stable")[:CORNERS]]
    triangles = np.repeat(other.triangles[None], len(corners), axis=0).reshape(-1, 3, 3)
    points = np.repeat(corners, len(other.triangles), axis=0)
    return float(np.linalg.norm(closest_point(triangles, points) - points, axis=1).min())
