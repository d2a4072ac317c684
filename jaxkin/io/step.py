"""Solid models from STEP files: parts in their assembled pose with their analytic faces, in the unit of the file."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from jaxkin._files import check_file
from jaxkin._names import listed
from jaxkin.geometry.part import Part
from jaxkin.io.names import cleaned, is_damaged, unique
from jaxkin.io.step_check import far_away, missing, without_tessellations
from jaxkin.io.step_colors import one_color_each
from jaxkin.io.step_convert import convert
from jaxkin.io.step_glb import Instance, instances
from jaxkin.io.step_materials import materials
from jaxkin.io.step_others import with_other_files
from jaxkin.io.step_placements import FilePlacements, check_not_mirrored, whole_operators
from jaxkin.io.step_rounding import corner_rounding, place_rounding, text_rounding
from jaxkin.io.step_shapes import StepShapes, solids_alone
from jaxkin.io.step_solid import Solid, make_solid
from jaxkin.io.step_strings import string_value
from jaxkin.io.step_text import step_text
from jaxkin.io.step_tree import nameless_occurrences, placed_parts, simple_occurrences
from jaxkin.io.step_unit import length_unit, uncertainty
from jaxkin.io.time_limit import TimeLimit

_SOLIDS = re.compile(r"MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP|TESSELLATED_SOLID")
_DOCUMENT = re.compile(r"DOCUMENT_FILE\s*\(\s*'([^']+)'")
"""The name of another file that an assembly has its parts in."""

_TOLD_DEFECTS = 3
"""Defects of a file that its warning tells."""

MAX_STEP_BYTES = 500_000_000
"""Bytes of a file; a large assembly has some fifty million."""

_PLACEHOLDER = re.compile(r"|\d+|NAUO\d+|=>\[.*\].*|Open CASCADE STEP translator.*|COMPOUND|COMPSOLID|SOLID|SHELL")
"""What translators write where nobody gave a name."""


def read_step(
    path: str | Path, seconds: float | None = None, progress: Callable[[int, int], None] | None = None
) -> tuple[tuple[Part, ...], str]:
    """Read the parts of a STEP file, in world coordinates and in the length unit of the file, and the name of that
    unit.

    Each instance of a solid in the assembly is a part. Names are cleaned, with what the file says in `original_name`;
    parts with the same name become "bolt", "bolt#2", parts without a name "part 1", "part 2" by their place in the
    file. The sub-assemblies that a part is in are its `path`. Faces of a part on one surface are one face; those on
    none of the four surfaces, and what was repaired, are in the notes of the part. `seconds` is the time allowed, by
    default that of `TimeLimit`; `progress(done, total)` is called after each part.

    Raises FileNotFoundError where there is no such file, and ValueError where it is no whole STEP file with solids, or
    not read in time. Warns where the reader met damages, or parts, faces or their triangles are not what the file says.
    """
    path = Path(path)
    own = _text(path)
    text = _checked(with_other_files(own, path, _text, MAX_STEP_BYTES), path.name)
    limit = TimeLimit.start(path, seconds, path.stat().st_size + len(text) - len(own))
    unit_name, metres = length_unit(text, path.name)
    off, relative = uncertainty(text), text_rounding(text)
    placed = placed_parts(text, path.name)
    check_not_mirrored(text, path.name)
    of_material = materials(text)
    text, sheets = solids_alone(text)
    read = partial(instances, products=nameless_occurrences(text), placements=FilePlacements(text))
    found, defects = _instances(one_color_each(text).encode("latin-1"), read, limit)
    placed, bare = _with_solids(text, placed, len(found))
    _tell_hidden(path.name, text)
    _tell_left_out(path.name, sheets, [name for name in bare if name not in sheets], _documents(text))
    defects += missing(text, sum(placed.values()), found) + far_away(found)
    names = unique(_name(instance, number) for number, instance in enumerate(found, start=1))
    solids: dict[bytes, Solid] = {}  # many instances are of one
    parts = []
    for name, instance in zip(names, found, strict=True):
        limit.remaining()
        if (key := instance.mesh.key) not in solids:
            solids[key] = make_solid(instance.mesh, metres, off)
        pose = instance.pose
        pose[:3, 3] /= metres
        part, damages = solids[key].placed(name, pose, instance.color)
        rounded = place_rounding(instance, relative) / metres
        material = of_material.get(cleaned(instance.names[1]))
        parts.append(
            replace(
                part,
                path=instance.path,
                original_name=next(iter(_given(instance)), ""),
                vertex_resolution=rounded + corner_rounding(instance) / metres,
                surface_resolution=rounded,
                density=material and material.density,
                notes=(*part.notes, *([material.note] if material else [])),
            )
        )
        defects += [f"{name!r}: {damage}" for damage in damages]
        if progress:
            progress(len(parts), len(found))
    if defects:
        told = "; ".join(defects[:_TOLD_DEFECTS]) + (
            f"; and {len(defects) - _TOLD_DEFECTS} more" if len(defects) > _TOLD_DEFECTS else ""
        )
        warnings.warn(
            f"{path.name} is damaged or incomplete ({told}): parts or faces may be missing or wrong; export it again",
            stacklevel=2,
        )
    return tuple(parts), unit_name


def _instances(
    data: bytes, read: Callable[[bytes], Iterable[Instance]], limit: TimeLimit
) -> tuple[list[Instance], list[str]]:
    """Convert the solids of a file, and `read` them as placed meshes, one at least; also what is said of damages."""
    glb, damages = convert(data, limit)
    found = list(read(glb))
    if not all(instance.complete for instance in found):  # of a product some is coloured, and some is not
        plain = list(read(convert(data.replace(b"STYLED_ITEM", b"UNSTYLED_ITEM"), limit)[0]))
        colors = [it.color for it in found] if len(plain) == len(found) else [None] * len(plain)
        found = [replace(bare, color=color) for bare, color in zip(plain, colors, strict=True)]
    found = without_tessellations(found)
    if not found:
        why = f" ({'; '.join(damages)})" if damages else ""
        raise ValueError(f"{limit.name} is damaged: none of its solids can be made{why}; export it again")
    for instance in found:
        if not (np.all(np.isfinite(instance.mesh.triangles)) and np.all(np.isfinite(instance.pose))):
            named = next(filter(None, instance.names), "without a name")
            raise ValueError(
                f"{limit.name} is damaged: coordinates of the part {named!r} are no numbers; export it again"
            )
    return found, damages


def _text(path: Path) -> str:
    """Read the text of a file, if it can be a STEP file."""
    if (size := check_file(path, "STEP file")) > MAX_STEP_BYTES:
        raise ValueError(
            f"{path.name} is {size / 1e6:.0f} MB, more than {MAX_STEP_BYTES / 1e6:.0f}: export it part by part"
        )
    return whole_operators(simple_occurrences(step_text(path.read_bytes(), path.name)))


def _checked(text: str, name: str) -> str:
    """Raise ValueError where the text of the file `name` holds no solids; return it else."""
    if not _SOLIDS.search(text):
        if elsewhere := _documents(text):
            raise ValueError(
                f"{name} holds no solids: it places those of other files, {listed(elsewhere)}, which are not beside "
                "it: put them there, or export the assembly with all parts in one file"
            )
        raise ValueError(f"{name} holds no solids, only surfaces, curves or nothing: export the parts as solids")
    return text


def _documents(text: str) -> list[str]:
    """List the names of other files that a file refers to."""
    return [string_value(name) for name in dict.fromkeys(_DOCUMENT.findall(text))]


def _with_solids(text: str, placed: Mapping[str, int], found: int) -> tuple[dict[str, int], list[str]]:
    """Find how often parts are placed whose shapes hold solids, and the names of the others: looked up where fewer are
    `found` than are placed."""
    if found >= sum(placed.values()):
        return dict(placed), []
    bare = {number: name for number, name in StepShapes(text).without_solids().items() if number in placed}
    names = [*dict.fromkeys(name or "without a name" for name in bare.values())]
    return {number: times for number, times in placed.items() if number not in bare}, names


def _tell_left_out(source: str, sheets: Sequence[str], bare: Sequence[str], documents: Sequence[str]) -> None:
    """Warn of surfaces and of parts without solids, which are left out."""
    said = []
    if sheets:
        said.append(f"open surfaces of {listed([*map(repr, sheets)])} bound no solid")
    if bare:
        elsewhere = f", and it refers to files that are not beside it, {listed(documents)}" if documents else ""
        said.append(f"it places {listed([*map(repr, bare)])} without a solid{elsewhere}")
    if said:
        warnings.warn(f"{source}: {'; '.join(said)}: left out; export them as solids if they matter", stacklevel=3)


def _tell_hidden(source: str, text: str) -> None:
    """Warn of solids that the file hides: they are parts as all others, and may be none of the mechanism."""
    if "INVISIBILITY" in text and (hidden := StepShapes(text).hidden()):
        warnings.warn(
            f"{source}: solids of {listed([*map(repr, hidden)])} are hidden in it, and read as all others: leave out "
            f"those that are not meant, by mechanism(exclude=[{hidden[0]!r}]), or export the file without them",
            stacklevel=3,
        )


def _name(instance: Instance, number: int) -> str:
    """Find the name of the instance, of its product, or else of the sub-assembly that it is in, cleaned; a damaged one
    only where there is no other."""
    given = _given(instance) or [name for name in instance.path[::-1] if not _PLACEHOLDER.fullmatch(name)]
    sound = [name for name in given if not is_damaged(name)]
    return next(filter(None, map(cleaned, sound + given)), f"part {number}")


def _given(instance: Instance) -> list[str]:
    """Find the names of an instance and its product that somebody gave."""
    return [name for name in instance.names if not _PLACEHOLDER.fullmatch(name)]
