"""Drives that are no joints: the pose of a part, its orientation, or the path of one of its points.

A target is a free joint between the fixed parts and the part, all or some of whose coordinates are driven. So the
loops that it closes, the mobility, the statuses and the derivatives are those of any drive, and the actuators of the
mechanism come out as coordinates (inverse kinematics). In a planar mechanism the joint is a planar pair.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import jax.numpy as jnp
import numpy as np
from jax import lax

from jaxkin._arguments import exact_numbers, text
from jaxkin._memory import once_for_each
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.geometry.trig import TURN
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.pairs import free, planar
from jaxkin.linkage.coupled import coupled
from jaxkin.linkage.linkage import Linkage
from jaxkin.topology.structure import structure

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

OFF_PLANE = 1e-9
"""How far a target of a planar mechanism may leave its plane, over the size of the joints, or in radians: rounding."""


@dataclass(frozen=True)
class Target:
    """What of a part is prescribed, as a key of a drive: `mechanism.sweep({jk.pose("platform"): poses})`."""

    part: str
    kind: Literal["pose", "point", "orientation"]
    at: tuple[float, float, float] | None = None
    """The point, in the assembled pose."""

    @property
    def joint(self) -> str:
        """Name of the joint that stands for the target."""
        if self.at is None:
            return f"{self.part} {self.kind}"
        return f"{self.part} ({', '.join(f'{x:g}' for x in self.at)})"

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of its value in one pose."""
        return {"pose": (4, 4), "point": (3,), "orientation": (3, 3)}[self.kind]


def pose(part: str) -> Target:
    """Prescribe the pose of a part: (poses, 4, 4), its displacements from the assembled pose in world coordinates."""
    return Target(text(part, "the part of a target"), "pose")


def point(part: str, at: Iterable[float | int]) -> Target:
    """Prescribe the path of a point of a part: (poses, 3), world coordinates.

    `at` is where the point is in the assembled pose. ValueError where it is not three finite numbers.
    """
    try:
        found = np.asarray(tuple(at), float)
    except (TypeError, ValueError):
        found = np.zeros(0)
    if found.shape != (3,) or not np.isfinite(found).all():
        raise ValueError(f"the point of a target must be three finite numbers (x, y, z), got {at!r}")
    x, y, z = map(float, found)
    return Target(text(part, "the part of a target"), "point", (x, y, z))


def orientation(part: str) -> Target:
    """Prescribe the orientation of a part: (poses, 3, 3), its rotations from the assembled pose."""
    return Target(text(part, "the part of a target"), "orientation")


DriveKey = str | Target


def with_targets(mechanism: Mechanism, drive: Mapping[Any, Any]) -> tuple[Mechanism, Mapping[str, Any]]:
    """Replace the targets of a drive by coordinates of free joints: the mechanism with these, and its drive.

    Raises ValueError for parts that are not there or fixed, and for values of another shape.
    """
    targets = [key for key in drive if isinstance(key, Target)]
    if not targets:
        return mechanism, drive
    found = mechanism_with(mechanism, targets)
    result: dict[str, Any] = {}
    for key, values in drive.items():
        if isinstance(key, Target):
            result |= _coordinates(found.joints[key.joint], key, values, extent(mechanism))
        else:
            result[key] = values
    return found, result


def names_with_targets(mechanism: Mechanism, keys: Iterable[DriveKey]) -> tuple[Mechanism, list[str]]:
    """Add the joints of targets to a mechanism, as `with_targets` does, for a drive without values."""
    keys = list(keys)
    targets = [key for key in keys if isinstance(key, Target)]
    found = mechanism_with(mechanism, targets) if targets else mechanism
    names: list[str] = []
    for key in keys:
        if isinstance(key, Target):
            joint = found.joints[key.joint]
            names += [joint.full_names[k] for k in _driven(joint, key)]
        else:
            names.append(key)
    return found, names


def mechanism_with(mechanism: Mechanism, targets: Iterable[Target]) -> Mechanism:
    """Add the joints of some targets to a mechanism; for each linkage they are made once, unless JAX traces it."""
    targets = tuple(targets)
    if traced(mechanism.linkage):
        return replace(mechanism, linkage=_linkage_with(mechanism, targets))
    kept = _kept(mechanism.linkage)
    if targets not in kept:
        kept[targets] = _linkage_with(mechanism, targets)
    return replace(mechanism, linkage=kept[targets])


