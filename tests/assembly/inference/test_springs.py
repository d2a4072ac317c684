"""Tubes loose about a rod: springs between parts that move on each other, spacers between parts that screws clamp.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring

FOOT = block((-30, -60, -20), (30, -20, 60))


def plunger(clearance):
    """A rod with a collar and a handle in a long bush, and a tube about it between the bush and the collar."""
    base = part("base", FOOT, ring(5.0, 12.0, -20, 20), block((-4, -20, -20), (4, -11, 20)))
    rod = part("rod", pin(5.0, -40, 80), pin(9.0, 50, 55), block((4, -2, 70), (25, 2, 78)))
    return assembly(base, rod, part("tube", ring(5.0 + clearance, 8.0, 20, 50)))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("clearance", [0.2, 0.6])
def test_a_spring_does_not_keep_a_plunger_from_sliding_and_a_spacer_does(seed, clearance):
    mechanism = anywhere(plunger(clearance), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "rod") == ("revolute" if clearance < 0.4 else "cylindrical")
    assert any("taken for a spring" in note for note in mechanism.notes) == (clearance > 0.4)


@pytest.mark.parametrize("seed", range(3))
def test_what_a_user_says_of_a_tube_is_its_truth(seed):
    mechanism = anywhere(plunger(0.6), seed).mechanism(fixed=["base"], rigid=[["tube", "rod"]])
    assert kind_of(mechanism, "base", "rod") == "revolute"
    assert not any("taken for a spring" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", range(3))
def test_tubes_as_loose_as_springs_are_spacers_where_screws_clamp_what_is_at_their_ends(seed):
    """Two plates on two screws with heads and nuts, and tubes between the plates; a lever turns on one of them."""
    places = [(-20.0, 0.0), (20.0, 0.0)]
    holes = [ring(5.0, 8.0, low, low + 5, at) for at in places for low in (0, 35)]
    low = part("low plate", *holes[0::2], block((-60, 10, 0), (60, 20, 5)), ring(4.0, 8.0, -20, 0, (40.0, 40.0)))
    high = part("high plate", *holes[1::2], block((-60, 10, 35), (60, 20, 40)))
    screws = [part(f"screw {k}", pin(5.0, -5, 48, at), pin(9.0, 40, 48, at)) for k, at in enumerate(places)]
    nuts = [part(f"nut {k}", ring(5.0, 9.0, -5, 0, at)) for k, at in enumerate(places)]
    tubes = [part(f"tube {k}", ring(5.6, 8.0, 5, 35, at)) for k, at in enumerate(places)]
    lever = part(
        "lever", pin(4.0, -40, 0, (40.0, 40.0)), pin(9.0, -26, -20.2, (40.0, 40.0)), block((44, 38, -40), (80, 42, -32))
    )
    drawn = assembly(low, high, *screws, *nuts, *tubes, lever)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["low plate"])
    body = owners(mechanism)
    assert body["high plate"] == body["low plate"] != body["lever"]
    assert not any("taken for a spring" in note for note in mechanism.notes)


def valve(inner, length, pilot):
    """A stem in the guide of a head, with a retainer on it, and a thin tube far wider than both between."""
    outer, top = inner + 1.5, 10.0 + length
    head = part("head", ring(3.0, 40.0, -30.0, 10.0), block((-60, -80, -30), (60, -39, 10)))
    retainer = [*ring(3.0, pilot, top - 2, top), *ring(3.0, outer, top, top + 4)]
    stem = part("stem", pin(3.0, -60.0, top + 12), pin(14.0, -66.0, -60.0), retainer)
    return assembly(head, stem, part("tube", ring(inner, outer, 10.0, top)))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("inner", "length", "pilot"), [(9.5, 21.0, 9.0), (9.5, 21.0, 9.5), (7.0, 12.0, 6.0)])
def test_the_spring_of_a_valve_is_far_wider_than_its_stem_and_may_be_short(inner, length, pilot, seed):
    mechanism = anywhere(valve(inner, length, pilot), seed).mechanism(fixed=["head"])
    body = owners(mechanism)
    assert body["tube"] == body["head"] != body["stem"]
    assert kind_of(mechanism, "head", "stem") == "cylindrical"
    assert any("'tube' is taken for a spring" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_short_thin_ring_between_a_seat_and_a_retainer_is_no_spring(seed):
    mechanism = anywhere(valve(9.5, 5.0, 9.0), seed).mechanism(fixed=["head"])
    assert not any("taken for a spring" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_tube_of_a_cylinder_between_its_caps_is_no_spring(seed):
    """Caps on a tube of thin walls, far wider than the rod that comes out of one of them, on two tie rods; the piston
    on the rod fills the tube."""
    at = [(-30.0, -30.0), (30.0, 30.0)]
    caps = [
        part(name, ring(inner, 24.0, low, low + 10), *(ring(3.0, 8.0, low, low + 10, each) for each in at))
        for name, inner, low in (("cap", 4.0, 80.0), ("bottom", 3.0, -10.0))
    ]
    ties = [part(f"tie {k}", pin(3.0, -16.0, 96.0, each)) for k, each in enumerate(at)]
    nuts = [
        part(f"nut {k}{low:.0f}", ring(3.0, 5.0, low, low + 5, each))
        for k, each in enumerate(at)
        for low in (-15.0, 90.0)
    ]
    rod = part("rod", pin(4.0, 45.0, 130.0), pin(20.0, 30.0, 45.0))
    drawn = assembly(*caps, *ties, *nuts, rod, part("tube", ring(20.0, 22.0, 0.0, 80.0)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["bottom"])
    assert not any("taken for a spring" in note for note in mechanism.notes)
    assert owners(mechanism)["cap"] == owners(mechanism)["bottom"]
