"""The equations of the balance of all parts, by its unknowns: wrenches of the chords, and forces of the couplings.

See `jaxkin.effects.forces.balance`. The wrenches of the joints are sums of those of the chords with signs, so that
derivatives by the former are added up to derivatives by the latter.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.joint_balance import JointBalance, Wrenches
from jaxkin.linkage.linkage import Linkage


class Tree(NamedTuple):
    """The spanning tree of joints that places the parts, and its chords (static): see `tree_of`."""

    chords: tuple[int, ...]
    """The joints that are not in the tree."""
    shares: tuple[tuple[int, ...], ...]
    """For each joint and chord the sign with which the wrench of the chord is part of that of the joint: -1, 0 or 1."""


def tree_of(linkage: Linkage) -> Tree:
    """Find the chords of the tree that places the parts, and through which joints their wrenches go."""
    inside = {joint: (part, sign) for part, _, joint, sign in linkage.structure.tree}
    parent = {part: before for part, before, _, _ in linkage.structure.tree}
    chords = tuple(number for number in range(len(linkage.joints)) if number not in inside)

    def ancestry(part: str) -> set[str]:
        return {part, *(ancestry(parent[part]) if part in parent else ())}

    shares = []
    for number in range(len(linkage.joints)):
        if number not in inside:
            shares.append(tuple(int(number == chord) for chord in chords))
            continue
        child, sign = inside[number]
        own = []
        for chord in chords:
            one, other = (child in ancestry(part) for part in linkage.joints[chord].parts)
            own.append(-sign * (int(other) - int(one)))
        shares.append(tuple(own))
    return Tree(chords, tuple(shares))


class Equations(NamedTuple):
    """The equations T S^T w = T (t + g f) of all freedoms that have no drive, by the unknowns."""

    chords: Float[Array, "equations wrenches poses"]
    """T S^T: by the wrenches of the chords."""
    couplings: Float[Array, "equations couplings poses"]
    """-T g: by the forces of the couplings."""

    @property
    def rows(self) -> Float[Array, "equations unknowns poses"]:
        """By all unknowns: wrenches of the chords, then forces of the couplings."""
        return jnp.concatenate([self.chords, self.couplings], axis=1)


def equations(tree: Tree, joints: Sequence[JointBalance], ties: Sequence[Sequence[Array]], poses: int) -> Equations:
    """Collect the equations T S^T w = T (t + g f) of all joints; `ties` are the gradients g of couplings, by joint."""
    by_chords, by_couplings = [jnp.zeros((0, 6 * len(tree.chords), poses))], [jnp.zeros((0, len(ties), poses))]
    for number, (joint, shares) in enumerate(zip(joints, tree.shares, strict=True)):
        screws = joint.scaled(joint.screws)
        by_chords.append(jnp.concatenate([screws[:, :0], *(share * screws for share in shares)], axis=1))
        gradients = [joint.scaled(tie[number])[:, None] for tie in ties]
        by_couplings.append(-jnp.concatenate([screws[:, :0], *gradients], axis=1))
    return Equations(jnp.concatenate(by_chords), jnp.concatenate(by_couplings))


def _hessian_by_chords(tree: Tree, each: Sequence[Array], poses: int) -> Float[Array, "wrenches wrenches poses"]:
    """Compute a Hessian by the wrenches of the chords from those by the wrench of each joint, by the chain rule."""
    chords, none = len(tree.chords), jnp.zeros((6, 6, poses))
    rows = [
        [
            sum((own[a] * own[b] * x for own, x in zip(tree.shares, each, strict=True) if own[a] * own[b]), none)
            for b in range(chords)
        ]
        for a in range(chords)
    ]
    return jnp.concatenate([jnp.concatenate(row, axis=1) for row in rows]) if rows else jnp.zeros((0, 0, poses))


def gradient_by_chords(tree: Tree, each: Sequence[Wrenches], poses: int) -> Float[Array, "wrenches poses"]:
    """Compute a gradient by the wrenches of the chords from those by the wrench of each joint, by the chain rule."""
    rows = [
        sum((own[c] * x for own, x in zip(tree.shares, each, strict=True) if own[c]), jnp.zeros((6, poses)))
        for c in range(len(tree.chords))
    ]
    return jnp.concatenate(rows) if rows else jnp.zeros((0, poses))


def stacked(rows: Sequence[Float[Array, "_ poses"]], poses: int) -> Float[Array, "_ poses"]:
    """Stack the rows of all joints; without joints there are none."""
    return jnp.concatenate([jnp.zeros((0, poses)), *rows])


def hessian(tree: Tree, joints: Sequence[JointBalance], found: Equations, poses: int) -> Float[Array, "n n poses"]:
    """Compute the Hessian, by x and f, of what is minimised: see the docstring of `jaxkin.effects.forces.balance`."""
    by_chords = _hessian_by_chords(tree, [joint.norm_hessian() for joint in joints], poses)
    count = found.couplings.shape[1]
    if not count:
        return by_chords
    across = _products(found.chords, found.couplings)
    own = _products(found.couplings, found.couplings) + jnp.eye(count)[..., None]
    return jnp.concatenate(
        [jnp.concatenate([by_chords, across], axis=1), jnp.concatenate([across.swapaxes(0, 1), own], axis=1)]
    )


def _products(one: Float[Array, "rows a poses"], other: Float[Array, "rows b poses"]) -> Float[Array, "a b poses"]:
    """Compute one^T other in each pose."""
    return jnp.sum(one[:, :, None] * other[:, None], axis=0)
