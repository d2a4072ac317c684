"""Motors and linear bearings, known by their sizes; places and orders at random change nothing."""

import numpy as np
import pytest

from jaxkin.geometry.part import moved
from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

ON_CATALOGUE = {"scaled_at_random": False}
"""Sizes of a catalogue are not scaled."""


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("side", "bore", "turns"),
    [(42.3, 2.5, True), (41.0, 2.6, True), (35.0, 2.5, True), (50.0, 2.5, False)],
)
def test_what_is_on_the_shaft_of_a_stepper_motor_of_one_solid_turns(side, bore, turns, seed):
    """A block of another size with a pin on it may be anything: what fits the pin is set on it, as before."""
    case = block((-side / 2, -side / 2, -40), (side / 2, side / 2, 0))
    drawn = assembly(part("part", case, pin(11.0, 0, 2), pin(2.5, 2, 22)), part("pulley", ring(bore, 7.0, 8, 20)))
    mechanism = anywhere(drawn, seed, **ON_CATALOGUE).mechanism(fixed=["part"])
    body = owners(mechanism)
    kinds = {joint.kind for joint in mechanism.all_joints if joint.freedoms}
    assert (body["pulley"] != body["part"] and kinds == {"revolute"}) == turns


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("name", "turns"),
    [
        ("Gearmotor_25D_left 2", True),
        ("Moteur", True),
        ("Motor N20", True),
        ("motor plate", False),
        ("Getriebemotorhalter", False),
        ("part", False),
    ],
)
def test_what_is_on_the_pin_of_a_part_that_is_named_a_motor_turns_and_is_told_as_doubtful(name, turns, seed):
    """A round case of no known size: its wheel fits the shaft exactly, and by contacts alone it would slide there."""
    base = part(
        "base", block((-40, -40, -60), (40, 40, -50)), pin(4.0, -50, 20, (60, 0)), block((40, -10, -60), (70, 10, -50))
    )
    case = part(name, pin(12.0, -50, 0), pin(3.0, 0, 20))
    lever = part("lever", ring(4.1, 8.0, 0, 10, (60, 0)), block((67, -3, 0), (110, 3, 10)))
    drawn = assembly(base, case, part("wheel", ring(3.0, 25.0, 6, 18)), lever)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    told = [joint for joint in mechanism.all_joints if joint.evidence and "by its name" in joint.evidence.text]
    assert bool(told) is turns
    if turns:
        (joint,) = told
        assert joint.kind == "revolute" and {*joint.parts} == {name, "wheel"}
        assert "name" in joint.evidence.doubt.why


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "held"), [("gearmotor 1", True), ("part", False)])
def test_the_round_case_of_a_motor_does_not_turn_in_its_seat(name, held, seed):
    """By exact contacts a shoulder and a bore let it turn there, as a journal does."""
    base = part("base", ring(12.0, 20.0, -20, 0), block((14, -60, -20), (60, -14, 0)), pin(4.0, 0, 20, (50, -40)))
    lever = part("lever", ring(4.1, 8.0, 5, 15, (50, -40)), block((57, -43, 5), (110, -37, 15)))  # something that moves
    case = part(name, pin(12.0, -50, 0), pin(14.0, -55, -20), pin(3.0, 0, 20))
    drawn = assembly(base, case, part("wheel", ring(3.0, 25.0, 6, 18)), lever)
    body = owners(anywhere(drawn, seed).mechanism(fixed=["base"]))
    assert (body[name] == body["base"]) is held
    assert not held or body["wheel"] != body["base"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_plate_on_the_flange_of_a_stepper_motor_is_no_hub(seed):
    motor = part("motor", block((-21, -21, -40), (21, 21, 0)), pin(11.0, 0, 2), pin(2.5, 2, 22))
    plate = part("plate", ring(2.5, 4.0, 2, 8), block((-30, 4, 2), (30, 30, 8)))
    mechanism = anywhere(assembly(motor, plate), seed, **ON_CATALOGUE).mechanism(fixed=["motor"])
    assert not any("stepper" in note for note in mechanism.notes)


def servo(length, width, radius, reach):
    """A servo of one solid whose shaft is as far from one end of its case as from its sides; tabs with holes."""
    low, high = -width / 2, length - width / 2
    case = block((low, -width / 2, -30), (high, width / 2, 0))
    tabs = [block((x - 4, -width / 2, -10), (x + 4, width / 2, -8)) for x in (low - 4, high + 4)]
    holes = [ring(1.1, 2.0, -10, -8, (x, 0)) for x in (low - 4, high + 4)]
    return part("box", case, *tabs, *holes, pin(radius, 0, reach))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("length", "width", "radius", "turns"),
    [(40.3, 20.0, 2.95, True), (22.8, 12.2, 2.4, True), (60.0, 20.0, 2.95, False), (40.3, 20.0, 4.0, False)],
)
def test_the_horn_of_a_servo_turns_on_it_with_what_it_is_set_into(length, width, radius, turns, seed):
    """The horn fits the shaft exactly, and the arm with play: it was tighter on the shaft, and held there."""
    horn = part("horn", ring(radius, 4.5, 1, 6), ring(4.5, 9.0, 1, 3))
    arm = part("arm", ring(4.55, 9.0, 3, 6), block((4.55, -4, 3), (60, 4, 6)))
    drawn = anywhere(assembly(servo(length, width, radius, 5), horn, arm), seed, **ON_CATALOGUE)
    mechanism = drawn.mechanism(fixed=["box"])
    body = owners(mechanism)
    assert (body["horn"] == body["arm"] != body["box"]) == turns
    assert not turns or kind_of(mechanism, "horn", "box") == "revolute"


