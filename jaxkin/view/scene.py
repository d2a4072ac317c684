"""What is drawn of a motion: coloured parts, a view, paths of points, and the closed poses in order of the input."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Points
from jaxkin.view.camera import PartTransforms, View, choose_view, move
from jaxkin.view.drawing import drawn_parts, told_apart
from jaxkin.view.lost_marks import LostMark, lost_marks
from jaxkin.view.traces import default_marks, given_marks

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

PROBES = 60
"""Poses that the view and the points are chosen from."""
CLOSED = 1e-4
"""The ends of a motion so near to each other, over its size, are one pose: safe in float32."""


@dataclass(frozen=True, eq=False)
class Trace:
    """The path of one point of a part."""

    part: str
    path: Float[np.ndarray, "poses 3"]
    """World coordinates at every pose, NaN where it failed."""


@dataclass(frozen=True, eq=False)
class Scene:
    """All that the pictures of one motion share."""

    parts: tuple[Part, ...]
    fixed: frozenset[str]
    bodies: Mapping[str, tuple[str, ...]]
    """Parts that move as one, by the first of each body."""
    displacements: PartTransforms
    """Of every part at every pose, in world coordinates from the assembled pose; failed poses included."""
    order: Int[np.ndarray, " poses"]
    """Indices of all poses: by the driven displacement if there is one, as given if there are several."""
    closed: Int[np.ndarray, " closed"]
    """Those of them that are closed."""
    cyclic: bool
    """Whether the last closed pose is the first again."""
    view: View
    traces: tuple[Trace, ...]
    lost: tuple[LostMark, ...]
    bounds: Float[np.ndarray, "2 3"]
    """Lowest and highest coordinates in the view, to the right, up and towards the viewer, of all that is drawn."""

    def moved(self, part: Part, points: Points, poses: Sequence[int] | np.ndarray) -> Float[np.ndarray, "poses *n 3"]:
        """Place points of a part, given where they are in the assembled pose, at some poses: world coordinates."""
        return move({part.name: self.displacements[part.name][np.asarray(poses)]}, part.name, points)


def make_scene(motion: Motion, points: Mapping[str, object] | None = None) -> Scene:
    """Make the scene of a motion; `points[part]`: (x, y, z) in the assembled pose, one or several, instead of the
    default.

    Raises ValueError for a part that does not exist and for points that are not such.
    """
    mechanism = motion.mechanism
    bodies, fixed = mechanism.bodies, frozenset(mechanism.fixed)
    parts = told_apart(drawn_parts(mechanism), bodies, fixed)
    displacements = {part.name: np.asarray(motion.transforms[part.name], float) for part in parts}
    order = np.arange(len(motion))
    if len(motion.inputs) == 1:
        (values,) = motion.inputs.values()
        order = np.argsort(np.asarray(values), kind="stable")
    closed = order[np.asarray(motion.on_branch)[order]]
    probes = closed[np.unique(np.linspace(0, len(closed) - 1, PROBES).astype(int))] if len(closed) else closed
    sample = {name: poses[probes] if len(probes) else np.eye(4)[None] for name, poses in displacements.items()}
    view = choose_view(parts, mechanism.fixed, sample)
    size = float(np.linalg.norm(np.ptp(np.concatenate([part.box for part in parts]), axis=0)))
    marks = default_marks(mechanism, parts, view, sample) if points is None else given_marks(points, mechanism.parts)
    kept = np.asarray(motion.on_branch)[:, None]
    traces = tuple(Trace(part, np.where(kept, move(displacements, part, point), np.nan)) for part, point in marks)
    bounds = _bounds(parts, sample, view, traces)
    lost = lost_marks(motion.lost_contacts, displacements)
    return Scene(
        parts, fixed, bodies, displacements, order, closed, _returns(parts, sample, size), view, traces, lost, bounds
    )


def _returns(parts: tuple[Part, ...], sample: PartTransforms, size: float) -> bool:
    """Tell whether the last pose of the sample is the first one, after another in between."""
    gaps = [np.ptp(move(sample, part.name, part.box)[[0, -1]], axis=0).max() for part in parts]
    return len(sample[parts[0].name]) > 2 and bool(max(gaps) < CLOSED * size)


def _bounds(
    parts: tuple[Part, ...], sample: PartTransforms, view: View, traces: tuple[Trace, ...]
) -> Float[np.ndarray, "2 3"]:
    """Find the bounds in the view of the assembled pose, of a sample of poses with both ends, and of all paths."""
    clouds = [trace.path[np.isfinite(trace.path).all(axis=1)] for trace in traces]
    for part in parts:
        corners = _extremes(part.triangles.reshape(-1, 3))
        clouds += [corners, *move(sample, part.name, corners)]
    points = view.project(np.concatenate(clouds))
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _extremes(points: Float[np.ndarray, "points 3"]) -> Float[np.ndarray, "extremes 3"]:
    """List the corners of the convex hull, where that saves work."""
    if len(points) < 1000:
        return points
    from scipy.spatial import ConvexHull

    return points[ConvexHull(points, qhull_options="QJ").vertices]  # joggled: a flat sheet has no hull otherwise
