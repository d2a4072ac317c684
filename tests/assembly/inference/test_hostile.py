"""Assemblies that tie nothing, tie everything, or repeat themselves: right, or named, within bounds of time."""

import time

import numpy as np
import pytest
import trimesh

from jaxkin.assembly.assembly import Assembly
from jaxkin.geometry.part import Face, Part
from jaxkin.geometry.surfaces import Cylinder, Plane


def cylinder(name, point, axis, radius, length, hole=False):
    """A face all round an axis, with the normal inwards for a hole."""
    mesh = trimesh.creation.cylinder(radius, length, sections=24)
    side = np.abs(mesh.face_normals[:, 2]) < 0.5
    frame = np.asarray(trimesh.geometry.align_vectors([0, 0, 1], axis))
    corners = mesh.triangles[side] @ frame[:3, :3].T + point
    surface = Cylinder(np.array(point, float), np.array(axis, float), radius, -1 if hole else 1)
    return Face(name, surface, corners[:, ::-1] if hole else corners)


def box_faces(low, high):
    """The six planes of a box."""
    low, high = np.array(low, float), np.array(high, float)
    mesh = trimesh.creation.box(bounds=[low, high])
    faces = []
    for number, normal in enumerate([*np.eye(3), *-np.eye(3)]):
        side = mesh.face_normals @ normal > 0.5
        point = high if number < 3 else low
        faces.append(Face(f"face {number + 1}", Plane(point, normal), mesh.triangles[side]))
    return faces


def part(name, faces):
    return Part(name, tuple(faces), np.concatenate([face.triangles for face in faces]))


def bolt(name, x, y, radius=1.0, length=8.0):
    return part(name, [cylinder("face 1", (x, y, 0), (0, 0, 1), radius, length)])


def plate(name, low, high, holes, radius=1.0):
    """A plate with holes along z; its planes are not cut out around them."""
    middle, depth = (low[2] + high[2]) / 2, high[2] - low[2]
    bores = [
        cylinder(f"face {number + 7}", (x, y, middle), (0, 0, 1), radius, depth, hole=True)
        for number, (x, y) in enumerate(holes)
    ]
    return part(name, [*box_faces(low, high), *bores])


def assembly(*parts):
    return Assembly(tuple(parts), "mm", "hostile.step")


def boxes(names, step=30.0):
    return [part(name, box_faces((step * k, 0, 0), (step * k + 10, 10, 10))) for k, name in enumerate(names)]


def test_parts_in_no_contact_are_left_or_held_and_all_are_named():
    names = ["base", "b", "c", "d"]
    mechanism = assembly(*boxes(names)).mechanism(fixed=["base"])
    assert set(mechanism.parts) == set(names)
    assert len(mechanism.bodies) == 1
    for name in names[1:]:
        assert any(repr(name) in note and "nothing" in note for note in mechanism.notes)


def test_parts_in_no_contact_are_refused_without_inference():
    with pytest.raises(ValueError, match="touch"):
        assembly(*boxes(["base", "b"])).mechanism(fixed=["base"], infer=False)


def test_parts_that_are_excluded_are_not_there():
    mechanism = assembly(*boxes(["base", "b", "c"])).mechanism(fixed=["base"], exclude=["c"])
    assert set(mechanism.parts) == {"base", "b"}


@pytest.mark.long
def test_hundreds_of_bolts_hold_two_plates_as_one_body():
    """Time grows as the number of pairs of parts does, and no faster: measured against half of the bolts."""
    times = []
    for rows in (7, 14):
        holes = [(10.0 * i, 10.0 * j) for i in range(20) for j in range(rows)]
        low, high = (-5, -5), (195, 10 * rows - 5)
        plates = [plate(name, (*low, z), (*high, z + 3), holes, 1.1) for name, z in (("lower", -3.0), ("upper", 0.0))]
        whole = assembly(*plates, *(bolt(f"bolt {k}", *at) for k, at in enumerate(holes)))
        whole.contacts()
        start = time.process_time()
        mechanism = whole.mechanism(fixed=["lower"])
        times.append(time.process_time() - start)
        assert len(mechanism.bodies) == 1
        assert any(note.startswith("inferred beside exact contacts") for note in mechanism.notes)
    assert times[1] < 6 * times[0]  # 4 where each pair of parts costs the same, 8 where each three of them do


def test_bores_on_one_axis_are_hinges_about_it():
    """Five levers on one axis and no pin: each turns about it, and none is welded for sharing it with all others."""
    levers = [plate(f"lever {k}", (-5, -5, 4.0 * k), (30, 5, 4.0 * k + 4), [(0.0, 0.0)], 2.0) for k in range(5)]
    mechanism = assembly(*levers).mechanism(fixed=["lever 0"])
    assert len(mechanism.bodies) == 5
    moving = [joint for joint in mechanism.all_joints if joint.freedoms]
    assert {str(joint.kind) for joint in moving} == {"revolute"}
    for joint in moving:
        np.testing.assert_allclose(np.cross(joint.frames_1[0, :3, 2], [0, 0, 1]), 0.0, atol=1e-9)
        np.testing.assert_allclose(joint.frames_1[0, :2, 3], 0.0, atol=1e-9)


def test_a_part_twice_in_one_place_ends_in_a_mechanism():
    holes = [(0.0, 0.0)]
    twice = [plate(name, (-5, -5, 0), (30, 5, 4), holes, 2.0) for name in ("lever", "lever#2")]
    base = plate("base", (-10, -10, -4), (40, 10, 0), holes, 2.0)
    mechanism = assembly(base, *twice).mechanism(fixed=["base"])
    assert any("lever face" in note and "lever#2 face" in note for note in mechanism.notes)
    assert {*mechanism.bodies.values()} == {("base", "lever#2"), ("lever",)}
    (joint,) = (each for each in mechanism.all_joints if each.freedoms)
    assert joint.kind == "revolute" and mechanism.mobility().freedoms == 1
    np.testing.assert_allclose(joint.frames_1[0, :3, 2], [0, 0, 1], atol=1e-9)


def test_what_is_excluded_is_not_proposed_either():
    drawn = assembly(*boxes(["base", "b", "c"]))
    for proposal in drawn.without(["b*"]).proposals():
        assert "base" not in proposal.fixed and "b" not in proposal.fixed


@pytest.mark.parametrize("play", [0.0, 0.2])
def test_links_over_a_sheet_of_equal_holes_turn_about_their_pivots_only(play):
    """All bores of the lever are coaxial with holes of the sheet, and one pin only is in two of them: it is a hinge."""
    holes = [(10.0 * i, 10.0 * j) for i in range(6) for j in range(4)]
    sheet = plate("sheet", (-5, -5, -2), (55, 35, 0), holes, 2.0 + play)
    lever = plate("lever", (-4, -4, 0), (34, 4, 3), [(0.0, 0.0)], 2.0 + play)
    pivot = part("pivot", [cylinder("face 1", (0, 0, 0.5), (0, 0, 1), 2.0, 5.0)])
    mechanism = assembly(sheet, lever, pivot).mechanism(fixed=["sheet"])
    (joint,) = (each for each in mechanism.all_joints if each.freedoms)
    assert joint.kind == "revolute" and mechanism.mobility().useful == 1
    np.testing.assert_allclose(joint.frames_1[0, :2, 3], 0.0, atol=1e-9)
