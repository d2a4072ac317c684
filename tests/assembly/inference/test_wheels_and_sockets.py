"""What gantries and rod ends of public libraries have: bearings on bolts, spacers, wheels on rails, loose balls, knobs.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from jaxkin.geometry.part import moved
from jaxkin.geometry.surfaces import Sphere
from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import SEEDS, across, anywhere, assembly, block, moving, owners, part, pin, ring


def of(drawn, seed, fixed="base"):
    mechanism = anywhere(drawn, seed).mechanism(fixed=[fixed])
    return owners(mechanism), mechanism


def wheel(name, at, low, *, radius=12.0, outside=8.0):
    """A hub with a bearing of two rings flush with it or not, on a loose bolt through a washer and the base."""
    middle = low + 2.5
    return [
        part(f"{name} hub", ring(outside, radius, low, low + 5, at)),
        part(f"{name} outer", ring(6.6, outside, low, low + 5, at)),
        part(f"{name} inner", ring(2.5, 4.2, low, low + 5, at)),
        part(f"{name} bolt", pin(2.1, middle - 20, middle + 5, at), pin(4.5, middle + 5, middle + 9, at)),
    ]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("gap", "clamped"), [(0.0, True), (0.4, False)])
def test_what_lies_on_the_inner_ring_of_a_bearing_is_clamped_to_it(seed, gap, clamped):
    """The bolt is loose in the base; a washer that lies on both holds the ring there, one that is away from it not."""
    base = part("base", ring(2.6, 30.0, -6, 0))
    washer = part("washer", ring(2.6, 5.0, 0, 1 - gap))
    body, mechanism = of(assembly(base, washer, *wheel("wheel", (0.0, 0.0), 1.0)), seed)
    told = [note for note in mechanism.notes if "clamped to the ring 'wheel inner'" in note]
    assert len(told) == clamped
    assert (body["wheel bolt"] == body["base"]) or not clamped
    assert body["wheel hub"] == body["wheel outer"] != body["wheel bolt"]


@pytest.mark.parametrize("seed", SEEDS)
def test_what_lies_on_both_rings_of_a_bearing_is_clamped_to_neither(seed):
    base = part("base", ring(2.6, 30.0, -6, 1))  # it reaches both rings, and the hub
    _, mechanism = of(assembly(base, *wheel("wheel", (0.0, 0.0), 1.0)), seed)
    assert not any("clamped to the ring" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_shaft_off_the_axis_of_its_bearings_turns_about_its_own(seed):
    """Both rings are 0.35 to one side of a shaft that is 0.1 thinner; what is on the shaft agrees with the shaft."""
    at = (0.35, 0.0)
    base = part("base", ring(8.0, 20.0, 0, 5, at), block((-20, 19, 0), (20, 30, 60)), ring(8.0, 20.0, 50, 55, at))
    rings = [
        part(f"{name} {k}", ring(*radii, low, low + 5, at))
        for k, low in enumerate((0, 50))
        for name, radii in (("outer", (6.6, 8.0)), ("inner", (4.0, 5.0)))
    ]
    shaft = part("shaft", pin(3.9, -20, 70), block((-3, -40, 60), (3, 0, 66)))
    body, mechanism = of(assembly(base, *rings, shaft), seed)
    (joint,) = moving(mechanism)
    assert joint.kind == "revolute" and joint.evidence.kind is EvidenceKind.BEARING
    assert body["shaft"] == body["inner 0"] == body["inner 1"]
    solid = next(each for each in mechanism.solids if each.name == "shaft")
    (cylinder,) = (face.surface for face in solid.faces if face.surface.kind == "cylinder")
    pose = np.asarray(joint.frames_1)[0]
    away = pose[:3, 3] - cylinder.point
    assert np.linalg.norm(away - (away @ cylinder.axis) * cylinder.axis) < 1e-9 * cylinder.radius


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("count", "held"), [(2, True), (1, False)])
def test_two_spacers_without_their_screws_hold_two_plates_together(seed, count, held):
    """The holes of the upper plate are tapped, and narrower than those of the spacers."""
    places = [(-20.0, 0.0), (20.0, 0.0)][:count]
    base = part("base", *(ring(2.6, 8.0, -6, 0, at) for at in places), block((-12, -8, -6), (12, 8, 0)))
    plate = part("plate", *(ring(2.1, 8.0, 40, 44, at) for at in places), block((-12, -8, 40), (12, 8, 44)))
    tubes = [part(f"spacer {k}", ring(2.6, 5.0, 0, 40, at)) for k, at in enumerate(places)]
    lever = part("lever", ring(3.1, 6.0, 0, 5, (60.0, 0.0)), block((65, -2, 0), (90, 2, 5)))
    post = part("post", pin(3.0, -6, 8, (60.0, 0.0)), block((50, -8, -12), (70, 8, -6)))
    body, mechanism = of(assembly(base, plate, *tubes, lever, post), seed)
    assert any("2 parallel common axes" in note for note in mechanism.notes) == held
    assert (body["plate"] == body["base"]) or not held


def carriage(gap, both, *, on_base=(), on_plate=(), others=()):
    """A plate with four wheels between the cheeks of a rail along y, or beside one of them."""
    radius = 12.0
    wide = 40.0 + radius + gap
    cheeks = [block((wide, -200, -3), (wide + 10, 200, 9))]
    cheeks += [block((-wide - 10, -200, -3), (-wide, 200, 9))] if both else []
    base = part("base", *cheeks, block((-wide - 10, -200, -40), (wide + 10, 200, -30)), *on_base)
    places = [(x, y) for x in (-40.0, 40.0) for y in (-30.0, 30.0)]
    holes = [ring(2.6, 8.0, -8, 0, at) for at in places]
    plate = part("plate", *holes, block((-31, -38, -8), (31, 38, 0)), *on_plate)
    parts = [base, plate, *others]
    for k, at in enumerate(places):
        parts += [part(f"washer {k}", ring(2.6, 5.0, 0, 1, at)), *wheel(f"wheel {k}", at, 1.0, radius=radius)]
    return assembly(*parts)


@pytest.mark.parametrize(("seed", "gap"), [(0, 0.1), (1, -0.02)])
def test_wheels_between_two_rails_leave_a_carriage_one_slide(seed, gap):
    _, mechanism = of(carriage(gap, both=True), seed)
    (slide,) = (joint for joint in moving(mechanism) if joint.kind == "prismatic")
    assert {*slide.parts} == {"base", "plate"} and "4 wheels" in slide.evidence.text
    rail = next(each for each in mechanism.solids if each.name == "base")
    axis = np.asarray(slide.frames_1)[0][:3, 2]
    lengths = [np.ptp(rail.triangles.reshape(-1, 3) @ face.surface.normal) for face in rail.faces]
    assert np.ptp(rail.triangles.reshape(-1, 3) @ axis) == pytest.approx(max(lengths), rel=1e-6)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_carriage_on_wheels_slides_along_a_screw_that_it_fits_exactly(seed):
    """The screw turns in its bearing; a wheel on it would turn with it, but the nut of a carriage does not."""
    place = np.array([[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, -19.0], [0.0, 0.0, 0.0, 1.0]])

    def along_y(*pieces):
        return [(face.surface, face.triangles) for face in moved(part("", across(*pieces)), place).faces]

    screw = part("screw", along_y(pin(4.0, -215, 190), pin(7.0, -199.8, -197), pin(7.0, -213, -210.2)))
    drawn = carriage(
        0.1,
        both=True,
        on_base=[along_y(ring(4.2, 9.0, -210, -200))],
        on_plate=[along_y(ring(4.0, 9.0, -8, 8)), block((-4, -8, -10.5), (4, 8, -8))],
        others=[screw],
    )
    body, mechanism = of(drawn, seed)
    assert len({body[each] for each in ("base", "plate", "screw")}) == 3
    slides = [joint for joint in moving(mechanism) if joint.kind == "prismatic"]
    assert [{body[each] for each in joint.parts} for joint in slides] == [{body["base"], body["plate"]}]


def test_wheels_beside_one_rail_guide_nothing():
    _, mechanism = of(carriage(0.1, both=False), 0)
    assert not [joint for joint in moving(mechanism) if joint.kind == "prismatic"]


def sphere(radius, side, low, high):
    """The zone of a sphere between two heights, over its radius."""
    triangles = trimesh.creation.icosphere(4, radius).triangles
    heights = triangles[:, :, 2] / radius
    kept = triangles[(heights.min(axis=1) > low) & (heights.max(axis=1) < high)]
    return [(Sphere(np.zeros(3), radius, side), kept if side > 0 else kept[:, ::-1])]


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("ball", "low", "joined"), [(7.8, -0.9, True), (8.1, -0.9, True), (6.5, -0.9, False), (7.8, 0.7, False)]
)
def test_a_ball_turns_in_its_socket_with_clearance_or_interference(seed, ball, low, joined):
    """A ball that is much too small is none of this socket, and what is round like a corner is no ball."""
    base = part("base", sphere(8.0, -1, -0.7, 0.7), ring(8.5, 14.0, -5.6, 5.6))
    stud = part("stud", sphere(ball, 1, low, 0.99), block((-2, -2, 9), (2, 2, 40)))
    _, mechanism = of(assembly(base, stud), seed)
    joints = moving(mechanism)
    assert [joint.kind for joint in joints] == (["spherical"] if joined else [])
    if joined:
        assert joints[0].evidence.kind is EvidenceKind.CLEARANCE
        sizes = dict(joints[0].evidence.sizes)
        assert sizes["clearance"] == pytest.approx(sizes["radius"] * (8.0 - ball) / 8.0, rel=1e-6)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("reach", "kind"), [(25.0, "prismatic"), (3.0, "revolute")])
def test_a_knob_at_the_end_of_its_slot_is_no_hinge_where_walls_keep_it_from_turning(seed, reach, kind):
    """The slide is between the walls of its channel over its whole length, or only beside the knob."""
    base = part(
        "base",
        block((-40, -20, -10), (40, 20, -6)),
        block((-40, 10.2, -6), (40, 20, 6)),
        block((-40, -20, -6), (40, -10.2, 6)),
        ring(4.0, 10.0, 6, 8),
    )
    slide = part("slide", block((-reach, -10, -5.8), (reach, 10, 5.8)), pin(3.6, 5.8, 12))
    _, mechanism = of(assembly(base, slide), seed)
    (joint,) = moving(mechanism)
    assert joint.kind == kind


def test_a_thread_of_its_own_goes_with_the_screw_that_it_is_drawn_into():
    base = part("base", ring(4.0, 20.0, 0, 10))
    screw = replace(part("screw", pin(2.0, -20, 40), block((-4, -4, 40), (4, 4, 44))), path=("bolt",))
    rib = block((1.5, -0.6, 20), (2.6, 0.6, 30))
    thread = replace(part("thread", rib), path=("bolt",))
    lever = part("lever", ring(4.0, 9.0, 10, 15), block((8, -3, 10), (60, 3, 15)))
    body, mechanism = of(assembly(base, screw, thread, lever), 0)
    assert body["thread"] == body["screw"]
    assert any("of 'thread' is drawn into 'screw'" in note for note in mechanism.notes)


def test_the_slit_of_a_clamp_takes_more_play_than_a_set_screw():
    """A hub with a slit is drawn together on a shaft that is 4 % thinner than its hole."""
    to_x = np.array([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 25], [0, 0, 0, 1]])
    ears = part("ears", *(ring(1.5, 3.5, low, high, (0.0, 7.5)) for low, high in ((-6.0, -1.0), (1.0, 6.0))))
    slit = [(face.surface, face.triangles) for face in moved(ears, to_x).faces]
    base = part("base", ring(5.0, 12.0, -60, -40), block((-20, 11, -60), (20, 30, -40)))
    shaft = part("shaft", pin(4.8, -40, 70), pin(5.0, -70, -40))
    hub = part("hub", ring(5.0, 10.0, 20, 30), slit, block((-3, -60, 20), (3, -9, 30)))
    body, mechanism = of(assembly(base, shaft, hub), 0)
    assert any("a screw across its slit" in note for note in mechanism.notes)
    assert body["hub"] == body["shaft"]


def test_proposals_lead_with_the_slide_and_tell_what_only_turns_wheels():
    best = carriage(0.1, both=True).proposals()[0]
    assert best.fixed in (("base",), ("plate",))
    assert len(best.wheels) == 4 and best.freedoms == 5
    assert best.drive[0].endswith(".z") and best.drive[1:] == best.wheels
    assert "5 freedoms in 6 bodies, 4 of which only turn wheels or rollers" in str(best)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("nut", "clamped"), [(True, True), (False, False)])
def test_a_screw_with_its_nut_clamps_what_its_head_lies_on_where_a_bush_on_it_turns(seed, nut, clamped):
    """The eccentric has a hole of its own in the base, beside the screw; the roller turns with its two bushes."""
    off = (1.0, 0.0)
    base = part("base", ring(4.0, 30.0, -6, 0, off))
    eccentric = part("eccentric", pin(4.0, -5, 0, off)[2:], ring(2.5, 6.0, 0, 4))
    bushes = [part(f"bush {k}", ring(2.5, 5.0, low, low + 4)) for k, low in enumerate((4, 8))]
    roller = part("roller", ring(5.0, 12.0, 4, 12))
    screw = part("screw", pin(2.5, -6, 20), pin(7.0, -9, -6))
    parts = [base, eccentric, *bushes, roller, screw, *([part("nut", ring(2.5, 4.6, 12, 16))] if nut else [])]
    body, mechanism = of(assembly(*parts), seed)
    told = any("on which its head lies" in note for note in mechanism.notes)
    assert told == clamped and (body["screw"] == body["base"]) >= clamped


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("end", "set_in"), [(6.0, True), (30.0, False)])
def test_a_rod_that_ends_in_a_wide_hole_is_set_in_and_one_that_goes_through_slides(seed, end, set_in):
    base = part("base", ring(6.0, 20.0, 0, 14), block((19, -5, 0), (60, 5, 14)))
    rod = part("rod", pin(4.0, -120, end))
    lever = part("lever", ring(3.1, 6.0, 14, 19, (50.0, 0.0)), block((55, -2, 14), (90, 2, 19)))
    post = part("post", pin(3.0, 2, 25, (50.0, 0.0)))
    body, _ = of(assembly(base, rod, lever, post), seed)
    assert (body["rod"] == body["base"]) == set_in


@pytest.mark.parametrize("seed", SEEDS)
def test_bearing_blocks_that_only_lie_on_their_base_stay_there(seed):
    """No screw is drawn, and the shaft turns all the same."""
    base = block((-60, -60, -10), (160, 160, 0))
    blocks = [part(f"block {k}", to_y(ring(5.0, 12.0, low, low + 10), 12.0)) for k, low in enumerate((0.0, 80.0))]
    shaft = part("shaft", to_y(pin(5.0, -20, 130), 12.0), block((-3, 120, 12), (3, 126, 60)))
    drawn = assembly(part("base", base), *blocks, shaft)
    body, mechanism = of(drawn, seed)
    assert body["block 0"] == body["block 1"] == body["base"] != body["shaft"]
    assert sum("nothing else needs it to move there" in note for note in mechanism.notes) == 2
    assert [joint.kind for joint in moving(mechanism)] in (["cylindrical"], ["revolute"])


def to_y(piece, height):
    """A piece about an axis along y, above a foot that lies on the plane z = 0."""
    to_y = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, height], [0, 0, 0, 1]])
    turned = [(face.surface, face.triangles) for face in moved(part("turned", piece), to_y).faces]
    heights = np.concatenate([triangles.reshape(-1, 3) for _, triangles in turned])[:, 1]
    low, high = float(heights.min()), float(heights.max())
    return turned + (block((-12, low, 0), (12, high, 2)) if len(piece) == 4 else [])
