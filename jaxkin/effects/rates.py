"""Velocities, accelerations and jerks: derivatives of the sweep along its drive, nested forward."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._names import by_name, nearest
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.geometry.movements import is_length
from jaxkin.linkage.coordinates import resolve
from jaxkin.mechanism.collect import nan_where_not_finite
from jaxkin.mechanism.motion import Motion, as_point
from jaxkin.mechanism.sweep import sweep
from jaxkin.solve.options import SolverOptions, options_with
from jaxkin.solve.status import Status

Inputs = dict[str, Float[Array, " poses"]]
NAMES = {1: "Velocities", 2: "Accelerations", 3: "Jerks"}
"""By the order of the derivative with respect to time."""


@dataclass(frozen=True, eq=False)
class Rates:
    """Derivatives of a motion with respect to time, of one order. A pytree; every array has the poses first.

    Rates are zero at poses that did not close, and NaN at NONFINITE poses: `motion.status` tells which.
    """

    motion: Motion
    inputs: Inputs
    """The given rates of the driven displacements."""
    displacements: tuple[Float[Array, "poses _"], ...]
    """Rates of the displacements of all joints, in the order of `mechanism.joints`: radians or lengths per time."""
    matrices: tuple[Float[Array, "poses 4 4"], ...]
    """Rates of the transforms of all parts, in the order of `mechanism.parts`."""
    lower: tuple[tuple[Float[Array, "poses 4 4"], ...], ...] = ()
    """The same of lower orders, velocities first: those of jerks, whose angular part needs them."""
    order: int = 1
    """1 for velocities, 2 for accelerations, 3 for jerks."""

    @property
    def closed(self) -> Bool[Array, " poses"]:
        """Which poses have rates."""
        return self.motion.closed

    @cached_property
    def coordinates(self) -> Mapping[str, Float[Array, "poses _"]]:
        """Rates of the displacements of each joint, in the order of its `coordinates`."""
        return dict(zip(self.motion.mechanism.joints, self.displacements, strict=True))

    @cached_property
    def transforms(self) -> Mapping[str, Float[Array, "poses 4 4"]]:
        """The derivative of the displacement matrix of each part."""
        return dict(zip(self.motion.mechanism.parts, self.matrices, strict=True))

    def __str__(self) -> str:
        """A line a coordinate: its least and its greatest rate, and where."""
        lines = [f"{NAMES[self.order]} over {len(self.motion)} poses, for the given ones of {', '.join(self.inputs)}"]
        for name, row in zip(*self._rows(), strict=True):
            if np.isfinite(row).any():
                low, high = int(np.nanargmin(row)), int(np.nanargmax(row))
                lines.append(f"  {name}: from {row[low]:.4g} at pose {low} to {row[high]:.4g} at pose {high}")
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw the rates of all joint coordinates over the poses into a picture file; returns its path."""
        names, rows = self._rows()
        return draw_lines(names, rows, f"{NAMES[self.order].lower()} of joints", "", Path(path))

    def save(self, path: str | Path) -> Path:
        """Write them as comma-separated values, a row a pose and a column a joint coordinate; returns the path."""
        return save_rows(*self._rows(), Path(path))

    def _rows(self) -> tuple[list[str], Float[np.ndarray, "coordinates poses"]]:
        """Names with units, and rates, of all joint coordinates; NaN at poses that are not closed."""
        closed, mechanism = np.asarray(self.closed), self.motion.mechanism
        per = "time" if self.order == 1 else f"time^{self.order}"
        names, rows = [], []
        for (joint, rates), made in zip(self.coordinates.items(), mechanism.joints.values(), strict=True):
            for column, coordinate in enumerate(made.coordinates):
                unit = (mechanism.unit or "length") if is_length(coordinate) else "rad"
                names.append(f"{joint}.{coordinate} [{unit}/{per}]")
                rows.append(np.where(closed, np.asarray(rates)[:, column], np.nan))
        return names, np.stack(rows) if rows else np.zeros((0, len(closed)))

    def points(self, part: str, point: Sequence[float | int] | np.ndarray | Array) -> Float[Array, "poses 3"]:
        """Velocity (acceleration, jerk) of a point of a part, given where it is in the assembled pose; world axes."""
        matrices = self.transforms[_known(self.motion, part)]
        return jnp.einsum("pij,j->pi", matrices[:, :3, :3], as_point(point)) + matrices[:, :3, 3]

    def angular(self, part: str) -> Float[Array, "poses 3"]:
        """Angular velocity (acceleration, jerk) of a part, world axes, radians per time to the power of the order."""
        rotation = self.motion.transforms[_known(self.motion, part)][:, :3, :3]
        number = self.motion.mechanism.parts.index(part)

        def skew_part(matrices: Float[Array, "poses 4 4"]) -> Float[Array, "poses 3"]:
            spin = jnp.einsum("pij,pkj->pik", matrices[:, :3, :3], rotation)
            return 0.5 * jnp.stack(
                [spin[:, 2, 1] - spin[:, 1, 2], spin[:, 0, 2] - spin[:, 2, 0], spin[:, 1, 0] - spin[:, 0, 1]], axis=-1
            )

        # the second derivative of R times R^T is [alpha] + [omega]^2, of which the skew part is [alpha]
        found = skew_part(self.matrices[number])
        if not self.lower:
            return found
        # the third one is [rate of alpha] + 2 [alpha][omega] + [omega][alpha] + [omega]^3
        omega, alpha = (skew_part(matrices[number]) for matrices in self.lower)
        square = jnp.sum(omega**2, axis=1, keepdims=True)
        return found - 0.5 * jnp.cross(alpha, omega) + square * omega


