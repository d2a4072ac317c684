"""What numbers that belong to the poses of a motion are drawn over: its drive, where that tells the poses apart."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._arguments import numbers
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


def drive_axis(motion: Motion, times: Any = None) -> PoseAxis | None:
    """Find the axis of a chart over the poses of a motion: `times`, one a pose, or the one displacement that its drive
    changes.

    None where several change, or where the one turns back or rests: then only the numbers of the poses tell them apart.
    Raises ValueError for times of another number than that of the poses.
    """
    if times is not None:
        values = np.asarray(numbers(times, "the times of a chart"))
        if values.shape != (len(motion),):
            raise ValueError(f"a chart needs one time for each of the {len(motion)} poses, got shape {values.shape}")
        return PoseAxis(values, "time")
    shown = _telling_input(motion)
    return None if shown is None else shown.axis()


def pose_names(motion: Motion) -> Callable[[int | np.integer[Any]], str]:
    """Make the function that names a pose, by its number and by what its drive is there: "pose 30 (90 deg)"."""
    shown = _telling_input(motion)
    if shown is None:
        return lambda pose: f"pose {pose}"
    return lambda pose: f"pose {pose} ({f'{shown.values[pose]:.4g} {shown.unit}'.rstrip()})"


def _telling_input(motion: Motion) -> ShownInput | None:
    """Find the one displacement that tells all poses of a motion apart, since it alone changes, and only rises or only
    falls; None without such."""
    steps = {key: np.diff(np.asarray(values, float)) for key, values in motion.inputs.items()}
    changed = [key for key, each in steps.items() if np.any(each != 0)]
    if len(changed) != 1:
        return None
    (key,) = changed
    if not (np.all(steps[key] > 0) or np.all(steps[key] < 0)):
        return None
    return shown_input(motion, key, np.asarray(motion.inputs[key], float))
