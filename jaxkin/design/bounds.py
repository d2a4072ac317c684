"""A variable of a design: its name, where it starts, and between which bounds it may change."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from jaxkin._arguments import exact_numbers

ROUNDING = 1e-9
"""Share of the numbers that a start was made of by which it may be outside of its bounds, and is moved onto them."""


@dataclass(frozen=True)
class Free:
    """Numbers to be chosen: where they start and between which bounds. Arrays of one shape, or numbers for all."""

    start: Any
    lower: Any
    upper: Any


@dataclass(frozen=True)
class Entry:
    """The name of a variable; nothing here is a number."""

    group: str
    key: Any
    shape: tuple[int, ...]
    ties: tuple[tuple[Any, Callable | None], ...] = ()
    """Further keys of the group that take this value, or a function of it."""


class Bounded(NamedTuple):
    """A variable with its numbers, all of its shape."""

    entry: Entry
    start: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def free_between(what: str, bounds: Any, now: Any) -> Free:
    """Return bounds as numbers to be chosen: a pair (lower, upper) starts at `now`, a `Free` has a start of its own.

    Raises ValueError for what is neither; `what` begins the message.
    """
    if isinstance(bounds, Free):
        return bounds
    try:
        lower, upper = bounds
    except (TypeError, ValueError):
        raise ValueError(f"{what}: give its bounds as (lower, upper), got {bounds!r}") from None
    return Free(now, lower, upper)


def bounded_entry(group: str, key: Any, free: Free, what: str = "", size: float = 0.0) -> Bounded:
    """Make a variable of a group ("lengths", "points", "inputs", "extras") with its start and its bounds.

    A start outside of its bounds by rounding is moved onto them: of numbers as large as the bounds, and of those of the
    mechanism, of this `size` in the same unit, that the start was measured with. Raises ValueError for numbers of
    different shapes, bounds in the wrong order, a start beyond them, and NaN and infinity; `what` begins the message.
    """
    what = what or f"{group[:-1]} {key!r}"
    try:
        start, lower, upper = (exact_numbers(value, what) for value in (free.start, free.lower, free.upper))
        start, lower, upper = (np.array(array) for array in np.broadcast_arrays(start, lower, upper))
    except (TypeError, ValueError):
        raise ValueError(f"{what}: start and bounds must be numbers of one shape, got {free!r}") from None
    if not all(np.all(np.isfinite(array)) for array in (start, lower, upper)):
        raise ValueError(f"{what}: start and bounds must be finite numbers, got {_said(start, lower, upper)}")
    if np.any(lower > upper):
        raise ValueError(f"{what}: the lower bound is above the upper one, {_said(start, lower, upper)}")
    slack = ROUNDING * (size + np.abs(upper) + np.abs(lower))
    if np.any(start < lower - slack) or np.any(start > upper + slack):
        raise ValueError(
            f"{what}: the bounds exclude the start, {_said(start, lower, upper)}; widen them, or give another start as "
            "jk.design.Free(start, lower, upper)"
        )
    return Bounded(Entry(group, key, start.shape), np.clip(start, lower, upper), lower, upper)


def _said(start, lower, upper) -> str:
    return f"start {np.round(start, 6).tolist()}, bounds {np.round(lower, 6).tolist()} to {np.round(upper, 6).tolist()}"