jax.tree_util.register_dataclass(
    Rates, data_fields=["motion", "inputs", "displacements", "matrices", "lower"], meta_fields=["order"]
)


def velocities(motion: Motion, rates: Mapping[str, Any], *, options: SolverOptions | None = None) -> Rates:
    """Velocities of all joints and parts in every pose of a motion, for given rates of its driven displacements.

    `rates` maps a driven "joint" or "joint.coordinate" to one number or one a pose, in radians or lengths per time;
    driven coordinates that it does not name are at rest. Poses are found anew with `options`, by default those of the
    motion. Works inside `jit`, `vmap` and `grad`. Raises ValueError for a name that is not driven and for arrays of
    another length.
    """
    tangents = tangents_of(motion, rates)
    place = placing(motion, options)
    found = jax.jvp(place, (motion.inputs,), (tangents,))[1]
    return Rates(motion, tangents, *_nan_where_nonfinite(motion, found, tangents))


def accelerations(
    motion: Motion,
    rates: Mapping[str, Any],
    accelerations: Mapping[str, Any] | None = None,
    *,
    options: SolverOptions | None = None,
) -> Rates:
    """Accelerations, for given rates and accelerations (none: constant rates) of the driven displacements.

    As `velocities`; second derivatives with respect to time.
    """
    first = tangents_of(motion, rates)
    second = tangents_of(motion, accelerations or {})
    place = placing(motion, options)

    def velocity(inputs: Inputs, tangents: Inputs):
        return jax.jvp(place, (inputs,), (tangents,))[1]

    found = jax.jvp(velocity, (motion.inputs, first), (first, second))[1]
    return Rates(motion, second, *_nan_where_nonfinite(motion, found, first, second), order=2)


def jerks(
    motion: Motion,
    rates: Mapping[str, Any],
    accelerations: Mapping[str, Any] | None = None,
    jerks: Mapping[str, Any] | None = None,
    *,
    options: SolverOptions | None = None,
) -> Rates:
    """Jerks, for given rates, accelerations and jerks (none: zero) of the driven displacements.

    As `velocities`; third derivatives with respect to time.
    """
    first, second, third = (tangents_of(motion, given or {}) for given in (rates, accelerations, jerks))
    place = placing(motion, options)

    def velocity(inputs: Inputs, tangents: Inputs):
        return jax.jvp(place, (inputs,), (tangents,))[1]

    def acceleration(inputs: Inputs, tangents: Inputs, changes: Inputs):
        return jax.jvp(velocity, (inputs, tangents), (tangents, changes))[1]

    found = jax.jvp(acceleration, (motion.inputs, first, second), (first, second, third))[1]
    displacements, matrices = _nan_where_nonfinite(motion, found, first, second, third)
    lower = (velocity(motion.inputs, first)[1], acceleration(motion.inputs, first, second)[1])
    return Rates(motion, third, displacements, matrices, _nan_where_nonfinite(motion, lower, first, second), order=3)


def placing(motion: Motion, options: SolverOptions | None) -> Callable[[Inputs], tuple]:
    """The function from inputs to displacements of all joints and transforms of all parts, which is differentiated."""
    options = options_with(options if options is not None else motion.options)

    def place(inputs: Inputs):
        found = sweep(motion.mechanism, inputs, options=options)
        return found.displacements, tuple(found.transforms.values())

    return place


def _nan_where_nonfinite(motion: Motion, found, *given: Inputs):
    """Set rates to NaN at poses that are NONFINITE, which the sweep replaces by others, and where given rates are."""
    finite = motion.status != Status.NONFINITE.value
    for rate in jax.tree.leaves(given):
        finite &= jnp.isfinite(rate)
    return nan_where_not_finite(found, finite)


def tangents_of(motion: Motion, rates: Mapping[str, Any]) -> Inputs:
    """Rates of all driven displacements, one a pose, from those that were given by name."""
    if not isinstance(motion, Motion):
        raise ValueError(f"rates are those of a motion, mechanism.sweep(drive), got {type(motion).__name__}")
    given = {}
    for key, rate in by_name(rates, "rates", f"{{{next(iter(motion.inputs))!r}: 1.0}}").items():
        value = rate if isinstance(rate, jax.Array) else np.asarray(rate, float)
        if value.ndim > 1 or (value.ndim == 1 and len(value) != len(motion)):
            raise ValueError(
                f"the rate of {key!r} must be one number or one for each of the {len(motion)} poses, got shape "
                f"{tuple(value.shape)}"
            )
        given[key] = jnp.broadcast_to(jnp.asarray(value, float), len(motion))
    driven = resolve(motion.mechanism.linkage, given) if given else {}
    given_rates = {name: jnp.asarray(entry.values) for name, entry in driven.items()}
    for name in given_rates:
        if name not in motion.inputs:
            raise ValueError(f"{name!r} is not driven in this motion{nearest(name, motion.inputs)}")
    return {
        name: given_rates.get(name, jnp.zeros_like(values)).astype(values.dtype)
        for name, values in motion.inputs.items()
    }


def _known(motion: Motion, part: str) -> str:
    if part not in motion.mechanism.parts:
        raise ValueError(f"there is no part {part!r}{nearest(part, motion.mechanism.parts)}")
    return part
