"""A drive that makes no sense is refused with what arrived, what was expected and what to write."""

import numpy as np
import pytest

from jaxkin.joints.pairs import cylindrical
from jaxkin.motion.drive import resolve
from reference.mechanisms import cam, planar_fourbar, rssr_linkage


@pytest.mark.parametrize(
    "drive, message",
    [
        ({}, "the drive is empty"),
        ({"a": [0.0]}, "there is no joint 'a' to drive"),
        ({"A.z": [0.0]}, r"joint 'A' \(revolute\) has no coordinate 'z'; it has: phi"),
        ({"A": [0.0, 1.0], "D": [0.0]}, "equal length.*'A.phi': 2, 'D.phi': 1"),
        ({"A": [0.0], "A.phi": [0.0]}, "names 'A.phi' twice"),
        ({"A": 0.5}, r"one value a pose, got shape \(\); write \[value\]"),
        ({"A": [[0.5]]}, r"got shape \(1, 1\)"),
        ({"A": [0.0, float("nan")]}, "drive 'A': pose 1 is nan"),
        ({"A": ["x"]}, "must be real numbers"),
        ({"A": [1j]}, "must be real numbers"),
    ],
)
def test_refused(drive, message):
    with pytest.raises(ValueError, match=message):
        resolve(planar_fourbar(), drive)


def test_a_joint_of_several_coordinates_asks_which():
    with pytest.raises(ValueError, match=r"has 2 coordinates: write 'A.z' or 'A.phi'"):
        resolve(planar_fourbar(pin=cylindrical), {"A": [0.0]})


def test_a_ball_is_driven_whole():
    with pytest.raises(ValueError, match=r"drive all of 'B\.theta', 'B\.phi', 'B\.psi', or none"):
        resolve(rssr_linkage(), {"B.phi": [0.1]})


def test_nearest_name():
    with pytest.raises(ValueError, match="did you mean 'shaft'"):
        resolve(cam(), {"shaf": [0.0]})


def test_coordinates_that_a_chain_holds_twice_are_numbered():
    joint = cam().joints["touch"]
    assert joint.coordinates == ("x", "y", "phi1", "phi2")
    driven = resolve(cam(), {"touch.phi2": np.zeros(3)})
    assert driven["touch.phi2"].coordinate == 3
