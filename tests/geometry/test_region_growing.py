"""Region growing: how many seeds a facet with many neighbours makes."""

import numpy as np

from jaxkin.geometry.facets import facets
from jaxkin.geometry.region_growing import RegionGrowing
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
