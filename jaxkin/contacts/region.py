"""Find the contact region of two faces: where the place at which their unbounded surfaces touch lies on both faces.

For a contact along a line, along a circle or at a point, the triangles of both faces are cut with two parallel planes,
a small length `margin` to either side of it. Where both planes cut both faces, the contact is inside of the faces.
Where only one of the planes cuts a face, the contact is at the rim of that face and is none: the edge of a fillet lies
on the plane next to it, but the fillet does not roll there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from jaxkin.contacts import intervals
from jaxkin.contacts.intervals import Intervals
from jaxkin.contacts.overlap import Overlap, flat, overlap, overlap_on_sphere
from jaxkin.contacts.rim import Difference, chord_height
from jaxkin.contacts.touch import Touch
from jaxkin.contacts.unrolled import shorter_way, turned, unrolled, unrolled_difference
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import Vector, perpendicular
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane, Sphere
from jaxkin.geometry.triangles import Triangles, plane_cut


@dataclass(frozen=True, eq=False)
class ContactRegion:
    """The place where two faces touch, or would touch if there were no gap."""

    centre: Vector
    """Centroid; where the region surrounds an axis, the point of the axis at its height."""
    extent: float
    """Length over which a tilt adds to the gap: that of a line, the diagonal of an area, the height of an area round an
    axis; 0 for a point or a circle."""
    inside: bool
    """False where the faces meet only along an edge of one of them."""


def contact_region(kind: str, touch: Touch, face1: Face, face2: Face, tolerance: float) -> ContactRegion | None:
    """Find the region that two faces share where their surfaces touch; None if they share none.

    `kind` is "surface", "line", "circle" or "point"; `tolerance` is a length.
    """
    match kind:
        case "surface":
            return _surface(touch, face1, face2, tolerance)
        case "line":
            return _line(touch, face1, face2, 4 * tolerance)
        case "circle":
            return _circle(touch, face1, face2, 4 * tolerance)
        case _:
            return _point(touch, face1, face2, 4 * tolerance)


def _surface(touch: Touch, face1: Face, face2: Face, tolerance: float) -> ContactRegion | None:
    """Find the area that two faces on the same surface share."""
    a, b = face1.triangles, face2.triangles
    match face1.surface:
        case Plane():
            x = perpendicular(touch.normal)
            y = np.cross(touch.normal, x)
            shared = overlap(flat(a, touch.point, x, y), flat(b, touch.point, x, y), tolerance)
            if shared is not None:
                centre = touch.point + shared.centre[0] * x + shared.centre[1] * y
                return ContactRegion(centre, shared.extent, _is_wide(shared, a, b, np.subtract, tolerance))
        case Sphere(radius=radius):
            shared = overlap_on_sphere(a, b, touch.point, radius, tolerance)
            if shared is not None:
                return ContactRegion(touch.point, shared.extent, _is_wide(shared, a, b, np.subtract, tolerance))
        case Cylinder() | Cone():
            offset = a.reshape(-1, 3) - touch.point
            radius = float(np.linalg.norm(np.cross(offset, touch.direction), axis=-1).mean())
            charts = [unrolled(triangles, touch.point, touch.direction, radius) for triangles in (a, b)]
            shared = overlap(charts[0], turned(charts[1], radius), tolerance)
            if shared is not None:
                centre = touch.point + shared.centre[1] * touch.direction
                extent = float(np.ptp(shared.box[:, 1]))
                between = partial(unrolled_difference, origin=touch.point, axis=touch.direction, radius=radius)
                return ContactRegion(centre, extent, _is_wide(shared, a, b, between, tolerance))
    return None


def _is_wide(shared: Overlap, a: Triangles, b: Triangles, between: Difference, tolerance: float) -> bool:
    """Check that an overlap is wider than the slivers that noise and chords of two tessellations leave at an edge."""
    width = shared.area / max(shared.extent, tolerance)
    if width > 0.1 * shared.extent:
        return True
    return width > 4 * (tolerance + max(chord_height(a, between), chord_height(b, between)))


def _line(touch: Touch, face1: Face, face2: Face, margin: float) -> ContactRegion | None:
    """Find the pieces of a contact line that lie on both faces."""
    cuts = _cuts(touch, touch.direction, face1, face2, margin)
    for shared, inside in ((_inside(cuts), True), (_at_rim(cuts, margin), False)):
        if intervals.length(shared) > margin:
            centre = touch.point + intervals.centroid(shared) * touch.direction
            return ContactRegion(centre, float(np.ptp(shared)), inside)
    return None


def _point(touch: Touch, face1: Face, face2: Face, margin: float) -> ContactRegion | None:
    """Check whether a contact point lies on both faces: `margin` (a length) to either side along a line."""
    cuts = _cuts(touch, perpendicular(touch.normal), face1, face2, margin)
    around = np.array([[-margin, margin]])
    for shared, inside in ((_inside(cuts), True), (_at_rim(cuts, margin), False)):
        shared = intervals.intersection(shared, around)
        if inside and intervals.length(shared) < 1.999 * margin:  # 2 margins but for rounding
            continue
        if len(shared):
            return ContactRegion(touch.point, 0.0, inside)
    return None


def _circle(touch: Touch, face1: Face, face2: Face, margin: float) -> ContactRegion | None:
    """Find the arcs of a contact circle that lie on both faces, as lengths along the circle."""
    x = perpendicular(touch.direction)
    y = np.cross(touch.direction, x)

    def arcs(face: Face, height: float) -> Intervals:
        """Cut a face with the plane at a height over the circle, and return the arcs as lengths along the circle."""
        segments = _cut(face.triangles, touch.point + height * touch.direction, touch.direction) - touch.point
        angles = np.arctan2(segments @ y, segments @ x)
        angles[:, 1] = angles[:, 0] + shorter_way(angles[:, 1] - angles[:, 0])
        angles.sort(axis=1)
        angles = np.concatenate([angles, angles - 2 * np.pi, angles + 2 * np.pi])
        angles = angles[(angles[:, 1] > -np.pi) & (angles[:, 0] < np.pi)].clip(-np.pi, np.pi)
        return intervals.union(touch.radius * angles, margin)

    cuts = [[arcs(face, side * margin) for side in (-1, 1)] for face in (face1, face2)]
    for shared, inside in ((_inside(cuts), True), (_at_rim(cuts, margin), False)):
        if intervals.length(shared) > margin:
            return ContactRegion(touch.point, 0.0, inside)
    return None


def _cuts(touch: Touch, along: Vector, face1: Face, face2: Face, margin: float) -> list[list[Intervals]]:
    """Cut both faces with two planes to either side of a line through `touch.point` in the direction `along`.

    Returns for each face, and each of the two planes, the intervals cut, as lengths along the line from `touch.point`.
    Of a curved face only the triangles are cut that face the other part.
    """
    across = np.cross(touch.normal, along)
    cuts = []
    for face, normal in ((face1, touch.normal), (face2, -touch.normal)):
        facing = face.surface.normals(face.triangles.mean(axis=1)) @ normal > 0
        segments = [_cut(face.triangles[facing], touch.point + side * margin * across, across) for side in (-1, 1)]
        lengths = [np.sort((segment - touch.point) @ along, axis=1) for segment in segments]
        cuts.append([intervals.union(length, margin / 4) for length in lengths])
    return cuts


def _inside(cuts: list[list[Intervals]]) -> Intervals:
    """Intersect the cuts of both faces with both planes."""
    (a, b), (c, d) = cuts
    return intervals.intersection(intervals.intersection(a, b), intervals.intersection(c, d))


def _at_rim(cuts: list[list[Intervals]], gap: float) -> Intervals:
    """Intersect, for the two faces, the union of their cuts with both planes."""
    first, second = (intervals.union(np.concatenate(sides), gap) for sides in cuts)
    return intervals.intersection(first, second)


def _cut(triangles: np.ndarray, point: Vector, normal: Vector) -> np.ndarray:
    """Compute the segments (k, 2, 3) in which a plane, given by a point and its normal, cuts triangles (_, 3, 3)."""
    heights = (triangles - point) @ normal
    above = heights > 0
    crossed = above.any(axis=1) & ~above.all(axis=1)
    return plane_cut(triangles[crossed], heights[crossed])
