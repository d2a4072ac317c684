"""Place the joints of a part with three joints or more so that new lengths hold, and all its other lengths stay.

The formulas of `feature_geometry` change one length between two features. With a third feature the one that moves must
also keep its lengths to that (a triangle is given by its three sides). This is a small system of equations in the
positions, solved by damped Gauss-Newton steps and differentiated by the implicit function theorem.
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
"""Gauss-Newton steps at most; the loop ends before when a step is of rounding size."""


class Change(NamedTuple):
    """A length to be changed: static, since its target is given separately."""

    first: int
    second: int
    """Indices of the two features; the second one moves."""
    quantity: Quantity


class Layout(NamedTuple):
    """The static input: the features of a part, and which of its lengths change."""

    features: tuple[Feature, ...]
    changes: tuple[Change, ...]


class _Pairs(NamedTuple):
    """The equations of all pairs of features (first axis) for the vectors d between them, divided by the size."""

    project: Any
    """3x3: projects d onto the directions in which the distance is measured."""
    distance: Any
    along: Any
    """Direction of the distance where the equation is linear in d: `project d = distance along`."""
    linear: Any
    """Whether it is linear; otherwise it is `|project d| = distance`."""
    offsets: Any
    """Two vectors, one for the offset along either feature: `offset . d = place`; zero where there is no offset."""
    places: Any
    angles: Any
    """Errors of the cosines of the angles: constant, since only positions are solved for."""
    weights: Any
    """One for each feature: 1 if it moves, else 0."""


def arrange(xp, layout: Layout, original, guess, targets) -> tuple[Any, Any]:
    """Solve for poses of all features near the guess; return them and the misfit, relative to the size of the part.

    `original` and `guess` are 4x4 poses (features, 4, 4), `targets` one number for each change. The second feature of
    every change moves, and so do all that coincide with it; the others stay. The misfit is the norm of all residuals:
    of rounding size where the lengths agree, else a differentiable measure of their contradiction.
    """
    places = original[:, :3, 3]
    size = xp.sqrt(xp.sum((places - places.mean(axis=0)) ** 2)) + 1e-300
    pairs = _pairs(xp, layout, original, guess, targets, size)
    start = guess[:, :3, 3] / size
    positions = _search(np, _host_loop, pairs, start) if xp is np else _solve(pairs, start)
    rows, _ = _rows(xp, pairs, positions if xp is np else lax.stop_gradient(positions))
    misfit = xp.sqrt(xp.sum(rows**2) + xp.sum(pairs.angles**2) + 1e-300)
    moved = guess[:, :3, 3] + size * (positions - start)  # exactly zero for features that stay
    poses = xp.concatenate([guess[:, :3, :3], moved[:, :, None]], axis=2)
    return xp.concatenate([poses, guess[:, 3:]], axis=1), misfit


class _Pair(NamedTuple):
    """Two features of the part, at their original and at their guessed poses."""

    i: int
    j: int
    one: Feature
    two: Feature
    was: Between
    """As they are."""
    now: Between
    """As they are guessed."""
    direction_1: Any
    direction_2: Any
    """As they are guessed."""
    delta: Any
    """From the origin of the first to that of the second, as they are."""


def _pairs(xp, layout: Layout, original, guess, targets, size) -> _Pairs:
    """Collect the equations of all pairs of features; lengths are divided by `size`."""
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
    """Look up the new length between two features, in either order; None where the length is kept."""
    return wanted.get((pair.i, pair.j, quantity), wanted.get((pair.j, pair.i, quantity)))


def _distance(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any], coincident: Mapping[tuple[int, int], Any]):
    """Find the distance that two features have to get; coinciding features get one distance to each other feature."""
    if (asked := _wanted(pair, "distance", wanted)) is not None:
        return asked
    kept = pair.was.distance
    for (a, b, quantity), target in wanted.items():
        if quantity == "distance":
            alike = (coincident[pair.i, a] & coincident[pair.j, b]) | (coincident[pair.i, b] & coincident[pair.j, a])
            kept = xp.where(alike, target, kept)
    return kept


def _distance_equation(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any]) -> tuple[Any, Any, Any]:
    """Make the distance equation of a pair: its projection (3x3), its direction, and whether it is linear in d."""
    one, two, u, v = pair.one, pair.two, pair.direction_1, pair.direction_2
    # features that coincide keep all three components: a distance has no derivative at zero
    together = (pair.was.distance == 0) & (_wanted(pair, "distance", wanted) is None)
    plane = "plane" in (one.kind, two.kind)
    # from the first to the second; from a plane the distance is measured along its normal
    along = u if one.kind == "plane" else -v if two.kind == "plane" else pair.now.away
    level = xp.eye(3) - xp.outer(v, v) if two.kind == "axis" else xp.eye(3) - xp.outer(u, u)
    if (one.kind, two.kind) == ("point", "point"):
        level = xp.eye(3)
    skew = xp.outer(along, along)
    project = skew if plane else xp.where(pair.now.parallel, level, skew)
    return project, along, together | ~pair.now.parallel | plane


def _angle_misfit(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any]) -> Any:
    """Compute the error of the cosine of the angle of a pair; zero where a feature is a point."""
    if "point" in (pair.one.kind, pair.two.kind):
        return 0.0
    target = _wanted(pair, "angle", wanted)
    return pair.direction_1 @ pair.direction_2 - xp.cos(pair.was.angle if target is None else target)


def _offset_equations(
    xp, pair: _Pair, original, wanted: Mapping[tuple[int, int, str], Any], size
) -> Iterator[tuple[Any, Any]]:
    """Make the offset equation along either feature: (vector, offset over the size), zeros where there is none."""
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
        if other.kind == "axis":  # the foot of the common normal is linear in d
            cross = xp.cross(axis, across)
            square = xp.where(pair.now.parallel, 1.0, cross @ cross)
            vector = xp.where(pair.now.parallel, axis, xp.cross(across, cross) / square)
        if place is None:
            place = sign * pair.delta @ original[a][:3, feature.axis]
        yield sign * vector, xp.asarray(place / size)


def _movers(xp, layout: Layout, coincident):
    """Make the weights of the features: 1 for those that move and those that coincide with them, 0 for the others."""
    count = len(layout.features)
    moving = sorted({change.second for change in layout.changes})
    moving = moving if len(moving) < count else moving[1:]  # at least one feature stays
    firsts = {change.first for change in layout.changes}
    weights = []
    for i in range(count):
        along = xp.asarray(i in moving)
        for j in moving if i not in firsts else ():
            along = along | coincident[i, j]
        weights.append(xp.where(along, 1.0, 0.0))
    return xp.stack(weights)


def _rows(xp, pairs: _Pairs, positions):
    """Compute the residuals of all equations, and their Jacobian by the positions (rows, features, 3)."""
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
    """Solve for the positions (features, 3) by damped Gauss-Newton steps of length 0.5 at most, run by `loop`."""
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
    """Repeat steps in numpy until they are of rounding size."""
    for _ in range(PLACEMENT_ITERATIONS):
        positions, length = step(positions)
        if length < 1e-16:
            break
    return positions


def _device_loop(step, positions):
    """Repeat steps in JAX until they are of rounding size."""

    def go(carry):
        count, positions, _ = carry
        return count + 1, *step(positions)

    start = (jnp.asarray(0), positions, jnp.asarray(jnp.inf, positions.dtype))
    least = 2.0 * float(jnp.finfo(positions.dtype).eps)
    return lax.while_loop(lambda carry: (carry[0] < PLACEMENT_ITERATIONS) & (carry[2] > least), go, start)[1]


@jax.custom_jvp
def _solve(pairs: _Pairs, start: Float[Array, "features 3"]) -> Float[Array, "features 3"]:
    """Solve the equations in JAX, with derivatives by the implicit function theorem."""
    return _search(jnp, _device_loop, pairs, start)


@_solve.defjvp
def _solve_jvp(primals, tangents):
    (pairs, start), (d_pairs, d_start) = primals, tangents
    positions = _solve(pairs, start)
    # features that stay have the derivative of the start; the others correct it by the least norm
    _, d_rows = jax.jvp(lambda p, x: _rows(jnp, p, x)[0], (pairs, positions), (d_pairs, d_start))
    rows, jacobian = _rows(jnp, pairs, positions)
    weights = jnp.repeat(pairs.weights, 3)
    inverse = jnp.linalg.pinv(jacobian.reshape(rows.size, -1) * weights, rtol=1e-8)
    return positions, d_start - (weights * (inverse @ d_rows)).reshape(positions.shape)
