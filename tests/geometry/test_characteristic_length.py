"""Centroid and characteristic length: no result depends on unit, origin, or the noise of a point."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.characteristic_length import centroid_and_length

POINTS = np.random.default_rng(0).normal(size=(7, 3))


@pytest.mark.parametrize("xp", [np, jnp])
@pytest.mark.parametrize("unit", [1e-5, 1.0, 1e5])
def test_the_length_has_the_unit_of_the_points_and_no_origin(xp, unit):
    centre, length = centroid_and_length(xp.asarray(POINTS), xp)
    there = centroid_and_length(xp.asarray(unit * (POINTS + 10.0)), xp)
    np.testing.assert_allclose(there[0], unit * (centre + 10.0), rtol=1e-14)
    np.testing.assert_allclose(there[1], unit * length, rtol=1e-13)
    # the root-mean-square distance is that of all pairs over the root of two
    pairs = np.linalg.norm(POINTS[:, None] - POINTS, axis=-1)
    np.testing.assert_allclose(length, np.sqrt(np.mean(pairs**2) / 2), rtol=1e-14)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize("place", [0.0, 1e-3, 1.0, 1e6])
def test_points_that_are_one_but_for_rounding_have_the_length_of_one(kind, place):
    one = np.full(3, place / np.sqrt(3)).astype(kind)
    noise = 4 * np.spacing(one, dtype=kind) * POINTS
    assert centroid_and_length((one + noise).astype(kind), np)[1] == 1.0


@pytest.mark.long
def test_derivatives_are_finite_where_points_are_one():
    found = jax.grad(lambda points: centroid_and_length(points)[1])(jnp.ones((4, 3)))
    np.testing.assert_array_equal(found, 0.0)
