"""Assemblies from files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from jaxkin.io.step import read_step
from jaxkin.motion.assembly import Assembly

STEP = (".step", ".stp")


def load(source: str | Path | Mapping[str, str | Path]) -> Assembly:
    """The assembly in a STEP file (.step, .stp), in world coordinates and in the length unit of the file.

    Raises FileNotFoundError where there is no such file, and ValueError where it is no STEP file with solids in it,
    or where meshes are given, part by part: they cannot be read yet.
    """
    if not isinstance(source, str | Path):
        raise ValueError(
            f"load reads a STEP file, {' or '.join(STEP)}, by its path; got a {type(source).__name__}: "
            "assemblies of meshes cannot be read yet"
        )
    path = Path(source)
    if path.suffix.lower() not in STEP:
        raise ValueError(
            f"{source}: load reads STEP files, {' or '.join(STEP)}; got {path.suffix or 'no suffix'}. "
            "Export the assembly as STEP from the CAD program"
        )
    parts, unit = read_step(path)
    return Assembly(parts, unit, path.name)
