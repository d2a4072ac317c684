"""One pose of a mechanism: what `Mechanism.solve` gives back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin._arguments import by_name
from jaxkin._named import Named
from jaxkin._traced import traced
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.targets import DriveKey, Target


@dataclass(frozen=True, eq=False)
class Pose:
    """One pose of a mechanism, for one displacement of each driven coordinate. A pytree."""

    motion: Motion
    """The pose as a motion of one pose: what effects, tables and pictures take."""

    @property
    def status(self) -> Int[Array, ""]:
        """Code of `Status`."""
        return self.motion.status[0]

    @property
    def residual(self) -> Float[Array, ""]:
        """Square root of Eq. 12, lengths over the characteristic length of the loops."""
        return self.motion.residual[0]

    @cached_property
    def coordinates(self) -> Mapping[str, Float[Array, " _"]]:
        """Displacements of each joint, in the order of its `coordinates`: radians, and lengths of the mechanism."""
        return Named("joint", ((name, rows[0]) for name, rows in self.motion.coordinates.items()))

    @cached_property
    def transforms(self) -> Mapping[str, Float[Array, "4 4"]]:
        """Displacement of each part from its assembled pose, in world coordinates."""
        return Named("part", ((name, rows[0]) for name, rows in self.motion.transforms.items()))

    def point(self, part: str, point: Sequence[float | int] | np.ndarray | Array) -> Float[Array, "3"]:
        """Tell where a point of a part is now, given where it is in the assembled pose (world coordinates)."""
        return self.motion.points(part, point)[0]

    def __str__(self) -> str:
        return str(self.motion)


jax.tree_util.register_dataclass(Pose, data_fields=["motion"], meta_fields=[])


def one_pose(drive: Mapping[Any, object]) -> dict[DriveKey, Array | np.ndarray]:
    """Make the drive of one pose a drive of a range of one; ValueError where it does not give one number each."""
    ranges = {}
    for name, value in by_name(drive, "driven displacements", "{'A': 0.3}").items():
        if isinstance(name, Target):
            ranges[name] = (jnp if traced(value) else np).asarray(value)[None]
            continue
        if np.shape(value) != ():
            raise ValueError(
                f"drive {name!r}: solve() takes one displacement, got an array of shape {np.shape(value)}; for a range "
                "write sweep()"
            )
        ranges[name] = (jnp if traced(value) else np).reshape(value, 1)
    return ranges
