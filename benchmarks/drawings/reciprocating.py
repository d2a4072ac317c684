"""What goes to and fro: a syringe pump, an oscillating engine, a sewing machine's needle bar, a Scott-Russell lift."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import ball_bearing, hollow
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, rivet, screw, torus, tube, union


@kind
def syringe_pump(random):
    """A carriage on two pressed rods, driven by a lead screw, pushes the plunger of a syringe held by the end plate."""
    drawing, play, length, c = Drawing(["motor plate"]), random.choice([0.0, 0.03]), 170.0, random.uniform(60, 75)
    rods, barrel = [at(0, y, 0) for y in (-27, 27)], at(0, 0, 32)
    drawing.add("foot", box((8, -40, -32), (length, 40, -24)))
    faces = hollow((0, 0, 0), X, 22, 4, 0.785)
    for name, x, way in (("motor plate", 0.0, X), ("end plate", length, -X)):
        plate = box((x, -42, -32), (x + 8, 42, 52 if name == "end plate" else 20))
        plate = cut(plate, *(bore(p, X, 3.98, 900) for p in rods))
        ties = [at(x + (0 if name == "motor plate" else 8), y, -28) for y in (-25, 25)]
        drawing.parts["foot"] = cut(drawing.parts["foot"], *(cyl(p + 8 * way, way, 1.25, 12) for p in ties))
        drawing.add(name, cut(plate, *(bore(p, X, 1.7, 12) for p in ties)))
        for k, p in enumerate(ties):
            drawing.add(f"{name} screw {k}", screw(p, way, 1.5, 20))
        drawing.joint("Weld", "foot", name)
    drawing.parts["motor plate"] = cut(drawing.parts["motor plate"], bore(0 * X, X, 11.2, 20))
    drawing.parts["motor plate"] = cut(drawing.parts["motor plate"], *(bore(p, X, 1.6, 20) for p in faces))
    spots = [at(length, s * 18, 32 + t * 15) for s in (-1, 1) for t in (-1, 1)]
    end = cut(drawing.parts["end plate"], cyl((length - 1, 0, 0), X, 11, 8), bore((length, 0, 0), X, 6, 20))
    end = cut(end, bore(barrel + length * X, X, 10.1, 20), *(bore(p, X, 1.25, 20) for p in spots))
    drawing.parts["end plate"] = end
    for k, p in enumerate(rods):
        drawing.add(f"rod {k}", cyl(p, X, 4, length + 8))
        drawing.joint("Weld", f"rod {k}", "motor plate")
    motor = cut(union(box((-40, -21, -21), (0, 21, 21)), cyl(0 * X, X, 11, 2)), cyl((-36, 0, 0), X, 2.52, 60))
    drawing.add("motor", cut(motor, *(cyl(p, -X, 1.5, 6) for p in faces)))
    for k, p in enumerate(faces):
        drawing.add(f"motor screw {k}", screw(p + 8 * X, -X, 1.5, 12))
    drawing.add("motor shaft", cyl((-36, 0, 0), X, 2.5, 58))
    coupling = cut(cyl((12, 0, 0), X, 9, 25), bore(0 * X, X, 2.5, 23), cyl((23, 0, 0), X, 4, 20))
    drawing.add("coupling", cut(coupling, *(cyl((x, 0, 0), Z, 1.25, 12) for x in (17, 32))))
    for x, r in ((17, 2.5), (32, 4)):
        drawing.add(f"grub screw {x}", cyl((x, 0, r), Z, 1.25, 5))
    drawing.add("lead screw", cyl((24, 0, 0), X, 4, length - 18))
    ball_bearing(drawing, "end bearing", (length, 0, 0), X, 4, 11, 7)
    carriage = union(box((c, -40, -14), (c + 30, 40, 14)), box((c, -22, 14), (c + 30, 22, 52)))
    ties, clips = hollow((c, 0, 0), X, 8, 4), [at(c + 30, s * 17, 33 + t * 14) for s in (-1, 1) for t in (-1, 1)]
    carriage = cut(carriage, *(bore(p, X, 7.49, 900) for p in rods), bore(0 * X, X, 5.2, 900))
    drawing.add("carriage", cut(carriage, *(cyl(p, X, 1.25, 9) for p in ties), *(cyl(p, -X, 1.25, 10) for p in clips)))
    for k, p in enumerate(rods):
        drawing.add(f"linear bearing {k}", tube(p + (c + 3) * X, X, 4 + play, 7.5, 24))
        drawing.joint("Weld", f"linear bearing {k}", "carriage")
    nut = union(cyl((c - 3.5, 0, 0), X, 11, 3.5), cyl((c - 10, 0, 0), X, 5.1, 25))
    drawing.add("lead nut", cut(nut, bore(0 * X, X, 4, 900), *(bore(p, X, 1.7, 5) for p in ties)))
    for k, p in enumerate(ties):
        drawing.add(f"nut screw {k}", screw(p - 3.5 * X, X, 1.5, 10))
    clip = cut(box((c + 30, -22, 14.2), (c + 37, 22, 52)), cyl(barrel + (c + 30) * X, X, 14.2, 3.1))
    clip = cut(clip, cyl(barrel + (c + 30) * X, X, 5.5, 9), box((c + 33, -5.5, 32), (c + 38, 5.5, 60)))
    drawing.add("clip", cut(clip, *(bore(p, X, 1.7, 9) for p in clips)))
    for k, p in enumerate(clips):
        drawing.add(f"clip screw {k}", screw(p + 7 * X, -X, 1.5, 16))
    tip = length + 45.0
    plunger = union(cyl(barrel + (c + 30) * X, X, 14, 3), cyl(barrel + (c + 30) * X, X, 4.5, tip - c - 30))
    drawing.add("plunger", plunger.union(cyl(barrel + (c + 40) * X, X, 6, tip - 8 - c - 40)))
    drawing.add("rubber piston", cut(cyl(barrel + (tip - 6) * X, X, 8.02, 10), cyl(barrel + (tip - 6) * X, X, 4.5, 6)))
    syringe = union(cyl(barrel + (length - 2) * X, X, 10, 82), cyl(barrel + (length - 2) * X, X, 14.5, 2))
    syringe = union(syringe, cyl(barrel + (length + 80) * X, X, 2.2, 10))
    drawing.add("barrel", cut(syringe, cyl(barrel + (length - 3) * X, X, 8, 81), bore(barrel + length * X, X, 1, 300)))
    keeper = cut(box((length - 6, -22, 13), (length, 22, 51)), cyl(barrel + (length - 2) * X, X, 14.6, 3))
    keeper = cut(keeper, bore(barrel + length * X, X, 9, 20), *(bore(p, X, 1.7, 20) for p in spots))
    drawing.add("keeper", keeper)
    for k, p in enumerate(spots):
        drawing.add(f"keeper screw {k}", screw(p - 6 * X, X, 1.5, 14))
    drawing.joint("Weld", "motor", "motor plate")
    drawing.joint("Revolute", "motor shaft", "motor", (0, 0, 0), X)
    drawing.joint("Weld", "coupling", "motor shaft")
    drawing.joint("Weld", "lead screw", "coupling")
    drawing.joint("Revolute", "lead screw", "end plate", (0, 0, 0), X)
    drawing.joint("Cylindrical", "lead screw", "lead nut", (0, 0, 0), X)
    drawing.joint("Weld", "lead nut", "carriage")
    drawing.joint("Prismatic", "carriage", "motor plate", (0, 0, 0), X)
    drawing.joint("Weld", "clip", "carriage")
    drawing.joint("Weld", "plunger", "carriage")
    drawing.joint("Weld", "rubber piston", "plunger")
    drawing.joint("Weld", "keeper", "end plate")
    drawing.joint("Weld", "barrel", "end plate")
    return drawing


@kind
def oscillating_engine(random):
    """A cylinder that rocks on a pivot pressed to the column by a spring; a crank disc, a flywheel."""
    drawing, play, turn = Drawing(["base"]), random.choice([0.0, 0.03, 0.1]), random.uniform(-0.9, 0.9)
    o, p = at(0, 30, 0), at(0, 95, 0)
    pin = o + 10 * at(np.cos(turn), np.sin(turn), 0)
    way = (pin - p) / np.linalg.norm(pin - p)
    angle = float(np.degrees(np.arctan2(way[0], -way[1])))
    reach = float(np.linalg.norm(pin - p))

    def rocked(shape):
        return shape.rotate((0, 0, 0), (0, 0, 1), angle).translate(tuple(p.tolist()))

    feet = [at(x, 0, 5) for x in (-12, 12)]
    base = box((-45, -10, -35), (45, 0, 50)).edges("|Y").fillet(6)
    drawing.add("base", cut(base, *(bore(q, Y, 1.7, 30) for q in feet), *(cyl(q - 10 * Y, Y, 3, 4) for q in feet)))
    column = cut(box((-20, 0, 0), (20, 112, 10)), bore(o, Z, 5, 30), bore(p, Z, 2 + play, 30))
    ports = [bore(p + at(s * 6, 14, 0), Z, 1, 30) for s in (-1, 1)]
    drawing.add("column", cut(column, *ports, *(cyl(q, Y, 1.25, 14) for q in feet)))
    for k, q in enumerate(feet):
        drawing.add(f"foot screw {k}", screw(q - 6 * Y, Y, 1.5, 16))
    drawing.add("bush", union(tube(o, Z, 3 + play, 5, 10), tube(o + 10 * Z, Z, 3 + play, 7, 2)))
    drawing.add("crankshaft", cyl(o - 30 * Z, Z, 3, 48))
    disc = cyl(o + 12.2 * Z, Z, 16, 5.8)
    drawing.add("crank disc", cut(disc, bore(o, Z, 2.99, 90), bore(pin, Z, 1.6, 90)))
    drawing.add("crank pin", union(cyl(pin + 12.5 * Z, Z, 2, 19), cyl(pin + 31.5 * Z, Z, 3.4, 1.6)))
    block = union(box((-11, -22, 10), (11, 18, 38)).edges("|Y and >Z").chamfer(4))
    block = cut(block, cyl((0, -30, 26), Y, 7, 80), cyl((0, 0, 9), Z, 1.6, 9), cyl((0, 14, 9), Z, 1, 12))
    caps = [at(sx * 8, 18, 26 + sz * 8.5) for sx in (-1, 1) for sz in (-1, 1)]
    drawing.add("cylinder", rocked(cut(block, *(cyl(q, -Y, 0.8, 8) for q in caps))))
    cap = union(box((-11, 18, 14), (11, 21, 38)), cyl((0, 16, 26), Y, 6.95, 3))
    drawing.add("cylinder cap", rocked(cut(cap, *(bore(q, Y, 1.1, 20) for q in caps))))
    for k, q in enumerate(caps):
        drawing.add(f"cap screw {k}", rocked(screw(q + 3 * Y, -Y, 1, 9)))
    drawing.add("pivot pin", cyl(p - 17 * Z, Z, 2, 34.5))
    drawing.add("pivot spring", tube(p - 11 * Z, Z, 2.3, 4, 11))
    drawing.add("pivot nut", hexagon(p - 14.2 * Z, Z, 3.5, 3.2, 2))
    piston = union(cyl((0, -reach + 54, 26), Y, 7 - play, 12), cyl((0, -reach, 26), Y, 2.5, 55))
    piston = union(piston, cyl((0, -reach, 22), Z, 4.5, 8))
    drawing.add("piston", rocked(cut(piston, bore((0, -reach, 22), Z, 2 + play, 90))))
    wheel = union(tube(o - 26 * Z, Z, 24, 30, 12), cyl(o - 26 * Z, Z, 7, 25.7), tube(o - 22 * Z, Z, 6, 25, 4))
    drawing.add("flywheel", cut(wheel, bore(o, Z, 3, 90), cyl(o - 9 * Z, X, 1.25, 9)))
    drawing.add("flywheel grub screw", cyl(o - 9 * Z + 3 * X, X, 1.25, 4))
    drawing.joint("Weld", "column", "base")
    drawing.joint("Weld", "bush", "column")
    drawing.joint("Revolute", "crankshaft", "column", o, Z)
    drawing.joint("Weld", "crank disc", "crankshaft")
    drawing.joint("Weld", "crank pin", "crank disc")
    drawing.joint("Revolute", "piston", "crank pin", pin, Z)
    drawing.joint("Cylindrical", "piston", "cylinder", p + 26 * Z, way)
    drawing.joint("Revolute", "cylinder", "column", p, Z)
    drawing.joint("Weld", "pivot pin", "cylinder")
    drawing.joint("Weld", "cylinder cap", "cylinder")
    drawing.joint("Weld", "flywheel", "crankshaft")
    return drawing


@kind
def needle_bar(random):
    """A sewing machine's head: crank, link, needle bar in two bushes, presser bar with spring, bracket and foot."""
    drawing, play, turn = Drawing(["head"]), random.choice([0.0, 0.02]), random.uniform(0.3, 2.6)
    pin = 12 * at(np.cos(turn), np.sin(turn), 0)
    y = pin[1] - np.sqrt(35**2 - pin[0] ** 2)
    head = [box((-35, -120, -30), (40, 40, -20)), box((-9, 19, -20), (30, 30, 14)), box((-9, -75, -20), (30, -62, 14))]
    needle, presser = at(0, 0, 6), at(20, 0, 6)
    slot = box((17.9, -45, -40), (22.1, 10, -19))
    head.append(cyl((0, 0, -60), Z, 14, 30))
    head = cut(union(*head), bore(0 * X, Z, 8, 200), bore(needle, Y, 4.99), bore(presser, Y, 3 + play), slot)
    drawing.add("head", head)
    for k, z in enumerate((-60, -32)):
        drawing.add(f"shaft bush {k}", tube((0, 0, z), Z, 5 + play, 8, 12))
    drawing.add("main shaft", cyl((0, 0, -90), Z, 5, 80))
    crank = union(cyl((0, 0, -18), Z, 13, 8), cyl(pin - 18 * Z, Z, 5, 8))
    drawing.add("crank", cut(crank, bore(0 * X, Z, 5, 90), bore(pin, Z, 3, 90), cyl((0, 0, -14), -pin, 1.5, 20)))
    drawing.add("crank set screw", cyl(at(0, 0, -14) - 5 * pin / 12, -pin, 1.5, 7))
    drawing.add("crank pin", union(cyl(pin - 18 * Z, Z, 3, 15.5), cyl(pin - 2.5 * Z, Z, 4.6, 1.3)))
    stud = at(0, y, 0)
    link = union(bar(pin, stud, 4.5, -9, -4), cyl(pin - 9 * Z, Z, 5, 6), cyl(stud - 9 * Z, Z, 5, 6))
    drawing.add("link", cut(link, bore(pin, Z, 3 + play, 90), bore(stud, Z, 2.5 + play, 90)))
    clamp = union(box((-6, y - 6, 0), (6, y + 6, 13)), cyl(stud - 11 * Z, Z, 2.5, 12), cyl(stud - 3 * Z, Z, 5, 3))
    clamp = cut(clamp, tube(stud - 10.2 * Z, Z, 2.25, 3, 0.8), bore(needle, Y, 3.2), cyl((-20, y, 6), X, 1.25, 20))
    drawing.add("bar clamp", clamp)
    drawing.add("link clip", circlip(stud - 10.2 * Z, Z, 2.5, 0.8))
    drawing.add("clamp screw", screw((-6, y, 6), X, 1.25, 2.8))
    rod = cut(cyl((0, y - 80, 6), Y, 3.2, 160), cyl((0, y - 81, 6), Y, 0.8, 12), cyl((0, y - 75, 6), -X, 1, 9))
    drawing.add("needle bar", rod)
    drawing.add("upper bush", tube((0, 17.5, 6), Y, 3.2 + play, 5, 14))
    drawing.add("lower bush", tube((0, -76, 6), Y, 3.2 + play, 5, 15))
    drawing.add("needle", cyl((0, y - 110, 6), Y, 0.8, 41))
    drawing.add("needle screw", cyl((-0.8, y - 75, 6), -X, 1, 5))
    drawing.add("presser bar", cyl((20, -118, 6), Y, 3, 170))
    bracket = union(box((14.5, -20, 0), (26, -8, 12)), box((18, -20, -24), (22, -8, 1)))
    drawing.add("guide bracket", cut(bracket, bore(presser, Y, 3), cyl((20, -14, 6), X, 1.5, 9)))
    drawing.add("bracket screw", screw((26, -14, 6), -X, 1.5, 3))
    drawing.add("presser spring", tube((20, -8, 6), Y, 3.3, 5, 27))
    foot = [box((14, -122, 0), (26, -106, 12)), box((17, -130, 2), (23, -121, 10)), box((-8, -132, -4), (26, -130, 16))]
    foot = union(*foot)
    foot = cut(foot, cyl((20, -118, 6), Y, 3, 40), cyl((20, -112, 6), X, 1.5, 9), box((-2, -140, 3), (2, -120, 9)))
    drawing.add("foot", foot)
    drawing.add("foot screw", screw((26, -112, 6), -X, 1.5, 3))
    drawing.add("face cover", cut(box((-35, -120, 14), (40, 40, 16)), bore((0, -14, 14), Z, 12, 9)))
    drawing.joint("Revolute", "main shaft", "head", (0, 0, 0), Z)
    drawing.joint("Weld", "crank", "main shaft")
    drawing.joint("Weld", "crank pin", "crank")
    drawing.joint("Revolute", "link", "crank", pin, Z)
    drawing.joint("Revolute", "link", "bar clamp", stud, Z)
    drawing.joint("Weld", "bar clamp", "needle bar")
    drawing.joint("Weld", "needle", "needle bar")
    drawing.joint("Weld", "lower bush", "head")
    drawing.joint("Cylindrical", "needle bar", "head", needle, Y)
    drawing.joint("Prismatic", "presser bar", "head", presser, Y)
    drawing.joint("Weld", "guide bracket", "presser bar")
    drawing.joint("Weld", "foot", "presser bar")
    return drawing


