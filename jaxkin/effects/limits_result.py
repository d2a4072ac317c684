"""What is found of the range of a drive: both limits, with all that is known of each. See `jaxkin.effects.limits`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._guesses import Result
from jaxkin.effects.limit_of_design import LimitEquation, limit_of_design
from jaxkin.effects.limit_search import LimitKind
from jaxkin.effects.mode_plot import draw_modes
from jaxkin.effects.pose_plot import save_displacements
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion


@dataclass(frozen=True, repr=False)
class Limit(Result):
    """One end of the range of a drive."""

    value: float
    """Displacement of the drive, radians or lengths from the assembled pose; -inf or inf where there is no limit."""
    kind: LimitKind
    """What ends the range there."""
    joints: tuple[str, ...]
    """Where it locks: the joints that can move while the drive is at rest. Where a range ends: the joint."""
    reason: str
    """What ends the range, in words."""
    coordinates: Mapping[str, Float[np.ndarray, " _"]]
    """Displacements of each joint at the limit; empty where there is none."""
    equation: LimitEquation | None = None
    """What the limit is a solution of; None where there is none, or the range of the drive itself ends."""

    def of(self, design: Mechanism) -> Float[Array, ""]:
        """Find this limit of another design of the mechanism, such as `mechanism.with_lengths(...)` makes it.

        It has derivatives by all numbers of the design, and works inside `jit`, `vmap` and `grad`, and so in losses and
        constraints of `jk.optimize`: `limit.of(motion.mechanism)`. The pose of the limit is led to the design in steps:
        the joints that lock, or the range that ends, stay the same; whether another limit comes first there,
        `jk.limits` of the design tells, and whether loops close that the drive does not move. NaN, with derivatives of
        zero, where it is lost on the way, as where the drive makes full turns.

        Raises ValueError for kinds `FAR` and `LOST`, and for mechanisms with other joints.
        """
        if self.equation is not None:
            return limit_of_design(self.equation, design)
        if self.kind in (LimitKind.NONE, LimitKind.RANGE):  # none, or that of the drive itself
            return jnp.asarray(self.value, float)
        raise ValueError(
            f"the limit where {self.reason} is the solution of no equation: it is not known of other designs; give "
            "jk.limits a range with ranges=, whose end is"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Limits(Result):
    """The reachable range of a drive. Prints, draws and saves itself."""

    drive: str
    """"joint.coordinate"."""
    lower: Limit
    upper: Limit
    full_turn: bool
    """Whether the drive makes full turns, after which the mechanism is in its assembled pose again."""
    motion: Motion
    """The poses at the lower limit, as assembled, and at the upper limit; those of limits that there are."""
    unit: str
    """Unit of the limits: "rad", or that of lengths."""

    @property
    def range(self) -> tuple[float, float]:
        """Lowest and highest displacement of the drive, -inf and inf where there is no limit."""
        return self.lower.value, self.upper.value

    def __str__(self) -> str:
        if self.full_turn:
            return f"{self.drive} makes full turns: no limit"
        lines = [f"{self.drive} from {self._value(self.lower.value)} to {self._value(self.upper.value)}"]
        for name, limit in (("lower", self.lower), ("upper", self.upper)):
            lines.append(f"  {name}: {limit.reason}")
        return "\n".join(lines)

    def plot(self, path: str | Path) -> Path:
        """Draw the mechanism at its limits and as assembled, as bars between joints, into a picture file."""
        return draw_modes(self.motion, [f"{name}: {value}" for name, value in self._poses()], Path(path))

    def save(self, path: str | Path) -> Path:
        """Write the displacements of all joints at the limits and as assembled as comma-separated values."""
        mechanism = self.motion.mechanism
        return save_displacements(mechanism.all_joints, self.motion.displacements, mechanism.unit, Path(path))

    def _value(self, value: float) -> str:
        return f"{value:.9g} {self.unit}".rstrip() if np.isfinite(value) else f"{value}"

    def _poses(self) -> list[tuple[str, str]]:
        at_home = float(self.motion.inputs[self.drive][int(bool(self.lower.coordinates))])
        ends = [("lower", self.lower.value), ("as assembled", at_home), ("upper", self.upper.value)]
        return [(name, f"{value:.4g} {self.unit}".rstrip()) for name, value in ends if np.isfinite(value)]
