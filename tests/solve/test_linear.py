"""Least-norm solutions against numpy's pseudo-inverse."""

import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.linear import least_norm, scale


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
