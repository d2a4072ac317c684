"""Affine images of many points: those of a product of matrices, with its derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.affine import affine_image

POINTS = 5
ROUNDING = 1e-14
"""Some ten roundings of sums of a few numbers of about one."""


def plainly(matrix, rows):
    """The same as a product of matrices."""
    return matrix[:, :-1] @ jnp.stack(rows) + matrix[:, -1:] if rows else matrix


def stacked(matrix, rows):
    return jnp.stack([jnp.broadcast_to(row, POINTS if rows else 1) for row in affine_image(matrix, rows)])


@pytest.mark.parametrize("coordinates", [0, 2, 3])
def test_image_and_derivatives_of_both_orders_are_those_of_a_product(coordinates):
    random = np.random.default_rng(coordinates)
    matrix, d_matrix = jnp.asarray(random.normal(size=(2, 3, coordinates + 1)))
    rows, d_rows = (tuple(jnp.asarray(random.normal(size=(coordinates, POINTS)))) for _ in range(2))

    def backwards_along(image):
        """The slopes of a loss, and how they change along a direction."""

        def slopes(*at):
            return jax.grad(lambda *at: jnp.sum(jnp.sin(image(*at))), argnums=(0, 1))(*at)

        return jax.jvp(slopes, (matrix, rows), (d_matrix, d_rows))

    for of in (
        lambda image: image(matrix, rows),
        lambda image: jax.jvp(image, (matrix, rows), (d_matrix, d_rows)),
        backwards_along,
    ):
        one, other = (jax.tree.leaves(of(image)) for image in (stacked, plainly))
        for found, expected in zip(one, other, strict=True):
            np.testing.assert_allclose(found, expected, rtol=0, atol=ROUNDING)
