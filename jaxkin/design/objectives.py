"""Objectives ready to use. Each is a sum of squares, so that Gauss-Newton steps apply, and can be drawn.

An objective is called as `objective(motion, extras)`; `2.0 * path(...) + transmission(...)` is their weighted sum.
Where a point or a placement is itself to be chosen, give the name of an extra variable in its place.

Objectives are pytrees of their numbers, such as targets and weights: a search with other numbers runs the program that
was compiled for the first ones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, Protocol

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin.design.measures import STATIC, PartPoint, as_rows, joint_coordinate, part_point, transmission_angle
from jaxkin.design.measures import stroke as stroke_between
from jaxkin.mechanism.motion import Motion

Extras = Mapping[str, Any]
Numbers = Array | np.ndarray


class Term(Protocol):
    """What a motion is asked for, in numbers that are to be zero."""

    def rows(self, motion: Motion, extras: Extras) -> Any:
        """Compute the numbers whose squares are added up."""
        ...

    def draw(self, axes: Any, motion: Motion, extras: Extras, style: dict) -> None:
        """Draw what is wanted and what the motion does into matplotlib axes."""
        ...


class Weighted(NamedTuple):
    """A term of a sum."""

    weight: Any
    term: Term


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class Objective:
    """A sum of squares over a motion, with what it takes to draw it."""

    terms: tuple[Weighted, ...]

    def residuals(self, motion: Motion, extras: Extras | None = None) -> Float[Array, " rows"]:
        """Return the numbers whose squares add up to the objective, weights included."""
        return jnp.concatenate([jnp.sqrt(w) * jnp.ravel(term.rows(motion, extras or {})) for w, term in self.terms])

    def __call__(self, motion: Motion, extras: Extras | None = None) -> Float[Array, ""]:
        return jnp.sum(self.residuals(motion, extras) ** 2)

    def __add__(self, other: Objective) -> Objective:
        return replace(self, terms=self.terms + other.terms)

    def __rmul__(self, weight: float | int) -> Objective:
        if not weight >= 0:
            raise ValueError(f"the weight of an objective must not be negative, got {weight}")
        return replace(self, terms=tuple(Weighted(weight * w, term) for w, term in self.terms))

    __mul__ = __rmul__

    def plot(self, axes: Any, motion: Motion, extras: Extras | None = None, **style: Any) -> None:
        """Draw what is wanted and what the motion does into matplotlib axes: the first term."""
        for _, term in self.terms[:1]:
            term.draw(axes, motion, extras or {}, style)


def _objective(term: Term) -> Objective:
    return Objective((Weighted(1.0, term),))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Path:
    point: PartPoint
    wanted: Float[Numbers, "targets components"]
    timing: bool = field(metadata=STATIC)
    placement: str | None = field(metadata=STATIC)
    components: tuple[int, ...] = field(metadata=STATIC)

    def traced_path(self, motion: Motion, extras: Extras) -> Float[Array, "poses components"]:
        found = self.point.path(motion, extras)
        if self.placement is not None:
            x, y, angle = extras[self.placement]
            cos, sin = jnp.cos(angle), jnp.sin(angle)
            turned = [cos * found[:, 0] - sin * found[:, 1] + x, sin * found[:, 0] + cos * found[:, 1] + y, found[:, 2]]
            found = jnp.stack(turned, axis=-1)
        return found[:, jnp.array(self.components)]

    def rows(self, motion: Motion, extras: Extras):
        found = self.traced_path(motion, extras)
        if self.timing:
            if len(found) != len(self.wanted):
                raise ValueError(
                    f"path: {len(self.wanted)} targets but {len(found)} poses; with timing each pose has its target, "
                    "write timing=False to compare with the nearest place of the path"
                )
            return found - self.wanted
        return _nearest(found, jnp.asarray(self.wanted)) - self.wanted

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, wanted = np.asarray(self.traced_path(motion, extras)), self.wanted
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
    wanted = as_rows(targets, "path targets", len(components))
    return _objective(_Path(part_point(part, point), wanted, timing, placement, tuple(components)))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Function:
    joint: str = field(metadata=STATIC)
    wanted: Float[Numbers, " targets"]
    relative: bool = field(metadata=STATIC)

    def rows(self, motion: Motion, extras: Extras):
        found = joint_coordinate(motion, self.joint)
        if len(found) != len(self.wanted):
            raise ValueError(f"function: {len(self.wanted)} targets but {len(found)} poses; give one target a pose")
        error = found - self.wanted
        return error - error.mean() if self.relative else error

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, given, wanted = _over_input(axes, motion, self.joint), _input(motion), self.wanted
        shift = np.mean(found - wanted) if self.relative and len(found) == len(wanted) else 0.0
        axes.plot(given, found - shift, **style)
        if len(found) == len(wanted):
            axes.plot(given, wanted, "o", color="black", markerfacecolor="none", zorder=0)


def function(joint: str, targets: Any, *, relative: bool = True) -> Objective:
    """Function generation: the displacement of a joint is to be one number a pose, in radians or lengths.

    With `relative` both are measured from their means: where the output stands at the start does not matter.
    """
    return _objective(_Function(joint, np.asarray(targets, float).ravel(), relative))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Guidance:
    point: PartPoint
    wanted: Float[Numbers, "poses 3"]
    size: Any

    def rows(self, motion: Motion, extras: Extras):
        found = self.point.path(motion, extras)[:, :2]
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
    return _objective(_Guidance(part_point(part, point), as_rows(targets, "guidance targets", 3), size))


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
    return _objective(_Transmission(joint, (ends[0], ends[1]), beyond))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Stroke:
    joint: str = field(metadata=STATIC)
    wanted: Any

    def rows(self, motion: Motion, extras: Extras):
        return (stroke_between(motion, self.joint) - self.wanted)[None] / self.wanted

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, given = _over_input(axes, motion, self.joint), _input(motion)
        axes.plot(given, found, **style)
        axes.fill_between(given, found.min(), found.min() + self.wanted, color="black", alpha=0.1)


def stroke_of(joint: str, wanted: float) -> Objective:
    """Demand that a joint's stroke, largest minus smallest displacement, is `wanted`; relative error."""
    if not wanted > 0:
        raise ValueError(f"the stroke of {joint!r} must be positive, got {wanted}")
    return _objective(_Stroke(joint, wanted))


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class _Dwell:
    joint: str = field(metadata=STATIC)
    poses: Int[Numbers, " poses"]

    def rows(self, motion: Motion, extras: Extras):
        found = joint_coordinate(motion, self.joint)[self.poses]
        return found - found.mean()

    def draw(self, axes, motion: Motion, extras: Extras, style: dict):
        found, given, poses = _over_input(axes, motion, self.joint), _input(motion), self.poses
        axes.plot(given, found, **style)
        if poses.max() < len(given):
            axes.plot(given[poses], np.full(poses.size, found[poses].mean()), ".", color="black", zorder=0)


