"""The status of a pose, and the closure residuals that decide it.

| precedence | status | when |
|---|---|---|
| 1 | NONFINITE | the residual is NaN or infinite |
| 2 | CLOSED | the residual is at most the tolerance, on the branch of the assembled pose |
| 2 | JUMPED | the residual is at most the tolerance, on another branch |
| 3 | UNREACHABLE | the residual is above the tolerance and stationary: no small displacement lessens it |
| 4 | STALLED | none of these: the solver stopped on its way |

The first row that holds is the status of the pose (`classify`). MISFIT replaces CLOSED after that, where the loops of
joints that disagree were solved with the nearest joints that agree, and the residual of the joints that were given is
above the tolerance. Of several structure elements the worst decides: see `SEVERITY`.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int


class Status(IntEnum):
    """Status of one pose, decided by the closure residual (Eq. 13), not by the convergence test of a solver."""

    CLOSED = 0
    UNREACHABLE = 1
    JUMPED = 2
    STALLED = 3
    NONFINITE = 4
    MISFIT = 5

    @property
    def message(self) -> str:
        """What the status means, and what to do about it."""
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

SEVERITY = (Status.CLOSED, Status.MISFIT, Status.JUMPED, Status.UNREACHABLE, Status.STALLED, Status.NONFINITE)
"""All statuses from the best to the worst. A pose has the worst of the statuses of its structure elements: what makes
it useless for one of them makes it useless for the mechanism."""

Scalar = Float[Array, ""] | Float[np.ndarray, ""]


class ClosureTolerance(NamedTuple):
    """The closure residuals that a sweep asks for, lengths over the characteristic length. Traced, not static."""

    max_residual: Scalar
    """Largest residual of a closed pose."""
    target_residual: Scalar
    """Residual at which a pose is improved no further."""


def default_tolerance(dtype) -> float:
    """Largest closure residual (Eq. 12, lengths over the characteristic length) of a closed pose: what rounding allows.

    Rounding leaves about 1e-15 for each elementary motion in float64 (5e-7 in float32); the margin is for loops of many
    joints.
    """
    return 1e-12 if jnp.finfo(dtype).bits == 64 else 2e-6


def rounding_residual(dtype, units: int) -> float:
    """`units` times the unit of rounding, but at most a tenth of the default tolerance: float32 has few to spare."""
    return min(units * float(jnp.finfo(dtype).eps), 0.1 * default_tolerance(dtype))


def classify(
    residual_norm: Float[Array, " poses"],
    stationary: Bool[Array, " poses"],
    same_branch: Bool[Array, " poses"],
    max_residual: Scalar | float | None = None,
) -> Int[Array, " poses"]:
    """Decide the status of poses by the table of this module.

    `residual_norm` is the square root of Eq. 12; `stationary` says where no small displacement lessens it;
    `max_residual` is the largest residual of a closed pose, by default `default_tolerance`.
    """
    closed = residual_norm <= (default_tolerance(residual_norm.dtype) if max_residual is None else max_residual)
    status = jnp.where(stationary, Status.UNREACHABLE.value, Status.STALLED.value)
    status = jnp.where(closed, jnp.where(same_branch, Status.CLOSED.value, Status.JUMPED.value), status)
    return jnp.where(jnp.isfinite(residual_norm), status, Status.NONFINITE.value).astype(jnp.int32)


def is_closed(status: Int[Array, " poses"]) -> Bool[Array, " poses"]:
    """Tell which poses have all loops closed, on whichever branch."""
    return (status == Status.CLOSED.value) | (status == Status.JUMPED.value)
