"""A design problem as functions of one vector: residuals, or a loss and its gradient, penalties included."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.design.augmented_lagrangian import Penalty
from jaxkin.design.constraints import Constraint
from jaxkin.design.objectives import Objective
from jaxkin.design.penalty import closure_gaps
from jaxkin.design.variables import Variables
from jaxkin.dimensions.frames import with_points
from jaxkin.dimensions.lengths import rearranged
from jaxkin.mechanism.sweep import sweep
from jaxkin.solve.options import SolverOptions

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion

HOPELESS = 1e6
"""Stands for residuals and losses that are not finite, so that the other designs of a batch are not spoilt."""


class Judged(NamedTuple):
    """A design, judged."""

    rows: Float[Array, " rows"]
    """Residuals of a sum of squares; a single loss otherwise."""
    gaps: Float[Array, " gaps"]
    """Closure residuals of poses that do not close, and misfits of parts; zero where all is well."""
    margins: Float[Array, " constraints"]
    """Values of constraints, negative where one is violated."""

    @property
    def finite(self) -> Array:
        """Whether every number is finite."""
        return jnp.all(jnp.isfinite(jnp.concatenate(self)))


@dataclass(frozen=True)
class Problem:
    """What is minimised: `sum(rows^2)` or the loss, and the penalty of `jaxkin.design.augmented_lagrangian`."""

    loss: Callable[..., Any]
    squares: bool
    mechanism: Mechanism
    variables: Variables
    constraints: Sequence[Constraint]
    options: SolverOptions = field(default_factory=SolverOptions)
    """How poses are found."""

    def motion(self, vector) -> tuple[Motion, dict[str, Any], dict[str, Any]]:
        """Compute the motion of a design, its extra variables, and the misfits of its parts."""
        values = self.variables.values(vector)
        linkage, misfits = rearranged(self.mechanism.linkage, values.lengths)
        linkage = with_points(linkage, values.points)
        motion = sweep(self.mechanism.with_linkage(linkage), values.inputs, options=self.options)
        return motion, values.extras, misfits

    def judge(self, vector) -> Judged:
        """Compute residuals and violations of a design, differentiable."""
        motion, extras, misfits = self.motion(vector)
        gaps = [rows for _, rows in self.gaps(motion, misfits)]
        margins = [rows for _, rows in self.margins(motion, extras)]
        return Judged(self.of_motion(motion, extras), jnp.concatenate(gaps), jnp.concatenate([jnp.zeros(0), *margins]))

    def gaps(self, motion: Motion, misfits: dict[str, Any]) -> list[tuple[str, Float[Array, " gaps"]]]:
        """Compute by how much loops do not close and lengths do not fit, each with its name; zero where all is well."""
        found = [("closure", closure_gaps(motion))]
        for part, misfit in misfits.items():
            found.append((f"fit of the lengths of {part}", jnp.reshape(jnp.where(misfit > 1e-12, misfit, 0.0), (1,))))
        return found

    def margins(self, motion: Motion, extras: dict[str, Any]) -> list[tuple[str, Float[Array, " constraints"]]]:
        """Compute the values of the constraints, each with its name."""
        found = []
        for number, each in enumerate(self.constraints):
            # the constraints of jaxkin.design are functions `margins` within those that made them
            whole = getattr(each, "__qualname__", type(each).__name__)
            name = whole.removesuffix(".<locals>.margins").rsplit(".", 1)[-1]
            found.append((f"constraint {number} ({name})", jnp.ravel(_called(each, motion, extras))))
        return found

    def of_motion(self, motion: Motion, extras: dict[str, Any]) -> Float[Array, " rows"]:
        """Compute residuals of a sum of squares, or the loss alone."""
        if not self.squares:
            return jnp.reshape(self._call(motion, extras), (1,))
        return jnp.ravel(
            self.loss.residuals(motion, extras) if isinstance(self.loss, Objective) else self._call(motion, extras)
        )

    def residuals(self, vector, penalty: Penalty) -> Float[Array, " rows"]:
        """Compute all that a sum of squares adds up: rows, gaps, and constraints."""
        judged = self.judge(vector)
        charged = jnp.maximum(penalty.shifts - judged.margins, 0.0)
        return jnp.concatenate([judged.rows, jnp.sqrt(penalty.weight) * jnp.concatenate([judged.gaps, charged])])

    def total(self, vector, penalty: Penalty) -> Float[Array, ""]:
        """Compute the loss with its penalty."""
        judged = self.judge(vector)
        value = jnp.sum(judged.rows**2) if self.squares else judged.rows[0]
        charged = jnp.maximum(penalty.shifts - judged.margins, 0.0)
        return value + penalty.weight * (jnp.sum(judged.gaps**2) + jnp.sum(charged**2))

    def _call(self, motion: Motion, extras: dict[str, Any]):
        return _called(self.loss, motion, extras)


def _called(function: Callable[..., Any], motion: Motion, extras: dict[str, Any]):
    """Call a loss or a constraint of a motion, with the extras where it takes them."""
    return function(motion, extras) if takes_extras(function) else function(motion)


def takes_extras(loss: Callable[..., Any]) -> bool:
    """Tell whether a loss wants the extra variables as a second argument."""
    try:
        inspect.signature(loss).bind(None, None)
    except TypeError:
        return False
    except ValueError:  # no signature to be had: a callable of C
        return False
    return True


def checked_shape(problem: Problem, vector) -> None:
    """Refuse a loss that is no single number, where it has to be one; by shapes only, nothing is computed."""
    if problem.squares and isinstance(problem.loss, Objective):
        return
    returned: list[Any] = []
    jax.eval_shape(lambda v: returned.append(problem._call(*problem.motion(v)[:2])), vector)
    (found,) = returned
    shape = getattr(found, "shape", () if isinstance(found, int | float) else None)
    if shape is None:
        raise ValueError(
            f"the loss must return one number, got {type(found).__name__}; return jnp.sum(...) of what it measures"
        )
    if not problem.squares and shape != ():
        raise ValueError(
            f"the loss must return one number, got an array of shape {shape}; return jnp.sum(...) of it, or say "
            "solver=jk.design.LevenbergMarquardt() if these are residuals whose squares are to be added up"
        )
