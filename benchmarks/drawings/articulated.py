"""What bends on pins and bearings: a robot's finger, a SCARA arm, a can crusher."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.guided import ball_bearing
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, rivet, screw, torus, tube, union


@kind
def robot_finger(random):
    """Three phalanges on pins with loose pulleys for a tendon, a servo in the palm with a spool, a pad, a lid."""
    drawing, play = Drawing(["palm"]), random.choice([0.03, 0.1])
    turns, lengths = np.cumsum(random.uniform(0.15, 0.5, 3)), (45.0, 34.0, 30.0)
    ways = [at(np.cos(t), np.sin(t), 0) for t in turns]
    joints = [at(0, 0, 0)]
    for way, length in zip(ways, lengths, strict=True):
        joints.append(joints[-1] + length * way)
    palm = union(box((-66, -12, -15), (-12, 10, 15)), box((-14, -8, -11), (-8, 8, 11)))
    palm = union(palm, *(bar(at(-12, 0, 0), at(0, 0, 0), 6, s * 9 - 2, s * 9 + 2) for s in (-1, 1)))
    palm = cut(palm, box((-52, -6.1, -12.5), (-28.9, 6.1, 16)), bore(joints[0], Z, 1.5, 20))
    lids = [at(x, 10, z) for x in (-62, -18) for z in (-11, 11)]
    palm = cut(palm, *(cyl(p, -Y, 1, 9) for p in lids))
    ears = [at(x, 0, 15) for x in (-55.5, -24.5)]
    drawing.add("palm", cut(palm, *(cyl(p, -Z, 0.95, 9) for p in ears)))
    lid = cut(box((-66, 10, -15), (-12, 12, 15)), *(bore(p, Y, 1.2, 9) for p in lids))
    drawing.add("lid", lid)
    for k, p in enumerate(lids):
        drawing.add(f"lid screw {k}", screw(p + 2 * Y, -Y, 1, 8))
    names, owners = ("proximal", "middle", "distal"), ("palm", "proximal", "middle")
    for k, (name, owner, way) in enumerate(zip(names, owners, ways, strict=True)):
        low, high = joints[k], joints[k + 1]
        shapes = [bar(low + 14 * way, high - (14 if k < 2 else 7) * way, 7, -11, 11)]
        shapes += [bar(low, low + 14 * way, 6, s * 4.75 - 2.15, s * 4.75 + 2.15) for s in (-1, 1)]
        if k < 2:
            shapes += [bar(high - 14 * way, high, 6, s * 9 - 2, s * 9 + 2) for s in (-1, 1)]
        shape = cut(union(*shapes), bore(low, Z, 1.5 + play, 20))
        if k < 2:
            shape = cut(shape, bore(high, Z, 1.5, 20))
        else:
            side = np.cross(Z, way)
            tip = low + 18 * way
            shape = cut(shape, cyl(tip - 3 * side, side, 1, 6), cyl(tip - 3 * side, -side, 9, 20))
            pad = cut(cyl(tip - 3 * side, -side, 8.9, 5), bore(tip, side, 1.2, 20))
            drawing.add("pad", cut(pad, cyl(tip - 5 * side, -side, 2, 9)))
            drawing.add("pad screw", screw(tip - 5 * side, side, 1, 7))
            drawing.joint("Weld", "pad", "distal")
        drawing.add(name, shape)
        drawing.add(f"{name} pin", cyl(low - 11 * Z, Z, 1.5, 22) if k else rivet(low - 11 * Z, Z, 1.5, 22))
        groove = torus(low, Z, 5.6, 1.2)
        drawing.add(f"{name} pulley", cut(tube(low - 2.4 * Z, Z, 1.55, 5, 4.8), groove))
        drawing.joint("Revolute", name, owner, low, Z)
        drawing.joint("Revolute", f"{name} pulley", owner, low, Z)
    axle = at(-34.5, 0, 12)
    servo = union(
        box((-51.5, -6, -10), (-29.4, 6, 22)), box((-59, -6, 15), (-21, 6, 17.5)), cyl(axle + 5 * Z, Z, 5.8, 9)
    )
    servo = cut(servo, cyl(axle, Z, 2.42, 40), *(bore(p, Z, 1.1, 9) for p in ears))
    drawing.add("servo", servo)
    for k, p in enumerate(ears):
        drawing.add(f"servo screw {k}", screw(p + 2.5 * Z, -Z, 0.95, 9))
    drawing.add("servo shaft", cut(cyl(axle, Z, 2.4, 17), cyl(axle + 8 * Z, Z, 0.9, 20)))
    spool = cut(cyl(axle + 14.4 * Z, Z, 8, 7), tube(axle + 15.9 * Z, Z, 6, 9, 3))
    spool = cut(spool, cyl(axle, Z, 2.4, 17), bore(axle, Z, 1.1, 30), cyl(axle + 20 * Z, Z, 2.2, 9))
    drawing.add("spool", spool)
    drawing.add("spool screw", screw(axle + 20 * Z, -Z, 0.9, 9))
    drawing.joint("Weld", "lid", "palm")
    drawing.joint("Weld", "servo", "palm")
    drawing.joint("Revolute", "servo shaft", "servo", axle, Z)
    drawing.joint("Weld", "spool", "servo shaft")
    return drawing


@kind
def scara_arm(random):
    """A shoulder shaft in two solid bearings with spacers, an elbow on ball bearings, a quill in bushes, a motor."""
    drawing, play = Drawing(["base"], unit="INCH"), random.choice([0.02, 0.1])
    o, elbow, turn = at(0, 0, 0), at(140, 0, 0), random.uniform(0.5, 1.2)
    way = at(np.cos(turn), np.sin(turn), 0)
    wrist, mid = elbow + 120 * way, elbow + 62 * way
    spots = [28.5 * at(np.cos(a), np.sin(a), 0) for a in np.arange(3) * 2 * np.pi / 3]
    base = union(cyl(o, Z, 60, 10), cyl(o, Z, 35, 90))
    base = cut(
        base, cyl(o + 15 * Z, Z, 20, 90), cyl(o + 60 * Z, Z, 22, 40), *(cyl(p + 92 * Z, -Z, 2, 16) for p in spots)
    )
    drawing.add("base", base)
    for k, z in enumerate((60, 81)):
        drawing.add(f"shoulder bearing {k}", tube(o + z * Z, Z, 12, 22, 9))
    drawing.add("inner spacer", tube(o + 69 * Z, Z, 12.05, 15, 12))
    drawing.add("outer spacer", tube(o + 69 * Z, Z, 19, 21.9, 12))
    drawing.add("bearing cap", cut(tube(o + 90 * Z, Z, 17, 35, 4), *(bore(p, Z, 2.2, 200) for p in spots)))
    for k, p in enumerate(spots):
        drawing.add(f"cap screw {k}", screw(p + 94 * Z, -Z, 2, 16))
    holes = [21 * at(np.cos(a), np.sin(a), 0) for a in np.arange(3) * 2 * np.pi / 3 + 0.6]
    shaft = union(cyl(o + 46 * Z, Z, 12, 60), cyl(o + 90 * Z, Z, 15, 10), cyl(o + 99 * Z, Z, 26, 7))
    drawing.add("shoulder shaft", cut(shaft, *(cyl(p + 107 * Z, -Z, 2, 20) for p in holes)))
    drawing.add("shaft nut", hexagon(o + 50 * Z, Z, 16.5, 10, 12))
    arm = cut(bar(o, elbow, 26, 106, 122), *(bore(p, Z, 2.2, 200) for p in holes))
    arm = cut(arm, bore(elbow, Z, 9, 200), cyl(elbow, Z, 11, 113), cyl(elbow + 115 * Z, Z, 11, 20))
    drawing.add("upper arm", cut(arm, *(cyl(p + 115 * Z, Z, 3.7, 20) for p in holes)))
    for k, p in enumerate(holes):
        drawing.add(f"arm screw {k}", screw(p + 115 * Z, -Z, 2, 15))
    for name, z in (("low", 106.0), ("high", 115.0)):
        ball_bearing(drawing, f"elbow {name}", elbow + z * Z, Z, 4, 11, 7)
    for name, z in (("low", 105.0), ("high", 122.0)):
        drawing.add(f"elbow {name} washer", tube(elbow + z * Z, Z, 4.1, 5.9, 1))
    drawing.add("elbow bolt", cyl(elbow + 94 * Z, Z, 4, 41).union(hexagon(elbow + 135 * Z, Z, 6.5, 5.3)))
    drawing.add("elbow nut", hexagon(elbow + 98 * Z, Z, 6.5, 7, 4))
    arm = union(bar(elbow, wrist, 22, 123, 135), cyl(wrist + 123 * Z, Z, 14, 40))
    corners = [mid + s * 11.5 * at(np.cos(turn + 0.8), np.sin(turn + 0.8), 0) for s in (-1, 1)]
    arm = cut(arm, bore(elbow, Z, 4, 200), bore(wrist, Z, 8, 200), *(bore(p, Z, 1.4, 200) for p in corners))
    drawing.add("forearm", cut(arm, bore(mid, Z, 5, 200)))
    for name, z, s in (("low", 123.0, -1), ("high", 163.0, 1)):
        bush = union(tube(wrist + z * Z, -s * Z, 6 + play, 8, 14), tube(wrist + z * Z, s * Z, 6 + play, 11, 2))
        drawing.add(f"{name} bush", bush)
    drawing.add("quill", cyl(wrist + 50 * Z, Z, 6, 180).faces(">Z").chamfer(0.8))
    for name, z, radius in (("tool flange", 50.0, 18), ("stop", 210.0, 11)):
        ring = tube(wrist + z * Z, Z, 6, radius, 10)
        drawing.add(name, cut(ring, cyl(wrist + (z + 5) * Z, X, 1.5, 40)))
        drawing.add(f"{name} grub screw", cyl(wrist + (z + 5) * Z + 6 * X, X, 1.5, 4))
        drawing.joint("Weld", name, "quill")
    motor = union(cyl(mid + 135 * Z, Z, 15, 32))
    motor = cut(motor, cyl(mid + 100 * Z, Z, 2.52, 63), *(cyl(p + 130 * Z, Z, 1.25, 12) for p in corners))
    drawing.add("motor", motor)
    for k, p in enumerate(corners):
        drawing.add(f"motor screw {k}", screw(p + 123 * Z, Z, 1.25, 17))
    drawing.add("motor shaft", cyl(mid + 108 * Z, Z, 2.5, 55))
    pulley = cut(tube(mid + 108.5 * Z, Z, 2.5, 8, 13), tube(mid + 110 * Z, Z, 7, 9, 5))
    drawing.add("pulley", cut(pulley, cyl(mid + 118.5 * Z, Y, 1.25, 20)))
    drawing.add("pulley grub screw", cyl(mid + 118.5 * Z + 2.5 * Y, Y, 1.25, 4))
    drawing.joint("Revolute", "shoulder shaft", "base", o, Z)
    drawing.joint("Weld", "bearing cap", "base")
    drawing.joint("Weld", "upper arm", "shoulder shaft")
    drawing.joint("Revolute", "forearm", "upper arm", elbow, Z)
    drawing.joint("Weld", "low bush", "forearm")
    drawing.joint("Weld", "high bush", "forearm")
    drawing.joint("Cylindrical", "quill", "forearm", wrist, Z)
    drawing.joint("Weld", "motor", "forearm")
    drawing.joint("Revolute", "motor shaft", "motor", mid, Z)
    drawing.joint("Weld", "pulley", "motor shaft")
    return drawing


@kind
def can_crusher(random):
    """A ram under the lips of two rails on a board, two links, a lever on a bush between the ears of a bracket."""
    drawing, play = Drawing(["board"]), random.choice([0.1, 0.3])
    lean = random.uniform(0.1, 0.5)
    pivot = at(285, 60, 0)
    way = at(-np.sin(lean), np.cos(lean), 0)
    top = pivot + 55 * way
    eye = at(top[0] - np.sqrt(110**2 - (top[1] - 40) ** 2), 40, 0)
    board, low = box((-40, -18, -60), (330, 0, 60)), eye[0] - 30
    for name, s in (("near", 1), ("far", -1)):
        rail = union(box((20, 0, s * 35), (250, 20, s * 45)), box((20, 14, s * 30), (250, 20, s * 45)))
        spots = [at(x, 20, s * 40) for x in (40, 135, 230)]
        drawing.add(f"{name} rail", cut(rail, *(bore(p, Y, 2.7, 30) for p in spots)))
        board = cut(board, *(cyl(at(p[0], 0, p[2]), -Y, 2.5, 12) for p in spots))
        for k, p in enumerate(spots):
            drawing.add(f"{name} rail screw {k}", screw(p, -Y, 2.5, 30))
        drawing.joint("Weld", f"{name} rail", "board")
    spots = [at(5, -12, z) for z in (-18, 18)]
    drawing.add("anvil", cut(box((0, 0, -34), (10, 80, 34)), *(cyl(p, Y, 2.5, 36) for p in spots)))
    board = cut(board, *(bore(p, Y, 2.7, 30) for p in spots), *(cyl(p, -Y, 5, 10) for p in spots))
    for k, p in enumerate(spots):
        drawing.add(f"anvil screw {k}", screw(p, Y, 2.5, 32))
    corners = [at(x, 6, z) for x in (268, 302) for z in (-23, 23)]
    ears = [box((275, 5, s * 10), (295, 60, s * 16)).union(cyl(pivot + s * 10 * Z, s * Z, 10, 6)) for s in (-1, 1)]
    bracket = cut(union(box((260, 0, -30), (310, 6, 30)), *ears), bore(pivot, Z, 4, 30))
    drawing.add("bracket", cut(bracket, *(bore(p, Y, 2.2, 10) for p in corners)))
    drawing.add("board", cut(board, *(cyl(at(p[0], 0, p[2]), -Y, 2, 14) for p in corners)))
    for k, p in enumerate(corners):
        drawing.add(f"bracket screw {k}", screw(p, -Y, 2, 18))
    ram = union(
        box((low, 0, play - 35), (low + 45, 14 - play, 35 - play)),
        box((low, 10, -20), (low + 45, 24, 20)),
        box((low, 20.5, -30), (low + 8, 80, 30)),
        bar(eye - 20 * Y, eye, 10, -9.9, 9.9),
    )
    drawing.add("ram", cut(ram, bore(eye, Z, 4, 30)))
    for name, s in (("near", 1), ("far", -1)):
        drawing.add(f"{name} link", bar(top, eye, 9, s * 11.5 - 1.5, s * 11.5 + 1.5, (top, eye), 4 + play / 2))
        drawing.joint("Revolute", f"{name} link", "lever", top, Z)
        drawing.joint("Revolute", f"{name} link", "ram", eye, Z)
    lever = union(bar(pivot, pivot + 150 * way, 10, -9.9, 9.9), cyl(pivot + 150 * way, way, 8, 105))
    drawing.add("lever", cut(lever, bore(pivot, Z, 6, 30), bore(top, Z, 4, 30)))
    drawing.add("lever bush", tube(pivot - 9.9 * Z, Z, 4.05, 6.02, 19.8))
    drawing.add("grip", cut(cyl(pivot + 162 * way, way, 12, 96), cyl(pivot + 150 * way, way, 8, 105)))
    for name, p, half in (("pivot", pivot, 16), ("top", top, 13), ("eye", eye, 13)):
        drawing.add(
            f"{name} bolt", cyl(p - half * Z, Z, 4, 2 * half + 12).union(hexagon(p - (half + 5) * Z, Z, 6.5, 5))
        )
        drawing.add(f"{name} washer", tube(p + half * Z, Z, 4.2, 8, 1.6))
        drawing.add(f"{name} nut", hexagon(p + (half + 1.6) * Z, Z, 6.5, 8, 4))
    drawing.joint("Weld", "anvil", "board")
    drawing.joint("Weld", "bracket", "board")
    drawing.joint("Prismatic", "ram", "board", eye, X)
    drawing.joint("Weld", "lever bush", "lever")
    drawing.joint("Revolute", "lever", "bracket", pivot, Z)
    return drawing
