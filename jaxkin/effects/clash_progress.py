"""How far a search for clashes has come, and beforehand whether it will take long, and what would take less."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from time import perf_counter
from types import TracebackType

from jaxkin._progress import ProgressBar

_LONG = 120.0
"""Seconds from which on a search that is left is told to take long."""
_CALLER = 4
"""Levels of calls from the warning up to the caller of `clashes`."""


class ClashProgress:
    """Tells how far a search has come: by a bar, as `wanted`, or to a function of what is done and the total."""

    def __init__(self, wanted: bool | Callable[[int, int], None] | None, advice: str):
        self._told = wanted if callable(wanted) else None
        self._bar = ProgressBar(1, False if callable(wanted) else wanted, "clashes")
        self._advice = advice
        self._warned = False

    def __enter__(self) -> ClashProgress:
        self._begun = perf_counter()
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._bar.close()

    def __call__(self, done: int, total: int) -> None:
        """Tell that so many placements of pairs of parts are searched; warn once where the others will take long."""
        left = (perf_counter() - self._begun) * (total - done) / done
        if left > _LONG and not self._warned:
            self._warned = True
            warnings.warn(
                f"clashes will take about {left / 60:.0f} min more, for {total - done} of {total} placements of two "
                f"parts that come near each other: {self._advice}",
                stacklevel=_CALLER,
            )
        if self._told:
            self._told(done, total)
        self._bar.show(done, "clashes", total)
