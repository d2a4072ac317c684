"""Spherical linkages whose joints all have one point, but for rounding."""

import numpy as np
import pytest

from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.mechanism import Mechanism
from reference import mechanisms
from reference.spatial import spherical_fourbar

LONG = pytest.mark.long


@pytest.mark.long
@pytest.mark.parametrize("centre", [1.0, pytest.param(1000.0, marks=LONG)])
@pytest.mark.parametrize("digits", [15, pytest.param(9, marks=LONG)])
def test_a_spherical_linkage_whose_points_are_one_but_for_rounding_moves(centre, digits):
    # the points of the joints have no extent of their own: their noise must not be taken for the size of the mechanism
    axes, theta = mechanisms.spherical_linkage().all_joints, np.linspace(-0.3, 0.3, 7)
    noise = centre * 10.0**-digits * np.random.default_rng(0).uniform(-1, 1, (4, 3))

    def at(points) -> Mechanism:
        joints = [
            revolute(joint.name, *joint.parts, point=point, axis=joint.frames_1[0, :3, 2])
            for joint, point in zip(axes, centre / np.sqrt(3) + points, strict=True)
        ]
        return Mechanism.build(fixed=["ground"], joints=joints)

    motion, exact = (at(points).sweep({"A": theta}) for points in (noise, 0 * noise))
    assert np.all(motion.closed) and motion.mechanism.mobility() == exact.mechanism.mobility()
    output = spherical_fourbar(0.4 + theta).output - spherical_fourbar(np.array([0.4])).output
    assert np.abs(np.asarray(motion.coordinates["D"])[:, 0] - output).max() < 1e-12 + 10.0 ** (1 - digits)
