"""Make the assemblies in `jaxkin/examples` with a CAD kernel: `python benchmarks/examples/make_examples.py`.

Needs cadquery, which jaxkin itself does not. All dimensions come from `jaxkin.examples.EXAMPLES`. Each part is drawn in
its own frame and placed in the assembly, as people do, so that the files hold a different placement for every part.
"""

from __future__ import annotations

import re
from pathlib import Path

import cadquery as cq
import numpy as np

from jaxkin.examples import EXAMPLES, Example
from jaxkin.geometry.pose import Pose, frame

FOLDER = Path(__file__).parents[2] / "jaxkin" / "examples"
SLATE, CORAL, OCEAN, AMBER = "#AEB8C2", "#E4572E", "#2A7FB8", "#F0A830"
GAP = 0.5  # the top of a pin in the ground stays this far below the link that passes over it


def fourbar(example: Example) -> cq.Assembly:
    size = example.dimensions
    thick, r_ground, r_pin = size["thickness"], size["ground pin radius"], size["pin radius"]
    a, d = np.zeros(3), np.array([size["ground"], 0.0, 0.0])
    b = size["crank"] * np.array([np.cos(size["angle"]), np.sin(size["angle"]), 0.0])
    c = _meet(b, size["coupler"], d, size["rocker"])

    ground = _plate(-34, 134, -30, 30, 10)
    ground = ground.cut(_holes([(x, y) for x in (-22, 122) for y in (-18, 18)], 3.5, 10).translate((0, 0, -10)))
    for point in (a, d):
        ground = ground.union(_pin(point[0], point[1], r_ground, 0, thick - GAP))
    swing = {"thickness": thick, "hole": r_ground, "pin": r_pin, "ends": (12.0, 10.0)}
    crank, rocker = _swing_link(size["crank"], **swing), _swing_link(size["rocker"], **swing)
    coupler = _bar(size["coupler"], (10.0, 10.0), thick).cut(_holes([(0, 0), (size["coupler"], 0)], r_pin, thick))

    return _assembly(
        "fourbar",
        example.placement,
        {
            "ground": (ground, SLATE, np.eye(4)),
            "crank": (crank, CORAL, frame(a, [0, 0, 1], b - a)),
            "coupler": (coupler, OCEAN, frame(b + [0, 0, thick], [0, 0, 1], c - b)),
            "rocker": (rocker, AMBER, frame(d, [0, 0, 1], c - d)),
        },
    )


def slider_crank(example: Example) -> cq.Assembly:
    size = example.dimensions
    thick, r_ground, r_pin, offset = size["thickness"], size["ground pin radius"], size["pin radius"], size["offset"]
    length, half_width = size["slider length"], size["slider width"] / 2
    b = size["crank"] * np.array([np.cos(size["angle"]), np.sin(size["angle"]), 0.0])
    c = np.array([b[0] + np.sqrt(size["rod"] ** 2 - (b[1] - offset) ** 2), offset, 0.0])

    ground = _plate(-34, 190, -52, 36, 10).union(_pin(0, 0, r_ground, 0, thick - GAP))
    ground = ground.cut(_holes([(x, y) for x in (-22, 178) for y in (-40, 24)], 3.5, 10).translate((0, 0, -10)))
    for y in (offset - half_width - 8, offset + half_width):  # lower than the slider: the rod passes over the rails
        ground = ground.union(cq.Workplane().box(128, 8, thick - 2, centered=False).translate((54, y, 0)))
    crank = _swing_link(size["crank"], thick, r_ground, r_pin, (12.0, 10.0))
    rod = _bar(size["rod"], (10.0, 10.0), thick).cut(_holes([(0, 0), (size["rod"], 0)], r_pin, thick))
    # Chamfered, not rounded: a fillet would touch its rail along the line where it begins.
    slider = cq.Workplane().box(length, 2 * half_width, thick, centered=(True, True, False)).edges("|Z").chamfer(3)
    slider = slider.union(_pin(0, 0, r_pin, thick, 2 * thick + 1))

    return _assembly(
        "slider_crank",
        example.placement,
        {
            "ground": (ground, SLATE, np.eye(4)),
            "crank": (crank, CORAL, frame(np.zeros(3), [0, 0, 1], b)),
            "rod": (rod, OCEAN, frame(b + [0, 0, thick], [0, 0, 1], c - b)),
            "slider": (slider, AMBER, frame(c, [0, 0, 1], [1, 0, 0])),
        },
    )


