"""Machines of parallel legs: a delta robot, a hexapod, and a scissor lift, as engineers' theses and hobbyists have."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import ram, stepper, strut, upright, upright_at, weld
from drawings.drawing import Drawing, kind
from drawings.shapes import Y, Z, at, bore, box, cut, cyl, laid, meet, sphere, union


@kind
def magnetic_delta(random: np.random.Generator) -> Drawing:
    """A delta robot: steppers under a disc, arms with ball studs, rods with magnetic cups, away from its middle.

    Truth: each arm turns on the motor with its shaft (revolute, horizontal, across the arm); motors and brackets are
    one with the base plate; ball studs one with their arm or with the effector; each cup of a rod and its ball are
    spherical. Three freedoms, and the spins of six rods.
    """
    out, upper, lower, inner, half = 80.0, random.uniform(88, 110), random.uniform(200, 230), 36.0, 22.0
    spot = at(*random.uniform(-30, 30, 2), -random.uniform(195, 235))
    loose, ball = float(random.choice([0, 0.05, 0.15])), 5.0
    drawing = Drawing(fixed=["Base plate"])
    disc = cyl((0, 0, 0), Z, 118, 6).cut(bore((0, 0, 3), Z, 25, 6)).edges("%CIRCLE and >Z").chamfer(1)
    drawing.add("Base plate", disc)
    lobes, cups = [cyl((*spot[:2], spot[2] - 3), Z, 24, 6)], []
    for number in range(1, 4):
        turn = 2 * np.pi * (number - 1) / 3
        radial, across = at(np.cos(turn), np.sin(turn), 0), at(-np.sin(turn), np.cos(turn), 0)

        def place(r: float, t: float, z: float, radial=radial, across=across) -> np.ndarray:
            return r * radial + t * across + z * Z

        shoulder = at(out, -26)
        wrist = at(spot @ radial + inner, spot[2])
        aside = float(spot @ across)
        knee = meet(wrist, np.sqrt(lower**2 - aside**2), shoulder, upper)
        other = meet(shoulder, upper, wrist, np.sqrt(lower**2 - aside**2))
        knee = knee if knee[0] > other[0] else other
        # in the coordinates of the arm: x radial, y across, z up
        bracket = box((out - 25, -12, -50), (out + 25, -9, 0)).union(box((out - 25, -12, -3), (out + 25, 22, 0)))
        bracket = cut(bracket, bore((out, -10, -26), Y, 11.2, 6))
        arm = union(
            upright([shoulder, knee], -4, 4, 7),
            cyl((out, -7, -26), Y, 9, 14),
            cyl(upright_at(knee, -half + 7.5), Y, 4, 2 * half - 15),
        )
        arm = cut(arm, bore((out, 0, -26), Y, 2.5 + loose / 3, 20), bore(upright_at(knee, 0), Y, 2, half))
        drawing.add(f"Motor bracket:{number}", laid(bracket, (0, 0, 0), radial, Z))
        drawing.add(f"NEMA17:{number}", laid(stepper((out, -12, -26), -Z, Y), (0, 0, 0), radial, Z))
        drawing.add(f"Bicep:{number}", laid(arm, (0, 0, 0), radial, Z))
        weld(drawing, "Base plate", f"Motor bracket:{number}")
        weld(drawing, f"Motor bracket:{number}", f"NEMA17:{number}")
        drawing.joint("Revolute", f"NEMA17:{number}", f"Bicep:{number}", place(out, 0, -26), across)
        lobes += [
            laid(box((inner - 34, -half + 7.5, -3), (inner, half - 7.5, 3)), spot, radial, Z),
            laid(cyl((inner, -half + 7.5, 0), Y, 4, 2 * half - 15), spot, radial, Z),
        ]
        cups.append(laid(bore((inner, 0, 0), Y, 2, half), spot, radial, Z))
        for side, word in ((-1, "A"), (1, "B")):
            high = place(knee[0], side * half, knee[1])
            low = place(wrist[0], aside + side * half, wrist[1])
            way = (low - high) / np.linalg.norm(low - high)
            ends = union(cyl(high + 2.9 * way, way, 5.8, 7), cyl(low - 2.9 * way, -way, 5.8, 7))
            rod = union(ends, strut(high + 9 * way, low - 9 * way, 3))
            drawing.add(f"Rod:{number}{word}", cut(rod, sphere(high, ball + loose), sphere(low, ball + loose)))
            for centre, body, end in ((high, f"Bicep:{number}", "upper"), (low, "Effector", "lower")):
                name = f"Ball stud 10mm {end}:{number}{word}"
                drawing.add(name, union(sphere(centre, ball), cyl(centre, -side * across, 2, 14)))
                weld(drawing, body, name)
                drawing.joint("Spherical", name, f"Rod:{number}{word}", centre)
    drawing.add("Effector", cut(union(*lobes), *cups, bore(spot, Z, 8, 5)))
    return drawing


@kind
def electric_hexapod(random: np.random.Generator) -> Drawing:
    """A Stewart platform, tilted: legs on universal joints with spiders, rods with ball ends in sockets.

    Truth for each leg: yoke one with the base; spider to the yoke and spider to the leg's tube revolute, along the two
    axes of the spider; rod to tube cylindrical along the leg (a round rod in a round tube); ball end of the rod to its
    socket spherical; socket one with the top plate. Six freedoms; a rod's spin is its socket's and its tube's too.
    """
    low, high = random.uniform(115, 130), random.uniform(75, 90)
    top = at(*random.uniform(-12, 12, 2), random.uniform(205, 230))
    roll, pitch, yaw = np.radians(random.uniform(-7, 7, 3))
    turn = np.array([[1, -yaw, pitch], [yaw, 1, -roll], [-pitch, roll, 1]])
    turn, upper = np.linalg.qr(turn)
    turn = turn * np.sign(np.diag(upper))
    play = float(random.choice([0, 0.1]))
    drawing = Drawing(fixed=["Bottom_Plate"])
    drawing.add("Bottom_Plate", cyl((0, 0, 0), Z, low + 28, 10).edges("%CIRCLE").chamfer(1.5))
    drawing.add("Top_Plate", laid(cyl((0, 0, 14), Z, high + 20, 8), top, turn[:, 0], turn[:, 2]))
    for leg in range(6):
        pair, side = leg // 2, 1 - 2 * (leg % 2)
        below, above = np.radians(120 * pair + side * np.array([18, 45]))
        foot = at(low * np.cos(below), low * np.sin(below), 32)
        head = top + turn @ at(high * np.cos(above), high * np.sin(above), 0)
        along = (head - foot) / np.linalg.norm(head - foot)
        first = at(-np.sin(below), np.cos(below), 0)
        second = np.cross(along, first)
        second /= np.linalg.norm(second)
        name = f"{leg + 1}"
        # the yoke on the base: ears across the first axis
        ears = [box((-8, a * 11, -17), (8, a * 16, 0)).union(cyl((0, a * 13.5 - 2.5, 0), Y, 8, 5)) for a in (-1, 1)]
        yoke = union(box((-14, -16, -22), (14, 16, -16)), *ears)
        yoke = laid(cut(yoke, bore((0, 0, 0), Y, 4 + play, 20)), foot, np.cross(first, Z), Z)
        drawing.add(f"Base_Yoke_{name}", yoke)
        body = laid(box((-7, -7, -5), (7, 7, 5)).edges().chamfer(0.8), foot, first, np.cross(first, second))
        spider = union(body, cyl(foot - 16 * first, first, 4, 32), cyl(foot - 16 * second, second, 4, 32))
        drawing.add(f"Cross_{name}", spider)
        fork = [cyl((0, a * 13.5 - 2.5, 0), Y, 8, 5).union(box((-8, a * 11, 0), (8, a * 16, 20))) for a in (-1, 1)]
        tube = union(box((-11, -16, 19), (11, 16, 25)), *fork, cyl((0, 0, 24), Z, 12, 100))
        tube = cut(tube, bore((0, 0, 0), Y, 4 + play, 20), cyl((0, 0, 34), Z, 6 + play, 100))
        drawing.add(f"Actuator_Body_{name}", laid(tube, foot, np.cross(second, along), along))
        rod = union(
            strut(foot + 70 * along, head - 12 * along, 6), strut(head - 13 * along, head, 3.5), sphere(head, 8)
        )
        drawing.add(f"Actuator_Rod_{name}", rod)
        socket = cyl((0, 0, -3), Z, 12, 17).cut(sphere((0, 0, 0), 8 + play / 2))
        drawing.add(f"Socket_{name}", laid(socket, head, turn[:, 0], turn[:, 2]))
        weld(drawing, "Bottom_Plate", f"Base_Yoke_{name}")
        weld(drawing, "Top_Plate", f"Socket_{name}")
        drawing.joint("Revolute", f"Base_Yoke_{name}", f"Cross_{name}", foot, first)
        drawing.joint("Revolute", f"Cross_{name}", f"Actuator_Body_{name}", foot, second)
        drawing.joint("Cylindrical", f"Actuator_Body_{name}", f"Actuator_Rod_{name}", foot, along)
        drawing.joint("Spherical", f"Actuator_Rod_{name}", f"Socket_{name}", head)
    return drawing


@kind
def two_stage_scissor_lift(random: np.random.Generator) -> Drawing:
    """A lift of two stages of crossed arms on both sides, with shafts across, blocks in channels, and a cylinder.

    Truth, along y (across) unless said: inner arms of a stage are one with the shaft in their middle, outer arms with
    the shaft at their end at base or platform; a shaft between stages is one with the inner arms there. Revolute:
    outer arms of a stage on its middle shaft, both ends of the joints between stages, lower outer arms on the base's
    lugs, upper inner arms on the platform's lugs, blocks on their shafts; cylinder on its pin (one with the base's
    lugs) and rod on the upper middle shaft. Blocks in their channels prismatic along x; rod in barrel cylindrical.
    Channels are one with base and platform. One freedom.
    """
    long, theta = random.uniform(560, 640), np.radians(random.uniform(22, 38))
    play, wide = float(random.choice([0.1, 0.25])), random.uniform(150, 190)
    across, rise, start = long * np.cos(theta), long * np.sin(theta), 18.3
    drawing = Drawing(fixed=["Base"])
    levels = [start, start + rise, start + 2 * rise]
    left = [at(0, z) for z in levels]
    right = [at(across, z) for z in levels]
    middle = [at(across / 2, start + rise / 2), at(across / 2, start + 1.5 * rise)]
    foot, span = at(0.2 * across, 42.0), at(-60, long + 80)
    y0, y1 = -wide - 50, wide + 50
    lugs = [
        upright([at(p[0], p[1]), at(p[0], end)], *sorted((side * a, side * b)), half)
        for p, end, half, a, b in ((left[0], -2, 18, wide - 12, wide - 2), (foot, -2, 18, 21, 31))
        for side in (-1, 1)
    ]
    base = union(
        box((span[0], y0, -10), (span[1], y1, 0)).edges("|Z").fillet(12),
        *(lug.cut(box((-999, -999, -99), (999, 999, -5))) for lug in lugs),
    )
    base = cut(base, bore(upright_at(left[0], 0), Y, 8 + play), bore(upright_at(foot, 0), Y, 10, 60))
    deck = levels[2] + 18.3
    lugs = [upright([left[2], left[2] + at(0, 24)], *sorted((s * (wide - 28), s * (wide - 16))), 17) for s in (-1, 1)]
    cap = box((-999, -999, deck + 5), (999, 999, deck + 99))
    platform = union(box((span[0], y0, deck), (span[1], y1, deck + 10)), *(lug.cut(cap) for lug in lugs))
    drawing.add("Base", base)
    drawing.add("Platform", cut(platform, bore(upright_at(left[2], 0), Y, 8 + play)))

    def shaft(name: str, p, reach: float) -> None:
        drawing.add(name, cyl(upright_at(p, -reach), Y, 8, 2 * reach).edges("%CIRCLE").chamfer(1))

    for stage in (0, 1):
        one, two = (left[stage], right[stage + 1]), (right[stage], left[stage + 1])
        for side, word in ((1, "L"), (-1, "R")):
            for name, ends, band, tight in (
                ("Outer", one, (wide, wide + 10), [left[0] if stage == 0 else right[2]]),
                ("Inner", two, (wide - 12, wide - 2), [*two, middle[stage]]),
            ):
                arm = upright(ends, *sorted(side * b for b in band), 14)
                holes = [
                    bore(upright_at(p, 0), Y, 8 + play * (not any(p is t for t in tight)))
                    for p in (*ends, middle[stage])
                ]
                drawing.add(f"{name} arm {stage + 1}{word}", cut(arm, *holes))
        shaft(f"Mid shaft {stage + 1}", middle[stage], wide + 14)
        for word in "LR":
            weld(drawing, f"Mid shaft {stage + 1}", f"Inner arm {stage + 1}{word}")
            point = upright_at(middle[stage], wide if word == "L" else -wide)
            drawing.joint("Revolute", f"Mid shaft {stage + 1}", f"Outer arm {stage + 1}{word}", point, Y)
    shaft("Pivot shaft bottom", left[0], wide + 14)
    shaft("Joint shaft A", left[1], wide + 14)
    shaft("Joint shaft B", right[1], wide + 14)
    shaft("Pivot shaft top", left[2], wide)
    shaft("Slide shaft bottom", right[0], wide + 38)
    shaft("Slide shaft top", right[2], wide + 38)
    weld(drawing, "Pivot shaft bottom", "Outer arm 1L", "Outer arm 1R")
    weld(drawing, "Slide shaft top", "Outer arm 2L", "Outer arm 2R")
    for name, arm in (("Slide shaft bottom", 1), ("Joint shaft A", 1), ("Joint shaft B", 2), ("Pivot shaft top", 2)):
        weld(drawing, f"Inner arm {arm}L", name)
    drawing.joint("Revolute", "Base", "Pivot shaft bottom", upright_at(left[0], 0), Y)
    drawing.joint("Revolute", "Platform", "Pivot shaft top", upright_at(left[2], 0), Y)
    for side, word in ((1, "L"), (-1, "R")):
        drawing.joint("Revolute", "Joint shaft A", f"Outer arm 2{word}", upright_at(left[1], side * wide), Y)
        drawing.joint("Revolute", "Joint shaft B", f"Outer arm 1{word}", upright_at(right[1], side * wide), Y)
        for place, p, plane in (("bottom", right[0], "Base"), ("top", right[2], "Platform")):
            z, near, far = p[1], side * (wide + 18), side * (wide + 40)
            block = box((p[0] - 22, near, z - 12), (p[0] + 22, far, z + 12)).edges("|Y").chamfer(2)
            block = cut(block, bore(upright_at(p, 0), Y, 8 + play))
            channel = box((0.4 * long, near, z - 18.3), (long + 50, far + side * 6.3, z + 18.3))
            channel = channel.cut(box((0, near - side, z - 12.3), (long + 99, far + side * 0.3, z + 12.3)))
            drawing.add(f"Slide block {place} {word}", block)
            drawing.add(f"C channel {place} {word}", channel)
            weld(drawing, plane, f"C channel {place} {word}")
            drawing.joint("Revolute", f"Slide shaft {place}", f"Slide block {place} {word}", upright_at(p, near), Y)
            drawing.joint(
                "Prismatic", f"C channel {place} {word}", f"Slide block {place} {word}", upright_at(p, near), (1, 0, 0)
            )
    gap = float(np.linalg.norm(middle[1] - foot))
    barrel, rod = ram(upright_at(foot, 0), upright_at(middle[1], 0), Y, 16, 10, 8, 40, 0.62 * gap, 10)
    drawing.add("Cylinder barrel", barrel)
    drawing.add("Cylinder rod", cut(rod, bore(upright_at(middle[1], 0), Y, 8 + play, 40)))
    drawing.add("Cylinder pin", cyl(upright_at(foot, -34), Y, 10, 68))
    weld(drawing, "Base", "Cylinder pin")
    drawing.joint("Revolute", "Cylinder pin", "Cylinder barrel", upright_at(foot, 0), Y)
    drawing.joint("Revolute", "Mid shaft 2", "Cylinder rod", upright_at(middle[1], 0), Y)
    way = upright_at(middle[1] - foot, 0)
    drawing.joint("Cylindrical", "Cylinder barrel", "Cylinder rod", upright_at(foot, 0), way)
    return drawing
