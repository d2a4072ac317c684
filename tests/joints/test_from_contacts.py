"""Joints from contacts: names, order of parts, signs, sources; and the shipped assemblies end to end."""

import numpy as np
import pytest

import jaxkin.examples
from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.pose import inverse, unit
from jaxkin.geometry.surfaces import Cylinder, Plane
from jaxkin.io.step import read_step
from jaxkin.joints.from_contacts import joints_from_contacts
from jaxkin.joints.screws import chain, freedoms
from joints.touching import X, Y, Z, ball, face, moved, pin, placed, roller, tip

PARTS = ("ground", "crank", "rod")
CRANK_FIRST = ("crank", "ground")


def hinge(parts=("ground", "crank"), at=(0, 0, 0), axis=Z):
    return [face(np.asarray(at) + 4 * axis, axis, parts), pin(at, axis, parts=parts)]


def test_contacts_of_two_parts_become_one_joint():
    found = joints_from_contacts(hinge(), PARTS)
    (joint,) = found.joints
    assert (joint.name, joint.parts, joint.kind, joint.coordinates) == ("ground-crank", PARTS[:2], "revolute", ("phi",))
    assert np.array_equal(joint.frames_1, joint.frames_2)
    assert joint.frames_1.dtype == np.float64
    assert found.notes == ()


def test_one_joint_a_contact():
    contacts = [*hinge(), face((0, 0, -4), -Z, CRANK_FIRST), *hinge(("crank", "rod"), (30, 0, 0))[1:]]
    joints = joints_from_contacts(contacts, PARTS, combine=False).joints
    assert [joint.name for joint in joints] == ["ground-crank:a", "ground-crank:e", "ground-crank:a2", "crank-rod"]
    assert [joint.kind for joint in joints] == ["contact a", "contact e", "contact a", "contact e"]
    assert [joint.movements for joint in joints] == [("T_xy_phi",), ("T_z_phi",), ("T_xy_phi",), ("T_z_phi",)]
    assert all(joint.parts == ("ground", "crank") for joint in joints[:3])


def test_joints_know_their_contacts():
    contacts = [*hinge(("crank", "rod"), (30, 0, 0)), *hinge()]
    found = joints_from_contacts(contacts, PARTS)
    assert {name: list(c) for name, c in found.contacts.items()} == {
        "ground-crank": contacts[2:],
        "crank-rod": contacts[:2],
    }
    found = joints_from_contacts(contacts, PARTS, combine=False)
    assert found.contacts["crank-rod:e"] == (contacts[1],)


def test_order_of_the_assembly_names_the_joint_and_its_parts():
    for parts in (("ground", "crank"), CRANK_FIRST):
        (joint,) = joints_from_contacts(hinge(CRANK_FIRST), parts).joints
        assert (joint.name, joint.parts) == ("-".join(parts), parts)


def test_part_1_of_a_contact_of_several_frames_owns_surface_1():
    rolling = roller((0, 0, 0), Y, Z, parts=CRANK_FIRST)
    (joint,) = joints_from_contacts([rolling], PARTS).joints
    assert (joint.name, joint.parts, joint.kind) == ("ground-crank", CRANK_FIRST, "contact b")


def test_what_is_no_lower_pair_stays_parallel_joints():
    slot = [
        roller((0, -3, 0), Y, Z, parts=PARTS[:2]),
        roller((0, 3, 0), -Y, Z, parts=PARTS[:2]),
        face((0, 0, 0), Z, PARTS[:2]),
    ]
    found = joints_from_contacts(slot, PARTS)
    assert [joint.name for joint in found.joints] == ["ground-crank:b", "ground-crank:b2", "ground-crank:a"]
    assert "ground-crank" in found.notes[0]


