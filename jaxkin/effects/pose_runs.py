"""Fill what lies between successive closed poses of a part by screw motions; poses that are not closed part the way."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from jaxkin.geometry.screw_motion import displacement_along, screw_between

LARGEST_TURN = np.pi / 2
"""Turn between two poses up to which what lies between them is filled: beyond, the way between them is a guess."""
SAGITTA = (np.sqrt(2) - 1) / 2
"""Height of the arc of a quarter turn over its chord, as a part of the chord."""


class PoseRun(NamedTuple):
    """Successive poses of a motion, all of them closed."""

    first: int
    """The number of the first of them in the motion."""
    places: Float[np.ndarray, "poses 4 4"]
    """Poses of the part in the world."""
    moved: Float[np.ndarray, "poses corners 3"]
    """Its outermost corners at each pose, world coordinates."""


def runs_of(
    places: Float[np.ndarray, "poses 4 4"], closed: Bool[np.ndarray, " poses"], corners: Float[np.ndarray, "corners 3"]
) -> list[PoseRun]:
    """Part the poses of a motion into runs of closed ones: between two runs the part was nowhere."""
    numbers = np.flatnonzero(closed)
    runs = []
    for run in np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1):
        own = places[run]
        moved = np.einsum("pij,cj->pci", own[:, :3, :3], corners) + own[:, None, :3, 3]
        runs.append(PoseRun(int(run[0]), own, moved))
    return runs


def placements(run: PoseRun, farthest: float) -> Iterator[Float[np.ndarray, "4 4"]]:
    """Yield the poses, and between them those of a screw motion, in which corners move by at most a length."""
    _, places, moved = run
    yield places[0]
    for number in range(len(places) - 1):
        velocity = screw_between(places[number], places[number + 1])
        turn = float(np.linalg.norm(velocity[:3]))
        if turn > LARGEST_TURN:
            raise ValueError(
                f"the part turns by {turn:.2g} rad between the poses {run.first + number} and "
                f"{run.first + number + 1}, so that the way between them is not known: sweep in smaller steps"
            )
        far = float(np.linalg.norm(moved[number + 1] - moved[number], axis=-1).max())
        pieces = max(1, int(np.ceil(far / farthest)))
        for piece in range(1, pieces):
            yield displacement_along(velocity, piece / pieces) @ places[number]
        yield places[number + 1]


def sagitta(run: PoseRun) -> float:
    """Measure how far an arc of at most a quarter turn between two poses goes beyond its chord: a length."""
    return SAGITTA * float(np.linalg.norm(np.diff(run.moved, axis=0), axis=-1).max(initial=0.0))


def off_between(run: PoseRun, corners: Float[np.ndarray, "corners 3"]) -> float:
    """Measure how far screw motions between poses are off: a quarter of what a pose is off its neighbours' middle.

    Two poses alone tell nothing of what lies between them: off by as much as an arc of a quarter turn then.
    """
    if len(run.places) == 2:
        return sagitta(run)
    off = 0.0
    for before, here, after in zip(run.places[:-2], run.moved[1:-1], run.places[2:], strict=True):
        middle = displacement_along(screw_between(before, after), 0.5) @ before
        off = max(off, float(np.linalg.norm(corners @ middle[:3, :3].T + middle[:3, 3] - here, axis=-1).max()))
    return off / 4
