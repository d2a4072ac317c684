"""The two equations that all formulas come down to: A cos x + B sin x = C, and the quadratic of a displacement."""

from __future__ import annotations

from typing import NamedTuple

from jaxkin.solve.closed_form.arithmetic import Number, ratio, root
from jaxkin.solve.closed_form.complex_numbers import Complex, argument, unit


class TurnRoot(NamedTuple):
    """A solution of A cos x + B sin x = C."""

    turn: Complex
    """The rotation by x, of absolute value 1."""
    discriminant: Number
    """Over its largest possible value: 1 where the two solutions are farthest apart."""

    @property
    def value(self) -> Number:
        """Compute the angle x, radians in [-pi, pi]."""
        return argument(self.turn)


class SlideRoot(NamedTuple):
    """A solution of (s + b)^2 = c."""

    value: Number
    """The displacement s."""
    discriminant: Number
    """As that of a turn."""


def solve_turn(a: Number, b: Number, c: Number, sign: Number) -> TurnRoot:
    """Solve a cos x + b sin x = c for the angle x.

    The derivative of the left side is b cos x - a sin x = `sign` sqrt(a^2 + b^2 - c^2); at x = 0 it is b. The
    discriminant is 1 - c^2 / (a^2 + b^2).
    """
    square = a * a + b * b
    radius = root(square)
    product = (radius - c) * (radius + c)
    slope = sign * root(product)
    turn = unit(Complex(a * c + b * slope, b * c - a * slope))
    return TurnRoot(turn, ratio(product, square))


def solve_slide(half: Number, square: Number, whole: Number, sign: Number) -> SlideRoot:
    """Solve (s + half)^2 = square for the displacement s.

    Half the derivative of the left side is s + half = `sign` sqrt(square); at s = 0 it is `half`. The discriminant is
    square / whole.
    """
    return SlideRoot(sign * root(square) - half, ratio(square, whole))
