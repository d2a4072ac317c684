"""What rolls: the rollers of a conveyor, a trolley under a beam, the wheel of a robot, the rods of a locomotive."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.office import compound
from drawings.shapes import (
    Shape,
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
    torus,
    tube,
    union,
)  # fmt: skip


@kind
def conveyor_rollers(random):
    """Three rollers with bearing rings and spacers on axles that are screwed between two rails with cross bars."""
    drawing, play = Drawing(["left rail"]), random.choice([0.02, 0.05, 0.1])
    pitch = random.uniform(62, 95)
    places = [at(x, 0, 15) for x in (-pitch, 0, pitch)]
    ties = [at(x, 0, -28) for x in (-100, 100)]
    for name, s in (("left", -1), ("right", 1)):
        flanges = [box((-160, s * 154, z - 2), (160, s * 175, z + 2)) for z in (-38, 38)]
        rail = union(box((-160, s * 150, -40), (160, s * 154, 40)), *flanges)
        rail = cut(rail, *(bore(p + s * 152 * Y, Y, 3.3, 9) for p in places + ties))
        drawing.add(f"{name} rail", cut(rail, *(bore((x, s * 165, -38), Z, 4, 9) for x in (-140, 140))))
    for number, p in enumerate(ties):
        tie = box(p + at(-10, -150, -8), p + at(10, 150, 8))
        drawing.add(f"cross bar {number}", cut(tie, *(cyl(p + s * 150 * Y, -s * Y, 3, 20) for s in (-1, 1))))
        for name, s in (("left", -1), ("right", 1)):
            drawing.add(f"{name} bar screw {number}", screw(p + s * 154 * Y, -s * Y, 3, 20))
        drawing.joint("Weld", f"cross bar {number}", "left rail")
    for number, p in enumerate(places):
        axle = cyl(p - 150 * Y, Y, 6, 300)
        drawing.add(f"axle {number}", cut(axle, *(cyl(p + s * 150 * Y, -s * Y, 3, 25) for s in (-1, 1))))
        shell = cut(cyl(p - 146 * Y, Y, 25, 292), bore(p, Y, 21))
        drawing.add(f"roller {number}", cut(shell, *(cyl(p + s * 134 * Y, s * Y, 22.5, 20) for s in (-1, 1))))
        for name, s in (("left", -1), ("right", 1)):
            drawing.add(f"{name} bearing {number}", tube(p + s * 134 * Y, s * Y, 6 + play, 22.51, 12))
            drawing.add(f"{name} spacer {number}", tube(p + s * 146 * Y, s * Y, 6.1, 9, 4))
            drawing.add(f"{name} axle screw {number}", screw(p + s * 154 * Y, -s * Y, 3, 20))
        drawing.joint("Weld", f"axle {number}", "left rail")
        drawing.joint("Revolute", f"roller {number}", f"axle {number}", p, Y)
    drawing.joint("Weld", "right rail", "left rail")
    return drawing


@kind
def beam_trolley(random):
    """Two plates with flanged wheels on the lower flange of a beam, a shaft with a yoke below, a hook that swivels."""
    drawing, play = Drawing(["beam"]), random.choice([0.05, 0.2])
    beam = union(*(box((-300, -40, z), (300, 40, z + 8)) for z in (0, 112)), box((-300, -3, 4), (300, 3, 116)))
    drawing.add("beam", beam)
    base = random.uniform(38, 50)
    pivot, tie = at(0, 0, -30), at(50, 0, -38)
    for name, s in (("left", -1), ("right", 1)):
        plate = box((-72, s * 50, -60), (72, s * 56, 60)).edges("|Y").chamfer(8)
        axles = [at(x, 0, 28) for x in (-base, base)]
        holes = [bore(p, Y, 6.1, 80) for p in axles] + [bore(pivot, Y, 8.05, 80), bore(tie, Y, 5.2, 80)]
        drawing.add(f"{name} plate", cut(plate, *holes))
        for number, p in enumerate(axles):
            axle = union(cyl(p + s * 20 * Y, s * Y, 8, 30), cyl(p + s * 45 * Y, s * Y, 11, 5))
            axle = union(axle, cyl(p + s * 50 * Y, s * Y, 6, 17))
            drawing.add(f"{name} axle {number}", cut(axle, tube(p + s * 22.9 * Y, s * Y, 6.5, 9, 1.05)))
            drawing.add(f"{name} axle nut {number}", hexagon(p + s * 56 * Y, s * Y, 9, 9, 6))
            clip = cut(tube(p + s * 22.95 * Y, s * Y, 6.5, 10, 0.95), box(p + at(-3, -90, 0), p + at(3, 90, 20)))
            drawing.add(f"{name} clip {number}", clip)
            wheel = union(cyl(p + s * 18 * Y, s * Y, 20, 27), cyl(p + s * 40.5 * Y, s * Y, 24, 4.5))
            wheel = cut(wheel, bore(p, Y, 11, 80), cyl(p + s * 24 * Y, s * Y, 14, 30))
            drawing.add(f"{name} wheel {number}", wheel)
            drawing.add(f"{name} bearing {number}", tube(p + s * 24 * Y, s * Y, 8 + play / 4, 14, 21))
            drawing.joint("Weld", f"{name} axle {number}", f"{name} plate")
            drawing.joint("Revolute", f"{name} wheel {number}", f"{name} plate", p, Y)
        drawing.add(f"{name} spacer", tube(pivot + s * 10.1 * Y, s * Y, 8.1, 13, 39.9))
    drawing.add("tie tube", tube(tie - 50 * Y, Y, 5.2, 9, 100))
    drawing.add("tie bolt", headed(tie - 56 * Y, Y, 5, 120))
    drawing.add("tie nut", hexagon(tie + 56 * Y, Y, 8, 7, 5))
    drawing.add("shaft", headed(pivot - 56 * Y, Y, 8, 124))
    drawing.add("shaft nut", hexagon(pivot + 56 * Y, Y, 12, 10, 8))
    yoke = union(
        box((-26, -10, -110), (26, 10, -52)), cyl(pivot - 10 * Y, Y, 18, 20), box((-14, -10, -55), (14, 10, -30))
    )
    yoke = cut(yoke, box((-20, -20, -100), (20, 20, -62)), bore(pivot, Y, 8 + play, 30))
    drawing.add("yoke", cut(yoke, cyl(-120 * Z, Z, 8 + play / 2, 40)))
    drawing.add("thrust washer", tube(-100 * Z, Z, 8.2, 9.8, 3))
    nut = hexagon(-97 * Z, Z, 12, 10, 8)
    drawing.add("hook nut", cut(nut, bore(-92 * Z, X, 1.5, 40)))
    drawing.add("cross pin", cyl(-92 * Z - 13 * X, X, 1.5, 26))
    hook = cut(tube((0, -9, -160), Y, 20, 36, 18), box((-50, -20, -155), (-10, 20, -133)))
    hook = union(hook, cyl(-128 * Z, Z, 8, 43), cyl(-128 * Z, Z, 12, 17.9))
    drawing.add("hook", cut(hook, bore(-92 * Z, X, 1.5, 20)))
    drawing.joint("Prismatic", "left plate", "beam", 0 * X, X)
    drawing.joint("Weld", "right plate", "left plate")
    drawing.joint("Revolute", "yoke", "left plate", pivot, Y)
    drawing.joint("Revolute", "hook", "yoke", 0 * Z, Z)
    drawing.joint("Weld", "hook nut", "hook")
    return drawing


@kind
def vacuum_wheel(random):
    """The wheel of a robot vacuum: a swing arm with a motor and a spring in a housing, a hub with a tyre."""
    drawing, play = Drawing(["housing"]), random.choice([0.05, 0.1, 0.2])
    reach = random.uniform(44, 52)
    pivot, wheel = at(0, 0, 0), at(reach, -4, 0)
    housing = cut(box((-20, -45, -32), (105, 42, 22)), box((-17, -60, -29), (102, 39, 30)))
    posts = [at(x, y, 22) for x, y in ((-12, 34), (97, 34), (97, -38))]
    housing = union(housing, *(cyl((p[0], p[1], -30), Z, 4.5, 52) for p in posts))
    housing = union(housing, cyl(-30 * Z, Z, 7, 10), cyl((-12, -38, -30), Z, 3, 30))
    drawing.add("housing", cut(housing, cyl(-30 * Z, Z, 3, 20), *(cyl(p, -Z, 1.2, 12) for p in posts)))
    lid = cut(box((-20, -45, 22), (105, 42, 25)), bore(20 * Z, Z, 3.02, 9), *(bore(p, Z, 1.6, 9) for p in posts))
    drawing.add("lid", lid)
    for number, p in enumerate(posts):
        drawing.add(f"lid screw {number}", screw(p + 3 * Z, -Z, 1.2, 12))
    drawing.add("pivot pin", cyl(-30 * Z, Z, 3, 55).faces(">Z").chamfer(0.3))
    arm = union(bar(pivot, wheel, 9, -19.8, -5), cyl(wheel - 19.8 * Z, Z, 17, 14.8), cyl(-19.8 * Z, Z, 8, 41.6))
    hook = at(12, -16, -14)
    arm = union(arm, bar((5, 0), hook, 3.5, -18, -10))
    bolts = [wheel + 13 * at(np.cos(a), np.sin(a), 0) for a in (0.6, 0.6 + np.pi)]
    arm = cut(arm, bore(pivot, Z, 5), bore(wheel, Z, 6.05, 60), *(bore(p, Z, 1.5, 60) for p in bolts))
    drawing.add("swing arm", cut(arm, bore(hook, Z, 1.2, 40)))
    for name, z in (("lower", -19.8), ("upper", 11.8)):
        drawing.add(f"{name} sleeve", tube((0, 0, z), Z, 3 + play, 5.02, 10))
        drawing.joint("Weld", f"{name} sleeve", "swing arm")
    motor = union(cyl(wheel - 28 * Z, Z, 15.5, 8.2), cyl(wheel - 19.8 * Z, Z, 6, 14))
    motor = cut(motor, cyl(wheel - 26 * Z, Z, 2.5 + play / 2, 40), *(cyl(p - 28 * Z, Z, 2.6, 2.4) for p in bolts))
    drawing.add("gear motor", cut(motor, *(bore(p, Z, 1.6, 60) for p in bolts)))
    for number, p in enumerate(bolts):
        drawing.add(f"motor screw {number}", screw(p - 25.6 * Z, Z, 1.5, 18))
    flat = box(wheel + at(-5, 1.7, -3), wheel + at(5, 9, 30))
    shaft = union(cut(cyl(wheel - 25.9 * Z, Z, 2.5, 40), flat), cyl(wheel - 5.6 * Z, Z, 4, 1.6))
    drawing.add("output shaft", cut(shaft, cyl(wheel + 14.1 * Z, -Z, 1.2, 9)))
    hub = union(cyl(wheel - 4 * Z, Z, 29, 19), *(cyl(wheel + z * Z, Z, 31, 1.5) for z in (-4, 13.5)))
    hub = cut(hub, bore(wheel, Z, 2.5, 60).cut(flat), tube(wheel + 4 * Z, Z, 8, 24, 20))
    drawing.add("hub", hub)
    drawing.add("tyre", tube(wheel - 2.5 * Z, Z, 29, 34, 16))
    drawing.add("hub washer", tube(wheel + 15 * Z, Z, 1.3, 4, 0.8))
    drawing.add("hub screw", screw(wheel + 15.8 * Z, -Z, 1.2, 8))
    drawing.add("spring", compound(*(torus(at(-2 + x, -24, -14), X, 2.5, 0.4) for x in (0, 1.2, 2.5, 3.8, 5))))
    drawing.joint("Weld", "lid", "housing")
    drawing.joint("Revolute", "swing arm", "housing", pivot, Z)
    drawing.joint("Weld", "gear motor", "swing arm")
    drawing.joint("Revolute", "output shaft", "gear motor", wheel, Z)
    drawing.joint("Weld", "hub", "output shaft")
    drawing.joint("Weld", "tyre", "hub")
    return drawing


def _broad(point, head: float) -> Shape:
    """A screw down into the end of a pin, with a head that is broad enough to hold what turns on it."""
    return cut(
        union(cyl(point, -Z, 1.5, 8), cyl(point, Z, head, 2)), box(point + at(-9, -0.5, 1), point + at(9, 0.5, 3))
    )


@kind
def locomotive_rods(random):
    """The rods of a model locomotive: two coupled wheels, a connecting rod, a crosshead, a piston in a cylinder."""
    drawing, play = Drawing(["frame"]), random.choice([0.03, 0.1])
    turn, long = random.uniform(0.3, 2.8), random.uniform(150, 175)
    throw = 20 * at(np.cos(turn), np.sin(turn), 0)
    wheels = {"rear": at(0, 0, 0), "front": at(110, 0, 0)}
    cross = at(110 + throw[0] + np.sqrt(long**2 - throw[1] ** 2), 0, 0)
    stand, back = long + 66, long + 162
    bolts = [at(x, y, -16) for x, y in ((back + 15, -24), (back + 63, 24))]
    feet = [at(stand + 5, y, -16) for y in (-32, 32)]
    frame = cut(box((-60, -38, -16), (back + 90, 38, -8)), *(bore(p, Z, 12, 30) for p in wheels.values()))
    drawing.add("frame", cut(frame, *(bore(p, Z, 2.2, 9) for p in bolts + feet)))
    for name, p in wheels.items():
        drawing.add(f"{name} bush", union(tube(p - 16 * Z, Z, 8 + play, 12.01, 8), tube(p - 8 * Z, Z, 8 + play, 15, 2)))
        drawing.add(f"{name} axle", cyl(p - 26 * Z, Z, 8, 36).faces("<Z or >Z").chamfer(0.5))
        drawing.add(f"{name} collar", tube(p - 22 * Z, Z, 7.99, 13, 5.9))
        tyre = union(cut(cyl(p - 5.9 * Z, Z, 13, 16), bore(p, Z, 8)), tube(p, Z, 40, 48, 10), tube(p, Z, 45, 51, 2))
        tyre = union(tyre, tube(p + 2 * Z, Z, 10, 44, 5), cyl(p + throw, Z, 8, 12))
        drawing.add(f"{name} wheel", cut(tyre, bore(p, Z, 8), bore(p + throw, Z, 3.5, 30)))
        top = 26.4 if name == "front" else 19.4
        pin = union(cyl(p + throw, Z, 3.5, 13), cyl(p + throw + 12 * Z, Z, 5, top - 12))
        drawing.add(f"{name} crank pin", cut(pin, cyl(p + throw + top * Z, -Z, 1.5, 8)))
        drawing.add(f"{name} cap screw", _broad(p + throw + top * Z, 7))
        drawing.joint("Weld", f"{name} bush", "frame")
        drawing.joint("Weld", f"{name} wheel", f"{name} axle")
        drawing.joint("Weld", f"{name} crank pin", f"{name} wheel")
        drawing.joint("Revolute", f"{name} axle", "frame", p, Z)
    ends = [p + throw for p in wheels.values()]
    rod = bar(ends[0], ends[1], 5, 12.2, 19.2)
    rod = union(rod, *(cyl((p[0], p[1], 12.2), Z, 10, 7) for p in ends))
    drawing.add("coupling rod", cut(rod, *(bore(p, Z, 5 + play, 40) for p in ends)))
    rod = union(bar(ends[1], cross, 5, 19.5, 26.2), *(cyl((p[0], p[1], 19.5), Z, 9, 6.7) for p in (ends[1], cross)))
    drawing.add("connecting rod", cut(rod, bore(ends[1], Z, 5 + play, 40), bore(cross, Z, 4 + play, 40)))
    axis = cross + 13 * Z
    head = union(box(cross + at(-13, play - 15, 3), cross + at(13, 15 - play, 19.3)), cyl(axis + 12 * X, X, 7, 12))
    cotter = axis + 19 * X
    head = cut(head, bore(cross, Z, 4, 40), cyl(axis + 5 * X, X, 4, 30), bore(cotter, Y, 1.2, 20))
    drawing.add("crosshead", head)
    drawing.add("gudgeon pin", cut(cyl(cross + 4 * Z, Z, 4, 22.4), cyl(cross + 26.4 * Z, -Z, 1.5, 8)))
    drawing.add("gudgeon screw", _broad(cross + 26.4 * Z, 6))
    rod = union(cyl(axis + 5 * X, X, 4, 91), cyl(axis + 95 * X, X, 2.5, 13))
    drawing.add("piston rod", cut(rod, bore(cotter, Y, 1.2, 20)))
    drawing.add("cotter", cyl(cotter - 7.5 * Y, Y, 1.2, 15))
    drawing.add("piston", tube(axis + 96 * X, X, 2.5, 18 - play, 8))
    drawing.add("piston nut", hexagon(axis + 104 * X, X, 4, 4, 2.5))
    bracket = cut(box((stand, -38, -8), (stand + 10, 38, 24)), box((0, -14.5, -3), (999, 14.5, 40)))
    sides = {"upper": 18 * Y + 13 * Z, "lower": -18 * Y + 13 * Z}
    bracket = cut(bracket, *(bore(p, X, 2.1) for p in sides.values()), *(cyl(p, Z, 2, 22) for p in feet))
    drawing.add("bracket", bracket)
    for name, p in sides.items():
        slide = cut(box(p + at(stand + 10, -3, -5), p + at(back - 3, 3, 5)), cyl(p + stand * X, X, 2, 24))
        drawing.add(f"{name} slide bar", slide)
        drawing.add(f"{name} bar screw", screw(p + stand * X, X, 2, 22))
        drawing.joint("Weld", f"{name} slide bar", "bracket")
    corners = [at(back, y, z) for y, z in ((-23, -3), (23, 30))]
    block = cut(box((back, -30, -8), (back + 85, 30, 34)), cyl(13 * Z, X, 18, back + 80))
    block = cut(block, *(cyl(p, Z, 2, 16) for p in bolts), *(cyl(p, X, 1.5, 10) for p in corners))
    drawing.add("cylinder", block)
    cover = cut(box((back - 5, -28, -7.5), (back, 28, 34)), *(bore(p, X, 1.7) for p in corners))
    cover = cut(cover, bore(13 * Z, X, 4 + play / 2))
    drawing.add("cover", cut(cover, *(box(p + at(0, -3, -5), p + at(back - 3, 3, 5)) for p in sides.values())))
    for number, p in enumerate(corners):
        drawing.add(f"cover screw {number}", screw(p - 5 * X, X, 1.5, 12))
    drawing.joint("Weld", "cover", "cylinder")
    for number, p in enumerate(bolts):
        drawing.add(f"cylinder screw {number}", screw(p, Z, 2, 16))
    for number, p in enumerate(feet):
        drawing.add(f"bracket screw {number}", screw(p, Z, 2, 18))
    drawing.joint("Weld", "cylinder", "frame")
    drawing.joint("Weld", "bracket", "frame")
    for name in wheels:
        drawing.joint("Revolute", f"{name} wheel", "coupling rod", wheels[name] + throw, Z)
    drawing.joint("Revolute", "front wheel", "connecting rod", ends[1], Z)
    drawing.joint("Revolute", "connecting rod", "crosshead", cross, Z)
    drawing.joint("Weld", "piston rod", "crosshead")
    drawing.joint("Weld", "piston", "piston rod")
    drawing.joint("Prismatic", "crosshead", "bracket", axis, X)
    return drawing
