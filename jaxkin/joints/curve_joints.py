"""Joints along plane curves: a point, a roller or a flat face on a profile, and a profile on a profile.

A profile is given by points (x, y), which a smooth spline passes (`jaxkin.geometry.curves`), in a plane: its origin and
its axes are `point`, `direction` (x) and `axis` (its normal), in world coordinates of the assembled pose. Parts slide
on each other; nothing rolls.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._names import nearest
from jaxkin.joints.axis_frame import Triple
from jaxkin.joints.evidence import BY_HAND, Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.limits import GivenLimits, with_limits_within
from jaxkin.joints.profile_plane import ProfilePlane, ProfilePoint, profile_plane, profile_point
from jaxkin.joints.profiles import PlacedProfile, check_simple, nearest_to, placed_profile, tangent_to, touching

Profile = Any
"""Points (x, y) of a profile, array-like of shape (n, 2)."""
FOLLOWERS = ("knife", "roller", "flat")
"""What follows a cam: an edge, a round roller, a flat face."""
TOUCHES = 5e-6
"""Distance, over the size of the profile, up to which a follower is moved onto it: the rounding of numbers with six
digits, as of `mobility.alignment.SIX_DIGITS`. A spline through fifty points of a smooth cam is nearer to it."""
_TOLD = 1e-12
"""Distance, over the size of the profile, from which on such a move is told: above rounding."""


def point_on_curve(
    name: str,
    part1: str,
    part2: str,
    *,
    profile: Profile,
    point2: Triple,
    point: Triple = (0.0, 0.0, 0.0),
    axis: Triple = (0.0, 0.0, 1.0),
    direction: Triple | None = None,
    closed: bool = False,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a pin of part 2, through `point2` along the axis, in a curved slot of part 1: a point on a curve.

    `profile` are points (x, y) that the curve passes, in axes with their origin in `point`, z along `axis` and x along
    `direction` (by default some direction across the axis: x of the world for the z axis). A `closed` curve goes on
    from its last point to its first one. Coordinates: s, how far the pin is along the curve, in lengths of the chords
    between its points, and phi, the turn of part 2 against the tangent there. The ends of an open curve are limits of
    s. A pin that is not on the curve, by more than rounding, leaves the mechanism open: `mechanism.close()` closes it.

    Raises ValueError for fewer than four points, equal or infinite ones, and directions that are not in the plane.
    """
    plane = profile_plane(name, point, axis, direction)
    curve = placed_profile(name, "profile", profile, np.zeros(3), closed)
    contact = profile_point(curve, nearest_to(curve, plane.local(name, "point2", point2)))
    made = _follows(name, (part1, part2), JointKind.POINT_ON_CURVE, _OnProfile(plane, curve, contact), 0.0, point2)
    return _with_ends(made, limits)


