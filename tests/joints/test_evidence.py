"""What a joint is known from is told, and JAX does not see it."""

import jax

import jaxkin as jk
from jaxkin.joints.evidence import EvidenceKind


def hinge() -> jk.Joint:
    return jk.revolute("A", "ground", "crank", point=(1, 2, 3), axis=(0, 0, 1))


def test_joints_by_hand_are_the_users():
    assert hinge().evidence.kind == EvidenceKind.USER == "user"


def test_it_is_left_behind_where_jax_takes_a_joint_apart():
    joint = hinge()
    leaves, treedef = jax.tree.flatten(joint)
    assert len(leaves) == 3
    assert jax.tree.unflatten(treedef, leaves).evidence is None
    paths = [jax.tree_util.keystr(path) for path, _ in jax.tree_util.tree_leaves_with_path(joint)]
    assert paths == [".frames_1", ".frames_2", ".pitch"]


def test_joints_known_otherwise_compile_nothing_anew():
    from dataclasses import replace

    joint = hinge()
    other = replace(joint, evidence=jk.Evidence(EvidenceKind.CLEARANCE, (("clearance", 0.1),), "a loose pin"))
    assert jax.tree.structure(joint) == jax.tree.structure(other)
    assert str(other.evidence) == "clearance: a loose pin"
