"""What is pulled out, pressed and cut with: a hatch on an electric cylinder, a tripod, garden shears."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import (
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
    rivet,
    screw,
    sphere,
    torus,
    tube,
    union,
)  # fmt: skip


@kind
def electric_cylinder(random):
    """A hatch on two butt hinges, a screw cylinder between clevises with pins: motor beside, nut in the inner tube."""
    drawing, play = Drawing(["frame"]), random.choice([0.05, 0.15])
    hinge, foot, eye = at(0, 200, 0), at(-40, -random.uniform(100, 120), 0), at(90, 186, 0)
    way, long = (eye - foot) / np.linalg.norm(eye - foot), float(np.linalg.norm(eye - foot))
    pilots = [at(-20, y, z) for y in (170, 185) for z in (-70, -50, 50, 70)]
    frame = union(box((-40, -160, -90), (-20, 190, 90)), box((-40, -160, -90), (120, -140, 90)))
    lugs = [box(foot + at(-10, -50, s * 11 - 2), foot + at(10, 8, s * 11 + 2)) for s in (1, -1)]
    frame = cut(frame, box((-41, -135, -45), (-19, 160, 45)))
    frame = cut(union(frame, *lugs), bore(foot, Z, 5), *(bore(p, X, 2, 12) for p in pilots))
    wells = [at(x, 210, z) for x in (15, 30) for z in (-70, -50, 50, 70)]
    hatch = cut(box((5, 202, -90), (150, 214, 90)), *(cyl(p - 8 * Y, Y, 2, 8) for p in wells))
    feet = [eye + at(x, 16, z) for x in (-14, 14) for z in (-18, 18)]
    drawing.add("hatch", cut(hatch, *(cyl(p, Y, 2, 9) for p in feet)))
    drawing.add("frame", frame)
    for name, z in (("upper", 60), ("lower", -60)):
        axis = hinge + z * Z
        leaf_a = union(
            box((-20, 165, z - 20), (-18, 200, z + 20)).cut(box((-21, 194, z - 7), (-17, 201, z + 7))),
            *(cyl(axis + s * 13.5 * Z - 6.5 * Z, Z, 4, 13) for s in (1, -1)),
            *(box((-20, 198, z + s * 13.5 - 6.5), (0, 200, z + s * 13.5 + 6.5)) for s in (1, -1)),
        )
        drawing.add(
            f"{name} leaf a",
            cut(leaf_a, bore(axis, Z, 2.5, 30), *(bore(p, X, 2.2, 5) for p in pilots if abs(p[2] - z) < 15)),
        )
        leaf_b = union(
            box((0, 200, z - 6.8), (5, 202, z + 6.8)),
            box((5, 200, z - 20), (36, 202, z + 20)),
            cyl(axis - 6.8 * Z, Z, 4, 13.6),
        )
        drawing.add(
            f"{name} leaf b",
            cut(leaf_b, bore(axis, Z, 2.5 + play, 30), *(bore(p, Y, 2.2, 30) for p in wells if abs(p[2] - z) < 15)),
        )
        drawing.add(f"{name} hinge pin", headed(axis + 20.2 * Z, -Z, 2.5, 40))
        for number, p in enumerate(each for each in pilots if abs(each[2] - z) < 15):
            drawing.add(f"{name} screw a{number}", screw(p + 2 * X, -X, 2, 13))
        for number, p in enumerate(each for each in wells if abs(each[2] - z) < 15):
            drawing.add(f"{name} screw b{number}", screw(p - 10 * Y, Y, 2, 9))
    bracket = union(
        box(eye + at(-20, 12, -25), eye + at(20, 16, 25)),
        *(
            union(cyl(eye + (s * 10 - 2) * Z, Z, 9, 4), box(eye + at(-9, 0, s * 10 - 2), eye + at(9, 13, s * 10 + 2)))
            for s in (1, -1)
        ),
    )
    drawing.add("bracket", cut(bracket, bore(eye, Z, 5), *(bore(p, Y, 2.2, 6) for p in feet)))
    for number, p in enumerate(feet):
        drawing.add(f"bracket screw {number}", screw(p - 4 * Y, Y, 2, 12))
    for name, p, half in (("rear", foot, 13), ("front", eye, 12)):
        pin = headed(p + half * Z, -Z, 5, 2 * half + 6).cut(bore(p - (half + 3) * Z, X, 1, 10))
        drawing.add(f"{name} pin", pin)
        drawing.add(
            f"{name} split pin",
            cyl(p + at(-8, 0, -half - 3), X, 1, 16).union(torus(p + at(10.5, 0, -half - 3), Z, 2.5, 0.9)),
        )
    side = np.cross(Z, way)
    rear = cut(
        union(cyl(foot - 8.5 * Z, Z, 11, 17), cyl(foot + 6 * way, way, 8, 20), cyl(foot + 22 * way, way, 18, 8)),
        bore(foot, Z, 5 + play),
    )
    box_end = cut(
        union(
            rear,
            cyl(foot + 30 * way, way, 22, 30),
            cyl(foot + 30 * way + 38 * side, way, 20, 30),
            cyl(foot + 30 * way + 19 * side, way, 19, 30),
        ),
        cyl(foot + 32 * way, way, 11, 8),
        cyl(foot + 40 * way, way, 15, 20),
        cyl(foot + 50 * way, way, 18, 20),
        cyl(foot + 40 * way + 38 * side, way, 16, 20),
    )
    drawing.add("gear case", box_end)
    drawing.add(
        "motor", union(cyl(foot + 40 * way + 38 * side, way, 16, 90), cyl(foot + 130 * way + 38 * side, way, 4, 4))
    )
    drawing.add("spindle bearing", tube(foot + 32 * way, way, 5, 11, 8))
    spindle = union(
        cyl(foot + 32 * way, way, 5, 8), cyl(foot + 40 * way, way, 6, 160), cyl(foot + 40 * way, way, 10, 6)
    )
    drawing.add("spindle", spindle)
    drawing.add("outer tube", tube(foot + 50 * way, way, 15, 18, 150))
    drawing.add(
        "guide bush",
        union(tube(foot + 180 * way, way, 11 + play, 15, 20), tube(foot + 200 * way, way, 11 + play, 18, 4)),
    )
    drawing.add("inner tube", tube(foot + 70 * way, way, 9, 11, long - 100))
    drawing.add("nut", union(tube(foot + 66 * way, way, 6, 14.8, 4), tube(foot + 70 * way, way, 6, 9, 20)))
    end = union(
        cyl(eye - 7.5 * Z, Z, 10, 15),
        cyl(eye - 30 * way, way, 11, 8),
        cyl(eye - 24 * way, way, 7, 20),
        cyl(eye - 50 * way, way, 9, 25),
    )
    drawing.add("eye", cut(end, bore(eye, Z, 5 + play)))
    for each in ("upper", "lower"):
        drawing.joint("Weld", f"{each} leaf a", "frame")
        drawing.joint("Weld", f"{each} leaf b", "hatch")
    drawing.joint("Revolute", "hatch", "frame", hinge, Z)
    drawing.joint("Weld", "bracket", "hatch")
    drawing.joint("Revolute", "gear case", "frame", foot, Z)
    drawing.joint("Revolute", "eye", "bracket", eye, Z)
    drawing.joint("Weld", "motor", "gear case")
    drawing.joint("Weld", "outer tube", "gear case")
    drawing.joint("Revolute", "spindle", "gear case", foot, way)
    drawing.joint("Cylindrical", "nut", "spindle", foot, way)
    drawing.joint("Weld", "inner tube", "nut")
    drawing.joint("Weld", "eye", "inner tube")
    drawing.joint("Cylindrical", "inner tube", "outer tube", foot, way)
    return drawing


def clamp_ear(ear, square, across):
    """The ear of a clamp, on its collar."""
    return cyl(ear - 5 * across, across, 5, 10).union(cyl(ear - 6 * square - 5 * across, across, 5, 10))


@kind
def tripod(random):
    """Three legs on bolts in a crown, tubes that telescope through clamps with levers, feet on balls, a column."""
    drawing, play = Drawing(["crown"]), random.choice([0.1, 0.2])
    spread, drawn = random.uniform(0.35, 0.5), random.uniform(60, 100)
    crown, count = tube((0, 0, -10), Z, 12 + play / 2, 26, 24), 3
    bores, lugs = [], []
    for number in range(count):
        turn = 2 * np.pi * number / count
        out, across = at(np.cos(turn), np.sin(turn), 0), at(-np.sin(turn), np.cos(turn), 0)
        hip = 34 * out
        way = np.sin(spread) * out - np.cos(spread) * Z
        square = np.cross(across, way)
        for s in (1, -1):
            low = hip + (s * 10 - 3) * across
            web = cyl(low, across, 8, 6).union(cyl(low, across, 8, 6).translate(tuple((-10 * out).tolist())))
            lugs.append(union(web, cyl(low - 4 * out + 0 * Z, across, 8, 6)))
        bores.append(bore(hip, across, 4, 20))
        top = union(
            cyl(hip - 6.8 * across, across, 8, 13.6), cyl(hip + 6 * way, way, 6.5, 14), cyl(hip + 18 * way, way, 12, 12)
        )
        drawing.add(f"leg top {number}", cut(top, bore(hip, across, 4 + play, 40), cyl(hip + 22 * way, way, 11, 30)))
        drawing.add(f"hip bolt {number}", screw(hip - 13 * across, across, 4, 32))
        drawing.add(f"hip nut {number}", hexagon(hip + 13 * across, across, 6.5, 5, 4))
        drawing.add(f"upper tube {number}", tube(hip + 22 * way, way, 9.5, 11, 180))
        start = hip + (202 - drawn) * way
        drawing.add(f"lower tube {number}", tube(start, way, 7, 8.5, 190))
        drawing.add(f"glide {number}", tube(start, way, 8.5, 9.5 - play / 2, 8))
        collar = union(tube(hip + 196 * way, way, 11, 14, 6), tube(hip + 202 * way, way, 8.5 + play, 14, 16))
        ear = hip + 210 * way + 20 * square
        collar = collar.union(clamp_ear(ear, square, across)).cut(cyl(hip + 190 * way, way, 8.5 + play, 40))
        slit = cyl(ear - 0.75 * across, across, 9, 1.5)
        drawing.add(
            f"clamp {number}", cut(collar, bore(ear, across, 2, 20), slit.cut(cyl(hip + 190 * way, way, 9, 60)))
        )
        drawing.add(f"clamp pin {number}", rivet(ear - 8.2 * across, across, 2, 16.4))
        lever = union(
            *(cyl(ear + (s * 6.6 - 1.5) * across, across, 6.5, 3) for s in (1, -1)),
            cyl(ear - 8.1 * across + 8.8 * square, across, 3.5, 16.2),
        )
        drawing.add(f"clamp lever {number}", cut(lever, bore(ear, across, 2 + play / 2, 20)))
        end = start + 200 * way
        ball = union(cyl(start + 170 * way, way, 7, 20), cyl(start + 190 * way, way, 4, 10), sphere(end, 6))
        drawing.add(f"ball plug {number}", ball)
        pad = cut(cyl(end - 2.5 * Z, -Z, 14, 10).union(cyl(end + 1.5 * Z, -Z, 9, 8)), sphere(end, 6 + play / 4))
        drawing.add(f"foot {number}", pad)
        drawing.joint("Revolute", f"leg top {number}", "crown", hip, across)
        drawing.joint("Weld", f"upper tube {number}", f"leg top {number}")
        drawing.joint("Weld", f"clamp {number}", f"upper tube {number}")
        drawing.joint("Cylindrical", f"lower tube {number}", f"upper tube {number}", hip, way)
        drawing.joint("Weld", f"ball plug {number}", f"lower tube {number}")
        drawing.joint("Revolute", f"clamp lever {number}", f"clamp {number}", ear, across)
        drawing.joint("Spherical", f"foot {number}", f"ball plug {number}", end)
    column = cyl((0, 0, -160), Z, 12, 240)
    drawing.add("crown", cut(union(crown, *lugs), *bores, bore(0 * X, Z, 12 + play / 2)))
    drawing.add("column", cut(column, cyl((0, 0, 80), -Z, 3, 20)))
    drawing.add("plate", cut(union(cyl((0, 0, 80), Z, 30, 6)), bore((0, 0, 80), Z, 3)))
    drawing.add(
        "camera screw", screw((0, 0, 83), -Z, 3, 18).cut(tube((0, 0, 83), Z, 6, 7, 7)).union(cyl((0, 0, 83), Z, 4, 1))
    )
    drawing.parts["plate"] = drawing.parts["plate"].cut(cyl((0, 0, 83), Z, 6, 4))
    drawing.joint("Cylindrical", "column", "crown", (0, 0, 0), Z)
    drawing.joint("Weld", "plate", "column")
    return drawing


@kind
def garden_shears(random):
    """A blade screwed to its handle, a hook in one with the other, a bolt with nut and lock plate, a catch."""
    drawing, play = Drawing(["hook"]), random.choice([0.0, 0.05, 0.1])
    pivot = at(0, 0, 0)
    opening = random.uniform(0.25, 0.4)
    down = at(-np.cos(opening), -np.sin(opening), 0)
    hook = union(
        bar(at(-110, 30, 0), at(-25, 10, 0), 9, -2, 10),
        bar(at(-25, 10, 0), pivot, 12, -2, 3),
        bar(pivot, at(50, 12, 0), 9, 0, 3),
        cyl(pivot - 2 * Z, Z, 12, 5),
    )
    catch = at(-95, 26, 0)
    hook = cut(hook, bore(pivot, Z, 4), bore(catch, Z, 2), box(catch + at(-15, -14, 2), catch + at(15, 14, 6)))
    drawing.add("hook", hook)
    holes = [22 * down, 40 * down]
    blade = cut(
        union(bar(40 * down, pivot, 10, -5.2, -2.2), bar(pivot, at(55, -10, 0), 10, -5.2, -2.2)),
        bore(pivot, Z, 4 + play),
        *(bore(p, Z, 2) for p in holes),
    )
    drawing.add("blade", blade)
    handle = cut(
        union(bar(18 * down, 120 * down, 9, -14, -5.2)), *(bore(p, Z, 2) for p in holes), cyl(pivot - 20 * Z, Z, 10, 30)
    )
    drawing.add("handle", handle)
    for number, p in enumerate(holes):
        drawing.add(
            f"blade screw {number}",
            screw(p - 2.2 * Z, -Z, 2, 14).cut(cyl(p - 2.2 * Z, Z, 1, 9)) if number else cyl(p - 2.2 * Z, -Z, 2, 11.8),
        )
    drawing.add("spacer", tube(pivot - 2.2 * Z, Z, 4.05, 8, 0.2))
    drawing.add("bolt", headed(pivot - 5.2 * Z, Z, 4, 16).union(hexagon(pivot - 8.4 * Z, Z, 6, 3.2)))
    drawing.add("nut", hexagon(pivot + 4 * Z, Z, 6.5, 5, 4))
    lock = cut(bar(pivot, at(18, 4, 0), 9, 3, 4), bore(pivot, Z, 4), bore(at(18, 4, 0), Z, 1.5))
    drawing.add("lock plate", lock)
    drawing.add("lock screw", screw(at(18, 4, 4), -Z, 1.5, 4))
    drawing.parts["hook"] = drawing.parts["hook"].cut(bore(at(18, 4, 0), Z, 1.5))
    drawing.add("catch", cut(bar(catch, catch + at(8, -20, 0), 4, 2.1, 5.9), bore(catch, Z, 2 + play)))
    drawing.add("catch rivet", rivet(catch - 2 * Z, Z, 2, 12))
    drawing.joint("Weld", "blade", "handle")
    drawing.joint("Revolute", "blade", "hook", pivot, Z)
    drawing.joint("Weld", "lock plate", "hook")
    drawing.joint("Revolute", "catch", "hook", catch, Z)
    return drawing
