"""Halves that screws draw onto a tube, U-bolts, pins across telescopes; bearings in halves, guides and slots hold none.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


def half_hole(radius, low, high, side):
    """The half of a hole about z that lies where x has a sign, without the faces beside it."""
    (surface, triangles) = ring(radius, 2 * radius, low, high)[2]
    return [(surface, triangles[np.all(side * triangles[..., 0] >= -1e-9 * radius, axis=1)])]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("gap", "beside", "held"), [(1.0, False, True), (1.0, True, True), (0.0, False, False)])
def test_halves_with_a_gap_between_them_clamp_the_tube_that_their_screws_draw_them_onto(seed, gap, beside, held):
    """Those of a bearing lie on each other, and their screws do not press on the shaft.

    What one of them has beside the tube, such as the stem of a handlebar, is of no matter.
    """
    base, spots = part("base", pin(11.0, -150, 150), PIVOT), [(0.0, 18.0), (0.0, -18.0)]
    upper = [across(ring(3.2, 6.0, gap / 2, 17, at)) for at in spots]
    lower = [across(ring(2.5, 6.0, -17, -gap / 2, at)) for at in spots]
    lower += [block((-17, 30, -10), (40, 60, 10))] if beside else []
    halves = part("upper", half_hole(11.0, -20, 20, 1), *upper), part("lower", half_hole(11.0, -20, 20, -1), *lower)
    screws = [part(f"screw {k}", across(pin(3.0, -14, 17, at), pin(5.0, 17, 22, at))) for k, at in enumerate(spots)]
    body, mechanism = of(seed, base, *halves, *screws, LEVER)
    assert body["upper"] == body["lower"]
    assert (body["upper"] == body["base"]) == held
    assert any("across a gap of" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("legs", "held"), [(19.0, True), (23.0, False)])
def test_a_u_bolt_holds_the_tube_that_fills_it_and_the_saddle_on_its_legs(seed, legs, held):
    """What is narrower than its legs are apart may slide in it."""
    base, spots = part("base", pin(16.0, -110, 110), PIVOT), [(0.0, legs), (0.0, -legs)]
    bend = block((-22, -legs - 3, -3), (-16, legs + 3, 3))
    bolt = part("bolt", bend, *(across(pin(3.0, -16, 46, at)) for at in spots))
    saddle = part("saddle", half_hole(16.0, -10, 10, 1), *(across(ring(3.2, 6.0, 3, 28, at)) for at in spots))
    rail = part("rail", *(across(ring(3.2, 6.0, 28, 34, at)) for at in spots), block((28, -6, -80), (34, 6, 80)))
    nuts = [part(f"nut {k}", across(ring(3.0, 5.0, 34, 39, at)[:-1])) for k, at in enumerate(spots)]
    body, mechanism = of(seed, base, bolt, saddle, rail, *nuts, LEVER)
    assert any("'base' in its bend" in note for note in mechanism.history) == held
    assert not held or body["bolt"] == body["saddle"] == body["rail"] == body["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("hole", ["round", "slot", "none"])
def test_a_pin_across_a_telescope_holds_it(seed, hole):
    """Without it the inner tube slides, and so it does where the pin is at the end of a slot."""
    walls = [block((24, -30, -100), (30, 30, 100)), block((-30, -30, -100), (-24, 30, 100))]
    walls += [block((-24, 24, -100), (24, 30, 100)), block((-24, -30, -100), (24, -24, 100))]
    at = (-50.0, 0.0)
    eyes = [across(ring(6.2, 8.0, low, low + 6, at)) for low in (-30, 24)]
    base = part("base", *walls, *eyes, PIVOT)
    own = {"round": [across(ring(6.2, 8.0, -23.8, 23.8, at))], "slot": [across(half_slot(at))], "none": []}
    inner = part("inner", block((-23.8, -23.8, -60), (23.8, 23.8, 160)), *own[hole])
    end = 24 if hole == "none" else -34
    body, mechanism = of(seed, base, inner, part("pin", across(pin(6.0, end, 30, at), pin(10.0, 30, 34, at))), LEVER)
    assert (body["inner"] == body["base"]) == (hole == "round")
    assert hole != "none" or kind_of(mechanism, "base", "inner") == "prismatic"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("radius", "away", "held"), [(6.2, 0.0, True), (5.9, 0.0, False), (6.2, 3.0, False)])
def test_holes_of_one_size_in_line_across_a_telescope_hold_it_without_their_pin(radius, away, held, seed):
    """It slides where they are not in line, or of two sizes. A pin of the other leg of the frame fills none of them."""
    walls = [block((24, -30, -100), (30, 30, 100)), block((-30, -30, -100), (-24, 30, 100))]
    walls += [block((-24, 24, -100), (24, 30, 100)), block((-24, -30, -100), (24, -24, 100))]
    at = (-50.0, 0.0)
    eyes = [across(ring(6.2, 8.0, low, low + 6, at)) for low in (-30, 24, 250)]
    base = part("base", *walls, *eyes, block((30, 30, -100), (260, 40, 100)), PIVOT)
    own = across(ring(radius, 8.0, -23.8, 23.8, (at[0] + away, 0.0)))
    inner = part("inner", block((-23.8, -23.8, -60), (23.8, 23.8, 160)), own)
    beyond = part("pin", across(pin(6.0, 240, 260, at), pin(10.0, 260, 264, at)))
    body, mechanism = of(seed, base, inner, beyond, LEVER)
    assert (body["inner"] == body["base"]) == held
    assert held or kind_of(mechanism, "base", "inner") == "prismatic"


def half_slot(at):
    """The end of a slot, a half of a hole."""
    (surface, triangles) = ring(6.2, 8.0, -23.8, 23.8, at)[2]
    return [(surface, triangles[np.all(triangles[..., 0] <= at[0] + 1e-6, axis=1)])]
