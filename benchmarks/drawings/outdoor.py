"""What stands in a yard: an engine crane on casters, a solar tracker on a post."""

from __future__ import annotations

import numpy as np

from drawings.actuated import cheeks, screws, weld
from drawings.drawing import Drawing, kind
from drawings.folding import both_sides, circlip
from drawings.guided import hollow
from drawings.pivoted import welds
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
    torus,
    tube,
    union,
)  # fmt: skip

DOWN = -Y
"""The normal of what is drawn flat and then set upright, x forward and y up."""


@kind
def car_jack_bottle_crane(random):
    """An engine crane: legs and mast on a base, a boom that is pulled out, a long jack, a hook, rollers and casters."""
    drawing, play, gap = Drawing(["base"]), random.choice([0.05, 0.1, 0.2]), random.choice([0.1, 0.2, 0.5])
    rise, top, foot = random.uniform(0.0, 0.3), at(0, 0, 1225), at(62, 0, random.uniform(460, 500))
    way, up = at(np.cos(rise), 0, np.sin(rise)), at(-np.sin(rise), 0, np.cos(rise))
    crown, bolt = top + 380 * way - 46 * up, top + 880 * way
    ram = (crown - foot) / np.linalg.norm(crown - foot)
    span, anchors = float(np.linalg.norm(crown - foot)), [at(0, y, 128) for y in (-60, 60)]
    base = [cut(box((-30, -240, 60), (30, 240, 120)), box((-25, -250, 65), (25, 250, 115)))]
    base += [cyl(p - 13 * Z, -Z, 12, 12) for p in anchors]
    holes = [bore(p, Z, 6, 35) for p in anchors]
    for s, name in ((-1, "left"), (1, "right")):
        side, hinge, lock, end = s * Y, at(60, s * 302, 88), at(0, s * 302, 88), at(1120, s * 294, 5)
        base += [box((-45, s * y, 60), (90, s * (y + 6), 126)) for y in (238, 296)]
        base.append(box((-45, s * 238, 120), (90, s * 302, 126)))
        tie = [cyl(p + 5 * side, -side, 8, 90) for p in (hinge, lock)]
        holes += [*tie, cyl((0, s * 190, 58), Z, 11, 9)]
        leg = cut(box((-35, s * 246, 64), (1080, s * 294, 112)), box((-36, s * 250, 68), (1081, s * 290, 108)))
        leg = union(leg, *(box((1030, s * y, -10), (1140, s * (y + 5), 80)) for y in (246, 289)))
        drawing.add(f"{name} leg", cut(leg, *tie, bore(end, Y, 8, 100)))
        drawing.add(f"{name} hinge bolt", headed(hinge, -side, 8, 76))
        drawing.add(f"{name} hinge nut", hexagon(hinge - 64 * side, -side, 12, 8, 8))
        drawing.add(f"{name} lock pin", headed(lock, -side, 7.8, 70))
        drawing.add(f"{name} roller", tube(end - 43 * side, side, 8 + play, 35, 38))
        drawing.add(f"{name} roller bolt", headed(end, -side, 8, 60))
        drawing.add(f"{name} roller nut", hexagon(end - 48 * side, -side, 12, 8, 8))
        king, pads = at(0, s * 190, 0), [at(x, s * 190 + y, 60) for x in (-19, 19) for y in (-19, 19)]
        holes += [bore(p, Z, 4, 8) for p in pads]
        plate = box(king + at(-28, -28, 55), king + at(28, 28, 60))
        drawing.add(f"{name} caster plate", cut(plate, bore(king, Z, 6), *(bore(p, Z, 4, 8) for p in pads)))
        drawing.add(f"{name} king pin", rivet(king + 49.9 * Z, Z, 6, 10.1))
        turn, axle = random.uniform(-180, 180), at(-22, 0, 2)
        fork = [box((-22, -18, 49.9), (20, 18, 54.9)), *(box((-36, t * 14, -8), (6, t * 18, 54.9)) for t in (-1, 1))]
        caster = {"fork": cut(union(*fork), bore(0 * X, Z, 6 + play), bore(axle, Y, 5))}
        dishes = [tube(axle + t * 12.1 * Y, -t * Y, 12, 24, 4) for t in (-1, 1)]
        caster["wheel"] = cut(tube(axle - 12 * Y, Y, 5 + play, 32, 24), *dishes)
        caster["axle"] = rivet(axle - 18 * Y, Y, 5, 36)
        for part, shape in caster.items():
            shape = shape.rotate((0, 0, 0), (0, 0, 1), float(turn)).translate(tuple(king.tolist()))
            drawing.add(f"{name} caster {part}", shape)
        about = at(-np.sin(np.radians(turn)), np.cos(np.radians(turn)), 0)
        drawing.joint("Revolute", f"{name} caster fork", f"{name} caster plate", king, Z)
        at_wheel = king + 2 * Z + 22 * np.cross(Z, about)
        drawing.joint("Revolute", f"{name} caster wheel", f"{name} caster fork", at_wheel, about)
        drawing.joint("Revolute", f"{name} roller", f"{name} leg", end, Y)
        welds(drawing, f"{name} leg > base", f"{name} caster plate > base", f"{name} hinge nut > {name} hinge bolt")
        welds(drawing, f"{name} hinge bolt > base", f"{name} roller bolt > {name} leg")
        welds(drawing, f"{name} roller nut > {name} roller bolt")
    drawing.add("base", cut(union(*base), *holes))
    mast = cut(box((-30, -31, 128), (30, 31, 1150)), box((-25, -26, 127), (25, 26, 1151)))
    cheeks = [box((-30, s * 26, 1149), (30, s * 31, 1255)) for s in (-1, 1)]
    cheeks += [box((29, s * 12, foot[2] - 18), (80, s * 18, foot[2] + 18)) for s in (-1, 1)]
    mast = union(mast, *cheeks, box((-30, -85, 120), (30, 85, 128)))
    drawing.add("mast", cut(mast, bore(top, Y, 8), bore(foot, Y, 8), *(bore(p, Z, 6.5, 12) for p in anchors)))
    for k, p in enumerate(anchors):
        drawing.add(f"mast bolt {k}", screw(p, -Z, 6, 28))
        welds(drawing, f"mast bolt {k} > base")
    boom = cut(box((-35, -28, -25), (560, 28, 25)), box((40, -24, -21), (570, 24, 21)))
    boom = union(boom, *(box((358, -64, s * 12), (402, -27, s * 17)) for s in (-1, 1)))
    own = {"boom": cut(boom, bore(0 * X, Z, 12), bore((380, -46, 0), Z, 8), bore((520, 0, 0), Z, 6.2))}
    tip = cut(box((300, gap - 24, gap - 21), (900, 24 - gap, 21 - gap)), box((290, -19, -17), (910, 19, 17)))
    tip = cut(tip, box((835, -30, -9), (910, -10, 9)), *(bore((x, 0, 0), Z, 6.2) for x in (360, 440, 520)))
    own["boom tip"] = cut(tip, bore((880, 0, 0), Z, 6))
    own["boom bush"] = tube((0, 0, -25), Z, 8 + play, 12, 50)
    own["tip pin"] = headed((520, 0, 25), -Z, 6, 58)
    own["hook bolt"] = headed((880, 0, 21 - gap), -Z, 6, 52)
    own["hook nut"] = hexagon((880, 0, gap - 21), -Z, 9, 8, 6)
    for name, shape in own.items():
        drawing.add(name, laid(shape, top, way, DOWN))
    drawing.add("boom bolt", headed(top - 31 * Y, Y, 8, 80))
    drawing.add("boom nut", hexagon(top + 31 * Y, Y, 12, 12, 8))
    hook = union(bar((0, 0), (0, -75), 10, -6, 6), cyl((0, 0, -15.5), Z, 13, 31), tube((0, -98, -6), Z, 15, 26, 12))
    hook = cut(hook, box((6, -98, -9), (50, -78, 9)), cyl((0, -98, -9), Z, 15, 20), bore(0 * X, Z, 6 + play))
    drawing.add("hook", laid(hook, bolt, X, DOWN))
    half, pump = 0.5 * span, at(100, -50, 0)
    can = [cyl(foot - 11.5 * Y, Y, 16, 23), cyl(foot, ram, 10, 40), cyl(foot + 34 * ram, ram, 30, half)]
    can.append(laid(box((45, -62, -10), (115, -20, 10)), foot, ram, DOWN))
    hollows = [cyl(foot + 46 * ram, ram, 20, half), cyl(foot + (16 + half) * ram, ram, 24, 20), bore(foot, Y, 8 + play)]
    drawing.add("barrel", cut(union(*can), *hollows, bore(foot + 100 * ram - 50 * np.cross(DOWN, ram), Y, 5)))
    gland = union(cyl(foot + (16 + half) * ram, ram, 24, 18), cyl(foot + (34 + half) * ram, ram, 28, 6))
    drawing.add("gland", cut(gland, bore(foot, ram, 13 + play, 900)))
    rod = [cyl(foot + 80 * ram, ram, 13, span - 108), cyl(foot + 80 * ram, ram, 20 - play / 2, 15)]
    rod.append(cyl(crown, -ram, 10, 40))
    drawing.add("ram", cut(union(*rod, cyl(crown - 11.5 * Y, Y, 15, 23)), bore(crown, Y, 8 + play)))
    drawing.add("foot pin", headed(foot - 18 * Y, Y, 8, 42))
    drawing.add("crown pin", headed(crown - 17 * Y, Y, 8, 40))
    lean, fork = at(0.3, -0.95, 0), both_sides(pump, at(118, -112, 0), 9, 10.5, 15, (pump,), 5 + play)
    handle = union(*fork, cyl((114, -98, 0), lean, 15, 70))
    drawing.add("pump lever", laid(cut(handle, cyl((121, -120, 0), lean, 10, 70)), foot, ram, DOWN))
    drawing.add("pump pin", laid(headed(pump + 15 * Z, -Z, 5, 33), foot, ram, DOWN))
    welds(drawing, "mast > base", "boom bush > boom", "boom tip > boom", "gland > barrel")
    welds(drawing, "boom bolt > mast", "boom nut > boom bolt", "hook bolt > boom tip", "hook nut > hook bolt")
    drawing.joint("Revolute", "boom", "mast", top, Y)
    drawing.joint("Revolute", "barrel", "mast", foot, Y)
    drawing.joint("Cylindrical", "ram", "barrel", foot, ram)
    drawing.joint("Revolute", "ram", "boom", crown, Y)
    drawing.joint("Revolute", "pump lever", "barrel", foot + 100 * ram - 50 * np.cross(DOWN, ram), Y)
    drawing.joint("Revolute", "hook", "boom tip", bolt, Y)
    return drawing


