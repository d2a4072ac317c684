"""A pencil sharpener, a mower's cutter bar, a railway signal."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.powered import grooved
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
    rivet,
    screw,
    sphere,
    tube,
    union,
)


def put(drawing: Drawing, name: str, shape: Shape, host: str, kind="Weld", point=(0, 0, 0), axis=(0, 0, 1)) -> None:
    """Draw a part and say how it is held by another."""
    drawing.add(name, shape)
    drawing.joint(kind, name, host, point, axis)


def sheet(points, low: float, high: float) -> Shape:
    """A plate with this outline in the plane xy, between two heights."""
    outline = cq.Workplane().polyline([tuple(map(float, p)) for p in points]).close()
    return outline.extrude(float(high - low)).translate((0, 0, float(low)))


@kind
def pencil_sharpener(random):
    """A stand with a ring gear, a carrier in a bush with two slanting cutters on pins, a cup, a crank, a dial."""
    drawing, play, arm = Drawing(["stand"]), random.choice([0.05, 0.1]), random.uniform(42, 55)
    ring, feet = hollow((48, 0, 0), X, 20.5, 3, 0.3), [at(x, y, -50) for x in (-12, 52) for y in (-20, 20)]
    stand = union(box((-22, -28, -50), (62, 28, -44)), box((42, -26, -50), (48, 26, 26)))
    dial = at(52, 0, -17)
    holes = [bore(p, X, 1.6, 9) for p in ring] + [bore(0 * X, X, 11), bore(dial, X, 2.5, 12)]
    drawing.add("stand", cut(stand, *holes, *(bore(p, Z, 3, 9) for p in feet)))
    for k, p in enumerate(feet):
        put(drawing, f"foot {k}", union(cyl(p - 5 * Z, Z, 7, 5), cyl(p, Z, 3, 6), cyl(p + 6 * Z, Z, 4, 2)), "stand")
    gear = cut(tube((24, 0, 0), X, 18.6, 24, 18), *(cyl(p - 20 * X, X, 1.5, 20) for p in ring))
    put(drawing, "ring gear", gear, "stand")
    for k, p in enumerate(ring):
        put(drawing, f"ring screw {k}", screw(p, -X, 1.5, 16), "ring gear")
    bush = union(tube((42, 0, 0), X, 9 + play, 11, 6), tube((41, 0, 0), X, 9 + play, 14, 1))
    put(drawing, "bush", bush, "stand")
    carrier = union(
        cyl((-6, 0, 0), X, 16, 6), cyl((36, 0, 0), X, 16, 5), *(box((-1, y, -6), (37, y + 5, 6)) for y in (-13, 8))
    )
    carrier = union(carrier, cyl((40, 0, 0), X, 9, 10.2), cyl((-40, 0, 0), X, 4, 35))
    slope = 5.2 / 24
    rolls = [(at(4, 0, s * 5.9), at(1, 0, s * slope) / np.hypot(1, slope)) for s in (-1, 1)]
    bosses = [cyl(p - 5 * u, u, 3.5, 5) for p, u in rolls] + [cyl(p + 30 * u, u, 3.5, 4) for p, u in rolls]
    way = [cyl((-3, 0, 0), X, 4.2, 80), cyl((48.1, 0, 0), X, 8.3, 1.1).cut(cyl((48, 0, 0), X, 8.2, 2))]
    groove = tube((48.1, 0, 0), X, 8.2, 12, 1.1)
    carrier = cut(
        union(carrier, *bosses),
        way[0],
        groove,
        cyl((-41, 0, 0), X, 1.5, 14),
        *(cyl(p - 9 * u, u, 2, 45) for p, u in rolls),
    )
    drawing.add("carrier", carrier)
    drawing.joint("Revolute", "carrier", "bush", 0 * X, X)
    clip = cut(tube((48.1, 0, 0), X, 8.2, 11, 1), box((47, -5, 0), (50, 5, 20)))
    put(drawing, "clip", clip, "carrier")
    for k, (p, u) in enumerate(rolls):
        put(drawing, f"cutter pin {k}", cyl(p - 9 * u, u, 2, 45), "carrier")
        cutter = union(cyl(p + 0.1 * u, u, 5.5, 24), cyl(p + 24 * u, u, 6.4, 5.9))
        drawing.add(f"cutter {k}", cut(cutter, bore(p, u, 2 + play, 50)))
        drawing.joint("Revolute", f"cutter {k}", f"cutter pin {k}", p, u)
    cup = cut(cyl((-20, 0, 0), X, 26, 58), cyl((-18, 0, 0), X, 24, 70), bore(0 * X, X, 5))
    put(drawing, "cup", cup, "ring gear")
    crank = laid(bar((0, 0), (arm, 0), 7, 0, 4), at(-36, 0, 0), -Y, X)
    crank = cut(union(crank, cyl((-32, 0, 0), X, 7, 6)), bore(0 * X, X, 4), bore((0, -arm, 0), X, 2))
    put(drawing, "crank", crank, "carrier")
    put(drawing, "crank screw", union(screw((-41, 0, 0), X, 1.5, 12), tube((-41, 0, 0), X, 1.5, 6.5, 1)), "carrier")
    knob = at(-36, -arm, 0)
    put(drawing, "knob pin", rivet(knob + 4 * X, -X, 2, 26), "crank")
    drawing.add("knob", tube(knob - 0.1 * X, -X, 2 + play, 7, 21.8))
    drawing.joint("Revolute", "knob", "knob pin", knob, X)
    sizes = zip(hollow(dial, X, 17, 6, 0), (2.5, 3, 3.5, 4, 4.5, 5), strict=True)
    drawing.add("dial", cut(cyl(dial, X, 24, 3), bore(dial, X, 2.5 + play), *(bore(p, X, r, 9) for p, r in sizes)))
    drawing.joint("Revolute", "dial", "stand", dial, X)
    put(drawing, "dial spacer", tube(dial - 4 * X, X, 2.5, 5, 4), "stand")
    put(drawing, "dial screw", screw(dial + 3.1 * X, -X, 2.5, 13), "stand")
    return drawing


@kind
def sickle_bar_mower(random):
    """A bar with bolted guards and clips, a knife with sections, a pitman between bushes, a crank in bearings."""
    drawing, play, throw, turn = Drawing(["bar"]), random.choice([0.1, 0.3]), 28.0, random.uniform(0.5, 2.6)
    axis = at(-420, 10, 0)
    pin = axis + throw * at(np.cos(turn), np.sin(turn), 0)
    head = at(pin[0] + np.sqrt(180.0**2 - (pin[1] - 10) ** 2), 10, 0)
    shift = head[0] + 240
    guards, clips = [at(x, 40, 0) for x in (-90, -30, 30, 90)], [at(x, 42, 0) for x in (-60, 60)]
    flange = [axis + at(x, y, 0) for x in (-27, 27) for y in (-27, 27)]
    bar_ = union(box((-310, 20, -8), (130, 60, 0)), box((-480, -40, -8), (-300, 60, 0)))
    holes = [bore(p, Z, 4, 20) for p in guards + clips] + [bore(p, Z, 3, 20) for p in flange] + [bore(axis, Z, 16, 20)]
    drawing.add("bar", cut(bar_, *holes))
    for k, p in enumerate(guards):
        low = at(p[0], 0, 0)
        guard = union(
            box(low + at(-12, 18, -16), low + at(12, 58, -8)),
            box(low + at(-8, -80, -16), low + at(8, 20, -6)),
            box(low + at(-8, -60, -6), low + at(8, 3.8, 0)),
            box(low + at(-6, -80, -6), low + at(6, -56, 9)),
            box(low + at(-6, -60, 2.9), low + at(6, -36, 9)),
            sheet(((-8, -80), (8, -80), (0, -105)), -16, -4).translate((p[0], 0, 0)),
        )
        put(drawing, f"guard {k}", cut(guard, bore(p, Z, 4.2, 30)), "bar")
        put(drawing, f"guard bolt {k}", union(cyl(p - 16 * Z, Z, 4, 26), hexagon(p - 21 * Z, Z, 6.5, 5)), f"guard {k}")
        put(drawing, f"guard nut {k}", hexagon(p, Z, 6.5, 6.5, 4), f"guard bolt {k}")
    for k, p in enumerate(clips):
        clip = union(box(p + at(-14, -18, 0), p + at(14, 12, 6)), box(p + at(-10, -34, 2.7), p + at(10, -16, 6)))
        put(drawing, f"clip {k}", cut(clip, bore(p, Z, 4.2, 30)), "bar")
        put(drawing, f"clip bolt {k}", union(cyl(p - 10 * Z, Z, 4, 16), hexagon(p + 6 * Z, Z, 6.5, 5)), "bar")
    knife = union(
        box((-245 + shift, 4, -6), (155 + shift, 19.8 - play, 0)),
        box((-255 + shift, 0, -6), (-224 + shift, 19.8 - play, 15)),
    )
    middles = [at(x + shift, 10, 0) for x in (-120, -60, 0, 60, 120)]
    spots = [[p + s * 15 * X for s in (-1, 1)] for p in middles]
    drawing.add("knife bar", cut(knife, bore(head, Z, 6, 30), *(bore(q, Z, 2, 20) for pair in spots for q in pair)))
    drawing.joint("Prismatic", "knife bar", "bar", (0, 10, 0), X)
    for k, (p, pair) in enumerate(zip(middles, spots, strict=True)):
        blade = sheet(((-28, 8), (28, 8), (28, -18), (9, -62), (-9, -62), (-28, -18)), 0, 2.5)
        put(drawing, f"section {k}", cut(blade.translate((*p[:2], 0)), *(bore(q, Z, 2, 20) for q in pair)), "knife bar")
    housing = cut(box(axis + at(-36, -36, -50), axis + at(36, 36, -8)), bore(axis, Z, 16, 60))
    put(drawing, "housing", cut(housing, *(cyl(p - 24 * Z, Z, 2.5, 20) for p in flange)), "bar")
    for k, p in enumerate(flange):
        put(drawing, f"housing screw {k}", screw(p, -Z, 2.5, 20), "housing")
    for k, z in enumerate((-50, -12)):
        put(drawing, f"bearing {k}", tube(axis + z * Z, Z, 10, 16, 12), "housing")
    put(drawing, "bearing spacer", tube(axis - 38 * Z, Z, 10, 13, 26), "crank shaft")
    drawing.add("crank shaft", cut(cyl(axis - 85 * Z, Z, 10, 94.8), cyl(axis - 14 * Z, Z, 3, 30)))
    drawing.joint("Revolute", "crank shaft", "housing", axis, Z)
    disc = union(cyl(axis + 6 * Z, Z, 40, 10), cyl(axis, Z, 15, 6))
    part = cut(disc, bore(axis, Z, 10, 40), cyl(axis + 10 * Z, Z, 13.2, 9), bore(pin, Z, 5, 40))
    put(drawing, "crank disc", part, "crank shaft")
    put(drawing, "disc washer", tube(axis + 10 * Z, Z, 3.2, 13, 2), "crank disc")
    put(drawing, "disc screw", union(cyl(axis - 10 * Z, Z, 3, 24), hexagon(axis + 12 * Z, Z, 5, 3.5)), "crank shaft")
    pulley = cut(cyl(axis - 85 * Z, Z, 45, 20), tube(axis - 81 * Z, Z, 38, 50, 12), bore(axis, Z, 10, 100))
    pulley = cut(union(pulley, tube(axis - 65 * Z, Z, 10, 17, 15)), cyl(axis - 58 * Z, X, 2.5, 30))
    put(drawing, "pulley", pulley, "crank shaft")
    put(drawing, "pulley grub", cyl(axis + at(10, 0, -58), X, 2.5, 7), "pulley")
    part = union(cyl(pin + 6 * Z, Z, 5, 10), cyl(pin + 16 * Z, Z, 7, 10.2), cyl(pin + 26.2 * Z, Z, 11, 4))
    put(drawing, "crank pin", part, "crank disc")
    put(drawing, "knife pin", headed(head + 25.4 * Z, -Z, 6, 36), "knife bar")
    put(drawing, "knife pin nut", hexagon(head - 12 * Z, Z, 9, 6, 6), "knife pin")
    pitman = union(bar(pin, head, 11, 16, 24), cyl(pin + 16 * Z, Z, 16, 10), cyl(head + 15 * Z, Z, 15, 10))
    pitman = cut(pitman, bore(pin, Z, 9, 40), bore(head, Z, 8.5, 40))
    drawing.add("pitman", pitman)
    put(drawing, "crank bush", tube(pin + 16 * Z, Z, 7 + play, 9, 10), "pitman")
    put(drawing, "knife bush", tube(head + 15.2 * Z, Z, 6 + play, 8.5, 9.8), "pitman")
    drawing.joint("Revolute", "pitman", "crank pin", pin, Z)
    drawing.joint("Revolute", "pitman", "knife bar", head, Z)
    return drawing


def jaw(drawing: Drawing, name: str, pin, way, host: str, play: float) -> None:
    """A fork on an eye 15 thick about y, its pin with a washer and a cotter, and a threaded hole along its way."""
    middle = at(pin[0], -107.5, pin[2])
    neck = middle + 24 * way
    ears = [laid(bar((0, 0), (0, 20), 12, *sorted((s * 7.8, s * 14))), middle, np.cross(way, -Y), -Y) for s in (-1, 1)]
    block = laid(box((-12, 20, -14), (12, 44, 14)), middle, np.cross(way, -Y), -Y)
    fork = cut(union(*ears, block), bore(middle, Y, 6 + play, 20), cyl(neck, way, 7, 30))
    put(drawing, f"{name} jaw", fork, host, "Revolute", pin, Y)
    put(drawing, f"{name} pin", cut(headed(middle + 14 * Y, -Y, 6, 38), bore(middle - 20 * Y, X, 1.5, 12)), host)
    put(drawing, f"{name} cotter", cyl(middle + at(-10, -20, 0), X, 1.5, 20), f"{name} pin")


@kind
def semaphore_signal(random):
    """An arm and lenses on a casting keyed on a spindle, a rod between forks, a weighted lever on a stud, a lamp."""
    drawing, play = Drawing(["post"]), random.choice([0.05, 0.2, 0.4])
    high, low, reach = at(0, 0, 1300), at(0, 0, 300), random.uniform(75, 100)
    upper, lower, pull = high + at(20, 0, -95), low + reach * X, low - 110 * X
    ground = [at(x, y, -10) for x in (-110, 110) for y in (-110, 110)]
    spots = {p[2]: [p + at(x, -40, z) for x in (-28, 28) for z in (-50, 50)] for p in (high, low)}
    post = cut(box((-40, -40, 0), (40, 40, 1500)), box((-32, -32, -1), (32, 32, 1501)))
    post = union(post, cut(box((-150, -150, -20), (150, 150, 0)), *(bore(p, Z, 11, 30) for p in ground)))
    lamp = [at(40, y, 1290) for y in (-20, 20)]
    post = cut(
        post, *(cyl(p, Y, 5, 9) for two in spots.values() for p in two), *(cyl(p - 9 * X, X, 4, 12) for p in lamp)
    )
    drawing.add("post", post)
    cap = union(
        box((-32, -32, 1480), (32, 32, 1500)), box((-46, -46, 1500), (46, 46, 1508)), cyl((0, 0, 1508), Z, 12, 30)
    )
    put(drawing, "finial", union(cap, sphere((0, 0, 1550), 22)), "post")
    for name, p in (("upper", high), ("lower", low)):
        plate = union(box(p + at(-42, -52, -66), p + at(42, -40, 66)), cyl(p - 92 * Y, Y, 30, 52))
        inner = cyl(p - 95 * Y, Y, 22 if name == "upper" else 15, 56)
        put(drawing, f"{name} bracket", cut(plate, inner, *(bore(q, Y, 5.5, 20) for q in spots[p[2]])), "post")
        for k, q in enumerate(spots[p[2]] if name == "upper" else []):
            bolt = union(cyl(q - 12 * Y, Y, 5, 20), hexagon(q - 18 * Y, Y, 8, 6))
            put(drawing, f"{name} bolt {k}", bolt, "post")
    put(drawing, "upper bush", tube(high - 92 * Y, Y, 15 + play, 22, 38), "upper bracket")
    keyway = box(high + at(-4, -122, 10), high + at(4, -100, 16.4))
    spindle = union(cyl(high - 150 * Y, Y, 12, 30), cyl(high - 123 * Y, Y, 15, 81), cyl(high - 98 * Y, Y, 22, 5.8))
    put(drawing, "spindle", cut(spindle, keyway), "upper bush", "Revolute", high, Y)
    put(drawing, "spindle collar", tube(high - 53.8 * Y, Y, 15, 20, 8), "spindle")
    put(drawing, "key", box(high + at(-4, -122, 10), high + at(4, -100, 18)), "spindle")
    lenses = [high + at(150, 0, z) for z in (72, -72)]
    front, back = -115, -100
    casting = [cyl(high + front * Y - 8 * Y, Y, 32, 25 - 2)]
    casting += [cyl(p + front * Y, Y, 76, 15) for p in lenses]
    for p in (*lenses, high - 150 * X, upper):
        flat = bar((high[0], high[2]), (p[0], p[2]), 20 if p is not upper else 16, -back, -front)
        casting.append(flat.rotate((0, 0, 0), (1, 0, 0), 90))
    ties = [high + x * X for x in (-80, -130)]
    casting = cut(union(*casting), bore(high, Y, 15), keyway, keyway.translate((0, 0, 1.6)), bore(upper, Y, 6))
    casting = cut(
        casting,
        *(cyl(p + front * Y - Y, Y, 60, 20) for p in lenses),
        *(cyl(p + (front - 1) * Y, Y, 66, 9) for p in lenses),
    )
    put(drawing, "spectacle", cut(casting, *(bore(p, Y, 5.5) for p in ties)), "spindle")
    put(drawing, "spindle washer", tube(high - 126 * Y, Y, 12, 28, 3), "spindle")
    put(drawing, "spindle nut", hexagon(high - 138 * Y, Y, 19, 12, 12), "spindle")
    for k, p in enumerate(lenses):
        put(drawing, f"lens {k}", cyl(p + (front + 3) * Y, Y, 66, 5), "spectacle")
    board = cut(box(high + at(-850, front - 8, -60), high + at(-50, front, 60)), *(bore(p, Y, 5.5) for p in ties))
    put(drawing, "board", board, "spectacle")
    for k, p in enumerate(ties):
        put(drawing, f"board bolt {k}", union(cyl(p - 123 * Y, Y, 5.5, 35), cyl(p - 127 * Y, Y, 11, 4)), "board")
        put(drawing, f"board nut {k}", hexagon(p - 100 * Y, Y, 9, 9, 5.5), f"board bolt {k}")
    stud = union(cyl(low - 130 * Y, Y, 15, 78), cyl(low - 96 * Y, Y, 24, 4))
    put(drawing, "stud", grooved(stud, low - 124 * Y, Y, 15), "lower bracket")
    lever = bar((low[0] - 300, low[2]), (lower[0], lower[2]), 18, -back, -front).rotate((0, 0, 0), (1, 0, 0), 90)
    lever = union(lever, cyl(low - 119 * Y, Y, 28, 23))
    lever = cut(lever, bore(low, Y, 19), bore(lower, Y, 6), bore(pull, Y, 6))
    put(drawing, "lever", lever, "stud", "Revolute", low, Y)
    put(drawing, "lever bush", tube(low - 119 * Y, Y, 15 + play, 19, 23), "lever")
    put(drawing, "lever washer", tube(low - 122.8 * Y, Y, 15, 26, 3), "stud")
    put(drawing, "lever circlip", circlip(low - 124 * Y, Y, 15), "stud")
    weight = cut(
        box(low + at(-290, -150, -60), low + at(-200, -65, 60)),
        drawing.parts["lever"],
        cyl(low + at(-245, -107.5, 0), Z, 6, 80),
    )
    put(drawing, "weight", weight, "lever")
    part = union(cyl(low + at(-245, -107.5, 18), Z, 6, 60), hexagon(low + at(-245, -107.5, 70), Z, 9, 10))
    put(drawing, "weight screw", part, "weight")
    way = (lower - upper) / np.linalg.norm(lower - upper)
    jaw(drawing, "top", upper, way, "spectacle", play)
    jaw(drawing, "bottom", lower, -way, "lever", play)
    start = at(upper[0], -107.5, upper[2])
    put(drawing, "rod", cyl(start + 26 * way, way, 7, np.linalg.norm(lower - upper) - 52), "top jaw")
    drawing.joint("Weld", "rod", "bottom jaw")
    put(drawing, "rod lock nut", hexagon(start + 44 * way, way, 11, 8, 7), "rod")
    jaw(drawing, "pull", pull, -Z, "lever", play)
    put(drawing, "pull rod", cyl(at(pull[0], -107.5, pull[2] - 24), -Z, 7, 200), "pull jaw")
    shelf = cut(
        union(box((40, -40, 1270), (48, 40, 1310)), box((40, -40, 1304), (210, 40, 1310))),
        *(bore(p, X, 4.2, 20) for p in lamp),
    )
    put(drawing, "lamp bracket", shelf, "post")
    for k, p in enumerate(lamp):
        put(drawing, f"lamp bolt {k}", union(cyl(p - 8 * X, X, 4, 18), hexagon(p + 8 * X, X, 6.5, 5)), "post")
    body = union(
        box((105, -35, 1310), (195, 35, 1430)), cyl((150, -35, 1372), -Y, 30, 30), cyl((150, 0, 1430), Z, 25, 30)
    )
    put(drawing, "lamp", body, "lamp bracket")
    return drawing
