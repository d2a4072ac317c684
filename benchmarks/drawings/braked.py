"""A brake of a car's drum and a shaper with a quick return."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.mown import fix, flat, prism, screws
from drawings.powered import grooved
from drawings.shapes import (
    Shape,
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
    screw,
    tube,
    union,
)


def sector(inner: float, outer: float, low: float, high: float, turns) -> Shape:
    """A piece of a ring about z between two angles."""
    points = [(0.0, 0.0), *((400 * np.cos(t), 400 * np.sin(t)) for t in np.radians(np.linspace(*turns, 5)))]
    return tube(low * Z, Z, inner, outer, high - low).intersect(prism(points, low * Z, X, Z, high - low))


@kind
def drum_brake(random):
    """Two lined shoes on anchor pins, a wheel cylinder, cams, hold-down pins, a lever; a drum in two bearings."""
    drawing, play, r = Drawing(["back plate"]), random.choice([0.05, 0.15]), random.uniform(99, 102)
    anchors, corners = {s: at(s * 20, -78, 0) for s in (-1, 1)}, hollow(0 * X, Z, 26, 4, np.pi / 4)
    ties, pins = [at(x, 80, 0) for x in (-12, 12)], {s: at(s * 82, 0, 0) for s in (-1, 1)}
    plate = union(
        cyl(0 * Z, Z, r + 16, 4), *(cyl(p, Z, 12, 17.8) for p in anchors.values()), box((-22, 66, 0), (22, 96, 8.5))
    )
    holes = (
        [bore(p, Z, 2.2) for p in pins.values()] + [bore(p, Z, 4.2) for p in corners] + [bore(p, Z, 2.6) for p in ties]
    )
    plate = cut(plate, bore(0 * X, Z, 17), *holes, *(bore(p, Z, 6) for p in anchors.values()))
    drawing.add("back plate", cut(plate, *(bore(at(s * 46.1, 33.3, 0), Z, 5) for s in (-1, 1))))
    body = union(cyl((-23, 80, 20.5), X, 12, 46), box((-20, 70, 8.5), (20, 90, 16)))
    body = cut(body, bore((0, 80, 20.5), X, 8), *(cyl(p, Z, 2.5, 12) for p in ties), cyl((0, 80, 20.5), Y, 3, 20))
    fix(drawing, "back plate", "cylinder", body)
    screws(drawing, "cylinder", "cylinder screw", ties, Z, 2.5, 12)
    fix(drawing, "cylinder", "bleeder", union(cyl((0, 88.2, 20.5), Y, 3, 5), hexagon((0, 92, 20.5), Y, 4, 4)))
    for s, name in ((1, "rear"), (-1, "front")):
        turns, p, eye = sorted((90 - s * 20, 90 - s * 150)), pins[s], anchors[s]
        web = union(sector(66, r - 6, 18, 23, turns), bar(eye, at(s * 60, -47, 0), 13, 18, 23))
        web = cut(
            web,
            box((s * 30, 60, 0), (-s * 40, 120, 40)),
            bore(eye, Z, 6 + play),
            bore(p, Z, 4),
            bore((s * 68, 30, 0), Z, 4),
        )
        shoe = union(web, sector(r - 7, r - 4, 6, 36, turns))
        drawing.add(f"{name} shoe", shoe.cut(box((s * 30, 60, 0), (-s * 40, 120, 40))))
        fix(drawing, f"{name} shoe", f"{name} lining", sector(r - 4, r - 0.3, 6, 36, (turns[0] + 9, turns[1] - 9)))
        drawing.joint("Revolute", f"{name} shoe", f"{name} anchor", eye, Z)
        fix(drawing, "back plate", f"{name} anchor", grooved(headed(eye, Z, 6, 28), eye + 23.1 * Z, Z, 6))
        fix(drawing, f"{name} anchor", f"{name} clip", circlip(eye + 23.1 * Z, Z, 6))
        drawing.add(f"{name} piston", cyl((s * 5, 80, 20.5), s * X, 8 - play / 2, 25))
        drawing.joint("Cylindrical", f"{name} piston", "cylinder", (0, 80, 20.5), X)
        fix(
            drawing,
            f"{name} piston",
            f"{name} cup",
            cut(cyl((s * 2, 80, 20.5), s * X, 8 - play / 2, 3), cyl((s, 80, 20.5), s * X, 5, 2)),
        )
        cam = at(s * 46.1, 33.3, 0)
        drawing.add(
            f"{name} cam", union(headed(cam, Z, 5, 5), cyl(cam + 4 * Z, Z, 7, 12), cyl(1.018 * cam + 16 * Z, Z, 8, 8))
        )
        drawing.joint("Revolute", f"{name} cam", "back plate", cam, Z)
        fix(drawing, "back plate", f"{name} hold pin", headed(p, Z, 2.2, 32))
        fix(
            drawing,
            f"{name} hold pin",
            f"{name} hold cup",
            union(tube(p + 23 * Z, Z, 6, 8, 6), tube(p + 27 * Z, Z, 2.2, 8, 2)),
        )
    lever = bar((68, 30), (50, -48), 8, 23.2, 25.7, [(68, 30)], 4 + play)
    drawing.add("lever", cut(lever, bore((50, -48, 0), Z, 3)))
    fix(
        drawing,
        "rear shoe",
        "lever pin",
        union(cyl((68, 30, 17), Z, 4, 9.5), cyl((68, 30, 15.5), Z, 6.5, 2.5), cyl((68, 30, 25.9), Z, 6.5, 2)),
    )
    drawing.joint("Revolute", "lever", "lever pin", (68, 30, 0), Z)
    axle = union(
        cyl(-6 * Z, Z, 17, 12),
        cyl(4 * Z, Z, 34, 6),
        cyl(10 * Z, Z, 17, 2),
        cyl(12 * Z, Z, 15, 14),
        cyl(26 * Z, Z, 11, 54),
    )
    fix(
        drawing, "back plate", "stub axle", cut(axle, *(cyl(p + 3 * Z, Z, 4, 9) for p in corners), bore(74 * Z, Y, 1.5))
    )
    screws(drawing, "stub axle", "axle screw", corners, Z, 4, 10)
    drum = union(tube(9 * Z, Z, r, r + 9, 40), tube(41 * Z, Z, 24, r + 5, 8), tube(12 * Z, Z, 16.5, 33, 54))
    drum = cut(
        drum,
        cyl(11 * Z, Z, 25, 13),
        cyl(54 * Z, Z, 20, 20),
        *(bore(p + 41 * Z, Z, 5, 9) for p in hollow(0 * X, Z, 52, 4)),
    )
    drawing.add("drum", drum)
    for name, low, inner, outer, wide in (("inner", 12, 15, 25, 12), ("outer", 54, 11, 20, 10)):
        fix(drawing, "drum", f"{name} bearing", tube(low * Z, Z, inner, outer, wide))
        drawing.joint("Revolute", f"{name} bearing", "stub axle", 0 * X, Z)
    fix(drawing, "stub axle", "washer", tube(64 * Z, Z, 11, 17, 3))
    fix(drawing, "stub axle", "castle nut", cut(hexagon(67 * Z, Z, 15, 9, 11), bore(74 * Z, Y, 1.5)))
    fix(drawing, "stub axle", "cotter", cyl((0, -17, 74), Y, 1.5, 34))
    cap = union(cyl(64.2 * Z, Z, 20, 2), cyl(66 * Z, Z, 24, 2), cyl(68 * Z, Z, 21, 18))
    fix(drawing, "drum", "dust cap", cut(cap, cyl(64 * Z, Z, 18, 20)))
    return drawing


@kind
def shaper(random):
    """A bull gear with a crank pin, a slotted rocker with a block, links to a ram in dovetails, a clapper."""
    drawing, play, turn = Drawing(["frame"]), random.choice([0.03, 0.1]), random.uniform(0.3, 1.2)
    foot, gear, pinion = at(0, 0, 50), at(0, 0, 150), at(64, 0, 213)
    c = gear + random.uniform(32, 40) * at(np.cos(turn), 0, np.sin(turn))
    way = (c - foot) / np.linalg.norm(c - foot)
    top = foot + 225 * way
    end = at(top[0] - np.sqrt(85**2 - (330 - top[2]) ** 2), 0, 330)
    frame = union(box((-120, -60, 0), (120, 60, 300)), box((-140, -80, 0), (140, 80, 15)))
    frame = cut(frame, box((-100, -30, 20), (100, 30, 301)), bore(foot, Y, 8), cyl(gear + 25 * Y, Y, 15, 40))
    posts = [at(x, s * 52, 300) for x in (-80, 80) for s in (-1, 1)]
    frame = cut(frame, cyl(pinion + 25 * Y, Y, 8 + play, 40), box((-101, -61, 60), (101, -29, 270)))
    frame = union(frame, box((-30, -60, 30), (30, -30, 75)).cut(bore(foot, Y, 8)))
    drawing.add("frame", cut(frame, *(cyl(p, -Z, 2.5, 18) for p in posts)))
    gibs = [at(x, 60, 308) for x in (-60, 60)]
    for s, name in ((-1, "left"), (1, "right")):
        more = 5.0 * (s > 0)
        edge = [(s * (36 + more), 300), (s * (26 + more), 316), (s * 62, 316), (s * 62, 300)]
        rail = prism(edge, (-110, 0, 0), Y, X, 220)
        rail = cut(
            rail,
            *(bore(p, Z, 2.7, 40) for p in posts if p[1] * s > 0),
            *(cyl(p + 9 * Y, -Y, 1.6, 60) for p in gibs if s > 0),
        )
        fix(drawing, "frame", f"{name} way", rail)
        screws(drawing, "frame", f"{name} way screw", [p + 16 * Z for p in posts if p[1] * s > 0], -Z, 2.5, 32)
    edge = [(36 + play, 300), (26 + play, 316), (31, 316), (41, 300)]
    fix(drawing, "right way", "gib", prism(edge, (-110, 0, 0), Y, X, 220))
    for k, p in enumerate(gibs):
        fix(drawing, "right way", f"gib screw {k}", cyl(p + 4 * Y, -Y, 1.6, 27 - play))
    ram = union(
        prism([(-36, 300), (-26, 316), (26, 316), (36, 300)], (-190, 0, 0), Y, X, 350),
        box((-190, -24, 316), (160, 24, 352)),
    )
    noses = hollow((160, 0, 326), X, 19, 2, np.pi / 2)
    ram = cut(
        ram, box(end + at(-35, -13, -31), end + at(60, 13, 15)), bore(end, Y, 6), *(cyl(p, -X, 2, 15) for p in noses)
    )
    drawing.add("ram", ram)
    drawing.joint("Prismatic", "ram", "frame", (0, 0, 300), X)
    fix(drawing, "ram", "ram pin", cyl(end - 24 * Y, Y, 6, 48))
    fix(drawing, "frame", "gear bush", tube(gear + 30 * Y, Y, 10 + play, 15, 30))
    key = box(gear + at(-3, 9, 7), gear + at(3, 21, 12.5))
    drawing.add("gear shaft", cut(union(cyl(gear + 8 * Y, Y, 10, 62), cyl(gear + 62 * Y, Y, 10, 2)), key))
    drawing.joint("Revolute", "gear shaft", "gear bush", gear, Y)
    fix(drawing, "gear shaft", "collar", cut(tube(gear + 60.2 * Y, Y, 10, 17, 9), cyl(gear + 65 * Y, Z, 2, 30)))
    wheel = union(cyl(gear + 8 * Y, Y, 74.8, 14), tube(gear + 22 * Y, Y, 10, 18, 8))
    fix(
        drawing,
        "gear shaft",
        "bull gear",
        cut(wheel, bore(gear, Y, 10), box(gear + at(-3, 0, 0), gear + at(3, 40, 12.5)), bore(c, Y, 5)),
    )
    fix(drawing, "gear shaft", "key", key)
    pin = union(cyl(c - 9.5 * Y, Y, 11, 2), cyl(c - 7.5 * Y, Y, 7, 15.5), cyl(c + 8 * Y, Y, 5, 20))
    fix(drawing, "bull gear", "crank pin", pin)
    fix(drawing, "crank pin", "crank nut", hexagon(c + 22 * Y, Y, 8, 6, 5))
    block = laid(box((-14, -10, -7), (14, 10, 7)), c, way, Y)
    drawing.add("block", cut(block, bore(c, Y, 7 + play)))
    drawing.joint("Revolute", "block", "crank pin", c, Y)
    rocker = cut(flat(foot, top, 18, -6.9, 6.9), flat(foot + 45 * way, foot + 155 * way, 10 + play, -9, 9))
    drawing.add("rocker", cut(rocker, bore(foot, Y, 8 + play), bore(top, Y, 6)))
    drawing.joint("Prismatic", "block", "rocker", c, way)
    fix(drawing, "frame", "rocker pin", cyl(foot - 58 * Y, Y, 8, 116))
    drawing.joint("Revolute", "rocker", "rocker pin", foot, Y)
    fix(drawing, "rocker", "top pin", cyl(top - 12 * Y, Y, 6, 24))
    for s in (-1, 1):
        drawing.add(f"link {s}", flat(top, end, 11, *sorted((s * 7, s * 12)), [top, end], 6 + play))
        drawing.joint("Revolute", f"link {s}", "top pin", top, Y)
        drawing.joint("Revolute", f"link {s}", "ram pin", end, Y)
        fix(drawing, "frame", f"thrust ring {s}", tube(foot + s * 7 * Y, s * Y, 8, 15, 23))
    shaft = union(cyl(pinion + 8 * Y, Y, 15, 14), cyl(pinion + 22 * Y, Y, 8, 70), cyl(pinion + 22 * Y, Y, 12, 8))
    drawing.add("pinion shaft", shaft)
    drawing.joint("Revolute", "pinion shaft", "frame", pinion, Y)
    fix(drawing, "pinion shaft", "pulley", tube(pinion + 60.2 * Y, Y, 8, 45, 22))
    head = union(
        cyl((160, 0, 326), X, 30, 12), prism([(-10, 172), (-16, 184), (16, 184), (10, 172)], (0, 0, 285), -Y, Z, 60)
    )
    head = cut(
        head,
        bore((177.5, 0, 0), Z, 3),
        *(bore(p, X, 2.2, 300) for p in noses),
        *(cyl(p + 8 * X, X, 3.4, 4.5) for p in noses),
    )
    fix(drawing, "ram", "head", head)
    screws(drawing, "ram", "head screw", [p + 8 * X for p in noses], -X, 2, 22)
    slide = box((173, -26, 292), (196, 26, 370))
    edge = [(-10 - play, 171), (-16 - play, 184 + play), (16 + play, 184 + play), (10 + play, 171)]
    lugs = [at(190, y, 370) for y in (-19, 19)]
    fronts = [at(201, y, 302) for y in (-18, 18)]
    slide = cut(
        slide,
        prism(edge, (0, 0, 280), -Y, Z, 95),
        *(cyl(p, -Z, 2, 14) for p in lugs),
        *(bore(p, X, 2, 9) for p in fronts),
    )
    drawing.add("slide", slide)
    drawing.joint("Prismatic", "slide", "head", (178, 0, 0), Z)
    fix(
        drawing,
        "slide",
        "bracket",
        cut(
            box((173, -26, 370), (196, 26, 378)), bore((177.5, 0, 0), Z, 3 + play), *(bore(p, Z, 2.2, 20) for p in lugs)
        ),
    )
    screws(drawing, "slide", "bracket screw", [p + 8 * Z for p in lugs], -Z, 2, 18)
    drawing.add("feed screw", union(cyl((177.5, 0, 296), Z, 3, 104), cyl((177.5, 0, 364), Z, 4.4, 6)))
    drawing.joint("Cylindrical", "feed screw", "head", (177.5, 0, 0), Z)
    drawing.joint("Revolute", "feed screw", "bracket", (177.5, 0, 0), Z)
    fix(drawing, "feed screw", "hand wheel", tube((177.5, 0, 378), Z, 3, 14, 12))
    clapper_box = union(
        box((196, -24, 294), (201, 24, 346)), *(box((196, y, 322), (215, y + 9 * np.sign(y), 346)) for y in (-15, 15))
    )
    fix(
        drawing,
        "slide",
        "clapper box",
        cut(clapper_box, bore((208, 0, 337), Y, 3), *(bore(p, X, 2.2, 9) for p in fronts)),
    )
    fix(drawing, "clapper box", "clapper pin", cyl((208, -24, 337), Y, 3, 48))
    clapper = cut(box((201, -14.9, 298), (215, 14.9, 345)), bore((208, 0, 337), Y, 3 + play), bore((208, 0, 312), X, 8))
    drawing.add("clapper", cut(clapper, box((205, -15, 299), (201, 15, 290))))
    drawing.joint("Revolute", "clapper", "clapper pin", (208, 0, 337), Y)
    post = union(cyl((203, 0, 312), X, 8, 34), cyl((215, 0, 312), X, 12, 4))
    fix(drawing, "clapper", "tool post", cut(post, box((222, -4, 290), (230, 4, 340)), cyl((229, 0, 312), X, 2.5, 20)))
    fix(drawing, "tool post", "tool", box((222, -4, 262), (230, 4, 345)))
    fix(drawing, "tool post", "tool screw", screw((240, 0, 312), -X, 2.5, 10))
    return drawing
