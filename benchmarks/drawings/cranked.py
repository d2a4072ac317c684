"""An eccentric press with gibs, a radial engine of five cylinders, and a beam engine with guides."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.catalogued import bolt, nut, strut, upright, upright_at
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, hexagon, laid, meet, screw, sphere, tube, union


@kind
def eccentric_press(random: np.random.Generator) -> Drawing:
    """A crankshaft with flywheel in bushes, a split rod with a ball screw in the ram, gibs, a motor with a pulley.

    Truth: crankshaft and pulley turn about y; the rod, one with cap and ball screw, turns on the crankpin and swivels
    in the ram; the ram slides along z between the gibs, one with the frame. Two freedoms.
    """
    d, play, turn = Drawing(["Bati"]), random.choice([0.02, 0.05, 0.1]), random.uniform(-1.2, 4.2)
    long = random.uniform(135, 145)
    pin = at(15 * np.cos(turn), 0, 330 + 15 * np.sin(turn))
    low = pin[2] - np.sqrt(long**2 - pin[0] ** 2)
    ball, shaft = at(0, -16, low), at(0, 0, 330)
    way = (at(0, 0, low) - pin) / long
    frame = box((-70, 20, 0), (70, 140, 400)).union(box((-70, -80, 0), (70, 20, 40))).cut(bore(shaft, Y, 22))
    spots = [at(s * 52, -54, z) for s in (-1, 1) for z in (low - 70, low + 20)]
    d.add("Bati", cut(frame, *(cyl(p, Y, 3, 100) for p in spots)))
    front = union(tube(shaft + 14 * Y, Y, 18 + play, 28, 6), tube(shaft + 20 * Y, Y, 18 + play, 22, 40))
    rear = union(tube(shaft + 140 * Y, Y, 18 + play, 28, 2), tube(shaft + 100 * Y, Y, 18 + play, 22, 40))
    fast(d, "Bati", **{"Bague avant": front, "Bague arriere": rear})
    crank = union(cyl(shaft + 4 * Y, Y, 18, 168), cyl(shaft + 4 * Y, Y, 34, 10), cyl(pin - 36 * Y, Y, 14, 41))
    key = box(shaft + at(-3, 142, 12), shaft + at(3, 170, 22))
    d.add("Vilebrequin", cut(crank, key, bore(pin - 36 * Y, Y, 4, 20)))
    fast(
        d, "Vilebrequin", **{"Rondelle": tube(pin - 40 * Y, Y, 4.2, 20, 4), "Vis CHC M8": screw(pin - 40 * Y, Y, 4, 22)}
    )
    fast(d, "Vilebrequin", Clavette=key, Volant=cut(tube(shaft + 142 * Y, Y, 18, 90, 30), key))
    turns(d, ("Bati", "Vilebrequin", shaft, Y))

    def put(shape):
        return laid(shape, pin, way, Y)

    ring = union(cyl((0, 0, -34), Z, 26, 36), box((-16, -37, -34), (16, 37, 2)))
    holes = [bore((0, s * 28, -16), X, 4, 60) for s in (-1, 1)]
    ring = cut(ring, bore((0, 0, 0), Z, 14 + play), *holes)
    stem = box((20, -15, -31), (95, 15, -1)).cut(cyl((50, 0, -16), X, 9, 60))
    d.add("Bielle", put(ring.intersect(box((0, -60, -60), (60, 60, 60))).union(stem)))
    fast(d, "Bielle", Chapeau=put(ring.intersect(box((-60, -60, -60), (0, 60, 60)))))
    for k, s in enumerate((-1, 1)):
        fast(d, "Bielle", **{f"Boulon M8 {k}": put(bolt((-16, s * 28, -16), X, 4, 40))})
        fast(d, "Bielle", **{f"Ecrou M8 {k}": put(nut((16, s * 28, -16), X, 4))})
    end = at(long, 0, -16)
    fast(d, "Bielle", Vis_rotule=put(union(cyl((52, 0, -16), X, 9, long - 60), sphere(end, 13))))
    fast(d, "Vis rotule", Contre_ecrou=put(hexagon((95, 0, -16), X, 16, 10, 9)))
    turns(d, ("Bielle", "Vilebrequin", pin, Y))
    ram = box((-40, -44, low - 90), (40, 20, low + 11)).cut(cyl(ball + Z, Z, 22, 30))
    holes = [cyl(ball + s * 17 * X - 9 * Z, Z, 2, 60) for s in (-1, 1)]
    ram = cut(ram, sphere(ball, 13), cyl(ball, Z, 13, 5), cyl((0, -16, low - 91), Z, 10, 26), *holes)
    d.add("Coulisseau", ram)
    cap = cut(cyl(ball + Z, Z, 22, 10), sphere(ball, 13 + play), cyl(ball, Z, 10.5, 20), *holes)
    fast(
        d,
        "Coulisseau",
        Bague_de_retenue=cap,
        Poincon=union(cyl((0, -16, low - 125), Z, 6, 35), cyl((0, -16, low - 90), Z, 10, 25)),
    )
    for k, s in enumerate((-1, 1)):
        fast(d, "Coulisseau", **{f"Vis M4 {k}": screw(ball + s * 17 * X + 11 * Z, -Z, 2, 18)})
        side = union(box((40 + play, -54, 0), (64, 20, 140)), box((28, -54, 0), (64, -44 - play, 140)))
        side = cut(side, *(cyl(at(52, -54, z), Y, 3.2, 100) for z in (35, 125)))
        fast(d, "Bati", **{f"Lardon {k}": (side if s > 0 else side.mirror("YZ")).translate((0, 0, low - 105))})
    for k, p in enumerate(spots):
        fast(d, "Bati", **{f"Vis M6 {k}": screw(p, Y, 3, 100)})
    d.joint("Spherical", "Vis rotule", "Coulisseau", ball)
    d.joint("Prismatic", "Bati", "Coulisseau", ball, Z)
    axle = at(0, 130, 460)
    fast(d, "Bati", Moteur=union(box((-40, 60, 400), (40, 130, 500)), cyl(axle, Y, 8, 48)))
    d.add("Poulie", tube(axle + 14 * Y, Y, 8, 30, 30))
    turns(d, ("Moteur", "Poulie", axle, Y))
    return d


@kind
def radial_engine(random: np.random.Generator) -> Drawing:
    """Five finned cylinders on a crankcase, a master rod with four link rods, floating wrist pins, a built-up crank.

    Truth: the crank turns in its bearings; the master rod turns on it, the link rods on knuckle pins fast in the master
    rod; each rod turns on the pin of its piston, which slides along its cylinder. One freedom.
    """
    d, play, turn = Drawing(["Crankcase"]), random.choice([0.0, 0.03, 0.1]), random.uniform(0, 2 * np.pi)
    pin, reach = 20 * at(np.cos(turn), np.sin(turn), 0), 92
    axes = [at(np.cos(t), np.sin(t), 0) for t in np.pi / 2 + 2 * np.pi * np.arange(5) / 5]

    def along(start, axis, length):
        """The point of an axis through the middle at a length from a point."""
        foot = start @ axis
        return (foot + np.sqrt(length**2 - start @ start + foot**2)) * axis

    case = cq.Workplane("XY", origin=(0, 0, -40)).polygon(5, 2 * 78 / np.cos(np.pi / 5)).extrude(80)
    case = case.rotate((0, 0, 0), (0, 0, 1), -90).cut(bore((0, 0, 0), Z, 66))
    d.add("Crankcase", cut(case, *(cyl((0, 0, 0), axis, 30, 200) for axis in axes)))
    cover = cq.Workplane("XY", origin=(0, 0, 40)).polygon(5, 2 * 78 / np.cos(np.pi / 5)).extrude(8)
    cover = cover.rotate((0, 0, 0), (0, 0, 1), -90).cut(bore((0, 0, 0), Z, 16))
    for word, front in (("Front", 40), ("Rear", -48)):
        fast(d, "Crankcase", **{f"{word} Cover": cover.translate((0, 0, front - 40))})
        fast(d, f"{word} Cover", **{f"Bearing {word}": tube((0, 0, front), Z, 10, 16, 8)})
    web = bar(-28 * pin / 20, pin, 13, 12, 22).union(cyl(-20 * pin / 20 + 12 * Z, Z, 22, 10))
    shaft = union(web, cyl((0, 0, 12), Z, 10, 60), cyl((0, 0, 72), Z, 8, 30), cyl(pin - 22 * Z, Z, 8, 36))
    d.add("Crankshaft Front", shaft)
    rear = web.translate((0, 0, -34)).union(cyl((0, 0, -60), Z, 10, 40)).cut(bore(pin, Z, 8))
    fast(d, "Crankshaft Front", Crankshaft_Rear=rear)
    blades = box((-180, -12, 74), (180, 12, 82)).union(cyl((0, 0, 72), Z, 20, 14)).cut(bore((0, 0, 72), Z, 8))
    fast(d, "Crankshaft Front", Propeller=blades, Prop_Nut=nut((0, 0, 86), Z, 8))
    turns(d, ("Crankcase", "Crankshaft Front", at(0, 0, 0), Z))
    wrist = along(pin, axes[0], reach)
    main = (wrist - pin) / reach
    first = np.arctan2(main[1], main[0])
    big = union(cyl(pin - 10 * Z, Z, 14, 20), *(cyl(pin + z * Z, Z, 29, 5) for z in (-10, 5)))
    big = big.union(bar(pin, wrist, 5, -4.8, 4.8)).union(cyl(wrist - 4.8 * Z, Z, 9, 9.6))
    knuckles = [
        pin + 22 * at(np.cos(first + k * 2 * np.pi / 5), np.sin(first + k * 2 * np.pi / 5), 0) for k in range(1, 5)
    ]
    d.add(
        "Master Rod", cut(big, bore(pin, Z, 8 + play), bore(wrist, Z, 5 + play), *(bore(k, Z, 3.5) for k in knuckles))
    )
    turns(d, ("Crankshaft Front", "Master Rod", pin, Z))
    for number, axis in enumerate(axes, 1):
        rod = "Master Rod"
        if number > 1:
            rod, knuckle = f"Link Rod {number - 1}", knuckles[number - 2]
            wrist = along(knuckle, axis, reach - 22)
            link = union(
                bar(knuckle, wrist, 4.5, -4.8, 4.8), cyl(wrist - 4.8 * Z, Z, 9, 9.6), cyl(knuckle - 4.8 * Z, Z, 7, 9.6)
            )
            d.add(rod, cut(link, bore(knuckle, Z, 3.5 + play), bore(wrist, Z, 5 + play)))
            fast(d, "Master Rod", **{f"Knuckle Pin {number - 1}": cyl(knuckle - 10 * Z, Z, 3.5, 20)})
            turns(d, ("Master Rod", rod, knuckle, Z))

        def put(shape, axis=axis):
            return laid(shape, (0, 0, 0), axis, Z)

        at_wrist = float(wrist @ axis)
        piston = cyl((at_wrist - 18, 0, 0), X, 24 - play, 34).cut(box((-99, -15, -7), (at_wrist + 10, 15, 7)))
        d.add(f"Piston {number}", put(piston.cut(cyl((at_wrist, 0, -30), Z, 5, 60))))
        d.add(f"Wrist Pin {number}", put(cyl((at_wrist, 0, -19), Z, 5, 38)))
        barrel = union(
            cyl((66, 0, 0), X, 30, 84),
            cyl((78, 0, 0), X, 36, 5),
            *(cyl((x, 0, 0), X, 38, 2) for x in range(100, 145, 8)),
        )
        fast(d, "Crankcase", **{f"Cylinder {number}": put(barrel.cut(cyl((60, 0, 0), X, 24, 84)))})
        turns(d, (rod, f"Piston {number}", wrist, Z))
        d.joint("Cylindrical", f"Piston {number}", f"Cylinder {number}", at(0, 0, 0), axis)
    return d


@kind
def beam_engine(random: np.random.Generator) -> Drawing:
    """A beam on a shaft between columns, links to a crosshead on guide rods, piston and cylinder, a crank, a flywheel.

    Truth: the beam, one with its pins and shaft, turns about y in the columns; links, crosshead, connecting rod and
    crank turn about y; the crosshead, one with the piston rod, slides along z. One freedom.
    """
    d, play, tilt = Drawing(["Base plate"]), random.choice([0.02, 0.1, 0.2]), np.radians(random.uniform(-11, 11))
    axle, crank = at(0, 0, 190), at(100, 0, 42)
    side = 100 * at(np.cos(tilt), 0, np.sin(tilt))
    left, right = axle - side, axle + side
    cross = at(-100, 0, left[2] - np.sqrt(55**2 - (left[0] + 100) ** 2))
    throw = upright_at(meet(right[::2], 148, crank[::2], 24), 0)
    d.add("Base plate", box((-160, -75, -10), (170, 75, 0)))
    for k, (low, high) in enumerate(((-36, -28), (28, 36)), 1):
        stand = upright([(-45, 6), (45, 6), (0, 190)], low, high, 12).cut(box((-99, -99, -99), (99, 99, 0)))
        fast(d, "Base plate", **{f"Column {k}": stand.cut(bore(axle, Y, 7 + play))})
    beam = upright([(-100, -6), (100, -6), (0, 22)], -5, 5, 9).rotate((0, 0, 0), (0, 1, 0), -np.degrees(tilt))
    ends = [cyl(p - 5 * Y, Y, 11, 10) for p in (left, right)]
    beam = union(beam.translate((0, 0, 190)), *ends)
    d.add("Beam", cut(beam, bore(axle, Y, 7), bore(left, Y, 4), bore(right, Y, 4)))
    fast(d, "Beam", Beam_shaft=union(cyl(axle - 40 * Y, Y, 7, 80)))
    fast(d, "Beam", Link_pin=cyl(left - 14 * Y, Y, 4, 28), Rod_pin=cyl(right - 12 * Y, Y, 4, 24))
    turns(d, ("Column 1", "Beam", axle, Y))
    head = cut(
        box(cross + at(-9, -5, -9), cross + at(9, 5, 9)).union(box(cross + at(-8, -48, -9), cross + at(8, 48, -22))),
        bore(cross, Y, 4),
    )
    rods = [at(-100, s * 36, 80) for s in (-1, 1)]
    d.add("Crosshead", cut(head, *(bore(p, Z, 5 + play) for p in rods), cyl(cross - 40 * Z, Z, 4, 34)))
    fast(d, "Crosshead", Crosshead_pin=cyl(cross - 14 * Y, Y, 4, 28))
    for k, (low, high) in enumerate(((-11, -6), (6, 11)), 1):
        d.add(f"Link {k}", upright([left[::2], cross[::2]], low, high, 8, [left[::2], cross[::2]], 4 + play))
        turns(d, ("Beam", f"Link {k}", left, Y), (f"Link {k}", "Crosshead", cross, Y))
    barrel = (
        tube((-100, 0, 0), Z, 22, 28, 68).union(tube((-100, 0, 62), Z, 22, 46, 6)).union(cyl((-100, 0, 0), Z, 40, 6))
    )
    fast(d, "Base plate", Cylinder=barrel)
    lid = cyl((-100, 0, 68), Z, 46, 8).union(cyl((-100, 0, 68), Z, 9, 14)).cut(bore((-100, 0, 68), Z, 4 + play / 2))
    bolts = [at(-100 + 36 * s, 0, 76) for s in (-1, 1)]
    lid = cut(lid, *(cyl(p - 20 * Z, Z, 2.2, 30) for p in bolts), *(cyl(p - 12 * Z, Z, 5, 30) for p in rods))
    d.parts["Cylinder"] = cut(barrel, *(cyl(p - 20 * Z, Z, 2, 30) for p in bolts))
    fast(d, "Cylinder", Cylinder_cover=lid)
    for k, p in enumerate(bolts):
        fast(d, "Cylinder cover", **{f"Cover bolt {k}": bolt(p, -Z, 2, 14)})
    for k, p in enumerate(rods):
        fast(d, "Cylinder cover", **{f"Guide rod {k}": cyl(p - 12 * Z, Z, 5, 100)})
    piston_at = at(-100, 0, cross[2] - 90)
    fast(d, "Crosshead", Piston_rod=strut(piston_at - 2 * Z, cross - 8 * Z, 4))
    fast(d, "Piston rod", Piston=tube(piston_at, Z, 4, 22 - play / 2, 12))
    d.joint("Prismatic", "Cylinder cover", "Crosshead", cross, Z)
    way = (throw - right) / 148
    mid = right + 26 * way
    fork = [upright([right[::2], mid[::2]], low, high, 9) for low, high in ((-10, -5.2), (5.2, 10))]
    rod = union(
        *fork,
        upright([mid[::2], mid[::2] + 4 * way[::2]], -10, 10, 9),
        strut(mid, throw, 6),
        cyl(throw - 5 * Y, Y, 11, 10),
    )
    d.add("Connecting rod", cut(rod, bore(right, Y, 4 + play), bore(throw, Y, 4 + play)))
    turns(d, ("Beam", "Connecting rod", right, Y), ("Connecting rod", "Crank", throw, Y))
    d.add("Crank", cut(upright([crank[::2], throw[::2]], 6, 14, 10), bore(crank, Y, 7), bore(throw, Y, 4)))
    fast(d, "Crank", Crank_pin=union(cyl(throw - 6 * Y, Y, 4, 20), cyl(throw - 8 * Y, Y, 7, 2)))
    fast(d, "Crank", Crankshaft=cyl(crank + 6 * Y, Y, 7, 69))
    wheel = tube(crank + 42 * Y, Y, 7, 38, 10).cut(bore(crank + at(0, 47, 20), Z, 2, 19))
    fast(d, "Crankshaft", Flywheel=wheel, Grub_screw=cyl(crank + at(0, 47, 7), Z, 2, 9))
    for k, y in enumerate((20, 56), 1):
        block = box((82, y, 0), (118, y + 14, 42)).cut(bore(crank, Y, 7 + play))
        cap = box((82, y, 42), (118, y + 14, 58)).cut(bore(crank, Y, 7 + play))
        holes = [cyl((x, y + 7, 20), Z, 2, 60) for x in (87, 113)]
        fast(d, "Base plate", **{f"Pillow block {k}": cut(block, *holes)})
        fast(d, f"Pillow block {k}", **{f"Pillow cap {k}": cut(cap, *holes)})
        for n, x in enumerate((87, 113)):
            fast(d, f"Pillow cap {k}", **{f"Cap bolt {k}{n}": bolt((x, y + 7, 58), -Z, 2, 30)})
    turns(d, ("Pillow block 1", "Crankshaft", crank, Y))
    return d
