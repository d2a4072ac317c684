"""The way of several inputs: through all poses, smooth, and never far from either of two poses."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jaxkin.solve.continuation.input_path import curve_through

POSES = 12
values = st.lists(st.sampled_from([-2.0, -0.5, 0.0, 0.3, 1.0, 1.1, 4.0]), min_size=POSES, max_size=POSES)


def _sampled(inputs, here):
    at, way = curve_through(inputs)
    return (at, *way(here(at)))


@jax.jit
def at_poses(inputs):
    return _sampled(inputs, lambda at: at)


@jax.jit
def between(inputs):
    """At a hundred places of each stretch, the first from the assembled pose."""

    def here(at):
        begin = jnp.concatenate([jnp.zeros(1), at[:-1]])
        return (begin[:, None] + (at - begin)[:, None] * jnp.linspace(0.0, 1.0, 101)[:-1]).ravel()

    return _sampled(inputs, here)


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(values, values)
def test_it_goes_through_all_poses_and_leaves_the_range_of_two_by_little(one, other):
    inputs = jnp.array([one, other])
    at, found, _ = at_poses(inputs)
    assert np.all(np.diff(at) >= 0)
    # a stretch's cubic is a sum of terms of the size of its inputs
    np.testing.assert_allclose(found, inputs, atol=1e-14)
    corners = np.concatenate([np.zeros((2, 1)), inputs], axis=1)
    stride = np.pad(np.abs(np.diff(corners, axis=1)), [(0, 0), (1, 1)])
    near = np.maximum(stride[:, 1:-1], np.maximum(stride[:, :-2], stride[:, 2:]))
    _, along, _ = between(inputs)
    ends = np.stack([corners[:, :-1], corners[:, 1:]])[..., None]
    along = np.asarray(along).reshape(2, POSES, 100)
    beyond = np.max(np.maximum(ends.min(axis=0) - along, along - ends.max(axis=0)), axis=-1)
    # from both of its ends a cubic may leave its range by 4/27 of the slope there times its width
    assert np.all(beyond <= 8 / 27 * near + 1e-14)


@jax.jit
def fifty(inputs):
    """At fifty places of the whole."""
    at, way = curve_through(inputs)
    here = jnp.linspace(0.0, at[-1], 50)
    return (here, *way(here))


def test_it_is_a_straight_line_where_the_poses_are_on_one():
    """Exactly so where they are equally far apart, and at any distance for its direction at the poses."""
    inputs = jnp.outer(jnp.array([1.0, -3.0]), jnp.array([0.1, 0.5, 0.6, 2.0]))
    here, found, direction = fifty(inputs)
    np.testing.assert_allclose(found, jnp.outer(jnp.array([1.0, -3.0]), here) / jnp.sqrt(10.0), atol=1e-14)
    np.testing.assert_allclose(direction, jnp.array([[1.0], [-3.0]]) / jnp.sqrt(10.0) * jnp.ones(50), atol=1e-14)


def test_its_direction_is_its_derivative_and_has_no_leaps():
    inputs = jnp.asarray(np.random.default_rng(0).normal(size=(3, 8)))

    @jax.jit
    def directions(inputs):
        at, way = curve_through(inputs)
        here = jnp.linspace(0.0, at[-1] - 1e-9, 101)
        differentiated = jax.jvp(lambda here: way(here)[0], (here,), (jnp.ones_like(here),))[1]
        return differentiated, way(here)[1], way(at[:-1] + 1e-9)[1], way(at[:-1] - 1e-9)[1]

    differentiated, direction, behind, before = directions(inputs)
    np.testing.assert_allclose(differentiated, direction, atol=1e-13)
    np.testing.assert_allclose(behind, before, atol=1e-6)  # 2e-9 times second derivatives of some tens


@pytest.mark.long
def test_poses_that_repeat_are_passed_without_a_stop():
    once = jnp.array([[0.2, 0.4, 0.6], [0.1, 0.3, 0.2]])
    twice = jnp.repeat(once, 2, axis=1)
    (at, _, direction), (at_twice, _, direction_twice) = at_poses(once), at_poses(twice)
    np.testing.assert_array_equal(at_twice[::2], at)
    for each in (direction, direction_twice):
        # the chords have length one by their unit
        assert np.all(np.linalg.norm(each, axis=0) > 0.5)
