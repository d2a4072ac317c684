"""What stands on desks of an office: a stapler, a punch for two holes, the two hinges of a laptop."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, headed, hexagon, rivet, screw, torus, tube, union


def compound(*shapes: Shape) -> Shape:
    """A part of several solids."""
    first, *others = shapes
    for each in others:
        first = first.add(each)
    return first


@kind
def stapler(random):
    """An arm and a magazine on one hinge pin in the base, a pusher on a rod in the magazine, an anvil that turns."""
    drawing, play = Drawing(["base"]), random.choice([0.05, 0.1, 0.2])
    hinge, pivot, where = at(0, 0, 14), at(110, 0, 0), random.uniform(50, 65)
    base = union(box((-12, -17, 0), (125, 17, 3)), *(box((-10, s * 12, 2), (12, s * 15, 22)) for s in (1, -1)))
    drawing.add("base", cut(base, bore(hinge, Y, 2), bore(pivot, Z, 2.5)))
    for name, x in (("rear", 5), ("front", 80)):
        drawing.add(f"{name} foot", box((x - 10, -15, -3), (x + 10, 15, 0)))
    anvil = tube(pivot + 3 * Z, Z, 2.5 + play, 9, 1.2).faces(">Z").edges().chamfer(0.2)
    drawing.add(
        "anvil", cut(anvil, *(box(pivot + at(x - 0.8, -6.5, 3.7), pivot + at(x + 0.8, 6.5, 5)) for x in (-6, 6)))
    )
    drawing.add("anvil rivet", rivet(pivot, Z, 2.5, 4.25))
    rod = at(0, 0, 17.6)
    magazine = cut(box((-8, -6.5, 8), (118, 6.5, 20)), box((-4, -5.5, 9), (115, 5.5, 21)))
    drawing.add("magazine", cut(magazine, bore(hinge, Y, 2 + play), bore(rod, X, 1.19)))
    drawing.add("pusher rod", headed(rod - 8 * X, X, 1.2, 126))
    pusher = box((where, -5.4, 9.1), (where + 10, 5.4, 19.6))
    drawing.add("pusher", cut(pusher, bore(rod, X, 1.3)))
    staples = box((where + 10, -5.3, 9), (114.8, 5.3, 15))
    drawing.add("staples", cut(staples, box((0, -4.8, 8), (120, 4.8, 14.5))))
    screws, tip = [at(25, 0, 31), at(95, 0, 31)], at(122, 0, 21)
    arm = cut(box((-10, -9, 10), (122, 9, 27)), box((-11, -7, 9), (120, 7, 25)))
    arm = cut(arm, bore(hinge, Y, 2 + play), *(bore(p, Z, 1.5, 8) for p in screws), bore(tip, X, 1.6, 5))
    drawing.add("arm", arm)
    driver = box((118.5, -5, 12), (120, 5, 25))
    drawing.add("driver", cut(driver, bore(tip, X, 1.5, 5)))
    drawing.add("driver screw", screw(tip, -X, 1.5, 3.5))
    cap = box((-10, -11, 27), (124, 11, 31)).edges("|X and >Z").fillet(2)
    drawing.add("cap", cut(cap, *(bore(p, Z, 1.6, 5) for p in screws)))
    for number, p in enumerate(screws):
        drawing.add(f"cap screw {number}", screw(p, -Z, 1.5, 6))
    for name, y in (("left", 9), ("right", -12)):
        drawing.add(f"{name} hinge washer", tube(hinge + y * Y, Y, 2.1, 4.5, 3 - 0.05 * (y > 0)))
    drawing.add("hinge pin", rivet(hinge - 15 * Y, Y, 2, 30))
    drawing.joint("Revolute", "arm", "base", hinge, Y)
    drawing.joint("Revolute", "magazine", "base", hinge, Y)
    drawing.joint("Revolute", "anvil", "base", pivot, Z)
    drawing.joint("Weld", "pusher rod", "magazine")
    drawing.joint("Prismatic", "pusher", "magazine", rod, X)
    drawing.joint("Weld", "driver", "arm")
    drawing.joint("Weld", "cap", "arm")
    return drawing


@kind
def paper_punch(random):
    """A lever on an axle with clips, two punches with springs in brackets on a base, a paper gauge in its guide."""
    drawing, play = Drawing(["base"]), random.choice([0.05, 0.1])
    apart, drawn = random.uniform(38, 42), random.uniform(0, 25)
    sides = (("left", -apart), ("right", apart))
    pins = {name: [at(x - 6, 18, 0), at(x + 6, 18, 0)] for name, x in sides}
    clip = [at(62, y, 0) for y in (27, 41)]
    base = box((-70, -35, 0), (70, 45, 4))
    feet = [p for each in pins.values() for p in each]
    bores = [bore(at(x, 0, 0), Z, 3.2) for _, x in sides]
    drawing.add("base", cut(base, *bores, *(bore(p, Z, 1.6) for p in feet), *(bore(p, Z, 1.2) for p in clip)))
    tray = cut(box((-72, -37, -12), (72, 47, 3.5)), box((-70.1, -35.1, 0), (70.1, 45.1, 5)))
    drawing.add("tray", cut(tray, box((-66, -31, -10), (66, 41, 1))))
    axle = at(0, 20, 34)
    for name, x in sides:
        bracket = cut(box((x - 9, -8, 4), (x + 9, 12, 34)), box((x - 10, -9, 6), (x + 10, 6, 8)))
        bracket = union(bracket, box((x - 9, 11, 4), (x + 9, 26, 40)))
        bracket = cut(bracket, bore(at(x, 0, 0), Z, 3 + play), bore(axle, X, 2.5 + play))
        drawing.add(f"{name} bracket", cut(bracket, *(cyl(p, Z, 1.5, 18) for p in pins[name])))
        drawing.add(f"{name} punch", union(cyl((x, 0, 9), Z, 3, 36), cyl((x, 0, 44), Z, 5, 3)))
        drawing.add(f"{name} spring", compound(*(torus((x, 0, z), Z, 4, 0.8) for z in (34.8, 37.5, 40.3, 43.2))))
        for number, p in enumerate(pins[name]):
            drawing.add(f"{name} bracket screw {number}", screw(p, Z, 1.5, 16))
        out = X * np.sign(x)
        groove = tube(axle + 54.6 * out, out, 2, 4.5, 0.9)
        drawing.add(f"{name} clip", cut(groove, box(axle + 50 * out - at(0, 1.2, 0), axle + at(0, 1.2, 9) + 60 * out)))
    lever = union(box((-54, -50, 47), (54, 26, 49)), *(box((s * 52, 10, 28), (s * 54.5, 26, 48)) for s in (1, -1)))
    pegs = [at(x, -40, 0) for x in (-35, 35)]
    drawing.add("lever", cut(lever, bore(axle, X, 2.5), *(bore(p, Z, 2) for p in pegs)))
    grooves = [tube(axle + s * 54.6 * X, s * X, 2, 3, 1) for s in (1, -1)]
    drawing.add("axle", cut(cyl(axle - 57 * X, X, 2.5, 114), *grooves))
    drawing.add("grip", union(box((-54, -52, 49), (54, -28, 54)), *(cyl(p + 46 * Z, Z, 2, 4) for p in pegs)))
    guide = cut(box((56, 24, 4), (68, 44, 8)), box((55, 29.9, 3), (69, 38.1, 6.1)))
    drawing.add("gauge guide", cut(guide, *(bore(p, Z, 1.3) for p in clip)))
    for number, p in enumerate(clip):
        drawing.add(f"guide screw {number}", screw(p + 8 * Z, -Z, 1.2, 8))
    gauge = union(box((20 + drawn, 30, 4), (110 + drawn, 38, 6)), box((108 + drawn, 10, 4), (110 + drawn, 38, 14)))
    drawing.add("gauge", gauge)
    for name, x in sides:
        drawing.joint("Weld", f"{name} bracket", "base")
        drawing.joint("Cylindrical", f"{name} punch", f"{name} bracket", at(x, 0, 0), Z)
    drawing.joint("Revolute", "lever", "left bracket", axle, X)
    drawing.joint("Weld", "grip", "lever")
    drawing.joint("Weld", "gauge guide", "base")
    drawing.joint("Prismatic", "gauge", "base", 0 * X, X)
    return drawing


def flats(point, axis, half: float, long: float) -> list[Shape]:
    """What is cut away above and below a shaft that lies horizontally, to make two flats."""
    start, end = np.asarray(point, float), np.asarray(point, float) + long * np.asarray(axis, float)
    side = at(0, 9, 9)
    return [box(start + s * half * Z - s * at(0, 9, 0), end + s * half * Z + s * side) for s in (1, -1)]


@kind
def laptop_hinge(random):
    """A case with a cover, a lid on two friction hinges: shafts with flats, disc springs, nuts, brackets on bosses."""
    drawing, lean = Drawing(["case"]), float(random.uniform(5, 35))
    axis, place = at(0, 95, 12), random.uniform(95, 115)
    corners = [at(x, y, 0) for x in (-142, 142) for y in (-92, 74)]
    case = cut(box((-150, -100, 0), (150, 82, 12)), box((-147, -97, -1), (147, 79, 10)))
    lid = box((-150, 99, 18), (150, 103, 200)).edges("|Y and >Z").fillet(8)
    bosses, holes, wells = [cyl(p, Z, 4, 11) for p in corners], [cyl(p, Z, 1.2, 8) for p in corners], []

    def leaned(shape: Shape) -> Shape:
        """A shape of the lid, that was drawn upright."""
        return shape.rotate(tuple(axis.tolist()), tuple((axis + X).tolist()), -lean)

    for name, s in (("left", -1), ("right", 1)):
        u, hub = s * X, axis + s * place * X
        ear = union(
            box(hub + at(-14, -39, -7.2), hub + at(14, -5, -6)),
            box(hub + at(0, -11, -7.2), hub + 1.2 * u + at(0, 4, 7)),
        )
        feet = [hub + at(x, -27, -7.2) for x in (-9, 9)]
        bosses += [cyl(p + 1.2 * Z, Z, 3, 5) for p in feet]
        holes += [cyl(p, Z, 1, 5) for p in feet] + [box(hub + at(-15, -18, -13), hub + at(15, -12, -3))]
        drawing.add(f"{name} bracket", cut(ear, bore(hub, X, 2.55, 20), *(bore(p, Z, 1.2, 5) for p in feet)))
        for number, p in enumerate(feet):
            drawing.add(f"{name} bracket screw {number}", screw(p, Z, 1, 4.5))
        stub, end = cut(cyl(hub, u, 2.5, 10), *flats(hub, u, 1.8, 10)), hub - 11.5 * u
        neck = cut(cyl(end, u, 3, 2), *flats(end, u, 2.4, 1.5))
        shaft = union(stub, cyl(hub - 10 * u, u, 4, 10), neck, cyl(end - u, u, 4, 1))
        drawing.add(f"{name} shaft", leaned(shaft))
        washer = cut(cyl(hub + 1.2 * u, u, 5, 1), cut(cyl(hub, u, 2.5, 4), *flats(hub, u, 1.8, 4)))
        drawing.add(f"{name} friction washer", leaned(washer))
        for number in range(2):
            drawing.add(f"{name} disc spring {number}", tube(hub + (2.2 + 0.8 * number) * u, u, 2.6, 5, 0.8))
        drawing.add(f"{name} nut", hexagon(hub + 3.8 * u, u, 4, 3, 2.5))
        plate = union(
            box(end + at(0, -4, -4), end + 1.5 * u + at(0, 4, 50)),
            box(end + at(0, 2.5, 13), end - 24 * u + at(0, 4, 50)),
        )
        own = [end - 14 * u + at(0, 2.5, z) for z in (22, 40)]
        wells += [cyl(p, Y, 1, 4.5) for p in own]
        plate = cut(plate, cut(cyl(end, u, 3, 1.5), *flats(end, u, 2.4, 1.5)), *(bore(p, Y, 1.1, 4) for p in own))
        drawing.add(f"{name} lid bracket", leaned(plate))
        for number, p in enumerate(own):
            drawing.add(f"{name} lid screw {number}", leaned(screw(p, Y, 1, 4)))
    drawing.add("case", cut(union(case, *bosses), *holes))
    drawing.add("lid", leaned(cut(lid, *wells)))
    drawing.add("cover", cut(box((-150, -100, -2), (150, 82, 0)), *(bore(p, Z, 1.4) for p in corners)))
    for number, p in enumerate(corners):
        drawing.add(f"cover screw {number}", screw(p - 2 * Z, Z, 1.2, 8))
    drawing.joint("Weld", "cover", "case")
    for name in ("left", "right"):
        drawing.joint("Weld", f"{name} bracket", "case")
        drawing.joint("Weld", f"{name} friction washer", f"{name} shaft")
        drawing.joint("Weld", f"{name} shaft", f"{name} lid bracket")
        drawing.joint("Weld", f"{name} lid bracket", "lid")
    drawing.joint("Revolute", "lid", "case", axis, X)
    return drawing