@once_for_each
def _kept(linkage: Linkage) -> dict[tuple[Target, ...], Linkage]:
    """Keep the linkages with the joints of targets that were asked for."""
    del linkage
    return {}


def _linkage_with(mechanism: Mechanism, targets: tuple[Target, ...]) -> Linkage:
    linkage = mechanism.linkage
    joints = tuple(_joint(mechanism, target) for target in targets)
    described = [(joint.name, *joint.parts) for joint in (*linkage.joints, *joints)]
    chords = linkage.structure.chords
    found = structure(
        linkage.parts, described, linkage.fixed, None if chords is None else (*chords, *(each.name for each in joints))
    )
    made = coupled(Linkage.of((*linkage.joints, *joints), found), linkage.couplings)
    ideal = (*linkage.ideal, *joints) if linkage.ideal else ()
    return replace(made.with_joints(made.joints, ideal), spinning=linkage.spinning)


def _joint(mechanism: Mechanism, target: Target) -> Joint:
    """Make the joint of a target: from the fixed parts, at its point or at the middle of the joints of its part."""
    linkage = mechanism.linkage
    if target.part not in linkage.parts:
        raise ValueError(f"{target.joint}: there is no part {target.part!r}{nearest(target.part, linkage.parts)}")
    if target.part in linkage.fixed:
        raise ValueError(f"{target.joint}: the part {target.part!r} is fixed, and no target moves it")
    held = [number for number, joint in enumerate(linkage.joints) if target.part in joint.parts]
    at = middle_of_joints(linkage, target.part) if target.at is None else target.at
    normal = linkage.normal(held)
    parts = (linkage.fixed[0], target.part)
    name = target.joint
    made = free(name, *parts, point=at) if normal is None else planar(name, *parts, point=at, normal=normal)
    return replace(made, evidence=Evidence(EvidenceKind.TARGET))


def middle_of_joints(linkage: Linkage, part: str) -> Any:
    """Average the origins of the frames of all joints of a part (3,)."""
    held = [joint for joint in linkage.joints if part in joint.parts]
    xp = jnp if traced(held) else np
    return xp.mean(xp.stack([xp.asarray(joint.frames_1, float)[0, :3, 3] for joint in held]), axis=0)


def extent(mechanism: Mechanism) -> float:
    """Find the largest extent of the joints of a mechanism; 1 where JAX traces them."""
    if traced(mechanism.linkage):
        return 1.0
    origins = np.concatenate([np.asarray(joint.frames_1, float)[:, :3, 3] for joint in mechanism.all_joints])
    return float(np.ptp(origins, axis=0).max()) or 1.0


def _driven(joint: Joint, target: Target) -> range:
    """List the indices of the coordinates of the joint that the target prescribes."""
    slides = joint.freedoms - (1 if joint.freedoms == 3 else 3)
    return {
        "pose": range(joint.freedoms),
        "point": range(slides),
        "orientation": range(slides, joint.freedoms),
    }[target.kind]


def _coordinates(joint: Joint, target: Target, values: Any, size: float) -> dict[str, Any]:
    """Compute the driven coordinates of the joint of a target, by full names."""
    xp: Any = jnp if traced(values, joint) else np
    given: Any = xp.asarray(target_values(target, values))
    if xp is np:
        given = _rigid_or_nan(target, given)
    frame = xp.asarray(joint.frames_1, float)[0]
    at, axes = frame[:3, 3], frame[:3, :3]
    eye = xp.broadcast_to(xp.eye(3), (len(given), 3, 3))
    turned = eye if target.kind == "point" else given[:, :3, :3]
    moved = xp.zeros((len(given), 3))
    if target.kind == "pose":
        moved = given[:, :3, :3] @ at + given[:, :3, 3] - at
    elif target.kind == "point":
        moved = given - at
    if joint.freedoms == 3:
        rows = _in_plane(target, axes, moved, turned, size, xp)
    else:
        rows = [*moved.T, *_unwrapped(_angles(turned, xp), xp)]
    return {joint.full_names[k]: rows[k] for k in _driven(joint, target)}


