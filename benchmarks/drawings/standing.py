"""What stands on the floor and is set by hand: a music stand, a work light, the mount of a telescope."""

from __future__ import annotations

import cadquery as cq

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
    laid,
    rivet,
    screw,
    tube,
    union,
)  # fmt: skip


@kind
def music_stand(random):
    """A column on a heavy foot, a tube that slides in it, a desk that tilts on a bolt and has two arms for pages."""
    drawing, play = Drawing(["foot"]), random.choice([0.05, 0.15, 0.3])
    low = random.uniform(200, 320)
    top, tilt = at(0, 0, low + 500), at(0, 0, low + 525)
    foot = cut(cyl(0 * Z, Z, 120, 12), bore(0 * Z, Z, 3.2, 30), cyl(-1 * Z, Z, 6, 7))
    drawing.add("foot", foot.faces(">Z").edges().chamfer(2))
    column = cut(cyl(12 * Z, Z, 14, 488), cyl(45 * Z, Z, 12, 500), cyl(6 * Z, Z, 3, 32), bore(485 * Z, X, 3.3, 60))
    drawing.add("column", column)
    drawing.add("foot screw", screw(6 * Z, Z, 3, 30))
    collar = cut(cyl(465 * Z, Z, 19, 45), cyl(460 * Z, Z, 13.98, 40), bore(0 * Z, Z, 12.2, 600))
    drawing.add("collar", cut(collar, cyl(485 * Z, X, 3, 30)))
    knob = union(cyl(485 * Z + (12.05 - play) * X, X, 3, 22), cyl(485 * Z + 21 * X, X, 12, 14))
    drawing.add("collar knob", knob.faces(">X").edges().fillet(2))
    tubing = cut(tube(low * Z, Z, 10, 12 - play, 500), bore(top - 15 * Z, Y, 2.02, 30))
    drawing.add("inner tube", tubing)
    block = union(
        cyl(top - 30 * Z, Z, 9.95, 30), box(top + at(-7, -11, 0), top + at(7, 11, 25)), cyl(tilt - 7 * X, X, 11, 14)
    )
    drawing.add("head", cut(block, bore(top - 15 * Z, Y, 2, 30), bore(tilt, X, 4 + play / 3, 30)))
    drawing.add("cross pin", cyl(top - 15 * Z - 11.5 * Y, Y, 2, 23))
    sides = [box(tilt + at(s * 7.1, -10, -14), tilt + at(s * 10, 17, 14)) for s in (-1, 1)]
    holes = [tilt + at(x, 14, 0) for x in (-25, 25)]
    bracket = union(*sides, box(tilt + at(-35, 14, -14), tilt + at(35, 17, 14)))
    drawing.add("desk bracket", cut(bracket, bore(tilt, X, 4.1, 30), *(bore(p, Y, 2.2, 9) for p in holes)))
    drawing.add("tilt bolt", headed(tilt - 10 * X, X, 4, 32))
    drawing.add("tilt washer", tube(tilt + 10 * X, X, 4.2, 9, 1.5))
    wing = union(cyl(tilt + 11.5 * X, X, 7, 9), box(tilt + at(14, -1.5, -13), tilt + at(19, 1.5, 13)))
    drawing.add("wing nut", cut(wing, bore(tilt, X, 4, 40)))
    floor = low + 480
    desk = union(box((-230, 17, floor), (230, 19, floor + 270)), box((-230, 17, floor), (230, 62, floor + 2)))
    desk = cut(desk, *(bore((x, 18, floor + z), Y, 14, 9) for x in (-140, 140) for z in (150, 210)))
    pivots = {"left": at(-205, 19, floor + 20), "right": at(205, 19, floor + 20)}
    drawing.add("desk", cut(desk, *(bore(p, Y, 2.2, 9) for p in holes), *(bore(p, Y, 3, 9) for p in pivots.values())))
    for number, p in enumerate(holes):
        drawing.add(f"desk screw {number}", screw(p + 5 * Y, -Y, 2, 12))
        drawing.add(f"desk nut {number}", hexagon(p, -Y, 3.5, 3.2, 2))
    for s, (name, p) in zip((1, -1), pivots.items(), strict=True):
        end = at(p[0] + s * 95, -p[2] - 35)
        arm = laid(bar((p[0], -p[2]), end, 6, 0, 2.5), 19.1 * Y, X, Y)
        drawing.add(f"{name} arm", cut(arm, bore(p, Y, 3 + play / 2, 20)))
        drawing.add(f"{name} rivet", rivet(p - 2 * Y, Y, 3, 4.7))
        drawing.joint("Revolute", f"{name} arm", "desk", p, Y)
    drawing.joint("Weld", "column", "foot")
    drawing.joint("Weld", "collar", "column")
    drawing.joint("Cylindrical", "inner tube", "column", 0 * Z, Z)
    drawing.joint("Weld", "head", "inner tube")
    drawing.joint("Revolute", "desk bracket", "head", tilt, X)
    drawing.joint("Weld", "desk", "desk bracket")
    return drawing


