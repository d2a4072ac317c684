"""Shared areas, intervals and boxes against closed forms and brute force."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaxkin.contacts import intervals
from jaxkin.contacts.boxes import crossing, overlapping
from jaxkin.contacts.overlap import overlap, overlap_on_sphere
from jaxkin.contacts.rim import chord_height
from jaxkin.contacts.unrolled import turned, unrolled
from jaxkin.geometry.surfaces import Cone, Cylinder, Sphere

X, Y, Z = np.eye(3)
TURN = (-np.pi, np.pi)


def rectangle(x, y, width, height):
    """Two triangles."""
    a, b, c, d = np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]], float)
    return np.array([[a, b, c], [a, c, d]])


sides = st.floats(0.1, 3)
places = st.floats(-3, 3)


@settings(max_examples=40, deadline=None)
@given(places, places, sides, sides, st.floats(0, np.pi))
def test_rectangles_share_a_rectangle(x, y, width, height, angle):
    shares = np.maximum(np.minimum([1, 1], [x + width, y + height]) - np.maximum([0, 0], [x, y]), 0)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    shared = overlap(rectangle(0, 0, 1, 1) @ turn.T, rectangle(x, y, width, height) @ turn.T, 1e-12)
    area = 0.0 if shared is None else shared.area
    assert area == pytest.approx(np.prod(shares), abs=1e-9)
    if np.prod(shares) > 1e-3:
        middle = (np.minimum([1, 1], [x + width, y + height]) + np.maximum([0, 0], [x, y])) / 2
        np.testing.assert_allclose(shared.centre, turn @ middle, atol=1e-8)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_triangles_share_what_random_points_share(seed):
    rng = np.random.default_rng(seed)
    a, b = rng.uniform(0, 1, (2, 1, 3, 2))
    points = rng.uniform(0, 1, (20_000, 2))

    def inside(triangle):
        edges = np.roll(triangle, -1, axis=0) - triangle
        offset = points[:, None] - triangle
        left = edges[:, 0] * offset[..., 1] - edges[:, 1] * offset[..., 0]
        return np.all(left > 0, axis=1) | np.all(left < 0, axis=1)

    shared, mirrored = overlap(a, b, 1e-12), overlap(b, a, 1e-12)
    area = 0.0 if shared is None else shared.area
    assert area == pytest.approx(0.0 if mirrored is None else mirrored.area, abs=1e-12)
    assert area == pytest.approx((inside(a[0]) & inside(b[0])).mean(), abs=0.02)  # 5 standard deviations


@pytest.mark.parametrize("steps", [12, 31])
def test_unrolled_areas_are_exact_for_any_tessellation(solids, steps):
    bore = solids.patch(Cylinder(np.zeros(3), Z, 2.0, -1), TURN, (0, 3), steps=24).triangles
    pin = solids.patch(Cylinder(np.zeros(3), Z, 2.0, 1), (1, 4), (2, 5), steps=steps).triangles  # across the seam
    charts = [unrolled(triangles, np.zeros(3), Z, 2.0) for triangles in (bore, pin)]
    assert overlap(charts[0], turned(charts[1], 2.0), 1e-12).area == pytest.approx(2.0 * 3 * 1, rel=1e-9)
    seat = solids.patch(Cone(np.zeros(3), Z, 0.5, -1), TURN, (0, 2)).triangles  # with its apex
    plug = solids.patch(Cone(np.zeros(3), Z, 0.5, 1), TURN, (0, 1.5), steps=steps).triangles
    charts = [unrolled(triangles, np.zeros(3), Z, 1.0) for triangles in (seat, plug)]
    assert overlap(charts[0], turned(charts[1], 1.0), 1e-12).area == pytest.approx(2 * np.pi * 1.5, rel=1e-9)


def test_areas_on_a_sphere(solids):
    """Against the closed form; the triangles lie askew to each other, with a pole of one inside the other."""
    whole = solids.patch(Sphere(X, 2.0, 1), TURN, (-np.pi / 2, np.pi / 2), axis=Y).triangles
    zone = solids.patch(Sphere(X, 2.0, -1), TURN, (0.3, np.pi / 2), steps=40).triangles
    shared = overlap_on_sphere(whole, zone, X, 2.0, 1e-9)
    # the great circles between the corners at latitude 0.3 run closer to the pole than the parallel: below 1 %
    assert shared.area == pytest.approx(2 * np.pi * 4.0 * (1 - np.sin(0.3)), rel=0.01)
    np.testing.assert_allclose(
        shared.box[1] - shared.box[0], [4 * np.cos(0.3), 4 * np.cos(0.3), 2 - 2 * np.sin(0.3)], rtol=0.03
    )


def test_chords_of_a_rim_are_as_high_as_the_arc_over_them(solids):
    hole = solids.patch(Cylinder(np.zeros(3), Z, 2.0, -1), TURN, (0, 1), steps=20).triangles
    assert chord_height(hole, np.subtract) == pytest.approx(2 * (1 - np.cos(np.pi / 20)), rel=0.02)
    square = np.concatenate([rectangle(0, 0, 1, 2), np.zeros((2, 3, 1))[..., :0]], axis=-1)
    square = np.concatenate([square, np.zeros((2, 3, 1))], axis=-1)
    assert chord_height(square, np.subtract) == 0.0


interval_sets = st.lists(st.tuples(st.integers(0, 30), st.integers(1, 5)), max_size=8)


@given(interval_sets, interval_sets)
def test_intervals_are_sets(first, second):
    """Against sets of unit cells."""
    a, b = (np.array([(x, x + n) for x, n in pairs], float).reshape(-1, 2) for pairs in (first, second))
    cells = [{x + k for x, n in pairs for k in range(n)} for pairs in (first, second)]
    a, b = intervals.union(a, 0.0), intervals.union(b, 0.0)
    assert intervals.length(a) == len(cells[0])
    assert np.all(a[1:, 0] > a[:-1, 1])
    shared = intervals.intersection(a, b)
    assert intervals.length(shared) == len(cells[0] & cells[1])
    if len(shared):
        assert intervals.centroid(shared) == pytest.approx(np.mean(list(cells[0] & cells[1])) + 0.5)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(0, 40), st.floats(0, 0.5))
def test_boxes_meet_as_all_with_all(seed, count, margin):
    rng = np.random.default_rng(seed)
    lows = rng.uniform(-5, 5, (count, 3)) * rng.permutation([1, 1, 0.1])
    sizes = rng.exponential(1, (count, 3)) * 10 ** rng.uniform(-6, 1, (count, 1)) * rng.integers(0, 2, (count, 1))
    boxes = np.stack([lows, lows + sizes], axis=1)  # of very different sizes, some of them points

    def meet(a, b):
        return bool(np.all(a[0] <= b[1] + margin) and np.all(b[0] <= a[1] + margin))

    expected = [(i, j) for i in range(count) for j in range(i + 1, count) if meet(boxes[i], boxes[j])]
    assert [tuple(pair) for pair in overlapping(boxes, margin)] == expected
    half = count // 2
    expected = [(i, j - half) for i in range(half) for j in range(half, count) if meet(boxes[i], boxes[j])]
    assert [tuple(pair) for pair in crossing(boxes[:half], boxes[half:], margin)] == expected
