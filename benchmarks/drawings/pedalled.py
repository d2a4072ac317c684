"""A pedal for a drum, rods of table football, a prosthetic knee, an elliptical trainer, louvres, a sliding door."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.folding import both_sides, circlip
from drawings.powered import grooved
from drawings.shapes import (
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
    laid,
    meet,
    screw,
    sphere,
    tube,
    union,
)
from drawings.vehicles import solid_bar, upright


class Sketch(Drawing):
    """A drawing with the ways in which parts are held."""

    def held(self, name: str, shape, *others: str) -> None:
        """Draw a part that is welded, pressed, screwed or clamped to others."""
        self.add(name, shape)
        for other in others:
            self.joint("Weld", name, other)

    def drill(self, part: str, *shapes) -> None:
        """Take shapes away from a part that is drawn already."""
        self.parts[part] = cut(self.parts[part], *shapes)

    def bolt(self, name: str, points, axis, radius: float, length: float, into: str, *through: str) -> None:
        """Screws with their threads in one part, with clearance through others; `core` is the size of their hole."""
        for k, p in enumerate(points):
            self.drill(into, cyl(p, axis, getattr(self, "core", 1.0) * radius, length + 3))
            for part in through:
                self.drill(part, cyl(p, axis, radius + 0.2, length + 3))
            self.held(f"{name} {k}", screw(p, axis, radius, length), into)

    def pin(self, name: str, point, axis, radius: float, length: float, fixed: str, links, play=0.0, clip=False):
        """A pin, plain or with head and circlip, pressed into a part, on which others turn."""
        end = np.asarray(point, float) + length * np.asarray(axis, float)
        self.drill(fixed, cyl(point, axis, radius, length))
        for link in links:
            self.drill(link, cyl(point, axis, radius + play, length))
            self.joint("Revolute", link, fixed, point, axis)
        self.held(name, cyl(point, axis, radius, length), fixed)
        if clip:
            self.parts[name] = grooved(headed(point, axis, radius, length + 2), end, axis, radius)
            self.held(f"{name} clip", circlip(end, axis, radius), name)

    def grub(self, name: str, point, axis, radius: float, length: float, hub: str) -> None:
        """A set screw in a hub from the shaft outwards."""
        self.drill(hub, cyl(point, axis, radius, 60))
        self.held(name, cyl(point, axis, radius, length), hub)


@kind
def kick_drum_pedal(random):
    """A board on a heel hinge, two posts with bearings, an axle with a cam, a rigid link, a beater, set screws."""
    it, play, tall, high = Sketch(["base"]), random.choice([0.05, 0.15]), *random.uniform(165, 190, 2)
    heel, toe, axle = at(-130, 0, 20), at(78, 0, random.uniform(52, 64)), at(112, 0, tall)
    cam, rod, boss = axle + at(-34, 0, -8), axle + at(16, 27, -20), cyl(axle - 13 * Y, Y, 13, 26)
    it.add("base", union(box((-160, -40, 0), (90, 40, 5)), box((80, -64, 0), (150, 64, 5))))
    for x, y in ((-145, 32), (-145, -32), (138, 54), (138, -54)):
        it.held(f"foot {x} {y}", cyl((x, y, -8), Z, 9, 8), "base")
    it.held("heel block", cut(box((-158, -30, 5), (-112, 30, 28)), box((-160, -22, 12), (-100, 22, 30))), "base")
    it.bolt("heel screw", [at(-150, y, 0) for y in (-15, 15)], Z, 2.5, 12, "heel block", "base")
    way, long = (toe - heel) / np.linalg.norm(toe - heel), float(np.linalg.norm(toe - heel))
    board = [cyl((0, -21.8, 0), Y, 7, 43.6), box((0, -21.8, 2), (30, 21.8, 7)), box((23, -34, 2), (long - 13, 34, 8))]
    board += [box((long - 30, s * 8.2, -7), (long, s * 13, 6)) for s in (-1, 1)]
    board += [cyl((long, y, 0), Y, 8, 4.8) for y in (-13, 8.2)]
    it.add("board", laid(union(*board), heel, way, np.cross(way, Y)))
    it.pin("heel pin", heel - 30 * Y, Y, 4, 60, "heel block", ["board"], play)
    it.add("link", solid_bar(toe, cam, 7, 7.8, 0.1))
    it.pin("toe pin", toe - 13 * Y, Y, 4, 26, "board", ["link"], play)
    it.add("axle", cyl(axle - 66 * Y, Y, 6, 142))
    it.held("cam", union(upright(axle, cam, 11, 8.2, 13, 4), boss).cut(it.parts["axle"]), "axle")
    it.pin("cam pin", cam - 13 * Y, Y, 4, 26, "cam", ["link"], play, True)
    it.grub("cam screw", axle + 6 * Z, Z, 2, 6, "cam")
    for s in (-1, 1):
        it.held(f"post {s}", cut(box((100, s * 50, 5), (124, s * 62, tall + 14)), bore(axle, Y, 11)), "base")
        it.bolt(f"post screw {s}", [at(x, s * 56, 0) for x in (106, 118)], Z, 2.5, 18, f"post {s}", "base")
        it.held(f"bearing {s}", tube(axle + s * 52 * Y, s * Y, 6, 11, 8), f"post {s}")
        it.held(f"collar {s}", tube(axle + s * 44 * Y, s * Y, 6, 10, 8), "axle")
        it.grub(f"collar screw {s}", axle + at(0, s * 47, 6), Z, 1.5, 3.5, f"collar {s}")
        it.joint("Revolute", "axle", f"post {s}", axle, Y)
    it.held("hub", cut(box(axle + at(-12, 16, -12), axle + at(26, 38, 12)), bore(axle, Y, 6), bore(rod, Z, 4)), "axle")
    it.grub("hub screw", axle + at(-6, 27, 0), -X, 2, 6, "hub")
    it.held("beater rod", cyl(rod, Z, 4, high), "hub")
    it.grub("rod screw", axle + at(20, 27, 0), X, 2, 12, "hub")
    it.held("beater", cut(cyl(rod + at(-16, 0, high - 10), X, 22, 40), cyl(rod, Z, 4, high)), "beater rod")
    return it


@kind
def table_football_rod(random):
    """A floor between two walls, two rods in threaded bushes with nuts, men on cross pins, bumpers, grips, caps."""
    it, play, half = Sketch(["floor"]), random.choice([0.1, 0.25]), random.uniform(165, 190)
    rods, pipe, it.core = (at(0, 0, 0), at(random.uniform(120, 150), 0, 0)), random.choice([5, 6]), 0.8
    it.add("floor", box((-80, -half, -100), (220, half, -88)))
    for s in (-1, 1):
        wall, ties = f"wall {s}", [at(x, s * (half + 18), -94) for x in (-50, 190)]
        it.held(wall, cut(box(ties[0] + at(-30, 0, -6), (220, s * half, 60)), *(bore(p, Y, 14) for p in rods)), "floor")
        it.bolt(f"wall screw {s}", ties, -s * Y, 2.5, 45, "floor", wall)
    for k, (p, places) in enumerate(zip(rods, ((-75, 0, 75), (-45, 45)), strict=True)):
        rod, far = f"rod {k}", (1 - 2 * k) * Y
        it.add(rod, tube(p - (half + 160) * Y, Y, pipe, 8, 2 * half + 320))
        for s in (-1, 1):
            low, y = p + s * half * Y, s * Y
            bush = union(tube(low - 20 * y, y, 8 + play, 14, 38), tube(low + 18 * y, y, 8 + play, 20, 4))
            it.held(f"bush {k} {s}", bush, f"wall {s}")
            it.held(f"bush nut {k} {s}", hexagon(low, -y, 18, 8, 14), f"bush {k} {s}")
            it.held(f"bumper {k} {s}", tube(p + (places[-1] + 12) * y, y, 8, 13, 22), rod)
            it.joint("Cylindrical", rod, f"bush {k} {s}", p, Y)
        for n, q in enumerate(p + y * Y for y in places):
            trunk = [cyl(q, Z, 6, 30), box(q + at(-6, -9, -62), q + at(6, 9, -5)), sphere(q + 32 * Z, 10)]
            man = union(cyl(q - 12 * Y, Y, 14, 24), *trunk, box(q + at(-8, -10, -82), q + at(8, 10, -60)))
            it.held(f"man {k} {n}", cut(man, bore(p, Y, 8), bore(q, X, 2, 30)), rod)
            it.pin(f"man pin {k} {n}", q - 14 * X, X, 2, 28, rod, [])
        root, end = p + (half + 60) * far, p - (half + 135) * far
        it.held(f"grip {k}", cut(cyl(root, far, 16, 112), cyl(root, far, 8, 100)), rod)
        it.grub(f"grip screw {k}", root + 50 * far + 8 * Z, Z, 2, 7, f"grip {k}")
        it.held(f"cap {k}", cut(cyl(end, -far, 11, 30), cyl(end, -far, 8, 25)), rod)
    return it


@kind
def prosthetic_knee(random):
    """Four bars on pins with flanged bushes and circlips, a damper with gland, a pyramid, a tube in set screws."""
    it, play, high = Sketch(["shin"]), random.choice([0.02, 0.08]), random.uniform(36, 44)
    a, b, c, d = at(-14, 0, 0), at(16, 4, 0), at(-16, high + 6, 0), at(random.uniform(8, 13), high, 0)
    low, eye, top = at(-34, -75, 0), at(-42, 22, 0), at(0, high + 29, 0)
    shin = [bar(a, b, 9, -13, 13), box((-20, -90, -13), (22, 2, 13)), cyl((1, -85, 0), -Y, 20, 40)]
    shin += [box((-40, -84, s * 6), (-18, -66, s * 12)) for s in (-1, 1)]
    it.add("shin", cut(union(*shin), cyl((1, -95, 0), -Y, 15, 40)))
    for k, y in enumerate((-115, -104)):
        it.grub(f"tube screw {k}", at(16, y, 0), X, 2.5, 6, "shin")
    it.held("shank tube", tube((1, -95, 0), -Y, 12.5, 15, 160), "shin")
    it.add("head", union(bar(c, d, 9, -13, 13), box((-18, high, -13), (16, high + 24, 13))))
    it.held("pyramid", union(box(top - at(14, 5, 14), top + at(14, 0, 14)), cyl(top, Y, 4.5, 14)), "head")
    it.bolt("pyramid screw", [top + at(x, 0, z) for x in (-9, 9) for z in (-9, 9)], -Y, 2, 13, "head", "pyramid")
    for s in (-1, 1):
        it.add(f"front link {s}", bar(b, d, 8, *sorted((s * 14, s * 19)), (b, d), 4))
    rear = [*both_sides(a, c, 8, 14, 19, (a, c), 4), box((-30, 14, -19), (-20, 30, 19))]
    it.add("rear link", union(*rear, box((-42, 16, -5), (-28, 28, 5)), cyl(eye - 5 * Z, Z, 7, 10)))
    for name, p, body, link in (("a", a, "shin", "rear link"), ("b", b, "shin", "front link 1"),
                                ("c", c, "head", "rear link"), ("d", d, "head", "front link 1")):  # fmt: skip
        shape = grooved(grooved(cyl(p - 21 * Z, Z, 4, 42), p + 19 * Z, Z, 4), p - 19 * Z, -Z, 4)
        it.held(f"pin {name}", shape, link, *(["front link -1"] if "1" in link else []))
        it.drill(body, bore(p, Z, 6))
        for s in (-1, 1):
            bush = union(tube(p + s * Z, s * Z, 4 + play, 6, 12), tube(p + s * 13 * Z, s * Z, 4 + play, 8, 1))
            it.held(f"bush {name} {s}", bush, body)
            it.held(f"circlip {name} {s}", circlip(p + s * 19 * Z, s * Z, 4), f"pin {name}")
        it.joint("Revolute", link, body, p, Z)
    way, long = (eye - low) / np.linalg.norm(eye - low), float(np.linalg.norm(eye - low))
    barrel = union(cyl(low - 5.8 * Z, Z, 7, 11.6), cyl(low, way, 5.5, 15), cyl(low + 12 * way, way, 8.5, 46))
    it.add("damper", cut(barrel, cyl(low + 16 * way, way, 6, 60)))
    it.held("damper gland", tube(low + 51 * way, way, 3 + play / 2, 6, 7), "damper")
    rod = [cyl(low + 26 * way, way, 3, long - 46), cyl(low + 26 * way, way, 6 - play, 6)]
    rod += both_sides(eye, eye - 20 * way, 6, 5.2, 9, (), 0)
    it.add("damper rod", union(*rod, bar(eye - 20 * way, eye - 24 * way, 6, -9, 9)))
    it.joint("Cylindrical", "damper rod", "damper", low, way)
    it.pin("damper pin", low - 12 * Z, Z, 3, 24, "shin", ["damper"], play)
    it.pin("rod pin", eye - 9 * Z, Z, 3, 18, "rear link", ["damper rod"], play, True)
    return it


@kind
def elliptical_trainer(random):
    """Cranks on a keyed axle in a shell, swing arms with bushes on a fixed shaft, pedal bars between, bolts, pedals."""
    it, play, turn = Sketch(["frame"]), random.choice([0.05, 0.2]), random.uniform(0.3, 0.9)
    o, m = at(-420, random.uniform(225, 245), 0), at(350, 950, 0)
    frame = [box((-600, -40, -25), (550, 10, 25)), cyl(o - 45 * Z, Z, 28, 90), cyl(m - 25 * Z, Z, 25, 50)]
    frame += [box((p[0] - 20, 0, -20), (p[0] + 20, p[1], 20)) for p in (o, m)]
    frame += [box((x, -60, -200), (x + 40, -40, 200)) for x in (-600, 510)]
    it.add("frame", cut(union(*frame), bore(o, Z, 21), bore(m, Z, 12)))
    key = box(o + at(-3, 9, 45), o + at(3, 15, 58))
    it.add("axle", cut(cyl(o - 76 * Z, Z, 12, 152), key))
    it.held("flywheel", cut(union(tube(o + 47 * Z, Z, 12, 180, 11), tube(o + 45 * Z, Z, 12, 18, 15)), key), "axle")
    it.held("flywheel key", key, "axle")
    it.held("axle spacer", tube(o - 60 * Z, Z, 12, 16, 15), "axle")
    it.held("arm shaft", cyl(m - 146.3 * Z, Z, 12, 292.6), "frame")
    for s, name in ((1, "left"), (-1, "right")):
        z, p = s * Z, o + s * 150 * at(np.cos(turn), np.sin(turn), 0)
        q = at(*meet(m[:2], 640, p[:2], 720), 0)
        it.held(f"{name} bearing", tube(o + 33 * z, z, 12, 21, 12), "frame")
        crank = cut(bar(o, p, 18, *sorted((s * 60, s * 84.7))), bore(o, Z, 12), cyl(o + 76 * z, z, 14.5, 9))
        it.held(f"{name} crank", cut(crank, bore(p, Z, 8)), "axle")
        it.drill("axle", cyl(o + 76 * z, -z, 5, 30))
        it.held(f"{name} crank bolt", union(cyl(o + 76 * z, -z, 5, 28), cyl(o + 76 * z, z, 14, 6)), "axle")
        it.held(f"{name} crank pin", headed(p + 115.3 * z, -z, 8, 55.3), f"{name} crank")
        it.add(f"{name} bar", cut(bar(p, q, 18, *sorted((s * 85, s * 115))), bore(p, Z, 12), bore(q, Z, 8)))
        it.held(f"{name} bar bush", tube(p + 85 * z, z, 8 + play, 12, 30), f"{name} bar")
        way = (q - p) / np.linalg.norm(q - p)
        normal, up = np.cross(Z, way), (m - q) / np.linalg.norm(m - q)
        it.held(f"{name} pedal", laid(box((200, 18, s * 70), (480, 26, s * 170)), p, way, Z), f"{name} bar")
        pads, pedal = [p + x * way + 26 * normal + 100 * z for x in (260, 420)], f"{name} pedal"
        it.bolt(f"{pedal} screw", pads, -normal, 4, 24, f"{name} bar", pedal)
        arm, root = bar(q, m + 150 * up, 20, *sorted((s * 122, s * 146))), m + 134 * z + 60 * up
        it.add(f"{name} arm", cut(arm, cyl(root, up, 9, 200), bore(m, Z, 16), bore(q, Z, 12)))
        for end, point, r in (("upper", m, 12), ("lower", q, 8)):
            it.held(f"{name} {end} bush", tube(point + 122 * z, z, r + play, r + 4, 24), f"{name} arm")
        it.held(f"{name} spacer", tube(m + 25 * z, z, 12, 17, 96.8), "arm shaft")
        it.bolt(f"{name} shaft screw", [m + 146.3 * z], -z, 8, 30, "arm shaft")
        it.held(f"{name} bolt", headed(q + 146.3 * z, -z, 8, 71.3), f"{name} bar")
        it.held(f"{name} nut", hexagon(q + 85 * z, -z, 12, 8, 8), f"{name} bolt")
        it.held(f"{name} handle", cyl(root, up, 9, 420), f"{name} arm")
        it.bolt(f"{name} handle screw", [root + 60 * up + 12 * z], -z, 2.5, 24, f"{name} arm", f"{name} handle")
        it.joint("Revolute", f"{name} bar", f"{name} crank", p, Z)
        it.joint("Revolute", f"{name} arm", "arm shaft", m, Z)
        it.joint("Revolute", f"{name} arm", f"{name} bar", q, Z)
    it.joint("Revolute", "axle", "frame", o, Z)
    return it


@kind
def louvre_window(random):
    """Glass blades in clips whose stubs turn in flanged bushes of two stiles, a tilt bar on rivets with a knob."""
    it, play, count = Sketch(["left stile"]), random.choice([0.1, 0.3]), 4
    half, tilt, pitch = random.uniform(150, 190), random.uniform(0.35, 0.55), random.uniform(68, 76)
    along, normal = at(0, np.cos(tilt), np.sin(tilt)), at(0, -np.sin(tilt), np.cos(tilt))
    rails, pivots = {"sill": -75.0, "head": count * pitch - 10}, [at(0, 0, k * pitch) for k in range(count)]
    pins = [p + at(9.5 - half, 0, 0) + 56 * along for p in pivots]
    for name, z in rails.items():
        it.add(name, box((-half, -20, z), (half, 20, z + 15)))
    for s, side in ((-1, "left"), (1, "right")):
        it.held(f"{side} stile", box((s * half, -20, -75), (s * (half + 25), 20, rails["head"] + 15)), *rails)
        for name, z in rails.items():
            spots = [at(s * (half + 25), y, z + 7.5) for y in (-10, 10)]
            it.bolt(f"{side} {name} screw", spots, -s * X, 2.5, 50, name, f"{side} stile")
    it.add("tilt bar", laid(bar((0, -30), (0, (count - 1) * pitch), 5.5, -3, 0), pins[0], Y, X))
    for k, p in enumerate(pivots):
        it.add(f"blade {k}", laid(box((6 - half, -42, -2.5), (half - 6, 42, 2.5)), p, X, normal))
        for s, side in ((-1, "left"), (1, "right")):
            clip = [box((s * (half - 6), -42, -5), (s * (half - 1), 63 if s < 0 else 42, 5))]
            clip += [box((s * (half - 22), -40, z), (s * (half - 6), 40, z + 2.5)) for z in (-5, 2.5)]
            clip = laid(union(*clip, cyl((s * (half - 6), 0, 0), s * X, 5, 26)), p, X, normal)
            it.held(f"{side} clip {k}", clip, f"blade {k}")
            edge = p + s * half * X
            it.drill(f"{side} stile", bore(edge, X, 8, 40))
            bush = union(tube(edge, s * X, 5 + play, 8, 22), tube(edge - s * X, s * X, 5 + play, 11, 1))
            it.held(f"{side} bush {k}", bush, f"{side} stile")
            it.joint("Revolute", f"{side} clip {k}", f"{side} bush {k}", p, X)
        it.pin(f"rivet {k}", pins[k], -X, 3, 8.5, f"left clip {k}", ["tilt bar"], play)
    it.bolt("knob", [pins[0] + at(4, 0, -22)], -X, 2.5, 7, "tilt bar")
    return it


@kind
def barn_door(random):
    """A flat rail on spacers and lag bolts, straps with grooved wheels on bearings, stops, a guide in a groove."""
    it, play, c = Sketch(["wall"]), random.choice([0.2, 0.5]), random.uniform(-160, 160) * X
    lags, big, g = [at(x, 38, 100) for x in (-600, -210, 210, 600)], random.uniform(38, 48), c / 2 + at(0, 34, -1000)
    it.add("wall", union(box((-750, -90, -1020), (750, 0, 250)), box((-750, -90, -1020), (750, 150, -1000))))
    it.add("rail", box((-650, 30, 80), (650, 38, 120)))
    for k, p in enumerate(lags):
        it.held(f"spacer {k}", tube(p - 8 * Y, -Y, 4.3, 12, 30), "wall", "rail")
    it.bolt("lag", lags, -Y, 3.8, 108, "wall", "rail")
    for s in (-1, 1):
        it.held(f"stop {s}", cut(box((s * 632 - 15, 24, 72), (s * 632 + 15, 44, 150)), it.parts["rail"]), "rail")
        it.grub(f"stop screw {s}", at(s * 632, 38, 100), Y, 4, 8, f"stop {s}")
    it.add("door", box(c + at(-340, 16, -980), c + at(340, 46, 60)))
    it.drill("door", box((-600, 31 - play, -981), (600, 37 + play, -955)))
    for k, p in enumerate(c + at(x, 34, 120 + big) for x in (-230, 230)):
        it.held(f"strap {k}", box((p[0] - 20, 46, -100), (p[0] + 20, 52, p[2] + 22)), "door")
        ties = [at(p[0], 52, z) for z in (0, -70)]
        it.bolt(f"strap bolt {k}", ties, -Y, 5, 44, f"strap {k}", "door")
        for n, each in enumerate(ties):
            it.held(f"strap nut {k} {n}", hexagon(each - 36 * Y, -Y, 8, 6, 5), f"strap bolt {k} {n}")
        it.add(f"wheel {k}", cut(tube(p - 10 * Y, Y, 13, big + 6, 20), tube(p - 4.5 * Y, Y, big, big + 9, 9)))
        it.held(f"bearing {k}", tube(p - 4 * Y, Y, 6, 13, 14), f"wheel {k}")
        it.bolt(f"axle {k}", [p + 18 * Y], -Y, 6, 32, f"strap {k}")
        it.held(f"axle spacer {k}", tube(p + 10 * Y, Y, 6, 9, 2), f"axle {k} 0")
        it.held(f"axle nut {k}", hexagon(p - 4 * Y, -Y, 9, 6, 6), f"axle {k} 0")
        it.joint("Revolute", f"wheel {k}", f"axle {k} 0", p, Y)
    it.held("guide", union(box(g - at(40, 8, 0), g + at(40, 12, 4)), box(g - at(12, 3, 0), g + at(12, 3, 40))), "wall")
    it.bolt("guide screw", [g + at(x, 2, 4) for x in (-28, 28)], -Z, 3, 20, "wall", "guide")
    pulls = [c + at(290, 46, z) for z in (-560, -360)]
    it.held("handle", box(pulls[0] + at(-12, 0, -40), pulls[1] + at(12, 25, 40)), "door")
    it.bolt("handle screw", [p - 30 * Y for p in pulls], Y, 3, 46, "handle", "door")
    it.joint("Prismatic", "door", "guide", g, X)
    return it
