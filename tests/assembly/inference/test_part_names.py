"""Names that say what a part is, as CAD systems and their users write them."""

import pytest

from jaxkin.assembly.inference.named_bearings import is_named_bearing
from jaxkin.assembly.inference.named_motors import is_named_motor


@pytest.mark.parametrize(
    "name",
    ["Output bearing", "608ZZ Bearing<1>", "Main_Bearing_Left", "Bearing (Mirror) 2", "Kugellager links", "BEARING.1"],
)
def test_marks_of_places_and_copies_leave_a_bearing_one(name):
    assert is_named_bearing(name) and not is_named_motor(name)


@pytest.mark.parametrize(
    "name",
    [
        "bearing cap",
        "Bearing_Block 2",
        "bearing inner",
        "outer ring of bearing race",
        "linear bearing",
        "thrust bearing",
    ],
)
def test_what_belongs_to_a_bearing_or_slides_is_no_ball_bearing(name):
    assert not is_named_bearing(name)


@pytest.mark.parametrize("name", ["Gearmotor_25D_left 2", "Motor copy", "Servo (mirror)", "Getriebemotor rechts"])
def test_marks_of_places_and_copies_leave_a_motor_one(name):
    assert is_named_motor(name) and not is_named_bearing(name)


@pytest.mark.parametrize("name", ["motor plate", "Motor_Mount 1", "servo horn", "left", ""])
def test_what_belongs_to_a_motor_is_none(name):
    assert not is_named_motor(name)
