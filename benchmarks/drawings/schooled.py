"""What students print and cut: an arm of servos, a gripper with gears, a walking machine of laser-cut links."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.catalogued import bolt, capscrew, nut, plate, servo, servo_horn, washer, weld
from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, Y, Z, at, bore, box, cut, cyl, laid, meet, tube, union


def _toward(angle: float) -> np.ndarray:
    return at(np.cos(angle), 0, np.sin(angle))


@kind
def servo_bracket_arm(random: np.random.Generator) -> Drawing:
    """Five servos in sheet-metal brackets, each horn turning the next bracket, an idle bearing on its other side.

    Truth: each horn turns on the shaft of its servo (revolute) at the waist (vertical), shoulder, elbow, wrist (all
    along y) and hand (along the hand). Servo 1 is one with the base; a bracket is one with the horn below it, with the
    bearing on its other side, with the servo that it holds, and with the screws and nuts of that. Five freedoms.
    """
    upper, fore, lift = random.uniform(98, 120), random.uniform(95, 110), random.uniform(58, 66)
    shoulder, elbow, wrist = np.radians(random.uniform((50, -30, -60), (100, 20, -20)))
    yaw = random.uniform(-60, 60)
    drawing = Drawing(fixed=["BASE"])
    deck = box((-45, -45, -14), (45, 45, -11)).cut(box((-10.4, -10.2, -20), (30.7, 10.2, 0)))
    base = union(deck, *(box((a * 45, b * 45, -45), (a * 38, b * 38, -14)) for a in (-1, 1) for b in (-1, 1)))
    base = base.union(box((-60, -60, -48), (60, 60, -45)).edges("|Z").fillet(8))
    drawing.add("BASE", base.rotate((0, 0, 0), (0, 0, 1), yaw))
    tab = (-13.8, 34.1)

    def driven(number: int, place, x, z, bracket: Shape, name: str, holder: str) -> None:
        drawing.add(f"MG996R-{number}", servo(place, x, z))
        drawing.add(f"Servo Horn-{number}", servo_horn(place, x, z))
        drawing.add(name, bracket)
        weld(drawing, holder, f"MG996R-{number}")
        drawing.joint("Revolute", f"MG996R-{number}", f"Servo Horn-{number}", place, z)
        weld(drawing, name, f"Servo Horn-{number}")
        for side, (along, across) in enumerate(zip(tab, (-5, 5), strict=True), 1) if 1 < number < 5 else ():
            spot = place + along * x + across * np.cross(z, x)
            drawing.add(f"M3x8 SHCS-{2 * number + side}", capscrew(spot - 8.5 * z, -z, 1.5, 8))
            drawing.add(f"M3 Hex Nut-{2 * number + side}", nut(spot - 14 * z, -z, 1.5))
            weld(drawing, holder, f"M3x8 SHCS-{2 * number + side}")
            weld(drawing, f"M3x8 SHCS-{2 * number + side}", f"M3 Hex Nut-{2 * number + side}")

    # a plate under the tabs of a servo, in the coordinates of the servo, and an idle pin behind its case
    seat = box((-20, -16, -14), (42, 16, -11)).cut(box((-10.4, -10.2, -20), (30.7, 10.2, 0)))
    seat = cut(seat, *(bore((along, across, -12), Z, 1.6, 5) for along in tab for across in (-5, 5)))
    pin = union(cyl((0, 0, -41), Z, 11, 3), cyl((0, 0, -47), Z, 4, 6.5))
    back = at(0, 0, -1)
    first = at(0, 18, lift)
    waist = union(
        box((-18, -24, 4), (18, 18, 7)).edges("|Z").fillet(5),
        laid(union(seat, pin), first, back, Y),
        box((-11, -23, 4), (11, -20, lift)),
        box((-16, 4, 4), (16, 7, lift - 40)),
    )
    driven(1, at(0, 0, 0), _rotated(yaw), Z, cut(waist, bore((0, 0, 5), Z, 4.55, 6)), "Waist bracket", "BASE")

    def arm(start, angle: float, length: float) -> Shape:
        """A bracket astride a servo, with a web, and a seat for the next servo."""
        flat = [
            box((-14, low, -14), (48 if length else 54, high, 14)).edges("|Y and <X").fillet(12)
            for low, high in ((4, 6), (-45, -42))
        ]
        if length:
            flat += [box((46, -45, -14), (48, 6, 14)), box((46, -14, -16), (length - 40, -11, 16))]
            flat += [laid(union(seat, pin), at(length, 0, 0), at(-1, 0, 0), Y), box((46, -41, -9), (length, -38, 9))]
        else:
            flat += [box((51, -49, -14), (54, 10, 14)).cut(box((50, -40.1, -10.2), (56, 1, 10.2)))]
        shape = cut(union(*flat), bore((0, 5, 0), Y, 4.55, 3), bore((0, -43, 0), Y, 6, 3))
        return laid(shape, start, _toward(angle), np.cross(_toward(angle), Y))

    second = first + upper * _toward(shoulder)
    third = second + fore * _toward(elbow)
    out = _toward(wrist)
    driven(2, first, back, Y, arm(first, shoulder, upper), "Upper arm bracket", "Waist bracket")
    driven(3, second, -_toward(shoulder), Y, arm(second, elbow, fore), "Forearm bracket", "Upper arm bracket")
    driven(4, third, -_toward(elbow), Y, arm(third, wrist, 0), "Wrist U bracket", "Forearm bracket")
    for number, (place, name) in enumerate(
        ((first, "Upper arm bracket"), (second, "Forearm bracket"), (third, "Wrist U bracket")), 1
    ):
        drawing.add(f"Bearing 8x12x3.5-{number}", tube(place + at(0, -45, 0), Y, 4, 6, 3.5))
        weld(drawing, name, f"Bearing 8x12x3.5-{number}")
    last = third + 65 * out - at(0, 9.4, 0)
    hand = union(plate([(-25, -16), (25, -16), (12, 16), (-12, 16)], 4, 8, 6))
    hand = union(hand, box((-28, -5, 8), (-22, 5, 50)), box((22, -5, 8), (28, 5, 50)))
    hand = laid(cut(hand, bore((0, 0, 5), Z, 4.6, 6)), last, np.cross(Y, out), out)
    driven(5, last, -Y, out, hand, "Fixed claw", "Wrist U bracket")
    return drawing


def _rotated(degrees: float) -> np.ndarray:
    return at(np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0)


def _gear(teeth: int, pitch: float, turn: float, low: float, high: float) -> Shape:
    """A spur gear with straight flanks and some backlash."""
    module, points = 2 * pitch / teeth, []
    for number in range(teeth):
        middle = turn + 2 * np.pi * number / teeth
        for out, wide in ((-1.25, -0.62), (1, -0.2), (1, 0.2), (-1.25, 0.62)):
            angle, radius = middle + wide * np.pi / teeth, pitch + out * module
            points.append((float(radius * np.cos(angle)), float(radius * np.sin(angle))))
    return cq.Workplane("XY", origin=(0, 0, low)).polyline(points).close().extrude(high - low)


@kind
def geared_parallel_gripper(random: np.random.Generator) -> Drawing:
    """A gripper of cut plates: a servo's horn turns one of two geared links, each with a follower and a finger.

    Truth: all along z. Left gear link is one with the horn, which turns on the servo (revolute at the left gear's
    centre); right gear link and both followers turn on screws of the base (revolute); each finger turns on its gear
    link and on its follower, at the screws that are tight in the finger (revolute). Screws of the base, their spacers,
    washers and nuts are one with the base; screws of the fingers with the finger. Two freedoms: the gears join them.
    """
    reach, theta = random.uniform(42, 52), np.radians(random.uniform(42, 72))
    drawing = Drawing(fixed=["base plate"])
    base = plate([(-38, -36), (38, -36), (28, 28), (-28, 28)], 0, 4, 8)
    base = base.cut(box((-27.2, -30.7, -1), (-6.8, 10.4, 5)))
    pivots = [at(17, 0), at(9, 26), at(-9, 26)]
    drawing.add("base plate", cut(base, *(bore((*p, 2), Z, 1.6, 4) for p in pivots)))
    drawing.add("MG995", servo((-17, 0, 8.5), (0, -1, 0), Z))
    drawing.add("horn", servo_horn((-17, 0, 8.5), (0, -1, 0), Z, 0.05))
    weld(drawing, "base plate", "MG995")
    drawing.joint("Revolute", "MG995", "horn", (-17, 0, 10), Z)
    low, high, top = 12.5, 17.5, 22.5
    for number, p in enumerate(pivots, 1):
        drawing.add(f"spacer {number}", tube((*p, 4), Z, 1.6, 4, 8.5))
        drawing.add(f"M3x25 {number}", capscrew((*p, 0), Z, 1.5, 21.5))
        drawing.add(f"washer {number}", washer((*p, high), Z, 1.5))
        drawing.add(f"nut {number}", nut((*p, high + 0.5), Z, 1.5))
        weld(drawing, "base plate", f"spacer {number}", f"M3x25 {number}")
        weld(drawing, f"M3x25 {number}", f"washer {number}", f"nut {number}")
    for side, word in ((1, "right"), (-1, "left")):
        way = at(side * np.cos(theta), np.sin(theta))
        gear, near = at(side * 17, 0), at(side * 9, 26)
        far, far_near = gear + reach * way, near + reach * way
        teeth = _gear(24, 17, 0 if side < 0 else np.pi / 24, low, high).translate((side * 17, 0, 0))
        link = teeth.union(plate([gear, far], low, high, 6))
        link = cut(link, bore((*gear, 15), Z, 1.6 if side > 0 else 4.55, 4), bore((*far, 15), Z, 1.6, 4))
        drawing.add(f"gear link {word}", link)
        drawing.add(f"follower {word}", plate([near, far_near], low, high, 5, [near, far_near], 1.6))
        elbow = far_near + at(side * 2, 22)
        tip = far_near + at(side * -10, 44)
        finger = union(plate([far, far_near], high, top, 6), plate([far_near, elbow], high, top, 6))
        finger = union(
            finger, plate([elbow, tip], high, top, 5), box((*(tip + at(-3.5, -6)), 10), (*(tip + at(3.5, 16)), top))
        )
        name = "Finger" if side > 0 else "MirrorFinger"
        drawing.add(name, cut(finger, bore((*far, 20), Z, 1.5, 4), bore((*far_near, 20), Z, 1.5, 4)))
        if side > 0:
            drawing.joint("Revolute", "base plate", "gear link right", (*gear, 15), Z)
        else:
            weld(drawing, "horn", "gear link left")
        drawing.joint("Revolute", "base plate", f"follower {word}", (*near, 15), Z)
        for number, (p, other) in enumerate(((far, "gear link"), (far_near, "follower")), 1):
            pin, lock = f"M3x12 {word} {number}", f"locknut {word} {number}"
            drawing.add(pin, capscrew((*p, low), Z, 1.5, 12.5))
            drawing.add(lock, nut((*p, top), Z, 1.5))
            weld(drawing, name, pin)
            weld(drawing, pin, lock)
            drawing.joint("Revolute", f"{other} {word}", name, (*p, 15), Z)
    return drawing


@kind
def jansen_pair(random: np.random.Generator) -> Drawing:
    """Two of Jansen's legs on one crank, of cut plates in layers, with bolts of the size of their holes.

    Truth: all revolute along z. At the frame: crank on the motor's shaft (one with the motor's body, so crank to
    motor), and for each leg triangle and lower rocker; at the crank's pin: upper and lower rod of both legs; triangle
    to upper rod and to its outer rod; foot to outer rod, lower rocker and lower rod. A bolt is one with the frame, the
    crank, the triangle, or the foot, in this order; nuts and spacers are one with their bolt. One freedom.
    """
    size, thick, gap = random.uniform(1.25, 1.6), 3.0, float(random.choice([0, 0.2, 0.5]))
    turn = random.uniform(0, 2 * np.pi)
    pin, hole = 2.0, 2.0
    drawing = Drawing(fixed=["Frame"])

    def z(layer: int) -> float:
        return layer * (thick + gap)

    def cutout(name: str, points, layer: int, drilled, half: float = 6.0) -> None:
        drawing.add(name, plate(points, z(layer), z(layer) + thick, half, drilled, hole))

    crank = 15 * size * at(np.cos(turn), np.sin(turn))
    ground = [size * at(side * 38, -7.8) for side in (-1, 1)]
    frame = plate([ground[0], at(0, 24), ground[1]], 0, thick, 11, ground, hole)
    drawing.add("Frame", frame.cut(bore((0, 0, 1), Z, 4.5, 5)))
    motor = union(box((-14, -11, -22), (46, 11, -0.0)), cyl((0, 0, 0), Z, 2.75, z(1) + thick))
    flat = box((1.85, -4, 0), (4, 4, 20))
    drawing.add("TT Motor", cut(motor, flat))
    weld(drawing, "Frame", "TT Motor")
    wheel = cyl((0, 0, z(1)), Z, 15 * size + 7, thick).cut(cut(bore((0, 0, z(1)), Z, 2.75, 5), flat))
    drawing.add("Crank", cut(wheel, bore((*crank, z(1)), Z, hole, 5)))
    drawing.joint("Revolute", "TT Motor", "Crank", (0, 0, z(1)), Z)
    drawing.add("Crank bolt", bolt((*crank, z(5) + thick), -Z, pin, z(4) + thick))
    weld(drawing, "Crank", "Crank bolt")
    for side, base in zip((-1, 1), ground, strict=True):
        flip = at(-side, 1)  # drawn on the left, mirrored to the right
        foot_of, start = base * flip, crank * flip
        top = meet(foot_of, 41.5 * size, start, 50 * size)
        outer = meet(foot_of, 40.1 * size, top, 55.8 * size)
        knee = meet(start, 61.9 * size, foot_of, 39.3 * size)
        ankle = meet(knee, 36.7 * size, outer, 39.4 * size)
        toe = meet(knee, 49 * size, ankle, 65.7 * size)
        top, outer, knee, ankle, toe = (each * flip for each in (top, outer, knee, ankle, toe))
        tag = "L" if side < 0 else "R"
        upper, lower = (2, 3) if side < 0 else (4, 5)
        cutout(f"Triangle_{tag}", [base, outer, top], 1, [base, outer, top])
        cutout(f"Foot_{tag}", [knee, ankle, toe], 1, [knee, ankle])
        cutout(f"Link_j_{tag}", [crank, top], upper, [crank, top])
        cutout(f"Link_k_{tag}", [crank, knee], lower, [crank, knee])
        cutout(f"Link_c_{tag}", [base, knee], 2, [base, knee])
        cutout(f"Link_f_{tag}", [outer, ankle], 2, [outer, ankle])
        for word, p, first, last, owner, others in (
            ("B", base, 0, 2, "Frame", (f"Triangle_{tag}", f"Link_c_{tag}")),
            ("C", top, 1, upper, f"Triangle_{tag}", (f"Link_j_{tag}",)),
            ("D", outer, 1, 2, f"Triangle_{tag}", (f"Link_f_{tag}",)),
            ("E", knee, 1, lower, f"Foot_{tag}", (f"Link_c_{tag}", f"Link_k_{tag}")),
            ("F", ankle, 1, 2, f"Foot_{tag}", (f"Link_f_{tag}",)),
        ):
            end = z(last) + thick
            drawing.add(f"M4 bolt {word}{tag}", bolt((*p, z(first)), Z, pin, end - z(first) + 4))
            drawing.add(f"M4 nut {word}{tag}", nut((*p, end), Z, pin))
            weld(drawing, owner, f"M4 bolt {word}{tag}")
            weld(drawing, f"M4 bolt {word}{tag}", f"M4 nut {word}{tag}")
            inner = {"C": 2, "E": 3}.get(word)
            if inner and last > inner:
                low, high = z(inner) + 0.0, z(last) - gap
                drawing.add(f"Spacer {word}{tag}", tube((*p, low), Z, pin, 4, high - low))
                weld(drawing, f"M4 bolt {word}{tag}", f"Spacer {word}{tag}")
            for other in others:
                drawing.joint("Revolute", owner, other, (*p, z(1)), Z)
        for rod in "jk":
            drawing.joint("Revolute", "Crank", f"Link_{rod}_{tag}", (*crank, z(3)), Z)
    return drawing
