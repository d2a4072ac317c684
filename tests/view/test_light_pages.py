"""Pages of large assemblies: few triangles, one displacement a body, and legends that name bodies."""

import re

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.assembly.assembly import Assembly
from jaxkin.geometry.part import Part
from jaxkin.view.drawing import body_label, drawn_parts
from jaxkin.view.mesh import lightened
from jaxkin.view.page import page


def ball(subdivisions: int) -> np.ndarray:
    return trimesh.creation.icosphere(subdivisions, 0.5).triangles


def test_few_triangles_stay_as_they_are():
    given = [ball(2), ball(1) + 1.0]
    assert all(np.array_equal(one, other) for one, other in zip(lightened(given), given, strict=True))


def test_of_many_as_many_are_left_as_may_be_and_the_surface_stays_where_it_was():
    most = 30_000
    (found,) = lightened([ball(6)], most)
    assert most / 8 < len(found) <= most  # doubled cells leave a quarter of the triangles
    radii = np.linalg.norm(found.reshape(-1, 3), axis=1)
    # corners of a cell are averaged: they lie within the sagitta of its width, a sixtieth
    assert np.all(radii > 0.5 - 1e-3) and np.all(radii < 0.5 + 1e-12)
    edges = found[:, 1:] - found[:, :1]
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1).sum() / 2
    assert abs(area / np.pi - 1) < 0.05


def test_triangles_without_area_go_and_parts_stay():
    found = lightened([ball(5), 1e-6 * ball(3) + 0.7], 3000)
    assert len(found) == 2 and len(found[1]) < len(ball(3))


@pytest.fixture
def swing():
    """A base, and an arm that is two boxes welded together."""
    box = trimesh.creation.box((1.0, 1.0, 1.0)).triangles
    parts = tuple(Part(name, (), box + 2.0 * place) for place, name in enumerate(("base", "arm", "hand")))
    assembly = Assembly(parts, "mm", "boxes.stl")
    hinge = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=(0, 0, 1))
    return assembly.mechanism(fixed=["base"], rigid=[["arm", "hand"]], joints=[hinge], contacts=[])


def test_a_body_has_one_colour_one_row_and_one_displacement(swing, tmp_path):
    parts = {part.name: part.color for part in drawn_parts(swing)}
    assert parts["arm"] == parts["hand"] != parts["base"]
    assert [body_label(parts, swing.solids) for parts in swing.bodies.values()] == ["base", "arm, hand"]
    page(swing.sweep({"A": np.linspace(0.0, 1.0, 5)}), tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text()
    assert re.findall(r'"body":(\d)', text) == ["0", "1", "1"]
    assert len(re.findall(r'"poses":"[^"]', text)) == 1


def test_a_body_is_called_by_its_heaviest_part():
    """The first of a table and its pins may be a pin; a long thin screw is no name for what it holds.

    All names stand there where they take no more room than how many there are.
    """
    box = trimesh.creation.box((1.0, 1.0, 1.0)).triangles
    sizes = {"pin": (0.1, 0.1, 0.5), "table": (1.0, 1.0, 0.2), "screw": (0.05, 0.05, 4.0)}
    parts = [Part(name, (), box * np.array(size)) for name, size in sizes.items()]
    assert body_label(("pin", "table", "screw"), parts) == "table and 2 more"
    assert body_label(("pin", "not drawn"), parts) == "pin, not drawn"
    assert body_label(("not drawn",), parts) == "not drawn"


def test_the_text_of_a_mechanism_calls_bodies_as_its_pictures_do():
    """A pin comes before the arm that it is in: the text called their body "pin", pictures "arm, pin"."""
    box = trimesh.creation.box((1.0, 1.0, 1.0)).triangles
    sizes = {"screw": 0.1, "base": 3.0, "pin": 0.1, "arm": 1.0}
    assembly = Assembly(tuple(Part(name, (), box * size) for name, size in sizes.items()), "mm", "boxes.stl")
    hinge = jk.revolute("A", "screw", "pin", point=(0, 0, 0), axis=(0, 0, 1))
    mechanism = assembly.mechanism(fixed=["screw", "base"], rigid=[["pin", "arm"]], joints=[hinge], contacts=[])
    labels = [body_label(parts, mechanism.solids) for parts in mechanism.bodies.values()]
    assert labels == ["base, screw", "arm, pin"]
    text = str(mechanism)
    assert "fixed: base, screw" in text
    assert "screw - pin  base - arm  revolute" in text
