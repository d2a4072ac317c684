"""Limits of joints along a motion: held against closed forms, and against the same mechanism without limits.

Limits change no pose, so that all numbers of a motion are exactly those without limits; statuses are decided by
displacements that the closed form knows to rounding, away from the limits themselves.
"""

import re
from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.long_motion import write_stream
from reference import planar
from reference.mechanisms import slider_crank

STROKE = (-30.0, 12.0)
TURN = np.linspace(0.0, 2 * np.pi, 73)


def limited(scale=1.0, limits=STROKE):
    """The slider-crank of the references, whose slide ends before its stroke does."""
    free = slider_crank()
    joints = []
    for joint in free.all_joints:
        frames = [np.array(side) for side in (joint.frames_1, joint.frames_2)]
        for side in frames:
            side[:, :3, 3] *= scale
        own = tuple(scale * end for end in limits)
        made = replace(joint, frames_1=frames[0], frames_2=frames[1])
        joints.append(replace(made, limits=(own,)) if joint.name == "S" else made)
    return jk.Mechanism.build(fixed=["ground"], joints=joints)


def stroke(turn):
    """How far the slider is from its assembled pose, by the closed form."""
    at = planar.slider_crank(np.append(1.0, 1.0 + turn)).slider
    return at[1:] - at[0]


def test_poses_beyond_a_limit_are_limited_and_all_else_is_as_without_limits():
    motion, free = limited().sweep({"A": TURN}), slider_crank().sweep({"A": TURN})
    s = stroke(TURN)
    outside = (s < STROKE[0]) | (s > STROKE[1])
    assert outside.any() and not outside.all()
    expected = np.where(outside, jk.Status.LIMITED, jk.Status.CLOSED)
    np.testing.assert_array_equal(motion.status, expected)
    assert np.all(motion.closed) and np.all(motion.on_branch)
    for some, others in zip(motion.displacements, free.displacements, strict=True):
        np.testing.assert_array_equal(some, others)
    over = np.maximum(s - STROKE[1], 0) + np.minimum(s - STROKE[0], 0)
    assert list(motion.beyond_limits) == ["S.z"]
    np.testing.assert_allclose(motion.beyond_limits["S.z"], over, atol=1e-10)  # closed form and sweep: rounding
    assert free.beyond_limits == {} and jk.Status.LIMITED not in np.asarray(free.status)


@pytest.mark.long
def test_effects_of_limited_poses_are_those_of_closed_ones():
    motion, free = (each.sweep({"A": TURN}) for each in (limited(), slider_crank()))
    push = [jk.force("slider", (0, 0, 0), (10.0, 0.0, 0.0))]
    for one, other in (
        (jk.velocities(motion, {"A": 1.0}).displacements, jk.velocities(free, {"A": 1.0}).displacements),
        (jk.drive_forces(motion, applied=push).forces, jk.drive_forces(free, applied=push).forces),
    ):
        for a, b in zip(jax.tree.leaves(one), jax.tree.leaves(other), strict=True):
            assert np.all(np.isfinite(a))
            np.testing.assert_array_equal(a, b)


def test_the_text_names_the_joint_how_far_and_what_to_do():
    mechanism = limited()
    motion = mechanism.sweep({"A": TURN})
    s = stroke(TURN)
    worst = int(np.argmax(np.maximum(s - STROKE[1], STROKE[0] - s)))
    far = max(s[worst] - STROKE[1], STROKE[0] - s[worst])
    told = f"beyond its limits: S.z at {np.sum((s < STROKE[0]) | (s > STROKE[1]))} poses, up to {far:.4g} "
    with pytest.raises(jk.PoseError, match="LIMITED") as error:
        motion.check()
    for text in (str(motion), str(error.value)):
        assert told in text and f"its limits -30 to 12, at pose {worst}" in text
        assert "jk.limits(mechanism, 'A.phi')" in text
    with pytest.raises(jk.PoseError, match="beyond the limits of a joint"):
        mechanism.sweep({"A": TURN}, throw=True)
    inside = mechanism.sweep({"A": np.linspace(*jk.limits(mechanism, "A").range, 9)})
    assert inside.check() is inside and "LIMITED" not in str(inside)  # the remedy works, up to the limits themselves


Z = (0.0, 0.0, 1.0)


def arm(*elbow):
    """An arm of two freedoms whose elbow has limits."""
    joints = [
        jk.revolute("shoulder", "ground", "upper", point=(0, 0, 0), axis=Z),
        jk.revolute("elbow", "upper", "lower", point=(2, 0, 0), axis=Z, limits=elbow),
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints)


def proposed(mechanism, motion):
    """What the call of `jk.limits` in the text of a motion finds."""
    (call,) = re.findall(r"jk\.limits\(.*\)$", str(motion), re.MULTILINE)
    return eval(call, {"jk": jk, "mechanism": mechanism, "motion": motion})


