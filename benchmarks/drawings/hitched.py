"""From tractor, boat, lathe, factory and school: a hitch, a rudder, a steady rest, a cylinder, an engine, a hexapod."""

from __future__ import annotations

from functools import partial

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import hollow
from drawings.rolled import fast, turns
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
    tube,
    union,
)
from drawings.vehicles import solid_bar, upright


def bored_ball(middle):
    """A ball with two flats, bored along y."""
    ball = laid(sphere(0 * X, 16), middle, X, Y).intersect(cyl(middle - 11.8 * Y, Y, 32, 23.6))
    return cut(ball, bore(middle, Y, 8))


@kind
def three_point_hitch(random):
    """A rock shaft with lift arms, lower links and a top link with balls in eyes, lift rods, a headstock; pins."""
    d, play, reach = Drawing(["housing"]), random.choice([0.1, 0.3]), random.uniform(310, 350)
    rock, fore, rear = at(-70, 0, 200), at(0, 0, 0), at(reach, 0, random.uniform(-30, 0))
    lift, mid, t1, t2 = at(110, 0, 225), 0.45 * fore + 0.55 * rear, at(12, 0, 150), at(reach + 10, 0, 150)
    way, long = (lift - mid) / np.linalg.norm(lift - mid), np.linalg.norm(lift - mid)
    housing = [box((-160, -80, -60), (-30, 80, 240)), *(box((-40, s * 92, -25), (20, s * 108, 25)) for s in (-1, 1))]
    housing += [box((-40, s * 70, -25), (-28, s * 108, 25)) for s in (-1, 1)]
    housing += [box((-40, s * 12, 130), (30, s * 20, 170)) for s in (-1, 1)]
    d.add("housing", cut(union(*housing), bore(rock, Y, 15 + play / 2), bore(t1, Y, 8), bore(fore, Y, 8)))
    frame = [box((reach + 25, -108, -55), (reach + 50, 108, -20))]
    frame += [box((reach - 20, s * 92, -60), (reach + 50, s * 108, 25)) for s in (-1, 1)]
    frame += [box((reach - 8, s * 12, -40), (reach + 40, s * 20, 170)) for s in (-1, 1)]
    d.add("headstock", cut(union(*frame), bore(t2, Y, 8), bore(rear, Y, 8)))
    d.add("rock shaft", cut(cyl(rock - 128 * Y, Y, 15, 256), bore(rock, Y, 5)))
    d.joint("Revolute", "rock shaft", "housing", rock, Y)
    for s, side in ((-1, "left"), (1, "right")):
        off, out = 120 * s * Y, s * Y
        eyes = [laid(sphere(0 * X, 16), p, X, Y) for p in (fore, rear, lift)]
        link = cut(solid_bar(fore, rear, 24, 8, 6), bore(mid, Y, 8 + play), *eyes[:2])
        d.add(f"{side} link", link.translate(tuple(off.tolist())))
        arm = cut(solid_bar(rock, lift, 24, 8, 6), bore(rock, Y, 15), eyes[2]).translate(tuple(off.tolist()))
        fast(d, "rock shaft", **{f"{side}_arm": arm, f"{side}_washer": tube(rock + 128 * out, out, 5, 22, 4)})
        fast(d, "rock shaft", **{f"{side}_end_screw": screw(rock + 132 * out, -out, 5, 25)})
        for end, p, by in (("front", fore, "housing"), ("rear", rear, "headstock")):
            fast(d, by, **{f"{side}_{end}_pin": cut(headed(p + 92 * out, out, 8, 52), bore(p + 138 * out, X, 2, 30))})
            fast(d, f"{side} {end} pin", **{f"{side}_{end}_linch_pin": cyl(p + 138 * out - 13 * X, X, 2, 26)})
            fast(d, f"{side} {end} pin", **{f"{side}_{end}_ball": bored_ball(p + off)})
            d.joint("Spherical", f"{side} link", f"{side} {end} ball", p + off)
        upper = union(upright(lift, lift - 46 * way, 16, 12, 18, 8), cyl(lift - 32 * way, -way, 19.5, 50))
        upper = cut(upper, cyl(lift - 45 * way, -way, 7, 60)).translate(tuple(off.tolist()))
        lower = union(upright(mid, mid + 46 * way, 16, 8.5, 15, 8), cyl(mid + 34 * way, way, 16.5, 26))
        d.add(f"{side} lift rod", union(lower, cyl(mid + 50 * way, way, 7, long - 100)).translate(tuple(off.tolist())))
        nut, pin = hexagon(lift + off - 82 * way, -way, 11, 8, 7), headed(mid + off - 15 * out, out, 8, 34)
        fast(d, f"{side} lift rod", **{f"{side}_lift_fork": upper, f"{side}_lock_nut": nut, f"{side}_low_pin": pin})
        fast(d, f"{side} lift fork", **{f"{side}_high_pin": headed(lift + off - 18 * out, out, 8, 40)})
        fast(d, f"{side} high pin", **{f"{side}_high_ball": bored_ball(lift + off)})
        d.joint("Spherical", f"{side} arm", f"{side} high ball", lift + off)
        d.joint("Revolute", f"{side} lift rod", f"{side} link", mid + off, Y)
    d.add("turnbuckle", union(tube(t1 + 75 * X, X, 8, 14, reach - 152), cyl(t1 + at(reach / 2, 8.5, 0), Y, 5, 60)))
    for k, (p, w, by) in enumerate(((t1, X, "housing"), (t2, -X, "headstock"))):
        eye = union(cyl(p - 8 * Y, Y, 24, 16), cyl(p + 18 * w, w, 8, reach * 0.32))
        fast(d, "turnbuckle", **{f"top_end_{k}": cut(eye, laid(sphere(0 * X, 16), p, X, Y))})
        fast(d, by, **{f"top_pin_{k}": headed(p - 20 * Y, Y, 8, 46)})
        fast(d, f"top pin {k}", **{f"top_ball_{k}": bored_ball(p)})
        d.joint("Spherical", f"top end {k}", f"top ball {k}", p)
    return d


