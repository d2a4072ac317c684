"""Transmission angle and ratio against the closed forms of planar linkages; reactions are right to 1e-8 of them."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path
from reference.energies import fourbar, whole_turn
from reference.mechanisms import slider_crank
from reference.planar import fourbar as fourbar_angles
from reference.planar import slider_crank as slider_crank_angles

TURN = whole_turn()


@pytest.mark.long
def test_angle_between_coupler_and_rocker(tmp_path):
    """Norton, Design of Machinery, sections 4.10 and 6.7: the transmission angle, and the ratio of the rates."""
    motion = fourbar().sweep({"A": TURN})
    found = jk.transmission(motion, "D")
    at = fourbar_angles(1.0 + TURN)
    np.testing.assert_allclose(np.sin(found.angle), np.abs(np.sin(at.rocker - at.coupler)), rtol=1e-8)
    ratio = 40.0 * np.sin(1.0 + TURN - at.coupler) / (80.0 * np.sin(at.rocker - at.coupler))
    np.testing.assert_allclose(found.ratio, ratio, atol=1e-10)
    np.testing.assert_allclose(found.advantage, 1 / ratio, rtol=1e-8)
    assert (found.input, found.output, found.joint) == ("A.phi", "D.phi", "C")
    assert "Transmission from A.phi to D.phi, through C" in str(found)
    assert found.plot(tmp_path / "angle.png").stat().st_size > 10_000
    assert (
        found.save(tmp_path / "angle.csv").read_text().startswith('pose,"ratio","advantage","transmission angle [rad]"')
    )


def test_what_makes_no_sense_is_refused():
    motion = fourbar().sweep({"A": TURN})
    with pytest.raises(ValueError, match=r"'A.phi' is the input itself"):
        jk.transmission(motion, "A")
    with pytest.raises(ValueError, match="'rocker' has no other joint 'B'"):
        jk.transmission(motion, "D", joint="B")


@pytest.mark.long
def test_a_slider_is_pushed_along_the_rod():
    """The transmission angle of a slider is that of the rod from across the slide; force over torque is 1 / (dx/dt)."""
    motion = replace(slider_crank(), unit="mm").sweep({"A": TURN})
    found = jk.transmission(motion, "S")
    rod = slider_crank_angles(1.0 + TURN).rod
    np.testing.assert_allclose(np.sin(found.angle), np.cos(rod), rtol=1e-8)
    slope = -40.0 * np.sin(1.0 + TURN) + 40.0 * np.cos(1.0 + TURN) * np.tan(rod)
    np.testing.assert_allclose(found.ratio, slope, atol=1e-9)
    np.testing.assert_allclose(found.advantage, 1e3 / slope, rtol=1e-8)


@pytest.mark.long
def test_links_that_lie_side_by_side():
    """Drawn four-bars have their links in layers, which bends the pins: the angle is that of the plane all the same."""
    mechanism = jk.load(path("fourbar")).mechanism(fixed=["ground"])
    found = jk.transmission(mechanism.sweep({"ground-crank": TURN}), "ground-rocker")
    at = fourbar_angles(np.pi / 3 + TURN)
    np.testing.assert_allclose(np.sin(found.angle), np.abs(np.sin(at.rocker - at.coupler)), rtol=1e-6)
