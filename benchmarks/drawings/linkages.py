"""Links that work: a derailleur, a bucket, a donkey pump."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import both_sides, circlip
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, laid, screw, tube, union


@kind
def derailleur(random):
    """Two knuckles on a parallelogram of two links with pressed pins, a cage that turns, two wheels on sleeves."""
    drawing, play, tilt = Drawing(["hanger"]), random.choice([0.05, 0.1]), -random.uniform(0.3, 0.6)
    way = 46 * at(np.cos(tilt), np.sin(tilt), 0)
    drawing.add("hanger", cut(box((-22, -14, -12), (-14.2, 40, 12)), bore(0 * X, X, 4)))
    drawing.add("hanger bolt", screw((6, 0, 0), -X, 4, 28))
    upper = cut(box((-14, -16, -6), (6, 16, 6)), bore(0 * X, X, 4 + play))
    lower = cut(box(way + at(-6, -16, -6), way + at(14, 16, 6)), bore(way, X, 5 + play))
    for k, y in enumerate((9.0, -9.0)):
        ends = (at(0, y, 0), way + at(0, y, 0))
        upper, lower = cut(upper, bore(ends[0], Z, 2 + play, 20)), cut(lower, bore(ends[1], Z, 2 + play, 20))
        link = union(*both_sides(*ends, 4.5, 6.6, 9.4, (), 0), cyl((ends[0] + ends[1]) / 2 - 7 * Z, Z, 2.5, 14))
        drawing.add(f"link {k}", cut(link, *(bore(p, Z, 2, 20) for p in ends)))
        for name, p in zip(("upper", "lower"), ends, strict=True):
            drawing.add(f"{name} pin {k}", cyl(p - 9.4 * Z, Z, 2, 18.8))
            drawing.joint("Revolute", f"link {k}", f"{name} knuckle", p, Z)
    drawing.add("upper knuckle", upper)
    drawing.add("lower knuckle", lower)
    x = way[0] + 14.2
    pivot, guide, tension = (at(way[1], 0), at(way[1] - 20, -3), at(way[1] - 64, -random.uniform(5, 20)))
    for name, low, high in (("inner", 0.0, 2.0), ("outer", 11.0, 13.0)):
        far = [pivot, guide, tension] if name == "inner" else [guide, tension]
        bars = [bar(one, other, 6, low, high) for one, other in pairwise(far)]
        plate = cut(union(*bars), *(bore((*p, low), Z, 2.5) for p in (guide, tension)))
        drawing.add(f"{name} plate", laid(plate, (x, 0, 0), Y, X))
    stub = cyl((x, way[1], 0), -X, 5, 20.2)
    stub = cut(union(drawing.parts["inner plate"], stub), cyl((x - 21, way[1], 0), X, 1.6, 12))
    drawing.parts["inner plate"] = stub
    drawing.add("stub washer", tube((x - 20.2, way[1], 0), -X, 2, 6.4, 1))
    drawing.add("stub screw", screw((x - 21.2, way[1], 0), X, 1.6, 9))
    for name, p in (("guide", guide), ("tension", tension)):
        low = at(x + 2, *p)
        drawing.add(f"{name} sleeve", tube(low, X, 2.5, 4, 9))
        drawing.add(f"{name} wheel", cut(tube(low + 1 * X, X, 4 + play, 15, 7), bore(low + 9 * Y, X, 2, 20)))
        drawing.add(f"{name} screw", screw(low + 11 * X, -X, 2.5, 13))
        drawing.joint("Revolute", f"{name} wheel", "inner plate", low, X)
    drawing.joint("Revolute", "upper knuckle", "hanger", (0, 0, 0), X)
    drawing.joint("Revolute", "inner plate", "lower knuckle", way, X)
    drawing.joint("Weld", "outer plate", "inner plate")
    return drawing


@kind
def bucket_linkage(random):
    """A stick, a bucket, two rockers, a link and a cylinder on clevis pins with circlips; bushes pressed into eyes."""
    drawing, play = Drawing(["stick"]), random.choice([0.0, 0.15])
    b, r, c = at(0, 0, 0), at(-90, 25, 0), at(-520, 110, 0)
    k = r + 120 * at(np.cos(t := random.uniform(1.7, 2.0)), np.sin(t), 0)
    lug = at(45, random.uniform(60, 75), 0)
    stick = [bar(c + at(0, -80, 0), b, 28, -25, 25), *both_sides(c, c + at(0, -80, 0), 26, 15, 25, (), 0)]
    stick = cut(union(*stick), *(bore(p, Z, 12, 60) for p in (b, r)), bore(c, Z, 10, 60))
    stick = cut(stick, cyl(k - 30 * Z, Z, 26, 60), box(c + at(-40, -30, -15), c + at(60, 60, 15)))
    drawing.add("stick", stick)
    for name, p in (("bucket", b), ("rocker", r)):
        drawing.add(f"{name} bush", tube(p - 25 * Z, Z, 10 + play, 12, 50))
        drawing.joint("Weld", f"{name} bush", "stick")
    shell = [box((30, -140, -60), (170, -130, 60)), box((30, -140, -60), (40, 20, 60))]
    shell += [*both_sides(b, lug, 22, 28, 38, (), 0), *both_sides(b, at(60, -120, 0), 22, 28, 38, (), 0)]
    drawing.add("bucket", cut(union(*shell), bore(b, Z, 10, 60), bore(lug, Z, 10, 60), bore(b, Z, 32, 26)))
    for s in (-1, 1):
        plate = bar(r, k, 20, *sorted((s * 26, s * 34)), (r, k), 10)
        drawing.add(f"rocker {s}", plate)
    middle = bar(k, lug, 18, -24, 24)
    middle = cut(middle, cyl(k - 13 * Z, Z, 24, 26), bore(k, Z, 10, 60), bore(lug, Z, 12, 60))
    drawing.add("link", middle)
    drawing.add("link bush", tube(lug - 24 * Z, Z, 10 + play, 12, 48))
    drawing.joint("Weld", "link bush", "link")
    way = (k - c) / np.linalg.norm(k - c)
    span = float(np.linalg.norm(k - c))
    barrel = union(cyl(c - 12 * Z, Z, 20, 24), cyl(c, way, 9, 42), cyl(c + 40 * way, way, 22, 0.6 * span - 25))
    barrel = cut(barrel, bore(c, Z, 10 + play, 60), cyl(c + 50 * way, way, 17, 0.6 * span))
    drawing.add("barrel", barrel)
    end = 15 + 0.6 * span
    drawing.add("gland", tube(c + (end - 16) * way, way, 10, 17, 16))
    drawing.add("piston", cyl(c + 0.45 * span * way, way, 17 - play, 18))
    rod = union(
        cyl(c + 0.45 * span * way + 18 * way, way, 10 - 0.5 * play, 0.55 * span - 30), cyl(k - 12 * Z, Z, 22, 24)
    )
    rod = union(rod, cyl(c + 0.45 * span * way, way, 6, 30))
    drawing.parts["piston"] = cut(drawing.parts["piston"], bore(c, way, 6, 900))
    drawing.add("rod", cut(rod, bore(k, Z, 10 + play, 60)))
    for name, p, reach in (("bucket", b, 38), ("rocker", r, 34), ("k", k, 34), ("lug", lug, 38), ("c", c, 25)):
        pin = headed(p - reach * Z, Z, 10, 2 * reach + 5)
        drawing.add(f"{name} pin", cut(pin, tube(p + (reach + 1.5) * Z, Z, 9, 11, 1.5)))
        drawing.add(f"{name} circlip", circlip(p + (reach + 1.5) * Z, Z, 10, 1.5))
    drawing.joint("Revolute", "bucket", "stick", b, Z)
    drawing.joint("Revolute", "rocker 1", "stick", r, Z)
    drawing.joint("Revolute", "rocker -1", "stick", r, Z)
    drawing.joint("Revolute", "link", "rocker 1", k, Z)
    drawing.joint("Revolute", "link", "rocker -1", k, Z)
    drawing.joint("Revolute", "rod", "rocker 1", k, Z)
    drawing.joint("Revolute", "bucket", "link", lug, Z)
    drawing.joint("Revolute", "barrel", "stick", c, Z)
    drawing.joint("Weld", "gland", "barrel")
    drawing.joint("Weld", "piston", "rod")
    drawing.joint("Cylindrical", "rod", "barrel", c, way)
    return drawing


@kind
def donkey_pump(random):
    """A walking beam on pillow blocks, an equaliser, pitmans, keyed cranks with weights, a gearbox on a skid."""
    drawing, play = Drawing(["skid"]), random.choice([0.05, 0.2])
    s0, tail, g = at(0, 300, 0), at(-220, 300, 0), at(-220, 70, 0)
    turn = random.uniform(-0.4, 0.4)
    w = g + 60 * at(np.cos(turn), np.sin(turn), 0)
    tail = s0 + at(-220, random.uniform(-10, 20), 0)
    feet = [at(x, 0, z) for x in (-260, -180) for z in (-45, 45)]
    posts = [at(x, 270, s * 50) for x in (-28, 28) for s in (-1, 1)]
    skid = [
        box((-320, -20, -100), (120, 0, 100)),
        box((-20, 0, -20), (20, 262, 20)),
        box((-45, 262, -65), (45, 270, 65)),
    ]
    drawing.add(
        "skid", cut(union(*skid), *(cyl(p - 21 * Y, Y, 4, 22) for p in feet), *(bore(p, Y, 4, 9) for p in posts))
    )
    gearbox = union(box((-275, 0, -60), (-165, 10, 60)), box((-255, 10, -40), (-185, 110, 40)))
    drawing.add("gearbox", cut(gearbox, bore(g, Z, 12 + play, 90), *(bore(p, Y, 4.2, 11) for p in feet)))
    key = [box(g + at(-3, 8, s * 42), g + at(3, 15, s * 64)) for s in (-1, 1)]
    drawing.add("crank shaft", cut(cyl(g - 65 * Z, Z, 12, 130), *key))
    for s in (-1, 1):
        web = bar(g - at(50, 0, 0), g, 22, *sorted((s * 44, s * 64))).union(bar(g, w, 22, *sorted((s * 44, s * 64))))
        slot = box(g + at(-3, 5, s * 40), g + at(3, 15, s * 70))
        ties = [g + at(-55, y, 0) for y in (-12, 12)]
        web = cut(web, bore(g, Z, 12, 90), slot, bore(w, Z, 8, 90), *(bore(p, Z, 3, 90) for p in ties))
        drawing.add(f"crank {s}", web)
        drawing.add(f"key {s}", box(g + at(-3, 8, s * 42), g + at(3, 15, s * 64)))
        weight = bar(g - at(70, 15, 0), g - at(70, -15, 0), 30, *sorted((s * 64, s * 76)))
        drawing.add(f"weight {s}", cut(weight, *(bore(p, Z, 3, 90) for p in ties)))
        drawing.add(f"crank pin {s}", headed(w + s * 100 * Z, -s * Z, 8, 60))
        drawing.add(f"pin nut {s}", hexagon(w + s * 44 * Z, -s * Z, 10, 4, 8))
        pitman = bar(w, tail, 16, *sorted((s * 80, s * 96)))
        spots = [tail + at(0, -22, s * 88), tail + at(0, -40, s * 88)]
        pitman = cut(pitman, bore(w, Z, 11, 120), *(bore(p, Z, 3.3, 10) for p in spots))
        drawing.add(f"pitman {s}", cut(pitman, box(tail + at(-20, -14, s * 70), tail + at(20, 30, s * 97))))
        drawing.add(f"wrist bush {s}", tube(w + s * 80 * Z, s * Z, 8 + play, 11, 18))
        block = union(box(s0 + at(-40, -30, s * 60), s0 + at(40, -20, s * 40)), cyl(s0 + s * 40 * Z, s * Z, 24, 20))
        block = cut(block, bore(s0, Z, 14, 90), *(bore(p, Y, 4.3, 15) for p in posts))
        drawing.add(f"block {s}", block)
        drawing.add(f"block bush {s}", tube(s0 + s * 40 * Z, s * Z, 11 + play, 14, 20))
        drawing.joint("Weld", f"block {s}", "skid")
        drawing.joint("Weld", f"block bush {s}", f"block {s}")
        drawing.joint("Weld", f"pitman {s}", "equaliser")
        drawing.joint("Revolute", f"pitman {s}", f"crank {s}", w, Z)
        drawing.joint("Weld", f"crank {s}", "crank shaft")
        drawing.joint("Weld", f"weight {s}", f"crank {s}")
    for k, p in enumerate(posts):
        drawing.add(f"block bolt {k}", screw(p + 10 * Y, -Y, 4, 24))
        drawing.add(f"block nut {k}", hexagon(p - 8 * Y, -Y, 6.5, 6, 4))
    lugs = [box(tail + at(-20, -50, s * 72), tail + at(20, -14, s * 80)) for s in (-1, 1)]
    lugs.append(box(tail + at(-20, -30, -80), tail + at(20, -14, 80)))
    eyes = [box(tail + at(-12, -14, s * 14), tail + at(12, 12, s * 22)) for s in (-1, 1)]
    spots = [bore(tail - at(0, y, 0), Z, 3.3, 120) for y in (22, 40)]
    drawing.add("equaliser", cut(union(*lugs, *eyes), bore(tail, Z, 8, 60), *spots))
    for s in (-1, 1):
        for k, y in enumerate((22, 40)):
            drawing.add(f"pitman screw {s} {k}", screw(tail + at(0, -y, s * 96), -s * Z, 3.3, 28))
    drawing.add("equaliser pin", headed(tail - 22 * Z, Z, 8, 44))
    beam = union(bar(tail, s0, 12, -13, 13), bar(s0, at(170, 300, 0), 12, -13, 13), cyl(s0 - 13 * Z, Z, 22, 26))
    bolts = [at(x, 300, 0) for x in (150, 172)]
    beam = cut(beam, bore(s0, Z, 11, 60), bore(tail, Z, 8 + play, 60), *(bore(p, Z, 4, 60) for p in bolts))
    drawing.add("beam", beam)
    drawing.add("saddle shaft", cyl(s0 - 62 * Z, Z, 11, 124))
    drawing.add("saddle dowel", cyl(s0 - 21 * Y, Y, 3, 42))
    drawing.parts["beam"] = cut(beam, bore(s0, Y, 3, 60))
    drawing.parts["saddle shaft"] = cut(drawing.parts["saddle shaft"], bore(s0, Y, 3, 60))
    head = union(box((188, 220, -13), (215, 370, 13)), *(box((140, 286, s * 13), (215, 314, s * 18)) for s in (-1, 1)))
    drawing.add("horse head", cut(head, *(bore(p, Z, 4, 60) for p in bolts)))
    drawing.joint("Weld", "gearbox", "skid")
    drawing.joint("Revolute", "crank shaft", "gearbox", g, Z)
    drawing.joint("Revolute", "beam", "skid", s0, Z)
    drawing.joint("Revolute", "equaliser", "beam", tail, Z)
    drawing.joint("Weld", "horse head", "beam")
    return drawing
