"""The drawing of a structure: everything is in it, lines do not cross for want of care, and large ones are refused."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.text import Annotation

from jaxkin.topology.structure import Structure, diagram, structure
from jaxkin.view.layout import layout
from jaxkin.view.tree import boxes


def chain(count: int, more: tuple[tuple[str, str, str], ...] = ()) -> Structure:
    """Parts in a row, each on the one before, and some joints more."""
    parts = [f"p{k}" for k in range(count)]
    joints = [(f"j{k}", f"p{k - 1}", f"p{k}") for k in range(1, count)]
    return structure(parts, [*joints, *more], ["p0"])


MIXED = chain(9, (("a", "p0", "p3"), ("b", "p1", "p3"), ("c", "p4", "p6"), ("d", "p4", "p5"), ("$e_1$", "p2", "p8")))
FIG_7 = [
    (1, 5),
    (1, 6),
    (1, 7),
    (1, 8),
    (1, 9),
    (2, 3),
    (2, 9),
    (2, 10),
    (3, 10),
    (4, 5),
    (4, 6),
    (4, 7),
    (4, 8),
    (4, 10),
]


@pytest.fixture(scope="module")
def mixed():
    return MIXED.plot()


def heads(figure) -> list[Annotation]:
    return [text for text in figure.axes[0].texts if isinstance(text, Annotation)]


def texts(figure) -> list[str]:
    return [text.get_text() for axes in figure.axes for text in axes.texts] + [text.get_text() for text in figure.texts]


def test_all_names_and_loops_are_drawn(mixed) -> None:
    shown = texts(mixed)
    assert {*MIXED.parts, *MIXED.joints} <= set(shown)
    assert all(f"l{k + 1}   {loop}" in shown for k, loop in enumerate(MIXED.loops))
    assert len(heads(mixed)) == sum(len(loop.joints) for loop in MIXED.loops)


def test_no_name_is_cut_off_at_the_edge() -> None:
    joints = [("ground-crank", "ground", "crank"), ("crank-coupler", "crank", "coupler")]
    joints += [("coupler-rocker", "coupler", "rocker"), ("ground-rocker", "ground", "rocker")]
    figure = structure(["ground", "crank", "coupler", "rocker"], joints, ["ground"]).plot()
    graph = figure.axes[0]
    frame = graph.get_window_extent()
    for text in graph.texts:
        drawn = text.get_window_extent()
        assert frame.x0 <= drawn.x0 and drawn.x1 <= frame.x1, text.get_text()


def test_arrows_point_the_way_of_their_loops(mixed) -> None:
    """Of two that share a joint, both; the head lies farther along the joint than its foot."""
    at = {text.get_text(): np.array(text.get_position()) for text in mixed.axes[0].texts if text.get_text()}
    steps = {}
    for loop in MIXED.loops:
        for joint, sign in loop.joints:
            steps.setdefault(joint, []).append(sign)
    straight = [joint for joint in steps if MIXED.joints[joint] not in {"d", "j5"}]  # those two are bowed
    for joint in straight:
        start, end = (at[MIXED.row_of[part]] for part in MIXED.joint_parts[joint])
        for sign in steps[joint]:
            along = (end - start) * sign / np.linalg.norm(end - start)
            found = [np.subtract(arrow.xy, arrow.xyann) for arrow in heads(mixed) if _near(arrow.xy, start, end)]
            assert any(head @ along > 0.9 * np.linalg.norm(head) for head in found)
            assert not any(head @ along < -0.9 * np.linalg.norm(head) for head in found)


def _near(point, start, end) -> bool:
    """Whether a point lies within the lanes of a straight joint."""
    along = (end - start) / np.linalg.norm(end - start)
    offset = np.subtract(point, start)
    return abs(offset[0] * along[1] - offset[1] * along[0]) < 0.06 and 0 < offset @ along < np.linalg.norm(end - start)


@pytest.mark.long
def test_a_planar_graph_is_drawn_without_crossings() -> None:
    """The parallel linkage of Fig. 7, five ways between two parts, which a layout by distances alone lets cross."""
    places = layout(range(1, 11), FIG_7)
    lines = [(places[a], places[b]) for a, b in FIG_7]
    assert not any(_crossing(*first, *second) for k, first in enumerate(lines) for second in lines[:k])
    points = np.array(list(places.values()))
    np.testing.assert_allclose(np.ptp(points, axis=0)[0], 1.0)
    gaps = np.linalg.norm(points[:, None] - points, axis=-1) + np.eye(10)
    assert gaps.min() > 0.08  # a name of four letters, over a drawing of five inches
    assert np.array_equal(points, np.array(list(layout(range(1, 11), FIG_7).values())))


def _crossing(a, b, c, d) -> bool:
    def side(p, q, r):
        return np.sign(np.linalg.det(np.stack([q - p, r - p])))

    if any(p is q for p in (a, b) for q in (c, d)):
        return False
    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def test_elements_of_the_tree_keep_apart() -> None:
    parts = ["p0", *(f"q{k}" for k in range(6)), *(f"r{k}" for k in range(6))]
    joints = [(f"j{k}", "p0", f"q{k}") for k in range(6)] + [(f"i{k}", f"q{k}", f"r{k}") for k in range(6)]
    places = boxes(diagram(structure(parts, joints, ["p0"])))
    for level in {box.y for box in places}:
        row = sorted((box for box in places if box.y == level), key=lambda box: box.x)
        for left, right in pairwise(row):
            assert left.x + left.width / 2 < right.x - right.width / 2
    assert len({box.y for box in places}) == 3


def test_large_structures_are_drawn_or_refused() -> None:
    assert "a tree of 50 elements:\nprint the structure" in texts(chain(50).plot())
    with pytest.raises(ValueError, match=r"up to 600 parts, this structure has 601; print it"):
        chain(601).plot()


@pytest.mark.long
@pytest.mark.parametrize("found", [chain(1), chain(2), MIXED], ids=["one part", "two parts", "mixed"])
def test_the_file_appears_whole_or_not_at_all(found: Structure, tmp_path) -> None:
    found.plot(tmp_path / "loops.png")
    assert (tmp_path / "loops.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(FileNotFoundError):
        found.plot(tmp_path / "none" / "loops.png")
    assert [file.name for file in tmp_path.iterdir()] == ["loops.png"]
