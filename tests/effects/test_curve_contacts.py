"""Where joints along curves are not possible: undercut, a face across a hollow, curves through each other."""

import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)
TURN = np.linspace(0.0, 2 * np.pi, 73)
ANGLE = 2 * np.pi * np.arange(180) / 180


def clover(waves=6.0, count=3, radius=30.0):
    """A round cam with waves: r = radius + waves cos(count angle), whose curvature has a closed form."""
    far = radius + waves * np.cos(count * ANGLE)
    return far[:, None] * np.stack([np.cos(ANGLE), np.sin(ANGLE)], axis=1)


def curvature(angle, waves=6.0, count=3, radius=30.0):
    r = radius + waves * np.cos(count * angle)
    dr, ddr = -waves * count * np.sin(count * angle), -waves * count**2 * np.cos(count * angle)
    return (r**2 + 2 * dr**2 - r * ddr) / (r**2 + dr**2) ** 1.5


def on_cam(follower, waves=6.0, radius=None):
    """A follower that slides along x, where the clover has a crest as assembled."""
    reach = 30.0 + waves + (radius or 0.0)
    more = {"profile": clover(waves), "follower": follower, "point2": (reach, 0, 0)}
    more |= {"radius": radius} if radius else {"direction2": (0, 1, 0)}
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.cam("contact", "cam", "follower", **more),
            jk.prismatic("guide", "ground", "follower", axis=(1, 0, 0)),
        ],
        unit="mm",
    )


def spline_curvature(angle, step=1e-3):
    """The curvature of a cubic spline through the points of the clover, at a crest or hollow that is one of them.

    The second derivative of a spline is less than that of its curve by h^2 / 12 times the fourth, which is
    k'' - k^3 along the normal, by arc length. What is left, of the order h^4, is 5e-5 of the curvature in a hollow.
    """
    before, there, after = (curvature(angle + way * step) for way in (-1, 0, 1))
    radius = 30.0 + 6.0 * np.cos(3 * angle)  # it does not change to the first order: ds = r d angle
    return there - (radius * ANGLE[1]) ** 2 / 12 * ((before - 2 * there + after) / (step * radius) ** 2 - there**3)


PAST = np.radians([0, 15, 30, 45, 50, 55, 58, 60, 61, 62, 80])
"""From a crest to a hollow, which faces the follower at 60 degrees, and on; the last pose does not close."""
HOLLOW = -1.0 / curvature(np.pi / 3)
"""Radius of curvature in a hollow of the clover: 19 mm."""


@pytest.mark.long
def test_a_roller_that_fits_into_the_hollows():
    motion = on_cam("roller", radius=10.0).sweep({"shaft": TURN}, throw=True)
    found = jk.curve_contacts(motion)
    assert found.holds and "possible" in str(found) and "curve contact" not in str(motion)
    contact = found.contacts[0]
    assert contact.curvature.max() == pytest.approx(spline_curvature(0.0), rel=1e-4)
    assert contact.curvature.min() == pytest.approx(spline_curvature(np.pi / 3), rel=1e-4)
    np.testing.assert_allclose(contact.clearance, 1 + 10.0 * contact.curvature, rtol=1e-12)
    # the contact passes all of the profile once
    assert np.ptp(np.unwrap(contact.parameter, period=length())) == pytest.approx(length(), rel=1e-9)


def length():
    points = clover()
    return np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum()


@pytest.mark.long
def test_a_roller_larger_than_a_hollow():
    """It rests on both flanks of a hollow where that faces it, and would have to pass through one from there on."""
    radius = 2.5 * HOLLOW
    motion = on_cam("roller", radius=radius).sweep({"shaft": PAST})
    found = jk.curve_contacts(motion)
    contact, closed = found.contacts[0], np.asarray(motion.closed)
    assert not found.holds
    # the depth is the radius less the distance of the roller's middle from the profile, found by brute force
    pose = int(np.nanargmax(contact.depth))
    middle = 36.0 + radius + float(motion.coordinates["guide"][pose, 0])
    fine = np.linspace(0, 2 * np.pi, 200_000) + PAST[pose]
    far = 30.0 + 6.0 * np.cos(3 * (fine - PAST[pose]))
    apart = np.hypot(far * np.cos(fine) - middle, far * np.sin(fine))
    # the samples of the profile are 0.13 mm apart: the square of half of that, over the radius
    assert contact.depth[pose] == pytest.approx(radius - apart.min(), abs=1e-3)
    assert contact.depth[pose] > 0.05
    assert "would have a roller pass through the profile" in str(motion)
    # where the contact is in the hollow the pitch curve is undercut; or the motion ends before, at its cusp
    undercut = contact.clearance[closed] < 0
    assert undercut.any() == ("is undercut" in str(found))
    assert undercut.any() or not closed.all()


