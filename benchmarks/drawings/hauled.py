"""An axle of a model crawler, a hull with bogies for tracks, an orange-peel grapple, a base on omni wheels."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import capscrew, nut, ram, strut, upright, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, headed, hexagon, laid, sphere, tube, union


def pivot_ball(p) -> Shape:
    """The ball of a small rod end, flat on both sides, with its hole along y."""
    p = np.asarray(p, float)
    return sphere(p, 3.5).intersect(box(p - at(9, 2.8, 9), p + at(9, 2.8, 9))).cut(bore(p, Y, 1.5, 9))


@kind
def crawler_axle(random: np.random.Generator) -> Drawing:
    """An axle with hexes, wheels and tyres, on four links with rod ends and two shocks, chassis plates on tubes.

    Truth: links and shocks swivel on their balls, wheels turn with their shafts, the pinion in its bearing.
    """
    d, play, drop = Drawing(["Chassis plate L"]), random.choice([0.0, 0.05, 0.1]), random.uniform(-6, 6)
    housing = union(cyl(-90 * Y, Y, 14, 180), sphere((0, 0, 0), 26), cyl((0, 0, 0), X, 15, 45))
    housing = cut(housing, sphere((0, 0, 0), 21), bore((0, 0, 0), Y, 6.5, 95), cyl((0, 0, 0), X, 6.5, 60))
    housing = cut(housing, cyl((38, 0, 0), X, 10, 9))
    shape = upright([(-20, 118), (160, 104), (215, 85), (175, 62)], -2, 2, 10)
    plates = {"L": shape.translate((0, 40, 0)), "R": shape.translate((0, -40, 0))}
    for k, (x, z) in enumerate(((60, 109), (190, 80))):
        fast(d, "Chassis plate L", **{f"Cross tube {k}": tube((x, -38, z), Y, 1.5, 4, 76)})
        for side, tag in ((1, "L"), (-1, "R")):
            p = at(x, side * 42, z)
            plates[tag] = plates[tag].cut(bore(p, Y, 1.6, 9))
            fast(d, f"Cross tube {k}", **{f"M3x10 {tag}{k}": capscrew(p, -side * Y, 1.5, 10)})
    weld(d, "Chassis plate R", "Cross tube 0", "Cross tube 1")
    for side, tag in ((1, "L"), (-1, "R")):

        def lug(p, low: float, high: float, side=side) -> Shape:
            """An ear on the tube of the axle."""
            one, other = sorted((side * low, side * high))
            return upright([p[::2], (0, 0)], one, other, 4).cut(cyl((0, -95, 0), Y, 13, 190)).cut(bore(p, Y, 1.5, 90))

        ends = {
            "lower": (at(10, side * 28, -18), at(172, side * 35.2, 66 + drop)),
            "upper": (at(-4, side * 22, 32), at(158, side * 35.2, 98 + drop)),
            "shock": (at(-24, side * 52.5, 8), at(-20, side * 52.5, 118)),
        }
        for word, (one, other) in ends.items():
            away = 1 if word != "shock" else -1
            low = abs(one[1]) + 2.8
            housing = housing.union(lug(one, low, low + 4))
            if word == "shock":
                plates[tag] = plates[tag].union(cyl(at(other[0], side * 42, other[2]), side * Y, 4, 7.7))
            plates[tag] = plates[tag].cut(bore(other, Y, 1.5, 20))
            for place, p, host, depth in (
                ("axle", one, "Axle housing", 4),
                ("frame", other, f"Chassis plate {tag}", 4 if away > 0 else 12),
            ):
                out = side * Y if place == "axle" else side * away * Y
                fast(d, host, **{f"{word} ball {place} {tag}": pivot_ball(p)})
                start = p - 2.8 * out
                fast(d, host, **{f"{word} screw {place} {tag}": capscrew(start, out, 1.5, 5.6 + depth + 2)})
            along = (other - one) / np.linalg.norm(other - one)

            def socket(p, way) -> Shape:
                """A rod end with its neck."""
                eye = union(cyl(p - 2.5 * Y, Y, 6, 5), strut(p + 4.5 * way, p + 12 * way, 2.5))
                return eye.cut(sphere(p, 3.5 + play))

            if word == "shock":
                body = union(socket(other, -along), strut(other - 11 * along, other - 58 * along, 6.5))
                body = body.union(strut(other - 12 * along, other - 16 * along, 9.5))
                body = cut(body, strut(other - 56 * along, other - 17 * along, 5), strut(one, other - 50 * along, 1.75))
                shaft = union(socket(one, along), strut(one + 11 * along, other - 40 * along, 1.75))
                shaft = union(shaft, strut(one + 11 * along, one + 15 * along, 9.5))
                shaft = union(shaft, strut(other - 42 * along, other - 38 * along, 4.95))
                d.add(f"Shock body {tag}", body)
                d.add(f"Shock shaft {tag}", shaft)
                spring = strut(one + 15 * along, other - 16 * along, 9).cut(strut(one, other, 7.5))
                d.add(f"Shock spring {tag}", spring)
                d.joint("Cylindrical", f"Shock body {tag}", f"Shock shaft {tag}", one, along)
                names = (f"Shock shaft {tag}", f"Shock body {tag}")
            else:
                link = union(socket(one, along), socket(other, -along))
                d.add(f"{word} link {tag}", link.union(strut(one + 11 * along, other - 11 * along, 3)))
                names = (f"{word} link {tag}",) * 2
            d.joint("Spherical", f"{word} ball axle {tag}", names[0], one)
            d.joint("Spherical", f"{word} ball frame {tag}", names[1], other)
        housing = housing.cut(cyl(side * 84 * Y, side * Y, 10, 9))
        d.add(f"Bearing {tag}", tube(side * 84 * Y, side * Y, 5, 10, 6))
        shaft = union(cyl(side * 14 * Y, side * Y, 5, 92), cyl(side * 106 * Y, side * Y, 4, 20))
        d.add(f"Axle shaft {tag}", shaft.cut(bore(side * 97 * Y, X, 1, 9)))
        cross = cyl(at(-6, side * 97, 0), X, 1, 12)
        wheel_hex = hexagon(side * 93 * Y, side * Y, 6.5, 7, 5).cut(cross)
        rim = union(tube(side * 96 * Y, side * Y, 36, 40, 40), cyl(side * 96 * Y, side * Y, 40, 10))
        rim = cut(rim, hexagon(side * 90 * Y, side * Y, 6.5 + play, 10), bore((0, 0, 0), Y, 5))
        fast(d, f"Axle shaft {tag}", **{f"Drive pin {tag}": cross, f"Hex {tag}": wheel_hex, f"Rim {tag}": rim})
        fast(d, f"Rim {tag}", **{f"Tyre {tag}": tube(side * 94 * Y, side * Y, 40, 55, 44)})
        fast(d, f"Axle shaft {tag}", **{f"Wheel nut {tag}": nut(side * 106 * Y, side * Y, 4)})
        turns(d, ("Axle housing", f"Axle shaft {tag}", at(0, 0, 0), Y))
    d.add("Axle housing", housing)
    d.add("Pinion", union(cyl((22, 0, 0), X, 5, 50), cyl((20, 0, 0), X, 6, 18)))
    d.add("Pinion bearing", tube((38, 0, 0), X, 5, 10, 6))
    turns(d, ("Axle housing", "Pinion", at(0, 0, 0), X))
    for tag, each in plates.items():
        d.add(f"Chassis plate {tag}", each)
    return d


@kind
def tracked_bogies(random: np.random.Generator) -> Drawing:
    """A hull with bogie arms on bolts with nuts, wheels on shoulder bolts, sprockets under set screws, idler blocks.

    Truth: arms turn on their bolts in the hull, wheels on those of the arms, sprockets on the motors. Sixteen freedoms.
    """
    d, play, reach = Drawing(["Hull"]), random.choice([0.05, 0.1, 0.3]), random.uniform(26, 32)
    hull = union(box((-170, -60, 0), (170, 60, 4)), *(box((-170, s * 56, 0), (170, s * 60, 60)) for s in (-1, 1)))
    for side, tag in ((1, "L"), (-1, "R")):

        def tooth(middle, radius: float, low: float, high: float, hole: float, side=side) -> Shape:
            """A disc about y between two distances from the middle of the hull."""
            return tube(middle + side * low * Y, side * Y, hole, radius, high - low)

        for place, x in (("front", 62), ("rear", -62)):
            p, name = at(x, 0, 14), f"{place} {tag}"
            hull = hull.cut(bore(p + side * 58 * Y, Y, 4, 6))
            one, other = (at(x + s * reach, 0, -18) for s in (-1, 1))
            arm = upright([one[::2], p[::2], other[::2]], *sorted((side * 64, side * 72)), 9)
            arm = union(arm, tooth(p, 12, 62, 64, 4)).cut(bore(p, Y, 4 + play))
            d.add(f"Bogie {name}", cut(arm, *(bore(q, Y, 2.5) for q in (one, other))))
            stud = union(cyl(p + side * 72.4 * Y, -side * Y, 4, 26), hexagon(p + side * 72.4 * Y, side * Y, 6.5, 5))
            fast(d, "Hull", **{f"M8 bolt {name}": stud})
            fast(d, f"M8 bolt {name}", **{f"M8 nut {name}": nut(p + side * 56 * Y, -side * Y, 4)})
            fast(d, f"M8 bolt {name}", **{f"Washer {name}": tooth(p, 8, 60, 62, 4.3)})
            for k, q in enumerate((one, other)):
                wheel = tooth(q, 20, 73, 91, 3 + play).cut(tooth(q, 16, 83, 92, 3))
                d.add(f"Road wheel {name} {k}", wheel)
                screw = union(cyl(q + side * 72 * Y, side * Y, 3, 11.4), cyl(q + side * 72 * Y, -side * Y, 2.5, 8))
                screw = screw.union(cyl(q + side * 83.4 * Y, side * Y, 5, 4))
                fast(d, f"Bogie {name}", **{f"Shoulder bolt {name} {k}": screw})
                turns(d, (f"Bogie {name}", f"Road wheel {name} {k}", q, Y))
            turns(d, ("Hull", f"Bogie {name}", p, Y))
        spin, idle = at(145, 0, 32), at(-145 + random.uniform(-5, 5), 0, 32)
        hull = hull.cut(bore(spin + side * 58 * Y, Y, 8, 9))
        motor = box(spin + at(-20, side * 56, -20), spin + at(20, side * 10, 20))
        motor = union(motor, cyl(spin + side * 56 * Y, side * Y, 8, 5), cyl(spin + side * 61 * Y, side * Y, 4, 26))
        spots = [spin + at(a * 14, side * 60, b * 14) for a, b in ((1, 1), (-1, -1))]
        fast(d, "Hull", **{f"Gearmotor {tag}": cut(motor, *(cyl(p, -side * Y, 1.5, 15) for p in spots))})
        for k, p in enumerate(spots):
            hull = hull.cut(bore(p, Y, 1.7, 6))
            fast(d, "Hull", **{f"M3 {tag}{k}": capscrew(p, -side * Y, 1.5, 10)})
        sprocket = union(tooth(spin, 30, 78, 86, 4), tooth(spin, 12, 68, 86, 4))
        for a in 2 * np.pi * np.arange(9) / 9:
            sprocket = sprocket.cut(bore(spin + 31 * at(np.cos(a), 0, np.sin(a)), Y, 5))
        d.add(f"Sprocket {tag}", sprocket.cut(cyl(spin + at(0, side * 73, 4), Z, 2, 9)))
        fast(d, f"Sprocket {tag}", **{f"Set screw {tag}": cyl(spin + at(0, side * 73, 4), Z, 2, 6)})
        turns(d, (f"Gearmotor {tag}", f"Sprocket {tag}", spin, Y))
        block = box(idle + at(-20, side * 60, -9), idle + at(24, side * 72, 9))
        block = cut(block, bore(idle, Y, 4), box(idle + at(9, side * 50, -2.7), idle + at(19, side * 80, 2.7)))
        fast(d, "Hull", **{f"Idler block {tag}": block})
        hull = hull.cut(bore(idle + at(14, side * 58, 0), Y, 2.5, 6))
        clamp = capscrew(idle + at(14, side * 72, 0), -side * Y, 2.5, 20)
        fast(d, f"Idler block {tag}", **{f"M5 {tag}": clamp})
        axle = union(cyl(idle + side * 62 * Y, side * Y, 4, 29), cyl(idle + side * 91 * Y, side * Y, 7, 3))
        fast(d, f"Idler block {tag}", **{f"Idler axle {tag}": axle})
        idler = union(tooth(idle, 26, 78, 90.6, 4 + play), tooth(idle, 8, 74, 78, 4 + play))
        d.add(f"Idler {tag}", idler)
        turns(d, (f"Idler block {tag}", f"Idler {tag}", idle, Y))
    d.add("Hull", hull)
    return d


@kind
def orange_peel_grapple(random: np.random.Generator) -> Drawing:
    """A rotor in a housing, a hub bolted to it with lugs, four tines of two plates and four rams, pins with rings.

    Truth: the rotor turns, tines turn on their pins in the hub, rams on theirs, rods slide. Five freedoms.
    """
    d, play = Drawing(["Rotator"]), random.choice([0.1, 0.2, 0.3])
    root, foot = at(70, 0, 0), at(66, 0, 150)
    head, knee, tip = at(128, 0, random.uniform(5, 20)), at(150, 0, -60), at(random.uniform(80, 110), 0, -170)
    hub = cyl((0, 0, -20), Z, 45, 190)
    hub = hub.cut(cyl((0, 0, -30), Z, 36, 190))
    spots = [at(26 * np.cos(a), 26 * np.sin(a), 160) for a in np.pi / 4 + np.arange(4) * np.pi / 2]
    hub = cut(hub, *(bore(p, Z, 4.2, 12) for p in spots))
    rotor = union(cyl((0, 0, 170), Z, 40, 12), cyl((0, 0, 182), Z, 20, 56))
    rotor = cut(rotor, tube((0, 0, 230), Z, 17, 25, 3), *(cyl(p + 5 * Z, Z, 4, 15) for p in spots))
    d.add("Rotor", rotor)
    stator = cut(box((-45, -45, 183), (45, 45, 250)), cyl((0, 0, 180), Z, 20 + play, 62))
    stator = stator.cut(tube((0, 0, 229.9), Z, 17, 24, 12.1))
    d.add("Rotator", union(stator, upright([(0, 250), (0, 285)], -8, 8, 16).cut(cyl((0, 0, 200), Z, 30, 50))))
    fast(d, "Rotor", Snap_ring=tube((0, 0, 230.1), Z, 17, 23, 2.8))
    fast(d, "Rotor", Hub=hub)
    for k, p in enumerate(spots):
        fast(d, "Hub", **{f"M8x25 {k}": capscrew(p, Z, 4, 19)})
    turns(d, ("Rotator", "Rotor"))
    for number, angle in enumerate(np.arange(4) * np.pi / 2, 1):
        out = at(np.cos(angle), np.sin(angle), 0)

        def put(shape: Shape, out=out) -> Shape:
            return laid(shape, (0, 0, 0), out, Z)

        def spot(p, out=out) -> np.ndarray:
            return p[0] * out + p[2] * Z

        def name(what: str, number=number) -> str:
            return f"{what} {number}"

        for side in (-1, 1):
            for p, low, half, hole in ((root, 19, 16, 8), (foot, 10, 13, 6)):
                ear = upright([p[::2], (44, p[2])], *sorted((side * low, side * (low + 9))), half)
                hub = hub.union(put(cut(ear, bore(p, Y, hole), cyl((0, 0, -30), Z, 40, 260))))
        sides = [
            union(upright([a[::2], b[::2]], *sorted((s * 10, s * 18)), 14), upright([b[::2], c[::2]], -10, 10, 5))
            for s in (-1, 1)
            for a, b, c in ((root, head, knee), (head, knee, tip), (knee, tip, tip - 8 * X))
        ]
        slim = box(head + at(-24, -9.9, -17), head + at(24, 9.9, 60)).union(cyl(head - 9.9 * Y, Y, 18, 19.8))
        tine = union(*sides, cyl(root - 18 * Y, Y, 15, 36)).cut(slim)
        d.add(name("Tine"), put(cut(tine, bore(root, Y, 10.5), bore(head, Y, 6))))
        fast(d, name("Tine"), **{name("Bush"): put(tube(root - 18 * Y, Y, 8 + play, 10.5, 36))})
        barrel, rod = ram(foot, head, Y, 7.5, 5, 6 + play, 19, 0.42 * float(np.linalg.norm(head - foot)))
        d.add(name("Barrel"), put(barrel))
        d.add(name("Rod"), put(rod))
        for word, p, half, radius, host in (
            ("root", root, 28, 8, "Hub"),
            ("foot", foot, 19, 6, "Hub"),
            ("head", head, 18, 6, name("Tine")),
        ):
            fast(d, host, **{name(f"Pin {word}"): put(headed(p - half * Y, Y, radius, 2 * half + 3))})
            ring = tube(p + half * Y, Y, radius, 1.5 * radius, 1.5)
            fast(d, name(f"Pin {word}"), **{name(f"Ring {word}"): put(ring)})
        side = np.cross(Z, out)
        turns(d, ("Hub", name("Tine"), spot(root), side), ("Hub", name("Barrel"), spot(foot), side))
        turns(d, (name("Rod"), name("Tine"), spot(head), side))
        d.joint("Cylindrical", name("Barrel"), name("Rod"), spot(foot), spot(head) - spot(foot))
    d.parts["Hub"] = hub
    return d


@kind
def omni_wheel_base(random: np.random.Generator) -> Drawing:
    """Three gearmotors with the shaft beside the middle, brackets, hubs under grub screws, wheels with small rollers.

    Truth: each hub, one with its wheel, turns on its motor, each roller on its pin in the wheel. Eighteen freedoms.
    """
    d, play, deep = Drawing(["Deck"]), random.choice([0.05, 0.1, 0.2]), random.uniform(23, 27)
    d.add("Deck", hexagon((0, 0, 0), Z, 112, 4))
    for number, turn in enumerate(2 * np.pi * np.arange(3) / 3 + 0.2, 1):
        ray = at(np.cos(turn), np.sin(turn), 0)

        def put(shape: Shape, ray=ray) -> Shape:
            return laid(shape, (0, 0, 0), ray, Z)

        def name(what: str, number=number) -> str:
            return f"{what} {number}"

        middle, spin = at(0, 0, -deep), at(0, 0, -deep - 7)
        face = [middle + at(105, 15.5 * np.cos(a), 15.5 * np.sin(a)) for a in (0, np.pi)]
        motor = union(cyl(middle + 38 * X, X, 18.5, 67), cyl(spin + 105 * X, X, 6, 5), cyl(spin + 105 * X, X, 3, 20))
        motor = cut(motor, *(cyl(p - 6 * X, X, 1.5, 7) for p in face), cyl(spin + 114 * X, X, 1.5, 12))
        bracket = union(box((105, -22, -50), (108, 22, 0)), box((75, -22, -3), (108, 22, 0)))
        bracket = cut(bracket, bore(spin + 105 * X, X, 6.2, 20), *(bore(p, X, 1.7, 6) for p in face))
        fast(d, "Deck", **{name("Bracket"): put(bracket)})
        fast(d, name("Bracket"), **{name("Gearmotor 37D"): put(motor)})
        for k, p in enumerate(face):
            fast(d, name("Bracket"), **{name(f"M3x8 {'ab'[k]}"): put(capscrew(p + 3 * X, -X, 1.5, 8))})
        hub = union(cyl(spin + 112 * X, X, 10, 12), cyl(spin + 124 * X, X, 6, 4))
        hub = cut(hub, bore(spin, X, 3, 200), cyl(spin + at(117, 3, 0), Y, 1.5, 9))
        d.add(name("Hub"), put(hub))
        fast(d, name("Hub"), **{name("Grub"): put(cyl(spin + at(117, 3, 0), Y, 1.5, 5))})
        wheel = cyl(spin + 124 * X, X, 27, 12).cut(cyl(spin + 123 * X, X, 6, 5)).cut(bore(spin, X, 1.6, 200))
        for k, a in enumerate(2 * np.pi * np.arange(5) / 5 + 0.3):
            out, side = at(0, np.cos(a), np.sin(a)), at(0, -np.sin(a), np.cos(a))
            p = spin + 130 * X + 24 * out
            wheel = cut(wheel, laid(box((-7, -9, -5.2), (7, 9, 5.2)), p, out, side), cyl(p - 9 * side, side, 1.5, 18))
            fast(d, name("Wheel"), **{name(f"Roller pin {k}"): put(cyl(p - 8.5 * side, side, 1.5, 17))})
            d.add(name(f"Roller {k}"), put(tube(p - 5 * side, side, 1.5 + play, 6, 10)))
            pivot = put(cyl(p - side, side, 1, 2)).val().Center()
            axis = np.cross(Z, ray) * side[1] + Z * side[2]
            turns(d, (name("Wheel"), name(f"Roller {k}"), at(pivot.x, pivot.y, pivot.z), axis))
        fast(d, name("Hub"), **{name("Wheel"): put(wheel)})
        fast(d, name("Wheel"), **{name("M3x18"): put(capscrew(spin + 136 * X, -X, 1.5, 18))})
        turns(d, (name("Gearmotor 37D"), name("Hub"), spin, ray))
    return d
