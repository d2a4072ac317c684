"""Closed forms of planar linkages, in numpy float64 and independent of jaxkin.

The plane is x, y; angles are in radians from the x axis, counter-clockwise, and principal values. Every function takes
an array of input angles (poses,) and answers with arrays of the same length; nan where the linkage cannot be assembled.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

Array = np.ndarray


def polar(radius, angle) -> Array:
    """The points (poses, 2) at a radius and an angle from the origin."""
    return np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle)), axis=-1)


def direction(start: Array, end: Array) -> Array:
    """The angle (poses,) of the line from one point to another."""
    return np.arctan2(*np.moveaxis(end - start, -1, 0)[::-1])


def meet(p: Array, p_radius: float, q: Array, q_radius: float, side: int) -> Array:
    """Where circles about p and q meet (poses, 2): left of the line from p to q for side=1, right of it for side=-1."""
    p, q = np.broadcast_arrays(np.asarray(p, float), np.asarray(q, float))
    distance = np.linalg.norm(q - p, axis=-1, keepdims=True)
    along = (q - p) / distance
    foot = (p_radius**2 - q_radius**2 + distance**2) / (2 * distance)
    height_squared = p_radius**2 - foot**2
    height = np.sqrt(np.where(height_squared < 0, np.nan, height_squared))
    return p + foot * along + side * height * np.stack([-along[..., 1], along[..., 0]], axis=-1)


class FourBar(NamedTuple):
    coupler: Array
    rocker: Array
    crank_pin: Array
    rocker_pin: Array


def fourbar(theta: Array, ground=100.0, crank=40.0, coupler=120.0, rocker=80.0, side=1) -> FourBar:
    """Angles of coupler and rocker, and where their pins are: crank about the origin, rocker about (ground, 0).

    Side 1 is the branch that Norton (Design of Machinery, section 4.5) calls open, -1 the crossed one, for a crank
    angle between 0 and pi. The lengths given are those of his example 4-1.
    """
    a, d = polar(crank, theta), np.array([ground, 0.0])
    b = meet(a, coupler, d, rocker, side)
    return FourBar(direction(a, b), direction(d, b), a, b)


def antiparallelogram(theta: Array, crank=50.0, ground=120.0) -> Array:
    """Angle of the rocker of a four-bar with equal opposite links, crossed (Hunt, Kinematic Geometry of Mechanisms).

    It meets the other branch, the parallelogram whose rocker turns with the crank, at theta = 0 and pi.
    """
    return 2 * np.arctan2((crank + ground) * np.sin(theta / 2), (crank - ground) * np.cos(theta / 2))


def fourbar_crank(rocker: Array, lengths=(100.0, 40.0, 120.0, 80.0), side=1) -> Array:
    """The crank of `fourbar`, lengths in the same order, by the angle of its rocker; side 1 has the crank pin left of
    the line from the crank's pivot to the rocker's pin."""
    ground, crank, coupler, out = lengths
    pin = np.array([ground, 0.0]) + polar(out, rocker)
    reach = np.hypot(*np.moveaxis(pin, -1, 0))
    cosine = (crank**2 + reach**2 - coupler**2) / (2 * crank * reach)
    return direction(np.zeros(2), pin) + side * np.arccos(np.where(np.abs(cosine) > 1, np.nan, cosine))


def kite(theta: Array, crank=50.0, coupler=120.0) -> Array:
    """Angle of the rocker of a four-bar whose ground is as long as the crank, its rocker as the coupler.

    The rocker's pin lies on the line that halves the crank angle: two turns of the crank bring it back. At theta = 0,
    where crank pin and rocker pivot meet, coupler and rocker could turn together.
    """
    reach = crank * np.cos(theta / 2) + np.sqrt(coupler**2 - (crank * np.sin(theta / 2)) ** 2)
    return np.arctan2(reach * np.sin(theta / 2), reach * np.cos(theta / 2) - crank)


def upright_kite(theta: Array, crank=50.0, ground=120.0) -> Array:
    """Angle of the rocker of a four-bar whose coupler is as long as the crank, its rocker as the ground.

    The rocker's pin mirrors the crank's pivot in the line of the other two; it meets that pivot at theta = 0 and pi,
    where crank and coupler could turn together.
    """
    return 2 * np.arctan2(crank * np.sin(theta), crank * np.cos(theta) - ground) - np.pi


class SliderCrank(NamedTuple):
    rod: Array
    slider: Array


def slider_crank(theta: Array, crank=40.0, rod=120.0, offset=-20.0, side=1) -> SliderCrank:
    """Angle of the rod, from crank pin to slider, and x of the slider, which runs on y = offset (Norton, section 4.6).

    Side 1 has the slider at the greater x. The lengths given are those of his example 4-2.
    """
    rise = offset - crank * np.sin(theta)
    run = side * np.sqrt(rod**2 - rise**2)
    return SliderCrank(np.arctan2(rise, run), crank * np.cos(theta) + run)


def scotch_yoke(theta: Array, crank=30.0, slot=np.pi / 2) -> Array:
    """x of a yoke that slides along x, its slot inclined by the angle `slot` and driven by a pin on a crank."""
    return crank * np.cos(theta) - crank * np.sin(theta) / np.tan(slot)


class SlottedArm(NamedTuple):
    arm: Array
    slide: Array


def quick_return(theta: Array, crank=50.0, distance=120.0) -> SlottedArm:
    """The arm of Whitworth's quick return, and the distance of the crank pin from the arm's pivot.

    The arm pivots at the origin, the crank at (distance, 0); its pin slides along the arm (Norton, section 3.7). A ball
    on a crank, in a bore of the arm (contact (j)), makes it turn and slide just so.
    """
    pin = np.array([distance, 0.0]) + polar(crank, theta)
    return SlottedArm(np.arctan2(pin[..., 1], pin[..., 0]), np.linalg.norm(pin, axis=-1))


class WattSixBar(NamedTuple):
    first: FourBar
    second: FourBar


def watt_sixbar(
    theta: Array, first=(100.0, 40.0, 120.0, 80.0), second=(90.0, 60.0, 110.0, 75.0), gamma=0.4, sides=(1, 1)
) -> WattSixBar:
    """Watt's second six-bar: two four-bars in series, lengths as (ground, crank, coupler, rocker).

    The rocker of the first, turned by gamma, is the crank of the second, whose ground lies along x too.
    """
    one = fourbar(theta, *first, side=sides[0])
    return WattSixBar(one, fourbar(one.rocker + gamma, *second, side=sides[1]))


JANSEN = {
    "a": 38.0, "b": 41.5, "c": 39.3, "d": 40.1, "e": 55.8, "f": 39.4, "g": 36.7,
    "h": 65.7, "i": 49.0, "j": 50.0, "k": 61.9, "l": 7.8, "m": 15.0,
}  # fmt: skip
"""Jansen's eleven numbers, and l and m (Jansen, The Great Pretender, 2007)."""


