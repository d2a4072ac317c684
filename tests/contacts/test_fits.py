"""Pins in holes and balls in sockets with clearance, off centre, too loose and too tight."""

import numpy as np
import pytest

from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.pose import rotation
from jaxkin.geometry.surfaces import Cylinder, Plane, Sphere

X, Y, Z = np.eye(3)
TURN = (-np.pi, np.pi)


def fit(solids, pin_radius, offset=0.0, hole_radius=1.0, **options):
    """A pin of length 2 in a hole."""
    hole = solids.patch(Cylinder(np.zeros(3), Z, hole_radius, -1), TURN, (0, 2))
    pin = solids.patch(Cylinder(offset * X, Z, pin_radius, 1), TURN, (-1, 3))
    return find_contacts((solids.part("block", hole), solids.part("pin", pin)), **options)


def ball(solids, radius, offset=0.0):
    socket = solids.patch(Sphere(np.zeros(3), 1.0, -1), TURN, (-1.5, 0.5))
    held = solids.patch(Sphere(offset * X, radius, 1), TURN, (-1.5, 1.5), axis=X)
    return find_contacts((solids.part("cup", socket), solids.part("ball", held)))


@pytest.mark.parametrize("offset", [0.0, 0.005, 0.01])
def test_a_pin_anywhere_within_its_clearance_fills_the_hole(solids, offset):
    """Clearance 0.01: concentric, off centre, or leaning against the wall (where it also is in state f)."""
    (contact,) = fit(solids, 0.99, offset)
    assert (contact.state, contact.region) == ("e", "surface")
    assert contact.misfit == pytest.approx(0.01)
    np.testing.assert_allclose(contact.frames[0, :3, 3], [offset / 2, 0, 1], atol=1e-6)  # the mean axis
    np.testing.assert_allclose(abs(contact.frames[0, :3, 2]), Z, atol=1e-12)
    (contact,) = ball(solids, 0.99, offset)
    assert contact.state == "o" and contact.misfit == pytest.approx(0.01)
    np.testing.assert_allclose(contact.frames[0, :3, 3], [offset / 2, 0, 0], atol=1e-12)


def test_a_loose_pin_touches_where_it_touches(solids):
    """Clearance 0.1: a contact along a line if it leans against the wall, else none."""
    (contact,) = fit(solids, 0.9, 0.1)
    assert (contact.state, contact.region) == ("f", "line")
    contacts = fit(solids, 0.9)
    assert len(contacts) == 0
    (miss,) = contacts.near_misses
    assert miss.state == "e" and miss.reason == "radial clearance 0.1, allowed 0.018: give fit=0.12 if it guides"
    (contact,) = fit(solids, 0.9, fit=0.12)  # as the report suggests
    assert contact.state == "e"


def test_a_press_fit_is_no_joint_but_a_report(solids):
    contacts = fit(solids, 1.01)
    assert len(contacts) == 0
    (miss,) = contacts.near_misses
    assert (miss.state, miss.parts) == ("e", ("block", "pin"))
    assert "thicker than its hole by 0.01: a press fit" in miss.reason
    assert [miss.state for miss in ball(solids, 1.01).near_misses] == ["o"]


def test_a_pin_off_centre_by_more_than_its_clearance_is_reported(solids):
    contacts = fit(solids, 0.99, 0.03)
    assert len(contacts) == 0
    (miss,) = contacts.near_misses
    assert miss.state == "e" and miss.gap == pytest.approx(0.03) and "off centre by 0.03" in miss.reason


def test_a_small_pin_in_a_large_hole_is_not_mentioned(solids):
    contacts = fit(solids, 0.5)
    assert len(contacts) == 0 and not contacts.near_misses


def test_tolerances_can_be_given(solids):
    assert len(fit(solids, 0.99, fit=0.001)) == 0
    assert [contact.state for contact in fit(solids, 0.9, 0.098, length=0.005)] == ["f"]


def test_a_gap_and_a_tilt_that_are_too_much_only_together_are_both_named(solids):
    """Length tolerance 0.01 over an extent of 2 sqrt 2: a gap of 0.007 and a tilt of 0.005 rad add up to 0.014."""
    floor = solids.patch(Plane(np.zeros(3), Z), (-1, 1), (-1, 1))
    lid = solids.patch(Plane(np.zeros(3), -Z), (-1, 1), (-1, 1))

    def lifted(gap, tilt):
        pose = np.eye(4)
        pose[:3, :3], pose[2, 3] = rotation(X, tilt), gap
        parts = solids.part("floor", floor), solids.part("lid", solids.moved(lid, pose))
        return find_contacts(parts, length=0.01, angle=0.01)

    assert len(lifted(0.007, 0.0)) == len(lifted(0.0, 0.005)) == 1
    contacts = lifted(0.007, 0.005)
    assert len(contacts) == 0
    (miss,) = contacts.near_misses
    assert "tilted by 0.005 rad" in miss.reason and "a gap of 0.007" in miss.reason
