"""The spherical triangle: three unknown turns about axes through one point.

The first and the third axis a_1, a_3 are carried along by none of their own turns, so that

    a_1 . K_1 U_2 K_2 a_3 = a_1 . K_3^T a_3

holds the second angle alone: the cosine rule, A cos x + B sin x = C. The first and the third turn carry one known
direction to another each.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from jaxkin.solve.closed_form.arithmetic import Number, ratio, root
from jaxkin.solve.closed_form.complex_numbers import Complex, argument, conj
from jaxkin.solve.closed_form.equations import solve_turn
from jaxkin.solve.closed_form.vectors import Rotation, Vector, back, carry, cross, dot, rotate, turn_about


class Triangle(NamedTuple):
    """The pose of a spherical triangle."""

    motions: tuple[Complex, Complex, Complex]
    """The turns in order of travel, complex numbers of absolute value 1."""
    discriminant: Number
    """The squared sine of the angle at the second axis, between the arcs to the first and to the third."""

    @property
    def coordinates(self) -> tuple[Number, ...]:
        """Compute the angles of the turns, radians in (-pi, pi]."""
        return tuple(argument(turn) for turn in self.motions)


def spherical_triangle(axes: Sequence[Vector], between: Sequence[Rotation], sign: Number) -> Triangle:
    """Solve U_1 K_1 U_2 K_2 U_3 K_3 = 1 for the angles of the three `U`.

    `axes` are the unit axes of the `U` in the assembled pose, `between` the rotations `K`, which are known. `sign` is
    that of `signed_root` in the assembled pose.
    """
    one, two, three = axes
    first, second, third = between
    before, behind = back(first, one), carry(second, three)
    carried = dot(before, two) * dot(two, behind)
    turned_back = back(third, three)
    found = solve_turn(
        dot(before, behind) - carried, dot(before, cross(two, behind)), dot(one, turned_back) - carried, sign
    )
    turn = found.turn
    arrived = carry(first, rotate(two, turn, behind))
    other = back(second, rotate(two, conj(turn), before))
    turns = turn_about(one, arrived, turned_back), turn, turn_about(three, carry(third, one), other)
    return Triangle(turns, found.discriminant)


def signed_root(axes: Sequence[Vector], between: Sequence[Rotation]) -> Number:
    """Compute the sine of the angle at the second axis, with its sign, in a pose in which all three unknowns are 0."""
    one, two, three = axes
    first, second, _ = between
    before, behind = back(first, one), carry(second, three)
    across = cross(two, before), cross(two, behind)
    return ratio(dot(before, across[1]), root(dot(across[0], across[0]) * dot(across[1], across[1])))
