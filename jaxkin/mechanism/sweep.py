"""The sweep: displacements of all joints for given displacements of some, over a whole range (Section 5)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes, lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin._names import closest
from jaxkin._traced import traced
from jaxkin.linkage.coordinates import Given, given_values, named, without_gaps
from jaxkin.mechanism.describe import why_infeasible
from jaxkin.mechanism.drive_plan import DrivenElement, plan_drive
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.correctors.least_residual import least_residual
from jaxkin.solve.execution.programs import Outcome, solve
from jaxkin.solve.methods import CONTINUATION, METHODS
from jaxkin.solve.status import Status, Tolerance, roundings
from jaxkin.solve.status import tolerance as default_tolerance
from jaxkin.solve.system.from_linkage import Columns

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

Solution = tuple[Float[Array, "_ _"], Outcome]
"""Displacements of the columns of a structure element, and what became of the poses."""
ROUNDINGS = 16
"""Units of rounding in the residual of a pose that is improved no further unless a tolerance is asked for."""
SEVERITY = (Status.CLOSED, Status.MISFIT, Status.JUMPED, Status.UNREACHABLE, Status.STALLED, Status.NONFINITE)
"""Of several loop systems the worst decides the status of the pose."""


def sweep(
    mechanism: Mechanism, drive: Mapping[str, object], *, tolerance: float | None = None, method: str = CONTINUATION
) -> Motion:
    """The motion of all parts while some joint coordinates run through given displacements.

    `drive` maps "joint" (if it has one coordinate) or "joint.coordinate" to an array of one value a pose: radians, or
    lengths in the unit of the mechanism, measured from the assembled pose. Several arrays must have equal length. The
    motion is followed from the assembled pose; a single input may come in any order, several are followed in the order
    given. Only loops that a driven joint moves are solved; coordinates that nothing drives stay at rest.

    A pose is closed where its residual is at most `tolerance`, and improved no further; by default 1e-12 (2e-6 in
    float32), and improved down to rounding. `method` names another way to find poses (`jaxkin.solve.methods.METHODS`):
    for comparison, none is as fast or watches the branch. `jk.work_precision` shows what either costs.

    Works inside `jax.jit`, `vmap` and `grad`. A pose that cannot be reached is reported in `motion.status`, it is never
    an exception; one whose displacements are NaN or infinite is NONFINITE and NaN itself, and all others are what they
    would be without it. Raises ValueError for a drive that makes no sense (see `jaxkin.linkage.coordinates.resolve`),
    or that the loops have no freedoms for (see `jaxkin.mobility.infeasible_drive`; not where the geometry is traced).
    """
    plan = plan_drive(mechanism.linkage, named(drive))
    values = given_values(plan.driven, drive)
    if plan.infeasible:
        raise ValueError(why_infeasible(mechanism, plan.infeasible))
    asked = _tolerance(tolerance)
    if method not in METHODS:
        raise ValueError(f"there is no method {method!r} among {', '.join(METHODS)}{closest(method, METHODS)}")
    _warn_of_float32()
    elements = plan.elements if values[0].shape[0] else ()
    followed, finite = without_gaps(values)
    solutions = [
        solve(element.system, method, element.joints, _padded([followed[i] for i in element.inputs]), asked)
        for element in elements
    ]
    elements, solutions = _of_least_residual(elements, solutions, asked)
    columns = tuple(element.columns for element in elements)
    layout = Layout(plan.freedoms, tuple(plan.driven.values()), columns)
    inputs, moved, resting, *found = _collect(layout, values, finite, solutions)
    displacements = tuple(
        moved[joint] if joint in moved else resting[freedoms] for joint, freedoms in enumerate(plan.freedoms)
    )
    # under `grad` JAX hands arrays of the host through as they are
    return Motion(mechanism, dict(zip(plan.driven, map(jnp.asarray, inputs), strict=True)), displacements, *found)


def _of_least_residual(
    elements: Sequence[DrivenElement], solutions: Sequence[Solution], asked: Tolerance
) -> tuple[list[DrivenElement], list[Solution]]:
    """Elements with what was found, that of ideal joints replaced by the poses of least residual of those given."""
    every, found = list(elements), list(solutions)
    for number, (element, (rows, outcome)) in enumerate(zip(elements, solutions, strict=True)):
        if element.given is None:
            continue
        system, columns, joints = element.given
        none = jnp.zeros_like(rows[:1])
        whole = [rows[element.columns.index(each)] if each in element.columns else none[0] for each in columns]
        poses, status, gap = least_residual(
            system, joints, element.joints, jnp.stack(whole), outcome.status, asked.closed
        )
        every[number], found[number] = element._replace(columns=columns), (poses, Outcome(status, gap))
    return every, found


def _tolerance(asked: float | None) -> Tolerance:
    """The tolerance asked for; without one that of the precision, and poses down to rounding."""
    dtype = dtypes.canonicalize_dtype(float)  # numbers of the host: to make arrays of the device takes longer
    if asked is None:
        return Tolerance(*(np.asarray(gap, dtype) for gap in (default_tolerance(dtype), roundings(dtype, ROUNDINGS))))
    if traced(asked):
        return Tolerance(*[jnp.asarray(asked, dtype)] * 2)
    try:
        given = np.asarray(asked, dtype)
        if given.shape or not given > 0:
            raise ValueError
    except (TypeError, ValueError):
        raise ValueError(f"tolerance must be a positive number such as 1e-9, got {asked!r}") from None
    return Tolerance(given, given)


class Layout(NamedTuple):
    """Where the displacements of the joints come from (static)."""

    freedoms: tuple[int, ...]
    """Of every joint."""
    driven: tuple[tuple[int, int], ...]
    """Joint and coordinate of every input."""
    columns: tuple[Columns, ...]
    """Of every structure element that was solved."""


@partial(jax.jit, static_argnums=0)
def _collect(
    layout: Layout,
    values: tuple[Given, ...],
    finite: Bool[Array | np.ndarray, " poses"] | None,
    solutions: list[Solution],
) -> tuple[
    tuple[Float[Array, " poses"], ...],
    dict[int, Float[Array, "poses _"]],
    dict[int, Float[Array, "poses _"]],
    Int[Array, " poses"],
    Float[Array, " poses"],
]:
    """The inputs, displacements, status and closure residual, of which the worst structure element's.

    Displacements by number of the joint; of those that nothing moves one array for all of as many freedoms. All are NaN
    where an input is not `finite`.
    """
    poses, dtype = values[0].shape[0], values[0].dtype
    resting = {freedoms: jnp.zeros((poses, freedoms), dtype) for freedoms in sorted(set(layout.freedoms))}
    moved: dict[int, Array] = {}
    for (joint, coordinate), given in zip(layout.driven, values, strict=True):
        moved[joint] = moved.get(joint, resting[layout.freedoms[joint]]).at[:, coordinate].set(given)
    rank = jnp.array([SEVERITY.index(status) for status in Status], jnp.int32)
    worst = jnp.zeros(poses, jnp.int32)
    if finite is not None:
        worst = jnp.where(finite, worst, SEVERITY.index(Status.NONFINITE))
    square = jnp.zeros(poses, dtype)
    for columns, (coordinates, found) in zip(layout.columns, solutions, strict=True):
        for joint in dict.fromkeys(joint for joint, _ in columns):
            own = [(joint, k) for k in range(layout.freedoms[joint])]
            rows = [coordinates[columns.index(each), :poses] if each in columns else 0.0 for each in own]
            moved[joint] = jnp.stack([jnp.broadcast_to(row, (poses,)) for row in rows], axis=1)
        worst = jnp.maximum(worst, rank[found.status[:poses]])
        square = square + found.gap[:poses] ** 2
    status = jnp.array([status.value for status in SEVERITY], jnp.int32)[worst]
    resting = {freedoms: resting[freedoms] for joint, freedoms in enumerate(layout.freedoms) if joint not in moved}
    moved, resting, residual = spoilt((moved, resting, jnp.sqrt(square)), finite)
    return tuple(map(jnp.asarray, values)), moved, resting, status, residual


def spoilt(rows, finite: Bool[Array | np.ndarray, " poses"] | None):
    """Arrays with a row a pose, NaN where the pose is not `finite`; None: all are."""
    if finite is None:
        return rows
    return jax.tree.map(
        lambda array: jnp.where(finite.reshape(len(finite), *[1] * (array.ndim - 1)), array, jnp.nan), rows
    )


def _padded(rows: list[Given]) -> Float[Array | np.ndarray, "driven padded"]:
    """The inputs, the last pose repeated up to one of few lengths: ranges of similar length share a compiled program.

    A power of two from 32 to 256 poses, above that a multiple of an eighth of one, of many a 32nd. Traced inputs are
    left alone: their program is compiled for their length anyway. Without a drive: one pose for all.
    """
    if not rows:
        return jnp.zeros((0, 1), float)
    poses = rows[0].shape[0]
    power = 2 ** max(5, (poses - 1).bit_length())
    part = power if power <= 256 else power // (8 if power <= 2**15 else 32)
    length = -(-poses // part) * part
    if not traced(rows):
        # on the host: there it costs a copy, not a program for every length
        padded = np.empty((len(rows), length), rows[0].dtype)
        for whole, row in zip(padded, rows, strict=True):
            whole[:poses], whole[poses:] = row, row[-1]
        # inside a function that is being traced what is put on the device counts as such
        return jax.device_put(padded) if traced(jax.device_put(padded[:, :0])) else padded
    inputs = jnp.stack(rows)
    return inputs if traced(lax.stop_gradient(inputs)) else jnp.pad(inputs, ((0, 0), (0, length - poses)), mode="edge")


_warned = False


def _warn_of_float32() -> None:
    global _warned  # noqa: PLW0603
    if _warned or dtypes.canonicalize_dtype(float) == jnp.float64:
        return
    _warned = True
    warnings.warn(
        "jaxkin computes in float32: loops close to about 5e-7 of the size. For 1e-15 write "
        'jax.config.update("jax_enable_x64", True) before the first array is made.',
        stacklevel=4,
    )
