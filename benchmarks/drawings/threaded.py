"""What a thread moves: an adjustable wrench, a clamp of two wooden jaws, a robot's gripper, a corkscrew."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.office import compound
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
    torus,
    tube,
    union,
)  # fmt: skip


@kind
def adjustable_wrench(random):
    """A jaw on a round rail in the slot of the head, a worm in a window on its pin with a spring, riveted scales."""
    drawing, play = Drawing(["body"]), random.choice([0.05, 0.1])
    opened = random.uniform(0, 8)
    rail, worm = at(-20, -8, 0), at(-8, -18, 0)
    rivets = [at(-14 + 0.16 * (y + 100), y, 0) for y in (-160, -130, -100)]
    body = union(
        box((-40, -30, -7), (30, 0, 7)),
        box((-40, -2, -7), (-20, 30, 7)),
        bar(at(-6, -28, 0), at(-28, -190, 0), 11, -4, 4),
    )
    body = cut(
        body,
        cyl(rail, X, 5, 60),
        box((-20, -8, -2.6), (40, 1, 2.6)),
        box((-2, -24, -8), (14, -9, 8)),
        cyl(worm, X, 1.5, 50),
        cyl(worm + 35 * X, X, 2.6, 9),
        bore(at(-28, -190, 0), Z, 5),
        *(bore(p, Z, 2) for p in rivets),
    )
    drawing.add("body", body)
    start = rail + (2 + opened) * X
    jaw = union(
        cyl(start, X, 5 - play, 36), box(start + at(0, 0, -2.5), start + at(36, 8.05, 2.5)),
        box(start + at(2, 8.02, -7), start + at(20, 38, 7)),
    )  # fmt: skip
    drawing.add("jaw", jaw)
    drawing.add("worm", tube(worm + 6 * X, X, 1.5 + play, 4.8, 14).faces("<X or >X").edges().chamfer(0.3))
    drawing.add("worm pin", union(cyl(worm, X, 1.5, 36), cyl(worm + 35 * X, X, 2.4, 3)))
    drawing.add("worm spring", compound(*(torus(worm + x * X, X, 2.6, 0.45) for x in (20.5, 21.5))))
    for name, z in (("front", 4), ("back", -8)):
        scale = bar(at(-9, -80, 0), at(-27, -172, 0), 9, z, z + 4)
        drawing.add(f"{name} scale", cut(scale, *(bore(p, Z, 2.05) for p in rivets)))
        drawing.joint("Weld", f"{name} scale", "body")
    for number, p in enumerate(rivets):
        drawing.add(f"rivet {number}", rivet(p - 8 * Z, Z, 2, 16))
    drawing.joint("Prismatic", "jaw", "body", rail, X)
    drawing.joint("Revolute", "worm", "body", worm, X)
    return drawing


@kind
def hand_screw(random):
    """Two wooden jaws on barrel nuts with flanges and circlips, two spindles through them, pinned handles."""
    drawing, play = Drawing(["upper jaw"]), random.choice([0.05, 0.1, 0.3])
    half, first, second = random.uniform(18, 30), 60, random.uniform(125, 140)
    for name, s in (("upper", 1), ("lower", -1)):
        jaw = box((0, s * (half - 12), -15), (210, s * (half + 18), 15)).edges("|Z and >X").chamfer(8)
        slots = []
        for place, x in (("front", first), ("rear", second)):
            hub = at(x, s * half, 0)
            barrel = union(cyl(hub - 17.5 * Z, Z, 9, 33), cyl(hub + 15.05 * Z, Z, 11, 1.5))
            barrel = cut(barrel, tube(hub - 16.2 * Z, Z, 8, 10, 1.1), bore(hub, Y, 4))
            drawing.add(f"{name} {place} barrel", barrel)
            ring = cut(tube(hub - 16.15 * Z, Z, 8, 10.5, 1), box(hub + at(0, -1.5, -17), hub + at(12, 1.5, -14)))
            drawing.add(f"{name} {place} circlip", ring)
            slots += [bore(hub, Z, 9 + play), box(hub + at(-8, -30, -5), hub + at(8, 30, 5))]
        drawing.add(f"{name} jaw", cut(jaw, *slots))
    for place, x, s in (("front", first, -1), ("rear", second, 1)):
        end = at(x, -s * (half + 40), 0)
        pin = end + s * (2 * half + 95) * Y
        spindle = cyl(end, s * Y, 4, 2 * half + 120)
        drawing.add(f"{place} spindle", cut(spindle, bore(pin, X, 1.5, 20)))
        handle = cyl(pin - 12 * s * Y, s * Y, 14, 90).faces("<Y or >Y").edges().fillet(4)
        handle = cut(handle, cyl(pin - 13 * s * Y, s * Y, 4, 38), bore(pin, X, 1.5, 20))
        drawing.add(f"{place} handle", handle)
        drawing.add(f"{place} pin", cyl(pin - 13 * X, X, 1.5, 26))
        drawing.joint("Weld", f"{place} handle", f"{place} spindle")
        for name, side in (("upper", 1), ("lower", -1)):
            hub = at(x, side * half, 0)
            drawing.joint("Revolute", f"{name} {place} barrel", f"{name} jaw", hub, Z)
            drawing.joint("Cylindrical", f"{place} spindle", f"{name} {place} barrel", hub, Y)
    return drawing


@kind
def screw_gripper(random):
    """A motor turns a lead screw whose nut moves a carriage on two rods, which turns two fingers by links."""
    drawing, play = Drawing(["base"]), random.choice([0.05, 0.1])
    drawn = random.uniform(0, 6)
    axis, front = at(0, -14, 29), at(0, 38 + drawn, 40)
    holes = [at(s * 15.5, -14, 29 + s * 15.5) for s in (1, -1)]
    feet = [at(x, 84, 0) for x in (-20, 20)]
    rods = [at(s * 26, -20, 29) for s in (1, -1)]
    posts = {name: at(s * 50, 62, 0) for name, s in (("right", 1), ("left", -1))}
    base = union(box((-62, -20, 0), (62, 100, 6)), box((-32, -20, 5), (32, -14, 52)))
    base = cut(
        base,
        bore(axis, Y, 11.1, 8),
        *(bore(p, Y, 1.6, 8) for p in holes),
        *(bore(p, Y, 3, 8) for p in rods),
        *(bore(p, Z, 1.6, 8) for p in (*feet, *posts.values())),
    )
    drawing.add("base", base)
    motor = union(box((-21, -60, 8), (21, -20, 50)).edges("|Y").chamfer(3), cyl(axis - 6 * Y, Y, 11, 2))
    drawing.add("motor", cut(motor, cyl(axis - 40 * Y, Y, 2.52, 60), *(cyl(p - 16 * Y, Y, 1.5, 20) for p in holes)))
    drawing.add("motor shaft", cyl(axis - 38 * Y, Y, 2.5, 50))
    for number, p in enumerate(holes):
        drawing.add(f"motor screw {number}", screw(p, -Y, 1.5, 14))
    drawing.add("coupler", cut(cyl(axis + 4 * Y, Y, 8, 20), cyl(axis, Y, 2.5, 14), cyl(axis + 14 * Y, Y, 4, 14)))
    drawing.add("lead screw", cyl(axis + 14.5 * Y, Y, 4, 84.5))
    block = cut(box((-32, 80, 6), (32, 88, 40)), cyl(axis + 90 * Y, Y, 7.99, 9), cyl(axis + 99 * Y, Y, 6, 9))
    block = cut(block, *(cyl(p + 100 * Y, Y, 3, 9) for p in rods), *(cyl(p, Z, 1.5, 16) for p in feet))
    drawing.add("bearing block", cut(block, cyl(axis + 93 * Y, Y, 7.99, 6)))
    drawing.add("bearing", tube(axis + 94 * Y, Y, 4, 8, 5))
    for number, p in enumerate(feet):
        drawing.add(f"block screw {number}", screw(p, Z, 1.5, 14))
    for number, p in enumerate(rods):
        drawing.add(f"rod {number}", cyl(p, Y, 3, 108))
    low = front - 8 * Y
    seat = low + at(0, 0, -11)
    studs, pins = [seat + at(0, 0, s * 7.5) for s in (1, -1)], [front + at(s * 20, 0, 0) for s in (1, -1)]
    carriage = box(low + at(-33, 0, -22), low + 33 * X + at(0, 16, 0))
    carriage = cut(carriage, bore(seat, Y, 5.1, 30), *(bore(p, Y, 1.5, 30) for p in studs))
    carriage = cut(carriage, *(bore(at(p[0], *seat[1:]), Y, 4.5, 30) for p in rods))
    drawing.add("carriage", cut(carriage, *(cyl(p - 9 * Z, Z, 2, 10) for p in pins)))
    for number, p in enumerate(rods):
        drawing.add(f"bush {number}", tube(at(p[0], *seat[1:]), Y, 3 + play / 2, 4.51, 16))
    nut = union(tube(seat - 3.5 * Y, Y, 4, 10, 3.5), tube(seat - Y, Y, 4, 5, 16))
    drawing.add("nut", cut(nut, *(bore(p, Y, 1.7, 5) for p in studs)))
    for number, p in enumerate(studs):
        drawing.add(f"nut screw {number}", screw(p - 3.5 * Y, Y, 1.5, 12))
    for (name, post), s, pin in zip(posts.items(), (1, -1), pins, strict=True):
        eye, elbow, tip = at(s * 33, 71, 0), at(s * 21, 98, 0), at(s * 21, 150, 0)
        drawing.add(
            f"{name} post", cut(cyl(post + 6 * Z, Z, 6, 39), bore(post, Z, 1.5, 22), bore(post + 45 * Z, Z, 2.5, 20))
        )
        drawing.add(f"{name} post screw", screw(post, Z, 1.5, 14))
        finger = union(*(bar(*ends, 6, 45, 49) for ends in ((post, eye), (post, elbow), (elbow, tip))))
        drawing.add(f"{name} finger", cut(finger, bore(post, Z, 2.5 + play), bore(eye, Z, 2)))
        drawing.add(f"{name} shoulder bolt", screw(post + 49.05 * Z, -Z, 2.5, 16))
        drawing.add(f"{name} link", bar(pin, eye, 5, 40, 45, (pin, eye), 2 + play))
        drawing.add(f"{name} link screw", screw(pin + 5.05 * Z, -Z, 2, 12))
        drawing.add(f"{name} bolt", headed(eye + 39.97 * Z, Z, 2, 13))
        drawing.add(f"{name} nut", hexagon(eye + 49 * Z, Z, 3.5, 3, 2))
        drawing.joint("Weld", f"{name} post", "base")
        drawing.joint("Revolute", f"{name} link", "carriage", pin, Z)
        drawing.joint("Revolute", f"{name} link", f"{name} finger", eye, Z)
        drawing.joint("Revolute", f"{name} finger", f"{name} post", post, Z)
    drawing.joint("Weld", "motor", "base")
    drawing.joint("Revolute", "motor shaft", "motor", axis, Y)
    drawing.joint("Weld", "coupler", "motor shaft")
    drawing.joint("Weld", "lead screw", "coupler")
    drawing.joint("Weld", "bearing block", "base")
    drawing.joint("Weld", "nut", "carriage")
    drawing.joint("Cylindrical", "nut", "lead screw", axis, Y)
    drawing.joint("Prismatic", "carriage", "base", axis, Y)
    for number in range(2):
        drawing.joint("Weld", f"rod {number}", "base")
        drawing.joint("Weld", f"bush {number}", "carriage")
    return drawing


@kind
def corkscrew(random):
    """A shaft with rings as a rack through a bell, two toothed levers riveted in its fork, worm and handle pinned."""
    drawing, play = Drawing(["bell"]), random.choice([0.1, 0.2])
    raised, spread, lift = random.uniform(0.2, 0.8), 14, random.uniform(0, 8)
    bell = union(
        tube(0 * X, Z, 14, 17, 20),
        *(box((s * 12, -4, 15), (s * 17, 4, 46)) for s in (1, -1)),
        box((-17, -6, 44), (17, 6, 54)),
        cyl((0, 0, 44), Z, 9, 10),
        cut(box((-22, -8, 53), (22, 8, 74)), box((-23, -4, 54), (23, 4, 75))),
    )
    pivots = {name: at(s * spread, 0, 64) for name, s in (("right", 1), ("left", -1))}
    bell = cut(bell, cyl((0, 0, 21), Z, 5 + play, 60), *(bore(p, Y, 2, 20) for p in pivots.values()))
    drawing.add("bell", bell.cut(cyl(-Z, Z, 14, 21)))
    liner = union(tube(0 * X, Z, 12, 14.01, 8), tube(-2 * Z, Z, 12, 17, 2))
    drawing.add("liner", liner)
    foot, top = at(0, 0, 40 + lift), at(0, 0, 118 + lift)
    rings = [tube(foot + z * Z, Z, 4, 6, 1.2) for z in np.arange(16, 46, 2.5)]
    shaft = cut(cyl(foot, Z, 5, 84), *rings, cyl(foot, Z, 3, 12), bore(foot + 6 * Z, X, 1, 9), bore(top, Y, 1.5, 9))
    drawing.add("shaft", shaft)
    drawing.add("worm", cut(cyl(foot - 45 * Z, Z, 3, 57), bore(foot + 6 * Z, X, 1, 9)))
    drawing.add("worm pin", cyl(foot + at(-4.8, 0, 6), X, 1, 9.6))
    handle = box(top + at(-28, -7, -6), top + at(28, 7, 12)).edges("|Y").fillet(4)
    drawing.add("handle", cut(handle, cyl(top - 7 * Z, Z, 5, 13), bore(top, Y, 1.5, 9)))
    drawing.add("handle pin", cyl(top - 7 * Y, Y, 1.5, 14))
    for (name, pivot), s in zip(pivots.items(), (1, -1), strict=True):
        way = at(s * np.cos(raised), np.sin(raised))
        teeth = [at(np.cos(a), np.sin(a)) for a in np.linspace(0, 2 * np.pi, 16, endpoint=False)]
        wheel = cut(cyl((0, 0, -3.9), Z, 8.7, 7.8), *(cyl((*(8.7 * t), -5), Z, 0.7, 10) for t in teeth))
        lever = union(wheel, bar((0, 0), 75 * way, 5, -3.9, 3.9), bar(70 * way, 84 * way, 8, -3.9, 3.9))
        drawing.add(f"{name} lever", laid(cut(lever, bore(0 * Z, Z, 2 + play)), pivot, X, -Y))
        drawing.add(f"{name} rivet", rivet(pivot - 8 * Y, Y, 2, 16))
        drawing.joint("Revolute", f"{name} lever", "bell", pivot, Y)
    drawing.joint("Cylindrical", "shaft", "bell", 0 * X, Z)
    drawing.joint("Weld", "worm", "shaft")
    drawing.joint("Weld", "handle", "shaft")
    drawing.joint("Weld", "liner", "bell")
    return drawing
