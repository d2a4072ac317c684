"""What legs move: the hinge of a knee brace, the seat of a rowing machine, a pedal on its crank."""

from __future__ import annotations

from functools import partial

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, laid, rivet, screw, tube, union


@kind
def knee_brace(random):
    """Two bars on sleeves between bolted plates, a shell riveted to each bar, a strap's loop on a pin at each shell."""
    drawing, play = Drawing(["thigh shell"]), random.choice([0.03, 0.1, 0.2])
    bend, apart = random.uniform(0.1, 0.5), random.uniform(14, 16)
    pivots = {"thigh": at(0, apart, 0), "calf": at(0, -apart, 0)}
    for name, z in (("inner", 0), ("outer", 6.3)):
        plate = bar(pivots["thigh"], pivots["calf"], 15, z, z + 2, tuple(pivots.values()), 2.1)
        drawing.add(f"{name} plate", plate.faces(">Z" if z else "<Z").edges().chamfer(0.4))
    for name, p, s, turn in (("thigh", pivots["thigh"], 1, 0.0), ("calf", pivots["calf"], -1, bend)):
        along = at(np.sin(turn), s * np.cos(turn), 0)
        across = np.cross(Z, along)
        lie = partial(laid, origin=p, x=along, z=Z)

        pins = [at(x, 0, 0) for x in (110, 150)]
        arm = union(bar((0, 0), (60, 0), apart - 0.4, 2.1, 6.2), bar((0, 0), (170, 0), 9, 2.1, 6.2))
        drawing.add(f"{name} bar", lie(cut(arm, bore(0 * Z, Z, 3 + play), *(bore(q, Z, 2.5) for q in pins))))
        drawing.add(f"{name} sleeve", tube(p + 2 * Z, Z, 2.05, 3, 4.3))
        drawing.add(f"{name} screw", screw(p + 8.3 * Z, -Z, 2, 12))
        drawing.add(f"{name} nut", hexagon(p, -Z, 3.5, 3.2, 2))
        shell = cut(tube((85, 0, -68), X, 67, 70, 90), box((0, -100, -200), (300, 100, -68)))
        shell = union(shell, box((100, -12, -3), (160, 12, 2.1)))
        edge = at(0, 68.5, -73.5)
        for low in (100, 124.4):
            shell = union(shell, cyl(edge + low * X, X, 5, 6), box((low, 67, -73.5), (low + 6, 70, -66)))
        shell = cut(shell, *(bore(q, Z, 2.5, 20) for q in pins), bore(edge + 115 * X, X, 2, 40))
        drawing.add(f"{name} shell", lie(shell))
        for number, q in enumerate(pins):
            drawing.add(f"{name} rivet {number}", lie(rivet(q - 3 * Z, Z, 2.5, 9.2)))
        loop = union(cyl(edge + 106.1 * X, X, 4.5, 18.2), box(edge + at(106.1, -2, -24), edge + at(124.3, 2, 0)))
        slot = box(edge + at(109, -5, -20), edge + at(121.4, 5, -8))
        drawing.add(f"{name} loop", lie(cut(loop, slot, bore(edge, X, 2 + play))))
        drawing.add(f"{name} loop pin", lie(rivet(edge + 100 * X, X, 2, 30.4)))
        drawing.joint("Weld", f"{name} shell", f"{name} bar")
        drawing.joint("Revolute", f"{name} bar", "inner plate", p, Z)
        drawing.joint("Revolute", f"{name} loop", f"{name} shell", p + edge[1] * across + edge[2] * Z, along)
    drawing.joint("Weld", "outer plate", "inner plate")
    return drawing