def cam(example: Example) -> cq.Assembly:
    size = example.dimensions
    angle, radius, height = size["angle"], size["cam radius"], size["stem height"]
    y_foot = size["eccentricity"] * np.sin(angle) + radius
    disc = _pin(size["eccentricity"], 0, radius, 0, 12, chamfer=0).union(_pin(0, 0, size["shaft radius"], -8, 0, 0))
    foot = cq.Workplane().box(40, 5, 12, centered=(True, False, False))
    stem = cq.Workplane("XZ", origin=(0, 5, height)).circle(size["stem radius"]).extrude(-55)
    plate = cq.Workplane().box(80, 100, 10, centered=(True, False, False)).translate((0, -25, -10))
    guide = cq.Workplane().box(30, 20, 20, centered=(True, False, False)).translate((0, 40, 0))
    bore = cq.Workplane("XZ", origin=(0, 40, height)).circle(size["stem radius"]).extrude(-20)
    shaft_hole = _holes([(0, 0)], size["shaft radius"], 10).translate((0, 0, -10))

    return _assembly(
        "cam with follower",  # a part and its assembly may not share a name
        example.placement,
        {
            "cam": (disc, CORAL, frame(np.zeros(3), [0, 0, 1], [np.cos(angle), np.sin(angle), 0])),
            "follower": (foot.union(stem), AMBER, frame([0, y_foot, 0], [0, 0, 1], [1, 0, 0])),
            "frame": (plate.union(guide).cut(shaft_hole).cut(bore), SLATE, np.eye(4)),
        },
    )


def _bar(length: float, ends: tuple[float, float], thickness: float) -> cq.Workplane:
    """A bar along x with round ends about 0 and `length`, of the two radii, joined by their common tangents."""
    sin = (ends[0] - ends[1]) / length
    normal = np.array([sin, np.sqrt(1 - sin**2)])
    up, down = normal, normal * [1, -1]
    start, end = ends[0] * up, [length, 0] + ends[1] * up
    return (
        cq.Workplane()
        .moveTo(*start)
        .lineTo(*end)
        .threePointArc((length + ends[1], 0), tuple([length, 0] + ends[1] * down))
        .lineTo(*(ends[0] * down))
        .threePointArc((-ends[0], 0), tuple(start))
        .close()
        .extrude(thickness)
    )


def _swing_link(length: float, thickness: float, hole: float, pin: float, ends: tuple[float, float]) -> cq.Workplane:
    """A bar with a hole at 0 and at `length` a pin that stands one unit out of a second bar laid on top."""
    bar = _bar(length, ends, thickness).cut(_holes([(0, 0)], hole, thickness))
    return bar.union(_pin(length, 0, pin, thickness, 2 * thickness + 1))


def _pin(x: float, y: float, radius: float, low: float, high: float, chamfer: float = 0.8) -> cq.Workplane:
    pin = cq.Workplane(origin=(x, y, low)).circle(radius).extrude(high - low)
    return pin.faces(">Z").chamfer(chamfer) if chamfer else pin


def _holes(centres: list[tuple[float, float]], radius: float, height: float) -> cq.Workplane:
    return cq.Workplane().pushPoints(centres).circle(radius).extrude(height)


def _plate(x0: float, x1: float, y0: float, y1: float, thickness: float) -> cq.Workplane:
    """A plate with rounded corners whose top is z = 0."""
    plate = cq.Workplane().box(x1 - x0, y1 - y0, thickness, centered=False).edges("|Z").fillet(12)
    return plate.translate((x0, y0, -thickness))


def _meet(p: np.ndarray, r_p: float, q: np.ndarray, r_q: float) -> np.ndarray:
    """The point at distance r_p from p and r_q from q, left of the direction from p to q: the open branch."""
    distance = np.linalg.norm(q - p)
    along = (q - p) / distance
    x = (distance**2 + r_p**2 - r_q**2) / (2 * distance)
    return p + x * along + np.sqrt(r_p**2 - x**2) * np.cross([0, 0, 1], along)


def _assembly(name: str, placement: Pose, parts: dict[str, tuple[cq.Workplane, str, Pose]]) -> cq.Assembly:
    assembly = cq.Assembly(name=name)
    for part, (solid, color, pose) in parts.items():
        world = placement @ pose
        plane = cq.Plane(tuple(world[:3, 3]), tuple(world[:3, 0]), tuple(world[:3, 2]))
        assembly.add(solid, name=part, color=cq.Color(color), loc=cq.Location(plane))
    return assembly


def write(assembly: cq.Assembly, path: Path) -> None:
    """Write a STEP file without the time of day, which the kernel puts into the header."""
    assembly.export(str(path))
    text = re.sub(r"FILE_NAME\('[^']*','[^']*'", f"FILE_NAME('{path.name}','2025-01-01T00:00:00'", path.read_text())
    path.write_text(text)


def main() -> None:
    for name, make in {"fourbar": fourbar, "slider_crank": slider_crank, "cam": cam}.items():
        example = EXAMPLES[name]
        write(make(example), FOLDER / example.file)
        print(f"{example.file}: {(FOLDER / example.file).stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
