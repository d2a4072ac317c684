"""Descriptions without a structure are refused in one sentence that says what to write instead."""

import pytest

from jaxkin._names import nearest
from jaxkin.topology.structure import structure

PARTS = ["ground", "crank", "coupler", "rocker"]
JOINTS = [("A", "ground", "crank"), ("B", "crank", "coupler"), ("C", "coupler", "rocker"), ("D", "ground", "rocker")]
LOOSE = [("E", "handle", "knob")]


@pytest.mark.parametrize(
    ("parts", "joints", "fixed", "chords", "message"),
    [
        ([], [], [], None, "there are no parts"),
        (
            "ground",
            JOINTS,
            ["ground"],
            None,
            r"parts must be a list .* got the text 'ground'; write parts=\['ground'\]",
        ),
        (PARTS, JOINTS, [], None, r"no part is fixed; .* such as fixed=\['ground'\]"),
        (PARTS, JOINTS, "ground", None, r"got the text 'ground'; write fixed=\['ground'\]"),
        (PARTS, JOINTS, ["gruond"], None, "no part 'gruond' to fix; did you mean 'ground'?"),
        (PARTS, JOINTS, ["ground", "ground"], None, "fixed part 'ground' is named twice"),
        ([*PARTS, "crank"], JOINTS, ["ground"], None, "part 'crank' is named twice"),
        (PARTS, [*JOINTS, JOINTS[0]], ["ground"], None, "joint 'A' is named twice"),
        (
            PARTS,
            [*JOINTS, ("E", "rocker", "copuler")],
            ["ground"],
            None,
            "joint 'E' .* 'copuler'; did you mean 'coupler'?",
        ),
        (
            PARTS,
            [*JOINTS, (5, "rocker", "crank")],
            ["ground"],
            None,
            "name of a joint must be a text, got 5; write '5'",
        ),
        (PARTS, [*JOINTS, ("E", "rocker", "rocker")], ["ground"], None, "joint 'E' joins part 'rocker' to itself"),
        ([*PARTS, "handle"], JOINTS, ["ground"], None, "no joint holds 'handle'; join .* or leave it out"),
        ([*PARTS, "handle", "knob"], [*JOINTS, *LOOSE], ["ground"], None, "no chain of joints ties 'handle', 'knob'"),
        ([*PARTS, "ground&crank"], JOINTS, ["ground", "crank"], None, "part 'ground&crank' has the name"),
        (PARTS, JOINTS, ["ground"], "D", r"got the text 'D'; write chords=\['D'\]"),
        (PARTS, JOINTS, ["ground"], ["d"], "there is no joint 'd' to be a chord; did you mean 'D'?"),
        (PARTS, JOINTS, ["ground"], ["D", "D"], "chord 'D' is named twice"),
        (PARTS, JOINTS, ["ground"], [], "one chord for each independent loop, 1 in all, not 0"),
        (
            [*PARTS, "handle"],
            [*JOINTS, ("E", "crank", "handle")],
            ["ground"],
            ["E"],
            r"\['E'\]: without them some parts",
        ),
    ],
)
def test_refused_in_words(parts, joints, fixed, chords, message) -> None:
    with pytest.raises(ValueError, match=message):
        structure(parts, joints, fixed, chords)


def test_long_lists_of_names_are_cut() -> None:
    assert nearest("z", [f"part {i}" for i in range(10)]).endswith("'part 7' and 2 more")
    assert nearest("z", []) == "; there is none"