def test_bearings_that_nearly_agree_are_noted():
    tilted = np.cos(1e-4) * Z + np.sin(1e-4) * X
    contacts = [pin((0, 0, 0), Z, parts=PARTS[:2]), pin((0, 0, 60), tilted, parts=PARTS[:2])]
    found = joints_from_contacts(contacts, PARTS)
    assert found.joints[0].kind == "fixed"
    assert "ground-crank" in found.notes[0] and "(e), (e)" in found.notes[0]


def test_unknown_part():
    with pytest.raises(ValueError, match=r"'crank'.*'ground', 'rod'"):
        joints_from_contacts(hinge(), ("ground", "rod"))


def test_no_contacts():
    assert joints_from_contacts([], PARTS).joints == ()


@pytest.mark.parametrize("axis", [Z, -Z, Y, -Y, X, -X, unit(X - Y), unit(X + Y - 1e-3 * Z), unit(X - 1e-9 * Z)])
def test_axes_point_forwards(axis):
    for combine in (True, False):
        for joint in joints_from_contacts(hinge(axis=axis), PARTS, combine=combine).joints:
            for pose in joint.frames_1:
                z = pose[:3, 2]
                assert next(c for c in z[::-1] if abs(c) > 1e-6) > 0
                np.testing.assert_allclose(np.cross(z, axis), 0.0, atol=1e-15)
                assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("seed", range(5))
def test_hinge_turns_the_same_way_with_and_without_combining(seed):
    """Closing the loop of the separate contacts (Eq. 1) gives back the angle of the hinge, sign and all."""
    contacts = placed(hinge(), np.random.default_rng(seed))
    (joint,) = joints_from_contacts(contacts, PARTS).joints
    displaced = chain(joint.movements, joint.frames_1, np.array([0.4]))[0]
    face_joint, pin_joint = joints_from_contacts(contacts, PARTS, combine=False).joints
    for single, angle in ((face_joint, 2), (pin_joint, 1)):
        local = inverse(single.frames_1[0]) @ displaced @ single.frames_1[0]
        q = np.zeros(freedoms(single.movements))
        q[angle] = np.arctan2(local[1, 0], local[0, 0])
        q[:angle] = local[:angle, 3] if angle == 2 else local[2, 3]
        np.testing.assert_allclose(chain(single.movements, single.frames_1, q)[0], displaced, atol=3e-13)
        assert q[angle] == pytest.approx(0.4, abs=1e-14)


def test_origin_is_at_the_contact():
    (joint,) = joints_from_contacts([pin((7, -4, 11), Z, parts=PARTS[:2])], PARTS).joints
    np.testing.assert_allclose(joint.frames_1[0, :3, 3], [7, -4, 11], atol=1e-14)


def test_axes_that_belong_to_no_single_contact_are_aligned_too():
    """Two rails of slanted faces along one direction: neither direction is the normal of a face."""
    contacts = []
    for k, (part, angles) in enumerate((("crank", (20, 75)), ("rod", (40, 110)))):
        for degrees in angles:
            normal = np.cos(np.radians(degrees)) * X + np.sin(np.radians(degrees)) * Y
            contacts.append(face((30 * k, degrees, 0), normal, ("ground", part)))
    contacts = placed(contacts, np.random.default_rng(2), noise=2e-7)
    first, second = joints_from_contacts(contacts, PARTS).joints
    assert first.kind == second.kind == "prismatic"
    assert np.array_equal(first.frames_1[0, :3, 2], second.frames_1[0, :3, 2])


def test_asymmetric_contact_moves_surface_2_of_its_part_2():
    rolling = placed([roller((0, 0, 0), Y, Z, parts=CRANK_FIRST)], np.random.default_rng(1))[0]
    (joint,) = joints_from_contacts([rolling], PARTS).joints
    there = chain(joint.movements, joint.frames_1, np.array([3.0, -2.0, 0.3, 0.5]))[0]
    cylinder, plane = rolling.surfaces[1].moved(there), rolling.surfaces[0]
    assert isinstance(cylinder, Cylinder) and isinstance(plane, Plane)
    assert plane.distance(cylinder.point) == pytest.approx(cylinder.radius, abs=1e-12)
    assert plane.normal @ cylinder.axis == pytest.approx(0.0, abs=1e-15)


