"""Determinants that change their sign, against those of numpy."""

import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.orientation import is_turned_over, turned_over
from reference.matrices import block_triangular


@pytest.mark.parametrize("n", [1, 3, 6, 9])
def test_what_has_turned_over_has_a_negative_determinant(n):
    """Jacobians of two poses near each other, some with one axis mirrored between them."""
    rng = np.random.default_rng(n)
    one = rng.normal(size=(40, n, n))
    mirror = np.broadcast_to(np.eye(n), one.shape).copy()
    mirror[::3, 0, 0] = -1.0
    product = one @ mirror @ np.swapaxes(one + 0.05 * rng.normal(size=one.shape), 1, 2)
    found = is_turned_over(jnp.moveaxis(jnp.asarray(product), 0, -1))
    np.testing.assert_array_equal(found, np.linalg.det(product) < 0)


def test_a_block_that_turns_over_is_seen_though_another_does_too():
    """The determinant of the whole has kept its sign."""
    rng = np.random.default_rng(3)
    jacobian, blocks = block_triangular(rng, 40)
    other = jacobian.copy()
    for block in blocks[:2]:
        other[np.ix_(block.rows, block.columns[:1])] *= -1.0
    jacobian, other = jnp.asarray(jacobian), jnp.asarray(other)
    assert np.all(turned_over(jacobian, other, blocks))
    assert not np.any(turned_over(jacobian, jacobian, blocks))