@pytest.mark.long
def test_a_flat_face_across_a_hollow():
    """It rests on two crests where a hollow faces it, and would have to pass through the next crest from there on."""
    assert jk.curve_contacts(on_cam("flat", waves=1.5).sweep({"shaft": TURN}, throw=True)).holds
    motion = on_cam("flat").sweep({"shaft": TURN[:19]})
    found, closed = jk.curve_contacts(motion), np.asarray(motion.closed)
    contact = found.contacts[0]
    assert not found.holds or not closed.all()
    # the height of the cam over all points, against that of the contact
    fine = np.linspace(0, 2 * np.pi, 200_000)
    far = 30.0 + 6.0 * np.cos(3 * fine)
    for pose in np.flatnonzero(closed):
        over = (far * np.cos(fine + TURN[pose])).max() - 36.0 - float(motion.coordinates["guide"][pose, 0])
        # the samples of the profile are 0.13 mm apart
        assert contact.depth[pose] == pytest.approx(over, abs=1e-3)


@pytest.mark.long
@pytest.mark.study
def test_a_round_curve_larger_than_a_hollow_is_told_as_a_roller_is():
    radius = 2.5 * HOLLOW
    round_one = radius * np.stack([np.cos(ANGLE), np.sin(ANGLE)], axis=1)
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.curve_on_curve(
                "contact", "cam", "follower", profile=clover(), profile2=round_one, point2=(36.0 + radius, 0, 0)
            ),
            jk.prismatic("guide", "ground", "follower", axis=(1, 0, 0)),
        ],
    )
    motion = mechanism.sweep({"shaft": PAST})
    alike = on_cam("roller", radius=radius).sweep({"shaft": PAST})
    both = np.asarray(motion.closed & alike.closed)
    assert both.sum() > 6
    np.testing.assert_allclose(
        motion.coordinates["guide"][both], alike.coordinates["guide"][both], atol=1e-5
    )  # both splines
    one, other = (jk.curve_contacts(each).contacts[0] for each in (motion, alike))
    np.testing.assert_allclose(one.depth[both], other.depth[both], atol=5e-2)  # by corners of polygons
    assert (one.depth[both] > 0).any()
    assert "would have a curve pass through the profile" in str(motion)


@pytest.mark.long
@pytest.mark.parametrize("points", [40, 180])
def test_a_disc_in_a_round_hollow_passes_through_nothing(points):
    """It touches the ring that it is in at one point, however far apart the points of both are."""
    angle = 2 * np.pi * np.arange(points) / points
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "ring", point=(0.0, 0.0, 0.0), axis=Z),
            jk.curve_on_curve(
                "contact", "ring", "disc", profile=40.0 * circle + [5.0, 0.0], profile2=8.0 * circle, point2=(37, 0, 0)
            ),
            jk.prismatic("guide", "ground", "disc", axis=(1, 0, 0)),
        ],
    )
    motion = mechanism.sweep({"shaft": TURN}, throw=True)
    centre = 5.0 * np.cos(TURN) + np.sqrt(32.0**2 - (5.0 * np.sin(TURN)) ** 2)
    # splines of so many points are off by R h^4 / 384
    np.testing.assert_allclose(motion.coordinates["guide"][:, 0], centre - 37.0, atol=40 * angle[1] ** 4 / 100)
    assert jk.curve_contacts(motion).holds


@pytest.mark.long
def test_what_is_not_known_of_open_curves_is_told():
    """Of an open curve no side is the inside: whether the other curve passes through it is not looked for."""
    along = np.linspace(-20.0, 20.0, 41)
    arc = np.stack([along, -(along**2) / 200], axis=1)
    joints = [
        jk.prismatic("slide", "ground", "ramp", axis=(1, 0, 0)),
        jk.curve_on_curve("contact", "ramp", "follower", profile=arc, profile2=-arc, closed=False, closed2=False),
        jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0)),
    ]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    found = jk.curve_contacts(mechanism.sweep({"slide": np.linspace(0.0, 5.0, 6)}))
    assert found.holds and np.isnan(found.contacts[0].depth).all()
    first, second = str(found).splitlines()
    assert first.endswith("all are possible at all closed poses")
    assert "'contact': whether its curves pass through each other is not known" in second


@pytest.mark.long
def test_drawn_and_saved(tmp_path):
    found = jk.curve_contacts(on_cam("roller", radius=10.0).sweep({"shaft": TURN}))
    assert found.plot(tmp_path / "contacts.png").stat().st_size > 1000
    table = found.save(tmp_path / "contacts.csv").read_text().splitlines()
    assert len(table) == len(TURN) + 1 and table[0].startswith('pose,"contact parameter [mm]"')


def test_mechanisms_without_curves_are_refused():
    hinge = jk.revolute("A", "ground", "arm", point=(0, 0, 0), axis=Z)
    motion = jk.Mechanism.build(fixed=["ground"], joints=[hinge]).sweep({"A": [0.0, 1.0]})
    with pytest.raises(ValueError, match="no joints along curves"):
        jk.curve_contacts(motion)
