"""Region growing: how many seeds a facet with many neighbours makes."""

import numpy as np
import pytest
import trimesh

from jaxkin.geometry import region_growing, region_union
from jaxkin.geometry.facets import facets
from jaxkin.geometry.region_growing import RegionGrowing
from jaxkin.geometry.regions import regions
from jaxkin.geometry.weld import weld


def dome(sides, rings=6):
    """A solid under an ellipsoid with three axes, which is free-form, with a flat polygon at its pole."""
    angles = np.linspace(0.0, 2 * np.pi, sides, endpoint=False)
    tilts = np.linspace(0.05, np.pi / 2, rings)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points = np.stack(
        [np.column_stack([10 * np.sin(t) * around * [1.0, 0.8], np.full(sides, 6 * np.cos(t))]) for t in tilts]
    )
    low, high = points[:-1], points[1:]
    after = np.roll(np.arange(sides), -1)
    sides_of = [[low, high, high[:, after]], [low, high[:, after], low[:, after]]]
    walls = [np.stack(corners, axis=2).reshape(-1, 3, 3) for corners in sides_of]
    fans = [[ring[0], ring[k], ring[k + 1]] for ring in (points[0], points[-1, ::-1]) for k in range(1, sides - 1)]
    return np.concatenate([*walls, np.array(fans)])


def test_a_facet_with_many_neighbours_is_tried_with_few_of_them():
    """Of the 90 neighbours of the pole 3,915 pairs could be strips with it: eight of them make 28 at most."""
    welded = weld(dome(90), 1e-6)
    mesh = facets(welded.points, welded.triangles, welded.pairs, 1e-5)
    growing = RegionGrowing(mesh, np.arange(len(mesh.triangles)))
    pole = int(np.argmax([len(near) for near in growing.neighbours]))
    assert len(growing.neighbours[pole]) == 90
    assert 0 < len(list(growing._strips(pole))) <= 28


def mesh_of(corners):
    welded = weld(corners, 1e-6)
    return facets(welded.points, welded.triangles, welded.pairs, 1e-5)


@pytest.mark.parametrize(("bound", "most"), [("MAX_FAILURES", 2), ("MAX_WORK", 0)])
def test_what_a_search_that_meets_its_bounds_leaves_is_counted(monkeypatch, bound, most):
    """It ended without a word: what was not looked at was called free-form."""
    mesh = mesh_of(dome(8, 4))
    whole = regions(mesh)
    assert not len(whole.untried) and not whole.pairs
    monkeypatch.setattr(region_growing, bound, most)
    found = regions(mesh)
    free = np.concatenate([region.rows for region in found.regions if region.surface is None])
    assert len(np.intersect1d(found.untried, free)) > len(free) / 2
    assert sum(len(region.rows) for region in found.regions) == len(mesh.triangles)


def test_pairs_of_pieces_that_are_not_tried_are_counted(monkeypatch):
    """A capsule is a cylinder with two balls, each of which meets it along a smooth edge."""
    capsule = trimesh.creation.capsule(height=30.0, radius=5.0, count=[32, 32])
    mesh = mesh_of(np.asarray(capsule.triangles))
    assert regions(mesh).pairs == 0
    monkeypatch.setattr(region_union, "_MAX_UNION_TRIALS", 0)
    assert regions(mesh).pairs == 2
