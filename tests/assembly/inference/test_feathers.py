"""Keys that hold a hub, and feathers along which a hub slides.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import anywhere, assembly, block, moving, owners, part, pin, ring


def slot(low, high, floor, top):
    """The walls of a slot of width 3 between two heights, for what is in it."""
    return *block((1.5, floor, low), (2.5, top, high)), *block((-2.5, floor, low), (-1.5, top, high))


def drawn(reach, play, shoulder=False):
    """A hub of length 20 with a lever on a shaft in a bush, and a key that is out of it by a length on one side."""
    shaft = part("shaft", pin(5.0, -60, 60), slot(-8, 10 + reach, 3, 5), *([pin(8.0, -20, -10)] if shoulder else []))
    key = part("key", block((play / 2 - 1.5, 3, -8), (1.5 - play / 2, 6.5, 10 + reach)))
    hub = part("hub", ring(5.0 + play, 12.0, -10, 10), slot(-10, 10, 5.1, 8), block((10, -3, -5), (40, 3, 5)))
    base = part("base", ring(5.0, 9.0, -55, -30), block((-30, -30, -55), (30, -8, -30)))
    return assembly(base, shaft, key, hub)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("play", [0.0, 0.1])
def test_a_hub_slides_along_a_feather_that_is_longer_and_is_held_by_a_key_that_is_not(seed, play):
    free = anywhere(drawn(20.0, play), seed).mechanism(fixed=["base"])
    assert {str(joint.kind) for joint in moving(free) if "hub" in joint.parts} == {"prismatic"}
    assert owners(free)["key"] == owners(free)["shaft"]
    held = anywhere(drawn(0.0, play), seed).mechanism(fixed=["base"])
    assert len({owners(held)[part] for part in ("shaft", "key", "hub")}) == 1


@pytest.mark.parametrize("seed", range(3))
def test_a_hub_on_a_shoulder_is_held_by_its_key_however_long_that_is(seed):
    held = anywhere(drawn(20.0, 0.0, shoulder=True), seed).mechanism(fixed=["base"])
    assert len({owners(held)[part] for part in ("shaft", "key", "hub")}) == 1
