"""Measurements of a mechanism, and how far a motion is from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, positive_number
from jaxkin._names import nearest
from jaxkin.geometry.movements import is_length
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.mechanism.targets import Target, middle_of_joints
from jaxkin.solve.closure.rod_spin import vee

HALF_TURN = -1.0 + 1e-9
"""Cosine of the angle between two rotations below which they count as half a turn apart: within 4e-5 rad of pi, which
is less than rotations are measured to."""


@dataclass(frozen=True)
class MeasuredQuantity:
    """One measured quantity. Static to JAX."""

    key: Any
    """As it was given: "joint", "joint.coordinate", or a target."""
    name: str
    lengths: tuple[bool, ...]
    """For each number of its residual whether it is a length; it is an angle otherwise."""
    place: JointCoordinate | None = None
    """The joint and its coordinate, by number; None for a target."""

    def residual(
        self, motion: Motion, measured: Array, markers: Mapping[Target, Any], middle: Float[np.ndarray | Array, "3"]
    ) -> Float[Array, "poses _"]:
        """Compute how far the motion is from the measured values: computed less measured, radians and lengths.

        Angles differ by less than half a turn. Of rotations it is the rotation vector; the translation of a pose is
        that of the `middle` of the joints of its part in the mechanism as it was given: one that moved with the unknown
        joints would lessen residuals by where they are taken.
        """
        if self.place is not None:
            joint, k = self.place
            off = motion.displacements[joint][:, k] - measured
            return (off if self.lengths[0] else off - 2 * jnp.pi * jnp.round(off / (2 * jnp.pi)))[:, None]
        if self.key.kind == "point":
            return motion.points(self.key.part, markers.get(self.key, self.key.at)) - measured
        place = motion.transforms[self.key.part]
        turn = _rotation_vectors(place[:, :3, :3] @ jnp.swapaxes(measured[:, :3, :3], 1, 2))
        if self.key.kind == "orientation":
            return turn
        off = place - measured
        return jnp.concatenate([off[:, :3, :3] @ middle + off[:, :3, 3], turn], axis=1)


def _rotation_vectors(rotations: Float[Array, "poses 3 3"]) -> Float[Array, "poses 3"]:
    """Compute axis times angle of rotations, 0 to pi radians; half a turn, which has two signs, is that about x."""
    sines = vee(jnp.moveaxis(rotations, 0, -1)).T
    square, cosine = jnp.sum(sines**2, axis=1), 0.5 * (jnp.trace(rotations, axis1=1, axis2=2) - 1.0)
    none = square == 0
    sine = jnp.sqrt(jnp.where(none, 1.0, square))
    scaled = jnp.where(none, 1.0, jnp.arctan2(sine, cosine) / sine)[:, None] * sines
    return jnp.where((none & (cosine < 0))[:, None], jnp.array([jnp.pi, 0.0, 0.0]), scaled)


@dataclass(frozen=True)
class Data:
    """All measurements as numbers."""

    kinds: tuple[MeasuredQuantity, ...]
    values: tuple[Float[np.ndarray, "poses *shape"], ...]
    """Measured values, NaN replaced."""
    weights: tuple[Float[np.ndarray, "poses _"], ...]
    """One over the standard deviation of each number of the residuals; zero where nothing was measured."""
    middles: tuple[Float[np.ndarray, "3"], ...]
    """Of a measured pose the point of the part at which its translation is taken, the middle of its joints as given;
    zeros of what is no pose."""

    def check_turns(self, motion: Motion) -> None:
        """Raise ValueError where a measured rotation is half a turn from that of the motion: it may be either way."""
        for kind, measured, weights in zip(self.kinds, self.values, self.weights, strict=True):
            if not isinstance(kind.key, Target) or kind.key.kind == "point":
                continue
            error = np.asarray(motion.transforms[kind.key.part])[:, :3, :3] @ measured[:, :3, :3].swapaxes(1, 2)
            cosine = 0.5 * (np.trace(error, axis1=1, axis2=2) - 1.0)
            if len(opposite := np.flatnonzero((cosine < HALF_TURN) & (weights[:, -1] > 0))):
                raise ValueError(
                    f"{kind.name}: at {len(opposite)} of {len(cosine)} measured poses, first at pose {opposite[0]}, "
                    "the measured rotation is half a turn from that of the given mechanism; measured rotations are "
                    "displacements from the assembled pose: multiply them from the right by the inverse of the one "
                    "that was measured there"
                )


def data_of(mechanism: Mechanism, measured: Any, sigma: Any, poses: int) -> Data:
    """Check measurements and their standard deviations; ValueError for what does not fit the mechanism or the drive."""
    given = by_name(measured, "measurements", "{'D': angles, jk.point('coupler', (1, 0, 0)): places}")
    if not given:
        raise ValueError("nothing was measured: give coordinates of joints, jk.point, jk.pose or jk.orientation")
    if not poses:
        raise ValueError("nothing was measured: the drive has no poses")
    kinds, values, weights, middles = [], [], [], []
    for key, numbers in given.items():
        kind = _kind(mechanism, key)
        array = _array(kind, numbers, poses)
        known = np.asarray(np.isfinite(array))
        if isinstance(key, Target) and key.kind != "point":
            known = np.asarray(known.all(axis=(1, 2)))
            _check_rigid(kind, array[known])
            array = np.where(known[:, None, None], array, np.eye(array.shape[-1]))
        else:
            array = np.where(known, array, 0.0)
        kinds.append(kind)
        of_pose = isinstance(key, Target) and key.kind == "pose"
        middles.append(np.asarray(middle_of_joints(mechanism.linkage, key.part)) if of_pose else np.zeros(3))
        values.append(array)
        weights.append(np.broadcast_to(known.reshape(poses, -1), (poses, len(kind.lengths))).astype(float))
    if not any(known.any() for known in weights):
        raise ValueError("nothing was measured: all values are NaN, which stands for values that are missing")
    deviations = _deviations(kinds, sigma)
    scaled = tuple(known / row for known, row in zip(weights, deviations, strict=True))
    return Data(tuple(kinds), tuple(values), scaled, tuple(middles))


def _kind(mechanism: Mechanism, key: Any) -> MeasuredQuantity:
    """Tell what a key of the measurements means: a coordinate of a joint, or the place or orientation of a part.

    Raises ValueError for names that are not there, and for parts that are fixed.
    """
    if not isinstance(key, Target):
        joint, k = coordinate(mechanism.linkage, key)
        return MeasuredQuantity(key, key, (is_length(mechanism.all_joints[joint].coordinates[k]),), (joint, k))
    if key.part not in mechanism.parts:
        raise ValueError(f"{key.joint}: there is no part {key.part!r}{nearest(key.part, mechanism.parts)}")
    if key.part in mechanism.fixed:
        raise ValueError(f"{key.joint}: the part {key.part!r} is fixed, and tells nothing")
    return MeasuredQuantity(
        key, key.joint, {"pose": (True,) * 3 + (False,) * 3, "point": (True,) * 3}.get(key.kind, (False,) * 3)
    )


def _array(kind: MeasuredQuantity, numbers: Any, poses: int) -> np.ndarray:
    """Return the measured values of one quantity as an array (poses, ...), NaN where nothing was measured.

    Raises ValueError for what is no real number, infinity, and arrays of another shape.
    """
    shape = (poses, *kind.key.shape) if isinstance(kind.key, Target) else (poses,)
    try:
        array = np.asarray(numbers, float)
    except (TypeError, ValueError):
        raise ValueError(f"{kind.name}: the measured values must be real numbers, got {numbers!r}") from None
    if np.isinf(array).any():
        raise ValueError(f"{kind.name}: a measured value is infinite; where nothing was measured, write NaN")
    if array.shape != shape:
        raise ValueError(
            f"{kind.name}: expected measured values of shape {shape}, one a pose of the drive (NaN where there is "
            f"none), got shape {array.shape}"
        )
    return array


def _check_rigid(kind: MeasuredQuantity, array: np.ndarray) -> None:
    """Raise ValueError for rotations that are none to three digits: measured ones are rounded."""
    turn = array[:, :3, :3]
    off = np.abs(turn @ turn.swapaxes(1, 2) - np.eye(3)).max(initial=0.0)
    if off > 1e-3 or (np.linalg.det(turn) < 0).any():
        raise ValueError(f"{kind.name}: the measured rotations must be orthonormal and right-handed, off by {off:.2g}")
    if kind.key.kind == "pose" and np.abs(array[:, 3] - [0.0, 0.0, 0.0, 1.0]).max(initial=0.0) > 1e-3:
        raise ValueError(f"{kind.name}: the last row of the measured poses must be 0, 0, 0, 1; are they transposed?")


def _deviations(kinds: list[MeasuredQuantity], sigma: Any) -> list[np.ndarray]:
    """List the standard deviations of all residuals; ones where they are not given, and all of one unit."""
    alike = len({length for kind in kinds for length in kind.lengths}) == 1
    if sigma is None or not isinstance(sigma, Mapping):
        if not alike:
            raise ValueError(
                "lengths and angles were measured: say how exact either is, as sigma={jk.pose('platform'): (0.01, "
                "1e-4), 'D': 1e-4}, a standard deviation for each key, of poses one of lengths and one of angles"
            )
        return [np.full(len(kind.lengths), 1.0 if sigma is None else _positive("sigma", sigma)) for kind in kinds]
    for key in sigma:
        if key not in [kind.key for kind in kinds]:
            raise ValueError(
                f"sigma names {key!r}, which was not measured{nearest(str(key), [kind.name for kind in kinds])}"
            )
    found = []
    for kind in kinds:
        if kind.key not in sigma:
            raise ValueError(f"sigma has no standard deviation of {kind.name}")
        given = sigma[kind.key]
        if len(set(kind.lengths)) > 1:
            if not isinstance(given, tuple | list) or len(given) != 2:
                raise ValueError(f"sigma of {kind.name} must be two numbers (length, angle), got {given!r}")
            each = [_positive(f"sigma of {kind.name}", number) for number in given]
            found.append(np.where(kind.lengths, *each))
        else:
            found.append(np.full(len(kind.lengths), _positive(f"sigma of {kind.name}", given)))
    return found


def _positive(what: str, given: Any) -> float:
    """Check a standard deviation; ValueError for what is no positive number."""
    return float(positive_number(given, what, "a positive number, a standard deviation"))
