"""Collect what was found for each loop group into the displacements, statuses and residuals of a mechanism."""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin.linkage.coordinates import InputValues
from jaxkin.linkage.first_order import Columns
from jaxkin.solve.execution.known_numbers import Outcome
from jaxkin.solve.status import SEVERITY, Status, closes_before_limits, of_severity, severity

GroupSolution = tuple[Float[Array, "_ _"] | list[Float[Array, " _"]], Outcome]
"""Displacements of the columns of a loop group, one row each, and what became of the poses."""


class DisplacementSources(NamedTuple):
    """Where the displacements of the joints come from (static)."""

    freedoms: tuple[int, ...]
    """Of every joint."""
    driven: Columns
    """Joint and coordinate of every input."""
    columns: tuple[Columns, ...]
    """Of every loop group that was solved."""


class Collected(NamedTuple):
    """The poses of a mechanism; displacements come by number of the joint."""

    inputs: tuple[Float[Array, " poses"], ...]
    moved: dict[int, Float[Array, "poses _"]]
    resting: dict[int, Float[Array, "poses _"]]
    """One array of zeros for each number of freedoms, which joints that nothing moves share."""
    status: Int[Array, " poses"]
    """The worst of all loop groups."""
    residual: Float[Array, " poses"]

    def displacements(self, freedoms: tuple[int, ...]) -> tuple[Float[Array, "poses _"], ...]:
        """List the displacements of all joints, which have so many freedoms each."""
        return tuple(
            self.moved[joint] if joint in self.moved else self.resting[count] for joint, count in enumerate(freedoms)
        )


def collect(
    sources: DisplacementSources,
    values: tuple[InputValues, ...],
    finite: Bool[Array | np.ndarray, " poses"] | None,
    solutions: list[GroupSolution],
) -> Collected:
    """Collect inputs, displacements, status and closure residual of each pose. All are NaN where an input is not
    `finite`."""
    poses, dtype = values[0].shape[0], values[0].dtype
    given = dict(zip(sources.driven, values, strict=True))
    resting = {freedoms: jnp.zeros((poses, freedoms), dtype) for freedoms in sorted(set(sources.freedoms))}
    moved: dict[int, Array] = {}
    for (joint, coordinate), value in given.items():
        moved[joint] = moved.get(joint, resting[sources.freedoms[joint]]).at[:, coordinate].set(value)
    worst = jnp.zeros(poses, jnp.int32)
    if finite is not None:
        worst = jnp.where(finite, worst, SEVERITY.index(Status.NONFINITE))
    square = jnp.zeros(poses, dtype)
    for columns, (coordinates, found) in zip(sources.columns, solutions, strict=True):
        own_status = found.status[:poses]
        follows = closes_before_limits(own_status) | (own_status == Status.MISFIT.value)
        for joint in dict.fromkeys(joint for joint, _ in columns):
            own = [(joint, k) for k in range(sources.freedoms[joint])]
            # inputs as they were given; the derivative of a pose that is not closed is zero in all its coordinates
            rows = [
                jnp.where(follows, given[each], lax.stop_gradient(given[each]))
                if each in given
                else (coordinates[columns.index(each)][:poses] if each in columns else 0.0)
                for each in own
            ]
            rows = [jnp.broadcast_to(row, (poses,)) for row in rows]
            moved[joint] = rows[0][:, None] if len(rows) == 1 else jnp.stack(rows, axis=1)
        worst = jnp.maximum(worst, severity(found.status[:poses]))
        square = square + found.residual_norm[:poses] ** 2
    status = of_severity(worst)
    resting = {freedoms: resting[freedoms] for joint, freedoms in enumerate(sources.freedoms) if joint not in moved}
    moved, resting, residual = nan_where_not_finite((moved, resting, jnp.sqrt(square)), finite)
    return Collected(tuple(map(jnp.asarray, values)), moved, resting, status, residual)


def nan_where_not_finite(rows, finite: Bool[Array | np.ndarray, " poses"] | None):
    """Set the rows of arrays to NaN, one row a pose, where the pose is not `finite` (None: all are)."""
    if finite is None:
        return rows
    return jax.tree.map(
        lambda array: jnp.where(finite.reshape(len(finite), *[1] * (array.ndim - 1)), array, jnp.nan), rows
    )
