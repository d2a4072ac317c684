"""What a calibration finds: the fitted mechanism, how sure its numbers are, and what the data do not tell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._files import quoted, save_table
from jaxkin._guesses import Result
from jaxkin.effects.pose_axis import PoseAxis
from jaxkin.effects.pose_plot import draw_lines
from jaxkin.mechanism.mechanism import Mechanism


@dataclass(frozen=True, eq=False, repr=False)
class Calibration(Result):
    """A mechanism fitted to measured poses. Prints, draws and saves itself.

    Unknowns are lengths as they are, and changes of frames, in the unit of the mechanism and in radians.
    """

    mechanism: Mechanism
    """The fitted mechanism. Combinations of unknowns that the data do not tell are as they were given."""
    names: tuple[str, ...]
    """Names of the unknowns."""
    given: Float[np.ndarray, " unknowns"]
    """The unknowns before the fit."""
    values: Float[np.ndarray, " unknowns"]
    """The fitted unknowns; NaN for those that the data do not tell."""
    covariance: Float[np.ndarray, "unknowns unknowns"]
    """Covariance of the fitted unknowns, in first order; NaN in the rows and columns of those that the data do not
    tell, and all of it where no deviation of the measurements is known."""
    undetermined: tuple[Mapping[str, float], ...]
    """The directions that the data do not tell: unknowns that can change together, by these amounts, and nothing that
    was measured changes."""
    residuals: Mapping[str, Float[np.ndarray, "poses _"]]
    """Computed less measured values, by what was measured; NaN where nothing was. Poses have three lengths, then three
    angles."""
    of_lengths: Mapping[str, Bool[np.ndarray, " _"]]
    """Which columns of the residuals are lengths: the others are angles, in radians."""
    deviation: float
    """Root of the sum of squared residuals over the degrees of freedom: the standard deviation of one measured number;
    in units of `sigma` where that was given, so that it should be about 1. NaN without degrees of freedom."""
    degrees_of_freedom: int
    """Measured numbers less combinations of unknowns that were found."""
    condition: float
    """Largest over smallest singular value of the Jacobian in the directions that are told, lengths over the size of
    the mechanism: digits of the data that are lost."""
    iterations: int
    """Steps of the fit."""
    converged: bool
    """Whether the fit ended at a minimum."""
    unit: str
    """Unit of the lengths."""

    @property
    def standard_errors(self) -> Float[np.ndarray, " unknowns"]:
        """Standard error of each unknown; infinite for those that the data do not tell."""
        return np.where(self.determined, np.sqrt(np.diag(self.covariance)), np.inf)

    @property
    def determined(self) -> Bool[np.ndarray, " unknowns"]:
        """Which unknowns the data tell."""
        return np.isfinite(self.values)

    def __str__(self) -> str:
        count = sum(int(np.isfinite(rows).sum()) for rows in self.residuals.values())
        ended = "ended" if self.converged else "did NOT end"
        lines = [
            f"Calibration of {len(self.names)} unknowns by {count} measured numbers: {ended} at a minimum after "
            f"{self.iterations} steps",
            f"  deviation of a measured number {self.deviation:.4g}, {self.degrees_of_freedom} degrees of freedom",
        ]
        width = max(map(len, self.names))
        unit = f" [{self.unit}, rad]" if self.unit else ""
        lines.append(f"  {'unknown' + unit:<{width}}  {'given':>12}  {'fitted':>12}  standard error")
        rows = zip(self.names, self.given, self.values, self.standard_errors, strict=True)
        for name, given, value, error in rows:
            told = "not told by the data" if np.isnan(value) else f"{value:>12.7g}  {_error(error):>14}"
            lines.append(f"  {name:<{width}}  {given:>12.7g}  {told}")
        if self.undetermined:
            lines.append("  the data do not tell, and nothing measured changes with:")
            lines += [f"    {_sum(direction)}" for direction in self.undetermined]
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw the residuals over the measured poses into a picture file; returns its path."""
        names, rows, labels = [], [], []
        for name, values in self.residuals.items():
            parts = ("x", "y", "z", "rx", "ry", "rz")[: values.shape[1]]
            for part, row, is_length in zip(parts, values.T, self.of_lengths[name], strict=True):
                names.append(f"{name} {part}" if len(parts) > 1 else name)
                rows.append(row)
                unit = self.unit if is_length else "rad"
                labels.append(f"computed less measured ({unit})" if unit else "computed less measured")
        axis = PoseAxis(np.arange(len(rows[0])), "measured pose")
        return draw_lines(names, np.array(rows), labels, "residuals of the calibration", Path(path), axis=axis)

    def save(self, path: str | Path) -> Path:
        """Write the unknowns as comma-separated values: given, fitted, standard error; returns the path."""
        columns = self.given, self.values, self.standard_errors
        return save_table(["name", "given", "fitted", "standard error"], map(quoted, self.names), columns, Path(path))


def _error(error: float) -> str:
    return "not known" if np.isnan(error) else f"{error:.3g}"


def _sum(direction: Mapping[str, float]) -> str:
    """Write a direction as changes that go together: "ground A D +1, crank A B +0.4"."""
    return ", ".join(f"{name} {amount:+.4g}" for name, amount in direction.items())
