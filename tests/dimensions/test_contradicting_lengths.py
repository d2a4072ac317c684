"""New lengths of a part that contradict those it keeps."""

import jax
import jax.numpy as jnp
import pytest

import jaxkin as jk


def test_they_are_refused_or_have_no_derivative():
    """Of numbers that are there, as under `grad` alone, in words; inside `jit` derivatives of masked losses are 0."""
    z = (0, 0, 1)
    key = ("plate", "B", "C")
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=z),
            jk.revolute("B", "crank", "plate", point=(1, 0, 0), axis=z),
            jk.revolute("C", "plate", "rocker", point=(3, 3, 0), axis=z),
            jk.revolute("D", "ground", "rocker", point=(4, 0, 0), axis=z),
            jk.revolute("E", "plate", "flag", point=(2, 3, 0), axis=z),
        ],
    )

    def loss(length):
        motion = mechanism.with_lengths({key: length}).sweep({"A": jnp.linspace(0.0, 0.5, 3)})
        return jnp.sum(jnp.where(motion.closed[:, None], motion.points("rocker", (3, 3, 0)), 0.0))

    with pytest.raises(ValueError, match=r"'plate' cannot have \('plate', 'B', 'C'\): 30 with all its other lengths"):
        jax.grad(loss)(30.0)
    with pytest.raises(ValueError, match="must be a finite number, got nan"):
        jax.grad(loss)(jnp.nan)
    slopes = jax.jit(jax.vmap(jax.grad(loss)))(jnp.array([mechanism.lengths[key], 30.0]))
    assert abs(slopes[0]) > 0.1
    assert slopes[1] == 0.0
