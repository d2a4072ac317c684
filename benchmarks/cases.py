"""The mechanisms whose sweeps are timed, and the ranges that they are driven through."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from timing import hexapod_curve

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path
from reference import catalogue, mechanisms  # on the path by `timing`

Drive = Callable[[int], dict[str, np.ndarray]]


def turn_of(joint: str, upto: float = 2 * np.pi) -> Drive:
    return lambda poses: {joint: np.linspace(0.0, upto, poses)}


def hexapod_legs(poses: int) -> dict[str, np.ndarray]:
    """Legs of the catalogue's hexapod while its platform runs through a closed curve."""
    return {f"leg {i}": leg for i, leg in enumerate(hexapod_curve(poses).legs.T)}


def example(name: str, *fixed: str) -> Callable[[], jk.Mechanism]:
    """An example of the paper, from solids."""
    return cache(lambda: jk.load(path(name)).mechanism(fixed=fixed or EXAMPLES[name].fixed))


def of_eighteen_bars(poses: int) -> dict[str, np.ndarray]:
    """Section 6 of the paper: j1, j3, j14 and j17 driven at once."""
    way = np.linspace(0.0, 1.0, poses)
    ends = {"p1-p2": 2 * np.pi, "p3-p11": 0.6, "p10-p13": 0.5, "p15-p16": 0.6}
    return {f"{joint}.phi": end * way for joint, end in ends.items()}


CASES: dict[str, tuple[Callable[[], jk.Mechanism], Drive]] = {
    "four-bar": (mechanisms.planar_fourbar, turn_of("A")),
    "slider-crank": (mechanisms.slider_crank, turn_of("A")),
    "Jansen leg": (catalogue.jansen, turn_of("O")),
    "Watt six-bar": (catalogue.watt, turn_of("A")),
    "cam (b)": (mechanisms.cam, turn_of("shaft")),
    "Cardan": (mechanisms.cardan_shafts, turn_of("in")),
    "spherical four-bar": (mechanisms.spherical_linkage, turn_of("A")),
    "ball in a bore (j)": (mechanisms.ball_in_bore, turn_of("A")),
    "RSSR": (mechanisms.rssr_linkage, turn_of("A")),
    "Bennett": (mechanisms.bennett_linkage, turn_of("A")),
    "paper, Fig. 3": (example("eighteen_bars"), of_eighteen_bars),
    "paper, Fig. 6": (example("cam"), turn_of("cam-frame.phi")),
    "paper, Fig. 7": (example("air_cylinder"), lambda poses: {"p2-p10.z": np.linspace(-8.0, 8.0, poses)}),
    "Stewart-Gough": (catalogue.hexapod, hexapod_legs),
}
