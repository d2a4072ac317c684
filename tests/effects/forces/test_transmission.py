"""Transmission angle and ratio against the closed forms of planar linkages; reactions are right to 1e-8 of them."""

from dataclasses import replace

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path
from reference.energies import fourbar, whole_turn
from reference.mechanisms import fourbar_through, slider_crank
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


@pytest.mark.long
def test_outputs_between_two_moving_parts():
    """Seen from the crank, the coupler is turned by the rocker, which has two hinges and no drive: the same angle.

    Seen from the coupler, the rocker is turned by the ground through D: there its velocity is across the line C D.
    """
    motion = fourbar().sweep({"A": TURN})
    at = fourbar_angles(1.0 + TURN)
    found = jk.transmission(motion, "B")
    assert found.joint == "C"
    np.testing.assert_allclose(np.sin(found.angle), np.abs(np.sin(at.rocker - at.coupler)), rtol=1e-8)
    through = jk.transmission(motion, "C")
    assert through.joint == "D"
    push = jk.reactions(motion, applied=jk.joint_load("C", 1.0)).forces["D"][:, :2]
    line = np.stack([np.cos(at.rocker), np.sin(at.rocker)], axis=1)
    expected = np.abs(push[:, 0] * line[:, 1] - push[:, 1] * line[:, 0]) / np.linalg.norm(push, axis=1)
    np.testing.assert_allclose(np.sin(through.angle), expected, rtol=1e-8)


@pytest.mark.long
def test_the_angle_where_the_output_rests():
    """Crank and coupler in line: the rocker turns back, and its angle to the coupler is that of the triangle."""
    mechanism = fourbar()
    side, ground, rocker = 40.0 + 120.0, 100.0, 80.0
    rest = np.arccos((side**2 + ground**2 - rocker**2) / (2 * side * ground))
    found = jk.transmission(mechanism.sweep({"A": np.array([rest - 1.0])}), "D")
    angle = np.arccos((side**2 + rocker**2 - ground**2) / (2 * side * rocker))
    np.testing.assert_allclose(found.ratio, 0.0, atol=1e-10)
    np.testing.assert_allclose(found.angle, min(angle, np.pi - angle), rtol=1e-7)


@pytest.mark.long
def test_a_right_angle_has_all_its_digits_and_finite_derivatives():
    """Coupler and rocker of (1, 3), (4, 3), (4, 0) are at right angles; beside that pose cos(angle) follows from the
    law of cosines."""
    mechanism = fourbar_through((0, 0), (1, 3), (4, 3), (4, 0))

    def angles(inputs):
        return jk.transmission(mechanism.sweep({"A": inputs}), "D").angle

    inputs = np.array([0.0, 0.1])
    diagonal = 26 - 8 * np.sqrt(10) * np.cos(np.arctan2(3, 1) + inputs)  # square of the distance of B from D
    expected = np.arccos(np.abs(18 - diagonal) / 18)
    found, slopes = jax.jvp(angles, (inputs,), (np.ones(2),))
    np.testing.assert_allclose(found, expected, rtol=1e-14)  # the arc sine left 1.6e-8 of the first
    beside = 8 * np.sqrt(10) * np.sin(np.arctan2(3, 1) + 0.1)  # the rate of the square
    np.testing.assert_allclose(slopes[1], -beside / (18 * np.sin(expected[1])), rtol=1e-12)
    # at the right angle itself the acute angle has a slope to either side: +-24 / 18, or zero between them
    assert abs(slopes[0]) <= 24 / 18 + 1e-12


def test_what_makes_no_sense_is_refused():
    motion = fourbar().sweep({"A": TURN})
    with pytest.raises(ValueError, match=r"'A.phi' is the input itself"):
        jk.transmission(motion, "A")
    with pytest.raises(ValueError, match="'rocker' has no other joint 'B'"):
        jk.transmission(motion, "D", joint="B")


@pytest.mark.long
def test_outputs_of_several_joints_and_of_none_but_their_own():
    """What the message says to write works, and where there is nothing to write it says where the numbers are."""
    z = (0.0, 0.0, 1.0)
    joints = [
        *fourbar().all_joints,
        jk.prismatic("rack", "ground", "bar", axis=(1.0, 0.0, 0.0)),
        jk.revolute("arm", "rocker", "arm", point=(9.0, 0.0, 0.0), axis=z),
    ]
    tied = [jk.rack("D", "rack", 2.0), jk.gear("D", "arm", 2.0)]
    motion = jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=tied).sweep({"A": TURN[:3]})
    with pytest.raises(ValueError, match=r"moved through one of C, arm: say joint='C'"):
        jk.transmission(motion, "D")
    with pytest.raises(ValueError, match=r"'bar' has no joint but 'rack', and so no transmission angle"):
        jk.transmission(motion, "rack")


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


@pytest.mark.long
def test_poses_of_which_nothing_is_known_are_told():
    motion = fourbar().sweep({"A": np.array([0.0, np.nan, 0.5])})
    found = jk.transmission(motion, "D")
    assert "\n  not known at 1 of 3 poses\n" in str(found)
    without = str(replace(found, angle=np.full(3, np.nan)))
    assert "ratio of rates from" in without and "no force goes through C in 2 poses" in without
