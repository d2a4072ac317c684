"""What a user says of an export beside what the export says: which of its joints go, and that this is told."""

import re
from dataclasses import replace

import pytest

import jaxkin as jk
from reference.exported import instance, joint, load


@pytest.fixture
def arms(tmp_path):
    """A chain base - a - b - c of hinges with parallel axes; the one of a and b is driven."""
    tree = instance("base", grounded="true") + "".join(instance(name, (k, 0, 0)) for k, name in enumerate("abc"))
    ends = [("base", "a"), ("a", "b"), ("b", "c")]
    joints = "".join(joint("Revolute", "".join(each), *each, (k, 0, 0)) for k, each in enumerate(ends))
    assembly = load(tmp_path, tree, joints)
    return replace(assembly, exported=replace(assembly.exported, motors=("ab",)))


def slide(one, other):
    return jk.prismatic("mine", one, other, axis=(1, 0, 0))


def test_joints_and_motors_that_a_joint_by_hand_replaces_are_told(arms):
    mechanism = arms.mechanism(joints=[slide("a", "b")])
    assert {each.name for each in mechanism.all_joints} == {"basea", "mine", "bc"} and mechanism.motors == ()
    assert "joint 'mine', given by hand, replaces Revolute 'ab' between its parts" in mechanism.notes
    assert "the motor 'ab' is left out: it moves nothing here" in mechanism.notes


def test_a_joint_by_hand_between_other_parts_of_the_two_bodies_is_told_too(arms):
    mechanism = arms.mechanism(rigid=[["b", "c"]], joints=[slide("a", "c")])
    assert "joint 'mine', given by hand, replaces Revolute 'ab' between its parts" in mechanism.notes


def test_joints_that_are_ignored_are_told(arms):
    mechanism = arms.mechanism(ignore=[["b", "c"]])
    assert "Revolute 'bc' ignored, as was asked for" in mechanism.notes and "bc" not in mechanism.joints
    said = "there is no joint or mate between 'base' and 'c' to ignore, and nothing is inferred there"
    with pytest.raises(ValueError, match=f"^{re.escape(said)}$"):
        arms.mechanism(ignore=[["base", "c"]])
    with pytest.raises(ValueError, match="did you mean 'base'"):
        arms.mechanism(ignore=[["bases", "c"]])


@pytest.mark.parametrize("ends", [("b", "c"), ("c", "d"), ("b", "d")])
def test_a_joint_by_hand_takes_one_part_out_of_a_rigid_group_and_leaves_the_others(arms, ends):
    """Of three parts in a group one moves by the joint then, and the two others stay one body, which moves too."""
    parts = (*arms.parts, replace(arms.parts[-1], name="d"))
    exported = arms.exported.without(["c"])
    assembly = replace(arms, parts=parts, exported=replace(exported, rigid=(("b", "c", "d"),)))
    assert assembly.mechanism().bodies["b"] == ("b", "c", "d")
    mechanism = assembly.mechanism(joints=[slide(*ends)])
    owner = {part: body for body, each in mechanism.bodies.items() for part in each}
    assert len(mechanism.bodies) == 4 and owner[ends[0]] != owner[ends[1]] and mechanism.bodies["base"] == ("base",)
    assert mechanism.mobility().freedoms == 3 and not any("tied to nothing" in note for note in mechanism.notes)