@kind
def dinghy_rudder(random):
    """Gudgeons bolted to a transom, pintles bolted to a stock of cheeks and a core, a blade, a tiller, an extension."""
    d, play, deep = Drawing(["transom"]), random.choice([0.1, 0.25]), random.uniform(330, 420)
    pivot, swivel, levels = at(105, 0, -95), at(-random.uniform(260, 330), 0, 0), (-70, 50)
    rails, ties = [at(0, y, z) for z in levels for y in (-26, 26)], [at(x, 0, z + 18) for z in levels for x in (60, 85)]
    d.add("transom", cut(box((-15, -120, -150), (0, 120, 76)), *(bore(p, X, 2.6, 30) for p in rails)))
    core = union(box((45, -10, -130), (75, 10, 80)), box((45, -10, -60), (120, 10, 80)))
    d.add("core", cut(core, *(bore(p, Y, 2.5) for p in ties)))
    for s, side in ((-1, "left"), (1, "right")):
        cheek = cut(box((45, s * 10, -130), (130, s * 14, 116)), *(bore(p, Y, 2.5) for p in ties), bore(pivot, Y, 6))
        fast(d, "core", **{f"{side}_cheek": cut(cheek, *(bore((x, 0, 97), Y, 4) for x in (65, 110)))})
        fast(d, f"{side} cheek", **{f"{side}_blade_washer": tube(pivot + s * 9 * Y, s * Y, 6, 14, 1)})
    for k, z in enumerate(levels):
        plate = [box((0, -36, z - 10), (4, 36, z + 10)), bar((9, 0), (22, 0), 9, z - 10, z + 10)]
        plate = cut(union(*plate), bore((22, 0, z), Z, 5 + play, 30), *(bore(p, X, 2.6, 30) for p in rails))
        nose = cut(box((22, -17, z + 10.4), (98, 17, z + 25)), box((45, -14, z), (99, 14, z + 30)))
        nose = union(nose, cyl((22, 0, z + 10.4), Z, 17, 14.6), cyl((22, 0, z - 20), Z, 5, 40))
        fast(d, "transom", **{f"gudgeon_{k}": plate})
        fast(d, "core", **{f"pintle_{k}": cut(nose, *(bore(p, Y, 2.5) for p in ties), bore((22, 0, z - 15), Y, 1.2))})
        fast(d, f"pintle {k}", **{f"clip_{k}": cyl((22, -9, z - 15), Y, 1.2, 18)})
        turns(d, (f"pintle {k}", f"gudgeon {k}", at(22, 0, z), Z))
    fast(d, "transom", **{f"gudgeon_screw_{k}": screw(p + 4 * X, -X, 2.6, 18) for k, p in enumerate(rails)})
    for k, p in enumerate(ties):
        fast(d, "core", **{f"pintle_bolt_{k}": screw(p - 17 * Y, Y, 2.5, 41)})
        fast(d, f"pintle bolt {k}", **{f"pintle_nut_{k}": hexagon(p + 17 * Y, Y, 4.5, 4, 2.5)})
    d.add("blade", laid(bar((0, 0), (0, -deep), 29, -9, 9, [(0, 0)], 6 + play), pivot, X, -Y))
    fast(d, "left cheek", blade_bolt=headed(pivot - 14 * Y, Y, 6, 40))
    fast(d, "blade bolt", blade_nut=hexagon(pivot + 14 * Y, Y, 9, 9, 6))
    tiller = cut(box(swivel + at(-18, -10, 82), (122, 10, 112)), *(bore((x, 0, 97), Y, 4) for x in (65, 110)))
    fast(d, "left cheek", tiller=cut(tiller, bore(swivel, Z, 3)))
    fast(d, "tiller", **{f"tiller_pin_{k}": rivet(at(x, -14, 97), Y, 4, 28) for k, x in enumerate((65, 110))})
    joint = swivel + 132 * Z
    base = cut(box(joint - at(9, 10, 19.7), joint + at(9, 10, 10)), box(joint - at(12, 6, 11.7), joint + at(12, 6, 20)))
    d.add("swivel base", cut(base, bore(swivel, Z, 3 + play), bore(joint, Y, 3)))
    fast(d, "tiller", swivel_screw=headed(swivel + 120.5 * Z, -Z, 3, 46))
    fast(d, "swivel screw", swivel_nut=hexagon(swivel + 82 * Z, -Z, 5.5, 5, 3))
    d.add("extension", cut(union(cyl(joint - 5.8 * Y, Y, 8, 11.6), cyl(joint, X, 5.5, 230)), bore(joint, Y, 3 + play)))
    fast(d, "swivel base", extension_rivet=rivet(joint - 10 * Y, Y, 3, 20))
    fast(d, "extension", grip=tube(joint + 120 * X, X, 5.5, 11, 105))
    turns(d, ("blade", "blade bolt", pivot, Y), ("swivel base", "tiller", swivel, Z))
    turns(d, ("extension", "swivel base", joint, Y))
    return d


