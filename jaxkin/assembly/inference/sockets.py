"""Balls in sockets: spheres of two parts about one centre, which fit exactly, with clearance or with interference."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from jaxkin.assembly.inference.axes import MAX_INTERFERENCE, MAX_OFFSET
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import Vector
from jaxkin.geometry.surfaces import Sphere

MAX_BALL_CLEARANCE = 0.1
"""Radial clearance over the radius of the socket, at most."""
MAX_CAPTIVE_CLEARANCE = 0.17
"""The same of a socket that goes round by more than half a sphere: its ball cannot leave it, however loosely it is
printed, as with 0.3 mm in a socket of 1.8."""
MAX_CAPTIVE_OFFSET = 0.1
"""Distance of its centre from that of such a ball beside the clearance, over the radius: a ball of a leaf is drawn
towards the opening by the gap beside the leaf."""
MIN_CAPTIVE = 0.52
"""Share of a whole sphere that such a socket has, at least, as its triangles tell it."""
MIN_SHARE = 0.2
"""Share of a whole sphere that faces of a ball and of its socket have, at least: rounded corners have an eighth."""
SAME_SPHERE = 1e-3
"""Distance between the centres of faces of one sphere, and the difference of their radii, over the radius, at most."""


class SphericalFaces(NamedTuple):
    """Faces of one part on one sphere."""

    part: str
    centre: Vector
    radius: float
    hole: bool
    """Whether the material is outside, as in a socket; otherwise the faces are those of a ball."""
    share: float
    """Of a whole sphere that the faces are."""


class Socket(NamedTuple):
    """A ball in a socket."""

    ball: SphericalFaces
    hole: SphericalFaces

    @property
    def parts(self) -> tuple[str, str]:
        return self.ball.part, self.hole.part

    @property
    def clearance(self) -> float:
        """Radial clearance; negative where the ball is thicker."""
        return self.hole.radius - self.ball.radius

    @property
    def offset(self) -> float:
        """Distance between the centres."""
        return float(np.linalg.norm(self.ball.centre - self.hole.centre))


def sockets(parts: Iterable[Part], clearance: float | None = None) -> list[Socket]:
    """Find the balls of parts that are in sockets of others.

    `clearance` is the largest radial clearance, in the unit of the file; by default MAX_BALL_CLEARANCE times the
    radius of the socket, MAX_CAPTIVE_CLEARANCE times where it keeps its ball.
    """
    spheres = [sphere for part in parts for sphere in _spheres(part)]
    found = []
    for hole in (each for each in spheres if each.hole):
        for ball in (each for each in spheres if not each.hole and each.part != hole.part):
            pair = Socket(ball, hole)
            captive = hole.share >= MIN_CAPTIVE
            loosest = MAX_CAPTIVE_CLEARANCE if captive else MAX_BALL_CLEARANCE
            most = loosest * hole.radius if clearance is None else clearance
            fits = -MAX_INTERFERENCE * hole.radius <= pair.clearance <= most
            off = MAX_CAPTIVE_OFFSET if captive else MAX_OFFSET
            if fits and pair.offset <= max(pair.clearance, 0.0) + off * hole.radius:
                found.append(pair)
    return found


def _spheres(part: Part) -> list[SphericalFaces]:
    """Find the spheres of a part that are no rounded corners."""
    groups: list[tuple[Sphere, float]] = []
    for face in part.faces:
        surface = face.surface
        if isinstance(surface, Sphere):
            share = face.area / (4 * np.pi * surface.radius**2)
            for index, (first, known) in enumerate(groups):
                apart = np.linalg.norm(first.centre - surface.centre) + abs(first.radius - surface.radius)
                if first.side == surface.side and apart <= SAME_SPHERE * first.radius:
                    groups[index] = first, known + share
                    break
            else:
                groups.append((surface, share))
    return [
        SphericalFaces(part.name, sphere.centre, sphere.radius, sphere.side < 0, share)
        for sphere, share in groups
        if share >= MIN_SHARE
    ]
