"""Robots and printers that people publish: a delta robot, a rocker-bogie, a platform's leg, a filament feeder."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import ball_bearing
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, screw, sphere, tube, union


def ball_stud(root, middle, shank: float, ball: float):
    """A ball on a shank that begins at the root."""
    way = np.asarray(middle, float) - root
    return union(cyl(root, way, shank, float(np.linalg.norm(way))), sphere(middle, ball))


@kind
def delta_robot(random):
    """Three arms clamped on motor shafts, six rods with sockets on ball studs, an effector with its nozzle."""
    drawing, play, dip = Drawing(["base"]), random.choice([0.0, 0.1]), random.uniform(0.2, 0.7)
    reach, rod, inner = 80.0, random.uniform(170, 200), 35.0
    hub, tip = at(70, 0, -21), at(70 + reach * np.cos(dip), 0, -21 - reach * np.sin(dip))
    low = tip[2] - np.sqrt(rod**2 - (tip[0] - inner) ** 2)
    foot = at(inner, 0, low)

    def turned(shape, t: int):
        return shape.rotate((0, 0, 0), (0, 0, 1), 120.0 * t)

    base, effector = cyl((0, 0, 0), Z, 105, 6), cyl((0, 0, low - 4), Z, 24, 8)
    base = cut(base, bore(0 * X, Z, 20, 20))
    for t in range(3):
        spoke = union(box((15, -7, low - 4), (35, 7, low + 4)), cyl(foot - 22 * Y, Y, 5, 44))
        effector = union(effector, turned(cut(spoke, *(cyl(foot + s * 14 * Y, s * Y, 2, 9) for s in (-1, 1))), t))
        base = cut(base, *(turned(bore((x, -5, 3), Z, 1.6, 20), t) for x in (62, 78)))
    effector = cut(effector, bore((0, 0, low), Z, 3, 20))
    drawing.add("base", base)
    drawing.add("effector", effector)
    drawing.add("nozzle", cyl((0, 0, low - 25), Z, 3, 29).union(hexagon((0, 0, low - 9), Z, 5, 5)))
    drawing.joint("Weld", "nozzle", "effector")
    for t in range(3):
        bracket = union(box((45, -12, -44), (95, -8, 0)), box((57, -8, -4), (83, -2, 0)))
        corners = [hub + at(sx * 15.5, -12, sz * 15.5) for sx in (-1, 1) for sz in (-1, 1)]
        bracket = cut(bracket, bore(hub, Y, 11.1, 40), *(bore(p, Y, 1.6, 6) for p in corners))
        drawing.add(f"bracket {t}", turned(cut(bracket, *(bore((x, -5, 0), Z, 1.25, 6) for x in (62, 78))), t))
        motor = union(box((49, -50, -42), (91, -12, 0)), cyl(hub - 12 * Y, Y, 11, 2))
        motor = cut(motor, cyl(hub - 46 * Y, Y, 2.55, 60), *(cyl(p, -Y, 1.25, 6) for p in corners))
        drawing.add(f"motor {t}", turned(motor, t))
        drawing.add(f"shaft {t}", turned(cyl(hub - 46 * Y, Y, 2.5, 54), t))
        for k, p in enumerate(corners):
            drawing.add(f"motor screw {t} {k}", turned(screw(p + 4 * Y, -Y, 1.5, 8), t))
        for k, x in enumerate((62, 78)):
            drawing.add(f"bracket screw {t} {k}", turned(screw((x, -5, 6), -Z, 1.5, 10), t))
        way = (tip - hub) / reach
        arm = union(cyl(hub - 6 * Y, Y, 9, 14), cyl(hub, way, 4.5, reach), cyl(tip - 22 * Y, Y, 5, 44))
        arm = cut(arm, bore(hub, Y, 2.5, 20), *(cyl(tip + s * 14 * Y, s * Y, 2, 9) for s in (-1, 1)))
        drawing.add(f"arm {t}", turned(cut(arm, cyl(hub + 5 * Y, -way, 1.5, 20)), t))
        drawing.add(f"grub screw {t}", turned(cyl(hub + 5 * Y - 2.5 * way, -way, 1.5, 6), t))
        turn = np.radians(120.0 * t)
        round_z = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        for s in (-1, 1):
            one, other = tip + s * 30 * Y, foot + s * 30 * Y
            along = (other - one) / rod
            body = union(cyl(one, along, 3, rod), sphere(one, 6.5), sphere(other, 6.5))
            body = cut(body, sphere(one, 4 + play), sphere(other, 4 + play))
            for p in (one, other):
                body = cut(body, box(p + at(-9, -s * 2, -9), p + at(9, -s * 9, 9)))
            drawing.add(f"rod {t} {s}", turned(body, t))
            for name, p, owner in (("upper", one, f"arm {t}"), ("lower", other, "effector")):
                drawing.add(f"{name} stud {t} {s}", turned(ball_stud(p - s * 16 * Y, p, 2, 4), t))
                drawing.joint("Weld", f"{name} stud {t} {s}", owner)
                drawing.joint("Spherical", f"rod {t} {s}", owner, round_z @ p)
        drawing.joint("Weld", f"bracket {t}", "base")
        drawing.joint("Weld", f"motor {t}", f"bracket {t}")
        drawing.joint("Weld", f"arm {t}", f"shaft {t}")
        drawing.joint("Revolute", f"shaft {t}", f"motor {t}", round_z @ hub, round_z @ Y)
    return drawing


@kind
def rocker_bogie(random):
    """One side of a rover: a rocker on bearings in the chassis, a bogie on a shoulder screw, three driven wheels."""
    drawing, play = Drawing(["chassis"]), random.choice([0.0, 0.05, 0.1])
    o, b = at(0, 0, 0), at(-80, random.uniform(-45, -35), 0)
    wheels = {"front": at(120, -90, 0), "middle": at(-22, -90, 0), "rear": at(-138, -90, 0)}
    shell = cut(box((-70, -20, 0), (100, 60, 70)), box((-66, -16, 4), (96, 61, 66)))
    lids = [at(x, 60, z) for x in (-62, 92) for z in (8, 62)]
    shell = union(shell, cyl(o, Z, 15, 16), *(box(p + at(-4, -12, -4), p + at(4, 0, 4)) for p in lids))
    shell = cut(shell, cyl(o, Z, 11, 7), cyl(o + 9 * Z, Z, 11, 7), bore(o, Z, 9, 30))
    drawing.add("chassis", cut(shell, *(cyl(p, -Y, 1.25, 10) for p in lids)))
    lid = cut(box((-70, 60, 0), (100, 63, 70)), *(bore(p, Y, 1.7, 10) for p in lids))
    drawing.add("lid", lid)
    for k, p in enumerate(lids):
        drawing.add(f"lid screw {k}", screw(p + 3 * Y, -Y, 1.5, 10))
    for k, z in enumerate((0.0, 9.0)):
        drawing.add(f"bearing {k}", tube(o + z * Z, Z, 4, 11, 7))
    drawing.add("rocker washer", tube(o - 4 * Z, Z, 4.2, 6, 4))
    drawing.add("rocker bolt", hexagon(o - 17.3 * Z, Z, 6.5, 5.3).union(cyl(o - 12 * Z, Z, 4, 40)))
    drawing.add("end washer", tube(o + 16 * Z, Z, 4.2, 8, 1.6))
    drawing.add("lock nut", hexagon(o + 17.6 * Z, Z, 6.5, 8, 4))
    rocker = union(*(bar(o, p, 10, -12, -4) for p in (b, wheels["front"])), cyl(wheels["front"] - 12 * Z, Z, 14, 8))
    rocker = cut(rocker, bore(o, Z, 4.1, 30), bore(b, Z, 2.1, 30))
    bogie = union(*(bar(b, wheels[n], 9, -21, -13) for n in ("middle", "rear")))
    bogie = union(bogie, *(cyl(wheels[n] - 21 * Z, Z, 14, 8) for n in ("middle", "rear")))
    arms = {"rocker": rocker, "bogie": cut(bogie, bore(b, Z, 4.5, 30))}
    bush = union(tube(b - 21 * Z, Z, 3 + play, 4.5, 8), tube(b - 13 * Z, Z, 3 + play, 7, 1))
    drawing.add("bogie bush", bush)
    drawing.add("shoulder screw", union(cyl(b - 25 * Z, Z, 5, 4), cyl(b - 21 * Z, Z, 3, 9), cyl(b - 12 * Z, Z, 2.5, 8)))
    for name, w in wheels.items():
        owner, low = ("rocker", -12) if name == "front" else ("bogie", -21)
        face, spots = w + (low + 8) * Z, [w + at(0, s * 8.5, low) for s in (-1, 1)]
        arms[owner] = cut(arms[owner], bore(w, Z, 4.2, 30), *(bore(p, Z, 1.1, 20) for p in spots))
        motor = union(cyl(face, Z, 12, 34), cyl(face, -Z, 4, 3))
        motor = cut(motor, cyl(face + 30 * Z, -Z, 2.05, 40), *(cyl(p + 8 * Z, Z, 1, 6) for p in spots))
        drawing.add(f"{name} motor", motor)
        drawing.add(f"{name} shaft", cyl(face + 30 * Z, -Z, 2, 64))
        out = w + (low - 28) * Z
        rim = union(cyl(out, Z, 8, 22), tube(out, Z, 21, 24, 20), tube(out + 8 * Z, Z, 7, 22, 4))
        rim = cut(rim, cyl(out + 2 * Z, Z, 2, 40), cyl(out + 18 * Z, Y, 1.25, 10))
        drawing.add(f"{name} wheel", rim)
        drawing.add(f"{name} grub screw", cyl(out + 18 * Z + 2 * Y, Y, 1.25, 5))
        drawing.add(f"{name} tyre", tube(out, Z, 24, 30, 20))
        for k, p in enumerate(spots):
            drawing.add(f"{name} screw {k}", screw(p, Z, 1, 12))
        drawing.joint("Weld", f"{name} motor", owner)
        drawing.joint("Revolute", f"{name} shaft", f"{name} motor", w, Z)
        drawing.joint("Weld", f"{name} wheel", f"{name} shaft")
        drawing.joint("Weld", f"{name} tyre", f"{name} wheel")
    for name, shape in arms.items():
        drawing.add(name, shape)
    drawing.joint("Weld", "lid", "chassis")
    drawing.joint("Weld", "shoulder screw", "rocker")
    drawing.joint("Weld", "bogie bush", "bogie")
    drawing.joint("Revolute", "rocker", "chassis", o, Z)
    drawing.joint("Revolute", "bogie", "rocker", b, Z)
    return drawing


def yoke(middle, along, pin, foot: float):
    """A fork whose two eyes hold the cups of a cross, with its web at `foot` from the cross."""
    across, shapes = np.cross(along, pin), []
    for s in (-1, 1):
        corner = middle + s * 12 * pin - 9 * across
        shapes += [box(corner, corner + s * 8 * pin + 18 * across + foot * along)]
        shapes += [cyl(middle + s * 12 * pin, s * pin, 9, 8)]
    corner = middle - 20 * pin - 9 * across + foot * along
    shapes.append(box(corner, corner + 40 * pin + 18 * across + 6 * along))
    return cut(union(*shapes), bore(middle, pin, 6.5, 40))


@kind
def platform_leg(random):
    """A leg of a platform: universal joints with needle cups below and above a cylinder, its rod and gland."""
    drawing, play, height = Drawing(["base"]), random.choice([0.0, 0.02]), random.uniform(225, 270)
    low, high = at(0, 0, 32), at(0, 0, height)
    plates = {"base": (low, -Z, -10.0), "platform": (high, Z, height + 28 + 6)}
    for name, (p, way, z) in plates.items():
        spots = [at(s * 25, t * 12, 0) for s in (-1, 1) for t in (-1, 1)]
        plate = box((-60, -60, z), (60, 60, z + 10)).edges("|Z").fillet(12)
        depth = 8 if name == "base" else 30
        face = 0.0 if name == "base" else z
        drawing.add(name, cut(plate, *(cyl(q + face * Z, way, 2, depth) for q in spots)))
        fork = yoke(p, way, X, 28 - 2 * (name == "base"))
        flange = box(at(-32, -18, 0) + face * Z, at(32, 18, 0) + (face - 6 * way[2]) * Z)
        fork = cut(union(fork, flange), *(cyl(q + (face - 40 * way[2]) * Z, way, 2.6, 60) for q in spots))
        drawing.add(f"{name} yoke", fork)
        for k, q in enumerate(spots):
            drawing.add(f"{name} screw {k}", screw(q + (face - 6 * way[2]) * Z, way, 2.5, 6 + min(depth, 8)))
        drawing.joint("Weld", f"{name} yoke", name)
    for name, p in (("lower", low), ("upper", high)):
        trunnions = [cyl(p - 19.1 * a, a, 4, 38.2) for a in (X, Y)]
        drawing.add(f"{name} cross", union(box(p - 7, p + 7), *trunnions))
        for a, letter in ((X, "x"), (Y, "y")):
            for s in (-1, 1):
                cup = cut(cyl(p + s * 12 * a, s * a, 6.5, 8), cyl(p + s * 11 * a, s * a, 4 + play, 8.2))
                drawing.add(f"{name} cup {letter} {s}", cup)
    body = union(yoke(low, Z, Y, 24), cyl(low + 30 * Z, Z, 20, 110))
    drawing.add("cylinder", cut(body, cyl(low + 36 * Z, Z, 15, 200)))
    drawing.add("piston", cut(cyl((0, 0, height - 130), Z, 15 - play, 12), bore(0 * X, Z, 5, 400)))
    head = low[2] + 140
    gland = union(tube((0, 0, head - 12), Z, 8 + play, 15, 12), tube((0, 0, head), Z, 8 + play, 20, 6))
    drawing.add("gland", cut(gland, tube((0, 0, head + 2), Z, 8, 10, 5)))
    drawing.add("wiper ring", tube((0, 0, head + 2), Z, 8, 10, 4))
    rod = union(
        cyl((0, 0, height - 118), Z, 8, 80), cyl((0, 0, height - 138), Z, 5, 20), cyl((0, 0, height - 38), Z, 6, 12)
    )
    drawing.add("rod", rod)
    drawing.add("piston nut", hexagon((0, 0, height - 138), Z, 8, 8, 5))
    top = yoke(high, -Z, Y, 18)
    drawing.add("rod yoke", cut(union(top, cyl(high - 32 * Z, Z, 10, 10)), cyl(high - 40 * Z, Z, 6, 14)))
    drawing.add("rod lock nut", hexagon(high - 38 * Z, Z, 9, 6, 6))
    drawing.joint("Revolute", "lower cross", "base yoke", low, X)
    drawing.joint("Revolute", "lower cross", "cylinder", low, Y)
    drawing.joint("Revolute", "upper cross", "platform yoke", high, X)
    drawing.joint("Revolute", "upper cross", "rod yoke", high, Y)
    drawing.joint("Cylindrical", "rod", "cylinder", low, Z)
    drawing.joint("Weld", "rod yoke", "rod")
    drawing.joint("Weld", "piston", "rod")
    drawing.joint("Weld", "gland", "cylinder")
    return drawing


@kind
def filament_feeder(random):
    """A hobbed gear on a stepper motor, an idler on a lever about one of the motor's screws, a spring, a coupler."""
    drawing, play = Drawing(["motor"]), random.choice([0.05, 0.15])
    motor = union(box((-21, -21, -38), (21, 21, 0)).edges("|Z").chamfer(3), cyl((0, 0, 0), Z, 11, 2))
    corners = [at(sx * 15.5, sy * 15.5, 0) for sx in (-1, 1) for sy in (-1, 1)]
    pivot = at(15.5, -15.5, 0)
    motor = cut(motor, cyl((0, 0, -34), Z, 2.55, 60), *(cyl(p, -Z, 1.25, 8) for p in corners))
    drawing.add("motor", motor)
    drawing.add("shaft", cyl((0, 0, -34), Z, 2.5, 56))
    x, idler = 6.4, at(6.4 + 0.9 + 5, 0, 0)
    body = [box((-21, -21, 0), (21, 21, 5)), box((10, 20, 0), (36, 34, 5)), box((30, 22, 5), (36, 34, 20))]
    body += [box((3, 10, 5), (10, 21, 18)), box((3, -21, 5), (10, -10, 18))]
    holes = [bore((0, 0, 0), Z, 11.1, 10), bore((x, 0, 13), Y, 1, 60), cyl((x, 15, 13), Y, 3, 20)]
    holes += [bore((33, 28, 13), X, 1.7, 10)]
    for p in corners:
        holes += [bore(p, Z, 1.6, 20), *([] if p is corners[2] else [cyl(p + 1.5 * Z, Z, 2.8, 10)])]
    drawing.add("body", cut(union(*body), *holes))
    for k, p in enumerate(corners):
        if k != 2:
            drawing.add(f"screw {k}", screw(p + 1.5 * Z, -Z, 1.5, 8))
    gear = cut(cyl((0, 0, 6), Z, 5.5, 13), bore((0, 0, 6), Z, 2.5, 40), cyl((0, 0, 8), -X, 1.5, 9))
    drawing.add("hobbed gear", gear)
    drawing.add("grub screw", cyl((-2.5, 0, 8), -X, 1.5, 3))
    end = at(17, 26, 0)
    lever = [bar(p, q, 3.7, low, low + 4) for p, q in ((pivot, idler), (idler, end)) for low in (6, 16)]
    lever += [cyl(pivot + 6 * Z, Z, 4.5, 14), box((13, 24, 6), (21, 32, 20))]
    lever = cut(union(*lever), bore(pivot, Z, 1.5 + play, 60), bore(idler, Z, 1.5, 60), cyl((30, 28, 13), -X, 2.2, 14))
    drawing.add("lever", lever)
    drawing.add("pivot washer", tube(pivot + 5 * Z, Z, 1.6, 3, 1))
    drawing.add("pivot screw", screw(pivot + 20 * Z, -Z, 1.5, 26))
    drawing.add("idler pin", cyl(idler + 6 * Z, Z, 1.5, 14))
    ball_bearing(drawing, "idler", idler + 11 * Z, Z, 1.5, 5, 4)
    for k, z in enumerate((10, 15)):
        drawing.add(f"idler washer {k}", tube(idler + z * Z, Z, 1.6, 2.3, 1))
    drawing.add("spring", tube((21, 28, 13), X, 2.3, 4, 9))
    drawing.add("tension screw", screw((36, 28, 13), -X, 2, 13))
    coupler = union(cyl((x, 15, 13), Y, 3, 6), hexagon((x, 21, 13), Y, 5, 6))
    drawing.add("coupler", cut(coupler, bore((x, 15, 13), Y, 1, 60)))
    drawing.add("filament", cyl((x, -60, 13), Y, 0.875, 140))
    drawing.add("motor cable", cyl((0, -21, -30), -Y, 2.5, 40))
    drawing.joint("Weld", "body", "motor")
    drawing.joint("Revolute", "shaft", "motor", (0, 0, 0), Z)
    drawing.joint("Weld", "hobbed gear", "shaft")
    drawing.joint("Revolute", "lever", "body", pivot, Z)
    drawing.joint("Weld", "pivot screw", "motor")
    drawing.joint("Weld", "idler pin", "lever")
    drawing.joint("Revolute", "idler outer ring", "lever", idler, Z)
    drawing.joint("Weld", "coupler", "body")
    return drawing
