"""Mechanisms assembled at a dead point of the drive: two poses for an input, and no branch that the drive chooses."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.solve.status import Status
from reference.mechanisms import planar_fourbar, slider_crank

CRANK, ROD = 40.0, 120.0
SLIDES = np.array([-10.0, -30.0, -70.0])
"""From the stretched pose; the slide gets 80 to the folded one."""


def stretched() -> jk.Mechanism:
    return slider_crank(0.0, CRANK, ROD, offset=0.0)


def crank_at(slides):
    """The angle of the crank by the law of cosines, one of two with opposite signs."""
    x = CRANK + ROD + slides
    return np.arccos((CRANK**2 + x**2 - ROD**2) / (2 * CRANK * x))


@pytest.mark.long
@pytest.mark.parametrize("options", [None, pytest.param(jk.SolverOptions(formulas=False), marks=pytest.mark.long)])
def test_poses_that_close_are_never_said_to_be_unreachable(options):
    motion = stretched().sweep({"S": SLIDES}, options=options)
    assert set(np.asarray(motion.status).tolist()) <= {Status.STALLED, Status.CLOSED}
    assert "the assembled pose is a dead point of S.z, where two branches meet: drive A.phi, or" in str(motion)
    with pytest.raises(jk.PoseError, match=r"dead point of S\.z"):
        motion.check()


def test_both_remedies_help():
    mechanism = stretched()
    beside = mechanism.sweep({"A.phi": [0, 0.01]})
    begun = float(beside.coordinates["S"][1, 0])
    motion = mechanism.at(beside, 1).sweep({"S": SLIDES - begun})
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["A"][:, 0] + 0.01, crank_at(SLIDES), atol=1e-12)
    driven = mechanism.sweep({"A": crank_at(SLIDES)})
    assert np.all(driven.closed)
    np.testing.assert_allclose(driven.coordinates["S"][:, 0], SLIDES, atol=1e-12)


@pytest.mark.long
def test_a_projection_says_so_and_finds_poses_from_beside_it():
    found = jk.project(stretched(), {"S": SLIDES}, hold=["S"])
    assert np.all(found.motion.status == Status.STALLED)
    assert "dead point of S.z" in str(found)
    beside = jk.project(stretched(), {"S": SLIDES, "A": np.full(3, 0.1)}, hold=["S"])
    assert np.all(beside.motion.closed)
    np.testing.assert_allclose(np.abs(beside.motion.coordinates["A"][:, 0]), crank_at(SLIDES), atol=1e-9)


@pytest.mark.long
def test_an_inverse_problem_steps_off_it():
    found = jk.inverse(stretched(), {"S": SLIDES})
    assert found.reached.all()
    np.testing.assert_allclose(np.abs(found.motion.coordinates["A"][:, 0]), crank_at(SLIDES), atol=1e-9)


@pytest.mark.long
def test_back_into_the_range_from_a_limit():
    """The limit is found to rounding, so that the drive moves by its root, 1e-8, to first order."""
    mechanism = planar_fourbar(1.0)
    limits = jk.limits(mechanism, "D")
    ends = [number for number in range(len(limits.motion)) if limits.motion.sigma_min[number] < 1e-6]
    assert len(ends) == 2
    for end, into in zip(ends, (0.1, -0.1), strict=True):
        motion = mechanism.at(limits.motion, end).sweep({"D": into * np.arange(4)})
        assert set(np.asarray(motion.status).tolist()) <= {Status.STALLED, Status.CLOSED}
        assert np.all(motion.closed) or "dead point of D.phi" in str(motion)


@pytest.mark.long
def test_a_regular_pose_keeps_its_statuses():
    motion = slider_crank(1.0, CRANK, ROD, offset=0.0).sweep({"S": np.array([0.0, 80.0])})
    assert np.asarray(motion.status).tolist() == [Status.CLOSED, Status.UNREACHABLE]
