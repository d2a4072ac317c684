"""Tell in which poses the angles of a ball lock, so that derivatives of the parts behind it lose their digits."""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxkin._names import listed
from jaxkin._traced import traced
from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import Inputs, KnownDrive, KnownMotion, follow, known_motion, some_poses
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.singularity import DETERMINED, singular_report
from jaxkin.solve.execution.compiler import whole_program

NEAR = 10.0
"""Poses are looked at where the cosine of phi is up to this many times that at which a rate of phi alone would lock."""


def not_determined(motion: Motion, order: int) -> list[str]:
    """Say in words at which closed poses derivatives of an order by time are not determined: at singular ones, and
    where angles of a ball lock."""
    return [*singular_report(motion, order), *angle_lock_report(motion, order)]


def angle_lock_report(motion: Motion, order: int) -> list[str]:
    """Say in words at which poses the angles of balls without a drive hide derivatives of an order by time, if any.

    Near phi = 90 deg the other two angles turn by rates r of any size, and their n-th derivatives add up to those of
    the parts behind the ball with an error of eps r^n: where that is above `DETERMINED` times w^n, with w the largest
    rate of other angles, they are not determined. A ball that turns about its y alone passes 90 deg without that.
    """
    if traced(motion) or not len(motion) or not (balls := _balls(motion.mechanism.linkage, motion)):
        return []
    eps = float(np.finfo(np.asarray(motion.residual).dtype).eps)
    least = (eps / DETERMINED) ** (1 / order)
    cosines = [np.abs(np.cos(np.asarray(motion.displacements[joint])[:, columns[1]])) for joint, columns in balls]
    near = np.flatnonzero(np.asarray(motion.on_branch) & (np.min(cosines, axis=0) < NEAR * least))
    if not len(near):
        return []
    rates = _rates(motion, near)
    locking = {(joint, k) for joint, columns in balls for k in (columns[0], columns[2])}
    others = [
        np.max(np.abs(each[:, k]), axis=1)
        for number, each in enumerate(rates)
        for k, name in enumerate(motion.mechanism.linkage.joints[number].coordinates)
        if (number, k) not in locking and not is_length(name)
    ]
    largest = np.max(others, axis=0, initial=0.0) if others else np.zeros(len(near))
    lines = []
    for joint, columns in balls:
        fast = np.max([np.max(np.abs(rates[joint][:, k]), axis=1) for k in (columns[0], columns[2])], axis=0)
        if len(found := near[fast * least > largest]):
            poses = f"{len(found)} pose{'s' * (len(found) > 1)} ({listed([*map(str, found)])})"
            lines.append(
                f"not determined at {poses}, where angles of {motion.mechanism.linkage.joints[joint].name} lock, a "
                "ball that has turned by 90 deg: leave their inputs out, or take others beside them"
            )
    return lines


def _balls(linkage: Linkage, motion: Motion) -> list[tuple[int, range]]:
    """List joint and coordinates of the balls that place parts and whose angles are not all driven."""
    driven: set[JointCoordinate] = {coordinate(linkage, name) for name in motion.inputs}
    return [
        (number, own)
        for _, _, number, _ in linkage.structure.tree
        for movement, own in zip(
            linkage.joints[number].movements, coordinate_ranges(linkage.joints[number].movements), strict=True
        )
        if MOVEMENTS[movement].ball and not {(number, k) for k in own} <= driven
    ]


def _rates(motion: Motion, chosen: Int[np.ndarray, " poses"]) -> list[np.ndarray]:
    """Differentiate the displacements of all joints by each input, (poses, coordinates, inputs), at some poses."""
    some = some_poses(motion, chosen)
    drive, known = known_motion(some)
    return [np.asarray(each) for each in _by_inputs(drive, known, some.inputs)]


@partial(whole_program, static=(0,))
def _by_inputs(drive: KnownDrive, known: KnownMotion, inputs: Inputs) -> list[Float[Array, "poses coordinates inputs"]]:
    """Differentiate the displacements of all joints by each input."""
    place, each = follow(drive, known), []
    for name in inputs:
        along = {other: jnp.full_like(values, other == name) for other, values in inputs.items()}
        each.append(jax.jvp(place, (inputs,), (along,))[1])
    return [jnp.stack(rows, axis=-1) for rows in zip(*each, strict=True)]
