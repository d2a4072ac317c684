"""How well a mechanism passes motion and force on to an output: ratio, mechanical advantage, transmission angle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxkin._arguments import check_motion
from jaxkin._guesses import Result
from jaxkin._names import counted, listed, nearest
from jaxkin.effects.forces.drive import drive_forces
from jaxkin.effects.forces.given import joint_load
from jaxkin.effects.forces.places import places
from jaxkin.effects.forces.reactions import reactions
from jaxkin.effects.forces.screws import velocity_at
from jaxkin.effects.forces.wrenches import nan_unless_closed
from jaxkin.effects.pose_axis import drive_axis, pose_names
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.effects.rates import velocities
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.root import root
from jaxkin.geometry.units import METRES
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.execution.compiler import whole_program

PASSES = 1e-9
"""Work of the force at the joint over that of the output, were they in one line, above which it is a force: where it
moves the output, one and more."""


@dataclass(frozen=True, eq=False, repr=False)
class Transmission(Result):
    """From the driven coordinate of a motion to an output, in each pose. A pytree; NaN at poses that are not closed
    (`motion.closed`)."""

    motion: Motion
    """The motion that was given."""
    input: str
    output: str
    """The coordinates, "joint.coordinate"."""
    joint: str
    """The joint through which the output part is moved."""
    ratio: Float[Array, " poses"]
    """Rate of the output over that of the input: of radians, or of the unit of the mechanism."""
    advantage: Float[Array, " poses"]
    """Force of the output over that of the input, newtons or newton metres; infinite where the output rests."""
    angle: Float[Array, " poses"]
    """Transmission angle, radians, 0 to pi/2: the complement of the angle between the force on the output part and the
    velocity of its point, relative to the other part of the output joint. In a four-bar it is the angle between coupler
    and output link, the acute one. NaN where no force goes through the joint."""

    def __str__(self) -> str:
        ratio, angle = np.asarray(self.ratio), np.degrees(np.asarray(self.angle))
        lines = [f"Transmission from {self.input} to {self.output}, through {self.joint}"]
        if unknown := int(np.isnan(ratio).sum()):
            lines.append(f"  not known at {unknown} of {len(ratio)} poses")
        if np.isfinite(ratio).any():
            lines.append(f"  ratio of rates from {np.nanmin(ratio):.4g} to {np.nanmax(ratio):.4g}")
        if np.isfinite(angle).any():
            at = pose_names(self.motion)
            lines.append(
                f"  transmission angle from {np.nanmin(angle):.4g} deg at {at(np.nanargmin(angle))} to "
                f"{np.nanmax(angle):.4g} deg at {at(np.nanargmax(angle))}"
            )
        if without := int((np.isnan(angle) & np.isfinite(ratio)).sum()):
            lines.append(
                f"  no force goes through {self.joint} in {counted(without, 'pose')}: no transmission angle there"
            )
        return "\n".join(lines)

    def plot(self, path: str | Path, times: Any = None) -> Path:
        """Draw the transmission angle over the drive or `times` into a picture file; returns its path."""
        degrees = np.degrees(np.asarray(self.angle, float))
        title = f"{self.input} to {self.output}"
        names, label = [f"through {self.joint}"], "transmission angle (deg)"
        return draw_lines(names, degrees[None], label, title, Path(path), axis=drive_axis(self.motion, times))

    def save(self, path: str | Path) -> Path:
        """Write ratio, advantage and angle as comma-separated values, one row a pose; returns the path."""
        rows = np.stack([np.asarray(each, float) for each in (self.ratio, self.advantage, self.angle)])
        return save_rows(["ratio", "advantage", "transmission angle [rad]"], rows, Path(path))


jax.tree_util.register_dataclass(
    Transmission, data_fields=["motion", "ratio", "advantage", "angle"], meta_fields=["input", "output", "joint"]
)


def transmission(motion: Motion, output: str, *, joint: str | None = None) -> Transmission:
    """Find how motion and force go from the one driven coordinate of a motion to another coordinate.

    `output` is "joint" or "joint.coordinate"; the part that moves there, part 2 of its joint unless that is fixed, is
    the output part. Without weight and friction, the advantage is the inverse of the ratio of rates in radians and
    metres. The transmission angle is measured at `joint`, by default the one other joint of the output part: there a
    load on the output puts a force on the part, and its angle from the velocity that the output gives the point says
    how much of it moves the output.

    Works inside `jit`, `vmap` and `grad`. Raises ValueError for motions with several drives, an output that is driven,
    and where the joint must be named.
    """
    check_motion(motion, "transmissions")
    mechanism = motion.mechanism
    if len(motion.inputs) != 1:
        raise ValueError(f"a transmission has one input, and this motion is driven by {listed(list(motion.inputs))}")
    (name,) = motion.inputs
    number, index = coordinate(mechanism.linkage, output)
    own = mechanism.all_joints[number]
    full = own.full_names[index]
    if full == name:
        raise ValueError(f"{full!r} is the input itself; name another coordinate")
    part = own.parts[0] if own.parts[1] in mechanism.fixed else own.parts[1]
    others = [each.name for each in mechanism.all_joints if part in each.parts and each.name != own.name]
    if joint is not None and joint not in others:
        raise ValueError(f"the output part {part!r} has no other joint {joint!r}{nearest(joint, others)}")
    if not others:
        raise ValueError(
            f"the output part {part!r} has no joint but {own.name!r}, and so no transmission angle: jk.velocities has "
            "the ratio of its rates, jk.drive_forces the force that a load on it takes"
        )
    if joint is None and len(others) != 1:
        raise ValueError(f"the output part {part!r} is moved through one of {listed(others)}: say joint={others[0]!r}")
    through = joint or others[0]
    speeds = velocities(motion, {name: 1.0})
    load = joint_load(full, 1.0)
    force = drive_forces(motion, applied=load).forces[name]
    found = reactions(motion, applied=load)
    normal = mechanism.linkage.normal([number], decoupled=True)
    angle = _angle(
        (number, index),
        mechanism.unit,
        mechanism.linkage,
        motion.displacements,
        motion.closed,
        (found.forces[through], found.points[through]),
        None if normal is None else (normal, motion.transforms[part]),
    )
    ratio = nan_unless_closed(motion, speeds.displacements[number][:, index])
    return Transmission(motion, name, full, through, ratio, -1.0 / force, angle)


@partial(whole_program, static=(0, 1))
def _angle(
    output: JointCoordinate,
    unit: str,
    linkage: Linkage,
    displacements: JointDisplacements,
    closed: Bool[Array, " poses"],
    passed_on: tuple[Float[Array, "poses 3"], Float[Array, "poses 3"]],
    plane: tuple[Float[Array, "3"], Float[Array, "poses 4 4"]] | None,
) -> Float[Array, " poses"]:
    """Compute `Transmission.angle`, from the force on the output part that is `passed_on`, and the point where it acts.

    `plane` is the normal of the plane in which the loops move, in the assembled pose, and the transform of the output
    part; None where there is no plane.
    """
    number, index = output
    # poses that are not closed have zeros here, since NaN would spoil the derivatives of all poses, and NaN at the end
    push, point = (jnp.where(closed[:, None], rows, 0.0) for rows in passed_on)
    if plane is not None:
        # links lie side by side, and what that puts along their pins is shared by stiffness, and moves nothing
        normal, place = plane
        normal = jnp.einsum("pij,j->pi", jnp.where(closed[:, None, None], place, 0.0)[:, :3, :3], normal)
        push = push - jnp.sum(push * normal, axis=1, keepdims=True) * normal
    # the velocity of the point of the output part that is there now, relative to the other part of the output joint: by
    # the output alone, which has a direction also where the output rests
    at = places(linkage, tuple(jnp.where(closed[:, None], q, 0.0) for q in displacements), chords=True)
    own = linkage.joints[number]
    velocity = velocity_at(at.joints[number].coordinates(own)[index], at.scale.arm(point.T)).T
    velocity = velocity * (1.0 if is_length(own.coordinates[index]) else at.scale.size * METRES[unit])
    along = jnp.abs(jnp.sum(push * velocity, axis=1))
    across = root(jnp.sum(jnp.cross(push, velocity) ** 2, axis=1))
    square = jnp.sum(push**2, axis=1) * jnp.sum(velocity**2, axis=1)
    passes = closed & (square > PASSES**2)
    # the arc sine of a right angle has no derivative, and half of its digits
    return jnp.where(passes, jnp.arctan2(along, jnp.where(passes, across, 1.0)), jnp.nan)
