"""Simple solids that symbolise the two sides of a joint in drawings.

The rows of `jaxkin.geometry.movements.MOVEMENTS` hold these figures, and `jaxkin.view.sticks` draws them. All lengths
are multiples of the radius of a drawn bar.
"""

from __future__ import annotations

from typing import NamedTuple


class CylinderFigure(NamedTuple):
    """A cylinder centred on a joint, along an axis of its frame."""

    axis: int
    """Axis of the joint frame along the cylinder: 0, 1, 2 for x, y, z."""
    radius: float
    length: float
    """Length along the axis."""


class BoxFigure(NamedTuple):
    """A box centred on a joint, with its edges along the axes of the frame."""

    extents: tuple[float, float, float]
    """Lengths of the edges along x, y, z."""


class BallFigure(NamedTuple):
    """A ball centred on a joint."""

    radius: float


Figure = CylinderFigure | BoxFigure | BallFigure
"""One solid of a drawing."""

ROD = CylinderFigure(2, 0.7, 32.0)
"""The rod on which a sliding part is drawn: about half as long as the mechanism, since the travel is not known."""
