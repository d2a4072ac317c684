"""What is mounted on frames: a bicycle's fork with the hub of its wheel, a throttle's linkage with rod ends."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, screw, sphere, tube, union


@kind
def suspension_fork(random):
    """A steerer in a headset with a stem, stanchions in bushed lowers, a damper, an axle with hub and disc."""
    drawing, play = Drawing(["head tube"]), random.choice([0.05, 0.15])
    sag = random.uniform(0, 30)
    legs = {"left": at(-60, 0, 0), "right": at(60, 0, 0)}
    drawing.add(
        "crown",
        cut(
            bar(legs["left"], legs["right"], 22, 0, 28),
            *(bore(p, Z, 14.98) for p in legs.values()),
            bore(0 * X, Z, 13.98),
        ),
    )
    drawing.add("steerer", tube((0, 0, 0), Z, 11, 14, 194))
    drawing.add("crown race", tube((0, 0, 28), Z, 14, 18, 4))
    head = cut(tube((0, 0, 33), Z, 16, 25, 118), *(cyl((0, 0, z), Z, 20.5, 8) for z in (32, 144)))
    drawing.add("head tube", head)
    for name, z in (("lower", 32), ("upper", 144)):
        drawing.add(f"{name} headset bearing", tube((0, 0, z), Z, 14, 20.5, 8))
    drawing.add("headset cover", tube((0, 0, 152), Z, 14.05, 24, 5))
    stem = union(cyl((0, 0, 157), Z, 20, 40), box((-14, 0, 165), (14, 60, 189)), box((-12, -30, 157), (12, 0, 197)))
    stem = cut(stem, bore(0 * X, Z, 14), box((-1, -31, 150), (1, 0, 200)))
    pinches = [at(-12, -24, z) for z in (166, 188)]
    stem = cut(stem, *(cyl(p, X, 2.5, 12) for p in pinches), *(cyl(p + 12 * X, X, 2.2, 20) for p in pinches))
    drawing.add("stem", stem)
    for k, p in enumerate(pinches):
        drawing.add(f"stem bolt {k}", screw(p, X, 2.2, 24))
    drawing.add("star nut", tube((0, 0, 165), Z, 3, 11, 8))
    drawing.add("top cap", cut(cyl((0, 0, 197), Z, 17, 4), bore(0 * X, Z, 3.2)))
    drawing.add("top cap bolt", screw((0, 0, 201), -Z, 3, 34))
    foot, low = -400 + sag, -150 + sag
    arch = union(
        box((-60, 22, low - 24), (60, 30, low - 4)),
        *(box((p[0] - 8, 0, low - 24), (p[0] + 8, 30, low - 4)) for p in legs.values()),
    )
    axle, right = at(0, 18, foot - 16), legs["right"]
    shells = [union(cyl(p + foot * Z, Z, 20, low - foot), cyl(p + (foot - 20) * Z, Z, 10, 24)) for p in legs.values()]
    ends = [cyl(axle + (p[0] - 9) * X, X, 13, 18) for p in legs.values()]
    lowers = cut(union(arch, *shells, *ends), *(cyl(p + (foot + 6) * Z, Z, 16, 300) for p in legs.values()))
    lowers = cut(lowers, *(cyl(p + (low - 8) * Z, Z, 18, 20) for p in legs.values()), bore(axle, X, 7.5, 100))
    lowers = cut(lowers, bore(right + foot * Z, Z, 2.7, 10), cyl(right + (foot - 2) * Z, -Z, 6.5, 40))
    drawing.add("lowers", lowers)
    for name, p in legs.items():
        drawing.add(f"{name} stanchion", tube(p - 250 * Z, Z, 12.5, 15, 278))
        for k, z in enumerate((low - 28, foot + 160)):
            drawing.add(f"{name} bush {k}", tube(p + z * Z, Z, 15 + play, 16, 18))
        drawing.add(f"{name} seal", tube(p + (low - 8) * Z, Z, 15, 18, 9))
        drawing.joint("Weld", f"{name} stanchion", "crown")
    drawing.add("gland", union(tube(right - 250 * Z, Z, 4.02, 12.5, 12), tube(right - 252 * Z, Z, 4.02, 14.5, 2)))
    rod = union(cyl(right + (foot + 6) * Z, Z, 4, 220 - sag))
    drawing.add("damper rod", cut(rod, cyl(right + foot * Z, Z, 2.5, 22)))
    top = foot + 226 - sag
    drawing.add(
        "damper piston",
        union(cyl(right + top * Z, Z, 12.3, 8), cyl(right + (top - 3) * Z, Z, 6, 3)).cut(
            cyl(right + (top - 9) * Z, Z, 4, 9)
        ),
    )
    drawing.add("foot bolt", screw(right + (foot - 2) * Z, Z, 2.5, 22))
    drawing.add("axle", union(cyl(axle - 69 * X, X, 7.5, 138), cyl(axle - 77 * X, X, 11, 8)))
    hub = union(cyl(axle - 36 * X, X, 18, 72), *(cyl(axle + (s * 30 - 2) * X, X, 28, 4) for s in (-1, 1)))
    hub = cut(hub, bore(axle, X, 9), *(cyl(axle + s * 29 * X, s * X, 14, 20) for s in (-1, 1)))
    discs = [axle + 36 * X + 16 * at(0, np.cos(a), np.sin(a)) for a in np.arange(4) * np.pi / 2 + 0.4]
    drawing.add("hub", cut(hub, *(cyl(p, -X, 1.2, 3.9) for p in discs)))
    for s in (-1, 1):
        drawing.add(f"hub bearing {s}", tube(axle + s * 29 * X, s * X, 7.5, 14, 7))
        drawing.add(f"end cap {s}", tube(axle + s * 36 * X, s * X, 7.55, 10, 15))
    disc = cut(tube(axle + 36 * X, X, 12, 80, 1.8), *(bore(p, X, 1.3, 5) for p in discs))
    drawing.add("disc", disc)
    for k, p in enumerate(discs):
        drawing.add(f"disc screw {k}", screw(p + 1.8 * X, -X, 1.2, 5))
    drawing.joint("Weld", "steerer", "crown")
    drawing.joint("Revolute", "steerer", "head tube", 0 * X, Z)
    drawing.joint("Weld", "stem", "steerer")
    drawing.joint("Prismatic", "lowers", "crown", 0 * X, Z)
    drawing.joint("Weld", "gland", "right stanchion")
    drawing.joint("Weld", "damper rod", "lowers")
    drawing.joint("Weld", "damper piston", "damper rod")
    drawing.joint("Weld", "axle", "lowers")
    drawing.joint("Revolute", "hub", "lowers", axle, X)
    drawing.joint("Weld", "disc", "hub")
    return drawing


def rod_end(drawing, name: str, middle, way, play: float):
    """A housing with a ball in it; the shank points along the way and is bored for a rod."""
    socket = union(cyl(middle - 3 * Z, Z, 9, 6), cyl(middle + 6 * way, way, 4.5, 20))
    drawing.add(f"{name} housing", cut(socket, sphere(middle, 6 + play), cyl(middle + 14 * way, way, 3, 20)))
    ball = cut(sphere(middle, 6), box(middle + at(-9, -9, 4), middle + 9), box(middle - 9, middle + at(9, 9, -4)))
    drawing.add(f"{name} ball", cut(ball, bore(middle, Z, 2.5, 20)))
    drawing.add(f"{name} jam nut", hexagon(middle + 26 * way, way, 5, 3.5, 3))


@kind
def throttle_linkage(random):
    """A pedal on a shoulder bolt, a bell crank on two bearings, two rods with rod ends, a lever on a shaft."""
    drawing, play = Drawing(["plate"]), random.choice([0.02, 0.1])
    pedal, crank, shaft = at(0, 0, 0), at(150, random.uniform(40, 60), 0), at(210, -90, 0)
    plate = cut(box((-40, -120, -10), (260, 120, 0)), cyl(pedal, -Z, 4, 30), cyl(crank, -Z, 3, 30))
    blocks = [at(x, -90, 0) for x in (192, 228)]
    drawing.add("plate", cut(plate, *(cyl(p, -Z, 2, 30) for p in blocks)))
    tips = {"pedal": pedal + 50 * Y, "crank in": crank + at(-8, 45, 0), "crank out": crank + at(45, 0, 0)}
    tips["lever"] = shaft + at(38, -random.uniform(0, 8), 0)
    arm = union(
        bar(pedal, tips["pedal"], 10, 4, 12), bar(at(0, -90, 0), pedal, 10, 4, 12), cyl(pedal + 2 * Z, Z, 12, 12)
    )
    drawing.add(
        "pedal",
        cut(
            arm,
            bore(pedal, Z, 6.5, 40),
            bore(tips["pedal"], Z, 2.5, 40),
            *(bore((0, -90 + y, 0), Z, 1.7, 40) for y in (-4, 10)),
        ),
    )
    for name, z, s in (("lower", 2, 1), ("upper", 14, -1)):
        drawing.add(
            f"{name} bush",
            union(tube(pedal + z * Z, s * Z, 5 + play, 6.5, 5.5), tube(pedal + z * Z, -s * Z, 5 + play, 9, 1.5)),
        )
    drawing.add("pedal washer", tube(pedal, Z, 5.2, 11, 0.5))
    bolt = union(cyl(pedal, Z, 5, 15.7), cyl(pedal, -Z, 4, 9), cyl(pedal + 15.7 * Z, Z, 8, 5))
    drawing.add("pedal bolt", cut(bolt, hexagon(pedal + 17.7 * Z, Z, 2.5, 5)))
    pad = cut(box((-20, -105, 12), (20, -75, 16)), *(bore((0, -90 + y, 0), Z, 1.7, 40) for y in (-4, 10)))
    drawing.add("foot pad", pad)
    for k, y in enumerate((-4, 10)):
        drawing.add(f"pad screw {k}", screw((0, -90 + y, 16), -Z, 1.5, 15))
        drawing.add(f"pad nut {k}", hexagon((0, -90 + y, 4), -Z, 2.75, 2.4, 1.5))
    bell = union(*(bar(crank, tips[n], 9, 4, 12) for n in ("crank in", "crank out")), cyl(crank + 2 * Z, Z, 14, 12))
    bell = cut(bell, bore(crank, Z, 7.5, 40), *(bore(tips[n], Z, 2.5, 40) for n in ("crank in", "crank out")))
    drawing.add("bell crank", cut(bell, cyl(crank, Z, 9.5, 6), cyl(crank + 10 * Z, Z, 9.5, 9)))
    for name, z in (("lower", 2), ("upper", 10)):
        drawing.add(f"{name} bearing", tube(crank + z * Z, Z, 3, 9.5, 4))
    drawing.add("crank standoff", tube(crank, Z, 3.1, 5, 2))
    drawing.add("crank spacer", tube(crank + 6 * Z, Z, 3.1, 5, 4))
    drawing.add("crank screw", screw(crank + 14 * Z, -Z, 3, 23))
    block = union(box((184, -102, 0), (236, -78, 6)), cyl(shaft, Z, 11, 14))
    drawing.add(
        "bearing block",
        cut(block, bore(shaft, Z, 4 + play), cyl(shaft, Z, 7, 3), *(bore(p, Z, 2.2, 9) for p in blocks)),
    )
    for k, p in enumerate(blocks):
        drawing.add(f"block screw {k}", screw(p + 6 * Z, -Z, 2, 14))
    ring = tube(shaft + 1.9 * Z, Z, 3.4, 6, 1)
    drawing.add("shaft", cut(union(cyl(shaft + Z, Z, 4, 32), cyl(shaft + 14.1 * Z, Z, 6, 1.9)), ring))
    drawing.add("retaining ring", ring.cut(box(shaft + at(0, -2, 1), shaft + at(9, 2, 4))))
    lever = cut(union(bar(shaft, tips["lever"], 8, 16, 24), cyl(shaft + 16 * Z, Z, 10, 8)), bore(shaft, Z, 4))
    drawing.add("throttle lever", cut(lever, bore(tips["lever"], Z, 2.5), cyl(shaft + 20 * Z, -X, 1.5, 20)))
    drawing.add("lever grub screw", cyl(shaft + 20 * Z - 4 * X, -X, 1.5, 5))
    owners = {"pedal": "pedal", "crank in": "bell crank", "crank out": "bell crank", "lever": "throttle lever"}
    for name, one, other in (("pedal rod", "pedal", "crank in"), ("throttle rod", "crank out", "lever")):
        ends = {n: tips[n] + 32 * Z for n in (one, other)}
        way = (ends[other] - ends[one]) / np.linalg.norm(ends[other] - ends[one])
        for n, along in ((one, way), (other, -way)):
            thick, top = (24 if n == "lever" else 12), 28
            rod_end(drawing, n, ends[n], along, play / 2)
            drawing.add(f"{n} stud", headed(tips[n] + (thick - 8) * Z, Z, 2.5, 32 - thick + 8 + 4 + 5))
            drawing.add(f"{n} spacer", tube(tips[n] + thick * Z, Z, 2.6, 3.5, top - thick))
            drawing.add(f"{n} nut", hexagon(tips[n] + 36 * Z, Z, 4, 4, 2.5))
            drawing.joint("Spherical", f"{n} housing", owners[n], ends[n])
            drawing.joint("Weld", f"{n} housing", name)
        reach = float(np.linalg.norm(ends[other] - ends[one]))
        drawing.add(name, cyl(ends[one] + 16 * way, way, 3, reach - 32))
    drawing.joint("Revolute", "pedal", "plate", pedal, Z)
    drawing.joint("Weld", "foot pad", "pedal")
    drawing.joint("Revolute", "bell crank", "plate", crank, Z)
    drawing.joint("Weld", "bearing block", "plate")
    drawing.joint("Revolute", "shaft", "bearing block", shaft, Z)
    drawing.joint("Weld", "throttle lever", "shaft")
    return drawing
