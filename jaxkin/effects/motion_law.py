"""Motion laws: displacements over time, made of segments that rise and dwell, with all derivatives.

Each law rises from 0 to 1 over a unit of time; a segment scales it to its rise and duration. Largest velocity,
acceleration and jerk of each law, for a unit rise in a unit of time, are those of the literature on cams.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from itertools import accumulate, pairwise
from numbers import Real
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import numbers, one_number, several, whole_number
from jaxkin._files import save_figure
from jaxkin._guesses import Result
from jaxkin._names import closest
from jaxkin._traced import traced
from jaxkin.effects.pose_plot import save_rows
from jaxkin.solve.execution.compiler import whole_program

TimeLaw = Callable[[Array], Array]
DWELL = "dwell"


def _harmonic(u: Array) -> Array:
    return 0.5 - 0.5 * jnp.cos(jnp.pi * u)


def _cycloidal(u: Array) -> Array:
    return u - jnp.sin(2 * jnp.pi * u) / (2 * jnp.pi)


def _polynomial(*coefficients: float) -> TimeLaw:
    return lambda u: jnp.polyval(jnp.array(coefficients), u)


def _modified_sine(u: Array) -> Array:
    """Acceleration: a quarter wave up within an eighth, a slow half wave down, a quarter wave back."""
    ends = jnp.pi * u - jnp.sin(4 * jnp.pi * u) / 4
    middle = 2 + jnp.pi * u - 9 / 4 * jnp.sin(jnp.pi / 3 + 4 / 3 * jnp.pi * u)
    return jnp.where(u < 1 / 8, ends, jnp.where(u < 7 / 8, middle, 4 + ends)) / (4 + jnp.pi)


def _modified_trapezoid(u: Array) -> Array:
    """Acceleration: a trapezoid whose flanks are quarter waves of an eighth each."""

    def half(u: Array) -> Array:
        rising = 2 * u - jnp.sin(4 * jnp.pi * u) / (2 * jnp.pi)
        held = 1 / 4 - 1 / (2 * jnp.pi) + 2 * (u - 1 / 8) + 4 * jnp.pi * (u - 1 / 8) ** 2
        falling = -jnp.pi / 2 + 2 * (1 + jnp.pi) * u - jnp.sin(4 * jnp.pi * (u - 1 / 4)) / (2 * jnp.pi)
        return jnp.where(u < 1 / 8, rising, jnp.where(u < 3 / 8, held, falling)) / (2 + jnp.pi)

    return jnp.where(u < 0.5, half(u), 1 - half(1 - u))


def _s_curve(u: Array) -> Array:
    """Constant jerk in eighths: up, none, down, a quarter at constant velocity, down, none, up."""

    def half(u: Array) -> Array:
        jerk, eighth = 256 / 5, 1 / 8  # the jerk with which half the time leads to half the rise
        v1, s1 = jerk * eighth**2 / 2, jerk * eighth**3 / 6
        a = jerk * eighth
        x = u - eighth
        held = s1 + v1 * x + a * x**2 / 2
        v2, s2 = v1 + a * eighth, s1 + v1 * eighth + a * eighth**2 / 2
        y = u - 2 * eighth
        falling = s2 + v2 * y + a * y**2 / 2 - jerk * y**3 / 6
        v3 = v2 + a * eighth - jerk * eighth**2 / 2
        s3 = s2 + v2 * eighth + a * eighth**2 / 2 - jerk * eighth**3 / 6
        even = s3 + v3 * (u - 3 * eighth)
        stages = jnp.where(u < 2 * eighth, held, jnp.where(u < 3 * eighth, falling, even))
        return jnp.where(u < eighth, jerk * u**3 / 6, stages)

    return jnp.where(u < 0.5, half(u), 1 - half(1 - u))


LAWS: dict[str, TimeLaw] = {
    DWELL: jnp.zeros_like,
    "constant speed": lambda u: u,
    "harmonic": _harmonic,
    "cycloidal": _cycloidal,
    "3-4-5": _polynomial(6, -15, 10, 0, 0, 0),
    "4-5-6-7": _polynomial(-20, 70, -84, 35, 0, 0, 0, 0),
    "modified sine": _modified_sine,
    "modified trapezoid": _modified_trapezoid,
    "s-curve": _s_curve,
}
"""Name -> displacement over time, both from 0 to 1."""


SAMPLES = 2001
"""Times of each segment at which its largest derivatives are looked for: they are right to six digits."""
DRAWN = 201
"""Times of each segment at which it is drawn at least."""


@dataclass(frozen=True)
class Segment:
    """A piece of a motion law."""

    law: str
    """Key of `LAWS`."""
    duration: float
    rise: float
    """What is added to the displacement: radians, or the unit of the mechanism."""


@dataclass(frozen=True, repr=False)
class MotionLaw(Result):
    """Displacement over time: call it with times. Before it begins it is at its start, and after its end it stays."""

    segments: tuple[Segment, ...]
    start: float = 0.0
    """Displacement at time 0."""

    @property
    def duration(self) -> float:
        """Sum of the durations of the segments."""
        return sum(segment.duration for segment in self.segments)

    def times(self, poses: int) -> Float[np.ndarray, " poses"]:
        """Make evenly spaced times from the beginning to the end."""
        return np.linspace(0.0, self.duration, whole_number(poses, "poses"))

    def __call__(self, times: Any, order: int = 0) -> Float[Array, "*times"]:
        """Evaluate displacements at one time or some, or with `order` 1, 2, 3 velocities, accelerations, jerks.

        Where a derivative jumps between two segments it is that of the later one.
        """
        if isinstance(order, bool) or not isinstance(order, int) or not 0 <= order <= 3:
            raise ValueError(f"order must be 0, 1, 2 or 3 (displacement, velocity, acceleration, jerk), got {order!r}")
        return _evaluated(self, order, jnp.asarray(numbers(times, "the times of a motion law"), float))

    def _at(self, time: Array) -> Array:
        """Compute the displacements at times, by the segment that began last; after the end the last one stays."""
        found = jnp.asarray(self.start, time.dtype)
        begins = accumulate((segment.duration for segment in self.segments), initial=0.0)
        rises = accumulate((segment.rise for segment in self.segments), initial=self.start)
        for segment, begin, before in zip(self.segments, begins, rises, strict=False):
            u = (time - begin) / segment.duration
            # far from its segment the powers of u overflow in single precision, and reverse derivatives with them
            share = jnp.where(jnp.abs(u) <= 2.0, u, 0.0)
            # the value beyond its end would have derivatives there, which a later segment replaces
            found = jnp.where(u >= 0, before + segment.rise * LAWS[segment.law](share), found)
        return jnp.where(time > self.duration, self.start + sum(segment.rise for segment in self.segments), found)

    def __str__(self) -> str:
        count = "1 segment" if len(self.segments) == 1 else f"{len(self.segments)} segments"
        lines = [f"Motion law of {count} over {self.duration:g}, from {self.start:g}"]
        lines += [f"  {each.law}: {each.rise:+g} in {each.duration:g}" for each in self.segments]
        told = ("infinite" if np.isinf(most) else f"{most:.4g}" for most in self.largest())
        return "\n".join([*lines, "  most: velocity {}, acceleration {}, jerk {}".format(*told)])

    def largest(self) -> tuple[float, float, float]:
        """Find the largest velocity, acceleration and jerk without their signs: infinite where what each is the
        derivative of jumps, also from the rest before the law and to that after it."""
        share = np.linspace(0.0, 1.0, SAMPLES)
        root = float(jnp.finfo(self(0.0).dtype).eps) ** 0.5
        found, jumps = [], False
        for order in (1, 2, 3):
            # of each segment by itself: one may be much shorter than the whole
            rows = [
                np.asarray(MotionLaw((Segment(each.law, 1.0, 1.0),))(share, order)) * each.rise / each.duration**order
                for each in self.segments
            ]
            most = max(float(np.abs(row).max()) for row in rows)
            found.append(np.inf if jumps else most)
            ends = np.array([0.0, *(row[end] for row in rows for end in (0, -1)), 0.0]).reshape(-1, 2)
            jumps |= bool(np.any(np.abs(ends[:, 1] - ends[:, 0]) > root * most))
        velocity, acceleration, jerk = found
        return velocity, acceleration, jerk

    def plot(self, path: str | Path) -> Path:
        """Draw displacement, velocity, acceleration and jerk over time into a picture file; returns its path."""
        from matplotlib.figure import Figure

        ends = [0.0, *accumulate(each.duration for each in self.segments)]
        within = [np.linspace(begin, end, DRAWN) for begin, end in pairwise(ends)]
        target, times = Path(path), np.unique(np.concatenate([self.times(SAMPLES), *within]))
        figure = Figure(figsize=(7, 7), layout="constrained")
        axes = figure.subplots(4, sharex=True)
        for order, (each, name) in enumerate(
            zip(axes, ("displacement", "velocity", "acceleration", "jerk"), strict=True)
        ):
            each.plot(times, self(times, order), color="C0")
            each.set_ylabel(name)
            each.grid(alpha=0.3)
            for segment_end in accumulate(segment.duration for segment in self.segments[:-1]):
                each.axvline(segment_end, color="0.7", linewidth=0.8)
        axes[-1].set_xlabel("time")
        return save_figure(figure, target)

    def save(self, path: str | Path, poses: int = 361) -> Path:
        """Write times, displacements, velocities, accelerations and jerks as comma-separated values, evenly spaced in
        time; returns the path."""
        times = self.times(poses)
        rows = [times, *(np.asarray(self(times, order)) for order in range(4))]
        return save_rows(["time [s]", "displacement", "velocity", "acceleration", "jerk"], np.stack(rows), Path(path))


@partial(whole_program, static=(0, 1))
def _evaluated(law: MotionLaw, order: int, times: Float[Array, "*times"]) -> Float[Array, "*times"]:
    """Compute a derivative of a motion law in one program: each operation by itself would be compiled, too."""
    function = law._at
    for _ in range(order):
        function = _derivative(function)
    found = jax.vmap(function)(times.ravel()).reshape(times.shape)
    return jnp.where(jnp.isnan(times), times, found)


def _derivative(function: Callable[[Array], Array]) -> Callable[[Array], Array]:
    return lambda time: jax.jvp(function, (time,), (jnp.ones_like(time),))[1]


def motion_law(segments: Iterable[tuple[Any, ...]], start: float = 0.0) -> MotionLaw:
    """Make a motion law of segments (law, duration, rise); a dwell has no rise, ("dwell", duration).

    As `jk.motion_law([("cycloidal", 0.5, 1.2), ("dwell", 0.2), ("3-4-5", 0.3, -1.2)])`. Laws are the keys of
    `jaxkin.effects.motion_law.LAWS`. Durations are in any unit of time, rises in radians or in the unit of the
    mechanism. Raises ValueError for unknown laws and durations that are not positive.
    """
    found = []
    for number, given in enumerate(
        several(segments, "segments", "segments (law, duration, rise)", "[('cycloidal', 1.0, 0.5)]"), start=1
    ):
        name, *sizes = given if isinstance(given, tuple | list) else (given,)
        where = f"segment {number}"
        if not isinstance(name, str) or name not in LAWS:
            known = ", ".join(map(repr, LAWS))
            raise ValueError(f"{where}: the law must be one of {known}, got {name!r}{closest(name, LAWS)}")
        if traced(sizes):
            raise ValueError(
                f"{where}: its numbers are traced, and a law is part of the program that is compiled: make it of "
                "rise 1 outside of jit, vmap and grad, and multiply what it returns"
            )
        wanted = 1 if name == DWELL else 2
        if len(sizes) != wanted or not all(isinstance(x, Real) and np.isfinite(float(x)) for x in sizes):
            said = f"({name!r}, duration{'' if wanted == 1 else ', rise'})"
            raise ValueError(f"{where}: expected {said} with finite numbers, got {given!r}")
        if sizes[0] <= 0:
            raise ValueError(f"{where}: its duration must be positive, got {sizes[0]!r}")
        found.append(Segment(name, float(sizes[0]), float(sizes[1]) if wanted > 1 else 0.0))
    if not found:
        raise ValueError("a motion law needs at least one segment, as in [('cycloidal', 1.0, 0.5)]")
    return MotionLaw(tuple(found), float(one_number(start, "the start")))
