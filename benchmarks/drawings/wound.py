"""What hands wind: a spinning reel, a sluice gate."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.driven import ORIGIN, SIDES, draw, flag, spun, turn
from drawings.guided import hollow
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, headed, hexagon, laid, screw, sphere, torus, tube, union


@kind
def fishing_reel(random):
    """A spinning reel: a crank with a gear, a pinion with a rotor, a spool shaft on a slider, a bail with a roller."""
    d, play, crank, osc, pivot = Drawing(["body"]), random.choice([0.02, 0.05]), at(-8, 0, -14), at(-38, 0, -16), 84 * X
    end, v = crank + random.uniform(48, 58) * turn(random.uniform(3.4, 4.9)), turn(random.uniform(1, 1.4))
    pin, roll, rods, spots = (
        osc + 7 * turn(random.uniform(0, 6)),
        pivot + 13 * v,
        [at(0, 2, -34), at(0, -1, 11)],
        [at(-54, 0, -39), at(14, 0, -39)],
    )
    s, bores = pin[0] * X, [cyl(p - 58 * X, X, 2, 77) for p in rods]
    body = union(
        cut(box((-60, -16, -45), (20, 17, 18)), box((-57, -12, -42), (17, 18, 15))),
        cyl(17 * X, X, 14, 23),
        cyl(crank - 22 * Y, Y, 11, 8),
        box((-30, -4, 16), (-10, 4, 70)),
        box((-55, -8, 70), (20, 8, 74)),
        *(cyl(p + 6 * Y, Y, 4, 11) for p in spots),
    )
    square, cross, flats = (
        box(crank + at(-2.8, 23, -2.8), crank + at(2.8, 28.5, 2.8)),
        cyl(crank - 6 * X, X, 1.25, 12),
        cyl(41 * X, X, 4, 4).intersect(box((40, -5, -3.2), (46, 5, 3.2))),
    )
    for k, (y, name) in enumerate(((-1, "left"), (1, "right"))):
        draw(
            d,
            {
                f"{name} bail lever < bail wire": cut(
                    flag(pivot, pivot + 26 * v, 6, *sorted((y * 35.2, y * 41.2))),
                    bore(pivot, Y, 2.5 + play),
                    cyl(pivot + 20 * v + y * 38.2 * Y, v, 1, 20),
                    cyl(roll, Y, 1.5, 99),
                ),
                f"{name} bail screw < rotor": headed(pivot + y * 41.4 * Y, -y * Y, 2.5, 6.4).union(
                    cyl(pivot + y * 36 * Y, -y * Y, 2, 6)
                ),
                f"cover screw {k} < cover": screw(spots[k] + 20 * Y, -Y, 1.25, 10),
                f"guide rod {k} < body": bores[k],
            },
        )
    return draw(
        d,
        {
            "body": cut(
                body,
                spun(ORIGIN, X, (22, 10, 30), (10, 7, 20)),
                cyl(crank - 19 * Y, Y, 8, 10),
                cyl(osc - 20 * Y, Y, 3, 15),
                *bores,
                *(cyl(p + 8 * Y, Y, 1.25, 20) for p in spots),
            ),
            "cover < body": cut(
                box((-60, 17, -45), (20, 20, 18)).union(cyl(crank + 13 * Y, Y, 11, 7)),
                cyl(crank + 10 * Y, Y, 8, 8),
                bore(crank, Y, 4.5),
                *(bore(p, Y, 1.25) for p in spots),
            ),
            "drive gear < handle shaft": cut(
                spun(crank, Y, (-13.8, 6, 26.6), (-10, 17.9, 3), (8, 22, 3)), bore(crank, Y, 4), cross
            ),
            "handle shaft": cut(union(cyl(crank - 19 * Y, Y, 4, 42), square), cross, cyl(crank + 16 * Y, Y, 2, 20)),
            "left handle bearing": tube(crank - 19 * Y, Y, 4, 8, 5),
            "right handle bearing": tube(crank + 13 * Y, Y, 4, 8, 5),
            "gear pin < drive gear": cross,
            "slider set screw < slider": cyl(s + 3 * Y, Y, 1.5, 2),
            "handle arm < handle shaft": cut(
                flag(crank, end, 8, 23, 29, [end], 3), square, bore(crank + 28 * Y, Y, 2, 5)
            ),
            "handle screw < handle shaft": screw(crank + 29 * Y, -Y, 2, 12),
            "knob pin < handle arm": spun(end, Y, (23, 3, 40), (62.2, 5, 2)),
            "knob": cut(cyl(end + 30 * Y, Y, 9, 32), bore(end, Y, 3 + play), torus(end + 46 * Y, Y, 14, 6)),
            "oscillating gear": cut(
                union(cyl(osc - 10 * Y, Y, 12, 3), cyl(pin - 8 * Y, Y, 2, 5.5)), bore(osc, Y, 3 + play)
            ),
            "gear stud < body": spun(osc, Y, (-16, 3, 9.5), (-6.9, 4.5, 0.6)),
            "slider": cut(
                box(s + at(-6, -6, -38), s + at(6, 5, 14)),
                bore(s, X, 3),
                *(bore(p, X, 2 + play) for p in rods),
                box(s + at(-2 - play, -7, -26), s + at(2 + play, -2, -6.5)),
                cyl(s, Y, 1.5, 9),
            ),
            "spool shaft < slider": spun(s, X, (-7, 3, 151), (98, 6, 4)),
            "bearing spacer": tube(26 * X, X, 5, 6.5, 8),
            "pinion": cut(
                union(spun(ORIGIN, X, (-13, 6, 35), (22, 5, 19), (45, 4, 5)), flats), bore(ORIGIN, X, 3 + play)
            ),
            "rear pinion bearing": tube(22 * X, X, 5, 10, 4),
            "front pinion bearing": tube(34 * X, X, 5, 10, 4),
            "rotor < pinion": cut(
                union(
                    cyl(41 * X, X, 31, 4),
                    tube(23 * X, X, 28, 31, 20),
                    *(box((25, y * 30, -6), (91, y * 35, 6)) for y in SIDES),
                ),
                flats,
                bore(pivot, Y, 2),
            ),
            "rotor nut < pinion": hexagon(45 * X, X, 6.5, 4, 4),
            "drag knob < spool shaft": cut(cyl(s + 134 * X, X, 12, 12), cyl(s + 128 * X, X, 3, 16)),
            "spool": cut(spun(s, X, (102, 24, 4), (106, 16, 24), (130, 24, 4)), bore(ORIGIN, X, 3 + play)),
            "bail wire": laid(
                union(
                    cut(torus(ORIGIN, Z, 38.2, 1), box((-60, -60, -5), (60, 0, 5))),
                    *(cyl((y * 38.2, -12, 0), Y, 1, 12) for y in SIDES),
                ),
                pivot + 32 * v,
                Y,
                np.cross(Y, v),
            ),
            "roller screw < right bail lever": headed(roll + 29.9 * Y, Y, 1.5, 11.3),
            "line roller": cut(tube(roll + 30 * Y, Y, 1.5 + play, 4, 5), torus(roll + 32.5 * Y, Y, 5, 1.8)),
        },
        ("Revolute", "handle shaft", "body", crank, Y),
        ("Revolute", "knob", "handle arm", end, Y),
        ("Revolute", "oscillating gear", "body", osc, Y),
        ("Revolute", "pinion", "body", ORIGIN, X),
        ("Prismatic", "slider", "body", s, X),
        ("Cylindrical", "spool shaft", "pinion", ORIGIN, X),
        ("Revolute", "spool", "spool shaft", ORIGIN, X),
        ("Revolute", "right bail lever", "rotor", pivot, Y),
        ("Revolute", "line roller", "right bail lever", roll, Y),
    )


@kind
def sluice_gate(random):
    """A leaf in lined guides, hung on a stem by a clevis; a nut on a thrust bearing, bevel wheels, a handwheel."""
    d, play, tap, q = Drawing(["frame"]), random.choice([0, 0.1, 0.2]), random.choice([2.5, 3.0]), 1000 * Z
    p, hub, feet = random.uniform(420, 620) * Z, q - 105 * Y, hollow(930 * Z, Z, 104, 4, 0.785)
    rim = hub + 110 * turn(0.4)
    z, spots, key = (
        p[2] - 400,
        [at(s * 55, s * 55, 1030) for s in SIDES],
        box(q + at(-2.5, -117, 4), q + at(2.5, -95, 10.5)),
    )
    leaf = union(
        box((play - 229, play - 9, z), (229 - play, 9 - play, z + 360)),
        box((-20, -8, z + 350), (20, 8, z + 400)),
        *(box((-185, 0, z + a), (185, 26, z + a + 12)) for a in (10, 120, 230, 340)),
        cyl(p - 8 * Y, Y, 20, 16),
    )
    roll, split, race = (
        cyl(p + 48 * Z - 20 * X, X, 3, 40),
        cyl(p + at(0, 24, -13), Z, 1.5, 26),
        torus(947 * Z, Z, 24.5, 3.21),
    )
    gears = union(box((-60, -60, 930), (60, 60, 1020)), box((-88, -88, 930), (88, 88, 938)), cyl(q - 90 * Y, Y, 18, 40))
    gears = cut(
        gears,
        box((-50, -50, 944), (50, 50, 1021)),
        spun(ORIGIN, Z, (940, 30, 5), (920, 18 + play, 30)),
        cyl(q - 95 * Y, Y, 13, 50),
        *(bore(f, Z, 4.5, 40) for f in feet),
        *(cyl(f, -Z, tap, 32) for f in spots),
    )
    for k, s in enumerate(SIDES):
        draw(
            d,
            {
                f"liner {k} < frame": cut(
                    box((s * 200, -15, 0), (s * 235, 15, 899)), box((s * 199, -9, -1), (s * 229, 9, 900))
                ),
                f"cover screw {k} < gearbox cover": screw(spots[k], -Z, 3, 30),
            },
        )
    return draw(
        d,
        {
            "frame": cut(
                union(
                    box((-250, -30, -40), (250, 30, 0)),
                    box((-250, -90, 900), (250, 90, 930)),
                    *(box((s * 195, -30, -40), (s * 250, 30, 900)) for s in SIDES),
                ),
                bore(930 * Z, Z, 20, 50),
                *(box((s * 194, -15, 0), (s * 235, 15, 900)) for s in SIDES),
                *(bore(f, Z, 4.5, 40) for f in feet),
            ),
            "leaf": cut(leaf, bore(p, Y, 8 + play)),
            "bottom seal < leaf": box((-185, -8, z - 12), (185, 8, z)),
            "stem": cut(cyl(p + 32 * Z, Z, 12, 1230 - p[2]), roll),
            "lock nut < stem": hexagon(p + 70 * Z, Z, 18, 12, 12),
            "clevis < stem": cut(
                union(
                    box(p + at(-20, -20, 26), p + at(20, 20, 70)),
                    *(box(p + at(-20, s * 8.5, -20), p + at(20, s * 20, 30)) for s in SIDES),
                ),
                bore(p, Y, 8),
                cyl(p + 20 * Z, Z, 12, 60),
                roll,
            ),
            "roll pin < clevis": roll,
            "cotter": split,
            "clevis pin": cut(headed(p - 20 * Y, Y, 8, 46), split),
            "gearbox < frame": gears,
            "gearbox cover < gearbox": cut(
                box((-60, -60, 1020), (60, 60, 1030)), bore(q, Z, 22), *(bore(f, Z, 3.2) for f in spots)
            ),
            "cover bush < gearbox cover": tube(1012 * Z, Z, 18 + play, 22, 18),
            "key < pinion shaft": key,
            "stem nut": cut(spun(ORIGIN, Z, (931, 18, 104), (954, 30, 8)), bore(q, Z, 12)),
            "lower race < gearbox": cut(tube(940 * Z, Z, 19, 30, 4), race),
            "upper race < stem nut": cut(tube(950 * Z, Z, 18, 30, 4), race),
            "bevel wheel < stem nut": cut(spun(ORIGIN, Z, (962, 44, 12), (974, 30, 8)), bore(q, Z, 17.99)),
            "pinion shaft": cut(spun(q, -Y, (22, 9, 69), (91, 8, 28), (119, 6, 16)), key),
            "pinion screw < bevel pinion": cyl(q + at(0, -35, 9), Z, 2.5, 6),
            "pinion bush < gearbox": tube(q - 90 * Y, Y, 9 + play, 13, 40),
            "bevel pinion < pinion shaft": cut(tube(q - 24 * Y, -Y, 9, 16, 25.5), cyl(q - 35 * Y, Z, 2.5, 20)),
            "handwheel < pinion shaft": cut(
                union(
                    cyl(q - 119 * Y, Y, 18, 28),
                    tube(hub - 9 * Y, Y, 101, 119, 18),
                    *(cyl(hub, e - hub, 7, 104) for e in hollow(hub, Y, 108, 4)),
                ),
                bore(q, Y, 8),
                key,
                bore(rim, Y, 4),
            ),
            "wheel nut < pinion shaft": hexagon(q - 119 * Y, -Y, 9, 10, 6),
            "knob": tube(rim - 74 * Y, Y, 4 + play, 11, 62),
            "knob bolt < handwheel": headed(rim - 75 * Y, Y, 4, 83),
            **{f"ball {k}": sphere(b, 3.2) for k, b in enumerate(hollow(947 * Z, Z, 24.5, 6))},
        },
        ("Prismatic", "leaf", "frame", ORIGIN, Z),
        ("Revolute", "clevis", "leaf", p, Y),
        ("Cylindrical", "stem", "stem nut", ORIGIN, Z),
        ("Revolute", "stem nut", "gearbox", ORIGIN, Z),
        ("Revolute", "pinion shaft", "gearbox", q, Y),
        ("Revolute", "knob", "handwheel", rim, Y),
    )
