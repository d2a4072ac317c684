"""The shipped assemblies, from STEP: exactly the contacts that they were drawn with."""

from collections import Counter
from importlib import resources

import numpy as np
import pytest

from jaxkin.contacts.contact import Contacts
from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.part import Part, size
from jaxkin.io.step import read_step

HINGE = ["a", "e"]
EXPECTED = {
    "fourbar": {
        ("crank", "ground"): HINGE,
        ("coupler", "crank"): HINGE,
        ("coupler", "rocker"): HINGE,
        ("ground", "rocker"): HINGE,
    },
    "slider_crank": {
        ("crank", "ground"): HINGE,
        ("crank", "rod"): HINGE,
        ("rod", "slider"): HINGE,
        ("ground", "slider"): ["a", "a", "a"],  # the bottom and the two rails
    },
    "cam": {  # Table 4 of the paper
        ("cam", "follower"): ["b"],
        ("cam", "frame"): HINGE,
        ("follower", "frame"): HINGE,
    },
}


@pytest.fixture(scope="module", params=list(EXPECTED))
def assembly(request):
    path = resources.files("jaxkin.examples") / f"{request.param}.step"
    parts, _ = read_step(str(path))
    return request.param, parts, find_contacts(parts)


def between_parts(contacts):
    found = {}
    for contact in contacts:
        found.setdefault(tuple(sorted(contact.parts)), []).append(contact.state)
    return {parts: sorted(states) for parts, states in found.items()}


@pytest.mark.long
def test_the_contacts_are_those_of_the_drawing(assembly):
    name, parts, contacts = assembly
    assert between_parts(contacts) == EXPECTED[name]
    assert not contacts.near_misses and not contacts.notes
    assert max(contact.misfit for contact in contacts) < 1e-11 * size(parts)  # their files have twelve decimals


def test_surface_1_belongs_to_part_1(assembly):
    _, parts, contacts = assembly
    faces = {(part.name, face.name): face for part in parts for face in part.faces}
    for contact in contacts:
        for part, face, surface in zip(contact.parts, contact.faces, contact.surfaces, strict=True):
            assert faces[part, face].surface is surface
    kinds = Counter(tuple(surface.kind for surface in contact.surfaces) for contact in contacts if contact.state == "b")
    assert set(kinds) <= {("plane", "cylinder")}


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_unit_does_not_matter(assembly, solids, scale):
    _, parts, contacts = assembly
    scaled = []
    for part in parts:
        faces = tuple(solids.moved(face, np.eye(4), scale) for face in part.faces)
        scaled.append(Part(part.name, faces, part.triangles * scale))
    again = find_contacts(tuple(scaled))
    assert [(c.parts, c.faces, c.state, c.region) for c in again] == [
        (c.parts, c.faces, c.state, c.region) for c in contacts
    ]
    for one, other in zip(contacts, again, strict=True):
        np.testing.assert_allclose(other.frames[:, :3, 3], scale * one.frames[:, :3, 3], atol=1e-9 * scale)
        np.testing.assert_allclose(other.frames[:, :3, :3], one.frames[:, :3, :3], atol=1e-9)


def test_a_part_moved_off_loses_its_contacts(assembly, solids):
    _, parts, contacts = assembly
    *others, last = parts
    away = np.eye(4)
    away[:3, 3] = size(parts)
    moved = solids.part(last.name, *(solids.moved(face, away) for face in last.faces))
    left = find_contacts((*others, moved))
    assert [contact.faces for contact in left] == [c.faces for c in contacts if last.name not in c.parts]


def test_the_report_names_everything(assembly):
    _, _, contacts = assembly
    lines = str(contacts).splitlines()
    assert lines[0] == f"{len(contacts)} contacts"
    for contact, line in zip(contacts, lines[2:], strict=True):
        for word in (*contact.parts, *contact.faces, f"({contact.state})", contact.region):
            assert word in line
            assert word in str(contact)


def test_the_report_of_misses_and_refusals(solids):
    pair = next(pair for pair in solids.pairs if pair.letter == "d")
    away = np.eye(4)
    away[2, 3] = 2e-3
    one, two = solids.part("table", pair.face1), solids.part("ball", solids.moved(pair.face2, away))
    torus = Part("ring", (), two.triangles, notes=("face 3: torus, not one of the four surfaces",))
    contacts = find_contacts((one, two, torus))
    assert str(contacts).splitlines() == [
        "no contacts",
        "1 near miss",
        "  nearly (d) table plane - ball sphere: ball on plane: a gap of 0.002: close it, or give length=0.0021",
        "1 note",
        "  ring: face 3: torus, not one of the four surfaces",
    ]
    assert len(find_contacts((one, solids.part("ball", solids.moved(pair.face2, away))), length=0.0021)) == 1


def test_fewer_than_two_parts_have_no_contacts(solids):
    face = solids.pairs[0].face1
    assert isinstance(find_contacts(()), Contacts)
    assert len(find_contacts((solids.part("one", face),))) == 0
