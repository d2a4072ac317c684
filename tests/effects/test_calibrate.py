"""Calibration, held to measurements made by closed forms of mechanisms with other lengths, and to repeated noise."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples.paths import fourbar
from jaxkin.geometry.pose import rotation
from reference import catalogue, parallel, planar

GROUND, CRANK, COUPLER, ROCKER = (
    ("ground", "A", "D"),
    ("crank", "A", "B"),
    ("coupler", "B", "C"),
    ("rocker", "C", "D"),
)
GIVEN = (100.0, 40.0, 120.0, 80.0)
TRUE = (100.0, 40.2, 119.6, 80.5)
ANGLES = np.linspace(0, 2 * np.pi, 24, endpoint=False)
START = planar.fourbar(np.array([0.0]), *GIVEN)
NOISE = 1e-4
Z = (0.0, 0.0, 1.0)


def rocker(lengths):
    """What is measured of a four-bar: the rocker's turn from the assembled pose of the lengths as given."""
    return planar.fourbar(ANGLES, *lengths).rocker - START.rocker[0]


def calibrated(measured, **more):
    return jk.calibrate(fourbar(*GIVEN), {"A": ANGLES}, {"D": measured}, **more)


@pytest.mark.long
def test_lengths_are_recovered_from_angles():
    found = calibrated(rocker(TRUE), lengths=[CRANK, COUPLER, ROCKER])
    np.testing.assert_allclose(found.values, TRUE[1:], rtol=1e-11)
    np.testing.assert_allclose(found.mechanism.lengths[COUPLER], 119.6, rtol=1e-11)
    assert found.converged and found.undetermined == () and found.degrees_of_freedom == 21
    assert np.abs(found.residuals["D"]).max() < 1e-12
    swept = found.mechanism.sweep({"A": ANGLES}).coordinates["D"][:, 0]
    np.testing.assert_allclose(swept, rocker(TRUE), atol=1e-12)


@pytest.mark.long
def test_the_covariance_is_that_of_repeated_noise():
    """80 fits to new noise: deviations within 4 standard errors of a deviation from 80, correlations within 0.1."""
    random = np.random.default_rng(3)
    fits = [
        calibrated(rocker(TRUE) + NOISE * random.standard_normal(24), lengths=[CRANK, COUPLER, ROCKER], sigma=NOISE)
        for _ in range(80)
    ]
    values = np.array([each.values for each in fits])
    one = fits[0]
    np.testing.assert_allclose(values.std(axis=0, ddof=1), one.standard_errors, rtol=4 / np.sqrt(2 * 79))
    inside = np.abs(values - TRUE[1:]) < 1.96 * one.standard_errors
    np.testing.assert_allclose(inside.mean(), 0.95, atol=0.05)
    scales = np.outer(one.standard_errors, one.standard_errors)
    np.testing.assert_allclose(np.corrcoef(values.T), one.covariance / scales, atol=0.1)
    # sums of squares over their degrees of freedom are 1 on average, with deviation sqrt(2 / 21 / 80)
    np.testing.assert_allclose(np.mean([each.deviation**2 for each in fits]), 1.0, atol=4 * np.sqrt(2 / 21 / 80))
    # without a stated deviation it is that of the residuals
    free = calibrated(rocker(TRUE) + one.residuals["D"][:, 0], lengths=[CRANK, COUPLER, ROCKER])
    np.testing.assert_allclose(free.standard_errors, one.standard_errors * free.deviation / NOISE, rtol=1e-2)


@pytest.mark.long
def test_angles_do_not_tell_the_scale(tmp_path):
    """All bars in proportion: the one direction is that of the lengths, and the ratios are told."""
    found = calibrated(rocker(np.array(TRUE)), lengths=[GROUND, CRANK, COUPLER, ROCKER])
    assert np.isnan(found.values).all() and np.isinf(found.standard_errors).all()
    (direction,) = found.undetermined
    assert list(direction) == ["ground A D", "crank A B", "coupler B C", "rocker C D"]
    np.testing.assert_allclose(list(direction.values()), np.array(TRUE) / TRUE[2], rtol=1e-8)
    lengths = np.array([found.mechanism.lengths[key] for key in (GROUND, CRANK, COUPLER, ROCKER)])
    np.testing.assert_allclose(lengths / lengths[0], np.array(TRUE) / TRUE[0], rtol=1e-10)
    text = str(found)
    assert "not told by the data" in text and "crank A B +0.336" in text
    assert found.plot(tmp_path / "found.png").stat().st_size > 10_000
    assert found.save(tmp_path / "found.csv").read_text().splitlines()[2] == '"crank A B",40,nan,inf'


