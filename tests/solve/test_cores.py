"""A long range in pieces, one a core, is the range in one: poses, full turns and order.

Tolerance 1e-12: what is left of the closure after the last step is rounding, and the knots of a piece are its own.
"""

from itertools import pairwise

import jax
import numpy as np
import pytest

from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.execution import cores as pieces
from reference.mechanisms import planar_fourbar, rssr_linkage

POSES = 3000
RANGES = {
    "four turns": np.linspace(-5.0, 20.0, POSES),
    "falling": np.linspace(8.0, 1.0, POSES),
    "shuffled": np.random.default_rng(0).permutation(np.linspace(-5.0, 20.0, POSES)),
}


def five_bar():
    """Two cranks of 40 and 35, 100 apart, and rods of 65 between them, which do not reach far enough everywhere."""
    one, two = 40.0 * np.exp(1.2j), 100.0 + 35.0 * np.exp(1.9j)
    middle = 0.5 * (one + two)
    pin = middle + 1j * (two - one) / abs(two - one) * np.sqrt(65.0**2 - abs(two - middle) ** 2)
    bars = ("ground", "crank", "rod", "other rod", "other crank", "ground")
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute(name, *parts, point=(at.real, at.imag, 0), axis=(0, 0, 1))
            for name, parts, at in zip("ABCDE", pairwise(bars), (0j, one, pin, two, 100 + 0j), strict=True)
        ],
    )


def swept(mechanism, angles, cores, monkeypatch):
    return driven(mechanism, {"A": angles}, cores, monkeypatch)


def driven(mechanism, drive, cores, monkeypatch):
    monkeypatch.setattr(pieces, "_cores", lambda: cores)
    monkeypatch.setattr(pieces, "LEAST", POSES // 4)
    monkeypatch.setattr("jaxkin.solve.execution.programs.MANY", POSES)  # put in order, as longer ranges are
    return mechanism.sweep(drive)


@pytest.mark.long
@pytest.mark.parametrize("order", RANGES)
@pytest.mark.parametrize("linkage", [planar_fourbar, rssr_linkage])
def test_pieces_are_the_range(linkage, order, monkeypatch):
    """Three pieces, of which the last overlaps the second; in balls full turns are counted across their ends."""
    mechanism = linkage()
    whole, split = (swept(mechanism, RANGES[order], cores, monkeypatch) for cores in (1, 3))
    assert np.all(whole.closed) and np.all(split.closed)
    assert np.max(split.residual) < 1e-12
    for one, other in zip(whole.displacements, split.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)


@pytest.mark.long
def test_pieces_of_several_inputs_are_their_range(monkeypatch):
    """In and out of reach of a five-bar: behind a limit a straight line from the assembled pose is tried."""
    way = np.linspace(0.0, 12.0, POSES)
    drive = {"A": way + 0.3 * np.sin(3 * way), "E": 1.5 * np.sin(way)}
    whole, split = (driven(five_bar(), drive, cores, monkeypatch) for cores in (1, 3))
    np.testing.assert_array_equal(whole.status, split.status)
    assert 0.3 < np.mean(split.closed) < 0.99
    assert np.max(split.residual[split.closed]) < 1e-12
    # beside a limit a pose is right to rounding over its smallest singular value, here 5e-3
    for one, other in zip(whole.displacements, split.displacements, strict=True):
        np.testing.assert_allclose(one[whole.closed], other[whole.closed], atol=1e-11)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
def test_settings_of_a_thread_hold_in_those_of_its_pieces(monkeypatch):
    with jax.enable_x64(False):
        motion = swept(planar_fourbar(), RANGES["falling"], 2, monkeypatch)
    assert {array.dtype for array in motion.displacements} == {np.dtype(np.float32)}
    assert np.all(motion.closed)


def test_how_many_pieces(monkeypatch):
    monkeypatch.setattr(pieces, "_cores", lambda: 8)
    (element,) = plan_drive(planar_fourbar().linkage, ("A",)).elements
    assert pieces.pieces(element.system, pieces.LEAST - 1) == 1
    assert pieces.pieces(element.system, 3 * pieces.LEAST) == 3
    assert pieces.pieces(element.system, 100 * pieces.LEAST) == 8
