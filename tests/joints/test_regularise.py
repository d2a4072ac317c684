"""Noise of the reader is taken out exactly, design is left alone."""

from itertools import pairwise

import numpy as np
import pytest

from jaxkin.geometry.pose import unit
from jaxkin.geometry.surfaces import Cylinder, Sphere
from jaxkin.joints.axes import align_positions
from jaxkin.joints.directions import align_directions
from jaxkin.joints.regularise import Noise, align, regularise
from joints.touching import X, Y, Z, ball, displacement, face, moved, pin, placed, roller, touching

ORIGIN = np.zeros(3)
SIZE = 100.0
READER = 2e-7  # radians, and of the size: about what float32 leaves


def hinge(part1, part2, at, axis):
    return [pin(at, axis, parts=(part1, part2)), face(np.asarray(at) + 3 * axis, axis, (part1, part2))]


def slider_crank():
    """Directions along z and in the plane across it, at odd angles."""
    rail = unit(2 * X + Y)
    across = np.cross(Z, rail)
    return [
        *hinge("ground", "crank", ORIGIN, Z),
        *hinge("crank", "rod", 20 * X + 10 * Y, Z),
        *hinge("rod", "slider", 80 * X + 40 * Y, -Z),
        face(80 * X + 50 * Y, across, ("ground", "slider")),
        face(80 * X + 30 * Y, -across, ("ground", "slider")),
        face(80 * X + 40 * Y + 9 * Z, Z, ("ground", "slider")),
        pin(80 * X + 40 * Y, rail, 4.0, ("slider", "plunger")),
        roller(90 * X, across, Z, parts=("plunger", "ground")),
    ]


MEETING = 30 * X + 20 * Y + 10 * Z
ARMS = [Z, unit(X + 2 * Y), unit(X - Z), unit(3 * Y + Z), unit(X + Y + Z)]


def spherical_chain():
    """Pins that all meet in one point, a ball there, and two bearings of one shaft."""
    parts = [f"p{k}" for k in range(len(ARMS) + 1)]
    pins = [pin(MEETING + 40 * a, a, parts=pair) for a, pair in zip(ARMS, pairwise(parts), strict=True)]
    return [*pins, ball(MEETING, parts=("p0", "p5")), pin(MEETING - 30 * Z, -Z, 5.0, ("p1", "p0"))]


def axes_of(contacts):
    """All directions that matter: z of frames, axes and normals of surfaces."""
    frames = [pose[:3, 2] for contact in contacts if contact.state != "o" for pose in contact.frames]
    surfaces = [getattr(s, "normal", getattr(s, "axis", None)) for contact in contacts for s in contact.surfaces]
    return np.array(frames + [s for s in surfaces if s is not None])


def assert_consistent(contacts, angle):
    """Every pair of directions near to parallel or perpendicular is exactly so."""
    z = axes_of(contacts)
    sines = np.linalg.norm(np.cross(z[:, None], z[None]), axis=-1)
    cosines = np.abs(z @ z.T)
    assert np.all(sines[sines < angle] == 0.0)
    assert np.all(cosines[cosines < angle] <= 2e-16)
    twins = sines == 0.0
    aligned = z[:, None] * np.sign(np.sum(z[:, None] * z[None], axis=-1))[..., None]
    assert np.all(aligned[twins] == np.broadcast_to(z[None], aligned.shape)[twins])  # the same floats


@pytest.mark.parametrize("mechanism", [slider_crank, spherical_chain])
def test_exact_input_is_left_alone(mechanism):
    contacts = placed(mechanism(), np.random.default_rng(1))
    regular = regularise(contacts, Noise.of(contacts))
    assert regular.angle < 1e-15
    assert regular.length < 1e-15 * 300  # the coordinates are up to 300
    for before, after in zip(contacts, regular.contacts, strict=True):
        np.testing.assert_allclose(after.frames[:, :3, :3], before.frames[:, :3, :3], atol=1e-15)
        np.testing.assert_allclose(after.frames[:, :3, 3], before.frames[:, :3, 3], atol=3e-13)


@pytest.mark.parametrize("mechanism", [slider_crank, spherical_chain])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("seed", range(4))
def test_noise_becomes_consistent(mechanism, scale, seed):
    rng = np.random.default_rng(seed)
    contacts = placed(mechanism(), rng, scale, READER, SIZE)
    noise = Noise.of(contacts)
    regular = regularise(contacts, noise)
    assert 1e-9 < regular.angle < 4 * READER
    assert 0.0 < regular.length < 4 * READER * 3 * SIZE * scale
    assert_consistent(regular.contacts, 10 * noise.angle)
    for contact in regular.contacts:
        rotation = contact.frames[:, :3, :3]
        np.testing.assert_allclose(
            rotation @ rotation.swapaxes(1, 2), np.broadcast_to(np.eye(3), rotation.shape), atol=1e-15
        )