@kind
def work_light(random):
    """A lamp with a glass under a bezel and a driver, between the knobs of a yoke that turns on a foot."""
    drawing, play = Drawing(["foot"]), random.choice([0.1, 0.2])
    pivot = at(0, 0, random.uniform(115, 130))
    foot = union(box((-95, -60, 0), (95, 60, 5)), *(box((s * 90, -60, -40), (s * 95, 60, 3)) for s in (-1, 1)))
    drawing.add("foot", cut(foot, bore(0 * Z, Z, 5 + play, 20)))
    drawing.add("foot washer", tube(5 * Z, Z, 5.2, 15, 1.5))
    yoke = union(box((-120, -15, 6.5), (120, 15, 10.5)), *(box((s * 116, -15, 7), (s * 120, 15, 150)) for s in (-1, 1)))
    drawing.add("yoke", cut(yoke, bore(0 * Z, Z, 5.1, 20), bore(pivot, X, 4 + play, 200)))
    drawing.add("foot bolt", headed(0 * Z, Z, 5, 22))
    drawing.add("upper washer", tube(10.5 * Z, Z, 5.2, 12, 1.5))
    drawing.add("lock nut", hexagon(12 * Z, Z, 8, 8, 5))
    low, high = pivot[2] - 60, pivot[2] + 60
    lamp = cut(box((-110, -30, low), (110, 10, high)), box((-99, -40, low + 11), (99, -5, high - 11)))
    lamp = cut(lamp, box((-104, -40, low + 6), (104, -26, high - 6)))
    lamp = cut(lamp, *(box((-200, 3, z), (200, 20, z + 4)) for z in (low + 4, low + 12, high - 16, high - 8)))
    lamp = union(lamp, *(cyl(pivot + s * 109 * X, s * X, 9, 7) for s in (-1, 1)))
    lamp = cut(lamp, *(cyl(pivot + s * 116 * X, -s * X, 4, 20) for s in (-1, 1)))
    corners = [at(x, -33, z) for x in (-107, 107) for z in (low + 3, high - 3)]
    chips = [at(x, -8, pivot[2]) for x in (-34, 34)]
    bolts = [at(x, 14, pivot[2]) for x in (-38, 38)]
    lamp = cut(lamp, *(cyl(p, Y, 1.5, 15) for p in corners), *(cyl(p, Y, 1.2, 9) for p in chips))
    drawing.add("lamp", cut(lamp, *(cyl(p, -Y, 2, 16) for p in bolts)))
    drawing.add("glass", box((-104 + play, -30, low + 6 + play), (104 - play, -26, high - 6 - play)))
    bezel = cut(box((-110, -33, low), (110, -30, high)), box((-95, -40, low + 15), (95, 0, high - 15)))
    drawing.add("bezel", cut(bezel, *(bore(p, Y, 1.7, 9) for p in corners)))
    for number, p in enumerate(corners):
        drawing.add(f"bezel screw {number}", screw(p, Y, 1.5, 15))
    board = box((-40, -8, pivot[2] - 25), (40, -5, pivot[2] + 25))
    drawing.add("board", cut(board, *(bore(p, Y, 1.4, 9) for p in chips)))
    for number, p in enumerate(chips):
        drawing.add(f"board screw {number}", screw(p, Y, 1.2, 9))
    driver = union(
        box(pivot + at(-30, 10, -30), pivot + at(30, 42, 30)), box(pivot + at(-45, 10, -10), pivot + at(45, 14, 10))
    )
    driver = cut(driver.edges("|Y").fillet(2), *(bore(p, Y, 2.2, 9) for p in bolts))
    drawing.add("driver", driver)
    for number, p in enumerate(bolts):
        drawing.add(f"driver screw {number}", screw(p, -Y, 2, 16))
    for name, s in (("left", -1), ("right", 1)):
        drawing.add(f"{name} washer", tube(pivot + s * 120 * X, s * X, 4.2, 12, 1.5))
        knob = union(cyl(pivot + s * 98 * X, s * X, 4, 24), cyl(pivot + s * 121.5 * X, s * X, 16, 18))
        drawing.add(f"{name} knob", knob.faces(">X" if s > 0 else "<X").edges().fillet(2))
    drawing.joint("Revolute", "yoke", "foot", 0 * Z, Z)
    drawing.joint("Revolute", "lamp", "yoke", pivot, X)
    drawing.joint("Weld", "bezel", "lamp")
    drawing.joint("Weld", "glass", "lamp")
    drawing.joint("Weld", "board", "lamp")
    drawing.joint("Weld", "driver", "lamp")
    return drawing


