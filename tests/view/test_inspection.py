"""The picture of an assembly: regions of contacts where they are, and nothing half written."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import jaxkin as jk
from jaxkin.assembly.assembly import Assembly
from jaxkin.contacts.tolerance import outline_length
from jaxkin.examples import EXAMPLES, path
from jaxkin.io.step import read_step
from jaxkin.view.callouts import COLORS
from jaxkin.view.gallery import PANEL, draw_gallery
from jaxkin.view.inspection import draw_inspection
from jaxkin.view.regions import region_of
from jaxkin.view.sheet import FOOT, GAP, HEAD, MARGIN, Sheet
from reference.round_parts import assembly, block, part, pin, ring

DATA = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def states():
    parts, unit = read_step(DATA / "contacts" / "data" / "states.step")
    return Assembly(parts, unit, "states.step")


@pytest.mark.long
def test_regions_lie_on_both_surfaces(states):
    """Areas by the corners of their triangles: between these lie chords."""
    faces = {(part.name, face.name): face for part in states.parts for face in part.faces}
    tolerance = outline_length(states.parts)
    for contact in states.contacts():
        face1, face2 = (faces[side] for side in zip(contact.parts, contact.faces, strict=True))
        region = region_of(contact, face1, face2, tolerance)
        points = region.triangles.reshape(-1, 3) if contact.region == "surface" else region.line
        assert len(points) == {"point": 1, "line": 2, "circle": 97}.get(contact.region, len(points)) > 0
        for surface in contact.surfaces:
            assert np.abs(surface.distance(points)).max() < 2 * tolerance


def area(triangles):
    edges = triangles[:, 1:] - triangles[:, :1]
    return np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=-1).sum() / 2


@pytest.mark.long
def test_areas_are_those_of_the_drawing():
    """The pin of the crank in the coupler: 2 pi r h, of which the chords of its tessellation leave out a little."""
    assembly = jk.load(path("fourbar"))
    faces = {(part.name, face.name): face for part in assembly.parts for face in part.faces}
    size = EXAMPLES["fourbar"].dimensions
    contact = next(c for c in assembly.contacts() if set(c.parts) == {"crank", "coupler"} and c.state == "e")
    face1, face2 = (faces[side] for side in zip(contact.parts, contact.faces, strict=True))
    found = area(region_of(contact, face1, face2, outline_length(assembly.parts)).triangles)
    assert found == pytest.approx(2 * np.pi * size["pin radius"] * size["thickness"], rel=0.01)


@pytest.mark.long
def test_the_picture_shows_contacts_in_their_colour(tmp_path):
    found = jk.load(path("cam"))
    red = []
    for contacts in (None, ()):
        mechanism = found.mechanism(fixed=["frame"])
        draw_inspection(found, tmp_path / "found.png", contacts=contacts, mechanism=mechanism, width=500)
        image = np.asarray(Image.open(tmp_path / "found.png").convert("RGB"), int)[:-150]  # without the legend
        red.append(int(((image[..., 0] - image[..., 1:].max(axis=-1)) > 90).sum()))
    assert red[0] > 5 * red[1] + 150
    assert [file.name for file in tmp_path.iterdir()] == ["found.png"]


@pytest.mark.long
def test_a_gallery_shows_each_contact_in_a_panel(states, tmp_path):
    """In the colour of its region; the panels stand side by side from the left."""
    contacts = {contact.region: contact for contact in states.contacts()}
    chosen = [contacts[region] for region in ("surface", "line", "circle", "point")]
    draw_gallery(states, tmp_path / "gallery.png", contacts=chosen)
    image = np.asarray(Image.open(tmp_path / "gallery.png").convert("RGB"), int)[MARGIN + HEAD : -FOOT]
    for panel, contact in enumerate(chosen):
        left = MARGIN + panel * (PANEL + GAP)
        near = np.abs(image[:, left : left + PANEL] - 255 * np.array(COLORS[contact.region])).max(axis=-1) < 60
        assert near.sum() > 50
    with pytest.raises(ValueError, match=r"states\.step has no contacts to draw"):
        draw_gallery(states, tmp_path / "none.png", contacts=())


def test_nothing_is_left_where_it_cannot_be_written(tmp_path):
    with pytest.raises(FileNotFoundError):
        draw_inspection(jk.load(path("cam")), tmp_path / "none" / "found.png", width=200)
    assert list(tmp_path.iterdir()) == []


def test_one_joint_is_called_so(tmp_path, monkeypatch):
    said = []
    monkeypatch.setattr(Sheet, "write", lambda sheet, at, text, *style, **more: said.append(text))
    base = part("base", block((-40, -40, -10), (40, 40, 0)), pin(4.0, 0, 20))
    drawn = assembly(base, part("lever", ring(4.2, 9.0, 0.5, 19.5), block((8, -4, 0.5), (40, 4, 6))))
    draw_inspection(drawn, tmp_path / "found.png", mechanism=drawn.mechanism(fixed=["base"]), width=300)
    assert any(text.startswith("2 parts  ·  no contacts  ·  1 joint  ·  ") for text in said)
