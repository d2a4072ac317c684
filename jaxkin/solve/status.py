"""The status of a pose, and the closure residuals that decide it.

| precedence | status | when |
|---|---|---|
| 1 | NONFINITE | the residual is NaN or infinite |
| 2 | CLOSED | the residual is at most the tolerance, on the branch of the assembled pose |
| 2 | JUMPED | the residual is at most the tolerance, and no way that was tried leads there: see below |
| 3 | UNREACHABLE | the residual is above the tolerance and stationary: no small displacement lessens it |
| 4 | STALLED | none of these: the solver stopped on its way |

A pose of one input that is JUMPED is on another branch: what lies between cannot be passed. Several inputs can go to
their values in any number of ways, of which a sweep tries four at most, so that such a pose may still be on the branch.

`classify` gives a pose the status of the first row that holds. The status is then changed in these cases, in turn:

- STALLED, whatever the residual: the trace of the branch ran out of steps before it got to the input of the pose
  (`range.polish`). Of several inputs, such a pose is then tried along other paths (`range.other_paths`).
- STALLED in place of CLOSED or JUMPED: correctors improve no pose below the rounding that is left of its residual, and
  that is above the tolerance (`range.solve_range.find_poses`).
- STALLED in place of CLOSED or JUMPED: the pose is that of a formula, and whether the motion leads to it is in doubt
  (`closed_form.range_by_formula`). Where JAX traces nothing, the continuation solves the range instead.
- STALLED in place of UNREACHABLE or JUMPED: the assembled pose is a dead point of the drive (`in_doubt`).
- MISFIT in place of CLOSED: the given joints disagree, the loops were solved with the nearest joints that agree, and
  the residual of the given joints is above the tolerance (`correctors.least_residual`).
- The worst of several loop groups: see `SEVERITY`.
- JUMPED in place of CLOSED or MISFIT: an earlier chunk of a stream left the branch (`mechanism.stream`).
- LIMITED in place of CLOSED: a coordinate is beyond the limits of its joint (`mechanism.joint_limits`). The loops are
  closed, on the branch of the assembled pose, so that effects and derivatives are those of any closed pose.
- NONFINITE: an input of the pose is NaN or infinite (`linkage.coordinates.with_finite_inputs` puts a finite input
  in its place, `mechanism.collect` sets the status).

The reference methods (`reference_methods.minimise`: DFP, BFGS and others) do not use the table. They report CLOSED,
STALLED and NONFINITE only: no JUMPED, because they trace no branch, so that a CLOSED pose may be on another branch; and
no UNREACHABLE, because they do not test whether the residual is stationary.

Results that are no sweep say of their poses in their own docstrings what a status means there: projections, inverse
problems, assembly modes and workspaces.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int


class Status(IntEnum):
    """What became of one pose.

    Whether a pose counts as closed is decided by its closure residual (Eq. 13). Whether a solver counts its own
    iteration as converged, because its steps became short, plays no part.
    """

    CLOSED = 0
    UNREACHABLE = 1
    JUMPED = 2
    STALLED = 3
    NONFINITE = 4
    MISFIT = 5
    LIMITED = 6

    @property
    def message(self) -> str:
        """Say in words what the status means, and what to do about it."""
        return _MESSAGES[self]


_MESSAGES = {
    Status.CLOSED: "all loops closed, on the branch of the assembled pose",
    Status.UNREACHABLE: "the loops cannot close for this input: leave it out of the range, or change the lengths",
    Status.JUMPED: "closed, but no way that was tried leads there from the assembled pose: on another branch, unless "
    "several inputs get there by another way",
    Status.STALLED: "not converged: give more poses in between, start from a pose that is less singular, or ask "
    "for a tolerance that rounding can reach",
    Status.MISFIT: "closed as nearly as the joints agree, on the branch of the assembled pose: the notes of the "
    "mechanism say which of them disagree",
    Status.LIMITED: "all loops closed, on the branch of the assembled pose, but a joint is beyond its limits: keep the "
    "range within what jk.limits finds, or give the joint other limits",
    Status.NONFINITE: "the input or the geometry holds NaN or infinity: correct it",
}

SEVERITY = (
    Status.CLOSED,
    Status.LIMITED,
    Status.MISFIT,
    Status.JUMPED,
    Status.UNREACHABLE,
    Status.STALLED,
    Status.NONFINITE,
)
"""All statuses from the best to the worst. A pose of a mechanism has the worst of the statuses that its loop
groups have: a pose that is useless for one of them is useless for the mechanism."""


def severity(status: Int[Array, " poses"]) -> Int[Array, " poses"]:
    """Look up the places of statuses, given by their values, in `SEVERITY`."""
    return jnp.array([SEVERITY.index(each) for each in Status], jnp.int32)[status]


def of_severity(place: Int[Array, " poses"]) -> Int[Array, " poses"]:
    """Look up the values of the statuses at places in `SEVERITY`."""
    return jnp.array([each.value for each in SEVERITY], jnp.int32)[place]


Scalar = Float[Array, ""] | Float[np.ndarray, ""]


class ClosureTolerance(NamedTuple):
    """The residual norms that a sweep asks for (square root of Eq. 12, lengths over the characteristic length).

    Both may be traced by JAX: another tolerance compiles nothing anew.
    """

    max_residual: Scalar
    """Largest residual norm of a closed pose."""
    target_residual: Scalar
    """Residual norm at which correctors stop improving a pose."""


CLOSED_ROUNDINGS = 64
"""Largest residual norm, in units of rounding, of a pose that a correction has closed: poses above it are passed on to
a method that costs more."""


def default_tolerance(dtype) -> float:
    """Return the largest residual norm of a closed pose if the user asks for none: 1e-12, or 2e-6 in float32.

    Residual norms are square roots of Eq. 12, lengths over the characteristic length. Rounding leaves about 1e-15 for
    each elementary motion in float64 (5e-7 in float32); the rest is a margin for loops of many joints.
    """
    return 1e-12 if jnp.finfo(dtype).bits == 64 else 2e-6


def rounding_residual(dtype, units: int) -> float:
    """Return a residual norm of `units` units of rounding of `dtype`, but at most a tenth of `default_tolerance`.

    The limit counts in float32, where the default tolerance is only 17 units of rounding.
    """
    return min(units * float(jnp.finfo(dtype).eps), 0.1 * default_tolerance(dtype))


def classify(
    residual_norm: Float[Array, " poses"],
    stationary: Bool[Array, " poses"],
    same_branch: Bool[Array, " poses"],
    max_residual: Scalar | float | None = None,
) -> Int[Array, " poses"]:
    """Decide the status of each pose by the table of this module.

    `residual_norm` is the square root of Eq. 12, lengths over the characteristic length; `stationary` says at which
    poses no small displacement lessens it; `same_branch` says which poses, if closed, are on the branch of the
    assembled pose; `max_residual` is the largest residual norm of a closed pose, by default `default_tolerance`.
    """
    closed = residual_norm <= (default_tolerance(residual_norm.dtype) if max_residual is None else max_residual)
    status = jnp.where(stationary, Status.UNREACHABLE.value, Status.STALLED.value)
    status = jnp.where(closed, jnp.where(same_branch, Status.CLOSED.value, Status.JUMPED.value), status)
    return jnp.where(jnp.isfinite(residual_norm), status, Status.NONFINITE.value).astype(jnp.int32)


CLOSED_ON_BRANCH = (Status.CLOSED.value, Status.LIMITED.value)
"""Of poses with all loops closed on the branch of the assembled pose, within limits of joints or not."""


def is_closed_on_branch(status: Int[Array, " poses"]) -> Bool[Array, " poses"]:
    """Tell which poses are `CLOSED_ON_BRANCH`."""
    closed, limited = CLOSED_ON_BRANCH
    return (status == closed) | (status == limited)


def closes_before_limits(status: Int[Array, " poses"]) -> Bool[Array, " poses"]:
    """Tell which poses are CLOSED or JUMPED: for statuses of the solver, which has not looked at limits yet."""
    return (status == Status.CLOSED.value) | (status == Status.JUMPED.value)


def in_doubt(status: Int[Array, " poses"]) -> Int[Array, " poses"]:
    """Replace UNREACHABLE and JUMPED by STALLED: what follows from a dead point in the assembled pose is not known.

    The residual is stationary there although the loops may close, and of two branches neither is that of the pose.
    """
    doubtful = (status == Status.UNREACHABLE.value) | (status == Status.JUMPED.value)
    return jnp.where(doubtful, Status.STALLED.value, status)
