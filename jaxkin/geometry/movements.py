"""The paper's allowable movements T_z, T_phi, T_z_phi, T_xy_phi, T_theta_phi, T_theta_phi_psi (Section 3) in JAX.

Each movement displaces a local frame; `x, y, z` are translations along and `theta, phi, psi` rotations about its axes.
The angle about z is psi in the three-angle matrix and phi elsewhere, as the paper prints it. A movement is written
once, as a product of elementary ones (`MOVEMENTS`); displacements and all that the solver needs follow from that.
`T_screw`, the helical pair, and `I`, no movement, are not in the paper.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.geometry.rigid import Rigid
from jaxkin.geometry.trig import cos_sin


@dataclass(frozen=True)
class ElementaryMotion:
    """An elementary movement along or about one axis of the local frame."""

    kind: Literal["translate", "rotate", "screw"]
    """A screw turns by its coordinate q and advances by pitch q / 2 pi."""
    axis: int
    """0, 1, 2 for x, y, z."""
    coordinate: int
    """Which coordinate of the movement drives it."""


@dataclass(frozen=True)
class Movement:
    """An allowable movement: the names of its coordinates and its elementary movements, leftmost factor first."""

    coordinates: tuple[str, ...]
    elements: tuple[ElementaryMotion, ...]
    ball: bool = False
    """True where the elements are the angles of a ball: solved without angles, since they lock at phi = 90 deg."""


def _translate(axis: int, coordinate: int) -> ElementaryMotion:
    return ElementaryMotion("translate", axis, coordinate)


def _rotate(axis: int, coordinate: int) -> ElementaryMotion:
    return ElementaryMotion("rotate", axis, coordinate)


MOVEMENTS: dict[str, Movement] = {
    "I": Movement((), ()),
    "T_z": Movement(("z",), (_translate(2, 0),)),
    "T_phi": Movement(("phi",), (_rotate(2, 0),)),
    "T_screw": Movement(("phi",), (ElementaryMotion("screw", 2, 0),)),
    "T_z_phi": Movement(("z", "phi"), (_translate(2, 0), _rotate(2, 1))),
    "T_xy_phi": Movement(("x", "y", "phi"), (_translate(0, 0), _translate(1, 1), _rotate(2, 2))),
    "T_theta_phi": Movement(("theta", "phi"), (_rotate(1, 1), _rotate(0, 0))),
    "T_theta_phi_psi": Movement(("theta", "phi", "psi"), (_rotate(2, 2), _rotate(1, 1), _rotate(0, 0)), ball=True),
}


def is_length(coordinate: str) -> bool:
    """Whether a coordinate of a joint, by its name, is a length (x, y, z) and not an angle (theta, phi, psi)."""
    return coordinate.rstrip("0123456789") in ("x", "y", "z")


def displaced(
    frame: Rigid, movement: str, q: Float[Array, "k *#poses"], pitch: Float[Array, ""] | float = 0.0
) -> Rigid:
    """The frames F followed by a movement, F T: elementary ones one by one, of which each changes two columns at most.

    `q` has a row for each of `MOVEMENTS[movement].coordinates`: radians, and lengths in the unit of the mechanism; so
    is `pitch`, per turn, which only `T_screw` has. Frames and `q` may be one for all poses.
    """
    for element in MOVEMENTS[movement].elements:
        frame = _displaced(frame, element, q[element.coordinate], pitch)
    return frame


def _displaced(
    frame: Rigid, element: ElementaryMotion, q: Float[Array, "*#poses"], pitch: Float[Array, ""] | float
) -> Rigid:
    i, j, k = element.axis, (element.axis + 1) % 3, (element.axis + 2) % 3
    columns = [frame[:, column] for column in range(4)]
    if element.kind != "rotate":
        columns[3] = columns[3] + columns[i] * (q if element.kind == "translate" else q * pitch / (2 * jnp.pi))
    if element.kind != "translate":
        cos, sin = cos_sin(q)
        columns[j], columns[k] = columns[j] * cos + columns[k] * sin, columns[k] * cos - columns[j] * sin
    return jnp.stack(jnp.broadcast_arrays(*columns), axis=1)
