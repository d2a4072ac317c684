"""Profiles of joints, drawn as walls, surfaces as plates, and what follows them: pin, roller, flat face, ball."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.curves import Curve
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import BicubicSpline, Patch
from jaxkin.geometry.triangles import Triangles
from jaxkin.joints.joint import Joint

_HEIGHT, _THICKNESS = 3.0, 0.3
"""Height of a wall across the plane of its curve, and half its thickness, over the radius of a drawn bar."""
_PIN = 1.2
"""Radius of a pin that follows a curve, over the radius of a drawn bar: that of a hinge."""
_BALL = 1.4
"""Radius of a ball that is drawn for a point on a surface, over the radius of a drawn bar."""
_PLATE = 0.05
"""Half the thickness of a drawn surface, over the radius of a drawn bar: thin, since what is drawn is its middle."""
_FACE = 0.7
"""Length of a flat face over the size of the profile that it follows."""
_SIDE = 41
"""Rows of corners of a drawn surface along u and v at least: it looks smooth."""
_SEGMENTS = 192
"""Segments of a wall at least: it looks smooth."""


def curve_figures(joint: Joint, radius: float) -> tuple[list[Triangles], list[Triangles]]:
    """Make the walls of the curves of a joint, on their parts, and what follows the curve on part 2.

    In world coordinates of the assembled pose over `radius`, that of a drawn bar.
    """
    from trimesh.creation import box, cylinder, icosphere

    sides: tuple[list[Triangles], list[Triangles]] = [], []
    for number, curve in enumerate(joint.curves):
        if isinstance(curve, Patch):
            sides[0].append(_plate(curve.spline(), np.asarray(joint.frames_1, float)[number], radius))
            size = _BALL if curve.height is None else abs(float(curve.height)) / radius
            ball = icosphere(radius=size)
            ball.apply_translation(np.asarray(joint.frames_2, float)[-1, :3, 3] / radius)
            return sides[0], [ball.triangles]
        if curve is not None:
            second = MOVEMENTS[joint.movements[number]].elements[0].sense < 0
            frames = joint.frames_2 if second else joint.frames_1
            sides[second].append(_wall(curve, np.asarray(frames, float)[number], radius))
    last = joint.movements[-1]
    if MOVEMENTS[last].follows:
        return sides
    pose = np.array(joint.frames_2[-1], float)
    pose[:3, 3] /= radius
    if MOVEMENTS[last].only_slides:
        points = np.asarray(joint.curves[0].points if joint.curves[0] else np.zeros((1, 2)), float)
        length = _FACE * float(np.linalg.norm(np.ptp(points, axis=0))) / radius
        sides[1].append(box(extents=(_HEIGHT, 2 * _THICKNESS, length), transform=pose).triangles)
    else:
        height = float(np.linalg.norm(np.diff(np.asarray(joint.frames_1, float)[:, :3, 3], axis=0))) / radius
        sides[1].append(cylinder(height or _PIN, _HEIGHT, sections=48, transform=pose).triangles)
    return sides


def _plate(spline: BicubicSpline, frame: Float[np.ndarray, "4 4"], radius: float) -> Triangles:
    """Make a thin plate along a surface, both of its sides."""
    u, v = (
        np.linspace(0.0, float(knots[-1]), max(_SIDE, len(knots))) - float(begin)
        for knots, begin in zip(spline.knots, spline.start, strict=True)
    )
    at = spline.derivatives(u[:, None], v[None])
    middle, along_u, along_v = (np.stack(np.broadcast_arrays(*each), axis=-1) for each in at[:3])
    normal = np.cross(along_u, along_v)
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-300)
    faces = []
    for side in (1, -1):
        flat = middle / radius + side * _PLATE * normal
        a, b, c, d = (each.reshape(-1, 3) for each in (flat[:-1, :-1], flat[1:, :-1], flat[1:, 1:], flat[:-1, 1:]))
        for triangle in ((a, b, c), (a, c, d)):
            faces.append(np.stack(triangle[::side], axis=1))
    return np.concatenate(faces) @ frame[:3, :3].T + frame[:3, 3] / radius


def _wall(curve: Curve, frame: Float[np.ndarray, "4 4"], radius: float) -> Triangles:
    """Make a wall of even thickness along a curve, in the plane of its frame."""
    spline = curve.spline()
    count = max(_SEGMENTS, 2 * (len(spline.knots) - 1))
    s = np.linspace(0.0, float(spline.knots[-1]), count + 1) - float(spline.start)
    if curve.closed:
        s = s[:-1]
    at = spline.at(s)
    middle, normal = np.stack([at.x, at.y], 1) / radius, np.stack([-at.sin, at.cos], 1)
    corners = []
    for side, height in ((1, -1), (1, 1), (-1, 1), (-1, -1)):
        flat = middle + side * _THICKNESS * normal
        corners.append(np.column_stack([flat, np.full(len(flat), 0.5 * height * _HEIGHT)]))
    ring = np.stack(corners, axis=1)  # (points, 4 corners, 3)
    begin, end = (ring, np.roll(ring, -1, axis=0)) if curve.closed else (ring[:-1], ring[1:])
    faces = []
    for k in range(4):
        a, b, c, d = begin[:, k], begin[:, (k + 1) % 4], end[:, (k + 1) % 4], end[:, k]
        faces += [np.stack([a, d, b], 1), np.stack([d, c, b], 1)]
    if not curve.closed:
        for cap, order in ((ring[0], (0, 1, 2, 3)), (ring[-1], (3, 2, 1, 0))):
            a, b, c, d = (cap[k] for k in order)
            faces.append(np.array([[a, b, c], [a, c, d]]))
    local = np.concatenate(faces)
    return local @ frame[:3, :3].T + frame[:3, 3] / radius
