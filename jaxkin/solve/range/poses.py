"""The poses that were found."""

from __future__ import annotations

from typing import NamedTuple

from jaxtyping import Array, Float, Int

from jaxkin.solve.system.state import State

MAX_CORRECTION = 0.1
"""Largest distance of a corrected pose from its prediction, radians or characteristic lengths, at which the pose is
trusted to be on the branch."""


class RangePoses(NamedTuple):
    """The poses that were found, without derivatives."""

    state: State
    status: Int[Array, " poses"]
    residual_norm: Float[Array, " poses"]
    """Square root of Eq. 12, lengths over the characteristic length."""
