"""What runs on rods, rails and bearings: a camera slider and a ball screw axis."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, hexagon, laid, screw, sphere, torus, tube, union


def ball_bearing(drawing: Drawing, name: str, point, axis, inner: float, outer: float, width: float) -> None:
    """Two rings and their balls, each a part."""
    axis, ring = np.asarray(axis, float), 0.3 * (outer - inner)
    side = np.cross(axis, X if abs(axis[0]) < 0.9 else Y)
    across = np.cross(axis, side)
    middle, pitch, ball = np.asarray(point, float) + 0.5 * width * axis, (inner + outer) / 2, 0.28 * (outer - inner)
    race = torus(middle, axis, pitch, ball)
    drawing.add(f"{name} inner ring", cut(tube(point, axis, inner, inner + ring, width), race))
    drawing.add(f"{name} outer ring", cut(tube(point, axis, outer - ring, outer, width), race))
    turns = np.arange(7) * 2 * np.pi / 7
    balls = [sphere(middle + pitch * (np.cos(t) * side + np.sin(t) * across), ball) for t in turns]
    drawing.add(f"{name} balls", union(*balls))


def hollow(point, axis, radius: float, count: int, phase: float = 0.4):
    """Points evenly on a circle about an axis."""
    axis = np.asarray(axis, float)
    side = np.cross(axis, X if abs(axis[0]) < 0.9 else Y)
    across, turns = np.cross(axis, side), np.arange(count) * 2 * np.pi / count + phase
    return [np.asarray(point, float) + radius * (np.cos(t) * side + np.sin(t) * across) for t in turns]


@kind
def camera_slider(random):
    """Rods clamped by set screws, a carriage on four linear bearings with circlips, a lead screw with a brass nut."""
    drawing, play, half = Drawing(["end -1"]), random.choice([0.0, 0.02]), random.uniform(180, 240)
    rods = [at(0, y, 0) for y in (-28, 28)]
    for s in (-1, 1):
        side, low = s * X, at(s * half, 0, 0)
        plate = box(low + at(0, -45, -25), low + at(s * 14, 45, 18))
        plate = cut(plate, *(bore(p, X, 4, 900) for p in rods), bore(0 * X, X, 7, 900), cyl(low, side, 11, 7))
        plate = cut(plate, *(cyl(low + at(s * 7, y, 2), Z, 1.5, 20) for y in (-28, 28)))
        if s > 0:
            plate = cut(plate, *(bore(p, X, 1.6, 20) for p in hollow(low, X, 22, 4, 0.785)))
        drawing.add(f"end {s}", plate)
        for k, y in enumerate((-28, 28)):
            drawing.add(f"set screw {s} {k}", cyl(low + at(s * 7, y, 4), Z, 1.5, 10))
        ball_bearing(drawing, f"end {s}", low, side, 4, 11, 7)
        drawing.add(f"collar {s}", cut(tube(low - 7 * side, side, 4, 6.5, 7), cyl(low - 3.5 * side, Z, 1.5, 8)))
        drawing.add(f"collar screw {s}", cyl(low - 3.5 * side + 4 * Z, Z, 1.5, 3.5))
    for k, p in enumerate(rods):
        drawing.add(f"rod {k}", cyl(p - (half + 14) * X, X, 4, 2 * half + 28))
        drawing.joint("Weld", f"rod {k}", "end -1")
    drawing.joint("Weld", "end 1", "end -1")
    drawing.add("lead screw", cyl((-half - 12, 0, 0), X, 4, 2 * half + 40))
    top = box((-38, -45, 16), (38, 45, 22))
    spots = [at(x, y, 16) for x in (-26, 26) for y in (-40, -18, 18, 40)]
    drawing.add("carriage", cut(top, *(bore(p, Z, 2.1, 30) for p in spots), bore((0, 0, 16), Z, 3, 30)))
    for k, p in enumerate(rods):
        block = box(p + at(-34, -15, -12), p + at(34, 15, 16))
        block = cut(
            block, bore(p, X, 7.5, 90), *(cyl(q - 12 * Z, Z, 1.65, 12.1) for q in spots if abs(q[1] - p[1]) < 13)
        )
        drawing.add(f"pillow block {k}", block)
        drawing.joint("Weld", f"pillow block {k}", "carriage")
        for s in (-1, 1):
            bearing = tube(p + at(s * 8, 0, 0), s * X, 4 + play, 7.5, 24)
            groove = tube(p + at(s * 28, 0, 0), s * X, 7.1, 8, 1)
            drawing.add(f"linear bearing {k} {s}", cut(bearing, groove))
            drawing.joint("Weld", f"linear bearing {k} {s}", f"pillow block {k}")
    for k, q in enumerate(spots):
        drawing.add(f"block screw {k}", screw(q + 6 * Z, -Z, 1.65, 15))
    ties = hollow((0, 0, 0), X, 8, 4)
    bracket = cut(box((-5, -11.5, -15), (5, 11.5, 16)), bore(0 * X, X, 5.1, 90), *(bore(p, X, 1.25, 9) for p in ties))
    drawing.add("nut bracket", cut(bracket, cyl((0, 0, 8), Z, 2.5, 9)))
    drawing.add("bracket screw", screw((0, 0, 22), -Z, 2.5, 14))
    nut = cut(union(cyl((-10, 0, 0), X, 5.1, 15), cyl((5, 0, 0), X, 11, 3.5)), bore(0 * X, X, 4, 90))
    drawing.add("brass nut", cut(nut, *(bore(p, X, 1.5, 9) for p in ties)))
    for k, p in enumerate(ties):
        drawing.add(f"nut screw {k}", screw(p + 8.5 * X, -X, 1.25, 8))
    motor = at(half + 54, 0, 0)
    drawing.add(
        "motor",
        cut(
            union(box(motor + at(0, -21, -21), motor + at(40, 21, 21)), tube(motor, -X, 3, 11, 2)),
            cyl(motor - 2 * X, X, 3, 30),
            *(cyl(p - X, X, 1.5, 8) for p in hollow(motor, X, 22, 4, 0.785)),
        ),
    )
    drawing.add("motor shaft", cyl(motor + 20 * X, -X, 2.5, 40))
    coupling = cut(cyl(motor - 32 * X, X, 9, 25), cyl(motor - 32 * X, X, 4, 12.5), cyl(motor - 20 * X, X, 2.5, 15))
    drawing.add("coupling", cut(coupling, *(cyl(motor - x * X, Z, 1.5, 12) for x in (27, 12))))
    for k, (x, r) in enumerate(((27, 4), (12, 2.5))):
        drawing.add(f"coupling screw {k}", cyl(motor - x * X + r * Z, Z, 1.5, 5))
    for k, p in enumerate(hollow((half + 14, 0, 0), X, 22, 4, 0.785)):
        drawing.add(f"stand-off {k}", tube(p, X, 1.5, 3.5, 40))
        drawing.add(f"motor screw {k}", screw(p - 14 * X, X, 1.5, 58))
    drawing.joint("Weld", "motor", "end 1")
    drawing.joint("Revolute", "motor shaft", "motor", motor, X)
    drawing.joint("Weld", "coupling", "motor shaft")
    drawing.joint("Weld", "lead screw", "coupling")
    drawing.joint("Revolute", "lead screw", "end 1", (0, 0, 0), X)
    drawing.joint("Weld", "nut bracket", "carriage")
    drawing.joint("Weld", "brass nut", "nut bracket")
    drawing.joint("Cylindrical", "lead screw", "brass nut", (0, 0, 0), X)
    drawing.joint("Prismatic", "carriage", "end -1", (0, 0, 0), X)
    return drawing


@kind
def ball_screw_axis(random):
    """Two profile rails with four carriages, a table, a ball screw in a fixed and a floating support, a motor."""
    drawing, play, half = Drawing(["bed"]), random.choice([0.0, 0.02]), random.uniform(200, 260)
    rails, x0 = (-60, 60), random.uniform(-60, 40)
    rail_spots = [at(x, y, 0) for y in rails for x in np.linspace(-half + 20, half - 20, 5)]
    places = [at(x0 + sx * 45, y, 0) for y in rails for sx in (-1, 1)]
    table_spots = [p + at(x, y, 24) for p in places for x in (-12, 12) for y in (-13, 13)]
    supports = {"fixed": at(-half - 10, 0, 0), "floating": at(half - 10, 0, 0)}
    feet = [p + at(10, y, 0) for p in supports.values() for y in (-24, 24)]
    holes = [cyl(p - 12 * Z, Z, 2.5, 13) for p in rail_spots] + [cyl(p - 15 * Z, Z, 2.5, 16) for p in feet]
    drawing.add("bed", cut(box((-half - 80, -90, -25), (half + 30, 90, 0)), *holes))
    profile = [
        (-7.5, 0),
        (7.5, 0),
        (7.5, 5),
        (6, 7),
        (6, 9),
        (7.5, 11),
        (7.5, 15),
        (-7.5, 15),
        (-7.5, 11),
        (-6, 9),
        (-6, 7),
        (-7.5, 5),
    ]

    def profile_bar(more: float):
        """The section of a rail, grown by this much, over the length of the axis."""
        points = [(x + more * np.sign(x), z + (more if z > 14 else 0)) for x, z in profile]
        return laid(cq.Workplane().polyline(points).close().extrude(2 * half), (-half, 0, 0), Y, X)

    for k, y in enumerate(rails):
        rail = cut(profile_bar(0.0).translate((0, y, 0)), *(bore(p, Z, 2.5, 30) for p in rail_spots if p[1] == y))
        drawing.add(f"rail {k}", cut(rail, *(cyl(p + 9 * Z, Z, 4.5, 9) for p in rail_spots if p[1] == y)))
        drawing.joint("Weld", f"rail {k}", "bed")
    for k, p in enumerate(rail_spots[:5]):
        drawing.add(
            f"rail screw {k}",
            cut(union(cyl(p + 9 * Z, -Z, 2.5, 20), cyl(p + 9 * Z, Z, 4.2, 5)), hexagon(p + 12 * Z, Z, 2, 3)),
        )
    for k, p in enumerate(places):
        block = cut(box(p + at(-28, -17, 4), p + at(28, 17, 24)), profile_bar(play).translate((0, p[1], 0)))
        drawing.add(f"carriage {k}", cut(block, *(cyl(q - 6 * Z, Z, 2, 7) for q in table_spots[4 * k : 4 * k + 4])))
        drawing.joint("Prismatic", f"carriage {k}", f"rail {k // 2}", p, X)
        drawing.joint("Weld", f"carriage {k}", "table")
    under = [at(x0 + x, y, 24) for x in (-14, 14) for y in (-22, 22)]
    table = box((x0 - 85, -85, 24), (x0 + 85, 85, 36))
    drawing.add("table", cut(table, *(bore(q, Z, 2.2, 30) for q in table_spots), *(bore(q, Z, 2.2, 30) for q in under)))
    for k, q in enumerate(table_spots[:8]):
        drawing.add(f"table screw {k}", screw(q + 12 * Z, -Z, 2, 17))
    axis, c = at(0, 0, 12), at(x0, 0, 12)
    housing = cut(
        box(c + at(-20, -30, -10), c + at(20, 30, 12)), bore(c, X, 9, 60), *(cyl(q - 10 * Z, Z, 2, 11) for q in under)
    )
    ties = hollow(c, X, 12.5, 6, 0.1)
    ties = [p for p in ties if abs(p[2] - 12) < 8]
    drawing.add("nut housing", cut(housing, *(bore(p, X, 1.5, 30) for p in ties)))
    nut = cut(union(cyl(c + at(-26, 0, 0), X, 9, 46), cyl(c + at(20, 0, 0), X, 17, 6)), bore(c, X, 6 + play, 60))
    nut = cut(nut, box(c + at(19, -20, -20), c + at(27, 20, -10)), box(c + at(19, -20, 11), c + at(27, 20, 20)))
    drawing.add("ball nut", cut(nut, *(bore(p, X, 1.7, 60) for p in ties)))
    for k, p in enumerate(ties):
        drawing.add(f"nut screw {k}", screw(p + 26 * X, -X, 1.5, 14))
    shaft = [
        cyl((-half + 14, 0, 12), X, 6, 2 * half - 26),
        cyl((-half - 70, 0, 12), X, 4, 90),
        cyl((half - 13, 0, 12), X, 4, 20),
    ]
    drawing.add("ball screw", cut(union(*shaft), tube((half + 5, 0, 12), X, 3.6, 5, 0.8)))
    for name, p in supports.items():
        mid = p + axis
        block = cut(box(p + at(0, -32, 0), p + at(20, 32, 28)), bore(mid, X, 8, 60), cyl(mid + 4 * X, X, 11, 20))
        block = cut(block, *(bore(q, Z, 2.7, 40) for q in feet))
        drawing.add(f"{name} support", block)
        for k in range(2 if name == "fixed" else 1):
            ball_bearing(drawing, f"{name} {k}", mid + (4 + 7 * k) * X, X, 4, 11, 7)
        drawing.joint("Weld", f"{name} support", "bed")
    cover = cut(box((-half + 10, -14, 0), (-half + 12, 14, 26)), bore(axis, X, 6.5, 900))
    drawing.add("cover", cover)
    drawing.add("spacer", tube((-half + 8, 0, 12), X, 4, 5.5, 6))
    drawing.add("lock nut", tube((-half - 6, 0, 12), -X, 4, 7.5, 7))
    drawing.add("floating clip", circlip((half + 5, 0, 12), X, 4, 0.8))
    m = at(-half - 100, 0, 12)
    drawing.add("motor shaft", cyl(m - 30 * X, X, 2.5, 56))
    motor = cut(box(m + at(-45, -21, -12), m + at(0, 21, 21)), cyl(m - 30 * X, X, 2.5, 56))
    drawing.add("motor", cut(motor, *(cyl(p - 6 * X, X, 1.5, 7) for p in hollow(m, X, 15, 2, np.pi / 2))))
    bracket = box(m + at(0, -24, -12), m + at(6, 24, 24))
    foot = union(bracket, box(m + at(0, -24, -12), m + at(26, 24, -8.5)))
    bed_ties = [m + at(20, y, -12) for y in (-16, 16)]
    foot = cut(
        foot,
        bore(m, X, 11, 7),
        *(bore(p, X, 1.6, 7) for p in hollow(m, X, 15, 2, np.pi / 2)),
        *(bore(p, Z, 2.2, 7) for p in bed_ties),
    )
    drawing.add("motor bracket", foot)
    drawing.parts["bed"] = cut(
        union(drawing.parts["bed"], box((-half - 120, -90, -25), (-half - 80, 90, 0))),
        *(bore(p, Z, 2, 10) for p in bed_ties),
    )
    jaws = {"motor": [at(0, t, 0) for t in (-1, 1)], "screw": [at(0, 0, t) for t in (-1, 1)]}
    disc = tube(m + 24 * X, X, 4.5, 8, 8)
    for name, low, r in (("motor", 12.0, 2.5), ("screw", 32.0, 4.0)):
        jaw = [
            box(m + 24 * X + 6 * t + 2.5 * (Y + Z - abs(t)), m + 32 * X + 11 * t - 2.5 * (Y + Z - abs(t)))
            for t in jaws[name]
        ]
        teeth = disc.intersect(union(*jaw))
        disc = cut(disc, *jaw)
        hub = union(
            cut(cyl(m + low * X, X, 8, 12), bore(m, X, r, 900)),
            *(cq.Workplane(obj=each) for each in teeth.solids().vals()),
        )
        spot = m + (low + (5 if name == "motor" else 7)) * X
        side = Z if name == "motor" else Y
        drawing.add(f"{name} hub", cut(hub, cyl(spot, side, 1.5, 20)))
        drawing.add(f"{name} hub screw", cyl(spot + r * side, side, 1.5, 4))
    drawing.add("spider", disc)
    drawing.joint("Weld", "motor", "motor bracket")
    drawing.joint("Weld", "motor bracket", "bed")
    drawing.joint("Weld", "nut housing", "table")
    drawing.joint("Weld", "ball nut", "nut housing")
    drawing.joint("Cylindrical", "ball screw", "ball nut", axis, X)
    drawing.joint("Revolute", "ball screw", "fixed support", axis, X)
    drawing.joint("Weld", "screw hub", "ball screw")
    drawing.joint("Revolute", "motor shaft", "motor", m, X)
    drawing.joint("Weld", "motor hub", "motor shaft")
    return drawing
