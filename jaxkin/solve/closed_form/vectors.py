"""Vectors and rotations of space, one or one a pose, kept as numbers: products, and turns about unit axes.

Of an array of three rows XLA would write each product to memory, and read it again for the next one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Float

from jaxkin.solve.closed_form.arithmetic import Number
from jaxkin.solve.closed_form.complex_numbers import Complex, unit


class Vector(NamedTuple):
    """A vector of space, by coordinates of shape (1,) or (poses,)."""

    x: Number
    y: Number
    z: Number

    @staticmethod
    def of(coordinates: Float[Array | np.ndarray, "3"]) -> Vector:
        """Make the vector that is the same in all poses, by coordinates of shape (1,)."""
        return Vector(coordinates[0:1], coordinates[1:2], coordinates[2:3])


class Rotation(NamedTuple):
    """A rotation of space: where it takes the three axes of coordinates, the columns of its matrix."""

    x: Vector
    y: Vector
    z: Vector

    @staticmethod
    def of(matrix: Float[Array | np.ndarray, "3 3"]) -> Rotation:
        """Make the rotation that is the same in all poses."""
        return Rotation(*(Vector.of(matrix[:, column]) for column in range(3)))


def add(one: Vector, other: Vector) -> Vector:
    """Add two vectors."""
    return Vector(one.x + other.x, one.y + other.y, one.z + other.z)


def subtract(one: Vector, other: Vector) -> Vector:
    """Subtract the second vector from the first."""
    return Vector(one.x - other.x, one.y - other.y, one.z - other.z)


def scale(number: Number, vector: Vector) -> Vector:
    """Multiply a vector by a number."""
    return Vector(number * vector.x, number * vector.y, number * vector.z)


def dot(one: Vector, other: Vector) -> Number:
    """Compute the scalar product."""
    return one.x * other.x + one.y * other.y + one.z * other.z


def cross(one: Vector, other: Vector) -> Vector:
    """Compute the vector product."""
    return Vector(
        one.y * other.z - one.z * other.y,
        one.z * other.x - one.x * other.z,
        one.x * other.y - one.y * other.x,
    )


def carry(rotation: Rotation, vector: Vector) -> Vector:
    """Rotate a vector."""
    x, y, z = (scale(number, column) for number, column in zip(vector, rotation, strict=True))
    return add(add(x, y), z)


def back(rotation: Rotation, vector: Vector) -> Vector:
    """Rotate a vector by the inverse of a rotation."""
    return Vector(*(dot(column, vector) for column in rotation))


def rotate(axis: Vector, turn: Complex, vector: Vector) -> Vector:
    """Rotate a vector about a unit axis (Rodrigues)."""
    along = scale(dot(axis, vector), axis)
    across = add(scale(turn.real, subtract(vector, along)), scale(turn.imag, cross(axis, vector)))
    return add(along, across)


def turn_about(axis: Vector, begun: Vector, wanted: Vector) -> Complex:
    """Compute the turn about a unit axis that brings one vector as near to another as it can."""
    along = dot(begun, wanted) - dot(axis, begun) * dot(axis, wanted)
    return unit(Complex(along, dot(axis, cross(begun, wanted))))
