"""What is pressed, clamped and shut: a toggle press, a valve train, a gate valve, a screw clamp, a Geneva drive."""

from __future__ import annotations

import numpy as np

from drawings.drawing import Drawing, kind
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, meet, screw, sphere, torus, tube, union


@kind
def toggle_press(random):
    """A handle and links on pins with circlips, a square ram in a channel under a cover, a tool with a grub screw."""
    drawing, play = Drawing(["frame"]), random.choice([0.05, 0.15])
    hinge, slide = at(0, 170, 0), random.choice([0.0, 0.03])
    pin = at(0, random.uniform(86, 92), 0)
    knee = at(*meet(pin[:2], 42, hinge[:2], 44), 0)
    frame = union(
        box((-60, -10, -40), (60, 0, 40)),
        box((-40, 0, -30), (40, 185, -18)),
        box((-18, 30, -18), (-8, 75, 10)),
        box((8, 30, -18), (18, 75, 10)),
        box((-8, 30, -18), (8, 75, -8)),
        box((-10, 160, -18), (10, 185, -12)),
    )
    covers = [at(x, y, 10) for x in (-13, 13) for y in (38, 67)]
    frame = cut(
        frame, bore(hinge, Z, 5, 40), *(cyl(p - 12 * Z, Z, 1.7, 13) for p in covers), cyl((0, -10, 0), Y, 4, 10)
    )
    drawing.add("frame", frame)
    ram = box((-8 + slide, 20, -8 + slide), (8 - slide, 74, 8 - slide))
    ram = union(ram, box((-8 + slide, 74, -4), (8 - slide, pin[1] + 9, 4)))
    ram = cut(ram, bore(pin, Z, 4 + play, 20), cyl((0, 20, 0), Y, 5, 18), cyl((0, 30, 8), -Z, 1.7, 8))
    drawing.add("ram", ram)
    cover = cut(box((-18, 30, 10), (18, 75, 16)), *(bore(p, Z, 2.1, 10) for p in covers))
    drawing.add("cover", union(cover, box((-7, 30, 8), (7, 75, 10))))
    for k, p in enumerate(covers):
        drawing.add(f"cover screw {k}", screw(p + 6 * Z, -Z, 2, 15))
    drawing.add("tool", union(cyl((0, 6, 0), Y, 5, 30), cyl((0, 6, 0), Y, 9, 13)))
    drawing.add("tool screw", cut(cyl((0, 30, 5), Z, 2, 2.5), hexagon((0, 30, 6), Z, 1, 3)))
    upper = cut(
        union(bar(hinge, knee, 9, -5, 5), bar(knee, knee + at(20, 130, 0) * at(np.sign(knee[0]), 1, 1), 9, -5, 5))
    )
    drawing.add("handle", cut(upper, bore(hinge, Z, 5 + play, 20), bore(knee, Z, 4 + play, 20)))
    for s in (-1, 1):
        heights = sorted((s * 5.3, s * 10.3))
        drawing.add(f"link {s}", bar(pin, knee, 9, *heights, (pin, knee), 4 + play))
        drawing.joint("Revolute", f"link {s}", "handle", knee, Z)
        drawing.joint("Revolute", f"link {s}", "ram", pin, Z)
    drawing.add("front ear", cut(box((-10, 160, 12), (10, 185, 18)), bore(hinge, Z, 5, 40), bore((0, 180, 15), X, 1.5)))
    drawing.add("ear bridge", box((-10, 185, -18), (10, 191, 18)))
    drawing.joint("Weld", "ear bridge", "frame")
    drawing.joint("Weld", "front ear", "ear bridge")
    for name, p, radius, reach in (("hinge", hinge, 5, 32.0), ("knee", knee, 4, 12.0), ("ram", pin, 4, 12.0)):
        ends = ((-1, reach), (1, 20.0 if name == "hinge" else reach))
        grooves = [tube(p + s * (end - 1.6) * Z, s * Z, radius - 0.5, radius + 2, 0.9) for s, end in ends]
        drawing.add(f"{name} pin", cut(cyl(p - reach * Z, Z, radius, reach + ends[1][1]), *grooves))
        for s, end in ends:
            ring = tube(p + s * (end - 1.6) * Z, s * Z, radius - 0.5, radius + 2, 0.8)
            drawing.add(f"{name} clip {s}", cut(ring, box(p + at(-1, 3, -40), p + at(1, 12, 40))))
    drawing.joint("Weld", "cover", "frame")
    drawing.joint("Weld", "tool", "ram")
    drawing.joint("Revolute", "handle", "frame", hinge, Z)
    drawing.joint("Prismatic", "ram", "frame", pin, Y)
    return drawing


