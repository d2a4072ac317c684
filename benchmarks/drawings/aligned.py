"""Things that screws align: a boring head, a mirror on a table of optics, a press for screen printing."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.pinched import cone, core, grub, nut, put, sink, socket, sunk, through, washer
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, laid, sphere, tube, union


def coil(point, axis, radius: float, wire: float, length: float, turns: float):
    """A helical spring from a point along an axis; its wire's middle lies on the radius."""
    path = cq.Wire.makeHelix(length / turns, length, radius)
    shape = cq.Workplane("XZ", origin=(radius, 0, 0)).circle(wire).sweep(cq.Workplane(obj=path), isFrenet=True)
    side = np.cross(axis, [0.3, 0.5, 0.8])
    return laid(shape, point, side, axis)


def along_x(points, low: float, high: float):
    """A polygon of the plane yz, drawn out from x = low to x = high."""
    return laid(cq.Workplane().polyline(points).close().extrude(high - low), at(low, 0, 0), Y, X)


@kind
def boring_head(random):
    """A slide in a dovetail with a gib, moved by a screw with a dial in a bearing plate, and a boring bar in it."""
    drawing, play, high = Drawing(["body"]), random.choice([0.05, 0.1]), random.uniform(34, 40)
    shift, screw_at = random.uniform(-2, 3), at(0, 0, 5.5)
    body = cut(cyl(0 * Z, Z, 32, high), box((27, -40, -1), (40, 40, high + 1)))
    flank, gib = 12 + 11 / np.sqrt(3), 2.5

    def leaning(y, z):
        return y + z / np.sqrt(3), z

    body = body.cut(along_x([(-12, 0), (12 + gib, 0), (flank + gib, 11), (-flank, 11)], -50, 50))
    shank_at = (high - 20) * Z
    gibs, plates = [at(x, 0, 6) for x in (-16, 0, 16)], [at(27, s * 10, 16.5) for s in (-1, 1)]
    body = cut(body, *(core(p, Y, 4, 40) for p in gibs), *(core(p, -X, 3, 9) for p in plates))
    body = cut(body, cyl(shank_at, Z, 10, 40), core(at(0, -40, high - 7), Y, 5, 35))
    drawing.add("body", body)
    shank = union(cyl(shank_at, Z, 10, 90), cyl(high * Z, Z, 14, 6))
    shank = cut(shank, cyl(at(0, -12, high - 7), Y, 2.5, 4))
    put(drawing, "shank", shank, "body")
    put(drawing, "shank screw", grub(at(0, -30, high - 7), Y, 5, 22), "body", "shank")
    wide = leaning(12, 10.7)[0]
    tail = along_x([(-12, 0), (12, 0), (wide, 10.7), (-wide, 10.7)], -27, 21)
    slide = union(cyl(-26 * Z, Z, 31, 26).cut(box((27, -40, -30), (40, 40, 1))), tail.intersect(cyl(-5 * Z, Z, 31, 40)))
    slide = cut(slide, cyl(screw_at - 40 * X, X, 4, 80))
    bars, side = [at(0, 0, -26), at(18, 0, -26)], [at(0, -31, -13), at(18, -31, -13)]
    slide = cut(slide, *(cyl(p, Z, 6, 22) for p in bars), *(core(p - 9 * Y, Y, 5, 40) for p in side))
    drawing.add("slide", slide.translate((shift, 0, 0)))
    drawing.joint("Prismatic", "slide", "body", 0 * X, X)
    edges = ((12.02, 0.1), (11.9 + gib, 0.1), (11.9 + gib, 10.7), (12.02, 10.7))
    strip = along_x([leaning(*each) for each in edges], -26, 24)
    put(drawing, "gib", cut(strip, *(cyl(p + 16.8 * Y, Y, 1.4, 5) for p in gibs)), "body")
    for k, p in enumerate(gibs):
        edge = np.sqrt(32**2 - p[0] ** 2) - 0.5
        part = union(grub(at(p[0], edge, 6), -Y, 4, edge - 19.2), cyl(p + 16.8 * Y, Y, 1.4, 2.6))
        put(drawing, f"gib screw {k}", part, "body", "gib")
    plate = cut(box((27, -15, 0.3), (33, 15, 22)), bore(screw_at, X, 3 + play / 2, 90))
    plate = cut(plate, *(through(p, X, 3, 20) for p in plates), *(cyl(p + 3 * X, X, 3, 9) for p in plates))
    put(drawing, "bearing plate", plate, "body")
    for k, p in enumerate(plates):
        put(drawing, f"plate screw {k}", socket(p + 3 * X, -X, 3, 11), "bearing plate", "body")
    screw = union(cyl(screw_at - 22 * X, X, 4, 47), cyl(screw_at + 25 * X, X, 5, 1.9), cyl(screw_at + 26 * X, X, 3, 19))
    drawing.add("feed screw", screw)
    drawing.joint("Revolute", "feed screw", "bearing plate", screw_at, X)
    dial = union(cyl(screw_at + 33.1 * X, X, 12, 5), cyl(screw_at + 38 * X, X, 8, 7)).cut(bore(screw_at, X, 3, 90))
    dial_at = screw_at + at(41.5, 0, 0)
    put(drawing, "dial", cut(dial, core(dial_at, Z, 3, 20)), "feed screw")
    put(drawing, "dial screw", grub(dial_at + 8 * Z, -Z, 3, 5), "dial", "feed screw")
    hole = at(shift, 0, 0)
    neck = random.uniform(40, 70)
    tool = union(cyl(hole + bars[0] + 21 * Z, -Z, 6, 23), cyl(hole + bars[0] - 2 * Z, -Z, 5, neck))
    seat = hole + bars[0] - (neck + 2) * Z
    tool = cut(tool, box(seat + at(0, -8, -1), seat + at(8, -1.5, 9)))
    place = seat + at(3, -1.5, 4)
    put(drawing, "boring bar", cut(tool, core(place - Y, Y, 2, 4.5)), "slide")
    tip = cut(
        box(seat + at(0, -4.5, 0), seat + at(7, -1.5, 8.5)),
        cyl(place - 9 * Y, Y, 1.2, 12),
        cyl(place - 9 * Y, Y, 2, 7.5),
    )
    put(drawing, "insert", tip, "boring bar")
    part = union(cyl(place - 3 * Y, Y, 1.9, 1.5), cyl(place - 1.6 * Y, Y, 1, 5))
    put(drawing, "insert screw", part, "boring bar", "insert")
    put(drawing, "bar screw", grub(hole + at(0, -29, -13), Y, 5, 23), "slide", "boring bar")
    part = union(cyl(hole + bars[1] + 12 * Z, -Z, 6, 12), cyl(hole + bars[1], -Z, 8, 1.5))
    put(drawing, "plug", part, "slide")
    return drawing


