"""Draw and save numbers that belong to the poses of a motion, one row each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxkin._files import DPI, quoted, save_figure, save_table, text_width
from jaxkin.effects.pose_axis import PoseAxis
from jaxkin.geometry.headings import coordinate_with_unit
from jaxkin.joints.joint import Joint

NAMED = 12
"""Lines of one axes that have a colour, a style and a name: more are not told apart."""
_STYLES = ("-", "--", "-.", ":")
"""Styles of lines, which change with the ten colours: lines that lie on each other are seen, and none looks like
another."""
_COLUMNS = 3
"""Columns of a legend at most."""
_WIDTH = 7.5
"""Width of the picture in inches."""
_LETTERS = 8.33
"""Size of the letters of the legend, in points."""
_QUARTERS = [1, 1.5, 3, 4.5, 9, 10]
"""Steps between numbers along an axis of degrees, but for powers of ten: 15, 30, 45 and 90 divide a turn."""
_BESIDE = 0.9
"""Inches beside each name of the legend, for its line and the gaps."""


def draw_lines(
    names: Sequence[str],
    rows: Float[np.ndarray, "rows poses"],
    label: str | Sequence[str],
    title: str,
    path: Path,
    *,
    axis: PoseAxis | None = None,
    marks: Sequence[tuple[float, str]] = (),
) -> Path:
    """Draw one line a row over the poses into a picture file; returns its path.

    `label` says what the numbers are; given for each row, rows of one label have axes of their own, so that angles and
    lengths are not drawn to one scale. Of more than `NAMED` rows the largest are named, and the others grey. With an
    `axis` they are drawn over its numbers. `marks` are places on the line of zero, each with a marker of matplotlib.
    """
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    labels = [label] * len(names) if isinstance(label, str) else list(label)
    groups = [[k for k, own in enumerate(labels) if own == each] for each in dict.fromkeys(labels)] or [[]]
    names = [_fitted(name) for name in names]
    columns = [_columns([names[k] for k in group]) for group in groups]
    lines = [-(-min(len(group), NAMED + 1) // many) for group, many in zip(groups, columns, strict=True)]
    heights = [max(4.0 if len(groups) > 1 else 4.8, 3.4 + 0.22 * count) for count in lines]
    figure = Figure(figsize=(_WIDTH, sum(heights)), layout="constrained")
    panels = figure.subfigures(len(groups), 1, squeeze=False, height_ratios=heights)[:, 0]
    across, along = axis or PoseAxis(np.arange(rows.shape[1]), "pose")
    for panel, group, many in zip(panels, groups, columns, strict=True):
        axes = panel.add_subplot()
        _lines(axes, across, [names[k] for k in group], rows[group])
        if len(across):  # all poses are seen, also those of which nothing is known
            axes.update_datalim([(np.nanmin(across), 0.0), (np.nanmax(across), 0.0)])
        # zero is where parts touch and where forces change sign: it is always seen
        axes.axhline(0.0, color="0.6", linewidth=0.8, zorder=1)
        for place, marker in marks:
            axes.plot(place, 0.0, marker, color="black")
        axes.set(xlabel=_fitted(along), ylabel=labels[group[0]] if group else label)
        axes.xaxis.set_major_locator(
            MaxNLocator(steps=_QUARTERS if along.endswith(" (deg)") else None, integer=axis is None)
        )
        axes.grid(alpha=0.3)
        if group:
            panel.legend(
                fontsize=_LETTERS,
                frameon=False,
                loc="outside lower center",
                ncols=many,
                handlelength=3,
            )
    figure.axes[0].set_title(title, fontsize="medium")
    return save_figure(figure, path)


def _columns(names: Sequence[str]) -> int:
    """Find how many columns of a legend fit into the picture, one at least."""
    widest = max(map(_width, names), default=0.0)
    return max(1, min(len(names), _COLUMNS, int(_WIDTH / (widest + _BESIDE))))


def _fitted(name: str) -> str:
    """Shorten a name that the picture is too narrow for in its middle: its end tells coordinates apart."""
    kept = len(name)
    shortened = name
    while kept > 1 and _width(shortened) > _WIDTH - _BESIDE:
        kept -= 1
        shortened = f"{name[: kept - kept // 2]}…{name[len(name) - kept // 2 :]}"
    return shortened


def _width(name: str) -> float:
    """Measure a name of the legend, in inches."""
    return text_width(name, _LETTERS) / DPI


def _lines(
    axes: Any, across: Float[np.ndarray, " poses"], names: Sequence[str], rows: Float[np.ndarray, "rows poses"]
) -> None:
    """Draw the rows of one label: the largest in colours with their names, the others grey below them."""
    sizes = np.abs(np.nan_to_num(rows)).max(axis=1, initial=0.0)
    largest = np.argsort(-sizes, kind="stable").tolist()
    named, others = sorted(largest[:NAMED]), largest[NAMED:]
    for number, k in enumerate(named):
        known = np.pad(np.isfinite(rows[k]), 1)
        alone = known[1:-1] & ~known[:-2] & ~known[2:]  # no line goes through these: they are dots
        marker = {"marker": "o", "markersize": 4, "markevery": np.flatnonzero(alone).tolist()} if alone.any() else {}
        style = {"color": f"C{number % 10}", "linestyle": _STYLES[number % len(_STYLES)]}
        axes.plot(across, np.where(known[1:-1], rows[k], np.nan), label=names[k], **style, **marker)
    for k in others:
        said = f"{len(others)} others, {sizes[others[0]]:.3g} at most" if k == others[0] else None
        axes.plot(across, np.where(np.isfinite(rows[k]), rows[k], np.nan), color="0.75", zorder=1.5, label=said)


def save_rows(names: Sequence[str], rows: Float[np.ndarray, "rows poses"], path: Path) -> Path:
    """Write rows as columns of comma-separated values, one line a pose, below a line of names; returns the path."""
    return save_table(["pose", *map(quoted, names)], map(str, range(rows.shape[1])), rows, path)


def save_displacements(
    joints: Sequence[Joint], displacements: Sequence[Float[Any, "poses _"]], unit: str, path: Path
) -> Path:
    """Write the displacements of all joints by `save_rows`, a column a coordinate; returns the path.

    `unit` is that of lengths, "" where it is not known.
    """
    names = [coordinate_with_unit(name, unit) for joint in joints for name in joint.full_names]
    rows = np.concatenate([np.asarray(each) for each in displacements], axis=1)
    return save_rows(names, rows.T, path)