@kind
def valve_train(random):
    """A camshaft under caps, a rocker with a set screw on a shaft, a valve in its guide with spring and collets."""
    drawing, play = Drawing(["head"]), random.choice([0.0, 0.03])
    stem, cam, shaft = at(0, 0, 0), at(random.uniform(58, 66), 0, 62), at(32, 0, 92)
    head = union(
        box((-30, -40, -40), (80, 40, 20)),
        *(box(at(cam[0] - 18, y, 20), at(cam[0] + 18, y + 12, 62)) for y in (-34, 22)),
    )
    head = union(head, *(box((22, y, 20), (42, y + 10, 104)) for y in (-22, 12)))
    head = cut(
        head,
        bore(stem, Z, 6, 60),
        cyl((0, 0, -41), Z, 16, 13),
        bore(cam, Y, 10, 60),
        bore(shaft, Y, 7, 60),
        *(cyl(at(cam[0] + x, y, 40), Z, 2.5, 30) for x in (-14, 14) for y in (-28, 28)),
    )
    drawing.add("head", head)
    for k, y in enumerate((-34, 22)):
        cap = cut(box(at(cam[0] - 18, y, 62), at(cam[0] + 18, y + 12, 80)), bore(cam, Y, 10, 60))
        drawing.add(f"cap {k}", cut(cap, *(bore(at(cam[0] + x, y + 6, 70), Z, 3.2, 20) for x in (-14, 14))))
        for n, x in enumerate((-14, 14)):
            drawing.add(f"cap screw {k}{n}", screw(at(cam[0] + x, y + 6, 80), -Z, 3, 34))
        drawing.joint("Weld", f"cap {k}", "head")
    lobe = union(
        cyl(cam - 6 * Y, Y, 13, 12),
        bar((0, 0), (-6, 0), 9, -6, 6).rotate((0, 0, 0), (1, 0, 0), 90).translate(tuple(cam.tolist())),
    )
    collars = [cyl(cam + s * 21.8 * Y, -s * Y, 13, 4) for s in (-1, 1)]
    drawing.add("camshaft", union(cyl(cam - 50 * Y, Y, 10 - play, 100), lobe, *collars))
    drawing.add("sprocket", cut(tube(cam - 50 * Y, Y, 10 - play, 30, 8)))
    drawing.add("sprocket pin", cyl(cam - 46 * Y + 5 * Z, Z, 2, 25))
    for name in ("sprocket", "camshaft"):
        drawing.parts[name] = cut(drawing.parts[name], cyl(cam - 46 * Y + 5 * Z, Z, 2, 30))
    drawing.add("rocker shaft", cyl(shaft - 25 * Y, Y, 7, 50))
    rocker = union(
        cyl(shaft - 11.8 * Y, Y, 13, 23.6),
        box(at(-8, -7, 90), at(34, 7, 100)),
        box(at(32, -7, 86), at(cam[0] + 4, 7, 98)),
    )
    drawing.add("rocker", cut(rocker, bore(shaft, Y, 7 + play, 30), bore((0, 0, 95), Z, 3, 20)))
    drawing.add("set screw", union(cyl((0, 0, 86), Z, 3, 22), sphere((0, 0, 86), 3)))
    drawing.add("lock nut", hexagon((0, 0, 100), Z, 5, 4, 3))
    drawing.add("guide", tube((0, 0, -20), Z, 3.5 + play, 6, 55))
    valve = union(cyl((0, 0, -36), Z, 3.5, 119), cyl((0, 0, -40), Z, 15, 4))
    drawing.add("valve", cut(valve, tube((0, 0, 74), Z, 2.9, 5, 2)))
    drawing.add("seat", cut(cyl((0, 0, -40), Z, 16, 6), bore((0, 0, -40), Z, 15.2, 9)))
    retainer = cut(union(cyl((0, 0, 70), Z, 12, 3), cyl((0, 0, 66), Z, 8, 4)), cyl((0, 0, 60), Z, 6, 20))
    drawing.add("retainer", retainer)
    ring = union(tube((0, 0, 66), Z, 3.5, 6, 7), tube((0, 0, 74.2), Z, 2.9, 3.6, 1.6), tube((0, 0, 73), Z, 3.5, 6, 2))
    for k, s in enumerate((-1, 1)):
        drawing.add(f"collet {k}", ring.intersect(box((-20, s * 0.1, 60), (20, s * 20, 80))))
        drawing.joint("Weld", f"collet {k}", "valve")
    drawing.add("spring", union(*(torus((0, 0, z), Z, 9.5, 1.25) for z in np.linspace(21.3, 68.6, 9))))
    drawing.joint("Revolute", "camshaft", "head", cam, Y)
    drawing.joint("Weld", "sprocket", "camshaft")
    drawing.joint("Revolute", "rocker", "head", shaft, Y)
    drawing.joint("Weld", "set screw", "rocker")
    drawing.joint("Weld", "guide", "head")
    drawing.joint("Weld", "retainer", "valve")
    drawing.joint("Cylindrical", "valve", "guide", stem, Z)
    return drawing


