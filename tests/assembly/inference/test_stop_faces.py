"""Faces along the axis of a pin with play: those of a lid that is drawn closed open, those that meet on both sides of
the axis keep it from turning.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest

from jaxkin.geometry.part import moved
from jaxkin.geometry.surfaces import Cylinder, Plane
from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("turns", [True, False])
def test_a_lid_that_lies_on_its_box_turns_where_the_faces_meet_on_one_side_of_its_pin_alone(seed, turns):
    """The axis is z, and the faces meet at y = -8 from x = 10 on; a lid that also meets them behind it cannot turn."""
    box = part("box", block((-60, -60, -40), (90, -8, 40)), ring(5.0, 7.5, -30, -11), ring(5.0, 7.5, 11, 30))
    behind = [] if turns else [block((-50, -8, -10), (-10, -2, 10))]
    lid = part(
        "lid", ring(5.3, 7.5, -10, 10), block((7, -2, -10), (80, 5, 10)), block((10, -8, -9), (80, -2, 9)), *behind
    )
    mechanism = anywhere(assembly(box, lid, part("pin", pin(5.0, -30, 30))), seed).mechanism(fixed=["box"])
    about = [joint for joint in moving(mechanism) if joint.kind == "revolute"]
    assert owners(mechanism)["pin"] == owners(mechanism)["box"]
    assert bool(about) == turns
    assert not turns or mechanism.mobility().useful == 1


FOOT = block((-30, -60, -50), (30, -50, 50)), block((-4, -50, -10), (4, -9, 10))
"""A base below a bush about z, between -10 and 10."""


def collars(play):
    """Shoulders of a shaft beside the bush, with a play in all; without one, a shaft that slides."""
    return [] if play is None else [pin(8.0, -20, -10 - play / 2), pin(8.0, 10 + play / 2, 20)]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.3, None])
@pytest.mark.parametrize("clearance", [0.0, 0.4])
def test_a_wheel_that_grazes_its_base_changes_nothing_of_what_stops_its_shaft(seed, play, clearance):
    """The wheel of radius 50 is about the axis of the shaft: whatever it does there, it still touches the base."""
    base = part("base", *FOOT, ring(5.0 + clearance, 9.0, -10, 10))
    shaft = part("shaft", pin(5.0, -40, 60), *collars(play), pin(50.0, 30, 40), block((4, -2, 52), (70, 2, 55)))
    mechanism = anywhere(assembly(base, shaft), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "shaft") == ("cylindrical" if play is None else "revolute")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.3, None])
def test_equal_bores_in_line_across_a_pin_that_fits_hold_nothing(seed, play):
    """Two tubes in line with the knuckles of a hinge between them, as in the frame of a folding bicycle."""
    base = part("base", *FOOT, ring(5.0, 9.0, -10, 10), tube_along_x(-80, -20))
    leaf = part("leaf", pin(5.0, -45, 40), *collars(play), block((4, -2, 25), (30, 2, 30)), tube_along_x(21, 80))
    mechanism = anywhere(assembly(base, leaf), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "leaf") == ("cylindrical" if play is None else "revolute")


def tube_along_x(low, high):
    """A ring along z, turned onto the axis x, below the pin."""
    turn = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    shift = np.array([0.0, -90, 0])
    faces = []
    for surface, triangles in ring(12.0, 15.0, low, high):
        point = turn @ surface.point + shift
        if isinstance(surface, Plane):
            turned = Plane(point, turn @ surface.normal)
        else:
            turned = Cylinder(point, turn @ surface.axis, surface.radius, surface.side)
        faces.append((turned, triangles @ turn.T + shift))
    return faces


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("hub", [True, False])
def test_a_crank_that_a_shoulder_keeps_on_the_shaft_stops_it_though_it_may_turn_there(seed, hub):
    """A shaft with a shoulder on one side of its bush and a crank on the other, which contacts leave a turn. All fit
    exactly, and the play is 0.4 + 0.6. Without the crank the shaft slides."""
    base = part("base", *FOOT, ring(5.0, 9.0, -10, 10))
    shaft = part("shaft", pin(5.0, -40, 15), pin(7.0, -20, -10.4), pin(4.0, 15, 30), block((4, -2, -38), (20, 2, -30)))
    crank = part("crank", ring(5.0, 9.0, 10.6, 15), ring(4.0, 9.0, 15, 20), block((8, -3, 11), (40, 3, 19)))
    drawn = assembly(base, shaft, crank) if hub else assembly(base, shaft)
    mechanism = anywhere(drawn, seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "shaft") == ("revolute" if hub else "cylindrical")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("play", "guided"), [(0.1, True), (2.0, False), (None, False)])
def test_a_finger_in_a_slot_guides_a_rod_that_fits_its_bush_exactly(seed, play, guided):
    """The finger is 6 wide, up to 35 beside the axis, with a play on each side of it; without a slot the rod turns."""
    walls = [] if play is None else [block((3 + play, 22, -30), (9, 38, 30)), block((-9, 22, -30), (-3 - play, 38, 30))]
    base = part("base", *FOOT, ring(5.0, 9.0, -10, 10), *walls)
    rod = part("rod", pin(5.0, -45, 60), block((-3, 4, 20), (3, 35, 26)))
    mechanism = anywhere(assembly(base, rod), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "rod") == ("prismatic" if guided else "cylindrical")


def press_with_a_lever(stroke):
    """A lever on the base, tied by a link to a ram and by another one to a rocker: pins that fit, and lugs, collars
    and a ram between its stops."""
    at, to = (60.0, 40.0), (150.0, 0.0)
    ram_pin = [pin(4.0, 11.0, 25.0, to), *(block((143, -7, low), (165, 7, low + 2.5)) for low in (11.0, 22.5))]
    ends = [pin(14.0, 210 - stroke / 2 - 9, 210 - stroke / 2), pin(14.0, 230 + stroke / 2, 239 + stroke / 2)]
    ram = part("ram", *ram_pin, _at_height(across(pin(10.0, 164, 300), *ends), 18.0))
    bush = _at_height(across(ring(10.0, 20.0, 210, 230)), 18.0)
    pivots = [pin(4.0, -10, 30), pin(4.0, -10, 30, (-60.0, 100.0))]
    base = part("base", block((-90, -40, -20), (260, 120, -10)), block((210, -12, -10), (230, 12, 0)), bush, *pivots)
    ears = [piece for each in (at, (0.0, 40.0)) for piece in (pin(4.0, 5, 26, each), pin(7.0, 22.5, 26, each))]
    plate = ring(4.0, 9.0, 5, 13), block((-4, 9, 5), (4, 40, 13)), block((4, 30, 5), (60, 44, 13))
    lever = part("lever", *plate, *ears)
    rod = part("rod", ring(4.0, 8.0, 13, 22.5, at), ring(4.0, 8.0, 14, 22, to), block((68, 36, 14), (146, 40, 22)))
    link = part(
        "link", ring(4.0, 8.0, 14, 22, (0.0, 40.0)), block((-3, 48, 14), (3, 92, 22)), pin(4.0, 14, 40, (0, 100))
    )
    rocker = part("rocker", ring(4.0, 8.0, 24, 32, (0.0, 100.0)), ring(4.0, 8.0, 24, 32, (-60.0, 100.0)))
    return assembly(base, lever, rod, ram, link, rocker)


def _at_height(faces, height):
    """Pieces moved along z."""
    pose = np.eye(4)
    pose[2, 3] = height
    return [(face.surface, face.triangles) for face in moved(part("drawn", faces), pose).faces]


@pytest.mark.parametrize("seed", SEEDS)
def test_faces_with_a_stroke_between_them_leave_a_ram_to_slide_where_others_stop_hinges(seed):
    """The lever slides with its rod along the pins of all others by exact contacts, and near faces stop that. To stop
    the ram as well, whose stops are its own diameter apart, would lock all."""
    mechanism = anywhere(press_with_a_lever(stroke=20.0), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "ram") == "cylindrical"
    assert kind_of(mechanism, "lever", "link") == kind_of(mechanism, "rod", "ram") == "revolute"
    assert mechanism.mobility().useful == 1
