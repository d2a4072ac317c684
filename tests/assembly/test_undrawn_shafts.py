"""A crank whose shaft is not drawn turns idly between its rods: that is told, with a hinge that was tried."""

import re

import pytest

import jaxkin as jk
from reference.round_parts import SEEDS, anywhere, assembly, block, part, pin, ring

PIN = (0.0, 12.0)


def engine(about):
    """Two levers on the base, and two rods from these to the pin of a crank, whose disc is amid a recess of the base
    or of something else."""
    posts, ends = ((-80.0, 0.0), (80.0, 0.0)), ((-80.0, 40.0), (80.0, 40.0))
    wall = ring(20.0, 30.0, 0, 6, about)
    shoulders = [piece for at in posts for piece in (pin(4.0, 0, 10, at), pin(7.0, 10, 12, at))]
    parts = [part("base", block((-100, -20, -10), (100, 20, 0)), wall, *shoulders)]
    parts.append(
        part("crank", pin(10.0, 1, 5), pin(3.0, 5, 20, PIN), pin(5.0, 20, 21, PIN), block((-2, 9, 1), (2, 14, 5)))
    )
    for name, post, end, low in (("left", posts[0], ends[0], 10.1), ("right", posts[1], ends[1], 15.1)):
        eye = [ring(4.1, 9.0, 0.1, 9.9, post), block((end[0] - 2, 8, 0.1), (end[0] + 2, 42, 9.9))]
        parts.append(part(f"{name} lever", *eye, pin(3.0, 9.9, low + 5, end), pin(5.0, low + 5, low + 7, end)))
        bar = block((min(end[0], 0) + 8, 20, low), (max(end[0], 0) - 8, 24, low + 4.8))
        parts.append(part(f"{name} rod", ring(3.1, 7.0, low, low + 4.8, end), ring(3.1, 7.0, low, low + 4.8, PIN), bar))
    return assembly(*parts)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_hinge_of_a_crank_is_told_where_its_shaft_is_not_drawn(seed):
    drawn = anywhere(engine((0.0, 0.0)), seed)
    mechanism = drawn.mechanism(fixed=["base"])
    (told,) = (note for note in mechanism.notes if "a shaft that is not drawn" in note)
    line = re.search(r"joints=\[(jk\.revolute\(.*\))\]", told)
    assert line and told.startswith("crank turns between")
    joint = eval(line[1], {"jk": jk})
    tried = drawn.mechanism(fixed=["base"], joints=[joint])
    assert mechanism.mobility().useful == 2 and mechanism.mobility().idle_freedoms == 1
    assert tried.mobility().useful == 1 and tried.mobility().idle_freedoms == 0
    assert told.endswith("which leaves one useful freedom")
    assert not any("a shaft that is not drawn" in note for note in tried.notes)


def test_nothing_is_told_where_no_round_face_is_on_the_axis_of_the_crank():
    mechanism = engine((3.0, 0.0)).mechanism(fixed=["base"])
    assert mechanism.mobility().idle_freedoms == 1
    assert not any("a shaft that is not drawn" in note for note in mechanism.notes)
