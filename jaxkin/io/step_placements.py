"""The placements of the parts of a STEP file, from its text: the reader hands them on in single precision only."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.spatial import KDTree

from jaxkin.geometry.pose import Transform, inverse
from jaxkin.io.step_unit import units_of_shapes

SINGLE = 2.0**-24
"""Rounding of single precision, relative."""

_ROUNDINGS = 2
"""Roundings of single precision by which the reader's numbers may be off: a length is one more for its unit."""

_NONE = 1e-12
"""Radians, and metres, that are none: what the text leaves of directions at right angles."""

_MAX_NEAR = 100
"""Placements that are looked at; real files have a few so near each other, each with its inverse, in two units."""

STATEMENT = re.compile(r"\s*#(\d+)\s*=\s*(\w+)\s*\((.*)\)\s*", re.S)
"""A statement of one kind: its number, its kind, and what is between the parentheses."""
_REFERENCE = re.compile(r"#(\d+)|\$")

_OPERATOR = "CARTESIAN_TRANSFORMATION_OPERATOR_3D"
_OPERANDS = 5
"""What an operator says of its placement: two axes, the origin, the scale and the third axis."""
_DESCRIBED = ("''", "$")
"""The name and the description that it has as a transformation."""
_BY_OPERATOR = re.compile(r"\bREPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION\s*\(\s*#(\d+)")
_SHAPE = re.compile(r"\s*#(\d+)\s*=\s*\w*SHAPE_REPRESENTATION\s*\(")


class Placement(NamedTuple):
    """Where an assembly places what is in it."""

    pose: Transform
    rounding: float
    """By which its numbers may be off beside those of the file, relative."""


class FilePlacements:
    """The placements that the text of a file has, in metres, among which those of the reader are found again."""

    def __init__(self, text: str) -> None:
        poses = np.array([*_placements(text.split(";"), units_of_shapes(text))]).reshape(-1, 4, 4)
        self.poses = np.unique(poses, axis=0)
        self.tree = KDTree(self.poses[:, :3].reshape(-1, 12)) if len(self.poses) else None

    def rounded_to(self, matrix: Float[np.ndarray, "4 4"]) -> Transform | None:
        """Find the placement that is `matrix` in single precision; None where none is, or several that differ."""
        if self.tree is None:
            return None
        reach = _ROUNDINGS * SINGLE * np.abs(matrix) + _NONE
        numbers = self.tree.query_ball_point(matrix[:3].reshape(12), float(np.linalg.norm(reach)))
        near = self.poses[numbers[:_MAX_NEAR]]
        found = near[(np.abs(near - matrix) <= reach).all(axis=(1, 2))]
        if not len(found) or (np.abs(found - found[0]) > _NONE).any():
            return None
        return found[0]


def whole_operators(text: str) -> str:
    """Write out the placements that many programs write by the names of their axes alone: readers leave a part in the
    place where it was drawn, without a word, whose placement has not the name and the description of its kind, too."""
    if _OPERATOR not in text:
        return text
    return ";".join(_whole_operator(each) if _OPERATOR in each else each for each in text.split(";"))


def _whole_operator(statement: str) -> str:
    found = STATEMENT.fullmatch(statement)
    if found is None or found[2] != _OPERATOR:
        return statement
    name, *words = (word.strip() for word in found[3].split(","))
    if not _OPERANDS <= len(words) < _OPERANDS + len(_DESCRIBED):
        return statement
    return f"\n#{found[1]}={_OPERATOR}({','.join([name, *_DESCRIBED, *words[-_OPERANDS:]])})"


def check_not_mirrored(text: str, name: str) -> None:
    """Raise ValueError where the text of a file, called `name`, places a part by a mirror: readers turn it instead."""
    if _OPERATOR not in text:
        return
    statements = text.split(";")
    bodies = {
        found[1]: [word.strip().lstrip("#") for word in found[3].split(",")]
        for statement in statements
        if _OPERATOR in statement and (found := STATEMENT.fullmatch(statement)) and found[2] == _OPERATOR
    }
    # x, y, origin, scale, z: an axis that is left out makes no mirror
    axes = {number: (words[-5], words[-4], words[-1]) for number, words in bodies.items() if len(words) >= 5}
    triples = dict(_triples(statements, {each for three in axes.values() for each in three}))
    mirrors = {
        number
        for number, three in axes.items()
        if all(each in triples for each in three) and np.linalg.det([triples[each] for each in three]) < 0
    }
    if mirrors and (used := mirrors & _placing(statements)):
        raise ValueError(
            f"{name} mirrors a part where it places it (#{min(used, key=int)}, {_OPERATOR}): export the mirrored part "
            "as one of its own"
        )


