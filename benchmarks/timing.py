"""What the benchmarks of speed share: how a call is timed, and the closed forms that all is held against."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))  # for the closed forms and the mechanisms

SECONDS, RUNS = 1.0, 15
"""Each figure is the median of so many runs, or of those that fit into this time, at least of three."""


class Timing(NamedTuple):
    """Seconds of a call."""

    median: float
    low: float
    """A quarter of the runs was faster."""
    high: float
    """A quarter of the runs was slower."""


def timed(function, *args) -> Timing:
    """A call whose first run is not counted, results awaited."""
    jax.block_until_ready(function(*args))
    times: list[float] = []
    while len(times) < 3 or (len(times) < RUNS and sum(times) < SECONDS):
        begin = time.perf_counter()
        jax.block_until_ready(function(*args))
        times.append(time.perf_counter() - begin)
    return Timing(*np.quantile(times, [0.5, 0.25, 0.75]).tolist())


def median_time(function, *args) -> float:
    """Median seconds of a call whose first run is not counted."""
    return timed(function, *args).median


@jax.jit
def closed_points(theta):
    """Where crank pin and rocker pin of the four-bar are: the intersection of two circles, no angle."""
    x, y = 40.0 * jnp.cos(theta), 40.0 * jnp.sin(theta)
    across, up = 100.0 - x, -y
    square = across * across + up * up
    along = (120.0**2 - 80.0**2 + square) / (2.0 * square)
    beside = jnp.sqrt(120.0**2 / square - along * along)
    return x, y, x + along * across - beside * up, y + along * up + beside * across


@jax.jit
def closed_fourbar(theta):
    """The same with coupler and rocker angles."""
    x, y, rocker_x, rocker_y = closed_points(theta)
    return jnp.arctan2(rocker_y - y, rocker_x - x), jnp.arctan2(rocker_y, rocker_x - 100.0)


def hexapod_curve(poses: int):
    """A closed curve of the platform of the catalogue's hexapod: displacements, and what its legs do."""
    from reference import catalogue, parallel

    mechanism = catalogue.hexapod()
    home = np.array([mechanism.joints[f"top {i}"].frames_1[0][:3, 3] for i in range(6)])
    return parallel.curve(parallel.hexapod().base, home, poses)
