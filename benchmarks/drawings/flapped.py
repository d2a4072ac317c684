"""A walking beam on two crankshafts, the riveted linkage of a recliner, and the drive of an ornithopter's wings."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from drawings.catalogued import capscrew, plate, upright, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, headed, laid, rivet, tube, union


@kind
def walking_beam(random: np.random.Generator) -> Drawing:
    """A welded frame, pillow blocks of two solids, keyed discs with shoulder bolts, a beam with bushes, sprockets.

    Truth: two shafts turn in the frame, the beam turns on the bolts of the discs. One freedom.
    """
    d, play, turn = Drawing(["Frame"]), random.choice([0.05, 0.1, 0.2]), random.uniform(0.3, 1.2)
    frame = union(*(box((-220, s * 55, 60), (220, s * 85, 80)) for s in (-1, 1)))
    frame = union(frame, *(box((x - 15, -85, 60), (x + 15, 85, 80)) for x in (-205, 205)))
    legs = [box((x - 15, s * 55, 0), (x + 15, s * 85, 60)) for s in (-1, 1) for x in (-205, 205)]
    posts = [box((x - 4, s * 60, 80), (x + 4, s * 80, 190)) for s in (-1, 1) for x in (-190, 0, 190)]
    frame = union(frame, *legs, *posts)
    crank = 22 * at(np.cos(turn), 0, np.sin(turn))
    beam = union(*(box((x - 10, -130, 195), (x + 10, 130, 203)) for x in (-130, -40, 40, 130)))
    for side in (-1, 1):
        beam = union(beam, box((-170, side * 114, 115 + crank[2]), (170, side * 126, 140 + crank[2])))
        beam = union(beam, *(box((x - 8, side * 114, 130), (x + 8, side * 126, 203)) for x in (-130, -40, 40, 130)))
    for word, x in (("front", 120), ("rear", -120)):
        spin = at(x, 0, 112)
        shaft = cyl(spin - 107 * Y, Y, 10, 214)
        for side, tag in ((1, "L"), (-1, "R")):
            name, pin = f"{word} {tag}", spin + crank
            low = box(spin + at(-45, side * 58, -32), spin + at(45, side * 82, -20))
            low = low.union(cyl(spin + side * 60 * Y, side * Y, 24, 20)).union(
                box(spin + at(-18, side * 58, -25), spin + at(18, side * 82, -10))
            )
            bolts = [spin + at(a * 34, side * 70, -20) for a in (-1, 1)]
            low = cut(low, bore(spin, Y, 16, 300), *(bore(p, Z, 4.4, 14) for p in bolts))
            fast(d, "Frame", **{f"Pillow block {name}": low})
            frame = cut(frame, *(cyl(p - 30 * Z, Z, 4, 19) for p in bolts))
            for k, p in enumerate(bolts):
                fast(d, f"Pillow block {name}", **{f"M8 {name} {k}": capscrew(p, -Z, 4, 26)})
            d.add(f"Insert {name}", tube(spin + side * 58 * Y, side * Y, 10, 16, 24))
            key = box(spin + at(-3, side * 95, 6.5), spin + at(3, side * 107, 12.5))
            shaft = shaft.cut(key)
            disc = tube(spin + side * 95 * Y, side * Y, 10, 38, 12).cut(key).cut(bore(pin, Y, 6))
            fast(d, f"Shaft {word}", **{f"Disc {name}": disc, f"Key {name}": key})
            screw = union(cyl(pin + side * 107 * Y, -side * Y, 6, 12), cyl(pin + side * 107 * Y, side * Y, 8, 20))
            screw = screw.union(cyl(pin + side * 127 * Y, side * Y, 13, 7))
            fast(d, f"Disc {name}", **{f"Shoulder bolt {name}": screw})
            fast(d, f"Disc {name}", **{f"Thrust washer {name}": tube(pin + side * 107 * Y, side * Y, 8.2, 14, 6)})
            boss = cyl(pin + side * 114 * Y, side * Y, 18, 12)
            beam = beam.union(boss).cut(bore(pin + side * 120 * Y, Y, 11, 12))
            fast(d, "Beam", **{f"Bush {name}": tube(pin + side * 113.5 * Y, side * Y, 8 + play, 11, 13)})
            turns(d, (f"Disc {name}", "Beam", pin, Y))
        d.add(f"Shaft {word}", shaft)
        sprocket = union(tube(spin - 20 * Y, Y, 10, 32, 6), tube(spin - 20 * Y, Y, 10, 18, 22))
        sprocket = sprocket.cut(cyl(spin + at(0, -6, 10), Z, 2.5, 20))
        fast(d, f"Shaft {word}", **{f"Sprocket {word}": sprocket})
        fast(d, f"Sprocket {word}", **{f"Set screw {word}": cyl(spin + at(0, -6, 10), Z, 2.5, 7)})
        turns(d, ("Frame", f"Shaft {word}", spin, Y))
    d.add("Frame", frame)
    d.add("Beam", beam)
    return d


@kind
def recliner_linkage(random: np.random.Generator) -> Drawing:
    """Ten flat links on thirteen rivets with washers, between a rail that is screwed down and a foot board.

    Truth: all rivets are hinges, and the linkage has one freedom.
    """
    d, play, slope = Drawing(["Rail"]), random.choice([0.05, 0.15, 0.3]), np.radians(random.uniform(-48, -38))
    u = at(np.cos(slope), 0, np.sin(slope))
    v = at(np.sin(slope), 0, -np.cos(slope))
    a0, a1, b0, b1 = at(-110, 0, 18), at(-125 + random.uniform(-8, 8), 0, 116), at(0, 0, 18), at(18, 0, 112)
    c0, d0, g0 = at(150, 0, 118), at(66, 0, 112), at(96, 0, 18)
    p, q, w = c0 + 92 * u, d0 + 92 * u, c0 + 40 * v
    r = p + 55 * (p - q) / np.linalg.norm(p - q)
    t, r_up = p - 42 * u, r + at(-16, 0, 26)
    links = {
        "Rail": ([at(-150, 0, 15), at(150, 0, 15)], 0, 5, 14, (a0, b0, g0)),
        "Rear lever": ([a0, a1], 6, 10, 11, (a0, a1)),
        "Front lever": ([b0, b1], 6, 10, 11, (b0, b1)),
        "Seat plate": ([a1, b1, c0], 11, 16, 12, (a1, b1, c0, d0)),
        "Link A": ([p, c0, w], 17, 21, 10, (c0, p, w, t)),
        "Link B": ([d0, q], 17, 21, 10, (d0, q)),
        "Carrier": ([q, r], 22, 26, 10, (p, q, r)),
        "Foot bracket": ([r, r_up, r_up + at(30, 0, 30)], 17, 21, 9, (r, r_up)),
        "Control link": ([t, r_up], 12, 16, 9, (t, r_up)),
        "Drive link": ([g0, w], 6, 10, 10, (g0, w)),
    }
    for name, (points, low, high, half, holes) in links.items():
        legs = [upright([one[::2], other[::2]], low, high, half) for one, other in pairwise(points)]
        d.add(name, cut(union(*legs), *(bore(each, Y, 4 + play) for each in holes)))
    for word, point, one, other, low, high, gap, wide in (
        ("A0", a0, "Rail", "Rear lever", 0, 10, 5, 1),
        ("B0", b0, "Rail", "Front lever", 0, 10, 5, 1),
        ("G0", g0, "Rail", "Drive link", 0, 10, 5, 1),
        ("A1", a1, "Rear lever", "Seat plate", 6, 16, 10, 1),
        ("B1", b1, "Front lever", "Seat plate", 6, 16, 10, 1),
        ("C0", c0, "Seat plate", "Link A", 11, 21, 16, 1),
        ("D0", d0, "Seat plate", "Link B", 11, 21, 16, 1),
        ("P", p, "Link A", "Carrier", 17, 26, 21, 1),
        ("Q", q, "Link B", "Carrier", 17, 26, 21, 1),
        ("R", r, "Carrier", "Foot bracket", 17, 26, 21, 1),
        ("T", t, "Link A", "Control link", 12, 21, 16, 1),
        ("U", r_up, "Foot bracket", "Control link", 12, 21, 16, 1),
        ("W", w, "Link A", "Drive link", 6, 21, 10, 7),
    ):
        d.add(f"Rivet {word}", rivet(point + (low - 0.1) * Y, Y, 4, high - low + 0.2))
        d.add(f"Washer {word}", tube(point + gap * Y, Y, 4.2, 7.5, wide))
        turns(d, (one, other, point, Y))
    toe, way, front = r_up + at(30, 0, 30), at(1, 0, 1), at(1, 0, -1)
    flange = laid(box((-20, -40, 6), (8, -17, 11)), toe, way, front)
    board = laid(box((-22, -90, 11), (50, -5, 23)), toe, way, front)
    spots = [laid(cyl((x, -31, 6), Z, 1, 1), toe, way, front).val().Center() for x in (-13, 1)]
    spots = [at(p.x, p.y, p.z) - 0.5 * front / np.sqrt(2) for p in spots]
    bracket = d.parts["Foot bracket"].union(flange)
    d.parts["Foot bracket"] = cut(bracket, *(bore(p, front, 2.2, 6) for p in spots))
    fast(d, "Foot bracket", Board=cut(board, *(cyl(p, front, 2, 15) for p in spots)))
    for k, p in enumerate(spots):
        fast(d, "Foot bracket", **{f"Screw {k}": capscrew(p, front, 2, 14)})
    return d


@kind
def ornithopter_drive(random: np.random.Generator) -> Drawing:
    """A motor, two stages of gears as discs between carbon plates, cranks with rods, wing levers on shoulder screws.

    Truth: gears and cranks turn, rods turn on their pins, levers on the screws in the plate. Four freedoms.
    """
    d, play, turn = Drawing(["Front plate"]), random.choice([0.0, 0.05, 0.1]), random.uniform(-0.5, 0.5)
    corners = [(-34, 4), (0, 34), (34, 4), (34, -36), (2, -46), (-30, -36)]
    outline = laid(plate(corners, 0, 1.5, 8), (0, 0, 0), Y, X)
    front = union(outline, laid(plate([(-16, 76), (16, 76), (30, 0), (-30, 0)], 0, 1.5, 7), (0, 0, 0), Y, X))
    rear = outline.translate((20, 0, 0))
    posts = [at(0, -30, -40), at(0, 0, 34), at(0, 8, -50)]
    for k, p in enumerate(posts):
        front, rear = front.cut(bore(p, X, 1.1, 5)), rear.cut(bore(p + 20 * X, X, 1.1, 5))
        fast(d, "Front plate", **{f"Standoff {k}": tube(p + 1.5 * X, X, 1, 2.5, 18.5)})
        fast(d, f"Standoff {k}", **{f"M2x6 front {k}": capscrew(p, X, 1, 6)})
        fast(d, f"Standoff {k}", **{f"M2x6 rear {k}": capscrew(p + 21.5 * X, -X, 1, 6)})
    shaft, spin = at(0, 26.3, -32.3), at(0, 2, -32.3)
    motor = union(cyl(spin + 21.5 * X, X, 12, 22), cyl(spin + 21.5 * X, -X, 3, 1.5), cyl(spin + 12 * X, X, 1, 12))
    holes = [spin + at(20, 8 * a, 0) for a in (-1, 1)]
    rear = cut(rear, bore(spin + 20 * X, X, 3, 5), *(bore(p, X, 1.1, 5) for p in holes))
    fast(d, "Rear plate", Motor_2212=cut(motor, *(cyl(p, X, 1, 5) for p in holes)))
    for k, p in enumerate(holes):
        fast(d, "Rear plate", **{f"M2x4 {k}": capscrew(p, X, 1, 4)})
    d.add("Pinion", tube(spin + 12.5 * X, X, 1, 4, 6))
    double = union(cyl(shaft + 13 * X, X, 20, 4), cyl(shaft + 6 * X, X, 6, 7)).cut(bore(shaft, X, 1.5 + play))
    d.add("Double gear", double)
    front, rear = front.cut(bore(shaft, X, 1.5, 5)), rear.cut(bore(shaft + 20 * X, X, 1.5, 5))
    fast(d, "Front plate", Layshaft=cyl(shaft, X, 1.5, 21.5))
    for k, (x, wide) in enumerate(((1.5, 4.3), (17.2, 2.6))):
        fast(d, "Layshaft", **{f"Collar {k}": tube(shaft + x * X, X, 1.5, 3, wide)})
    turns(d, ("Motor 2212", "Pinion", spin, X), ("Layshaft", "Double gear", shaft, X))
    for side, tag in ((1, "R"), (-1, "L")):
        axle, hinge = at(0, side * 26.3, 0), at(0, side * 16, 72)
        pin = axle + 12 * at(0, side * np.cos(turn), np.sin(turn))
        joint = hinge + 22 * at(0, side * np.cos(turn / 3), np.sin(turn / 3))
        for word, x in (("front", 0), ("rear", 20)):
            low = x - 0.5 if word == "front" else x - 1
            fast(d, f"{word.title()} plate", **{f"Bearing {word} {tag}": tube(axle + low * X, X, 2, 4, 3)})
        front, rear = front.cut(bore(axle, X, 4, 5)), rear.cut(bore(axle + 20 * X, X, 4, 5))
        gear = union(cyl(axle + 6 * X, X, 26, 5), cyl(axle + 11 * X, X, 5, 4)).cut(bore(axle, X, 2))
        for a in np.arange(5) * 2 * np.pi / 5:
            gear = gear.cut(bore(axle + 15 * at(0, np.cos(a), np.sin(a)), X, 5))
        d.add(f"Shaft {tag}", cyl(axle - 5 * X, X, 2, 27.5))
        crank = laid(plate([(0, 0), (12, 0)], -5, -1.5, 4.5), axle, (pin - axle) / 12, X)
        crank = cut(crank, bore(axle, X, 2, 9), bore(pin, X, 1.5, 9))
        fast(d, f"Shaft {tag}", **{f"Gear {tag}": gear, f"Crank {tag}": crank})
        fast(d, f"Crank {tag}", **{f"Crank pin {tag}": headed(pin - 10 * X, X, 1.5, 8.5)})
        rod = laid(plate([(0, 0), (np.linalg.norm(joint - pin), 0)], -9.5, -6, 4), pin, joint - pin, X)
        d.add(f"Rod {tag}", cut(rod, bore(pin, X, 1.5 + play, 15), bore(joint, X, 1.5 + play, 15)))
        way = (joint - hinge) / 22
        lever = laid(plate([(0, 0), (22, 0)], -5.5, -1, 5), hinge, way, X)
        lever = lever.union(cyl(hinge + 20 * way - 3.25 * X, way, 4, 26)).cut(
            cyl(hinge + 30 * way - 3.25 * X, way, 2, 50)
        )
        lever = lever.cut(laid(box((18, -9, -9.7), (27, 9, -5.5)), hinge, way, X))
        d.add(f"Wing lever {tag}", cut(lever, bore(hinge, X, 2 + play, 15), bore(joint, X, 1.5, 15)))
        fast(d, f"Wing lever {tag}", **{f"Lever pin {tag}": headed(joint - 10 * X, X, 1.5, 9)})
        fast(d, f"Wing lever {tag}", **{f"Spar {tag}": cyl(hinge + 30 * way - 3.25 * X, way, 2, 180)})
        screw = union(cyl(hinge - 5.7 * X, X, 2, 5.7), cyl(hinge - 8.7 * X, X, 3.5, 3), cyl(hinge, X, 1.5, 3))
        fast(d, "Front plate", **{f"Shoulder screw {tag}": screw})
        front = front.cut(bore(hinge, X, 1.5, 5))
        turns(d, ("Front plate", f"Shaft {tag}", axle, X), (f"Crank {tag}", f"Rod {tag}", pin, X))
        turns(d, (f"Rod {tag}", f"Wing lever {tag}", joint, X), ("Front plate", f"Wing lever {tag}", hinge, X))
    d.add("Front plate", front)
    d.add("Rear plate", rear)
    weld(d, "Standoff 0", "Rear plate")
    return d
