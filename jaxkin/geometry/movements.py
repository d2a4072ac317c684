"""The paper's allowable movements T_z, T_phi, T_z_phi, T_xy_phi, T_theta_phi, T_theta_phi_psi (Section 3) in JAX.

A movement displaces a local frame. Its coordinates x, y, z are translations along the axes of the frame. In
`T_theta_phi` and `T_theta_phi_psi`, theta, phi, psi are rotations about x, y, z; in the other movements phi is the
rotation about z, as the paper prints it. Each movement is one row of `MOVEMENTS`, the only table that is keyed by
movements. A row holds the movement as a product of elementary motions, from which displacements, screws and
closure equations follow, and all else that depends on the movement. `T_screw`, the helical pair,
`T_theta_phi_theta`, the constant velocity joint, `T_theta`, `T_phi_y`, `T_x` and `T_y`, turns about and slides along x
and y alone, `T_xy` and `T_xyz`, slides in a plane and in space, `T_xyz_phi`, these with a turn about z, `T_s` and
`T_s_back`, which travel along a curve, `T_uv`, which travels over a surface, and `I`, the identity, are not in the
paper.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.geometry.elementary_motions import ElementaryMotion, FollowedLaw, amount, displaced_columns, displaced_point
from jaxkin.geometry.figures import ROD, BallFigure, BoxFigure, CylinderFigure, Figure
from jaxkin.geometry.movement import AngleLock, InvariantFeature, Movement
from jaxkin.geometry.patches import Followed
from jaxkin.geometry.rigid import Rigid
from jaxkin.geometry.trig import cos_and_sin


def _translate(axis: int, coordinate: int) -> ElementaryMotion:
    """Make a translation along an axis of the local frame."""
    return ElementaryMotion("translate", axis, coordinate)


def _rotate(axis: int, coordinate: int) -> ElementaryMotion:
    """Make a rotation about an axis of the local frame."""
    return ElementaryMotion("rotate", axis, coordinate)


_THREE_RODS: tuple[Figure, ...] = tuple(CylinderFigure(axis, 0.5, 9.0) for axis in range(3))
"""Rods along the three axes of a frame, along which something slides."""

_ALONG_CURVE = (
    ElementaryMotion("translate", 0, 0, law="x"),
    ElementaryMotion("translate", 1, 0, law="y"),
    ElementaryMotion("rotate", 2, 0, law="turn"),
)
"""The elementary motions of a frame that travels along a curve, with its x axis along the tangent."""

_SURFACE_LAWS: tuple[tuple[FollowedLaw, ...], ...] = (("x", "y", "z"), ("x_v", "y_v", "z_v"))
"""For u and for v the laws of the slides along x, y and z."""
_OVER_SURFACE = tuple(
    ElementaryMotion("translate", axis, coordinate, law=law)
    for coordinate, laws in enumerate(_SURFACE_LAWS)
    for axis, law in enumerate(laws)
)
"""The elementary motions of a frame that travels over a surface and keeps its directions."""

MOVEMENTS: dict[str, Movement] = {
    "I": Movement(subgroup_joint="fixed"),
    "T_z": Movement(
        coordinates=("z",),
        elements=(_translate(2, 0),),
        subgroup_joint="prismatic",
        feature=InvariantFeature("axis"),
        aligned=frozenset({"direction"}),
        figures=((ROD,), (BoxFigure((3.6, 3.6, 6.0)),)),
    ),
    "T_phi": Movement(
        coordinates=("phi",),
        elements=(_rotate(2, 0),),
        subgroup_joint="revolute",
        feature=InvariantFeature("axis", marked=True),
        surface="cone",
        aligned=frozenset({"axis", "direction"}),
        figures=((CylinderFigure(2, 2.0, 2.4),), (CylinderFigure(2, 1.2, 4.4),)),
    ),
    # what keeping to a plane leaves of balls and crosses, and of plates across it
    "T_theta": Movement(coordinates=("theta",), elements=(_rotate(0, 0),)),
    "T_phi_y": Movement(coordinates=("phi",), elements=(_rotate(1, 0),)),
    "T_x": Movement(coordinates=("x",), elements=(_translate(0, 0),)),
    "T_y": Movement(coordinates=("y",), elements=(_translate(1, 0),)),
    # what mates of CAD systems that keep an angle only leave free
    "T_xy": Movement(
        coordinates=("x", "y"),
        elements=(_translate(0, 0), _translate(1, 1)),
        subgroup_joint="rectangular",
        feature=InvariantFeature("plane"),
        aligned=frozenset({"direction"}),
        figures=((BoxFigure((18.0, 18.0, 0.8)),), (BoxFigure((4.4, 4.4, 1.8)),)),
    ),
    "T_xyz": Movement(
        coordinates=("x", "y", "z"),
        elements=(_translate(0, 0), _translate(1, 1), _translate(2, 2)),
        subgroup_joint="cartesian",
        feature=InvariantFeature("point"),  # the place as assembled
        figures=(_THREE_RODS, (BoxFigure((3.6, 3.6, 3.6)),)),
    ),
    "T_xyz_phi": Movement(
        coordinates=("x", "y", "z", "phi"),
        elements=(_translate(0, 0), _translate(1, 1), _translate(2, 2), _rotate(2, 3)),
        subgroup_joint="schoenflies",
        feature=InvariantFeature("axis"),
        aligned=frozenset({"direction"}),
        figures=(_THREE_RODS, (CylinderFigure(2, 2.4, 3.6),)),
    ),
    "T_screw": Movement(
        coordinates=("phi",),
        elements=(ElementaryMotion("screw", 2, 0),),
        subgroup_joint="screw",
        feature=InvariantFeature("axis", marked=True),
        aligned=frozenset({"axis", "direction"}),
        figures=((ROD,), (CylinderFigure(2, 2.4, 3.0),)),
    ),
    "T_z_phi": Movement(
        coordinates=("z", "phi"),
        elements=(_translate(2, 0), _rotate(2, 1)),
        subgroup_joint="cylindrical",
        letter="C",
        feature=InvariantFeature("axis"),
        surface="cylinder",
        aligned=frozenset({"axis", "direction"}),
        figures=((ROD,), (CylinderFigure(2, 1.6, 6.0),)),
    ),
    "T_xy_phi": Movement(
        coordinates=("x", "y", "phi"),
        elements=(_translate(0, 0), _translate(1, 1), _rotate(2, 2)),
        subgroup_joint="planar",
        letter="E",
        feature=InvariantFeature("plane"),
        surface="plane",
        aligned=frozenset({"direction"}),
        figures=((BoxFigure((18.0, 18.0, 0.8)),), (CylinderFigure(2, 3.0, 1.8),)),
        lock=AngleLock("T_theta_phi", ball=1, columns=(3, 4, 2)),
    ),
    "T_theta_phi": Movement(
        coordinates=("theta", "phi"),
        elements=(_rotate(1, 1), _rotate(0, 0)),
        letter="U",
        feature=InvariantFeature("point"),
        # Ry(phi) Rx(theta), the universal joint: part 1 holds the y axis of the cross, part 2 its x axis
        features_alone=(InvariantFeature("axis", 1, marked=True), InvariantFeature("axis", 0, marked=True)),
        aligned=frozenset({"direction", "centre"}),
        figures=((CylinderFigure(1, 0.9, 6.0),), (CylinderFigure(0, 0.8, 6.0),)),
        lock=AngleLock("T_theta_phi_psi", ball=0, columns=(0, 1)),
    ),
    "T_theta_phi_theta": Movement(
        coordinates=("theta", "phi"),
        # Rx(theta) Ry(phi) Rx(theta): the same read backwards, so that its rotation vector has no z component; these
        # are all rotations about axes at right angles to z, by less than half a turn
        elements=(_rotate(0, 0), _rotate(1, 1), _rotate(0, 0)),
        letter="V",
        # z bisects the shafts in the assembled pose only: no axis of either part, whose angles would be lengths
        feature=InvariantFeature("point"),
        aligned=frozenset({"direction", "centre"}),
        figures=((CylinderFigure(2, 2.6, 2.4),), (BallFigure(2.2),)),
    ),
    "T_s": Movement(
        coordinates=("s",),
        elements=_ALONG_CURVE,
        letter="K",
        feature=InvariantFeature("axis", marked=True),  # across the plane of the curve, at the contact as assembled
        aligned=frozenset({"direction"}),
        figures=((), (BallFigure(1.4),)),
    ),
    "T_s_back": Movement(  # the inverse of T_s: the curve belongs to part 2
        coordinates=("s",),
        elements=tuple(replace(element, sense=-1) for element in reversed(_ALONG_CURVE)),
        letter="K",
        feature=InvariantFeature("axis", marked=True),
        aligned=frozenset({"direction"}),
    ),
    "T_uv": Movement(
        coordinates=("u", "v"),
        elements=_OVER_SURFACE,
        letter="F",
        feature=InvariantFeature("point"),  # the contact as assembled
    ),
    "T_theta_phi_psi": Movement(
        coordinates=("theta", "phi", "psi"),
        elements=(_rotate(2, 2), _rotate(1, 1), _rotate(0, 0)),
        ball=True,
        subgroup_joint="spherical",
        letter="S",
        feature=InvariantFeature("point"),
        surface="sphere",
        aligned=frozenset({"centre"}),
        figures=((CylinderFigure(2, 1.8, 2.0),), (BallFigure(2.2),)),
    ),
}
"""All movements by their keys, with which joints (`jaxkin.joints.pairs`) and contact states
(`jaxkin.contacts.states`) name the movements of their chains."""


def symmetry_of(surface: str) -> str:
    """Look up the key of the movement that maps a kind of surface, such as "plane", onto itself."""
    return next(name for name, movement in MOVEMENTS.items() if movement.surface == surface)


def is_length(coordinate: str) -> bool:
    """Check by its name, such as "z" or "phi2", whether a coordinate is a length (x, y, z, s, u, v) and no angle."""
    return coordinate.rstrip("0123456789") in ("x", "y", "z", "s", "u", "v")


def displaced(
    frame: Rigid,
    movement: str,
    q: Float[Array, "k *#poses"],
    pitch: Float[Array, ""] | float = 0.0,
    curve: Followed | None = None,
    back: bool = False,
) -> Rigid:
    """Multiply frames F by a movement T, or `back` by its inverse, from the right: F T, elementary motion by motion.

    `q` has one row for each of `MOVEMENTS[movement].coordinates`: radians, or lengths in the unit of the mechanism.
    `pitch` is the advance per turn of `T_screw`, and `curve` the curve, or the surface, that a movement follows, in the
    same unit. The frames, or `q`, may have a last axis of length one, for all poses. An elementary motion changes at
    most two columns of F, which costs less than a matrix product.
    """
    point = None if curve is None else curve.spline(jnp).at(*q, xp=jnp)
    for element in MOVEMENTS[movement].elements[:: -1 if back else 1]:
        how_far = amount(element, q[element.coordinate], pitch, point, cos_and_sin)
        columns = displaced_columns([frame[:, column] for column in range(4)], element.axis, *how_far, back)
        frame = jnp.stack(jnp.broadcast_arrays(*columns), axis=1)
    return frame


def displace_point(
    rows: tuple[Float[Array, "*#poses"], Float[Array, "*#poses"], Float[Array, "*#poses"]],
    movement: str,
    q: Sequence[Float[Array, " poses"]],
    pitch: Float[Array, ""] | float,
    curve: Followed | None,
    back: bool,
) -> tuple[Float[Array, "*#poses"], Float[Array, "*#poses"], Float[Array, "*#poses"]]:
    """Displace a point (x, y, z) by a movement T, or `back` by its inverse, in the axes of the frame, as `displaced`
    does."""
    followed = None if curve is None else curve.spline(jnp).at(*q, xp=jnp)
    for element in MOVEMENTS[movement].elements[:: 1 if back else -1]:
        how_far = amount(element, q[element.coordinate], pitch, followed, cos_and_sin)
        rows = displaced_point(rows, element.axis, *how_far, back)
    return rows
