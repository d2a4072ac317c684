"""Make the small STEP files in `tests/io/data` with a CAD kernel: `python benchmarks/examples/make_fixtures.py`.

Each holds one thing that readers get wrong. The dimensions stand here and in `tests/io/test_step.py`.
"""

from __future__ import annotations

from pathlib import Path

import cadquery as cq
import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert
from shapes import write
from single import SOLIDS

FOLDER = Path(__file__).parents[2] / "tests" / "io" / "data"


def nested() -> cq.Assembly:
    """A washer and two bolts as a unit that is used twice: instances, and names that come twice."""
    bolt = cq.Workplane().circle(3).extrude(10)
    washer = cq.Workplane().circle(8).circle(3).extrude(2)
    unit = cq.Assembly(name="unit")
    unit.add(washer, name="washer", color=cq.Color("#2A7FB8"))
    unit.add(bolt, name="bolt")
    unit.add(bolt, name="other bolt", loc=cq.Location((0, 0, 20)))
    top = cq.Assembly(name="top")
    top.add(unit, name="left", loc=cq.Location((0, 0, 0), (1, 1, 0), 30))
    top.add(unit, name="right", loc=cq.Location((100, 10, 0), (0, 1, 1), 50))
    return top


def halves() -> cq.Assembly:
    """A plate whose hole, and a pin whose side, are two half cylinders each; both ends of the pin in two halves."""
    half = cq.Workplane().moveTo(0, -5).threePointArc((5, 0), (0, 5)).close().extrude(10)
    pin = half.union(half.rotate((0, 0, 0), (0, 0, 1), 180), clean=False)
    side = cq.Workplane().moveTo(0, -5).threePointArc((5, 0), (0, 5)).lineTo(0, 10).lineTo(10, 10).lineTo(10, -10)
    side = side.lineTo(0, -10).close().extrude(4)
    plate = side.union(side.rotate((0, 0, 0), (0, 0, 1), 180), clean=False)
    assembly = cq.Assembly(name="split")
    assembly.add(pin, name="pin")
    assembly.add(plate, name="plate", loc=cq.Location((0, 0, 3)))
    return assembly


def fillet() -> cq.Assembly:
    """A stepped shaft with a rounded inner corner, which is a torus, and a chamfered end, which is a cone."""
    profile = cq.Workplane("XZ").lineTo(10, 0).lineTo(10, 5).lineTo(8, 5).radiusArc((6, 7), 2)
    shaft = profile.lineTo(6, 19).lineTo(5, 20).lineTo(0, 20).close().revolve(360, (0, 0, 0), (0, 1, 0))
    return _single("shaft", shaft)


def ball() -> cq.Assembly:
    """A ball whose rod crosses the seam of its sphere: cascadio gives triangles that overlap and face inwards."""
    direction = cq.Vector(1, 0.02, 0)
    rod = cq.Workplane(cq.Plane((0, 0, 0), direction.cross(cq.Vector(0.3, 0.2, 1.1)), direction)).circle(8).extrude(30)
    return _single("ball", cq.Workplane().sphere(12.5).rotate((0, 0, 0), (1, 1, 0), 40).union(rod))


def splines() -> cq.Assembly:
    """A part with a plane, a cylinder, a cone and a sphere, all of them written as splines."""
    profile = cq.Workplane("XZ").lineTo(8, 0).lineTo(8, 10).lineTo(5, 16)
    profile = profile.threePointArc((5 * 0.5**0.5, 16 + 5 * 0.5**0.5), (0, 21))
    solid = profile.close().revolve(360, (0, 0, 0), (0, 1, 0)).val()
    return _single("nose", cq.Workplane(cq.Shape.cast(BRepBuilderAPI_NurbsConvert(solid.wrapped, True).Shape())))


