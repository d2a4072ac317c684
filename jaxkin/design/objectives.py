"""Objectives ready to use. Each is a sum of squares, so that Gauss-Newton steps apply, and can be drawn.

Where a point or a placement is itself to be chosen, give the name of an extra variable in its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin._arguments import text, yes_or_no
from jaxkin.design import given
from jaxkin.design.measures import STATIC, PartPoint, joint_coordinate, part_point, transmission_angle
from jaxkin.design.measures import stroke as stroke_between
from jaxkin.design.objective import Extras, Objective, single
from jaxkin.mechanism.motion import Motion

_WITH_TIMING = "with timing each pose has its target, write timing=False to compare with the nearest place of the path"
"""What to do about other numbers of targets than of poses."""


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Path:
    point: PartPoint
    wanted: Float[Array | np.ndarray, "targets components"]
    timing: bool = field(metadata=STATIC)
    placement: str | None = field(metadata=STATIC)
    components: tuple[int, ...] = field(metadata=STATIC)

    def traced_path(self, motion: Motion, extras: Extras) -> Float[Array, "poses components"]:
        """Compute the path of the point in the wanted components, placed as the extra variable says."""
        found = self.point.path(motion, extras)
        if self.placement is not None:
            x, y, angle = given.extra(extras, self.placement, "path: placement", ((3,),))
            cos, sin = jnp.cos(angle), jnp.sin(angle)
            turned = [cos * found[:, 0] - sin * found[:, 1] + x, sin * found[:, 0] + cos * found[:, 1] + y, found[:, 2]]
            found = jnp.stack(turned, axis=-1)
        return found[:, jnp.array(self.components)]

    def rows(self, motion: Motion, extras: Extras):
        found = self.traced_path(motion, extras)
        if self.timing:
            given.check_targets(len(self.wanted), len(found), "path", _WITH_TIMING)
            return found - self.wanted
        return _nearest(found, jnp.asarray(self.wanted)) - self.wanted

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, wanted = np.asarray(self.traced_path(motion, extras)), np.asarray(self.wanted)
        if len(self.components) == 1:
            axes.plot(found[:, 0], **style)
            axes.plot(wanted[:, 0], "o", color="black", markerfacecolor="none", zorder=0)
            axes.set_xlabel("pose")
            axes.set_ylabel("xyz"[self.components[0]])
            return
        axes.plot(found[:, 0], found[:, 1], **style)
        axes.plot(wanted[:, 0], wanted[:, 1], "o", color="black", markerfacecolor="none", zorder=0)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("xyz"[self.components[0]])
        axes.set_ylabel("xyz"[self.components[1]])


def path(
    part: str,
    point: Sequence[float | int] | np.ndarray | str,
    targets: Any,
    *,
    timing: bool = True,
    placement: str | None = None,
    components: Sequence[int] = (0, 1),
) -> Objective:
    """Path generation: a point of a part is to pass through target points. Square of their distances.

    `point` is where it is in the assembled pose, (x, y, z) or (x, y), or the name of an extra variable. With `timing`
    pose i is to reach target i; without it each target is measured from the nearest place of the path, straight between
    poses. `targets` have the world coordinates named by `components`, x and y by default. `placement` names an extra
    variable (x, y, angle) by which the whole mechanism is moved in the plane x y before it is compared.
    """
    chosen = given.components(components, "path: components")
    wanted = given.rows(targets, "path targets", len(chosen))
    placed = placement if placement is None else text(placement, "path: placement")
    timed = yes_or_no(timing, "path: timing")
    return single(_Path(part_point(part, point, "path"), wanted, timed, placed, chosen))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Function:
    joint: str = field(metadata=STATIC)
    wanted: Float[Array | np.ndarray, " targets"]
    relative: bool = field(metadata=STATIC)

    def rows(self, motion: Motion, extras: Extras):
        found = joint_coordinate(motion, self.joint)
        given.check_targets(len(self.wanted), len(found), "function")
        error = found - self.wanted
        return error - error.mean() if self.relative else error

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, inputs, wanted = _over_input(axes, motion, self.joint), _input(motion), self.wanted
        shift = np.mean(found - wanted) if self.relative and len(found) == len(wanted) else 0.0
        axes.plot(inputs, found - shift, **style)
        if len(found) == len(wanted):
            axes.plot(inputs, wanted, "o", color="black", markerfacecolor="none", zorder=0)


def function(joint: str, targets: Any, *, relative: bool = True) -> Objective:
    """Function generation: the displacement of a joint is to be one number a pose, in radians or lengths.

    `targets` are the values of the function at the inputs of the drive, such as `f(angles)`, and not the function. With
    `relative` both are measured from their means: where the output stands at the start does not matter.
    """
    text(joint, "function: joint")
    wanted = given.row(targets, "function: targets", "f(angles) for a drive by angles")
    return single(_Function(joint, wanted, yes_or_no(relative, "function: relative")))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Guidance:
    point: PartPoint
    wanted: Float[Array | np.ndarray, "poses 3"]
    size: Any

    def rows(self, motion: Motion, extras: Extras):
        found = self.point.path(motion, extras)[:, :2]
        given.check_targets(len(self.wanted), len(found), "guidance")
        turn = motion.transforms[self.point.part][:, :3, :3]
        angle = jnp.arctan2(turn[:, 1, 0], turn[:, 0, 0]) - self.wanted[:, 2]
        # 2 sin(half) is the angle for small ones, smooth, and the same for full turns
        return jnp.concatenate([(found - self.wanted[:, :2]).ravel(), self.size * 2 * jnp.sin(angle / 2)])

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, wanted = np.asarray(self.point.path(motion, extras)), self.wanted
        turn = np.asarray(motion.transforms[self.point.part])
        angle = np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
        axes.plot(found[:, 0], found[:, 1], **style)
        for poses, angles, color in ((wanted, wanted[:, 2], "black"), (found, angle, style.get("color", "C0"))):
            axes.quiver(poses[:, 0], poses[:, 1], np.cos(angles), np.sin(angles), color=color, width=0.004)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("x")
        axes.set_ylabel("y")


def guidance(part: str, point: Sequence[float | int] | str, targets: Any, *, size: float) -> Objective:
    """Rigid-body guidance in the plane x y: a point of a part and the part's turn, (x, y, angle) for each pose.

    Angles are radians from the assembled pose; their errors are multiplied by `size`, a length.
    """
    wanted = given.rows(targets, "guidance targets", 3)
    return single(_Guidance(part_point(part, point, "guidance"), wanted, given.positive(size, "guidance: size")))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Transmission:
    joint: str = field(metadata=STATIC)
    ends: tuple[str, str] = field(metadata=STATIC)
    beyond: Any

    def rows(self, motion: Motion, extras: Extras):
        cosine = jnp.cos(transmission_angle(motion, self.joint, self.ends))
        return jnp.sign(cosine) * jnp.maximum(jnp.abs(cosine) - jnp.sin(self.beyond), 0.0)

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        angle = np.degrees(np.asarray(transmission_angle(motion, self.joint, self.ends)))
        axes.plot(_input(motion), angle, **style)
        axes.axhline(90.0, color="black", linewidth=0.8)
        axes.set_xlabel(next(iter(motion.inputs)))
        axes.set_ylabel(f"transmission angle at {self.joint}, degrees")


def transmission(joint: str, ends: tuple[str, str], *, beyond: float = 0.0) -> Objective:
    """Transmission angle near a right angle: its cosine, as far as it is more than `beyond` (radians) off."""
    text(joint, "transmission: joint")
    named, beyond = given.ends(ends, "transmission: ends"), given.angle(beyond, "transmission: beyond", np.pi / 2)
    return single(_Transmission(joint, named, beyond))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Stroke:
    joint: str = field(metadata=STATIC)
    wanted: Any

    def rows(self, motion: Motion, extras: Extras):
        return (stroke_between(motion, self.joint) - self.wanted)[None] / self.wanted

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, inputs = _over_input(axes, motion, self.joint), _input(motion)
        axes.plot(inputs, found, **style)
        axes.fill_between(inputs, found.min(), found.min() + self.wanted, color="black", alpha=0.1)


def stroke_of(joint: str, wanted: float) -> Objective:
    """Demand that a joint's stroke, largest minus smallest displacement, is `wanted`; relative error."""
    text(joint, "stroke_of: joint")
    return single(_Stroke(joint, given.positive(wanted, f"the stroke of {joint!r}")))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Dwell:
    joint: str = field(metadata=STATIC)
    poses: Int[Array | np.ndarray, " poses"]
    of: int | None = field(metadata=STATIC)
    """The number of all poses, where a mask named some."""
    span: tuple[int, int] = field(metadata=STATIC)
    """The least and the greatest number of a pose: known where the poses themselves are traced."""

    def rows(self, motion: Motion, extras: Extras):
        values = joint_coordinate(motion, self.joint)
        if self.of not in (None, len(values)):
            raise ValueError(f"dwell of {self.joint!r}: a mask of {self.of} poses, the motion has {len(values)}")
        if beyond := [pose for pose in self.span if not -len(values) <= pose < len(values)]:
            raise ValueError(f"dwell of {self.joint!r}: pose {beyond[0]} is named, the motion has {len(values)}")
        found = values[self.poses]
        return found - found.mean()

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, inputs, poses = _over_input(axes, motion, self.joint), _input(motion), self.poses
        axes.plot(inputs, found, **style)
        if poses.max() < len(inputs):
            axes.plot(inputs[poses], np.full(poses.size, found[poses].mean()), ".", color="black", zorder=0)


