"""A joint coordinate of many poses, of which an angle is known as a number, as a turn, or as both."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.solve.closed_form.arithmetic import Number, namespace
from jaxkin.solve.closed_form.complex_numbers import Complex, argument, conj, turn_by


class Coordinate(NamedTuple):
    """One coordinate: formulas find turns, from which angles are computed only where they are asked for."""

    known: Number | None
    """Radians or lengths; None where only the turn is known."""
    turn: Complex
    """Of absolute value 1; without meaning for a length."""

    @property
    def value(self) -> Number:
        """Radians, in (-pi, pi] where only the turn is known, or lengths."""
        return argument(self.turn) if self.known is None else self.known

    def at(self, pose: int) -> Number:
        """Compute the value in one pose."""
        if self.known is not None:
            return namespace(self.known).asarray(self.known)[pose]
        real, imag = (namespace(part).asarray(part)[pose] for part in self.turn)
        return argument(Complex(real, imag))

    def times(self, sign: Number) -> Coordinate:
        """Multiply by a sign, 1 or -1."""
        turn = Complex(self.turn.real, sign * self.turn.imag)
        return Coordinate(None if self.known is None else sign * self.known, turn)

    def back(self) -> Coordinate:
        """Change the sign."""
        return Coordinate(None if self.known is None else -self.known, conj(self.turn))


FormulaCoordinates = Sequence[Coordinate | None]
"""For each column of the system its coordinate; None where it is not known yet."""
REST = Coordinate(np.zeros(1), Complex(np.ones(1), np.zeros(1)))
"""A coordinate of the assembled pose."""


def given(value: Number, *, is_length: bool) -> Coordinate:
    """Make a coordinate of lengths or of angles in radians."""
    return Coordinate(value, REST.turn if is_length else turn_by(value))


def found(motion: Complex | Number) -> Coordinate:
    """Make a coordinate of what a formula has found: a turn, or a displacement."""
    return Coordinate(None, motion) if isinstance(motion, Complex) else Coordinate(motion, REST.turn)
