"""Hard cases: change points, nearly changing points, and limits of the motion."""

from __future__ import annotations

from functools import partial

import numpy as np

from reference import catalogue, planar
from reference.hard_case import TURN, HardCase, angles, displacements, turn
from reference.hard_fourbars import (
    DEAD,
    FOURBAR,
    LIMIT,
    MARGINS,
    NON_GRASHOF,
    PARALLELOGRAM,
    ROCKER,
    at,
    kite,
    reach_of_the_crank,
    rocker,
    upright_kite,
)

CHANGE_POINTS = (
    *(
        HardCase(
            f"parallelogram, {how}",
            "change points at 0 and pi",
            PARALLELOGRAM,
            {"A": drive},
            displacements(lambda given: {"B": -given, "C": given, "D": given}),
            "rocker turns as the crank",
        )
        for how, drive in {
            "a turn forwards": turn(25),
            "a turn backwards": turn(25, -1.0),
            "exactly at 0 and pi": at(np.pi * np.arange(-6, 7) / 2),
            "into 0, and stop": at([0.5, 1e-3, 1e-6, 1e-9, 0.0]),
        }.items()
    ),
    *(
        HardCase(
            f"antiparallelogram, {how}",
            "change points at 0 and pi",
            partial(catalogue.antiparallelogram, 0.8),
            {"A": drive},
            angles("D", planar.antiparallelogram, 0.8),
            "closed form",
        )
        for how, drive in {
            "a turn forwards": turn(25),
            "a turn backwards": turn(25, -1.0),
            "exactly at 0 and pi": np.pi * np.arange(-6, 7) / 2 - 0.8,
        }.items()
    ),
    *(
        HardCase(
            f"kite, {how}",
            hard,
            kite,
            {"A": drive},
            angles("D", lambda theta: planar.kite(theta, 50.0, 120.0), 1.0),
            "closed form",
        )
        for how, hard, drive in (
            ("two turns forwards", "change point at 0; back after two turns only", turn(25, 2.0)),
            ("two turns backwards", "change point at 0; back after two turns only", turn(25, -2.0)),
            ("exactly at 0", "change point", at(np.pi * np.arange(-4, 5) / 2)),
        )
    ),
    *(
        HardCase(
            f"upright kite, {how}",
            "change points at 0 and pi",
            upright_kite,
            {"A": drive},
            angles("D", lambda theta: planar.upright_kite(theta, 50.0, 120.0), 1.0),
            "closed form",
        )
        for how, drive in {
            "a turn forwards": turn(25),
            "a turn backwards": turn(25, -1.0),
            "exactly at 0 and pi": at(np.pi * np.arange(-4, 5) / 2),
        }.items()
    ),
)

NEAR_CHANGE_POINTS = tuple(
    HardCase(
        f"parallelogram, crank shorter by {short:.0e}",
        "two branches miss each other narrowly",
        partial(FOURBAR, ground=120.0, crank=50.0 * (1 - short), coupler=120.0, rocker=50.0),
        {"A": turn(25)},
        angles("D", rocker(ground=120.0, crank=50.0 * (1 - short), coupler=120.0, rocker=50.0), 1.0),
        "closed form",
    )
    for short in (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
)

LIMITS = (
    *(
        HardCase(
            f"non-Grashof four-bar, {how}",
            hard,
            partial(FOURBAR, **NON_GRASHOF),
            {"A": drive},
            angles("D", rocker(**NON_GRASHOF), 1.0),
            "closed form",
            reach_of_the_crank,
        )
        for how, hard, drive in (
            ("two turns", "enters and leaves a range that it cannot reach", turn(31, 2.0, -TURN)),
            ("1e-2 to 1e-10 rad inside its limit", "two branches meet", at(LIMIT - MARGINS)),
            ("1e-2 to 1e-8 rad outside", "nearly closed", at(LIMIT + MARGINS[:7])),
            ("in and out in turn", "as near to either side", at(LIMIT + np.outer(MARGINS[:7], [-1, 1]).ravel())),
        )
    ),
    HardCase(
        "four-bar driven by its rocker",
        "dead point, 1e-2 to 1e-10 rad away",
        FOURBAR,
        {"D": DEAD - ROCKER + MARGINS},
        angles("A", planar.fourbar_crank, ROCKER),
        "closed form",
        long=True,
    ),
)
