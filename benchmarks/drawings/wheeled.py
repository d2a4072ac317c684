"""Things on wheels: a swerve module of a robot, the jockey wheel of a trailer, a skate with three wheels."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.pinched import bolt, cone, core, grub, nut, put, sink, socket, sunk, through, washer
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, hexagon, torus, tube, union


def around(radius: float, number: int, turn: float = 0.0) -> list[np.ndarray]:
    """Points of the plane xy, evenly spread on a circle."""
    angles = turn + 2 * np.pi * np.arange(number) / number
    return [radius * at(np.cos(a), np.sin(a), 0) for a in angles]


def on_y(radius: float, number: int, middle, turn: float = 0.0) -> list[np.ndarray]:
    """Points of a plane xz, evenly spread on a circle about a point."""
    return [middle + at(p[0], 0, p[1]) for p in around(radius, number, turn)]


@kind
def swerve_module(random):
    """A robot's wheel on an axle in a yoke that turns in a slewing ring; a shaft in the middle drives it by bevels."""
    drawing, wide, rim = Drawing(["plate"]), random.choice([18.0, 20.0, 22.0]), random.uniform(37, 42)
    hub, o = at(0, 0, -62), at(0, 0, 0)
    cap_at, bridge_at = around(38.5, 3, 0.2), [at(58, y, 8) for y in (-24, 24)]
    corners = [at(x, y, 0) for x in (-62, 62) for y in (-62, 62)]
    plate = cut(box((-70, -70, -2), (70, 70, 8)), cyl(o, Z, 35, 9), cyl(-3 * Z, Z, 33, 9))
    plate = cut(plate, *(core(p + 8 * Z, -Z, 3, 7) for p in cap_at), *(core(p, -Z, 5, 11) for p in bridge_at))
    drawing.add("plate", cut(plate, *(through(p, Z, 6) for p in corners)))
    put(drawing, "outer race", tube(o, Z, 29.6, 35, 8), "plate")
    ring = cut(tube(8 * Z, Z, 32, 42, 2.5), *(sink(p + 10.5 * Z, -Z, 3) for p in cap_at))
    put(drawing, "retaining ring", ring, "plate", "outer race")
    for k, p in enumerate(cap_at):
        put(drawing, f"ring screw {k}", sunk(p + 10.5 * Z, -Z, 3, 8), "retaining ring", "plate")
    drawing.add("inner race", tube(o, Z, 25, 29.4, 8))
    drawing.joint("Revolute", "inner race", "outer race", o, Z)
    gear_at, low, high = around(19.5, 3, 0.7), -20.0, 24 + wide + 4
    yoke = union(cyl(-12 * Z, Z, 27, 12), cyl(o, Z, 25, 15), box((-16, low, -12), (16, high + 8, -3)))
    for y in (low, high):
        yoke = union(yoke, box((-14, y, -62), (14, y + 8, -3)), cyl(hub + y * Y, Y, 14, 8))
    yoke = union(yoke, cyl(hub + (wide + 24.1) * Y, Y, 6, 5))
    yoke = cut(yoke, cyl(-13 * Z, Z, 11, 8), cyl(-9 * Z, Z, 9, 30), cyl(6 * Z, Z, 11, 30), bore(hub, Y, 4.05, 90))
    put(drawing, "yoke", cut(yoke, *(core(p + 15 * Z, -Z, 3, 11) for p in gear_at)), "inner race")
    gear = union(cyl(11.5 * Z, Z, 45, 8), cyl(8 * Z, Z, 27.5, 4)).cut(cyl(7 * Z, Z, 25, 8))
    gear = cut(gear, bore(o, Z, 9), *(through(p, Z, 3) for p in gear_at))
    put(drawing, "steering gear", gear, "yoke", "inner race")
    for k, p in enumerate(gear_at):
        put(drawing, f"steering gear screw {k}", socket(p + 19.5 * Z, -Z, 3, 14), "steering gear", "yoke")
    for name, z in (("lower", -10), ("upper", 6)):
        put(drawing, f"{name} bearing", tube(z * Z, Z, 5.01, 11, 5), "yoke")
    shaft = cut(cyl(-44.7 * Z, Z, 5, 76.5), box((3, -1.5, 25), (6, 1.5, 31)), core(31.8 * Z, -Z, 4, 14))
    drawing.add("drive shaft", shaft)
    pinion = union(cone(-44.7 * Z, Z, 6.2, 9.2, 8), cyl(-36.7 * Z, Z, 9.2, 10))
    put(drawing, "bevel pinion", cut(pinion, bore(o, Z, 5, 90), core(-30 * Z, X, 4, 12)), "drive shaft")
    put(drawing, "pinion set screw", grub(at(9.1, 0, -30), -X, 4, 4.1), "bevel pinion", "drive shaft")
    put(drawing, "lower spacer", tube(-26.7 * Z, Z, 5.05, 7, 16.7), "drive shaft", "bevel pinion")
    put(drawing, "upper spacer", tube(11 * Z, Z, 5.05, 7, 13), "drive shaft")
    gear = cut(cyl(24 * Z, Z, 30, 8), bore(o, Z, 5), box((0, -1.5, 23), (6.6, 1.5, 33)))
    put(drawing, "drive gear", cut(gear, *(bore(p, Z, 6) for p in around(18, 5, 0.6))), "drive shaft", "upper spacer")
    put(drawing, "drive key", box((3, -1.5, 25), (6.4, 1.5, 31)), "drive shaft", "drive gear")
    put(drawing, "drive washer", tube(32 * Z, Z, 2.2, 8, 1.5), "drive gear")
    put(drawing, "drive screw", socket(33.5 * Z, -Z, 4, 13), "drive shaft", "drive washer")
    for name in ("lower bearing", "upper bearing"):
        drawing.joint("Revolute", "drive shaft", name, o, Z)
    bevel_at = on_y(14.5, 3, hub, 0.5)
    core_ = cut(cyl(hub + 20 * Y, Y, rim - 8, wide + 4), bore(hub, Y, 8), cyl(hub + 19 * Y, Y, 11, 6))
    core_ = cut(core_, cyl(hub + (wide + 19) * Y, Y, 11, 9), *(core(p + 19 * Y, Y, 3, 9) for p in bevel_at))
    bevel = union(cone(hub + 6.5 * Y, Y, 16.9, 25, 3), cyl(hub + 9.5 * Y, Y, 25, 4), cyl(hub + 13 * Y, Y, 20, 7))
    bevel = cut(bevel, bore(hub, Y, 11, 90), *(through(p, Y, 3) for p in bevel_at))
    bevel = cut(bevel, *(cyl(p, Y, 3, 12) for p in bevel_at))
    drawing.add("wheel hub", core_)
    put(drawing, "bevel gear", bevel, "wheel hub")
    for k, p in enumerate(bevel_at):
        put(drawing, f"bevel screw {k}", socket(p + 12 * Y, Y, 3, 14), "bevel gear", "wheel hub")
    put(drawing, "tread", tube(hub + 20 * Y, Y, rim - 8, rim, wide + 4), "wheel hub")
    for name, y in (("inner", 20), ("outer", wide + 19)):
        put(drawing, f"{name} wheel bearing", tube(hub + y * Y, Y, 4.01, 11, 5), "wheel hub")
        drawing.joint("Revolute", f"{name} wheel bearing", "axle", hub, Y)
    drawing.add("axle", bolt(hub + low * Y, Y, 8, high + 8 - low + 9))
    drawing.joint("Weld", "axle", "yoke")
    put(drawing, "axle nut", nut(hub + (high + 8) * Y, Y, 8), "axle", "yoke")
    put(drawing, "long spacer", tube(hub + (low + 8) * Y, Y, 4.05, 5.5, 12 - low), "axle", "yoke")
    bridge = union(box((50, -32, 8), (66, 32, 14)), box((56, -32, 8), (66, 32, 56)), box((18, -32, 50), (66, 32, 56)))
    motor_at = at(42.2, 0, 0)
    bridge = cut(bridge, cyl(at(42.2, 0, 40), Z, 8, 30), *(through(p + 6 * Z, Z, 5, 8) for p in bridge_at))
    bridge = cut(bridge, cyl(motor_at + 14 * Z, Z, 13.5, 35.9), *(cyl(p + 6 * Z, Z, 4.8, 30) for p in bridge_at))
    screw_at = [motor_at + 12 * p + 49 * Z for p in around(1, 4, np.pi / 4)]
    put(drawing, "motor bridge", cut(bridge, *(cyl(p, Z, 1.7, 9) for p in screw_at)), "plate")
    for k, p in enumerate(bridge_at):
        put(drawing, f"bridge screw {k}", socket(p + 6 * Z, -Z, 5, 15), "motor bridge", "plate")
    motor = union(cyl(motor_at + 56 * Z, Z, 19, 44), cyl(motor_at + 50 * Z, Z, 8, 6))
    motor = cut(motor, cyl(motor_at + 49 * Z, Z, 3.1, 40), *(core(p + 6 * Z, Z, 3, 8) for p in screw_at))
    put(drawing, "motor", motor, "motor bridge")
    drawing.add("motor shaft", cyl(motor_at + 23 * Z, Z, 3, 65))
    drawing.joint("Revolute", "motor shaft", "motor", motor_at, Z)
    put(drawing, "motor pinion", tube(motor_at + 24 * Z, Z, 3, 12, 8), "motor shaft")
    return drawing


