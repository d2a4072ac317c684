"""Things that spin on shafts: the flyer of a spinning wheel, a gang of harrow discs, the axles of a toy truck."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.pinched import bolt, cone, core, nut, put, sink, sunk, through
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, hexagon, rivet, sphere, tube, union


@kind
def spinning_flyer(random):
    """A flyer and a bobbin on a shaft between maidens; a mother-of-all that a wooden screw moves along a table."""
    drawing, play, axis = Drawing(["table"]), random.choice([0.1, 0.2, 0.3]), at(0, 0, random.uniform(112, 125))
    slot, reach = 15 + play / 2, random.uniform(60, 66)
    table = cut(box((-140, -60, -45), (140, 60, 0)), box((-80, -slot, -50), (80, slot, 5)))
    drive = at(0, 0, -22)
    table = cut(table, cyl(drive + 70 * X, X, 8 + play, 90), cyl(drive - 105 * X, X, 5 + play, 40))
    legs = [cyl(at(x, y, -46), Z, 9, 30) for x in (-120, 120) for y in (-42, 42)]
    drawing.add("table", cut(table, *legs))
    fast = [at(x, y, -45) for x in (-13, 13) for y in (-9, 9)]
    mother = union(box((-22, -125, 0), (22, 125, 30)), box((-20, -15, -45), (20, 15, 1)))
    mother = cut(mother, *(cyl((0, s * 100, 5), Z, 9, 30) for s in (-1, 1)), bore(drive, X, 8, 50))
    drawing.add("mother-of-all", cut(mother, *(cyl(p, Z, 1.2, 13) for p in fast)))
    drawing.joint("Prismatic", "mother-of-all", "table", 0 * X, X)
    keeper = cut(box((-26, -30, -49), (26, 30, -45.1)), *(cone(p - 4 * Z, Z, 3.6, 1.8, 1.8) for p in fast))
    put(drawing, "keeper", cut(keeper, *(cyl(p - 5 * Z, Z, 1.8, 9) for p in fast)), "mother-of-all")
    for k, p in enumerate(fast):
        part = union(cone(p - 4 * Z, Z, 3.6, 1.8, 1.8), cyl(p - 3 * Z, Z, 1.7, 14)).cut(
            box(p + at(-4, -0.4, -5), p + at(4, 0.4, -3.3))
        )
        put(drawing, f"keeper screw {k}", part, "keeper", "mother-of-all")
    head, collar = drive + 148 * X, drive + 75 * X
    screw = union(cyl(drive - 78 * X, X, 8, 238), cyl(drive - 100 * X, X, 5, 25))
    drawing.add("drive screw", cut(screw, bore(head, Z, 2.5, 30), bore(collar, Z, 1.5, 30)))
    drawing.joint("Revolute", "drive screw", "table", drive, X)
    knob = union(cyl(head - 6 * X, X, 14, 14), sphere(head + 14 * X, 18)).cut(cyl(drive, X, 8, 160))
    put(drawing, "screw knob", cut(knob, bore(head, Z, 2.5, 30)), "drive screw")
    put(drawing, "knob dowel", cyl(head - 14 * Z, Z, 2.5, 28), "drive screw", "screw knob")
    part = cut(tube(collar - 4.8 * X, X, 8, 13, 9.6), bore(collar, Z, 1.5, 30))
    put(drawing, "collar", part, "drive screw")
    put(drawing, "collar pin", cyl(collar - 12 * Z, Z, 1.5, 24), "drive screw", "collar")
    for s, name, hole in ((-1, "front", 12), (1, "rear", 8)):
        foot = at(0, s * 100, 30)
        post = union(cyl(foot - 25 * Z, Z, 9, 30), cyl(foot, Z, 17, 22), cone(foot + 22 * Z, Z, 12, 17, axis[2] - 77))
        post = union(post, cyl(at(0, s * 100, axis[2] - 26), Z, 18, 46), sphere(at(0, s * 100, axis[2] + 24), 10))
        put(drawing, f"{name} maiden", cut(post, bore(axis + s * 100 * Y, Y, hole, 40)), "mother-of-all")
        inner = (8 if s < 0 else 4) + play
        bush = tube(axis + s * 80 * Y, s * Y, inner, hole, 42).union(
            tube(axis + s * 79 * Y, s * Y, inner, hole + 4, 2.5)
        )
        put(drawing, f"{name} bush", bush, f"{name} maiden")
    shaft = union(cyl(axis - 130 * Y, Y, 8, 59), cyl(axis - 72 * Y, Y, 4, 194), cyl(axis - 78 * Y, Y, 11, 7))
    shaft = cut(shaft, cyl(axis - 131 * Y, Y, 5, 38), cyl(axis - 98 * Y, at(1, 0.6, 0), 3, 30))
    pin = axis - 62 * Y
    drawing.add("flyer shaft", cut(shaft, bore(pin, Z, 1.5, 30)))
    for name in ("front bush", "rear bush"):
        drawing.joint("Revolute", "flyer shaft", name, axis, Y)
    flyer = union(box(axis + at(-56, -71, -8), axis + at(56, -53, 8)), cyl(axis - 71 * Y, Y, 14, 18))
    hooks = []
    for s in (-1, 1):
        flyer = union(flyer, box(axis + at(s * 44, -60, -8), axis + at(s * 56, reach - 10, 8)))
        hooks += [axis + at(s * 50, y, 8) for y in np.linspace(-30, 40, 4)]
    flyer = cut(flyer, bore(axis, Y, 4, 200).union(cyl(axis - 80 * Y, Y, 11, 9)))
    put(drawing, "flyer pin", cyl(pin - 14 * Z, Z, 1.5, 28), "flyer shaft", "flyer")
    put(drawing, "flyer", cut(flyer, bore(pin, Z, 1.5, 30), *(cyl(p, -Z, 1, 9) for p in hooks)), "flyer shaft")
    for k, p in enumerate(hooks):
        hook = union(cyl(p - 9 * Z, Z, 1, 16), sphere(p + 7 * Z, 1), cyl(p + 7 * Z, -np.sign(p[0]) * X, 1, 6))
        put(drawing, f"hook {k}", hook, "flyer")
    bobbin = union(cyl(axis - 50 * Y, Y, 11, 98), cyl(axis - 50 * Y, Y, 33, 6), cyl(axis + 38 * Y, Y, 38, 10))
    bobbin = cut(bobbin, tube(axis + 41 * Y, Y, 35, 60, 4), bore(axis, Y, 4 + play, 90))
    drawing.add("bobbin", bobbin)
    drawing.joint("Revolute", "bobbin", "flyer shaft", axis, Y)
    whorl = union(cyl(axis + 50 * Y, Y, 42, 14), cyl(axis + 64 * Y, Y, 10, 14))
    whorl = cut(whorl, tube(axis + 53 * Y, Y, 38, 60, 3), tube(axis + 58 * Y, Y, 38, 60, 3), bore(axis, Y, 4, 90))
    put(drawing, "whorl", whorl, "flyer shaft")
    return drawing


def square(low: float, high: float, half: float):
    """A square bar along y."""
    return box((-half, low, -half), (half, high, half))


@kind
def disc_harrow_gang(random):
    """Four discs and their spools clamped on a square shaft in two bearings under a beam, and scrapers on a bar."""
    drawing, play, apart = Drawing(["beam"]), random.choice([0.1, 0.2, 0.3]), random.uniform(205, 245)
    rim, hole = random.uniform(255, 280), 15.2
    pieces = [("end plate 0", 12), ("disc 0", 5), ("spool 0", 80), ("insert 0", 60), ("spool 1", 80), ("disc 1", 5)]
    pieces += [("spool 2", apart), ("disc 2", 5), ("spool 3", 80), ("insert 1", 60), ("spool 4", 80), ("disc 3", 5)]
    pieces += [("end plate 1", 12)]
    total = sum(wide for _, wide in pieces)
    y, places = -total / 2, {}
    shaft = union(square(y + 3, -y - 3, 15), cyl(y * Y - 34 * Y, Y, 12, total + 68))
    drawing.add("shaft", shaft)
    for name, wide in pieces:
        places[name] = y
        if name.startswith("disc"):
            profile = [(0, 0), (60, 0), (rim, 38), (rim, 43), (59, 5), (0, 5)]
            shape = cq.Workplane().polyline(profile).close().revolve(360, (0, 0, 0), (0, 1, 0)).translate((0, y, 0))
        elif name.startswith("spool"):
            shape = union(cyl(y * Y, Y, 28, wide), cyl(y * Y, Y, 44, 10), cyl((y + wide - 10) * Y, Y, 44, 10))
        else:
            shape = cyl(y * Y, Y, 40 if name.startswith("insert") else 52, wide)
        put(drawing, name, cut(shape, square(y - 1, y + wide + 40, hole)), "shaft")
        y += wide
    for k, s in enumerate((-1, 1)):
        put(drawing, f"shaft nut {k}", hexagon(s * total / 2 * Y, s * Y, 18, 20, 12), "shaft", f"end plate {k}")
    beam = cut(box((-40, -total / 2, 330), (40, total / 2, 410)), box((-33, -total, 337), (33, total, 403)))
    drawing.add("beam", beam)
    rail = at(200, 0, 240)
    for k in range(2):
        o = at(0, places[f"insert {k}"] + 30, 0)
        feet, legs = [o + at(x, 0, 70) for x in (-33, 33)], [o + at(x, 0, 318) for x in (-47, 47)]
        housing = union(cyl(o - 29 * Y, Y, 56, 58), box(o + at(-46, -29, 30), o + at(46, 29, 70)))
        housing = cut(housing, bore(o, Y, 40 + play, 60), *(core(p, -Z, 12, 18) for p in feet))
        hanger = union(
            box(o + at(-46, -29, 70), o + at(46, 29, 82)),
            box(o + at(-20, -10, 80), o + at(20, 10, 320)),
            box(o + at(-64, -40, 318), o + at(64, 40, 330)),
            box(o + at(0, -10, 210), o + at(230, 10, 270)),
        )
        hanger = cut(hanger, *(through(p, Z, 12, 30) for p in (*feet, *legs)))
        stop = o + at(200, 0, 276)
        hanger = cut(hanger, square(-999, 999, 15.1).translate(tuple(rail)), core(stop, -Z, 10, 25))
        put(drawing, f"hanger {k}", hanger, "beam")
        put(drawing, f"bar screw {k}", bolt(stop, -Z, 10, 21), f"hanger {k}", "scraper bar")
        put(drawing, f"housing {k}", housing, f"hanger {k}")
        drawing.joint("Revolute", f"insert {k}", f"housing {k}", o, Y)
        for j, p in enumerate(feet):
            part = bolt(p + 12 * Z, -Z, 12, 28)
            put(drawing, f"housing bolt {k} {j}", part, f"housing {k}", f"hanger {k}")
        loop = union(*(cyl(p - 20 * Z, Z, 6, 118) for p in legs), cyl(legs[0] + 98 * Z, X, 6, 94))
        put(drawing, f"U-bolt {k}", union(loop, *(sphere(p + 98 * Z, 6) for p in legs)), "beam")
        for j, p in enumerate(legs):
            put(drawing, f"U-bolt nut {k} {j}", nut(p, -Z, 12), f"U-bolt {k}", f"hanger {k}")
    put(drawing, "scraper bar", square(-total / 2, total / 2 + 80, 15).translate(tuple(rail)), "hanger 0", "hanger 1")
    for k in range(3):
        o = rail + (places[f"disc {k}"] + 46) * Y
        scraper = union(box(o + at(-23, -16, -23), o + at(23, 24, 23)), box(o + at(-130, 0, -20), o + at(-20, 6, 0)))
        scraper = cut(scraper, square(-999, 999, 15.1).translate(tuple(rail)), core(o + at(0, 4, 30), -Z, 10, 15))
        put(drawing, f"scraper {k}", scraper, "scraper bar")
        part = bolt(o + at(0, 4, 28), -Z, 10, 13)
        put(drawing, f"scraper screw {k}", part, f"scraper {k}", "scraper bar")
    return drawing


def clevis(p, base: float, half: float):
    """Two ears on a plate for a pin along y at a point, from z = base upwards."""
    low = at(p[0] - 9, -8, base)
    ears = [box((p[0] - 4, s * 4.3, base), (p[0] + 4, s * 8, p[2])).union(cyl((p[0], s * 4.3, p[2]), s * Y, 4, 3.7))
            for s in (-1, 1)]  # fmt: skip
    return cut(union(box(low, low + at(18, 16, 2)), *ears), bore(p, Y, half, 20))


@kind
def toy_tipper(random):
    """A wooden truck: wheels pressed on axles in blocks, a bed on a hinge that a dummy cylinder lifts, a tailgate."""
    drawing, play, slope = Drawing(["chassis"]), random.choice([0.1, 0.2, 0.3]), random.uniform(0.38, 0.6)
    hinge, foot, top = at(-100, 0, 18), at(-30, 0, 19), at(8, 0, 16)

    def lifted(shape):
        return shape.rotate(tuple(hinge), tuple(hinge + Y), -float(np.degrees(slope)))

    def moved(p):
        x, y, z = np.asarray(p, float) - hinge
        return hinge + at(x * np.cos(slope) - z * np.sin(slope), y, x * np.sin(slope) + z * np.cos(slope))

    axles = [at(x, 0, -9) for x in (-72, 74)]
    block_screws = [[p + at(s * 9, s * 20, 3) for s in (-1, 1)] for p in axles]
    hinge_screws, foot_screws = [hinge + at(0, y, -5.5) for y in (-12, 12)], [foot + at(x, 0, -7) for x in (-6.5, 6.5)]
    cab_pins = [at(x, y, 4) for x, y in ((52, -15), (88, 15))]
    chassis = cut(box((-112, -30, 0), (112, 30, 10)), *(cyl(p + (10 - p[2]) * Z, -Z, 0.8, 9) for p in hinge_screws))
    chassis = cut(
        chassis, *(cyl(p + (10 - p[2]) * Z, -Z, 0.7, 8) for p in foot_screws), *(cyl(p, Z, 3, 9) for p in cab_pins)
    )
    drawing.add("chassis", cut(chassis, *(cyl(at(p[0], p[1], -1), Z, 1.1, 9) for b in block_screws for p in b)))
    for k, (p, spots) in enumerate(zip(axles, block_screws, strict=True)):
        block = cut(box(p + at(-14, -30, -8), p + at(14, 30, 9)), bore(p, Y, 2.5 + play, 50))
        spots = [at(q[0], q[1], -17) for q in spots]
        block = cut(block, *(cone(q, Z, 3, 1.6, 1.4) for q in spots), *(cyl(q, Z, 1.6, 30) for q in spots))
        put(drawing, f"axle block {k}", block, "chassis")
        for j, q in enumerate(spots):
            part = union(cone(q, Z, 3, 1.6, 1.4), cyl(q + Z, Z, 1.5, 22)).cut(
                box(q + at(-4, -0.3, -1), q + at(4, 0.3, 0.7))
            )
            put(drawing, f"block screw {k} {j}", part, f"axle block {k}", "chassis")
        drawing.add(f"axle {k}", cyl(p - 48 * Y, Y, 2.5, 96))
        drawing.joint("Revolute", f"axle {k}", f"axle block {k}", p, Y)
        for s, name in ((-1, "left"), (1, "right")):
            wheel = union(cyl(p + s * 32 * Y, s * Y, 20, 12), cyl(p + s * 30.6 * Y, s * Y, 8, 2))
            wheel = cut(wheel, tube(p + s * 42 * Y, s * Y, 9, 15, 5), bore(p, Y, 2.5, 60))
            put(drawing, f"{name} wheel {k}", wheel, f"axle {k}")
            cap = union(cyl(p + s * 44 * Y, s * Y, 5, 4), cyl(p + s * 48 * Y, s * Y, 4.5, 3)).cut(
                cyl(p, s * Y, 2.5, 48)
            )
            put(drawing, f"{name} cap {k}", cap, f"axle {k}")
    cab = cut(
        box((42, -30, 10), (106, 30, 72)), box((60, -40, 44), (98, 40, 64)), *(cyl(p, Z, 3, 15) for p in cab_pins)
    )
    put(drawing, "cab", cab, "chassis")
    for k, p in enumerate(cab_pins):
        put(drawing, f"cab dowel {k}", cyl(p, Z, 3, 14), "cab", "chassis")
    bracket = box((-110, -26, 10), (-90, 26, 12.5))
    for s in (-1, 1):
        bracket = union(bracket, box((-105, s * 20, 10), (-95, s * 26, 18)), cyl(hinge + s * 20 * Y, s * Y, 5, 6))
    bracket = cut(bracket, bore(hinge, Y, 2, 50), *(sink(p, -Z, 2, 9) for p in hinge_screws))
    put(drawing, "hinge bracket", bracket, "chassis")
    for k, p in enumerate(hinge_screws):
        put(drawing, f"hinge screw {k}", sunk(p, -Z, 2, 9), "hinge bracket", "chassis")
    put(drawing, "hinge pin", rivet(hinge - 26 * Y, Y, 2, 52), "hinge bracket")
    nails = [at(-104, s * 42, 52) for s in (-1, 1)]
    bed = cut(box((-106, -42, 24), (26, 42, 58)), box((-120, -38, 28), (21, 38, 60)))
    bed = union(bed, cyl(hinge - 19.8 * Y, Y, 5, 39.6), box((-105, -19.8, 18), (-95, 19.8, 25)))
    bed = cut(bed, bore(hinge, Y, 2 + play / 2, 50), *(bore(p, Y, 1, 6) for p in nails))
    top_screws = [at(top[0] + x, 0, 24) for x in (-6.5, 6.5)]
    drawing.add("bed", lifted(cut(bed, *(cyl(p, Z, 0.7, 3.5) for p in top_screws))))
    drawing.joint("Revolute", "bed", "hinge pin", hinge, Y)
    gate = box((-105.5, -37.7, 28.3), (-102, 37.7, 54)).union(cyl((-104, -37.7, 52), Y, 3, 75.4))
    gate = cut(gate, *(cyl(p, -np.sign(p[1]) * Y, 1 + play / 2, 16) for p in nails))
    drawing.add("tailgate", lifted(gate))
    for k, p in enumerate(nails):
        way = np.sign(p[1]) * Y
        nail = union(cyl(p - 14 * way, way, 1, 14), cyl(p, way, 2.2, 1))
        put(drawing, f"tailgate nail {k}", lifted(nail), "bed")
        drawing.joint("Revolute", "tailgate", f"tailgate nail {k}", moved(p), Y)
    lower = cut(clevis(foot, 10, 1.5), *(sink(p, -Z, 2, 9) for p in foot_screws))
    put(drawing, "foot clevis", lower, "chassis")
    upper = clevis(at(top[0], 0, 24 + 24 - top[2]), 24, 1.5)
    upper = upper.mirror("XY", (0, 0, 24))
    upper = cut(upper, *(sink(p - 2 * Z, Z, 2, 9) for p in top_screws))
    put(drawing, "bed clevis", lifted(upper), "bed")
    for k, (p, q) in enumerate(zip(foot_screws, top_screws, strict=True)):
        put(drawing, f"foot screw {k}", sunk(p, -Z, 2, 8), "foot clevis", "chassis")
        put(drawing, f"bed screw {k}", lifted(sunk(q - 2 * Z, Z, 2, 5)), "bed clevis", "bed")
    end = moved(top)
    way, far = (end - foot) / np.linalg.norm(end - foot), np.linalg.norm(end - foot)
    body = union(cyl(foot - 4 * Y, Y, 4, 8), cyl(foot, way, 3.5, 8), cyl(foot + 6.5 * way, way, 5.5, 28.5))
    body = cut(body, bore(foot, Y, 1.5 + play / 2, 20), cyl(foot + 10 * way, way, 3 + play / 2, 40))
    rod = union(cyl(end - 4 * Y, Y, 4, 8), cyl(foot + 17 * way, way, 3, far - 19))
    drawing.add("cylinder", body)
    drawing.add("rod", cut(rod, bore(end, Y, 1.5 + play / 2, 20)))
    drawing.joint("Cylindrical", "rod", "cylinder", foot, way)
    for name, p, host, link in (("foot", foot, "foot clevis", "cylinder"), ("bed", end, "bed clevis", "rod")):
        put(drawing, f"{name} rivet", rivet(p - 8 * Y, Y, 1.5, 16), host)
        drawing.joint("Revolute", link, f"{name} rivet", p, Y)
    return drawing