def _placing(statements: Sequence[str]) -> set[str]:
    """Find the numbers of what shapes are placed by; views and annotations are mapped, too."""
    related = {found[1] for statement in statements if (found := _BY_OPERATOR.search(statement))}
    named = _named(statements, ("REPRESENTATION_MAP", "MAPPED_ITEM"))
    shapes = {found[1] for statement in statements if (found := _SHAPE.match(statement))}
    maps = {number for number, (kind, rest) in named.items() if kind == "REPRESENTATION_MAP" and rest[1] in shapes}
    return related | {rest[1] for kind, rest in named.values() if kind == "MAPPED_ITEM" and rest[0] in maps}


def _placements(statements: Sequence[str], units: Iterable[float]) -> Iterator[Transform]:
    """Compute each placement of one frame in another, in each unit of the file, and its inverse: which of both is meant
    differs by translator."""
    pairs = _pairs(statements)
    frames = _frames(statements, {each for pair in pairs for each in pair})
    for one, other in dict.fromkeys(pairs):
        if one in frames and other in frames:
            pose = frames[other] @ inverse(frames[one])
            for each in (pose, inverse(pose)):
                for metres in units:
                    scaled = each.copy()
                    scaled[:3, 3] *= metres
                    yield scaled


def _pairs(statements: Sequence[str]) -> list[tuple[str, str]]:
    """List the numbers of the frames of each placement: that of what is placed, and where this one comes to be."""
    kinds = ("ITEM_DEFINED_TRANSFORMATION", "REPRESENTATION_MAP", "MAPPED_ITEM")
    named = _named(statements, kinds)
    pairs, origins = [], {}
    for number, (kind, (one, other, *_)) in named.items():
        if kind == "ITEM_DEFINED_TRANSFORMATION":
            pairs.append((one, other))
        elif kind == "REPRESENTATION_MAP":
            origins[number] = one
    mapped = [rest for kind, rest in named.values() if kind == "MAPPED_ITEM"]
    return pairs + [(origins[source], target) for source, target, *_ in mapped if source in origins]


def _frames(statements: Sequence[str], wanted: set[str]) -> dict[str, Transform]:
    """Compute the frames of some numbers, in their own unit, as far as they are told whole."""
    named = _named(statements, ("AXIS2_PLACEMENT_3D",), wanted)
    axes = {number: rest for number, (_, rest) in named.items() if len(rest) == 3}
    triples = dict(_triples(statements, {each for rest in axes.values() for each in rest}))
    frames = {}
    for number, (point, along, across) in axes.items():
        z, x = triples.get(along), triples.get(across)
        if along == across == "":
            z, x = np.eye(3)[[2, 0]]
        if point in triples and z is not None and x is not None:
            with np.errstate(all="ignore"):
                z = z / np.linalg.norm(z)
                x = x - (x @ z) * z
                x = x / np.linalg.norm(x)
            pose = np.eye(4)
            pose[:3] = np.stack([x, np.cross(z, x), z, triples[point]], axis=1)
            if np.isfinite(pose).all():
                frames[number] = pose
    return frames


def _named(
    statements: Sequence[str], kinds: Sequence[str], wanted: set[str] | None = None
) -> dict[str, tuple[str, tuple[str, ...]]]:
    """Map the numbers of statements of some kinds, all or the `wanted` ones, to their kind and the two or more numbers
    that they name, "" where one is left out."""
    found = {}
    for statement in statements:
        if any(kind in statement for kind in kinds) and (match := STATEMENT.fullmatch(statement)):
            number, kind, rest = match.groups()
            names = tuple(_REFERENCE.findall(rest.rpartition("'")[2]))
            if kind in kinds and len(names) > 1 and (wanted is None or number in wanted):
                found[number] = kind, names
    return found


def _triples(statements: Sequence[str], wanted: set[str]) -> Iterator[tuple[str, Float[np.ndarray, " 3"]]]:
    """Yield points and directions in space by their numbers."""
    for statement in statements:
        number = statement.partition("=")[0].strip(" \r\n\t#")
        if number in wanted:
            try:
                triple = np.array(statement.rpartition("(")[2].strip(" \r\n\t)").split(","), float)
            except ValueError:  # points without end
                continue
            if triple.shape == (3,):
                yield number, triple
