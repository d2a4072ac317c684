"""A V-twin of a course in Spanish, and the front corner of a student's racing car."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import bolt, capscrew, eye, nut, plate, ram, rings, strut, weld
from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, hexagon, laid, sphere, tube, union


@kind
def motor_v_twin(random: np.random.Generator) -> Drawing:
    """A V-twin with every circlip: split rods on one pin, pistons with rings, bearings as rings without balls.

    Truth: crank in both bearings (inner rings one with the crank, outer rings one with case and cover) and each rod on
    the crank's pin, and each rod on its piston's pin, revolute along z; each piston in its cylinder cylindrical.
    Caps and bolts are one with their rod; piston pin, rings and circlips with the piston; cylinders, heads, their
    screws and the cover with the case; flywheel, key and nut with the crank. One freedom.
    """
    throw, long, radius = random.uniform(26, 31), random.uniform(108, 116), 30.0
    turn = random.uniform(0, 2 * np.pi)
    play, small = float(random.choice([0.05, 0.1])), float(random.choice([0, 0.02]))
    drawing = Drawing(fixed=["Carcasa"])
    pin = throw * at(np.cos(turn), np.sin(turn), 0)
    ways = [at(side * np.sqrt(0.5), np.sqrt(0.5), 0) for side in (-1, 1)]
    blocks = [laid(box((0, -44, -46), (82, 44, 46)), (0, 0, 0), way, Z) for way in ways]
    case = union(cyl((0, 0, -56), Z, 72, 102), *blocks, box((-80, -90, -56), (80, -60, 46)))
    wells = [cyl(40 * way + offset * Z, way, 33.5, 60) for way, offset in zip(ways, (-8, 8), strict=True)]
    case = cut(case, cyl((0, 0, -46), Z, 62, 92), *wells, bore((0, 0, -50), Z, 31, 9))
    drawing.add("Carcasa", case)
    cover = cut(cyl((0, 0, 46), Z, 72, 10).edges(">Z").fillet(2), bore((0, 0, 50), Z, 31, 9))
    drawing.add("Tapa carcasa", cover)
    counter = [laid(box((-48, -26, 16), (-15, 26, 28)), (0, 0, 0), pin, Z)]
    counter += [each.mirror("XY") for each in counter]
    crank = union(
        cyl(pin - 17 * Z, Z, 14, 34),
        *(laid(box((-20, -19, low), (throw, 19, low + 12)), (0, 0, 0), pin, Z) for low in (-28, 16)),
        *(cyl(pin + low * Z, Z, 19, 12) for low in (-28, 16)),
        *counter,
        cyl((0, 0, -64), Z, 15, 40),
        cyl((0, 0, 24), Z, 15, 38),
        cyl((0, 0, 62), Z, 12, 40),
    )
    key = box((-3, 9, 66), (3, 15, 82))
    drawing.add("Ciguenal", crank.cut(key))
    drawing.add("Chaveta 6x6", key)
    wheel = union(tube((0, 0, 64), Z, 12, 22, 20), tube((0, 0, 64), Z, 20, 68, 8), tube((0, 0, 64), Z, 58, 75, 20))
    drawing.add("Volante", wheel.cut(key))
    drawing.add("Tuerca M24", nut((0, 0, 84), Z, 12).intersect(cyl((0, 0, 84), Z, 30, 14)))
    weld(drawing, "Carcasa", "Tapa carcasa")
    weld(drawing, "Ciguenal", "Chaveta 6x6", "Volante", "Tuerca M24")
    for number, (low, holder) in enumerate(((-56, "Carcasa"), (46, "Tapa carcasa")), 1):
        inner, outer = rings((0, 0, low), Z, 15, 31, 10)
        drawing.add(f"Rodamiento 6206 interior-{number}", inner)
        drawing.add(f"Rodamiento 6206 exterior-{number}", outer)
        weld(drawing, holder, f"Rodamiento 6206 exterior-{number}")
        weld(drawing, "Ciguenal", f"Rodamiento 6206 interior-{number}")
        names = (f"Rodamiento 6206 exterior-{number}", f"Rodamiento 6206 interior-{number}")
        drawing.joint("Revolute", *names, (0, 0, low), Z)
    for number, (way, offset) in enumerate(zip(ways, (-8, 8), strict=True), 1):
        centre = pin + offset * Z
        along = float(pin @ way)
        up = along + np.sqrt(long**2 - throw**2 + along**2)
        wrist = up * way + offset * Z
        # the cylinder, in its own coordinates: z along it, x along the crank
        fins = [cyl((0, 0, low), Z, 43, 3) for low in range(92, 168, 8)]
        barrel = union(
            cyl((0, 0, 62), Z, 33.5, 110), box((-44, -44, 82), (44, 44, 88)), cyl((0, 0, 82), Z, 36, 94), *fins
        )
        barrel = barrel.union(cyl((0, 0, 166), Z, 43, 10))
        head = union(
            cyl((0, 0, 176), Z, 43, 24), *(box((-44, low, 200), (44, low + 4, 214)) for low in (-38, -20, -2, 16, 34))
        )
        head = head.cut(sphere((0, 0, 150), 36))
        spots = [at(a * 27, b * 27, 0) for a in (-1, 1) for b in (-1, 1)]
        place = (offset * Z, Z, way)
        drawing.add(
            f"Cilindro-{number}",
            laid(cut(barrel, bore((0, 0, 100), Z, radius, 99), *(cyl(s + 160 * Z, Z, 3.5, 17) for s in spots)), *place),
        )
        drawing.add(f"Culata-{number}", laid(cut(head, *(bore(s + 190 * Z, Z, 4, 40) for s in spots)), *place))
        weld(drawing, "Carcasa", f"Cilindro-{number}")
        weld(drawing, f"Cilindro-{number}", f"Culata-{number}")
        for count, s in enumerate(spots, 4 * number - 3):
            drawing.add(f"Tornillo M7-{count}", laid(capscrew(s + 200 * Z, -Z, 3.5, 36), *place))
            weld(drawing, f"Culata-{number}", f"Tornillo M7-{count}")
        # the rod, in its own coordinates: x from the crank's pin to the piston's
        whole = union(
            cyl((0, 0, -6.5), Z, 20, 13),
            box((-12, -26, -6.5), (12, 26, 6.5)),
            box((15, -8, -4), (long - 8, 8, 4)),
            cyl((long, 0, -6.5), Z, 13, 13),
        )
        whole = cut(whole, bore((0, 0, 0), Z, 14 + small, 20), bore((long, 0, 0), Z, 8 + small, 20))
        whole = cut(whole, *(cyl((-20, y, 0), X, 3, 30) for y in (-22.5, 22.5)))
        lie = (centre, wrist - centre, Z)
        drawing.add(f"Biela-{number}", laid(whole.intersect(box((0, -60, -20), (200, 60, 20))), *lie))
        drawing.add(f"Tapa biela-{number}", laid(whole.intersect(box((0, -60, -20), (-200, 60, 20))), *lie))
        weld(drawing, f"Biela-{number}", f"Tapa biela-{number}")
        for count, y in enumerate((-22.5, 22.5), 2 * number - 1):
            drawing.add(
                f"Perno biela-{count}", laid(cyl((-12, y, 0), X, 3, 22).union(hexagon((-15, y, 0), X, 4, 3)), *lie)
            )
            weld(drawing, f"Tapa biela-{number}", f"Perno biela-{count}")
        # the piston, in the cylinder's coordinates about its pin
        piston = cyl((0, 0, -24), Z, radius - play, 48).cut(cyl((0, 0, -24), Z, 25, 38.5))
        bosses = cyl((-29, 0, 0), X, 13, 58).intersect(cyl((0, 0, -30), Z, radius - play, 60))
        piston = piston.union(bosses.cut(box((-8, -20, -20), (8, 20, 20))))
        grooves = [tube((0, 0, low), Z, 27.5, 31, 2) for low in (12, 18)]
        clips = [tube((low, 0, 0), X, 6.5, 8.6, 1.2) for low in (-26.2, 25)]
        spare = [cyl((low, 0, 0), X, 8.6, 1.2) for low in (-26.2, 25)]
        piston = cut(piston, bore((0, 0, 0), X, 8, 40), *grooves, *spare)
        place = (wrist, Z, way)
        drawing.add(f"Piston-{number}", laid(piston, *place))
        drawing.add(f"Bulon-{number}", laid(tube((-25, 0, 0), X, 5, 8, 50), *place))
        weld(drawing, f"Piston-{number}", f"Bulon-{number}")
        for count in (1, 2):
            drawing.add(f"Seeger {number}.{count}", laid(clips[count - 1], *place))
            ring = tube((0, 0, (12, 18)[count - 1]), Z, 27.7, radius, 1.9).cut(box((-0.4, 0, 0), (0.4, 40, 40)))
            drawing.add(f"Segmento {number}.{count}", laid(ring, *place))
            weld(drawing, f"Piston-{number}", f"Seeger {number}.{count}", f"Segmento {number}.{count}")
        drawing.joint("Revolute", "Ciguenal", f"Biela-{number}", centre, Z)
        drawing.joint("Revolute", f"Biela-{number}", f"Bulon-{number}", wrist, Z)
        drawing.joint("Cylindrical", f"Piston-{number}", f"Cilindro-{number}", wrist, way)
    return drawing


def _ball(point, axis, hole: float = 5.0, tall: float = 9.0) -> Shape:
    """The inner ball of a spherical bearing."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    return sphere(point, 12).intersect(cyl(point - tall * unit, unit, 20, 2 * tall)).cut(bore(point, unit, hole, 20))


