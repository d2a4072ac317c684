"""An egg beater, a ship's hatch, a helicopter's rotor head."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
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
    laid,
    rivet,
    screw,
    sphere,
    torus,
    tube,
    union,
)
from drawings.sharpened import put


@kind
def egg_beater(random):
    """A flat frame with a wooden handle, a crank wheel on a shoulder bolt, pinions pinned on two beaters' shafts."""
    drawing, play, half = Drawing(["frame"]), random.choice([0.05, 0.15, 0.25]), random.uniform(12.5, 14)
    frame = union(
        box((-8, -3, -21), (8, 3, 71)),
        cyl((0, 0, 70), Z, 4, 55),
        *(box((-26, -4.5, z), (26, 4.5, z + 5)) for z in (-25, -51)),
        *(box((x, -4.5, -51), (x + 4, 4.5, -21)) for x in (-26, 22)),
    )
    shafts = [bore((s * half, 0, 0), Z, 2 + play) for s in (-1, 1)]
    drawing.add("frame", cut(frame, *shafts, bore(0 * X, Y, 3), cyl((0, 0, 105), Z, 1.6, 30)))
    grip = union(cyl((0, 0, 71), Z, 10, 10), cyl((0, 0, 81), Z, 13, 45))
    put(drawing, "handle", cut(grip, bore(0 * X, Z, 4)), "frame")
    put(drawing, "ferrule", tube((0, 0, 71), Z, 10, 11, 10), "handle")
    put(drawing, "cap", tube((0, 0, 126), Z, 2, 12, 2), "handle")
    put(drawing, "cap screw", screw((0, 0, 128), -Z, 1.6, 20), "frame")
    knob = at(24, 0, 0)
    wheel = union(cyl((0, 8, 0), Y, 40, 4), tube((0, 5, 0), Y, 32, 40, 4), cyl((0, 4, 0), Y, 8, 8))
    wheel = cut(
        wheel, bore(0 * X, Y, 4 + play), bore(knob, Y, 2.5), *(bore(p, Y, 7) for p in hollow(0 * X, Y, 21, 4, 0.785))
    )
    drawing.add("wheel", wheel)
    axle = union(cyl((0, -7, 0), Y, 3, 11), cyl((0, 3, 0), Y, 4, 9.2), cyl((0, 12.2, 0), Y, 7, 3))
    put(drawing, "wheel bolt", axle, "frame")
    put(drawing, "wheel bolt nut", hexagon((0, -6, 0), Y, 5, 3, 3), "wheel bolt")
    put(drawing, "wheel washer", tube((0, 3, 0), Y, 4.05, 8, 1), "frame")
    drawing.joint("Revolute", "wheel", "frame", 0 * X, Y)
    put(drawing, "knob pin", rivet(knob + 8 * Y, Y, 2.5, 30.4), "wheel")
    drawing.add(
        "knob", cut(union(cyl(knob + 12.2 * Y, Y, 6, 26), cyl(knob + 20 * Y, Y, 8, 14)), bore(knob, Y, 2.5 + play))
    )
    drawing.joint("Revolute", "knob", "knob pin", knob, Y)
    for s, turn in ((-1, 0), (1, 45)):
        p, name = at(s * half, 0, 0), "left" if s < 0 else "right"
        pin = cyl(p + at(-4, 0, -42), X, 0.75, 8)
        drawing.add(f"{name} shaft", cut(cyl(p - 168 * Z, Z, 2, 150), bore(p - 42 * Z, X, 0.75, 9)))
        pinion = union(cyl(p - 45.5 * Z, Z, 4, 20), cyl(p - 37 * Z, Z, 4.8, 8.2))
        pinion = cut(pinion, bore(p, Z, 2), bore(p - 42 * Z, X, 0.75, 9))
        put(drawing, f"{name} pinion", pinion, f"{name} shaft")
        put(drawing, f"{name} cross pin", pin, f"{name} pinion")
        for z, where in ((-25.5, "upper"), (-46, "lower")):
            put(drawing, f"{name} {where} washer", tube(p + z * Z, Z, 2, 4.4, 0.5), f"{name} shaft")
        loop = cut(box((-12, -3, -168), (12, 3, -95)), box((-11, -4, -166.8), (11, 4, -96.2)))
        loops = union(loop, loop.rotate((0, 0, 0), (0, 0, 1), 90)).rotate((0, 0, 0), (0, 0, 1), turn)
        put(drawing, f"{name} whisk", cut(loops.translate(tuple(p)), bore(p, Z, 2)), f"{name} shaft")
        drawing.joint("Revolute", f"{name} shaft", "frame", p, Z)
    return drawing