@kind
def gate_valve(random):
    """A gate in guides, a stem in its slot, a bonnet and a yoke on bolts, a wheel on a square; in inches."""
    origin = at(0, 0, 0)
    drawing, play, lift = Drawing(["body"], unit="INCH"), random.choice([0.1, 0.25]), random.uniform(15, 30)
    body = union(cyl((-60, 0, 0), X, 34, 120), box((-14, -40, -36), (14, 40, 80)), box((-30, -50, 70), (30, 50, 80)))
    body = union(body, *(cyl((s * 60 - 6, 0, 0), X, 50, 12) for s in (-1, 1)))
    flange = [at(x, y, 80) for x in (-22, 22) for y in (-42, -20, 20, 42)]
    rim = [at(s * 60, 42 * np.cos(a), 42 * np.sin(a)) for s in (-1, 1) for a in np.arange(4) * np.pi / 2 + 0.4]
    body = cut(body, bore((0, 0, 0), X, 24), box((-6, -30, -30), (6, 30, 90)), *(bore(p, Z, 3, 11) for p in flange))
    drawing.add("body", cut(body, *(bore(p, X, 4, 7) for p in rim)))
    gate = box((-6 + play, -30 + play, -29 + lift), (6 - play, 30 - play, 30 + lift))
    slot = union(box((-10, -4.2, 22 + lift), (10, 4.2, 31 + lift)), box((-10, -7.2, 17 + lift), (10, 7.2, 23.2 + lift)))
    drawing.add("gate", cut(gate, slot))
    bonnet = union(box((-30, -50, 80), (30, 50, 90)), cyl((0, 0, 90), Z, 18, 25), box((-16, -16, 90), (16, 16, 100)))
    bonnet = cut(
        bonnet, bore((0, 0, 90), Z, 4.2, 60), cyl((0, 0, 97), Z, 9, 30), *(bore(p + 5 * Z, Z, 3.2, 11) for p in flange)
    )
    drawing.add("bonnet", cut(bonnet, cyl((0, 0, 79), Z, 9, 3)))
    for k, p in enumerate(flange):
        drawing.add(f"stud {k}", cyl(p - 16 * Z, Z, 3, 34))
        drawing.add(f"stud nut {k}", hexagon(p + 10 * Z, Z, 5, 5, 3))
    drawing.add("packing", tube((0, 0, 97), Z, 4, 9, 12))
    drawing.add(
        "gland", cut(union(cyl((0, 0, 109), Z, 9, 8), cyl((0, 0, 117), Z, 17, 4)), bore((0, 0, 110), Z, 4.1, 40))
    )
    posts = [box((-8, s * 30 - 3, 90), (8, s * 30 + 3, 170)) for s in (-1, 1)]
    yoke = union(
        *posts,
        box((-14, -33, 170), (14, 33, 178)),
        *(box((-12, s * 31 - 9, 90), (12, s * 31 + 9, 94)) for s in (-1, 1)),
    )
    holes = [at(x, s * 37, 92) for x in (-0.0,) for s in (-1, 1)]
    drawing.add("yoke", cut(yoke, bore((0, 0, 174), Z, 8, 20), *(bore(p, Z, 2.1, 7) for p in holes)))
    drawing.parts["bonnet"] = cut(drawing.parts["bonnet"], *(cyl(p - 9 * Z, Z, 1.7, 9) for p in holes))
    sleeve = union(tube((0, 0, 170), Z, 4.1, 8, 14), tube((0, 0, 166), Z, 4.1, 12, 4))
    square = cut(box((-6.5, -6.5, 184), (6.5, 6.5, 196)), bore((0, 0, 190), Z, 4.1, 10))
    drawing.add("yoke sleeve", union(sleeve, square))
    drawing.add("sleeve washer", tube((0, 0, 178), Z, 8.1, 13, 1))
    wheel = union(
        tube((0, 0, 186), Z, 40, 50, 8),
        cyl((0, 0, 179), Z, 13, 17),
        *(cyl((0, 0, 190), at(np.cos(a), np.sin(a), 0), 4, 44) for a in np.arange(3) * 2.1),
    )
    drawing.add("hand wheel", cut(wheel, bore((0, 0, 179), Z, 8.1, 5), box((-6.5, -6.5, 183), (6.5, 6.5, 200))))
    stem = union(cyl((0, 0, 20 + lift), Z, 4, 210), box((-4, -7, 17.2 + lift), (4, 7, 23 + lift)))
    drawing.add("stem", stem)
    drawing.joint("Weld", "bonnet", "body")
    drawing.joint("Weld", "yoke", "bonnet")
    drawing.joint("Weld", "packing", "bonnet")
    drawing.joint("Weld", "gland", "bonnet")
    drawing.joint("Prismatic", "gate", "body", origin, Z)
    drawing.joint("Revolute", "yoke sleeve", "yoke", origin, Z)
    drawing.joint("Weld", "hand wheel", "yoke sleeve")
    drawing.joint("Cylindrical", "stem", "yoke sleeve", origin, Z)
    return drawing


