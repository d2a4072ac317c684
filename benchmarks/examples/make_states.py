"""Draw a pair of solids in every contact state and variant: `python benchmarks/examples/make_states.py`.

Each pair is placed askew. Its two parts are named after the state, the region and the variant, with 1 for the part of
surface 1. Each is drawn in a frame of its own, so that the placements, which readers keep in single precision, differ
within a pair.
"""

from __future__ import annotations

from pathlib import Path

import cadquery as cq
import numpy as np
from shapes import write

FILE = Path(__file__).parents[2] / "tests" / "contacts" / "data" / "states.step"

X, Y, Z = np.eye(3)
SPACING = 150.0
AL, BE, SEAT = 0.4, 0.3, 0.5  # half angles of cones


def cylinder(radius, start, end):
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(end - start))
    return cq.Solid.makeCylinder(radius, length, cq.Vector(*start), cq.Vector(*(end - start)))


def cone(half_angle, apex, axis, low, high):
    """The part of a cone between two heights over its apex."""
    radii = (low * np.tan(half_angle), high * np.tan(half_angle))
    start = np.asarray(apex, float) + low * np.asarray(axis)
    return cq.Solid.makeCone(*radii, high - low, cq.Vector(*start), cq.Vector(*axis))


def ball(radius, centre):
    return cq.Solid.makeSphere(radius, cq.Vector(), cq.Vector(0, 0, 1), -90, 90, 360).translate(cq.Vector(*centre))


def box(low, high):
    low, high = np.asarray(low, float), np.asarray(high, float)
    return cq.Solid.makeBox(*(high - low), cq.Vector(*low))


def lean(angle, along, up):
    return np.cos(angle) * along + np.sin(angle) * up


def pairs():
    """Name of the state, its region and variant -> the solid with surface 1, the solid with surface 2."""
    across = lean(0.9, X, Y)
    ruling, inwards = lean(SEAT, Z, X), lean(SEAT, -X, Z)  # of the seat
    floor, rod = box([-30, -30, -8], [30, 30, 0]), cylinder(10, -30 * X, 30 * X)
    bore = box([-16, -16, 0], [16, 16, 30]).cut(cylinder(10, -Z, 31 * Z))
    seat = box([-22, -22, 2], [22, 22, 30]).cut(cone(SEAT, [0, 0, 0], Z, 0.5, 40))
    socket = box([-14, -14, -14], [14, 14, 0]).cut(ball(10, [0, 0, 0]))
    low_cone = cone(SEAT, [0, 0, 0], lean(-SEAT, X, Z), 4, 30)
    hollow = box([-5, -25, -8], [50, 25, 45])
    return {
        "a surface flat": (floor, box([-7, -14, 0], [13, 16, 10])),
        "b line roller": (floor, cylinder(15, [-10, 4, 15], [20, 4, 15])),
        "c line cone": (floor, cone(AL, [1, 2, 0], lean(AL, X, Z), 5, 20)),
        "d point ball": (floor, ball(11, [3, 2, 11])),
        "e surface pin": (bore, cylinder(10, -10 * Z, 35 * Z)),
        "f line outside": (cylinder(10, 0 * Z, 30 * Z), cylinder(5, [15, 0, -5], [15, 0, 35])),
        "f line inside": (bore, cylinder(8, [2, 0, -10], [2, 0, 35])),
        "g point crossed": (rod, cylinder(5, 15 * Z - 15 * across, 15 * Z + 15 * across)),
        "h line outside": (rod, cone(AL, [0, 0, 10], lean(AL, X, Z), 5, 20)),
        "h line cone in hole": (
            box([-15, -35, -35], [30, 35, 35]).cut(cylinder(30, -40 * X, 40 * X)),
            cone(AL, [0, 0, -30], lean(AL, X, Z), 5, 20),
        ),
        "h line pin in cone": (cylinder(2, 0 * X, 15 * X), hollow.cut(cone(AL, [-10, 0, -2], lean(AL, X, Z), 0.5, 90))),
        "i point crossed": (rod, cone(AL, 10 * Z - 17 * across, lean(AL, across, Z), 5, 30)),
        "j circle ball in bore": (bore, ball(10, [0, 0, 13])),
        "j point outside": (rod, ball(5, [3, 0, 15])),
        "j point inside": (bore, ball(4, [6, 0, 13])),
        "k surface plug": (seat, cone(SEAT, [0, 0, 0], Z, 5, 25)),
        "l line outside": (low_cone, cone(AL, [6, 0, 0], lean(AL, X, Z), 2, 20)),
        "l line inside": (
            hollow.cut(cone(AL, [0, 0, 0], lean(AL, X, Z), 0.5, 90)),
            cone(BE, [5, 0, 0], lean(BE, X, Z), 2, 20),
        ),
        "m point crossed": (low_cone, cone(AL, 10 * X - 8 * across, lean(AL, across, Z), 2, 20)),
        "n circle ball in seat": (seat, ball(6, [0, 0, 6 / np.sin(SEAT)])),
        "n point outside": (cone(SEAT, [0, 0, 0], Z, 2, 30), ball(6, 15 * ruling - 6 * inwards)),
        "n point inside": (seat, ball(3, 15 * ruling + 3 * inwards)),
        "o surface socket": (socket, ball(10, [0, 0, 0])),
        "p point outside": (ball(10, [0, 0, 0]), ball(5, [12, 9, 0])),
        "p point inside": (socket, ball(5, [0, 0, -5])),
    }


def placement(rng, translation):
    axis = rng.normal(size=3)
    return cq.Location(cq.Vector(*translation), cq.Vector(*axis), float(rng.uniform(0, 360)))


def main():
    rng = np.random.default_rng(1998)
    assembly = cq.Assembly(name="states")
    for number, (name, (first, second)) in enumerate(pairs().items()):
        place = placement(rng, [SPACING * (number % 5), SPACING * (number // 5), rng.uniform(-50, 50)])
        for part, solid in ((1, first), (2, second)):
            own = placement(rng, rng.uniform(-30, 30, 3))
            assembly.add(cq.Workplane(obj=solid.moved(own.inverse)), name=f"{name} {part}", loc=place * own)
    write(assembly, FILE)


if __name__ == "__main__":
    main()
