"""Parts drawn as bars between their joints, for mechanisms that were written by hand and have no solids."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Pose

if TYPE_CHECKING:
    from jaxkin.motion.mechanism import Mechanism

_SLIMNESS = 0.014
"""Radius of a bar over the diagonal of the box around all joints."""

Triangles = Float[np.ndarray, "triangles 3 3"]


class _Round(NamedTuple):
    """A cylinder centred on a joint, along an axis of its frame; lengths in radii of a bar."""

    axis: int
    radius: float
    length: float


class _Block(NamedTuple):
    """A block centred on a joint, with its edges along the axes of the frame; lengths in radii of a bar."""

    extents: tuple[float, float, float]


class _Ball(NamedTuple):
    radius: float


_Shape = _Round | _Block | _Ball

_ROD = _Round(2, 0.7, 36.0)
"""Half as long as the mechanism, since the joint does not know how far it will slide."""

_SHAPES: dict[str, tuple[tuple[_Shape, ...], tuple[_Shape, ...]]] = {
    "I": ((), ()),
    "T_z": ((_ROD,), (_Block((3.6, 3.6, 6.0)),)),
    "T_phi": ((_Round(2, 2.0, 2.4),), (_Round(2, 1.2, 4.4),)),
    "T_screw": ((_ROD,), (_Round(2, 2.4, 3.0),)),
    "T_z_phi": ((_ROD,), (_Round(2, 1.6, 6.0),)),
    "T_xy_phi": ((_Block((18.0, 18.0, 0.8)),), (_Round(2, 3.0, 1.8),)),
    "T_theta_phi": ((_Round(1, 0.9, 6.0),), (_Round(0, 0.8, 6.0),)),
    "T_theta_phi_psi": ((_Round(2, 1.8, 2.0),), (_Ball(2.2),)),
}
"""What a movement looks like on the side of part 1 (bearing, rail, plate) and of part 2 (pin, slider, puck, ball)."""


def stick_parts(mechanism: Mechanism) -> tuple[Part, ...]:
    """The parts of a mechanism as bars from joint to joint, with pins, rails and balls that show what the joints do.

    In world coordinates of the assembled pose and in the unit of the mechanism, in the order of `mechanism.parts`.
    Up to three joints of a part are linked pair by pair, more of them to their middle.
    """
    ends: dict[str, list[tuple[Pose, tuple[_Shape, ...]]]] = {part: [] for part in mechanism.parts}
    for joint in mechanism.joints.values():
        first, second = joint.parts
        ends[first].append((np.asarray(joint.before[0], float), _SHAPES[joint.movements[0]][0]))
        ends[second].append((np.asarray(joint.after[-1], float), _SHAPES[joint.movements[-1]][1]))
    origins = np.array([pose[:3, 3] for part in ends.values() for pose, _ in part])
    radius = _SLIMNESS * (float(np.linalg.norm(np.ptp(origins, axis=0))) or 1.0)
    return tuple(Part(part, (), _sticks(ends[part], radius)) for part in mechanism.parts)


def _sticks(ends: list[tuple[Pose, tuple[_Shape, ...]]], radius: float) -> Triangles:
    from trimesh.creation import cylinder, icosphere

    origins = _distinct(np.array([pose[:3, 3] for pose, _ in ends]), radius)
    if len(origins) > 3:
        origins = np.vstack([origins.mean(axis=0), origins])
        bars = [(0, end) for end in range(1, len(origins))]
    else:
        bars = [(start, end) for end in range(len(origins)) for start in range(end)]
    pieces = [icosphere(subdivisions=2, radius=radius).triangles + origin for origin in origins]
    for start, end in bars:
        pieces.append(cylinder(radius=radius, segment=origins[[start, end]], sections=24).triangles)
    pieces += [_shape(shape, pose, radius) for pose, shapes in ends for shape in shapes]
    return np.concatenate(pieces)


def _distinct(points: Float[np.ndarray, "points 3"], distance: float) -> Float[np.ndarray, "distinct 3"]:
    """The points without those that lie within the distance of an earlier one: a bar would have no length."""
    kept: list[np.ndarray] = []
    for point in points:
        if all(np.linalg.norm(point - other) > distance for other in kept):
            kept.append(point)
    return np.array(kept)


def _shape(shape: _Shape, pose: Pose, radius: float) -> Triangles:
    from trimesh.creation import box, cylinder, icosphere

    match shape:
        case _Round(axis, width, length):
            turn = np.eye(4)
            turn[:3, :3] = np.roll(np.eye(3), axis - 2, axis=0)  # z of the cylinder onto the axis, handedness kept
            return cylinder(radius * width, radius * length, sections=32, transform=pose @ turn).triangles
        case _Block(extents):
            return box(extents=radius * np.array(extents), transform=pose).triangles
        case _Ball(width):
            return icosphere(subdivisions=3, radius=radius * width).triangles + pose[:3, 3]
