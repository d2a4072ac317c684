"""T-junctions: corners in the middle of edges of other triangles, as refining one side of an edge only leaves them."""

from collections import Counter

import numpy as np
import pytest

from jaxkin.geometry.shells import volume
from jaxkin.geometry.stitch import stitched
from jaxkin.geometry.weld import pair_edges, weld
from jaxkin.io.load import load
from tessellation import write_stl

TOLERANCE = 1e-6


def bushing(chords=40):
    """A hollow cylinder of radii 4 and 9 and height 15."""
    angle = 2 * np.pi * np.arange(chords) / chords

    def ring(radius, height):
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(chords, height)], axis=-1)

    rims = [ring(9.0, 0.0), ring(9.0, 15.0), ring(4.0, 15.0), ring(4.0, 0.0)]
    pieces = []
    for low, high in zip(rims, rims[1:] + rims[:1], strict=True):
        after_low, after_high = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
        pieces += [np.stack([low, after_low, high], axis=1), np.stack([after_low, after_high, high], axis=1)]
    return np.concatenate(pieces)


def divided(triangles, seed, share=0.3, times=2):
    """Triangles some of which are divided at a point of an edge, on their side of it only."""
    random = np.random.default_rng(seed)
    for _ in range(times):
        chosen = random.random(len(triangles)) < share
        rolled = triangles[chosen]
        a, b, c = np.moveaxis(np.roll(rolled, random.integers(3), axis=1), 1, 0)
        middle = a + random.uniform(0.2, 0.8, (len(a), 1)) * (b - a)
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        triangles = np.concatenate([triangles[~chosen], *halves])
    return triangles


@pytest.mark.parametrize("seed", range(4))
def test_every_junction_is_gone_and_nothing_has_moved(seed):
    """All edges are shared again, and the volume is that of the whole mesh to rounding, wherever the junctions are."""
    whole = bushing()
    welded = weld(divided(whole, seed), TOLERANCE)
    assert len(welded.open_edges) == 0
    assert volume(welded.points[welded.triangles]) == pytest.approx(volume(whole), rel=1e-12)


def test_faces_are_those_of_the_mesh_without_junctions(tmp_path):
    """Corners in the middle of chords are off the round faces; with them these would fall to pieces."""
    (part,) = load({"bushing": write_stl(tmp_path / "bushing.stl", divided(bushing(), 7))}).parts
    assert Counter(face.surface.kind for face in part.faces) == {"plane": 2, "cylinder": 2} and not part.notes
    radii = sorted(face.surface.radius for face in part.faces if face.surface.kind == "cylinder")
    np.testing.assert_allclose(radii, [4, 9], rtol=1e-5)


def test_an_edge_is_divided_where_two_faces_end_on_it():
    """The faces on the other side lie in different planes, so that their common corner has to stay."""
    points = np.array([[0, 0, 0], [2, 0, 0], [1, 0, 0], [1, -1, 0], [1.5, 1, 0.5], [0.5, 1, -0.5]], float)
    below, right, left, between = [0, 1, 3], [1, 2, 4], [2, 0, 5], [2, 5, 4]
    triangles = np.array([below, right, left, between])
    _, rim = pair_edges(points, triangles)
    found = stitched(points, triangles, rim, TOLERANCE)
    assert sorted(map(sorted, found.tolist())) == [[0, 2, 3], [0, 2, 5], [1, 2, 3], [1, 2, 4], [2, 4, 5]]
    pairs, rim = pair_edges(points, found)
    assert len(pairs) == 5 and len(rim) == 5  # the edges around it


def test_a_true_hole_stays_one():
    """A missing triangle is no junction, and its rim keeps its corners where they bound it."""
    triangles = bushing()[1:]
    welded = weld(triangles, TOLERANCE)
    assert len(welded.open_edges) == 3 and len(welded.triangles) == len(triangles)