@kind
def lathe_steady_rest(random):
    """A base on a bed, a hinged half ring shut by a swing bolt, three round fingers with rollers, screws and knobs."""
    d, play, inner = Drawing(["bed"]), random.choice([0.02, 0.06]), random.uniform(30, 36)
    hinge, swing = at(-97, 0, 0), at(97, -25, 0)
    d.add("bed", cut(box((-110, -165, -45), (110, -140, 45)), box((-8, -170, -30), (8, -130, 30))))
    ring = tube((0, 0, -15), Z, 60, 85, 30)
    lower = [ring.intersect(box((-90, -90, -20), (90, 0, 20))), box((-40, -130, -15), (40, -70, 15))]
    lower += [box((-90, -140, -35), (90, -128, 35)), box((75, -38, -15), (108, 0, 15))]
    lower += [f for z in (-15, 6) for f in (cyl(hinge + z * Z, Z, 10, 9), box((-97, -10, z), (-75, 0, z + 9)))]
    upper = [ring.intersect(box((-90, 0, -20), (90, 90, 20))), box((75, 0, -15), (110, 16, 15))]
    upper += [cyl(hinge - 5.8 * Z, Z, 10, 11.6), box((-97, 0, -5.8), (-75, 10, 5.8))]
    slot = box((85, -60, -6), (120, 60, 6))
    base = cut(union(*lower), bore(hinge, Z, 5), bore(swing, Z, 5), slot, cyl((0, -131, 0), -Y, 6, 15))
    halves = {"base": base, "cap": cut(union(*upper), bore(hinge, Z, 5 + play), slot)}
    for k, angle in enumerate((90, 210, 330)):
        u, half = at(np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0), "cap" if k == 0 else "base"
        turned = partial(laid, origin=0 * X, x=u, z=Z)
        roller, taps = inner + 5, [cyl((105, y, 0), X, 2, 30) for y in (-13, 13)]
        halves[half] = union(halves[half], turned(cyl((62, 0, 0), X, 17, 58)))
        for hole in (*taps, cyl((50, 0, 0), X, 9 + play, 90), cyl((80, 0, 0), Z, 2.5, 40)):
            halves[half] = cut(halves[half], turned(hole))
        finger = cut(cyl((inner, 0, 0), X, 9, 108 - inner), cyl((62, 0, 0), X, 5, 60), box((66, -2, 6), (100, 2, 12)))
        finger = cut(finger, box((0, -12, -3.3), (inner + 17, 12, 3.3)), bore((roller, 0, 0), Z, 2.5, 20))
        d.add(f"finger {k}", turned(finger))
        fast(d, f"finger {k}", **{f"roller_pin_{k}": turned(cyl((roller, 0, -8.5), Z, 2.5, 17))})
        d.add(f"roller {k}", turned(tube((roller, 0, -3), Z, 2.5 + play, 8.5, 6)))
        fast(d, half, **{f"dog_screw_{k}": turned(union(cyl((80, 0, 8), Z, 2, 4), cyl((80, 0, 11), Z, 2.5, 9)))})
        fast(d, half, **{f"plate_{k}": turned(cut(tube((120, 0, 0), X, 4 + play, 17, 7), *taps))})
        for n, y in enumerate((-13, 13)):
            fast(d, half, **{f"plate_screw_{k}_{n}": turned(screw((127, y, 0), -X, 2, 15))})
        stem = union(cyl((75, 0, 0), X, 5, 40), cyl((113, 0, 0), X, 8.5, 6.9), cyl((119, 0, 0), X, 4, 30))
        d.add(f"feed screw {k}", turned(stem))
        fast(d, f"feed screw {k}", **{f"knob_{k}": turned(tube((132, 0, 0), X, 4, 15, 17))})
        d.joint("Prismatic", f"finger {k}", half, 80 * u, u)
        d.joint("Cylindrical", f"feed screw {k}", f"finger {k}", 80 * u, u)
        turns(d, (f"feed screw {k}", f"plate {k}", 120 * u, u), (f"roller {k}", f"roller pin {k}", roller * u, Z))
    d.add("cap", halves["cap"])
    fast(d, "bed", base=halves["base"])
    fast(d, "base", hinge_pin=headed(hinge - 15 * Z, Z, 5, 32), swing_pin=headed(swing - 15 * Z, Z, 5, 32))
    d.add("swing bolt", cut(cyl(swing - 5.6 * Z, Z, 9, 11.2).union(cyl(swing, Y, 5, 75)), bore(swing, Z, 5 + play)))
    fast(d, "swing bolt", swing_washer=tube((97, 16, 0), Y, 5, 11, 3), swing_nut=hexagon((97, 19, 0), Y, 9, 12, 5))
    fast(d, "base", stud=cyl((0, -140 + 9, 0), -Y, 6, 60))
    fast(d, "stud", clamp_nut=hexagon((0, -175, 0), -Y, 9, 10, 6))
    fast(d, "bed", clamp_plate=cut(box((-35, -175, -15), (35, -165, 15)), bore(0 * X, Y, 6.2)))
    turns(d, ("cap", "base", hinge, Z), ("swing bolt", "swing pin", swing, Z))
    return d


