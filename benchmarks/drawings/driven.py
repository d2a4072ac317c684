"""What motors drive: an orbital sander, a pusher of a packaging machine."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.powered import grooved
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, screw, sphere, tube, union

SIDES = (-1, 1)
ORIGIN = 0 * X


def draw(d, parts, *moving):
    """Draw parts, of which "one < other" is rigid with the other, and say what moves."""
    for key, shape in parts.items():
        name, _, body = key.partition(" < ")
        d.add(name, shape)
        if body:
            d.joint("Weld", name, body)
    for each in moving:
        d.joint(*each)
    return d


def spun(p, w, *steps):
    """A turned part: cylinders on one axis, each by its start, radius and length."""
    return union(*(cyl(p + a * w, w, r, b) for a, r, b in steps))


def flag(one, other, half, low, high, holes=(), radius=0.0):
    """A bar in the plane xz between two widths."""
    flat = [(p[0], p[2]) for p in (one, other, *holes)]
    return bar(flat[0], flat[1], half, -high, -low, flat[2:], radius).rotate((0, 0, 0), (1, 0, 0), 90)


def turn(angle):
    """A direction in the plane xz."""
    return at(np.cos(angle), 0, np.sin(angle))


@kind
def bench_sander_linkage(random):
    """A motor shaft with an eccentric pin, a counterweight, a pad on a bearing and on three posts with balls."""
    d, play, off = Drawing(["housing"]), random.choice([0, 0.05, 0.15]), random.uniform(0, 6)
    way, lid, posts = at(np.cos(off), np.sin(off), 0), hollow(98 * Z, Z, 33, 3), hollow(ORIGIN, Z, 46, 3)
    c, wide = random.uniform(1.2, 2.5) * way, random.uniform(58, 66)
    sole, half = hollow(c, Z, 34, 3, 1.4), box((3, -40, 30), (40, 40, 45)).rotate((0, 0, 0), (0, 0, 1), off * 57.29578)
    shaft = spun(c, Z, (19, 4, 7), (26, 6, 3)).union(spun(ORIGIN, Z, (29, 11, 3), (32, 5, 62), (94, 4, 7)))
    pad = cut(
        spun(c, Z, (8, wide, 8), (8, 19, 20)), spun(c, Z, (19, 11, 20), (0, 8.5, 50)), tube(c + 26 * Z, Z, 10, 11.8, 1)
    )
    for k, p in enumerate(posts):
        low, high = p + c + 14.5 * Z, p + 47 * Z
        cup = cut(spun(p + c, Z, (8, 8.01, 8), (16, 10, 2)), sphere(low, 5 + play), cyl(low, Z, 3.9, 6))
        draw(
            d,
            {
                f"post cup {k} < pad": cup,
                f"post {k}": union(sphere(low, 5), sphere(high, 5), cyl(low, high - low, 2.5, 30)),
                f"lid screw {k} < lid": screw(lid[k] + 8 * Z, -Z, 1.5, 18),
                f"sole screw {k} < pad": screw(sole[k] + 2 * Z, Z, 2, 12),
            },
            ("Spherical", f"post {k}", "housing", high),
            ("Spherical", f"post {k}", "pad", low),
        )
    return draw(
        d,
        {
            "housing": cut(
                spun(ORIGIN, Z, (42, 58, 12), (42, 36, 56)),
                spun(ORIGIN, Z, (54, 30, 60), (44, 13, 20), (40, 10.5, 20)),
                *(cyl(p, -Z, 1.25, 12) for p in lid),
                *(sphere(p + 47 * Z, 5 + play) for p in posts),
                *(cyl(p + 41 * Z, Z, 3.9, 6) for p in posts),
            ),
            "lid < housing": cut(
                spun(ORIGIN, Z, (98, 36, 8), (92, 20, 6)), cyl(90 * Z, Z, 11, 11), *(bore(p, Z, 1.6) for p in lid)
            ),
            "motor shaft": grooved(cut(shaft, cyl(c + 19 * Z, Z, random.choice([2.1, 2.5]), 12)), 52 * Z, Z, 5),
            "stator < housing": tube(58 * Z, Z, 17, 30, 30),
            "rotor < motor shaft": tube(58 * Z, Z, 4.99, 16.4, 30),
            "shaft circlip": circlip(52 * Z, Z, 5),
            "set screw < counterweight": cyl(36 * Z - 5 * way, -way, 2, 8),
            "counterweight < motor shaft": cut(
                union(cut(cyl(32 * Z, Z, 24, 8), half), cyl(32 * Z, Z, 11, 8)),
                bore(ORIGIN, Z, 5),
                cyl(36 * Z, -way, 2, 40),
            ),
            "spacer": tube(40 * Z, Z, 5, 7, 4),
            "upper bearing": tube(94 * Z, Z, 4, 11, 7),
            "lower inner ring < motor shaft": tube(44 * Z, Z, 5, 7.5, 8),
            "lower outer ring < housing": tube(44 * Z, Z, 10.5, 13, 8),
            "pad inner ring < motor shaft": tube(c + 19 * Z, Z, 4, 6.3, 7),
            "pad outer ring < pad": tube(c + 19 * Z, Z, 8.8, 11, 7),
            "eccentric washer": tube(c + 18 * Z, Z, 2.6, 6.8, 1),
            "eccentric screw < motor shaft": screw(c + 18 * Z, Z, 2.5, 13),
            "pad circlip": cut(tube(c + 26 * Z, Z, 9.4, 11.8, 1), cyl(c + 26.5 * Z, X, 3, 15)),
            "pad": cut(pad, *(bore(p, Z, 2) for p in sole), *(bore(c + p, Z, 8) for p in posts)),
            "sole < pad": cut(
                cyl(c - 2 * Z, Z, wide, 10), bore(c, Z, 12), *(spun(p, Z, (-3, 3.7, 5), (0, 2.1, 20)) for p in sole)
            ),
            "abrasive disc < sole": cyl(c - 3 * Z, Z, wide, 1),
        },
        ("Revolute", "motor shaft", "housing", ORIGIN, Z),
        ("Revolute", "pad", "motor shaft", c, Z),
    )


@kind
def packaging_pusher(random):
    """A geared motor, a crank disc, a rod with rod ends, a carriage on two rails with linear bushes, a paddle."""
    d, play, long, o = Drawing(["base"]), random.choice([0, 0.02, 0.05]), random.uniform(200, 230), 80 * Z
    c, corners = o + random.uniform(38, 45) * turn(random.uniform(0.5, 5.8)), hollow(o - 50 * Y, Y, 35, 4, 0.785)
    x, ys, feet = c[0] + (long**2 - (c[2] - 80) ** 2) ** 0.5, (-60, 60), [at(i, -15, 0) for i in (-45, 45)]
    k, w, key = o + x * X, (o + x * X - c) / long, box(o + at(-2.5, -30, 5), o + at(2.5, -20, 10.3))
    for name, p, s in (("crank", c, w), ("carriage", k, -w)):
        draw(
            d,
            {
                f"{name} rod end < rod tube": cut(
                    union(cyl(p - 4.5 * Y, Y, 12, 9), cyl(p + 8 * s, s, 4, 34)), sphere(p, 8 + play)
                ),
                f"{name} ball < {'carriage' if s is not w else 'crank disc'}": cut(
                    sphere(p, 8).intersect(cyl(p - 6 * Y, Y, 20, 12)), bore(p, Y, 4)
                ),
                f"{name} lock nut < {name} rod end": hexagon(p + 27 * s, s, 6.5, 5, 4),
            },
            ("Spherical", f"{name} ball", f"{name} rod end", p),
        )
    for i, s in enumerate(SIDES):
        draw(
            d,
            {
                f"support {i} < base": cut(
                    box((80 + 265 * i, -80, 0), (96 + 265 * i, 80, 98)),
                    box((79, -40, 14), (400, 40, 99)),
                    *(bore(o + e * Y, X, 6) for e in ys),
                    *(cyl((88 + 265 * i, e, 80), Z, 2.5, 20) for e in ys),
                ),
                f"rail {i} < support 0": cyl((80, ys[i], 80), X, 6, 281),
                f"paddle screw {i} < paddle": screw(at(x + 56, s * 40, 107), -X, 2.5, 20),
            },
        )
        for j, e in enumerate(ys):
            draw(
                d,
                {
                    f"set screw {i}{j} < support {i}": cyl((88 + 265 * i, e, 86), Z, 2.5, 10),
                    f"bush {i}{j} < carriage": tube((x + s * 46, e, 80), -s * X, 6 + play, 10.5, 30),
                },
            )
    carriage = union(
        box((x - 50, -85, 102), (x + 50, 85, 112)),
        *(box((x - 48, y - 17, 62), (x + 48, y + 17, 102)) for y in ys),
        *(box((x - 12, s * 6, 66), (x + 12, s * 12, 103)) for s in SIDES),
    )
    return draw(
        d,
        {
            "base": cut(box((-80, -130, -12), (380, 100, 0)), *(bore(f, Z, 3.3, 20) for f in feet)),
            "bracket < base": cut(
                union(box((-60, -50, 0), (60, -42, 140)), box((-60, -50, 0), (60, 0, 8))),
                bore(o, Y, 12),
                *(bore(p, Y, 2.5, 20) for p in corners),
                *(bore(f, Z, 3.3, 20) for f in feet),
            ),
            "gearmotor < bracket": cut(
                union(box(o + at(-35, -120, -35), o + at(35, -50, 35)), cyl(o - 120 * Y, -Y, 30, 100)),
                spun(o, -Y, (50, 17, 12), (40, 10.5, 65)),
                *(cyl(p, -Y, 2.5, 14) for p in corners),
            ),
            "carriage": cut(
                carriage,
                bore(k, Y, 4, 30),
                *(bore(y * Y + o, X, 10.49) for y in ys),
                *(cyl((x + 60, s * 40, 107), -X, 2.5, 30) for s in SIDES),
            ),
            "motor bearing": tube(o - 50 * Y, -Y, 10, 17, 12),
            "shaft key < output shaft": key,
            "output shaft": cut(spun(o, -Y, (30, 10, 72), (20, 8, 12)), key, cyl(o - 20 * Y, -Y, 2.5, 14)),
            "crank disc < output shaft": cut(cyl(o - 30 * Y, Y, 58, 10), bore(o, Y, 8), key, bore(c, Y, 4)),
            "end washer": tube(o - 20 * Y, Y, 2.6, 12, 2),
            "end screw < output shaft": screw(o - 18 * Y, -Y, 2.5, 14),
            "crank bolt < crank disc": headed(c + 6 * Y, -Y, 4, 36),
            "spacer": tube(c - 20 * Y, Y, 4, 7, 14),
            "rod tube": tube(c + 32 * w, w, 4, 8, long - 64),
            "carriage bolt < carriage": headed(k - 12 * Y, Y, 4, 24),
            "paddle < carriage": cut(
                box((x + 50, -80, 100), (x + 56, 80, 190)), *(bore((x, s * 40, 107), X, 2.5) for s in SIDES)
            ),
        },
        ("Revolute", "output shaft", "gearmotor", o, Y),
        ("Prismatic", "carriage", "base", k, X),
    )
