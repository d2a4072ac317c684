"""Faces along the axis of a pin with play: those of a lid that is drawn closed open, those that meet on both sides of
the axis keep it from turning.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import anywhere, assembly, block, moving, owners, part, pin, ring


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("turns", [True, False])
def test_a_lid_that_lies_on_its_box_turns_where_the_faces_meet_on_one_side_of_its_pin_alone(seed, turns):
    """The axis is z, and the faces meet at y = -8 from x = 10 on; a lid that also meets them behind it cannot turn."""
    box = part("box", block((-60, -60, -40), (90, -8, 40)), ring(5.0, 7.5, -30, -11), ring(5.0, 7.5, 11, 30))
    behind = [] if turns else [block((-50, -8, -10), (-10, -2, 10))]
    lid = part(
        "lid", ring(5.3, 7.5, -10, 10), block((7, -2, -10), (80, 5, 10)), block((10, -8, -9), (80, -2, 9)), *behind
    )
    mechanism = anywhere(assembly(box, lid, part("pin", pin(5.0, -30, 30))), seed).mechanism(fixed=["box"])
    about = [joint for joint in moving(mechanism) if joint.kind == "revolute"]
    assert owners(mechanism)["pin"] == owners(mechanism)["box"]
    assert bool(about) == turns
    assert not turns or mechanism.mobility().useful == 1
