"""Make constraints between two parts each of the joints and mates of the exports of CAD systems."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from unicodedata import combining, normalize

import numpy as np

from jaxkin.assembly.exported import Constraint
from jaxkin.geometry.pose import Transform
from jaxkin.io.export_content import Export, ExportedJoint, ExportedMate
from jaxkin.io.export_joints import joint_of_kind
from jaxkin.io.names import cleaned
from jaxkin.joints.combine import SUBGROUP_JOINTS, Chain
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.mates import MateFeature, mate

Paths = Mapping[tuple[str, ...], str]
"""Paths of instances -> names of their first solids."""

LOCKS = ("weld", "lock", "fixed", "rigid")
"""Mates that leave no freedom."""

LIMITS = ("limit", "grenz", "\u9650")
"""What the names of mates have, in the languages of the system and without accents, that allow a range of distances or
angles, which the export does not say: limit, limite, l\u00edmite, Grenze, \u9650\u5236."""
RANGES = ("distance", "angle")
"""Mates that may be such a range."""

UNKNOWN = "UnknownConstraint"
"""Mates that the exporter has no name for: gears, locks, slots. Their own names may tell."""
NO_LOCKS = ("gear", "cam", "path", "slot", "width", "screw", "rack", "symmetric", "linear", "universal", "hinge",
            "belt")  # fmt: skip
"""How the names begin of mates that the exporter has no name for, and that are no locks."""
NO_GEOMETRY = ("", "unknown")
"""What exporters write as the geometry of a side that has none: it is the whole part."""

PARALLEL_MATES = 1e-5
"""Radians within which the features of a mate are parallel: exports round directions to nine digits, and systems solve
mates to about 1e-6."""


class ConstrainedParts:
    """The parts that joints and mates are on."""

    def __init__(self, export: Export, first: Paths, world: str | None) -> None:
        """`world` is a part that stands in the world; None where nothing does."""
        self.first, self.world = first, world
        self.body = {part.path: part.body for part in export.parts}
        self.fixed_in = {part.path: part.fixed_in for part in export.parts}

    def part(self, path: tuple[str, ...]) -> str | None:
        """Find the part at a path: of the root the world, of another assembly one that is fixed in it, or the first one
        where it is rigid; None where there is none."""
        if path in self.first:
            return self.first[path]
        if not path:
            return self.world
        below = [each for each in self.first if each[: len(path)] == path]
        bodies = {self.body[each] for each in below}
        if len(bodies) == 1 and None not in bodies:
            return self.first[below[0]]
        fixed = (each for each in below if (at := self.fixed_in[each]) is not None and path[: len(at)] == at)
        return next((self.first[each] for each in fixed), None)

    def parts(self, one: tuple[str, ...], other: tuple[str, ...]) -> tuple[str, str] | None:
        """Find the two parts at two paths; None where there are no two."""
        first, second = self.part(one), self.part(other)
        return None if first is None or second is None or first == second else (first, second)

    def is_ground(self, paths: tuple[tuple[str, ...], tuple[str, ...]]) -> bool:
        """Check whether one of two paths is that of the root, and the other one that of the part that stands in it."""
        return () in paths and self.world is not None and {self.part(path) for path in paths} == {self.world}

    def why_not(self, paths: tuple[tuple[str, ...], tuple[str, ...]]) -> str:
        """Say why two paths are not those of two parts."""
        found = [name for path in paths if (name := self.part(path)) is not None]
        if () in paths and self.world is None and len(found) == 1:
            return f"it holds {found[0]!r} in the assembly itself, in which nothing is fixed"
        return "it is not between two parts"


def joints_between(
    joints: Iterable[ExportedJoint], where: ConstrainedParts, metres: float, notes: list[str]
) -> list[Constraint]:
    """Find the joints between parts; what is no joint that is known is added to the notes."""
    result = []
    for each in joints:
        text = f"{each.kind} {each.name!r}"
        paths = each.sides[0].path, each.sides[1].path
        if where.is_ground(paths):
            continue
        parts = where.parts(*paths)
        base, follower = (in_unit(side.frame, metres) for side in each.sides)
        known = joint_of_kind(each.kind, base, follower)
        if parts is None or known is None:
            why = where.why_not(paths) if parts is None else "its kind is not known, or not between such frames"
            notes.append(f"{text}: {why}; left out")
            continue
        ends = (parts[1], parts[0]) if known.swapped else parts
        result.append(Constraint(cleaned(each.name), ends, text, known.chain, known.kind, known.offset, known.tilt))
    return result


def mates_between(
    mates: Iterable[ExportedMate], where: ConstrainedParts, metres: float, size: float, notes: list[str]
) -> list[Constraint]:
    """Find the mates between parts of an assembly of a size; those that are not understood are added to the notes."""
    return [found for each in mates for found in _mate(each, where, metres, PARALLEL_MATES * size, notes)]


def _mate(
    each: ExportedMate, where: ConstrainedParts, metres: float, length: float, notes: list[str]
) -> list[Constraint]:
    """Find what a mate between two parts leaves free; nothing, and a note, where it holds nothing or is not understood;
    nothing for one that holds what stands in the world anyway.

    Features that differ by less than `length`, in the unit of the assembly, count as coincident.
    """
    text = f"{each.kind} {each.name!r}"
    paths = each.sides[0].path, each.sides[1].path
    if where.is_ground(paths):
        return []
    if (parts := where.parts(*paths)) is None:
        notes.append(f"{text}: {where.why_not(paths)}; left out")
        return []
    between = f"{text} between {parts[0]!r} and {parts[1]!r}"
    if each.kind.lower() in RANGES and any(word in _plain(each.name) for word in LIMITS):
        notes.append(f"{between} is a limit by its name: it holds nothing in between")
        return []
    if why := _unnamed_lock(each):
        notes.append(f"{between} is taken for a lock, {why}")
    if why or each.kind.lower() in LOCKS:
        held = Chain((SUBGROUP_JOINTS[0, 0][1],), np.eye(4)[None])
        return [Constraint(cleaned(each.name), parts, text, held, JointKind.FIXED)]
    features = [MateFeature.of(side.kind, side.point / metres, side.axis) for side in each.sides]
    found = mate(each.kind, features[0], features[1], PARALLEL_MATES, length) if features[0] and features[1] else ()
    if not found:
        named = [side.kind or "nameless feature" for side in each.sides]
        of = " and ".join(f"{'an' if kind[0].lower() in 'aeiou' else 'a'} {kind}" for kind in named)
        notes.append(
            f"{text} of {of}, between {parts[0]!r} and {parts[1]!r}, is not understood; left out; a joint by hand "
            "between the two (joints=) stands in place of all that the file says of them"
        )
        return []
    if each.kind.lower() == "angle" and found[0].kind is JointKind.SCHOENFLIES:
        notes.append(
            f"{between} stands where its directions are parallel: they stay so, which takes two freedoms and not one"
        )
    name, back = cleaned(each.name), (parts[1], parts[0])
    return [
        Constraint(name, back if one.swapped else parts, text, one.chain, one.kind, one.offset, one.tilt)
        for one in found
    ]


def _unnamed_lock(each: ExportedMate) -> str:
    """Say why a mate that the exporter has no name for is taken for a lock; empty where it is not.

    The names of mates are in the language of the system. A lock is known in any: it alone is of two whole parts.
    """
    if each.kind != UNKNOWN:
        return ""
    name = each.name.lower()
    if name.startswith(LOCKS):
        return "by its name"
    whole = all(side.axis is None and side.kind.lower() in NO_GEOMETRY for side in each.sides)
    return "since it is of two parts as a whole" if whole and not name.startswith(NO_LOCKS) else ""


def _plain(name: str) -> str:
    """Write a name in small letters without accents."""
    return "".join(letter for letter in normalize("NFKD", name.lower()) if not combining(letter))


def in_unit(transform: Transform, metres: float) -> Transform:
    """Convert a transform in metres to another unit."""
    result = transform.copy()
    result[:3, 3] /= metres
    return result
