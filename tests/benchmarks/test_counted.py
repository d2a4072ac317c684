"""The iterations that `benchmarks/counted.py` counts from outside of the solver."""

import sys
from pathlib import Path

import numpy as np
import pytest

from reference.mechanisms import planar_fourbar

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.mark.long
def test_steps_of_a_sweep_are_counted_and_the_solver_is_left_as_it_was(monkeypatch):
    """It looked for a function in a module that no longer has it, which nothing noticed."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    monkeypatch.delitem(sys.modules, "counted", raising=False)
    from counted import counted

    from jaxkin import SolverOptions
    from jaxkin.solve.range import damped_poses, polish

    before = (polish.newton, damped_poses.levenberg_marquardt)
    with counted() as count:
        motion = planar_fourbar().sweep({"A": np.linspace(0, 2, 30)}, options=SolverOptions(formulas=False))
    assert motion.closed.all()
    assert 2 <= count.steps < 100 and 1 <= count.newton < 10
    assert (polish.newton, damped_poses.levenberg_marquardt) == before
