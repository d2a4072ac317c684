"""Link lengths: read and change all distances and angles between the joints of each part, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from jaxkin._arguments import by_name, exact_numbers
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.dimensions.feature_geometry import between, moved, value
from jaxkin.dimensions.features import Feature, Length, LengthName, Quantity, length_table
from jaxkin.dimensions.rearrange import Change, Layout, arrange
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage

MAX_MISFIT = 1e-9
"""Largest misfit of the lengths of a part, relative to its size, that is not reported as a contradiction: far above
rounding in float64."""
MISFIT_ROUNDINGS = 100
"""The same in units of rounding, where these are more: parts of three to six joints have two of them in float32."""

_ORDER = ("angle", "distance", "radius", "offset")
"""Order in which the quantities of a body are changed."""

_SIDES = ("frames_1", "frames_2")
"""The frames of a joint on its two parts."""

Body = tuple[Feature, ...]
"""The features of one part, or of a body between two frames of a contact joint."""


def lengths(linkage: Linkage) -> dict[LengthName, float | jax.Array]:
    """Measure all lengths by name: see `Mechanism.lengths`."""
    table = length_table(linkage)
    return dict(zip(table, _measured(linkage, list(table.values())), strict=True))


def lengths_now(linkage: Linkage, keys: Sequence[object]) -> list[float | jax.Array]:
    """Measure some lengths by any names that `with_lengths` takes; ValueError where there is none."""
    return _measured(linkage, [find_length(linkage, key) for key in keys])


def _number(quantity):
    """Turn a numpy scalar into a float; JAX arrays stay as they are."""
    return quantity if isinstance(quantity, jax.Array) else float(quantity)


def _measured(linkage: Linkage, asked: Sequence[Length]) -> list[float | jax.Array]:
    """Measure lengths."""
    xp = jnp if traced(linkage) else np
    found = [linkage.joints[each.first].pitch if each.quantity == "pitch" else None for each in asked]
    between_two = [number for number, pitch in enumerate(found) if pitch is None]
    kinds: list[Any] = []
    poses: list[Any] = []
    for number in between_two:
        body, first, second, quantity = asked[number]
        kinds.append((_kind(body[first]), _kind(body[second]), quantity))
        poses.append(tuple(_pose(xp, linkage, body[index]) for index in (first, second)))
    for number, quantity in zip(between_two, _side_by_side(xp, _quantity, kinds, poses), strict=True):
        found[number] = quantity
    return [_number(each) for each in found]


def _quantity(xp, kind: tuple[Feature, Feature, Quantity], pose1, pose2):
    """Measure a quantity between two features of some kinds at their poses."""
    one, two, quantity = kind
    return value(between(xp, one, pose1, two, pose2), quantity)


def _kind(feature: Feature) -> Feature:
    """Leave out of which joint a feature is: what remains decides how lengths follow from its pose."""
    return feature._replace(joint=0, side="frames_1", frame=0)


def _side_by_side(
    xp, function: Callable[..., Any], kinds: Sequence[Any], given: Sequence[tuple[Any, ...]]
) -> list[Any]:
    """Call a function of `xp`, a kind and arrays for each of several; where JAX traces, all of one kind at once.

    So a program holds the operations once: to trace and to compile them takes far longer than to compute them.
    """
    found: dict[int, Any] = {}
    for kind in dict.fromkeys(kinds):
        own = [number for number, each in enumerate(kinds) if each == kind]
        if xp is np or len(own) == 1:
            found |= {number: function(xp, kind, *given[number]) for number in own}
            continue
        stacked = jax.tree.map(lambda *arrays: jnp.stack(arrays), *(given[number] for number in own))
        leaves, tree = jax.tree.flatten(jax.vmap(partial(function, xp, kind))(*stacked))
        found |= zip(own, (tree.unflatten(each) for each in zip(*leaves, strict=True)), strict=True)
    return [found[number] for number in range(len(kinds))]


def _pose(xp, linkage: Linkage, feature: Feature):
    """Look up the 4x4 pose of a feature."""
    return xp.asarray(getattr(linkage.joints[feature.joint], feature.side)[feature.frame])


def find_length(linkage: Linkage, key: object) -> Length:
    """Find a length by its name, with its two joints in either order. Raises ValueError with the nearest names."""
    table = length_table(linkage)
    if not isinstance(key, tuple) or not key or not all(isinstance(name, str) for name in key):
        example = next(iter(table), ("coupler", "B", "C"))
        raise ValueError(f"a length is named by a part and two of its joints, as {example!r}, got {key!r}")
    row = linkage.structure.row_of.get(key[0], key[0])
    same = (row, *key[1:])
    if same in table:
        return table[same]
    exchanged = (row, *key[1:3][::-1], *key[3:])
    if len(key) >= 3 and key[3:] != ("offset",) and exchanged in table:
        length = table[exchanged]
        return length._replace(first=length.second, second=length.first)
    raise ValueError(_unknown(linkage, key, row, table))


def _unknown(linkage: Linkage, key: LengthName, row: str, table: dict[LengthName, Length]) -> str:
    """Say that there is no such length, with the nearest names or all lengths of the part."""
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
    """Change some lengths: see `Mechanism.with_lengths`."""
    changed, misfits = rearranged(linkage, changes)
    if linkage.ideal:  # both the joints as given and their mobile replacements get the lengths
        ideal = with_lengths(linkage.with_joints(linkage.ideal), changes)
        changed = changed.with_joints(changed.joints, ideal.joints)
    for row, misfit in misfits.items():
        most = max(MAX_MISFIT, MISFIT_ROUNDINGS * float(jnp.finfo(misfit.dtype).eps))
        known = lax.stop_gradient(misfit) if traced(misfit) else misfit  # under `grad` alone the number is there
        if not traced(known):
            if not float(known) <= most:
                asked = ", ".join(f"{key!r}: {_shown(changes[key])}" for key in changes)
                raise ValueError(
                    f"part {row!r} cannot have {asked} with all its other lengths as they are (they miss by "
                    f"{float(known):.1g} of its size): change others of it in the same call so that they fit "
                    "together, or place its joints by with_points"
                )
        else:
            # Traced numbers cannot raise: every pose gets the status NONFINITE instead of a wrong length. The choice
            # keeps NaN out of the derivative, which a sum would hand on.
            fits = misfit <= most
            joints = [
                replace(joint, **{side: jnp.where(fits, getattr(joint, side), jnp.nan) for side in _SIDES})
                if row in [linkage.structure.row_of[part] for part in joint.parts]
                else joint
                for joint in changed.joints
            ]
            changed = changed.with_joints(joints, changed.ideal)
    return changed


def rearranged(linkage: Linkage, changes: Mapping[Any, Any]) -> tuple[Linkage, dict[str, np.floating | jax.Array]]:
    """Change some lengths; return the mechanism, and the misfit of each part with three joints or more.

    Where the new lengths and those to be kept contradict each other, the joints get the nearest places, and the misfit
    (relative to the size of the part) is a differentiable measure of the contradiction.
    """
    bodies, pitches = _by_body(linkage, changes)
    xp = jnp if traced(linkage, *(wanted for group in bodies.values() for _, wanted in group)) else np
    frames: dict[tuple[int, str, int], Any] = {}
    misfits: dict[str, np.floating | jax.Array] = {}
    kinds = [
        (tuple(map(_kind, body)), tuple(each._replace(body=()) for each, _ in group)) for body, group in bodies.items()
    ]
    given = [
        (
            xp.stack([_pose(xp, linkage, feature) for feature in body]),
            xp.stack([xp.asarray(wanted, dtype=float) for _, wanted in group]),
        )
        for body, group in bodies.items()
    ]
    arranged = _side_by_side(xp, _arranged_program if xp is jnp else _arranged, kinds, given)
    for body, (poses, misfit) in zip(bodies, arranged, strict=True):
        if misfit is not None:
            misfits[_row(linkage, body)] = misfit
        frames.update({(f.joint, f.side, f.frame): pose for f, pose in zip(body, poses, strict=True)})
    joints = [
        _with_frames(joint, {key[1:]: pose for key, pose in frames.items() if key[0] == column}, pitches.get(column))
        for column, joint in enumerate(linkage.joints)
    ]
    return linkage.with_joints(joints), misfits


def _by_body(
    linkage: Linkage, changes: Mapping[Any, Any]
) -> tuple[dict[Body, list[tuple[Length, Any]]], dict[int, Any]]:
    """Check the new lengths (ValueError) and group them by body, angles first; pitches by the column of their joint."""
    bodies: dict[Body, list[tuple[Length, Any]]] = {}
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
    for group in bodies.values():
        group.sort(key=lambda entry: _ORDER.index(entry[0].quantity))
    return bodies, pitches


def _arranged(xp, kind: tuple[Body, tuple[Length, ...]], original, wanted) -> tuple[Any, Any]:
    """Place the features of one body so that some lengths get the values wanted.

    Returns the poses of the features (features, 4, 4), and the misfit, None for two features only.
    """
    body, changed = kind
    poses = list(original)
    for length, new in zip(changed, wanted, strict=True):
        one, two = body[length.first], body[length.second]
        found = between(xp, one, poses[length.first], two, poses[length.second])
        if one.kind == two.kind == "plane" and length.second < length.first:
            # of two planes `lengths` has the distance of the later one from the one before, which is turned here
            found = found._replace(about=poses[length.first][:3, 3])
        along, change = poses[length.first][:3, one.axis], new - value(found, length.quantity)
        poses[length.second] = moved(xp, length.quantity, found, change, along, poses[length.second])
    if len(body) == 2:
        return xp.stack(poses), None
    layout = Layout(body, tuple(Change(length.first, length.second, length.quantity) for length in changed))
    return arrange(xp, layout, original, xp.stack(poses), wanted)


_arranged_program = jax.jit(_arranged, static_argnums=(0, 1))
"""One program for a body: operation by operation, a gradient that is not inside `jit` compiles some fifty."""


def _row(linkage: Linkage, body: Body) -> str:
    """Name the row of the incidence matrix that a body belongs to."""
    return linkage.structure.row_of[linkage.joints[body[0].joint].parts[_SIDES.index(body[0].side)]]


def _with_frames(joint: Joint, frames: Mapping[tuple, Any], pitch: Any) -> Joint:
    """Replace some frames of a joint, given by (side, index), and its pitch if it is not None."""
    sides = {}
    for side in _SIDES:
        given = getattr(joint, side)
        new = [frames.get((side, i), given[i]) for i in range(len(joint.movements))]
        sides[side] = (jnp if traced(new, given) else np).stack(new)
    return replace(joint, **sides, pitch=joint.pitch if pitch is None else pitch)


def range_of(length: Length) -> tuple[float, float]:
    """Find the least and the largest value that a length may have: lengths without a sign, and angles, have bounds."""
    signed = length.quantity in ("offset", "pitch") or "plane" in [feature.kind for feature in length.body]
    highest = float(np.pi) if length.quantity == "angle" else np.inf
    return (-np.inf if signed and length.quantity not in ("radius", "angle") else 0.0), highest


def _checked(key: LengthName, length: Length, wanted):
    """Check that a new length is a finite number in its range (ValueError); traced numbers are not checked."""
    if traced(wanted):
        known = lax.stop_gradient(wanted)  # under `grad` alone the number is there
        if not traced(known) and not np.isfinite(known).all():
            raise ValueError(f"length {key!r} must be a finite number, got {known}")
        return wanted
    number = exact_numbers(wanted, f"length {key!r}", "a number")
    if number.shape != ():
        raise ValueError(
            f"length {key!r} must be one number, got an array of shape {number.shape}; for many designs at once map "
            "over them, as in jax.vmap(lambda value: mechanism.with_lengths({...: value}).sweep(drive).coordinates)"
        )
    if not np.isfinite(number):
        raise ValueError(f"length {key!r} must be a finite number, got {number}")
    low, high = range_of(length)
    if length.quantity == "distance" and number < low:
        raise ValueError(f"length {key!r} must not be negative, got {number}: a distance has no direction")
    if length.quantity == "radius" and number <= 0:
        raise ValueError(f"radius {key!r} must be positive, got {number}")
    if length.quantity == "angle" and not low <= number <= high:
        raise ValueError(f"angle {key!r} must be in radians between 0 and pi, got {number}")
    return number


def _shown(wanted: Any) -> str:
    """Write a new length for a message."""
    known = lax.stop_gradient(wanted) if traced(wanted) else wanted
    return repr(known) if traced(known) else f"{float(known):.6g}"
