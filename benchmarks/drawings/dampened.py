"""A model car's corner of double wishbones with ball studs and a shock, and the steering of a kart with rod ends."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import bolt, capscrew, nut, plate, strut, washer, weld
from drawings.drawing import Drawing, kind
from drawings.rolled import fast, turns
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, hexagon, laid, sphere, tube, union


def _ball(middle, axis, radius: float, half: float, hole: float) -> Shape:
    """A ball between two flats with a bore."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    return (
        sphere(middle, radius)
        .intersect(cyl(middle - half * axis, axis, 2 * radius, 2 * half))
        .cut(bore(middle, axis, hole))
    )


@kind
def rc_double_wishbone(random: np.random.Generator) -> Drawing:
    """A bulkhead with arms on clipped pins, an upright on two ball studs, a shock on balls, a tie rod to a bellcrank.

    Truth: each arm turns about y; the upright swivels on the balls of both arms and on that of the tie rod, which
    swivels on the bellcrank's; the bellcrank turns about z on its post, the wheel's axle about x in the upright; the
    shock slides, and swivels on a ball of the tower and one of the lower arm.
    """
    d, play = Drawing(["Chassis"]), random.choice([0.0, 0.05, 0.15])
    low, high = at(20, 0, 0), at(24, 0, 40)
    outer, upper = at(80, 0, random.uniform(-6, 6)), at(80, 0, 40)
    deck = box((-40, -34, -14), (34, 70, -10))
    post = union(cyl((-5, 48, -10), Z, 6, 18), cyl((-5, 48, 0), Z, 3, 14.2)).cut(cyl((-5, 48, 4), Z, 1.5, 30))
    d.add("Chassis", deck.union(post))
    block = box((-15, -25, -10), (10, 25, 48))
    for pivot in (low, high):
        for y in (-25, 17 + play):
            ear = cyl(pivot + y * Y, Y, 6, 8 - play).union(
                box((5, y, pivot[2] - 6), (pivot[0], y + 8 - play, pivot[2] + 6))
            )
            block = block.union(ear)
    block = cut(block, *(bore(p, Y, 1.5, 60) for p in (low, high)))
    fast(d, "Chassis", Bulkhead=cut(block, *(box((9.99, -17, z - 7), (30, 17 + play, z + 7)) for z in (0, 40))))
    for word, pivot, ball, half in (("Lower", low, outer, 12), ("Upper", high, upper, 8)):
        rise = np.arctan2(ball[2] - pivot[2], ball[0] - pivot[0])
        lean = at(np.cos(rise), 0, np.sin(rise))
        reach = float(np.linalg.norm(ball - pivot))
        arm = plate([(4, half), (4, -half), (reach - 14, 0)], -3, 3, 4).union(cyl((0, -16.9, 0), Y, 5, 33.8))
        if word == "Lower":
            arm = arm.union(box((30, -14, -3.5), (40, 0, 3.5)))
        arm = laid(cut(arm, bore((0, 0, 0), Y, 1.5 + play, 60)), pivot, lean, np.cross(lean, Y))
        arm = cut(arm, strut(ball - 22 * lean, ball, 2))
        spot = pivot + 35 * lean
        d.add(f"{word} arm", cut(arm, cyl(spot - 14 * Y, Y, 1.5, 12)) if word == "Lower" else arm)
        fast(d, f"{word} arm", **{f"{word} ball stud": union(sphere(ball, 4), strut(ball - 20 * lean, ball, 2))})
        d.add(f"{word} hinge pin", cyl(pivot - 29 * Y, Y, 1.5, 58))
        for k, y in enumerate((-25.8, 25)):
            d.add(f"E-clip {word} {k}", tube(pivot + y * Y, Y, 1.5, 3.4, 0.8))
        weld(d, "Bulkhead", f"{word} hinge pin")
        weld(d, f"{word} hinge pin", f"E-clip {word} 0", f"E-clip {word} 1")
        turns(d, ("Bulkhead", f"{word} arm", pivot, Y))
        d.joint("Spherical", f"{word} ball stud", "Carrier", ball)
    wheel = at(84, 0, 20)
    body = box((78, -9, -16), (90, 9, 52)).union(box((80, 9, 8), (90, 28, 13)))
    tie = at(85, 23, 20)
    body = cut(
        body, sphere(outer, 4 + play), sphere(upper, 4 + play), bore(wheel, X, 5, 30), cyl(tie - 13 * Z, Z, 1.5, 30)
    )
    d.add("Carrier", body)
    for k, x in enumerate((78, 86)):
        fast(d, "Carrier", **{f"MR105 {k}": tube((x, 0, 20), X, 2.5, 5, 4)})
    axle = union(cyl((74, 0, 20), X, 4, 4), cyl((78, 0, 20), X, 2.5, 22), cyl((100, 0, 20), X, 2, 18))
    d.add("Axle", axle)
    fast(d, "Axle", Hex_hub=hexagon((90, 0, 20), X, 6, 10, 2.5))
    fast(d, "Axle", Wheel=union(tube((100, 0, 20), X, 2, 25, 6), tube((92, 0, 20), X, 25, 31, 26)))
    fast(d, "Axle", **{"93625A150": nut((106, 0, 20), X, 2)})
    turns(d, ("Carrier", "Axle", wheel, X))
    inner = at(16, 40, 20)
    crank = plate([(-5, 48), inner], 8, 13, 5, [(-5, 48)], 3 + play).cut(cyl(inner - 12 * Z, Z, 1.5, 8))
    d.add("Bellcrank", crank.union(cyl((-5, 48, 8), Z, 7, 6)).cut(bore((-5, 48, 0), Z, 3 + play)))
    fast(
        d, "Chassis", **{"M3 washer": washer((-5, 48, 14.2), Z, 1.5), "91290A115": capscrew((-5, 48, 14.7), -Z, 1.5, 9)}
    )
    turns(d, ("Chassis", "Bellcrank", at(-5, 48, 0), Z))
    along = (tie - inner) / np.linalg.norm(tie - inner)
    for word, ball, by, way in (("outer", tie, "Carrier", -along), ("inner", inner, "Bellcrank", along)):
        fast(
            d,
            by,
            **{
                f"Stud {word}": union(sphere(ball, 3), cyl(ball - 11 * Z, Z, 1.5, 10), hexagon(ball - 7 * Z, Z, 2.5, 2))
            },
        )
        end = union(cyl(ball - 2.2 * Z, Z, 5, 4.4), strut(ball + 3.5 * way, ball + 20 * way, 2.6))
        end = cut(end, sphere(ball, 3 + play), strut(ball + 8 * way, ball + 21 * way, 1.5))
        d.add(f"Rod end {word}", end)
        d.joint("Spherical", f"Rod end {word}", f"Stud {word}", ball)
    d.add("Turnbuckle", strut(tie - 9 * along, inner + 9 * along, 1.5))
    weld(d, "Turnbuckle", "Rod end outer", "Rod end inner")
    tower = box((-15, -14, 48), (44, -10, 76)).cut(bore((34, -13, 66), Y, 1.5, 20))
    fast(d, "Bulkhead", Shock_tower=tower)
    rise = np.arctan2(outer[2], 60)
    foot, head = at(20 + 35 * np.cos(rise), -20, 35 * np.sin(rise)), at(34, -20, 66)
    way = (head - foot) / np.linalg.norm(head - foot)
    for word, ball, by, tail in (("low", foot, "Lower arm", 12), ("top", head, "Shock tower", 9)):
        fast(d, by, **{f"Shock ball {word}": _ball(ball, Y, 3, 2, 1.5)})
        fast(d, by, **{f"M3 screw {word}": capscrew(ball - 2 * Y, Y, 1.5, tail + 2)})
    fast(d, "Lower arm", Spacer_low=tube(foot + 2 * Y, Y, 1.5, 2.8, 4))
    fast(d, "Shock tower", Spacer_top=tube(head + 2 * Y, Y, 1.5, 2.8, 4), M3_nut=nut(head + 10 * Y, Y, 1.5))
    body = union(cyl(head - 1.6 * Y, Y, 5.2, 3.2), cyl(head - 5 * way, -way, 5.5, 38))
    body = cut(
        body,
        cyl(head - 10 * way, -way, 4.5, 31),
        bore(head - 20 * way, way, 1.6, 30).intersect(cyl(head - 30 * way, -way, 5, 20)),
        sphere(head, 3 + play),
    )
    d.add("Shock body", body)
    rod = union(
        cyl(foot - 1.6 * Y, Y, 5.2, 3.2),
        strut(foot + 4 * way, head - 20 * way, 1.6),
        cyl(head - 20 * way, -way, 4.5, 3),
    )
    d.add("Shock shaft", rod.cut(sphere(foot, 3 + play)))
    d.joint("Cylindrical", "Shock body", "Shock shaft", head, way)
    d.joint("Spherical", "Shock body", "Shock ball top", head)
    d.joint("Spherical", "Shock shaft", "Shock ball low", foot)
    return d


