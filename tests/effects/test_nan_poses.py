"""Derivatives of what is computed of a motion, of which a pose has no numbers: those of the other poses."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar

COUPLER = ("coupler", "B", "C")
INPUTS = jnp.array([0.1, jnp.nan, 0.2])
PUSH = [jk.force("coupler", (0.0, 0.0, 0.0), (1.0, 0.5, 0.0))]
AT = (1.0, 1.0, 0.0)


def turning(motion, first=1.0):
    """Velocities; with `first=0`, the first pose rests."""
    return jk.velocities(motion, {"A": jnp.where(jnp.arange(len(motion)) == 0, first, 1.0)})


def axes(motion, first=1.0):
    """Points of the screw axes of poses that have some."""
    point = jk.screw_axes(turning(motion, first), "coupler").point
    return jnp.where(jnp.isnan(point), 0.0, point)


COMPUTED = {
    "points": lambda motion: motion.points("coupler", AT),
    "transforms": lambda motion: motion.transforms["rocker"],
    "singular value": lambda motion: motion.sigma_min,
    "velocities": lambda motion: turning(motion).points("coupler", AT),
    "jerks": lambda motion: jk.jerks(motion, {"A": 1.0}).points("coupler", AT),
    "screw axes": axes,
    "screw axes, one at rest": lambda motion: axes(motion, 0.0),
    "transmission": lambda motion: jk.transmission(motion, "D").angle,
    "drive forces": lambda motion: jk.drive_forces(motion, applied=PUSH, rates={"A": 1.0}).forces["A.phi"],
    "reactions": lambda motion: jk.reactions(motion, applied=PUSH).forces["B"],
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name == "points" else pytest.mark.long) for name in COMPUTED]
)
def test_a_pose_without_numbers_spoils_no_derivative(name):
    mechanism = planar_fourbar(1.0)

    def total(length, inputs):
        motion = mechanism.with_lengths({COUPLER: length}).sweep({"A": inputs})
        rows = COMPUTED[name](motion)
        return jnp.sum(jnp.where(motion.closed.reshape(-1, *[1] * (rows.ndim - 1)), rows, 0.0))

    derivative = jax.jit(jax.value_and_grad(total, (0, 1)))
    length = float(mechanism.lengths[COUPLER])
    value, (by_length, by_inputs) = derivative(length, INPUTS)
    alone, (expected, others) = derivative(length, INPUTS[::2])
    # sums of other order, of lengths of 100 mm
    np.testing.assert_allclose([value, by_length], [alone, expected], rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(by_inputs, [others[0], 0.0, others[1]], rtol=1e-10, atol=1e-12)
