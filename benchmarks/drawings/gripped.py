"""What hands squeeze and crank: a coffee grinder, a nutcracker, a ratchet wrench, a paper trimmer."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing, kind
from drawings.office import compound
from drawings.shapes import (
    Shape,
    X,
    Y,
    Z,
    at,
    bar,
    bore,
    box,
    cut,
    cyl,
    hexagon,
    laid,
    rivet,
    screw,
    sphere,
    torus,
    tube,
    union,
)  # fmt: skip


def _cone(point, axis, low: float, high: float, length: float) -> Shape:
    """A cone along an axis, from one radius to another."""
    start, way = (cq.Vector(*map(float, numbers)) for numbers in (point, axis))
    return cq.Workplane(obj=cq.Solid.makeCone(float(low), float(high), float(length), start, way))


def _sunk(point, axis, radius: float, length: float) -> Shape:
    """A countersunk screw along an axis, its head flush with the point."""
    return union(_cone(point, axis, 2 * radius, radius, radius), cyl(point, axis, radius, length))


@kind
def coffee_grinder(random):
    """A wooden body with a drawer, burrs on a shaft in a bush and a bridge, a hopper, a crank with a knob."""
    drawing, play = Drawing(["body"]), random.choice([0.05, 0.15])
    drawn, long = random.uniform(0, 30), random.uniform(95, 115)
    corners = [at(x, y, 100) for x in (-31, 31) for y in (-31, 31)]
    rims = [19 * at(np.cos(a), np.sin(a), 0) for a in np.arange(3) * 2 * np.pi / 3]
    body = cut(box((-45, -45, 0), (45, 45, 100)), box((-38, -46, 6), (38, 40, 46)), cyl(45 * Z, Z, 15, 20))
    body = union(cut(body, cyl(60 * Z, Z, 24.1, 50)), box((-16, -5, 47), (16, 5, 53)))
    body = cut(body, cyl(46.5 * Z, Z, 4 + play, 9), *(cyl(p + 60 * Z, -Z, 1.5, 10) for p in rims))
    drawing.add("body", cut(body, *(cyl(p, -Z, 2, 12) for p in corners)))
    ring = cut(cyl(60 * Z, Z, 24, 20), _cone(60 * Z, Z, 13, 16, 20), *(bore(p, Z, 1.6) for p in rims))
    drawing.add("ring burr", cut(ring, *(cyl(p + 77 * Z, Z, 2.6, 9) for p in rims)))
    for number, p in enumerate(rims):
        drawing.add(f"burr screw {number}", screw(p + 77 * Z, -Z, 1.5, 24))
    shaft = union(cyl(47 * Z, Z, 4, 99), box((-2.6, -2.6, 145), (2.6, 2.6, 151.5)), cyl(151 * Z, Z, 2.2, 7))
    shaft = union(shaft, cyl(92 * Z, Z, 7.5, 4.8))
    drawing.add("shaft", cut(shaft, bore(70 * Z, X, 1.5, 9), tube(107.2 * Z, Z, 3, 5, 1.1)))
    drawing.add("shaft clip", cut(tube(107.2 * Z, Z, 3, 7, 1), box((-1.5, 0, 100), (1.5, 9, 110))))
    inner = cut(_cone(61 * Z, Z, 12.2, 10, 18), bore(0 * Z, Z, 4), bore(70 * Z, X, 1.5, 20))
    drawing.add("inner burr", inner)
    drawing.add("burr pin", cyl(70 * Z - 9 * X, X, 1.5, 18))
    plate = cut(box((-50, -50, 100), (50, 50, 105)).edges("|Z").fillet(4), bore(0 * Z, Z, 7))
    drawing.add(
        "top plate", cut(plate, *(bore(p, Z, 2.2) for p in corners), *(bore(at(x, 0, 0), Z, 8) for x in (-20, 20)))
    )
    drawing.add("bush", union(tube(97 * Z, Z, 4 + play, 7.01, 8), tube(105 * Z, Z, 4 + play, 10, 2)))
    hopper = union(tube(108 * Z, Z, 33, 37, 28), tube(105 * Z, Z, 33, 49, 3))
    drawing.add("hopper", cut(hopper, *(bore(p, Z, 2.2) for p in corners)))
    for number, p in enumerate(corners):
        drawing.add(f"hopper screw {number}", screw(p + 8 * Z, -Z, 2, 18))
    tip = at(long, 0, 0)
    crank = union(bar((0, 0), tip, 7, 146, 152), cyl(146 * Z, Z, 10, 6))
    drawing.add("crank", cut(crank, box((-2.65, -2.65, 140), (2.65, 2.65, 160)), bore(tip, Z, 2.2)))
    nut = union(hexagon(152 * Z, Z, 4.5, 6), cyl(158 * Z, Z, 4, 3))
    drawing.add("cap nut", cut(nut, cyl(152 * Z, Z, 2.2, 6.5)))
    pin = union(cyl(tip + 152 * Z, Z, 3, 28), cyl(tip + 146 * Z, Z, 2.2, 7), cyl(tip + 180 * Z, Z, 5, 2))
    drawing.add("knob pin", union(pin, cyl(tip + 144.5 * Z, Z, 4, 1.5)))
    ball = cut(sphere(tip + 166 * Z, 15), bore(tip, Z, 3 + 2 * play))
    ball = cut(ball, box(tip + at(-20, -20, 140), tip + at(20, 20, 152.2)), cyl(tip + 179.6 * Z, Z, 20, 9))
    drawing.add("knob", ball)
    drawer = cut(box((-37.8, -45, 6), (37.8, 36, 45.8)), box((-34, -42, 9), (34, 33, 50)))
    drawer = union(drawer, box((-42, -51, 3), (42, -45, 50))).translate((0, -drawn, 0))
    front = at(0, -51 - drawn, 27)
    drawing.add("drawer", cut(drawer, bore(front, Y, 2.2, 12)))
    pull = union(cyl(front, -Y, 5, 8), sphere(front - 14 * Y, 9))
    drawing.add("drawer knob", cut(pull, cyl(front, -Y, 2, 10)))
    drawing.add("drawer screw", screw(front + 9 * Y, -Y, 2, 18))
    drawing.joint("Weld", "ring burr", "body")
    drawing.joint("Weld", "top plate", "body")
    drawing.joint("Weld", "bush", "top plate")
    drawing.joint("Weld", "hopper", "top plate")
    drawing.joint("Revolute", "shaft", "bush", 0 * Z, Z)
    drawing.joint("Weld", "inner burr", "shaft")
    drawing.joint("Weld", "crank", "shaft")
    drawing.joint("Revolute", "knob", "crank", tip, Z)
    drawing.joint("Prismatic", "drawer", "body", 0 * Y, Y)
    drawing.joint("Weld", "drawer knob", "drawer")
    return drawing


@kind
def nutcracker(random):
    """Two handles with screwed jaws and pinned sleeves between two links, on rivets."""
    drawing, play = Drawing(["front link"]), random.choice([0.05, 0.1, 0.2])
    half, wide = 16.0, random.uniform(30, 42)
    pivots = {"left": at(-half, 0, 0), "right": at(half, 0, 0)}
    for name, z in (("front", 3), ("back", -6)):
        drawing.add(f"{name} link", bar(pivots["left"], pivots["right"], 9, z, z + 3, tuple(pivots.values()), 4))
    for s, (name, p) in zip((-1, 1), pivots.items(), strict=True):
        drawing.add(f"{name} rivet", rivet(p - 6 * Z, Z, 4, 12))
        knee, end = p - 60 * Y, at(s * wide, -165, 0)
        handle = union(bar(p, knee, 7, -2.9, 2.9), bar(knee, end, 7, -2.9, 2.9))
        bolts = [p + at(s * 7, y, 0) for y in (-32, -48)]
        middle, last = 0.6 * knee + 0.4 * end, 0.1 * knee + 0.9 * end
        handle = cut(handle, bore(p, Z, 4 + play), *(bore(q, X, 1.6, 20) for q in bolts))
        pins = [middle, last]
        sleeve = cut(bar(middle, end, 11, -6, 6), handle)
        sleeve, handle = (cut(each, *(bore(q, Z, 2) for q in pins)) for each in (sleeve, handle))
        drawing.add(f"{name} handle", handle)
        drawing.add(f"{name} sleeve", sleeve)
        for number, q in enumerate(pins):
            drawing.add(f"{name} sleeve rivet {number}", rivet(q - 6 * Z, Z, 2, 12))
        jaw = box(p + at(-s * 7, -54, -8), p + at(-s * 12, -26, 8))
        teeth = [box(p + at(-s * 11.2, y, -9), p + at(-s * 13, y + 1.5, 9)) for y in range(-52, -27, 4)]
        drawing.add(f"{name} jaw", cut(jaw, *teeth, *(cyl(q, -s * X, 1.5, 17) for q in bolts)))
        for number, q in enumerate(bolts):
            drawing.add(f"{name} jaw screw {number}", screw(q, -s * X, 1.5, 17))
        drawing.joint("Revolute", f"{name} handle", "front link", p, Z)
        drawing.joint("Weld", f"{name} jaw", f"{name} handle")
        drawing.joint("Weld", f"{name} sleeve", f"{name} handle")
    drawing.joint("Weld", "back link", "front link")
    return drawing


@kind
def ratchet_wrench(random):
    """A toothed drive between a body and its cover, a pawl on the square of a selector, a clamped grip."""
    drawing, play = Drawing(["body"], "INCH"), random.choice([0.03, 0.08])
    pivot, end = at(-24, 0, 0), random.uniform(-190, -170)
    bolts = [at(11, 12, 5), at(11, -12, 5), at(-46, 0, 5)]
    body = union(bar((0, 0), (-34, 0), 20, -9, 5), box((-75, -9, -9), (-40, 9, 5)), cyl((-74, 0, -2), -X, 6, -74 - end))
    body = cut(body, cyl(-6 * Z, Z, 13, 20), cyl(pivot - 6 * Z, Z, 9.5, 20), box((-24, -9, -6), (0, 9, 20)))
    body = cut(body, bore(0 * Z, Z, 9), bore(pivot, Z, 4), *(cyl(p, -Z, 1.2, 9) for p in bolts))
    drawing.add("body", cut(body, cyl((end, 0, -2), X, 2, 16)))
    cover = cut(bar((0, 0), (-34, 0), 19, 5, 8), bore(0 * Z, Z, 8 + play), bore(pivot, Z, 3 + play))
    drawing.add("cover", cut(cover, *(bore(p, Z, 1.4) for p in bolts)))
    for number, p in enumerate(bolts):
        drawing.add(f"cover screw {number}", screw(p + 3 * Z, -Z, 1.2, 9))
    angles = 2 * np.pi * np.arange(36) / 36
    points = [(r * np.cos(a + d), r * np.sin(a + d)) for a in angles for r, d in ((12, 0), (11, np.pi / 36))]
    gear = cq.Workplane().polyline(points).close().extrude(10.8).translate((0, 0, -5.9))
    gear = union(
        gear, cyl(4.8 * Z, Z, 8, 4.2), cyl(-9.5 * Z, Z, 9 - play, 4), box((-4.75, -4.75, -23), (4.75, 4.75, -9))
    )
    drawing.add("drive", cut(gear, cyl((0, 0, -16), X, 1.6, 9)))
    drawing.add("ball", sphere((3.9, 0, -16), 1.5))
    drawing.add("spring", compound(*(torus((x, 0, -16), X, 1.1, 0.3) for x in (0.4, 1.2, 2.0))))
    pawl = union(cyl(pivot - 5.9 * Z, Z, 7, 10.8), box(pivot + at(0, -6, -5.9), at(-9, 6, 4.9)))
    pawl = cut(pawl, bore(0 * Z, Z, 12.8), box(pivot + at(-2, -2, -9), pivot + at(2, 2, 9)))
    drawing.add("pawl", pawl)
    stem = union(box(pivot + at(-2, -2, -5.7), pivot + at(2, 2, 5)), cyl(pivot + 4.9 * Z, Z, 3, 3.3))
    stem = union(stem, bar(pivot, pivot - 11 * X, 5, 8.2, 11))
    drawing.add("selector", cut(stem, cyl(pivot - 9 * Z, Z, 1.2, 12)))
    drawing.add("pawl washer", tube(pivot - 6.4 * Z, Z, 1.3, 3.5, 0.5))
    drawing.add("pawl screw", screw(pivot - 6.4 * Z, Z, 1.2, 8.4))
    axis = at(-75, 0, -2)
    drawing.add("grip", tube(axis, -X, 6.1, 12, -75 - end + 0.2).faces("<X or >X").edges().fillet(0.4))
    drawing.add("end washer", tube((end - 0.2, 0, -2), -X, 2.2, 10, 2))
    drawing.add("end screw", screw((end - 2.2, 0, -2), X, 2, 16))
    drawing.joint("Weld", "cover", "body")
    drawing.joint("Revolute", "drive", "body", 0 * Z, Z)
    drawing.joint("Revolute", "selector", "cover", pivot, Z)
    drawing.joint("Weld", "pawl", "selector")
    drawing.joint("Weld", "grip", "body")
    return drawing


@kind
def paper_trimmer(random):
    """A board with a blade on its edge, an arm on a shoulder bolt, a stop that slides on a T-shaped ruler, a guard."""
    drawing, play = Drawing(["board"]), random.choice([0.05, 0.1, 0.2])
    turn, where = random.uniform(0.2, 0.6), random.uniform(-150, -60)
    hinge, edge = at(0, 130, -9), [at(4, y, -10) for y in (-130, -20, 90)]
    marks = [at(x, 139, 8) for x in (-185, -15)]
    posts, feet = [at(-14, y, 0) for y in (-100, 70)], [at(x, y, -15) for x in (-180, -20) for y in (-130, 130)]
    board = cut(box((-200, -150, -15), (0, 150, 0)), *(cyl(p, -X, 2, 25) for p in edge), cyl(hinge + 9 * X, -X, 3, 32))
    board = cut(board, *(cyl(p, -Z, 1.5, 17) for p in marks), *(cyl(p, -Z, 1.5, 9) for p in posts))
    drawing.add("board", cut(board, *(cyl(p, Z, 1.5, 9) for p in feet)))
    blade = cut(box((0, -150, -20), (4, 150, 0)), bore(hinge, X, 3.1), *(_cone(p, -X, 4.1, 2.1, 2) for p in edge))
    drawing.add("fixed blade", cut(blade, *(bore(p, X, 2.1) for p in edge)))
    for number, p in enumerate(edge):
        drawing.add(f"blade screw {number}", _sunk(p, -X, 2, 22))
    along, start = at(0, -np.cos(turn), np.sin(turn)), hinge + 4.1 * X
    pins = [at(322, 0, 0), at(356, 0, 0)]
    arm = bar((0, 0), (370, 0), 12, 0, 3, ((0, 0), *pins), 2.5).cut(bore(0 * Z, Z, 4 + play))
    drawing.add("arm", laid(arm, start, along, X))
    grip = cut(bar((310, 0), (390, 0), 16, -8, 11), bar((0, 0), (370, 0), 12, 0, 3), *(bore(p, Z, 2.5) for p in pins))
    drawing.add("handle", laid(grip, start, along, X))
    for number, p in enumerate(pins):
        drawing.add(f"handle rivet {number}", laid(rivet(p - 8 * Z, Z, 2.5, 19), start, along, X))
    bolt = union(cyl(hinge + 4 * X, X, 4, 5.3), cyl(hinge + 4 * X, -X, 3, 20), cyl(hinge + 9.3 * X, X, 9, 5))
    drawing.add("arm bolt", cut(bolt, hexagon(hinge + 11 * X, X, 3, 9)))
    drawing.add("arm washer", tube(hinge + 7.2 * X, X, 4.1, 9, 2))
    ruler = union(box((-200, 134, 0), (0, 144, 4.5)), box((-200, 130, 4), (0, 148, 8)))
    drawing.add("ruler", cut(ruler, *(bore(p, Z, 1.6) for p in marks), *(cyl(p - 3.2 * Z, Z, 2.6, 9) for p in marks)))
    for number, p in enumerate(marks):
        drawing.add(f"ruler screw {number}", screw(p - 3.2 * Z, -Z, 1.5, 12))
    room = union(
        box((-300, 134 - play, -1), (100, 144 + play, 5)),
        box((-300, 130 - play, 4 - play), (100, 148 + play, 8 + play)),
    )
    stop = union(box((where, 124, 0.5), (where + 30, 154, 14)), box((where, 100, 0.5), (where + 4, 130, 10)))
    drawing.add("stop", cut(stop, room, bore((where + 15, 139, 9), Z, 2, 40)))
    thumb = union(cyl((where + 15, 139, 8.8), Z, 2, 10), cyl((where + 15, 139, 17), Z, 8, 8))
    drawing.add("thumb screw", thumb)
    drawing.add("guard", cut(box((-24, -120, 12), (-5, 110, 15)), *(bore(p, Z, 1.6) for p in posts)))
    for number, p in enumerate(posts):
        drawing.add(f"post {number}", tube(p, Z, 1.7, 5, 12))
        drawing.add(f"guard screw {number}", screw(p + 15 * Z, -Z, 1.5, 24))
    for number, p in enumerate(feet):
        foot = cut(cyl(p, -Z, 9, 8), bore(p, Z, 1.7), cyl(p - 3 * Z, -Z, 4, 9))
        drawing.add(f"foot {number}", foot)
        drawing.add(f"foot screw {number}", screw(p - 3 * Z, Z, 1.5, 12))
        drawing.joint("Weld", f"foot {number}", "board")
    drawing.joint("Weld", "fixed blade", "board")
    drawing.joint("Revolute", "arm", "fixed blade", hinge, X)
    drawing.joint("Weld", "handle", "arm")
    drawing.joint("Weld", "ruler", "board")
    drawing.joint("Prismatic", "stop", "ruler", 0 * X, X)
    drawing.joint("Weld", "guard", "board")
    return drawing