def target_values(target: Target, values: Any) -> Any:
    """Convert the values of a target to an array (poses, *shape of one), of JAX where they are traced.

    Raises ValueError for what is no number, and for arrays of another shape.
    """
    shape = f"(poses, {', '.join(map(str, target.shape))})"
    given = exact_numbers(values, f"{target.joint}: the values", f"real numbers, an array {shape}")
    if given.ndim != len(target.shape) + 1 or given.shape[1:] != target.shape:
        raise ValueError(f"{target.joint}: expected an array of shape {shape}, got shape {given.shape}")
    return given


def _rigid_or_nan(target: Target, given: np.ndarray) -> np.ndarray:
    """Check that finite poses are rigid; ValueError where one is not. A pose with NaN or infinity is NaN as a whole."""
    finite = np.isfinite(given).all(axis=tuple(range(1, given.ndim)))
    if target.kind != "point":
        check_rigid(target, given[finite, :3, :3], given[finite])
    return np.where(finite.reshape(-1, *[1] * (given.ndim - 1)), given, np.nan)


def _unwrapped(angles: Any, xp: Any) -> Any:
    """Unwrap angles (angles, poses) from pose to pose, past poses that are NaN: these stay NaN, and spoil no other."""
    finite = xp.isfinite(angles).all(axis=0)
    numbered = xp.where(finite, xp.arange(len(finite)), 0)
    held = angles[:, np.maximum.accumulate(numbered) if xp is np else lax.cummax(numbered)]
    turns = xp.round(xp.diff(held, axis=1, prepend=held[:, :1]) / TURN)
    return angles - TURN * xp.cumsum(xp.where(xp.isfinite(turns), turns, 0.0), axis=1)


def check_rigid(target: Target, turned: Any, given: Any) -> None:
    """Raise ValueError where a pose is not rigid to nine digits."""
    off = np.abs(turned @ turned.swapaxes(1, 2) - np.eye(3)).max(initial=0.0)
    mirrored = (np.linalg.det(turned) < 0).any()
    last = np.abs(given[:, 3] - [0, 0, 0, 1]).max(initial=0.0) if target.kind == "pose" else 0.0
    if off > OFF_PLANE or mirrored or last > 0:
        raise ValueError(
            f"{target.joint}: the poses must be rigid, with columns of perpendicular unit vectors, right-handed, and a "
            f"last row 0, 0, 0, 1; they are off by {max(off, last):.2g}" + (", and mirrored" if mirrored else "")
        )


def _in_plane(target: Target, axes: Any, moved: Any, turned: Any, size: float, xp: Any) -> list[Any]:
    """Compute the coordinates x, y, phi of a planar pair; ValueError where known numbers leave its plane."""
    local = moved @ axes
    turn = axes.T @ turned @ axes
    off = [xp.abs(local[:, 2]) / size, xp.abs(turn[:, :2, 2]).max(axis=1), xp.abs(turn[:, 2, :2]).max(axis=1)]
    if not traced(off) and (leaves := float(np.nanmax(np.stack(off), initial=0.0))) > OFF_PLANE:
        raise ValueError(
            f"{target.joint}: the loops move in one plane, with the normal {np.round(np.asarray(axes)[:, 2], 6)}, and "
            f"the target leaves it by {leaves:.2g} of the size of the mechanism, or radians"
        )
    return [local[:, 0], local[:, 1], *_unwrapped(xp.arctan2(turn[:, 1, 0], turn[:, 0, 0])[None], xp)]


def _angles(turned: Any, xp: Any) -> Any:
    """Compute the angles theta, phi, psi (3, poses) of rotations Rz(psi) Ry(phi) Rx(theta)."""
    level = xp.hypot(turned[:, 2, 1], turned[:, 2, 2])
    sines = xp.stack([turned[:, 2, 1], -turned[:, 2, 0], turned[:, 1, 0]])
    return xp.arctan2(sines, xp.stack([turned[:, 2, 2], level, turned[:, 0, 0]]))
