"""Resolve the names of driven coordinates, such as "A" or "j5.z", and check the arrays that are given for them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import dtypes, lax
from jaxtyping import Array, Bool, Float

from jaxkin._arguments import by_name, numbers
from jaxkin._names import nearest
from jaxkin._traced import traced
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.linkage import Linkage

InputValues = Float[Array | np.ndarray, " poses"]
"""Displacements of one coordinate, one a pose, radians or lengths of the mechanism; numpy unless JAX traces them."""


class Driven(NamedTuple):
    """A driven coordinate with its displacements."""

    joint: int
    """Number of the joint in `Linkage.joints`."""
    coordinate: int
    """Number of the coordinate in `Joint.coordinates`."""
    values: InputValues


def resolve(linkage: Linkage, drive: Mapping[str, object]) -> dict[str, Driven]:
    """Resolve a drive into its coordinates, by full names "joint.coordinate" in the order given.

    Raises ValueError for names that do not exist or are not unique, and arrays of unequal length or of more than one
    axis. Displacements may be NaN or infinite: their poses are NONFINITE.
    """
    driven = coordinates(linkage, named(drive))
    given = given_values(driven, drive)
    return {name: Driven(*place, values) for (name, place), values in zip(driven.items(), given, strict=True)}


def named(drive: Mapping[str, object]) -> tuple[str, ...]:
    """Return the names in a drive; ValueError where the drive is no mapping."""
    return tuple(by_name(drive, "driven displacements", "{'A': angles}"))


def coordinates(linkage: Linkage, keys: Sequence[str]) -> dict[str, JointCoordinate]:
    """Resolve names of coordinates: full name "joint.coordinate" -> (joint, coordinate); ValueError as in `resolve`."""
    if not keys:
        raise ValueError("the drive is empty: name at least one joint, as in {'A': angles}")
    driven: dict[str, JointCoordinate] = {}
    for key in keys:
        joint, index = coordinate(linkage, key)
        name = linkage.joints[joint].full_names[index]
        if name in driven:
            raise ValueError(f"{name!r} is named twice; give each coordinate once")
        driven[name] = joint, index
    return driven


def given_values(names: Collection[str], drive: Mapping[str, object]) -> tuple[InputValues, ...]:
    """Check the arrays of a drive, and return them in its order; ValueError as in `resolve`.

    `names` are the full names of the coordinates in that order, for messages.
    """
    given = tuple(_values(key, values) for key, values in drive.items())
    lengths = [values.shape[0] for values in given]
    if len(set(lengths)) > 1:
        listed = ", ".join(f"{name!r}: {length}" for name, length in zip(names, lengths, strict=True))
        raise ValueError(f"driven arrays must have equal length, one value a pose, got {listed}")
    return given


def with_finite_inputs(
    given: tuple[InputValues, ...],
) -> tuple[tuple[InputValues, ...], Bool[Array | np.ndarray, " poses"] | None]:
    """Replace the inputs of each pose that has NaN or infinity by those of the last finite pose before it.

    Poses at the beginning get the inputs of the first finite pose, or zero if no pose is finite. So the branch is
    followed through the same inputs as without the replaced poses. Returns the displacements, and which poses were
    finite (None if all were).
    """
    on_host = all(isinstance(values, np.ndarray) for values in given)
    # under `jvp` and `grad` alone the numbers are known: to look at them here saves some twenty small programs
    known = given if on_host else lax.stop_gradient(given)
    if (on_host or not traced(known)) and all(np.isfinite(np.asarray(values)).all() for values in known):
        return given, None
    xp = jnp if not on_host and traced(given) else np
    finite = xp.all(xp.isfinite(xp.stack(given)), axis=0)
    if not len(finite):
        return given, None
    numbered = xp.where(finite, xp.arange(len(finite)), -1)
    # `jnp.maximum.accumulate` would be a loop over the poses
    last = lax.cummax(jnp.asarray(numbered)) if xp is jnp else np.maximum.accumulate(numbered)
    source = xp.where(last < 0, xp.argmax(finite), last)
    found = []
    for values in given:
        before = lax.stop_gradient(values)[source] if xp is jnp else values[source]
        found.append(xp.where(finite, values, xp.where(xp.isfinite(before), before, 0.0)))
    return tuple(found), finite


def coordinate(linkage: Linkage, key: str) -> JointCoordinate:
    """Resolve a name "joint" or "joint.coordinate" into (joint, coordinate); ValueError where there is none."""
    names = [joint.name for joint in linkage.joints]
    if not isinstance(key, str):
        raise ValueError(f"a drive names 'joint' or 'joint.coordinate', as in {{{names[0]!r}: angles}}, got {key!r}")
    if key in names:
        joint = linkage.joints[names.index(key)]
        if joint.freedoms != 1:
            choices = [repr(name) for name in joint.full_names]
            said = f"has {joint.freedoms} coordinates: write {' or '.join(choices)}"
            what = said if choices else "has no coordinate to drive"
            raise ValueError(f"joint {key!r} ({joint.kind}) {what}")
        return names.index(key), 0
    name, _, own = key.rpartition(".")
    if name in names:
        joint = linkage.joints[names.index(name)]
        if own not in joint.coordinates:
            known = ", ".join(joint.coordinates) or "none"
            raise ValueError(f"joint {name!r} ({joint.kind}) has no coordinate {own!r}; it has: {known}")
        return names.index(name), joint.coordinates.index(own)
    if len(pair := _pair(linkage, name or key)) > 1:
        raise ValueError(f"{key!r}: there are several joints between these parts, name one of {', '.join(pair)}")
    raise ValueError(f"there is no joint {key!r}{nearest(name if '.' in key and name else key, names)}")


def _pair(linkage: Linkage, name: str) -> list[str]:
    """List the names of parallel joints, such as 'p-q:a' and 'p-q:e' for the pair of parts "p-q"."""
    return [repr(joint.name) for joint in linkage.joints if joint.name.rpartition(":")[0] == name]


def _values(key: str, values: Any) -> InputValues:
    """Check the displacements of one coordinate and convert them to floats; `key` is its name, for messages."""
    if type(values) is not np.ndarray or values.dtype != dtypes.canonicalize_dtype(float):
        values = numbers(values, f"drive {key!r}: the displacements", "real numbers")
    if values.ndim != 1:
        raise ValueError(
            f"drive {key!r}: the displacements must be an array of one axis, one value a pose, got shape "
            f"{tuple(values.shape)}" + ("; write [value] for a single pose" if values.ndim == 0 else "")
        )
    return values
