"""What drives and steers: a cardan shaft, a steering knuckle, a belt tensioner."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import ball_bearing
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, screw, sphere, torus, tube, union


def yoke(middle, axis, way, arm: float, seat: float):
    """A fork around a joint's middle with bores along an axis, its stem on the far side of `way`."""
    middle, side = np.asarray(middle, float), np.cross(way, axis)
    cheeks = [cyl(middle + s * (arm - 6) * axis, s * axis, seat + 4, 6) for s in (-1, 1)]
    low = middle - (seat + 16) * way
    plane = np.array([axis, side, way]).T
    webs = [box((s * (arm - 6), -seat - 2, -seat - 12), (s * arm, seat + 2, 0)) for s in (-1, 1)]
    webs.append(box((-arm, -seat - 2, -seat - 16), (arm, seat + 2, -seat - 10)))
    webs = [laid(web, middle, plane[:, 0], plane[:, 2]) for web in webs]
    return cut(union(*cheeks, *webs), bore(middle, axis, seat)), low


@kind
def cardan_shaft(random):
    """Two universal joints with crosses in closed cups and circlips, a square shaft that slides in a square tube."""
    drawing, play, arm = Drawing(["block 1", "block 2"]), random.choice([0.02, 0.05]), 26.0
    length = random.uniform(200, 260)
    bend = random.uniform(0.15, 0.3)
    one, way = at(0, 0, 0), at(np.cos(bend), np.sin(bend), 0)
    two = one + length * way
    side = np.cross(Z, way)
    forks = {
        "yoke 1": (one, Z, X, 1.0),
        "tube": (one, side, -way, 0.0),
        "shaft": (two, side, way, 0.0),
        "yoke 2": (two, Z, -X, 1.0),
    }
    for name, (middle, axis, along, stem) in forks.items():
        shape, low = yoke(middle, axis, along, arm, 7.0)
        if stem:
            shape = union(shape, cyl(low, -along, 10, 60))
            block = union(box(low - 40 * along - at(12, 50, 25), low - 40 * along + at(12, 25, 25)))
            number = name[-1]
            drawing.add(f"block {number}", cut(block, bore(low, X, 14)))
            drawing.add(f"bush {number}", tube(low - 52 * X * along[0] - 0 * Y, along[0] * X, 10 + play, 14, 24))
            drawing.add(f"collar {number}", tube(low - 53 * along, -along, 10, 16, 6))
            drawing.add(f"shoulder {number}", tube(low - 27 * along, along, 10, 16, 6))
            for part, spot in ((f"collar {number}", low - 56 * along), (f"shoulder {number}", low - 24 * along)):
                shape = cut(shape, cyl(spot, Z, 1.5, 20))
                drawing.parts[part] = cut(drawing.parts[part], cyl(spot, Z, 1.5, 20))
                drawing.add(f"set screw {part}", cyl(spot + 5 * Z, Z, 1.5, 10))
            drawing.joint("Weld", f"bush {number}", f"block {number}")
            drawing.joint("Revolute", name, f"block {number}", middle, X)
            drawing.joint("Weld", f"collar {number}", name)
        drawing.add(name, shape)
    for name, half, start, stop in (("tube", 9, 22.5, 0.6 * length), ("shaft", 6, 0.3 * length, length - 22.5)):
        prism = laid(box((-half, -half, 0), (half, half, stop - start)), one + start * way, side, way)
        drawing.parts[name] = union(drawing.parts[name], prism)
    hole = laid(box((-6.02, -6.02, 0), (6.02, 6.02, length)), one + 25 * way, side, way)
    drawing.parts["tube"] = cut(drawing.parts["tube"], hole)
    for number, middle in (("1", one), ("2", two)):
        trunnions = [cyl(middle - (arm - 1.5) * axis, axis, 5, 2 * arm - 3) for axis in (Z, side)]
        drawing.add(f"cross {number}", union(*trunnions, sphere(middle, 9)))
        for axis, owner in ((Z, f"yoke {number}"), (side, "tube" if number == "1" else "shaft")):
            for s in (-1, 1):
                cup = cyl(middle + s * (arm - 9) * axis, s * axis, 7, 9)
                cup = cut(cup, cyl(middle + s * (arm - 10) * axis, s * axis, 5 + play, 8.5))
                label = f"cup {number} {owner} {s}"
                drawing.add(label, cup)
                drawing.joint("Weld", label, owner)
            drawing.joint("Revolute", f"cross {number}", owner, middle, axis)
    drawing.joint("Prismatic", "shaft", "tube", one, way)
    return drawing


