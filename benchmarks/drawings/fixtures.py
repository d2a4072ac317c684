"""A stand that telescopes, a ball valve, and a carriage whose wheels run in the slots of a profile."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import hollow
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, hexagon, screw, sphere, tube, union


@kind
def telescopic_stand(random):
    """A square tube in another with glides, a loose clamp screw, a head that swivels and tilts, a plate on screws."""
    drawing, play = Drawing(["base"]), random.choice([0.1, 0.2])
    rise = random.uniform(180, 220)
    feet = [at(x, y, 0) for x in (-30, 30) for y in (-30, 30)]
    flange = box((-40, -40, 10), (40, 40, 16))
    drawing.add("base", cut(box((-120, -100, 0), (120, 100, 10)), *(bore(p, Z, 3) for p in feet)))
    column = union(flange, cut(box((-20, -20, 16), (20, 20, 160)), box((-17, -17, 16), (17, 17, 161))))
    column = cut(column, *(bore(p, Z, 3.3) for p in feet), cyl((-30, 0, 140), X, 3, 20))
    drawing.add("column", column)
    for number, p in enumerate(feet):
        drawing.add(f"foot screw {number}", screw(p + 16 * Z, -Z, 3, 14))
    drawing.add("clamp screw", union(cyl((-26, 0, 140), X, 3, 10), cyl((-38, 0, 140), X, 12, 12)))
    glide = cut(box((-17, -17, 145), (17, 17, 160)), box((-15, -15, 140), (15, 15, 170)))
    drawing.add("glide", union(glide, cut(box((-20, -20, 160), (20, 20, 162)), box((-15, -15, 150), (15, 15, 170)))))
    low = cut(box((-17 + play, -17 + play, 60), (17 - play, 17 - play, 70)), box((-15, -15, 50), (15, 15, 80)))
    drawing.add("low glide", low)
    tube_ = cut(box((-15, -15, 60), (15, 15, rise)), box((-13, -13, 50), (13, 13, rise - 10)))
    drawing.add("inner tube", cut(tube_, bore((0, 0, rise), Z, 8)))
    drawing.add("low glide plug", box((-13, -13, 60), (13, 13, 66)))
    collar = union(
        cyl((0, 0, rise), Z, 14, 20), box((-6, -25, rise + 20), (6, 25, rise + 26)), cyl((0, 0, rise + 10), Z, 14, 12)
    )
    cheeks = [box((-12, y, rise + 20), (12, y + 5 * np.sign(y), rise + 55)) for y in (-20, 20)]
    tilt = at(0, 0, rise + 42)
    collar = cut(union(collar, *cheeks), bore(tilt, Y, 4), cyl((0, 0, rise - 1), Z, 8 + play, 20))
    drawing.add("swivel", collar)
    drawing.add("post", union(cyl((0, 0, rise - 10), Z, 8, 27), tube((0, 0, rise - 14), Z, 7, 11, 4)))
    block = union(cyl(tilt - 19 * Y, Y, 10, 38), box(tilt + at(0, -15, -6), tilt + at(30, 15, 6)))
    drawing.add("tilt block", cut(block, bore(tilt, Y, 4 + play)))
    for side in (-1, 1):
        drawing.add(f"friction washer {side}", tube(tilt + (19 if side > 0 else -20) * Y, Y, 4, 9, 1))
    drawing.add("tilt screw", screw(tilt - 25 * Y, Y, 4, 58))
    drawing.add("tilt nut", hexagon(tilt + 25 * Y, Y, 6.5, 6, 4))
    holes = [tilt + at(30, y, z) for y in (-10, 10) for z in (-3, 3)]
    corners = [tilt + at(30, y, z) for y in (-37.5, 37.5) for z in (-37.5, 37.5)]
    plate = cut(box(tilt + at(30, -45, -45), tilt + at(33, 45, 45)), *(bore(p, X, 2.2, 10) for p in corners))
    drawing.add("plate", cut(plate, *(bore(p, X, 1.5, 10) for p in holes)))
    drawing.parts["tilt block"] = cut(drawing.parts["tilt block"], *(cyl(p - 8 * X, X, 1.5, 9) for p in holes))
    screen = cut(box(tilt + at(33, -150, -90), tilt + at(50, 150, 90)), *(cyl(p, X, 2, 12) for p in corners))
    drawing.add("screen", screen)
    for number, p in enumerate(corners):
        drawing.add(f"plate screw {number}", screw(p, X, 2, 12))
    drawing.joint("Weld", "column", "base")
    drawing.joint("Weld", "glide", "column")
    drawing.joint("Weld", "low glide", "inner tube")
    drawing.joint("Prismatic", "inner tube", "column", 0 * X, Z)
    drawing.joint("Revolute", "swivel", "inner tube", at(0, 0, rise), Z)
    drawing.joint("Revolute", "tilt block", "swivel", tilt, Y)
    drawing.joint("Weld", "plate", "tilt block")
    drawing.joint("Weld", "screen", "plate")
    return drawing


@kind
def ball_valve(random):
    """A ball between two seats in a body of two halves, a stem with a tongue, packing, a gland, a lever with a nut."""
    drawing, play = Drawing(["body"]), random.choice([0.0, 0.1])
    size = random.uniform(15, 17)
    ring = hollow(0 * X, X, size + 13, 4, np.pi / 4)
    body = union(cyl((-60, 0, 0), X, size + 20, 84), cyl((0, 0, 0), Z, 16, size + 42))
    body = cut(body, cyl((-70, 0, 0), X, 8, 80), cyl((-size - 6, 0, 0), X, size + 4, 90), bore((0, 0, 40), Z, 6, 38))
    drawing.add("body", cut(body, cyl((0, 0, size + 24), Z, 10, 40), *(cyl(p - 5 * X, X, 3, 30) for p in ring)))
    cap = union(
        cyl((24, 0, 0), X, size + 20, 14),
        cyl((38, 0, 0), X, size + 4, 20),
        cyl((size + 6, 0, 0), X, size + 4, 24 - size),
    )
    drawing.add("cap", cut(cap, bore(0 * X, X, 8), *(bore(p + 30 * X, X, 3.3, 15) for p in ring)))
    for number, p in enumerate(ring):
        drawing.add(f"cap screw {number}", screw(p + 38 * X, -X, 3, 30))
    slot = box((-20, -3, size - 6), (20, 3, size + 5))
    drawing.add("ball", cut(sphere(0 * X, size), bore(0 * X, X, 8), slot))
    seat = cut(tube((-size - 6, 0, 0), X, 8, size + 4, 10), sphere(0 * X, size))
    drawing.add("front seat", seat)
    drawing.add("rear seat", seat.rotate((0, 0, 0), (0, 0, 1), 180))
    stem = union(cyl((0, 0, size + 0.5), Z, 6, 60), cut(cyl((0, 0, size - 5), Z, 6, 6), *_sides(3 - play, size - 6)))
    flats = [box((x, -9, size + 50), (x + 5 * np.sign(x), 9, size + 80)) for x in (-4, 4)]
    drawing.add("stem", cut(stem, *flats, tube((0, 0, size + 55), Z, 4, 8, 20)))
    drawing.add("packing", tube((0, 0, size + 24), Z, 6, 10, 9))
    drawing.add(
        "gland", union(tube((0, 0, size + 33), Z, 6 + play, 10, 12), tube((0, 0, size + 42), Z, 6 + play, 15, 4))
    )
    lever = box((-12, -12, size + 50), (120, 12, size + 55))
    drawing.add("lever", cut(lever, cut(cyl((0, 0, size + 45), Z, 6, 20), *flats)))
    drawing.add("lever nut", hexagon((0, 0, size + 55), Z, 7, 5, 4))
    drawing.joint("Weld", "cap", "body")
    drawing.joint("Weld", "front seat", "body")
    drawing.joint("Revolute", "stem", "body", 0 * X, Z)
    drawing.joint("Weld", "ball", "stem")
    drawing.joint("Weld", "lever", "stem")
    drawing.joint("Weld", "packing", "body")
    return drawing


def _sides(half: float, low: float):
    """What is cut away beside a tongue along x."""
    return [box((-20, y, low), (20, y + 20 * np.sign(y), low + 6.5)) for y in (-half, half)]


def _profile(long: float) -> Shape:
    """An extruded bar along x, 20 mm square, with a slot in each side that opens in the shape of a V."""
    shape = box((0, -10, -10), (long, 10, 10))
    outline = [
        (4.8, 10),
        (3, 8.2),
        (5.5, 8.2),
        (5.5, 6.5),
        (3, 4),
        (-3, 4),
        (-5.5, 6.5),
        (-5.5, 8.2),
        (-3, 8.2),
        (-4.8, 10),
    ]
    slot = cq.Workplane("YZ").polyline(outline).close().extrude(long)
    for turn in range(4):
        shape = shape.cut(slot.rotate((0, 0, 0), (1, 0, 0), 90.0 * turn))
    return shape.cut(bore((0, 0, 0), X, 2.1))


def _wheel(point) -> Shape:
    """A wheel about y whose rim fits the slot."""
    outline = [(8, -5.5), (9.4, -5.5), (11.95, -2.95), (11.95, 2.95), (9.4, 5.5), (8, 5.5)]
    wheel = cq.Workplane("XY").polyline(outline).close().revolve(360, (0, 0, 0), (0, 1, 0))
    return wheel.translate(tuple(np.asarray(point, float).tolist()))


@kind
def v_slot_carriage(random):
    """A plate on three wheels with bearings in the slots of a profile, one on an eccentric; a stop on a slot nut."""
    drawing, long = Drawing(["profile"]), random.uniform(280, 320)
    where = random.uniform(100, 180)
    drawing.add("profile", _profile(long))
    end = cut(box((-4, -20, -20), (0, 20, 20)), bore(0 * X, X, 2.6), *(bore(at(0, y, 15), X, 1.6) for y in (-15, 15)))
    drawing.add("end plate", end)
    drawing.add("end screw", screw(-4 * X, X, 2.5, 20))
    hubs = [at(where + x, 0, z) for x, z in ((-25, 20.1), (25, 20.1), (0, -20.1))]
    plate = box((where - 40, 16, -40), (where + 40, 22, 40))
    plate = cut(plate, *(bore(p, Y, r) for p, r in zip(hubs, (2.55, 2.55, 3.6), strict=True)))
    drawing.add("plate", cut(plate, *(bore(at(where + x, 0, 0), Y, 2.6) for x in (-10, 10))))
    for number, hub in enumerate(hubs):
        drawing.add(f"wheel {number}", _wheel(hub))
        for side, y in (("near", 0.5), ("far", -5.5)):
            drawing.add(f"{side} bearing {number}", tube(hub + y * Y, Y, 2.5, 8, 5))
        drawing.add(f"shim {number}", tube(hub - 0.5 * Y, Y, 2.6, 4, 1))
        if number < 2:
            drawing.add(f"spacer {number}", tube(hub + 5.5 * Y, Y, 2.55, 5, 10.5))
        else:
            nut = union(hexagon(hub + 5.5 * Y, Y, 5, 10.5), cyl(hub + 16 * Y, Y, 3.6, 4))
            drawing.add("eccentric", cut(nut, bore(hub, Y, 2.55)))
        drawing.add(f"axle screw {number}", screw(hub + 22 * Y, -Y, 2.5, 33))
        drawing.add(f"axle nut {number}", hexagon(hub - 9.5 * Y, Y, 4, 4, 2.5))
    stop = union(box((30, -13, -9), (60, -10, 9)), box((57, -30, -9), (60, -10, 9)))
    drawing.add("stop", cut(stop, bore((42, 0, 0), Y, 2.6, 40)))
    drawing.add("slot nut", cut(box((37, -8.2, -5), (47, -6.7, 5)), bore((42, 0, 0), Y, 2.5)))
    drawing.add("stop screw", screw((42, -13, 0), Y, 2.5, 7))
    drawing.joint("Weld", "end plate", "profile")
    drawing.joint("Prismatic", "plate", "profile", 0 * X, X)
    for number, hub in enumerate(hubs):
        drawing.joint("Revolute", f"wheel {number}", "plate", hub, Y)
    drawing.joint("Weld", "stop", "profile")
    drawing.joint("Weld", "eccentric", "plate")
    return drawing
