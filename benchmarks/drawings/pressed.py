"""A press with a rack, a loom with levers, a crane for a camera."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import hollow
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, screw, sphere, tube, union
from drawings.sharpened import put, sheet
from drawings.vehicles import solid_bar, upright


@kind
def arbor_press(random):
    """A cast frame, a square ram with a rack, a cover, a pinion shaft with a keyed hub and a bar, a turning plate."""
    drawing, play, drop = Drawing(["frame"]), random.choice([0.05, 0.1, 0.2]), random.uniform(0, 35)
    axle, plate = at(0, 33.3, 250), at(0, 0, 40)
    frame = union(
        box((-65, -80, 0), (65, 130, 40)), box((-40, 75, 30), (40, 125, 300)), box((-52, -15.1, 200), (52, 120, 300))
    )
    frame = cut(
        frame, box((-15 - play, -20, 190), (15 + play, 15 + play, 310)), bore(axle, X, 18 + play), bore(plate, Z, 10)
    )
    spots = [at(x, -15.1, z) for x in (-35, 35) for z in (215, 285)]
    feet = [bore((x, y, 0), Z, 5.5, 60) for x in (-50, 50) for y in (-65, 112)]
    drawing.add("frame", cut(frame, *(cyl(p, Y, 4, 22) for p in spots), *feet))
    rack = [(15, 330 + drop), (-15, 330 + drop), (-15, 90 + drop), (15, 90 + drop)]
    for z in np.arange(108, 310, 8.0) + drop:
        rack += [(15, z), (12, z + 1.5), (12, z + 3.5), (15, z + 5)]
    ram = laid(sheet(rack, -15, 15), 0 * X, Y, X)
    ram = cut(ram, cyl((0, 0, 80 + drop), Z, 8, 40), cyl((0, 0, 310 + drop), Z, 4, 30))
    put(drawing, "ram", ram, "frame", "Prismatic", 0 * X, Z)
    nose = union(cyl((0, 0, 65 + drop), Z, 11, 25), cyl((0, 0, 90 + drop), Z, 8, 25))
    put(drawing, "nose", nose, "ram")
    put(drawing, "stop plate", cut(box((-25, -20, 330 + drop), (25, 25, 338 + drop)), bore(0 * X, Z, 4.2)), "ram")
    put(drawing, "stop screw", screw((0, 0, 338 + drop), -Z, 4, 24), "ram")
    cover = cut(box((-50, -29, 203), (50, -15.1, 297)), *(bore(p, Y, 4.3, 30) for p in spots))
    trims = [at(0, -29, z) for z in (225, 275)]
    put(drawing, "cover", cut(cover, *(bore(p, Y, 3, 20) for p in trims)), "frame")
    for k, p in enumerate(spots):
        put(drawing, f"cover screw {k}", screw(p - 13.9 * Y, Y, 4, 30), "frame")
    for k, p in enumerate(trims):
        put(drawing, f"trim screw {k}", cyl(p - 8 * Y, Y, 3, 22), "cover")
        put(drawing, f"trim nut {k}", hexagon(p, -Y, 5, 4, 3), f"trim screw {k}")
    shaft = union(cyl(axle - 52.2 * X, X, 18, 104.4), cyl(axle + 52.2 * X, X, 14, 26))
    teeth = [cyl(axle + at(-16, 20.2 * np.cos(t), 20.2 * np.sin(t)), X, 2.6, 32) for t in np.arange(14) * np.pi / 7]
    shaft = cut(shaft, *teeth, cyl(axle - 53 * X, X, 4, 30), box(axle + at(56, -3, 10), axle + at(76, 3, 20)))
    put(drawing, "pinion shaft", shaft, "frame", "Revolute", axle, X)
    put(drawing, "end washer", tube(axle - 57.2 * X, X, 4.2, 26, 5), "pinion shaft")
    put(drawing, "end screw", screw(axle - 57.2 * X, X, 4, 25), "pinion shaft")
    way = at(0, -np.cos(0.6), np.sin(0.6))
    grip = axle + 97 * X
    hub = cut(
        cyl(axle + 52.3 * X, X, 30, 62), cyl(axle + 50 * X, X, 14, 29), box(axle + at(52, -3, 0), axle + at(78, 3, 17))
    )
    hub = cut(hub, bore(grip, way, 9 + play), cyl(axle + 62 * X, -way, 3, 40))
    put(drawing, "hub", hub, "pinion shaft")
    put(drawing, "key", box(axle + at(56, -3, 10), axle + at(76, 3, 16.8)), "pinion shaft")
    put(drawing, "hub screw", cyl(axle + 62 * X - 14 * way, -way, 3, 12), "hub")
    slide = grip - random.uniform(40, 90) * way
    put(drawing, "lever", cyl(slide, way, 9, 360), "hub", "Cylindrical", grip, way)
    for k, p in enumerate((slide, slide + 360 * way)):
        ball = cut(sphere(p - (8 if k == 0 else -8) * way, 16), cyl(slide, way, 9, 360))
        put(drawing, f"lever ball {k}", ball, "lever")
    slots = [box((-w, 20, 0), (w, 90, 90)).rotate((0, 0, 0), (0, 0, 1), 90 * k) for k, w in enumerate((6, 10, 15, 20))]
    anvil = cut(cyl(plate, Z, 70, 22), bore(0 * X, Z, 10 + play), *slots)
    put(drawing, "anvil", anvil, "frame", "Revolute", plate, Z)
    put(drawing, "anvil pin", cyl(10 * Z, Z, 10, 51), "frame")
    return drawing


@kind
def table_loom(random):
    """Side boards with tenoned rails, four shafts in grooves on ties to levers, rollers with ratchets, a batten."""
    drawing, play = Drawing(["left side"]), random.choice([0.2, 0.4])
    lifts = random.uniform(-12, 12, 4)
    rails = [((-22, 60), (20, 20)), ((20, 12), (30, 40)), ((400, 60), (20, 20))]
    rods = {"cloth": at(0, 70, 75), "warp": at(0, 350, 75)}
    ys, pivot, swing = [190 + 18.0 * k for k in range(4)], at(60, 0, 375), at(0, 135, 30)
    for s, name in ((-1, "left"), (1, "right")):
        side = union(box((s * 200, -30, 0), (s * 216, 430, 130)), box((s * 200, 175, 100), (s * 216, 275, 320)))
        side = cut(side, *(box((s * 190, y - 5 - play, 60), (s * 206, y + 5 + play, 310)) for y in ys))
        side = cut(
            side, *(bore(p + s * 208 * X, X, 10 + play, 12) for p in rods.values()), bore(swing + s * 208 * X, X, 3, 12)
        )
        for (y, z), (w, h) in rails:
            side = cut(side, box((s * 199, y + 4, z + 3), (s * 217, y + w - 4, z + h - 3)))
        for p in rods.values():
            side = cut(side, bore(p + at(s * 208, 0, 36), X, 2.5, 12)) if s > 0 else side
        drawing.add(f"{name} side", cut(side, *(cyl((s * 208, y, 280), Z, 2, 50) for y in (195, 255))))
    for k, ((y, z), (w, h)) in enumerate(rails):
        rail = union(box((-200, y, z), (200, y + w, z + h)), box((-216, y + 4, z + 3), (216, y + w - 4, z + h - 3)))
        put(drawing, f"rail {k}", rail, "left side")
        drawing.joint("Weld", f"rail {k}", "right side")
    top = box((-216, 175, 320), (216, 275, 332))
    top = cut(
        top,
        *(box((-8, y - 5, 310), (8, y + 5, 340)) for y in ys),
        *(bore((s * 208, y, 326), Z, 2.2, 9) for s in (-1, 1) for y in (195, 255)),
    )
    ends = [box(pivot + at(-10, y, -43), pivot + at(10, y + 8, 12)) for y in (176, 266)]
    put(drawing, "top", cut(union(top, *ends), bore(pivot, Y, 4)), "left side")
    for s in (-1, 1):
        for y in (195, 255):
            part = screw((s * 208, y, 332), -Z, 2, 50)
            put(drawing, f"top screw {s} {y}", part, "left side" if s < 0 else "right side")
    put(drawing, "lever rod", cyl(pivot + 174 * Y, Y, 4, 102), "top")
    for k, (y, lift) in enumerate(zip(ys, lifts, strict=True)):
        shaft = cut(
            box((-205.5, y - 5, 80 + lift), (205.5, y + 5, 215 + lift)),
            box((-190, y - 9, 92 + lift), (190, y + 9, 203 + lift)),
        )
        hook = at(0, y, 228 + lift)
        shaft = union(shaft, box((-7, y - 2.4, 210 + lift), (7, y + 2.4, 235 + lift)))
        put(drawing, f"shaft {k}", cut(shaft, bore(hook, Y, 2, 9)), "left side", "Prismatic", hook, Z)
        rise = np.arcsin(lift / 60)
        tip = pivot + y * Y + 60 * at(-np.cos(rise), 0, np.sin(rise))
        handle = pivot + y * Y - 130 / 60 * (tip - pivot - y * Y)
        lever = solid_bar(tip - y * Y, handle - y * Y, 8, 2.4, 2).translate((0, y, 0))
        put(drawing, f"lever {k}", cut(lever, bore(pivot, Y, 4 + play / 2)), "lever rod", "Revolute", pivot, Y)
        tie = upright(hook - y * Y, tip - y * Y, 5, 2.5, 4.2, 2 + play / 4)
        half = (hook + tip) / 2
        tie = union(tie.translate((0, y, 0)), box(half + at(-4, -3, -20), half + at(4, 3, 0)))
        put(drawing, f"tie {k}", tie, f"lever {k}", "Revolute", tip, Y)
        drawing.joint("Revolute", f"tie {k}", f"shaft {k}", hook, Y)
        for name, p, host in (("upper", tip, "lever"), ("lower", hook, "shaft")):
            put(drawing, f"{name} pin {k}", cyl(p - 4.2 * Y, Y, 2, 8.4), f"{host} {k}")
    for name, p in rods.items():
        roller = union(cyl(p - 199.5 * X, X, 20, 399), cyl(p - 220 * X, X, 10, 463))
        put(drawing, f"{name} roller", roller, "left side", "Revolute", p, X)
        notches = [box((-1, 20, -3), (20, 26, 3)).rotate((0, 0, 0), (1, 0, 0), 30 * k) for k in range(12)]
        ratchet = cut(cyl(0 * X, X, 25, 8), *notches, bore(0 * X, X, 10))
        put(drawing, f"{name} ratchet", ratchet.translate(tuple(p + 216.5 * X)), f"{name} roller")
        put(
            drawing,
            f"{name} crank",
            cut(
                union(
                    box(p + at(226, -6, -60), p + at(236, 6, 12)),
                    cyl(p + at(226, 0, 0), X, 16, 10),
                    cyl(p + at(236, 0, -52), X, 6, 40),
                ),
                bore(p, X, 10, 600),
            ),
            f"{name} roller",
        )
        q = p + at(216, 0, 36)
        pawl = laid(
            union(bar((0, 0), (22, -4), 5, 0.5, 7.5), sheet(((20, -9), (27, -5), (24, -15), (22, -14)), 0.5, 7.5)),
            q,
            Y,
            X,
        )
        put(drawing, f"{name} pawl", cut(pawl, bore(q, X, 4 + play)), "right side", "Revolute", q, X)
        pin = union(cyl(q - 14 * X, X, 2.5, 14), cyl(q, X, 4, 8), cyl(q + 8 * X, X, 7, 3))
        put(drawing, f"{name} pawl screw", pin, "right side")
    batten = [box((s * 199.6, 125, 20), (s * 186, 145, 210)) for s in (-1, 1)] + [
        box((-196, 123, z), (196, 147, z + 22)) for z in (90, 190)
    ]
    slot = box((-180, 132, 106), (180, 138, 196))
    put(drawing, "batten", cut(union(*batten), slot, bore(swing, X, 4 + play)), "left side", "Revolute", swing, X)
    put(drawing, "reed", slot, "batten")
    for s in (-1, 1):
        pin = union(
            cyl(swing + s * 200 * X, s * X, 3, 14),
            cyl(swing + s * 200 * X, -s * X, 4, 15),
            cyl(swing + s * 185 * X, -s * X, 8, 3),
        )
        put(drawing, f"batten screw {s}", pin, "left side" if s < 0 else "right side")
    return drawing


@kind
def camera_jib(random):
    """A post, a housing on bearings, cheeks with two parallel beams on bushes, a head, weights, a camera mount."""
    drawing, play, tilt = Drawing(["base"]), random.choice([0.03, 0.1]), random.uniform(-0.25, 0.45)
    way, p, q = at(np.cos(tilt), 0, np.sin(tilt)), at(0, 0, 110), at(0, 0, 180)
    long = random.uniform(650, 850)
    tail, front, high = p - 280 * way, p + long * way, q + long * way
    spots = hollow(0 * X, Z, 43, 4, np.pi / 4)
    base = union(cyl(-90 * Z, Z, 75, 12), cyl(-80 * Z, Z, 25, 24), cyl(-58 * Z, Z, 17, 58))
    feet = [bore(at(x, y, -85), Z, 5, 20) for x in (-42, 42) for y in (-42, 42)]
    drawing.add("base", cut(base, cyl(-20 * Z, Z, 4, 40), *feet))
    housing = union(cyl(-55 * Z, Z, 38, 55), cyl(-8 * Z, Z, 50, 8))
    housing = cut(housing, bore(0 * X, Z, 22), *(cyl(z * Z, Z, 30, 14) for z in (-56, -14)), cyl(-30 * Z, -Y, 5, 50))
    housing = cut(housing, *(cyl(s - 9 * Z, Z, 2.5, 10) for s in spots))
    put(drawing, "housing", housing, "base", "Revolute", 0 * X, Z)
    for k, z in enumerate((-56, -14)):
        put(drawing, f"pan bearing {k}", tube(z * Z, Z, 17, 30, 14), "housing")
    put(drawing, "pan washer", tube(0 * Z, Z, 4.2, 21, 3), "base")
    put(drawing, "pan screw", screw(3 * Z, -Z, 4, 20), "base")
    brake = union(cyl((0, -17.2, -30), -Y, 5, 40), cyl((0, -50, -30), -Y, 13, 16))
    put(drawing, "brake screw", brake, "housing")
    plate = cut(box((-48, -48, 0), (48, 48, 12)), bore(0 * X, Z, 24), *(bore(s, Z, 2.7) for s in spots))
    cheeks = upright(at(0, 0, 32), q, 24, 20, 28, 6)
    fulcrum = cut(union(plate, cheeks), bore(p, Y, 8), bore(q, Y, 6))
    put(drawing, "fulcrum", fulcrum, "housing")
    for k, s in enumerate(spots):
        put(drawing, f"fulcrum screw {k}", screw(s + 12 * Z, -Z, 2.5, 19), "housing")
    lower = cut(solid_bar(tail, front, 18, 15, 12), bore(p, Y, 12))
    put(drawing, "lower beam", lower, "fulcrum", "Revolute", p, Y)
    put(drawing, "upper beam", solid_bar(q, high, 10, 8, 9), "fulcrum", "Revolute", q, Y)
    head = union(upright(front - 70 * Z, high, 20, 20, 28, 8), box(front + at(-20, -28, -95), front + at(20, 28, -58)))
    head = cut(head, bore(front, Y, 8), cyl(high - 40 * Y, Y, 6, 80), cyl(front - 96 * Z, Z, 6, 30))
    put(drawing, "head", head, "lower beam", "Revolute", front, Y)
    drawing.joint("Revolute", "head", "upper beam", high, Y)
    for name, o, host, beam, half, outer, radius in (
        ("lower rear", p, "fulcrum", "lower beam", 15, 12, 8),
        ("lower front", front, "head", "lower beam", 15, 12, 8),
        ("upper rear", q, "fulcrum", "upper beam", 8, 9, 6),
        ("upper front", high, "head", "upper beam", 8, 9, 6),
    ):
        put(drawing, f"{name} bush", tube(o - half * Y, Y, radius + play, outer, 2 * half), beam)
        for s, side in ((-1, "right"), (1, "left")):
            put(drawing, f"{name} {side} spacer", tube(o + s * half * Y, s * Y, radius, outer + 2, 20 - half), host)
        bolt = union(cyl(o - 28 * Y, Y, radius, 58 + radius), hexagon(o - 28 * Y, -Y, 1.6 * radius, 0.7 * radius))
        put(drawing, f"{name} bolt", bolt, host)
        put(drawing, f"{name} nut", hexagon(o + 28 * Y, Y, 1.6 * radius, radius, radius), f"{name} bolt")
    put(drawing, "weight bar", cyl(tail - 90 * Y, Y, 12, 180), "lower beam")
    for s, side in ((-1, "right"), (1, "left")):
        put(drawing, f"{side} weight", tube(tail + s * 15 * Y, s * Y, 12, 60, 45), "weight bar")
        collar = cut(tube(tail + s * 60 * Y, s * Y, 12, 20, 14), cyl(tail + s * 67 * Y, Z, 3, 30))
        put(drawing, f"{side} collar", collar, "weight bar")
    mount = [((-30, -50, -107), (30, 50, -97)), ((-30, 42, -220), (30, 50, -97)), ((-30, -50, -220), (30, 50, -212))]
    mount = union(*(box(front + at(*low), front + at(*top)) for low, top in mount))
    mount = cut(mount, cyl(front - 110 * Z, Z, 6 + play, 20), cyl(front - 225 * Z, Z, 3.3, 20))
    put(drawing, "camera mount", mount, "head", "Revolute", front, Z)
    put(drawing, "mount washer", tube(front - 97 * Z, Z, 6, 18, 2), "head")
    put(drawing, "mount bolt", screw(front - 107.1 * Z, Z, 6, 40), "head")
    camera = union(box(front + at(-40, -40, -212), front + at(50, 38, -150)), cyl(front + at(50, 0, -180), X, 26, 45))
    put(drawing, "camera", cut(camera, cyl(front - 213 * Z, Z, 3.1, 12)), "camera mount")
    put(drawing, "camera screw", screw(front - 220 * Z, Z, 3.1, 18), "camera")
    return drawing
