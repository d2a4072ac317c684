"""A vane pump, a safety valve, a press for etchings, a slicer, a block with a hook, a pallet truck."""

from __future__ import annotations

import numpy as np

from drawings.drawing import kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.pedalled import Sketch
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, hexagon, laid, sphere, torus, tube, union
from drawings.vehicles import solid_bar, upright


@kind
def vane_pump(random):
    """A keyed rotor out of the middle of a bore, vanes in its slots, bushes, a seal, a cover on screws and dowels."""
    it, play, off = Sketch(["body"]), random.choice([0.02, 0.06]), random.uniform(3.0, 3.8)
    it.core, wide, phase, long = 0.85, 30.0, random.uniform(0.0, 0.3), random.uniform(34, 44)
    foot, boss = box((-25, -58, -62), (long - 4, 58, -42)), cyl((long / 2, -58, 0), Y, 15, 116)
    body = union(cyl(-30 * X, X, 50, long + 30), foot, boss)
    body = cut(body, cyl(off * Z, X, wide, 90), bore(0 * X, X, 13), cyl(-31 * X, X, 16, 10))
    body = cut(body, bore((long / 2, 0, 0), Y, 8, 60))
    it.add("body", cut(body, *(bore(at(x, y, -50), Z, 4, 30) for x in (-15, long - 14) for y in (-49, 49))))
    it.held("cover", cut(cyl(long * X, X, 50, 24), cyl(long * X, X, 13, 18)), "body")
    it.bolt("cover screw", hollow((long + 24) * X, X, 42, 6, 0), -X, 2.5, 40, "body", "cover")
    for k, p in enumerate(hollow((long - 10) * X, X, 42, 2, 0.52)):
        it.pin(f"dowel {k}", p, X, 3, 20, "body", [])
        it.drill("cover", it.parts[f"dowel {k}"])
    it.held("rear bush", tube(-20 * X, X, 10 + play, 13, 20), "body")
    it.held("front bush", tube(long * X, X, 10 + play, 13, 16), "cover")
    it.held("seal", tube(-30 * X, X, 10, 16, 8), "body")
    keys = {"rotor": box((6, -3, 7), (long - 6, 3, 12.5)), "coupling": box((-68, -3, 7), (-44, 3, 12.5))}
    it.add("shaft", cut(cyl(-70 * X, X, 10, long + 84), *keys.values()))
    ways = [at(0, np.sin(t), np.cos(t)) for t in np.arange(6) * np.pi / 3 + np.pi / 6 + phase]
    slots = [laid(box((13, -2, -1), (40, 2, 99)), 0 * X, u, X) for u in ways]
    it.held("rotor", cut(tube(0.05 * X, X, 10, wide - off - 0.1, long - 0.1), *slots, keys["rotor"]), "shaft")
    it.held("coupling", cut(tube(-72 * X, X, 10, 22, 32), keys["coupling"], cyl(-72 * X, X, 10, 2)), "shaft")
    it.grub("coupling screw", at(-56, 0, -10), -Z, 2.5, 8, "coupling")
    for name, key in keys.items():
        it.held(f"{name} key", key, "shaft")
    for k, u in enumerate(ways):
        reach = off * u[2] + np.sqrt(wide**2 - (off * u[1]) ** 2)
        vane = laid(box((reach - 12.5, play / 2 - 2, 0.1), (reach + 2, 2 - play / 2, long - 0.1)), 0 * X, u, X)
        it.add(f"vane {k}", vane.intersect(cyl(off * Z, X, wide, 90)))
        it.joint("Prismatic", f"vane {k}", "rotor", 0 * X, u)
    it.joint("Revolute", "shaft", "rear bush", 0 * X, X)
    it.joint("Revolute", "shaft", "front bush", 0 * X, X)
    return it


