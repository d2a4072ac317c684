"""Slides of carriages on rails are told from those of what is put over a lip, or laid on a step."""

import pytest

from jaxkin.assembly.assembly import Assembly
from jaxkin.assembly.guides import is_guide
from jaxkin.joints.kinds import JointKind
from reference.round_parts import block, part


def slide(length, *, lips=True, sides=True):
    """The joint of a rail with a wider head, 200 long, and something on it, with and without what holds it there."""
    rail = part("rail", block((0, -4, 0), (200, 4, 6)), block((0, -8, 6), (200, 8, 12)))
    low, high = 100 - length / 2, 100 + length / 2
    pieces = [block((low, -14, 12), (high, 14, 18))]
    if sides:
        pieces += [block((low, 8, 2), (high, 14, 12)), block((low, -14, 2), (high, -8, 12))]
    if lips:
        pieces += [block((low, 4, 2), (high, 8, 6)), block((low, -8, 2), (high, -4, 6))]
    mechanism = Assembly((rail, part("carriage", *pieces)), "mm", "drawn").mechanism(fixed=["rail"], infer=False)
    (joint,) = mechanism.all_joints
    return mechanism, joint


@pytest.mark.parametrize("length", [20, 99])
def test_a_carriage_on_its_rail_is_a_guide(length):
    mechanism, joint = slide(length)
    assert joint.kind is JointKind.PRISMATIC and is_guide(mechanism, joint)


@pytest.mark.parametrize("length, lips, sides", [(101, True, True), (20, False, True), (20, False, False)])
def test_what_has_no_room_or_can_be_lifted_off_is_none(length, lips, sides):
    mechanism, joint = slide(length, lips=lips, sides=sides)
    assert joint.kind is (JointKind.PRISMATIC if sides else JointKind.PLANAR) and not is_guide(mechanism, joint)
