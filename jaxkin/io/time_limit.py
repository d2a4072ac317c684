"""How long a file may be read: so many seconds for every file, and so many for each megabyte of it.

They are seconds of a processor, not of the clock: on a machine that others use, too, a sound file takes several times
as long to be read as it takes work, and is not to be refused for that.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from pathlib import Path

SECONDS = 20.0
"""For every file: programs start within one."""

SECONDS_PER_MB = 5.0
"""For each megabyte (10^6 bytes); real assemblies of 1 MB and more take up to 4 s a MB on one core."""

PATIENCE = 10.0
"""Seconds of the clock for each second of a processor, after which a reader that does nothing is given up. Six programs
on two cores made a sound file of 6 MB take 5.5."""


@dataclass(frozen=True)
class TimeLimit:
    """The time within which one file has to be read: that of this thread, from the moment at which the limit was set,
    and as much for the program that reads the format."""

    name: str
    """What messages call the file."""
    size: int
    """Bytes of the file."""
    seconds: float
    """Of a processor."""
    ends: float
    """On the clock of `time.thread_time`."""

    @classmethod
    def start(cls, path: Path, seconds: float | None = None, size: int | None = None) -> TimeLimit:
        """Start the time of a file that exists: `seconds`, or what its size allows, which is `size` where others are
        read with it.

        Raises ValueError where `seconds` is no positive number.
        """
        number = isinstance(seconds, int | float) and not isinstance(seconds, bool)
        if seconds is not None and not (number and 0 < seconds < math.inf):
            raise ValueError(f"seconds is the time allowed to read a file, a positive number; got {seconds!r}")
        size = path.stat().st_size if size is None else size
        allowed = SECONDS + SECONDS_PER_MB * size / 1e6 if seconds is None else float(seconds)
        return cls(path.name, size, allowed, time.thread_time() + allowed)

    def remaining(self) -> float:
        """Return the processor seconds that are left; ValueError where none are, with what to do about it."""
        if (left := self.ends - time.thread_time()) <= 0:
            raise self.exceeded()
        return left

    def exceeded(self) -> ValueError:
        """Make the error for a file that was not read in time."""
        most, more = PATIENCE * self.seconds, math.ceil(4 * self.seconds)
        return ValueError(
            f"{self.name} ({self.size / 1e6:.3g} MB) was not read within {self.seconds:.3g} seconds of a processor, or "
            f"{most:.3g} in all: it is damaged, or larger than can be used; export it again, or part by part, or allow "
            f"more time, as seconds={more} of load or load_study, or with --seconds {more}"
        )
