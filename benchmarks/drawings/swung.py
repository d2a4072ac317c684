"""What digs, changes tools and strikes: an excavator's thumb, a tool changer's arm, a tower clock's hammer."""

from __future__ import annotations

import numpy as np
from numpy.linalg import norm

from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import hollow
from drawings.powered import grooved
from drawings.shapes import (
    Shape,
    X,
    Y,
    Z,
    at,
    bar,
    bore,
    box,
    cut,
    cyl,
    headed,
    hexagon,
    meet,
    rivet,
    screw,
    sphere,
    tube,
    union,
)

SIDES, W = ((1, "left"), (-1, "right")), 0 * X


class Machine(Drawing):
    """A drawing with the play of its holes, and what part of a thread's diameter is drilled."""

    def __init__(self, random, ground: str) -> None:
        super().__init__([ground])
        self.play, self.tap = random.choice([0.0, 0.05, 0.1]), random.choice([0.85, 1.0])

    def means(self, *each):
        """What is fast on what as "host: part, part"; what moves on what, where, and how if not turning about z."""
        for one, others in (text.split(": ") for text in each if isinstance(text, str)):
            for other in others.split(", "):
                self.joint("Weld", other, one)
        for one, other, p, *how in (move for move in each if not isinstance(move, str)):
            self.joint(how[1] if how[1:] else "Revolute", one, other, p, *(how[:1] or [Z]))
        return self

    def fasten(self, name: str, host: str, points, axis, radius: float, length: float, *clear: str) -> None:
        """Screws in tapped holes of the host, through clear holes of other parts."""
        for number, p in enumerate(np.atleast_2d(points)):
            wide = stack(p - 3 * radius * axis, axis, 1.8 * radius, 3 * radius, 1.1 * radius, length)
            self.parts |= {each: cut(self.parts[each], wide) for each in clear}
            self.parts[host] = cut(self.parts[host], cyl(p, axis, radius * self.tap, length + 2))
            self.parts[f"{name} {number}"] = screw(p, axis, radius, length)
            self.means(f"{host}: {name} {number}")


def stack(p, axis, *sizes: float) -> Shape:
    """Cylinders one on another, each of a radius and a length."""
    pairs = zip(sizes[::2], sizes[1::2], strict=True)
    return union(*(cyl(p + sum(sizes[1 : 2 * k : 2]) * axis, axis, *pair) for k, pair in enumerate(pairs)))


def boxes(p, *corners) -> Shape:
    """Boxes in one, each between two corners from a point."""
    return union(*(box(p + np.array(each[:3]), p + np.array(each[3:])) for each in corners))


def drill(shape: Shape, *holes) -> Shape:
    """A part with holes along z, each of a point and a radius."""
    return cut(shape, *(bore(p, Z, r) for p, r in zip(holes[::2], holes[1::2], strict=True)))


def strap(one, other, half: float, *heights: float, hole: float = 0.0) -> Shape:
    """A bar, or several, between pairs of heights, with a hole at both ends."""
    pairs = zip(heights[::2], heights[1::2], strict=True)
    return union(*(bar(one, other, half, *sorted(pair), (one, other) if hole else (), hole) for pair in pairs))


