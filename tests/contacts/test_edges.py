"""Parts that touch in none of the sixteen states are named; parts that are apart are not."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from jaxkin.contacts.detect import find_contacts
from jaxkin.contacts.edges import _nearest, _Side, distances
from jaxkin.geometry.pose import rotation, unit
from jaxkin.geometry.surfaces import Cylinder, Plane

X, Y, Z = np.eye(3)
TURN = (-np.pi, np.pi)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_distances_of_triangles_against_their_points(seed):
    """Never above the least distance of a fine grid of their points, and below it by no more than the grid."""
    rng = np.random.default_rng(seed)
    a, b = (
        rng.uniform(0, 1, (3, 3)),
        rng.uniform(0, 1, (3, 3)) + 1.2 * X,
    )  # apart along x: they do not pierce each other
    steps = np.linspace(0, 1, 31)
    weights = np.array([(u, v, 1 - u - v) for u in steps for v in steps if u + v <= 1 + 1e-9])
    grid = np.linalg.norm((weights @ a)[:, None] - (weights @ b)[None], axis=-1).min()
    (exact,) = distances(a[None], b[None])
    assert grid - 2 * 1.8 / 30 <= exact <= grid + 1e-12


def cube(solids, name, displacement):
    """A cube of side 2 about the origin, displaced."""
    faces = [
        solids.patch(Plane(axis * side, axis * side), (-1, 1), (-1, 1)) for axis in (X, Y, Z) for side in (1.0, -1.0)
    ]
    return solids.part(name, *(solids.moved(face, displacement) for face in faces))


def test_a_cube_on_its_edge_a_corner_or_a_pin_on_its_rim_is_named(solids):
    table = cube(solids, "table", np.eye(4))
    on_edge, on_corner, apart = np.eye(4), np.eye(4), np.eye(4)
    on_edge[:3, :3] = rotation(X, np.pi / 4)
    on_edge[2, 3] = 1 + np.sqrt(2)
    on_corner[:3, :3] = rotation(unit(np.array([1.0, -1.0, 0])), np.arccos(1 / np.sqrt(3)))
    on_corner[2, 3] = 1 + np.sqrt(3)
    for displacement in (on_edge, on_corner):
        contacts = find_contacts((table, cube(solids, "cube", displacement)))
        assert len(contacts) == 0 and not contacts.near_misses
        (note,) = contacts.notes
        assert note.startswith("table plane and cube plane meet at an edge or a corner only")
    apart[:3, :3], apart[2, 3] = on_edge[:3, :3], on_edge[2, 3] + 1e-3
    assert not find_contacts((table, cube(solids, "cube", apart))).notes

    tilt = np.eye(4)  # a pin that stands on the lowest point of its rim
    tilt[:3, :3] = rotation(X, 0.3)
    tilt[2, 3] = 1 + np.sin(0.3)
    pin = solids.moved(solids.patch(Cylinder(np.zeros(3), Z, 1.0, 1), TURN, (0, 2), steps=23), tilt)
    contacts = find_contacts((table, solids.part("pin", pin)))
    assert len(contacts) == 0 and [note[:31] for note in contacts.notes] == ["table plane and pin cylinder me"]


def test_parts_in_contact_are_not_named(pair, solids):
    contacts = find_contacts((solids.part("one", pair.face1), solids.part("two", pair.face2)))
    assert len(contacts) == 1 and not contacts.notes


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, 1e-3, 0.0]), st.sampled_from([0.0, 0.02, 0.3]))
def test_the_nearest_pair_is_that_of_all_pairs(seed, thin, bulge):
    """Sparing pairs spares none that is the nearest, of long thin triangles, degenerate ones and bulges too."""
    rng = np.random.default_rng(seed)

    def side(count, middle):
        start = rng.uniform(-1, 1, (count, 1, 3)) + middle
        along, across = rng.normal(size=(2, count, 1, 3))
        corners = start + along * np.array([[0.0], [1.0], [0.5]]) + thin * across * np.array([[0.0], [0.0], [1.0]])
        return _Side(corners, np.zeros(count, int), rng.uniform(0, bulge, count) if bulge else np.zeros(count))

    one, two = side(30, np.zeros(3)), side(40, 2 * X)
    i, j = (index.ravel() for index in np.indices((30, 40)))
    beyond = distances(one.triangles[i], two.triangles[j]) - one.bulges[i] - two.bulges[j]
    for tolerance in (0.0, 0.1, 10.0):
        found = _nearest(one, two, tolerance)
        assert (found is None) == (beyond.min() > tolerance)
        if found is not None:
            # equal but for rounding: where a triangle of no height is the nearest, two distances differ by that
            assert beyond[found[0] * 40 + found[1]] <= beyond.min() + 1e-12
