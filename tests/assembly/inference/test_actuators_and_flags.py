"""Barrels of cylinders and actuators, pins with flags under screws, sliders in tracks, pinched steerers, pressed cups.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("floor", "held"), [(30.0, False), (18.0, True)])
def test_what_ends_behind_the_floor_of_its_bore_is_no_screw_on_the_bush_beyond(seed, floor, held):
    """The piston of a cylinder is not, with the wall of the eye between; a set screw in a hole that comes out is."""
    base = part("base", ring(19.0, 28.0, -20, 20), across(ring(10.0, 16.0, floor, 150)), PIVOT)
    bush = part("bush", pin(18.97, -20, 20))
    rod = part("rod", across(pin(9.95, 35 if floor > 20 else 19, 200)))
    _, mechanism = of(seed, base, bush, rod, LEVER)
    assert any("the screw 'rod' holds" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("screw_at", "held"), [(30.0, True), (None, False)])
def test_a_screw_through_its_flag_keeps_a_pin_from_turning(seed, screw_at, held):
    """The pin fits the ear in which it is, and would turn there without the screw, with what is tight on it."""
    at = (0.0, 30.0)
    base = part("base", ring(10.0, 20.0, 0, 20), ring(3.0, 8.0, 0, 20, at), PIVOT)
    flag = [ring(3.4, 8.0, 20, 26, at), block((-8, 8, 20), (8, 22, 26))]
    parts = [
        part("flagged", pin(10.0, -40, 26), *flag),
        part("link", ring(10.1, 20.0, -30, -10), block((18, -5, -30), (90, 5, -10))),
    ]
    parts += [part("screw", pin(3.0, 4, 26, at), pin(5.0, 26, 30, at))] if screw_at else []
    body, _ = of(seed, base, *parts, LEVER)
    assert (body["flagged"] == body["base"]) == held and body["link"] != body["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("depth", "held"), [(-3.0, False), (-6.0, True)])
def test_a_rivet_that_ends_in_its_slider_clamps_that_on_no_slot(seed, depth, held):
    """One that goes on into the slot, as a screw does into a profile, does."""
    walls = [block((-60, 6, -7), (60, 12, 0)), block((-60, -12, -7), (60, -6, 0)), block((-60, -12, -20), (60, 12, -7))]
    base = part("base", *walls, PIVOT)
    plate = [ring(3.0, 8.0, 0, 10), block((-20, -11, 0), (-8, 11, 10))]
    plate += [] if held else [ring(3.0, 5.0, depth, 0), block((-5, -5, -5), (5, 5, depth))]
    rivet = part("rivet", pin(3.0, depth, 14), pin(5.0, 14, 17))
    _, mechanism = of(seed, base, part("slider", *plate), rivet, LEVER)
    assert any("ends in a slot" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("kind", "held"), [("steerer", True), ("motor", False), ("loose", False)])
def test_a_screw_across_a_slit_pinches_a_steerer_but_no_motor(seed, kind, held):
    """The steerer is one solid with the crown of its fork; what has screw holes round about its shaft is a motor."""
    ears = [across(ring(1.5, 3.0, low, low + 7, (0.0, 14.0))) for low in (-8, 1)]
    hub = part("hub", ring(5.0, 12.0, -10, 10), *ears, block((-40, -40, -10), (40, -12, 10)))
    spots = [(sx * 12.0, sy * 12.0) for sx in (-1, 1) for sy in (-1, 1)]
    holes = [ring(1.25, 2.0, -90, -70, at) for at in spots] if kind == "motor" else []
    base = part("base", pin(5.0, -70, 12), block((-18, -30, -90), (18, 30, -70)), *holes, PIVOT)
    screws = [] if kind == "loose" else [part("screw", across(pin(1.5, -8, 8, (0.0, 14.0))))]
    body, _ = of(seed, base, hub, *screws, LEVER)
    assert (body["hub"] == body["base"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("radius", "held"), [(8.01, True), (8.0, False)])
def test_a_cup_with_interference_is_pressed_into_its_only_hole(seed, radius, held):
    """With an exact fit nothing that is drawn keeps it from turning."""
    base = part("base", ring(8.0, 14.0, 0, 8), PIVOT)
    cup = part("cup", pin(radius, 0, 8), block((-5, -12, 8), (5, 12, 14)))
    _, mechanism = of(seed, base, cup, LEVER)
    told = [note for note in mechanism.history if "'cup' is pressed into 'base'" in note]
    assert bool(told) == held and not any("play" in note for note in told)  # nothing else is on the cup


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("rib", "held"), [(1.0, True), (6.0, False)])
def test_a_nut_with_a_rib_is_set_into_its_tube_and_its_spindle_turns(seed, rib, held):
    """What reaches farther than a key is no sleeve."""
    tube = part("tube", ring(10.0, 13.0, 0, 100), block((-5, -40, 90), (5, -12, 100)))
    nut = part("nut", ring(6.0, 17.0, -15, 0), ring(6.0, 10.0, 0, 12), block((16, -3, -15), (17 + rib, 3, 0)))
    base = part("base", ring(17.05, 21.0, -100, 60), block((-30, -30, -120), (30, 30, -110)), PIVOT)
    spindle = part("spindle", pin(6.0, -90, 90), block((-4, -9, -100), (4, 9, -90)))
    body, mechanism = of(seed, base, tube, nut, spindle, LEVER)
    assert any("the sleeve 'nut' is set into" in note for note in mechanism.history) == held
    assert not held or body["nut"] == body["tube"] != body["spindle"]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_tube_of_an_actuator_is_no_nut_of_the_one_that_slides_in_it(seed):
    base = part("base", block((-30, -30, -120), (30, 30, -100)), PIVOT)
    outer, gland = part("outer", ring(17.0, 21.0, -100, 60)), part("gland", ring(13.05, 17.0, 50, 60))
    inner = part("inner", pin(16.95, -60, -40), pin(13.0, -40, 100), block((-5, -40, 100), (5, 40, 110)))
    body, _ = of(seed, base, outer, gland, inner, LEVER)
    assert body["gland"] == body["outer"] != body["inner"]
