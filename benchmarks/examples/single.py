"""Single solids, each with something that makes its faces hard to recover from triangles."""

from __future__ import annotations

import cadquery as cq


def block(*size: float) -> cq.Workplane:
    return cq.Workplane().box(*size)


def rod(radius: float, length: float, plane: str = "XY") -> cq.Workplane:
    return cq.Workplane(plane).circle(radius).extrude(length)


def capsule() -> cq.Workplane:
    """A cylinder that runs smoothly into half a ball."""
    profile = cq.Workplane("XZ").lineTo(5, 0).lineTo(5, 20).threePointArc((5 * 0.5**0.5, 20 + 5 * 0.5**0.5), (0, 25))
    return profile.close().revolve(360, (0, 0, 0), (0, 1, 0))


def shaft() -> cq.Workplane:
    """A stepped shaft with a rounded inner corner, which is a torus, and a chamfered end, which is a cone."""
    profile = cq.Workplane("XZ").lineTo(10, 0).lineTo(10, 5).lineTo(8, 5).radiusArc((6, 7), 2)
    return profile.lineTo(6, 19).lineTo(5, 20).lineTo(0, 20).close().revolve(360, (0, 0, 0), (0, 1, 0))


def bolt() -> cq.Workplane:
    bolt = rod(8, 5).faces(">Z").workplane().circle(4).extrude(30).faces(">Z").chamfer(0.8)
    return bolt.faces("<Z").workplane().polygon(6, 7).cutBlind(-3)


def tilted() -> cq.Workplane:
    """A rod cut off askew."""
    return rod(6, 40).cut(block(40, 40, 20).rotate((0, 0, 0), (1, 0, 0), 30).translate((0, 0, 35)))


def angle() -> cq.Workplane:
    """An angle bar whose edges along it are all rounded."""
    profile = cq.Workplane().polyline([(0, 0), (30, 0), (30, 10), (10, 10), (10, 40), (0, 40)])
    return profile.close().extrude(12).edges("|Z").fillet(2)


def hollow() -> cq.Workplane:
    """A box with a conical bore that leaves through a side, where meshers leave triangles far off the cone."""
    bore = cq.Solid.makeCone(0.2, 38, 90, cq.Vector(-35, 0, -10), cq.Vector(0.92, 0, 0.39))
    return block(55, 50, 53).cut(cq.Workplane(obj=bore))


_MAKERS = {
    "box": lambda: block(10, 20, 30),
    "pin": lambda: rod(3, 20),
    "bush": lambda: cq.Workplane().circle(5).circle(3).extrude(10),
    "cone": lambda: cq.Workplane(obj=cq.Solid.makeCone(8, 0, 15)),
    "frustum": lambda: cq.Workplane(obj=cq.Solid.makeCone(8, 3, 15)),
    "nut": lambda: cq.Workplane().polygon(6, 10).circle(2.5).extrude(5),
    "slot": lambda: cq.Workplane().slot2D(40, 12).extrude(5),
    "rounded plate": lambda: block(20, 30, 10).edges("|Z").fillet(3),
    "rounded box": lambda: block(20, 30, 10).edges().fillet(2),
    "angle": angle,
    "capsule": capsule,
    "shaft": shaft,
    "cross": lambda: cq.Workplane().cylinder(40, 8).union(cq.Workplane("XZ").cylinder(40, 5)),
    "cross hole": lambda: cq.Workplane().cylinder(40, 8).cut(cq.Workplane("XZ").cylinder(40, 4)),
    "ball joint": lambda: cq.Workplane().sphere(12.5).union(rod(5, 30)),
    "socket": lambda: block(30, 30, 15).cut(cq.Workplane().sphere(10).translate((0, 0, 7.5))),
    "countersunk": lambda: block(40, 40, 10).faces(">Z").workplane().cskHole(6, 12, 82),
    "tilted": tilted,
    "bolt": bolt,
    "flat": lambda: rod(10, 30).cut(block(40, 40, 40).translate((0, 29, 0))),
    "hollow": hollow,
    "step": lambda: rod(40, 10).faces(">Z").workplane().circle(1).extrude(2),
}

SOLIDS = {name: (lambda make=make: make().val()) for name, make in _MAKERS.items()}
"""Name -> function that makes the solid."""
