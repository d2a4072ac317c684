"""Solutions against those of numpy, and against what they are to solve."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.linear.blocks import inverse_jacobian, solve_blocks, solve_blocks_refined
from jaxkin.solve.linear.least_norm import solve_least_norm, solve_least_norm_refined
from reference.matrices import block_triangular


@pytest.mark.long
@pytest.mark.parametrize(
    "rows, columns, rank",
    [(6, 3, 3), (6, 7, 6), (6, 4, 2), (3, 5, 3), (18, 9, 9), (18, 19, 12), (13, 15, 13), (30, 31, 20), (44, 40, 25)],
)
def test_least_norm_of_systems_that_lack_rank(rows, columns, rank):
    rng = np.random.default_rng(rows * columns)
    jacobian = rng.normal(size=(7, rows, rank)) @ rng.normal(size=(7, rank, columns))
    right = np.einsum("pij,pj->pi", jacobian, rng.normal(size=(7, columns)))
    expected = np.stack([np.linalg.pinv(j, rcond=1e-10) @ r for j, r in zip(jacobian, right, strict=True)])
    batched = jnp.moveaxis(jnp.asarray(jacobian), 0, -1)
    solve = jax.jit(lambda jacobian, right: solve_least_norm_refined(jacobian, right, 1e-14, range(columns)))
    found = solve(batched, jnp.asarray(right).T)
    # rounding is amplified by the square of the condition number, here below 1e3
    np.testing.assert_allclose(found.T, expected, atol=1e-11 * np.abs(expected).max())


@pytest.mark.long
@pytest.mark.parametrize(("rows", "poses"), [(3, 3), (9, 3), (9, 1024), (12, 3), (13, 3), (39, 3), (40, 3)])
@pytest.mark.parametrize("lacking", [0, 1])
def test_every_size_class_finds_the_solution_of_the_pseudoinverse(rows, poses, lacking):
    """On both sides of each limit between the algorithms, of full rank and of one less."""
    rng = np.random.default_rng(100 * rows + lacking)
    columns, few = rows + 2, 3  # a few different systems, so that numpy is not what takes the time
    values = np.linspace(1.0, 2.0, rows) * (np.arange(rows) >= lacking)
    left, across = (np.linalg.qr(rng.normal(size=(few, n, n)))[0] for n in (rows, columns))
    jacobian = (left * values) @ across[:, :rows]
    right = np.einsum("pij,pj->pi", jacobian, rng.normal(size=(few, columns)))
    expected = np.einsum("pij,pj->pi", np.linalg.pinv(jacobian, rcond=1e-10), right)
    which = np.arange(poses) % few
    batched, sides = jnp.asarray(np.moveaxis(jacobian[which], 0, -1)), jnp.asarray(right[which].T)
    found = jax.jit(lambda jacobian, right: solve_least_norm(jacobian, right, 1e-14, range(columns)))(batched, sides)
    # a damping of 1e-14, and condition numbers of two; without full rank rounding of r over the damping, times J^T
    np.testing.assert_allclose(found.T, expected[which], atol=1e-11 if not lacking else 1e-6)


@pytest.mark.long
def test_an_idle_coordinate_stays_exactly_at_rest():
    """The part of x in the null space of J is rounding of x itself, not rounding over damping."""
    rng = np.random.default_rng(0)
    jacobian = np.concatenate([rng.normal(size=(6, 4)), np.zeros((6, 2))], axis=1)
    jacobian = jacobian @ np.linalg.qr(rng.normal(size=(6, 6)))[0]
    null = np.linalg.svd(jacobian)[2][4:]
    batched = jnp.asarray(jacobian)[..., None]
    x = solve_least_norm(batched, jnp.asarray(jacobian @ rng.normal(size=6))[:, None], 1e-14, range(6))
    np.testing.assert_allclose(null @ np.asarray(x)[:, 0], 0.0, atol=1e-13)


def test_only_used_columns_are_solved_for():
    """The same as with all columns, of which the others are zero."""
    rng = np.random.default_rng(0)
    jacobian = rng.normal(size=(6, 20, 7))
    jacobian[:, 8:] = 0.0
    right = jnp.asarray(rng.normal(size=(6, 7)))
    damping = jnp.full(7, 1e-3)
    solve = jax.jit(solve_least_norm, static_argnums=3)
    one, other = (solve(jnp.asarray(jacobian), right, damping, range(used)) for used in (8, 20))
    np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-15)


@pytest.mark.long
@pytest.mark.parametrize("regular", [False, True])
@pytest.mark.parametrize("poses", [5, 1024])
def test_blocks_one_after_another_solve_the_whole(regular, poses):
    rng = np.random.default_rng(poses)
    jacobian, blocks = block_triangular(rng, poses)
    right = rng.normal(size=(9, poses))
    x = jax.jit(lambda jacobian, right: solve_blocks(jacobian, right, 1e-14, blocks, regular=regular))(jacobian, right)
    residual = np.einsum("rcp,cp->rp", jacobian, x) - right
    # J J^T squares condition numbers, up to a thousand here; its damping is a hundredth of that
    np.testing.assert_allclose(residual, 0.0, atol=1e-9 * np.abs(x).max())
    assert np.median(np.abs(residual)) < 1e-12
    idle = np.setdiff1d(np.arange(12), np.concatenate([block.columns for block in blocks]))
    np.testing.assert_array_equal(np.asarray(x)[idle], 0.0)


@pytest.mark.long
@pytest.mark.parametrize("poses", [5, 1024])
def test_the_inverse_does_what_solutions_are(poses):
    rng = np.random.default_rng(poses)
    jacobian, blocks = block_triangular(rng, poses)
    right = jnp.asarray(rng.normal(size=(9, poses)))
    expected = jax.jit(lambda jacobian, right: solve_blocks(jacobian, right, 1e-14, blocks, regular=True))(
        jacobian, right
    )
    inverse = jax.jit(lambda jacobian: inverse_jacobian(jacobian, 1e-14, blocks))(jacobian)
    found = jnp.einsum("pcr,rp->cp", inverse, right)
    # the same operations in another order, of blocks whose conditions multiply up to 1e6
    np.testing.assert_allclose(found, expected, atol=1e-11 * np.abs(expected).max())


def test_refined_blocks_solve_the_whole_and_their_derivative_does():
    """dx of J x = r solves J dx = dr - dJ x; the last block leaves one unknown open, which least norm determines."""
    rng = np.random.default_rng(3)
    jacobian, blocks = block_triangular(rng, 4)
    right, d_right = rng.normal(size=(2, 9, 4))
    d_jacobian = np.where(jacobian != 0, rng.normal(size=jacobian.shape), 0.0)
    x, dx = jax.jit(
        lambda *given: jax.jvp(lambda j, r: solve_blocks_refined(j, r, 1e-14, blocks), given[:2], given[2:])
    )(*map(jnp.asarray, (jacobian, right, d_jacobian, d_right)))
    residual = np.einsum("rcp,cp->rp", jacobian, x) - right
    change = np.einsum("rcp,cp->rp", jacobian, dx) + np.einsum("rcp,cp->rp", d_jacobian, x) - d_right
    # rounding over the conditions of the blocks, up to a hundred here, which multiply; refinement removes the damping
    np.testing.assert_allclose(residual, 0.0, atol=1e-13 * np.abs(x).max())
    np.testing.assert_allclose(change, 0.0, atol=1e-12 * np.abs(dx).max())
    last = blocks[-1]
    for pose in range(4):
        own = jacobian[np.ix_(last.rows, last.columns)][..., pose]
        null = np.linalg.svd(own)[2][2:]
        np.testing.assert_allclose(null @ np.asarray(x)[list(last.columns), pose], 0.0, atol=1e-12 * np.abs(x).max())
