"""The sheet that a storyboard is laid out on: a figure with a legend and a scale, in pixels."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxkin._files import DPI, save_figure, text_width
from jaxkin.view.illustration import INK, Canvas

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Color = tuple[float, float, float]
Place = tuple[float | int, float | int]

MARGIN, GAP, HEAD, CAPTION, FOOT, LINE = 54, 36, 122, 44, 64, 34
"""In pixels: around the sheet, between panels, above them, above each, below them, a line of the legend."""
GREY = (0.40, 0.42, 0.46)


class Sheet(NamedTuple):
    """The figure, with axes over all of it whose coordinates are pixels from its upper left corner."""

    figure: Figure
    axes: Axes
    canvas: Canvas
    columns: int
    width: int
    height: int

    def place(self, index: int) -> tuple[int, int]:
        """Find left and top of a panel with its caption."""
        row, column = divmod(index, self.columns)
        return MARGIN + column * (self.canvas.width + GAP), HEAD + row * (self.canvas.height + CAPTION + GAP)

    def write(self, at: Place, text: str, size: int, color: Color, weight="normal", ha="left") -> None:
        """Write one line of text that begins at a point (or as `ha` says), halfway up; a dollar sign is one."""
        self.axes.text(*at, text, size=size, color=color, weight=weight, ha=ha, va="center", parse_math=False)

    def save(self, path: Path | str) -> None:
        """Write the sheet as PNG."""
        save_figure(self.figure, Path(path))


def make_sheet(canvas: Canvas, columns: int, rows: int, entries: list[tuple[Artist, str]]) -> Sheet:
    """Make a sheet for some rows and columns of panels, and for a legend of some entries."""
    from matplotlib.figure import Figure

    width = 2 * MARGIN + columns * canvas.width + (columns - 1) * GAP
    foot = FOOT + LINE * -(-len(entries) // _columns(entries, width))
    height = HEAD + rows * (canvas.height + CAPTION) + (rows - 1) * GAP + foot
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="white")
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(height, 0), zorder=1)
    axes.set_axis_off()
    return Sheet(figure, axes, canvas, columns, width, height)


def _columns(entries: list[tuple[Artist, str]], width: int) -> int:
    """Compute how many entries fit in a line of the legend, beside the scale."""
    widths = [75 + 11 * len(label) for _, label in entries]  # symbol and gaps, and letters of the legend's size
    room = int(0.8 * width)
    return len(entries) if sum(widths) <= room else max(1, room // max(widths))


def draw_legend(sheet: Sheet, entries: list[tuple[Artist, str]]) -> None:
    """Draw the legend in the lower left corner: what each entry looks like, and what it is called."""
    handles, labels = zip(*entries, strict=True)
    legend = sheet.figure.legend(
        handles,
        ["x"] * len(labels),  # matplotlib leaves out labels that begin with an underscore: they are set afterwards
        ncols=_columns(entries, sheet.width),
        loc="lower left",
        bbox_to_anchor=((MARGIN - 8) / sheet.width, 20 / sheet.height),
        frameon=False,
        fontsize=9,
        labelcolor=INK,
        handlelength=1.6,
        columnspacing=1.6,
        borderpad=0,
    )
    for text, label in zip(legend.get_texts(), labels, strict=True):
        text.set(text=label, parse_math=False)


def draw_scale(sheet: Sheet, unit: str) -> None:
    """Draw a line of a round length, up to a quarter of a panel, in the lower right corner."""
    wanted = sheet.canvas.width / sheet.canvas.scale / 4
    power = 10.0 ** np.floor(np.log10(wanted))
    length = power * max((step for step in (1, 2, 5) if step * power <= wanted), default=1)
    right, y = sheet.width - MARGIN, sheet.height - 34
    left = right - length * sheet.canvas.scale
    for x, height in (([left, right], 0), ([left, left], 7), ([right, right], 7)):
        sheet.axes.plot(x, [y - height, y + height], color=GREY, linewidth=1.0, solid_capstyle="butt")
    sheet.write(((left + right) / 2, y - 18), f"{length:g} {unit}".strip(), 8, GREY, ha="center")


def fitted(text: str, room: float, size: int, weight: str = "normal") -> str:
    """Return the text, cut off where it is wider than so many pixels."""
    letters = len(text)
    while letters > 1 and text_width(clip(text, letters), size, weight) > room:
        letters -= 1
    return clip(text, letters)


def clip(text: str, letters: int) -> str:
    """Return the text, cut off where it is longer."""
    return text if len(text) <= letters else f"{text[: letters - 1]}…"
