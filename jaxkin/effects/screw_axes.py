"""Instantaneous screw axes of a part along a motion; in the plane their points are the centrodes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._guesses import Result
from jaxkin._names import counted
from jaxkin.effects.rates import Rates
from jaxkin.geometry.movements import is_length
from jaxkin.joints.joint import Joint
from jaxkin.mechanism.known_motion import JointRates
from jaxkin.solve.execution.compiler import whole_program

ROUNDING = 100.0
"""Angular speed of a part, over the largest one of a joint and the precision of numbers, up to which the part does not
turn: a few joints' rates that cancel leave some units of rounding, and axes from these are anywhere."""
NO_PITCH = 1e-9
"""Pitch, over the distance of axes from the origin, up to which it is told as none: that of planar motion is rounding
of 1e-12 where the part hardly turns."""


@dataclass(frozen=True, eq=False, repr=False)
class ScrewAxes(Result):
    """The instantaneous screw axes of a part: it turns about them, and slides along them. A pytree."""

    direction: Float[Array, "poses 3"]
    """Unit vectors along the angular velocity, world axes."""
    point: Float[Array, "poses 3"]
    """The point of each axis that is nearest to the origin of the world: in the plane the fixed centrode."""
    moving: Float[Array, "poses 3"]
    """The same point, where it is on the part in the assembled pose: in the plane the moving centrode."""
    pitch: Float[Array, " poses"]
    """Advance along the axis per radian, in the unit of the mechanism; the `pitch` of `jk.screw` is per turn."""
    angular_speed: Float[Array, " poses"]
    """Radians per time; zero where the part only slides or rests, NaN at poses that have no rates: that are not closed
    (`Rates.closed`), or at which a given rate is NaN."""
    part: str
    unit: str
    """Unit of lengths of the mechanism."""

    def __str__(self) -> str:
        """Say the least and the greatest angular speed and pitch, and at which poses the part does not turn."""
        speed = np.asarray(self.angular_speed)
        poses = counted(len(speed), "pose")
        lines = [f"Screw axes of {self.part} over {poses}, {np.isfinite(speed).sum()} of them with rates"]
        unit = self.unit or "length"
        for name, of, row in (("angular speed", "rad/time", speed), ("pitch", f"{unit}/rad", np.asarray(self.pitch))):
            if len(turning := np.flatnonzero(speed > 0)):
                low, high = turning[row[turning].argmin()], turning[row[turning].argmax()]
                least, most = f"{row[low]:.4g}", f"{row[high]:.4g}"
                said = least if least == most else f"from {least} at pose {low} to {most} at pose {high}"
                if name == "pitch" and np.abs(row[turning]).max() <= NO_PITCH * self._reach(turning):
                    said = "0 but for rounding"
                lines.append(f"  {name} [{of}]: {said}")
        if len(still := np.flatnonzero(speed == 0)):
            count = f"{len(still)} of {len(speed)} poses"
            lines.append(f"  only slides or rests in {count}, first at pose {still[0]}: no axis there")
        return "\n".join(lines)

    def _reach(self, turning: np.ndarray) -> float:
        """Measure the largest distance of an axis from the origin, on either side: what roundings of lengths are of."""
        points = np.concatenate([np.asarray(self.point)[turning], np.asarray(self.moving)[turning]])
        return float(np.linalg.norm(points, axis=1).max())


jax.tree_util.register_dataclass(
    ScrewAxes,
    data_fields=["direction", "point", "moving", "pitch", "angular_speed"],
    meta_fields=["part", "unit"],
)


def screw_axes(velocities: Rates, part: str) -> ScrewAxes:
    """Find the instantaneous screw axes of a part from `jk.velocities`: NaN in poses in which it does not turn.

    With the velocity v of the material point at the origin of the world and the angular velocity w, the axis passes
    through w x v / w^2, and the pitch is w . v / w^2. Works inside `jit`, `vmap` and `grad`. Raises ValueError for a
    part that is not there, and for accelerations and jerks.
    """
    if not isinstance(velocities, Rates):
        raise ValueError(f"screw axes are those of jk.velocities(motion, rates), got {type(velocities).__name__}")
    if velocities.order != 1:
        raise ValueError(
            "screw axes are those of jk.velocities(motion, rates), got derivatives of order "
            f"{velocities.order}: of accelerations and jerks there are none"
        )
    number, mechanism = velocities.motion.mechanism.parts.index(part), velocities.motion.mechanism
    direction, point, moving, pitch, speed = _axes(
        tuple(mechanism.joints.values()),
        velocities.displacements,
        velocities.closed,
        velocities.angular(part),
        velocities.motion.transforms[part],
        velocities.matrices[0][number],
    )
    return ScrewAxes(direction, point, moving, pitch, speed, part, mechanism.unit)


@partial(whole_program, static=())
def _axes(
    joints: tuple[Joint, ...],
    rates: JointRates,
    closed: Bool[Array, " poses"],
    omega: Float[Array, "poses 3"],
    place: Float[Array, "poses 4 4"],
    velocity: Float[Array, "poses 4 4"],
) -> tuple[
    Float[Array, "poses 3"],
    Float[Array, "poses 3"],
    Float[Array, "poses 3"],
    Float[Array, " poses"],
    Float[Array, " poses"],
]:
    """Compute direction, point, moving point, pitch and angular speed of `ScrewAxes`.

    `omega` is the angular velocity of the part, `place` its transform and `velocity` the derivative of that; `rates`
    are those of all joints.
    """
    square = jnp.sum(omega**2, axis=1, keepdims=True)
    known, turns = closed & ~jnp.isnan(square[:, 0]), square > _rounding(joints, rates)[:, None] ** 2
    # poses without an axis are zeros here, since NaN would spoil the derivatives of all poses, and NaN at the end
    omega, shift, slides = (jnp.where(turns, rows, 0.0) for rows in (omega, place[:, :3, 3], velocity[:, :3, 3]))
    rotation = jnp.where(turns[..., None], place[:, :3, :3], 0.0)
    at_origin = slides - jnp.cross(omega, shift)
    square = jnp.where(turns, jnp.sum(omega**2, axis=1, keepdims=True), 1.0)
    point = jnp.cross(omega, at_origin) / square
    moving = jnp.einsum("pji,pj->pi", rotation, point - shift)
    speed = jnp.sqrt(square)
    pitch = jnp.sum(omega * at_origin, axis=1, keepdims=True) / square
    direction, point, moving, pitch = (
        jnp.where(turns, rows, jnp.nan) for rows in (omega / speed, point, moving, pitch)
    )
    return direction, point, moving, pitch[:, 0], jnp.where(known, jnp.where(turns, speed, 0.0)[:, 0], jnp.nan)


def _rounding(joints: tuple[Joint, ...], rates: JointRates) -> Float[Array, " poses"]:
    """Bound the angular speed that rounding leaves a part that does not turn, by the largest one of a joint."""
    angles = [
        jnp.abs(rows[:, column])
        for joint, rows in zip(joints, rates, strict=True)
        for column, coordinate in enumerate(joint.coordinates)
        if not is_length(coordinate)
    ]
    still = jnp.zeros(len(rates[0]))
    return ROUNDING * jnp.finfo(still.dtype).eps * jnp.max(jnp.stack([still, *angles]), axis=0)
