"""A wheel of a robot, a hose reel, a rotary actuator."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.mown import fix, flat, screws
from drawings.powered import grooved
from drawings.shapes import (
    X,
    Y,
    Z,
    at,
    bore,
    box,
    cut,
    cyl,
    headed,
    hexagon,
    laid,
    tube,
    union,
)


@kind
def mecanum_wheel(random):
    """Barrel rollers on slanting pins between two plates with bosses, a hub with a key on the shaft of a motor."""
    drawing, play, count = Drawing(["motor"]), random.choice([0.1, 0.2]), 8
    ring, ties = 40.0, hollow(0 * X, Z, 10, 3)
    spots = [
        (ring * at(np.cos(t), np.sin(t), 0), at(-np.sin(t), np.cos(t), 1) / np.sqrt(2))
        for t in np.arange(count) * np.pi / 4
    ]
    motor = union(cyl(-100 * Z, Z, 22, 66), cyl(-34 * Z, Z, 9, 2))
    corners = hollow(-34 * Z, Z, 15, 4)
    drawing.add("motor", cut(motor, cyl(-60 * Z, Z, 5, 90), *(cyl(p, -Z, 1.5, 9) for p in corners)))
    bracket = union(box((-28, -28, -34), (28, 45, -30)), box((-28, 41, -80), (28, 45, -30)))
    holes = [bore(at(x, 43, z), Y, 2.7, 9) for x in (-18, 18) for z in (-70, -48)]
    fix(
        drawing,
        "motor",
        "bracket",
        cut(bracket, bore(-32 * Z, Z, 9, 3), *(bore(p, Z, 1.7, 9) for p in corners), *holes),
    )
    screws(drawing, "motor", "motor screw", [p + 4 * Z for p in corners], -Z, 1.5, 12)
    key = box((-2, 2.5, -10), (2, 6.5, 12))
    drawing.add("shaft", cut(cyl(-60 * Z, Z, 5, 84), key, cyl(5 * Z, Z, 2, 30)))
    drawing.joint("Revolute", "shaft", "motor", 0 * X, Z)
    fix(drawing, "shaft", "key", key)
    hub = cut(tube(-20 * Z, Z, 5, 16, 40), box((-2, 2, -21), (2, 6.5, 21)), *(bore(p, Z, 1.5, 21) for p in ties))
    fix(drawing, "shaft", "hub", hub)
    fix(drawing, "shaft", "end washer", tube(24 * Z, Z, 2.2, 7.5, 2))
    screws(drawing, "shaft", "end screw", [26 * Z], -Z, 2, 16)
    for s, name in ((-1, "inner"), (1, "outer")):
        disc = union(tube(s * 20 * Z, s * Z, 5.5, 46, 4), *(cyl(p + s * 17 * d, s * d, 5, 12) for p, d in spots))
        disc = cut(disc, box((-99, -99, s * 24), (99, 99, s * 50)), *(cyl(p, s * d, 2.5, 26) for p, d in spots))
        disc = cut(disc, bore(0 * X, Z, 5.5), *(bore(p, Z, 1.7, 30) for p in ties))
        fix(drawing, "hub", f"{name} plate", disc)
        screws(drawing, "hub", f"{name} screw", [p + s * 24 * Z for p in ties], -s * Z, 1.5, 14)
    edge = [
        (5.0, -16.0),
        *((50 - float(np.hypot(ring, u / np.sqrt(2))), float(u)) for u in np.linspace(-16, 16, 9)),
        (5.0, 16.0),
    ]
    barrel = cq.Workplane("XZ").polyline(edge).close().revolve(360, (0, 0, 0), (0, 1, 0))
    for k, (p, d) in enumerate(spots):
        fix(drawing, "inner plate", f"pin {k}", cyl(p - 26 * d, d, 2.5, 52))
        drawing.add(f"core {k}", tube(p - 16.8 * d, d, 2.5 + play, 5, 33.6))
        drawing.joint("Revolute", f"core {k}", f"pin {k}", p, d)
        fix(drawing, f"core {k}", f"rubber {k}", laid(barrel, p, p / ring, d))
    return drawing


@kind
def hose_reel(random):
    """A frame that swings on a wall plate, a drum of sheet discs on a hollow axle, a water swivel, a crank, a lock."""
    drawing, play, r = Drawing(["wall plate"]), random.choice([0.1, 0.3]), random.uniform(135, 150)
    c, h = at(r + 40, 0, 0), at(8, 0, 0)
    nails, ties, hole = [at(-4, y, z) for y in (-45, 45) for z in (-65, 65)], hollow(c, Y, 36, 3), at(80, 0, 0)
    wall = union(box((-10, -60, -80), (-4, 60, 80)), *(box((-4, -12, z), (8, 12, z + 10)) for z in (40, -50)))
    wall = cut(
        union(wall, *(cyl(h + z * Z, Z, 12, 10) for z in (40, -50))),
        bore(h, Z, 6),
        *(bore(p, X, 3.2, 9) for p in nails),
    )
    drawing.add("wall plate", wall)
    screws(drawing, "wall plate", "wall screw", nails, -X, 3, 50)
    arms = [flat(at(26, 0, 0), c, 26, *sorted((s * 122, s * 130))) for s in (-1, 1)]
    frame = union(
        box((20, -130, -26), (28, 130, 26)), *arms, cyl(h - 38 * Z, Z, 12, 76), box((8, -10, -26), (22, 10, 26))
    )
    frame = cut(frame, box((-30, -140, -40), (20, -30, 40)), box((-30, 30, -40), (20, 140, 40)), bore(h, Z, 6 + play))
    drawing.add("frame", cut(frame, bore(c, Y, 12), cyl(hole + 100 * Y, Y, 8, 50)))
    drawing.joint("Revolute", "frame", "hinge pin", h, Z)
    fix(drawing, "wall plate", "hinge pin", grooved(headed(h + 50 * Z, -Z, 6, 108), h - 51.2 * Z, Z, 6))
    fix(drawing, "hinge pin", "hinge clip", circlip(h - 51.2 * Z, Z, 6))
    for s in (-1, 1):
        drawing.add(f"hinge washer {s}", tube(h + s * 38 * Z, s * Z, 6 + play, 12, 2))
        drawing.joint("Revolute", f"hinge washer {s}", "hinge pin", h, Z)
        bush = union(tube(c + s * 122 * Y, s * Y, 8 + play, 12, 8), tube(c + s * 130 * Y, s * Y, 8 + play, 17, 2))
        fix(drawing, "frame", f"bush {s}", bush)
        drawing.joint("Revolute", "axle", f"bush {s}", c, Y)
        fix(drawing, "axle", f"clip {s}", circlip(c + (132.1 if s > 0 else -133.1) * Y, Y, 8))
        disc = cut(tube(c + s * 95 * Y, s * Y, 8.2, r, 2), *(bore(p, Y, 3, 130) for p in ties))
        disc = cut(disc, *(bore(p, Y, 5, 130) for p in hollow(c, Y, c[0] - hole[0], 8, -np.pi / 2)))
        hub = union(tube(c + s * 97 * Y, s * Y, 8, 44, 3), tube(c + s * 100 * Y, s * Y, 8, 15, 22))
        hub = cut(hub, *(bore(p, Y, 3, 130) for p in ties), cyl(c + s * 112 * Y, Z, 2, 20))
        fix(drawing, "axle", f"hub {s}", hub)
        fix(drawing, f"hub {s}", f"disc {s}", disc)
        fix(drawing, f"hub {s}", f"hub screw {s}", cyl(c + at(0, s * 112, 8), Z, 2, 7))
        drawing.joint("Weld", "barrel", f"disc {s}")
    axle = cut(
        cyl(c - 165 * Y, Y, 8, 320), cyl(c - 170 * Y, Y, 5, 190), cyl(c, Z, 4, 20), tube(c - 151 * Y, Y, 7, 9, 3)
    )
    axle = grooved(grooved(axle, c + 132.1 * Y, Y, 8), c - 133.1 * Y, Y, 8)
    drawing.add("axle", cut(axle, bore(c + 145 * Y, Z, 2)))
    drawing.add("barrel", cut(tube(c - 95 * Y, Y, 48, 51, 190), cyl(c + 40 * Z, Z, 6.5, 20)))
    fix(
        drawing,
        "axle",
        "outlet",
        cut(
            union(cyl(c + 5 * Z, Z, 4, 8), cyl(c + 9 * Z, Z, 6, 60)),
            cyl(c, Y, 8, 40),
            cyl(c - 20 * Y, Y, 8, 40),
            bore(c + 40 * Z, Z, 2.5, 45),
        ),
    )
    for k, p in enumerate(ties):
        fix(drawing, "hub 1", f"tie {k}", headed(p + 100 * Y, -Y, 3, 208))
        fix(drawing, f"tie {k}", f"tie nut {k}", hexagon(p - 100 * Y, -Y, 5, 5, 3))
    swivel = union(cyl(c - 175 * Y, Y, 14, 39), cyl(c - 169 * Y, -Z, 8, 26))
    swivel = cut(
        swivel,
        cyl(c - 165 * Y, Y, 8 + play, 40),
        cyl(c - 170 * Y, Y, 5, 9),
        cyl(c - 169 * Y, -Z, 5, 40),
        bore(c + at(8.2, -149.5, 0), Z, 1.2),
    )
    drawing.add("swivel", swivel)
    drawing.joint("Revolute", "swivel", "axle", c, Y)
    fix(drawing, "swivel", "swivel pin", cyl(c + at(8.2, -149.5, -11), Z, 1.2, 22))
    fix(
        drawing,
        "swivel",
        "inlet",
        cut(
            union(cyl(c + at(0, -169, -16), -Z, 5, 45), hexagon(c + at(0, -169, -26), -Z, 9, 8)),
            bore(c - 169 * Y, Z, 3),
        ),
    )
    tip = c + 110 * at(np.cos(0.6), 0, -np.sin(0.6))
    crank = cut(union(flat(c, tip, 12, 141, 149)), bore(c, Y, 8), bore(tip, Y, 4), bore(c + 145 * Y, Z, 2))
    fix(drawing, "axle", "crank", crank)
    fix(drawing, "crank", "crank pin", cyl(c + at(0, 145, -11.5), Z, 2, 23))
    fix(drawing, "crank", "knob screw", union(headed(tip + 215 * Y, -Y, 5, 66), cyl(tip + 141 * Y, Y, 4, 10)))
    drawing.add("knob", union(cyl(tip + 149.3 * Y, Y, 13, 65)).cut(bore(tip, Y, 5 + play)))
    drawing.joint("Revolute", "knob", "knob screw", tip, Y)
    fix(
        drawing,
        "frame",
        "lock bush",
        union(tube(hole + 118 * Y, Y, 4 + play, 8, 16), tube(hole + 130 * Y, Y, 4 + play, 12, 6)),
    )
    drawing.add("lock pin", cyl(hole + 99 * Y, Y, 4, 61))
    drawing.joint("Cylindrical", "lock pin", "lock bush", hole, Y)
    fix(drawing, "lock pin", "lock knob", cut(cyl(hole + 138 * Y, Y, 10, 28), cyl(hole + 130 * Y, Y, 4, 30)))
    return drawing


@kind
def rotary_actuator(random):
    """Two pistons with racks on a pinion in bushes, end caps on screws, stop screws with nuts, an indicator on top."""
    drawing, play, reach = Drawing(["body"]), random.choice([0.05, 0.1]), random.uniform(0, 8)
    corners = [at(0, y, z) for y in (-31, 31) for z in (-31, 31)]
    body = cut(box((-62, -40, -40), (62, 40, 40)), bore(0 * X, X, 26), bore(0 * X, Z, 12))
    body = cut(
        body,
        *(bore(p + x * X, X, 2.5, 16) for p in corners for x in (-62, 62)),
        *(bore((x, 40, 0), Y, 5, 16) for x in (-54, 8)),
    )
    drawing.add("body", body)
    for s, name in ((-1, "left"), (1, "right")):
        piston = union(
            cyl(s * (40 + reach) * X, s * X, 26 - play, 10),
            box((s * (40 + reach), -s * 10, -8), (s * (reach - 25), -s * 17, 8)),
        )
        piston = cut(piston, tube(s * (43.5 + reach) * X, s * X, 23, 30, 3))
        drawing.add(f"{name} piston", cut(piston, cyl(0 * X - 40 * Z, Z, 10, 80)))
        drawing.joint("Prismatic", f"{name} piston", "body", 0 * X, X)
        fix(drawing, f"{name} piston", f"{name} seal", tube(s * (43.5 + reach) * X, s * X, 23, 26, 3))
        pad = box((s * (reach - 20), -s * 17, -6), (s * (reach + 20), -s * 40, 6)).intersect(
            cyl(-90 * X, X, 26 - play, 180)
        )
        fix(drawing, f"{name} piston", f"{name} pad", pad)
        cap = cut(
            box((s * 62, -40, -40), (s * 74, 40, 40)),
            bore(s * 68 * X, X, 4, 9),
            *(bore(p + s * 68 * X, X, 2.7, 9) for p in corners),
        )
        fix(drawing, "body", f"{name} cap", cap)
        screws(drawing, "body", f"{name} cap screw", [p + s * 74 * X for p in corners], -s * X, 2.5, 26)
        stop = s * (50.0 + reach)
        fix(drawing, f"{name} cap", f"{name} stop screw", cyl(stop * X, s * X, 4, 45 - reach))
        fix(drawing, f"{name} stop screw", f"{name} stop nut", hexagon(s * 74 * X, s * X, 6.5, 6, 4))
        bush = union(tube(s * 28 * Z, s * Z, 9 + play, 12, 12), tube(s * 40 * Z, s * Z, 9 + play, 15, 1.5))
        fix(drawing, "body", f"{name} bush", bush)
        drawing.joint("Revolute", "pinion", f"{name} bush", 0 * X, Z)
        drawing.add(f"{name} thrust washer", tube(s * 41.5 * Z, s * Z, 9 + play, 14, 1))
        drawing.joint("Revolute", f"{name} thrust washer", "pinion", 0 * X, Z)
        fix(drawing, "pinion", f"{name} circlip", circlip((42.6 if s > 0 else -43.6) * Z, Z, 9))
    pinion = union(cyl(-48 * Z, Z, 9, 96), cyl(-12 * Z, Z, 9.9, 24), box((-5, -5, 48), (5, 5, 62)))
    pinion = grooved(grooved(pinion, 42.6 * Z, Z, 9), -43.6 * Z, Z, 9)
    square = box((-5, -5, -62), (5, 5, -36))
    drawing.add("pinion", cut(pinion, square, cyl(52 * Z, Z, 2, 20)))
    fix(drawing, "pinion", "drive square", square)
    pointer = cut(
        union(cyl(50 * Z, Z, 16, 14), box((0, -4, 50), (28, 4, 56))),
        box((-5, -5, 48), (5, 5, 62)),
        bore(60 * Z, Z, 2.2),
    )
    fix(drawing, "pinion", "indicator", pointer)
    screws(drawing, "pinion", "indicator screw", [64 * Z], -Z, 2, 10)
    for k, x in enumerate((-54, 8)):
        fitting = union(cyl((x, 30, 0), Y, 5, 10), hexagon((x, 40, 0), Y, 8, 9), cyl((x, 49, 0), Y, 5, 16))
        fix(drawing, "body", f"fitting {k}", cut(fitting, bore((x, 40, 0), Y, 3, 40)))
    return drawing