def test_the_call_that_the_text_proposes_runs():
    """The range that it finds is the one that the joint was given, counted from the pose that is assembled."""
    mechanism, values = arm(-0.5, 1.0), np.linspace(0, 2, 5)
    motion = mechanism.sweep({"shoulder": values, "elbow": values})  # the coordinate beyond its limits, others held
    found = proposed(mechanism, motion)
    assert found.drive == "elbow.phi"
    np.testing.assert_allclose(found.range, (-0.5, 1.0), rtol=1e-15)
    mechanism = arm(0.1, 1.0)  # beyond as assembled: from the first pose within, 0.5
    motion = mechanism.sweep({"shoulder": values, "elbow": values})
    assert "the assembled pose itself is beyond its limits: elbow.phi, 0.1 to 1;" in str(motion)
    np.testing.assert_allclose(proposed(mechanism, motion).range, (-0.4, 0.5), rtol=1e-12)
    motion = mechanism.sweep({"shoulder": values, "elbow": -values})  # no pose is within
    assert "jk.limits(" not in str(motion) and "drive it to a pose within them" in str(motion)


@pytest.mark.long
def test_the_call_that_is_proposed_for_a_target_runs():
    """The inputs are then those of a joint that only the mechanism of the motion has.

    Two links of 2 and 1 reach from 1 to 3: along x, with y held, from where they fold up to where they are in line.
    """
    tip = np.array([2 + np.cos(1.0), np.sin(1.0), 0.0])
    joints = [
        jk.revolute("shoulder", "ground", "upper", point=(0, 0, 0), axis=Z),
        jk.revolute("elbow", "upper", "lower", point=(2, 0, 0), axis=Z),
        jk.prismatic("lift", "lower", "hand", axis=Z, limits=(-0.1, 0.1)),
    ]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    motion = mechanism.sweep({jk.point("hand", tip): tip + np.outer(np.linspace(0, 0.2, 5), Z)})
    assert "beyond its limits: lift.z at 2 poses" in str(motion)
    found = proposed(mechanism, motion)
    assert found.upper.kind is found.lower.kind is jk.LimitKind.LOCKS
    # limits are found to rounding
    np.testing.assert_allclose(found.range, (-2.0, np.sqrt(9 - np.sin(1.0) ** 2) - tip[0]), rtol=0, atol=1e-9)


def test_rounding_beyond_a_limit_is_at_the_limit_for_a_range_as_for_a_sweep():
    """A pose that is assembled at its limit is beyond by rounding."""
    found = jk.limits(arm(1e-9, 1.0), "elbow")
    np.testing.assert_array_equal(found.range, (0.0, 1.0))
    with pytest.raises(ValueError, match=r"not in the range 0.001 to 1 of elbow\.phi.*mechanism\.at\(motion, index\)"):
        jk.limits(arm(1e-3, 1.0), "elbow")


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_unit_does_not_matter(scale):
    ends = np.linspace(*jk.limits(limited(), "A").range, 5)
    turn = np.concatenate([TURN, ends])
    motion = limited(scale).sweep({"A": turn})
    np.testing.assert_array_equal(motion.status, limited().sweep({"A": turn}).status)


def test_a_mechanism_that_is_assembled_at_its_limit_is_within_it():
    motion = limited(limits=(0.0, 5.0)).sweep({"A": np.array([0.0, 0.0])})
    assert np.all(motion.status == jk.Status.CLOSED)


@pytest.mark.long
def test_statuses_are_those_of_the_sweep_inside_jit_and_gradients_those_without_limits():
    def of(mechanism):
        return jax.jit(lambda turn: mechanism.sweep({"A": turn}).status)(TURN)

    np.testing.assert_array_equal(of(limited()), limited().sweep({"A": TURN}).status)

    def height(mechanism):
        return lambda turn: jnp.sum(mechanism.sweep({"A": turn}).coordinates["S"] ** 2)

    one, other = (jax.grad(height(each))(jnp.asarray(TURN)) for each in (limited(), slider_crank()))
    np.testing.assert_array_equal(one, other)
    with pytest.raises(ValueError, match=r"read motion\.status"):
        jax.jit(lambda turn: limited().sweep({"A": turn}).beyond_limits)(TURN)


def test_a_stream_and_its_file_tell_the_same(tmp_path):
    mechanism = limited()
    whole, chunks = mechanism.sweep({"A": TURN}), list(mechanism.stream({"A": TURN}, chunk=20))
    np.testing.assert_array_equal(np.concatenate([each.status for each in chunks]), whole.status)
    said = write_stream(mechanism.stream({"A": TURN}, chunk=20), tmp_path / "motion.npz")
    assert [line for line in str(whole).splitlines() if "limits" in line] == [
        line for line in said.splitlines() if "limits" in line
    ]
    with np.load(tmp_path / "motion.npz") as saved:
        names = saved["status_names"][saved["status"]]
    np.testing.assert_array_equal(names == "LIMITED", np.asarray(whole.status) == jk.Status.LIMITED)


def test_a_table_says_limited_and_a_limited_pose_can_be_assembled(tmp_path):
    mechanism = limited()
    motion = mechanism.sweep({"A": TURN})
    (table,) = motion.save(tmp_path, only="motion.csv")
    rows = table.read_text().splitlines()
    assert sum("LIMITED" in row for row in rows) == int(np.sum(motion.status == jk.Status.LIMITED))
    at = int(np.argmax(np.asarray(motion.status) == jk.Status.LIMITED))
    moved = mechanism.at(motion, at)  # limits count from there: the assembled pose itself is beyond them now
    assert moved.sweep({"A": np.array([0.0])}).status[0] == jk.Status.LIMITED