@kind
def guided_air_cylinder(random):
    """A body with piston, cap and circlips, a rod and two guide rods in bushes, a plate on three screws, fittings."""
    d, play, out = Drawing(["body"]), random.choice([0.01, 0.04]), random.uniform(100, 135)
    rods, piston = [at(0, y, 0) for y in (-42, 42)], 20 + min(out - 96, 40)
    body = cut(box((0, -60, -25), (90, 60, 25)), cyl(-X, X, 16, 81), bore(0 * X, X, 9), tube((1, 0, 0), X, 10, 17, 1.6))
    for k, (p, x) in enumerate((p, x) for p in rods for x in (3, 65)):
        body = cut(body, cyl(p + (x - 9) * X, X, 12, 62), tube(p + (1 if x == 3 else 87.6) * X, X, 5, 13, 1.4))
        fast(d, "body", **{f"guide_bush_{k}": tube(p + x * X, X, 8 + play, 12, 22)})
        ring = tube(p + (1 if x == 3 else 87.6) * X, X, 9.5, 13, 1.4)
        fast(d, "body", **{f"bush_ring_{k}": cut(ring, box(p + at(-9, -2.5, 3), p + at(99, 2.5, 20)))})
    for k, p in enumerate((at(20, 0, 16), at(72, 0, 16))):
        sensor = box((30 + 25 * k, -61, -4), (46 + 25 * k, -55, 4))
        body = cut(body, cyl(p - 3 * Z, Z, 5, 20), sensor)
        fitting = union(tube(p + 1 * Z, Z, 2, 5, 8), hexagon(p + 9 * Z, Z, 7, 7, 2), tube(p + 16 * Z, Z, 2, 6, 9))
        fast(d, "body", **{f"fitting_{k}": fitting, f"sensor_{k}": sensor})
    d.add("body", body)
    ring = cut(tube((1, 0, 0), X, 13, 17, 1.6), box((-9, -4, 5), (99, 4, 30)))
    fast(d, "body", cap=cyl((2.6, 0, 0), X, 16, 8), cap_ring=ring, rod_bush=tube((79, 0, 0), X, 6 + play, 9, 11))
    rod = union(cyl((piston - 7, 0, 0), X, 4, 20), cyl((piston + 12, 0, 0), X, 6, out - piston - 12))
    d.add("rod", cut(rod, cyl((out - 15, 0, 0), X, 2.5, 20)))
    fast(d, "rod", piston=tube((piston, 0, 0), X, 4, 16 - play, 12), piston_nut=hexagon((piston, 0, 0), -X, 6.5, 6, 4))
    places = [0 * X, *rods]
    plate = cut(box((out, -58, -24), (out + 12, 58, 24)), *(bore(p, X, 2.7) for p in places))
    fast(d, "rod", plate=cut(plate, *(cyl((out + 6, p[1], 0), X, 4.5, 9) for p in places)))
    for k, p in enumerate(places):
        fast(d, f"guide rod {k}" if k else "rod", **{f"plate_screw_{k}": screw(p + (out + 6) * X, -X, 2.5, 16)})
        if k:
            fast(d, "plate", **{f"guide_rod_{k}": tube(p - 30 * X, X, 2.5, 8, out + 30)})
            fast(d, f"guide rod {k}", **{f"bumper_{k}": tube(p + (out - 6) * X, X, 8, 13, 6)})
            d.joint("Cylindrical", f"guide rod {k}", f"guide bush {2 * k - 2}", p, X)
    d.joint("Cylindrical", "rod", "rod bush", 0 * X, X)
    return d


