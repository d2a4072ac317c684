"""The front end of a cycle, a pair of binoculars, a hand pump."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.mown import fix, flat, screws
from drawings.powered import grooved
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
    screw,
    sphere,
    tube,
    union,
)


@kind
def headset_stem(random):
    """A head tube with cups and cartridge bearings, a fork on a through axle, spacers, a stem, a bar, brake levers."""
    drawing, play, rise = Drawing(["frame"]), random.choice([0.03, 0.1]), random.choice([5.0, 10.0])
    frame = union(
        cyl(0 * Z, Z, 20, 130), cyl((0, 0, 105), at(-1, 0, -0.1), 15, 150), cyl((0, 0, 50), at(-1, 0, -0.7), 17, 150)
    )
    drawing.add("frame", cut(frame, bore(0 * Z, Z, 17)))
    for s, name, z in ((-1, "lower", 0 * Z), (1, "upper", 130 * Z)):
        cup = union(tube(z, -s * Z, 15.5, 17, 12), tube(z, s * Z, 15.5, 23, 3), tube(z + 3 * s * Z, s * Z, 20.5, 23, 9))
        fix(drawing, "frame", f"{name} cup", cup)
        fix(drawing, f"{name} cup", f"{name} bearing", tube(z + 3 * s * Z, s * Z, 17, 20.5, 7))
    seat = 148 + 2 * rise
    fork = union(box((-22, -61, -45), (22, 61, -13)), *(cyl((0, y, -400), Z, 13, 380) for y in (-48, 48)))
    fork = cut(union(fork, cyl(-20 * Z, Z, 14.3, seat + 57)), cyl(-50 * Z, Z, 12, 500), bore(-385 * Z, Y, 6))
    drawing.add("fork", fork)
    fix(drawing, "fork", "crown race", union(tube(-13 * Z, Z, 14.3, 20, 3), tube(-10 * Z, Z, 14.3, 17, 6)))
    ring = cut(tube(134 * Z, Z, 14.3, 17, 7), box((0, -1, 130), (30, 1, 150)))
    fix(drawing, "fork", "compression ring", ring)
    drawing.joint("Revolute", "crown race", "lower bearing", 0 * Z, Z)
    drawing.joint("Revolute", "compression ring", "upper bearing", 0 * Z, Z)
    fix(
        drawing, "compression ring", "dust cover", union(tube(141 * Z, Z, 14.5, 20, 2), tube(143 * Z, Z, 14.5, 23.5, 5))
    )
    for k in range(2):
        fix(
            drawing,
            "dust cover" if k == 0 else "spacer 0",
            f"spacer {k}",
            tube((148 + k * rise) * Z, Z, 14.4, 18, rise),
        )
    m, grip = at(random.uniform(70, 95), 0, seat + 20), random.uniform(280, 330)
    stem = union(cyl(seat * Z, Z, 20, 40), cyl(seat * Z + 20 * Z, X, 15, m[0] - 5), cyl(m - 22 * Y, Y, 22, 44))
    stem = union(
        stem, box(m + at(-16, -22, -28), m + at(-0.5, 22, 28)), box((-30, -13, seat + 2), (-12, 13, seat + 38))
    )
    stem = cut(stem, box(m + at(-0.5, -30, -30), m + at(40, 30, 30)), bore(m, Y, 15.9), bore(seat * Z, Z, 14.3))
    bolts, ties = [at(-24, 13, seat + z) for z in (10, 30)], [m + at(10, y, z) for y in (-16, 16) for z in (-23, 23)]
    stem = cut(stem, box((-31, -1, seat - 1), (0, 1, seat + 41)), *(bore(p, Y, 2.5, 24) for p in bolts))
    fix(drawing, "fork", "stem", cut(stem, *(bore(p, X, 2.5, 24) for p in ties)))
    screws(drawing, "stem", "pinch bolt", bolts, -Y, 2.5, 24)
    plate = union(cyl(m - 22 * Y, Y, 22, 44), box(m + at(0, -22, -28), m + at(10, 22, 28)))
    plate = cut(
        plate, box(m + at(-40, -30, -30), m + at(0.5, 30, 30)), bore(m, Y, 15.9), *(bore(p, X, 2.7, 20) for p in ties)
    )
    fix(drawing, "stem", "face plate", cut(plate, *(cyl(p, X, 4.2, 20) for p in ties)))
    screws(drawing, "stem", "face screw", ties, -X, 2.5, 22)
    bar_ = union(cyl(m - 45 * Y, Y, 15.9, 90), cyl(m - grip * Y, Y, 11.1, 2 * grip)).cut(bore(m, Y, 9.3))
    fix(drawing, "stem", "handlebar", bar_)
    for s in (-1, 1):
        fix(drawing, "handlebar", f"grip {s}", tube(m + s * (grip - 118) * Y, s * Y, 11.1, 16, 118))
        fix(drawing, "handlebar", f"plug {s}", headed(m + s * grip * Y, -s * Y, 9.3, 18))
        p = m + at(32, s * (grip - 130), 0)
        clamp = cut(
            union(cyl(p - at(32, 9, 0), Y, 16, 18), box(p + at(-20, -9, -9), p + at(8, 9, 9))), bore(m, Y, 11.1)
        )
        clamp = cut(clamp, box(p + at(-8, -10, -4), p + at(9, 10, 4)), bore(p, Z, 2.5))
        fix(drawing, "handlebar", f"lever clamp {s}", cut(clamp, cyl(p - 32 * X, -X, 2, 30)))
        fix(drawing, f"lever clamp {s}", f"clamp screw {s}", cyl(p - 43.1 * X, -X, 2, 5))
        fix(drawing, f"lever clamp {s}", f"lever pin {s}", cyl(p - 9 * Z, Z, 2.5, 18))
        drawing.add(f"lever {s}", bar(p, p + at(-6, s * 110, 0), 7, m[2] - 3.8, m[2] + 3.8, [p], 2.5 + play))
        drawing.joint("Revolute", f"lever {s}", f"lever pin {s}", p, Z)
        end = union(tube((0, s * 22, -385), s * Y, 6, 9, 9), tube((0, s * 31, -385), s * Y, 6, 12, 4))
        fix(drawing, "axle", f"end cap {s}", end)
        fix(drawing, "hub", f"hub bearing {s}", tube((0, s * 23, -385), s * Y, 9, 15, 8))
        drawing.joint("Revolute", f"hub bearing {s}", f"end cap {s}", (0, 0, -385), Y)
    fix(drawing, "fork", "star nut", tube((seat + 10) * Z, Z, 3, 12, 6))
    fix(drawing, "stem", "top cap", cut(cyl((seat + 40) * Z, Z, 19, 5), bore(0 * Z, Z, 3.2)))
    screws(drawing, "star nut", "cap screw", [(seat + 45) * Z], -Z, 3, 36)
    fix(drawing, "fork", "axle", headed((0, -61, -385), Y, 6, 122))
    hub = union(cyl((0, -31, -385), Y, 19, 62), *(cyl((0, y, -385), Y, 28, 4) for y in (-27, 23)))
    drawing.add("hub", cut(hub, bore(-385 * Z, Y, 10), *(cyl((0, s * 23, -385), s * Y, 15, 9) for s in (-1, 1))))
    return drawing


@kind
def binoculars(random):
    """Two tubes hinged on a hollow pin, a wheel with a threaded rod, a bridge that turns, eyepieces that slide."""
    drawing, play, half = Drawing(["left body"]), random.choice([0.02, 0.06]), random.uniform(34, 37)
    pin = tube(-50 * Z, Z, 3, 5, 108)
    pin = cut(pin, tube(51.5 * Z, Z, 4, 6, 2.4), cyl(-51 * Z, Z, 3.5, 12))
    for s, name, lows in ((-1, "left", (-50, 20)), (1, "right", (-38, 32))):
        axis = s * half * X
        body = union(cyl(axis - 60 * Z, Z, 21, 120), *(bar(axis, (0, 0), 9, low, low + 12) for low in lows))
        body = cut(body, bore(axis, Z, 18), bore(0 * X, Z, 5 if s < 0 else 5 + play))
        drawing.add(f"{name} body", body)
        fix(
            drawing,
            f"{name} body",
            f"{name} cell",
            union(tube(axis - 60 * Z, Z, 15, 18, 14), tube(axis - 50 * Z, Z, 13, 18, 4)),
        )
        fix(drawing, f"{name} cell", f"{name} objective", cyl(axis - 56 * Z, Z, 15, 6))
        fix(drawing, f"{name} cell", f"{name} front ring", tube(axis - 59 * Z, Z, 13, 15, 3))
        fix(
            drawing,
            f"{name} body",
            f"{name} bush",
            union(tube(axis + 44 * Z, Z, 15 + play, 18, 16), tube(axis + 60 * Z, Z, 15 + play, 21, 2)),
        )
        arm = union(bar((0, 0), axis, 8, *((76, 82) if s < 0 else (82, 88))), cyl(axis + 76 * Z, Z, 18, 12))
        drawing.add(f"{name} arm", cut(arm, bore(axis, Z, 15), bore(0 * X, Z, 2.5 if s < 0 else 4 + play)))
        eyepiece = cut(tube(axis + 30 * Z, Z, 12, 15, 72), tube(axis + 33 * Z, Z, 14, 16, 2))
        fix(drawing, f"{name} arm", f"{name} eyepiece", union(eyepiece, tube(axis + 84 * Z, Z, 10.5, 12.5, 2)))
        drawing.joint("Cylindrical", f"{name} eyepiece", f"{name} bush", axis, Z)
        fix(drawing, f"{name} eyepiece", f"{name} eye lens", cyl(axis + 86 * Z, Z, 12, 7))
        fix(drawing, f"{name} eyepiece", f"{name} eye ring", tube(axis + 93 * Z, Z, 10, 12, 3))
        fix(
            drawing,
            f"{name} eyepiece",
            f"{name} eye cup",
            union(tube(axis + 94 * Z, Z, 15, 19, 14), tube(axis + 102 * Z, Z, 11, 15, 2)),
        )
    drawing.add("dioptre ring", tube(at(half, 0, 88.3), Z, 15 + play, 19, 5.4))
    drawing.joint("Revolute", "dioptre ring", "right eyepiece", half * X, Z)
    fix(drawing, "left body", "hinge pin", pin)
    fix(drawing, "hinge pin", "hinge screw", headed(-50 * Z, Z, 3.5, 10))
    drawing.joint("Revolute", "right body", "hinge pin", 0 * X, Z)
    wheel = union(tube(46 * Z, Z, 5 + play, 12, 12.2), tube(58.2 * Z, Z, 2.5, 12, 5))
    drawing.add("wheel", cut(wheel, cyl(52.7 * Z, X, 1, 20)))
    drawing.joint("Revolute", "wheel", "hinge pin", 0 * X, Z)
    fix(drawing, "wheel", "wheel pin", cyl((4.2, 0, 52.7), X, 1, 7.5))
    drawing.add("rod", union(cyl(-20 * Z, Z, 2.5, 112), tube(82 * Z, Z, 2, 4, 6.2)))
    drawing.joint("Cylindrical", "rod", "wheel", 0 * X, Z)
    drawing.joint("Weld", "left arm", "rod")
    drawing.joint("Revolute", "right arm", "rod", 0 * X, Z)
    fix(drawing, "rod", "bridge nut", cut(cyl(88.2 * Z, Z, 7, 6), bore(0 * X, Z, 2.5, 92)))
    return drawing


@kind
def hand_pump(random):
    """A plunger under a lever on a fulcrum link, a gland with packing, ball valves, a needle valve, a tank below."""
    drawing, play = Drawing(["tank"]), random.choice([0.05, 0.15])
    a, f, g = at(0, 0, random.uniform(120, 130)), at(-40, 0, 128), at(-40, 0, 82)
    feet = [at(x, y, 10) for x in (-44, 68) for y in (-34, 34)]
    tank = box((-70, -50, -90), (95, 50, 0)).cut(box((-66, -46, -86), (91, 46, -6)))
    fill = at(84, 0, 0)
    tank = cut(tank, *(cyl(p - 17 * Z, Z, 3, 20) for p in feet), bore(0 * X, Z, 8, 7), bore(fill, Z, 5, 7))
    drawing.add("tank", tank)
    needle, valve = at(40, 30, 20), at(40, 0, 30)
    body = union(box((-52, -42, 0), (76, 42, 10)), box((-28, -30, 0), (60, 30, 70)), box((-50, -6, 8), (-27, 6, 92)))
    body = cut(body, cyl(0 * Z, Z, 7, 12), cyl(10 * Z, Z, 10.5, 80), cyl(50 * Z, Z, 15, 30), bore(g, Y, 5, 20))
    body = cut(
        body, cyl((0, 0, 20), X, 3, 62), cyl(valve - 10 * Z, Z, 3, 15), cyl(valve, Z, 7, 50), cyl((40, 0, 50), X, 5, 30)
    )
    body = cut(
        body,
        cyl(needle, -Y, 5, 24),
        cyl(needle, -Y, 2.5, 30),
        bore(22 * Z, Y, 1.5, 40),
        *(bore(p, Z, 3.3, 20) for p in feet),
    )
    fix(drawing, "tank", "body", body)
    screws(drawing, "tank", "foot screw", feet, -Z, 3, 17)
    for k in range(2):
        fix(drawing, "body", f"packing {k}", tube((50 + 4 * k) * Z, Z, 10, 15, 4))
    fix(drawing, "body", "gland", union(tube(58 * Z, Z, 10 + play, 15, 12), hexagon(70 * Z, Z, 18, 9, 10 + play)))
    plunger = union(cyl(25 * Z, Z, 10, a[2] - 38), box(a + at(-9, -11, -19), a + at(9, 11, 9)))
    plunger = cut(plunger, box(a + at(-11, -6.2, -15.5), a + at(11, 6.2, 10)), bore(a, Y, 5))
    drawing.add("plunger", plunger)
    drawing.joint("Cylindrical", "plunger", "gland", 0 * X, Z)
    end = a + 60 * (a - f) / np.linalg.norm(a - f)
    lever = union(flat(f, end, 12, -6, 6), cyl(end - 8 * X, X, 14, 60)).cut(cyl(end + 10 * X, X, 10, 60))
    drawing.add("lever", cut(lever, *(bore(p, Y, 5 + play) for p in (a, f)), cyl(end + 40 * X, Z, 3, 20)))
    handle = cut(tube(end + 10 * X, X, 7, 10, 330), cyl(end + 40 * X, Z, 3, 20))
    fix(drawing, "lever", "handle", handle)
    fix(drawing, "handle", "grip", cut(cyl(end + 240 * X, X, 14, 106), cyl(end + 239 * X, X, 10, 101)))
    fix(drawing, "lever", "handle screw", screw(end + at(40, 0, 14), -Z, 3, 7))
    for s in (-1, 1):
        drawing.add(f"link {s}", flat(f, g, 10, *sorted((6.2 * s, 11 * s)), [f, g], 5 + play))
        for p, name in ((f, "upper"), (g, "lower")):
            drawing.joint("Revolute", f"link {s}", f"{name} pin", p, Y)
    for name, p, holder in (("upper", f, "lever"), ("lower", g, "body"), ("plunger", a, "plunger")):
        drawing.add(f"{name} pin", grooved(headed(p - 11 * Y, Y, 5, 25), p + 11.1 * Y, Y, 5))
        drawing.joint("Revolute" if holder == "lever" else "Weld", f"{name} pin", holder, p, Y)
        fix(drawing, f"{name} pin", f"{name} clip", circlip(p + 11.1 * Y, Y, 5))
    drawing.joint("Revolute", "lever", "plunger pin", a, Y)
    fix(drawing, "body", "suction seat", tube(0 * Z, Z, 3, 7, 10))
    fix(drawing, "suction seat", "suction pipe", cut(cyl(-80 * Z, Z, 5, 80), bore(0 * X, Z, 3)))
    strainer = cut(
        cyl(-84 * Z, Z, 9, 16),
        cyl(-82 * Z, Z, 7, 11),
        cyl(-80 * Z, Z, 5, 20),
        *(bore(z * Z, X, 1.5, 20) for z in (-80, -75)),
    )
    fix(drawing, "suction pipe", "strainer", strainer)
    fix(drawing, "body", "stop pin", cyl((0, -30, 22), Y, 1.5, 60))
    for name, seat in (("suction", 10 * Z), ("delivery", valve)):
        drawing.add(f"{name} ball", sphere(seat + 4 * Z, 5))
        drawing.joint("Spherical", f"{name} ball", "suction seat" if name == "suction" else "body", seat + 4 * Z)
    plug = union(
        cyl(valve + 10 * Z, Z, 3, 6),
        cyl(valve + 25 * Z, Z, 7, 15),
        cyl(valve + 10 * Z, Z, 3, 20),
        hexagon(70 * Z + at(40, 0, 0), Z, 10, 8),
    )
    fix(drawing, "body", "valve plug", plug)
    fix(drawing, "body", "channel plug", cyl((60, 0, 20), -X, 3, 9))
    fix(
        drawing,
        "body",
        "outlet",
        cut(union(cyl((50, 0, 50), X, 5, 35), hexagon((60, 0, 50), X, 9, 9)), bore((60, 0, 50), X, 2.5, 50)),
    )
    fix(drawing, "body", "needle nut", union(tube(needle - 10 * Y, Y, 2.5, 5, 10), hexagon(needle, Y, 8, 7, 2.5)))
    drawing.add("needle", cyl(needle - 28 * Y, Y, 2.45, 58))
    drawing.joint("Cylindrical", "needle", "needle nut", needle, Y)
    fix(drawing, "needle", "needle knob", tube(needle + 18 * Y, Y, 2.45, 12, 12))
    fix(drawing, "tank", "filler plug", union(cyl(fill - 6 * Z, Z, 5, 6), hexagon(fill, Z, 5.8, 6)))
    return drawing
