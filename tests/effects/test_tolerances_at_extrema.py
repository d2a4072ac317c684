"""Tolerances where the first order of a measure says nothing."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples.paths import fourbar

CRANK, COUPLER, LENGTHS = ("crank", "A", "B"), ("coupler", "B", "C"), (100.0, 40.0, 120.0, 80.0)


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


@pytest.mark.long
def test_what_has_no_influence_spoils_no_derivative_of_a_spread():
    """An arm beside the four-bar: the play of its pin counts nothing, and where nothing counts derivatives are zero."""
    arm = jk.revolute("E", "ground", "arm", point=(0.0, 50.0, 0.0), axis=(0.0, 0.0, 1.0))
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=[*fourbar(*LENGTHS).all_joints, arm])

    def slope(measure, clearances):
        def found(crank):
            made, drive = mechanism.with_lengths({CRANK: crank}), {"A": 0.2, "E": 0.0}
            stated = jk.tolerances(made, {COUPLER: 0.05}, measure, drive=drive, clearances=clearances, samples=0)
            return jnp.stack([stated.root_sum_of_squares, stated.standard_deviation])

        return jax.jit(jax.jacrev(found))(LENGTHS[1])

    alone = slope(rocker, {})
    assert np.all(np.abs(alone) > 1e-6)
    np.testing.assert_allclose(slope(rocker, {"E": 0.02}), alone, rtol=1e-12)
    np.testing.assert_array_equal(slope(lambda pose: pose.coordinates["E"][0], {"E": 0.02}), 0.0)