@kind
def stirling_model(random):
    """Two plates on a ring with bolts, a displacer on a rod in a gland, a piston, a crank in two posts, a flywheel."""
    d, play, turn = Drawing(["lower plate"]), random.choice([0.02, 0.08]), random.uniform(0.2, 2.6)
    high, bolts = 110.0, hollow(0 * X, Z, 61, 4, 0.9)
    posts = [at(x, y, 28) for x in (-27, 59) for y in (-9, 9)]
    d.add("lower plate", cut(cyl(0 * X, Z, 66, 4), *(bore(p, Z, 2.1) for p in bolts)))
    fast(d, "lower plate", ring=tube((0, 0, 4), Z, 52, 56, 20))
    plate = cut(tube((0, 0, 24), Z, 4, 66, 4), bore((30, 0, 0), Z, 11), *(bore(p, Z, 1.5) for p in posts))
    fast(d, "ring", upper_plate=cut(plate, *(bore(p, Z, 2.1) for p in bolts)))
    for k, p in enumerate(bolts):
        fast(d, "lower plate", **{f"bolt_{k}": headed(p, Z, 2, 34)})
        fast(d, f"bolt {k}", **{f"nut_{k}": hexagon(p + 28 * Z, Z, 3.5, 3, 2)})
    fast(d, "upper plate", gland=union(tube((0, 0, 24), Z, 1.5 + play, 4, 16), tube((0, 0, 28), Z, 1.5 + play, 6, 3)))
    fast(d, "upper plate", cylinder=tube((30, 0, 24), Z, 8, 11, 32))
    for k, (x, foot) in enumerate(((-18, -31), (50, 48))):
        post = union(box((x - 2, -12, 28), (x + 2, 12, high + 10)), box((foot, -14, 28), (foot + 15, 14, 31)))
        post = cut(post, bore((x, 0, high), X, 5), *(bore(p, Z, 1.7, 20) for p in posts))
        fast(d, "upper plate", **{f"post_{k}": post})
        fast(d, f"post {k}", **{f"bearing_{k}": tube((x - 2, 0, high), X, 2, 5, 4)})
        turns(d, ("crank", f"bearing {k}", at(0, 0, high), X))
    a, b = (at(x, r * np.sin(v), high + r * np.cos(v)) for x, r, v in ((0, 4, turn), (30, 6, turn + np.pi / 2)))
    crank = [cyl((x, 0, high), X, 2, long) for x, long in ((-32, 27), (5, 20), (35, 43))]
    crank += [cyl((x, 0, high), X, 9, 2) for x in (-5, 3, 25, 33)] + [cyl(p - 5 * X, X, 2, 10) for p in (a, b)]
    d.add("crank", union(*crank))
    wheel = union(tube((52.2, 0, high), X, 2, 7, 14), tube((60, 0, high), X, 2, 50, 4))
    fast(d, "crank", flywheel=wheel, collar=tube((-24, 0, high), X, 2, 5, 4))
    for name, p, long, radius in (("displacer", a, 32.0, 1.0), ("power", b, 64.0, 1.5)):
        low = at(p[0], 0, p[2] - np.sqrt(long**2 - p[1] ** 2))
        rod = laid(bar(p[1:], low[1:], 3, -1.5, 1.5), p[0] * X, Y, X).union(cyl(p - 1.5 * X, X, 5, 3))
        d.add(f"{name} link", cut(rod, bore(p, X, 2 + play), bore(low, X, radius + play / 2)))
        turns(d, (f"{name} link", "crank", p, X))
        if name == "power":
            piston = cut(cyl(low - 10 * Z, Z, 8 - play / 2, 17), box(low + at(-2, -9, -5), low + at(2, 9, 9)))
            d.add("piston", cut(piston, bore(low, X, 1.5)))
            fast(d, "piston", piston_pin=cyl(low - 7.5 * X, X, 1.5, 15))
            turns(d, ("power link", "piston pin", low, X))
            d.joint("Cylindrical", "piston", "cylinder", low, Z)
        else:
            yoke = cut(box(low - at(5, 4, 9), low + at(5, 4, 4)), box(low - at(1.7, 9, 4), low + at(1.7, 9, 9)))
            d.add("displacer rod", cyl((0, 0, low[2] - 69), Z, 1.5, 63))
            fast(d, "displacer rod", yoke=cut(yoke, cyl(low - 10 * Z, Z, 1.5, 4), bore(low, X, 1)))
            fast(d, "yoke", yoke_pin=rivet(low - 5 * X, X, 1, 10))
            fast(d, "displacer rod", displacer=tube((0, 0, low[2] - 69), Z, 1.5, 50, 9))
            turns(d, ("displacer link", "yoke pin", low, X))
            d.joint("Cylindrical", "displacer rod", "gland", low, Z)
    fast(d, "upper plate", **{f"post_screw_{k}": screw(p + 3 * Z, -Z, 1.5, 7) for k, p in enumerate(posts)})
    return d


