import numpy as np
import pytest

from jaxkin.view.raster import normals, rasterise


def _by_hand(triangles, height, width):
    """Barycentric coordinates of every pixel's centre in every triangle, and the least margin to an edge."""
    y, x = np.mgrid[:height, :width] + 0.5
    best, owner = np.full((height, width), -1e9), np.full((height, width), -1)
    margin = np.full((height, width), np.inf)
    for index, triangle in enumerate(triangles):
        (a, b, c), area = triangle, np.linalg.det(triangle[1:, :2] - triangle[0, :2])
        u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        weights = np.stack([1 - u - v, u, v])
        inside = (weights >= 0).all(axis=0)
        depth = np.where(inside, np.tensordot([a[2], b[2], c[2]], weights, 1), -1e9)
        # How far two depths are apart counts as well: equal ones may be won by either triangle.
        margin = np.minimum(margin, np.abs(weights).min(axis=0))
        margin = np.where(inside, np.minimum(margin, np.abs(depth - best)), margin)
        owner, best = np.where(depth > best, index, owner), np.maximum(best, depth)
    return owner, best, margin


@pytest.mark.parametrize("seed", range(5))
def test_every_pixel_shows_the_triangle_in_front(seed):
    height, width = 40, 60
    triangles = np.random.default_rng(seed).uniform([-20, -20, -9], [80, 60, 9], (12, 3, 3))  # some reach outside
    owner, depth, margin = _by_hand(triangles, height, width)
    raster = rasterise(triangles, height, width)
    clear = margin > 1e-5  # depths are float32: 1e-6 of 9
    assert clear.mean() > 0.9
    assert np.array_equal(raster.triangle[clear], owner[clear])
    hit = clear & (owner >= 0)
    assert np.allclose(raster.depth[hit], depth[hit], atol=1e-5)


def test_triangles_that_share_an_edge_leave_no_gap_and_do_not_overlap():
    rng = np.random.default_rng(3)
    inner, square = rng.uniform(5, 35, 2), np.array([[2.0, 3.0], [37.0, 3.0], [37.0, 36.0], [2.0, 36.0]])
    fan = [[[*inner, 0], [*square[i - 1], 0], [*square[i], 0]] for i in range(4)]
    covered = [rasterise(np.array([part]), 40, 40).triangle >= 0 for part in fan]
    count = np.sum(covered, axis=0)
    assert count.max() == 1 and count.sum() == 35 * 33


def test_two_plates_that_cross_are_seen_on_either_side_of_the_line_where_they_meet():
    def plate(slope):
        corners = np.array([[x, y, slope * (x - 20)] for x, y in ((0, 0), (40, 0), (40, 30), (0, 30))], float)
        return corners[[[0, 1, 2], [0, 2, 3]]]

    owner = rasterise(np.concatenate([plate(0.5), plate(-0.2)]), 30, 40).triangle
    assert set(owner[:, :20].ravel()) == {2, 3} and set(owner[:, 20:].ravel()) == {0, 1}


def test_a_triangle_on_edge_or_outside_or_none_shows_nothing():
    upright = np.array([[[3.0, 3, 0], [17, 11, 0], [10, 7, 9]]])  # holds the line of sight
    assert (rasterise(upright, 20, 20).triangle == -1).all()
    assert (rasterise(upright + [100.0, 0, 0], 20, 20).triangle == -1).all()
    assert np.isneginf(rasterise(np.zeros((0, 3, 3)), 20, 20).depth).all()


def test_many_pixels_are_filled_in_batches(monkeypatch):
    triangles = np.random.default_rng(0).uniform(0, 50, (30, 3, 3))
    whole = rasterise(triangles, 50, 50)
    monkeypatch.setattr("jaxkin.view.raster.BATCH", 97)
    assert np.array_equal(rasterise(triangles, 50, 50).triangle, whole.triangle)


def test_normals_face_the_viewer_whichever_way_a_triangle_is_wound():
    triangle = np.array([[0.0, 0, 0], [4, 0, 3], [0, 1, 0]])  # a plane that rises 3 over 4
    for wound in (triangle, triangle[::-1]):
        assert np.allclose(normals(wound[None]), [[-0.6, 0, 0.8]])
