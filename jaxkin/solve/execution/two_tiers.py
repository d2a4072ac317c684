"""Compile a program quickly at first, and anew for speed when it has computed for long.

Most searches for a design end before a program that the compiler has optimised repays the seconds that it took.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax

from jaxkin.solve.execution.compiler import COMPILER_OPTIONS, FEW_OPTIMISATIONS, known_options

QUICK_OPERATIONS = 1e10
"""Arithmetic operations, as XLA counts them, after which the optimised program is compiled. Residuals and derivatives
of eight four-bars took 3.5 s of a processor to compile with few optimisations, and 9.4 and 11.0 with all; a call took
1.5 and 6.4 ms in place of 0.6 and 2.1 (paths of five points, and of ten). The measured difference of 6 to
7 s is spent after 0.9e10 to 1.2e10 of them: so no search takes longer than twice what it takes with the better of both
programs. By operations and not by seconds, since both programs round differently, and a search is to be repeatable."""


class TwoTiers:
    """A function of arrays that is called often, with arguments of the same shapes each time."""

    def __init__(self, function: Callable[..., Any]):
        self._function = function
        self._lowered: Any = None
        self._quick: Any = None
        self._cost = 0.0
        self._fast: Any = None

    def search(self) -> Callable[..., Any]:
        """Return the function for a search, which counts its operations by itself: it is the same the second time,
        though nothing is compiled anew then."""
        done = 0.0

        def call(*given: Any) -> Any:
            nonlocal done
            if self._quick is None:
                self._lowered = jax.jit(self._function).lower(*given)
                self._quick = _compiled(self._lowered, quick=True)
                self._cost = float((self._quick.cost_analysis() or {}).get("flops", 0.0))
            done += self._cost
            if done <= QUICK_OPERATIONS:
                return self._quick(*given)
            if self._fast is None:
                self._fast = _compiled(self._lowered, quick=False)
            return self._fast(*given)

        return call


def _compiled(lowered: Any, quick: bool) -> Any:
    """Compile what was lowered, quickly or well; either way with all options of the solver's programs."""
    return lowered.compile(known_options(COMPILER_OPTIONS | FEW_OPTIMISATIONS if quick else COMPILER_OPTIONS))
