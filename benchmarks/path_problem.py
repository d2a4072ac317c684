"""Print the row of one path problem for `design.py paths`: a process that imports what its search needs, and no more.

python benchmarks/path_problem.py a|b|c|d|e
"""

import sys
import time

BEGAN = time.perf_counter()

import jax  # noqa: E402 - imports are timed

import jaxkin as jk  # noqa: E402
from jaxkin.examples.paths import PATHS  # noqa: E402

jax.config.update("jax_enable_x64", True)
cells = []
for _ in range(2):
    begin = time.process_time(), time.perf_counter()
    found = jk.optimize(**PATHS[sys.argv[1]].arguments(), starts=64, progress=False)
    cells += [time.process_time() - begin[0], time.perf_counter() - begin[1]]
    if len(cells) == 2:  # the process so far, the interpreter's own start left out of the clock
        cells += [time.process_time(), time.perf_counter() - BEGAN]
row = "".join(f"{value:>{width}.1f}" for value, width in zip(cells, (12, 8, 15, 8, 14, 8), strict=True))
print(f"({sys.argv[1]}) {row}     {PATHS[sys.argv[1]].published:>13.5g}{found.value:>13.5g}", flush=True)
