import math

import jax
import jax.numpy as jnp
import mpmath
import numpy as np
import pytest

from jaxkin.geometry.trig import angle, cos_and_sin, cos_sin, known_cos_and_sin

EPS = np.finfo(float).eps
compiled = jax.jit(cos_sin)


def off(angles, found) -> float:
    """Largest difference from cosine and sine with fifty digits."""
    with mpmath.workdps(50):
        exact = [(mpmath.cos(mpmath.mpf(float(a))), mpmath.sin(mpmath.mpf(float(a)))) for a in angles]
        return max(
            abs(float(mpmath.mpf(float(got)) - wanted[which]))
            for which, rows in enumerate(found)
            for got, wanted in zip(rows, exact, strict=True)
        )


@pytest.mark.long
@pytest.mark.parametrize("farthest", [1.0, 10.0, 1e4, 1.5e6])
def test_of_any_angles_down_to_rounding(farthest):
    # half a unit in the last place is EPS / 4; the sums of the series round a few times more
    angles = np.random.default_rng(0).uniform(-farthest, farthest, 400)
    assert off(angles, compiled(jnp.asarray(angles))) < EPS


@pytest.mark.long
def test_at_whole_eighths_of_a_turn():
    angles = np.arange(-40, 41) * (math.pi / 4)
    assert off(angles, compiled(jnp.asarray(angles))) < EPS


@pytest.mark.long
def test_far_away_within_what_the_angle_is_known_to():
    angles = np.random.default_rng(0).uniform(1e7, 1e9, 100)
    assert off(angles, compiled(jnp.asarray(angles))) < np.max(np.spacing(angles))


def test_of_no_finite_angle_there_is_none():
    cos, sin = compiled(jnp.array([jnp.nan, jnp.inf, -jnp.inf]))
    assert bool(jnp.all(jnp.isnan(cos) & jnp.isnan(sin)))


@pytest.mark.parametrize(
    "both",
    [
        lambda x: cos_sin(x[None])[:, 0],
        lambda x: jnp.stack(cos_and_sin(x)),
        lambda x: jnp.stack(known_cos_and_sin(x, (jnp.cos(2.3), jnp.sin(2.3)))),
    ],
)
def test_derivatives_are_those_of_cosine_and_sine(both):
    x = jnp.asarray(2.3)
    once, twice = jax.jit(jax.jacfwd(both))(x), jax.jit(jax.jacrev(jax.jacfwd(both)))(x)
    np.testing.assert_allclose(once, [-math.sin(2.3), math.cos(2.3)], atol=EPS)
    np.testing.assert_allclose(twice, [-math.cos(2.3), -math.sin(2.3)], atol=EPS)


def test_float32_keeps_its_precision():
    angles = np.float32(np.linspace(-7, 7, 50))
    assert off(angles, compiled(jnp.asarray(angles, jnp.float32))) < np.finfo(np.float32).eps


def test_angles_of_vectors_down_to_rounding():
    """In all eight directions and all octants, of lengths from 1e-100 to 1e100, against fifty digits."""
    rng = np.random.default_rng(0)
    lengths, angles = 10.0 ** rng.uniform(-100, 100, 800), rng.uniform(-math.pi, math.pi, 800)
    whole = [(y, x) for y in (-1.0, 0.0, 1.0) for x in (-1.0, 0.0, 1.0)]
    sin, cos = np.concatenate([[lengths * np.sin(angles), lengths * np.cos(angles)], np.transpose(whole)], axis=1)
    found = jax.jit(angle)(jnp.asarray(sin), jnp.asarray(cos))
    with mpmath.workdps(50):
        exact = [mpmath.atan2(float(y), float(x)) if y or x else mpmath.mpf(0) for y, x in zip(sin, cos, strict=True)]
        # a unit in the last place of pi is 2 EPS; three sums and a quotient are rounded
        assert max(abs(float(mpmath.mpf(float(a)) - b)) for a, b in zip(found, exact, strict=True)) < 3 * EPS
        small = [abs(float(mpmath.mpf(float(a)) / b - 1)) for a, b in zip(found, exact, strict=True) if 0 < abs(b) < 1]
    assert max(small) < 2 * EPS  # relative


@pytest.mark.long
def test_derivatives_of_angles():
    x = jnp.asarray([0.6, -0.8])
    once = jax.jit(jax.grad(lambda v: angle(v[0], v[1])))(x)
    np.testing.assert_allclose(once, [-0.8, -0.6], atol=EPS)
    np.testing.assert_array_equal(jax.grad(lambda v: angle(v[0], v[1]))(jnp.zeros(2)), [0.0, 0.0])
    assert np.isnan(angle(jnp.asarray(jnp.nan), jnp.asarray(1.0)))
