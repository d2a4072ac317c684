"""Constraints of designs by an augmented Lagrangian, in its form as a shifted penalty.

With margins g >= 0 and the shifts s = multiplier / (2 weight), each search minimises

    loss + weight * sum(max(s - g, 0)^2)

whose slope at a design is that of the Lagrangian with the multipliers 2 weight max(s - g, 0). These are taken for the
next search, s <- max(s - g, 0), until they are settled: then the design breaks no constraint, and only constraints that
it touches have multipliers (Hestenes 1969, Powell 1969, Rockafellar 1973). A penalty without shifts would have to be
infinitely stiff for that. The shifted penalty is a sum of squares, as Levenberg-Marquardt steps ask for.

Closure residuals and misfits of parts have no inside, which would tell how far a design is from not closing: they have
no shifts, and become small only by a stiffer penalty.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Bool, Float

MET = 1e-6
"""Root of the sum of squares of all violations (they are without unit) below which a design counts as feasible."""
STIFFER = 10.0
"""What the weight of a start is multiplied by where its violations fell by too little since the search before."""
ENOUGH = 0.25
"""Share of the violations of the search before, above which they fell by too little."""


class Penalty(NamedTuple):
    """Weight and shifts of the penalty, of each start or, without the leading axes, of one."""

    weight: Float[np.ndarray, " starts"] | Any
    shifts: Float[np.ndarray, "starts constraints"] | Any
    """Multipliers over twice the weight, without unit as the constraints are."""

    @classmethod
    def plain(cls, weight: float, starts: int, constraints: int) -> Penalty:
        """Make the penalty of the first search, without multipliers."""
        return cls(np.full(starts, weight), np.zeros((starts, constraints)))


class Verdict(NamedTuple):
    """The losses of some designs, and what they violate."""

    losses: Float[np.ndarray, " starts"]
    """Without penalty; nan where not finite."""
    gaps: Float[np.ndarray, "starts gaps"]
    """Closure residuals and misfits of parts, zero where all is well."""
    charged: Float[np.ndarray, "starts constraints"]
    """max(shift - margin, 0)."""
    shifts: Float[np.ndarray, "starts constraints"]

    @property
    def violations(self) -> Float[np.ndarray, " starts"]:
        """Roots of the sums of squares of gaps and of what constraints lack."""
        lacks = np.maximum(self.charged - self.shifts, 0.0)
        return np.sqrt(np.sum(self.gaps**2, axis=1) + np.sum(lacks**2, axis=1))

    @property
    def unsettled(self) -> Float[np.ndarray, " starts"]:
        """Roots of the sums of squares of gaps and of what the shifts change by: the violations, and the margins of
        constraints that still have multipliers."""
        return np.sqrt(np.sum(self.gaps**2, axis=1) + np.sum((self.charged - self.shifts) ** 2, axis=1))

    def least(self, weight: Float[np.ndarray, " starts"]) -> Float[np.ndarray, " starts"]:
        """Estimate from below the loss at which each start will meet its constraints: its augmented Lagrangian."""
        squares = np.sum(self.gaps**2, axis=1) + np.sum(self.charged**2 - self.shifts**2, axis=1)
        return np.where(np.isfinite(self.losses), self.losses, np.inf) + weight * squares


def renewed(penalty: Penalty, verdict: Verdict, before: Float[np.ndarray, " starts"]) -> Penalty:
    """Compute the penalty of the next search from where the last one ended, and from what was unsettled before it."""
    stiffer = np.where(verdict.unsettled > ENOUGH * before, STIFFER, 1.0)
    return Penalty(penalty.weight * stiffer, verdict.charged / stiffer[:, None])


def worth_more(penalty: Penalty, verdict: Verdict) -> Bool[np.ndarray, " starts"]:
    """Find the starts that are not settled, and may still meet their constraints below the best feasible loss."""
    feasible = (verdict.violations <= MET) & np.isfinite(verdict.losses)
    least = np.min(verdict.losses[feasible], initial=np.inf)
    return (verdict.unsettled > MET) & (verdict.least(penalty.weight) < least)
