"""What turns on bearings: an arm of a robot, an engine with a split connecting rod."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import ball_bearing, hollow
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, screw, tube, union


@kind
def robot_arm(random):
    """A turret on a thin bearing, a shoulder in a flanged housing with two bearings, an elbow on flanged bushes."""
    drawing, play = Drawing(["pedestal"], unit="INCH"), random.choice([0.0, 0.05])
    upper, fore = random.uniform(180, 230), random.uniform(140, 180)
    pedestal = cut(cyl((0, 0, -80), Z, 60, 80), cyl((0, 0, -14), Z, 45, 20), bore(0 * X, Z, 38, 200))
    seats = hollow((0, 0, -80), Z, 52, 4)
    drawing.add("pedestal", cut(pedestal, *(bore(p, Z, 3.3, 10) for p in seats)))
    ball_bearing(drawing, "turret", (0, 0, -14), Z, 30, 45, 14)
    spots = hollow((0, 0, 0), Z, 52, 6)
    drawing.add("retainer", cut(tube((0, 0, 0), Z, 42, 58, 4), *(bore(p, Z, 2.2, 10) for p in spots)))
    drawing.parts["pedestal"] = cut(drawing.parts["pedestal"], *(cyl(p - 14 * Z, Z, 2, 15) for p in spots))
    for k, p in enumerate(spots):
        drawing.add(f"retainer screw {k}", screw(p + 4 * Z, -Z, 2, 14))
    turret = union(
        cyl((0, 0, -30), Z, 12, 20),
        cyl((0, 0, -14), Z, 30, 26),
        cyl((0, 0, 10), Z, 56, 10),
        box((-20, 20, 16), (60, 32, 110)),
    )
    shoulder = at(20, 0, 80)
    turret = cut(turret, bore(shoulder, Y, 21, 60), bore(0 * X, Z, 9, 100))
    rim = hollow(shoulder + 20 * Y, Y, 27, 4, 0.785)
    drawing.add("turret", cut(turret, *(bore(p, Y, 1.6, 20) for p in rim)))
    drawing.add("turret ring nut", tube((0, 0, -14), -Z, 12, 35, 8))
    housing = union(cyl(shoulder + 20 * Y, -Y, 32, 5), cyl(shoulder + 15 * Y, Y, 21, 30))
    housing = cut(
        housing, bore(shoulder, Y, 12, 100), cyl(shoulder + 15 * Y, Y, 16, 7), cyl(shoulder + 45 * Y, -Y, 16, 7)
    )
    drawing.add("shoulder housing", cut(housing, *(bore(p, Y, 1.7, 30) for p in rim)))
    for k, p in enumerate(rim):
        drawing.add(f"housing screw {k}", screw(p - 5 * Y, Y, 1.6, 17))
    for k, y in enumerate((15.0, 38.0)):
        ball_bearing(drawing, f"shoulder {k}", shoulder + y * Y, Y, 8, 16, 7)
    shaft = union(cyl(shoulder - 8 * Y, Y, 8, 63), cyl(shoulder + 15 * Y, -Y, 10.5, 5))
    shaft = cut(shaft, tube(shoulder + 45.5 * Y, Y, 7.2, 9, 1.5))
    drawing.add("shoulder shaft", shaft)
    drawing.add("shoulder clip", circlip(shoulder + 45.5 * Y, Y, 8, 1.5))
    drawing.add("shoulder spacer", tube(shoulder + 22 * Y, Y, 8, 10, 16))
    elbow = shoulder + upper * Z
    drawing.add("clamp screw", screw(shoulder + at(14, -3, 15), -X, 2.5, 26))
    plate = box(shoulder + at(-20, -8, -20), shoulder + at(20, 2, upper * 0.7))
    fork = [box(elbow + at(-16, y, -0.3 * upper), elbow + at(16, y + 6, 12)) for y in (-20, 8)]
    fork.append(box(elbow + at(-16, -20, -0.32 * upper), elbow + at(16, 14, -0.3 * upper + 2)))
    arm = cut(union(plate, *fork), bore(shoulder, Y, 8, 60), box(shoulder + at(-0.8, -9, 0), shoulder + at(0.8, 3, 25)))
    arm = cut(
        arm,
        cyl(shoulder + at(14, -3, 15), X, 4.2, 10),
        bore(shoulder + at(0, -3, 15), X, 2.5, 30),
        bore(elbow, Y, 9, 40),
    )
    drawing.add("upper arm", arm)
    for k, (y, way) in enumerate(((-20.0, 1.0), (14.0, -1.0))):
        bush = union(
            tube(elbow + y * Y, way * Y, 6 + play, 9, 6), tube(elbow + (y + 6 * way) * Y, way * Y, 6 + play, 12, 1.5)
        )
        drawing.add(f"elbow bush {k}", bush)
        drawing.joint("Weld", f"elbow bush {k}", "upper arm")
    wrist = elbow + fore * X
    forearm = union(
        box(elbow + at(-14, -12.5, -14), elbow + at(fore - 50, 6.5, 14)), cyl(elbow + (fore - 50) * X, X, 19, 50)
    )
    forearm = cut(forearm, bore(elbow, Y, 6, 60), cyl(wrist - 22 * X, X, 13, 30), cyl(elbow + at(0, -3, 20), -Z, 2, 40))
    drawing.add("forearm", cut(forearm, bore(wrist, X, 10, 45)))
    pin = cut(cyl(elbow - 23 * Y, Y, 6, 40), cyl(elbow + at(0, -3, 20), -Z, 2, 40))
    drawing.add("elbow pin", union(pin, cyl(elbow - 20 * Y, -Y, 10, 3)))
    drawing.add("elbow dowel", cyl(elbow + at(0, -3, 14), -Z, 2, 28))
    drawing.add("elbow ring", tube(elbow + 14 * Y, Y, 6, 9, 2))
    for k in range(2):
        ball_bearing(drawing, f"wrist {k}", wrist + (-22 + 8 * k) * X, X, 6, 13, 8)
    drawing.add(
        "wrist shaft", union(cyl(wrist - 26 * X, X, 6, 32), cyl(wrist - 26 * X, X, 8, 4), cyl(wrist - 6 * X, X, 9, 6))
    )
    tool = cut(cyl(wrist + X, X, 25, 9), cyl(wrist - X, X, 6, 7))
    grips = hollow(wrist, X, 18, 4)
    drawing.add("tool flange", cut(tool, *(bore(p, X, 2, 20) for p in grips), bore(wrist, X, 1.6, 20)))
    drawing.parts["wrist shaft"] = cut(drawing.parts["wrist shaft"], cyl(wrist - 8 * X, X, 1.6, 20))
    drawing.add("flange screw", screw(wrist + 10 * X, -X, 1.6, 16))
    drawing.joint("Revolute", "turret", "pedestal", (0, 0, 0), Z)
    drawing.joint("Weld", "retainer", "pedestal")
    drawing.joint("Weld", "shoulder housing", "turret")
    drawing.joint("Revolute", "shoulder shaft", "shoulder housing", shoulder, Y)
    drawing.joint("Weld", "upper arm", "shoulder shaft")
    drawing.joint("Revolute", "forearm", "upper arm", elbow, Y)
    drawing.joint("Revolute", "wrist shaft", "forearm", wrist, X)
    drawing.joint("Weld", "tool flange", "wrist shaft")
    return drawing


@kind
def split_engine(random):
    """A crank in two shells, a connecting rod with cap, bolts and half shells, a gudgeon pin with circlips, a liner."""
    drawing, play, throw = Drawing(["crankcase"]), random.choice([0.0, 0.03]), random.uniform(20, 26)
    turn = random.uniform(0.4, 1.1)
    p, rod = throw * at(np.sin(turn), np.cos(turn), 0), 95.0
    g = at(0, p[1] + np.sqrt(rod**2 - p[0] ** 2), 0)
    case = cut(box((-60, -62, -44), (60, 55, 44)), box((-52, -54, -32), (52, 56, 32)), bore(0 * X, Z, 13, 100))
    studs = [at(x, 55, z) for x in (-46, 46) for z in (-38, 38)]
    drawing.add("crankcase", cut(case, *(cyl(q + Y, -Y, 3, 20) for q in studs)))
    for s in (-1, 1):
        bush = union(tube((0, 0, s * 32), s * Z, 11 + play, 13, 12), tube((0, 0, s * 32), -s * Z, 11 + play, 16, 2))
        drawing.add(f"main bush {s}", bush)
        drawing.joint("Weld", f"main bush {s}", "crankcase")
    webs = [cyl((0, 0, s * 28), -s * Z, 18, 14) for s in (-1, 1)]
    webs += [bar((0, 0), p, 15, *sorted((s * 28, s * 14))) for s in (-1, 1)]
    webs += [cyl(-0.6 * p + s * 28 * Z, -s * Z, 24, 14) for s in (-1, 1)]
    crank = union(*webs, cyl(p - 15 * Z, Z, 12, 30), cyl((0, 0, -80), Z, 11, 55), cyl((0, 0, 25), Z, 11, 40))
    drawing.add("crank", cut(crank, box((-2.5, 7, -81), (2.5, 12, -50))))
    way = (g - p) / np.linalg.norm(g - p)
    side = np.cross(Z, way)
    big = cyl(p - 12 * Z, Z, 20, 24)
    ears = [cyl(p + s * 20 * side - 14 * way, way, 6, 28) for s in (-1, 1)]
    half_space = union(cyl(p - 300 * way, way, 290, 300))
    head = cut(union(big, *ears, cyl(p, way, 8, rod), cyl(g - 10 * Z, Z, 13, 20)), bore(p, Z, 14), bore(g, Z, 9))
    bolts = [p + s * 20 * side for s in (-1, 1)]
    head = cut(head, half_space, *(bore(q, way, 2.5, 40) for q in bolts))
    drawing.add("connecting rod", head)
    cap = cut(union(big, *ears), bore(p, Z, 14), cyl(p, way, 290, 300), *(bore(q, way, 2.6, 40) for q in bolts))
    drawing.add("cap", cap)
    shell = tube(p - 11 * Z, Z, 12 + play, 14, 22)
    drawing.add("upper shell", cut(shell, half_space))
    drawing.add("lower shell", cut(shell, cyl(p, way, 290, 300)))
    for k, q in enumerate(bolts):
        drawing.add(f"cap bolt {k}", cut(union(cyl(q - 14 * way, way, 2.5, 32), hexagon(q - 14 * way, -way, 4, 3))))
        drawing.add(f"cap nut {k}", hexagon(q + 14 * way, way, 4, 4, 2.5))
    drawing.add("small bush", tube(g - 10 * Z, Z, 7 + play, 9, 20))
    top = g[1] + 22
    piston = cut(cyl((0, g[1] - 20, 0), Y, 29.9, 42), cyl((0, g[1] - 21, 0), Y, 25, 36))
    bosses = union(*(cyl(g + s * 11 * Z, s * Z, 12, 16) for s in (-1, 1)))
    piston = union(piston, bosses.intersect(cyl((0, g[1] - 20, 0), Y, 29, 40)))
    rings = [tube((0, top - y, 0), -Y, 27, 31, 2) for y in (3, 7)]
    clips = [tube(g + s * 26.5 * Z, s * Z, 6, 7.6, 1) for s in (-1, 1)]
    drawing.add("piston", cut(piston, *rings, bore(g, Z, 7, 60), *clips))
    for k, y in enumerate((3, 7)):
        ring = tube((0, top - y, 0), -Y, 27.3, 30, 2)
        drawing.add(f"piston ring {k}", cut(ring, box((25, top - y - 3, -0.5), (35, top - y + 1, 0.5))))
    drawing.add("gudgeon pin", tube(g - 26 * Z, Z, 4, 7, 52))
    for s, clip in zip((-1, 1), clips, strict=True):
        ring = cut(clip, box(g + at(-3, 2, s * 26), g + at(3, 9, s * 28)))
        drawing.add(f"gudgeon clip {s}", ring)
    block = cut(box((-60, 55, -44), (60, 62, 44)), bore(0 * X, Y, 33, 400))
    block = union(block, tube((0, 55, 0), Y, 33, 40, top - 30))
    drawing.add("cylinder", cut(block, *(bore(q, Y, 3.2, 30) for q in studs)))
    drawing.add("liner", tube((0, 55, 0), Y, 30, 33, top - 30))
    for k, q in enumerate(studs):
        drawing.add(f"stud {k}", cyl(q - 19 * Y, Y, 3, 36))
        drawing.add(f"stud nut {k}", hexagon(q + 7 * Y, Y, 5, 5, 3))
    wheel = cut(cyl((0, 0, -78), Z, 50, 14), bore(0 * X, Z, 11, 100), box((-2.5, 0, -80), (2.5, 13.5, -60)))
    drawing.add("flywheel", wheel)
    drawing.add("key", box((-2.5, 7, -78), (2.5, 13.5, -64)))
    drawing.joint("Revolute", "crank", "crankcase", (0, 0, 0), Z)
    drawing.joint("Revolute", "connecting rod", "crank", p, Z)
    drawing.joint("Weld", "cap", "connecting rod")
    drawing.joint("Weld", "upper shell", "connecting rod")
    drawing.joint("Weld", "lower shell", "cap")
    drawing.joint("Weld", "small bush", "connecting rod")
    drawing.joint("Revolute", "piston", "connecting rod", g, Z)
    drawing.joint("Cylindrical", "piston", "liner", (0, 0, 0), Y)
    drawing.joint("Weld", "liner", "cylinder")
    drawing.joint("Weld", "cylinder", "crankcase")
    drawing.joint("Weld", "flywheel", "crank")
    return drawing
