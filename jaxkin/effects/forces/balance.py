"""The balance of all parts by the forces of their joints, of least norm, in every pose.

A joint transmits any wrench but along its freedoms: with the unit twists S of its free coordinates, S^T w = t, where t
is the load in these coordinates (springs, couplings; zero of a plain hinge). Driven coordinates count as not free: what
is transmitted there is the drive force. So w = S (S^T S)^-1 t + P u with P = 1 - S (S^T S)^-1 S^T, for any u.

Each part must be in balance. Among all u that achieve this the one of least norm is P X^T y, where X^T y are relative
small displacements of the parts of a joint, and y solves the symmetric system

    (sum over joints of X P X^T + sum over couplings of v v^T) y = -(all that acts).

These are the forces of joints of equal stiffness: X P X^T is the stiffness of a joint. Rows are forces about the middle
of the mechanism, torques over its size, six for each part that moves. A freedom that nothing drives makes the system
singular. Its parts are held in the free coordinates of their joints, by a stiffness so small that it changes nothing
else, and refinement removes the rest of its error: where such a freedom is in balance by itself that takes no force.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.effects.forces.screws import joint_screws, pulls_of, purified
from jaxkin.geometry.movements import is_length
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.motion import Motion

HOLD = 10.0
"""Stiffness of the free coordinates over that of the others, in square roots of rounding: 1.5e-7 in float64. Less would
leave fewer digits to what holds an undriven freedom, more to all else."""
REFINEMENTS = 3
"""Steps that remove the error of that stiffness: each by its ratio to the smallest eigenvalue of the balance, which is
1e-3 or so away from singular poses."""

Wrenches = Float[Array, "poses 6"]
"""Torque over the size of the mechanism, then force: newtons."""


class Balance(NamedTuple):
    """The system of one motion: what each joint transmits, where, and how the parts are tied by it."""

    size: Float[Array, ""]
    """Size of the mechanism, in its unit: the lever arm by which torques are divided."""
    places: tuple[Float[Array, "poses 3"], ...]
    """The point of each joint: the origin of its last frame, on part 2."""
    screws: tuple[Float[Array, "poses 6 _"], ...]
    """Unit twists of the coordinates of each joint about its point: angular, then linear velocity over the size."""
    pulls: tuple[dict[int, Float[Array, "poses 6"]], ...]
    """For each joint and free coordinate the wrench of a unit load in it: a column of S (S^T S)^-1."""
    projectors: tuple[Float[Array, "poses 6 6"], ...]
    """P of each joint."""
    levers: tuple[Float[Array, "poses 6 6"], ...]
    """X of each joint: from its point to the middle of the mechanism."""
    gradients: tuple[dict[tuple[int, int], Float[Array, " poses"]], ...]
    """For each coupling its derivatives by (joint, coordinate), lengths over the size."""
    ties: tuple[dict[int, Float[Array, "poses 6"]], ...]
    """For each coupling and joint the wrench S (S^T S)^-1 g of a unit of its force, g its derivatives."""


def size_and_middle(linkage: Linkage) -> tuple[Float[Array, ""], Float[Array, "3"]]:
    """Root mean square distance of the joints from their middle (1 where it is zero), and the middle."""
    origins = jnp.concatenate([jnp.asarray(joint.frames_1, float)[:, :3, 3] for joint in linkage.joints])
    middle = jnp.mean(origins, axis=0)
    square = jnp.mean(jnp.sum((origins - middle) ** 2, axis=1))
    return jnp.where(square > 0, jnp.sqrt(jnp.where(square > 0, square, 1.0)), 1.0), middle


def balance(motion: Motion) -> Balance:
    """Set up the system for all poses of a motion."""
    linkage = motion.mechanism.linkage
    size, middle = size_and_middle(linkage)
    driven = driven_coordinates(motion)
    gradients = coupling_gradients(motion, size)
    places, screws, pulls, projectors, levers = [], [], [], [], []
    for number, (joint, q) in enumerate(zip(linkage.joints, motion.displacements, strict=True)):
        own = [k for k in range(joint.freedoms) if (number, k) in driven]
        free = [k for k in range(joint.freedoms) if k not in own]
        place, every = joint_screws(joint, q, motion.transforms[joint.parts[0]], size, own)
        loose = every[:, :, np.array(free, int)]
        pulled = pulls_of(loose)
        places.append(place)
        screws.append(every)
        pulls.append({k: pulled[:, :, column] for column, k in enumerate(free)})
        projectors.append(purified(jnp.eye(6) - jnp.einsum("pij,pkj->pik", pulled, loose)))
        levers.append(_lever((place - middle) / size))
    ties: list[dict[int, Array]] = [{} for _ in gradients]
    for tie, gradient in zip(ties, gradients, strict=True):
        for (number, k), slope in gradient.items():
            if k in pulls[number]:
                tie[number] = tie.get(number, 0.0) + slope[:, None] * pulls[number][k]
    joints = (tuple(places), tuple(screws), tuple(pulls), tuple(projectors), tuple(levers))
    return Balance(size, *joints, tuple(gradients), tuple(ties))


def driven_coordinates(motion: Motion) -> dict[tuple[int, int], str]:
    """Name of each driven coordinate, by joint and coordinate."""
    found = {}
    for name in motion.inputs:
        joint, _, own = name.rpartition(".")
        number = list(motion.mechanism.joints).index(joint)
        found[number, motion.mechanism.all_joints[number].coordinates.index(own)] = name
    return found


def coupling_gradients(motion: Motion, size: Any) -> list[dict[tuple[int, int], Float[Array, " poses"]]]:
    """Derivative of each coupling by its coordinates, with lengths over the size."""
    found = []
    joints = list(motion.mechanism.joints)
    for coupling in motion.mechanism.linkage.couplings:
        rows = {}
        for name, factors in zip(coupling.coordinates, jnp.asarray(coupling.coefficients, float), strict=True):
            joint, _, own = name.rpartition(".")
            number = joints.index(joint)
            index = motion.mechanism.all_joints[number].coordinates.index(own)
            q = motion.displacements[number][:, index]
            slope = sum(power * factor * q ** (power - 1) for power, factor in enumerate(factors, start=1))
            rows[number, index] = slope * (size if is_length(own) else 1.0)
        found.append(rows)
    return found


def _lever(arm: Float[Array, "poses 3"]) -> Float[Array, "poses 6 6"]:
    """The matrix that takes a wrench at a point to the origin of the arm: its torque grows by arm cross force."""
    x, y, z = arm.T
    none = jnp.zeros_like(x)
    cross = jnp.stack([none, -z, y, z, none, -x, -y, x, none], axis=1).reshape(-1, 3, 3)
    one = jnp.broadcast_to(jnp.eye(3), cross.shape)
    return jnp.concatenate(
        [jnp.concatenate([one, cross], axis=2), jnp.concatenate([jnp.zeros_like(cross), one], axis=2)], axis=1
    )


class Transmitted(NamedTuple):
    """What joints and couplings transmit."""

    wrenches: tuple[Wrenches, ...]
    """Of each joint at its point, by part 1 on part 2: all of it."""
    held: tuple[Wrenches, ...]
    """The share of it that holds freedoms which nothing drives."""
    couplings: tuple[Float[Array, " poses"], ...]
    """Force of each coupling, newtons: its derivatives times this are the loads in its coordinates."""


def solve(
    linkage: Linkage, found: Balance, acting: Float[Array, "poses parts 6"], loaded: dict[int, Wrenches]
) -> Transmitted:
    """Solve for what the joints transmit, of least norm.

    `acting` is what acts on each part about the middle, `loaded` the wrenches of loads in free coordinates, by joint.
    """
    rows = {part: row for row, part in enumerate(part for part in linkage.parts if part not in linkage.fixed)}
    ends = [(rows.get(joint.parts[0]), rows.get(joint.parts[1])) for joint in linkage.joints]
    poses, count = acting.shape[0], len(rows)

    def onto(number: int, wrench: Any, target: Any) -> Any:
        """Add the wrench of a joint at its point to its parts, opposite ones."""
        about_middle = jnp.einsum("pij,pj->pi", found.levers[number], wrench)
        for row, sign in zip(ends[number], (-1.0, 1.0), strict=True):
            if row is not None:
                target = target.at[:, row].add(sign * about_middle)
        return target

    def apart(number: int, y: Any) -> Any:
        """Displacement of part 2 of a joint relative to part 1, at its point."""
        moved = jnp.zeros((poses, 6))
        for row, sign in zip(ends[number], (-1.0, 1.0), strict=True):
            if row is not None:
                moved = moved + sign * y.reshape(poses, count, 6)[:, row]
        return jnp.einsum("pji,pj->pi", found.levers[number], moved)

    right = -acting[:, np.array([linkage.parts.index(part) for part in rows], int)]
    for number, wrench in loaded.items():
        right = onto(number, -wrench, right)
    columns = []
    for tie in found.ties:
        column = jnp.zeros((poses, count, 6))
        for number, wrench in tie.items():
            column = onto(number, wrench, column)
        columns.append(column.reshape(poses, 6 * count))
    matrix = _assembled(found.levers, found.projectors, ends, count)
    free = _assembled(found.levers, [jnp.eye(6) - each for each in found.projectors], ends, count)
    for column in columns:
        matrix = matrix + column[:, :, None] * column[:, None, :]
    hold = HOLD * float(jnp.finfo(matrix.dtype).eps) ** 0.5
    y, last = _solve_held(matrix, hold * free, right.reshape(poses, 6 * count))
    strengths = tuple(jnp.einsum("pi,pi->p", column, y) for column in columns)
    wrenches, held = [], []
    for number, projector in enumerate(found.projectors):
        moved = hold * apart(number, last)
        held.append(moved - jnp.einsum("pij,pj->pi", projector, moved))
        wrench = jnp.einsum("pij,pj->pi", projector, apart(number, y)) + held[-1] + loaded.get(number, 0.0)
        for tie, strength in zip(found.ties, strengths, strict=True):
            wrench = wrench + strength[:, None] * tie.get(number, 0.0)
        wrenches.append(wrench)
    return Transmitted(tuple(wrenches), tuple(held), strengths)


def _assembled(
    levers: Sequence[Array], projectors: Sequence[Array], ends: Sequence[tuple[int | None, int | None]], count: int
) -> Float[Array, "poses n n"]:
    """The sum over joints of X P X^T, as the stiffness of all parts."""
    poses = levers[0].shape[0]
    matrix = jnp.zeros((poses, count, count, 6, 6))
    for lever, projector, pair in zip(levers, projectors, ends, strict=True):
        stiffness = jnp.einsum("pij,pjk,plk->pil", lever, projector, lever)
        for row, sign in zip(pair, (-1.0, 1.0), strict=True):
            for column, other in zip(pair, (-1.0, 1.0), strict=True):
                if row is not None and column is not None:
                    matrix = matrix.at[:, row, column].add(sign * other * stiffness)
    return matrix.transpose(0, 1, 3, 2, 4).reshape(poses, 6 * count, 6 * count)


def _solve_held(
    matrix: Float[Array, "poses n n"], held: Float[Array, "poses n n"], right: Float[Array, "poses n"]
) -> tuple[Float[Array, "poses n"], Float[Array, "poses n"]]:
    """Solve matrix y = right, semidefinite, with `held` added: (matrix + held) (y_k+1 - y_k) = right - matrix y_k.

    Returns the last y, and the last step, by which `held` makes up for what the matrix cannot balance.
    """
    factor = jnp.linalg.cholesky(matrix + held)

    def solved(rows: Array) -> Array:
        below = jax.scipy.linalg.solve_triangular(factor, rows[..., None], lower=True)
        return jax.scipy.linalg.solve_triangular(factor, below, lower=True, trans=1)[..., 0]

    step = y = solved(right)
    for _ in range(REFINEMENTS):
        step = solved(right - jnp.einsum("pij,pj->pi", matrix, y))
        y = y + step
    return y, step
