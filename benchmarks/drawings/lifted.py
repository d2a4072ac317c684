"""What is lifted and tilted: a hospital bed, a stage light in its yoke."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.driven import ORIGIN, SIDES, draw, flag, spun, turn
from drawings.guided import hollow
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, headed, hexagon, laid, screw, sphere, tube, union


@kind
def hospital_bed_lift(random):
    """A top frame on two bell cranks with a tie rod; an actuator with a spindle, a keyed nut and a piston tube."""
    d, play, lift = Drawing(["base frame"]), random.choice([0, 0.1, 0.2]), random.uniform(0.35, 0.75)
    spread, reach, rear = random.uniform(380, 430) * X, random.uniform(270, 310), at(110, 0, 110)
    pivots, both = {"head": 120 * Z - spread, "foot": 120 * Z + spread}, {-1: "right", 1: "left"}
    hub, hubs = pivots["head"], pivots.values()
    push, tops, ties = (
        hub + 110 * turn(lift + 0.9),
        [p + reach * turn(lift) for p in hubs],
        [p + 90 * turn(lift + 1.45) for p in hubs],
    )
    long, (x, _, z) = float(np.linalg.norm(push - rear)), tops[0]
    w, end = (push - rear) / long, tops[1][0] + 150
    base, bed, rod = (
        [box((i, -240, 40), (i + 40, 240, 80)) for i in (-600, 90, 560)],
        [box((i, -218, z + 25), (i + 30, 218, z + 55)) for i in (x - 100, end - 30)],
        [cyl(ties[0] + at(40, 90, 0), X, 9, 2 * spread[0] - 80)],
    )
    for s, side in both.items():
        base += [
            box((-600, s * 206, 40), (600, s * 240, 80)),
            box((96, s * 10.5, 78), (126, s * 19, 126)),
            *(box(p + at(-28, s * 203.2, -42), p + at(28, s * 220, 30)) for p in hubs),
        ]
        bed += [
            box((x - 100, s * 178.6, z + 25), (end, s * 218, z + 55)),
            *(box(q + at(-22, s * 178.6, -22), q + at(22, s * 188, 26)) for q in tops),
        ]
        t = ties[s > 0]
        rod += [
            box(t + at(-s * 26, 78, -12), t + at(-s * 46, 102, 12)),
            *(flag(t, t - s * 40 * X, 12, b, b + 7.5) for b in (78, 94.5)),
        ]
        draw(
            d,
            {
                f"{side} actuator lever < head crank": cut(
                    flag(hub, push, 16, *sorted((s * 13.5, s * 19.5))).union(cyl(hub + s * 13.5 * Y, s * Y, 30, 6)),
                    bore(hub, Y, 21),
                    bore(push, Y, 6),
                )
            },
        )
    for (name, p), q, t in zip(pivots.items(), tops, ties, strict=True):
        crank = union(
            cyl(p - 200 * Y, Y, 21, 400),
            flag(p, t, 14, 86, 94, [t], 6 + play),
            *(flag(p, q, 24, *sorted((s * 170, s * 178)), [q], 8 + play) for s in SIDES),
        )
        draw(
            d,
            {f"{name} crank": cut(crank, bore(p, Y, 16)), f"{name} tie pin": headed(t + 78 * Y, Y, 6, 26)},
            *(
                ("Revolute", f"{name} crank", *each, Y)
                for each in (("base frame", p), ("top frame", q), ("tie rod", t))
            ),
        )
        for s, side in both.items():
            draw(
                d,
                {
                    f"{name} {side} bush < {name} crank": cut(
                        spun(p, s * Y, (175, 16.01, 25), (200, 22, 3)), bore(p, Y, 10 + play)
                    ),
                    f"{name} {side} bolt < top frame": headed(q + s * 169.8 * Y, s * Y, 8, 8.8).union(
                        cyl(q + s * 178 * Y, s * Y, 5, 20)
                    ),
                    f"{name} {side} pivot pin": headed(p + s * 220 * Y, -s * Y, 10, 42),
                    f"{name} {side} lock nut < top frame": hexagon(q + s * 188 * Y, s * Y, 8, 9, 5),
                },
            )
    nut = spun(rear, w, (110, 16.95, 15), (125, 10, 12)).union(laid(box((14, -2.9, 110), (18, 2.9, 125)), rear, Y, w))
    return draw(
        d,
        {
            "base frame": cut(union(*base), bore(rear, Y, 6), *(bore(p, Y, 10) for p in hubs)),
            "top frame": cut(union(*bed), *(bore(q, Y, 5) for q in tops)),
            "tie rod": cut(union(*rod), *(bore(t, Y, 6) for t in ties)),
            "actuator motor < outer tube": cut(
                union(
                    cyl(rear - 10 * Y, Y, 14, 20),
                    spun(rear, w, (0, 10, 30), (26, 26, 46)),
                    cyl(rear + 49 * w, -Y, 22, 120),
                ),
                bore(rear, Y, 6 + play),
                spun(rear, w, (34, 8, 30), (62, 18, 10)),
            ),
            "outer tube": cut(
                spun(rear, w, (72, 21, long / 2), (72, 26, 6)),
                bore(rear, w, 17, 900),
                laid(box((10, -3, 60), (18.2, 3, 900)), rear, Y, w),
            ),
            "gland < outer tube": tube(rear + (57 + long / 2) * w, w, 13 + play, 17, 15),
            "spindle bearing": tube(rear + 62 * w, w, 5, 18, 10),
            "spindle": spun(rear, w, (36, 5, 36), (72, 6, long - 120)),
            "spindle nut < piston tube": cut(nut, bore(rear, w, 6, 900)),
            "piston tube": tube(rear + 125 * w, w, 10, 13, long - 139),
            "rear pin": headed(rear - 19 * Y, Y, 6, 42),
            "front eye < piston tube": cut(
                union(cyl(push - 13 * Y, Y, 13, 26), cyl(push - 8 * w, -w, 10, 24)), bore(push, Y, 6 + play)
            ),
            "front pin": headed(push - 19.5 * Y, Y, 6, 43),
        },
        ("Revolute", "actuator motor", "base frame", rear, Y),
        ("Revolute", "spindle", "actuator motor", rear, w),
        ("Cylindrical", "spindle", "spindle nut", rear, w),
        ("Prismatic", "piston tube", "outer tube", rear, w),
        ("Revolute", "front eye", "head crank", push, Y),
    )


@kind
def stage_light_yoke(random):
    """A hook clamp on a pipe, a swivel bolt, a yoke with a knob, a lamp with a tray on rods and a barn door."""
    d, play, a, y = Drawing(["pipe"]), random.choice([0.1, 0.2]), random.uniform(0.3, 0.9), random.uniform(-75, -30)
    t, n, u, caps = (
        -random.uniform(266, 296) * Z,
        (Y - Z) / 2**0.5,
        np.cos(a) * Y - np.sin(a) * Z,
        hollow(ORIGIN, Y, 82, 3),
    )
    seat, rods, ears, hinges = (
        at(0, y + 25, 0),
        [at(s * 30, -113, -60) for s in SIDES],
        [s * at(68, 0, 68) for s in SIDES],
        [at(0, 119, s * 97) for s in SIDES],
    )
    clamp = cut(
        union(cyl(-15 * X, X, 33, 30), box((-15, -20, -66), (15, 14, -26)), cyl(28 * n, n, 11, 26)),
        bore(ORIGIN, X, 24.1),
        box((-16, 6, -12), (16, 40, 40)),
        spun(ORIGIN, n, (20, 9.5, 11), (20, 5, 60)),
        cyl(-70 * Z, Z, 6, 34),
        cyl((0, -25, -50), Y, 4, 25),
    )
    yoke = union(
        box((-124, -20, -76), (124, 20, -68)),
        *(box((s * 118, -20, t[2]), (s * 124, 20, -68)) for s in SIDES),
        *(cyl(t + s * 118 * X, s * X, 20, 6) for s in SIDES),
    )
    can = union(
        cyl(-110 * Y, Y, 90, 220),
        *(cyl(s * 84 * X, s * X, 14, 32) for s in SIDES),
        *(cyl(e + 95 * Y, Y, 7, 15) for e in ears),
    )
    can = union(
        cut(can, bore(ORIGIN, Y, 86)),
        tube(96 * Y, Y, 78, 86.5, 4),
        tube(60 * Y, Y, 60, 86.5, 4),
        *(cyl(e - 110 * Y, Y, 5, 20) for e in caps),
    )
    barn = union(box((-95, 114, -95), (95, 117, 95)), *(cyl(h + x * X, X, 3.5, 15) for h in hinges for x in (-57, 42)))
    lamp = {
        "can": cut(
            can,
            bore(ORIGIN, X, 5),
            box((-3.2, -100, -95), (3.2, 50, -80)),
            *(cyl(e, Y, 4, 200) for e in rods),
            *(cyl(e - 120 * Y, Y, 1.25, 28) for e in caps),
            *(bore(e, Y, 2) for e in ears),
        ),
        "barn frame < front plate": cut(
            barn,
            bore(ORIGIN, Y, 80),
            *(bore(e, Y, 2) for e in ears),
            *(cyl(h - 41.5 * X, X, 4, 83) for h in hinges),
            *(bore(h, X, 1.5) for h in hinges),
        ),
        "tray": cut(
            box((-45, y, -66), (45, y + 50, -54)), *(bore(e, Y, 4 + play) for e in rods), cyl(seat - 70 * Z, Z, 3, 12)
        ),
        "lens < can": cyl(100 * Y, Y, 85.5, 10).intersect(sphere(-510 * Y, 620)),
        "front plate < can": cut(
            box((-95, 110, -95), (95, 114, 95)), bore(ORIGIN, Y, 78), *(bore(e, Y, 2) for e in ears)
        ),
        "rear cap < can": cut(
            cyl(-116 * Y, Y, 90, 6), *(bore(e, Y, 1.6) for e in caps), *(cyl(e, Y, 4, 9) for e in rods)
        ),
        "socket < tray": cut(box(seat + at(-15, -12, -54), seat + at(15, 12, -30)), cyl(seat - 40 * Z, Z, 6, 20)),
        "bulb < socket": cyl(seat - 40 * Z, Z, 6, 30).union(sphere(seat, 18)),
        "focus knob < tray": spun(seat, -Z, (58, 3, 36), (91, 12, 16)),
        "tilt knob < can": spun(ORIGIN, X, (126, 18, 18), (92, 5, 34)),
        "tilt bolt < can": hexagon(-126 * X, -X, 8.5, 7).union(cyl(-126 * X, X, 5, 34)),
        **{f"cap screw {k} < rear cap": screw(e - 116 * Y, Y, 1.5, 18) for k, e in enumerate(caps)},
    }
    for k, (s, h) in enumerate(zip(SIDES, hinges, strict=True)):
        flap = box(h + at(-41, 0, -0.8), h + at(41, random.uniform(70, 90), 0.8)).rotate(
            tuple(h), tuple(h + X), s * random.uniform(5, 60)
        )
        lamp |= {
            f"flap {k}": cut(union(flap, cyl(h - 41 * X, X, 3.5, 82)), bore(h, X, 1.5 + play / 2)),
            f"rod {k} < rear cap": cyl(rods[k], Y, 4, 177),
            f"hinge pin {k} < barn frame": cyl(h - 58 * X, X, 1.5, 116),
            f"front screw {k} < front plate": screw(ears[k] + 117 * Y, -Y, 2, 20),
            f"inner washer {k}": tube(s * 116 * X, s * X, 5, 13, 2),
            f"outer washer {k}": tube(s * 124 * X, s * X, 5, 13, 2),
        }
        draw(
            d,
            {f"swivel washer {k}": tube(-(68 + 10 * k) * Z, Z, 6, 14, 2)},
            ("Revolute", f"flap {k}", "barn frame", t + 119 * u + s * 97 * np.cross(X, u), X),
        )
    draw(
        d,
        {
            name: shape.rotate((0, 0, 0), (1, 0, 0), -float(np.degrees(a))).translate(tuple(t))
            for name, shape in lamp.items()
        },
    )
    return draw(
        d,
        {
            "pipe": tube(-200 * X, X, 21, 24.1, 400),
            "clamp < pipe": clamp,
            "yoke": cut(yoke, bore(t, X, 5 + play), bore(-72 * Z, Z, 6 + play, 20)),
            "pressure pad": cut(cyl(20 * n, n, 9, 10.5), bore(ORIGIN, X, 24.1), cyl(27 * n, n, 5, 9)),
            "swivel bolt < clamp": screw(-78 * Z, Z, 6, 42),
            "clamp bolt < clamp": union(spun(ORIGIN, n, (27, 5, 45), (62, 8, 12)), cyl(68 * n - 20 * X, X, 3, 40)),
            "pan lock < clamp": spun(at(0, 0, -50), -Y, (6, 4, 39), (45, 14, 12)),
        },
        ("Revolute", "yoke", "clamp", ORIGIN, Z),
        ("Revolute", "can", "yoke", t, X),
        ("Prismatic", "tray", "can", t, u),
    )
