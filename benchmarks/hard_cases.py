"""The gallery of hard cases as a table in Markdown: `python benchmarks/hard_cases.py [FILE]`.

Every case of `tests/reference/hard_cases.py` is swept and held against its truth. Without a file the table is printed.
"""

from __future__ import annotations

import sys
from pathlib import Path

import jax
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from counted import counted

from jaxkin.solve.status import Status
from reference import hard_cases
from reference.hard_case import HardCase

SECTIONS = {
    "Change points": hard_cases.CHANGE_POINTS,
    "Nearly change points": hard_cases.NEAR_CHANGE_POINTS,
    "Limits and dead points": hard_cases.LIMITS,
    "Overconstrained and redundant": hard_cases.OVERCONSTRAINED,
    "Idle freedoms and balls": hard_cases.IDLE,
    "Inputs": hard_cases.INPUTS,
    "Nearly parallel, nearly intersecting": hard_cases.NEARLY,
    "Lengths and units": hard_cases.SIZES,
    "Single precision": hard_cases.SINGLE_PRECISION,
    "Rounded and misaligned": hard_cases.ROUNDED,
}
COLUMNS = (
    "input",
    "what is hard",
    "poses",
    "status",
    "steps + Newton + damped",
    "residual",
    "sigma_min",
    "error",
    "of what is allowed",
    "truth",
)
HEAD = """# Hard cases

Made by `python benchmarks/hard_cases.py benchmarks/HARD_CASES.md` from the table in `tests/reference/hard_cases.py`,
which is run as tests too (`pytest -m "" tests/motion/test_hard_cases.py`), with the status of every pose.

*residual* is the largest of the closed poses, and of those of least residual where joints disagree (Eq. 12, lengths
over the characteristic length), *sigma_min* the least of all poses (`motion.sigma_min`), *error* the largest distance
of such a pose from the truth, in radians and sizes of the mechanism. A pose may be wrong by 100 roundings (more where
the input itself is a thousand turns) over its own smallest singular value, and at most over the root of rounding; where
its numbers were rounded, by ten times that error. *of what is allowed* is the largest part of that used. A closed loop
is no accurate pose near a dead point or a change point: there the residual stays at rounding while the error grows as
rounding over *sigma_min*.

*steps* are those of the continuation from the assembled pose to either end of the range, refused ones included;
*Newton* the steps of Newton's method from there until all poses are closed (4 at most); *damped* the most iterations
that the damped corrector took of any pose which that did not close (200 is its limit: poses that cannot be reached).
They are counted by `counted.py`, which makes the solver's loops tell.
"""


def row(case: HardCase) -> str:
    """One line of the table."""
    motion = case.sweep()
    with counted() as count:
        case.sweep()
    status = np.asarray(motion.status)
    poses = len(status)
    near = case.near(motion)
    error = case.error(motion)[near]
    with jax.enable_x64(case.bits == 64):
        sigma = np.asarray(motion.sigma_min)
    right = "" if np.array_equal(status, case.statuses) else " (**not as it must be**)"
    counts = ", ".join(f"{np.sum(status == s)} {s.name}" for s in Status if np.any(status == s))
    cells = (
        case.name,
        case.hard,
        str(poses),
        (counts or "none") + right,
        str(count),
        figure(np.asarray(motion.residual)[near]),
        figure(sigma, np.min),
        figure(error),
        f"{np.max(error / case.allowed(motion)[near]):.1%}" if error.size else "",
        case.truth,
    )
    return f"| {' | '.join(cells)} |"


def figure(values: np.ndarray, which=np.max) -> str:
    return f"{which(values):.0e}" if values.size else ""


def table() -> str:
    lines = [HEAD]
    for title, cases in SECTIONS.items():
        lines += [f"## {title}", "", f"| {' | '.join(COLUMNS)} |", "|" + "---|" * len(COLUMNS)]
        for case in cases:
            lines.append(row(case))
            print(lines[-1], file=sys.stderr, flush=True)
        lines.append("")
    return "\n".join(lines)


def main(arguments: list[str]) -> None:
    jax.config.update("jax_enable_x64", True)
    text = table()
    if not arguments:
        print(text)
        return
    path = Path(arguments[0])
    beside = path.with_name(path.name + ".new")
    beside.write_text(text)
    beside.replace(path)


if __name__ == "__main__":
    main(sys.argv[1:])
