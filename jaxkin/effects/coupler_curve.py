"""The curve that a point of a part draws, with its cusps and crossings found to rounding (host code).

At a cusp the point stands still while the drive moves: it lies on the moving centrode, at the instantaneous pole. At a
crossing two inputs put it to the same place. Both are told apart by the steps of the motion, and refined by Newton's
method on poses that are swept anew: p' . p'' = 0 for a cusp, p(u) = p(v) for a crossing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._arguments import check_motion
from jaxkin._files import save_figure
from jaxkin._names import listed, nearest
from jaxkin._traced import traced
from jaxkin.effects.pose_plot import save_rows
from jaxkin.effects.rates import accelerations, velocities
from jaxkin.mechanism.motion import Motion, as_point

NEWTON_STEPS = 12
"""Newton steps from the steps of the motion: from a few degrees, five reach rounding."""
STANDS_STILL = 1e-9
"""Speed of the point, over its largest one, at which it counts as standing still: a hundred times the rounding of a
pose over the steps of the drive, and far below what a curve without a cusp shows."""
MEETS = 1e-10
"""Distance of two points, over the extent of the curve, at which they count as one: rounding of the poses, which is
that of the mechanism, for a curve of a hundredth of its size."""
FLAT = 1e-9
"""Extent of a curve across its plane, over that along it, up to which it counts as plane."""
ONE_INPUT = 1e-6
"""Difference of two inputs, over the steps of the motion, up to which they are one: far more than refining leaves, and
far less than two cusps or crossings that steps can tell apart."""
ALONG_STEPS = 2.0
"""Steps of the motion that a crossing may be refined away from where its polygons cross: curves beside their chords
cross in the next step at most."""
TOUCHES = 1e-12
"""What the cosine between two tangents lacks of 1, up to which the curve touches itself, or passes a pose again, and
does not cross: an angle of 1e-6, as exact as tangents at refined places are."""
BLOCK = 512
"""Steps of the curve that are compared with all others at once: some megabytes of numbers."""

Place = Float[np.ndarray, "3"]


class Cusp(NamedTuple):
    """A pose in which the point stands still and turns back."""

    input: float
    """Displacement of the drive."""
    point: Place


class Crossing(NamedTuple):
    """A place through which the curve passes twice."""

    inputs: tuple[float, float]
    """Displacements of the drive."""
    point: Place
    angle: float
    """Between the tangents, radians, 0 to pi/2."""


@dataclass(frozen=True, eq=False)
class CouplerCurve:
    """The path of a point of a part over one drive. Prints, draws and saves itself."""

    part: str
    drive: str
    """The driven coordinate."""
    inputs: Float[np.ndarray, " poses"]
    points: Float[np.ndarray, "poses 3"]
    """World coordinates, unit of the mechanism; NaN at poses that are not closed (`motion.closed`)."""
    cusps: tuple[Cusp, ...]
    crossings: tuple[Crossing, ...]
    """Empty for curves that are not plane: these do not cross themselves but by chance."""
    plane: Float[np.ndarray, "2 3"] | None
    """Axes of the plane of the curve; None where it has none."""

    def __str__(self) -> str:
        """A line for the curve, and one for each cusp and crossing."""
        shape = "plane" if self.plane is not None else "not plane, so that crossings were not looked for"
        lines = [f"Curve of a point of {self.part} over {self.drive}, {len(self.inputs)} poses, {shape}"]
        for cusp in self.cusps:
            lines.append(f"  cusp at {cusp.input:.9g}: {_place(cusp.point)}")
        for crossing in self.crossings:
            one, other = crossing.inputs
            lines.append(
                f"  crossing at {one:.9g} and {other:.9g}: {_place(crossing.point)}, "
                f"{np.degrees(crossing.angle):.4g} deg"
            )
        if not self.cusps and not self.crossings:
            lines.append("  no cusp, no crossing")
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw the curve in its plane with cusps (x) and crossings (o) into a picture file; returns its path.

        A curve without a plane is drawn as seen along its least extent.
        """
        from matplotlib.figure import Figure

        path = Path(path)
        axes_of = self.plane if self.plane is not None else _axes(self.points)[0]
        figure = Figure(figsize=(6.4, 5.2), layout="constrained")
        axes = figure.add_subplot()
        axes.plot(*(self.points @ axes_of.T).T, label=f"a point of {self.part}")
        for name, marker, found in (("cusp", "x", self.cusps), ("crossing", "o", self.crossings)):
            if found:
                at = np.array([each.point for each in found]) @ axes_of.T
                axes.plot(*at.T, marker, color="black", fillstyle="none", label=name)
        axes.set(xlabel="in the plane of the curve, unit of the mechanism")
        axes.set_aspect("equal")
        axes.grid(alpha=0.3)
        figure.legend(fontsize="small", frameon=False, loc="outside lower center", ncols=3)
        return save_figure(figure, path)

    def save(self, path: str | Path) -> Path:
        """Write input and point of each pose as comma-separated values; returns the path."""
        return save_rows([self.drive, "x", "y", "z"], np.vstack([self.inputs, self.points.T]), Path(path))


