"""Where joints along curves and over surfaces could not be what they are: undercut, in the way, past an end.

A joint along a curve keeps one point of contact, as the paper's contacts are kept (assumption 4), and all its poses
are CLOSED. A real follower cannot pass through the profile beside that point, and a curve ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float

from jaxkin._arguments import check_known, check_motion
from jaxkin.effects.curve_contact import CurveContact, CurveContacts, CurveFit, CurvePlace, PerPose, made_contact
from jaxkin.effects.surface_contact import contacts_on_surface
from jaxkin.geometry.curves import CurvePoint, Spline, sampled_pieces
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import BicubicSpline
from jaxkin.joints.joint import Joint

if TYPE_CHECKING:
    from jaxkin.mechanism.motion import Motion

SAMPLES = 8
"""Samples of each piece of a profile: what is in the way of a follower is longer than an eighth of a piece."""


def curve_contacts(motion: Motion) -> CurveContacts:
    """Check at each closed pose of a motion whether followers of curves and surfaces fit there.

    A roller must not meet its profile anywhere but at the contact, nor be larger than a hollow of the profile (undercut
    of the pitch curve), nor a ball its surface (looked for at samples of the surface); a flat face must have all of the
    profile on one side; of two curves that touch neither may pass through the other (not known of an open one of part
    1, and said). A point passes everywhere. No follower may leave the ends of an open curve or surface. Only the
    profiles of each joint are looked at; `jk.clashes` looks at the solids. Raises ValueError for a mechanism
    without joints along curves or over surfaces, and inside `jit`, `vmap` and `grad`.
    """
    check_motion(motion, "contacts of curves")
    check_known("contacts of curves", "jk.curve_contacts", motion)
    found = []
    closed = np.asarray(motion.on_branch)
    for joint, q in zip(motion.mechanism.all_joints, motion.displacements, strict=True):
        if joint.curves:
            found += _of_joint(joint, np.where(closed[:, None], np.asarray(q, float), np.nan))
    if not found:
        raise ValueError("the mechanism has no joints along curves or over surfaces, such as jk.cam")
    return CurveContacts(motion, tuple(found), motion.mechanism.unit)


def _of_joint(joint: Joint, q: Float[np.ndarray, "poses freedoms"]) -> list[CurveContact]:
    """Check what follows the curve or surface of one joint; coordinates of the plane are those of the curve's frame.

    `q` are the displacements of the joint at each pose, NaN where it is not closed. A surface has two contacts,
    one along each of its coordinates, and so have two curves.
    """
    spline, second = joint.splines[0], joint.splines[-1]
    if isinstance(spline, BicubicSpline):
        return contacts_on_surface(joint.name, spline, q)
    assert isinstance(spline, Spline)  # what a joint with curves follows first
    if isinstance(second, Spline):
        return _of_two(joint, spline, second, q)
    finite = np.isfinite(q[:, 0])
    at = spline.at(np.where(finite, q[:, 0], 0.0))
    curve = _sampled(spline)
    size = float(np.linalg.norm(np.ptp(curve, axis=0)))
    between = np.linalg.inv(np.asarray(joint.frames_1, float)[0]) @ np.asarray(joint.frames_1, float)[1]
    height = float(between[1, 3])
    bend = at.turning / np.hypot(at.dx, at.dy)
    contact, normal = np.stack([at.x, at.y], 1), np.stack([-at.sin, at.cos], 1)
    depth = np.zeros(len(q))
    if MOVEMENTS[joint.movements[-1]].only_slides:
        what = "a flat face"
        home = spline.at(0.0)
        side = -np.sign(np.mean((curve - [home.x, home.y]) @ [-home.sin, home.cos])) or 1.0
        for pose in np.flatnonzero(finite):
            depth[pose] = (side * ((curve - contact[pose]) @ normal[pose])).max()
        clearance = -side * bend * size
    elif height:
        what, side = "a roller", float(np.sign(height))
        for pose in np.flatnonzero(finite):
            centre = contact[pose] + height * normal[pose]
            depth[pose] = abs(height) - np.linalg.norm(curve - centre, axis=1).min()
        clearance = 1.0 - height * bend
    else:
        what, side, clearance = "a point", -1.0, np.ones(len(q))
    return [_contact(joint.name, what, spline, q[:, 0], CurveFit(-side * bend, clearance, depth, size))]


def _of_two(joint: Joint, one: Spline, other: Spline, q: Float[np.ndarray, "poses freedoms"]) -> list[CurveContact]:
    """Check two curves that touch; coordinates of the plane are those of the frame of the first one."""
    finite = np.isfinite(q).all(axis=1)
    a, b = (spline.at(np.where(finite, q[:, k], 0.0)) for k, spline in enumerate((one, other)))
    curve, second = _sampled(one), _sampled(other)
    size = min(float(np.linalg.norm(np.ptp(each, axis=0))) for each in (curve, second))
    frames = np.asarray(joint.frames_1, float)
    # the second curve runs along the first one at the contact, or against it
    along = float(np.sign(frames[0, :3, 0] @ frames[1, :3, 0]))
    bends = a.turning / np.hypot(a.dx, a.dy), along * b.turning / np.hypot(b.dx, b.dy)
    depth, side = np.full(len(q), np.nan), np.nan
    if one.closed:
        from scipy.spatial import KDTree

        tree, sag = KDTree(curve), _sag(one) + _sag(other)
        home = _placed_second(second, one.at(0.0), other.at(0.0), along)
        inside = bool(np.mean(_inside(curve, home)) > 0.5)
        depth[finite] = 0.0
        for pose in np.flatnonzero(finite):
            here, there = (CurvePoint(*(values[pose] for values in each)) for each in (a, b))
            points = _placed_second(second, here, there, along)
            wrong = points[_inside(curve, points) != inside]
            if len(wrong):
                nearest = np.asarray(tree.query(wrong)[1])
                depth[pose] = max(0.0, float(_from_chords(curve, nearest, wrong).max()) - 2 * sag)
        area = float(np.sum(curve[:, 0] * np.roll(curve[:, 1], -1) - curve[:, 1] * np.roll(curve[:, 0], -1)))
        side = np.sign(area) * (1.0 if inside else -1.0)  # +1 where the second part is to the left of the first curve
    shared = CurveFit(-side * bends[0], side * (bends[1] - bends[0]) * size, depth, size)
    own = CurveFit(side * bends[1], np.ones(len(q)), np.zeros(len(q)), size)
    return [
        _contact(joint.name, "a curve", one, q[:, 0], shared),
        _contact(joint.name, "a curve", other, q[:, 1], own),
    ]


def _contact(joint: str, what: str, spline: Spline, q: PerPose, fit: CurveFit) -> CurveContact:
    """Make the contact of a curve at displacements `q`, which are counted from its place in the assembled pose."""
    place = CurvePlace(float(spline.start) + q, float(spline.knots[-1]), spline.closed)
    return made_contact(joint, what, "curve", place, fit)


def _sampled(spline: Spline) -> Float[np.ndarray, "samples 2"]:
    """Evaluate a curve at SAMPLES places of each piece, and at the end of an open one."""
    at = spline.at(sampled_pieces(spline.knots, spline.closed, SAMPLES) - spline.start)
    return np.stack([at.x, at.y], axis=1)


def _sag(spline: Spline) -> float:
    """Bound how far a curve is from the chords between its samples."""
    at = spline.at(spline.knots[:-1] - spline.start)
    chords = np.diff(spline.knots) / SAMPLES
    return float(np.max(np.abs(at.turning) * chords**2 / 8))


def _placed_second(points: np.ndarray, a: CurvePoint, b: CurvePoint, along: float) -> Float[np.ndarray, "samples 2"]:
    """Place points in axes of the second curve where it touches the first one at `a`, at its own point `b`."""
    x, y = points[:, 0] - b.x, points[:, 1] - b.y
    along_tangent, across = along * (b.cos * x + b.sin * y), along * (b.cos * y - b.sin * x)
    return np.stack(
        [a.x + a.cos * along_tangent - a.sin * across, a.y + a.sin * along_tangent + a.cos * across], axis=1
    )


def _from_chords(curve: np.ndarray, nearest: np.ndarray, points: np.ndarray) -> Float[np.ndarray, " points"]:
    """Measure how far points are from the chords of a closed curve that meet at its sample `nearest` to each.

    The samples alone would not do: between two of them a point on the curve is half a chord from either.
    """
    found = np.full(len(points), np.inf)
    for after in (0, 1):
        begin, end = (curve[(nearest + k) % len(curve)] for k in (after - 1, after))
        chord = end - begin
        share = np.sum((points - begin) * chord, axis=1) / np.sum(chord**2, axis=1)
        foot = begin + np.clip(share, 0.0, 1.0)[:, None] * chord
        found = np.minimum(found, np.linalg.norm(points - foot, axis=1))
    return found


def _inside(polygon: np.ndarray, points: np.ndarray) -> Bool[np.ndarray, " points"]:
    """Tell which points are inside a polygon, by the crossings of a ray."""
    (x0, y0), (x1, y1) = polygon.T, np.roll(polygon, -1, axis=0).T
    x, y = points[:, :1], points[:, 1:]
    spans = (y0 > y) != (y1 > y)
    slope = np.where(y1 == y0, 1.0, y1 - y0)
    return np.sum(spans & (x < x0 + (y - y0) * (x1 - x0) / slope), axis=1) % 2 == 1