@pytest.mark.parametrize("seed", range(4))
def test_axes_meet_and_coincide_exactly(seed):
    contacts = placed(spherical_chain(), np.random.default_rng(seed), noise=READER)
    regular = regularise(contacts, Noise.of(contacts)).contacts
    meeting = regular[len(ARMS)].frames[0, :3, 3]
    lines = [contact.frames[0] for contact in regular[: len(ARMS)] + regular[len(ARMS) + 1 :]]
    lines += [pose for c in regular if c.state == "e" for pose in align_to_frames(c.surfaces)]
    for line in lines:
        # rounding of positions a few hundred long
        assert np.linalg.norm(np.cross(meeting - line[:3, 3], line[:3, 2])) < 3e-13
    assert all(np.array_equal(sphere.centre, meeting) for sphere in regular[len(ARMS)].surfaces)


def align_to_frames(surfaces):
    for cylinder in surfaces:
        pose = np.eye(4)
        pose[:3, 2], pose[:3, 3] = cylinder.axis, cylinder.point
        yield pose


def test_bores_of_one_hinge_are_coaxial_across_parts_and_pairs():
    chain = [pin(k * 20 * Z, Z, 3.0 + k, (f"p{k}", f"p{k + 1}")) for k in range(4)]
    contacts = placed(chain, np.random.default_rng(0), noise=READER)
    assert max(off_axis(c.frames[0], contacts[0].frames[0]) for c in contacts) > 1e-6
    regular = regularise(contacts, Noise.of(contacts)).contacts
    assert max(off_axis(c.frames[0], regular[0].frames[0]) for c in regular) < 1e-13


def off_axis(pose, line):
    return np.linalg.norm(np.cross(pose[:3, 3] - line[:3, 3], line[:3, 2]))


@pytest.mark.parametrize("tilt", [1e-5, 1e-4])
def test_tilt_of_the_design_is_kept(tilt):
    axis = np.cos(tilt) * Z + np.sin(tilt) * X
    contacts = [
        pin(ORIGIN, Z),
        pin(60 * X, axis, parts=("q", "r")),
        face(9 * Y, np.cos(tilt) * X - np.sin(tilt) * Z + tilt * Y),
    ]
    regular = regularise(contacts, Noise.of(contacts)).contacts
    z = [contact.frames[0, :3, 2] for contact in regular]
    # the face is perpendicular to the second axis and off the first by the tilt: only noise was looked for
    assert np.linalg.norm(np.cross(z[0], z[1])) == pytest.approx(tilt, rel=1e-6)
    assert abs(z[0] @ z[2]) == pytest.approx(tilt, rel=1e-6)
    assert abs(z[1] @ z[2]) < 2e-16


def test_offset_of_the_design_is_kept():
    contacts = [pin(ORIGIN, Z), pin(50 * Z + 1e-3 * X, Z, parts=("q", "r")), pin(99 * X, Y, parts=("q", "r"))]
    regular = regularise(contacts, Noise.of(contacts))
    offset = regular.contacts[1].frames[0, :3, 3] - regular.contacts[0].frames[0, :3, 3]
    np.testing.assert_allclose(offset, [1e-3, 0, 50], atol=1e-13)
    assert regular.length < 1e-13


def test_chain_of_small_steps_is_no_noise():
    angles = 0.9e-6 * np.arange(12)
    fan = np.stack([np.sin(angles), 0 * angles, np.cos(angles)], axis=1)
    np.testing.assert_allclose(align_directions(fan, 1e-6), fan, atol=1e-15)
    stairs = np.stack([0.9e-4 * np.arange(12), np.zeros(12), np.zeros(12)], axis=1)
    centres = align_positions(np.empty((0, 3)), np.empty((0, 3)), stairs, 1e-4)[1]
    np.testing.assert_allclose(centres, stairs, atol=1e-15)
    crossing = np.stack([np.arange(12.0), np.arange(12.0), 0.9e-4 * np.arange(12)], axis=1)
    lines = align_positions(crossing, np.tile([X, Y], (6, 1)), np.empty((0, 3)), 1e-4)[0]
    np.testing.assert_allclose(lines, crossing, atol=1e-14)
    pair = align_positions(crossing[:2], np.array([X, Y]), np.empty((0, 3)), 1e-4)[0]
    assert pair[0, 2] == pytest.approx(0.45e-4) == pair[1, 2]


@pytest.mark.parametrize("noise", [1e-6, 1e-11])
def test_nothing_moves_farther_than_the_noise_twice(noise):
    """Random bundles of directions around the threshold: parallel costs one noise at most, perpendicular another."""
    rng = np.random.default_rng(0)
    for _ in range(50):
        bundle = np.concatenate([unit_rows(axis + rng.normal(size=(5, 3)) * 0.7 * noise) for axis in np.eye(3)])
        moved_by = np.linalg.norm(align_directions(bundle, noise) - bundle, axis=1)
        assert moved_by.max() <= 2 * noise


