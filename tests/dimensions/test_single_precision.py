"""Lengths of parts with three joints or more in float32, as JAX computes by default."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.dimensions.lengths import lengths_now
from jaxkin.joints.pairs import revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism


@pytest.mark.long
@pytest.mark.parametrize("make", [spherical, partial(revolute, axis=(0.0, 0.0, 1.0))], ids=["balls", "hinges"])
def test_lengths_of_a_part_with_many_joints(make):
    """Their places are those of float64, and so are the derivatives: to some units of rounding, 1.2e-7."""
    points = np.random.default_rng(1).normal(5.0, 30.0, (5, 3))
    mechanism = Mechanism.build(
        fixed=["p"], joints=[make(f"J{k}", "p", f"q{k}", point=point) for k, point in enumerate(points)], align=0
    )
    bars = [("p", "J0", "J1"), ("p", "J1", "J2")]
    weights = np.random.default_rng(2).normal(size=(5, 3))

    def moved(values):
        changed = mechanism.with_lengths(dict(zip(bars, values, strict=True)))
        return jnp.stack([joint.frames_1[0, :3, 3] for joint in changed.all_joints])

    now, found = np.array(lengths_now(mechanism.linkage, bars)), []
    for exact in (True, False):
        with jax.enable_x64(exact):
            values = jnp.array(1.1 * now)
            slope = jax.jit(jax.grad(lambda values: jnp.sum(weights * moved(values))))(values)
            found.append((jax.jit(moved)(values), slope))
    (places, slopes), (single, single_slopes) = found
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, places, atol=1e-6 * np.abs(points).max())
    np.testing.assert_allclose(single_slopes, slopes, rtol=1e-4)
