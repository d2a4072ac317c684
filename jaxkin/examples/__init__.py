"""Assemblies that come with the package, and the dimensions that they were drawn with.

Each is a STEP file in millimetres. It was drawn in a plane, z being the direction of the pins, and then placed in the
world by one rigid pose, so that nothing in the file is parallel to an axis; `benchmarks/examples/make_examples.py`
makes the files from the numbers below.
"""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import numpy as np

from jaxkin.examples.example import Example as Example
from jaxkin.examples.paper import PAPER_EXAMPLES

EXAMPLES: dict[str, Example] = {
    "fourbar": Example(
        file="fourbar.step",
        description="Crank-rocker four-bar linkage; pins in holes, on the open branch at a crank angle of 60 degrees",
        fixed=("ground",),
        drive=("ground", "crank"),
        unit="mm",
        # Pins A (ground-crank) at the origin, B (crank-coupler), C (coupler-rocker), D (ground-rocker) on the x axis.
        dimensions={
            "ground": 100.0,
            "crank": 40.0,
            "coupler": 120.0,
            "rocker": 80.0,
            "angle": np.pi / 3,
            "ground pin radius": 6.0,
            "pin radius": 5.0,
            "thickness": 8.0,
        },
        turn=(np.array([0.48, -0.31, 0.82]), 0.93),
        shift=np.array([37.2, -21.8, 54.6]),
    ),
    "slider_crank": Example(
        file="slider_crank.step",
        description="Offset slider-crank; the slider runs on the ground between two rails, crank angle 60 degrees",
        fixed=("ground",),
        drive=("ground", "crank"),
        unit="mm",
        # Crank pin A at the origin; the slider's pin moves along x on the line y = offset, at positive x.
        dimensions={
            "crank": 40.0,
            "rod": 120.0,
            "offset": -20.0,
            "angle": np.pi / 3,
            "ground pin radius": 6.0,
            "pin radius": 5.0,
            "thickness": 8.0,
            "slider length": 36.0,
            "slider width": 30.0,
        },
        turn=(np.array([-0.62, 0.55, 0.37]), 1.21),
        shift=np.array([-28.9, 43.1, 17.3]),
    ),
    "cam": Example(
        file="cam.step",
        description="Eccentric cam with flat-faced follower: Fig. 6 of the paper; p1, p2, p3 are cam, follower, frame",
        fixed=("frame",),
        drive=("frame", "cam"),
        unit="mm",
        # Shaft of the cam at the origin; the follower's stem along y. Lift = eccentricity (sin angle - sin angle_0).
        dimensions={
            "cam radius": 15.0,
            "eccentricity": 5.0,
            "angle": np.pi / 6,
            "shaft radius": 5.0,
            "stem radius": 4.0,
            "stem height": 6.0,
        },
        turn=(np.array([0.27, 0.71, -0.44]), 0.78),
        shift=np.array([19.4, 32.7, -41.5]),
    ),
    **PAPER_EXAMPLES,
}


def path(name: str) -> Path:
    """Find the path of the file of an example, by its name in `EXAMPLES`; KeyError names those that exist."""
    if name not in EXAMPLES:
        raise KeyError(f"no example is named {name!r}: choose one of {', '.join(EXAMPLES)}")
    return Path(str(resources.files(__name__) / EXAMPLES[name].file))
