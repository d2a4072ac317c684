"""The equations of the balance of all parts, by its unknowns: wrenches of the chords, and forces of the couplings.

See `jaxkin.effects.forces.balance`. The wrenches of the joints are sums of those of the chords with signs, so that
derivatives by the former are added up to derivatives by the latter.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.joint_balance import JointBalance
from jaxkin.linkage.linkage import Linkage


class BalancedLoops(NamedTuple):
    """Loops whose wrenches are found together, since they have joints or couplings in common (static)."""

    joints: tuple[int, ...]
    """All joints that the loops pass or couplings tie, by number."""
    chords: tuple[int, ...]
    """Those of them that are not in the tree which places the parts, one a loop."""
    shares: tuple[tuple[int, ...], ...]
    """For each of `joints` and each chord the sign with which the wrench of the chord is part of that of the joint: -1,
    0 or 1."""
    couplings: tuple[int, ...]
    """Numbers of the couplings between the joints."""


def balanced_loops(linkage: Linkage) -> tuple[BalancedLoops, ...]:
    """Find through which joints the wrenches of the chords go, for each loop group by itself."""
    inside = {joint: (part, sign) for part, _, joint, sign in linkage.structure.tree}
    parent = {part: before for part, before, _, _ in linkage.structure.tree}

    def ancestry(part: str) -> set[str]:
        return {part, *(ancestry(parent[part]) if part in parent else ())}

    def share(number: int, chord: int) -> int:
        if number not in inside:
            return int(number == chord)
        child, sign = inside[number]
        one, other = (child in ancestry(part) for part in linkage.joints[chord].parts)
        return -sign * (int(other) - int(one))

    found = []
    for each in linkage.structure.loop_groups:
        chords = tuple(number for number in each.joints if number not in inside)
        shares = tuple(tuple(share(number, chord) for chord in chords) for number in each.joints)
        found.append(BalancedLoops(each.joints, chords, shares, each.couplings))
    # a joint between two fixed parts is in no loop, and places nothing
    grouped = {number for each in found for number in each.joints}
    alone = [number for number in range(len(linkage.joints)) if number not in inside and number not in grouped]
    return *found, *(BalancedLoops((number,), (number,), ((1,),), ()) for number in alone)


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


def equations(
    loops: BalancedLoops, joints: Sequence[JointBalance], ties: Sequence[Sequence[Array]], poses: int
) -> Equations:
    """Collect the equations T S^T w = T (t + g f) of all joints; `ties` are the gradients g of couplings, by joint."""
    by_chords, by_couplings = [jnp.zeros((0, 6 * len(loops.chords), poses))], [jnp.zeros((0, len(ties), poses))]
    for number, (joint, shares) in enumerate(zip(joints, loops.shares, strict=True)):
        screws = joint.scaled(joint.screws)
        by_chords.append(jnp.concatenate([screws[:, :0], *(share * screws for share in shares)], axis=1))
        gradients = [joint.scaled(tie[number])[:, None] for tie in ties]
        by_couplings.append(-jnp.concatenate([screws[:, :0], *gradients], axis=1))
    return Equations(jnp.concatenate(by_chords), jnp.concatenate(by_couplings))


def _signed_sum(signs: Sequence[int], each: Float[Array, "*rows joints poses"]) -> Float[Array, "*rows poses"]:
    """Add up what belongs to each joint with its sign: -1, 0 or 1."""
    terms = (sign * each[..., joint, :] for joint, sign in enumerate(signs) if sign)
    return sum(terms, jnp.zeros_like(each[..., 0, :]))


def _hessian_by_chords(
    loops: BalancedLoops, each: Float[Array, "6 6 joints poses"]
) -> Float[Array, "wrenches wrenches poses"]:
    """Compute a Hessian by the wrenches of the chords from those by the wrench of each joint, by the chain rule."""
    chords = range(len(loops.chords))
    rows = [[_signed_sum([own[a] * own[b] for own in loops.shares], each) for b in chords] for a in chords]
    return jnp.concatenate([jnp.concatenate(row, axis=1) for row in rows]) if rows else each[:0, :0, 0]


def gradient_by_chords(loops: BalancedLoops, each: Float[Array, "6 joints poses"]) -> Float[Array, "wrenches poses"]:
    """Compute a gradient by the wrenches of the chords from those by the wrench of each joint, by the chain rule."""
    rows = [_signed_sum([own[c] for own in loops.shares], each) for c in range(len(loops.chords))]
    return jnp.concatenate(rows) if rows else each[:0, 0]


def stacked(rows: Sequence[Float[Array, "_ poses"]], poses: int) -> Float[Array, "_ poses"]:
    """Stack the rows of all joints; without joints there are none."""
    return jnp.concatenate([jnp.zeros((0, poses)), *rows])


def hessian(
    loops: BalancedLoops, by_wrenches: Float[Array, "6 6 joints poses"], found: Equations
) -> Float[Array, "n n poses"]:
    """Compute the Hessian, by x and f, of what is minimised: see the docstring of `jaxkin.effects.forces.balance`.

    `by_wrenches` are those of |w|^2 / 2 by the wrench of each joint.
    """
    by_chords = _hessian_by_chords(loops, by_wrenches)
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
