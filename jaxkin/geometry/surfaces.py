"""The four analytic surfaces of the paper (assumption 3, Section 2): plane, cylinder, cone, sphere.

They are unbounded and computed on the host (numpy, float64). Points (*batch, 3) and lengths are in world coordinates
and the unit of the assembly; axes and normals are unit vectors. `side` is +1 where the material is inside of the
surface (a pin, a ball) and -1 where it is outside (a hole, a socket), so that normals always point out of the material.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.pose import Points, Transform, Vector

Distances = Float[np.ndarray, "*batch"] | np.floating
"""One number for each point; numpy gives a scalar for a single point."""


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane."""

    point: Vector
    """A point of the plane."""
    normal: Vector
    """Unit normal, out of the material."""
    kind: ClassVar[str] = "plane"

    def distance(self, points: Points) -> Distances:
        """Measure the height over the plane, positive outside the material."""
        return (points - self.point) @ self.normal

    def normals(self, points: Points) -> Points:
        """Find the outward normals at points of the surface."""
        return np.broadcast_to(self.normal, points.shape)

    def moved(self, pose: Transform) -> Plane:
        """Displace the surface by a rigid 4x4 displacement in world coordinates."""
        return Plane(pose[:3, :3] @ self.point + pose[:3, 3], pose[:3, :3] @ self.normal)

    def scaled(self, factor: float) -> Plane:
        """Enlarge the surface by a factor from the origin of the world."""
        return replace(self, point=factor * self.point)


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A circular cylinder, unbounded along its axis."""

    point: Vector
    """A point of the axis."""
    axis: Vector
    """Unit vector, in either direction."""
    radius: float
    side: int
    """+1 where the material is inside, -1 where it is outside."""
    kind: ClassVar[str] = "cylinder"

    def distance(self, points: Points) -> Distances:
        """Measure the distance from the surface, positive outside the material."""
        return self.side * (np.linalg.norm(_radial(points, self.point, self.axis), axis=-1) - self.radius)

    def normals(self, points: Points) -> Points:
        """Find the outward normals at points of the surface."""
        return self.side * _unit(_radial(points, self.point, self.axis))

    def moved(self, pose: Transform) -> Cylinder:
        """Displace the surface by a rigid 4x4 displacement in world coordinates."""
        return replace(self, point=pose[:3, :3] @ self.point + pose[:3, 3], axis=pose[:3, :3] @ self.axis)

    def scaled(self, factor: float) -> Cylinder:
        """Enlarge the surface by a factor from the origin of the world."""
        return replace(self, point=factor * self.point, radius=factor * self.radius)


@dataclass(frozen=True, eq=False)
class Cone:
    """One half of a circular double cone."""

    apex: Vector
    axis: Vector
    """Unit vector from the apex into the half of the double cone that the face lies on."""
    half_angle: float
    """Angle between the axis and a ruling, radians, 0 < half_angle < pi/2."""
    side: int
    """+1 where the material is inside, -1 where it is outside."""
    kind: ClassVar[str] = "cone"

    def distance(self, points: Points) -> Distances:
        """Measure the distance from the surface, positive outside the material; behind the apex, from the extended
        rulings."""
        height = (points - self.apex) @ self.axis
        radius = np.linalg.norm(_radial(points, self.apex, self.axis), axis=-1)
        return self.side * (radius * np.cos(self.half_angle) - height * np.sin(self.half_angle))

    def normals(self, points: Points) -> Points:
        """Find the outward normals at points of the surface."""
        radial = _unit(_radial(points, self.apex, self.axis))
        return self.side * (radial * np.cos(self.half_angle) - self.axis * np.sin(self.half_angle))

    def moved(self, pose: Transform) -> Cone:
        """Displace the surface by a rigid 4x4 displacement in world coordinates."""
        return replace(self, apex=pose[:3, :3] @ self.apex + pose[:3, 3], axis=pose[:3, :3] @ self.axis)

    def scaled(self, factor: float) -> Cone:
        """Enlarge the surface by a factor from the origin of the world."""
        return replace(self, apex=factor * self.apex)


@dataclass(frozen=True, eq=False)
class Sphere:
    """A sphere."""

    centre: Vector
    radius: float
    side: int
    """+1 where the material is inside, -1 where it is outside."""
    kind: ClassVar[str] = "sphere"

    def distance(self, points: Points) -> Distances:
        """Measure the distance from the surface, positive outside the material."""
        return self.side * (np.linalg.norm(points - self.centre, axis=-1) - self.radius)

    def normals(self, points: Points) -> Points:
        """Find the outward normals at points of the surface."""
        return self.side * _unit(points - self.centre)

    def moved(self, pose: Transform) -> Sphere:
        """Displace the surface by a rigid 4x4 displacement in world coordinates."""
        return replace(self, centre=pose[:3, :3] @ self.centre + pose[:3, 3])

    def scaled(self, factor: float) -> Sphere:
        """Enlarge the surface by a factor from the origin of the world."""
        return replace(self, centre=factor * self.centre, radius=factor * self.radius)


Surface = Plane | Cylinder | Cone | Sphere


def _radial(points: Points, origin: Vector, axis: Vector) -> Points:
    """Project `points - origin` perpendicular to the axis, a unit vector."""
    offset = points - origin
    return offset - (offset @ axis)[..., None] * axis


def _unit(vectors: Points) -> Points:
    """Divide vectors by their lengths; zero vectors stay zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0)  # a point on the axis has no normal: zero, not NaN
