"""Wheels with teeth in mesh, and their shafts: they turn in a plate, also where they have the form of a fastener."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.fasteners import parallel
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import SAME_FIT
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.teeth import Teeth, find_teeth

LEAST_TEETH = 8
"""Teeth of a wheel, at least: heads of screws have six sides, and few pinions have fewer teeth."""

SAME_MODULE = 0.25
"""Difference of the modules of two wheels that mesh, over the module, at most: pitch radii are measured halfway between
tips and roots, and profiles are shifted."""
IN_MESH = 0.5
"""Distance of the axes of two wheels that mesh less the sum of their pitch radii, over the module, at most."""


def meshing_wheels(known: Known, fastening: Collection[str]) -> set[str]:
    """Find the parts with play in all their holes that have teeth about their axis which mesh with those of another
    part, or are one body with a part that has: wheels and their shafts turn there.

    What fits a hole exactly may be pressed in.
    """
    body, result = known.body, set()
    for name in fastening:
        pairs = [pair for pair in known.axes if not pair.virtual and pair.one.part == name]
        if not pairs or any(pair.clearance <= SAME_FIT * pair.other.radius for pair in pairs):
            continue
        pin = pairs[0].one
        for part in (part for part in known.parts if body[part.name] == body[name]):
            wheel = outer_teeth(part, pin.point, pin.axis)
            if wheel is not None and any(_meshes(known, pin, wheel, each) for each in known.measured.beside(part)):
                result.add(name)
    return result


def _meshes(known: Known, pin: Bore, wheel: Teeth, other: Part) -> bool:
    """Tell whether another part has teeth that mesh with a wheel, about the axis of a bore or pin of its body that is
    parallel to that of the wheel."""
    module = 2 * wheel.pitch_radius / wheel.number
    mates = [part for part in known.names if known.body[part] == known.body[other.name]]
    for bore in (bore for part in mates for bore in known.bores[part] if parallel(bore, pin)):
        offset = bore.point - pin.point
        apart = float(np.linalg.norm(offset - (offset @ pin.axis) * pin.axis))
        if apart <= wheel.pitch_radius:
            continue
        teeth = outer_teeth(other, bore.point, bore.axis)
        if teeth is None or abs(2 * teeth.pitch_radius / teeth.number - module) > SAME_MODULE * module:
            continue
        if abs(wheel.pitch_radius + teeth.pitch_radius - apart) <= IN_MESH * module:
            return True
    return False


def outer_teeth(part: Part, point: Vector, axis: Vector) -> Teeth | None:
    """Find the outer teeth of a part about an axis, most often one rim."""
    exact = sum(len(face.triangles) for face in part.faces) == len(part.triangles)
    if exact and len(part.faces) < 2 * LEAST_TEETH:
        return None
    levels = part.outermost @ axis
    found = find_teeth(part.triangles, point, axis, (float(levels.min()), float(levels.max())))
    return next((each for each in found if each.side == "outer" and each.counted >= LEAST_TEETH), None)