def dwell(joint: str, poses: Any) -> Objective:
    """Demand that a joint stands still in the poses given (indices, or a mask): its deviation from its mean there."""
    chosen = np.flatnonzero(poses) if np.asarray(poses).dtype == bool else np.asarray(poses, int).ravel()
    if chosen.size < 2:
        raise ValueError(f"dwell of {joint!r}: name at least two poses, got {chosen.size}")
    return _objective(_Dwell(joint, chosen))


def _input(motion: Motion) -> np.ndarray:
    """Return the displacements of the first driven coordinate."""
    return np.asarray(next(iter(motion.inputs.values())))


def _over_input(axes: Any, motion: Motion, joint: str) -> np.ndarray:
    """Label the axes of a joint's displacement over the input, and return the displacement."""
    axes.set_xlabel(next(iter(motion.inputs)))
    axes.set_ylabel(joint)
    return np.asarray(joint_coordinate(motion, joint))


def _nearest(places: Float[Array, "poses k"], targets: Float[Array, "targets k"]) -> Float[Array, "targets k"]:
    """Find for each target the nearest point of the polyline through the places."""
    start, step = places[:-1], places[1:] - places[:-1]
    square = jnp.sum(step**2, axis=-1)
    along = jnp.einsum("tsk,sk->ts", targets[:, None] - start, step) / jnp.where(square > 0, square, 1.0)
    feet = start + jnp.clip(along, 0.0, 1.0)[..., None] * step
    best = jnp.argmin(jnp.sum((feet - targets[:, None]) ** 2, axis=-1), axis=1)
    return feet[jnp.arange(len(targets)), best]
