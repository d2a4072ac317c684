"""Where a pin with play in some parts belongs, which slides a far stop leaves, and screws that guide instead of hold.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
LEVER = part("pivot lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("play", "owner"), [(0.3, "base"), (0.0, "fork")])
def test_a_bolt_belongs_to_the_part_without_play_and_else_to_the_fork(seed, play, owner):
    """The fork turns on its bolt either way."""
    base = part("base", ring(8, 14, -10, 10), block((-60, -10, -10), (-14, 10, 10)))
    lugs = [ring(8 + play, 14, 10.2, 20), ring(8 + play, 14, -20, -10.2)]
    fork = part("fork", *lugs, block((14, -6, 10.2), (60, 6, 20)), block((14, -6, -20), (60, 6, -10.2)))
    bolt, nut = part("bolt", pin(8, -20.2, 30), pin(13, -28, -20.2)), part("nut", ring(8, 13, 20.2, 28))
    body, mechanism = of(seed, base, fork, bolt, nut)
    assert body["bolt"] == body[owner] and kind_of(mechanism, "base", "fork") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
def test_leaves_that_fill_a_pin_between_its_ends_stop_each_other(seed):
    """Alone each leaf could slide to where the other one is."""
    base = part("base", ring(2.5, 5, -8, 0), ring(2.5, 5, 24.4, 32), block((-40, -20, -8), (-5, 20, 32)))
    hinge_pin = part("pin", pin(2.5, -8, 32), pin(5, -12, -8.1), pin(5, 32.1, 36))
    leaves = [
        part(name, ring(2.6, 5, low, low + 12), block((5, sign * 2, low), (40, sign * 4, low + 12)))
        for name, low, sign in (("one", 0.1, 1), ("other", 12.3, -1))
    ]
    _, mechanism = of(seed, base, hinge_pin, *leaves)
    assert [kind_of(mechanism, "base", leaf) for leaf in ("one", "other")] == ["revolute", "revolute"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("stops", "kind"), [(True, "cylindrical"), (False, "revolute")])
def test_a_rod_that_stands_in_the_middle_slides_between_stops_that_are_far_away(seed, stops, kind):
    """Without any stop it is taken to turn in the middle."""
    base = part("base", ring(8, 14, -105, -95), ring(8, 14, 95, 105), block((-60, -14, -105), (-14, 14, 105)))
    collars = [ring(8, 12, z - 4, z + 4) for z in (-40, 40)] if stops else []
    rod = part("rod", pin(8, -160, 160), *collars, block((-3, 20, -5), (3, 60, 5)))
    _, mechanism = of(seed, base, rod)
    assert kind_of(mechanism, "base", "rod") == kind


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("stroke", "held"), [(30.0, False), (5.0, True)])
def test_a_screw_that_ends_in_a_slot_along_a_finger_guides_it(seed, stroke, held):
    """In a recess that is no longer than its tip it holds."""
    hole = across(ring(2.5, 4.0, 9.1, 20))
    base = part("base", ring(9.1, 20, -25, 25), hole, block((-60, -20, -25), (-20, 20, 25)), PIVOT)
    walls = [block((4, y, -stroke / 2), (8.2, y + 1, stroke / 2)) for y in (-3, 2)]
    finger = part("finger", pin(9, -60, 60), *walls)
    screw = part("screw", across(pin(2, 5, 9.5)), across(pin(2.5, 9.5, 20)))
    _, mechanism = of(seed, base, finger, screw, LEVER)
    assert any("the screw 'screw' holds" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("length", [1.2, 30.0])
def test_a_ring_on_the_end_of_a_pin_is_no_rod_that_it_pulls_against_a_lever(seed, length):
    """The pin fits its base exactly, and the lever has play on it."""
    base = part("base", ring(5, 10, 0, 12), block((-40, -10, 0), (-10, 10, 12)))
    lugs = [piece for z in (-10.2, 12.2) for piece in (ring(5.4, 10, z, z + 10), block((10, -5, z), (60, 5, z + 10)))]
    pivot, end = part("pivot", pin(5, -10.2, 26), pin(8, -14, -10.2)), part("end", ring(5, 8, 22.2, 22.2 + length))
    lever = part("lever", *lugs)
    _, mechanism = of(seed, base, lever, pivot, end)
    assert any("pulls it against 'lever'" in note for note in mechanism.history) == (length > 20)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("hole", "held"), [(3.0, False), (3.5, True)])
def test_a_stop_screw_in_its_cap_is_not_one_body_with_the_piston_that_meets_it(seed, hole, held):
    """A rod that stands there with play around it is."""
    base = part("base", ring(10, 16, 0, 60), ring(hole, 16, 60, 70), block((-60, -16, 0), (-15, 16, 60)), PIVOT)
    piston, screw = part("piston", pin(10, 10, 40)), part("screw", pin(3.0, 40, 80), pin(5, 80, 84))
    _, mechanism = of(seed, base, piston, screw, LEVER)
    assert any("stands on the coaxial end of 'piston'" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("wide", "held"), [(9.0, True), (60.0, False)])
def test_a_bar_that_ends_on_a_part_is_held_there_by_the_screw_in_its_end(seed, wide, held):
    """A bar between two cheeks is slender along the screw, as a rod is; a link is wide across it."""
    base = part("base", ring(3.3, 10, 0, 5), block((-60, -20, 0), (-10, 20, 5)), PIVOT)
    bar = part("bar", ring(3, 8, 5, 25), block((-wide, -8, 25), (9, 8, 160)))
    screw = part("screw", pin(3, -0.1, 24), pin(6, -6, 0))
    _, mechanism = of(seed, base, bar, screw, LEVER)
    assert any("'screw' in the end of 'bar' pulls it against 'base'" in note for note in mechanism.history) == held
