"""Did anything get slower? Ratios of one run, held against those that are committed.

    python benchmarks/baseline.py               # measure, and print
    python benchmarks/baseline.py --compare     # hold against baseline.json; exit code 1 where something got slower
    python benchmarks/baseline.py --update      # measure, and write baseline.json

Every figure is a time over another one of the same seconds of the same run: sweeps over the closed form
of the four-bar at as many poses, a gradient over its sweep, a first call in a new process over `import jax`. Reference
and case take turns in blocks of calls; a figure is the median of their quotients, its noise the distance between the
quartiles. Something got slower if its quotient grew by more than both noises together and a tenth. A formula of 60 us
and a program of 10 ms do not keep their quotient from one machine to another: update the file on the machine that is
to compare, from the commit before, with nothing else running.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from cases import CASES
from timing import closed_fourbar

from reference import mechanisms  # on the path by `timing`

FILE = Path(__file__).with_name("baseline.json")
TURNS = 15
"""Quotients of a figure: reference and case take so many turns."""
BLOCK = 0.02
"""Seconds of a block of calls: single calls of 50 us differ by half."""
COLD_TURNS = 3
"""The same of new processes, which take seconds."""
LEAST = 0.1
"""Relative growth below which nothing counts as slower, however quiet the machine was."""
SLOW = ("paper, Fig. 3", "paper, Fig. 7", "Stewart-Gough")
"""Cases that are measured at 360 poses only."""


class Figure(NamedTuple):
    ratio: float
    noise: float
    """Distance between the quartiles of the quotients."""


def quotients(case: Callable[[], object], reference: Callable[[], object], turns: int = TURNS) -> Figure:
    """The time of one call over that of another, each in blocks of calls, in turns; first calls are not counted."""
    jax.block_until_ready((reference(), case()))
    counts = [max(1, round(BLOCK / seconds(call, 1))) for call in (reference, case)]
    found = []
    for _ in range(turns):
        below, above = (seconds(call, count) for call, count in zip((reference, case), counts, strict=True))
        found.append(above / below)
    low, middle, high = np.quantile(found, [0.25, 0.5, 0.75])
    return Figure(float(middle), float(high - low))


def seconds(call: Callable[[], object], count: int) -> float:
    """Mean time of one of so many calls in a row."""
    begin = time.perf_counter()
    for _ in range(count):
        jax.block_until_ready(call())
    return (time.perf_counter() - begin) / count


def sweeps() -> Iterator[tuple[str, Figure]]:
    """Sweeps over the closed form of the four-bar with its angles, at as many poses."""
    for poses in (360, 100_000):
        angles = jnp.linspace(1.0, 1.0 + 2 * jnp.pi, poses)
        for name, (make, drive) in CASES.items():
            if poses > 360 and name in SLOW:
                continue
            mechanism, inputs = make(), drive(poses)
            yield (
                f"sweep, {name}, {poses} poses",
                quotients(lambda m=mechanism, u=inputs: m.sweep(u).displacements, lambda a=angles: closed_fourbar(a)),
            )


def derivatives() -> Iterator[tuple[str, Figure]]:
    """A gradient of a path error with respect to a length, over the sweep that it differentiates."""
    mechanism, key = mechanisms.planar_fourbar(), ("coupler", "B", "C")
    angles = jnp.linspace(0.0, 2 * jnp.pi, 360)

    @jax.jit
    def error(length):
        return jnp.sum(mechanism.with_lengths({key: length}).sweep({"A": angles}).coordinates["D"] ** 2)

    slope = jax.jit(jax.grad(error))
    length = jnp.asarray(float(mechanism.lengths[key]))
    yield "gradient, four-bar, 360 poses", quotients(lambda: slope(length), lambda: error(length))


def designs() -> Iterator[tuple[str, Figure]]:
    """A thousand four-bars over a hundred poses each, over the closed form at as many poses."""
    mechanism, key = mechanisms.planar_fourbar(), ("coupler", "B", "C")
    lengths = float(mechanism.lengths[key]) * jnp.linspace(0.95, 1.05, 1000)
    angles = jnp.linspace(0.0, 2 * jnp.pi, 100)
    every = jax.jit(jax.vmap(lambda length: mechanism.with_lengths({key: length}).sweep({"A": angles}).displacements))
    many = jnp.tile(angles, 1000)
    yield "1,000 designs x 100 poses", quotients(lambda: every(lengths), lambda: closed_fourbar(many))


def first_calls() -> Iterator[tuple[str, Figure]]:
    """The first sweep in a new process, without stored programs, over a process that only imports jax."""
    tests = Path(__file__).resolve().parents[1] / "tests"
    start = f"import sys; sys.path.insert(0, {str(tests)!r}); import jax; jax.config.update('jax_enable_x64', True)"
    sweep = (
        "import numpy as np; from reference import catalogue, mechanisms; {}().sweep({{{!r}: np.linspace(0, 6, 360)}})"
    )
    cases = {
        "four-bar": sweep.format("mechanisms.planar_fourbar", "A"),
        "RSSR": sweep.format("mechanisms.rssr_linkage", "A"),
        "Jansen leg": sweep.format("catalogue.jansen", "O"),
    }
    for name, code in cases.items():
        yield (
            f"first call, {name}",
            quotients(lambda c=code: _process(f"{start}; {c}"), lambda: _process(start), COLD_TURNS),
        )


def _process(code: str) -> None:
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def measured() -> dict[str, Figure]:
    """All figures, each printed when it is there."""
    jax.config.update("jax_enable_x64", True)
    found = {}
    for group in (sweeps, derivatives, designs, first_calls):
        for name, figure in group():
            found[name] = figure
            print(f"{name:44}{figure.ratio:10.3f} +- {figure.noise:.3f}", flush=True)
    return found


def verdict(before: Figure, now: Figure) -> str:
    """ "slower", "faster" or "same": beyond both noises together, and a tenth."""
    change, doubt = now.ratio - before.ratio, before.noise + now.noise + LEAST * before.ratio
    return "slower" if change > doubt else "faster" if -change > doubt else "same"


def compared(before: dict[str, Figure], now: dict[str, Figure]) -> tuple[str, bool]:
    """A table of all figures, and whether none got slower; figures that only one of the two has are named."""
    lines, good = [f"{'':44}{'baseline':>12}{'now':>12}  verdict"], True
    for name in [*before, *(name for name in now if name not in before)]:
        if name not in now or name not in before:
            lines.append(f"{name:44}{'not measured now' if name in before else 'not in the baseline':>36}")
            continue
        said = verdict(before[name], now[name])
        good = good and said != "slower"
        lines.append(f"{name:44}{before[name].ratio:12.3f}{now[name].ratio:12.3f}  {said}")
    return "\n".join(lines), good


def read(path: Path) -> dict[str, Figure]:
    return {name: Figure(**figure) for name, figure in json.loads(path.read_text()).items()}


def write(path: Path, figures: dict[str, Figure]) -> None:
    rounded = {
        name: {key: round(value, 4) for key, value in figure._asdict().items()} for name, figure in figures.items()
    }
    path.write_text(json.dumps(rounded, indent=1) + "\n")


if __name__ == "__main__":
    asked = sys.argv[1:]
    if asked not in ([], ["--compare"], ["--update"]):
        sys.exit(f"give nothing, --compare or --update, got {' '.join(asked)}")
    before = read(FILE) if asked == ["--compare"] else {}
    now = measured()
    if asked == ["--update"]:
        write(FILE, now)
    if asked == ["--compare"]:
        table, good = compared(before, now)
        print(f"\n{table}")
        sys.exit(0 if good else 1)