def dwell(joint: str, poses: Any) -> Objective:
    """Demand that a joint stands still in the poses given (indices, or a mask): its deviation from its mean there."""
    text(joint, "dwell: joint")
    chosen = given.pose_numbers(poses, f"dwell of {joint!r}: poses")
    if chosen.size < 2:
        raise ValueError(f"dwell of {joint!r}: name at least two poses, got {chosen.size}")
    mask = len(poses) if np.asarray(poses).dtype == bool else None
    return single(_Dwell(joint, chosen, mask, (int(chosen.min()), int(chosen.max()))))


def _input(motion: Motion) -> np.ndarray:
    """Return the displacements of the first driven coordinate."""
    return np.asarray(next(iter(motion.inputs.values())))


def _over_input(axes: Any, motion: Motion, joint: str) -> np.ndarray:
    """Label the axes of a joint's displacement over the input, and return the displacement."""
    axes.set_xlabel(next(iter(motion.inputs)))
    axes.set_ylabel(joint)
    return np.asarray(joint_coordinate(motion, joint))


def _nearest(places: Float[Array, "poses k"], targets: Float[Array, "targets k"]) -> Float[Array, "targets k"]:
    """Find for each target the nearest point of the polyline through the places, which may be a single one."""
    if len(places) == 1:
        return jnp.broadcast_to(places, targets.shape)
    start, step = places[:-1], places[1:] - places[:-1]
    square = jnp.sum(step**2, axis=-1)
    along = jnp.einsum("tsk,sk->ts", targets[:, None] - start, step) / jnp.where(square > 0, square, 1.0)
    feet = start + jnp.clip(along, 0.0, 1.0)[..., None] * step
    best = jnp.argmin(jnp.sum((feet - targets[:, None]) ** 2, axis=-1), axis=1)
    return feet[jnp.arange(len(targets)), best]
