"""Hard cases: more equations than freedoms, idle freedoms, and inputs far apart or in any order."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

from jaxkin.joints.pairs import cylindrical
from jaxkin.mechanism.motion import Motion
from reference import catalogue, mechanisms, overconstrained, spatial
from reference.hard_case import TURN, HardCase, angles, displacements, turn, whole_turns
from reference.hard_fourbars import (
    FOURBAR,
    Array,
    rocker,
)


def goldberg_truth(given: Array) -> Mapping[str, Array]:
    """Hinge S turns against the angle of the hinge that Goldberg froze; full turns aside there are none here."""
    now, then = overconstrained.goldberg(0.8 - given), overconstrained.goldberg(np.array([0.8]))
    return {name: now[name] - then[name] for name in "PUTR"}


def sarrus_rise(motion: Motion) -> Array:
    """The platform rises straight, by the closed form, and does not turn."""
    given = np.asarray(motion.inputs["x0.phi"], float)
    expected = np.tile(np.eye(4), (len(given), 1, 1))
    expected[:, 2, 3] = spatial.sarrus(0.6 - given) - spatial.sarrus(np.array([0.6]))
    off = np.abs(np.asarray(motion.transforms["platform"], float) - expected)
    return np.max(off / np.where(np.arange(4) == 3, 50.0, 1.0), axis=(1, 2))


def attitude(motion: Motion) -> Array:
    """The body on a ball is turned by three hinges, one after another."""
    turns = [np.asarray(motion.inputs[f"{name}.phi"], float) for name in "ABC"]
    first, second, third = (Rotation.from_euler(axis, turn[:, None]) for axis, turn in zip("zxz", turns, strict=True))
    found = np.asarray(motion.transforms["body"], float)
    return np.max(np.abs(found[:, :3, :3] - (first * second * third).as_matrix()), axis=(1, 2))


def shaft_truth(contacts: int) -> Callable[[Array], Mapping[str, Array]]:
    """All contacts turn as the first one is turned; nothing slides."""
    names = [f"{'shoulder' if number % 2 else 'bearing'} {number}" for number in range(contacts)]
    slides = {name: "xy" if name.startswith("s") else "z" for name in names}
    return lambda given: {
        f"{name}.{coordinate}": given * (coordinate == "phi") for name in names for coordinate in ("phi", *slides[name])
    }


OVERCONSTRAINED = (
    HardCase(
        "Bennett linkage, a turn",
        "4R, three redundant equations; folds flat",
        mechanisms.bennett_linkage,
        {"A": turn(25)},
        angles("B", lambda theta: spatial.bennett(theta)[..., 1], 0.9),
        "closed form",
        long=True,
    ),
    HardCase(
        "Goldberg linkage",
        "5R, two redundant equations",
        overconstrained.goldberg_linkage,
        {"S": np.linspace(-1.0, 1.0, 25)},
        displacements(goldberg_truth),
        "two Bennett linkages",
        long=True,
    ),
    HardCase(
        "Bricard linkage",
        "6R, one redundant equation",
        overconstrained.bricard_linkage,
        {"A": np.linspace(-1.0, 1.0, 25)},
        angles("B", overconstrained.bricard, 0.3),
        "closed form",
        long=True,
    ),
    HardCase(
        "Sarrus linkage",
        "6R, one redundant equation",
        catalogue.sarrus,
        {"x0": np.linspace(-0.9, 0.5, 25)},
        sarrus_rise,
        "closed form",
        long=True,
    ),
    HardCase(
        "five-bar parallelogram, a turn",
        "a redundant bar, and change points",
        partial(catalogue.parallelogram, 3),
        {"A": turn(25)},
        displacements(lambda given: {name: given for name in "BCabc"}),
        "all cranks turn alike",
        long=True,
    ),
    HardCase(
        "four parallel links, cylindrical pairs",
        "Fig. 7: redundant bars, idle slides",
        partial(catalogue.parallelogram, 4, pin=cylindrical),
        {"A.phi": turn(25)},
        displacements(
            lambda given: {f"{name}.phi": given for name in "BCD"} | {f"{name}.z": 0 * given for name in "ABCDa"}, 50.0
        ),
        "all cranks turn alike, nothing slides",
        long=True,
    ),
    *(
        HardCase(
            f"shaft in {contacts} contacts",
            "redundant contacts of one pair of parts",
            partial(overconstrained.shaft_in_contacts, contacts),
            {"bearing 0.phi": turn(25, 3.0)},
            displacements(shaft_truth(contacts), 20.0),
            "turns about its axis, nothing slides",
            long=True,
        )
        for contacts in range(2, 7)
    ),
)

IDLE = (
    HardCase(
        "RSSR linkage, 1,000 turns",
        "the rod may spin",
        mechanisms.rssr_linkage,
        {"A": TURN * np.arange(-500, 500, 40.0)},
        whole_turns("B", "C", "D"),
        "back after every turn",
        roundings=10_000,
        long=True,
    ),
    HardCase(
        "four-bar of cylindrical pairs, 1,000 turns",
        "Fig. 3: every pin may slide",
        partial(FOURBAR, cylindrical),
        {"A.phi": TURN * np.arange(-500, 500, 40.0)},
        whole_turns("B", "C", "D", length=100.0),
        "back after every turn",
        roundings=10_000,
        long=True,
    ),
    HardCase(
        "ball through every attitude",
        "no angles of a ball are regular everywhere",
        overconstrained.wrist,
        {"A": turn(41), "B": turn(41, 2.0), "C": np.pi * np.sin(turn(41))},
        attitude,
        "product of three turns",
        long=True,
    ),
)

INPUTS = tuple(
    HardCase(
        f"four-bar, {how}",
        hard,
        FOURBAR,
        {"A": drive},
        angles("D", rocker(), 1.0),
        "closed form",
        roundings=roundings,
    )
    for how, hard, drive, roundings in (
        ("ten poses a turn", "coarse grid", turn(11), 100),
        ("far apart in random order", "up to 100 turns away", np.random.default_rng(0).uniform(-628, 628, 25), 10_000),
        ("repeated poses", "inputs without distance", np.repeat([3.0, -2.0, 0.0, 3.0], 7), 100),
        ("a single pose", "far from the assembled one", np.array([2.9]), 100),
        ("an empty range", "nothing to solve", np.zeros(0), 100),
    )
) + (
    HardCase(
        "Cardan shafts, 20 turns",
        "full turns are counted",
        mechanisms.cardan_shafts,
        {"in": turn(25, 20.0)},
        displacements(lambda given: {"out": given + off_mean(given)}),
        "closed form",
        roundings=1000,
        long=True,
    ),
)


def off_mean(given: Array) -> Array:
    """How far the driven shaft of a universal joint is ahead of the driving one."""
    return np.remainder(spatial.cardan(given, 0.5) - given + np.pi, TURN) - np.pi
