"""The paper's three examples: Eq. (2)-(9), Tables 3, 5 and 7, Fig. 4, the order of Section 5.2 (as corrected)."""

import numpy as np
import pytest

from jaxkin.topology.structure import Structure, structure

# Eq. (2) with the corrected rows. It has p1 and p9 in one row; j11 and j12 are taken to be those that p9 holds.
EXAMPLE_1 = {
    **{1: (1, 2), 2: (2, 3), 3: (3, 11), 4: (3, 4), 5: (1, 4), 6: (4, 5), 7: (5, 10), 8: (5, 6), 9: (6, 7)},
    **{10: (7, 8), 11: (9, 8), 12: (9, 6), 13: (11, 12), 14: (10, 13), 15: (13, 14), 16: (10, 15), 17: (15, 16)},
    **{18: (16, 17), 19: (17, 18), 20: (15, 18)},
}
EXAMPLE_2 = {1: (1, 2), 2: (1, 3), 3: (1, 3), 4: (2, 3), 5: (2, 3)}  # Table 4
EXAMPLE_3 = {  # Table 6
    **{1: (1, 5), 2: (1, 6), 3: (1, 7), 4: (1, 8), 5: (1, 9), 6: (2, 3), 7: (2, 9), 8: (2, 9)},
    **{9: (2, 10), 10: (3, 10), 11: (4, 5), 12: (4, 6), 13: (4, 7), 14: (4, 8), 15: (4, 10), 16: (4, 10)},
}
CHORDS_1 = ["j5", "j11", "j12", "j20"]
TABLE_3 = """
p1&p9 j5 p4 j4 p3 j2 p2 j1
p1&p9 j11 p8 j10 p7 j9 p6 j8 p5 j6 p4 j4 p3 j2 p2 j1
p1&p9 j12 p6 j8 p5 j6 p4 j4 p3 j2 p2 j1
p15 j20 p18 j19 p17 j18 p16 j17
"""
TABLE_5 = """
p3 j2 p1 j1 p2 j4
p1 j1 p2 j5 p3 j2
p3 j2 p1 j3
"""
TABLE_7 = """
p4 j12 p6 j2 p1 j1 p5 j11
p1 j1 p5 j11 p4 j13 p7 j3
p1 j1 p5 j11 p4 j14 p8 j4
p1 j1 p5 j11 p4 j15 p10 j9 p2 j7 p9 j5
p1 j1 p5 j11 p4 j16 p10 j9 p2 j7 p9 j5
p10 j9 p2 j6 p3 j10
p2 j7 p9 j8
"""


def example(pairs: dict[int, tuple[int, int]], fixed: list[str], chords: list[str] | None = None) -> Structure:
    parts = [f"p{number}" for number in sorted({part for pair in pairs.values() for part in pair})]
    return structure(parts, [(f"j{j}", f"p{a}", f"p{b}") for j, (a, b) in pairs.items()], fixed, chords)


def paths(table: str) -> list[tuple[str, ...]]:
    return [tuple(line.split()) for line in table.strip().splitlines()]


def matrix(table: str, found: Structure) -> np.ndarray:
    """The cycle matrix of a table of loops, each joint signed by the part that is left over it."""
    rows = np.zeros((len(paths(table)), len(found.joints)), int)
    for row, path in zip(rows, paths(table), strict=True):
        for part, joint in zip(path[::2], path[1::2], strict=True):
            column = found.joints.index(joint)
            row[column] = 1 if found.row_of[found.joint_parts[column][0]] == part else -1
    return rows


def one_sign(cycles: np.ndarray) -> bool:
    return not ((cycles > 0).any(axis=0) & (cycles < 0).any(axis=0)).any()


def test_incidence_is_equation_2() -> None:
    found = example(EXAMPLE_1, ["p1", "p9"])
    assert found.parts == ("p1&p9", *(f"p{i}" for i in (2, 3, 4, 5, 6, 7, 8, 10, 11, 12, 13, 14, 15, 16, 17, 18)))
    assert found.incidence.shape == (17, 20)
    assert not found.incidence.sum(axis=0).any()
    rows = dict(zip(found.parts, found.incidence, strict=True))
    plus = {"p1&p9": [1, 5, 11, 12], "p3": [3, 4], "p10": [14, 16], "p14": [], "p15": [17, 20], "p18": []}
    minus = {"p1&p9": [], "p3": [2], "p10": [7], "p14": [15], "p15": [16], "p18": [19, 20]}
    for part in plus:
        assert [int(j) + 1 for j in np.flatnonzero(rows[part] > 0)] == plus[part]
        assert [int(j) + 1 for j in np.flatnonzero(rows[part] < 0)] == minus[part]


def test_cycles_are_equations_3_and_5() -> None:
    found = example(EXAMPLE_1, ["p1", "p9"], CHORDS_1)
    chords = [found.joints.index(chord) for chord in CHORDS_1]
    tree = [joint for joint in range(20) if joint not in chords]
    reduced = found.incidence[1:]
    expected = np.zeros((4, 20))
    expected[:, chords] = np.eye(4)
    expected[:, tree] = -reduced[:, chords].T @ np.linalg.inv(reduced[:, tree].T)
    np.testing.assert_allclose(found.cycles, expected, atol=1e-12)  # integers by way of one float inverse
    equation_5 = {
        "j1 j2 j4": [-1, -1, -1, 0],
        "j3 j7 j13 j14 j15 j16": [0, 0, 0, 0],
        "j6 j8": [0, -1, -1, 0],
        "j9 j10": [0, -1, 0, 0],
        "j17 j18 j19": [0, 0, 0, -1],
    }
    for joints, column in equation_5.items():
        for joint in joints.split():
            assert found.cycles[:, found.joints.index(joint)].tolist() == column


