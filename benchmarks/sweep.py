"""Sweeps against closed forms, in one process: poses per second warm, compile time, residual.

    python benchmarks/sweep.py [POSES ...]

Every mechanism is swept over its range at several numbers of poses; the four-bar's closed form with its angles, jitted,
is timed beside it on as many inputs, and so are the form that stops at coordinates and one in NumPy. Medians of
repeated runs, results awaited. Machines differ and are noisy: compare the columns of one run, not the figures of two.
"""

from __future__ import annotations

import sys
import time

import jax
import jax.numpy as jnp
import numpy as np
from cases import CASES
from timing import closed_fourbar, closed_points, median_time

from reference import mechanisms, planar  # on the path by `timing`

SIZES = (1, 360, 10_000, 100_000)


def main(sizes: tuple[int, ...]) -> None:
    jax.config.update("jax_enable_x64", True)
    print(f"jax {jax.__version__}, {jax.devices()[0].device_kind}, float64")
    print(f"{'':20}{'poses':>8}{'first [s]':>11}{'ms a call':>11}{'ns a pose':>11}{'ratio':>8}{'residual':>10}  closed")
    for poses in sizes:
        turn = jnp.linspace(1.0, 1.0 + 2 * jnp.pi, poses)
        reference = median_time(closed_fourbar, turn)
        rows = {
            "closed, angles": reference,
            "closed, points": median_time(closed_points, turn),
            "closed, NumPy": median_time(planar.fourbar, np.asarray(turn)),
        }
        for name, seconds in rows.items():
            print(f"{name:20}{poses:>8}{'':>11}{_figures(seconds, poses, reference)}", flush=True)
        for name, (make, drive) in CASES.items():
            mechanism, inputs = make(), drive(poses)
            begin = time.perf_counter()
            motion = mechanism.sweep(inputs)
            jax.block_until_ready(motion.residual)
            first = time.perf_counter() - begin
            warm = median_time(lambda m=mechanism, u=inputs: m.sweep(u).displacements)
            residual, closed = float(np.max(motion.residual)), float(np.mean(motion.closed))
            print(
                f"{name:20}{poses:>8}{first:>11.2f}{_figures(warm, poses, reference)}{residual:>10.0e}{closed:>8.1%}",
                flush=True,
            )
        shuffled = np.random.default_rng(0).permutation(np.linspace(0.0, 2 * np.pi, poses))
        mechanism = mechanisms.planar_fourbar()
        warm = median_time(lambda m=mechanism, u=shuffled: m.sweep({"A": u}).displacements)
        print(f"{'four-bar, unsorted':20}{poses:>8}{'':>11}{_figures(warm, poses, reference)}", flush=True)


def _figures(seconds: float, poses: int, reference: float) -> str:
    return f"{seconds * 1e3:>11.2f}{seconds / poses * 1e9:>11.0f}{reference / seconds:>8.3f}"


if __name__ == "__main__":
    main(tuple(int(text) for text in sys.argv[1:]) or SIZES)
