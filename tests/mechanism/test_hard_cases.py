"""The gallery of hard cases: every pose has the status that it must have, and is as accurate as it can be."""

import numpy as np
import pytest

from jaxkin.solve.status import default_tolerance
from reference import planar
from reference.catalogue import antiparallelogram
from reference.hard_case import HardCase
from reference.hard_cases import CASES
from reference.hard_fourbars import LIMIT, NON_GRASHOF
from reference.mechanisms import planar_fourbar


@pytest.mark.parametrize(
    "case", [pytest.param(case, id=case.name, marks=[pytest.mark.long] * case.long) for case in CASES]
)
def test_every_pose_is_closed_on_its_branch_or_says_why_not(case: HardCase):
    motion = case.sweep()
    np.testing.assert_array_equal(motion.status, case.statuses)
    closed = np.asarray(motion.closed)
    assert np.all(np.asarray(motion.residual)[closed] <= default_tolerance(motion.residual.dtype))
    near = case.near(motion)
    assert np.all(case.error(motion)[near] <= case.allowed(motion)[near])


def test_a_change_point_is_closed_from_its_prediction():
    """Newton's method made of rounding a step of 1e-5, and came back by halves, to 2.3e-7 of the pose."""
    (case,) = [each for each in CASES if each.name == "parallelogram, exactly at 0 and pi"]
    # the prediction is off by 3e-10, the error of the samples of the branch; the root of rounding is 1.5e-8
    assert np.all(case.error(case.sweep()) <= 1e-9)


@pytest.mark.parametrize("margin", 10.0 ** -np.arange(4.0, 11.0, 0.5))
def test_a_range_may_end_anywhere_just_inside_a_limit(margin):
    """The last knot was up to 4e-6 rad from the limit, and what lay between the two taken for another branch."""
    motion = planar_fourbar(1.0, **NON_GRASHOF).sweep({"A": np.array([LIMIT - margin - 1.0])})
    assert np.all(motion.closed)
    both = planar_fourbar(1.0, **NON_GRASHOF).sweep({"A": LIMIT - 1.0 + np.array([-margin, 0.3])})
    assert bool(both.closed[0]) and not both.closed[1]


@pytest.mark.long
@pytest.mark.parametrize(
    "build, start, closed",
    [
        (planar_fourbar, 1.0, lambda theta: planar.fourbar(theta).rocker),
        (antiparallelogram, 0.8, planar.antiparallelogram),
    ],
)
def test_ten_poses_a_turn_find_the_branch_of_ten_thousand(build, start, closed):
    """Ten turns coarsely and one finely: the same displacements wherever both have a pose, and the closed form."""
    mechanism = build(start)
    coarse = mechanism.sweep({"A": np.linspace(0.0, 20 * np.pi, 101)})
    fine = mechanism.sweep({"A": np.linspace(0.0, 2 * np.pi, 10_001)})
    assert np.all(coarse.closed) and np.all(fine.closed)
    found = np.asarray(fine.coordinates["D"][:, 0])
    expected = closed(start + np.linspace(0.0, 2 * np.pi, 10_001)) - closed(np.array([start]))
    # within 3e-4 rad of a change point rounding grows by the inverse of that
    np.testing.assert_allclose(np.cos(found - expected), 1.0, atol=1e-14)
    np.testing.assert_allclose(coarse.coordinates["D"][:11, 0], found[::1000], atol=1e-12)
    turned = np.asarray(coarse.coordinates["D"][::10, 0])
    np.testing.assert_allclose(turned, turned[1] * np.arange(11), atol=1e-11)