def test_loop_data_is_table_3() -> None:
    assert [loop.path for loop in example(EXAMPLE_1, ["p1", "p9"], CHORDS_1).loops] == paths(TABLE_3)


def test_tree_is_figure_4() -> None:
    found = example(EXAMPLE_1, ["p1", "p9"], CHORDS_1)
    nodes = [(e.kind, e.upper, e.lower, e.joint, e.above, e.loops) for e in found.elements]
    assert nodes == [
        ("multiple loop", "p1&p9", ("p3", "p5"), None, None, (0, 1, 2)),
        ("part", "p10", ("p10",), "j7", 0, ()),
        ("part", "p11", ("p11",), "j3", 0, ()),
        ("part", "p13", ("p13",), "j14", 1, ()),
        ("single loop", "p15", (), "j16", 1, (3,)),
        ("part", "p12", (), "j13", 2, ()),
        ("part", "p14", (), "j15", 3, ()),
    ]
    assert found.elements[0].parts == ("p1&p9", "p2", "p3", "p4", "p5", "p6", "p7", "p8")
    assert found.elements[4].parts == ("p15", "p16", "p17", "p18")
    assert [found.joints[joint] for joint in found.loop_groups[1].joints] == ["j17", "j18", "j19", "j20"]


def test_parts_are_placed_in_the_order_of_section_5_2() -> None:
    found = example(EXAMPLE_1, ["p1", "p9"], CHORDS_1)
    order = "4=1*5 3=4*4 2=3*2 8=9*11 7=8*10 6=7*9 5=6*8 10=5*7 11=3*3"
    order += " 13=10*14 15=10*16 12=11*13 18=15*20 17=18*19 16=17*18 14=13*15"
    steps = [f"{part[1:]}={parent[1:]}*{joint + 1}" for part, parent, joint, _ in found.tree]
    assert steps == order.split()
    for part, parent, joint, sign in found.tree:
        assert found.joint_parts[joint] == ((parent, part) if sign > 0 else (part, parent))


def test_change_of_tree_is_equation_8() -> None:
    before = example(EXAMPLE_1, ["p1", "p9"], CHORDS_1)
    after = example(EXAMPLE_1, ["p1", "p9"], ["j1", "j9", "j8", "j17"])
    chosen = [after.joints.index(chord) for chord in after.chords or ()]
    changed = np.linalg.inv(before.cycles[:, chosen]) @ before.cycles
    turned = np.diag(after.cycles[:, chosen])  # operation (a)
    np.testing.assert_allclose(after.cycles, turned[:, None] * changed, atol=1e-12)


def test_loops_without_chords_are_the_shortest() -> None:
    found = example(EXAMPLE_1, ["p1", "p9"])
    table = matrix(TABLE_3, found)
    assert np.linalg.matrix_rank(np.vstack([table, found.cycles])) == np.linalg.matrix_rank(found.cycles) == 4
    assert one_sign(found.cycles)
    assert [len(loop.joints) for loop in found.loops] == [4, 4, 4, 4]  # Table 3: 4, 8, 6, 4
    assert [loop.path[0] for loop in found.loops] == ["p1&p9", "p1&p9", "p1&p9", "p15"]


def test_one_fixed_part_leaves_three_single_loops() -> None:
    found = example(EXAMPLE_1, ["p1"])
    assert found.incidence.shape == (18, 20)
    assert [element.kind for element in found.elements if element.loops] == ["single loop"] * 3
    assert found.loops[0].path == ("p1", "j5", "p4", "j4", "p3", "j2", "p2", "j1")
    assert [(e.upper, e.joint) for e in found.elements if e.loops] == [("p1", None), ("p6", "j8"), ("p15", "j16")]
    assert {part for part, *_ in found.tree} == {f"p{i}" for i in range(2, 19)}


@pytest.mark.parametrize(
    ("pairs", "fixed", "table", "chords"),
    [
        (EXAMPLE_2, "p3", TABLE_5, ["j4", "j5", "j3"]),
        (EXAMPLE_3, "p4", TABLE_7, ["j12", "j13", "j14", "j15", "j16", "j10", "j8"]),
    ],
    ids=["Table 5", "Table 7"],
)
def test_tables_5_and_7(pairs: dict[int, tuple[int, int]], fixed: str, table: str, chords: list[str]) -> None:
    found = example(pairs, [fixed])
    expected = matrix(table, found)
    assert one_sign(expected)
    assert len(found.loops) == len(expected) == len(pairs) - len(found.parts) + 1
    assert np.linalg.matrix_rank(found.cycles) == len(expected)
    assert np.linalg.matrix_rank(np.vstack([expected, found.cycles])) == len(expected)
    assert one_sign(found.cycles)
    assert np.abs(found.cycles).sum() <= np.abs(expected).sum()
    assert [element.kind for element in found.elements] == ["multiple loop"]
    assert found.loops[0].path[0] == fixed

    asked = example(pairs, [fixed], chords)
    assert {tuple(row) for row in asked.cycles} == {tuple(row) for row in expected}
