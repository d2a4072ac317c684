"""What a lever or a handle works: a mortise lock in a door, a plate shear, a floating brake caliper."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
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
    tube,
    union,
)  # fmt: skip


@kind
def door_lock(random):
    """A lock in a door: a latch, a bolt, a follower on a square spindle, handles in roses, a cylinder with a cam."""
    drawing, play = Drawing(["door"]), random.choice([0.05, 0.15])
    middle, key, grip = at(0, 20, 0), at(-8, -48, 0), random.uniform(95, 115)
    door = cut(box((-110, -150, -12), (40, 150, 30)), box((-41, -81, 0), (60, 81, 21)))
    slot = union(cyl(key - 99 * Z, Z, 8.6, 200), box(key + at(-5.1, -22.1, -99), key + at(5.1, 0, 99)))
    forend = [at(43, y, 8.5) for y in (-95, 95)]
    roses = {"inner": (30, 1), "outer": (-12, -1)}
    spots = {name: [middle + at(x, 0, z) for x in (-18, 18)] for name, (z, _) in roses.items()}
    door = cut(door, bore(middle, Z, 12, 60), slot, *(cyl(p, -X, 1.8, 30) for p in forend))
    door = cut(door, *(cyl(p, -roses[name][1] * Z, 1.5, 10) for name, each in spots.items() for p in each))
    drawing.add("door", door)
    wall = cut(box((-40, -80, 0), (40, 80, 15)), box((-38, -78, 2), (38, 78, 20)))
    posts = [at(x, y, 15) for x in (-33, 33) for y in (-74, 74)]
    ribs = [box((-38, y, 1), (38, y + 3, 15)) for y in (2 - play, 35 + play, -28)]
    wall = union(wall, *ribs, *(cyl((p[0], p[1], 1), Z, 4, 14) for p in posts), box((40, -105, 0), (43, 105, 17)))
    openings = [box((35, 8 - 2 * play, 4 - play), (50, 32 + 2 * play, 13 + play)),
                box((35, -24 - 2 * play, 4 - play), (50, -3 + 2 * play, 13 + play))]  # fmt: skip
    wall = cut(wall, *openings, *(cyl(p, -Z, 1.5, 10) for p in posts), *(bore(p, X, 2, 5) for p in forend))
    key_screw = at(43, key[1] - 18, 8.5)
    wall = cut(wall, cyl(middle - Z, Z, 8 + play, 9), slot, bore(key_screw, X, 2.6, 9))
    drawing.add("case", wall)
    cover = cut(box((-40, -80, 15), (40, 80, 17)), bore(middle, Z, 8 + play, 40), slot)
    drawing.add("case cover", cut(cover, *(bore(p, Z, 1.6, 9) for p in posts)))
    for number, p in enumerate(posts):
        drawing.add(f"cover screw {number}", screw(p + 2 * Z, -Z, 1.5, 11))
    for number, p in enumerate(forend):
        drawing.add(f"forend screw {number}", screw(p, -X, 1.8, 25))
    follower = union(cyl(middle, Z, 8, 17), cyl(middle + 2.1 * Z, Z, 10.5, 12.8), bar(middle, (-12, 24), 3.5, 4, 13))
    hole = box(middle + at(-4.05, -4.05, -99), middle + at(4.05, 4.05, 99))
    drawing.add("follower", cut(follower, hole))
    latch = union(box((-30, 5, 2 + play), (32, 35, 15 - play)), box((30, 8, 4), (55, 32, 13)))
    latch = cut(latch, box((-24, 8, 0), (20, 33, 20)))
    nose = cq.Workplane().polyline([(45, 33), (58, 33), (58, 8)]).close().extrude(20)
    drawing.add("latch", cut(latch, nose))
    bolt = union(box((-30, play - 25, 2 + play), (25, 2 - 2 * play, 15 - play)), box((24, -24, 4), (46, -3, 13)))
    drawing.add("bolt", cut(bolt, box((-14, -30, 0), (-2, -17, 20))))
    barrel = union(cyl(key - 25 * Z, Z, 8.5, 68), box(key + at(-5, -22, -25), key + at(5, 0, 43)))
    barrel = cut(barrel, cyl(key + 20 * Z, Z, 6 + play, 40), box(key + at(-20, -14.5, 4), key + at(20, 20, 13)))
    barrel = cut(barrel, cyl(key + 5 * Z, Z, 5, 20), bore(key + at(0, -18, 8.5), X, 2.5, 8))
    drawing.add("cylinder", barrel)
    flat = box(key + at(-9, 2.5, 0), key + at(9, 9, 13))
    plug = union(cyl(key + 20 * Z, Z, 6, 24), cyl(key + 13 * Z, Z, 5 - play, 8), cyl(key + 43.1 * Z, Z, 8, 3))
    plug = union(plug, cut(cyl(key + 4.2 * Z, Z, 4, 9), flat), box(key + at(-9, -2, 45), key + at(9, 2, 75)))
    drawing.add("plug", plug)
    cam = union(cyl(key + 4.1 * Z, Z, 8, 8.8), bar(key, key + 10 * Y, 3, 4.1, 12.9))
    drawing.add("cam", cut(cam, bore(key, Z, 4, 30).cut(flat)))
    drawing.add("cylinder screw", screw(key_screw, -X, 2.5, 56))
    drawing.add("spindle", box(middle + at(-4, -4, -40), middle + at(4, 4, 58)).edges("|Z").chamfer(0.2))
    drawing.joint("Weld", "case", "door")
    drawing.joint("Weld", "case cover", "case")
    drawing.joint("Revolute", "follower", "case", middle, Z)
    drawing.joint("Prismatic", "spindle", "follower", middle, Z)
    for name, (z, s) in roses.items():
        face = middle + z * Z
        rose = tube(face, s * Z, 9.5 + play, 24, 6)
        drawing.add(f"{name} rose", cut(rose, *(bore(p, Z, 1.7, 60) for p in spots[name])))
        for number, p in enumerate(spots[name]):
            drawing.add(f"{name} rose screw {number}", screw(p + 6 * s * Z, -s * Z, 1.5, 14))
        low, high = sorted((z + s * 12, z + s * 22))
        handle = union(cyl(face + s * 0.2 * Z, s * Z, 9.5, 6), cyl(face + s * 6.1 * Z, s * Z, 13, 16))
        handle = union(handle, bar(middle, middle - grip * X, 8, low, high)).cut(hole)
        grub = face + s * 17 * Z + 4 * Y
        drawing.add(f"{name} handle", cut(handle, cyl(grub, Y, 2, 20)))
        drawing.add(f"{name} grub screw", cyl(grub, Y, 2, 8))
        drawing.joint("Weld", f"{name} rose", "door")
        drawing.joint("Weld", f"{name} handle", "spindle")
        drawing.joint("Revolute", f"{name} handle", f"{name} rose", middle, Z)
    drawing.joint("Prismatic", "latch", "case", 0 * X, X)
    drawing.joint("Prismatic", "bolt", "case", 0 * X, X)
    drawing.joint("Weld", "cylinder", "case")
    drawing.joint("Revolute", "plug", "cylinder", key, Z)
    drawing.joint("Weld", "cam", "plug")
    return drawing


@kind
def plate_shear(random):
    """A lever that pulls an arm with a blade past a blade on a frame, by two links on rivets and shoulder pins."""
    drawing, play = Drawing(["base"]), random.choice([0.05, 0.1, 0.2])
    pivot, fulcrum = at(-100, 30, 0), at(150, 160, 0)
    lift = random.uniform(0.1, 0.22)
    along, across = at(np.cos(lift), np.sin(lift), 0), at(-np.sin(lift), np.cos(lift), 0)
    end, short = pivot + 215 * along, fulcrum + at(-38, -12, 0)
    feet = [at(x, -60, 28) for x in (-90, 10, 110)]
    holes = [bore((x, -55, z), Y, 4.2, 9) for x in (-120, 60, 170) for z in (-20, 28)]
    base = cut(box((-140, -60, -60), (190, -50, 60)), *holes, *(bore(p, Y, 3.3, 30) for p in feet))
    drawing.add("base", base)
    outline = [(-130, -50), (180, -50), (180, 185), (125, 185), (85, 20), (-60, 20), (-60, 60), (-130, 60)]
    frame = union(
        cq.Workplane().polyline(outline).close().extrude(10).translate((0, 0, 8)), box((-130, -50, 8), (180, -40, 45))
    )
    low_bolts = [at(x, 10, 0) for x in (-60, 0, 50)]
    frame = cut(frame, bore(pivot, Z, 8, 30), bore(fulcrum, Z, 6, 30), *(bore(p, Z, 2.5, 30) for p in low_bolts))
    drawing.add("frame", cut(frame, *(cyl(p, Y, 3, 25) for p in feet)))
    for number, p in enumerate(feet):
        drawing.add(f"base screw {number}", screw(p, Y, 3, 18))
    blade = cut(box((-75, 0, 0), (70, 25, 8)), *(bore(p, Z, 2.7, 30) for p in low_bolts))
    drawing.add("lower blade", cut(blade, *(cyl(p - Z, Z, 4.2, 6.2) for p in low_bolts)))
    for number, p in enumerate(low_bolts):
        drawing.add(f"lower screw {number}", screw(p + 5.2 * Z, Z, 2.5, 12))
    arm = union(bar(pivot, end, 14, -18, -8), cyl(pivot - 18 * Z, Z, 22, 10))
    bolts = [pivot + t * along - 4 * across for t in (50, 95, 140)]
    arm = cut(arm, bore(pivot, Z, 8 + play, 30), bore(end, Z, 5 + play, 30), *(bore(p, Z, 2.5, 30) for p in bolts))
    drawing.add("arm", arm)
    edge = [pivot + t * along + h * across for t, h in ((35, -32), (160, -32), (160, 6), (35, 6))]
    blade = cq.Workplane().polyline([(p[0], p[1]) for p in edge]).close().extrude(7.95).translate((0, 0, -8))
    blade = cut(blade, *(bore(p, Z, 2.7, 30) for p in bolts), *(cyl(p - 5.2 * Z, Z, 4.2, 9) for p in bolts))
    drawing.add("upper blade", blade)
    for number, p in enumerate(bolts):
        drawing.add(f"upper screw {number}", screw(p - 5.2 * Z, -Z, 2.5, 12))
    drawing.add("pivot bolt", headed(pivot - 19.6 * Z, Z, 8, 50))
    drawing.add("pivot washer", tube(pivot - 18 * Z, -Z, 8.2, 13, 1.6))
    drawing.add("pivot spacer", tube(pivot - 7.9 * Z, Z, 8.1, 14, 15.9))
    drawing.add("pivot nut", hexagon(pivot + 18 * Z, Z, 12, 10, 8))
    lever = union(
        bar(fulcrum, short, 11, -18, -8),
        bar(fulcrum, fulcrum + at(190, 80, 0), 11, -18, -8),
        cyl(fulcrum - 18 * Z, Z, 18, 10),
    )
    tip = at(190, 80, 0) / np.hypot(190, 80)
    lever = cut(lever, bore(fulcrum, Z, 6 + play, 30), bore(short, Z, 5 + play, 30))
    drawing.add("lever", lever)
    sleeve = bar(fulcrum + 110 * tip, fulcrum + 220 * tip, 15, -22, -4)
    drawing.add("grip", cut(sleeve, bar(fulcrum, fulcrum + at(190, 80, 0), 11, -18, -8)))
    drawing.add("lever bolt", headed(fulcrum - 18.1 * Z, Z, 6, 46))
    drawing.add("lever spacer", tube(fulcrum - 7.9 * Z, Z, 6.1, 12, 15.9))
    drawing.add("lever nut", hexagon(fulcrum + 18 * Z, Z, 9, 9, 6))
    for name, low in (("front", -24), ("back", -7.9)):
        drawing.add(f"{name} link", bar(end, short, 9, low, low + 5.9, (end, short), 5))
    for name, p in (("lower", end), ("upper", short)):
        drawing.add(f"{name} pin", cut(headed(p - 24 * Z, Z, 5, 25), tube(p - 0.9 * Z, Z, 4, 6, 0.7)))
        drawing.add(f"{name} clip", cut(tube(p - 0.85 * Z, Z, 4, 7.5, 0.6), box(p + at(-2, 0, -3), p + at(2, 9, 3))))
    drawing.joint("Weld", "frame", "base")
    drawing.joint("Weld", "lower blade", "frame")
    drawing.joint("Weld", "upper blade", "arm")
    drawing.joint("Revolute", "arm", "frame", pivot, Z)
    drawing.joint("Revolute", "lever", "frame", fulcrum, Z)
    drawing.joint("Weld", "grip", "lever")
    drawing.joint("Revolute", "front link", "arm", end, Z)
    drawing.joint("Revolute", "front link", "lever", short, Z)
    drawing.joint("Revolute", "back link", "arm", end, Z)
    drawing.joint("Revolute", "back link", "lever", short, Z)
    return drawing


@kind
def brake_caliper(random):
    """A disc on a hub in a bearing, a carrier on the knuckle, pads in its grooves, a caliper on pins, a piston."""
    drawing, play = Drawing(["knuckle"]), random.choice([0.05, 0.1])
    mounts = [at(0, y, 56) for y in (-42, 42)]
    knuckle = union(cyl(-45 * X, X, 38, 30), box((-40, -55, 0), (-28, 55, 66)), box((-40, -30, -70), (-28, 30, 0)))
    knuckle = cut(knuckle, cyl(-43 * X, X, 30, 40), bore(0 * X, X, 26, 60), *(bore(p, X, 4.2, 60) for p in mounts))
    drawing.add("knuckle", cut(knuckle, *(bore((0, y, -58), X, 5, 60) for y in (-18, 18))))
    drawing.add("hub bearing", tube(-43 * X, X, 15, 30.01, 28))
    studs = [30 * at(0, np.cos(a), np.sin(a)) for a in np.arange(4) * np.pi / 2]
    sunk = [30 * at(0, np.cos(a), np.sin(a)) for a in (np.pi / 4, 5 * np.pi / 4)]
    hub = union(cyl(-15 * X, X, 20, 16), cyl(0 * X, X, 45, 8), cyl(-60 * X, X, 15, 61), cyl(7 * X, X, 20, 20))
    hub = cut(hub, *(bore(p, X, 6, 15) for p in studs), *(bore(p, X, 2.5, 15) for p in sunk))
    drawing.add("hub", hub)
    drawing.add("hub washer", tube(-43 * X, -X, 15.2, 23, 3))
    drawing.add("hub nut", hexagon(-46 * X, -X, 20, 12, 15))
    disc = cut(cyl(8 * X, X, 110, 10), bore(0 * X, X, 20 + play, 60), *(bore(p, X, 6.3, 60) for p in studs))
    disc = cut(disc, *(bore(p, X, 2.7, 60) for p in sunk), *(cyl(p + 12.5 * X, X, 4.2, 9) for p in sunk))
    drawing.add("disc", disc)
    for number, p in enumerate(studs):
        drawing.add(f"stud {number}", union(cyl(p, X, 6, 38), cyl(p, -X, 8, 4)))
    for number, p in enumerate(sunk):
        drawing.add(f"disc screw {number}", screw(p + 12.5 * X, -X, 2.5, 11.5))
    pins = {"front": at(0, -62, 105), "rear": at(0, 62, 105)}
    carrier = box((-28, -75, 45), (-16, 75, 125))
    carrier = union(
        carrier,
        *(box((-28, s * 40, 113), (40, s * 56, 125)) for s in (-1, 1)),
        *(cyl(p - 28 * X, X, 10, 38) for p in pins.values()),
    )
    groove = box((-99, -46 - play, 116 - play), (99, 46 + play, 120 + play))
    carrier = cut(
        carrier, box((-99, -40, 70), (99, 40, 140)), groove, *(cyl(p - 30 * X, X, 5 + play, 33) for p in pins.values())
    )
    drawing.add("carrier", cut(carrier, *(cyl(p - 30 * X, X, 4, 20) for p in mounts)))
    for number, p in enumerate(mounts):
        drawing.add(f"carrier screw {number}", screw(p - 40 * X, X, 4, 23))
    wear = random.uniform(0, 2)
    for name, back, face in (("inner", -10, 8), ("outer", 36 - wear, 18)):
        inward = 1 if name == "inner" else -1
        plate = box((back, -38, 74), (back + inward * 5, 38, 122))
        plate = union(plate, box((back, -46, 116), (back + inward * 5, 46, 120)))
        lining = cut(box((back + inward * 5, -34, 76), (face - inward * 0.1, 34, 108)), box((-99, -1, 0), (99, 1, 99)))
        drawing.add(f"{name} pad", union(plate, lining))
        drawing.joint("Prismatic", f"{name} pad", "carrier", 0 * X, X)
    heart = at(0, 0, 95)
    body = union(
        box((-60, -36, 72), (-14, 36, 138)),
        box((-60, -36, 124), (52, 36, 138)),
        box((36 - wear, -30, 80), (52, 30, 138)),
    )
    body = union(body, *(box((-46, s * 30, 95), (-38, s * 74, 117)) for s in (-1, 1)))
    body = cut(body, cyl(heart - 52 * X, X, 20, 60), *(bore(p, X, 3.2, 60) for p in pins.values()))
    bleed = at(-50, 0, 138)
    drawing.add("caliper", cut(body, cyl(bleed, -Z, 3, 30)))
    drawing.add("bleeder", union(cyl(bleed - 18 * Z, Z, 3, 30), hexagon(bleed + Z, Z, 4, 5)))
    drawing.add("piston", cut(cyl(heart - 44 * X, X, 20 - play / 2, 34), cyl(heart - 34 * X, X, 14, 40)))
    for name, p in pins.items():
        pin = union(cyl(p - 33 * X, X, 5, 35), hexagon(p - 38 * X, X, 6.5, 5))
        drawing.add(f"{name} guide pin", cut(pin, cyl(p - 38 * X, X, 3, 16)))
        drawing.add(f"{name} pin screw", screw(p - 46 * X, X, 3, 22))
        drawing.joint("Weld", f"{name} guide pin", "caliper")
    drawing.joint("Revolute", "hub", "knuckle", 0 * X, X)
    drawing.joint("Weld", "disc", "hub")
    drawing.joint("Weld", "carrier", "knuckle")
    drawing.joint("Prismatic", "caliper", "carrier", 0 * X, X)
    drawing.joint("Cylindrical", "piston", "caliper", heart, X)
    return drawing
