"""What is found on cycles and cars: a sprung rear end, wipers, a hand brake."""

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
    rivet,
    screw,
    sphere,
    torus,
    tube,
    union,
)  # fmt: skip


@kind
def bicycle_suspension(random):
    """A chain stay on bearings, a seat stay, two rocker plates on an axle, a shock with plain bushes and reducers."""
    drawing, play = Drawing(["frame"]), random.choice([0.03, 0.1])
    main, rocker = at(0, 0, 0), at(60, random.uniform(145, 160), 0)
    rear, stay, low, high = at(-350, -30, 0), at(-40, 165, 0), at(200, 40, 0), at(120, 190, 0)
    way, long = (high - low) / np.linalg.norm(high - low), float(np.linalg.norm(high - low))
    bosses = [cyl(main - 30 * Z, Z, 22, 60), cyl(rocker - 29 * Z, Z, 14, 58)]
    tubes = [cyl(main, rocker, 12, np.linalg.norm(rocker)), cyl(main, at(200, 12, 0), 10, 200)]
    lugs = [cyl(low + z * Z, Z, 12, 6) for z in (14, -20)]
    lugs += [box(low + at(-12, -28, z), low + at(12, 0, z + 6)) for z in (14, -20)]
    frame = union(*bosses, *tubes, box(low + at(-12, -28, -20), low + at(12, -15, 20)), *lugs)
    drawing.add("frame", cut(frame, bore(main, Z, 15), bore(rocker, Z, 9), bore(low, Z, 4)))
    for side, name in ((1, "left"), (-1, "right")):
        z = side * Z
        drawing.add(f"{name} main bearing", tube(main + 22 * z, z, 7.5, 15, 8))
        drawing.add(f"{name} main spacer", tube(main + 30 * z, z, 7.5, 10, 1))
        drawing.add(f"{name} rocker bush", tube(rocker + 17 * z, z, 6 + play, 9, 12))
        drawing.add(f"{name} rocker washer", tube(rocker + 29 * z, z, 6, 9, 1))
        drawing.add(f"{name} stay bearing", tube(rear + 31 * z, z, 4, 8, 11))
        drawing.add(f"{name} stay washer", tube(rear + 42 * z, z, 4, 6, 0.5))
        drawing.add(f"{name} stay screw", screw(rear + 50 * z, -z, 4, 26))
        drawing.add(f"{name} stay nut", hexagon(rear + 24.5 * z, z, 6.5, 6.5, 4))
        drawing.add(f"{name} seat bearing", tube(stay + 30 * z, z, 4, 8, 8))
        drawing.add(f"{name} seat spacer", tube(stay + 38 * z, z, 4, 6, 4.5))
        drawing.add(f"{name} seat screw", screw(stay + 50 * z, -z, 4, 27))
        drawing.add(f"{name} seat nut", hexagon(stay + 23.5 * z, z, 6.5, 6.5, 4))
        plate = union(*(bar(a, b, 15, *sorted((30 * side, 38 * side))) for a, b in ((rocker, stay), (rocker, high))))
        drawing.add(f"{name} rocker", cut(plate, bore(rocker, Z, 6), bore(stay, Z, 8), bore(high, Z, 3)))
        drawing.add(f"{name} rocker screw", headed(rocker + 38 * z, -z, 4, 16))
        drawing.add(f"{name} eye screw", screw(high + 38 * z, -z, 3, 20))
        drawing.add(f"{name} eye spacer", tube(high + 12 * z, z, 5, 8, 18))
    arms = both_sides(main, rear, 14, 31, 42, [main], 7.5)
    drawing.add(
        "chain stay", cut(union(*arms, box((-70, -10, -42), (-45, 8, 42))), bore(rear, Z, 8), bore(main, Z, 7.5))
    )
    axle = cyl(main - 42 * Z, Z, 7.5, 84).union(cyl(main - 46 * Z, Z, 11, 4))
    drawing.add("main axle", cut(axle, cyl(main + 20 * Z, Z, 5, 30)))
    drawing.add("main axle screw", screw(main + 42 * Z, -Z, 5, 20).union(tube(main + 42 * Z, Z, 5, 11, 3)))
    arms = both_sides(rear, stay, 12, 42.5, 50, [rear, stay], 4)
    drawing.add("seat stay", union(*arms, box((-205, 60, -50), (-185, 75, 50))))
    holes = [cyl(rocker + s * 38 * Z, -s * Z, 4, 20) for s in (1, -1)]
    drawing.add("rocker axle", cut(cyl(rocker - 38 * Z, Z, 6, 76), *holes))
    holes = [cyl(high + s * 30 * Z, -s * Z, 3, 20) for s in (1, -1)]
    drawing.add("shock pin", cut(cyl(high - 30 * Z, Z, 5, 60), *holes))
    drawing.add("lower shock bolt", headed(low + 20 * Z, -Z, 4, 50))
    drawing.add("lower shock nut", hexagon(low - 27 * Z, Z, 6.5, 7, 4))
    drawing.add("lower reducer", tube(low - 14 * Z, Z, 4, 5, 28))
    drawing.add("lower shock bush", tube(low - 12 * Z, Z, 5 + play, 7, 24))
    drawing.add("upper shock bush", tube(high - 12 * Z, Z, 5 + play, 7, 24))
    can = cut(
        cyl(low, way, 17, 110), cyl(low, way, 18, 14), cyl(low + 25 * way, way, 13, 70), cyl(low, way, 6 + play, 200)
    )
    can = union(can, cyl(low - 12 * Z, Z, 11, 24), cyl(low, way, 7, 24))
    drawing.add("shock can", cut(can, bore(low, Z, 7)))
    rod = union(
        cyl(low + 60 * way, way, 6, long - 60), cyl(low + 60 * way, way, 13 - play, 8), cyl(high - 12 * Z, Z, 11, 24)
    )
    drawing.add("shock rod", cut(rod, bore(high, Z, 7)))
    drawing.joint("Revolute", "chain stay", "frame", main, Z)
    drawing.joint("Revolute", "seat stay", "chain stay", rear, Z)
    drawing.joint("Revolute", "seat stay", "left rocker", stay, Z)
    drawing.joint("Revolute", "left rocker", "frame", rocker, Z)
    drawing.joint("Weld", "left rocker", "right rocker")
    drawing.joint("Weld", "rocker axle", "left rocker")
    drawing.joint("Revolute", "shock rod", "left rocker", high, Z)
    drawing.joint("Revolute", "shock can", "frame", low, Z)
    drawing.joint("Cylindrical", "shock rod", "shock can", low, way)
    return drawing