@kind
def jockey_wheel(random):
    """A tube in a clamp on a drawbar; a crank turns a spindle whose nut moves the inner tube with fork and wheel."""
    drawing, play, out = Drawing(["bracket"]), random.choice([0.1, 0.2, 0.3]), random.uniform(60, 160)
    clamp_at = [at(x, 0, z) for x in (-38, 38) for z in (230, 270)]
    bracket = cut(box((-55, 1, 215), (55, 60, 285)), box((-21, 45, 200), (21, 70, 300)), bore(0 * Z, Z, 24))
    bracket = cut(bracket, *(through(p, Y, 8) for p in clamp_at), *(bore((x, 0, 250), Y, 5.5, 70) for x in (-38, 38)))
    drawing.add("bracket", bracket)
    jaw = cut(box((-55, -36, 215), (55, -1, 285)), bore(0 * Z, Z, 24), *(through(p, Y, 8) for p in clamp_at))
    jaw = cut(jaw, box((-56, -40, 214), (-27, -15, 286)), box((27, -40, 214), (56, -15, 286)))
    spot = at(0, -24, 150)
    tube_ = cut(tube(0 * Z, Z, 21, 24, 400), core(spot - Y, Y, 6, 5))
    put(drawing, "outer tube", tube_, "bracket")
    put(drawing, "clamp jaw", jaw, "outer tube")
    for k, p in enumerate(clamp_at):
        put(drawing, f"clamp washer {k}", washer(p - 15 * Y, -Y, 8), "clamp jaw")
        put(drawing, f"clamp bolt {k}", bolt(p - 16.6 * Y, Y, 8, 88), f"clamp washer {k}")
        put(drawing, f"clamp nut {k}", nut(p + 60 * Y, Y, 8), "bracket", f"clamp bolt {k}")
    cap = union(cyl(385 * Z, Z, 21, 15), cyl(400 * Z, Z, 26, 6)).cut(bore(0 * Z, Z, 8 + play / 2))
    put(drawing, "cap", cap, "outer tube")
    pin = at(0, 0, 428)
    spindle = union(cyl((0, 0, 120), Z, 8, 320), cyl((0, 0, 376), Z, 14, 8.9))
    drawing.add("spindle", cut(spindle, bore(pin, Y, 2.5, 30)))
    drawing.joint("Revolute", "spindle", "cap", 0 * Z, Z)
    drawing.add("thrust washer", tube(406 * Z, Z, 8.3, 18, 2))
    crank = union(cyl(408.2 * Z, Z, 14, 32), box((0, -10, 432), (130, 10, 440)), cyl((130, 0, 432), Z, 10, 8))
    crank = cut(crank, bore(0 * Z, Z, 8), cyl((130, 0, 430), Z, 4, 20), bore(pin, Y, 2.5, 30))
    put(drawing, "crank", crank, "spindle")
    put(drawing, "crank pin", cyl(pin - 14 * Y, Y, 2.5, 28), "crank", "spindle")
    stud = union(cyl((130, 0, 432), Z, 4, 8), cyl((130, 0, 440), Z, 5, 60), cyl((130, 0, 500), Z, 8, 4))
    put(drawing, "knob screw", cut(stud, box((120, -0.8, 502), (140, 0.8, 506))), "crank")
    knob = union(cyl((130, 0, 440.2), Z, 11, 59.6), torus((130, 0, 470), Z, 11, 4)).cut(bore((130, 0, 0), Z, 5 + play))
    drawing.add("knob", knob)
    drawing.joint("Revolute", "knob", "knob screw", (130, 0, 0), Z)
    low, top = -out, 370 - out
    inner = tube(low * Z, Z, 17, 21 - play, top - low)
    inner = cut(inner, box((-3.2, -24, low + 60), (3.2, -10, top - 30)))
    cross = at(0, 0, low + 25)
    drawing.add("inner tube", cut(inner, through(cross, Y, 8, 40)))
    drawing.joint("Prismatic", "inner tube", "outer tube", 0 * Z, Z)
    guide = union(cyl(spot - 0.5 * Y, Y, 3, 6.5), cyl(spot - 4.5 * Y, Y, 6, 4))
    put(drawing, "guide screw", cut(guide, hexagon(spot - 4.5 * Y, Y, 2, 3)), "outer tube")
    put(drawing, "spindle nut", tube((top - 28) * Z, Z, 8, 17, 28), "inner tube")
    fork = union(cyl((low - 8) * Z, Z, 17, 50), box((-25, -34, low - 8), (25, 34, low)))
    axle = at(0, 0, low - 110)
    for s in (-1, 1):
        fork = union(fork, box((-20, s * 28, low - 108), (20, s * 34, low)), cyl(axle + s * 28 * Y, s * Y, 20, 6))
    put(drawing, "fork", cut(fork, bore(axle, Y, 6, 90), through(cross, Y, 8, 40)), "inner tube")
    side = 21 - play
    part = cut(cyl(cross - 29 * Y, Y, 8, 10), bore(cross, Z, side), bore(cross, Y, 4.1, 40))
    put(drawing, "fork sleeve", part, "inner tube")
    put(drawing, "fork bolt", bolt(cross - 29 * Y, Y, 8, 62), "fork sleeve")
    part = cut(cyl(cross + 19 * Y, Y, 8, 6), bore(cross, Z, side), bore(cross, Y, 4.1, 40))
    put(drawing, "fork pad", part, "inner tube")
    put(drawing, "fork nut", nut(cross + 25 * Y, Y, 8), "fork bolt", "fork pad")
    put(drawing, "axle", bolt(axle - 34 * Y, Y, 12, 86), "fork")
    put(drawing, "axle nut", nut(axle + 34 * Y, Y, 12), "axle", "fork")
    wheel = cut(cyl(axle - 25 * Y, Y, 70, 50), cyl(axle - 26 * Y, Y, 60, 18), cyl(axle + 8 * Y, Y, 60, 19))
    wheel = union(wheel, cyl(axle - 26 * Y, Y, 18, 52)).cut(bore(axle, Y, 8, 90))
    drawing.add("wheel", wheel)
    put(drawing, "tyre", tube(axle - 25 * Y, Y, 70, random.uniform(85, 98), 50), "wheel")
    for s, name in ((-1, "left"), (1, "right")):
        bush = union(tube(axle + s * 6 * Y, s * Y, 6 + play, 8, 20), tube(axle + s * 26 * Y, s * Y, 6 + play, 14, 1.8))
        put(drawing, f"{name} bush", bush, "wheel")
        drawing.joint("Revolute", f"{name} bush", "axle", axle, Y)
    return drawing


