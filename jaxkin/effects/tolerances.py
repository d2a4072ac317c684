"""Tolerances of lengths and clearances of joints: how far they move what a mechanism is measured by."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, check_mechanism, whole_number
from jaxkin._traced import traced
from jaxkin.dimensions.lengths import find_length, lengths_now, range_of
from jaxkin.effects.design_batch import DesignMeasure, evaluate, evaluate_batch, value_and_slopes
from jaxkin.effects.pin_play import directions_of_play
from jaxkin.effects.tolerance import Tolerance, as_tolerance, named
from jaxkin.effects.tolerance_result import Tolerances
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.targets import Target
from jaxkin.solve.options import SolverOptions, options_with

SMALL = 1e-3
"""The part of a tolerance by which each length is changed alone, to see whether the loops still close."""


def tolerances(
    mechanism: Mechanism,
    lengths: Mapping[Any, Any],
    measure: Callable[..., Any],
    *,
    drive: Mapping[Any, object] | None = None,
    clearances: Mapping[str, Any] | None = None,
    wanted: tuple[float, float] | None = None,
    samples: int = 10_000,
    seed: int = 0,
    label: str = "measure",
    options: SolverOptions | None = None,
) -> Tolerances:
    """Find how far a measure deviates for given tolerances of lengths: worst case, root sum of squares, Monte Carlo.

    `lengths` maps keys of `mechanism.lengths` to tolerances in the unit of the length (angles in radians): a number t
    is plus and minus t, all values as likely; `jk.sigma(s)` is a normal distribution. `clearances` maps revolute,
    cylindrical or spherical joints to how far the centre of the pin may lie from that of its hole (half the difference
    of the diameters): anywhere within that circle or ball, or `jk.sigma(s)` along each axis. The axes stay parallel.

    `measure` returns one number. With a `drive` it is a function of the pose, where the drive gives one displacement a
    coordinate, as in `mechanism.solve`; of the motion where it gives arrays, as in `mechanism.sweep`. Without a drive
    it is a function of the mechanism, and whether the poses close that it looks at is not known here: it returns
    `jnp.where(jnp.all(motion.closed), value, jnp.nan)` where designs may not. It is computed by jax.numpy, and `label`
    is what it is called in print.

    With s the derivatives of the measure by the n lengths, t their limits (three times the deviation of `jk.sigma`) and
    sigma_i their standard deviations (t / sqrt(3) of an even distribution):

        worst case           = sum |s_i| t_i
        root sum of squares  = sqrt(sum (s_i t_i)^2)
        standard deviation   = sqrt(sum (s_i sigma_i)^2), the share of each length in its square in percent

    These are of first order. `samples` designs are drawn and evaluated in full, as batches on all cores: none of the
    three is assumed there. With `wanted`, (low, high), the yield is the share of designs whose measure is within.

    With `samples=0`, numbers may be traced: the result can be differentiated by the mechanism, the drive and the
    tolerances, as a loss. Raises ValueError for names that are not there, tolerances that are no positive numbers or
    reach below zero, lengths that the loops leave no room for, a measure that is not one finite number, and a nominal
    mechanism that does not close.
    """
    stated = {key: as_tolerance(f"length {key!r}", given) for key, given in _lengths(lengths).items()}
    played = {
        name: as_tolerance(f"clearance {name!r}", given)
        for name, given in by_name(clearances or {}, "clearances", "{'B': 0.02}").items()
    }
    if not stated and not played:
        raise ValueError("tolerances need at least one length or clearance, as {('coupler', 'B', 'C'): 0.05}")
    if not callable(measure):
        raise ValueError(f"the measure must be a function of the pose, motion or mechanism, got {measure!r}")
    check_mechanism(mechanism, "tolerances")
    drive = by_name(drive or {}, "driven displacements", "{'A': 0.3}")
    samples, seed = whole_number(samples, "samples"), whole_number(seed, "seed")
    nominal = _nominal(mechanism, stated)
    limits = _limits_of(wanted)
    directions = {name: directions_of_play(mechanism.linkage, name) for name in played}
    measured = DesignMeasure(
        measure,
        tuple(stated),
        tuple(directions.items()),
        tuple(drive),
        bool(drive) and _is_one_pose(drive),
        options_with(options),
    )
    driven = tuple(_displacements(key, value) for key, value in drive.items())
    places = np.zeros(sum(directions.values()))
    on_host = not traced(mechanism, driven, nominal, *stated.values(), *played.values())
    start = np.concatenate([nominal, places]) if on_host else jnp.concatenate([jnp.asarray(nominal, float), places])
    value, reached, slopes = value_and_slopes(measured, mechanism, driven, start)
    sizes = [1] * len(stated) + list(directions.values())
    if on_host:
        _check_nominal(float(value), bool(reached), np.asarray(slopes))
        value, slopes = float(value), np.asarray(slopes)
    elif samples:
        raise ValueError("samples are drawn on the host: inside jit, vmap and grad say samples=0")
    found = Tolerances(
        label=label,
        unit=mechanism.unit,
        keys=(*stated, *played),
        stated=(*stated.values(), *played.values()),
        dimensions=tuple(sizes),
        nominal_lengths=tuple(nominal) + (0.0,) * len(played),
        nominal=value,
        slopes=slopes,
        wanted=limits,
    )
    if not on_host:
        full = partial(evaluate_batch, measured, mechanism, driven)
        return replace(found, in_full=partial(_extremes, found, full, jnp.asarray(start)))
    poses = 1 if measured.one_pose or not driven else len(driven[0])
    evaluated = partial(evaluate, measured, mechanism, driven, poses=poses)
    return _sampled(found, evaluated, np.asarray(start), samples, seed)


def _extremes(
    found: Tolerances, evaluated: Callable[[Array], tuple[Array, Array]], start: Float[Array, " numbers"]
) -> tuple[Array, Array]:
    """Evaluate the two designs of the worst case where numbers are traced; NaN where one does not close."""
    worst = found.worst_deviations()
    values, reached = evaluated(start + jnp.stack([-worst, worst]))
    low, high = jnp.where(reached & jnp.isfinite(values), values, jnp.nan)
    return low, high


def _sampled(
    found: Tolerances,
    evaluated: Callable[[Float[np.ndarray, "designs numbers"]], tuple[np.ndarray, np.ndarray]],
    start: Float[np.ndarray, " numbers"],
    samples: int,
    seed: int,
) -> Tolerances:
    """Evaluate the two designs of the worst case, small changes of each length alone, and those drawn at random.

    `evaluated` is `design_batch.evaluate` of designs.
    """
    worst = found.worst_deviations()
    alone = np.diag(SMALL * np.repeat(np.asarray(found.limits), found.dimensions))
    drawn = np.zeros((0, len(start)))
    if samples:
        random = np.random.default_rng(seed)
        drawn = np.concatenate(
            [each.drawn(random, samples, size) for each, size in zip(found.stated, found.dimensions, strict=True)],
            axis=1,
        )
    values, reached = evaluated(start + np.concatenate([-worst[None], worst[None], alone, drawn]))
    rows = np.repeat(np.arange(len(found.keys)), found.dimensions)
    closes = reached[2 : 2 + len(alone)]
    if not closes.all():
        keys = dict.fromkeys(found.keys[row] for row in rows[~closes])
        raise ValueError(
            f"the loops do not close, or the measure is no number, for a small change of "
            f"{', '.join(map(named, keys))} alone: an overconstrained mechanism has no room for it; leave it out"
        )
    return found.with_values((float(values[0]), float(values[1])), values[2 + len(alone) :])


def _lengths(given: Any) -> Mapping[Any, Any]:
    return by_name(given, "tolerances", "{('coupler', 'B', 'C'): 0.05}")


def _nominal(mechanism: Mechanism, stated: Mapping[Any, Tolerance]) -> list[Any]:
    """Look up the nominal lengths; ValueError where a tolerance reaches below zero, or does not fit others."""
    nominal = lengths_now(mechanism.linkage, list(stated))
    if traced(nominal, *stated.values()) or not stated:
        return nominal
    for (key, tolerance), now in zip(stated.items(), nominal, strict=True):
        low, high = range_of(find_length(mechanism.linkage, key))
        if now - tolerance.limit < low or now + tolerance.limit > high:
            advice = (
                "axes that are parallel or meet, and points that coincide, deviate to all sides: state a clearance "
                "there, or move a frame by with_frames in a measure of your own"
            )
            raise ValueError(f"length {key!r} is {now:.4g}, and {tolerance} reaches below what it can be; {advice}")
    # new lengths of one part may contradict each other: said here, where messages can be made
    shares = np.linspace(0.3, 0.9, len(stated))
    mechanism.with_lengths(
        {
            key: now + share * tolerance.limit
            for (key, tolerance), now, share in zip(stated.items(), nominal, shares, strict=True)
        }
    )
    return nominal


def _displacements(key: Any, value: Any) -> Any:
    """Return the displacements of a drive as an array; ValueError where they are no numbers, or there are none."""
    if traced(value):
        return value
    try:
        found = np.asarray(value, float)
    except (TypeError, ValueError):
        raise ValueError(f"drive {key!r}: the displacements must be real numbers, got {value!r}") from None
    if not found.size:
        raise ValueError(f"drive {key!r} has no poses: nothing can be measured there, got {value!r}")
    return found


def _is_one_pose(drive: Mapping[Any, Any]) -> bool:
    """Tell whether a drive gives one displacement, or one target, for each of its keys."""
    single = {"pose": 2, "point": 1, "orientation": 2}
    return all(np.ndim(value) == (single[key.kind] if isinstance(key, Target) else 0) for key, value in drive.items())


def _limits_of(wanted: Any) -> tuple[float, float] | None:
    """Return the limits (low, high) that are wanted of a measure; ValueError for others than two rising numbers."""
    if wanted is None:
        return None
    try:
        low, high = map(float, wanted)
        if not low < high:
            raise ValueError
    except (TypeError, ValueError):
        raise ValueError(f"wanted must be (low, high), two numbers in rising order, got {wanted!r}") from None
    return low, high


def _check_nominal(value: float, reached: bool, slopes: Float[np.ndarray, " numbers"]) -> None:
    """Raise ValueError where the nominal mechanism does not close, or its measure is no number or has no derivative."""
    if not reached:
        raise ValueError(
            "the nominal mechanism does not close for this drive: tolerances are asked about one that works; sweep it "
            "and look at its status"
        )
    if not np.isfinite(value):
        raise ValueError(f"the measure of the nominal mechanism is {value}: it must be a finite number")
    if not np.isfinite(slopes).all():
        raise ValueError(
            "the measure has no derivative at the nominal lengths (NaN or infinite): look for a square root or a norm "
            "of zero in it, or for a dead point of the mechanism"
        )
