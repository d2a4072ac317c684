"""Things of every day: a lid on a gas spring, a printed box, a chain, cranks with pedals."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import hollow
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
    tube,
    union,
)  # fmt: skip


@kind
def gas_spring_lid(random):
    """A chest whose lid turns on two rolled hinges and is held by a gas spring between ball studs."""
    drawing, play = Drawing(["chest"]), random.choice([0.05, 0.15])
    axis = at(0, -4, 101)
    low, high = at(120, random.uniform(140, 160), 30), at(120, 60, 80)
    way = (high - low) / np.linalg.norm(high - low)
    long = float(np.linalg.norm(high - low))
    pilots = [at(x + dx, 0, z) for x in (-90, 60) for dx in (-10, 10) for z in (75, 120)]
    chest = cut(box((-150, 0, 0), (150, 200, 100)), box((-135, 15, 15), (135, 185, 120)), bore(low + 30 * X, X, 3, 18))
    drawing.add("chest", cut(chest, *(cyl(p, Y, 1.5, 10) for p in pilots)))
    feet = [at(x, y, 102) for x in (106, 118) for y in (50,)]
    lid = cut(box((-150, 0, 102), (150, 200, 130)), *(cyl(p, Y, 1.5, 10) for p in pilots))
    drawing.add("lid", cut(lid, *(cyl(p, Z, 1.5, 10) for p in feet)))
    for name, x in (("left", -90), ("right", 60)):
        mine = [p for p in pilots if abs(p[0] - x) < 20]
        for leaf, ends, spans in (("a", (60, 95), [(-25, -8.2), (8.2, 25)]), ("b", (107, 128), [(-8, 8)])):
            sheet = box((x - 25, -2, ends[0]), (x + 25, 0, ends[1]))
            ends = (80, 101) if leaf == "a" else (101, 110)
            webs = [box((x + u, -2, ends[0]), (x + v, 0, ends[1])) for u, v in spans]
            rolls = [cyl(axis + (x + u) * X, X, 4, v - u) for u, v in spans]
            inner = 2 if leaf == "a" else 2 + play
            shape = cut(union(sheet, *webs, *rolls), bore(axis + x * X, X, inner, 60))
            drawing.add(f"{name} leaf {leaf}", cut(shape, *(bore(p, Y, 1.75, 5) for p in mine)))
        drawing.add(f"{name} hinge pin", cyl(axis + (x - 25) * X, X, 2, 50))
        if name == "left":
            for number, p in enumerate(mine):
                drawing.add(f"wood screw {number}", screw(p - 2 * Y, Y, 1.5, 11))
    bracket = union(box((100, 40, 99), (131, 70, 102)), box((128, 40, 68), (131, 70, 102)))
    drawing.add("bracket", cut(bracket, bore(high, X, 3, 30), *(bore(p, Z, 1.75, 5) for p in feet)))
    for number, p in enumerate(feet):
        drawing.add(f"bracket screw {number}", screw(p - 3 * Z, Z, 1.5, 10))
    for name, middle, reach in (("chest", low, 30), ("lid", high, 14)):
        wall = 15 if name == "chest" else 8
        ball = union(sphere(middle, 5), cyl(middle, X, 2.5, wall), cyl(middle + wall * X, X, 3, reach - wall))
        drawing.add(f"{name} stud", union(ball, cyl(middle + (wall - 2) * X, X, 6, 2)))
    drawing.add("stud nut", hexagon(high + 11 * X, X, 4, 3, 3))
    for name, middle in (("chest", low), ("lid", high)):
        socket = cyl(middle - 7 * X, X, 8, 10)
        if name == "chest":
            socket = union(socket, cyl(middle + 6 * way, way, 3, 14))
        else:
            socket = union(socket, cyl(low + 40 * way, way, 3, long - 46), cyl(low + 36 * way, way, 6.5, 4))
        drawing.add("fitting" if name == "chest" else "rod", cut(socket, sphere(middle, 5 + play / 2)))
    tank = cut(cyl(low + 14 * way, way, 7.5, 50), cyl(low + 22 * way, way, 6.5, 36), cyl(low, way, 3, 90))
    drawing.add("tank", tank)
    drawing.joint("Weld", "left leaf a", "chest")
    drawing.joint("Weld", "left leaf b", "lid")
    drawing.joint("Weld", "right leaf b", "lid")
    drawing.joint("Weld", "bracket", "lid")
    drawing.joint("Revolute", "lid", "chest", axis, X)
    drawing.joint("Weld", "fitting", "tank")
    drawing.joint("Spherical", "fitting", "chest", low)
    drawing.joint("Spherical", "rod", "lid", high)
    drawing.joint("Cylindrical", "rod", "tank", low, way)
    return drawing


@kind
def printed_box(random):
    """A printed box: a lid on a screw with its nut in a pocket, a turning latch, a board on posts, a cable gland."""
    drawing, play = Drawing(["box"]), random.choice([0.1, 0.25])
    wide = random.uniform(35, 45)
    axis, hook = at(0, -6, 46), at(0, 60, 30)
    posts = [at(x, y, 0) for x in (-25, 25) for y in (10, 45)]
    shell = cut(box((-wide, 0, 0), (wide, 60, 40)), box((3 - wide, 3, 3), (wide - 3, 57, 50)))
    ears = [union(box((x, -12, 30), (x + 6, 0, 46)), cyl((x, -6, 46), X, 6, 6)) for x in (-20, 14)]
    pillars = [cyl(p + 2 * Z, Z, 4, 8) for p in posts]
    shell = union(shell, *ears, *pillars, cyl(hook - Y, Y, 3, 6))
    pocket = hexagon((18, -6, 46), X, 2.85, 5)
    shell = cut(
        shell, bore(axis, X, 1.5 + play / 2), pocket, cyl(hook - 4 * Y, Y, 1.25, 20), bore((wide, 30, 26), X, 6, 8)
    )
    drawing.add("box", cut(shell, *(cyl(p + 4 * Z, Z, 1.25, 8) for p in posts)))
    lid = union(
        box((-wide, 0, 40.2), (wide, 60, 44)), box((-13.8, -8, 41), (13.8, 4, 44)), cyl((-13.8, -6, 46), X, 5, 27.6)
    )
    drawing.add("lid", cut(lid, bore(axis, X, 1.5 + play)))
    drawing.add("hinge screw", screw((-20, -6, 46), X, 1.5, 40))
    drawing.add("hinge nut", hexagon((18, -6, 46), X, 2.75, 2, 1.5))
    latch = cut(laid_bar(hook), bore(hook, Y, 3 + play))
    drawing.add("latch", latch)
    drawing.add("latch washer", tube(hook + 5 * Y, Y, 1.6, 5, 0.8))
    drawing.add("latch screw", screw(hook + 5.8 * Y, -Y, 1.5, 8))
    board = cut(box((-30, 6, 10), (30, 50, 11.6)), *(bore(p, Z, 1.6) for p in posts))
    drawing.add("board", board)
    for number, p in enumerate(posts):
        drawing.add(f"board screw {number}", screw(p + 11.6 * Z, -Z, 1.5, 7))
    drawing.add("chip", box((-8, 20, 11.6), (8, 34, 14)))
    gland = union(
        hexagon((wide, 30, 26), X, 9, 5), cyl((wide - 10, 30, 26), X, 6, 10), cyl((wide + 5, 30, 26), X, 8, 9)
    )
    drawing.add("gland", cut(gland, bore((wide, 30, 26), X, 3, 40)))
    drawing.add("gland nut", hexagon((wide - 8, 30, 26), X, 9, 5, 6))
    drawing.joint("Revolute", "lid", "box", axis, X)
    drawing.joint("Revolute", "latch", "box", hook, Y)
    drawing.joint("Weld", "board", "box")
    drawing.joint("Weld", "chip", "board")
    drawing.joint("Weld", "gland", "box")
    drawing.joint("Weld", "hinge nut", "box")
    return drawing


def laid_bar(hook):
    """A bar that hangs on a pin along y, beside a wall."""
    return union(cyl(hook + 0.3 * Y, Y, 6, 4.5), box(hook + at(-6, 0.3, 0), hook + at(6, 4.8, 20)))


@kind
def roller_chain(random):
    """Inner links of plates and bushes, outer links of plates and pins, rollers, from an anchor to a hook."""
    drawing, play = Drawing(["anchor"]), random.choice([0.05, 0.1])
    pitch = random.uniform(12, 16)
    turns = np.cumsum([0, *random.uniform(-0.3, 0.3, 4)])
    pins = [at(0, 0, 0)]
    for turn in turns:
        pins.append(pins[-1] + pitch * at(np.cos(turn), np.sin(turn), 0))
    outer, inner = (5.0, 6.5), (3.2, 4.7)
    tail, nose = pins[0] - 30 * X, pins[5] + 30 * at(np.cos(turns[4]), np.sin(turns[4]), 0)
    anchor = union(*(bar(tail, pins[0], 5.5, low, high) for low, high in (outer, (-outer[1], -outer[0]))))
    anchor = union(anchor, box(tail + at(-8, -8, -10), tail + at(14, 8, 10)))
    drawing.add("anchor", cut(anchor, bore(pins[0], Z, 1.8), bore(tail - 2 * X, Z, 3)))
    for number in range(5):
        one, other = pins[number], pins[number + 1]
        if number % 2 == 0:
            for side, (low, high) in (("top", inner), ("bottom", (-inner[1], -inner[0]))):
                drawing.add(f"inner {side} {number}", bar(one, other, 5.5, low, high, [one, other], 2.6))
            for end, point in (("left", one), ("right", other)):
                drawing.add(f"{end} bush {number}", tube(point - 4.7 * Z, Z, 1.8 + play, 2.6, 9.4))
                drawing.add(f"{end} roller {number}", tube(point - 3.1 * Z, Z, 2.6 + play, 4.2, 6.2))
        else:
            for side, (low, high) in (("top", outer), ("bottom", (-outer[1], -outer[0]))):
                drawing.add(f"outer {side} {number}", bar(one, other, 5.5, low, high, [one, other], 1.8))
            for end, point in (("left", one), ("right", other)):
                drawing.add(f"{end} pin {number}", cyl(point - 7 * Z, Z, 1.8, 14))
    drawing.add("anchor pin", rivet(pins[0] - 6.5 * Z, Z, 1.8, 13))
    hook = union(*(bar(pins[5], nose, 5.5, low, high) for low, high in (outer, (-outer[1], -outer[0]))))
    hook = union(hook, cyl(nose - 10 * Z, Z, 6, 20))
    drawing.add("hook", cut(hook, bore(pins[5], Z, 1.8)))
    drawing.add("hook pin", rivet(pins[5] - 6.5 * Z, Z, 1.8, 13))
    names = ["anchor", "inner top 0", "outer top 1", "inner top 2", "outer top 3", "inner top 4", "hook"]
    for one, other, point in zip(names[:-1], names[1:], pins, strict=True):
        drawing.joint("Revolute", one, other, point, Z)
    for number in (0, 2, 4):
        drawing.joint("Weld", f"inner top {number}", f"inner bottom {number}")
        drawing.joint("Revolute", f"left roller {number}", f"inner top {number}", pins[number], Z)
    for number in (1, 3):
        drawing.joint("Weld", f"outer top {number}", f"outer bottom {number}")
    return drawing


@kind
def crank_set(random):
    """A cartridge in a shell, cranks on its square ends, a chain ring on sleeve nuts, pedals on threaded spindles."""
    drawing, play = Drawing(["shell"]), random.choice([0.05, 0.15])
    long = random.uniform(160, 175)
    drawing.add(
        "shell", union(tube((0, -34, 0), Y, 17, 20, 68), cyl((19, 0, 0), X, 14, 120).cut(bore(0 * X, Y, 18, 60)))
    )
    drawing.add("cartridge", union(tube((0, -34, 0), Y, 9, 17, 68), tube((0, 34, 0), Y, 9, 19, 3)))
    square = [box((-6.5, y, -6.5), (6.5, y + 14 * np.sign(y), 6.5)) for y in (-48, 48)]
    spindle = union(cyl((0, -48, 0), Y, 9, 96), *square)
    drawing.add("spindle", cut(spindle, cyl((0, -62, 0), Y, 4, 20), cyl((0, 62, 0), -Y, 4, 20)))
    wells = hollow(0 * X, Y, 32, 4, np.pi / 4)
    for side, name in ((1, "right"), (-1, "left")):
        end, y = at(0, 0, -side * long), side * 48
        arm = union(*(cyl(p + (y if side > 0 else y - 14) * Y, Y, r, 14) for p, r in ((0 * X, 17), (end, 14))))
        arm = union(arm, box((-10, y, 0), (10, y + 14 * side, end[2])))
        if side > 0:
            spider = union(*(box((-8, y, -8), (8, y + 4, 40)).rotate((0, 0, 0), (0, 1, 0), _angle(p)) for p in wells))
            arm = cut(union(arm, spider), *(bore(p + 50 * Y, Y, 5, 8) for p in wells))
        drawing.add(f"{name} crank", cut(arm, square[0 if side < 0 else 1], bore(end, Y, 7)))
        drawing.add(f"{name} crank screw", screw((0, side * 62, 0), -side * Y, 4, 18))
        pedal = end + (y + 14 * side) * Y
        out = side * Y
        axle = union(cyl(pedal - 14 * out, out, 7, 14), cyl(pedal, out, 8, 4), cyl(pedal + 4 * out, out, 5, 70))
        drawing.add(f"{name} pedal spindle", axle)
        body = box(pedal + at(-45, 0, -8), pedal + at(45, 0, 8) + 72 * out).translate(tuple((5 * out).tolist()))
        drawing.add(f"{name} pedal", cut(body, cyl(pedal, out, 7, 67), cyl(pedal + 66 * out, out, 9, 40)))
        drawing.add(f"{name} pedal bush", tube(pedal + 5 * out, out, 5 + play, 7, 15))
        drawing.add(f"{name} pedal bearing", tube(pedal + 59 * out, out, 5, 7, 7))
        drawing.add(f"{name} pedal nut", hexagon(pedal + 66.5 * out, out, 7, 5, 5))
    ring = cut(tube((0, 44, 0), Y, 27, 60, 4), *(bore(p + 46 * Y, Y, 5, 4) for p in wells))
    drawing.add("chain ring", ring)
    for number, p in enumerate(wells):
        drawing.add(f"sleeve {number}", union(tube(p + 44 * Y, Y, 4, 5, 7), tube(p + 42.5 * Y, Y, 4, 7, 1.5)))
        drawing.add(f"ring screw {number}", headed(p + 52 * Y, -Y, 4, 9))
    drawing.joint("Weld", "cartridge", "shell")
    drawing.joint("Revolute", "spindle", "cartridge", 0 * X, Y)
    drawing.joint("Weld", "right crank", "spindle")
    drawing.joint("Weld", "left crank", "spindle")
    drawing.joint("Weld", "chain ring", "right crank")
    drawing.joint("Revolute", "right pedal", "right crank", at(0, 0, -long), Y)
    drawing.joint("Revolute", "left pedal", "left crank", at(0, 0, long), Y)
    return drawing


def _angle(point) -> float:
    """Degrees about y from z to a point of the plane zx."""
    return float(np.degrees(np.arctan2(point[0], point[2])))
