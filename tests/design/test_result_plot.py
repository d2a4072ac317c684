"""The picture of a search: losses of either sign are seen."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.design.result import SweepVerdict
from reference.mechanisms import planar_fourbar


def ended_with(history) -> jk.Optimum:
    history = np.array(history, float)[:, None]
    return jk.Optimum(
        mechanism=planar_fourbar(),
        value=float(history[-1, 0]),
        violation=0.0,
        history=history,
        reason="converged",
        seconds=1.0,
        values={},
        extras={},
        drive={},
        losses=history[-1],
        violations=np.zeros(1),
        moves=SweepVerdict(3, {"CLOSED": 3}, 1.0),
    )


@pytest.mark.parametrize(
    ("history", "scale"),
    [([1.0, 1e-9], "log"), ([-0.7, -0.8], "linear"), ([0.2, -0.1], "linear"), ([1.0, 0.1, 0.0], "log")],
)
def test_losses_that_are_not_all_above_zero_are_on_a_linear_axis(history, scale, tmp_path):
    """The loss of what is to be as large as possible is below zero: a logarithmic axis was empty, with a warning."""
    figure = ended_with(history).plot(tmp_path / "search.png")
    (axes,) = figure.axes
    assert axes.get_yscale() == scale
    low, high = axes.get_ylim()
    assert low <= min(each for each in history if scale == "linear" or each > 0) and max(history) <= high
    assert [line.get_label() for line in axes.lines][-1] == "best so far"
