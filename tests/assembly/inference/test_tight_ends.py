"""Which end of a pin, a screw or a thread holds, and which one turns: where the one is tight, the other has play.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

from itertools import pairwise

import numpy as np
import pytest

from jaxkin.assembly.inference.hinges import hinges
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.measured import Measured
from jaxkin.assembly.inference.slide_stops import Stop
from jaxkin.geometry.surfaces import Plane
from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

BASE = block((-60, -60, -140), (60, 60, -130))
PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
LEVER = part("pivot lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""
FITTING = part("pivot lever", ring(4.0, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""The same without play: where others have some, what fits exactly is pressed on."""


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


def hexagon(inner, flat, low, high):
    """A hexagonal ring about the axis z; `flat` is the distance from the axis to a flat."""
    corners = [2 * flat / np.sqrt(3) * np.array([np.cos(t), np.sin(t)]) for t in np.arange(7) * np.pi / 3]
    walls = []
    for one, other in pairwise(corners):
        a, b, c, d = (np.array([*p, z]) for p, z in ((one, low), (other, low), (other, high), (one, high)))
        normal = np.array([*((one + other) / np.linalg.norm(one + other)), 0.0])
        walls.append((Plane(a, normal), np.array([[a, b, c], [a, c, d]])))
    return [*ring(inner, flat, low, high)[:-1], *walls]  # without its round outside


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("tip", "held"), [(0.8, True), (0.9, True), (0.7, True), (3.2, False)])
def test_a_set_screw_may_be_wider_than_the_shaft_that_its_end_presses_on(seed, tip, held):
    """Up to a tenth of a millimetre beside the shaft, or into it; not one that ends farther off."""
    base = part("base", BASE, ring(0.8, 12.0, -60, -40), ring(0.8, 12.0, 40, 60))
    shaft = part("shaft", pin(0.8, -70, 70))
    hub = part("hub", ring(0.8, 6.0, -6, 6), across(ring(1.0, 2.0, 0.9, 6)), block((-2, -40, -6), (2, -5, 6)))
    body, mechanism = of(seed, base, shaft, hub, part("screw", across(pin(1.0, tip, 8))))
    assert any("holds 'hub' to 'shaft'" in note for note in mechanism.notes) == held
    assert (body["hub"] == body["shaft"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("elsewhere", [True, False])
def test_a_stem_through_body_and_liner_is_no_screw_where_it_fits_a_third_part(seed, elsewhere):
    """The holes of body and liner are wider; the disc fits the stem, which turns."""
    base = part("base", ring(42.0, 60.0, -20, 20), across(ring(6.3, 14.0, 43, 90), ring(6.3, 14.0, -90, -43)), PIVOT)
    liner = part("liner", ring(40.0, 42.0, -20, 20), across(ring(6.3, 6.4, 40, 42), ring(6.3, 6.4, -42, -40)))
    stem = part("stem", across(pin(6.0, -95, 95)))
    disc = part("disc", across(ring(6.0, 11.0, -37, 37)), block((-20, 10, -3), (20, 35, 3)))
    _, mechanism = of(seed, base, liner, stem, LEVER, *([disc] if elsewhere else []))
    told = any("the screw 'stem' holds" in note for note in mechanism.history)
    assert told != elsewhere


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("play", "screws", "turns"), [(0.08, True, True), (0.0, True, False), (0.08, False, False)])
def test_a_rod_with_play_in_a_blind_hole_amid_screw_holes_is_the_shaft_of_a_motor(seed, play, screws, turns):
    """A post is set into its hole without play, and a foot without screw holes is that of a stand."""
    spots = [(sx * 15.0, sy * 15.0) for sx in (-1, 1) for sy in (-1, 1)]
    holes = [ring(1.25, 3.0, -10, 0, at) for at in spots] if screws else []
    motor = part("base", ring(5.0 + play, 11.0, -30, 0), block((-20, -20, -40), (20, 20, -30)), *holes, PIVOT)
    shaft = part("shaft", pin(5.0, -30, 40))
    arm = part(
        "arm", ring(5.0, 9.0, 20, 34), across(ring(1.5, 3.0, 5, 9, (-27.0, 0.0))), block((-3, 8, 20), (3, 70, 34))
    )
    grub = part("grub", across(pin(1.5, 5, 9, (-27.0, 0.0))))
    body, mechanism = of(seed, motor, shaft, arm, grub, LEVER)
    assert body["arm"] == body["shaft"]
    assert (body["shaft"] != body["base"]) == turns
    assert not turns or kind_of(mechanism, "base", "shaft") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("hole", "clamped"), [(3.3, True), (3.1, False)])
