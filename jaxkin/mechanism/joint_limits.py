"""Tell which poses of a motion lie beyond the limits of joints, of which joints, and by how much.

The solver follows closed loops whatever the limits are, since limits end a motion and do not change it. Each pose is
looked at by itself; how far a drive can go until the first limit is what `jk.limits` finds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from jaxkin._names import counted, listed
from jaxkin.geometry.movements import is_length
from jaxkin.joints.evidence import EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.linkage.coordinates import coordinates
from jaxkin.mobility.infeasible_drive import undriven_freedoms
from jaxkin.solve.status import Status
from jaxkin.solve.system.joints import scaled_frames

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism
    from jaxkin.mechanism.motion import Motion

ROUNDING = 1e-6
"""How far beyond a limit a coordinate is still at it, radians or characteristic lengths: what six digits of a file
leave open. A gripper whose file draws a coupler at its limit is within it, though closing the loops turned the coupler
by 2e-9. `jk.limits` finds the end of a range to 1e-10, and a motion up to there is within it, too."""
ROUNDINGS = 32
"""The same in units of rounding, where these are more: in float32, poses are right to some of them."""
MAX_REPORTED_COORDINATES = 8
"""Coordinates beyond their limits that a report names at most: those that are farthest beyond."""


class Bound(NamedTuple):
    """A coordinate that has limits (static)."""

    joint: int
    """Number of its joint in the mechanism."""
    coordinate: int
    """Its number in the joint."""
    low: float
    high: float
    length: bool
    """Whether it is a length, and not an angle."""


class Breach(NamedTuple):
    """A coordinate that is beyond its limits at some poses of a motion."""

    name: str
    """"joint.coordinate"."""
    limits: tuple[float, float]
    """Lowest and highest displacement from the assembled pose, radians or lengths."""
    poses: int
    """How many poses are beyond the limits."""
    worst: float
    """The displacement farthest beyond."""
    at: int
    """The pose of that."""
    length: bool

    @property
    def excess(self) -> float:
        """How far the worst displacement is beyond its limit, radians or lengths."""
        low, high = self.limits
        return max(low - self.worst, self.worst - high)


def bounds_of(joints: Sequence[Joint]) -> tuple[Bound, ...]:
    """List the coordinates that have a finite limit."""
    return tuple(
        Bound(number, k, low, high, is_length(joint.coordinates[k]))
        for number, joint in enumerate(joints)
        for k, (low, high) in enumerate(joint.limits)
        if np.isfinite(low) or np.isfinite(high)
    )


def with_limited(motion: Motion) -> Motion:
    """Give the poses that are CLOSED with a joint beyond its limits the status LIMITED; the same motion without any."""
    joints = motion.mechanism.all_joints
    if not (bounds := bounds_of(joints)):
        return motion
    frames = tuple(joint.frames_1 for joint in joints), tuple(joint.frames_2 for joint in joints)
    return replace(motion, status=_limited(bounds, frames, motion.displacements, motion.status))


@partial(jax.jit, static_argnums=0)
def _limited(
    bounds: tuple[Bound, ...],
    frames: tuple[tuple[Array, ...], tuple[Array, ...]],
    displacements: tuple[Float[Array, "poses _"], ...],
    status: Int[Array, " poses"],
) -> Int[Array, " poses"]:
    """Set LIMITED in place of CLOSED where a coordinate is beyond its limits."""
    size = scaled_frames(*frames)[1]
    beyond = jnp.zeros(status.shape, bool)
    for each in bounds:
        q = lax.stop_gradient(displacements[each.joint][:, each.coordinate])
        slack = _slack(q.dtype) * (size if each.length else 1.0)
        beyond |= (q < each.low - slack) | (q > each.high + slack)
    return jnp.where(beyond & (status == Status.CLOSED.value), Status.LIMITED.value, status)


def _slack(dtype: np.dtype) -> float:
    return max(ROUNDING, ROUNDINGS * float(jnp.finfo(dtype).eps))


def excesses(
    motion: Motion, which: Bool[Array | np.ndarray, " poses"] | None = None
) -> dict[str, Float[np.ndarray, " poses"]]:
    """Measure how far each coordinate is beyond its limits at each pose: see `Motion.beyond_limits`.

    At the poses `which`, by default those on the branch; 0 at others.
    """
    joints, counted_poses = motion.mechanism.all_joints, np.asarray(motion.on_branch if which is None else which)
    bounds, found = bounds_of(joints), {}
    if not bounds:
        return found
    frames = ([np.asarray(each.frames_1) for each in joints], [np.asarray(each.frames_2) for each in joints])
    size = scaled_frames(frames[0], frames[1], np)[1]
    for each in bounds:
        q = np.asarray(motion.displacements[each.joint], float)[:, each.coordinate]
        slack = _slack(motion.displacements[each.joint].dtype) * (float(size) if each.length else 1.0)
        over = np.maximum(q - each.high, 0.0) - np.maximum(each.low - q, 0.0)
        over = np.where(counted_poses & (np.abs(over) > slack), over, 0.0)
        if over.any():
            found[joints[each.joint].full_names[each.coordinate]] = over
    return found


def breaches(motion: Motion) -> tuple[Breach, ...]:
    """Collect the coordinates that are beyond their limits, in the order of the mechanism."""
    joints, over, found = motion.mechanism.all_joints, motion.beyond_limits, []
    for each in bounds_of(joints) if over else ():
        name = joints[each.joint].full_names[each.coordinate]
        if name in over:
            at = int(np.argmax(np.abs(over[name])))
            worst = float(motion.displacements[each.joint][at, each.coordinate])
            count = int(np.count_nonzero(over[name]))
            found.append(Breach(name, (each.low, each.high), count, worst, at, each.length))
    return tuple(found)


def first_within(motion: Motion) -> int | None:
    """Find the first pose that is closed and within all limits; None where there is none."""
    closed = np.flatnonzero(np.asarray(motion.status) == Status.CLOSED.value)
    return int(closed[0]) if len(closed) else None


def joined(pieces: Sequence[tuple[Sequence[Breach], int]]) -> tuple[Breach, ...]:
    """Join what was found in consecutive motions, each given with its number of poses."""
    found: dict[str, Breach] = {}
    first = 0
    for piece, poses in pieces:
        for each in piece:
            here = each._replace(at=each.at + first)
            known = found.get(each.name)
            worse = here if known is None or here.excess > known.excess else known
            found[each.name] = worse._replace(poses=each.poses + (known.poses if known else 0))
        first += poses
    return tuple(found.values())


def rounding(joints: Sequence[Joint], length: bool) -> float:
    """Tell how far beyond a limit a coordinate of the joints still counts as at it, radians or a length."""
    if not length:
        return ROUNDING
    frames = ([np.asarray(each.frames_1) for each in joints], [np.asarray(each.frames_2) for each in joints])
    return ROUNDING * float(scaled_frames(frames[0], frames[1], np)[1])


def beyond_as_assembled(joints: Sequence[Joint]) -> str:
    """Name the coordinates whose limits exclude the assembled pose, with these limits; empty where none do."""
    return listed(
        [
            f"{joints[each.joint].full_names[each.coordinate]}, {each.low:.4g} to {each.high:.4g}"
            for each in bounds_of(joints)
            if max(each.low, -each.high) > rounding(joints, each.length)
        ]
    )


def limit_report(
    found: Sequence[Breach], mechanism: Mechanism, inputs: Mapping[str, object], within: int | None = None
) -> list[str]:
    """Write a line on each coordinate that is beyond its limits, the farthest first, and one on what to do.

    `within` is a pose of the motion that is closed and within all limits, if there is one.
    """
    if not found:
        return []
    unit = mechanism.unit
    order = sorted(found, key=lambda each: -each.excess)
    lines = []
    for each in order[:MAX_REPORTED_COORDINATES]:
        low, high = each.limits
        of = unit if each.length else "rad"
        lines.append(
            f"beyond its limits: {each.name} at {counted(each.poses, 'pose')}, up to {each.excess:.4g} {of} ".rstrip()
            + f" {'below' if each.worst < low else 'above'} its limits {low:.4g} to {high:.4g}, at pose {each.at}"
        )
    if len(order) > MAX_REPORTED_COORDINATES:
        lines.append(f"beyond its limits: {len(order) - MAX_REPORTED_COORDINATES} more: see motion.beyond_limits")
    return [*lines, *_remedy(order[0].name, mechanism, inputs, within)]


def _remedy(worst: str, mechanism: Mechanism, inputs: Mapping[str, object], within: int | None) -> list[str]:
    """Write the call of `jk.limits` that tells how far a drive can go: that of the worst coordinate, if it is driven.

    All other freedoms are held. From an assembled pose that is itself beyond a limit there is no such range, so that a
    pose within is assembled first. There is no call where the loops close but for misalignments.
    """
    linkage = mechanism.linkage
    # coordinates of a target are those of a joint that the mechanism of the motion has, and the one that was swept not
    targets = any(each.evidence and each.evidence.kind is EvidenceKind.TARGET for each in mechanism.all_joints)
    whole = "motion.mechanism" if targets else "mechanism"
    outside = beyond_as_assembled(mechanism.all_joints)
    if outside and within is None:
        return [
            f"the assembled pose itself is beyond its limits: {outside}; drive it to a pose within them, and assemble "
            f"the mechanism there: {whole}.at(motion, index)"
        ]
    if linkage.ideal:
        return []
    driven = coordinates(linkage, [*inputs] or [worst])
    drive = worst if worst in driven else next(iter(driven))
    hold = [*(name for name in driven if name != drive), *undriven_freedoms(linkage, list(driven.values()))]
    of = f"{drive!r}, hold={hold}" if hold else f"{drive!r}"
    if outside:
        return [
            f"the assembled pose itself is beyond its limits: {outside}; how far a drive can go from pose {within}, "
            f"which is within: jk.limits({whole}.at(motion, {within}), {of})"
        ]
    return [f"how far a drive can go within all limits: jk.limits({whole}, {of})"]
