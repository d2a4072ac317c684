"""Faces that part while their surfaces stay in contact: against the detection of contacts in the displaced pose."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from jaxkin.contacts.detect import find_contacts
from jaxkin.contacts.hulls import PlaneMotion, gaps_between_hulls, hull
from jaxkin.contacts.separation import on_plane
from jaxkin.contacts.states import find_state
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.geometry.surfaces import Plane, Sphere
from jaxkin.joints.joint import joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.screws import displacements

LENGTH = 1e-4
"""Of the gallery at the scale of one: what counts as touching."""


def test_what_is_told_is_lost(pair, solids):
    """Faces moved by the movements of Table 2: where a gap is told, detection finds no contact of these faces."""
    (contact,) = find_contacts((solids.part("one", pair.face1), solids.part("two", pair.face2)), LENGTH)
    state = find_state(contact.state, contact.region)
    if state.gaps is None:
        assert contact.state in "iklmnop"
        return
    faces = [pair.face1, pair.face2] if contact.parts[0] == "one" else [pair.face2, pair.face1]
    held = joint("j", ("one", "two"), JointKind.of_state(state.letter), state.movements, contact.frames)
    names = [name for movement in state.movements for name in MOVEMENTS[movement].coordinates]
    rng = np.random.default_rng(5)
    reach = np.array([8.0 if is_length(name) else np.pi for name in names])
    moved = displacements(held, rng.uniform(-1, 1, (12, len(names))) * reach)
    gaps = state.gaps(*faces, moved)
    poses = np.concatenate([moved, np.tile([[[0.0], [0.0], [0.0], [1.0]]], (1, 1, 12))])
    for pose, gap in zip(np.moveaxis(poses, 2, 0), gaps, strict=True):
        there = (solids.part("one", faces[0]), solids.part("two", solids.moved(faces[1], pose)))
        found = [each for each in find_contacts(there, LENGTH) if each.state == contact.state]
        assert not (gap > LENGTH and found)
    if any(map(is_length, names)):
        assert gaps.max() > 1.0, "a face moved by its own size is off"


def test_nothing_is_told_of_the_assembled_pose(pair, solids):
    (contact,) = find_contacts((solids.part("one", pair.face1), solids.part("two", pair.face2)), LENGTH)
    state = find_state(contact.state, contact.region)
    if state.gaps is not None:
        faces = [pair.face1, pair.face2] if contact.parts[0] == "one" else [pair.face2, pair.face1]
        assert state.gaps(*faces, np.eye(4)[:3, :, None])[0] < 0


def random_polygon(rng, corners):
    return rng.normal(size=(corners, 2)) * rng.uniform(0.2, 2.0, 2)


@pytest.mark.parametrize(("corners1", "corners2"), [(3, 3), (8, 5), (40, 30), (30, 2), (30, 1)])
def test_hulls_are_apart_exactly_where_no_point_is_in_both(corners1, corners2):
    """A linear programme looks for weights of the corners of both that give one point."""
    rng = np.random.default_rng(corners1)
    first, second = random_polygon(rng, corners1), random_polygon(rng, corners2)
    angle, shift = rng.uniform(-np.pi, np.pi, 60), rng.normal(size=(2, 60)) * 2
    motion = PlaneMotion(np.stack([np.cos(angle), np.sin(angle)]), shift)
    one, other = (replace(hull(points), slack=0.0) for points in (first, second))
    gaps = gaps_between_hulls(one, other, motion)
    apart = []
    for k in range(60):
        turn = np.array([[np.cos(angle[k]), -np.sin(angle[k])], [np.sin(angle[k]), np.cos(angle[k])]])
        there = second @ turn.T + shift[:, k]
        weights = np.block(
            [[first.T, -there.T], [np.ones(corners1), np.zeros(corners2)], [np.zeros(corners1), np.ones(corners2)]]
        )
        apart.append(linprog(np.zeros(corners1 + corners2), A_eq=weights, b_eq=[0, 0, 1, 1]).status == 2)
        nearest = np.linalg.norm(first[:, None] - there[None], axis=-1).min()
        assert gaps[k] < nearest + 1e-12
    np.testing.assert_array_equal(gaps > 0, apart)
    assert 10 < np.sum(apart) < 50


def test_the_order_of_the_poses_does_not_matter():
    """A long range is decided from a few of its poses, a shuffled one pose by pose."""
    rng = np.random.default_rng(3)
    one, other = hull(random_polygon(rng, 30)), hull(random_polygon(rng, 12))
    t = np.linspace(0, 20, 5000)
    motion = PlaneMotion(np.stack([np.cos(t), np.sin(t)]), np.stack([9 * np.sin(t / 3), 6 * np.cos(t / 2)]))
    order = rng.permutation(len(t))
    gaps, shuffled = (gaps_between_hulls(one, other, each) for each in (motion, motion.at(order)))
    np.testing.assert_array_equal(gaps[order] > 0, shuffled > 0)
    lost = gaps > 0
    assert 500 < lost.sum() < 4500
    np.testing.assert_allclose(gaps[order][lost[order]], shuffled[lost[order]], atol=1e-14)  # rounding


@pytest.mark.parametrize("turn", [0.1, 0.3])
def test_a_round_outline_in_chords_is_not_called_off_too_early(turn):
    """A disc in chords against a half plane: its true rim stands out of the chords by 1 - cos(turn / 2)."""
    angles = np.arange(0, 2 * np.pi - turn / 2, turn)
    disc = hull(np.stack([np.cos(angles), np.sin(angles)], axis=-1))
    table = hull(np.array([[-5.0, -5.0], [0.0, -5.0], [0.0, 5.0], [-5.0, 5.0]]))
    assert table.slack == 0.0
    x = np.linspace(0.9, 1.1, 201)
    spin = np.linspace(0, turn, 201)
    motion = PlaneMotion(np.stack([np.cos(spin), np.sin(spin)]), np.stack([x, 0 * x]))
    gaps = gaps_between_hulls(table, disc, motion)
    assert np.all(gaps <= np.maximum(x - 1, 0) + 1e-12)
    assert np.all(gaps[x > 1.06] > 0)


def fan(ring):
    """The corners of triangles over a convex ring of points."""
    ring = np.asarray(ring, float)
    return np.concatenate([ring[[0, k, k + 1]] for k in range(1, len(ring) - 1)])


def arc(start, end, chords):
    angles = np.linspace(start, end, chords + 1)
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


@pytest.mark.parametrize(
    "corners",
    [
        # flats of 30 degrees: a chamfer, a gable
        fan([(0, 0), (20, 0), (20, 10), (5, 10), (0, 10 - 5 * np.tan(np.pi / 6))]),
        fan([(0, 0), (20, 0), (20, 10), (10, 10 + 10 * np.tan(np.pi / 6)), (0, 10)]),
        # a T, beside whose leg the hull leaves the rim by 18 degrees
        np.concatenate([fan([(0, 0), (9, 0), (9, 1), (0, 1)]), fan([(3, -1), (6, -1), (6, 0), (3, 0)])]),
    ],
)
def test_straight_edges_are_no_chords(corners):
    assert hull(corners, of_triangles=True).slack == 0.0


@pytest.mark.parametrize("turn", [0.05, 0.3])
@pytest.mark.parametrize(
    "ring",
    [
        lambda turn: arc(0, 2 * np.pi - turn, round(2 * np.pi / turn) - 1),  # a disc
        lambda turn: arc(0, np.pi, round(np.pi / turn)),  # a half disc
        lambda turn: arc(-turn, turn, 2),  # a segment of two chords
        lambda turn: [(-9, -9), (1, -9), *arc(0, np.pi / 2, round(np.pi / 2 / turn)), (-9, 1)],  # a fillet
        # one chord between tangents
        lambda turn: [(1, -9), *arc(0, turn, 1), (np.cos(turn) - 9 * np.sin(turn), np.sin(turn) + 9 * np.cos(turn))],
    ],
)
def test_chords_of_an_arc_are(ring, turn):
    """An arc of radius 1 is 1 - cos(turn / 2) high over its chords, of about this turn."""
    corners = fan(ring(turn))
    assert hull(corners, of_triangles=True).slack > 0.9 * (1 - np.cos(turn / 2))


def test_points_on_a_line_have_no_hull():
    assert hull(np.array([[0.0, 0], [1, 0], [2, 0], [3, 0]])) is None


def test_a_ball_that_rolls_by_a_quarter_is_as_near_as_before(solids):
    """Whichever of its directions stands on the plane: exact quarter turns about x, y and z through its centre."""
    x, z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    table = solids.patch(Plane(0.0 * z, z), (-3, 3), (-3, 3), x)
    ball = solids.patch(Sphere(z, 1.0, 1), (0, 2 * np.pi), (-1.5, 1.5), axis=x)
    turns = np.array([np.eye(3), [[1, 0, 0], [0, 0, -1], [0, 1, 0]], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]])
    moved = np.concatenate([turns, (z - turns @ z)[:, :, None]], axis=2).transpose(1, 2, 0)
    np.testing.assert_array_equal(on_plane(table, ball, moved), on_plane(table, ball, moved[..., :1])[0])
