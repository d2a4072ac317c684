"""The angle between a plane and another feature of its part, changed by itself."""

import jax
import pytest

from jaxkin.joints.pairs import cylindrical, planar
from jaxkin.mechanism.mechanism import Mechanism


def others_kept(mechanism, changed, keys):
    return max(abs(changed.lengths[key] - value) for key, value in mechanism.lengths.items() if key not in keys)


@pytest.mark.parametrize("other", [cylindrical, planar])
@pytest.mark.parametrize("exchanged", [False, True])
@pytest.mark.parametrize("plane_last", [False, True])
def test_the_angle_of_a_plane_leaves_its_distance(other, exchanged, plane_last):
    """Whichever of the two turns, as of a block on a tilted table whose hinge is beside it."""
    direction = {"axis" if other is cylindrical else "normal": (0.2, 0.4, 1)}
    joints = [
        planar("on", "table", "block", normal=(0.3, 0, 1), point=(1, -2, 2)),
        other("pin", "block", "arm", point=(3, 1, 5), **direction),
    ]
    mechanism = Mechanism.build(fixed=["table"], joints=joints[:: -1 if plane_last else 1])
    one, two = [joint.name for joint in mechanism.all_joints][:: -1 if exchanged else 1]
    angle = ("block", one, two, "angle")
    (now,) = (value for key, value in mechanism.lengths.items() if key[0] == "block" and key[3:] == ("angle",))
    changed = mechanism.with_lengths({angle: now + 0.3})
    listed = ("block", *[joint.name for joint in mechanism.all_joints], "angle")
    assert changed.lengths[listed] == pytest.approx(now + 0.3, abs=1e-14)
    assert others_kept(mechanism, changed, [listed]) < 1e-14
    traced = jax.jit(lambda value: mechanism.with_lengths({angle: value}).lengths)(now + 0.3)
    assert max(abs(traced[key] - value) for key, value in changed.lengths.items()) < 1e-14
