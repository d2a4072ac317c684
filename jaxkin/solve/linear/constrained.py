"""Minimise quadratic functions subject to linear equations, at every pose: min z^T M z / 2 - a^T z, E z = b.

With R M R^T = 1 the equations are those of v, z = R^T v, whose rows E R^T are made orthonormal: M is positive definite
and well-conditioned, E need not be. Errors are rounding times the condition of E. Equations that depend on others may
contradict them: then E z - b is least. With D the projector on the combinations of equations that vanish, z and the
multipliers y satisfy

    M z + E^T y = a,    E z - D y = b,

which is symmetric and can be solved for every a and b, so that derivatives solve the same system: the elimination is
never differentiated.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.cramer import inverse_of_three
from jaxkin.solve.linear.gram import Matrix, Vector, column_products, product, row_products
from jaxkin.solve.linear.inverse_root import inverse_root
from jaxkin.solve.linear.orthonormal_rows import WEAK, orthonormal_rows

CRAMER = 3
"""Number of equations, and of unknowns in them, that Cramer's rule solves where no pose is nearly singular: those of
one loop in the plane."""

Unknowns = Float[Array, "n+equations poses"]
"""z and y, or the right-hand sides a and b of their equations: in one array, as JAX cannot take the way back through a
linear solve of which one of several results is not used."""


def minimise_constrained(
    matrix: Float[Array, "n n poses"],
    slope: Float[Array, "n poses"],
    equations: Float[Array, "equations held poses"],
    right: Float[Array, "equations poses"],
) -> Float[Array, "n poses"]:
    """Find z (n, poses) from M (n, n, poses), a (n, poses), E (equations, held, poses) and b (equations, poses).

    The last unknowns, as many as E has columns, are those in the equations. With R lower triangular, no others are in
    the equations of v.
    """
    count = len(slope)
    before = count - equations.shape[1]
    found = _factors(lax.stop_gradient(matrix), lax.stop_gradient(equations))
    own_root = found.root[before:, before:]
    absent = jnp.zeros_like(slope[:before])

    def of_vanishing(y: Vector) -> Vector:
        """Project on the combinations of equations that vanish, as they are found."""
        return column_sums(found.vanishing, row_sums(found.vanishing, y))

    def vanishing(y: Vector) -> Vector:
        """Compute D y, whose derivative is that of the projector, which changes with E."""
        least = of_vanishing(y)
        made = row_sums(found.made_by, y - least)
        inside = of_vanishing(row_sums(equations, column_sums(own_root, column_sums(found.rows, made))))
        across = column_sums(found.made_by, row_sums(found.rows, row_sums(own_root, column_sums(equations, least))))
        return least - inside - (across - of_vanishing(across))

    def system(given: Unknowns) -> Unknowns:
        z, y = given[:count], given[count:]
        of_equations = jnp.concatenate([absent, column_sums(equations, y)])
        return jnp.concatenate([row_sums(matrix, z) + of_equations, row_sums(equations, z[before:]) - vanishing(y)])

    def solve(_: object, given: Unknowns) -> Unknowns:
        a, b = given[:count], given[count:]
        free = row_sums(found.root, a)
        missing = row_sums(found.whitened, free[before:]) - b
        missing = row_sums(found.made_by, missing - of_vanishing(missing))
        z = column_sums(found.root, free - jnp.concatenate([absent, column_sums(found.rows, missing)]))
        left = row_sums(own_root, (a - row_sums(lax.stop_gradient(matrix), z))[before:])
        y = column_sums(found.made_by, row_sums(found.rows, left))
        return jnp.concatenate([z, y - of_vanishing(y + b)])

    return lax.custom_linear_solve(system, jnp.concatenate([slope, right]), solve, symmetric=True)[:count]


class _Factors(NamedTuple):
    """R, and the orthonormal rows of E R^T, E and R without what is not in the equations."""

    root: Matrix
    whitened: Matrix
    """E R^T."""
    rows: Matrix
    made_by: Matrix
    vanishing: Matrix


def _factors(matrix: Float[Array, "n n poses"], equations: Float[Array, "equations held poses"]) -> _Factors:
    """Factorise M and E in each pose.

    As many independent equations as unknowns in them say all of these by themselves. R then may stop short of them: it
    only makes M one where the others are, and where it is not triangular, and E^-1 takes the place of orthonormal rows.
    """
    before = len(matrix) - equations.shape[1]

    def by_orthonormal_rows() -> _Factors:
        root = inverse_root(matrix)
        whitened = row_products(equations, root[before:, before:])
        return _Factors(root, whitened, *orthonormal_rows(whitened))

    def by_inverse() -> _Factors:
        root, unit = inverse_root(matrix[:before, :before]), jnp.zeros_like(equations) + jnp.eye(CRAMER)[..., None]
        across = -product(matrix[before:, :before], column_products(root, root))
        none = jnp.zeros_like(matrix[:before, before:])
        rows = [jnp.concatenate([root, none], axis=1), jnp.concatenate([across, unit], axis=1)]
        return _Factors(jnp.concatenate(rows), equations, unit, inverse, jnp.zeros_like(equations))

    if equations.shape[:2] != (CRAMER, CRAMER):
        return by_orthonormal_rows()
    inverse = inverse_of_three(equations)
    condition = jnp.max(jnp.abs(inverse), axis=(0, 1)) * jnp.max(jnp.abs(equations), axis=(0, 1))
    regular = jnp.all(condition < float(jnp.finfo(matrix.dtype).eps) ** -WEAK)
    return lax.cond(regular, by_inverse, by_orthonormal_rows)


def row_sums(matrix: Matrix, vector: Float[Array, "columns poses"]) -> Vector:
    """Compute A x at every pose."""
    return jnp.sum(matrix * vector[None], axis=1)


def column_sums(matrix: Matrix, vector: Vector) -> Float[Array, "columns poses"]:
    """Compute A^T x at every pose."""
    return jnp.sum(matrix * vector[:, None], axis=0)
