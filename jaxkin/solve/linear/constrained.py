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

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import Matrix, Vector, row_products
from jaxkin.solve.linear.inverse_root import inverse_root
from jaxkin.solve.linear.orthonormal_rows import orthonormal_rows

Unknowns = Float[Array, "n+equations poses"]
"""z and y, or the right-hand sides a and b of their equations: in one array, as JAX cannot take the way back through a
linear solve of which one of several results is not used."""


def minimise_constrained(
    matrix: Float[Array, "n n poses"],
    slope: Float[Array, "n poses"],
    equations: Float[Array, "equations n poses"],
    right: Float[Array, "equations poses"],
) -> Float[Array, "n poses"]:
    """Find z (n, poses) from M (n, n, poses), a (n, poses), E (equations, n, poses) and b (equations, poses)."""
    count = len(slope)
    root = inverse_root(lax.stop_gradient(matrix))
    whitened = row_products(lax.stop_gradient(equations), root)
    found = orthonormal_rows(whitened)

    def vanishing(y: Vector) -> Vector:
        """Compute D y, whose derivative is that of the projector, which changes with E."""
        least = column_sums(found.vanishing, row_sums(found.vanishing, y))
        inside = row_sums(equations, column_sums(root, column_sums(found.rows, row_sums(found.made_by, y))))
        inside = column_sums(found.vanishing, row_sums(found.vanishing, inside))
        across = row_sums(root, column_sums(equations, least))
        return least - inside - column_sums(found.made_by, row_sums(found.rows, across))

    def system(given: Unknowns) -> Unknowns:
        z, y = given[:count], given[count:]
        return jnp.concatenate([row_sums(matrix, z) + column_sums(equations, y), row_sums(equations, z) - vanishing(y)])

    def solve(_: object, given: Unknowns) -> Unknowns:
        a, b = given[:count], given[count:]
        free = row_sums(root, a)
        missing = row_sums(found.made_by, row_sums(whitened, free) - b)
        z = column_sums(root, free - column_sums(found.rows, missing))
        y = column_sums(found.made_by, missing) - column_sums(found.vanishing, row_sums(found.vanishing, b))
        return jnp.concatenate([z, y])

    return lax.custom_linear_solve(system, jnp.concatenate([slope, right]), solve, symmetric=True)[:count]


def row_sums(matrix: Matrix, vector: Float[Array, "columns poses"]) -> Vector:
    """Compute A x at every pose."""
    return jnp.sum(matrix * vector[None], axis=1)


def column_sums(matrix: Matrix, vector: Vector) -> Float[Array, "columns poses"]:
    """Compute A^T x at every pose."""
    return jnp.sum(matrix * vector[:, None], axis=0)
