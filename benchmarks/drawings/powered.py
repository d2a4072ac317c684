"""Machines with a drive: a hydraulic boom, a belt drive, a spindle, a pump with rollers, a throttle."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
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
    torus,
    tube,
    union,
)  # fmt: skip


def _cone(point, large: float, small: float, length: float) -> Shape:
    """A cone along x."""
    return Shape(obj=cq.Solid.makeCone(large, small, length, cq.Vector(*point), cq.Vector(1, 0, 0)))


def grooved(shape: Shape, point, axis, radius: float) -> Shape:
    """A shaft with a groove for the circlip of `circlip`."""
    return cut(shape, tube(point, axis, 0.9 * radius, 1.5 * radius, 1.0))


@kind
def hydraulic_boom(random):
    """A boom on lugs, a cylinder with gland, piston, nut and a screwed fork, pins with cotters and circlips."""
    drawing, play = Drawing(["base"]), random.choice([0.05, 0.2])
    foot, eye = at(20, 0, -100), at(random.uniform(145, 165), 0, -25)
    way = (eye - foot) / np.linalg.norm(eye - foot)
    long = float(np.linalg.norm(eye - foot))
    lugs = [box((-30, y, -126), (70, y + 12 * np.sign(y), 25)) for y in (-20, 20)]
    base = union(box((-60, -60, -140), (100, 60, -125)), *lugs)
    holes = [bore(at(x, y, -130), Z, 5.5, 20) for x in (-45, 85) for y in (-45, 45)]
    drawing.add("base", cut(base, bore(0 * X, Y, 10), bore(foot, Y, 8), *holes))
    boom = union(box((-20, -18, -10), (320, 18, 15)), box(eye + at(-12, -8, -15), eye + at(12, 8, 16)))
    drawing.add("boom", cut(boom, bore(0 * X, Y, 10 + play), bore(eye, Y, 8)))
    for name, point, radius in (("boom", at(0, 0, 0), 10.0), ("foot", foot, 8.0)):
        hole = bore(point + 37 * Y, X, 1.5)
        drawing.add(f"{name} pin", cut(headed(point - 32 * Y, Y, radius, 74), hole))
        drawing.add(f"{name} cotter", cyl(point + at(-1.6 * radius, 37, 0), X, 1.5, 3.2 * radius))

    def along(shape: Shape) -> Shape:
        return laid(shape, foot, way, Y)

    barrel = union(cyl((0, 0, -15), Z, 15, 30), cut(cyl((10, 0, 0), X, 14, 75), cyl((20, 0, 0), X, 11, 80)))
    drawing.add("barrel", along(cut(barrel, bore((0, 0, 0), Z, 10))))
    drawing.add("eye bush", along(tube((0, 0, -15), Z, 8 + play, 10, 30)))
    for side in (-1, 1):
        drawing.add(f"foot spacer {side}", tube(foot + (17.5 * side - 2.4) * Y, Y, 8.2, 13, 4.8))
    gland = union(tube((76, 0, 0), X, 6, 11, 9), tube((85, 0, 0), X, 6, 14, 5))
    drawing.add("gland", along(gland))
    rod = union(cyl((30, 0, 0), X, 5, 20), cyl((44, 0, 0), X, 6, long - 88), cyl((long - 46, 0, 0), X, 5, 22))
    drawing.add("rod", along(rod))
    drawing.add("piston", along(tube((36, 0, 0), X, 5, 11, 8)))
    drawing.add("piston nut", along(hexagon((31, 0, 0), X, 8, 5, 5)))
    drawing.add("lock nut", along(hexagon((long - 44, 0, 0), X, 9, 6, 5)))
    fork = union(
        box((long - 38, -11, -16), (long - 22, 11, 16)),
        *(box((long - 30, -11, z), (long, 11, z + 7.5 * np.sign(z))) for z in (-8.5, 8.5)),
        *(cyl((long, 0, z), Z, 11, 7.5) for z in (-16, 8.5)),
    )
    fork = cut(fork, bore((long, 0, 0), Z, 8 + play), cyl((long - 39, 0, 0), X, 5, 20))
    drawing.add("fork", along(fork))
    drawing.add("fork pin", grooved(headed(eye - 16 * Y, Y, 8, 38), eye + 18 * Y, Y, 8))
    drawing.add("fork circlip", circlip(eye + 18 * Y, Y, 8))
    drawing.joint("Revolute", "boom", "base", 0 * X, Y)
    drawing.joint("Revolute", "barrel", "base", foot, Y)
    drawing.joint("Cylindrical", "rod", "barrel", foot, way)
    drawing.joint("Weld", "gland", "barrel")
    drawing.joint("Weld", "piston", "rod")
    drawing.joint("Weld", "fork", "rod")
    drawing.joint("Revolute", "fork", "boom", eye, Y)
    return drawing


@kind
def belt_drive(random):
    """A motor under a plate, a pulley with a set screw, an idler on a shoulder bolt, a keyed shaft in two bearings."""
    drawing, play = Drawing(["plate"]), random.choice([0.0, 0.1])
    idler, driven = at(45, random.uniform(20, 30), 0), at(110, 0, 0)
    ring = [at(x, y, 0) for x in (-15.5, 15.5) for y in (-15.5, 15.5)]
    posts = [driven + at(0, y, 0) for y in (-35, 35)]
    plate = box((-40, -50, 0), (150, 50, 8))
    plate = cut(plate, bore(0 * X, Z, 11), bore(idler, Z, 2.5), bore(driven, Z, 11))
    drawing.add("plate", cut(plate, *(bore(p, Z, 1.7) for p in ring), *(bore(p, Z, 2.2) for p in posts)))
    motor = union(box((-21, -21, -45), (21, 21, 0)), cyl((0, 0, 0), Z, 11, 2))
    drawing.add("motor", cut(motor, cyl((0, 0, -30), Z, 2.5, 40), *(cyl(p - 5 * Z, Z, 1.5, 6) for p in ring)))
    drawing.add("motor shaft", cyl((0, 0, -30), Z, 2.5, 62))
    for number, p in enumerate(ring):
        drawing.add(f"motor screw {number}", screw(p + 8 * Z, -Z, 1.5, 12))
    pulley = union(*(cyl((0, 0, z), Z, r, h) for z, r, h in ((10, 10, 1), (11, 8, 10), (21, 10, 8))))
    drawing.add("pulley", cut(pulley, bore((0, 0, 0), Z, 2.5 + play / 4), cyl((0, 0, 25), X, 1.5, 20)))
    drawing.add("grub screw", cyl((2.5, 0, 25), X, 1.5, 6))
    drawing.add("idler spacer", tube(idler + 8 * Z, Z, 2.5, 4, 2))
    wheel = union(*(cyl(idler + z * Z, Z, r, h) for z, r, h in ((10, 13, 1), (11, 11, 8), (19, 13, 1))))
    drawing.add("idler", cut(wheel, bore(idler, Z, 8)))
    for number in range(2):
        drawing.add(f"idler bearing {number}", tube(idler + (10 + 5 * number) * Z, Z, 2.5 + play / 2, 8, 5))
    drawing.add("idler screw", screw(idler + 20 * Z, -Z, 2.5, 20))
    shaft = cut(cyl(driven - 8 * Z, Z, 5, 80), box(driven + at(2, -1.5, 10), driven + at(6, 1.5, 24)))
    drawing.add("driven shaft", grooved(grooved(shaft, driven - Z, Z, 5), driven + 58 * Z, Z, 5))
    wheel = union(cyl(driven + 10 * Z, Z, 24, 12), cyl(driven + 22 * Z, Z, 10, 6))
    slot = box(driven + at(0, -1.5, 5), driven + at(7, 1.5, 30))
    drawing.add("driven pulley", cut(wheel, bore(driven, Z, 5 + play / 2), slot))
    drawing.add("key", box(driven + at(2, -1.5, 10), driven + at(6.8, 1.5, 24)))
    bridge = box(driven + at(-18, -45, 50), driven + at(18, 45, 58))
    drawing.add("bridge", cut(bridge, bore(driven, Z, 11), *(bore(p, Z, 2.2) for p in posts)))
    for number, p in enumerate(posts):
        drawing.add(f"stand-off {number}", hexagon(p + 8 * Z, Z, 5, 42, 2))
        drawing.add(f"top screw {number}", screw(p + 58 * Z, -Z, 2, 16))
        drawing.add(f"bottom screw {number}", screw(p, Z, 2, 16))
    for name, z in (("lower", 0), ("upper", 50)):
        drawing.add(f"{name} bearing", tube(driven + z * Z, Z, 5, 11, 8))
    drawing.add("short spacer", tube(driven + 8 * Z, Z, 5.1, 7, 2))
    drawing.add("long spacer", tube(driven + 28 * Z, Z, 5.1, 7, 22))
    drawing.add("lower circlip", circlip(driven - Z, Z, 5))
    drawing.add("upper circlip", circlip(driven + 58 * Z, Z, 5))
    drawing.joint("Weld", "motor", "plate")
    drawing.joint("Revolute", "motor shaft", "motor", 0 * X, Z)
    drawing.joint("Weld", "pulley", "motor shaft")
    drawing.joint("Revolute", "idler", "plate", idler, Z)
    drawing.joint("Revolute", "driven shaft", "plate", driven, Z)
    drawing.joint("Weld", "driven pulley", "driven shaft")
    drawing.joint("Weld", "bridge", "plate")
    return drawing


@kind
def spindle_cartridge(random):
    """A spindle in three bearings with spacers, a lock nut with a set screw, a cap on bolts, a keyed pulley."""
    drawing, play = Drawing(["housing"]), random.choice([0.0, 0.03])
    rear = random.uniform(110, 130)
    housing = cut(tube(0 * X, X, 31, 42, rear + 16), bore((60, 0, 0), Y, 2, 50))
    foot = box((10, -50, -60), (rear, 50, -36)).cut(cyl(0 * X, X, 41, 200))
    ring = hollow(0 * X, X, 36.5, 6)
    bolts = [bore(at(x, y, -50), Z, 4, 30) for x in (30, rear - 20) for y in (-44, 44)]
    housing = cut(union(housing, foot), *(cyl(p - X, X, 2.5, 16) for p in ring), *bolts)
    drawing.add("housing", housing)
    for name, x in (("front", 0), ("second", 22), ("rear", rear)):
        drawing.add(f"{name} bearing", tube((x, 0, 0), X, 15 + play, 31, 16))
    drawing.add("outer spacer", tube((16, 0, 0), X, 26, 31, 6))
    drawing.add("inner spacer", tube((16, 0, 0), X, 15.05, 19, 6))
    drawing.add("long spacer", tube((38, 0, 0), X, 15.05, 19, rear - 38))
    slot = box((rear + 36, -4, 9), (rear + 58, 4, 20))
    nose = _cone((-20, 0, 0), 12, 8, 30)
    spindle = union(cyl((-20, 0, 0), X, 25, 20), cyl(0 * X, X, 15, rear + 28), cyl((rear + 28, 0, 0), X, 12.5, 32))
    drawing.add("spindle", cut(spindle, nose, slot, cyl((rear + 40, 0, 0), X, 3, 30)))
    drawing.add("holder", union(nose, cyl((-60, 0, 0), X, 20, 40)))
    nut = cut(tube((rear + 16, 0, 0), X, 15, 24, 10), cyl((rear + 21, 0, 0), Z, 2, 40))
    drawing.add("lock nut", nut)
    drawing.add("nut screw", cyl((rear + 21, 0, 15), Z, 2, 8))
    cap = union(tube((-6, 0, 0), X, 26, 42, 6), tube((-12, 0, 0), X, 26, 30, 6))
    drawing.add("cap", cut(cap, *(bore(p, X, 2.7, 20) for p in ring)))
    for number, p in enumerate(ring):
        drawing.add(f"cap screw {number}", screw(p - 6 * X, X, 2.5, 18))
    pulley = cut(tube((rear + 28, 0, 0), X, 12.5 + play, 35, 32), box((rear + 20, -4, 0), (rear + 70, 4, 15.5)))
    drawing.add("pulley", pulley)
    drawing.add("key", box((rear + 36, -4, 9), (rear + 58, 4, 15.3)))
    drawing.add("end washer", tube((rear + 60, 0, 0), X, 3.3, 17, 4))
    drawing.add("end screw", screw((rear + 64, 0, 0), -X, 3, 20))
    drawing.joint("Revolute", "spindle", "housing", 0 * X, X)
    drawing.joint("Weld", "cap", "housing")
    drawing.joint("Weld", "pulley", "spindle")
    drawing.joint("Weld", "lock nut", "spindle")
    drawing.joint("Weld", "holder", "spindle")
    drawing.joint("Weld", "front bearing", "housing")
    return drawing


@kind
def peristaltic_pump(random):
    """A geared motor whose shaft has a flat, a rotor of two discs with rollers on pins, a housing on stand-offs."""
    drawing, play = Drawing(["housing"]), random.choice([0.1, 0.2])
    reach = random.uniform(18, 22)
    corners = [at(x, y, 0) for x in (-34, 34) for y in (-34, 34)]
    pair = [at(x, 0, 0) for x in (-13, 13)]
    housing = cut(box((-40, -40, 0), (40, 40, 26)), cyl((0, 0, 4), Z, reach + 9, 40), bore(0 * X, Z, 5))
    drawing.add("housing", cut(housing, *(bore(p, Z, 2.1) for p in corners), *(bore(p, Z, 1.6, 10) for p in pair)))
    cover = cut(box((-40, -40, 26), (40, 40, 30)), *(bore(p, Z, 2.1) for p in corners))
    drawing.add("cover", cover)
    for number, p in enumerate(corners):
        drawing.add(f"screw {number}", screw(p + 30 * Z, -Z, 2, 36))
        drawing.add(f"nut {number}", hexagon(p - 3 * Z, Z, 3.5, 3, 2))
    motor = union(cyl((0, 0, -45), Z, 18, 45), cyl(0 * X, Z, 5, 2))
    drawing.add("motor", cut(motor, cyl((0, 0, -12), Z, 3, 20), *(cyl(p - 6 * Z, Z, 1.5, 7) for p in pair)))
    flat = box((2.5, -5, 4), (8, 5, 30))
    drawing.add("shaft", cut(cyl((0, 0, -12), Z, 3, 34), flat))
    wells = hollow(0 * X, Z, reach, 3)
    drive = cut(cyl(0 * X, Z, 3.05, 40), flat.translate((0.05, 0, 0)))
    for name, z in (("lower", 6.0), ("upper", 19.0)):
        disc = union(cyl((0, 0, z), Z, reach + 5, 3), *([cyl((0, 0, 9), Z, 7, 10)] if name == "lower" else []))
        drawing.add(f"{name} disc", cut(disc, drive, *(bore(p, Z, 2) for p in wells)))
    for number, p in enumerate(wells):
        drawing.add(f"roller {number}", tube(p + 9.2 * Z, Z, 2 + play, 7, 9.6))
        drawing.add(f"roller pin {number}", cyl(p + 6 * Z, Z, 2, 16))
    drawing.joint("Weld", "motor", "housing")
    drawing.joint("Weld", "cover", "housing")
    drawing.joint("Revolute", "shaft", "motor", 0 * X, Z)
    drawing.joint("Weld", "lower disc", "shaft")
    drawing.joint("Weld", "upper disc", "lower disc")
    for number, p in enumerate(wells):
        drawing.joint("Revolute", f"roller {number}", "lower disc", p, Z)
    return drawing


@kind
def throttle_body(random):
    """A plate on two screws in a slit shaft, bushes, a lever on two flats with a nut, a spring drawn as rings."""
    drawing, play = Drawing(["body"]), random.choice([0.02, 0.08])
    wide = random.uniform(22, 26)
    body = union(tube((0, 0, -30), Z, wide, wide + 6, 60), cyl((0, -wide - 16, 0), Y, 9, 2 * wide + 32))
    body = cut(body, cyl((0, 0, -31), Z, wide, 62), cyl((0, -wide - 17, 0), Y, 6, 2 * wide + 34))
    ears = [box((x - 8, -8, -30), (x + 8, 8, -24)) for x in (-wide - 10, wide + 10)]
    drawing.add(
        "body",
        cut(
            union(body, *ears),
            *(bore(at(x, 0, -27), Z, 3, 5) for x in (-wide - 12, wide + 12)),
            cyl((0, 0, -31), Z, wide, 62),
        ),
    )
    for side in (-1, 1):
        middle = side * (wide + 11)
        drawing.add(f"bush {side}", tube((0, middle - 5, 0), Y, 4 + play, 6, 10))
    plate = cut(cyl((0, 0, -0.75), Z, wide - 0.1, 1.5), *(bore(at(0, y, 0), Z, 1.6, 5) for y in (-9, 9)))
    drawing.add("plate", plate)
    shaft = cyl((0, -wide - 18, 0), Y, 4, 2 * wide + 46)
    flats = [box((x, wide + 18, -8), (x + 4 * np.sign(x), wide + 30, 8)) for x in (-3, 3)]
    slit = box((-6, -wide + 0.1, -0.75), (6, wide - 0.1, 0.75))
    shaft = cut(shaft, slit, *flats, *(bore(at(0, y, 0), Z, 1.5, 6) for y in (-9, 9)))
    shaft = cut(grooved(shaft, (0, -wide - 17, 0), Y, 4), tube((0, wide + 21, 0), Y, 3, 8, 20))
    drawing.add("shaft", shaft)
    for y in (-9, 9):
        drawing.add(f"plate screw {y}", screw((0, y, 4), -Z, 1.5, 7.5))
    hole = cut(cyl((0, wide, 0), Y, 4, 40), *flats)
    lever = cut(bar((0, 0), (40, 0), 9, 0, 3, [(40, 0)], 2), cyl(0 * X, Z, 1, 1))
    lever = laid(lever, at(0, wide + 18, 0), X, Y)
    drawing.add("lever", cut(lever, hole))
    drawing.add("lever nut", hexagon((0, wide + 21, 0), Y, 5.5, 5, 3))
    drawing.add("circlip", circlip((0, -wide - 17, 0), Y, 4))
    for number in range(3):
        drawing.add(f"coil {number}", torus((0, wide + 16.3 - 2.2 * number, 0), Y, 10.2, 1))
    drawing.joint("Revolute", "shaft", "body", 0 * X, Y)
    drawing.joint("Weld", "plate", "shaft")
    drawing.joint("Weld", "lever", "shaft")
    drawing.joint("Weld", "bush 1", "body")
    return drawing
