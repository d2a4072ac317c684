"""What a user may ask of the solver: one object, passed from the sweep down to the correctors.

To add an option: a field here, with its docstring; a whole number, 1 or more, is checked already. All that runs in the
compiled program has the options at hand: correctors and continuation as `problem.options`
(`jaxkin.solve.correctors.problem`), `range.solve_range` as `options`, so that no signature changes.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cache, cached_property
from typing import Any

import numpy as np

from jaxkin._names import closest
from jaxkin._traced import traced

CONTINUATION = "continuation"
"""The method of jaxkin: the branch of the assembled pose is traced, then all poses are corrected at once by Newton's
method, with the Levenberg-Marquardt method for those that it does not close."""
METHODS = (CONTINUATION, "gauss-newton", "levenberg-marquardt", "bfgs", "dfp", "dfp-autodiff")
"""All methods by name. Those other than the continuation minimise Eq. 12 one pose after the other, for comparison:
see `jaxkin.solve.reference_methods.minimise`. "dfp" is the method of the paper."""


@dataclass(frozen=True, kw_only=True)
class SolverOptions:
    """How poses are found: accuracy, method, limits on the work, cores. Immutable and hashable.

    A sweep is compiled anew for other values of all fields but `tolerance`, `formulas`, `cores` and `min_shard_poses`;
    the latter two only decide into how many shards a range is cut, for each number of which a program is compiled.
    Raises ValueError for a value that a field cannot have.
    """

    tolerance: float | None = None
    """Largest closure residual of a closed pose (square root of Eq. 12, lengths over the characteristic length), at
    which a pose is improved no further. None: 1e-12 (2e-6 in float32), and poses improved down to rounding, which
    leaves about 1e-15 for each elementary motion (5e-7 in float32): poses above a tolerance less than that are
    STALLED."""
    method: str = CONTINUATION
    """One of `METHODS`."""
    formulas: bool = True
    """Whether the poses of loops that have a formula are computed by it, with a single input, in float64:
    `mechanism.plan(drive)` says which. The continuation is left for sweeps with poses to which the formulas do not
    prove that the motion leads, such as those behind a limit; for long ranges, which are interpolated; and inside
    functions that JAX traces, for mechanisms whose input does not make full turns. But where the geometry is traced,
    as by `vmap` over designs, there are formulas alone: a pose that does not close is then where the formula has it,
    not at its least residual, and poses behind a change point, or within 1e-6 of a limit, are STALLED. False: the
    continuation for all."""
    max_steps: int | None = None
    """Steps of the continuation to either side of the assembled pose, at most; poses that they do not reach are
    STALLED. None: 1024, or 2 a pose (12 with several inputs) of at most 1024 poses, whichever is more."""
    newton_iterations: int = 4
    """Iterations of Newton's method, at most: each squares the residual of a prediction (1e-2, 1e-4, 1e-8, 1e-16)."""
    damped_steps: int = 8
    """Steps of the damped corrector, at most, for one step of the continuation that Newton's method did not close. More
    would only come from a prediction that is too far away: a shorter step of the continuation costs less."""
    limit_steps: int = 16
    """Steps of the damped corrector, at most, for one step of the continuation beyond a limit of the motion, where the
    residual is large and convergence linear."""
    rescue_steps: int = 200
    """Steps of the damped corrector, at most, for the assembled pose, and for a pose that is to be closed or to be
    brought to its least residual by itself; ten times as many for a pose far beyond a limit."""
    interpolate_from: int = 8192
    """Ranges of at least this number of poses are interpolated between a few that were solved, and checked, but
    for those that formulas of all loops find."""
    cores: int | None = None
    """Processor cores that share a range, at most. None: all that this process may use."""
    min_shard_poses: int | None = None
    """Poses that one core is given, at least: for fewer, tracing the branch to them takes longer than finding them.
    None: 16384, and 128 for loops of twenty joints and more."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "tolerance", _positive_number(self.tolerance))
        if self.method not in METHODS:
            raise ValueError(
                f"there is no method {self.method!r} among {', '.join(METHODS)}{closest(self.method, METHODS)}"
            )
        if not isinstance(self.formulas, bool):
            raise ValueError(f"formulas must be True or False, got {self.formulas!r}")
        for field in fields(self):
            if field.name not in ("tolerance", "method", "formulas"):
                object.__setattr__(self, field.name, _count(field.name, getattr(self, field.name), field.default))

    @cached_property
    def of_program(self) -> SolverOptions:
        """The options that the code of a program depends on; the others at their defaults."""
        return replace(self, tolerance=None, formulas=True, cores=None, min_shard_poses=None)


_defaults = cache(SolverOptions)


def options_with(options: SolverOptions | None, tolerance: Any = None, method: str | None = None) -> SolverOptions:
    """Put the shorthands `tolerance=` and `method=` of a call into its options.

    A traced `tolerance` is left out: options are static. Raises ValueError for what is no `SolverOptions`, and where a
    shorthand and the options both say the same thing.
    """
    if options is not None and not isinstance(options, SolverOptions):
        raise ValueError(
            f"options must be a jk.SolverOptions, such as jk.SolverOptions(tolerance=1e-9), got {options!r}"
        )
    if options is None:
        options = _defaults()
    if tolerance is not None:
        _refuse_both("tolerance", tolerance, options.tolerance, None)
        if not traced(tolerance):
            options = replace(options, tolerance=tolerance)
    if method is not None:
        _refuse_both("method", method, options.method, CONTINUATION)
        options = replace(options, method=method)
    return options


def _refuse_both(name: str, shorthand: object, of_options: object, default: object) -> None:
    if of_options != default:
        raise ValueError(
            f"{name} is given twice, as {name}={shorthand!r} and as options=SolverOptions({name}={of_options!r}): "
            "write one of them"
        )


def _positive_number(tolerance: Any) -> float | None:
    if tolerance is None:
        return None
    if traced(tolerance):
        raise ValueError(
            "SolverOptions are static, and this tolerance is traced by JAX: write sweep(drive, tolerance=...) instead"
        )
    try:
        given = np.asarray(tolerance, float)
        if isinstance(tolerance, str | bool) or given.shape or not 0 < given < np.inf:
            raise ValueError
    except (TypeError, ValueError):
        raise ValueError(f"tolerance must be a positive finite number such as 1e-9, got {tolerance!r}") from None
    return float(given)


def _count(name: str, value: Any, default: Any) -> int | None:
    if value is None and default is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 1:
        example = default or 2
        raise ValueError(
            f"{name} must be a whole number, 1 or more, such as jk.SolverOptions({name}={example}), got {value!r}"
        )
    return int(value)
