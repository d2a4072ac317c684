"""The mechanism as a facade of its linkage: what JAX takes apart, and notes that tell of the joints as they are now."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar
from reference.rounding import tilted_fourbar


def test_taking_a_mechanism_apart_computes_nothing():
    """All that is static is what it was, whatever numbers are put in place: nothing is looked for in them."""
    mechanism = planar_fourbar()
    leaves, tree = jax.tree.flatten(mechanism)
    again = jax.tree.unflatten(tree, [np.full_like(leaf, np.nan) for leaf in leaves])
    assert again.linkage.classes is mechanism.linkage.classes
    assert again.structure is mechanism.structure and again.unit == mechanism.unit
    assert hash(tree) == hash(jax.tree.structure(jax.tree.map(lambda leaf: np.asarray(2 * leaf), mechanism)))
    assert all(np.asarray(leaf).dtype.kind == "f" for leaf in leaves)


def test_a_mechanism_that_was_taken_apart_is_the_same():
    mechanism = planar_fourbar()
    again = jax.tree.map(lambda leaf: leaf, mechanism)
    assert again.mobility() == mechanism.mobility() and str(again.plan(["A"])) == str(mechanism.plan(["A"]))


@pytest.mark.long
def test_notes_of_an_alignment_go_with_what_they_told_of():
    """A hinge that disagrees is told of until its frame is put right."""
    wrong = tilted_fourbar(1e-4)
    right = planar_fourbar(1.0)
    assert len(wrong.notes) == 1 and "MISFIT" in wrong.notes[0]
    axes = {name: joint.frames_1[0] for name, joint in wrong.joints.items()}
    upright = {name: np.column_stack([np.eye(4)[:, :3], pose[:, 3]]) for name, pose in axes.items()}
    assert wrong.with_frames(upright).notes == () == right.notes


@pytest.mark.long
@pytest.mark.parametrize("change", ["lengths", "points"])
def test_joints_that_disagree_do_so_after_a_change(change):
    """Poses are those of least residual still, not out of reach."""
    mechanism = tilted_fourbar(1e-4)
    if change == "lengths":
        key = next(key for key in mechanism.lengths if len(key) == 3)
        changed = mechanism.with_lengths({key: 1.001 * mechanism.lengths[key]})
    else:
        changed = mechanism.with_points({"D": mechanism.joints["D"].frames_1[0, :3, 3] + [1e-3, 0, 0]})
    assert changed.linkage.ideal and len(changed.notes) == 1
    assert set(np.asarray(changed.sweep({"A": np.linspace(0.0, 0.5, 5)}).status)) <= {
        jk.Status.CLOSED,
        jk.Status.MISFIT,
    }


def test_joints_may_come_one_by_one():
    """A generator gives its joints once."""
    joints = planar_fourbar().all_joints
    again = jk.Mechanism.build(fixed=["ground"], joints=(joint for joint in joints))
    assert [joint.name for joint in again.all_joints] == [joint.name for joint in joints]
