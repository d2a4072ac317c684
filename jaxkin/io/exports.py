"""Assemblies from the exports of CAD systems: an XML file with joints, and beside it the solids, a file a part."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin.assembly.exported import Constraint, Exported
from jaxkin.geometry.inertial import NONE
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.part import Part, moved, scaled
from jaxkin.geometry.pose import Pose
from jaxkin.geometry.units import METRES
from jaxkin.io.export_joints import FREE, joint_of_kind
from jaxkin.io.names import cleaned, unique
from jaxkin.io.simscape import Export, ExportedJoint, ExportedMate, ExportedPart, read_export
from jaxkin.joints.combine import LOWER_PAIRS, Chain
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.mates import Feature, mate

Reader = Callable[[Path], tuple[tuple[Part, ...], str]]
"""Reads the solids in a file, in the frame of the file, and its unit; "" where the file says none."""

Paths = Mapping[tuple[str, ...], str]
"""Paths of instances -> names of their first solids."""

BOX = 0.02
"""Edge of the box of a part without a solid, over the size of the assembly."""

LISTED = 3
"""Parts or assemblies that a message names."""

LOCKS = ("weld", "lock", "fixed")
"""Mates that leave no freedom."""

LIMIT = "limit"
"""How the names of mates begin that allow a range of distances or angles, which the export does not say."""

UNKNOWN = "UnknownConstraint"
"""Mates that the exporter has no name for: gears, locks, slots. Their own names may tell."""

PARALLEL = 1e-5
"""Radians within which the features of a mate are parallel: exports round directions to nine digits, and systems solve
mates to about 1e-6."""


def read_exported(path: Path, root: Element, read_solids: Reader) -> tuple[tuple[Part, ...], str, Exported]:
    """Read the parts of an export in world coordinates, their unit, and what the CAD system says; `root` is its XML.

    Each instance is a part; an instance of several solids is a rigid group. Lengths are in the unit of the first file
    of a solid; solids in another unit are converted. Warns of parts without a file, and of files that hold no solid or
    are damaged: these parts are small boxes. Raises ValueError where the XML is not understood.
    """
    export = read_export(path, root)
    if not export.parts:
        raise ValueError(f"{path.name}: there are no parts in its InstanceTree; export the assembly again")
    files, missing = _files(path.parent, export.parts)
    products, unread = _read_each(files, read_solids)
    unit = next((unit for _, unit in products.values() if unit), "m")
    solids = {
        name: tuple(scaled(part, METRES[own] / METRES[unit]) if own not in ("", unit) else part for part in parts)
        for name, (parts, own) in products.items()
    }
    if missing:
        listed = _listed([f"{part.name!r} ({part.file or 'no file is named'})" for part in missing])
        warnings.warn(
            f"{path.name}: no solids for {listed}: drawn as small boxes; joints are as exported. Put the files "
            "that were exported with it into its folder",
            stacklevel=2,
        )
    if unread:
        warnings.warn(
            f"{path.name}: {_listed(unread)}. The parts are drawn as small boxes; joints are as exported",
            stacklevel=2,
        )
    metres = METRES[unit]
    placed, groups, first = _placed(export, solids, metres)
    notes = list(export.notes)
    where = _Places(export, first, notes)
    if folders := {str(file.parent) for file in files.values() if file.parent.resolve() != path.parent.resolve()}:
        notes.append(f"solids are not beside {path.name}, but in {', '.join(sorted(folders))}")
    constraints = [*_joints(export.joints, where, metres, notes), *_mates(export, where, metres, notes)]
    return placed, unit, Exported(where.fixed, (*groups, *_rigid(export, first)), tuple(constraints), tuple(notes))


def _read_each(
    files: Mapping[str, Path], read_solids: Reader
) -> tuple[dict[str, tuple[tuple[Part, ...], str]], list[str]]:
    """Read the solids of each file and its unit, and say which files cannot be read, and why."""
    products, unread = {}, []
    for name, file in files.items():
        try:
            products[name] = read_solids(file)
        except ValueError as error:  # parts that are sketches or planes only have a file without a solid
            unread.append(str(error))
    return products, unread


def _listed(names: Sequence[str]) -> str:
    """Name the first few, and how many more there are."""
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return ", ".join(names[:LISTED]) + more


def _files(folder: Path, parts: Sequence[ExportedPart]) -> tuple[dict[str, Path], list[ExportedPart]]:
    """Find the files of the solids by the names that the export gives them, and the parts whose file is not there.

    Files are looked for beside the export, in any case of letters; those that are not there in the folders in it and
    next to it, where one has all of them: one of another assembly may have a "Cylinder.step", too.
    """
    names = {part.file: Path(part.file.replace("\\", "/")).name.casefold() for part in parts}
    found = _there(folder, names)
    missing = {file: name for file, name in names.items() if file not in found}
    if missing:
        others = (_there(place, missing) for place in (*_folders(folder), *_folders(folder.resolve().parent)))
        found |= next((other for other in others if len(other) == len(missing)), {})
    return found, [part for part in parts if part.file not in found]


def _there(folder: Path, names: Mapping[str, str]) -> dict[str, Path]:
    """Find the files in a folder, by what they are called, of those names that are there."""
    there = {file.name.casefold(): file for file in folder.iterdir()}
    return {called: there[name] for called, name in names.items() if name in there}


def _folders(folder: Path) -> list[Path]:
    """Find the folders in a folder that can be read, in the order of their names."""
    return sorted(each for each in folder.iterdir() if each.is_dir() and os.access(each, os.R_OK | os.X_OK))


def _placed(
    export: Export, products: Mapping[str, tuple[Part, ...]], metres: float
) -> tuple[tuple[Part, ...], list[tuple[str, ...]], Paths]:
    """Return the placed parts, the groups of solids of one instance, and the first part of each instance by its
    path."""
    box = (_box(BOX * _extent(export) / metres),)
    solids = [(part, solid) for part in export.parts for solid in products.get(part.file, box)]
    names = unique(cleaned(part.names[-1]) or cleaned(solid.name) or "part" for part, solid in solids)
    placed, of = [], {}
    for name, (part, solid) in zip(names, solids, strict=True):
        path = tuple(map(cleaned, part.names[:-1]))
        own = part.inertial if part.path not in of else NONE  # of several solids the first has the mass of all
        at = replace(solid, inertial=own and own.in_unit(1.0 / metres))
        at = moved(at, _in_unit(part.transform, metres))
        placed.append(replace(at, name=name, path=path, original_name=part.names[-1]))
        of.setdefault(part.path, []).append(name)
    return tuple(placed), [tuple(group) for group in of.values() if len(group) > 1], {p: n[0] for p, n in of.items()}


def _extent(export: Export) -> float:
    """Measure the largest extent of the origins of the parts, metres; one millimetre at least."""
    return max(1e-3, float(np.ptp([part.transform[:3, 3] for part in export.parts], axis=0).max()))


def _box(edge: float) -> Part:
    import trimesh

    return Part(
        "", (), edge * np.asarray(trimesh.creation.box().triangles), notes=("no file of its solid",), is_solid=False
    )


class _Places:
    """The parts that joints and mates are on."""

    def __init__(self, export: Export, first: Paths, notes: list[str]) -> None:
        self.first = first
        self.body = {part.path: part.body for part in export.parts}
        self.fixed_in = {part.path: part.fixed_in for part in export.parts}
        self.fixed = self._fixed(export, notes)

    def _fixed(self, export: Export, notes: list[str]) -> tuple[str, ...]:
        """Find the parts that stand in the world: those that are fixed in it, or else welded to it.

        Where the file has neither, and what is fixed in assemblies is all in one of these, that one is the frame.
        """
        fixed = [name for path, name in self.first.items() if self.fixed_in[path] == ()]
        if not fixed:
            welds = [each.sides for each in export.joints if each.kind.lower() in LOCKS]
            ends = [one.path or other.path for one, other in welds if not (one.path and other.path)]
            fixed = [name for path in ends if (name := self.part(path)) is not None]
        if fixed:
            return tuple(dict.fromkeys(fixed))
        inside = {path: name for path, name in self.first.items() if self.fixed_in[path] is not None}
        if not inside:
            return ()
        frames = {part.names[0] for part in export.parts if part.path in inside}
        if len({path[0] for path in inside}) > 1:
            notes.append(f"nothing is fixed in the assembly itself, only in {_listed(sorted(frames))}, which may move")
            return ()
        notes.append(f"nothing is fixed in the assembly itself; what is fixed in {_listed([*frames])} is taken to be")
        return tuple(inside.values())

    def part(self, path: tuple[str, ...]) -> str | None:
        """Find the part at a path: of an assembly one that is fixed in it, or the first one where it is rigid; None
        where there is none."""
        if path in self.first:
            return self.first[path]
        if not path:
            return next(iter(self.fixed), None)
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


def _rigid(export: Export, first: Paths) -> list[tuple[str, ...]]:
    """Find the rigid groups of the export, as names of parts: rigid assemblies, and what is fixed in one assembly."""
    groups: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for part in export.parts:
        for what, holder in (("body", part.body), ("fixed", part.fixed_in)):
            if holder:
                groups.setdefault((what, holder), []).append(first[part.path])
    return [tuple(group) for group in groups.values() if len(group) > 1]


def _joints(joints: Iterable[ExportedJoint], where: _Places, metres: float, notes: list[str]) -> list[Constraint]:
    """Find the joints between parts; what is no joint that is known is added to the notes."""
    result = []
    for each in joints:
        text = f"{each.kind} {each.name!r}"
        parts = where.parts(each.sides[0].path, each.sides[1].path)
        base, follower = (_in_unit(side.frame, metres) for side in each.sides)
        known = joint_of_kind(each.kind, base, follower)
        if parts is None or known is None:
            why = "it is not between two parts" if parts is None else _unknown(each.kind)
            notes.append(f"{text}: {why}; left out")
            continue
        kind, chain = known
        offset, tilt = _apart(chain.movements[0], base, follower) if len(chain.movements) == 1 else (0.0, 0.0)
        result.append(Constraint(cleaned(each.name), parts, text, chain, kind, offset, tilt))
    return result


def _unknown(kind: str) -> str:
    free = kind.lower().replace("-", "") in FREE
    return "it leaves all freedoms, and holds nothing" if free else "this kind is not known"


def _apart(movement: str, base: Pose, follower: Pose) -> tuple[float, float]:
    """Measure distance and angle by which two frames of a joint differ in what its movement leaves in place."""
    feature, aligned = MOVEMENTS[movement].feature, MOVEMENTS[movement].aligned
    offset = follower[:3, 3] - base[:3, 3]
    along = float(offset @ base[:3, 2])
    tilt = float(np.linalg.norm(np.cross(base[:3, 2], follower[:3, 2]))) if "direction" in aligned else 0.0
    if feature is None or not aligned:
        return 0.0, tilt
    if feature.kind == "plane":
        return abs(along), tilt
    if feature.kind == "axis" and not feature.marked:
        return float(np.linalg.norm(offset - along * base[:3, 2])) if "axis" in aligned else 0.0, tilt
    return float(np.linalg.norm(offset)), tilt


def _mates(export: Export, where: _Places, metres: float, notes: list[str]) -> list[Constraint]:
    """Find the mates between parts; those that are not understood are added to the notes."""
    size = _extent(export) / metres
    return [found for each in export.mates if (found := _mate(each, where, metres, PARALLEL * size, notes)) is not None]


def _mate(each: ExportedMate, where: _Places, metres: float, length: float, notes: list[str]) -> Constraint | None:
    text = f"{each.kind} {each.name!r}"
    parts = where.parts(each.sides[0].path, each.sides[1].path)
    if parts is None:
        notes.append(f"{text}: it is not between two parts; left out")
        return None
    if each.name.lower().startswith(LIMIT):
        notes.append(
            f"{text} between {parts[0]!r} and {parts[1]!r} is a limit by its name: it holds nothing in between"
        )
        return None
    if each.kind.lower() in LOCKS or (each.kind == UNKNOWN and each.name.lower().startswith(LOCKS)):
        if each.kind == UNKNOWN:
            notes.append(f"{text} between {parts[0]!r} and {parts[1]!r} is taken for a lock, by its name")
        return Constraint(
            cleaned(each.name), parts, text, Chain((LOWER_PAIRS[0, 0][1],), np.eye(4)[None]), JointKind.FIXED
        )
    features = [Feature.of(side.kind, side.point / metres, side.axis) for side in each.sides]
    found = mate(each.kind, features[0], features[1], PARALLEL, length) if features[0] and features[1] else None
    if found is None:
        of = " and ".join(f"a {side.kind or 'nameless feature'}" for side in each.sides)
        notes.append(f"{text} of {of}, between {parts[0]!r} and {parts[1]!r}, is not understood; left out")
        return None
    return Constraint(
        cleaned(each.name), (parts[1], parts[0]) if found.swapped else parts, text, found.chain, found.kind
    )


def _in_unit(transform: Pose, metres: float) -> Pose:
    """Convert a transform in metres to another unit."""
    result = transform.copy()
    result[:3, 3] /= metres
    return result
