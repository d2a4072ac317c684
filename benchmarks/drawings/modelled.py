"""A camera's gimbal and an aileron's drive, of makers who leave out pins, shafts and what else does not show."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.catalogued import capscrew, upright, upright_at, weld
from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, laid, tube, union


def _brushless(origin, x, z, shaft: bool) -> tuple[Shape, Shape]:
    """A gimbal motor below its top face at the origin: stator on its foot, and bell."""
    stator = union(cyl((0, 0, -22), Z, 23, 4).edges("%CIRCLE").chamfer(0.8), cyl((0, 0, -18), Z, 16.5, 14.5))
    slots = [box((9, -1.2, -17), (17, 1.2, 0)).rotate((0, 0, 0), (0, 0, 1), 30.0 * n) for n in range(12)]
    stator = cut(stator, bore((0, 0, -10), Z, 4 if not shaft else 2.5, 20), *slots)
    bell = union(tube((0, 0, -17), Z, 18.5, 23, 17), cyl((0, 0, -2.5), Z, 23, 2.5))
    bell = bell.union(cyl((0, 0, -21), Z, 2.5, 20)) if shaft else bell
    return laid(stator, origin, x, z), laid(
        cut(bell, *(bore((a * 8, 0, -1), Z, 1.5, 4) for a in (-1, 1))), origin, x, z
    )


@kind
def handheld_gimbal(random: np.random.Generator) -> Drawing:
    """A three-axis gimbal held in the hand, its motors as stator and bell, with a shaft or with only an air gap.

    Truth: each bell on its stator revolute: yaw along the handle, then roll, then pitch. Stator 1 is one with the
    handle, yaw arm with bell 1 and stator 2, roll arm with bell 2 and stator 3, camera, its plate, lens and sensor with
    bell 3; screws are one with the arm or plate that they hold. Three freedoms.
    """
    yaw, roll, pitch = np.radians(random.uniform((-50, -15, -25), (50, 15, 25)))
    high, shaft = random.uniform(58, 66), bool(random.integers(2))
    drawing = Drawing(fixed=["Handle"])
    grip = cyl((0, 0, -150), Z, 17, 128).edges("%CIRCLE and <Z").fillet(5).cut(cyl((0, 0, -140), Z, 13, 105))
    drawing.add("Handle", union(grip, cyl((0, 0, -28), Z, 24, 6)))
    drawing.add("Trigger", cyl((15, 0, -60), X, 5, 5).edges(">X").fillet(1).cut(cyl((0, 0, -150), Z, 17, 128)))
    one = at(np.cos(yaw), np.sin(yaw), 0)
    side = np.cross(Z, one)
    up = np.cos(roll) * Z - np.sin(roll) * side
    across = np.cross(up, one)
    middle = high * Z
    fore = np.cos(pitch) * one - np.sin(pitch) * up
    frames = ((at(0, 0, 0), one, Z), (middle - 38 * one, up, one), (middle + 26 * across, fore, -across))
    for number, frame in enumerate(frames, 1):
        stator, bell = _brushless(*frame, shaft)
        drawing.add(f"GM4108 Stator<{number}>", stator)
        drawing.add(f"GM4108 Bell<{number}>", bell)
        drawing.joint("Revolute", f"GM4108 Stator<{number}>", f"GM4108 Bell<{number}>", frame[0], frame[2])
    arm = union(box((-64, -14, 0), (0, 14, 4)), cyl((0, 0, 0), Z, 18, 4), box((-64, -14, 0), (-60, 14, high)))
    arm = union(arm, cyl((-64, 0, high), X, 23, 4)).edges("|Y").edges("<X and <Z").fillet(3)
    drawing.add("Yaw Arm", laid(cut(arm, *(bore((a * 8, 0, 2), Z, 1.5, 9) for a in (-1, 1))), *frames[0]))
    # roll arm: x forward, y across, z up, about the middle of the camera
    arm = union(cyl((-38, 0, 0), X, 18, 4), box((-38, 0, -13), (-34, 52, 13)), box((-38, 48, -13), (0, 52, 13)))
    arm = union(arm, cyl((0, 48, 0), Y, 23, 4))
    drawing.add("Roll Arm", laid(cut(arm, *(bore((-36, 0, a * 8), X, 1.5, 9) for a in (-1, 1))), middle, one, up))
    top = np.cross(fore, across)
    plate = (
        union(box((-20, 22, -18), (20, 26, 18)), box((-20, -18, -22), (20, 26, -18)))
        .edges("|X")
        .edges(">Y and <Z")
        .fillet(2)
    )
    plate = cut(plate, *(bore((a * 8, 24, 0), Y, 1.5, 3) for a in (-1, 1)))
    drawing.add("Camera Plate", laid(plate, middle, fore, top))
    drawing.add("GoPro", laid(box((-16, -30, -18), (17, 21, 18)).edges("|X").fillet(4), middle, fore, top))
    drawing.add("Lens", laid(cyl((17, -12, 4), X, 11, 7).edges(">X").chamfer(1), middle, fore, top))
    drawing.add("IMU board", laid(box((-9, -8, -25), (9, 8, -22)), middle, fore, top))
    for number, (frame, thick, owner) in enumerate(
        zip(frames, (4, 4, 4), ("Yaw Arm", "Roll Arm", "Camera Plate"), strict=True), 1
    ):
        origin, x, z = frame
        for a in (-1, 1) if number < 3 else ():
            name = f"M3x6<{2 * number + (a + 1) // 2}>"
            drawing.add(name, capscrew(origin + a * 8 * x + thick * z, -z, 1.5, 6))
            weld(drawing, owner, name)
    weld(drawing, "Handle", "Trigger", "GM4108 Stator<1>")
    weld(drawing, "Yaw Arm", "GM4108 Bell<1>", "GM4108 Stator<2>")
    weld(drawing, "Roll Arm", "GM4108 Bell<2>", "GM4108 Stator<3>")
    weld(drawing, "Camera Plate", "GM4108 Bell<3>", "GoPro", "IMU board")
    weld(drawing, "GoPro", "Lens")
    return drawing


def _clevis(point, way) -> Shape:
    """A fork without its pin: its hole at a point of the plane xz, about y = 0, its shank on the way."""
    turn = at(way[0], 0, way[1])
    prongs = [upright([(0, 0), (12, 0)], *sorted((s * 1.0, s * 2.5)), 2.2) for s in (-1, 1)]
    fork = union(*prongs, box((9, -2.5, -2.2), (14, 2.5, 2.2)), cyl((13, 0, 0), X, 2, 8))
    fork = cut(fork, bore((0, 0, 0), Y, 0.8, 9), cyl((11, 0, 0), X, 1, 20))
    return laid(fork, upright_at(point, 0), turn, np.cross(turn, Y))


@kind
def aileron_drive(random: np.random.Generator) -> Drawing:
    """An aileron of a model aircraft with its servo, arm, pushrod and horn: holes everywhere, and no pin in any.

    Truth, along y: aileron on the two hinge tabs of the wing, arm on the servo's shaft, one clevis on the arm and the
    other on the control horn: revolute. Servo, its screws and tabs are one with the wing, both
    clevises with the wire, the horn with the aileron. One freedom.
    """
    bend, turn = np.radians(random.uniform((-18, -25), (18, 25)))
    span, chord = random.uniform(320, 420), random.uniform(70, 100)
    station, gap = 0.48 * span, float(random.choice([0, 0.3, 0.6]))
    hinge, shaft = at(8, 0), at(-80, -8)
    drawing = Drawing(fixed=["wing_section"])

    def bent(x: float, z: float) -> np.ndarray:
        return hinge + at(np.cos(bend) * x - np.sin(bend) * z, np.sin(bend) * x + np.cos(bend) * z)

    wing = cq.Workplane("XZ").polyline([(-150, -17), (-150, 17), (-2, 9.5), (-2, -9.5)]).close().extrude(-span)
    pocket = box((-104, station - 10.1, -40), (-66, station + 8, 3)).union(
        box((-97.1, station - 29, -40), (-73.9, station, -1.9))
    )
    tabs = [0.15 * span, 0.85 * span]
    slots = [box((-14, y - 1.5, -3), (0, y + 1.5, 3)) for y in tabs]
    drawing.add("wing_section", cut(wing, pocket, *slots))
    nose = cyl((8, 6, 0), Y, 8.5, span - 12)
    skin = (
        cq.Workplane("XZ", origin=(0, 6, 0))
        .polyline([(8, -8.5), (8, 8.5), (8 + chord, 0.6), (8 + chord, -0.6)])
        .close()
        .extrude(-span + 12)
    )
    skin = cut(union(nose, skin), *(box((-5, y - 1.5 - gap, -30), (20, y + 1.5 + gap, 30)) for y in tabs))
    skin = cut(skin, *(bore((8, y, 0), Y, 1, 12) for y in tabs))
    drawing.add("aileron", skin.rotate((8, 0, 0), (8, 1, 0), -np.degrees(bend)))
    for number, y in enumerate(tabs, 1):
        tab = union(box((-14, y - 1.5, -3), (8, y + 1.5, 3)), cyl((8, y - 1.5, 0), Y, 3, 3))
        drawing.add(f"hinge_tab_{number}", cut(tab, bore((8, y, 0), Y, 1, 9)))
        weld(drawing, "wing_section", f"hinge_tab_{number}")
    tip = shaft + 18 * at(np.sin(turn), -np.cos(turn))
    end = bent(3, -27)
    case = union(
        box((-5.9, -5.9, -22), (16.9, 5.9, 0)),
        box((-10.6, -5.9, -6.5), (21.7, 5.9, -4)),
        cyl((0, 0, 0), Z, 5.5, 1),
        cyl((0, 0, 0), Z, 2.3, 3.6),
    )
    case = cut(case, *(bore((along, 0, -5), Z, 1.1, 3) for along in (-8.2, 19.3)))
    for number, along in enumerate((-8.2, 19.3), 1):  # into wood that nobody drilled
        seat = at(shaft[0] - along, station - 7.6, shaft[1])
        drawing.add(f"servo_screw_{number}", capscrew(seat, -Y, 0.9, 8))
        weld(drawing, "SG90", f"servo_screw_{number}")
    drawing.add("SG90", laid(case, upright_at(shaft, station - 3.6), -X, Y))
    arm = union(upright([shaft, tip], -0.75, 0.75, 2.5), cyl(upright_at(shaft, -2.2), Y, 3.6, 3.6))
    holes = [bore(upright_at(shaft + far * (tip - shaft), 0), Y, 0.8, 9) for far in (0.5, 0.75, 1)]
    drawing.add("servo_arm", cut(arm, cyl(upright_at(shaft, -4), Y, 2.3, 4), *holes).translate((0, station, 0)))
    way = (end - tip) / np.linalg.norm(end - tip)
    for name, shape in (
        ("clevis_servo", _clevis(tip, way)),
        ("clevis_horn", _clevis(end, -way)),
        ("pushrod_wire", cyl(upright_at(tip + 14 * way, 0), upright_at(way, 0), 1, np.linalg.norm(end - tip) - 28)),
    ):
        drawing.add(name, shape.translate((0, station, 0)))
    slope = 7.9 / chord
    below = ((0, 0, -8.5), at(1, 0, slope), at(-slope, 0, 1))
    horn = union(
        upright([(3, -27), (2, -9), (11, -8.5)], -0.75, 0.75, 2.2), laid(box((0.5, -7, -1.5), (15, 7, 0)), *below)
    )
    horn = cut(horn, *(bore((3 + a * 0.8, 0, -27 + b * 1), Y, 0.8, 9) for a, b in ((0, 0), (-1.3, 4.5), (-2.4, 9))))
    horn = horn.cut(laid(box((-30, -20, 0), (chord, 20, 20)), *below))
    horn = laid(horn, upright_at(hinge, station), upright_at(bent(1, 0) - hinge, 0), upright_at(bent(0, 1) - hinge, 0))
    drawing.add("control_horn", horn)
    weld(drawing, "wing_section", "SG90")
    weld(drawing, "pushrod_wire", "clevis_servo", "clevis_horn")
    weld(drawing, "aileron", "control_horn")
    drawing.joint("Revolute", "hinge_tab_1", "aileron", upright_at(hinge, tabs[0]), Y)
    drawing.joint("Revolute", "SG90", "servo_arm", upright_at(shaft, station), Y)
    drawing.joint("Revolute", "servo_arm", "clevis_servo", upright_at(tip, station), Y)
    drawing.joint("Revolute", "control_horn", "clevis_horn", upright_at(end, station), Y)
    return drawing
