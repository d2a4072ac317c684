"""Weighted sums of what a motion is asked for.

An objective is called as `objective(motion, extras)`; `2.0 * path(...) + transmission(...)` is a weighted sum of two.
Objectives are pytrees of their numbers, such as targets and weights: a search with other numbers runs the program that
was compiled for the first ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Protocol

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin._traced import traced
from jaxkin.design import given
from jaxkin.mechanism.motion import Motion

Extras = Mapping[str, Any]


class Term(Protocol):
    """What a motion is asked for, in numbers that are to be zero."""

    def rows(self, motion: Motion, extras: Extras) -> Any:
        """Compute the numbers whose squares are added up."""
        ...

    def draw(self, axes: Any, motion: Motion, extras: Extras, style: dict) -> None:
        """Draw what is wanted and what the motion does into matplotlib axes."""
        ...


class WeightedTerm(NamedTuple):
    """A term of a sum."""

    weight: Any
    term: Term


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class Objective:
    """A sum of squares over a motion, with what it takes to draw it."""

    terms: tuple[WeightedTerm, ...]

    def residuals(self, motion: Motion, extras: Extras | None = None) -> Float[Array, " rows"]:
        """Return the numbers whose squares add up to the objective, weights included."""
        return jnp.concatenate([jnp.sqrt(w) * jnp.ravel(term.rows(motion, extras or {})) for w, term in self.terms])

    def __call__(self, motion: Motion, extras: Extras | None = None) -> Float[Array, ""]:
        return jnp.sum(self.residuals(motion, extras) ** 2)

    def __add__(self, other: Objective) -> Objective:
        return replace(self, terms=self.terms + other.terms)

    def __rmul__(self, weight: float | int) -> Objective:
        weight = given.number(weight, "the weight of an objective")
        if not traced(weight) and weight < 0:
            raise ValueError(f"the weight of an objective must not be negative, got {weight}")
        return replace(self, terms=tuple(WeightedTerm(weight * w, term) for w, term in self.terms))

    __mul__ = __rmul__

    def plot(self, axes: Any, motion: Motion, extras: Extras | None = None, **style: Any) -> None:
        """Draw what is wanted and what the motion does into matplotlib axes: the first term."""
        for _, term in self.terms[:1]:
            term.draw(axes, motion, extras or {}, style)


def single(term: Term) -> Objective:
    """Make the objective of one term, of weight 1."""
    return Objective((WeightedTerm(1.0, term),))
