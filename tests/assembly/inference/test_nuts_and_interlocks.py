"""What nuts, washers and tapers hold on shafts, and what only looks like a screw across a shaft.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.surfaces import Cone, Sphere
from reference.round_parts import SECTIONS, SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
LEVER = part("lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("low", "high", "held"), [(-7.7, 7.7, False), (-35.0, -20.8, True)])
def test_a_pin_between_two_shafts_is_their_interlock_and_no_set_screw(seed, low, high, held):
    """It can be tightened from no side; one outside of both is a set screw of the nearer shaft."""
    rails = [(x, 0.0) for x in (-14.0, 14.0)]
    bores = [ring(7.0, 10.0, z, z + 25, at) for at in rails for z in (-95, 70)]
    hole = across(ring(3.0, 3.1, low, high))
    base = part("base", *bores, hole, block((-60, -60, -140), (80, 80, -135)), PIVOT)
    shafts = [part(f"rail {k}", pin(6.98, -130, 130, at)) for k, at in enumerate(rails)]
    body, mechanism = of(seed, base, *shafts, part("pin", across(pin(2.95, low, high))), LEVER)
    assert any("the screw 'pin' holds" in note for note in mechanism.history) == held
    assert (body["rail 0"] == body["base"]) == held and body["rail 1"] != body["base"]


@pytest.mark.parametrize("seed", range(4))
def test_a_port_through_a_cylinder_and_its_liner_is_no_screw_in_the_piston(seed):
    """Equal holes of two parts across a third one, with nothing in them."""
    group = part("base", ring(28.0, 38.0, -55, 40), across(ring(5.0, 5.1, 28, 80, (5.0, 0.0))))
    liner = part("liner", ring(25.0, 28.0, -55, 40), across(ring(5.0, 5.1, 25, 28, (5.0, 0.0))))
    piston = part("piston", pin(24.95, -20, 0), block((-8, -13, 0), (8, 13, 20)))
    body, mechanism = of(seed, group, liner, piston)
    assert body["liner"] == body["base"] and not any("'liner' to 'piston'" in note for note in mechanism.history)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("second", "held"), [((8, 20, -10.0), True), ((-20, -8, 10.0), False)])
def test_screws_that_point_at_a_part_are_beside_each_other(seed, second, held):
    """A plug and a pin in one drilled hole, on both sides of a part, are no pattern."""
    places = [(8, 20, 10.0), second]
    holes = [across(ring(2.0, 4.0, a, b, (0.0, y))) for a, b, y in places]
    base = part("base", *holes, block((-60, -60, -140), (80, 80, -135)), PIVOT)
    pins = [part(f"pin {k}", across(pin(2.0, a, b, (0.0, y)))) for k, (a, b, y) in enumerate(places)]
    _, mechanism = of(seed, base, *pins, part("slider", block((-6, -15, -8), (6, 15, 8))), LEVER)
    assert any("2 parallel screws of" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
def test_a_nut_on_a_threaded_bush_goes_with_it(seed):
    """It is on the bush, and does not turn in it as a shaft would."""
    base = part("base", ring(9.0, 20.0, 0, 10), block((20, -4, 0), (60, 4, 10)), PIVOT)
    bush = part("bush", ring(5.03, 9.0, -8, 24), ring(9.0, 13.0, -8, 0))
    plunger = part("plunger", pin(5.0, -60, 60), block((4, -2, 50), (25, 2, 60)))
    body, _ = of(seed, base, bush, part("nut", ring(9.0, 12.0, 10, 15)[:-1]), plunger, LEVER)
    assert body["nut"] == body["bush"] == body["base"] != body["plunger"]


def ball(radius, side, centre):
    """The faces of a ball, or of a socket, about the axis z, without what is beyond 0.9 radii."""
    triangles = trimesh.creation.icosphere(4, radius).triangles
    kept = triangles[np.abs(triangles[:, :, 2] / radius).max(axis=1) < 0.9] + [0.0, 0.0, centre]
    return [(Sphere(np.array([0.0, 0.0, centre]), radius, side), kept if side > 0 else kept[:, ::-1])]


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("nut", [True, False])
def test_a_ball_stud_is_screwed_to_the_lever_between_its_collar_and_its_nut(seed, nut):
    base = part("base", ring(5.0, 12.0, 0, 10), block((12, -4, 0), (60, 4, 10)), PIVOT)
    stud = part("stud", pin(5.0, -16, 10), pin(7.0, 10, 12.5), pin(4.0, 12.5, 19), ball(8.0, 1, 25.0))
    rod = part("rod", ball(8.1, -1, 25.0), block((12, -4, 20), (60, 4, 30)))
    held = [part("nut", ring(5.0, 8.0, -6, 0)[:-1])] if nut else []
    body, mechanism = of(seed, base, stud, rod, *held, LEVER)
    assert any("'nut' presses 'base' against a shoulder of 'stud'" in note for note in mechanism.history) == nut
    assert body["rod"] != body["stud"] and (not nut or body["stud"] == body["base"])


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("washer", "held"), [(9.0, True), (4.8, False)])
def test_washers_under_the_screws_in_its_ends_hold_an_axle_to_its_cheeks(seed, washer, held):
    """Those that are narrower than the axle lie on nothing but the axle."""
    cheeks = [ring(5.0, 31.0, *sorted((s * 8, s * 10.5))) for s in (-1, 1)]
    base = part("base", *cheeks, block((31, -4, -10.5), (60, 4, 10.5)), PIVOT)
    holes = [ring(2.5, 2.6, *sorted((s * 2.5, s * 10.5))) for s in (-1, 1)]
    axle = part("axle", pin(6.0, -8, 8), pin(5.0, -10.5, -8), pin(5.0, 8, 10.5), *holes)
    sheave = part("sheave", ring(6.2, 28.0, -7, 7), block((28, -2, -7), (30, 2, 7)))
    small = []
    for k, s in enumerate((-1, 1)):
        small.append(part(f"washer {k}", ring(2.7, washer, *sorted((s * 10.5, s * 11.5)))))
        screw = pin(2.5, *sorted((s * 3, s * 11.5))), pin(4.5, *sorted((s * 11.5, s * 14)))
        small.append(part(f"screw {k}", *screw))
    body, mechanism = of(seed, base, axle, sheave, *small, LEVER)
    assert any("in the end of 'axle' holds 'base'" in note for note in mechanism.history) == held
    assert not held or body["axle"] == body["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("play", [0.0, 0.03])
def test_a_lead_screw_with_its_knob_turns_in_the_nut_of_its_slide(seed, play):
    """Though it has play in its bush: the nut is set into a wide hole of the slide, and is no crank."""
    frame = block((-60, -60, -140), (60, 60, -135))
    base = part("base", ring(5.0, 12.0, 90, 100), frame, pin(8.0, -135, 90, (40.0, 0.0)), PIVOT)
    bush = part("bush", ring(3.0 + play, 5.0, 90, 100))
    screw = part("screw", pin(3.0, -50, 122), pin(6.0, 86.5, 89.5))
    knob = part("knob", ring(3.0, 16.0, 102, 122), across(ring(1.5, 1.6, 3, 16, (-107.0, 0.0))))
    grub = part("grub", across(pin(1.5, 3, 9, (-107.0, 0.0))))
    slide = part("slide", ring(5.0, 12.0, -10, 10), ring(4.0, 5.0, -14, -10), ring(8.0, 14.0, -30, 30, (40.0, 0.0)))
    nut = part("nut", ring(3.0, 5.0, -10, 10))
    body, _ = of(seed, base, bush, screw, knob, grub, slide, nut, LEVER)
    assert body["nut"] == body["slide"] != body["screw"] == body["knob"]


def cone(first, last, low, high, side):
    """A conical face about z whose radius goes from `first` to `last`."""
    angles = np.linspace(0, 2 * np.pi, SECTIONS, endpoint=False)
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(SECTIONS)])
    below, above = first * circle + [0, 0, low], last * circle + [0, 0, high]
    after = [np.roll(points, -1, axis=0) for points in (below, above)]
    triangles = np.concatenate([np.stack([below, after[0], above], 1), np.stack([above, after[0], after[1]], 1)])
    half_angle = float(np.arctan((last - first) / (high - low)))
    apex = np.array([0.0, 0.0, low - first / np.tan(half_angle)])
    return [(Cone(apex, np.array([0.0, 0.0, 1.0]), half_angle, side), triangles if side > 0 else triangles[:, ::-1])]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("rise", "held"), [(1.0, True), (4.0, False)])
def test_a_slender_taper_holds_itself_and_the_plug_of_a_cock_turns(seed, rise, held):
    """Half angles of 1.4 degrees, as of Morse, and of 5.7 degrees."""
    base = part("base", cone(6.0, 6.0 + rise, 0, 40, -1), block((20, -4, 0), (60, 4, 40)), PIVOT)
    centre = part("centre", cone(6.0, 6.0 + rise, 0, 40, 1), block((-2, -20, 44), (2, 20, 54)))
    body, mechanism = of(seed, base, centre, LEVER)
    assert (body["centre"] == body["base"]) == held
    assert held or kind_of(mechanism, "base", "centre") == "revolute"
