"""Gears in cases: a cycloidal reducer on a stepper, a bevel differential, a gear pump, a worm box and a lathe chuck."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.catalogued import balls, capscrew, nut, rings, stepper
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, laid, tube, union

THIRDS = 2 * np.pi * np.arange(3) / 3


def ray(turn: float, radius: float = 1.0, z: float = 0.0) -> np.ndarray:
    """The point at an angle, a distance from z, and a height."""
    return at(radius * np.cos(turn), radius * np.sin(turn), z)


def toothed(teeth: int, root: float, pitch: float, outer: float, low: float, high: float, turn: float = 0.0) -> Shape:
    """A spur gear about z with straight flanks, a tooth at an angle."""
    step, points = 2 * np.pi / teeth, []
    for k in range(teeth):
        for radius, share in (
            (root, -0.34),
            (pitch, -0.22),
            (outer, -0.12),
            (outer, 0.12),
            (pitch, 0.22),
            (root, 0.34),
        ):
            points.append(tuple(ray(turn + (k + share) * step, radius)[:2].tolist()))
    return cq.Workplane("XY", origin=(0, 0, low)).polyline(points).close().extrude(high - low)


def frustum(point, axis, start: float, end: float, length: float) -> Shape:
    """A cone from one radius to another along an axis."""
    point, axis = (cq.Vector(*map(float, each)) for each in (point, axis))
    return cq.Workplane(obj=cq.Solid.makeCone(start, end, length, point, axis))


@kind
def cycloidal_drive(random: np.random.Generator) -> Drawing:
    """A stepper with an eccentric under a set screw, a bearing, a cycloidal disc, ring pins, pins of the output plate.

    Truth: the eccentric turns on the motor, the disc on the eccentric, the output plate in the lid.
    """
    d, play = Drawing(["Housing"]), random.choice([0.0, 0.05, 0.1])
    e, ring, pins = random.uniform(1.2, 1.6), 32.0, 10
    spots = [at(a * 15.5, b * 15.5, 4) for a in (-1, 1) for b in (-1, 1)]
    ends = [ray(t, 41.5, 31) for t in np.pi / 4 + np.arange(4) * np.pi / 2]
    posts = [ray(2 * np.pi * k / pins, ring, 1) for k in range(pins)]
    housing = cut(cyl((0, 0, 0), Z, 46, 24), cyl((0, 0, 4), Z, 37, 30), bore((0, 0, 0), Z, 11.2, 10))
    housing = cut(housing, *(bore(p, Z, 1.7, 10) for p in spots), *(cyl(p, Z, 3, 22) for p in posts))
    d.add("Housing", cut(housing, *(cyl(p - 17 * Z, Z, 1.5, 20) for p in ends)))
    fast(d, "Housing", NEMA17=stepper((0, 0, 0), X, Z))
    for k, p in enumerate(spots):
        fast(d, "NEMA17", **{f"M3x8 {k}": capscrew(p, -Z, 1.5, 8)})
    for k, p in enumerate(posts):
        fast(d, "Housing", **{f"Dowel 6x22 {k}": cyl(p, Z, 3, 22)})
    off = at(e, 0, 0)
    eccentric = union(cyl(off + 9 * Z, Z, 7.5, 6.5), cyl((0, 0, 15.5), Z, 6, 6)).cut(bore((0, 0, 0), Z, 2.5, 50))
    d.add("Eccentric", eccentric.cut(cyl((2, 0, 18.5), X, 1.5, 10)))
    fast(d, "Eccentric", Set_screw=cyl((2.5, 0, 18.5), X, 1.5, 3.4))
    d.add("6802", tube(off + 9.5 * Z, Z, 7.5, 12, 5))
    t = np.linspace(0, 2 * np.pi, 181)[:-1]
    lead = np.arctan2(np.sin((1 - pins) * t), ring / (e * pins) - np.cos((1 - pins) * t))
    x = ring * np.cos(t) - 3.1 * np.cos(t + lead) - e * np.cos(pins * t)
    y = -ring * np.sin(t) + 3.1 * np.sin(t + lead) + e * np.sin(pins * t)
    outline = [(float(a), float(b)) for a, b in zip(x, y, strict=True)]
    disc = cq.Workplane("XY", origin=(0, 0, 9.5)).spline(outline, periodic=True).close().extrude(6)
    outs = [ray(a, 20, 9) for a in np.pi / 4 + np.arange(4) * np.pi / 2]
    disc = cut(disc, bore((0, 0, 0), Z, 12 + play, 50), *(bore(p, Z, 2.6 + e, 50) for p in outs))
    d.add("Cycloidal disc", disc.translate((e, 0, 0)))
    output = union(cyl((0, 0, 16.5), Z, 26, 5.5), cyl((0, 0, 22), Z, 12, 2), cyl((0, 0, 22), Z, 10, 16))
    output = cut(output, cyl((0, 0, 16), Z, 8, 7), *(bore(p, Z, 2.5, 50) for p in outs))
    d.add("Output plate", output)
    for k, p in enumerate(outs):
        fast(d, "Output plate", **{f"Dowel 5x13 {k}": cyl(p, Z, 2.5, 13)})
    inner, outer = rings((0, 0, 24), Z, 10, 16, 7)
    lid = cut(cyl((0, 0, 24), Z, 46, 7), bore((0, 0, 0), Z, 16, 50), *(bore(p, Z, 1.7, 10) for p in ends))
    fast(d, "Housing", Lid=lid)
    fast(d, "Lid", Bearing_6804_outer=outer)
    fast(d, "Output plate", Bearing_6804_inner=inner)
    for k, p in enumerate(ends):
        fast(d, "Lid", **{f"M3x16 {k}": capscrew(p, -Z, 1.5, 16)})
    turns(d, ("NEMA17", "Eccentric"), ("Eccentric", "Cycloidal disc", off), ("Lid", "Output plate"))
    return d


@kind
def bevel_differential(random: np.random.Generator) -> Drawing:
    """A carrier with ring gear in a case, a cross pin under a roll pin, bevel gears as cones, keyed half shafts.

    Truth: carrier and pinion turn in the case, the planets on the cross pin, the side gears in the carrier. Six.
    """
    d, play = Drawing(["Case"]), random.choice([0.05, 0.1, 0.2])
    case = union(box((-64, -75, -80), (64, 100, -66)), box((-64, 85, -70), (64, 100, 40)))
    carrier = union(cyl((-30, 0, 0), X, 38, 60), cyl((-70, 0, 0), X, 17, 140), cyl((-30, 0, 0), X, 56, 6))
    carrier = cut(carrier, cyl((-24, 0, 0), X, 30, 48), bore((0, 0, 0), X, 12 + play), bore((0, 0, 0), Z, 6, 60))
    carrier = cut(carrier, box((-18, -60, -16), (18, 60, 16)), bore((0, 0, 34), Y, 1.5, 30))
    bolts = [at(-30, *(46 * np.array([np.cos(a), np.sin(a)]))) for a in np.arange(6) * np.pi / 3 + 0.3]
    d.add("Carrier", cut(carrier, *(bore(p, X, 2.75, 10) for p in bolts)))
    ring = tube((-24, 0, 0), X, 38, 58, 12).cut(frustum((-12.01, 0, 0), -X, 57, 50, 5))
    fast(d, "Carrier", Ring_gear=cut(ring, *(cyl(p, X, 2.5, 16) for p in bolts)))
    for k, p in enumerate(bolts):
        fast(d, "Carrier", **{f"M5 bolt {k}": capscrew(p, X, 2.5, 14)})
    pin = cyl((0, 0, -38), Z, 6, 76).cut(bore((0, 0, 34), Y, 1.5, 30))
    fast(d, "Carrier", Cross_pin=pin.cut(cyl((0, 0, -39), Z, 2, 3)))
    fast(d, "Cross pin", Roll_pin=cyl((0, -15, 34), Y, 1.5, 30))
    for side, tag in ((1, "A"), (-1, "B")):

        def gear(boss: float, end: float, hole: float, key: bool) -> Shape:
            """A bevel gear about z, apex at the origin, with a boss behind."""
            cone = frustum((0, 0, 10), Z, 9.2, 16.2, 7).union(cyl((0, 0, 17), Z, 16.2, 7))
            cone = cone.union(cyl((0, 0, 24), Z, boss, end - 24)).cut(bore((0, 0, 0), Z, hole))
            return cone.cut(box((-2, 0, 10), (2, 9, 40))) if key else cone

        d.add(f"Planet gear {tag}", laid(gear(9, 28.3, 6 + play, False), (0, 0, 0), X, side * Z))
        d.add(f"Side gear {tag}", laid(gear(12, 42, 7, True), (0, 0, 0), Y, side * X))
        key = box((-2, 3.5, 14), (2, 9, 38))
        shaft = union(cyl((0, 0, 11), Z, 7, 105), cyl((0, 0, 110), Z, 24, 8)).cut(key)
        shaft = cut(shaft, *(bore(ray(a, 17), Z, 3, 200) for a in np.arange(4) * np.pi / 2))
        fast(d, f"Side gear {tag}", **{f"Half shaft {tag}": laid(shaft, (0, 0, 0), Y, side * X)})
        fast(d, f"Half shaft {tag}", **{f"Key {tag}": laid(key, (0, 0, 0), Y, side * X)})
        inner, outer = rings(side * 50 * X, side * X, 17, 27, 12)
        wall = box((side * 48, -45, -70), (side * 64, 45, 40)).cut(cyl(side * 47.9 * X, side * X, 24, 20))
        case = case.union(wall.cut(cyl(side * 40 * X, side * X, 27, 22)))
        fast(d, "Case", **{f"Outer race {tag}": outer})
        fast(d, "Carrier", **{f"Inner race {tag}": inner})
        turns(d, ("Carrier", f"Planet gear {tag}", at(0, 0, 0), Z), ("Carrier", f"Side gear {tag}", at(0, 0, 0), X))
    spin = at(-8, 0, 0)
    pinion = union(frustum(spin + 60 * Y, Y, 8.5, 11, 18), cyl(spin + 78 * Y, Y, 11, 7), cyl(spin + 80 * Y, Y, 8, 60))
    d.add("Pinion shaft", pinion)
    fast(d, "Pinion shaft", Pinion_nut=nut(spin + 100 * Y, Y, 8))
    d.add("Pinion bearing", tube(spin + 85 * Y, Y, 8, 19, 15))
    d.add("Case", case.cut(bore(spin + 90 * Y, Y, 19, 20)))
    turns(d, ("Case", "Carrier", at(0, 0, 0), X), ("Case", "Pinion shaft", spin, Y))
    return d


@kind
def gear_pump(random: np.random.Generator) -> Drawing:
    """A body with two pockets, a driving gear of one piece with its shaft, a gear on its shaft, bushes, cover, gland.

    Truth: both shafts turn in their bushes, all else is one body.
    """
    d, play, long = Drawing(["Corps"]), random.choice([0.02, 0.05, 0.1]), random.uniform(15, 20)
    top, one, other = 8 + long, at(-12.5, 0, 0), at(12.5, 0, 0)
    spots = [at(x, y, top + 12) for x in (-34, 0, 34) for y in (-24, 24)]
    dowels = [at(-38, 0, top - 8), at(38, 0, top - 8)]
    body = box((-45, -31, -6), (45, 31, top)).edges("|Z").fillet(8)
    body = cut(body, *(cyl(p + 8 * Z, Z, 15.1, 50) for p in (one, other)), *(cyl(p, Z, 8, 30) for p in (one, other)))
    body = cut(body, bore((0, 0, 8 + long / 2), Y, 5, 60), *(cyl(p - 26 * Z, Z, 2.5, 30) for p in spots))
    d.add("Corps", cut(body, *(cyl(p, Z, 2.5, 20) for p in dowels)))
    cover = box((-45, -31, top), (45, 31, top + 12)).edges("|Z").fillet(8)
    cover = union(cover, cyl(one + (top + 12) * Z, Z, 16, 10)).cut(bore(one, Z, 8, 90)).cut(cyl(other, Z, 8, top + 9))
    cover = cut(cover, cyl(one + (top + 12) * Z, Z, 10, 20), *(bore(p, Z, 2.75, 20) for p in spots))
    screws = [one + at(0, y, top + 27) for y in (-13, 13)]
    cover = cut(cover, *(cyl(p, Z, 2.5, 16.5) for p in dowels), *(cyl(p - 17 * Z, Z, 1.5, 20) for p in screws))
    fast(d, "Corps", Couvercle=cover)
    for k, p in enumerate(spots):
        fast(d, "Couvercle", **{f"Vis M5x25 {k}": capscrew(p, -Z, 2.5, 25)})
    for k, p in enumerate(dowels):
        fast(d, "Corps", **{f"Goupille {k}": cyl(p, Z, 2.5, 16)})
    for k, p in enumerate((one, other)):
        fast(d, "Corps", **{f"Coussinet bas {k}": tube(p, Z, 6 + play, 8, 8)})
        fast(d, "Couvercle", **{f"Coussinet haut {k}": tube(p + top * Z, Z, 6 + play, 8, 9)})
    drive = union(toothed(10, 9.6, 12.5, 14.9, 8.05, top - 0.05), cyl((0, 0, 0.5), Z, 6, top + 50))
    d.add("Arbre moteur", drive.cut(box((-2, 3.5, top + 35), (2, 9, top + 49))).translate(tuple(one)))
    fast(d, "Arbre moteur", Clavette=box((-2, 3.5, top + 35), (2, 8.5, top + 49)).translate(tuple(one)))
    driven = toothed(10, 9.6, 12.5, 14.9, 8.05, top - 0.05, np.pi / 10 + np.pi).cut(bore((0, 0, 0), Z, 6, 90))
    d.add("Axe mene", cyl(other + 0.5 * Z, Z, 6, top + 8))
    fast(d, "Axe mene", Pignon_mene=driven.translate(tuple(other)))
    fast(d, "Couvercle", Garniture=tube(one + (top + 12) * Z, Z, 6, 10, 6))
    gland = union(cyl(one + (top + 18) * Z, Z, 10, 6), cyl(one + (top + 24) * Z, Z, 17, 3)).cut(bore(one, Z, 6.3, 90))
    fast(d, "Couvercle", Presse_etoupe=cut(gland, *(bore(p, Z, 1.7, 20) for p in screws)))
    for k, p in enumerate(screws):
        fast(d, "Presse etoupe", **{f"Vis M3x16 {k}": capscrew(p, -Z, 1.5, 16)})
    turns(d, ("Coussinet bas 0", "Arbre moteur", one), ("Coussinet bas 1", "Axe mene", other))
    return d


@kind
def worm_gearbox(random: np.random.Generator) -> Drawing:
    """A housing with a worm as a cylinder in ball bearings between caps, a wheel with a throat, keyed to its shaft.

    Truth: worm and output shaft turn in the housing, each one with its inner rings, key, wheel and spacer.
    """
    d, away = Drawing(["Housing"]), random.uniform(38, 42)
    hub = at(0, 0, away)
    house = box((-55, -36, -28), (55, 32, away + 45)).cut(box((-45, -26, -20), (45, 40, away + 37)))
    house = cut(house, bore((0, 0, 0), X, 14, 80), cyl(hub - 33 * Y, Y, 14, 10), cyl(hub - 40 * Y, Y, 9, 20))
    corners = [at(x, 40, z) for x in (-50, 50) for z in (-24, away + 41)]
    house = cut(house, *(cyl(p - 20 * Y, Y, 2, 13) for p in corners))
    cover = box((-55, 32, -28), (55, 40, away + 45)).cut(cyl(hub + 30 * Y, Y, 14, 9))
    cover = cut(cover, *(bore(p, Y, 2.2, 9) for p in corners))
    fast(d, "Housing", Side_cover=cover)
    for k, p in enumerate(corners):
        fast(d, "Side cover", **{f"M4x16 cover {k}": capscrew(p, -Y, 2, 16)})
    key = box((-2.5, -6, away + 4.5), (2.5, 6, away + 10))
    d.add("Output shaft", cut(union(cyl(hub - 75 * Y, Y, 7.5, 113), cyl(hub - 26 * Y, Y, 10, 18)), key))
    wheel = cut(tube(hub - 8 * Y, Y, 7.5, away - 9, 16), bore((0, 0, 0), X, 12, 90), key)
    fast(d, "Output shaft", Parallel_key=key, Worm_wheel=wheel, Spacer=tube(hub + 8 * Y, Y, 7.5, 10, 24))
    for k, y in enumerate((-33, 32)):
        inner, outer = rings(hub + y * Y, Y, 7.5, 14, 7)
        fast(d, "Housing" if k == 0 else "Side cover", **{f"6902 outer {k}": outer})
        fast(d, "Output shaft", **{f"6902 inner {k}": inner})
    fast(d, "Housing", Shaft_seal=tube(hub - 36 * Y, Y, 7.5, 9, 3))
    worm = union(cyl((-20, 0, 0), X, 11.5, 40), cyl((-45, 0, 0), X, 9, 90), cyl((-53, 0, 0), X, 6, 150))
    d.add("Worm shaft", worm.cut(box((70, -2, 3.5), (92, 2, 9))))
    for side, tag in ((-1, "rear"), (1, "front")):
        inner, outer = rings(side * 45 * X, side * X, 6, 14, 8)
        fast(d, "Housing", **{f"6001 outer {tag}": outer})
        fast(d, "Worm shaft", **{f"6001 inner {tag}": inner})
        for n, each in enumerate(balls(side * 45 * X, side * X, 6, 14, 8, 6)):
            d.add(f"6001 ball {n} {tag}", each)
        cap = union(box((side * 55, -20, -20), (side * 61, 20, 20)), cyl(side * 53 * X, side * X, 14, 4))
        cap = cap.cut(cyl(side * 50 * X, side * X, 10, 6)) if side < 0 else cap.cut(bore((60, 0, 0), X, 7, 20))
        spots = [at(side * 61, a * 16, b * 16) for a in (-1, 1) for b in (-1, 1)]
        house = cut(house, *(cyl(p - side * 16 * X, side * X, 1.5, 14) for p in spots))
        fast(d, "Housing", **{f"Cap {tag}": cut(cap, *(bore(p, X, 1.7, 9) for p in spots))})
        for k, p in enumerate(spots[:: 1 if side > 0 else 3]):
            fast(d, f"Cap {tag}", **{f"M3x12 {tag} {k}": capscrew(p, -side * X, 1.5, 12)})
    d.add("Housing", house)
    turns(d, ("Housing", "Worm shaft", at(0, 0, 0), X), ("Housing", "Output shaft", hub, Y))
    return d


@kind
def scroll_chuck(random: np.random.Generator) -> Drawing:
    """A body with three jaws in grooves, a scroll behind them, three pinions under grub screws, a back plate.

    Truth: jaws slide along their grooves, scroll and pinions turn. Seven freedoms.
    """
    d, play, reach = Drawing(["Body"]), random.choice([0.03, 0.08, 0.15]), random.uniform(17, 24)
    body = cut(cyl((0, 0, 0), Z, 60, 50), bore((0, 0, 0), Z, 15, 90), tube((0, 0, -1), Z, 20, 52, 23))
    body = cut(body, *(cyl(ray(t + np.pi / 3, 56, -1), Z, 2.5, 18) for t in THIRDS))
    back = union(cyl((0, 0, -10), Z, 60, 10), tube((0, 0, 0), Z, 20, 32, 11.9)).cut(bore((0, 0, 0), Z, 15, 30))
    fast(d, "Body", Back_plate=cut(back, *(bore(ray(t + np.pi / 3, 56), Z, 2.75, 12) for t in THIRDS)))
    d.add("Scroll", tube((0, 0, 12), Z, 20 + play, 52 - play, 9.9))
    turns(d, ("Body", "Scroll"))
    for number, turn in enumerate(THIRDS, 1):
        out = ray(turn)

        def put(shape: Shape, out=out) -> Shape:
            return laid(shape, (0, 0, 0), out, Z)

        groove = union(box((14, -7, 22), (70, 7, 55)), box((14, -11, 34), (70, 11, 39)))
        pocket = union(cyl((51, 0, 6), X, 5 + play, 12), cyl((55.5, 0, -1), Z, 1.5, 6))
        body = cut(body, put(groove), put(pocket))
        jaw = union(
            box((reach, play - 7, 22.2), (reach + 36, 7 - play, 62)),
            box((reach, play - 11, 34 + play), (reach + 36, 11 - play, 39 - play)),
        )
        jaw = cut(jaw, box((reach + 12, -9, 54), (70, 9, 70)), box((reach + 24, -9, 46), (70, 9, 70)))
        d.add(f"Jaw {number}", put(jaw))
        pinion = union(frustum((40, 0, 6), X, 4.5, 5.6, 11.5), cyl((50, 0, 6), X, 5, 9.5))
        pinion = cut(pinion, tube((54, 0, 6), X, 3.8, 6, 3), box((54, -2.5, 3.5), (62, 2.5, 8.5)))
        d.add(f"Pinion {number}", put(pinion))
        fast(d, "Body", **{f"Grub M3 {number}": put(cyl((55.5, 0, 0), Z, 1.5, 2.1))})
        fast(d, "Back plate", **{f"M5x22 {number}": capscrew(ray(turn + np.pi / 3, 56, -10), Z, 2.5, 22)})
        d.joint("Prismatic", "Body", f"Jaw {number}", (0, 0, 36), out)
        turns(d, ("Body", f"Pinion {number}", at(0, 0, 6), out))
    d.add("Body", body)
    return d
