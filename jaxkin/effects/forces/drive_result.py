"""Forces and torques of the drive along a motion: printed, drawn and saved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._guesses import Result
from jaxkin._names import listed
from jaxkin.effects.angle_locks import not_determined
from jaxkin.effects.forces.changes import ORDER
from jaxkin.effects.forces.friction_result import Friction
from jaxkin.effects.forces.wrenches import units_of
from jaxkin.effects.pose_axis import drive_axis, pose_names
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.mechanism.motion import Motion
from jaxkin.mobility.infeasible_drive import resting_freedoms


@dataclass(frozen=True, eq=False, repr=False)
class DriveForces(Result):
    """The force or torque of each driven coordinate in each pose. A pytree; NaN at poses that are not closed
    (`motion.closed`).

    Positive along the coordinate: it acts on part 2 of the joint, and its opposite on part 1.
    """

    motion: Motion
    forces: dict[str, Float[Array, " poses"]]
    """By "joint.coordinate": newton metres of an angle, newtons of a length."""
    powers: dict[str, Float[Array, " poses"]]
    """Power that each drive delivers, watts; zero at rest."""
    friction: Friction | None = None
    """What friction does; None where no joint has any."""

    @property
    def power(self) -> Float[Array, " poses"]:
        """Power that all drives deliver together, watts."""
        return sum(self.powers.values(), jnp.zeros(len(self.motion)))

    @property
    def units(self) -> dict[str, str]:
        """Unit of the force of each coordinate."""
        return {name: units_of(self.motion, name)[0] for name in self.forces}

    def __str__(self) -> str:
        closed = int(np.sum(self.motion.closed))
        lines = [f"Drive forces in {closed} closed poses of {len(self.motion)}"]
        width, named = max(map(len, self.forces)), pose_names(self.motion)
        for name, values in self.forces.items():
            lines.append(f"  {name:<{width}}  {_range(np.asarray(values), self.units[name], named)}")
        power = np.asarray(self.power)
        if np.any(np.nan_to_num(power)):
            lines.append(f"  {'power':<{width}}  {_range(power, 'W', named)}")
        if free := resting_freedoms(self.motion.mechanism.linkage, self.forces):
            lines.append(f"  without a drive, and counted as held: {listed(free)} (by what load, jk.reactions says)")
        lines += [f"  {line}" for line in not_determined(self.motion, ORDER)]
        lines += [f"  {line}" for line in (self.friction.lines() if self.friction else ())]
        return "\n".join(lines)

    def plot(self, path: str | Path, times: Any = None) -> Path:
        """Draw the forces over the drive or `times` into a picture file; returns its path."""
        labels = [{"N m": "torque (N m)", "N": "force (N)"}[self.units[name]] for name in self.forces]
        axis = drive_axis(self.motion, times)
        return draw_lines([*self.forces], self._rows(), labels, "drive forces", Path(path), axis=axis)

    def save(self, path: str | Path) -> Path:
        """Write forces and power as comma-separated values, one row a pose; returns the path."""
        names = [f"{name} [{self.units[name]}]" for name in self.forces]
        return save_rows([*names, "power [W]"], np.vstack([self._rows(), np.asarray(self.power)]), Path(path))

    def _rows(self) -> np.ndarray:
        return np.stack([np.asarray(values, float) for values in self.forces.values()])


jax.tree_util.register_dataclass(DriveForces, data_fields=["motion", "forces", "powers", "friction"], meta_fields=[])


def _range(values: np.ndarray, unit: str, named: Callable[[int], str]) -> str:
    """Say the least, the largest and the root mean square of the finite values."""
    if not np.isfinite(values).any():
        return "unknown"
    low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
    least, most = (f"{values[end] + 0.0:.4g} {unit}" for end in (low, high))  # + 0.0: none is -0
    if least == most and np.isfinite(values).all():
        return f"{least} at all poses"
    mean = np.sqrt(np.nanmean(values**2))
    return f"from {least} at {named(low)} to {most} at {named(high)}, root mean square {mean:.4g} {unit}"
