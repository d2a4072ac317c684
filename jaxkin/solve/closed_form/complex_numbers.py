"""Vectors and rotations of the plane as complex numbers, kept as real and imaginary part."""

from __future__ import annotations

from typing import NamedTuple

from jaxkin.solve.closed_form.arithmetic import Number, angle, cos_sin, namespace


class Complex(NamedTuple):
    """A vector or a rotation of the plane."""

    real: Number
    imag: Number


def add(*vectors: Complex) -> Complex:
    """Add vectors."""
    return Complex(sum(v.real for v in vectors), sum(v.imag for v in vectors))


def subtract(one: Complex, other: Complex) -> Complex:
    """Subtract the second vector from the first."""
    return Complex(one.real - other.real, one.imag - other.imag)


def cross(one: Complex, other: Complex) -> Number:
    """Compute the cross product of two vectors, a number."""
    return one.real * other.imag - one.imag * other.real


def times(*factors: Complex) -> Complex:
    """Multiply complex numbers."""
    first, *rest = factors
    for factor in rest:
        first = Complex(
            first.real * factor.real - first.imag * factor.imag, first.real * factor.imag + first.imag * factor.real
        )
    return first


def scale(number: Number, vector: Complex) -> Complex:
    """Multiply a vector by a real number."""
    return Complex(number * vector.real, number * vector.imag)


def conj(number: Complex) -> Complex:
    """Conjugate a number: the rotation back, or the mirror image."""
    return Complex(number.real, -number.imag)


def square(number: Complex) -> Number:
    """Compute the squared absolute value."""
    return number.real * number.real + number.imag * number.imag


def turn_by(angles: Number) -> Complex:
    """Compute the rotations by angles in radians."""
    cos, sin = cos_sin(angles)
    return Complex(cos, sin)


def argument(number: Complex) -> Number:
    """Compute the angles in [-pi, pi], radians; zero of the number zero."""
    return angle(number.imag, number.real)


def rough_argument(number: Complex) -> Number:
    """Compute the angles in [-pi, pi], radians, to 0.08, at the price of a division.

    The point on the square |x| + |y| = 1 in the same direction is as far along it as the angle says, to 0.072.
    """
    xp = namespace(number.real, number.imag)
    size = xp.abs(number.real) + xp.abs(number.imag)
    part = number.imag / xp.where(size > 0, size, 1.0)
    beyond = xp.where(number.imag < 0, -2.0, 2.0) - part
    return (0.5 * xp.pi) * xp.where(number.real < 0, beyond, part)


def unit(number: Complex) -> Complex:
    """Divide by the absolute value: the rotation in this direction; 1 with zero derivative for the number zero."""
    xp, size = namespace(number.real, number.imag), square(number)
    positive = size > 0
    inverse = 1.0 / xp.sqrt(xp.where(positive, size, 1.0))
    return Complex(xp.where(positive, number.real * inverse, 1.0), xp.where(positive, number.imag * inverse, 0.0))
