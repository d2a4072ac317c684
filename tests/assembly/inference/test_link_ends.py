"""Ends of links whose screw is not drawn, as authors of printed machines leave it out."""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, moving, owners, part, pin, ring

ROCKER, CRANK = (60.0, 0.0), (0.0, 0.0)
FAR, NEAR = (60.0, 40.0), (0.0, 30.0)


def four_bar(narrow=1.65, wide=2.2, gap=0.3, at=NEAR, screwed=False):
    """A crank and a rocker on a base, and a link on a pin of the rocker, `gap` above the crank: a hole of its other
    end is over a hole of the crank. The crank is on a pin of the base, or under a screw in a post of it."""
    post = [ring(1.6, 5.0, -10, 0, CRANK)] if screwed else [pin(5.0, -10, 5.2, CRANK), pin(7.0, 5.2, 6.2, CRANK)]
    stub = pin(5.0, -10, 5.2, ROCKER), pin(7.0, 5.2, 6.2, ROCKER)
    base = part("base", block((-40, -40, -12), (100, -12, -0.2)), block((7, -12, -12), (50, 60, -0.2)), *post, *stub)
    eye = ring(2.1 if screwed else 5.2, 9.0, 0, 5, CRANK)
    crank = part("crank", eye, block((-3, 9, 0), (3, 26, 5)), ring(narrow, 5.0, 0, 5, NEAR))
    pivot = pin(3.0, 0, 12.5, FAR), pin(5.0, 12.5, 14, FAR)
    rocker = part("rocker", ring(5.2, 9.0, 0, 5, ROCKER), block((57, 9, 0), (63, 38, 5)), pin(5.0, 5, 6.9, FAR), *pivot)
    low, high = 5 + gap, 12
    link = ring(3.2, 6.0, 7, high, FAR), block((4, 31, 7), (54, 37, high)), ring(wide, 5.0, low, high, at)
    screw = [part("screw", pin(2.0, -9, 5, CRANK), pin(3.5, 5, 7, CRANK))] if screwed else []
    return assembly(base, crank, rocker, part("link", *link), *screw)


def kinds(mechanism):
    """The kinds of the joints between the crank and the link."""
    body = owners(mechanism)
    pair = {body["crank"], body["link"]}
    return [each.kind for each in moving(mechanism) if {body[part] for part in each.parts} == pair]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("narrow", "gap", "joined"), [(1.65, 0.3, True), (1.65, 0.0, True), (1.2, 0.3, False), (1.65, 1.8, False)]
)
def test_the_end_of_a_link_turns_on_a_screw_that_is_not_drawn(narrow, gap, joined, seed):
    """Its hole is beside one as drilled for the thread of what goes through it: not a far thinner one, nor far away."""
    mechanism = anywhere(four_bar(narrow, gap=gap), seed).mechanism(fixed=["base"])
    assert kinds(mechanism) == (["revolute"] if joined else [])
    assert mechanism.mobility().useful == (1 if joined else 3)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_hole_that_is_not_in_line_is_no_end_of_a_link(seed):
    mechanism = anywhere(four_bar(at=(0.0, 30.5)), seed).mechanism(fixed=["base"])
    assert not kinds(mechanism)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("narrow", "turns"), [(1.65, True), (1.2, False)])
def test_a_crank_under_the_screw_in_its_shaft_turns_where_such_a_link_closes_a_ring_of_four(narrow, turns, seed):
    """As the horn of a servo whose shaft is one solid with it: clamped, it would lock all four."""
    mechanism = anywhere(four_bar(narrow, screwed=True), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert (body["crank"] != body["base"]) == turns
    assert not turns or (kinds(mechanism), mechanism.mobility().useful) == (["revolute"], 1)
