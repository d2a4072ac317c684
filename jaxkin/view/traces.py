"""The points whose paths are drawn, chosen for the user where none are given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin._names import nearest
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.view.camera import PartTransforms, View, move

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

Marks = list[tuple[str, Vector]]
"""Points of parts: the part, and where the point is in the assembled pose, in world coordinates."""

NEAR_JOINT = 0.15
"""A corner so near to a joint, over the size of its part, would only double the path of the joint."""
SAME_PATH = 1e-3
"""Paths so near to each other, over the size of the mechanism, are one path; one so short is a dot."""
MAX_PATHS = 8
"""More paths than these hide the mechanism: the longest are kept."""


def given_marks(points: Mapping[str, object], parts: Sequence[str]) -> Marks:
    """Read the points that a user gives, one (x, y, z) or several a part: ValueError otherwise."""
    marks: Marks = []
    for part, value in points.items():
        if part not in parts:
            raise ValueError(f"points are given on a part {part!r}, which does not exist{nearest(part, parts)}")
        try:
            array = np.asarray(value, float)
        except (TypeError, ValueError):
            array = np.array(np.nan)
        if array.shape[-1:] != (3,) or array.ndim > 2 or not np.isfinite(array).all():
            raise ValueError(
                f"points[{part!r}] must be one finite (x, y, z) or a list of them, in the assembled pose; got {value!r}"
            )
        marks += [(part, point) for point in array.reshape(-1, 3)]
    return marks


def default_marks(mechanism: Mechanism, parts: Sequence[Part], view: View, displacements: PartTransforms) -> Marks:
    """Find the centres of the joints that move, and of each part that they leave out the point farthest from them.

    A joint has a centre if the origin of its frame stays together on both parts. A part is left out if no such path
    is drawn on it, or if it is joined to no fixed part (a coupler: its motion is not that of its joints).
    """
    size = float(np.linalg.norm(np.ptp(np.concatenate([part.box for part in parts]), axis=0)))
    flat = view.axes[:2].T @ view.axes[:2] if view.planar else np.eye(3)  # points one behind the other look the same
    ends: dict[str, list[Vector]] = {part.name: [] for part in parts}
    marks, paths, covered = [], [], set()
    for joint in mechanism.joints.values():
        if not joint.freedoms:
            continue  # where it holds two parts together is nowhere in particular
        points = {joint.parts[0]: joint.frames_1[0, :3, 3], joint.parts[1]: joint.frames_2[0, :3, 3]}
        points = {part: np.asarray(point, float) for part, point in points.items()}
        for part, point in points.items():
            ends[part].append(point)
        one, other = (move(displacements, part, point) @ flat for part, point in points.items())
        if _gap(one, other) > SAME_PATH * size or _extent(one) < SAME_PATH * size:
            continue
        part = next((name for name in points if name not in covered), joint.parts[0])
        covered |= {*points}
        if all(_gap(one, path) > SAME_PATH * size for path in paths):
            marks.append((part, points[part]))
            paths.append(one)
    held = {name for joint in mechanism.joints.values() if {*joint.parts} & {*mechanism.fixed} for name in joint.parts}
    for part in parts:
        if part.name in mechanism.fixed or part.name in covered & held:
            continue
        point, distance = _farthest(part, np.array(ends[part.name]).reshape(-1, 3), flat)
        path = move(displacements, part.name, point) @ flat
        if distance > NEAR_JOINT * part.extent and _extent(path) > SAME_PATH * size:
            marks.append((part.name, point))
            paths.append(path)
    longest = np.argsort([-np.linalg.norm(np.diff(path, axis=0), axis=1).sum() for path in paths], kind="stable")
    return [marks[index] for index in sorted(longest[:MAX_PATHS])]


def _farthest(part: Part, joints: Float[np.ndarray, "joints 3"], flat: np.ndarray) -> tuple[Vector, float]:
    """Find the corner of the part farthest from the nearest of its joints; of equal ones the first in the file."""
    corners = part.triangles.reshape(-1, 3)
    centres = joints if len(joints) else part.box.mean(axis=0)[None]
    gaps = np.min([np.linalg.norm((corners - centre) @ flat, axis=1) for centre in centres], axis=0)
    index = int(np.argmax(gaps > (1 - 1e-6) * gaps.max()))
    return corners[index], float(gaps[index])


def _gap(one: Float[np.ndarray, "poses 3"], other: Float[np.ndarray, "poses 3"]) -> float:
    return float(np.abs(one - other).max())


def _extent(path: Float[np.ndarray, "poses 3"]) -> float:
    return float(np.ptp(path, axis=0).max())
