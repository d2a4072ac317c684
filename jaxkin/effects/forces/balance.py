"""The balance of all parts by the forces of their joints, of least norm, in every pose.

Along a tree from the fixed parts, each joint carries all that acts on the parts behind it. What the other joints, the
chords, carry is unknown: six numbers each, as many as a loop has equations. So the wrench of each joint is
w = w_0 + sum of +-x_c over the chords c, and every part is in balance for any x.

A joint transmits any wrench but along its freedoms: with the unit twists S of its free coordinates, S^T w = t, where t
is the load in these coordinates: that of springs, and the derivatives g of couplings times their forces f; zero of a
plain hinge. Driven coordinates count as not free: what is transmitted there is the drive force. Of all x and f that
satisfy these equations, those of least norm minimise

    sum over joints of |P w|^2 + sum over couplings of f^2,    P = 1 - S (S^T S)^-1 S^T,

where |P w| is taken about the point of the joint, torques over the size of the mechanism. These are the forces of
joints of equal stiffness. With T that makes S orthonormal, |P w|^2 is |w|^2 less the square of T S^T w, which is
T (t + g f) where the equations hold: so with E the matrix of the equations T (S^T w - g f) = T t by x and f,

    sum over joints of |w|^2 - 2 (T S^T w) . T (t + g f) + |T (t + g f)|^2, plus sum over couplings of f^2

has the same minimum, and is well-conditioned in every pose. The equations are not where a small force holds a large
one, as near dead centres: see `jaxkin.solve.linear.constrained`. Of loops in a plane half the components of x are in
none of them: see `jaxkin.effects.forces.wrench_axes`. A freedom that nothing drives may leave no x that satisfies them:
then what violates them least, which is what would hold the freedom.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.effects.forces.balance_equations import (
    BalancedLoops,
    balanced_loops,
    equations,
    gradient_by_chords,
    hessian,
    own_blocks,
    stacked,
    wrenches_of_chords,
)
from jaxkin.effects.forces.joint_balance import JointBalance, joint_balances, norm_gradients
from jaxkin.effects.forces.places import Places
from jaxkin.effects.forces.screws import Scale, Twist, Wrench, cross
from jaxkin.effects.forces.wrench_axes import WrenchAxes, wrench_axes
from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.joints.joint import Joint, JointCoordinate
from jaxkin.linkage.coordinates import coordinate
from jaxkin.linkage.joint_motion import JointDisplacements
from jaxkin.linkage.linkage import Linkage
from jaxkin.solve.linear.constrained import minimise_constrained
from jaxkin.solve.linear.gram import column_sums
from jaxkin.solve.range.groups import in_groups

LARGEST_GROUP = 512
"""Poses of a group, which is placed and solved before the next one: its matrices stay in the cache. Reactions in 10,000
poses of a four-bar, without the derivatives of the motion, took 14 ms of a processor in groups of 128, 10 of 512, 12 of
1,024, and 15 where all poses were placed before they were solved."""
SMALLEST_GROUP = 64
"""Operations on fewer poses take as long."""
GROUP_ENTRIES = 2**17
"""Entries of the Hessians of a group. The balance of 30 unknowns took 48 us a pose of a processor in groups of 500
poses, 31 of 128 and 32 of 64."""


class Balance(NamedTuple):
    """The joints in each pose: where they are, and what they let through."""

    scale: Scale | None
    """None where the balance is solved, which needs none."""
    arms: tuple[Float[Array, "3 poses"], ...]
    """The point of each joint, the origin of its last frame on part 2: from the middle, over the size."""
    screws: tuple[tuple[Twist, ...], ...]
    """Unit twists of the coordinates of each joint. The angles of a ball without a drive are replaced by turns about
    the axes of the world, which allow the same at every angle."""
    gradients: tuple[dict[JointCoordinate, Float[Array, " poses"]], ...]
    """For each coupling its derivatives by (joint, coordinate), lengths over the size."""


def balance(
    linkage: Linkage, at: Places, displacements: JointDisplacements, driven: Sequence[JointCoordinate]
) -> Balance:
    """Find the joints in each pose, all of which have been placed; `driven` are (joint, coordinate)."""
    arms = tuple(at.joints[number].point for number in range(len(linkage.joints)))
    screws = []
    for number, joint in enumerate(linkage.joints):
        own = at.joints[number].coordinates(joint)
        for first in _free_balls(joint, [k for k in range(joint.freedoms) if (number, k) in driven]):
            for k, axis in enumerate(np.eye(3)):
                turning = jnp.broadcast_to(jnp.asarray(axis)[:, None], arms[number].shape)
                own[first + k] = jnp.concatenate([turning, cross(arms[number], turning)])
        screws.append(tuple(own))
    return Balance(at.scale, arms, tuple(screws), tuple(coupling_gradients(linkage, displacements, at.scale.size)))


def _free_balls(joint: Joint, driven: Sequence[int]) -> list[int]:
    """List the first coordinate of each ball that ends the chain of a joint and has no drive."""
    # balls before the end of the chain are not at the point of the joint: their angles stay
    ends = list(zip(joint.movements, coordinate_ranges(joint.movements), strict=True))[-1:]
    return [own[0] for movement, own in ends if MOVEMENTS[movement].ball and not set(own) & set(driven)]


def coupling_gradients(linkage: Linkage, displacements: Sequence[Array], size: Any) -> list[dict[Any, Array]]:
    """Differentiate each coupling with respect to its coordinates (joint, coordinate), lengths over the size."""
    found = []
    for coupling in linkage.couplings:
        rows = {}
        for name, factors in zip(coupling.coordinates, jnp.asarray(coupling.coefficients, float), strict=True):
            number, index = coordinate(linkage, name)
            q = displacements[number][:, index]
            slope = sum(power * factor * q ** (power - 1) for power, factor in enumerate(factors, start=1))
            rows[number, index] = slope * (size if is_length(linkage.joints[number].coordinates[index]) else 1.0)
        found.append(rows)
    return found


class Transmitted(NamedTuple):
    """What joints and couplings transmit."""

    wrenches: tuple[Wrench, ...]
    """Of each joint, by part 1 on part 2: all of it."""
    held: tuple[Float[Array, "_ poses"], ...]
    """For each joint the load in its coordinates that holds freedoms which nothing drives, over the size for angles."""
    couplings: tuple[Float[Array, " poses"], ...]
    """Force of each coupling, newtons: its derivatives times this are the loads in its coordinates."""


def solve(
    linkage: Linkage,
    found: Balance,
    driven: Sequence[JointCoordinate],
    acting: dict[str, Wrench],
    loaded: dict[JointCoordinate, Float[Array, " poses"]],
) -> Transmitted:
    """Solve the balance of all parts for what the joints transmit, of least norm.

    `acting` are the wrenches that act on parts, about the middle; `loaded` are the loads t in free coordinates (joint,
    coordinate), newtons.
    """
    poses = found.arms[0].shape[1]
    acting = {part: jnp.broadcast_to(wrench, (6, poses)) for part, wrench in acting.items()}
    loaded = {at: jnp.broadcast_to(load, (poses,)) for at, load in loaded.items()}
    given = found._replace(scale=None), acting, loaded
    return in_groups(lambda group: _solve(linkage, driven, *group), given, group_size(linkage))


def group_size(linkage: Linkage) -> int:
    """Return the number of poses that are balanced together: fewer, the more unknowns a loop group has."""
    unknowns = max((6 * len(each.chords) + len(each.couplings) for each in balanced_loops(linkage)), default=0)
    return max(SMALLEST_GROUP, min(LARGEST_GROUP, GROUP_ENTRIES // max(1, unknowns) ** 2))


def _solve(
    linkage: Linkage,
    driven: Sequence[JointCoordinate],
    found: Balance,
    acting: dict[str, Wrench],
    loaded: dict[JointCoordinate, Float[Array, " poses"]],
) -> Transmitted:
    """Solve the balance for one group of poses: see `solve`."""
    poses = found.arms[0].shape[1]
    free = [
        [k for k in range(each.freedoms) if (number, k) not in driven] for number, each in enumerate(linkage.joints)
    ]
    joints = joint_balances(found.arms, found.screws, free)
    none = jnp.zeros(poses)

    def in_free(given: dict[JointCoordinate, Array]) -> list[Float[Array, "free poses"]]:
        each = ([given.get((number, k), none) for k in own] for number, own in enumerate(free))
        return [jnp.stack(rows) if rows else jnp.zeros((0, poses)) for rows in each]

    loads, ties = in_free(loaded), [in_free(gradients) for gradients in found.gradients]
    carried_by = tree_wrenches(linkage, acting, poses)
    wrenches = [carried_by.get(number, jnp.zeros((6, poses))) for number in range(len(linkage.joints))]
    strengths = [none] * len(ties)
    for loops in balanced_loops(linkage):
        axes = wrench_axes(linkage, loops.plane, [(n, k) for n in loops.joints for k in free[n]], found.screws)
        of_joints, of_couplings = _solve_loops(linkage, loops, axes, joints, wrenches, loads, ties)
        for number, wrench in zip(loops.joints, of_joints, strict=True):
            wrenches[number] = wrench
        for number, strength in zip(loops.couplings, of_couplings, strict=True):
            strengths[number] = strength
    held = []
    for number, (own, joint) in enumerate(zip(free, joints, strict=True)):
        left = joint.along(wrenches[number]) - loads[number]
        left = left - sum((strength * tie[number] for strength, tie in zip(strengths, ties, strict=True)), 0.0)
        rows = [none] * linkage.joints[number].freedoms
        for k, column in enumerate(own):
            rows[column] = left[k]
        held.append(jnp.stack(rows) if rows else jnp.zeros((0, poses)))
    return Transmitted(tuple(wrenches), tuple(held), tuple(strengths))


def _solve_loops(
    linkage: Linkage,
    loops: BalancedLoops,
    axes: WrenchAxes,
    every: Sequence[JointBalance],
    carried: Sequence[Wrench],
    every_load: Sequence[Float[Array, "free poses"]],
    every_tie: Sequence[Sequence[Float[Array, "free poses"]]],
) -> tuple[list[Wrench], list[Float[Array, " poses"]]]:
    """Solve the balance of some loops for the wrenches of their joints and the forces of their couplings.

    What is given is that of all joints and couplings: `carried` are the wrenches w_0.
    """
    joints = [every[number] for number in loops.joints]
    begun, loads = ([given[number] for number in loops.joints] for given in (carried, every_load))
    ties = [[every_tie[coupling][number] for number in loops.joints] for coupling in loops.couplings]
    if not (loops.chords or ties):
        return begun, []
    poses = joints[0].arm.shape[1]
    system = equations(loops, joints, ties, axes, poses)
    load = stacked([joint.scaled(own) for joint, own in zip(joints, loads, strict=True)], poses)
    right = load - stacked([joint.scaled(joint.along(w)) for joint, w in zip(joints, begun, strict=True)], poses)
    arms = jnp.stack([joint.arm for joint in joints], axis=1)
    by_wrenches = gradient_by_chords(loops, axes, norm_gradients(arms, jnp.stack(begun, axis=1)))
    absent = axes.absent * len(loops.chords)
    by_held = column_sums(system.chords, load) - by_wrenches[absent:]
    slope = jnp.concatenate([-by_wrenches[:absent], by_held, column_sums(system.couplings, right)])
    blocks = own_blocks(linkage, loops, axes, [each.screws.shape[0] for each in joints])
    z = minimise_constrained(hessian(loops, axes, arms, system), slope, system.rows, right, blocks=blocks)
    unknown = wrenches_of_chords(loops, axes, z)
    found = [
        w + sum((share * unknown[c] for c, share in enumerate(shares) if share), jnp.zeros((6, poses)))
        for w, shares in zip(begun, loops.shares, strict=True)
    ]
    return found, list(z[6 * len(loops.chords) :])


def tree_wrenches(linkage: Linkage, acting: dict[str, Any], poses: int) -> dict[int, Wrench]:
    """Compute the wrench of each joint of the tree, by part 1 on part 2, that balances all that acts behind it: w_0."""
    none = jnp.zeros((6, poses))
    behind = {part: acting.get(part, none) for part, *_ in linkage.structure.tree}
    found = {}
    for part, before, joint, sign in reversed(linkage.structure.tree):
        found[joint] = -sign * behind[part]
        if before in behind:
            behind[before] = behind[before] + behind[part]
    return found