@kind
def safety_valve(random):
    """A nozzle, a disc in a guided holder, a spindle through spring washers, a bonnet on studs, a cap with a lever."""
    it, play, top = Sketch(["body"], "INCH"), random.choice([0.05, 0.15]), random.uniform(262, 287)
    body = [cyl(0 * Z, Z, 40, 110), cyl(98 * Z, Z, 55, 12), cyl(60 * Z, X, 27, 90), cyl(at(80, 0, 60), X, 45, 14)]
    body = cut(union(*body), cyl(20 * Z, Z, 32, 100), bore(0 * Z, Z, 20), cyl(60 * Z, X, 20, 110))
    it.add("body", cut(body, *(bore(p, X, 4, 30) for p in hollow(at(87, 0, 60), X, 36, 4, 0.785))))
    it.held("nozzle", union(tube(-16 * Z, Z, 12, 32, 16), tube(-1 * Z, Z, 12, 20, 49)), "body")
    it.bolt("plug", [at(-40, 0, 30)], X, 5, 7.5, "body")
    it.add("disc", cyl(48 * Z, Z, 18, 8))
    holder = cut(union(cyl(52 * Z, Z, 24, 12), cyl(64 * Z, Z, 16, 36)), cyl(72 * Z, Z, 7.4, 40), sphere(72 * Z, 7))
    it.held("holder", holder.cut(it.parts["disc"]), "disc")
    it.held("guide", union(tube(110 * Z, Z, 16 + play, 40, 6), tube(80 * Z, Z, 16 + play, 22, 31)), "body")
    bonnet = union(cyl(110 * Z, Z, 55, 16), cyl(126 * Z, Z, 34, top - 126))
    bonnet = cut(bonnet, cyl(100 * Z, Z, 27, top - 122), cyl(109 * Z, Z, 40, 7), bore(0 * Z, Z, 14))
    it.held("bonnet", bonnet, "body", "guide")
    for k, p in enumerate(hollow(92 * Z, Z, 47, 4, 0.3)):
        it.drill("bonnet", bore(p, Z, 4.3))
        it.pin(f"stud {k}", p, Z, 4, 48, "body", [])
        it.held(f"nut {k}", hexagon(p + 34 * Z, Z, 6.5, 6.5, 4), f"stud {k}")
    it.add("spindle", union(cyl(72 * Z, Z, 7, top - 2), sphere(72 * Z, 7), cyl(128 * Z, Z, 10, 4)))
    it.held("lower washer", union(tube(132 * Z, Z, 7, 24, 5), tube(137 * Z, Z, 7, 14, 6)), "spindle")
    screw = union(tube((top - 32) * Z, Z, 7 + play, 14, 55), hexagon((top + 20) * Z, Z, 11, 11, 7 + play))
    it.held("adjusting screw", screw, "bonnet")
    it.held("upper washer", tube((top - 42) * Z, Z, 7.3, 24, 10), "adjusting screw")
    it.held("lock nut", hexagon(top * Z, Z, 18, 9, 14), "adjusting screw")
    it.held("lifting nut", hexagon((top + 52) * Z, Z, 13, 8, 7), "spindle")
    it.held("spindle nut", hexagon((top + 60) * Z, Z, 11, 6, 7), "lifting nut", "spindle")
    pivot = at(-48, 0, top + 44)
    cap = [tube((top - 22) * Z, Z, 30, 40, 105), cyl((top + 83) * Z, Z, 40, 6)]
    cap += [box(pivot + at(-10, s * 13.5, -12), pivot + at(14, s * 20, 12)) for s in (-1, 1)]
    cap = cut(union(*cap), cyl((top - 23) * Z, Z, 34, 23), box(pivot + at(-20, -13.5, -9), pivot + at(100, 13.5, 14)))
    it.held("cap", cap, "bonnet")
    it.grub("cap screw", at(0, 34, top - 11), Y, 2, 8, "cap")
    lever = solid_bar(pivot, pivot + 165 * X, 6.5, 13, 0.1)
    it.add("lever", cut(lever, box(pivot + at(36, -7.6, -20), pivot + at(60, 7.6, 20))))
    it.pin("lever pin", pivot - 20 * Y, Y, 4, 40, "cap", ["lever"], play, True)
    it.joint("Cylindrical", "holder", "guide", 72 * Z, Z)
    it.joint("Spherical", "spindle", "holder", 72 * Z)
    it.joint("Cylindrical", "spindle", "adjusting screw", 72 * Z, Z)
    return it


