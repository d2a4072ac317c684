"""The closed forms against published values, and against the bars and axes that they must keep."""

from __future__ import annotations

import numpy as np
import pytest

from reference import higher_pairs, overconstrained, parallel, planar, spatial
from reference.mechanisms import denavit_hartenberg

THETA = np.linspace(0.0, 2 * np.pi, 361)
ROUNDING = 1e-12
"""Relative to lengths of about 100: some hundred units in the last place."""


def distance(p, q) -> np.ndarray:
    return np.linalg.norm(np.asarray(p) - np.asarray(q), axis=-1)


@pytest.mark.parametrize(("side", "coupler", "rocker"), [(1, 20.298, 57.325), (-1, -60.98, -98.01)])
def test_norton_example_4_1(side, coupler, rocker):
    found = planar.fourbar(np.radians([40.0]), side=side)
    # Norton prints the open circuit to 0.001 degrees and the crossed one to 0.01
    within = 0.0006 if side == 1 else 0.006
    assert np.degrees(found.coupler[0]) == pytest.approx(coupler, abs=within)
    assert np.degrees(found.rocker[0]) == pytest.approx(rocker, abs=within)


@pytest.mark.parametrize(("side", "slider_to_crank", "slider"), [(1, 152.91, 126.84), (-1, 27.09, -86.84)])
def test_norton_example_4_2(side, slider_to_crank, slider):
    found = planar.slider_crank(np.radians([60.0]), side=side)
    assert np.degrees(found.rod[0]) % 360 == pytest.approx((slider_to_crank + 180) % 360, abs=0.006)
    assert found.slider[0] == pytest.approx(slider, abs=0.006)


@pytest.mark.parametrize("side", [1, -1])
def test_fourbar_satisfies_freudenstein(side):
    """Freudenstein (1955): K1 cos(rocker) - K2 cos(theta) + K3 = cos(theta - rocker)."""
    ground, crank, coupler, rocker = 100.0, 40.0, 120.0, 80.0
    psi = planar.fourbar(THETA, ground, crank, coupler, rocker, side).rocker
    k3 = (ground**2 + crank**2 + rocker**2 - coupler**2) / (2 * crank * rocker)
    error = ground / crank * np.cos(psi) - ground / rocker * np.cos(THETA) + k3 - np.cos(THETA - psi)
    assert np.abs(error).max() < ROUNDING


def test_fourbar_out_of_reach_is_nan():
    """Non-Grashof: crank and ground reach the far pin only while their diagonal is below coupler + rocker."""
    ground, crank, coupler, rocker = 100.0, 80.0, 50.0, 60.0
    diagonal = np.sqrt(ground**2 + crank**2 - 2 * ground * crank * np.cos(THETA))
    beyond = (diagonal > coupler + rocker) | (diagonal < abs(coupler - rocker))
    assert 0 < beyond.sum() < len(THETA)
    np.testing.assert_array_equal(np.isnan(planar.fourbar(THETA, ground, crank, coupler, rocker).rocker), beyond)


def test_parallelogram_and_antiparallelogram():
    theta = THETA[5:175]  # between the change points at 0 and pi
    np.testing.assert_allclose(planar.fourbar(theta, 120.0, 50.0, 120.0, 50.0).rocker, theta, atol=ROUNDING)
    crossed = planar.fourbar(theta, 120.0, 50.0, 120.0, 50.0, side=-1).rocker
    np.testing.assert_allclose(np.cos(crossed - planar.antiparallelogram(theta)), 1.0, atol=ROUNDING)


def test_scotch_yoke_keeps_the_pin_in_the_slot():
    pin, slot = planar.polar(30.0, THETA), 1.1
    normal = np.array([np.sin(slot), -np.cos(slot)])
    yoke = np.stack([planar.scotch_yoke(THETA, 30.0, slot), np.zeros(THETA.shape)], axis=-1)
    np.testing.assert_allclose((pin - yoke) @ normal, 0.0, atol=100 * ROUNDING)


def test_quick_return_time_ratio():
    """The arm turns back where the crank is perpendicular to it: slow over quick is (pi + 2k) / (pi - 2k) (Norton)."""
    theta = np.linspace(0.0, 2 * np.pi, 3601)
    arm = planar.quick_return(theta).arm
    slow = (np.diff(arm) > 0).mean()
    limit = np.arcsin(50.0 / 120.0)
    assert np.abs(arm).max() == pytest.approx(limit, abs=1e-6)  # the samples miss the turning point by half a step
    assert slow / (1 - slow) == pytest.approx((np.pi + 2 * limit) / (np.pi - 2 * limit), abs=2e-3)


