"""Detection on pairs of faces: every state in any placement and unit, and no contact where there is a misfit."""

import numpy as np
import pytest

from jaxkin.contacts.detect import find_contacts
from jaxkin.contacts.rulings import ruling
from jaxkin.contacts.states import find_state
from jaxkin.geometry.part import Face
from jaxkin.geometry.pose import perpendicular, rotation, unit
from jaxkin.geometry.surfaces import Cone, Cylinder, Plane

X, Y, Z = np.eye(3)
TURN = (-np.pi, np.pi)


def detect(solids, face1, face2, **options):
    return find_contacts((solids.part("one", face1), solids.part("two", face2)), **options)


def translated(vector):
    pose = np.eye(4)
    pose[:3, 3] = vector
    return pose


def turned(axis, angle, point):
    pose = np.eye(4)
    pose[:3, :3] = rotation(axis, angle)
    pose[:3, 3] = point - pose[:3, :3] @ point
    return pose


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_every_state_is_found_in_any_placement_and_unit(pair, solids, scale):
    rng = np.random.default_rng([ord(pair.letter), round(1e3 * scale)])
    placed = solids.random_displacement(rng)
    face1, face2 = (solids.moved(face, placed, scale) for face in (pair.face1, pair.face2))
    contacts = detect(solids, face1, face2)
    assert [(c.state, c.region, c.parts) for c in contacts] == [(pair.letter, pair.region, ("one", "two"))]
    assert not contacts.near_misses
    (contact,) = contacts
    assert contact.misfit < 1e-9 * scale
    assert contact.frames.shape == (len(find_state(pair.letter, pair.region).movements), 4, 4)
    if pair.region in ("line", "point"):
        assert abs(face1.surface.distance(contact.centre)) < 1e-9 * scale
        assert abs(face2.surface.distance(contact.centre)) < 1e-9 * scale
    _check_table_1(contact, scale)


def _check_table_1(contact, scale):
    """The constraints of Table 1, read from the paper's symbols: z parallel, O on."""
    s1, s2 = contact.surfaces

    def axis_of(surface):
        return surface.apex if surface.kind == "cone" else surface.point, surface.axis

    def parallel(direction):
        assert abs(abs(z @ unit(direction)) - 1) < 1e-12

    def on_line(point, direction):
        assert np.linalg.norm(np.cross(origin - point, direction)) < 1e-9 * scale

    for (z_symbol, o_symbol), frame in zip(
        find_state(contact.state, contact.region).frames, contact.frames, strict=True
    ):
        z, origin = frame[:3, 2], frame[:3, 3]
        np.testing.assert_allclose(frame[:3, :3] @ frame[:3, :3].T, np.eye(3), atol=1e-12)
        assert np.linalg.det(frame[:3, :3]) > 0
        match z_symbol:
            case "n1":
                parallel(s1.normal)
            case "a1":
                parallel(s1.axis)
            case "a2":
                parallel(s2.axis)
            case "m" if contact.state != "p":
                parallel(s1.normals(contact.centre))
            case "m":
                parallel(s2.centre - s1.centre)
            case "l":
                on_line(s1.apex, z), on_line(s2.apex, z)
            case "v1 - p":
                parallel(s1.apex - contact.centre)
        match o_symbol:
            case "f1":
                assert abs(s1.distance(origin)) < 1e-9 * scale
            case "a1":
                on_line(*axis_of(s1))
            case "a2":
                on_line(*axis_of(s2))
            case "c1":
                assert np.linalg.norm(origin - s1.centre) < 1e-9 * scale
            case "c2":
                assert np.linalg.norm(origin - s2.centre) < 1e-9 * scale
            case "p" | "l":
                assert abs(s1.distance(origin)) < 1e-9 * scale and abs(s2.distance(origin)) < 1e-9 * scale


def test_the_order_of_parts_does_not_matter(pair, solids):
    forwards, backwards = (detect(solids, *faces) for faces in ((pair.face1, pair.face2), (pair.face2, pair.face1)))
    assert [(c.state, c.region) for c in backwards] == [(c.state, c.region) for c in forwards]
    if pair.face1.surface.kind != pair.face2.surface.kind:  # surface 1 of Table 1 stays surface 1
        assert backwards[0].parts == ("two", "one") and backwards[0].faces == forwards[0].faces
        np.testing.assert_allclose(backwards[0].frames, forwards[0].frames, atol=1e-12)


def test_a_gap_is_no_contact_but_a_report_of_its_size(pair, solids):
    """Apart by 5e-4 of the size along the common normal; a fit is forced off its axis instead."""
    state = find_state(pair.letter, pair.region)
    touch = state.touch(pair.face1.surface, pair.face2.surface, np.zeros(3))
    size = np.linalg.norm(np.ptp(np.concatenate([pair.face1.box, pair.face2.box]), axis=0))
    fit = state.region in ("surface", "circle") and state.letter != "a"
    away = touch.normal if not fit else perpendicular(touch.direction) if np.any(touch.direction) else X
    contacts = detect(solids, pair.face1, solids.moved(pair.face2, translated(5e-4 * size * away)))
    assert len(contacts) == 0
    (miss,) = contacts.near_misses
    assert (miss.state, miss.region, miss.rim) == (pair.letter, pair.region, False)
    across = np.cos(pair.face1.surface.half_angle) if pair.letter == "k" else 1.0
    assert miss.gap == pytest.approx(5e-4 * size * across, rel=0.02)
    assert ("off centre" if touch.clearance is not None else "a gap of") in miss.reason


