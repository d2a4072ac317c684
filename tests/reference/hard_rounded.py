"""Hard cases: numbers that were rounded, and joints that disagree."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np

from jaxkin.mechanism.motion import Motion
from jaxkin.solve.status import Status
from reference import catalogue, mechanisms, spatial
from reference.hard_case import HardCase, angles, displacements, off_turns, turn
from reference.hard_fourbars import (
    Array,
)
from reference.rounding import schmidt_coupling, tilted_fourbar, written_down


def tilted_rocker(motion: Motion) -> Array:
    """How far the rocker is from that of the planar four-bar, a circle cut with a circle."""

    def rocker(theta: Array) -> Array:
        pin = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
        to_end = np.array([4.0, 0.0]) - pin
        distance = np.linalg.norm(to_end, axis=-1)
        coupler, output = np.hypot(2.2, 2.9), np.hypot(0.8, 2.9)
        along = (coupler**2 - output**2 + distance**2) / (2 * distance)
        across = np.sqrt(coupler**2 - along**2)
        unit = to_end / distance[:, None]
        joint = pin + along[:, None] * unit + across[:, None] * np.stack([-unit[:, 1], unit[:, 0]], axis=-1)
        return np.arctan2(joint[:, 1], joint[:, 0] - 4.0)

    given = np.asarray(motion.inputs["A.phi"], float)
    found = np.asarray(motion.coordinates["D"][:, 0], float)
    return off_turns(found - rocker(given) + rocker(np.zeros(1)))


def beside_the_assembled(drive: Mapping[str, Array]) -> Array:
    """CLOSED as assembled and after whole turns, MISFIT at all others."""
    return np.where(off_turns(drive["A"]) < 1e-9, Status.CLOSED, Status.MISFIT)


def turned_alike(motion: Motion) -> Array:
    """The last disc of a Schmidt coupling turns as the first one."""
    driven, out = (np.asarray(motion.coordinates[name], float)[:, 0] for name in ("in", "out"))
    return np.abs(np.abs(out) - np.abs(driven))


ROUNDED = (
    *(
        HardCase(
            f"four-bar, one axis tilted by {tilt:.0e}",
            "parallel axes but for rounding",
            partial(tilted_fourbar, tilt),
            {"A": turn(25)},
            tilted_rocker,
            "closed form, not tilted",
            noise=10 * tilt,
            long=tilt < 1e-6,
        )
        for tilt in (1e-12, 1e-9, 1e-6)
    ),
    *(
        HardCase(
            f"four-bar, one axis tilted by {tilt:.0e}",
            "axes disagree: no pose but one closes",
            partial(tilted_fourbar, tilt),
            {"A": turn(25)},
            tilted_rocker,
            "closed form, not tilted",
            beside_the_assembled,
            noise=10 * tilt,
            long=tilt > 1e-4,
        )
        for tilt in (1e-4, 1e-3)
    ),
    *(
        HardCase(
            f"Bennett linkage, {digits} digits",
            "moves for the sake of its lengths and twists",
            lambda digits=digits: written_down(mechanisms.bennett_linkage(), digits),
            {"A": turn(25)},
            angles("B", lambda theta: spatial.bennett(theta)[..., 1], 0.9),
            "closed form",
            noise=10 * 10.0**-digits,
            long=True,
        )
        for digits in (6, 9)
    ),
    HardCase(
        "Schmidt coupling, 7 digits",
        "moves for the sake of equal lengths",
        lambda: written_down(schmidt_coupling(), 7),
        {"in": np.linspace(-0.3, 0.3, 13)},
        turned_alike,
        "output turns as the input",
        noise=1e-6,
        long=True,
    ),
    HardCase(
        "three cranks side by side, 6 digits",
        "a redundant bar, and change points",
        lambda: written_down(catalogue.parallelogram(3), 6),
        {"A": np.linspace(-0.8, 0.8, 13)},
        displacements(lambda given: {name: given for name in "BCabc"}),
        "all cranks turn alike",
        noise=1e-5,
        long=True,
    ),
)
