"""The stage of a microscope and the tailstock of a lathe: slides that screws move, and what locks them."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.pivoted import cone, welds
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, screw, sphere, tube, union


def prism(points, low: float, high: float):
    """A polygon of the plane xy between two heights."""
    flat = [tuple(map(float, p)) for p in points]
    return cq.Workplane().polyline(flat).close().extrude(float(high - low)).translate((0, 0, float(low)))


@kind
def tilting_microscope_stage(random):
    """A pillar with a dovetail, a carriage with a gib on a focusing screw, a fork, a stage on a bolt with a knob."""
    drawing, play, tap = Drawing(["base"]), random.choice([0.0, 0.01, 0.03]), random.choice([2.5, 3.0])
    high, axis, pivot, tilt = random.uniform(-15, 15), at(0, -22, 0), at(0, -70, 99), random.uniform(3, 14)
    base = cut(box((-60, -140, 0), (60, 50, 12)), box((-32, -141, -1), (32, -60, 13)))
    feet, heads = [at(x, 15, 0) for x in (-14, 14)], [at(x, 15, 200) for x in (-14, 14)]
    drawing.add("base", cut(base, *(bore(p, Z, 3.2, 30) for p in feet), *(cyl(p, Z, 5.3, 6) for p in feet)))
    tail = prism([(-11.4, 1), (-18, -10), (18, -10), (11.4, 1)], 30, 186)
    holes = [cyl(p, Z, tap, 28) for p in feet] + [cyl(p, -Z, 2, 25) for p in heads]
    drawing.add("pillar", cut(union(box((-25, 0, 12), (25, 30, 190)), tail), *holes))
    top = cut(box((-22, -36, 190), (22, 30, 200)), bore(axis, Z, 5), *(bore(p, Z, 2.2, 30) for p in heads))
    drawing.add("top bracket", top)
    for k in (0, 1):
        drawing.add(f"foot screw {k}", screw(feet[k] + 6 * Z, Z, 3, 20))
        drawing.add(f"top screw {k}", screw(heads[k], -Z, 2, 22))
        welds(drawing, f"foot screw {k} > pillar", f"top screw {k} > pillar")
    drawing.add("top bush", tube(axis + 190 * Z, Z, 3 + play, 5, 10))
    focus = union(cyl(axis + 45 * Z, Z, 3, 176), cyl(axis + 186.4 * Z, Z, 6, 3))
    drawing.add("focusing screw", focus)
    drawing.add("lower washer", tube(axis + 189.4 * Z, Z, 3.1, 6.5, 0.5))
    drawing.add("upper washer", tube(axis + 200 * Z, Z, 3.1, 6.5, 1))
    knob = cut(cyl(axis + 201 * Z, Z, 16, 22), cyl(axis + 200 * Z, Z, 3, 21), cyl(axis + 207 * Z, X, 1.5, 20))
    drawing.add("focusing knob", knob)
    drawing.add("knob set screw", cyl(axis + 207 * Z + 3 * X, X, 1.5, 6))
    shift = (0, 0, float(high))
    ways = prism([(-11.4 - play, 1), (-18.18 - play, -10.3), (21.18, -10.3), (14.4, 1)], 60, 140)
    slide = cut(box((-32, -34, 70), (32, -0.4, 130)), ways, bore(axis, Z, 4), cyl(axis + 110 * Z, Z, 5, 25))
    ties, gibs = [at(x, -22, 133) for x in (-7.2, 7.2)], [at(19, -5, z) for z in (84, 116)]
    bolts = [at(x, -40, z) for x in (-24, 24) for z in (80, 118)]
    slide = cut(slide, *(cyl(p, -Z, 1, 12) for p in ties), *(cyl(p - 5 * X, X, 1.5, 20) for p in gibs))
    parts = {"carriage": cut(slide, *(cyl(p, Y, 1.65, 17) for p in bolts))}
    parts["gib"] = prism([(12.06 + play, -0.1), (17.94 + play, -9.9), (20.94, -9.9), (15.06, -0.1)], 70, 130)
    nut = cut(union(cyl(axis + 110 * Z, Z, 5, 20), cyl(axis + 130 * Z, Z, 10, 3)), bore(axis, Z, 3))
    parts["focusing nut"] = cut(nut, *(bore(p, Z, 1.4, 9) for p in ties))
    arms = [box((s * 26, -80, 92), (s * 34, -39, 105)) for s in (-1, 1)]
    fork = union(box((-34, -40, 72), (34, -34, 126)), *arms)
    parts["fork"] = cut(fork, bore(pivot, X, 4), *(bore(p, Y, 2.2, 9) for p in bolts))
    for k in (0, 1):
        parts[f"nut screw {k}"] = screw(ties[k], -Z, 1.25, 9)
        parts[f"gib screw {k}"] = cyl(gibs[k], X, 1.5, 20)
        parts[f"gib lock nut {k}"] = hexagon(at(32, *gibs[k][1:]), X, 2.75, 2.4, 1.5)
        welds(drawing, f"nut screw {k} > carriage", f"gib screw {k} > carriage", f"gib lock nut {k} > gib screw {k}")
    for k, p in enumerate(bolts):
        parts[f"fork screw {k}"] = screw(p, Y, 2, 18)
        welds(drawing, f"fork screw {k} > carriage")
    spots = [at(x, -60, 118) for x in (-45, 45)]
    lugs = [box((s * 18, -78, 91), (s * 25.5, -62, 113)) for s in (-1, 1)]
    stage = cut(union(box((-60, -125, 112), (60, -48, 118)), *lugs), bore(pivot, X, 6), bore((0, -92, 112), Z, 12, 9))
    own = {"stage": cut(stage, *(bore(p, Z, 1.5, 9) for p in spots))}
    for k, (s, p) in enumerate(zip((-1, 1), spots, strict=True)):
        own[f"clip {k}"] = bar(p, p + at(-s * 22, -34, 0), 4, 118, 119, (p,), 1.6)
        own[f"clip screw {k}"] = screw(p + Z, -Z, 1.5, 7)
        own[f"stage bush {k}"] = tube(pivot + s * 18 * X, s * X, 4 + play, 6, 7.5)
        parts[f"friction washer {k}"] = tube(pivot + s * 25.5 * X, s * X, 4.1, 8, 0.5)
        welds(drawing, f"clip {k} > stage", f"clip screw {k} > stage", f"stage bush {k} > stage")
    turn = (tuple(pivot.tolist()), tuple((pivot + X).tolist()), float(tilt))
    parts |= {name: shape.rotate(*turn) for name, shape in own.items()}
    parts["tilt bolt"] = union(cyl(pivot - 34 * X, X, 4, 84), hexagon(pivot - 39 * X, X, 6.5, 5))
    parts["tilt washer"] = tube(pivot + 34 * X, X, 4.2, 9, 1.5)
    grips = [cyl(p, X, 4, 30) for p in hollow(pivot + 30 * X, X, 14.5, 6)]
    parts["tilt knob"] = cut(cyl(pivot + 35.5 * X, X, 12, 18), cyl(pivot + 35 * X, X, 4, 15.5), *grips)
    for name, shape in parts.items():
        drawing.add(name, shape.translate(shift))
    welds(drawing, "pillar > base", "top bracket > pillar", "top bush > top bracket", "focusing knob > focusing screw")
    welds(drawing, "knob set screw > focusing knob", "gib > carriage", "focusing nut > carriage", "fork > carriage")
    drawing.joint("Prismatic", "carriage", "pillar", axis, Z)
    drawing.joint("Revolute", "focusing screw", "top bracket", axis, Z)
    drawing.joint("Cylindrical", "focusing screw", "focusing nut", axis, Z)
    drawing.joint("Revolute", "stage", "fork", pivot + high * Z, X)
    return drawing


@kind
def mini_lathe_tailstock(random):
    """A base on a V and a flat, a quill with screw and wheel, split cotters with a lever, a cam with a pull bolt."""
    drawing, play, out = Drawing(["bed"]), random.choice([0.01, 0.03, 0.08]), random.uniform(-15, 5)
    e, lift, tap = random.uniform(0.3, 2.6), random.choice([0.0, 1.0]), random.choice([2.5, 3.0])
    cam, lock, key = at(0, 0, -46), at(-35, -16, 0), at(10, 0, 0)
    ecc = cam + 1.9 * at(np.cos(e), 0, np.sin(e))
    low, feet, caps = at(ecc[0], 0, -101), [at(x, 0, -50) for x in (-43, 43)], hollow((58, 0, 0), X, 17, 3)
    ridge = laid(prism([(-42, -76), (-35, -69), (-28, -76)], 0, 320), (-170, 0, 0), Y, X)
    bed = [box((-170, s * 22, -100), (150, s * 50, -75)) for s in (-1, 1)]
    drawing.add("bed", union(*bed, ridge, *(box((x, -50, -100), (x + 20, 50, -80)) for x in (-170, 130))))
    base = union(box((-50, -50, -74.5), (50, 50, -60)), box((-50, 22, -75), (50, 50, -70)))
    drawing.add("base", cut(base, ridge, bore(cam, Z, 8), *(cyl(p, -Z, tap, 22) for p in feet)))
    body = [cyl((-60, 0, 0), X, 22, 102), box((-35, -16, -55), (35, 16, -10)), box((-35, -25, -60), (35, 25, -33))]
    body += [box((-50, -25, -60), (50, 25, -50)), box((-45, -27, -18), (-25, -8, 22)), cyl(key + 12 * Y, Y, 8, 12)]
    holes = [bore(0 * X, X, 12 + play), cyl(lock - 16 * Z, Z, 7, 40), cyl(key, Y, 4, 30)]
    holes += [bore(p, Z, 3.3, 20) for p in feet]
    holes += [cyl(cam - 30 * Y, Y, 9 + play, 22), cyl(cam, Y, 5 + play, 30), box((-14, -8.5, -62), (14, 8.5, -32))]
    drawing.add("body", cut(union(*body), *holes, *(cyl(p - 30 * X, X, 2, 20) for p in caps)))
    for k, p in enumerate(feet):
        drawing.add(f"foot screw {k}", screw(p, -Z, 3, 20))
        welds(drawing, f"foot screw {k} > base")
    bores = [cone((-75, 0, 0), X, 7, 6, 45), cyl((-31, 0, 0), X, 5.5, 70), cyl((17, 0, 0), X, 8, 20)]
    quill = cut(cyl((-75, 0, 0), X, 12, 110), *bores, box((-50, 9.4, -2.5), (30, 13, 2.5)))
    centre = union(cone((-75, 0, 0), X, 7, 6.05, 42.75), cyl((-79, 0, 0), X, 8, 4), cone((-79, 0, 0), -X, 8, 0, 14))
    moved = {"quill": quill, "dead centre": centre, "quill nut": tube((17, 0, 0), X, 5, 8.01, 18)}
    for name, shape in moved.items():
        drawing.add(name, shape.translate((float(out), 0, 0)))
    dog = union(cyl(key + 9.7 * Y, Y, 2.5 - play / 2, 3), cyl(key + 12.3 * Y, Y, 4, 20))
    drawing.add("key screw", dog)
    drawing.add("key nut", hexagon(key + 24 * Y, Y, 6.5, 5, 4))
    spindle = union(cyl((-22, 0, 0), X, 5, 100), cyl((43, 0, 0), X, 9, 3), cyl((78, 0, 0), X, 4, 11))
    slot = box((67, -1.5, 3), (77, 1.5, 6.5))
    drawing.add("feed screw", cut(spindle, slot))
    drawing.add("wheel key", slot)
    cover = cut(cyl((42, 0, 0), X, 22, 16), cyl((41, 0, 0), X, 10, 6), bore(0 * X, X, 5 + play))
    drawing.add("rear cap", cut(cover, *(bore(p, X, 2.2, 30) for p in caps)))
    for k, p in enumerate(caps):
        drawing.add(f"cap screw {k}", screw(p, -X, 2, 25))
        welds(drawing, f"cap screw {k} > body")
    drawing.add("thrust washer", tube((46, 0, 0), X, 5.1, 9.5, 0.95))
    drawing.add("dial", cut(tube((58.2, 0, 0), X, 5, 13, 7.7), cyl((62, 0, 0), -Z, 1.5, 20)))
    drawing.add("dial screw", cyl((62, 0, -5), -Z, 1.5, 6))
    grip = at(78, 44 * np.cos(out), 44 * np.sin(out))
    wheel = union(cyl((66, 0, 0), X, 14, 12), cyl((70, 0, 0), X, 40, 5), tube((68, 0, 0), X, 37, 52, 10))
    drawing.add("handwheel", cut(wheel, bore(0 * X, X, 5), slot, bore(grip, X, 3)))
    drawing.add("wheel washer", tube((78, 0, 0), X, 4.2, 9, 1.5))
    drawing.add("wheel nut", hexagon((79.5, 0, 0), X, 6.5, 6.5, 4))
    drawing.add("grip bolt", union(cyl(grip - 10 * X, X, 3, 10), cyl(grip, X, 4, 40), cyl(grip + 40 * X, X, 6, 3)))
    drawing.add("grip", tube(grip + 0.3 * X, X, 4.1, 8, 39.4))
    for name, z, h, r in (("lower", -16, 14, 3.0), ("upper", 2, 16, 3.2)):
        drawing.add(f"{name} cotter", cut(cyl(lock + z * Z, Z, 6.95, h), bore(0 * X, X, 12), bore(lock, Z, r)))
    drawing.add("lock stud", cyl(lock - 14 * Z, Z, 3, 48))
    drawing.add("lock washer", tube(lock + 22 * Z, Z, 3.2, 8.5, 1.5))
    ways = {"lock": at(-0.5, -0.85, 0.15) / np.linalg.norm((0.5, 0.85, 0.15)), "cam": at(0.5, 0, 0.75**0.5)}
    roots, lengths = {"lock": lock + 29 * Z, "cam": cam - 35 * Y}, {"lock": 50, "cam": 90}
    hubs = {"lock": cyl(lock + 23.5 * Z, Z, 8, 11), "cam": cyl(cam - 43 * Y, Y, 11, 15.9)}
    holes = {"lock": bore(lock, Z, 3), "cam": union(bore(cam, Y, 6), cyl(roots["cam"], -ways["cam"], 2, 20))}
    for name, way in ways.items():
        handle, tip = cyl(roots[name] + 7 * way, way, 4, lengths[name] - 7), roots[name] + (lengths[name] - 2) * way
        drawing.add(f"{name} lever", cut(union(hubs[name], handle), holes[name]))
        drawing.add(f"{name} knob", cut(sphere(tip, 9), cyl(tip - 12 * way, way, 4, 14)))
        welds(drawing, f"{name} knob > {name} lever")
    drawing.add("cam lever screw", cyl(roots["cam"] - 6 * ways["cam"], -ways["cam"], 2, 5))
    shaft = [cyl(cam - 44 * Y, Y, 6, 30), cyl(cam - 27 * Y, Y, 9, 19), cyl(ecc - 8 * Y, Y, 7, 16)]
    drawing.add("cam shaft", cut(union(*shaft, cyl(cam + 8 * Y, Y, 5, 20)), tube(cam + 25.2 * Y, Y, 4.5, 6, 1.1)))
    drawing.add("cam circlip", circlip(cam + 25.2 * Y, Y, 5, 1.1))
    pull = union(cyl(ecc - 7 * Y, Y, 11, 14), cyl(ecc - 9 * Z, -Z, 5, ecc[2] + 112))
    drawing.add("pull bolt", cut(pull, bore(ecc, Y, 7 + play)))
    low = low - lift * Z
    drawing.add("clamp plate", cut(box(low + at(-18, -38, -8), low + at(18, 38, 1)), bore(low, Z, 5.2)))
    drawing.add("clamp spring", tube(low + Z, Z, 6.2, 8.5, 25.5 + lift))
    drawing.add("clamp washer", tube(low - 8 * Z, -Z, 5.2, 10, 1.6))
    drawing.add("clamp nut", hexagon(low - 9.6 * Z, -Z, 8, 8, 5))
    welds(drawing, "body > base", "quill nut > quill", "dead centre > quill", "key screw > body", "key nut > key screw")
    welds(drawing, "rear cap > body", "dial > feed screw", "dial screw > dial", "handwheel > feed screw")
    welds(drawing, "wheel key > feed screw", "wheel nut > feed screw", "grip bolt > handwheel", "cam lever > cam shaft")
    welds(drawing, "lock stud > lower cotter", "lower cotter > body", "cam lever screw > cam lever")
    welds(drawing, "clamp plate > pull bolt", "clamp nut > pull bolt")
    drawing.joint("Prismatic", "base", "bed", 0 * X, X)
    drawing.joint("Prismatic", "quill", "body", 0 * X, X)
    drawing.joint("Revolute", "feed screw", "rear cap", 0 * X, X)
    drawing.joint("Cylindrical", "feed screw", "quill nut", 0 * X, X)
    drawing.joint("Revolute", "grip", "grip bolt", grip, X)
    drawing.joint("Revolute", "lock lever", "lock stud", lock, Z)
    drawing.joint("Revolute", "cam shaft", "body", cam, Y)
    drawing.joint("Revolute", "pull bolt", "cam shaft", ecc, Y)
    return drawing
