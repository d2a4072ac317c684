"""Wheels with teeth in mesh, and their shafts: they turn in a plate, also where they have the form of a fastener."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

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

    What fits a hole exactly may be pressed in, but for a pinion that meshes with a wheel or a ring which has play
    about its own axis: that is there to turn, and could not.
    """
    body, result = known.body, set()
    axes = [pair for pair in known.axes if not pair.virtual]
    loose = [pair for pair in axes if pair.clearance > SAME_FIT * pair.other.radius]
    for name in fastening:
        pairs = [pair for pair in axes if pair.one.part == name]
        if not pairs:
            continue
        pin, others = pairs[0].one, known.bores
        if not all(pair in loose for pair in pairs):
            others = {
                part: [bore for pair in loose for bore in (pair.one, pair.other) if bore.part == part]
                for part in known.names
            }
        for part in (part for part in known.parts if body[part.name] == body[name]):
            wheel = outer_teeth(part, pin.point, pin.axis)
            if wheel is not None and any(
                _meshes(known, pin, wheel, each, others) for each in known.measured.beside(part)
            ):
                result.add(name)
    return result


def _meshes(known: Known, pin: Bore, wheel: Teeth, other: Part, bores: Mapping[str, Sequence[Bore]]) -> bool:
    """Tell whether another part has teeth that mesh with a wheel, about the axis of one of the `bores` of its body that
    is parallel to that of the wheel: outer ones, or inner ones of a ring, whose bearing is wider than the wheel."""
    module = 2 * wheel.pitch_radius / wheel.number
    mates = [part for part in known.names if known.body[part] == known.body[other.name]]
    for bore in (bore for part in mates for bore in bores[part] if parallel(bore, pin)):
        offset = bore.point - pin.point
        apart = float(np.linalg.norm(offset - (offset @ pin.axis) * pin.axis))
        for side, sign in (("outer", 1), ("inner", -1)):
            if (apart if side == "outer" else bore.radius) <= wheel.pitch_radius:
                continue
            teeth = _teeth(other, bore.point, bore.axis, side)
            if teeth is None or abs(2 * teeth.pitch_radius / teeth.number - module) > SAME_MODULE * module:
                continue
            if abs(teeth.pitch_radius + sign * wheel.pitch_radius - apart) <= IN_MESH * module:
                return True
    return False


def outer_teeth(part: Part, point: Vector, axis: Vector) -> Teeth | None:
    """Find the outer teeth of a part about an axis, most often one rim."""
    return _teeth(part, point, axis, "outer")


def _teeth(part: Part, point: Vector, axis: Vector, side: str) -> Teeth | None:
    """Find the teeth of a part about an axis that stand out from a rim, or into a ring."""
    exact = sum(len(face.triangles) for face in part.faces) == len(part.triangles)
    if exact and len(part.faces) < 2 * LEAST_TEETH:
        return None
    levels = part.outermost @ axis
    found = find_teeth(part.triangles, point, axis, (float(levels.min()), float(levels.max())))
    return next((each for each in found if each.side == side and each.counted >= LEAST_TEETH), None)