@kind
def etching_press(random):
    """Two sides with a cap on screws, a fixed and a sliding roller in bushes, pressure screws, a bed, a star."""
    it, play, half = Sketch(["base"]), random.choice([0.05, 0.15]), random.uniform(110, 150)
    low, thick, big = at(0, 0, 80), random.uniform(10, 14), 35.0
    high = at(0, 0, 110 + thick + big)
    ties, reach = [at(x, 0, 245) for x in (-50, 50)], random.uniform(-60, 60)
    it.add("base", box((-110, -half - 40, -20), (110, half + 40, 0)))
    for name, p, r, m in (("lower roller", low, 30, 121), ("upper roller", high, big, 72)):
        it.add(name, union(cyl(p - (half - 5) * Y, Y, r, 2 * half - 10), cyl(p - (half + 36) * Y, Y, 15, 2 * half + m)))
    it.add("bed", box((reach - 300, -half - 8, 110), (reach + 300, half + 8, 110 + thick)))
    for k, p in enumerate(ties):
        it.held(f"tie {k}", cyl(p - (half + 20) * Y, Y, 12, 2 * half + 40), "side -1", "side 1")
    for s, y in ((-1, -Y), (1, Y)):
        edge, side, block, screw = s * (half + 20), f"side {s}", f"block {s}", f"pressure screw {s}"
        window = box((-28 - play, edge, high[2] - 24), (28 + play, edge + s * 20, 301))
        it.held(side, cut(box((-70, edge, 0), (70, edge + s * 20, 300)), bore(low, Y, 20), window), "base")
        it.bolt(f"side screw {s}", [at(x, edge + s * 10, -20) for x in (-45, 45)], Z, 4, 45, side, "base")
        for k, p in enumerate(ties):
            it.bolt(f"tie screw {k} {s}", [p + (edge + 20 * s) * Y], -y, 5, 45, f"tie {k}", side)
        it.held(f"bush {s}", tube(low + edge * Y, y, 15 + play, 20, 20), side)
        rail = box((-70, edge - 16 * s, 104), (70, edge, 120 + thick))
        it.held(f"rail {s}", cut(rail, box((-80, 0, 110), (80, edge - s * (12 - play), 110 + thick + play))), side)
        it.bolt(f"rail tie {s}", [at(x, edge + 20 * s, 115 + thick) for x in (-50, 50)], -y, 2.5, 30, f"rail {s}", side)
        foot = at(0, edge + 10 * s, high[2] + 36)
        it.add(block, box((-28, edge, high[2] - 24), (28, edge + 20 * s, foot[2])))
        it.drill(block, bore(high, Y, 15 + play), cyl(foot - 10 * Z, Z, 6.6, 20))
        it.held(f"cap {s}", cut(box((-70, edge - 2 * s, 300), (70, edge + 22 * s, 322)), bore(foot, Z, 9)), side)
        it.bolt(f"cap screw {s}", [at(x, edge + 10 * s, 322) for x in (-50, 50)], -Z, 4, 50, side, f"cap {s}")
        stem = union(cyl(foot - 10 * Z, Z, 6.5, 12), cyl(foot, Z, 9, 355 - foot[2]), cyl(at(*foot[:2], 345), Z, 14, 24))
        it.add(screw, cut(stem, tube(foot - 7 * Z, Z, 5, 8, 4)))
        it.grub(f"block screw {s}", foot + at(5.2, 0, -5), X, 1.8, 10, block)
        it.pin(f"tommy bar {s}", at(-70, foot[1], 357), X, 5, 140, screw, [])
        it.joint("Cylindrical", screw, f"cap {s}", foot, Z)
        it.joint("Revolute", screw, block, foot, Z)
        it.joint("Prismatic", block, side, high, Z)
        it.joint("Revolute", "upper roller", block, high, Y)
        it.joint("Revolute", "lower roller", f"bush {s}", low, Y)
        it.joint("Prismatic", "bed", f"rail {s}", at(0, edge, 110), X)
    hub = low + (half + 52) * Y
    it.held("hub", tube(hub, Y, 15, 30, 33), "lower roller")
    for k, u in enumerate(hollow(0 * X, Y, 1, 4, 0.785)):
        it.pin(f"spoke {k}", hub + 16 * Y + 20 * u, u, 7, 170, "hub", [])
    return it


