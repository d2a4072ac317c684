"""Solid models from STEP files: parts in their assembled pose with their analytic faces, in the unit of the file."""

from __future__ import annotations

import re
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Int

from jaxkin.geometry.fit import fit_surface, flipped, rounding
from jaxkin.geometry.merge import merge_faces
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Points, apply, unit
from jaxkin.geometry.shells import wrong_side
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface
from jaxkin.io.names import unique
from jaxkin.io.step_convert import convert
from jaxkin.io.step_glb import Instance, instances
from jaxkin.io.step_side import Triangles, areas, points_outwards, winding
from jaxkin.io.step_tree import check_parts
from jaxkin.io.step_unit import length_unit

_SOLIDS = re.compile(rb"MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP|TESSELLATED_SOLID")

_SAMPLES = 24
"""Triangles of a part at which it is looked whether it cuts itself."""

LARGEST = 500_000_000
"""Bytes of a file; a large assembly has some fifty million."""

Rows = Int[np.ndarray, "rows"]

_PLACEHOLDER = re.compile(r"|\d+|NAUO\d+|=>\[.*\].*|Open CASCADE STEP translator.*")
"""What translators write where nobody gave a name."""


def read_step(path: str | Path) -> tuple[tuple[Part, ...], str]:
    """The parts of a STEP file, in world coordinates and in the length unit of the file, and the name of that unit.

    Each instance of a solid in the assembly is a part. Parts with the same name become "bolt", "bolt#2"; parts without
    a name "part 1", "part 2" by their place in the file. Faces of a part on one surface are one face; those on none of
    the four surfaces, and what was repaired, are in the notes of the part.

    Raises FileNotFoundError where there is no such file, and ValueError where it is no whole STEP file with solids.
    """
    path = Path(path)
    data = _checked(path)
    text = data.decode("latin-1")
    unit_name, metres = length_unit(text, path.name)
    check_parts(text, path.name)
    found = list(instances(convert(data, path.name)))
    if not all(instance.complete for instance in found):
        plain = instances(convert(data.replace(b"STYLED_ITEM", b"UNSTYLED_ITEM"), path.name))
        found = [replace(bare, color=it.color) for bare, it in zip(plain, found, strict=True)]
    names = unique(_name(instance, number) for number, instance in enumerate(found, start=1))
    seen: dict[bytes, Points | None] = {}
    return tuple(_part(name, instance, metres, seen) for name, instance in zip(names, found, strict=True)), unit_name


def _checked(path: Path) -> bytes:
    """The content of the file, if it can be a STEP file with solids."""
    if path.is_dir():
        raise ValueError(f"{path} is a folder: give the STEP file itself")
    if not path.exists():
        raise FileNotFoundError(f"{path} does not exist: give the path of a STEP file")
    if (size := path.stat().st_size) > LARGEST:
        raise ValueError(f"{path.name} is {size / 1e6:.0f} MB, more than {LARGEST / 1e6:.0f}: export it part by part")
    data = path.read_bytes()
    if not data.strip():
        raise ValueError(f"{path.name} is empty: expected a STEP file")
    if not re.match(rb"(\xef\xbb\xbf)?\s*ISO-10303-21\s*;", data):
        raise ValueError(f"{path.name} is not a STEP file: it does not begin with ISO-10303-21;")
    if not re.search(rb"END-ISO-10303-21\s*;", data[-1000:]):
        raise ValueError(f"{path.name} is cut off: it does not end with END-ISO-10303-21; copy or export it again")
    if not _SOLIDS.search(data):
        raise ValueError(f"{path.name} holds no solids, only surfaces, curves or nothing: export the parts as solids")
    return data