@kind
def rowing_seat(random):
    """A carriage with four wheels on a rail, two shoes around its flange, a seat screwed on, a stop at the end."""
    drawing, play = Drawing(["rail"]), random.choice([0.1, 0.2])
    middle, stop = random.uniform(-60, 60) * X, 280 * X
    holes = [stop + at(0, y, 0) for y in (-12, 12)]
    rail = union(box((-300, -30, -4), (300, 30, 0)), box((-300, -4, -44), (300, 4, -3)))
    drawing.add("rail", cut(rail, *(bore(p, Z, 2, 10) for p in holes)))
    corners = [middle + at(x, y, 20) for x in (-44, 44) for y in (-37, 37)]
    clamps = [middle + at(x, s * 34, 20) for s in (-1, 1) for x in (-12, 12)]
    axles = {"front": middle + at(34, 0, 12), "rear": middle + at(-34, 0, 12)}
    carriage = box(middle + at(-52, -44, 20), middle + at(52, 44, 24))
    carriage = union(carriage, *(box(middle + at(-48, s * 20.2, 5), middle + at(48, s * 24.2, 21)) for s in (-1, 1)))
    wells = [box(p + at(-13.5, -20.2, -9), p + at(13.5, 20.2, 13)) for p in axles.values()]
    carriage = cut(carriage, *wells, *(bore(p, Y, 4) for p in axles.values()))
    drawing.add(
        "carriage", cut(carriage, *(bore(p, Z, 2.7, 30) for p in corners), *(bore(p, Z, 2.2, 30) for p in clamps))
    )
    for name, p in axles.items():
        drawing.add(f"{name} axle", headed(p - 24.2 * Y, Y, 4, 55))
        drawing.add(f"{name} nut", hexagon(p + 24.2 * Y, Y, 6.5, 5, 4))
        drawing.add(f"{name} spacer", tube(p - 10 * Y, Y, 4.1, 6, 20))
        for side, s in (("left", 1), ("right", -1)):
            wheel = tube(p + s * 10.5 * Y, s * Y, 8, 12, 9).faces("<Y or >Y").edges().chamfer(0.5)
            drawing.add(f"{name} {side} wheel", wheel)
            drawing.add(f"{name} {side} bearing", tube(p + s * 10 * Y, s * Y, 4, 8, 10))
            drawing.joint("Revolute", f"{name} {side} wheel", "carriage", p, Y)
    flange = box((-400, -30 - play, -4 - play), (400, 30 + play, 0.3))
    for side, s in (("left", 1), ("right", -1)):
        shoe = cut(box(middle + at(-20, s * 24.5, -10), middle + at(20, s * 40, 20)), flange)
        drawing.add(f"{side} shoe", cut(shoe, *(cyl(p, -Z, 2, 14) for p in clamps)))
        drawing.joint("Weld", f"{side} shoe", "carriage")
    for number, p in enumerate(clamps):
        drawing.add(f"shoe screw {number}", screw(p + 4 * Z, -Z, 2, 16))
    seat = union(
        box(middle + at(-70, -60, 24), middle + at(70, 60, 34)),
        box(middle + at(-70, -60, 30), middle + at(-45, 60, 55)),
    )
    seat = cut(seat.edges("|Z").fillet(8), *(cyl(p, Z, 2.5, 12) for p in corners))
    drawing.add("seat", cut(seat, *(cyl(p, Z, 4, 9) for p in clamps)))
    for number, p in enumerate(corners):
        drawing.add(f"seat screw {number}", screw(p, Z, 2.5, 11))
    drawing.add("stop", cut(box(stop + at(-9, -20, 0), stop + at(9, 20, 16)), *(bore(p, Z, 2.2) for p in holes)))
    for number, p in enumerate(holes):
        drawing.add(f"stop screw {number}", screw(p + 16 * Z, -Z, 2, 20))
    drawing.joint("Prismatic", "carriage", "rail", 0 * X, X)
    drawing.joint("Weld", "seat", "carriage")
    drawing.joint("Weld", "stop", "rail")
    return drawing