def arm():
    return jk.Mechanism.build(
        fixed=["g"],
        joints=[
            jk.revolute("A", "g", "a", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "a", "b", point=(1.0, 0, 0), axis=Z),
        ],
    )


def displacement(axis, point, angle):
    found = np.eye(4)
    found[:3, :3] = rotation(np.asarray(axis) / np.linalg.norm(axis), angle)
    found[:3, 3] = point - found[:3, :3] @ point
    return found


@pytest.mark.long
def test_the_axis_of_an_arm_is_found_and_not_where_along_it():
    """A hinge has four numbers (Denavit and Hartenberg): along its axis, and about it, nothing is told."""
    random, axis, point = np.random.default_rng(0), np.array([0.02, -0.03, 1.0]), np.array([1.02, -0.01, 0.05])
    first, second = random.uniform(-2, 2, (2, 12))
    poses = np.array(
        [displacement(Z, np.zeros(3), a) @ displacement(axis, point, b) for a, b in zip(first, second, strict=True)]
    )
    poses[3] = np.nan  # not measured
    target = jk.pose("b")
    found = jk.calibrate(arm(), {"A": first, "B": second}, {target: poses}, frames=["B"], sigma={target: (1e-3, 1e-4)})
    frame = np.asarray(found.mechanism.joints["B"].frames_1)[0]
    unit = axis / np.linalg.norm(axis)
    np.testing.assert_allclose(frame[:3, 2], unit, atol=1e-9)
    np.testing.assert_allclose(np.cross(frame[:3, 3] - point, unit), 0, atol=1e-9)
    assert found.degrees_of_freedom == 11 * 6 - 4 and len(found.undetermined) == 2
    for direction in found.undetermined:
        parts = np.array([direction.get(f"{name} of B", 0.0) for name in ("x", "y", "z", "rx", "ry", "rz")])
        shift, turn = parts[:3], parts[3:]
        # to slide along the axis, or to turn about it: the rotation vector is counted from the frame as given
        np.testing.assert_allclose(np.cross(shift, unit), 0, atol=1e-7)
        assert np.linalg.norm(shift) > 0.99 or np.linalg.norm(turn) > 0.99
    assert np.isnan(found.residuals[target.joint][3]).all()


@pytest.mark.long
def test_bars_and_a_marker_are_found_from_its_path():
    """A mark on the coupler, its place unknown as all bars are; places in a plane, z not measured."""
    at = np.array([60.0, 25.0])
    truth = np.array([61.0, 24.5])

    def path(lengths, mark):
        """A mark that is fixed to the crank pin and the direction of the coupler, as assembled."""
        pose = planar.fourbar(ANGLES, *lengths)
        turn = pose.coupler - START.coupler[0]
        local = mark - START.crank_pin[0]
        c, s = np.cos(turn), np.sin(turn)
        return pose.crank_pin + np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=1)

    marker = jk.point("coupler", (*at, 0.0))
    places = np.column_stack([path((101.0, *TRUE[1:]), truth), np.full(len(ANGLES), np.nan)])
    found = jk.calibrate(
        fourbar(*GIVEN),
        {"A": ANGLES},
        {marker: places},
        lengths=[GROUND, CRANK, COUPLER, ROCKER],
        markers=[marker],
    )
    np.testing.assert_allclose(found.values[:6], [101.0, *TRUE[1:], *truth], rtol=1e-9)
    (direction,) = found.undetermined
    assert list(direction) == [f"z of {marker.joint}"] and np.isnan(found.values[6])


@pytest.mark.long
def test_the_zeros_of_two_encoders():
    """Crank and rocker read with offsets: the hinges turned on their links by as much."""
    offsets = 0.02, -0.03
    measured = planar.fourbar(ANGLES + offsets[0], *TRUE).rocker - START.rocker[0] + offsets[1]
    places = {("crank", "A"): ("rz",), ("rocker", "D"): ("rz",)}
    found = calibrated(measured, lengths=[CRANK, COUPLER, ROCKER], frames=places)
    np.testing.assert_allclose(found.values[:3], TRUE[1:], rtol=1e-9)
    np.testing.assert_allclose(np.abs(found.values[3:]), np.abs(offsets), rtol=1e-8)