@kind
def hexapod_platform(random):
    """Six servos screwed to a base, horns with ball pins, rods with cups of plastics, a platform with ball pins."""
    d, size, high = Drawing(["base"]), random.uniform(105, 118), random.uniform(105, 125)
    base, top = tube(0 * X, Z, 25, size + 12, 5), tube((0, 0, high), Z, 14, 56, 6)
    for k in range(6):
        angle, turn = np.pi * k / 3, np.radians((-18, 78, 102, 198, 222, 318)[k])
        u, v = at(np.cos(angle), np.sin(angle), 0), at(np.cos(turn), np.sin(turn), 0)
        t, axle, tip = (1 - 2 * (k % 2)) * np.cross(Z, u), size * u + 15 * Z, 80 * v + (high + 3) * Z
        low, spots = axle + 24 * t + 18 * u, [(size - x) * u - 10 * t for x in (9, 27)]
        servo = laid(union(box((-30, -10, -36), (10, 10, 0)), cyl(0 * X, Z, 5, 3)), axle, t, u)
        servo = cut(servo, cyl(axle - 6 * u, u, 3, 20), *(cyl(p, Z, 1.5, 12) for p in spots))
        base = cut(base, *(bore(p, Z, 1.7, 10) for p in spots))
        fast(d, "base", **{f"servo_{k}": servo})
        fast(d, f"servo {k}", **{f"servo_screw_{k}_{n}": screw(p, Z, 1.5, 12) for n, p in enumerate(spots)})
        horn = laid(bar((0, 0), (24, 0), 6, 4, 8, [(24, 0)], 1.5), axle, t, u)
        d.add(f"horn {k}", horn.union(cyl(axle - 6 * u, u, 3, 12)))
        top = cut(top, cyl(tip - 32 * v, v, 1.5, 30))
        cups, balls = [cyl(low, tip - low, 2, np.linalg.norm(tip - low))], []
        for name, by, p, axis, root in (("low", f"horn {k}", low, u, 14), ("high", "platform", tip, v, 32)):
            ball = laid(sphere(0 * X, 4), p, Z, axis)
            fast(d, by, **{f"{name}_pin_{k}": union(ball, cyl(p - root * axis, axis, 1.5, root))})
            cups, balls = [*cups, cyl(p - 2.5 * axis, axis, 6.5, 5)], [*balls, ball]
            d.joint("Spherical", f"rod {k}", f"{name} pin {k}", p)
        d.add(f"rod {k}", cut(union(*cups), *balls))
        turns(d, (f"horn {k}", f"servo {k}", axle, u))
    d.add("base", base)
    d.add("platform", top)
    return d
