"""Derivatives of what is computed of a motion, of which a pose has no numbers: those of the other poses."""

from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar

COUPLER = ("coupler", "B", "C")
INPUTS = jnp.array([0.1, jnp.nan, 0.2])
AT = (1.0, 1.0, 0.0)


def turning(motion):
    """Velocities; the first pose rests."""
    return jk.velocities(motion, {"A": jnp.where(jnp.arange(len(motion)) == 0, 0.0, 1.0)})


def axes(velocities):
    """Points of the screw axes of poses that have some."""
    point = jk.screw_axes(velocities, "coupler").point
    return jnp.where(jnp.isnan(point), 0.0, point)


COMPUTED = {
    "points": lambda motion, _: motion.points("coupler", AT),
    "transforms": lambda motion, _: motion.transforms["rocker"],
    "singular value": lambda motion, _: motion.sigma_min,
    "velocities": lambda _, velocities: velocities().points("coupler", AT),
    "screw axes": lambda _, velocities: axes(velocities()),
    "transmission": lambda motion, _: jk.transmission(motion, "D").angle,  # of drive forces and reactions
}


@pytest.mark.parametrize(
    "names", [["points"], pytest.param([*COMPUTED], marks=pytest.mark.long)], ids=["points", "all that is computed"]
)
def test_a_pose_without_numbers_spoils_no_derivative(names):
    mechanism, kept = planar_fourbar(1.0), np.array([True, False, True])

    def totals(length, inputs):
        motion = mechanism.with_lengths({COUPLER: length}).sweep({"A": inputs})
        velocities = cache(lambda: turning(motion))
        found = [COMPUTED[name](motion, velocities) for name in names]
        sums = jnp.stack([jnp.sum(jnp.where(kept.reshape(-1, *[1] * (each.ndim - 1)), each, 0.0)) for each in found])
        return sums, sums

    derivatives = jax.jit(lambda *given: jax.tree.leaves(jax.jacrev(totals, (0, 1), has_aux=True)(*given)))
    length = float(mechanism.lengths[COUPLER])
    # the pose that is left out has an input that is no number, or one
    for found, expected in zip(derivatives(length, INPUTS), derivatives(length, INPUTS.at[1].set(0.15)), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-12)  # lengths of 100 mm
