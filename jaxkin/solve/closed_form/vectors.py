"""Vectors and rotations of space, one or one a pose: products, and turns about unit axes."""

from __future__ import annotations

import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.closed_form.arithmetic import Number, namespace
from jaxkin.solve.closed_form.complex_numbers import Complex, unit

Vector = Float[Array | np.ndarray, "3 *#poses"]
Rotation = Float[Array | np.ndarray, "3 3 *#poses"]
"""[row, column]."""


def dot(one: Vector, other: Vector) -> Number:
    """Compute the scalar product."""
    return (one * other).sum(axis=0)


def cross(one: Vector, other: Vector) -> Vector:
    """Compute the vector product."""
    return namespace(one, other).stack(
        [
            one[1] * other[2] - one[2] * other[1],
            one[2] * other[0] - one[0] * other[2],
            one[0] * other[1] - one[1] * other[0],
        ]
    )


def carry(rotation: Rotation, vector: Vector) -> Vector:
    """Rotate a vector by a matrix."""
    return (rotation * vector[None]).sum(axis=1)


def back(rotation: Rotation, vector: Vector) -> Vector:
    """Rotate a vector by the inverse of a matrix."""
    return (rotation * vector[:, None]).sum(axis=0)


def rotate(axis: Vector, turn: Complex, vector: Vector) -> Vector:
    """Rotate a vector about a unit axis (Rodrigues)."""
    along = axis * dot(axis, vector)
    return along + turn.real * (vector - along) + turn.imag * cross(axis, vector)


def turn_about(axis: Vector, begun: Vector, wanted: Vector) -> Complex:
    """Compute the turn about a unit axis that brings one vector as near to another as it can."""
    along = dot(begun, wanted) - dot(axis, begun) * dot(axis, wanted)
    return unit(Complex(along, dot(axis, cross(begun, wanted))))