def _snapped(middle, radius: float):
    """A cup of plastics over a ball on a stud along z, open below."""
    return cut(cyl(middle - 0.45 * radius * Z, Z, radius + 3, 1.8 * radius), sphere(middle, radius))


@kind
def wiper_linkage(random):
    """A motor with a crank, two levers riveted on shafts in bushes, two rods with cups on ball studs."""
    drawing, play = Drawing(["frame"]), random.choice([0.0, 0.05, 0.15])
    pivots = {"driver": at(-random.uniform(140, 170), 0, 0), "passenger": at(260, 20, 0)}
    housings = [cyl(p, Z, 12, 50) for p in pivots.values()]
    rail = [
        cyl(p + 25 * Z, at(40, -28, 13) - p - 25 * Z, 8, np.linalg.norm(at(40, -28, -12) - p)) for p in pivots.values()
    ]
    plate = union(box((-5, -90, 20), (85, -40, 24)), box((20, -50, 20), (60, -15, 24)))
    feet = [at(40, -65, 0) + p for p in hollow(0 * X, Z, 20, 3)]
    bores = [bore(p, Z, 8) for p in pivots.values()] + [bore(p, Z, 3) for p in feet] + [bore((40, -65, 0), Z, 9)]
    drawing.add("frame", cut(union(*housings, *rail, plate), *bores))
    hub, ball = at(40, -65, 0), 5.0
    drawing.add(
        "motor",
        cut(
            union(cyl(hub + 24 * Z, Z, 35, 25), cyl(hub + at(0, 0, 46), -Y, 20, 90)),
            cyl(hub, Z, 6, 46),
            *(cyl(p + 24 * Z, Z, 3, 12) for p in feet),
        ),
    )
    drawing.add(
        "motor shaft",
        union(cyl(hub, Z, 6 - play / 2, 46), cyl(hub - 12 * Z, Z, 4, 12), cyl(hub - 4 * Z, Z, 6 - play / 2, 4)),
    )
    for number, p in enumerate(feet):
        drawing.add(f"motor screw {number}", screw(p + 20 * Z, Z, 3, 14))
    tip = hub + 40 * at(np.cos(0.5), np.sin(0.5), 0)
    crank = cut(bar(hub, tip, 11, -9, -4), bore(hub, Z, 4), bore(tip, Z, 3.5))
    drawing.add("motor crank", crank)
    drawing.add("motor nut", hexagon(hub - 14 * Z, Z, 6.5, 5, 4))
    near = union(
        sphere(tip - 18 * Z, ball),
        cyl(tip - 18 * Z, Z, 3.2, 9),
        cyl(tip - 9 * Z, Z, 3.5, 5),
        cyl(tip - 4 * Z, Z, 5, 1.5),
    )
    second = union(cyl(tip - 34 * Z, Z, 3.2, 16), sphere(tip - 34 * Z, ball))
    drawing.add("double stud", union(near, second))
    drawing.joint("Weld", "motor", "frame")
    drawing.joint("Revolute", "motor shaft", "motor", hub, Z)
    drawing.joint("Weld", "motor crank", "motor shaft")
    drawing.joint("Weld", "double stud", "motor crank")
    for (name, p), level, turn in zip(pivots.items(), (-34, -18), (-1.3, -1.9), strict=True):
        for number, z in enumerate((0, 38)):
            drawing.add(f"{name} bush {number}", tube(p + z * Z, Z, 5 + play, 8, 12))
        shaft = union(cyl(p - 4 * Z, Z, 5, 76), cyl(p - 10 * Z, Z, 4, 6))
        drawing.add(f"{name} shaft", grooved(shaft, p + 52 * Z, Z, 5))
        drawing.add(f"{name} lower washer", tube(p - 2 * Z, Z, 5, 9, 1.9))
        drawing.add(f"{name} upper washer", tube(p + 50.2 * Z, Z, 5, 9, 1.5))
        drawing.add(f"{name} circlip", circlip(p + 52 * Z, Z, 5))
        end = p + 50 * at(np.cos(turn), np.sin(turn), 0)
        lever = cut(bar(p, end, 9, -8, -4, [end], 3.5), bore(p, Z, 4))
        drawing.add(f"{name} lever", lever)
        there = end + level * Z
        drawing.add(
            f"{name} stud",
            union(
                sphere(there, ball),
                cyl(there, Z, 3.2, -8 - level),
                cyl(end - 8 * Z, Z, 3.5, 4),
                cyl(end - 4 * Z, Z, 5, 1),
            ),
        )
        here = tip + level * Z
        span = there - here
        long = np.linalg.norm(span)
        web = cyl(here + 6 * span / long - 0 * Z, span, 3.2, long - 12)
        cups = [_snapped(each, ball) for each in (here, there)]
        if level == -18:
            cups[0] = cut(cups[0], cyl(here - 20 * Z, Z, 4, 25), bore(here, Z, 3.4))
        drawing.add(
            f"{name} rod",
            cut(
                union(web, *cups),
                sphere(here, ball),
                sphere(there, ball),
                cyl(there, Z, 4.2, 20),
                cyl(here, Z, 4.2, 20),
            ),
        )
        drawing.joint("Revolute", f"{name} shaft", "frame", p, Z)
        drawing.joint("Weld", f"{name} lever", f"{name} shaft")
        drawing.joint("Weld", f"{name} stud", f"{name} lever")
        drawing.joint("Spherical", f"{name} rod", "motor crank", here)
        drawing.joint("Spherical", f"{name} rod", f"{name} lever", there)
    return drawing


