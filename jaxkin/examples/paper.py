"""The paper's larger examples, Fig. 3 and 5 and Fig. 7, and the numbers of their joints in its tables.

The paper prints no dimensions: those here are ours, and so are the places of the pins in Fig. 3. Which parts meet in
which joint, and in which contact state, is the paper's.
"""

from __future__ import annotations

import numpy as np

from jaxkin.examples.example import Example

EIGHTEEN_BARS: dict[str, tuple[str, str]] = {
    f"j{joint}": (f"p{part1}", f"p{part2}")
    for joint, part1, part2 in (
        *((1, 1, 2), (2, 2, 3), (3, 3, 11), (4, 3, 4), (5, 1, 4), (6, 4, 5), (7, 5, 10), (8, 5, 6), (9, 6, 7)),
        *((10, 7, 8), (11, 9, 8), (12, 9, 6), (13, 11, 12), (14, 10, 13), (15, 13, 14), (16, 10, 15), (17, 15, 16)),
        *((18, 16, 17), (19, 17, 18), (20, 15, 18)),
    )
}
"""Eq. (2) as corrected, all pins in holes: joint, part 1, part 2. The equation has p1 and p9 in one row; p9 is taken to
hold j11 and j12."""

AIR_CYLINDER: dict[str, tuple[str, str, str]] = {
    f"j{joint}": (f"p{part1}", f"p{part2}", state)
    for joint, part1, part2, state in (
        *((1, 1, 5, "e"), (2, 1, 6, "e"), (3, 1, 7, "e"), (4, 1, 8, "e"), (5, 1, 9, "e"), (6, 2, 3, "e")),
        *((7, 2, 9, "e"), (8, 2, 9, "a"), (9, 2, 10, "e"), (10, 3, 10, "e"), (11, 4, 5, "e"), (12, 4, 6, "e")),
        *((13, 4, 7, "e"), (14, 4, 8, "e"), (15, 4, 10, "e"), (16, 4, 10, "a")),
    )
}
"""Table 6: joint, part 1, part 2, contact state. The column of the states is lost in print; these were recovered."""

_PINS: dict[str, tuple[float | int, float | int]] = {
    "j1": (0, 0),
    "j2": (-5, 30),
    "j3": (20, 75),
    "j4": (55, 50),
    "j5": (60, 0),
    "j6": (80, 58),
    "j7": (112, 100),
    "j8": (150, 70),
    "j9": (172, 50),
    "j10": (222, 55),
    "j11": (210, 0),
    "j12": (150, 0),
    "j13": (15, 115),
    "j14": (90, 135),
    "j15": (70, 165),
    "j16": (140, 135),
    "j17": (150, 170),
    "j18": (160, 205),
    "j19": (205, 200),
    "j20": (190, 140),
    "end of p12": (40, 140),
    "end of p14": (95, 185),
}

PAPER_EXAMPLES: dict[str, Example] = {
    "eighteen_bars": Example(
        file="eighteen_bars.step",
        description="Fig. 3 and 5 of the paper: 18 bars, 20 pins in holes; p9 may be fixed beside p1, or not",
        fixed=("p1", "p9"),
        drive=("p1", "p2"),
        unit="mm",
        # Places of the pins, and of the far ends of p12 and p14, in the plane of the drawing.
        dimensions={
            **{
                f"{name} {axis}": float(value)
                for name, at in _PINS.items()
                for axis, value in zip("xy", at, strict=True)
            },
            "pin radius": 3.0,
            "end radius": 7.0,
            "thickness": 4.0,
            "gap": 0.5,
        },
        turn=(np.array([0.35, 0.52, 0.78]), 1.07),
        shift=np.array([-61.3, 24.7, 38.2]),
    ),
    "air_cylinder": Example(
        file="air_cylinder.step",
        description="Fig. 7 of the paper: an air cylinder moves a parallel linkage; its rod is driven along its axis",
        fixed=("p4",),
        drive=("p2", "p10"),
        unit="mm",
        # Base pins at the origin and on the x axis; the links stand at `angle`; the eye of the rod is hinged on the
        # platform halfway between its pins, the cylinder on the base at (trunnion, 0).
        dimensions={
            "link": 50.0,
            "base": 60.0,
            "angle": np.pi / 3,
            "trunnion": 140.0,
            "pin radius": 3.0,
            "trunnion radius": 4.0,
            "bore radius": 5.0,
            "rod radius": 3.0,
            "tip radius": 2.2,
        },
        turn=(np.array([-0.44, 0.61, 0.57]), 0.86),
        shift=np.array([-48.6, -17.9, 26.5]),
    ),
}
