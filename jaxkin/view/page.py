"""`motion.html`: the animated mechanism in one page that needs nothing else, neither a network nor a server."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.geometry.part import box_corners
from jaxkin.solve.status import Status
from jaxkin.view.drawing import FIXED_COLOR, body_label
from jaxkin.view.labels import headline, inputs, title
from jaxkin.view.lost_marks import told
from jaxkin.view.scene import Scene, make_scene
from jaxkin.view.viewer import encoded, part_entries, rounded, write_page

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion
    from jaxkin.view.sheet import Color

MAX_PAGE_POSES = 361
"""Poses in the page: a full turn in degrees; more are not told apart on a slider."""
TILT = (-0.45, 0.40)
"""Yaw and pitch that a plane mechanism is first seen from, in radians: its depth shows."""
RISE = 0.52
"""Pitch that one in space is first seen from."""


def page(motion: Motion, path: Path | str, points: Mapping[str, object] | None = None) -> None:
    """Write a page that shows the motion in 3D, with a slider over its range; works from a file, without a network.

    `points[part]`: (x, y, z) in the assembled pose, or several of them, whose paths are drawn; by default the same as
    in `storyboard`. At most `MAX_PAGE_POSES` poses are kept, evenly in order of the input. Failed poses are told, not
    drawn; at poses where joints leave their faces, these are told and marked.

    Raises ValueError for an unknown part and for points that are not such.
    """
    write_page(path, "page", _content(motion, make_scene(motion, points)))


def _content(motion: Motion, scene: Scene) -> dict:
    """Write what `page.js` reads. Lengths are over `scale` about `centre`, so that float32 is enough in any unit."""
    low, high = scene.bounds
    centre, scale = scene.view.axes.T @ (low + high) / 2, float(np.linalg.norm(high - low) / 2)
    shown = scene.order[np.unique(np.linspace(0, len(motion) - 1, min(len(motion), MAX_PAGE_POSES)).astype(int))]
    axes, yaw, pitch = scene.view.axes, *TILT
    if not scene.view.planar:  # the turntable stands upright in the world
        up = np.array([0.0, 0.0, 1.0])
        axes, yaw, pitch = np.stack([axes[0], up, np.cross(axes[0], up)]), 0.0, RISE
    corners = box_corners(scene.bounds - (low + high) / 2) @ scene.view.axes
    first, second = headline(motion)
    status, entries = np.asarray(motion.status), inputs(motion)
    colors = {part.name: part.color or FIXED_COLOR for part in scene.parts}
    return {
        "title": first,
        "subtitle": second,
        "labels": [title(entries, int(pose)) for pose in shown],
        "problems": [_problem(Status(int(status[pose]))) for pose in shown],
        "lost": [told(scene.lost, int(pose)) for pose in shown],
        "cyclic": scene.cyclic,
        "planar": scene.view.planar,
        "centre": centre.tolist(),
        "scale": scale,
        "axes": axes.tolist(),
        "corners": (corners / scale).tolist(),
        "yaw": yaw,
        "pitch": pitch,
        "bodies": [_body(name, scene, shown, centre, scale, colors[name]) for name in scene.bodies],
        "parts": part_entries(scene.parts, [*scene.bodies.values()], colors, centre, scale),
        "paths": [
            {
                "part": trace.part,
                "color": rounded(colors[trace.part]),
                "points": encoded((trace.path[shown] - centre) / scale),
            }
            for trace in scene.traces
        ],
        "marks": [[encoded((end[shown] - centre) / scale) for end in mark.ends] for mark in scene.lost],
    }


def _problem(status: Status) -> str:
    return "" if status is Status.CLOSED else f"{status.name.lower()}: {status.message}"


def _body(name: str, scene: Scene, shown: np.ndarray, centre: np.ndarray, scale: float, color: Color) -> dict:
    """Describe parts that move as one: one row of the legend, and one displacement a pose."""
    poses = scene.displacements[name][shown, :3, :].copy()
    poses[..., 3] += poses[..., :3] @ centre - centre
    poses[..., 3] /= scale
    return {
        "name": body_label(scene.bodies[name], scene.parts),
        "fixed": name in scene.fixed,
        "color": rounded(color),
        "poses": "" if name in scene.fixed else encoded(poses),
    }
