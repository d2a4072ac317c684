"""Tell which loop groups are planar, and which loops turn about one direction or point (host code, numbers only).

A loop whose joints generate a displacement subgroup needs as many equations as the subgroup has dimensions:

- planar: all joints turn about one direction or slide at right angles to it; three equations;
- Schoenflies: all joints turn about one direction or slide in any; four equations;
- spherical: all joints turn, about axes through one point; three equations.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from jaxkin._traced import traced
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.joint import Joint

ALIGNED = 1e-12
"""Largest sine of the angle between directions that count as parallel, cosine of that between perpendicular ones, and
distance of points that count as one over the size of the loops: rounding, since frames with the noise of files are
aligned before (`mobility.alignment`)."""


def plane_columns(joints: Sequence[Joint]) -> tuple[int, ...] | None:
    """Find the columns of the coordinates that act in one plane; None where there is no such plane.

    Columns are numbered from 0 through all coordinates of `joints`. Translations along the normal are allowed and left
    out: they commute with all other motions, and rest. Where frames of a joint on its two parts differ along the
    normal, because lengths were changed, such translations may be needed, and the loops count as spatial (None).
    """
    if traced(joints) or (axes := elementary_axes(joints)) is None:
        return None
    turning, sliding = axes
    if not _one_direction(turning):
        return None
    normal = turning[0][1]
    inside = [column for column, *_ in turning]
    for column, *axes in sliding:
        if np.all(np.abs(np.array(axes) @ normal) <= ALIGNED):
            inside.append(column)
        elif np.any(np.linalg.norm(np.cross(axes, normal), axis=-1) > ALIGNED):
            return None
    return tuple(sorted(inside)) if level(joints, normal) else None


def level(joints: Sequence[Joint], normal: np.ndarray) -> bool:
    """Tell whether no joint has its frames on its two parts apart along a normal, as changes of lengths leave them."""
    origins = np.concatenate([side[:, :3, 3] for joint in joints for side in (joint.frames_1, joint.frames_2)])
    shifts = [(np.asarray(joint.frames_1) - np.asarray(joint.frames_2))[:, :3, 3] @ normal for joint in joints]
    return bool(np.max(np.abs(np.concatenate(shifts))) <= ALIGNED * np.ptp(origins, axis=0).max(initial=0.0))


def normal_of_turns(joints: Sequence[Joint], columns: Sequence[int]) -> Any:
    """Return the axis of the first turn among some columns, on part 1 of its joint (3,), traced where that is traced.

    Columns are numbered from 0 through all coordinates of `joints`. Of the columns of a plane it is the normal.
    """
    column = 0
    for joint in joints:
        for frame, name in enumerate(joint.movements):
            for element in MOVEMENTS[name].elements:
                if element.kind == "rotate" and column + element.coordinate in columns:
                    return joint.frames_1[frame][:3, element.axis]
            column += len(MOVEMENTS[name].coordinates)
    raise ValueError("no coordinate of a plane turns")


def turn_about_one_direction(joints: Sequence[Joint]) -> bool:
    """Tell whether all rotations of the joints are about one direction; False where the frames are traced."""
    axes = None if traced(joints) else elementary_axes(joints)
    return axes is not None and _one_direction(axes[0])


def turn_about_one_point(joints: Sequence[Joint]) -> bool:
    """Tell whether all joints turn about axes through one point, without translations; False where frames are traced.

    The axes of each joint on part 1 and on part 2 both count. Along both axes the point must be equally far from the
    origin of the frame, so that it is one point of both parts however far the joint turns. Joints whose axes all have
    one direction are not spherical but planar.
    """
    axes = None if traced(joints) else elementary_axes(joints)
    if axes is None or not axes[0] or axes[1] or _one_direction(axes[0]):
        return False
    turning, _ = axes
    sides = np.array([[first, second] for _, first, second in turning]).reshape(-1, 3)
    places = np.concatenate([_origins(joint) for joint in joints])
    places = places - places[0]
    size = np.ptp(places, axis=0).max(initial=0.0)
    across = np.eye(3) - sides[:, :, None] * sides[:, None]
    centre = np.linalg.lstsq(across.sum(axis=0), np.einsum("aij,aj->i", across, places), rcond=None)[0]
    off = np.linalg.norm(np.einsum("aij,aj->ai", across, centre - places), axis=1)
    along = np.einsum("ai,ai->a", sides, centre - places).reshape(-1, 2)
    return bool(max(off.max(), np.abs(along[:, 0] - along[:, 1]).max()) <= ALIGNED * size)


def _origins(joint: Joint) -> np.ndarray:
    """List a point on each of `elementary_axes`: (2 coordinates, 3), for each coordinate on part 1, then on part 2."""
    sides = np.asarray(joint.frames_1, float), np.asarray(joint.frames_2, float)
    return np.array(
        [
            side[frame, :3, 3]
            for frame, name in enumerate(joint.movements)
            for _ in MOVEMENTS[name].elements
            for side in sides
        ]
    ).reshape(-1, 3)


ElementaryAxes = list[tuple[int, np.ndarray, np.ndarray]]
"""(column of a coordinate, direction of its axis on part 1, direction on part 2), both unit vectors in the world."""


def elementary_axes(joints: Sequence[Joint], *, of_balls: bool = False) -> tuple[ElementaryAxes, ElementaryAxes] | None:
    """List the axes of rotations and the axes of translations in the assembled pose.

    None where a joint is a screw, or follows a curve or a surface, where its axes are no straight lines; and where it
    is a ball, unless its three axes count as those `of_balls`.
    """
    turning: ElementaryAxes = []
    sliding: ElementaryAxes = []
    column = 0
    for joint in joints:
        sides = np.asarray(joint.frames_1, float), np.asarray(joint.frames_2, float)
        for frame, name in enumerate(joint.movements):
            movement = MOVEMENTS[name]
            if movement.has_pitch or movement.follows or (movement.ball and not of_balls):
                return None
            for element in movement.elements:
                first, second = (side[frame][:3, element.axis] for side in sides)
                entry = (column + element.coordinate, first, second)
                (sliding if element.kind == "translate" else turning).append(entry)
            column += len(movement.coordinates)
    return turning, sliding


def _one_direction(turning: ElementaryAxes) -> bool:
    """Tell whether there are axes of rotations, and all of them are parallel, on either part of each joint."""
    return bool(turning) and all(
        np.linalg.norm(np.cross(turning[0][1], axis)) <= ALIGNED for _, *axes in turning for axis in axes
    )
