"""The points whose paths are drawn, chosen for the user where none are given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.motion.mechanism import Mechanism
from jaxkin.topology.names import nearest
from jaxkin.view.camera import Displacements, View, move

Marks = list[tuple[str, Vector]]
"""Points of parts: the part, and where the point is in the assembled pose, in world coordinates."""

NEAR = 0.15  # a corner so near to a joint, over the size of its part, would only double the path of the joint
SAME = 1e-3  # paths so near to each other, over the size of the mechanism, are one path; one so short is a dot
MOST = 8  # more paths than these hide the mechanism: the longest are kept


def given_marks(points: Mapping[str, object], parts: Sequence[str]) -> Marks:
    """The points that a user gives, one (x, y, z) or several a part: ValueError otherwise."""
    marks: Marks = []
    for part, value in points.items():
        if part not in parts:
            raise ValueError(f"points are given on a part {part!r}, which does not exist{nearest(part, parts)}")
        array = np.asarray(value, float)
        if array.shape[-1:] != (3,) or array.ndim > 2 or not np.isfinite(array).all():
            raise ValueError(
                f"points[{part!r}] must be one finite (x, y, z) or a list of them, in the assembled pose; got {value!r}"
            )
        marks += [(part, point) for point in array.reshape(-1, 3)]
    return marks


def default_marks(mechanism: Mechanism, parts: Sequence[Part], view: View, displacements: Displacements) -> Marks:
    """Centres of the joints that move, and the point farthest from the joints of every part that they leave out.

    A joint has a centre if the origin of its frame stays together on both parts. A part is left out if no such path
    is drawn on it, or if it is joined to no fixed part (a coupler: its motion is not that of its joints).
    """
    size = float(np.linalg.norm(np.ptp(np.concatenate([part.box for part in parts]), axis=0)))
    flat = view.axes[:2].T @ view.axes[:2] if view.planar else np.eye(3)  # points one behind the other look the same

    def path(part: str, point: Vector) -> Float[np.ndarray, "poses 3"]:
        return move(displacements, part, point) @ flat

    marks, paths = [], []
    ends: dict[str, list[Vector]] = {part.name: [] for part in parts}
    covered: set[str] = set()
    for joint in mechanism.joints.values():
        first, second = (np.asarray(frames[0, :3, 3], float) for frames in (joint.before, joint.after))
        pair = dict(zip(joint.parts, (first, second), strict=True))
        for part, point in pair.items():
            ends[part].append(point)
        track = path(joint.parts[0], first)
        together = np.abs(track - path(joint.parts[1], second)).max() < SAME * size
        if not together or _short(track, size):
            continue
        part = next((name for name in pair if name not in covered), joint.parts[0])
        covered |= {*pair}
        if not any(np.abs(track - other).max() < SAME * size for other in paths):
            marks.append((part, pair[part]))
            paths.append(track)
    grounded = {
        part for joint in mechanism.joints.values() if set(joint.parts) & {*mechanism.fixed} for part in joint.parts
    }
    for part in parts:
        if part.name in covered & grounded or part.name in mechanism.fixed:
            continue
        point, distance = _farthest(part, np.array(ends[part.name]).reshape(-1, 3), flat)
        track = path(part.name, point)
        if distance > NEAR * np.linalg.norm(np.ptp(part.box, axis=0)) and not _short(track, size):
            marks.append((part.name, point))
            paths.append(track)
    longest = np.argsort([-_length(track) for track in paths], kind="stable")[:MOST]
    return [marks[index] for index in sorted(longest)]


def _farthest(part: Part, joints: Float[np.ndarray, "joints 3"], flat: np.ndarray) -> tuple[Vector, float]:
    """The corner of the part farthest from the nearest of its joints; of equal ones the first in the file."""
    corners = part.triangles.reshape(-1, 3)
    centres = joints if len(joints) else part.box.mean(axis=0)[None]
    gaps = np.min([np.linalg.norm((corners - centre) @ flat, axis=1) for centre in centres], axis=0)
    index = int(np.argmax(gaps > (1 - 1e-6) * gaps.max()))
    return corners[index], float(gaps[index])


def _length(path: Float[np.ndarray, "poses 3"]) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def _short(path: Float[np.ndarray, "poses 3"], size: float) -> bool:
    return bool(np.ptp(path, axis=0).max() < SAME * size)
