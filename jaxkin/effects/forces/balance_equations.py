"""The equations of the balance of all parts, by its unknowns: wrenches of the chords, and forces of the couplings.

See `jaxkin.effects.forces.balance`. The wrenches of the joints are sums of those of the chords with signs, so that
derivatives by the former are added up to derivatives by the latter. The unknowns are in order: the components of all
chords that are in no equation, their other ones (`WrenchAxes`), and the couplings.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxkin.effects.forces.joint_balance import JointBalance
from jaxkin.effects.forces.wrench_axes import WrenchAxes
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.linkage import Linkage
from jaxkin.solve.linear.own_equations import Blocks

MIN_UNKNOWNS = 24
"""Least number of unknowns, six a loop, of which own equations of the chords are eliminated first: a balance of 30 in
25 equations takes 0.65 of the time, of 18 or 6 as long as without."""


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
    plane: tuple[JointCoordinate, ...] = ()
    """The coordinates (joint, coordinate) that act in the plane in which the loops move; none where they have no such
    plane, or where couplings tie others. All others slide along its normal."""


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
    for each, loop_class in zip(linkage.structure.loop_groups, linkage.classes, strict=True):
        chords = tuple(number for number in each.joints if number not in inside)
        shares = tuple(tuple(share(number, chord) for chord in chords) for number in each.joints)
        columns = [(number, k) for number in each.joints for k in range(linkage.joints[number].freedoms)]
        # joints that disagree with the ideal ones are not quite in the plane of these
        plane = () if linkage.ideal else tuple(columns[column] for column in loop_class.plane or ())
        couplings = [linkage.couplings[number] for number in each.couplings]
        tied = {coordinate(linkage, name) for coupling in couplings for name in coupling.coordinates}
        found.append(BalancedLoops(each.joints, chords, shares, each.couplings, plane if tied <= {*plane} else ()))
    # a joint between two fixed parts is in no loop, and places nothing
    grouped = {number for each in found for number in each.joints}
    alone = [number for number in range(len(linkage.joints)) if number not in inside and number not in grouped]
    return *found, *(BalancedLoops((number,), (number,), ((1,),), ()) for number in alone)


class Equations(NamedTuple):
    """The equations T S^T w = T (t + g f) of all freedoms that have no drive, by the unknowns that they hold."""

    chords: Float[Array, "equations held poses"]
    """T S^T: by the components of the wrenches of the chords."""
    couplings: Float[Array, "equations couplings poses"]
    """-T g: by the forces of the couplings."""

    @property
    def rows(self) -> Float[Array, "equations unknowns poses"]:
        """By components of the chords, then by the couplings."""
        return jnp.concatenate([self.chords, self.couplings], axis=1)


def equations(
    loops: BalancedLoops,
    joints: Sequence[JointBalance],
    ties: Sequence[Sequence[Array]],
    axes: WrenchAxes,
    poses: int,
) -> Equations:
    """Collect the equations T S^T w = T (t + g f) of all joints; `ties` are the gradients g of couplings, by joint."""
    held = (6 - axes.absent) * len(loops.chords)
    by_chords, by_couplings = [jnp.zeros((0, held, poses))], [jnp.zeros((0, len(ties), poses))]
    for number, (joint, shares) in enumerate(zip(joints, loops.shares, strict=True)):
        screws = joint.scaled(axes.components(joint.screws.swapaxes(0, 1))[axes.absent :].swapaxes(0, 1))
        by_chords.append(jnp.concatenate([screws[:, :0], *(share * screws for share in shares)], axis=1))
        gradients = [joint.scaled(tie[number])[:, None] for tie in ties]
        by_couplings.append(-jnp.concatenate([screws[:, :0], *gradients], axis=1))
    return Equations(jnp.concatenate(by_chords), jnp.concatenate(by_couplings))


def own_blocks(linkage: Linkage, loops: BalancedLoops, axes: WrenchAxes, free: Sequence[int]) -> Blocks | None:
    """Tell which equations hold the wrench of one chord only, and are independent in every pose: those of the chord
    itself, if its displacements form a subgroup; None where there are none.

    `free` are the numbers of free coordinates of the joints.
    """
    first, own = [0, *accumulate(free)], []
    for chord in loops.chords:
        at = loops.joints.index(chord)
        joint = linkage.joints[chord]
        movement = MOVEMENTS[joint.movements[0]]
        # of a ball some of the angles without a drive may lock, and couplings hold forces of their own
        alone = len(joint.movements) == 1 and movement.subgroup_joint is not None and not loops.couplings
        regular = alone and (not movement.ball or free[at] == joint.freedoms)
        own.append(tuple(range(first[at], first[at + 1])) if regular else ())
    return Blocks(6 - axes.absent, tuple(own)) if any(own) and 6 * len(own) >= MIN_UNKNOWNS else None


def _signed_sum(signs: Sequence[int], each: Float[Array, "*rows joints poses"]) -> Float[Array, "*rows poses"]:
    """Add up what belongs to each joint with its sign: -1, 0 or 1."""
    terms = (sign * each[..., joint, :] for joint, sign in enumerate(signs) if sign)
    return sum(terms, jnp.zeros_like(each[..., 0, :]))


def gradient_by_chords(
    loops: BalancedLoops, axes: WrenchAxes, each: Float[Array, "6 joints poses"]
) -> Float[Array, "wrenches poses"]:
    """Compute a gradient by the wrenches of the chords from those by the wrench of each joint, by the chain rule."""
    rows = [axes.components(_signed_sum([own[c] for own in loops.shares], each)) for c in range(len(loops.chords))]
    return jnp.concatenate([each[:0, 0], *(row[: axes.absent] for row in rows), *(row[axes.absent :] for row in rows)])


def wrenches_of_chords(
    loops: BalancedLoops, axes: WrenchAxes, unknowns: Float[Array, "unknowns poses"]
) -> list[Float[Array, "6 poses"]]:
    """Select the wrench of each chord from the unknowns, in the axes of the world."""
    chords, poses = len(loops.chords), unknowns.shape[1]
    absent = unknowns[: axes.absent * chords].reshape(chords, axes.absent, poses)
    held = unknowns[axes.absent * chords : 6 * chords].reshape(chords, 6 - axes.absent, poses)
    return [axes.wrench(jnp.concatenate([absent[chord], held[chord]])) for chord in range(chords)]


def stacked(rows: Sequence[Float[Array, "_ poses"]], poses: int) -> Float[Array, "_ poses"]:
    """Stack the rows of all joints; without joints there are none."""
    return jnp.concatenate([jnp.zeros((0, poses)), *rows])


def hessian(
    loops: BalancedLoops, axes: WrenchAxes, arms: Float[Array, "3 joints poses"], found: Equations
) -> Float[Array, "n n poses"]:
    """Compute the Hessian, by x and f, of what is minimised: see the docstring of `jaxkin.effects.forces.balance`.

    `arms` are those of the joints.
    """
    chords, poses, absent = range(len(loops.chords)), arms.shape[-1], axes.absent
    blocks = _hessians_by_chords(loops, axes, arms)

    def part(rows: slice, columns: slice) -> Float[Array, "rows columns poses"]:
        each = [jnp.concatenate([blocks[a, b][rows, columns] for b in chords], axis=1) for a in chords]
        return jnp.concatenate(each) if each else jnp.zeros((0, 0, poses))

    first, last = slice(absent), slice(absent, None)
    by_chords = part(last, last)
    if absent:
        across = part(first, last)
        by_chords = _of_parts(part(first, first), across, by_chords)
    count = found.couplings.shape[1]
    if not count:
        return by_chords
    across = jnp.concatenate(
        [jnp.zeros((absent * len(chords), count, poses)), _products(found.chords, found.couplings)]
    )
    return _of_parts(by_chords, across, _products(found.couplings, found.couplings) + jnp.eye(count)[..., None])


def _hessians_by_chords(
    loops: BalancedLoops, axes: WrenchAxes, arms: Float[Array, "3 joints poses"]
) -> dict[tuple[int, int], Float[Array, "6 6 poses"]]:
    """Differentiate the sum of |w|^2 / 2 over the joints by the wrenches of each two chords, each norm at its joint.

    By torque and force about the middle, that of a joint at the arm a is (1, -[a]; [a], (1 + |a|^2) 1 - a a^T), where
    [a] b is a x b: its sums over joints are those of 1, a and a a^T.
    """
    arms = axes.turned(arms)
    outer = arms[:, None] * arms[None]
    eye, found = jnp.eye(3)[..., None], {}
    for a in range(len(loops.chords)):
        for b in range(a + 1):
            signs = [own[a] * own[b] for own in loops.shares]
            count, (x, y, z), squares = sum(signs), _signed_sum(signs, arms), _signed_sum(signs, outer)
            none = jnp.zeros_like(x)
            lever = jnp.stack([none, -z, y, z, none, -x, -y, x, none]).reshape(3, 3, -1)
            unit = jnp.broadcast_to(count * eye, lever.shape)
            forces = (count + squares[0, 0] + squares[1, 1] + squares[2, 2]) * eye - squares
            own = jnp.concatenate([jnp.concatenate([unit, -lever], axis=1), jnp.concatenate([lever, forces], axis=1)])
            found[a, b] = found[b, a] = axes.in_order(axes.in_order(own).swapaxes(0, 1))  # symmetric
    return found


def _of_parts(one: Array, across: Array, other: Array) -> Float[Array, "n n poses"]:
    """Put a symmetric matrix together from its diagonal blocks, and the one beside the first."""
    return jnp.concatenate(
        [jnp.concatenate([one, across], axis=1), jnp.concatenate([across.swapaxes(0, 1), other], axis=1)]
    )


def _products(one: Float[Array, "rows a poses"], other: Float[Array, "rows b poses"]) -> Float[Array, "a b poses"]:
    """Compute one^T other in each pose."""
    return jnp.sum(one[:, :, None] * other[:, None], axis=0)
