"""Copies of parts, and poses that come again, are searched once: what is told is what is told of each alone."""

from dataclasses import replace

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.effects.clash_cases import distinct_cases
from jaxkin.effects.clash_search import clearances
from jaxkin.effects.clash_shapes import clash_parts, displaced
from jaxkin.effects.clashes import _case
from jaxkin.geometry.congruent import displacement
from jaxkin.geometry.part import Part, moved
from reference.drawn_parts import box, loaded

POSES = 7


def random_pose(generator, reach):
    pose = np.eye(4)
    pose[:3, :3] = Rotation.random(rng=generator).as_matrix()
    pose[:3, 3] = generator.uniform(-reach, reach, 3)
    return pose


def parts_and_poses():
    """Two brackets and three wedges, copies anywhere, and a path of each."""
    generator = np.random.default_rng(7)
    bracket = np.array((box([0, 0, 0], [20, 8, 3]) + box([0, 0, 3], [3, 8, 20])).triangles)
    wedge = np.array(trimesh.creation.cone(4, 9, sections=12).triangles)
    parts = [moved(Part(f"bracket {k}", (), bracket), random_pose(generator, 10)) for k in range(2)]
    parts += [moved(Part(f"wedge {k}", (), wedge), random_pose(generator, 10)) for k in range(3)]
    paths = [np.stack([random_pose(generator, 15) for _ in range(POSES)]) for _ in parts]
    for path in paths:  # the last poses are those of the first ones
        path[-2:] = path[:2]
    return parts, paths


def test_copies_are_found_and_mirrored_parts_are_none():
    parts, _ = parts_and_poses()
    found = clash_parts(parts)
    assert [each.shape.number for each in found] == [0, 0, 1, 1, 1]
    for each in found:
        corners = each.shape.part.triangles @ each.place[:3, :3].T + each.place[:3, 3]
        np.testing.assert_allclose(corners, each.part.triangles, atol=1e-12)  # of coordinates up to 30
    points = parts[0].triangles.reshape(-1, 3)
    assert displacement(points, points * [-1, 1, 1], 1e-6) is None
    assert displacement(points, points[:-1], 1e-6) is None
    assert displacement(points, points * 1.001, 1e-6) is None


def test_all_cases_at_once_are_as_each_by_itself():
    """The clearances of copies, whichever is named first, are those of the parts as they are, pose by pose."""
    parts, paths = parts_and_poses()
    shared, alone = clash_parts(parts), [clash_parts([part])[0] for part in parts]
    pairs = [(i, j) for i in range(5) for j in range(5) if i != j]
    cases = [_case(shared[i], shared[j], {}, 1e-6, paths[i], paths[j]) for i, j in pairs]
    distinct = distinct_cases(cases, 50.0)
    assert len(distinct.cases) == 10  # each pair is given in both orders
    assert all(len(case.moved.shift) == POSES - 2 for case in distinct.cases)
    measured = clearances(distinct.cases, 12.0, 1e-8)
    seen = []
    for (i, j), which, poses in zip(pairs, distinct.which, distinct.poses, strict=True):
        case = _case(alone[i], alone[j], {}, 1e-6, paths[i], paths[j])
        # the two meshes have one number each when they are prepared one by one
        (expected,) = clearances([case._replace(other=replace(case.other, number=1))], 12.0, 1e-8)
        np.testing.assert_allclose(measured[which][poses], expected, atol=1e-11)
        seen.append(expected)
    seen = np.concatenate(seen)
    assert (seen < 0).any() and np.isinf(seen).any() and ((seen > 0) & np.isfinite(seen)).any()


def test_copies_in_the_same_places_are_one_case():
    """Two arms alike turn past posts alike: every pair of the one side is a case of the other side, too."""
    parts, paths = parts_and_poses()
    place = random_pose(np.random.default_rng(1), 100)
    copies = [moved(part, place) for part in parts]
    both = clash_parts([*parts, *copies])
    back = np.linalg.inv(place)
    paths = [*paths, *(place @ path @ back for path in paths)]
    pairs = [(i, j) for i in range(5) for j in range(i)]
    cases = [_case(both[i + k], both[j + k], {}, 1e-6, paths[i + k], paths[j + k]) for k in (0, 5) for i, j in pairs]
    distinct = distinct_cases(cases, 100.0)
    assert len(distinct.cases) == 10 and distinct.which[:10] == distinct.which[10:]
    for i, j in pairs:  # to the rounding that makes two places one
        one, other = (displaced(both[i + o], both[j + o], paths[i + o], paths[j + o]) for o in (0, 5))
        np.testing.assert_allclose(one.rotation, other.rotation, atol=1e-9)


def test_a_motion_there_and_back_is_told_as_there(tmp_path):
    parts = {"wall": box([30, -20, -20], [60, 20, 20]), "slider": box([0, -5, -4], [20, 5, 4])}
    slide = jk.prismatic("slide", "wall", "slider", axis=(1, 0, 0))
    mechanism = loaded(tmp_path, parts).mechanism(fixed=["wall"], joints=[slide])
    there = np.linspace(0.0, 20.0, 9)
    found = jk.clashes(mechanism.sweep({"slide": np.concatenate([there, there[::-1]])}), within=6)
    np.testing.assert_array_equal(found.clearances[0], found.clearances[0][::-1])
    np.testing.assert_allclose(found.clearances[0][:9], np.where(10 - there > 6, np.inf, 10 - there), atol=1e-12)
