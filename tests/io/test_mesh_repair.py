"""Meshes whose faces were tessellated apart: they load with a note that says where, and keep their faces."""

from collections import Counter

import numpy as np
import pytest

from jaxkin.io.load import load
from tessellation import write_stl

KINDS = {"plane": 2, "cylinder": 2}


def circle(radius, count, height, turn=0.0):
    """The corners of a regular polygon in a circle about z, (count, 3)."""
    angle = turn + 2 * np.pi * np.arange(count) / count
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)], axis=-1)


def band(low, high):
    """Triangles between two closed polygons of as many corners."""
    next_low, next_high = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
    return np.concatenate([np.stack([low, next_low, high], 1), np.stack([next_low, next_high, high], 1)])


def ring(outer, flat, turn=0.0):
    """A ring of radii 30 and 40, height 12: `outer` chords outside, `flat` ones in the rims of its flat faces."""
    walls = [
        band(circle(40, outer, 0, turn), circle(40, outer, 12, turn)),
        band(circle(30, flat, 12), circle(30, flat, 0)),
    ]
    faces = [band(circle(40, flat, 12), circle(30, flat, 12)), band(circle(30, flat, 0), circle(40, flat, 0))]
    return np.concatenate(walls + faces)


@pytest.mark.parametrize(("chords", "turn"), [((48, 48), 0.0), ((48, 60), 0.0), ((90, 72), 0.01)])
def test_a_ring_with_faces_tessellated_apart_keeps_its_faces(chords, turn, tmp_path):
    """The rims share some corners, or none: the gap is the sag of the chords, 40 (1 - cos(pi / 48)) = 0.09 at most."""
    (part,) = load({"ring": write_stl(tmp_path / "ring.stl", ring(*chords, turn))}).parts
    assert Counter(face.surface.kind for face in part.faces) == KINDS
    radii = sorted(face.surface.radius for face in part.faces if face.surface.kind == "cylinder")
    np.testing.assert_allclose(radii, [30, 40], rtol=1e-5)
    # equal chords share their corners; other chords do not meet along the two outer rims
    assert len(part.notes) == (chords[0] != chords[1])
    assert all("do not meet along 2 of their edges, the first near" in note for note in part.notes)


def test_a_ring_without_a_flat_face_is_refused(tmp_path):
    """Two rims 10 apart in one plane are a hole, however long they are."""
    triangles = ring(48, 48)
    with pytest.raises(
        ValueError,
        match=r"not closed.* are 2 holes, the largest near \(.*, 113 across with 48 edges; near \(.*, 84.9 across with",
    ):
        load({"ring": write_stl(tmp_path / "ring.stl", triangles[: -2 * 48])})


def test_corners_that_differ_by_rounding_are_one(tmp_path):
    """Each triangle with its own corners, off by 1e-6 of the size: no note, the same faces."""
    triangles = ring(48, 48)
    noise = 5e-5 * np.random.default_rng(0).uniform(-1, 1, triangles.shape)
    (part,) = load({"ring": write_stl(tmp_path / "ring.stl", triangles + noise)}).parts
    assert Counter(face.surface.kind for face in part.faces) == KINDS and not part.notes


def test_corners_in_the_middle_of_edges_and_slivers_do_no_harm(tmp_path):
    """One triangle of the outer cylinder is split at the middle of its edge, its neighbour is not: a T-junction."""
    triangles = ring(48, 48)
    a, b, c = triangles[0]
    middle = (a + b) / 2
    split = np.concatenate([triangles[1:], [[a, middle, c], [middle, b, c]]])
    (part,) = load({"ring": write_stl(tmp_path / "ring.stl", split)}).parts
    assert len([face for face in part.faces if face.surface.kind == "cylinder"]) == 2


def zipped(outer, inner):
    """Triangles between two closed polygons about z with any numbers of corners, facing up."""
    angles = [np.unwrap(np.arctan2(points[:, 1], points[:, 0])) for points in (outer, inner)]
    angles = [np.append(each, each[0] + 2 * np.pi) for each in angles]
    triangles, i, j = [], 0, 0
    while i < len(outer) or j < len(inner):
        a, b = outer[i % len(outer)], inner[j % len(inner)]
        if j == len(inner) or (i < len(outer) and angles[0][i + 1] <= angles[1][j + 1]):
            triangles.append([a, outer[(i + 1) % len(outer)], b])
            i += 1
        else:
            triangles.append([a, inner[(j + 1) % len(inner)], b])
            j += 1
    return np.array(triangles)


def prism(profile, height, bore=None):
    """A prism over a polygon around the origin, with a round bore of so many chords if asked for."""
    top = profile + np.array([0.0, 0.0, height])
    walls = [band(profile, top)]
    middle = np.zeros((1, 3)) if bore is None else circle(4.0, bore, 0)
    if bore is not None:
        walls.append(band(middle + [0.0, 0.0, height], middle))
    return np.concatenate([*walls, zipped(top, middle + [0.0, 0.0, height]), zipped(profile, middle)[:, ::-1]])


def test_two_flat_faces_at_a_small_angle_are_flat(tmp_path):
    """A sole that rises by 30 degrees, as of a base with bevelled sides: the angle is that of a coarse round face."""
    section = [(-30.0, -20.0), (10.0, -20.0), (30.0, -20.0 + 20 * np.tan(np.pi / 6)), (30.0, 20.0), (-30.0, 20.0)]
    corners = np.array([(x, y, 0.0) for x, y in section])
    (part,) = load({"base": write_stl(tmp_path / "base.stl", prism(corners, 15.0))}).parts
    assert Counter(face.surface.kind for face in part.faces) == {"plane": 7} and not part.notes


def test_bends_far_larger_than_those_of_round_faces_are_edges(tmp_path):
    """Walls of uneven lengths that turn by 20 to 25 degrees each, beside a bore of chords of 6 degrees."""
    turns = np.deg2rad(np.cumsum([20, 25, 20, 22, 25, 20, 23, 25, 20, 25, 22, 24, 20, 23, 22, 24]))
    assert np.isclose(turns[-1], 2 * np.pi)
    normals = np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    away = np.random.default_rng(1).uniform(29.0, 31.0, 16)
    both = np.stack([normals, np.roll(normals, -1, axis=0)], axis=1)
    corners = np.linalg.solve(both, np.stack([away, np.roll(away, -1)], axis=-1)[..., None])[..., 0]
    corners = np.column_stack([corners, np.zeros(16)])
    (part,) = load({"base": write_stl(tmp_path / "base.stl", prism(corners, 15.0, bore=60))}).parts
    assert Counter(face.surface.kind for face in part.faces) == {"plane": 18, "cylinder": 1} and not part.notes


@pytest.mark.long
def test_a_free_form_wall_is_no_row_of_flat_faces(tmp_path):
    """An elliptic wall of 60 chords beside a bore of 60: bends are alike, so it stays one face on no surface."""
    angle = 2 * np.pi * np.arange(60) / 60
    corners = np.stack([40 * np.cos(angle), 22 * np.sin(angle), 0 * angle], axis=-1)
    (part,) = load({"cam": write_stl(tmp_path / "cam.stl", prism(corners, 15.0, bore=60))}).parts
    assert Counter(face.surface.kind for face in part.faces)["plane"] == 2
    assert any("freeform surface" in note for note in part.notes)
