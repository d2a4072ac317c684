"""Parts drawn as bars between their joints, for mechanisms that were written by hand and have no solids."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.figures import BallFigure, BoxFigure, CylinderFigure, Figure
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Transform
from jaxkin.geometry.triangles import Triangles
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.view.curve_figures import curve_figures

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_SLIMNESS = 0.03
"""Radius of a bar, the unit of all lengths below, over the distance of the farthest joint from the middle of all."""

_SLIMMER = 0.8
"""Radius of a bar of a fixed part over that of the others: a moving bar that passes over it hides it."""

_LAYER, _POST = 2.4, 1.1
"""Distance of two layers of parts, and radius of the posts between them."""


def stick_parts(mechanism: Mechanism) -> tuple[Part, ...]:
    """Make the parts of a mechanism as bars from joint to joint, with pins, rails and balls that show what the joints
    do.

    In world coordinates of the assembled pose and in the unit of the mechanism, in the order of `mechanism.parts`.
    Up to three joints of a part are linked pair by pair, more of them to their middle. Where all axes are parallel, the
    bodies lie in layers one above the other, fixed ones lowest, as in a linkage that one could build, unless there are
    solids, which lie where they are.
    """
    frames = _frames(mechanism)
    origins = np.array([pose[:3, 3] for poses in frames.values() for pose in poses])
    reach = float(np.linalg.norm(origins - origins.mean(axis=0), axis=-1).max())
    radius = _SLIMNESS * (reach or 1.0)
    moving = [parts for name, parts in mechanism.bodies.items() if name not in mechanism.fixed]
    layers = dict.fromkeys(mechanism.parts, 0.0)
    layers |= {part: _LAYER * layer for layer, parts in enumerate(moving, start=1) for part in parts}
    up = np.zeros(3) if any(part.is_solid for part in mechanism.solids) else _common_axis(mechanism)

    ends: dict[str, list[Float[np.ndarray, "3"]]] = {part: [] for part in mechanism.parts}
    pieces: dict[str, list[Triangles]] = {part: [] for part in mechanism.parts}
    for name, joint in mechanism.joints.items():
        if joint.evidence is not None and joint.evidence.kind is EvidenceKind.TARGET:
            continue  # nothing is there that could be drawn
        lower = min(layers[part] for part in joint.parts)
        for part, pose, index in zip(joint.parts, frames[name], (0, -1), strict=True):
            place = pose[:3, 3] / radius
            end = place + layers[part] * up
            pose[:3, 3] = place + lower * up
            figures = () if joint.curves else MOVEMENTS[joint.movements[index]].figures[index]
            pieces[part] += [_shape(shape, pose) for shape in figures]
            if np.any(end != pose[:3, 3]):
                pieces[part].append(_rod(pose[:3, 3], end, _POST))
            ends[part].append(end)
        if joint.curves:
            for part, drawn in zip(joint.parts, curve_figures(joint, radius), strict=True):
                pieces[part] += [triangles + layers[part] * up for triangles in drawn]
    for part, place in _marks(mechanism).items():
        ends[part].append(place / radius + layers[part] * up)
    for part in mechanism.parts:
        pieces[part] += _bars(ends[part], 1.0 if layers[part] else _SLIMMER)
    none = np.zeros((0, 3, 3))
    return tuple(Part(part, (), radius * np.concatenate([none, *pieces[part]])) for part in mechanism.parts)


def _frames(mechanism: Mechanism) -> dict[str, tuple[Transform, Transform]]:
    """Find for each joint the frame at its end of part 1 and that of part 2, copied.

    A fixed joint is nowhere in particular: it goes to the middle of the other joints of its parts, if they have any.
    """
    frames = {
        name: (np.array(joint.frames_1[0], float), np.array(joint.frames_2[-1], float))
        for name, joint in mechanism.joints.items()
    }
    somewhere = {name: joint for name, joint in mechanism.joints.items() if joint.freedoms}
    for name, joint in mechanism.joints.items():
        if name not in somewhere:
            near = [other for other, neighbour in somewhere.items() if set(joint.parts) & set(neighbour.parts)]
            places = [frames[other][0][:3, 3] for other in near or somewhere]
            middle = np.mean(places, axis=0) if places else np.zeros(3)
            first, second = frames[name]
            offset = np.linalg.solve(first, np.append(middle, 1.0))
            first[:3, 3], second[:3, 3] = middle, (second @ offset)[:3]
    return frames


def _marks(mechanism: Mechanism) -> dict[str, Float[np.ndarray, "3"]]:
    """Find where the file places parts of which it has no solid, and that no joint moves against another part, such as
    the tip of a robot: in the middle of what stands for each of them."""
    moved = {part for joint in mechanism.joints.values() if joint.freedoms for part in joint.parts}
    return {
        part.name: part.box.mean(axis=0) for part in mechanism.solids if not part.is_solid and part.name not in moved
    }


def _common_axis(mechanism: Mechanism) -> Float[np.ndarray, "3"]:
    """Find the direction of all axes of rotation if they are parallel, otherwise zero."""
    axes = [
        np.asarray(frame, float)[:3, element.axis]
        for joint in mechanism.joints.values()
        for movement, frame in zip(joint.movements, joint.frames_1, strict=True)
        for element in MOVEMENTS[movement].elements
        if element.kind != "translate"
    ]
    parallel = axes and all(np.linalg.norm(np.cross(axis, axes[0])) < 1e-6 for axis in axes)  # 1e-6: as drawn
    return axes[0] if parallel else np.zeros(3)


def _bars(ends: list[Float[np.ndarray, "3"]], radius: float) -> list[Triangles]:
    from trimesh.creation import icosphere

    points = _distinct(ends)
    if len(points) > 3:
        points = [np.mean(points, axis=0), *points]
        pairs = [(points[0], end) for end in points[1:]]
    else:
        pairs = list(combinations(points, 2))
    balls = [icosphere(subdivisions=2, radius=radius).triangles + point for point in points]
    return balls + [_rod(start, end, radius) for start, end in pairs]


def _rod(start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"], radius: float) -> Triangles:
    from trimesh.creation import cylinder

    return cylinder(radius=radius, segment=np.stack([start, end]), sections=24).triangles


def _distinct(points: list[Float[np.ndarray, "3"]]) -> list[Float[np.ndarray, "3"]]:
    """Keep the points without those that lie within the radius of an earlier one: a bar would have no length."""
    kept: list[np.ndarray] = []
    for point in points:
        if all(np.linalg.norm(point - other) > 1.0 for other in kept):
            kept.append(point)
    return kept


def _shape(shape: Figure, pose: Transform) -> Triangles:
    from trimesh.creation import box, cylinder, icosphere

    match shape:
        case CylinderFigure(axis, width, length):
            turn = np.eye(4)
            turn[:3, :3] = np.roll(np.eye(3), axis - 2, axis=0)  # z of the cylinder onto the axis, handedness kept
            return cylinder(width, length, sections=32, transform=pose @ turn).triangles
        case BoxFigure(extents):
            return box(extents=extents, transform=pose).triangles
        case BallFigure(width):
            return icosphere(subdivisions=3, radius=width).triangles + pose[:3, 3]