@kind
def excavator_thumb(random):
    """A stick, a cylinder, a crank, a push link and a thumb on the bucket's pin; pins with flags and grease caps."""
    d, crank, foot = Machine(random, "stick"), at(-190, -90, 0), at(-random.uniform(590, 640), -105, 0)
    lug, knee = at(-45, -150, 0), at(*meet((-45, -150), random.uniform(112, 125), crank[:2], 130), 0)
    way, arm, body = (knee - foot) / norm(knee - foot), (knee - crank) / 130, 0.54 * norm(knee - foot)
    stick = union(
        boxes(W, (-720, -50, -45, -30, 90, 45), (-218, -90, -31, -162, -45, 31)),
        cyl(-45 * Z, Z, 34, 90),
        cyl(crank - 31 * Z, Z, 28, 62),
        strap(foot, foot + 34 * Y, 30, -34, -20, 20, 34),
    )
    thumb = union(
        strap(W, -450 * Y, 34, -62, -46, 46, 62),
        boxes(W, (0, -400, -47, 22, -120, 47), (20, -480, -47, 45, -420, 47), (-45, -168, -18, 5, -132, 18)),
        cyl(lug - 18 * Z, Z, 28, 36),
    )
    barrel = union(cyl(foot - 18 * Z, Z, 28, 36), stack(foot + 20 * way, way, 17, 16, 32, body))
    rod = union(cyl(knee - 18 * Z, Z, 28, 36), stack(foot + 60 * way, way, 26 - d.play, 24, 14, body / 0.54 - 100))
    d.parts |= {
        "stick": drill(stick, W, 19, crank, 19, foot, 15),
        "thumb": drill(thumb, W, 15, lug, 19),
        "barrel": cut(drill(barrel, foot, 19), cyl(foot + 48 * way, way, 26, body)),
        "gland": cut(stack(foot + (12 + body) * way, way, 26, 24, 32, 8), bore(foot, way, 14 + d.play)),
        "rod": drill(rod, knee, 19),
    }
    for s, name in SIDES:
        d.parts |= {
            f"{name} crank": strap(crank, knee, 27, s * 32, s * 44, hole=15),
            f"{name} link": drill(strap(lug, knee, 26, s * 19, s * 31), lug, 15, knee, 15 + d.play),
        }
    pins = (
        ("nose", W, "stick", 45, "thumb", 62, -Y),
        ("foot", foot, "barrel", 18, "stick", 34, Y),
        ("crank", crank, "stick", 31, "right crank", 44, arm),
        ("knee", knee, "rod", 18, "right crank", 44, -arm),
        ("lug", lug, "thumb", 18, "right link", 31, (knee - lug) / norm(knee - lug)),
    )
    for name, p, holder, half, host, z, u in pins:
        low, flag = p - (z + 6) * Z, strap(p, p + 32 * u, 17, -z - 6, -z)
        d.parts |= {
            f"{name} pin": cut(
                union(cyl(low, Z, 15, 2 * z + 9), flag), cyl(low, Z, 4, z + 6), cyl(p - 2 * Z, Y, 2, 16)
            ),
            f"{name} grease cap": stack(low - 4 * Z, Z, 9, 4, 4, 10),
            f"{name} bush": tube(p - half * Z, Z, 15 + d.play, 19 + random.choice([0, 0.01]), 2 * half),
        }
        d.fasten(f"{name} flag screw", host, low + 32 * u, Z, 4, 16, f"{name} pin")
        d.means(f"{host}: {name} pin", f"{name} pin: {name} grease cap", f"{holder}: {name} bush")
    return d.means(
        "right crank: left crank",
        "right link: left link",
        "barrel: gland",
        ("thumb", "stick", W),
        ("right crank", "stick", crank),
        ("barrel", "stick", foot),
        ("rod", "right crank", knee),
        ("right link", "right crank", knee),
        ("right link", "thumb", lug),
        ("rod", "barrel", foot, way, "Cylindrical"),
    )