def _ears(
    point, axis, toward, reach: float, half: float = 12.0, near: float = 9.0, thick: float = 7.0
) -> tuple[Shape, Shape]:
    """Two ears across an axis at a point, and on toward something, whole."""
    point, axis = np.asarray(point, float), np.asarray(axis, float) / np.linalg.norm(axis)
    toward = np.asarray(toward, float) - (np.asarray(toward, float) @ axis) * axis
    shapes = []
    for low in (near, -near - thick):
        tongue = box((0, -half, low), (reach, half, low + thick)).union(cyl((0, 0, low), Z, half, thick))
        shapes.append(laid(tongue, point, toward, axis))
    return shapes[0], shapes[1]


@kind
def formula_student_corner(random: np.random.Generator) -> Drawing:
    """A front corner: two wishbones, upright, pushrod to a rocker and damper across, tie rod from a square rack.

    Truth: wishbones on their brackets revolute along their inner axes; upright on both, tie rod to upright and to
    rack, pushrod to lower wishbone and to rocker spherical (a ball is one with its bolt and what the bolt is through);
    hub in the upright, rocker on its mount, damper to rocker and to its mount revolute; rod in damper cylindrical; rack
    in its housing prismatic (across). Bolts are one with brackets, upright, rack, lower wishbone, rocker. Bump, steer,
    wheel: three freedoms, and the spins of tie rod and pushrod.
    """
    jog = lambda *numbers: at(*numbers) + random.uniform(-6, 6, 3)  # noqa: E731
    lower_out, upper_out = jog(0, 545, -86), jog(-10, 534, 84)
    tie_out, tie_in = jog(-78, 540, -40), at(-70, 240, -52)
    tilt = np.radians(random.uniform(-3, 3, 2))
    low_mid, high_mid = at(-10, 232, -92), at(-10, 252, 62)
    push_out, rocker_at = at(0, 492, -58), at(0, 236, 196)
    push_in, shock_in, shock_out = (
        rocker_at + jog(0, 56, -12) * at(0, 1, 1),
        rocker_at + jog(0, -14, 58) * at(0, 1, 1),
        at(0, 30, 236),
    )
    drawing = Drawing(fixed=["Monocoque_Simplified"])
    tub = (
        box((-190, 0, -130), (170, 200, 120))
        .edges("|Y")
        .fillet(25)
        .cut(box((-178, -1, -118), (158, 188, 108)).edges("|Y").fillet(15))
    )
    drawing.add("Monocoque_Simplified", cut(tub, bore((-70, 200, -52), Y, 18, 20)))
    for name, middle, lean, out, spread, balls in (
        ("Lower", low_mid, tilt[0], lower_out, 125, True),
        ("Upper", high_mid, tilt[1], upper_out, 108, False),
    ):
        axis = at(np.cos(lean), 0, np.sin(lean))
        ends = [middle + side * spread * axis for side in (1, -1)]
        arm = union(
            *(strut(end, out, 7) for end in ends), *(eye(end, axis, 6, 13, 30) for end in ends), eye(out, Z, 5, 17, 13)
        )
        if balls:
            tabs = _ears(push_out, X, at(0, 0.2, -1), 32, 11, 9, 6)
            cross = box((-40, push_out[1] - 14, push_out[2] - 38), (40, push_out[1] + 10, push_out[2] - 20))
            cross = cross.intersect(box((-24, 0, -200), (24, 800, 200)))
            arm = cut(union(arm, *tabs, cross), bore(push_out, X, 5, 40))
        arm = cut(arm, *(bore(end, axis, 6.1, 30) for end in ends), sphere(out, 12), bore(out, Z, 10.5, 10))
        drawing.add(f"{name}_A-Arm", arm)
        for end, letter in zip(ends, "FR", strict=True):
            foot = laid(box((-26, -18, 0), (26, 18, 6)), (end[0], 200, end[2]), axis, Y)
            ears = _ears(end, axis, -Y, end[1] - 203, 13, 15.5, 6)
            bracket = f"{name}_Bracket_{letter}"
            drawing.add(bracket, cut(union(foot, *ears), bore(end, axis, 6, 30)))
            drawing.add(f"M12_Bolt_{name}_{letter}", bolt(end - 21.5 * axis, axis, 6, 56))
            drawing.add(f"M12_Nut_{name}_{letter}", nut(end + 21.5 * axis, axis, 6))
            weld(drawing, "Monocoque_Simplified", bracket)
            weld(drawing, bracket, f"M12_Bolt_{name}_{letter}")
            weld(drawing, f"M12_Bolt_{name}_{letter}", f"M12_Nut_{name}_{letter}")
        drawing.joint("Revolute", f"{name}_A-Arm", f"{name}_Bracket_F", ends[0], axis)
    upright = union(box((-22, 574, -112), (22, 592, 112)), cyl((0, 574, 0), Y, 46, 18))
    for p in (lower_out, upper_out):
        upright = union(upright, *_ears(p, Z, Y, 585 - p[1], 13))
    reach = np.linalg.norm((at(0, 583, 0) - tie_out)[:2])
    upright = union(
        upright, *_ears(tie_out, Z, at(0, 583, 0) - tie_out, reach, 11), box((-20, 574, -60), (20, 592, -20))
    )
    upright = cut(upright, *(bore(p, Z, 5, 30) for p in (lower_out, upper_out, tie_out)), bore((0, 583, 0), Y, 36, 20))
    upright = cut(upright, *(cyl(p - 9 * Z, Z, 20, 18) for p in (lower_out, upper_out, tie_out)))
    inner, outer = tube((0, 574, 0), Y, 20, 27.5, 18), tube((0, 574, 0), Y, 28, 36, 18)
    hub = union(
        cyl((0, 566, 0), Y, 20, 54), cyl((0, 594, 0), Y, 27, 8), cyl((0, 614, 0), Y, 60, 9), cyl((0, 620, 0), Y, 16, 44)
    )
    drawing.add("Upright_FL", upright)
    drawing.add("Bearing_outer_ring", outer)
    drawing.add("Bearing_inner_ring", inner)
    drawing.add("Hub", hub)
    drawing.add("Brake_disc", tube((0, 609, 0), Y, 40, 105, 5))
    rim = union(tube((0, 510, 0), Y, 152, 165, 170), tube((0, 623, 0), Y, 16, 155, 8))
    spokes = [bore((95 * np.cos(a), 630, 95 * np.sin(a)), Y, 26, 40) for a in np.arange(5) * 2 * np.pi / 5]
    drawing.add("Wheel_rim_13in", cut(rim, *spokes))
    drawing.add("Tyre_Hoosier", tube((0, 510, 0), Y, 165, 232, 170))
    drawing.add("Centre_lock_nut", nut((0, 631, 0), Y, 16))
    caliper = (
        box((-135, 600, -26), (-72, 623, 26))
        .cut(box((-110, 607, -40), (-60, 616, 40)))
        .union(box((-135, 580, -20), (-112, 602, 20)))
    )
    caliper = union(caliper, box((-135, 576, -20), (-40, 592, 20)).cut(cyl((0, 570, 0), Y, 46, 40)))
    drawing.add("Brake_caliper", caliper)
    weld(drawing, "Upright_FL", "Bearing_outer_ring", "Brake_caliper")
    weld(drawing, "Hub", "Bearing_inner_ring", "Brake_disc", "Wheel_rim_13in", "Centre_lock_nut")
    weld(drawing, "Wheel_rim_13in", "Tyre_Hoosier")
    drawing.joint("Revolute", "Bearing_outer_ring", "Bearing_inner_ring", (0, 583, 0), Y)
    housing = box((-86, 40, -68), (-54, 180, -36)).union(box((-100, 50, -118), (-40, 170, -66)))
    drawing.add("Rack_housing", housing.cut(box((-80.1, 0, -62.1), (-59.9, 300, -41.9))))
    ears = _ears(tie_in, Z, -Y, 24, 10, 9, 5)
    rack = union(
        box((-80, 20, -62), (-60, 212, -42)).edges("|Y").chamfer(1.5), box((-80, 208, -66), (-60, 219, -38)), *ears
    )
    drawing.add("Steering_rack", cut(rack, bore(tie_in, Z, 5, 30)))
    weld(drawing, "Monocoque_Simplified", "Rack_housing")
    drawing.joint("Prismatic", "Rack_housing", "Steering_rack", (-70, 100, -52), Y)
    # rods with an eye and a ball at both ends, and the wishbones' own balls
    for name, one, other, axis in (("Tie_rod", tie_in, tie_out, Z), ("Pushrod", push_out, push_in, X)):
        whole = union(strut(one, other, 8), eye(one, axis, 5, 16, 12), eye(other, axis, 5, 16, 12))
        drawing.add(
            name, cut(whole, sphere(one, 12), sphere(other, 12), bore(one, axis, 10.5, 8), bore(other, axis, 10.5, 8))
        )
    for number, (p, axis, holder, rod, ear) in enumerate(
        (
            (lower_out, Z, "Upright_FL", "Lower_A-Arm", 7),
            (upper_out, Z, "Upright_FL", "Upper_A-Arm", 7),
            (tie_out, Z, "Upright_FL", "Tie_rod", 7),
            (tie_in, Z, "Steering_rack", "Tie_rod", 5),
            (push_out, X, "Lower_A-Arm", "Pushrod", 6),
            (push_in, X, "Rocker", "Pushrod", 5),
        ),
        1,
    ):
        drawing.add(f"COM-10 ball-{number}", _ball(p, axis))
        drawing.add(f"M10x45-{number}", bolt(p + (9 + ear) * axis, -axis, 5, 2 * (9 + ear) + 10))
        weld(drawing, holder, f"M10x45-{number}")
        weld(drawing, f"M10x45-{number}", f"COM-10 ball-{number}")
        drawing.joint("Spherical", rod, f"COM-10 ball-{number}", p)
    flat = [p[1:] for p in (rocker_at, push_in, shock_in)]
    sides = []
    for low in (9, -14):
        sides += [laid(plate(flat, low, low + 5, 11), (0, 0, 0), Y, X)]
    rocker = cut(
        union(*sides, cyl(rocker_at - 14 * X, X, 15, 28)),
        bore(rocker_at, X, 8.05, 30),
        *(bore(p, X, 5, 30) for p in (push_in, shock_in)),
    )
    drawing.add("Rocker", rocker)
    mount = union(*_ears(rocker_at, X, at(0, -1, -2), 78, 14, 15, 8), box((-40, 165, 120), (40, 200, 128)))
    mount = mount.intersect(box((-99, 0, 120), (99, 400, 400)))
    drawing.add("Rocker_mount", cut(mount, bore(rocker_at, X, 8, 40)))
    drawing.add("M16_Rocker_bolt", bolt(rocker_at - 23 * X, X, 8, 60))
    mount = union(*_ears(shock_out, X, -Z, 112, 12, 18.5, 7), box((-30, 10, 120), (30, 55, 128)))
    drawing.add("Damper_mount", cut(mount, bore(shock_out, X, 5, 40)))
    drawing.add("M10_Damper_bolt", bolt(shock_out - 25.5 * X, X, 5, 60))
    drawing.add("M10_Rocker_damper_bolt", bolt(shock_in - 14 * X, X, 5, 38))
    body, rod = ram(shock_out, shock_in, X, 14, 6, 5, 17.5, 110, 5, 36)
    drawing.add("Damper_body", body)
    drawing.add("Damper_shaft", rod)
    weld(drawing, "Monocoque_Simplified", "Rocker_mount", "Damper_mount")
    weld(drawing, "Rocker_mount", "M16_Rocker_bolt")
    weld(drawing, "Damper_mount", "M10_Damper_bolt")
    weld(drawing, "Rocker", "M10_Rocker_damper_bolt")
    drawing.joint("Revolute", "M16_Rocker_bolt", "Rocker", rocker_at, X)
    drawing.joint("Revolute", "M10_Damper_bolt", "Damper_body", shock_out, X)
    drawing.joint("Revolute", "M10_Rocker_damper_bolt", "Damper_shaft", shock_in, X)
    drawing.joint("Cylindrical", "Damper_body", "Damper_shaft", shock_out, shock_in - shock_out)
    return drawing