@kind
def watertight_hatch(random):
    """A cover hinged on a coaming, a hand wheel whose spindle turns a disc, links to four dogs in bolted guides."""
    drawing, play, turn = Drawing(["coaming"]), random.choice([0.1, 0.3]), random.uniform(0.6, 0.9)
    coaming = cut(box((-150, -150, -70), (150, 150, 0)), box((-140, -140, -71), (140, 140, 1)))
    keeper = box((118, -16, -9), (141, 16, -3))
    coaming = union(coaming, *(keeper.rotate((0, 0, 0), (0, 0, 1), 90 * k) for k in range(4)))
    hinge, ears = at(-185, 0, 8), []
    for y in (-90, -58, 50, 82):
        ears += [
            box((-195, y, -40), (-149, y + 8, -2)),
            box((-195, y, -3), (-168, y + 8, 8)),
            cyl(hinge + y * Y, Y, 10, 8),
        ]
    drawing.add("coaming", cut(union(coaming, *ears), bore(hinge, Y, 5)))
    cover = [box((-165, -165, 4), (165, 165, 12))]
    for y in (-80, 60):
        cover += [box((-186, y + 0.3, 4), (-160, y + 19.7, 12)), cyl(hinge + (y + 0.3) * Y, Y, 9, 19.4)]
        name = "left" if y < 0 else "right"
        pin = grooved(headed(hinge + (y - 10) * Y, Y, 5, 43), hinge + (y + 30.2) * Y, Y, 5)
        put(drawing, f"{name} hinge pin", pin, "coaming")
        put(drawing, f"{name} circlip", circlip(hinge + (y + 30.2) * Y, Y, 5), f"{name} hinge pin")
    bolts = [at(94, y, 0) for y in (-15, 15)]
    slew = [((0, 0, 0), (0, 0, 1), 90 * k) for k in range(4)]
    through = [bore(p, Z, 3).rotate(*s) for s in slew for p in bolts]
    part = cut(union(*cover), bore(hinge, Y, 5 + play), bore(0 * X, Z, 16), *through)
    put(drawing, "cover", part, "coaming", "Revolute", hinge, Y)
    gasket = cut(box((-153, -153, 0), (153, 153, 4)), box((-137, -137, -1), (137, 137, 5)))
    put(drawing, "gasket", gasket, "cover")
    put(
        drawing, "gland", union(tube((0, 0, -26), Z, 10 + play, 16, 50), tube((0, 0, 12), Z, 10 + play, 26, 5)), "cover"
    )
    spindle = cut(union(cyl((0, 0, -26.1), Z, 10, 50.2), cyl((0, 0, -44), Z, 8, 102)), box((4, -2.5, 26), (9, 2.5, 42)))
    put(drawing, "spindle", spindle, "gland", "Revolute", 0 * X, Z)
    spokes = [cyl(34 * Z, at(np.cos(t), np.sin(t), 0), 5, 92) for t in np.arange(5) * 0.4 * np.pi]
    wheel = union(torus((0, 0, 34), Z, 92, 8), cyl((0, 0, 24.1), Z, 19, 19.9), *spokes)
    put(drawing, "hand wheel", cut(wheel, bore(0 * X, Z, 8), box((4, -2.5, 20), (11, 2.5, 50))), "spindle")
    put(drawing, "wheel key", box((4, -2.5, 26), (10.6, 2.5, 42)), "spindle")
    put(drawing, "wheel washer", tube((0, 0, 44), Z, 8, 16, 2), "hand wheel")
    put(drawing, "wheel nut", hexagon((0, 0, 46), Z, 12, 9, 8), "spindle")
    knobs = [35 * at(np.cos(turn), np.sin(turn), 0)]
    disc = cut(cyl((0, 0, -34), Z, 44, 7.9), bore(0 * X, Z, 8), *(bore(knobs[0], Z, 3).rotate(*s) for s in slew))
    put(drawing, "disc", disc, "spindle")
    put(drawing, "disc nut", hexagon((0, 0, -42), Z, 12, 8, 8), "spindle")
    pin = at(knobs[0][0] + np.sqrt(45.0**2 - knobs[0][1] ** 2), 0, 0)
    dog = cut(box(pin + at(-10, -10, -20), pin + at(64, 10, -9.2)), bore(pin, Z, 3))
    guide = cut(box((80, -20, -26), (108, 20, 4)), box((70, -10 - play, -20 - play), (120, 10 + play, -9.2 + play)))
    guide = cut(guide, *(bore(p, Z, 2.5) for p in bolts))
    link = bar(knobs[0], pin, 7, -26, -20.1, (knobs[0], pin), 3 + play / 2)
    inner = headed(knobs[0] - 20 * Z, -Z, 3, 14).union(cyl(knobs[0] - 35.5 * Z, Z, 4.5, 1.5))
    for k, s in enumerate(slew):
        way = at(np.cos(np.pi / 2 * k), np.sin(np.pi / 2 * k), 0)
        side = np.cross(Z, way)
        put(drawing, f"guide {k}", guide.rotate(*s), "cover")
        for j, p in enumerate(bolts):
            put(drawing, f"guide screw {k} {j}", screw(p + 12 * Z, -Z, 2.5, 24).rotate(*s), f"guide {k}")
        put(drawing, f"dog {k}", dog.rotate(*s), f"guide {k}", "Prismatic", 0 * X, way)
        put(drawing, f"disc pin {k}", inner.rotate(*s), "disc")
        put(drawing, f"dog pin {k}", rivet(pin - 26 * Z, Z, 3, 16.8).rotate(*s), f"dog {k}")
        where = knobs[0][0] * way + knobs[0][1] * side
        put(drawing, f"link {k}", link.rotate(*s), f"disc pin {k}", "Revolute", where, Z)
        drawing.joint("Revolute", f"link {k}", f"dog pin {k}", pin[0] * way, Z)
    return drawing


