"""Assemblies drawn with library parts, and the joints that they were built with: what all drawings here share."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from bd_warehouse.fastener import HexHeadScrew, HexNut, PlainWasher
from build123d import Circle, Compound, Cylinder, Plane, Pos, SlotCenterToCenter, export_step, extrude

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
BACK, DOWN = (-1.0, 0.0, 0.0), (0.0, 0.0, -1.0)
METRE = 1e-3
"""Metres in a millimetre: drawings are in millimetres, labels in metres."""

Vec = Sequence[float] | np.ndarray
Solid = Any
"""A part or an assembly of build123d, which types its operators loosely."""


class Drawing:
    """An assembly, the parts that it is fixed by, and its joints.

    Labels name one part of each body; `freedoms` are the motions that the designer meant, without rollers, rings
    and fasteners that turn idly.
    """

    def __init__(self, name: str, fixed: Sequence[str], freedoms: int) -> None:
        self.name, self.fixed, self.freedoms = name, fixed, freedoms
        self.solids: list[Solid] = []
        self.joints: list[dict[str, Any]] = []

    def add(self, name: str, solid: Solid, at: Vec = (0, 0, 0), along: Vec = Z, x: Vec | None = None) -> None:
        """Place a solid that was drawn at the origin along z: its origin comes to `at`, its z axis to `along`."""
        placed = Plane(origin=tuple(at), x_dir=None if x is None else tuple(x), z_dir=tuple(along)).location * solid
        placed.label = name
        self.solids.append(placed)

    def label(self, kind: str, first: str, second: str, point: Vec = (0, 0, 0), axis: Vec = Z) -> None:
        """Note the joint that two parts were built with, about an axis through a point."""
        unit = np.array(axis, float) / np.linalg.norm(axis)
        side = {"point": [METRE * float(each) for each in point], "axis": unit.tolist()}
        ends = {key: {"part": part, **side} for key, part in (("a", first), ("b", second))}
        self.joints.append({"type": kind, "name": f"{first} - {second}", **ends})

    def weld(self, host: str, *others: str) -> None:
        """Note parts that do not move on another one."""
        for other in others:
            self.label("Weld", host, other)

    def bolt(
        self,
        name: str,
        size: str,
        at: Vec,
        along: Vec,
        grip: float,
        *,
        screw: Callable[..., Solid] = HexHeadScrew,
        nut: Callable[..., Solid] = HexNut,
        length: float | None = None,
    ) -> None:
        """Add a screw with its nut, and a washer under each, in millimetres.

        The head points along an axis. `at` is where the upper washer stands, and `grip` the length between the
        washers; the screw reaches through its nut if no `length` is given.
        """
        unit, diameter = np.array(along, float), float(size[1:].split("-")[0])
        washer, under = (PlainWasher(f"M{diameter:g}", "iso7089") for _ in range(2))
        thickness = washer.bounding_box().size.Z
        through = 5 * float(np.ceil((grip + 2 * thickness + 1.3 * diameter) / 5))
        self.add(f"{name} washer", washer, at, along)
        self.add(f"{name} nut washer", under, at - grip * unit, -unit)
        self.add(f"{name} screw", screw(size, length=length or through), at + thickness * unit, along)
        self.add(f"{name} nut", nut(size), at - (grip + thickness) * unit, -unit)

    def write(self, folder: Path) -> None:
        """Write NAME.step and NAME.joints.json."""
        if not export_step(Compound(label=self.name, children=self.solids), folder / f"{self.name}.step"):
            raise OSError(f"could not write {folder / self.name}.step")
        instances = [{"name": each.label, "grounded": each.label in self.fixed} for each in self.solids]
        truth = {
            "source": {"by": "benchmarks/library_parts", "using": "build123d, bd_warehouse"},
            "units": "metre, world of the assembly",
            "instances": instances,
            "freedoms": self.freedoms,
            "joints": self.joints,
        }
        (folder / f"{self.name}.joints.json").write_text(json.dumps(truth, indent=1) + "\n")


def holed(plate: Solid, holes: Iterable[tuple[float, float, float]], depth: float, z: float = 0.0) -> Solid:
    """Drill holes (x, y, radius) along z, from z upwards by a depth."""
    for x, y, radius in holes:
        plate -= Pos(x, y, z + depth / 2) * Cylinder(radius, depth)
    return plate


def bar(length: float, width: float, thickness: float, *holes: tuple[float, float]) -> Solid:
    """Draw a bar along x from the origin with round ends and holes (x, radius); its thickness is along z."""
    plate = extrude(Pos(length / 2, 0) * SlotCenterToCenter(length, width), amount=thickness)
    return holed(plate, [(x, 0.0, radius) for x, radius in holes], thickness)


def ring(outer: float, inner: float, length: float) -> Solid:
    """Draw a sleeve along z from the origin, by its radii."""
    return holed(rod(outer, length), [(0, 0, inner)], length)


def rod(radius: float, length: float) -> Solid:
    """Draw a round rod along z from the origin."""
    return extrude(Circle(radius), amount=length)


def towards(start: Vec, end: Vec) -> tuple[float, tuple[float, float, float]]:
    """Tell the distance between two points and the unit vector from the one to the other."""
    offset = np.subtract(end, start).astype(float)
    length = float(np.linalg.norm(offset))
    x, y, z = offset / length
    return length, (float(x), float(y), float(z))


def meet(first: Vec, second: Vec, r1: float, r2: float, side: int = 1) -> tuple[float, float]:
    """Find where two circles in the plane meet: on the left of the line from first to second if side is 1."""
    length, (ux, uy, _) = towards((*first[:2], 0), (*second[:2], 0))
    along = (r1**2 - r2**2 + length**2) / (2 * length)
    up = side * (r1**2 - along**2) ** 0.5
    return first[0] + along * ux - up * uy, first[1] + along * uy + up * ux


def write_all(makers: Iterable[Callable[[], Drawing]], folder: Path, names: Sequence[str]) -> None:
    """Draw mechanisms, all or those named, and write their files; say what is wrong where a name is not known."""
    known = {make.__name__: make for make in makers}
    if unknown := [name for name in names if name not in known]:
        raise SystemExit(f"no drawing is named {', '.join(unknown)}; there are {', '.join(known)}")
    folder.mkdir(parents=True, exist_ok=True)
    for name in names or known:
        known[name]().write(folder)
        print(name, flush=True)
