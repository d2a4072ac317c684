"""Draw poses of a mechanism side by side, each part as bars between its joints."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxkin._files import save_figure
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion

MAX_PANELS = 40
"""Modes that are drawn at most: as many as a general hexapod has."""
COLUMNS = 8
"""Panels in a row at most."""
PANEL = 2.2
"""Side of a panel, inches."""
MAX_BARS = 4
"""Joints of a part that are linked pair by pair at most; those of other parts are linked to their middle."""


def draw_modes(motion: Motion, titles: Sequence[str], path: Path) -> Path:
    """Draw the poses of a motion into a picture file, all at one scale; returns its path.

    Planar mechanisms are seen along their axes, others in perspective.
    """
    from matplotlib.figure import Figure

    count = min(len(titles), MAX_PANELS)
    columns = min(max(count, 1), COLUMNS if count > 12 else 4)
    rows = -(-max(count, 1) // columns)
    plane = common_plane(motion.mechanism)
    figure = Figure(figsize=(PANEL * columns, (PANEL + 0.3) * rows), layout="constrained")
    bars = _bars(motion)
    every = np.concatenate([np.zeros((1, 3)), *(points.reshape(-1, 3) for points, _ in bars)])[1:]
    if plane is not None:
        every = every @ plane.T
    low, high = (every.min(axis=0), every.max(axis=0)) if len(every) else (np.zeros(3), np.ones(3))
    middle, reach = (low + high) / 2, 0.55 * float((high - low).max() or 1.0)
    colours = [f"C{k % 10}" for k in range(len(motion.mechanism.parts))]
    for number in range(count):
        axes = figure.add_subplot(rows, columns, number + 1, projection=None if plane is not None else "3d")
        for points, part in bars:
            fixed = motion.mechanism.parts[part] in motion.mechanism.fixed
            style = {"color": "0.75" if fixed else colours[part], "linewidth": 2.2 if not fixed else 1.5}
            for line in points[number]:
                drawn = line if plane is None else line @ plane.T
                axes.plot(*drawn.T, marker="o", markersize=3, zorder=1 if fixed else 2, **style)
        for limits, at in zip(("set_xlim", "set_ylim", "set_zlim"), middle, strict=False):
            getattr(axes, limits)(at - reach, at + reach)
        _shape_panel(axes, plane is None)
        axes.set_axis_off()
        axes.set_title(titles[number], fontsize="small")
    if not count:
        figure.suptitle("no assembly mode")
    elif len(titles) > count:
        figure.supxlabel(f"and {len(titles) - count} more", fontsize="small")
    return save_figure(figure, path)


def _shape_panel(axes: Any, in_space: bool) -> None:
    """Give a panel equal scales along its axes: a cube in space, as large as the panel takes; a plane otherwise."""
    if in_space:
        axes.set_box_aspect((1, 1, 1), zoom=1.5)
    else:
        axes.set_aspect("equal")


def common_plane(mechanism: Mechanism) -> Float[np.ndarray, "2 3"] | None:
    """Find two directions across all axes of rotation if these are parallel; None otherwise."""
    axes = [
        np.asarray(frame, float)[:3, element.axis]
        for joint in mechanism.all_joints
        for movement, frame in zip(joint.movements, joint.frames_1, strict=True)
        for element in MOVEMENTS[movement].elements
        if element.kind != "translate"
    ]
    if not axes or any(np.linalg.norm(np.cross(axis, axes[0])) > 1e-6 for axis in axes):  # 1e-6: as drawn
        return None
    normal = axes[0] * np.sign(axes[0][np.argmax(np.abs(axes[0]))])
    along = np.eye(3)[0 if abs(normal[0]) < 0.9 else 1]
    right = along - normal * (normal @ along)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(normal, right)])


def _bars(motion: Motion) -> list[tuple[Float[np.ndarray, "poses bars 2 3"], int]]:
    """Compute the ends of the bars of each part in all poses, and the number of the part."""
    mechanism, found = motion.mechanism, []
    for number, part in enumerate(mechanism.parts):
        ends = [
            np.asarray(side[k], float)[:3, 3]
            for joint in mechanism.all_joints
            for name, side, k in zip(joint.parts, (joint.frames_1, joint.frames_2), (0, -1), strict=True)
            if name == part and joint.freedoms
        ]
        if len(ends) > MAX_BARS:
            middle = np.mean(ends, axis=0)
            lines = [(middle, end) for end in ends]
        else:
            lines = list(combinations(ends, 2))
        places = np.asarray(motion.transforms[part], float)
        points = np.array(lines).reshape(-1, 2, 3)
        found.append((np.einsum("pij,bej->pbei", places[:, :3, :3], points) + places[:, None, None, :3, 3], number))
    return found
