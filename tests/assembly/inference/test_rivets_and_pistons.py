"""Rivets that are loose in all they hold, pistons and their rings, slits, what sits on turning shafts, undercut rails.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, moving, owners, part, pin, ring

BASE = block((-60, -60, -140), (60, 60, -130))


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("heads", [True, False])
def test_a_rivet_that_is_loose_in_all_plates_belongs_to_one_of_them_where_heads_keep_it(seed, heads):
    """Most of the rivet is outside of its holes, as that of a rod on which plates slide."""
    base = part("base", BASE, ring(3.2, 8.0, -30, -26), block((8, -3, -130), (14, 3, -26)))
    plate = part("plate", ring(3.2, 8.0, 26, 30), block((7, -3, 26), (40, 3, 30)))
    ends = [pin(5.0, -33, -30), pin(5.0, 30, 33)] if heads else []
    body, mechanism = of(seed, base, plate, part("rivet", pin(3.0, -30, 30), *ends))
    assert (body["rivet"] in (body["base"], body["plate"])) == heads
    assert body["plate"] != body["base"] and mechanism.mobility().useful


@pytest.mark.parametrize("seed", SEEDS)
def test_a_cup_with_a_pin_across_it_that_carries_a_rod_is_a_piston_and_no_bush(seed):
    cylinder = part("base", ring(20.0, 26.0, -50, 60))
    wrist = across(ring(4.0, 8.0, -19, -8, (0.0, 0.0)), ring(4.0, 8.0, 8, 19, (0.0, 0.0)))
    piston = part("piston", ring(17.0, 19.9, -15, 14), pin(19.9, 14, 16), wrist)
    rod = part("rod", across(ring(4.2, 8.0, -6, 6)), block((-5, -5, -120), (5, 5, -7)))
    body, mechanism = of(seed, cylinder, piston, part("pin", across(pin(4.0, -19, 19))), rod)
    assert body["piston"] != body["base"] and body["rod"] != body["piston"] and mechanism.mobility().useful


@pytest.mark.parametrize("seed", SEEDS)
def test_a_piston_ring_has_play_in_its_groove_and_none_in_the_cylinder(seed):
    cylinder = part("base", ring(20.0, 26.0, -50, 60), block((-40, -40, -60), (40, 40, -50)))
    piston = part("piston", pin(19.9, -10, 0), pin(17.0, 0, 2), pin(19.9, 2, 10))
    body, mechanism = of(seed, cylinder, piston, part("seal", ring(17.3, 20.0, 0, 2)))
    (joint,) = moving(mechanism)
    assert body["seal"] == body["piston"] and joint.kind == "cylindrical"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("gland", [True, False])
def test_a_ring_behind_the_gland_on_a_thinner_end_of_the_rod_is_its_piston(seed, gland):
    cylinder = part("base", ring(20.0, 26.0, -50, 60), block((-40, -40, -60), (40, 40, -50)))
    rod = part("rod", pin(5.0, -10, 0), pin(9.0, 0, 100), block((-4, 10, 90), (4, 40, 99)))
    parts = [cylinder, rod, part("ring", ring(5.0, 20.0, -10, 0))]
    body, _ = of(seed, *parts, *([part("gland", ring(9.0, 20.0, 45, 60))] if gland else []))
    assert (body["ring"] == body["rod"]) == gland
    assert not gland or body["gland"] == body["base"] != body["rod"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("slit", "held"), [(1.0, True), (12.0, False)])
def test_a_screw_across_a_slit_holds_a_lever_on_its_shaft(seed, slit, held):
    base = part("base", BASE, ring(5.0, 12.0, -60, -40), ring(5.0, 12.0, 40, 60))
    shaft = part("shaft", pin(5.0, -70, 70))
    ears = [across(ring(1.5, 3.0, *sorted((side * slit / 2, side * (slit / 2 + 6))), (0.0, 9.0))) for side in (-1, 1)]
    lever = part("lever", ring(5.0, 7.0, -10, 10), *ears, block((-4, -60, -10), (4, -8, 10)))
    body, _ = of(seed, base, shaft, lever)
    assert (body["lever"] == body["shaft"]) == held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("guided", [False, True])
def test_what_fits_a_shaft_in_bearings_turns_with_it_unless_others_guide_it(seed, guided):
    """A crank on the end of the shaft; and a nut, which is also on a rod beside it."""
    housing = ring(11.0, 16.0, -20, -8)
    guide = [pin(3.0, -130, 60, (40.0, 0.0))] if guided else []
    base = part("base", BASE, housing, block((16, -3, -130), (24, 3, -8)), *guide)
    rings = [part("inner", ring(4.0, 6.0, -20, -10)), part("outer", ring(9.0, 11.0, -20, -10))]
    shaft = part("shaft", pin(4.0, -30, 60))
    arm = [ring(3.0, 6.0, 20, 40, (40.0, 0.0))] if guided else []
    crank = part("crank", ring(4.0, 9.0, 20, 40), block((9, -3, 20), (34, 3, 40)), *arm)
    body, _ = of(seed, base, shaft, *rings, crank)
    assert (body["crank"] == body["shaft"]) != guided and body["shaft"] != body["base"]
