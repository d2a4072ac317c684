"""Profiles and followers that make no sense are refused, and what is moved onto a profile is told."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.joints.kinds import JointKind
from reference import higher_pairs
from reference.oval_cam import flat_on_oval

CIRCLE = higher_pairs.disc_profile(24, eccentricity=0.0)
EIGHT = np.stack([np.sin(2 * np.pi * np.arange(24) / 24), np.sin(4 * np.pi * np.arange(24) / 24)], axis=1)


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"follower": "rollr"}, "follower must be one of 'knife', 'roller', 'flat', got 'rollr'.*'roller'"),
        ({"follower": "roller", "direction2": None}, "a follower 'roller' needs radius"),
        ({"radius": 3.0}, "a follower 'flat' has no radius, got 3.0"),
        ({"direction2": None}, "a follower 'flat' needs direction2"),
        ({"direction2": (0, 0, 1)}, "direction2 must be perpendicular to the axis of the profile"),
        ({"follower": "roller", "direction2": None, "radius": -2.0}, "radius of a roller must be a positive number"),
        ({"follower": "roller", "direction2": None, "radius": np.nan}, "radius of a roller must be a positive number"),
        ({"profile": CIRCLE[:3]}, "needs 4 points at least, got 3"),
        ({"profile": CIRCLE[:, :1]}, r"an array of shape \(n, 2\), got shape \(24, 1\)"),
        ({"profile": "round"}, "must be points .* got 'round'"),
        ({"profile": np.where(np.arange(24)[:, None] == 7, np.nan, CIRCLE)}, "point 7 of profile is not finite"),
        ({"profile": np.vstack([CIRCLE, CIRCLE[:1]])}, "the last point repeats the first one.*leave it out"),
        ({"profile": np.insert(CIRCLE, 5, CIRCLE[5], axis=0)}, "points 5 and 6 are the same"),
        ({"profile": EIGHT}, "crosses itself near"),
        ({"point2": (0, np.inf, 0)}, "point2 must be three finite numbers"),
        ({"axis": (0, 0, 0)}, "axis must be a direction, got the zero vector"),
        ({"limits": {"t": (0, 1)}}, "there is no coordinate 't'"),
    ],
)
def test_bad_input(changes, message):
    with pytest.raises(ValueError, match=message):
        flat_on_oval(**changes)


def test_curves_without_a_common_normal_are_refused():
    line = np.stack([np.linspace(0, 1, 5), np.zeros(5)], axis=1)
    with pytest.raises(ValueError, match="no common normal"):
        jk.curve_on_curve(
            "c", "a", "b", profile=line, profile2=line, closed=False, closed2=False, direction2=(1, 1, 0),
            point2=(3, 0, 0),
        )  # fmt: skip
    with pytest.raises(ValueError, match="no tangent of the profile is parallel to the face"):
        jk.cam(
            "c", "a", "b", profile=line, closed=False, follower="flat", point2=(0, 0, 0), direction2=(0, 1, 0)
        )  # fmt: skip


def test_traced_profiles_are_given_another_way():
    with pytest.raises(ValueError, match=r"outside of jit and grad"):
        jax.grad(lambda scale: flat_on_oval(profile=scale * CIRCLE).joints["contact"].pitch)(1.0)


def test_a_point_that_is_moved_onto_its_curve_is_told():
    mechanism = flat_on_oval(point2=(0, 22 + 1e-5, 0))
    assert "moved by 1e-05 to touch the profile" in str(mechanism)
    assert mechanism.joints["contact"].kind is JointKind.CAM
    assert "Not closed" in str(flat_on_oval(point2=(0, 22.1, 0)))
