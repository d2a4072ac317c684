"""How `optimize` goes downhill, and when it stops."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class _Search:
    """When a search stops, and what it pays for designs that cannot move."""

    iterations: int = 300
    """Iterations at most."""
    tolerance: float = 1e-9
    """A start retires when its loss falls by less than this, relative, over ten iterations."""
    target: float | None = None
    """Loss of a feasible design at which the search ends; None for none."""
    penalty: float | None = None
    """Weight of violations; None for a hundred times the median of the absolute losses of the starts."""

    def __post_init__(self) -> None:
        name = type(self).__name__
        whole = isinstance(self.iterations, int | np.integer) and not isinstance(self.iterations, bool)
        if not whole or self.iterations < 1:
            raise ValueError(f"{name}: iterations must be a whole number from 1 on, got {self.iterations!r}")
        if not _is_number(self.tolerance) or self.tolerance < 0:
            raise ValueError(f"{name}: tolerance must be 0 or a positive number, got {self.tolerance!r}")
        if self.penalty is not None and (not _is_number(self.penalty) or self.penalty <= 0):
            raise ValueError(f"{name}: penalty must be a positive number or None, got {self.penalty!r}")
        if self.target is not None and not _is_number(self.target):
            raise ValueError(f"{name}: target must be a number or None, got {self.target!r}")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool) and bool(np.isfinite(value))


@dataclass(frozen=True)
class LevenbergMarquardt(_Search):
    """Damped Gauss-Newton steps, for losses that are sums of squared residuals: a dozen steps where L-BFGS takes
    hundreds."""


@dataclass(frozen=True)
class LBFGS(_Search):
    """Bounded L-BFGS, for losses that are one number."""


Optimiser = LevenbergMarquardt | LBFGS
