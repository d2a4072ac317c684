"""Sweeps against closed forms, in one process: poses per second warm, compile time, error and residual.

    python benchmarks/sweep.py

Every mechanism is swept over one turn at several numbers of poses; the four-bar's closed form with its angles, jitted,
is timed beside it on the same inputs. Medians of repeated runs, results awaited. Machines differ and are noisy: compare
the columns of one run, not the figures of two.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from reference import mechanisms, planar

RUNS = 7


def median_time(function, *args) -> float:
    """Seconds of a call whose first run is not counted."""
    jax.block_until_ready(function(*args))
    times = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        jax.block_until_ready(function(*args))
        times.append(time.perf_counter() - begin)
    return float(np.median(times))


@jax.jit
def closed_fourbar(theta):
    """Coupler and rocker angles of the open branch by the law of cosines."""
    x, y = 100.0 - 40.0 * jnp.cos(theta), -40.0 * jnp.sin(theta)
    square = x * x + y * y
    to_crank = jnp.arctan2(-y, -x)
    rocker = to_crank - jnp.arccos((80.0**2 + square - 120.0**2) / (160.0 * jnp.sqrt(square)))
    coupler = jnp.arctan2(y + 80.0 * jnp.sin(rocker), x + 80.0 * jnp.cos(rocker))
    return coupler, rocker


def main() -> None:
    jax.config.update("jax_enable_x64", True)
    cases = {
        "four-bar": (mechanisms.planar_fourbar(), "A"),
        "slider-crank": (mechanisms.slider_crank(), "A"),
        "cam (b)": (mechanisms.cam(), "shaft"),
        "spherical four-bar": (mechanisms.spherical_linkage(), "A"),
        "Cardan": (mechanisms.cardan_shafts(), "in"),
        "RSSR": (mechanisms.rssr_linkage(), "A"),
    }
    print(
        f"{'':20}{'poses':>8}{'first [s]':>11}{'ns a pose':>11}{'closed form':>13}{'ratio':>8}{'residual':>10}"
        f"{'closed':>8}"
    )
    for poses in (1, 360, 10_000, 100_000):
        inputs = jnp.linspace(0.0, 2 * jnp.pi, poses)
        reference = median_time(closed_fourbar, inputs + 1.0)
        for name, (mechanism, joint) in cases.items():
            begin = time.perf_counter()
            motion = mechanism.sweep({joint: inputs})
            jax.block_until_ready(motion.residual)
            first = time.perf_counter() - begin
            warm = median_time(lambda m=mechanism, j=joint, u=inputs: m.sweep({j: u}).displacements)
            closed = float(jnp.mean(motion.closed))
            print(
                f"{name:20}{poses:>8}{first:>11.2f}{warm / poses * 1e9:>11.0f}{reference / poses * 1e9:>13.0f}"
                f"{reference / warm:>8.3f}{float(jnp.max(motion.residual)):>10.0e}{closed:>8.0%}",
                flush=True,
            )
    exact = planar.fourbar(1.0 + np.linspace(0.0, 2 * np.pi, 3600)).rocker
    found = cases["four-bar"][0].sweep({"A": np.linspace(0.0, 2 * np.pi, 3600)}).coordinates["D"][:, 0]
    error = np.max(np.abs(np.unwrap(exact) - exact[0] - found))
    print(f"\nfour-bar, 3600 poses: largest error of the rocker angle {error:.1e}")


if __name__ == "__main__":
    main()
