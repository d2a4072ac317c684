"""`motion.png`: the mechanism at several inputs, with the paths of its points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from jaxkin._files import text_width
from jaxkin.view.drawing import body_label
from jaxkin.view.illustration import FAINT_INK, INK, Canvas, Layer, backdrop, compose, draw
from jaxkin.view.labels import Input, headline, inputs, title, values
from jaxkin.view.lost_marks import WARNING, told
from jaxkin.view.scene import Scene, make_scene
from jaxkin.view.sheet import (
    CAPTION,
    GAP,
    GREY,
    MARGIN,
    Sheet,
    clip,
    draw_legend,
    draw_scale,
    fitted,
    make_sheet,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist

    from jaxkin.mechanism.motion import Motion

PANELS = 6
"""Poses that are drawn, in two rows."""
PANEL_COLUMNS = {0: 1, 1: 1, 2: 2, 4: 2}
"""Panels in a row by their number, three for all others."""
WIDTHS = {1: 1000, 2: 760, 3: 544}
"""Width of a panel in pixels by the number in a row; a panel is at most as high as it is wide."""
SWEEP_MARGIN = 0.03
"""Around the mechanism, over the larger side of what it sweeps."""
MAX_LEGEND_LETTERS = 40
"""Letters of a name in the legend."""
MAX_LEGEND_BODIES = 24
"""Moving bodies in the legend; more hide the picture."""
FIXED = (0.90, 0.905, 0.915)
LOST_STYLE = {
    "color": WARNING,
    "linewidth": 1.6,
    "linestyle": (0, (1.2, 1.2)),
    "marker": "o",
    "markersize": 11,
    "markerfacecolor": "none",
    "markeredgewidth": 2.0,
}
"""Rings where the faces of a lost contact were on each other, one on either part, and a dotted line between them."""


def storyboard(
    motion: Motion,
    path: Path | str,
    points: Mapping[str, object] | None = None,
    poses: Sequence[int] | np.ndarray | None = None,
) -> None:
    """Write a picture of a motion at some of its closed poses, all at one scale.

    - `points[part]`: (x, y, z) in the assembled pose, or several of them, whose paths are drawn; by default the
      centres of the joints that move and a far corner of the parts that these leave out.
    - `poses`: indices of the poses to draw; by default up to six, evenly over the range.

    Raises ValueError for an unknown part, points that are not such, and poses that are not closed.
    """
    scene = make_scene(motion, points)
    shown = _choose(scene) if poses is None else _check(poses, scene, len(motion))
    columns = PANEL_COLUMNS.get(len(shown), 3)
    entries = _legend(scene)
    sheet = make_sheet(_canvas(scene, WIDTHS[columns]), columns, -(-len(shown) // columns) or 1, entries)
    _panels(sheet, scene, inputs(motion), shown)
    first, second = headline(motion)
    sheet.write((MARGIN, 50), fitted(first, sheet.width - 2 * MARGIN, 13, "bold"), 13, INK, weight="bold")
    sheet.write((MARGIN, 87), second, 9, GREY)
    draw_legend(sheet, entries)
    draw_scale(sheet, motion.mechanism.unit)
    sheet.save(path)


def _choose(scene: Scene) -> list[int]:
    """Choose up to PANELS closed poses, evenly over the range; not the end of a motion that returns to its start.

    If contacts are lost between them only, the nearest of them makes room for the middle of the poses where they are.
    """
    count = len(scene.closed)
    if count <= PANELS:
        return scene.closed.tolist()
    places = np.rint(np.linspace(0, count - 1, PANELS + scene.cyclic)[:PANELS]).astype(int)
    lost = np.flatnonzero(np.any([mark.shown[scene.closed] for mark in scene.lost], axis=0))
    if len(lost) and not np.isin(places, lost).any():
        middle = lost[len(lost) // 2]
        places[np.argmin(np.abs(places - middle))] = middle
    return scene.closed[places].tolist()


def _check(poses: Sequence[int] | np.ndarray, scene: Scene, count: int) -> list[int]:
    poses = [int(pose) for pose in poses]
    for pose in poses:
        if not -count <= pose < count:
            raise ValueError(f"poses holds {pose}, but the motion has poses 0 to {count - 1}")
        if pose % count not in scene.closed:
            raise ValueError(f"pose {pose} is not closed and cannot be drawn: choose among motion.closed.nonzero()[0]")
    return [pose % count for pose in poses]


def _canvas(scene: Scene, width: int) -> Canvas:
    """Make the canvas that every pose and all paths fit in, with some air, no higher than wide."""
    low, high = scene.bounds[:, :2]
    margin = SWEEP_MARGIN * (high - low).max()
    extent, centre = high - low + 2 * margin, (low + high) / 2
    scale = width / extent.max()
    height = int(np.ceil(extent[1] * scale))
    corner = np.append(centre + np.array([-width, height]) / (2 * scale), scene.bounds[:, 2].mean())
    return Canvas(scene.view, corner, scale, height, width)


def _layer(scene: Scene, canvas: Canvas, fixed: bool, pose: int | None) -> Layer:
    """Draw the fixed or the moving parts at a pose, or in the assembled pose."""
    parts = [part for part in scene.parts if (part.name in scene.fixed) == fixed]
    triangles = [part.triangles if pose is None else scene.moved(part, part.triangles, [pose])[0] for part in parts]
    return draw(canvas, triangles, [FIXED if fixed else part.color or GREY for part in parts])


def _panels(sheet: Sheet, scene: Scene, entries: tuple[Input, ...], shown: list[int]) -> None:
    """Draw the mechanism at each pose; if there is none to show, where it was assembled."""
    canvas = sheet.canvas
    fixed = _layer(scene, canvas, True, None)
    behind = backdrop(fixed, _layer(scene, canvas, False, None))
    for index, pose in enumerate(shown or [None]):
        left, top = sheet.place(index)
        warning = "" if pose is None else fitted(told(scene.lost, pose), canvas.width / 2, 9, "bold")
        sheet.write((left + canvas.width, top + 14), warning, 9, WARNING, weight="bold", ha="right")
        room = canvas.width - (text_width(warning, 9, "bold") + GAP / 2 if warning else 0)
        caption, color = ("the assembled pose", GREY) if pose is None else (title(entries, pose), INK)
        if pose is not None and text_width(caption, 10, "bold") > room:
            caption = values(entries, pose)
        sheet.write((left, top + 14), fitted(caption, room, 10, "bold"), 10, color, weight="bold")
        moving = draw(canvas, [], []) if pose is None else _layer(scene, canvas, False, pose)
        image = compose(behind, fixed, moving)
        sheet.figure.figimage(image, xo=left, yo=sheet.height - top - CAPTION - canvas.height)  # pixel on pixel
        if pose is not None:
            _paths(sheet, left, top + CAPTION, scene, pose)
            _lost(sheet, left, top + CAPTION, scene, pose)


def _paths(sheet: Sheet, left: int, top: int, scene: Scene, pose: int) -> None:
    """Draw the paths over a panel, with a dot where the point is now."""
    colors = {part.name: part.color or GREY for part in scene.parts}
    for trace in scene.traces:
        x, y = sheet.canvas.pixels(trace.path)[:, :2].T + np.array([[left], [top]])
        color = tuple(0.72 * value for value in colors[trace.part])
        sheet.axes.plot(x[scene.order], y[scene.order], color="white", linewidth=2.6, alpha=0.75, zorder=3)
        sheet.axes.plot(x[scene.order], y[scene.order], color=color, linewidth=1.1, zorder=4)
        sheet.axes.plot(x[pose], y[pose], "o", color=color, markersize=5, markeredgecolor="white", zorder=5)


def _lost(sheet: Sheet, left: int, top: int, scene: Scene, pose: int) -> None:
    """Mark over a panel where the faces that a joint has left were on each other, on either part."""
    for mark in scene.lost:
        if mark.shown[pose]:
            x, y = sheet.canvas.pixels(mark.ends[:, pose])[:, :2].T + np.array([[left], [top]])
            sheet.axes.plot(x, y, zorder=6, **LOST_STYLE | {"color": "white", "linewidth": 4.0, "markeredgewidth": 4.0})
            sheet.axes.plot(x, y, zorder=7, **LOST_STYLE)


def _legend(scene: Scene) -> list[tuple[Artist, str]]:
    """Tell what the legend explains, and how."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: list[tuple[Artist, str]] = []
    if still := [part.name for part in scene.parts if part.name in scene.fixed]:
        patch = Patch(facecolor=FIXED, edgecolor=FAINT_INK, hatch="/////", hatch_linewidth=0.4)
        entries.append((patch, f"{clip(body_label(still, scene.parts), MAX_LEGEND_LETTERS)} (fixed)"))
    colors = {part.name: part.color or GREY for part in scene.parts}
    moving = {name: parts for name, parts in scene.bodies.items() if name not in scene.fixed}
    for name, parts in list(moving.items())[:MAX_LEGEND_BODIES]:
        patch = Patch(facecolor=colors[name], edgecolor=INK, linewidth=0.8)
        entries.append((patch, clip(body_label(parts, scene.parts), MAX_LEGEND_LETTERS)))
    if len(moving) > MAX_LEGEND_BODIES:
        entries.append(
            (Patch(facecolor="white", edgecolor=INK, linewidth=0.8), f"{len(moving) - MAX_LEGEND_BODIES} more bodies")
        )
    if scene.traces:
        style = {"color": GREY, "linewidth": 1.1, "marker": "o", "markersize": 5, "markeredgecolor": "white"}
        entries.append((Line2D([], [], **style), "path of a point"))
    if scene.lost:
        names = clip(", ".join(mark.joint for mark in scene.lost), MAX_LEGEND_LETTERS)
        entries.append((Line2D([], [], **LOST_STYLE), f"where the faces of a lost contact touched: {names}"))
    return [*entries, (Line2D([], [], color=INK, alpha=0.3, linewidth=1.0), "assembled pose")]
