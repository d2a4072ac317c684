"""A solid of a STEP file in the frame of its mesh: its faces with their analytic surfaces, and what is amiss in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from jaxkin.geometry.facets import TriangleIndices
from jaxkin.geometry.fit import fit_surface, fit_torus, flipped, rounding
from jaxkin.geometry.fit_together import Piece, fit_together
from jaxkin.geometry.merge import merge_faces
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import Points, Transform, apply, unit
from jaxkin.geometry.shells import volume
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere, Surface
from jaxkin.geometry.triangles import Triangles, double_areas
from jaxkin.geometry.weld import weld
from jaxkin.io.gltf_colors import Color
from jaxkin.io.mesh_regions import recovered_faces
from jaxkin.io.step_check import Defect, unsound
from jaxkin.io.step_glb import ProductMesh
from jaxkin.io.step_side import points_outwards, winding

_GROSS = 1e-3
"""Distance of triangles from their surface over the size of the solid; sound files come with up to 2e-4."""

_EXACT = 1e-4
"""The uncertainty over the size of the solid that files may say of their geometry: of more they would have to warn. An
exporter that writes 1e-6 m has faces that are off by 3e-5 of a screw."""

_SPLINE_ACCURACY = 1e-5
"""Distance over the extent of a face up to which a spline is taken for one of the four surfaces.

Exact conversions are right to 1e-7; free forms whose few corners lie on some cylinder were met from 4e-5 on."""

_SPLINE_ANGLE = 1e-3
"""Angle, radians, between a spline and the surface that it is taken for, at nine of ten corners.

