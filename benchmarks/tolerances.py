"""What the tolerances of a pose cost: sensitivities, and 10^5 designs drawn at random.

    python benchmarks/tolerances.py

The shortest of three runs, the first one apart, which holds tracing and compilation.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import jax

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import jaxkin as jk
from jaxkin.examples.paths import fourbar
from reference import mechanisms

jax.config.update("jax_enable_x64", True)
SAMPLES = 100_000


def main() -> None:
    cases = {
        "four-bar, 4 lengths": (fourbar(100.0, 40.0, 120.0, 80.0), "A", "D", {}),
        "the same, 4 clearances": (fourbar(100.0, 40.0, 120.0, 80.0), "A", "D", dict.fromkeys("ABCD", 0.01)),
        "spherical four-bar": (mechanisms.spherical_linkage(), "A", "D", {}),
        "RSSR": (mechanisms.rssr_linkage(), "A", "D", {}),
    }
    print(f"{jax.default_backend()}, {SAMPLES} samples of one pose\n")
    print(f"{'':<24}{'numbers':>9}{'first [s]':>11}{'10^5 [s]':>10}{'none [ms]':>11}")
    for name, (mechanism, driven, output, clearances) in cases.items():
        stated = {key: 1e-3 for key, value in mechanism.lengths.items() if value > 0.1 and "offset" not in key}

        def measure(pose, output=output):
            return pose.coordinates[output][0]

        def run(samples, mechanism=mechanism, stated=stated, driven=driven, clearances=clearances, measure=measure):
            begin = time.perf_counter()
            jk.tolerances(mechanism, stated, measure, drive={driven: 0.3}, clearances=clearances, samples=samples)
            return time.perf_counter() - begin

        first = run(SAMPLES)
        most = min(run(SAMPLES) for _ in range(3))
        run(0)
        none = min(run(0) for _ in range(3))
        print(f"{name:<24}{len(stated) + 2 * len(clearances):>9}{first:>11.2f}{most:>10.2f}{1e3 * none:>11.1f}")


if __name__ == "__main__":
    main()
