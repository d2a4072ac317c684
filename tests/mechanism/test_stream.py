"""Motions in chunks against one sweep of all poses: tolerance 1e-12, what rounding leaves of either."""

from functools import cache

import jax
import numpy as np
import pytest

from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.execution.compiler import compilations
from jaxkin.solve.status import Status
from reference.mechanisms import Z, planar_fourbar, rssr_linkage

CHUNK = 30
"""With the pose that leads to them 31, of which the compiled program makes 32."""


def together(stream, joint):
    return np.concatenate([np.asarray(motion.coordinates[joint]) for motion in stream])


def statuses(stream):
    return np.concatenate([np.asarray(motion.status) for motion in stream])


def assert_same(mechanism, drive, closed_only=slice(None)):
    stream, whole = mechanism.stream(drive, CHUNK), mechanism.sweep(drive)
    assert len(stream) == -(-len(whole) // CHUNK) and stream.poses == len(whole)
    np.testing.assert_array_equal(statuses(stream), whole.status)
    for joint in mechanism.joints:
        found, expected = together(stream, joint), np.asarray(whole.coordinates[joint])
        np.testing.assert_allclose(found[closed_only], expected[closed_only], atol=1e-12, rtol=0)
    for name in whole.inputs:
        given = np.concatenate([np.asarray(motion.inputs[name]) for motion in stream])
        np.testing.assert_array_equal(given, whole.inputs[name])


@pytest.mark.parametrize(
    "turn",
    [
        pytest.param(np.linspace(0.0, 7.0, 100), marks=pytest.mark.long),
        np.linspace(40.0, 33.0, 100),
        pytest.param(np.random.default_rng(1).uniform(-9.0, 9.0, 100), marks=pytest.mark.long),
    ],
    ids=["rising", "falling, far away", "in any order"],
)
def test_chunks_of_a_fourbar(turn):
    assert_same(planar_fourbar(1.0), {"A": turn})


@pytest.mark.long
def test_limits_within_chunks_at_their_borders_and_chunks_out_of_reach():
    mechanism = planar_fourbar(1.0, ground=40.0, crank=20.0, coupler=25.0, rocker=30.0)
    turn = np.linspace(-8.0, 8.0, 100)
    status = np.asarray(mechanism.sweep({"A": turn}).status)
    assert {Status.CLOSED, Status.UNREACHABLE} == set(status.tolist())
    borders = status[CHUNK::CHUNK], status[CHUNK - 1 :: CHUNK][:3]
    assert Status.CLOSED in borders[0] and Status.UNREACHABLE in borders[1]
    assert_same(mechanism, {"A": turn}, status == Status.CLOSED)


@pytest.mark.long
def test_angles_of_balls_are_counted_through():
    turn = np.linspace(0.0, 20.0, 200)
    mechanism = rssr_linkage(0.3)
    assert np.ptp(np.asarray(mechanism.sweep({"A": turn}).coordinates["B"]), axis=0).max() > 2 * np.pi
    assert_same(mechanism, {"A": turn})


@cache
def fivebar(axis=Z):
    """Two cranks of 60 mm, 100 mm apart and upright, and two rods of 80 mm, whose pin has an axis."""
    tops = (0.0, 60.0, 0.0), (100.0, 60.0, 0.0)
    middle = (50.0, 60.0 + np.sqrt(80.0**2 - 50.0**2), 0.0)
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("A", "ground", "left", point=(0, 0, 0), axis=Z),
            revolute("B", "left", "rod", point=tops[0], axis=Z),
            revolute("C", "rod", "other rod", point=middle, axis=axis),
            revolute("D", "other rod", "right", point=tops[1], axis=Z),
            revolute("E", "ground", "right", point=(100, 0, 0), axis=Z),
        ],
    )


def around(poses, turns):
    """Round the inputs at which the cranks point away from each other, which the rods are too short for."""
    angle = np.linspace(0.75 * np.pi, (0.75 - 2 * turns) * np.pi, poses)
    reach = np.sqrt(2) * np.pi / 2
    return {"A": np.pi / 2 + reach * np.cos(angle), "E": -np.pi / 2 + reach * np.sin(angle)}


@pytest.mark.long
def test_chunks_of_joints_that_disagree_are_led_as_those_of_others(monkeypatch):
    """Poses of least residual keep the branch, too: a lead is tried again where loops do not close, and only there."""
    drive, counts = around(90, 0.5), []
    for axis in (Z, (0, 2e-4, 1)):
        mechanism, led = fivebar(axis), []
        stream = mechanism.stream(drive, chunk=15)
        follow = stream._sweep
        monkeypatch.setattr(stream, "_sweep", lambda inputs, led=led, follow=follow: led.append(1) or follow(inputs))
        found = np.concatenate([motion.status for motion in stream])
        np.testing.assert_array_equal(found, mechanism.sweep(drive).status)
        counts.append(len(led))
    assert Status.MISFIT in found and counts[0] == counts[1]


@pytest.mark.long
@pytest.mark.study
def test_several_inputs_are_followed_on_their_way():
    """Behind the inputs that cannot be reached a straight line from the assembled pose says JUMPED."""
    drive = around(90, 0.5)
    straight = fivebar().sweep({name: np.linspace(0.0, values[-1], 90) for name, values in drive.items()})
    assert straight.status[-1] == Status.JUMPED
    assert np.all(fivebar().sweep(drive).closed)
    assert_same(fivebar(), drive)


def test_later_chunks_compile_nothing():
    chunks = iter(planar_fourbar(1.0).stream({"A": np.linspace(0.0, 1.0, 100)}, CHUNK))
    next(chunks)
    before = compilations()
    assert len(list(chunks)) == 3
    assert compilations() == before


def test_one_chunk_is_the_sweep_and_no_pose_is_an_empty_one():
    assert [len(motion) for motion in planar_fourbar(1.0).stream({"A": np.linspace(0.0, 1.0, 7)})] == [7]
    assert [len(motion) for motion in planar_fourbar(1.0).stream({"A": []})] == [0]


def test_refused():
    mechanism = planar_fourbar(1.0)
    with pytest.raises(ValueError, match="chunk must be a whole number, 1 or more, got 0"):
        mechanism.stream({"A": [0.0]}, chunk=0)
    with pytest.raises(ValueError, match="there is no joint 'a'"):
        mechanism.stream({"a": [0.0]})
    with pytest.raises(ValueError, match="inside jit, vmap and grad write sweep"):
        jax.jit(lambda turn: [motion.status for motion in mechanism.stream({"A": turn})])(np.zeros(3))
