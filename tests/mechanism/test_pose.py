"""One pose: `Mechanism.solve`."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar

FOURBAR = planar_fourbar()


@pytest.mark.long
def test_a_pose_is_that_of_a_sweep():
    angles = np.array([0.0, 0.4])
    pose, motion = FOURBAR.solve({"A": 0.4}), FOURBAR.sweep({"A": angles})
    assert pose.status == jk.Status.CLOSED and pose.residual < 1e-14
    for name, rows in motion.coordinates.items():
        assert np.allclose(pose.coordinates[name], rows[1], atol=1e-14)
    for part, rows in motion.transforms.items():
        assert np.allclose(pose.transforms[part], rows[1], atol=1e-13)
    assert np.allclose(pose.point("coupler", (1, 2, 0)), motion.points("coupler", (1, 2, 0))[1], atol=1e-13)
    with pytest.raises(KeyError, match=r"no joint 'E'"):
        pose.coordinates["E"]


@pytest.mark.long
def test_a_pose_differentiates():
    def rocker(angle):
        return FOURBAR.solve({"A": angle}, throw=False).coordinates["D"][0]

    step = 1e-5  # the square of it is the error, 1e-10
    slope = jax.jit(jax.grad(rocker))(0.4)
    assert np.isclose(slope, (rocker(0.4 + step) - rocker(0.4 - step)) / (2 * step), rtol=1e-8)


@pytest.mark.long
def test_a_pose_that_is_not_there_is_said():
    stuck = planar_fourbar(crank=95.0, coupler=60.0)
    with pytest.raises(jk.PoseError, match="UNREACHABLE"):
        stuck.solve({"A": 3.0})
    assert stuck.solve({"A": 3.0}, throw=False).status == jk.Status.UNREACHABLE


def test_a_range_is_refused():
    with pytest.raises(ValueError, match=r"one displacement, got an array of shape \(1,\); for a range write sweep"):
        FOURBAR.solve({"A": [0.1]})


def test_an_untraced_number_on_the_device_is_one():
    assert FOURBAR.solve({"A": jnp.asarray(0.0)}).status == jk.Status.CLOSED
