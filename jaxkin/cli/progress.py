"""How far a command has come, on a terminal only."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress


class CommandSteps:
    """The steps of a command: call it with what each is at its beginning, and `within` as the step goes on."""

    def __init__(self, bar: Progress | None, total: int) -> None:
        self._bar, self._begun = bar, -1
        self._task = bar.add_task("", total=total) if bar else None

    def __call__(self, text: str) -> None:
        """Begin the next step."""
        self._begun += 1
        if self._bar and self._task is not None:
            self._bar.update(self._task, description=text, completed=self._begun)

    def within(self, done: int, total: int) -> None:
        """Show that so much of the present step is done."""
        if self._bar and self._task is not None:
            self._bar.update(self._task, completed=self._begun + done / total)


@contextmanager
def progress(steps: int) -> Iterator[CommandSteps]:
    """Show a bar on the terminal (stderr), gone when done; its steps are to be told by what it yields."""
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    if not console.is_terminal:
        yield CommandSteps(None, steps)
        return
    with Progress(console=console, transient=True) as bar:
        yield CommandSteps(bar, steps)
