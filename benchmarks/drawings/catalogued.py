"""Parts as vendors draw them, simplified, that the assemblies of students and teams are full of; in millimetres."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from drawings.drawing import Drawing
from drawings.shapes import Shape, X, Y, Z, at, bore, box, cut, cyl, hexagon, laid, screw, sphere, tube, union


def weld(drawing: Drawing, body: str, *others: str) -> None:
    """Say that parts are rigid with one."""
    for each in others:
        drawing.joint("Weld", body, each)


def servo(origin, x, z) -> Shape:
    """A standard servo with its shaft: the face that the shaft comes out of at the origin, the case along x."""
    case = box((-10.2, -10, -37), (30.5, 10, 0)).union(box((-17.5, -10, -11), (37.8, 10, -8.5)))
    holes = [bore((along, across, -10), Z, 2.2, 5) for along in (-13.8, 34.1) for across in (-5, 5)]
    case = cut(case, *holes).union(cyl((0, 0, -1), Z, 6.5, 2)).union(cyl((0, 0, 0), Z, 2.95, 5))
    return laid(case, origin, x, z)


def servo_horn(origin, x, z, clearance: float = 0.0) -> Shape:
    """A round horn on the shaft of such a servo."""
    disc = union(cyl((0, 0, 1.3), Z, 10.5, 2.7), cyl((0, 0, 1.3), Z, 4.5, 4.2))
    holes = [bore((7.5 * np.cos(turn), 7.5 * np.sin(turn), 3), Z, 1.2, 5) for turn in np.arange(4) * np.pi / 2]
    socket = cyl((0, 0, 0), Z, 2.95 + clearance, 5.0)
    return laid(cut(disc, socket, bore((0, 0, 3), Z, 1.5, 5), *holes), origin, x, z)


def stepper(origin, x, z, size: float = 42.3, length: float = 40.0, shaft: float = 2.5, out: float = 22.0) -> Shape:
    """A stepper as one solid with its shaft, flange at the origin."""
    half = size / 2
    case = box((-half, -half, -length), (half, half, 0)).edges("|Z").chamfer(4)
    holes = [cyl((a * 15.5, b * 15.5, -5), Z, 1.5, 6) for a in (-1, 1) for b in (-1, 1)]
    case = cut(case, *holes).union(cyl((0, 0, -1), Z, 11, 3)).union(cyl((0, 0, 0), Z, shaft, out))
    return laid(case, origin, x, z)


def rings(point, axis, inner: float, outer: float, width: float) -> tuple[Shape, Shape]:
    """The inner and the outer ring of a ball bearing, with the grooves of its balls."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    wall, middle = 0.28 * (outer - inner), (inner + outer) / 2
    ball = 0.3 * (outer - inner)
    centre = np.asarray(point, float) + width / 2 * unit
    groove = cq.Workplane(
        obj=cq.Solid.makeTorus(middle, ball, cq.Vector(*map(float, centre)), cq.Vector(*map(float, unit)))
    )
    one = tube(point, unit, inner, inner + wall, width).cut(groove)
    return one, tube(point, unit, outer - wall, outer, width).cut(groove)


def balls(point, axis, inner: float, outer: float, width: float, number: int) -> list[Shape]:
    """The balls of such a bearing."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    side = np.cross(unit, X if abs(unit[0]) < 0.7 else Y)
    side /= np.linalg.norm(side)
    up, middle = np.cross(unit, side), (inner + outer) / 2
    centre = np.asarray(point, float) + width / 2 * unit
    turns = 2 * np.pi * np.arange(number) / number
    return [sphere(centre + middle * (np.cos(t) * side + np.sin(t) * up), 0.3 * (outer - inner)) for t in turns]


def nut(point, axis, radius: float) -> Shape:
    """A hexagonal nut with its thread drawn at its nominal size, from a point along an axis."""
    return hexagon(point, axis, 1.8 * radius, 1.6 * radius, radius)


def washer(point, axis, radius: float, thick: float = 0.5) -> Shape:
    """A plain washer."""
    return tube(point, axis, 1.07 * radius, 2.1 * radius, thick)


def bolt(point, axis, radius: float, length: float) -> Shape:
    """A bolt with a hexagonal head on this side of the point."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    return cyl(point, unit, radius, length).union(
        hexagon(np.asarray(point) - 1.3 * radius * unit, unit, 1.75 * radius, 1.3 * radius)
    )


