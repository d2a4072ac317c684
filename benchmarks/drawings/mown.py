"""Machines of house, garden, workshop and shop: a bolt of a window, a mower, a dividing head, a tape gun."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.powered import grooved
from drawings.shapes import Shape, X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, laid, screw, tube, union


def fix(drawing: Drawing, holder: str, name: str, shape: Shape) -> None:
    """Draw a part that another holds fast."""
    drawing.add(name, shape)
    drawing.joint("Weld", name, holder)


def screws(drawing: Drawing, holder: str, name: str, points, axis, radius: float, length: float) -> None:
    """Socket screws along an axis, with their heads at these points."""
    for k, p in enumerate(points):
        fix(drawing, holder, f"{name} {k}", screw(p, axis, radius, length))


def flat(one, other, half: float, low: float, high: float, holes=(), radius: float = 0.0) -> Shape:
    """A bar with round ends in the plane xz, from y = low to y = high."""
    there = bar(*((p[0], p[2]) for p in (one, other)), half, -high, -low, [(p[0], p[2]) for p in holes], radius)
    return there.rotate((0, 0, 0), (1, 0, 0), 90)


def prism(points, origin, x, z, length: float) -> Shape:
    """A polygon of a plane at a point, drawn out along z."""
    return laid(cq.Workplane().polyline(points).close().extrude(length), origin, x, z)


@kind
def cremone_bolt(random):
    """A handle on a square spindle, a pinion between two racks in a case, two round rods in guides on a door."""
    drawing, play, reach = Drawing(["door"]), random.choice([0.1, 0.2]), random.uniform(330, 400)
    spots = [at(x, y, 0) for x in (-17, 17) for y in (-65, 65)]
    guides = [at(0, s * y, 0) for s in (-1, 1) for y in (190, reach)]
    holes = [cyl(p - 18 * Z, Z, 2, 19) for p in spots]
    core = random.choice([1.6, 2.0])
    holes += [cyl(p + at(x, 0, -15), Z, core, 16) for p in guides for x in (-23, 23)]
    drawing.add("door", cut(box((-60, -reach - 20, -40), (60, reach + 20, 0)), *holes))
    case = cut(box((-26, -75, 0), (26, 75, 26)), box((-21, -55, -1), (21, 55, 20)), bore(10 * Z, Y, 6 + play))
    fix(drawing, "door", "case", cut(case, bore(0 * X, Z, 8 + play), *(bore(p, Z, 2.2) for p in spots)))
    fix(drawing, "case", "back plate", cut(box((-21, -55, 0), (21, 55, 2)), bore(0 * X, Z, 5 + play)))
    screws(drawing, "door", "case screw", [p + 26 * Z for p in spots], -Z, 2, 42)
    square = box((-3.5, -3.5, 0.5), (3.5, 3.5, 45))
    pinion = union(cyl(0 * X, Z, 5, 4), cyl(4 * Z, Z, 11, 12), cyl(16 * Z, Z, 8, 10))
    drawing.add("pinion", cut(pinion, square))
    drawing.joint("Revolute", "pinion", "case", 0 * X, Z)
    fix(drawing, "pinion", "spindle", square)
    fix(drawing, "case", "rose", cut(tube(26 * Z, Z, 8 + play, 17, 3)))
    lever = union(cyl(29 * Z, Z, 11, 21), bar((0, 0), (random.uniform(95, 120), 0), 9, 40, 50))
    fix(drawing, "spindle", "handle", cut(lever, square, cyl(35 * Z, -Y, 2, 20)))
    fix(drawing, "handle", "grub screw", cyl((0, -3.5, 35), -Y, 2, 7))
    for s, name in ((1, "upper"), (-1, "lower")):
        rack = box((-s * (21 - play), s * -18, 3), (-s * 11, s * 48, 17))
        rack = union(rack, box((-s * 11, s * 40, 3), (s * 9, s * 48, 17)))
        drawing.add(f"{name} rack", cut(rack, cyl((0, s * 39, 10), s * Y, 4, 10), cyl((0, 0, 2), Z, 11, 16)))
        drawing.joint("Prismatic", f"{name} rack", "case", (0, 0, 10), Y)
        rod = union(cyl((0, s * 40, 10), s * Y, 4, 8), cyl((0, s * 48, 10), s * Y, 6, reach - 34))
        fix(drawing, f"{name} rack", f"{name} rod", rod)
    for k, p in enumerate(guides):
        guide = union(box(p + at(-30, -9, 0), p + at(30, 9, 3)), box(p + at(-12, -9, 0), p + at(12, 9, 20)))
        guide = cut(guide, bore(10 * Z, Y, 6 + play), *(bore(p + x * X, Z, 2.1) for x in (-23, 23)))
        fix(drawing, "door", f"guide {k}", guide)
        drawing.joint("Cylindrical", "upper rod" if p[1] > 0 else "lower rod", f"guide {k}", (0, 0, 10), Y)
        screws(drawing, "door", f"guide screw {k}", [p + at(x, 0, 3) for x in (-23, 23)], -Z, 2, 17)
    return drawing


@kind
def reel_mower(random):
    """Two cast sides on a tie rod, a reel of blades in bearings, geared wheels on bolts, knife, roller, handle."""
    drawing, play, r = Drawing(["side 1"]), random.choice([0.1, 0.25]), random.uniform(56, 62)
    axle, tie, hind, grip = at(45, 0, 45), at(88, 0, -20), at(-110, 0, -55), at(-125, 0, 50)
    for s in (-1, 1):
        low, out = s * 150 * Y, s * Y
        outline = [(-150, -85), (60, -85), (115, -30), (115, 60), (70, 90), (-150, 80)]
        side = prism(outline, low if s < 0 else low + 8 * Y, X, -Y, 8)
        beds = [at(x, 0, -r - 9) for x in (-11, 11)]
        side = cut(side, bore(0 * X, Y, 14), bore(axle, Y, 8), bore(tie, Y, 4.2), bore(hind, Y, 6), bore(grip, Y, 5))
        drawing.add(f"side {s}", cut(side, *(bore(p, Y, 3.2) for p in beds)))
        screws(drawing, f"side {s}", f"bed screw {s}", [p + s * 158 * Y for p in beds], -out, 3, 24)
        screws(drawing, f"side {s}", f"tie screw {s}", [tie + s * 158 * Y], -out, 4, 28)
        fix(drawing, f"side {s}", f"bearing {s}", tube(low, out, 8, 14, 8))
        pinion = union(tube(s * 158 * Y, out, 8, 10, 2), tube(s * 160 * Y, out, 8, 14, 14))
        drawing.add(f"pinion {s}", cut(pinion, bore(s * 167 * Y, Z, 2)))
        drawing.add(f"pinion pin {s}", cyl(at(0, s * 167, -14), Z, 2, 28))
        fix(drawing, f"side {s}", f"axle bolt {s}", headed(axle + s * 194 * Y, -out, 8, 54))
        fix(drawing, f"axle bolt {s}", f"axle nut {s}", hexagon(axle + low, -out, 11, 8, 8))
        fix(drawing, f"axle bolt {s}", f"axle spacer {s}", tube(axle + s * 158 * Y, out, 8, 14, 4))
        ring = np.hypot(45, 45) + 14
        wheel = union(tube(axle + s * 166 * Y, out, ring, 120, 26), tube(axle + s * 184 * Y, out, 18, 119, 8))
        wheel = union(wheel, tube(axle + s * 162 * Y, out, 8 + play, 20, 30))
        drawing.add(f"wheel {s}", wheel)
        drawing.joint("Revolute", f"wheel {s}", f"axle bolt {s}", axle, Y)
        fix(drawing, f"axle bolt {s}", f"axle washer {s}", tube(axle + s * 192 * Y, out, 8, 15, 2))
        fix(drawing, f"side {s}", f"handle bolt {s}", headed(grip + s * 142 * Y, out, 5, 24))
        fix(drawing, f"handle bolt {s}", f"handle nut {s}", hexagon(grip + s * 158 * Y, out, 8, 7, 5))
    drawing.add("reel shaft", cut(cyl(-176 * Y, Y, 8, 352), *(bore(at(0, s * 167, 0), Z, 2) for s in (-1, 1))))
    drawing.joint("Revolute", "reel shaft", "bearing 1", 0 * X, Y)
    drawing.joint("Revolute", "reel shaft", "bearing -1", 0 * X, Y)
    for k, y in enumerate((-110, 0, 110)):
        spider = union(tube((0, y - 8, 0), Y, 8, 16, 16), tube((0, y - 2, 0), Y, 8, r - 8, 4))
        fix(drawing, "reel shaft", f"spider {k}", spider)
    for k in range(5):
        blade = box((-1.5, -136, r - 8), (1.5, 136, r)).rotate((0, 0, 0), (0, 1, 0), 72 * k + 20)
        drawing.add(f"blade {k}", blade)
        for j in range(3):
            drawing.joint("Weld", f"blade {k}", f"spider {j}")
    bar_ = box((-22, -150, -r - 15), (22, 150, -r - 3))
    cuts = [cyl(at(x, s * 151, -r - 9), -s * Y, 3, 18) for x in (-11, 11) for s in (-1, 1)]
    knots = [at(-8, y, -r - 3) for y in (-90, 90)]
    drawing.add("bed bar", cut(bar_, *cuts, *(cyl(p, -Z, 2.5, 10) for p in knots)))
    knife = cut(box((-20, -140, -r - 3), (5, 140, -r - 0.4)), *(bore(p, Z, 2.7, 9) for p in knots))
    fix(drawing, "bed bar", "knife", cut(knife, *(cyl(p + 1.2 * Z, Z, 4.2, 5) for p in knots)))
    for k, p in enumerate(knots):
        fix(drawing, "bed bar", f"knife screw {k}", union(cyl(p + 1.2 * Z, -Z, 2.5, 10), cyl(p + 1.2 * Z, Z, 4, 1.2)))
    drawing.add(
        "tie rod", cut(cyl(tie - 150 * Y, Y, 9, 300), *(cyl(tie + s * 151 * Y, -s * Y, 4, 30) for s in (-1, 1)))
    )
    for s in (-1, 1):
        for name in ("bed bar", "tie rod"):
            drawing.joint("Weld", name, f"side {s}")
        for name, other in (
            ("tie screw {} 0", "tie rod"),
            ("bed screw {} 0", "bed bar"),
            ("bed screw {} 1", "bed bar"),
        ):
            drawing.joint("Weld", name.format(s), other)
        for name in ("pinion", "pinion pin"):
            drawing.joint("Weld", f"{name} {s}", "reel shaft")
    fix(drawing, "side 1", "roller shaft", cyl(hind - 158 * Y, Y, 6, 316))
    drawing.joint("Weld", "roller shaft", "side -1")
    drawing.add("roller", tube(hind - 148 * Y, Y, 6 + play, 22, 296))
    drawing.joint("Revolute", "roller", "roller shaft", hind, Y)
    top = grip + at(-150, 0, 140)
    arms = [flat(grip, top, 12, *sorted((s * 142, s * 150)), [grip], 5 + play) for s in (-1, 1)]
    drawing.add("handle", union(*arms, cyl(top - 146 * Y, Y, 10, 292), cyl(top, at(-150, 0, 140), 12, 400)))
    drawing.joint("Revolute", "handle", "side 1", grip, Y)
    drawing.joint("Revolute", "handle", "side -1", grip, Y)
    return drawing


@kind
def dividing_head(random):
    """A body with a spindle, worm wheel and worm that tilts in a cradle under straps, index plate, crank, plunger."""
    drawing, play, worm = Drawing(["base"]), random.choice([0.02, 0.05]), at(0, 0, -46)
    bolts = {s: [at(x, s * 52, 18) for x in (-69, 69)] for s in (-1, 1)}
    base = union(box((-95, -60, -90), (95, 60, -78)), *(box((-76, s * 44, -80), (76, s * 60, 0)) for s in (-1, 1)))
    base = cut(base, bore(0 * X, Y, 62 + play), *(box((x, -8, -95), (x + 15, 8, -70)) for x in (-96, 81)))
    holes = [cyl(p - 45 * Z, Z, 4, 60) for s in bolts for p in bolts[s]]
    drawing.add("base", cut(base, *holes, box((-70, -7, -91), (70, 7, -86))))
    for x in (-55, 30):
        fix(drawing, "base", f"tenon {x}", box((x, -7, -95), (x + 25, 7, -86)))
    for s in (-1, 1):
        ring = cyl((0, s * 44, 0), s * Y, 75, 16).union(box((-76, s * 44, 0), (76, s * 60, 18)))
        ring = cut(ring, bore(0 * X, Y, 62 + play), box((-99, -99, -99), (99, 99, 0)))
        strap = cut(ring, *(bore(p, Z, 4.4, 40) for p in bolts[s]), *(cyl(p, Z, 7, 60) for p in bolts[s]))
        drawing.add(f"strap {s}", strap)
        drawing.joint("Weld", f"strap {s}", "base")
        screws(drawing, "base", f"strap bolt {s}", bolts[s], -Z, 4, 42)
    body = union(box((-45, -42, -60), (45, 42, 40)), *(cyl((0, s * 42, 0), s * Y, 62, 18) for s in (-1, 1)))
    body = union(body, cyl((0, 60, -46), Y, 22, 6).intersect(box((-30, 50, -88), (30, 70, 0))))
    body = cut(
        body, bore(0 * X, X, 20), box((-13, -39, -40), (13, 39, 41)), bore(worm, Y, 10), cyl(worm - 40 * Y, Y, 12, 80)
    )
    lids = [at(x, y, 40) for x in (-22, 22) for y in (-32, 32)]
    ties = hollow(worm + 66 * Y, Y, 16, 3)
    body = cut(body, *(cyl(p, -Z, 2, 12) for p in lids), *(cyl(p, -Y, 1.6, 5.8) for p in ties))
    drawing.add("body", body)
    drawing.joint("Revolute", "body", "base", 0 * X, Y)
    fix(drawing, "body", "cover", cut(box((-28, -39, 40), (28, 39, 44)), *(bore(p, Z, 2.2, 9) for p in lids)))
    screws(drawing, "body", "cover screw", [p + 4 * Z for p in lids], -Z, 2, 14)
    key = box((-9, -3, 12), (9, 3, 18.5))
    cone = Shape(obj=cq.Solid.makeCone(6.5, 9, 50, cq.Vector(4, 0, 0), cq.Vector(1, 0, 0)))
    spindle = union(cyl((-56, 0, 0), X, 16, 102), cyl((46, 0, 0), X, 24, 8))
    drawing.add("spindle", cut(spindle, cone, key, bore(0 * X, X, 5)))
    for s, name in ((1, "front"), (-1, "rear")):
        bush = union(tube((s * 20, 0, 0), s * X, 16 + play, 20, 25), tube((s * 45, 0, 0), s * X, 16 + play, 26, 1))
        fix(drawing, "body", f"{name} bush", bush)
        drawing.joint("Revolute", "spindle", f"{name} bush", 0 * X, X)
    fix(drawing, "spindle", "worm wheel", cut(tube((-12, 0, 0), X, 16, 36.2, 24), box((-13, -3, 0), (13, 3, 18.5))))
    fix(drawing, "spindle", "key", key)
    fix(drawing, "spindle", "spindle nut", cut(tube((-46, 0, 0), -X, 16, 24, 9), cyl((-50.5, 0, 20), Z, 2, 9)))
    nose = Shape(obj=cq.Solid.makeCone(9.5, 0.5, 18, cq.Vector(60, 0, 0), cq.Vector(1, 0, 0)))
    fix(drawing, "spindle", "centre", union(cone, cyl((54, 0, 0), X, 9, 6), nose))
    shaft = union(cyl(worm - 60 * Y, Y, 6, 160), cyl(worm - 18 * Y, Y, 9.8, 36))
    shaft = cut(shaft, box(worm + at(4.5, 76, -9), worm + at(9, 120, 9)))
    drawing.add("worm", shaft)
    for s in (-1, 1):
        fix(drawing, "body", f"worm bush {s}", tube(worm + s * 40 * Y, s * Y, 6 + play, 10, 20))
        drawing.joint("Revolute", "worm", f"worm bush {s}", worm, Y)
    spots = hollow(worm, Y, 34, 16)
    plate = cut(tube(worm + 66 * Y, Y, 6.1, 41, 4), *(bore(p, Y, 1.5, 90) for p in spots))
    plate = cut(plate, *(bore(p, Y, 1.8, 20) for p in ties), *(cyl(p + 2 * Y, Y, 3.4, 9) for p in ties))
    fix(drawing, "body", "index plate", plate)
    for k, p in enumerate(ties):
        fix(drawing, "body", f"plate screw {k}", union(cyl(p - 5.8 * Y, Y, 1.6, 8), cyl(p + 2 * Y, Y, 3.2, 2)))
    end = spots[int(random.integers(3))]
    first = np.arctan2(*(end - worm)[[2, 0]])
    for k, turn in enumerate((first + 0.3, first + 1.6)):
        low, tip = 70 + 3 * k, worm + 40 * at(np.cos(turn), 0, np.sin(turn))
        sector = cut(union(flat(worm, tip, 3, low, low + 3), cyl(worm + low * Y, Y, 12, 3)), bore(worm, Y, 6 + play))
        drawing.add(f"sector {k}", sector)
        drawing.joint("Revolute", f"sector {k}", "worm", worm, Y)
    crank = union(flat(worm, end, 8, 76, 81), cyl(end + 81 * Y, Y, 7, 13), cyl(worm + 76 * Y, Y, 11, 5))
    crank = cut(crank, cut(bore(worm, Y, 6), box((4.5, -500, -99), (9, 500, 0))), bore(end, Y, 3))
    fix(drawing, "worm", "crank", crank)
    fix(drawing, "worm", "crank nut", hexagon(worm + 81 * Y, Y, 9, 7, 6))
    drawing.add("plunger", union(cyl(end + 66.5 * Y, Y, 1.45, 8), cyl(end + 74 * Y, Y, 3 - play, 28)))
    drawing.joint("Cylindrical", "plunger", "crank", end, Y)
    fix(drawing, "plunger", "knob", cut(cyl(end + 95 * Y, Y, 9, 25), cyl(end + 90 * Y, Y, 3 - play, 12)))
    return drawing


@kind
def tape_gun(random):
    """A plate with a stud for the core of tape under a brake knob, a roller and finger on pins, a blade, a grip."""
    drawing, play, wide = Drawing(["plate"]), random.choice([0.1, 0.2]), 50.0
    front, rivet_at, fold = at(random.uniform(118, 130), 0, 25), at(78, 0, -16), at(80, 0, 47)
    finger = at(96, 0, -2)
    plate = union(flat(0 * X, front, 17, 0, 3), flat(0 * X, at(50, 0, -160), 15, 0, 3))
    plate = union(plate, box((72, 0, 30), (100, wide + 4, 33)), box((72, 0, 20), (100, 3, 60)))
    plate = union(plate, flat(at(40, 0, 0), rivet_at, 10, 0, 3))
    blades, grips = [at(86, y, 33) for y in (14, 40)], [at(29, 0, -82), at(38, 0, -115), at(47, 0, -148)]
    plate = cut(plate, bore(0 * X, Y, 5), bore(front, Y, 4), bore(rivet_at, Y, 2.5), *(bore(p, Y, 2.2) for p in grips))
    drawing.add("plate", cut(plate, bore(fold, Y, 1.5), *(bore(p, Z, 1.6, 9) for p in blades)))
    fix(drawing, "plate", "stud", headed(0 * X, Y, 5, wide + 22))
    drawing.add(
        "hub", union(tube(3 * Y, Y, 5 + play, 14, wide), tube(3 * Y, Y, 12, 38, 3), tube(6 * Y, Y, 33, 37.5, wide - 3))
    )
    drawing.joint("Revolute", "hub", "stud", 0 * X, Y)
    fix(drawing, "hub", "core", tube(6 * Y, Y, 37.5, 40, wide - 2))
    fix(drawing, "core", "tape", tube(6 * Y, Y, 40, random.uniform(48, 56), wide - 2))
    drawing.add("brake washer", tube((0, wide + 3, 0), Y, 5 + play, 15, 1.5))
    drawing.joint("Revolute", "brake washer", "stud", 0 * X, Y)
    fix(
        drawing,
        "stud",
        "brake knob",
        cut(union(hexagon((0, wide + 4.5, 0), Y, 8, 8), cyl((0, wide + 12.5, 0), Y, 16, 10)), bore(0 * X, Y, 5)),
    )
    fix(drawing, "plate", "roller pin", grooved(headed(front, Y, 4, wide + 10), front + (wide + 5.4) * Y, Y, 4))
    drawing.add("roller", tube(front + 3.5 * Y, Y, 4 + play, 13, wide))
    drawing.joint("Revolute", "roller", "roller pin", front, Y)
    drawing.add("roller washer", tube(front + (wide + 3.6) * Y, Y, 4 + play, 8, 1.6))
    drawing.joint("Revolute", "roller washer", "roller pin", front, Y)
    fix(drawing, "roller pin", "roller clip", circlip(front + (wide + 5.4) * Y, Y, 4))
    blade = [(-100, 0), (-74, 0), (-74, 1.5), (-100, 1.5)]
    blade = prism(blade, (0, 4, 33), -X, Y, wide - 2).union(box((100, 4, 33), (101.5, 2 + wide, 45)))
    fix(drawing, "plate", "blade", cut(blade, *(bore(p, Z, 1.7, 9) for p in blades)))
    screws(drawing, "plate", "blade screw", [p + 1.5 * Z for p in blades], -Z, 1.6, 6)
    fix(drawing, "plate", "guard pin", headed(fold, Y, 1.5, wide + 8))
    guard = union(
        tube(fold + 3.2 * Y, Y, 1.5 + play, 4, wide), box(fold + at(2, 3.2, 2.4), fold + at(30, wide + 3.2, 4))
    )
    drawing.add("guard", guard.cut(bore(fold, Y, 1.5 + play)))
    drawing.joint("Revolute", "guard", "guard pin", fold, Y)
    fix(drawing, "guard pin", "guard cap", cut(cyl(fold + (wide + 3.4) * Y, Y, 3.5, 6), bore(fold, Y, 1.5)))
    fix(drawing, "plate", "arm pin", headed(rivet_at, Y, 2.5, 13))
    drawing.add(
        "arm", union(flat(rivet_at, finger, 6, 3.2, 6, [rivet_at], 2.5 + play), cyl(finger + 5 * Y, Y, 3, wide - 4))
    )
    drawing.joint("Revolute", "arm", "arm pin", rivet_at, Y)
    fix(drawing, "arm pin", "arm clip", tube(rivet_at + 6.3 * Y, Y, 2.5, 5, 1.5))
    shell = flat(at(28, 0, -78), at(50, 0, -160), 18, -14, 17).cut(flat(0 * X, at(50, 0, -160), 15, 0, 3))
    for name, low, hole in (("outer", -14, 2.2), ("inner", 1.5, 1.7)):
        half = shell.intersect(box((-99, low, -299), (199, low + 15.5, 99)))
        holes = [cyl(p + (-15 if low < 0 else 1) * Y, Y, hole, 16 if low < 0 else 12) for p in grips]
        sunk = [cyl(p - 15 * Y, Y, 4, 6) for p in grips if low < 0]
        fix(drawing, "plate", f"{name} grip", cut(half, *holes, *sunk))
    screws(drawing, "inner grip", "grip screw", [p - 9 * Y for p in grips], Y, 1.9, 20)
    return drawing
