"""Assembly modes of mechanisms whose joints have limits: against the same mechanism without any."""

import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)


def limited_fourbar(low: float, high: float, side: int = 1) -> jk.Mechanism:
    """A four-bar whose rocker has limits, above or below the line of its ground."""
    points, ends = [(0, 0, 0), (1, 0.3 * side, 0), (3, 2 * side, 0), (4, 0, 0)], ["ga", "ab", "bc", "gc"]
    joints = [
        jk.revolute(name, *pair, point=point, axis=Z, limits=(low, high) if name == "D" else None)
        for name, pair, point in zip("ABCD", ends, points, strict=True)
    ]
    return jk.Mechanism.build(joints=joints, fixed=["g"])


@pytest.mark.parametrize("side", [1, -1])
def test_an_angle_is_that_full_turn_which_is_within_the_limits_of_its_joint(side):
    """Else the mechanism that is assembled in the mode would be beyond its limits in all its poses."""
    turn = jk.assembly_modes(limited_fourbar(-np.inf, np.inf, side), {"A": 0.3 * side})[1].coordinates["D"][0]
    assert 0.1 < turn * side < np.pi
    within = turn - 2 * np.pi * side
    low, high = sorted([float(within) - 0.5 * side, 0.1 * side])
    modes = jk.assembly_modes(limited_fourbar(low, high, side), {"A": 0.3 * side})
    np.testing.assert_allclose(modes[1].coordinates["D"][0], within, rtol=0, atol=1e-12)
    assert modes.beyond_limits == {}
    status = modes[1].mechanism().sweep({"A": np.array([0.0, 0.05])}).status
    np.testing.assert_array_equal(status, jk.Status.CLOSED)


def test_modes_beyond_the_limits_of_a_joint_are_told():
    """As a sweep tells it of the first mode; the other one is beyond by what its angle is above the limit."""
    mechanism = limited_fourbar(-0.02, 0.02)
    modes, free = (jk.assembly_modes(each, {"A": 0.3}) for each in (mechanism, limited_fourbar(-np.inf, np.inf)))
    turns = np.array([mode.coordinates["D"][0] for mode in free])
    assert np.all(np.abs(turns) > 0.02)
    np.testing.assert_allclose(modes.beyond_limits["D.phi"], turns - 0.02 * np.sign(turns), rtol=0, atol=1e-12)
    assert modes.motion.status[0] == mechanism.sweep({"A": [0.3]}).status[0] == jk.Status.LIMITED
    assert modes.assembled and str(modes).count("beyond the limits of D.phi") == 2 and len(modes) == 2
    assert "limits" not in str(free)