@kind
def solar_tracker(random):
    """A post with a slewing ring, a yoke with a torque tube, rails on U-bolts, a panel, an actuator on clevises."""
    drawing, play, tilt = Drawing(["post"]), random.choice([0.05, 0.1, 0.2]), random.uniform(12, 32)
    up, low = at(0, 0, random.uniform(195, 215)), at(-175, 0, 48)

    def tilted(shape):
        return shape.rotate(tuple(up), tuple(up + Y), tilt)

    c, s = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    level = at(-60, 0, -15)
    high, drive = up + at(c * level[0] + s * level[2], 0, c * level[2] - s * level[0]), at(92, 0, 0)
    ring, plate = hollow(0 * X, Z, 66, 6), hollow(at(0, 0, 30), Z, 47, 4, 0.8)
    post = union(cyl(-12 * Z, Z, 78, 12), cyl(-250 * Z, Z, 36, 245), box((-100, -100, -262), (100, 100, -250)))
    feet = [bore((x, y, -256), Z, 7, 20) for x in (-80, 80) for y in (-80, 80)]
    drawing.add("post", cut(post, bore(0 * X, Z, 30), *feet, *(bore(p, Z, 4, 20) for p in ring)))
    race = torus(10 * Z, Z, 55, 4)
    drawing.add("outer ring", cut(tube(0 * X, Z, 55.5, 76, 18), race, *(bore(p, Z, 4, 30) for p in ring)))
    drawing.add("inner ring", cut(tube(2 * Z, Z, 40, 54.5, 18), race, *(cyl(p - 24 * Z, Z, 2.5, 20) for p in plate)))
    drawing.add("slew balls", union(*(sphere(p, 4) for p in hollow(10 * Z, Z, 55, 14))))
    table = [cyl(20 * Z, Z, 80, 10), box((-200, -22, 20), (100, 22, 30)), box((68, -42, 20), (112, 42, 30))]
    table += [cheeks(up, at(0, 0, 50), 25, 36, 46), box((-190, -14, 30), (-160, 14, 48)), cyl(low - 14 * Y, Y, 12, 28)]
    table = cut(
        union(*table), box((-220, -6.3, 30), (-150, 6.3, 70)), bore(up, Y, 19), bore(low, Y, 5), bore(0 * X, Z, 30)
    )
    feet = [drive + at(0, y, 36) for y in (-31, 31)]
    holes = [bore(p, Z, 3.3, 12) for p in plate] + [bore(drive, Z, 8, 40)] + [cyl(p - 16 * Z, Z, 2.1, 14) for p in feet]
    drawing.add("turntable", cut(table, *holes))
    screws(drawing, "turntable screw", plate, -Z, 3, 22, "turntable")
    motor = cut(
        union(cyl(drive + 30 * Z, Z, 22, 85), bar(feet[0], feet[1], 10, 30, 36)), cyl(drive, Z, 6 + play / 4, 90)
    )
    drawing.add("slew motor", cut(motor, *(bore(p, Z, 2.7, 7) for p in feet)))
    screws(drawing, "slew motor screw", feet, -Z, 2.5, 14, "turntable")
    drawing.add("slew shaft", cyl(drive + 3 * Z, Z, 6, 80))
    drawing.add("pinion", cut(tube(drive + 3.5 * Z, Z, 6, 15.5, 14), cyl(drive + 10.5 * Z, X, 2, 20)))
    drawing.add("pinion screw", cut(cyl(drive + at(6, 0, 10.5), X, 2, 6), hexagon(drive + at(9, 0, 10.5), X, 1, 4)))
    for side, y in (("left", Y), ("right", -Y)):
        bush = union(cyl(up + 36 * y, y, 19, 10), cyl(up + 46 * y, y, 23, 3))
        drawing.add(f"{side} bush", cut(bush, bore(up, Y, 16 + play, 60)))
        collar = tube(up + 49.2 * y, y, 16, 25, 10)
        drawing.add(f"{side} collar", tilted(cut(collar, cyl(up + 54.2 * y, X, 2.5, 30))))
        saddle, legs = up + 90 * y, [up + 90 * y + x * X for x in (-19, 19)]
        block = box(saddle + at(-27, -10, 3), saddle + at(27, 10, 28))
        drawing.add(f"{side} saddle", tilted(cut(block, bore(up, Y, 16), *(bore(p, Z, 3.2, 60) for p in legs))))
        bend = cut(torus(saddle, Y, 19, 3), box(saddle + at(-30, -9, 0), saddle + at(30, 9, 30)))
        drawing.add(f"{side} U-bolt", tilted(union(bend, *(cyl(p, Z, 3, 42) for p in legs))))
        rail = box(saddle + at(-150, -15, 28), saddle + at(150, 15, 58))
        rail = cut(rail, box(saddle + at(-151, -12, 31), saddle + at(151, 12, 55)))
        rail = cut(rail, box(saddle + at(-151, 0, 31) - 15.5 * y, saddle + at(151, 0, 55)))
        taps = [bore(saddle + at(x, 0, 58), Z, 3, 6) for x in (-145, 145)]
        drawing.add(f"{side} rail", tilted(cut(rail, *(bore(p, Z, 3.2, 40) for p in legs), *taps)))
        for number, p in enumerate(legs):
            drawing.add(f"{side} nut {number}", tilted(hexagon(p + 31 * Z, Z, 5, 5, 3)))
        weld(drawing, "turntable", f"{side} bush")
        for part in ("collar", "saddle", "rail"):
            weld(drawing, "torque tube", f"{side} {part}")
        weld(drawing, f"{side} rail", f"{side} U-bolt")
    drawing.add("torque tube", tilted(cut(tube(up - 112 * Y, Y, 12, 16, 224), bore(up, Z, 3, 30))))
    lever = cut(
        union(cheeks(up, up + level, 12, 0, 6), cyl(up - 10 * Y, Y, 24, 20)), bore(up, Y, 16), bore(up, Z, 3, 40)
    )
    drawing.add("lever", tilted(cut(lever, bore(up + level, Y, 5 + play))))
    drawing.add("lever bolt", tilted(headed(up + 24 * Z, -Z, 3, 56)))
    drawing.add("lever nut", tilted(hexagon(up - 24 * Z, -Z, 5, 5, 3)))
    frame = cut(box((-170, -130, 58), (170, 130, 78)), box((-166, -126, 61), (166, 126, 80)))
    frame = cut(
        frame, box((-125, -85, 50), (125, 85, 70)), *(bore((x, y, 58), Z, 3, 9) for x in (-145, 145) for y in (-90, 90))
    )
    drawing.add("panel frame", tilted(frame.translate(tuple(up))))
    drawing.add("panel", tilted(box(up + at(-166, -126, 61), up + at(166, 126, 65))))
    way, span = (high - low) / np.linalg.norm(high - low), float(np.linalg.norm(high - low))
    out, end = np.cross(way, Y), 16 + 0.5 * span
    gear = laid(bar((0, 0), (36, 0), 19, 0, 18), low + 16 * way, out, way)
    barrel = union(
        cyl(low - 6 * Y, Y, 11, 12), cyl(low + 7 * way, way, 6, 10), gear, cyl(low + 16 * way, way, 17, end - 16)
    )
    fit = cyl(low + 29 * way + 36 * out, way, 5, 6)
    drawing.add("barrel", cut(barrel, bore(low, Y, 5 + play), cyl(low + 26 * way, way, 12, span), fit))
    drawing.add("actuator motor", union(cyl(low + 34 * way + 36 * out, way, 18, 62), fit))
    drawing.add("nose bush", tube(low + (end - 14) * way, way, 7 + play / 2, 12.01, 14))
    rod = union(cyl(low + 40 * way, way, 7, span - 81), cyl(low + 40 * way, way, 12 - play, 10))
    drawing.add("actuator rod", union(rod, cyl(high - 42 * way, way, 5, 22)))
    drawing.add("lock nut", hexagon(high - 39 * way, way, 8, 5, 5))
    fork = cut(
        union(cyl(high - 34 * way, way, 13, 34), cyl(high - 13 * Y, Y, 12, 26)), cyl(high - 6.3 * Y, Y, 17.5, 12.6)
    )
    drawing.add("clevis", cut(fork, bore(high, Y, 5), cyl(high - 40 * way, way, 4.25, 40)))
    for name, p, half in (("low", low, 14.0), ("high", high, 13.0)):
        pin = headed(p - half * Y, Y, 5, 2 * half + 3)
        drawing.add(f"{name} pin", grooved(pin, p + (half + 0.1) * Y, Y, 5))
        drawing.add(f"{name} circlip", circlip(p + (half + 0.1) * Y, Y, 5))
    drawing.joint("Revolute", "inner ring", "outer ring", 10 * Z, Z)
    drawing.joint("Revolute", "slew shaft", "slew motor", drive, Z)
    drawing.joint("Revolute", "torque tube", "turntable", up, Y)
    drawing.joint("Revolute", "barrel", "turntable", low, Y)
    drawing.joint("Cylindrical", "actuator rod", "barrel", low, way)
    drawing.joint("Revolute", "clevis", "lever", high, Y)
    weld(drawing, "post", "outer ring")
    weld(drawing, "turntable", "inner ring", "slew motor")
    weld(drawing, "slew shaft", "pinion")
    weld(drawing, "pinion", "pinion screw")
    weld(drawing, "torque tube", "lever")
    weld(drawing, "lever", "lever bolt")
    weld(drawing, "left rail", "panel frame")
    weld(drawing, "panel frame", "panel")
    weld(drawing, "barrel", "actuator motor", "nose bush")
    weld(drawing, "actuator rod", "clevis", "lock nut")
    return drawing
