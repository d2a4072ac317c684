"""What swivels: a model of Peaucellier's straight line, the head of a windmill that pumps, a camera on two servos."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.office import compound
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
    meet,
    screw,
    torus,
    tube,
    union,
)  # fmt: skip


@kind
def peaucellier_model(random):
    """Seven bars in four storeys on a board with two posts, washers between the bars, bolts with nuts."""
    drawing, play = Drawing(["board"]), random.choice([0.0, 0.05, 0.2])
    crank, turn, long, short = 50.0, random.uniform(0.2, 0.6), random.uniform(135, 145), random.uniform(58, 62)
    o, a = at(0, 0), at(crank, 0)
    b = a + crank * at(np.cos(turn), np.sin(turn))
    away = float(np.linalg.norm(b))
    c, d = meet(b, short, o, long), meet(o, long, b, short)
    e = b * (long**2 - short**2) / away**2
    storey = [10.5 + 4.5 * number for number in range(4)]
    board = box((-40, -140, -5), (260, 160, 5)).edges("|Z").fillet(10)
    drawing.add("board", cut(board, *(bore((*p, 0), Z, 2.2) for p in (o, a))))
    for name, p, high in (("long post", o, storey[1]), ("short post", a, storey[0])):
        post = cyl((*p, 5), Z, 6, high - 5.5)
        drawing.add(name, cut(post, bore((*p, 0), Z, 2)))
        drawing.add(f"{name} washer", tube((*p, high - 0.5), Z, 2.1, 5, 0.5))
        drawing.add(f"{name} screw", screw((*p, -5), Z, 2, 11.5))
        drawing.joint("Weld", name, "board")
    bars = {"crank": (a, b, 0), "bar oc": (o, c, 2), "bar od": (o, d, 1), "bar cb": (c, b, 1), "bar db": (d, b, 2),
            "bar ce": (c, e, 3), "bar de": (d, e, 0)}  # fmt: skip
    for name, (p, q, level) in bars.items():
        radius = 2 + play
        drawing.add(name, bar(p, q, 6, storey[level], storey[level] + 4, (p, q), radius))
    drawing.add("long post bolt", screw((*o, storey[2] + 4.02), -Z, 2, 15))
    drawing.add("short post bolt", screw((*a, storey[0] + 4.02), -Z, 2, 7.5))
    drawing.add("long post spacer", tube((*o, storey[1] + 4), Z, 2.1, 5, 0.5))
    for name, p, low, high in (("b", b, 0, 2), ("c", c, 1, 3), ("d", d, 0, 2), ("e", e, 0, 3)):
        long_ = storey[high] - storey[low] + 4.05
        drawing.add(f"bolt {name}", headed((*p, storey[low] - 0.02), Z, 2, long_ + 3))
        drawing.add(f"nut {name}", hexagon((*p, storey[high] + 4.02), Z, 3.5, 3, 2))
        if name == "e":
            drawing.add("spacer e", tube((*p, storey[0] + 4), Z, 2.1, 5, 9.5))
            continue
        for number in range(low, high):
            drawing.add(f"washer {name}{number}", tube((*p, storey[number] + 4), Z, 2.1, 5, 0.5))
    pairs = [("crank", "short post", a), ("bar oc", "long post", o), ("bar od", "long post", o), ("bar cb", "crank", b),
             ("bar db", "crank", b), ("bar oc", "bar cb", c), ("bar ce", "bar cb", c), ("bar od", "bar db", d),
             ("bar de", "bar db", d), ("bar ce", "bar de", e)]  # fmt: skip
    for one, other, p in pairs:
        drawing.joint("Revolute", one, other, (*p, 0), Z)
    return drawing


@kind
def windmill_pump(random):
    """A head on a mast, a shaft with wheel and keyed nut, an overhung crank, a rod to a fork, a tail on a hinge."""
    drawing, play = Drawing(["mast"]), random.choice([0.05, 0.1, 0.2])
    turn, throw, long = random.uniform(0.3, 2.8), 15.0, 50.0
    axle, tail = at(0, 0, 110), at(-52, 0, 6)
    crank = axle + throw * at(0, np.cos(turn), np.sin(turn))
    foot = at(0, 0, crank[2] - np.sqrt(long**2 - crank[1] ** 2))
    drawing.add("mast", tube(-140 * Z, Z, 20, 25, 140))
    for name, z in (("upper", -20), ("lower", -60)):
        drawing.add(f"{name} mast bush", tube(z * Z, Z, 14 + play, 20.01, 20))
    drawing.add("thrust washer", tube(0 * Z, Z, 16, 25, 6))
    head = union(
        box((-44, -40, 6), (74, 40, 16)),
        cyl(-70 * Z, Z, 14, 77),
        *(box((x, -20, 15), (x + 12, 20, 128)).edges("|X and >Z").fillet(10) for x in (20, 60)),
        box((-60, -8, 6), (-40, 8, 16)),
        box((-44, -8, 15), (-40, 8, 50)),
        box((-60, -8, 40), (-40, 8, 50)),
    )
    head = cut(head, bore(axle, X, 11), bore(tail, Z, 4), bore(0 * Z, Z, 9), cyl(at(14.5, 0, -65), -X, 2, 4))
    drawing.add("head", head)
    drawing.add("collar", cut(tube(-70 * Z, Z, 14, 19, 9.95), cyl((0, 0, -65), X, 2, 25)))
    drawing.add("collar screw", cut(cyl((10.5, 0, -65), X, 2, 8.5), hexagon((19, 0, -65), -X, 1, 2)))
    for name, x, s in (("rear", 20, 1), ("front", 72, -1)):
        bush = union(
            tube(axle + x * X, s * X, 8 + play / 2, 11.01, 12), tube(axle + x * X, -s * X, 8 + play / 2, 14, 2)
        )
        drawing.add(f"{name} shaft bush", bush)
    shaft = union(cyl(axle + 8 * X, X, 8, 92), cyl(axle + 100 * X, X, 5, 14))
    cross = at(0, -np.sin(turn), np.cos(turn))
    across = axle + 13 * X - 24 * cross
    drawing.add("shaft", cut(shaft, bore(across, cross, 1.5), box(axle + at(78, -2, 5), axle + at(96, 2, 9))))
    drawing.add("key", box(axle + at(78.05, -2, 5), axle + at(95.95, 2, 10)))
    disc = cut(tube(axle + 8 * X, X, 8, 24, 10), bore(crank, X, 5), bore(across, cross, 1.5))
    drawing.add("crank disc", disc)
    drawing.add("disc pin", cyl(across, cross, 1.5, 48))
    outs = [at(0, np.cos(t), np.sin(t)) for t in np.linspace(0, 2 * np.pi, 8, endpoint=False)]
    blade = box((20, -1, -12), (170, 1, 12))
    blades = [laid(blade, axle + 87 * X, out, 0.8 * X + 0.6 * np.cross(X, out)) for out in outs]
    wheel = union(cyl(axle + 74.05 * X, X, 26, 26), *blades)
    keyway = box(axle + at(70, -2, 0), axle + at(105, 2, 10.1))
    drawing.add("wheel", cut(wheel, bore(axle, X, 8.02), keyway))
    drawing.add("wheel washer", tube(axle + 100.05 * X, X, 5.2, 12, 2))
    drawing.add("wheel nut", hexagon(axle + 102.05 * X, X, 8, 6, 5))
    drawing.add("crank pin", headed(crank - 6.1 * X, X, 5, 24.1))
    drawing.add("crank spacer", tube(crank + 6 * X, X, 5.1, 8, 2))
    rod = laid(bar((0, 0), (long, 0), 12, -6, 6, ((0, 0), (long, 0)), 4 + play), crank, foot - crank, X)
    drawing.add("pitman", cut(rod, bore(crank, X, 8)))
    drawing.add("pitman bush", tube(crank - 6 * X, X, 5 + play, 8.01, 12))
    fork = cut(
        box(foot + at(-11, -9, -25), foot + at(11, 9, 9)), box(foot + at(-6.2, -10, -13), foot + at(6.2, 10, 10))
    )
    stud = foot - 19 * Z
    fork = cut(fork, bore(foot, X, 4), cyl(foot - 26 * Z, Z, 6, 12), bore(stud, X, 1.5, 20))
    drawing.add("fork", fork)
    pin = headed(foot - 11.05 * X, X, 4, 28)
    drawing.add("fork pin", cut(pin, bore(foot + 13.5 * X, Y, 1)))
    drawing.add("split pin", union(cyl(foot + at(13.5, -7, 0), Y, 1, 14), torus(foot + at(13.5, 9.2, 0), X, 2.4, 0.8)))
    drawing.add("pump rod", cut(cyl((0, 0, -200), Z, 6, float(foot[2]) + 186), bore(stud, X, 1.5, 20)))
    drawing.add("rod pin", cyl(stud - 11 * X, X, 1.5, 22))
    for name, z, s in (("top", 16, -1), ("bottom", -70, 1)):
        guide = union(tube(z * Z, s * Z, 6 + play, 9.01, 15), tube(z * Z, -s * Z, 6 + play, 12, 3))
        drawing.add(f"{name} rod guide", guide)
        drawing.joint("Weld", f"{name} rod guide", "head")
    bolts = [at(-175, 0, 28), at(-200, 0, 28)]
    boom = cut(
        union(cyl(tail + 10.2 * Z, Z, 7, 23.6), box((-210, -5, 22), (-52, 5, 34))),
        bore(tail, Z, 4 + play),
        *(bore(p, Y, 2.6, 9) for p in bolts),
    )
    drawing.add("boom", boom)
    drawing.add("boom pin", headed(tail + 44 * Z, -Z, 4, 52).cut(bore(tail - 5 * Z, X, 1, 9)))
    drawing.add("boom split pin", cyl(tail + at(-7, 0, -5), X, 1, 14))
    drawing.add("vane", cut(box((-270, 5, 0), (-165, 8, 60)), *(bore(p, Y, 2.6, 9) for p in bolts)))
    for number, p in enumerate(bolts):
        drawing.add(f"vane bolt {number}", headed(p + 8 * Y, -Y, 2.5, 17))
        drawing.add(f"vane nut {number}", hexagon(p - 5 * Y, -Y, 4, 3.5, 2.5))
    for name in ("upper", "lower"):
        drawing.joint("Weld", f"{name} mast bush", "mast")
    for name in ("rear", "front"):
        drawing.joint("Weld", f"{name} shaft bush", "head")
    drawing.joint("Revolute", "head", "mast", 0 * Z, Z)
    drawing.joint("Weld", "collar", "head")
    drawing.joint("Revolute", "shaft", "head", axle, X)
    drawing.joint("Weld", "crank disc", "shaft")
    drawing.joint("Weld", "wheel", "shaft")
    drawing.joint("Weld", "crank pin", "crank disc")
    drawing.joint("Weld", "pitman bush", "pitman")
    drawing.joint("Revolute", "pitman", "crank disc", crank, X)
    drawing.joint("Revolute", "pitman", "fork", foot, X)
    drawing.joint("Weld", "pump rod", "fork")
    drawing.joint("Cylindrical", "pump rod", "head", 0 * Z, Z)
    drawing.joint("Revolute", "boom", "head", tail, Z)
    drawing.joint("Weld", "vane", "boom")
    return drawing


def _servo() -> tuple[Shape, Shape, Shape]:
    """A servo of three shells, its spline and its horn, about z; the ears lie on the plane z = 32."""
    outline, cavity = ((-17.3, -6), (5.3, 6)), (cyl((0, 0, 33.95), Z, 4.6, 2.1), bore(0 * Z, Z, 2.42))
    low, middle, high = (box((*outline[0], z), (*outline[1], top)) for z, top in ((12, 28), (28, 34), (34, 37)))
    middle = cut(
        union(middle, box((-22, -6, 32), (10, 6, 34))), *(bore(p, Z, 1.1) for p in (at(-19.6, 0, 0), at(7.6, 0, 0)))
    )
    middle = cut(middle, cyl((0, 0, 33.95), Z, 4.6, 1))
    high = cut(union(high, cyl((0, 0, 36), Z, 5.9, 5)), cavity[0], cyl((0, 0, 33), Z, 2.42, 9))
    spline = cut(union(cyl((0, 0, 34), Z, 4.5, 2), cyl((0, 0, 35), Z, 2.4, 8.5)), cyl((0, 0, 37), Z, 1, 8))
    horn = bar((-14, 0), (14, 0), 3, 41.5, 44.5).union(cyl((0, 0, 41.5), Z, 4, 3))
    horn = cut(horn, cyl((0, 0, 41), Z, 2.4, 2.5), bore(0 * Z, Z, 1.1), *(bore(at(x, 0, 0), Z, 0.8) for x in (-12, 12)))
    return compound(low, middle, high), spline, horn


@kind
def pan_tilt(random):
    """A printed base with a servo that turns a platform, a servo on it that tilts a cradle, an idler bearing."""
    drawing, play = Drawing(["base"]), random.choice([0.05, 0.15])
    high = random.uniform(78, 84)
    tilt = at(0, -56, high)
    corners = [at(x, y, 0) for x in (-24, 24) for y in (-19, 19)]
    hollow = cut(box((-27, -22, -1), (27, 22, 29)), *(cyl(p, Z, 3.5, 30) for p in corners))
    base = cut(box((-30, -25, 0), (30, 25, 32)).edges("|Z").fillet(4), hollow, *(cyl(p, Z, 1.2, 10) for p in corners))

    def lie(shape: Shape) -> Shape:
        """A shape of a servo, laid from about z to about the axis of the tilt."""
        return compound(*(laid(Shape(obj=each), tilt, Z, Y) for each in shape.vals()))

    def keep(shape: Shape) -> Shape:
        return shape

    room = box((-17.3 - play, -6 - play, 20), (5.3 + play, 6 + play, 40))
    ears, ends = [at(-19.6, 0, 34), at(7.6, 0, 34)], [at(x, 0, 41.5) for x in (-12, 12)]
    nest = union(bar((-14, 0), (14, 0), 3 + play, 41, 44.5), cyl((0, 0, 41), Z, 4 + play, 3.5))
    nest = union(nest, cyl((0, 0, 41), Z, 3, 20), *(cyl(p, Z, 0.8, 8) for p in ends))
    drawing.add("base", cut(base, room, *(cyl(p, -Z, 1, 10) for p in ears)))
    drawing.add("cover", cut(box((-30, -25, -3), (30, 25, 0)), *(bore(p, Z, 1.4) for p in corners)))
    for number, p in enumerate(corners):
        drawing.add(f"cover screw {number}", screw(p - 3 * Z, Z, 1.2, 10))
    platform = union(
        box((-20, -30, 42.5), (20, 30, 49)),
        box((-11, -27, 43), (11, -24, high + 14)),
        box((-11, 16, 43), (11, 20, high + 12)),
    )
    platform = cut(platform, nest, lie(room), *(lie(cyl(p, -Z, 1, 10)) for p in ears), cyl((0, 14, high), Y, 2, 9))
    drawing.add("platform", platform)
    tray = union(
        *(box((-10, y, high - 22), (10, y + 4, high + 20)) for y in (-13, 9)),
        box((-10, -13, high - 24), (30, 13, high - 20)),
    )
    feet = [at(16, y, high - 24) for y in (-8, 8)]
    drawing.add("cradle", cut(tray, lie(nest), cyl((0, 8, high), Y, 4.99, 9), *(bore(p, Z, 1.1, 9) for p in feet)))
    for name, put in (("pan", keep), ("tilt", lie)):
        servo, spline, horn = _servo()
        drawing.add(f"{name} servo", put(servo))
        drawing.add(f"{name} spline", put(spline))
        drawing.add(f"{name} horn", put(horn))
        drawing.add(f"{name} horn screw", put(screw((0, 0, 44.5), -Z, 1, 6)))
        for number, (ear, end) in enumerate(zip(ears, ends, strict=True)):
            drawing.add(f"{name} ear screw {number}", put(screw(ear, -Z, 1, 5)))
            drawing.add(f"{name} small screw {number}", put(screw(end, Z, 0.8, 4.8)))
        drawing.joint("Weld", f"{name} horn", f"{name} spline")
    drawing.add("bearing", tube((0, 9, high), Y, 2, 5, 4))
    drawing.add("spacer", tube((0, 13, high), Y, 2.1, 3.2, 3))
    drawing.add("idler bolt", screw((0, 20, high), -Y, 2, 14))
    drawing.add("idler nut", hexagon((0, 9, high), -Y, 3.5, 3, 2))
    camera = union(box((12, -12, high - 20), (20, 12, high + 4)), cyl((20, 0, high - 8), X, 7, 12))
    drawing.add("camera", cut(camera, *(cyl(p, Z, 1, 9) for p in feet)))
    for number, p in enumerate(feet):
        drawing.add(f"camera screw {number}", screw(p, Z, 1, 8))
    drawing.joint("Weld", "cover", "base")
    drawing.joint("Weld", "pan servo", "base")
    drawing.joint("Revolute", "pan spline", "pan servo", 0 * Z, Z)
    drawing.joint("Weld", "platform", "pan horn")
    drawing.joint("Weld", "tilt servo", "platform")
    drawing.joint("Revolute", "tilt spline", "tilt servo", tilt, Y)
    drawing.joint("Weld", "cradle", "tilt horn")
    drawing.joint("Revolute", "cradle", "platform", tilt, Y)
    drawing.joint("Weld", "camera", "cradle")
    return drawing
