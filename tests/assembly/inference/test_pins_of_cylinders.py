"""Pins of hydraulic cylinders and of yokes, with a cotter across them or a grease nipple in their end, and the blocks
on them; springs in their cans; screws that are drawn into nuts.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring

PLAY = 0.06


def wall(radius, low, high, at=(0.0, 0.0)):
    """The wall of a hole."""
    return ring(radius, 2 * radius, low, high, at)[2:3]


def fork_and_eye(*pins):
    """A fork with play on pins, which stand out of it, and the eye of a cylinder between its plates."""
    lugs = [ring(10.0 + PLAY, 22.0, low, low + 12.0) for low in (-32.0, 20.0)]
    fork = part("fork", *lugs, block((-60, -20, -32), (-23, 20, 32)))
    eye = part("eye", ring(10.0 + PLAY, 19.0, -18.0, 18.0), block((20, -10, -15), (150, 10, 15)))
    return assembly(fork, eye, *pins)


def with_cotter():
    """A pin whose head has play to the fork, with a washer and a cotter at its other end."""
    hole = across(*[wall(2.0, -10.0, 10.0, (-38.0, 0.0))])
    cotter = part("cotter", across(pin(2.0, -17.0, 17.0, (-38.0, 0.0))))
    washer = part("washer", ring(10.4, 16.0, 32.5, 35.5))
    return part("pin", pin(10.0, -32.4, 44.0), pin(15.0, -38.0, -32.4), hole), cotter, washer


def with_nipple():
    """A pin with a collar at one end, and a grease nipple in a hole of its other end."""
    nipple = part("nipple", pin(3.0, 36.0, 40.0), pin(3.6, 40.0, 43.0), pin(2.0, 43.0, 48.0))
    return part("pin", pin(10.0, -32.4, 40.0), pin(15.0, -38.0, -32.4), wall(2.5, 32.0, 40.0)), nipple


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("pins", [with_cotter, with_nipple])
def test_a_pin_with_small_holes_belongs_to_its_fork_as_one_without_does(pins, seed):
    """Else it is a body of its own, which turns between fork and eye, and these have no joint."""
    mechanism = anywhere(fork_and_eye(*pins()), seed).mechanism(fixed=["fork"])
    body = owners(mechanism)
    assert {body[name] for name in body if name != "eye"} == {body["fork"]}
    assert kind_of(mechanism, "fork", "eye") in ("revolute", "cylindrical")


@pytest.mark.parametrize("seed", SEEDS)
def test_what_turns_on_a_tube_through_a_fork_still_does(seed):
    """A tube that is hollow from end to end is an axle: neither fork nor wheel holds it."""
    tube = part("pin", ring(6.0, 10.0, -40.0, 40.0))
    mechanism = anywhere(fork_and_eye(tube), seed).mechanism(fixed=["fork"])
    assert owners(mechanism)["eye"] != owners(mechanism)["fork"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("room", [0.15, 0.6])
def test_a_spring_in_its_can_stops_no_plunger(room, seed):
    """The can is a tube round the spring, thicker than this: it is no rod of it, nor is the spring a bush in it."""
    can = part(
        "can", ring(5.0, 30.0, -30, 0), ring(16.0 * (1 + room), 30.0, 0, 90), block((-40, -60, -30), (40, -29, 60))
    )
    rod = part("rod", pin(5.0, -60, 60), pin(15.0, 60, 66), block((4, -2, -58), (25, 2, -50)))
    drawn = assembly(can, rod, part("spring", ring(11.0, 16.0, 0, 60)))
    mechanism = anywhere(drawn, seed).mechanism(fixed=["can"])
    assert owners(mechanism)["spring"] == owners(mechanism)["can"]
    assert kind_of(mechanism, "can", "rod") == "cylindrical"
    assert any("'spring' is taken for a spring" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_block_with_play_on_a_plain_pin_slides_between_the_walls_of_a_yoke(seed):
    """The pin is fast in a crank. The block would be a nut on it by its form."""
    base = part(
        "base", pin(8.0, -40.0, 10.0), pin(8.0, -40.0, 10.0, (0.0, -60.0)), block((-30, -80, -50), (30, 20, -40))
    )
    crank = part(
        "crank",
        ring(8.0, 16.0, -38.0, -26.0),
        block((-10, 15, -38), (10, 24, -26)),
        ring(6.0, 12.0, -38.0, -26.0, (0.0, 35.0)),
    )
    post = part("post", pin(6.0, -38.0, 4.0, (0.0, 35.0)))
    slider = part("block", block((-10, 25, -14), (10, 45, 2)), wall(6.0 + PLAY, -14.0, 2.0, (0.0, 35.0)))
    lever = part(
        "lever",
        ring(8.0, 16.0, -14.0, 2.0, (0.0, -60.0)),
        block((-20, -46, -14), (20, -40, 2)),
        block((-20, -40, -14), (-10.05, 60, 2)),
        block((10.05, -40, -14), (20, 60, 2)),
    )
    mechanism = anywhere(assembly(base, crank, post, slider, lever), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["post"] == body["crank"] and len({body[each] for each in ("base", "crank", "block", "lever")}) == 4
    assert kind_of(mechanism, "block", "crank") in ("revolute", "cylindrical")  # no face stops it along the pin
    assert kind_of(mechanism, "block", "lever") == "prismatic"


@pytest.mark.parametrize("seed", SEEDS)
def test_a_screw_that_is_drawn_into_a_nut_is_no_shaft_of_a_motor(seed):
    """A clash of two fasteners: a nut has no pin that could be a shaft."""
    plate = part("plate", ring(4.0, 12.0, 0.0, 10.0), block((-60, -30, 0), (-12, 30, 10)))
    sides = [block((-8, -8, -8), (-4, 8, 0)), block((4, -8, -8), (8, 8, 0))]
    sides += [block((-4, -8, -8), (4, -4, 0)), block((-4, 4, -8), (4, 8, 0))]
    nut = part("nut", wall(4.0, -8.0, 0.0), *sides)
    bolt = part("bolt", pin(4.0, -9.0, 10.0), pin(7.0, 10.0, 15.0))
    cover = part("cover", ring(1.0, 6.0, -30.0, -14.0, (6.0, 0.0)), block((6, -6, -60), (60, 6, -30)))
    screw = part("screw", pin(1.0, -30.0, -4.0, (6.0, 0.0)), pin(2.0, -34.0, -30.0, (6.0, 0.0)))
    mechanism = anywhere(assembly(plate, nut, bolt, cover, screw), seed).mechanism(fixed=["plate"])
    assert not any("a shaft" in note for note in mechanism.notes)
