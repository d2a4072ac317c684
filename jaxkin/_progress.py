"""How far a long call has come: a bar on a terminal, also for calls from Python."""

from __future__ import annotations

import sys
from typing import Any


class ProgressBar:
    """A bar of progress; by default, with `wanted` None, on a terminal only."""

    def __init__(self, total: int, wanted: bool | None, text: str):
        self.bar: Any = None
        if sys.stderr.isatty() if wanted is None else wanted:
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

            columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
            self.bar = Progress(*columns, console=Console(stderr=True))
            self.bar.start()
            self.task = self.bar.add_task(text, total=total)

    def show(self, done: int, text: str, total: int | None = None) -> None:
        """Show how much is done of the total, which may be another one than at first."""
        if self.bar:
            self.bar.update(self.task, completed=done, description=text, total=total)

    def close(self) -> None:
        """Leave the bar as it is."""
        if self.bar:
            self.bar.stop()
