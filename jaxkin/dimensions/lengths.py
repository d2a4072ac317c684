"""Link lengths: all distances and angles between the joints of each part, by name, to be read and to be changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin._names import by_name, nearest
from jaxkin._traced import traced
from jaxkin.dimensions.feature_geometry import between, moved, value
from jaxkin.dimensions.features import Feature, Key, Length, length_table
from jaxkin.dimensions.rearrange import Change, Layout, arrange
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage

MAX_MISFIT = 1e-9
"""Largest error of a length, relative to the size of its part, at which lengths are said to hold together."""

_ORDER = ("angle", "distance", "radius", "offset")


def lengths(linkage: Linkage) -> dict[Key, float | jax.Array]:
    """The values of all lengths by name: see `Mechanism.lengths`."""
    table = length_table(linkage)
    xp = jnp if traced(linkage) else np
    return {key: _number(_measured(xp, linkage, length)) for key, length in table.items()}


def _number(quantity):
    return quantity if isinstance(quantity, jax.Array) else float(quantity)


def _measured(xp, linkage: Linkage, length: Length):
    if length.quantity == "pitch":
        return linkage.joints[length.first].pitch
    one, two = length.body[length.first], length.body[length.second]
    pose1, pose2 = (_pose(xp, linkage, feature) for feature in (one, two))
    return value(between(xp, one, pose1, two, pose2), length.quantity)


def _pose(xp, linkage: Linkage, feature: Feature):
    return xp.asarray(getattr(linkage.joints[feature.joint], feature.side)[feature.frame])


def find_length(linkage: Linkage, key: object) -> Length:
    """The length of that name, its two joints in the order given. Raises ValueError with the nearest names."""
    table = length_table(linkage)
    if not isinstance(key, tuple) or not all(isinstance(name, str) for name in key):
        example = next(iter(table), ("coupler", "B", "C"))
        raise ValueError(f"a length is named by a part and two of its joints, as {example!r}, got {key!r}")
    row = linkage.structure.row_of.get(key[0], key[0])
    same = (row, *key[1:])
    if same in table:
        return table[same]
    turned = (row, *key[1:3][::-1], *key[3:])
    if len(key) >= 3 and key[3:] != ("offset",) and turned in table:
        length = table[turned]
        return length._replace(first=length.second, second=length.first)
    raise ValueError(_unknown(linkage, key, row, table))


def _unknown(linkage: Linkage, key: Key, row: str, table: dict[Key, Length]) -> str:
    start = f"there is no length {key!r}"
    joints = list(linkage.structure.joints)
    if row not in linkage.structure.parts and row not in joints:
        return f"{start}: no part {key[0]!r}{nearest(key[0], [*linkage.parts])}"
    for name in key[1:3] if row in linkage.structure.parts else ():
        if name not in joints:
            return f"{start}: no joint {name!r}{nearest(name, joints)}"
    known = [repr(known) for known in table if known[0] == row]
    return f"{start}; of {row!r} there are: {', '.join(known) or 'none'}"


def with_lengths(linkage: Linkage, changes: Mapping[Any, Any]) -> Linkage:
    """The mechanism with some lengths changed: see `Mechanism.with_lengths`."""
    changed, misfits = rearranged(linkage, changes)
    if linkage.ideal:  # the lengths are given to the joints that move as to those that disagree
        ideal = with_lengths(linkage.with_joints(linkage.ideal), changes)
        changed = changed.with_joints(changed.joints, ideal.joints)
    for row, misfit in misfits.items():
        if not traced(misfit):
            if not float(misfit) <= MAX_MISFIT:
                asked = ", ".join(f"{key!r}: {_shown(changes[key])}" for key in changes)
                raise ValueError(
                    f"part {row!r} cannot have {asked} with all its other lengths as they are (they miss by "
                    f"{float(misfit):.1g} of its size): change others of it in the same call so that they fit "
                    "together, or place its joints by with_points"
                )
        else:
            # seen as the status NONFINITE of every pose: never as a wrong length
            spoilt = jnp.where(misfit <= MAX_MISFIT, 0.0, jnp.nan)
            joints = [
                replace(joint, frames_1=joint.frames_1 + spoilt)
                if row in [linkage.structure.row_of[part] for part in joint.parts]
                else joint
                for joint in changed.joints
            ]
            changed = changed.with_joints(joints, changed.ideal)
    return changed


def rearranged(linkage: Linkage, changes: Mapping[Any, Any]) -> tuple[Linkage, dict[str, np.floating | jax.Array]]:
    """The mechanism with some lengths changed, and for each part with three joints or more what they miss by.

    Where the lengths asked for and those to be kept cannot hold together, the nearest place of the joints is given, and
    the misfit (relative to the size of the part) is a differentiable measure of it.
    """
    bodies: dict[tuple[Feature, ...], list[tuple[Length, Any]]] = {}
    pitches: dict[int, Any] = {}
    named: dict[Length, Any] = {}
    for key, wanted in by_name(changes, "lengths", "{('coupler', 'B', 'C'): 3.6}").items():
        length = find_length(linkage, key)
        wanted = _checked(key, length, wanted)
        same = length._replace(first=min(length[1:3]), second=max(length[1:3]))
        same = length if length.quantity == "offset" else same
        if same in named:
            raise ValueError(f"the lengths {named[same]!r} and {key!r} are the same: give it once")
        named[same] = key
        if length.quantity == "pitch":
            plain = not traced(wanted)
            pitches[length.first] = np.array(wanted, float) if plain else jnp.asarray(wanted, float) + 0.0
        else:
            bodies.setdefault(length.body, []).append((length, wanted))
    xp = jnp if traced(linkage, *(wanted for group in bodies.values() for _, wanted in group)) else np
    frames: dict[tuple[int, str, int], Any] = {}
    misfits: dict[str, np.floating | jax.Array] = {}
    for body, group in bodies.items():
        group.sort(key=lambda entry: _ORDER.index(entry[0].quantity))
        poses = [_pose(xp, linkage, feature) for feature in body]
        original = xp.stack(poses)
        for length, wanted in group:
            one, two = body[length.first], body[length.second]
            found = between(xp, one, poses[length.first], two, poses[length.second])
            change = xp.asarray(wanted) - value(found, length.quantity)
            direction = poses[length.first][:3, one.axis]
            poses[length.second] = moved(xp, length.quantity, found, change, direction, poses[length.second])
        if len(body) > 2:
            layout = Layout(body, tuple(Change(length.first, length.second, length.quantity) for length, _ in group))
            targets = xp.stack([xp.asarray(wanted, dtype=float) for _, wanted in group])
            moved_poses, misfit = arrange(xp, layout, original, xp.stack(poses), targets)
            poses, misfits[_row(linkage, body)] = list(moved_poses), misfit
        frames.update({(f.joint, f.side, f.frame): pose for f, pose in zip(body, poses, strict=True)})
    joints = [
        _with_frames(joint, {key[1:]: pose for key, pose in frames.items() if key[0] == column}, pitches.get(column))
        for column, joint in enumerate(linkage.joints)
    ]
    return linkage.with_joints(joints), misfits


def _row(linkage: Linkage, body: tuple[Feature, ...]) -> str:
    joint = linkage.joints[body[0].joint]
    return linkage.structure.row_of[joint.parts[0 if body[0].side == "frames_1" else 1]]


def _with_frames(joint: Joint, frames: Mapping[tuple, Any], pitch: Any) -> Joint:
    """The joint with some of its frames replaced, by (side, index)."""
    sides = {}
    for side in ("frames_1", "frames_2"):
        given = getattr(joint, side)
        new = [frames.get((side, i), given[i]) for i in range(len(joint.movements))]
        sides[side] = (jnp if traced(new, given) else np).stack(new)
    return replace(joint, **sides, pitch=joint.pitch if pitch is None else pitch)


def _checked(key: Key, length: Length, wanted):
    if traced(wanted):
        return wanted
    try:
        if isinstance(wanted, str):
            raise TypeError
        number = np.asarray(wanted, float)
    except (TypeError, ValueError):
        raise ValueError(f"length {key!r} must be a number, got {wanted!r}") from None
    if number.shape != ():
        raise ValueError(
            f"length {key!r} must be one number, got an array of shape {number.shape}; for many designs at once map "
            "over them, as in jax.vmap(lambda value: mechanism.with_lengths({...: value}).sweep(drive).coordinates)"
        )
    if not np.isfinite(number):
        raise ValueError(f"length {key!r} must be a finite number, got {number}")
    if length.quantity == "distance" and number < 0 and "plane" not in [f.kind for f in length.body]:
        raise ValueError(f"length {key!r} must not be negative, got {number}: a distance has no direction")
    if length.quantity == "radius" and number <= 0:
        raise ValueError(f"radius {key!r} must be positive, got {number}")
    if length.quantity == "angle" and not 0 <= number <= np.pi:
        raise ValueError(f"angle {key!r} must be in radians between 0 and pi, got {number}")
    return number


def _shown(wanted: object) -> str:
    return f"{float(wanted):.6g}" if isinstance(wanted, int | float | np.ndarray) else repr(wanted)
