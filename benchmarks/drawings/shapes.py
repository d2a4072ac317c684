"""Shapes that machines are drawn from, in millimetres, by CadQuery; points and axes are arrays."""

from __future__ import annotations

import cadquery as cq
import numpy as np

Shape = cq.Workplane
X, Y, Z = np.eye(3)


def at(*numbers: float) -> np.ndarray:
    """A point or a direction."""
    return np.array(numbers, float)


def _vector(numbers) -> cq.Vector:
    return cq.Vector(*(float(number) for number in numbers))


def cyl(point, axis, radius: float, length: float) -> Shape:
    """A cylinder from a point along an axis."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    return cq.Workplane(obj=cq.Solid.makeCylinder(float(radius), float(length), _vector(point), _vector(unit)))


def tube(point, axis, inner: float, outer: float, length: float) -> Shape:
    """A cylinder with a bore."""
    return cyl(point, axis, outer, length).cut(cyl(point, axis, inner, length))


def box(low, high) -> Shape:
    """A box between two opposite corners."""
    low, high = np.minimum(low, high).astype(float), np.maximum(low, high).astype(float)
    return cq.Workplane(obj=cq.Solid.makeBox(*(high - low).tolist(), _vector(low)))


def sphere(middle, radius: float) -> Shape:
    """A ball."""
    return cq.Workplane(obj=cq.Solid.makeSphere(float(radius), _vector(middle), _vector(Z), -90, 90, 360))


def torus(middle, axis, large: float, small: float) -> Shape:
    """A ring of round section."""
    return cq.Workplane(obj=cq.Solid.makeTorus(float(large), float(small), _vector(middle), _vector(axis)))


def hexagon(point, axis, flat: float, length: float, bore: float = 0.0) -> Shape:
    """A hexagonal prism, such as a nut; `flat` is the distance from its axis to a flat."""
    plane = cq.Plane(tuple(map(float, point)), normal=tuple(map(float, axis)))
    prism = cq.Workplane(plane).polygon(6, 2 * float(flat) / np.cos(np.pi / 6)).extrude(float(length))
    return prism.cut(cyl(point, axis, bore, length)) if bore else prism


def bar(one, other, half: float, low: float, high: float, holes=(), radius: float = 0.0) -> Shape:
    """A bar with round ends in the plane xy, from one point to the other, with holes, between two heights."""
    one, other = np.asarray(one, float)[:2], np.asarray(other, float)[:2]
    along = other - one
    length, turn = np.linalg.norm(along), np.degrees(np.arctan2(along[1], along[0]))
    shape = cq.Workplane().slot2D(float(length + 2 * half), 2.0 * half).extrude(float(high - low))
    shape = shape.translate((float(length / 2), 0, 0)).rotate((0, 0, 0), (0, 0, 1), float(turn))
    return cut(shape.translate((*one.tolist(), float(low))), *(bore((*hole[:2], low), Z, radius) for hole in holes))


def bore(point, axis, radius: float, reach: float = 500.0) -> Shape:
    """What a drill takes away on both sides of a point."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    return cyl(np.asarray(point, float) - reach * unit, unit, radius, 2 * reach)


def laid(shape: Shape, origin, x, z) -> Shape:
    """A shape that was drawn in the plane xy, laid into the plane at a point with these directions of x and z."""
    plane = cq.Plane(*(tuple(np.asarray(each, float).tolist()) for each in (origin, x, z)))
    return cq.Workplane(obj=shape.val().moved(cq.Location(plane)))


def union(*shapes: Shape) -> Shape:
    """One solid of several."""
    first, *others = shapes
    for each in others:
        first = first.union(each)
    return first


def cut(shape: Shape, *others: Shape) -> Shape:
    """A solid without others."""
    for each in others:
        shape = shape.cut(each)
    return shape


def headed(point, axis, radius: float, length: float) -> Shape:
    """A pin along an axis with a head on this side of the point."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    head = cyl(np.asarray(point, float) - 0.8 * radius * unit, unit, 1.7 * radius, 0.8 * radius)
    return cyl(point, axis, radius, length).union(head)


def rivet(point, axis, radius: float, length: float) -> Shape:
    """A pin with a head on both ends."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    return headed(point, axis, radius, length).union(cyl(point + length * unit, unit, 1.7 * radius, 0.8 * radius))


def screw(point, axis, radius: float, length: float) -> Shape:
    """A screw along an axis with a socket head on this side of the point."""
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    top = np.asarray(point, float) - 2 * radius * unit
    shape = cyl(point, axis, radius, length).union(cyl(top, axis, 1.6 * radius, 2 * radius))
    return shape.cut(hexagon(top, axis, 0.8 * radius, radius))


def meet(one, radius_1: float, other, radius_2: float) -> np.ndarray:
    """The point at given distances from two points of the plane, on the left of the way from one to the other."""
    one, other = np.asarray(one, float), np.asarray(other, float)
    apart = float(np.linalg.norm(other - one))
    along = (other - one) / apart
    share = (apart**2 + radius_1**2 - radius_2**2) / (2 * apart)
    return one + share * along + np.sqrt(radius_1**2 - share**2) * np.array([-along[1], along[0]])
