"""`motion.png`: the mechanism at several inputs, with the paths of its points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin.motion.motion import Motion
from jaxkin.motion.writers import register
from jaxkin.view.illustration import FAINT_INK, INK, Canvas, Layer, compose, draw
from jaxkin.view.labels import headline, inputs, title
from jaxkin.view.scene import Scene, make_scene

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DPI = 150
PANELS = 6
COLUMNS = {1: 1, 2: 2, 4: 2}
"""Panels in a row by their number, three for all others."""
WIDTHS = {1: 1000, 2: 760, 3: 544}
"""Width of a panel by the number in a row; a panel is at most as high as it is wide. All lengths here are in pixels."""
MARGIN, GAP, HEAD, CAPTION, FOOT, LINE = 54, 36, 122, 44, 64, 34
AIR = 0.03  # around the mechanism, over the larger side of what it sweeps
FIXED, GREY = (0.90, 0.905, 0.915), (0.40, 0.42, 0.46)


class _Sheet(NamedTuple):
    """The figure with axes over all of it, whose coordinates are pixels from its upper left corner."""

    figure: Figure
    axes: Axes
    width: int
    height: int


@register("motion.png")
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
    columns = COLUMNS.get(len(shown), 3) if len(shown) else 1
    rows = max(1, -(-len(shown) // columns))
    canvas = _canvas(scene, WIDTHS[columns])
    entries = _legend(scene)
    per_line = max(1, columns * canvas.width // (70 + 13 * max(len(str(entry.get_label())) for entry in entries)))
    width = 2 * MARGIN + columns * canvas.width + (columns - 1) * GAP
    foot = FOOT + LINE * -(-len(entries) // per_line)
    sheet = _sheet(width, HEAD + rows * (canvas.height + CAPTION) + (rows - 1) * GAP + foot)

    fixed, ghost = (_layer(scene, canvas, still, None) for still in (True, False))
    nothing = draw(canvas, [], [])
    for index, pose in enumerate(shown):
        left = MARGIN + index % columns * (canvas.width + GAP)
        top = HEAD + index // columns * (canvas.height + CAPTION + GAP)
        sheet.axes.text(left, top + 14, title(inputs(motion), pose), size=10, weight="bold", color=INK, va="center")
        _panel(sheet, left, top + CAPTION, compose(fixed, _layer(scene, canvas, False, pose), ghost))
        _paths(sheet, left, top + CAPTION, scene, canvas, pose)
    if not len(shown):
        sheet.axes.text(MARGIN, HEAD + 14, "the assembled pose", size=10, weight="bold", color=GREY, va="center")
        _panel(sheet, MARGIN, HEAD + CAPTION, compose(fixed, nothing, ghost))
    first, second = headline(motion)
    sheet.axes.text(MARGIN, 50, shorten(first, width // 16), size=13, weight="bold", color=INK, va="center")
    sheet.axes.text(MARGIN, 87, second, size=9, color=GREY, va="center")
    sheet.figure.legend(
        handles=entries, ncols=per_line, loc="lower left", bbox_to_anchor=((MARGIN - 8) / width, 20 / sheet.height),
        frameon=False, fontsize=9, labelcolor=INK, handlelength=1.6, columnspacing=1.6, borderpad=0,
    )  # fmt: skip
    _scale_bar(sheet, canvas, motion.mechanism.unit)
    sheet.figure.savefig(path, dpi=DPI)


def _choose(scene: Scene) -> list[int]:
    """Up to PANELS closed poses, evenly over the range; of a motion that returns to its start the end is left out."""
    count = len(scene.closed)
    if count <= PANELS:
        return scene.closed.tolist()
    return scene.closed[np.rint(np.linspace(0, count - 1, PANELS + scene.cyclic)[:PANELS]).astype(int)].tolist()


def _check(poses: Sequence[int] | np.ndarray, scene: Scene, count: int) -> list[int]:
    poses = [int(pose) for pose in poses]
    for pose in poses:
        if not -count <= pose < count:
            raise ValueError(f"poses holds {pose}, but the motion has poses 0 to {count - 1}")
        if pose % count not in scene.closed:
            raise ValueError(f"pose {pose} is not closed and cannot be drawn: choose among motion.closed.nonzero()[0]")
    return [pose % count for pose in poses]


def _canvas(scene: Scene, width: int) -> Canvas:
    """The canvas that every pose and all paths fit in, with some air, no higher than wide."""
    low, high = scene.bounds[:, :2]
    margin = AIR * (high - low).max()
    extent, centre = high - low + 2 * margin, (low + high) / 2
    scale = width / extent.max()
    height = int(np.ceil(extent[1] * scale))
    corner = centre + np.array([-width, height]) / (2 * scale)
    return Canvas(scene.view, corner, scale, height, width)


def _layer(scene: Scene, canvas: Canvas, fixed: bool, pose: int | None) -> Layer:
    """The fixed or the moving parts at a pose, or in the assembled pose."""
    parts = [part for part in scene.parts if (part.name in scene.fixed) == fixed]
    triangles = [part.triangles if pose is None else scene.moved(part, part.triangles, [pose])[0] for part in parts]
    return draw(canvas, triangles, [FIXED if fixed else part.color or GREY for part in parts])


def _sheet(width: int, height: int) -> _Sheet:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="white")
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(height, 0), zorder=1)
    axes.set_axis_off()
    return _Sheet(figure, axes, width, height)


def _panel(sheet: _Sheet, left: int, top: int, image: np.ndarray) -> None:
    """An image, pixel on pixel."""
    sheet.figure.figimage(image, xo=left, yo=sheet.height - top - image.shape[0])


def _paths(sheet: _Sheet, left: int, top: int, scene: Scene, canvas: Canvas, pose: int) -> None:
    """The paths over a panel, with a dot where the point is now."""
    colors = {part.name: part.color or GREY for part in scene.parts}
    for trace in scene.traces:
        x, y = canvas.pixels(trace.path)[:, :2].T + np.array([[left], [top]])
        color = tuple(0.72 * value for value in colors[trace.part])
        sheet.axes.plot(x[scene.order], y[scene.order], color="white", linewidth=2.6, alpha=0.75, zorder=3)
        sheet.axes.plot(x[scene.order], y[scene.order], color=color, linewidth=1.1, zorder=4)
        sheet.axes.plot(x[pose], y[pose], "o", color=color, markersize=5, markeredgecolor="white", zorder=5)


def _legend(scene: Scene) -> list[Artist]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    still = [part.name for part in scene.parts if part.name in scene.fixed]
    entries: list[Artist] = []
    if still:
        label = f"{shorten(', '.join(still), 40)} (fixed)"
        entries.append(Patch(facecolor=FIXED, edgecolor=FAINT_INK, hatch="/////", hatch_linewidth=0.4, label=label))
    entries += [
        Patch(facecolor=part.color or GREY, edgecolor=INK, linewidth=0.8, label=shorten(part.name, 40))
        for part in scene.parts
        if part.name not in scene.fixed
    ]
    if scene.traces:
        style = {"color": GREY, "linewidth": 1.1, "marker": "o", "markersize": 5, "markeredgecolor": "white"}
        entries.append(Line2D([], [], label="path of a point", **style))
    entries.append(Line2D([], [], color=INK, alpha=0.3, linewidth=1.0, label="assembled pose"))
    return entries


def _scale_bar(sheet: _Sheet, canvas: Canvas, unit: str) -> None:
    """A line of a round length, up to a quarter of a panel, in the lower right corner."""
    wanted = canvas.width / canvas.scale / 4
    power = 10.0 ** np.floor(np.log10(wanted))
    length = power * max(step for step in (1, 2, 5) if step * power <= wanted)
    right, y = sheet.width - MARGIN, sheet.height - 34
    left = right - length * canvas.scale
    for x, height in (([left, right], 0), ([left, left], 7), ([right, right], 7)):
        sheet.axes.plot(x, [y - height, y + height], color=GREY, linewidth=1.0, solid_capstyle="butt")
    sheet.axes.text(
        (left + right) / 2, y - 18, f"{length:g} {unit}".strip(), size=8, color=GREY, ha="center", va="center"
    )
