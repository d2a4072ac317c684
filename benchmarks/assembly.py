"""How the time from a STEP file to joints grows with the assembly: `uv run --group cad python benchmarks/assembly.py`.

A lattice of plates in two layers on a base, each hinged to its four neighbours by pins in holes: each hinge is a face
on a face and a pin in a hole, and the lower plates lie on the base. The files are drawn on the fly. The broad phase is
also timed alone, on boxes of so many parts, and on a lattice that is far larger.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeVar

import cadquery as cq
import numpy as np

import jaxkin as jk
from jaxkin.contacts.boxes import overlapping

T = TypeVar("T")

LATTICES = ((3, 3), (4, 7), (9, 11), (13, 23))
"""Rows and columns of plates: 10, 29, 100 and 300 parts with the base."""
PITCH, REACH, THICKNESS, RADIUS = 40.0, 30.0, 6.0, 4.0


def plates() -> tuple[cq.Workplane, cq.Workplane]:
    """The lower plate with its pins and the upper plate with its holes."""
    ends = [(REACH, 0), (0, REACH), (-REACH, 0), (0, -REACH)]
    hinges = [(PITCH / 2 * np.sign(x), PITCH / 2 * np.sign(y)) for x, y in ends]
    plate = cq.Workplane().polyline(ends).close().extrude(THICKNESS)
    pins = cq.Workplane(origin=(0, 0, THICKNESS)).pushPoints(hinges).circle(RADIUS).extrude(THICKNESS + 1)
    holes = cq.Workplane().pushPoints(hinges).circle(RADIUS).extrude(THICKNESS)
    return plate.union(pins), plate.cut(holes)


def lattice(rows: int, columns: int, path: Path) -> None:
    """The STEP file of a lattice, askew in space."""
    lower, upper = plates()
    width, depth = columns * PITCH, rows * PITCH
    base = cq.Workplane().box(width + PITCH, depth + PITCH, 10, centered=(False, False, False))
    assembly = cq.Assembly(name="lattice", loc=cq.Location((31, -17, 8), (0.4, 0.2, 0.9), 37))
    assembly.add(base, name="base", loc=cq.Location((-PITCH, -PITCH, -10)))
    for row in range(rows):
        for column in range(columns):
            odd = (row + column) % 2
            place = cq.Location((column * PITCH, row * PITCH, odd * THICKNESS))
            assembly.add(upper if odd else lower, name=f"plate {row}.{column}", loc=place)
    assembly.export(str(path))


def seconds(call: Callable[[], T]) -> tuple[T, float]:
    start = time.perf_counter()
    result = call()
    return result, time.perf_counter() - start


def broad_phase(count: int) -> float:
    """The time to find the neighbours among the boxes of a square lattice of `count` plates, for a plate and log N."""
    side = int(np.sqrt(count))
    centres = np.stack(np.meshgrid(np.arange(side), np.arange(side), [0.0]), axis=-1).reshape(-1, 3) * PITCH
    boxes = np.stack([centres - 0.7 * PITCH, centres + 0.7 * PITCH], axis=1)
    best = min(seconds(lambda: overlapping(boxes, 1e-3))[1] for _ in range(3))
    return best / (len(boxes) * np.log2(len(boxes)))


def main() -> None:
    print("parts  contacts  joints  loops  file [kB]  read [s]  contacts [s]  joints [s]  all [s]")
    with TemporaryDirectory() as folder:
        for rows, columns in LATTICES:
            path = Path(folder) / f"lattice-{rows}-{columns}.step"
            lattice(rows, columns, path)
            assembly, reading = seconds(lambda: jk.load(path))  # noqa: B023
            contacts, finding = seconds(assembly.contacts)
            mechanism, joining = seconds(lambda: assembly.mechanism(fixed=["base"]))  # noqa: B023
            numbers = len(assembly.parts), len(contacts), len(mechanism.all_joints), len(mechanism.structure.loops)
            print(
                "{:5}{:10}{:8}{:7}".format(*numbers)
                + f"{path.stat().st_size / 1000:11.0f}{reading:10.2f}{finding:14.2f}{joining:12.2f}"
                + f"{reading + finding + joining:9.2f}"
            )
    print("\nboxes  broad phase, ns over N log2 N")
    for count in (100, 1_000, 10_000, 100_000):
        print(f"{count:6}{1e9 * broad_phase(count):8.0f}")


if __name__ == "__main__":
    main()
