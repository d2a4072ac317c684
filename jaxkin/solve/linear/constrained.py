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

from jaxkin.solve.linear.block_factors import block_factors
from jaxkin.solve.linear.constraint_factors import factors
from jaxkin.solve.linear.gram import Vector, column_sums, row_sums
from jaxkin.solve.linear.own_equations import Blocks

Unknowns = Float[Array, "n+equations poses"]
"""z and y, or the right-hand sides a and b of their equations: in one array, as JAX cannot take the way back through a
linear solve of which one of several results is not used."""


def minimise_constrained(
    matrix: Float[Array, "n n poses"],
    slope: Float[Array, "n poses"],
    equations: Float[Array, "equations held poses"],
    right: Float[Array, "equations poses"],
    *,
    blocks: Blocks | None = None,
) -> Float[Array, "n poses"]:
    """Find z (n, poses) from M (n, n, poses), a (n, poses), E (equations, held, poses) and b (equations, poses).

    The last unknowns, as many as E has columns, are those in the equations. `blocks` of these have equations of their
    own, which are eliminated first.
    """
    count = len(slope)
    before = count - equations.shape[1]
    given_numbers = lax.stop_gradient(matrix), lax.stop_gradient(equations)
    found = factors(*given_numbers) if blocks is None else block_factors(*given_numbers, blocks)
    absent = jnp.zeros_like(slope[:before])

    def of_vanishing(y: Vector) -> Vector:
        """Project on the combinations of equations that vanish, as they are found."""
        return column_sums(found.vanishing, row_sums(found.vanishing, y))

    def vanishing(y: Vector) -> Vector:
        """Compute D y, whose derivative is that of the projector, which changes with E."""
        least = of_vanishing(y)
        inside = of_vanishing(row_sums(equations, found.solved(y - least)))
        across = found.combined(column_sums(equations, least))
        return least - inside - (across - of_vanishing(across))

    def system(given: Unknowns) -> Unknowns:
        z, y = given[:count], given[count:]
        of_equations = jnp.concatenate([absent, column_sums(equations, y)])
        return jnp.concatenate([row_sums(matrix, z) + of_equations, row_sums(equations, z[before:]) - vanishing(y)])

    def solve(_: object, given: Unknowns) -> Unknowns:
        a, b = given[:count], given[count:]
        z = found.minimum(a, b - of_vanishing(b))
        y = found.combined((a - row_sums(lax.stop_gradient(matrix), z))[before:])
        return jnp.concatenate([z, y - of_vanishing(y + b)])

    return lax.custom_linear_solve(system, jnp.concatenate([slope, right]), solve, symmetric=True)[:count]
