"""Make the local frames of a contact (Table 1 of the paper)."""

from __future__ import annotations

from typing import Any

import numpy as np
from jaxtyping import Float

from jaxkin.contacts.states import ContactState
from jaxkin.contacts.touch import Touch, foot
from jaxkin.geometry.pose import Vector, frame, unit


def contact_frames(
    state: ContactState, s1: Any, s2: Any, touch: Touch, centre: Vector
) -> Float[np.ndarray, "frames 4 4"]:
    """Make the poses of the local frames in world coordinates, one for each movement of the state.

    `s1` and `s2` are the surfaces of the state, `centre` is the centroid of the contact region. An origin that Table 1
    allows anywhere on a surface, an axis or a line is the projection of `centre`; x of a frame on a plane points along
    the contact line. In a fit (e, k, o) the mean of the two axes or centres stands for that of surface 1. Raises
    ValueError for a symbol that Table 1 does not use.
    """
    fit = state.is_fit
    x = touch.direction if state.region == "line" else None

    def direction(symbol: str) -> Vector:
        """Look up the z axis by its symbol in `ContactState.frames`."""
        match symbol:
            case "n1":
                return s1.normal
            case "a1":
                return touch.direction if fit else s1.axis
            case "a2":
                return s2.axis
            case "m":
                return touch.normal
            case "l":
                return touch.direction
            case "v1 - p":
                return unit(s1.apex - touch.point)
            case "any":
                return np.array([0.0, 0.0, 1.0])
            case _:
                raise ValueError(f"{symbol!r} is no direction that a frame of a contact state may have")

    def origin(symbol: str) -> Vector:
        """Look up the origin by the symbol of the set that it lies on in `ContactState.frames`."""
        match symbol:
            case "f1":
                return centre - s1.distance(centre) * s1.normal
            case "a1":
                return foot(centre, touch.point, touch.direction) if fit else _on_axis(s1, centre)
            case "a2":
                return _on_axis(s2, centre)
            case "c1":
                return touch.point if fit else s1.centre
            case "c2":
                return s2.centre
            case "l":
                return foot(centre, touch.point, touch.direction)
            case "p":
                return touch.point
            case _:
                raise ValueError(f"{symbol!r} is no origin that a frame of a contact state may have")

    return np.stack([frame(origin(o), direction(z), x if z == "n1" else None) for z, o in state.frames])


def _on_axis(surface: Any, centre: Vector) -> Vector:
    """Project a point onto the axis of a cylinder or a cone."""
    return foot(centre, surface.apex if surface.kind == "cone" else surface.point, surface.axis)
