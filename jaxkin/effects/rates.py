"""Velocities, accelerations and jerks: derivatives of a motion with respect to time, at its known poses.

With u(t) the inputs and q(u) the displacements that the closure equations give, q' = dq/du u' and so on: nested forward
derivatives of `jaxkin.mechanism.known_motion.follow` along u', u'', ... give the rates of all joints, and those of the
displacements of the parts (`jaxkin.linkage.joint_motion`) along the rates of the joints give the rates of all parts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import dtypes
from jaxtyping import Array, Bool, Float

from jaxkin._arguments import by_name, check_motion, numbers
from jaxkin._guesses import Result
from jaxkin._names import counted, nearest
from jaxkin.effects.angle_locks import not_determined
from jaxkin.effects.pose_axis import drive_axis, pose_names
from jaxkin.effects.pose_plot import draw_lines, save_rows
from jaxkin.effects.pose_shards import in_shards
from jaxkin.geometry.movements import is_length
from jaxkin.joints.joint import Joint
from jaxkin.linkage.coordinates import resolve
from jaxkin.linkage.joint_motion import moved_point, transforms
from jaxkin.mechanism.collect import nan_where_not_finite
from jaxkin.mechanism.known_motion import Inputs, JointRates, KnownDrive, KnownMotion, derivatives, follow, known_motion
from jaxkin.mechanism.motion import Motion, as_point
from jaxkin.solve.closure.rod_spin import vee
from jaxkin.solve.execution.compiler import whole_program
from jaxkin.solve.range.groups import in_groups
from jaxkin.solve.status import Status
from jaxkin.topology.structure import Structure

NAMES = {1: "Velocities", 2: "Accelerations", 3: "Jerks"}
"""Order of a derivative with respect to time -> its name."""
MIN_SHARD_ENTRIES = 2**19
"""Least number of poses of a shard, times the square of the number of joints, times the order."""
LONG_RANGE = 2**14
"""Number of poses beyond which derivatives are found by groups: what those of order two and three hold of each pose is
beyond the cache. 100,000 poses of Jansen's leg take 22 and 56 ms in place of 62 and 134; 10,000 take 2.1 and 5.8 ms by
groups, and 2.0 and 4.4 at once."""
GROUP = 2**12
"""Largest number of poses of such a group: groups of a quarter as many take a third longer."""


@dataclass(frozen=True, eq=False, repr=False)
class Rates(Result):
    """Derivatives of a motion with respect to time, of one order. A pytree; every array has the poses first.

    Rates are zero at poses that did not close, and NaN at NONFINITE poses: `motion.status` tells which. At MISFIT poses
    they are those of the nearest joints that agree, right to as much as the given ones disagree. At singular
    poses they are those of least norm, finite but not those of the branch: `print` names them, by `motion.sigma_min`.
    Rates of parts are computed when they are asked for.
    """

    motion: Motion
    inputs: Inputs
    """The given rates of the driven displacements."""
    orders: tuple[JointRates, ...]
    """Rates of the displacements of all joints: velocities first, those of this order last."""

    @property
    def order(self) -> int:
        """1 for velocities, 2 for accelerations, 3 for jerks."""
        return len(self.orders)

    @property
    def displacements(self) -> tuple[Float[Array, "poses _"], ...]:
        """Rates of the displacements of all joints, in the order of `mechanism.joints`: radians or lengths per time."""
        return self.orders[-1]

    @cached_property
    def matrices(self) -> tuple[tuple[Float[Array, "poses 4 4"], ...], ...]:
        """Derivatives of the transforms of all parts: `matrices[order - 1][part]`, in the order of
        `mechanism.parts`."""
        linkage = self.motion.mechanism.linkage
        return _part_rates(linkage.structure, linkage.joints, (self.motion.displacements, *self.orders))

    @property
    def closed(self) -> Bool[Array, " poses"]:
        """Which poses have rates: those on the branch of the assembled pose (`motion.on_branch`), MISFIT ones too."""
        return self.motion.on_branch

    @cached_property
    def coordinates(self) -> Mapping[str, Float[Array, "poses _"]]:
        """Rates of the displacements of each joint, in the order of its `coordinates`."""
        return dict(zip(self.motion.mechanism.joints, self.displacements, strict=True))

    @cached_property
    def transforms(self) -> Mapping[str, Float[Array, "poses 4 4"]]:
        """The derivative of the displacement matrix of each part."""
        return dict(zip(self.motion.mechanism.parts, self.matrices[-1], strict=True))

    def __str__(self) -> str:
        """Say the least and the greatest rate of each coordinate, and at which poses rates are not known."""
        poses = counted(len(self.motion), "pose")
        lines = [f"{NAMES[self.order]} over {poses}, for the given ones of {', '.join(self.inputs)}"]
        named = pose_names(self.motion)
        names, units, rows = self._rows()
        for name, unit, row in zip(names, units, rows, strict=True):
            if np.isfinite(row).any():
                low, high = int(np.nanargmin(row)), int(np.nanargmax(row))
                least, most = f"{row[low]:.4g}", f"{row[high]:.4g}"
                said = f"from {least} at {named(low)} to {most} at {named(high)}"
                said = f"{least} at all poses" if least == most and np.isfinite(row).all() else said
                lines.append(f"  {name} [{unit}]: {said}")
        if unknown := int(np.isnan(rows).any(axis=0).sum()):
            lines.append(f"  not known at {unknown} of {poses}")
        lines += [f"  {line}" for line in not_determined(self.motion, self.order)]
        return "\n".join(lines)

    def plot(self, path: str | Path, times: Any = None) -> Path:
        """Draw the rates of all joint coordinates over the drive or `times` into a picture file; returns its path."""
        names, units, rows = self._rows()
        labels = [f"{NAMES[self.order].lower()} of joints ({unit})" for unit in units]
        return draw_lines(names, rows, labels, "", Path(path), axis=drive_axis(self.motion, times))

    def save(self, path: str | Path) -> Path:
        """Write them as comma-separated values, a row a pose and a column a joint coordinate; returns the path."""
        names, units, rows = self._rows()
        return save_rows([f"{name} [{unit}]" for name, unit in zip(names, units, strict=True)], rows, Path(path))

    def _rows(self) -> tuple[list[str], list[str], Float[np.ndarray, "coordinates poses"]]:
        """List names, units and rates of all joint coordinates; NaN at poses that have none (`closed`)."""
        closed, mechanism = np.asarray(self.closed), self.motion.mechanism
        per = "time" if self.order == 1 else f"time^{self.order}"
        names, units, rows = [], [], []
        for rates, joint in zip(self.coordinates.values(), mechanism.joints.values(), strict=True):
            names += joint.full_names
            for column, coordinate in enumerate(joint.coordinates):
                unit = (mechanism.unit or "length") if is_length(coordinate) else "rad"
                units.append(f"{unit}/{per}")
                rows.append(np.where(closed, np.asarray(rates)[:, column], np.nan))
        return names, units, np.stack(rows) if rows else np.zeros((0, len(closed)))

    def points(self, part: str, point: Sequence[float | int] | np.ndarray | Array) -> Float[Array, "poses 3"]:
        """Compute velocity (acceleration, jerk) of a point of a part, given where it is in the assembled pose.

        World axes; the unit of the mechanism per time to the power of the order.
        """
        return moved_point(self.transforms[_known(self.motion, part)], as_point(point))

    def angular(self, part: str) -> Float[Array, "poses 3"]:
        """Compute angular velocity (acceleration, jerk) of a part; world axes, radians per time to the power of the
        order."""
        place = self.motion.transforms[_known(self.motion, part)]
        number = self.motion.mechanism.parts.index(part)
        return _angular(tuple(every[number] for every in self.matrices), place)


jax.tree_util.register_dataclass(Rates, data_fields=["motion", "inputs", "orders"], meta_fields=[])


def velocities(motion: Motion, rates: Mapping[str, Any]) -> Rates:
    """Compute the velocities of all joints and parts in every pose of a motion, for given rates of its drive.

    `rates` maps a driven "joint" or "joint.coordinate" to one number or one a pose, in radians or lengths per time;
    driven coordinates that it does not name are at rest. Velocities follow from the poses of the motion, which are not
    found anew: J q' = 0 in all loops, with J the Jacobian of the closure equations and q' the rates of the coordinates,
    of least norm where that leaves freedoms. Works inside `jit`, `vmap` and `grad`. Raises ValueError for a name that
    is not driven and for arrays of another length.
    """
    return _rates(motion, tangents_of(motion, rates))


def accelerations(motion: Motion, rates: Mapping[str, Any], accelerations: Mapping[str, Any] | None = None) -> Rates:
    """Compute the accelerations of all joints and parts, second derivatives with respect to time.

    `rates` and `accelerations` are those of the driven coordinates, as of `velocities`; without `accelerations` the
    rates are constant.
    """
    return _rates(motion, tangents_of(motion, rates), tangents_of(motion, accelerations or {}))


def jerks(
    motion: Motion,
    rates: Mapping[str, Any],
    accelerations: Mapping[str, Any] | None = None,
    jerks: Mapping[str, Any] | None = None,
) -> Rates:
    """Compute the jerks of all joints and parts, third derivatives with respect to time.

    `rates`, `accelerations` and `jerks` are those of the driven coordinates, as of `velocities`; without them
    accelerations and jerks of the drive are zero.
    """
    return _rates(motion, *(tangents_of(motion, given or {}) for given in (rates, accelerations, jerks)))


def _rates(motion: Motion, *given: Inputs) -> Rates:
    """Compute the rates of all joints, of as many orders as rates of the inputs are given."""
    drive, known = known_motion(motion)
    orders = in_shards(partial(_joint_rates, drive), known, (motion.inputs, *given), MIN_SHARD_ENTRIES // len(given))
    return Rates(motion, given[-1], orders)


@partial(whole_program, static=(0,))
def _joint_rates(drive: KnownDrive, known: KnownMotion, inputs: tuple[Inputs, ...]) -> tuple[JointRates, ...]:
    """Compute the rates of all joints by order; NaN at NONFINITE poses, and where a given rate is not finite.

    `inputs` are displacements and rates of the driven coordinates, by order.
    """

    def of_group(own: Any) -> tuple[JointRates, ...]:
        displacements, status, inputs = own
        finite = status != Status.NONFINITE.value
        for rate in jax.tree.leaves(inputs[1:]):
            finite &= jnp.isfinite(rate)
        here = known._replace(displacements=displacements, status=status)
        return nan_where_not_finite(derivatives(follow(drive, here), inputs), finite)

    poses = len(known.status)
    size = GROUP if poses > LONG_RANGE else max(poses, 1)
    return in_groups(of_group, (known.displacements, known.status, inputs), size, axis=0)


@partial(whole_program, static=(0,))
def _part_rates(
    structure: Structure, joints: tuple[Joint, ...], orders: tuple[JointRates, ...]
) -> tuple[tuple[Float[Array, "poses 4 4"], ...], ...]:
    """Differentiate the transforms of all parts, by order; NaN where the rate of any joint is not finite.

    `orders` are displacements and rates of all joints, by order.
    """
    finite = jnp.all(jnp.stack([jnp.all(jnp.isfinite(rows), axis=1) for rows in orders[-1]]), axis=0)
    return nan_where_not_finite(derivatives(partial(transforms, structure, joints), orders), finite)


@partial(whole_program, static=())
def _angular(
    matrices: tuple[Float[Array, "poses 4 4"], ...], place: Float[Array, "poses 4 4"]
) -> Float[Array, "poses 3"]:
    """Compute `Rates.angular` of a part from its transform and the derivatives of that, by order."""

    def skew_part(derivative: Float[Array, "poses 4 4"]) -> Float[Array, "poses 3"]:
        return vee(jnp.einsum("pij,pkj->ikp", derivative[:, :3, :3], place[:, :3, :3])).T

    # the second derivative of R times R^T is [alpha] + [omega]^2, of which the skew part is [alpha]
    *lower, found = map(skew_part, matrices)
    if len(lower) < 2:
        return found
    # the third one is [rate of alpha] + 2 [alpha][omega] + [omega][alpha] + [omega]^3
    omega, alpha = lower
    square = jnp.sum(omega**2, axis=1, keepdims=True)
    return found - 0.5 * jnp.cross(alpha, omega) + square * omega


def tangents_of(motion: Motion, rates: Mapping[str, Any]) -> Inputs:
    """Complete rates given by name to those of all driven displacements, one a pose: zero where none is given."""
    check_motion(motion, "rates")
    given = {}
    for key, rate in by_name(rates, "rates", f"{{{next(iter(motion.inputs))!r}: 1.0}}").items():
        real = isinstance(rate, jax.Array) and not jnp.iscomplexobj(rate)
        value = rate if real else numbers(rate, f"the rate of {key!r}")
        if value.ndim > 1 or (value.ndim == 1 and len(value) != len(motion)):
            raise ValueError(
                f"the rate of {key!r} must be one number or one for each of the {len(motion)} poses, got shape "
                f"{tuple(value.shape)}"
            )
        # numbers of the host stay there: to make an array of the device takes longer
        xp = jnp if isinstance(value, jax.Array) else np
        given[key] = xp.broadcast_to(value.astype(dtypes.canonicalize_dtype(float)), len(motion))
    driven = resolve(motion.mechanism.linkage, given) if given else {}
    given_rates = {name: entry.values for name, entry in driven.items()}
    for name in given_rates:
        if name not in motion.inputs:
            raise ValueError(f"{name!r} is not driven in this motion{nearest(name, motion.inputs)}")
    found: Inputs = {}
    for name, values in motion.inputs.items():
        known = name in given_rates
        found[name] = given_rates[name].astype(values.dtype) if known else np.zeros(values.shape, values.dtype)
    return found


def _known(motion: Motion, part: str) -> str:
    """Return the name of a part; ValueError where there is none."""
    if part not in motion.mechanism.parts:
        raise ValueError(f"there is no part {part!r}{nearest(part, motion.mechanism.parts)}")
    return part