def test_one_bolt_with_its_nut_clamps_two_plates_with_the_clearance_of_a_screw_in_both(seed, hole, clamped):
    base = part("base", ring(hole, 14.0, -3, 0), block((14, -4, -3), (80, 4, 0)), PIVOT)
    track = part("track", ring(hole, 14.0, 0, 2), block((-80, -4, 0), (-14, 4, 2)))
    bolt, nut = part("bolt", pin(3.0, -9, 2), pin(7.0, 2, 4)), part("nut", ring(3.0, 5.5, -8, -3)[:-1])
    body, _ = of(seed, base, track, bolt, nut, LEVER)
    assert (body["track"] == body["base"]) == clamped


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("beside", "held"), [(True, True), (False, False)])
def test_a_lock_screw_holds_an_arm_off_its_rail_where_a_second_screw_stands_beside_it(seed, beside, held):
    base = part(
        "base", block((-60, -60, -30), (80, 80, -20)), ring(2.1, 9.0, -20, 0), ring(3.5, 5.0, -5, 0, (20, 0)), PIVOT
    )
    arm = part("arm", ring(2.6, 6.0, 5, 8), ring(2.5, 5.0, 5, 8, (20.0, 0.0)), block((24, -4, 5), (60, 4, 8)))
    lock = part("lock screw", pin(2.5, -8, 8), pin(4.5, 8, 12))
    adjust = part("adjusting screw", pin(2.5, -5, 8, (20.0, 0.0)))
    body, _ = of(seed, base, arm, lock, LEVER, *([adjust] if beside else []))
    assert (body["arm"] == body["base"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("washer", "locked"), [(4.3, True), (4.0, False)])
def test_a_nut_locks_a_thread_across_a_round_part_beside_a_loose_washer(seed, washer, locked):
    """What is tight on the thread beyond the part is a second nut: the part may be that of a hinge between them."""
    base = part("base", block((-60, -60, -60), (-50, 60, 60)), across(pin(6.0, -50, -40)), PIVOT)
    bolt = part("bolt", across(ring(6.0, 9.0, -50, -40), pin(4.0, -40, 40)))
    trunnion = part("trunnion", pin(5.0, -13, 13), across(ring(4.0, 4.1, -5, 5)))
    nut, disc = part("nut", across(ring(4.0, 6.0, 5, 8)[:-1])), part("washer", across(ring(washer, 9.0, -20, -17)))
    body, _ = of(seed, base, bolt, trunnion, nut, disc, FITTING)
    assert (body["trunnion"] == body["bolt"]) == locked


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("play", "riveted"), [(0.0, True), (1.0, False)])
def test_a_stud_is_riveted_to_what_it_fits_without_play_and_turns_in_the_other_part(seed, play, riveted):
    base = part("base", BASE, ring(3.2, 8.0, 8, 14), block((8, -3, -130), (14, 3, 14)))
    arm = part("arm", ring(2.5, 9.0, 0, 2), block((-60, -3, 0), (-8, 3, 2)))
    stud = part("stud", pin(4.5, -1 - play, -play), pin(2.5, -play, 2), pin(5.5, 2, 7.5), pin(3.0, 7.5, 14))
    _, mechanism = of(seed, base, arm, stud)
    assert any("'stud' is riveted to 'arm'" in note for note in mechanism.history) == riveted


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("bush", "held"), [(4.1, True), (4.0, False)])
def test_a_screw_in_the_end_of_a_shaft_holds_its_crank_where_the_shaft_turns_in_a_bush(seed, bush, held):
    """Where the base fits the shaft as tightly as the crank does, nothing tells which of them turns."""
    base = part("base", BASE, ring(bush, 9.0, -60, 0), block((9, -3, -130), (14, 3, 0)))
    shaft = part("shaft", pin(4.0, -70, 8), ring(1.5, 4.0, 8, 20), pin(6.0, -66, -60.1))
    crank = part("crank", ring(4.0, 9.0, 4, 20), block((-60, -3, 4), (-8, 3, 20)))
    screw = part("screw", pin(1.5, 9, 20), pin(6.0, 20, 23))
    _, mechanism = of(seed, base, shaft, crank, screw)
    assert any("in the end of 'shaft' holds 'crank'" in note for note in mechanism.history) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("wrench", "held"), [(True, True), (False, False)])
