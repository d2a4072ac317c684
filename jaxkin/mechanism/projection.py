"""Project coordinates of all joints onto the nearest closed poses: `project`, and what it gives back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Array, Bool, Float, Int

from jaxkin._arguments import by_name, check_mechanism, numbers, several
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.geometry.root import root
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate, coordinates
from jaxkin.linkage.first_order import Columns
from jaxkin.mechanism.collect import nan_where_not_finite
from jaxkin.mechanism.joint_limits import with_limited
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.sweep import closure_tolerance, padded, warn_of_float32
from jaxkin.mobility.infeasible_drive import dead_point
from jaxkin.solve.correctors.nearest_pose import NearestPoses
from jaxkin.solve.execution.programs import project as nearest_poses
from jaxkin.solve.options import SolverOptions, options_with
from jaxkin.solve.status import SEVERITY, Status, in_doubt, of_severity, severity
from jaxkin.solve.system.from_linkage import group_joints, group_system

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


@dataclass(frozen=True, eq=False)
class Projection:
    """Closed poses nearest to given coordinates. A pytree; every array has the poses as its first axis."""

    motion: Motion
    """The poses. Its inputs are the coordinates that were held; where none were, those of the motors, or of the first
    joint of a mechanism without motors."""
    distance: Float[Array, " poses"]
    """Root of the sum of squares, over all coordinates of joints in loops, of how far they were moved, with their
    weights: radians, and lengths over the characteristic length of the loops."""
    nearest: Bool[Array, " poses"]
    """Which poses are nearest: closed, and no closed pose beside them is nearer. The others may be closed, too, as
    their status says, but another closed pose beside them may be nearer."""

    def __str__(self) -> str:
        poses, closed = len(self.motion), np.asarray(self.motion.on_branch)
        if not poses:
            return "no poses"
        lines = [
            f"{closed.sum()} of {poses} poses close; {int(np.sum(self.nearest))} of them are the nearest closed pose"
        ]
        if closed.any():
            far = np.asarray(self.distance)[closed]
            lines.append(f"  moved by {np.median(far):.3g} in the median, {far.max():.3g} at most")
        linkage = self.motion.mechanism.linkage
        driven = [coordinate(linkage, name) for name in self.motion.inputs]
        if np.any(np.asarray(self.motion.status) == Status.STALLED.value) and (why := dead_point(linkage, driven)):
            lines.append(f"  {why}")
        return "\n".join(lines)


class _Collected(NamedTuple):
    """The poses that were found, of all loop groups together."""

    displacements: tuple[Float[Array, "poses _"], ...]
    """Of all joints."""
    status: Int[Array, " poses"]
    residual: Float[Array, " poses"]
    distance: Float[Array, " poses"]
    """See `Projection.distance`."""
    nearest: Bool[Array, " poses"]
    """See `Projection.nearest`."""


jax.tree_util.register_dataclass(Projection, data_fields=["motion", "distance", "nearest"], meta_fields=[])


def project(
    mechanism: Mechanism,
    given: Mapping[str, Any],
    *,
    hold: Iterable[str] = (),
    weights: Mapping[str, float | int] | None = None,
    options: SolverOptions | None = None,
) -> Projection:
    """Move coordinates of joints, many poses at once, to the nearest ones at which the loops close.

    `given` maps joints to their displacements from the assembled pose, arrays (poses, coordinates) as those of
    `motion.coordinates`, or (poses,) for a joint of one coordinate; joints that are not given are at zero. Nearest is
    the least sum of squared differences, of angles in radians and of lengths over the characteristic length of the
    loops; balls count by the angle between their rotations, but for those at which a loop is cut: these follow. Joints
    in no loop stay as they are given; coordinates along the normal of planar loops rest.

    - `hold`: coordinates that stay as they are given, such as those of motors.
    - `weights`: factors of the differences of coordinates; a large one moves little. 1 where none is given.

    It starts from what is given, not from the assembled pose: nothing says that the motion leads from one to the other,
    and CLOSED means no more than that the loops close; MISFIT, that those of the nearest joints that agree do, because
    the given ones disagree. Poses that cannot be closed have the status UNREACHABLE, those with NaN or infinity
    NONFINITE. Works inside `jit`, `vmap` and `grad`; derivatives are those of the nearest pose, zero where `nearest` is
    False. Raises ValueError for a mechanism without coordinates, names that are not there, arrays of other shapes, and
    weights that are not positive.
    """
    check_mechanism(mechanism, "nearest poses")
    linkage, options = mechanism.linkage, options_with(options)
    warn_of_float32()
    rows = _given(mechanism, given)
    held = coordinates(linkage, hold) if (hold := several(hold, "hold", "coordinates")) else {}
    factors = _weights(mechanism, weights or {})
    xp = jnp if traced(rows) else np
    every = [rows[joint.name] for joint in mechanism.all_joints]
    finite = xp.isfinite(xp.concatenate(every, axis=1)).all(axis=1)
    tolerance = closure_tolerance(options.tolerance)
    solved, found = [], []
    for number, loop_group in enumerate(linkage.structure.loop_groups):
        inside = tuple(place for place in held.values() if place[0] in loop_group.joints)
        system, columns = group_system(linkage, loop_group, inside, linkage.in_space.classes[number])
        joints = group_joints(linkage, linkage.solved_joints, loop_group)
        begun = padded([xp.where(finite, every[joint][:, k], 0.0) for joint, k in columns])
        found.append(
            nearest_poses(system, options, joints, begun, np.array([factors[place] for place in columns]), tolerance)
        )
        resting = tuple(place for place in factors if place[0] in loop_group.joints and place not in columns)
        solved.append((columns, resting))
    poses = _collect(tuple(solved), every, finite, found)
    status = poses.status
    if linkage.ideal:  # what closed are the nearest joints that agree
        status = jnp.where(status == Status.CLOSED.value, Status.MISFIT.value, status)
    if not traced(linkage) and dead_point(linkage, list(held.values())):
        status = in_doubt(status)
    names = held or coordinates(linkage, mechanism.motors or _first(mechanism))
    inputs = {name: poses.displacements[joint][:, k] for name, (joint, k) in names.items()}
    motion = Motion(mechanism, inputs, poses.displacements, status, poses.residual, options=options, swept=False)
    return Projection(with_limited(motion), poses.distance, poses.nearest)


@partial(jax.jit, static_argnums=0)
def _collect(
    solved: tuple[tuple[Columns, Columns], ...],
    given: list[Float[Array, "poses _"]],
    finite: Bool[Array, " poses"],
    found: list[NearestPoses],
) -> _Collected:
    """Collect what was found for the loop groups; displacements, residual and distance are NaN where not `finite`.

    `solved` are the (joint, coordinate) of each loop group that were moved, and those that rest.
    """
    poses = len(finite)
    moved = {(joint, k): row for joint, rows in enumerate(given) for k, row in enumerate(rows.T)}
    worst = jnp.where(finite, 0, SEVERITY.index(Status.NONFINITE))
    square = residual = jnp.zeros(poses, given[0].dtype)
    nearest_of_all = finite
    for (columns, resting), each in zip(solved, found, strict=True):
        moved |= {place: row[:poses] for place, row in zip(columns, each.displacements, strict=True)}
        moved |= dict.fromkeys(resting, jnp.zeros(poses, given[0].dtype))  # along the normal of a planar group
        worst = jnp.maximum(worst, severity(each.status[:poses]))
        square, residual = square + each.square[:poses], residual + each.residual_norm[:poses] ** 2
        nearest_of_all = nearest_of_all & each.nearest[:poses]
    status = of_severity(worst)
    displacements = tuple(
        jnp.stack([moved[joint, k] for k in range(rows.shape[1])], axis=1) if rows.shape[1] else rows
        for joint, rows in enumerate(given)
    )
    norms = jnp.sqrt(residual), root(square)
    displacements, (residual, distance) = nan_where_not_finite((displacements, norms), finite)
    return _Collected(displacements, status, residual, distance, nearest_of_all)


def _first(mechanism: Mechanism) -> tuple[str, ...]:
    """Name all coordinates of the first joint that moves, for a motion of a mechanism without motors."""
    return next(joint.full_names for joint in mechanism.all_joints if joint.freedoms)


def _given(mechanism: Mechanism, given: Mapping[str, Any]) -> dict[str, Float[Array | np.ndarray, "poses _"]]:
    """Check the coordinates that are given, and fill in those that are not; ValueError for others than there are."""
    if not any(joint.freedoms for joint in mechanism.all_joints):
        raise ValueError("no joint of the mechanism has a coordinate: all its parts are one body")
    found: dict[str, Any] = {}
    dtype = dtypes.canonicalize_dtype(float)
    for name, values in by_name(given, "coordinates", "{'A': angles, 'ball': (poses, 3)}").items():
        if name not in mechanism.joints:
            raise ValueError(f"there is no joint {name!r}{nearest(str(name), mechanism.joints)}")
        freedoms = mechanism.joints[name].freedoms
        rows = numbers(values, f"the coordinates of {name!r}", f"real numbers, an array (poses, {freedoms})")
        rows = rows.reshape(-1, 1) if rows.ndim == 1 and freedoms == 1 else rows
        if rows.ndim != 2 or rows.shape[1] != freedoms:
            raise ValueError(
                f"joint {name!r} has {freedoms} coordinate{'s' * (freedoms != 1)} "
                f"({', '.join(mechanism.joints[name].coordinates)}): expected an array (poses, {freedoms}), got shape "
                f"{np.shape(values)}"
            )
        found[name] = rows
    if not found:
        raise ValueError("no coordinates are given: name at least one joint, as in {'A': angles}")
    counts = {name: len(rows) for name, rows in found.items()}
    if len({*counts.values()}) > 1:
        raise ValueError(f"all joints need as many poses, got {counts}")
    poses = next(iter(counts.values()))
    if not poses:
        raise ValueError("the coordinates have no pose: give at least one, as in {'A': angles}")
    return {
        joint.name: found.get(joint.name, np.zeros((poses, joint.freedoms), dtype)) for joint in mechanism.all_joints
    }


def _weights(mechanism: Mechanism, weights: Mapping[str, float | int]) -> dict[JointCoordinate, float]:
    """Find the weight of each coordinate, (joint, coordinate); ValueError for one that is not positive."""
    every = {(number, k): 1.0 for number, joint in enumerate(mechanism.all_joints) for k in range(joint.freedoms)}
    for name, weight in by_name(weights, "weights", "{'A': 10.0}").items():
        try:
            value = float(weight)
        except (TypeError, ValueError):
            value = np.nan
        if not 0 < value < np.inf:
            raise ValueError(f"the weight of {name!r} must be a positive number, got {weight!r}; hold= keeps it fixed")
        every[coordinate(mechanism.linkage, name)] = value
    return every
