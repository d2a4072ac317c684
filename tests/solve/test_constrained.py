"""Constrained minima of quadratic functions, and what they are made of, against dense algebra in numpy."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.linear.constrained import minimise_constrained
from jaxkin.solve.linear.inverse_root import inverse_root
from jaxkin.solve.linear.orthonormal_rows import orthonormal_rows
from jaxkin.solve.linear.own_equations import Blocks

POSES = 3
SHAPES = [(0, 6), (1, 1), (3, 6), (7, 6), (9, 18), (25, 30), (20, 12)]


def _dependent(rng, rows, columns):
    """Rows of which two depend on others where there are more than three; over seven decades in the last pose."""
    matrix = rng.normal(size=(rows, columns, POSES))
    if rows > 3:
        matrix[2] = matrix[0] - 2 * matrix[1]
        matrix[-1] = matrix[0] + matrix[-2]
        matrix[:, :, -1] *= np.logspace(0, -7, rows)[:, None]
    return matrix


@pytest.mark.parametrize(("rows", "columns"), SHAPES)
def test_orthonormal_rows_are_made_by_the_pseudoinverse(rows, columns):
    """Tolerance: rounding times the condition, 1e7 in the last pose."""
    matrix = _dependent(np.random.default_rng(rows), rows, columns)
    found = [np.asarray(each) for each in jax.jit(orthonormal_rows)(matrix)]
    for pose, allowed in zip(range(POSES), (1e-11, 1e-11, 1e-6), strict=True):
        orthonormal, made_by, vanishing = (each[..., pose] for each in found)
        own = matrix[..., pose]
        rank = np.linalg.matrix_rank(own, tol=1e-9)
        assert np.sum(np.any(orthonormal != 0, axis=1)) == rank
        assert np.sum(np.any(vanishing != 0, axis=1)) == rows - rank
        np.testing.assert_allclose(vanishing @ own, 0.0, atol=1e-11)
        np.testing.assert_allclose(vanishing @ vanishing.T, np.diag(np.any(vanishing != 0, axis=1)), atol=1e-11)
        inverse = np.linalg.pinv(own, rcond=1e-9)
        made = orthonormal.T @ (made_by - made_by @ vanishing.T @ vanishing)
        np.testing.assert_allclose(made, inverse, atol=allowed * np.abs(inverse).max(initial=0.0))


@pytest.mark.parametrize(("rows", "columns"), [(4, 3), (7, 6), (9, 3), (12, 6), (25, 12)])
@pytest.mark.parametrize("apart", [1e-9, 1e-8, 1e-6])
def test_rows_that_nearly_depend_on_others_do_not_spoil_what_later_rows_say_better(rows, columns, apart):
    """As of two hinges on axes that are 1e-7 apart. The matrix is well-conditioned: tolerance of rounding times 1e4."""
    rng = np.random.default_rng(rows)
    matrix, right = rng.normal(size=(rows, columns, POSES)), rng.normal(size=rows)
    matrix[2] = matrix[0] - 2 * matrix[1] + apart * matrix[2]
    found = jax.jit(orthonormal_rows)(matrix)
    for pose in range(POSES):
        orthonormal, made_by, vanishing = (np.asarray(each)[..., pose] for each in found)
        least = np.linalg.lstsq(matrix[..., pose], right)[0]
        given = right - vanishing.T @ (vanishing @ right)
        np.testing.assert_allclose(orthonormal.T @ (made_by @ given), least, atol=1e-11 * np.abs(least).max() * rows)


@pytest.mark.long
@pytest.mark.parametrize("n", [1, 3, 4, 6, 17, 30])
def test_inverse_roots_are_lower_and_make_the_matrix_one(n):
    factor = np.random.default_rng(n).normal(size=(n, n, POSES))
    matrix = np.einsum("ikp,jkp->ijp", factor, factor) + np.eye(n)[..., None]
    root = np.asarray(inverse_root(jnp.asarray(matrix)))
    for pose in range(POSES):
        own = root[..., pose]
        np.testing.assert_array_equal(np.triu(own, 1), 0.0)
        np.testing.assert_allclose(own @ matrix[..., pose] @ own.T, np.eye(n), atol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize(("rows", "columns"), SHAPES)
def test_minima_and_their_derivatives(rows, columns):
    """z = x + N u: x violates the equations least, and u minimises along their null space; derivatives by differences.

    Tolerance: rounding times the condition, about 1e3 here, and the square of the step of the differences, 1e-5.
    """
    rng = np.random.default_rng(columns)
    equations = _dependent(rng, rows, columns)[..., :1]
    factor = rng.normal(size=(columns, columns, 1))
    matrix = np.einsum("ikp,jkp->ijp", factor, factor) + np.eye(columns)[..., None]
    slope, right = rng.normal(size=(columns, 1)), rng.normal(size=(rows, 1))

    def direct(slope, equations, right):
        e, m, a = equations[..., 0], matrix[..., 0], slope[:, 0]
        x = np.linalg.pinv(e, rcond=1e-9) @ right[:, 0]
        null = np.linalg.svd(e)[2][np.linalg.matrix_rank(e, tol=1e-9) :].T
        return x + null @ np.linalg.solve(null.T @ m @ null, null.T @ (a - m @ x))

    given = [jnp.asarray(each) for each in (matrix, slope, equations, right)]
    found = minimise_constrained(*given)[:, 0]
    expected = direct(slope, equations, right)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
    # a change of the columns: dependent equations stay dependent
    turn = 1e-1 * rng.normal(size=(columns, columns))
    change = np.einsum("rcp,cd->rdp", equations, turn)
    weights, linear, given_equations, constants = given
    _, derivative = jax.jvp(
        lambda e: minimise_constrained(weights, linear, e, constants)[:, 0], (given_equations,), (jnp.asarray(change),)
    )
    one, other = (direct(slope, equations + step * change, right) for step in (1e-5, -1e-5))
    difference = (one - other) / 2e-5
    np.testing.assert_allclose(derivative, difference, atol=1e-5 * np.abs(difference).max())


@pytest.mark.long
@pytest.mark.parametrize("outer", [jax.jacfwd, jax.jacrev])
def test_second_derivatives_by_the_right_sides_backwards(outer):
    """z is linear in (a, b) = s (a_0, b_0): |z|^2 = s^2 |z_0|^2 has the second derivative 2 |z_0|^2."""
    rng = np.random.default_rng(0)
    factor = rng.normal(size=(4, 4, POSES))
    matrix = jnp.asarray(np.einsum("ikp,jkp->ijp", factor, factor) + np.eye(4)[..., None])
    equations, slope, right = (jnp.asarray(rng.normal(size=shape)) for shape in ((2, 4, POSES), (4, POSES), (2, POSES)))

    def square(scale):
        return jnp.sum(minimise_constrained(matrix, scale * slope, equations, scale * right) ** 2)

    np.testing.assert_allclose(outer(jax.jacrev(square))(1.3), 2 * square(1.0), rtol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize(("rows", "held"), [(3, 3), (2, 3), (5, 4)])
@pytest.mark.parametrize("singular", [False, True])
def test_unknowns_in_no_equation_are_those_whose_columns_are_zero(rows, held, singular):
    """Minima and their derivatives backwards, also where a pose among regular ones is singular.

    Tolerance: rounding times the condition, about 1e2.
    """
    rng, count = np.random.default_rng(rows), held + 3
    factor = rng.normal(size=(count, count, POSES))
    matrix = jnp.asarray(np.einsum("ikp,jkp->ijp", factor, factor) + np.eye(count)[..., None])
    equations = rng.normal(size=(rows, held, POSES))
    if singular:
        equations[-1, :, 1] = equations[0, :, 1]
    equations, slope, right = (jnp.asarray(each) for each in (equations, factor[0], rng.normal(size=(rows, POSES))))
    weights = jnp.asarray(rng.normal(size=(count, 1)))

    def minimum(matrix, slope, equations, right, columns):
        zeros = jnp.zeros((rows, columns, POSES))
        return minimise_constrained(matrix, slope, jnp.concatenate([zeros, equations], axis=1), right)

    given = matrix, slope, equations, right
    found, expected = (jax.jit(minimum, static_argnums=4)(*given, columns) for columns in (0, 3))
    np.testing.assert_allclose(found, expected, atol=1e-11 * float(jnp.abs(expected).max()))

    def loss(columns, *given):
        return jnp.sum(weights * minimum(*given, columns) ** 2)

    both = [jax.jit(jax.grad(loss, argnums=(1, 2, 3, 4)), static_argnums=0)(columns, *given) for columns in (0, 3)]
    for one, other in zip(*both, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-10 * float(jnp.abs(other).max()))


@pytest.mark.long
@pytest.mark.parametrize("contradict", [False, True])
@pytest.mark.parametrize(
    ("absent", "blocks", "rows"),
    [(0, Blocks(6, ((0, 1), (5, 3), ())), 14), (4, Blocks(3, ((2,), (0,))), 7), (0, Blocks(3, ((4, 1, 0), (2,))), 6)],
)
def test_own_equations_of_blocks_may_be_eliminated_first(absent, blocks, rows, contradict):
    """Minima and their derivatives backwards are those without blocks, also where equations depend on own ones.

    Tolerance: rounding times the condition, about 1e3.
    """
    rng, inside = np.random.default_rng(rows), blocks.width * len(blocks.own)
    held = inside + 1
    factor = rng.normal(size=(absent + held, absent + held, POSES))
    matrix = np.einsum("ikp,jkp->ijp", factor, factor) + np.eye(absent + held)[..., None]
    equations, right = rng.normal(size=(rows, held, POSES)), rng.normal(size=(rows, POSES))
    for number, own in enumerate(blocks.own):
        outside = np.delete(np.arange(held), np.arange(number * blocks.width, (number + 1) * blocks.width))
        equations[np.ix_(own, outside)] = 0.0
    first = [row for own in blocks.own for row in own]
    # the last equation is a combination of others, own ones among them, in all poses but one
    others = [row for row in range(rows - 1) if row not in first]
    combination = np.zeros(rows)
    combination[[first[0], first[-1], others[0]]] = 1.0, -2.0, 0.5
    equations[-1, :, 1:] = np.einsum("r,rcp->cp", combination, equations)[:, 1:]
    if not contradict:
        right[-1, 1:] = (combination @ right)[1:]
    # a change of the unknowns within each block: dependent equations stay dependent
    within = np.kron(np.eye(len(blocks.own)), np.ones((blocks.width, blocks.width)))
    turn = np.pad(within, (0, 1)) * rng.normal(size=(held, held))
    change = jnp.asarray(np.einsum("rcp,cd->rdp", equations, turn))
    slope, far = rng.normal(size=(absent + held, POSES)), np.zeros(POSES)
    given = [jnp.asarray(each) for each in (matrix, slope, far, right)]
    weights = jnp.asarray(rng.normal(size=(absent + held, 1)))

    def loss(blocks, matrix, slope, far, right):
        found = minimise_constrained(matrix, slope, equations + far * change, right, blocks=blocks)
        return jnp.sum(weights * found**2), found

    each = [
        jax.jit(jax.value_and_grad(loss, argnums=(1, 2, 3, 4), has_aux=True), static_argnums=0)(some, *given)
        for some in (blocks, None)
    ]
    for one, other in zip(*map(jax.tree.leaves, each), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-11 * float(jnp.abs(other).max()))