@pytest.mark.parametrize("noise", [1e-6, 1e-8, 1e-11])
def test_directions_within_the_noise_become_one_and_others_stay(noise):
    """Also where the cosine of the angle is 1 to rounding."""
    rng = np.random.default_rng(1)
    axis = unit_rows(rng.normal(size=(1, 3)))
    near = unit_rows(axis + 0.2 * noise * rng.uniform(-1, 1, (6, 3)))
    far = unit_rows(axis + 20 * noise * np.array([[1.0, -2.0, 0.5]]))
    aligned = align_directions(np.concatenate([near, far]), noise)
    assert np.array_equal(aligned[:6], np.tile(aligned[0], (6, 1)))
    np.testing.assert_allclose(aligned[6:], far, atol=1e-15)


def unit_rows(rows):
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


@pytest.mark.parametrize("mechanism", [slider_crank, spherical_chain])
def test_idempotent(mechanism):
    contacts = placed(mechanism(), np.random.default_rng(3), noise=READER)
    once = regularise(contacts, Noise.of(contacts))
    twice = regularise(once.contacts, Noise.of(contacts))
    assert twice.angle < 4e-16
    assert twice.length < 3e-13  # rounding of positions a few hundred long


@pytest.mark.parametrize("mechanism", [slider_crank, spherical_chain])
def test_moves_and_scales_with_the_input(mechanism):
    contacts = placed(mechanism(), np.random.default_rng(4), noise=READER)
    place, scale = displacement(np.random.default_rng(5), 2.0, SIZE), 1e3
    names = {part for contact in contacts for part in contact.parts}
    there = [moved(contact, dict.fromkeys(names, place), scale) for contact in contacts]
    here = regularise(contacts, Noise(1e-6, 1e-4)).contacts
    other = regularise(there, Noise(1e-6, 1e-4 * scale)).contacts
    for a, b in zip(here, other, strict=True):
        for pose, image in zip(a.frames, b.frames, strict=True):
            wanted = place @ pose
            # rounding of the placement itself, not the 1e-7 that was corrected
            if a.state != "o":
                np.testing.assert_allclose(image[:3, 2], wanted[:3, 2], atol=3e-15)
            np.testing.assert_allclose(image[:3, 3] / scale, wanted[:3, 3], atol=3e-12)


def test_order_of_the_contacts_does_not_matter():
    contacts = placed(slider_crank(), np.random.default_rng(6), noise=READER)
    noise = Noise.of(contacts)
    forwards = regularise(contacts, noise).contacts
    backwards = regularise(contacts[::-1], noise).contacts[::-1]
    for a, b in zip(forwards, backwards, strict=True):
        np.testing.assert_allclose(a.frames[:, :3, 2], b.frames[:, :3, 2], atol=1e-15)


def test_clearance_of_a_fit_stays_between_its_surfaces():
    hole, shaft = Cylinder(ORIGIN, Z, 3.02, -1), Cylinder(np.array([0.01, 0, 0]), Z, 3.0, 1)
    contact = regularise([touching(("p", "q"), "e", hole, shaft), pin(90 * X, Y)], Noise(1e-6, 1e-4)).contacts[0]
    np.testing.assert_allclose(contact.surfaces[1].point - contact.surfaces[0].point, [0.01, 0, 0], atol=1e-15)


def test_heights_of_faces_and_radii_stay():
    contacts = placed(slider_crank(), np.random.default_rng(7), noise=READER)
    regular = regularise(contacts, Noise.of(contacts)).contacts
    for before, after in zip(contacts, regular, strict=True):
        for s, t in zip(before.surfaces, after.surfaces, strict=True):
            assert getattr(s, "radius", 0) == getattr(t, "radius", 0)
            if s.kind == "plane":
                np.testing.assert_array_equal(s.point, t.point)


def test_centre_on_an_axis_ends_on_it():
    off = Sphere(np.array([2e-6, 0, 50.0]), 4.0, 1)
    contacts = [pin(ORIGIN, Z), touching(("p", "q"), "o", Sphere(off.centre, 4.0, -1), off), pin(99 * X, Y)]
    regular = regularise(contacts, Noise.of(contacts))
    assert off_axis(regular.contacts[1].frames[0], regular.contacts[0].frames[0]) < 1e-14
    assert regular.length == pytest.approx(1e-6, rel=1e-6)  # each gives half


def test_nothing_to_do():
    assert regularise([], Noise(1e-6, 1e-4)).contacts == ()
    frames, angle, length = align(["I"], np.eye(4)[None], Noise(1e-6, 1e-4))
    assert np.array_equal(frames[0], np.eye(4)) and angle == length == 0.0
