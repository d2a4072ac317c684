"""Shafts, screws and rings: which of the parts on one axis turn, which slide, and which are one body.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest

from jaxkin.geometry.part import moved
from reference.round_parts import SEEDS, anywhere, assembly, block, moving, owners, part, pin, ring

BASE = block((-60, -60, -100), (60, -50, 100))
"""A side of a base, which touches nothing else."""


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("length", "kind"), [(6.0, "revolute"), (30.0, "cylindrical")])
def test_a_plate_that_is_shorter_than_its_hole_is_wide_turns_on_a_rod(seed, length, kind):
    """Nothing stops either of them on the rod between two lugs; a hub of three diameters slides as well."""
    lugs = [ring(5.0, 12.0, -90, -80), ring(5.0, 12.0, 80, 90)]
    base, rod = part("base", block((-60, -60, -90), (60, -50, 90)), *lugs), part("rod", pin(5.0, -92, 92))
    lever = part("lever", ring(5.0, 12.0, 20, 20 + length), block((11, -3, 20), (40, 3, 20 + length)))
    mechanism = anywhere(assembly(base, rod, lever), seed).mechanism(fixed=["base"])
    (joint,) = moving(mechanism)
    assert joint.kind == kind
    assert any("would jam" in note for note in mechanism.notes) == (kind == "revolute")
    assert ("Doubtful: 1 of 1 joints" in str(mechanism)) == (kind == "revolute")


@pytest.mark.parametrize(
    ("play", "kind", "other"),
    [(1.0, "revolute", None), (9.0, "revolute", "cylindrical"), (20.0, "cylindrical", "revolute")],
)
def test_a_play_near_the_limit_of_none_is_doubtful_and_both_readings_are_told(play, kind, other):
    """A pin with clearance in a long hub between two lugs: up to 15.8 mm, three radii of its hole, count as none."""
    base = part("base", BASE, ring(5.0, 12.0, -50, -40), ring(5.0, 12.0, 40, 55))
    rod = part("rod", pin(5.0, -52, 55))
    hub = part("hub", ring(5.25, 12.0, -40 + 0.3 * play, 40 - 0.7 * play), block((11, -3, -5), (40, 3, 5)))
    (joint,) = moving(assembly(base, rod, hub).mechanism(fixed=["base"]))
    doubt = joint.evidence and joint.evidence.doubt
    assert (joint.kind, doubt and doubt.kind) == (kind, other)
    assert doubt is None or f"a play of {play:.2g}" in doubt.why


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.0, 0.05])
@pytest.mark.parametrize("keyed", [True, False])
def test_a_key_holds_a_hub_on_its_shaft(seed, play, keyed):
    base = part("base", block((-60, -60, -30), (60, -50, 30)), ring(5.5, 12.0, -60, -20))
    slot = [block((3.5, low, 0), (5.5, low + 0.2, 30)) for low in (-2.2, 2.0)]
    shaft = part("shaft", pin(5.5, -60, -20), pin(6.0, -20, 40), pin(9.0, -62, -60), *slot)
    walls = [block((6.5, low, 5), (8.0, low + 1.0, 25)) for low in (-3.0, 2.0)]
    hub = part("hub", ring(6.0, 30.0, 5, 25), *walls)
    key = part("key", block((4.0, -2.0 + play, 5), (8.0, 2.0 - play, 25)))
    drawn = assembly(base, shaft, hub, key) if keyed else assembly(base, shaft, hub)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["shaft"] != body["base"]
    assert (body["hub"] == body["shaft"]) == keyed
    assert any("the key 'key'" in note for note in mechanism.notes) == keyed


@pytest.mark.parametrize("seed", range(3))
def test_a_shaft_in_bushes_of_one_body_turns_in_them(seed):
    """A flag shows that it turns: round parts alone count as what only spins."""
    base = part("base", BASE, ring(8.0, 14.0, -60, -40), ring(8.0, 14.0, 40, 60))
    bushes = [part(f"bush {z}", ring(5.0, 8.0, z, z + 20)) for z in (-60, 40)]
    flag = block((4, -2, 64), (18, 2, 70))
    shaft = part("shaft", pin(5.0, -70, 70), pin(9.0, -64, -60), pin(9.0, 60, 64), flag)
    mechanism = anywhere(assembly(base, *bushes, shaft), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["bush -60"] == body["bush 40"] == body["base"] != body["shaft"]
    assert [joint.kind for joint in moving(mechanism)] == ["revolute"]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("collar", [True, False])
def test_a_screw_that_turns_in_a_slide_goes_with_the_slide_and_not_with_its_nut(seed, collar):
    """It fits more tightly in the base, as a guide rod does; a collar between faces of the slide tells them apart."""
    base = part("base", BASE, ring(5.0, 14.0, 80, 100))
    slide = part("slide", ring(5.2, 14.0, -20, -12), ring(5.2, 14.0, -6, 20), block((-6, -50, -20), (6, -14, 20)))
    screw = part("screw", pin(5.0, -60, 120), *([pin(9.0, -12, -6)] if collar else []))
    mechanism = anywhere(assembly(base, slide, screw), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert (body["screw"] == body["base"]) == (not collar)
    if collar:
        assert sorted(str(joint.kind) for joint in moving(mechanism) if "screw" in joint.name) == [
            "cylindrical",
            "revolute",
        ]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("floor", [True, False])
def test_a_post_on_the_floor_of_its_hole_is_set_into_it(seed, floor):
    foot = [block((-40, -40, -110), (40, 40, -100))] if floor else []
    base = part("base", block((-60, -60, -140), (60, 60, -130)), ring(8.0, 14.0, -100, -70), *foot)
    post = part("post", pin(8.0, -100, 100))
    arm = part("arm", ring(8.1, 14.0, 0, 60), block((13, -5, 0), (60, 5, 60)))
    mechanism = anywhere(assembly(base, post, arm), seed).mechanism(fixed=["base"])
    assert any("stands on the floor" in note for note in mechanism.notes) == floor
    if floor:
        assert owners(mechanism)["post"] == owners(mechanism)["base"] != owners(mechanism)["arm"]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("bore", "held"), [(4.7, True), (5.0, False), (5.1, False)])
def test_a_round_part_that_is_tight_on_a_rod_is_held_by_it(seed, bore, held):
    """A nut of 4.7 mm on a thread of 5 mm, too large for a fastener by its form; wider ones turn, or hang there."""
    base = part("base", BASE, ring(5.2, 12.0, -60, -30))
    rod = part("rod", pin(5.0, -80, 60), block((-20, -3, -90), (20, 3, -80)))
    knob = part("knob", ring(bore, 22.0, 40, 55))
    mechanism = anywhere(assembly(base, rod, knob), seed).mechanism(fixed=["base"])
    assert any("is tight on" in note for note in mechanism.notes) == held
    assert (owners(mechanism)["knob"] == owners(mechanism)["rod"]) == held


@pytest.mark.parametrize("seed", range(3))
def test_a_hub_turns_on_a_hollow_axle_that_is_no_bush(seed):
    base = part("base", BASE, ring(5.0, 14.0, -60, -50), ring(5.0, 14.0, 50, 60))
    axle = part("axle", ring(2.5, 5.0, -62, 62))
    hub = part("hub", ring(5.0, 20.0, -30, 30), block((18, -5, -30), (40, 5, 30)))
    mechanism = anywhere(assembly(base, axle, hub), seed).mechanism(fixed=["base"])
    assert owners(mechanism)["hub"] not in (owners(mechanism)["axle"], owners(mechanism)["base"])


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("gap", "kind"), [(2.0, "revolute"), (30.0, "cylindrical")])
def test_what_is_between_two_bearings_stops_a_slide_whatever_its_faces(seed, gap, kind):
    """A round body across the axis, with stubs in two arms: no plane face of it looks at them."""
    far = 20 + gap
    yoke = part("yoke", BASE, ring(4.1, 10.0, -far - 8, -far), ring(4.1, 10.0, far, far + 8))
    side = [block((-3 * k, -3 * k, -20 + k), (3 * k, 3 * k, 20 - k)) for k in (1, 2, 3)]
    stubs = [pin(4.0, -far - 9, -10), pin(4.0, 10, far + 9)]
    rounded = [tuple_of for piece in side for tuple_of in piece if abs(tuple_of[0].normal[2]) < 0.5]
    ring_ = part("ring", *stubs, rounded, block((20, -5, -5), (60, 5, 5)))
    mechanism = anywhere(assembly(yoke, ring_), seed).mechanism(fixed=["yoke"])
    assert [joint.kind for joint in moving(mechanism)] == [kind]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("coupled", [True, False])
def test_a_rod_on_the_floor_of_its_hole_is_the_shaft_of_a_motor_where_it_has_a_hub(seed, coupled):
    """Without one it is a post; with a hub that touches the shaft beyond its end it is what drives that shaft."""
    motor = part(
        "motor", ring(5.0, 20.0, 0, 20), block((-20, -20, -10), (20, 20, 0)), block((-20, 20, -10), (20, 30, 90))
    )
    rod = part("rod", pin(5.0, 0, 40))
    screw = ring(1.5, 1.6, 5, 9, (0.0, 0.0))
    across = np.array([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 35], [0, 0, 0, 1]])
    hole = [(face.surface, face.triangles) for face in moved(part("hole", screw), across).faces]
    hub = part("hub", ring(5.0, 9.0, 30, 40), hole)
    bearing = part("bearing", ring(5.0, 12.0, 60, 70), block((-12, 11, 60), (12, 20, 70)))
    shaft = part("shaft", pin(9.0, 40, 50), pin(5.0, 50, 90), block((-3, -40, 80), (3, 0, 86)))
    drawn = assembly(motor, rod, *([hub, bearing, shaft] if coupled else []), LEVER, POST)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["motor"], rigid=[["motor", "bearing"]] if coupled else [])
    body = owners(mechanism)
    assert (body["rod"] != body["motor"]) == coupled == (body.get("hub") == body["rod"])


LEVER = part("lever", ring(3.1, 6.0, -20, -14, (60.0, 0.0)), block((65, -2, -20), (90, 2, -14)))
POST = part(
    "post", pin(3.0, -30, -10, (60.0, 0.0)), block((0, -8, -36), (70, 8, -30)), block((0, -8, -36), (8, 8, -10))
)
