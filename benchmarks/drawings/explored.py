"""Robots that walk and drive: the leg of a quadruped with a pushrod to its knee, and a rover on rockers and bogies."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import bolt, capscrew, nut, strut, upright, upright_at, washer, weld
from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, X, Y, Z, at, bar, bore, box, cut, cyl, laid, sphere, tube, union


def _actuator(origin, x, z) -> tuple[Shape, Shape]:
    """A flat geared motor, its case and the flange that turns in a pocket of it; the face of the case at the origin."""
    case = union(cyl((0, 0, -36), Z, 44, 36).edges("%CIRCLE").chamfer(2), box((-12, -50, -30), (12, -38, -8)))
    case = cut(case, cyl((0, 0, -6), Z, 24.3, 7), cyl((0, 0, -18), Z, 8, 18))
    flange = union(cyl((0, 0, -5.6), Z, 24, 9.6), cyl((0, 0, -16), Z, 8, 12))
    holes = [cyl((18 * np.cos(t), 18 * np.sin(t), -3), Z, 1.65, 8) for t in np.arange(6) * np.pi / 3]
    return laid(case, origin, x, z), laid(cut(flange, *holes), origin, x, z)


@kind
def quadruped_pushrod_leg(random: np.random.Generator) -> Drawing:
    """A leg of three flat actuators: abduction, hip, and a knee that is pushed by a rod from a crank beside the hip.

    Truth: each rotor in its stator (revolute: along x at the chassis, along y at hip and knee's motor, on one line);
    rod on the crank's pin and on the shank's pin, shank on the knee's shaft: revolute along y. Hip bracket is one with
    rotor 1 and stator 2; thigh's plates, standoffs, screws, stator 3 and the knee's shaft with rotor 2; crank and its
    pin with rotor 3; the rod's bearings with the rod; knee's bearings, foot, other pin with the shank. Three freedoms.
    """
    thigh, shank = random.uniform(190, 215), random.uniform(180, 205)
    lean, fold = np.radians(random.uniform((15, 45), (45, 75)))
    hip = at(96, 0)
    down = at(np.sin(lean), -np.cos(lean))
    knee = hip + thigh * down
    side = at(-down[1], down[0])  # to the front of the thigh
    turn = np.radians(random.uniform(-15, 15))
    crank = hip - 30 * (np.cos(turn) * side + np.sin(turn) * down)
    turn += np.radians(random.uniform(-8, 8))
    lever = knee - 32 * (np.cos(turn) * side + np.sin(turn) * down)
    toe = knee + shank * at(np.sin(lean - fold), -np.cos(lean - fold))
    play = float(random.choice([0, 0.02]))
    drawing = Drawing(fixed=["Chassis_Side_Plate"])
    drawing.add(
        "Chassis_Side_Plate", box((-6, -70, -60), (0, 70, 60)).edges("|X").fillet(10).cut(bore((-3, 0, 0), X, 20, 10))
    )
    for number, (origin, x, z) in enumerate((((36, 0, 0), Z, X), ((96, 94, 0), Z, Y), ((96, 132, 0), Z, -Y)), 1):
        case, flange = _actuator(origin, x, z)
        drawing.add(f"AK80-9_Stator:{number}", case)
        drawing.add(f"AK80-9_Rotor:{number}", flange)
        drawing.joint("Revolute", f"AK80-9_Stator:{number}", f"AK80-9_Rotor:{number}", origin, z)
    bracket = union(
        box((40, -30, -30), (46, 58, 30)), box((40, 52, -40), (hip[0], 58, 40)), cyl((hip[0], 52, 0), Y, 46, 6)
    )
    bracket = union(
        bracket, *(box((45, 20, z), (75, 53, z + 5)).edges("|Z and >X and <Y").chamfer(24) for z in (-30, 25))
    )
    drawing.add("Hip_Bracket", bracket)
    weld(drawing, "Chassis_Side_Plate", "AK80-9_Stator:1")
    weld(drawing, "Hip_Bracket", "AK80-9_Rotor:1", "AK80-9_Stator:2")
    for name, low, round_ in (("Thigh_Plate_Inner", 98, 30), ("Thigh_Plate_Outer", 168, 46)):
        flat = union(upright([hip, knee], low, low + 6, 15), cyl((hip[0], low, hip[1]), Y, round_, 6))
        spots = [hip + along * down + 8 * side for along in (80, 135)]
        drawing.add(
            name,
            cut(flat, bore(upright_at(knee, low), Y, 6, 20), *(bore(upright_at(p, low), Y, 2.5, 20) for p in spots)),
        )
    weld(drawing, "Thigh_Plate_Inner", "AK80-9_Rotor:2")
    weld(drawing, "Thigh_Plate_Outer", "AK80-9_Stator:3")
    for number, p in enumerate(spots, 1):
        drawing.add(f"Standoff_64mm:{number}", tube(upright_at(p, 104), Y, 2.5, 6, 64))
        weld(drawing, "Thigh_Plate_Inner", f"Standoff_64mm:{number}")
        for word, start, way in (("i", 98, Y), ("o", 174, -Y)):
            drawing.add(f"M5x20:{number}{word}", capscrew(upright_at(p, start), way, 2.5, 20))
            weld(drawing, f"Standoff_64mm:{number}", f"M5x20:{number}{word}")
    weld(drawing, "Standoff_64mm:1", "Thigh_Plate_Outer")
    drawing.add("Knee_Shaft", union(cyl(upright_at(knee, 96), Y, 6, 80), cyl(upright_at(knee, 94), Y, 8, 4)))
    weld(drawing, "Thigh_Plate_Inner", "Knee_Shaft")
    arm = union(upright([hip, crank], 120, 128, 11), cyl((hip[0], 120, hip[1]), Y, 24, 8))
    drawing.add("Knee_Crank", cut(arm, bore(upright_at(crank, 120), Y, 3, 20)))
    weld(drawing, "Knee_Crank", "AK80-9_Rotor:3")
    rod = union(upright([crank, lever], 111, 119, 5), *(cyl(upright_at(p, 111), Y, 9, 8) for p in (crank, lever)))
    drawing.add("Push_Rod", cut(rod, *(bore(upright_at(p, 111), Y, 6, 20) for p in (crank, lever))))
    leg = union(
        cyl(upright_at(knee, 106), Y, 16, 60), upright([knee, lever], 120, 128, 10), upright([knee, toe], 132, 146, 11)
    )
    leg = cut(leg, bore(upright_at(knee, 136), Y, 8, 90), *(cyl(upright_at(knee, y), Y, 12, 6) for y in (106, 160)))
    leg = cut(leg, bore(upright_at(lever, 120), Y, 3, 20))
    ball = sphere(upright_at(toe, 139), 19)
    drawing.add("Shank", leg)
    drawing.add("Foot_Rubber", ball.cut(leg))
    weld(drawing, "Shank", "Foot_Rubber")
    for number, (p, owner, word) in enumerate(((crank, "Knee_Crank", "Crank_Pin"), (lever, "Shank", "Lever_Pin")), 1):
        drawing.add(f"Bearing_6x12x8:{number}", tube(upright_at(p, 111), Y, 3 + play, 6, 8))
        drawing.add(f"{word}_M6", bolt(upright_at(p, 111), Y, 3, 17))
        weld(drawing, "Push_Rod", f"Bearing_6x12x8:{number}")
        weld(drawing, owner, f"{word}_M6")
        drawing.joint("Revolute", "Push_Rod", owner, upright_at(p, 115), Y)
    for number, y in enumerate((106, 160), 1):
        drawing.add(f"Bearing_61901:{number}", tube(upright_at(knee, y), Y, 6 + play, 12, 6))
        weld(drawing, "Shank", f"Bearing_61901:{number}")
    drawing.joint("Revolute", "Knee_Shaft", "Bearing_61901:1", upright_at(knee, 109), Y)
    return drawing


def _eye_ball(point, axis) -> Shape:
    """The ball of a small rod end."""
    unit = np.asarray(axis, float)
    return sphere(point, 8).intersect(cyl(point - 6 * unit, unit, 20, 12)).cut(bore(point, unit, 3, 20))


@kind
def rocker_bogie_rover(random: np.random.Generator) -> Drawing:
    """A six-wheeled rover with a differential bar across its body, drawn on rough ground, left and right mirrored.

    Truth: rockers on the body's stub axles (through their bearing's two rings), bogies on rockers, wheels on their
    motors: revolute along y; bar on the body revolute, vertical; link to the rocker's ball and to the bar's ball
    spherical on both sides. Motors are one with rocker or bogie; bolts, nuts and washers of a bogie with its rocker;
    balls and their bolts with rocker and bar. Nine freedoms (differential, bogies, wheels), and the spins of two links.
    """
    sway, tilts = np.radians(random.uniform(-9, 9)), np.radians(random.uniform(-14, 14, 2))
    radius, high = random.uniform(52, 62), 150.0
    horn, wide, behind = 84.0, 79.0, -85.0
    drawing = Drawing(fixed=["Chassis_Body"])
    body = box((-150, -70, 120), (110, 70, 190)).edges("|X").fillet(8).cut(box((-144, -64, 126), (104, 64, 184)))
    drawing.add("Chassis_Body", cut(body, bore((0, 0, high), Y, 8, 200), bore((behind, 0, 190), Z, 4, 20)))
    drawing.add("Diff_Pivot_Post", tube((behind, 0, 190), Z, 4, 10, 30))
    drawing.add("M8_Washer_Diff", washer((behind, 0, 220), Z, 4, 2))
    drawing.add("M8x60_Diff", bolt((behind, 0, 228), -Z, 4, 52))
    drawing.add("M8_Nut_Diff", nut((behind, 0, 184), -Z, 4))
    weld(drawing, "Chassis_Body", "Diff_Pivot_Post", "M8x60_Diff")
    weld(drawing, "Diff_Pivot_Post", "M8_Washer_Diff")
    weld(drawing, "M8x60_Diff", "M8_Nut_Diff")
    swing = np.arcsin(horn * np.sin(sway) / wide)
    ends = [at(behind - side * wide * np.sin(swing), side * wide * np.cos(swing), 234.0) for side in (1, -1)]
    beam = bar(ends[0], ends[1], 9, 222, 228, [*ends], 3).cut(bore((behind, 0, 225), Z, 4.1, 20))
    drawing.add("Differential_Bar", beam)
    drawing.joint("Revolute", "M8x60_Diff", "Differential_Bar", (behind, 0, 225), Z)
    for side, word, end, tilt in ((1, "L", ends[0], tilts[0]), (-1, "R", ends[1], tilts[1])):
        turn = side * sway

        def swung(x: float, z: float, turn=turn) -> np.ndarray:
            return at(np.cos(turn) * x - np.sin(turn) * z, high + np.sin(turn) * x + np.cos(turn) * z)

        front, joint, top = swung(185, -88), swung(-95, -48), swung(0, horn)

        def tilted(x: float, z: float, joint=joint, tilt=tilt) -> np.ndarray:
            return joint + at(np.cos(tilt) * x - np.sin(tilt) * z, np.sin(tilt) * x + np.cos(tilt) * z)

        middle, rear = tilted(88, -44), tilted(-88, -44)

        def mirrored(low: float, high: float, side=side) -> tuple[float, float]:
            one, other = sorted((side * low, side * high))
            return one, other

        def out(p, y: float, side=side) -> np.ndarray:
            return upright_at(p, side * y)

        way = side * Y
        centre = at(0, high)
        rocker = union(
            *(upright([centre, p], *mirrored(85, 97), half) for p, half in ((front, 11), (joint, 11), (top, 8))),
            cyl(out(centre, 80), way, 17, 17),
            cyl(out(front, 85), way, 15, 26),
        )
        rocker = cut(
            rocker, bore(out(centre, 90), Y, 11, 20), bore(out(joint, 90), Y, 4, 20), bore(out(top, 90), Y, 3, 20)
        )
        rocker = cut(rocker, bore(out(front, 95), Y, 3.5, 30))
        drawing.add(f"Rocker_{word}", rocker)
        bogie = union(
            upright([middle, joint, rear], *mirrored(99, 111), 10),
            *(cyl(out(p, 99), way, 15, 12) for p in (middle, rear)),
        )
        bogie = cut(bogie, bore(out(joint, 100), Y, 4.1, 30), *(bore(out(p, 100), Y, 3.5, 30) for p in (middle, rear)))
        drawing.add(f"Bogie_{word}", bogie)
        axle = union(
            cyl(out(centre, 40), way, 8, 42), cyl(out(centre, 70), way, 12, 8), cyl(out(centre, 78), way, 4, 24)
        )
        drawing.add(f"Stub_Axle_{word}", axle)
        drawing.add(f"608_Inner_{word}", tube(out(centre, 82), way, 4, 6.6, 7))
        drawing.add(f"608_Outer_{word}", tube(out(centre, 82), way, 6.8, 11, 7))
        weld(drawing, "Chassis_Body", f"Stub_Axle_{word}")
        weld(drawing, f"Stub_Axle_{word}", f"608_Inner_{word}")
        weld(drawing, f"Rocker_{word}", f"608_Outer_{word}")
        drawing.joint("Revolute", f"608_Inner_{word}", f"608_Outer_{word}", out(centre, 85), Y)
        drawing.add(f"M8x35_{word}", bolt(out(joint, 85), way, 4, 35))
        drawing.add(f"M8_Washer_{word}", washer(out(joint, 97), way, 4, 2))
        drawing.add(f"M8_Locknut_{word}", nut(out(joint, 111), way, 4))
        weld(drawing, f"Rocker_{word}", f"M8x35_{word}", f"M8_Washer_{word}")
        weld(drawing, f"M8x35_{word}", f"M8_Locknut_{word}")
        drawing.joint("Revolute", f"Rocker_{word}", f"Bogie_{word}", out(joint, 98), Y)
        for number, (p, owner, face) in enumerate(
            ((front, "Rocker", 85), (middle, "Bogie", 99), (rear, "Bogie", 99)), 1
        ):
            case = union(
                cyl(out(p, face - 52), way, 12.5, 52),
                cyl(out(p, face - 1), way, 3.5, 3.5),
                cyl(out(p, face), way, 2, 132 - face),
            )
            flat = laid(box((1.5, -4, 108), (4, 4, 140)), out(p, 0), X, way)
            drawing.add(f"Gearmotor_25D_{word}{number}", case.cut(flat))
            wheel = union(
                tube(out(p, 120), way, radius - 9, radius - 2, 44),
                cyl(out(p, 120), way, radius - 8, 5),
                cyl(out(p, 113), way, 8, 16),
            )
            spots = np.arange(16) * np.pi / 8
            ribs = [
                laid(box((radius - 4, -2, 120), (radius, 2, 164)), out(p, 0), at(np.cos(t), 0, np.sin(t)), way)
                for t in spots
            ]
            wheel = cut(union(wheel, *ribs), cut(cyl(out(p, 110), way, 2, 22), flat))
            drawing.add(f"Wheel_{word}{number}", wheel)
            weld(drawing, f"{owner}_{word}", f"Gearmotor_25D_{word}{number}")
            drawing.joint("Revolute", f"Gearmotor_25D_{word}{number}", f"Wheel_{word}{number}", out(p, 120), Y)
        near = out(top, 79)
        link = union(strut(near, end, 4), cyl(near - 4.5 * Y, Y, 11, 9), cyl(end - 4.5 * Z, Z, 11, 9))
        drawing.add(
            f"Diff_Link_{word}", cut(link, sphere(near, 8), sphere(end, 8), bore(near, Y, 6.5, 6), bore(end, Z, 6.5, 6))
        )
        drawing.add(f"Rod_end_ball_{word}1", _eye_ball(near, Y))
        drawing.add(f"Rod_end_ball_{word}2", _eye_ball(end, Z))
        drawing.add(f"M6x30_{word}1", bolt(out(top, 97), -way, 3, 30))
        drawing.add(f"M6x30_{word}2", bolt(end + 6 * Z, -Z, 3, 26))
        for number, owner, p in ((1, f"Rocker_{word}", near), (2, "Differential_Bar", end)):
            weld(drawing, owner, f"M6x30_{word}{number}")
            weld(drawing, f"M6x30_{word}{number}", f"Rod_end_ball_{word}{number}")
            drawing.joint("Spherical", f"Diff_Link_{word}", f"Rod_end_ball_{word}{number}", p)
    return drawing