@pytest.mark.long
@pytest.mark.study
def test_a_platform_is_found_from_its_poses():
    """The balls of a hexapod on its platform, misplaced by half a millimetre; legs by the distance of their balls."""
    mechanism, random = catalogue.hexapod(), np.random.default_rng(1)
    base, home = (
        np.array([np.asarray(mechanism.joints[f"{end} {leg}"].frames_1)[0, :3, 3] for leg in range(6)])
        for end in ("base", "top")
    )
    moved = parallel.curve(base, home, 12).moved
    off = random.uniform(-0.5, 0.5, (6, 3))
    tops = np.einsum("pij,kj->pki", moved[:, :3, :3], home + off) + moved[:, None, :3, 3]
    legs = np.linalg.norm(tops - base, axis=2) - np.linalg.norm(home - base, axis=1)
    target = jk.pose("platform")
    found = jk.calibrate(
        mechanism,
        {f"leg {leg}": legs[:, leg] for leg in range(6)},
        {target: moved},
        frames={("platform", f"top {leg}"): ("x", "y", "z") for leg in range(6)},
        sigma={target: (0.01, 1e-4)},
    )
    assert found.undetermined == ()
    np.testing.assert_allclose(found.values, off.ravel(), atol=1e-7)


@pytest.mark.long
def test_units_change_nothing_and_three_poses_leave_no_freedom():
    def results(scale):
        mechanism = fourbar(*(scale * length for length in GIVEN))
        return jk.calibrate(
            mechanism, {"A": ANGLES[:3]}, {"D": rocker(TRUE)[:3]}, lengths=[CRANK, COUPLER, ROCKER], sigma=NOISE
        )

    large, small = results(1.0), results(1e-3)
    np.testing.assert_allclose(1e3 * small.values, large.values, rtol=1e-9)
    np.testing.assert_allclose(1e3 * small.standard_errors, large.standard_errors, rtol=1e-6)
    np.testing.assert_allclose(small.condition, large.condition, rtol=1e-6)
    assert large.degrees_of_freedom == 0 and np.isnan(large.deviation)
    without = jk.calibrate(
        fourbar(*GIVEN), {"A": ANGLES[:3]}, {"D": rocker(TRUE)[:3]}, lengths=[CRANK, COUPLER, ROCKER]
    )
    assert np.isnan(without.standard_errors).all() and "not known" in str(without)
    np.testing.assert_allclose(without.values, TRUE[1:], rtol=1e-8)


@pytest.mark.long
def test_a_length_ends_at_zero_where_noise_wants_less():
    """An eccentric of 0.1 mm, drawn with 0.5: the least squares are those of less than none, x = e cos + l by hand."""
    angles = np.linspace(0, 6, 10)
    eccentric = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("A", "ground", "eccentric", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "eccentric", "rod", point=(0.5, 0, 0), axis=Z),
            jk.revolute("C", "rod", "slide", point=(100, 0, 0), axis=Z),
            jk.prismatic("S", "ground", "slide", point=(100, 0, 0), axis=(1, 0, 0)),
        ],
    )
    measured = 0.1 * (np.cos(angles) - 1) - 0.6 * np.cos(angles)
    found = jk.calibrate(
        eccentric, {"A": angles}, {"S": measured}, lengths=[("eccentric", "A", "B"), ("rod", "B", "C")]
    )
    assert not found.converged and 0 <= found.values[0] < 1e-6


POINT = jk.point("coupler", (60.0, 25.0, 0.0))
TRANSPOSED = np.tile(np.eye(4), (24, 1, 1)) + np.eye(4)[[3]].T * (1.0, 2.0, 0.0, 0.0)
"""Poses whose translation is in the last row."""


