"""Cold starts: from process start to a finished sweep of 360 poses, each mechanism in processes of its own.

    python benchmarks/cold.py [NAME ...]
    python benchmarks/cold.py derivatives

*first* runs find no compiled program, *again* those find them in JAX's persistent cache, with the settings that the
command line makes. Python's own compiled modules are there in both, as they are once a package is installed and used:
they are kept in a temporary folder, whatever the environment says. Processor time counts all threads; of *again* the
least of two runs. `imports` is the part of the processor time before the mechanism is made, `solids` its making.

`derivatives` times first calls in one process, after a sweep of the four-bar of 360 poses: nothing is stored.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

POSES, AGAIN = 360, 2
ROOT = Path(__file__).resolve().parents[1]


class Start(NamedTuple):
    """Seconds of one process."""

    wall: float
    processor: float
    imports: float
    solids: float


def child(name: str) -> None:
    """What is timed."""
    import jax

    jax.config.update("jax_enable_x64", True)
    from cases import CASES

    import jaxkin  # noqa: F401

    marks = [time.process_time()]
    make, drive = CASES[name]
    mechanism = make()
    marks.append(time.process_time())
    jax.block_until_ready(mechanism.sweep(drive(POSES)).displacements)
    print(json.dumps([marks[0], marks[1] - marks[0]]))


def start(name: str, folder: Path, cache: Path) -> Start:
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"} | {
        "PYTHONPYCACHEPREFIX": str(folder / "python"),
        "PYTHONPATH": str(ROOT),
        "JAX_COMPILATION_CACHE_DIR": str(cache),
        "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0.1",
    }
    begin = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, __file__, "--one", name], env=environment, stdout=subprocess.PIPE, text=True
    )
    output = process.stdout.read() if process.stdout else ""
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - begin
    if process.returncode:
        raise RuntimeError(f"{name}: the process ended with {process.returncode}")
    return Start(wall, used.ru_utime + used.ru_stime, *json.loads(output))


def main(names: list[str]) -> None:
    from cases import CASES

    print(f"{'':20}{'first':>16}{'again':>18}{'imports':>10}{'solids':>8}")
    print(f"{'':20}{'wall':>8}{'cpu':>8}{'wall':>10}{'cpu':>8}  [s]")
    with TemporaryDirectory() as temporary:
        folder = Path(temporary)
        start("four-bar", folder, folder / "python's own")
        for name in names or CASES:
            first = start(name, folder, folder / name)
            again = [start(name, folder, folder / name) for _ in range(AGAIN)]
            figures = [first.wall, first.processor, min(run.wall for run in again), min(run.processor for run in again)]
            rest = [min(run.imports for run in again), min(run.solids for run in again)]
            print(
                f"{name:20}{figures[0]:>8.1f}{figures[1]:>8.1f}{figures[2]:>10.1f}{figures[3]:>8.1f}"
                f"{rest[0]:>10.1f}{rest[1]:>8.1f}",
                flush=True,
            )


def derivatives() -> None:
    """Print the processor time of first derivatives of a rocker's angle, by the inputs and by a length."""
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    from cases import CASES

    make, drive = CASES["four-bar"]
    mechanism, ((joint, angles),) = make(), drive(POSES).items()
    angles = jnp.asarray(angles)
    part, length = next((key, value) for key, value in mechanism.lengths.items() if len(key) == 3)
    last = list(mechanism.joints)[-1]

    def output(inputs, change):
        changed = mechanism.with_lengths({part: length + change}) if change is not None else mechanism
        return jnp.sum(changed.sweep({joint: inputs}).coordinates[last][:, 0] ** 2)

    mechanism.sweep({joint: angles})
    calls = {
        "jvp by the inputs": lambda: jax.jvp(lambda u: output(u, None), (angles,), (jnp.ones(POSES),)),
        "grad by the inputs": lambda: jax.grad(output)(angles, None),
        "the same inside jit": lambda: jax.jit(lambda u: jax.grad(output)(u, None))(angles),
        "grad by a length": lambda: jax.grad(output, 1)(angles, 0.0),
        "that inside jit": lambda: jax.jit(jax.grad(output, 1))(angles, 0.0),
    }
    for name, call in calls.items():
        begin = time.process_time()
        jax.block_until_ready(call())
        print(f"{name:20}{time.process_time() - begin:>8.1f} s", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        child(sys.argv[2])
    elif sys.argv[1:2] == ["derivatives"]:
        derivatives()
    else:
        main(sys.argv[1:])