def _part(name: str, instance: Instance, metres: float, seen: dict[bytes, Points | None]) -> Part:
    """`seen` holds where meshes cut themselves, in their own frames: many instances are of one solid."""
    triangles, pose = instance.triangles / metres, instance.pose.copy()
    pose[:3, 3] /= metres
    tolerance = rounding(triangles)
    faces, notes, doubtful = [], [], False
    for index, described in enumerate(instance.faces):
        label, rows = f"face {index + 1}", np.flatnonzero(instance.face_of == index)
        if len(rows) == 0:
            notes.append(f"{label}: it came without triangles, so where it ends is not known: left out")
            continue
        corners, normals = triangles[rows].reshape(-1, 3), instance.normals[rows].reshape(-1, 3)
        surface = _analytic(described, corners, metres) or fit_surface(corners, normals, 5 * tolerance, angle=1e-2)
        if surface is None:
            kind = described["type"] if described else "freeform surface"
            notes.append(f"{label}: {kind}, not one of the four surfaces")
            continue
        surface, corners, note = _oriented(surface, triangles, rows)
        triangles[rows] = corners
        off = float(np.abs(surface.distance(corners)).max())
        if off > 10 * tolerance:
            notes.append(f"{label}: its triangles lie up to {off:.2g} off its {surface.kind}")
        if note:
            notes.append(f"{label}: {note}")
            doubtful = True
        faces.append(Face(label, surface.moved(pose), apply(pose, corners)))
    key = sha256(instance.triangles.tobytes()).digest()
    if key not in seen:
        seen[key] = None if doubtful or not len(triangles) else wrong_side(triangles, tolerance, _SAMPLES)
    # no reason to refuse it: its faces are known exactly, and overlapping bodies are common in real assemblies
    if (place := seen[key]) is not None:
        near = ", ".join(f"{x:.4g}" for x in apply(pose, place))
        notes.append(f"it cuts itself, or bodies touch or overlap in it, near ({near}): unite them if they move apart")
    return Part(name, merge_faces(faces, tolerance), apply(pose, triangles), instance.color, tuple(notes))


def _analytic(described: dict[str, Any] | None, corners: Points, metres: float) -> Surface | None:
    """The surface as cascadio describes it, in the frame of the mesh; its side says nothing."""
    if described is None:
        return None
    at = {key: np.array(described[key]) / metres for key in ("origin", "apex", "center") if key in described}
    match described["type"]:
        case "plane":
            return Plane(at["origin"], unit(np.array(described["normal"])))
        case "cylinder":
            return Cylinder(at["origin"], unit(np.array(described["axis"])), described["radius"] / metres, 1)
        case "cone":  # the sign of its angle is that of the axis, which may point either way
            axis = unit(np.array(described["axis"]))
            axis = axis if np.sum((corners - at["apex"]) @ axis) > 0 else -axis
            return Cone(at["apex"], axis, abs(described["semi_angle"]), 1)
        case "sphere":
            return Sphere(at["center"], described["radius"] / metres, 1)
    return None


def _oriented(surface: Surface, triangles: Triangles, rows: Rows) -> tuple[Surface, Triangles, str]:
    """The surface of some triangles of a solid and these triangles, both facing outwards, and what was amiss."""
    corners = triangles[rows]
    wound = winding(surface, corners)
    outwards = wound > 0
    # where tessellations were seen to fail; for all faces of a large solid the rays would take minutes
    doubtful = isinstance(surface, Sphere) or abs(wound) < 0.9
    if doubtful:
        outwards = points_outwards(surface, corners, triangles)
    surface = surface if outwards else flipped(surface)
    if outwards == (wound > 0) and abs(wound) >= 0.9:
        return surface, corners, ""
    facing_in = np.sum(areas(corners) * surface.normals(corners.mean(axis=1)), axis=-1) < 0
    corners = np.where(facing_in[:, None, None], corners[:, ::-1], corners)
    return (
        surface,
        corners,
        f"its triangles overlap or face inwards: the side of the {surface.kind} is that of the solid",
    )


def _name(instance: Instance, number: int) -> str:
    return next((name for name in instance.names if not _PLACEHOLDER.fullmatch(name)), f"part {number}")
