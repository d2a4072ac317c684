"""Coulomb friction in joints: what presses their faces together, and what their sliding costs.

The faces of a joint slide on each other with the velocity s = (v, r w): v is that of the point of the joint on part 2
relative to part 1, w the relative angular velocity, r the radius at which the faces touch. They are pressed together by
N, the part of what the joint transmits that it could not transmit by sliding: see `PairFriction`. Friction acts on part
2 against the sliding,

    (force, torque / r) = -mu N s / |s|,

and on part 1 the other way round. Its power is -mu N |s|.

Reactions depend on friction, and friction on reactions: the balance of the parts (`balance`) is linear in the loads
along the freedoms of joints, so that what presses joint j is c_j = c_j0 + sum over k of C_jk N_k, and N_j = |c_j|. The
c_j0 and C_jk are found by one factorisation a pose; the few equations that are left by Newton's method. Near the joints
without friction the Jacobian 1 - d|c|/dN is the identity; where its determinant has changed its sign, or no N is found,
no forces move the mechanism as it is prescribed: it locks.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce
from operator import add
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from jaxkin._named import Named
from jaxkin.effects.forces.balance import balance, solve
from jaxkin.effects.forces.friction_of import FRICTION_OF
from jaxkin.effects.forces.friction_result import Friction
from jaxkin.effects.forces.given import JointFriction
from jaxkin.effects.forces.moving_parts import MovingParts
from jaxkin.effects.forces.places import relative_twist
from jaxkin.effects.forces.screws import Twist, cross, velocity_at
from jaxkin.effects.forces.wrenches import Loads
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.geometry.units import METRES
from jaxkin.joints.joint import JointCoordinate
from jaxkin.joints.kinds import JointKind
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.known_motion import KnownDrive
from jaxkin.mechanism.motion import Motion
from jaxkin.solve.execution.compiler import whole_program

FOLLOWED = 12
"""Steps in which friction grows from none to all of it, one of Newton's each: from the joints without friction at once,
a screw with mu above the tangent of its lead angle was not solved, whose thread is pressed the other way round then."""
STEPS = 20
"""Steps of Newton's method in all: it needs 4 to 6 once friction has grown."""
EXACT_STEPS = 2
"""Steps that are differentiated, from the solution: they change nothing, and carry derivatives up to the third."""
MAX_CRAMER = 3
"""Joints with friction up to which Newton's steps are written out: a library took two thirds of the time for one."""
SOLVED = 1e4
"""Largest error of N, in units of rounding of the largest force, that counts as solved: that of the balance itself."""


class Sliding(NamedTuple):
    """How the faces of a joint slide on each other in each pose."""

    against: Twist
    """The wrench of friction of one newton, -s/|s|, about the middle of the mechanism; zero at rest."""
    rests: Bool[Array, " poses"]


class _RubbingJoint(NamedTuple):
    """A joint with friction."""

    number: int
    """That of the joint in `Linkage.joints`."""
    given: JointFriction
    wrench: Twist
    """The wrench of its friction where a newton presses its faces together, mu times `Sliding.against`."""


def with_friction(
    motion: Motion, drive: KnownDrive, moving: MovingParts, all_loads: Loads, given: Sequence[JointFriction]
) -> tuple[Loads, Friction | None]:
    """Add to the loads the wrenches of the friction that is `given`, and return what is known of it; None without.

    All joints have been placed. Where the mechanism locks, there is no friction, and `Friction.locked` says so.
    """
    if not given:
        return all_loads, None
    wrenches, locked, found = _solved(drive, motion.mechanism.linkage, moving, all_loads, tuple(given))
    locked = locked & motion.closed
    known = motion.closed & ~locked
    normal, limit, losses, rests = (
        Named("joint with friction", zip((each.joint for each in given), rows, strict=True)) for rows in found
    )
    normal, limit, losses = (
        jax.tree.map(lambda rows: jnp.where(known, rows, jnp.nan), each) for each in (normal, limit, losses)
    )
    return all_loads._replace(friction=wrenches), Friction(motion, normal, limit, losses, rests, locked)


@partial(whole_program, static=(0,))
def _solved(
    drive: KnownDrive,
    linkage: Linkage,
    moving: MovingParts,
    all_loads: Loads,
    given: tuple[JointFriction, ...],
) -> tuple[dict[int, Twist], Bool[Array, " poses"], tuple[list[Array], ...]]:
    """Compute the wrenches of friction, whether poses lock, and for each joint N, mu N, watts, and whether it rests."""
    names = [joint.name for joint in linkage.joints]
    numbers = [names.index(each.joint) for each in given]
    slides = [_sliding(linkage, moving, number, each) for number, each in zip(numbers, given, strict=True)]
    most = [jnp.asarray(each.coefficient, float) for each in given]
    rubbing = [
        _RubbingJoint(number, each, mu * slide.against)
        for number, each, mu, slide in zip(numbers, given, most, slides, strict=True)
    ]
    normal, locked = _normal_forces(*_pressing(drive, linkage, moving, all_loads, rubbing))
    wrenches = {joint.number: pressed * joint.wrench for joint, pressed in zip(rubbing, normal, strict=True)}
    lever = moving.at.scale.size * METRES[drive.unit]
    losses = [
        -lever * jnp.sum(wrench * _twist_in(linkage, moving, number), axis=0) for number, wrench in wrenches.items()
    ]
    limits = [mu * pressed for mu, pressed in zip(most, normal, strict=True)]
    return wrenches, locked, (list(normal), limits, losses, [slide.rests for slide in slides])


