"""A ball balancer of students, a lift of folded panels without pins, and the pitch drive of a wind turbine."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import balls, bolt, capscrew, nut, ram, rings, servo, strut, upright, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, laid, sphere, tube, union

THIRDS = 2 * np.pi * np.arange(3) / 3


@kind
def rrs_platform(random: np.random.Generator) -> Drawing:
    """Three servos with cranks, links with a bearing below and a rod end above, a plate on the balls; bolts and nuts.

    Truth: each crank turns on the shaft of its servo, each link on the bolt of its crank, about the tangent; the ball
    of each rod end is one with the plate, and the housing, one with the link, swivels on it. Three freedoms.
    """
    d, play = Drawing(["Base"]), random.choice([0.02, 0.1, 0.2])
    lift, crank, length, wide = np.radians(random.uniform(5, 40)), random.uniform(38, 46), random.uniform(85, 105), 95
    start = at(wide, 0, 22)
    end = start + crank * at(np.cos(lift), 0, np.sin(lift))
    top = at(wide + random.uniform(5, 15), 0, 0)
    top[2] = end[2] + np.sqrt(length**2 - (top[0] - end[0]) ** 2)
    way = (top - end) / length
    base, deck, ears = cyl((0, 0, -5), Z, wide + 30, 5), cyl((0, 0, top[2] + 10), Z, top[0] + 12, 4), []
    for number, turn in enumerate(THIRDS, 1):
        out = at(np.cos(turn), np.sin(turn), 0)

        def put(shape, out=out):
            return laid(shape, (0, 0, 0), out, Z)

        def name(what, number=number):
            return f"{what}-{number}"

        tangent, spot = np.cross(Z, out), lambda point, out=out: point[0] * out + point[2] * Z
        base = cut(base, put(bore((wide - 30, -38, 0), Z, 1.5, 20)))
        wall = box((wide - 40, -26, 0), (wide + 20, -23, 36)).union(box((wide - 40, -46, 0), (wide + 20, -23, 4)))
        wall = cut(wall, box((wide - 30.7, -30, 11.8), (wide + 10.4, -20, 32.2)), bore((wide - 30, -38, 0), Z, 1.6, 20))
        fast(d, "Base", **{name("Servo bracket"): put(wall)})
        fast(d, name("Servo bracket"), **{name("MG996R"): put(servo(start - 12 * Y, -X, Y))})
        fast(d, name("Servo bracket"), **{name("M3x8"): put(capscrew((wide - 30, -38, 4), -Z, 1.5, 8))})
        arm = upright([start[::2], end[::2]], -10, -5, 7, [end[::2]], 1.6)
        d.add(name("Crank"), put(cut(arm, bore(start, Y, 2.95))))
        fast(d, name("Crank"), **{name("M3x18"): put(bolt(end - 10 * Y, Y, 1.5, 18))})
        fast(d, name("Crank"), **{name("Spacer"): put(tube(end - 5 * Y, Y, 1.6, 2.5, 3))})
        fast(d, name("Crank"), **{name("M3 nut"): put(nut(end + 2 * Y, Y, 1.5))})
        link = union(cyl(end - 2 * Y, Y, 8, 4), strut(end + 4 * way, top - 12 * way, 4))
        link = cut(link, cyl(end - 9 * Y, Y, 5, 18), strut(top - 26 * way, top - 10 * way, 2))
        d.add(name("Link"), put(link))
        fast(d, name("Link"), **{name("623ZZ"): put(tube(end - 2 * Y, Y, 1.5, 5, 4))})
        eye = union(cyl(top - 2.5 * Y, Y, 7, 5), strut(top - 24 * way, top - 5 * way, 2))
        fast(d, name("Link"), **{name("POS4"): put(cut(eye, sphere(top, 4.5 + play)))})
        ball = sphere(top, 4.5).intersect(box(top - at(9, 3.5, 9), top + at(9, 3.5, 9))).cut(bore(top, Y, 2))
        ears.append(put(box(top + at(-5, 3.5, -5), top + at(5, 9.5, 10)).cut(bore(top, Y, 2.1, 12))))
        d.add(name("POS4 ball"), put(ball))
        d.add(name("M4x16"), put(capscrew(top - 3.5 * Y, Y, 2, 17)))
        d.add(name("M4 nut"), put(nut(top + 9.5 * Y, Y, 2)))
        d.joint("Revolute", name("MG996R"), name("Crank"), spot(start), tangent)
        d.joint("Revolute", name("Crank"), name("Link"), spot(end), tangent)
        d.joint("Spherical", name("POS4"), name("POS4 ball"), spot(top))
    d.add("Base", base)
    d.add("Plate", union(deck, *ears))
    for number in (1, 2, 3):
        weld(d, "Plate", f"POS4 ball-{number}", f"M4x16-{number}", f"M4 nut-{number}")
    return d


@kind
def sarrus_lift(random: np.random.Generator) -> Drawing:
    """A top over a base on four pairs of panels with hinge knuckles, bores coaxial and nothing in them.

    Truth: twelve hinges, three in each pair of panels, about the tangents. One freedom: the top rises.
    """
    d, gap, wide = Drawing(["PRT0001"]), random.choice([0.1, 0.2, 0.5]), 70
    reach, long = random.uniform(25, 45), random.uniform(60, 70)
    low = at(wide, 0, 10)
    mid = low + at(reach, 0, np.sqrt(long**2 - reach**2))
    high = at(wide, 0, 2 * mid[2] - 10)
    base = box((8 - wide, 8 - wide, 0), (wide - 8, wide - 8, 6))
    top = base.translate((0, 0, high[2] + 4))
    for side in range(4):
        out = at(np.cos(side * np.pi / 2), np.sin(side * np.pi / 2), 0)

        def put(shape, out=out):
            return laid(shape, (0, 0, 0), out, Z)

        def knuckles(point, inner: bool, toward):
            """Those of one panel at a hinge, with necks to its web."""
            spans = [(-20, 20)] if inner else [(-40, -20 - gap), (20 + gap, 40)]
            flat = [point[::2], (point + 9 * toward)[::2]]
            return [
                cyl(point + y * Y, Y, 5, z - y).union(upright(flat, y, z, 3)).cut(bore(point, Y, 2.5)) for y, z in spans
            ]

        ear = box((wide - 12, -20, 0), (wide, 20, 10)).union(cyl(low - 20 * Y, Y, 5, 40)).cut(bore(low, Y, 2.5, 60))
        base = base.union(put(ear))
        ear = box((wide - 12, -20, high[2]), (wide, 20, high[2] + 10)).union(cyl(high - 20 * Y, Y, 5, 40))
        top = top.union(put(ear.cut(bore(high, Y, 2.5, 60))))
        names = [f"PRT{2 * side + 3:04}", f"PRT{2 * side + 4:04}"]
        for name, one, other, inner in ((names[0], low, mid, True), (names[1], high, mid, False)):
            along = (other - one) / long
            web = upright([(one + 9 * along)[::2], (other - 9 * along)[::2]], -40, 40, 3)
            d.add(name, put(union(web, *knuckles(one, False, along), *knuckles(other, inner, -along))))
        tangent, spot = np.cross(Z, out), lambda point, out=out: point[0] * out + point[2] * Z
        d.joint("Revolute", "PRT0001", names[0], spot(low), tangent)
        d.joint("Revolute", names[0], names[1], spot(mid), tangent)
        d.joint("Revolute", names[1], "PRT0002", spot(high), tangent)
    d.add("PRT0001", base)
    d.add("PRT0002", top)
    return d


@kind
def pitch_drive(random: np.random.Generator) -> Drawing:
    """A hub with three blade bearings of rings and balls, blades, crank plates with pins, a cylinder to each.

    Truth: each inner ring, one with blade and crank plate, turns about the radius; each cylinder turns on the pin in
    the hub, its rod slides, and turns on the pin of the crank plate. Three freedoms.
    """
    d, hub = Drawing(["Nabe"]), union(cyl((0, 0, -40), Z, 50, 80), cyl((0, 0, -210), Z, 175, 12))
    hub = hub.union(cyl((0, 0, -200), Z, 45, 200))
    turn, deep = np.radians(random.uniform(-25, 25)), random.uniform(150, 165)
    pin, foot = at(132, 30 * np.cos(turn), 30 * np.sin(turn)), at(132, 30, -deep)
    head = random.choice([0.0, 0.05])
    for number, angle in enumerate(THIRDS + random.uniform(0, 1), 1):
        out = at(np.cos(angle), np.sin(angle), 0)

        def put(shape, out=out):
            return laid(shape, (0, 0, 0), out, Z)

        def spot(point, out=out):
            return point[0] * out + point[1] * np.cross(Z, out) + point[2] * Z

        def name(what, number=number):
            return f"{what} {number}"

        arm = cut(cyl((30, 0, 0), X, 62, 120), cyl((80, 0, 0), X, 50, 80), box((112, 8, -80), (141, 52, 0)))
        lugs = box((112, 16, -200), (152, 44, -deep + 12)).cut(box((120, 10, -198), (144, 50, 0)))
        hub = hub.union(put(arm)).union(put(lugs.cut(cyl(foot - 40 * X, X, 5, 80))))
        inner, outer = rings((150, 0, 0), X, 40, 60, 16)
        fast(d, "Nabe", **{name("Aussenring"): put(outer)})
        d.add(name("Innenring"), put(inner))
        for count, each in enumerate(balls((150, 0, 0), X, 40, 60, 16, 6), 1):
            d.add(name(f"Kugel {count} an"), put(each))
        blade = union(cyl((150, 0, 0), X, 40, 16), cyl((166, 0, 0), X, 48, 8), box((174, -25, -8), (420, 35, 8)))
        fast(d, name("Innenring"), **{name("Blattwurzel"): put(blade)})
        plate = cyl((142, 0, 0), X, 45, 8).cut(cyl(pin - 40 * X, X, 5, 80))
        fast(d, name("Blattwurzel"), **{name("Kurbelscheibe"): put(plate)})
        fast(d, name("Kurbelscheibe"), **{name("Bolzen"): put(cyl((122, pin[1], pin[2]), X, 5 - head, 28))})
        barrel, rod = ram(foot, pin, X, 9, 5, 5, 14, 68, foot_width=24)
        d.add(name("Zylinderrohr"), put(barrel))
        d.add(name("Kolbenstange"), put(rod))
        d.add(name("Lagerbolzen"), put(cyl((110, 30, -deep), X, 5, 44)))
        weld(d, "Nabe", name("Lagerbolzen"))
        d.joint("Revolute", name("Aussenring"), name("Innenring"), (0, 0, 0), out)
        d.joint("Revolute", "Nabe", name("Zylinderrohr"), spot(foot), out)
        along = spot(pin) - spot(foot)
        d.joint("Cylindrical", name("Zylinderrohr"), name("Kolbenstange"), spot(foot), along)
        d.joint("Revolute", name("Kolbenstange"), name("Kurbelscheibe"), spot(pin), out)
    d.add("Nabe", hub)
    return d
