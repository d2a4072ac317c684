"""A drive that makes no sense is refused with what arrived, what was expected and what to write."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.joints.pairs import cylindrical
from jaxkin.linkage.coordinates import resolve, with_finite_inputs
from jaxkin.solve.status import Status
from reference.catalogue import pinned
from reference.mechanisms import cam, planar_fourbar, rssr_linkage


@pytest.mark.parametrize(
    "drive, message",
    [
        ({}, "the drive is empty"),
        ({"a": [0.0]}, "there is no joint 'a'"),
        ({"A.z": [0.0]}, r"joint 'A' \(revolute\) has no coordinate 'z'; it has: phi"),
        ({"A": [0.0, 1.0], "D": [0.0]}, "equal length.*'A.phi': 2, 'D.phi': 1"),
        ({"A": [0.0], "A.phi": [0.0]}, "'A.phi' is named twice"),
        ({"A": 0.5}, r"one value a pose, got shape \(\); write \[value\]"),
        ({"A": [[0.5]]}, r"got shape \(1, 1\)"),
        ({"A": ["x"]}, "must be real numbers"),
        ({"A": [1j]}, "must be real numbers"),
    ],
)
def test_refused(drive, message):
    with pytest.raises(ValueError, match=message):
        resolve(planar_fourbar().linkage, drive)


def test_a_joint_of_several_coordinates_asks_which():
    with pytest.raises(ValueError, match=r"has 2 coordinates: write 'A.z' or 'A.phi'"):
        resolve(planar_fourbar(pin=cylindrical).linkage, {"A": [0.0]})


def test_a_ball_is_driven_by_some_of_its_angles_or_all():
    assert list(resolve(rssr_linkage().linkage, {"B.phi": [0.1]})) == ["B.phi"]
    with pytest.raises(ValueError, match=r"write 'B\.theta' or 'B\.phi' or 'B\.psi'"):
        resolve(rssr_linkage().linkage, {"B": [0.1]})


def test_nearest_name():
    with pytest.raises(ValueError, match="did you mean 'shaft'"):
        resolve(cam().linkage, {"shaf": [0.0]})


def test_coordinates_that_a_chain_holds_twice_are_numbered():
    joint = cam().joints["touch"]
    assert joint.coordinates == ("x", "y", "phi1", "phi2")
    driven = resolve(cam().linkage, {"touch.phi2": np.zeros(3)})
    assert driven["touch.phi2"].coordinate == 3


def test_numbers_too_large_to_be_summed_are_finite_and_infinite_ones_are_not():
    """Neither raises a warning of numpy: 1e308 + 1e308, and infinity less infinity."""
    large = (np.array([1e308, 1e308]),)
    assert with_finite_inputs(large) == (large, None)
    (followed,), finite = with_finite_inputs((np.array([np.inf, 1.0, 2.0, -np.inf]),))
    np.testing.assert_array_equal(followed, [1.0, 1.0, 2.0, 2.0])
    np.testing.assert_array_equal(finite, [False, True, True, False])


@pytest.mark.long
@pytest.mark.parametrize("where", [[0], [6], [12], [0, 1, 11, 12], list(range(13))])
def test_nan_and_infinity_are_the_status_of_their_poses(where):
    """NaN in numbers of the host as in traced ones; the other poses are what they are without."""
    mechanism, angles = planar_fourbar(), np.linspace(0.0, 6.0, 13)
    expected, given = mechanism.sweep({"A": angles}), angles.copy()
    given[where] = np.where(np.arange(len(where)) % 2, np.inf, np.nan)
    motion, rest = mechanism.sweep({"A": given}), np.setdiff1d(np.arange(13), where)
    assert np.all(np.asarray(motion.status)[where] == Status.NONFINITE) and np.all(np.asarray(motion.closed)[rest])
    for name, found in motion.coordinates.items():
        assert np.all(np.isnan(found[np.array(where)]))
        np.testing.assert_allclose(found[rest], expected.coordinates[name][rest], atol=1e-14)
    assert f"{len(where)}  NONFINITE" in str(motion)


@pytest.mark.long
def test_nan_among_several_inputs_leaves_the_way_as_it_is():
    """The arm's tip is held by two drives; several inputs are followed in their order."""
    points = {"A": (0, 0), "B": (-20, 45), "C": (35, 90), "D": (85, 50), "E": (70, 0)}
    bars = {"ground": "AE", "left": "AB", "upper": "BC", "lower": "CD", "right": "DE"}
    mechanism, t = pinned(points, bars), np.linspace(0.0, 2 * np.pi, 41)
    one, other = 0.4 * np.sin(t), 0.3 * np.sin(2 * t)
    spoilt = one.copy()
    spoilt[[3, 20, 21, 40]] = np.nan
    keep = np.isfinite(spoilt)
    without = mechanism.sweep({"A": one[keep], "E": other[keep]})
    motion = mechanism.sweep({"A": spoilt, "E": other})
    np.testing.assert_array_equal(np.asarray(motion.status) == Status.NONFINITE, ~keep)
    np.testing.assert_allclose(motion.coordinates["C"][keep], without.coordinates["C"], atol=1e-13)


@pytest.mark.long
def test_nan_in_long_ranges_streams_and_files(tmp_path):
    mechanism, angles = jk.load(path("fourbar")).mechanism(fixed=["ground"]), np.linspace(0.0, 6.0, 10_000)
    expected = mechanism.sweep({"ground-crank": angles}).coordinates["ground-rocker"]
    wrong = np.array([0, 5000, 6999, 7000, 9999])
    angles[wrong] = np.nan
    motion, rest = mechanism.sweep({"ground-crank": angles}), np.setdiff1d(np.arange(10_000), wrong)
    assert np.all(np.asarray(motion.closed)[rest]) and int(np.sum(motion.status == Status.NONFINITE)) == len(wrong)
    np.testing.assert_allclose(motion.coordinates["ground-rocker"][rest], expected[rest], atol=1e-12)
    chunks = list(mechanism.stream({"ground-crank": angles}, chunk=1000))
    np.testing.assert_array_equal(np.concatenate([chunk.status for chunk in chunks]), motion.status)
    streamed = np.concatenate([chunk.coordinates["ground-rocker"] for chunk in chunks])
    np.testing.assert_allclose(streamed[rest], expected[rest], atol=1e-12)
    mechanism.sweep({"ground-crank": angles[4990:5010]}).save(tmp_path)  # pictures show the closed poses
    assert "NONFINITE" in (tmp_path / "motion.csv").read_text()
    rates = jk.velocities(mechanism.sweep({"ground-crank": angles[4990:5010]}), {"ground-crank": 1.0})
    assert np.all(np.isfinite(rates.displacements[0][:5]))
