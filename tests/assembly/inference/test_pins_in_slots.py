"""Pins with play in straight slots: what exact contacts say without play is inferred with it.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring

SLOT = "pin in slot"


def frame_of_slot(width, length=80.0, low=0.0, high=5.0):
    """Four blocks round a slot along x."""
    sides = [block((-60, y, low), (60, y + 20, high)) for y in (-width / 2 - 20, width / 2)]
    ends = [block((x, -width / 2, low), (x + 60 - length / 2, width / 2, high)) for x in (-60, length / 2)]
    return [*sides, *ends]


def arm_in_slot(play, low=5.0, at=((10.0, 0.0),), radius=4.0):
    """An arm with rivets in a slot, on the plate that has the slot or above it."""
    plate = part("plate", *frame_of_slot(2 * (radius + play)))
    arm = part("arm", *(ring(radius, 10, low, low + 5, where) for where in at), block((0, 10, low), (20, 60, low + 5)))
    rivets = [
        part(f"rivet {k}", pin(radius, 0, low + 5, where), pin(7, low + 5, low + 7, where), pin(7, -2, 0, where))
        for k, where in enumerate(at)
    ]
    return assembly(plate, arm, *rivets)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("play", [0.005, 0.05, 0.2, 1.0])
def test_a_rivet_with_play_in_a_slot_slides_and_turns(play, seed):
    drawn = anywhere(arm_in_slot(play), seed)
    mechanism = drawn.mechanism(fixed=["plate"])
    (joint,) = moving(mechanism)
    assert (joint.kind, mechanism.mobility().freedoms) == (SLOT, 2)
    assert joint.evidence is not None and joint.evidence.kind is EvidenceKind.CLEARANCE
    sizes = dict(joint.evidence.sizes)
    assert sizes["clearance"] / sizes["radius"] == pytest.approx(play / 4.0, rel=1e-6)
    assert any(f"inferred from clearance: {SLOT} joint" in note for note in mechanism.notes)
    assert not any("nearly (b)" in note for note in mechanism.notes)
    assert SLOT not in [each.kind for each in drawn.mechanism(fixed=["plate"], infer=False).all_joints]
    assert SLOT not in [each.kind for each in drawn.mechanism(fixed=["plate"], clearance=play * 1e-3).all_joints]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pin_that_is_much_thinner_than_a_gap_is_in_no_slot(seed):
    mechanism = anywhere(arm_in_slot(3.0), seed).mechanism(fixed=["plate"])
    assert SLOT not in [each.kind for each in mechanism.all_joints]


@pytest.mark.parametrize("seed", SEEDS)
def test_two_pins_in_one_slot_do_not_turn(seed):
    drawn = arm_in_slot(0.1, at=((-15.0, 0.0), (10.0, 0.0)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["plate"])
    assert kind_of(mechanism, "plate", "arm") == "prismatic"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pin_in_a_square_hole_does_not_slide(seed):
    plate = part("plate", *frame_of_slot(8.2, 8.2))
    arm = part("arm", ring(4, 10, 5, 10), block((0, 10, 5), (20, 60, 10)))
    rivet = part("rivet", pin(4, 0, 10), pin(7, 10, 12), pin(7, -2, 0))
    mechanism = anywhere(assembly(plate, arm, rivet), seed).mechanism(fixed=["plate"])
    assert SLOT not in [each.kind for each in mechanism.all_joints]


def yoke(gap, collar=None, radius=4.0):
    """A crank with a pin in the slot of a yoke `gap` above it, whose rods slide in the base; perhaps with a collar.

    The slot is 8.2 wide."""
    base = part(
        "base",
        ring(5.0, 12, -20, -10),
        block((-80, -60, -20), (80, -12, -10)),
        *(across(ring(4.0, 12, x, x + 10, (-10.0, 0.0))) for x in (-70, 60)),
        *(block((x, -60, -10), (x + 10, -12, 10)) for x in (-70, 60)),
    )
    ends = [] if collar is None else [pin(9, collar, collar + 3, (12.0, 0.0))]
    crank = part("crank", pin(5.0, -24, -8), pin(9, -10, -8), pin(9, -24, -20), pin(20, -8, -gap))
    throw = part("throw", pin(radius, -gap, collar or 60, (12.0, 0.0)), *ends)
    sides = [block((x, -40, 0), (x + 8, 40, 20)) for x in (-0.1, 16.1)]
    ends = [block((8 - 0.1, y, 0), (16.1, y + 10, 20)) for y in (-40, 30)]
    rods = [across(pin(4.0, *reach, (-10.0, 0.0))) for reach in ((-100, 0), (24.1, 110))]
    return assembly(base, crank, throw, part("yoke", *sides, *ends, *rods))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("collar", "kind"), [(None, "contact b"), (20.5, SLOT)])
def test_the_pin_of_a_crank_drives_a_yoke_that_does_not_touch_it(collar, kind, seed):
    drawn = anywhere(yoke(0.5, collar), seed)
    mechanism = drawn.mechanism(fixed=["base"], rigid=[["crank", "throw"]])
    assert kind_of(mechanism, "crank", "yoke") == kind
    assert mechanism.mobility().useful == 1


@pytest.mark.parametrize("seed", SEEDS)
def test_a_roller_round_a_pin_is_what_is_in_the_slot(seed):
    plate = part("plate", *frame_of_slot(12.2))
    arm = part("arm", ring(4, 10, 8.2, 13), block((0, 10, 8.2), (20, 60, 13)))
    rivet = part("rivet", pin(4, -1, 13), pin(7, 13, 15), pin(5.5, -3, -1))
    roller = part("roller", ring(4.25, 6, 0, 8))
    mechanism = anywhere(assembly(plate, arm, rivet, roller), seed).mechanism(fixed=["plate"])
    body = owners(mechanism)
    (joint,) = (each for each in moving(mechanism) if each.kind in (SLOT, "contact b"))
    assert {body[name] for name in joint.parts} == {body["plate"], body["roller"]}
    assert kind_of(mechanism, "arm", "roller") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("washer", "foot"), [(0, False), (2, False), (2, True)])
@pytest.mark.parametrize(("play", "guides"), [(0.1, True), (0.4, False)])
def test_a_screw_with_the_clearance_of_screws_in_an_adjusting_slot_guides_nothing(play, guides, washer, foot, seed):
    """Its head or a washer lies on the plate that has the slot, and nothing ties that to the base but a foot that lies
    on both, perhaps."""
    floor = block((-60, 35, -20), (60, 50, 0))
    base = part("base", ring(4, 10, -20, 0), block((-60, -60, -20), (60, -10, 0)), floor)
    screw = part("screw", pin(4, -15, 5 + washer), pin(7, 5 + washer, 9 + washer))
    others = [part("washer", ring(4.2, 9, 5, 5 + washer))] if washer else []
    if foot:
        others.append(part("foot", block((-60, 35, 0), (60, 50, 8)), block((-60, 20, 5), (60, 35, 8))))
    drawn = assembly(base, part("plate", *frame_of_slot(2 * (4 + play))), screw, *others)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    assert any(each.kind == SLOT for each in moving(mechanism)) == guides


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pin_with_much_play_between_walls_that_it_does_not_lie_on_is_in_no_slot(seed):
    """Only a pin with little play drives a yoke, or what else does not touch the crank."""
    drawn = yoke(0.5, 20.5, 3.2)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"], rigid=[["crank", "throw"]])
    assert not {SLOT, "contact b"} & {each.kind for each in mechanism.all_joints}


def round_end(x, sign, radius=4.1):
    """The half-round end of a slot along x, at a place of it, between two heights."""
    faces = ring(radius, 9.0, 6, 11, (x, 40.0))
    round_ones = [face for face in faces if getattr(face[0], "side", 1) < 0]
    return [(surface, each[sign * (each.mean(axis=1)[:, 0] - x) > 0]) for surface, each in round_ones]


def levers(end=-20.0, far=34.0, low=0.0):
    """Two levers that hinge on a base with play: a pin of the one, 0.7 loose, is in a round-ended slot of the other
    `low` above it, from `end` to `far` along x; the pin is at 0."""
    base = part(
        "base",
        block((-60, -60, -10), (90, 90, -0.2)),
        *(pin(5.0, -10, 5.2), pin(8.0, 5.2, 5.9)),
        *(pin(8.0, -0.2, 5.8, (60.0, 40.0)), pin(5.0, 5.8, 11.2, (60.0, 40.0)), pin(8.0, 11.2, 13, (60.0, 40.0))),
    )
    driver = part("driver", ring(5.2, 9.0, 0, 5), block((-4, 9, 0), (4, 36, 5)), pin(3.4, 0, 14, (0.0, 40.0)))
    walls = [block((end, *sides), (far, *ends)) for sides, ends in (((44.1, 6), (50, 11)), ((30, 6), (35.9, 11)))]
    ends = [round_end(end, -1), round_end(far, 1), block((far + 6, 30, 6), (52, 50, 11))]
    return assembly(base, driver, part("slotted", ring(5.2, 8.0, 6, 11, (60.0, 40.0)), *walls, *ends))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("end", [-20.0, 0.2, -0.5])
def test_a_loose_pin_does_not_slide_along_its_axis_where_hinges_keep_it_level(end, seed):
    """Nothing is between the two levers that would stop such a slide. At the end of its stroke the pin is in a half of
    a hole, which it leaves: a hinge there would lock both levers."""
    mechanism = anywhere(levers(end), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "driver", "slotted") == SLOT
    assert mechanism.mobility().useful == 1
    (joint,) = (each for each in mechanism.all_joints if each.kind == SLOT)
    assert "hinges along it keep both level" in joint.evidence.text
