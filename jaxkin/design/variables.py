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
from jaxkin.design.measures import STATIC, lengths_now
from jaxkin.dimensions.frames import find_profile, locate
from jaxkin.dimensions.lengths import find_length, range_of
from jaxkin.geometry.characteristic_length import centroid_and_length

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

ROUNDING = 1e-9
"""Share of the numbers that a start was made of by which it may be outside of its bounds, and is moved onto them."""

DesignVector = Float[np.ndarray | Array, " variables"]


@dataclass(frozen=True)
class Free:
    """Numbers to be chosen: where they start and between which bounds. Arrays of one shape, or numbers for all."""

    start: Any
    lower: Any
    upper: Any


class Design(NamedTuple):
    """A design: the values of all variables by name."""

    lengths: dict[Any, Any]
    points: dict[Any, Any]
    inputs: dict[str, Any]
    extras: dict[str, Any]


@dataclass(frozen=True)
class _Entry:
    """The name of a variable; nothing here is a number."""

    group: str
    key: Any
    shape: tuple[int, ...]
    ties: tuple[tuple[Any, Callable | None], ...] = ()
    """Further keys of the group that take this value, or a function of it."""


class _Bounded(NamedTuple):
    """A variable with its numbers, all of its shape."""

    entry: _Entry
    start: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


@jax.tree_util.register_dataclass
@dataclass(frozen=True, eq=False)
class Variables:
    """All variables, one after another. A pytree of bounds and fixed inputs."""

    entries: tuple[_Entry, ...] = field(metadata=STATIC)
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
        """A name for each number of the vector."""
        names = []
        for entry in self.entries:
            label = entry.key if isinstance(entry.key, str) else "(" + ", ".join(map(str, entry.key)) + ")"
            names += [label + "".join(f"[{i}]" for i in index) for index in np.ndindex(entry.shape)]
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


