"""Factorise quadratic functions and linear equations at every pose, so that both are solved by products.

With R M R^T = 1 the equations E z = b are those of v, z = R^T v, whose rows E R^T are made orthonormal: M is positive
definite and well-conditioned, E need not be.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.cramer import inverse_of_three
from jaxkin.solve.linear.gram import Matrix, Vector, column_products, column_sums, product, row_products, row_sums
from jaxkin.solve.linear.inverse_root import inverse_root
from jaxkin.solve.linear.orthonormal_rows import WEAK, orthonormal_rows

CRAMER = 3
"""Number of equations, and of unknowns in them, that Cramer's rule solves where no pose is nearly singular: those of
one loop in the plane."""


class Factors(NamedTuple):
    """R, and the orthonormal rows Q of E R^T, E without the columns of unknowns that are in no equation."""

    root: Float[Array, "n n poses"]
    """R. The last unknowns are those in the equations, whose rows of E R^T hold no others."""
    whitened: Float[Array, "equations held poses"]
    """E R^T."""
    rows: Float[Array, "equations held poses"]
    """Q = T E R^T."""
    made_by: Float[Array, "equations equations poses"]
    """T."""
    vanishing: Float[Array, "_ equations poses"]
    """Orthonormal combinations of equations that vanish, and zeros."""

    @property
    def _own_root(self) -> Matrix:
        before = len(self.root) - self.rows.shape[1]
        return self.root[before:, before:]

    def solved(self, y: Vector) -> Float[Array, "held poses"]:
        """Find a z with E z = y, where no equation contradicts others."""
        return column_sums(self._own_root, column_sums(self.rows, row_sums(self.made_by, y)))

    def combined(self, z: Float[Array, "held poses"]) -> Vector:
        """Find a y with E^T y = z, where there is one."""
        return column_sums(self.made_by, row_sums(self.rows, row_sums(self._own_root, z)))

    def minimum(self, slope: Float[Array, "n poses"], right: Vector) -> Float[Array, "n poses"]:
        """Minimise z^T M z / 2 - a^T z where E z = b, for a `slope` a and a `right` side b that no equation
        contradicts."""
        before, free = len(self.root) - self.rows.shape[1], row_sums(self.root, slope)
        missing = row_sums(self.made_by, row_sums(self.whitened, free[before:]) - right)
        taken = column_sums(self.rows, missing)
        return column_sums(self.root, free - jnp.concatenate([jnp.zeros_like(slope[:before]), taken]))


def factors(matrix: Float[Array, "n n poses"], equations: Float[Array, "equations held poses"]) -> Factors:
    """Factorise M and E in each pose.

    As many independent equations as unknowns in them say all of these by themselves. R then may stop short of them: it
    only makes M one where the others are, and where it is not triangular, and E^-1 takes the place of orthonormal rows.
    """
    before = len(matrix) - equations.shape[1]

    def by_orthonormal_rows() -> Factors:
        root = inverse_root(matrix)
        whitened = row_products(equations, root[before:, before:])
        return Factors(root, whitened, *orthonormal_rows(whitened))

    def by_inverse() -> Factors:
        root, unit = inverse_root(matrix[:before, :before]), jnp.zeros_like(equations) + jnp.eye(CRAMER)[..., None]
        across = -product(matrix[before:, :before], column_products(root, root))
        none = jnp.zeros_like(matrix[:before, before:])
        rows = [jnp.concatenate([root, none], axis=1), jnp.concatenate([across, unit], axis=1)]
        return Factors(jnp.concatenate(rows), equations, unit, inverse, jnp.zeros_like(equations))

    if equations.shape[:2] != (CRAMER, CRAMER):
        return by_orthonormal_rows()
    inverse = inverse_of_three(equations)
    condition = jnp.max(jnp.abs(inverse), axis=(0, 1)) * jnp.max(jnp.abs(equations), axis=(0, 1))
    regular = jnp.all(condition < float(jnp.finfo(matrix.dtype).eps) ** -WEAK)
    return lax.cond(regular, by_inverse, by_orthonormal_rows)
