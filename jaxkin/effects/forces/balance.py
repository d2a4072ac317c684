"""The balance of all parts by the forces of their joints, of least norm, in every pose.

A joint transmits any wrench but along its freedoms: with the unit twists S of its free coordinates, S^T w = t, where t
is the load in these coordinates (springs, couplings; zero of a plain hinge). Driven coordinates count as not free: what
is transmitted there is the drive force. So w = S (S^T S)^-1 t + P u with P = 1 - S (S^T S)^-1 S^T, for any u.

Each part must be in balance. Among all u that achieve this the one of least norm is P X^T y, where X^T y are relative
small displacements of the parts of a joint, and y solves the symmetric system

    (sum over joints of X P X^T + sum over couplings of v v^T) y = -(all that acts).

These are the forces of joints of equal stiffness: X P X^T is the stiffness of a joint. Rows are forces about the middle
of the mechanism, torques over its size, six for each part that moves. A freedom that nothing drives makes the system
singular: a tiny damping holds it, and refinement removes the error of it from all else. What is left out of balance
along such freedoms is told as `imbalance`.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxkin.geometry.movements import MOVEMENTS, displaced_columns, is_length
from jaxkin.geometry.rigid import as_rigid, inverse, product
from jaxkin.joints.joint import Joint
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.motion import Motion

DAMPING = 1e4
"""Damping over the mean of the diagonal, in units of rounding: 2e-12 in float64."""
REFINEMENTS = 2
"""Steps that remove the error of the damping, a factor of damping over the smallest eigenvalue each."""

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


def joint_screws(
    joint: Joint, q: Float[Array, "poses _"], part_1: Float[Array, "poses 4 4"], size: Any, driven: Collection[int] = ()
) -> tuple[Float[Array, "poses 3"], Float[Array, "poses 6 _"]]:
    """The point of a joint in each pose, and the unit twists of its coordinates about this point, in world axes.

    Twists are those of part 2 relative to part 1. Lengths count over `size` in linear velocities, and in the
    coordinates that are lengths. The angles of a ball without a drive are replaced by turns about the axes of the
    world, which allow the same at every angle.
    """
    found = jnp.moveaxis(part_1[:, :3], 0, -1)
    twists: list[Any] = []
    first = 0
    for number, (movement, frame) in enumerate(zip(joint.movements, joint.frames_1, strict=True)):
        if number:
            found = product(found, inverse(as_rigid(jnp.asarray(joint.frames_2[number - 1], float))))
        found = product(found, as_rigid(jnp.asarray(frame, float)))
        own: dict[int, Any] = {}
        for element in MOVEMENTS[movement].elements:
            axis, at = found[:, element.axis], found[:, 3]
            turning = jnp.zeros_like(axis) if element.kind == "translate" else axis
            if MOVEMENTS[movement].ball and first not in driven:
                turning = jnp.broadcast_to(jnp.eye(3)[:, element.axis, None], axis.shape)
            pitch = 0.0 if element.kind == "rotate" else jnp.asarray(joint.pitch, float) / (2 * jnp.pi) / size
            along = axis if element.kind == "translate" else pitch * axis
            own[element.coordinate] = turning, along, at
            value = q[:, first + element.coordinate]
            advance = None
            if element.kind != "rotate":
                advance = value if element.kind == "translate" else value * pitch * size
            turn = None if element.kind == "translate" else (jnp.cos(value), jnp.sin(value))
            columns = displaced_columns([found[:, column] for column in range(4)], element.axis, advance, turn)
            found = jnp.stack(columns, axis=1)
        twists += [own[k] for k in range(len(own))]
        first += len(own)
    place = found[:, 3]
    rows = [
        jnp.concatenate([turning, along + jnp.cross(turning, (place - at) / size, axis=0)])
        for turning, along, at in twists
    ]
    screws = jnp.stack(rows, axis=-1) if rows else jnp.zeros((6, q.shape[0], 0))
    return place.T, jnp.moveaxis(screws, 1, 0)


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
        pulled = _pulls(loose)
        places.append(place)
        screws.append(every)
        pulls.append({k: pulled[:, :, column] for column, k in enumerate(free)})
        projectors.append(jnp.eye(6) - jnp.einsum("pij,pkj->pik", pulled, loose))
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


def _pulls(screws: Float[Array, "poses 6 free"]) -> Float[Array, "poses 6 free"]:
    """S (S^T S)^-1: the wrench of least norm that has a unit load in one coordinate and none in the others."""
    if not screws.shape[2]:
        return screws
    gram = jnp.einsum("pik,pil->pkl", screws, screws)
    tiny = DAMPING * jnp.finfo(screws.dtype).eps
    return jnp.moveaxis(jnp.linalg.solve(gram + tiny * jnp.eye(gram.shape[-1]), jnp.moveaxis(screws, 1, 2)), 1, 2)


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


def solve(
    linkage: Linkage, found: Balance, acting: Float[Array, "poses parts 6"], loaded: dict[int, Wrenches]
) -> tuple[tuple[Wrenches, ...], tuple[Float[Array, " poses"], ...], Float[Array, " poses"]]:
    """Solve for the wrench of each joint at its point, by part 1 on part 2, of least norm.

    `acting` is what acts on each part about the middle, `loaded` the wrenches of loads in free coordinates, by joint.
    Returns wrenches (joint loads included), the force of each coupling, and the norm of what is left out of balance.
    """
    rows = {part: row for row, part in enumerate(part for part in linkage.parts if part not in linkage.fixed)}
    moving = [linkage.parts.index(part) for part in rows]
    ends = [(rows.get(joint.parts[0]), rows.get(joint.parts[1])) for joint in linkage.joints]
    poses, count = acting.shape[0], len(rows)

    def onto(number: int, wrench: Any, target: Any) -> Any:
        """Add the wrench of a joint, about the middle, to its parts: opposite ones."""
        for row, sign in zip(ends[number], (-1.0, 1.0), strict=True):
            if row is not None:
                target = target.at[:, row].add(sign * wrench)
        return target

    right = -acting[:, np.array(moving, int)]
    for number, wrench in loaded.items():
        right = onto(number, -jnp.einsum("pij,pj->pi", found.levers[number], wrench), right)
    columns = []
    for tie in found.ties:
        column = jnp.zeros((poses, count, 6))
        for number, wrench in tie.items():
            column = onto(number, jnp.einsum("pij,pj->pi", found.levers[number], wrench), column)
        columns.append(column.reshape(poses, 6 * count))
    matrix = jnp.zeros((poses, count, count, 6, 6))
    for number, (one, other) in enumerate(ends):
        stiffness = jnp.einsum("pij,pjk,plk->pil", found.levers[number], found.projectors[number], found.levers[number])
        for row, sign in ((one, -1.0), (other, 1.0)):
            for column, second in ((one, -1.0), (other, 1.0)):
                if row is not None and column is not None:
                    matrix = matrix.at[:, row, column].add(sign * second * stiffness)
    matrix = matrix.transpose(0, 1, 3, 2, 4).reshape(poses, 6 * count, 6 * count)
    for column in columns:
        matrix = matrix + column[:, :, None] * column[:, None, :]
    y, left = _solve_damped(matrix, right.reshape(poses, 6 * count))
    wrenches = []
    strengths = tuple(jnp.einsum("pi,pi->p", column, y) for column in columns)
    each = y.reshape(poses, count, 6)
    for number, (one, other) in enumerate(ends):
        apart = jnp.zeros((poses, 6))
        if other is not None:
            apart = apart + each[:, other]
        if one is not None:
            apart = apart - each[:, one]
        wrench = jnp.einsum("pij,pkj,pk->pi", found.projectors[number], found.levers[number], apart)
        wrench = wrench + loaded.get(number, 0.0)
        for tie, strength in zip(found.ties, strengths, strict=True):
            wrench = wrench + strength[:, None] * tie.get(number, 0.0)
        wrenches.append(wrench)
    return tuple(wrenches), strengths, jnp.linalg.norm(left, axis=1)


def _solve_damped(matrix: Float[Array, "poses n n"], right: Float[Array, "poses n"]):
    """Solve positive semidefinite systems by a tiny damping and refinement; returns also what is left over."""
    size = matrix.shape[-1]
    if not size:
        return right, right
    scale = jax.lax.stop_gradient(jnp.trace(matrix, axis1=1, axis2=2) / size)
    tiny = DAMPING * jnp.finfo(matrix.dtype).eps * jnp.where(scale > 0, scale, 1.0)
    damped = matrix + tiny[:, None, None] * jnp.eye(size)
    factor = jnp.linalg.cholesky(damped)

    def solved(rows: Array) -> Array:
        below = jax.scipy.linalg.solve_triangular(factor, rows[..., None], lower=True)
        return jax.scipy.linalg.solve_triangular(factor, below, lower=True, trans=1)[..., 0]

    y = solved(right)
    for _ in range(REFINEMENTS):
        y = y + solved(right - jnp.einsum("pij,pj->pi", matrix, y))
    return y, right - jnp.einsum("pij,pj->pi", matrix, y)
