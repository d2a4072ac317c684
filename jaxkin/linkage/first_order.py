"""Write the closure of loops at first order, as linear equations for the rates of their joints (numpy, on the host)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.joints.joint import JointCoordinate
from jaxkin.joints.screws import Screws


class Thresholds(NamedTuple):
    """The numbers below which quantities of a mechanism count as zero, for one floating-point precision.

    Lengths are divided by the characteristic length of the loops.
    """

    residual: float
    """Largest closure residual (square root of Eq. 12) of a pose whose loops count as closed."""
    rank: float
    """Largest singular value of a closure Jacobian, over the largest of all, that counts as zero. Mobility, plan and
    sweep agree on the rank, because the solver damps its least-norm steps by the square of this number."""
    rate: float
    """Largest rate of a coordinate, in a motion of unit norm, that counts as rest."""


RESIDUAL_TOLERANCE = 1e-11
"""`Thresholds.residual` in float64: ten times the residual at which a sweep calls a pose closed, 1e-12."""
RANK_TOLERANCE = 1e-7
"""`Thresholds.rank` in float64. Seven times the least that is possible: singular values of J below 1.5e-8, the root of
one unit of rounding, are rounding in J J^T, from which least-norm steps are computed. Its square, 45 units of rounding,
is the damping of J J^T. Singular values of sound designs are far larger, above `LARGEST_UNCERTAIN`."""
RATE_TOLERANCE = 2e-5
"""`Thresholds.rate` in float64: four times the rounding of numbers of six digits, 5e-6. Frames of a part with an idle
motion (a leg that slides along its line) may stay rounded so, since its loops move without exact alignment."""
DOUBLE = Thresholds(RESIDUAL_TOLERANCE, RANK_TOLERANCE, RATE_TOLERANCE)
"""Thresholds for mechanisms in float64."""

RESIDUAL_TOLERANCE_SINGLE = 1e-5
"""`Thresholds.residual` in float32: five times the residual at which a sweep calls a pose closed, 2e-6."""
RANK_TOLERANCE_SINGLE = 1e-3
"""`Thresholds.rank` in float32: three times the root of one unit of rounding, 3.5e-4."""
RATE_TOLERANCE_SINGLE = 1e-3
"""`Thresholds.rate` in float32: that of the rank, since motions found with it are uncertain by as much."""
SINGLE = Thresholds(RESIDUAL_TOLERANCE_SINGLE, RANK_TOLERANCE_SINGLE, RATE_TOLERANCE_SINGLE)
"""Thresholds for mechanisms in float32."""

SPREAD = 30.0
"""How large a singular value of a closure Jacobian (relative to the largest) may result from an error of the frames, as
a multiple of that error: sums of a few lever arms, each of the characteristic length."""
LARGEST_UNCERTAIN = 0.03
"""Singular values above this, relative to the largest, count in the rank whatever the error of the frames: those of
sound designs are larger."""

EQUATIONS = 6
"""Independent closure equations of a loop at most, of the twelve of Eq. 11: three of rotation, three of translation."""
IN_SUBGROUP = 3
"""Independent equations of a planar loop at most, one of rotation and two of translation; and of a spherical loop, all
three of rotation."""

Columns = tuple[JointCoordinate, ...]
"""Coordinates of joints in some order, such as that of the columns of a Jacobian."""


def loop_jacobian(
    loops: Sequence[Sequence[tuple[int, int]]], columns: Columns, screws: Screws
) -> Float[np.ndarray, "equations columns"]:
    """Assemble the closure Jacobian: for each loop six rows that say that the twists of its joints add up to zero.

    `loops` are (joint, sign) in order of travel, `columns` are (joint, coordinate), and `screws` (6, columns) are the
    unit twists of the coordinates, angular velocity first. A joint that is travelled backwards counts with sign -1.
    """
    rows = np.zeros((len(loops), 6, len(columns)))
    of_joint: dict[int, list[int]] = {}
    for column, (joint, _) in enumerate(columns):
        of_joint.setdefault(joint, []).append(column)
    for row, loop in zip(rows, loops, strict=True):
        for joint, sign in loop:
            row[:, of_joint.get(joint, [])] = sign * screws[:, of_joint.get(joint, [])]
    return rows.reshape(len(loops) * EQUATIONS, len(columns))


def null_space(
    matrix: Float[np.ndarray, "rows columns"], least: float
) -> tuple[int, Float[np.ndarray, "free columns"]]:
    """Return the rank of a Jacobian and an orthonormal basis of its null space, one vector a row.

    Singular values that are at most `least` times the largest count as zero.
    """
    if not matrix.shape[0]:
        return 0, np.eye(matrix.shape[1])
    values, directions = _right(matrix)
    rank = int((values > least * values[0]).sum()) if values.size else 0
    return rank, directions[rank:]


def without(
    motions: Float[np.ndarray, "n columns"], resting: Sequence[int], thresholds: Thresholds
) -> Float[np.ndarray, "m columns"]:
    """Return a basis of those combinations of motions in which the columns `resting` have a rate of zero."""
    values, mixes = _right(motions[:, list(resting)].T)
    return mixes[int((values > thresholds.rate).sum()) :] @ motions


def independent(motions: Float[np.ndarray, "freedoms columns"], columns: Sequence[int], thresholds: Thresholds) -> int:
    """Count the rates of these columns that the motions allow independently of each other."""
    return int((np.linalg.svd(motions[:, list(columns)], compute_uv=False) > thresholds.rate).sum())


def _right(matrix: Float[np.ndarray, "rows columns"]) -> tuple[np.ndarray, Float[np.ndarray, "columns columns"]]:
    """Compute singular values and all right singular vectors, one a row; the left ones may be many more."""
    _, values, directions = np.linalg.svd(matrix, full_matrices=matrix.shape[0] < matrix.shape[1])
    return values, directions
