"""Where the elementary motions of joints are in each pose, and their unit twists; joints of one kind all at once.

Each joint is looked at in the axes of its part 1, in which no other joint counts, and then carried along with that
part. Joints of the same movements differ in numbers only, so that their arrays are stacked: robots have some twenty
hinges, whose operations by themselves would be a long program to compile.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from operator import itemgetter
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from jaxkin.effects.forces.screws import Scale, Twist, cross
from jaxkin.geometry.chains import coordinate_ranges
from jaxkin.geometry.elementary_motions import ElementaryMotion, amount, displaced_columns, rates
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.patches import FollowedSpline
from jaxkin.geometry.rigid import Rigid, as_rigid, inverse, product
from jaxkin.geometry.trig import cos_sin
from jaxkin.joints.joint import Joint


class JointScrews(NamedTuple):
    """The elementary motions of a joint in each pose."""

    point: Float[Array, "3 poses"]
    """The origin of the last frame, on part 2, from the middle over the size."""
    twists: tuple[Twist, ...]
    """Unit twist of each, from part 1 to part 2; `coordinates_of_motions` lists their coordinates."""
    bends: tuple[dict[int, Twist], ...]
    """Change of each unit twist with the coordinates of its own movement, as a curve or a surface bends, by number of
    the coordinate; empty where it does not change."""

    def coordinates(self, joint: Joint) -> list[Twist]:
        """Add up unit twists by coordinate: a coordinate may be that of several elementary motions."""
        none = jnp.zeros((6, self.point.shape[1]))
        each = list(zip(coordinates_of_motions(joint), self.twists, strict=True))
        return [sum((twist for own, twist in each if own == k), none) for k in range(joint.freedoms)]


def coordinates_of_motions(joint: Joint) -> list[int]:
    """List for each elementary motion of a joint, from part 1 to part 2, the number of its coordinate."""
    return [coordinate for _, coordinate, _ in _elements(joint.movements)]


def _elements(movements: Sequence[str]) -> list[tuple[ElementaryMotion, int, tuple[int, ...]]]:
    """List the elementary motions of movements, the coordinate of each, and those by which its unit twist changes."""
    numbered = zip(movements, coordinate_ranges(movements), strict=True)
    return [
        (element, own[element.coordinate], () if element.law is None else tuple(own))
        for movement, own in numbered
        for element in MOVEMENTS[movement].elements
    ]


class Chain(NamedTuple):
    """The elementary motions of a joint in each pose, while its part 1 is where it was assembled.

    A row is an elementary motion, and after these, of those with a law, their changes by each coordinate.
    """

    axes: Float[Array, "3 rows poses"]
    origins: Float[Array, "3 rows poses"]
    """A point of each axis, world coordinates."""
    slides: Float[Array, "rows #poses"]
    """Derivative of the length of the motion, over the size, by its coordinate over its unit."""
    turns: Float[Array, "rows #poses"]
    """That of its angle."""
    point: Float[Array, "3 poses"]
    """The origin of the last frame, on part 2."""
    displacement: Rigid
    """That of part 2."""


def chains(joints: Sequence[Joint], displacements: Sequence[Float[Array, "poses _"]], scale: Scale) -> list[Chain]:
    """Find the elementary motions of joints, each while its part 1 is where it was assembled."""
    found: dict[int, Chain] = {}
    for alike in _alike(joints):
        first, q = joints[alike[0]], jnp.stack([displacements[number] for number in alike])
        frames_1, frames_2, pitch = (
            jnp.stack([jnp.asarray(getattr(joints[number], name), float) for number in alike])
            for name in ("frames_1", "frames_2", "pitch")
        )
        stacked = jax.vmap(partial(_chain, first, scale))(frames_1, frames_2, pitch, q)
        for place, number in enumerate(alike):
            found[number] = jax.tree.map(itemgetter(place), stacked)
    return [found[number] for number in range(len(joints))]


def carried(
    joints: Sequence[Joint], found: Sequence[Chain], parts_1: Sequence[Rigid], scale: Scale
) -> list[JointScrews]:
    """Carry the elementary motions of joints along with the displacements `parts_1` of their parts 1."""
    screws: dict[int, JointScrews] = {}
    for alike in _alike(joints):
        own = jax.tree.map(lambda *each: jnp.stack(each), *(found[number] for number in alike))
        poses = own.point.shape[-1]
        part_1 = jnp.stack([jnp.broadcast_to(parts_1[number], (3, 4, poses)) for number in alike])
        # found once: XLA would find all of it anew wherever it is used
        points, twists = lax.optimization_barrier(jax.vmap(partial(_carried, scale))(part_1, own))
        elements = _elements(joints[alike[0]].movements)
        for place, number in enumerate(alike):
            rows = [twists[place, :, row] for row in range(twists.shape[2])]
            changes = iter(rows[len(elements) :])
            bends = tuple({k: next(changes) for k in bent} for _, _, bent in elements)
            screws[number] = JointScrews(points[place], tuple(rows[: len(elements)]), bends)
    return [screws[number] for number in range(len(joints))]


def _alike(joints: Sequence[Joint]) -> list[list[int]]:
    """Group the numbers of joints of the same movements; what follows a curve or a surface stays by itself."""
    kinds: dict[Any, list[int]] = {}
    for number, joint in enumerate(joints):
        kinds.setdefault((joint.movements, number if joint.curves else None), []).append(number)
    return list(kinds.values())


def _chain(
    joint: Joint,
    scale: Scale,
    frames_1: Float[Array, "frames 4 4"],
    frames_2: Float[Array, "frames 4 4"],
    pitch: Float[Array, ""],
    q: Float[Array, "poses _"],
) -> Chain:
    """Find the elementary motions of a joint like `joint`, with numbers of its own."""
    poses, units = q.shape[0], scale.of_coordinates(joint)
    last = as_rigid(jnp.eye(4))
    found = jnp.broadcast_to(last, (3, 4, poses))
    lines: list[tuple[Array, Array]] = []
    speeds: list[tuple[Any, Any]] = []
    bent: list[tuple[int, tuple[Any, Any]]] = []
    numbered = zip(joint.movements, coordinate_ranges(joint.movements), strict=True)
    for number, (movement, own) in enumerate(numbered):
        between = as_rigid(frames_1[number])
        found = product(found, product(inverse(last), between)) if number else jnp.broadcast_to(between, (3, 4, poses))
        last = as_rigid(frames_2[number])
        curve = joint.curves[number] if joint.curves else None
        spline = None if curve is None else curve.spline(jnp)
        values = tuple(q[:, k] for k in own)
        point = None if spline is None else spline.at(*values, xp=jnp)
        for element in MOVEMENTS[movement].elements:
            unit = units[own[element.coordinate]]
            if element.law is not None and spline is not None:
                along = partial(_followed_rates, element, spline)
                for k, index in enumerate(own):
                    by_k = tuple(jnp.full_like(each, units[index] * (j == k)) for j, each in enumerate(values))
                    bent.append((len(lines), tuple(each * unit for each in jax.jvp(along, values, by_k)[1])))
            lines.append((found[:, element.axis], found[:, 3]))
            speeds.append(tuple(each * unit for each in rates(element, pitch, point)))
            how_far = amount(element, values[element.coordinate], pitch, point, cos_sin)
            columns = displaced_columns([found[:, column] for column in range(4)], element.axis, *how_far)
            found = jnp.stack(columns, axis=1)
    lines += [lines[row] for row, _ in bent]
    speeds += [change for _, change in bent]
    none = jnp.zeros((3, 0, poses)), jnp.zeros((0, 1))
    axes, origins = (jnp.stack(each, axis=1) for each in zip(*lines, strict=True)) if lines else (none[0], none[0])
    slides, turns = (_stacked(each) for each in zip(*speeds, strict=True)) if speeds else (none[1], none[1])
    return Chain(axes, origins, slides / scale.size, turns, found[:, 3], product(found, inverse(last)))


def _stacked(rows: Sequence[Any]) -> Float[Array, "rows #poses"]:
    """Stack rows, each one number or one a pose."""
    every = jnp.broadcast_arrays(*(jnp.asarray(row, float) for row in rows))
    return jnp.stack([jnp.atleast_1d(row) for row in every])


def _carried(
    scale: Scale, part_1: Float[Array, "3 4 poses"], own: Chain
) -> tuple[Float[Array, "3 poses"], Float[Array, "6 rows poses"]]:
    """Find the point and the unit twists of a joint whose part 1 is displaced."""

    def turned(vectors: Float[Array, "3 rows poses"]) -> Float[Array, "3 rows poses"]:
        x, y, z = (part_1[:, k, None] * vectors[k] for k in range(3))
        return x + y + z

    axes = turned(own.axes)
    places = turned(jnp.concatenate([own.origins, own.point[:, None]], axis=1)) + part_1[:, 3, None]
    arms = scale.arm(places)
    moments = own.turns * cross(arms[:, :-1], axes) + own.slides * axes
    return arms[:, -1], jnp.concatenate([own.turns * axes, moments])


def _followed_rates(
    element: ElementaryMotion, spline: FollowedSpline, *q: Float[Array, " poses"]
) -> tuple[Array, Array]:
    """Differentiate length and angle of a motion along a curve, or over a surface, with respect to its coordinate."""
    slides, turns = rates(element, None, spline.at(*q, xp=jnp))
    return slides * jnp.ones_like(q[0]), turns * jnp.ones_like(q[0])
