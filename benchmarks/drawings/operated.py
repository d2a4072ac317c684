"""What is operated from afar: an espresso group by a lever, a gearbox by a stick, a gate by a geared motor."""

from __future__ import annotations

import numpy as np

from drawings.actuated import cheeks, screws, weld
from drawings.drawing import Drawing, kind
from drawings.folding import circlip
from drawings.guided import ball_bearing, hollow
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
    meet,
    sphere,
    torus,
    tube,
    union,
)  # fmt: skip


@kind
def espresso_lever(random):
    """A group with a liner, a cap with ears, a forked lever on a pin, a rod with a wrist pin, a piston with seals."""
    drawing, play, turn = Drawing(["group"]), random.choice([0.02, 0.05, 0.1]), random.uniform(-0.22, 0.22)
    pivot, long = at(45, 0, 120), random.uniform(112, 120)
    top = pivot + 45 * at(-np.cos(turn), 0, np.sin(turn))
    wrist = at(0, 0, top[2] - np.sqrt(long**2 - top[0] ** 2))
    rise, ring = at(0.5, 0, np.sqrt(0.75)), hollow(51 * Z, Z, 33, 4, 0)
    neck, back = box((-75, -16, -30), (-30, 16, 20)), box((-85, -45, -40), (-75, 45, 30))
    group = union(cyl(-62 * Z, Z, 38, 102), neck, back)
    group = cut(group, cyl(-55 * Z, Z, 28, 100), bore((-80, 0, -5), X, 5, 60), cyl(-65 * Z, Z, 2.1, 20))
    group = cut(
        group, *(bore((-80, y, -5), X, 4.5, 9) for y in (-34, 34)), *(cyl(p - 30 * Z, Z, 2.5, 30) for p in ring)
    )
    drawing.add("group", cut(group, *(bore(p - 113 * Z, Z, 2, 9) for p in hollow(51 * Z, Z, 15, 6))))
    drawing.add("liner", cut(tube(-55 * Z, Z, 25, 28, 95), bore((-27, 0, -5), X, 5, 10)))
    screen = cut(
        cyl(-64 * Z, Z, 30, 2), bore(-64 * Z, Z, 2.5, 9), *(bore(p, Z, 1, 120) for p in hollow(0 * X, Z, 22, 8))
    )
    drawing.add("shower screen", screen)
    screws(drawing, "screen screw", [-64 * Z], Z, 2.5, 9, "group")
    drawing.add("gasket", cut(tube(40 * Z, Z, 28, 38, 1), *(bore(p, Z, 2.7, 30) for p in ring)))
    cap = union(cyl(41 * Z, Z, 38, 10), cheeks(at(22, 0, 53), pivot, 12, 20.2, 28))
    cap = cut(cap, cyl(20 * Z, Z, 10, 40), *(bore(p, Z, 2.7, 20) for p in ring))
    drawing.add("cap", cut(cap, bore(pivot, Y, 5)))
    screws(drawing, "cap screw", ring, -Z, 2.5, 28, "group")
    arms = [
        cheeks(top, pivot, 10, 8, 17),
        cheeks(pivot, pivot + 30 * rise, 10, 8, 17),
        cyl(pivot + 20 * rise, rise, 17, 22),
    ]
    fork = cut(union(*arms), bore(pivot, Y, 7), bore(top, Y, 4), cyl(pivot + 28 * rise, rise, 5, 30))
    drawing.add("lever fork", cut(fork, cyl(top + at(0, 12.5, 2), Z, 2, 20)))
    drawing.add("top pin", cyl(top - 17 * Y, Y, 4, 34))
    grub = cut(cyl(top + at(0, 12.5, 4), Z, 2, 5), hexagon(top + at(0, 12.5, 7), Z, 1, 3))
    drawing.add("grub screw", grub)
    for side, y in (("left", Y), ("right", -Y)):
        bush = union(cyl(pivot + 8 * y, y, 7.01, 9), cyl(pivot + 17 * y, y, 9.5, 3))
        drawing.add(f"{side} bush", cut(bush, bore(pivot, Y, 5 + play, 60)))
        weld(drawing, "lever fork", f"{side} bush")
    drawing.add("pivot pin", grooved(headed(pivot - 28 * Y, Y, 5, 59), pivot + 28.1 * Y, Y, 5))
    drawing.add("circlip", circlip(pivot + 28.1 * Y, Y, 5))
    way = (wrist - top) / long
    rod = union(cyl(top - 7 * Y, Y, 10, 14), cyl(wrist - 5 * Y, Y, 7.5, 10), cyl(top, way, 4.8, long))
    drawing.add("rod", cut(rod, bore(top, Y, 6), bore(wrist, Y, 3.5 + play)))
    drawing.add("rod bush", tube(top - 7 * Y, Y, 4 + play, 6.01, 14))
    crown = wrist - 10 * Z
    piston = union(
        cyl(crown - 16 * Z, Z, 25 - max(play, 0.05), 16), box(wrist + at(-8, -13, -11), wrist + at(8, 13, 7))
    )
    piston = cut(piston, box(wrist + at(-9, -5.2, -9.5), wrist + at(9, 5.2, 9)), bore(wrist, Y, 3.5))
    drawing.add("piston", cut(piston, *(tube(crown - z * Z, Z, 22, 26, 3.2) for z in (5.6, 13.6))))
    for number, z in enumerate((4, 12)):
        drawing.add(f"seal {number}", torus(crown - z * Z, Z, 23.5, 1.5))
    drawing.add("wrist pin", cyl(wrist - 13 * Y, Y, 3.5, 26))
    drawing.add("spring", tube(crown, Z, 17, 20.5, 41 - crown[2]))
    stalk = union(
        cyl(pivot + 28 * rise, rise, 5, 20), cyl(pivot + 42 * rise, rise, 7, 60), cyl(pivot + 80 * rise, rise, 5, 120)
    )
    drawing.add("stalk", stalk)
    drawing.add("handle", tube(pivot + 102 * rise, rise, 5, 14, 88))
    drawing.add("cap nut", cut(cyl(pivot + 190 * rise, rise, 9, 14), cyl(pivot + 185 * rise, rise, 5, 15)))
    drawing.joint("Revolute", "lever fork", "cap", pivot, Y)
    drawing.joint("Revolute", "rod", "lever fork", top, Y)
    drawing.joint("Revolute", "rod", "piston", wrist, Y)
    drawing.joint("Cylindrical", "piston", "liner", 0 * X, Z)
    weld(drawing, "group", "liner", "shower screen", "cap")
    weld(drawing, "lever fork", "top pin", "grub screw", "stalk")
    weld(drawing, "stalk", "handle", "cap nut")
    weld(drawing, "rod", "rod bush")
    weld(drawing, "piston", "wrist pin")
    return drawing


