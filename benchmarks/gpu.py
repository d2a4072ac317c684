"""What the device of JAX, such as a GPU, makes of sweeps and gradients, beside the CPU of the same machine.

    python benchmarks/gpu.py [poses]

The same work is done in two processes, one of which has the CPU alone. Milliseconds are the least of five calls;
`statuses` counts poses that differ in status, `apart` is the largest difference of a coordinate of poses that are
closed in both, radians or lengths of the mechanism.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import jax
import jax.numpy as jnp
import numpy as np
from cases import CASES

import jaxkin as jk
from design import BARS, NOW
from reference import hard_fourbars, mechanisms

jax.config.update("jax_enable_x64", True)
POSES, RUNS, DESIGNS = 100_000, 5, 10_000
SWEEPS = ("four-bar", "Jansen leg", "spherical four-bar", "RSSR", "Bennett", "Stewart-Gough")
BEYOND = "four-bar, beyond limits"
DERIVATIVES = ("sweep inside jit", "gradient inside jit", f"{DESIGNS:,} designs x 200", "their gradients")


def least(function, *given) -> tuple[float, object]:
    """Milliseconds of a call, the least of some, and what it returns."""
    jax.block_until_ready(function(*given))
    times = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        found = jax.block_until_ready(function(*given))
        times.append(time.perf_counter() - begin)
    return 1e3 * min(times), found


def of_sweep(name: str, poses: int, kept: dict[str, np.ndarray]) -> float:
    """Time a sweep, and keep its statuses and coordinates."""
    if name == BEYOND:
        mechanism, drive = (
            hard_fourbars.FOURBAR(**hard_fourbars.NON_GRASHOF),
            {"A": np.linspace(-np.pi, np.pi, poses)},
        )
    else:
        make, drive_of = CASES[name]
        mechanism, drive = make(), drive_of(poses)
    milliseconds, _ = least(lambda: mechanism.sweep(drive).displacements)
    motion = mechanism.sweep(drive)
    kept[f"{name}/status"] = np.asarray(motion.status)
    kept[f"{name}/found"] = np.concatenate(
        [np.asarray(each).reshape(poses, -1) for each in motion.coordinates.values()], axis=1
    )
    return milliseconds


def of_derivatives(poses: int) -> list[float]:
    """Time what is inside `jit` for a four-bar: a sweep, the gradient of a loss by all inputs, many designs."""
    mechanism: jk.Mechanism = mechanisms.planar_fourbar(1.0)
    turn, inputs = jnp.linspace(0.0, 2 * jnp.pi, 200), jnp.linspace(0.0, 2 * jnp.pi, poses)

    def loss(mechanism: jk.Mechanism, inputs: jax.Array) -> jax.Array:
        return jnp.sum(jnp.concatenate(mechanism.sweep({"A": inputs}).displacements, axis=1) ** 2)

    def of_design(bars: jax.Array) -> jax.Array:
        return loss(mechanism.with_lengths(dict(zip(BARS, bars, strict=True))), turn)

    bars = jnp.asarray(NOW) * (1 + 0.05 * np.random.default_rng(0).uniform(-1, 1, (DESIGNS, len(NOW))))
    return [
        least(jax.jit(lambda inputs: mechanism.sweep({"A": inputs}).displacements), inputs)[0],
        least(jax.jit(jax.grad(lambda inputs: loss(mechanism, inputs))), inputs)[0],
        least(jax.jit(jax.vmap(of_design)), bars)[0],
        least(jax.jit(jax.vmap(jax.grad(of_design))), bars)[0],
    ]


def measure(path: str, poses: int) -> None:
    """Do all the work on the device of this process, and write what was found to a file."""
    kept: dict[str, np.ndarray] = {}
    times = [of_sweep(name, poses, kept) for name in (*SWEEPS, BEYOND)] + of_derivatives(poses)
    np.savez(path, times=times, device=str(jax.devices()[0].device_kind), **kept)  # pyright: ignore[reportArgumentType]


def main(poses: int = POSES) -> None:
    with TemporaryDirectory() as folder:
        found = []
        for name, platform in (("device", {}), ("cpu", {"JAX_PLATFORMS": "cpu"})):
            path = str(Path(folder) / f"{name}.npz")
            subprocess.run(
                [sys.executable, __file__, "--measure", path, str(poses)], env=os.environ | platform, check=True
            )
            with np.load(path) as file:
                found.append(dict(file))
    device, cpu = found
    print(f"{device['device']} beside {os.cpu_count()} cores, jax {jax.__version__}, {poses} poses\n")
    print(f"{'':28}{'device [ms]':>12}{'cpu [ms]':>10}{'statuses':>10}{'apart':>9}")
    for name, one, other in zip((*SWEEPS, BEYOND, *DERIVATIVES), device["times"], cpu["times"], strict=True):
        row = f"{name:28}{one:>12.2f}{other:>10.2f}"
        if f"{name}/status" in device:
            one, other = device[f"{name}/status"], cpu[f"{name}/status"]
            closed = (one == jk.Status.CLOSED) & (other == jk.Status.CLOSED)
            apart = np.abs(device[f"{name}/found"] - cpu[f"{name}/found"])[closed].max()
            row += f"{(one != other).sum():>10}{apart:>9.0e}"
        print(row)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--measure"]:
        measure(sys.argv[2], int(sys.argv[3]))
    else:
        main(*map(int, sys.argv[1:]))
