"""The curve that a point of a part draws, with its cusps and crossings found to rounding (host code).

At a cusp the point stands still while the drive moves: it lies on the moving centrode, at the instantaneous pole. At a
crossing two inputs put it to the same place. Both are refined on poses that are swept anew (`cusps_crossings`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import check_known, check_motion
from jaxkin._files import save_figure
from jaxkin._guesses import Result
from jaxkin._names import counted, listed, nearest
from jaxkin.effects.curve_range import DOUBLE, SINGLE, CurvePoints, CurveRange, Evaluate, range_of
from jaxkin.effects.cusps_crossings import Crossing, Cusp, crossings_of, cusps_of
from jaxkin.effects.pose_plot import save_rows
from jaxkin.effects.rates import accelerations
from jaxkin.geometry.headings import coordinate_with_unit, places_with_unit
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.pose import Vector
from jaxkin.mechanism.motion import Motion, as_point

UPRIGHT = 1e-9
"""What the cosine between the normal of a curve and an axis of the world lacks of 1, up to which its axes are those of
the world: rounding of poses in either precision leaves less."""
POSES = 128
"""Poses that are evaluated together: all that is refined in one, and a whole motion in a few calls of that program."""


@dataclass(frozen=True, eq=False, repr=False)
class CouplerCurve(Result):
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
    unit: str
    """Unit of lengths."""
    rests: bool = False
    """Whether the point does not move, as that at the fixed pivot of a crank: it has no plane, cusps and crossings."""

    def __str__(self) -> str:
        """Describe the curve in a line, and each cusp and crossing in one."""
        about = f"Curve of a point of {self.part} over {self.drive}, {counted(len(self.inputs), 'pose')}"
        if unknown := int(np.isnan(self.points).any(axis=1).sum()):
            about += f", {unknown} of them not closed"
        if self.rests:
            return f"{about}: the point rests at {self._place(np.nanmean(self.points, axis=0))}"
        shape = "plane" if self.plane is not None else "not plane, so that crossings were not looked for"
        lines = [f"{about}, {shape}"]
        for cusp in self.cusps:
            lines.append(f"  cusp at {cusp.input:.9g}: {self._place(cusp.point)}")
        for crossing in self.crossings:
            one, other = crossing.inputs
            lines.append(
                f"  crossing at {one:.9g} and {other:.9g}: {self._place(crossing.point)}, "
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
        axes_of = self.plane if self.plane is not None else _axes(self.points, 0.0)[0]
        figure = Figure(figsize=(6.4, 5.2), layout="constrained")
        axes = figure.add_subplot()
        known = np.pad(np.isfinite(self.points).all(axis=1), 1)
        alone = known[1:-1] & ~known[:-2] & ~known[2:]  # no line goes through these: they are dots
        axes.plot(*(self.points @ axes_of.T).T, color="C0", label=f"a point of {self.part}")
        axes.plot(*(self.points[alone] @ axes_of.T).T, "o", markersize=4, color="C0")
        for name, marker, found in (("cusp", "x", self.cusps), ("crossing", "o", self.crossings)):
            if found:
                at = np.array([each.point for each in found]) @ axes_of.T
                axes.plot(*at.T, marker, color="black", fillstyle="none", label=name)
        unit = f" ({self.unit})" if self.unit else ""
        seen = "in the plane of the curve" if self.plane is not None else "seen along its least extent"
        axes.set(xlabel=seen + unit, ylabel=f"across{unit}")
        axes.set_aspect("equal")
        axes.grid(alpha=0.3)
        figure.legend(fontsize="small", frameon=False, loc="outside lower center", ncols=3)
        return save_figure(figure, path)

    def save(self, path: str | Path) -> Path:
        """Write input and point of each pose as comma-separated values; returns the path."""
        names = [coordinate_with_unit(self.drive, self.unit), *places_with_unit(self.unit)]
        return save_rows(names, np.vstack([self.inputs, self.points.T]), Path(path))

    def _place(self, point: Vector) -> str:
        return f"({', '.join(f'{x:.6g}' for x in point)}) {self.unit}".rstrip()


def coupler_curve(motion: Motion, part: str, point: Sequence[float | int] | np.ndarray | Array) -> CouplerCurve:
    """Find the curve of a point of a part over the one drive of a motion, with its cusps and crossings.

    `point` is given where it is in the assembled pose. The motion tells cusps and crossings apart by its steps: two
    crossings within one step are missed, and so is a loop smaller than a step. Branches that lie on each other, as
    where a curve is drawn twice, do not cross, nor do the two sides of a cusp. Of a curve that repeats itself after
    full turns of the drive, cusps and crossings are those of the first time, and its ends are one pose. Poses between
    those of the motion are swept with its options.

    Raises ValueError for motions with several drives, with fewer than four closed poses, for a part that is not there,
    and inside `jit`, `vmap` and `grad`.
    """
    check_motion(motion, "coupler curves")
    check_known("cusps and crossings", "jk.coupler_curve", motion, point)
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
    precision = DOUBLE if np.finfo(motion.residual.dtype).bits == 64 else SINGLE
    extent, unit = float(np.ptp(points[closed], axis=0).max()), motion.mechanism.unit
    if extent <= precision.rests * _largest_coordinate(motion, points[closed]):
        return CouplerCurve(part, drive, inputs, points, (), (), None, unit, rests=True)
    axes, flat = _axes(points, precision.flat)
    # a motion may pass inputs several times, and rest at them; the curve is a function of the input
    own, first = np.unique(inputs[closed], return_index=True)
    passed = points[closed][first]
    if is_length(drive.rpartition(".")[2]):
        curve = CurveRange(own, passed, False, precision)
    else:
        curve = range_of(evaluate, own, passed, extent, precision)
    cusps = cusps_of(evaluate, curve)
    crossings = crossings_of(evaluate, axes, curve, extent, cusps) if flat else ()
    return CouplerCurve(part, drive, inputs, points, cusps, crossings, axes if flat else None, unit)


def _evaluation(motion: Motion, drive: str, part: str, at: Vector) -> Evaluate:
    """Make the function that computes the curve at any inputs, as many at a time as one compiled program has."""
    number = motion.mechanism.parts.index(part)

    def some(inputs: Float[np.ndarray, " inputs"]) -> CurvePoints:
        padded = np.pad(inputs, (0, POSES - len(inputs)), mode="edge")
        swept = motion.mechanism.sweep({drive: padded}, options=motion.options)
        rates = [np.asarray(every[number], float) for every in accelerations(swept, {drive: 1.0}).matrices]
        slope, bend = (each[:, :3, :3] @ at + each[:, :3, 3] for each in rates)
        rows = np.asarray(swept.points(part, at), float), slope, bend, np.asarray(swept.closed)
        return CurvePoints(*(each[: len(inputs)] for each in rows))

    def evaluate(inputs: Float[np.ndarray, " inputs"]) -> CurvePoints:
        found = [some(inputs[first : first + POSES]) for first in range(0, len(inputs), POSES)]
        return CurvePoints(*map(np.concatenate, zip(*found, strict=True)))

    return evaluate


def _largest_coordinate(motion: Motion, points: Float[np.ndarray, "poses 3"]) -> float:
    """Find the largest coordinate, without sign, of points and of the joints as assembled: poses are rounded to it."""
    joints = [np.asarray(joint.frames_1, float)[:, :3, 3] for joint in motion.mechanism.all_joints]
    return float(np.abs(np.concatenate([points, *joints])).max())


def _axes(points: Float[np.ndarray, "poses 3"], thin: float) -> tuple[Float[np.ndarray, "2 3"], bool]:
    """Find two axes along which points extend most, and whether they extend across these by the share `thin` at most.

    Axes of the world are kept where the points lie in a plane of two of them, so that pictures stand upright.
    """
    known = points[np.isfinite(points).all(axis=1)]
    _, sizes, directions = np.linalg.svd(known - known.mean(axis=0), full_matrices=False)
    flat = bool(sizes[2] <= thin * sizes[0])
    if flat and (across := np.abs(directions[2])).max() > 1 - UPRIGHT:
        return np.delete(np.eye(3), int(across.argmax()), axis=0), flat
    return directions[:2], flat
