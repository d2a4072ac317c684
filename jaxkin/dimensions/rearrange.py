"""Parts with three joints or more: places for their joints at which the lengths asked for hold, and all others too.

The closed movements of `measure` change one length between two features. With a third one the moved feature must keep
its distances to that as well (a triangle is given by its three sides), which is a small system of equations in the
positions: solved by damped Gauss-Newton steps, differentiated by the implicit function theorem.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.dimensions.feature_geometry import Between, between
from jaxkin.dimensions.features import Feature, Quantity

PLACEMENT_ITERATIONS = 60


class Change(NamedTuple):
    """A length to be changed: static, its target is given beside it."""

    first: int
    second: int
    quantity: Quantity


class Layout(NamedTuple):
    """What is static: the features of a part and which of its lengths change."""

    features: tuple[Feature, ...]
    changes: tuple[Change, ...]


class _Pairs(NamedTuple):
    """The equations of all pairs (first index) for the vectors d from one feature to the other, over the size."""

    project: Any
    """3x3: what of d is the distance."""
    distance: Any
    along: Any
    """Direction of the distance where the equation is linear in d: `project d = distance along`."""
    linear: Any
    """Elsewhere it is `|project d| = distance`."""
    offsets: Any
    """Two vectors, one for either end: `offset d = place`, all zero where nothing is held."""
    places: Any
    angles: Any
    """What the cosines of the angles miss by: directions are given, only positions are solved for."""
    weights: Any
    """Of the features: 1 for those that move, else 0."""


def arrange(xp, layout: Layout, original, guess, targets) -> tuple[Any, Any]:
    """Poses of all features near the guess, and what is left of the equations, relative to the size of the part.

    `original` and `guess` are 4x4 poses (features, 4, 4), `targets` one number a change. The second feature of every
    change moves, and all that coincide with it; the others stay where they are. What is left is at rounding where the
    lengths can hold together, and a differentiable measure of by how much they cannot.
    """
    places = original[:, :3, 3]
    size = xp.sqrt(xp.sum((places - places.mean(axis=0)) ** 2)) + 1e-300
    pairs = _pairs(xp, layout, original, guess, targets, size)
    start = guess[:, :3, 3] / size
    positions = _search(np, _host_loop, pairs, start) if xp is np else _solve(pairs, start)
    rows, _ = _rows(xp, pairs, positions if xp is np else lax.stop_gradient(positions))
    misfit = xp.sqrt(xp.sum(rows**2) + xp.sum(pairs.angles**2) + 1e-300)
    moved = guess[:, :3, 3] + size * (positions - start)  # exactly nothing for what stays
    poses = xp.concatenate([guess[:, :3, :3], moved[:, :, None]], axis=2)
    return xp.concatenate([poses, guess[:, 3:]], axis=1), misfit


class _Pair(NamedTuple):
    """Two features of the part, as they are and as they are guessed."""

    i: int
    j: int
    one: Feature
    two: Feature
    was: Between
    now: Between
    direction_1: Any
    direction_2: Any
    """As they are guessed."""
    delta: Any
    """From the origin of the first to that of the second, as they are."""


def _pairs(xp, layout: Layout, original, guess, targets, size) -> _Pairs:
    """Put together the equations of all pairs of features; `size` is what lengths are divided by."""
    wanted: dict[tuple[int, int, str], Any] = {
        (change.first, change.second, change.quantity): target
        for change, target in zip(layout.changes, targets, strict=True)
    }
    features = layout.features
    pairs = [
        _Pair(
            i,
            j,
            features[i],
            features[j],
            between(xp, features[i], original[i], features[j], original[j]),
            between(xp, features[i], guess[i], features[j], guess[j]),
            guess[i][:3, features[i].axis],
            guess[j][:3, features[j].axis],
            original[j][:3, 3] - original[i][:3, 3],
        )
        for i, j in combinations(range(len(features)), 2)
    ]
    coincident = {(i, i): xp.asarray(True) for i in range(len(features))}
    for pair in pairs:
        apart = (pair.was.distance == 0) & pair.was.parallel
        coincident[pair.i, pair.j] = coincident[pair.j, pair.i] = apart
    entries = []
    for pair in pairs:
        project, along, linear = _distance_equation(xp, pair, wanted)
        vectors, places = zip(*_offset_equations(xp, pair, original, wanted, size), strict=True)
        distance = _distance(xp, pair, wanted, coincident) / size
        angle = xp.asarray(_angle_misfit(xp, pair, wanted))
        entries.append((project, distance, along, linear, xp.stack(vectors), xp.stack(places), angle))
    columns = [xp.stack([xp.asarray(entry) for entry in column]) for column in zip(*entries, strict=True)]
    return _Pairs(*columns, weights=_movers(xp, layout, coincident))


def _wanted(pair: _Pair, quantity: Quantity, wanted: Mapping[tuple[int, int, str], Any]) -> Any:
    """The length asked for between the two, whichever is named first; None where it is to be kept."""
    return wanted.get((pair.i, pair.j, quantity), wanted.get((pair.j, pair.i, quantity)))


def _distance(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any], coincident: Mapping[tuple[int, int], Any]):
    """The distance that the two are to have: features in one place have one distance to all others."""
    if (asked := _wanted(pair, "distance", wanted)) is not None:
        return asked
    kept = pair.was.distance
    for (a, b, quantity), target in wanted.items():
        if quantity == "distance":
            alike = (coincident[pair.i, a] & coincident[pair.j, b]) | (coincident[pair.i, b] & coincident[pair.j, a])
            kept = xp.where(alike, target, kept)
    return kept


def _distance_equation(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any]) -> tuple[Any, Any, Any]:
    """What of the vector from one to the other is their distance (3x3), its direction, and whether it is linear."""
    one, two, u, v = pair.one, pair.two, pair.direction_1, pair.direction_2
    # what coincides stays so in all directions: a distance has no slope at zero
    together = (pair.was.distance == 0) & (_wanted(pair, "distance", wanted) is None)
    plane = "plane" in (one.kind, two.kind)
    # from one to two; for planes the distance is counted along the normal of the plane
    along = u if one.kind == "plane" else -v if two.kind == "plane" else pair.now.away
    level = xp.eye(3) - xp.outer(v, v) if two.kind == "axis" else xp.eye(3) - xp.outer(u, u)
    if (one.kind, two.kind) == ("point", "point"):
        level = xp.eye(3)
    skew = xp.outer(along, along)
    project = skew if plane else xp.where(pair.now.parallel, level, skew)
    return project, along, together | ~pair.now.parallel | plane


def _angle_misfit(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any]) -> Any:
    """What the cosine of their angle misses by; nothing where one is a point."""
    if "point" in (pair.one.kind, pair.two.kind):
        return 0.0
    target = _wanted(pair, "angle", wanted)
    return pair.direction_1 @ pair.direction_2 - xp.cos(pair.was.angle if target is None else target)


def _offset_equations(
    xp, pair: _Pair, original, wanted: Mapping[tuple[int, int, str], Any], size
) -> Iterator[tuple[Any, Any]]:
    """For either end the vector that the offset is counted along, and its place over the size; zeros where none is
    held."""
    u, v = pair.direction_1, pair.direction_2
    for a, b, feature, other, axis, across, sign in (
        (pair.i, pair.j, pair.one, pair.two, u, v, 1.0),
        (pair.j, pair.i, pair.two, pair.one, v, u, -1.0),
    ):
        place = wanted.get((a, b, "offset"))
        if place is None and not (feature.marked and other.kind == "point"):
            yield 0.0 * axis, 0.0 * size
            continue
        vector = axis
        if other.kind == "axis":  # linear in the vector between them: the foot of the common normal
            cross = xp.cross(axis, across)
            square = xp.where(pair.now.parallel, 1.0, cross @ cross)
            vector = xp.where(pair.now.parallel, axis, xp.cross(across, cross) / square)
        if place is None:
            place = sign * pair.delta @ original[a][:3, feature.axis]
        yield sign * vector, xp.asarray(place / size)


def _movers(xp, layout: Layout, coincident):
    """1 for features that move, 0 for those that stay; what coincides with a moving one goes along."""
    count = len(layout.features)
    moving = sorted({change.second for change in layout.changes})
    moving = moving if len(moving) < count else moving[1:]  # one must stay
    firsts = {change.first for change in layout.changes}
    weights = []
    for i in range(count):
        along = xp.asarray(i in moving)
        for j in moving if i not in firsts else ():
            along = along | coincident[i, j]
        weights.append(xp.where(along, 1.0, 0.0))
    return xp.stack(weights)


def _rows(xp, pairs: _Pairs, positions):
    """What the equations miss by, and their Jacobian for the positions (rows, features, 3)."""
    count = len(positions)
    first, second = np.array(list(combinations(range(count), 2))).T
    incidence = np.zeros((len(first), count))
    incidence[np.arange(len(first)), first], incidence[np.arange(len(first)), second] = -1.0, 1.0
    d = positions[second] - positions[first]
    across = xp.einsum("pij,pj->pi", pairs.project, d)
    square = xp.sum(across**2, axis=1)
    length = xp.sqrt(xp.where(square > 0, square, 1.0))
    linear = pairs.linear[:, None]
    scalar = np.array([1.0, 0.0, 0.0])
    curved = (xp.where(square > 0, length, 0.0) - pairs.distance)[:, None] * scalar
    distances = xp.where(linear, across - pairs.distance[:, None] * pairs.along, curved)
    slope = xp.einsum("pi,pij->pj", across / length[:, None], pairs.project)
    slopes = xp.where(linear[:, :, None], pairs.project, scalar[:, None] * slope[:, None])
    offsets = xp.einsum("pej,pj->pe", pairs.offsets, d) - pairs.places
    rows = xp.concatenate([distances, offsets], axis=1)
    jacobian = xp.concatenate([slopes, pairs.offsets], axis=1)[:, :, None] * incidence[:, None, :, None]
    return rows.ravel(), jacobian.reshape(rows.size, count, 3)


def _search(xp, loop, pairs: _Pairs, start):
    weights = xp.repeat(pairs.weights, 3)

    def step(positions):
        rows, jacobian = _rows(xp, pairs, positions)
        slope = jacobian.reshape(rows.size, -1) * weights
        gram = slope.T @ slope
        damping = (0.1 * xp.minimum(rows @ rows, 1.0) + 1e-15) * xp.trace(gram) + 1e-300
        delta = -weights * xp.linalg.solve(gram + damping * xp.eye(len(gram)), slope.T @ rows)
        length = xp.sqrt(delta @ delta)
        delta = delta * xp.minimum(1.0, 0.5 / (length + 1e-300))
        return positions + delta.reshape(positions.shape), length

    return loop(step, start)


def _host_loop(step, positions):
    for _ in range(PLACEMENT_ITERATIONS):
        positions, length = step(positions)
        if length < 1e-16:
            break
    return positions


def _device_loop(step, positions):
    def go(carry):
        count, positions, _ = carry
        return count + 1, *step(positions)

    start = (jnp.asarray(0), positions, jnp.asarray(jnp.inf, positions.dtype))
    least = 2.0 * float(jnp.finfo(positions.dtype).eps)
    return lax.while_loop(lambda carry: (carry[0] < PLACEMENT_ITERATIONS) & (carry[2] > least), go, start)[1]


@jax.custom_jvp
def _solve(pairs: _Pairs, start: Float[Array, "features 3"]) -> Float[Array, "features 3"]:
    return _search(jnp, _device_loop, pairs, start)


@_solve.defjvp
def _solve_jvp(primals, tangents):
    (pairs, start), (d_pairs, d_start) = primals, tangents
    positions = _solve(pairs, start)
    # features that stay follow the start, those that move follow the equations from there, by the least norm
    _, d_rows = jax.jvp(lambda p, x: _rows(jnp, p, x)[0], (pairs, positions), (d_pairs, d_start))
    rows, jacobian = _rows(jnp, pairs, positions)
    weights = jnp.repeat(pairs.weights, 3)
    inverse = jnp.linalg.pinv(jacobian.reshape(rows.size, -1) * weights, rtol=1e-8)
    return positions, d_start - (weights * (inverse @ d_rows)).reshape(positions.shape)