@kind
def meat_slicer(random):
    """A blade on a flanged shaft, a guard, a gauge plate in a T slot with a spindle, a carriage on rods, a pusher."""
    it, play, slide = Sketch(["base"]), random.choice([0.05, 0.15]), random.uniform(-60, 60)
    c, big = at(20, 0, 170), random.uniform(92, 100)
    base = [box((-200, -120, 0), (200, 120, 50)), box((-60, 20, 50), (140, 100, 230))]
    base += [box((s * 176, -170, 0), (s * 200, -120, 80)) for s in (-1, 1)]
    slot = box((-145 - play, 0, 30), (-135 + play, 121, 51)).union(box((-152 - play, 0, 36), (-128 + play, 121, 44.2)))
    rods, o, screw = [at(0, -142, z) for z in (20, 60)], slide * X, at(-140, 30, 66)
    base = union(*base, box((-165, 106, 50), (-115, 120, 90))).cut(slot)
    it.add("base", cut(base, bore(c, Y, 18), cyl(screw + 60 * Y, Y, 5 + play, 40), *(bore(p, X, 8) for p in rods)))
    for x, y in ((-180, -100), (180, -100), (-180, 100), (180, 100)):
        it.held(f"foot {x} {y}", cyl((x, y, -20), Z, 14, 20), "base")
    it.add("shaft", union(cyl(c + 14 * Y, Y, 30, 4), cyl(c + 12 * Y, Y, 8, 108), cyl(c + 18 * Y, Y, 13, 2)))
    for y in (20, 86):
        it.held(f"bearing {y}", tube(c + y * Y, Y, 8, 18, 14), "base")
    it.held("blade", tube(c + 10 * Y, Y, 8, big, 4), "shaft")
    it.bolt("blade screw", hollow(c + 10 * Y, Y, 20, 3), Y, 2.5, 8, "shaft", "blade")
    it.held("guard", cut(tube(c + 5 * Y, Y, big + 3, big + 15, 15), box((-150, -5, 0), (20, 30, 300))), "base")
    spots = [c + at((big + 9) * np.cos(t), 5, (big + 9) * np.sin(t)) for t in (-0.15, 0.3)]
    it.bolt("guard screw", spots, Y, 2, 30, "base", "guard")
    gauge = [box((-195, 9, 58), (-83, 20, 240)), box((-165, 9, 50), (-115, 70, 82)), box((-145, 9, 44), (-135, 70, 50))]
    it.add("gauge", cut(union(*gauge, box((-152, 20, 36), (-128, 70, 44))), cyl(screw - 30 * Y, Y, 5, 110)))
    it.add("spindle", union(cyl(screw, Y, 5, 110), cyl(screw + 72 * Y, Y, 10, 4)))
    it.held("knob", cut(cyl(screw + 90 * Y, Y, 18, 28), cyl(screw + 90 * Y, Y, 5, 20)), "spindle")
    it.grub("knob screw", screw + at(5, 100, 0), X, 2, 9, "knob")
    it.add("carriage", cut(box(o + at(-40, -162, 4), o + at(40, -122, 76)), *(bore(p, X, 12) for p in rods)))
    for k, p in enumerate(rods):
        it.held(f"rod {k}", cyl(p - 200 * X, X, 8, 400), "base")
        for s in (-1, 1):
            it.held(f"slide bush {k} {s}", tube(p + (slide + s * 20) * X, s * X, 8 + play, 12, 20), "carriage")
        it.joint("Prismatic", "carriage", f"rod {k}", p, X)
    tray = [box(o + at(-70, -174, 130), o + at(90, 0, 136)), box(o + at(84, -174, 136), o + at(90, 0, 190))]
    tray += [box(o + at(78, y, 186), o + at(96, y + 14, 214)) for y in (-174, -14)]
    it.held("tray", union(*tray, box(o + at(-20, -174, 10), o + at(20, -162, 130))), "carriage")
    it.bolt("tray screw", [o + at(x, -174, z) for x in (-12, 12) for z in (32, 48)], Y, 3, 26, "carriage", "tray")
    p, y = o + at(87, -174, 204), random.uniform(40, 70)
    it.pin("pusher rod", p, Y, 6, 174, "tray", [])
    pusher = [cyl(p + y * Y, Y, 12, 50), cyl(p + at(-80, y + 10, -30), Y, 10, 30)]
    pusher += [box(p + at(x, y + b, z), p + at(-6, y + 46, 6)) for x, b, z in ((-120, 38, -64), (-40, 0, -6))]
    it.add("pusher", cut(union(*pusher), bore(p, Y, 6 + play)))
    it.joint("Cylindrical", "pusher", "pusher rod", p, Y)
    it.joint("Revolute", "shaft", "base", c, Y)
    it.joint("Prismatic", "gauge", "base", at(-140, 0, 40), Y)
    it.joint("Revolute", "spindle", "base", screw, Y)
    it.joint("Cylindrical", "spindle", "gauge", screw, Y)
    return it


