"""Drives that are no joints: the pose of a part, its orientation, or the path of one of its points.

A target is a free joint between the fixed parts and the part, all or some of whose coordinates are driven. So the
loops that it closes, the mobility, the statuses and the derivatives are those of any drive, and the actuators of the
mechanism come out as coordinates (inverse kinematics). Where the loops of the part move in a plane, the joint is a
planar pair.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin._arguments import text
from jaxkin._memory import once_for_each
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.pairs import free, planar
from jaxkin.linkage.coupled import coupled
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.target_values import driven_coordinates, driven_indices
from jaxkin.topology.structure import structure

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism


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

    Raises ValueError for parts that are not there or fixed, and as `driven_coordinates` for values.
    """
    targets = [key for key in drive if isinstance(key, Target)]
    if not targets:
        return mechanism, drive
    found = mechanism_with(mechanism, targets)
    result: dict[str, Any] = {}
    for key, values in drive.items():
        if isinstance(key, Target):
            result |= driven_coordinates(found.joints[key.joint], key, values, extent(mechanism))
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
            names += [joint.full_names[k] for k in driven_indices(joint, key)]
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


def middle_of_joints(linkage: Linkage, part: str) -> Float[Array | np.ndarray, "3"]:
    """Average the origins of the frames of all joints of a part (3,)."""
    held = [joint for joint in linkage.joints if part in joint.parts]
    xp = jnp if traced(held) else np
    return xp.mean(xp.stack([xp.asarray(joint.frames_1, float)[0, :3, 3] for joint in held]), axis=0)


def extent(mechanism: Mechanism) -> float | Array:
    """Find the largest extent of the joints of a mechanism; traced where these are."""
    xp: Any = jnp if traced(mechanism.linkage) else np
    origins = xp.concatenate([xp.asarray(joint.frames_1, float)[:, :3, 3] for joint in mechanism.all_joints])
    largest = xp.ptp(origins, axis=0).max()
    return (float(largest) or 1.0) if xp is np else lax.stop_gradient(xp.where(largest > 0, largest, 1.0))
