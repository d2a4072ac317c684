"""What machines are put together from: bushes, screws that are drawn and that are not, rods, slides, bolts with play.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

from dataclasses import replace

import numpy as np
import pytest

from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import anywhere, assembly, block, kind_of, moving, owners, part, pin, ring

LUGS = [block((-60, -60, -40), (60, 60, -30)), ring(5.0, 12.0, -16, -8), ring(5.0, 12.0, 8, 16)]
"""A base with two lugs about z."""
PIVOT = pin(4.0, 0, 60, (100.0, 60.0))
OTHER = part("other lever", ring(4.1, 9.0, 5, 15, (100.0, 60.0)), block((108, 57, 5), (140, 63, 15)))
"""Something that moves on the pivot of the base: where nothing can, inferences are left out until something does."""


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("inner", "outer", "host"), [(5.0, 7.0, "lever"), (5.2, 7.0, "lever"), (5.0, 6.9, "pin")])
def test_a_bush_sits_where_it_fits_more_tightly_and_else_in_its_hole(seed, inner, outer, host):
    base, bolt = part("base", *LUGS), part("pin", pin(5.0, -18, 18))
    lever = part("lever", ring(7.0, 14.0, -6, 6), block((13, -3, -4), (40, 3, 4)))
    mechanism = anywhere(assembly(base, bolt, lever, part("bush", ring(inner, outer, -6, 6))), seed).mechanism(
        fixed=["base"]
    )
    body = owners(mechanism)
    assert body["bush"] == body[host] and body["lever"] != body["base"]
    assert mechanism.mobility().useful == 1


@pytest.mark.parametrize("seed", range(3))
def test_a_ring_in_a_groove_goes_with_the_piston_not_with_the_bore(seed):
    cylinder = part("cylinder", ring(20.0, 26.0, -50, 60), block((-40, -40, -60), (40, 40, -50)))
    piston = part("piston", pin(19.9, -10, 0), pin(17.0, 0, 2), pin(19.9, 2, 10))
    drawn = assembly(cylinder, piston, part("seal", ring(17.0, 20.0, 0, 2)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["cylinder"])
    (joint,) = moving(mechanism)
    assert owners(mechanism)["seal"] == owners(mechanism)["piston"] and joint.kind == "cylindrical"


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("play", "turns"), [(0.1, True), (0.2, False)])
def test_screws_in_holes_drilled_for_their_threads_hold(seed, play, turns):
    """M6 in a hole of 5 mm: the screw belongs to the base. The lever turns on it with the play of a hinge; with that of
    a screw (6.4 mm, the fine series of ISO 273) the head clamps it, with a note of how to have the hinge."""
    base = part("base", block((-60, -60, -40), (60, 60, -30)), ring(2.5, 8.0, -30, -10), PIVOT)
    screw = part("screw", pin(3.0, -28, 4), pin(5.0, 4, 8))
    lever = part("lever", ring(3.0 + play, 8.0, -10, 4), block((7, -3, -4), (40, 3, 4)))
    mechanism = anywhere(assembly(base, screw, lever, OTHER), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["screw"] == body["base"] and (body["lever"] != body["base"]) == turns
    assert not turns or kind_of(mechanism, "base", "lever") == "revolute"
    assert turns or any("give joints=[jk.revolute('lever-base'" in note for note in mechanism.history)
    assert any("screwed into a hole" in note for note in mechanism.history)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("tapped", [3.3, None])
def test_screws_that_are_not_drawn_hold_what_lies_flat(seed, tapped):
    """Two holes of 4.5 mm over two tapped ones of 3.3 mm, and over a face without any."""
    places = [(-20.0, 0.0), (20.0, 0.0)]
    under = [ring(tapped, 8.0, -10, 0, at) for at in places] if tapped else []
    base = part("base", block((-60, -60, -20), (60, 60, -10 if tapped else 0)), *under)
    cover = part("cover", *(ring(4.5, 8.0, 0, 4, at) for at in places), block((-12, -5, 0), (12, 5, 4)))
    mechanism = anywhere(assembly(base, cover, part("far", ring(2.0, 3.0, 300, 310))), seed).mechanism(fixed=["base"])
    assert owners(mechanism)["cover"] == owners(mechanism)["base"]
    if tapped:
        assert any("2 parallel common axes" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", range(3))
def test_bolts_with_nuts_and_washers_are_pivots(seed):
    """Two plates on a bolt with play, a washer between them: nothing but that bolt is on the axis, so they turn."""
    base = part("base", block((-60, -60, -40), (60, 60, -30)), ring(5.3, 12.0, -30, -4))
    lever = part("lever", ring(5.3, 12.0, -2, 4), block((11, -3, -2), (40, 3, 4)))
    bolt = part("bolt", pin(5.0, -29, 9), pin(8.0, 9, 13))
    washers = [part("washer", ring(5.4, 9.0, -4, -2)), part("nut", ring(5.0, 8.5, 4, 9))]
    mechanism = anywhere(assembly(base, lever, bolt, *washers), seed).mechanism(fixed=["base"])
    assert owners(mechanism)["lever"] != owners(mechanism)["base"] and mechanism.mobility().useful == 1


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.0, 0.1])
def test_a_carriage_on_two_rods_slides(seed, play):
    ends = [ring(4.0, 10.0, z, z + 10, (x, 0)) for z in (0, 150) for x in (-30, 30)]
    frame = part("frame", *ends, block((-50, 20, 0), (50, 30, 160)))
    rods = [part(f"rod {x}", pin(4.0, 0, 160, (x, 0))) for x in (-30, 30)]
    bearings = [part(f"bearing {x}", ring(4.0 + play, 7.5, 62, 88, (x, 0))) for x in (-30, 30)]
    holders = [ring(7.5, 12.0, 60, 90, (x, 0)) for x in (-30, 30)]
    carriage = part("carriage", *holders, block((-20, -5, 60), (20, 5, 90)))
    mechanism = anywhere(assembly(frame, *rods, *bearings, carriage), seed).mechanism(fixed=["frame"])
    (joint,) = moving(mechanism)
    assert joint.kind == "prismatic"
    assert {*mechanism.bodies[owners(mechanism)["carriage"]]} == {"carriage", "bearing -30", "bearing 30"}


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("play", "kind"), [(0.1, "prismatic"), (0.5, "prismatic"), (3.0, None)])
def test_a_drawer_with_play_slides(seed, play, kind):
    walls = [((-15, -15, 0), (15, -12, 150)), ((-15, 12, 0), (15, 15, 150))]
    walls += [((-15, -12, 0), (-12, 12, 150)), ((12, -12, 0), (15, 12, 150))]
    half = 12 - play
    drawer = part("drawer", block((-half, -half, 50), (half, half, 200)))
    drawn = assembly(part("tube", *(block(*wall) for wall in walls)), drawer)
    found = moving(anywhere(drawn, seed).mechanism(fixed=["tube"]))
    assert [joint.kind for joint in found] == ([kind] if kind else [])
    if kind:
        assert found[0].evidence.kind == EvidenceKind.CLEARANCE


@pytest.mark.parametrize("seed", range(3))
def test_the_axis_is_that_of_both_parts_not_that_of_a_bolt_beside_it(seed):
    """The bores of fork and eye are one axis to the last digit, and the bolt through them is drawn 0.2 mm beside it."""
    fork = part("fork", *LUGS)
    eye = part("eye", ring(4.9, 12.0, -8, 8), block((11, -3, -4), (40, 3, 4)))
    drawn = assembly(fork, eye, part("bolt", pin(5.0, -20, 20, (0.2, 0.0)), pin(8.0, 20, 25, (0.2, 0.0))))
    (joint,) = moving(drawn.mechanism(fixed=["fork"]))
    np.testing.assert_allclose(joint.frames_1[0, :2, 3], 0.0, atol=1e-9)
    np.testing.assert_allclose(joint.frames_1[0, :3, 2], [0, 0, 1], atol=1e-9)


def test_a_pin_that_ends_where_a_hole_begins_is_not_in_it():
    """A sheet with many equal holes: a lever lies on it, turns about one of them, and its other pin is over another."""
    holes = [(0.0, 0.0), (40.0, 0.0), (0.0, 40.0)]
    sheet = part("sheet", block((-60, -60, -6), (60, 60, -4)), *(ring(2.0, 4.0, -4, 0, at) for at in holes))
    lever = part("lever", *(ring(2.0, 5.0, 0, 3, at) for at in holes[:2]), block((5, -3, 0), (35, 3, 3)))
    pivot = part("pivot", pin(2.0, -4, 3), pin(3.5, 3, 5))
    link = part("link", ring(2.0, 5.0, 3, 6, holes[1]), block((38, 5, 3), (42, 40, 6)))
    tie = part("tie", pin(2.0, 0, 6, holes[1]), pin(3.5, 6, 8, holes[1]))
    mechanism = assembly(sheet, lever, pivot, link, tie).mechanism(fixed=["sheet"])
    assert len({owners(mechanism)[name] for name in ("sheet", "lever", "link")}) == 3
    assert {str(joint.kind) for joint in moving(mechanism)} == {"revolute"}


def test_subassemblies_hold_what_only_lies_on_others():
    """A label on the arm that lies on a shelf, too: it goes with the part of its own sub-assembly."""
    frame = part("frame", block((-60, -60, -20), (60, 60, 0)), pin(5.0, 0, 12))
    arm = part("arm", ring(5.1, 12.0, 1, 9), block((11, -5, 1), (50, 5, 9)))
    label = part("label", block((20, -5, 9), (58, 5, 10)))
    shelf = part("shelf", block((52, -5, 0), (58, 5, 9)))
    paths = {"arm": ("top", "lever"), "label": ("top", "lever")}
    parts = (replace(each, path=paths.get(each.name, ("top",))) for each in (frame, arm, label, shelf))
    mechanism = assembly(*parts).mechanism(fixed=["frame"])
    body = owners(mechanism)
    assert body["label"] == body["arm"] != body["frame"]
    assert any("in its sub-assembly" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("half", "floor", "held"), [(3.0, True, True), (2.5, True, False), (3.0, False, False)])
def test_a_screw_in_the_slot_of_a_profile_holds_what_lies_on_it(seed, half, floor, held):
    """With 2.5 mm the slot is that of a pin that slides in it; a slot without a floor is one to slide in, too.

    The plate lies on a side of the profile as well, as an angle does.
    """
    walls = [block((-60, half, -7), (60, 10, 0)), block((-60, -10, -7), (60, -half, 0))]
    walls += [block((-60, -10, -20), (60, 10, -7))] if floor else []
    rail = part("rail", *walls, pin(5.0, -7, 30, (50, 0)))
    plate = part("plate", ring(2.6, 6.0, 0, 4), block((-20, -9, 0), (-5, 9, 4)), block((-20, 10, -9), (-5, 12, 4)))
    screw = part("screw", pin(2.5, -6, 4), pin(4.0, 4, 7))
    lever = part("lever", ring(5.1, 12.0, 10, 18, (50, 0)), block((61, -3, 10), (90, 3, 18)))
    mechanism = anywhere(assembly(rail, plate, screw, lever), seed).mechanism(fixed=["rail"])
    assert owners(mechanism)["lever"] != owners(mechanism)["rail"]
    assert any("ends in a slot" in note for note in mechanism.notes) == held


def test_plates_that_bolts_with_nuts_hold_are_a_structure():
    """No bolt is let go so that it can turn alone in its holes."""
    places = [(-20.0, 0.0), (20.0, 0.0)]
    plates = [part(name, *(ring(5.0, 12.0, low, low + 8, at) for at in places)) for low, name in ((0, "a"), (8, "b"))]
    bolts = [part(f"bolt{k}", pin(5.0, -6, 16, at), pin(8.0, 16, 22, at)) for k, at in enumerate(places)]
    nuts = [part(f"nut{k}", ring(5.0, 9.0, -6, 0, at)) for k, at in enumerate(places)]
    drawn = assembly(*plates, *bolts, *nuts)
    assert len(drawn.contacts()) > 10
    for fixed in ("a", "b"):
        mechanism = drawn.mechanism(fixed=[fixed])
        assert len(mechanism.bodies) == 1
        assert "It cannot move: all its parts are one body." in str(mechanism)
