"""The clearance of two parts along a motion, by their shapes, differentiable by the design."""

from __future__ import annotations

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin._names import nearest
from jaxkin.design.objective import Extras
from jaxkin.design.shapes import Bar, Shape, Solid
from jaxkin.geometry.closest_points import closest_points, signed_distance
from jaxkin.geometry.rigid import inverse, product
from jaxkin.mechanism.motion import Motion

MAX_PAIRS = 300_000
"""Pairs of triangles of two solids up to which they are compared: 37 poses of as many took 4 s of a processor."""


def clearance(motion: Motion, one: Shape, other: Shape, extras: Extras | None = None) -> Float[Array, " poses"]:
    """Measure how far two shapes of different parts are apart in each pose, a length; below zero where they clash.

    Shapes are `jk.design.bar(...)` and `jk.design.solid(...)`. The clearance is the exact distance of bars, and of the
    triangles of solids, with first derivatives by lengths, points and inputs; these jump where the nearest points do.
    Where axes or triangles cross it is the depth of the deepest of some points: corners, points inside, five points of
    an axis; less the radii.

    Raises ValueError for shapes of one part, for bars that end at the same joint, for names that are not there, and for
    solids of too many triangles.
    """
    check_shapes(one, other, "clearance")
    mechanism, extras = motion.mechanism, extras or {}
    for shape in (one, other):
        if shape.part not in mechanism.parts:
            raise ValueError(f"clearance: there is no part {shape.part!r}{nearest(shape.part, mechanism.parts)}")
    if common := one.joints(mechanism) & other.joints(mechanism):
        raise ValueError(
            f"clearance: bars of {one.part!r} and {other.part!r} both end at the joint {min(common)!r}, where they "
            "always meet: leave this pair out, or let a bar end beside the joint, at a point"
        )
    moved, fixed = sorted((one, other), key=_face_count)  # of the fixed one all elements are looked at in one loop
    if _face_count(moved) * _face_count(fixed) > MAX_PAIRS:
        raise ValueError(
            f"clearance: the solids of {one.part!r} and {other.part!r} have {_face_count(one):,} and "
            f"{_face_count(other):,} triangles, and up to {MAX_PAIRS:,} pairs of these are compared: write hull=True "
            "for one of them or both, or give a simpler mesh that contains it, or bars"
        )
    mesh1, mesh2 = (shape.mesh(mechanism, extras) for shape in (fixed, moved))
    place1, place2 = (jnp.moveaxis(motion.transforms[shape.part][:, :3], 0, -1) for shape in (fixed, moved))
    found = closest_points(mesh1, mesh2, product(inverse(place1), place2))
    return signed_distance(mesh1, mesh2, (place1, place2), found) - one.radius - other.radius


def check_shapes(one: Shape, other: Shape, what: str) -> None:
    """Raise ValueError for what are no shapes of two parts; `what` begins the message."""
    for shape in (one, other):
        if not isinstance(shape, Bar | Solid):
            raise ValueError(f"{what}: shapes are jk.design.bar(...) or jk.design.solid(...), got {shape!r}")
    if one.part == other.part:
        raise ValueError(f"{what}: both shapes are of the part {one.part!r}, give those of two parts")


def _face_count(shape: Shape) -> int:
    return len(shape.faces) if isinstance(shape, Solid) else 0
