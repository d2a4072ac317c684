"""What people draw a little wrong, or leave out: shims and heads sunk into their neighbours, pins that stand out of
their hole, eyes without pin and bush, washers at the ends of shafts, covers that touch nothing."""

import pytest

from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring


def arm_on_an_axle(sunk):
    """An arm on the axle of a frame, with a shim under it that is drawn `sunk` into the frame."""
    frame = part("frame", ring(6.0, 17.0, -14.0, 14.0), block((-60, -60, -14), (60, -18, 14)))
    shim = part("shim", ring(6.05, 9.0, 14.0 - sunk, 14.5 - sunk))
    arm = part("arm", ring(6.0, 13.0, 14.5 - sunk, 22.5 - sunk), block((13, -8, 14.5 - sunk), (80, 8, 22.5 - sunk)))
    axle = part("axle", pin(6.0, -20.0, 22.5 - sunk), pin(9.5, 22.5 - sunk, 30.0))
    return assembly(frame, shim, arm, axle)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("sunk", [0.0, 0.1, 0.3, 0.45])
def test_a_shim_that_is_sunk_into_a_hub_is_no_screw(sunk, seed):
    """It is thicker than the hole that it stands in, as a screw is than that of its thread, but goes round the axle."""
    mechanism = anywhere(arm_on_an_axle(sunk), seed).mechanism(fixed=["frame"])
    assert len({owners(mechanism)[name] for name in ("frame", "arm")}) == 2
    assert mechanism.mobility().freedoms >= 1
    assert not any("screwed into" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("sunk", [-1.0, 9.0])
def test_the_head_of_a_screw_that_is_drawn_into_a_frame_holds_nothing_there(sunk, seed):
    """A ram in the guide of a frame, with a tool plate under it on a screw, and a lever that moves whatever is held."""
    table, floor = 20.0, 11.0 + 9.0 - sunk
    frame = part(
        "frame",
        block((-60, -60, 0), (60, 60, table)),
        ring(20.05, 40.0, 100.0, 150.0),
        block((-60, -60, table), (-40, 60, 150)),
        pin(4.0, 20.0, 60.0, (-20.0, 50.0)),
    )
    ram = part("ram", ring(3.4, 20.0, floor + 18, floor + 40), pin(20.0, floor + 40, floor + 170))
    plate = part("plate", ring(4.5, 25.0, floor + 8, floor + 18))
    screw = part("screw", pin(6.0, floor, floor + 8), pin(4.0, floor + 8, floor + 34))
    lever = part("lever", ring(4.1, 8.0, 20.0, 30.0, (-20.0, 50.0)), block((-12, 46, 20), (30, 54, 30)))
    mechanism = anywhere(assembly(frame, ram, plate, screw, lever), seed).mechanism(fixed=["frame"])
    body = owners(mechanism)
    assert body["screw"] == body["ram"] == body["plate"] != body["frame"]
    assert kind_of(mechanism, "frame", "ram") == "cylindrical"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("end", [12.0, 12.1, 14.0])
def test_a_pin_that_stands_out_of_its_hole_beside_a_wall_is_held_there_still(end, seed):
    """The rod of an actuator in a yoke, up to the floor of a slot as wide as the rod, or into the slot: the walls of
    the slot touch the rod along lines, as they would touch a roller."""
    barrel = part("barrel", ring(5.1, 20.0, -120.0, -40.0))
    rod = part("rod", pin(5.0, -140.0, end))
    walls = [block((low, -12, 12), (low + 10, 12, 40)) for low in (-15, 5)]
    yoke = part("yoke", ring(5.0, 15.0, 0.0, 12.0), *walls)
    mechanism = anywhere(assembly(barrel, rod, yoke), seed).mechanism(fixed=["barrel"])
    body = owners(mechanism)
    assert body["rod"] == body["yoke"] != body["barrel"]
    assert kind_of(mechanism, "barrel", "rod") == "cylindrical"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("eye", [5.0, 6.0, 7.5])
def test_an_eye_in_its_fork_has_its_pin_where_pin_and_bush_are_not_drawn(eye, seed):
    """The rod of the eye slides in a barrel, so that it is tied to another part, too."""
    fork = part("fork", *(ring(5.0, 12.0, low, low + 4) for low in (-8, 4)), block((-40, -12, -8), (-12, 12, 8)))
    rod = part("rod", ring(eye, 11.0, -3.8, 3.8), block((11, -3, -3), (120, 3, 3)))
    sides = [block((60, -20, low), (100, 20, low + 10)) for low in (-13, 3)]
    walls = [block((60, low, -13), (100, low + 10, 13)) for low in (-13, 3)]
    mechanism = anywhere(assembly(fork, rod, part("barrel", *sides, *walls)), seed).mechanism(fixed=["fork"])
    assert kind_of(mechanism, "fork", "rod") == "revolute"
    (joint,) = (each for each in mechanism.all_joints if {*each.parts} == {"fork", "rod"})
    assert joint.evidence.kind == EvidenceKind.VIRTUAL_PIN


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("gap", "joined"), [(1.0, True), (20.0, False)])
def test_bores_of_two_sizes_beside_each_other_are_one_axis_of_parts_that_nothing_else_ties(gap, joined, seed):
    base = part("base", ring(5.0, 12.0, -10.0, 0.0), block((-60, -60, -10), (60, -12, 0)))
    lever = part("lever", ring(7.5, 14.0, gap, gap + 8), block((14, -5, gap), (90, 5, gap + 8)))
    mechanism = anywhere(assembly(base, lever), seed).mechanism(fixed=["base"])
    assert (len(mechanism.bodies) == 2) == joined
    if joined:
        assert kind_of(mechanism, "base", "lever") == "cylindrical"  # no face stops a slide away from the base


