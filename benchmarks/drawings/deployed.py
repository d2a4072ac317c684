"""Landing gear, excavator and wiper, as engineers model them for their courses and for a simulation."""

from __future__ import annotations

import numpy as np

from drawings.catalogued import plate, ram, strut, upright, upright_at, weld
from drawings.drawing import Drawing, kind
from drawings.shapes import Shape, X, Y, Z, at, box, cut, cyl, headed, laid, meet, tube, union


def _cheeks(points, near: float, thick: float, half: float) -> list[Shape]:
    """A pair of plates in planes xz, as far from the middle as near."""
    return [upright(points, *sorted((side * near, side * (near + thick))), half) for side in (-1, 1)]


def _across(p, reach: float, radius: float) -> Shape:
    """A hole along y for a point of the plane xz."""
    return cyl(upright_at(p, -reach), Y, radius, 2 * reach)


@kind
def nose_landing_gear(random: np.random.Generator) -> Drawing:
    """A nose gear with a folding drag brace, a retraction actuator and torque links, every pin with a head.

    Truth, along y unless said: strut cylinder on the bay's bushes; upper brace on the bay, lower brace on the upper and
    on the strut; actuator on the bay and its rod on the strut; upper torque link on the strut, lower on the upper and
    on the piston: revolute, and the wheel (one with tyre and bearings) on its axle, one with the piston. Piston in its
    strut cylindrical along the strut, and so is the rod in its barrel. Pins are one with the bay, the strut, piston,
    the upper brace and the upper torque link. Retraction, stroke, wheel: three freedoms.
    """
    rake = np.radians(random.uniform(-4, 9))
    play, jut = float(random.choice([0, 0.05, 0.1])), random.uniform(30, 70)
    down, aft = at(np.sin(rake), -np.cos(rake)), at(np.cos(rake), np.sin(rake))
    pivot = at(0, 0)
    front, rear = at(-random.uniform(310, 350), -5), at(random.uniform(255, 285), 0)
    brace_low, pull = 250 * down - 52 * aft, 150 * down + 52 * aft
    mid = 0.47 * front + 0.53 * brace_low
    way = (brace_low - front) / np.linalg.norm(brace_low - front)
    knee = mid + jut * at(-way[1], way[0])
    knee = knee if knee[1] > mid[1] else mid - jut * at(-way[1], way[0])
    stroke = random.uniform(0, 30)
    high, low = 395 * down + 50 * aft, (560 + stroke) * down + 50 * aft
    apex = meet(low, 112, high, 118)
    other = meet(high, 118, low, 112)
    apex = apex if apex @ aft > other @ aft else other
    axle = (712 + stroke) * down + 18 * aft
    drawing = Drawing(fixed=["Bay structure"], unit="INCH")
    beams = [box((-390, *y), (330, *w)) for y, w in (((-92, -25), (-80, 62)), ((80, -25), (92, 62)))]
    bay = union(*beams, box((-390, -92, 56), (330, 92, 62)), *_cheeks([front, front + at(0, 60)], 27, 9, 16))
    bay = union(bay, *_cheeks([rear, rear + at(0, 58)], 20, 8, 16)).intersect(box((-999, -999, -999), (999, 999, 62)))
    drawing.add("Bay structure", cut(bay, _across(front, 60, 9), _across(rear, 60, 8), _across(pivot, 110, 17)))
    for side, word in ((-1, "RH"), (1, "LH")):
        bush = union(
            tube((0, side * 80, 0), side * Y, 14 + play, 17, 12), tube((0, side * 78, 0), side * Y, 14 + play, 21, 2)
        )
        drawing.add(f"Trunnion bush {word}", bush)
        weld(drawing, "Bay structure", f"Trunnion bush {word}")

    def along(start: float, end: float, radius: float) -> Shape:
        return strut(upright_at(start * down, 0), upright_at(end * down, 0), radius)

    outer = union(along(-26, 425, 31), along(375, 425, 35), cyl((0, -76, 0), Y, 20, 152), cyl((0, -94, 0), Y, 14, 188))
    outer = union(
        outer, *_cheeks([brace_low, brace_low + 40 * aft], 14, 9, 15), *_cheeks([pull, pull - 40 * aft], 14, 8, 14)
    )
    outer = union(outer, upright([high, high - 30 * aft], -11, 11, 13))
    outer = cut(outer, along(20, 500, 22 + play), _across(brace_low, 40, 8), _across(pull, 40, 8), _across(high, 30, 6))
    drawing.add("Strut cylinder", outer)
    fork = union(
        along(200 + stroke, 540 + stroke, 22),
        along(538 + stroke, 585 + stroke, 34),
        laid(
            box((-26, -76, 0), (26, 76, 18)),
            upright_at((575 + stroke) * down, 0),
            upright_at(aft, 0),
            upright_at(down, 0),
        ),
        *_cheeks([axle, (584 + stroke) * down], 62, 14, 22),
        *_cheeks([low, low - 30 * aft], 11.5, 8, 12),
    )
    drawing.add("Piston and fork", cut(fork, _across(low, 30, 6), _across(axle, 99, 12)))
    upper = union(*_cheeks([front, knee], 14, 8, 15), cyl(upright_at(front, -26.5), Y, 15, 53))
    third = 0.5 * (front + knee)
    upper = union(upper, cyl(upright_at(third, -15), Y, 9, 30))
    drawing.add("Upper drag brace", cut(upper, _across(front, 40, 9 + play), _across(knee, 40, 8)))
    lower = cut(upright([knee, brace_low], -13, 13, 14), _across(knee, 40, 8 + play), _across(brace_low, 40, 8 + play))
    drawing.add("Lower drag brace", lower)
    barrel, rod = ram(
        upright_at(rear, 0), upright_at(pull, 0), Y, 15, 8, 8, 27, 0.5 * float(np.linalg.norm(rear - pull)), 8, 38
    )
    drawing.add("Retraction actuator cylinder", barrel)
    drawing.add("Retraction actuator rod", rod)
    link = union(*_cheeks([high, apex], 11.5, 8, 11), cyl(upright_at(0.45 * high + 0.55 * apex, -14), Y, 7, 28))
    drawing.add("Torque link upper", cut(link, _across(high, 30, 6 + play), _across(apex, 30, 6)))
    link = cut(upright([apex, low], -11, 11, 11), _across(apex, 30, 6 + play), _across(low, 30, 6 + play))
    drawing.add("Torque link lower", link)
    for name, p, radius, reach, owner in (
        ("Pin brace to bay", front, 9, 37, "Bay structure"),
        ("Pin actuator to bay", rear, 8, 29, "Bay structure"),
        ("Pin brace knee", knee, 8, 23, "Upper drag brace"),
        ("Pin brace to strut", brace_low, 8, 24, "Strut cylinder"),
        ("Pin actuator to strut", pull, 8, 23, "Strut cylinder"),
        ("Pin torque link upper", high, 6, 21, "Strut cylinder"),
        ("Pin torque link apex", apex, 6, 21, "Torque link upper"),
        ("Pin torque link lower", low, 6, 21, "Piston and fork"),
    ):
        drawing.add(name, headed(upright_at(p, -reach + 1), Y, radius, 2 * reach))
        weld(drawing, owner, name)
    hub = upright_at(axle, 0)
    drawing.add("Axle", cyl(hub - 84 * Y, Y, 12, 168).edges("%CIRCLE").chamfer(1.5))
    drawing.add(
        "Nose wheel rim",
        cut(tube(hub - 46 * Y, Y, 18, 58, 92), tube(hub + 12 * Y, Y, 30, 50, 40), tube(hub - 52 * Y, Y, 30, 50, 40)),
    )
    drawing.add("Tire 5.00-5", tube(hub - 52 * Y, Y, 58, 106, 104).edges("%CIRCLE").edges("<Y or >Y").fillet(14))
    for side, word in ((-1, "A"), (1, "B")):
        drawing.add(f"Wheel bearing {word}", tube(hub + (side * 38 - 8) * Y, Y, 12 + play, 18, 16))
        weld(drawing, "Nose wheel rim", f"Wheel bearing {word}")
    weld(drawing, "Nose wheel rim", "Tire 5.00-5")
    weld(drawing, "Piston and fork", "Axle")
    for one, two, p in (
        ("Trunnion bush LH", "Strut cylinder", pivot),
        ("Pin brace to bay", "Upper drag brace", front),
        ("Pin brace knee", "Lower drag brace", knee),
        ("Pin brace to strut", "Lower drag brace", brace_low),
        ("Pin actuator to bay", "Retraction actuator cylinder", rear),
        ("Pin actuator to strut", "Retraction actuator rod", pull),
        ("Pin torque link upper", "Torque link upper", high),
        ("Pin torque link apex", "Torque link lower", apex),
        ("Pin torque link lower", "Torque link lower", low),
        ("Axle", "Wheel bearing A", axle),
    ):
        drawing.joint("Revolute", one, two, upright_at(p, 0), Y)
    drawing.joint("Cylindrical", "Strut cylinder", "Piston and fork", (0, 0, 0), upright_at(down, 0))
    drawing.joint(
        "Cylindrical",
        "Retraction actuator cylinder",
        "Retraction actuator rod",
        upright_at(rear, 0),
        upright_at(pull - rear, 0),
    )
    return drawing


