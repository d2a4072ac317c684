"""Machines whose levers pinch: a can opener, a surgeon's rongeur, a rope lock of a stage; and screws by their sizes."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, tube, union

SIZES = {
    2: (2.4, 1.6, 3.8, 4, 1.6, 5, 0.3),
    3: (3.4, 2.5, 5.5, 5.5, 2.4, 7, 0.5),
    4: (4.5, 3.3, 7, 7, 3.2, 9, 0.8),
    5: (5.5, 4.2, 8.5, 8, 4.7, 10, 1),
    6: (6.6, 5, 10, 10, 5.2, 12, 1.6),
    8: (9, 6.8, 13, 13, 6.8, 16, 1.6),
    10: (11, 8.5, 16, 16, 8.4, 20, 2),
    12: (13.5, 10.2, 18, 18, 10.8, 24, 2.5),
    16: (17.5, 14, 24, 24, 14.8, 30, 3),
}
"""By thread: through hole, core hole, head of a socket screw, width across flats, height of a nut, washer, its own."""


def put(drawing: Drawing, name: str, shape: Shape, *holders: str) -> None:
    """Draw a part that others hold fast."""
    drawing.add(name, shape)
    for holder in holders:
        drawing.joint("Weld", name, holder)


def through(point, axis, size: int, reach: float = 60.0) -> Shape:
    """The hole that a screw passes through, on both sides of a point."""
    return bore(point, axis, SIZES[size][0] / 2, reach)


def core(point, axis, size: int, depth: float) -> Shape:
    """The core hole of a thread from a point on."""
    return cyl(point, axis, SIZES[size][1] / 2, depth)


def socket(point, axis, size: int, length: float) -> Shape:
    """A socket screw along an axis; its head ends at the point."""
    top, radius = np.asarray(point, float) - size * np.asarray(axis, float), SIZES[size][2] / 2
    shape = cyl(top, axis, radius, size).union(cyl(point, axis, size / 2, length))
    return shape.cut(hexagon(top, axis, 0.4 * size, 0.5 * size))


def bolt(point, axis, size: int, length: float) -> Shape:
    """A hexagon bolt along an axis; its head ends at the point."""
    head = hexagon(
        np.asarray(point, float) - 0.65 * size * np.asarray(axis, float), axis, SIZES[size][3] / 2, 0.65 * size
    )
    return head.union(cyl(point, axis, size / 2, length))


def cone(point, axis, first: float, last: float, length: float) -> Shape:
    """A frustum."""
    vectors = (cq.Vector(*np.asarray(each, float).tolist()) for each in (point, axis))
    return cq.Workplane(obj=cq.Solid.makeCone(float(first), float(last), float(length), *vectors))


def sunk(point, axis, size: int, length: float) -> Shape:
    """A countersunk screw along an axis, its head flush with the point."""
    shape = cone(point, axis, 0.9 * size, 0.5 * size, 0.4 * size).union(cyl(point, axis, size / 2, length))
    return shape.cut(hexagon(point, axis, 0.25 * size, 0.3 * size))


def sink(point, axis, size: int, depth: float = 60.0) -> Shape:
    """The hole of a countersunk screw."""
    return union(cone(point, axis, 0.9 * size, 0.5 * size, 0.4 * size), cyl(point, axis, SIZES[size][0] / 2, depth))


def nut(point, axis, size: int, bored: float = 0.0) -> Shape:
    """A nut from a point on."""
    return hexagon(point, axis, SIZES[size][3] / 2, SIZES[size][4], bored or size / 2)


def washer(point, axis, size: int) -> Shape:
    """A washer from a point on."""
    return tube(point, axis, 0.53 * size, SIZES[size][5] / 2, SIZES[size][6])


def grub(point, axis, size: int, length: float) -> Shape:
    """A set screw from a point on, with its socket there."""
    return cyl(point, axis, size / 2, length).cut(hexagon(point, axis, 0.25 * size, 0.4 * length))


def clip(point, axis, radius: float, high: float = 1.0) -> Shape:
    """A retaining ring, in its groove on a shaft, from a point on."""
    frame = cq.Plane(tuple(np.asarray(point, float).tolist()), normal=tuple(np.asarray(axis, float).tolist()))
    gap = laid(box((0, -0.4 * radius, -1), (3 * radius, 0.4 * radius, high + 1)), point, frame.xDir.toTuple(), axis)
    return tube(point, axis, 0.9 * radius, 1.4 * radius, high).cut(gap)


def groove(shape: Shape, point, axis, radius: float, high: float = 1.0) -> Shape:
    """A shaft with the groove of a retaining ring."""
    return shape.cut(tube(point, axis, 0.9 * radius, 1.5 * radius, high))


@kind
def can_opener(random):
    """Two handles on a rivet, a cutting wheel on a shoulder screw, a feed wheel whose shaft in a bush bears a key."""
    drawing, play, gap = Drawing(["lower handle"]), random.choice([0.05, 0.1, 0.15]), random.uniform(30, 38)
    feed, cutter, o = at(22, -8, 0), at(24, 9, 0), at(0, 0, 0)
    ends = {"lower": (at(-118, -gap, 0), feed, 0.0), "upper": (at(-118, gap - 2, 0), cutter, 2.7)}
    grips = {}
    for name, (end, front, low) in ends.items():
        handle = union(bar(o, end, 8, low, low + 2.5), bar(o, front, 9, low, low + 2.5))
        rear = bar(end * 0.55, end, 11, low - 3.5, low + 6).cut(handle)
        grips[name] = cut(rear, cyl(end * 0.8 - 4 * Z, Z, 1.5, 20))
        handle = cut(handle, cyl(end * 0.8 - 4 * Z, Z, 1.5, 20), bore(o, Z, 3 if low == 0 else 3 + play))
        if name == "lower":
            drawing.add("lower handle", cut(handle, bore(feed, Z, 4.5)))
        else:
            drawing.add("upper handle", cut(handle, bore(cutter, Z, 2)))
        put(drawing, f"{name} grip", grips[name], f"{name} handle")
        pin = cyl(end * 0.8 + (low - 3.5) * Z, Z, 1.5, 9.5)
        put(drawing, f"{name} grip pin", pin, f"{name} grip", f"{name} handle")
    rivet = union(cyl(-1.5 * Z, Z, 5, 1.5), cyl(o, Z, 3, 5.4), cyl(5.4 * Z, Z, 5.5, 1.6))
    put(drawing, "rivet", rivet, "lower handle")
    drawing.joint("Revolute", "upper handle", "rivet", o, Z)
    drawing.joint("Revolute", "upper handle", "lower handle", o, Z)
    bush = cut(union(cyl(feed, Z, 4.5, 5.2), cyl(feed - 1.5 * Z, Z, 6.5, 1.5)), bore(feed, Z, 3 + play))
    put(drawing, "bush", bush, "lower handle")
    flats = [box(feed + at(s * 2.2, -4, 5.4), feed + at(s * 5, 4, 20)) for s in (-1, 1)]
    shaft = union(cyl(feed - 20 * Z, Z, 3, 32), cyl(feed - 3.6 * Z, Z, 5, 2))
    slot = box(feed + at(-5, -1, -21), feed + at(5, 1, -8))
    shaft = cut(shaft, *flats, slot, cyl(feed + at(0, -5, -14), Y, 1, 10))
    drawing.add("feed shaft", shaft)
    drawing.joint("Revolute", "feed shaft", "bush", feed, Z)
    key = union(box(feed + at(-24, -1, -30), feed + at(24, 1, -8)), cyl(feed + at(0, -1, -30), Y, 8, 2))
    put(drawing, "key", cut(key, cyl(feed + at(0, -5, -14), Y, 1, 10)), "feed shaft")
    put(drawing, "key pin", cyl(feed + at(0, -3.4, -14), Y, 1, 6.8), "feed shaft", "key")
    wheel = cut(cyl(feed + 5.4 * Z, Z, 9, 3), cut(cyl(feed, Z, 3, 20), *flats))
    for k in range(24):
        way = at(np.cos(k * np.pi / 12), np.sin(k * np.pi / 12), 0)
        wheel = wheel.cut(cyl(feed + 9.2 * way, Z, 0.7, 20))
    put(drawing, "feed wheel", wheel, "feed shaft")
    put(drawing, "feed nut", nut(feed + 8.4 * Z, Z, 5, 3), "feed shaft", "feed wheel")
    spacer = tube(cutter + 5.2 * Z, Z, 2, 5, 3.4)
    put(drawing, "cutter spacer", spacer, "upper handle")
    stud = union(cyl(cutter + 0.5 * Z, Z, 2, 8.2), cyl(cutter + 8.6 * Z, Z, 3, 1.7), cyl(cutter + 10.3 * Z, Z, 5, 2.5))
    put(drawing, "cutter screw", stud.cut(box(cutter + at(-6, -0.5, 11.5), cutter + at(6, 0.5, 14))), "upper handle")
    drawing.joint("Weld", "cutter spacer", "cutter screw")
    blade = cut(
        union(cyl(cutter + 8.7 * Z, Z, 8, 1.5), cone(cutter + 8.7 * Z, Z, 9.5, 8, 1)), bore(cutter, Z, 3 + play)
    )
    drawing.add("cutter", blade)
    drawing.joint("Revolute", "cutter", "cutter screw", cutter, Z)
    return drawing


@kind
def bone_rongeur(random):
    """Two jaws and two handles in two layers on four shoulder screws, and leaf springs: a surgeon's bone nibbler."""
    drawing, play, t, long = Drawing(["handle 1"]), random.choice([0.03, 0.08]), random.uniform(0.36, 0.45), 26
    jaws, back = at(0, 0, 0), at(-2 * long * np.cos(t), 0, 0)
    knees = {s: at(-long * np.cos(t), s * long * np.sin(t), 0) for s in (-1, 1)}
    top, low = (0.0, 3.0), (-3.1, -0.1)
    tilt, shapes, inward = t - 0.2, {}, {}
    lean = random.uniform(0.26, 0.32)
    for s, name in ((1, "jaw 1"), (-1, "jaw 2")):
        way = at(np.cos(tilt), s * np.sin(tilt), 0)
        jaw = union(bar(knees[-s], jaws, 5, *(top if s > 0 else low)), bar(jaws, 56 * way, 4, *(top if s > 0 else low)))
        tip = bar(42 * way, 58 * way, 4, -3.1, 3)
        spoon = cyl(58 * way + at(0, -s * 5, -9), Z, 4, 20)
        shapes[name] = cut(union(jaw, tip), spoon)
    for s, name in ((1, "handle 1"), (-1, "handle 2")):
        way, layer = at(-np.cos(lean), s * np.sin(lean), 0), low if s > 0 else top
        handle = union(bar(knees[-s], back, 5, *layer), bar(back, back + 130 * way, 5, *layer))
        shapes[name] = union(handle, bar(back + 24 * way, back + 130 * way, 5, -3.1, 3))
        inward[name] = (way, at(-np.sin(lean), -s * np.cos(lean), 0))
    pivots = {
        "jaw screw": (jaws, "jaw 1", "jaw 2"),
        "handle screw": (back, "handle 2", "handle 1"),
        "lower link screw": (knees[-1], "jaw 1", "handle 1"),
        "upper link screw": (knees[1], "handle 2", "jaw 2"),
    }
    for p, over, under in pivots.values():
        shapes[over] = cut(shapes[over], cyl(p + 1.7 * Z, Z, 3.7, 9), cyl(p - Z, Z, 2.5 + play, 9))
        shapes[under] = cut(shapes[under], cyl(p - 9 * Z, Z, 2, 9))
    leaves = {}
    for name, (way, side) in inward.items():
        seat = back + 34 * way + 5 * side
        hole = seat + 5 * way
        shapes[name] = cut(shapes[name], cyl(hole - side, -side, 0.8, 6), cyl(hole + side, -side, 0.8, 3))
        path = [seat, seat + 12 * way, seat + 42 * way + 5 * side]
        sheet = [*path, *(p + 0.8 * side for p in reversed(path))]
        leaf = laid(cq.Workplane().polyline([tuple(p[:2]) for p in sheet]).close().extrude(5), at(0, 0, -2.5), X, Z)
        leaves[name] = (cut(leaf, cyl(hole - side, side, 1.1, 4)), hole, side)
    for name, shape in shapes.items():
        drawing.add(name, shape)
    for name, (p, over, under) in pivots.items():
        shape = union(cyl(p - 3.1 * Z, Z, 2, 3.1), cyl(p - 0.1 * Z, Z, 2.5, 1.9), cyl(p + 1.75 * Z, Z, 3.6, 1.2))
        put(drawing, name, cut(shape, box(p + at(-5, -0.4, 2.4), p + at(5, 0.4, 4))), under)
        drawing.joint("Revolute", over, name, p, Z)
        drawing.joint("Revolute", over, under, p, Z)
    for name, (leaf, hole, side) in leaves.items():
        put(drawing, f"{name} spring", leaf, name)
        part = socket(hole + 0.8 * side, -side, 2, 5)
        put(drawing, f"{name} spring screw", part, name, f"{name} spring")
    return drawing


