"""What an optimisation found: the design, how it got there, and whether it moves through the whole range."""

from __future__ import annotations

import json
import os
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import BadZipFile

import numpy as np

from jaxkin._files import save_figure, whole
from jaxkin._guesses import Result
from jaxkin._names import counted
from jaxkin.design.objective import Objective
from jaxkin.geometry.characteristic_length import centroid_and_length
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import check_unit
from jaxkin.linkage.record import UNREADABLE, as_record, from_record
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.status import CLOSED_ON_BRANCH, Status

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

POSES, PIECE = 361, 32
"""Of the range, and at least of what is swept at once."""
STEEP = 100.0
"""Radians, or lengths over the size of the mechanism, per radian of the drive: beyond it a pose is near-singular."""
SAVED_FORMAT = 3
"""Version of the files that `Optimum.save` writes, raised with every change of their fields: those of `SweepVerdict`
and `Optimum`, and of `jaxkin.linkage.record`. Files of another version are refused."""


@dataclass(frozen=True)
class SweepVerdict:
    """The verdict of a fine sweep over the range of the drive."""

    poses: int
    counts: dict[str, int]
    """Number of poses of each status that occurs."""
    steepest: float
    """Largest change of any joint from pose to pose over that of the drive: it grows as 1/sqrt(distance) to a limit."""

    @property
    def everywhere(self) -> bool:
        """Whether all poses close on one branch, and none is near-singular."""
        return self.counts.get("CLOSED", 0) == self.poses and self.steepest < STEEP

    def __str__(self) -> str:
        said = ", ".join(f"{count} {name}" for name, count in self.counts.items())
        verdict = "moves through the whole range" if self.everywhere else "does not move through the whole range"
        near = (
            f"; near-singular, joints up to {self.steepest:.3g} times as fast as the drive"
            if self.steepest >= STEEP
            else ""
        )
        return f"{verdict} ({said} of {self.poses} poses{near})"


@dataclass(frozen=True, eq=False, repr=False)
class Optimum(Result):
    """The best design of `optimize`."""

    mechanism: Mechanism
    value: float
    """Its loss, without penalty."""
    violation: float
    """Root of the sum of squares of closure residuals, misfits and lacks of constraints; at most 1e-6 if feasible."""
    history: np.ndarray
    """Loss with penalty after every iteration (iterations, starts); nan for starts that have retired."""
    reason: str
    """Why the search ended."""
    seconds: float
    values: dict[str, float]
    """All variables by name."""
    extras: dict[str, np.ndarray]
    drive: dict[str, np.ndarray]
    """The drive, with the inputs that were chosen."""
    losses: np.ndarray
    """Where every start ended."""
    violations: np.ndarray
    moves: SweepVerdict
    motion: Motion | None = None
    initial: tuple[Motion, dict[str, Any]] | None = None
    """Motion and extras of the design given; not saved."""
    loss: Any = None
    """Not saved."""

    @property
    def feasible(self) -> bool:
        """Whether the design closes in all poses asked for and meets all constraints."""
        return self.violation <= 1e-6

    def __str__(self) -> str:
        lines = [
            f"Optimum {self.value:.6g}{'' if self.feasible else f', infeasible by {self.violation:.1g}'}, from "
            f"{counted(len(self.losses), 'start')} in {self.seconds:.1f} s",
            f"  {self.reason}",
            f"  {self.moves}",
        ]
        width = max(len(name) for name in self.values)
        lines += [f"  {name.ljust(width)}  {value:.6g}" for name, value in self.values.items()]
        return "\n".join(lines)

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Draw a matplotlib figure: the losses over the iterations, and the objective before and after. It is written
        into a picture file where a path is given."""
        from matplotlib.figure import Figure
        from matplotlib.ticker import MaxNLocator

        objective, motion = self.loss if isinstance(self.loss, Objective) else None, self.motion
        drawn = objective is not None and motion is not None
        figure = Figure(figsize=(10 if drawn else 5, 3.8), layout="constrained")
        axes = figure.subplots(1, 2 if drawn else 1, squeeze=False)[0]
        iterations = np.arange(1, len(self.history) + 1)
        best = np.fmin.accumulate(np.nanmin(np.where(np.isnan(self.history), np.inf, self.history), axis=1))
        axes[0].plot(iterations, self.history, color="0.75", linewidth=0.8)
        axes[0].plot(iterations, best, color="C0", label="best so far")
        known = self.history[np.isfinite(self.history)]
        if np.any(known > 0) and not np.any(known < 0):  # no negative loss, as of what is to grow, has a logarithm
            axes[0].set_yscale("log")
        axes[0].set_xlabel("iteration")
        axes[0].xaxis.set_major_locator(MaxNLocator(integer=True))
        axes[0].set_ylabel("loss with penalty")
        axes[0].legend(frameon=False)
        if objective is not None and motion is not None:
            if self.initial is not None:
                objective.plot(axes[1], *self.initial, color="0.6", label="before", linewidth=1.0)
            objective.plot(axes[1], motion, self.extras, color="C1", label="after")
            axes[1].legend(frameon=False)
        for each in axes:
            each.spines[["top", "right"]].set_visible(False)
        if path is not None:
            save_figure(figure, Path(path))
        return figure

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the result into one file (.npz): design, values, history, verdict. Read it back with `read_optimum`."""
        target = Path(path)
        if target.suffix != ".npz":
            raise ValueError(f"the result is saved as a .npz file, got {str(target)!r}")
        text = {
            "format": SAVED_FORMAT,
            "value": self.value,
            "violation": self.violation,
            "reason": self.reason,
            "seconds": self.seconds,
            "values": self.values,
            "moves": {"poses": self.moves.poses, "counts": self.moves.counts, "steepest": self.moves.steepest},
            "unit": self.mechanism.unit,
            "linkage": as_record(self.mechanism.linkage),
        }
        arrays: dict[str, Any] = {"text": np.array(json.dumps(text))}
        arrays |= {"history": self.history, "losses": self.losses, "violations": self.violations}
        arrays |= {f"drive {name}": value for name, value in self.drive.items()}
        arrays |= {f"extra {name}": value for name, value in self.extras.items()}
        with whole(target) as draft, open(draft, "wb") as file:
            np.savez_compressed(file, **arrays)
        return target


