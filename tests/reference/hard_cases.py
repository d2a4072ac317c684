"""The gallery of hard cases: tests run through it, and `benchmarks/hard_cases.py` prints it as a table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

from jaxkin.joints.pairs import cylindrical
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.status import Status
from reference import catalogue, mechanisms, overconstrained, planar, spatial
from reference.hard_case import TURN, HardCase, angles, displacements, off_turns, turn, whole_turns
from reference.rounding import schmidt_coupling, tilted_fourbar, written_down

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


def sliders(crank: float, rod: float) -> HardCase:
    """A slider-crank without offset of these lengths; its closed form needs no difference of large numbers."""

    def slide(given: Array) -> Mapping[str, Array]:
        def sag(theta: Array) -> Array:
            return (crank * np.sin(theta)) ** 2 / (rod + np.sqrt(rod**2 - (crank * np.sin(theta)) ** 2))

        return {"S": crank * (np.cos(1.0 + given) - np.cos(1.0)) - sag(1.0 + given) + sag(1.0)}

    return HardCase(
        f"slider-crank, crank {crank:g}, rod {rod:g}",
        "unit" if rod == 3 * crank else "length ratio 1e6",
        partial(mechanisms.slider_crank, 1.0, crank, rod, 0.0),
        {"A": turn(25)},
        displacements(slide, rod),
        "closed form",
        long=True,
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


NEARLY = tuple(
    HardCase(
        f"Bennett linkage, twists {margin:.0e}",
        "axes nearly parallel",
        partial(mechanisms.bennett_linkage, 0.9, margin, 1.7 * margin),
        {"A": turn(25, 0.3)},
        angles("B", lambda theta, m=margin: spatial.bennett(theta, m, 1.7 * m)[..., 1], 0.9),
        "closed form",
        long=True,
    )
    for margin in MARGINS[:7]
) + tuple(
    HardCase(
        f"spherical four-bar, axes miss by {margin:.0e}",
        "axes nearly intersecting",
        partial(overconstrained.missing_axes, 0.4, margin),
        {"A": turn(25)},
        angles("D", lambda theta: spatial.spherical_fourbar(theta).output, 0.4),
        "closed form",
        long=True,
    )
    for margin in MARGINS[:7]
)

SIZES = tuple(
    sliders(crank, rod)
    for crank, rod in ((1.0, 1e6), (1e-3, 1e3), (1e-6, 3e-6), (1e-3, 3e-3), (1.0, 3.0), (1e3, 3e3), (1e6, 3e6))
)

SINGLE_PRECISION = (
    HardCase(
        "four-bar in float32",
        "rounding of 1e-7",
        FOURBAR,
        {"A": turn(25)},
        angles("D", rocker(), 1.0),
        "closed form",
        bits=32,
        long=True,
    ),
    HardCase(
        "parallelogram in float32",
        "change points at 0 and pi",
        PARALLELOGRAM,
        {"A": turn(25)},
        displacements(lambda given: {"D": given}),
        "rocker turns as the crank",
        bits=32,
        long=True,
    ),
    HardCase(
        "Bennett linkage in float32",
        "redundant equations",
        mechanisms.bennett_linkage,
        {"A": turn(25)},
        angles("B", lambda theta: spatial.bennett(theta)[..., 1], 0.9),
        "closed form",
        bits=32,
        long=True,
    ),
    HardCase(
        "RSSR linkage in float32",
        "the rod may spin",
        mechanisms.rssr_linkage,
        {"A": turn(25)},
        angles("D", lambda theta: spatial.rssr(theta).output, 0.3),
        "closed form",
        bits=32,
        long=True,
    ),
)


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

CASES: tuple[HardCase, ...] = (
    *CHANGE_POINTS,
    *NEAR_CHANGE_POINTS,
    *LIMITS,
    *OVERCONSTRAINED,
    *IDLE,
    *INPUTS,
    *NEARLY,
    *SIZES,
    *SINGLE_PRECISION,
    *ROUNDED,
)