@kind
def mirror_mount(random):
    """A mirror in a plate on a ball, set by two fine screws with balls against springs, on a post and a fork."""
    drawing, gap, long = Drawing(["table"]), random.uniform(3.6, 4.4), random.uniform(45, 65)
    front, ball, play = 8 + gap, at(8, 8, 8 + gap / 2), random.choice([0.01, 0.03])
    sets, pulls, middle = [at(42, 8, 0), at(8, 42, 0)], [at(21, 8, 0), at(8, 25, 0)], at(25, 25, 0)
    post = at(32, 0, 4)
    back = cut(box((0, 0, 0), (50, 50, 8)), bore(middle, Z, 13, 40), cyl(ball, -Z, 2, 40))
    back = cut(back, *(cyl(p - Z, Z, 5, 20) for p in sets), *(cyl(p - Z, Z, 2.8, 20) for p in pulls))
    back = cut(back, *(box(p + at(-5, -0.8, -1), p + at(5, 0.8, 1.6)) for p in pulls))
    back = cut(back, cyl(post - Y, Y, 1.7, 18), cyl(post + 7 * Y, Y, 3, 12))
    plate = cut(box((0, 0, front), (50, 50, front + 10)), bore(middle, Z, 10.5, 40), sphere(ball, 4))
    plate = cut(plate, cyl(middle + (front + 3) * Z, Z, 12.7, 20), *(cyl(p, Z, 2.8, 40) for p in pulls))
    plate = cut(plate, *(box(p + at(-5, -0.8, front + 8.4), p + at(5, 0.8, front + 11)) for p in pulls))
    lock = at(25, 51, front + 7)
    plate = cut(plate, core(lock, -Y, 4, 20))
    base = post - (long + 10) * Y
    drawing.add(
        "table", cut(box(base + at(-75, -12, -75), base + at(75, 0, 75)), core(base + at(0, 1, -38), -Y, 6, 14))
    )
    foot = cut(union(cyl(base, Y, 16, 5), cyl(base, Y, 11, 10)), bore(base, Y, 3.3, 30), cyl(base - Y, Y, 5.3, 7.2))
    put(drawing, "post foot", foot, "table")
    fork = cut(box(base + at(-24, 0, -52), base + at(24, 9, 18)), cyl(base - Y, Y, 16.5, 6))
    fork = cut(fork, cyl(base - Y, Y, 11.5, 20), box(base + at(-11.5, -1, 0), base + at(11.5, 20, 30)))
    fork = cut(fork, box(base + at(-16.5, -1, 0), base + at(16.5, 5, 30)))
    slot = box(base + at(-3.3, -1, -44), base + at(3.3, 20, -30))
    put(drawing, "fork", cut(fork, slot), "table", "post foot")
    put(drawing, "fork washer", washer(base + at(0, 9, -38), Y, 6), "fork")
    put(drawing, "fork screw", socket(base + at(0, 10.6, -38), -Y, 6, 20), "table", "fork washer")
    drawing.add("post", cut(cyl(post, -Y, 6, long), core(post + Y, -Y, 3, 13), core(post - (long + 1) * Y, Y, 6, 16)))
    drawing.joint("Weld", "post", "post foot")
    put(drawing, "foot screw", socket(base + 6.2 * Y, Y, 6, 15), "post", "post foot")
    put(drawing, "back plate", back, "post")
    put(drawing, "post screw", socket(post + 7 * Y, -Y, 3, 16), "post", "back plate")
    put(drawing, "ball stud", union(sphere(ball, 4 - play), cyl(at(8, 8, 0), Z, 2, ball[2] - 2)), "back plate")
    drawing.parts["back plate"] = drawing.parts["back plate"].cut(sphere(ball, 4.05))
    pads = [p + front * Z for p in sets]
    plate = plate.cut(cyl(pads[1] - Z, Z, 3, 3)).cut(cyl(pads[0] - Z, Z, 3, 3))
    drawing.add("front plate", plate)
    drawing.joint("Spherical", "front plate", "ball stud", ball)
    for k, p in enumerate(sets):
        name = "tilt" if k else "turn"
        pad = cyl(pads[k], Z, 3, 2)
        if k:
            pad = pad.cut(cone(pads[k], Z, 1.5, 0.3, 1.2))
        put(drawing, f"{name} pad", pad, "front plate")
        drop = 0.55 if k else 0.0
        bush = union(cyl(p, Z, 5, 8), cyl(p - 3 * Z, Z, 7, 3)).cut(bore(p, Z, 3, 40))
        put(drawing, f"{name} bush", bush, "back plate")
        tip = pads[k] - (2.5 - drop) * Z
        screw = cut(cyl(at(p[0], p[1], -26), Z, 3, tip[2] + 25), sphere(tip, 2.5))
        drawing.add(f"{name} screw", screw)
        drawing.joint("Cylindrical", f"{name} screw", f"{name} bush", p, Z)  # a screw joint
        put(drawing, f"{name} ball", sphere(tip, 2.5), f"{name} screw")
        knob = cut(cyl(p - 26 * Z, Z, 9, 14), bore(p, Z, 3, 40), core(p - 19 * Z, X, 3, 20))
        put(drawing, f"{name} knob", knob, f"{name} screw")
        put(drawing, f"{name} knob screw", grub(p + at(8.5, 0, -19), -X, 3, 5.5), f"{name} knob", f"{name} screw")
    for k, p in enumerate(pulls):
        put(drawing, f"back pin {k}", cyl(p + at(-4.5, 0, 0.8), X, 0.8, 9), "back plate")
        put(drawing, f"front pin {k}", cyl(p + at(-4.5, 0, front + 9.2), X, 0.8, 9), "front plate")
        drawing.add(f"spring {k}", coil(p + 2.1 * Z, Z, 2, 0.35, front + 5.8, 9))
    put(drawing, "mirror", cyl(middle + (front + 3) * Z, Z, 12.7, 6), "front plate")
    put(drawing, "mirror screw", grub(at(25, 49.5, front + 7), -Y, 4, 11.8), "front plate", "mirror")
    return drawing


