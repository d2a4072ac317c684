"""The interface of `optimize` to a solver: all starts are improved together, and only the active ones are computed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.design.augmented_lagrangian import Penalty, Verdict
from jaxkin.design.variables import DesignVector, Variables

CHUNK = 10
"""Iterations after which starts may retire, and the search may end."""
TOGETHER = 8
"""Largest number of designs of one call of the compiled program: few wait for the slowest, and none for retired
starts."""
KEPT = 16
"""Number of programs that are kept, those used last: each serves all problems of one structure."""


class Solver(NamedTuple):
    """A minimiser of the loss with its penalty, for all starts; its state is of a type of its own."""

    begin: Callable[[Any, Penalty], Any]
    """Make the state for vectors (starts, variables) and what violations cost."""
    advance: Callable[[Any, Penalty, Bool[np.ndarray, " starts"]], tuple[Any, Float[np.ndarray, "iterations starts"]]]
    """Take `CHUNK` iterations of the active starts; returns the state and the losses after each, NaN for others."""
    vectors: Callable[[Any], Float[np.ndarray, "starts variables"]]
    """Return the designs of a state."""
    slopes: Callable[[Any], Float[np.ndarray, "starts variables"]]
    """Return numbers of the size of the derivatives in a state: zero where a variable has no influence."""
    unknown: Callable[[Any, Penalty], Bool[np.ndarray, "starts variables"]]
    """Tell for vectors whether what is minimised is a number there, and its derivative by a variable none: steps take
    it for zero."""
    judge: Callable[[Any, Float[np.ndarray, "starts constraints"]], Verdict]
    """Compute losses and violations of vectors, for given shifts."""


def in_groups(
    program: Callable[[Any], Any], size: int, starts: Any, chosen: Int[np.ndarray, " chosen"] | None = None
) -> Any:
    """Return what a compiled program of `size` designs gives for the chosen ones of a pytree, in their order, in host
    memory.

    The last group is filled up: for each other number of designs the program would be compiled anew.
    """
    if chosen is None:
        chosen = np.arange(len(jax.tree.leaves(starts)[0]))

    def found() -> Iterator[Any]:
        for first in range(0, len(chosen), size):
            group = np.resize(chosen[first : first + size], size)
            yield program(jax.tree.map(lambda leaf, group=group: leaf[group], starts))

    return jax.tree.map(lambda *groups: np.concatenate(groups)[: len(chosen)], *found())


def unit_box(chosen: Variables) -> tuple[DesignVector, DesignVector]:
    """Return lower bounds and widths: vectors are lower + width * unit."""
    return chosen.lower, chosen.upper - chosen.lower