def driven_four_bar():
    """Pieces of a motor in its bracket, and of a crank on its shaft, a rocker, a coupler and two pins with heads."""
    motor = (block((-21, -21, -40), (21, 21, 0)), pin(11.0, 0, 4), pin(2.5, 4, 22))
    pivot = [pin(2.5, 4, 22, (70, 35)), pin(4.0, 22, 24, (70, 35))]
    bracket = (ring(11.0, 15.0, 0, 4), block((-30, 15, 0), (120, 50, 4)), *pivot)
    eyes = [ring(2.5, 7.0, 6, 11, (x, 0)) for x in (0, 25, 70)]
    others = {
        "crank": (eyes[0], eyes[1], block((2.5, -3, 6), (22.5, 3, 11))),
        "rocker": (eyes[2], ring(2.55, 7.0, 6, 11, (70, 35)), block((67, 2.5, 6), (73, 32.4, 11))),
        "coupler": (*(ring(2.55, 7.0, 11, 16, (x, 0)) for x in (25, 70)), block((27.6, -3, 11), (67.4, 3, 16))),
    }
    heads = [(2.5, 6, 16), (4.0, 16, 18), (4.0, 4, 6)]
    others |= {f"pin {x}": tuple(pin(*size, (x, 0)) for size in heads) for x in (25, 70)}
    return {"motor": motor, "bracket": bracket, **others}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("flat", [False, True])
def test_a_motor_is_held_in_its_bracket_and_drives_a_four_bar(flat, seed):
    """Its pilot turns in the bracket by exact contacts; what is on its shaft turns, and nothing else does. A flat on
    the shaft lets the crank slide only, by exact contacts, and then nothing would move."""
    pieces = driven_four_bar()
    if flat:  # a face along the shaft, inside of it, and one of the crank on that
        pieces["motor"] += (block((-2, 0, 6), (2, 2, 11)),)
        pieces["crank"] += (block((-2, 2, 6), (2, 3.5, 11)),)
    drawn = assembly(*(part(name, *some) for name, some in pieces.items()))
    mechanism = anywhere(drawn, seed, **ON_CATALOGUE).mechanism(fixed=["bracket"])
    body = owners(mechanism)
    assert body["motor"] == body["bracket"] != body["crank"]
    assert kind_of(mechanism, "motor", "crank") == "revolute" and mechanism.mobility().useful == 1


@pytest.mark.parametrize("seed", SEEDS)
def test_the_set_screw_of_a_hub_holds_no_case_of_a_motor(seed):
    """It touches nothing of the motor but its shaft; nothing that is drawn holds the case, and a lever moves."""
    base = part("base", block((-40, -40, -60), (90, 40, -40)), pin(4.0, -40, 20, (60, 0)))
    lever = part("lever", ring(4.1, 8.0, 0, 10, (60, 0)), block((67, -3, 0), (110, 3, 10)))
    motor = part("motor", block((-21, -21, -40), (21, 21, 0)), pin(11.0, 0, 2), pin(2.5, 2, 22))
    lift = np.eye(4)
    lift[2, 3] = 14
    hole = moved(part("hole", across(ring(1.5, 2.0, 2.5, 8.0))), lift)
    arm = [ring(2.5, 8.0, 8, 20), block((-60, -3, 10), (-8, 3, 18))]
    hub = part("hub", *arm, [(face.surface, face.triangles) for face in hole.faces])
    screw = moved(part("screw", across(pin(1.5, 2.5, 7.0))), lift)
    drawn = assembly(motor, hub, screw, base, lever)
    for each in (drawn, anywhere(drawn, seed, **ON_CATALOGUE)):  # the motor first, and in an order at random
        body = owners(each.mechanism(fixed=["base"], rigid=[["base", "motor"]]))
        assert body["hub"] != body["motor"] != body["screw"]


def rods_and_carriages(length):
    """Two carriages with two bearings each on two rods, of which a block holds more than half with them."""
    places = [(-30.0, 0.0), (30.0, 0.0)]
    block_ = part("block", *(ring(4.0, 12.0, 0, 50, at) for at in places), block((-18, -10, 0), (18, 10, 50)))
    rods = [part(f"rod {k}", pin(4.0, 0, 140, at)) for k, at in enumerate(places)]
    carriages, bearings = [], []
    for name, low in (("lower", 60.0), ("upper", 100.0)):
        seats = [ring(7.5, 12.0, low, low + length, at) for at in places]
        carriages.append(part(name, *seats, block((-18, -10, low), (18, 10, low + length))))
        bearings += [part(f"{name} {k}", ring(4.0, 7.5, low, low + length, at)) for k, at in enumerate(places)]
    return assembly(block_, *rods, *carriages, *bearings)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("length", "slides"), [(24.0, True), (20.0, False)])
def test_two_carriages_with_linear_bearings_on_the_same_rods_are_not_one_body(length, slides, seed):
    """Bushes of no such size in two plates on two rods are as those of spacers: the rods hold all of them."""
    mechanism = anywhere(rods_and_carriages(length), seed, **ON_CATALOGUE).mechanism(fixed=["block"])
    body = owners(mechanism)
    assert (len({body["lower"], body["upper"], body["block"]}) == 3) == slides
    assert not slides or (body["lower 0"] == body["lower"] and body["upper 1"] == body["upper"])
