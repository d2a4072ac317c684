"""What turns on shafts: a rotary table, an Oldham coupling, a butterfly valve and Watt's governor."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import ball_bearing
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, screw, sphere, tube, union


@kind
def rotary_table(random):
    """A table on a ring of crossed rollers in a round base, a worm wheel, a worm in bearings, a handwheel."""
    drawing, play = Drawing(["base"]), random.choice([0.0, 0.1])
    worm = at(0, -48.3, 22)
    base = union(cyl((0, 0, 0), Z, 75, 10), tube((0, 0, 10), Z, 62, 75, 28), cyl((0, 0, 10), Z, 15, 14))
    base = union(base, tube((0, 0, 10), Z, 14, 22, 2))
    base = union(base, *(box((s * 30, -60.3, 9), (s * 66, -36.3, 34)) for s in (-1, 1)))
    inner_spots = [9 * at(np.cos(t), np.sin(t), 0) for t in np.arange(3) * 2 * np.pi / 3]
    slots = [box((s * 60, -8, -1), (s * 80, 8, 20)) for s in (-1, 1)]
    base = cut(base, bore(worm, X, 6), *(cyl(worm + s * 45 * X, s * X, 11, 60) for s in (-1, 1)), *slots)
    drawing.add("base", cut(base, *(cyl(p + 12 * Z, Z, 1.65, 14) for p in inner_spots)))
    profile = [(22.5 - 2.9, 18), (22.5, 18 - 2.9), (22.5 + 2.9, 18), (22.5, 18 + 2.9)]
    groove = cq.Workplane("XZ").polyline(profile).close().revolve(360, (0, 0, 0), (0, 1, 0))
    drawing.add("inner ring", cut(tube((0, 0, 12), Z, 15, 22.2, 12), groove))
    drawing.add("outer ring", cut(tube((0, 0, 12), Z, 22.8, 31, 12), groove))
    rollers = []
    for k, t in enumerate(np.arange(12) * np.pi / 6):
        out = at(np.cos(t), np.sin(t), 0)
        axis = (out + (-1) ** k * Z) / np.sqrt(2)
        rollers.append(cyl(22.5 * out + 18 * Z - 1.9 * axis, axis, 2, 3.8))
    drawing.add("rollers", cq.Workplane().newObject([each.val() for each in rollers]))
    drawing.add("clamp disc", cut(cyl((0, 0, 24), Z, 20, 4), *(bore(p, Z, 2.2, 60) for p in inner_spots)))
    for k, p in enumerate(inner_spots):
        drawing.add(f"clamp screw {k}", screw(p + 28 * Z, -Z, 2, 14))
    table_spots = [33.5 * at(np.cos(t), np.sin(t), 0) for t in np.arange(4) * np.pi / 2 + 0.3]
    wheel = cut(tube((0, 0, 12), Z, 27, 40, 28), cyl((0, 0, 11), Z, 31, 13))
    drawing.add("worm wheel", cut(wheel, *(cyl(p + 26 * Z, Z, 2, 20) for p in table_spots)))
    top = cut(cyl((0, 0, 40), Z, 72, 12).faces(">Z").chamfer(1), bore((0, 0, 40), Z, 10, 60))
    tees = [box((r, -5, 47), (80, 5, 60)).rotate((0, 0, 0), (0, 0, 1), a) for r, a in ((20, 60), (20, 180), (20, 300))]
    top = cut(top, *tees, *(bore(p, Z, 2.2, 60) for p in table_spots), *(cyl(p + 46 * Z, Z, 4, 9) for p in table_spots))
    drawing.add("table", top)
    for k, p in enumerate(table_spots):
        drawing.add(f"table screw {k}", screw(p + 46 * Z, -Z, 2, 16))
    shaft = union(cyl(worm - 53 * X, X, 5, 160), cyl(worm - 18 * X, X, 8, 36))
    drawing.add("worm shaft", cut(shaft, box(worm + at(90, -1, 3), worm + at(104, 1, 6))))
    for s in (-1, 1):
        drawing.add(f"worm bearing {s}", tube(worm + s * 45 * X, s * X, 5, 11, 8))
        drawing.add(f"worm sleeve {s}", tube(worm + s * 18 * X, s * X, 5, 5.9, 27))
    drawing.add("bearing nut", tube(worm + 53 * X, X, 5.5, 11, 5))
    drawing.add("plug", cyl(worm - 54 * X, -X, 11, 4))
    hand = union(tube(worm + 92 * X, X, 5 + play / 10, 30, 8), tube(worm + 90 * X, X, 5 + play / 10, 10, 14))
    keyway = box(worm + at(90, -1, 3), worm + at(104, 1, 6))
    crank = worm + at(100, 22, 0)
    drawing.add("handwheel", cut(hand, keyway, bore(crank, X, 3, 30)))
    drawing.add("key", keyway)
    drawing.add("handle pin", union(cyl(crank - 8 * X, X, 3, 42), cyl(crank + 34 * X, X, 5, 3)))
    drawing.add("handle sleeve", tube(crank + 0.5 * X, X, 3 + max(play, 0.05), 7, 33))
    drawing.add("scale", tube((0, 0, 38.2), Z, 70, 71, 1.6))
    drawing.joint("Weld", "inner ring", "base")
    drawing.joint("Weld", "clamp disc", "base")
    drawing.joint("Weld", "outer ring", "worm wheel")
    drawing.joint("Weld", "worm wheel", "table")
    drawing.joint("Revolute", "table", "base", (0, 0, 0), Z)
    drawing.joint("Revolute", "worm shaft", "base", worm, X)
    drawing.joint("Weld", "handwheel", "worm shaft")
    drawing.joint("Weld", "handle pin", "handwheel")
    drawing.joint("Revolute", "handle sleeve", "handwheel", crank, X)
    return drawing


@kind
def oldham_coupling(random):
    """Two shafts beside each other's axes, each in two bearings of its housing, keyed hubs, a disc with two slots."""
    drawing, play = Drawing(["bed"]), random.choice([0.0, 0.05])
    shift = at(0, random.uniform(1.5, 3), random.uniform(-2, 2))
    axes = {-1: at(0, 0, 45), 1: at(0, 0, 45) + shift}
    bed, spots = box((-150, -45, -12), (150, 45, 0)), []
    disc = cyl((-6, shift[1], 45), X, 22, 12)
    half = 5 + play
    disc = cut(disc, box((-7, -40, 45 - half), (-1.5, 40, 45 + half)))
    disc = cut(disc, box((1.5, shift[1] - half, 0), (7, shift[1] + half, 90)), bore((0, shift[1], 45), X, 6, 40))
    drawing.add("disc", disc)
    for s, p in axes.items():
        way, name = s * X, "driving" if s < 0 else "driven"
        housing = union(box((s * 50, -40, 0), (s * 120, 40, 10)), cyl(p + 50 * way, way, 24, 70))
        housing = union(housing, box((s * 50, -18, 5), (s * 120, 18, p[2])))
        feet = [at(s * x, y, 10) for x in (60, 110) for y in (-33, 33)]
        spots += feet
        housing = cut(housing, cyl(p + 50 * way, way, 16, 10), cyl(p + 110 * way, way, 16, 10.1), bore(p, X, 12))
        drawing.add(f"{name} housing", cut(housing, *(bore(q, Z, 3.3, 30) for q in feet)))
        for k, q in enumerate(feet):
            drawing.add(f"{name} washer {k}", tube(q, Z, 3.2, 6, 1.2))
            drawing.add(f"{name} screw {k}", union(cyl(q - 18 * Z, Z, 3, 19.2), hexagon(q + 1.2 * Z, Z, 5, 4)))
        for k, x in enumerate((50, 110)):
            ball_bearing(drawing, f"{name} bearing {k}", p + x * way, way, 8, 16, 9)
        shaft = cut(cyl(p + 10 * way, way, 8, 150), tube(p + 120 * way, way, 7.2, 9, 1.1))
        key = box(*(p + at(s * x, y, z) for x, y, z in ((14, -2, 5), (34, 2, 9.5))))
        drawing.add(f"{name} shaft", cut(shaft, key))
        drawing.add(f"{name} key", key)
        drawing.add(f"{name} clip", circlip(p + 120 * way, way, 8, 1.1))
        drawing.add(f"{name} ring", tube(p + 46 * way, way, 8, 11, 4))
        hub = union(cyl(p + 6.2 * way, way, 21, 6), cyl(p + 6.2 * way, way, 14, 30))
        tongue = (-19, -5, 19, 5) if s < 0 else (-5, -19, 5, 19)
        hub = union(hub, box(p + at(s * 1.8, *tongue[:2]), p + at(s * 6.5, *tongue[2:])))
        hub = cut(hub, cyl(p + 10 * way, way, 8, 60), key, cyl(p + 30 * way, Y, 2, 20))
        drawing.add(f"{name} hub", cut(hub, bore(p, X, 4, 60)))
        drawing.add(f"{name} grub screw", cyl(p + 30 * way + 8 * Y, Y, 2, 5))
        drawing.joint("Weld", f"{name} housing", "bed")
        drawing.joint("Weld", f"{name} hub", f"{name} shaft")
        drawing.joint("Revolute", f"{name} shaft", f"{name} housing", p, X)
        drawing.joint("Prismatic", f"{name} hub", "disc", p, Y if s < 0 else Z)
    drawing.add("bed", cut(bed, *(cyl(q - 19 * Z, Z, 2.6, 20) for q in spots)))
    return drawing


