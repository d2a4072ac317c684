"""The disc of Oldham's coupling, which floats between two hubs.

It is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import anywhere, assembly, block, kind_of, part, pin, ring


def coupling(play, gap):
    """Two hubs on axes 2.2 beside each other, in bushes that their shoulders are beside, and a disc with slots between
    them, with a play on each side of the tongues and a gap on both sides along the axes."""
    shift = (2.0, 1.0)
    base = part(
        "base",
        block((-40, -60, -60), (40, -40, 60)),
        ring(5.0, 12.0, -60, -40),
        ring(5.0, 12.0, 40, 60, shift),
        *(block((-4, -40, low), (4, -10, low + 20)) for low in (-60, 40)),
    )
    tongue = block((-15, -3, -12 - gap), (15, 3, -4.3))
    flange = pin(16.0, -30, -10 - gap)
    shoulders = pin(9.0, -39.8, -30), pin(9.0, -66, -60.2)
    driving = part("driving", pin(5.0, -80, -20), *shoulders, flange, tongue, block((4, -2, -79), (30, 2, -70)))
    tongue = block((-1, -14, 4.3), (5, 16, 12 + gap))
    flange = pin(16.0, 10 + gap, 30, shift)
    shoulders = pin(9.0, 30, 39.8, shift), pin(9.0, 60.2, 66, shift)
    driven = part("driven", pin(5.0, 20, 80, shift), *shoulders, flange, tongue, block((4, -2, 70), (30, 2, 79)))
    disc = [block((-16, -16, -4), (16, 16, 4))]
    disc += [block((-16, low, -10), (16, high, -4)) for low, high in ((-16, -3 - play), (3 + play, 16))]
    disc += [block((low, -16, 4), (high, 16, 10)) for low, high in ((-16, -1 - play), (5 + play, 16))]
    return assembly(base, driving, part("disc", *disc), driven)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.0, 0.05])
def test_a_disc_between_two_hubs_slides_in_a_slot_of_each(seed, play):
    mechanism = anywhere(coupling(play, 0.2), seed).mechanism(fixed=["base"])
    assert [kind_of(mechanism, hub, "disc") for hub in ("driving", "driven")] == ["prismatic"] * 2
    assert mechanism.mobility().useful == 1


@pytest.mark.parametrize("seed", range(3))
def test_hubs_that_are_far_from_a_disc_do_not_keep_it(seed):
    mechanism = anywhere(coupling(0.0, 3.0), seed).mechanism(fixed=["base"])
    assert not any("floats" in note for note in mechanism.notes)
