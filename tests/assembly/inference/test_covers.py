"""Covers round a shaft: rings with play on it that lie on what it is in.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part, pin, ring


def geared(play, hub=2.5, radius=9.5):
    """A case with the shaft of a lever that fits it, a ring on the case round the shaft, and the lever from some height
    on."""
    case = part("case", ring(3.0, 12, -10, 0), block((-20, -12, -20), (20, 12, -10)))
    cover = part("cover", ring(3.0 + play, radius, 0, 2))
    lever = part("lever", pin(3.0, -10, hub), pin(7, hub, 8), block((7, -3, hub), (40, 3, 8)))
    return assembly(case, cover, lever)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("play", "radius"), [(0.03, 9.5), (0.05, 6.0), (0.3, 9.5)])
def test_a_ring_with_play_on_a_shaft_belongs_to_the_case_that_it_lies_on(play, radius, seed):
    mechanism = anywhere(geared(play, radius=radius), seed).mechanism(fixed=["case"])
    body = owners(mechanism)
    assert body["cover"] == body["case"] != body["lever"]
    assert kind_of(mechanism, "case", "lever") in ("revolute", "cylindrical")


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("play", "hub"), [(0.0, 2.5), (0.05, 2.0)])
def test_a_ring_that_fits_the_shaft_or_is_under_its_hub_is_no_cover(play, hub, seed):
    mechanism = anywhere(geared(play, hub), seed).mechanism(fixed=["case"])
    assert not any("on which it lies" in note for note in mechanism.notes)
