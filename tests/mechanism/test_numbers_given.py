"""Numbers come as users have them: integers, fractions, masked arrays. What is none is refused (`test_wrong_types`)."""

from decimal import Decimal
from fractions import Fraction

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.solve.status import Status

ARM = jk.Mechanism.build(fixed=["ground"], joints=[jk.revolute("A", "ground", "arm", point=(0, 0, 0), axis=(0, 0, 1))])


@pytest.mark.parametrize(
    "given", [[Decimal("0.5"), 1], [Fraction(1, 2), 1], np.array([0.5, 1], object), np.array([0.5, 1], np.float16)]
)
def test_exact_numbers_are_numbers(given):
    np.testing.assert_array_equal(ARM.sweep({"A": given}).coordinates["A"][:, 0], [0.5, 1.0])


def test_what_a_mask_hides_is_no_input():
    motion = ARM.sweep({"A": np.ma.array([0.5, 1.0, 1.5], mask=[False, True, False])})
    np.testing.assert_array_equal(motion.status, [Status.CLOSED.value, Status.NONFINITE.value, Status.CLOSED.value])
    np.testing.assert_array_equal(motion.coordinates["A"][:, 0], [0.5, np.nan, 1.5])


def test_inputs_of_a_motion_are_a_dict_to_jax():
    """So that `jax.jvp` takes their rates as a dict."""
    motion = ARM.sweep({"A": [0.5]})
    assert jax.tree.structure(motion.inputs) == jax.tree.structure({"A.phi": 1.0})
