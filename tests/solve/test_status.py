"""The precedence of statuses: every row of the table in `jaxkin.solve.status`."""

import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.status import SEVERITY, Status, classify, closes_before_limits, default_tolerance, rounding_residual

NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize(
    "residual_norm, stationary, same_branch, expected",
    [
        (NAN, True, True, Status.NONFINITE),
        (INF, True, True, Status.NONFINITE),
        (INF, False, False, Status.NONFINITE),
        (1e-7, True, True, Status.CLOSED),
        (1e-7, False, True, Status.CLOSED),
        (1e-7, True, False, Status.JUMPED),
        (1e-7, False, False, Status.JUMPED),
        (1e-5, True, True, Status.UNREACHABLE),
        (1e-5, True, False, Status.UNREACHABLE),
        (1e-5, False, True, Status.STALLED),
        (1e-5, False, False, Status.STALLED),
    ],
)
def test_the_first_cause_decides(residual_norm, stationary, same_branch, expected):
    given = jnp.array([residual_norm]), jnp.array([stationary]), jnp.array([same_branch])
    assert classify(*given, 1e-6).tolist() == [expected]


def test_the_residual_of_a_closed_pose_is_that_of_the_precision():
    for dtype, largest in ((jnp.float32, 2e-6), (jnp.float64, 1e-12)):
        assert default_tolerance(dtype) == largest
        residual_norm = jnp.array([largest, 1.1 * largest], dtype)
        status = classify(residual_norm, jnp.array([False, False]), jnp.array([True, True]))
        assert status.tolist() == [Status.CLOSED, Status.STALLED]


def test_units_of_rounding_stay_below_the_tolerance():
    assert rounding_residual(jnp.float64, 16) == 16 * np.finfo(np.float64).eps
    assert rounding_residual(jnp.float32, 64) == 0.1 * default_tolerance(jnp.float32)


def test_every_status_has_a_place_and_a_remedy():
    assert sorted(SEVERITY) == sorted(Status) and SEVERITY[0] == Status.CLOSED
    assert all(each.message for each in Status)
    closed = closes_before_limits(jnp.array([each.value for each in Status]))
    assert {each for each, yes in zip(Status, closed, strict=True) if yes} == {Status.CLOSED, Status.JUMPED}