def test_watt_sixbar_is_closed():
    found = planar.watt_sixbar(THETA)
    crank = planar.polar(60.0, found.first.rocker + 0.4)
    np.testing.assert_allclose(found.second.crank_pin, crank)
    np.testing.assert_allclose(distance(found.second.crank_pin, found.second.rocker_pin), 110.0)
    np.testing.assert_allclose(distance(found.second.rocker_pin, [90.0, 0.0]), 75.0)


def test_jansen_walks():
    """The foot keeps level, within a twentieth of its stride, for more than half a turn: what Jansen bred it for."""
    found = planar.jansen(THETA)
    stride = np.ptp(found.foot[:, 0])
    assert (found.foot[:, 1] < found.foot[:, 1].min() + stride / 20).mean() > 0.5
    bars = {
        "j": (found.crank_pin, found.knee),
        "e": (found.knee, found.rear),
        "k": (found.crank_pin, found.lower),
        "f": (found.rear, found.ankle),
        "g": (found.ankle, found.lower),
        "h": (found.ankle, found.foot),
        "i": (found.lower, found.foot),
    }
    for bar, ends in bars.items():
        np.testing.assert_allclose(distance(*ends), planar.JANSEN[bar])


def test_chebyshev_lambda_draws_a_nearly_straight_line():
    """4 cranks long over half a turn, and straight within a quarter of a percent of that."""
    theta = np.linspace(np.pi / 2, 3 * np.pi / 2, 181)
    x, y = planar.chebyshev_lambda(theta).T
    assert np.ptp(x) == pytest.approx(4.0)
    assert np.ptp(y) < 0.0025 * 4.0


def test_peaucellier_draws_a_straight_line():
    found = planar.peaucellier(np.linspace(-0.3, 0.3, 61))
    np.testing.assert_allclose(found.far[:, 0], (100.0**2 - 40.0**2) / 70.0)
    np.testing.assert_allclose(distance(found.near, [35.0, 0.0]), 35.0)
    for corner in (found.left, found.right):
        np.testing.assert_allclose(distance(corner, found.far), 40.0)


def test_oldham_disc_lies_in_both_slots():
    centre = planar.oldham(THETA)
    first, second = planar.polar(1.0, THETA), planar.polar(1.0, THETA + np.pi / 2)
    np.testing.assert_allclose((centre * second).sum(axis=-1), 0.0, atol=100 * ROUNDING)
    np.testing.assert_allclose(((centre - [10.0, 0.0]) * first).sum(axis=-1), 0.0, atol=100 * ROUNDING)


def test_cardan_keeps_its_arms_perpendicular_and_its_speed_ratio():
    driven = spatial.cardan(THETA, 0.5)
    ratio = np.gradient(np.unwrap(driven), THETA)[1:-1]
    # differences of second order over one degree
    assert ratio.min() == pytest.approx(np.cos(0.5), abs=2e-4)
    assert ratio.max() == pytest.approx(1 / np.cos(0.5), abs=2e-4)
    tilt = spatial.about_x(0.5)
    # zero where the driving arm is along x, the normal of the shafts' plane; the driven arm is a quarter turn ahead
    input_arm = np.stack([np.cos(THETA), np.sin(THETA), 0 * THETA], axis=-1)
    output_arm = np.stack([-np.sin(driven), np.cos(driven), 0 * THETA], axis=-1) @ tilt.T
    np.testing.assert_allclose((input_arm * output_arm).sum(axis=-1), 0.0, atol=ROUNDING)


@pytest.mark.parametrize("branch", [1, -1])
def test_spherical_fourbar_keeps_its_arcs(branch):
    found = spatial.spherical_fourbar(THETA, branch=branch)
    output_axis = spatial.about_x(1.2) @ [0.0, 0.0, 1.0]
    np.testing.assert_allclose((found.input_pin * found.output_pin).sum(axis=-1), np.cos(1.1), atol=ROUNDING)
    np.testing.assert_allclose(found.output_pin @ output_axis, np.cos(0.9), atol=ROUNDING)
    np.testing.assert_allclose(found.input_pin[:, 2], np.cos(0.5), atol=ROUNDING)


@pytest.mark.parametrize("branch", [1, -1])
def test_rssr_keeps_its_rod(branch):
    found = spatial.rssr(THETA, branch=branch)
    np.testing.assert_allclose(distance(found.crank_ball, found.rocker_ball), 140.0)