def capscrew(point, axis, radius: float, length: float) -> Shape:
    """A socket head cap screw."""
    return screw(point, axis, radius, length)


def eye(point, axis, hole: float, outer: float, width: float) -> Shape:
    """A round eye about a point, whole: its hole is drilled later."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    return cyl(np.asarray(point, float) - width / 2 * unit, unit, outer, width)


def strut(one, other, radius: float) -> Shape:
    """A round bar between two points."""
    one, other = np.asarray(one, float), np.asarray(other, float)
    return cyl(one, other - one, radius, np.linalg.norm(other - one))


def ram(
    foot,
    head,
    axis,
    bore_radius: float,
    rod: float,
    hole: float,
    width: float,
    barrel: float,
    foot_hole: float = 0.0,
    foot_width: float = 0.0,
) -> tuple[Shape, Shape]:
    """A hydraulic cylinder between two pins along an axis: its barrel with a gland, and its rod with a piston."""
    foot, head = np.asarray(foot, float), np.asarray(head, float)
    long = float(np.linalg.norm(head - foot))
    along = (head - foot) / long
    outer, edge, foot_hole = 1.25 * bore_radius, 1.8 * hole, foot_hole or hole
    start = foot + 1.9 * foot_hole * along
    body = union(
        eye(foot, axis, hole, 1.8 * foot_hole, foot_width or width),
        cyl(foot + foot_hole * 1.2 * along, along, outer, 1.9 * foot_hole + barrel),
    )
    inside = cyl(start + 1.3 * foot_hole * along, along, bore_radius, barrel - 8 - foot_hole * 0.5)
    body = cut(
        body, inside, bore(foot, axis, foot_hole, foot_width or width), cyl(start, along, rod, barrel + 4 * foot_hole)
    )
    deep = start + (1.3 * foot_hole + 0.25 * barrel) * along
    stem = union(
        strut(deep, head - 0.9 * hole * along, rod),
        cyl(deep, along, bore_radius, 0.45 * bore_radius),
        eye(head, axis, hole, edge, width),
    )
    return body, cut(stem, bore(head, axis, hole, width))


def plate(points, low: float, high: float, half: float, holes=(), radius: float = 0.0) -> Shape:
    """A plate in the plane xy through points, each with a round corner about it, with a hole in each of some."""
    points = [np.asarray(p, float)[:2] for p in points]
    shape = (
        cq.Workplane("XY", origin=(0, 0, low)).polyline([tuple(p.tolist()) for p in points]).close().extrude(high - low)
        if len(points) > 2
        else None
    )
    for one, other in zip(points, points[1:] + points[:1], strict=True):
        along = other - one
        across = half * np.array([-along[1], along[0]]) / np.linalg.norm(along)
        ring = [tuple(p.tolist()) for p in (one + across, other + across, other - across, one - across)]
        side = cq.Workplane("XY", origin=(0, 0, low)).polyline(ring).close().extrude(high - low)
        shape = side if shape is None else shape.union(side)
        shape = shape.union(cyl(at(*one, low), Z, half, high - low))
        if len(points) == 2:
            shape = shape.union(cyl(at(*other, low), Z, half, high - low))
            break
    return cut(shape.clean(), *(cyl(at(*np.asarray(h)[:2], low), Z, radius, high - low) for h in holes))


def upright(points, low: float, high: float, half: float, holes=(), radius: float = 0.0) -> Shape:
    """Such a plate in the plane xz, points (x, z), from one y to another."""
    return laid(plate(points, -high, -low, half, holes, radius), (0, 0, 0), X, -Y)


def upright_at(point, y: float) -> np.ndarray:
    """The point of the plane xz at a y."""
    return at(point[0], y, point[1])