@kind
def scott_russell_lift(random):
    """Arms halved by links that turn about the base, a slider on two rods driven by a handwheel, a hook on a bolt."""
    drawing, play, tilt = Drawing(["base"]), random.choice([0.0, 0.05, 0.1]), random.uniform(0.65, 1.0)
    o, m = at(0, 0, 0), 90 * at(np.cos(tilt), np.sin(tilt), 0)
    foot, top = at(2 * m[0], 0, 0), at(0, 2 * m[1], 0)
    low, spindle = -18.0, at(0, -18, 0)
    base, rods = box((-40, -44, -60), (241, -34, 60)), [at(0, low, s * 18) for s in (-1, 1)]
    holders, spots = {"near holder": 25.0, "far holder": 222.0}, []
    for name, x in holders.items():
        block = cut(box((x, -34, -27), (x + 15, -7, 27)), *(bore(p, X, 5, 900) for p in rods))
        ties = [at(x + 7.5, -34, z) for z in (-8, 8)]
        block = cut(block, bore(spindle, X, 5.0 if name == "far holder" else 4.1, 900))
        drawing.add(name, cut(block, *(cyl(p, Y, 1.7, 8) for p in ties)))
        spots += ties
        drawing.joint("Weld", name, "base")
    for s in (-1, 1):
        bracket = union(box((-15, -34, s * 40), (15, 0, s * 48)), cyl(o + s * 40 * Z, s * Z, 15, 8))
        ties = [at(x, -34, s * 44) for x in (-9, 9)]
        drawing.add(f"bracket {s}", cut(bracket, bore(o, Z, 3, 90), *(cyl(p, Y, 1.7, 12) for p in ties)))
        spots += ties
        drawing.joint("Weld", f"bracket {s}", "base")
    drawing.add("base", cut(base, *(bore(p, Y, 2.2, 30) for p in spots), *(cyl(p - 10 * Y, Y, 4, 4) for p in spots)))
    for k, p in enumerate(spots):
        drawing.add(f"base screw {k}", screw(p - 6 * Y, Y, 2, 12))
    for k, p in enumerate(rods):
        drawing.add(f"rod {k}", cyl(p + 25 * X, X, 5, 212))
        drawing.joint("Weld", f"rod {k}", "near holder")
    slider = cut(box(foot + at(-15, -28, -25), foot + at(15, 9, 25)), *(bore(p, X, 7, 900) for p in rods))
    slider = cut(slider, bore(spindle, X, 6, 900), *(cyl(foot + s * 26 * Z, -s * Z, 2.5, 14) for s in (-1, 1)))
    drawing.add("slider", slider)
    for k, p in enumerate(rods):
        for s in (-1, 1):
            q = p + (foot[0] + s * 15) * X
            bush = union(tube(q, -s * X, 5 + play, 7, 12), tube(q, s * X, 5 + play, 7.9, 1.5))
            drawing.add(f"slide bush {k} {s}", bush)
    nut = union(cyl(spindle + (foot[0] - 15) * X, X, 6, 20), cyl(spindle + (foot[0] - 18) * X, X, 9.5, 3))
    drawing.add("spindle nut", cut(nut, bore(spindle, X, 4, 900)))
    drawing.add("spindle", cyl(spindle + 25 * X, X, 4, 235))
    drawing.add("spindle bush", tube(spindle + 222 * X, X, 4 + play, 5, 15))
    for k, x in enumerate((214.0, 237.0)):
        collar = cut(tube(spindle + x * X, X, 4, 8, 8), cyl(spindle + (x + 4) * X, Y, 1.25, 9))
        drawing.add(f"collar {k}", collar)
        drawing.add(f"collar screw {k}", cyl(spindle + (x + 4) * X + 4 * Y, Y, 1.25, 3))
    wheel = union(torus(spindle + 252 * X, X, 26, 3), tube(spindle + 247 * X, X, 4, 9, 12))
    spokes = [cyl(spindle + 252 * X + 8 * d, d, 2.5, 16) for d in (Y, -Y, Z, -Z)]
    drawing.add("handwheel", cut(union(wheel, *spokes), bore(spindle, X, 4, 900)))
    drawing.add("wheel key", box(spindle + at(248, 3.5, -1), spindle + at(258, 5, 1)))
    for name in ("spindle", "handwheel"):
        drawing.parts[name] = cut(drawing.parts[name], box(spindle + at(248, 3.5, -1), spindle + at(258, 5, 1)))
    hook = union(bar(top, top - 35 * Y, 9, -10, 10), cyl(top - 14 * Z, Z, 9, 28))
    drawing.add("hook", cut(hook, bore(top, Z, 4 + play, 90), bore(top - 35 * Y, Z, 5, 90)))
    drawing.add("top bolt", union(cyl(top - 34 * Z, Z, 4, 78), hexagon(top - 39 * Z, Z, 6.5, 5)))
    drawing.add("top nut", hexagon(top + 33 * Z, Z, 6.5, 6.5, 4))
    for s in (-1, 1):
        side = s * Z
        drawing.add(f"long arm {s}", bar(foot, top, 8, *sorted((s * 28, s * 33)), (foot, top, m), 3 + play))
        drawing.parts[f"long arm {s}"] = cut(drawing.parts[f"long arm {s}"], bore(top, Z, 4 + play, 90))
        drawing.add(f"short arm {s}", bar(o, m, 8, *sorted((s * 34, s * 39)), (o, m), 3 + play))
        drawing.add(f"top sleeve {s}", tube(top + 14 * side, side, 4.2, 7, 14))
        drawing.add(f"foot washer {s}", tube(foot + 25 * side, side, 3.2, 6, 3))
        shoulder = union(cyl(foot + 33.2 * side, -side, 3, 8.2), cyl(foot + 25 * side, -side, 2.5, 11))
        drawing.add(f"shoulder screw {s}", shoulder.union(cyl(foot + 33.2 * side, side, 5, 4)))
        drawing.add(f"middle washer {s}", tube(m + 33 * side, side, 3.2, 6, 1))
        drawing.add(f"middle bolt {s}", headed(m + 39 * side, -side, 3, 16))
        drawing.add(f"middle nut {s}", hexagon(m + 28 * side, -side, 5, 5, 3))
        drawing.add(f"base washer {s}", tube(o + 39 * side, side, 3.2, 6, 1))
        drawing.add(f"base rivet {s}", rivet(o + 34 * side, side, 3, 14))
        drawing.joint("Revolute", f"long arm {s}", "slider", foot, Z)
        drawing.joint("Revolute", f"long arm {s}", f"short arm {s}", m, Z)
        drawing.joint("Revolute", f"short arm {s}", f"bracket {s}", o, Z)
        drawing.joint("Revolute", f"long arm {s}", "hook", top, Z)
    drawing.joint("Prismatic", "slider", "base", foot, X)
    drawing.joint("Revolute", "spindle", "far holder", spindle, X)
    drawing.joint("Cylindrical", "spindle", "spindle nut", spindle, X)
    drawing.joint("Weld", "spindle nut", "slider")
    drawing.joint("Weld", "handwheel", "spindle")
    return drawing
