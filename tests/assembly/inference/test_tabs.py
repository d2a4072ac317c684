"""Tabs in slots, with play, at a place, a size and in an order at random, which change nothing."""

import pytest

from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, owners, part


def stand(tab, wide=30.0):
    """A plate with a slot, and an upright with a tab in it, up to its shoulders, with play all round."""
    half, slot = wide / 2, wide / 2 + 0.1
    plate = [block((-60, 1.1, 0), (60, 40, tab)), block((-60, -40, 0), (60, -1.1, tab))]
    plate += [block((slot, -1.1, 0), (60, 1.1, tab)), block((-60, -1.1, 0), (-slot, 1.1, tab))]
    upright = [block((-half - 5, -1, tab + 0.1), (half + 5, 1, tab + 40)), block((-half, -1, 0), (half, 1, tab + 0.1))]
    return assembly(part("plate", *plate), part("upright", *upright))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("tab", "held"), [(2.0, True), (5.0, True), (20.0, False)])
def test_a_tab_that_is_too_short_to_guide_is_held_in_its_slot(tab, held, seed):
    mechanism = anywhere(stand(tab), seed).mechanism(fixed=["plate"])
    body = owners(mechanism)
    assert (body["upright"] == body["plate"]) == held
    assert held or kind_of(mechanism, "plate", "upright") == "prismatic"