@kind
def kart_steering(random: np.random.Generator) -> Drawing:
    """Stub axles with flanged bushes on kingpin bolts in a frame, tie rods with rod ends, a column in two bearings.

    Truth: each stub turns about its kingpin, each wheel, one with the rings of its bearings, on the stub; the column
    turns in its bearings; each tie rod swivels on the balls bolted to stub and column. Bolts and nuts are fast.
    """
    d, play, lean = Drawing(["Frame"]), random.choice([0.0, 0.1, 0.3]), np.radians(random.uniform(4, 12))
    frame = union(
        strut((-196, 0, 0), (196, 0, 0), 13),
        strut((-60, 0, 0), (-60, -160, 0), 12),
        strut((60, 0, 0), (60, -160, 0), 12),
    )
    rake = np.radians(random.uniform(35, 50))
    axis = at(0, -np.sin(rake), np.cos(rake))
    down = np.cross(X, axis)  # from the column toward the tie rods
    origin = at(0, -45, 45)
    column = union(
        cyl(origin - 4 * axis, axis, 9, 180), laid(plate([(0, 0), (20, -38), (-20, -38)], -4, 4, 9), origin, X, axis)
    )
    joints = []
    for side in (1, -1):
        tag = "R" if side > 0 else "L"
        z = at(-side * np.sin(lean), 0, np.cos(lean))
        x = at(side * np.cos(lean), 0, np.sin(lean))
        king = at(side * 225, 0, 0)

        def put(shape, king=king, x=x, z=z):
            return laid(shape, king, x, z)

        bracket = union(
            box((-32, -14, -36), (-22, 14, 36)), box((-32, -14, 30), (12, 14, 36)), box((-32, -14, -36), (12, 14, -30))
        )
        frame = frame.union(put(bracket)).cut(put(bore((0, 0, 0), Z, 5 + play, 60)))
        back = -np.sign(np.cross(z, x)[1])  # the arm points to the rear
        arm = at(-12, back * 72, -6)
        stub = union(
            cyl((0, 0, -27), Z, 12, 54),
            cyl((8, 0, 0), X, 10, 18),
            cyl((26, 0, 0), X, 8, 74),
            cyl((100, 0, 0), X, 6, 16),
        )
        stub = cut(stub.union(plate([(0, back * 9), arm], -10, -2, 9)), bore((0, 0, 0), Z, 7, 60), bore(arm, Z, 4, 20))
        d.add(f"Stub axle {tag}", put(stub))
        for k, turn in enumerate((1, -1)):
            bush = union(
                tube((0, 0, turn * 12), turn * Z, 5 + play / 2, 7, 15),
                tube((0, 0, turn * 27), turn * Z, 5 + play / 2, 10, 2.8),
            )
            fast(d, f"Stub axle {tag}", **{f"Flanged bush {tag}{k}": put(bush)})
        fast(
            d,
            "Frame",
            **{
                f"Kingpin M10x90 {tag}": put(bolt((0, 0, 36), -Z, 5, 86)),
                f"Nyloc M10 {tag}": put(nut((0, 0, -36), -Z, 5)),
            },
        )
        turns(d, ("Frame", f"Stub axle {tag}", king, z))
        hub = union(cyl((30, 0, 0), X, 26, 66), cyl((40, 0, 0), X, 58, 40)).cut(bore((30, 0, 0), X, 12))
        for x0 in (30, 84):
            hub = hub.cut(cyl((x0, 0, 0), X, 16, 12))
        d.add(f"Wheel {tag}", put(hub))
        for k, x0 in enumerate((30, 84)):
            fast(d, f"Wheel {tag}", **{f"6002 {tag}{k}": put(tube((x0, 0, 0), X, 8, 16, 12))})
        fast(
            d,
            f"Stub axle {tag}",
            **{
                f"Axle sleeve {tag}": put(tube((26, 0, 0), X, 8, 9.5, 4)),
                f"Axle nut {tag}": put(nut((100, 0, 0), X, 6)),
            },
        )
        turns(d, (f"Stub axle {tag}", f"Wheel {tag}", king, x))
        far = king + arm[0] * x + arm[1] * np.cross(z, x) + 4.5 * z
        near = origin + side * 20 * X + 38 * down + 10.5 * axis
        along = (near - far) / np.linalg.norm(near - far)
        ends = []
        for word, ball, normal, by in (("out", far, z, f"Stub axle {tag}"), ("in", near, axis, "Column")):
            way = along if word == "out" else -along
            eye = np.cross(way, np.cross(normal, way))
            eye /= np.linalg.norm(eye)
            fast(d, by, **{f"Ball {word} {tag}": _ball(ball, normal, 8.5, 6.5, 4)})
            fast(
                d,
                by,
                **{
                    f"M8x25 {word} {tag}": bolt(ball + 6.5 * normal, -normal, 4, 28),
                    f"M8 nut {word} {tag}": nut(ball - 14.5 * normal, -normal, 4),
                },
            )
            housing = union(cyl(ball - 3.5 * eye, eye, 12, 7), strut(ball + 9 * way, ball + 38 * way, 4)).cut(
                sphere(ball, 8.5 + play / 4)
            )
            ends.append(f"Rod end {word} {tag}")
            d.add(ends[-1], housing)
            joints.append(("Spherical", ends[-1], f"Ball {word} {tag}", ball))
        bar = strut(far + 22 * along, near - 22 * along, 7).cut(strut(far + 21 * along, near - 21 * along, 4))
        d.add(f"Tie rod {tag}", bar)
        weld(d, f"Tie rod {tag}", *ends)
    for k, place in enumerate((origin + 14 * axis, origin + 120 * axis), 1):
        fast(
            d,
            "Frame",
            **{
                f"Column block {k}": laid(
                    box((-22, -16, 0), (22, 16, 14)).cut(bore((0, 0, 0), Z, 9 + play)), place, X, axis
                )
            },
        )
        frame = frame.union(laid(box((-22, 16, 0), (22, 26, 14)), place, X, axis))
    back = laid(box((-22, 20, 14), (22, 26, 120)), origin, X, axis)
    foot = origin + 23 * np.cross(axis, X) + 21 * axis
    frame = union(frame, back, strut((0, 0, 0), foot, 6))
    d.add("Frame", frame)
    d.add("Column", cut(column, *(bore(origin + s * 20 * X + 38 * down, axis, 4, 30) for s in (-1, 1))))
    fast(d, "Column", Steering_hub=tube(origin + 150 * axis, axis, 9, 24, 16))
    turns(d, ("Column block 1", "Column", origin, axis))
    for each in joints:
        d.joint(*each)
    return d
