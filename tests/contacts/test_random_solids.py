"""Detection against sampled distances on random pairs of whole solids in random poses.

A solid comes nearer to another one along a random direction by the distance that the samples have, until they touch as
far as samples tell. What is reported has samples as near as they are dense; what is farther apart is never reported.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from jaxkin.contacts.detect import find_contacts
from jaxkin.contacts.tolerance import default_length
from jaxkin.geometry.part import Part
from jaxkin.geometry.pose import apply
from jaxkin.io.step import read_step

SOLIDS = Path(__file__).parents[1] / "io" / "data" / "solids.step"
SPACING = 2.0
"""mm between neighbouring samples at most, of solids of 10 to 80 mm."""


@pytest.fixture(scope="module")
def shapes():
    names = ("box", "pin", "bush", "cone", "frustum", "socket", "ball joint", "countersunk", "slot")
    return [part for part in read_step(SOLIDS)[0] if part.name in names]


def placed(part, pose, name):
    faces = tuple(replace(f, surface=f.surface.moved(pose), triangles=apply(pose, f.triangles)) for f in part.faces)
    return Part(name, faces, apply(pose, part.triangles))


def samples(part, rng):
    """Points all over the faces, on their exact surfaces, some `SPACING` apart."""
    found = []
    for face in part.faces:
        edges = face.triangles[:, 1:] - face.triangles[:, :1]
        areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=-1) / 2
        count = max(30, int(8 * areas.sum() / SPACING**2))
        chosen = face.triangles[rng.choice(len(areas), count, p=areas / areas.sum())]
        points = np.einsum("nc,nci->ni", rng.dirichlet([1, 1, 1], count), chosen)
        for _ in range(2):  # the second step takes out what a cone's distance along its normal leaves
            points = points - face.surface.distance(points)[:, None] * face.surface.normals(points)
        found.append(points)
    return np.concatenate(found)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_what_is_reported_is_near_and_what_is_apart_is_not_reported(shapes, solids, seed):
    rng = np.random.default_rng(seed)
    first, second = (shapes[k] for k in rng.integers(len(shapes), size=2))
    one = placed(first, solids.random_displacement(rng), "one")
    other = placed(second, solids.random_displacement(rng), "other")
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    points1, points2 = samples(one, rng), samples(other, rng)
    tree = cKDTree(points1)
    pose = np.eye(4)
    pose[:3, 3] = 150 * direction
    for _ in range(8):
        parts = (one, placed(other, pose, "other"))
        nearest, _ = tree.query(apply(pose, points2))
        contacts = find_contacts(parts)
        if len(contacts):
            assert nearest.min() < SPACING + default_length(parts)
        if nearest.min() > SPACING + default_length(parts):
            assert not len(contacts) and not contacts.near_misses
        pose[:3, 3] -= nearest.min() * direction
