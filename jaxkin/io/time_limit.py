"""How long a file may be read: so many seconds for every file, and so many for each megabyte of it."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from pathlib import Path

SECONDS = 20.0
"""For every file: programs start within one, on a busy machine within some."""

SECONDS_PER_MB = 5.0
"""For each megabyte (10^6 bytes); real assemblies of 1 MB and more take up to 4 s a MB on one core."""


@dataclass(frozen=True)
class TimeLimit:
    """The time within which one file has to be read, from the moment at which it was set."""

    name: str
    """What messages call the file."""
    size: int
    """Bytes of the file."""
    seconds: float
    ends: float
    """On the clock of `time.monotonic`."""

    @classmethod
    def start(cls, path: Path, seconds: float | None = None) -> TimeLimit:
        """Start the time of a file that exists: `seconds`, or what its size allows.

        Raises ValueError where `seconds` is no positive number.
        """
        number = isinstance(seconds, int | float) and not isinstance(seconds, bool)
        if seconds is not None and not (number and 0 < seconds < math.inf):
            raise ValueError(f"seconds is the time allowed to read a file, a positive number; got {seconds!r}")
        size = path.stat().st_size
        allowed = SECONDS + SECONDS_PER_MB * size / 1e6 if seconds is None else float(seconds)
        return cls(path.name, size, allowed, time.monotonic() + allowed)

    def remaining(self) -> float:
        """Return the seconds that are left; ValueError where none are, with what to do about it."""
        if (left := self.ends - time.monotonic()) <= 0:
            raise self.exceeded()
        return left

    def exceeded(self) -> ValueError:
        """Make the error for a file that was not read in time."""
        return ValueError(
            f"{self.name} ({self.size / 1e6:.3g} MB) was not read within {self.seconds:.3g} seconds: it is damaged, or "
            f"larger than can be used; export it again, or part by part, or allow more time with "
            f"seconds={math.ceil(4 * self.seconds)} in load or load_study"
        )