@kind
def excavator_assem(random: np.random.Generator) -> Drawing:
    """An excavator's arm from a course in SolidWorks, plain pins in near holes, parts named as they were begun.

    Truth, all along y unless said: body turns on the undercarriage (revolute, vertical); boom on the body, stick on
    the boom, bucket on the stick, rocker on the stick, link on the rocker and on the bucket: revolute; three cylinders,
    each with its barrel and its rod's eye revolute on their neighbours, rod in barrel cylindrical. A pin is one with
    the forked part that carries it. Slew, boom, stick, bucket: four freedoms.
    """
    boom_turn, stick_turn, curl = np.radians(random.uniform((28, -110, -60), (48, -80, -20)))
    size, pin = random.uniform(0.95, 1.2), 6.0
    drill = pin + float(random.choice([0, 0.1, -0.02]))
    drawing = Drawing(fixed=["Part1^Excavator"])

    def turned(angle: float, *numbers: float) -> np.ndarray:
        cosine, sine = np.cos(angle), np.sin(angle)
        return size * at(cosine * numbers[0] - sine * numbers[1], sine * numbers[0] + cosine * numbers[1])

    heel, foot = size * at(60, 150), size * at(108, 108)
    bend, elbow, under, over = (heel + turned(boom_turn, *p) for p in ((140, 62), (300, 0), (150, 20), (150, 104)))
    on_stick = [(-58, 6), (-34, 4), (40, 36), (40, 4), (146, 4), (190, 0)]
    tail, neck, back, base, hinge, tip = (elbow + turned(stick_turn, *p) for p in on_stick)

    def dug(*numbers: float) -> np.ndarray:
        return tip + turned(stick_turn + curl, *numbers)

    lip = dug(4, 36)
    rocker = max(
        (meet(hinge, 50 * size, lip, 54 * size), meet(lip, 54 * size, hinge, 50 * size)),
        key=lambda p: float((p - hinge) @ turned(stick_turn, 0, 1)),
    )
    tracks = [box((-150, side * 70, 0), (150, side * 120, 50)).edges("|Y").fillet(24) for side in (-1, 1)]
    tracks = union(*tracks, box((-60, -75, 20), (60, 75, 45)), cyl((0, 0, 40), Z, 40, 20))
    drawing.add("Part1^Excavator", cut(tracks, cyl((0, 0, 30), Z, 22, 50)))
    cab = [box((-140, -90, 60), (132, 90, 90)), box((-140, -90, 85), (-50, 90, 150)).edges("|Z").fillet(12)]
    cab += [box((-45, 35, 85), (40, 90, 185)).edges("|Y").fillet(10), cyl((0, 0, 32), Z, 22, 30)]
    cab += [*_cheeks([heel, at(25, 76), at(80, 76)], 16, 8, 13), *_cheeks([foot, at(95, 76), at(118, 76)], 16, 8, 13)]
    drawing.add("Cabin", cut(union(*cab), _across(heel, 60, drill), _across(foot, 60, drill)))
    boom = union(upright([heel, bend], -14, 14, 17), upright([bend, elbow], -14, 14, 15))
    slot = upright([elbow, elbow + at(0, 0.1)], -11, 11, 42)
    boom = union(cut(boom, slot), *_cheeks([elbow, 0.3 * bend + 0.7 * elbow], 11, 8, 15))
    boom = union(boom, *_cheeks([under, bend], 11, 6, 11), *_cheeks([over, bend], 11, 6, 11))
    drawing.add("Boom", cut(boom, *(_across(p, 60, drill) for p in (heel, elbow, under, over))))
    stick = union(upright([neck, elbow, tip], -10.5, 10.5, 12), *_cheeks([tail, neck], 10.5, 6.5, 11))
    stick = cut(stick, upright([tail, tail + at(0, 0.1)], -10.5, 10.5, 13))
    stick = union(stick, *_cheeks([back, base], 10.4, 6.6, 11))
    drawing.add("Dipper", cut(stick, *(_across(p, 60, drill) for p in (tail, elbow, back, hinge, tip))))
    shell = [
        laid(plate([dug(*p) for p in edge], -wide, wide, 0.5), (0, 0, 0), X, -Y)
        for edge, wide in (
            ([(17, 0), (17, 42), (57, 68), (98, 46), (110, 0)], 45),
            ([(23, -15), (23, 38), (58, 61), (92, 41), (104, -15)], 40),
        )
    ]
    bucket = union(cut(*shell), *_cheeks([tip, lip, dug(23, 20)], 11.5, 8, 10))
    drawing.add("Part5^Excavator", cut(bucket, _across(tip, 60, drill), _across(lip, 60, drill)))
    for number, side in enumerate((-1, 1), 1):
        flat = upright([hinge, rocker], *sorted((side * 11.5, side * 17.5)), 10)
        drawing.add(f"Side link-{number}", cut(flat, _across(hinge, 60, drill), _across(rocker, 60, drill)))
    link = union(*_cheeks([rocker, lip], 5.8, 5.2, 10), cyl(upright_at((rocker + lip) / 2, -8), Y, 5, 16))
    drawing.add("H link", cut(link, _across(rocker, 60, drill), _across(lip, 60, drill)))
    for number, (one, other, first, last) in enumerate(
        ((foot, under, 28, 20), (over, tail, 20, 20), (back, rocker, 20, 10)), 1
    ):
        long = float(np.linalg.norm(other - one))
        pair = ram(upright_at(one, 0), upright_at(other, 0), Y, 8, 4.5, drill, last, 0.52 * long, drill, first)
        drawing.add(f"Cyl body-{number}", pair[0])
        drawing.add(f"Cyl rod-{number}", pair[1])
        point = upright_at(one, 0)
        drawing.joint("Cylindrical", f"Cyl body-{number}", f"Cyl rod-{number}", point, upright_at(other - one, 0))
    drawing.joint("Revolute", "Part1^Excavator", "Cabin", (0, 0, 40), Z)
    for number, (p, reach, owner, *others) in enumerate(
        (
            (heel, 25, "Cabin", "Boom"),
            (foot, 25, "Cabin", "Cyl body-1"),
            (under, 18, "Boom", "Cyl rod-1"),
            (over, 18, "Boom", "Cyl body-2"),
            (elbow, 20, "Boom", "Dipper"),
            (tail, 18, "Dipper", "Cyl rod-2"),
            (back, 18, "Dipper", "Cyl body-3"),
            (hinge, 18.5, "Dipper", "Side link-1"),
            (tip, 20, "Part5^Excavator", "Dipper"),
            (rocker, 18.5, "Side link-1", "Cyl rod-3", "H link"),
            (lip, 20, "Part5^Excavator", "H link"),
        ),
        1,
    ):
        drawing.add(f"Pin-{number}", cyl(upright_at(p, -reach), Y, pin, 2 * reach).edges("%CIRCLE").chamfer(0.6))
        weld(drawing, owner, f"Pin-{number}")
        for other in others:
            drawing.joint("Revolute", owner, other, upright_at(p, 0), Y)
    weld(drawing, "Pin-10", "Side link-2")
    return drawing
