"""Four-bars and what is known of them, which several groups of hard cases use."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.status import Status
from reference import mechanisms, planar
from reference.hard_case import off_turns

Array = np.ndarray
FOURBAR = partial(mechanisms.planar_fourbar, 1.0)
PARALLELOGRAM = partial(FOURBAR, ground=120.0, crank=50.0, coupler=120.0, rocker=50.0)
NON_GRASHOF = {"ground": 40.0, "crank": 20.0, "coupler": 25.0, "rocker": 30.0}
LIMIT = float(np.arccos((40.0**2 + 20.0**2 - 55.0**2) / (2 * 40.0 * 20.0)))
"""The crank of that four-bar reaches this angle, coupler and rocker in line, to either side."""
MARGINS = 10.0 ** -np.arange(2, 11)


def at(angle: Array) -> Array:
    """Displacements that bring a crank, assembled at 1 rad, to these angles."""
    return np.asarray(angle) - 1.0


def rocker(**lengths: float) -> Callable[[Array], Array]:
    """The rocker of a four-bar, by its crank angle."""
    return lambda theta: planar.fourbar(theta, **lengths).rocker


def kite() -> Mechanism:
    """Crank as long as the ground, rocker as the coupler."""
    return FOURBAR(ground=50.0, crank=50.0, coupler=120.0, rocker=120.0)


def upright_kite() -> Mechanism:
    """Crank as long as the coupler, rocker as the ground: the rocker's pin mirrors the crank's pivot."""
    return FOURBAR(ground=120.0, crank=50.0, coupler=50.0, rocker=120.0)


ROCKER = float(planar.fourbar(np.array([1.0])).rocker[0])
"""Angle of the rocker of Norton's four-bar as assembled."""
DEAD = np.pi - float(np.arccos((100.0**2 + 80.0**2 - 160.0**2) / (2 * 100.0 * 80.0)))
"""The same with crank and coupler stretched out."""


def reach_of_the_crank(drive: Mapping[str, Array]) -> Array:
    """UNREACHABLE where the crank of the non-Grashof four-bar is beyond its limit."""
    return np.where(off_turns(1.0 + drive["A"]) <= LIMIT, Status.CLOSED, Status.UNREACHABLE)
