"""Driven displacements in words: degrees for angles, the unit of the mechanism for lengths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin._names import counted
from jaxkin.effects.pose_axis import shown_input
from jaxkin.geometry.units import unit_name
from jaxkin.solve.status import Status

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

MAX_TOLD_INPUTS = 3
"""Driven displacements that are told; there may be many, and no place for them."""


@dataclass(frozen=True, eq=False)
class Input:
    """One driven displacement, as people read it."""

    name: str
    """The joint, with the coordinate where the joint has several."""
    values: Float[np.ndarray, " poses"]
    """In degrees or in the unit of the mechanism."""
    suffix: str
    """The unit, with the space that belongs before it."""

    def at(self, pose: int) -> str:
        """Write the value at a pose with its unit, rounded to 0.1 degree or to four digits; with a true minus sign."""
        value = float(self.values[pose])
        number = f"{value:.1f}".removesuffix(".0") if self.suffix == "°" else f"{value:.4g}"
        return f"{'0' if number == '-0' else number.replace('-', chr(0x2212))}{self.suffix}"


def inputs(motion: Motion) -> tuple[Input, ...]:
    """Return the driven displacements of a motion, in its order."""
    return tuple(_input(motion, key, np.asarray(values, float)) for key, values in motion.inputs.items())


def named(inputs: tuple[Input, ...], pose: int) -> str:
    """Write the driven displacements at a pose, with their names; of many the first ones."""
    return _some([f"{entry.name} {entry.at(pose)}" for entry in inputs], ", ")


def title(inputs: tuple[Input, ...], pose: int) -> str:
    """Write the bare value where a single joint is driven, otherwise as `named`."""
    return values(inputs, pose) if len(inputs) == 1 else named(inputs, pose)


def values(inputs: tuple[Input, ...], pose: int) -> str:
    """Write the driven displacements at a pose without their names, in the order of the headline; of many the first."""
    return _some([entry.at(pose) for entry in inputs], ", ")


def headline(motion: Motion) -> tuple[str, str]:
    """Tell what drives the motion over which range, and how many of its poses were not closed or lost contact."""
    drives = _some([f"{entry.name}, {_range(entry)}" for entry in inputs(motion)], "; ")
    status = np.asarray(motion.status)[~np.asarray(motion.on_branch)]
    facts = [counted(len(motion), "pose")]
    if len(status):
        codes, numbers = np.unique(status, return_counts=True)
        causes = (f"{number} {Status(code).name.lower()}" for code, number in zip(codes, numbers, strict=True))
        facts.append(f"not drawn: {', '.join(causes)}")
    if limited := np.sum(np.any([over != 0 for over in motion.beyond_limits.values()], axis=0)):
        facts.append(f"beyond joint limits at {limited}")
    if lost := np.sum(np.any([each.loose for each in motion.lost_contacts], axis=0)):
        facts.append(f"contact lost at {lost}")
    facts.append(f"lengths in {unit_name(motion.mechanism.unit) or 'the unit of the input'}")
    return f"Motion driven by {drives}", "  ·  ".join(facts)


def _some(texts: list[str], comma: str) -> str:
    more = len(texts) - MAX_TOLD_INPUTS
    return comma.join(texts) if more <= 0 else f"{comma.join(texts[:MAX_TOLD_INPUTS])} and {more} more"


def _range(entry: Input) -> str:
    finite = np.flatnonzero(np.isfinite(entry.values))
    if not len(finite):
        return "nowhere"
    low, high = (entry.at(int(finite[pick(entry.values[finite])])) for pick in (np.argmin, np.argmax))
    return low if low == high else f"{low} to {high}"


def _input(motion: Motion, key: str, values: Float[np.ndarray, " poses"]) -> Input:
    shown = shown_input(motion, key, values)
    return Input(shown.name, shown.values, "°" if shown.unit == "deg" else f" {shown.unit}".rstrip())
