"""What stays where it is put: a folding scooter's stem, a window on stays, an arm that holds a tablet."""

from __future__ import annotations

import numpy as np
from numpy.linalg import norm

from drawings.drawing import kind
from drawings.guided import hollow
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, headed, hexagon, rivet, screw, sphere, torus, tube, union
from drawings.swung import SIDES, Machine, W, boxes, drill, stack, strap


@kind
def folding_scooter_stem(random):
    """A fork in headset bearings, a hinge block clamped on it, a folding stem with a hook latch, a handlebar."""
    d, hinge, latch, catch, grip, half, race, cup = (
        Machine(random, "frame"),
        at(-26, 190, 0),
        at(37, 205, 0),
        at(37, 159, 0),
        at(2, random.uniform(600, 720), 0),
        random.uniform(210, 260),
        torus(106.5 * Y, Y, 18, 1.7),
        103 * Y,
    )
    frame, fork, block = (
        union(
            cyl(W, Y, 26, 110), cyl((-8, 50, 0), (-200, -150, 0), 18, 270), boxes(W, (-520, -130, -70, -195, -95, 70))
        ),
        union(
            cyl(-20 * Y, Y, 15, 196),
            boxes(W, (-18, -28, -50, 18, -3, 50), *((-12, -190, z, 12, -3, z + 12) for z in (-50, 38))),
        ),
        union(
            boxes(W, (-28, 126, -26, 28, 176, 26), (27, 150, -8, 34, 168, 8)),
            strap(hinge, hinge - 20 * Y, 10, -20, -11, 11, 20),
            cyl(catch - 8 * Z, Z, 8, 16),
        ),
    )
    stem, lever = (
        union(
            boxes(W, (-14, 178, -20, 24, 222, 20), (-26, 182, -10, -12, 198, 10), (23, 197, -8, 37, 213, 8)),
            cyl(hinge - 10 * Z, Z, 10, 20),
            cyl(latch - 8 * Z, Z, 8, 16),
            cyl((2, 220, 0), Y, 17, grip[1] - 246),
            boxes(grip, (-20, -26, -22, -0.5, 26, 22)),
        ),
        union(
            strap(latch, catch, 8, -13, -8.5, 8.5, 13),
            strap(catch, (52, 95), 7, -13, -8.5, 8.5, 13),
            box((46, 88, -13), (59, 102, 13)),
        ),
    )
    d.parts |= {
        "frame": cut(frame, bore(W, Y, 18), cyl(W, Y, 21, 7), cyl(cup, Y, 21, 7)),
        "fork": drill(fork, -178 * Y, 5),
        "crown race": tube(-3 * Y, Y, 15, 19, 3),
        "lower bearing": tube(W, Y, 15, 21, 7),
        "upper inner race": cut(tube(cup, Y, 15, 17, 7), race),
        "upper outer race": cut(tube(cup, Y, 19, 21, 7), race),
        "headset nut": hexagon(111 * Y, Y, 19, 9, 15),
        "hinge block": cut(
            drill(block, catch, 3, hinge, 3 * d.tap),
            bore(W, Y, 15),
            box((-1.5, 120, 10), (1.5, 180, 30)),
            cyl(hinge + 5 * Z, Z, 4, 20),
        ),
        "stem": drill(stem, hinge, 6, latch, 3, grip, 11),
        "bar clamp": drill(boxes(grip, (0.5, -25, -22, 17, 25, 22)), grip, 11),
        "handlebar": tube(grip - half * Z, Z, 9, 11, 2 * half),
        "hinge bolt": stack(hinge + 24 * Z, -Z, 7, 4, 4, 31, 3, 9),
        "catch pin": cyl(catch - 13 * Z, Z, 3, 26),
        "latch pin": rivet(latch - 13.2 * Z, Z, 3, 26.4),
        "latch lever": cut(drill(lever, latch, 3 + d.play, catch, 3), box((20, 156, -20), (37, 162, 20))),
    }
    d.parts |= {f"ball {number}": sphere(p, 1.7) for number, p in enumerate(hollow(106.5 * Y, Y, 18, 6))}
    for s, name in SIDES:
        d.parts |= {
            f"{name} grip": tube(grip + s * half * Z, -s * Z, 11, 16, 110),
            f"{name} hinge bush": tube(hinge + s * 10 * Z, -s * Z, 4 + d.play, 6, 8),
            f"{name} hinge washer": tube(hinge + s * 10 * Z, s * Z, 4.1, 8, 1),
        }
        d.fasten(f"{name} bar screw", "stem", [grip + (17, y, 14 * s) for y in (-18, 18)], -X, 2.5, 32, "bar clamp")
        d.fasten(f"{name} clamp screw", "hinge block", at(28, 151 + 14 * s, 20), -X, 2.5, 46)
        d.means(f"stem: {name} hinge bush", f"handlebar: {name} grip")
    return d.means(
        "fork: crown race, upper inner race, headset nut, hinge block",
        "hinge block: hinge bolt, catch pin",
        "stem: bar clamp, handlebar, latch pin",
        "frame: upper outer race",
        ("stem", "hinge block", hinge),
        ("latch lever", "stem", latch),
        ("fork", "frame", W, Y),
    )


