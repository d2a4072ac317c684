"""A car's wiper linkage and the two upper axes of a hobby router, from engineers who take parts of catalogues."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.catalogued import nut, rings, strut, weld
from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, screw, sphere, union


def _cup(centre, away, inner: float) -> tuple[Shape, Shape]:
    """A socket about a ball, closed on the side away from its stud, and what is hollow in it."""
    return cyl(centre - 3.5 * away, away, 10, 12), sphere(centre, inner)


@kind
def tandem_wiper(random: np.random.Generator) -> Drawing:
    """A wiper drive with pivots that lean apart, two rods with ball sockets on a V-shaped crank, arms and blades.

    Truth: crank on the motor revolute; each rod spherical on a ball of the crank and on one of its lever; each pivot
    shaft in its housing revolute along its own lean; arm on its head and blade on its arm revolute (across the arm).
    Motor, its screws and housings are one with the frame tube; lever, ball, head and nut with the pivot shaft; hinge
    pins with head and blade. Crank, arms and blades: five freedoms, and the spins of two rods.
    """
    apart, drop = random.uniform(370, 430), random.uniform(57, 75)
    turn, reach, radius = np.radians(random.uniform(105, 195)), random.uniform(58, 68), random.uniform(34, 40)
    loose = float(random.choice([0, 0.05, 0.1]))
    drawing = Drawing(fixed=["Wiper Frame Tube"])
    pivots = [at(0, 0, 0), at(apart, random.uniform(-20, 20), 0)]
    leans = [
        at(np.sin(a), np.sin(b), 1) for a, b in np.radians(random.uniform((-9, 3, 2, 3), (-3, 8, 7, 8))).reshape(2, 2)
    ]
    leans = [lean / np.linalg.norm(lean) for lean in leans]
    motor = at(apart / 2, -drop, 0)
    ends = [p + 8 * lean for p, lean in zip(pivots, leans, strict=True)]
    frame = union(
        strut(*ends, 9), box((motor[0] - 45, motor[1] - 45, -14), (motor[0] + 45, 16, -10)).edges("|Z").fillet(9)
    )
    frame = union(frame, box((motor[0] - 14, -9, -12), (motor[0] + 14, 9, 8)))
    spots = [motor + 36 * at(np.cos(t), np.sin(t), 0) for t in np.radians((30, 150, 270))]
    frame = cut(frame, bore(motor, Z, 14, 20), *(bore(p, Z, 2.75, 20) for p in spots))
    frame = cut(frame, *(bore(p, lean, 12, 30) for p, lean in zip(pivots, leans, strict=True)))
    drawing.add("Wiper Frame Tube", frame)
    gear = union(
        cyl(motor - 10 * Z, Z, 42, 24).edges(">Z").fillet(4), cyl(motor + at(10, -20, 14.5), at(0.3, -1, 0), 24, 110)
    )
    gear = cut(gear, *(bore(p, Z, 2.5, 18) for p in spots))
    gear = union(gear, cyl(motor - 13 * Z, Z, 10, 6), cyl(motor - 37 * Z, Z, 5, 30))
    drawing.add("Wiper Motor", gear)
    weld(drawing, "Wiper Frame Tube", "Wiper Motor")
    for number, p in enumerate(spots, 1):
        drawing.add(f"Screw M5x14-{number}", screw(p - 14 * Z, Z, 2.5, 14))
        weld(drawing, "Wiper Motor", f"Screw M5x14-{number}")
    tips = [
        motor + radius * at(np.cos(a), np.sin(a), 0) - depth * Z
        for a, depth in ((turn, 35), (turn - np.radians(70), 51))
    ]
    plate = union(*(bar(motor, tip, 9, -28, -24) for tip in tips))
    drawing.add("Motor Crank", cut(plate, bore(motor, Z, 5, 40), *(bore(tip, Z, 3.5, 60) for tip in tips)))
    drawing.add("Nut M10 crank", nut(motor - 28 * Z, -Z, 5))
    weld(drawing, "Motor Crank", "Nut M10 crank")
    drawing.joint("Revolute", "Wiper Motor", "Motor Crank", motor - 22 * Z, Z)
    for number, (p, lean, tip) in enumerate(zip(pivots, leans, tips, strict=True), 1):
        angle, swung = np.radians(random.uniform((-110, 20), (-65, 65)))
        ahead = np.cross(np.cross(lean, at(np.cos(angle), np.sin(angle), 0)), lean)
        ahead /= np.linalg.norm(ahead)
        out = np.cross(np.cross(lean, at(np.cos(swung), np.sin(swung), 0)), lean)
        out /= np.linalg.norm(out)
        end = p + reach * ahead - 31 * lean
        housing = cut(
            union(cyl(p - 12 * lean, lean, 12, 40), cyl(p + 19 * lean, lean, 15, 4)), bore(p, lean, 6 + loose, 60)
        )
        drawing.add(f"Pivot Housing-{number}", housing)
        drawing.add(f"Pivot Shaft-{number}", union(cyl(p - 27 * lean, lean, 6, 76), cyl(p - 16 * lean, lean, 9, 3.5)))
        lever = laid(bar((0, 0), (reach, 0), 10, -25, -21, [(0, 0)], 6), p, ahead, lean)
        drawing.add(f"Pivot Lever-{number}", lever.cut(bore(end, lean, 3.5, 40)))
        drawing.add(
            f"Lever Ball Stud-{number}",
            union(sphere(end, 6.5), cyl(end, lean, 3.5, 10), cyl(end + 10 * lean, lean, 5, 2)),
        )
        drawing.add(
            f"Crank Ball Stud-{number}",
            union(
                sphere(tip, 6.5), strut(tip, tip * at(1, 1, 0) - 24 * Z, 3.5), cyl(tip * at(1, 1, 0) - 24 * Z, Z, 5, 2)
            ),
        )
        (one, hollow_1), (other, hollow_2) = _cup(end, -lean, 6.5 + loose), _cup(tip, -Z, 6.5 + loose)
        way = (tip - end) / np.linalg.norm(tip - end)
        rod = union(one, other, strut(end + 8 * way - 3 * lean, tip - 8 * way - 3 * Z, 4.5))
        drawing.add(f"Drive Rod-{number}", cut(rod, hollow_1, hollow_2))
        head = union(
            cyl((0, 0, 32), Z, 13, 13),
            box((0, -13, 35), (36, 13, 43)),
            *(box((34, s * 7, 35), (52, s * 13, 43)) for s in (-1, 1)),
        )
        head = cut(head, bore((0, 0, 40), Z, 6, 20), bore((46, 0, 39), Y, 2.5, 20))
        arm = union(
            cyl((46, -6.5, 39), Y, 4, 13),
            box((46, -6.5, 36), (120, 6.5, 42)),
            box((118, -4, 37), (330, 4, 41)),
            cyl((330, -4, 39), Y, 4.5, 8),
        )
        arm = cut(arm, bore((46, 0, 39), Y, 2.5 + loose, 20), bore((330, 0, 39), Y, 2 + loose, 20))
        blade = union(
            box((130, -7, 22), (530, 7, 27)),
            box((130, -1.5, 12), (530, 1.5, 23)),
            *(box((322, s * 4.3, 26), (338, s * 7, 43)) for s in (-1, 1)),
        )
        blade = cut(blade, bore((330, 0, 39), Y, 2, 20))
        place = (p, out, lean)
        for name, shape in (
            ("Arm Head", head),
            ("Cap Nut M12", hexagon((0, 0, 45), Z, 9, 8, 6)),
            ("Hinge Pin", cyl((46, -13, 39), Y, 2.5, 26)),
            ("Wiper Arm", arm),
            ("Blade Pin", cyl((330, -7.5, 39), Y, 2, 15)),
            ("Wiper Blade", blade),
        ):
            drawing.add(f"{name}-{number}", laid(shape, *place))
        across = np.cross(lean, out)
        weld(drawing, "Wiper Frame Tube", f"Pivot Housing-{number}")
        weld(drawing, "Motor Crank", f"Crank Ball Stud-{number}")
        weld(drawing, f"Pivot Shaft-{number}", f"Pivot Lever-{number}", f"Arm Head-{number}", f"Cap Nut M12-{number}")
        weld(drawing, f"Pivot Lever-{number}", f"Lever Ball Stud-{number}")
        weld(drawing, f"Arm Head-{number}", f"Hinge Pin-{number}")
        weld(drawing, f"Wiper Blade-{number}", f"Blade Pin-{number}")
        drawing.joint("Revolute", f"Pivot Housing-{number}", f"Pivot Shaft-{number}", p, lean)
        drawing.joint("Spherical", f"Lever Ball Stud-{number}", f"Drive Rod-{number}", end)
        drawing.joint("Spherical", f"Crank Ball Stud-{number}", f"Drive Rod-{number}", tip)
        drawing.joint("Revolute", f"Hinge Pin-{number}", f"Wiper Arm-{number}", p + 46 * out + 39 * lean, across)
        drawing.joint("Revolute", f"Wiper Arm-{number}", f"Blade Pin-{number}", p + 330 * out + 39 * lean, across)
    return drawing


def _profile(grown: float, length: float) -> Shape:
    """A profiled rail of 15 mm from the origin along z, upward along y."""
    half = [(7.5, 0), (7.5, 6), (5.5, 8), (5.5, 11), (7.5, 13), (7.5, 15)]
    points = half + [(-x, y) for x, y in reversed(half)]
    sketch = cq.Workplane().polyline(points).close()
    return (sketch.offset2D(grown, "intersection") if grown else sketch).extrude(length)


def _stage(
    drawing: Drawing,
    tag: str,
    base: str,
    carriage: str,
    frame,
    span: float,
    reach,
    place: float,
    half: float,
    grown: float,
) -> None:
    """Rails, blocks, a ballscrew with its supports and its motor between a base plate and a carriage.

    In the frame: z along the travel between both reaches, x across the rails, y from the base's face to the carriage.
    """
    low, high = reach
    screw_y, long = 14.5, high - low

    def add(name: str, shape: Shape, owner: str) -> str:
        drawing.add(f"{name} {tag}", laid(shape, *frame))
        weld(drawing, owner, f"{name} {tag}")
        return f"{name} {tag}"

    origin, x, z = (np.asarray(each, float) for each in frame)
    y = np.cross(z, x)
    middle = origin + screw_y * y
    for number, side in enumerate((-1, 1), 1):
        rail = _profile(0, long - 20).translate((side * span, 0, low + 10))
        holes = [
            union(bore((side * span, 0, at_z), Y, 2.25, 30), cyl((side * span, 9.7, at_z), Y, 3.75, 6))
            for at_z in np.arange(low + 30, high - 20, 60)
        ]
        rail = add(f"HGR15 Rail:{number}", cut(rail, *holes), base)
        for count, offset in enumerate((-half, half), 1):
            block = (
                box((-17, 4.3, -25), (17, 28, 25))
                .edges("|Z")
                .chamfer(1.2)
                .cut(_profile(grown, 99).translate((0, 0, -50)))
            )
            block = add(
                f"HGH15CA:{2 * number - 2 + count}", block.translate((side * span, 0, place + offset)), carriage
            )
            if count == 1:
                drawing.joint("Prismatic", rail, block, origin + side * span * x + place * z, z)
    spindle = cyl((0, screw_y, low + 22), Z, 6, long - 62)
    spindle = union(spindle, cyl((0, screw_y, low + 4), Z, 5, 20), cyl((0, screw_y, high - 42), Z, 5, 33))
    drawing.add(f"SFU1204 Screw {tag}", laid(spindle, *frame))
    flange = union(
        cyl((0, screw_y, place - 12), Z, 11, 34),
        cyl((0, screw_y, place - 22), Z, 20, 10).intersect(box((-40, screw_y - 13, -999), (40, screw_y + 13, 999))),
    )
    add("SFU1204 Nut", flange.cut(bore((0, screw_y, place), Z, 6, 99)), f"Nut Housing {tag}")
    add(
        "Nut Housing",
        box((-19, 1.5, place - 12), (19, 28, place + 12)).cut(bore((0, screw_y, place), Z, 11, 50)),
        carriage,
    )
    drawing.joint("Cylindrical", f"SFU1204 Screw {tag}", f"SFU1204 Nut {tag}", middle, z)
    for word, near in (("BF10", low + 4), ("BK10", high - 42)):
        support = box((-21, 0, near), (21, 27, near + 18)).edges("|Z and >Y").chamfer(6)
        support = cut(support, cyl((0, screw_y, near + 6), Z, 11, 6), bore((0, screw_y, near), Z, 8, 50))
        support = add(word, support, base)
        inner, outer = rings((0, screw_y, near + 6), Z, 5, 11, 6)
        inner = add(f"6900 Inner {word}", inner, f"SFU1204 Screw {tag}")
        outer = add(f"6900 Outer {word}", outer, support)
        drawing.joint("Revolute", inner, outer, middle + near * z, z)
    mount = box((-29, -14, high), (29, 43, high + 8)).cut(bore((0, screw_y, high), Z, 19.1, 20))
    mount = add("Motor Plate", mount, base)
    body = box((-28.2, screw_y - 28.2, high + 8), (28.2, screw_y + 28.2, high + 64)).edges("|Z").fillet(4)
    body = union(body, cyl((0, screw_y, high + 6.4), Z, 19.05, 4), cyl((0, screw_y, high - 7), Z, 3.175, 16))
    motor = add("NEMA23", body, mount)
    sleeve = cyl((0, screw_y, high - 21), Z, 9.5, 24)
    sleeve = cut(sleeve, cyl((0, screw_y, high - 25), Z, 5, 17), cyl((0, screw_y, high - 8), Z, 3.175, 20))
    sleeve = cut(
        sleeve,
        cyl((0, screw_y, high - 13.2), Z, 5, 5.2),
        bore((6, screw_y, high - 16), Y, 1.25, 15),
        bore((6, screw_y, high - 2), Y, 1.25, 15),
    )
    sleeve = add("Coupling", sleeve, f"SFU1204 Screw {tag}")
    drawing.joint("Revolute", motor, sleeve, middle + high * z, z)


@kind
def router_xz_axes(random: np.random.Generator) -> Drawing:
    """Two axes of a router on profiled rails with ballscrews, rings of bearings without balls, and a spindle.

    Truth for both axes: two rails and one of the blocks on each prismatic along the travel (all four blocks one with
    the carriage); screw in both bearings revolute (inner rings one with the screw, outer with BK and BF), coupling (one
    with the screw) on the motor's shaft revolute, screw in its nut cylindrical, since threads are not a kind. Rails,
    supports, motor plate and motor are one with the base, nut and housing with the carriage. Spindle's nose in its
    body revolute. Travel and turn of both screws, spindle: five freedoms of which threads take two.
    """
    wide, x0 = random.uniform(330, 420), random.uniform(-50, 50)
    z0 = random.uniform(-25, 25)
    grown = float(random.choice([0, 0.1, 0.2]))
    drawing = Drawing(fixed=["Gantry Beam"])
    beam = box((-wide / 2, 0, -75), (wide / 2, 40, 75)).edges("|X").fillet(3)
    beam = cut(beam, *(box((-999, 12, z), (999, 34, z + 44)) for z in (-62, 18)))
    drawing.add("Gantry Beam", beam)
    # the gantry's face is at y = 0, and what it carries is on the side of -y
    drawing.add("X Carriage Plate", box((x0 - 62, -28, -100), (x0 + 62, -38, 118)).edges("|Y").fillet(4))
    _stage(drawing, "X", "Gantry Beam", "X Carriage Plate", ((0, 0, 0), Z, X), 48, (-wide / 2, wide / 2), x0, 32, grown)
    front = at(x0, -38, 0)
    low = z0 - 5
    drawing.add("Z Carriage Plate", box((x0 - 58, -66, low - 62), (x0 + 58, -76, low + 62)).edges("|Y").fillet(4))
    _stage(drawing, "Z", "X Carriage Plate", "Z Carriage Plate", (front, -X, Z), 38, (-100, 118), low, 30, grown)
    axis = at(x0, -112, low)
    clamp = union(cyl(axis - 35 * Z, Z, 35, 55), box((x0 - 35, -112, low - 35), (x0 + 35, -76, low + 20)))
    clamp = cut(clamp, bore(axis, Z, 26, 99), box((x0 - 2, -160, low - 50), (x0 + 2, -130, low + 30)))
    drawing.add("Spindle Clamp 52mm", clamp)
    drawing.add(
        "Spindle 500W Body",
        cut(cyl(axis - 62 * Z, Z, 26, 150).edges("%CIRCLE").chamfer(1), cyl(axis - 70 * Z, Z, 8 + grown, 70)),
    )
    nose = union(cyl(axis - 80 * Z, Z, 8, 75), cyl(axis - 90 * Z, Z, 9.5, 24))
    drawing.add("ER11 Nose", nose.cut(cyl(axis - 95 * Z, Z, 3, 30)))
    drawing.add("End Mill 6mm", cyl(axis - 130 * Z, Z, 3, 60))
    weld(drawing, "Z Carriage Plate", "Spindle Clamp 52mm")
    weld(drawing, "Spindle Clamp 52mm", "Spindle 500W Body")
    weld(drawing, "ER11 Nose", "End Mill 6mm")
    drawing.joint("Revolute", "Spindle 500W Body", "ER11 Nose", axis, Z)
    return drawing
