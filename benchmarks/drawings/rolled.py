"""From kitchen, laboratory, field and road: a pasta machine, a peeler, a centrifuge, a focuser, a planter, a brake."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import both_sides, circlip
from drawings.guided import hollow
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
    laid,
    rivet,
    screw,
    sphere,
    tube,
    union,
)


def fast(d: Drawing, by: str, **parts) -> None:
    """Draw parts that are fast on another; an underscore in a name stands for a blank."""
    for name, shape in parts.items():
        d.add(name.replace("_", " "), shape)
        d.joint("Weld", name.replace("_", " "), by)


def turns(d: Drawing, *rows) -> None:
    """Say which two parts turn on each other, and where, and about which axis."""
    for row in rows:
        d.joint("Revolute", *row)


@kind
def pasta_machine(random):
    """Two rollers between side plates on tie rods, one on an eccentric shaft with knob; gears, a crank with a grip."""
    d, play = Drawing(["base"]), random.choice([0.05, 0.15])
    half, gap = random.uniform(75, 90), random.uniform(0.5, 2.0)
    low, roll = at(0, -15, 45), at(0, 13 + gap, 45)
    shaft, ties = roll + 2 * Y, [at(0, -30, 18), at(0, 34, 70)]
    feet = [at(s * (half + 13), y, 6) for s in (-1, 1) for y in (-30, 30)]
    d.add("base", cut(box((-half - 24, -60, 0), (half + 24, 60, 6)), *(cyl(p - 6 * Z, Z, 2, 6) for p in feet)))
    fast(d, "base", **{f"side_screw_{k}": screw(p + 4 * Z, -Z, 2, 9) for k, p in enumerate(feet)})
    roller = union(cyl((12 - half, 0, 0), X, 14, 2 * half - 12), cyl((1 - half, 0, 0), X, 10, 12))
    d.add("loose roller", cut(roller.translate(tuple(roll.tolist())), bore(roll, X, 8)))
    fixed = union(roller.translate(tuple(low.tolist())), cyl(low - (half + 9) * X, X, 6, 2 * half + 18))
    fixed = cut(fixed, hexagon(low + (half - 12) * X, X, 3.6, 30))
    for k, p in enumerate(ties):
        d.add(f"tie {k}", cut(cyl(p - (half + 2) * X, X, 5, 2 * half + 4), bore(p, X, 2)))
    for s, side in ((-1, "left"), (1, "right")):
        x, clip = s * (half + 2), low + s * (half + (6.5 if s > 0 else 7.5)) * X
        plate = union(box((x, -48, 6), (x + 4 * s, 48, 85)), box((x, -48, 6), (x + 20 * s, 48, 10)))
        plate = cut(plate, bore(low, X, 8), bore(shaft, X, 9 + play), *(bore(p, X, 2.2) for p in ties))
        fast(d, "base", **{f"{side}_plate": cut(plate, *(bore(p, Z, 2.2, 8) for p in feet))})
        fast(d, f"{side} plate", **{f"{side}_bush": tube(low + s * (half + 0.5) * X, s * X, 6 + play, 8, 6)})
        for k, p in enumerate(ties):
            fast(d, f"tie {k}", **{f"{side}_tie_screw_{k}": screw(p + s * (half + 6) * X, -s * X, 2, 16)})
            d.joint("Weld", f"tie {k}", f"{side} plate")
        fixed = grooved(fixed, clip, X, 6)
        fast(d, "fixed roller", **{f"{side}_ring": circlip(clip, X, 6)})
        fast(d, "loose roller", **{f"{side}_roller_bush": tube(roll + s * (half - 1) * X, -s * X, 6 + play, 8, 14)})
        turns(d, ("fixed roller", f"{side} bush", low, X), ("eccentric shaft", f"{side} plate", shaft, X))
    d.add("fixed roller", fixed)
    fast(d, "fixed roller", fixed_gear=tube(low - (half - 2) * X, X, 10, (28 + gap) / 2, 8))
    fast(d, "loose roller", loose_gear=tube(roll - (half - 2) * X, X, 10, (28 + gap) / 2, 8))
    rod = union(cyl(roll - (half + 2) * X, X, 6, 2 * half + 4), cyl(shaft + (half + 1) * X, X, 9, 6))
    rod = union(rod, cyl(shaft - (half + 9) * X, X, 9, 8), cyl(shaft + (half + 7) * X, X, 5, 14))
    d.add("eccentric shaft", grooved(rod, shaft - (half + 7) * X, X, 9))
    knob = tube(shaft + (half + 7) * X, X, 5, 16, 14)
    fast(d, "eccentric shaft", shaft_ring=circlip(shaft - (half + 7) * X, X, 9), knob=knob)
    end = at(half + 27, -85, 45)
    arm = laid(bar((-15, 45), (-85, 45), 9, 0, 5, ((-85, 45),), 4), (half + 22) * X, Y, X)
    fast(d, "fixed roller", crank=union(arm, hexagon(low + (half - 10) * X, X, 3.5, 34)))
    fast(d, "crank", crank_pin=headed(end + 46.5 * X, -X, 4, 51.5))
    d.add("grip", tube(end + 0.3 * X, X, 4 + play, 11, 46))
    turns(d, ("grip", "crank pin", end, X), ("loose roller", "eccentric shaft", roll, X))
    return d


@kind
def apple_peeler(random):
    """A screw shaft with fork and crank in a cast frame with a table clamp, a half nut lever, an arm with a blade."""
    d, play = Drawing(["frame"]), random.choice([0.1, 0.2])
    long, high = random.uniform(190, 220), random.uniform(95, 110)
    axis, pivot, post, rise = at(0, 0, high), at(30, 0, high - 32), at(95, 55, 12), at(0.5 * long + 30, 66, 0)
    frame = [box((-40, -20, 0), (110, 20, 12)), box((-40, -20, -62), (-25, 20, 12)), box((-40, -9, -62), (9, 9, -50))]
    frame += [box((-12, -14, 12), (12, 14, high)), cyl(axis - 20 * X, X, 17, 40), box((75, 15, 0), (110, 70, 12))]
    frame += [box((10, y, high - 40), (37, y + 4, high - 25)) for y in (-8.2, 4.2)]
    frame = cut(union(*frame), bore(axis, X, 8 + play), bore(pivot, Y, 2.5, 20))
    d.add("frame", cut(frame, cyl(post - 10 * Z, Z, 3, 12), cyl((0, 0, -70), Z, 5.05, 30)))
    d.add("clamp screw", cut(cyl((0, 0, -112), Z, 5, 90).union(cyl((0, 0, -22), Z, 3, 7)), bore((0, 0, -104), Y, 2.5)))
    d.add("clamp pad", cut(cyl((0, 0, -21.8), Z, 13, 10), cyl((0, 0, -22), Z, 3 + play, 7.2)))
    fast(d, "clamp screw", clamp_bar=cyl((0, -30, -104), Y, 2.5, 60))
    fast(d, "clamp bar", **{f"bar_cap_{k}": tube((0, y, -104), Y, 2.5, 5, 8) for k, y in enumerate((-30, 22))})
    root, head, tip = axis - 0.5 * long * X, axis + 0.5 * long * X, axis - at(0.5 * long, 75, 0)
    d.add("shaft", cut(cyl(root, X, 8, long).union(cyl(root - 14 * X, X, 5, 14)), cyl(head - 20 * X, X, 4, 30)))
    prongs = [cyl(head + 8 * X + p, X, 1.6, 26) for p in hollow(0 * X, X, 7, 3)]
    crank = cut(laid(bar((0, 0), (75, 0), 9, 0, 6, [(0, 0)], 5), root, -Y, -X), bore(tip, X, 3.5, 20))
    fast(d, "shaft", fork=union(cyl(head, X, 11, 8), cyl(head - 20 * X, X, 4, 20), *prongs), crank=crank)
    fast(d, "shaft", crank_washer=tube(root - 6 * X, -X, 5, 9, 1.5), crank_nut=hexagon(root - 7.5 * X, -X, 8, 6, 5))
    fast(d, "crank", grip_pin=rivet(tip - 62.5 * X, X, 3.5, 62.5))
    d.add("grip", tube(tip - 62.2 * X, X, 3.5 + play, 10, 56))
    lever = [bar((30, -32), (50, -14), 6, -4, 4), box((43, -18, -4), (57, -5, 4)), bar((50, -14), (85, -22), 4, -4, 4)]
    knob = union(cyl(axis + at(89, 0, -21), X, 7, 14), cyl(axis + at(78, 0, -21), X, 1.5, 11))
    d.add("half nut", cut(laid(union(*lever), axis, X, -Y), cyl(axis, X, 8, 100), bore(pivot, Y, 2.5 + play, 20), knob))
    fast(d, "half nut", lever_knob=knob)
    spot = rise + at(0, -8, high)
    arm = bar(post, rise, 9, 12.2, 21.8, [post], 4 + play).union(cyl(rise + 13 * Z, Z, 5, high))
    d.add("peeler arm", cut(arm.union(box(spot + at(-8, 3, -12), spot + at(8, 14, 12))), cyl(spot, Y, 1.5, 12)))
    fast(d, "peeler arm", blade=cut(box(spot + at(-7, 0, -10), spot + at(7, 3, 10)), bore(spot, Y, 1.7, 5)))
    fast(d, "peeler arm", blade_screw=screw(spot, Y, 1.5, 10))
    stud = union(cyl(post - 10 * Z, Z, 3, 12), cyl(post, Z, 4, 10), cyl(post + 10 * Z, Z, 7, 4))
    fast(d, "frame", arm_screw=stud, lever_pin=rivet(pivot - 8.2 * Y, Y, 2.5, 16.4))
    d.joint("Cylindrical", "shaft", "frame", axis, X)
    d.joint("Cylindrical", "clamp screw", "frame", 0 * X, Z)
    turns(d, ("clamp pad", "clamp screw", 0 * X, Z), ("peeler arm", "arm screw", post, Z))
    turns(d, ("grip", "grip pin", tip, X), ("half nut", "frame", pivot, Y))
    return d


@kind
def swing_bucket_centrifuge(random):
    """A motor on rubber buffers in a case with a lid, a rotor with a cross pin and a cap nut, buckets on pivot pins."""
    d, play = Drawing(["case"]), random.choice([0.1, 0.2])
    reach, deep, spots = random.uniform(72, 80), random.uniform(48, 56), hollow(0 * X, Z, 40, 3)
    rim = reach + deep + 12
    hinge = at(-rim - 16, 0, 46)
    case = [box((-rim - 12, -rim - 12, -80), (rim + 12, rim + 12, -74)), tube((0, 0, -74), Z, rim, rim + 4, 114)]
    case += [box((-rim - 22, y - 7, 28), (-rim + 20, y + 7, 40)) for y in (-40, 40)]
    case += [box(hinge + at(-6, y - 7, -12), hinge + at(6, y + 7, 0)) for y in (-40, 40)]
    case += [cyl(hinge + (y - 7) * Y, Y, 6, 14) for y in (-40, 40)]
    holes = [cyl((0, 0, -74), Z, rim, 120), *(bore(p - 77 * Z, Z, 2.2, 10) for p in spots), bore(hinge, Y, 3)]
    d.add("case", cut(union(*case), *holes, cyl((0, 0, -81), Z, 32, 10)))
    motor = union(cyl((0, 0, -64), Z, 30, 50), cyl((0, 0, -64), Z, 46, 5), cyl((0, 0, -14), Z, 10, 3))
    d.add("motor", cut(motor, cyl((0, 0, -50), Z, 4, 60), *(bore(p - 64 * Z, Z, 2.2, 8) for p in spots)))
    for k, p in enumerate(spots):
        fast(d, "case", **{f"buffer_{k}": tube(p - 74 * Z, Z, 2, 6, 10)})
        fast(d, f"buffer {k}", **{f"low_screw_{k}": screw(p - 80 * Z, Z, 2, 9)})
        fast(d, f"buffer {k}", **{f"high_screw_{k}": screw(p - 59 * Z, -Z, 2, 10)})
        d.joint("Weld", "motor", f"buffer {k}")
    d.add("shaft", cut(cyl((0, 0, -50), Z, 4, 64).union(cyl((0, 0, 14), Z, 3, 10)), bore(-4 * Z, X, 1.5)))
    ways = [at(np.cos(t), np.sin(t), 0) for t in np.arange(4) * np.pi / 2]
    pins = [(reach * w, s * np.cross(Z, w)) for w in ways for s in (-1, 1)]
    arms = [box(0.3 * p + 22 * t - 6 * Z, 1.1 * p + 30 * t + 6 * Z) for p, t in pins]
    rotor = cut(union(cyl((0, 0, -6), Z, 36, 12), cyl((0, 0, -8), Z, 11, 20), *arms), bore(0 * X, Z, 4.02))
    rotor = cut(rotor, box((-12, -1.55, -20), (12, 1.55, -2.5)), *(cyl(p + 15 * t, t, 3, 20) for p, t in pins))
    washer, nut = tube((0, 0, 12), Z, 4.1, 9, 2), cut(hexagon((0, 0, 14), Z, 7, 13), cyl((0, 0, 13), Z, 3, 12))
    fast(d, "shaft", rotor=rotor, cross_pin=cyl((-10, 0, -4), X, 1.5, 20), rotor_washer=washer, cap_nut=nut)
    fast(d, "rotor", **{f"pivot_pin_{k}": headed(p + 30 * t, -t, 3, 14) for k, (p, t) in enumerate(pins)})
    for k, (p, t) in enumerate(pins[::2]):
        bucket = union(cyl(p + (8 - deep) * Z, Z, 17, deep), cyl(p + 21.5 * t, -t, 6, 43))
        holes = [cyl(p + s * 15.5 * t, s * t, 3 + play, 10) for s in (-1, 1)]
        d.add(f"bucket {k}", cut(bucket, cyl(p + (11 - deep) * Z, Z, 14, 80), *holes))
        glass = cut(cyl(p + (11 - deep) * Z, Z, 14, deep + 4), cyl(p + (13 - deep) * Z, Z, 12.5, 90))
        fast(d, f"bucket {k}", **{f"tube_{k}": glass})
        fast(d, f"tube {k}", **{f"stopper_{k}": union(cyl(p + 9 * Z, Z, 12.5, 6), cyl(p + 15 * Z, Z, 15, 6))})
        turns(d, (f"bucket {k}", "rotor", p, t))
    lid = cyl((0, 0, 40), Z, rim + 4, 5), box((-rim - 16, -30, 41), (20 - rim, 30, 45)), cyl(hinge - 30 * Y, Y, 6, 60)
    d.add("lid", cut(union(*lid), bore(hinge, Y, 3 + play)))
    fast(d, "case", lid_pin=rivet(hinge - 48 * Y, Y, 3, 96))
    turns(d, ("shaft", "motor", 0 * X, Z), ("lid", "case", hinge, Y))
    return d


@kind
def crayford_focuser(random):
    """A draw tube with a flat on four bearings on pins, a shaft in a carrier, knobs with set screws, thumb screws."""
    d, play = Drawing(["base flange"]), random.choice([0.02, 0.05])
    long, spots = random.uniform(62, 72), hollow(-10 * X, X, 40, 3)
    middle, seat = at(long / 2, 0, -26), at(long + 26, 0, 0)
    corners = [at(x, y, -50) for x in (13, long - 13) for y in (-19, 19)]
    d.add("base flange", cut(tube((-10, 0, 0), X, 27, 54, 6), *(bore(p, X, 2.2, 30) for p in spots)))
    body = cut(union(cyl((-4, 0, 0), X, 44, long + 4), box((-4, -30, -44), (long, 30, -30))), bore(0 * X, X, 26.5))
    body = cut(body, *(cyl(p, X, 2, 22) for p in spots))
    body = cut(body, box(middle + at(-13, -16.5, -30), middle + at(13, 16.5, 8)), bore(middle, Y, 5))
    for k, (x, turn) in enumerate((x, s * np.pi / 4) for x in (12, long - 12) for s in (-1, 1)):
        out, way = at(0, np.sin(turn), np.cos(turn)), at(0, np.cos(turn), -np.sin(turn))
        p = x * X + 31.5 * out
        body = cut(body, laid(box((-8, -2.7, -16), (8, 2.7, 20)), p, X, out), cyl(p - 10 * way, way, 2, 50))
        d.add(f"bearing {k}", tube(p - 2 * way, way, 2 + play, 6.5, 4))
        fast(d, "body", **{f"bearing_pin_{k}": cyl(p - 10 * way, way, 2, 20)})
        d.joint("Revolute", f"bearing {k}", f"bearing pin {k}", p, way)
    fast(d, "base flange", body=cut(body, *(cyl(p + 5 * Z, Z, 1.5, 10) for p in corners)))
    fast(d, "body", **{f"flange_screw_{k}": screw(p, X, 2, 16) for k, p in enumerate(spots)})
    ways = [at(0, np.cos(t), np.sin(t)) for t in (0.5, 2.5)]
    tubes = union(tube((-25, 0, 0), X, 22, 25, long + 55), tube((long + 18, 0, 0), X, 22, 31, 16))
    d.add("draw tube", cut(tubes, box((-30, -20, -30), (long + 16, 20, -23)), *(cyl(seat, w, 2, 40) for w in ways)))
    fast(d, "draw tube", adapter=tube((long + 16, 0, 0), X, 16, 22, 18).union(tube((long + 34, 0, 0), X, 16, 29, 5)))
    fast(d, "draw tube", **{f"thumb_screw_{k}": headed(seat + 40 * w, -w, 2, 18) for k, w in enumerate(ways)})
    carrier = union(box((6, -26, -50), (long - 6, 26, -44)), box(middle + at(-12, -14, -18), middle + at(12, 14, 1)))
    holes = [bore(middle, Y, 3 + play), *(bore(p, Z, 1.7, 10) for p in corners)]
    fast(d, "body", carrier=cut(carrier, *holes))
    fast(d, "body", **{f"carrier_screw_{k}": screw(p, Z, 1.5, 13) for k, p in enumerate(corners)})
    shaft = cyl(middle - 62 * Y, Y, 3, 124)
    for s, side in ((-1, "left"), (1, "right")):
        place, p, size = middle + (14.2 if s > 0 else -15.2) * Y, middle + 46 * s * Y, random.choice([15, 18])
        shaft = grooved(shaft, place, Y, 3)
        knob = cut(union(cyl(p, s * Y, 8, 8), cyl(p + 6 * s * Y, s * Y, size, 12)), cyl(p, s * Y, 3, 16))
        knob = cut(knob, cyl(p + 3 * s * Y, -Z, 1, 12))
        fast(d, "shaft", **{f"{side}_ring": circlip(place, Y, 3), f"{side}_knob": knob})
        fast(d, f"{side} knob", **{f"{side}_set_screw": cyl(p + 3 * s * Y - 3 * Z, -Z, 1, 4)})
    d.add("shaft", shaft)
    d.joint("Prismatic", "draw tube", "body", 0 * X, X)
    d.joint("Revolute", "shaft", "carrier", middle, Y)
    return d


@kind
def planter_row_unit(random):
    """A bracket on U-bolts, two pairs of parallel arms, a shank with an opener disc and a gauge wheel; bolts, nuts."""
    d, play, tilt = Drawing(["toolbar"]), random.choice([0.1, 0.3]), random.uniform(-0.1, 0.25)
    drop = random.uniform(230, 280) * at(np.cos(tilt), -np.sin(tilt), 0)
    a, b, c, dd = at(82, 60, 0), at(82, -60, 0), at(82, 60, 0) + drop, at(82, -60, 0) + drop
    e, g = dd + at(-10, -170, 0), dd + at(60, -12, 0)
    w, legs, ring = e + at(45, -10, 0), [at(45, y, z) for z in (-66, 66) for y in (-40, 40)], hollow(e, Z, 33, 4)
    d.add("toolbar", cut(box((-35, -35, -160), (35, 35, 160)), box((-28, -28, -200), (28, 28, 200))))
    plate = union(box((35, -90, -80), (45, 90, 80)), *(box((40, -80, s * 39), (98, 80, s * 48)) for s in (-1, 1)))
    fast(d, "toolbar", bracket=cut(plate, *(bore(q, Z, 8, 60) for q in (a, b)), *(bore(q, X, 5.3, 20) for q in legs)))
    for k, z in enumerate((-66, 66)):
        hoop = [cyl((-40, y, z), X, 5, 98) for y in (-40, 40)] + [box((-45, -45, z - 5), (-35, 45, z + 5))]
        fast(d, "bracket", **{f"U-bolt_{k}": union(*hoop)})
        fast(d, f"U-bolt {k}", **{f"U-nut_{k}_{n}": hexagon(legs[2 * k + n], X, 8, 8, 5) for n in (0, 1)})
    shank = [*both_sides(c, dd, 18, 39, 48, (), 0), box(dd + at(-12, 20, -39), c + at(12, -20, 39))]
    shank += [bar(dd, e, 20, -12, 12), box(dd + at(-12, 0, -12), dd + at(12, 40, 12)), bar(dd, g, 18, -12, 12)]
    d.add("shank", cut(union(*shank), *(bore(q, Z, 8, 60) for q in (c, dd, e, g))))
    for name, one, other in (("upper", a, c), ("lower", b, dd)):
        arm = both_sides(one, other, 14, 48.5, 58, (one, other), 8 + play)
        d.add(f"{name} arm", union(*arm, cyl((one + other) / 2 - 50 * Z, Z, 12, 100)))
        for end, q, by in (("front", one, "bracket"), ("rear", other, "shank")):
            fast(d, by, **{f"{name}_{end}_bolt": headed(q - 58.2 * Z, Z, 8, 132)})
            fast(d, f"{name} {end} bolt", **{f"{name}_{end}_nut": hexagon(q + 58.2 * Z, Z, 12, 12, 8)})
            d.joint("Revolute", f"{name} arm", by, q, Z)
    holes = [bore(q, Z, 2.5, 60) for q in ring]
    d.add("disc hub", cut(tube(e - 35 * Z, Z, 18, 24, 14).union(tube(e - 27 * Z, Z, 18, 42, 4)), *holes))
    fast(d, "disc hub", disc=cut(tube(e - 30 * Z, Z, 24, 120, 3), *holes), disc_bearing=tube(e - 35 * Z, Z, 8, 18, 14))
    fast(d, "disc hub", **{f"disc_rivet_{k}": rivet(q - 30 * Z, Z, 2.5, 7) for k, q in enumerate(ring)})
    fast(d, "shank", disc_bolt=headed(e - 35 * Z, Z, 8, 60), disc_spacer=tube(e - 21 * Z, Z, 8, 12, 9))
    fast(d, "disc bolt", disc_nut=hexagon(e + 12 * Z, Z, 12, 10, 8))
    d.add("gauge arm", cut(bar(g, w, 14, 12.5, 22.5), bore(g, Z, 8 + play, 60), bore(w, Z, 7, 60)))
    fast(d, "shank", gauge_bolt=headed(g + 22.8 * Z, -Z, 8, 48))
    fast(d, "gauge bolt", gauge_nut=hexagon(g - 12 * Z, -Z, 12, 10, 8))
    d.add("gauge wheel", tube(w + 29 * Z, Z, 15, 24, 40).union(tube(w + 34 * Z, Z, 15, 82, 30)))
    fast(d, "gauge wheel", tyre=tube(w + 30 * Z, Z, 82, 95, 38), wheel_bearing_0=tube(w + 29 * Z, Z, 8, 15, 12))
    fast(d, "gauge wheel", wheel_bearing_1=tube(w + 57 * Z, Z, 8, 15, 12))
    fast(d, "gauge arm", wheel_bolt=headed(w + 69 * Z, -Z, 8, 46.5).union(cyl(w + 13 * Z, Z, 7, 10)))
    fast(d, "wheel bolt", wheel_sleeve=tube(w + 41 * Z, Z, 8.1, 10, 16), wheel_spacer=tube(w + 22.5 * Z, Z, 8, 11, 6.5))
    turns(d, ("disc hub", "shank", e, Z), ("gauge arm", "shank", g, Z), ("gauge wheel", "gauge arm", w, Z))
    return d


@kind
def v_brake(random):
    """A fork with brake studs, arms on bushes, pads on studs with domed washers, a noodle in a stirrup on a rivet."""
    d, play, high = Drawing(["fork"]), random.choice([0.03, 0.1]), random.uniform(88, 105)
    fork = [box((-58, 66, -14), (58, 84, 14)), cyl((0, 80, 0), Y, 14, 120)]
    fork += [f for s in (-45, 45) for f in (tube((s, -200, 0), Y, 9, 12, 268), cyl((s * 8 / 9, -20, 6), Z, 9, 12))]
    d.add("fork", cut(union(*fork), *(cyl((s, -20, 7), Z, 4, 20) for s in (-40, 40))))
    for s, side in ((-1, "left"), (1, "right")):
        foot, top, q, out, arm = at(40 * s, -20, 0), at(40 * s, high, 0), at(40 * s, 11, 30), s * X, f"{side} arm"
        stud = union(cyl(foot + 8 * Z, Z, 4, 10), cyl(foot + 18 * Z, Z, 7, 2), cyl(foot + 20 * Z, Z, 5, 20))
        fast(d, "fork", **{f"{side}_stud": cut(stud, cyl(foot + 26 * Z, Z, 3, 20))})
        body = cut(union(bar(foot, top, 8, 21, 39), cyl(foot + 21 * Z, Z, 11, 18)), bore(foot, Z, 7))
        holes = box(q + at(-20, -7, -3), q + at(20, 7, 3)), cyl(top, Z, 2.5 if s < 0 else 3, 60)
        d.add(arm, cut(body, *holes))
        washer, boss_screw = tube(foot + 40 * Z, Z, 3, 9, 1.5), screw(foot + 41.5 * Z, -Z, 3, 14)
        fast(d, f"{side} stud", **{f"{side}_washer": washer, f"{side}_boss_screw": boss_screw})
        rod = union(cyl(q - 24 * out, out, 6, 4), cyl(q - 24 * out, out, 3, 53))
        fast(d, arm, **{f"{side}_rod": rod, f"{side}_bush": tube(foot + 20.1 * Z, Z, 5 + play, 7, 19.8)})
        pad, nut = cut(box(q + at(-30 * s, -6, -26), q + at(-22 * s, 6, 44)), rod), hexagon(q + 20 * out, out, 5, 6, 3)
        fast(d, f"{side} rod", **{f"{side}_pad": pad, f"{side}_pad_nut": nut})
        for k, (face, way) in enumerate(((-20, out), (20, -out))):
            ball = laid(sphere(0 * X, 8), q + face * out - 2 * way, Y, X)
            dome = cut(ball.intersect(cyl(q + face * out, way, 9, 10)), bore(q, X, 3.1))
            cup = cut(tube(q + face * out + 2.5 * way, way, 3.1, 7.5, 9.5), ball)
            fast(d, f"{side} rod", **{f"{side}_dome_{k}": dome, f"{side}_cup_{k}": cup})
        turns(d, (arm, f"{side} stud", foot, Z))
    top, bend = at(-40, high, 30), at(-65, high + 12, 30)
    stirrup = both_sides(top, top + at(13, 12, 0), 7, 9.2, 11, [top], 2.5 + play)
    stirrup = union(*stirrup).translate((0, 0, 30)).union(box(top + at(9, 6, -9.2), top + at(17, 18, 9.2)))
    d.add("stirrup", cut(stirrup, bore(top + 12 * Y, X, 2.5, 60)))
    pipe = cyl(bend, X, 2.5, 55), cyl(bend + 30 * X, X, 4, 4), cyl(bend, Y, 2.5, 45), sphere(bend, 2.5)
    fast(d, "stirrup", noodle=union(*pipe))
    fast(d, "left arm", stirrup_rivet=rivet(top - 11 * Z, Z, 2.5, 22))
    fast(d, "right arm", cable_washer=tube((40, high, 39), Z, 3, 7, 2), cable_bolt=screw((40, high, 41), -Z, 3, 18))
    turns(d, ("stirrup", "left arm", top, Z))
    return d