def _twist_in(linkage: Linkage, moving: MovingParts, number: int) -> Twist:
    """Compute the twist of part 2 of a joint relative to part 1, about the middle."""
    rates = moving.velocity[number] if moving.velocity else jnp.zeros_like(moving.displacements[number])
    return relative_twist(linkage.joints[number], moving.at.joints[number], rates, moving.at.scale)


def _sliding(linkage: Linkage, moving: MovingParts, number: int, given: JointFriction) -> Sliding:
    """Find how the faces of a joint slide on each other."""
    arm, scale = moving.at.joints[number].point, moving.at.scale
    twist = _twist_in(linkage, moving, number)
    radius = 0.0 if given.radius is None else jnp.asarray(given.radius, float) / scale.size
    squares = jnp.stack([jnp.sum(each**2, axis=0) for each in (twist, *moving.twists.values())])
    still = float(jnp.finfo(squares.dtype).eps) * jnp.max(squares, axis=0)

    def moving_part(rate: Float[Array, "3 poses"]) -> Float[Array, "3 poses"]:
        return jnp.where(jnp.sum(rate**2, axis=0) > still, rate, 0.0)

    # slide and turn each by itself: a hinge turns, however small it is
    slide, turn = velocity_at(twist, arm), twist[:3]
    moves = jnp.concatenate([moving_part(slide), radius * moving_part(turn)])
    rests = jnp.sum(moves**2, axis=0) == 0.0
    smooth = jnp.asarray(given.smooth, float) / scale.size
    # what fades has a direction at rest: its derivative by the velocity is not zero there
    fades = smooth > 0
    s = jnp.where(fades, jnp.concatenate([slide, radius * turn]), moves)
    none = rests & ~fades
    rate = jnp.where(none, 1.0, jnp.sum(s**2, axis=0)) + smooth**2
    direction = -jnp.where(none, 0.0, 1.0) * s / jnp.sqrt(rate)
    return Sliding(jnp.concatenate([radius * direction[3:] + cross(arm, direction[:3]), direction[:3]]), rests)


def _pressing(
    drive: KnownDrive, linkage: Linkage, moving: MovingParts, all_loads: Loads, rubbing: Sequence[_RubbingJoint]
) -> tuple[Float[Array, "joints 4 poses"], Float[Array, "joints joints 4 poses"]]:
    """Compute what presses each joint without friction, c_0, and per newton of N in each joint, C by (k, j)."""
    driven = [(joint, k) for _, joint, k in drive.driven]
    found = balance(linkage, moving.at, moving.displacements, driven)
    lever = moving.at.scale.size * METRES[drive.unit]
    poses = found.arms[0].shape[1]

    def pressed(
        acting: dict[str, Twist], loaded: dict[JointCoordinate, Array], friction_loads: Float[Array, "joints poses"]
    ) -> Float[Array, "joints 4 poses"]:
        sent = solve(linkage, found, driven, acting, loaded).wrenches
        each = zip(rubbing, friction_loads, strict=True)
        return jnp.stack(
            [_pressed(linkage, moving, joint.number, joint.given, sent[joint.number], load) for joint, load in each]
        )

    # without friction first, then one newton of N in each joint
    loaded = {
        (number, k): jnp.zeros((len(rubbing) + 1, poses))
        for number, joint in enumerate(linkage.joints)
        for k in range(joint.freedoms)
        if (number, k) not in driven
    }
    for (number, k), load in all_loads.joints.items():
        if (number, k) in loaded:
            own = load / (1.0 if is_length(linkage.joints[number].coordinates[k]) else lever)
            loaded[number, k] = loaded[number, k].at[0].set(own)
    for row, (number, _, wrench) in enumerate(rubbing, start=1):
        for k, screw in enumerate(found.screws[number]):
            if (number, k) in loaded:
                loaded[number, k] = loaded[number, k].at[row].set(jnp.sum(wrench * screw, axis=0))
    acting = {
        part: jnp.zeros((len(rubbing) + 1, 6, poses)).at[0].set(jnp.broadcast_to(wrench, (6, poses)))
        for part, wrench in all_loads.parts.items()
    }
    turning = jnp.stack([jnp.sum(wrench * found.screws[number][-1], axis=0) for number, _, wrench in rubbing])
    friction_loads = jnp.concatenate([jnp.zeros((1, *turning.shape)), jnp.eye(len(rubbing))[:, :, None] * turning])
    every = jax.vmap(pressed)(acting, loaded, friction_loads)
    return every[0], every[1:]


