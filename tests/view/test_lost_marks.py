"""Joints that leave their faces, in the pictures: a slider of the press that runs off its guide."""

import json
import re
from base64 import b64decode
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread

import jaxkin as jk
from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.surfaces import Plane
from jaxkin.joints.from_contacts import joints_from_contacts
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.view.lost_marks import WARNING, told
from jaxkin.view.page import page
from jaxkin.view.scene import make_scene
from jaxkin.view.storyboard import _choose, storyboard
from view.bars import box

X, Y, Z = np.eye(3)
OFF = 31
"""First pose of 0 to 60 at which the ram, 10 wide over a guide that ends 30 further on, has left it."""


def faced(part, *planes):
    """The part with the named sides of its box as faces."""
    faces = []
    for point, normal in planes:
        flat = np.all(np.abs((part.triangles - point) @ normal) < 1e-9, axis=1)
        faces.append(Face(f"face {len(faces) + 1}", Plane(np.array(point, float), normal), part.triangles[flat]))
    return Part(part.name, tuple(faces), part.triangles)


@pytest.fixture(scope="module")
def leaving():
    """A ram on a floor and along a fence; it slides along x from 0 to 60 and is off both beyond 30."""
    floor = faced(box("floor", [-40, 0, -5], [30, 20, 0]), ([0, 0, 0], Z))
    fence = faced(box("fence", [-40, 20, 0], [30, 25, 10]), ([0, 20, 0], -Y))
    ram = faced(box("ram", [0, 10, 0], [10, 20, 8]), ([0, 0, 0], -Z), ([0, 20, 0], Y))
    solids = (floor, fence, ram)
    bodies = {"floor": "floor", "fence": "floor", "ram": "ram"}
    found = joints_from_contacts(find_contacts(solids), ("floor", "fence", "ram"), bodies=bodies)
    built = Mechanism.build(
        fixed=["floor", "fence"], joints=[*found.joints, jk.fixed("tie", "floor", "fence")], unit="mm"
    )
    mechanism = replace(built, solids=solids, contacts=found.contacts)
    sign = np.sign(found.joints[0].frames_1[0, 0, 2])
    return mechanism.sweep({"floor-ram": sign * np.arange(61.0)})


def test_marks_are_where_the_faces_touched(leaving):
    scene = make_scene(leaving, {})
    (mark,) = scene.lost
    np.testing.assert_array_equal(mark.shown, np.arange(61) >= OFF)
    held, moved = mark.ends[:, OFF:]
    np.testing.assert_allclose(held, np.broadcast_to(held[0], held.shape), atol=1e-12)
    np.testing.assert_allclose(moved - held, np.outer(np.arange(OFF, 61), X), atol=1e-9)
    assert told(scene.lost, OFF - 1) == "" and told(scene.lost, OFF) == "lost contact: floor-ram"


def test_the_storyboard_rings_them(leaving, tmp_path):
    storyboard(leaving, tmp_path / "motion.png", poses=[0, 40])
    image = imread(tmp_path / "motion.png")[:-150, :, :3]  # without the legend
    red = np.abs(image - WARNING).max(axis=-1) < 0.02
    left, right = np.array_split(red, 2, axis=1)
    assert left.sum() == 0 and right.sum() > 300


def test_a_storyboard_shows_a_lost_contact_between_its_poses(leaving):
    """At one pose only, which an even choice of six would pass by."""
    scene = make_scene(leaving, {})
    ends = scene.lost[0].ends.copy()
    ends[:, np.arange(61) != 33] = np.nan
    order = scene.closed.tolist()
    chosen = _choose(replace(scene, lost=(replace(scene.lost[0], ends=ends),)))
    assert 33 in chosen and len(chosen) == 6 and chosen == sorted(chosen, key=order.index)


def test_the_page_tells_and_marks_them(leaving, tmp_path):
    page(leaving, tmp_path / "motion.html")
    text = (tmp_path / "motion.html").read_text("utf-8")
    (content,) = re.findall(r'<script id="scene" type="application/json">(.*?)</script>', text, re.DOTALL)
    data = json.loads(content)
    scene = make_scene(leaving)
    lost = np.array([bool(said) for said in data["lost"]])
    np.testing.assert_array_equal(lost, (scene.order >= OFF))
    assert "contact lost at 30" in data["subtitle"]
    ((held, moved),) = ([np.frombuffer(b64decode(end), "<f4").reshape(-1, 3) for end in mark] for mark in data["marks"])
    np.testing.assert_array_equal(np.isfinite(held).all(axis=1), lost)
    apart = data["scale"] * np.linalg.norm(moved - held, axis=1)[lost]
    np.testing.assert_allclose(apart, scene.order[lost], rtol=1e-5)  # float32
    assert not any(data["problems"])
