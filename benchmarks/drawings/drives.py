"""What motors move: an arm of servos, a walking leg, an axis with a lead screw, a planetary gearbox."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, meet, screw, sphere, torus, tube, union


@kind
def servo_arm(random):
    """Two servos, one with a spline of its own, horns and a bracket on patterns of holes, an elbow without its pin."""
    drawing, play, length = Drawing(["base"]), random.choice([0.0, 0.05]), random.uniform(70, 95)
    base = union(box((-40, -60, -6), (40, 40, 0)), box((-10, -38, 0), (10, -31, 26)), box((-10, 11, 0), (10, 18, 26)))
    ears = [at(x, y, 26) for x in (-5, 5) for y in (-34, 14)]
    drawing.add("base", cut(base, *(cyl(p - 10 * Z, Z, 1.25, 10) for p in ears)))
    case = union(box((-10, -30, 0), (10, 10, 38)), box((-10, -38, 26), (10, 18, 29)))
    drawing.add("servo 1", cut(case, *(bore(p, Z, 2.1, 5) for p in ears), cyl((0, 0, 34), Z, 3, 5)))
    for k in (0, 3):
        drawing.add(f"ear screw {k}", screw(ears[k] + 3 * Z, -Z, 1.5, 10))
    drawing.add("spline", cut(cyl((0, 0, 34), Z, 3 - play, 9), cyl((0, 0, 37), Z, 1.25, 6)))
    drawing.add("spline screw", screw((0, 0, 43), -Z, 1.25, 5))
    ring = [at(7 * np.cos(a), 7 * np.sin(a), 0) for a in np.pi / 4 + np.arange(4) * np.pi / 2]
    drawing.add("horn 1", cut(tube((0, 0, 40), Z, 3 - play, 10, 3), *(bore(p + 41 * Z, Z, 1, 5) for p in ring)))
    shoulder = at(0, 0, 78)
    bracket = union(
        box((-22, -14, 43), (22, 34, 48)),
        box((-22, -14, 43), (-18, 34, 95)),
        box((17, -14, 43), (21, 34, 95)),
        box((-22, 30, 43), (21, 34, 95)),
    )
    backs = [at(x, 30, z) for x in (-10, 10) for z in (71, 85)]
    drawing.add(
        "turret",
        cut(
            bracket,
            bore((0, 0, 45), Z, 4, 6),
            *(bore(p + 45 * Z, Z, 1, 6) for p in ring),
            cyl(shoulder + 15 * X, X, 12, 8),
            cyl(shoulder - 24 * X, X, 4, 8),
            *(bore(p + 2 * Y, Y, 1.6, 5) for p in backs),
        ),
    )
    servo = union(box((-14, -10, 66), (14, 30, 90)), cyl(shoulder + 14 * X, X, 3, 8))
    drawing.add("servo 2", cut(servo, *(cyl(p - 8 * Y, Y, 1.25, 9) for p in backs)))
    side = [at(0, p[0], p[1]) + shoulder for p in ring]
    drawing.add("horn 2", cut(tube(shoulder + 18.5 * X, X, 3, 10, 3.5), *(bore(p + 20 * X, X, 1, 6) for p in side)))
    elbow = shoulder + length * Z
    plates = [box(at(x, -10, 66), at(x + 3, 10, elbow[2] + 10)) for x in (22, -25.5)]
    link = union(*plates, box((-25.5, -5, elbow[2] - 28), (25, 5, elbow[2] - 16)))
    drawing.add(
        "link",
        cut(
            link,
            *(bore(p + 23 * X, X, 1, 3) for p in side),
            cyl(shoulder + 21 * X, X, 4, 5),
            cyl(shoulder - 26 * X, X, 1.6, 5),
            bore(elbow, X, 2),
        ),
    )
    drawing.add(
        "idler bearing", union(tube(shoulder - 22 * X, X, 1.5, 4, 4), tube(shoulder - 22.4 * X, X, 1.5, 5, 0.4))
    )
    drawing.add("idler screw", screw(shoulder - 25.5 * X, X, 1.5, 10))
    drawing.add("idler nut", hexagon(shoulder - 18 * X, X, 2.75, 2.4, 1.5))
    boss = union(cyl(elbow - 21.5 * X, X, 8, 43.5), box(elbow + at(-6, 4, -5), elbow + at(6, 90, 5)))
    drawing.add("forearm", cut(boss, bore(elbow, X, 2 + play)))
    drawing.add("loose washer", tube(elbow - 22.4 * X, X, 2.1, 5, 0.8))
    drawing.joint("Weld", "servo 1", "base")
    drawing.joint("Revolute", "spline", "servo 1", (0, 0, 0), Z)
    drawing.joint("Weld", "horn 1", "spline")
    drawing.joint("Weld", "turret", "horn 1")
    drawing.joint("Weld", "servo 2", "turret")
    drawing.joint("Revolute", "horn 2", "servo 2", shoulder, X)
    drawing.joint("Weld", "link", "horn 2")
    drawing.joint("Revolute", "forearm", "link", elbow, X)
    return drawing


@kind
def walking_leg(random):
    """A leg after Jansen: bars in three layers on screws with nuts, some washers, a crank on a shaft with a flat."""
    drawing, play, turn = Drawing(["frame"]), random.choice([0.05, 0.15]), random.uniform(0, 2 * np.pi)
    pivot = at(-38, -7.8, 0)
    wrist = 15 * at(np.cos(turn), np.sin(turn), 0)

    def plane(one, first, other, second):
        return at(*meet(one[:2], first, other[:2], second), 0)

    top, knee = plane(pivot, 41.5, wrist, 50), plane(wrist, 61.9, pivot, 39.3)
    left = plane(pivot, 40.1, top, 55.8)
    ankle = plane(knee, 36.7, left, 39.4)
    toe = plane(knee, 49, ankle, 65.7)
    hole = 1.5 + play
    low, mid, high = (5.0, 8.0), (9.0, 12.0), (13.0, 16.0)

    def plate(corners, level, holes, radius=hole):
        pairs = zip(corners, [*corners[1:], *corners[:1]], strict=True) if len(corners) > 2 else [corners]
        return cut(union(*(bar(p, q, 5, *level) for p, q in pairs)), *(bore(p, Z, radius) for p in holes))

    frame = cut(bar((0, 0), pivot, 12, 0, 4), bore((0, 0, 0), Z, 5), bore(pivot, Z, 1.25))
    drawing.add("frame", frame)
    drawing.add("shaft bearing", tube((0, 0, 0), Z, 2.5, 5, 4))
    flat = box((1.9, -5, 4.5), (6, 5, 20))
    drawing.add("shaft", cut(cyl((0, 0, -15), Z, 2.5, 23), flat))
    crank = cut(bar((0, 0), wrist, 5, *low), cut(cyl((0, 0, 4), Z, 2.5, 6), flat))
    drawing.add("crank", cut(crank, bore(wrist, Z, 1.25)))
    drawing.add("upper", plate([pivot, top, left], low, [pivot, top, left]))
    drawing.add("foot", plate([knee, ankle, toe], low, [knee, ankle]))
    for name, ends, level in (
        ("rod j", (wrist, top), mid),
        ("rod k", (wrist, knee), high),
        ("rod c", (pivot, knee), mid),
        ("rod f", (left, ankle), mid),
    ):
        drawing.add(name, plate(list(ends), level, ends))
    for name, point, z, nut in (
        ("wrist", wrist, high[1], False),
        ("pivot", pivot, mid[1], False),
        ("top", top, mid[1], True),
        ("knee", knee, high[1], True),
        ("left", left, mid[1], True),
        ("ankle", ankle, mid[1], True),
    ):
        bottom = 5.5 if name == "wrist" else 0.5 if name == "pivot" else 2.0
        drawing.add(f"screw {name}", screw(point + z * Z, -Z, 1.5, z - bottom))
        if nut:
            drawing.add(f"nut {name}", hexagon(point + 2.6 * Z, Z, 2.75, 2.4, 1.5))
    for name, point, z in (("a", wrist, 8.1), ("b", wrist, 12.1), ("c", knee, 12.0), ("d", pivot, 4.0)):
        drawing.add(f"washer {name}", tube(point + z * Z, Z, 1.6, 3.5, 0.8))
    drawing.joint("Weld", "crank", "shaft")
    drawing.joint("Revolute", "shaft", "frame", (0, 0, 0), Z)
    for one, other, point in (
        ("upper", "frame", pivot),
        ("rod c", "frame", pivot),
        ("rod j", "crank", wrist),
        ("rod k", "crank", wrist),
        ("rod j", "upper", top),
        ("rod f", "upper", left),
        ("rod k", "foot", knee),
        ("rod c", "foot", knee),
        ("rod f", "foot", ankle),
    ):
        drawing.joint("Revolute", one, other, point, Z)
    return drawing


@kind
def lead_screw_axis(random):
    """A motor, a coupling, a lead screw in a bearing, a carriage with bushes on two rods; most screws not drawn."""
    drawing, level, play = Drawing(["base"]), random.uniform(90, 180), random.choice([0.0, 0.02])
    corners = [at(x, y, 0) for x in (-15.5, 15.5) for y in (-15.5, 15.5)]
    sides = [at(s * 40, 0, 0) for s in (-1, 1)]
    backs = [at(x, 30, z) for x in (-30, 30) for z in (2.5, 278.5)]
    taps = [cyl(p - 10 * Y, Y, 1.25, 10) for p in backs]
    base = cut(box((-60, -30, 0), (60, 30, 5)), bore((0, 0, 0), Z, 11.2, 9), *(bore(p, Z, 1.6, 9) for p in corners))
    drawing.add("base", cut(base, *(bore(p, Z, 5, 9) for p in sides), *taps))
    motor = union(box((-21, -21, -40), (21, 21, 0)), cyl((0, 0, 0), Z, 11, 2), cyl((0, 0, 0), Z, 2.5, 24))
    drawing.add("motor", cut(motor, *(cyl(p - 5 * Z, Z, 1.25, 6) for p in corners)))
    clamps = [at(5.5, -9, z) for z in (18, 31)]
    coupling = cut(cyl((0, 0, 12), Z, 9.5, 25), cyl((0, 0, 11), Z, 2.5, 14), cyl((0, 0, 25), Z, 4, 14))
    drawing.add("coupling", cut(coupling, *(bore(p, Y, 1.25, 30) for p in clamps)))
    for k, p in enumerate(clamps):
        drawing.add(f"clamp screw {k}", cyl(p + 2 * Y, Y, 1.25, 14))
    drawing.add("lead screw", cyl((0, 0, 26), Z, 4, 258))
    top = cut(box((-60, -30, 276), (60, 30, 281)), bore((0, 0, 280), Z, 9, 20), *taps)
    drawing.add("top plate", cut(top, *(bore(p + 280 * Z, Z, 5, 20) for p in sides)))
    drawing.add("inner ring", tube((0, 0, 276), Z, 4, 5.5, 5))
    drawing.add("outer ring", cut(tube((0, 0, 276), Z, 7, 9, 5), torus((0, 0, 278.5), Z, 6.25, 1.2)))
    drawing.parts["inner ring"] = cut(drawing.parts["inner ring"], torus((0, 0, 278.5), Z, 6.25, 1.2))
    balls = [sphere((6.25 * np.cos(a), 6.25 * np.sin(a), 278.5), 1.2) for a in np.arange(8) * np.pi / 4]
    drawing.add("balls", union(*balls))
    drawing.add("collar", cut(tube((0, 0, 268), Z, 4, 8, 8), cyl((0, 0, 272), X, 1.25, 9)))
    drawing.add("grub screw", cyl((4, 0, 272), X, 1.25, 4))
    pattern = [at(8 * np.cos(a), 8 * np.sin(a), level) for a in np.pi / 4 + np.arange(4) * np.pi / 2]
    carriage = cut(box((-60, -25, level), (60, 25, level + 10)), bore((0, 0, level), Z, 5.1, 40))
    drawing.add(
        "carriage",
        cut(carriage, *(bore(p, Z, 1.5, 40) for p in pattern), *(bore(p + level * Z, Z, 9.5, 40) for p in sides)),
    )
    nut = union(tube((0, 0, level - 3.5), Z, 4 + play, 11, 3.5), tube((0, 0, level - 8), Z, 4 + play, 5, 20))
    drawing.add("lead nut", cut(nut, *(bore(p, Z, 1.75, 6) for p in pattern)))
    for k, p in enumerate(sides):
        drawing.add(f"rod {k}", cyl(p, Z, 5, 281))
        drawing.add(f"bush {k}", tube(p + (level - 9) * Z, Z, 5 + play, 9.5, 29))
        drawing.joint("Weld", f"rod {k}", "base")
        drawing.joint("Weld", f"bush {k}", "carriage")
    drawing.add("back", cut(box((-60, 30, 0), (60, 34, 281)), *(bore(p, Y, 1.6) for p in backs)))
    drawing.joint("Weld", "back", "base")
    drawing.joint("Weld", "top plate", "back")
    drawing.joint("Weld", "motor", "base")
    drawing.joint("Revolute", "coupling", "motor", (0, 0, 0), Z)
    drawing.joint("Weld", "lead screw", "coupling")
    drawing.joint("Weld", "collar", "lead screw")
    drawing.joint("Revolute", "lead screw", "top plate", (0, 0, 0), Z)
    drawing.joint("Weld", "lead nut", "carriage")
    drawing.joint("Cylindrical", "lead screw", "lead nut", (0, 0, 0), Z)
    drawing.joint("Prismatic", "carriage", "base", (40, 0, 0), Z)
    return drawing


@kind
def planetary_gearbox(random):
    """A stack of plates on four long screws, a sun, planets without teeth on pins in a carrier, bearings as rings."""
    drawing, play = Drawing(["input plate"]), random.choice([0.0, 0.05])
    corners = [at(x, y, 0) for x in (-15.5, 15.5) for y in (-15.5, 15.5)]
    holes = [bore(p, Z, 1.6, 60) for p in corners]
    drawing.add("input plate", cut(box((-21, -21, -8), (21, 21, 0)), *holes, bore((0, 0, 0), Z, 8, 20)))
    drawing.add("ring", cut(box((-21, -21, 0), (21, 21, 14)), *holes, bore((0, 0, 0), Z, 17, 20)))
    housing = cut(
        box((-21, -21, 14), (21, 21, 38)),
        cyl((0, 0, 13), Z, 17, 6),
        cyl((0, 0, 13), Z, 11, 23),
        bore((0, 0, 0), Z, 8, 60),
    )
    drawing.add("output housing", cut(housing, *(cyl(p + 13 * Z, Z, 1.25, 18) for p in corners)))
    for k, p in enumerate(corners):
        drawing.add(f"long screw {k}", screw(p - 8 * Z, Z, 1.5, 36))
    drawing.add("sun", union(cyl((0, 0, 2.2), Z, 5, 9.8), cyl((0, 0, -25), Z, 2.5, 30)))
    drawing.add("input bearing", tube((0, 0, -6), Z, 2.5, 8, 5))
    pins = [at(11 * np.cos(a), 11 * np.sin(a), 0) for a in random.uniform(0, 2) + np.arange(3) * 2 * np.pi / 3]
    carrier = union(cyl((0, 0, 13), Z, 15, 5), cyl((0, 0, 13), Z, 5, 45))
    drawing.add("carrier", cut(carrier, *(bore(p + 15 * Z, Z, 2, 5) for p in pins)))
    for k, p in enumerate(pins):
        drawing.add(f"planet {k}", tube(p + 2.2 * Z, Z, 2 + play, 5.9, 9.8))
        drawing.add(f"pin {k}", cyl(p + 1 * Z, Z, 2, 17))
        drawing.add(f"clip {k}", tube(p + 1.2 * Z, Z, 2, 3.5, 0.8))
        drawing.joint("Weld", f"pin {k}", "carrier")
        drawing.joint("Revolute", f"planet {k}", "carrier", p, Z)
    for k, z in enumerate((20.0, 29.0)):
        drawing.add(f"output bearing {k}", tube((0, 0, z), Z, 5, 11, 7))
    drawing.add("spacer", tube((0, 0, 27.1), Z, 5.2, 7, 1.8))
    drawing.joint("Weld", "ring", "input plate")
    drawing.joint("Weld", "output housing", "ring")
    drawing.joint("Revolute", "sun", "input plate", (0, 0, 0), Z)
    drawing.joint("Revolute", "carrier", "output housing", (0, 0, 0), Z)
    return drawing
