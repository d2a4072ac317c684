"""Tolerances as objectives: by the tolerances themselves, and by the designs of the worst case computed in full."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples.paths import fourbar

CRANK, COUPLER, ROCKER = ("crank", "A", "B"), ("coupler", "B", "C"), ("rocker", "C", "D")
LENGTHS = (100.0, 40.0, 120.0, 80.0)
STATED = jnp.array([0.05, 0.1, 0.02, 0.03])
"""Of crank and coupler, the standard deviation of the rocker, and the play of C."""


def rocker(pose):
    return pose.coordinates["D"][0]


def spread(stated, crank=LENGTHS[1]) -> jk.Tolerances:
    return jk.tolerances(
        fourbar(*LENGTHS).with_lengths({CRANK: crank}),
        {CRANK: stated[0], COUPLER: stated[1], ROCKER: jk.sigma(stated[2])},
        rocker,
        drive={"A": 0.7},
        clearances={"C": stated[3]},
        samples=0,
    )


@pytest.mark.long
def test_spreads_by_the_tolerances_that_make_them():
    """The worst case is a sum of parts that are proportional to the tolerances, each squared in the variance."""
    known = spread(np.asarray(STATED))
    assert {CRANK, "C"} <= known.allowed(0.01).scaled.keys() and "worst case" in str(known)  # pairs and names in one

    def both(stated):
        found = spread(stated)
        return jnp.stack([found.worst_case, found.standard_deviation**2])

    slope, variance = jax.jit(jax.jacrev(both))(STATED)
    shares = np.abs(known.sensitivities) * [1.0, 1.0, 3.0, 1.0]
    np.testing.assert_allclose(slope, shares, rtol=1e-12)
    np.testing.assert_allclose(
        np.asarray(variance) * STATED / 2, known.contributions / 100 * known.standard_deviation**2, rtol=1e-12
    )


@pytest.mark.long
def test_designs_computed_in_full_and_spreads_have_the_derivatives_of_differences():
    """Designs in full were NaN where numbers are traced, with a derivative of zero. The central difference errs by the
    square of its step, 1e-3 of lengths of 40, and 1e-2 of the tolerances, whose third derivatives are those of a
    cosine."""

    def ends(crank, size):
        found = spread(size * STATED, crank)
        return jnp.stack([*found.extremes, found.root_sum_of_squares])

    value, slopes = ends(40.0, 1.0), jax.jit(jax.jacfwd(ends, (0, 1)))(40.0, 1.0)
    known = spread(np.asarray(STATED))
    np.testing.assert_allclose(value, [*known.extremes, known.root_sum_of_squares], rtol=1e-13)
    by_crank = (ends(40.001, 1.0) - ends(39.999, 1.0)) / 0.002
    np.testing.assert_allclose(slopes[0], by_crank, rtol=1e-6)
    by_size = (ends(40.0, 1.01) - ends(40.0, 0.99)) / 0.02
    np.testing.assert_allclose(slopes[1], by_size, rtol=1e-6)


@pytest.mark.long
def test_clearances_alone_can_be_differentiated():
    """There is no length among the numbers of a design then."""

    def worst(crank):
        mechanism = fourbar(*LENGTHS).with_lengths({CRANK: crank})
        return jk.tolerances(mechanism, {}, rocker, drive={"A": 0.7}, clearances={"C": 0.03}, samples=0).worst_case

    worst = jax.jit(jax.value_and_grad(worst))
    difference = (worst(40.001)[0] - worst(39.999)[0]) / 0.002
    np.testing.assert_allclose(worst(40.0)[1], difference, rtol=1e-6)