def test_an_overlap_is_no_contact_but_a_report_of_its_size(pair, solids):
    state = find_state(pair.letter, pair.region)
    touch = state.touch(pair.face1.surface, pair.face2.surface, np.zeros(3))
    size = np.linalg.norm(np.ptp(np.concatenate([pair.face1.box, pair.face2.box]), axis=0))
    if not np.any(touch.normal):
        return  # a fit has no normal to move along
    contacts = detect(solids, pair.face1, solids.moved(pair.face2, translated(-5e-4 * size * touch.normal)))
    assert len(contacts) == 0
    (miss,) = contacts.near_misses
    assert miss.state == pair.letter and miss.gap == pytest.approx(-5e-4 * size, rel=0.02)
    assert "overlap by" in miss.reason


@pytest.mark.parametrize("angle", [3e-4, 0.01])
def test_a_tilt_is_no_contact_but_a_report_of_its_size(pair, solids, angle):
    state = find_state(pair.letter, pair.region)
    if state.region in ("point", "circle") or pair.letter == "o":
        return  # nothing has to be parallel
    (contact,) = detect(solids, pair.face1, pair.face2)
    touch = state.touch(*contact.surfaces, contact.centre)
    along = touch.normal if pair.letter == "a" else touch.direction
    axis = np.cross(touch.normal, along) if state.region == "line" else perpendicular(along)
    contacts = detect(solids, pair.face1, solids.moved(pair.face2, turned(axis, angle, contact.centre)))
    assert len(contacts) == 0
    (miss,) = contacts.near_misses
    assert (miss.state, miss.region) == (pair.letter, pair.region)
    assert miss.tilt == pytest.approx(angle, rel=1e-3)
    assert f"tilted by {angle:.3g} rad" in miss.reason


def test_what_is_far_apart_is_not_mentioned(pair, solids):
    size = np.linalg.norm(np.ptp(np.concatenate([pair.face1.box, pair.face2.box]), axis=0))
    contacts = detect(solids, pair.face1, solids.moved(pair.face2, translated([0, 0, 3 * size])))
    assert len(contacts) == 0 and not contacts.near_misses


def test_degenerate_triangles_change_nothing(pair, solids):
    """Tessellations hold triangles without area: two corners at one point, or all three on a line."""

    def spoiled(face):
        points, lines = face.triangles[::5].copy(), face.triangles[::7].copy()
        points[:, 1] = points[:, 0]
        lines[:, 2] = (lines[:, 0] + lines[:, 1]) / 2
        return Face(face.name, face.surface, np.concatenate([face.triangles, points, lines, points[:1, [0, 0, 0]]]))

    contacts = detect(solids, spoiled(pair.face1), spoiled(pair.face2))
    assert [(c.state, c.region) for c in contacts] == [(pair.letter, pair.region)] and not contacts.near_misses
    away = solids.moved(spoiled(pair.face2), translated([0.0, 0.0, 5e-3]))
    detect(solids, spoiled(pair.face1), away)  # whatever is near, nothing divides by zero


def strips(solids):
    """Two flat faces that share a strip of 0.01 times 3."""
    table = solids.patch(Plane(np.zeros(3), Z), (-1.5, 1.5), (-2, 0), towards=X)
    return table, solids.patch(Plane(np.zeros(3), -Z), (-1.5, 1.5), (-2, 0.01), towards=X)  # y is upside down


def short_line(solids):
    """A roller whose end, 0.01 long, lies on a table."""
    table = solids.patch(Plane(np.zeros(3), Z), (-1, 1), (-1, 1))
    return table, solids.patch(Cylinder(0.5 * Z, Y, 0.5, 1), TURN, (0.99, 2.5))


@pytest.mark.parametrize("drawn", [strips, short_line])
def test_a_larger_length_loses_no_contact(solids, drawn):
    """Narrow regions are more than noise where the faces touch exactly, whatever is allowed elsewhere."""
    faces = drawn(solids)
    for length in (None, 1e-3, 3e-3, 1e-2, 0.1):
        found = detect(solids, *faces, length=length)
        assert len(found) == 1, length
        assert found[0].misfit < 1e-12  # rounding


@pytest.mark.parametrize("length", [None, 0.01])
def test_a_cone_whose_ruling_stands_on_a_plane_is_no_contact_along_it(solids, length):
    """The projection of such a ruling onto the plane has no direction."""
    table = solids.patch(Plane(np.zeros(3), Z), (-1, 1), (-1, 1))
    cone = Cone(0.5 * Z, rotation(Y, 0.5) @ -Z, 0.5, 1)
    assert not np.any(np.cross(ruling(cone, -Z), Z).round(12))
    assert not detect(solids, table, solids.patch(cone, TURN, (0.1, 0.6)), length=length)
