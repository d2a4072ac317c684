"""Make the assemblies in `jaxkin/examples` with a CAD kernel: `python benchmarks/examples/make_examples.py`.

Needs cadquery, which jaxkin itself does not. All dimensions come from `jaxkin.examples.EXAMPLES`. Each part is drawn in
its own frame and placed in the assembly, as people do, so that the files hold a different placement for every part.
"""

from __future__ import annotations

import sys
from pathlib import Path

import cadquery as cq
import numpy as np
from paper import air_cylinder, eighteen_bars
from shapes import AMBER, CORAL, OCEAN, SLATE, assembly, bar, holes, meet, pin, plate, swing_link, write

from jaxkin.examples import EXAMPLES, Example
from jaxkin.examples.paper import PAPER_EXAMPLES
from jaxkin.geometry.pose import frame

FOLDER = Path(__file__).parents[2] / "jaxkin" / "examples"
GAP = 0.5  # the top of a pin in the ground stays this far below the link that passes over it


def fourbar(example: Example) -> cq.Assembly:
    size = example.dimensions
    thick, r_ground, r_pin = size["thickness"], size["ground pin radius"], size["pin radius"]
    a, d = np.zeros(3), np.array([size["ground"], 0.0, 0.0])
    b = size["crank"] * np.array([np.cos(size["angle"]), np.sin(size["angle"]), 0.0])
    c = meet(b, size["coupler"], d, size["rocker"])

    ground = plate(-34, 134, -30, 30, 10)
    ground = ground.cut(holes([(x, y) for x in (-22, 122) for y in (-18, 18)], 3.5, 10).translate((0, 0, -10)))
    for point in (a, d):
        ground = ground.union(pin(point[0], point[1], r_ground, 0, thick - GAP))
    swing = {"thickness": thick, "hole": r_ground, "radius": r_pin, "ends": (12.0, 10.0)}
    crank, rocker = swing_link(size["crank"], **swing), swing_link(size["rocker"], **swing)
    coupler = bar(size["coupler"], (10.0, 10.0), thick).cut(holes([(0, 0), (size["coupler"], 0)], r_pin, thick))

    return assembly(
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

    ground = plate(-34, 190, -52, 36, 10).union(pin(0, 0, r_ground, 0, thick - GAP))
    ground = ground.cut(holes([(x, y) for x in (-22, 178) for y in (-40, 24)], 3.5, 10).translate((0, 0, -10)))
    for y in (offset - half_width - 8, offset + half_width):  # lower than the slider: the rod passes over the rails
        ground = ground.union(cq.Workplane().box(128, 8, thick - 2, centered=False).translate((54, y, 0)))
    crank = swing_link(size["crank"], thick, r_ground, r_pin, (12.0, 10.0))
    rod = bar(size["rod"], (10.0, 10.0), thick).cut(holes([(0, 0), (size["rod"], 0)], r_pin, thick))
    # Chamfered, not rounded: a fillet would touch its rail along the line where it begins.
    slider = cq.Workplane().box(length, 2 * half_width, thick, centered=(True, True, False)).edges("|Z").chamfer(3)
    slider = slider.union(pin(0, 0, r_pin, thick, 2 * thick + 1))

    return assembly(
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
    disc = pin(size["eccentricity"], 0, radius, 0, 12, chamfer=0).union(pin(0, 0, size["shaft radius"], -8, 0, 0))
    foot = cq.Workplane().box(40, 5, 12, centered=(True, False, False))
    stem = cq.Workplane("XZ", origin=(0, 5, height)).circle(size["stem radius"]).extrude(-55)
    base = cq.Workplane().box(80, 100, 10, centered=(True, False, False)).translate((0, -25, -10))
    guide = cq.Workplane().box(30, 20, 20, centered=(True, False, False)).translate((0, 40, 0))
    bore = cq.Workplane("XZ", origin=(0, 40, height)).circle(size["stem radius"]).extrude(-20)
    shaft_hole = holes([(0, 0)], size["shaft radius"], 10).translate((0, 0, -10))

    return assembly(
        "cam with follower",  # a part and its assembly may not share a name
        example.placement,
        {
            "cam": (disc, CORAL, frame(np.zeros(3), [0, 0, 1], [np.cos(angle), np.sin(angle), 0])),
            "follower": (foot.union(stem), AMBER, frame([0, y_foot, 0], [0, 0, 1], [1, 0, 0])),
            "frame": (base.union(guide).cut(shaft_hole).cut(bore), SLATE, np.eye(4)),
        },
    )


MAKE = {
    "fourbar": fourbar,
    "slider_crank": slider_crank,
    "cam": cam,
    "eighteen_bars": eighteen_bars,
    "air_cylinder": air_cylinder,
}


def main() -> None:
    """Make the examples named on the command line, by default all."""
    for name in sys.argv[1:] or MAKE:
        example = EXAMPLES[name]
        write(MAKE[name](example), FOLDER / example.file, parameter_curves=name not in PAPER_EXAMPLES)
        print(f"{example.file}: {(FOLDER / example.file).stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