@kind
def gearbox_shifter(random):
    """A cover with two rails and forks, jaws, detents, an interlock; a lever with a ball under a cap on a turret."""
    drawing, play, gap = Drawing(["cover"]), random.choice([0.02, 0.05, 0.1]), random.choice([0.0, 0.05])
    sides, seat, rail = {"first": 1, "second": -1}, at(0, 0, random.uniform(78, 90)), 7 - random.choice([0.01, 0.03])
    corners = [at(x, y, 33) for x in (-38, 38) for y in (-32, 32)]
    cover = union(box((-110, -55, 16), (110, 55, 26)), *(box((s * 70, -32, -14), (s * 95, 32, 17)) for s in (-1, 1)))
    cover = cut(
        cover,
        box((-28, -25, 10), (28, 25, 30)),
        *(bore((x, y, 20), Z, 3.3, 9) for x in (-102, 102) for y in (-45, 0, 45)),
    )
    cover = cut(cover, *(cyl((p[0], p[1], 12), Z, 2.5, 16) for p in corners), cyl((77, -10, 0), Y, 3, 60))
    for s in sides.values():
        cover = cut(
            cover, bore((0, 14 * s, 0), X, 7), cyl((86, 14 * s, 0), Z, 3, 30), cyl((86, 14 * s, 17), Z, 3.4, 12)
        )
    drawing.add("cover", cover)
    for name, s in sides.items():
        p, f = at(0, 14 * s, 0), at(-38 * s, 14 * s, 0)
        shaft = cut(cyl(p - 90 * X, X, rail, 200), bore(f + 8 * X, Z, 2.5, 30), cyl(p + at(0, 6 * s, 0), Y * s, 2.5, 5))
        shaft = cut(shaft, *(sphere(p + at(86 + t, 0, 8.8), 3) for t in (-8, 0, 8)))
        drawing.add(f"{name} rail", cut(shaft, cyl((77, 9 * s, 0), -s * Y, 3.2, 9)))
        yoke = cut(tube(at(f[0] - 4, 0, -62), X, 30, 40, 8), box((-80, -50, -120), (80, 50, -66)))
        hub = union(cyl(f - 12 * X, X, 11.5, 24), box(f + at(-4, -7, -24), f + at(4, 7, 0)), yoke)
        pads = [box((f[0] - 4, y, -76), (f[0] + 4, y + 10, -65)) for y in (-40, 30)]
        drawing.add(f"{name} fork", cut(union(hub, *pads), bore(p, X, 7), bore(f + 8 * X, Z, 2.5, 30)))
        roll = cut(tube(f + at(8, 0, -12), Z, 1.6, 2.5, 24), box(f + at(7.6, 0, -20), f + at(8.4, 5, 20)))
        drawing.add(f"{name} roll pin", roll)
        jaw = union(cyl(p - 12 * X, X, 11, 24), box(p + at(-12, -8, 0), p + at(12, 8, 22)))
        jaw = cut(jaw, bore(p, X, 7), box(p + at(-5, -12, 10.5), p + at(5, 12, 30)), cyl(p, s * Y, 2.1, 20))
        drawing.add(f"{name} jaw", jaw)
        grub = cut(cyl(p + at(0, 6 * s, 0), s * Y, 2.5, 5), hexagon(p + at(0, 9 * s, 0), s * Y, 1.2, 3))
        drawing.add(f"{name} jaw screw", grub)
        drawing.add(f"{name} detent ball", sphere(p + at(86, 0, 8.8), 3))
        drawing.add(f"{name} detent spring", tube(p + at(86, 0, 11.8), Z, 2, 2.8, 6.2))
        drawing.add(f"{name} detent plug", cut(cyl(p + at(86, 0, 18), Z, 4, 8), hexagon(p + at(86, 0, 23), Z, 2, 4)))
        drawing.add(f"{name} core plug", cyl(p - 95 * X, X, 7.02, 4))
        drawing.joint("Cylindrical", f"{name} rail", "cover", p, X)
        for part in ("fork", "jaw"):
            weld(drawing, f"{name} rail", f"{name} {part}")
        weld(drawing, f"{name} fork", f"{name} roll pin")
        weld(drawing, f"{name} jaw", f"{name} jaw screw")
        weld(drawing, "cover", f"{name} detent plug", f"{name} core plug")
    drawing.add("interlock pin", cyl((77, -7.7, 0), Y, 2.95, 15.4))
    drawing.add("interlock plug", cyl((77, 26, 0), Y, 3.01, 6))
    gasket = cut(box((-46, -40, 26), (46, 40, 27)), box((-28, -25, 20), (28, 25, 30)))
    drawing.add("gasket", cut(gasket, *(bore(p, Z, 3.3, 20) for p in corners)))
    rim = hollow(seat, Z, 21.5, 3)
    turret = union(box((-46, -40, 27), (46, 40, 33)), cyl(27 * Z, Z, 26, seat[2] - 27))
    turret = cut(turret, sphere(seat, 14 + gap), cyl(20 * Z, Z, 20, seat[2] - 40), cyl(20 * Z, Z, 11, seat[2] - 20))
    drawing.add(
        "turret", cut(turret, *(bore(p, Z, 3.3, 20) for p in corners), *(cyl(p - 14 * Z, Z, 1.7, 15) for p in rim))
    )
    screws(drawing, "turret screw", corners, -Z, 3, 20, "cover")
    cap = cut(union(cyl(seat, Z, 26, 5), cyl(seat, Z, 17.5, 12)), sphere(seat, 14 + gap), cyl(seat, Z, 10, 20))
    drawing.add("socket cap", cut(cap, *(bore(p, Z, 2.2, 20) for p in rim)))
    screws(drawing, "cap screw", [p + 5 * Z for p in rim], -Z, 2, 16, "turret")
    finger = at(0, 14, 16)
    lean = (seat - finger) / np.linalg.norm(seat - finger)
    length = float(np.linalg.norm(seat - finger))
    stick = [cyl(finger, lean, 4, length), cyl(seat, lean, 6, 130), cyl(seat + 120 * lean, lean, 4, 40)]
    drawing.add("lever", union(sphere(seat, 14), sphere(finger, 5 - play), *stick))
    drawing.add("knob nut", hexagon(seat + 130 * lean, lean, 6.5, 5, 4))
    knob = union(sphere(seat + 155 * lean, 20), cyl(seat + 135 * lean, lean, 9, 10))
    drawing.add("knob", cut(knob, cyl(seat + 130 * lean, lean, 4, 30)))
    drawing.joint("Spherical", "lever", "turret", seat)
    weld(drawing, "cover", "interlock plug", "turret")
    weld(drawing, "turret", "socket cap")
    weld(drawing, "lever", "knob", "knob nut")
    return drawing


