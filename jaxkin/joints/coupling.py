"""Couplings: relations between the coordinates of joints, such as those of gears, racks and belts.

A coupling demands that the sum over its coordinates `q_i` of polynomials without a constant term equals an offset,

    sum_i (c_i1 q_i + c_i2 q_i^2 + ...) = d,

with `q_i` measured from the assembled pose, so that the offset is zero where the assembled pose obeys the coupling.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import comb
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin._arguments import by_name, one_number, text
from jaxkin._names import nearest
from jaxkin._pytree import register_leaves
from jaxkin._traced import traced
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.joints.joint import Joint

Number = float | int | Array | np.ndarray


@dataclass(frozen=True, eq=False)
class Coupling:
    """A relation between coordinates of joints. A pytree: coefficients and offset are leaves."""

    name: str
    coordinates: tuple[str, ...]
    """Names of the coordinates, "joint" (of one coordinate) or "joint.coordinate"."""
    coefficients: Float[Array | np.ndarray, "*batch coordinates powers"]
    """Factor of each coordinate to the powers 1, 2, ...: radians, and lengths in the unit of the mechanism."""
    offset: Float[Array | np.ndarray, "*batch"]
    """What the sum is equal to; zero where the assembled pose obeys the coupling."""
    angles: bool | None = None
    """Whether all coordinates must be angles, as those of gears; False if one of each kind is expected (a rack), None
    if any will do."""

    def __str__(self) -> str:
        """Write the equation: "2 A.phi - B.phi = 0"."""
        if traced(self.coefficients, self.offset):
            return " ~ ".join(self.coordinates)
        rows = zip(self.coordinates, np.asarray(self.coefficients), strict=True)
        terms = [
            (float(factor), name if power == 1 else f"{name}^{power}")
            for name, factors in rows
            for power, factor in enumerate(factors, start=1)
            if factor
        ]
        said = "".join(
            f" {'-' if factor < 0 else '+'} {'' if abs(factor) == 1 else f'{abs(factor):g} '}{name}"
            for factor, name in terms
        )
        said = said.removeprefix(" + ") if said.startswith(" + ") else f"-{said.removeprefix(' - ')}"
        return f"{said} = {float(self.offset) + 0.0:g}"  # 0.0 makes 0 of -0


register_leaves(Coupling, leaves=("coefficients", "offset"), static=("name", "coordinates", "angles"))


def gear(a: str, b: str, ratio: Number, *, name: str | None = None) -> Coupling:
    """Couple two turns by toothed wheels, such that `b` turns by `ratio` times the angle of `a`.

    `a` and `b` are the joints about which the wheels turn on one carrier, each counted about its own axis. For wheels
    with `n_a` and `n_b` teeth on parallel axes of one sense the ratio is `-n_a / n_b` if both have outer teeth, and
    `n_a / n_b` if one of them is a ring with inner teeth; for bevel wheels the senses of both axes decide its sign.
    """
    return _linear(name or f"gear {a} {b}", (a, b), (ratio, -1.0), "ratio", True)


def belt(a: str, b: str, radius_a: Number, radius_b: Number, *, name: str | None = None) -> Coupling:
    """Couple two turns by an open belt or a chain over pulleys of these radii, on parallel axes of one sense."""
    _check_numbers({"radius_a": radius_a, "radius_b": radius_b})
    return _linear(name or f"belt {a} {b}", (a, b), (radius_a, -1.0 * radius_b), "radius", True)


def rack(pinion: str, rack: str, radius: Number, *, name: str | None = None) -> Coupling:
    """Couple a turn and a slide, such that `rack` slides by `radius` times the angle of `pinion`, in radians.

    `radius` is that of the pitch circle in the unit of the mechanism, negative where the rack moves against its axis.
    """
    return _linear(name or f"rack {pinion} {rack}", (pinion, rack), (radius, -1.0), "radius", False)


def differential(a: str, b: str, carrier: str, *, name: str | None = None) -> Coupling:
    """Couple the two output turns of a bevel differential with that of its carrier: `a + b = 2 carrier`."""
    return _linear(name or f"differential {a} {b} {carrier}", (a, b, carrier), (1.0, 1.0, -2.0), "ratio", True)


def relation(factors: Mapping[str, Number], offset: Number = 0.0, *, name: str | None = None) -> Coupling:
    """Couple coordinates linearly: the sum of `factors[name]` times the displacement of `name` equals the offset.

    As `jk.relation({"A.phi": 2, "B.phi": -1})`. Displacements are measured from the assembled pose, in radians and in
    the unit of the mechanism. Where the offset is not zero the assembled pose does not obey the relation, and is
    brought to it as the loops of an open mechanism are. Raises ValueError for fewer than two names, and for factors
    that are zero or no finite numbers.
    """
    given = by_name(factors, "the factors of a relation", "{'A.phi': 2.0, 'B.phi': -1.0}")
    names = _two(*given)
    return _linear(name or f"relation {' '.join(names)}", names, tuple(given.values()), "factor", None, offset)


def polynomial(
    follower: str, leader: str, coefficients: Sequence[Number] | Array | np.ndarray, *, name: str | None = None
) -> Coupling:
    """Couple a coordinate to a polynomial of another: `follower = c_0 + c_1 leader + c_2 leader^2 + ...`.

    Both are measured from the assembled pose, as `coefficients` are for radians and the unit of the mechanism. Raises
    ValueError where there are fewer than two coefficients, or where all but the first are zero.
    """
    xp = jnp if traced(coefficients) else np
    try:
        values = xp.asarray(coefficients, float)
    except (TypeError, ValueError):
        values = np.zeros(0)
    if values.ndim != 1 or len(values) < 2 or (xp is np and not (np.isfinite(values).all() and values[1:].any())):
        raise ValueError(
            f"the polynomial of {follower!r} needs the coefficients c_0, c_1, ... of {leader!r}, finite and not all of "
            f"the powers zero, got {coefficients!r}; write [0.0, 1.0] for equal displacements"
        )
    rows = xp.stack([values[1:], xp.asarray([-1.0] + [0.0] * (len(values) - 2))])
    return Coupling(name or f"polynomial {leader} {follower}", _two(leader, follower), rows, xp.asarray(-values[0]))


COUPLINGS: dict[str, Callable[..., Coupling]] = {
    function.__name__: function for function in (gear, belt, rack, differential, relation, polynomial)
}
"""Kind of a coupling -> the function that makes it. Studies are read by this table: arguments of the function, by their
names and annotations, are keys of the coupling in the file."""


def _linear(
    name: str,
    coordinates: tuple[str, ...],
    factors: tuple[Number, ...],
    what: str,
    angles: bool | None,
    offset: Number = 0.0,
) -> Coupling:
    """Make the coupling sum f_i q_i = `offset` of coordinates q_i and `factors` f_i.

    `what` names the factors in messages; `angles` is that of `Coupling`. Raises ValueError for fewer than two
    coordinates, and for factors that are zero or no finite numbers.
    """
    _two(*coordinates)
    _check_numbers({f"the {what} of {each!r}": factor for each, factor in zip(coordinates, factors, strict=True)})
    _check_numbers({"the offset": offset}, zero=True)
    xp = jnp if traced(factors, offset) else np
    coefficients = xp.stack([xp.asarray(each, float) for each in factors])[:, None]
    return Coupling(name, coordinates, coefficients, xp.asarray(offset, float), angles)


def _two(*coordinates: str) -> tuple[str, ...]:
    """Check that a coupling ties at least two coordinates, each named once."""
    for each in coordinates:
        text(each, "a coordinate of a coupling")
    if len(set(coordinates)) < max(len(coordinates), 2):
        raise ValueError(f"a coupling ties at least two different coordinates, got {', '.join(map(repr, coordinates))}")
    return coordinates


def _check_numbers(given: Mapping[str, Any], zero: bool = False) -> None:
    """Raise ValueError for what is no finite number, and for zeros unless `zero`; traced numbers are not looked at."""
    for what, value in given.items():
        if traced(value):
            continue
        if one_number(value, what) == 0 and not zero:
            raise ValueError(f"{what} must not be zero: nothing would be coupled then")


def check_couplings(couplings: Sequence[Coupling], joints: Sequence[Joint]) -> tuple[Coupling, ...]:
    """Check couplings against the joints, and give their coordinates the full names "joint.coordinate".

    Raises ValueError for names that repeat or do not exist, the angles of a ball, and gears and racks on coordinates
    of the wrong kind.
    """
    by_joint = {joint.name: joint for joint in joints}
    found: list[Coupling] = []
    for coupling in couplings:
        if not isinstance(coupling, Coupling):
            raise ValueError(f"couplings are made by jk.gear, jk.rack, jk.belt, ..., got {coupling!r}")
        if coupling.name in [other.name for other in found]:
            raise ValueError(f"two couplings are named {coupling.name!r}; give one of them another name=")
        names = tuple(_full_name(coupling, each, by_joint) for each in coupling.coordinates)
        if len(set(names)) < len(names):
            raise ValueError(f"coupling {coupling.name!r} names a coordinate twice: {', '.join(map(repr, names))}")
        lengths = [is_length(name.rpartition(".")[2]) for name in names]
        if coupling.angles and any(lengths):
            slide = names[lengths.index(True)]
            raise ValueError(f"{coupling.name!r} couples turns, and {slide!r} is a length; jk.rack couples a slide")
        if coupling.angles is False and lengths != [False, True]:
            kinds = ["a length" if is_length else "an angle" for is_length in lengths]
            raise ValueError(
                f"{coupling.name!r} couples a turn with a slide, in this order; {names[0]!r} is {kinds[0]} and "
                f"{names[1]!r} {kinds[1]}"
            )
        found.append(replace(coupling, coordinates=names))
    return tuple(found)


def _full_name(coupling: Coupling, key: str, by_joint: Mapping[str, Joint]) -> str:
    """Return "joint.coordinate" of a name in a coupling; ValueError where there is none, or where it is of a ball."""
    name, _, wanted = (key, "", "") if key in by_joint else str(key).rpartition(".")
    if name not in by_joint:
        raise ValueError(f"coupling {coupling.name!r}: there is no joint {key!r}{nearest(str(key), by_joint)}")
    joint = by_joint[name]
    if any(MOVEMENTS[name].repeats for name in joint.movements):
        raise ValueError(
            f"coupling {coupling.name!r}: joint {name!r} ({joint.kind}) bends without an axis of its own; couple a "
            f"joint that turns about one axis, such as a bearing of its shafts"
        )
    alone = [c for c, group in zip(joint.coordinates, _groups(joint), strict=True) if len(group) == 1]
    if wanted and wanted in joint.coordinates and wanted not in alone:
        raise ValueError(
            f"coupling {coupling.name!r}: {name}.{wanted} is an angle of a ball, which has no axis of its own; couple "
            f"a joint that turns about one axis"
        )
    if not alone:
        raise ValueError(f"coupling {coupling.name!r}: joint {name!r} ({joint.kind}) has no coordinate to couple")
    if not wanted and len(alone) == 1 and joint.freedoms == 1:
        return f"{name}.{alone[0]}"
    if wanted not in alone:
        raise ValueError(
            f"coupling {coupling.name!r}: write one of {', '.join(repr(f'{name}.{c}') for c in alone)}, got {key!r}"
        )
    return f"{name}.{wanted}"


def _groups(joint: Joint) -> list[tuple[int, ...]]:
    """List for each coordinate of a joint the coordinates that are one turn with it."""
    return [group for group in joint.driven_together for _ in group]


def shifted_coupling(coupling: Coupling, q: Float[np.ndarray, " coordinates"]) -> Coupling:
    """Count the coordinates of a coupling from the displacements `q`, where the new assembled pose is.

    The polynomials are expanded about `q`: with `c_k (q + x)^k = sum_j c_k binom(k, j) q^(k-j) x^j` their constant
    terms go to the offset.
    """
    given = np.asarray(coupling.coefficients, float)
    found, offset = np.zeros_like(given), float(coupling.offset)
    for row, (factors, at) in enumerate(zip(given, q, strict=True)):
        for k, factor in enumerate(factors, start=1):
            offset -= factor * at**k
            for j in range(1, k + 1):
                found[row, j - 1] += factor * comb(k, j) * at ** (k - j)
    return replace(coupling, coefficients=found, offset=np.asarray(offset))