@kind
def telescope_mount(random):
    """Two axes of a mount in bearings, on a fork that tilts; a saddle with a plate that slides, a counterweight."""
    drawing, play = Drawing(["pier"]), random.choice([0.05, 0.1])
    tilted, away = random.uniform(-60, -35), random.uniform(-195, -165)
    pier = union(cyl(-150 * Z, Z, 45, 60), *(box((s * 25.1, -20, -92), (s * 36, 20, 0)) for s in (-1, 1)))
    pier = union(pier, *(cyl(s * 25.1 * X, s * X, 20, 10.9) for s in (-1, 1)))
    drawing.add("pier", cut(pier, bore(0 * X, X, 6.1, 60)).rotate((0, 0, 0), (1, 0, 0), float(tilted)))
    first, second = at(0, 45, 0), at(0, 45, 110)
    house = union(cyl(-25 * X, X, 20, 50), box((-25, 0, -20), (25, 40, 20)), cyl(first - 60 * Z, Z, 30, 120))
    house = cut(house, bore(0 * X, X, 6 + play, 60), bore(first, Z, 14, 90))
    drawing.add("polar housing", cut(house, *(cyl(first + s * 45 * Z, s * Z, 20, 20) for s in (-1, 1))))
    drawing.add("altitude bolt", headed(-36 * X, X, 6, 84))
    drawing.add("altitude nut", hexagon(36 * X, X, 9, 10, 6))
    for name, s in (("lower", -1), ("upper", 1)):
        drawing.add(f"{name} polar bearing", tube(first + s * 45 * Z, s * Z, 12, 20, 15))
    feet = [first + at(x, y, 70) for x in (-19, 19) for y in (-19, 19)]
    shaft = union(cyl(first - 75 * Z, Z, 12, 146), cyl(first + 60 * Z, Z, 18, 11), cyl(first + 70 * Z, Z, 34, 10))
    drawing.add("polar shaft", cut(shaft, *(bore(p, Z, 2.7, 15) for p in feet)))
    drawing.add(
        "polar nut",
        cut(
            cyl(first - 60 * Z, -Z, 18, 10),
            bore(first, Z, 12, 99),
            box(first + at(-20, -2, -75), first + at(20, 2, -67)),
        ),
    )
    house = union(cyl(second - 60 * X, X, 28, 120), box(first + at(-30, -28, 80), first + at(30, 28, 110)))
    house = cut(house, bore(second, X, 12, 90), *(cyl(second + s * 46 * X, s * X, 18, 20) for s in (-1, 1)))
    drawing.add("declination housing", cut(house, *(cyl(p, Z, 2.5, 24) for p in feet)))
    for number, p in enumerate(feet):
        drawing.add(f"foot screw {number}", screw(p, Z, 2.5, 22))
    for name, s in (("left", -1), ("right", 1)):
        drawing.add(f"{name} bearing", tube(second + s * 46 * X, s * X, 10, 18, 14))
    corners = [second + at(78, y, z) for y in (-23, 23) for z in (-15, 15)]
    shaft = union(cyl(second - 230 * X, X, 10, 291), cyl(second + 60 * X, X, 14, 2), cyl(second + 61 * X, X, 34, 9))
    shaft = cut(shaft, cyl(second - 230 * X, X, 3, 20), *(bore(p, X, 2.5, 20) for p in corners))
    drawing.add("declination shaft", shaft)
    drawing.add("lock collar", cut(tube(second - 60 * X, -X, 10, 16, 12), cyl(second - 66 * X, Y, 2, 30)))
    drawing.add("collar grub", cyl(second - 66 * X + 10 * Y, Y, 2, 5))
    section = [(79, -15), (85, -11.5), (85, 11.5), (79, 15)]
    groove = cq.Workplane().polyline([(x, y + 45) for x, y in section]).close().extrude(220)
    saddle = cut(box(second + at(70, -33, -50), second + at(85, 33, 50)), groove)
    clamp = second + at(82, 33, 0)
    saddle = cut(saddle, cyl(clamp, -Y, 2.5, 21), *(bore(p, X, 2.7, 9) for p in corners))
    drawing.add("saddle", cut(saddle, *(cyl(p, X, 4.1, 9) for p in corners)))
    for number, p in enumerate(corners):
        drawing.add(f"saddle screw {number}", screw(p, -X, 2.5, 16))
    rail = [
        (79, play - 15),
        (85, play - 11.5),
        (92, play - 11.5),
        (92, 11.5 - play),
        (85, 11.5 - play),
        (79, 15 - play),
    ]
    rail = cq.Workplane().polyline([(x, y + 45) for x, y in rail]).close().extrude(220)
    drawing.add("dovetail plate", cut(rail, *(bore((85, 45, z), X, 3.2, 20) for z in (15, 205))))
    knob = union(cyl(clamp + 6 * Y, -Y, 2.5, 24), cyl(clamp + 5 * Y, Y, 10, 14))
    drawing.add("saddle knob", knob)
    weight = cut(cyl(second + away * X, X, 38, 40), bore(second, X, 10 + 2 * play))
    drawing.add("counterweight", cut(weight, cyl(second + (away + 20) * X, Y, 4, 60)))
    knob = union(cyl(second + (away + 20) * X + 10.4 * Y, Y, 4, 32), cyl(second + (away + 20) * X + 40 * Y, Y, 11, 12))
    drawing.add("weight knob", knob)
    drawing.add("end washer", tube(second - 230 * X, -X, 3.2, 16, 3))
    drawing.add("end screw", screw(second - 233 * X, X, 3, 20))
    drawing.joint("Revolute", "polar housing", "pier", 0 * X, X)
    drawing.joint("Revolute", "polar shaft", "polar housing", first, Z)
    drawing.joint("Weld", "declination housing", "polar shaft")
    drawing.joint("Revolute", "declination shaft", "declination housing", second, X)
    drawing.joint("Weld", "lock collar", "declination shaft")
    drawing.joint("Weld", "saddle", "declination shaft")
    drawing.joint("Prismatic", "dovetail plate", "saddle", 0 * Z, Z)
    drawing.joint("Cylindrical", "counterweight", "declination shaft", second, X)
    return drawing
