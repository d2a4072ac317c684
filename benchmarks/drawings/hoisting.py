"""What pulls: a winch with a pawl, the pulley of a gym's column, a turnbuckle between two brackets."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.office import compound
from drawings.shapes import (
    Shape,
    X,
    Y,
    Z,
    at,
    bar,
    bore,
    box,
    cut,
    cyl,
    headed,
    hexagon,
    laid,
    screw,
    sphere,
    torus,
    tube,
    union,
)  # fmt: skip


def _ratchet(outer: float, root: float, teeth: int, low: float, high: float) -> Shape:
    """A wheel with saw teeth about y, between two heights."""
    angles = 2 * np.pi * np.arange(teeth) / teeth
    points = [(radius * np.cos(turn), radius * np.sin(turn)) for turn in angles for radius in (root, outer)]
    wheel = cq.Workplane().polyline(points).close().extrude(high - low)
    return laid(wheel, low * Y, X, Y)


@kind
def rope_winch(random):
    """A drum with a ratchet wheel pinned to its shaft in a bent frame, a pawl on a shoulder bolt, a crank, a grip."""
    drawing, play = Drawing(["frame"]), random.choice([0.03, 0.1])
    pawl, tie, long = at(-48, 0, 30), at(-50, 0, -35), random.uniform(100, 125)
    frame = union(box((-62, -40, -60), (45, 40, -54)), *(box((-62, s * 36, -60), (45, s * 40, 45)) for s in (-1, 1)))
    feet = [at(x, y, -60) for x in (-50, 33) for y in (-20, 20)]
    frame = cut(frame, bore(0 * Y, Y, 10), *(bore(p, Z, 5, 20) for p in feet), cyl(pawl + 30 * Y, Y, 3.1, 20))
    drawing.add("frame", cut(frame, bore(tie, Y, 4.2)))
    for name, s in (("left", -1), ("right", 1)):
        bush = union(tube(s * 34 * Y, s * Y, 8 + play, 14, 2), tube(s * 36 * Y, s * Y, 8 + play, 10.02, 4))
        drawing.add(f"{name} bush", bush)
        drawing.joint("Weld", f"{name} bush", "frame")
    square = box((-5.5, 42, -5.5), (5.5, 56, 5.5)).edges("|Y").chamfer(0.3)
    shaft = union(cyl(-46 * Y, Y, 8, 88), square, cyl(55 * Y, Y, 4, 15))
    groove = tube(-41.3 * Y, Y, 6.5, 8, 1.1)
    drawing.add("shaft", cut(shaft, groove, bore(0 * Y, X, 2.5, 20)))
    drawing.add("clip", cut(tube(-41.2 * Y, Y, 6.5, 12, 1), box((-3, -45, 0), (3, -35, 20))))
    core = union(cyl(-33.8 * Y, Y, 18, 59.6), cyl(-33.8 * Y, Y, 40, 4), cyl(21.8 * Y, Y, 40, 4))
    bolts = [25.8 * Y + 22 * at(np.cos(a), 0, np.sin(a)) for a in np.arange(3) * 2 * np.pi / 3 + 0.3]
    core = cut(core, bore(0 * Y, Y, 8), bore(0 * Y, X, 2.5, 60), *(bore(p, Y, 2.5, 5) for p in bolts))
    drawing.add("drum", cut(core, bore(at(30, -32, 0), Y, 3, 4)))
    drawing.add("cross pin", cyl(-17.5 * X, X, 2.5, 35).faces("<X or >X").chamfer(0.4))
    wheel = union(_ratchet(36, 30, 14, 25.8, 31.8), cyl(31 * Y, Y, 14, 2.8))
    wheel = cut(wheel, bore(0 * Y, Y, 8.1), *(bore(p, Y, 2.7, 20) for p in bolts))
    drawing.add("ratchet wheel", cut(wheel, *(cyl(p + 1.5 * Y, Y, 4.3, 9) for p in bolts)))
    for number, p in enumerate(bolts):
        drawing.add(f"ratchet screw {number}", screw(p + 1.5 * Y, -Y, 2.5, 5))
    tip = at(-7.1, 40.4)
    shape = laid(bar((-48, -30), (tip[0], -tip[1]), 4, 0, 5).union(cyl((-48, -30, 0), Z, 9, 5)), 26.3 * Y, X, Y)
    drawing.add("pawl", cut(shape, bore(pawl, Y, 4 + play)))
    bolt = union(cyl(pawl + 26.1 * Y, Y, 4, 9.9), cyl(pawl + 36 * Y, Y, 3, 10), cyl(pawl + 22.1 * Y, Y, 7, 4))
    drawing.add("pawl bolt", cut(bolt, hexagon(pawl + 22.1 * Y, Y, 2, 2.5)))
    drawing.add("pawl spacer", tube(pawl + 31.5 * Y, Y, 4.1, 7, 4.4))
    drawing.add("pawl nut", hexagon(pawl + 40 * Y, Y, 5, 5, 3))
    drawing.add("tie tube", tube(tie - 36 * Y, Y, 4.3, 7, 72))
    drawing.add("tie bolt", headed(tie - 40 * Y, Y, 4, 86.5))
    drawing.add("tie nut", hexagon(tie + 40 * Y, Y, 6.5, 6, 4))
    crank = laid(bar((0, 0), (long, 0), 11, 0, 10), 47 * Y, X, Y).union(cyl(42 * Y, Y, 15, 15))
    knob = long * X
    hole = box((-5.55, 40, -5.55), (5.55, 60, 5.55))
    drawing.add("crank", cut(crank, hole, bore(knob, Y, 4)))
    drawing.add("crank washer", tube(57 * Y, Y, 4.2, 10, 1.5))
    drawing.add("crank nut", hexagon(58.5 * Y, Y, 6.5, 6.5, 4))
    pin = union(cyl(knob + 57 * Y, Y, 5, 58), cyl(knob + 40 * Y, Y, 4, 17), cyl(knob + 115 * Y, Y, 8, 4))
    drawing.add("grip bolt", cut(pin, hexagon(knob + 116 * Y, Y, 2.5, 4)))
    drawing.add("grip nut", hexagon(knob + 41 * Y, Y, 6.5, 6, 4))
    drawing.add("grip", tube(knob + 57.3 * Y, Y, 5 + 2 * play, 12, 57.4).faces("<Y or >Y").edges().fillet(0.5))
    drawing.joint("Revolute", "shaft", "frame", 0 * Y, Y)
    drawing.joint("Weld", "drum", "shaft")
    drawing.joint("Weld", "ratchet wheel", "drum")
    drawing.joint("Revolute", "pawl", "frame", pawl, Y)
    drawing.joint("Weld", "tie tube", "frame")
    drawing.joint("Weld", "crank", "shaft")
    drawing.joint("Revolute", "grip", "crank", knob, Y)
    return drawing


@kind
def gym_pulley(random):
    """A carriage with liners on a square column, a pin that is pulled against a spring, a bracket with a pulley."""
    drawing, play = Drawing(["column"]), random.choice([0.05, 0.15])
    low = random.uniform(180, 260)
    middle = low + 45
    column = cut(box((-25, -25, 8), (25, 25, 480)), box((-22, -22, -9), (22, 22, 500)))
    column = union(column, box((-70, -70, 0), (70, 70, 8)))
    column = cut(column, *(cyl((0, -20, z), -Y, 5.2, 9) for z in range(60, 470, 30)))
    drawing.add("column", cut(column, *(bore(at(x, y, 0), Z, 5.5, 20) for x in (-55, 55) for y in (-55, 55))))
    carriage = union(
        box((-33, -33, low), (33, 33, low + 90)),
        cyl((0, -33, middle), -Y, 12, 37),
        *(bar((0, 20), (0, 62), 14, middle + s * 25 - 4, middle + s * 25 + 4) for s in (-1, 1)),
    )
    swivel, axle, sides = at(0, 62, middle), at(0, 128, middle), [(s, z) for z in (low + 8, low + 82) for s in (-1, 1)]
    carriage = cut(
        carriage,
        box((-28, -28, 0), (28, 28, 500)),
        cyl((0, -20, middle), -Y, 5 + play, 30),
        cyl((0, -38, middle), -Y, 7.8, 50),
        bore(swivel, Z, 6.05, 40),
        *(cyl((s * 27, 0, z), s * X, 1.7, 9) for s, z in sides),
    )
    drawing.add("carriage", carriage)
    hollow = box((-25 - play, -25 - play, 0), (25 + play, 25 + play, 500))
    for name, z, s in (("lower", low, 1), ("upper", low + 90, -1)):
        liner = union(box((-28, -28, z), (28, 28, z + s * 16)), box((-33, -33, z), (33, 33, z - s * 2)))
        drawing.add(f"{name} liner", cut(liner, hollow, bore((0, 0, z + s * 8), X, 1.5, 50)))
        drawing.joint("Weld", f"{name} liner", "carriage")
    for number, (s, z) in enumerate(sides):
        drawing.add(f"liner screw {number}", screw((s * 33, 0, z), -s * X, 1.5, 7))
    pull = at(0, 0, middle)
    pin = union(cyl(pull - 27 * Y, -Y, 5, 22), cyl(pull - 49 * Y, -Y, 7.5, 3), cyl(pull - 52 * Y, -Y, 4, 46))
    drawing.add("pull pin", cut(pin, cyl(pull - 84 * Y, -Y, 2, 20)))
    drawing.add("pin bush", union(tube(pull - 70 * Y, Y, 4.1, 7.8, 8), hexagon(pull - 70 * Y, -Y, 11, 4, 4.1)))
    drawing.add("pin spring", compound(*(torus(pull - y * Y, Y, 5.6, 0.9) for y in (53, 55.5, 58.3, 61))))
    knob = cut(sphere(pull - 102 * Y, 14), cyl(pull - 80 * Y, -Y, 4, 18), bore(pull, Y, 2.1))
    drawing.add("pull knob", cut(knob, cyl(pull - 106 * Y, -Y, 4, 20), cyl(pull - 80 * Y, -Y, 20, 10)))
    drawing.add("knob screw", screw(pull - 106 * Y, Y, 2, 18))
    bracket = union(
        cyl(swivel - 20.8 * Z, Z, 13, 41.6),
        box(at(-19, 70, middle - 18), at(19, 78, middle + 18)),
        *(box(at(s * 14, 70, middle - 13), at(s * 19, 141, middle + 13)) for s in (-1, 1)),
    )
    bracket = cut(bracket, bore(swivel, Z, 8, 40), bore(axle, X, 5.1, 40))
    drawing.add("bracket", cut(bracket, *(cyl(swivel + s * 18.8 * Z, s * Z, 11, 5) for s in (-1, 1))))
    for name, s in (("lower", -1), ("upper", 1)):
        bush = union(
            tube(swivel + s * 7 * Z, s * Z, 6 + play, 8.02, 12), tube(swivel + s * 18.8 * Z, s * Z, 6 + play, 10.9, 2)
        )
        drawing.add(f"{name} bush", bush)
        drawing.joint("Weld", f"{name} bush", "bracket")
    drawing.add("swivel bolt", headed(swivel + 29 * Z, -Z, 6, 70))
    drawing.add("swivel nut", hexagon(swivel - 29 * Z, -Z, 9, 10, 6))
    pulley = cut(cyl(axle - 8 * X, X, 45, 16), torus(axle, X, 46, 5), bore(axle, X, 9, 20))
    drawing.add("pulley", cut(pulley, *(cyl(axle + s * 3 * X, s * X, 11, 9) for s in (-1, 1))))
    for name, s in (("left", -1), ("right", 1)):
        drawing.add(f"{name} bearing", tube(axle + s * 3 * X, s * X, 5, 11, 5))
        drawing.add(f"{name} spacer", tube(axle + s * 8 * X, s * X, 5.1, 7, 6))
    drawing.add("inner spacer", tube(axle - 3 * X, X, 5.1, 7, 6))
    drawing.add("pulley bolt", headed(axle - 19 * X, X, 5, 48))
    drawing.add("pulley nut", hexagon(axle + 19 * X, X, 8, 8, 5))
    drawing.joint("Prismatic", "carriage", "column", 0 * Z, Z)
    drawing.joint("Weld", "pin bush", "carriage")
    drawing.joint("Cylindrical", "pull pin", "carriage", pull, Y)
    drawing.joint("Weld", "pull knob", "pull pin")
    drawing.joint("Revolute", "bracket", "carriage", swivel, Z)
    drawing.joint("Revolute", "pulley", "bracket", axle, X)
    return drawing


@kind
def turnbuckle(random):
    """A body with two threads, a jaw and an eye in it, pinned and bolted to the lugs of a wall and of a mast."""
    drawing, play = Drawing(["wall plate", "mast"], "INCH"), random.choice([0.02, 0.1, 0.3])
    drawn = random.uniform(0, 12)
    left, right = at(-110 - drawn, 0, 0), at(110 + drawn, 0, 0)
    body = union(
        *(cyl((s * 45, 0, 0), s * X, 11, 18) for s in (-1, 1)), *(cyl((-50, s * 13, 0), X, 4, 100) for s in (-1, 1))
    )
    body = union(body, *(box((s * 46, -13, -4), (s * 54, 13, 4)) for s in (-1, 1)))
    drawing.add("body", cut(body, bore(0 * X, X, 6)))
    fork = union(cyl(left + 24 * X, X, 6, 65), box(left + at(14, -12, -12), left + at(24, 12, 12)))
    fork = union(fork, *(laid(bar((0, 0), (20, 0), 12, -3, 3), left + s * 9 * Y, X, Y) for s in (-1, 1)))
    drawing.add("jaw", cut(fork, bore(left, Y, 5 + play)))
    eye = union(cyl(right - 12 * X, -X, 6, 77), laid(cyl(-7.0 * Z, Z, 15, 14), right, X, Y))
    drawing.add("eye", cut(eye, bore(right, Y, 7)))
    drawing.add("eye bush", tube(right - 7 * Y, Y, 5 + play, 7.02, 14))
    for name, x in (("jaw", -73), ("eye", 67)):
        drawing.add(f"{name} lock nut", hexagon((x, 0, 0), X, 9, 6, 6))
    holes = [at(0, y, z) for y in (-28, 28) for z in (-28, 28)]
    plate = union(
        box(left + at(-32, -40, -40), left + at(-24, 40, 40)), box(left + at(-24, -5.9, -12), left + at(0, 5.9, 12))
    )
    plate = union(plate, cyl(left - 5.9 * Y, Y, 12, 11.8))
    plate = cut(plate, bore(left, Y, 5), *(bore(left - 28 * X + p, X, 4.2, 9) for p in holes))
    drawing.add("wall plate", plate)
    pin = cut(headed(left - 12 * Y, Y, 5, 30), bore(left + 15 * Y, X, 1.2, 9))
    drawing.add("clevis pin", pin)
    drawing.add("pin washer", tube(left + 12.1 * Y, Y, 5.2, 9, 1.5))
    drawing.add("split pin", cyl(left + 15 * Y - 8 * X, X, 1.2, 16))
    mast = union(box(right + at(26, -30, -30), right + at(34, 30, 30)),
                 *(box(right + at(-12, s * 7.3, -12), right + at(26, s * 14, 12)) for s in (-1, 1)))  # fmt: skip
    bolts = [right + at(26, 0, z) for z in (-22, 22)]
    drawing.add("mast lug", cut(mast, bore(right, Y, 5.05), *(bore(p, X, 3.2, 9) for p in bolts)))
    drawing.add(
        "mast", cut(box(right + at(34, -30, -200), right + at(94, 30, 200)), *(bore(p, X, 3, 30) for p in bolts))
    )
    for number, p in enumerate(bolts):
        drawing.add(f"lug screw {number}", screw(p, X, 3, 24))
    drawing.add("eye bolt", headed(right - 14 * Y, Y, 5, 38))
    for s, name in ((-1, "left"), (1, "right")):
        drawing.add(f"{name} shim", tube(right + s * 7 * Y, s * Y, 5.1, 9, 0.2))
    drawing.add("eye nut", hexagon(right + 14 * Y, Y, 8, 8, 5))
    drawing.joint("Revolute", "jaw", "wall plate", left, Y)
    drawing.joint("Cylindrical", "body", "jaw", 0 * X, X)
    drawing.joint("Cylindrical", "body", "eye", 0 * X, X)
    drawing.joint("Weld", "eye bush", "eye")
    drawing.joint("Revolute", "eye", "mast lug", right, Y)
    drawing.joint("Weld", "mast lug", "mast")
    return drawing
