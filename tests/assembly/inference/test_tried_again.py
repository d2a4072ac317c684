"""What an inference takes for one body is tried as a joint, where nothing moves with it or it would lock a slide; what
turns by itself only is no such case."""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, moving, part, pin, ring


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("play", [0.1, 0.3])
def test_a_short_lever_on_a_pin_with_play_turns(play, seed):
    """The lever stands on the base around the pin, as a bush would be pressed on: then nothing could move."""
    base = part("base", block((-40, -20, -6), (40, 20, 0)), pin(4.0, 0, 10))
    lever = part("lever", ring(4.0 + play, 8.0, 0, 10), block((0, -6, 0), (8, 6, 10)))
    mechanism = anywhere(assembly(base, lever), seed).mechanism(fixed=["base"])
    (joint,) = moving(mechanism)
    assert joint.kind == "revolute" and joint.evidence.kind == "clearance"
    assert any(note.startswith("left out, since nothing could move with it") for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_yoke_that_a_guide_leads_with_play_is_not_held_to_the_crank_that_it_lies_on(seed):
    """A Scotch yoke: its square rod is between four walls of the base, and the yoke lies on the disc of the crank,
    whose pin has play in the slot of the yoke."""
    walls = [
        block((95, low, bottom), (125, high, top))
        for low, high, bottom, top in [
            (-20, -4.1, 0, 40),
            (4.1, 20, 0, 40),
            (-4.1, 4.1, 0, 10.9),
            (-4.1, 4.1, 19.1, 40),
        ]
    ]
    base = part("base", block((-110, -40, -10), (190, 40, 0)), *walls, ring(6.0, 9.0, -10, 0))
    crank = part("crank", pin(6.0, -10, 0), pin(25.0, 0, 8), pin(4.0, 8, 22, (11.5, 9.6)))
    cheeks = [block((low, -35, 8), (low + 6, 35, 22)) for low in (1.4, 15.6)]
    yoke = part("yoke", *cheeks, block((20, -4, 11), (170, 4, 19)))
    mechanism = anywhere(assembly(base, crank, yoke), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "yoke") == "prismatic"
    assert kind_of(mechanism, "base", "crank") == "revolute"
    assert kind_of(mechanism, "crank", "yoke") == "pin in slot"
    assert mechanism.mobility().useful == 1


@pytest.mark.parametrize("seed", SEEDS)
def test_the_block_of_a_quick_return_turns_on_its_pin_and_slides_in_its_lever(seed):
    """It has the form of a nut on the pin, and both walls of the lever lie on it."""
    crank_axis, at_pin = (60.0, -15.0), (80.0, 0.0)
    base = part("base", block((-40, -60, -20), (120, 60, -10)), pin(6, -10, 10), ring(5, 9, -10, 0, crank_axis))
    crank = part("crank", pin(5, -10, 0, crank_axis), pin(30, 0, 5, crank_axis), pin(4, 5, 11, at_pin))
    walls = [block((9, low, 5.5), (120, low + 4, 9.5)) for low in (-10, 6)]
    lever = part("lever", ring(6, 9, 5.5, 9.5), *walls)
    sides = [block((72, low, 5.5), (88, low + 1, 9.5)) for low in (-6, 5)]
    block_on_pin = part("block", ring(4, 5, 5.5, 9.5, at_pin), *sides)
    mechanism = anywhere(assembly(base, crank, lever, block_on_pin), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "block", "crank") == "cylindrical"
    assert kind_of(mechanism, "block", "lever") == "planar"
    assert mechanism.mobility().useful == 1


@pytest.mark.parametrize("seed", SEEDS)
def test_a_disc_on_a_shoulder_screw_keeps_its_hinge(seed):
    """It turns by itself, which moves nothing else: nothing is given up for that."""
    base = part("base", ring(2.5, 20, -10, 0))
    disc = part("disc", ring(4, 30, 0, 8))
    screw = part("screw", pin(2.5, -9, 0), pin(3.9, 0, 8.1), pin(7, 8.1, 13))
    mechanism = anywhere(assembly(base, disc, screw), seed).mechanism(fixed=["base"])
    assert kind_of(mechanism, "base", "disc") == "revolute"