Normals are float32, which takes exact conversions to 3e-4; free forms whose corners lie on a cylinder by chance were
met with 2.6e-3."""

_OTHERS = ("torus",)
"""Kinds that the reader of STEP files names, and that are none of the four: nothing is fitted to these."""


_TESSELLATED = "the file has its triangles only, from which its faces are recovered: export it with exact geometry"


@dataclass(frozen=True, eq=False)
class Solid:
    """A solid that may be placed many times; lengths in the unit of the file."""

    faces: tuple[Face, ...]
    triangles: Triangles
    notes: tuple[str, ...]
    """What could not be read as one of the four surfaces, and what was repaired."""
    damages: tuple[str, ...]
    """Notes on faces that are so in damaged files only."""
    defects: tuple[Defect, ...]

    def placed(self, name: str, pose: Transform, color: Color | None) -> tuple[Part, list[str]]:
        """Make the part at a pose, and those of its notes that tell of a damage."""
        faces = tuple(Face(face.name, face.surface.moved(pose), apply(pose, face.triangles)) for face in self.faces)
        notes = [*self.notes, *(defect.note(pose) for defect in self.defects if not defect.damage)]
        damages = [*self.damages, *(defect.note(pose) for defect in self.defects if defect.damage)]
        return Part(name, faces, apply(pose, self.triangles), color, (*notes, *damages)), damages


def make_solid(mesh: ProductMesh, metres: float, uncertainty: float = 0.0) -> Solid:
    """Make the solid of a mesh; `metres` is the unit of the file, `uncertainty` how far its faces may be off, in it."""
    triangles = mesh.triangles / metres
    tolerance = rounding(triangles)
    size = float(np.linalg.norm(np.ptp(triangles.reshape(-1, 3), axis=0))) if len(triangles) else 0.0
    if mesh.tessellated:
        return _tessellated(triangles, tolerance)
    faces, notes, damages, repaired = [], [], [], False
    rows_of = [np.flatnonzero(mesh.face_of == index) for index in range(len(mesh.faces))]
    surfaces = _surfaces(mesh, triangles, rows_of, metres, tolerance)
    for index, (described, rows, surface) in enumerate(zip(mesh.faces, rows_of, surfaces, strict=True)):
        label = f"face {index + 1}"
        if len(rows) == 0:
            damages.append(f"{label}: it came without triangles, so where it ends is not known: left out")
            continue
        if surface is None:
            kind = described["type"] if described else _unnamed(triangles[rows], mesh.normals[rows], tolerance)
            notes.append(f"{label}: {kind}, not one of the four surfaces")
            continue
        surface, corners, note = _oriented(surface, triangles, rows)
        triangles[rows] = corners
        off = float(np.abs(surface.distance(corners)).max())
        if off > max(10 * tolerance, min(uncertainty, _EXACT * size)):
            to = damages if off > _GROSS * size else notes
            to.append(f"{label}: its triangles lie up to {off:.2g} off its {surface.kind}")
        if note:
            notes.append(f"{label}: {note}")
            repaired = True
        faces.append(Face(label, surface, corners))
    defects = [] if repaired or not len(triangles) else unsound(triangles, tolerance)
    return Solid(merge_faces(faces, tolerance), triangles, tuple(notes), tuple(damages), tuple(defects))


def _tessellated(triangles: Triangles, tolerance: float) -> Solid:
    """Make the solid of triangles whose faces are not known: they are recovered from it, as those of a mesh are."""
    welded = weld(triangles, 2 * tolerance)
    corners = welded.points[welded.triangles]
    if volume(corners) < 0:
        welded = replace(welded, triangles=welded.triangles[:, ::-1])
        corners = corners[:, ::-1]
    defects = unsound(corners, tolerance)
    faces, notes = ((), []) if any(it.damage for it in defects) else recovered_faces(welded, tolerance)
    return Solid(faces, corners, (_TESSELLATED, *notes), (), tuple(defects))


def _surfaces(
    mesh: ProductMesh, triangles: Triangles, rows_of: Sequence[TriangleIndices], metres: float, tolerance: float
) -> list[Surface | None]:
    """Find the surface of each face: as the file says it, or fitted to a spline; None where it is none of the four."""
    found: list[Surface | None] = [None] * len(rows_of)
    fitted: dict[int, Piece] = {}
    for index, (described, rows) in enumerate(zip(mesh.faces, rows_of, strict=True)):
        if len(rows) == 0:
            continue
        corners, normals = triangles[rows].reshape(-1, 3), mesh.normals[rows].reshape(-1, 3)
        found[index] = _analytic(described, corners, metres)
        if found[index] is None and (described is None or described["type"] not in _OTHERS):
            within = max(tolerance, _SPLINE_ACCURACY * float(np.linalg.norm(np.ptp(corners, axis=0))))
            surface = fit_surface(corners, normals, within, _SPLINE_ANGLE, thorough=True)
            fitted[index] = Piece(corners, normals, surface)
    together = fit_together([*fitted.values()], tolerance, _SPLINE_ACCURACY, _SPLINE_ANGLE)
    for index, surface in zip(fitted, together, strict=True):
        found[index] = surface
    return found


def _unnamed(triangles: Triangles, normals: Triangles, tolerance: float) -> str:
    """Name the surface of a spline that is none of the four: a fillet, a race or a seal is a torus."""
    torus = fit_torus(triangles.reshape(-1, 3), normals.reshape(-1, 3), tolerance)
    return "freeform surface" if torus is None else torus.kind


def _analytic(described: dict[str, Any] | None, corners: Points, metres: float) -> Surface | None:
    """Make the surface as cascadio describes it, in the frame of the mesh; its side says nothing."""
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


def _oriented(surface: Surface, triangles: Triangles, rows: TriangleIndices) -> tuple[Surface, Triangles, str]:
    """Make the surface of some triangles of a solid and these triangles, both facing outwards, and what was amiss."""
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
    facing_in = np.sum(double_areas(corners) * surface.normals(corners.mean(axis=1)), axis=-1) < 0
    corners = np.where(facing_in[:, None, None], corners[:, ::-1], corners)
    return (
        surface,
        corners,
        f"its triangles overlap or face inwards: the side of the {surface.kind} is that of the solid",
    )
