"""What a range costs of which one input in two or five is beyond a limit, beside one of as many poses that all close.

    python benchmarks/unreachable.py [poses]

The range of a single input that closes ends at the limits of the drive; the other one goes on beyond one of them, for
as long again. The hexapod's legs follow a closed curve of the platform; in the other range three of them become longer
and longer from the middle on. Both are swept in turn, in processor time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import jax
import numpy as np
from cases import hexapod_legs  # puts the mechanisms of the tests on the path

import jaxkin as jk
from reference import catalogue, hard_fourbars, mechanisms

jax.config.update("jax_enable_x64", True)
POSES = 10_000
RUNS = 7
Ranges = tuple[dict[str, np.ndarray], dict[str, np.ndarray]]


def beyond_a_limit(joint: str) -> Callable[[jk.Mechanism, int], Ranges]:
    """A range between the limits of a joint, and one that goes on beyond the upper one."""

    def ranges(mechanism: jk.Mechanism, poses: int) -> Ranges:
        turn = np.linspace(-np.pi, np.pi, 721)
        closed = np.asarray(mechanism.sweep({joint: turn}).closed)
        middle = len(turn) // 2
        low = turn[middle - int(np.argmin(closed[middle::-1])) + 1] if not closed[:middle].all() else turn[0]
        high = turn[middle + int(np.argmin(closed[middle:])) - 1]
        return {joint: np.linspace(low, high, poses)}, {joint: np.linspace(low, 2 * high - low, poses)}

    return ranges


def beyond_their_reach(mechanism: jk.Mechanism, poses: int) -> Ranges:
    """Legs of a hexapod on a closed curve, and with three of them longer and longer."""
    legs, more = hexapod_legs(poses), np.clip(np.linspace(-0.5, 0.5, poses), 0.0, None)
    longest = max(float(abs(leg).max()) for leg in legs.values())
    return legs, {name: leg + 3 * longest * more * (i % 2) for i, (name, leg) in enumerate(legs.items())}


CASES: dict[str, tuple[Callable[[], jk.Mechanism], Callable[[jk.Mechanism, int], Ranges], bool]] = {
    "RSSR": (mechanisms.rssr_linkage, beyond_a_limit("D"), True),
    "RSSR, formulas=False": (mechanisms.rssr_linkage, beyond_a_limit("D"), False),
    "four-bar": (lambda: hard_fourbars.FOURBAR(**hard_fourbars.NON_GRASHOF), beyond_a_limit("A"), True),
    "four-bar, formulas=False": (
        lambda: hard_fourbars.FOURBAR(**hard_fourbars.NON_GRASHOF),
        beyond_a_limit("A"),
        False,
    ),
    "hexapod, six inputs": (catalogue.hexapod, beyond_their_reach, True),
}
"""Name -> mechanism, its ranges, whether formulas are used."""


def main(poses: int = POSES) -> None:
    print(f"{jax.default_backend()}, {poses} poses\n")
    print(f"{'':<26}{'closes [ms]':>12}{'half [ms]':>11}{'ratio':>7}{'unreachable':>13}{'jumped':>8}")
    for name, (make, ranges_of, formulas) in CASES.items():
        mechanism, options = make(), jk.SolverOptions(formulas=formulas)
        ranges = ranges_of(mechanism, poses)
        times = [[_time(mechanism, each, options) for each in ranges] for _ in range(RUNS + 1)]
        closes, half = 1e3 * np.median(times[1:], axis=0)  # the first is compiled
        status = np.asarray(mechanism.sweep(ranges[1], options=options).status)
        shares = [np.mean(status == each) for each in (jk.Status.UNREACHABLE, jk.Status.JUMPED)]
        print(f"{name:<26}{closes:>12.1f}{half:>11.1f}{half / closes:>7.1f}{shares[0]:>13.0%}{shares[1]:>8.0%}")


def _time(mechanism: jk.Mechanism, drive: dict[str, np.ndarray], options: jk.SolverOptions) -> float:
    """Seconds of the processor that a sweep takes."""
    begin = time.process_time()
    jax.block_until_ready(mechanism.sweep(drive, options=options).displacements)
    return time.process_time() - begin


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
