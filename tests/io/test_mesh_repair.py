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
    with pytest.raises(ValueError, match=r"is not closed.*the first near"):
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
