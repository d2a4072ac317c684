"""Batches that `jax.vmap` made, given outside of it: refused in words whose advice works."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.energies import fourbar

SCALES = jnp.array([1.0, 2.0, 3.0])
POINT = (60.0, 50.0, 7.0)


def first(batch):
    """Take one out of a batch, as the message says."""
    return jax.tree.map(lambda rows: rows[0], batch)


def masses_of(mechanism, mass):
    own = jk.Mass(mass, POINT, 1e-3)
    return jk.masses(mechanism, given={"crank": 0, "coupler": own, "rocker": 0})


def test_batches_of_masses_and_their_prints(motion, tmp_path):
    batch = jax.vmap(lambda mass: masses_of(motion.mechanism, mass))(SCALES)
    for function in (jk.drive_forces, jk.reactions):
        with pytest.raises(ValueError, match=r"of one mechanism, and this is a batch of 3, .*inside of jax\.vmap"):
            function(motion, batch)
    with pytest.raises(ValueError, match="a batch of 3"):
        jk.equilibrium(motion.mechanism, {"A": np.linspace(0, 1, 5)}, batch)
    with pytest.raises(ValueError, match="a batch of 3"):
        batch.at(motion, 2)
    with pytest.raises(ValueError, match="a batch of 3"):
        jk.write_urdf(motion.mechanism, tmp_path / "m.urdf", masses=batch)
    assert str(batch) == "Masses of 4 parts, a batch of 3"
    np.testing.assert_allclose(batch.total, SCALES)
    inside = jax.vmap(lambda masses: jk.drive_forces(motion, masses).forces["A.phi"])(batch)
    one = jk.drive_forces(motion, first(batch)).forces["A.phi"]
    # force is linear in mass; sums in another order
    np.testing.assert_allclose(inside, SCALES[:, None] * one, rtol=1e-9, atol=1e-9 * float(jnp.abs(one).max()))


@pytest.mark.parametrize(
    "load",
    [
        lambda x: jk.force("coupler", POINT, x * jnp.ones(3)),
        lambda x: jk.spring("ground", POINT, "rocker", (3.0, x, 4.0), 20.0),
        lambda x: jk.joint_friction("D", 0.1 * x, radius=3.0),
    ],
)
@pytest.mark.parametrize("count", [3, 5])
def test_batches_of_loads_also_of_as_many_as_poses(load, count):
    motion = fourbar().sweep({"A": np.linspace(0.0, 1.0, 5)})
    batch = jax.vmap(load)(jnp.linspace(1.0, 2.0, count))
    steady = jk.torque("rocker", (0.0, 0.0, 1.0))
    with pytest.raises(ValueError, match=f"batch of {count}"):
        jk.drive_forces(motion, applied=[steady, batch], rates={"A": 1.0})
    jk.drive_forces(motion, applied=[steady, first(batch)], rates={"A": 1.0})


@pytest.mark.long
def test_batches_of_motions():
    mechanism, inputs = fourbar(), jnp.linspace(0.0, 1.0, 4)
    batch = jax.vmap(lambda scale: mechanism.sweep({"A": scale * inputs}))(SCALES)
    loads = jk.torque("rocker", (0.0, 0.0, 1.0))
    for function in (
        lambda motion: jk.drive_forces(motion, applied=loads),
        lambda motion: jk.velocities(motion, {"A": 1.0}),
        lambda motion: jk.transmission(motion, "D"),
    ):
        with pytest.raises(ValueError, match="of one motion, and this is a batch of 3"):
            function(batch)
        function(first(batch))
