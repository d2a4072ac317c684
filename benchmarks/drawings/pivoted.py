"""What turns on points, bolts and posts: a treadle, the brake of a wheelchair, a block on a swivel with its cleat."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import ball_bearing, hollow
from drawings.shapes import (
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
    torus,
    tube,
    union,
)  # fmt: skip


def cone(point, axis, first: float, last: float, length: float):
    """A cone from a point along an axis, with its radii at both ends."""
    place = (cq.Vector(*map(float, point)), cq.Vector(*map(float, axis)))
    return cq.Workplane(obj=cq.Solid.makeCone(float(first), float(last), float(length), *place))


def welds(drawing: Drawing, *pairs) -> None:
    """Parts of one body, pair by pair, as `one > other`."""
    for pair in pairs:
        drawing.joint("Weld", *pair.split(" > "))


@kind
def sewing_treadle(random):
    """Two legs with tie rods and a table, a treadle between cone points, a pitman on a ball, a flywheel on bushes."""
    drawing, play = Drawing(["right leg"]), random.choice([0.02, 0.05, 0.1])
    gap, press = random.choice([0.0, 0.05]), random.choice([0.0, 0.01])
    pivot, hub, ties = at(0, 0, 115), at(0, random.uniform(70, 90), 360), [at(0, -150, z) for z in (200, 600)]
    tilt, turn = random.uniform(0.06, 0.2), random.uniform(0.3, 1.2)
    ball, arm = pivot + at(185, 100 * np.cos(tilt), 100 * np.sin(tilt)), 32 * at(0, np.cos(turn), np.sin(turn))
    pin = hub + 185 * X + arm
    way, long = (pin - ball) / np.linalg.norm(pin - ball), float(np.linalg.norm(pin - ball))
    spots = [at(s * 270, y, 692) for s in (-1, 1) for y in (-130, 130)]
    for s, name in ((-1, "left"), (1, "right")):
        leg = [box((s * 240, y - 12, 0), (s * 252, y + 12, 700)) for y in (-150, 150)]
        leg += [box((s * 240, -150, z), (s * 252, 150, z + h)) for z, h in ((100, 30), (345, 30), (680, 20))]
        leg += [box((s * 240, -162, 692), (s * 285, 162, 700)), cyl(hub + s * 240 * X, s * X, 22, 16)]
        holes = [bore(p, X, 6) for p in (pivot, *ties)] + [bore(p, Z, 2.2, 20) for p in spots]
        drawing.add(f"{name} leg", cut(union(*leg), *holes, *([bore(hub, X, 6)] if s > 0 else [])))
        tip = pivot + s * (219 + gap) * X
        point = union(cone(tip, s * X, 0, 6, 8.4), cyl(tip + s * 8.4 * X, s * X, 6, 45))
        drawing.add(f"{name} cone screw", cut(point, box(tip + at(s * 50, -0.8, -7), tip + at(s * 55, 0.8, 7))))
        drawing.add(f"{name} lock nut", hexagon(pivot + s * 252 * X, s * X, 9, 7, 6))
        welds(drawing, f"{name} leg > table", f"{name} cone screw > {name} leg", f"{name} lock nut > {name} cone screw")
        for k, p in enumerate(ties):
            drawing.add(f"{name} tie nut {k}", hexagon(p + s * 252 * X, s * X, 9.5, 10, 6))
            welds(drawing, f"{name} tie nut {k} > tie rod {k}")
    drawing.add("table", cut(box((-300, -200, 700), (300, 200, 722)), *(cyl(p, Z, 1.5, 24) for p in spots)))
    for k, p in enumerate(spots):
        drawing.add(f"table screw {k}", screw(p, Z, 2, 22))
        welds(drawing, f"table screw {k} > table")
    for k, p in enumerate(ties):
        drawing.add(f"tie rod {k}", union(cyl(p - 240 * X, X, 8, 480), cyl(p - 266 * X, X, 6, 532)))
        welds(drawing, f"tie rod {k} > right leg")

    def tilted(shape):
        return shape.rotate((0, 0, 0), (1, 0, 0), float(np.degrees(tilt))).translate(tuple(pivot.tolist()))

    tread = cut(box((-150, -130, -14), (150, 130, -6)), *(box((-130, y, -20), (130, y + 12, 0)) for y in (-90, 60)))
    arms = box((160, -14, -8), (170, 114, 8)), box((148, -14, -14), (162, 50, -6))
    tread = union(tread, cyl(-226 * X, X, 12, 452), *arms)
    ends = [cone(s * 226 * X, -s * X, 5, 0, 7) for s in (-1, 1)] + [cyl(s * 221 * X, -s * X, 1, 6) for s in (-1, 1)]
    drawing.add("treadle", tilted(cut(tread, *ends, cyl((155, 100, 0), X, 5, 20))))
    stud = [sphere((185, 100, 0), 8), cyl((172, 100, 0), X, 4, 8), cyl((170, 100, 0), X, 7, 2.5)]
    drawing.add("ball stud", tilted(union(*stud, cyl((152, 100, 0), X, 5, 18))))
    drawing.add("stud nut", tilted(hexagon((154, 100, 0), X, 8, 6, 5)))
    rod = union(box((0.2, -16, -9), (24, 16, 9)), cyl((20, 0, 0), X, 7, long - 33), cyl((long, 0, -4), Z, 16, 8))
    socket = [sphere((0, 0, 0), 8 + play).rotate((0, 0, 0), (0, 1, 0), 90), cyl((0, 0, 0), -Z, 5.5, 20)]
    seat = [cyl((long, 0, -5), Z, 11, 8), cyl((long, 0, 0), Z, 9.5, 9)]
    parts = {"pitman": cut(rod, *socket, *seat, *(cyl((0, y, 0), X, 1.65, 17) for y in (-12, 12)))}
    cap = cut(box((-14, -16, -9), (-0.2, 16, 9)), *socket, *(bore((0, y, 0), X, 2.2, 30) for y in (-12, 12)))
    parts |= {"pitman cap": cap, **{f"cap screw {k}": screw((-14, 24 * k - 12, 0), X, 2, 28) for k in (0, 1)}}
    for name, shape in parts.items():
        drawing.add(name, laid(shape, ball, way, X))
    ball_bearing(drawing, "pitman", pin - 4 * X, X, 5, 11, 7)
    drawing.add("pin washer", tube(pin + 3 * X, X, 5, 7, 2))
    drawing.add("crank pin", union(cyl(pin - 7 * X, X, 8, 3), cyl(pin - 4 * X, X, 5, 9), cyl(pin + 5 * X, X, 4, 39)))
    drawing.add("crank nut", hexagon(pin + 37 * X, X, 6.5, 6, 4))
    rim = cut(tube(hub + 207 * X, X, 130, 150, 20), torus(hub + 217 * X, X, 151, 4))
    spokes = [cyl(p + 217 * X, p - hub, 6, 91) for p in hollow(hub, X, 44, 5)]
    wheel = union(rim, *spokes, cyl(hub + 210 * X, X, 48, 12), cyl(hub + 203 * X, X, 20, 34))
    wheel = union(wheel, cyl(pin + 5 * X, X, 12, 25))
    drawing.add("flywheel", cut(wheel, bore(hub, X, 12), bore(pin, X, 4)))
    bush = union(tube(hub + 203 * X, X, 8, 12 + press, 12), tube(hub + 201.5 * X, X, 8, 15, 1.5))
    drawing.add("front bush", cut(bush, bore(hub, X, 8 + play)))
    drawing.add("rear bush", tube(hub + 225 * X, X, 8 + play, 12 + press, 12))
    axle = union(cyl(hub + 196 * X, X, 8, 44), cyl(hub + 238 * X, X, 13, 2), cyl(hub + 240 * X, X, 6, 30))
    drawing.add("axle", cut(axle, tube(hub + 198.6 * X, X, 7.2, 9, 1.2)))
    drawing.add("axle circlip", circlip(hub + 198.6 * X, X, 8, 1.2))
    drawing.add("front washer", tube(hub + 199.9 * X, X, 8.1, 14, 1.5))
    drawing.add("rear washer", tube(hub + 237 * X, X, 8.1, 14, 0.9))
    drawing.add("nut washer", tube(hub + 256 * X, X, 6.2, 12, 1.6))
    drawing.add("axle nut", hexagon(hub + 257.6 * X, X, 9, 8, 6))
    welds(drawing, "ball stud > treadle", "stud nut > ball stud", "pitman cap > pitman", "cap screw 0 > pitman")
    welds(drawing, "cap screw 1 > pitman", "pitman outer ring > pitman", "pitman inner ring > crank pin")
    welds(drawing, "crank pin > flywheel", "crank nut > crank pin", "front bush > flywheel", "rear bush > flywheel")
    welds(drawing, "axle > right leg", "axle nut > axle")
    drawing.joint("Revolute", "treadle", "right leg", pivot, X)
    drawing.joint("Spherical", "pitman", "ball stud", ball)
    drawing.joint("Revolute", "pitman", "flywheel", pin, X)
    drawing.joint("Revolute", "flywheel", "axle", hub, X)
    return drawing


@kind
def wheelchair_brake(random):
    """A split clamp on a tube, a plate, a lever on a shoulder bolt, a riveted link, an arm with a shoe and a spring."""
    drawing, play, tap = Drawing(["frame tube"]), random.choice([0.0, 0.05, 0.1]), random.choice([2.5, 3.0])
    t, u, v = random.uniform(1.8, 2.2), random.uniform(-0.3, 0.1), random.uniform(1.95, 2.3)
    a, b, way = at(0, 36, 0), at(80, 30, 0), at(np.cos(t), np.sin(t), 0)
    c, d, shoe = a + 22 * at(np.cos(u), np.sin(u), 0), b + 34 * at(np.cos(v), np.sin(v), 0), b + at(30, -17, 0)
    end, stop = a + 120 * way, a + 30 * way + 11.7 * at(-way[1], way[0], 0)
    drawing.add("frame tube", tube((-150, 0, 0), X, 9, 11, 300))
    drawing.add("plug", union(cyl((138, 0, 0), X, 9.02, 12), cyl((150, 0, 0), X, 11, 4)))
    saddle, spots = box((-20, -20, 0.5), (20, 20, 17)), [at(0, y, 0) for y in (-15, 15)]
    drawing.add("upper clamp", cut(saddle, bore((0, 0, 0), X, 11), *(bore(p, Z, 3.2) for p in spots)))
    saddle = box((-20, -20, -17), (20, 20, -0.5))
    drawing.add("lower clamp", cut(saddle, bore((0, 0, 0), X, 11), *(bore(p, Z, tap) for p in spots)))
    plate = union(box((-28, -22, 17), (95, 48, 20)), bar(a, stop, 9, 17, 20))
    holes = [bore(p, Z, r) for p, r in ((a, 3), (b, 4), (stop, 2.5), (spots[0], 3.2), (spots[1], 3.2))]
    drawing.add("plate", cut(plate, *holes))
    for k, p in enumerate(spots):
        drawing.add(f"clamp screw {k}", screw(p + 20 * Z, -Z, 3, 35))
        welds(drawing, f"clamp screw {k} > lower clamp")
    drawing.add("stop pin", cyl(stop + 17 * Z, Z, 2.51, 14))
    lever = union(bar(a, end, 9, 24, 28), bar(a, c, 9, 24, 28), cyl(end + 26 * Z, way, 5, 90))
    drawing.add("lever", cut(lever, bore(a, Z, 6), bore(c, Z, 3 + play)))
    drawing.add("grip", cut(cyl(end + 20 * way + 26 * Z, way, 9, 76), cyl(end + 10 * way + 26 * Z, way, 5, 80)))
    drawing.add("lever bush", cut(union(cyl(a + 20 * Z, Z, 10, 3.9), cyl(a + 20 * Z, Z, 6, 8)), bore(a, Z, 4.5 + play)))
    drawing.add("lever washer", tube(a + 28 * Z, Z, 4.6, 9, 1))
    bolt = union(cyl(a + 10 * Z, Z, 3, 10), cyl(a + 20 * Z, Z, 4.5, 9.1), cyl(a + 29.1 * Z, Z, 8, 5))
    drawing.add("shoulder bolt", cut(bolt, hexagon(a + 31 * Z, Z, 2.5, 4)))
    drawing.add("lever nut", hexagon(a + 17 * Z, -Z, 5, 5, 3))
    drawing.add("link", bar(c, d, 6.5, 29, 32, (c, d), 3 + play))
    drawing.add("rivet c", rivet(c + 24 * Z, Z, 3, 8))
    drawing.add("rivet d", rivet(d + 24.1 * Z, Z, 3, 7.9))
    drawing.add("link washer c", tube(c + 28 * Z, Z, 3.1, 6, 1))
    drawing.add("link washer d", tube(d + 27.95 * Z, Z, 3.1, 6, 1))
    arm = union(bar(b, d, 9, 24.1, 27.9), bar(b, shoe, 9, 24.1, 27.9))
    drawing.add("arm", cut(arm, bore(b, Z, 4 + play), bore(d, Z, 3), bore(shoe, Z, 3.2)))
    drawing.add("arm bolt", headed(b + 17 * Z, Z, 4, 29))
    drawing.add("arm spacer", tube(b + 20 * Z, Z, 4.05, 8, 4))
    drawing.add("spring sleeve", tube(b + 28 * Z, Z, 4.05, 4.9, 8))
    drawing.add("torsion spring", tube(b + 28 * Z, Z, 5.1, 7.6, 7.9))
    drawing.add("arm washer", tube(b + 36 * Z, Z, 4.2, 9, 1.5))
    drawing.add("arm nut", hexagon(b + 37.5 * Z, Z, 6.5, 7, 4))
    drawing.add("shoe", cut(cyl(shoe + 27.9 * Z, Z, 9, 60), cyl(shoe + 27 * Z, Z, tap, 20)))
    drawing.add("shoe screw", screw(shoe + 24.1 * Z, Z, 3, 20))
    welds(drawing, "plug > frame tube", "upper clamp > frame tube", "lower clamp > frame tube", "plate > upper clamp")
    welds(drawing, "stop pin > plate", "grip > lever", "lever bush > lever", "shoulder bolt > plate")
    welds(
        drawing,
        "arm bolt > plate",
        "lever nut > shoulder bolt",
        "arm nut > arm bolt",
        "shoe > arm",
        "shoe screw > shoe",
    )
    for one, other, p in (("lever", "plate", a), ("arm", "plate", b), ("link", "lever", c), ("link", "arm", d)):
        drawing.joint("Revolute", one, other, p + 26 * Z, Z)
    return drawing


@kind
def boat_cleat_and_block(random):
    """A horn cleat and a pad eye through a deck, a shackle with a swivel post, a block of two cheeks with a becket."""
    drawing, play, tap = Drawing(["deck"]), random.choice([0.05, 0.1, 0.2]), random.choice([2.1, 2.5])
    phi, s1, horns = random.uniform(0, np.pi), at(0, 0, 18), [at(x, 0, 30) for x in (108, 152)]
    across, side = at(np.cos(phi), np.sin(phi), 0), at(-np.sin(phi), np.cos(phi), 0)
    pads = [at(0, y, 4) for y in (-22, 22)]
    deck = box((-120, -80, -12), (230, 80, 0))
    drawing.add("deck", cut(deck, *(bore(p, Z, 3.3, 60) for p in horns), *(bore(p, Z, 2.75, 60) for p in pads)))
    cleat = [box((92, -14, 0), (168, 14, 6)), cyl((50, 0, 30), X, 8, 160), *(cyl(p - 30 * Z, Z, 9, 32) for p in horns)]
    drawing.add("cleat", cut(union(*cleat), *(bore(p, Z, 3.3, 60) for p in horns), *(cyl(p, Z, 5.2, 9) for p in horns)))
    for k, p in enumerate(horns):
        drawing.add(f"cleat screw {k}", screw(p, -Z, 3, 50))
        drawing.add(f"cleat washer {k}", tube(at(p[0], 0, -12), -Z, 3.2, 9, 1.6))
        drawing.add(f"cleat nut {k}", hexagon(at(p[0], 0, -13.6), -Z, 5, 5, 3))
        drawing.add(f"pad screw {k}", screw(pads[k], -Z, 2.5, 21))
        welds(drawing, f"cleat screw {k} > cleat", f"cleat nut {k} > cleat screw {k}", f"pad screw {k} > backing plate")
    eye = union(box((-18, -30, 0), (18, 30, 4)), box((-8, -9, 3), (8, 9, 18)), cyl(s1 - 8 * X, X, 9, 16))
    drawing.add("pad eye", cut(eye, bore(s1, X, 4 + play), *(bore(p, Z, 2.75, 9) for p in pads)))
    drawing.add("backing plate", cut(box((-18, -30, -16), (18, 30, -12)), *(bore(p, Z, tap, 30) for p in pads)))
    legs = [union(box((s * 8.5, -8, 18), (s * 13.5, 8, 54)), cyl(s1 + s * 8.5 * X, s * X, 8, 5)) for s in (-1, 1)]
    shackle = union(*legs, box((-13.5, -8, 46), (13.5, 8, 54)))
    drawing.add("shackle", cut(shackle, bore(s1, X, 4), bore(s1, Z, 5 + play)))
    drawing.add("shackle pin", cut(headed(s1 + 13.5 * X, -X, 4, 28), bore(s1 + 15.2 * X, Z, 0.8)))
    drawing.add("lower thrust washer", tube((0, 0, 44.5), Z, 5.1, 7.5, 1.5))
    drawing.add("upper thrust washer", tube((0, 0, 54), Z, 5.1, 9, 1))
    hub, tail, own = at(0, 100, 0), at(0, 140, 0), {}  # from here on x lies across the block, y up, z along the axle
    post = union(cyl((0, 41, 0), Y, 7.2, 3.5), cyl((0, 44, 0), Y, 5, 23))
    own["swivel post"] = cut(post, bore((0, 59, 0), X, 1.5, 9))
    ties = [at(x, 64.5, 0) for x in (-7.6, 7.6)]
    head = cut(box((-11, 55, -8), (11, 70, 8)), cyl((0, 54, 0), Y, 5, 13), bore((0, 59, 0), X, 1.5, 30))
    own["block head"] = cut(head, *(bore(p, Z, 2, 30) for p in ties))
    own["roll pin"] = tube((-10.5, 59, 0), X, 0.8, 1.5, 21)
    for k, p in enumerate(ties):
        own[f"head rivet {k}"] = rivet(p - 10.5 * Z, Z, 2, 21)
        welds(drawing, f"head rivet {k} > block head")
    for k, s in enumerate((-1, 1)):
        cheek = union(bar((0, 70), tail, 13, *sorted((s * 8, s * 10.5))), cyl(hub + s * 8 * Z, s * Z, 31, 2.5))
        holes = [bore(p, Z, 2, 30) for p in ties] + [bore(hub, Z, 5), bore(tail, Z, 3)]
        own[f"cheek {k}"] = cut(cheek, *holes)
        own[f"side washer {k}"] = tube(hub + s * 7 * Z, s * Z, 6.1, 12, 0.9)
        own[f"axle washer {k}"] = tube(hub + s * 10.5 * Z, s * Z, 2.7, 9, 1)
        own[f"axle screw {k}"] = screw(hub + s * 11.5 * Z, -s * Z, 2.5, 8)
        own[f"becket spacer {k}"] = tube(tail + s * 4.1 * Z, s * Z, 3.05, 6, 3.9)
        welds(drawing, f"cheek {k} > block head", f"axle screw {k} > axle")
    axle = union(cyl(hub - 8 * Z, Z, 6, 16), cyl(hub - 10.5 * Z, Z, 5, 21))
    own["axle"] = cut(axle, *(cyl(hub + s * 2.5 * Z, s * Z, tap, 9) for s in (-1, 1)))
    own["sheave"] = cut(tube(hub - 7 * Z, Z, 10, 28, 14), torus(hub, Z, 30, 6.5))
    own["sheave bush"] = tube(hub - 7 * Z, Z, 6 + play, 10 + random.choice([0, 0.01]), 14)
    own["becket"] = cut(bar(tail, at(0, 166, 0), 9, -4, 4, (tail,), 3 + play), bore((0, 166, 0), Z, 5.5, 9))
    own["becket bolt"] = headed(tail + 10.5 * Z, -Z, 3, 27)
    own["becket nut"] = hexagon(tail - 10.5 * Z, -Z, 5, 5, 3)
    for name, shape in own.items():
        drawing.add(name, laid(shape, (0, 0, 0), side, across))
    welds(drawing, "cleat > deck", "pad eye > deck", "backing plate > deck", "shackle pin > shackle")
    welds(drawing, "swivel post > block head", "roll pin > block head", "axle > cheek 0", "sheave bush > sheave")
    welds(drawing, "becket bolt > cheek 1", "becket nut > becket bolt")
    drawing.joint("Revolute", "shackle", "pad eye", s1, X)
    drawing.joint("Revolute", "block head", "shackle", s1, Z)
    drawing.joint("Revolute", "sheave", "axle", (0, 0, 100), across)
    drawing.joint("Revolute", "becket", "becket bolt", (0, 0, 140), across)
    return drawing
