"""What `tolerances` finds: sensitivities, spreads and yield; and the tolerances that a wanted error allows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import positive_number
from jaxkin._files import quoted, save_table
from jaxkin._guesses import Result
from jaxkin._names import closest
from jaxkin._traced import traced
from jaxkin.effects.tolerance import Tolerance, named
from jaxkin.geometry.root import root

RULES = ("worst case", "root sum of squares")
SIZE_OF_NONE = 1e-13
"""Sensitivities that are this much smaller than the largest one, limits counted in, are rounding of none."""


@dataclass(frozen=True, eq=False, repr=False)
class Tolerances(Result):
    """How far a measure deviates for given tolerances. Prints, draws and saves itself.

    Rows are the lengths, then the clearances, in the order in which they were given.
    """

    label: str
    """What the measure is called."""
    unit: str
    """Unit of the lengths."""
    keys: tuple[Any, ...]
    """Names of the lengths, and joints of the clearances."""
    stated: tuple[Tolerance, ...]
    """The tolerance of each."""
    dimensions: tuple[int, ...]
    """In how many directions each deviates: 1 for a length, 2 for a pin in its hole, 3 for a ball."""
    nominal_lengths: tuple[Any, ...]
    """Nominal lengths; zero for clearances."""
    nominal: float | Array
    """The measure of the nominal mechanism."""
    slopes: Float[np.ndarray | Array, " numbers"]
    """Derivatives of the measure by the lengths, then by the offsets of pins along the axes of their joint frames."""
    wanted: tuple[float, float] | None = None
    """The measure that designs shall have, lowest and highest."""
    in_full: tuple[float, float] | Callable[[], tuple[Array, Array]] = (np.nan, np.nan)
    """The `extremes`, or what computes them where numbers are traced, and only what is asked for should be computed."""
    samples: Float[np.ndarray, " samples"] = field(default_factory=lambda: np.zeros(0))
    """The measure of designs drawn at random; NaN for designs that do not close."""

    @cached_property
    def extremes(self) -> tuple[float, float] | tuple[Array, Array]:
        """The measure of the two designs that the worst case stands for, computed in full; NaN where one does not
        close."""
        return self.in_full() if callable(self.in_full) else self.in_full

    @cached_property
    def sensitivities(self) -> Float[np.ndarray | Array, " rows"]:
        """The derivative of the measure by each length; of a clearance that in the direction in which it is largest."""
        xp = jnp if traced(self.slopes) else np
        rows, first = [], 0
        for size in self.dimensions:
            part = self.slopes[first : first + size]
            rows.append(part[0] if size == 1 else _root(xp.sum(part**2)))
            first += size
        return xp.stack(rows)

    @property
    def limits(self) -> Float[np.ndarray | Array, " rows"]:
        """The deviation of each that the worst case counts with."""
        return _row([each.limit for each in self.stated])

    @property
    def deviations(self) -> Float[np.ndarray | Array, " rows"]:
        """The standard deviation of each; of a clearance that along one axis."""
        return _row([each.standard_deviation(size) for each, size in zip(self.stated, self.dimensions, strict=True)])

    @property
    def worst_case(self) -> float | Array:
        """Largest deviation of the measure in first order: sum |s_i| t_i."""
        return abs(self.sensitivities * self.limits).sum()

    @property
    def root_sum_of_squares(self) -> float | Array:
        """Deviation of the measure where deviations partly cancel: sqrt(sum (s_i t_i)^2)."""
        return _root(((self.sensitivities * self.limits) ** 2).sum())

    @property
    def standard_deviation(self) -> float | Array:
        """Standard deviation of the measure in first order: sqrt(sum (s_i sigma_i)^2)."""
        return _root(((self.sensitivities * self.deviations) ** 2).sum())

    @property
    def contributions(self) -> Float[np.ndarray | Array, " rows"]:
        """The share of each in the variance of the measure, percent; zeros where nothing contributes."""
        squares = (self.sensitivities * self.deviations) ** 2
        total = squares.sum()
        xp = jnp if traced(squares) else np
        return 100.0 * squares / xp.where(total > 0, total, 1.0)

    @property
    def not_closed(self) -> int:
        """How many of the samples do not close for the drive, or have a measure that is no finite number."""
        return int(np.isnan(self.samples).sum())

    @property
    def within(self) -> float | None:
        """The yield: which share of the samples, 0 to 1, has a wanted measure. None without samples or `wanted`.

        Designs that do not close are not within.
        """
        if self.wanted is None or not len(self.samples):
            return None
        return float(np.mean((self.samples >= self.wanted[0]) & (self.samples <= self.wanted[1])))

    def worst_deviations(self) -> Float[np.ndarray | Array, " numbers"]:
        """Find the deviations that together raise the measure most to first order; reversed they lower it most.

        Where the first order is zero, as at an extremum of the measure, a deviation goes to its limit all the same: the
        designs that are computed in full show what the second order does.
        """
        xp = jnp if traced(self.slopes, self.limits) else np
        parts, first = [], 0
        for limit, size in zip(self.limits, self.dimensions, strict=True):
            slope = xp.asarray(self.slopes[first : first + size])
            length = _root(xp.sum(slope**2))
            direction = slope / xp.where(length > 0, length, 1.0)
            parts.append(limit * xp.where(length > 0, direction, np.eye(size)[0]))
            first += size
        return xp.concatenate(parts)

    def with_values(self, extremes: tuple[float, float], samples: Float[np.ndarray, " samples"]) -> Tolerances:
        """Add the measures of designs that were evaluated in full."""
        return replace(self, in_full=extremes, samples=samples)

    def allowed(
        self, error: float | int, rule: Literal["worst case", "root sum of squares"] = "worst case"
    ) -> AllowedTolerances:
        """Find the tolerances for which the deviation of the measure is `error`, in first order, by one of two rules.

        `scaled` are those given, all by one factor; with `equal` every length contributes the same, so that lengths to
        which the measure is sensitive get small ones. Raises ValueError for an error that is not positive, another
        rule, and a measure that depends on no length.
        """
        if rule not in RULES:
            raise ValueError(f"rule must be one of {', '.join(RULES)}, got {rule!r}{closest(rule, RULES)}")
        error = float(positive_number(error, "the wanted error", "a positive number"))
        sizes = np.abs(np.asarray(self.sensitivities))
        weights = sizes * self.limits
        counted = weights > SIZE_OF_NONE * weights.max()
        if not counted.any():
            raise ValueError("the measure does not depend on any of these lengths, so that any tolerance is allowed")
        whole_now = self.worst_case if rule == RULES[0] else self.root_sum_of_squares
        share = error / counted.sum() if rule == RULES[0] else error / np.sqrt(counted.sum())
        equal = np.where(counted, share / np.where(counted, sizes, 1.0), np.inf)
        scale = float(error / whole_now)
        return AllowedTolerances(
            error,
            rule,
            scale,
            dict(zip(self.keys, (scale * self.limits).tolist(), strict=True)),
            dict(zip(self.keys, equal.tolist(), strict=True)),
            self.unit,
        )

    def __str__(self) -> str:
        unit = f" [{self.unit}]" if self.unit else ""
        names = [*map(named, self.keys)]
        width = max(map(len, names))
        lines = [
            f"{self.label}: {self.nominal:.6g} nominal",
            f"  worst case           ± {self.worst_case:.4g}, computed in full {_interval(self.extremes)}",
            f"  root sum of squares  ± {self.root_sum_of_squares:.4g}",
            f"  standard deviation     {self.standard_deviation:.4g}",
        ]
        if len(self.samples):
            good = self.samples[~np.isnan(self.samples)]
            lines.append(f"  {len(self.samples)} samples: {_spread(good)}")
            if self.not_closed:
                lines.append(f"    {self.not_closed} of them do not close")
        if self.wanted is not None and self.within is not None:
            # with two samples more on either side (Agresti and Coull): where all are within, some of many may not be
            count = len(self.samples) + 4
            share = (self.within * len(self.samples) + 2) / count
            error = np.sqrt(share * (1 - share) / count)
            lines.append(f"  yield {100 * self.within:.2f} ± {100 * error:.2f} % within {_interval(self.wanted)}")
        lines.append(f"  {'length' + unit:<{width}}  {'nominal':>10}  {'tolerance':>12}  sensitivity  contribution")
        rows = zip(names, self.nominal_lengths, self.stated, self.dimensions, strict=True)
        for (name, now, stated, size), slope, share in zip(rows, self.sensitivities, self.contributions, strict=True):
            what = f"{now:.6g}" if size == 1 else ""
            lines.append(f"  {name:<{width}}  {what:>10}  {stated!s:>12}  {slope:>11.4g}  {share:>10.1f} %")
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw the contributions as bars, and the samples as a histogram, into a picture file; returns its path."""
        from jaxkin.effects.tolerance_plot import Deviation, draw_tolerances

        numbers = float(self.nominal), float(self.worst_case), float(self.root_sum_of_squares)
        deviation = Deviation(*numbers, self.wanted, self.within)
        names = [named(key) for key in self.keys]
        return draw_tolerances(names, np.asarray(self.contributions), self.samples, deviation, self.label, Path(path))

    def save(self, path: str | Path) -> Path:
        """Write the rows of the table as comma-separated values; returns the path."""
        heading = ["name", "nominal", "limit", "standard deviation", "sensitivity", "contribution percent"]
        columns = (self.nominal_lengths, self.limits, self.deviations, self.sensitivities, self.contributions)
        names = (quoted(named(key)) for key in self.keys)
        return save_table(heading, names, [np.asarray(column, float) for column in columns], Path(path))