def _shape(entry: _Entry) -> jax.ShapeDtypeStruct:
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
    bounded: list[_Bounded] = []
    fixed: dict[Any, Any] = {}
    _, size = centroid_and_length(np.concatenate([joint.frames_1[:, :3, 3] for joint in mechanism.all_joints]), np)
    for key, bounds in by_name(lengths, "lengths", "{('coupler', 'B', 'C'): (3.0, 5.0)}").items():
        length = find_length(mechanism.linkage, key)
        (now,) = lengths_now(mechanism, [key])
        found = _entry(
            "lengths", key, _free(f"length {key!r}", bounds, now), size=1.0 if length.quantity == "angle" else size
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
        bounded.append(_entry("points", key, _free(f"point {key!r}", bounds, now), size=size))
    for key, given in by_name(drive, "driven displacements", "{'A': angles}").items():
        if isinstance(given, Free):
            bounded.append(_entry("inputs", key, given, f"drive {key!r}"))
        else:
            fixed[key] = given if callable(given) else _as_array(given)
    for key, given in by_name(extras, "extras", "{'first': jk.design.Free(0.0, -1.0, 1.0)}").items():
        if not isinstance(given, Free):
            raise ValueError(f"extra {key!r}: write jk.design.Free(start, lower, upper), got {given!r}")
        bounded.append(_entry("extras", key, given, f"extra {key!r}"))
    if not bounded:
        raise ValueError("nothing to choose: give lengths, points, extras, or a drive with jk.design.Free")
    entries, *numbers = zip(*bounded, strict=True)
    start, lower, upper = (np.concatenate([np.ravel(each) for each in group]) for group in numbers)
    entries = _tied(mechanism, entries, ties)
    _check_ends(mechanism, entries)
    return Variables(entries, start, lower, upper, tuple(fixed), tuple(fixed.values()))


def _check_ends(mechanism: Mechanism, entries: Sequence[_Entry]) -> None:
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


def _free(what: str, bounds: Any, now: Any) -> Free:
    """Return bounds as numbers to be chosen: a pair (lower, upper) starts at `now`, a `Free` has a start of its own.

    Raises ValueError for what is neither; `what` begins the message.
    """
    if isinstance(bounds, Free):
        return bounds
    try:
        lower, upper = bounds
    except (TypeError, ValueError):
        raise ValueError(f"{what}: give its bounds as (lower, upper), got {bounds!r}") from None
    return Free(now, lower, upper)


def _entry(group: str, key: Any, free: Free, what: str = "", size: float = 0.0) -> _Bounded:
    """Make a variable of a group ("lengths", "points", "inputs", "extras") with its start and its bounds.

    A start outside of its bounds by rounding is moved onto them: of numbers as large as the bounds, and of those of the
    mechanism, of this `size` in the same unit, that the start was measured with. Raises ValueError for numbers of
    different shapes, bounds in the wrong order, a start beyond them, and NaN and infinity; `what` begins the message.
    """
    what = what or f"{group[:-1]} {key!r}"
    try:
        start, lower, upper = (exact_numbers(value, what) for value in (free.start, free.lower, free.upper))
        start, lower, upper = (np.array(array) for array in np.broadcast_arrays(start, lower, upper))
    except (TypeError, ValueError):
        raise ValueError(f"{what}: start and bounds must be numbers of one shape, got {free!r}") from None
    if not all(np.all(np.isfinite(array)) for array in (start, lower, upper)):
        raise ValueError(f"{what}: start and bounds must be finite numbers, got {_said(start, lower, upper)}")
    if np.any(lower > upper):
        raise ValueError(f"{what}: the lower bound is above the upper one, {_said(start, lower, upper)}")
    slack = ROUNDING * (size + np.abs(upper) + np.abs(lower))
    if np.any(start < lower - slack) or np.any(start > upper + slack):
        raise ValueError(
            f"{what}: the bounds exclude the start, {_said(start, lower, upper)}; widen them, or give another start as "
            "jk.design.Free(start, lower, upper)"
        )
    return _Bounded(_Entry(group, key, start.shape), np.clip(start, lower, upper), lower, upper)


def _said(start, lower, upper) -> str:
    return f"start {np.round(start, 6).tolist()}, bounds {np.round(lower, 6).tolist()} to {np.round(upper, 6).tolist()}"


def _tied(mechanism: Mechanism, entries: Sequence[_Entry], ties: Mapping[Any, Any]) -> tuple[_Entry, ...]:
    """Add to variables the further keys that take their values.

    `ties` maps such a key to the key of a variable, or to (key of the variable, function of its value). Raises
    ValueError for a source that is no variable, and for a key that is a variable itself or that the mechanism lacks.
    """
    followers: dict[Any, list[tuple[Any, Callable | None]]] = {}
    known = [entry.key for entry in entries]
    for key, source in by_name(ties, "ties", "{('rocker', 'C', 'D'): ('coupler', 'B', 'C')}").items():
        change = None
        if isinstance(source, tuple) and len(source) == 2 and callable(source[1]):
            source, change = source
        if source not in known:
            raise ValueError(f"tie of {key!r}: {source!r} is no variable; there are {', '.join(map(repr, known))}")
        if key in known:
            raise ValueError(f"tie of {key!r}: it is a variable of its own; give it in lengths or points, or in ties")
        group = entries[known.index(source)].group
        if group == "lengths":
            find_length(mechanism.linkage, key)
        elif group == "points":
            _point_now(mechanism, key)
        followers.setdefault(source, []).append((key, change))
    return tuple(
        replace(entry, ties=tuple(followers[entry.key])) if entry.key in followers else entry for entry in entries
    )


def spread(variables: Variables, count: int, seed: int) -> Float[np.ndarray, "starts variables"]:
    """Draw designs at random between the bounds, after the given one."""
    random = np.random.default_rng(seed).uniform(size=(max(count - 1, 0), len(variables.start)))
    return np.concatenate([variables.start[None], variables.lower + random * (variables.upper - variables.lower)])
