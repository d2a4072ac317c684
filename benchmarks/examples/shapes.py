"""Shapes that the drawn assemblies share, and how they are placed and written."""

from __future__ import annotations

import re
from pathlib import Path

import cadquery as cq
import numpy as np

from jaxkin.geometry.pose import Transform

SLATE, CORAL, OCEAN, AMBER = "#AEB8C2", "#E4572E", "#2A7FB8", "#F0A830"


def bar(length: float, ends: tuple[float, float], thickness: float) -> cq.Workplane:
    """A bar along x with round ends about 0 and `length`, of the two radii, joined by their common tangents."""
    sin = (ends[0] - ends[1]) / length
    normal = np.array([sin, np.sqrt(1 - sin**2)])
    up, down = normal, normal * [1, -1]
    start, end = ends[0] * up, [length, 0] + ends[1] * up
    return (
        cq.Workplane()
        .moveTo(*start)
        .lineTo(*end)
        .threePointArc((length + ends[1], 0), tuple([length, 0] + ends[1] * down))
        .lineTo(*(ends[0] * down))
        .threePointArc((-ends[0], 0), tuple(start))
        .close()
        .extrude(thickness)
    )


def swing_link(length: float, thickness: float, hole: float, radius: float, ends: tuple[float, float]) -> cq.Workplane:
    """A bar with a hole at 0 and at `length` a pin that stands one unit out of a second bar laid on top."""
    link = bar(length, ends, thickness).cut(holes([(0, 0)], hole, thickness))
    return link.union(pin(length, 0, radius, thickness, 2 * thickness + 1))


def pin(x: float, y: float, radius: float, low: float, high: float, chamfer: float = 0.8) -> cq.Workplane:
    solid = cq.Workplane(origin=(x, y, low)).circle(radius).extrude(high - low)
    return solid.faces(">Z").chamfer(chamfer) if chamfer else solid


def holes(centres: list[tuple[float, float]], radius: float, height: float) -> cq.Workplane:
    return cq.Workplane().pushPoints(centres).circle(radius).extrude(height)


def plate(x0: float, x1: float, y0: float, y1: float, thickness: float) -> cq.Workplane:
    """A plate with rounded corners whose top is z = 0."""
    solid = cq.Workplane().box(x1 - x0, y1 - y0, thickness, centered=False).edges("|Z").fillet(12)
    return solid.translate((x0, y0, -thickness))


def meet(p: np.ndarray, r_p: float, q: np.ndarray, r_q: float) -> np.ndarray:
    """The point at distance r_p from p and r_q from q, left of the direction from p to q: the open branch."""
    distance = np.linalg.norm(q - p)
    along = (q - p) / distance
    x = (distance**2 + r_p**2 - r_q**2) / (2 * distance)
    return p + x * along + np.sqrt(r_p**2 - x**2) * np.cross([0, 0, 1], along)


def assembly(name: str, placement: Transform, parts: dict[str, tuple[cq.Workplane, str, Transform]]) -> cq.Assembly:
    assembly = cq.Assembly(name=name)
    for part, (solid, color, pose) in parts.items():
        world = placement @ pose
        plane = cq.Plane(tuple(world[:3, 3]), tuple(world[:3, 0]), tuple(world[:3, 2]))
        assembly.add(solid, name=part, color=cq.Color(color), loc=cq.Location(plane))
    return assembly


def write(assembly: cq.Assembly, path: Path, *, parameter_curves: bool = True) -> None:
    """Write a STEP file without the time of day, which the kernel puts into the header.

    `parameter_curves` repeats every edge in the parameters of its faces: nothing needs that, and files without it are
    half as large.
    """
    assembly.export(str(path), write_pcurves=parameter_curves)
    text = re.sub(r"FILE_NAME\('[^']*','[^']*'", f"FILE_NAME('{path.name}','2025-01-01T00:00:00'", path.read_text())
    path.write_text(text)