@kind
def inline_skate(random):
    """A frame with three wheels on bearings and axle screws, a boot with a cuff on rivets, a brake at the heel."""
    drawing, play, r = Drawing(["frame"]), random.choice([0.1, 0.25]), random.uniform(44, 52)
    hubs, mounts = [at(x, 0, -70) for x in (-110, 0, 110)], [at(x, 0, 0) for x in (-75, 85)]
    frame = cut(box((-140, -17, -20), (135, 17, 0)), box((-150, -13, -30), (150, 13, -5)))
    for h in hubs:
        for s in (-1, 1):
            frame = union(frame, box(h + at(-14, s * 13, 0), h + at(14, s * 17, 60)), cyl(h + s * 13 * Y, s * Y, 14, 4))
            frame = union(frame, cyl(h + s * 12 * Y, s * Y, 6, 1.5))
    for p, s in [(p, s) for p in (at(-56, 0, 0), at(56, 0, 0)) for s in (-1, 1)]:
        frame = union(frame, box(p + at(-56, s * 13, -32), p + at(56, s * 17, -20)))
    stops = [at(x, s * 17, -12) for s in (-1, 1) for x in (-133, -114)]
    frame = cut(
        frame,
        *(cyl(h, -Y, 4.2, 20) for h in hubs),
        *(core(h, Y, 8, 20) for h in hubs),
        *(through(p, Z, 8) for p in mounts),
    )
    frame = cut(frame, *(core(p, at(0, -np.sign(p[1]), 0), 5, 6) for p in stops))
    drawing.add("frame", frame)
    for k, h in enumerate(hubs):
        wheel = cut(cyl(h - 10 * Y, Y, 24, 20), bore(h, Y, 8, 40))
        wheel = cut(wheel, *(cyl(h + s * 5 * Y, s * Y, 11, 10) for s in (-1, 1)))
        wheel = union(wheel, tube(h - 12 * Y, Y, 11, 15, 24))
        drawing.add(f"wheel hub {k}", wheel)
        tyre = cut(cyl(h - 11 * Y, Y, r - 6, 22).union(cyl(h - 7 * Y, Y, r, 14)), bore(h, Y, 24, 40))
        put(drawing, f"tyre {k}", tyre, f"wheel hub {k}")
        axle = union(cyl(h - 17 * Y, Y, 3.98, 34), cyl(h - 20 * Y, Y, 7, 3)).cut(hexagon(h - 20 * Y, Y, 2.5, 5))
        put(drawing, f"axle {k}", axle, "frame")
        drawing.add(f"spacer {k}", tube(h - 5 * Y, Y, 4.1, 6, 10))
        for s, name in ((-1, "left"), (1, "right")):
            put(drawing, f"{name} bearing {k}", tube(h + s * 5 * Y, s * Y, 4, 11, 7), f"wheel hub {k}")
            drawing.joint("Revolute", f"{name} bearing {k}", f"axle {k}", h, Y)
    shell = cut(box((-130, -42, 0), (140, 42, 65)), box((-126, -38, 8), (136, 38, 70)))
    ankle = cut(box((-130, -42, 60), (0, 42, 120)), box((-126, -38, 50), (20, 38, 130)))
    pivots = {s: at(-70, s * 42, 100) for s in (-1, 1)}
    shell = cut(union(shell, ankle), bore(pivots[1], Y, 4, 120), *(through(p, Z, 8) for p in mounts))
    put(drawing, "boot", shell, "frame")
    for k, p in enumerate(mounts):
        put(drawing, f"mount washer {k}", washer(p + 8 * Z, Z, 8), "boot")
        part = bolt(p + 9.6 * Z, -Z, 8, 22)
        put(drawing, f"mount bolt {k}", part, f"mount washer {k}")
        put(drawing, f"mount nut {k}", hexagon(p - 5 * Z, -Z, 6.5, 6.8, 4), "frame", f"mount bolt {k}")
    cuff = box((-133.4, -45.4, 76), (-30, 45.4, 210)).cut(box((-130.4, -42.4, 70), (20, 42.4, 220)))
    cuff = cut(cuff, bore(pivots[1], Y, 4 + play, 120))
    drawing.add("cuff", cuff)
    for s, name in ((-1, "left"), (1, "right")):
        p, way = pivots[s], s * Y
        rivet = union(cyl(p - 4 * way, way, 4, 7.6), cyl(p - 6 * way, way, 7, 2), cyl(p + 3.6 * way, way, 8, 2.4))
        put(drawing, f"{name} rivet", rivet, "boot")
        drawing.joint("Revolute", "cuff", f"{name} rivet", p, Y)
    drawing.joint("Revolute", "cuff", "boot", pivots[1], Y)
    brake = union(
        *(box((-220, s * 17, -24), (-106, s * 21, -2)) for s in (-1, 1)), box((-220, -21, -24), (-180, 21, -2))
    )
    pad_at = at(-200, 0, -24)
    brake = cut(brake, *(through(p, Y, 5, 10) for p in stops), core(pad_at - Z, Z, 6, 19))
    put(drawing, "brake bracket", brake, "frame")
    for s, p in enumerate(stops):
        way = at(0, -np.sign(p[1]), 0)
        put(drawing, f"brake screw {s}", socket(p - 4 * way, way, 5, 8), "brake bracket", "frame")
    pad = cut(box((-222, -18, -85), (-178, 18, -24)), through(pad_at, Z, 6, 90), cyl(pad_at - 100 * Z, Z, 5.2, 70))
    put(drawing, "brake pad", pad, "brake bracket")
    put(drawing, "pad screw", socket(pad_at - 30 * Z, Z, 6, 44), "brake bracket", "brake pad")
    return drawing
