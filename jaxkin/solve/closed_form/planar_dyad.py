"""Planar dyads: three unknown turns and slides of one planar loop, in whatever order.

Vectors and rotations of the plane are complex numbers here, kept as real and imaginary part. With e_i for the turn of
unknown i, r_i for the rotation of what lies behind it and z_i for the link from its centre to that of the next one,

    RRR    e_1 z_1 + e_1 r_1 e_2 z_2 = -conj(r_3) z_3          a triangle of sides |z_1|, |z_2|, |z_3|
    RRP    e_1 z_1 = -conj(r_3) (z_3 + conj(r_2) z_2 + s d)     a circle and a line
    RPP    z_1 + r_1 (s_2 d_2 + z_2) + r_1 r_2 (s_3 d_3 + z_3) = 0    two lines

and all turns together are 1.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from jaxkin.solve.closed_form.arithmetic import Number, namespace, ratio, root
from jaxkin.solve.closed_form.complex_numbers import (
    Complex,
    add,
    argument,
    conj,
    cross,
    square,
    times,
    unit,
)
from jaxkin.solve.closed_form.equations import solve_slide


class PlanarLink(NamedTuple):
    """A displacement of the plane: the first end of the link to the second, displaced, is `shift`."""

    turn: Complex
    """Of absolute value 1."""
    shift: Complex


Three = tuple[Complex | Number, Complex | Number, Complex | Number]
"""One for each unknown: a turn as a complex number of absolute value 1, a slide as a length."""


class Dyad(NamedTuple):
    """The pose of a dyad."""

    motions: Three
    """Of the unknowns in the order in which they were given."""
    discriminant: Number
    """RRR: the squared sine of the angle between the two links. RRP: that of the angle between the link and the slide.
    RPP: that of the angle between the slides, of which there is one pose only."""

    @property
    def coordinates(self) -> tuple[Number, ...]:
        """Compute the coordinates of the unknowns: radians in (-pi, pi], or lengths."""
        return tuple(argument(each) if isinstance(each, Complex) else each for each in self.motions)


class _Link(NamedTuple):
    """A link behind an unknown."""

    turn: Complex
    shift: Complex
    along: Complex
    """Direction of the unknown, if it is a slide."""


def link_ends(kinds: str, places: Sequence[Complex]) -> list[tuple[Complex, Complex]]:
    """Find the points between which the link behind each unknown is counted: centres of turns, and for slides 0.

    All are points of the assembled pose. Arguments are those of `planar_dyad`.
    """
    origin = Complex(np.zeros(1), np.zeros(1))
    ends = [place if kind == "R" else origin for kind, place in zip(kinds, places, strict=True)]
    return list(zip(ends, ends[1:] + ends[:1], strict=True))


def planar_dyad(kinds: str, places: Sequence[Complex], links: Sequence[PlanarLink], sign: Number) -> Dyad:
    """Solve U_1 K_1 U_2 K_2 U_3 K_3 = 1 for the coordinates of the three `U`.

    `kinds` are three letters in order of travel, R for a turn and P for a slide, not PPP. `places` are the centre of
    each turn and the unit direction of each slide in the assembled pose, `links` are the `K`, which are known, each
    between its `link_ends`. `sign` is that of `signed_root` in the assembled pose.
    """
    first = _first(kinds)
    kinds = kinds[first:] + kinds[:first]
    found, discriminant = _FORMULAS[kinds](_begun_at(first, places, links), sign)
    return Dyad((found[-first % 3], found[(1 - first) % 3], found[(2 - first) % 3]), discriminant)


def signed_root(kinds: str, places: Sequence[Complex], links: Sequence[PlanarLink]) -> Number:
    """Compute the root of the discriminant, with the sign of the branch, in a pose in which all three unknowns are 0.

    Arguments are those of `planar_dyad`. The root is the sine of the angle between the links of RRR, the cosine of the
    angle of link and slide of RRP, and 1 for RPP, which has one pose.
    """
    first = _first(kinds)
    kinds = kinds[first:] + kinds[:first]
    one, two, three = _begun_at(first, places, links)
    if kinds == "RRR":
        lengths = root(square(one.shift) * square(two.shift))
        return ratio(times(conj(one.shift), one.turn, two.shift).imag, lengths)
    if kinds == "RRP":
        return ratio(times(conj(three.along), _to_line(two, three)).real, root(square(one.shift)))
    return namespace(one.shift.real).ones_like(one.shift.real)


def _first(kinds: str) -> int:
    """Find the unknown at which the loop is begun, so that its letters are a key of `_FORMULAS`."""
    return next(k for k in range(3) if kinds[k:] + kinds[:k] in _FORMULAS)


def _begun_at(first: int, places: Sequence[Complex], links: Sequence[PlanarLink]) -> tuple[_Link, _Link, _Link]:
    """List the links behind the unknowns, from the unknown `first` on, each with the place of its unknown."""
    one, two, three = (_Link(*links[k % 3], places[k % 3]) for k in range(first, first + 3))
    return one, two, three


def _triangle(links: tuple[_Link, _Link, _Link], sign: Number) -> tuple[Three, Number]:
    """Solve RRR: w = conj(z_1) r_1 e_2 z_2 is known by its real part, by its size, and by the sign of the rest."""
    one, two, three = links
    first, second, third = (square(link.shift) for link in links)
    sides = first * second
    real = 0.5 * (third - first - second)
    size = root(sides)
    product = (size - real) * (size + real)
    w = Complex(real, sign * root(product))
    e_1 = unit(
        times(
            conj(three.turn),
            Complex(-three.shift.real, -three.shift.imag),
            conj(one.shift),
            Complex(first + real, -w.imag),
        )
    )
    # links that are known of all poses are multiplied first
    e_2 = unit(times(w, times(one.shift, conj(two.shift), conj(one.turn))))
    e_3 = conj(times(e_1, e_2, times(one.turn, two.turn), three.turn))
    return (e_1, e_2, e_3), ratio(product, sides)


def _circle_and_line(links: tuple[_Link, _Link, _Link], sign: Number) -> tuple[Three, Number]:
    """Solve RRP: u = conj(d) (z_3 + conj(r_2) z_2 + s d) is known by its imaginary part, size, and sign of the rest."""
    one, two, three = links
    whole = square(one.shift)
    begun = times(conj(three.along), _to_line(two, three))
    radius = root(whole)
    slide = solve_slide(begun.real, (radius - begun.imag) * (radius + begun.imag), whole, sign)
    e_1 = unit(times(conj(three.turn), three.along, Complex(-begun.real - slide.value, -begun.imag), conj(one.shift)))
    e_2 = conj(times(e_1, one.turn, two.turn, three.turn))
    return (e_1, e_2, slide.value), slide.discriminant


def _two_lines(links: tuple[_Link, _Link, _Link], sign: Number) -> tuple[Three, Number]:
    """Solve RPP: the turn is the one that is left, and the slides are solved by Cramer's rule."""
    del sign
    one, two, three = links
    left = add(times(conj(one.turn), one.shift), two.shift, times(two.turn, three.shift))
    along_2, along_3 = two.along, times(two.turn, three.along)
    sine = cross(along_2, along_3)
    parallel, xp = sine == 0, namespace(sine)
    divisor = xp.where(parallel, 1.0, sine)
    e_1 = conj(times(one.turn, two.turn, three.turn))
    slides = [xp.where(parallel, 0.0, -part / divisor) for part in (cross(left, along_3), cross(along_2, left))]
    return (e_1, slides[0], slides[1]), sine * sine


_FORMULAS: dict[str, Callable[..., tuple[Three, Number]]] = {
    "RRR": _triangle,
    "RRP": _circle_and_line,
    "RPP": _two_lines,
}
"""Letters of the unknowns, begun at the one that makes them one of these -> formula."""


def _to_line(two: _Link, three: _Link) -> Complex:
    """Compute z_3 + conj(r_2) z_2 of the slide in RRP."""
    return add(three.shift, times(conj(two.turn), two.shift))
