"""Fixed parts in one row, joints between them, parts that elements share, and the structure as a key."""

import numpy as np

from jaxkin.topology.structure import structure

FOURBAR = [("A", "ground", "crank"), ("B", "crank", "coupler"), ("C", "coupler", "rocker"), ("D", "wall", "rocker")]
PARTS = ["crank", "ground", "coupler", "rocker", "wall"]


def test_fixed_parts_share_the_row_of_the_first() -> None:
    found = structure(PARTS, FOURBAR, ["wall", "ground"])
    assert found.parts == ("crank", "ground&wall", "coupler", "rocker")
    assert found.part_names == tuple(PARTS) and found.fixed == ("wall", "ground")
    assert found.row_of == {part: "ground&wall" if part in found.fixed else part for part in PARTS}
    assert found.loops[0].path == ("ground&wall", "D", "rocker", "C", "coupler", "B", "crank", "A")
    assert found.tree == (("rocker", "wall", 3, 1), ("coupler", "rocker", 2, -1), ("crank", "coupler", 1, -1))


def test_open_chain_has_no_loops() -> None:
    found = structure(PARTS[:4], FOURBAR[:3], ["ground"])
    assert found.loops == () and found.loop_groups == () and found.cycles.shape == (0, 3)
    assert [(element.kind, element.upper, element.above) for element in found.elements] == [
        ("part", "ground", None),
        ("part", "crank", 0),
        ("part", "coupler", 1),
        ("part", "rocker", 2),
    ]
    assert structure(PARTS[:4], FOURBAR[:3], ["ground"], chords=[]).loops == ()


def test_joint_between_fixed_parts_is_a_loop_by_itself() -> None:
    """It closes at rest only, which is what a joint between two parts that do not move is held to."""
    found = structure(PARTS, [*FOURBAR, ("E", "ground", "wall")], ["ground", "wall"])
    assert not found.incidence[:, 4].any()
    assert [loop.path for loop in found.loops] == [
        ("ground&wall", "D", "rocker", "C", "coupler", "B", "crank", "A"),
        ("ground&wall", "E"),
    ]
    assert [element.kind for element in found.elements] == ["part", "single loop", "single loop"]
    assert structure(PARTS, [*FOURBAR, ("E", "ground", "wall")], ["ground", "wall"], ["D", "E"]).loops == found.loops


def test_loops_that_share_a_part_but_no_joint_are_separate() -> None:
    second = [("E", "rocker", "link"), ("F", "link", "plate"), ("G", "plate", "rocker")]
    found = structure([*PARTS, "link", "plate"], [*FOURBAR, *second], ["ground", "wall"])
    upper, lower = found.elements
    assert (upper.kind, upper.lower, upper.joint) == ("single loop", ("rocker",), None)
    assert (lower.kind, lower.upper, lower.joint, lower.above) == ("single loop", "rocker", None, 0)
    assert found.loops[1].path[0] == "rocker"


def test_contacts_of_one_pair_are_closed_loops() -> None:
    """Fig. 2, Eq. (1): a plane and a cylinder between two parts, J1 J2 = I."""
    found = structure(["p1", "p2"], [("a", "p1", "p2"), ("e", "p2", "p1")], ["p1"])
    np.testing.assert_array_equal(found.cycles, [[1, 1]])
    assert found.loops[0].path == ("p1", "a", "p2", "e")


def test_parts_may_be_named_by_the_letters_of_a_text() -> None:
    ring = [("j", "A", "B"), ("k", "B", "C"), ("l", "C", "A")]
    assert structure("ABC", ring, ["A"]) == structure(["A", "B", "C"], ring, ["A"])


def test_equal_descriptions_are_one_key() -> None:
    first, second = (structure(PARTS, FOURBAR, ["ground", "wall"]) for _ in range(2))
    assert first == second and hash(first) == hash(second)
    assert first.loops is first.loops  # worked out once
    assert first != structure(PARTS, FOURBAR, ["ground", "wall"], chords=["A"])


def test_the_text_shows_the_tree_and_the_loops() -> None:
    text = str(structure([*PARTS, "handle"], [*FOURBAR, ("E", "crank", "handle")], ["ground", "wall"]))
    assert text.splitlines() == [
        "single loop of ground&wall, crank, coupler, rocker (fixed)",
        "    l1: ground&wall - D - rocker - C - coupler - B - crank - A - ground&wall",
        "  part handle (by E)",
    ]


def test_the_row_of_many_fixed_parts_has_a_short_name():
    walls = [f"wall {k}" for k in range(9)]
    joints = [(f"J{k}", wall, "link") for k, wall in enumerate(walls)]
    found = structure([*walls, "link"], joints, walls)
    assert found.parts == ("wall 0&8 more", "link") and found.row_of["wall 5"] == "wall 0&8 more"
    frame_first = structure([*walls, "link"], joints, ["wall 5", *walls[:5], *walls[6:]])
    assert frame_first.parts == ("wall 5&8 more", "link"), "the first part is a screw as often as not"
