"""Derivatives of the numbers that judge a motion, where these have a kink."""

import jax
import numpy as np
import pytest

from jaxkin import design
from reference.mechanisms import fourbar_through


@pytest.mark.long
def test_links_in_line_have_finite_derivatives_in_both_modes():
    """Crank and coupler of (0, 0), (1, 0), (3, 0) are in line, where the angle turns back from pi: its slope is on
    neither side, and leaves those of the other poses alone."""
    mechanism = fourbar_through((0, 0), (1, 0), (3, 0), (3, 2))

    def angles(inputs):
        return design.transmission_angle(mechanism.sweep({"A": inputs}), "B", ("A", "C"))

    inputs = np.array([0.0, 0.1])
    forward, reverse = jax.jacfwd(angles)(inputs), jax.jacrev(angles)(inputs)
    step = 1e-5
    slope = (angles(inputs[1:] + step) - angles(inputs[1:] - step))[0] / (2 * step)
    np.testing.assert_allclose(forward[1], [0.0, slope], atol=1e-8)  # of differences: the square of the step
    np.testing.assert_allclose(reverse, forward, rtol=1e-12)
    np.testing.assert_array_equal(forward[0], 0.0)
