"""Countersunk screws, screws in holes drilled for wood, bars under the tip of a screw, large washers, tyres, and slides
on a lead screw.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from jaxkin.assembly.inference.axes import common_axes
from jaxkin.assembly.inference.bores import bores
from jaxkin.assembly.inference.fasteners import fasteners
from reference.round_parts import SEEDS, anywhere, assembly, block, cone, moving, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (60.0, 60.0))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (60.0, 60.0)), block((68, 57, 5), (100, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("core", [2.1, 1.8])
def test_countersunk_screws_hold_what_their_heads_fit(seed, core):
    """The cone of the head fits its countersink exactly; M5 in a hole for its thread, and a screw in one for wood."""
    spots = [(x, 0.0) for x in (-20.0, 20.0)]
    base = part("base", *(ring(core, 9, -20, 0, at) for at in spots), block((-60, 10, -20), (80, 80, 0)), PIVOT)
    sinks = [piece for at in spots for piece in (ring(2.75, 9, 0, 3.75, at), cone(2.75, 5.0, 3.75, 6.0, -1, at))]
    plate = part("plate", *sinks, block((-11, -8, 0), (11, 8, 6)))
    screws = [part(f"screw {k}", pin(2.5, -12, 3.5, at), cone(2.5, 5.0, 3.5, 6.0, 1, at)) for k, at in enumerate(spots)]
    body = owners(anywhere(assembly(base, plate, *screws, LEVER), seed).mechanism(fixed=["base"]))
    assert body["plate"] == body["base"] == body["screw 0"] == body["screw 1"]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_needle_of_a_valve_is_no_screw_with_a_head(seed):
    """Its cone fits the seat exactly, too, but is its point."""
    base = part("base", ring(4.1, 12, 0, 30), cone(1.0, 3.0, -8, -4, -1), block((12, -60, 0), (80, 80, 30)), PIVOT)
    needle = part("needle", pin(4.0, -2, 45), cone(0.5, 3.0, -9, -4, 1), block((5, -2, 40), (30, 2, 44)))
    body = owners(anywhere(assembly(base, needle, LEVER), seed).mechanism(fixed=["base"]))
    assert body["needle"] != body["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("behind", [0.2, 12.0])
def test_the_tip_of_a_screw_clamps_a_bar_that_has_a_wall_behind_it(seed, behind):
    """A bar with play in a square hole; where there is room behind it the screw moves it."""
    walls = [block((5.1, -15, -30), (12, 15, 12)), block((-12, -15, -30), (-5.1, 15, 12))]
    floor = block((-12, -15, -30), (12, 15, -5 - behind))
    base = part("base", *walls, floor, ring(2.1, 5.0, 5.1, 12), block((12, -80, -30), (80, 80, 0)), PIVOT)
    bar = part("bar", block((-5, -60, -5), (5, 60, 5)))
    screw = part("screw", pin(2.5, 5, 14), pin(4.5, 14, 18))
    body = owners(anywhere(assembly(base, bar, screw, LEVER), seed).mechanism(fixed=["base"]))
    assert body["screw"] == body["base"]
    assert (body["bar"] == body["base"]) == (behind < 1.0)


@pytest.mark.parametrize(("thick", "is_one"), [(1.6, True), (6.0, False)])
def test_a_thin_ring_of_four_radii_is_a_large_washer(thick, is_one):
    parts = [part("screw", pin(2.0, -10, thick), pin(3.5, thick, thick + 4)), part("ring", ring(2.2, 8.0, 0, thick))]
    every = {each.name: bores(each) for each in parts}
    pairs = common_axes([bore for own in every.values() for bore in own])
    found = fasteners(parts, [bore for pair in pairs for bore in (pair.one, pair.other)], every)
    assert "screw" in found and ("ring" in found) == is_one


@pytest.mark.parametrize("seed", SEEDS)
def test_a_cutting_wheel_between_shoulders_is_no_washer(seed):
    """It is as thin, but has play on both sides, and turns."""
    base = part("base", ring(2.5, 12.0, -10, 0), block((12, -60, -10), (80, 80, 0)), PIVOT)
    screw = part("screw", pin(2.5, -10, 0), pin(3.0, 0, 2.2), pin(5.0, 2.2, 5))
    wheel = part("wheel", ring(3.1, 11.0, 0.1, 2.1))
    body = owners(anywhere(assembly(base, screw, wheel, LEVER), seed).mechanism(fixed=["base"]))
    assert body["screw"] == body["base"] != body["wheel"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wheel_goes_round_with_the_axle_that_it_fits(seed):
    """The axle turns in its blocks: a second joint about that axis would be of no use."""
    base = part("base", ring(4.1, 9.0, -30, -20), ring(4.1, 9.0, 20, 30), block((-40, -40, -30), (80, -9, 0)), PIVOT)
    axle = part("axle", pin(4.0, -48, 48), pin(6.0, -19.5, 19.5))
    wheels = [part(f"wheel {side}", ring(4.0, 15.0, *sorted((side * 34.0, side * 44.0)))) for side in (-1, 1)]
    body = owners(anywhere(assembly(base, axle, *wheels, LEVER), seed).mechanism(fixed=["base"]))
    assert body["wheel -1"] == body["wheel 1"] == body["axle"] != body["base"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_slide_on_its_lead_screw_is_no_body_with_it(seed):
    """It fits the thread exactly, on which the bearing has play; but faces of the base guide it along the screw."""
    walls = [block((-10, side * 8.1, -40), (0, side * 12, 40)) for side in (1.0,)]
    walls += [block((-10, -12, -40), (0, -8.1, 40))]
    base = part("base", block((-30, -20, -60), (-10, 20, 60)), *walls, ring(4.2, 9.0, 41, 50), PIVOT)
    screw = part("screw", pin(4.0, -35, 75), pin(7.0, 38, 40.8), pin(7.0, 50.2, 53))
    knob = part("knob", ring(4.0, 12.0, 60, 70), block((12, -2, 62), (20, 2, 68)))
    slide = part("slide", ring(4.0, 7.0, -6, 6), block((-10, -8, -6), (-6.5, 8, 6)))
    mechanism = anywhere(assembly(base, screw, knob, slide, LEVER), seed).mechanism(
        fixed=["base"], rigid=[["screw", "knob"]]
    )
    body = owners(mechanism)
    assert body["slide"] not in (body["screw"], body["base"])
    kinds = {frozenset(body[part] for part in joint.parts): joint.kind for joint in moving(mechanism)}
    assert kinds[frozenset((body["slide"], body["base"]))] == "prismatic"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("thick", [1.5, 6.0])
def test_a_screw_is_held_by_the_plate_in_which_it_has_play_and_not_by_its_washer(seed, thick):
    """The washer fits more tightly, and lies a little above the plate; a ring as thick as a spacer is pressed on."""
    base = part("base", ring(4.25, 20.0, -6, 0), block((20, -80, -30), (80, 80, 0)), PIVOT)
    washer = part("washer", ring(4.0, 12.0, 0.05, 0.05 + thick))
    screw = part("screw", pin(3.99, -20, 0.1 + thick), pin(6.5, 0.1 + thick, 8 + thick))
    nut = part("nut", ring(3.99, 6.5, -13, -6.05))
    body = owners(anywhere(assembly(base, washer, screw, nut, LEVER), seed).mechanism(fixed=["base"]))
    assert (body["screw"] == body["base"]) == (thick < 2)
