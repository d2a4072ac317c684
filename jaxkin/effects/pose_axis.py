"""What numbers that belong to the poses of a motion are drawn over: its drive, where that tells the poses apart."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.movements import is_length

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion


class PoseAxis(NamedTuple):
    """Numbers along the horizontal axis of a chart, one a pose, and what they are."""

    values: Float[np.ndarray, " poses"]
    label: str


class ShownInput(NamedTuple):
    """One driven displacement, as people read it."""

    name: str
    """The joint, with the coordinate where the joint has several."""
    values: Float[np.ndarray, " poses"]
    """In degrees or in the unit of the mechanism."""
    unit: str
    """"deg", that of the mechanism, or "" where it is not known."""

    def axis(self) -> PoseAxis:
        """Make the axis along which the displacement grows."""
        return PoseAxis(self.values, f"{self.name} ({self.unit})" if self.unit else self.name)


def shown_input(motion: Motion, full_name: str, values: Float[np.ndarray, " poses"]) -> ShownInput:
    """Turn displacements of the coordinate "joint.coordinate", radians or lengths, into what people read."""
    joint, _, coordinate = full_name.rpartition(".")
    name = joint if len(motion.mechanism.joints[joint].coordinates) == 1 else full_name
    if is_length(coordinate):
        return ShownInput(name, values, motion.mechanism.unit)
    return ShownInput(name, np.rad2deg(values), "deg")


def drive_axis(motion: Motion) -> PoseAxis | None:
    """Find the axis of a chart over the poses of a motion: that of the one displacement which its drive changes.

    None where several change, or where the one turns back or rests: then only the numbers of the poses tell them apart.
    """
    steps = {key: np.diff(np.asarray(values, float)) for key, values in motion.inputs.items()}
    changed = [key for key, each in steps.items() if np.any(each != 0)]
    if len(changed) != 1:
        return None
    (key,) = changed
    if not (np.all(steps[key] > 0) or np.all(steps[key] < 0)):
        return None
    return shown_input(motion, key, np.asarray(motion.inputs[key], float)).axis()
