"""Stand-offs that a screw clamps to a plate, and bushes that turn on one."""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring


def drawn(plate, bore, gap=0.0):
    """A tube between two plates of a frame, in the hole of a lever that it fits, with a screw through the upper plate:
    radii of the holes for the screw, and the gap under its head."""
    posts = [block((-30, -20, -4), (-20, 20, 17)), block((-20, -20, -4), (12, 20, 0))]
    upper = [block((-20, -20, 12), (-10, 20, 17)), ring(plate, 10.0, 12, 17)]
    screw = part("screw", pin(1.25, 4, 17 + gap), pin(2.75, 17 + gap, 20 + gap))
    lever = part("lever", ring(3.0, 8.0, 2, 10), block((7, -3, 2), (40, 3, 10)))
    return assembly(part("frame", *posts, *upper), part("tube", ring(bore, 3.0, 0, 12)), screw, lever)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_tube_that_a_screw_clamps_to_a_plate_is_no_bush_of_what_turns_on_it(seed):
    mechanism = anywhere(drawn(1.5, 1.25), seed).mechanism(fixed=["frame"])
    body = owners(mechanism)
    assert body["tube"] == body["screw"] == body["frame"] != body["lever"]
    assert kind_of(mechanism, "frame", "lever") == "revolute"
    assert any("its head lies on 'frame', through which it goes" in note for note in mechanism.history)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("plate", "bore", "gap"), [(1.25, 1.5, 0.0), (1.3, 1.25, 0.0), (1.5, 1.25, 2.0)])
def test_a_tube_with_play_on_its_screw_or_under_a_head_that_clamps_nothing_is_a_bush(plate, bore, gap, seed):
    """The screw is tight in the plate, or goes through it closely as the pin of a hinge, or its head is above it."""
    mechanism = anywhere(drawn(plate, bore, gap), seed).mechanism(fixed=["frame"])
    assert any("the sleeve 'tube' is set into the hole of 'lever'" in note for note in mechanism.history)
