"""The formulas of a rod: it keeps its length, on the branch of the assembled pose, right to rounding near limits."""

import jax
import mpmath
import numpy as np
import pytest

from jaxkin.geometry.pose import rotation, unit
from jaxkin.solve.closed_form import rod
from jaxkin.solve.closed_form.equations import solve_turn
from jaxkin.solve.closed_form.vectors import Vector

EPS = np.finfo(float).eps


def of_arrays(function):
    """The function, given arrays in place of vectors."""
    return lambda *given: function(*(Vector(*each) if np.ndim(each) else each for each in given))


turn, slide = of_arrays(jax.jit(rod.rod_turn)), of_arrays(jax.jit(rod.rod_slide))
signed_root_of_turn, signed_root_of_slide = of_arrays(rod.signed_root_of_turn), of_arrays(rod.signed_root_of_slide)


def drawn(seed):
    rng = np.random.default_rng(seed)
    return unit(rng.normal(size=3)), *rng.normal(size=(3, 3))


def test_a_rod_that_turns_keeps_its_length():
    reached = 0
    for seed in range(20):
        axis, centre, near, far = drawn(seed)
        length = np.linalg.norm(far - near)
        begun = float(signed_root_of_turn(axis, centre, near, far))
        rest = turn(axis, centre, near, far, length, np.sign(begun))
        np.testing.assert_allclose(rest.discriminant, begun**2, atol=1e-12)
        np.testing.assert_allclose(rest.value, 0.0, atol=200 * EPS / abs(begun))
        for sign in (1.0, -1.0):
            found = turn(axis, centre, near + 0.2, far, length, sign)
            if found.discriminant > 1e-3:
                reached += 1
                there = centre + rotation(axis, float(found.value)) @ (far - centre)
                np.testing.assert_allclose(np.linalg.norm(there - near - 0.2), length, atol=1e-13)
    assert reached > 20


def test_a_rod_that_slides_keeps_its_length():
    for seed in range(20):
        axis, _, near, far = drawn(seed)
        length = np.linalg.norm(far - near)
        begun = float(signed_root_of_slide(axis, near, far))
        rest = slide(axis, near, far, length, np.sign(begun))
        np.testing.assert_allclose([rest.discriminant, rest.value], [begun**2, 0.0], atol=1e-12)
        for sign in (1.0, -1.0):
            s, discriminant = slide(axis, near + 0.05, far, length, sign)
            if discriminant > 1e-3:
                np.testing.assert_allclose(np.linalg.norm(far + s * axis - near - 0.05), length, atol=1e-13)


@pytest.mark.parametrize("wanted", [1e-2, 1e-6, 1e-10, 1e-14])
def test_beside_a_limit_the_error_of_the_angle_is_rounding_over_the_root_of_the_discriminant(wanted):
    rng = np.random.default_rng(4)
    for a, b in rng.normal(size=(20, 2)):
        c = np.hypot(a, b) * (1 - wanted / 2)
        for sign in (1.0, -1.0):
            found = solve_turn(a, b, c, sign)
            with mpmath.workdps(50):
                radius = mpmath.hypot(a, b)
                true = mpmath.atan2(b, a) - sign * mpmath.acos(c / radius)
                error = abs(float(mpmath.sin((float(found.value) - true) / 2))) * 2
            assert error < 100 * EPS / np.sqrt(found.discriminant)
