"""A mechanism assembled in another of its poses: the same motion, counted from there."""

import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar

Z = (0.0, 0.0, 1.0)
TURN = np.linspace(0.0, 2 * np.pi, 25)


def geared():
    joints = [
        jk.revolute("A", "ground", "a", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "a", "b", point=(0, 1, 0), axis=Z),
        jk.revolute("C", "b", "c", point=(1.5, 3, 0), axis=Z),
        jk.revolute("D", "c", "d", point=(4, 1, 0), axis=Z),
        jk.revolute("E", "ground", "d", point=(4, 0, 0), axis=Z),
        jk.screw("S", "d", "nut", point=(4, 2, 0), axis=(0, 1, 1), pitch=0.5),
        jk.universal("U", "nut", "tip", point=(4, 2, 1), axis1=(1, 0, 0), axis2=(0, 1, 0)),
    ]
    ties = [jk.gear("A", "E", -1.0), jk.polynomial("S", "A", [0.0, 1.0, 0.5])]
    return jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=ties)


@pytest.mark.long
def test_the_motion_from_there_is_the_rest_of_the_motion():
    """Displacements of parts from the new pose are those from the old one, after the displacement between the two."""
    mechanism = geared()
    angles = np.linspace(0.0, 0.5, 6)
    before = mechanism.sweep({"A": angles, "U.theta": 0.3 * angles, "U.phi": -angles}, throw=True)
    there = mechanism.at(before, 2)
    after = there.sweep({"A": angles - angles[2], "U.theta": 0.3 * (angles - angles[2]), "U.phi": angles[2] - angles})
    assert np.asarray(after.closed).all()
    for part in mechanism.parts:
        place = np.asarray(before.transforms[part][2])
        np.testing.assert_allclose(after.transforms[part] @ place, before.transforms[part], rtol=0, atol=1e-12)
    np.testing.assert_allclose(after.coordinates["S"] + before.coordinates["S"][2], before.coordinates["S"], atol=1e-13)


@pytest.mark.long
def test_all_lengths_stay_and_a_single_pose_will_do():
    mechanism = planar_fourbar()
    drive = mechanism.mobility().drivable[0]
    there = mechanism.at(mechanism.solve({drive: 1.0}))
    assert there.lengths == pytest.approx(mechanism.lengths, rel=1e-13)
    back = there.at(there.solve({drive: -1.0}))
    for one, other in zip(mechanism.all_joints, back.all_joints, strict=True):
        np.testing.assert_allclose(one.frames_1[:, :3, 3], other.frames_1[:, :3, 3], atol=1e-12)


@pytest.mark.long
def test_what_is_no_closed_pose_of_this_mechanism_is_refused():
    mechanism = geared()
    motion = mechanism.sweep({"A": np.array([0.0, 3.0, np.nan])})
    with pytest.raises(ValueError, match=r"pose 2 is NONFINITE: .*; a mechanism is assembled in closed poses only"):
        mechanism.at(motion, 2)
    with pytest.raises(ValueError, match="the motion has 3 poses, numbered from 0, got 3"):
        mechanism.at(motion, 3)
    with pytest.raises(ValueError, match=r"with other parts or joints: write motion.mechanism.at"):
        planar_fourbar().at(motion, 0)
