"""What a range costs of which one input in two is beyond a limit, beside one of as many poses that all close.

    python benchmarks/unreachable.py [poses]

The range that closes ends at the limits of the drive; the other one goes on beyond one of them, for as long again. Both
are swept in turn, in processor time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import jax
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
import jaxkin as jk
from reference import hard_fourbars, mechanisms

jax.config.update("jax_enable_x64", True)
POSES = 10_000
RUNS = 7
CASES: dict[str, tuple[Callable[[], jk.Mechanism], str, bool]] = {
    "RSSR": (mechanisms.rssr_linkage, "D", True),
    "RSSR, formulas=False": (mechanisms.rssr_linkage, "D", False),
    "four-bar": (lambda: hard_fourbars.FOURBAR(**hard_fourbars.NON_GRASHOF), "A", True),
    "four-bar, formulas=False": (lambda: hard_fourbars.FOURBAR(**hard_fourbars.NON_GRASHOF), "A", False),
}
"""Name -> mechanism, driven joint, whether formulas are used."""


def main(poses: int = POSES) -> None:
    print(f"{jax.default_backend()}, {poses} poses\n")
    print(f"{'':<26}{'closes [ms]':>12}{'half [ms]':>11}{'ratio':>7}{'unreachable':>13}")
    for name, (make, joint, formulas) in CASES.items():
        mechanism, options = make(), jk.SolverOptions(formulas=formulas)
        turn = np.linspace(-np.pi, np.pi, 721)
        closed = np.asarray(mechanism.sweep({joint: turn}).closed)
        middle = len(turn) // 2
        low = turn[middle - int(np.argmin(closed[middle::-1])) + 1] if not closed[:middle].all() else turn[0]
        high = turn[middle + int(np.argmin(closed[middle:])) - 1]
        ranges = [{joint: np.linspace(low, end, poses)} for end in (high, 2 * high - low)]
        times = [[_time(mechanism, each, options) for each in ranges] for _ in range(RUNS + 1)]
        closes, half = 1e3 * np.median(times[1:], axis=0)  # the first is compiled
        beyond = np.mean(np.asarray(mechanism.sweep(ranges[1], options=options).status) == jk.Status.UNREACHABLE)
        print(f"{name:<26}{closes:>12.1f}{half:>11.1f}{half / closes:>7.1f}{beyond:>13.0%}")


def _time(mechanism: jk.Mechanism, drive: dict[str, np.ndarray], options: jk.SolverOptions) -> float:
    """Seconds of the processor that a sweep takes."""
    begin = time.process_time()
    jax.block_until_ready(mechanism.sweep(drive, options=options).displacements)
    return time.process_time() - begin


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