@dataclass(frozen=True, repr=False)
class AllowedTolerances(Result):
    """The tolerances that a wanted error of a measure allows, in first order."""

    error: float
    """The wanted error of the measure, plus and minus."""
    rule: str
    """How deviations add up: "worst case" or "root sum of squares"."""
    scale: float
    """The factor by which the given tolerances may grow, or have to shrink."""
    scaled: Mapping[Any, float]
    """The given limits times that factor."""
    equal: Mapping[Any, float]
    """The limits with which each length contributes the same; infinite for those without influence."""
    unit: str
    """Unit of the lengths."""

    def __str__(self) -> str:
        names = {key: named(key) for key in self.scaled}
        width = max(map(len, names.values()))
        unit = f" [{self.unit}]" if self.unit else ""
        lines = [f"for an error of ± {self.error:.4g} by {self.rule}: {self.scale:.4g} times the tolerances given"]
        lines.append(f"  {'length' + unit:<{width}}  {'scaled':>10}  {'equal shares':>12}")
        for key, name in names.items():
            equal = f"± {self.equal[key]:.4g}" if np.isfinite(self.equal[key]) else "any"
            lines.append(f"  {name:<{width}}  {f'± {self.scaled[key]:.4g}':>10}  {equal:>12}")
        return "\n".join(lines)


def _row(entries: list[Any]) -> Any:
    """Make a row of numbers, of JAX where one is traced."""
    return jnp.stack(entries) if traced(entries) else np.array(entries)


def _root(square: Any) -> Any:
    """Compute a square root: of a traced zero with a derivative of zero, since that of `jnp.sqrt` is no number."""
    return root(square) if traced(square) else np.sqrt(square)


def _interval(pair: tuple[float | Array, float | Array]) -> str:
    return " to ".join("not closed" if np.isnan(end) else f"{end:.6g}" for end in pair)


def _spread(good: Float[np.ndarray, " samples"]) -> str:
    """Tell mean, standard deviation and range of the samples that close."""
    if not len(good):
        return "none closes"
    deviation = good.std(ddof=1) if len(good) > 1 else 0.0
    return f"mean {good.mean():.6g}, standard deviation {deviation:.4g}, {_interval((good.min(), good.max()))}"
