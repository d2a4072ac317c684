"""Splines of curves against scipy's, in numpy and in JAX, and counted from another contact."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from jaxkin.geometry.curves import Curve
from jaxkin.geometry.movements import displaced
from jaxkin.geometry.rigid import as_matrices, as_rigid
from jaxkin.joints.screws import chain

Q = np.linspace(-9.0, 12.0, 60)
"""Several times around the closed curve, and beyond both ends of the open one."""


def curve(closed, start=2.3, place=(0.4, -0.2, 0.7)):
    turn = np.sort(np.random.default_rng(0).uniform(0, 6, 9))
    points = np.stack([3 * np.cos(turn), 2 * np.sin(turn) + 0.1 * turn], axis=1)
    return Curve(points, np.asarray(start), np.asarray(place), closed)


def by_scipy(given, s, derivative=0):
    points = np.vstack([given.points, given.points[:1]]) if given.closed else given.points
    knots = np.append(0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    spline = CubicSpline(knots, points, bc_type="periodic" if given.closed else "not-a-knot")
    return spline(s % knots[-1] if given.closed else s, derivative)


@pytest.mark.parametrize("closed", [True, False])
def test_the_spline_is_that_of_scipy_over_the_chords(closed):
    given = curve(closed, place=(0.0, 0.0, 0.0))
    spline = given.spline()
    at, s = spline.at(Q), spline.start + Q
    # rounding of cubics that go on far beyond the ends of the open curve
    close = {"rtol": 1e-12, "atol": 1e-12}
    np.testing.assert_allclose(np.stack([at.x, at.y], axis=1), by_scipy(given, s), **close)
    first, second = by_scipy(given, s, 1), by_scipy(given, s, 2)
    np.testing.assert_allclose(np.stack([at.dx, at.dy], axis=1), first, **close)
    turning = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / np.sum(first**2, axis=1)
    np.testing.assert_allclose(at.turning, turning, rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(np.arctan2(at.sin, at.cos), np.arctan2(first[:, 1], first[:, 0]), **close)


@pytest.mark.long
@pytest.mark.parametrize("closed", [True, False])
def test_in_jax_it_is_the_same(closed):
    given = curve(closed)
    found = jax.jit(lambda given, q: given.spline(jnp).at(q, jnp))(given, jnp.asarray(Q))
    for one, other in zip(given.spline().at(Q), found, strict=True):
        np.testing.assert_allclose(other, one, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("q", [1.7, -3.0, 5.0])  # behind the ends of the open curve too
def test_counted_from_another_contact_it_is_the_same_curve_in_a_frame_there(closed, q):
    given = curve(closed)
    here, there, moved = given.spline(), given.counted_from(q).spline(), given.spline().at(np.array(q))
    at, wanted = there.at(Q), here.at(Q + q)
    x, y = moved.x + moved.cos * at.x - moved.sin * at.y, moved.y + moved.sin * at.x + moved.cos * at.y
    np.testing.assert_allclose([x, y], [wanted.x, wanted.y], rtol=1e-11, atol=1e-11)
    assert there.begins_at_contact and not here.begins_at_contact


@pytest.mark.long
@pytest.mark.parametrize("closed", [True, False])
def test_derivatives_with_respect_to_points_are_differences(closed):
    given = curve(closed)

    @jax.jit
    def ends(points):
        at = Curve(points, given.start, given.place, closed).spline(jnp).at(jnp.asarray(Q[20:40]), jnp)
        return jnp.sum(at.x * jnp.arange(20) + at.turning)

    direction = np.random.default_rng(1).normal(size=given.points.shape)
    step = 1e-6
    differences = (ends(given.points + step * direction) - ends(given.points - step * direction)) / (2 * step)
    found = jnp.sum(jax.jit(jax.grad(ends))(jnp.asarray(given.points)) * direction)
    # the square of the step, and rounding over the step
    assert float(found) == pytest.approx(float(differences), rel=1e-7)


@pytest.mark.long
@pytest.mark.parametrize("closed", [True, False])
def test_a_frame_travels_along_the_curve_with_x_along_the_tangent(closed):
    """T_s is a translation by the point of the spline and a turn to its tangent; T_s_back is the inverse of T_s."""
    given = curve(closed, place=(0.0, 0.0, 0.0))
    s = float(given.spline().start) + Q
    point, tangent = by_scipy(given, s), by_scipy(given, s, 1)
    angle = np.arctan2(tangent[:, 1], tangent[:, 0])
    wanted = np.tile(np.eye(4), (len(Q), 1, 1))
    wanted[:, 0, 0] = wanted[:, 1, 1] = np.cos(angle)
    wanted[:, 1, 0], wanted[:, 0, 1] = np.sin(angle), -np.sin(angle)
    wanted[:, :2, 3] = point
    identity = as_rigid(jnp.eye(4))
    for movement, matrices in (("T_s", wanted), ("T_s_back", np.linalg.inv(wanted))):
        moved = as_matrices(displaced(identity, movement, jnp.asarray(Q)[None], 0.0, given))
        # rounding of cubics that go on far beyond the ends of the open curve
        np.testing.assert_allclose(moved, matrices, rtol=1e-12, atol=1e-11)
        for q, matrix in zip(Q[20:30], matrices[20:30], strict=True):
            step, splines = 1e-6, (given.spline(),)
            pose, screw = chain([movement], np.eye(4)[None], np.array([q]), splines=splines)
            np.testing.assert_allclose(pose, matrix, atol=1e-12)
            ends = [chain([movement], np.eye(4)[None], np.array([q + by]), splines=splines)[0] for by in (-step, step)]
            twist = (ends[1] - ends[0]) / (2 * step) @ np.linalg.inv(pose)
            found = [twist[2, 1], twist[0, 2], twist[1, 0], *twist[:3, 3]]
            np.testing.assert_allclose(screw[:, 0], found, atol=1e-7)  # differences
