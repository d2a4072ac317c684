"""Robots from files: the first sweep of all motors in a fresh process, the same again, and 10,000 poses.

    python benchmarks/robots.py FOLDER

Takes each .urdf of the folder with the .yaml of its name, and each .xml. Every robot runs in a process of its own,
which finds no compiled program. *first* is processor time, of all threads, from the call to the poses, *wall* the time
of the clock beside it, and *again* the wall time of the best of thirty calls: 360 poses each, all motors at once from 0
to 0.1. *static* and *dynamic* are processor times of the first drive forces at rest and the first reactions in motion,
both of all bodies under gravity; behind them those of the best of ten calls of the latter, ms.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
POSES, MANY = 360, 10_000


def child(path: Path) -> None:
    """Time one robot."""
    import jax
    import numpy as np

    jax.config.update("jax_enable_x64", True)
    import jaxkin as jk

    loops = path.with_suffix(".yaml")
    mechanism = jk.load(path, loops=loops if loops.exists() else None).mechanism()

    def sweep(poses: int, to: float) -> float:
        drive = {motor: np.linspace(0, to, poses) for motor in mechanism.motors}
        begin = time.perf_counter()
        motion = mechanism.sweep(drive, throw=True)
        jax.block_until_ready(motion.displacements)
        return time.perf_counter() - begin

    begin = time.process_time()
    wall = sweep(POSES, 0.1)
    first = time.process_time() - begin
    again = min(sweep(POSES, 0.09) for _ in range(30))
    sweep(MANY, 0.1)
    many = min(sweep(MANY, 0.09) for _ in range(3))
    loops_there, motors = len(mechanism.structure.loops), len(mechanism.motors)
    print(
        f"{path.stem:40} {loops_there:5} {motors:6} {first:9.1f} {wall:8.1f} {1e3 * again:9.1f} {1e3 * many:11.0f}",
        end=" ",
        flush=True,
    )
    try:
        masses = jk.masses(mechanism)
    except ValueError:
        print("  (masses are not in the file)")
        return
    motion = mechanism.sweep({motor: np.linspace(0, 0.1, POSES) for motor in mechanism.motors})
    rates = dict.fromkeys(motion.inputs, 1.0)

    def busy(call: Callable[[], Any]) -> float:
        begin = time.process_time()
        jax.block_until_ready(call())
        return time.process_time() - begin

    static = busy(lambda: jk.drive_forces(motion, masses).forces)
    dynamic, *later = (busy(lambda: jk.reactions(motion, masses, rates=rates).forces) for _ in range(11))
    print(f"{static:10.1f} {dynamic:11.1f} {1e3 * min(later):9.1f}")


def main() -> None:
    files = sorted(each for each in Path(sys.argv[1]).iterdir() if each.suffix in (".urdf", ".xml"))
    print(f"{'':40} loops motors  first, s  wall, s again, ms 10,000, ms  static, s  dynamic, s again, ms", flush=True)
    for path in files:
        environment = {key: value for key, value in os.environ.items() if key != "JAX_COMPILATION_CACHE_DIR"}
        subprocess.run(
            [sys.executable, __file__, "--one", str(path)], env=environment | {"PYTHONPATH": str(ROOT)}, check=True
        )


if __name__ == "__main__":
    child(Path(sys.argv[2])) if sys.argv[1] == "--one" else main()
