"""A clock's movement, a toy with cams, a surgeon's retractor."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.powered import grooved
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, laid, meet, rivet, screw, sphere, tube, union
from drawings.sharpened import put, sheet


@kind
def clock_escapement(random):
    """Plates on pillars, arbors with wheels and pinions, an anchor with a crutch, a cock, a pendulum on a spring."""
    drawing, play, lean = Drawing(["back plate"]), random.choice([0.03, 0.08]), random.uniform(0.4, 0.6)
    side = 34.2 * np.sin(lean)
    great = at(0, -30, 0)
    centre = great + at(side, 34.2 * np.cos(lean), 0)
    escape = centre + at(-side, np.sqrt(30.2**2 - side**2), 0)
    anchor = escape + 28 * Y
    top = anchor[1] + 14
    posts, feet = [at(x, y, 0) for x in (-40, 40) for y in (-64, top - 8)], [anchor + s * 18 * X for s in (-1, 1)]
    outline = box((-48, -72, 0), (48, top, 3))
    arbors = (great, centre, escape, anchor)
    back = [bore(p, Z, 1 + play, 9) for p in arbors[:3]] + [bore(p, Z, 2, 9) for p in posts] + [bore(anchor, Z, 5, 9)]
    drawing.add("back plate", cut(outline, *back, *(bore(p, Z, 1.2, 9) for p in feet)))
    front = [bore(p, Z, (1 if k % 3 else 2.5) + play, 9) for k, p in enumerate(arbors)]
    front[1], front[3] = bore(centre, Z, 1.5 + play, 9), bore(anchor, Z, 1 + play, 9)
    part = cut(outline, *front, *(bore(p, Z, 1.6, 9) for p in posts)).translate((0, 0, 33))
    put(drawing, "front plate", part, "pillar 0")
    for k, p in enumerate(posts):
        pillar = union(cyl(p + 3 * Z, Z, 4, 30), cyl(p, Z, 2, 4), cyl(p - Z, Z, 3, 1))
        put(drawing, f"pillar {k}", cut(pillar, cyl(p + 23 * Z, Z, 1.5, 12)), "back plate")
        put(drawing, f"pillar screw {k}", screw(p + 36 * Z, -Z, 1.5, 11), f"pillar {k}")
    shapes = {
        "great": union(
            cyl(great + 3.1 * Z, Z, 3, 29.8),
            cyl(great, Z, 1, 5),
            cyl(great + 30 * Z, Z, 2.5, 8),
            box(great + at(-1.6, -1.6, 36), great + at(1.6, 1.6, 50)),
        ),
        "centre": union(
            cyl(centre + 3.1 * Z, Z, 2, 29.8),
            cyl(centre + 4 * Z, Z, 3.8, 7),
            cyl(centre, Z, 1, 5),
            cyl(centre + 30 * Z, Z, 1.5, 14),
        ),
        "escape": union(cyl(escape + 3.1 * Z, Z, 2, 29.8), cyl(escape + 11 * Z, Z, 3.8, 8), cyl(escape, Z, 1, 36)),
        "anchor": union(cyl(anchor - 10.9 * Z, Z, 2, 43.8), cyl(anchor - 14 * Z, Z, 1, 50)),
    }
    for (name, shape), p in zip(shapes.items(), arbors, strict=True):
        drawing.add(f"{name} arbor", shape)
        drawing.joint("Revolute", f"{name} arbor", "cock" if name == "anchor" else "back plate", p, Z)
    for name, p, radius, z, bored in (("great", great, 30, 6, 3), ("centre", centre, 26, 14, 2)):
        wheel = cut(cyl(p + z * Z, Z, radius, 2), *(bore(q, Z, radius / 4) for q in hollow(p, Z, 0.6 * radius, 5)))
        put(drawing, f"{name} wheel", cut(union(wheel, cyl(p + z * Z, Z, 5, 4)), bore(p, Z, bored)), f"{name} arbor")
    angles = np.pi / 15 * (np.arange(30) + 0.4 * (np.arange(30) % 2))
    teeth = [(17.5 - 3 * (k % 2)) * at(np.cos(t), np.sin(t), 0) for k, t in enumerate(angles)]
    star = sheet([p[:2] for p in teeth], 22, 24).translate((*escape[:2], 0))
    put(drawing, "escape wheel", cut(union(star, cyl(escape + 20 * Z, Z, 4, 4)), bore(escape, Z, 2)), "escape arbor")
    arms = [bar(anchor, escape + 20.5 * at(s * np.sin(0.9), np.cos(0.9), 0), 2.5, 21, 25) for s in (-1, 1)]
    put(drawing, "anchor", cut(union(*arms, cyl(anchor + 20 * Z, Z, 5, 6)), bore(anchor, Z, 2)), "anchor arbor")
    drum = union(cyl(great + 18 * Z, Z, 12, 13), cyl(great + 18 * Z, Z, 17, 1.5), cyl(great + 29.5 * Z, Z, 17, 1.5))
    put(drawing, "drum", cut(drum, bore(great, Z, 3)), "great arbor")
    hand = cut(union(bar(centre, centre + 40 * Y, 2, 40, 41), cyl(centre + 38 * Z, Z, 4, 4)), bore(centre, Z, 1.5))
    put(drawing, "minute hand", hand, "centre arbor")
    cock = union(
        box(anchor + at(-22, -5, -14), anchor + at(22, 5, -11)),
        *(box(p + at(-4, -5, -11), p + at(4, 5, 0)) for p in feet),
    )
    cock = union(cock, box(anchor + at(-5, 2, -32), anchor + at(5, 10, -12)))
    cock = cut(
        cock,
        bore(anchor, Z, 1 + play),
        *(bore(p, Z, 1.6) for p in feet),
        box(anchor + at(-0.15, 1, -40), anchor + at(0.15, 11, -14)),
    )
    put(drawing, "cock", cut(cock, bore(anchor + at(0, 6, -26), X, 1)), "back plate")
    for k, p in enumerate(feet):
        put(drawing, f"cock screw {k}", screw(p - 14 * Z, Z, 1.2, 17), "cock")
    part = cut(box(anchor + at(-0.15, -12, -30), anchor + at(0.15, 10, -22)), bore(anchor + at(0, 6, -26), X, 1))
    put(drawing, "suspension spring", part, "cock")
    put(drawing, "chop pin", cyl(anchor + at(-7, 6, -26), X, 1, 14), "cock")
    crutch = union(bar(anchor, anchor - 44 * Y, 3, -8, -5), cyl(anchor - 10 * Z, Z, 5, 5))
    prongs = [box(anchor + at(x, -47, -31), anchor + at(x + 1.5, -41, -5)) for x in (-4.1, 2.6)]
    crutch = cut(union(crutch, box(anchor + at(-4.1, -47, -8), anchor + at(4.1, -41, -5)), *prongs), bore(anchor, Z, 2))
    put(drawing, "crutch", crutch, "anchor arbor")
    rod = union(box(anchor + at(-3, -16, -31), anchor + at(3, -5, -21)), cyl(anchor + at(0, -15, -26), -Y, 2.5, 165))
    drawing.add("pendulum rod", cut(rod, box(anchor + at(-0.15, -12, -40), anchor + at(0.15, 0, -10))))
    drawing.joint("Revolute", "pendulum rod", "suspension spring", anchor, Z)
    low = anchor + at(0, -150, -26)
    put(drawing, "bob", cut(cyl(low - 6 * Z, Z, 25, 12), bore(low, Y, 2.5, 60)), "pendulum rod")
    put(drawing, "rating nut", tube(low - 25 * Y, -Y, 2.5, 6, 4), "pendulum rod")
    return drawing


@kind
def cam_automaton(random):
    """A wooden box, a crank shaft in bushes, three cams, a turning rod, a square rod with a roller, a rower."""
    drawing, play, turn = Drawing(["base"]), random.choice([0.1, 0.2]), random.uniform(0.3, 2.8, 3)
    spots = [(s, at(s * 86, y, 0)) for s in (-1, 1) for y in (-22, 22)]
    board = [cut(box((-90, -36, z), (90, 36, z + 8)), *(bore(p + z * Z, Z, 1.8, 9) for _, p in spots)) for z in (0, 90)]
    drawing.add("base", board[0])
    link_slot, tops = box((50, 10, 80), (62, 34, 110)), [at(36, y, 0) for y in (-30, -22, -4, 4)]
    guide = [at(x, 0, 0) for x in (-11, 21)]
    holes = [bore((-45, 7, 94), Z, 6, 9), box((-1.3, -6.3, 80), (11.3, 6.3, 110)), link_slot]
    put(drawing, "top", cut(board[1], *holes, *(bore(p + 94 * Z, Z, 1.5, 9) for p in tops + guide)), "left side")
    for s, name in ((-1, "left"), (1, "right")):
        panel = box((s * 82, -36, 8), (s * 90, 36, 90))
        panel = cut(
            panel, bore((s * 86, 0, 45), X, 6, 9), *(bore(p + z * Z, Z, 1.5, 18) for _, p in spots for z in (8, 90))
        )
        put(drawing, f"{name} side", panel, "base")
        bush = union(tube((s * 82, 0, 45), s * X, 4 + play, 6, 8), tube((s * 90, 0, 45), s * X, 4 + play, 9, 2))
        put(drawing, f"{name} bush", bush, f"{name} side")
        part = cut(tube((s * 75, 0, 45), s * X, 4, 8, 7), bore((s * 78, 0, 49), Z, 1.2, 4))
        put(drawing, f"{name} collar", part, "shaft")
    for k, (s, p) in enumerate(spots):
        name = "left side" if s < 0 else "right side"
        put(drawing, f"lower screw {k}", screw(p, Z, 1.5, 24), name)
        put(drawing, f"upper screw {k}", screw(p + 98 * Z, -Z, 1.5, 24), name)
    drawing.add("shaft", cut(cyl((-94, 0, 45), X, 4, 196), cyl((84, 0, 45), X, 1.5, 30)))
    drawing.joint("Revolute", "shaft", "left bush", (0, 0, 45), X)
    middles = []
    for k, (x, radius, out) in enumerate(((-45, 20, 6), (5, 19, 8), (50, 16, 7))):
        c = at(x, out * np.cos(turn[k]), 45 + out * np.sin(turn[k]))
        hub = cyl((x - 12, 0, 45), X, 8, 8)
        put(drawing, f"cam {k}", cut(union(cyl(c - 4 * X, X, radius, 8), hub), bore((x, 0, 45), X, 4, 40)), "shaft")
        middles.append(c)
    foot = at(-45, 7, middles[0][2] + 20)
    drawing.add("turning rod", cyl(foot, Z, 4, 60))
    drawing.joint("Cylindrical", "turning rod", "turning guide", foot, Z)
    put(drawing, "turning foot", tube(foot, Z, 4, 14, 5), "turning rod")
    sleeve = union(tube((-45, 7, 86), Z, 4 + play, 6, 12), tube((-45, 7, 98), Z, 4 + play, 9, 2))
    put(drawing, "turning guide", sleeve, "top")
    figure = union(cyl(foot + 50 * Z, Z, 11, 24), sphere(foot + 80 * Z, 9))
    put(drawing, "dancer", cut(figure, cyl(foot, Z, 4, 60)), "turning rod")
    roll = at(5, 0, middles[1][2] + np.sqrt(26.0**2 - middles[1][1] ** 2))
    rod = box((-1, -6, roll[2] - 4), (11, 6, 140))
    rod = cut(rod, box((2, -9, roll[2] - 9), (8, 9, roll[2] + 9)), bore(roll, X, 2))
    drawing.add("square rod", rod)
    drawing.joint("Prismatic", "square rod", "square guide", roll, Z)
    put(drawing, "roller pin", cyl(roll - 6 * X, X, 2, 12), "square rod")
    drawing.add("roller", tube(roll - 2.9 * X, X, 2 + play / 2, 7, 5.8))
    drawing.joint("Revolute", "roller", "roller pin", roll, X)
    block = cut(box((-17, -12, 98), (27, 12, 112)), box((-1 - play, -6 - play, 90), (11 + play, 6 + play, 120)))
    put(drawing, "square guide", cut(block, *(bore(p + 110 * Z, Z, 1.8, 20) for p in guide)), "top")
    for k, p in enumerate(guide):
        put(drawing, f"guide screw {k}", screw(p + 112 * Z, -Z, 1.5, 20), "top")
    part = cut(union(box((-15, -5, 132), (30, 5, 150)), box((25, -4, 145), (40, 4, 155))), drawing.parts["square rod"])
    put(drawing, "bird", part, "square rod")
    p, c = at(50, -26, 72), middles[2]
    tilt = np.arctan2(c[2] - p[2], c[1] - p[1]) + np.arcsin(21 / np.hypot(c[1] - p[1], c[2] - p[2]))
    tip, r = p + 50 * at(0, np.cos(tilt), np.sin(tilt)), at(50, 0, 132)
    f = at(50, *meet(r[1:], 23, tip[1:], 62))

    def plate(one, other, half, low, high, radii):
        flat = bar(one[1:], other[1:], half, low, high)
        return cut(laid(flat, 0 * X, Y, X), *(bore(q, X, radius, 90) for q, radius in radii))

    drawing.add("rocker", plate(p, tip, 5, 46, 54, ((p, 2.5 + play), (tip, 2))))
    drawing.add("link", plate(tip, f, 4, 54.1, 57, ((tip, 2 + play), (f, 2 + play))))
    drawing.add(
        "rower",
        cut(
            union(plate(r, f, 5, 46, 54, ()), plate(r, r + 30 * Z, 8, 46, 54, ())),
            bore(r, X, 2.5 + play),
            bore(f, X, 2),
        ),
    )
    for k, (q, low, high) in enumerate(((p, 66, 90), (r, 98, 138))):
        name, ears = ("bracket", "post")[k], tops[2 * k : 2 * k + 2]
        flange = box((30, q[1] - 8, 86 if k == 0 else 98), (46, q[1] + 8, 90 if k == 0 else 102))
        lug = cut(
            union(box((42, q[1] - 8, low), (46, q[1] + 8, high)), flange),
            bore(q, X, 2.5),
            *(bore(e + 94 * Z, Z, 1.5, 14) for e in ears),
        )
        put(drawing, name, lug, "top")
        put(drawing, f"{name} pin", headed(q - 8 * X, X, 2.5, 12.1).union(cyl(q + 4.1 * X, X, 4, 2)), name)
    for name, q, host in (("tip rivet", tip, "rocker"), ("arm rivet", f, "rower")):
        put(drawing, name, headed(q - 4 * X, X, 2, 11.1).union(cyl(q + 7.1 * X, X, 3.4, 1.6)), host)
    drawing.joint("Revolute", "rocker", "bracket pin", p, X)
    drawing.joint("Revolute", "rower", "post pin", r, X)
    drawing.joint("Revolute", "link", "tip rivet", tip, X)
    drawing.joint("Revolute", "link", "arm rivet", f, X)
    crank = laid(bar((0, 0), (36, 0), 9, 92.1, 102, ((36, 0, 92),), 2), at(0, 0, 45), Y, X)
    put(drawing, "crank", cut(crank, cyl((80, 0, 45), X, 4, 22)), "shaft")
    put(drawing, "crank screw", union(screw((104, 0, 45), -X, 1.5, 14), tube((102, 0, 45), X, 1.5, 7, 2)), "shaft")
    put(drawing, "knob pin", rivet((92.1, 36, 45), X, 2, 34), "crank")
    drawing.add("knob", tube((102.2, 36, 45), X, 2 + play, 7, 23.7))
    drawing.joint("Revolute", "knob", "knob pin", (0, 36, 45), X)
    return drawing


@kind
def rib_retractor(random):
    """A toothed bar with a fixed arm, a block with pinion, cover, pawl and folding crank, four clipped blades."""
    drawing, play, start = Drawing(["rack"], unit="INCH"), random.choice([0.03, 0.1]), 5.0 * random.integers(11, 22)
    edge = [(x + dx, y) for x in np.arange(20, 195, 5) for dx, y in ((0, 6), (0.4, 8), (2.1, 8), (2.5, 6))]
    rack = sheet([(-26, -6), (210, -6), (210, 6), *reversed(edge), (-26, 6)], -3, 3)
    ties = [at(-20, 0, 0), at(-4, 0, 0)]
    drawing.add("rack", cut(rack, *(bore(p, Z, 2, 9) for p in ties), bore((204, 0, 0), Z, 2, 9)))
    put(drawing, "end stop", screw((204, 0, 3), -Z, 2, 6), "rack")
    o, gear, pawl = at(start, 0, 0), at(start + 14, 14.4, 0), at(start + 36, 16, 0)
    spots = [o + at(*p, 0) for p in ((4, -9), (40, -9), (4, 19), (24, 19))]
    under = [o + at(16, y, 0) for y in (-9, 2)]
    block = box(o + at(0, -12, -9), o + at(44, 24, 9))
    block = cut(
        block, box(o + at(-1, -6 - play, -3 - play), o + at(45, 8 + play, 3 + play)), cyl(gear - 4 * Z, Z, 6.6, 20)
    )
    block = cut(block, bore(gear, Z, 4 + play), box(o + at(28, 7, -3), o + at(45, 25, 3)), bore(pawl, Z, 2))
    block = cut(
        block,
        *(cyl(p, Z, 1.5, 20) for p in spots[:1] + spots[2:]),
        cyl(spots[1], Z, 1.5, 20),
        *(cyl(p - 20 * Z, Z, 2, 16) for p in under),
    )
    drawing.add("block", block)
    drawing.joint("Prismatic", "block", "rack", o, X)
    cover = cut(box(o + at(0, -12, 9), o + at(44, 24, 12)), bore(gear, Z, 4 + play), *(bore(p, Z, 1.7) for p in spots))
    put(drawing, "cover", cover, "block")
    for k, p in enumerate(spots):
        put(drawing, f"cover screw {k}", screw(p + 12 * Z, -Z, 1.5, 11), "block")
    hinge, way = at(38, 0, 18.3), at(np.cos(1.2), np.sin(1.2), 0)
    shaft = union(cyl(gear - 9 * Z, Z, 4, 24.3), cyl(gear - 4 * Z, Z, 6, 8), cyl(gear + 4 * Z, Z, 5, 5))
    shaft = union(shaft, laid(box((-2.8, -2.8, 14), (2.8, 2.8, 21)), gear, way, Z))
    drawing.add("pinion", cut(shaft, cyl(gear + 11 * Z, Z, 1.25, 20)))
    drawing.joint("Revolute", "pinion", "block", gear, Z)
    arm = union(bar((0, 0), (26, 0), 7, 15.3, 21.3), box((26, -7, 15.3), (38, 7, 21.3)), cyl(hinge - 7 * Y, Y, 3, 14))
    arm = cut(arm, box((31, -3, 9), (60, 3, 25)), box((-2.8, -2.8, 10), (2.8, 2.8, 30)), bore(hinge, Y, 1.5))
    put(drawing, "crank", laid(arm, gear, way, Z), "pinion")
    part = union(screw(gear + 22.3 * Z, -Z, 1.25, 10), tube(gear + 21.3 * Z, Z, 1.25, 5, 1))
    put(drawing, "crank screw", part, "pinion")
    put(drawing, "crank pin", laid(cyl(hinge - 7 * Y, Y, 1.5, 14), gear, way, Z), "crank")
    grip = union(cyl(hinge - 2.9 * Y, Y, 3, 5.8), box((35.5, -2.9, 18), (40.5, 2.9, 43)), cyl((38, 0, 41), Z, 6, 30))
    drawing.add("crank grip", laid(cut(grip, bore(hinge, Y, 1.5 + play)), gear, way, Z))
    where = gear + hinge[0] * way + hinge[2] * Z
    drawing.joint("Revolute", "crank grip", "crank", where, np.cross(Z, way))
    put(drawing, "pawl pin", cyl(pawl - 9 * Z, Z, 2, 18), "block")
    tooth = sheet(((33.2, 6.6), (34, 6.6), (36, 15), (32, 15)), -2.9, 2.9).translate((start, 0, 0))
    drawing.add("pawl", cut(union(tooth, bar(pawl, pawl + at(16, 2, 0), 4, -2.9, 2.9)), bore(pawl, Z, 2 + play)))
    drawing.joint("Revolute", "pawl", "pawl pin", pawl, Z)
    fixed = union(box((-20, -150, -15), (-4, 0, -9)), box((-26, -12, -15), (4, 12, -3)))
    stems = [[at(x, y, 0) for y in (-75, -132)] for x in (-12, start + 16)]
    drawing.joint("Weld", "fixed arm", "rack")
    drawing.add(
        "fixed arm", cut(fixed, *(cyl(p - 12 * Z, Z, 2, 20) for p in ties), *(bore(p, Z, 3 + play) for p in stems[0]))
    )
    for k, p in enumerate(ties):
        put(drawing, f"arm screw {k}", screw(p + 3 * Z, -Z, 2, 14), "fixed arm")
    slide = cut(
        box(o + at(8, -150, -15), o + at(24, 8, -9)),
        *(bore(p, Z, 2.2) for p in under),
        *(bore(p, Z, 3 + play) for p in stems[1]),
    )
    put(drawing, "sliding arm", slide, "block")
    for k, p in enumerate(under):
        put(drawing, f"slide screw {k}", screw(p - 15 * Z, Z, 2, 10.5), "block")
    for side, name, s in ((0, "fixed", 1), (1, "sliding", -1)):
        for k, p in enumerate(stems[side]):
            blade = union(box((-10, -24, -18), (10, 24, -15)), box((s * 7, -24, -60), (s * 10, 24, -15)))
            blade = cut(blade, box((-20, -14, -50), (20, 14, -30))).translate(tuple(p))
            stem = grooved(cyl(p - 17 * Z, Z, 3, 10.5), p - 8.9 * Z, Z, 3)
            drawing.add(f"{name} blade {k}", union(blade, stem))
            put(drawing, f"{name} clip {k}", circlip(p - 8.9 * Z, Z, 3), f"{name} blade {k}")
            drawing.joint("Revolute", f"{name} blade {k}", f"{name} arm", p, Z)
    return drawing
