"""Motions that several tests of the pictures share: each is swept once."""

from dataclasses import replace

import numpy as np
import pytest

from jaxkin.joints.pairs import prismatic, revolute
from jaxkin.mechanism.mechanism import Mechanism
from reference.mechanisms import planar_fourbar
from reference.planar import fourbar
from view.bars import COLORS, TURN, bar, box


@pytest.fixture(scope="session")
def plates():
    """The parts of the four-bar of the reference at a crank angle of 1, as bars in layers over a base plate."""
    at = fourbar(np.array([1.0]))
    b, c = at.crank_pin[0], at.rocker_pin[0]
    return (
        box("ground", [-30, -20, -10], [130, 20, 0]),
        bar("crank", [0, 0], b, 1, COLORS["crank"]),
        bar("coupler", b, c, 6, COLORS["coupler"]),
        bar("rocker", [100, 0], c, 1, COLORS["rocker"]),
    )


def linkage(solids=(), **lengths):
    """The reference's four-bar; one unit for all, since a sweep is compiled anew for another."""
    return replace(planar_fourbar(1.0, **lengths), solids=solids, unit="mm")


@pytest.fixture(scope="session")
def four_bar(plates):
    """A whole turn of the four-bar from the pose at a crank angle of 1, with solids."""
    return linkage(plates).sweep({"A": TURN})


@pytest.fixture(scope="session")
def sticks():
    """The same without solids."""
    return linkage().sweep({"A": TURN})


@pytest.fixture(scope="session")
def small():
    """The same at a millionth of the size."""
    return linkage(ground=1e-4, crank=4e-5, coupler=1.2e-4, rocker=8e-5).sweep({"A": TURN})


@pytest.fixture(scope="session")
def partly():
    """A four-bar that does not turn fully: some poses are unreachable."""
    return linkage(crank=95.0, coupler=60.0).sweep({"A": TURN})


@pytest.fixture(scope="session")
def nowhere():
    """The same, asked for poses that are all unreachable."""
    return linkage(crank=95.0, coupler=60.0).sweep({"A": np.linspace(1.0, 1.2, len(TURN))})


@pytest.fixture(scope="session")
def crane():
    """Without loops, in space: a turret about z, an arm about an axis across it, a hook along the arm."""
    joints = [
        revolute("pan", "base", "turret", point=(0, 0, 50), axis=(0, 0, 1)),
        revolute("tilt", "turret", "arm", point=(10, 0, 60), axis=(0, 1, 0)),
        prismatic("reach", "arm", "hook", point=(60, 0, 60), axis=(1, 0, 0)),
    ]
    mechanism = Mechanism.build(fixed=["base"], joints=joints, unit="mm")
    return mechanism.sweep({"pan": TURN, "tilt": 0.5 * np.sin(3 * TURN), "reach": 20 * np.sin(TURN)})


@pytest.fixture(scope="session")
def press():
    """Without loops, in a plane: a wheel that turns and a ram that slides, both in the frame."""
    joints = [
        revolute("turn", "frame", "wheel", point=(0, 0, 0), axis=(0, 0, 1)),
        prismatic("slide", "frame", "ram", point=(30, 0, 0), axis=(0, 1, 0)),
    ]
    solids = (
        box("frame", [-20, -20, -5], [60, 20, 0]),
        box("wheel", [-1, -1, 0], [8, 1, 1]),
        box("ram", [25, -5, 0], [35, 5, 1]),
    )
    mechanism = replace(Mechanism.build(fixed=["frame"], joints=joints, unit="mm"), solids=solids)
    return mechanism.sweep({"turn": TURN, "slide": 10 * np.sin(TURN)})
