"""Find the faces of two parts that their relative motion maps onto themselves: they need be compared at one pose only.

A pin turns in its hole, a ball in its socket. The surface of revolution of such a face, about an axis that stays where
it is in both parts, is at each pose where it was at the first: how near the other part comes to it does not change.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool

from jaxkin.effects.clash_shapes import ClashShape
from jaxkin.geometry.displaced import Displaced

SAME_PLACE = 1e-2
"""Share of what counts as contact by which a point of an axis may move and still be at rest: poses are closed far more
exactly, and nothing that is told depends on so little."""


def invariant(one: ClashShape, other: ClashShape, moved: Displaced, length: float) -> Bool[np.ndarray, "labels labels"]:
    """Mark the pairs of faces of which the motion of shape 2 relative to shape 1 maps one onto itself.

    These are whole cylinders, cones and balls, whose axis or centre stays within a length of where it is at the first
    pose, in the other part, too.
    """
    first, second = _of_second(one, moved.inverse(), length), _of_second(other, moved, length)
    return first[:, None] | second


def _of_second(shape: ClashShape, moved: Displaced, length: float) -> Bool[np.ndarray, " labels"]:
    """Mark the faces of shape 2, displaced relative to shape 1, that all displacements leave where the first does."""
    found = np.zeros(len(shape.bulges), bool)
    for label, points in shape.axis_points.items():
        placed = points @ moved.rotation.swapaxes(1, 2) + moved.shift[:, None]
        found[label] = np.abs(placed - placed[0]).max() <= length
    return found
