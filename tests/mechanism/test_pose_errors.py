"""`sweep(throw=True)` and `motion.check()`: one error that says what became of poses, where, and what to do."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar

RANGE = np.linspace(0.0, 2 * np.pi, 20)


def rocker():
    """The crank does not go round: from some pose on coupler and rocker are in line."""
    return planar_fourbar(1.0, crank=95.0, coupler=60.0)


def test_poses_on_the_branch_pass():
    motion = planar_fourbar(1.0).sweep({"A": RANGE}, throw=True)
    assert motion.check() is motion


def test_the_error_tells_statuses_first_pose_inputs_and_remedy():
    given = RANGE.copy()
    given[-1] = np.nan
    motion = rocker().sweep({"A": given})
    off_branch = ~np.asarray(motion.on_branch)
    with pytest.raises(jk.PoseError) as raised:
        motion.check()
    message = str(raised.value)
    assert message.startswith(f"{off_branch.sum()} of 20 poses are not on the branch of the assembled pose:\n")
    first = int(np.argmax(np.asarray(motion.status) == jk.Status.UNREACHABLE))
    count = int(np.sum(np.asarray(motion.status) == jk.Status.UNREACHABLE))
    where = f"first pose {first} (A.phi = {given[first]:.6g})"
    assert f"  {count} UNREACHABLE, {where}: {jk.Status.UNREACHABLE.message}" in message
    # the worst comes first
    assert message.splitlines()[1].startswith("  1 NONFINITE, first pose 19 (A.phi = nan): the input or the geometry")
    assert raised.value.motion is motion


def test_throw_raises_the_same():
    with pytest.raises(jk.PoseError, match="UNREACHABLE, first pose"):
        rocker().sweep({"A": RANGE}, throw=True)


@pytest.mark.long
def test_traced_statuses_cannot_be_looked_at():
    mechanism = planar_fourbar(1.0)
    with pytest.raises(
        ValueError, match=r"JAX traces here: inside jit, vmap and grad write throw=False and read the status"
    ):
        jax.jit(lambda turn: mechanism.sweep({"A": turn}, throw=True).status)(RANGE)
    assert jax.jit(lambda turn: mechanism.sweep({"A": turn}))(RANGE).check().closed.all()
