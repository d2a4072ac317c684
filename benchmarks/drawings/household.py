"""What stands in a house: a door with its closer, scales."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, meet, rivet, screw, tube, union


@kind
def door_closer(random):
    """A door on a hinge, a closer on it: a rack piston, a shaft in bushes, an arm on its square, a fore arm, a shoe."""
    drawing, play = Drawing(["wall"]), random.choice([0.02, 0.05])
    axle = at(180, -31, 0)
    door_axis = at(0, -8, 0)
    screws = [at(x, 0, z) for x in (104, 256) for z in (-18, 18)]
    door = union(
        box((8, 0, -250), (500, 40, 60)),
        *(cyl((0, -8, z), Z, 8, 60) for z in (-240, -20)),
        *(box((0, -14, z), (20, 2, z + 60)) for z in (-240, -20)),
    )
    door = cut(door, *(cyl(p, Y, 2, 20) for p in screws), bore(door_axis, Z, 5 + play))
    wall = union(
        box((-120, -4, -260), (-12, 40, 140)),
        box((-120, -4, 75), (500, 40, 140)),
        *(cyl((0, -8, z), Z, 8, 30) for z in (-272, -178, 42)),
        *(box((-20, -14, z), (0, -2, z + 30)) for z in (-272, -178, 42)),
    )
    drawing.add("door", door)
    shoe = at(330, -60, 60)
    pilots = [at(320 + x, -4, 95 + z) for x in (-18, 18) for z in (-10, 10)]
    drawing.add("wall", cut(wall, bore(door_axis, Z, 5), *(cyl(p, Y, 2, 20) for p in pilots)))
    drawing.add("hinge rod", cyl((0, -8, -275), Z, 5, 350))
    body = box((80, -58, -22), (280, 0, 22))
    body = cut(body, bore(axle, X, 13), bore(axle, Z, 11, 30), *(bore(p, Y, 2.2) for p in screws))
    drawing.add("body", body)
    for number, p in enumerate(screws):
        drawing.add(f"body screw {number}", screw(p - 58 * Y, Y, 2, 76))
    for name, x, s in (("left plug", 80, 1), ("right plug", 280, -1)):
        drawing.add(name, union(cyl(at(x, -31, 0), s * X, 13, 12), cyl(at(x, -31, 0), -s * X, 16, 3)))
    piston = cut(cyl(at(130, -31, 0), X, 13 - play, 100), box((145, -50, -14), (215, -23, 14)))
    drawing.add("piston", piston)
    drawing.add("piston spring", tube(at(232, -31, 0), X, 9, 11, 34))
    shaft = union(
        cyl(axle - 24 * Z, Z, 7, 50), cyl(axle - 6 * Z, Z, 5.8, 12), box(axle + at(-4, -4, 26), axle + at(4, 4, 31.5))
    )
    drawing.add("shaft", cut(shaft, cyl(axle + 36 * Z, -Z, 2, 18)))
    for name, z in (("lower bush", -22), ("upper bush", 12)):
        drawing.add(name, tube(axle + z * Z, Z, 7 + play, 11, 10))
    drawing.add("cap", tube(axle + 22 * Z, Z, 7.5, 14, 2))
    reach = random.uniform(150, 170)
    elbow = at(*meet(shoe[:2], 180, axle[:2], reach), 0)
    arm = cut(bar(axle, elbow, 11, 26, 32), box(axle + at(-4, -4, 20), axle + at(4, 4, 40)), bore(elbow, Z, 4))
    drawing.add("arm", arm)
    drawing.add("arm screw", screw(axle + 34 * Z, -Z, 2, 15))
    drawing.add("arm washer", tube(axle + 32 * Z, Z, 2.2, 8, 2))
    flat = at(*(shoe[:2] - elbow[:2]), 0)
    flat /= np.linalg.norm(flat)
    here, there = elbow + 44 * Z, at(*shoe[:2], 44)
    fore = cut(
        union(cyl(here - 6 * Z, Z, 9, 12), cyl(here + 8 * flat, flat, 6, 80)),
        cyl(here + 30 * flat, flat, 4, 90),
        bore(elbow, Z, 4 + play),
    )
    drawing.add("fore arm", fore)
    drawing.add(
        "elbow bolt",
        union(cyl(elbow + 26 * Z, Z, 4, 24.2), cyl(elbow + 21 * Z, Z, 7, 5), cyl(elbow + 50.2 * Z, Z, 6, 3)),
    )
    drawing.add("elbow washer", tube(elbow + 32 * Z, Z, 4, 8, 6))
    rod = union(cyl(here + 40 * flat, flat, 4, 134), cyl(there - 6 * Z, Z, 9, 12))
    drawing.add("fore rod", cut(rod, bore(there, Z, 4 + play)))
    drawing.add("fore nut", hexagon(here + 88 * flat, flat, 6.5, 5, 4))
    lug = union(
        box((300, -8, 80), (340, -4, 110)),
        box((310, -8, 54), (346, -4, 110)),
        *(
            union(box(at(shoe[0] - 9, shoe[1], z), at(shoe[0] + 9, -4, z + 4)), cyl(at(*shoe[:2], z), Z, 9, 4))
            for z in (33, 51)
        ),
        box((321, -8, 33), (339, -4, 60)),
    )
    drawing.add("shoe", cut(lug, bore(shoe, Z, 4, 40), *(bore(p, Y, 2.2, 6) for p in pilots)))
    drawing.add("shoe pin", headed(at(*shoe[:2], 55), -Z, 4, 25))
    drawing.add("shoe clip", tube(at(*shoe[:2], 32), Z, 4, 6, 1))
    for number, p in enumerate(pilots):
        if p[0] < 320:
            drawing.add(f"shoe screw {number}", screw(p - 4 * Y, Y, 2, 18))
    drawing.joint("Revolute", "door", "wall", door_axis, Z)
    drawing.joint("Weld", "body", "door")
    drawing.joint("Cylindrical", "piston", "body", axle, X)
    drawing.joint("Revolute", "shaft", "body", axle, Z)
    drawing.joint("Weld", "arm", "shaft")
    drawing.joint("Revolute", "fore arm", "arm", elbow, Z)
    drawing.joint("Weld", "fore rod", "fore arm")
    drawing.joint("Revolute", "fore rod", "shoe", shoe, Z)
    drawing.joint("Weld", "shoe", "wall")
    drawing.joint("Weld", "left plug", "body")
    return drawing


@kind
def kitchen_scales(random):
    """Scales after Roberval: a beam of two plates above, a stay below, two posts with pans pressed on."""
    drawing, play = Drawing(["case"]), random.choice([0.05, 0.15])
    reach, tilt = random.uniform(80, 100), random.uniform(-0.12, 0.12)
    arm = reach * at(np.cos(tilt), np.sin(tilt), 0)
    top, bottom = at(0, 60, 0), at(0, 15, 0)
    post = union(box((-9, -20, -6), (9, 68, 6)), box((-130, -26, -40), (130, -20, 40)))
    drawing.add("case", cut(post, bore(top, Z, 3), bore(bottom, Z, 3)))
    for number, s in enumerate((1, -1)):
        plate = bar(top - arm, top + arm, 7, *sorted((s * 7, s * 10)), [top, top - arm, top + arm], 3 + play)
        drawing.add(f"beam plate {number}", plate)
        drawing.add(f"beam washer {number}", tube(top + s * 6 * Z, s * Z, 3, 6, 0.9))
        drawing.add(
            f"beam tie {number}",
            rivet(top + 0.5 * s * arm - 10 * Z, Z, 2, 20).union(cyl(top + 0.5 * s * arm - 7 * Z, Z, 4, 14)),
        )
    for s in (1, -1):
        for plate in (0, 1):
            name = f"beam plate {plate}"
            drawing.parts[name] = drawing.parts[name].cut(bore(top + 0.5 * s * arm, Z, 2))
    drawing.add("stay", bar(bottom - arm, bottom + arm, 5, 7, 10, [bottom, bottom - arm, bottom + arm], 3 + play))
    drawing.add("beam axle", cyl(top - 12 * Z, Z, 3, 24))
    for number, s in enumerate((1, -1)):
        drawing.add(f"axle clip {number}", tube(top + s * 10.2 * Z, s * Z, 3, 5.5, 1))
    drawing.add("stay screw", screw(bottom + 11 * Z, -Z, 3, 24))
    drawing.add("stay washer", tube(bottom + 10 * Z, Z, 3.1, 6, 1))
    drawing.add("stay nut", hexagon(bottom - 10 * Z, Z, 5, 4, 3))
    for name, s in (("left", -1), ("right", 1)):
        high, low = top + s * arm, bottom + s * arm
        carrier = union(box(low + at(-7, -10, -6), high + at(7, 10, 6)), cyl(high + 10 * Y, Y, 4, 20))
        drawing.add(f"{name} carrier", cut(carrier, bore(high, Z, 3), bore(low, Z, 3)))
        drawing.add(f"{name} pan", union(tube(high + 16 * Y, Y, 4, 8, 14), cyl(high + 30 * Y, Y, 60, 3)))
        drawing.add(f"{name} beam pin", rivet(high - 10 * Z, Z, 3, 20))
        drawing.add(f"{name} stay pin", rivet(low - 6 * Z, Z, 3, 16))
        drawing.joint("Revolute", f"{name} carrier", "beam plate 0", high, Z)
        drawing.joint("Revolute", f"{name} carrier", "stay", low, Z)
        drawing.joint("Weld", f"{name} pan", f"{name} carrier")
    drawing.joint("Revolute", "beam plate 0", "case", top, Z)
    drawing.joint("Weld", "beam plate 0", "beam plate 1")
    drawing.joint("Revolute", "stay", "case", bottom, Z)
    return drawing
