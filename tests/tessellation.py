"""The parts of a STEP file as triangles of other fineness, and as mesh files with float32 coordinates."""

from pathlib import Path

import numpy as np
import pytest

from jaxkin.io import step_convert
from jaxkin.io.step import read_step

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("about", "<u2")])


def tessellated(step, angle):
    """The parts, their triangles with chords of `angle` radians at most."""
    with pytest.MonkeyPatch.context() as patch:
        # a sag of 1 mm and more, so that the angle alone says how fine it is
        patch.setattr(step_convert, "TESSELLATION", {"tol_linear": 1.0, "tol_relative": False, "tol_angular": angle})
        return read_step(step)[0]


def write_stl(path, triangles) -> Path:
    """A binary STL file without normals, which readers take from the corners."""
    records = np.zeros(len(triangles), RECORD)
    records["corners"] = triangles
    path.write_bytes(bytes(80) + np.uint32(len(records)).tobytes() + records.tobytes())
    return path