@kind
def screw_clamp(random):
    """A bow, a screw in it with a ball in a pad, a handle that slides through its head."""
    drawing, radius, reach = Drawing(["bow"]), random.uniform(4, 6), random.uniform(20, 45)
    bow = cut(box((-12, -10, 0), (80, 10, 130)), box((-20, -20, 15), (62, 20, 108)))
    drawing.add("bow", cut(union(bow, cyl((0, 0, 100), Z, 13, 34)), bore((0, 0, 120), Z, radius, 40)))
    low = at(0, 0, 15 + reach)
    spindle = union(sphere(low, 0.8 * radius), cyl(low, Z, 0.55 * radius, 10), cyl(low + 8 * Z, Z, radius, 150 - reach))
    top = at(0, 0, 178)
    spindle = cut(union(spindle, cyl(top - 10 * Z, Z, 1.8 * radius, 22)), bore(top, X, 3.2, 30))
    drawing.add("spindle", spindle)
    pad = cut(cyl(low - 8 * Z, Z, 13, 11), sphere(low, 0.8 * radius), cyl(low, Z, 0.72 * radius, 9))
    drawing.add("pad", pad)
    shift = random.uniform(-15, 15)
    drawing.add("handle", cyl(top + (shift - 40) * X, X, 3, 80))
    for k, x in enumerate((-40.0, 40.0)):
        drawing.add(f"knob {k}", cut(sphere(top + (shift + x) * X, 5.5), cyl(top + (shift - 40) * X, X, 3, 80)))
        drawing.joint("Weld", f"knob {k}", "handle")
    drawing.joint("Cylindrical", "spindle", "bow", low, Z)
    drawing.joint("Spherical", "pad", "spindle", low)
    drawing.joint("Cylindrical", "handle", "spindle", top, X)
    return drawing


