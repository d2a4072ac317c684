"""Choices between what measures the same but for rounding: they must not depend on where an assembly is placed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")


def first_largest(some: Iterable[T], measure: Callable[[T], float], rounding: float) -> T:
    """Return the first of those whose measure is the largest but for `rounding`; there must be one at least."""
    each = list(some)
    measures = [measure(one) for one in each]
    most = max(measures)
    return next(one for one, size in zip(each, measures, strict=True) if size >= most - rounding)
