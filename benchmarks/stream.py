"""Ten million poses in chunks: time, and the memory that it takes at most.

    python benchmarks/stream.py [POSES [NAME ...]]

Each mechanism is streamed in a process of its own, with a progress bar where a terminal is there to show it, and all
displacements are read. *peak* is the largest resident set of the process, Python, JAX and compilation included.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import time

POSES = 10_000_000
NAMES = ("four-bar", "slider-crank", "Jansen leg", "RSSR")


def child(name: str, poses: int) -> None:
    """What is measured."""
    import jax

    jax.config.update("jax_enable_x64", True)
    import numpy as np
    from cases import CASES
    from rich.console import Console
    from rich.progress import track

    make, drive = CASES[name]
    mechanism = make()
    for _ in mechanism.stream(drive(250_000)):  # compiles
        pass
    stream = mechanism.stream(drive(poses))
    console = Console(stderr=True)
    closed, residual, begin, used = 0, 0.0, time.perf_counter(), time.process_time()
    for motion in track(stream, name, console=console, disable=not console.is_terminal):
        jax.device_get(motion.displacements)
        closed += int(np.sum(motion.closed))
        residual = max(residual, float(np.max(motion.residual)))
    used, wall = time.process_time() - used, time.perf_counter() - begin
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps([wall, used, peak / 1e9, residual, closed / stream.poses]))


def main(poses: int, names: tuple[str, ...]) -> None:
    print(
        f"{'':20}{'poses':>10}{'wall [s]':>10}{'cpu [s]':>9}{'ns a pose':>11}{'peak [GB]':>11}{'residual':>10}  closed"
    )
    for name in names:
        command = [sys.executable, __file__, "--one", name, str(poses)]
        found = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
        wall, used, peak, residual, closed = json.loads(found)
        print(
            f"{name:20}{poses:>10}{wall:>10.1f}{used:>9.1f}{used / poses * 1e9:>11.0f}{peak:>11.2f}{residual:>10.0e}"
            f"{closed:>8.1%}",
            flush=True,
        )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        child(sys.argv[2], int(sys.argv[3]))
    else:
        main(int(sys.argv[1]) if sys.argv[1:] else POSES, tuple(sys.argv[2:]) or NAMES)
