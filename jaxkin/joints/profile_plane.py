"""The plane of a profile, with its own coordinates (x, y), and contacts in it (host code)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._traced import traced
from jaxkin.geometry.pose import Transform, frame
from jaxkin.joints.axis_frame import PERPENDICULAR, Triple, axis_frame
from jaxkin.joints.profiles import PlacedProfile


class ProfilePoint(NamedTuple):
    """A point of a profile in coordinates of the plane."""

    q: float
    """Parameter, from the first point of the profile."""
    point: Float[np.ndarray, "2"]
    tangent: Float[np.ndarray, "2"]

    def away(self, point: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        """Measure how far a point of the plane is from here along the tangent, and along the normal to its left."""
        x, y = point - self.point
        cos, sin = self.tangent
        return np.array([cos * x + sin * y, cos * y - sin * x])

    def beside(self, height: float) -> Float[np.ndarray, "2"]:
        """Return the point at a height along the normal to the left."""
        return self.point + height * np.array([-self.tangent[1], self.tangent[0]])


class ProfilePlane(NamedTuple):
    """The plane of a profile."""

    pose: Transform
    """Its axes in the world: x along `direction`, z along `axis`."""

    def local(self, name: str, label: str, point: Triple) -> Float[np.ndarray, "2"]:
        """Find the coordinates (x, y) of a point; how far it is off the plane does not matter."""
        origin = np.asarray(axis_frame(name, point, (0.0, 0.0, 1.0), point_label=label))[:3, 3]
        return (self.pose[:3, :2].T @ (origin - self.pose[:3, 3])).astype(float)

    def direction(self, name: str, label: str, given: Triple) -> Float[np.ndarray, "2"]:
        """Find the unit direction (x, y) of a direction in the plane; ValueError where it is not in the plane."""
        along = np.asarray(axis_frame(name, (0.0, 0.0, 0.0), given, label))[:3, 2]
        if abs(float(along @ self.pose[:3, 2])) > PERPENDICULAR:
            raise ValueError(
                f"joint {name!r}: {label} must be perpendicular to the axis of the profile, the cosine between them "
                f"is {float(along @ self.pose[:3, 2]):.3g}"
            )
        flat = self.pose[:3, :2].T @ along
        return flat / np.linalg.norm(flat)

    def frame(self, contact: ProfilePoint, height: float = 0.0) -> Transform:
        """Make the frame at a height beside a contact, with x along its tangent."""
        found = np.eye(4)
        found[:2, 3] = contact.beside(height)
        found[:2, 0] = contact.tangent
        found[:2, 1] = -contact.tangent[1], contact.tangent[0]
        return self.pose @ found


def profile_plane(name: str, point: Triple, axis: Triple, direction: Triple | None, suffix: str = "") -> ProfilePlane:
    """Make the plane of a profile; `suffix` is that of the names of its arguments. ValueError for traced numbers."""
    if traced(point, axis, direction):
        raise ValueError(
            f"joint {name!r}: the place of a profile is traced, and where the parts touch is found from numbers: make "
            "the joint outside of jit and grad, and move it by mechanism.with_points or with_frames"
        )
    pose = np.asarray(axis_frame(name, point, axis, point_label=f"point{suffix}"))
    if direction is None:
        return ProfilePlane(pose)
    x = ProfilePlane(pose).direction(name, f"direction{suffix}", direction)
    return ProfilePlane(frame(pose[:3, 3], pose[:3, 2], pose[:3, :2] @ x))


def profile_point(curve: PlacedProfile, q: float) -> ProfilePoint:
    """Find the point and the tangent of a profile at a parameter."""
    at = curve.spline.at(np.array(q))
    return ProfilePoint(q, np.array([at.x, at.y], float), np.array([at.cos, at.sin], float))
