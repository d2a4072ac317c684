"""What drives and flies: a landing gear, the controls of a flap, a cart."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, headed, hexagon, screw, sphere, tube, union


def upright(one, other, half: float, inner: float, outer: float, radius: float):
    """A fork of two bars in planes of constant y, from `inner` to `outer` on both sides, with holes at both ends."""
    flat = [at(p[0], p[2], 0) for p in (one, other)]
    sides = [bar(*flat, half, *sorted((s * inner, s * outer)), flat, radius) for s in (-1, 1)]
    return union(*(side.rotate((0, 0, 0), (1, 0, 0), 90) for side in sides))


def solid_bar(one, other, half: float, width: float, radius: float):
    """A bar in the plane xz, `width` to both sides of it, with holes at both ends."""
    flat = [at(p[0], p[2], 0) for p in (one, other)]
    return bar(*flat, half, -width, width, flat, radius).rotate((0, 0, 0), (1, 0, 0), 90)


@kind
def landing_gear(random):
    """A strut on trunnion pins, a folding brace, a ram, a piston with torque links, a wheel on bearings; in inches."""
    drawing, play = Drawing(["airframe"], unit="INCH"), random.choice([0.0, 0.1])
    origin, brace, roof, back = at(0, 0, 0), at(42, 0, -120), at(random.uniform(170, 200), 0, 20), at(-170, 0, 20)
    rear = at(-42, 0, -60)
    lugs = [box((-15, s * 40 - 6, -15), (15, s * 40 + 6, 42)) for s in (-1, 1)]
    hangers = [box((p[0] - 10, s * 11 - 3, 8), (p[0] + 10, s * 11 + 3, 42)) for p in (roof, back) for s in (-1, 1)]
    airframe = union(box((-200, -60, 40), (230, 60, 50)), *lugs, *hangers)
    drawing.add("airframe", cut(airframe, bore(origin, Y, 10), *(bore(p, Y, 5) for p in (roof, back))))
    strut = union(
        cyl((0, -33, 0), Y, 18, 66),
        cyl((0, 0, -200), Z, 26, 195),
        box((20, -6, -130), (52, 6, -110)),
        *(box((-52, s * 9.5 - 3, -70), (-20, s * 9.5 + 3, -50)) for s in (-1, 1)),
        box((20, -8, -198), (48, 8, -182)),
    )
    torque = at(40, 0, -190), at(95, 0, -245), at(40, 0, -300)
    holes = [bore(brace, Y, 5), bore(rear, Y, 5), bore(torque[0], Y, 4)]
    drawing.add("strut", cut(strut, cyl((0, 0, -210), Z, 20, 180), bore(origin, Y, 10 + play), *holes))
    for s in (-1, 1):
        drawing.add(f"trunnion pin {s}", headed((0, s * 46, 0), -s * Y, 10, 34))
    drawing.add("lower bearing", tube((0, 0, -200), Z, 18, 20, 25))
    piston = union(
        cyl((0, 0, -330), Z, 18, 270),
        cyl((0, 0, -72), Z, 20 - play, 12),
        box((10, -12, -308), (48, 12, -292)),
        cyl((0, -15, -325), Y, 9, 115),
        cyl((0, 18.5, -325), Y, 14, 4),
    )
    drawing.add("piston", cut(piston, bore(torque[2], Y, 4)))
    drawing.add(
        "upper torque link", union(upright(*torque[:2], 7, 8.2, 12, 4 + play), box((60, -9, -222), (70, 9, -208)))
    )
    lower = union(upright(*torque[1:], 7, 12.4, 16, 4 + play), box((62, -13, -282), (72, 13, -268)))
    drawing.add("lower torque link", lower)
    for k, p in enumerate(torque):
        drawing.add(f"torque pin {k}", headed(p - (12 if k == 0 else 16) * Y, Y, 4, 24 if k == 0 else 34))
    middle = (brace + roof) / 2
    knee = middle + random.uniform(12, 25) * at(0.6, 0, -0.8)
    way = (knee - brace) / np.linalg.norm(knee - brace)
    block = box((-6, -7, -6), (6, 7, 6)).translate(tuple((brace + 0.5 * (knee - brace)).tolist()))
    drawing.add("lower brace", union(upright(brace, knee, 9, 6.5, 10, 5 + play), block))
    drawing.add("upper brace", solid_bar(knee, roof, 9, 6, 5 + play))
    for name, p, reach in (("brace pin", brace, 10), ("knee pin", knee, 10), ("roof pin", roof, 14)):
        drawing.add(name, headed(p - reach * Y, Y, 5, 2 * reach + 3))
        drawing.add(f"{name} washer", tube(p + reach * Y, Y, 5, 8, 1))
    way = (rear - back) / np.linalg.norm(rear - back)
    span = float(np.linalg.norm(rear - back))
    barrel = union(
        cyl(back - 6 * Y, Y, 10, 12), cyl(back + 8 * way, way, 7, 10), cyl(back + 16 * way, way, 14, 0.55 * span)
    )
    drawing.add("barrel", cut(barrel, bore(back, Y, 5 + play), cyl(back + 22 * way, way, 10, 0.6 * span)))
    end = 16 + 0.55 * span
    drawing.add("gland", tube(back + (end - 12) * way, way, 6, 10, 12))
    drawing.add("ram", union(cyl(back + 40 * way, way, 6, span - 55), cyl(back + 40 * way, way, 10, 12)))
    eye = union(cyl(rear - 6 * Y, Y, 10, 12), cyl(rear, -way, 6, 28))
    drawing.add("ram eye", cut(eye, bore(rear, Y, 5 + play), cyl(rear - 15 * way, -way, 4, 20)))
    drawing.parts["ram"] = union(drawing.parts["ram"], cyl(rear - 28 * way, way, 4, 10))
    drawing.parts["ram"] = cut(
        drawing.parts["ram"], cut(cyl(rear - 28 * way, way, 9, 13), cyl(rear - 29 * way, way, 4, 15))
    )
    for name, p, reach in (("ram pin 1", back, 14.0), ("ram pin 2", rear, 12.5)):
        drawing.add(name, headed(p - reach * Y, Y, 5, 2 * reach))
    hub = at(0, 0, -325)
    wheel = cut(tube(hub + 24 * Y, Y, 16, 60, 46), *(cyl(hub + y * Y, Y, 18, 10) for y in (24, 60)))
    drawing.add("wheel", wheel)
    for k, y in enumerate((24.0, 60.0)):
        drawing.add(f"inner race {k}", tube(hub + y * Y, Y, 9, 12, 10))
        drawing.add(f"outer race {k}", tube(hub + y * Y, Y, 15, 18, 10))
    drawing.add("axle washer", tube(hub + 70 * Y, Y, 9, 14, 1))
    drawing.add("axle nut", hexagon(hub + 71 * Y, Y, 13, 8, 9))
    drawing.joint("Revolute", "strut", "airframe", origin, Y)
    drawing.joint("Cylindrical", "piston", "strut", origin, Z)
    drawing.joint("Weld", "lower bearing", "strut")
    drawing.joint("Revolute", "upper torque link", "strut", torque[0], Y)
    drawing.joint("Revolute", "lower torque link", "upper torque link", torque[1], Y)
    drawing.joint("Revolute", "lower torque link", "piston", torque[2], Y)
    drawing.joint("Revolute", "lower brace", "strut", brace, Y)
    drawing.joint("Revolute", "lower brace", "upper brace", knee, Y)
    drawing.joint("Revolute", "upper brace", "airframe", roof, Y)
    drawing.joint("Revolute", "barrel", "airframe", back, Y)
    drawing.joint("Weld", "gland", "barrel")
    drawing.joint("Cylindrical", "ram", "barrel", back, way)
    drawing.joint("Weld", "ram eye", "ram")
    drawing.joint("Revolute", "ram eye", "strut", rear, Y)
    drawing.joint("Revolute", "wheel", "piston", hub, Y)
    return drawing


def push_rod(drawing: Drawing, name: str, ends, axes) -> None:
    """A tube with rod ends on balls, and their lock nuts."""
    way = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    length = float(np.linalg.norm(ends[1] - ends[0]))
    drawing.add(f"{name} tube", tube(ends[0] + 22 * way, way, 5, 7, length - 44))
    for k, (middle, axis) in enumerate(zip(ends, axes, strict=True)):
        along = way if k == 0 else -way
        eye = union(cyl(middle - 3.5 * axis, axis, 11, 7), cyl(middle + 9 * along, along, 5, 21))
        drawing.add(f"{name} end {k}", cut(eye, sphere(middle, 8)))
        slab = cyl(middle - 5 * axis, axis, 20, 10)
        drawing.add(f"{name} ball {k}", cut(sphere(middle, 8).intersect(slab), bore(middle, axis, 3, 20)))
        drawing.add(f"{name} lock nut {k}", hexagon(middle + 19 * along, along, 7, 3, 5))
        drawing.joint("Weld", f"{name} end {k}", f"{name} tube")


@kind
def flap_controls(random):
    """A lever, a bell crank on a bearing, two push rods with rod ends, a flap on three lugs, one without its pin."""
    drawing, play, arm = Drawing(["spar"]), random.choice([0.0, 0.05]), random.uniform(42, 55)
    crank, lever, hinges = at(0, 0, 0), at(-130, 0, 0), [at(x, -150, 0) for x in (-80, 0, 80)]
    spar = [box((-160, -160, -30), (160, 80, -20))]
    for p in (crank, lever):
        spar.append(box(p + at(-12, -14, -22), p + at(12, 12, -4)))
        spar += [box(p + at(-12, -24, -22), p + at(12, -14, 8)), box(p + at(-12, -24, 4), p + at(12, 12, 8))]
    forks = [box(p + at(s * 5 - 1.8, -7, -22), p + at(s * 5 + 1.8, 7, 6)) for p in hinges for s in (-1, 1)]
    pivots = [bore(p, Z, 4, 17) for p in (crank, lever)]
    drawing.add("spar", cut(union(*spar, *forks), *pivots, bore((0, -150, 0), X, 2.5)))
    a, b, tip = crank + arm * Y, crank + arm * X, lever + arm * Y
    bell = cut(union(bar(crank, a, 9, -3, 3), bar(crank, b, 9, -3, 3), cyl((0, 0, -3), Z, 13, 6)), bore(crank, Z, 8, 9))
    drawing.add("bell crank", cut(bell, *(bore(p, Z, 3, 9) for p in (a, b))))
    drawing.add("crank bearing", tube((0, 0, -3.5), Z, 4, 8, 7))
    drawing.add("lever", cut(bar(lever, tip, 9, -3, 3), bore(lever, Z, 4 + play, 9), bore(tip, Z, 3, 9)))
    for name, p in (("crank", crank), ("lever", lever)):
        drawing.add(f"{name} bolt", screw(p + 8 * Z, -Z, 4, 24))
    horn = at(b[0], -150, 30)
    flap = [box((-100, -260, -4), (100, -162, 4)), *(box(p + at(-3, -15, -5), p + at(3, 6, 5)) for p in hinges)]
    flap.append(box(horn + at(-8, -22, -26), horn + at(-5, 10, 10)))
    drawing.add("flap", cut(union(*flap), bore((0, -150, 0), X, 2.5 + play), bore(horn, X, 3, 12)))
    for k in (0, 2):
        drawing.add(f"hinge pin {k}", headed(hinges[k] - 6.8 * X, X, 2.5, 16))
    push_rod(drawing, "rod 1", (tip + 8 * Z, a + 8 * Z), (Z, Z))
    push_rod(drawing, "rod 2", (b + 8 * Z, horn), (Z, X))
    for name, p, axis in (("tip", tip + 8 * Z, Z), ("a", a + 8 * Z, Z), ("b", b + 8 * Z, Z), ("horn", horn, X)):
        drawing.add(f"bolt {name}", screw(p + 5 * axis, -axis, 3, 18))
        drawing.add(f"nut {name}", hexagon(p - (14 if axis is Z else 13) * axis, axis, 5, 3 if axis is Z else 5, 3))
    drawing.joint("Revolute", "lever", "spar", lever, Z)
    drawing.joint("Revolute", "bell crank", "spar", crank, Z)
    drawing.joint("Revolute", "flap", "spar", hinges[1], X)
    drawing.joint("Spherical", "rod 1 end 0", "lever", tip + 8 * Z)
    drawing.joint("Spherical", "rod 1 end 1", "bell crank", a + 8 * Z)
    drawing.joint("Spherical", "rod 2 end 0", "bell crank", b + 8 * Z)
    drawing.joint("Spherical", "rod 2 end 1", "flap", horn)
    return drawing


@kind
def hand_cart(random):
    """A turning beam with wheels on ball bearings and circlips, a live axle with keyed wheels in blocks on a frame."""
    drawing, track = Drawing(["chassis"]), random.uniform(110, 150)
    front, rear = at(150, 0, -60), at(-150, 0, -40)
    blocks = [at(-150, s * 70, -40) for s in (-1, 1)]
    feet = [p + at(x, 0, 40) for p in blocks for x in (-22, 22)]
    chassis = union(box((-200, -90, 0), (200, 90, 8)), tube((150, 0, -12), Z, 8, 25, 12))
    drawing.add("chassis", cut(chassis, bore((150, 0, 0), Z, 8, 40), *(bore(p, Z, 3.2, 20) for p in feet)))
    beam = union(box((135, -track + 40, -75), (165, track - 40, -45)), cyl((150, 0, -45), Z, 25, 32.5))
    ends = [cyl(front + s * (track - 45) * Y, s * Y, 8, 55) for s in (-1, 1)]
    grooves = [tube(front + s * (track - 4) * Y, s * Y, 7.4, 9, 1.4) for s in (-1, 1)]
    drawing.add("beam", cut(union(beam, *ends), bore((150, 0, 0), Z, 8, 90), *grooves))
    drawing.add("king bolt", screw((150, 0, 8), -Z, 7.9, 100))
    drawing.add("king nut", hexagon((150, 0, -86), Z, 12, 10, 7.9))
    drawing.add("slide ring", tube((150, 0, -12.5), Z, 8.2, 25, 0.5))
    for s in (-1, 1):
        side, low = s * Y, front + s * (track - 38) * Y
        wheel = cut(tube(low, side, 11, 55, 34), cyl(low, side, 16, 8), cyl(low + 26 * side, side, 16, 8))
        drawing.add(f"front wheel {s}", wheel)
        for k, at_y in enumerate((0.0, 26.0)):
            place = low + at_y * side
            middle, turns = place + 4 * side, np.arange(7) * 2 * np.pi / 7
            drawing.add(f"inner {s} {k}", cut(tube(place, side, 8, 10.5, 8)))
            drawing.add(f"outer {s} {k}", cut(tube(place, side, 13.5, 16, 8)))
            balls = [sphere(middle + 12 * at(np.cos(a), 0, np.sin(a)), 1.5) for a in turns]
            drawing.add(f"balls {s} {k}", union(*balls))
        drawing.add(f"sleeve {s}", tube(low + 8 * side, side, 8.1, 10, 18))
        clip = cut(
            tube(front + s * (track - 4) * Y, side, 7.4, 11, 1.2), box(front + at(-2, -300, 5), front + at(2, 300, 15))
        )
        drawing.add(f"circlip {s}", clip)
        drawing.joint("Revolute", f"front wheel {s}", "beam", front, Y)
    axle = cut(
        cyl(rear - (track - 10) * Y, Y, 10, 2 * track - 20),
        *(box(rear + at(-3, s * (track - 15), 6.5), rear + at(3, s * (track - 33), 12)) for s in (-1, 1)),
    )
    drawing.add("rear axle", axle)
    for s, p in zip((-1, 1), blocks, strict=True):
        block = union(
            box(p + at(-30, -9, 28), p + at(30, 9, 40)),
            cyl(p - 9 * Y, Y, 22, 18),
            box(p + at(-20, -9, 0), p + at(20, 9, 30)),
        )
        drawing.add(
            f"block {s}", cut(block, bore(p, Y, 13, 20), *(cyl(p + at(x, 0, 25), Z, 2.5, 16) for x in (-22, 22)))
        )
        drawing.add(f"bush {s}", tube(p - 10 * Y, Y, 10.05, 13, 20))
        hub = rear + s * (track - 38) * Y
        slot = box(hub + at(-3, -60, 5), hub + at(3, 60, 12.8))
        drawing.add(f"rear wheel {s}", cut(tube(hub, s * Y, 10, 45, 26), slot))
        drawing.add(f"key {s}", box(rear + at(-3, s * (track - 15), 6.5), rear + at(3, s * (track - 33), 12.6)))
        drawing.joint("Weld", f"block {s}", "chassis")
        drawing.joint("Weld", f"bush {s}", f"block {s}")
        drawing.joint("Weld", f"rear wheel {s}", "rear axle")
        drawing.joint("Revolute", "rear axle", f"bush {s}", rear, Y)
    drawing.joint("Revolute", "beam", "chassis", (150, 0, 0), Z)
    return drawing