def test_bennett_closes():
    """The Denavit-Hartenberg transforms of the four links multiply to the identity."""
    length, twist, other_twist = 60.0, 0.7, 1.2
    other = spatial.bennett_length(length, twist, other_twist)
    product = np.eye(4)
    for angle, (a, alpha) in zip(
        spatial.bennett(THETA, twist, other_twist).T, [(length, twist), (other, other_twist)] * 2, strict=True
    ):
        c, s, zero, one = np.cos(angle), np.sin(angle), np.zeros(angle.shape), np.ones(angle.shape)
        turn = np.moveaxis(
            np.array([[c, -s, zero, zero], [s, c, zero, zero], [zero, zero, one, zero], [zero, zero, zero, one]]), -1, 0
        )
        shift = np.eye(4)
        shift[:3, :3], shift[0, 3] = spatial.about_x(alpha), a
        product = product @ turn @ shift
    np.testing.assert_allclose(product, np.broadcast_to(np.eye(4), product.shape), atol=100 * ROUNDING)


def test_bricard_closes():
    """The Denavit-Hartenberg transforms of the six links multiply to the identity."""
    for theta in THETA[(THETA < 1.8) | (THETA > 4.5)][::20]:
        other, product = overconstrained.bricard(theta), np.eye(4)
        for angle, twist in zip((theta, other) * 3, (1.2, -1.2) * 3, strict=True):
            product = product @ denavit_hartenberg(angle, 50.0, twist)
        np.testing.assert_allclose(product, np.eye(4), atol=100 * ROUNDING)


def test_goldberg_closes():
    """The screw displacements of its five joints, turned as the closed form says, multiply to the identity."""
    joints = overconstrained.goldberg_linkage(0.8).joints
    start = overconstrained.goldberg(np.array(0.8))
    for phi in np.linspace(-0.5, 1.8, 12):
        now, product = overconstrained.goldberg(np.array(phi)), np.eye(4)
        for name, joint in joints.items():
            turn, frame = now[name] - start[name], joint.frames_1[0]
            # the ring runs RS, SP, PU, UT, TR: against the direction of U and T
            turned = denavit_hartenberg(-turn if name in "UT" else turn, 0.0, 0.0)
            product = product @ frame @ turned @ np.linalg.inv(frame)
        np.testing.assert_allclose(product, np.eye(4), atol=100 * ROUNDING)


def test_kites_keep_their_links_and_fourbars_turn_back():
    theta = 2 * THETA  # two turns, after which a kite is back
    for ground, crank, coupler, closed in ((50.0, 50.0, 120.0, planar.kite), (120.0, 50.0, 50.0, planar.upright_kite)):
        rocker = closed(theta, 50.0, 120.0)
        pin = np.array([ground, 0.0]) + planar.polar(120.0, rocker)
        np.testing.assert_allclose(distance(pin, planar.polar(crank, theta)), coupler, atol=100 * ROUNDING)
    crank = np.linspace(0.6, 3.0, 50)
    np.testing.assert_allclose(planar.fourbar_crank(planar.fourbar(crank).rocker), crank, rtol=1e-12)


def test_sarrus_is_two_links_high():
    knee = planar.polar(50.0, THETA)
    np.testing.assert_allclose(distance(knee, np.stack([0 * THETA, spatial.sarrus(THETA)], axis=-1)), 50.0)


def test_hexapod_legs():
    robot = parallel.hexapod()
    home = robot.legs(np.eye(3)[None], np.array([[0.0, 0.0, 300.0]]))
    np.testing.assert_allclose(home, home[0, 0])  # alike by the robot's symmetry
    moved = robot._replace(platform=robot.base)
    np.testing.assert_allclose(moved.legs(np.eye(3)[None], np.array([[30.0, -40.0, 120.0]])), 130.0)


def test_delta_forearms_keep_their_length():
    positions = np.array([[0.0, 0.0, -500.0], [60.0, -40.0, -450.0], [-80.0, 110.0, -520.0]])
    angles = parallel.delta(positions)
    for k, turn in enumerate(2 * np.pi / 3 * np.arange(3)):
        outward = np.array([np.cos(turn), np.sin(turn), 0.0])
        arm = np.cos(angles[:, k, None]) * outward - np.sin(angles[:, k, None]) * np.array([0.0, 0.0, 1.0])
        np.testing.assert_allclose(distance(200.0 * outward + 240.0 * arm, positions + 45.0 * outward), 560.0)


def test_cams_touch_their_followers():
    centre = planar.polar(8.0, THETA)
    roller = np.stack([np.full(THETA.shape, 3.0), higher_pairs.cam_roller_follower(THETA)], axis=-1)
    np.testing.assert_allclose(distance(centre, roller), 25.0 + 6.0)
    np.testing.assert_allclose(higher_pairs.cam_flat_follower(THETA, 25.0, 8.0) - centre[:, 1], 25.0)


def test_swash_plate_touches_the_ball():
    found = higher_pairs.swash_plate(THETA)
    centre = np.stack([np.full(THETA.shape, 40.0), 0 * THETA, found.height], axis=-1)
    np.testing.assert_allclose((centre * found.normal).sum(axis=-1), 6.0)
