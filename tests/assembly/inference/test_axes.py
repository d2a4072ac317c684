"""Axes that bores and pins of different parts have in common."""

import numpy as np
import pytest

from jaxkin.assembly.inference.axes import far_axes
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
