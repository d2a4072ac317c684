"""What became of a pose."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int


class Status(IntEnum):
    """Status of one pose, decided by the closure residual (Eq. 13), not by the solver's own opinion."""

    CLOSED = 0
    UNREACHABLE = 1
    JUMPED = 2
    STALLED = 3
    NONFINITE = 4
    MISFIT = 5

    @property
    def message(self) -> str:
        """What it means, and what to do about it."""
        return _MESSAGES[self]


_MESSAGES = {
    Status.CLOSED: "all loops closed, on the branch of the assembled pose",
    Status.UNREACHABLE: "the loops cannot close for this input: leave it out of the range, or change the lengths",
    Status.JUMPED: "closed, but on another branch than the assembled pose: the range between them cannot be passed",
    Status.STALLED: "not converged: give more poses in between, or start from a pose that is less singular",
    Status.MISFIT: "closed as nearly as the joints agree, on the branch of the assembled pose: the notes of the "
    "mechanism say which of them disagree",
    Status.NONFINITE: "the input or the geometry holds NaN or infinity: correct it",
}


def tolerance(dtype) -> float:
    """Largest closure residual (Eq. 12, lengths over the characteristic length) of a closed pose: what rounding allows.

    Rounding leaves about 1e-15 a movement in float64 (5e-7 in float32); the margin is for loops of many joints.
    """
    return 1e-12 if jnp.finfo(dtype).bits == 64 else 2e-6


def roundings(dtype, times: int) -> float:
    """So many units of rounding, but less than a closed pose may have as its residual: float32 has few to spare."""
    return min(times * float(jnp.finfo(dtype).eps), 0.1 * tolerance(dtype))


Scalar = Float[Array, ""] | Float[np.ndarray, ""]


class Tolerance(NamedTuple):
    """What closure is asked for."""

    closed: Scalar
    """Largest gap of a closed pose."""
    enough: Scalar
    """A pose whose gap is not larger is not improved any more; zero: down to rounding."""


def classify(
    gap: Float[Array, " poses"],
    stationary: Bool[Array, " poses"],
    same_branch: Bool[Array, " poses"],
    largest: Scalar | float | None = None,
) -> Int[Array, " poses"]:
    """The status of poses; the first cause in the order NONFINITE, CLOSED or JUMPED, UNREACHABLE, STALLED wins.

    `largest` is the gap of a closed pose, that of `tolerance` if not given.
    """
    closed = gap <= (tolerance(gap.dtype) if largest is None else largest)
    status = jnp.where(stationary, Status.UNREACHABLE.value, Status.STALLED.value)
    status = jnp.where(closed, jnp.where(same_branch, Status.CLOSED.value, Status.JUMPED.value), status)
    return jnp.where(jnp.isfinite(gap), status, Status.NONFINITE.value).astype(jnp.int32)


def is_closed(status: Int[Array, " poses"]) -> Bool[Array, " poses"]:
    """Whether all loops close, on whichever branch."""
    return (status == Status.CLOSED.value) | (status == Status.JUMPED.value)
