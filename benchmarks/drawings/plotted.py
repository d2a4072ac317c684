"""Robots of students: a five-bar plotter, a linear delta, a spherical wrist and a palletizing arm."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import bolt, capscrew, nut, servo, servo_horn, stepper, strut, upright, washer, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import Shape, X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, meet, sphere, tube, union

THIRDS = 2 * np.pi * np.arange(3) / 3


def ray(turn: float) -> np.ndarray:
    """The direction at an angle in the plane xy."""
    return at(np.cos(turn), np.sin(turn), 0)


@kind
def five_bar_plotter(random: np.random.Generator) -> Drawing:
    """Two steppers under an acrylic plate, printed arms with set screws in captive nuts, bearings in acrylic links.

    Truth: arms turn on the motors, links on the bolts of the arms, and on the sleeve that holds the pen. Two freedoms.
    """
    d, play, half = Drawing(["Base plate"]), random.choice([0.0, 0.05, 0.15]), random.uniform(26, 34)
    base = box((-80, -50, 0), (80, 50, 5)).edges("|Z").fillet(10)
    tips = [at(side * half, 0, 0) + 80 * ray(np.pi / 2 - side * random.uniform(0.5, 0.8)) for side in (-1, 1)]
    pen = at(*meet(tips[0][:2], 100, tips[1][:2], 100), 0)
    for k, p in enumerate([at(a * 70, b * 40, 5) for a in (-1, 1) for b in (-1, 1)]):
        base = base.cut(bore(p, Z, 1.6, 20))
        fast(d, "Base plate", **{f"Standoff M3x50 {k}": hexagon(p - 55 * Z, Z, 2.75, 50, 1.5)})
        fast(d, f"Standoff M3x50 {k}", **{f"M3x12 {k}": capscrew(p, -Z, 1.5, 12)})
    for side, tag, low, end in ((-1, "L", 17, tips[0]), (1, "R", 23, tips[1])):
        spin, along = at(side * half, 0, 0), (end - at(side * half, 0, 0)) / 80
        base = base.cut(bore(spin, Z, 11.2, 20))
        fast(d, "Base plate", **{f"NEMA17 {tag}": stepper(spin, X, Z)})
        for k, p in enumerate([spin + at(a * 15.5, b * 15.5, 5) for a in (-1, 1) for b in (-1, 1)]):
            base = base.cut(bore(p, Z, 1.7, 20))
            if (k + (side > 0)) % 2:
                fast(d, f"NEMA17 {tag}", **{f"M3x8 {tag}{k}": capscrew(p, -Z, 1.5, 8)})
        arm = union(bar(spin, end, 7, 8, 16), cyl(spin + 8 * Z, Z, 11, 11))
        slot = laid(box((-7.6, -3.2, 8), (-5, 3.2, 22)), spin, along, Z)
        screw_at = spin - 2.5 * along + 13 * Z
        arm = cut(arm, bore(spin, Z, 2.5 + play, 50), bore(end, Z, 2.5, 50), slot, cyl(screw_at, -along, 1.5, 15))
        d.add(f"Arm {tag}", arm)
        fast(d, f"Arm {tag}", **{f"M3 nut {tag}": hexagon(screw_at - 2.5 * along, -along, 2.75, 2.4, 1.5)})
        fast(d, f"Arm {tag}", **{f"Grub screw {tag}": cyl(screw_at, -along, 1.5, 9)})
        fast(d, f"Arm {tag}", **{f"M5x30 {tag}": bolt(end + 8 * Z, Z, 2.5, low + 2)})
        fast(d, f"Arm {tag}", **{f"Spacer {tag}": tube(end + 16 * Z, Z, 2.6, 4, low - 16)})
        fast(d, f"Arm {tag}", **{f"M5 nut {tag}": nut(end + (low + 5) * Z, Z, 2.5)})
        d.add(f"625ZZ {tag}", tube(end + low * Z, Z, 2.5, 8, 5))
        link = bar(end, pen, 12, low, low + 5).cut(bore(end, Z, 8, 60))
        d.add(f"Link {tag}", link.cut(bore(pen, Z, 8 if side < 0 else 4, 60)))
        turns(d, (f"NEMA17 {tag}", f"Arm {tag}", spin), (f"Arm {tag}", f"Link {tag}", end))
    d.add("Base plate", base)
    sleeve = union(cyl(pen + 16 * Z, Z, 4, 12), cyl(pen + 28 * Z, Z, 7, 4)).cut(bore(pen, Z, 3, 60))
    fast(d, "Link R", Pen_sleeve=sleeve)
    fast(d, "Pen sleeve", Pen=cyl(pen - 40 * Z, Z, 3, 130), Retaining_ring=tube(pen + 16 * Z, Z, 4, 6.5, 1))
    fast(d, "Pen sleeve", Shim=tube(pen + 22 * Z, Z, 4, 6, 1))
    d.add("688ZZ", tube(pen + 17 * Z, Z, 4, 8, 5))
    turns(d, ("Link L", "Link R", pen))
    return d


@kind
def linear_delta(random: np.random.Generator) -> Drawing:
    """Three profiles with rails and carriages between two plates, printed mounts, rods with sockets on ball studs.

    Truth: carriages slide along the rails, sockets swivel on the balls; profiles stand on the plate with no screw.
    """
    d, play, room = Drawing(["Bottom"]), random.choice([0.0, 0.02]), random.choice([0.0, 0.05, 0.15])
    low, high = random.uniform(60, 90), random.uniform(300, 330)
    d.add("Bottom", cyl((0, 0, -15), Z, 165, 15))
    effector = cyl((0, 0, low - 4), Z, 28, 8).cut(bore((0, 0, low), Z, 8))
    studs = []
    for tag, turn in zip("XYZ", THIRDS + random.uniform(0, 1), strict=True):

        def put(shape: Shape, turn=turn) -> Shape:
            return laid(shape, (0, 0, 0), ray(turn), Z)

        fast(d, "Bottom", **{f"2020 {tag}": put(box((130, -10, 0), (150, 10, 500)))})
        rail = box((122, -6, 20), (130, 6, 480))
        for side in (-1, 1):
            rail = rail.cut(box((124.5, side * 5, 0), (127, side * 9, 500)))
        carriage = box((117, -13.5, high - 8), (127, 13.5, high + 38))
        carriage = carriage.cut(box((121.5, -6 - play, 0), (140, 6 + play, 500)))
        for side in (-1, 1):
            lip = box((124.5 + play, side * (5 + play), high - 8), (127 - play, side * 8, high + 38))
            carriage = carriage.union(lip)
        screws = [at(114, a * 9, high + b) for a, b in ((-1, 5), (1, 25))]
        carriage = cut(carriage, *(cyl(p, X, 1.5, 7.4) for p in screws))
        mount = union(box((110, -22, high), (117, 22, high + 30)), box((94, -14, high + 10), (112, 14, high + 20)))
        mount = mount.cut(box((90, -6, high - 9), (108, 6, high + 40)))
        mount = cut(mount, bore(at(100, 0, high + 15), Y, 2, 30), *(bore(p, X, 1.7, 9) for p in screws))
        mount = cut(mount, *(cyl(p, -X, 3, 30) for p in screws))
        fast(d, f"2020 {tag}", **{f"MGN12 rail {tag}": put(rail)})
        d.add(f"MGN12H {tag}", put(carriage))
        fast(d, f"MGN12H {tag}", **{f"Mount {tag}": put(mount)})
        for k, p in enumerate(screws):
            fast(d, f"Mount {tag}", **{f"M3x10 {tag}{k}": put(capscrew(p, X, 1.5, 7))})
        d.joint("Prismatic", f"MGN12 rail {tag}", f"MGN12H {tag}", (0, 0, 0), Z)
        ear = box((22, -14, low - 4), (41, 14, low + 4))
        effector = effector.union(put(ear.cut(bore(at(36, 0, low), Y, 2, 30))))
        top, end = at(100, 0, high + 15), at(36, 0, low)
        along = (end - top) / np.linalg.norm(end - top)
        for side, word in ((-1, "a"), (1, "b")):
            move, name = side * 20 * Y, f"{tag}{word}"
            for place, host, point in (("upper", f"Mount {tag}", top), ("lower", "Effector", end)):
                stud = sphere(point + move, 5).union(cyl(point + move - side * 13 * Y, side * Y, 2, 10))
                studs.append((host, f"Stud {place} {name}", put(stud)))
                inward = along if place == "upper" else -along
                socket = union(
                    cyl(point + move - 3 * Y, Y, 7.5, 6),
                    strut(point + move + 6 * inward, point + move + 22 * inward, 3.5),
                )
                socket = cut(socket, sphere(point + move, 5 + room))
                socket = socket.cut(strut(point + move + 14 * inward, point + move + 22 * inward, 2))
                fast(d, f"Rod {name}", **{f"Socket {place} {name}": put(socket)})
                spot = laid(cyl(point + move, Z, 1, 1), (0, 0, 0), ray(turn), Z).val().Center()
                spot = at(spot.x, spot.y, spot.z - 0.5)
                d.joint("Spherical", f"Stud {place} {name}", f"Socket {place} {name}", spot)
            d.add(f"Rod {name}", put(strut(top + move + 14 * along, end + move - 14 * along, 2)))
    d.add("Effector", effector)
    for host, name, shape in studs:
        fast(d, host, **{name: shape})
    fast(d, "Effector", Hotend=union(cyl((0, 0, low - 30), Z, 8, 60), cyl((0, 0, low + 4), Z, 11, 6)))
    cover = cyl((0, 0, 500), Z, 165, 12).cut(bore((0, 0, 500), Z, 100, 20))
    fast(d, "2020 X", Top=cover)
    weld(d, "Top", "2020 Y", "2020 Z")
    return d


@kind
def spherical_wrist(random: np.random.Generator) -> Drawing:
    """Three steppers on a corner, curved links of a quarter turn on two shells, pins, bushes, shoulder screws.

    Truth: nine hinges with axes through one point. Three freedoms.
    """
    d, play = Drawing(["Corner"]), random.choice([0.02, 0.05, 0.1])
    plates = [laid(box((100, -24, -24), (106, 106, 106)), (0, 0, 0), x, z) for x, z in ((X, Z), (Y, X), (Z, Y))]
    corner, platform = union(*plates), union(*(cyl(-8 * p, p, 9, 74) for p in (X, Y, Z)), box((-8,) * 3, (20,) * 3))
    inner = random.uniform(71, 73)

    def arch(start, end, low: float, width: float) -> Shape:
        """A quarter of a ring about the origin, with bosses at both ends."""
        ring = tube((0, 0, -6), Z, low, low + width, 12).intersect(box((0, 0, -9), (120, 120, 9)))
        ring = laid(ring, (0, 0, 0), start, np.cross(start, end))
        return union(ring, *(cyl(p * (low - 0.5), p, 8.5, width + 1) for p in (start, end)))

    for tag, u, w, v in (("1", X, -Y, Z), ("2", Y, -Z, X), ("3", Z, -X, Y)):
        corner = corner.cut(bore(106 * u, u, 11.2, 20))
        x = np.roll(u, 1)
        fast(d, "Corner", **{f"Stepper {tag}": stepper(106 * u, x, -u, out=23)})
        for k, (a, b) in enumerate(((1, 1), (-1, -1))):
            p = 100 * u + 15.5 * (a * x + b * np.cross(u, x))
            corner = corner.cut(bore(p, u, 1.6, 10))
            fast(d, f"Stepper {tag}", **{f"M3x10 {tag}{k}": capscrew(p, u, 1.5, 10)})
        link = arch(u, w, 85, 6).union(cyl(90 * u, u, 8.5, 7))
        link = cut(link, bore(90 * u, u, 2.5, 12), bore(90 * w, w, 3, 12), cyl(94 * u + 2.5 * x, x, 1.5, 10))
        d.add(f"Proximal {tag}", link)
        fast(d, f"Proximal {tag}", **{f"Set screw {tag}": cyl(94 * u + 2.5 * x, x, 1.5, 5)})
        pin = union(cyl(91.5 * w, -w, 3, 92.5 - inner), cyl(91.5 * w, w, 5, 2))
        fast(d, f"Proximal {tag}", **{f"Pin {tag}": pin})
        fast(d, f"Pin {tag}", **{f"Circlip {tag}": tube((inner - 0.5) * w, -w, 3, 5, 0.8)})
        fast(d, f"Pin {tag}", **{f"Sleeve {tag}": tube((inner + 6.5) * w, w, 3.1, 5, 78 - inner)})
        distal = cut(arch(w, v, inner, 6), bore(inner * w, w, 4.5, 20), bore(inner * v, v, 4.5, 20))
        d.add(f"Distal {tag}", distal)
        for word, p in (("w", w), ("v", v)):
            fast(d, f"Distal {tag}", **{f"Bush {word}{tag}": tube((inner - 0.5) * p, p, 3 + play, 4.5, 7)})
        screw = union(cyl((inner + 6.6) * v, v, 5.5, 3), cyl((inner + 6.6) * v, -v, 3, inner - 59.4))
        platform = platform.cut(cyl(66 * v, -v, 2.5, 16))
        fast(d, "Platform", **{f"Shoulder screw {tag}": screw.union(cyl(66 * v, -v, 2.5, 12))})
        turns(d, (f"Stepper {tag}", f"Proximal {tag}", at(0, 0, 0), u))
        turns(d, (f"Proximal {tag}", f"Distal {tag}", at(0, 0, 0), w))
        turns(d, (f"Distal {tag}", "Platform", at(0, 0, 0), v))
    d.add("Corner", corner)
    d.add("Platform", platform)
    return d


@kind
def palletizing_arm(random: np.random.Generator) -> Drawing:
    """A printed arm on three servos: cheeks on captive nuts, two parallelograms that keep the wrist level, M4 bolts.

    Truth: turntable, lever and crank turn on the servos, all other hinges on their bolts. Three freedoms.
    """
    d, play = Drawing(["Base"]), random.choice([0.05, 0.1, 0.25])
    lean, rise = np.radians(random.uniform(5, 25)), np.radians(random.uniform(-15, 10))
    s = at(0, 0, 85)
    e, c = s + 135 * at(np.sin(lean), 0, np.cos(lean)), s - 45 * at(np.cos(rise), 0, np.sin(rise))
    tail, w = e + c - s, e + 150 * at(np.cos(rise), 0, np.sin(rise))
    f, up = s + at(-40, 0, 10), at(14, 0, 38)
    base = box((-40, -30, 0), (60, 30, 34)).cut(box((-10.4, -10.2, 6), (30.7, 10.2, 40)))
    d.add("Base", base)
    fast(d, "Base", Servo_yaw=servo((0, 0, 45), X, Z))
    d.add("Horn yaw", servo_horn((0, 0, 45), X, Z))
    table = union(cyl((0, 0, 49), Z, 42, 8), box((-48, -33, 49), (0, -20, 57)), box((-47, -33, 49), (-33, -28, f[2])))
    table = union(table, upright([f[::2], (f - 10 * Z)[::2]], -33, -28, 7)).cut(cyl((0, 0, 48), Z, 4.6, 2.6))
    for k, p in enumerate((7.5 * X, -7.5 * X)):
        table = table.cut(bore(p + 57 * Z, Z, 1.2, 20))
        fast(d, "Horn yaw", **{f"M2x10 yaw {k}": capscrew(p + 57 * Z, -Z, 1.2, 10)})
    turns(d, ("Servo yaw", "Turntable"))
    weld(d, "Horn yaw", "Turntable")
    for side, tag, arm in ((-1, "R", "Lever"), (1, "L", "Crank")):
        cheek = box((-15, side * 20, 57), (15, side * 27.5, 125)).union(
            box((-26, side * 20, 57), (26, side * 27.5, 62))
        )
        cheek = cheek.cut(box((-10.4, side * 15, 74.6), (10.4, side * 40, 115.8)))
        place = s + side * 19 * Y
        fast(d, f"Cheek {tag}", **{f"Servo {tag}": servo(place, Z, -side * Y)})
        for k, (x, z) in enumerate(((5, -13.8), (-5, 34.1))):
            p = at(x, side * 30, 85 + z)
            cheek = cheek.cut(cyl(p, -side * Y, 2, 12))
            fast(d, f"Servo {tag}", **{f"M4x10 {tag}{k}": capscrew(p, -side * Y, 2, 8)})
        for k, x in enumerate((-21, 21)):
            p = at(x, side * 24, 62)
            cheek = cheek.cut(bore(p, Z, 1.7, 8))
            table = cut(table, bore(p, Z, 1.7, 20), hexagon(p - 13.1 * Z, Z, 2.8, 2.8))
            fast(d, f"Cheek {tag}", **{f"M3x14 {tag}{k}": capscrew(p, -Z, 1.5, 14)})
            fast(d, "Turntable", **{f"M3 nut {tag}{k}": hexagon(p - 12.7 * Z, Z, 2.7, 2.4, 1.5)})
        d.add(f"Cheek {tag}", cheek)
        weld(d, f"Cheek {tag}", "Turntable")
        d.add(f"Horn {tag}", servo_horn(place, Z, -side * Y))
        fast(d, arm, **{f"M2x8 {tag}": capscrew(s + side * 9 * Y + 7.5 * Z, side * Y, 1.2, 8)})
        weld(d, arm, f"Horn {tag}")
        turns(d, (f"Servo {tag}", arm, s, Y))

    def link(name: str, points, low: float, half: float = 7) -> None:
        """A printed link through points, between two heights."""
        thick = 10 if name == "Forearm" else 5 if low in (-27, -21) else 5.5 if name == "Rod" else 6
        shape = upright([p[::2] for p in points], low, low + thick, half)
        shape = cut(shape, *(bore(p, Y, 2 + play) for p in points if p is not s))
        if points[0] is s:
            hub = cyl(s + low * Y, Y, 12, 6)
            shape = shape.union(hub).cut(bore(s + 7.5 * Z, Y, 1.2, 40)).cut(cyl(s + low * Y, Y, 4.6, 6))
        d.add(name, shape)

    link("Lever", [s, e], -15)
    link("Crank", [s, c], 9)
    link("Rod", [c, tail], 3)
    link("Forearm", [tail, w], -8)
    d.parts["Forearm"] = d.parts["Forearm"].cut(bore(e, Y, 2 + play))
    link("Link 1", [f, f + e - s], -27)
    link("Triangle", [e, f + e - s, e + up], -21)
    link("Link 2", [e + up, w + up], -27)
    link("Wrist", [w, w + up], -21)
    d.parts["Turntable"] = table.cut(bore(f, Y, 2, 40))
    hand = box(w + at(8, -21, -25), w + at(30, -16, 8)).union(box(w + at(6, -35, -31), w + at(32, -5, -25)))
    hand = hand.union(box(w + at(0, -21, -5), w + at(10, -16, 5))).cut(bore(w, Y, 2 + play))
    cup = w + at(19, -28, -25)
    d.parts["Wrist"] = d.parts["Wrist"].union(hand).cut(bore(cup, Z, 3, 20))
    fast(d, "Wrist", Suction_cup=union(cyl(cup - 26 * Z, Z, 3, 38), cyl(cup - 34 * Z, Z, 9, 10)))
    for name, p, low, high, shims in (
        ("E", e, -21, 2, ((-16, 1), (-9, 1))),
        ("D", tail, -8, 8.5, ((2, 1),)),
        ("C", c, 3, 15, ((8.5, 0.5),)),
        ("F", f, -33, -22, ((-28, 1),)),
        ("T1", f + e - s, -27, -16, ((-22, 1),)),
        ("T2", e + up, -27, -16, ((-22, 1),)),
        ("W2", w + up, -27, -16, ((-22, 1),)),
        ("W", w, -21, 2, ((-16, 8),)),
    ):
        d.add(f"M4 bolt {name}", bolt(p + low * Y, Y, 2, high - low + 5))
        d.add(f"M4 nyloc {name}", nut(p + high * Y, Y, 2))
        for k, (y, thick) in enumerate(shims):
            d.add(f"Washer {name}{k}", washer(p + y * Y, Y, 2, thick))
    turns(d, ("Lever", "Forearm", e, Y), ("Lever", "Triangle", e, Y), ("Rod", "Forearm", tail, Y))
    turns(d, ("Crank", "Rod", c, Y), ("Turntable", "Link 1", f, Y), ("Link 1", "Triangle", f + e - s, Y))
    turns(d, ("Triangle", "Link 2", e + up, Y), ("Link 2", "Wrist", w + up, Y), ("Forearm", "Wrist", w, Y))
    return d
