"""Limits of mechanisms with an idle freedom: the spin of a rod between two balls must not pass for a lock."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import jaxkin as jk

STEP = 0.004
"""Angle in which the closed form is looked at, radians."""


def drawn_at_random(seed: int):
    """An RSSR linkage, and what is above 0 where its rod reaches from the crank to the circle of the rocker."""
    random = np.random.default_rng(seed)
    pivot, axis = random.normal(size=(2, 3)) * [[0.3], [1.0]]
    other_pivot, other_axis = np.array([1.0, 0.2, 0.0]) + random.normal(size=3) * 0.2, random.normal(size=3)
    ball, other_ball = pivot + random.normal(size=3) * 0.4, other_pivot + random.normal(size=3) * 0.6
    joints = [
        jk.revolute("A", "ground", "crank", point=pivot, axis=axis),
        jk.spherical("B", "crank", "rod", point=ball),
        jk.spherical("C", "rod", "rocker", point=other_ball),
        jk.revolute("D", "ground", "rocker", point=other_pivot, axis=other_axis),
    ]
    unit = other_axis / np.linalg.norm(other_axis)
    arm = other_ball - other_pivot
    along = (arm @ unit) * unit
    across, square = arm - along, np.cross(unit, arm)
    length = np.linalg.norm(other_ball - ball)

    def room(angle: float) -> float:
        # |across cos t + square sin t - w|^2 = length^2 is c + a cos t + b sin t = 0, solvable where |c| <= |(a, b)|
        turned = pivot + Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).apply(ball - pivot)
        w = turned - other_pivot - along
        return np.hypot(2 * across @ w, 2 * square @ w) - abs(across @ across + w @ w - length**2)

    return jk.Mechanism.build(fixed=["ground"], joints=joints), room


def first_lock(room, sign: int) -> float | None:
    """The first angle in a direction at which the rod no longer reaches; None within a turn."""
    for angle in np.arange(STEP, 2 * np.pi, STEP):
        if room(sign * angle) < 0:
            return brentq(room, sign * (angle - STEP), sign * angle, xtol=1e-14)
    return None


@pytest.mark.parametrize("seed", [8, 10, 21])
def test_a_rod_that_spins_locks_nothing(seed):
    mechanism, room = drawn_at_random(seed)
    found, wanted = jk.limits(mechanism, "A"), [first_lock(room, sign) for sign in (-1, 1)]
    if None in wanted:
        assert found.full_turn
    else:
        # the root of rounding of the closed form, over the slope that it has there
        np.testing.assert_allclose(found.range, wanted, rtol=0, atol=1e-9)
        assert "D" in found.lower.joints and "D" in found.upper.joints


def test_a_screw_beside_a_rod_that_spins_does_not_repeat():
    """A nut takes a rod with it, whose foot is on an arm: after a turn the nut is elsewhere, whatever the rod's spin.

    It ends, after three turns to one side, where the rod no longer reaches: its length is then the least or the largest
    distance of the ball on the nut from the circle of the foot.
    """
    home, pitch, height, arm = 6.0, 0.8, 4.0, 1.5
    press = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.screw("screw", "ground", "nut", point=(home, 0, 0), axis=(1, 0, 0), pitch=pitch),
            jk.spherical("ball", "nut", "rod", point=(home, 1, 0)),
            jk.spherical("foot", "rod", "arm", point=(0, height - arm, 0)),
            jk.revolute("arm", "ground", "arm", point=(0, height, 0), axis=(0, 0, 1)),
        ],
    )
    rod = np.hypot(home, height - arm - 1.0)

    def room(turn: float) -> float:
        x, y, z = home + pitch * turn / (2 * np.pi), np.cos(turn), np.sin(turn)
        out = np.hypot(x, y - height)
        return min(rod - np.hypot(out - arm, z), np.hypot(out + arm, z) - rod)

    found = jk.limits(press, "screw")
    assert not found.full_turn
    lock = {}
    for sign in (-1, 1):
        turn = next(each for each in sign * np.arange(0.0, 60.0, STEP) if room(each) < 0)
        lock[sign] = brentq(room, turn - sign * STEP, turn, xtol=1e-14)
    np.testing.assert_allclose(found.range, (lock[-1], lock[1]), rtol=0, atol=1e-9)
    assert lock[-1] < -4 * np.pi


@pytest.mark.long
def test_a_rack_behind_a_crank_beside_a_rod_that_spins_ends_it():
    """The crank turns on and on, and the rack with it to the ends of its way."""
    mechanism, room = drawn_at_random(10)
    assert first_lock(room, 1) is first_lock(room, -1) is None
    rack = jk.prismatic("rack", "ground", "rack", axis=(1, 0, 0), limits=(-30.0, 12.5))
    tied = jk.Mechanism.build(
        fixed=["ground"], joints=[*mechanism.all_joints, rack], couplings=[jk.rack("A", "rack", 0.5)]
    )
    found = jk.limits(tied, "A")
    np.testing.assert_allclose(found.range, (-60.0, 25.0), rtol=1e-12)
    assert found.lower.joints == found.upper.joints == ("rack",)
