"""What a drive moves, against displacements that are plain numbers, added up along the tree."""

from random import Random

import pytest

from jaxkin.topology.moving import moving
from jaxkin.topology.structure import Structure, structure

# The paper's Fig. 3 from the loops downwards: two elements with loops, the second one below two joints.
FIRST = [("j1", "p1", "p2"), ("j2", "p2", "p3"), ("j4", "p3", "p4"), ("j5", "p1", "p4")]
BETWEEN = [("j3", "p3", "p11"), ("j7", "p4", "p10"), ("j16", "p10", "p15")]
SECOND = [("j17", "p15", "p16"), ("j18", "p16", "p17"), ("j20", "p15", "p17")]
SHARED = [("k1", "p16", "p21"), ("k2", "p21", "p22"), ("k3", "p22", "p16")]


def example() -> Structure:
    joints = [*FIRST, *BETWEEN, *SECOND, *SHARED]
    return structure(sorted({part for _, *ends in joints for part in ends}), joints, ["p1"])


@pytest.mark.parametrize(
    ("driven", "solved", "parts"),
    [
        ([], [], ""),
        (["j1"], ["j1"], "p2 p3 p4 p10 p11 p15 p16 p17 p21 p22"),
        (["j3"], [], "p11"),
        (["j7"], [], "p10 p15 p16 p17 p21 p22"),
        (["j18"], ["j17"], "p16 p17 p21 p22"),
        (["k2"], ["k1"], "p21 p22"),
        (["j3", "k1"], ["k1"], "p11 p21 p22"),
    ],
)
def test_what_a_drive_moves(driven: list[str], solved: list[str], parts: str) -> None:
    found = moving(example(), driven)
    assert [example().joints[block.joints[0]] for block in found.loop_groups] == solved
    assert set(found.parts) == set(parts.split())


@pytest.mark.parametrize("seed", range(20))
def test_parts_that_are_said_to_rest_do(seed: int) -> None:
    """Random places for the parts of solved loops close them; all that is displaced is said to move, and no more."""
    random = Random(seed)
    found = example()
    driven = random.sample(found.joints, random.randrange(1, 4))
    share = moving(found, driven)
    values = {joint: random.random() if joint in driven else 0.0 for joint in found.joints}
    for block in share.loop_groups:
        place = {part: random.random() for part in found.part_names}
        for column in block.joints:
            part1, part2 = found.joint_parts[column]
            values[found.joints[column]] = place[part2] - place[part1]
    places = {"p1": 0.0}
    for part, parent, joint, sign in found.tree:
        places[part] = places[parent] + sign * values[found.joints[joint]]
    displacements = [values[joint] for joint in found.joints]
    assert abs(found.cycles @ displacements).max() < 1e-12  # all loops close but for rounding
    assert {part for part, place in places.items() if abs(place) > 1e-12} == set(share.parts)
