"""Wheels with teeth on shafts in one plate, at a place, a size and in an order at random, which change nothing."""

import numpy as np
import pytest

from assembly.polygons import prism, square, teeth
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring


def winder(play, apart=18.0, tight=False):
    """Two shafts with play in a plate: one with teeth cut on it, which may be tight there, one with a wheel on its
    square."""
    own = 2.0 if tight else 2.0 + play
    plate = [ring(own, 6.0, 0, 2), ring(2.0 + play, 6.0, 0, 2, (apart, 0.0)), block((-20, -30, 0), (40, -6, 2))]
    pinion = part("pinion", pin(2.0, -2, 3), prism(teeth(9, 1.0), 3, 9), pin(2.0, 9, 12))
    shaft = part("shaft", pin(2.0, -10, 4, (apart, 0.0)), prism(square(3.0), 4, 8.5, (apart, 0.0)))
    # 27 teeth have a gap where the nine have one
    rim = prism(teeth(27, 1.0, np.pi / 27 + np.pi), 4, 8, (apart, 0.0))
    wheel = part("wheel", rim, prism(square(3.15), 4, 8, (apart, 0.0), -1.0))
    return assembly(part("plate", *plate), pinion, shaft, wheel)


@pytest.mark.parametrize("seed", SEEDS)
def test_wheels_in_mesh_turn_on_shafts_with_play_in_one_plate_alone(seed):
    """The wheel is on a square as long as itself, which leaves it no stroke: it is held there."""
    mechanism = anywhere(winder(0.1), seed).mechanism(fixed=["plate"])
    body = owners(mechanism)
    assert body["wheel"] == body["shaft"] and len({body[each] for each in ("plate", "pinion", "wheel")}) == 3
    assert {kind_of(mechanism, "plate", each) for each in ("pinion", "shaft")} <= {"revolute", "cylindrical"}


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wheel_with_teeth_that_mesh_with_nothing_may_be_the_knob_of_a_screw(seed):
    """So may one that fits its hole exactly, which is pressed in."""
    drawn = winder(0.1)
    alone = anywhere(assembly(*(each for each in drawn.parts if each.name in ("plate", "pinion"))), seed)
    loose = owners(alone.mechanism(fixed=["plate"]))
    assert loose["pinion"] == loose["plate"]
    tight = owners(anywhere(winder(0.0), seed).mechanism(fixed=["plate"]))
    assert tight["pinion"] == tight["plate"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pinion_without_play_turns_where_the_wheel_in_mesh_with_it_does(seed):
    """Pressed in, it would lock a wheel that is drawn to turn."""
    mechanism = anywhere(winder(0.1, tight=True), seed).mechanism(fixed=["plate"])
    body = owners(mechanism)
    assert len({body[each] for each in ("plate", "pinion", "wheel")}) == 3
    assert kind_of(mechanism, "plate", "pinion") == "cylindrical"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("play", "apart", "turns"), [(0.1, 15.0, True), (0.0, 15.0, False), (0.1, 12.0, False)])
def test_a_pinion_with_a_collar_in_a_blind_bore_turns_in_a_ring_with_teeth(play, apart, turns, seed):
    """It has the form of a screw with a head. Where the ring fits as well, or is not in mesh, it may be pressed in."""
    at = (apart, 0.0)
    nose = [ring(2.2, 6.0, -10, -2, at), block((apart - 6, -6, -12), (apart + 6, 6, -10))]
    base = part("base", ring(30.0 + play, 40.0, 0, 8), block((-40, -40, -4), (40, 40, -3)), *nose)
    # 45 teeth of the ring have a gap where the fifteen have a tooth
    rim = part("rim", pin(30.0, 0, 8), prism(teeth(45, 1.0), 0, 8, side=-1.0))
    pinion = part("pinion", prism(teeth(15, 1.0), 0, 8, at), pin(4.0, -2, 0, at), pin(2.2, -10, -2, at))
    mechanism = anywhere(assembly(base, rim, pinion), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert (body["pinion"] != body["base"]) == turns
    assert not turns or kind_of(mechanism, "base", "pinion") == "revolute"