@kind
def rope_lock(random):
    """A cast frame on a rail, a jaw set by a thumb screw, a jaw that the cam of a handle presses upon a rope."""
    drawing, play, lean = Drawing(["rail"]), random.choice([0.1, 0.15, 0.25]), random.uniform(0.4, 0.9)
    pins = {"set jaw": at(-24, 0, 35), "press jaw": at(24, 0, 35), "handle": at(52, 0, 105)}
    frame = box((-70, -50, 0), (80, 50, 10))
    for s in (-1, 1):
        frame = union(frame, box((-58, s * 14, 0), (70, s * 20, 125)))
    feet, sides = [at(x, y, 0) for x in (-56, 66) for y in (-35, 35)], [at(-47, 0, z) for z in (90, 102)]
    frame = cut(frame, *(bore(p, Y, 5, 60) for p in pins.values()), *(through(p, Z, 12) for p in feet))
    rail = cut(
        box((-90, -60, -12), (100, 60, 0)), box((-14, -14, -20), (14, 14, 9)), *(through(p, Z, 12) for p in feet)
    )
    drawing.add("rail", rail)
    put(drawing, "frame", cut(frame, *(through(p, Y, 5) for p in sides)), "rail")
    for k, p in enumerate(feet):
        put(drawing, f"foot washer {k}", washer(p + 10 * Z, Z, 12), "frame")
        put(drawing, f"foot bolt {k}", bolt(p + 12.5 * Z, -Z, 12, 45), f"foot washer {k}")
        put(drawing, f"foot nut {k}", nut(p - 12 * Z, -Z, 12), f"foot bolt {k}", "rail")
    block = cut(box((-55, -14, 82), (-39, 14, 110)), cyl((-60, 0, 96), X, 6, 40))
    block = cut(block, *(core(p + s * 15 * Y, -s * Y, 5, 10) for p in sides for s in (-1, 1)))
    put(drawing, "block", block, "frame")
    for k, p in enumerate(sides):
        for s in (-1, 1):
            name = f"block screw {k} {'left' if s < 0 else 'right'}"
            put(drawing, name, socket(p + s * 20 * Y, -s * Y, 5, 14), "frame", "block")
    screw = union(cyl((-78, 0, 96), X, 6, 50), cyl((-90, 0, 96), X, 16, 12))
    screw = cut(screw, *(cyl((-91, 17 * np.cos(a), 96 + 17 * np.sin(a)), X, 4, 14) for a in np.arange(6) * np.pi / 3))
    put(drawing, "thumb screw", screw, "block")
    put(drawing, "lock nut", nut((-55, 0, 96), -X, 12), "thumb screw", "block")
    for name, s in (("set jaw", -1), ("press jaw", 1)):
        p = pins[name]
        jaw = union(box((s * 10, -13.8, 36), (s * 28, 13.8, 116)), cyl(p - 13.8 * Y, Y, 12, 27.6))
        jaw = cut(jaw, bore(p, Y, 7, 60), *(cyl((s * 7, -20, z), Y, 4, 40) for z in (55, 75, 95)))
        drawing.add(name, jaw)
    h = pins["handle"]
    way = at(np.sin(lean), 0, np.cos(lean))
    lever = union(cyl(h - 13.8 * Y, Y, 14, 27.6), cyl(h + at(-9, -13.8, -3), Y, 15, 27.6), cyl(h, way, 8, 210))
    drawing.add("handle", cut(lever, bore(h, Y, 7, 60)))
    grip = tube(h + 110 * way, way, 8, 12, 100).union(cyl(h + 210 * way, way, 12, 4))
    put(drawing, "grip", grip, "handle")
    for name, p in pins.items():
        put(drawing, f"{name} bush", tube(p - 13.8 * Y, Y, 5 + play, 7, 27.6), name)
        pin = groove(cyl(p - 20 * Y, Y, 5, 43), p + 20 * Y, Y, 5, 1.2).union(cyl(p - 23 * Y, Y, 8, 3))
        put(drawing, f"{name} pin", pin, "frame")
        put(drawing, f"{name} clip", clip(p + 20 * Y, Y, 5, 1.2), f"{name} pin")
        drawing.joint("Revolute", f"{name} bush", f"{name} pin", p, Y)
    return drawing
