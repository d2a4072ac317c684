"""Designs whose best is known in closed form: function generation, a cam's lift, a spatial linkage. All take long."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin import design
from jaxkin.examples.paths import BARS, fourbar
from reference import spatial
from reference.mechanisms import cam, rssr_linkage

pytestmark = [pytest.mark.long, pytest.mark.study]


def freudenstein(inputs, outputs):
    """Crank, coupler and rocker of a four-bar of ground 1 through three pairs of angles, both from the ground link.

    K1 cos(output) - K2 cos(input) + K3 = cos(input - output), K1 = 1/crank, K2 = 1/rocker.
    """
    table = np.column_stack([np.cos(outputs), -np.cos(inputs), np.ones(3)])
    k1, k2, k3 = np.linalg.solve(table, np.cos(inputs - outputs))
    crank, rocker = 1 / k1, 1 / k2
    return crank, np.sqrt(crank**2 + rocker**2 + 1 - 2 * crank * rocker * k3), rocker


def chebyshev(low, high, count):
    """Precision points by Chebyshev's spacing."""
    return 0.5 * (low + high) - 0.5 * (high - low) * np.cos(np.pi * (2 * np.arange(count) + 1) / (2 * count))


def test_function_generator():
    """y = x^1.5 for 1 <= x <= 4 at three Chebyshev points, 60 degrees of crank, 90 of rocker: Freudenstein's bars.

    Three equations for three bars: the error falls to none, and the bars agree to 1e-6 as asked for.
    """
    x = chebyshev(1.0, 4.0, 3)
    inputs = np.radians(60.0 + 60.0 * (x - 1.0) / 3.0)
    outputs = np.radians(60.0 + 90.0 * (x**1.5 - 1.0) / 7.0)
    start = fourbar(1.0, 0.6, 0.9, 0.8)
    pin = start.joints["C"].before[0][:2, 3]
    rest = np.arctan2(pin[1], pin[0] - 1.0)  # of the rocker; the crank's is none
    best = jk.optimize(
        design.function("D", outputs - rest, relative=False),
        start,
        drive={"A": inputs},
        lengths={bar: (0.3, 2.0) for bar in BARS[1:]},
        starts=4,
    )
    np.testing.assert_allclose(
        [best.mechanism.lengths[bar] for bar in BARS[1:]], freudenstein(inputs, outputs), rtol=1e-6
    )
    assert best.value < 1e-16


def test_cam_for_a_wanted_lift():
    """The lift of an eccentric disc is e sin(angle): e = 8 and the angle it starts at come out; its radius is idle."""
    turn = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
    with pytest.warns(UserWarning, match=r"does not depend on \(touch, radius\)"):
        best = jk.optimize(
            design.function("guide", 8.0 * np.sin(turn + 1.0)),
            cam(np.pi / 6),
            drive={"shaft": lambda extras: extras["first"] + turn},
            lengths={("cam", "shaft", "touch"): (1.0, 12.0), ("touch", "radius"): (10.0, 20.0)},
            extras={"first": design.Free(0.0, -np.pi, np.pi)},
        )
    assert best.mechanism.lengths[("cam", "shaft", "touch")] == pytest.approx(8.0, rel=1e-9)
    assert best.values["first"] == pytest.approx(1.0 - np.pi / 6, abs=1e-9)
    assert best.values["(touch, radius)"] == pytest.approx(15.0, rel=1e-6)


def test_spatial_four_bar():
    """Crank, rod and rocker of an RSSR from what its rocker does, to 1e-6; the rod's idle spin does not disturb."""
    truth, turn = rssr_linkage(0.3), np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
    wanted = spatial.rssr(0.3 + turn).output
    keys = [("crank", "A", "B"), ("rod", "B", "C"), ("rocker", "D", "C")]
    now = [float(truth.lengths[key if key in truth.lengths else (key[0], *key[:0:-1])]) for key in keys]
    best = jk.optimize(
        design.function("D", wanted),
        truth.with_lengths(dict(zip(keys, np.array(now) * [0.9, 1.05, 1.1], strict=True))),
        drive={"A": turn},
        lengths={key: (0.7 * length, 1.3 * length) for key, length in zip(keys, now, strict=True)},
    )
    np.testing.assert_allclose([best.values[f"({', '.join(key)})"] for key in keys], now, rtol=1e-6)
