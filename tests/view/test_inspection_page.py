"""The report of an inspection: what it holds for each part, joint and assumption, and that it needs nothing else."""

import json
import re
from base64 import b64decode
from dataclasses import replace

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.assembly.assembly import Assembly
from jaxkin.contacts.contact import Contacts
from jaxkin.geometry.part import Part
from jaxkin.view.drawing import body_colors
from jaxkin.view.glass import oblique_view
from jaxkin.view.inspection_page import inspection_page

SIDE = 20.0
"""Of the boxes below, in mm; they stand in a row along x, with as much air between them."""
FLOAT32 = 2e-5
"""Two roundings of coordinates of about 100 mm in single precision."""


@pytest.fixture
def boxes():
    """A base, an arm of two parts that hangs on it by a hinge, and a lid; one name is a letter, one has a path."""
    box = trimesh.creation.box((SIDE, SIDE, SIDE)).triangles
    names = ("base", "arm", "a", "lid")
    parts = tuple(Part(name, (), box + np.array([2 * SIDE * place, 0, 0])) for place, name in enumerate(names))
    lid = replace(parts[3], path=("Cover", "Top"), original_name="lid\x07", notes=("face 1: torus",))
    return Assembly((*parts[:3], lid), "mm", "boxes.step")


def swing(boxes):
    hinge = jk.revolute("hinge", "base", "arm", point=(5, 0, 0), axis=(0, 0, 1))
    rail = jk.prismatic("rail", "base", "lid", point=(0, 0, 0), axis=(1, 0, 0))
    return boxes.mechanism(fixed=["base"], rigid=[["arm", "a"]], joints=[hinge, rail], contacts=[])


def written(found, path, **options):
    """The text of the page, and the data in it."""
    inspection_page(found, path / "report.html", source="boxes.step", **options)
    text = (path / "report.html").read_text("utf-8")
    (data,) = re.findall(r'<script id="scene" type="application/json">(.*?)</script>', text, re.DOTALL)
    return text, json.loads(data)


def points(data, entry):
    """Points of a part or a path, in the unit of the assembly."""
    return np.frombuffer(b64decode(entry["points"]), "<f4").reshape(-1, 3) * data["scale"] + data["centre"]


def test_the_report_needs_nothing_from_elsewhere(boxes, tmp_path):
    text, _ = written(swing(boxes), tmp_path)
    assert not re.search(r"https?:|//\w+\.|\bsrc=|\bhref=|url\(|@import|\bimport\b|fetch\(|XMLHttp|{{", text)
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]


def test_each_part_says_what_it_is(boxes, tmp_path):
    _, data = written(swing(boxes), tmp_path)
    assert [part["name"] for part in data["parts"]] == list(boxes.names)
    lid = data["parts"][3]
    assert (lid["original"], lid["path"], lid["notes"]) == ("lid\x07", ["Cover", "Top"], ["face 1: torus"])
    assert lid["size"] == "20 x 20 x 20 mm" and data["parts"][0]["original"] == ""
    for part, solid in zip(data["parts"], boxes.parts, strict=True):
        assert np.allclose(np.ptp(points(data, part), axis=0), SIDE, rtol=0, atol=FLOAT32)
        assert np.allclose(points(data, part).min(axis=0), solid.box[0], rtol=0, atol=FLOAT32)


def test_bodies_have_one_colour_and_all_their_parts(boxes, tmp_path):
    _, data = written(swing(boxes), tmp_path)
    assert [(body["name"], body["fixed"], body["parts"]) for body in data["bodies"]] == [
        ("base", True, [0]),
        ("arm, a", False, [1, 2]),
        ("lid", False, [3]),
    ]
    for number, body in enumerate(data["bodies"]):
        assert {tuple(data["parts"][part]["color"]) for part in body["parts"]} == {tuple(body["color"])}
        assert {data["parts"][part]["body"] for part in body["parts"]} == {number}
    assert len({tuple(body["color"]) for body in data["bodies"]}) == 3


def test_colours_repeat_late():
    bodies = {f"part {number}": (f"part {number}",) for number in range(22)}
    colors = body_colors(bodies, ["part 0"])
    assert len(set(colors.values())) == 22 and all(0 <= value <= 1 for color in colors.values() for value in color)