def cam(
    name: str,
    part1: str,
    part2: str,
    *,
    profile: Profile,
    follower: str,
    point2: Triple,
    radius: float | int | None = None,
    direction2: Triple | None = None,
    point: Triple = (0.0, 0.0, 0.0),
    axis: Triple = (0.0, 0.0, 1.0),
    direction: Triple | None = None,
    closed: bool = True,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make a cam, part 1, with a follower, part 2, that keeps touching its profile.

    `profile`, `point`, `axis`, `direction` and `closed` say where the profile is, as of `point_on_curve`. `point2` is a
    point of the follower as assembled: the edge of a "knife", the centre of a "roller" of the given `radius`, or any
    point of a "flat" face along `direction2`. A roller touches at the point of the profile nearest to its centre, on
    the side where its centre is; a flat face where the tangent is parallel to it, nearest to it. Coordinates: s, how
    far the contact is along the profile, in lengths of the chords between its points, counted on over many turns; and
    phi, the turn of part 2 against the tangent (its changes are those of the pressure angle), or z, how far a flat face
    has slid along the tangent. Part 2 may be the roller itself, on a hinge of the follower.

    A follower that does not touch in the assembled pose, by more than rounding, leaves the mechanism open:
    `mechanism.close()` closes it. `jk.curve_contacts(motion)` tells undercut and where the follower would have to pass
    through the profile. Raises ValueError for a profile that crosses itself, and as `point_on_curve`.
    """
    if follower not in FOLLOWERS:
        known = ", ".join(map(repr, FOLLOWERS))
        raise ValueError(
            f"joint {name!r}: follower must be one of {known}, got {follower!r}{nearest(str(follower), FOLLOWERS)}"
        )
    for label, given, of in (("radius", radius, "roller"), ("direction2", direction2, "flat")):
        if (given is None) == (follower == of):
            what = f"needs {label}" if given is None else f"has no {label}, got {given!r}"
            raise ValueError(f"joint {name!r}: a follower {follower!r} {what}")
    plane = profile_plane(name, point, axis, direction)
    curve = placed_profile(name, "profile", profile, np.zeros(3), closed)
    check_simple(name, "profile", curve)
    at = plane.local(name, "point2", point2)
    if direction2 is not None:
        along = plane.direction(name, "direction2", direction2)
        found = tangent_to(curve, along, at)
        if found is None:
            raise ValueError(
                f"joint {name!r}: no tangent of the profile is parallel to the face, "
                f"direction2={np.asarray(direction2).tolist()}"
            )
        flat = _flat(name, (part1, part2), _OnProfile(plane, curve, profile_point(curve, found)), at)
        return _with_ends(flat, limits)
    contact, size = profile_point(curve, nearest_to(curve, at)), 0.0
    if radius is not None:
        size = positive_radius(name, radius, "a roller")
        size = size if contact.away(at)[1] >= 0 else -size
    made = _follows(name, (part1, part2), JointKind.CAM, _OnProfile(plane, curve, contact), size, point2)
    return _with_ends(made, limits)


def curve_on_curve(
    name: str,
    part1: str,
    part2: str,
    *,
    profile: Profile,
    profile2: Profile,
    point: Triple = (0.0, 0.0, 0.0),
    axis: Triple = (0.0, 0.0, 1.0),
    direction: Triple | None = None,
    closed: bool = True,
    point2: Triple = (0.0, 0.0, 0.0),
    direction2: Triple | None = None,
    closed2: bool = True,
    contact: Triple | None = None,
    limits: GivenLimits | None = None,
) -> Joint:
    """Make two profiles in one plane that keep touching, one of each part, and slide on each other.

    `profile`, `point`, `axis`, `direction` and `closed` are those of part 1, as of `point_on_curve`; `profile2`,
    `point2`, `direction2` and `closed2` those of part 2, with the same axis. They touch in the assembled pose where
    they have a common normal: near `contact`, or without it where they are nearest to each other. Coordinates: s1 and
    s2, how far the contact is along either profile, in lengths of the chords between its points.

    Profiles that do not touch in the assembled pose, by more than rounding, leave the mechanism open:
    `mechanism.close()` closes it. `jk.curve_contacts(motion)` tells where they would pass through each other. Raises
    ValueError for profiles that cross themselves or have no common normal there, and as `point_on_curve`.
    """
    plane, plane2 = profile_plane(name, point, axis, direction), profile_plane(name, point2, axis, direction2, "2")
    tilted = plane.pose[:3, :3].T @ plane2.pose[:3, :3]
    x, y = plane.local(name, "point2", point2)
    place2 = np.array([x, y, np.arctan2(tilted[1, 0], tilted[0, 0])])
    curves = (
        placed_profile(name, "profile", profile, np.zeros(3), closed),
        placed_profile(name, "profile2", profile2, place2, closed2),
    )
    for label, curve in zip(("profile", "profile2"), curves, strict=True):
        check_simple(name, label, curve)
    near = None if contact is None else plane.local(name, "contact", contact)
    found = touching(*curves, near)
    if found is None:
        raise ValueError(
            f"joint {name!r}: the two profiles have no common normal "
            + (f"near contact={np.asarray(contact).tolist()}" if contact is not None else "where they are nearest")
            + "; move a part to where they touch, or give another contact=(x, y, z) near that place"
        )
    one, other = (profile_point(curve, q) for curve, q in zip(curves, found, strict=True))
    misfit = float(one.away(other.point)[1])
    size = min(curve.size for curve in curves)
    touches = abs(misfit) <= TOUCHES * size
    # the second frame has the tangent of the second profile, which may run against that of the first one
    first, second = plane.frame(one), plane.frame(other._replace(point=one.point))
    frames_1, frames_2 = np.stack([first, second]), np.stack([first, second if touches else plane.frame(other)])
    evidence = _moved(misfit, size) if touches else BY_HAND
    made = Joint(
        name,
        (part1, part2),
        JointKind.CURVE_ON_CURVE,
        ("T_s", "T_s_back"),
        frames_1,
        frames_2,
        np.zeros(()),
        evidence,
        curves=tuple(curve.curve.counted_from(q) for curve, q in zip(curves, found, strict=True)),
    )
    return _with_ends(made, limits)


def positive_radius(name: str, radius: Any, of: str) -> float:
    """Return the radius `of` what rolls, such as "a roller"; ValueError for what is no positive number."""
    if isinstance(radius, bool) or not isinstance(radius, int | float | np.number) or not 0 < radius < np.inf:
        raise ValueError(f"joint {name!r}: the radius of {of} must be a positive number, got {radius!r}")
    return float(radius)


class _OnProfile(NamedTuple):
    """Where a follower touches a profile."""

    plane: ProfilePlane
    curve: PlacedProfile
    contact: ProfilePoint


def _follows(
    name: str, parts: tuple[str, str], kind: JointKind, on: _OnProfile, height: float, point2: Triple
) -> Joint:
    """Make a joint whose second part turns about a point at a height beside its profile, `point2` as assembled."""
    plane, curve, contact = on
    given = plane.local(name, "point2", point2)
    misfit = float(np.linalg.norm(given - contact.beside(height)))
    touches = misfit <= TOUCHES * curve.size
    on_curve, beside = plane.frame(contact), plane.frame(contact, height)
    end = beside.copy()
    if not touches:
        end[:3, 3] = (plane.pose @ np.array([*given, 0.0, 1.0]))[:3]
    evidence = _moved(misfit, curve.size) if touches else BY_HAND
    frames_1, frames_2 = np.stack([on_curve, beside]), np.stack([on_curve, end])
    curves = (curve.curve.counted_from(contact.q), None)
    return Joint(name, parts, kind, ("T_s", "T_phi"), frames_1, frames_2, np.zeros(()), evidence, curves=curves)


def _flat(name: str, parts: tuple[str, str], on: _OnProfile, face: Float[np.ndarray, "2"]) -> Joint:
    """Make a cam with a flat follower, whose face passes the point `face` of the plane as assembled."""
    plane, curve, contact = on
    misfit = float(contact.away(face)[1])
    touches = abs(misfit) <= TOUCHES * curve.size
    on_curve, end = plane.frame(contact), plane.frame(contact, 0.0 if touches else misfit)
    turned = np.eye(4)  # z along the tangent, y along the normal
    turned[:3, :3] = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    evidence = _moved(misfit, curve.size) if touches else BY_HAND
    frames_1, frames_2 = np.stack([on_curve, on_curve @ turned]), np.stack([on_curve, end @ turned])
    curves = (curve.curve.counted_from(contact.q), None)
    return Joint(name, parts, JointKind.CAM, ("T_s", "T_z"), frames_1, frames_2, np.zeros(()), evidence, curves=curves)


def _moved(misfit: float, size: float) -> Evidence:
    """Tell how far what touches was moved onto the profile."""
    if abs(misfit) <= _TOLD * size:
        return BY_HAND
    return Evidence(EvidenceKind.USER, (("moved", abs(misfit)),), f"moved by {abs(misfit):.1g} to touch the profile")


def _with_ends(made: Joint, limits: GivenLimits | None) -> Joint:
    """Give a joint its limits; the ends of open curves are limits of the parameter where no others are given."""
    ends, splines = {}, [spline for spline in made.splines if spline is not None]
    names = [name for name in made.coordinates if name[0] == "s"]
    for name, spline in zip(names, splines, strict=True):
        if not spline.closed:
            ends[name] = (-float(spline.start), float(spline.knots[-1] - spline.start))
    return with_limits_within(made, ends, limits)
