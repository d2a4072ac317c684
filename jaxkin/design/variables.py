"""What an optimiser may change: lengths, points, inputs and further numbers, between bounds, as one vector."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import jax
import numpy as np
from jax import dtypes
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, exact_numbers
from jaxkin.design.bounds import Bounded, Entry, Free, bounded_entry, free_between
from jaxkin.design.measures import STATIC, lengths_now
from jaxkin.dimensions.frames import find_profile, locate
from jaxkin.dimensions.lengths import find_length, range_of
from jaxkin.geometry.characteristic_length import centroid_and_length

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

GROUPS = {"lengths": "length", "points": "point", "inputs": "drive", "extras": "extra"}
"""What a variable of each group is called."""

DesignVector = Float[np.ndarray | Array, " variables"]


class Design(NamedTuple):
    """A design: the values of all variables by name."""

    lengths: dict[Any, Any]
    points: dict[Any, Any]
    inputs: dict[str, Any]
    extras: dict[str, Any]


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class Variables:
    """All variables, one after another. A pytree of bounds and fixed inputs."""

    entries: tuple[Entry, ...] = field(metadata=STATIC)
    start: DesignVector
    """The vector of the design that was given."""
    lower: DesignVector
    """Lower bounds."""
    upper: DesignVector
    """Upper bounds."""
    fixed_keys: tuple[Any, ...] = field(metadata=STATIC)
    """Keys of the drive that are no variables."""
    fixed_inputs: tuple[Any, ...]
    """For each of these its displacements, or a function of the extras."""

    @property
    def change_geometry(self) -> bool:
        """Whether lengths or points are variables."""
        return any(entry.group in ("lengths", "points") for entry in self.entries)

    @property
    def names(self) -> list[str]:
        """A name for each number of the vector: its key, and what it is where there are several of one name."""
        labels = [
            entry.key if isinstance(entry.key, str) else "(" + ", ".join(map(str, entry.key)) + ")"
            for entry in self.entries
        ]
        names = []
        for entry, label in zip(self.entries, labels, strict=True):
            name = label if labels.count(label) == 1 else f"{GROUPS[entry.group]} {label}"
            names += [name + "".join(f"[{i}]" for i in index) for index in np.ndindex(entry.shape)]
        return names

    def values(self, vector) -> Design:
        """Make the design that a vector stands for."""
        fixed = dict(zip(self.fixed_keys, self.fixed_inputs, strict=True))
        found: dict[str, dict] = {"lengths": {}, "points": {}, "inputs": fixed, "extras": {}}
        first = 0
        for entry in self.entries:
            count = int(np.prod(entry.shape, dtype=int))
            value = vector[first : first + count].reshape(entry.shape)
            first += count
            found[entry.group][entry.key] = value
            for key, change in entry.ties:
                found[entry.group][key] = value if change is None else change(value)
        for key, given in found["inputs"].items():
            if callable(given):
                found["inputs"][key] = given(found["extras"])
        return Design(**found)

    def with_functions(self, traced: Callable[..., Any]) -> Variables:
        """Replace functions of extras, and those of ties, by what `traced` makes of the function, a name, and the
        shapes of its arguments."""
        entries = tuple(
            replace(
                entry,
                ties=tuple(
                    (key, change and traced(change, f"tie of {key!r}", _shape(entry))) for key, change in entry.ties
                ),
            )
            for entry in self.entries
        )
        extras = replace(self, entries=entries, fixed_keys=(), fixed_inputs=())
        shapes = jax.eval_shape(lambda vector: extras.values(vector).extras, self.start)
        fixed = tuple(
            traced(given, f"drive {key!r}", shapes) if callable(given) else given
            for key, given in zip(self.fixed_keys, self.fixed_inputs, strict=True)
        )
        return replace(self, entries=entries, fixed_inputs=fixed)


def _shape(entry: Entry) -> jax.ShapeDtypeStruct:
    return jax.ShapeDtypeStruct(entry.shape, dtypes.canonicalize_dtype(float))


def variables(
    mechanism: Mechanism,
    drive: Mapping[str, Any],
    lengths: Mapping[Any, Any],
    points: Mapping[Any, Any],
    extras: Mapping[str, Any],
    ties: Mapping[Any, Any],
) -> Variables:
    """Make the variables of a design problem; see `optimize`. Raises ValueError for names and bounds that make no
    sense."""
    bounded: list[Bounded] = []
    fixed: dict[Any, Any] = {}
    _, size = centroid_and_length(np.concatenate([joint.frames_1[:, :3, 3] for joint in mechanism.all_joints]), np)
    for key, bounds in by_name(lengths, "lengths", "{('coupler', 'B', 'C'): (3.0, 5.0)}").items():
        length = find_length(mechanism.linkage, key)
        (now,) = lengths_now(mechanism, [key])
        found = bounded_entry(
            "lengths",
            key,
            free_between(f"length {key!r}", bounds, now),
            size=1.0 if length.quantity == "angle" else size,
        )
        low, high = range_of(length)
        if length.quantity == "angle" and (np.any(found.lower < low) or np.any(found.upper > high)):
            given = f"{float(found.lower):.6g} to {float(found.upper):.6g}"
            raise ValueError(f"length {key!r}: an angle is in radians between 0 and pi, got the bounds {given}")
        if np.any(found.lower < low):
            raise ValueError(f"length {key!r}: the lower bound {float(found.lower)} is negative, and a length is not")
        bounded.append(found)
    for key, bounds in by_name(points, "points", "{'A': (lower, upper)}").items():
        now = _point_now(mechanism, key)
        bounded.append(bounded_entry("points", key, free_between(f"point {key!r}", bounds, now), size=size))
    for key, given in by_name(drive, "driven displacements", "{'A': angles}").items():
        if isinstance(given, Free):
            bounded.append(bounded_entry("inputs", key, given, f"drive {key!r}"))
        else:
            fixed[key] = given if callable(given) else _as_array(given)
    for key, given in by_name(extras, "extras", "{'first': jk.design.Free(0.0, -1.0, 1.0)}").items():
        if not isinstance(given, Free):
            raise ValueError(f"extra {key!r}: write jk.design.Free(start, lower, upper), got {given!r}")
        bounded.append(bounded_entry("extras", key, given, f"extra {key!r}"))
    if not bounded:
        raise ValueError("nothing to choose: give lengths, points, extras, or a drive with jk.design.Free")
    entries, *numbers = zip(*bounded, strict=True)
    start, lower, upper = (np.concatenate([np.ravel(each) for each in group]) for group in numbers)
    entries = _tied(mechanism, entries, ties)
    _check_ends(mechanism, entries)
    return Variables(entries, start, lower, upper, tuple(fixed), tuple(fixed.values()))


def _check_ends(mechanism: Mechanism, entries: Sequence[Entry]) -> None:
    """Refuse a length that would not be what was chosen, since a point that is a variable too moves one of its ends."""
    keys = {
        group: [key for each in entries if each.group == group for key in (each.key, *(key for key, _ in each.ties))]
        for group in ("lengths", "points")
    }
    places = [
        (key, locate(mechanism.linkage, key)) for key in keys["points"] if not find_profile(mechanism.linkage, key)
    ]
    for name in keys["lengths"]:
        length = find_length(mechanism.linkage, name)
        ends = [(length.body[i].joint, length.body[i].side) for i in (length.first, length.second) if length.body]
        for key, (column, side) in places:
            if any(column == joint and side in (None, end) for joint, end in ends):
                raise ValueError(
                    f"length {name!r} ends at the joint of the point {key!r}, and both are variables: the point would "
                    "change the length that was chosen; leave out one of them"
                )


def _as_array(given: Any) -> Any:
    """Convert what are numbers to an array; what is none is refused by the sweep of the design given."""
    try:
        return exact_numbers(given, "a drive")
    except ValueError:
        return given


def _point_now(mechanism: Mechanism, key: Any) -> np.ndarray:
    """Look up the point, or the points of the profile, that a key of `with_points` means."""
    if (found := find_profile(mechanism.linkage, key)) is not None:
        curve = mechanism.all_joints[found[0]].curves[found[1]]
        return np.asarray(curve.points if curve is not None else np.zeros((0, 2)), float)
    column, side = locate(mechanism.linkage, key)
    joint = mechanism.all_joints[column]
    return np.asarray((joint.frames_2[-1] if side == "frames_2" else joint.frames_1[0])[:3, 3], float)


def _tied(mechanism: Mechanism, entries: Sequence[Entry], ties: Mapping[Any, Any]) -> tuple[Entry, ...]:
    """Add to variables the further keys that take their values.

    `ties` maps such a key to the key of a variable, or to (key of the variable, function of its value). Raises
    ValueError for a source that is no variable, and for a key that is a variable itself or that the mechanism lacks.
    """
    followers: dict[tuple[str, Any], list[tuple[Any, Callable | None]]] = {}
    known = [(entry.group, entry.key) for entry in entries]
    for key, source in by_name(ties, "ties", "{('rocker', 'C', 'D'): ('coupler', 'B', 'C')}").items():
        change = None
        if isinstance(source, tuple) and len(source) == 2 and callable(source[1]):
            source, change = source
        groups = [group for group, name in known if name == source]
        if not groups:
            said = ", ".join(repr(name) for _, name in known)
            raise ValueError(f"tie of {key!r}: {source!r} is no variable; there are {said}")
        if len(groups) > 1 and isinstance(key, tuple):  # of a part: no drive and no extra
            groups = [group for group in groups if group in ("lengths", "points")]
        if len(groups) > 1:
            said = ", ".join(GROUPS[group] for group in groups)
            raise ValueError(
                f"tie of {key!r}: {source!r} names several variables ({said}); write a drive as a function of an "
                "extra, and give extras other names"
            )
        (group,) = groups
        if (group, key) in known:
            raise ValueError(f"tie of {key!r}: it is a variable of its own; give it in lengths or points, or in ties")
        if group == "lengths":
            find_length(mechanism.linkage, key)
        elif group == "points":
            _point_now(mechanism, key)
        followers.setdefault((group, source), []).append((key, change))
    return tuple(replace(entry, ties=tuple(followers.get((entry.group, entry.key), entry.ties))) for entry in entries)


def spread(variables: Variables, count: int, seed: int) -> Float[np.ndarray, "starts variables"]:
    """Draw designs at random between the bounds, after the given one."""
    random = np.random.default_rng(seed).uniform(size=(max(count - 1, 0), len(variables.start)))
    return np.concatenate([variables.start[None], variables.lower + random * (variables.upper - variables.lower)])
