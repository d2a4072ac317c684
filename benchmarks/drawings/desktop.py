"""What stands on desks: a fan, a monitor's arm, a printer's carriage on two rods."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, screw, sphere, tube, union


@kind
def desk_fan(random):
    """A head that tilts on a bolt with a knob, a motor in a shell, a fan on its shaft by a grub screw, two guards."""
    drawing, play = Drawing(["base"]), random.choice([0.0, 0.05, 0.1])
    tilt, hub = at(0, 0, 165), at(0, 0, random.uniform(205.5, 206.5))
    base = union(cyl((0, 0, 0), Z, 70, 12).edges(">Z").chamfer(3), cyl((0, 0, 11), Z, 16, 13))
    drawing.add("base", cut(base, cyl((0, 0, 4), Z, 10, 40), cyl((0, 0, 18), X, 2, 30)))
    drawing.add("base grub screw", cyl((10, 0, 18), X, 2, 6))
    cheeks = [union(box((-9, s * 8, 128), (9, s * 12, 165)), cyl(tilt + s * 8 * Y, s * Y, 9, 4)) for s in (-1, 1)]
    post = union(cyl((0, 0, 4), Z, 10, 126), box((-9, -12, 128), (9, 12, 136)), *cheeks)
    drawing.add("post", cut(post, bore(tilt, Y, 3, 30)))
    back = at(-50, 0, hub[2])
    lug = union(cyl(tilt - 7.9 * Y, Y, 9, 15.8), box((-9, -7.9, 165), (9, 7.9, 178)))
    spots = [at(0, 24 * np.cos(a), 24 * np.sin(a)) for a in np.arange(3) * 2 * np.pi / 3 + 0.5]
    bosses = [cyl(back + p + 46 * X, X, 4, 14) for p in spots]
    shell = union(tube(back, X, 27, 30, 60), cyl(back, X, 30, 4), lug, *bosses)
    feet = [back + s * 12 * Y for s in (-1, 1)]
    shell = cut(shell, bore(tilt, Y, 3 + play, 30), *(bore(p, X, 1.6, 10) for p in feet))
    drawing.add("shell", cut(shell, *(cyl(back + p + 61 * X, -X, 1.25, 14) for p in spots)))
    drawing.add("tilt bolt", cyl(tilt - 12 * Y, Y, 3, 34).union(hexagon(tilt - 16 * Y, Y, 5, 4)))
    drawing.add("tilt washer", tube(tilt + 12 * Y, Y, 3.2, 7, 1.5))
    drawing.add("knob", cut(cyl(tilt + 13.5 * Y, Y, 11, 12).faces(">Y").chamfer(1), bore(tilt, Y, 3, 30)))
    motor = cut(cyl(back + 4 * X, X, 22, 40), cyl(back + 10 * X, X, 3.02, 60))
    drawing.add("motor", cut(motor, *(cyl(p + 3 * X, X, 1.5, 8) for p in feet)))
    drawing.add("shaft", cyl(back + 10 * X, X, 3, 82))
    for k, p in enumerate(feet):
        drawing.add(f"motor screw {k}", screw(p, X, 1.5, 10))
    cap = cut(cyl(back + 60 * X, X, 30, 3), bore(back, X, 4), *(bore(back + p, X, 1.5) for p in spots))
    drawing.add("cap", cap)
    bars = [box(back + at(63, 20, -1.5), back + at(65, 98, 1.5)) for _ in range(8)]
    bars = [each.rotate(tuple(back), tuple(back + X), 45.0 * k + 8) for k, each in enumerate(bars)]
    rear = union(tube(back + 63 * X, X, 9, 28, 2), *bars, tube(back + 63 * X, X, 97, 100, 30))
    clips = [at(0, np.cos(a), np.sin(a)) for a in np.arange(3) * 2 * np.pi / 3 + 1]
    rear = cut(rear, *(bore(back + p, X, 1.4 + play) for p in spots))
    drawing.add("rear guard", cut(rear, *(cyl(back + 89 * X, w, 1.25, 120) for w in clips)))
    for k, p in enumerate(spots):
        drawing.add(f"cap screw {k}", screw(back + p + 65 * X, -X, 1.25, 17))
    bars = [box(back + at(93, 10, -1.5), back + at(95, 101, 1.5)) for _ in range(8)]
    bars = [each.rotate(tuple(back), tuple(back + X), 45.0 * k + 30) for k, each in enumerate(bars)]
    front = union(tube(back + 84 * X, X, 100.1, 102, 11), *bars, cyl(back + 93 * X, X, 20, 2))
    front = union(front, tube(back + 93 * X, X, 98, 102, 2))
    drawing.add("front guard", cut(front, *(cyl(back + 89 * X, w, 1.4, 120) for w in clips)))
    for k, w in enumerate(clips):
        drawing.add(f"guard screw {k}", screw(back + 89 * X + 102 * w, -w, 1.25, 5))
    blades = [box(back + at(77, 12, -14), back + at(79, 88, 14)) for _ in range(5)]
    blades = [each.rotate(tuple(back + 78 * X), tuple(back + 78 * X + Y), 30) for each in blades]
    blades = [each.rotate(tuple(back), tuple(back + X), 72.0 * k) for k, each in enumerate(blades)]
    fan = union(cyl(back + 70 * X, X, 16, 16), *blades)
    drawing.add("fan", cut(fan, bore(back, X, 3), cyl(back + 73 * X, -Z, 1.5, 40)))
    drawing.add("fan grub screw", cyl(back + 73 * X - 3 * Z, -Z, 1.5, 8))
    drawing.add("fan nut", hexagon(back + 86 * X, X, 5, 4, 3))
    drawing.joint("Weld", "post", "base")
    drawing.joint("Revolute", "shell", "post", tilt, Y)
    drawing.joint("Weld", "motor", "shell")
    drawing.joint("Revolute", "shaft", "motor", back, X)
    drawing.joint("Weld", "fan", "shaft")
    drawing.joint("Weld", "cap", "shell")
    drawing.joint("Weld", "rear guard", "cap")
    drawing.joint("Weld", "front guard", "rear guard")
    return drawing


@kind
def monitor_arm(random):
    """A desk clamp, a post with a collar, a parallelogram with a gas spring, a stem with a circlip, a tilting plate."""
    drawing, play = Drawing(["clamp"]), random.choice([0.02, 0.1])
    rise, long = random.uniform(0.2, 0.5), random.uniform(180, 210)
    clamp = [box((-40, -12, -30), (40, 0, 30)), box((-40, -80, -30), (-32, 0, 30)), box((-40, -80, -30), (20, -70, 30))]
    feet = [at(22 * np.cos(a), 0, 22 * np.sin(a)) for a in np.arange(3) * 2 * np.pi / 3]
    clamp = cut(union(*clamp), cyl((0, -65, 0), -Y, 5, 20), *(bore(p, Y, 2.5, 20) for p in feet))
    drawing.add("clamp", clamp)
    ball = at(0, -33, 0)
    spindle = union(cyl((0, -105, 0), Y, 5, 65), cyl((0, -41, 0), Y, 2.5, 6), sphere(ball, 4))
    drawing.add("clamp screw", cut(spindle, bore((0, -98, 0), X, 2.6, 10)))
    drawing.add("pad", cut(cyl((0, -34, 0), Y, 14, 8), sphere(ball, 4 + play / 2)))
    ends = [cyl((s * 28, -98, 0), s * X, 4, 4) for s in (-1, 1)]
    drawing.add("toggle bar", union(cyl((-30, -98, 0), X, 2.5, 60), *ends))
    post = union(cyl((0, 0, 0), Y, 30, 8), cyl((0, 8, 0), Y, 12, 186))
    drawing.add("post", cut(post, cyl((0, 194, 0), -Y, 3, 25), *(bore(p, Y, 2.75, 20) for p in feet)))
    for k, p in enumerate(feet):
        drawing.add(f"post screw {k}", screw(p + 8 * Y, -Y, 2.5, 17))
    drawing.add("collar", cut(tube((0, 120, 0), Y, 12, 19, 12), cyl((0, 126, 0), -X, 2, 30)))
    drawing.add("collar grub screw", cyl((-12, 126, 0), -X, 2, 6))
    drawing.add("washer", tube((0, 132, 0), Y, 12.2, 19, 1))
    drawing.add("post cap", cut(cyl((0, 194, 0), Y, 20, 5), bore((0, 194, 0), Y, 3.2)))
    drawing.add("cap screw", screw((0, 199, 0), -Y, 3, 22))
    a, b = (at(45, y, 0) for y in (146, 181))
    along = at(np.cos(rise), np.sin(rise), 0)
    c, d = a + long * along, b + long * along
    shoulder = union(cyl((0, 133, 0), Y, 20, 60.9), *(box((0, 135, s * 12), (54, 192, s * 17)) for s in (-1, 1)))
    drawing.add("shoulder", cut(shoulder, bore((0, 0, 0), Y, 12 + play), *(bore(p, Z, 4, 30) for p in (a, b))))
    mid = b + 0.6 * long * along
    for name, one, other, webs, more in (("lower", a, c, 0.85, []), ("upper", b, d, 0.2, [mid])):
        strips = [bar(one, other, 9, s * 10.4 - 1.5, s * 10.4 + 1.5) for s in (-1, 1)]
        web = one + webs * long * along
        link = union(*strips, box(web - at(5, 4, 10), web + at(5, 4, 10)))
        drawing.add(
            f"{name} link",
            cut(link, *(bore(p, Z, 4 + play, 30) for p in (one, other)), *(bore(p, Z, 3, 30) for p in more)),
        )
    for name, p in (("a", a), ("b", b), ("c", c), ("d", d)):
        drawing.add(f"pin {name}", headed(p - 17 * Z, Z, 4, 41))
        drawing.add(f"pin nut {name}", hexagon(p + 17 * Z, Z, 6.5, 6.5, 4))
    way, reach = (mid - a) / np.linalg.norm(mid - a), float(np.linalg.norm(mid - a))
    cylinder = union(cyl(a - 8 * Z, Z, 8, 16), cyl(a + 4 * way, way, 7, 0.55 * reach))
    cylinder = cut(
        cylinder,
        bore(a, Z, 4 + play, 20),
        cyl(a + 14 * way, way, 5.5, 0.55 * reach - 18),
        cyl(a + 30 * way, way, 3 + play, 200),
    )
    drawing.add("gas cylinder", cylinder)
    rod = union(cyl(a + 40 * way, way, 3, reach - 44), cyl(a + 38 * way, way, 5.4, 5), cyl(mid - 8 * Z, Z, 7, 16))
    drawing.add("gas rod", cut(rod, bore(mid, Z, 3 + play, 20)))
    drawing.add("gas pin", cyl(mid - 11.9 * Z, Z, 3, 23.8))
    low, high, stem = c[1] - 10, d[1] + 10, c[0] + 32
    cheeks = [box((c[0] - 9, low, s * 12), (c[0] + 20, high, s * 17)) for s in (-1, 1)]
    knuckle = union(*cheeks, box((c[0] + 12, low, -17), (c[0] + 48, high, 17)))
    drawing.add("knuckle", cut(knuckle, *(bore(p, Z, 4, 30) for p in (c, d)), bore((stem, low, 0), Y, 8 + play)))
    head = at(stem, high + 25, 0)
    turn = union(
        cyl((stem, low - 4, 0), Y, 8, high - low + 6),
        cyl((stem, high, 0), Y, 13, 5),
        box((stem - 8, high + 4, -6), (stem + 8, high + 25, 6)),
        cyl(head - 6 * Z, Z, 8, 12),
    )
    drawing.add("stem", cut(turn, bore(head, Z, 3, 20), tube((stem, low - 1.55, 0), Y, 7, 9, 1.5)))
    drawing.add("circlip", tube((stem, low - 1.5, 0), Y, 7, 11, 1.4).cut(box((stem, low - 9, -2), (stem + 12, low, 2))))
    ears = [box(head + at(0, -9, s * 6.1), head + at(21, 9, s * 10)) for s in (-1, 1)]
    ears += [cyl(head + s * 6.1 * Z, s * Z, 9, 3.9) for s in (-1, 1)]
    plate = union(box(head + at(20, -45, -45), head + at(24, 45, 45)), *ears)
    spots = [head + at(20, y, z) for y in (-37.5, 37.5) for z in (-37.5, 37.5)]
    drawing.add("plate", cut(plate, bore(head, Z, 3.1, 20), *(bore(p, X, 2.2, 10) for p in spots)))
    drawing.add("tilt bolt", cyl(head - 10 * Z, Z, 3, 26).union(hexagon(head - 14 * Z, Z, 5, 4)))
    drawing.add("tilt nut", hexagon(head + 10 * Z, Z, 5, 5, 3))
    monitor = box(head + at(24, -150, -250), head + at(50, 150, 250))
    drawing.add("monitor", cut(monitor, *(cyl(p + 3 * X, X, 2, 12) for p in spots)))
    for k, p in enumerate(spots):
        drawing.add(f"plate screw {k}", screw(p, X, 2, 12))
    drawing.joint("Cylindrical", "clamp screw", "clamp", (0, 0, 0), Y)
    drawing.joint("Spherical", "pad", "clamp screw", ball)
    drawing.joint("Weld", "post", "clamp")
    drawing.joint("Weld", "collar", "post")
    drawing.joint("Revolute", "shoulder", "post", (0, 0, 0), Y)
    for name, one, other in (("lower", a, c), ("upper", b, d)):
        drawing.joint("Revolute", f"{name} link", "shoulder", one, Z)
        drawing.joint("Revolute", f"{name} link", "knuckle", other, Z)
    drawing.joint("Revolute", "gas cylinder", "shoulder", a, Z)
    drawing.joint("Cylindrical", "gas rod", "gas cylinder", a, way)
    drawing.joint("Revolute", "gas rod", "upper link", mid, Z)
    drawing.joint("Revolute", "stem", "knuckle", head, Y)
    drawing.joint("Revolute", "plate", "stem", head, Z)
    drawing.joint("Weld", "monitor", "plate")
    return drawing


@kind
def printer_carriage(random):
    """Two halves about three linear bearings on two rods, a hot end in its groove, an idler in the right end."""
    drawing, play = Drawing(["left end"]), random.choice([0.0, 0.02, 0.1])
    start = random.uniform(70, 130)
    rods = {"upper": at(0, 0, 22.5), "lower": at(0, 0, -22.5)}
    for name, low, wall in (("left", 0, 5), ("right", 230, 255)):
        block = box((low, -12, -36), (low + 30, 12, 36)).edges("|X").chamfer(2)
        block = cut(block, *(cyl(p + wall * X, X if low == 0 else -X, 4, 40) for p in rods.values()))
        block = cut(block, *(cyl(p + (low + 15) * X, Y, 1.5, 30) for p in rods.values()))
        if name == "right":
            block = cut(block, box((230, -4.7, -13), (261, 4.7, 13)), bore((247, 0, 0), Y, 2.5, 30))
        drawing.add(f"{name} end", block)
        for rod, p in rods.items():
            drawing.add(f"{name} {rod} grub screw", cyl(p + at(low + 15, 4, 0), Y, 1.5, 5))
    for name, p in rods.items():
        drawing.add(f"{name} rod", cyl(p + 5 * X, X, 4, 250))
        drawing.joint("Weld", f"{name} rod", "left end")
        drawing.joint("Weld", f"{name} rod", "right end")
    drawing.add("idler", tube((247, -4.5, 0), Y, 2.55, 9, 9))
    drawing.add("idler bolt", screw((247, 12, 0), -Y, 2.5, 30))
    drawing.add("idler nut", hexagon((247, -12, 0), -Y, 4, 4, 2.5))
    bearings = {"first": rods["upper"] + 3 * X, "second": rods["upper"] + 31 * X, "third": rods["lower"] + 17 * X}
    pockets = [cyl(p + start * X, X, 7.5, 24) for p in bearings.values()]
    for name, p in bearings.items():
        drawing.add(f"{name} bearing", tube(p + start * X, X, 4 + play, 7.5, 24))
        drawing.joint("Weld", f"{name} bearing", "carriage")
    spots = [at(start + x, 0, z) for x in (8, 50) for z in (-34, 34)]
    gaps = [*pockets, *(bore(p, X, 6) for p in rods.values()), *(bore(p, Y, 1.6, 40) for p in spots)]
    back = cut(box((start, -12, -39), (start + 58, 0, 39)), *gaps, *(hexagon(p - 9.5 * Y, -Y, 2.8, 5) for p in spots))
    drawing.add("carriage", back)
    hot, clips = at(start + 29, 26, 0), [at(start + 29 + x, 26, -3) for x in (-13, 13)]
    belt = [at(start + 29 + x, 6, 42) for x in (-7, 7)]
    cover = union(box((start, 0, -39), (start + 58, 12, 39)), box((start + 9, 10, -6), (start + 49, 26, 0)))
    cover = cut(cover, *gaps, bore(hot, Z, 6, 30), *(cyl(p, -Y, 1.25, 12) for p in clips))
    drawing.add("cover", cut(cover, *(cyl(p - 3 * Z, -Z, 1.25, 9) for p in belt)))
    for k, p in enumerate(spots):
        drawing.add(f"cover screw {k}", screw(p + 12 * Y, -Y, 1.5, 23))
        drawing.add(f"cover nut {k}", hexagon(p - 9.5 * Y, -Y, 2.75, 2.4, 1.5))
    clip = cut(
        box((start + 9, 26, -6), (start + 49, 34, 0)), bore(hot, Z, 6, 30), *(bore(p, Y, 1.6, 30) for p in clips)
    )
    drawing.add("clip", clip)
    for k, p in enumerate(clips):
        drawing.add(f"clip screw {k}", screw(p + 8 * Y, -Y, 1.25, 18))
    clamp = cut(box((start + 17, 1, 39), (start + 41, 11, 42)), *(bore(p, Z, 1.5, 30) for p in belt))
    drawing.add("belt clamp", clamp)
    for k, p in enumerate(belt):
        drawing.add(f"belt screw {k}", screw(p, -Z, 1.25, 10))
    sink = union(cyl(hot, Z, 8, 4), cyl(hot - 6 * Z, Z, 6, 6), cyl(hot - 9 * Z, Z, 8, 3), cyl(hot - 36 * Z, Z, 11, 27))
    sink = cut(sink, *(tube(hot - z * Z, Z, 5, 12, 1.5) for z in range(15, 36, 5)), bore(hot, Z, 1, 100))
    drawing.add("heat sink", cut(sink, cyl(hot - 36 * Z, Z, 3, 12)))
    drawing.add("heat break", tube(hot - 44 * Z, Z, 1, 3, 20))
    block = box(hot + at(-8, -8, -50), hot + at(12, 8, -39))
    drawing.add("heater block", cut(block, bore(hot, Z, 3, 60), bore(hot + at(7, 0, -44.5), Y, 3.02, 20)))
    drawing.add("heater", cyl(hot + at(7, -10, -44.5), Y, 3, 20))
    nozzle = union(cyl(hot - 50 * Z, Z, 3, 6), hexagon(hot - 53 * Z, Z, 3.5, 3), cyl(hot - 55 * Z, Z, 2, 3))
    drawing.add("nozzle", cut(nozzle, bore(hot, Z, 0.9, 60)))
    drawing.joint("Weld", "cover", "carriage")
    drawing.joint("Prismatic", "carriage", "left end", (0, 0, 0), X)
    drawing.joint("Weld", "heat sink", "cover")
    drawing.joint("Weld", "clip", "cover")
    drawing.joint("Weld", "heater block", "heat break")
    drawing.joint("Weld", "heat break", "heat sink")
    drawing.joint("Weld", "nozzle", "heater block")
    drawing.joint("Weld", "belt clamp", "cover")
    drawing.joint("Revolute", "idler", "right end", (247, 0, 0), Y)
    return drawing
