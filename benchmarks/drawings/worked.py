"""The arms of a skid-steer loader, a scotch yoke actuator of a valve, and the vertical axis of a printer."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import balls, capscrew, nut, plate, ram, rings, stepper, upright, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import X, Y, Z, at, bore, box, cut, cyl, headed, tube, union


@kind
def skid_loader_arms(random: np.random.Generator) -> Drawing:
    """Two arms with a cross tube, bushes, flag pins screwed to the chassis, lift and tilt cylinders, a bucket.

    Truth: the arms, one with cross tube, lugs, bosses and bushes, turn about y on the chassis, the bucket on the arms;
    each cylinder turns on its pin, its rod slides in it and turns on its own pin. Two freedoms.
    """
    d, play, wide = Drawing(["Chassis"]), random.choice([0.0, 0.1, 0.25]), 120
    root, knee, nose = at(0, 0, 130), at(random.uniform(240, 280), 0, 60), at(340, 0, random.uniform(-60, -20))
    foot, lift = at(60, 0, -20), at(150, 0, 112)
    lug, dump = at(215, 0, 135), nose + at(12, 0, 66)
    chassis = box((-80, -150, -60), (70, 150, -40))
    boom = []
    for tag, side in (("LH", 1), ("RH", -1)):

        def slab(points, low, high, half, side=side):
            return upright([p[::2] for p in points], *sorted((side * (wide + low), side * (wide + high))), half)

        def pin(point, low, high, radius, side=side):
            """A pin with its head on the outside."""
            return headed(point + side * (wide + high) * Y, -side * Y, radius, high - low)

        def across(point, low, high, inner, outer, side=side):
            return tube(point + side * (wide + low) * Y, side * Y, inner, outer, high - low)

        chassis = chassis.union(slab([root, at(-60, 0, -45), at(60, 0, -45)], -14, -2, 22))
        chassis = chassis.union(slab([root, at(-60, 0, -45)], 14, 26, 20)).union(
            slab([foot, at(60, 0, -50)], -58, -46, 18)
        )
        arm = union(slab([root, knee], 0, 12, 20), slab([knee, nose], 0, 12, 18))
        arm = cut(arm, bore(root, Y, 13), bore(nose, Y, 12), bore(lift, Y, 8 + play))
        d.add(f"Loader arm {tag}", arm)
        fast(d, f"Loader arm {tag}", **{f"Bushing A {tag}": across(root, 0, 12, 10 + play, 13)})
        fast(d, f"Loader arm {tag}", **{f"Bushing B {tag}": across(nose, 0, 12, 9 + play, 12)})
        fast(d, f"Loader arm {tag}", **{f"Boss {tag}": across(lift, -14, 0, 8 + play, 14)})
        flag = pin(root, -14, 26, 10).union(
            box(root + at(0, side * (wide + 26), -6), root + at(34, side * (wide + 31), 6))
        )
        screw_at = root + at(26, side * (wide + 31), 0)
        chassis = chassis.union(slab([root, root + 26 * X], 14, 26, 14)).cut(bore(screw_at, Y, 3, 17))
        d.add(f"Flag pin {tag}", flag.cut(bore(screw_at, Y, 3.3, 17)))
        d.add(f"M6 flag screw {tag}", capscrew(screw_at, -side * Y, 3, 16))
        weld(d, "Chassis", f"Flag pin {tag}", f"M6 flag screw {tag}")
        barrel, rod = ram(foot, lift, Y, 12, 7, 8, 28, 85)
        move = (0, side * (wide - 30), 0)
        d.add(f"Lift barrel {tag}", barrel.translate(move))
        d.add(f"Lift rod {tag}", rod.translate(move))
        d.add(f"Pin F {tag}", pin(foot, -60, -2, 8 - play))
        d.add(f"Pin G {tag}", pin(lift, -48, 12, 8 - play))
        for word, point in (("F", foot), ("G", lift)):
            low = -60 if word == "F" else -46
            d.add(f"DIN471-16 {word} {tag}", across(point, low, low + 1.5, 8 - play, 11))
            weld(d, f"Pin {word} {tag}", f"DIN471-16 {word} {tag}")
            weld(d, "Chassis" if word == "F" else f"Loader arm {tag}", f"Pin {word} {tag}")
        d.add(f"Bucket pin {tag}", pin(nose, -14, 12, 9))
        turns(d, ("Chassis", f"Loader arm {tag}", root, Y), (f"Loader arm {tag}", "Bucket", nose, Y))
        turns(d, ("Chassis", f"Lift barrel {tag}", foot, Y), (f"Lift rod {tag}", f"Loader arm {tag}", lift, Y))
        d.joint("Cylindrical", f"Lift barrel {tag}", f"Lift rod {tag}", foot + at(*move), lift - foot)
        boom.append(f"Loader arm {tag}")
    d.add("Chassis", cut(chassis, bore(root, Y, 10), bore(foot, Y, 8)))
    middle = at(215, 0, 0)
    middle[2] = root[2] + (knee[2] - root[2]) * 215 / knee[0]
    lugs = [upright([middle[::2], (lug + 25 * Z)[::2]], low, low + 10, 14) for low in (-25, 15)]
    lug = lug + 25 * Z
    fast(d, boom[0], Torque_tube=cyl(middle - wide * Y, Y, 16, 2 * wide))
    weld(d, boom[1], "Torque tube")
    for k, shape in enumerate(lugs):
        fast(d, "Torque tube", **{f"Tilt lug {k}": cut(shape, bore(middle, Y, 16), bore(lug, Y, 7))})
    body = [at(nose[0] + 30, 0, nose[2] - 30), at(nose[0] + 30, 0, nose[2] + 50), at(nose[0] + 130, 0, nose[2] - 30)]
    bucket = upright([p[::2] for p in body], -150, 150, 6)
    ears = [upright([nose[::2], (nose + 34 * X)[::2]], *sorted((s * (wide - 14), s * (wide - 2))), 15) for s in (-1, 1)]
    ears += [upright([dump[::2], (nose + at(34, 0, 30))[::2]], low, low + 10, 13) for low in (-22, 12)]
    d.add("Bucket", cut(union(bucket, *ears), bore(nose, Y, 9), bore(dump, Y, 7)))
    long = float(np.linalg.norm(dump - lug))
    barrel, rod = ram(lug, dump, Y, 11, 6, 7, 20, 0.5 * long, foot_width=29)
    d.add("Tilt barrel", barrel)
    d.add("Tilt rod", rod)
    for word, point, half in (("T", lug, 25), ("H", dump, 22)):
        d.add(f"Pin {word}", headed(point - half * Y, Y, 7 - play, 2 * half + 2))
        d.add(f"DIN471-14 {word}", tube(point + half * Y, Y, 7 - play, 10, 1.2))
        weld(d, f"Pin {word}", f"DIN471-14 {word}")
        weld(d, "Tilt lug 0" if word == "T" else "Bucket", f"Pin {word}")
    turns(d, ("Tilt lug 0", "Tilt barrel", lug, Y), ("Tilt rod", "Bucket", dump, Y))
    d.joint("Cylindrical", "Tilt barrel", "Tilt rod", lug, dump - lug)
    return d


@kind
def scotch_yoke_actuator(random: np.random.Generator) -> Drawing:
    """A piston on a rod with a guide block, a shoe on its pin in the slot of a yoke, keyed to a stem; tie rods, nuts.

    Truth: the stem, one with yoke and key, turns about z; rod, block, pin and piston slide along x as one; the shoe
    turns on the pin and slides in the slot. One freedom.
    """
    d, play = Drawing(["Body"]), random.choice([0.02, 0.05, 0.15])
    place = random.uniform(-34, 34)
    pin = at(place, 42, 0)
    along = pin / np.linalg.norm(pin)
    turn = np.degrees(np.arctan2(along[1], along[0]))
    body = box((-110, -50, -36), (110, 100, 36)).cut(box((-100, -40, -28), (100, 90, 40)))
    rod, guide = at(0, 42, 20), at(0, 72, 20)
    holes = [at(x, y, 44) for x in (-105, 105) for y in (-45, 95)]
    body = cut(
        body,
        bore((0, 0, -36), Z, 13, 10),
        bore(rod, X, 11, 200),
        bore(guide, X, 6, 200),
        *(cyl(p - 28 * Z, Z, 2.5, 30) for p in holes),
    )
    stays = [at(110, 42 + a * 38, 20 + b * 30) for a in (-1, 1) for b in (-1, 1)]
    d.add("Body", body)
    cover = cut(
        box((-110, -50, 36), (110, 100, 44)), bore((0, 0, 40), Z, 13, 10), *(bore(p, Z, 2.7, 10) for p in holes)
    )
    fast(d, "Body", Cover=cover)
    for k, p in enumerate(holes):
        fast(d, "Cover", **{f"ISO 4762 M5x16 {k}": capscrew(p, -Z, 2.5, 16)})
    for k, (low, flip) in enumerate(((-36, 1), (44, -1))):
        bush = union(
            tube((0, 0, low), flip * Z, 10 + play, 13, 8), tube((0, 0, low + 8 * flip), flip * Z, 10 + play, 17, 3)
        )
        fast(d, "Body" if k == 0 else "Cover", **{f"Stem bush {k}": bush})
    key = box((-7, -3, -6), (-13, 3, 6))
    yoke = plate([(0, 0), (62, 0)], -7, 7, 20).cut(box((26, -8 - play, -9), (72, 8 + play, 9)))
    yoke = cut(yoke, bore((0, 0, 0), Z, 10), key)
    key, yoke = (each.rotate((0, 0, 0), (0, 0, 1), turn) for each in (key, yoke))
    d.add("Stem", cut(union(cyl((0, 0, -50), Z, 10, 110), box((-6, -6, 60), (6, 6, 72))), key))
    fast(d, "Stem", Key=key, Yoke=yoke)
    turns(d, ("Stem bush 0", "Stem", at(0, 0, 0), Z))
    block = box((place - 16, 28, 8), (place + 16, 86, 32))
    block = cut(block, bore(rod, X, 8, 200), bore(guide, X, 9, 200), cyl(pin, Z, 5, 11))
    d.add("Guide block", block)
    fast(d, "Guide block", Drive_pin=cyl(pin - 10 * Z, Z, 5, 21))
    fast(d, "Drive pin", Circlip=tube((place, 42, -8.2), Z, 5, 8, 1.2))
    shoe = box((-11, -8, -6.9), (11, 8, 6.9)).cut(bore((0, 0, 0), Z, 5 + play, 20)).rotate((0, 0, 0), (0, 0, 1), turn)
    d.add("Shoe", shoe.translate((place, 42, 0)))
    turns(d, ("Drive pin", "Shoe", pin, Z))
    d.joint("Prismatic", "Shoe", "Yoke", pin, along)
    fast(d, "Guide block", Guide_bush=tube(guide + (place - 16) * X, X, 6 + play, 9, 32))
    fast(d, "Body", Guide_bar=cyl(guide - 110 * X, X, 6, 220))
    end = place + 175
    fast(d, "Guide block", Piston_rod=cyl(at(place - 60, 42, 20), X, 8, 225).union(cyl(at(end - 10, 42, 20), X, 6, 32)))
    fast(d, "Body", Rod_bush=tube(at(100, 42, 20), X, 8 + play, 11, 10))
    fast(d, "Body", Travel_stop=cyl(at(-125, 42, 20), X, 11, 25))
    fast(
        d,
        "Body",
        Flange=cut(box((110, -4, -18), (122, 88, 58)), bore(rod, X, 8.5, 300), *(bore(p, X, 4, 60) for p in stays)),
    )
    fast(d, "Flange", Tube=tube(at(122, 42, 20), X, 34, 37, 130))
    fast(d, "Tube", End_cap=cut(box((252, -4, -18), (264, 88, 58)), *(bore(p, X, 4.2, 190) for p in stays)))
    for k, p in enumerate(stays):
        fast(d, "End cap", **{f"Tie rod {k}": cyl(p, X, 4, 166), f"Nut M8 {k}": nut(p + 154 * X, X, 4)})
    piston = tube(at(place + 165, 42, 20), X, 6, 34 - play, 16)
    fast(d, "Piston rod", Piston=piston, Piston_nut=nut(at(place + 181, 42, 20), X, 6))
    d.joint("Prismatic", "Body", "Guide block", pin, X)
    return d


@kind
def printer_z_axis(random: np.random.Generator) -> Drawing:
    """Two motors with couplings, lead screws in bearings above, smooth rods, ends with brass nuts, a carriage between.

    Truth: ends, one with nuts, bearings and the rods between them, slide along z as one; the carriage slides along x;
    each lead screw, one with its coupling, turns on its motor's shaft and in the bearing above.
    """
    d, play = Drawing(["Base profile"]), random.choice([0.0, 0.02, 0.1])
    high, run = random.uniform(90, 190), random.uniform(-60, 60)
    d.add("Base profile", box((-190, -10, -20), (190, 10, 0)))
    fast(
        d,
        "Base profile",
        **{f"Upright profile {k}": box((x, -10, 0), (x + 20, 10, 300)) for k, x in enumerate((-190, 170))},
    )
    fast(d, "Upright profile 0", Top_profile=box((-190, -10, 300), (190, 10, 320)))
    weld(d, "Upright profile 1", "Top profile")
    for k, side in enumerate((-1, 1)):
        spin, rod = at(side * 140, -40, 0), at(side * 140 + 17 * side, -40, 0)
        mount = box(spin + at(-24, -24, 6), spin + at(24, 50, 10)).cut(cyl(spin, Z, 11.2, 30))
        mount = mount.cut(bore(rod, Z, 4))
        mount = mount.union(box(spin + at(-24, 26, 0), spin + at(24, 30, 10))).cut(box((-190, -10, -5), (190, 60, 5)))
        mount = mount.cut(box((-200, -10, 0), (-170, 10, 20))).cut(box((170, -10, 0), (200, 10, 20)))
        mount = mount.union(box(spin + at(-24, 24, -20), spin + at(24, 30, 6)))
        fast(d, "Base profile", **{f"Z motor mount {k}": mount})
        fast(d, f"Z motor mount {k}", **{f"NEMA17 {k}": stepper(spin + 6 * Z, X, Z)})
        coupling = tube(spin + 12 * Z, Z, 2.5, 9, 13).union(tube(spin + 25 * Z, Z, 4, 9, 12))
        d.add(f"Flex coupling {k}", coupling.cut(cyl(spin + at(6, 0, 18), X, 1.5, 4)))
        fast(
            d,
            f"Flex coupling {k}",
            **{
                f"T8 lead screw {k}": cyl(spin + 29 * Z, Z, 4, 290),
                f"Set screw {k}": cyl(spin + at(6, 0, 18), X, 1.5, 3.5),
            },
        )
        turns(d, (f"NEMA17 {k}", f"Flex coupling {k}", spin, Z))
        fast(d, f"Z motor mount {k}", **{f"Smooth rod {k}": cyl(rod + 6 * Z, Z, 4, 312)})
        cap = (
            box(spin + at(-18, -18, 304), spin + at(26, 30, 316))
            if side > 0
            else box(spin + at(-26, -18, 304), spin + at(18, 30, 316))
        )
        cap = cut(cap, bore(rod, Z, 4, 400), bore(spin, Z, 11, 400))
        fast(d, "Top profile", **{f"Top bracket {k}": cap})
        inner, outer = rings(spin + 305 * Z, Z, 4, 11, 7)
        fast(d, f"Top bracket {k}", **{f"608 outer {k}": outer})
        fast(d, f"T8 lead screw {k}", **{f"608 inner {k}": inner})
        for n, each in enumerate(balls(spin + 305 * Z, Z, 4, 11, 7, 7)) if k == 0 else ():
            d.add(f"608 ball {n}", each)
        end = box(spin + at(-20, -20, high), spin + at(20, 16, high + 46))
        end = end.union(box(spin + at(17 * side - 11, -11, high), spin + at(17 * side + 11, 11, high + 46)))
        end = end.cut(bore(rod, Z, 7.5, 400)).cut(bore(spin, Z, 5.2, 400))
        bars = [at(0, -60, high + z) for z in (8, 38)]
        end = cut(
            end.union(box(spin + at(-12, -27, high), spin + at(12, -15, high + 46))),
            *(bore(p, X, 3, 149) for p in bars),
        )
        screws = [spin + at(8 * np.cos(t), 8 * np.sin(t), 0) for t in (np.pi / 2, -np.pi / 2)]
        end = cut(end, *(cyl(p + high * Z, Z, 1.5, 12) for p in screws))
        d.add(f"X end {k}", end)
        brass = union(tube(spin + (high - 4) * Z, Z, 4, 11, 4), tube(spin + high * Z, Z, 4, 5.2, 12))
        fast(d, f"X end {k}", **{f"T8 nut {k}": cut(brass, *(bore(p, Z, 1.7, 400) for p in screws))})
        for n, p in enumerate(screws):
            fast(d, f"X end {k}", **{f"M3x12 {k}{n}": capscrew(p + (high - 4) * Z, Z, 1.5, 12)})
        fast(d, f"X end {k}", **{f"LM8UU {k}": tube(rod + (high + 11) * Z, Z, 4 + play, 7.5, 24)})
        d.joint("Prismatic", f"Upright profile {k}", f"X end {k}", rod, Z)
    for n, p in enumerate(bars):
        fast(d, "X end 0", **{f"X rod {n}": cyl(p - 148 * X, X, 3, 296)})
        weld(d, "X end 1", f"X rod {n}")
    cart = box((run - 25, -90, high), (run + 25, -52, high + 46))
    d.add("X carriage", cut(cart, *(bore(p, X, 6, 400) for p in bars), cyl((run, -80, high - 1), Z, 4, 20)))
    for n, p in enumerate(bars):
        fast(d, "X carriage", **{f"LM6UU {n}": tube(p + (run - 20) * X, X, 3 + play, 6, 19)})
    fast(d, "X carriage", Hotend=union(cyl((run, -80, high - 20), Z, 2, 22), cyl((run, -80, high - 14), Z, 4, 33)))
    d.joint("Prismatic", "X end 0", "X carriage", bars[0], X)
    return d
