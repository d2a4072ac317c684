"""Parts on one bolt with its nut, with the clearance of a screw: brackets that it clamps, levers and leaves that turn.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import re

import pytest

import jaxkin as jk
from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
OTHER = part("other lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""It turns and slides on the pivot of the base: where nothing moves, inferences are left out until something does."""
EYE = ring(3.3, 14.0, -3, 0)
BOLT = part("bolt", pin(3.0, -9, 2), pin(7.0, 2, 4)), part("nut", ring(3.0, 5.5, -8, -3)[:-1])
"""An M6 bolt through the eye of the base and 2 mm more."""


def link(name, one, other, low):
    """A bar with a hole at one place and a headed pin at another one, which stands up from it."""
    middle = [(a + b) / 2 for a, b in zip(one, other, strict=True)]
    bar = block((middle[0] - 4, middle[1] - 4, low), (middle[0] + 4, middle[1] + 4, low + 4))
    ends = pin(3.0, low, low + 12, other), pin(6.0, low + 12, low + 13, other)
    return part(name, ring(3.1, 8.0, low, low + 4, one), bar, *ends)


def stud(at, low, high):
    """A pin with a head."""
    return pin(3.0, low, high, at), pin(6.0, high, high + 1, at)


def of(seed, *parts):
    drawn = anywhere(assembly(*parts, *BOLT, OTHER), seed)
    mechanism = drawn.mechanism(fixed=["base"])
    return drawn, owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
def test_a_crank_on_a_bolt_turns_where_a_coupler_and_a_rocker_close_a_ring_of_four(seed):
    base = part("base", EYE, block((14, -4, -3), (80, 4, 0)), *stud((0, -60), -3, 18), PIVOT)
    crank = part("crank", ring(3.3, 14.0, 0, 2), block((-56, -4, 0), (-14, 4, 2)), *stud((-60, 0), 0, 12))
    coupler = link("coupler", (-60, 0), (-60, -60), 4)
    rocker = part("rocker", *(ring(3.1, 8.0, 10, 14, (x, -60)) for x in (-60, 0)), block((-52, -64, 10), (-8, -56, 14)))
    _, body, mechanism = of(seed, base, crank, coupler, rocker)
    assert body["crank"] != body["base"]
    assert mechanism.mobility().useful == 3  # that of the ring, and two of the other lever


@pytest.mark.parametrize("seed", SEEDS)
def test_a_bracket_on_a_bolt_is_clamped_where_it_carries_a_ring_of_four(seed):
    base = part("base", EYE, block((14, -4, -3), (80, 4, 0)), *stud((60, -60), -3, 26), PIVOT)
    bracket = part("bracket", ring(3.3, 14.0, 0, 2), block((-56, -4, 0), (-14, 4, 2)), *stud((-60, 0), 0, 12))
    crank, coupler = link("crank", (-60, 0), (-60, -40), 4), link("coupler", (-60, -40), (0, -60), 11)
    rocker = part("rocker", *(ring(3.1, 8.0, 18, 22, (x, -60)) for x in (0, 60)), block((8, -64, 18), (52, -56, 22)))
    _, body, mechanism = of(seed, base, bracket, crank, coupler, rocker)
    assert body["bracket"] == body["base"]
    assert mechanism.mobility().useful == 3


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("leaf", [True, False])
def test_a_leaf_between_two_eyes_turns_on_two_bolts_of_one_axis(seed, leaf):
    """With one bolt only it is a bracket."""
    lug = [ring(3.3, 14.0, 100, 103), block((14, -4, 100), (80, 4, 103))] if leaf else []
    base = part("base", EYE, block((14, -4, -3), (80, 4, 0)), *lug, PIVOT)
    eyes = [ring(3.3, 14.0, low, low + 2) for low in (0, 98)[: 1 + leaf]]
    door = part("door", *eyes, block((-80, -2, 0), (-13, 2, 100 if leaf else 2)))
    second = part("second bolt", pin(3.0, 98, 109), pin(7.0, 96, 98)), part("second nut", ring(3.0, 5.5, 103, 108)[:-1])
    _, body, mechanism = of(seed, base, door, *(second if leaf else ()))
    assert (body["door"] == body["base"]) != leaf
    assert not leaf or kind_of(mechanism, "door", "base") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pedal_on_a_bolt_is_taken_as_clamped_and_told_with_the_line_that_makes_it_a_hinge(seed):
    """Nothing that is drawn tells it from a bracket."""
    base = part("base", EYE, block((14, -4, -3), (80, 4, 0)), PIVOT)
    pedal = part("pedal", ring(3.3, 14.0, 0, 2), block((-80, -4, 0), (-14, 4, 2)), ring(2.0, 6.0, 0, 2, (-90, 0)))
    drawn, body, mechanism = of(seed, base, pedal)
    assert body["pedal"] == body["base"]
    (line,) = (found[1] for note in mechanism.history if (found := re.search(r"give joints=\[(jk\..*\))\]", note)))
    hinged = drawn.mechanism(fixed=["base"], joints=[eval(line, {"jk": jk})])
    assert kind_of(hinged, "pedal", "base") == "revolute"
    assert hinged.mobility().useful == 3


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("flat", [False, True])
def test_a_head_clamps_what_it_lies_flat_on_and_no_round_shank_that_it_touches_on_a_line(flat, seed):
    """A crank pin with a head; the shank of the rod is as thick as its eye is long, and touches head and crank."""
    crank = part("crank", ring(3.0, 10.0, -12, -5), block((9, -4, -12), (60, 4, -5)), ring(4.0, 9.0, -12, -5, (68, 0)))
    base = part("base", pin(4.0, -40, 10, (68, 0)), block((40, -30, -60), (96, 30, -40)))
    bolt = part("pin", pin(3.0, -12, 5), pin(6.0, 5, 8))
    eye = ring(3.3, 8.0, -5, 5) if flat else ring(3.3, 8.0, -4.5, 4.5)
    shank = block((-60, -4, -5), (-7, 4, 5)) if flat else across(pin(5.0, -60, -4.5))
    rod = part("rod", eye, shank)
    body = owners(anywhere(assembly(base, crank, bolt, rod), seed).mechanism(fixed=["base"]))
    assert body["pin"] == body["crank"]
    assert (body["rod"] == body["crank"]) is flat