def read_optimum(path: str | os.PathLike[str]) -> Optimum:
    """Read a result that `Optimum.save` wrote. Raises ValueError where the file is none."""
    try:
        with open(path, "rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        text = json.loads(str(arrays.pop("text")))
        if text["format"] != SAVED_FORMAT:
            raise ValueError(f"format {text['format']}, and this version reads {SAVED_FORMAT}")
        drive, extras = (
            {name.removeprefix(kind): value for name, value in arrays.items() if name.startswith(kind)}
            for kind in ("drive ", "extra ")
        )
        return Optimum(
            mechanism=Mechanism(from_record(text["linkage"]), check_unit(text["unit"])),
            **{name: text[name] for name in ("value", "violation", "reason", "seconds", "values")},
            **{name: arrays[name] for name in ("history", "losses", "violations")},
            extras=extras,
            drive=drive,
            moves=SweepVerdict(**text["moves"]),
        )
    except FileNotFoundError:
        raise
    except (*UNREADABLE, OSError, BadZipFile, EOFError, zlib.error) as error:
        said = f"there is no {error}" if isinstance(error, KeyError) else str(error)
        raise ValueError(f"{str(path)!r} is no saved result of optimize: {said}") from error


def judged_range(motion: Motion) -> SweepVerdict:
    """Find the verdict of a fine sweep over the range of the drive; of several inputs, along the poses given.

    It is swept in pieces as long as the motion is: the program for these is compiled already, and one for the whole
    range takes a hundred times as long to compile as to run.
    """
    if len(motion.inputs) > 1:
        status, steepest = np.asarray(motion.status), _steepest(motion)
    else:
        ((name, given),) = motion.inputs.items()
        given = np.asarray(given)  # on the host, as all here: operations of the device are compiled one by one
        values = np.linspace(given.min(), given.max(), max(POSES, len(motion)))
        size = min(max(PIECE, len(motion)), len(values))
        status, steepest = np.zeros(len(values), int), 0.0
        for first in range(0, len(values) - 1, size - 1):  # neighbours share a pose
            piece = slice(min(first, len(values) - size), first + size)
            found = motion.mechanism.sweep({name: values[piece]}, options=motion.options)
            status[piece], steepest = found.status, max(steepest, _steepest(found))
    counts = {each.name: int(np.sum(status == each)) for each in Status if np.any(status == each)}
    return SweepVerdict(len(status), counts, steepest)


def _steepest(motion: Motion) -> float:
    """Measure the largest change of any joint from closed pose to closed pose over that of the drive."""
    joints = motion.mechanism.all_joints
    pace = np.sqrt(sum(np.diff(np.asarray(values)) ** 2 for values in motion.inputs.values()))
    origins = np.concatenate([np.asarray(joint.frames_1)[:, :3, 3] for joint in joints])
    size = float(centroid_and_length(origins, np)[1])
    closed = np.isin(motion.status, CLOSED_ON_BRANCH)
    steepest, both = 0.0, closed[1:] & closed[:-1] & (pace > 0)
    for joint, moved in zip(joints, motion.displacements, strict=True):
        for name, column in zip(joint.coordinates, np.asarray(moved).T, strict=True):
            steps = np.abs(np.diff(column)) / (size if is_length(name) else 1.0)
            steepest = max(steepest, float(np.max(steps[both] / pace[both], initial=0.0)))
    return steepest