@kind
def cnc_tool_changer_arm(random):
    """A double arm with two sprung grippers on a keyed shaft in bearings, swung by a cylinder between clevises."""
    d, rear, swing = Machine(random, "housing"), at(-random.uniform(225, 245), -70, 0), random.uniform(-0.2, 0.2)
    crank, eye, tool, pivot = 60 * at(np.sin(swing), -np.cos(swing), 0), rear - 21 * Z, at(210, 0, 0), at(150, 26, 0)
    way, hub = (crank - rear) / norm(crank - rear), crank - 21 * Z
    lever = cut(union(cyl(-30 * Z, Z, 26, 18), strap(W, crank, 12, -28, -14)), box((-2.5, 10, -31), (2.5, 17.5, -11)))
    half = union(
        cut(cyl(tool + 109 * Z, Z, 42, 22), box((100, -4, 100), (300, 60, 140))),
        strap(W, (160, 0), 24, 109, 131),
        box((110, -24, 109), (172, 38, 131)),
    )
    half, finger = (
        cut(drill(half, pivot, 4, tool, 30), box((100, 12, 114.5), (200, 60, 125.5)), cyl((128, -6, 120), Y, 5.2, 30)),
        cut(cyl(tool + 115 * Z, Z, 42, 10), box((100, -60, 100), (300, 14, 140))),
    )
    finger = union(finger, strap(pivot, tool + (-22, 28, 0), 8, 115, 125), strap(pivot, (128, 21), 8, 115, 125))
    made = {
        "finger": drill(finger, pivot, 4 + d.play, tool, 30),
        "spring": tube((128, -6, 120), Y, 3.4, 4.8, 19),
        "pin": headed(pivot + 131 * Z, -Z, 4, 24),
    }
    for s, name in SIDES:
        d.parts |= {f"{name} {each}": shape.rotate((0, 0, 0), (0, 0, 1), 90 - 90 * s) for each, shape in made.items()}
        d.means(f"arm: {name} pin", (f"{name} finger", "arm", s * pivot))
    body, bracket = (
        union(cyl(eye - 7 * Z, Z, 9, 14), stack(eye + 5 * way, way, 6.5, 11, 17, 100)),
        union(
            strap(rear, rear - 16 * X, 9, -34, -28.4, -13.6, -8),
            boxes(rear, (-26, -14, -34, -14, 14, 0), (-52, -14, -7, -20, 14, 0)),
        ),
    )
    fork = union(strap(crank, crank - 20 * way, 9, -34, -28.4, -13.6, -8), cyl(hub - 34 * way, way, 12.5, 19))
    d.parts |= {
        "lower bearing": tube(3 * Z, Z, 15, 28, 9),
        "upper bearing": tube(88 * Z, Z, 15, 28, 9),
        "lever": drill(lever, W, 15, crank, 5 + d.play),
        "lower spacer": tube(-12 * Z, Z, 15, 19, 15),
        "key": box((-2.5, 12, -29), (2.5, 17.3, -13)),
        "end washer": tube(-33 * Z, Z, 4.2, 19, 3),
        "shaft": cut(
            stack(-29.5 * Z, Z, 15, 41.5, 18, 76, 15, 13, 34, 8, 10, 5), box((-2.5, 12, -29.5), (2.5, 16, -13))
        ),
        "housing": cut(
            boxes(W, (-300, -100, 0, 70, 70, 14)).union(cyl(W, Z, 40, 100)),
            stack(W, Z, 28, 12, 25, 76, 28, 12),
            *(bore((x, y, 0), Z, 5.5) for x in (-285, 55) for y in (-85, 55)),
        ),
        "arm": cut(union(half, half.rotate((0, 0, 0), (0, 0, 1), 180), cyl(109 * Z, Z, 36, 22)), bore(W, Z, 10)),
        "bracket": drill(bracket, rear, 5),
        "cylinder": cut(drill(body, eye, 5 + d.play), cyl(eye + 24 * way, way, 13, 100)),
        "front cap": cut(stack(eye + 106 * way, way, 13, 10, 17, 6), bore(eye, way, 6 + d.play)),
        "rod": stack(eye + 40 * way, way, 13 - d.play, 12, 6, norm(crank - rear) - 97, 5, 25),
        "rear pin": headed(rear - 8 * Z, -Z, 5, 29),
        "fork pin": headed(crank - 8 * Z, -Z, 5, 29),
        "lock nut": hexagon(hub - 41 * way, way, 8, 6, 5),
        "fork": cut(drill(fork, crank, 5), cyl(hub - 35 * way, way, 5, 18)),
    }
    d.fasten("end screw", "shaft", -33 * Z, Z, 4, 18)
    d.fasten("arm screw", "shaft", hollow(124 * Z, Z, 24, 3), -Z, 3, 22, "arm")
    d.fasten("bracket screw", "housing", [rear + (-40, y, -7) for y in (-7, 7)], Z, 3, 18, "bracket")
    return d.means(
        "shaft: arm, lever, key, end washer",
        "housing: bracket",
        "bracket: rear pin",
        "fork: fork pin",
        "rod: fork, lock nut",
        "cylinder: front cap",
        ("shaft", "housing", W),
        ("cylinder", "bracket", eye),
        ("fork", "lever", hub),
        ("rod", "cylinder", eye, way, "Cylindrical"),
    )


