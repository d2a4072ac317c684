"""What results of forces print: one number where there is one."""

import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar


@pytest.mark.long
def test_one_force_in_all_poses_is_said_once():
    """What works against the driven hinge itself is what the drive delivers, and nothing is no negative zero."""
    motion = planar_fourbar().sweep({"A": np.linspace(0.0, 1.0, 5)})
    for load, said in ((-2.0, "A.phi  2 N m at all poses"), (0.0, "A.phi  0 N m at all poses")):
        assert said in str(jk.drive_forces(motion, applied=jk.joint_load("A", load)))
