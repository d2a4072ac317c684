"""How long `inspect` takes for a large assembly: `uv run --group cad python benchmarks/bearings.py`.

Two plates with shafts, screws, washers and nuts, and thirty bearings: 24 of them are one product of 59,000 triangles
with 28 balls, six are sub-assemblies of twelve parts. The file is drawn on the fly; its 400 parts are of nine products.
"""

from __future__ import annotations

import resource
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import cadquery as cq
import numpy as np

import jaxkin as jk

PARTS = 400
RACE, BALL, WIDTH = 19.0, 2.0, 10.0
"""Radius of the circle of the balls, radius of a ball, width of a bearing: millimetres, as all lengths."""
RADII = (26.0, 21.0, 17.0, 12.0)
"""Of the outer ring and of the inner one."""
LEVELS = (0.0, 40.0)
"""Middles of the two plates."""
PLATE = (300.0, 200.0, 12.0)


def seats() -> list[tuple[float, float]]:
    """The middles of the bearings in a plate."""
    return list(product((-120.0, -60.0, 0.0, 60.0, 120.0), (-60.0, 0.0, 60.0)))


def screws() -> list[tuple[float, float]]:
    """The axes of the screws: four around each bearing."""
    return [(x + dx, y + dy) for x, y in seats() for dx, dy in product((-28.0, 28.0), repeat=2)]


def rings() -> list[cq.Workplane]:
    """The outer and the inner ring of a bearing, with their grooves."""
    groove = cq.Workplane(obj=cq.Solid.makeTorus(RACE, BALL + 0.02))
    bare = [cq.Workplane().circle(outer).circle(inner).extrude(WIDTH) for outer, inner in (RADII[:2], RADII[2:])]
    return [ring.translate((0, 0, -WIDTH / 2)).cut(groove) for ring in bare]


def around(balls: int) -> list[cq.Location]:
    """The places of the balls of a bearing."""
    angles = 2 * np.pi * np.arange(balls) / balls
    return [cq.Location((RACE * np.cos(angle), RACE * np.sin(angle), 0.0)) for angle in angles.tolist()]


def bearing() -> cq.Compound:
    """A bearing with 28 balls as one product."""
    ball = cq.Workplane().sphere(BALL).val()
    return cq.Compound.makeCompound([*(ring.val() for ring in rings()), *(ball.moved(place) for place in around(28))])


def bearing_of_parts() -> cq.Assembly:
    """A bearing with ten balls as a sub-assembly."""
    assembly = cq.Assembly(name="rolling")
    for name, ring in zip(("outer", "inner"), rings(), strict=True):
        assembly.add(ring, name=name)
    ball = cq.Workplane().sphere(BALL)
    for number, place in enumerate(around(10)):
        assembly.add(ball, name=f"ball {number}", loc=place)
    return assembly


def placed() -> Iterator[tuple[object, str, tuple[float, float, float]]]:
    """What the assembly is made of, with names and places, until there are enough parts."""
    plate = cq.Workplane().box(*PLATE).faces(">Z").workplane().pushPoints(seats()).hole(2 * RADII[0])
    plate = plate.faces(">Z").workplane().pushPoints(screws()).hole(6.2)
    shaft, whole, split = cq.Workplane().circle(RADII[3]).extrude(120), bearing(), bearing_of_parts()
    screw = cq.Workplane().circle(3).extrude(40).faces("<Z").workplane().circle(5).extrude(6)
    nut = cq.Workplane().polygon(6, 11.5).circle(3).extrude(5)
    washer = cq.Workplane().circle(6).circle(3.2).extrude(1)
    for level in LEVELS:
        yield plate, "plate", (0.0, 0.0, level)
    for x, y in seats():
        yield shaft, "shaft", (x, y, -30.0)
    for number, (level, (x, y)) in enumerate(product(LEVELS, seats())):
        yield (whole, "bearing", (x, y, level)) if number < 24 else (split, "rolling", (x, y, level))
    for x, y in screws():
        yield screw, "screw", (x, y, -7.0)
        yield washer, "washer", (x, y, -7.0)
        yield washer, "washer", (x, y, 6.0)
        yield nut, "nut", (x, y, 7.0)
    for number in range(PARTS):
        yield screw, "spare", (-140.0 + 12 * (number % 24), 90.0 - 180 * (number // 24), 80.0)


def draw(path: Path) -> None:
    """Write the STEP file."""
    assembly, parts = cq.Assembly(name="bearings"), 0
    for number, (what, name, place) in enumerate(placed()):
        parts += 12 if name == "rolling" else 1
        assembly.add(what, name=f"{name} {number}", loc=cq.Location(place))
        if parts == PARTS:
            break
    assembly.export(str(path))


def main() -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "bearings.step"
        draw(path)
        begun = [perf_counter()]
        assembly = jk.load(path)
        begun.append(perf_counter())
        contacts = assembly.contacts()
        begun.append(perf_counter())
        proposals = assembly.proposals()
        begun.append(perf_counter())
        text = str(assembly.mechanism(fixed=proposals[0].fixed))
        begun.append(perf_counter())
    triangles = sum(len(part.triangles) for part in assembly.parts)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print("parts  triangles  contacts  read [s]  contacts [s]  proposals [s]  report [s]  all [s]  memory [GB]")
    numbers = (len(assembly.parts), triangles, len(contacts), *np.diff(begun), begun[-1] - begun[0], memory)
    print("{:5}{:11}{:10}{:10.1f}{:14.1f}{:15.1f}{:12.1f}{:9.1f}{:13.2f}".format(*numbers))
    assert text


if __name__ == "__main__":
    main()