@kind
def steering_knuckle(random):
    """Two arms on rubber bushes, ball studs with nuts, a rack, a tie rod, a hub in a bearing unit, a wheel."""
    drawing, play = Drawing(["subframe"]), random.choice([0.0, 0.1])
    balls = {"lower": at(0, 0, -60), "upper": at(0, random.uniform(-15, -5), 80)}
    inner = {"lower": at(0, -200, -60), "upper": at(0, -170, random.uniform(60, 80))}
    axle = at(0, 0, 10)
    frame = [
        box((-90, -260, -90), (90, -230, 110)),
        box((60, -232, 4), (90, -150, 36)),
        box((-90, -232, 4), (-60, -150, 36)),
    ]
    for name, eye in inner.items():
        for x in (-60, 60):
            frame += [
                box((x + s * 19 - 4, -235, eye[2] - 14), (x + s * 19 + 4, eye[1] + 14, eye[2] + 14)) for s in (-1, 1)
            ]
        ball = balls[name]
        arm = [cyl((x - 12, eye[1], eye[2]), X, 18, 24) for x in (-60, 60)]
        arm += [bar((x, eye[1] + 12), (0, ball[1] - 12), 9, ball[2] - 5, ball[2] + 5) for x in (-60, 60)]
        away = 1.0 if name == "lower" else -1.0
        arm.append(cyl(ball - 12 * away * Z, away * Z, 17, 22))
        solid = cut(union(*arm), sphere(ball, 10), cyl(ball, away * Z, 8.5, 20), bore(eye, X, 15, 100))
        drawing.add(f"{name} arm", solid)
        stud = union(sphere(ball, 10 - 0.5 * play), cyl(ball, away * Z, 6, 62))
        drawing.add(f"{name} stud", stud)
        drawing.add(f"{name} nut", hexagon(ball + 50 * away * Z, away * Z, 9, 9, 6))
        for k, x in enumerate((-60, 60)):
            drawing.add(f"{name} rubber {k}", tube((x - 12, eye[1], eye[2]), X, 9, 15, 24))
            drawing.add(f"{name} sleeve {k}", tube((x - 15, eye[1], eye[2]), X, 6, 9, 30))
            drawing.add(f"{name} bolt {k}", screw((x - 23, eye[1], eye[2]), X, 6, 60))
            drawing.add(f"{name} bolt nut {k}", hexagon((x + 23, eye[1], eye[2]), X, 9, 9, 6))
    frame = cut(union(*frame), *(bore(eye, X, 6, 200) for eye in inner.values()), bore((0, -160, 20), X, 13, 200))
    drawing.add("subframe", frame)
    for s in (-1, 1):
        drawing.add(f"rack bush {s}", tube((s * 75 - 15, -160, 20), X, 10 + play, 13, 30))
        drawing.joint("Weld", f"rack bush {s}", "subframe")
    tie, end = at(130, -160, 20), at(100, -20, 20)
    drawing.add("rack", union(cyl((-140, -160, 20), X, 10, 255), sphere(tie, 9), cyl((110, -160, 20), X, 5, 15)))
    way = (end - tie) / np.linalg.norm(end - tie)
    rod = union(
        sphere(tie, 14), cyl(tie + 5 * way, way, 6, np.linalg.norm(end - tie) - 10), cyl(end - 11 * Z, Z, 14, 20)
    )
    rod = cut(rod, sphere(tie, 9 + 0.5 * play), cyl(tie, -X, 8, 20), sphere(end, 8), cyl(end, Z, 7, 20))
    drawing.add("tie rod", rod)
    drawing.add("tie stud", union(sphere(end, 8), cyl(end, Z, 5, 40)))
    drawing.add("tie nut", hexagon(end + 30 * Z, Z, 8, 8, 5))
    knuckle = [box((-20, -16, -28), (20, 50, 40)), cyl((0, 34, 10), Y, 38, 24)]
    knuckle += [cyl(balls["lower"] + 20 * Z, Z, 14, 35), cyl(balls["upper"] - 20 * Z, -Z, 14, 35)]
    knuckle += [box((10, -8, 36), (106, 8, 50)), cyl(end + 18 * Z, Z, 12, 12), box((94, -20, 36), (106, 8, 48))]
    cuts = [cyl(balls["lower"], Z, 6, 50.1), cyl(balls["upper"], -Z, 6, 50.1), bore(end, Z, 5, 60)]
    cuts += [cyl(balls["lower"] + 50 * Z, Z, 11, 16), cyl(balls["upper"] - 50 * Z, -Z, 11, 16)]
    turns = {"unit bolt": (0.5, 2.6, 4.71), "wheel bolt": np.arange(5) * 1.2566, "roller": np.arange(9) * 0.698}
    around = {name: [at(np.cos(t), 0, np.sin(t)) for t in angles] for name, angles in turns.items()}
    spots, studs = [axle + 32 * p for p in around["unit bolt"]], [axle + 24 * p for p in around["wheel bolt"]]
    drawing.add(
        "knuckle", cut(union(*knuckle), *cuts, cyl(axle + 34 * Y, Y, 26, 30), *(bore(p, Y, 3, 70) for p in spots))
    )
    unit = union(tube(axle + 34 * Y, Y, 19, 26, 24), tube(axle + 58 * Y, Y, 19, 37, 8))
    drawing.add("bearing unit", cut(unit, *(bore(p, Y, 3.2, 70) for p in spots)))
    rollers = [cyl(axle + y * Y + 17 * p, Y, 2, 8) for y in (36, 52) for p in around["roller"]]
    drawing.add("bearing rollers", union(*rollers))
    for k, p in enumerate(spots):
        drawing.add(f"unit bolt {k}", screw(p + 66 * Y, -Y, 3, 28))
    hub = union(cyl(axle + 34.5 * Y, Y, 15, 41.5), cyl(axle + 74 * Y, Y, 34, 6))
    drawing.add("hub", cut(hub, *(bore(p, Y, 3, 90) for p in studs)))
    rim = union(cyl(axle + 80 * Y, Y, 60, 6), tube(axle + 44 * Y, Y, 90, 110, 60), tube(axle + 80 * Y, Y, 55, 92, 6))
    drawing.add("wheel", cut(rim, *(bore(p, Y, 3.4, 90) for p in studs)))
    for k, p in enumerate(studs[:2]):
        drawing.add(f"wheel bolt {k}", screw(p + 86 * Y, -Y, 3, 12))
    for name in balls:
        drawing.joint("Revolute", f"{name} arm", "subframe", inner[name], X)
        drawing.joint("Weld", f"{name} stud", "knuckle")
        drawing.joint("Spherical", f"{name} arm", "knuckle", balls[name])
    drawing.joint("Spherical", "tie rod", "rack", tie)
    drawing.joint("Spherical", "tie rod", "knuckle", end)
    drawing.joint("Cylindrical", "rack", "subframe", (0, -160, 20), X)
    drawing.joint("Weld", "bearing unit", "knuckle")
    drawing.joint("Revolute", "hub", "knuckle", (0, 0, 10), Y)
    drawing.joint("Weld", "wheel", "hub")
    return drawing


