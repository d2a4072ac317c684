"""Eliminate equations that hold the unknowns of one block only, and that never depend on others of that block.

In orthonormal axes of a block, of which the first ones are along its own equations, these say the first components of
its unknowns. The other equations are left with the last components of all blocks: of 30 unknowns in 25 equations, those
of five loops, 20 are left in 15.
"""

from __future__ import annotations

from itertools import accumulate
from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.solve.linear.gram import Matrix, column_sums


class Blocks(NamedTuple):
    """Which equations are the own ones of a block of unknowns (static)."""

    width: int
    """Number of unknowns of each block: the first unknowns are those of the blocks in turn."""
    own: tuple[tuple[int, ...], ...]
    """For each block the numbers of its own equations, no more than its unknowns."""

    @property
    def first(self) -> list[int]:
        """The numbers of all own equations, those of the blocks in turn."""
        return [row for own in self.own for row in own]


class OwnEquations(NamedTuple):
    """The own equations of all blocks at every pose, solved in axes of the blocks."""

    axes: Float[Array, "blocks width width poses"]
    """Orthonormal axes of each block."""
    inverse: Float[Array, "own own poses"]
    """That of the own equations by the first components, block by block."""

    def apart(self, blocks: Blocks, vectors: Float[Array, "unknowns *sides poses"]) -> tuple[Array, Array]:
        """Write vectors in the axes: first components of all blocks; last ones, and then what is in no block."""
        width, end = blocks.width, blocks.width * len(blocks.own)
        inside = vectors[:end].reshape(len(blocks.own), 1, width, *vectors.shape[1:])
        axes = self.axes.reshape(*self.axes.shape[:3], *[1] * (vectors.ndim - 2), -1)
        turned = jnp.sum(axes * inside, axis=2)
        one = [turned[k, : len(own)] for k, own in enumerate(blocks.own)]
        other = [turned[k, len(own) :] for k, own in enumerate(blocks.own)]
        return jnp.concatenate(one), jnp.concatenate([*other, vectors[end:]])

    def together(
        self, blocks: Blocks, one: Float[Array, "own poses"], other: Float[Array, "left poses"]
    ) -> Float[Array, "unknowns poses"]:
        """Put a vector together from what `apart` returns."""
        found, at, behind = [], 0, 0
        for axes, own in zip(self.axes, blocks.own, strict=True):
            left = blocks.width - len(own)
            found.append(column_sums(axes, jnp.concatenate([one[at : at + len(own)], other[behind : behind + left]])))
            at, behind = at + len(own), behind + left
        return jnp.concatenate([*found, other[behind:]])


def own_equations(equations: Matrix, blocks: Blocks) -> OwnEquations:
    """Choose axes of all blocks, and solve their own equations, which must be independent."""
    places = [0, *accumulate(map(len, blocks.own))]
    axes: dict[int, Array] = {}
    rows: dict[int, Array] = {}
    for size in sorted(set(map(len, blocks.own))):
        # at once: one by one, their operations are a long program
        alike = [number for number, own in enumerate(blocks.own) if len(own) == size]
        own = [
            equations[list(blocks.own[number]), number * blocks.width : (number + 1) * blocks.width] for number in alike
        ]
        # found once, here and below: XLA would find all of it anew wherever it is used
        found = lax.optimization_barrier(_reflected(jnp.stack(own)))
        for place, number in enumerate(alike):
            around = places[number], places[-1] - places[number + 1]
            axes[number], rows[number] = found[0][place], jnp.pad(found[1][place], ((0, 0), around, (0, 0)))
    every = [rows[number] for number in range(len(blocks.own))]
    return OwnEquations(jnp.stack([axes[number] for number in range(len(blocks.own))]), jnp.concatenate(every))


def _reflected(rows: Float[Array, "alike own width poses"]) -> tuple[Array, Array]:
    """Choose axes by Householder's reflections; returns them, and the inverse of the rows by the first components."""
    alike, own, width, poses = rows.shape
    axes = jnp.broadcast_to(jnp.eye(width, dtype=rows.dtype)[..., None], (alike, width, width, poses))
    for k in range(own):
        # what is left of a row is reflected to its first axis, on the side from which it is farther
        lead = rows[:, k, k:]
        norm = jnp.sqrt(jnp.sum(lead * lead, axis=1))
        first = lead[:, 0] + jnp.where(lead[:, 0] < 0, -norm, norm)
        normal = jnp.concatenate([jnp.zeros_like(rows[:, k, :k]), first[:, None], lead[:, 1:]], axis=1)
        scaled = normal / (norm * jnp.abs(first))[:, None]
        rows = rows - jnp.sum(rows * scaled[:, None], axis=2)[:, :, None] * normal[:, None]
        axes = axes - normal[:, :, None] * jnp.sum(scaled[:, :, None] * axes, axis=1)[:, None]
    found: list[Array] = []
    for i in range(own):
        unit = jnp.zeros_like(rows[:, 0, :own]).at[:, i].set(1.0)
        found.append((unit - sum(rows[:, i, j, None] * before for j, before in enumerate(found))) / rows[:, i, i, None])
    return axes, jnp.stack(found, axis=1) if found else rows[:, :, :0]
