"""Detection against sampled distances between the faces, in poses where nothing was meant to touch."""

import numpy as np
from scipy.spatial import cKDTree

from jaxkin.contacts.detect import find_contacts
from jaxkin.geometry.pose import rotation, unit


def samples(face, rng, count=2000):
    """Random points of a face, taken from its triangles onto its surface."""
    edges = face.triangles[:, 1:] - face.triangles[:, :1]
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=-1)
    chosen = face.triangles[rng.choice(len(areas), count, p=areas / areas.sum())]
    points = np.einsum("nc,nci->ni", rng.dirichlet([1, 1, 1], count), chosen)
    for _ in range(2):  # the second step takes out what a cone's distance along its normal leaves
        points = points - face.surface.distance(points)[:, None] * face.surface.normals(points)
    return points


def test_contacts_are_confirmed_by_sampled_distances(pair, solids):
    """Displaced at random by 1e-6 to 1: a contact has points of both faces at one place, and what is apart has none."""
    rng = np.random.default_rng([ord(letter) for letter in pair.letter + pair.variant])
    spacing = (
        0.25  # 2000 points of a face of up to 36 by 36: the nearest samples of touching faces are closer than this
    )
    found = 0
    for size in 10.0 ** np.linspace(-6, 0, 5):
        turn = np.eye(4)
        turn[:3, :3] = rotation(unit(rng.normal(size=3)), size)
        turn[:3, 3] = size * unit(rng.normal(size=3))
        face2 = solids.moved(pair.face2, turn)
        contacts = find_contacts((solids.part("one", pair.face1), solids.part("two", face2)))
        points1, points2 = samples(pair.face1, rng), samples(face2, rng)
        nearest, _ = cKDTree(points1).query(points2)
        tolerance = 1e-5 * np.linalg.norm(np.ptp(np.concatenate([pair.face1.box, face2.box]), axis=0))
        if len(contacts):
            found += 1
            assert nearest.min() < spacing
            # points of face 2 that lie over face 1 come down to its surface, as far as a sample falls near the contact
            over = points2[nearest < spacing]
            assert np.abs(pair.face1.surface.distance(over)).min() < 0.02
            assert contacts[0].misfit <= tolerance
        if nearest.min() > spacing:
            assert not len(contacts)
    assert found >= 1  # at 1e-6 it is the contact that it was
