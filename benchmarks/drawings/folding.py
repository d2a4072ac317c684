"""What is folded and clamped by hand: a toggle clamp, a lift table, a chair, a hinge, a latch, a drone's arm."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, meet, rivet, screw, tube, union


def both_sides(one, other, half: float, inner: float, outer: float, holes, radius: float):
    """Two bars in planes of constant z, from `inner` to `outer` on both sides of z = 0."""
    return [bar(one, other, half, *sorted((s * inner, s * outer)), holes, radius) for s in (-1, 1)]


def circlip(point, axis, radius: float, width: float = 1.0):
    """A ring for a groove in a shaft of this radius, open on one side."""
    unit = np.asarray(axis, float)
    side = np.cross(unit, X if abs(unit[0]) < 0.9 else Y)
    ring = tube(point, unit, 0.9 * radius, 1.5 * radius, width)
    middle = np.asarray(point, float) + 0.5 * width * unit
    return cut(ring, cyl(middle, side, 0.5 * radius, 3 * radius))


@kind
def toggle_clamp(random):
    """A horizontal clamp: an arm of two plates, a handle, two links, rivets; a spindle between nuts in a slot."""
    drawing, play = Drawing(["base"]), random.choice([0.0, 0.1])
    a, b, tilt = at(0, 25, 0), at(-28, 18, 0), random.uniform(1.0, 1.35)
    c = a + 30 * at(np.cos(tilt), np.sin(tilt), 0)
    d = at(*meet(b[:2], random.uniform(26, 30), c[:2], 34), 0)
    base = [box((-60, -6, -30), (20, 0, 30))]
    base += [box((-40, 0, s * 9.7), (8, 31, s * 12.5)) for s in (-1, 1)]
    drawing.add("base", cut(union(*base), bore(a, Z, 3, 40), bore(b, Z, 3, 40)))
    tip = at(95, c[1], 0)
    arm = [*both_sides(a, c, 6, 7, 9.5, (), 0), *both_sides(c, tip, 6, 7, 9.5, (), 0)]
    arm.append(box((50, c[1] - 6, -7), (62, c[1] + 6, 7)))
    drawing.add("arm", cut(union(*arm), bore(a, Z, 3 + play, 40), bore(c, Z, 3, 40)))
    end = c + 130 * (d - c) / np.linalg.norm(d - c)
    drawing.add("handle", bar(c, end, 7, -2, 2, (c, d), 3 + play))
    for s in (-1, 1):
        drawing.add(f"link {s}", bar(b, d, 6, *sorted((s * 2.2, s * 4.2)), (b, d), 3 + play))
        drawing.joint("Revolute", f"link {s}", "base", b, Z)
        drawing.joint("Revolute", f"link {s}", "handle", d, Z)
    for name, p, reach in (("A", a, 12.5), ("B", b, 12.5), ("C", c, 9.5), ("D", d, 4.2)):
        drawing.add(f"rivet {name}", rivet(p - reach * Z, Z, 3, 2 * reach))
    foot = at(80, c[1], 0)
    drawing.add("spindle", cyl(foot - 50 * Y, Y, 4, 80))
    for s in (-1, 1):
        drawing.add(f"spindle washer {s}", tube(foot + 6 * s * Y, s * Y, 4.2, 10, 1.5))
        drawing.add(f"spindle nut {s}", hexagon(foot + 7.5 * s * Y, s * Y, 6.5, 6, 4))
    drawing.add("rubber foot", cut(cyl(foot - 58 * Y, Y, 9, 16), cyl(foot - 50 * Y, Y, 4, 20)))
    drawing.joint("Revolute", "arm", "base", a, Z)
    drawing.joint("Revolute", "handle", "arm", c, Z)
    drawing.joint("Weld", "spindle", "arm")
    drawing.joint("Weld", "rubber foot", "spindle")
    return drawing


@kind
def lift_table(random):
    """Legs that cross on pins in flanged bushes, sliding blocks of plastics in channels of base and platform."""
    drawing, play, w, h = Drawing(["base"]), random.choice([0.0, 0.08]), 200.0, random.uniform(90, 140)
    p0, q0, p1, q1 = at(0, 0, 0), at(w, 0, 0), at(0, h, 0), at(w, h, 0)
    m, way_a, way_b = (p0 + q1) / 2, (q1 - p0) / np.hypot(w, h), (p1 - q0) / np.hypot(w, h)
    base, top = [box((-20, -26, -75), (w + 40, -16, 75))], [box((-20, h + 16, -75), (w + 40, h + 26, 75))]
    for s in (-1, 1):
        base.append(box((-14, -16, s * 58), (14, 12, s * 66)))
        top.append(box((-14, h - 12, s * 30), (14, h + 16, s * 38)))
        for shape, y, low, high, web in ((base, 0.0, 30, 38, 26), (top, h, 58, 66, 70)):
            shape += [box((w - 70, y + t * 8, s * low), (w + 30, y + t * 16, s * high)) for t in (-1, 1)]
            shape.append(box((w - 70, y - 16, s * web), (w + 30, y + 16, s * (low if web < low else high))))
    for shape, p in ((base, p0), (top, p1)):
        name = "base" if p is p0 else "platform"
        drawing.add(name, cut(union(*shape), bore(p, Z, 5, 90)))
    legs_a = [*both_sides(p0, q1, 11, 50, 56, (p0, q1), 5 + play), cyl(p0 + 60 * way_a - 51 * Z, Z, 4, 102)]
    drawing.add("legs a", cut(union(*legs_a), bore(m, Z, 5, 90)))
    legs_b = [*both_sides(q0, p1, 11, 40, 46, (q0, p1), 5 + play), cyl(q0 + 60 * way_b - 41 * Z, Z, 4, 82)]
    drawing.add("legs b", cut(union(*legs_b), bore(m, Z, 7, 90)))
    for s in (-1, 1):
        drawing.add(f"bush {s}", tube(m + s * 40 * Z, s * Z, 5.05, 7, 6).union(tube(m + s * 46 * Z, s * Z, 5.05, 9, 2)))
        drawing.add(f"cross pin {s}", headed(m + s * 56 * Z, -s * Z, 5, 19))
        for name, p, near, far in (("base", p0, 66, 50), ("platform", p1, 30, 46)):
            way = s * np.sign(far - near) * Z
            drawing.add(f"{name} pin {s}", headed(p + s * near * Z, way, 5, abs(far - near)))
        for name, leg, ground, p, low, start, length in (
            ("lower", "legs b", "base", q0, 30, 46, 16),
            ("upper", "legs a", "platform", q1, 58, 50, 16),
        ):
            block = box(p + at(-14, -8, s * low), p + at(14, 8, s * (low + 8)))
            drawing.add(f"{name} block {s}", cut(block, bore(p, Z, 5 + play, 90)))
            drawing.add(f"{name} pin {s}", headed(p + s * start * Z, (-s if low == 30 else s) * Z, 5, length))
            drawing.joint("Prismatic", f"{name} block {s}", ground, p, X)
            drawing.joint("Revolute", f"{name} block {s}", leg, p, Z)
        drawing.joint("Weld", f"bush {s}", "legs b")
    drawing.joint("Revolute", "legs a", "base", p0, Z)
    drawing.joint("Revolute", "legs b", "platform", p1, Z)
    drawing.joint("Revolute", "legs a", "legs b", m, Z)
    return drawing


@kind
def folding_chair(random):
    """Two frames of round tubes that cross on rivets, a seat on one of them, flat links from the seat to the other."""
    drawing, play = Drawing(["front frame"]), random.choice([0.0, 0.15])
    foot, crown, rear = at(0, 0, 0), at(random.uniform(230, 270), 800, 0), at(400, 0, 0)
    seat = at(20, 430, 0)
    way, back = (crown - foot) / np.linalg.norm(crown - foot), (seat - rear) / np.linalg.norm(seat - rear)
    share = np.linalg.solve(np.array([way[:2], -back[:2]]).T, (rear - foot)[:2])
    cross, high, hind = foot + share[0] * way, foot + 0.72 * (crown - foot), seat + at(290, -10, 0)
    frames = {
        "front frame": (foot, crown, 200, (cross, high)),
        "rear frame": (rear, seat + 20 * back, 175, (cross, seat)),
    }
    for name, (one, other, z, holes) in frames.items():
        length, along = float(np.linalg.norm(other - one)), (other - one) / np.linalg.norm(other - one)
        tubes = [tube(one + s * z * Z, along, 8, 10, length) for s in (-1, 1)]
        tubes += [cyl(one + k * along - (z - 9) * Z, Z, 6, 2 * z - 18) for k in (60, length - 12)[: 1 + (z == 200)]]
        drawing.add(name, cut(union(*tubes), *(bore(p, Z, 3 + play, 300) for p in holes)))
    panel = [box((-40, 437, -160), (250, 452, 160)), *both_sides(seat, hind, 12, 150, 160, (), 0)]
    drawing.add("seat", cut(union(*panel), *(bore(p, Z, 3 + play, 300) for p in (seat, hind))))
    for s in (-1, 1):
        drawing.add(f"link {s}", bar(hind, high, 10, *sorted((s * 140, s * 146)), (hind, high), 3 + play))
        drawing.add(f"cross rivet {s}", rivet(cross + s * 165 * Z, s * Z, 3, 45))
        drawing.add(f"seat rivet {s}", rivet(seat + s * 150 * Z, s * Z, 3, 35))
        drawing.add(f"hind rivet {s}", rivet(hind + s * 140 * Z, s * Z, 3, 20))
        drawing.add(f"high rivet {s}", rivet(high + s * 140 * Z, s * Z, 3, 70))
        drawing.add(f"spacer {s}", tube(high + s * 146 * Z, s * Z, 3.1, 7, 44))
        drawing.add(f"foot cap {s}", cyl(foot + s * 200 * Z, way, 8, 15).union(cyl(foot + s * 200 * Z, -way, 11, 6)))
        drawing.joint("Revolute", f"link {s}", "seat", hind, Z)
        drawing.joint("Revolute", f"link {s}", "front frame", high, Z)
        drawing.joint("Weld", f"foot cap {s}", "front frame")
    drawing.joint("Revolute", "rear frame", "front frame", cross, Z)
    drawing.joint("Revolute", "seat", "rear frame", seat, Z)
    return drawing


@kind
def three_leaf_hinge(random):
    """Three leaves on one pin with two heads, each screwed to a panel: by screws, or by holes without any."""
    drawing, play, span = Drawing(["panel 0"], unit="INCH"), random.choice([0.05, 0.1]), random.uniform(10, 14)
    angles = (0.0, random.uniform(105, 120), random.uniform(220, 240))
    for k, angle in enumerate(angles):
        own = [tube((0, 0, j * span + 0.1), Z, 2.5 + (play if k else 0), 5, span - 0.2) for j in (k, k + 3)]
        others = [cyl((0, 0, j * span - 0.1), Z, 5.6, span + 0.2) for j in range(6) if j not in (k, k + 3)]
        plate = cut(box((0, 3, 0.1), (40, 5, 6 * span - 0.1)), *others)
        panel = box((10, 5, -20), (150, 23, 6 * span + 20))
        for x, z in ((20, span), (32, 3 * span), (20, 5 * span)):
            plate = cut(plate, bore((x, 4, z), Y, 2.2, 5))
            panel = cut(panel, cyl((x, 4, z), Y, 1.6 if k == 1 else 2, 14))
            if k != 1:
                drawing.add(f"screw {k} {x} {z:.0f}", screw((x, 3, z), Y, 2, 14).rotate((0, 0, 0), (0, 0, 1), angle))
        drawing.add(f"leaf {k}", union(plate, *own).rotate((0, 0, 0), (0, 0, 1), angle))
        drawing.add(f"panel {k}", panel.rotate((0, 0, 0), (0, 0, 1), angle))
        drawing.joint("Weld", f"leaf {k}", f"panel {k}")
        if k:
            drawing.joint("Revolute", f"leaf {k}", "leaf 0", (0, 0, 0), Z)
    drawing.add("pin", rivet((0, 0, 0), Z, 2.5, 6 * span))
    return drawing


@kind
def draw_latch(random):
    """A lever on a rivet between cheeks, a bail of wire whose ends lie in the lever, a keeper; a board below both."""
    drawing, play = Drawing(["board"]), random.choice([0.05, 0.15])
    a, b = at(0, 10, 0), at(random.uniform(9, 12), random.uniform(13, 15), 0)
    e = at(random.uniform(52, 60), 14, 0)
    base = [box((-30, 0, -16), (30, 2, 16)), *both_sides(a, a + at(0, -5, 0), 5, 10, 12, (), 0)]
    holes = [bore((x, 1, z), Y, 2, 5) for x in (-22, 22) for z in (-8, 8)]
    drawing.add("base", cut(union(*base), bore(a, Z, 2, 20), *holes))
    lever = [*both_sides(a, at(-55, 16, 0), 4.5, 7.3, 9.5, (), 0), *both_sides(a, b, 4.5, 7.3, 9.5, (), 0)]
    lever.append(box((-55, 15, -7.5), (-12, 18, 7.5)))
    drawing.add("lever", cut(union(*lever), bore(a, Z, 2 + play, 20), bore(b, Z, 1.5 + play, 20)))
    drawing.add("rivet", rivet(a - 12 * Z, Z, 2, 24))
    way = (e - b) / np.linalg.norm(e - b)
    arms = [cyl(b + s * 5 * Z - way * 1.5, way, 1.5, np.linalg.norm(e - b) + 3) for s in (-1, 1)]
    drawing.add("bail", union(cyl(b - 9.5 * Z, Z, 1.5, 19), cyl(e - 6.5 * Z, Z, 1.5, 13), *arms))
    keeper = union(box((e[0] - 12, 0, -10), (e[0] + 20, 2, 10)), box((e[0] - 6, 2, -3), (e[0] - 2, 18, 3)))
    spots = [(e[0] + 13, z) for z in (-6, 6)]
    drawing.add("keeper", cut(keeper, *(bore((x, 1, z), Y, 2, 5) for x, z in spots)))
    spots += [(x, z) for x in (-22, 22) for z in (-8, 8)]
    board = box((-70, -12, -40), (130, 0, 40))
    drawing.add("board", cut(board, *(cyl((x, -9, z), Y, 1.6, 10) for x, z in spots)))
    for k, (x, z) in enumerate(spots[:2]):
        drawing.add(f"keeper screw {k}", screw((x, 2, z), -Y, 1.6, 10))
    drawing.joint("Weld", "base", "board")
    drawing.joint("Weld", "keeper", "board")
    drawing.joint("Revolute", "lever", "base", a, Z)
    drawing.joint("Revolute", "bail", "lever", b, Z)
    return drawing


@kind
def drone_arm(random):
    """An arm on a sleeve between two plates on stand-offs, a motor in two bearings, blades on screws in its hub."""
    drawing, play, reach = Drawing(["lower plate"]), random.choice([0.05, 0.1]), random.uniform(100, 140)
    posts = [at(-50, -30, 0), at(-50, 30, 0), at(-15, 30, 0)]
    for name, z in (("lower plate", 0), ("upper plate", 22)):
        drawing.add(name, cut(box((-60, -40, z), (10, 40, z + 2)), *(bore(p, Z, 1.5) for p in [*posts, 0 * X])))
    for k, p in enumerate(posts):
        drawing.add(f"stand-off {k}", hexagon(p + 2 * Z, Z, 2.75, 20, 1.5))
        drawing.add(f"lower screw {k}", screw(p, Z, 1.5, 8))
        drawing.add(f"upper screw {k}", screw(p + 24 * Z, -Z, 1.5, 8))
    drawing.add("sleeve", tube((0, 0, 2), Z, 1.5, 4, 20))
    drawing.add("fold screw", screw((0, 0, 24), -Z, 1.5, 28))
    drawing.add("fold nut", hexagon((0, 0, 0), -Z, 2.75, 2.4, 1.5))
    arm = union(box((-9, -8, 2.5), (reach, 8, 21.5)), cyl((reach, 0, 14), Z, 17, 7.5), cyl((0, 0, 2.5), Z, 9, 19))
    m, turns = at(reach, 0, 0), np.arange(4) * np.pi / 2 + 0.4
    spots = [m + 9 * at(np.cos(t), np.sin(t), 0) for t in turns]
    arm = cut(arm, cyl(m - Z, Z, 13, 15), bore(0 * X, Z, 4 + play), bore(m, Z, 4.5), *(bore(p, Z, 1.6) for p in spots))
    drawing.add("arm", arm)
    stator = cut(
        union(cyl(m + 21.5 * Z, Z, 14, 3), cyl(m + 24.5 * Z, Z, 6, 15.5)), bore(m, Z, 3.2), cyl(m + 24 * Z, Z, 4, 20)
    )
    drawing.add("stator", cut(stator, *(cyl(p + 20 * Z, Z, 1.25, 4) for p in spots)))
    for k, z in enumerate((24.0, 37.5)):
        drawing.add(f"inner ring {k}", tube(m + z * Z, Z, 1.5, 2.2, 2.5))
        drawing.add(f"outer ring {k}", tube(m + z * Z, Z, 3.3, 4, 2.5))
    groove = tube(m + 23.0 * Z, Z, 1.35, 2, 0.6)
    drawing.add("shaft", cut(cyl(m + 22.4 * Z, Z, 1.5, 30), groove))
    drawing.add("shaft clip", circlip(m + 23.0 * Z, Z, 1.5, 0.6))
    drawing.add("bell", union(tube(m + 41 * Z, Z, 1.5, 15.5, 2), tube(m + 26 * Z, Z, 14.2, 15.5, 15)))
    hub = union(*(box(m + at(-15, -5, z), m + at(15, 5, z + 2)) for z in (43, 48)), cyl(m + 43 * Z, Z, 5, 7))
    roots = [m + s * 11 * X for s in (-1, 1)]
    ties = [m + s * 3.2 * Y for s in (-1, 1)]
    hub = cut(hub, bore(m, Z, 1.5), *(bore(p, Z, 1.5) for p in roots), *(bore(p, Z, 0.8) for p in ties))
    drawing.parts["bell"] = cut(drawing.parts["bell"], *(bore(p, Z, 0.8) for p in ties))
    drawing.add("hub", hub)
    for s, root in zip((-1, 1), roots, strict=True):
        blade = bar(root, root + s * 70 * X, 4.5, 45.2, 47.8, (root,), 1.5 + play)
        drawing.add(f"blade {s}", blade)
        drawing.add(f"blade screw {s}", screw(root + 50 * Z, -Z, 1.5, 7))
        drawing.joint("Revolute", f"blade {s}", "hub", root, Z)
    drawing.joint("Weld", "upper plate", "lower plate")
    drawing.joint("Revolute", "arm", "lower plate", (0, 0, 0), Z)
    drawing.joint("Weld", "stator", "arm")
    drawing.joint("Revolute", "shaft", "stator", m, Z)
    drawing.joint("Weld", "bell", "shaft")
    drawing.joint("Weld", "hub", "bell")
    return drawing