def painted() -> cq.Assembly:
    """A blue bush with one red and one green face: cascadio names the faces of the first colour only."""
    bush = cq.Workplane().circle(5).circle(3).extrude(10)
    assembly = cq.Assembly(name="painted").add(bush, name="bush", color=cq.Color("#2A7FB8"))
    assembly["bush"].addSubshape(bush.faces(">Z").val(), color=cq.Color("red"))
    assembly["bush"].addSubshape(bush.faces("<Z").val(), color=cq.Color("green"))
    return assembly


def sheet() -> cq.Assembly:
    """A surface, no solid."""
    return _single("sheet", cq.Workplane(cq.Face.makePlane(10, 10)))


def fasteners() -> cq.Assembly:
    """An arm on a boss under a washer, and two screws, one of them on a loose washer: only the arm has work to do."""
    base = cq.Workplane().box(80, 50, 6).translate((10, 0, -3))
    base = base.cut(cq.Workplane().pushPoints([(30, 15), (30, -15)]).circle(3).extrude(-6))
    base = base.union(cq.Workplane().circle(5).extrude(14))
    arm = cq.Workplane().box(60, 14, 6).translate((-20, 0, 3)).cut(cq.Workplane().circle(5).extrude(6))
    washer = cq.Workplane().circle(9).circle(5).extrude(2)
    screw = cq.Workplane().circle(3).extrude(-5).union(cq.Workplane().polygon(6, 12).extrude(4))
    long_screw = cq.Workplane().circle(3).extrude(-6).union(cq.Workplane().polygon(6, 12).extrude(4))
    loose = cq.Workplane().circle(7).circle(3.4).extrude(1.5)
    assembly = cq.Assembly(name="fastened", loc=cq.Location((12, -7, 31), (0.3, 0.8, -0.5), 50))
    assembly.add(base, name="base")
    assembly.add(arm, name="arm")
    assembly.add(washer, name="washer", loc=cq.Location((0, 0, 6)))
    assembly.add(screw, name="screw", loc=cq.Location((30, 15, 0)))
    assembly.add(long_screw, name="long screw", loc=cq.Location((30, -15, 1.5)))
    assembly.add(loose, name="loose washer", loc=cq.Location((30, -15, 0)))
    return assembly


def flanges() -> cq.Assembly:
    """Two flanges on each other and six bolts with nuts, 20 mm in holes of 22 mm: no bolt is needed, but two are."""
    circle = [(80 * np.cos(angle), 80 * np.sin(angle)) for angle in np.arange(6) * np.pi / 3]
    flange = cq.Workplane().circle(110).circle(50).extrude(20)
    flange = flange.cut(cq.Workplane().pushPoints(circle).circle(11).extrude(20))
    bolt = cq.Workplane().polygon(6, 34).extrude(12).union(cq.Workplane().circle(10).extrude(-60))
    nut = cq.Workplane().polygon(6, 34).circle(10).extrude(-14)
    assembly = cq.Assembly(name="pipe", loc=cq.Location((40, -15, 60), (0.2, -0.7, 0.4), 35))
    assembly.add(flange, name="lower", loc=cq.Location((0, 0, -40)))
    assembly.add(flange, name="upper", loc=cq.Location((0, 0, -20)))
    for number, (x, y) in enumerate(circle, 1):
        assembly.add(bolt, name=f"bolt {number}", loc=cq.Location((x, y, 0)))
        assembly.add(nut, name=f"nut {number}", loc=cq.Location((x, y, -40)))
    return assembly


def _single(name: str, shape: cq.Workplane) -> cq.Assembly:
    return cq.Assembly(name=f"{name} alone").add(shape, name=name)


def solids() -> cq.Assembly:
    """Single solids at the origin, all turned, for `tests/io/test_mesh_faces.py` to tessellate."""
    assembly = cq.Assembly(name="solids")
    for name, make in SOLIDS.items():
        assembly.add(make().rotate(cq.Vector(), cq.Vector(1, 2, 3), 40), name=name)
    return assembly


def main() -> None:
    for make in (nested, halves, fillet, ball, splines, painted, sheet, fasteners, flanges, solids):
        path = FOLDER / f"{make.__name__}.step"
        write(make(), path, parameter_curves=make not in (flanges, solids))
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
