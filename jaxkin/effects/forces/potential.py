"""The potential energy of the weights of all parts, along the tree from the fixed parts.

The height of a point of a part against gravity g is one number, -g . (R x + t). It takes only the row (g^T R, g^T t) of
the displacement (R, t) of the part, which passes through the joints of the tree as frames do: from the fixed parts on,
each joint multiplies it by its own displacement from the right. Four numbers a part in place of twelve, and no twists:
at rest the drive forces of weights are derivatives of this sum.

The row stands in the frame behind a movement. The frame of the next one, and the weights that are carried there, are
referred to it by constants of the mechanism (`referred_weights`). What is left for each pose is one product with a
constant a movement, and the movement.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin._memory import once_for_each
from jaxkin._traced import traced
from jaxkin.effects.forces.masses import Masses
from jaxkin.effects.forces.screws import Scale
from jaxkin.geometry.elementary_motions import amount, displaced_columns
from jaxkin.geometry.movement import Movement
from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.trig import cos_sin
from jaxkin.joints.joint import JointCoordinate
from jaxkin.linkage.linkage import Linkage
from jaxkin.solve.execution.compiler import whole_program

WeightRow = Sequence[Float[Array, "#poses"]]
"""A row of four numbers in each pose: three in the axes of a frame, and one for its origin."""


class _Passage(NamedTuple):
    """A movement of a joint on the way along the tree (static)."""

    joint: int
    movement: int
    first: int
    """Its first coordinate in the joint."""
    backwards: bool
    """Whether the way leads from part 2 of the joint to part 1."""
    before: int
    """The passage before it, counted from 1; 0 at the fixed parts."""
    moves: bool
    """False for that of a weld: a robot has six links with names for each that moves by itself."""
    row: int
    """The row that stands behind it: one for each passage that moves, counted from 1; 0 at the fixed parts."""
    row_before: int


class CarriedWeights(NamedTuple):
    """Mass and first moment of all that a joint carries, for each row along the tree, and where the rows stand."""

    enters: Float[Array, "movements 4 4"]
    """The frame of the movement before a row, seen from behind the movement before that."""
    mass: Float[Array, " rows"]
    """Kilograms that move with a row and with no later one; first those that rest."""
    moment: Float[Array, "rows 3"]
    """The same mass times its centre, seen from where the row stands."""


def weights_along_tree(linkage: Linkage, masses: Masses) -> CarriedWeights:
    """Return `referred_weights`, found once for a linkage and its masses as long as both live, unless their numbers are
    traced."""
    kept = _kept(masses)
    if linkage in kept:
        return kept[linkage]
    found = _referred(linkage, masses)
    if not traced(found):
        kept[linkage] = found
    return found


@once_for_each
def _kept(masses: Masses) -> WeakKeyDictionary[Linkage, CarriedWeights]:
    """Keep the weights along the tree, by the linkage."""
    del masses
    return WeakKeyDictionary()


def referred_weights(linkage: Linkage, masses: Masses) -> CarriedWeights:
    """Refer the weights of all parts to the movements that carry them.

    Origins are counted from the middle of the mechanism: far from the world's, digits would be lost.
    """
    passages, last = _passages(linkage)
    middle = Scale.of(linkage).middle
    sides = [[jnp.asarray(side, float) for side in (joint.frames_1, joint.frames_2)] for joint in linkage.joints]
    enter, leave = (
        jnp.stack([sides[each.joint][side ^ each.backwards][each.movement] for each in passages])
        .at[:, :3, 3]
        .add(-middle)
        for side in (0, 1)
    )

    def passed(places: Float[Array, "places 4 4"], given: Any) -> tuple[Any, Float[Array, "4 4"]]:
        number, before, moves, enter, leave = given
        enters = _product(places[before], enter)
        return places.at[number].set(_product(jnp.where(moves, jnp.eye(4), enters), _inverse(leave))), enters

    # in a loop: written out for each of two hundred links, the program would be long
    moves = np.array([each.moves for each in passages], bool)
    before = np.array([each.before for each in passages], int)
    places = jnp.broadcast_to(jnp.eye(4), (len(passages) + 1, 4, 4))
    places, enters = lax.scan(passed, places, (np.arange(1, len(places)), before, moves, enter, leave))
    own = np.array([masses.parts.index(part) for part in last], int)
    at = np.array([*last.values()], int)
    centres = _turned(places[at], masses.centre[own] - middle) + places[at, :3, 3]
    row = np.array([0, *(each.row for each in passages)])[at]
    mass = jnp.zeros(moves.sum() + 1).at[row].add(masses.mass[own])
    moment = jnp.zeros((moves.sum() + 1, 3)).at[row].add(masses.mass[own, None] * centres)
    return CarriedWeights(enters[moves], mass, moment)


_referred = whole_program(referred_weights, static=())


def potential(
    linkage: Linkage, weights: CarriedWeights, gravity: Any, displacements: Sequence[Float[Array, "poses _"]]
) -> Float[Array, " poses"]:
    """Compute the potential energy of all weights, in newtons times the unit of the mechanism; zero at the middle."""
    moving = [each for each in _passages(linkage)[0] if each.moves]
    rows: list[WeightRow] = [[*(number[None] for number in jnp.asarray(gravity, float)), jnp.zeros(1)]]
    turns = _turns(linkage, moving, displacements)
    for each, enters in zip(moving, weights.enters, strict=True):
        row: WeightRow = _times(rows[each.row_before], enters)
        for axis, how_far in _motions(linkage, each, displacements[each.joint], turns):
            row = displaced_columns(row, axis, *how_far)
        # found once: XLA would find the whole chain anew wherever it is used
        rows.append(lax.optimization_barrier(row))
    total = jnp.zeros(displacements[0].shape[0])
    for row, mass, moment in zip(rows, weights.mass, weights.moment, strict=True):
        total = total - sum(r * x for r, x in zip(row, (*moment, mass), strict=True))
    return total


def _passages(linkage: Linkage) -> tuple[list[_Passage], dict[str, int]]:
    """List the movements along the tree, and for each part the last one before it, counted from 1."""
    passages: list[_Passage] = []
    last: dict[str, int] = {}
    rows = 0
    for part, parent, number, sign in linkage.structure.tree:
        at, names, first = last.get(parent, 0), linkage.joints[number].movements, 0
        own = []
        for movement, name in enumerate(names):
            own.append((movement, first, bool(MOVEMENTS[name].elements)))
            first += len(MOVEMENTS[name].coordinates)
        for movement, first, moves in own[::sign]:
            rows += moves
            row_before = passages[at - 1].row if at else 0
            row = rows if moves else row_before
            passages.append(_Passage(number, movement, first, sign < 0, at, moves, row, row_before))
            at = len(passages)
        last[part] = at
    return passages, last


def _product(a: Float[Array, "4 4"], b: Float[Array, "4 4"]) -> Float[Array, "4 4"]:
    """Multiply by sums: products of matrices are less exact than their numbers on some devices."""
    return jnp.sum(a[:, :, None] * b[None], axis=1)


def _inverse(place: Float[Array, "4 4"]) -> Float[Array, "4 4"]:
    """Compute the inverse of a place: with its rotation R and origin t, R^T and -R^T t."""
    turn = place[:3, :3].T
    return place.at[:3, :3].set(turn).at[:3, 3].set(-jnp.sum(turn * place[:3, 3], axis=1))


def _turned(places: Float[Array, "parts 4 4"], points: Float[Array, "parts 3"]) -> Float[Array, "parts 3"]:
    """Rotate each point by the rotation of its place."""
    return jnp.sum(places[:, :3, :3] * points[:, None, :], axis=2)


def _turns(
    linkage: Linkage, moving: Sequence[_Passage], displacements: Sequence[Float[Array, "poses _"]]
) -> dict[JointCoordinate, tuple[Any, Any]]:
    """Compute cosine and sine of each angle (joint, coordinate), of all at once: a few operations for many joints."""
    angles = dict.fromkeys(
        (each.joint, each.first + element.coordinate)
        for each in moving
        for element in _movement(linkage, each).elements
        if element.law is None and element.kind != "translate"
    )
    if not angles:
        return {}
    both = cos_sin(jnp.stack([displacements[joint][:, k] for joint, k in angles]))
    # split and not indexed: backwards that is one concatenation, and no sum of arrays padded with zeros
    cos, sin = (lax.split(each, [1] * len(angles)) for each in both)
    return {at: (cos[n][0], sin[n][0]) for n, at in enumerate(angles)}


def _motions(
    linkage: Linkage, passage: _Passage, q: Float[Array, "poses _"], turns: dict[JointCoordinate, tuple[Any, Any]]
) -> list[tuple[int, tuple[Any, Any]]]:
    """List the elementary motions of a movement in their order along the tree: axis, how far along and about it."""
    joint, movement = linkage.joints[passage.joint], _movement(linkage, passage)
    curve = joint.curves[passage.movement] if joint.curves else None
    own = q[:, passage.first : passage.first + len(movement.coordinates)].T
    point = None if curve is None else curve.spline(jnp).at(*own, xp=jnp)
    found = []
    for element in movement.elements:
        turn = turns.get((passage.joint, passage.first + element.coordinate))
        pitch = jnp.asarray(joint.pitch, float)
        found.append((element.axis, amount(element, own[element.coordinate], pitch, point, lambda _, own=turn: own)))
    return [(axis, _back(*far)) for axis, far in reversed(found)] if passage.backwards else found


def _movement(linkage: Linkage, passage: _Passage) -> Movement:
    return MOVEMENTS[linkage.joints[passage.joint].movements[passage.movement]]


def _back(advance: Any, turn: tuple[Any, Any] | None) -> tuple[Any, Any]:
    """Invert an elementary motion."""
    return None if advance is None else -advance, None if turn is None else (turn[0], -turn[1])


def _times(row: WeightRow, frame: Float[Array, "4 4"]) -> WeightRow:
    """Multiply a row by a frame from the right."""
    found = [row[0] * frame[0, j] + row[1] * frame[1, j] + row[2] * frame[2, j] for j in range(4)]
    return [*found[:3], found[3] + row[3]]
