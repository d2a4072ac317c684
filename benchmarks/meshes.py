"""Faces recovered from meshes, and the time it takes: `python benchmarks/meshes.py`.

The single solids of `examples/single.py` are tessellated at angles from 0.1 to 0.35 rad, near the origin and a metre
away, written as binary STL and read again. Inventories are counted where kind and number of all faces are those that
were drawn; radii are relative, apart for the three solids whose round faces are a quarter of a turn.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from jaxkin.geometry.surfaces import Cylinder, Sphere
from jaxkin.io.mesh import read_mesh

TESTS = Path(__file__).parents[1] / "tests"
sys.path[:0] = [str(TESTS), str(TESTS / "io")]

from test_mesh_faces import QUARTERS, SOLIDS  # noqa: E402

from tessellation import tessellated, write_stl  # noqa: E402

ANGLES = (0.1, 0.15, 0.2, 0.25, 0.3, 0.35)
DIRECTION = np.array([0.6, -0.64, 0.48])


def main() -> None:
    print("chord [rad]  away [mm]  triangles  inventories  radii  of quarters  seconds")
    with TemporaryDirectory() as folder:
        for angle in ANGLES:
            drawn = tessellated(TESTS / "io" / "data" / "solids.step", angle)
            for away in (0.0, 1000.0):
                exact, worst, start = 0, {True: 0.0, False: 0.0}, time.process_time()
                for solid in drawn:
                    file = write_stl(Path(folder) / "solid.stl", solid.triangles + away * DIRECTION)
                    faces = read_mesh(file)[0][0].faces
                    kinds, radii = SOLIDS[solid.name]
                    found = sorted(face.surface.radius for face in faces if isinstance(face.surface, Cylinder | Sphere))
                    if Counter(face.surface.kind for face in faces) == kinds:
                        exact += 1
                        if radii and len(found) == len(radii):
                            error = float(np.abs(np.divide(found, radii) - 1).max())
                            worst[solid.name in QUARTERS] = max(error, worst[solid.name in QUARTERS])
                count = sum(len(solid.triangles) for solid in drawn)
                print(
                    f"{angle:11}{away:11.0f}{count:11}{exact:10}/{len(drawn)}{worst[False]:7.0e}{worst[True]:13.0e}"
                    f"{time.process_time() - start:9.1f}"
                )


if __name__ == "__main__":
    main()
