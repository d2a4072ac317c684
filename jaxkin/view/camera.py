"""From where a mechanism is looked at: along the normal of its plane of motion, or obliquely when it moves in space."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from jaxkin.geometry.part import Part, box_corners
from jaxkin.geometry.pose import Points, Vector, frame, perpendicular, unit
from jaxkin.geometry.triangles import Triangles, double_areas
from jaxkin.view.raster import rasterise

FLAT = 1e-3
"""A motion this much thinner than it is wide is plane: far above rounding, and not to be seen in a picture."""
PREFERENCE = 1.1
"""Another side must show so many times more of the moving parts to be chosen instead of the first."""
THUMBNAIL = 120
"""Pixels across the trial pictures that compare the sides."""

PartTransforms = Mapping[str, Float[np.ndarray, "poses 4 4"]]


@dataclass(frozen=True, eq=False)
class View:
    """An orthographic view of the world."""

    axes: Float[np.ndarray, "3 3"]
    """Rows: unit vectors to the right, upwards and towards the viewer, in world coordinates; right-handed."""
    planar: bool
    """Whether all parts move parallel to the picture."""

    def project(self, points: Points) -> Points:
        """Turn world coordinates into those of the view (right, up, towards the viewer): same unit, same origin."""
        return points @ self.axes.T


def choose_view(parts: Sequence[Part], fixed: Sequence[str], displacements: PartTransforms) -> View:
    """Choose the view that shows most of the moving parts: of the two sides of the plane of motion, or of eight oblique
    ones.

    `displacements` are of closed poses, at least one. A plane of motion that two world axes lie in is drawn with these
    axes to the right and up; any other with the longer side of the fixed parts level and the moving parts above them.
    Depends neither on the unit nor on the origin.
    """
    moving = [part for part in parts if part.name not in fixed]
    corners = {part.name: box_corners(part.box) for part in moving}
    steps = [(move(displacements, name, each) - each).reshape(-1, 3) for name, each in corners.items()]
    normal = _normal(parts, steps)
    if normal is None:
        azimuths, rise = np.deg2rad(np.arange(8) * 45.0 - 60.0), np.deg2rad(30.0)
        outs = [np.array([np.cos(a) * np.cos(rise), np.sin(a) * np.cos(rise), np.sin(rise)]) for a in azimuths]
        up = np.array([0.0, 0.0, 1.0])
    else:
        axis = int(np.argmax(np.abs(normal)))
        aligned = abs(normal[axis]) > 1 - FLAT**2
        out = normal * np.sign(normal[axis]) * (-1 if aligned and axis == 1 else 1)  # x to the right, z up: from -y
        up = np.eye(3)[1 if axis == 2 else 2] if aligned else _upwards(out, parts, moving, fixed, displacements)
        outs = [out, -out]
    views = [View(frame(np.zeros(3), out, np.cross(up, out))[:3, :3].T, normal is not None) for out in outs]
    triangles, owners = _middle(parts, displacements)
    is_moving = np.array([part not in fixed for part in owners])
    merits = [_seen(view, triangles, is_moving) * _spread(view, steps) for view in views]
    best = int(np.argmax(merits))
    return views[best] if merits[best] > PREFERENCE * merits[0] else views[0]


def move(displacements: PartTransforms, part: str, points: Points) -> Float[np.ndarray, "poses *points 3"]:
    """Place points of a part, given where they are in the assembled pose, at all poses: world coordinates."""
    pose = displacements[part]
    turned = np.einsum("pij,...j->p...i", pose[:, :3, :3], np.asarray(points, float))
    return turned + pose[:, :3, 3].reshape(-1, *(1,) * (turned.ndim - 2), 3)


def _normal(parts: Sequence[Part], steps: Sequence[np.ndarray]) -> Vector | None:
    """Find the normal of the plane that everything moves parallel to; None in space.

    Where the motion leaves a choice (along one line, or none at all) it is the normal of most of the flat faces.
    """
    triangles = np.concatenate([part.triangles for part in parts])
    size = np.linalg.norm(np.ptp(triangles, axis=(0, 1)))
    _, widths, directions = np.linalg.svd(np.concatenate([*steps, np.zeros((3, 3))]), full_matrices=False)
    rank = int((widths > max(FLAT * widths[0], 1e-9 * size)).sum())
    if rank >= 2:
        return directions[2] if rank == 2 else None
    faces = double_areas(triangles)
    faces = faces[np.linalg.norm(faces @ directions[:rank].T, axis=1) <= FLAT * np.linalg.norm(faces, axis=1)]
    areas = np.linalg.norm(faces, axis=1, keepdims=True)
    largest = np.take_along_axis(faces, np.abs(faces).argmax(axis=1, keepdims=True), axis=1)
    names = np.round(np.sign(largest) * faces / np.where(areas > 0, areas, 1), 3)  # opposite sides count together
    kinds, kind = np.unique(names, axis=0, return_inverse=True)
    if not len(kinds):
        return perpendicular(directions[0])
    best = np.bincount(kind.ravel(), areas.ravel()).argmax()
    return unit((np.sign(largest) * faces)[kind.ravel() == best].sum(axis=0))


def _upwards(
    out: Vector, parts: Sequence[Part], moving: Sequence[Part], fixed: Sequence[str], displacements: PartTransforms
) -> Vector:
    """Choose the direction across the longer side of the fixed parts (of all, if none is drawn), towards the moving
    ones."""
    from trimesh.bounds import oriented_bounds_2D

    still = [part for part in parts if part.name in fixed]
    corners = np.concatenate([part.triangles.reshape(-1, 3) for part in still or parts])
    plane = frame(np.zeros(3), out)[:3, :2]
    to_rectangle, _ = oriented_bounds_2D(corners @ plane / np.ptp(corners, axis=0).max())  # it has absolute tolerances
    short = plane @ to_rectangle[1, :2]
    if not still or not moving:
        return short * np.sign(short[np.argmax(np.abs(short))])
    middles = [move(displacements, part.name, part.box.mean(axis=0)).mean(axis=0) for part in moving]
    above = (np.mean(middles, axis=0) - corners.mean(axis=0)) @ short
    return short * (1 if above >= 0 else -1)


def _middle(parts: Sequence[Part], displacements: PartTransforms) -> tuple[np.ndarray, list[str]]:
    """Find all triangles at the pose in the middle, and the part that each is of."""
    middle = {name: poses[[len(poses) // 2]] for name, poses in displacements.items()}
    triangles = [move(middle, part.name, part.triangles)[0] for part in parts]
    return np.concatenate(triangles), [part.name for part in parts for _ in part.triangles]


def _spread(view: View, steps: Sequence[np.ndarray]) -> float:
    """Measure how wide a motion in space opens in the view: the geometric mean over the parts of the area that each
    sweeps, so that no path is looked at from its edge if that can be helped."""
    if view.planar:
        return 1.0
    flat = [part @ view.axes[:2].T for part in (np.concatenate(steps), *steps)]
    whole, *areas = (np.sqrt(max(np.linalg.det(part.T @ part / len(part)), 0.0)) for part in flat)
    return float(np.exp(np.mean(np.log(np.array(areas) + 0.01 * whole))))  # some parts may move along a line


def _seen(view: View, triangles: np.ndarray, wanted: np.ndarray) -> int:
    """Count how many pixels of a small picture show a wanted triangle."""
    return int(wanted[thumbnail(view, triangles)].sum())


def thumbnail(view: View, triangles: Triangles) -> Int[np.ndarray, " pixels"]:
    """Draw a small picture: the index of the triangle in front for each of its pixels that shows one."""
    points = view.project(triangles)
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    pixels = (points - low) * (THUMBNAIL / (high - low)[:2].max())
    front = rasterise(pixels, THUMBNAIL, THUMBNAIL).triangle
    return front[front >= 0]
