"""What accuracy costs in time: the sweep of a user's own mechanism at many tolerances, precisions and methods."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import jax
import numpy as np

from jaxkin._arguments import by_name, check_known, check_mechanism, one_number, several
from jaxkin._guesses import Result
from jaxkin.effects.extended import Extended
from jaxkin.linkage.coordinates import coordinate, named
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.options import CONTINUATION, METHODS, SolverOptions, options_with

FORMULA = "formula"
"""Name of the sweep that is computed by formulas, which have no tolerance; other sweeps here do without them."""
TOLERANCES = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14)
TIGHTEST_32 = 1e-6
"""The tightest tolerance that float32 is asked for: rounding leaves about 5e-7."""
COMPARED_POSES = 12
"""Poses whose error is measured: extended precision takes longer for a few than a sweep for all."""
MAX_RUNS = 7
"""Sweeps that are timed, at most, of which the median counts."""
MAX_SECONDS = 2.0
"""Seconds after which no more sweeps are timed."""


class WorkPrecisionPoint(NamedTuple):
    """Time and error of one sweep."""

    method: str
    """One of `METHODS`, or "formula"."""
    precision: str
    """float64 or float32."""
    tolerance: float | None
    """Closure residual asked for; None: down to rounding."""
    seconds: float
    """Time of the sweep, compiled before: the median of several."""
    error: float
    """Largest error of a pose in radians and characteristic lengths, against the pose in extended precision; NaN where
    none of the compared poses is closed."""
    residual: float
    """Largest closure residual of the closed poses."""
    closed: float
    """Fraction of the poses that is closed."""


@dataclass(frozen=True, repr=False)
class WorkPrecision(Result):
    """Time against error of the sweeps of one mechanism. Prints itself as a table, and draws itself."""

    points: tuple[WorkPrecisionPoint, ...]
    poses: int
    compared: int
    """Poses whose error was measured."""

    @property
    def advice(self) -> str:
        """What accuracy costs here, in one sentence."""
        known = [point for point in self.points if np.isfinite(point.error)]
        if not known:
            return "None of the compared poses closed: there is no error to tell."
        double = [each for each in known if each.method == CONTINUATION and each.precision == "float64"] or known
        best = min(double, key=lambda point: point.error)
        coarse = [point for point in double if point.error <= 1e-4]
        cheap = min(coarse or double, key=lambda point: point.seconds)
        more = best.seconds / cheap.seconds - 1
        cost = f"costs {more:.0%} more than" if more >= 0.05 else "costs no more than"
        single = [point.error for point in known if point.precision == "float32"]
        end = f"; float32 stops at {min(single):.0e}" if single else ""
        alike = [p for p in known if p.method != best.method and p.closed == 1 and p.error <= 10 * best.error]
        if alike:
            quick = min(alike, key=lambda point: point.seconds)
            end += f"; {quick.method}, as accurate, takes {quick.seconds / best.seconds:.2g} times as long"
        if cheap is best:
            return f"The least error, {best.error:.0e}, costs no more than larger ones here{end}."
        return f"An error of {best.error:.0e} {cost} one of {cheap.error:.0e} here{end}."

    def __str__(self) -> str:
        lines = [
            f"{self.poses} poses, errors of {self.compared} of them against extended precision",
            f"{'method':22}{'precision':>10}{'tolerance':>11}{'us a pose':>11}{'error':>9}{'residual':>10}  closed",
        ]
        for point in self.points:
            asked = "rounding" if point.tolerance is None else f"{point.tolerance:.0e}"
            micro = point.seconds / self.poses * 1e6
            lines.append(
                f"{point.method:22}{point.precision:>10}{asked:>11}{micro:>11.2f}{point.error:>9.0e}"
                f"{point.residual:>10.0e}{point.closed:>8.0%}"
            )
        return "\n".join([*lines, self.advice])

    def plot(self, path: str | Path) -> Path:
        """Draw time against error, both logarithmic, into a picture file."""
        from jaxkin.effects.work_plot import draw

        points = ((point.method, point.precision, point.error, point.seconds) for point in self.points)
        return draw(points, self.poses, Path(path))


def work_precision(
    mechanism: Mechanism,
    drive: Mapping[str, object],
    *,
    tolerances: Sequence[float] = TOLERANCES,
    methods: Sequence[str] = METHODS,
    options: SolverOptions | None = None,
    step: Callable[[str], None] = lambda what: None,
) -> WorkPrecision:
    """Sweep a mechanism at many tolerances, in both precisions and by several methods, and measure time and error.

    Where the loops that the drive moves have formulas, and `options` do not forbid them, these come first; all methods
    then do without them.

    Each method is a program of its own, which is compiled before it is timed: over a point on a surface, 9 to 17 s of a
    processor for each of the reference methods, and 5 for the continuation; `methods=["continuation"]` leaves the
    others out.

    Errors are against poses in extended precision, near those that the sweep finds; coordinates of idle freedoms have
    no exact value and are left out. `options` says all but tolerance and method, which vary. `step` is told what is
    about to be swept. Needs mpmath. Raises ValueError as `sweep` does, where `options` say a tolerance or a method, and
    where no pose closes.
    """
    check_mechanism(mechanism, "accuracy and time")
    driven = by_name(drive, "driven displacements", "{'A': angles}")
    check_known("accuracy and time", "jk.work_precision", mechanism, *driven.values())
    entries = several(tolerances, "tolerances", "numbers", "[1e-6, 1e-12]")
    tolerances = tuple(float(one_number(each, "each of the tolerances")) for each in entries)
    methods = several(methods, "methods", "names of methods")
    options = options_with(options)
    for name, of_options in (("tolerance", options.tolerance), ("method", options.method)):
        if of_options != getattr(SolverOptions, name):
            raise ValueError(f"options say {name}={of_options!r}, which is varied here: write {name}s=[{of_options!r}]")
    reference = mechanism.sweep(drive, options=options)
    closed = np.flatnonzero(np.asarray(reference.closed))
    if not len(closed):
        raise ValueError("no pose of this drive closes, so there is nothing to measure: see the status of its sweep")
    chosen = np.unique(closed[np.linspace(0, len(closed) - 1, COMPARED_POSES).round().astype(int)])
    exact = _ExactPoses(mechanism, reference, chosen)
    points = []
    for method, precision, tolerance in combinations(tolerances, methods, _has_formulas(mechanism, drive, options)):
        step(f"{method}, {precision}, {'rounding' if tolerance is None else f'{tolerance:.0e}'}")
        with jax.enable_x64(precision == "float64"), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "jaxkin computes in float32")  # that is what is asked for
            by_formula = method == FORMULA
            found_by = CONTINUATION if by_formula else method
            asked = replace(options, method=found_by, tolerance=tolerance, formulas=by_formula)
            points.append(_measured(mechanism, drive, asked, precision, exact)._replace(method=method))
    return WorkPrecision(tuple(points), len(reference), int(exact.known.sum()))


def combinations(
    tolerances: Sequence[float] = TOLERANCES, methods: Sequence[str] = METHODS, by_formula: bool = True
) -> list[tuple[str, str, float | None]]:
    """List method, precision and tolerance of every sweep; the continuation in both precisions, and down to
    rounding."""
    found: list[tuple[str, str, float | None]] = [(FORMULA, "float64", None)] if by_formula else []
    for method in methods:
        found += [(method, "float64", tolerance) for tolerance in tolerances]
        if method == CONTINUATION:
            found += [(method, "float64", None)]
            found += [(method, "float32", tolerance) for tolerance in tolerances if tolerance >= TIGHTEST_32]
            found += [(method, "float32", None)]
    return found


def _has_formulas(mechanism: Mechanism, drive: Mapping[str, object], options: SolverOptions) -> bool:
    loop_groups = plan_drive(mechanism.linkage, named(drive)).loop_groups
    return options.formulas and bool(loop_groups) and all(loop_group.axes is not None for loop_group in loop_groups)


def _measured(
    mechanism: Mechanism, drive, options: SolverOptions, precision: str, exact: _ExactPoses
) -> WorkPrecisionPoint:
    """Time one sweep, compiled before, and measure its error."""

    def run() -> Motion:
        return jax.block_until_ready(mechanism.sweep(drive, options=options))

    motion, times = run(), []
    while len(times) < MAX_RUNS and (not times or sum(times) < MAX_SECONDS):
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    closed = np.asarray(motion.closed)
    residual = float(np.max(np.asarray(motion.residual)[closed], initial=0.0))
    seconds = float(np.median(times))
    error = exact.error(motion)
    return WorkPrecisionPoint(
        options.method, precision, options.tolerance, seconds, error, residual, float(closed.mean())
    )


class _ExactPoses:
    """Exact poses at some places of a motion, and the errors of other motions there."""

    def __init__(self, mechanism: Mechanism, motion: Motion, chosen: np.ndarray) -> None:
        self.chosen, self.loop_groups = chosen, []
        self.known = np.ones(len(chosen), bool)
        """At which of the places the exact pose was found."""
        driven = [coordinate(mechanism.linkage, name) for name in motion.inputs]
        for loop_group in mechanism.structure.loop_groups:
            columns = [(joint, k) for joint in loop_group.joints for k in range(mechanism.all_joints[joint].freedoms)]
            free = [number for number, column in enumerate(columns) if column not in driven]
            if len(free) == len(columns):
                continue
            loops = Extended(mechanism, loop_group, free)
            rows = self._rows(motion, loop_group.joints)
            poses, ended = zip(*(loops.closed(row) for row in rows), strict=True)
            self.known &= ended
            self.loop_groups.append(
                (loop_group.joints, loops, poses, [np.eye(len(row)) - loops.idle(row) for row in poses])
            )

    def error(self, motion: Motion) -> float:
        """Measure the largest error of the known poses that are closed, in radians and characteristic lengths; NaN
        where none is."""
        closed = np.asarray(motion.closed)[self.chosen] & self.known
        largest = 0.0 if closed.any() else np.nan
        for joints, loops, poses, seen in self.loop_groups:
            for row, pose, kept, is_closed in zip(self._rows(motion, joints), poses, seen, closed, strict=True):
                if is_closed:
                    off = (row - pose) / loops.loops.units
                    off -= np.where(loops.loops.units == 1.0, 2 * np.pi * np.round(off / (2 * np.pi)), 0.0)
                    largest = max(largest, float(np.abs(kept @ off).max(initial=0.0)))
        return largest

    def _rows(self, motion: Motion, joints: Sequence[int]) -> np.ndarray:
        """List the displacements of the joints at the chosen poses (poses, columns), in float64."""
        parts = [np.asarray(motion.displacements[joint], np.float64)[self.chosen] for joint in joints]
        return np.concatenate(parts, axis=1)
