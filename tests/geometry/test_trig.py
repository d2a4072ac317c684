import math

import jax
import jax.numpy as jnp
import mpmath
import numpy as np
import pytest

from jaxkin.geometry.trig import cos_sin

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


@pytest.mark.parametrize("farthest", [1.0, 10.0, 1e4, 1.5e6])
def test_of_any_angles_down_to_rounding(farthest):
    # half a unit in the last place is EPS / 4; the sums of the series round a few times more
    angles = np.random.default_rng(0).uniform(-farthest, farthest, 400)
    assert off(angles, compiled(jnp.asarray(angles))) < EPS


def test_at_whole_eighths_of_a_turn():
    angles = np.arange(-40, 41) * (math.pi / 4)
    assert off(angles, compiled(jnp.asarray(angles))) < EPS


def test_far_away_within_what_the_angle_is_known_to():
    angles = np.random.default_rng(0).uniform(1e7, 1e9, 100)
    assert off(angles, compiled(jnp.asarray(angles))) < np.max(np.spacing(angles))


def test_of_no_finite_angle_there_is_none():
    cos, sin = compiled(jnp.array([jnp.nan, jnp.inf, -jnp.inf]))
    assert bool(jnp.all(jnp.isnan(cos) & jnp.isnan(sin)))


def test_derivatives_are_those_of_cosine_and_sine():
    def both(x):
        return cos_sin(x[None])[:, 0]

    x = jnp.asarray(2.3)
    once, twice = jax.jit(jax.jacfwd(both))(x), jax.jit(jax.jacrev(jax.jacfwd(both)))(x)
    np.testing.assert_allclose(once, [-math.sin(2.3), math.cos(2.3)], atol=EPS)
    np.testing.assert_allclose(twice, [-math.cos(2.3), -math.sin(2.3)], atol=EPS)


def test_float32_keeps_its_precision():
    angles = np.float32(np.linspace(-7, 7, 50))
    assert off(angles, compiled(jnp.asarray(angles, jnp.float32))) < np.finfo(np.float32).eps
