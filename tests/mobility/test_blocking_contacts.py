"""A mechanism that cannot move: the contacts without which it could are named."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.assembly.assembly import Assembly
from jaxkin.assembly.blocking_contacts import blocking_contacts
from jaxkin.examples import EXAMPLES, path
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.pose import rotation
from jaxkin.geometry.surfaces import Plane


@pytest.fixture(scope="module")
def blocked():
    """The slider-crank with a stop, a plate against the end face of the slider."""
    assembly = jk.load(path("slider_crank"))
    along = EXAMPLES["slider_crank"].placement[:3, 0]
    slider = next(part for part in assembly.parts if part.name == "slider")
    end = next(f for f in slider.faces if f.surface.kind == "plane" and f.surface.normal @ along > 0.999)
    triangles = end.triangles[:, ::-1]
    stop = Part("stop", (Face("face 1", Plane(end.surface.point, -end.surface.normal), triangles),), triangles)
    return replace(assembly, parts=(*assembly.parts, stop)), end


@pytest.mark.long
def test_the_stop_is_the_first_way_out(blocked):
    assembly, end = blocked
    mechanism = assembly.mechanism(fixed=["ground", "stop"])
    assert mechanism.mobility().freedoms == 0
    ways = blocking_contacts(mechanism)
    (contact,) = ways[0].what
    assert contact.parts == ("slider", "stop") and contact.faces == (end.name, "face 1")
    assert ways[0].freedoms == 1 and set(ways[0].parts) == {"crank", "rod", "slider"}
    lines = str(mechanism).splitlines()
    (place,) = [k for k, line in enumerate(lines) if line.startswith("It cannot move.")]
    assert lines[place + 1].strip() == str(ways[0])
    assert f"slider {end.name} - stop face 1" in str(ways[0])


@pytest.mark.long
def test_each_way_out_is_one(blocked):
    """Leaving out a contact that is named gives just the freedoms that were promised, one that is not gives none that
    is of use: a hinge without the face that it rests on slides along its pin, and no more."""
    assembly, _ = blocked
    mechanism = assembly.mechanism(fixed=["ground", "stop"])
    promised = {contact: way.freedoms for way in blocking_contacts(mechanism) for contact in way.what}
    used = [contact for some in mechanism.contacts.values() for contact in some]
    assert 0 < len(promised) < len(used)
    for contact in [*promised, *[c for c in used if c not in promised][:2]]:
        sides = [f"{part} {face}" for part, face in zip(contact.parts, contact.faces, strict=True)]
        without = assembly.mechanism(fixed=["ground", "stop"], ignore=[sides])
        assert without.mobility().useful == promised.get(contact, 0)


@pytest.mark.long
def test_a_report_of_what_moves_says_nothing_of_it(blocked):
    assembly, _ = blocked
    assert "cannot move" not in str(assembly.mechanism(fixed=["ground", "stop"], ignore=[["slider", "stop"]]))


def test_joints_by_hand_are_named():
    """A triangle: three hinges of which each is one too many."""
    points = {"A": (0, 0, 0), "B": (4, 0, 0), "C": (1, 3, 0)}
    parts = {"A": ("base", "left"), "B": ("base", "right"), "C": ("left", "right")}
    hinges = [jk.revolute(name, *parts[name], point=points[name], axis=(0, 0, 1)) for name in points]
    ways = blocking_contacts(jk.Mechanism.build(fixed=["base"], joints=hinges))
    assert {way.what for way in ways} == {("A",), ("B",), ("C",)}
    assert [way.freedoms for way in ways] == [2, 2, 2]
    assert "joint 'A': then 2 freedoms, moving left, right" in map(str, ways)


def test_couplings_hold_what_they_tie_without_a_joint_too():
    """A triangle of hinges, and two wheels that gears of two ratios lock: without a hinge only the bars move."""
    points = {"A": (0, 0, 0), "B": (4, 0, 0), "C": (1, 3, 0), "P": (9, 0, 0), "Q": (12, 0, 0)}
    parts = {
        "A": ("base", "left"),
        "B": ("base", "right"),
        "C": ("left", "right"),
        "P": ("base", "p"),
        "Q": ("base", "q"),
    }
    hinges = [jk.revolute(name, *parts[name], point=points[name], axis=(0, 0, 1)) for name in points]
    gears = [jk.gear("P", "Q", ratio, name=f"gear {ratio}") for ratio in (1.0, 2.0)]
    mechanism = jk.Mechanism.build(fixed=["base"], joints=hinges).with_couplings(gears)
    assert mechanism.mobility().freedoms == 0
    assert {way.what: way.freedoms for way in blocking_contacts(mechanism)} == {("A",): 2, ("B",): 2, ("C",): 2}


def test_where_no_single_contact_is_the_reason_the_fewest_of_two_parts_are():
    """A bar held twice over by three pairs of faces: each face repeats what the other forbids."""
    lid = [jk.planar(f"lid {k}", "base", "lid", normal=(0, 0, 1), point=(k, 0, 0)) for k in range(2)]
    lid += [jk.planar(f"side {k}", "base", "lid", normal=(0, 1, 0), point=(k, 0, 0)) for k in range(2)]
    lid += [jk.planar(f"end {k}", "base", "lid", normal=(1, 0, 0), point=(k, 0, 0)) for k in range(2)]
    ways = blocking_contacts(jk.Mechanism.build(fixed=["base"], joints=lid))
    assert {way.what for way in ways} == {("lid 0", "lid 1"), ("side 0", "side 1"), ("end 0", "end 1")}
    assert "joint 'lid 0' and joint 'lid 1': then 1 freedom, moving lid" in map(str, ways)
    for way in ways:
        left = jk.Mechanism.build(fixed=["base"], joints=[joint for joint in lid if joint.name not in way.what])
        assert left.mobility().useful == way.freedoms == 1


def rectangle(name, point, normal, along, half=2.0):
    """A square face about a point."""
    across = np.cross(normal, along)
    corners = np.array([point + half * (i * along + j * across) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    return Face(name, Plane(point, normal), corners[[[0, 1, 2], [0, 2, 3]]])


def test_contacts_that_were_perhaps_meant_to_agree_come_first():
    """A block on a floor between two walls, one of which is turned by 9e-5 rad: the walls hold it, not the floor."""
    x, y, z = np.eye(3)
    turned = rotation(z, 9e-5)
    sides = {"floor": (0 * x, z, x), "left": (-2 * y, y, x), "right": (2 * y, turned @ -y, turned @ x)}
    parts = []
    for name, sign in (("base", 1), ("block", -1)):
        faces = tuple(rectangle(side, point, sign * normal, along) for side, (point, normal, along) in sides.items())
        parts.append(Part(name, faces, np.concatenate([face.triangles for face in faces])))
    assembly = Assembly(tuple(parts), "mm", "block")
    contacts = assembly.contacts()
    assert len(contacts) == 3
    mechanism = assembly.mechanism(fixed=["base"])
    assert mechanism.mobility().freedoms == 0
    ways = blocking_contacts(mechanism)
    assert [way.what[0].faces[0] for way in ways] == ["left", "right", "floor"]
    for way in ways:
        (contact,) = way.what
        ignored = [[f"{part} {face}" for part, face in zip(contact.parts, contact.faces, strict=True)]]
        assert assembly.mechanism(fixed=["base"], ignore=ignored).mobility().useful == way.freedoms
