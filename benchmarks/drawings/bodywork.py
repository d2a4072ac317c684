"""What opens cars, doors and cupboards: a window winder, a bicycle's hinge, a garage door's hinges, a cup hinge."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import ball_bearing
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, rivet, screw, tube, union


def channel(low_x: float, high_x: float, y: float, legs: tuple[float, ...] = ()):
    """A rail along x of U section, open towards -z, on legs down to z = 2 with feet for screws."""
    shapes = [box((low_x, y - 7, 9.5), (high_x, y + 7, 17.5))]
    shapes += [box((x - 6, y - 7, 2), (x + 6, y + 7, 10)) for x in legs]
    groove = box((low_x - 1, y - 5, 9), (high_x + 1, y + 5, 16))
    return cut(union(*shapes), groove, *(bore((x, y, 2), Z, 1.7, 30) for x in legs))


@kind
def window_winder(random):
    """Arms that cross on a rivet, plastic slides in a fixed and a lifted rail, a sector, a crank, glass in channels."""
    drawing, play, tilt = Drawing(["door panel"]), random.choice([0.05, 0.15]), random.uniform(0.6, 0.9)
    o, a = at(0, 0, 0), 200 * at(np.cos(tilt), np.sin(tilt), 0)
    b, c, d = a / 2, at(0, a[1], 0), at(a[0], 0, 0)
    p = 70.2 * at(-np.cos(tilt), -np.sin(tilt), 0)
    panel = box((-130, -90, 0), (300, 330, 2)).edges("|Z").fillet(15)
    right, spots = a[0] + 70, []
    drawing.add("fixed rail", channel(d[0] - 55, d[0] + 55, 0, (d[0] - 49, d[0] + 49)))
    spots += [at(d[0] + s * 49, 0, 2) for s in (-1, 1)]
    lifted = cut(channel(-35, a[0] + 35, a[1]), *(bore((x, a[1], 10), Z, 2.6, 40) for x in (50, a[0] - 50)))
    drawing.add("lift rail", lifted)
    bolts = [at(x, a[1], 0) for x in (50, a[0] - 50)]
    drawing.add(
        "glass", cut(box((-60, a[1] - 7, 17.5), (right - 10, a[1] + 140, 21.5)), *(bore(q, Z, 4) for q in bolts))
    )
    for k, q in enumerate(bolts):
        drawing.add(f"glass bolt {k}", union(cyl(q + 13.5 * Z, Z, 2.5, 16), cyl(q + 12.5 * Z, Z, 4.4, 3.5)))
        drawing.add(f"glass bush {k}", tube(q + 17.5 * Z, Z, 2.5, 4, 4))
        drawing.add(f"glass nut {k}", hexagon(q + 21.5 * Z, Z, 5, 4, 2.5))
    for name, x, s in (("left run", -60, -1), ("right run", right - 10, 1)):
        run = box((x - s * 12, 40, 15), (x + s * 4, 320, 24))
        run = union(run, *(box((x + s * 1, y - 7, 2), (x + s * 4, y + 7, 16)) for y in (80, 280)))
        run = union(run, *(box((x + s * 1, y - 7, 2), (x + s * 14, y + 7, 4)) for y in (80, 280)))
        holes = [at(x + s * 9, y, 4) for y in (80, 280)]
        spots += [q - 2 * Z for q in holes]
        run = cut(run, box((x - s * 13, 30, 17.3), (x + s * 0.3, 330, 21.7)), *(bore(q, Z, 1.7, 20) for q in holes))
        drawing.add(name, run)
        for k, q in enumerate(holes):
            drawing.add(f"{name} screw {k}", screw(q, -Z, 1.5, 6))
        drawing.joint("Weld", name, "door panel")
    for k, q in enumerate(spots[:2]):
        drawing.add(f"rail screw {k}", screw(q - 2 * Z, Z, 1.5, 5))
    panel = cut(panel, *(bore(q, Z, 1.6, 20) for q in spots), bore(o, Z, 4, 20), bore(p, Z, 6, 20))
    drawing.add("door panel", cut(panel, box((40, 120, -1), (120, 200, 3)), bore((200, 200, 0), Z, 25, 9)))
    sector = tube(o + 3 * Z, Z, 45, 60, 2).intersect(box(p - at(34, 34, 0), p + at(34, 34, 9)))
    lift = union(bar(o, a, 11, 3, 5), bar(o, 0.55 * p, 14, 3, 5), sector)
    lift = cut(lift, bore(o, Z, 4 + play, 20), bore(b, Z, 3, 20), bore(a, Z, 2.5, 20))
    drawing.add("lift arm", lift)
    drawing.add("pivot rivet", rivet(o, Z, 4, 5))
    drawing.add("pivot washer", tube(o + 2 * Z, Z, 4.2, 9, 1))
    drawing.add("cross arm", cut(bar(d, c, 9, 6, 8), bore(b, Z, 3 + play, 20), *(bore(q, Z, 2.5, 20) for q in (c, d))))
    drawing.add("cross washer", tube(b + 5 * Z, Z, 3.2, 8, 1))
    drawing.add("cross rivet", headed(b + 8 * Z, -Z, 3, 5))
    for name, q, arm, low, rail in (
        ("lift", a, "lift arm", 3, "lift rail"),
        ("upper", c, "cross arm", 6, "lift rail"),
        ("lower", d, "cross arm", 6, "fixed rail"),
    ):
        stud = union(cyl(q + (low - 0.8) * Z, Z, 4.5, 0.8), cyl(q + low * Z, Z, 2.5, 2))
        stud = union(stud, cyl(q + (low + 2) * Z, Z, 5.5, 7.5 - low), cyl(q + 9 * Z, Z, 3, 6.5))
        drawing.add(f"{name} stud", stud)
        drawing.add(f"{name} slide", cut(box(q + at(-12, -4.9, 9.8), q + at(12, 4.9, 15.8)), bore(q, Z, 3 + play, 40)))
        drawing.joint("Weld", f"{name} stud", arm)
        drawing.joint("Revolute", f"{name} slide", arm, q, Z)
        drawing.joint("Prismatic", f"{name} slide", rail, q, X)
    drawing.add("pinion", cut(cyl(p + 2.5 * Z, Z, 10, 3.5), bore(p, Z, 4, 40)))
    drawing.add("crank bush", union(tube(p - 8 * Z, Z, 4 + play / 3, 6, 10), tube(p - 2 * Z, Z, 4 + play / 3, 12, 2)))
    drawing.add("crank spindle", cut(cyl(p - 22 * Z, Z, 4, 28), cyl(p - 23 * Z, Z, 1.5, 12)))
    hand = p - 80 * X
    crank = cut(union(bar(p, hand, 7, -22, -16), cyl(p - 22 * Z, Z, 10, 13)), bore(p, Z, 4, 60), bore(hand, Z, 3, 60))
    drawing.add("crank", crank)
    drawing.add("crank screw", union(cyl(p - 22 * Z, Z, 1.5, 10), cyl(p - 24 * Z, Z, 5, 2)))
    drawing.add("knob pin", union(cyl(hand - 46 * Z, Z, 3, 30), cyl(hand - 48 * Z, Z, 4.5, 2)))
    drawing.add("knob", tube(hand - 45.5 * Z, Z, 3 + play, 9, 23).edges("<Z").chamfer(1))
    drawing.joint("Revolute", "lift arm", "door panel", o, Z)
    drawing.joint("Revolute", "cross arm", "lift arm", b, Z)
    drawing.joint("Weld", "fixed rail", "door panel")
    drawing.joint("Weld", "glass", "lift rail")
    drawing.joint("Prismatic", "glass", "left run", (-60, 100, 19.5), Y)
    drawing.joint("Revolute", "crank spindle", "door panel", p, Z)
    drawing.joint("Weld", "pinion", "crank spindle")
    drawing.joint("Weld", "crank", "crank spindle")
    drawing.joint("Revolute", "knob", "crank", hand, Z)
    return drawing


@kind
def bicycle_hinge(random):
    """Two frame tubes with knuckles on a pin, an eye bolt in lugs, a lever whose cam presses on a washer, a catch."""
    drawing, play = Drawing(["front frame"]), random.choice([0.02, 0.05])
    hinge, eye, cam = at(0, 30, 0), at(-20, -38, 0), at(25, -38, 0)
    wall = random.uniform(1.5, 2.5)
    for s, name, heights in ((-1, "front frame", ((-8, 8),)), (1, "rear frame", ((-20, -8.1), (8.1, 20)))):
        shape = union(box((s * 12, -30, -26), (s * 0.05, 24, 26)), tube((s * 10, 0, 0), s * X, 22 - wall, 22, 160))
        for low, high in ((-20, -8.1), (-8, 8), (8.1, 20)):
            if (low, high) in heights:
                shape = union(shape, cyl(hinge + low * Z, Z, 9, high - low), box((s * 12, 18, low), (s * 4, 30, high)))
            else:
                shape = cut(shape, cyl(hinge + (low - 0.1) * Z, Z, 9.6, high - low + 0.2))
        shape = cut(shape, bore(hinge, Z, 5 if s > 0 else 6.5, 60))
        if s < 0:
            lugs = [box((-30, -46, k * 7), (-10, -28, k * 13)) for k in (-1, 1)]
            shape = cut(union(shape, *lugs), bore(eye, Z, 3, 60))
        else:
            shape = union(shape, *(box((2, -47, k * 5), (14, -28, k * 13)) for k in (-1, 1)))
            shape = cut(shape, cyl(hinge + at(0, 0, 14), Y, 1.6, 20))
        drawing.add(name, shape)
    drawing.add("hinge pin", cut(cyl(hinge - 20 * Z, Z, 5, 40), cyl(hinge + at(0, 3, 14), Y, 1.6, 9)))
    drawing.add("pin screw", cyl(hinge + at(0, 3, 14), Y, 1.6, 5))
    for k, z in enumerate((-8, 0.5)):
        drawing.add(f"hinge bush {k}", tube(hinge + z * Z, Z, 5 + play, 6.5, 7.5))
    drawing.add("eye pin", rivet(eye - 13 * Z, Z, 3, 26))
    bolt = cut(union(cyl(eye - 6.8 * Z, Z, 7, 13.6), cyl(eye, X, 4, 54)), bore(eye, Z, 3 + play, 60))
    drawing.add("eye bolt", bolt)
    drawing.add("cam washer", tube(at(14, -38, 0), X, 4.3, 9, 3))
    drawing.add("trunnion", cut(cyl(cam - 13 * Z, Z, 5, 26), bore(cam, X, 4, 60)))
    lever = union(cyl(cam - 13 * Z, Z, 8, 26), box(cam + at(0, -8, -13), cam + at(95, 4, 13)))
    lever = cut(
        lever, box(cam + at(-20, -20, -7), cam + at(20, 20, 7)), box(cam + at(24, -5, -10), cam + at(91, 9, 10))
    )
    drawing.add("lever", cut(lever, bore(cam, Z, 5 + play, 60)))
    drawing.add("lock nut", hexagon(cam + 5 * X, X, 5.5, 3, 4))
    spring_clip = union(box((80, -24, -5), (90, -21.4, 5)), box((87, -31, -5), (90, -22, 5)))
    drawing.add("catch", cut(spring_clip, cyl((70, 0, 0), X, 22, 40), bore((83, -23, 0), Y, 1, 6)))
    drawing.add("cable", cyl((-150, 24.5, 0), X, 2, 120))
    drawing.joint("Weld", "catch", "rear frame")
    drawing.joint("Revolute", "rear frame", "front frame", hinge, Z)
    drawing.joint("Weld", "hinge pin", "rear frame")
    for k in range(2):
        drawing.joint("Weld", f"hinge bush {k}", "front frame")
    drawing.joint("Revolute", "eye bolt", "front frame", eye, Z)
    drawing.joint("Weld", "trunnion", "eye bolt")
    drawing.joint("Revolute", "lever", "trunnion", cam, Z)
    return drawing


@kind
def garage_hinges(random):
    """Two panels of a garage door, folded hinges that carry roller stems, wheels on balls, C-channel tracks."""
    drawing, play = Drawing(["lower panel", "left jamb", "right jamb"]), random.choice([0.1, 0.25])
    depth = random.uniform(38, 42)
    pin, stem = at(0, 0, depth + 10), at(0, -22, depth + 12)
    spots = {k: [at(x, k * 42, depth) for x in (-232 - r, -228 + r, 228 - r, 232 + r)] for k, r in ((-1, 13), (1, 10))}
    for k, name in ((-1, "lower panel"), (1, "upper panel")):
        panel = box((-300, k * 0.3, 0), (300, k * 300, depth)).edges("|X and >Z").chamfer(0.2)
        drawing.add(name, cut(panel, *(cyl(p - 14 * Z, Z, 1.8, 15) for p in spots[k])))
    for s, side in ((-1, "left"), (1, "right")):
        middle = s * 230 * X
        for k, name, where in ((-1, "lower", 24), (1, "upper", 20)):
            ears = [
                box(middle + at(t * where, k * 60, depth), middle + at(t * (where - 3), -k * 7, depth + 19))
                for t in (-1, 1)
            ]
            leaf = union(box(middle + at(-where, k * 60, depth), middle + at(where, k * 8, depth + 2.5)), *ears)
            leaf = cut(leaf, bore(pin, X, 4 + play * (k + 1) / 2), *(bore(p, Z, 2.6, 60) for p in spots[k]))
            if k < 0:
                leaf = cut(leaf, bore(stem, X, 5.2 + play))
            drawing.add(f"{side} {name} leaf", leaf)
            drawing.joint("Weld", f"{side} {name} leaf", f"{name} panel")
            for j, p in enumerate(q for q in spots[k] if q[0] * s > 0):
                drawing.add(f"{side} {name} screw {j}", screw(p + 2.5 * Z, -Z, 2.2, 14))
        drawing.add(f"{side} pin", rivet(pin + middle - 24 * X, X, 4, 48))
        drawing.joint("Revolute", f"{side} upper leaf", f"{side} lower leaf", pin, X)
        root, wheel, way = stem + middle - s * 30 * X, stem + s * 330 * X, s * X
        reach = float(np.linalg.norm(wheel - root))
        rod = union(cyl(root, way, 5.2, reach + 10), cyl(wheel + 10 * way, way, 7, 2), cyl(wheel, -way, 8, 2))
        drawing.add(f"{side} stem", rod)
        ball_bearing(drawing, f"{side} wheel", wheel, way, 5.2, 17, 10)
        drawing.add(f"{side} tyre", tube(wheel, way, 17, 22, 10))
        low, high = stem + at(s * 326, -280, -24.5), stem + at(s * 346, 320, 24.5)
        track = cut(box(low, high), box(low + at(s * 1.5, -9, 2), high + at(-s * 1.5, 9, -2)))
        track = cut(track, box(stem + at(s * 320, -300, -16), stem + at(s * 330, 400, 16)))
        bolt = stem + at(s * 346, 200, 0)
        drawing.add(f"{side} track", cut(track, bore(bolt, X, 3.3, 12)))
        jamb = union(
            box(bolt + at(0, -30, -50), bolt + at(s * 3, 30, 20)),
            box(bolt + at(0, -30, -53), bolt + at(s * 60, 30, -50)),
        )
        drawing.add(f"{side} jamb", cut(jamb, bore(bolt, X, 3.3, 12), bore(bolt + at(s * 35, 0, -50), Z, 4, 9)))
        drawing.add(f"{side} track bolt", union(cyl(bolt - 3.3 * way, way, 7, 1.8), cyl(bolt - 3 * way, way, 3, 16)))
        drawing.add(f"{side} track nut", hexagon(bolt + 3 * way, way, 5, 5, 3))
        drawing.joint("Weld", f"{side} track", f"{side} jamb")
        drawing.joint("Cylindrical", f"{side} stem", f"{side} lower leaf", stem, X)
        drawing.joint("Weld", f"{side} wheel inner ring", f"{side} stem")
        drawing.joint("Weld", f"{side} tyre", f"{side} wheel outer ring")
        drawing.joint("Revolute", f"{side} tyre", f"{side} stem", stem, X)
    return drawing


@kind
def cup_hinge(random):
    """A concealed hinge: a cup let into a door, two links on pins, an arm on its mounting plate, wood screws."""
    drawing, play = Drawing(["side panel"]), random.choice([0.0, 0.05, 0.1])
    c1, c2 = at(-4, 13, 0), at(-6, random.uniform(27, 29), 0)
    a1, a2 = at(18, random.uniform(9, 11), 0), at(26, 20, 0)
    plate_spots, cup_spots = [at(62, 4, z) for z in (-18, 18)], [at(3.5, 31, z) for z in (-22, 22)]
    drawing.add(
        "side panel", cut(box((4, -16, -120), (300, 0, 120)), *(cyl(p - 16 * Y, Y, 1.5, 14) for p in plate_spots))
    )
    door = cut(box((-18, -15, -120), (2, 280, 120)), cyl((-11.2, 22, 0), X, 17.5 + play, 20))
    drawing.add("door", cut(door, *(cyl(p - 14 * X, X, 1.5, 13) for p in cup_spots)))
    cup = union(cyl((-11, 22, 0), X, 17.5, 13), box((2, 1, -27), (3.5, 43, 27)).edges("|X").fillet(8))
    cup = cut(cup, cyl((-10, 22, 0), X, 15.5, 20), *(bore(p, X, 2.2, 9) for p in cup_spots))
    drawing.add("cup", cut(cup, bore(c1, Z, 1.5, 30), bore(c2, Z, 1.5, 30)))
    for k, p in enumerate(cup_spots):
        drawing.add(f"cup screw {k}", screw(p, -X, 2, 12))
    for name, p, reach in (("inner", c1, 13.5), ("outer", c2, 15)):
        drawing.add(f"{name} cup pin", cyl(p - reach * Z, Z, 1.5, 2 * reach))
    for name, p, q in (("inner", c1, a1), ("outer", c2, a2)):
        drawing.add(f"{name} link", bar(p, q, 2.8, -6, 6, (p, q), 1.5 + play))
        drawing.add(f"{name} arm pin", rivet(q - 8.5 * Z, Z, 1.5, 17))
        drawing.joint("Revolute", f"{name} link", "cup", p, Z)
        drawing.joint("Revolute", f"{name} link", "arm", q, Z)
    walls = [box((12, 4.2, s * 7), (95, 26, s * 8.5)).edges("|Z").fillet(4) for s in (-1, 1)]
    arm = union(*walls, box((40, 24, -8), (91, 26, 8)))
    lock, adjust = at(75, 26, 0), at(52, 26, 0)
    arm = cut(arm, bore(a1, Z, 1.5, 30), bore(a2, Z, 1.5, 30), bore(lock, Y, 2.6, 5), bore(adjust, Y, 2.5, 5))
    drawing.add("arm", arm)
    mount = union(box((42, 0, -26), (84, 4, 26)).edges("|Y").fillet(6), box((44, 3, -6.9), (86, 19, 6.9)))
    mount = cut(mount, *(bore(p, Y, 2.3, 9) for p in plate_spots), cyl(lock - 16 * Y, Y, 2.1, 20))
    drawing.add("mounting plate", cut(mount, cyl((52, 17, 0), Y, 3.5, 9)))
    for k, p in enumerate(plate_spots):
        drawing.add(f"plate screw {k}", screw(p, -Y, 2, 15))
    drawing.add("lock screw", screw(lock, -Y, 2.5, 15))
    drawing.add("adjusting screw", cyl((52, 17, 0), Y, 2.5, 10))
    cover = cut(box((42, 26, -9), (93, 33, 9)), box((43, 25, -8), (92, 32, 8)))
    drawing.add("cover", union(cover, *(box((60, 20, s * 8.5), (66, 28, s * 9)) for s in (-1, 1))))
    drawing.joint("Weld", "cup", "door")
    drawing.joint("Weld", "mounting plate", "side panel")
    drawing.joint("Weld", "arm", "mounting plate")
    drawing.joint("Weld", "cover", "arm")
    for name in ("inner", "outer"):
        drawing.joint("Weld", f"{name} cup pin", "cup")
    return drawing
