"""What counts as a rigid pose."""

import numpy as np
import pytest

from jaxkin.geometry.pose import frame, is_rigid

POSE = frame(np.array([3.0, -2.0, 5.0]), np.array([1.0, 2.0, -0.5]), np.array([0.3, 0.1, 1.0]))


def test_poses_in_single_precision_are_rigid():
    assert is_rigid(POSE)
    assert is_rigid(POSE.astype(np.float32).astype(float))


@pytest.mark.parametrize("row, column, error", [(0, 0, 1e-5), (1, 2, 1e-5), (3, 3, 1e-5), (3, 0, 1e-5), (0, 3, np.nan)])
def test_errors_beyond_single_precision_are_not_rigid(row, column, error):
    wrong = POSE.copy()
    wrong[row, column] += error
    assert not is_rigid(wrong)


def test_a_mirror_is_not_rigid():
    assert not is_rigid(POSE @ np.diag([1.0, 1.0, -1.0, 1.0]))
