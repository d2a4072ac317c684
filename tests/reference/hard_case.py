"""What a hard case is, and how far its poses are from the truth.

A pose is held to be right to some roundings over its smallest singular value: the law that a closed loop obeys near
singular poses, down to the square root of rounding.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import NamedTuple

import jax
import numpy as np

from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.status import Status

Array = np.ndarray
TURN = 2 * np.pi


class HardCase(NamedTuple):
    name: str
    hard: str
    """What is hard about it."""
    build: Callable[[], Mechanism]
    drive: Mapping[str, Array]
    error: Callable[[Motion], Array]
    """How far each pose is from the truth (poses,), in radians and sizes of the mechanism."""
    truth: str
    """Where that is known from."""
    expected: Callable[[Mapping[str, Array]], Array] | Status = Status.CLOSED
    """The status of each pose for the drive, or of all."""
    bits: int = 64
    roundings: float = 100
    """So many of them over the smallest singular value are allowed as an error."""
    long: bool = False
    noise: float = 0.0
    """How far the numbers of the mechanism are off, in radians and sizes: a pose may be wrong by that much more, over
    the smallest singular value."""

    def sweep(self) -> Motion:
        with jax.enable_x64(self.bits == 64), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "jaxkin computes in float32")
            return self.build().sweep(self.drive)

    @staticmethod
    def near(motion: Motion) -> Array:
        """The poses that have to be near to the truth: closed, or as nearly so as the joints agree."""
        return np.isin(np.asarray(motion.status), (Status.CLOSED, Status.MISFIT))

    @property
    def statuses(self) -> Array:
        """What the status of each pose has to be."""
        expected = self.expected(self.drive) if callable(self.expected) else self.expected
        return np.broadcast_to(expected, len(next(iter(self.drive.values()))))

    def allowed(self, motion: Motion) -> Array:
        """The errors that the law allows (poses,)."""
        eps = float(np.finfo(f"float{self.bits}").eps)
        with jax.enable_x64(self.bits == 64):
            sigma = np.asarray(motion.sigma_min, float)
        return (self.roundings * eps + self.noise) / np.clip(sigma, np.sqrt(eps), 1.0)


def off_turns(angle: Array) -> Array:
    """How far angles are from whole turns."""
    return np.abs(np.remainder(angle + np.pi, TURN) - np.pi)


def turn(poses: int, turns: float = 1.0, start: float = 0.0) -> Array:
    """Evenly spaced angles of so many turns."""
    return np.linspace(start, start + turns * TURN, poses)


def angles(joint: str, expected: Callable[[Array], Array], start: float):
    """The error of a joint's displacement, full turns aside, by a closed form of the input's angle, `start` at zero."""

    def error(motion: Motion) -> Array:
        given = np.asarray(next(iter(motion.inputs.values())), float)
        found = np.asarray(motion.coordinates[joint][:, -1], float)
        return off_turns(found - (expected(start + given) - expected(np.array([start]))))

    return error


def displacements(expected: Callable[[Array], Mapping[str, Array]], length: float = 1.0):
    """The largest error of several joints, full turns counted, slides over a length."""

    def error(motion: Motion) -> Array:
        given = np.asarray(next(iter(motion.inputs.values())), float)
        errors = []
        for joint, value in expected(given).items():
            name, _, coordinate = joint.partition(".")
            names = motion.mechanism.joints[name].coordinates
            column = names.index(coordinate) if coordinate else -1
            error = np.abs(np.asarray(motion.coordinates[name][:, column], float) - value)
            errors.append(error / (length if names[column] in "xyz" else 1.0))
        return np.max(errors, axis=0)

    return error


def whole_turns(*joints: str, length: float = 1.0):
    """How far joints are from whole turns, and their slides from where they began: none after turns of the input."""

    def error(motion: Motion) -> Array:
        errors = []
        for name in joints:
            found = np.asarray(motion.coordinates[name], float)
            for column, coordinate in enumerate(motion.mechanism.joints[name].coordinates):
                values = found[:, column]
                errors.append(np.abs(values) / length if coordinate in "xyz" else off_turns(values))
        return np.max(errors, axis=0)

    return error