@kind
def bicycle_pedal(random):
    """An axle with a flange in a crank, a body on a bush and a bearing with a ring, cages with reflectors, a cap."""
    drawing, play = Drawing(["crank"]), random.choice([0.02, 0.06])
    long, wide = random.uniform(165, 175), random.uniform(42, 48)
    crank = laid(bar((0, 0), (0, long), 13, -14, 0), 0 * X, Y, X)
    crank = union(crank, laid(cyl((0, long, -22), Z, 19, 22), 0 * X, Y, X))
    square = laid(box((-6.4, long - 6.4, -30), (6.4, long + 6.4, 9)), 0 * X, Y, X)
    drawing.add("crank", cut(crank, bore(0 * X, X, 7, 50), square))
    drawing.add("axle washer", tube(0 * X, X, 7.1, 11, 1))
    flats = [box((2, s * 7.5, -20), (7, s * 20, 20)) for s in (-1, 1)]
    axle = union(cyl(-14 * X, X, 7, 15), cut(cyl(X, X, 9.5, 6), *flats), cyl(7 * X, X, 6, 53), cyl(60 * X, X, 4, 20))
    drawing.add("axle", cut(axle, hexagon(-14 * X, X, 3, 8)))
    body = union(cyl(10 * X, X, 14, 82), box((16, -wide, -5), (86, wide, 5)))
    body = cut(body, bore(0 * X, X, 8, 61), cyl(60 * X, X, 9, 60), cyl(68.1 * X, X, 10, 1.1))
    body = cut(body, box((30, 18, -9), (72, wide - 6, 9)), box((30, -18, -9), (72, 6 - wide, 9)))
    cap = [11.5 * at(0, np.cos(a), np.sin(a)) + 92 * X for a in np.arange(3) * 2 * np.pi / 3 + 0.5]
    bolts = {side: [at(x, s * wide, 0) for x in (23, 79)] for side, s in (("front", 1), ("back", -1))}
    holes = [cyl(p, -np.sign(p[1]) * Y, 1.5, 12) for each in bolts.values() for p in each]
    drawing.add("pedal body", cut(body, *holes, *(cyl(p, -X, 1, 8) for p in cap)))
    drawing.add("bush", union(tube(10 * X, X, 6 + play, 8.02, 18), tube(8.5 * X, X, 6 + play, 11, 1.5)))
    drawing.add("bearing", tube(60 * X, X, 4, 9, 8).faces("<X or >X").edges().chamfer(0.2))
    drawing.add("ring", cut(tube(68.1 * X, X, 8, 10, 1), box((60, -2, 0), (80, 2, 20))))
    drawing.add("bearing washer", tube(68 * X, X, 4.1, 6, 1.5))
    drawing.add("axle nut", hexagon(69.5 * X, X, 6, 6, 4))
    plate = cut(cyl(92 * X, X, 14, 3), *(bore(p, X, 1.1, 9) for p in cap))
    drawing.add("end cap", plate)
    for number, p in enumerate(cap):
        drawing.add(f"cap screw {number}", screw(p + 3 * X, -X, 1, 9))
    for side, s in (("front", 1), ("back", -1)):
        cage = cut(
            box((12, s * wide, -13), (90, s * (wide + 3), 13)), box((34, s * (wide - 1), 6), (68, s * (wide + 9), 20))
        )
        drawing.add(f"{side} cage", cut(cage, *(bore(p, Y, 1.7, 9) for p in bolts[side])))
        reflector = box((17, s * (wide + 3), -5), (85, s * (wide + 7), 5)).edges("|Y").fillet(2)
        drawing.add(f"{side} reflector", cut(reflector, *(bore(p, Y, 1.7, 9) for p in bolts[side])))
        for number, p in enumerate(bolts[side]):
            drawing.add(f"{side} screw {number}", screw(p + s * 7 * Y, -s * Y, 1.5, 17))
        drawing.joint("Weld", f"{side} cage", "pedal body")
        drawing.joint("Weld", f"{side} reflector", "pedal body")
    drawing.joint("Weld", "axle", "crank")
    drawing.joint("Revolute", "pedal body", "axle", 0 * X, X)
    drawing.joint("Weld", "bush", "pedal body")
    drawing.joint("Weld", "end cap", "pedal body")
    return drawing
