"""Random mechanisms against closed forms: is every pose closed on its branch, or does it say why not?

    python benchmarks/random_mechanisms.py [MECHANISMS [SEED [formulas]]]

By the continuation, or by formulas alone, as inside of `vmap` over designs.
Mechanisms of one to four loops (`tests/reference/random_linkages.py`) are drawn in their assembled pose, so that they
close: in the plane dyads on a crank, on the ground and on each other, in space RSSR linkages and spherical four-bars in
series. Each is swept over sixteen poses of a range of up to a turn around the assembled pose, and every pose is held
against closed forms in NumPy, which share nothing with jaxkin: what is reachable, on which branch, how far off it is.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import jax
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from jaxkin.solve.options import SolverOptions
from reference.random_linkages import LINKAGES
from reference.random_sweeps import Count, checked, sweeps

BATCH = 50
SHARES = {
    "four-bar": 0.58,
    "Watt six-bar": 0.05,
    "Stephenson six-bar": 0.05,
    "leg of three dyads": 0.01,
    "four dyads": 0.005,
    "RSSR": 0.06,
    "two RSSR": 0.01,
    "three RSSR": 0.005,
    "spherical four-bar": 0.19,
    "two spherical four-bars": 0.035,
    "four spherical four-bars": 0.005,
}
"""Of the mechanisms; those that take long are fewer."""


def main(mechanisms: int = 5_000, seed: int = 0, *, formulas: bool = False) -> None:
    jax.config.update("jax_enable_x64", True)
    print(f"{'':24}{'loops':>6}{'designs':>8}{Count.head()}{'ms each':>9}")
    total, designs = Count(), 0
    for number, linkage in enumerate(LINKAGES):
        each = max(1, round(mechanisms * SHARES[linkage.name] / BATCH)) * BATCH
        rng = np.random.default_rng([seed, number])
        program, count, seconds = sweeps(linkage, SolverOptions(formulas=formulas)), Count(), 0.0
        for _ in range(each // BATCH):
            begin = time.process_time()
            count += checked(linkage, program, rng, BATCH)
            seconds += time.process_time() - begin
        print(f"{linkage.name:24}{len(linkage.stages):>6}{each:>8}{count}{1e3 * seconds / each:>9.1f}", flush=True)
        total += count
        designs += each
    print(f"{'all':24}{'':>6}{designs:>8}{total}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]), formulas=sys.argv[3:] == ["formulas"])