@kind
def automatic_gate_opener(random):
    """A leaf on two eye bolts over pintles; a geared motor with a worm, a motor arm and a second arm to a bracket."""
    drawing, play, width = Drawing(["pillar"]), random.choice([0.05, 0.1, 0.2]), random.uniform(740, 880)
    turn = random.uniform(5, 38)

    def swung(shape):
        return shape.rotate((0, 0, 0), (0, 0, 1), turn)

    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    hub, eye = at(-110, 170, 0), at(350 * c - 52 * s, 350 * s + 52 * c, 0)
    arms = random.uniform(220, 235), random.uniform(262, 275)
    elbow = at(*meet(hub[:2], arms[0], eye[:2], arms[1]), 0)
    pillar = cut(
        box((-240, -100, 0), (-40, 100, 1000)), *(bore((-40, y, z), X, 4, 40) for y in (-20, 20) for z in (210, 790))
    )
    fixing = [at(x, 110, z) for x in (-210, -70) for z in (400, 640)]
    drawing.add("pillar", cut(pillar, *(cyl(p + at(0, -50, 0), Y, 4, 60) for p in fixing)))
    leaf = cut(box((40, -20, 100), (width, 20, 900)), box((80, -30, 140), (width - 40, 30, 380)))
    leaf = cut(leaf, box((80, -30, 420), (width - 40, 30, 860)))
    panel = box((60, -22, 120), (width - 20, -20, 880))
    holes = [bore((x, -20, z), Y, 3, 9) for x in (70, width - 30) for z in (130, 870)]
    for name, z, d in (("lower", 185, Z), ("upper", 815, -Z)):
        p, foot = at(0, 0, z), [at(-32, y, 210 if z < 500 else 790) for y in (-20, 20)]
        plate = box((-40, -32, z + 45 * d[2]), (-32, 32, z - 25 * d[2]))
        plate = union(plate, box((-33, -14, z), (0, 14, z - 15 * d[2])), cyl(p - 15 * d, d, 14, 15), cyl(p, d, 8, 52))
        drawing.add(f"{name} pintle", cut(plate, *(bore(q, X, 4, 10) for q in foot)))
        drawing.add(f"{name} hinge washer", tube(p, d, 8.2, 14, 2))
        level = p + 24 * d
        bolt = union(cyl(p + 2.1 * d, d, 15, 42), cyl(level, X, 8, 105))
        drawing.add(f"{name} eye bolt", swung(cut(bolt, bore(p, Z, 8 + play))))
        for number, x in enumerate((27, 80)):
            drawing.add(f"{name} nut {number}", swung(hexagon(level + x * X, X, 12, 13, 8)))
        leaf = cut(leaf, cyl(level + 30 * X, X, 8, 60))
        weld(drawing, "pillar", f"{name} pintle")
        weld(drawing, "leaf", f"{name} eye bolt")
        for number in (0, 1):
            weld(drawing, f"{name} eye bolt", f"{name} nut {number}")
        if name == "lower":
            screws(drawing, f"{name} pintle screw", foot, -X, 4, 40, "pillar")
    taps = [at(x, 26, 400) for x in (322, 378)]
    drawing.add("leaf", swung(cut(leaf, *holes, *(bore(p, Y, 3.4, 60) for p in taps))))
    drawing.add("infill", swung(cut(panel, *holes)))
    case = union(box((-230, 106, 420), (-50, 260, 600)), box((-230, 100, 380), (-50, 110, 660)))
    case = cut(case, box((-225, 111, 440), (-158, 255, 610)), box((-151, 111, 440), (-55, 255, 610)))
    worm, wheel = at(-151, 220.5, 520), hub + 512 * Z
    case = cut(case, bore(worm, X, 5.5, 20), cyl(hub + 410 * Z, Z, 12.5, 60), cyl(hub + 424 * Z, Z, 16, 20))
    motor_screws = [worm + y * Y for y in (-15, 15)]
    case = cut(case, *(bore(p, Y, 4, 30) for p in fixing), *(bore(p, X, 2, 12) for p in motor_screws))
    lids = [at(x, y, 600) for x, y in ((-154.5, 113), (-227, 257), (-53, 257))]
    drawing.add("housing", cut(case, *(cyl(p - 15 * Z, Z, 1.2, 20) for p in lids)))
    screws(drawing, "housing screw", [fixing[0], fixing[3]], -Y, 4, 50, "housing")
    lid = cut(box((-232, 110, 600), (-48, 262, 630)), box((-228, 112, 599), (-52, 258, 626)))
    feet = [box(p + at(-3, -3, 0), p + at(3, 3, 28)) for p in lids]
    drawing.add("lid", cut(union(lid, *feet), *(cyl(p - Z, Z, 1.2, 12) for p in lids)))
    ball_bearing(drawing, "output bearing", hub + 424 * Z, Z, 10, 16, 8)
    shaft = union(cyl(hub + 392 * Z, Z, 10, 150), cyl(hub + 432.2 * Z, Z, 14, 78))
    keys = {
        "arm": box(hub + at(-3, 6, 395), hub + at(3, 12.5, 407)),
        "wheel": box(hub + at(-3, 6, 514), hub + at(3, 12.5, 528)),
    }
    shaft = grooved(cut(shaft, *keys.values(), cyl(hub + 390 * Z, Z, 3, 20)), wheel + 18.2 * Z, Z, 10)
    drawing.add("output shaft", shaft)
    for name, key in keys.items():
        drawing.add(f"{name} key", key)
    drawing.add(
        "worm wheel", cut(tube(hub + 510.2 * Z, Z, 10, 40, 20), box(hub + at(-3, 0, 500), hub + at(3, 12.5, 540)))
    )
    drawing.add("wheel circlip", circlip(wheel + 18.2 * Z, Z, 10))
    motor = cut(
        cyl(worm - 7 * X, -X, 25, 62), cyl(worm, -X, 5, 60), *(cyl(p - 6 * X, -X, 1.6, 14) for p in motor_screws)
    )
    drawing.add("motor", motor)
    screws(drawing, "motor screw", motor_screws, -X, 2, 17, "motor")
    drawing.add("worm", union(cyl(worm - 60 * X, X, 5, 75), cyl(worm + 12 * X, X, 10, 64)))
    arm = cut(bar(hub, elbow, 22, 395, 407), bore(hub, Z, 10), box(hub + at(-3, 0, 390), hub + at(3, 12.5, 410)))
    drawing.add("motor arm", cut(arm, bore(elbow, Z, 5)))
    drawing.add("arm washer", tube(hub + 389 * Z, Z, 3.3, 16, 3))
    screws(drawing, "arm screw", [hub + 389 * Z], Z, 3, 20, "output shaft")
    link = bar(elbow, eye, 18, 381, 393, [eye], 5 + play)
    drawing.add("second arm", cut(link, bore(elbow, Z, 7)))
    drawing.add(
        "elbow bush",
        cut(union(cyl(elbow + 381 * Z, Z, 7, 12), cyl(elbow + 393 * Z, Z, 11, 2)), bore(elbow, Z, 5 + play)),
    )
    drawing.add("elbow bolt", union(hexagon(elbow + 407 * Z, Z, 8.5, 6.5), cyl(elbow + 368 * Z, Z, 5, 40)))
    drawing.add("elbow washer", tube(elbow + 379 * Z, Z, 5.2, 11, 2))
    drawing.add("elbow nut", hexagon(elbow + 370 * Z, Z, 8.5, 9, 5))
    bracket = union(
        box((305, 20, 375), (395, 26, 425)),
        bar((350, 26), (350, 52), 17, 395, 403),
        box((333, 20, 395), (367, 40, 403)),
    )
    bracket = cut(
        bracket, box((300, 0, 370), (400, 20, 430)), bore((350, 52, 400), Z, 5), *(bore(p, Y, 4, 20) for p in taps)
    )
    drawing.add("gate bracket", swung(bracket))
    screws(
        drawing,
        "bracket screw",
        [at(c * x - s * 26, s * x + c * 26, 400) for x in (322, 378)],
        at(s, -c, 0),
        4,
        40,
        "leaf",
    )
    drawing.add("eye pin", grooved(headed(eye + 403 * Z, -Z, 5, 26), eye + 380.9 * Z, -Z, 5))
    drawing.add("eye washer", tube(eye + 393 * Z, Z, 5, 10, 2))
    drawing.add("eye circlip", circlip(eye + 380.9 * Z, -Z, 5))
    drawing.joint("Revolute", "lower eye bolt", "lower pintle", 0 * X, Z)
    drawing.joint("Revolute", "worm", "motor", worm, X)
    drawing.joint("Revolute", "output shaft", "housing", hub, Z)
    drawing.joint("Revolute", "second arm", "motor arm", elbow, Z)
    weld(drawing, "leaf", "infill")
    weld(drawing, "pillar", "housing")
    weld(drawing, "housing", "lid", "motor", "output bearing outer ring")
    weld(drawing, "output shaft", "output bearing inner ring", "worm wheel", "motor arm")
    weld(drawing, "second arm", "elbow bush")
    weld(drawing, "motor arm", "elbow bolt")
    weld(drawing, "elbow bolt", "elbow nut")
    weld(drawing, "output shaft", "arm key", "wheel key", "arm washer")
    drawing.joint("Revolute", "second arm", "gate bracket", eye, Z)
    weld(drawing, "leaf", "gate bracket")
    return drawing