@kind
def window_opener_chain(random):
    """A top-hung window, drawn open: two stays of a track, a slider, an arm and a sash bar; a handle with a tongue."""
    d, turn, reach, low = Machine(random, "frame"), random.uniform(0.25, 0.5), random.uniform(195, 205), -338 * Y
    side, lean = at(np.cos(turn), np.sin(turn), 0), np.arcsin(reach / 160 * np.sin(turn))
    end = at(160 * np.sin(lean) - 20, -160 * np.cos(lean), 0)
    hang, handle = (
        end + reach * np.cross(Z, side),
        union(
            stack(low - 36 * X, X, 10, 14.5, 4, 6.5, 7, 2),
            boxes(low, (-36, -8, 0, -28, 8, 115), (-27, -34, -6, -22, 0, 6)),
        ),
    )
    d.parts |= {
        "sash": cut(
            box((-15, -360, -176), (20, 25, 176)),
            boxes(W, (-16, -315, -140, 21, -20, 140), (4, -325, -150, 21, -10, 150)),
            stack(low - 16 * X, X, 8, 4, 5, 12),
        ),
        "handle base": cut(boxes(low, (-21, -14, -34, -15, 14, 34)), bore(low, X, 4 + d.play)),
        "glass": box((4, -325, -150), (8, -10, 150)),
        "handle": handle,
        "frame": cut(box((-45, -373, -230), (0, 130, 230)), box((-46, -328, -190), (1, 92, 190))),
    }
    for s, name in SIDES:
        foot, head, into, track, leaf = (
            at(-20, 0, s * 190),
            at(-20, hang[1], s * 187),
            -s * Z,
            f"{name} track",
            f"{name} sash bar",
        )
        rail, slider = (
            boxes(foot, (-10, -131, -2 * s, 10, 85, -6 * s), (-7, -131, -6 * s, 7, 85, -9 * s)),
            boxes(head, (d.play - 10, -20, s, 10 - d.play, 20, -3 * s), (d.play - 7, -20, 0, 7 - d.play, 20, -5 * s)),
        )
        d.parts |= {
            track: cut(boxes(foot, (-12, -130, 0, 12, 84, -8 * s)), rail, cyl(foot, into, 3, 5)),
            f"{name} post": union(cyl(foot, into, 3, 11), cyl(foot + 2 * into, into, 6, 6.4)),
            f"{name} arm": strap(-20 * X, end, 8, s * 181.5, s * 179, hole=3 + d.play),
            f"{name} slider": cut(union(slider, cyl(head, into, 6, 8.4)), cyl(head, into, 3, 12)),
            f"{name} slider rivet": cyl(head, into, 3, 11),
            f"{name} arm rivet": cyl(end + s * 181.5 * Z, into, 3, 5.5),
            leaf: drill(strap(W, (0, -reach - 75), 9, s * 178.5, s * 176), W, 3 + d.play, -reach * Y, 3),
        }
        d.fasten(f"{name} track screw", "frame", [(-20, y, s * 188) for y in (-60, -110)], -into, 1.6, 22, track)
        d.fasten(f"{name} stay screw", "sash", [(0, y - reach, s * 178.5) for y in (-30, -65)], into, 1.6, 18, leaf)
        d.fasten(f"{name} handle screw", "sash", low + (-21, 0, s * 24), X, 2, 18, "handle base")
        d.means(
            f"frame: {track}",
            f"{track}: {name} post",
            f"sash: {leaf}",
            f"{leaf}: {name} arm rivet",
            f"{name} slider: {name} slider rivet",
            (f"{name} slider", track, head, Y, "Prismatic"),
            (f"{name} slider", leaf, head),
            (f"{name} arm", track, foot),
            (f"{name} arm", leaf, end),
        )
    for name in (each for each in d.parts if any(word in each for word in ("sash", "handle", "glass", "stay"))):
        d.parts[name] = d.parts[name].rotate((0, 0, 0), (0, 0, 1), np.degrees(turn)).translate(tuple(hang))
    return d.means("sash: glass, handle base", ("handle", "handle base", hang - 338 * np.cross(Z, side), side))


