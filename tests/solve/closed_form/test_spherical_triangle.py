"""The formula of the spherical triangle: closes, on the branch of the assembled pose, right to rounding near limits."""

import jax
import mpmath
import numpy as np
import pytest

from jaxkin.geometry.pose import rotation, unit
from jaxkin.solve.closed_form import spherical_triangle
from jaxkin.solve.closed_form.vectors import Rotation, Vector

EPS = np.finfo(float).eps


def of_arrays(function):
    """The function, given arrays in place of vectors and rotations."""

    def call(axes, between, *sign):
        rotations = [Rotation(*(Vector(*column) for column in matrix.T)) for matrix in between]
        return function([Vector(*axis) for axis in axes], rotations, *sign)

    return call


solve, signed_root = (
    of_arrays(jax.jit(spherical_triangle.spherical_triangle)),
    of_arrays(spherical_triangle.signed_root),
)


def drawn(seed):
    """Three axes, and known rotations between them after some have moved."""
    rng = np.random.default_rng(seed)
    axes = [unit(rng.normal(size=3)) for _ in range(3)]
    moved = [rotation(unit(rng.normal(size=3)), angle) for angle in (0.2, 0.0, -0.3)]
    return axes, moved


def misfit(axes, between, q):
    product = np.eye(3)
    for axis, known, each in zip(axes, between, q, strict=True):
        product = product @ rotation(axis, float(each)) @ known
    return np.abs(product - np.eye(3)).max()


@pytest.mark.long
def test_the_loop_closes_on_both_branches_and_is_at_rest_in_the_assembled_pose():
    reached = 0
    for seed in range(20):
        axes, moved = drawn(seed)
        begun = float(signed_root(axes, [np.eye(3)] * 3))
        rest = solve(axes, [np.eye(3)] * 3, np.sign(begun))
        np.testing.assert_allclose(begun**2, rest.discriminant, atol=1e-13)
        np.testing.assert_allclose(rest.coordinates, 0.0, atol=200 * EPS / abs(begun))
        for sign in (1.0, -1.0):
            found = solve(axes, moved, sign)
            if found.discriminant > 1e-3:
                reached += 1
                assert misfit(axes, moved, found.coordinates) < 1e-13
    assert reached > 20


@pytest.mark.parametrize("wanted", [1e-3, 1e-7, 1e-11])
def test_beside_a_limit_the_error_is_rounding_over_the_root_of_the_discriminant(wanted):
    """The second angle against the cosine rule in fifty digits, and the loop against closure."""
    for seed in range(4):
        axes, _ = drawn(seed)
        about = unit(np.cross(axes[0], axes[2]))
        closes, open_ = 0.0, np.arccos(axes[0] @ axes[2])  # there the first and the third axis are one
        while True:
            middle = 0.5 * (closes + open_)
            between = [np.eye(3), np.eye(3), rotation(about, float(middle))]
            found = solve(axes, between, 1.0)
            q, discriminant = found.coordinates, found.discriminant
            if wanted / 4 < discriminant < 4 * wanted:
                break
            closes, open_ = (middle, open_) if discriminant > wanted else (closes, middle)
        with mpmath.workdps(50):
            one, two, three = (
                mpmath.matrix(axis.tolist()) / mpmath.norm(mpmath.matrix(axis.tolist())) for axis in axes
            )
            wanted_cosine = (one.T * mpmath.matrix(between[2].T.tolist()) * three)[0]
            along = (one.T * two)[0] * (two.T * three)[0]
            a = (one.T * three)[0] - along
            b = sum(one[i] * (two[j] * three[k] - two[k] * three[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
            true = mpmath.atan2(b, a) - mpmath.acos((wanted_cosine - along) / mpmath.hypot(a, b))
            error = 2 * abs(float(mpmath.sin((float(q[1]) - true) / 2)))
            assert error < 100 * EPS / np.sqrt(discriminant)
        assert misfit(axes, between, q) < 100 * EPS / np.sqrt(discriminant)
