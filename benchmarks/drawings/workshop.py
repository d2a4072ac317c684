"""What stands in a workshop: jacks, vises, slides, hinges, casters, a drill press."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, rivet, screw, tube, union


@kind
def scissor_jack(random):
    """Two arms on each side of a screw, on pins in a foot and in a saddle; one trunnion is the nut."""
    drawing, play = Drawing(["foot"]), random.choice([0.0, 0.1, 0.25])
    arm, half, gap = random.uniform(75, 90), random.uniform(45, 60), 12.0
    height = np.sqrt(arm**2 - (half - gap) ** 2)
    low, high = {s: at(s * gap, 0, 0) for s in (-1, 1)}, {s: at(s * gap, 2 * height, 0) for s in (-1, 1)}
    knee = {s: at(s * half, height, 0) for s in (-1, 1)}
    holders = {"foot": (low, -1, 0.0), "saddle": (high, 1, 2 * height)}
    for name, (pins, way, level) in holders.items():
        cheeks = [box((-24, level - way * 8, s * 14 - 2), (24, level + way * 14, s * 14 + 2)) for s in (-1, 1)]
        plate = box((-35, level + way * 14, -20), (35, level + way * 20, 20))
        drawing.add(name, cut(union(plate, *cheeks), *(bore(p, Z, 4 + play) for p in pins.values())))
        for s, point in pins.items():
            drawing.add(f"pin {name} {s}", rivet(point - 16 * Z, Z, 4, 32))
    for s in (-1, 1):
        for name, pins, z in (("lower", low, 8), ("upper", high, 4)):
            strips = [bar(pins[s], knee[s], 8, e * z - 1.5, e * z + 1.5, (pins[s], knee[s]), 4 + play) for e in (-1, 1)]
            web = box((-3, -4, -z), (3, 4, z)).translate(tuple((pins[s] + 0.3 * (knee[s] - pins[s])).tolist()))
            drawing.add(f"{name} {s}", union(*strips, web))
        trunnion = union(
            cyl(knee[s] - 10 * Z, Z, 4, 20), cyl(knee[s] - 2.4 * Z, Z, 8, 4.8), box(knee[s] - 2.4, knee[s] + 2.4)
        )
        drawing.add(f"trunnion {s}", trunnion.cut(bore(knee[s], X, 1.5)))
        drawing.joint("Revolute", f"lower {s}", "foot", low[s], Z)
        drawing.joint("Revolute", f"upper {s}", "saddle", high[s], Z)
        for name in ("lower", "upper"):
            drawing.joint("Revolute", f"{name} {s}", f"trunnion {s}", knee[s], Z)
    collars = [cyl(knee[1] + x * X, X, 2.4, 3) for x in (8.2, -11.2)]
    spindle = union(cyl(knee[-1] - 30 * X, X, 1.5, 2 * half + 60), *collars, cyl(knee[1] + 30 * X, X, 3, 6))
    drawing.add("spindle", spindle)
    drawing.joint("Cylindrical", "spindle", "trunnion -1", knee[-1], X)
    drawing.joint("Revolute", "spindle", "trunnion 1", knee[1], X)
    return drawing


@kind
def vise(random):
    """A jaw on two ways, drawn by a screw whose collar is held by a plate; jaw plates without their screws."""
    drawing, play = Drawing(["body"], unit="INCH"), random.choice([0.0, 0.05])
    travel = random.uniform(20, 50)
    ways = [box((-20, s * 22 - 8, 0), (150, s * 22 + 8, 12)) for s in (-1, 1)]
    body = union(
        *ways,
        box((-20, -30, -12), (150, 30, 0)),
        box((130, -30, 0), (150, 30, 45)),
    )
    jaw_holes = [at(0, y, 32) for y in (-18, 18)]
    body = cut(body, bore((0, 0, 6), X, 5), *(cyl((125, *p[1:]), X, 2, 20) for p in jaw_holes))
    drawing.add("body", body)
    x = 110 - travel
    jaw = union(box((x - 22, -30, 12 + play), (x, 30, 45)), box((x - 22, -14 + play, 0.5), (x, 14 - play, 12 + play)))
    jaw = cut(jaw, bore((0, 0, 6), X, 5.2), *(cyl((x - 15, *p[1:]), X, 2, 20) for p in jaw_holes))
    drawing.add("jaw", jaw)
    for name, low, host in (("soft", x, "jaw"), ("hard", 124.0, "body")):
        plate = cut(box((low, -30, 18), (low + 6, 30, 44)), *(bore((low, *p[1:]), X, 2.6) for p in jaw_holes))
        drawing.add(f"{name} plate", plate)
        drawing.joint("Weld", f"{name} plate", host)
    spindle = union(cyl((-60, 0, 6), X, 5, 215), cyl((x - 27, 0, 6), X, 8, 5), cyl((-60, 0, 6), X, 8, 18))
    drawing.add("spindle", cut(spindle, bore((-51, 0, 6), Y, 3)))
    keeper = cut(
        union(box((x - 28 - 4, -14, 13.5), (x - 22, 14, 30)), box((x - 32, -14, -0.5), (x - 27, 14, 30))),
        bore((0, 0, 6), X, 5.3),
    )
    keeper = cut(keeper, box((x - 27, -20, -9), (x - 22, 20, 13.5)), *(bore((0, y, 24), X, 1.6) for y in (-9, 9)))
    drawing.parts["jaw"] = cut(jaw, *(cyl((x - 22, y, 24), X, 1.25, 10) for y in (-9, 9)))
    drawing.add("keeper", keeper)
    ends = [cyl((-51, y, 6), Y, 5, 4) for y in (-49, 45)]
    drawing.add("handle", union(cyl((-51, -45, 6), Y, 3 - play, 90), *ends))
    drawing.joint("Weld", "keeper", "jaw")
    drawing.joint("Prismatic", "jaw", "body", (0, 0, 6), X)
    drawing.joint("Cylindrical", "spindle", "body", (0, 0, 6), X)
    drawing.joint("Revolute", "spindle", "jaw", (0, 0, 6), X)
    return drawing


@kind
def drawer_slide(random):
    """Three channels in each other, the outer one screwed to a cabinet by holes without screws, the inner to a box."""
    drawing, play = Drawing(["cabinet"]), random.choice([0.0, 0.15])
    out = random.uniform(60, 120)
    holes = [at(x, 0, 0) for x in (30, 150, 270)]
    drawing.add("cabinet", cut(box((-20, -60, -18), (320, 60, 0)), *(cyl(p - 12 * Z, Z, 1.6, 20) for p in holes)))
    outer = union(box((0, -22, 0), (300, 22, 2)), *(box((0, s * 22, 0), (300, s * 20, 14)) for s in (-1, 1)))
    drawing.add("outer", union(outer, *(box((0, s * 22, 12), (300, s * 16, 14)) for s in (-1, 1))))
    low, high, wide = 2 + play, 12 - play, 20 - play
    ends = out / 2, out / 2 + 300
    middle = [box((ends[0], s * wide, low), (ends[1], s * (wide - 2), high)) for s in (-1, 1)]
    middle += [box((ends[0], s * wide, high - 2), (ends[1], s * 12, high)) for s in (-1, 1)]
    drawing.add("middle", union(box((ends[0], -wide, low), (ends[1], wide, low + 2)), *middle))
    drawing.add("inner", box((out, play - wide + 2, low + 2 + play), (out + 300, wide - 2 - play, high - 2 - play)))
    drawing.parts["outer"] = cut(drawing.parts["outer"], *(bore(p, Z, 2.2) for p in holes))
    drawing.joint("Weld", "outer", "cabinet")
    drawing.joint("Prismatic", "middle", "outer", (0, 0, 0), X)
    drawing.joint("Prismatic", "inner", "middle", (0, 0, 0), X)
    return drawing


@kind
def sheet_hinge(random):
    """Leaves of rolled sheet on a pin that is a little thick, with countersunk holes."""
    drawing, thick, pin = Drawing(["frame leaf"]), random.uniform(1.2, 2.0), random.uniform(2.0, 3.0)
    width, knuckles, tight = random.uniform(9, 13), 5, random.choice([0.0, 0.06])
    for name, side, parity in (("frame leaf", 1, 0), ("door leaf", -1, 1)):
        rolls = [tube((0, 0, k * width + 0.1), Z, pin, pin + thick, width - 0.2) for k in range(parity, knuckles, 2)]
        straps = [
            box((0, pin, k * width + 0.1), (side * 8, pin + thick, (k + 1) * width - 0.1))
            for k in range(parity, knuckles, 2)
        ]
        leaf = union(box((side * 7, pin, 0), (side * 35, pin + thick, knuckles * width)), *rolls, *straps)
        holes = [bore((side * 25, 0, z), Y, 2.2) for z in (8, knuckles * width - 8)]
        drawing.add(name, cut(leaf, *holes, bore((0, 0, 0), Z, pin)))
    drawing.add("pin", headed((0, 0, 0), Z, pin + tight, knuckles * width + 1))
    drawing.joint("Revolute", "frame leaf", "door leaf", (0, 0, 0), Z)
    return drawing


@kind
def caster(random):
    """A swivelling fork under a plate on a rivet, a wheel on a bush and an axle screw with its nut."""
    drawing, offset, radius = Drawing(["plate"]), random.uniform(15, 25), random.uniform(28, 36)
    play = random.choice([0.1, 0.3])
    plate = box((-40, -35, 0), (40, 35, 4))
    plate = cut(plate, bore((0, 0, 0), Z, 6), *(bore((x, y, 0), Z, 4.2) for x in (-30, 30) for y in (-25, 25)))
    drawing.add("plate", plate)
    hub = at(offset, 0, -radius - 12)
    legs = [
        union(
            box((-12, s * 16 - 1.5, -20), (offset + 8, s * 16 + 1.5, -4)),
            box((offset - 8, s * 16 - 1.5, hub[2]), (offset + 8, s * 16 + 1.5, -20)),
            cyl(hub + (s * 16 - 1.5) * Y, Y, 8, 3),
        )
        for s in (-1, 1)
    ]
    fork = cut(
        union(box((-18, -17.5, -4), (offset + 8, 17.5, -1)), *legs), bore((0, 0, 0), Z, 6 + play), bore(hub, Y, 4)
    )
    drawing.add("fork", fork)
    drawing.add("washer", tube((0, 0, -1), Z, 6 + play, 14, 1))
    drawing.add("kingpin", rivet(at(0, 0, -4), Z, 6, 8))
    drawing.add("wheel", cut(cyl(hub - 12 * Y, Y, radius, 24), bore(hub, Y, 6)))
    drawing.add("bush", tube(hub - 14 * Y, Y, 4 + play, 6, 28))
    drawing.add("axle", screw(hub - 17.5 * Y, Y, 4, 42))
    drawing.add("nut", hexagon(hub + 17.5 * Y, Y, 6.5, 6, 4))
    drawing.joint("Revolute", "plate", "fork", (0, 0, 0), Z)
    drawing.joint("Revolute", "wheel", "fork", hub, Y)
    drawing.joint("Weld", "bush", "wheel")
    drawing.joint("Weld", "axle", "fork")
    return drawing


@kind
def drill_press(random):
    """A table on a column, a quill that a pinion moves, a spindle in bushes in it."""
    drawing, play = Drawing(["base"], unit="INCH"), random.choice([0.0, 0.05])
    level, radius = random.uniform(60, 120), 20.0
    base = union(box((-60, -50, -15), (150, 50, 0)), tube((0, 0, 0), Z, radius, 32, 40))
    drawing.add("base", cut(base, *(bore((x, y, 0), Z, 5) for x in (-45, 130) for y in (-35, 35))))
    drawing.add("column", cyl((0, 0, 0), Z, radius, 320))
    collar = union(tube((0, 0, level), Z, radius + play, 32, 45), box((30, -8, level), (60, 8, level + 30)))
    table = union(collar, box((55, -50, level + 30), (155, 50, level + 40)))
    drawing.add("table", cut(table, bore((0, 0, 0), Z, radius + play), bore((105, 0, 0), Z, 8)))
    head = union(tube((0, 0, 240), Z, radius, 34, 75), box((30, -34, 240), (140, 34, 315)))
    head = cut(head, bore((0, 0, 0), Z, radius), bore((105, 0, 0), Z, 22), bore((72, 0, 262), Y, 8))
    drawing.add("head", head)
    drawing.add(
        "quill",
        cut(
            cyl((105, 0, 205), Z, 22 - play, 100),
            bore((105, 0, 0), Z, 9),
            cyl((105, 0, 200), Z, 12, 20),
            cyl((105, 0, 290), Z, 12, 20),
        ),
    )
    for name, z in (("lower bush", 205.0), ("upper bush", 290.0)):
        drawing.add(name, tube((105, 0, z), Z, 8, 12, 15))
        drawing.joint("Weld", name, "quill")
    drawing.add(
        "spindle", union(cyl((105, 0, 190), Z, 8, 140), cyl((105, 0, 180), Z, 14, 24.9), cyl((105, 0, 305.1), Z, 11, 4))
    )
    drawing.add(
        "feed",
        union(
            cyl((72, -40, 262), Y, 8, 80),
            cyl((72, -56, 262), Y, 14, 16),
            cyl((72, -48, 262), X, 3, 80),
            cyl((72, 40, 262), Y, 11, 3),
        ),
    )
    drawing.joint("Weld", "column", "base")
    drawing.joint("Weld", "head", "column")
    drawing.joint("Cylindrical", "table", "column", (0, 0, 0), Z)
    drawing.joint("Cylindrical", "quill", "head", (105, 0, 0), Z)
    drawing.joint("Revolute", "spindle", "quill", (105, 0, 0), Z)
    drawing.joint("Revolute", "feed", "head", (72, 0, 262), Y)
    return drawing