@kind
def crane_hook_block(random):
    """Cheeks on a pin with a keeper, two sheaves on bearings, a cross head on trunnions, a hook with nut and latch."""
    it, play, drop = Sketch(["cheek -1"]), random.choice([0.1, 0.3]), random.uniform(170, 190)
    big, hinge, tip = random.uniform(80, 95), at(6, 0, -drop - 74), at(38, 0, -drop - 120)
    low, bowl, ends = at(0, 0, -drop), at(0, 0, -drop - 140), [at(x, -38, big + 12) for x in (-45, 45)]
    pin = cut(cyl(-58 * Y, Y, 20, 122), box((-30, 49.7, 14), (30, 56.3, 25)))
    for s in (-1, 1):
        cheek = union(solid_bar(0 * X, low, 36, 6, 0.1), *(solid_bar(0 * X, p, 16, 6, 0.1) for p in ends))
        cheek = cut(cheek, bore(0 * X, Y, 20), bore(low, Y, 18 + play), *(bore(p, Y, 6) for p in ends))
        it.add(f"cheek {s}", cheek.translate((0, s * 44, 0)))
    it.held("pin", union(pin, cyl(-58 * Y, Y, 26, 8)), "cheek 1", "cheek -1")
    it.held("keeper", box((-34, 50, 14), (34, 56, 30)), "cheek 1")
    it.bolt("keeper screw", [at(x, 56, 24) for x in (-25, 25)], -Y, 3, 16, "cheek 1", "keeper")
    for s in (-1, 1):
        m = at(0, s * 18, 0)
        it.add(f"sheave {s}", cut(tube(m - 14 * Y, Y, 29, big, 28), torus(m, Y, big + 4, 11)))
        it.held(f"bearing {s}", tube(m - 14 * Y, Y, 20, 29, 28), f"sheave {s}")
        it.held(f"spacer {s}", tube(m + s * 14 * Y, s * Y, 20, 26, 6), "pin")
        it.joint("Revolute", f"sheave {s}", "pin", 0 * X, Y)
    it.held("middle spacer", tube(-4 * Y, Y, 20, 26, 8), "pin")
    for k, p in enumerate(ends):
        it.held(f"stay {k}", tube(p, Y, 6.2, 11, 76), "cheek -1", "cheek 1")
        it.held(f"stay bolt {k}", union(cyl(p - 12 * Y, Y, 6, 112), hexagon(p - 12 * Y, -Y, 9.5, 7)), "cheek -1")
        it.held(f"stay nut {k}", hexagon(p + 88 * Y, Y, 9.5, 9, 6), f"stay bolt {k}")
    head = union(box(low + at(-32, -37.5, -22), low + at(32, 37.5, 22)), cyl(low - 50 * Y, Y, 18, 100))
    it.add("cross head", cut(head, bore(low, Z, 16 + play)))
    it.held("thrust bearing", tube(low + 22 * Z, Z, 17, 28, 12), "cross head")
    ring = cut(torus(bowl, Y, 45, 14), box(bowl + at(15, -20, 8), bowl + at(90, 20, 90)))
    it.add("hook", union(ring, cyl(bowl + 40 * Z, Z, 16, 160)))
    it.held("hook nut", tube(low + 34 * Z, Z, 16, 29, 24), "hook")
    it.pin("nut pin", low + at(-29, 0, 46), X, 3, 58, "hook nut", [])
    it.drill("hook", it.parts["nut pin"])
    it.add("latch", union(upright(hinge, tip, 6, 16.3, 19, 0.1), box(tip - at(4, 17, 4), tip + at(4, 17, 4))))
    it.pin("latch pin", hinge - 19.5 * Y, Y, 3, 39, "hook", ["latch"], play)
    it.joint("Revolute", "cross head", "cheek -1", low, Y)
    it.joint("Revolute", "cross head", "cheek 1", low, Y)
    it.joint("Revolute", "hook", "cross head", low, Z)
    return it