@pytest.mark.parametrize(
    ("measured", "more", "said"),
    [
        ({"D": np.zeros(24)}, {}, "nothing to calibrate"),
        ({"D": np.zeros(24)}, {"lengths": CRANK}, "must be a list of keys"),
        ({"D": np.zeros(24)}, {"lengths": [("crank", "A", "E")]}, "no joint 'E'"),
        ({"D": np.zeros(24)}, {"frames": ["E"]}, "there is no joint 'E'"),
        ({"D": np.zeros(24)}, {"frames": {"B": ("z",)}}, "'B' can change by x, y, rz .* got 'z'"),
        ({"D": np.zeros(23)}, {"lengths": [CRANK]}, r"shape \(24,\), one a pose of the drive .* got shape \(23,\)"),
        ({"E": np.zeros(24)}, {"lengths": [CRANK]}, "there is no joint 'E'"),
        ({}, {"lengths": [CRANK]}, "nothing was measured"),
        ({"D": np.full(24, np.nan)}, {"lengths": [CRANK]}, "nothing was measured: all values are NaN"),
        ({"D": np.full(24, np.inf)}, {"lengths": [CRANK]}, "D.*: a measured value is infinite"),
        ({"D": np.zeros(24), POINT: np.zeros((24, 3))}, {"lengths": [CRANK]}, "say how exact either is"),
        ({"D": np.zeros(24)}, {"lengths": [CRANK], "markers": [POINT]}, "markers must be points that were measured"),
        ({"D": np.zeros(24), "B": np.zeros(24)}, {"lengths": [CRANK], "sigma": {"B": 1}}, "no standard deviation of D"),
        ({"D": np.zeros(24)}, {"lengths": [CRANK], "sigma": {"D": 1, "b": 1}}, "'b', which was not measured"),
        ({POINT: np.zeros((24, 3))}, {"markers": POINT}, "must be a list of measured points"),
        ({jk.pose("ground"): np.zeros((24, 4, 4))}, {"lengths": [CRANK]}, "'ground' is fixed"),
        ({jk.orientation("rocker"): np.ones((24, 3, 3))}, {"lengths": [CRANK]}, "orthonormal and right-handed"),
        ({jk.pose("rocker"): TRANSPOSED, "D": np.zeros(24)}, {"lengths": [CRANK]}, "are they transposed"),
        ({"D": np.zeros(24)}, {"lengths": [CRANK], "sigma": "2"}, "sigma must be a positive number"),
        ({"D": np.zeros(24)}, {"lengths": [CRANK], "sigma": True}, "sigma must be a positive number"),
    ],
)
def test_what_makes_no_sense_is_refused(measured, more, said):
    with pytest.raises(ValueError, match=said):
        jk.calibrate(fourbar(*GIVEN), {"A": ANGLES}, measured, **more)


@pytest.mark.long
def test_a_start_that_does_not_close_and_data_that_tell_nothing():
    with pytest.raises(ValueError, match=r"does not close at \d+ of 24 measured poses, first at pose"):
        jk.calibrate(fourbar(100.0, 60.0, 80.0, 60.0), {"A": ANGLES}, {"D": np.zeros(24)}, lengths=[CRANK])
    with pytest.raises(ValueError, match="nothing was measured: the drive has no poses"):
        jk.calibrate(fourbar(*GIVEN), {"A": np.zeros(0)}, {"D": np.zeros(0)}, lengths=[CRANK])
    with pytest.raises(ValueError, match="they tell nothing about them"):
        jk.calibrate(arm(), {"A": np.zeros(3), "B": np.ones(3)}, {"A": np.zeros(3)}, lengths=[("a", "A", "B")])
    with pytest.raises(ValueError, match="outside of jit, vmap and grad"):
        jax.jit(lambda angles: jk.calibrate(arm(), {"A": angles, "B": angles}, {"A": np.zeros(3)}))(np.zeros(3))


@pytest.mark.long
def test_rotations_that_are_far_off_are_no_fit():
    """A marker that was put on turned: its residuals are as large as the turn, and half a turn tells no direction."""
    mechanism = fourbar(*GIVEN)
    drive, turns = {"A": ANGLES}, np.asarray(mechanism.sweep({"A": ANGLES}).transforms["rocker"])[:, :3, :3]
    target = jk.orientation("rocker")
    for turn in (1.0, 3.0):  # no length of the crank turns the rocker by as much
        measured = {target: turns @ rotation(np.array(Z), turn)}
        assert jk.calibrate(mechanism, drive, measured, lengths=[CRANK], iterations=1).deviation > 0.5 * turn / 3**0.5
    with pytest.raises(
        ValueError, match=r"rocker orientation: at 24 of 24 .* half a turn from that of the given mechanism"
    ):
        jk.calibrate(mechanism, drive, {target: turns @ rotation(np.array(Z), np.pi)}, lengths=[CRANK])
