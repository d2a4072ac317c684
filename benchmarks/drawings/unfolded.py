"""A Hoberman ring of rivets, a digit of a prosthetic hand without pins, and a Schmidt coupling on ball bearings."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import balls, plate, rings, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast
from drawings.shapes import X, Y, Z, at, bar, bore, box, cut, cyl, meet, rivet, tube, union


@kind
def hoberman_ring(random: np.random.Generator) -> Drawing:
    """Eight pairs of angulated links in two layers, with a rivet at each of the twenty-four crossings.

    Truth: the two links at each rivet turn on each other about z. One freedom: the ring opens.
    """
    d, play, gap = Drawing(["link_a_0"]), random.choice([0, 0.1, 0.25]), random.choice([0.0, 0.2])
    far, near, count = random.uniform(118, 128), random.uniform(70, 80), 8
    half = np.pi / count
    middle = (far + near) / (2 * np.cos(half))

    def spot(radius, step):
        return at(radius * np.cos(step * half), radius * np.sin(step * half), 0)

    for number in range(count):
        for layer, side in (("a", 1), ("b", -1)):
            points = [spot(far, 2 * number - side), spot(middle, 2 * number), spot(near, 2 * number + side)]
            low = -3 if layer == "a" else gap
            link = bar(points[0], points[1], 6, low, low + 3).union(bar(points[1], points[2], 6, low, low + 3))
            d.add(f"link_{layer}_{number}", cut(link, *(bore(p, Z, 2 + play, 10) for p in points)))
    for number in range(count):
        after = (number + 1) % count
        rows = (
            ("centre", spot(middle, 2 * number), number, number),
            ("outer", spot(far, 2 * number + 1), after, number),
            ("inner", spot(near, 2 * number + 1), number, after),
        )
        for what, point, a, b in rows:
            d.add(f"rivet_{what}_{number}", rivet(point - 3 * Z, Z, 2, 6 + gap))
            d.joint("Revolute", f"link_a_{a}", f"link_b_{b}", point, Z)
    return d


@kind
def prosthetic_digit(random: np.random.Generator) -> Drawing:
    """Three phalanges with two couplers, a slide on a screw behind a gearmotor, a push rod; bores without pins.

    Truth: the phalanges turn on each other and on the palm, the couplers on palm, phalanges, and the push rod on slide
    and proximal phalanx, all about z; the slide slides in the palm; coupling and screw turn on the motor's shaft.
    """
    d, play = Drawing(["Palma"]), random.choice([0.1, 0.2, 0.3])
    bend = np.radians(random.uniform(5, 35, 3) * (-0.5, -1, -1))
    ways = [at(np.cos(t), np.sin(t), 0) for t in np.cumsum(bend)]
    first = at(0, 0, 0)
    second = first + random.uniform(44, 50) * ways[0]
    third = second + random.uniform(28, 32) * ways[1]
    tip = third + 20 * ways[2]
    sides = [np.cross(Z, way) for way in ways]
    cheek = [-12, -8 - play], [8 + play, 12]
    root = at(-6, 9, 0)
    far = second + 2 * ways[1] - 10 * sides[1]
    near = second - 4 * ways[0] + 9.5 * sides[0]
    last = third + 3 * ways[2] - 8 * sides[2]
    lug, ear = first + 2 * ways[0] - 11 * sides[0], at(-45, -6, 0)
    palm = box((-75, -25, -12), (-15, 14, 12)).cut(box((-52, -20, -5 - play), (-14, 20, 5 + play)))
    palm = palm.cut(box((-70, -20, -5.5), (-51, 20, 5.5)))
    for low, high in cheek:
        palm = palm.union(plate([(-17, -12), (-17, 8), (0, 0)], low, high, 6))
    palm = palm.union(bar(at(-16, 9), root, 4, 8 + play, 12))
    d.add("Palma", cut(palm, bore(first, Z, 2), bore(root, Z, 1.5), bore((-70, -15, 0), X, 1.6, 26)))
    body = union(bar(first, second - 14 * ways[0], 6, -8, 8), cyl(first - 8 * Z, Z, 7, 16))
    body = union(body, *(bar(second - 14 * ways[0], second, 6.5, low, low + 3) for low in (-8, 5)))
    body = union(body, bar(second - 14 * ways[0], near, 3.5, -8, -5), bar(first, lug, 3.5, -3, 3))
    d.add("Falange proximal", cut(body, bore(first, Z, 2), bore(second, Z, 2), bore(near, Z, 1.5), bore(lug, Z, 1.5)))
    body = union(bar(second, third - 11 * ways[1], 5, play - 5, 5 - play), bar(second, far, 4, play - 5, 5 - play))
    body = union(body, *(bar(third - 10 * ways[1], third, 4.5, low, low + 2) for low in (play - 5, 3 - play)))
    body = union(body, cyl(far, Z, 1.5, 14.2 + 2 * play))
    d.add("Falange media", cut(body, bore(second, Z, 2), bore(third, Z, 1.5)))
    body = union(bar(third, tip, 4.5, 2 * play - 3, 3 - 2 * play), bar(third, last, 3, 2 * play - 3, 3 - 2 * play))
    body = union(body, cyl(last - (11 + play) * Z, Z, 1.5, 11))
    d.add("Falange distal", cut(body, bore(third, Z, 1.5)))
    pad = bar(third + 12 * ways[2], tip, 6, -6, 6).cut(bar(third, tip, 4.5, 2 * play - 3, 3 - 2 * play))
    fast(d, "Falange distal", **{"Silicona punta": pad})
    d.add("Acoplador 1", bar(root, far, 3.5, 12 + play, 14 + play, [root, far], 1.5))
    d.add("Acoplador 2", bar(near, last, 3, -10.5 - play, -8 - play, [near, last], 1.5))
    slide = box((-50, -20, -5), (-40, -10, 5)).union(bar(at(-45, -11), ear, 3.5, -3, 3))
    d.add("Corredera", cut(slide, bore((-45, -15, 0), X, 1.5), bore(ear, Z, 1.5)))
    d.add("Biela", bar(ear, lug, 3, 3 + 0.1, 5, [ear, lug], 1.5))
    d.add(
        "Motor N20",
        union(box((-100, -20, -6), (-76, -10, 6)), cyl((-76, -15, 0), X, 2, 1), cyl((-76, -15, 0), X, 1.5, 9)),
    )
    weld(d, "Palma", "Motor N20")
    d.add("Acople", tube((-68, -15, 0), X, 1.5, 3.5, 12).cut(box((-70, -13, -1), (-50, -11, 1))))
    fast(d, "Acople", **{"Tornillo M3": cyl((-66, -15, 0), X, 1.5, 48)})
    cover = box((-75, 14, -12), (-52, 16, 12))
    fast(d, "Palma", **{"Tapa": cut(cover, *(bore((x, 14, z), Y, 1.1) for x, z in ((-72, 9), (-56, -9))))})
    for one, other, point in (
        ("Palma", "Falange proximal", first),
        ("Falange proximal", "Falange media", second),
        ("Falange media", "Falange distal", third),
        ("Palma", "Acoplador 1", root),
        ("Acoplador 1", "Falange media", far),
        ("Falange proximal", "Acoplador 2", near),
        ("Acoplador 2", "Falange distal", last),
        ("Corredera", "Biela", ear),
        ("Biela", "Falange proximal", lug),
    ):
        d.joint("Revolute", one, other, point, Z)
    d.joint("Prismatic", "Palma", "Corredera", (-45, -15, 0), X)
    d.joint("Revolute", "Motor N20", "Acople", (0, -15, 0), X)
    return d


@kind
def schmidt_coupling(random: np.random.Generator) -> Drawing:
    """Two shafts out of line, keyed to discs, a disc between them, three links to each side on pressed pins.

    Truth: each shaft, one with key, disc, pins and inner ring, turns in its block about z; each link turns on a pin of
    one disc and on one of the next. One freedom.
    """
    d, play = Drawing(["Socle"]), random.choice([0.0, 0.05, 0.1])
    away = at(random.uniform(5, 25), random.uniform(-10, 10), 0)
    span, phase = random.uniform(22, 28), random.uniform(0, 2)
    places = [at(0, 0, 0), at(*meet((0, 0), span, away[:2], span), 0), away]
    heights = [0, 13.4, 26.8]
    discs = [cyl(p + h * Z, Z, 52, 8) for p, h in zip(places, heights, strict=True)]
    pins, number = [], 0
    for stage in (0, 1):
        link = places[stage + 1] - places[stage]
        for k in range(3):
            number += 1
            turn = phase + 2 * np.pi * k / 3 + stage * np.pi / 3
            start = places[stage] + 40 * at(np.cos(turn), np.sin(turn), 0)
            low = heights[stage]
            d.add(
                f"Biellette{number:03}",
                bar(start, start + link, 8, low + 8.2, low + 13.2, [start, start + link], 4 + play),
            )
            for which, point, foot in ((stage, start, low), (stage + 1, start + link, low + 8.2)):
                discs[which] = discs[which].cut(cyl(point + (low if which == stage else low + 13.4) * Z, Z, 4, 8))
                pins.append((f"Axe{len(pins) + 1:03}", cyl(point + foot * Z, Z, 4, 13.2), which))
                d.joint("Revolute", f"Disque{which + 1:03}", f"Biellette{number:03}", point, Z)
    for which, shape in enumerate(discs):
        keyway = union(bore(places[which], Z, 10), box(places[which] + at(-3, 0, -9), places[which] + at(3, 13, 99)))
        d.add(f"Disque{which + 1:03}", shape if which == 1 else shape.cut(keyway))
    for name, shape, which in pins:
        d.add(name, shape)
        weld(d, f"Disque{which + 1:03}", name)
    base = box((-70, -70, -75), (90, -62, 110))
    for which, low, high, seat in ((0, -70, 8, -50), (2, 26.8, 105, 75)):
        place, tail = places[which], "" if which == 0 else "001"
        shaft = cyl(place + low * Z, Z, 10, high - low).cut(
            box(place + at(-3, 6, heights[which]), place + at(3, 13, heights[which] + 8))
        )
        key = box(place + at(-3, 6, heights[which]), place + at(3, 13, heights[which] + 8))
        d.add(f"Arbre{tail}", shaft)
        fast(d, f"Arbre{tail}", **{f"Clavette{tail}": key})
        weld(d, f"Arbre{tail}", f"Disque{which + 1:03}")
        block = box((place[0] - 28, -62, seat), (place[0] + 28, place[1] + 28, seat + 12)).cut(bore(place, Z, 21))
        fast(d, "Socle", **{f"Palier{tail}": block})
        inner, outer = rings(place + seat * Z, Z, 10, 21, 12)
        fast(d, f"Arbre{tail}", **{f"Bague interieure{tail}": inner})
        fast(d, f"Palier{tail}", **{f"Bague exterieure{tail}": outer})
        for count, each in enumerate(balls(place + seat * Z, Z, 10, 21, 12, 7), 1):
            d.add(f"Bille{count:03}{tail}", each)
        d.joint("Revolute", f"Palier{tail}", f"Arbre{tail}", place, Z)
    d.add("Socle", base)
    return d
