"""Gaps between two convex polygons of which one moves in the plane, over many poses (separating axes).

Two convex polygons are apart exactly where a line along an edge of one of them separates them. The farthest corner in a
direction is found by bisection, since the normals of the edges of a convex polygon are in order. Most poses need no
search: their corners are hardly elsewhere than at a pose near by at which the polygons overlap by more.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from jaxkin.contacts.rim import CORNER

EVEN = 2.5
"""Chords of one arc differ in length by less than this factor; an edge much longer than its neighbours is straight."""
STRIDE = 64
"""Poses of which one is searched at once, and decides the others if it can: most of a long range, one for each."""
CHUNK = 20_000
"""Poses that are searched together: bounds the memory to some tens of megabytes for a hundred corners."""


class PlaneMotion(NamedTuple):
    """Displacements of a plane chart in another one."""

    turn: Float[np.ndarray, "2 poses"]
    """Cosine and sine of the angle."""
    shift: Float[np.ndarray, "2 poses"]
    """Of the origin."""

    def inverse(self) -> PlaneMotion:
        """How the other chart moves, seen from this one."""
        cos, sin = self.turn
        x, y = self.shift
        return PlaneMotion(np.stack([cos, -sin]), np.stack([-cos * x - sin * y, sin * x - cos * y]))

    def of(self, point: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2 poses"]:
        """Where a point of the chart is in the other one."""
        (cos, sin), (x, y) = self.turn, point
        return np.stack([cos * x - sin * y, sin * x + cos * y]) + self.shift

    def at(self, poses: Int[np.ndarray, " _"]) -> PlaneMotion:
        """At some of the poses."""
        return PlaneMotion(self.turn[:, poses], self.shift[:, poses])


@dataclass(frozen=True, eq=False)
class Hull:
    """A convex polygon; a segment or a point too."""

    corners: Float[np.ndarray, "corners 2"]
    """Anticlockwise."""
    slack: float
    """Length by which what it was made of may stand out of it: curved rims over their chords."""

    @property
    def edges(self) -> Float[np.ndarray, "corners 2"]:
        """From each corner to the next one."""
        return np.roll(self.corners, -1, axis=0) - self.corners

    def normals(self) -> tuple[Float[np.ndarray, " edges"], Float[np.ndarray, " edges"]]:
        """Angle of the outward normal of each edge, in [-pi, pi), and the height of the edge along it."""
        edges = self.edges[np.any(self.edges != 0, axis=1)]
        angles = np.arctan2(-edges[:, 0], edges[:, 1])
        return angles, self.corners[: len(edges), 0] * np.cos(angles) + self.corners[: len(edges), 1] * np.sin(angles)


def hull(points: Float[np.ndarray, "points 2"]) -> Hull | None:
    """The convex hull of points; None where they have none, being on a line but for rounding."""
    from scipy.spatial import ConvexHull, QhullError

    if len(points) < 3:
        return Hull(points, 0.0)
    try:
        corners = points[ConvexHull(points).vertices]
    except QhullError:
        return None
    return Hull(corners, _chord_height(corners))


def gaps_between_hulls(one: Hull, other: Hull, motion: PlaneMotion) -> Float[np.ndarray, " poses"]:
    """Lengths by which hulls are apart, the second one moved; negative where they overlap, or do within their slacks.

    A gap is measured across the line that separates the hulls most; from corner to corner they are a little farther
    apart. Negative ones are upper bounds: it grows between two poses by no more than a corner moves.
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
    """The largest distance by which one of two hulls is beyond an edge of the other; negative where they overlap."""
    return np.maximum(_beyond(one, other, motion), _beyond(other, one, motion.inverse()))


def _beyond(one: Hull, other: Hull, motion: PlaneMotion) -> Float[np.ndarray, " poses"]:
    """The largest distance by which the second hull is beyond an edge of the first one."""
    angles, heights = one.normals()
    if not len(angles):
        return np.full(motion.shift.shape[1], -np.inf)
    turned = angles[:, None] - np.arctan2(motion.turn[1], motion.turn[0])
    places = np.cos(angles)[:, None] * motion.shift[0] + np.sin(angles)[:, None] * motion.shift[1]
    return np.max(places - _farthest(other, turned + np.pi) - heights[:, None], axis=0)


def _farthest(one: Hull, angles: Float[np.ndarray, "edges poses"]) -> Float[np.ndarray, "edges poses"]:
    """How far a hull reaches in the directions at some angles."""
    normals, _ = one.normals()
    corners = one.corners
    if len(normals) > 1:  # corner k lies between the normals of the edges k - 1 and k
        order = np.argsort(normals)
        place = np.searchsorted(normals[order], (angles + np.pi) % (2 * np.pi) - np.pi)
        corners = corners[order[place % len(order)]]
    return corners[..., 0] * np.cos(angles) + corners[..., 1] * np.sin(angles)


def _chord_height(corners: Float[np.ndarray, "corners 2"]) -> float:
    """How far a curved rim stands out of the chords that a hull has of it: twice the height of an arc, to be safe.

    The chord of an arc is an edge that hardly turns against a neighbour that is not much shorter. An arc of one chord
    shows half of its turn at either end: hence twice.
    """
    edges = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(edges, axis=-1)
    angle = np.arctan2(edges[:, 1], edges[:, 0])
    turn = (np.roll(angle, -1) - angle + np.pi) % (2 * np.pi) - np.pi  # at the end of each edge
    height = 0.0
    for turns, neighbour in ((turn, np.roll(length, -1)), (np.roll(turn, 1), np.roll(length, 1))):
        chord = (np.abs(turns) < CORNER) & (length < EVEN * neighbour)
        height = max(height, float(np.max(np.where(chord, length * np.abs(turns) / 4, 0.0), initial=0.0)))
    return height
