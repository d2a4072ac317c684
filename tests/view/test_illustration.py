import numpy as np
import pytest

from jaxkin.view.camera import View
from jaxkin.view.illustration import PAPER, SUPERSAMPLING, Canvas, backdrop, compose, draw

FRONT = View(np.eye(3), planar=True)
CANVAS = Canvas(FRONT, corner=np.array([0.0, 8.0, 0.0]), scale=10.0, height=80, width=120)  # x in 0..12, y in 0..8
RED, BLUE = (0.8, 0.2, 0.1), (0.1, 0.2, 0.8)


def plate(low, high, z):
    """A rectangle that faces the viewer."""
    corners = np.array([[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]], float)
    return corners[[[0, 1, 2], [0, 2, 3]]]


def at(image, x, y):
    """The colour of the picture at a point of the view."""
    return image[int((8 - y) * 10), int(x * 10)] / 255


def test_a_plate_is_where_the_canvas_says_and_keeps_its_colour():
    layer = draw(CANVAS, [plate([2, 3], [7, 5], 0)], [RED])
    rows, columns = np.nonzero(layer.present)
    assert layer.present.sum() == 50 * 20 * SUPERSAMPLING**2
    assert np.allclose([columns.mean() + 0.5, rows.mean() + 0.5], np.array([45, 40]) * SUPERSAMPLING)
    assert np.allclose(layer.color[layer.present], RED) and np.allclose(layer.color[~layer.present], PAPER)


def test_lines_run_around_parts_and_along_creases_but_not_between_triangles():
    roof = np.array(
        [[[2, 2, 0], [6, 2, 0], [2, 4, 2]], [[6, 2, 0], [6, 4, 2], [2, 4, 2]]], float
    )  # rises at 45 degrees
    both = np.concatenate([roof, roof * [1, -1, 1] + [0, 8, 0]])  # and falls again from y = 4
    layer = draw(CANVAS, [both], [RED])
    middle = np.argwhere(layer.crease)[:, 0]
    assert np.abs(middle + 0.5 - 40 * SUPERSAMPLING).max() <= 1  # the ridge
    assert not layer.outline[25 * SUPERSAMPLING : 55 * SUPERSAMPLING, 25 * SUPERSAMPLING : 55 * SUPERSAMPLING].any()
    assert (
        layer.outline[40 * SUPERSAMPLING, 20 * SUPERSAMPLING]
        and layer.outline[40 * SUPERSAMPLING, 60 * SUPERSAMPLING - 1]
    )


def test_a_step_within_a_part_is_a_line():
    layer = draw(CANVAS, [np.concatenate([plate([2, 2], [8, 6], 0), plate([4, 2], [6, 6], 1)])], [RED])
    columns = np.unique(np.nonzero(layer.crease)[1])
    assert {round(column / SUPERSAMPLING / 10) for column in columns} == {4, 6}


def test_moving_parts_cover_fixed_ones_and_shine_through_where_they_are_covered():
    fixed = draw(CANVAS, [plate([1, 1], [11, 4], 1)], [(0.9, 0.9, 0.9)])
    over, under = draw(CANVAS, [plate([3, 2], [5, 7], 2)], [RED]), draw(CANVAS, [plate([7, 2], [9, 7], 0)], [BLUE])
    nothing = draw(CANVAS, [], [])
    above, below = (compose(backdrop(fixed, nothing), fixed, each) for each in (over, under))
    assert np.allclose(at(above, 4, 3), RED, atol=0.01) and np.allclose(at(above, 4, 6), RED, atol=0.01)
    assert np.allclose(at(below, 8, 6), BLUE, atol=0.01)
    shining = at(below, 8, 3)
    assert at(below, 10, 3)[0] - 0.35 < shining[0] < at(below, 10, 3)[0] - 0.1  # some blue in the grey
    assert shining[2] > shining[0]
    assert np.allclose(at(above, 6, 6), PAPER)


def test_a_ghost_is_only_an_outline_and_behind_all_that_moves():
    nothing = draw(CANVAS, [], [])
    ghost, part = draw(CANVAS, [plate([2, 2], [6, 6], 0)], [BLUE]), draw(CANVAS, [plate([4, 1], [10, 7], 0)], [RED])
    image = compose(backdrop(nothing, ghost), nothing, part)
    assert np.allclose(at(image, 3, 4), PAPER)
    assert 0.6 < at(image, 2.0, 4)[0] < 0.95
    assert np.allclose(at(image, 6.0, 4), RED, atol=0.01)


def test_what_lies_below_an_edge_is_in_its_shadow():
    low, high = draw(CANVAS, [plate([0, 0], [12, 8], 0)], [PAPER]), draw(CANVAS, [plate([4, 3], [8, 5], 1)], [RED])
    image = compose(backdrop(low, draw(CANVAS, [], [])), low, high)
    near, far = image[40, 84:88].mean(), image[4:8, 110:116].mean()
    assert near < far - 3


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_picture_is_the_same_in_another_unit(scale):
    triangles = np.random.default_rng(0).uniform([0, 0, 0], [12, 8, 3], (20, 3, 3))
    other = Canvas(FRONT, CANVAS.corner * scale, CANVAS.scale / scale, CANVAS.height, CANVAS.width)
    one, two = draw(CANVAS, [triangles], [RED]), draw(other, [triangles * scale], [RED])
    assert np.mean(one.color != two.color) < 1e-4  # a pixel's centre on an edge may fall to either side
