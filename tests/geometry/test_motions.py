"""The movements of frames against the matrices that the paper prints."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.movements import MOVEMENTS, displaced, is_length
from jaxkin.geometry.pose import rotation, unit
from jaxkin.geometry.rigid import as_matrices, as_rigid
from reference.movements import matrix


@pytest.mark.parametrize("movement", [name for name, each in MOVEMENTS.items() if not each.follows])
def test_a_frame_is_displaced_by_the_papers_matrix(movement):
    """Whatever the frame: the movement is about its own axes. Tolerance: some roundings of numbers below ten."""
    rng = np.random.default_rng(1)
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = rotation(unit(rng.normal(size=3)), 1.1), rng.normal(size=3)
    q = rng.uniform(-3, 3, (len(MOVEMENTS[movement].coordinates), 9))
    moved = jax.jit(displaced, static_argnums=1)(as_rigid(jnp.asarray(frame)), movement, jnp.asarray(q), 0.7)
    # "I" has one matrix for all poses
    np.testing.assert_array_less(np.abs(as_matrices(moved) - frame @ matrix(movement, q, 0.7)), 1e-14)


def test_lengths_are_told_from_angles_by_their_names():
    names = [name for movement in MOVEMENTS.values() for name in movement.coordinates]
    assert [name for name in names if is_length(name)] == list("zxyxyxyzxyzzxyssuv")
    assert is_length("z2") and not is_length("phi2")