def test_each_joint_has_its_axis_through_both_parts(boxes, tmp_path):
    mechanism = swing(boxes)
    _, data = written(mechanism, tmp_path)
    assert [joint["name"] for joint in data["joints"]] == ["hinge", "rail", "arm-a"]  # those that move come first
    assert len(data["paths"]) == 2
    hinge, rail = data["joints"][:2]
    assert (hinge["kind"], hinge["coordinates"], hinge["parts"]) == ("revolute", ["hinge.phi"], [0, 1])
    assert (hinge["evidence"], hinge["inferred"]) == ("user", False)
    place, start, end = points(data, data["paths"][0])
    assert np.allclose(place, (5, 0, 0), rtol=0, atol=FLOAT32)
    assert np.allclose(start[:2], (5, 0), rtol=0, atol=FLOAT32) and start[2] < -SIDE / 2 and end[2] > SIDE / 2
    _, start, end = points(data, data["paths"][1])  # along x the boxes have no stretch in common: it spans the air
    assert start[0] < SIDE / 2 and end[0] > 6 * SIDE - SIDE / 2 and rail["parts"] == [0, 3]


def test_notes_name_their_parts_and_joints(boxes, tmp_path):
    said = (
        "inferred from nearest: 'arm', 'a' are one body: 'a' is tied to nothing, and 2 from 'arm'",
        "inferred from clearance: revolute joint 'hinge': the pin has a clearance of 0.1",
        "nearly (a) base face 1 - lid face 2: plane on plane: a gap of 0.1: close it",
        "lid: face 1: torus",  # said with the part
    )
    _, data = written(replace(swing(boxes), history=said), tmp_path, tried=["with fixed = ['lid', 'a']: nothing"])
    notes = [(note["group"], note["parts"], note["joint"]) for note in data["notes"]]
    assert notes == [
        ("Inferred from nearest", [1, 2], None),  # the part "a" is not the article
        ("Inferred from clearance", [0, 1], "hinge"),
        ("Nearly in contact", [0, 3], None),
        ("Tried to be fixed", [3, 2], None),
    ]


def test_without_a_mechanism_it_says_why_and_lists_contacts(boxes, tmp_path):
    _, data = written(boxes, tmp_path, missing=["no part is fixed"], contacts=Contacts((), (), ("base face 1: torus",)))
    assert data["missing"] == ["no part is fixed"] and not data["joints"] and not data["paths"]
    assert [body["name"] for body in data["bodies"]] == list(boxes.names)
    assert [(note["group"], note["parts"]) for note in data["notes"]] == [("Noted", [0])]


def test_mechanisms_by_hand_are_shown_as_sticks(tmp_path):
    hinge = jk.revolute("A", "ground", "</script>", point=(0, 0, 0), axis=(0, 0, 1))
    ball = jk.spherical("B", "</script>", "tip", point=(1, 0, 0))
    text, data = written(jk.Mechanism.build(fixed=["ground"], joints=[hinge, ball]), tmp_path)
    assert text.count("</script>") == 3
    assert [part["name"] for part in data["parts"]] == ["ground", "</script>", "tip"]
    assert np.ptp(points(data, data["paths"][1]), axis=0) == pytest.approx(0, abs=1e-6)  # a ball has no axis


@pytest.mark.parametrize("up", [*np.eye(3), *-np.eye(3)], ids=str)
def test_the_page_opens_as_the_picture_does_with_the_moving_parts_on_their_base(up, tmp_path):
    """However the file is turned: seen with z up, the base plate hid what is on its other side."""
    flat = 100.0 - 90.0 * np.abs(up)
    plate = Part("plate", (), trimesh.creation.box(flat).triangles)
    arm = Part("arm", (), trimesh.creation.box(0.4 * flat).triangles + 20.0 * up)
    hinge = jk.revolute("hinge", "plate", "arm", point=(0, 0, 0), axis=tuple(up))
    mechanism = Assembly((plate, arm), "mm", "plate.step").mechanism(fixed=["plate"], joints=[hinge], contacts=[])
    _, data = written(mechanism, tmp_path)
    np.testing.assert_allclose(data["axes"][1], up, atol=1e-12)
    cos, sin = np.cos(data["pitch"]), np.sin(data["pitch"])
    assert data["yaw"] == 0 and sin > 0, "the plate is looked down on"
    looked = np.array([[1, 0, 0], [0, cos, -sin], [0, sin, cos]]) @ data["axes"]
    np.testing.assert_allclose(looked, oblique_view(mechanism.solids, ["plate"]).axes, atol=1e-12)
    corners = np.concatenate([part.triangles.reshape(-1, 3) for part in mechanism.solids]) - data["centre"]
    seen, filled = (np.ptp(each @ np.transpose(data["axes"]), axis=0) for each in (corners, np.array(data["corners"])))
    np.testing.assert_allclose(filled * data["scale"], seen, atol=1e-9)