@kind
def butterfly_valve(random):
    """A disc pinned to a stem in two bushes, packing rings under a gland on studs, a lever on the stem's square."""
    drawing, play, turn = Drawing(["body"]), random.choice([0.05, 0.1]), random.uniform(15, 75)
    studs = [at(0, s * 17, 100) for s in (-1, 1)]
    body = union(tube((-20, 0, 0), X, 42, 60, 40), cyl((0, 0, 50), Z, 14, 56), cyl((0, 0, -68), Z, 13, 20))
    body = union(body, box((-20, -24, 98), (20, 24, 106)))
    body = cut(body, cyl((-30, 0, 0), X, 42, 60), cyl((0, 0, -70), Z, 6.3, 190), cyl((0, 0, 80), Z, 9, 40))
    body = cut(body, cyl((0, 0, 55), Z, 7.5, 60), cyl((0, 0, -80), Z, 7.5, 35), *(bore(p, Z, 2.5, 9) for p in studs))
    bolts = [51 * at(0, np.cos(t), np.sin(t)) for t in np.arange(4) * np.pi / 2 + np.pi / 4]
    drawing.add("body", cut(body, *(bore(p, X, 4, 60) for p in bolts)))
    drawing.add("liner", cut(tube((-20, 0, 0), X, 40, 42, 40), bore(0 * X, Z, 6.3)))
    stem = cut(cyl((0, 0, -58), Z, 6, 192), bore((0, 0, 134), Z, 2, 12))
    drawing.add("stem", cut(stem, *(box((-9, s * 4, 124), (9, s * 9, 140)) for s in (-1, 1))))
    drawing.parts["stem"] = cut(drawing.parts["stem"], *(box((s * 4, -9, 124), (s * 9, 9, 140)) for s in (-1, 1)))
    disc = cut(union(cyl((-3, 0, 0), X, 39.9, 6), cyl((0, 0, -37.5), Z, 11, 75)), bore(0 * X, Z, 6, 90))
    for k, z in enumerate((-20, 20)):
        hole = cyl((-12, 0, z), X, 2, 24)
        disc, drawing.parts["stem"] = cut(disc, hole), cut(drawing.parts["stem"], hole)
        drawing.add(f"taper pin {k}", cyl((-11, 0, z), X, 2, 22).rotate((0, 0, 0), (0, 0, 1), turn))
        drawing.joint("Weld", f"taper pin {k}", "stem")
    drawing.add("disc", disc.rotate((0, 0, 0), (0, 0, 1), turn))
    drawing.parts["stem"] = drawing.parts["stem"].rotate((0, 0, 0), (0, 0, 1), turn)
    drawing.add("upper bush", tube((0, 0, 55), Z, 6 + play, 7.5, 20))
    drawing.add("lower bush", tube((0, 0, -60), Z, 6 + play, 7.5, 15))
    drawing.add("plug", union(cyl((0, 0, -68), Z, 7.5, 8), hexagon((0, 0, -74), Z, 9, 6)))
    drawing.add("packing washer", tube((0, 0, 80), Z, 6.2, 9, 2))
    for k in range(3):
        drawing.add(f"packing ring {k}", tube((0, 0, 82 + 5 * k), Z, 6, 9, 5))
    gland = union(tube((0, 0, 97), Z, 6.2, 8.9, 15), bar(*(1.1 * p for p in studs), 8, 112, 117))
    drawing.add("gland", cut(gland, bore(0 * X, Z, 6.2), *(bore(p, Z, 3.3, 30) for p in studs)))
    for k, p in enumerate(studs):
        drawing.add(f"stud {k}", cyl(p - 2 * Z, Z, 3, 26))
        drawing.add(f"stud nut {k}", hexagon(p + 17 * Z, Z, 5, 5, 3))
    lever = union(bar((0, 0, 0), (150, 0, 0), 11, 124, 132), cyl((60, 0, 128), X, 6, 110))
    lever = cut(lever, box((-4, -4, 100), (4, 4, 140)))
    drawing.add("lever", lever.rotate((0, 0, 0), (0, 0, 1), turn))
    drawing.add("lever washer", tube((0, 0, 134), Z, 2.2, 8, 1.5))
    drawing.add("lever screw", screw((0, 0, 135.5), -Z, 2, 12))
    grip = cut(cyl((80, 0, 128), X, 9, 95), cyl((79, 0, 128), X, 6, 91), box((50, -11, 124), (161, 11, 132)))
    drawing.add("grip", grip.rotate((0, 0, 0), (0, 0, 1), turn))
    drawing.add("name plate", box((20, -15, 99), (20.8, 15, 105)))
    drawing.joint("Weld", "disc", "stem")
    drawing.joint("Revolute", "stem", "body", (0, 0, 0), Z)
    drawing.joint("Weld", "lever", "stem")
    drawing.joint("Weld", "grip", "lever")
    for each in ("gland", "upper bush", "lower bush", "liner", "plug", "packing ring 0", "name plate"):
        drawing.joint("Weld", each, "body")
    return drawing


