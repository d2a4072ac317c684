"""Motions of mechanisms by hand against their closed forms, on 3600 poses a turn.

Tolerance: 1e-9 of the size is asked for; rounding leaves about 1e-14 away from singular poses, so 1e-12 is held to.
"""

import numpy as np
import pytest

from jaxkin.joints.pairs import cylindrical
from reference import higher_pairs, planar, spatial
from reference.mechanisms import (
    ball_in_bore,
    bennett_linkage,
    cam,
    cardan_shafts,
    planar_fourbar,
    rssr_linkage,
    slider_crank,
    spherical_linkage,
)

TURN = np.linspace(0.0, 2 * np.pi, 3600)


def displacement(angles):
    """Angles as displacements from the first one, full turns counted."""
    angles = np.unwrap(angles)
    return angles - angles[0]


@pytest.mark.long
def test_fourbar():
    motion = planar_fourbar(1.0).sweep({"A": TURN})
    expected = planar.fourbar(1.0 + TURN)
    assert np.all(motion.closed)
    assert np.max(motion.residual) < 1e-12
    coupler, rocker = displacement(expected.coupler), displacement(expected.rocker)
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], rocker, atol=1e-12)
    np.testing.assert_allclose(motion.coordinates["B"][:, 0], coupler - TURN, atol=1e-12)
    np.testing.assert_allclose(motion.coordinates["C"][:, 0], rocker - coupler, atol=1e-12)
    pin = np.append(expected.rocker_pin[0], 0.0)
    path = np.asarray(motion.points("rocker", pin))
    np.testing.assert_allclose(path[:, :2], expected.rocker_pin, atol=1e-10)  # 1e-12 of the size


@pytest.mark.long
def test_fourbar_of_cylindrical_joints_moves_as_one_of_hinges_and_does_not_slide():
    """The paper's own Example 1 takes all joints as contacts (e): the axial freedoms are idle and stay at rest."""
    motion = planar_fourbar(1.0, pin=cylindrical).sweep({"A.phi": TURN, "A.z": np.zeros_like(TURN)})
    expected = displacement(planar.fourbar(1.0 + TURN).rocker)
    np.testing.assert_allclose(motion.coordinates["D"][:, 1], expected, atol=1e-12)
    slides = np.stack([motion.coordinates[joint][:, 0] for joint in "ABCD"])
    np.testing.assert_allclose(slides, 0.0, atol=1e-10)


def test_slider_crank():
    motion = slider_crank(1.0).sweep({"A": TURN})
    expected = planar.slider_crank(1.0 + TURN).slider
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["S"][:, 0], expected - expected[0], atol=1e-10)  # mm, size 160


@pytest.mark.long
def test_cam_of_figure_6():
    start = np.pi / 6
    motion = cam(start).sweep({"shaft": TURN})
    lift = 5.0 * (np.sin(start + TURN) - np.sin(start))
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], lift, atol=1e-11)  # mm, size 15
    height = higher_pairs.cam_flat_follower(start + TURN)
    np.testing.assert_allclose(lift, height - height[0], atol=1e-12)  # the two routes to the closed form agree


@pytest.mark.long
@pytest.mark.parametrize("start", [0.3, 2.0])
def test_rssr_while_its_rod_does_not_spin(start):
    motion = rssr_linkage(start).sweep({"A": TURN})
    expected = displacement(spatial.rssr(start + TURN).output)
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], expected, atol=1e-12)


@pytest.mark.long
def test_bennett():
    start = 0.9
    range_ = np.linspace(0.0, 2.0, 900)
    motion = bennett_linkage(start).sweep({"A": range_})
    expected = spatial.bennett(start + range_)
    assert np.all(motion.closed)
    for joint, angles in zip("BCD", expected.T[1:], strict=True):
        np.testing.assert_allclose(motion.coordinates[joint][:, 0], displacement(angles), atol=1e-12)


@pytest.mark.long
def test_spherical_fourbar():
    start = 0.4
    motion = spherical_linkage(start).sweep({"A": TURN})
    expected = displacement(spatial.spherical_fourbar(start + TURN).output)
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], expected, atol=1e-12)


@pytest.mark.long
def test_cardan():
    motion = cardan_shafts(0.5).sweep({"in": TURN})
    expected = displacement(spatial.cardan(TURN, 0.5))
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["out"][:, 0], expected, atol=1e-12)


@pytest.mark.long
def test_ball_in_bore_slides_and_turns():
    start = 0.3
    motion = ball_in_bore(start).sweep({"A": TURN})
    expected = displacement(planar.quick_return(start + TURN, 30.0, 80.0).arm)
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], expected, atol=1e-12)
