"""Tubes and bars between two plates far apart, which hold these to each other, and such on which something moves.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring

LEVER = [
    part("pivot", pin(4.0, -8, 24, (0.0, 40.0)), pin(7.0, 24, 28, (0.0, 40.0)), pin(7.0, -12, -8, (0.0, 40.0))),
    part("lever", ring(4.1, 9.0, 5, 15, (0.0, 40.0)), block((8, 37, 5), (40, 43, 15))),
]
"""Something that moves on the low plate, whatever else is held."""


def plate(low, high, *holes, floor: tuple[float, float] | None = None):
    """Pieces of a plate with holes at places, each of some radius, and perhaps a floor of some heights under each."""
    collars = [ring(radius, 10, low, high, at) for radius, at in holes]
    floors = [pin(10, *floor, at) for _, at in holes] if floor else []
    return [*collars, *floors, block((-30, -30, low), (30, -10, high))]


def between(bars, gap=100.0, floors=False, others=()):
    """Two plates 4 thick and a gap apart with bars in holes at places: (radius of the bar, inner radius of a tube or 0,
    radius of the holes, the length by which it sticks out at the high end, the place); with floors 1 from their
    ends."""
    holes = [(hole, at) for _, _, hole, _, at in bars]
    ends = [(-3, 0), (8 + gap, 11 + gap)] if floors else [None, None]
    pivot = [ring(4.0, 9.0, 0, 4, (0.0, 40.0)), block((-4, 9, 0), (4, 32, 4))]
    low = part("low", *plate(0, 4, *holes, floor=ends[0]), *pivot)
    high = part("high", *plate(4 + gap, 8 + gap, *holes, floor=ends[1]))
    drawn = []
    for k, (outer, inner, _, out, at) in enumerate(bars):
        bottom, top = (1, 7 + gap) if floors else (0, 8 + gap + out)
        drawn.append(part(f"bar {k}", ring(inner, outer, bottom, top, at) if inner else pin(outer, bottom, top, at)))
    return assembly(low, high, *drawn, *LEVER, *others)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("inner", "hole"), [(5.0, 6.0), (5.0, 6.05), (0, 6.0), (0, 6.05)])
def test_a_bar_flush_with_two_plates_holds_them(inner, hole, seed):
    drawn = between([(6.0, inner, hole, 0.0, (0.0, 0.0))])
    mechanism = anywhere(drawn, seed).mechanism(fixed=["low"])
    body = owners(mechanism)
    assert body["low"] == body["high"] == body["bar 0"] != body["lever"]
    assert any("hold the two ends of 'bar 0' alike, flush with their faces" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("gap", "out"), [(100.0, 30.0), (2.0, 0.0)])
def test_plates_turn_on_a_bar_that_goes_on_or_beside_each_other(gap, out, seed):
    drawn = between([(6.0, 0, 6.05, out, (0.0, 0.0))], gap)
    body = owners(anywhere(drawn, seed).mechanism(fixed=["low"]))
    assert body["low"] != body["high"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("floors", [True, False])
def test_guide_rods_in_blind_holes_of_two_blocks_hold_these(floors, seed):
    """A carriage slides on the rods; in holes that go through, one block may slide, too."""
    places = ((-20.0, 0.0), (20.0, 0.0))
    slides = [ring(4.0, 10, 40, 60, at) for at in places]
    carriage = part("carriage", *slides, block((-10, -4, 40), (10, 4, 60)))
    drawn = between([(4.0, 0, 4.0, 0.0, at) for at in places], floors=floors, others=[carriage])
    mechanism = anywhere(drawn, seed).mechanism(fixed=["low"])
    body = owners(mechanism)
    assert (body["low"] == body["high"] == body["bar 0"] == body["bar 1"]) == floors
    if floors:
        assert kind_of(mechanism, "low", "carriage") == "prismatic"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wheel_that_is_flush_with_its_axle_may_turn_on_it(seed):
    drawn = between([(6.0, 0, 6.05, 0.0, (0.0, 0.0))])
    wheel = part("high", ring(6.05, 40, 104, 108))
    drawn = assembly(*(wheel if each.name == "high" else each for each in drawn.parts))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["low"])
    assert not any("hold the two ends" in note for note in mechanism.notes)
    assert moving(mechanism)