@kind
def geneva_drive(random):
    """A crank with a pressed pin and a locking disc, a slotted wheel, both on shafts in bushes with collars."""
    drawing, apart, play = Drawing(["plate"]), random.uniform(55, 70), random.choice([0.0, 0.05])
    arm = apart * np.sin(np.pi / 4)
    wheel, phase = at(apart, 0, 0), np.pi + random.uniform(-0.3, 0.3)
    plate = cut(box((-50, -60, -8), (apart + 60, 60, 0)), bore((0, 0, 0), Z, 7, 20), bore(wheel, Z, 7, 20))
    drawing.add("plate", plate)
    pin = arm * at(np.cos(phase), np.sin(phase), 0)
    stub = 0.95 * apart - arm
    disc = union(
        cyl((0, 0, 2), Z, 0.7 * arm, 4),
        bar((0, 0), pin, 7, 2, 6),
        cut(cyl((0, 0, 6), Z, 0.62 * arm, 5), cyl(wheel + 5 * Z, Z, 0.9 * arm + 3, 8)),
    )
    drawing.add("crank", cut(disc, bore(pin, Z, 2.5), bore((0, 0, 0), Z, 5 - play)))
    drawing.add("crank pin", cyl(pin + 2 * Z, Z, 2.5, 10))
    star = cyl(wheel + 7 * Z, Z, 0.9 * arm, 5)
    for a in np.arange(4) * np.pi / 2:
        u = at(np.cos(a + np.pi / 4), np.sin(a + np.pi / 4), 0)
        star = cut(star, bar(wheel + stub * u, wheel + 90 * u, 2.5 + play, 0, 20))
        v = at(np.cos(a), np.sin(a), 0)
        star = cut(star, cyl(wheel - apart * v + 2 * Z, Z, 0.62 * arm + 0.1, 20))
    drawing.add("star", cut(union(star, cyl(wheel + 7 * Z, Z, 9, 8)), bore(wheel, Z, 5 - play)))
    for name, p, top in (("crank", at(0, 0, 0), 12.0), ("star", wheel, 18.0)):
        drawing.add(f"{name} bush", union(tube(p - 8 * Z, Z, 5, 7, 8), tube(p - 0 * Z, Z, 5, 9, 1.5)))
        drawing.add(f"{name} shaft", cyl(p - 25 * Z, Z, 5 - play, 25 + top))
        drawing.add(f"{name} collar", cut(tube(p - 14 * Z, Z, 5 - play, 9, 5.5), cyl(p - 11 * Z, X, 1.5, 12)))
        drawing.add(f"{name} grub screw", cyl(p + at(5 - play, 0, -11), X, 1.5, 4))
        drawing.joint("Weld", f"{name} shaft", name)
        drawing.joint("Weld", f"{name} bush", "plate")
        drawing.joint("Weld", f"{name} collar", f"{name} shaft")
        drawing.joint("Revolute", name, "plate", p, Z)
    drawing.joint("Weld", "crank pin", "crank")
    return drawing
