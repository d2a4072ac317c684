"""Where a point or a ball could not be over its surface: narrow hollows, the surface in the way, edges passed."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from jaxkin.effects.curve_contact import CurveContact, CurveFit, CurvePlace, PerPose, made_contact
from jaxkin.geometry.curves import sampled_pieces
from jaxkin.geometry.patches import BicubicSpline
from jaxkin.joints.patch_contact import SAMPLES


def contacts_on_surface(
    joint: str, spline: BicubicSpline, q: Float[np.ndarray, "poses freedoms"]
) -> list[CurveContact]:
    """Check what follows a surface at each pose: a contact for u, with all that is wrong, and one for v with its edges.

    `q` are the coordinates of the joint, u and v first, NaN where the pose is not closed.
    """
    finite = np.asarray(np.isfinite(q[:, :2]).all(axis=1))
    at = np.where(finite[:, None], q[:, :2], 0.0).T
    u, v = (sampled_pieces(knots, closed, SAMPLES) for knots, closed in zip(spline.knots, spline.closed, strict=True))
    begin_u, begin_v = map(float, spline.start)
    found = spline.derivatives(u[:, None] - begin_u, v[None] - begin_v).point
    points = np.stack(np.broadcast_arrays(*found), axis=-1).reshape(-1, 3)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    height = 0.0 if spline.height is None else float(spline.height)
    low, high = _principal(spline, at)
    # the normal points to where the centre is for a positive height, and a surface that bends towards it is positive
    towards = -low if height < 0 else high
    depth, clearance = np.zeros(len(q)), np.ones(len(q))
    if height:
        from scipy.spatial import KDTree

        clearance = 1.0 - abs(height) * towards
        place = spline.at(*at)
        depth = abs(height) - np.asarray(KDTree(points).query(np.stack([place.x, place.y, place.z], axis=1))[0])
    what = "a ball" if height else "a point"
    fits = {
        "u": CurveFit(-towards, clearance, depth, size),
        "v": CurveFit(np.zeros(len(q)), np.ones(len(q)), np.zeros(len(q)), size),
    }
    contacts = []
    for k, (label, fit) in enumerate(fits.items()):
        s = np.where(finite, q[:, k], np.nan) + float(spline.start[k])
        place = CurvePlace(s, float(spline.knots[k][-1]), spline.closed[k])
        contacts.append(made_contact(joint, what, f"surface along {label}", place, fit))
    return contacts


def _principal(spline: BicubicSpline, at: Float[np.ndarray, "2 poses"]) -> tuple[PerPose, PerPose]:
    """Compute the principal curvatures, least first, positive where the surface bends towards its normal u x v."""
    found = spline.derivatives(*at)
    u, v, uu, uv, vv = (np.stack(each) for each in found[1:])
    normal = np.cross(u, v, axis=0)
    square = np.sum(normal**2, axis=0)
    e, f, g = (np.sum(a * b, axis=0) for a, b in ((u, u), (u, v), (v, v)))
    ll, m, n = (np.sum(each * normal, axis=0) / np.sqrt(square) for each in (uu, uv, vv))
    mean = (e * n - 2 * f * m + g * ll) / (2 * square)
    root = np.sqrt(np.maximum(mean**2 - (ll * n - m * m) / square, 0.0))
    return mean - root, mean + root