@kind
def pallet_truck(random):
    """Forks with a rocker on a cross shaft, push rods to wheel frames, a pump steered in a saddle, a ram, a tiller."""
    it, play, long = Sketch(["forks"]), random.choice([0.1, 0.4]), random.uniform(700, 950)
    hub, saddle, rocker, foot = at(-110, 0, 90), at(-30, 0, 100), at(80, 0, 80), at(75, 0, 35)
    wheel, crank, axle = at(long, 0, 80), at(long - 5, 0, 35), at(long + 50, 0, 40)
    forks = [box((10, -240, 110), (70, 240, 140)), box((10, -120, 140), (30, 120, 400))]
    forks.append(box((-160, -60, 376), (30, 60, 400)))
    for s in (-1, 1):
        forks += [box((10, s * 232, 40), (long + 20, s * 240, 118)), box((130, s * 90, 60), (long + 20, s * 98, 118))]
        forks.append(box((10, s * 90, 110), (long + 120, s * 240, 118)))
    it.add("forks", cut(union(*forks), sphere(hub + 290 * Z, 14)))
    arms = [upright(rocker, saddle, 11, 15.5, 27, 5), cyl(rocker - 231 * Y, Y, 18, 462)]
    arms += [laid(upright(rocker, foot, 11, 8.5, 20, 5), y * Y, X, Z) for y in (-165, 165)]
    it.add("rocker", union(*arms))
    it.pin("cross shaft", rocker - 240 * Y, Y, 12, 480, "forks", ["rocker"], play)
    up = hub + 20 * Z
    pump = union(box(hub - at(30, 66, 20), hub + at(30, 66, 25)), cyl(up, Z, 45, 190), cyl(up + 8 * Z, Z, 56, 10))
    ears = [box(up + at(-80, s * 20.3, 90), up + at(-30, s * 32, 125)) for s in (-1, 1)]
    it.add("pump", cut(union(pump, *ears), cyl(up + 60 * Z, Z, 16, 200), tube(up + 48 * Z, Z, 42, 50, 3)))
    ring = [tube(up + 18.2 * Z, Z, 45 + play, 62, 29), box((-60, -15.3, 90), (-19, 15.3, 157))]
    it.add("saddle", cut(union(*ring), cyl(up, Z, 45 + play, 100), cyl(up, Z, 58, 18.2)))
    it.held("saddle clip", cut(tube(up + 48 * Z, Z, 42, 55, 3), box((-60, -8, 150), (0, 8, 170))), "pump")
    it.pin("saddle pin", saddle - 27 * Y, Y, 5, 54, "saddle", ["rocker"], play, True)
    it.add("ram", union(cyl(up + 70 * Z, Z, 16 - play / 10, 192), sphere(hub + 290 * Z, 14)))
    it.joint("Revolute", "pump", "saddle", up, Z)
    it.joint("Cylindrical", "ram", "pump", up, Z)
    it.joint("Spherical", "ram", "forks", hub + 290 * Z)
    it.pin("axle", hub - 122 * Y, Y, 10, 244, "pump", [])
    for s, name in ((-1, "right"), (1, "left")):
        y, c = s * Y, at(0, s * 165, 0)
        it.add(f"{name} wheel", tube(hub + 66 * y, y, 21, 90, 50))
        it.held(f"{name} bearing", tube(hub + 66 * y, y, 10, 21, 50), f"{name} wheel")
        it.drill("axle", tube(hub + 116 * y, y, 9, 12, 1.5))
        it.held(f"{name} clip", circlip(hub + 116 * y, y, 10, 1.5), "axle")
        it.joint("Revolute", f"{name} wheel", "axle", hub, Y)
        rod = union(solid_bar(foot, crank, 10, 8, 0.1), cyl(crank - 36.5 * Y, Y, 10, 73))
        it.add(f"{name} push rod", rod.translate(tuple(c)))
        frame = [upright(a, b, 13, 37, 45, 0.1) for a, b in ((wheel, crank), (crank, axle))]
        it.add(f"{name} frame", union(*frame, cyl(wheel - 66 * Y, Y, 12, 132)).translate(tuple(c)))
        it.pin(f"{name} foot pin", foot + c - 20 * Y, Y, 5, 40, "rocker", [f"{name} push rod"], play)
        it.pin(f"{name} crank pin", crank + c - 45 * Y, Y, 5, 90, f"{name} frame", [f"{name} push rod"], play)
        it.pin(f"{name} hinge", wheel + at(0, s * 90, 0), y, 8, 150, "forks", [f"{name} frame"], play)
        it.add(f"{name} roller", cyl(axle + c - 36 * Y, Y, 40, 72))
        it.pin(f"{name} roller pin", axle + c - 45 * Y, Y, 8, 90, f"{name} frame", [f"{name} roller"], play, True)
    pivot = up + at(-66, 0, 108)
    it.add("tiller", union(cyl(pivot - 20 * Y, Y, 14, 40), cyl(pivot, at(-0.25, 0, 1), 11, 700)))
    it.pin("tiller pin", pivot - 32 * Y, Y, 6, 64, "pump", ["tiller"], play, True)
    it.held("handle", cut(cyl(pivot + at(-167, -90, 669), Y, 14, 180), it.parts["tiller"]), "tiller")
    return it
