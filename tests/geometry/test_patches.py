"""Bicubic splines through a grid of points, and the surface at a height over them."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.patches import bicubic, patch_point
from jaxkin.joints.patch_contact import placed_patch


def plane(u, v):
    return u, v, 0.3 * u - 0.2 * v


def torus(u, v, ring=24.0, tube=10.0):
    far = ring + tube * np.cos(v)
    return far * np.cos(u), far * np.sin(u), tube * np.sin(v)


FULL = (0.0, 2 * np.pi)


def test_the_offset_surface_and_its_derivatives():
    """In the arithmetic of Python as in numpy: the point at a height along the normal, by central differences."""
    rng = np.random.default_rng(1)
    table = rng.normal(size=(4, 4, 3)) * 0.2
    table[1, 0, 0], table[0, 1, 1] = 1.0, 1.0

    def at(s, t):
        found = patch_point(bicubic(table, s, t), 0.3, np.sqrt)
        return np.array(found[:3]), np.array(found[3:6]), np.array(found[6:])

    step = 1e-5
    _, by_s, by_t = at(0.2, 0.4)
    np.testing.assert_allclose(by_s, (at(0.2 + step, 0.4)[0] - at(0.2 - step, 0.4)[0]) / (2 * step), atol=1e-9)
    np.testing.assert_allclose(by_t, (at(0.2, 0.4 + step)[0] - at(0.2, 0.4 - step)[0]) / (2 * step), atol=1e-9)
    joints = jk.surface_points(plane, (0, 1), (0, 1), samples=(4, 4))  # every plane has its own normal
    flat = jk.point_on_surface("c", "a", "b", surface=joints, point2=(0.5, 0.5, 3.0), radius=1.0).curves[0]
    found = np.array(flat.spline().at(0.25, 0.5))
    moved = np.array([0.25 / np.hypot(1, 0.3), 0.5 / np.hypot(1, 0.2), 0.0])
    np.testing.assert_allclose(found[:3], [*moved[:2], plane(*moved[:2])[2]], atol=1e-14)
    surface, off = bicubic(table, 0.2, 0.4), at(0.2, 0.4)[0]
    assert np.linalg.norm(off - np.array(surface.point)) == pytest.approx(0.3, rel=1e-14)


@pytest.mark.parametrize("closed", [(True, True), (True, False), (False, False)])
def test_the_spline_passes_its_points_and_is_smooth(closed):
    ends = [2 * np.pi if each else 4.5 for each in closed]
    points = jk.surface_points(torus, (0, ends[0]), (0, ends[1]), closed=closed, samples=(24, 16))
    spline = placed_patch("contact", points, closed).spline
    u, v = (np.asarray(knots) for knots in spline.knots)
    u, v = u[: len(points)], v[: points.shape[1]]
    at = spline.derivatives(u[:, None], v[None])
    np.testing.assert_allclose(np.stack(at.point, -1), points, atol=1e-12)
    # from both sides of an inner knot the same point, slopes and bends
    for k in range(6):
        sides = [spline.derivatives(u[5] + side, v[3] + 0.4)[k] for side in (-1e-9, 1e-9)]
        np.testing.assert_allclose(*sides, atol=1e-6)
    again = spline.derivatives(1.0 + (spline.periods[0] or 0.0), 2.0 + (spline.periods[1] or 0.0))
    np.testing.assert_allclose(again.point, spline.derivatives(1.0, 2.0).point, atol=1e-12)
