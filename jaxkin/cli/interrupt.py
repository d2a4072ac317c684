"""Ctrl-C ends a command wherever it arrives, also in code whose exceptions Python ignores."""

from __future__ import annotations

import _thread
import sys
import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

AGAIN = 0.02
"""Seconds after which an interrupt that was ignored comes again: the code that ignored it has returned by then, mostly;
where it has not, the interrupt comes once more."""


def never_ignored() -> None:
    """Have an interrupt that Python ignores come again.

    JAX is called whenever Python collects garbage, which is often while it compiles. Python prints exceptions of such
    calls and goes on: of thirteen interrupts of a sweep four did not end it.
    """
    usual = sys.unraisablehook

    def hook(ignored: UnraisableHookArgs) -> None:
        if not isinstance(ignored.exc_value, KeyboardInterrupt):
            usual(ignored)
            return
        # not here: an interrupt inside of this hook would be ignored, too
        later = threading.Timer(AGAIN, _thread.interrupt_main)
        later.daemon = True
        later.start()

    sys.unraisablehook = hook