def _pressed(
    linkage: Linkage,
    moving: MovingParts,
    number: int,
    given: JointFriction,
    wrench: Twist,
    friction_load: Float[Array, " poses"],
) -> Float[Array, "4 poses"]:
    """Select from the wrench that a joint transmits what presses its faces together: N is the length of these rows.

    A screw of radius r and advance p transmits through its thread the force F along its axis, and the torque T with
    T + p F = L, the `friction_load` along its coordinate: what else acts there, such as its drive, is a torque beside
    the thread. Across the thread this is (r F - p T / r) / h = F h / r - L p / (r h), h^2 = r^2 + p^2.
    """
    (movement,), own = (MOVEMENTS[name] for name in linkage.joints[number].movements), moving.at.joints[number]
    which, force, helical = FRICTION_OF[movement.subgroup_joint], wrench[3:], movement.subgroup_joint == JointKind.SCREW
    none = jnp.zeros((1, wrench.shape[1]))
    if which.along and which.across and not helical:
        return jnp.concatenate([force, none])
    axis = own.twists[-1][3:] if movement.only_slides else own.twists[-1][:3]
    far = jnp.sum(force * axis, axis=0)
    across = force - far * axis
    if not helical:
        return jnp.concatenate([far * axis if which.along else across, none])
    radius = jnp.asarray(given.radius, float) / moving.at.scale.size
    advance = jnp.sum(velocity_at(own.twists[-1], own.point) * axis, axis=0)
    slant = jnp.sqrt(radius**2 + advance**2)
    through = far * slant / radius - friction_load * advance / (radius * slant)
    return jnp.concatenate([across, through[None]])


def _normal_forces(
    c_0: Float[Array, "joints 4 poses"], by: Float[Array, "joints joints 4 poses"]
) -> tuple[Float[Array, "joints poses"], Bool[Array, " poses"]]:
    """Solve N_j = |c_j0 + sum over k of C_kj N_k| in each pose: N, zero where poses lock, and whether they do."""
    unit = jnp.eye(len(c_0))

    def step(c_0: Array, by: Array, normal: Array) -> tuple[Array, Array, Array]:
        """Take a step of Newton's method; returns also the error before it, and the determinant of the Jacobian."""
        c = c_0 + jnp.sum(by * normal[:, None, None], axis=0)
        square = jnp.sum(c**2, axis=1)
        size = jnp.sqrt(jnp.where(square > 0, square, 1.0)) * jnp.where(square > 0, 1.0, 0.0)
        along = c / jnp.where(square > 0, size, 1.0)[:, None]
        jacobian = unit[..., None] - jnp.sum(along * by, axis=2).swapaxes(0, 1)
        change, determinant = _solve(jacobian, normal - size)
        return normal - change, normal - size, determinant

    fixed_0, fixed_by = lax.stop_gradient((c_0, by))
    found = jnp.sqrt(jnp.sum(fixed_0**2, axis=1))

    def grown(number: Array, normal: Array) -> Array:
        return step(fixed_0, jnp.minimum(1.0, (number + 1) / FOLLOWED) * fixed_by, normal)[0]

    found = lax.fori_loop(0, STEPS, grown, found)
    _, error, determinant = step(fixed_0, fixed_by, found)
    largest = jnp.max(jnp.abs(fixed_0), axis=(0, 1)) + jnp.max(jnp.abs(found), axis=0)
    solved = jnp.max(jnp.abs(error), axis=0) <= SOLVED * float(jnp.finfo(c_0.dtype).eps) * largest
    locked = ~(solved & (determinant > 0))
    # where poses lock, nothing is left to solve: their derivatives would be no numbers
    found = jnp.where(locked, 0.0, found)
    c_0, by = jnp.where(locked, 0.0, c_0), jnp.where(locked, 0.0, by)
    for _ in range(EXACT_STEPS):
        found, *_ = step(c_0, by, found)
    return found, locked


def _solve(
    matrix: Float[Array, "n n poses"], right: Float[Array, "n poses"]
) -> tuple[Float[Array, "n poses"], Float[Array, " poses"]]:
    """Solve a linear system in each pose; returns the determinants, too. Few unknowns are found by Cramer's rule."""
    n = len(matrix)
    if n > MAX_CRAMER:
        each = jnp.moveaxis(matrix, -1, 0)
        return jnp.linalg.solve(each, right.T[..., None])[..., 0].T, jnp.linalg.det(each)
    columns = [list(matrix[:, k]) for k in range(n)]
    whole = _determinant(columns)
    replaced = [[*columns[:k], list(right), *columns[k + 1 :]] for k in range(n)]
    return jnp.stack([_determinant(each) / whole for each in replaced]), whole


def _determinant(columns: list[list[Array]]) -> Array:
    """Expand a determinant along its first column."""
    first, *others = columns
    if not others:
        return first[0]
    minors = [[[*column[:row], *column[row + 1 :]] for column in others] for row in range(len(first))]
    signed = ((-1) ** row * first[row] * _determinant(minor) for row, minor in enumerate(minors))
    return reduce(add, signed)
