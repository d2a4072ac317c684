"""Ranges of so many poses that most are interpolated and checked, or found by formulas on several cores: the same as
one at a time, in whatever order.

Tolerance 1e-12, as for few poses: what is left of the closure after the last step is rounding.
"""

import numpy as np
import pytest

from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status
from reference import higher_pairs, planar, spatial
from reference.mechanisms import cam, planar_fourbar, rssr_linkage

POSES = SolverOptions().interpolate_from + 100
TURN = np.linspace(0.0, 2 * np.pi, POSES)


def displacement(angles, first):
    """Angles of parts that only swing, as displacements from the first one."""
    return np.remainder(angles - first + np.pi, 2 * np.pi) - np.pi


@pytest.mark.long
@pytest.mark.parametrize("formulas", [True, False], ids=["formulas", "interpolated"])
@pytest.mark.parametrize("order", ["rising", "falling", "shuffled", "repeated", "both ways"])
def test_a_fourbar_in_any_order(order, formulas):
    turn = {
        "rising": TURN,
        "falling": TURN[::-1],
        "shuffled": np.random.default_rng(0).permutation(TURN),
        "repeated": np.repeat(TURN[:: POSES // 8], 1100)[:POSES],
        "both ways": np.linspace(-2.0, 3.0, POSES),
    }[order]
    motion = planar_fourbar(1.0).sweep({"A": turn}, options=SolverOptions(formulas=formulas))
    assert np.all(motion.closed)
    assert np.max(motion.residual) < 1e-12
    rocker = [planar.fourbar(1.0 + angles).rocker for angles in (turn, np.zeros(1))]
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], displacement(*rocker), atol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("formulas", [True, False], ids=["formulas", "interpolated"])
def test_a_cam_and_an_rssr_linkage(formulas):
    """Line contact, and balls with an idle spin between them."""
    options = SolverOptions(formulas=formulas)
    motion = cam(0.5).sweep({"shaft": TURN}, options=options)
    height = higher_pairs.cam_flat_follower(0.5 + TURN)
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], height - height[0], atol=1e-11)  # mm, size 15
    motion = rssr_linkage(0.3).sweep({"A": TURN}, options=options)
    output = spatial.rssr(0.3 + TURN).output
    expected = displacement(output, output[0])
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], expected, atol=1e-12)


@pytest.mark.long
def test_limits_inside_the_range_are_found_among_many_poses():
    """Against the reach of a double rocker: the coupler and the rocker in line."""
    mechanism = planar_fourbar(1.0, crank=95.0, coupler=60.0)
    motion = mechanism.sweep({"A": TURN})
    few = mechanism.sweep({"A": TURN[::37]})
    assert np.array_equal(np.asarray(motion.status)[::37], few.status)
    assert {Status.CLOSED, Status.UNREACHABLE} <= set(np.asarray(motion.status).tolist())
    # the residual is the least to 1e-5 of itself (`SETTLED_COSINE`), from whichever neighbours it was found
    beyond = np.asarray(few.status) == Status.UNREACHABLE
    alone = [float(mechanism.sweep({"A": [each]}).residual[0]) for each in TURN[::37][beyond][::9]]
    np.testing.assert_allclose(np.asarray(motion.residual)[::37][beyond][::9], alone, rtol=1e-5)
    np.testing.assert_allclose(np.asarray(few.residual)[beyond][::9], alone, rtol=1e-5)
    closed = np.asarray(few.closed)
    one, other = (np.asarray(m.coordinates["D"])[:, 0] for m in (motion, few))
    np.testing.assert_allclose(one[::37][closed], other[closed], atol=1e-9)  # a pose is ill-conditioned at its limit
