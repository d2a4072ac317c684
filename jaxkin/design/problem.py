"""A design problem as functions of one vector: residuals, or a loss and its gradient, penalties included.

A problem is a pytree: what two problems may differ in without being compiled anew are its numbers, `taken_apart`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Array, Float

from jaxkin.design.augmented_lagrangian import Penalty
from jaxkin.design.constraints import Constraint, DesignConstraint, constraint_name, numbered
from jaxkin.design.objective import Objective
from jaxkin.design.own_functions import called, check_constraint, check_loss, is_constant, own_function
from jaxkin.design.penalty import closure_gaps
from jaxkin.design.variables import Variables
from jaxkin.dimensions.frames import with_points
from jaxkin.dimensions.lengths import rearranged
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.sweep import sweep
from jaxkin.solve.options import SolverOptions

HOPELESS = 1e15
"""Stands for residuals and losses that are not finite, and for what constraints lack that are NaN or -inf, so that the
other designs of a batch are not spoilt: more than any residual in any unit, and than any loss over its first size; its
square is a number in float32."""


class Judged(NamedTuple):
    """What a design loses and violates, without a penalty."""

    rows: Float[Array, " rows"]
    """Residuals of a sum of squares; a single loss otherwise."""
    gaps: Float[Array, " gaps"]
    """Closure residuals of poses that do not close, and misfits of parts; zero where all is well."""
    margins: Float[Array, " constraints"]
    """Values of constraints, negative where one is violated."""

    def weighted(self, penalty: Penalty) -> WeightedResiduals:
        """Weight what is violated, so that its squares are the penalty."""
        root = jnp.sqrt(penalty.weight)
        return WeightedResiduals(self.rows, root * self.gaps, root * jnp.maximum(penalty.shifts - self.margins, 0.0))


class WeightedResiduals(NamedTuple):
    """What a sum of squares adds up, for a design and a penalty."""

    rows: Float[Array, " rows"]
    """Residuals, as in `Judged`."""
    gaps: Float[Array, " gaps"]
    """Gaps times the root of the weight."""
    charged: Float[Array, " constraints"]
    """By how much constraints are below their shifts, times the root of the weight."""


@dataclass(frozen=True, eq=False)
class Problem:
    """What is minimised: `sum(rows^2)` or the loss, and the penalty of `jaxkin.design.augmented_lagrangian`."""

    loss: Callable[..., Any]
    squares: bool
    mechanism: Mechanism
    variables: Variables
    constraints: tuple[Constraint, ...]
    options: SolverOptions
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
        margins = jnp.concatenate([jnp.zeros(0), *(rows for _, rows in self.margins(motion, extras))])
        margins = jnp.maximum(jnp.where(jnp.isnan(margins), -HOPELESS, margins), -HOPELESS)
        return Judged(self.of_motion(motion, extras), jnp.concatenate(gaps), margins)

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
            found.append((numbered(number, each), jnp.ravel(called(each, motion, extras))))
        return found

    def of_motion(self, motion: Motion, extras: dict[str, Any]) -> Float[Array, " rows"]:
        """Compute residuals of a sum of squares, or the loss alone."""
        if not self.squares:
            return jnp.reshape(self._call(motion, extras), (1,))
        return jnp.ravel(
            self.loss.residuals(motion, extras) if isinstance(self.loss, Objective) else self._call(motion, extras)
        )

    def constraint_count(self, motion: Motion, extras: dict[str, Any]) -> int:
        """Count the values of all constraints, for the motion and the extras of any design."""
        return sum(rows.size for rows in jax.eval_shape(_margins, self, motion, extras))

    def _call(self, motion: Motion, extras: dict[str, Any]):
        return called(self.loss, motion, extras)


def _margins(problem: Problem, motion: Motion, extras: dict[str, Any]) -> list[Float[Array, " constraints"]]:
    """Compute the values of constraints; JAX keeps what it traces of this function for problems of one structure."""
    return [rows for _, rows in problem.margins(motion, extras)]


class ProgramKey(NamedTuple):
    """What a program is compiled for."""

    problem: Any
    """The problem without its numbers."""
    shapes: tuple[tuple[tuple[int, ...], Any], ...]
    """Shape and type of each of the numbers."""
    settings: tuple[Any, ...]
    """Of JAX: precision, and device."""


def taken_apart(problem: Problem) -> tuple[ProgramKey, list[Array]]:
    """Take a problem apart into its key, which is hashable, and its numbers, on the device."""
    leaves, tree = jax.tree.flatten(problem)
    # to make them one by one compiles a program for each shape
    numbers = jax.device_put([leaf if isinstance(leaf, jax.Array) else np.asarray(leaf) for leaf in leaves])
    settings = dtypes.canonicalize_dtype(float), getattr(jax.config, "jax_default_device", None)
    return ProgramKey(tree, tuple((each.shape, each.dtype) for each in numbers), settings), numbers


def _children(problem: Problem) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """List the pytrees of a problem, and what else it has.

    Of a mechanism that changes, the linkage is numbers; one that does not change is what it is: its poses are found by
    what is known of it. So is one that has contacts, which JAX leaves behind, for functions that ask for these.
    """
    mechanism, changes = problem.mechanism, problem.variables.change_geometry
    whole = not changes or mechanism.contacts or mechanism.contacts_at_rest or mechanism.bonds
    rest = mechanism if whole else (mechanism.unit, mechanism.motors)
    given = mechanism.linkage if changes else None
    return (problem.loss, problem.constraints, problem.variables, given), (rest, problem.squares, problem.options)


def _rebuilt(static: tuple[Any, ...], children: tuple[Any, ...]) -> Problem:
    """Make a problem of what `_children` returns, `static` being what it has besides pytrees."""
    (rest, squares, options), (loss, constraints, chosen, linkage) = static, children
    if not isinstance(rest, Mechanism):
        unit, motors = rest
        rest = Mechanism(linkage, unit, motors=motors)
    mechanism = rest if linkage is None else rest.with_linkage(linkage)
    return Problem(loss, squares, mechanism, chosen, constraints, options)


jax.tree_util.register_pytree_node(Problem, _children, _rebuilt)


def design_problem(
    loss: Objective | Callable[..., Any],
    squares: bool,
    mechanism: Mechanism,
    chosen: Variables,
    constraints: Sequence[Constraint],
    options: SolverOptions,
) -> Problem:
    """Make a problem, with functions of the user as what they compute: see `own_functions`.

    Raises ValueError for a loss that is no single number where it has to be one, and for constraints that are none.
    """

    def traced(function: Callable[..., Any], name: str, *shapes: Any):
        return own_function(function, name, shapes, forward=squares)

    chosen = chosen.with_functions(traced)
    problem = Problem(loss, squares, mechanism, chosen, tuple(constraints), options)
    if isinstance(loss, Objective) and not any(map(_is_own, constraints)):
        return problem
    # shapes only, nothing is computed
    motion, extras, _ = jax.eval_shape(problem.motion, jnp.asarray(chosen.start))

    def own(function: Callable[..., Any], number: int | None = None):
        def of_motion(motion: Motion, extras: dict[str, Any]):
            return called(function, replace(motion, mechanism=_with_contacts(motion.mechanism, mechanism)), extras)

        if number is None:
            check_loss(of_motion, squares, motion, extras)
            if not constraints and is_constant(of_motion, motion, extras):
                raise ValueError("the loss is the same for every design: it must depend on the motion or the extras")
        else:
            check_constraint(of_motion, numbered(number, function), motion, extras)
        found = traced(of_motion, constraint_name(function), motion, extras)
        return replace(found, function=partial(called, function))

    return replace(
        problem,
        loss=own(loss) if _is_own(loss) else loss,
        constraints=tuple(own(each, number) if _is_own(each) else each for number, each in enumerate(constraints)),
    )


def _is_own(function: Any) -> bool:
    """Tell whether a loss or a constraint is a function of the user, and not one of `jaxkin.design`."""
    return not isinstance(function, Objective | DesignConstraint)


def _with_contacts(mechanism: Mechanism, whole: Mechanism) -> Mechanism:
    """Give a mechanism what JAX has left behind, as functions of the motion find it when they are called."""
    return replace(mechanism, contacts=whole.contacts, contacts_at_rest=whole.contacts_at_rest, bonds=whole.bonds)
