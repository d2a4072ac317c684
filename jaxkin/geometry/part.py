"""Parts and their faces; a face is a bounded piece of an analytic surface, given by triangles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.inertial import Inertial
from jaxkin.geometry.pose import Transform, apply
from jaxkin.geometry.surfaces import Surface
from jaxkin.geometry.triangles import total_area


@dataclass(frozen=True, eq=False)
class Face:
    """One face of a part: its unbounded surface, and the triangles that say where on the surface the face lies."""

    name: str
    """Name, unique within the part, such as "face 7"."""
    surface: Surface
    """The surface in world coordinates at the assembled pose."""
    triangles: Float[np.ndarray, "triangles 3 3"]
    """Corners in world coordinates at the assembled pose, in the unit of the assembly, wound outwards."""

    @cached_property
    def box(self) -> Float[np.ndarray, "2 3"]:
        """Lowest and highest corner of the bounding box."""
        corners = self.triangles.reshape(-1, 3)
        return np.stack([corners.min(axis=0), corners.max(axis=0)])

    @cached_property
    def bulge(self) -> float:
        """Largest distance of the surface from the triangles, measured at their middles and those of their edges."""
        corners = self.triangles
        middles = [(corners + np.roll(corners, 1, axis=1)) / 2, corners.mean(axis=1, keepdims=True)]
        return float(np.abs(self.surface.distance(np.concatenate(middles, axis=1).reshape(-1, 3))).max())

    @cached_property
    def area(self) -> float:
        """Sum of the areas of the triangles."""
        return total_area(self.triangles)


@dataclass(frozen=True, eq=False, repr=False)
class Part:
    """A rigid part in its assembled pose, in world coordinates and in the unit of the assembly."""

    name: str
    """Name, unique within the assembly."""
    faces: tuple[Face, ...]
    """The faces that are one of the four analytic surfaces."""
    triangles: Float[np.ndarray, "triangles 3 3"]
    """Corners of the triangles of all faces, analytic or not, for drawing."""
    color: tuple[float, float, float] | None = None
    """Red, green, blue, 0 to 1; None where the file gives no colour."""
    notes: tuple[str, ...] = field(default=())
    """Messages about faces of this part that could not be read as one of the four surfaces."""
    vertex_resolution: float = 0.0
    """Largest rounding error, a length, of the corners of the triangles."""
    surface_resolution: float | None = None
    """Largest rounding error, a length, of where its surfaces lie, as the file holds them; None where they were fitted
    to the corners of the triangles."""
    path: tuple[str, ...] = ()
    """Names of the sub-assemblies that contain the part, outermost first, without the assembly of the whole file."""
    original_name: str = ""
    """The name in the file, before it was cleaned and numbered; empty where the file gives none."""
    inertial: Inertial | None = None
    """What the file says that the part weighs, world axes; None where it says nothing."""
    density: float | None = None
    """What the file says of its material, kg/m^3; None where it says nothing."""
    is_solid: bool = True
    """Whether the triangles are those of the part: False where its file has none, and a small box marks its place."""

    def __repr__(self) -> str:
        return f"<Part {self.name!r}: {len(self.faces)} faces, {len(self.triangles)} triangles>"

    @cached_property
    def box(self) -> Float[np.ndarray, "2 3"]:
        """Lowest and highest corner of the bounding box."""
        corners = self.triangles.reshape(-1, 3)
        return np.stack([corners.min(axis=0), corners.max(axis=0)])

    @property
    def resolution(self) -> float:
        """Largest rounding error, a length, of where its surfaces lie, fitted ones too."""
        return self.vertex_resolution if self.surface_resolution is None else self.surface_resolution

    @cached_property
    def outermost(self) -> Float[np.ndarray, "corners 3"]:
        """Corners whose convex hull is that of all corners, few of a large part; all corners of a flat part."""
        return outermost(self.triangles.reshape(-1, 3))

    @property
    def extent(self) -> float:
        """Diagonal of the bounding box."""
        return float(np.linalg.norm(self.box[1] - self.box[0]))

    @cached_property
    def volume(self) -> float:
        """Volume inside of the triangles, in the cube of the unit: one sixth of the sum of their triple products."""
        corners = self.triangles - self.box.mean(axis=0)
        return float(abs(np.einsum("ti,ti->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6)


def outermost(points: Float[np.ndarray, "_ 3"]) -> Float[np.ndarray, "_ 3"]:
    """Choose points whose convex hull is that of all points, few of many; all of flat ones."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        return points


def heaviest(names: Sequence[str], solids: Mapping[str, Part]) -> str:
    """Find the heaviest of some parts, the first of equal ones: the longest may be a screw."""
    return max(names, key=lambda name: (solids[name].volume, solids[name].extent))


def body_name(parts: Sequence[str], solids: Mapping[str, Part]) -> str:
    """Name a body by the heaviest of its parts that have a solid, since its first may be a pin; else by the first."""
    drawn = [part for part in parts if part in solids] if len(parts) > 1 else []
    return heaviest(drawn, solids) if drawn else parts[0]


def box_corners(box: Float[np.ndarray, "2 3"]) -> Float[np.ndarray, "8 3"]:
    """List the eight corners of a box, given by its lowest and its highest one."""
    return np.stack(np.meshgrid(*box.T), axis=-1).reshape(-1, 3)


def moved(part: Part, pose: Transform) -> Part:
    """Displace a part by a pose, (4, 4)."""
    faces = tuple(
        replace(face, surface=face.surface.moved(pose), triangles=apply(pose, face.triangles)) for face in part.faces
    )
    inertial = None if part.inertial is None else part.inertial.moved(pose)
    return replace(part, faces=faces, triangles=apply(pose, part.triangles), inertial=inertial)


def scaled(part: Part, factor: float) -> Part:
    """Enlarge a part by a factor from the origin of the world, as for another unit of length: its mass stays."""
    faces = tuple(
        replace(face, surface=face.surface.scaled(factor), triangles=factor * face.triangles) for face in part.faces
    )
    inertial = None if part.inertial is None else part.inertial.in_unit(factor)
    triangles = factor * part.triangles
    return replace(
        part,
        faces=faces,
        triangles=triangles,
        vertex_resolution=factor * part.vertex_resolution,
        surface_resolution=None if part.surface_resolution is None else factor * part.surface_resolution,
        inertial=inertial,
    )


def size(parts: tuple[Part, ...]) -> float:
    """Measure the diagonal of the bounding box of all parts, the length that tolerances are relative to."""
    boxes = np.stack([part.box for part in parts])
    return float(np.linalg.norm(boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)))
