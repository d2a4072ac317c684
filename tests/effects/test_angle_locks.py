"""A ball whose angles lock after a quarter turn: what is told, and what is exact all the same.

A crank turns at a constant rate, so that it has no angular acceleration, and shifts a stage by its ball, which turns as
far against the stage. The crank is placed behind the ball.
"""

import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk

QUARTER = np.pi / 2


def stage(tilt: float) -> jk.Mechanism:
    """A stage on three slides that a crank about y moves; `tilt` turns the axis of the crank."""
    return jk.Mechanism.build(
        fixed=["ground"],
        unit="m",
        joints=[
            jk.prismatic("X", "ground", "x", axis=(1, 0, 0)),
            jk.prismatic("Y", "x", "y", axis=(0, 1, 0)),
            jk.prismatic("Z", "y", "stage", axis=(0, 0, 1)),
            jk.spherical("B", "stage", "crank", point=(0.3, 0, 0.2)),
            jk.revolute("A", "crank", "ground", point=(0, 0, 0), axis=(tilt, 1, 0.5 * tilt)),
        ],
    )


@pytest.mark.long
def test_poses_in_which_the_angles_of_a_ball_lock_are_told():
    motion = stage(1e-7).sweep({"A": -np.array([1.0, QUARTER, 2.0])})
    found = jk.accelerations(motion, {"A": 1.0})
    wrong = jnp.abs(found.angular("crank")).max(axis=1)
    assert wrong[1] > 1e-3 > 1e-9 > wrong[2]
    said = "not determined at 1 pose (1), where angles of B lock, a ball that has turned by 90 deg"
    assert said in str(found)
    assert "lock" not in str(jk.velocities(motion, {"A": 1.0}))
    load = jk.force("stage", (0.5, 0, 0), (1.0, 2.0, 3.0))
    assert said in str(jk.drive_forces(motion, applied=load, rates={"A": 1.0}))
    assert said in str(jk.reactions(motion, applied=load, rates={"A": 1.0}))
    # the advice; of as many poses as above, whose programs serve
    beside = jk.accelerations(stage(1e-7).sweep({"A": -np.array([1.0, QUARTER + 1e-3, 2.0])}), {"A": 1.0})
    assert float(jnp.abs(beside.angular("crank")).max()) < 1e-6
    assert "lock" not in str(beside)


@pytest.mark.long
def test_a_ball_that_turns_about_one_axis_passes_a_quarter_turn():
    motion = stage(0.0).sweep({"A": -np.array([1.0, QUARTER, 2.0])})
    found = jk.accelerations(motion, {"A": 1.0})
    assert abs(float(jnp.cos(motion.coordinates["B"][1, 1]))) < 1e-12
    assert float(jnp.abs(found.angular("crank")).max()) < 1e-12
    assert "lock" not in str(found)
