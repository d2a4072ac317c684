"""What balances or reaches: a desk lamp, an umbrella, a robot's wrist."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import both_sides
from drawings.guided import hollow
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
    hexagon,
    laid,
    rivet,
    screw,
    torus,
    tube,
    union,
)  # fmt: skip


@kind
def desk_lamp(random):
    """A foot, a swivelling bracket, two parallelograms of square bars, springs on studs, a shade on a wing screw."""
    drawing, play = Drawing(["foot"]), random.choice([0.05, 0.2])
    tilt, fold = random.uniform(1.2, 1.5), random.uniform(0.3, 0.6)
    lower, upper = 130 * at(np.cos(tilt), np.sin(tilt), 0), 120 * at(np.cos(fold), np.sin(fold), 0)
    low = [at(-9, 20, 0), at(9, 20, 0)]
    knee = [p + lower for p in low]
    mid = [knee[1] + at(0, 0, 0), knee[1] + at(-6, 20, 0)]
    head = [p + upper for p in mid]
    drawing.add(
        "foot", cut(union(cyl(at(0, -50, 0), Y, 60, 14), cyl(at(0, -36, 0), Y, 10, 20)), cyl(at(0, -40, 0), Y, 6, 40))
    )
    stem = union(cyl(at(0, -39, 0), Y, 6 - play / 2, 39), cyl(at(0, -16, 0), Y, 9, 16))
    drawing.add("stem", cut(stem, cyl(0 * X, -Y, 2.5, 12)))
    cheeks = [box((-18, 0, s * 9), (18, 28, s * 11)) for s in (1, -1)]
    bracket = union(box((-18, 0, -11), (18, 2, 11)), *cheeks)
    drawing.add("bracket", cut(bracket, bore(0 * X, Y, 2.5, 4), *(bore(p, Z, 2.5) for p in low)))
    drawing.add("stem screw", screw(2 * Y, -Y, 2.5, 12))

    def pinned(name: str, point) -> None:
        drawing.add(f"{name} rivet", rivet(point - 11 * Z, Z, 2.5, 22))
        for s in (1, -1):
            drawing.add(f"{name} washer {s}", tube(point + s * 4.1 * Z, s * Z, 2.6, 5, 4.8))

    def beam(name: str, one, other, stud: float) -> None:
        middle = one + stud * (other - one)
        shape = union(bar(one, other, 4, -4, 4, [one, other], 2.5 + play), cyl(middle, Z, 1.5, 17))
        drawing.add(name, shape)

    for number in (0, 1):
        beam(f"lower bar {number}", low[number], knee[number], 0.6)
        pinned(f"low {number}", low[number])
    pinned("knee 0", knee[0])
    pinned("knee 1", knee[1])
    pinned("top", mid[1])
    for s, name in ((1, "left"), (-1, "right")):
        plate = union(*(bar(a, b, 8, *sorted((s * 9, s * 11))) for a, b in ((knee[0], knee[1]), (knee[0], mid[1]))))
        drawing.add(f"{name} knee", cut(plate, *(bore(p, Z, 2.5) for p in (*knee, mid[1]))))
    beam("upper bar 1", mid[1], head[1], 0.3)
    outer = [bar(mid[0], head[0], 4, *sorted((s * 11.2, s * 14)), [mid[0], head[0]], 2.5 + play) for s in (1, -1)]
    for s, shape in zip((1, -1), outer, strict=True):
        drawing.add(f"upper flat {s}", shape)
    drawing.parts["knee 1 rivet"] = rivet(knee[1] - 14.2 * Z, Z, 2.5, 28.4)
    hook = tube(low[0] + 0.6 * lower + 14.9 * Z, Z, 1.6, 2.8, 1.2)
    anchor = at(18, 4, 0)
    drawing.parts["bracket"] = drawing.parts["bracket"].union(cyl(anchor + 11 * Z - 6 * X, Z, 1.5, 6))
    end, start = low[0] + 0.6 * lower + 15.5 * Z, anchor + 15.5 * Z - 6 * X
    span = end - start
    long = float(np.linalg.norm(span))
    coil = tube(start + 4 * span / long, span, 0.4, 2.0, long - 8)
    drawing.add(
        "spring",
        union(
            hook,
            coil,
            tube(start - 0.6 * Z, Z, 1.6, 2.8, 1.2),
            cyl(start + 2.2 * span / long, span, 0.6, 3),
            cyl(end - 5 * span / long, span, 0.6, 3),
        ).cut(bore(start, Z, 1.6), bore(end, Z, 1.6)),
    )
    pinned("head 1", head[1])
    drawing.add("head 0 rivet", rivet(head[0] - 14.2 * Z, Z, 2.5, 28.4))
    for s in (1, -1):
        drawing.add(f"head 0 washer {s}", tube(head[0] + s * 4 * Z, s * Z, 2.6, 5, 4.8))
    tab = head[0] + at(30, -6, 0)
    cheeks = [
        union(*(bar(a, b, 7, *sorted((s * 9, s * 11))) for a, b in ((head[0], head[1]), (head[0], tab))))
        for s in (1, -1)
    ]
    yoke = union(*cheeks, cyl(tab - 11 * Z, Z, 6, 22))
    drawing.add("yoke", cut(yoke, *(bore(p, Z, 2.5) for p in head), bore(tab, Z, 2)))
    lug = union(
        bar(tab, tab - 24 * Y + 0.01 * X, 7, 11.5, 14.5),
        cyl(tab + at(0, -26, 13), -Y, 30, 40).cut(cyl(tab + at(0, -28, 13), -Y, 28, 50)),
    )
    drawing.add("shade", cut(lug, bore(tab, Z, 2 + play)))
    drawing.add("wing screw", screw(tab + 15.5 * Z, -Z, 2, 32))
    drawing.add("wing washer", tube(tab + 14.5 * Z, Z, 2.1, 5, 1))
    drawing.add("shade nut", hexagon(tab - 13.5 * Z, Z, 3.5, 2.5, 2))
    drawing.joint("Revolute", "stem", "foot", 0 * X, Y)
    drawing.joint("Weld", "bracket", "stem")
    for number in (0, 1):
        drawing.joint("Revolute", f"lower bar {number}", "bracket", low[number], Z)
        drawing.joint("Revolute", f"lower bar {number}", "left knee", knee[number], Z)
    drawing.joint("Weld", "left knee", "right knee")
    drawing.joint("Revolute", "upper bar 1", "left knee", mid[1], Z)
    drawing.joint("Revolute", "upper flat 1", "left knee", mid[0], Z)
    drawing.joint("Revolute", "upper flat -1", "right knee", mid[0], Z)
    drawing.joint("Revolute", "upper bar 1", "yoke", head[1], Z)
    drawing.joint("Revolute", "upper flat 1", "yoke", head[0], Z)
    drawing.joint("Revolute", "upper flat -1", "yoke", head[0], Z)
    drawing.joint("Revolute", "shade", "yoke", tab, Z)
    return drawing


@kind
def umbrella(random):
    """A crown on a tube, four ribs, stretchers to forks in the ribs from a runner that slides on the tube."""
    drawing, play = Drawing(["tube"], random.choice(["MM", "INCH"])), random.choice([0.05, 0.1])
    slope, rib, stretcher, share = random.uniform(0.2, 0.5), 150.0, 80.0, 75.0
    root = at(10, 300, 0)
    way = at(np.cos(slope), -np.sin(slope), 0)
    joint = root + share * way
    inner = at(12, joint[1] - np.sqrt(stretcher**2 - (joint[0] - 12) ** 2), 0)
    drawing.add("tube", cut(tube((0, 0, 0), Z, 5.2, 6, 320), bore((0, 0, 300), X, 1)))
    drawing.add("handle", cut(union(cyl((0, 0, -80), Z, 10, 95)), cyl((0, 0, 0), Z, 6, 20)))
    slots, bores = [], []
    for number in range(4):
        turn = number * np.pi / 2 + np.pi / 4
        radial = at(np.cos(turn), np.sin(turn), 0)
        across = np.cross(radial, Z)

        def put(name: str, shape, radial=radial, across=across, number=number) -> None:
            drawing.add(f"{name} {number}", laid(shape, (0, 0, 0), radial, across))

        def point(p, radial=radial):
            return p[0] * radial + p[1] * Z

        channel = union(*both_sides(root + 20 * way, root + rib * way, 3, 1.6, 2.4, [joint], 1))
        far = root + (rib - 6) * way
        channel = union(
            channel,
            bar(root, root + 24 * way, 3, -2.4, 2.4).cut(bar(root - 5 * way, root + 16 * way, 5, 1.5, 3)),
            bar(far, root + rib * way, 3, -2.4, 2.4),
        )
        channel = channel.cut(bar(root - 5 * way, root + 16 * way, 5, -3, -1.5))
        put("rib", channel.cut(bore(root, Z, 1 + play)))
        put("stretcher", bar(inner, joint, 2.5, -1.5, 1.5, [inner, joint], 1 + play))
        put("rib pin", cyl(root - 5 * Z, Z, 1, 10))
        put("runner pin", cyl(inner - 5 * Z, Z, 1, 10))
        put("rivet", rivet(joint - 2.4 * Z, Z, 1, 4.8))
        for p in (root, inner):
            slots.append(laid(box((6.2, p[1] - 8, -1.6), (25, p[1] + 7, 1.6)), (0, 0, 0), radial, across))
            bores.append(laid(cyl(p - 5 * Z, Z, 1, 10), (0, 0, 0), radial, across))
        drawing.joint("Revolute", f"rib {number}", "crown", point(root), across)
        drawing.joint("Revolute", f"stretcher {number}", f"rib {number}", point(joint), across)
        drawing.joint("Revolute", f"stretcher {number}", "runner", point(inner), across)
    crown = tube((0, 0, 294), Z, 6, 15, 12)
    drawing.add("crown", cut(crown, *slots[::2], *bores[::2], bore((0, 0, 300), X, 1)))
    drawing.add("crown pin", cyl((-12, 0, 300), X, 1, 24))
    z = inner[1]
    runner = union(tube((0, 0, z - 6), Z, 6 + play, 17, 12), tube((0, 0, z - 40), Z, 6 + play, 9, 34))
    slots = [each.cut(cyl((0, 0, z - 10), Z, 7.5, 20)) for each in slots[1::2]]
    drawing.add("runner", cut(runner, *slots, *bores[1::2]))
    drawing.joint("Weld", "crown", "tube")
    drawing.joint("Weld", "handle", "tube")
    drawing.joint("Cylindrical", "runner", "tube", (0, 0, z), Z)
    return drawing


def _rollers(axis, radius: float, count: int) -> cq.Workplane:
    """Rollers of a bearing whose axes cross in turns, about x."""
    rollers = []
    for number, p in enumerate(hollow(0 * X, axis, radius, count)):
        out = p / np.linalg.norm(p)
        lean = (out + (-1) ** number * axis) / np.sqrt(2)
        rollers.append(cyl(p - 2.2 * lean, lean, 2.4, 4.4))
    return union(*rollers)


@kind
def robot_wrist(random):
    """A crossed-roller bearing with a split outer ring, a hub with a yoke, a flange on two bearings with a lock nut."""
    drawing = Drawing(["housing"])
    bolts, inner = hollow(0 * X, X, 41, 8), hollow(0 * X, X, 21, 6)
    drawing.add(
        "housing",
        cut(union(tube((-60, 0, 0), X, 30, 50, 60)), cyl((-10, 0, 0), X, 36, 20), *(cyl(p, -X, 2, 15) for p in bolts)),
    )
    groove = torus((-5, 0, 0), X, 28, 3.2)
    for number, a in enumerate((0, 5)):
        drawing.add(f"outer ring {number}", cut(tube((-10 + a, 0, 0), X, 28.6, 36, 5), groove))
    drawing.add("inner ring", cut(tube((-10, 0, 0), X, 17, 27.4, 10), groove, *(bore(p, X, 1.75) for p in inner)))
    drawing.add("rollers", _rollers(X, 28, 24).translate((-5, 0, 0)))
    drawing.add("retainer", cut(tube((0, 0, 0), X, 30, 46, 4), *(bore(p, X, 2.1) for p in bolts)))
    for number, p in enumerate(bolts):
        drawing.add(f"retainer screw {number}", screw(p + 4 * X, -X, 2, 14))
    wide = random.uniform(26, 30)
    hub = union(
        cyl((0, 0, 0), X, 27, 14),
        *(box((14, s * wide - 5, -20), (70, s * wide + 5, 20)) for s in (1, -1)),
        box((8, -wide - 5, -20), (14, wide + 5, 20)),
    )
    middle = at(52, 0, 0)
    hub = cut(hub, bore(middle, Y, 11), *(cyl(p - X, X, 1.75, 9) for p in inner), bore(0 * X, X, 8, 20))
    drawing.add("hub", hub)
    for number, p in enumerate(inner):
        drawing.add(f"hub screw {number}", screw(p - 10 * X, X, 1.75, 17))
    for name, s in (("left", 1), ("right", -1)):
        drawing.add(f"{name} bearing", tube(middle + s * (wide - 4.5) * Y, s * Y, 5, 11, 8))
        drawing.add(f"{name} distance ring", tube(middle + s * 18 * Y, s * Y, 5, 7, wide - 22.5))
    flange = union(box((42, -18, -12), (70, 18, 12)), cyl((70, 0, 0), X, 20, 8))
    drawing.add(
        "flange", cut(flange, bore(middle, Y, 5), *(cyl(p + 78 * X, -X, 2, 8) for p in hollow(0 * X, X, 14, 4)))
    )
    drawing.add(
        "axle",
        union(
            cyl(middle - (wide + 12) * Y, Y, 5, 2 * wide + 17.5),
            cyl(middle - (wide + 6.5) * Y, Y, 7, 3),
            cyl(middle + (wide + 5.5) * Y, Y, 5, 8),
        ).cut(box((40, -wide - 20, 3), (60, -wide - 8, 6))),
    )
    drawing.add(
        "lock nut",
        cut(
            tube(middle + (wide + 3.5) * Y, Y, 5, 9, 6),
            *(bore(p + middle + (wide + 6) * Y, p, 1, 1) for p in hollow(0 * X, Y, 9, 4)),
        ),
    )
    drawing.add("grub", cyl(middle + 12 * Y + 12 * Z, -Z, 1.5, 7))
    drawing.parts["flange"] = drawing.parts["flange"].cut(cyl(middle + 12 * Y, Z, 1.5, 14))
    cover = tube(middle + (wide + 5) * Y, Y, 10, 16, 2)
    pins = hollow(middle + (wide + 5) * Y, Y, 13.5, 4)
    drawing.add("cover", cut(cover, *(bore(p, Y, 1.1, 5) for p in pins)))
    for number, p in enumerate(pins):
        drawing.parts["hub"] = drawing.parts["hub"].cut(cyl(p, -Y, 1, 7))
        drawing.add(f"cover screw {number}", screw(p + 2 * Y, -Y, 1, 6))
    drawing.joint("Weld", "outer ring 0", "housing")
    drawing.joint("Weld", "outer ring 1", "housing")
    drawing.joint("Weld", "retainer", "housing")
    drawing.joint("Weld", "inner ring", "hub")
    drawing.joint("Revolute", "hub", "housing", (0, 0, 0), X)
    drawing.joint("Weld", "left bearing", "hub")
    drawing.joint("Weld", "axle", "flange")
    drawing.joint("Weld", "cover", "hub")
    drawing.joint("Revolute", "flange", "hub", middle, Y)
    return drawing
