"""What looks clamped or hinged and is not: what pushes pins, the bracket of a friction hinge, a jaw on a round rail.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest

from jaxkin.geometry.surfaces import Plane
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring

LEVER = part("lever", pin(2.0, 30, 60, (100.0, 60.0)), block((98, 40, 60), (102, 62, 70)))


def of(seed, *parts):
    mechanism = anywhere(assembly(*parts), seed).mechanism(fixed=["base"])
    return owners(mechanism), mechanism


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("holes", [False, True])
def test_a_plate_that_lies_on_the_heads_of_two_pins_is_not_bolted_by_them(seed, holes):
    """Two axes in common are those of holes in both bodies: with holes for the pins the plate is."""
    at = [(-20.0, 0.0), (20.0, 0.0)]
    base = part("base", block((-40, -10, -12), (40, 10, -2)), *(ring(3.0, 8.0, -2, 10, each) for each in at))
    pins = [part(f"pin {k}", pin(3.0, 0, 20, each), pin(5.0, 20, 24, each)) for k, each in enumerate(at)]
    plate = [ring(3.1, 12.0, 10, 20, each) for each in at] if holes else [block((-30, -8, 24), (30, 8, 30))]
    cover = part("cover", *plate, *([block((-8, -4, 10), (8, 4, 20))] if holes else []))
    _, mechanism = of(seed, base, *pins, cover)
    assert any("2 parallel common axes of" in note for note in mechanism.history) == holes


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("keyed", [True, False])
def test_a_bracket_under_a_nut_turns_beside_a_washer_that_a_flat_of_the_shaft_keeps(seed, keyed):
    """As that of a friction hinge, whose washer does not turn with what it brakes; a crank is pressed on."""
    base = part("base", ring(8.1, 16.0, -50, -30), block((-60, -60, -80), (60, 60, -70)))
    flat = [block((0, -2, 0), (3.2, 2, 34))] if keyed else []
    shaft = part("shaft", pin(8.0, -60, 0), pin(4.0, 0, 34), *flat)
    bracket = part("bracket", ring(4.1, 14.0, 0, 6), block((13, -4, 0), (70, 4, 6)))
    tooth = [block((3.2, -2, 6), (6, 2, 8))] if keyed else []
    washer = part("washer", ring(4.0 if keyed else 4.1, 9.0, 6, 8), *tooth)
    nut = part("nut", ring(4.0, 8.0, 8, 14)[:-1])  # without its outside, which is not round
    body, mechanism = of(seed, base, shaft, bracket, washer, nut)
    assert body["nut"] == body["shaft"] and (body["bracket"] == body["shaft"]) != keyed
    assert not keyed or kind_of(mechanism, "shaft", "bracket") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("play", [0.0, 0.1])
@pytest.mark.parametrize(("slot", "kind"), [(2.6, "prismatic"), (8.0, "cylindrical")])
def test_a_jaw_on_a_round_rail_slides_where_its_neck_is_in_a_slot(seed, play, slot, kind):
    walls = [block((8, slot, 10), (30, slot + 6, 90)), block((8, -slot - 6, 10), (30, -slot, 90))]
    base = part("base", ring(5.0, 12.0, -60, 0), *walls, block((8, -slot - 6, 90), (30, slot + 6, 100)))
    jaw = part("jaw", pin(5.0 - play, -50, 50), block((4, -2.5, 20), (40, 2.5, 50)))
    _, mechanism = of(seed, base, jaw)
    assert kind_of(mechanism, "base", "jaw") == kind


def square(half, low, high, hole=False):
    """The sides of a square about z, which look inwards where it is a hole."""
    sides = []
    for normal in ((1.0, 0, 0), (-1.0, 0, 0), (0, 1.0, 0), (0, -1.0, 0)):
        x, y, _ = half * np.array(normal)
        along = (abs(y) > 0) * half, (abs(x) > 0) * half
        corners = np.array([(x - s * along[0], y - s * along[1], z) for s, z in ((1, low), (-1, low), (-1, high))])
        other = np.array([(x - s * along[0], y - s * along[1], z) for s, z in ((1, low), (-1, high), (1, high))])
        sides.append((Plane(corners[0], np.array(normal) * (-1 if hole else 1)), np.array([corners, other])))
    return sides


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("nut", [True, False])
def test_a_crank_on_a_square_with_play_goes_with_its_shaft_where_a_nut_keeps_it(seed, nut):
    """Without the nut it slides off."""
    base = part("base", ring(8.0, 16.0, -40, -2), block((-60, -60, -60), (60, 60, -50)))
    shaft = part("shaft", pin(8.0, -44, 0), square(3.5, 0, 8), pin(2.5, 8, 18))
    crank = part("crank", square(3.6, 0, 8, hole=True), *crank_about(3.6, 12, 0, 8))
    washer = part("washer", ring(2.7, 6.0, 8, 9))
    held = [part("nut", ring(2.5, 5.0, 9, 14)[:-1])] if nut else []  # without its outside, which is not round
    _, mechanism = of(seed, base, shaft, crank, washer, *held)
    assert any("flat sides of 'shaft' keep 'crank' from turning" in note for note in mechanism.history) == nut


def crank_about(inner, outer, low, high):
    """The faces across the axis of a square hub, and a lever on it."""
    plates = [
        (Plane(np.array([0.0, 0.0, z]), np.array([0.0, 0.0, s])), frame_of(inner, outer, z))
        for z, s in ((low, -1.0), (high, 1.0))
    ]
    return plates, block((outer - 1, -4, low), (60, 4, high))


def frame_of(inner, outer, z):
    """Triangles of a square of half an edge `outer` with a square hole."""
    ends = [np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half for half in (inner, outer)]
    flat = [
        triangle
        for k in range(4)
        for triangle in (
            (ends[0][k], ends[1][k], ends[1][(k + 1) % 4]),
            (ends[0][k], ends[1][(k + 1) % 4], ends[0][(k + 1) % 4]),
        )
    ]
    return np.array([[(*corner, z) for corner in triangle] for triangle in flat])


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("wide", [True, False])
def test_a_wheel_with_journals_on_both_sides_turns_in_its_housing(seed, wide):
    """A pin of the same holes, no wider between them, is held."""
    base = part("base", ring(4.0, 14.0, -16, -8), ring(3.0, 14.0, 8, 16), block((14, -4, -16), (20, 4, 16)))
    middle = [pin(6.0, -7, 7)] if wide else []
    drive = part("drive", pin(3.9, -16, -7 if wide else 0), *middle, pin(2.9, 7 if wide else 0, 16))
    body, _ = of(seed, base, drive, LEVER)
    assert (body["drive"] == body["base"]) != wide


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pressed", [True, False])
def test_a_ring_set_into_a_hub_and_clamped_on_its_axle_is_a_bearing(seed, pressed):
    """One that is in no hub is a spacer, and goes with the axle."""
    axle = part("base", pin(8.0, -40, 0), pin(4.0, 0, 24), block((-60, -60, -60), (60, 60, -50)), pin(5.0, -50, -40))
    ring_ = part("ring", ring(4.0, 10.0, 0, 8))
    hub = part("hub", ring(10.0 if pressed else 12.0, 18.0, 0, 8), block((17, -4, 0), (60, 4, 8)))
    sleeve = [] if pressed else [part("sleeve", ring(8.0, 12.0, -20, -10), ring(12.0, 18.1, -30, -20))]
    nut = part("nut", ring(4.0, 8.0, 8, 14)[:-1])  # without its outside, which is not round
    body, _ = of(seed, axle, ring_, hub, *sleeve, nut, LEVER)
    assert not pressed or body["ring"] == body["hub"] != body["base"]
    assert pressed or body["ring"] == body["base"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("thick", "kind"), [(0.5, None), (6.0, "revolute")])
def test_a_thin_disc_with_much_play_in_a_counterbore_guides_nothing(seed, thick, kind):
    base = part("base", ring(4.0, 14.0, -2, 6), block((14, -4, -20), (20, 4, 6)))
    disc = part("disc", pin(3.5, 6 - thick - 0.1, 5.9), pin(6.0, 5.9, 9), block((-3, -30, 9), (3, 30, 12)))
    _, mechanism = of(seed, base, disc, LEVER)
    joints = [joint for joint in mechanism.all_joints if {*joint.parts} == {"base", "disc"} and joint.freedoms]
    assert (str(joints[0].kind) if joints else None) == kind


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("lift", [20.0, 0.0])
def test_what_slides_on_guide_pins_is_not_bolted_to_what_they_are_in(seed, lift):
    """As a brake caliper; down on the base, its screws would clamp it there."""
    at = [(-30.0, 0.0), (30.0, 0.0)]
    base = part("base", *(ring(5.1, 10.0, 0, 40, each) for each in at), block((-20, -8, 0), (20, 8, 40)))
    eyes = [ring(3.2, 10.0, 40 + lift, 46 + lift, each) for each in at]
    caliper = part("caliper", *eyes, block((-20, -8, 40 + lift), (20, 8, 46 + lift)))
    pins = [part(f"pin {k}", pin(5.0, 5, 30, each), ring(3.0, 5.0, 30, 40 + lift, each)) for k, each in enumerate(at)]
    screws = [
        part(f"screw {k}", pin(3.0, 30, 46 + lift, each), pin(5.0, 46 + lift, 50 + lift, each))
        for k, each in enumerate(at)
    ]
    body, mechanism = of(seed, base, caliper, *pins, *screws, LEVER)
    assert (body["caliper"] == body["base"]) == (lift == 0)
    if lift:
        assert kind_of(mechanism, "base", "caliper") == "prismatic"
        assert body["pin 0"] == body["pin 1"] == body["caliper"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("play", [0.2, 8.0])
def test_a_plate_on_the_floor_of_a_dovetail_slides_along_it(seed, play):
    """Flanks that are far away do not guide it."""
    floor = block((-30, -60, -10), (30, 60, 0))
    base = part("base", floor, flank(12 + play, 1), flank(12 + play, -1))
    _, mechanism = of(
        seed,
        base,
        part("plate", block((-6, -20, 0), (6, 20, 9)), flank(12, 1, out=False), flank(12, -1, out=False)),
        LEVER,
    )
    assert kind_of(mechanism, "base", "plate") == ("prismatic" if play < 1 else "planar")
    told = [each.evidence.text for each in mechanism.all_joints if each.evidence]
    assert any("flanks of a dovetail" in text for text in told) == (play < 1)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_dovetail_with_play_guides_what_has_other_faces_beside_its_tail(seed):
    """A jaw on the floor of the dovetail, which stands beside it on both sides farther out than its flanks."""
    base = part(
        "base", block((-30, -60, -10), (30, 60, 0)), flank(12.2, 1), flank(12.2, -1), block((30, 8, -10), (36, 60, 0))
    )
    tail = [block((-3, -20, 0.1), (3, 20, 9)), flank(12, 1, out=False, low=0.1), flank(12, -1, out=False, low=0.1)]
    jaw = part("jaw", *tail, block((36.2, -20, -10), (44, 20, 20)), block((-44, -20, 14), (44, 20, 20)))
    _, mechanism = of(seed, base, jaw, LEVER)
    assert kind_of(mechanism, "base", "jaw") == "prismatic"


def flank(half, side, out=True, low=0.0):
    """A flank of a dovetail along y, inclined by 45 degrees, `half` from the middle at the floor."""
    length, top = (60, 8) if out else (20, 8)
    corners = np.array(
        [
            (side * half, -length, low),
            (side * half, length, low),
            (side * (half - top), length, low + top),
            (side * (half - top), -length, low + top),
        ]
    )
    normal = np.array([side, 0.0, 1.0]) / np.sqrt(2) * (-1 if out else 1)
    return [(Plane(corners[0], normal), corners[np.array([[0, 1, 2], [0, 2, 3]])])]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("hole", [2.9, 3.02])
def test_screws_that_cut_their_threads_into_two_plates_hold_both(seed, hole):
    """Most of each screw is bare between the plates; where its holes are wider, one plate may slide on it."""
    at = [(-30.0, -10.0), (30.0, -10.0), (-30.0, 10.0), (30.0, 10.0)]
    base = part("base", *(ring(hole, 8.0, 0, 6, each) for each in at), block((-24, -12, 0), (24, 12, 6)))
    plate = part("plate", *(ring(hole, 8.0, 40, 46, each) for each in at), block((-24, -12, 40), (24, 12, 46)))
    screws = [part(f"screw {k}", pin(3.0, -4, 46, each), pin(5.5, 46, 50, each)) for k, each in enumerate(at)]
    body, _ = of(seed, base, plate, *screws, LEVER)
    assert (body["plate"] == body["base"]) == (hole < 3.0)
