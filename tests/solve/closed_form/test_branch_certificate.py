"""Angles are unwrapped without an arc tangent, and lines that are passed by a wide margin are certified."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.closed_form.branch_certificate import MAX_TURN, are_steep, certify_line, surely_passes, unwrapped
from jaxkin.solve.closed_form.complex_numbers import Complex, rough_argument, turn_by
from jaxkin.solve.lockstep import computed_once, in_lockstep

NODES = np.linspace(0.0, 2 * np.pi, 129)


def test_rough_angles_are_right_to_what_they_promise():
    angles = np.linspace(-np.pi, np.pi, 1001)[1:]
    rough = rough_argument(turn_by(angles))
    assert (
        0.07 < np.max(np.abs(rough - angles)) < 0.08
    )  # the largest difference is 0.0716, at an eighth of a right angle
    assert rough_argument(Complex(np.zeros(1), np.zeros(1))) == 0.0


@pytest.mark.parametrize("start", [0.0, 3.0, -3.1])
@pytest.mark.parametrize("turns", [-3.0, -1.0, 0.4, 2.0])
def test_angles_are_unwrapped_whatever_way_they_turn(start, turns):
    angles = start + turns * NODES + 0.3 * np.sin(3 * NODES)
    (found,) = unwrapped([turn_by(angles)])
    whole = 2 * np.pi * np.round((angles[0] - found[0]) / (2 * np.pi))
    np.testing.assert_allclose(found + whole, angles, atol=0.08)


def test_steps_are_steep_from_the_largest_turn_on():
    changes = np.array([0.9, 1.0, -0.9, -1.0, 2.0]) * MAX_TURN * np.array([1, 1.01, 1, 1.01, 1])
    found = are_steep([turn_by(np.concatenate([[0.0], np.cumsum(changes)]))], 6)
    np.testing.assert_array_equal(found, [False, True, False, True, True])


@pytest.mark.parametrize("seed", range(20))
def test_what_surely_passes_passes_and_stays_positive(seed):
    """Discriminants drawn as sums of waves, held against a thousand times as many inputs."""
    rng = np.random.default_rng(seed)
    sizes, phases = rng.normal(size=5) / np.arange(1, 6) ** 2, rng.uniform(0, 6, 5)

    def wave(inputs):
        return sum(
            size * np.cos(k * inputs + phase) for k, (size, phase) in enumerate(zip(sizes, phases, strict=True), 1)
        )

    steep, dense = np.zeros(128, bool), np.min(wave(np.linspace(0.0, 2 * np.pi, 100_000)))
    for margin in (-1e-2, 1e-8, 1e-4, 1e-2, 0.3):
        f = [wave(NODES) - dense + margin]
        passes = bool(certify_line(f, steep, 0, 128).passes)
        assert passes or not surely_passes(f, steep)
        assert margin > 1e-6 or not passes
        if margin == 0.3:
            assert surely_passes(f, steep)
            assert not surely_passes(f, np.arange(128) == 5)


def test_what_is_computed_once_is_what_the_function_returns():
    numbers = jnp.arange(3.0)
    np.testing.assert_array_equal(computed_once(lambda x: x + 1, numbers), [1, 2, 3])
    assert np.all(np.isnan(computed_once(lambda x: x + 1, numbers * np.nan)))
    # of a group of designs, one of which is not finite, all are computed
    designs = jnp.array([[1.0, 2.0], [np.nan, np.nan]])
    found = jax.jit(in_lockstep(lambda x: computed_once(jnp.square, x), (0,)))(designs)
    np.testing.assert_array_equal(found, designs**2)
