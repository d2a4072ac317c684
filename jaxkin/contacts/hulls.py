"""Compute the gap between two convex polygons, of which one moves in the plane, over many poses (separating axes).

Two convex polygons are apart exactly if a line along an edge of one of them separates them. The farthest corner in a
direction is found by bisection, since the edge normals of a convex polygon are ordered by angle. Most poses need no
search: if the polygons overlap at a neighbouring pose by more than the corners move in between, they overlap there too.
A chart is a plane with its own origin and axes x, y.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from jaxkin.contacts.rim import CORNER, numbered

EVEN = 2.5
"""Largest ratio of the lengths of neighbouring chords of one arc; an edge that is longer is straight."""
ALIKE = 1.0 + EVEN
"""Largest ratio of two successive turns along one arc. A turn is half of the arcs on its two sides: beside an arc a, of
which the next one is `EVEN` a at most, they are a and a + `EVEN` a, over two, where the arc leaves its tangent."""
FEW_CHORDS = CORNER / 2
"""Largest turn, radians, that is taken for that of an arc of one or two chords, of which no second turn is seen: chords
of tessellated files turn by 0.35 at most, and flats by more, as chamfers of 30 degrees do."""
STRIDE = 64
"""Every pose with a number divisible by this is searched first, and may decide the poses around it."""
CHUNK = 20_000
"""Number of poses searched together: bounds the memory to some tens of megabytes for a hundred corners."""


class PlaneMotion(NamedTuple):
    """Displacements of a moving chart relative to a fixed one: rotation, then translation."""

    turn: Float[np.ndarray, "2 poses"]
    """Cosine and sine of the angle of rotation."""
    shift: Float[np.ndarray, "2 poses"]
    """Translation of the origin, lengths."""

    def inverse(self) -> PlaneMotion:
        """Return the motion of the fixed chart relative to the moving one."""
        cos, sin = self.turn
        x, y = self.shift
        return PlaneMotion(np.stack([cos, -sin]), np.stack([-cos * x - sin * y, sin * x - cos * y]))

    def of(self, point: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2 poses"]:
        """Map a point of the moving chart to the fixed one."""
        (cos, sin), (x, y) = self.turn, point
        return np.stack([cos * x - sin * y, sin * x + cos * y]) + self.shift

    def at(self, poses: Int[np.ndarray, " _"]) -> PlaneMotion:
        """Select some of the poses, by their numbers."""
        return PlaneMotion(self.turn[:, poses], self.shift[:, poses])


@dataclass(frozen=True, eq=False)
class Hull:
    """A convex polygon, or a segment (two corners) or a point (one)."""

    corners: Float[np.ndarray, "corners 2"]
    """Anticlockwise."""
    slack: float
    """Length by which the face may extend beyond the polygon, since its curved rim is replaced by chords."""

    @property
    def edges(self) -> Float[np.ndarray, "corners 2"]:
        """The vectors from each corner to the next one."""
        return np.roll(self.corners, -1, axis=0) - self.corners

    def normals(self) -> tuple[Float[np.ndarray, " edges"], Float[np.ndarray, " edges"]]:
        """Compute for each edge the angle of its outward normal, in [-pi, pi], and the edge's distance from the origin
        along this normal."""
        edges = self.edges[np.any(self.edges != 0, axis=1)]
        angles = np.arctan2(-edges[:, 0], edges[:, 1])
        return angles, self.corners[: len(edges), 0] * np.cos(angles) + self.corners[: len(edges), 1] * np.sin(angles)


def hull(points: Float[np.ndarray, "points 2"], of_triangles: bool = False) -> Hull | None:
    """Compute the convex hull of points; None for three or more points on one line, but for rounding.

    Points of `of_triangles` are corners of triangles, three each: then an edge of the hull that is none of a triangle
    spans a notch of their rim, and is no chord of it.
    """
    from scipy.spatial import ConvexHull, QhullError

    if len(points) < 3:
        return Hull(points, 0.0)
    try:
        vertices = ConvexHull(points).vertices
    except QhullError:
        return None
    on_rim = _are_edges(points, vertices) if of_triangles else np.ones(len(vertices), bool)
    return Hull(points[vertices], _chord_height(points[vertices], on_rim))


def gaps_between_hulls(one: Hull, other: Hull, motion: PlaneMotion) -> Float[np.ndarray, " poses"]:
    """Compute the gap between two hulls at each pose: a length, negative where they overlap or may do so.

    `motion` moves the chart of `other` relative to that of `one`. A positive gap is the width of the widest strip
    between the hulls along an edge, less both slacks; from corner to corner the hulls may be farther apart. A negative
    gap is only an upper bound: that at a neighbouring pose plus the largest movement of a corner in between.
    """
    slack, poses = one.slack + other.slack, motion.shift.shape[1]
    known = np.arange(0, poses, STRIDE)
    near = np.minimum((np.arange(poses) + STRIDE // 2) // STRIDE, len(known) - 1)
    middle = other.corners.mean(axis=0)
    radius = np.linalg.norm(other.corners - middle, axis=1).max()
    places, turns = motion.of(middle), motion.turn
    steps = np.linalg.norm(places - places[:, known[near]], axis=0)
    steps += radius * np.linalg.norm(turns - turns[:, known[near]], axis=0)
    gaps = _widest(one, other, motion.at(known))[near] + steps - slack
    (undecided,) = np.nonzero(gaps > 0)
    for some in np.array_split(undecided, -(-len(undecided) // CHUNK) or 1):
        gaps[some] = _widest(one, other, motion.at(some)) - slack
    return gaps


def _widest(one: Hull, other: Hull, motion: PlaneMotion) -> Float[np.ndarray, " poses"]:
    """Compute the width of the widest strip between two hulls along an edge of either; negative where they overlap."""
    return np.maximum(_beyond(one, other, motion), _beyond(other, one, motion.inverse()))


def _beyond(one: Hull, other: Hull, motion: PlaneMotion) -> Float[np.ndarray, " poses"]:
    """Compute the width of the widest strip between two hulls along an edge of the first; -inf where it has no edge."""
    angles, heights = one.normals()
    if not len(angles):
        return np.full(motion.shift.shape[1], -np.inf)
    turned = angles[:, None] - np.arctan2(motion.turn[1], motion.turn[0])
    places = np.cos(angles)[:, None] * motion.shift[0] + np.sin(angles)[:, None] * motion.shift[1]
    return np.max(places - _farthest(other, turned + np.pi) - heights[:, None], axis=0)


def _farthest(one: Hull, angles: Float[np.ndarray, "edges poses"]) -> Float[np.ndarray, "edges poses"]:
    """Compute the largest coordinate of the corners of a hull along directions at given angles (support function)."""
    normals, _ = one.normals()
    corners = one.corners
    if len(normals) > 1:  # corner k lies between the normals of the edges k - 1 and k
        order = np.argsort(normals)
        place = np.searchsorted(normals[order], (angles + np.pi) % (2 * np.pi) - np.pi)
        corners = corners[order[place % len(order)]]
    return corners[..., 0] * np.cos(angles) + corners[..., 1] * np.sin(angles)


def _are_edges(corners: Float[np.ndarray, "corners 2"], vertices: Int[np.ndarray, " hull"]) -> np.ndarray:
    """Tell for each edge of a hull, from a vertex to the next one, whether it is one of a triangle: (hull,)."""
    numbers = numbered(corners)
    triangles = numbers.reshape(-1, 3)
    of_triangles = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    of_hull = np.stack([numbers[vertices], np.roll(numbers[vertices], -1)], axis=-1)
    one, other = (np.sort(each, axis=1) @ [numbers.max() + 1, 1] for each in (of_hull, of_triangles))
    return np.isin(one, other)


def _chord_height(corners: Float[np.ndarray, "corners 2"], on_rim: Bool[np.ndarray, " corners"]) -> float:
    """Bound how far a curved rim extends beyond the edges of a hull that are its chords: a length.

    An edge is a chord if the rim turns by less than `CORNER` at one of its ends, the neighbour there is not much
    shorter (`EVEN`), and the rim turns alike at the next vertex on one side, as an arc does. Where its other end is a
    corner, it may be all of an arc, if it turns little. An arc of length l that turns by t is l t / 8 high over
    its chord; l t / 4 is returned, since at the ends of an arc with a single chord only half of its turn is seen.
    """
    edges = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(edges, axis=-1)
    angle = np.arctan2(edges[:, 1], edges[:, 0])
    turn = np.abs((np.roll(angle, -1) - angle + np.pi) % (2 * np.pi) - np.pi)  # at the end of each edge
    turn = np.where(on_rim & np.roll(on_rim, -1), turn, np.pi)  # an arc ends where the hull leaves the rim
    height = 0.0
    for onward in (1, -1):
        here, other = (turn, np.roll(turn, 1)) if onward == 1 else (np.roll(turn, 1), turn)
        beyond = np.roll(here, -onward)
        arc = _alike(here, other) | _alike(here, beyond) | ((other >= CORNER) & (here < FEW_CHORDS))
        chord = arc & (here < CORNER) & (length < EVEN * np.roll(length, -onward))
        height = max(height, float(np.max(np.where(chord, length * here / 4, 0.0), initial=0.0)))
    return height


def _alike(turn: np.ndarray, next_one: np.ndarray) -> np.ndarray:
    """Tell where two successive turns may be those of one arc."""
    return (next_one < CORNER) & (turn <= ALIKE * next_one) & (next_one <= ALIKE * turn)