@pytest.mark.parametrize("seed", SEEDS)
def test_a_washer_between_a_hub_and_the_screw_in_the_end_of_its_shaft_is_clamped(seed):
    frame = part("frame", ring(15.05, 60.0, -40.0, 0.0))
    shaft = part("shaft", pin(15.0, -45.0, 20.0), ring(5.0, 15.0, 20.0, 45.0), pin(18.0, 1.0, 5.0))
    hub = part("hub", ring(15.0, 60.0, 5.0, 46.0))
    washer = part("washer", ring(5.5, 22.0, 46.0, 52.0))
    screw = part("screw", pin(5.0, 28.0, 52.0), pin(7.5, 52.0, 62.0))
    mechanism = anywhere(assembly(frame, shaft, hub, washer, screw), seed).mechanism(fixed=["frame"])
    body = owners(mechanism)
    assert body["washer"] == body["screw"] == body["hub"] == body["shaft"] != body["frame"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("gap", [0.0, 0.2])
def test_a_wheel_on_a_thrust_washer_turns_on_the_shoulder_of_its_bolt(gap, seed):
    """The nut presses the frame against the shoulder; the washer, which the bolt holds, is no hub of the wheel. A lever
    beside it moves whatever is held."""
    at = (0.0, -70.0)
    frame = part("frame", ring(3.0, 40.0, -6.0, 0.0), block((-60, -90, -6), (60, -38, 0)), pin(5.0, 0.0, 12.0, at))
    lever = part("lever", ring(5.05, 9.0, 0.0, 8.0, at), block((8, -74, 0), (50, -66, 8)))
    bolt = part("bolt", pin(3.0, -12.0, 0.0), pin(4.0, 0.0, 9.0 + gap), pin(7.0, 9.0 + gap, 12.0 + gap))
    nut = part("nut", ring(3.0, 5.5, -9.0, -6.0))
    washer = part("washer", ring(4.05, 8.0, 0.0, 1.0))
    wheel = part("wheel", ring(4.25, 40.0, 1.0, 9.0))
    mechanism = anywhere(assembly(frame, lever, bolt, nut, washer, wheel), seed).mechanism(fixed=["frame"])
    body = owners(mechanism)
    assert body["bolt"] == body["nut"] == body["frame"] != body["wheel"]


def test_a_cover_that_touches_nothing_is_not_what_is_proposed_to_be_fixed():
    holes = [(0.0, 0.0), (150.0, 0.0)]
    housing = part("housing", *(pin(5.0, 0.0, 14.0, at) for at in holes), block((-60, -20, -20), (200, 20, 0)))
    cranks = [part(f"crank {k}", ring(5.05, 9.0, 5.0, 12.0, at)) for k, at in enumerate(holes)]
    cover = part("cover", block((-480, -300, -100), (480, -290, -98)))
    first, *_ = assembly(housing, *cranks, cover).proposals()
    assert first.fixed == ("housing",)