def coupler_curve(motion: Motion, part: str, point: Sequence[float | int] | np.ndarray | Array) -> CouplerCurve:
    """Find the curve of a point of a part over the one drive of a motion, with its cusps and crossings.

    `point` is given where it is in the assembled pose. The motion tells cusps and crossings apart by its steps: two
    crossings within one step are missed, and so is a loop smaller than a step. Branches that lie on each other, as
    where a curve is drawn twice, do not cross. Poses between those of the motion are swept with its options.

    Raises ValueError for motions with several drives, with fewer than four closed poses, for a part that is not there,
    and inside `jit`, `vmap` and `grad`.
    """
    check_motion(motion, "coupler curves")
    if traced(motion, point):
        raise ValueError("cusps and crossings are found on the host: call coupler_curve outside of jit, vmap and grad")
    if len(motion.inputs) != 1:
        raise ValueError(f"a curve has one drive, and this motion has {listed(list(motion.inputs))}: hold the others")
    if part not in motion.mechanism.parts:
        raise ValueError(f"there is no part {part!r}{nearest(str(part), motion.mechanism.parts)}")
    at = np.asarray(as_point(point), float)
    ((drive, values),) = motion.inputs.items()
    inputs, closed = np.asarray(values, float), np.asarray(motion.closed)
    if closed.sum() < 4:
        raise ValueError(f"a curve needs four closed poses, and this motion has {closed.sum()} of {len(closed)}")
    points = np.where(closed[:, None], np.asarray(motion.points(part, at), float), np.nan)
    evaluate = _evaluation(motion, drive, part, at)
    axes, flat = _axes(points)
    extent = float(np.nanmax(np.ptp(points[closed], axis=0)))
    # a motion may pass inputs several times, and rest at them; the curve is a function of the input
    own, first = np.unique(inputs[closed], return_index=True)
    cusps = _cusps(evaluate, own)
    crossings = _crossings(evaluate, axes, own, points[closed][first], extent, cusps) if flat and extent > 0 else ()
    return CouplerCurve(part, drive, inputs, points, cusps, crossings, axes if flat else None)


class _Curve(NamedTuple):
    """Points of a curve and their derivatives by the input; and where there are some."""

    point: Float[np.ndarray, "inputs 3"]
    slope: Float[np.ndarray, "inputs 3"]
    bend: Float[np.ndarray, "inputs 3"]
    closed: Bool[np.ndarray, " inputs"]


Evaluate = Callable[[Float[np.ndarray, " inputs"]], _Curve]


def _evaluation(motion: Motion, drive: str, part: str, at: Place) -> Evaluate:
    """Make the function that computes the curve at any inputs."""

    def evaluate(inputs: Float[np.ndarray, " inputs"]) -> _Curve:
        # all of few lengths, so that they share compiled programs
        padded = np.pad(inputs, (0, 2 ** max(5, (len(inputs) - 1).bit_length()) - len(inputs)), mode="edge")
        swept = motion.mechanism.sweep({drive: padded}, options=motion.options)
        rates = velocities(swept, {drive: 1.0}), accelerations(swept, {drive: 1.0})
        rows = (swept.points(part, at), *(each.points(part, at) for each in rates))
        point, slope, bend = (np.asarray(each, float)[: len(inputs)] for each in rows)
        return _Curve(point, slope, bend, np.asarray(swept.closed)[: len(inputs)])

    return evaluate


def _axes(points: Float[np.ndarray, "poses 3"]) -> tuple[Float[np.ndarray, "2 3"], bool]:
    """Axes along which points extend most, and whether they extend along these only.

    Axes of the world are kept where the points lie in a plane of two of them, so that pictures stand upright.
    """
    known = points[np.isfinite(points).all(axis=1)]
    _, sizes, directions = np.linalg.svd(known - known.mean(axis=0), full_matrices=False)
    flat = bool(sizes[2] <= FLAT * sizes[0])
    if flat and (across := np.abs(directions[2])).max() > 1 - FLAT:
        return np.delete(np.eye(3), int(across.argmax()), axis=0), flat
    return directions[:2], flat


