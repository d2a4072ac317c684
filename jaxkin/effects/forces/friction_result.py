"""What friction in joints does in each pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import jax
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._guesses import Result
from jaxkin._names import counted
from jaxkin.effects.forces.friction_of import undetermined_friction
from jaxkin.effects.forces.undetermined import Undetermined, undetermined
from jaxkin.effects.pose_axis import pose_names
from jaxkin.mechanism.motion import Motion


@dataclass(frozen=True, eq=False, repr=False)
class Friction(Result):
    """The friction of joints in each pose, by joint. A pytree; NaN at poses that are not closed (`motion.closed`), or
    lock."""

    motion: Motion
    normal: Mapping[str, Float[Array, " poses"]]
    """What presses the faces of the joint together, newtons."""
    most: Mapping[str, Float[Array, " poses"]]
    """Coefficient times `normal`, newtons: the friction where the joint slides, and the most it holds at rest."""
    losses: Mapping[str, Float[Array, " poses"]]
    """Power that becomes heat, watts."""
    rests: Mapping[str, Bool[Array, " poses"]]
    """Whether the joint does not slide. Its friction there is taken as zero, and may have any direction and any size up
    to `most`: what the mechanism needs to start from there is not known."""
    locked: Bool[Array, " poses"]
    """Whether no forces of the drives move the mechanism as prescribed, or none were found: it locks by friction."""

    @cached_property
    def undetermined(self) -> tuple[Undetermined, ...]:
        """The joints whose friction rests on reactions that do not follow from the balance of the parts.

        Raises ValueError inside `jit`, `vmap` and `grad`.
        """
        return tuple(
            undetermined_friction(self.motion.mechanism.linkage, tuple(self.normal), undetermined(self.motion))
        )

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> list[str]:
        """Say what friction does, in lines of a report."""
        found, closed, at = [], np.asarray(self.motion.closed), pose_names(self.motion)
        for name, values in self.normal.items():
            normal, losses = np.asarray(values), np.asarray(self.losses[name])
            if not np.isfinite(normal).any():
                continue
            found.append(
                f"friction in {name}: pressed by up to {np.nanmax(normal):.4g} N at {at(np.nanargmax(normal))}, loses "
                f"up to {np.nanmax(losses):.4g} W at {at(np.nanargmax(losses))}"
            )
            rests = np.asarray(self.rests[name]) & closed
            if rests.any():
                most = np.asarray(self.most[name])[rests]
                known = f"up to {np.nanmax(most):.4g} N" if np.isfinite(most).any() else "of any size"
                found.append(
                    f"{name} does not slide in {counted(rests.sum(), 'pose')}, first {np.argmax(rests)}: its friction "
                    f"is taken as zero there, and may be {known} in any direction"
                )
        locked = np.asarray(self.locked)
        if locked.any():
            found.append(
                f"locks by friction in {counted(locked.sum(), 'pose')}, first {np.argmax(locked)}: no drive forces "
                "were found that move it as prescribed; drive another joint, or the other way round"
            )
        return found + [f"friction rests on a reaction of least norm, {each}" for each in self.undetermined]


jax.tree_util.register_dataclass(
    Friction, data_fields=["motion", "normal", "most", "losses", "rests", "locked"], meta_fields=[]
)
