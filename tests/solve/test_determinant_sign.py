"""Determinants that change their sign, against those of numpy."""

import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.continuation.determinant_sign import determinant_ratio, ratio_of_determinants
from jaxkin.solve.system.equation_blocks import EquationBlock
from reference.matrices import block_triangular


@pytest.mark.parametrize("n", [1, 3, 6, 9])
def test_what_has_turned_over_has_a_negative_determinant(n):
    """Jacobians of two poses near each other, some with one axis mirrored between them.

    Tolerance: eliminated without pivoting, which loses some digits of matrices that have turned over.
    """
    rng = np.random.default_rng(n)
    one = rng.normal(size=(40, n, n))
    mirror = np.broadcast_to(np.eye(n), one.shape).copy()
    mirror[::3, 0, 0] = -1.0
    after, before = (
        one @ change @ np.swapaxes(one + noise, 1, 2)
        for change, noise in ((mirror, 0.05 * rng.normal(size=one.shape)), (np.eye(n), 0.0))
    )
    found = ratio_of_determinants(*(jnp.moveaxis(jnp.asarray(product), 0, -1) for product in (after, before)))
    np.testing.assert_allclose(found, np.linalg.det(after) / np.linalg.det(before), rtol=1e-6)


@pytest.mark.long
def test_a_block_that_turns_over_is_seen_though_another_does_too():
    """The determinant of the whole has kept its sign."""
    rng = np.random.default_rng(3)
    jacobian, blocks = block_triangular(rng, 40)
    other = jacobian.copy()
    for block in blocks[:2]:
        other[np.ix_(block.rows, block.columns[:1])] *= -1.0
    jacobian, other = jnp.asarray(jacobian), jnp.asarray(other)
    # but for the little on the diagonal, a billionth of the square of a block, over the square of its least value
    expected = np.repeat([[-1.0], [-1.0], [1.0]], 40, axis=1)
    np.testing.assert_allclose(determinant_ratio(jacobian, other, blocks[:3]), expected, atol=1e-2)


@pytest.mark.long
@pytest.mark.parametrize("shape", [(5, 3), (3, 5)])
def test_a_jacobian_that_is_not_square_is_compared_in_its_own_range(shape):
    """An unknown, or an equation, that changes its sign, and another length of it; tolerance as above."""
    jacobian = jnp.asarray(np.random.default_rng(1).normal(size=(*shape, 4)))
    rows, columns = (np.arange(count) for count in shape)
    for factor in (-1.0, 0.5):
        other = jacobian.at[:, 0].multiply(factor) if shape[1] < shape[0] else jacobian.at[0].multiply(factor)
        found = determinant_ratio(jacobian, other, [EquationBlock(tuple(rows), tuple(columns))])
        np.testing.assert_allclose(found, factor, rtol=1e-6)
