"""Make the rows of many small matrices orthonormal, and find which rows depend on others.

By the modified method of Gram and Schmidt, the largest of the rows that are left after the ones before in turn; what is
done to the rows A is done to a unit matrix beside them. So A becomes Q = T A, whose rows are orthonormal, and dependent
rows leave the combinations N of rows that vanish, N A = 0. To take these out of T would be a product of matrices; out
of what T multiplies it is one of a matrix and a vector. Errors grow with the condition of A, and not with its
square, as they do by way of A A^T.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import Matrix, product, row_products

NEGLIGIBLE = 0.6
"""Power of rounding: a row counts as dependent where less than this is left of it, over the largest row. 4e-10 in
float64: above the errors of poses, 1e-12, and below what is of use as a lever."""

WEAK = 0.25
"""Power of rounding: T is large where one of its entries is more than one over this, 8,000 in float64, over the largest
row. A row that nearly depends on those before, as of two hinges on axes 1e-7 apart, makes it so, and rows that
contradict each other by as little then had solutions of any size: all rows are made orthonormal anew, the largest
first. Within halves of all mechanisms that took reactions of a platform on six legs from 30 us a pose to 41."""

MAX_ROWS_IN_TURN = 8
"""Largest number of rows of which each is treated in turn. More are halved first, which turns most of the work into
products of matrices: 25 rows of 30 columns took 15 us a pose in place of 48."""


class OrthonormalRows(NamedTuple):
    """Orthonormal rows of matrices A (rows, columns, poses) in each pose."""

    rows: Matrix
    """Q = T A. Zero in place of a dependent row."""
    made_by: Float[Array, "rows rows poses"]
    """T. The pseudoinverse of A is Q^T T (1 - N^T N)."""
    vanishing: Float[Array, "rows rows poses"]
    """N, orthonormal; zero in place of an independent row."""


def orthonormal_rows(matrix: Matrix) -> OrthonormalRows:
    """Make rows orthonormal in each pose."""
    if not len(matrix):
        return OrthonormalRows(matrix, matrix[:, :0], matrix[:, :0])
    squares = jnp.sum(matrix * matrix, axis=1)
    if len(matrix) == 1:
        kept = squares[:, None] > 0
        over = jnp.where(kept, 1.0, 0.0) / jnp.sqrt(jnp.where(kept, squares[:, None], 1.0))
        return OrthonormalRows(over * matrix, over, jnp.where(kept, 0.0, 1.0))
    largest = jnp.max(squares, axis=0)
    rounding = float(jnp.finfo(matrix.dtype).eps)
    least = rounding ** (2 * NEGLIGIBLE) * largest
    if len(matrix) <= MAX_ROWS_IN_TURN:
        return _largest_first(matrix, least)
    found = _halved(matrix, least)
    large = jnp.max(found.made_by**2, axis=(0, 1)) * largest > rounding ** (-2 * WEAK)
    found = lax.cond(jnp.any(large), lambda: _largest_first(matrix, least), lambda: found)
    # combinations that vanish, which few mechanisms have, are independent, but not orthonormal yet
    return lax.cond(jnp.any(found.vanishing != 0), _with_orthonormal_combinations, lambda found: found, found)


def _halved(matrix: Matrix, least: Float[Array, " poses"]) -> OrthonormalRows:
    """Make the upper half of the rows orthonormal, then what the others have besides."""
    if len(matrix) <= MAX_ROWS_IN_TURN:
        return _in_order(matrix, least)
    half = len(matrix) // 2
    upper = _halved(matrix[:half], least)
    along = row_products(matrix[half:], upper.rows)
    lower = _halved(matrix[half:] - product(along, upper.rows), least)
    left = product(along, upper.made_by)
    unit = jnp.pad(upper.made_by, ((0, 0), (0, len(matrix) - half), (0, 0)))

    def of_all(of_lower: Array) -> Array:
        return jnp.concatenate([-product(of_lower, left), of_lower], axis=1)

    vanishing = jnp.pad(upper.vanishing, ((0, 0), (0, len(matrix) - half), (0, 0)))
    return OrthonormalRows(
        jnp.concatenate([upper.rows, lower.rows]),
        jnp.concatenate([unit, of_all(lower.made_by)]),
        jnp.concatenate([vanishing, of_all(lower.vanishing)]),
    )


def _with_orthonormal_combinations(found: OrthonormalRows) -> OrthonormalRows:
    return found._replace(vanishing=independent_rows(found.vanishing))


def independent_rows(matrix: Matrix) -> Matrix:
    """Make independent rows orthonormal, the upper half first; rows of zeros stay so."""
    if len(matrix) <= MAX_ROWS_IN_TURN:
        return lax.fori_loop(0, len(matrix), _one_in_turn, matrix)
    half = len(matrix) // 2
    upper = independent_rows(matrix[:half])
    along = row_products(matrix[half:], upper)
    return jnp.concatenate([upper, independent_rows(matrix[half:] - product(along, upper))])


def _one_in_turn(number: Any, each: Matrix) -> Matrix:
    """Normalise one row, and make those behind it orthogonal to it."""
    own = lax.dynamic_index_in_dim(each, number, keepdims=False)
    square = jnp.sum(own * own, axis=0)
    own = own * (jnp.where(square > 0, 1.0, 0.0) / jnp.sqrt(jnp.where(square > 0, square, 1.0)))
    place = jnp.arange(len(each))[:, None]
    along = jnp.where(place > number, jnp.sum(each * own, axis=1), 0.0)
    return jnp.where((place == number)[:, None], own, each - along[:, None] * own)


def _in_order(matrix: Matrix, least: Float[Array, " poses"]) -> OrthonormalRows:
    """Make one row after the other orthonormal; a row whose square is not above `least` depends on those before.

    The combinations that vanish are as they are found, independent of each other.
    """
    count, columns, poses = matrix.shape
    unit = jnp.broadcast_to(jnp.eye(count, dtype=matrix.dtype)[..., None], (count, count, poses))
    place = jnp.arange(count)[:, None]

    def step(number: Any, given: tuple[Array, Array]) -> tuple[Array, Array]:
        each, kept = given
        own = lax.dynamic_index_in_dim(each, number, keepdims=False)
        square = jnp.sum(own[:columns] ** 2, axis=0)
        stays = square > least
        own = own * (jnp.where(stays, 1.0, 0.0) / jnp.sqrt(jnp.where(stays, square, 1.0)))
        along = jnp.where(place > number, jnp.sum(each[:, :columns] * own[:columns], axis=1), 0.0)
        here = (place == number) & stays
        return jnp.where(here[:, None], own, each - along[:, None] * own), kept | here

    begun = jnp.concatenate([matrix, unit], axis=1), jnp.zeros((count, poses), bool)
    each, kept = lax.fori_loop(0, count, step, begun)
    kept = kept[:, None]
    rows, made_by = each[:, :columns], each[:, columns:]
    return OrthonormalRows(jnp.where(kept, rows, 0.0), jnp.where(kept, made_by, 0.0), jnp.where(kept, 0.0, made_by))


def _largest_first(matrix: Matrix, least: Float[Array, " poses"]) -> OrthonormalRows:
    """Make rows orthonormal, in each pose the largest of those that are left after the ones before in turn; a row whose
    square is not above `least` depends on those before."""
    count, columns, poses = matrix.shape
    unit = jnp.broadcast_to(jnp.eye(count, dtype=matrix.dtype)[..., None], (count, count, poses))
    beside = jnp.arange(columns + count) >= columns

    def step(_: Any, given: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        each, kept, left = given
        squares = jnp.where(left, jnp.sum(each[:, :columns] ** 2, axis=1), -1.0)
        here = jnp.arange(count)[:, None] == jnp.argmax(squares, axis=0)
        own = jnp.sum(jnp.where(here[:, None], each, 0.0), axis=0)
        stays = jnp.sum(own[:columns] ** 2, axis=0) > least
        # a dependent row is a combination of rows that vanishes: these are made orthonormal by themselves
        lead = jnp.where(beside[:, None] ^ stays, own, 0.0)
        over = 1.0 / jnp.sqrt(jnp.sum(lead * lead, axis=0))
        own = jnp.where(beside[:, None] | stays, own, 0.0) * over
        along = jnp.where(here, 0.0, jnp.sum(each * (lead * over), axis=1))
        each = jnp.where(here[:, None], own, each - along[:, None] * own)
        return each, kept | (here & stays), left & ~here

    begun = jnp.concatenate([matrix, unit], axis=1), jnp.zeros((count, poses), bool), jnp.ones((count, poses), bool)
    each, kept, _ = lax.fori_loop(0, count, step, begun)
    kept = kept[:, None]
    made_by = each[:, columns:]
    return OrthonormalRows(each[:, :columns], jnp.where(kept, made_by, 0.0), jnp.where(kept, 0.0, made_by))
