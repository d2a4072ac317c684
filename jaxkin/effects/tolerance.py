"""How far a length may be from its nominal value: plus and minus a limit, or a standard deviation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import jax
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import positive_number
from jaxkin._traced import traced

USUAL_LIMIT = 3.0
"""Limit of a normal deviation in standard deviations where none is said: 99.73 % of parts are within it."""


@dataclass(frozen=True)
class Tolerance:
    """How one length, or the place of a pin in its hole, deviates. Numbers are in the unit of the length, and may be
    traced by JAX."""

    limit: float | Array
    """The largest deviation that the worst case counts with."""
    deviation: float | Array
    """The standard deviation of a normal distribution; unused by an even one."""
    distribution: Literal["even", "normal"]
    """"even": all deviations up to the limit are as likely; "normal": the bell curve, not cut at the limit."""

    def standard_deviation(self, dimensions: int = 1) -> float | Array:
        """Compute the standard deviation of one component: of a length, or of a place evenly within a circle or a ball.

        A point evenly in a ball of n dimensions and radius t has the variance t^2 / (n + 2) along each of them.
        """
        return self.deviation if self.distribution == "normal" else self.limit / float(np.sqrt(dimensions + 2))

    def drawn(self, random: np.random.Generator, samples: int, dimensions: int = 1) -> Float[np.ndarray, "samples _"]:
        """Draw deviations, a row of `dimensions` components each."""
        if self.distribution == "normal":
            return np.asarray(self.deviation * random.standard_normal((samples, dimensions)))
        if dimensions == 1:
            return random.uniform(-self.limit, self.limit, (samples, 1))
        towards = random.standard_normal((samples, dimensions))
        towards /= np.linalg.norm(towards, axis=1, keepdims=True)
        return self.limit * random.uniform(size=(samples, 1)) ** (1 / dimensions) * towards

    def __str__(self) -> str:
        return f"± {self.limit:.4g}" if self.distribution == "even" else f"sigma {self.deviation:.4g}"


jax.tree_util.register_dataclass(Tolerance, data_fields=["limit", "deviation"], meta_fields=["distribution"])


def sigma(deviation: float | int | Array, limit: float | int | Array | None = None) -> Tolerance:
    """State that a length is normally distributed about its nominal value, as a tolerance of `jk.tolerances`.

    `deviation` is the standard deviation in the unit of the length (radians for angles), `limit` the deviation that the
    worst case counts with, by default three times as much. Raises ValueError for what is no positive number.
    """
    checked = _positive("the standard deviation", deviation)
    return Tolerance(USUAL_LIMIT * checked if limit is None else _positive("the limit", limit), checked, "normal")


def as_tolerance(what: str, given: Any) -> Tolerance:
    """Read a tolerance: a number is plus and minus that, evenly distributed. ValueError for what is none."""
    if isinstance(given, Tolerance):
        return given
    return Tolerance(_positive(f"the tolerance of {what}", given), 0.0, "even")


def named(key: Any) -> str:
    """Write the name of a length, or of the clearance of a joint."""
    return f"clearance of {key}" if isinstance(key, str) else " ".join(map(str, key))


def _positive(what: str, given: Any) -> float | Array:
    """Check a tolerance or what it is made of; ValueError for what is no positive number. Traced ones stay so."""
    expected = "a positive number, as 0.05 for plus and minus 0.05, or jk.sigma(0.02)"
    number = positive_number(given, what, expected)
    return number if traced(number) else float(number)
