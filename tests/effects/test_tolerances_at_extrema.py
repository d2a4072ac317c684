"""Tolerances where the first order of a measure says nothing."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples.paths import fourbar

CRANK, LENGTHS = ("crank", "A", "B"), (100.0, 40.0, 120.0, 80.0)


def rocker(pose):
    return pose.coordinates["D"][0]


@pytest.mark.long
def test_at_an_extremum_the_extremes_show_the_second_order():
    """The square of a displacement that is zero: nothing to first order, all of it at the limits of the length."""
    stated, mechanism = {CRANK: 0.05}, fourbar(*LENGTHS)
    angle = jk.tolerances(mechanism, stated, rocker, drive={"A": 0.0}, samples=0)

    def squared(offset):
        return lambda pose: (rocker(pose) - offset) ** 2

    for offset in (0.0, float(angle.nominal)):  # what is left of zero by rounding, and zero itself
        square = jk.tolerances(mechanism, stated, squared(offset), drive={"A": 0.0}, samples=0)
        assert square.worst_case < 1e-15
        np.testing.assert_allclose(sorted(square.extremes), sorted(np.square(angle.extremes)), rtol=1e-9)
        assert min(square.extremes) > 0
