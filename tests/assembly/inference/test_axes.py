"""Axes that bores and pins of different parts have in common."""

import numpy as np
import pytest

from jaxkin.assembly.inference.axes import common_axes, far_axes
from jaxkin.assembly.inference.bores import Bore
from reference.round_parts import Z


@pytest.mark.parametrize(("radius", "found"), [(0.905, 1), (0.895, 0)])
def test_equal_bores_far_from_each_other_are_one_axis_in_either_order(radius, found):
    """Radii may differ by a tenth of the larger one, and the gap be 20 of it."""
    one, other = (
        Bore(part, ("face 1",), np.array([0.0, 0.0, z]), Z, r, hole=True, half=1.0, spans=((-1.0, 1.0),))
        for part, r, z in (("one", 1.0, 0.0), ("other", radius, 12.0))
    )
    for bores in ([one, other], [other, one]):
        assert len(far_axes(bores, [])) == found


def bore(part, radius, *middles, hole=True):
    """A bore or a pin about z with spans of length 4."""
    half = (max(middles) - min(middles)) / 2 + 2.0
    point = np.array([0.0, 0.0, (max(middles) + min(middles)) / 2])
    spans = tuple((z - point[2] - 2.0, z - point[2] + 2.0) for z in middles)
    return Bore(part, ("face 1",), point, Z, radius, hole, half, spans)


@pytest.mark.parametrize(("pinned", "found"), [(100.0, True), (0.0, False)])
def test_a_pin_in_a_far_lug_of_one_part_leaves_bores_elsewhere_on_its_axis_empty(pinned, found):
    frame, link, pin = bore("frame", 2.0, 0.0, 100.0), bore("link", 2.0, 4.5), bore("pin", 1.9, pinned, hole=False)
    empty = [pair.parts for pair in common_axes([frame, link, pin]) if pair.virtual]
    assert empty == ([("frame", "link")] if found else [])


@pytest.mark.parametrize(("elsewhere", "found"), [(True, False), (False, True)])
def test_bores_round_a_bolt_that_is_in_its_own_holes_elsewhere_are_room_for_its_head_and_its_nut(elsewhere, found):
    """Of a bolt in no hole of its size nothing is known."""
    base, board, plate = bore("base", 8.0, 0.0), bore("board", 8.2, 10.0), bore("plate", 4.1, 5.0)
    bolt = bore("bolt", 4.0, 4.0, 8.0, 12.0, hole=False)
    every = [base, board, bolt, *([plate] if elsewhere else [])]
    empty = [pair.parts for pair in common_axes(every) if pair.virtual]
    assert empty == ([("base", "board")] if found else [])
    assert not far_axes(every, common_axes(every)) or not elsewhere
