"""What a calibration may change: lengths, places of joint frames, and places of measured points on their parts.

An unknown is counted from what was given: its change is zero there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxkin._arguments import several
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.dimensions.feature_geometry import shifted, turned
from jaxkin.dimensions.frames import locate
from jaxkin.dimensions.lengths import find_length, lengths_now, range_of
from jaxkin.geometry.pose import frame
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.targets import Target

COMPONENTS = ("x", "y", "z", "rx", "ry", "rz")
"""Changes of a frame: translations along, and turns about, three axes."""
IN_PLANE = ("x", "y", "rz")
"""Those that leave a planar mechanism planar, the z axis along the normal."""
WORLD_AXIS = 1e-9
"""Sine of the angle within which the normal of a plane counts as an axis of the world."""


class UnknownFrame(NamedTuple):
    """A joint frame that may change. Static to JAX."""

    place: Any
    """The joint, or (part, joint), as it was given."""
    joint: int
    """Number of the joint in `Linkage.joints`."""
    sides: tuple[str, ...]
    """"frames_1", "frames_2" or both."""
    components: tuple[int, ...]
    """Those that may change, as numbers in `COMPONENTS`."""


class Nominal(NamedTuple):
    """The numbers from which changes are counted."""

    values: Float[np.ndarray, " unknowns"]
    """Lengths and markers as given, zeros for frames."""
    axes: tuple[Float[np.ndarray, "3 3"], ...]
    """The directions of x, y, z of each unknown frame, as rows."""


@dataclass(frozen=True)
class Unknowns:
    """The unknowns, one after another: lengths, components of frames, points. Static to JAX."""

    lengths: tuple[Any, ...]
    frames: tuple[UnknownFrame, ...]
    markers: tuple[Target, ...]
    """Measured points whose place on the part is unknown: three numbers each."""

    @property
    def names(self) -> tuple[str, ...]:
        """A name for each unknown."""
        found = [written(key) for key in self.lengths]
        found += [f"{COMPONENTS[k]} of {written(each.place)}" for each in self.frames for k in each.components]
        return (*found, *(f"{axis} of {marker.joint}" for marker in self.markers for axis in "xyz"))

    def are_angles(self, linkage: Linkage) -> tuple[bool, ...]:
        """Tell which unknowns are angles; all others are lengths."""
        found = [find_length(linkage, key).quantity == "angle" for key in self.lengths]
        found += [k > 2 for each in self.frames for k in each.components]
        return (*found, *[False] * (3 * len(self.markers)))

    def ranges(self, linkage: Linkage) -> Float[np.ndarray, "unknowns 2"]:
        """Find the least and the largest value of each unknown: a length without a sign is not negative."""
        found = np.tile([-np.inf, np.inf], (len(self.names), 1))
        for number, key in enumerate(self.lengths):
            found[number] = range_of(find_length(linkage, key))
        return found

    def applied(self, mechanism: Mechanism, nominal: Nominal, changes: Any) -> tuple[Mechanism, dict[Target, Any]]:
        """Change a mechanism, and say where the markers are on their parts then."""
        count = len(self.lengths)
        if count:
            new = {
                key: now + change
                for key, now, change in zip(self.lengths, nominal.values[:count], changes[:count], strict=True)
            }
            mechanism = mechanism.with_lengths(new)
        xp = jnp if traced(mechanism, changes) else np
        joints: list[Joint] = list(mechanism.all_joints)
        for each, rows in zip(self.frames, nominal.axes, strict=True):
            here = [xp.zeros(())] * 6
            for number, component in enumerate(each.components):
                here[component] = changes[count + number]
            count += len(each.components)
            shift, turn = (xp.stack(three) @ xp.asarray(rows) for three in (here[:3], here[3:]))
            for side in each.sides:
                frames = list(getattr(joints[each.joint], side))
                end = 0 if side == "frames_1" else -1
                pose = xp.asarray(frames[end])
                frames[end] = shifted(xp, turned(xp, pose, turn, pose[:3, 3]), shift)
                stacked = xp.stack(frames)
                given = joints[each.joint]
                joints[each.joint] = (
                    replace(given, frames_1=stacked) if side == "frames_1" else replace(given, frames_2=stacked)
                )
        if self.frames:
            mechanism = mechanism.with_linkage(mechanism.linkage.with_joints(joints))
        markers = {}
        for marker in self.markers:
            markers[marker] = xp.asarray(marker.at) + changes[count : count + 3]
            count += 3
        return mechanism, markers


def unknowns_of(
    mechanism: Mechanism, lengths: Any, frames: Any, markers: Any, measured: Mapping[Any, Any]
) -> tuple[Unknowns, Nominal]:
    """Check the unknowns that were asked for, and find their nominal numbers; ValueError for what is not there."""
    if isinstance(lengths, str) or (isinstance(lengths, tuple) and lengths and isinstance(lengths[0], str)):
        raise ValueError(f"lengths must be a list of keys of mechanism.lengths, as [{lengths!r}], got {lengths!r}")
    keys = several(lengths, "lengths", "keys of mechanism.lengths")
    for key in keys:
        find_length(mechanism.linkage, key)
    if len(set(keys)) < len(keys):
        raise ValueError("lengths names one of them twice")
    wanted = [(place, None) for place in several(frames, "frames", "joints and (part, joint)")]
    found: list[UnknownFrame] = []
    axes = []
    for place, components in frames.items() if isinstance(frames, Mapping) else wanted:
        number, side = locate(mechanism.linkage, place)
        if place in [known.place for known in found]:
            raise ValueError(f"frames names {place!r} twice")
        joint = mechanism.all_joints[number]
        if side is None and len(joint.movements) > 1:
            raise ValueError(f"frames: {place!r} has several frames: say on which part, as {(joint.parts[0], place)!r}")
        normal = mechanism.linkage.normal([number])
        known = COMPONENTS if normal is None else IN_PLANE
        rows = np.eye(3) if normal is None or _is_z(normal) else frame(np.zeros(3), normal)[:3, :3].T
        sides = ("frames_1", "frames_2") if side is None else (side,)
        found.append(UnknownFrame(place, number, sides, _components(place, components, known)))
        axes.append(rows)
    if isinstance(markers, Target):
        raise ValueError(f"markers must be a list of measured points, as [{markers!r}], got {markers!r}")
    markers = several(markers, "markers", "measured points")
    for marker in markers:
        if not isinstance(marker, Target) or marker.kind != "point" or marker not in measured:
            points = ", ".join(key.joint for key in measured if isinstance(key, Target) and key.kind == "point")
            raise ValueError(f"markers must be points that were measured ({points or 'there is none'}), got {marker!r}")
    unknowns = Unknowns(keys, tuple(found), markers)
    if not unknowns.names:
        raise ValueError("nothing to calibrate: name lengths, frames or markers")
    values = [float(each) for each in lengths_now(mechanism.linkage, keys)]
    values += [0.0 for each in found for _ in each.components]
    values += [x for marker in markers for x in marker.at or ()]
    return unknowns, Nominal(np.array(values), tuple(axes))


def written(key: Any) -> str:
    """Write a key without quotation marks."""
    return key if isinstance(key, str) else " ".join(map(str, key))


def _components(place: Any, asked: Any, known: Sequence[str]) -> tuple[int, ...]:
    """Return the numbers, in COMPONENTS, of the components by which a frame at `place` may change.

    `asked` is one name or several, or None for all that are `known` there. Raises ValueError for other names.
    """
    chosen = known if asked is None else asked
    if isinstance(chosen, str):
        chosen = (chosen,)
    for name in chosen:
        if name not in known:
            planar = " (it moves in a plane, z along its normal)" if tuple(known) == IN_PLANE else ""
            raise ValueError(
                f"frames: {place!r} can change by {', '.join(known)}{planar}, got {name!r}{nearest(str(name), known)}"
            )
    return tuple(COMPONENTS.index(name) for name in dict.fromkeys(chosen))


def _is_z(normal: Float[np.ndarray, "3"]) -> bool:
    return bool(np.hypot(normal[0], normal[1]) < WORLD_AXIS)
