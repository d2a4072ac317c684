"""Mechanisms whose given pose is open, made from closed ones."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.joints.screws import chain
from jaxkin.mechanism.mechanism import Mechanism


def pushed(mechanism: Mechanism, place: tuple[str, str], shift, turn=(0.0, 0.0, 0.0)) -> Mechanism:
    """A joint moved on one of its parts only: the given pose is open by as much."""
    name = place[1]
    joint = mechanism.joints[name]
    pose = np.array((joint.frames_1 if joint.parts[0] == place[0] else joint.frames_2)[0])
    pose[:3, :3] = Rotation.from_rotvec(turn).as_matrix() @ pose[:3, :3]
    pose[:3, 3] += shift
    return mechanism.with_frames({place: pose}, align=0)


def zeroed_elsewhere(mechanism: Mechanism, angle: float, seed: int = 0) -> Mechanism:
    """The mechanism with displacements of all joints counted from other positions: the pose is open, and can close."""
    rng, joints = np.random.default_rng(seed), []
    size = float(np.ptp(np.concatenate([joint.frames_1[:, :3, 3] for joint in mechanism.all_joints]), axis=0).max())
    for joint in mechanism.all_joints:
        frames = []
        for name, frame in zip(joint.movements, joint.frames_2, strict=True):
            scales = [0.3 * size if is_length(each) else 1.0 for each in MOVEMENTS[name].coordinates]
            q = angle * np.array(scales) * rng.uniform(-1.0, 1.0, len(scales))
            frames.append(chain([name], frame[None], q, float(joint.pitch))[0] @ frame)
        joints.append(replace(joint, frames_2=np.array(frames)))
    return replace(mechanism, linkage=mechanism.linkage.with_joints(joints))


def rounded(mechanism: Mechanism, digits: int) -> Mechanism:
    """Turn a mechanism in space, in numbers of some digits, of which its loops do not close exactly."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = Rotation.from_rotvec([0.3, -1.0, 0.7]).as_matrix(), (40.0, -70.0, 25.0)
    joints = []
    for joint in mechanism.all_joints:
        before, after = (pose @ side for side in (joint.frames_1, joint.frames_2))
        for side in (before, after):
            side[:, :3, 3] = np.round(side[:, :3, 3], digits)
        joints.append(replace(joint, frames_1=before, frames_2=after))
    return Mechanism.build(fixed=["ground"], joints=joints)


def assert_same_lengths(one: Mechanism, other: Mechanism) -> None:
    """But for where the follower of the cam stands along its slide, which its pose says."""
    lengths = one.lengths
    for key, expected in other.lengths.items():
        if key != ("follower", "guide", "touch"):
            assert lengths[key] == pytest.approx(expected, rel=1e-12, abs=1e-10), key
