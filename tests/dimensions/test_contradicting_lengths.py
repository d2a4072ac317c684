"""New lengths of a part that contradict those it keeps."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.solve.status import Status

Z = (0, 0, 1)
KEY = ("plate", "B", "C")
PLATE = jk.Mechanism.build(
    fixed=["ground"],
    joints=[
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "crank", "plate", point=(1, 0, 0), axis=Z),
        jk.revolute("C", "plate", "rocker", point=(3, 3, 0), axis=Z),
        jk.revolute("D", "ground", "rocker", point=(4, 0, 0), axis=Z),
        jk.revolute("E", "plate", "flag", point=(2, 3, 0), axis=Z),
    ],
)


@pytest.mark.long
def test_they_are_refused_or_have_no_derivative():
    """Of numbers that are there, as under `grad` alone, in words; inside `jit` derivatives of masked losses are 0."""

    def loss(length):
        motion = PLATE.with_lengths({KEY: length}).sweep({"A": jnp.linspace(0.0, 0.5, 3)})
        return jnp.sum(jnp.where(motion.closed[:, None], motion.points("rocker", (3, 3, 0)), 0.0))

    with pytest.raises(ValueError, match=r"'plate' cannot have \('plate', 'B', 'C'\): 30 with all its other lengths"):
        jax.grad(loss)(30.0)
    with pytest.raises(ValueError, match="must be a finite number, got nan"):
        jax.grad(loss)(jnp.nan)
    slopes = jax.jit(jax.vmap(jax.grad(loss)))(jnp.array([PLATE.lengths[KEY], 30.0]))
    assert abs(slopes[0]) > 0.1
    assert slopes[1] == 0.0


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
def test_in_float32_rounding_is_no_contradiction():
    """Of the length as it is, and of others that a triangle can have, in float32 and inside `jit`."""
    wanted = PLATE.lengths[KEY] * np.linspace(0.98, 1.01, 13)
    with jax.enable_x64(False):
        angles = jnp.zeros(1, jnp.float32)
        statuses = jax.jit(jax.vmap(lambda length: PLATE.with_lengths({KEY: length}).sweep({"A": angles}).status))
        found = statuses(jnp.asarray([*wanted, 30.0], jnp.float32))
    np.testing.assert_array_equal(found[:, 0], [Status.CLOSED.value] * 13 + [Status.NONFINITE.value])
