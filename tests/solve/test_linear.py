"""Least-norm solutions against numpy's pseudo-inverse."""

import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.linear import inverse, is_turned_over, least_norm, scale


@pytest.mark.parametrize("rows, columns, rank", [(6, 3, 3), (6, 7, 6), (6, 4, 2), (3, 5, 3), (18, 9, 9), (18, 19, 12)])
def test_least_norm_of_systems_that_lack_rank(rows, columns, rank):
    rng = np.random.default_rng(rows * columns)
    jacobian = rng.normal(size=(7, rows, rank)) @ rng.normal(size=(7, rank, columns))
    right = np.einsum("pij,pj->pi", jacobian, rng.normal(size=(7, columns)))
    expected = np.stack([np.linalg.pinv(j, rcond=1e-10) @ r for j, r in zip(jacobian, right, strict=True)])
    batched = jnp.moveaxis(jnp.asarray(jacobian), 0, -1)
    found = least_norm(batched, jnp.asarray(right).T, 1e-14 * scale(batched), range(columns), refine=True)
    # rounding is amplified by the square of the condition number, here below 1e3
    np.testing.assert_allclose(found.T, expected, atol=1e-9 * np.abs(expected).max())


def test_an_idle_coordinate_stays_exactly_at_rest():
    """The part of x in the null space of J is rounding of x itself, not rounding over damping."""
    rng = np.random.default_rng(0)
    jacobian = np.concatenate([rng.normal(size=(6, 4)), np.zeros((6, 2))], axis=1)
    jacobian = jacobian @ np.linalg.qr(rng.normal(size=(6, 6)))[0]
    null = np.linalg.svd(jacobian)[2][4:]
    batched = jnp.asarray(jacobian)[..., None]
    x = least_norm(batched, jnp.asarray(jacobian @ rng.normal(size=6))[:, None], 1e-14 * scale(batched), range(6))
    np.testing.assert_allclose(null @ np.asarray(x)[:, 0], 0.0, atol=1e-13)


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


def test_only_used_columns_are_solved_for():
    """The same as with all columns, of which the others are zero."""
    rng = np.random.default_rng(0)
    jacobian = rng.normal(size=(6, 20, 7))
    jacobian[:, 8:] = 0.0
    right = jnp.asarray(rng.normal(size=(6, 7)))
    damping = jnp.full(7, 1e-3)
    one, other = (least_norm(jnp.asarray(jacobian), right, damping, range(used)) for used in (8, 20))
    np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("rows, poses", [(3, 5), (6, 5), (6, 1024)])
def test_the_inverse_does_what_solutions_are(rows, poses):
    """By straight-line code and in a loop, with columns left out and without."""
    rng = np.random.default_rng(rows)
    jacobian, right = jnp.asarray(rng.normal(size=(rows, 12, poses))), jnp.asarray(rng.normal(size=(rows, poses)))
    damping = jnp.full(poses, 1e-3)
    for used in (range(12), range(2, 9)):
        only = jacobian * np.isin(np.arange(12), used)[:, None]
        expected = least_norm(only, right, damping, used)
        found = jnp.einsum("pcr,rp->cp", inverse(only, damping, used), right)
        np.testing.assert_allclose(found, expected, rtol=1e-11, atol=1e-13)  # conditions up to a thousand
