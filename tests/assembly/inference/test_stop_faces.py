"""Faces along the axis of a pin with play: those of a lid that is drawn closed open, those that meet on both sides of
the axis keep it from turning.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import numpy as np
import pytest

from jaxkin.geometry.surfaces import Cylinder, Plane
from reference.round_parts import anywhere, assembly, block, kind_of, moving, owners, part, pin, ring


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
