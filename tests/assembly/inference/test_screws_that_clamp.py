"""What one screw, screws in counterbores, and screws beside a shaft clamp; pins of levers and flanges do not.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from jaxkin.assembly.inference.axes import common_axes
from jaxkin.assembly.inference.bores import bores
from jaxkin.assembly.inference.fasteners import fasteners
from reference.round_parts import SEEDS, across, anywhere, assembly, block, moving, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (60.0, 60.0))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (60.0, 60.0)), block((68, 57, 5), (100, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


def of(drawn, seed):
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


def screwed(name, at=(0.0, 0.0)):
    """An M5 screw whose head lies on a plate 6 mm thick."""
    return part(name, pin(2.5, -10, 6, at), pin(4.5, 6, 11, at))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("hole", "clamped"), [(2.75, True), (2.55, False)])
def test_one_screw_clamps_where_it_goes_through_with_the_clearance_of_a_screw(seed, hole, clamped):
    """A hinge has less."""
    base = part("base", block((-80, -80, -30), (80, 80, -20)), ring(2.5, 9.0, -20, 0), PIVOT)
    bracket = part("bracket", ring(hole, 9.0, 0, 6), block((8, -4, 0), (40, 4, 6)))
    body, mechanism = of(assembly(base, bracket, screwed("screw"), LEVER), seed)
    assert (body["bracket"] == body["base"]) == clamped
    assert any("'screw' is tight in 'base'" in note for note in mechanism.history) == clamped


@pytest.mark.parametrize("seed", SEEDS)
def test_a_bar_on_one_screw_at_each_end_is_a_link(seed):
    base = part("base", block((-80, -80, -30), (80, 80, -20)), ring(2.5, 9.0, -20, 0), PIVOT)
    link = part("link", ring(2.75, 9.0, 0, 6), block((8, -4, 0), (32, 4, 6)), ring(2.75, 9.0, 0, 6, (40.0, 0.0)))
    other = part("other", ring(2.5, 9.0, -15, 0, (40.0, 0.0)), block((48, -4, -15), (70, 4, 0)))
    drawn = assembly(base, link, other, screwed("screw"), screwed("end screw", (40.0, 0.0)), LEVER)
    body, mechanism = of(drawn, seed)
    assert len({body["base"], body["link"], body["other"]}) == 3
    assert sum(joint.kind == "revolute" for joint in moving(mechanism)) == 2


@pytest.mark.parametrize("seed", SEEDS)
def test_screws_in_counterbores_hold_the_post_that_they_are_drawn_into(seed):
    """Two heads with play in their counterbores are no guide rods."""
    spots = [(x, 0.0) for x in (-20.0, 20.0)]
    holes = [piece for at in spots for piece in (ring(4.75, 8, -10, -4.5, at), ring(2.75, 8, -4.5, 0, at))]
    base = part("base", *holes, block((-60, 10, -10), (60, 80, 0)), PIVOT)
    screws = [part(f"screw {k}", pin(2.5, -4.5, 10.5, at), pin(4.36, -9.5, -4.5, at)) for k, at in enumerate(spots)]
    post = part("post", block((-30, -10, 0), (30, 10, 40)))
    body, _ = of(assembly(base, *screws, post, LEVER), seed)
    assert body["post"] == body["base"] == body["screw 0"] == body["screw 1"]


@pytest.mark.parametrize("seed", SEEDS)
def test_screws_as_thin_as_their_root_clamp_what_their_heads_lie_on(seed):
    """M3 by the root of its thread, in holes of 3.4 mm, is mostly outside of the hole that it is tight in."""
    spots = [(x, 0.0) for x in (-20.0, 20.0)]
    base = part("base", *(ring(1.5, 6, -8, 0, at) for at in spots), block((-60, 10, -10), (60, 80, 0)), PIVOT)
    plate = part("plate", *(ring(1.7, 6, 0, 6, at) for at in spots), block((-14, -6, 0), (14, 6, 6)))
    screws = [part(f"screw {k}", pin(1.229, -4, 6, at), pin(2.75, 6, 9, at)) for k, at in enumerate(spots)]
    body, _ = of(assembly(base, plate, *screws, LEVER), seed)
    assert body["plate"] == body["base"] == body["screw 0"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("link", "held"), [(False, True), (True, False)])
def test_a_screw_beside_the_shaft_clamps_a_round_hub(seed, link, held):
    """The pin of a link does not."""
    base = part("base", block((-60, -60, -140), (80, 80, -130)), ring(5.0, 12.0, -60, -40), ring(5.0, 12.0, 40, 60))
    shaft = part("shaft", pin(5.0, -70, 70))
    hub = part("hub", ring(5.0, 12.0, -10, 10), across(ring(1.25, 1.3, -8, 8, (0.0, 7.0))))
    screw = part("screw", across(pin(1.25, -8, 22 if link else 8, (0.0, 7.0))))
    bar = part("bar", across(ring(1.3, 4.0, 14, 20, (0.0, 7.0))), block((14, 11, -3), (20, 50, 3)))
    body, _ = of(assembly(base, shaft, hub, screw, *([bar] if link else [])), seed)
    assert (body["hub"] == body["shaft"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("lever", "held"), [(False, True), (True, False)])
def test_a_slit_clamps_with_its_screw_but_not_with_a_quick_release(seed, lever, held):
    """The pin of a quick release is in its lever, too."""
    base = part("base", block((-60, -60, -140), (80, 80, -130)), ring(5.0, 12.0, -60, -40), ring(5.0, 12.0, 40, 60))
    shaft = part("shaft", pin(5.0, -70, 70))
    ears = [across(ring(1.5, 3.0, low, low + 7, (0.0, 14.0))) for low in (-8, 1)]
    hub = part("hub", ring(5.0, 12.0, -10, 10), *ears)
    screw = part("screw", across(pin(1.5, -8, 15 if lever else 8, (0.0, 14.0))))
    cam = part("cam", across(ring(1.6, 4.0, 9, 13, (0.0, 14.0))), block((9, 18, -3), (13, 60, 3)))
    body, _ = of(assembly(base, shaft, hub, screw, *([cam] if lever else [])), seed)
    assert (body["hub"] == body["shaft"]) == held


@pytest.mark.parametrize("is_one", [True, False])
def test_a_hole_across_a_pin_is_that_of_a_cotter_and_one_beside_it_that_of_a_flange(is_one):
    hole = across(ring(1.5, 1.6, -4.7, 4.7)) if is_one else ring(1.5, 1.6, -4, 0, (10.0, 0.0))
    headed = part("headed", pin(5.0, 0, 30), pin(14.0, -4, 0), hole)
    plate = part("plate", ring(5.1, 20.0, 5, 15))
    every = {each.name: bores(each) for each in (headed, plate)}
    found = common_axes([bore for own in every.values() for bore in own])
    on_axes = [bore for pair in found for bore in (pair.one, pair.other)]
    assert ("headed" in fasteners((headed, plate), on_axes, every)) == is_one


@pytest.mark.parametrize("seed", SEEDS)
def test_screws_in_the_cores_of_bars_on_end_clamp_what_lies_on_these(seed):
    """Three bars with a hole from end to end under one plate, each with a screw: no link between them, as it is on
    eyes. The bars stand over wider holes of the base, whose screws are not drawn."""
    spots = [(0.0, 0.0), (50.0, 0.0), (0.0, 40.0)]
    plate = part("plate", *(ring(2.75, 9, 0, 6, at) for at in spots), block((9, -4, 0), (41, 4, 6)))
    bars = [part(f"bar {k}", ring(2.5, 8, -60, 0, at)) for k, at in enumerate(spots)]
    screws = [screwed(f"screw {k}", at) for k, at in enumerate(spots)]
    holes = [ring(2.75, 9, -69, -60, at) for at in spots]
    base = part("base", *holes, block((50, 50, -90), (70, 70, -80)), pin(4.0, -80, 0, (60.0, 60.0)))
    lever = part("lever", ring(4.1, 9.0, -70, -60, (60.0, 60.0)), block((68, 57, -70), (100, 63, -60)))
    body, _ = of(assembly(base, plate, *bars, *screws, lever), seed)
    assert len({body[name] for name in ("base", "plate", "bar 0", "bar 1", "bar 2")}) == 1
