"""Factorise quadratic functions and equations, of which the own ones of blocks of unknowns are eliminated first."""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.constraint_factors import Factors, factors
from jaxkin.solve.linear.gram import Matrix, Vector, column_sums, product, row_sums
from jaxkin.solve.linear.orthonormal_rows import independent_rows
from jaxkin.solve.linear.own_equations import Blocks, OwnEquations, own_equations


class BlockFactors(NamedTuple):
    """Own equations, solved in axes of the blocks, and the `Factors` of what the others leave."""

    blocks: Blocks
    own: OwnEquations
    along: Float[Array, "others own poses"]
    """The other equations by the first components of all blocks, which the own equations say."""
    across: Float[Array, "left own poses"]
    """M by its other unknowns, the last components of the blocks among them, and the first components."""
    left: Factors
    vanishing: Float[Array, "_ equations poses"]
    """As in `Factors`."""

    def solved(self, y: Vector) -> Float[Array, "held poses"]:
        """Find a z with E z = y, where no equation contradicts others."""
        first, others = _numbers(self.blocks, len(y))
        one = row_sums(self.own.inverse, y[first])
        return self.own.together(self.blocks, one, self.left.solved(y[others] - row_sums(self.along, one)))

    def combined(self, z: Float[Array, "held poses"]) -> Vector:
        """Find a y with E^T y = z, where there is one."""
        one, other = self.own.apart(self.blocks, z)
        of_others = self.left.combined(other)
        of_own = column_sums(self.own.inverse, one - column_sums(self.along, of_others))
        return jnp.concatenate([of_own, of_others])[
            np.argsort(np.concatenate(_numbers(self.blocks, self.vanishing.shape[1])))
        ]

    def minimum(self, slope: Float[Array, "n poses"], right: Vector) -> Float[Array, "n poses"]:
        """Minimise z^T M z / 2 - a^T z where E z = b, for a `slope` a and a `right` side b that no equation
        contradicts."""
        before, (first, others) = len(self.left.root) - self.left.rows.shape[1], _numbers(self.blocks, len(right))
        one = row_sums(self.own.inverse, right[first])
        other = jnp.concatenate([slope[:before], self.own.apart(self.blocks, slope[before:])[1]])
        found = self.left.minimum(other - row_sums(self.across, one), right[others] - row_sums(self.along, one))
        return jnp.concatenate([found[:before], self.own.together(self.blocks, one, found[before:])])


def _numbers(blocks: Blocks, equations: int) -> tuple[np.ndarray, np.ndarray]:
    """List the numbers of the own equations of all blocks in turn, and of the others."""
    return np.array(blocks.first, int), np.setdiff1d(np.arange(equations), blocks.first)


def block_factors(matrix: Float[Array, "n n poses"], equations: Matrix, blocks: Blocks) -> BlockFactors:
    """Factorise M and E in each pose; the last unknowns are those in the equations."""
    first, others = _numbers(blocks, len(equations))
    before = len(matrix) - equations.shape[1]
    own = own_equations(equations, blocks)
    # found once, here and below: XLA would find all of it anew wherever it is used
    along, left = lax.optimization_barrier(own.apart(blocks, equations[others].swapaxes(0, 1)))
    along, left = along.swapaxes(0, 1), left.swapaxes(0, 1)
    # rows and columns of M by the last components of the blocks
    lower = lax.optimization_barrier(own.apart(blocks, matrix[before:])[1])
    some = jnp.concatenate([matrix[:before], lower])
    across, held = lax.optimization_barrier(own.apart(blocks, some[:, before:].swapaxes(0, 1)))
    across, held = across.swapaxes(0, 1), held.swapaxes(0, 1)
    found = factors(jnp.concatenate([some[:, :before], held], axis=1), left)
    order = np.argsort(np.concatenate([first, others]))

    def combinations() -> Matrix:
        by_own = product(found.vanishing, product(along, own.inverse))
        return independent_rows(jnp.concatenate([-by_own, found.vanishing], axis=1)[:, order])

    none = jnp.zeros((len(found.vanishing), *equations.shape[::2]), equations.dtype)
    vanishing = lax.cond(jnp.any(found.vanishing != 0), combinations, lambda: none)
    return BlockFactors(blocks, own, along, across, found, vanishing)