@kind
def hand_brake(random):
    """A lever of two sheets on a rivet, a pawl with a push rod in a tube, a clevis with pin and cotter, a cable rod."""
    drawing, play = Drawing(["bracket"]), random.choice([0.05, 0.15, 0.3])
    pivot, pawl, clevis = at(0, 0, 0), at(55, 18, 0), at(-8, -random.uniform(30, 36), 0)
    foot = cut(box((-50, -70, -35), (60, -66, 35)), *(bore(at(x, -66, z), Y, 4) for x in (-35, 45) for z in (-25, 25)))
    sector = bar((45, -60), (0, 0), 14, -2, 2)
    teeth = [box((44, y, -2), (49, y + 3, 2)) for y in (-14, -8, -2, 4)]
    drawing.add(
        "bracket",
        cut(
            union(foot, sector, box((20, -66, -2), (60, -40, 2)), bar((38, -50), (38, 2), 8, -2, 2), *teeth),
            bore(pivot, Z, 5),
        ),
    )
    for side, name in ((1, "left"), (-1, "right")):
        z = sorted((side * 3, side * 5.5))
        sheet = union(bar(pivot, pawl, 14, *z), bar(pivot, clevis, 10, *z), bar(pawl, at(80, 26, 0), 12, *z))
        drawing.add(
            f"{name} sheet",
            cut(
                sheet,
                bore(pivot, Z, 5 + play),
                bore(pawl, Z, 3),
                bore(clevis, Z, 4 + play),
                bore((80, 26, 0), Z, 2.5),
                bore((73, 14.5, 0), Z, 2),
            ),
        )
        drawing.add(f"{name} washer", tube(side * 2 * Z, side * Z, 5, 9, 1))
    drawing.add("pivot", rivet(pivot - 5.5 * Z, Z, 5, 11))
    drawing.add("pawl rivet", rivet(pawl - 5.5 * Z, Z, 3, 11))
    drawing.add("grip rivet", rivet(at(73, 14.5, -5.5), Z, 2, 11))
    drawing.add("spacer rivet", union(rivet((80, 26, -5.5), Z, 2.5, 11), cyl((80, 26, -3), Z, 5, 6)))
    way = at(np.cos(0.2), np.sin(0.2), 0)
    root = at(95, 24, 0)
    grip = cut(cyl(root, way, 13, 130), cyl(root + 30 * way, way, 11, 140), bore(root, way, 4 + play))
    cheeks = cut(
        box((70, 10, -3), (100, 34, 3)),
        cyl((80, 26, -9), Z, 5, 18),
        bore(root, way, 5),
        cyl(root + 30 * way, way, 11, 140),
        bore((73, 14.5, 0), Z, 2),
    )
    drawing.add("grip", union(grip, cheeks))
    tail = pawl + at(9, 2, 0)
    drawing.add(
        "pawl",
        cut(
            union(bar(pawl, tail, 5, -2, 2), bar(pawl, at(51, 4, 0), 4.5, -2, 2).cut(box((40, -20, -3), (49.5, 9, 3)))),
            bore(pawl, Z, 3 + play),
        ),
    )
    rod = union(cyl(root + 4 * way, way, 4, 138), cyl(root + 118 * way, way, 10.8, 20))
    drawing.add("button", rod)
    drawing.add("clevis pin", headed(clevis + 12 * Z, -Z, 4, 28))
    drawing.add("cotter", union(cyl(clevis + at(0, -8, -14), Y, 1, 16), torus(clevis + at(0, 10, -14), Z, 2.5, 0.9)))
    drawing.add("pin washer", tube(clevis - 12.9 * Z, Z, 4, 8, 0.9))
    ears = both_sides(clevis, clevis - 14 * X, 7, 6, 12, [clevis], 4 + play)
    fork = union(*ears, box(clevis + at(-30, -7, -12), clevis + at(-12, 7, 12)))
    drawing.add("clevis", cut(fork, bore(clevis - 14 * X, X, 4, 30), bore(clevis, Z, 4 + play)))
    drawing.add("cable rod", cyl(clevis - 15 * X, -X, 4, 120))
    drawing.add("lock nut", hexagon(clevis - 30 * X, -X, 6.5, 5, 4))
    drawing.parts["clevis pin"] = drawing.parts["clevis pin"].cut(bore(clevis - 14 * Z, Y, 1))
    drawing.joint("Revolute", "left sheet", "bracket", pivot, Z)
    drawing.joint("Weld", "left sheet", "right sheet")
    drawing.joint("Weld", "grip", "left sheet")
    drawing.joint("Revolute", "pawl", "left sheet", pawl, Z)
    drawing.joint("Cylindrical", "button", "grip", root, way)
    drawing.joint("Revolute", "clevis", "left sheet", clevis, Z)
    drawing.joint("Weld", "cable rod", "clevis")
    return drawing
