"""Objectives ready to use. Each is a sum of squares, so that Gauss-Newton steps apply, and can be drawn.

An objective is called as `objective(motion, extras)`; `2.0 * path(...) + transmission(...)` is their weighted sum.
Where a point or a placement is itself to be chosen, give the name of an extra variable in its place.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.design.measures import as_rows, joint_coordinate, transmission_angle
from jaxkin.design.measures import stroke as stroke_between
from jaxkin.mechanism.motion import Motion

Extras = Mapping[str, Any]
Rows = Callable[[Motion, Extras], Any]


@dataclass(frozen=True)
class Objective:
    """A sum of squares over a motion, with what it takes to draw it."""

    terms: tuple[tuple[str, float, Rows, Callable | None], ...]
    """(name, weight, rows, drawing)."""

    def residuals(self, motion: Motion, extras: Extras | None = None) -> Float[Array, " rows"]:
        """Return the numbers whose squares add up to the objective, weights included."""
        return jnp.concatenate([np.sqrt(w) * jnp.ravel(rows(motion, extras or {})) for _, w, rows, _ in self.terms])

    def __call__(self, motion: Motion, extras: Extras | None = None) -> Float[Array, ""]:
        return jnp.sum(self.residuals(motion, extras) ** 2)

    def __add__(self, other: Objective) -> Objective:
        return replace(self, terms=self.terms + other.terms)

    def __rmul__(self, weight: float | int) -> Objective:
        if not weight >= 0:
            raise ValueError(f"the weight of an objective must not be negative, got {weight}")
        return replace(self, terms=tuple((name, weight * w, rows, draw) for name, w, rows, draw in self.terms))

    __mul__ = __rmul__

    def plot(self, axes: Any, motion: Motion, extras: Extras | None = None, **style: Any) -> None:
        """Draw what is wanted and what the motion does into matplotlib axes: the first term that has a picture."""
        for _, _, _, draw in self.terms:
            if draw is not None:
                draw(axes, motion, extras or {}, style)
                return


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

    def traced_path(motion: Motion, extras: Extras):
        found = motion.points(part, _point(point, extras))
        if placement is not None:
            x, y, angle = extras[placement]
            cos, sin = jnp.cos(angle), jnp.sin(angle)
            turned = [cos * found[:, 0] - sin * found[:, 1] + x, sin * found[:, 0] + cos * found[:, 1] + y, found[:, 2]]
            found = jnp.stack(turned, axis=-1)
        return found[:, jnp.array(components)]

    def rows(motion: Motion, extras: Extras):
        found = traced_path(motion, extras)
        if timing:
            if len(found) != len(wanted):
                raise ValueError(
                    f"path: {len(wanted)} targets but {len(found)} poses; with timing each pose has its target, write "
                    "timing=False to compare with the nearest place of the path"
                )
            return found - wanted
        return _nearest(found, jnp.asarray(wanted)) - wanted

    def draw(axes, motion: Motion, extras: Extras, style: dict):
        found = np.asarray(traced_path(motion, extras))
        axes.plot(found[:, 0], found[:, 1], **style)
        axes.plot(wanted[:, 0], wanted[:, 1], "o", color="black", markerfacecolor="none", zorder=0)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("xyz"[components[0]])
        axes.set_ylabel("xyz"[components[1]])

    return Objective((("path", 1.0, rows, draw),))


def function(joint: str, targets: Any, *, relative: bool = True) -> Objective:
    """Function generation: the displacement of a joint is to be one number a pose, in radians or lengths.

    With `relative` both are measured from their means: where the output stands at the start does not matter.
    """
    wanted = np.asarray(targets, float).ravel()

    def rows(motion: Motion, extras: Extras):
        found = joint_coordinate(motion, joint)
        if len(found) != len(wanted):
            raise ValueError(f"function: {len(wanted)} targets but {len(found)} poses; give one target a pose")
        error = found - wanted
        return error - error.mean() if relative else error

    def draw(axes, motion: Motion, extras: Extras, style: dict):
        found, given = np.asarray(joint_coordinate(motion, joint)), np.asarray(next(iter(motion.inputs.values())))
        shift = np.mean(found - wanted) if relative and len(found) == len(wanted) else 0.0
        axes.plot(given, found - shift, **style)
        if len(found) == len(wanted):
            axes.plot(given, wanted, "o", color="black", markerfacecolor="none", zorder=0)
        axes.set_xlabel(next(iter(motion.inputs)))
        axes.set_ylabel(joint)

    return Objective((("function", 1.0, rows, draw),))


def guidance(part: str, point: Sequence[float | int] | str, targets: Any, *, size: float) -> Objective:
    """Rigid-body guidance in the plane x y: a point of a part and the part's turn, (x, y, angle) for each pose.

    Angles are radians from the assembled pose; their errors are multiplied by `size`, a length.
    """
    wanted = as_rows(targets, "guidance targets", 3)

    def rows(motion: Motion, extras: Extras):
        found = motion.points(part, _point(point, extras))[:, :2]
        turn = motion.transforms[part][:, :3, :3]
        angle = jnp.arctan2(turn[:, 1, 0], turn[:, 0, 0]) - wanted[:, 2]
        # 2 sin(half) is the angle for small ones, smooth, and the same for full turns
        return jnp.concatenate([(found - wanted[:, :2]).ravel(), size * 2 * jnp.sin(angle / 2)])

    def draw(axes, motion: Motion, extras: Extras, style: dict):
        found = np.asarray(motion.points(part, _point(point, extras)))
        turn = np.asarray(motion.transforms[part])
        angle = np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
        axes.plot(found[:, 0], found[:, 1], **style)
        for poses, angles, color in ((wanted, wanted[:, 2], "black"), (found, angle, style.get("color", "C0"))):
            axes.quiver(poses[:, 0], poses[:, 1], np.cos(angles), np.sin(angles), color=color, width=0.004)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("x")
        axes.set_ylabel("y")

    return Objective((("guidance", 1.0, rows, draw),))


def transmission(joint: str, ends: tuple[str, str], *, beyond: float = 0.0) -> Objective:
    """Transmission angle near a right angle: its cosine, as far as it is more than `beyond` (radians) off."""

    def rows(motion: Motion, extras: Extras):
        cosine = jnp.cos(transmission_angle(motion, joint, ends))
        return jnp.sign(cosine) * jnp.maximum(jnp.abs(cosine) - np.sin(beyond), 0.0)

    def draw(axes, motion: Motion, extras: Extras, style: dict):
        given = np.asarray(next(iter(motion.inputs.values())))
        axes.plot(given, np.degrees(np.asarray(transmission_angle(motion, joint, ends))), **style)
        axes.axhline(90.0, color="black", linewidth=0.8)
        axes.set_xlabel(next(iter(motion.inputs)))
        axes.set_ylabel(f"transmission angle at {joint}, degrees")

    return Objective((("transmission", 1.0, rows, draw),))


def stroke_of(joint: str, wanted: float) -> Objective:
    """Demand that a joint's stroke, largest minus smallest displacement, is `wanted`; relative error."""
    if not wanted > 0:
        raise ValueError(f"the stroke of {joint!r} must be positive, got {wanted}")

    def rows(motion: Motion, extras: Extras):
        return (stroke_between(motion, joint) - wanted)[None] / wanted

    def draw(axes, motion: Motion, extras: Extras, style: dict):
        found, given = np.asarray(joint_coordinate(motion, joint)), np.asarray(next(iter(motion.inputs.values())))
        axes.plot(given, found, **style)
        axes.fill_between(given, found.min(), found.min() + wanted, color="black", alpha=0.1)
        axes.set_xlabel(next(iter(motion.inputs)))
        axes.set_ylabel(joint)

    return Objective((("stroke", 1.0, rows, draw),))


