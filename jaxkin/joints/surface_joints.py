"""Joints over surfaces: a point, or a ball, on a surface that is given by points or by a function.

A surface is a grid of points (x, y, z), which a smooth bicubic spline passes (`jaxkin.geometry.patches`), in axes of
its own: their origin is `point`, z is along `axis` and x along `direction`, in world coordinates of the assembled pose.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxkin._arguments import several
from jaxkin._traced import traced
from jaxkin.geometry.curves import ROUNDING
from jaxkin.geometry.pose import inverse
from jaxkin.joints.axis_frame import Triple, axis_frame
from jaxkin.joints.curve_joints import TOUCHES, positive_radius
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.limits import GivenLimits, with_limits_within
from jaxkin.joints.patch_contact import LEAST_POINTS, PlacedPatch, check_closed, nearest_on, placed_patch
from jaxkin.joints.profile_plane import profile_plane

_ENDS_MEET = 1e-6
"""Distance over the size of a surface up to which the ends of a closed one are the same: six digits."""


def surface_points(
    function: Callable[[Any, Any], Any],
    u: Sequence[float | int],
    v: Sequence[float | int],
    *,
    closed: Sequence[bool] = (False, False),
    samples: Sequence[int] = (40, 40),
) -> Float[np.ndarray | jax.Array, "m n 3"]:
    """Sample a surface that is given as a function, for `jk.point_on_surface(..., surface=points)`.

    `function(u, v)` is called once, with two arrays of shape (m, n), and returns x, y and z, each an array of that
    shape or a number. `u` and `v` are the intervals (from, to); of a coordinate that is `closed` the end is the
    beginning again, and is left out. `samples` are m and n. Of a traced function, as inside `jax.grad`, the points are
    traced, for `mechanism.with_points`.

    Raises ValueError for intervals and numbers of samples that are none, for a function that returns something else,
    and for the ends of a closed surface that do not meet.
    """
    pair = check_closed("surface_points", closed)
    grid, counts = [], several(samples, "surface_points: samples", "two whole numbers", "(40, 40)")
    if len(counts) != 2:
        raise ValueError(f"surface_points: samples must be two whole numbers, of u and v, got {samples!r}")
    for label, ends, count, joined in zip("uv", (u, v), counts, pair, strict=True):
        if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < LEAST_POINTS:
            raise ValueError(
                f"surface_points: samples must be two whole numbers of {LEAST_POINTS} or more, got {samples}"
            )
        try:
            low, high = (float(end) for end in ends)
        except (TypeError, ValueError):
            low = high = np.nan
        if not (np.isfinite([low, high]).all() and low != high):
            raise ValueError(
                f"surface_points: {label} must be an interval (from, to), such as (0.0, 1.0), got {ends!r}"
            )
        grid.append(np.linspace(low, high, count + joined))
    at = np.meshgrid(*grid, indexing="ij")
    try:
        found = tuple(function(*at))
        xp = jnp if traced(found) else np
        x, y, z = (xp.broadcast_to(xp.asarray(each, float), at[0].shape) for each in found)
    except (TypeError, ValueError) as error:
        raise ValueError(
            "surface_points: the function of the surface must take arrays of u and v and return three arrays x, y, z "
            f"of their shape {at[0].shape}, as lambda u, v: (u, v, u * v) does: {error}"
        ) from error
    points = xp.stack([x, y, z], axis=-1)
    if any(pair) and xp is np:
        size = float(np.linalg.norm(np.ptp(points.reshape(-1, 3), axis=0)))
        for axis, label in enumerate("uv"):
            rows = np.moveaxis(np.asarray(points), axis, 0)
            apart = float(np.linalg.norm(rows[-1] - rows[0], axis=-1).max())
            if pair[axis] and not apart <= _ENDS_MEET * size:
                raise ValueError(
                    f"surface_points: closed along {label}, but the ends of its interval are {apart:.3g} apart: give "
                    "an interval of one whole period, or leave it open"
                )
    return points[: samples[0], : samples[1]]


def point_on_surface(
    name: str,
    part1: str,
    part2: str,
    *,
    surface: Any,
    point2: Triple,
    radius: float | int | None = None,
    closed: Any = (False, False),
    point: Triple = (0.0, 0.0, 0.0),
    axis: Triple = (0.0, 0.0, 1.0),
    direction: Triple | None = None,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a point of part 2, or the centre of a ball of it, that stays on, or over, a surface of part 1.

    `surface` is a grid of points (x, y, z), an array of shape (m, n, 3), that the surface passes, in axes with their
    origin in `point`, z along `axis` and x along `direction` (by default x of the world for the z axis);
    `jk.surface_points` samples a function. `closed` says whether it goes on from its last row to its first one, along u
    and along v. `point2` is the point as assembled, or the centre of a ball of the given `radius`, which touches on the
    side where the centre is. Part 2 turns about it freely. Coordinates: u and v, how far the contact is along the
    surface, in mean lengths of the chords between its points, and theta, phi, psi, the turn of part 2. The edges of an
    open surface are limits of u and v.

    A point that is not on the surface, or a ball that does not touch it, by more than rounding, leaves the mechanism
    open: `mechanism.close()` closes it. `jk.curve_contacts(motion)` tells where edges are passed and where a ball does
    not fit. The table of joints says how far the spline is off between the points, estimated from its third
    derivatives. Raises ValueError for fewer than four points along u or v, equal or infinite ones, surfaces without a
    normal, and directions that are not across the axis.
    """
    plane = profile_plane(name, point, axis, direction)
    placed = placed_patch(name, surface, closed)
    centre = np.asarray(axis_frame(name, point2, (0.0, 0.0, 1.0), point_label="point2"), float)[:3, 3]
    given = (inverse(plane.pose) @ np.array([*centre, 1.0]))[:3]
    contact, height = nearest_on(placed, given), None
    if radius is not None:
        size = positive_radius(name, radius, "a ball")
        height = np.asarray(size if contact.normal @ (given - contact.point) >= 0 else -size)
    at = contact.point + (0.0 if height is None else float(height)) * contact.normal
    misfit = float(np.linalg.norm(given - at))
    beside = np.eye(4)
    beside[:3, 3] = at
    begin = plane.pose @ beside
    end = begin.copy()
    touches = misfit <= TOUCHES * placed.size
    if not touches:
        end[:3, 3] = centre
    over = replace(placed.patch, height=height).counted_from(contact.u, contact.v)
    made = Joint(
        name,
        (part1, part2),
        JointKind.POINT_ON_SURFACE,
        ("T_uv", "T_theta_phi_psi"),
        np.stack([begin, begin]),
        np.stack([begin, end]),
        np.zeros(()),
        _known_from(placed, misfit if touches else 0.0),
        curves=(over, None),
    )
    spline = placed.spline
    edges = {
        label: (-q, float(knots[-1]) - q)
        for label, q, knots, joined in zip("uv", (contact.u, contact.v), spline.knots, spline.closed, strict=True)
        if not joined
    }
    return with_limits_within(made, edges, limits)


def _known_from(placed: PlacedPatch, misfit: float) -> Evidence:
    """Tell how far the spline is off between its points, and how far what touches was moved onto it."""
    between = placed.between
    sizes, said = [("between points", between)], [f"spline within about {between:.1g} between its points"]
    if misfit > ROUNDING * placed.size:
        sizes.append(("moved", misfit))
        said.append(f"moved by {misfit:.1g} to touch the surface")
    return Evidence(EvidenceKind.USER, tuple(sizes), ", ".join(said))
