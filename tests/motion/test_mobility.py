"""Mobility from the rank, where counting is wrong too."""

import pytest

from jaxkin.joints.pairs import cylindrical
from reference.mechanisms import (
    ball_in_bore,
    bennett_linkage,
    cam,
    cardan_shafts,
    planar_fourbar,
    rssr_linkage,
    slider_crank,
    spherical_linkage,
)


@pytest.mark.parametrize(
    "mechanism, freedoms, redundant",
    [
        (planar_fourbar(), 1, 3),
        (slider_crank(), 1, 3),
        (cam(), 1, 1),
        (bennett_linkage(), 1, 3),
        (spherical_linkage(), 1, 3),
        (cardan_shafts(), 1, 3),
        (rssr_linkage(), 2, 0),
        (ball_in_bore(), 1, 1),
        (planar_fourbar(pin=cylindrical), 4, 2),
        (planar_fourbar(1.0, ground=120.0, crank=50.0, coupler=120.0, rocker=50.0), 1, 3),
        (planar_fourbar(0.0, ground=120.0, crank=50.0, coupler=120.0, rocker=50.0), 1, 3),  # flat: a singular pose
    ],
)
def test_freedoms_and_redundant_equations(mechanism, freedoms, redundant):
    """Six equations a loop: freedoms - redundant = coordinates - 6 loops, whatever the pose."""
    found = mechanism.mobility()
    assert (found.freedoms, found.redundant) == (freedoms, redundant)
    coordinates = sum(joint.freedoms for joint in mechanism.all_joints)
    assert freedoms - redundant == coordinates - 6 * len(mechanism.structure.loops)


def test_idle_freedoms_are_named():
    assert rssr_linkage().mobility().idle == ("B.theta", "B.phi", "B.psi", "C.theta", "C.phi", "C.psi")
    assert planar_fourbar().mobility().idle == ()
    assert set(planar_fourbar(pin=cylindrical).mobility().idle) == {"A.z", "B.z", "C.z", "D.z"}
