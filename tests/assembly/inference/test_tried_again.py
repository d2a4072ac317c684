"""What an inference takes for one body is tried as a joint, where nothing moves with it or it would lock a slide."""

import pytest

from reference.round_parts import anywhere, assembly, block, kind_of, moving, part, pin, ring


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("play", [0.1, 0.3])
def test_a_short_lever_on_a_pin_with_play_turns(play, seed):
    """The lever stands on the base around the pin, as a bush would be pressed on: then nothing could move."""
    base = part("base", block((-40, -20, -6), (40, 20, 0)), pin(4.0, 0, 10))
    lever = part("lever", ring(4.0 + play, 8.0, 0, 10), block((0, -6, 0), (8, 6, 10)))
    mechanism = anywhere(assembly(base, lever), seed).mechanism(fixed=["base"])
    (joint,) = moving(mechanism)
    assert joint.kind == "revolute" and joint.evidence.kind == "clearance"
    assert any(note.startswith("not inferred, since nothing could move with it") for note in mechanism.notes)


@pytest.mark.parametrize("seed", range(2))
def test_a_yoke_that_a_guide_leads_with_play_is_not_held_to_the_crank_that_it_lies_on(seed):
    """A Scotch yoke: its square rod is between four walls of the base, and the yoke lies on the disc of the crank."""
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
    assert kind_of(mechanism, "crank", "yoke") == "planar"
