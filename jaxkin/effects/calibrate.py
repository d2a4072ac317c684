"""Calibration: lengths and places of joints from measured poses, by least squares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._arguments import by_name, check_known, check_mechanism, whole_number
from jaxkin.effects.calibration_data import MeasuredQuantity, data_of
from jaxkin.effects.calibration_result import Calibration
from jaxkin.effects.calibration_unknowns import Nominal, Unknowns, unknowns_of
from jaxkin.effects.rank_deficient_fit import Fit, fit, readable, told
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.targets import extent
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.options import SolverOptions, options_with

SMALL = 1e-6
"""Change of each unknown alone, over the size of the mechanism or in radians, to see whether the loops still close."""
PART_OF = {64: 1e-6, 32: 1e-3}
"""An unknown takes part in a direction that the data do not tell where its share of it is larger than this, by the bits
of numbers: rounding of derivatives over the least singular value that counts would be a hundredth of it."""


@dataclass(frozen=True)
class Model:
    """What is fitted to what: static to JAX."""

    unknowns: Unknowns
    kinds: tuple[MeasuredQuantity, ...]
    driven: tuple[Any, ...]
    """Keys of the drive."""
    options: SolverOptions


class _Numbers(NamedTuple):
    """The numbers of a calibration."""

    inputs: tuple[Any, ...]
    """Of the drive, in the order of `Model.driven`."""
    values: tuple[Any, ...]
    """Those of `Data`, and so are weights and middles."""
    weights: tuple[Any, ...]
    middles: tuple[Any, ...]
    nominal: Nominal

    @property
    def measured(self) -> int:
        """How many numbers were measured."""
        return sum(int(np.count_nonzero(weights)) for weights in self.weights)


def calibrate(
    mechanism: Mechanism,
    drive: Mapping[Any, object],
    measured: Mapping[Any, Any],
    *,
    lengths: Sequence[Any] = (),
    frames: Sequence[Any] | Mapping[Any, Any] = (),
    markers: Sequence[Any] = (),
    sigma: Any = None,
    iterations: int = 50,
    options: SolverOptions | None = None,
) -> Calibration:
    """Fit lengths and places of joints to measured poses, and tell how sure they are and what the data do not tell.

    `drive` gives the displacements of the inputs in the measured poses, as in `mechanism.sweep`; they are taken as
    exact. `measured` maps to values, one a pose and NaN where there is none: "joint" or "joint.coordinate" to
    displacements from the assembled pose; `jk.point(part, at)` to places (poses, 3); `jk.pose(part)` to displacements
    (poses, 4, 4) and `jk.orientation(part)` to rotations (poses, 3, 3) from the assembled pose; in world coordinates.

    Unknown are `lengths`, keys of `mechanism.lengths`; `frames`, joints or (part, joint), as in `with_frames`; and
    `markers`, those of the measured points whose place on the part is unknown too. A frame changes by x, y, z and
    the rotation vector rx, ry, rz along the axes of the world, in a planar mechanism by x, y, rz only (where its normal
    is not the z axis of the world, along two axes in the plane); a mapping says which: `{("crank", "A"): ("rz",)}` is
    the zero of the joint.

    `sigma` is the standard deviation of the measured numbers, one for all, or one for each key (of a pose two: lengths,
    angles). It weighs them and makes the covariance; without it, all numbers must be lengths or all angles, and their
    deviation is estimated from the residuals. The covariance is of first order: (J^T J)^-1 with the weighted Jacobian.

    The fit takes steps of least norm from the given mechanism, so that it finds the solution near it; one that does
    not close at a measured pose, or makes a length without a sign negative, is no step. Combinations of unknowns that
    change nothing measured stay as they are, and are named. Raises ValueError for names and shapes that do not fit, a
    given mechanism that does not close at all measured poses, rotations that are half a turn from it, unknowns that the
    loops have no room for, data that tell none of the unknowns, and for traced numbers.
    """
    check_mechanism(mechanism, "calibrations")
    iterations = whole_number(iterations, "iterations", 1)
    driven = by_name(drive, "driven displacements", "{'A': angles}")
    measurements = by_name(measured, "measurements", "{'D': angles}")
    weights = tuple(sigma.values()) if isinstance(sigma, Mapping) else sigma
    numbers = (*driven.values(), *measurements.values(), weights)
    check_known("calibrations", "jk.calibrate", mechanism, *numbers)
    motion = mechanism.sweep(driven, options=options)
    _check_start(motion.on_branch)
    data = data_of(mechanism, measured, sigma, len(motion))
    data.check_turns(motion)
    unknowns, nominal = unknowns_of(mechanism, lengths, frames, markers, measured)
    model = Model(unknowns, data.kinds, tuple(driven), options_with(options))
    inputs = tuple(np.asarray(values, float) for values in driven.values())
    known = _Numbers(inputs, data.values, data.weights, data.middles, nominal)
    low, high = unknowns.ranges(mechanism.linkage).T
    scales = np.where(unknowns.are_angles(mechanism.linkage), 1.0, extent(mechanism))

    def evaluate(scaled: Float[np.ndarray, " unknowns"]):
        changes = scales * scaled
        rows, slopes, reached = jax.device_get(_residuals(model, mechanism, known, changes))
        valid = bool(np.all(reached) and np.isfinite(rows).all() and np.isfinite(slopes).all())
        valid &= bool(np.all((low <= nominal.values + changes) & (nominal.values + changes <= high)))
        return rows, slopes * scales, valid

    for number, name in enumerate(unknowns.names):
        if not evaluate(SMALL * np.eye(len(scales))[number])[2]:
            raise ValueError(
                f"the loops do not close where {name!r} changes a little: an overconstrained mechanism has no room for "
                "it; leave it out, or give lengths that keep the mechanism what it is"
            )
    found = fit(evaluate, np.zeros(len(scales)), iterations, _bits())
    return _result(mechanism, model, known, scales, found, given_sigma=sigma is not None)


@partial(whole_program, static=(0,))
def _residuals(model: Model, mechanism: Mechanism, numbers: _Numbers, changes: Float[Array, " unknowns"]):
    """Compute weighted residuals, their derivatives by the unknowns, and which poses are on the branch."""

    def rows(changes: Float[Array, " unknowns"]):
        found, markers = model.unknowns.applied(mechanism, numbers.nominal, changes)
        motion = found.sweep(dict(zip(model.driven, numbers.inputs, strict=True)), options=model.options)
        off = [
            (weight * kind.residual(motion, value, markers, middle)).ravel()
            for kind, value, weight, middle in zip(
                model.kinds, numbers.values, numbers.weights, numbers.middles, strict=True
            )
        ]
        return jnp.concatenate(off), motion.on_branch

    def twice(changes: Float[Array, " unknowns"]):
        found, reached = rows(changes)
        return found, (found, reached)

    slopes, (found, reached) = jax.jacfwd(twice, has_aux=True)(changes)
    return found, slopes, reached


def _result(
    mechanism: Mechanism,
    model: Model,
    numbers: _Numbers,
    scales: Float[np.ndarray, " unknowns"],
    found: Fit,
    given_sigma: bool,
) -> Calibration:
    """Make the result: covariance, and directions that are not told, from the Jacobian at the end of the fit.

    Without a `given_sigma` the standard deviation of what was measured is that of the residuals.
    """
    nominal = numbers.nominal
    bits = _bits()
    singular, directions, rest = told(found.jacobian, bits)
    if not len(singular):
        raise ValueError("the measured values do not depend on any of the unknowns: they tell nothing about them")
    changes = scales * found.unknowns
    fitted, _ = model.unknowns.applied(mechanism, nominal, changes)
    freedom = numbers.measured - len(singular)
    square = float(found.residuals @ found.residuals)
    deviation = float(np.sqrt(square / freedom)) if freedom > 0 else np.nan
    scaled = (directions / singular[:, None]).T
    covariance = scales[:, None] * (scaled @ scaled.T) * scales * (1.0 if given_sigma else deviation**2)
    lost = np.linalg.norm(rest, axis=0) > PART_OF[bits]
    covariance[lost] = covariance[:, lost] = np.nan
    names = model.unknowns.names
    residuals, first = {}, 0
    for kind, weights in zip(model.kinds, numbers.weights, strict=True):
        rows = found.residuals[first : first + weights.size].reshape(weights.shape)
        first += weights.size
        residuals[kind.name] = np.where(weights > 0, rows / np.where(weights > 0, weights, 1.0), np.nan)
    return Calibration(
        mechanism=fitted,
        names=names,
        given=nominal.values,
        values=np.where(lost, np.nan, nominal.values + changes),
        covariance=covariance,
        undetermined=tuple(_named(names, row, scales) for row in readable(rest)),
        residuals=residuals,
        of_lengths={kind.name: np.array(kind.lengths) for kind in model.kinds},
        deviation=deviation,
        degrees_of_freedom=freedom,
        condition=float(singular[0] / singular[-1]),
        iterations=found.iterations,
        converged=found.converged,
        unit=mechanism.unit,
    )


def _bits() -> int:
    """Count the bits of the numbers in which motions are computed: 64, or 32 where x64 is off."""
    return int(jnp.finfo(jnp.result_type(float)).bits)


def _named(
    names: Sequence[str], row: Float[np.ndarray, " unknowns"], scales: Float[np.ndarray, " unknowns"]
) -> dict[str, float]:
    """List the unknowns that take part in a direction of scaled unknowns, and by how much: one that takes the largest
    part by 1.

    Which take part is told in scaled unknowns, whatever the unit: lengths in micrometres have numbers a million times
    those of the angles that go with them.
    """
    parts = np.abs(row)
    amounts = row * scales / (row * scales)[parts.argmax()]
    taken = parts > PART_OF[_bits()] * parts.max()
    return {name: float(each) for name, each, part in zip(names, amounts, taken, strict=True) if part}


def _check_start(reached: Bool[Array, " poses"]) -> None:
    """Raise ValueError where the given mechanism misses measured poses: `reached` tells at which it closes."""
    lost = np.flatnonzero(~np.asarray(reached))
    if len(lost):
        raise ValueError(
            f"the given mechanism does not close at {len(lost)} of {len(reached)} measured poses, first at pose "
            f"{lost[0]}: start from lengths with which it does, or leave these poses out"
        )