def _cusps(evaluate: Evaluate, inputs: np.ndarray) -> tuple[Cusp, ...]:
    """Refine the least speeds of the point, and keep those that are zero."""
    speed = np.sum(evaluate(inputs).slope ** 2, axis=1)
    beside = np.pad(speed, 1, constant_values=np.inf)
    at = inputs[(speed <= beside[:-2]) & (speed <= beside[2:])]
    if len(inputs) < 2 or speed.max() == 0:
        return ()
    step = np.diff(inputs).max()
    begun = at.copy()
    for _ in range(NEWTON_STEPS):
        found = evaluate(at)
        # Gauss-Newton on the velocity, which is linear in the input beside a cusp
        square = np.sum(found.bend**2, axis=1)
        change = np.sum(found.slope * found.bend, axis=1) / np.where(square > 0, square, 1.0)
        at = np.clip(at - change, begun - step, begun + step)
    found = evaluate(at)
    still = found.closed & (np.linalg.norm(found.slope, axis=1) <= STANDS_STILL * np.sqrt(speed.max()))
    cusps: list[Cusp] = []
    for u, point in zip(at[still], found.point[still], strict=True):
        if all(abs(u - other.input) > ONE_INPUT * step for other in cusps):
            cusps.append(Cusp(float(u), point))
    return tuple(cusps)


def _crossings(
    evaluate: Evaluate,
    axes: Float[np.ndarray, "2 3"],
    inputs: np.ndarray,
    points: np.ndarray,
    extent: float,
    cusps: Sequence[Cusp],
) -> tuple[Crossing, ...]:
    """Find steps of the curve that cut each other, and refine where."""
    pairs = _cut_steps(points @ axes.T)
    if not len(pairs):
        return ()
    step = np.diff(inputs).max()
    one, other = inputs[pairs].T + 0.5 * np.diff(inputs)[pairs].T
    begun = np.stack([one, other])
    at = begun.copy()
    for _ in range(NEWTON_STEPS):
        here = evaluate(at.ravel())
        place, slope = ((each @ axes.T).reshape(2, -1, 2) for each in (here.point, here.slope))
        # slope(u) du - slope(v) dv = p(v) - p(u)
        apart, (a, b) = place[1] - place[0], slope
        area = -a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0]
        area = np.where(area == 0, np.inf, area)
        du = (-apart[:, 0] * b[:, 1] + apart[:, 1] * b[:, 0]) / area
        dv = (a[:, 0] * apart[:, 1] - a[:, 1] * apart[:, 0]) / area
        at = np.clip(at + np.stack([du, dv]), begun - ALONG_STEPS * step, begun + ALONG_STEPS * step)
    here = evaluate(at.ravel())
    place, slope = (each.reshape(2, -1, 3) for each in (here.point, here.slope))
    good = here.closed.reshape(2, -1).all(axis=0)
    good &= np.linalg.norm(place[1] - place[0], axis=1) <= MEETS * extent
    good &= np.abs(at[1] - at[0]) > ONE_INPUT * step
    # where the input makes a full turn, its ends are one pose
    lengths = np.linalg.norm(slope, axis=2)
    cosine = np.abs(np.sum(slope[0] * slope[1], axis=1)) / np.where(lengths.prod(axis=0) > 0, lengths.prod(axis=0), 1.0)
    good &= cosine < 1 - TOUCHES
    crossings: list[Crossing] = []
    for k in np.flatnonzero(good):
        u, v = sorted(map(float, at[:, k]))
        at_cusp = any(
            abs(u - each.input) < ONE_INPUT * step or abs(v - each.input) < ONE_INPUT * step for each in cusps
        )
        known = any(np.abs(np.subtract(each.inputs, (u, v))).max() < ONE_INPUT * step for each in crossings)
        if not at_cusp and not known:
            crossings.append(Crossing((u, v), place[0, k], float(np.arccos(min(1.0, cosine[k])))))
    return tuple(crossings)


def _cut_steps(points: Float[np.ndarray, "poses 2"]) -> np.ndarray:
    """List the pairs of steps of a polygon, not neighbours, that cut each other: (pairs, 2)."""
    a, b = points[:-1], points[1:]
    found = []

    def side(p, q, r):
        return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])

    for first in range(0, len(a), BLOCK):
        p, q = a[first : first + BLOCK, None], b[first : first + BLOCK, None]
        cut = (side(p, q, a) * side(p, q, b) <= 0) & (side(a, b, p) * side(a, b, q) <= 0)
        rows, columns = np.nonzero(cut)
        rows = rows + first
        later = columns > rows + 1
        found.append(np.stack([rows[later], columns[later]], axis=1))
    return np.concatenate(found)


def _place(point: Place) -> str:
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"
