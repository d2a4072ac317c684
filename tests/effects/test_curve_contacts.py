"""Where joints along curves are not possible: undercut, a face across a hollow, curves through each other."""

import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)
TURN = np.linspace(0.0, 2 * np.pi, 73)
ANGLE = 2 * np.pi * np.arange(180) / 180


def clover(waves=3.0, count=3, radius=30.0):
    """A round cam with waves: r = radius + waves cos(count angle), whose curvature has a closed form."""
    far = radius + waves * np.cos(count * ANGLE)
    return far[:, None] * np.stack([np.cos(ANGLE), np.sin(ANGLE)], axis=1)


def curvature(angle, waves=3.0, count=3, radius=30.0):
    r = radius + waves * np.cos(count * angle)
    dr, ddr = -waves * count * np.sin(count * angle), -waves * count**2 * np.cos(count * angle)
    return (r**2 + 2 * dr**2 - r * ddr) / (r**2 + dr**2) ** 1.5


def on_cam(follower, waves=3.0, radius=None):
    """A follower that slides along x, where the clover has a crest as assembled."""
    reach = 30.0 + waves + (radius or 0.0)
    more = {"radius": radius} if radius else {"direction2": (0, 1, 0)}
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.cam(
                "contact", "cam", "follower", profile=clover(waves), follower=follower, point2=(reach, 0, 0), **more
            ),
            jk.prismatic("guide", "ground", "follower", axis=(1, 0, 0)),
        ],
        unit="mm",
    )


def test_a_roller_that_fits_into_the_hollows():
    motion = on_cam("roller", 3.0, 10.0).sweep({"shaft": TURN}, throw=True)
    found = jk.curve_contacts(motion)
    assert found.holds and "possible" in str(found)
    contact = found.contacts[0]
    # curvature in crests and hollows: the spline's, to the second order of 1 mm between points
    assert contact.curvature.max() == pytest.approx(curvature(0.0), rel=1e-3)
    assert contact.curvature.min() == pytest.approx(curvature(np.pi / 3), rel=1e-2)
    np.testing.assert_allclose(contact.clearance, 1 + 10.0 * contact.curvature, rtol=1e-12)


def test_a_roller_larger_than_a_hollow_is_undercut():
    """The hollows have a radius of curvature of 1 / 0.0658 = 15 mm: a roller of 20 mm touches their flanks."""
    hollow = -1.0 / curvature(np.pi / 3)
    assert 14 < hollow < 65
    motion = on_cam("roller", 3.0, hollow * 1.3).sweep({"shaft": TURN})
    found = jk.curve_contacts(motion)
    contact = found.contacts[0]
    assert not found.holds
    closed = np.asarray(motion.closed)
    assert (np.nanmin(contact.depth) >= 0 and np.nanmax(contact.depth) > 0) or not closed.all()
    if closed.all():
        assert "is undercut" in str(found) and "would have a roller pass through the profile" in str(motion)


def test_a_flat_face_across_a_hollow():
    """A face rests on two crests; the contact in the hollow between them is deep below it."""
    motion = on_cam("flat", waves=0.5).sweep({"shaft": TURN}, throw=True)
    assert jk.curve_contacts(motion).holds  # 30 > 8 * 0.5: convex all around
