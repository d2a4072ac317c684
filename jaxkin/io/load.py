"""Assemblies from files."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from jaxkin.assembly.assembly import Assembly
from jaxkin.examples import EXAMPLES
from jaxkin.examples import path as example_file
from jaxkin.geometry.part import Part, size
from jaxkin.geometry.units import check_unit
from jaxkin.io.exports import read_exported
from jaxkin.io.mechanism_file import MECHANISM_SUFFIX
from jaxkin.io.mesh import MESHES, read_mesh
from jaxkin.io.odd_sizes import with_odd_sizes_noted
from jaxkin.io.robot_files import ROBOT_ROOTS, ROBOT_SUFFIXES, read_robot
from jaxkin.io.saved_mechanism import read_mechanism
from jaxkin.io.step import read_step
from jaxkin.io.xml_tree import read_xml

STEP_SUFFIXES = (".step", ".stp")

_PACKED = (".stpz", ".gz", ".zip")
"""The suffixes of packed files; CAD systems write STEP so."""

XML = ".xml"
"""The suffix of exports for Simscape Multibody, and of MuJoCo's robots."""

_TWINS = 1e-6
"""Of the size of the assembly; two copies in the same place differ by the rounding of their placements at most."""


def load(
    source: str | Path | Mapping[str, str | Path],
    *,
    unit: str | None = None,
    seconds: float | None = None,
    loops: str | Path | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Assembly:
    """Load the assembly in a file, or of one file a part, `{"crank": "crank.stl"}`, in world coordinates.

    STEP (.step, .stp) or meshes (.stl, .obj, .ply, .3mf, .glb). Faces of meshes are recovered from their triangles; in
    one mesh file a part is a node, or a connected body where there is but one node. Of an export for Simscape Multibody
    (.xml), which SolidWorks, Creo, Inventor and Onshape write, the joints, mates and rigid groups are read too; the
    files of its solids are those beside it. Of a robot in URDF (.urdf), MJCF (.xml, .mjcf) or SDF (.sdf, .world) the
    links are the parts, in metres, and its joints are read with their limits and motors. A URDF is a tree; `loops` is
    the YAML file that closes its loops, as in Gepetto's example-parallel-robots. Assemblies of FreeCAD (.FCStd, in mm)
    and of its solver (.asmt, in `unit`) are read in the same way, without solids. Where the file's own pose is open,
    the loops are closed, and a note says how far parts were moved.

    A mechanism that `Mechanism.save` wrote (.json) comes back whole: `jk.load(path).mechanism()`.

    Lengths stay as they are in the files. STEP and 3MF say their unit, GLB is in metres; for STL, OBJ, PLY and ASMT,
    which have none, and for a mechanism that was saved without one, `unit` says it ("mm"); without it the unit is "".
    `seconds` is the processor time in which each file has to be read, by default 20 s and 5 s a megabyte.
    `progress(done, total)` is called after each part of a STEP file, and after each file of several.

    Raises FileNotFoundError where there is no such file, and ValueError where one holds no solids or is not read in
    time, where files differ in their unit, or are in another one than `unit`. Warns of damages that leave something to
    be read.
    """
    if unit is not None:
        check_unit(unit)
    if isinstance(source, str | Path):
        return _from_file(Path(source), unit, seconds, None if loops is None else Path(loops), progress)
    if not isinstance(source, Mapping) or not source:
        raise ValueError(
            f"load reads a file by its path, or a dict of files by part, as in {{'crank': 'crank.stl'}}; got {source!r}"
        )
    if loops is not None:
        raise ValueError(
            f"loops is the YAML file of the loops of a robot in URDF; got a file for each of {len(source)} parts"
        )
    return _from_parts(source, unit, seconds, progress)


def _from_file(
    path: Path,
    unit: str | None,
    seconds: float | None,
    loops: Path | None,
    progress: Callable[[int, int], None] | None,
) -> Assembly:
    """Load the assembly in one file; the arguments are those of `load`."""
    name, suffix = path.name, path.suffix.lower()
    if not path.exists() and (shipped := [key for key, each in EXAMPLES.items() if each.file == name]):
        raise FileNotFoundError(
            f"{path} does not exist; one of this name comes with the package: from jaxkin.examples import path, and "
            f"jk.load(path({shipped[0]!r})), or copy {example_file(shipped[0])}"
        )
    root = read_xml(path) if suffix == XML else None
    if suffix in ROBOT_SUFFIXES or (root is not None and root.tag in ROBOT_ROOTS):
        parts, said, exported = read_robot(path, root, loops, seconds)
        return Assembly(parts, _agreed({name: said}, unit), name, exported)
    if loops is not None:
        raise ValueError(f"loops is the YAML file of the loops of a robot in URDF; {name} is none")
    if suffix == MECHANISM_SUFFIX:
        saved = read_mechanism(path)
        saved = replace(saved, unit=_agreed({name: saved.unit}, unit))
        return Assembly((), saved.unit, name, saved=saved)
    if root is not None:
        parts, said, exported = read_exported(path, root, lambda file: _read(file, seconds))
        twice = tuple(
            f"the parts {one.name!r} and {other.name!r} are the same solid in the same place"
            for one, other in _twins(parts)
        )
        exported = replace(exported, notes=(*exported.notes, *twice))
        return Assembly(parts, _agreed({name: said}, unit), name, exported)
    parts, said = _read(path, seconds, progress=progress)
    return Assembly(with_odd_sizes_noted(_without_twins(parts, name)), _agreed({name: said}, unit), name)


def _from_parts(
    source: Mapping[str, str | Path],
    unit: str | None,
    seconds: float | None,
    progress: Callable[[int, int], None] | None,
) -> Assembly:
    """Load the assembly of one file a part; the arguments are those of `load`."""
    parts, units = [], {}
    for name, file in source.items():
        if not isinstance(file, str | Path):
            raise ValueError(
                f"part {name!r}: expected the path of a file, as in {{'crank': 'crank.stl'}}; got {file!r}"
            )
        found, units[f"{name} ({Path(file).name})"] = _read(Path(file), seconds, name)
        parts += found
        if progress:
            progress(len(units), len(source))
    agreed = _agreed(units, unit)  # first: numbers in different units tell nothing about the same place
    if twins := next(_twins(tuple(parts)), None):
        one, other = (part.name for part in twins)
        raise ValueError(f"the parts {one!r} and {other!r} are the same solid in the same place: leave one out")
    names = ", ".join(Path(file).name for file in source.values())
    return Assembly(with_odd_sizes_noted(tuple(parts)), agreed, names)


def _read(
    path: Path,
    seconds: float | None,
    name: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[tuple[Part, ...], str]:
    """Read the parts in a file, or the one part that it is with a name."""
    suffix = path.suffix.lower()
    if path.is_dir():
        raise ValueError(f"{path} is a folder: give the path of a STEP file in it, or of each of its meshes as a part")
    if suffix in MESHES:
        return read_mesh(path, name, seconds)
    if suffix in _PACKED:
        raise ValueError(f"{path}: load does not unpack files; unpack it, and load the STEP file or the meshes in it")
    if suffix == ".toml":
        raise ValueError(f"{path}: load reads geometry and robots; a study is read by jk.load_study({str(path)!r})")
    if suffix not in STEP_SUFFIXES:
        raise ValueError(
            f"{path}: load reads STEP files ({', '.join(STEP_SUFFIXES)}), meshes ({', '.join(MESHES)}), "
            f"{XML} exports and robots ({', '.join(ROBOT_SUFFIXES)}); got {path.suffix or 'no suffix'}. Export the "
            "assembly as STEP from the CAD program"
        )
    parts, unit = read_step(path, seconds, progress)
    if name is None:
        return parts, unit
    if len(parts) > 1:
        raise ValueError(
            f"{path.name} holds {len(parts)} solids, but is given as the one part {name!r}: export that part alone, or "
            f"load the file as an assembly, load({str(path)!r})"
        )
    return tuple(replace(part, name=name) for part in parts), unit


def _without_twins(parts: tuple[Part, ...], source: str) -> tuple[Part, ...]:
    """Leave out parts that are the same solid in the same place as another one, which is then said of this one."""
    twins = {other.name: one.name for one, other in _twins(parts)}
    if not twins:
        return parts
    first, *more = [f"{other!r} (as {one!r})" for other, one in twins.items()]
    others = f" and {len(more)} more are" if more else " is"
    warnings.warn(f"{source}: {first}{others} the same solid in the same place as another part: left out", stacklevel=4)
    notes: dict[str, tuple[str, ...]] = {}
    for other, one in twins.items():
        notes[one] = (*notes.get(one, ()), f"{other!r} is the same solid in the same place: left out")
    kept = (part for part in parts if part.name not in twins)
    return tuple(replace(part, notes=(*part.notes, *notes.get(part.name, ()))) for part in kept)


def _twins(parts: tuple[Part, ...]) -> Iterator[tuple[Part, Part]]:
    """Yield each part that is the same solid in the same place as one before it, with that one; those without faces
    are none."""
    near = _TWINS * size(parts)
    seen: dict[tuple[float, ...], list[tuple[Part, np.ndarray]]] = {}
    for part in (part for part in parts if part.faces):
        about = np.stack([*part.box, part.triangles.mean(axis=(0, 1))])
        cell = np.floor(about[2] / near)  # of the middle, so that only what is in the cells around it is compared
        count = float(len(part.triangles))
        cells = ((count, *(cell + step).tolist()) for step in product((-1.0, 0.0, 1.0), repeat=3))
        others = (other for each in cells for other in seen.get(each, ()))
        if twin := next((other for other, told in others if np.abs(told - about).max() < near), None):
            yield twin, part
        else:
            seen.setdefault((count, *cell.tolist()), []).append((part, about))


def _agreed(said: Mapping[str, str], unit: str | None) -> str:
    """Find the one unit of all files; those that have none are in that of `unit`, or of the others."""
    known = {file: given for file, given in said.items() if given}
    for file, given in known.items():
        if unit is not None and given != unit:
            raise ValueError(
                f"{file} is in {given}, not in {unit}: nothing is rescaled; leave unit out, or export it in {unit}"
            )
    if len(set(known.values())) > 1:
        listed = ", ".join(f"{file} in {given}" for file, given in known.items())
        raise ValueError(f"the files differ in their unit: {listed}; nothing is rescaled: export them in one unit")
    if known and unit is None and len(known) < len(said):
        silent = ", ".join(file for file in said if file not in known)
        raise ValueError(
            f"{silent}: the format has no unit, but {next(iter(known))} is in {next(iter(known.values()))}; say that "
            f"all are, unit={next(iter(known.values()))!r}, or export them in one unit"
        )
    return unit or next(iter(known.values()), "")