@pytest.fixture(scope="module", params=["fourbar", "slider_crank", "cam"])
def shipped(request):
    parts, _ = read_step(f"{jaxkin.examples.__path__[0]}/{request.param}.step")
    return request.param, [part.name for part in parts], find_contacts(parts)


KINDS = {
    "fourbar": {
        "ground-crank": "revolute",
        "ground-rocker": "revolute",
        "crank-coupler": "revolute",
        "coupler-rocker": "revolute",
    },
    "slider_crank": {
        "ground-crank": "revolute",
        "ground-slider": "prismatic",
        "crank-rod": "revolute",
        "rod-slider": "revolute",
    },
    "cam": {"cam-follower": "contact b", "cam-frame": "revolute", "follower-frame": "prismatic"},
}


@pytest.mark.long
def test_shipped_assemblies(shipped):
    name, parts, contacts = shipped
    found = joints_from_contacts(contacts, parts)
    assert {joint.name: joint.kind for joint in found.joints} == KINDS[name]
    assert found.notes == ()
    assert 0.0 < found.angle < 2e-7  # the reader's float32
    assert 0.0 < found.length < 1e-5  # mm, on 100 mm


@pytest.mark.parametrize("combine", [True, False])
def test_axes_of_shipped_assemblies_are_exact(shipped, combine):
    _, parts, contacts = shipped
    joints = joints_from_contacts(contacts, parts, combine=combine).joints
    z = np.concatenate([joint.frames_1[:, :3, 2] for joint in joints])
    sines = np.linalg.norm(np.cross(z[:, None], z[None]), axis=-1)
    # these mechanisms are planar: all their axes lie across or along one direction, or one of two across each other
    parallel = sines < 1e-3
    assert all(np.array_equal(z[i], z[j]) for i, j in np.argwhere(parallel))
    assert np.all(np.abs(z @ z.T)[~parallel] <= 2e-16)
    assert (~parallel).any() == ("rod" in parts or "cam" in parts)


def test_mobile_pair_of_every_kind_in_one_assembly():
    """All lower pairs but the screw, each between its own two parts, in one arbitrary pose, with the reader's noise."""
    parts = ("a", "b", "c", "d", "e", "f", "g")
    given = {
        "revolute": [ball((90, 0, 0), parts=parts[:2]), ball((90, 50, 0), parts=parts[:2])],
        "prismatic": [face((9, 9, 9), X, parts[1:3]), face((9, 9, 9), X + Y, parts[1:3])],
        "cylindrical": [pin((40, 0, 0), unit(X + Z), parts=parts[2:4])],
        "planar": [tip(p, Z, parts=parts[3:5]) for p in ((0, 0, 0), (70, 0, 0), (0, 50, 0))],
        "spherical": [ball((5, 6, 7), parts=parts[4:6])],
        "fixed": [face((0, 0, 0), n, parts[5:]) for n in (X, Y, unit(X + Y + Z))],
    }
    contacts = placed([c for group in given.values() for c in group], np.random.default_rng(3), noise=1e-7)
    joints = joints_from_contacts(contacts, parts).joints
    assert [joint.kind for joint in joints] == list(given)


def test_unit_of_the_file_changes_no_joint(shipped):
    _, parts, contacts = shipped
    here = joints_from_contacts(contacts, parts).joints
    poses = dict.fromkeys(parts, np.eye(4))
    there = joints_from_contacts([moved(contact, poses, 1e3) for contact in contacts], parts).joints
    for a, b in zip(here, there, strict=True):
        assert (a.name, a.kind, a.movements) == (b.name, b.kind, b.movements)
        np.testing.assert_allclose(a.frames_1[:, :3, 2], b.frames_1[:, :3, 2], atol=1e-14)
