"""What motors and cylinders move: a leg with two drives, two rodless axes with a suction cup."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import ball_bearing, hollow
from drawings.powered import grooved
from drawings.shapes import Shape, X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, screw, sphere, tube, union


def cheeks(one, other, half: float, inner: float, outer: float):
    """Two bars without holes in planes of constant y, on both sides of y = 0."""
    flat = [at(p[0], p[2], 0) for p in (one, other)]
    sides = [bar(*flat, half, *sorted((s * inner, s * outer))) for s in (-1, 1)]
    return union(*(side.rotate((0, 0, 0), (1, 0, 0), 90) for side in sides))


def screws(drawing: Drawing, name: str, points, axis, radius: float, length: float, held: str) -> None:
    """Socket screws with their heads on these points, and what they are fixed to."""
    for number, p in enumerate(points):
        drawing.add(f"{name} {number}", screw(p, axis, radius, length))
        drawing.joint("Weld", f"{name} {number}", held)


def weld(drawing: Drawing, held: str, *names: str) -> None:
    """Say that parts are fixed to one."""
    for name in names:
        drawing.joint("Weld", name, held)


@kind
def quadruped_leg(random):
    """Two drives on plates with stand-offs, a thigh, a crank with a parallel rod, a shin on a ball bearing, a foot."""
    drawing, play, long = Drawing(["left plate"]), random.choice([0.0, 0.02, 0.1]), random.uniform(105, 130)
    lean, bend, arm = random.uniform(0.5, 0.8), random.uniform(0.35, 0.6), random.uniform(26, 29)
    hip, knee, down = at(0, 0, 0), long * at(-np.sin(lean), -np.cos(lean), 0), at(np.sin(bend), -np.cos(bend), 0)
    tip, tail, foot = hip - arm * down, knee - arm * down, knee + 1.05 * long * down
    posts = [at(-30, 48, 0), at(30, 48, 0), at(0, 66, 0)]
    for name, face, d, link in (("left", -16.0, -Z, "thigh"), ("right", 15.0, Z, "crank")):
        p, low, high = hip + face * Z, *sorted((face + 4 * d[2], face + 10 * d[2]))
        fixing, flange = hollow(p + 4 * d, Z, 26, 3), hollow(p, Z, 13, 3)
        sheet = [bar(a, b, 10, low, high) for a, b in ((posts[0], posts[1]), (posts[0], posts[2]), posts[1:])]
        sheet = union(cyl((0, 0, low), Z, 36, 6), box((-36, 0, low), (36, 50, high)), *sheet)
        sheet = cut(sheet, bore(p, Z, 20), *(bore(q, Z, 1.6) for q in fixing), *(bore(q, Z, 2.2) for q in posts))
        drawing.add(f"{name} plate", sheet)
        case = union(
            cyl(p + 10 * d, d, 30, 34),
            cyl(p + 7 * d, d, 20, 3),
            box(p + at(26, -9, 12 * d[2]), p + at(38, 9, 24 * d[2])),
        )
        case = cut(case, cyl(p - d, d, 16, 17), cyl(p - d, d, 10.5, 21))
        drawing.add(f"{name} drive", cut(case, *(cyl(q, d, 1.25, 16) for q in fixing)))
        shaft = union(cyl(p - 3 * d, d, 8, 3), cyl(p, d, 18, 6), cyl(p, d, 11.5, 8), cyl(p, d, 10, 19))
        drawing.add(f"{name} output", cut(shaft, *(cyl(q, d, 1.25, 6.5) for q in flange)))
        ball_bearing(drawing, f"{name} bearing", p + 8 * d, d, 10, 16, 8)
        drawing.joint("Revolute", f"{name} output", f"{name} drive", p, Z)
        drawing.joint("Weld", link, f"{name} output")
        weld(drawing, f"{name} plate", f"{name} drive")
        weld(drawing, f"{name} output", f"{name} bearing inner ring")
        weld(drawing, f"{name} drive", f"{name} bearing outer ring")
        screws(drawing, f"{name} drive screw", fixing, d, 1.5, 12, f"{name} drive")
        thick = 8 if name == "left" else 6
        screws(drawing, f"{name} flange screw", [q - thick * d for q in flange], d, 1.5, thick + 5, f"{name} output")
        links = cyl(p - thick * d, d, 20, thick), bore(p, Z, 8), *(bore(q, Z, 1.6) for q in flange)
        if name == "left":
            plain = union(links[0], bar(hip, knee, 13, -16, -8))
            holes = [bore(knee, Z, 2.5), *(bore(hip + t * knee, Z, 6) for t in (0.36, 0.52, 0.68))]
        else:
            plain, holes = union(links[0], bar(hip, tip, 8, 9, 15)), [bore(tip, Z, 2.1)]
        drawing.add(link, cut(plain, *links[1:], *holes))
    for number, p in enumerate(posts):
        drawing.add(f"stand-off {number}", tube(p - 20 * Z, Z, 1.7, 5, 39))
        weld(drawing, "left plate", f"stand-off {number}")
    weld(drawing, "right plate", "stand-off 0")
    shin = union(bar(tail, foot, 8, -7, 1), cyl(knee - 7 * Z, Z, 13, 8), cyl(foot - 3 * Z, down, 4, 24))
    shin = cut(shin, cyl(knee - 4 * Z, Z, 8, 9), bore(knee, Z, 6.5), bore(tail, Z, 2.1))
    drawing.add("shin", shin)
    ball_bearing(drawing, "knee bearing", knee - 4 * Z, Z, 4, 8, 5)
    drawing.add("knee spacer", tube(knee - 8 * Z, Z, 4 + play, 6, 4))
    shoulder = union(cyl(knee - 8 * Z, Z, 4, 9), cyl(knee + Z, Z, 6, 4), cyl(knee - 16 * Z, Z, 3, 8))
    drawing.add("knee shoulder bolt", cut(shoulder, hexagon(knee + 3 * Z, Z, 2, 3)))
    drawing.add("foot", cut(sphere(foot - 3 * Z + 20 * down, 12), cyl(foot - 3 * Z, down, 4, 24)))
    slot = bar(tip + 0.2 * knee, tip + 0.8 * knee, 3, 0, 10)
    drawing.add("rod", cut(bar(tip, tail, 8, 2, 8), slot, bore(tip, Z, 4), bore(tail, Z, 4)))
    for name, p, z in (("crank", tip, 8), ("shin", tail, 1)):
        plain = union(cyl(p + 2 * Z, Z, 4.01, 6), cyl(p + z * Z, Z, 6, 1))
        drawing.add(f"{name} bush", cut(plain, bore(p, Z, 2.5 + play)))
        drawing.joint("Revolute", "rod", name, p, Z)
        weld(drawing, "rod", f"{name} bush")
    screws(drawing, "crank bolt", [tip + 2 * Z], Z, 2.5, 13, "crank")
    screws(drawing, "shin bolt", [tail + 8 * Z], -Z, 2.5, 14, "shin")
    drawing.joint("Revolute", "shin", "thigh", knee, Z)
    weld(drawing, "thigh", "knee shoulder bolt")
    weld(drawing, "shin", "knee bearing outer ring", "foot")
    return drawing


def rodless(drawing: Drawing, name: str, place, half: float, shift: float, play: float, taps) -> None:
    """A rodless cylinder along x with a guided carriage above it, laid to its place."""
    profile = cut(box((-half, -25, -40), (half, 25, 0)), bore((0, 0, -22), X, 12), box((-half, -3, -22), (half, 3, 1)))
    grooves = [box((-half, y, -35), (half, np.sign(y) * 26, -31)) for y in (-22, 22)]
    holes = [bore((x, 16, 0), Z, 1.5, 10) for x in np.linspace(-0.8 * half, 0.8 * half, 5)]
    ends = [(s, [at(s * half, y, -7) for y in (-17.5, 17.5)]) for s in (-1, 1)]
    taps_in = [cyl(p - 16 * s * X, s * X, 1.7, 17) for s, points in ends for p in points]
    drawing.add(f"{name} profile", place(cut(profile, *grooves, *holes, *taps_in)))
    for s, points in ends:
        cap = union(box((s * half, -25, -40), (s * (half + 14), 25, 0)), cyl((s * half, 0, -22), -s * X, 12, 6))
        cap = cut(cap, cyl((s * half - s * 7, 0, -22), s * X, 4.2, 30), *(bore(p, X, 2.1, 30) for p in points))
        drawing.add(f"{name} cap {s}", place(cap))
        weld(drawing, f"{name} profile", f"{name} cap {s}")
        for number, p in enumerate(points):
            drawing.add(f"{name} cap screw {s} {number}", place(screw(p + 14 * s * X, -s * X, 2, 26)))
            weld(drawing, f"{name} cap {s}", f"{name} cap screw {s} {number}")
    vees = [box((-half, y, 4), (half, y + 1.2, 6)) for y in (12, 18.8)]
    drawing.add(f"{name} rail", place(cut(box((-0.9 * half, 12, 0), (0.9 * half, 20, 10)), *vees, *holes)))
    gap = play / 2
    block = cut(box((-25, 4, 2), (25, 28, 16)), box((-26, 12 - gap, 0), (26, 20 + gap, 10.5)))
    ridges = [box((-25, a, 4 + gap), (25, b, 6 - gap)) for a, b in ((11, 13 - gap), (19 + gap, 21))]
    fixings = [at(-18, 16, 22), at(18, 16, 22)]
    block = cut(union(block, *ridges), *(cyl(p - 12 * Z, Z, 1.7, 12) for p in fixings))
    plate = cut(box((-50, -45, 16), (50, 45, 26)), *(bore((a, b, 20), Z, radius, 9) for a, b, radius in taps))
    for p in (*fixings, 22 * Z):
        plate = cut(plate, bore(p, Z, 2.2, 9), cyl(p, Z, 3.4, 9))
    piston = union(cyl((-32, 0, -22), X, 12 - play, 64), box((-20, -2.8, -22), (20, 2.8, 16)))
    parts = {"block": block, "carriage": plate, "piston": cut(piston, cyl(4 * Z, Z, 1.7, 13))}
    parts |= {f"block screw {k}": screw(p, -Z, 2, 10.5) for k, p in enumerate(fixings)}
    parts["piston screw"] = screw(22 * Z, -Z, 2, 15)
    for part, shape in parts.items():
        drawing.add(f"{name} {part}", place(shape.translate((shift, 0, 0))))
        if part != "carriage":
            weld(drawing, f"{name} carriage", f"{name} {part}")
    weld(drawing, f"{name} profile", f"{name} rail")


@kind
def pick_and_place_suction(random):
    """Two rodless axes, one on the carriage of the other; a sprung plunger in a bush, a ball stud, a suction cup."""
    drawing, play = Drawing(["x profile"]), random.choice([0.0, 0.02, 0.05])
    x, z0, dz = random.uniform(-90, 90), random.uniform(-50, -20), random.uniform(-50, 30)
    up = z0 + dz
    rodless(drawing, "x", lambda s: laid(s, 0 * X, X, Y), 200.0, x, play, [(-33.5, 0, 1.7), (33.5, 0, 1.7)])
    taps = [(a, b, 2.1) for a in (-12, 12) for b in (-20, 20)]
    rodless(drawing, "z", lambda s: laid(s, (x, 66, z0), Z, Y), random.uniform(125, 150), dz, play, taps)
    for side, s in (("left", -1), ("right", 1)):
        clamp = union(
            box((x + s * 25, 26, -20), (x + s * 42, 34.8, 20)), box((x + s * 22, 31, -20), (x + s * 26, 34.8, 20))
        )
        drawing.add(f"{side} clamp", cut(clamp, bore((x + s * 33.5, 30, 0), Y, 2.2, 20)))
        weld(drawing, "x carriage", f"{side} clamp")
        screws(drawing, f"{side} clamp screw", [at(x + s * 33.5, 34.8, 0)], -Y, 2, 16, "x carriage")
    p = at(x, 148, up)
    plate = union(
        box((x - 30, 92, up - 45), (x + 30, 100, up + 25)), box((x - 25, 99, up - 45), (x + 25, 172, up - 35))
    )
    holes = [at(x + b, 100, up + a) for a, b, _ in taps]
    drawing.add("bracket", cut(plate, bore(p, Z, 9, 60), *(bore(q, Y, 2.7, 20) for q in holes)))
    screws(drawing, "bracket screw", holes[1:3], -Y, 2.5, 17, "z carriage")
    bush = union(cyl(p - 51 * Z, Z, 13, 6), cyl(p - 51 * Z, Z, 9, 23))
    drawing.add("plunger bush", cut(bush, bore(p, Z, 5 + play, 90)))
    drawing.add("bush nut", hexagon(p - 35 * Z, Z, 12, 5.5, 9))
    plunger = union(cyl(p - 98 * Z, Z, 5, 83), cyl(p - 90 * Z, Z, 9, 4))
    plunger = grooved(cut(plunger, bore(p, Z, 1.5, 120), cyl(p - 99 * Z, Z, 2.5, 10)), p - 27 * Z, Z, 5)
    drawing.add("plunger", plunger)
    drawing.add("plunger washer", tube(p - 28 * Z, Z, 5.2, 9, 1))
    drawing.add("plunger circlip", circlip(p - 27 * Z, Z, 5))
    drawing.add("spring", tube(p - 86 * Z, Z, 5.5, 7.5, 35))
    ball = p - 112 * Z
    stud = union(sphere(ball, 7), cyl(ball, Z, 3.8, 12), cyl(ball + 10 * Z, Z, 6, 4), cyl(ball, Z, 3, 21))
    drawing.add("ball stud", cut(stud, bore(ball, Z, 1, 40)))
    barb = union(cyl(ball - 24 * Z, Z, 5, 12), cyl(ball - 22 * Z, Z, 6, 3))
    holder = cut(cyl(ball - 13 * Z, Z, 11, 18), sphere(ball, 7 + play))
    drawing.add("cup holder", cut(union(holder, barb), cyl(ball - 30 * Z, Z, 1.5, 30)))
    cones = [
        Shape(obj=cq.Solid.makeCone(a, b, h, cq.Vector(*(ball - 38 * Z)))) for a, b, h in ((19, 9, 13), (17, 6.5, 11))
    ]
    cup = cut(union(cyl(ball - 25 * Z, Z, 9, 12), cones[0]), cones[1], cyl(ball - 36 * Z, Z, 3, 14), barb)
    drawing.add("suction cup", cup)
    drawing.joint("Prismatic", "x carriage", "x profile", 0 * X, X)
    drawing.joint("Prismatic", "z carriage", "z profile", p, Z)
    drawing.joint("Cylindrical", "plunger", "plunger bush", p, Z)
    drawing.joint("Spherical", "cup holder", "ball stud", ball)
    weld(drawing, "x carriage", "z profile")
    weld(drawing, "z carriage", "bracket")
    weld(drawing, "bracket", "plunger bush", "bush nut")
    weld(drawing, "plunger", "ball stud")
    weld(drawing, "cup holder", "suction cup")
    return drawing