@kind
def tower_clock_hammer(random):
    """A bell on a post, a hammer and a tail on an arbor in two pillars, a wire to a lever with a roller below."""
    d, arbor, lean, slope = Machine(random, "plate"), at(150, 42, 0), random.uniform(0.12, 0.2), random.uniform(0, 0.1)
    hook, stud, bottom = arbor + 78 * at(np.cos(slope), np.sin(slope), 0), at(140, -160, 0), at(227, -163, 0)
    out, mid, wire = at(np.cos(lean), np.sin(lean), 0), 30 * Z, (bottom - hook) / norm(bottom - hook)
    head, lift, bell = (
        arbor + 112 * np.cross(Z, out),
        at(85, -172, 0),
        union(
            cut(sphere((0, 130, 0), 100), sphere((0, 130, 0), 94), boxes(W, (-110, 0, -110, 110, 130, 110))),
            cyl(221 * Y, Y, 18, 13),
        ),
    )
    lever = union(strap(stud, bottom, 9, 26, 34), strap(stud, lift, 9, 26, 34), cyl(stud + 26 * Z, Z, 14, 8))
    d.parts |= {
        "plate": cut(
            boxes(W, (-120, -15, -100, 190, 0, 100)), *(bore((-105, 0, z), Y, 5) for z in (-85, 85)), bore(W, Y, 8)
        ),
        "bell": cut(bell, bore(W, Y, 6.2)),
        "bell post": stack(-15 * Y, Y, 8, 15, 11, 221, 6, 29),
        "bell nut": hexagon(234 * Y, Y, 10, 9, 6),
        "arbor": cut(stack(arbor - 63 * Z, Z, 6, 15.2, 8, 95.6, 6, 15.2), bore(arbor, X, 2)),
        "taper pin": cyl(arbor - 18 * X, X, 2, 36),
        "hammer arm": cut(
            union(cyl(arbor - 12 * Z, Z, 16, 24), cyl(arbor, head - arbor, 6, 128)),
            bore(arbor, Z, 8),
            bore(arbor, X, 2),
        ),
        "hammer head": cut(stack(head - 22 * out, out, 9, 4, 17, 42), bore(head, head - arbor, 6)),
        "tail": drill(union(cyl(arbor + 22 * Z, Z, 15, 16), strap(arbor, hook, 8, 26, 34)), arbor, 8, hook, 3 + d.play),
        "wire": cyl(hook + mid + 18 * wire, wire, 2.5, norm(bottom - hook) - 36),
        "lever": drill(lever, stud, 9, bottom, 3 + d.play, lift, 3),
        "lever bush": tube(stud + 26 * Z, Z, 6 + d.play, 9.01, 8),
        "roller": tube(lift + 34.3 * Z, Z, 3 + d.play, 11, 9),
        "roller pin": headed(lift + 43.6 * Z, -Z, 3, 18),
        "bracket": drill(boxes(W, (105, -200, 4, 180, -15, 16), (105, -27, 4, 180, -15, 66)), stud, 5 * d.tap),
        "lever stud": grooved(stack(stud + 4 * Z, Z, 5, 12, 10, 9.8, 6, 11), stud + 34.2 * Z, Z, 6),
        "lever circlip": circlip(stud + 34.2 * Z, Z, 6),
    }
    for s, name, end, w in ((1, "upper", hook, wire), (-1, "lower", bottom, -wire)):
        pillar = union(
            boxes(arbor, (-22, -42, s * 50, 22, 0, s * 60), (-22, -42, s * 60, 22, -33, s * 90)),
            cyl(arbor + s * 50 * Z, s * Z, 22, 10),
        )
        ears = union(strap(end, end + 16 * w, 7, 22, 25.7, 34.3, 38), cyl(end + mid + 14 * w, w, 8, 14))
        d.parts |= {
            f"pillar {s}": drill(pillar, arbor, 9),
            f"bush {s}": drill(stack(arbor + s * 48 * Z, s * Z, 12, 2, 9.01, 10), arbor, 6 + d.play),
            f"{name} clevis": cut(drill(ears, end, 3), cyl(end + mid + 17 * w, w, 2.5 * d.tap, 12)),
            f"{name} pin": rivet(end + 22 * Z, Z, 3, 16),
        }
        d.means(f"plate: pillar {s}", f"pillar {s}: bush {s}", f"wire: {name} clevis", f"{name} clevis: {name} pin")
    d.fasten("pillar screw", "plate", [(150, 9, z) for z in (-76, 76)], -Y, 4, 20, "pillar 1", "pillar -1")
    d.fasten("bracket screw", "plate", [(x, -27, 46) for x in (118, 166)], Y, 3, 22, "bracket")
    d.fasten("head screw", "hammer head", head + 24 * out, -out, 2.5, 18)
    return d.means(
        "plate: bell post, bracket",
        "bell post: bell, bell nut",
        "arbor: hammer arm, taper pin, tail",
        "hammer arm: hammer head",
        "bracket: lever stud",
        "lever stud: lever circlip",
        "lever: lever bush, roller pin",
        ("arbor", "pillar 1", arbor),
        ("upper clevis", "tail", hook),
        ("lower clevis", "lever", bottom),
        ("lever", "lever stud", stud),
        ("roller", "lever", lift),
    )
