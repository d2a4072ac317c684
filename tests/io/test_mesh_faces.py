"""Faces recovered from tessellations with float32 coordinates, near the origin and a metre away from it.

The solids are those of `benchmarks/examples/single.py`, in millimetres and turned. What the corners of a
tessellation keep is exact: only their rounding limits what comes back.
"""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from jaxkin.io.mesh import read_mesh
from tessellation import tessellated, write_stl

# name: inventory, and the radii that are drawn, without those of a quarter turn or less
SOLIDS = {
    "box": ({"plane": 6}, []),
    "pin": ({"plane": 2, "cylinder": 1}, [3]),
    "bush": ({"plane": 2, "cylinder": 2}, [3, 5]),
    "cone": ({"plane": 1, "cone": 1}, []),
    "frustum": ({"plane": 2, "cone": 1}, []),
    "nut": ({"plane": 8, "cylinder": 1}, [2.5]),
    "slot": ({"plane": 4, "cylinder": 2}, [6, 6]),
    "rounded plate": ({"plane": 6, "cylinder": 4}, [3] * 4),
    "rounded box": ({"plane": 6, "cylinder": 12, "sphere": 8}, [2] * 20),
    "angle": ({"plane": 8, "cylinder": 6}, [2] * 6),
    "capsule": ({"plane": 1, "cylinder": 1, "sphere": 1}, [5, 5]),
    "shaft": ({"plane": 3, "cylinder": 2, "cone": 1}, [6, 10]),
    "cross": ({"plane": 4, "cylinder": 2}, [5, 8]),
    "cross hole": ({"plane": 2, "cylinder": 2}, [4, 8]),
    "ball joint": ({"plane": 1, "cylinder": 1, "sphere": 1}, [5, 12.5]),
    "socket": ({"plane": 6, "sphere": 1}, [10]),
    "countersunk": ({"plane": 6, "cylinder": 1, "cone": 1}, [3]),
    "tilted": ({"plane": 2, "cylinder": 1}, [6]),
    "bolt": ({"plane": 10, "cylinder": 2, "cone": 1}, [4, 8]),
    "flat": ({"plane": 4, "cylinder": 1}, [10]),
    "hollow": ({"plane": 6, "cone": 1}, []),
    "step": ({"plane": 3, "cylinder": 2}, [1, 40]),
}
"""Solids drawn with the CAD kernel and how many faces of each kind they have."""

QUARTERS = ("rounded plate", "rounded box", "angle")
"""Solids whose round faces are a quarter of a turn."""


@pytest.fixture(params=[(0.1, 0.0, 1200), (0.35, 1000.0, 1200)], ids=str, scope="module")
def solids(request, tmp_path_factory):
    """How far from the origin, and name of the solid -> its part, read from a file of its own.

    At an angle, those with up to so many triangles: the others take seconds each, and are held to the same by
    `benchmarks/meshes.py`.
    """
    angle, away, most = request.param
    folder = tmp_path_factory.mktemp("solids")
    parts = {}
    for solid in tessellated(Path(__file__).parent / "data" / "solids.step", angle):
        if len(solid.triangles) <= most:
            file = write_stl(folder / f"{solid.name}.stl", solid.triangles + away * np.array([0.6, -0.64, 0.48]))
            (parts[solid.name],), unit = read_mesh(file)
            assert (parts[solid.name].name, unit) == (solid.name, "")
    assert len(parts) >= 11
    return away, parts


@pytest.mark.long
def test_the_faces_are_those_that_were_drawn(solids):
    for name, part in solids[1].items():
        assert Counter(face.surface.kind for face in part.faces) == SOLIDS[name][0], name
        tori = [note for note in part.notes if "torus, not one of the four surfaces" in note]
        assert (len(tori), len(part.notes)) == ((1, 1) if name == "shaft" else (0, 0)), part.notes


@pytest.mark.long
def test_radii_come_back(solids):
    """To 1e-5; a metre away the corners are 6e-5 mm apart, which a quarter of a turn magnifies by some ten."""
    away, parts = solids
    for name, part in parts.items():
        found = sorted(face.surface.radius for face in part.faces if hasattr(face.surface, "radius"))
        if name != "shaft":
            assert len(found) == len(SOLIDS[name][1])
        accuracy = 1e-5 if not (away and name in QUARTERS) else 1e-4
        np.testing.assert_allclose(found, SOLIDS[name][1], rtol=accuracy, err_msg=name)