def dwell(joint: str, poses: Any) -> Objective:
    """Demand that a joint stands still in the poses given (indices, or a mask): its deviation from its mean there."""
    chosen = np.flatnonzero(poses) if np.asarray(poses).dtype == bool else np.asarray(poses, int).ravel()
    if chosen.size < 2:
        raise ValueError(f"dwell of {joint!r}: name at least two poses, got {chosen.size}")

    def rows(motion: Motion, extras: Extras):
        found = joint_coordinate(motion, joint)[chosen]
        return found - found.mean()

    def draw(axes, motion: Motion, extras: Extras, style: dict):
        found, given = np.asarray(joint_coordinate(motion, joint)), np.asarray(next(iter(motion.inputs.values())))
        axes.plot(given, found, **style)
        if chosen.max() < len(given):
            axes.plot(given[chosen], np.full(chosen.size, found[chosen].mean()), ".", color="black", zorder=0)
        axes.set_xlabel(next(iter(motion.inputs)))
        axes.set_ylabel(joint)

    return Objective((("dwell", 1.0, rows, draw),))


def _point(point: Any, extras: Extras):
    """Find the coordinates of a point that may be an extra variable; (x, y) is in the plane z = 0."""
    found = jnp.asarray(extras[point] if isinstance(point, str) else point, float)
    return jnp.append(found, 0.0) if found.shape == (2,) else found


def _nearest(places: Float[Array, "poses k"], targets: Float[Array, "targets k"]) -> Float[Array, "targets k"]:
    """Find for each target the nearest point of the polyline through the places."""
    start, step = places[:-1], places[1:] - places[:-1]
    square = jnp.sum(step**2, axis=-1)
    along = jnp.einsum("tsk,sk->ts", targets[:, None] - start, step) / jnp.where(square > 0, square, 1.0)
    feet = start + jnp.clip(along, 0.0, 1.0)[..., None] * step
    best = jnp.argmin(jnp.sum((feet - targets[:, None]) ** 2, axis=-1), axis=1)
    return feet[jnp.arange(len(targets)), best]