@kind
def watt_governor(random):
    """A spindle in a column, a hub pinned to it, arms with balls, a sleeve on a feather, a spring, a pulley."""
    drawing, play, lean = Drawing(["column"]), random.choice([0.0, 0.1]), random.uniform(0.45, 0.75)
    top = at(14, 200, 0)
    way = at(np.sin(lean), -np.cos(lean), 0)
    middle, ball = top + 60 * way, top + 120 * way
    low = at(14, 200 - 120 * np.cos(lean), 0)
    column = union(cyl((0, 0, 0), Y, 16, 50), box((-45, 0, -30), (45, 10, 30)).edges("|Y").fillet(8))
    feet = [at(x, 0, z) for x in (-35, 35) for z in (-20, 20)]
    drawing.add("column", cut(column, bore(0 * X, Y, 7, 90), *(bore(p, Y, 3, 30) for p in feet)))
    for k, (y, s) in enumerate(((0.0, 1), (50.0, -1))):
        bush = union(tube((0, y, 0), s * Y, 5 + play / 4, 7, 18), tube((0, y, 0), -s * Y, 5 + play / 4, 9, 2))
        drawing.add(f"bush {k}", bush)
        drawing.joint("Weld", f"bush {k}", "column")
    feather = box((-1.5, max(low[1] - 45, 62), 3), (1.5, low[1] + 9, 6.8))
    pin = cyl((0, 202, -12), Z, 1.5, 24)
    drawing.add("spindle", cut(cyl((0, -34, 0), Y, 5, 250), feather, pin))
    drawing.add("feather", feather)
    drawing.add("collar", cut(tube((0, 52, 0), Y, 5, 9, 8), cyl((0, 56, 0), X, 1.5, 12)))
    drawing.add("collar screw", cyl((5, 56, 0), X, 1.5, 4))
    pulley = cut(cyl((0, -30, 0), Y, 25, 27.5), bore(0 * X, Y, 5, 90), tube((0, -26, 0), Y, 21, 30, 12))
    drawing.add("pulley", cut(pulley, cyl((0, -8, 0), X, 2, 40)))
    drawing.add("pulley screw", cyl((5, -8, 0), X, 2, 10))
    hub = cut(box((-22, 190, -10), (22, 212, 10)), bore(0 * X, Y, 5), pin)
    hub = cut(hub, *(box((s * 7.5, 180, -4.2), (s * 30, 220, 4.2)) for s in (-1, 1)))
    drawing.add("hub", cut(hub, *(bore(s * 14 * X + 200 * Y, Z, 2.5, 40) for s in (-1, 1))))
    drawing.add("hub pin", cyl((0, 202, -10), Z, 1.5, 20))
    sleeve = union(cyl(low[1] * Y - 24 * Y, Y, 9, 34), cyl(low[1] * Y - 24 * Y, Y, 12, 15))
    sleeve = union(sleeve, box(low * Y - at(19, 7, 4), low * Y + at(19, 7, 4)))
    sleeve = cut(sleeve, bore(0 * X, Y, 5 + play / 4), box((-1.5, 0, 2), (1.5, 190, 6.9)))
    sleeve = cut(sleeve, tube(low[1] * Y - 20 * Y, Y, 9.5, 14, 6))
    drawing.add("sleeve", cut(sleeve, *(bore(s * 14 * X + low * Y, Z, 2, 40) for s in (-1, 1))))
    drawing.add("spring", tube((0, low[1] + 10, 0), Y, 5.6, 7, 180 - low[1]))
    for s, side in ((-1, "left"), (1, "right")):
        flip = at(s, 1, 1)
        a, m, b, c, d = flip * top, flip * middle, flip * ball, flip * low, flip * way
        arm = union(bar(a, a + 99 * d, 5, -4, 4), cyl(a + 90 * d, d, 3, 56))
        drawing.add(f"{side} arm", cut(arm, bore(a, Z, 2.5 + play, 40), bore(m, Z, 2, 40)))
        weight = cut(sphere(b, 18), bore(b, d, 3, 60), *(cyl(b + t * 16 * d, t * d, 20, 9) for t in (-1, 1)))
        drawing.add(f"{side} ball", weight)
        drawing.add(f"{side} ball nut", hexagon(b + 16 * d, d, 5, 5, 3))
        for k in (-1, 1):
            plate = bar(m, c, 4.5, *sorted((k * 4.2, k * 6.7)), (m, c), 2 + play)
            drawing.add(f"{side} link {k}", plate)
            drawing.joint("Revolute", f"{side} link {k}", f"{side} arm", m, Z)
            drawing.joint("Revolute", f"{side} link {k}", "sleeve", c, Z)
        drawing.add(f"{side} hub bolt", cyl(a - 10 * Z, Z, 2.5, 20))
        for name, p in (("middle", m), ("sleeve", c)):
            drawing.add(f"{side} {name} pin", union(cyl(p - 8.5 * Z, Z, 2, 17), cyl(p - 8.5 * Z, Z, 3.4, 1.5)))
            drawing.add(f"{side} {name} clip", circlip(p + 7 * Z, Z, 2, 0.6))
            groove = tube(p + 7 * Z, Z, 1.8, 3, 0.6)
            drawing.parts[f"{side} {name} pin"] = cut(drawing.parts[f"{side} {name} pin"], groove)
        drawing.joint("Revolute", f"{side} arm", "hub", a, Z)
        drawing.joint("Weld", f"{side} ball", f"{side} arm")
        drawing.joint("Weld", f"{side} hub bolt", "hub")
    drawing.joint("Revolute", "spindle", "column", (0, 0, 0), Y)
    drawing.joint("Weld", "hub", "spindle")
    drawing.joint("Weld", "pulley", "spindle")
    drawing.joint("Prismatic", "sleeve", "spindle", (0, 0, 0), Y)
    return drawing
