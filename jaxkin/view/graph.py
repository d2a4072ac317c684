"""The graph of a mechanism: parts as nodes, joints as lines, and on these every loop as an arrow in its colour."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.topology.elements import StructureElement
from jaxkin.topology.loops import Loop
from jaxkin.view.illustration import INK
from jaxkin.view.layout import layout
from jaxkin.view.sheet import GREY, Color, Place, clip

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MAX_LETTERS = 14
"""Letters of a name that are drawn."""
MAX_DRAWN_PARTS = 600
"""Parts up to which they are drawn."""
SMALL = 40
"""Parts from which on names are small and joints have none."""
LANE = 0.055
"""Between the arrows of two loops along a joint, in inches."""
BOW = 0.2
"""Of several joints between the same parts, over their distance."""
STILL = (0.85, 0.86, 0.88)

Polyline = Float[np.ndarray, "points 2"]


class Diagram(NamedTuple):
    """What is drawn of a structure; a part stands for its row of the incidence matrix, the fixed ones for one part."""

    parts: tuple[str, ...]
    joints: tuple[str, ...]
    ends: tuple[tuple[str, str], ...]
    """For each joint part 1 and part 2."""
    fixed: str
    loops: tuple[Loop, ...]
    elements: tuple[StructureElement, ...]


def colors(count: int) -> list[Color]:
    """Choose colours for loops that stay apart: those of a map for few, without its grey, hues for many."""
    from matplotlib import colormaps
    from matplotlib.colors import hsv_to_rgb

    if count <= 9:
        found = [colormaps["tab10"](k) for k in (0, 1, 2, 3, 4, 5, 6, 8, 9)[:count]]
    else:
        found = [hsv_to_rgb((k * 0.618 % 1, 0.75, 0.55 + 0.35 * (k % 2))) for k in range(count)]
    return [(float(red), float(green), float(blue)) for red, green, blue, *_ in found]


def places(diagram: Diagram, width: float) -> dict[str, np.ndarray]:
    """Choose where the parts go, in inches about the middle of a drawing of some width.

    Raises ValueError for more parts than a drawing can show.
    """
    if len(diagram.parts) > MAX_DRAWN_PARTS:
        raise ValueError(
            f"a drawing shows up to {MAX_DRAWN_PARTS} parts, this structure has {len(diagram.parts)}; print it"
        )
    return {part: width * place for part, place in layout(diagram.parts, diagram.ends).items()}


def reach_of_names(diagram: Diagram) -> float:
    """Find how far the name of a joint may reach sideways from its line, in inches; 0 where joints have no names."""
    if len(diagram.parts) > SMALL or not diagram.joints:
        return 0.0
    loops = Counter(joint for loop in diagram.loops for joint, _ in loop.joints)
    return 0.03 + LANE * max(loops.values(), default=0) / 2 + 2 * max(_half_width(name) for name in diagram.joints)


def _half_width(name: str) -> float:
    """Estimate half the width of the name of a joint as it is drawn, in inches."""
    return 0.02 + 0.033 * min(len(name), MAX_LETTERS)


def draw_graph(
    axes: Axes,
    diagram: Diagram,
    at: Mapping[str, np.ndarray],
    lines: Mapping[int, Polyline],
    palette: Sequence[Color],
) -> None:
    """Draw parts, each at its place, joints along their lines, and loops; a unit of the axes is an inch."""
    small = len(at) > SMALL
    through: dict[int, list[tuple[int, int]]] = {joint: [] for joint in range(len(diagram.joints))}
    for number, loop in enumerate(diagram.loops):
        for joint, sign in loop.joints:
            through[joint].append((number, sign))
    for joint, line in lines.items():
        loops = through[joint]
        if not loops:
            axes.plot(*line.T, color=GREY, linewidth=1.2, zorder=1)
        for k, (number, sign) in enumerate(loops):
            lane = line + LANE * (k - (len(loops) - 1) / 2) * _aside(line)
            axes.plot(*lane.T, color=palette[number], linewidth=1.6, zorder=2)
            _arrow(axes, lane[::sign], palette[number], small)
    if not small:
        _names(axes, diagram, lines, np.array(list(at.values())), through)
    for part, place in at.items():
        style = {"boxstyle": "round,pad=0.35", "edgecolor": INK, "linewidth": 1.6 if part == diagram.fixed else 0.9}
        box = style | {"facecolor": STILL if part == diagram.fixed else "white"}
        write(axes, place, part, size=5 if small else 8.5, bbox=box, zorder=5)


def write(axes: Axes, at: Place | np.ndarray, text: str, letters: int = MAX_LETTERS, **style: Any) -> None:
    """Write a name in the middle of a place, cut off where it is long; a dollar sign is one."""
    style = {"color": INK, "ha": "center", "va": "center", "parse_math": False} | style
    axes.text(float(at[0]), float(at[1]), clip(text, letters), **style)


def _names(
    axes: Axes,
    diagram: Diagram,
    lines: Mapping[int, Polyline],
    parts: Float[np.ndarray, "parts 2"],
    through: Mapping[int, Sequence[object]],
) -> None:
    """Write the name of each joint beside its line, where the next part, line or name is farthest."""
    taken = [parts]
    for joint, line in lines.items():
        name = diagram.joints[joint]
        half = np.array([_half_width(name), 0.07])
        aside = _aside(line)
        aside = aside * (0.03 + LANE * len(through[joint]) / 2 + np.abs(aside) @ half)[:, None]
        spots = np.concatenate([(line + side * aside)[len(line) * 3 // 10 : len(line) * 7 // 10] for side in (1, -1)])
        others = np.concatenate([*taken, *(other for number, other in lines.items() if number != joint)])
        gaps = np.abs(spots[:, None] - others) / half
        room = np.minimum(gaps.max(axis=-1).min(axis=-1), 3.0)
        from_middle = np.linalg.norm(spots - line[len(line) // 2], axis=1)
        spot = spots[np.argmax(room - 0.5 * from_middle)]
        taken.append(spot[None])
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.8}
        write(axes, spot, name, size=7, color=GREY, bbox=box, zorder=4)


def lines_of(diagram: Diagram, at: Mapping[str, np.ndarray]) -> dict[int, Polyline]:
    """Find the line of each joint from part 1 to part 2; several between the same parts are bowed, one part's is a
    ring."""
    together: dict[tuple[str, ...], list[int]] = defaultdict(list)
    for joint, ends in enumerate(diagram.ends):
        together[tuple(sorted(ends))].append(joint)
    t = np.linspace(0.0, 1.0, 41)[:, None]
    lines: dict[int, Polyline] = {}
    for (first, last), joints in together.items():
        start, end = at[first], at[last]
        for k, joint in enumerate(joints):
            if first == last:
                away = start / np.linalg.norm(start) if start.any() else np.array([0.0, 1.0])
                ring = (0.3 + 0.12 * k) * np.hstack([1 - np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)])
                lines[joint] = start + ring @ np.array([away, [-away[1], away[0]]])
                continue
            across = np.array([start[1] - end[1], end[0] - start[0]])
            bow = BOW * (k - (len(joints) - 1) / 2)
            line = start + t * (end - start) + 4 * t * (1 - t) * bow * across
            lines[joint] = line if diagram.ends[joint][0] == first else line[::-1]
    return lines


def _aside(line: Polyline) -> Polyline:
    """Find where lanes beside a line are looked for, per inch: across it, but from the same part and to the same.

    Whichever way the line is travelled, it is the same side of the drawing.
    """
    along = np.gradient(line, axis=0)
    along = along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    left = np.stack([-along[:, 1], along[:, 0]], axis=1)
    middle = left[len(left) // 2]
    t = np.linspace(0.0, 1.0, len(line))[:, None]
    opening = np.clip(np.minimum(t, 1 - t) / 0.2, 0.0, 1.0)
    return left * opening * (2 - opening) * (1 if (middle[1], middle[0]) >= (0.0, 0.0) else -1)


def _arrow(axes: Axes, line: Polyline, color: Color, small: bool) -> None:
    """Draw an arrow head on the line, after its middle."""
    k = int(0.62 * (len(line) - 1))
    style = {"arrowstyle": "-|>", "color": color, "linewidth": 0, "mutation_scale": 7 if small else 13}
    axes.annotate("", xy=line[k + 1], xytext=line[k - 1], zorder=3, arrowprops=style)
