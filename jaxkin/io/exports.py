"""Assemblies from the exports of CAD systems: an XML file with joints, and beside it the solids, a file a part."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin._names import listed
from jaxkin.assembly.exported import Exported
from jaxkin.geometry.inertial import NONE
from jaxkin.geometry.part import Part, moved, scaled
from jaxkin.geometry.units import METRES
from jaxkin.io.export_constraints import ConstrainedParts, Paths, in_unit, joints_between, mates_between
from jaxkin.io.export_content import Export, ExportedPart
from jaxkin.io.export_ground import fixed_parts
from jaxkin.io.names import cleaned, unique
from jaxkin.io.simscape import read_export

Reader = Callable[[Path], tuple[tuple[Part, ...], str]]
"""Reads the solids in a file, in the frame of the file, and its unit; "" where the file says none."""

LISTED = 3
"""Parts or files that a warning names, each with its path."""

SOLVED = 2.5e-6
"""Radians, and lengths over the size of the assembly, within which systems solve mates: to 1e-6 as published files
show, where parts stand in between."""

BOX = 0.02
"""Edge of the box of a part without a solid, over the size of the assembly."""


def read_exported(path: Path, root: Element, read_solids: Reader) -> tuple[tuple[Part, ...], str, Exported]:
    """Read the parts of an export in world coordinates, their unit, and what the CAD system says; `root` is its XML.

    Each instance is a part; an instance of several solids is a rigid group. Lengths are in the unit of the first file
    of a solid; solids in another unit are converted, and files that say none are in that of their part, which a note
    tells. Warns of parts without a file, and of files that hold no solid or are damaged: these parts are small boxes.
    Raises ValueError where the XML is not understood.
    """
    export = read_export(path, root)
    if not export.parts:
        raise ValueError(f"{path.name}: there are no parts in its InstanceTree; export the assembly again")
    files, missing = _files(path.parent, export.parts)
    products, unread = _read_each(files, read_solids)
    unit = next((unit for _, unit in products.values() if unit), "m")
    notes = list(export.notes)
    solids = _converted(products, {part.file: part.file_unit for part in export.parts}, unit, notes)
    if missing:
        names = [f"{part.name!r} ({part.file or 'no file is named'})" for part in missing]
        warnings.warn(
            f"{path.name}: no solids for {listed(names, LISTED)}: drawn as small boxes; joints are as exported. Put "
            "the files that were exported with it into its folder",
            stacklevel=2,
        )
    if unread:
        warnings.warn(
            f"{path.name}: {listed(unread, LISTED)}. The parts are drawn as small boxes; joints are as exported",
            stacklevel=2,
        )
    metres = METRES[unit]
    placed, groups, first = _placed(export, solids, metres)
    size = _extent(export) / metres
    fixed = fixed_parts(export, first, metres, size, notes)
    where = ConstrainedParts(export, first, next(iter(fixed), None))
    if folders := {str(file.parent) for file in files.values() if file.parent.resolve() != path.parent.resolve()}:
        notes.append(f"solids are not beside {path.name}, but in {', '.join(sorted(folders))}")
    constraints = [
        *joints_between(export.joints, where, metres, notes),
        *mates_between(export.mates, where, metres, size, notes),
    ]
    rigid = (*groups, *_rigid(export, first))
    accuracy = max(export.rounding, SOLVED) if export.mates else export.rounding
    more = {"accuracy": accuracy, "marks_rigid": export.marks_rigid}
    return placed, unit, Exported(fixed, rigid, tuple(constraints), tuple(notes), **more)


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


def _converted(
    products: Mapping[str, tuple[tuple[Part, ...], str]],
    file_units: Mapping[str, tuple[str, float]],
    unit: str,
    notes: list[str],
) -> dict[str, tuple[Part, ...]]:
    """Convert the solids of each file to a unit; those of files that say none are in `file_units`, which is noted."""
    solids = {}
    for name, (parts, own) in products.items():
        times = (METRES[own] if own else file_units[name][1]) / METRES[unit]
        solids[name] = parts if times == 1.0 else tuple(scaled(part, times) for part in parts)
    if silent := [f"{name} in {file_units[name][0]}" for name, (_, own) in products.items() if not own]:
        notes.append(f"files that say no unit are taken to be in that of their parts: {listed(silent, LISTED)}")
    return solids


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
        at = moved(at, in_unit(part.transform, metres))
        placed.append(replace(at, name=name, path=path, original_name=part.names[-1]))
        of.setdefault(part.path, []).append(name)
    return tuple(placed), [tuple(group) for group in of.values() if len(group) > 1], {p: n[0] for p, n in of.items()}


def _extent(export: Export) -> float:
    """Measure the largest extent of the places of parts, joints and mates, metres; one millimetre at least.

    Parts that were modelled where they are in the assembly all have its origin.
    """
    places = [part.transform[:3, 3] for part in export.parts]
    places += [side.frame[:3, 3] for joint in export.joints for side in joint.sides]
    places += [side.point for mate in export.mates for side in mate.sides]
    return max(1e-3, float(np.ptp(places, axis=0).max()))


def _box(edge: float) -> Part:
    import trimesh

    return Part(
        "", (), edge * np.asarray(trimesh.creation.box().triangles), notes=("no file of its solid",), is_solid=False
    )


def _rigid(export: Export, first: Paths) -> list[tuple[str, ...]]:
    """Find the rigid groups of the export, as names of parts: rigid assemblies, and what is fixed in one assembly."""
    groups: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for part in export.parts:
        for what, holder in (("body", part.body), ("fixed", part.fixed_in)):
            if holder:
                groups.setdefault((what, holder), []).append(first[part.path])
    return [tuple(group) for group in groups.values() if len(group) > 1]
