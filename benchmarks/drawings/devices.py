"""Grippers, gimbals, steering, pantographs, a skewer: links that carry something."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, rivet, screw, sphere, torus, tube, union


@kind
def pantograph(random):
    """Four bars on rivets, two longer than their parallelogram, on the boss of a board, with a tracer."""
    drawing, play = Drawing(["board"]), random.choice([0.0, 0.1])
    a, b = random.uniform(40, 55), random.uniform(60, 80)
    turns = random.uniform(0.3, 0.7), random.uniform(1.6, 2.2)
    u, v = (at(np.cos(angle), np.sin(angle), 0) for angle in turns)
    pivot, elbow = at(0, 0, 0), b * u
    ends = {
        "long": (pivot, 2 * b * u),
        "short": (a * v, a * v + b * u),
        "side": (pivot, a * v),
        "tracer": (b * u, b * u + 2 * a * v),
    }
    levels = {"long": 5.0, "short": 5.0, "side": 9.0, "tracer": 9.0}
    rivets = {
        "A": (pivot, ("long", "side")),
        "B": (elbow, ("long", "tracer")),
        "C": (a * v, ("side", "short")),
        "D": (b * u + a * v, ("tracer", "short")),
    }
    for name, (one, other) in ends.items():
        holes = [point for point, on in rivets.values() if name in on]
        drawing.add(name, bar(one, other, 5, levels[name], levels[name] + 4, holes, 2 + play))
    for name, (point, on) in rivets.items():
        for one, other in ((each, "board") for each in on) if name == "A" else (on,):
            drawing.joint("Revolute", one, other, point, Z)
        if name != "A":
            drawing.add(f"rivet {name}", rivet(point + 5 * Z, Z, 2, 8))
    board = union(box((-60, -60, -6), (180, 180, 0)), cyl((0, 0, 0), Z, 6, 5), cyl((0, 0, 0), Z, 2, 14))
    drawing.add("board", board)
    drawing.add("clip", tube((0, 0, 13.2), Z, 1.9, 4, 0.8))
    tip = b * u + 2 * a * v
    drawing.parts["tracer"] = cut(drawing.parts["tracer"], bore(tip, Z, 2.5))
    drawing.add("pencil", cyl(tip + 1 * Z, Z, 2.5, 40))
    drawing.joint("Weld", "pencil", "tracer")
    return drawing


@kind
def skewer(random):
    """A rod through a hollow axle between dropouts, a cam lever on a cross pin, a nut, two springs as rings."""
    drawing, width = Drawing(["dropout 1"]), random.uniform(45, 60)
    for s in (-1, 1):
        drop = cut(box((s * width, -20, -8), (s * (width + 5), 20, 60)), bore((0, 0, 0), X, 5))
        drawing.add(f"dropout {s}", drop)
        drawing.add(f"spring {s}", torus((s * (width + 9), 0, 0), X, 6, 1))
    drawing.add("bridge", box((-width - 5, -20, 60), (width + 5, 20, 70)))
    drawing.add(
        "axle", union(tube((-width - 4, 0, 0), X, 2.75, 5, 2 * width + 8), tube((-width, 0, 0), X, 5, 8, 2 * width))
    )
    drawing.add(
        "hub",
        union(
            tube((-width + 12, 0, 0), X, 8, 14, 2 * width - 24),
            *(tube((s * 0.6 * width - 2, 0, 0), X, 8, 24, 4) for s in (-1, 1)),
        ),
    )
    eye = at(-width - 22, 0, 0)
    rod = union(cyl(eye + 6 * X, X, 2.5, 2 * width + 40), box(eye - at(6, 3, 6), eye + at(7, 3, 6)))
    drawing.add("rod", cut(rod, bore(eye, Y, 3.1)))
    cap = cut(tube((-width - 16, 0, 0), X, 2.8, 10, 11), box(eye - 6.5 * at(2, 1, 2), eye))
    drawing.add("cap", cap)
    lever = union(
        *(cyl(eye + (s * 4.6 - 1.5) * Y, Y, 7, 3) for s in (-1, 1)),
        cyl(eye - 6 * Y, Y, 3, 12),
        box(eye + at(-5, -6, 5), eye + at(5, 6, 10)),
        bar((0, 0), (60, 0), 5, 0, 4).rotate((0, 0, 0), (0, 1, 0), -90).translate(tuple((eye + at(2, 0, 10)).tolist())),
    )
    drawing.add("lever", lever)
    drawing.add("nut", tube((width + 12, 0, 0), X, 2.4, 9, 12))
    for s in (-1, 1):
        drawing.joint("Weld", f"dropout {s}", "bridge")
    drawing.joint("Revolute", "lever", "rod", eye, Y)
    drawing.joint("Weld", "nut", "rod")
    drawing.joint("Weld", "axle", "dropout 1")
    drawing.joint("Cylindrical", "rod", "axle", (0, 0, 0), X)
    drawing.joint("Revolute", "hub", "axle", (0, 0, 0), X)
    return drawing


@kind
def parallel_gripper(random):
    """Jaws that stay parallel on two links each, on shoulder screws in a palm, and a rod that drives the inner ones."""
    drawing, play = Drawing(["palm"]), random.choice([0.05, 0.15])
    length, tilt = random.uniform(38, 50), random.uniform(0.1, 0.4)
    palm = box((-50, -18, -8), (50, 30, 0))
    for s in (-1, 1):
        way = length * at(s * np.sin(tilt), np.cos(tilt), 0)
        for k, foot in enumerate((at(s * 14, 10, 0), at(s * 36, 10, 0))):
            tip = foot + way
            drawing.add(f"link {s} {k}", bar(foot, tip, 5, 0, 5, (foot, tip), 2.5 + play))
            for name, point, z in (("palm", foot, -6.0), ("jaw", tip, -4.0)):
                drawing.add(f"{name} screw {s} {k}", screw(point + 5 * Z, -Z, 2.5, 5 - z))
            palm = cut(palm, cyl(foot - 6 * Z, Z, 2.1, 10))
            drawing.joint("Revolute", f"link {s} {k}", "palm", foot, Z)
            drawing.joint("Revolute", f"link {s} {k}", f"jaw {s}", tip, Z)
        near, far = at(s * 14, 10, 0) + way, at(s * 36, 10, 0) + way
        jaw = union(bar(near, far, 6, -6, 0), box(near + at(-s * 6, 0, -6), near + at(s * 2, 45, 0)))
        jaw = cut(jaw, *(cyl(p - 5 * Z, Z, 2.1, 9) for p in (near, far)))
        pad = box(near + at(-s * 9, 20, -6), near + at(-s * 6, 45, 0))
        holes = [cyl(near + at(-s * 12, y, -3), s * X, 1.6, 5.9) for y in (26, 39)]
        drawing.add(f"jaw {s}", cut(jaw, *(cyl(near + at(-s * 7, y, -3), s * X, 1.25, 6) for y in (26, 39))))
        drawing.add(f"pad {s}", cut(pad, *holes))
        drawing.joint("Weld", f"pad {s}", f"jaw {s}")
    drawing.add("palm", palm)
    drawing.add("wrist", union(box((-25, -30, -8), (25, -18, 0)), cyl((0, -30, -4), -Y, 4, 20)))
    drawing.joint("Weld", "wrist", "palm")
    return drawing


@kind
def gimbal(random):
    """A yoke, a ring in it, a camera in the ring: stubs in flanged bushes, motors with screws."""
    drawing, outer = Drawing(["stand"]), random.uniform(50, 60)
    inner, play = outer - 16, random.choice([0.0, 0.05])
    drawing.add("stand", union(cyl((0, 0, -outer - 40), Z, 35, 8), tube((0, 0, -outer - 32), Z, 10, 16, 20)))
    drawing.add("pan", cyl((0, 0, -outer - 32), Z, 10 - play, 24))
    arms = [box((s * (outer + 4), -9, -outer - 8), (s * (outer + 10), 9, 9)) for s in (-1, 1)]
    yoke = union(
        box((-outer - 10, -9, -outer - 12), (outer + 10, 9, -outer - 6)), cyl((0, 0, -outer - 12), Z, 18, 4), *arms
    )
    drawing.add("yoke", cut(yoke, bore((0, 0, 0), X, 5), cyl((0, 0, -outer - 13), Z, 10, 5)))
    ring = cut(
        union(
            tube((0, 0, -6), Z, inner + 4, outer, 12), *(cyl((s * (outer - 2), 0, 0), s * X, 4, 16) for s in (-1, 1))
        ),
        bore((0, 0, 0), Y, 3),
    )
    drawing.add("ring", ring)
    for s in (-1, 1):
        bush = union(
            tube((s * (outer + 3), 0, 0), s * X, 4 + play, 5, 7), tube((s * (outer + 2), 0, 0), s * X, 4 + play, 7, 2)
        )
        drawing.add(f"bush {s}", bush)
        drawing.joint("Weld", f"bush {s}", "yoke")
    camera = union(
        box((-22, -inner + 6, -16), (22, inner - 6, 16)),
        cyl((0, 0, 0), Z, 12, 30),
        cyl((0, -outer - 3, 0), Y, 3 - play, 2 * outer + 6),
    )
    drawing.add("camera", camera)
    drawing.add("clip", torus((0, outer + 0.9, 0), Y, 3.4, 0.8))
    motor = cut(cyl((outer + 14, 0, 0), X, 13, 14), cyl((outer + 13, 0, 0), X, 4, 6))
    drawing.add("motor", motor)
    bracket = union(box((outer + 10, -14, -14), (outer + 14, 14, 14)))
    drawing.add(
        "bracket", cut(bracket, bore((0, 0, 0), X, 5.5), *(bore((0, y, z), X, 1.6) for y in (-9, 9) for z in (-9, 9)))
    )
    drawing.parts["motor"] = cut(motor, *(cyl((outer + 13, y, z), X, 1.25, 7) for y in (-9, 9) for z in (-9, 9)))
    drawing.parts["yoke"] = cut(drawing.parts["yoke"], bore((outer + 7, 7, 7), X, 1.0, 0.1))
    drawing.joint("Revolute", "yoke", "stand", (0, 0, 0), Z)
    drawing.joint("Revolute", "ring", "yoke", (0, 0, 0), X)
    drawing.joint("Revolute", "camera", "ring", (0, 0, 0), Y)
    drawing.joint("Weld", "motor", "bracket")
    drawing.joint("Weld", "bracket", "yoke")
    return drawing


@kind
def rack_steering(random):
    """A rod in a tube with end bushes, tie rods on balls at both ends, arms of stub axles on king pins, a pinion."""
    drawing, track = Drawing(["housing"]), random.uniform(220, 260)
    arm, play = random.uniform(45, 60), random.choice([0.0, 0.08])
    frame = union(
        tube((-90, 0, 0), X, 12, 18, 180),
        box((-track - 15, 40, -25), (track + 15, 60, -15)),
        box((-12, 0, -25), (12, 50, -10)),
    )
    forks = [box((s * track - 14, 30, z), (s * track + 14, 60, z + 10)) for s in (-1, 1) for z in (-25, 15)]
    post = [box((s * track - 14, 50, -25), (s * track + 14, 60, 25)) for s in (-1, 1)]
    frame = cut(frame, bore((0, 0, 0), X, 12, 90))
    frame = cut(
        union(frame, *forks, *post), *(bore((s * track, 40, 0), Z, 5) for s in (-1, 1)), cyl((0, 14, -40), Z, 6, 80)
    )
    drawing.add("housing", frame)
    rack = union(
        cyl((-130, 0, 0), X, 9, 260),
        *(sphere((s * 140, 0, 0), 7) for s in (-1, 1)),
        *(cyl((s * 125, 0, 0), s * X, 4, 12) for s in (-1, 1)),
    )
    drawing.add("rack", rack)
    for s in (-1, 1):
        drawing.add(f"bush {s}", tube((s * 90 - 15 * (s > 0), 0, 0), X, 9 + play, 12, 15))
        king = at(s * track, 40, 0)
        tip = king + arm * at(-s * np.sin(0.2), -np.cos(0.2), 0) * at(1, 1, 0)
        knuckle = union(
            cyl(king - 15 * Z, Z, 12, 30),
            bar(king, tip, 7, -5, 5),
            cyl(king + at(s * 10, 0, 0), s * X, 8, 50),
            cyl(tip, Z, 3, 12),
        )
        knuckle = union(cut(knuckle, bore(king, Z, 5 + play)), sphere(tip + 15 * Z, 6))
        drawing.add(f"knuckle {s}", knuckle)
        drawing.add(f"king pin {s}", headed(king - 25 * Z, Z, 5, 55))
        ball, socket = at(s * 140, 0, 0), tip + 15 * Z
        way = (socket - ball) / np.linalg.norm(socket - ball)
        tie = union(cyl(ball, way, 3.5, np.linalg.norm(socket - ball)), sphere(ball, 11), sphere(socket, 10))
        opening = cut(tie, sphere(ball, 7), sphere(socket, 6), cyl(ball, -way, 6, 20), cyl(socket, -Z, 5, 20))
        drawing.add(f"tie {s}", opening)
        drawing.joint("Weld", f"bush {s}", "housing")
        drawing.joint("Revolute", f"knuckle {s}", "housing", king, Z)
        drawing.joint("Spherical", f"tie {s}", "rack", ball, Z)
        drawing.joint("Spherical", f"tie {s}", f"knuckle {s}", socket, Z)
    drawing.add(
        "pinion", union(cyl((0, 14, -30), Z, 6 - play, 90), cyl((0, 14, 25), Z, 9, 10), cyl((0, 14, -34), Z, 9, 9))
    )
    drawing.joint("Cylindrical", "rack", "housing", (0, 0, 0), X)
    drawing.joint("Revolute", "pinion", "housing", (0, 14, 0), Z)
    return drawing
