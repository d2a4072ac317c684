"""A walker with a Klann leg on each side, an arm on two gearmotors, and the iris of a lens."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from drawings.catalogued import balls, capscrew, rings, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import Shape, X, Y, Z, at, bar, bore, box, cut, cyl, laid, meet, tube, union


@kind
def klann_walker(random: np.random.Generator) -> Drawing:
    """A leg on each face of a chassis plate, of flat links with coaxial holes and nothing in them, on one crankshaft.

    Truth: the shaft, one with both cranks, turns in the chassis; crank, connecting arm, rockers and leg turn on each
    other at their holes, about z. One freedom.
    """
    d, gap, turn = Drawing(["CHASSIS"]), random.choice([0.0, 0.1, 0.3]), random.uniform(0, 2 * np.pi)
    hip, shoulder = at(-46, -20), at(-51, 44)
    chassis = bar((-60, 0), (60, 0), 22, 0, 5).union(box((-56, -30, 0), (56, 56, 5)))
    d.add("SHAFT", cyl((0, 0, -5 - gap), Z, 4, 15 + 2 * gap))
    turns(d, ("CHASSIS", "SHAFT", at(0, 0, 0), Z))
    for tag, side in (("A", 1), ("B", -1)):
        first = 5 + gap if side > 0 else -gap
        second = first + side * (5 + gap)

        def layer(start, side=side):
            return sorted((start, start + side * 5))

        def mirrored(point, side=side):
            return at(side * point[0], point[1])

        crank = 13 * at(np.cos(turn), np.sin(turn))
        elbow = meet(crank, 43, hip, 27)
        way = (elbow - crank) / 43
        bend = np.radians(-22)
        knee = crank + 85 * at(
            np.cos(bend) * way[0] - np.sin(bend) * way[1], np.sin(bend) * way[0] + np.cos(bend) * way[1]
        )
        thigh = meet(knee, 54.7, shoulder, 58)
        foot = knee + 85 * (knee - thigh) / 54.7 + at(-20, 0)
        o, c, h, s, e, k, t, f = map(mirrored, (at(0, 0), crank, hip, shoulder, elbow, knee, thigh, foot))

        def link(start, *points, holes):
            pieces = [bar(a, b, 5, *layer(start)) for a, b in pairwise(points)]
            return cut(union(*pieces), *(bore((*p, 0), Z, 2, 60) for p in holes))

        crank_disc = (
            link(first, o, c, holes=[c]).union(cyl((0, 0, layer(first)[0]), Z, 8, 5)).cut(bore((0, 0, 0), Z, 4, 60))
        )
        fast(d, "SHAFT", **{f"CRANK-{tag}": crank_disc})
        d.add(f"CONN-ARM-{tag}", link(second, c, e, k, holes=[c, e, k]))
        d.add(f"LOWER-ROCKER-{tag}", link(first, h, e, holes=[h, e]))
        d.add(f"UPPER-ROCKER-{tag}", link(second, s, t, holes=[s, t]))
        d.add(f"LEG-{tag}", link(first, t, k, f, holes=[t, k]))
        face = 5 if side > 0 else 0
        spacer = tube((*s, face), side * Z, 2, 4.5, abs(second - face) - gap)
        fast(d, "CHASSIS", **{f"SPACER-{tag}": spacer})
        chassis = cut(chassis, *(cyl((*p, 2.5), side * Z, 2, 9) for p in (h, s)))
        for one, other, point in (
            (f"CRANK-{tag}", f"CONN-ARM-{tag}", c),
            (f"CONN-ARM-{tag}", f"LOWER-ROCKER-{tag}", e),
            (f"LOWER-ROCKER-{tag}", "CHASSIS", h),
            (f"CONN-ARM-{tag}", f"LEG-{tag}", k),
            (f"LEG-{tag}", f"UPPER-ROCKER-{tag}", t),
            (f"UPPER-ROCKER-{tag}", "CHASSIS", s),
        ):
            turns(d, (one, other, at(*point, 0), Z))
    d.add("CHASSIS", chassis.cut(bore((0, 0, 0), Z, 4 + random.choice([0.05, 0.2]), 60)))
    return d


def _gearmotor(origin, x, z) -> Shape:
    """A gearmotor of 37 mm as one solid: the face of its gearbox seven millimetres beside the shaft at the origin."""
    shaft = cyl((0, 0, 0), Z, 3, 20).cut(box((2.5, -9, 6), (9, 9, 30)))
    case = union(cyl((-7, 0, -24), Z, 18.5, 24), cyl((-7, 0, -56), Z, 17, 32), cyl((0, 0, -1), Z, 6, 6))
    holes = [cyl((-7 + 15.5 * np.cos(t), 15.5 * np.sin(t), -5), Z, 1.5, 6) for t in np.arange(6) * np.pi / 3]
    return laid(cut(case, *holes).union(shaft), origin, x, z)


@kind
def gearmotor_arm(random: np.random.Generator) -> Drawing:
    """Two gearmotors with D shafts, hubs with grub screws, two links, a wrist shaft in two ball bearings, a tool.

    Truth: each hub, one with its grub screw, the screws and its link, turns on its motor about y; the wrist's shaft,
    one with collar and tool, turns in its bearings about the length of the forearm. Three freedoms.
    """
    d, play = Drawing(["Grundplatte"]), random.choice([0.0, 0.02, 0.1])
    angles = np.cumsum(random.uniform((0.3, -1.5), (1.4, -0.3)))
    ways = [at(np.cos(t), 0, np.sin(t)) for t in angles]
    first = at(0, 0, 90)
    second = first + random.uniform(110, 140) * ways[0]
    d.add("Grundplatte", box((-70, -70, -8), (70, 60, 0)))
    column = union(box((-35, -4, 0), (35, 0, 125)), box((-35, -60, 0), (35, 0, 6)))
    spots = [at(x, -40, 6) for x in (-25, 25)]
    d.parts["Grundplatte"] = cut(d.parts["Grundplatte"], *(cyl(p - 14 * Z, Z, 2.5, 20) for p in spots))

    def motor(number: int, place, x, holder: Shape) -> Shape:
        """Put a gearmotor behind a plate that ends at y = 0 of the place; return the plate with its holes."""
        d.add(f"JGB37-520 {number}", _gearmotor(place - 4 * Y, x, Y))
        holder = cut(holder, bore(place, Y, 6.2, 7))
        y = np.cross(Y, x)
        for k, t in enumerate((0, 2, 4)):
            t = t * np.pi / 3 + np.pi / 3
            spot = place + (-7 + 15.5 * np.cos(t)) * x + 15.5 * np.sin(t) * y
            holder = cut(holder, bore(spot, Y, 1.6, 7))
            d.add(f"M3x8 {number}{k}", capscrew(spot, -Y, 1.5, 8))
        hub = laid(union(cyl((0, 0, 3), Z, 11, 4), cyl((0, 0, 7), Z, 7, 9)), place - 4 * Y, x, Y)
        hub = hub.translate((0, 3, 0))
        shaft = laid(cyl((0, 0, 0), Z, 3 + play, 20).cut(box((2.5 + play, -9, 0), (9, 9, 30))), place - 4 * Y, x, Y)
        grub = cyl(place + 13 * Y + (2.5 + play) * x, x, 1.5, 5)
        d.add(f"Nabe {number}", cut(hub, shaft, cyl(place + 13 * Y + 1 * x, x, 1.5, 9)))
        fast(d, f"Nabe {number}", **{f"Gewindestift {number}": grub})
        turns(d, (f"JGB37-520 {number}", f"Nabe {number}", place, Y))
        return holder

    d.add("Staender", cut(motor(1, first, -X, column), *(bore(p, Z, 2.7, 10) for p in spots)))
    weld(d, "Grundplatte", "Staender")
    for k, p in enumerate(spots):
        fast(d, "Staender", **{f"M5x14 {k}": capscrew(p, -Z, 2.5, 13)})
    weld(d, "Staender", "JGB37-520 1", "M3x8 10", "M3x8 11", "M3x8 12")

    def arm(start, way, length: float) -> Shape:
        """A flat link from the hub at its start, y from 6 to 10."""
        return laid(cut(bar((0, 0), (length, 0), 20, -4, 0), bore((0, 0, 0), Z, 7, 20)), start + 6 * Y, way, -Y)

    def fastened(number: int, link: Shape, place, way) -> Shape:
        """Screw a link to a hub."""
        for k, s in enumerate((-1, 1)):
            spot = place + s * 9 * np.cross(Y, way) + 10 * Y
            d.parts[f"Nabe {number}"] = cut(d.parts[f"Nabe {number}"], bore(spot, Y, 1, 9))
            fast(d, f"Nabe {number}", **{f"M2x8 {number}{k}": cyl(spot - 8 * Y, Y, 1, 8).union(cyl(spot, Y, 1.9, 2))})
            link = link.cut(bore(spot, Y, 1.1, 20))
        return link

    upper = fastened(1, arm(first, ways[0], float(np.linalg.norm(second - first))), first, ways[0])
    place, out = second + 10 * Y, ways[1]
    d.add("Oberarm", motor(2, place, ways[0], upper))
    weld(d, "Nabe 1", "Oberarm")
    weld(d, "Oberarm", "JGB37-520 2", "M3x8 20", "M3x8 21", "M3x8 22")
    fore = fastened(2, arm(place, out, 95), place, out)
    wrist = place + 110 * out + 22 * Y
    block = cut(laid(box((60, -14, -8), (112, 14, 18)), place + 18 * Y, out, Y), bore(wrist, out, 8, 300))
    starts = [wrist - 50 * out, wrist - 5 * out]
    d.add("Unterarm", fore)
    weld(d, "Nabe 2", "Unterarm")
    for k, start in enumerate(starts):
        block = block.cut(cyl(start, out, 11, 7))
        inner, outer = rings(start, out, 4, 11, 7)
        fast(d, "Lagerblock", **{f"608 Aussenring {k}": outer})
        fast(d, "Handwelle", **{f"608 Innenring {k}": inner})
        for n, each in enumerate(balls(start, out, 4, 11, 7, 7)):
            d.add(f"608 Kugel {k}{n}", each)
    d.add("Lagerblock", block)
    weld(d, "Unterarm", "Lagerblock")
    d.add("Handwelle", cyl(wrist - 60 * out, out, 4, 100))
    fast(d, "Handwelle", Stellring=tube(wrist + 2 * out, out, 4, 9, 8), Werkzeug=tube(wrist + 20 * out, out, 4, 16, 14))
    turns(d, ("Lagerblock", "Handwelle", wrist, out))
    return d


@kind
def iris_diaphragm(random: np.random.Generator) -> Drawing:
    """Six blades with two pins each, one in a base ring, one in a slot of a driving ring under a lid with screws.

    Truth: each blade turns on the base, the driving ring in the base, about z. The pins slide in the slots.
    """
    d, play, count = Drawing(["Base ring"]), random.choice([0.02, 0.1, 0.2]), 6
    swing = random.uniform(0.6, 0.8)
    base = union(tube((0, 0, -4), Z, 30, 66, 4), tube((0, 0, 0), Z, 60, 66, 12.4))
    driver = tube((0, 0, 9), Z, 34, 60 - play, 3)
    lid, screws = tube((0, 0, 12.4), Z, 36, 66, 2), [63 * at(np.cos(t), np.sin(t), 0) for t in np.arange(3) * 2.1 + 0.5]
    for number in range(count):
        turn, low = number * np.pi / 3, 0.3 + number * 1.4

        def polar(radius, angle, turn=turn):
            return at(radius * np.cos(turn + angle), radius * np.sin(turn + angle), 0)

        pivot, drive, tip = polar(50, 0), polar(44, swing), polar(22, swing + 0.8)
        blade = union(bar(pivot, drive, 5, low, low + 1), bar(drive, tip, 9, low, low + 1))
        blade = union(blade, cyl(pivot - 4 * Z, Z, 1.5, 4.2 + low), cyl(drive + (low + 0.8) * Z, Z, 1.5, 11.2 - low))
        d.add(f"Blade {number + 1}", blade)
        base = base.cut(cyl(pivot - 5 * Z, Z, 1.5 + play, 6))
        driver = driver.cut(bar(polar(38, swing), polar(54, swing), 1.5 + play, 8, 13))
        turns(d, ("Base ring", f"Blade {number + 1}", pivot, Z))
    d.add("Base ring", cut(base, *(cyl(p + 5 * Z, Z, 1, 9) for p in screws), box((55, -14, 8.9), (80, 14, 12.4))))
    d.add("Driving ring", driver.cut(box((60 - play, -3, 9), (80, 3, 12))))
    fast(d, "Driving ring", Lever=box((60 - play, -3, 9), (80, 3, 12)))
    fast(d, "Base ring", Lid=cut(lid, *(bore(p, Z, 1.1, 20) for p in screws)))
    for k, p in enumerate(screws):
        fast(d, "Lid", **{f"M2x6 {k + 1}": capscrew(p + 14.4 * Z, -Z, 1, 6)})
    turns(d, ("Base ring", "Driving ring", at(0, 0, 0), Z))
    return d