@kind
def belt_tensioner(random):
    """A base on two screws, an arm on a bush round its stud, a spring about the hub, a pulley on a ball bearing."""
    drawing, play = Drawing(["block"]), random.choice([0.05, 0.1])
    hub, wheel = at(0, 0, 0), at(random.uniform(60, 75), 10, 0)
    ears = [at(-30, 38, 0), at(-30, -38, 0)]
    pocket = [bore(p, Z, 4, 15) for p in ears]
    drawing.add("block", cut(box((-80, -80, -30), (40, 80, 0)), *pocket, cyl((-20, 0, -8), Z, 3, 9)))
    base = union(
        cyl(hub, Z, 28, 8),
        *(bar((0, 0), p, 10, 0, 8) for p in ears),
        cyl(hub + 8 * Z, Z, 10, 39.8),
        cyl((-20, 0, -8), Z, 3, 8),
    )
    cup = tube(hub + 8 * Z, Z, 25, 28, 14)
    drawing.add("base", cut(union(base, cup), *(bore(p, Z, 4.25) for p in ears), cyl(hub + 20 * Z, Z, 4, 40)))
    for number, p in enumerate(ears):
        drawing.add(f"base screw {number}", screw(p + 8 * Z, -Z, 4, 20))
    drawing.add("bush", union(tube(hub + 22.2 * Z, Z, 10 + play, 12, 25.6), tube(hub + 22.2 * Z, Z, 10 + play, 15, 2)))
    arm = union(cyl(hub + 24.2 * Z, Z, 22, 23), bar(hub, wheel, 14, 34, 46), cyl(wheel + 26 * Z, Z, 12, 20))
    drawing.add("arm", cut(arm, bore(hub, Z, 12), cyl(wheel, Z, 5, 46)))
    drawing.add("friction washer", tube(hub + 47.8 * Z, Z, 4.1, 18, 1.5))
    drawing.add("centre screw", screw(hub + 49.3 * Z, -Z, 4, 24))
    rings = [torus(hub + z * Z, Z, 19, 1.5) for z in (10.5, 13.6, 16.7, 19.8)]
    drawing.add("spring", union(*rings, *(box((18, -1, z), (20, 1, z + 3)) for z in (10.5, 13.6, 16.7))))
    ball_bearing(drawing, "roller bearing", wheel + 10 * Z, Z, 6, 16, 14)
    drawing.add("spacer", tube(wheel + 24 * Z, Z, 5, 8, 2))
    drawing.add("inner sleeve", tube(wheel + 10 * Z, Z, 5, 6, 14))
    drawing.add("pulley", union(tube(wheel + 10 * Z, Z, 16, 18, 14), tube(wheel + 5 * Z, Z, 18, 34, 24)))
    drawing.add("dust cap", union(tube(wheel + 8.6 * Z, Z, 5, 15, 1.4)))
    drawing.add("pulley screw", screw(wheel + 8.6 * Z, Z, 5, 34))
    drawing.joint("Weld", "base", "block")
    drawing.joint("Revolute", "arm", "base", hub, Z)
    drawing.joint("Weld", "roller bearing inner ring", "arm")
    drawing.joint("Weld", "pulley", "roller bearing outer ring")
    drawing.joint("Revolute", "pulley", "arm", wheel, Z)
    return drawing