@kind
def screen_press(random):
    """A screen clamped in a carriage that slides on rods in a block; the block turns on a shaft; weight and platen."""
    drawing, play, lift = Drawing(["base"]), random.choice([0.1, 0.2]), random.uniform(5, 25)
    hinge, wide = at(0, 0, 60), random.uniform(105, 125)

    def lifted(shape):
        return shape.rotate(tuple(hinge), tuple(hinge + Y), -lift)

    turn = np.radians(lift)

    def moved(p):
        x, y, z = np.asarray(p, float) - hinge
        return hinge + at(x * np.cos(turn) - z * np.sin(turn), y, x * np.sin(turn) + z * np.cos(turn))

    feet = [at(x, s * 83, 20) for x in (-24, 24) for s in (-1, 1)]
    boards = [at(x, y, 40) for x in (150, 290) for y in (-50, 50)]
    base = cut(box((-60, -110, 0), (320, 110, 12)), *(core(p - 7 * Z, -Z, 8, 14) for p in feet))
    drawing.add("base", cut(base, *(core(p - 27 * Z, -Z, 6, 14) for p in boards)))
    for s, name in ((-1, "left"), (1, "right")):
        cheek = union(box((-36, s * 58, 12), (36, s * 95, 20)), box((-20, s * 58, 12), (20, s * 70, 60)))
        cheek = union(cheek, cyl(hinge + s * 58 * Y, s * Y, 20, 12)).cut(bore(hinge, Y, 8, 90))
        cheek = cut(cheek, *(through(p, Z, 8, 30) for p in feet), core(at(0, s * 64, 81), -Z, 6, 15))
        put(drawing, f"{name} cheek", cheek, "base")
        put(drawing, f"{name} shaft screw", grub(at(0, s * 64, 79), -Z, 6, 11), f"{name} cheek")
    for k, p in enumerate(feet):
        put(drawing, f"foot screw {k}", socket(p, -Z, 8, 19), "base", "left cheek" if p[1] < 0 else "right cheek")
    put(drawing, "shaft", cyl(hinge - 72 * Y, Y, 8, 144), "left cheek", "right cheek")
    for name in ("left", "right"):
        drawing.joint("Weld", f"{name} shaft screw", "shaft")
    rods, feed, tail = [at(48, 0, z) for z in (50, 80)], at(48, 0, 65), at(-18, 0, 60)
    block = union(box((-18, -54.8, 45), (60, 54.8, 75)), box((30, -54.8, 40), (69.7, 54.8, 90)))
    block = cut(block, bore(hinge, Y, 10, 90), *(bore(p, Y, 5 + play / 2, 90) for p in rods))
    block = cut(block, cyl(feed - 60 * Y, Y, 4, 200), core(tail - X, X, 8, 7))
    drawing.add("block", lifted(block))
    for s, name in ((-1, "left"), (1, "right")):
        bush = union(
            tube(hinge + s * 30 * Y, s * Y, 8 + play / 2, 10, 24.8),
            tube(hinge + s * 54.8 * Y, s * Y, 8 + play / 2, 13, 3),
        )
        put(drawing, f"{name} bush", lifted(bush), "block")
        drawing.joint("Revolute", f"{name} bush", "shaft", hinge, Y)
    carriage = box((70, -95, 40), (86, 95, 90))
    for s in (-1, 1):
        carriage = union(carriage, box((38, s * 83, 40), (86, s * 95, 90)))
    thumbs, locks = [at(104, y, 90) for y in (-60, 60)], [at(37, s * 89, p[2]) for p in rods for s in (-1, 1)]
    carriage = union(carriage, box((80, -95, 82), (118, 95, 90)), box((80, -95, 40), (118, 95, 46)))
    carriage = cut(carriage, *(bore(p, Y, 5, 120) for p in rods), cyl(feed + 80 * Y, Y, 4 + play / 2, 30))
    carriage = cut(carriage, *(core(p + Z, -Z, 8, 12) for p in thumbs), *(core(p, X, 4, 11) for p in locks))
    drawing.add("carriage", lifted(carriage))
    drawing.joint("Prismatic", "carriage", "block", hinge, Y)
    for k, p in enumerate(rods):
        put(drawing, f"rod {k}", lifted(cyl(p - 95 * Y, Y, 5, 190)), "carriage")
    for k, p in enumerate(locks):
        part = grub(p + 1.5 * X, X, 4, 4.5)
        put(drawing, f"rod screw {k}", lifted(part), "carriage", f"rod {k // 2}")
    pin = feed + 104 * Y
    screw = union(cyl(feed + 25 * Y, Y, 4, 87), cyl(feed + 76 * Y, Y, 7, 6.9))
    drawing.add("feed screw", lifted(cut(screw, bore(pin, X, 1.5, 40))))
    drawing.joint("Revolute", "feed screw", "carriage", moved(feed), Y)
    knob = cut(cyl(feed + 95.1 * Y, Y, 12, 20), cyl(feed + 95 * Y, Y, 4, 17), bore(pin, X, 1.5, 40))
    put(drawing, "feed knob", lifted(knob), "feed screw")
    put(drawing, "feed pin", lifted(cyl(pin - 11 * X, X, 1.5, 22)), "feed screw", "feed knob")
    frame = cut(box((88, -wide - 30, 46), (368, wide + 30, 72)), box((118, -wide, 40), (338, wide, 90)))
    put(drawing, "screen frame", lifted(frame), "carriage")
    mesh = box((118.5, -wide - 12, 45.7), (350, wide + 12, 46))
    put(drawing, "mesh", lifted(mesh), "screen frame")
    put(drawing, "pressure plate", lifted(box((90, -85, 72), (117, 85, 75))), "screen frame")
    for k, p in enumerate(thumbs):
        part = union(cyl(p - 15 * Z, Z, 4, 25), cyl(p + 8 * Z, Z, 13, 9))
        part = cut(part, *(cyl(p + at(13 * np.cos(a), 13 * np.sin(a), 0), Z, 3, 20) for a in np.arange(5) * 1.2566))
        put(drawing, f"thumb screw {k}", lifted(part), "carriage", "pressure plate")
    put(drawing, "counter rod", lifted(cyl(tail + 6 * X, -X, 4, 140)), "block")
    put(drawing, "counter nut", lifted(nut(tail, -X, 8)), "counter rod", "block")
    heavy = tail - 80 * X
    part = cut(cyl(heavy, -X, 26, 45), bore(tail, X, 4.2, 200), core(heavy + at(-20, 0, 4), Z, 6, 30))
    put(drawing, "weight", lifted(part), "counter rod")
    part = grub(heavy + at(-20, 0, 25), -Z, 6, 21)
    put(drawing, "weight screw", lifted(part), "weight", "counter rod")
    support = cut(box((135, -65, 12), (305, 65, 25)), *(through(p, Z, 6) for p in boards))
    put(drawing, "platen block", support, "base")
    platen = cut(box((122, -wide + 8, 25), (334, wide - 8, 40)), *(sink(p, -Z, 6) for p in boards))
    put(drawing, "platen", platen, "platen block")
    for k, p in enumerate(boards):
        put(drawing, f"platen screw {k}", sunk(p, -Z, 6, 38), "platen", "base")
    return drawing