class Jansen(NamedTuple):
    crank_pin: Array
    knee: Array
    rear: Array
    lower: Array
    ankle: Array
    foot: Array


def jansen(theta: Array) -> Jansen:
    """Pins of Jansen's leg: crank about the origin, the fixed pin at (-a, -l); three dyads, one after another."""
    n = JANSEN
    crank_pin, fixed = polar(n["m"], theta), np.array([-n["a"], -n["l"]])
    knee = meet(fixed, n["b"], crank_pin, n["j"], 1)
    rear = meet(fixed, n["d"], knee, n["e"], 1)
    lower = meet(fixed, n["c"], crank_pin, n["k"], -1)
    ankle = meet(rear, n["f"], lower, n["g"], -1)
    return Jansen(crank_pin, knee, rear, lower, ankle, meet(ankle, n["h"], lower, n["i"], -1))


def chebyshev_lambda(theta: Array, crank=1.0) -> Array:
    """The drawing point of Chebyshev's lambda linkage, of bars 2 : 1 : 2.5 : 2.5; nearly straight (Norton, 3.8)."""
    bar = fourbar(theta, 2 * crank, crank, 2.5 * crank, 2.5 * crank)
    return 2 * bar.rocker_pin - bar.crank_pin


class Peaucellier(NamedTuple):
    near: Array
    far: Array
    left: Array
    right: Array


def peaucellier(psi: Array, arm=100.0, side=40.0, crank=35.0) -> Peaucellier:
    """Corners of Peaucellier's rhombus; `far` draws the line x = (arm^2 - side^2) / (2 crank).

    The arms pivot at the origin and end at `left` and `right`; the crank about (crank, 0) ends at `near`, at the angle
    2 psi, and psi is the angle of the rhombus' diagonal (Kempe, How to Draw a Straight Line, 1877).
    """
    near = polar(2 * crank * np.cos(psi), psi)
    far = polar((arm**2 - side**2) / (2 * crank * np.cos(psi)), psi)
    origin = np.zeros(2)
    return Peaucellier(near, far, meet(origin, arm, near, side, 1), meet(origin, arm, near, side, -1))


def oldham(theta: Array, offset=10.0) -> Array:
    """Centre of the disc of an Oldham coupling with parallel shafts at the origin and at (offset, 0).

    Both shafts turn by theta; the slot of the first lies along theta, that of the second across it.
    """
    return polar(offset * np.cos(theta), theta)


def platform_poses(base: Array, platform: Array, legs: Array) -> Array:
    """All poses (x, y, angle) of a triangle whose corners are at the distances `legs` from three points (3-RPR).

    For a given angle the differences of the three circles are linear in x and y, and the first circle is left: a
    polynomial of degree 6 in the tangent of half the angle, of which the changes of sign are bracketed (Hunt, 1983).
    """

    def place(angle: Array) -> Array:
        c, s = np.cos(angle), np.sin(angle)
        corners = np.einsum("ijp,kj->pki", np.array([[c, -s], [s, c]]), platform) - base  # at (x, y) = 0
        rows = 2 * (corners[:, 1:] - corners[:, :1])
        right = (legs[1:] ** 2 - legs[0] ** 2) - (np.sum(corners[:, 1:] ** 2, -1) - np.sum(corners[:, :1] ** 2, -1))
        return np.linalg.solve(rows, right[..., None])[..., 0]

    def circle(angle: Array) -> Array:
        c, s = np.cos(angle), np.sin(angle)
        corners = np.einsum("ijp,kj->pki", np.array([[c, -s], [s, c]]), platform) - base
        rows = 2 * (corners[:, 1:] - corners[:, :1])
        at = place(angle)
        return (np.sum((corners[:, 0] + at) ** 2, -1) - legs[0] ** 2) * np.linalg.det(rows) ** 2

    angles = np.linspace(-np.pi, np.pi, 20001) + 1e-5
    values = circle(angles)
    found = []
    for k in np.flatnonzero(values[:-1] * values[1:] < 0):
        root = brentq(lambda angle: circle(np.array([angle]))[0], angles[k], angles[k + 1], xtol=1e-15)
        found.append([*place(np.array([root]))[0], root])
    return np.array(found)
