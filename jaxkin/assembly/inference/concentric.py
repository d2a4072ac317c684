"""Shafts inside of each other, each with a bearing of its own: what is wide of another one guides nothing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from jaxkin.assembly.inference.bores import NEAR_ANGLE, NEAR_LENGTH
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.sleeves import MAX_LOOSE
from jaxkin.assembly.inference.stopped_joint import StoppedJoint
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind


def without_concentric(
    known: Known, hinges: Iterable[StoppedJoint], turning: Sequence[Inference]
) -> list[StoppedJoint]:
    """Leave out hinges with more play than a bush has, of two bodies each of which turns in a third one about the same
    axis already: the collar of an eccentric in the hollow of the output is beside it, and not in it."""
    joints = [each.joint for each in turning if each.joint is not None and each.joint.kind is JointKind.REVOLUTE]
    return [each for each in hinges if not _is_beside(known, each, joints)]


def _is_beside(known: Known, hinge: StoppedJoint, joints: Sequence[Joint]) -> bool:
    sizes, joint = dict(hinge.inference.evidence.sizes), hinge.inference.joint
    radius = sizes.get("radius", 0.0)
    if joint is None or sizes.get("clearance", 0.0) <= MAX_LOOSE * radius:
        return False
    owners = {known.body[part] for part in joint.parts}
    about = [{known.body[part] for part in each.parts} for each in joints if _have_one_axis(each, joint, radius)]
    return all(any(owner in pair and pair != owners for pair in about) for owner in owners)


def _have_one_axis(one: Joint, other: Joint, radius: float) -> bool:
    """Tell whether two joints turn about one axis, to `NEAR_LENGTH` over the radius of the pin of one of them."""
    first, second = (np.asarray(each.frames_1, float)[0] for each in (one, other))
    offset = np.cross(second[:3, 3] - first[:3, 3], first[:3, 2])
    tilt = np.cross(second[:3, 2], first[:3, 2])
    return bool(np.linalg.norm(tilt) <= NEAR_ANGLE and np.linalg.norm(offset) <= NEAR_LENGTH * radius)