def ball_link(one, other, axes, ball: float, space: float = 0.0):
    """A rod with cups of plastics that are snapped onto balls whose studs lie along these axes."""
    way, long = (other - one) / np.linalg.norm(other - one), np.linalg.norm(other - one)
    cups = [cyl(p - 2 * a, a, ball + 2, 4) for p, a in zip((one, other), axes, strict=True)]
    rod = union(cyl(one + (ball + 1) * way, way, 1.5, long - 2 * ball - 2), *cups)
    return cut(rod, sphere(one, ball + space), sphere(other, ball + space))


@kind
def swashplate_rotor(random):
    """Servos with horns on a frame, a swash plate of two rings on a ball that slides on the mast, grips on bearings."""
    drawing, play, middle = Drawing(["frame"]), random.choice([0.03, 0.08]), 10 * Z
    turns = [np.radians(65 + 120 * k) for k in range(3)]
    rays = [at(np.cos(t), np.sin(t), 0) for t in turns]
    posts = [cyl(-28.5 * ray - 60 * Z, Z, 4, 48) for ray in rays]
    frame = union(cyl(-60 * Z, Z, 33, 6), cyl(-20 * Z, Z, 33, 8), *posts)
    drawing.add("frame", cut(frame, bore(0 * X, Z, 8)))
    for k, z in enumerate((-60, -18)):
        put(drawing, f"mast bearing {k}", tube(z * Z, Z, 4, 8, 6), "frame")
    drawing.add("mast", cut(cyl(-66 * Z, Z, 4, 128), bore(54 * Z, Y, 1.5)))
    drawing.joint("Revolute", "mast", "frame", 0 * X, Z)
    for name, z in (("lower", -65), ("upper", -12)):
        put(drawing, f"{name} collar", tube(z * Z, Z, 4, 7, 5), "mast")
    slider = cut(sphere(middle, 10).intersect(cyl(4.5 * Z, Z, 20, 11)), bore(middle, Z, 4 + play))
    put(drawing, "slider", slider, "mast", "Cylindrical", middle, Z)
    lower = cut(union(cyl(4 * Z, Z, 26, 5), cyl(9 * Z, Z, 15, 7)), sphere(middle, 10), tube(14.1 * Z, Z, 14, 16, 1.1))
    balls = [39 * ray + 6.5 * Z for ray in rays]
    lower = cut(lower, *(cyl(p - 20 * r, r, 1.5, 20) for p, r in zip(balls, rays, strict=True)))
    put(drawing, "lower ring", lower, "slider", "Spherical", middle)
    put(drawing, "ring bearing", tube(9 * Z, Z, 15, 19, 5), "lower ring")
    clip = cut(tube(14.1 * Z, Z, 14, 17, 1), box((10, -3, 13), (20, 3, 16)))
    put(drawing, "ring clip", clip, "lower ring")
    upper, lift = tube(9.2 * Z, Z, 19, 28, 5), [at(s * 33, s * 20, 20) for s in (-1, 1)]
    for s in (-1, 1):
        upper = union(upper, box((s * 17, s * 15, 9.2), (s * 28, s * 24, 23)))
    drive, elbow, hang = at(0, -33, 11.7), at(0, -33, 34), at(0, -13, 47)
    upper = cut(upper, tube(9.2 * Z, Z, 0.1, 19, 20), *(bore(p, X, 1.5, 20) for p in lift), cyl(drive, Y, 1.5, 14))
    put(drawing, "upper ring", upper, "lower ring", "Revolute", middle, Z)
    for k, (p, ray) in enumerate(zip(balls, rays, strict=True)):
        side = np.cross(Z, ray)
        stud = union(sphere(p, 3), cyl(p - 18 * ray, ray, 1.5, 18), cyl(p - 13 * ray, ray, 2.2, 2))
        put(drawing, f"ring stud {k}", stud, "lower ring")
        shaft, tilt = -6.5 * side - 42 * Z, random.uniform(-0.3, 0.3)
        body = union(box((16, -19, -54), (28, 6, -30)), cyl((27, -6.5, -42), X, 2.5, 4.9))
        body = cut(body, cyl((24, -6.5, -42), X, 1, 12))
        put(drawing, f"servo {k}", laid(body, 0 * X, ray, Z), "frame")
        tip = shaft + 13 * (np.cos(tilt) * side + np.sin(tilt) * Z)
        flat = laid(bar((0, 0), (13 * np.cos(tilt), 13 * np.sin(tilt)), 4.5, 28.1, 32), shaft, side, ray)
        horn = union(flat, cyl(tip + 31 * ray, ray, 1.5, 8), sphere(tip + 39 * ray, 3))
        horn = cut(horn, cyl(shaft + 20 * ray, ray, 2.5, 11.9), bore(shaft, ray, 1.1, 60))
        put(drawing, f"horn {k}", horn, f"servo {k}", "Revolute", shaft, ray)
        part = ball_link(tip + 39 * ray, p, (ray, ray), 3)
        put(drawing, f"servo link {k}", part, f"horn {k}", "Spherical", tip + 39 * ray)
        drawing.joint("Spherical", f"servo link {k}", f"ring stud {k}", p)
    hub = union(box((-14, -8, 44), (14, 8, 60)), box((-2, -16, 44), (2, -7, 50)))
    for s in (-1, 1):
        hub = union(hub, cyl((s * 13, 0, 52), s * X, 5.3, 4), cyl((s * 13, 0, 52), s * X, 4, 25))
    hub = cut(
        hub,
        bore(0 * X, Z, 4),
        bore(54 * Z, Y, 1.5),
        bore(hang, X, 1.5, 9),
        bore(52 * Z, X, 1.25).cut(box((-20, -9, 40), (20, 9, 70))),
    )
    put(drawing, "hub", hub, "mast")
    put(drawing, "mast bolt", screw((0, -8, 54), Y, 1.5, 21), "hub")
    put(drawing, "mast nut", hexagon((0, 8, 54), Y, 2.75, 3, 1.5), "mast bolt")
    for s, name in ((-1, "left"), (1, "right")):
        o, out, stem = 52 * Z, s * X, at(s * 33, s * 20, 52)
        grip = union(
            cyl(o + 17.5 * out, out, 10, 26), *(box((s * 38, -8, 52 + z), (s * 66, 8, 56 + z)) for z in (-9, 5))
        )
        grip = union(grip, box((s * 19, s * 6, 49), (s * 28, s * 25, 55)))
        grip = cut(grip, cyl(o + 16 * out, out, 7, 6.4), cyl(o + 16 * out, out, 6, 30), cyl(o + 33 * out, out, 7, 40))
        grip = cut(grip, bore((s * 58, 0, 52), Z, 1.5), bore(stem, X, 1.5, 20))
        put(drawing, f"{name} grip", grip, "hub", "Revolute", o, X)
        for k, x in enumerate((17.4, 33)):
            put(drawing, f"{name} bearing {k}", tube(o + x * out, out, 4, 7, 5), f"{name} grip")
        part = union(screw(o + 39 * out, -out, 1.25, 10), tube(o + 38 * out, out, 1.25, 5.3, 1))
        put(drawing, f"{name} spindle screw", part, "hub")
        low = lift[(s + 1) // 2]
        for which, p, host in (("upper", stem, f"{name} grip"), ("lower", low, "upper ring")):
            stud = union(sphere(p, 3), cyl(p - 13 * out, out, 1.5, 13), cyl(p - 5 * out, out, 2.2, 2))
            put(drawing, f"{name} {which} stud", stud, host)
        put(drawing, f"{name} pitch link", ball_link(low, stem, (X, X), 3), f"{name} lower stud", "Spherical", low)
        drawing.joint("Spherical", f"{name} pitch link", f"{name} upper stud", stem)
    part = union(sphere(drive, 3), cyl(drive, Y, 1.5, 13), cyl(drive + 3 * Y, Y, 2.2, 2))
    put(drawing, "drive stud", part, "upper ring")
    lower_arm = union(cyl(drive - 2 * Y, Y, 5, 4), cyl(drive + 4 * Z, Z, 1.8, 17), cyl(elbow - 2 * X, X, 4, 4))
    part = cut(lower_arm, sphere(drive, 3), bore(elbow, X, 1.5 + play, 9))
    put(drawing, "lower arm", part, "drive stud", "Spherical", drive)
    arm = laid(bar(elbow[1:], hang[1:], 4, -4.5, 4.5), 0 * X, Y, X)
    waist = (elbow + hang) / 2
    arm = cut(arm, box((-2.1, -60, 0), (2.1, waist[1] - 3, 90)), box((-2.1, waist[1] + 3, 0), (2.1, 30, 90)))
    put(
        drawing, "upper arm", cut(arm, bore(elbow, X, 1.5, 9), bore(hang, X, 1.5 + play, 9)), "hub", "Revolute", hang, X
    )
    drawing.joint("Revolute", "lower arm", "upper arm", elbow, X)
    for name, p, host in (("elbow pin", elbow, "upper arm"), ("hub pin", hang, "hub")):
        put(drawing, name, cyl(p - 5 * X, X, 1.5, 10), host)
    return drawing
