"""Valves that are drawn on their seats lift where nothing moves else; a lock is no reason to let fasteners go.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

import jaxkin as jk
from reference.round_parts import (
    SEEDS,
    across,
    anywhere,
    assembly,
    block,
    cone,
    kind_of,
    moving,
    owners,
    part,
    pin,
    ring,
)


def chest(*pieces):
    """A guide of radius 10 about the axis z, other pieces, and a post with a pin along x."""
    post = [across(pin(4.0, 15.0, 25.0, (-80.0, 60.0))), block((5, 50, -20), (15, 70, 90))]
    return part("chest", ring(10.0, 30.0, 0.0, 30.0)[2:3], *pieces, *post)


def valve(*pieces):
    """A valve in the guide, with other pieces, and a head with a pin along x."""
    head = [across(pin(4.0, 5.0, 15.0, (-70.0, 0.0))), block((-5, -9, 38), (5, 9, 85))]
    return part("valve", pin(10.0, -5.0, 30.0), *pieces, *head)


def rocked(base, plug):
    """A valve that a rocker on the post of its chest moves by a rod."""
    rod = across(*(ring(4.0, 8.0, 5.0, 15.0, at) for at in ((-70.0, 0.0), (-100.0, 30.0))))
    rocker = [across(pin(4.0, 5.0, 15.0, (-100.0, 30.0))), across(ring(4.0, 8.0, 15.0, 25.0, (-80.0, 60.0)))]
    return assembly(base, plug, part("rod", rod), part("rocker", *rocker, block((15, 22, 90), (25, 38, 110))))


SEAT, PLUG = cone(10.0, 16.0, 30.0, 36.0, -1), cone(10.0, 16.0, 30.0, 36.0, 1)
CLOSED = rocked(chest(SEAT), valve(PLUG))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_valve_on_its_seat_lifts_where_nothing_moves_else(seed):
    """The cone stops it on one side only. The note has what a user could have said, and what holds it down."""
    drawn = anywhere(CLOSED, seed)
    mechanism = drawn.mechanism(fixed=["chest"])
    assert kind_of(mechanism, "chest", "valve") == "cylindrical" and mechanism.mobility().useful == 1
    (note,) = (each for each in mechanism.notes if "a stop on one side" in each)
    ignored = eval(note.partition("as ignore=")[2].partition(" says")[0])
    as_said = drawn.mechanism(fixed=["chest"], ignore=ignored)
    assert [str(each.kind) for each in as_said.all_joints] == [str(each.kind) for each in mechanism.all_joints]
    joints = eval(note.rpartition("say joints=")[2], {"jk": jk})
    held = drawn.mechanism(fixed=["chest"], joints=joints)
    assert kind_of(held, "chest", "valve") == "revolute" and not held.mobility().useful


@pytest.mark.parametrize("seed", SEEDS)
def test_a_cone_between_two_seats_is_no_valve(seed):
    """It can leave neither of them."""
    more, both = cone(16.0, 10.0, 40.0, 46.0, -1), cone(16.0, 10.0, 40.0, 46.0, 1)
    mechanism = anywhere(rocked(chest(SEAT, more), valve(PLUG, both)), seed).mechanism(fixed=["chest"])
    assert kind_of(mechanism, "chest", "valve") == "revolute" and not mechanism.mobility().useful


@pytest.mark.parametrize("seed", SEEDS)
def test_a_cone_that_turns_in_its_seat_keeps_its_hinge_where_something_moves(seed):
    """As the plug of a cock with a handle: nothing is locked."""
    handle = block((-3, 9, 40), (3, 90, 46))
    cock = part("valve", pin(10.0, -5.0, 30.0), PLUG, handle)
    mechanism = anywhere(assembly(chest(SEAT), cock), seed).mechanism(fixed=["chest"])
    assert [str(each.kind) for each in moving(mechanism)] == ["revolute"]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_fastener_that_has_no_part_in_a_lock_is_held_still(seed):
    """Three bars that are a triangle cannot move; a pin in one of them has nothing to do with that."""
    base = part("base", pin(5.0, 0.0, 10.0), pin(5.0, 0.0, 10.0, (80.0, 0.0)), block((-20, -9, -10), (100, 9, 0)))
    one = part(
        "one", ring(5.0, 9.0, 0.0, 10.0), ring(5.0, 9.0, 0.0, 10.0, (40.0, 60.0)), ring(3, 7, 0, 10, (20.0, 30.0))
    )
    arm = block((35, 55, 10), (45, 65, 20))
    other = part("other", ring(5.0, 9.0, 0.0, 10.0, (80.0, 0.0)), pin(5.0, 0.0, 10.0, (40.0, 60.0)), arm)
    bolt = part("bolt", pin(3.0, -8.0, 18.0, (20.0, 30.0)))
    mechanism = anywhere(assembly(base, one, other, bolt), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["bolt"] == body["one"] != body["base"] and not mechanism.mobility().useful
    assert not any("not inferred" in note for note in mechanism.notes)
