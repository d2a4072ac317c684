"""What an outer solver is to `optimize`: many starts, of which only those still active are computed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from jaxkin.design.augmented_lagrangian import Penalty, Verdict
from jaxkin.design.variables import Variables

CHUNK = 10
"""Iterations between two looks at the losses."""
TOGETHER = 8
"""Designs that go through one call of the compiled program at most: few wait for the slowest, and none for retired
starts."""

KEPT = 16
"""Programs of problems that are kept, each for all problems of the same structure; those used last."""


class Solver(NamedTuple):
    """A way downhill, for all starts."""

    begin: Callable[[Any, Penalty], Any]
    """The state for some vectors and what violations cost."""
    advance: Callable[[Any, Penalty, Bool[np.ndarray, " starts"]], tuple[Any, Float[np.ndarray, "iterations starts"]]]
    """Some iterations of the active starts; the state, and the losses after each, nan for the others."""
    vectors: Callable[[Any], Float[np.ndarray, "starts variables"]]
    slopes: Callable[[Any], Float[np.ndarray, "starts variables"]]
    """Zero where a variable has no influence."""
    judge: Callable[[Any, Float[np.ndarray, "starts constraints"]], Verdict]
    """Losses and violations of some vectors, for given shifts."""


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


def unit_box(chosen: Variables) -> tuple[Array, Array]:
    """Return lower bounds and widths: vectors are lower + width * unit."""
    return jnp.asarray(chosen.lower), jnp.asarray(chosen.upper) - chosen.lower
