"""`--drive`: what is read, in which unit, and what is refused."""

import numpy as np
import pytest

from jaxkin.cli.drives import parse_drives, to_radians
from jaxkin.joints.pairs import cylindrical, revolute
from jaxkin.motion.mechanism import Mechanism

MECHANISM = Mechanism.build(
    fixed=["base"],
    joints=[
        revolute("hinge", "base", "arm", point=(0, 0, 0), axis=(0, 0, 1)),
        cylindrical("sleeve=2", "arm", "tool", point=(1, 0, 0), axis=(0, 0, 1)),
    ],
)


def test_range_and_list():
    drives = parse_drives(["hinge=-30:30:3", "sleeve=2.z=0,2.5,1e1"])
    assert list(drives) == ["hinge", "sleeve=2.z"]
    np.testing.assert_array_equal(drives["hinge"], [-30.0, 0.0, 30.0])
    np.testing.assert_array_equal(drives["sleeve=2.z"], [0.0, 2.5, 10.0])


def test_angles_are_degrees_and_lengths_are_not():
    drives = parse_drives(["sleeve=2.z=0:90:2", "hinge=0:90:2", "sleeve=2.phi=0:-90:2"])
    converted = to_radians(MECHANISM, drives)
    np.testing.assert_array_equal(converted["sleeve=2.z"], [0.0, 90.0])
    np.testing.assert_allclose(converted["hinge.phi"], [0.0, np.pi / 2])
    np.testing.assert_allclose(converted["sleeve=2.phi"], [0.0, -np.pi / 2])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["hinge"], "--drive hinge: write JOINT=START:STOP:COUNT"),
        (["=0:1:2"], "--drive =0:1:2: write JOINT="),
        (["hinge=0:360"], "cannot read '0:360' as a range"),
        (["hinge=0:360:many"], "cannot read '0:360:many'"),
        (["hinge=0:360:2.5"], "cannot read '0:360:2.5'"),
        (["hinge=0:360:0"], "COUNT must be 1 or more, got 0"),
        (["hinge=a,b"], "cannot read 'a,b'"),
        (["hinge=0:1:2", "hinge=0:2:2"], "hinge was given a range already"),
    ],
)
def test_unreadable_options_are_refused(options, said):
    with pytest.raises(ValueError, match="--drive") as error:
        parse_drives(options)
    assert said in str(error.value)


def test_nothing_driven_names_what_can_be():
    with pytest.raises(ValueError, match=r"hinge\.phi, sleeve=2\.z, sleeve=2\.phi"):
        to_radians(MECHANISM, {})