@kind
def tablet_arm(random):
    """A desk clamp with a turret, two parallelograms with springs, a tilting and turning holder with a sliding jaw."""
    d, steep, flat = Machine(random, "clamp"), random.uniform(1.0, 1.35), random.uniform(-0.35, 0.15)
    up, over = random.uniform(200, 240) * at(np.cos(steep), np.sin(steep), 0), 210 * at(np.cos(flat), np.sin(flat), 0)
    b1, b2, c1, c2 = at(-15, 58, 0), at(15, 58, 0), up + (14, 82, 0), up + (14, 108, 0)
    e1, e2, h1, h2, tilt, clamp = (
        b1 + up,
        b2 + up,
        c1 + over,
        c2 + over,
        c1 + over + (34, 13, 0),
        union(
            boxes(W, (-32, -12, -25, 32, 0, 25), (20, -90, -25, 32, 0, 25), (-32, -90, -25, 32, -76, 25)),
            cyl(-12 * Y, Y, 17, 40),
        ),
    )
    turret, head = (
        union(
            stack(-7 * Y, Y, 8, 36, 18, 4),
            boxes(W, (-24, 33, -10, 24, 43, 10)),
            strap(b1 - 10 * Y, b2 - 10 * Y, 9, -10, -7, 7, 10),
            strap(b1, b2, 9, -10, -7, 7, 10),
        ),
        union(
            strap(h1, h2, 9, -10, -7, 7, 10),
            boxes(h1, (7.5, -9, -10, 16, 35, 10)),
            strap(tilt - 20 * X, tilt, 9, -5, 5),
        ),
    )
    yoke = union(strap(tilt, tilt + 12.5 * X, 9, -9.2, -5.2, 5.2, 9.2), boxes(tilt, (12, -9, -9.2, 22, 9, 9.2)))
    holder, jaw = (
        union(cyl(tilt + 23 * X, X, 14, 6), boxes(tilt, (28, -100, -60, 40, 100, 60), (39, -104, -60, 54, -97, 60))),
        boxes(
            tilt,
            *((x, 40, d.play - w, x + 3, 135, w - d.play) for x, w in ((35, 16), (37, 12))),
            (35, 128, -40, 54, 135, 40),
        ),
    )
    d.parts |= {
        "clamp": cut(clamp, cyl(-8 * Y, Y, 10, 40), cyl((-10, -91, 0), Y, 5 * d.tap, 20)),
        "turret bush": cut(stack(-8 * Y, Y, 10, 36, 16, 1), bore(W, Y, 8 + d.play)),
        "clamp screw": stack(at(-10, -140, 0), Y, 14, 12, 5, 88),
        "clamp pad": cyl((-10, -40, 0), Y, 14, 9),
        "turret": drill(turret, b1, 3, b2, 3),
        "head": drill(head, h1, 3, h2, 3, tilt, 3 + d.play),
        "yoke": drill(yoke, tilt, 3),
        "tilt screw": screw(tilt + 9.2 * Z, -Z, 3, 25),
        "tilt nut": hexagon(tilt - 9.2 * Z, -Z, 5, 4, 3),
        "holder washer": tube(tilt + 22 * X, X, 3.2, 12, 1),
        "jaw": jaw,
        "holder": cut(
            holder,
            bore(tilt, X, 3 + d.play),
            cyl(tilt + 32 * X, X, 6, 9),
            boxes(tilt, (35, 16, -16, 38, 101, 16), (37, 16, -12, 41, 101, 12)),
        ),
    }
    d.fasten("holder screw", "yoke", tilt + 32 * X, -X, 3, 19)
    arms = (
        ("left lower", b1, e1, "turret", "left elbow"),
        ("right lower", b2, e2, "turret", "left elbow"),
        ("under upper", c1, h1, "left elbow", "head"),
        ("over upper", c2, h2, "left elbow", "head"),
    )
    for name, p, q, one, other in arms:
        d.parts |= {
            f"{name} bar": strap(p, q, 6, -6, 6, hole=3 + d.play),
            f"{name} pin": headed(p + 20 * Z, -Z, 3, 32),
            f"{name} rivet": rivet(q - 10 * Z, Z, 3, 20),
        }
        d.means(f"{one}: {name} pin", f"{other}: {name} rivet", (f"{name} bar", one, p), (f"{name} bar", other, q))
    for name, p, foot in (("left lower", b1 + 0.75 * up, b2), ("under upper", c1 + 0.75 * over, c2)):
        way, eyes = (p - foot) / norm(p - foot), (tube(each + 14 * Z, Z, 3.2, 7, 3) for each in (p, foot))
        d.parts |= {
            f"{name} bar": drill(d.parts[f"{name} bar"], p, 3),
            f"{name} stud": headed(p + 20 * Z, -Z, 3, 26),
            f"{name} spring": union(tube(foot + 15.5 * Z + 6 * way, way, 3.5, 5, norm(p - foot) - 12), *eyes),
        }
        d.means(f"{name} bar: {name} stud")
    plates = [(e1, e2), (c1, c2), (e2, c1), (e1, c2)]
    d.parts |= {
        f"{name} elbow": drill(union(*(strap(*ends, 8, 7 * s, 10 * s) for ends in plates)), e1, 3, e2, 3, c1, 3, c2, 3)
        for s, name in SIDES
    }
    return d.means(
        "clamp: turret bush",
        "left elbow: right elbow",
        "yoke: tilt screw, tilt nut",
        ("yoke", "head", tilt),
        ("turret", "clamp", W, Y),
        ("holder", "yoke", tilt, X),
        ("jaw", "holder", tilt, Y, "Prismatic"),
    )
