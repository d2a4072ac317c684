"""What bends on bearings: a robot's finger, a SCARA arm, a bicycle's fork with its wheel hub, a throttle's linkage."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import ball_bearing
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
def robot_finger(random):
    """Three phalanges on pins with loose pulleys for a tendon, a servo in the palm with a spool, a pad, a lid."""
    drawing, play = Drawing(["palm"]), random.choice([0.03, 0.1])
    turns, lengths = np.cumsum(random.uniform(0.15, 0.5, 3)), (45.0, 34.0, 30.0)
    ways = [at(np.cos(t), np.sin(t), 0) for t in turns]
    joints = [at(0, 0, 0)]
    for way, length in zip(ways, lengths, strict=True):
        joints.append(joints[-1] + length * way)
    palm = union(box((-66, -12, -15), (-12, 10, 15)), box((-14, -8, -11), (-8, 8, 11)))
    palm = union(palm, *(bar(at(-12, 0, 0), at(0, 0, 0), 6, s * 9 - 2, s * 9 + 2) for s in (-1, 1)))
    palm = cut(palm, box((-52, -6.1, -12.5), (-28.9, 6.1, 16)), bore(joints[0], Z, 1.5, 20))
    lids = [at(x, 10, z) for x in (-62, -18) for z in (-11, 11)]
    palm = cut(palm, *(cyl(p, -Y, 1, 9) for p in lids))
    ears = [at(x, 0, 15) for x in (-55.5, -24.5)]
    drawing.add("palm", cut(palm, *(cyl(p, -Z, 0.95, 9) for p in ears)))
    lid = cut(box((-66, 10, -15), (-12, 12, 15)), *(bore(p, Y, 1.2, 9) for p in lids))
    drawing.add("lid", lid)
    for k, p in enumerate(lids):
        drawing.add(f"lid screw {k}", screw(p + 2 * Y, -Y, 1, 8))
    names, owners = ("proximal", "middle", "distal"), ("palm", "proximal", "middle")
    for k, (name, owner, way) in enumerate(zip(names, owners, ways, strict=True)):
        low, high = joints[k], joints[k + 1]
        shapes = [bar(low + 14 * way, high - (14 if k < 2 else 7) * way, 7, -11, 11)]
        shapes += [bar(low, low + 14 * way, 6, s * 4.75 - 2.15, s * 4.75 + 2.15) for s in (-1, 1)]
        if k < 2:
            shapes += [bar(high - 14 * way, high, 6, s * 9 - 2, s * 9 + 2) for s in (-1, 1)]
        shape = cut(union(*shapes), bore(low, Z, 1.5 + play, 20))
        if k < 2:
            shape = cut(shape, bore(high, Z, 1.5, 20))
        else:
            side = np.cross(Z, way)
            tip = low + 18 * way
            shape = cut(shape, cyl(tip, side, 0.95, 20), cyl(tip - 3 * side, -side, 40, 20))
            pad = union(bar(tip - 4 * way, tip + 8 * way, 5, -9, 9))
            pad = cut(pad, cyl(tip - 3 * side, side, 40, 20), bore(tip, side, 1.2, 20))
            drawing.add("pad", cut(pad, cyl(tip - 4 * side, -side, 2, 9)))
            drawing.add("pad screw", screw(tip - 4 * side, side, 1, 6))
            drawing.joint("Weld", "pad", "distal")
        drawing.add(name, shape)
        drawing.add(f"{name} pin", cyl(low - 11 * Z, Z, 1.5, 22) if k else rivet(low - 11 * Z, Z, 1.5, 22))
        groove = torus(low, Z, 5.6, 1.2)
        drawing.add(f"{name} pulley", cut(tube(low - 2.4 * Z, Z, 1.55, 5, 4.8), groove))
        drawing.joint("Revolute", name, owner, low, Z)
        drawing.joint("Revolute", f"{name} pulley", owner, low, Z)
    axle = at(-34.5, 0, 12)
    servo = union(box((-51.5, -6, -10), (-29.4, 6, 22)), box((-59, -6, 15), (-21, 6, 17.5)), cyl(axle, Z, 5.8, 14))
    servo = cut(servo, cyl(axle, Z, 2.42, 40), *(bore(p, Z, 1.1, 9) for p in ears))
    drawing.add("servo", servo)
    for k, p in enumerate(ears):
        drawing.add(f"servo screw {k}", screw(p + 2.5 * Z, -Z, 0.95, 9))
    drawing.add("servo shaft", cut(cyl(axle, Z, 2.4, 17), cyl(axle + 8 * Z, Z, 0.9, 20)))
    spool = cut(cyl(axle + 14.4 * Z, Z, 8, 7), tube(axle + 15.9 * Z, Z, 6, 9, 3))
    spool = cut(spool, cyl(axle, Z, 2.4, 17), bore(axle, Z, 1.1, 30), cyl(axle + 20 * Z, Z, 2.2, 9))
    drawing.add("spool", spool)
    drawing.add("spool screw", screw(axle + 20 * Z, -Z, 0.9, 9))
    drawing.joint("Weld", "lid", "palm")
    drawing.joint("Weld", "servo", "palm")
    drawing.joint("Revolute", "servo shaft", "servo", axle, Z)
    drawing.joint("Weld", "spool", "servo shaft")
    return drawing


@kind
def scara_arm(random):
    """A shoulder shaft in two solid bearings with spacers, an elbow on ball bearings, a quill in two bushes, a motor."""
    drawing, play = Drawing(["base"], unit="INCH"), random.choice([0.02, 0.1])
    o, elbow, turn = at(0, 0, 0), at(140, 0, 0), random.uniform(0.5, 1.2)
    way = at(np.cos(turn), np.sin(turn), 0)
    wrist, mid = elbow + 120 * way, elbow + 62 * way
    spots = [28.5 * at(np.cos(a), np.sin(a), 0) for a in np.arange(3) * 2 * np.pi / 3]
    base = union(cyl(o, Z, 60, 10), cyl(o, Z, 35, 90))
    base = cut(base, cyl(o + 15 * Z, Z, 20, 90), cyl(o + 60 * Z, Z, 22, 40), *(cyl(p + 92 * Z, -Z, 2, 16) for p in spots))
    drawing.add("base", base)
    for k, z in enumerate((60, 81)):
        drawing.add(f"shoulder bearing {k}", tube(o + z * Z, Z, 12, 22, 9))
    drawing.add("inner spacer", tube(o + 69 * Z, Z, 12.05, 15, 12))
    drawing.add("outer spacer", tube(o + 69 * Z, Z, 19, 21.9, 12))
    drawing.add("bearing cap", cut(tube(o + 90 * Z, Z, 17, 35, 4), *(bore(p, Z, 2.2, 200) for p in spots)))
    for k, p in enumerate(spots):
        drawing.add(f"cap screw {k}", screw(p + 94 * Z, -Z, 2, 16))
    holes = [21 * at(np.cos(a), np.sin(a), 0) for a in np.arange(3) * 2 * np.pi / 3 + 0.6]
    shaft = union(cyl(o + 46 * Z, Z, 12, 60), cyl(o + 90 * Z, Z, 15, 10), cyl(o + 99 * Z, Z, 26, 7))
    drawing.add("shoulder shaft", cut(shaft, *(cyl(p + 107 * Z, -Z, 2, 20) for p in holes)))
    drawing.add("shaft nut", hexagon(o + 50 * Z, Z, 16.5, 10, 12))
    arm = cut(bar(o, elbow, 26, 106, 122), *(bore(p, Z, 2.2, 200) for p in holes))
    arm = cut(arm, bore(elbow, Z, 9, 200), cyl(elbow, Z, 11, 113), cyl(elbow + 115 * Z, Z, 11, 20))
    drawing.add("upper arm", cut(arm, *(cyl(p + 115 * Z, Z, 3.7, 20) for p in holes)))
    for k, p in enumerate(holes):
        drawing.add(f"arm screw {k}", screw(p + 115 * Z, -Z, 2, 15))
    for name, z in (("low", 106.0), ("high", 115.0)):
        ball_bearing(drawing, f"elbow {name}", elbow + z * Z, Z, 4, 11, 7)
    for name, z in (("low", 105.0), ("high", 122.0)):
        drawing.add(f"elbow {name} washer", tube(elbow + z * Z, Z, 4.1, 5.9, 1))
    drawing.add("elbow bolt", cyl(elbow + 94 * Z, Z, 4, 41).union(hexagon(elbow + 135 * Z, Z, 6.5, 5.3)))
    drawing.add("elbow nut", hexagon(elbow + 98 * Z, Z, 6.5, 7, 4))
    arm = union(bar(elbow, wrist, 22, 123, 135), cyl(wrist + 123 * Z, Z, 14, 40))
    corners = [mid + s * 11.5 * at(np.cos(turn + 0.8), np.sin(turn + 0.8), 0) for s in (-1, 1)]
    arm = cut(arm, bore(elbow, Z, 4, 200), bore(wrist, Z, 8, 200), *(bore(p, Z, 1.4, 200) for p in corners))
    drawing.add("forearm", cut(arm, bore(mid, Z, 5, 200)))
    for name, z, s in (("low", 123.0, -1), ("high", 163.0, 1)):
        bush = union(tube(wrist + z * Z, -s * Z, 6 + play, 8, 14), tube(wrist + z * Z, s * Z, 6 + play, 11, 2))
        drawing.add(f"{name} bush", bush)
    drawing.add("quill", cyl(wrist + 50 * Z, Z, 6, 180).faces(">Z").chamfer(0.8))
    for name, z, radius in (("tool flange", 50.0, 18), ("stop", 210.0, 11)):
        ring = tube(wrist + z * Z, Z, 6, radius, 10)
        drawing.add(name, cut(ring, cyl(wrist + (z + 5) * Z, X, 1.5, 40)))
        drawing.add(f"{name} grub screw", cyl(wrist + (z + 5) * Z + 6 * X, X, 1.5, 4))
        drawing.joint("Weld", name, "quill")
    motor = union(cyl(mid + 135 * Z, Z, 15, 32))
    motor = cut(motor, cyl(mid + 100 * Z, Z, 2.52, 63), *(cyl(p + 130 * Z, Z, 1.25, 12) for p in corners))
    drawing.add("motor", motor)
    for k, p in enumerate(corners):
        drawing.add(f"motor screw {k}", screw(p + 123 * Z, Z, 1.25, 17))
    drawing.add("motor shaft", cyl(mid + 108 * Z, Z, 2.5, 55))
    pulley = cut(tube(mid + 108.5 * Z, Z, 2.5, 8, 13), tube(mid + 110 * Z, Z, 7, 9, 5))
    drawing.add("pulley", cut(pulley, cyl(mid + 118.5 * Z, Y, 1.25, 20)))
    drawing.add("pulley grub screw", cyl(mid + 118.5 * Z + 2.5 * Y, Y, 1.25, 4))
    drawing.joint("Revolute", "shoulder shaft", "base", o, Z)
    drawing.joint("Weld", "bearing cap", "base")
    drawing.joint("Weld", "upper arm", "shoulder shaft")
    drawing.joint("Revolute", "forearm", "upper arm", elbow, Z)
    drawing.joint("Weld", "low bush", "forearm")
    drawing.joint("Weld", "high bush", "forearm")
    drawing.joint("Cylindrical", "quill", "forearm", wrist, Z)
    drawing.joint("Weld", "motor", "forearm")
    drawing.joint("Revolute", "motor shaft", "motor", mid, Z)
    drawing.joint("Weld", "pulley", "motor shaft")
    return drawing


@kind
def suspension_fork(random):
    """A steerer in a headset with a stem, stanchions in the bushes of the lowers, a damper, an axle with hub and disc."""
    drawing, play = Drawing(["head tube"]), random.choice([0.05, 0.15])
    sag = random.uniform(0, 30)
    legs = {"left": at(-60, 0, 0), "right": at(60, 0, 0)}
    drawing.add("crown", cut(bar(legs["left"], legs["right"], 22, 0, 28), *(bore(p, Z, 15) for p in legs.values()),
                             bore(0 * X, Z, 14)))  # fmt: skip
    drawing.add("steerer", tube((0, 0, 0), Z, 11, 14, 194))
    drawing.add("crown race", tube((0, 0, 28), Z, 14, 18, 4))
    head = cut(tube((0, 0, 33), Z, 16, 25, 118), *(cyl((0, 0, z), Z, 20.5, 8) for z in (32, 144)))
    drawing.add("head tube", head)
    for name, z in (("lower", 32), ("upper", 144)):
        drawing.add(f"{name} headset bearing", tube((0, 0, z), Z, 14, 20.5, 8))
    drawing.add("headset cover", union(tube((0, 0, 152), Z, 14.05, 24, 5), tube((0, 0, 151.8), Z, 14.05, 17, 1)))
    drawing.parts["headset cover"] = tube((0, 0, 152), Z, 14.05, 24, 5)
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
    arch = union(box((-60, 22, low - 24), (60, 30, low - 4)), *(box((p[0] - 8, 0, low - 24), (p[0] + 8, 30, low - 4))
                                                             for p in legs.values()))  # fmt: skip
    drop = foot - 8
    shells = [union(cyl(p + foot * Z, Z, 20, low - foot), bar(p, p, 16, foot - 24, foot + 4)) for p in legs.values()]
    axle = at(0, 0, drop - 4)
    tabs = [at(50, -28, z) for z in (foot + 45, foot + 95)]
    lugs = [box(p + at(0, 0, -7), p + at(8, 14, 7)) for p in tabs]
    lowers = cut(union(arch, *shells, *lugs), *(cyl(p + (foot + 6) * Z, Z, 16, 300) for p in legs.values()))
    lowers = cut(lowers, *(cyl(p + (low - 8) * Z, Z, 18, 20) for p in legs.values()), bore(axle, X, 7.5, 100))
    lowers = cut(lowers, bore(legs["right"] + foot * Z, Z, 4, 10), *(bore(p, X, 2.5, 9) for p in tabs))
    drawing.add("lowers", cut(lowers, cyl(legs["right"] + (foot - 2) * Z, -Z, 6.5, 40)))
    for name, p in legs.items():
        drawing.add(f"{name} stanchion", tube(p - 250 * Z, Z, 12.5, 15, 278))
        for k, z in enumerate((low - 28, foot + 120)):
            drawing.add(f"{name} bush {k}", tube(p + z * Z, Z, 15 + play, 16, 18))
        drawing.add(f"{name} seal", tube(p + (low - 8) * Z, Z, 15, 18, 9))
        drawing.joint("Weld", f"{name} stanchion", "crown")
    right = legs["right"]
    drawing.add("gland", union(tube(right - 250 * Z, Z, 4.02, 12.5, 12), tube(right - 252 * Z, Z, 4.02, 14.5, 2)))
    rod = union(cyl(right + (foot + 6) * Z, Z, 4, 220 - sag))
    drawing.add("damper rod", cut(rod, cyl(right + foot * Z, Z, 2.5, 22)))
    top = foot + 226 - sag
    drawing.add("damper piston", union(cyl(right + top * Z, Z, 12.3, 8), cyl(right + (top - 3) * Z, Z, 6, 3))
                .cut(cyl(right + (top - 9) * Z, Z, 4, 9)))  # fmt: skip
    drawing.add("foot bolt", screw(right + (foot - 2) * Z, Z, 2.5, 22))
    thick = cyl(axle - 85 * X, X, 7.5, 170)
    drawing.add("axle", union(thick, cyl(axle - 89 * X, X, 11, 13)))
    hub = union(cyl(axle - 36 * X, X, 18, 72), *(cyl(axle + (s * 30 - 2) * X, X, 28, 4) for s in (-1, 1)))
    hub = cut(hub, bore(axle, X, 9), *(cyl(axle + s * 29 * X, s * X, 14, 20) for s in (-1, 1)))
    discs = [axle + 36 * X + 16 * at(0, np.cos(a), np.sin(a)) for a in np.arange(4) * np.pi / 2 + 0.4]
    drawing.add("hub", cut(hub, *(cyl(p, -X, 1.2, 3.9) for p in discs)))
    for s in (-1, 1):
        drawing.add(f"hub bearing {s}", tube(axle + s * 29 * X, s * X, 7.5, 14, 7))
        drawing.add(f"end cap {s}", tube(axle + s * 36 * X, s * X, 7.55, 10, 8))
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
    arm = union(bar(pedal, tips["pedal"], 10, 4, 12), bar(at(0, -90, 0), pedal, 10, 4, 12), cyl(pedal + 2 * Z, Z, 12, 12))
    drawing.add("pedal", cut(arm, bore(pedal, Z, 6.5, 40), bore(tips["pedal"], Z, 2.5, 40),
                             *(bore((0, -90 + y, 0), Z, 1.7, 40) for y in (-4, 10))))  # fmt: skip
    for name, z, s in (("lower", 2, 1), ("upper", 14, -1)):
        drawing.add(f"{name} bush", union(tube(pedal + z * Z, s * Z, 5 + play, 6.5, 5.5),
                                          tube(pedal + z * Z, -s * Z, 5 + play, 9, 1.5)))  # fmt: skip
    drawing.add("pedal washer", tube(pedal, Z, 5.2, 11, 0.5))
    bolt = union(cyl(pedal, Z, 5, 15.7), cyl(pedal, -Z, 4, 9), cyl(pedal + 15.7 * Z, Z, 8, 5))
    drawing.add("pedal bolt", cut(bolt, hexagon(pedal + 17.7 * Z, Z, 2.5, 5)))
    pad = cut(box((-20, -105, 12), (20, -75, 16)), *(bore((0, -90 + y, 0), Z, 1.7, 40) for y in (-4, 10)))
    drawing.add("foot pad", pad)
    for k, y in enumerate((-4, 10)):
        drawing.add(f"pad screw {k}", screw((0, -90 + y, 16), -Z, 1.5, 16))
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
    drawing.add("bearing block", cut(block, bore(shaft, Z, 4 + play), *(bore(p, Z, 2.2, 9) for p in blocks)))
    for k, p in enumerate(blocks):
        drawing.add(f"block screw {k}", screw(p + 6 * Z, -Z, 2, 14))
    drawing.add("shaft", union(cyl(shaft + Z, Z, 4, 32), cyl(shaft + 14.1 * Z, Z, 6, 1.9)))
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