def test_a_hollow_thread_with_a_hexagon_down_on_a_face_is_screwed_in(seed, wrench, held):
    """A lever may turn there."""
    base = part("base", ring(3.0, 12.0, -10, 0), block((-60, -60, -30), (60, 60, -20)), PIVOT)
    head = hexagon(1.0, 5.0, 0, 6) if wrench else [*ring(1.0, 5.0, 0, 6), *block((4, -1, 0), (20, 1, 6))]
    body, mechanism = of(seed, base, part("coupler", ring(1.0, 3.0, -10, 0), head), LEVER)
    assert any("the hexagon of 'coupler'" in note for note in mechanism.history) == held
    assert (body["coupler"] == body["base"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("walls", [5.1, 9.0])
def test_a_block_on_a_stud_between_walls_is_a_shoe_that_turns_and_slides(seed, walls):
    """A crank swings a lever by the shoe on its stud. Its collar lies on the edges of the channel of the lever; walls
    far off guide nothing."""
    pins = [piece for at, low in (((100.0, 0.0), 0), ((0.0, -40.0), -2)) for piece in _stepped(at, low)]
    base = part("base", block((-60, -60, -30), (120, 60, -20)), *pins)
    sides = [block((-40, min(s * walls, s * 14), 0), (60, max(s * walls, s * 14), 7)) for s in (-1, 1)]
    lever = part("lever", *sides, block((-40, -14, 7), (95, 14, 9)), ring(4.0, 9.0, 0, 7, (100.0, 0.0)))
    web = block((-3, -31, -2), (3, -12, -0.5))
    crank = part("crank", ring(4.0, 9.0, -2, 0, (0.0, -40.0)), web, pin(12.0, -2, 0), pin(3.0, 0, 6))
    sides = [block((min(s * 4.5, s * 20), -5, 0.3), (max(s * 4.5, s * 20), 5, 6.8)) for s in (-1, 1)]
    shoe = part("shoe", ring(3.2, 4.5, 0.3, 6.8), *sides)
    _, mechanism = of(seed, base, lever, crank, shoe)
    assert any("'shoe' is a shoe in a channel" in note for note in mechanism.history) == (walls < 6)
    if walls < 6:
        assert kind_of(mechanism, "shoe", "lever") == "prismatic"
        assert kind_of(mechanism, "shoe", "crank") == "revolute"
        assert mechanism.mobility().useful == 1


def _stepped(at, low):
    """A post of the base with a thinner end, on which something lies at a height."""
    return pin(9.0, -20, low, at), pin(4.0, low, 12, at)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("length", "stops"), [(30.0, [Stop.ONE_FACE]), (260.0, [])])
def test_a_collar_on_one_side_stops_a_fastener_but_no_stem_that_is_mostly_in_nothing(seed, length, stops):
    """On the other side of a short pin is a ring or a thread that is not drawn."""
    base = part("base", BASE, ring(5.0, 12.0, -24, 24), block((11, -3, -130), (14, 3, 24)))
    stem = part("stem", pin(5.0, -26, length), pin(8.0, -28, -26))
    drawn = anywhere(assembly(base, stem), seed)
    known = Known(Measured(drawn.parts), drawn.contacts(), ["base"], (), ())
    assert [each.stop for each in hinges(known, {"stem"})] == stops
