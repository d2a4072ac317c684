"""Parts with three joints or more: places for their joints at which the lengths asked for hold, and all others too.

The closed movements of `measure` change one length between two features. With a third one the moved feature must keep
its distances to that as well (a triangle is given by its three sides), which is a small system of equations in the
positions: solved by damped Gauss-Newton steps, differentiated by the implicit function theorem.
"""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from jaxkin.dimensions.feature_geometry import between
from jaxkin.dimensions.features import Feature, Quantity

STEPS = 60


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


def _pairs(xp, layout: Layout, original, guess, targets, size) -> _Pairs:
    wanted: dict[tuple[int, int, str], Any] = {
        (change.first, change.second, change.quantity): target
        for change, target in zip(layout.changes, targets, strict=True)
    }
    features = layout.features
    before = {
        (i, j): between(xp, features[i], original[i], features[j], original[j])
        for i, j in combinations(range(len(features)), 2)
    }
    coincident = {(i, i): xp.asarray(True) for i in range(len(features))}
    for (i, j), was in before.items():
        coincident[i, j] = coincident[j, i] = (was.distance == 0) & was.parallel
    entries = []
    for (i, j), was in before.items():
        one, two = features[i], features[j]
        now = between(xp, one, guess[i], two, guess[j])
        u, v = guess[i][:3, one.axis], guess[j][:3, two.axis]
        distance = wanted.get((i, j, "distance"), wanted.get((j, i, "distance")))
        kept = was.distance
        for (a, b, quantity), target in wanted.items():
            if quantity == "distance":  # joints in one place have one distance to the others
                alike = (coincident[i, a] & coincident[j, b]) | (coincident[i, b] & coincident[j, a])
                kept = xp.where(alike, target, kept)
        # what coincides stays so in all directions: a distance has no slope at zero
        together = (was.distance == 0) & (distance is None)
        plane, points = "plane" in (one.kind, two.kind), "point" in (one.kind, two.kind)
        # from one to two; for planes the distance is counted along the normal of the plane
        along = u if one.kind == "plane" else -v if two.kind == "plane" else now.away
        level = xp.eye(3) - xp.outer(v, v) if two.kind == "axis" else xp.eye(3) - xp.outer(u, u)
        if (one.kind, two.kind) == ("point", "point"):
            level = xp.eye(3)
        skew = xp.outer(along, along)
        project = skew if plane else xp.where(now.parallel, level, skew)
        angle = 0.0
        if not points:
            target = wanted.get((i, j, "angle"), wanted.get((j, i, "angle")))
            angle = u @ v - xp.cos(was.angle if target is None else target)
        ends = []
        for a, b, feature, other, pose, axis, sign in (
            (i, j, one, two, original[i], u, 1.0),
            (j, i, two, one, original[j], v, -1.0),
        ):
            place = wanted.get((a, b, "offset"))
            held = place is not None or (feature.marked and other.kind == "point")
            if held and other.kind == "axis":  # linear in d: the foot of the common normal
                cross = xp.cross(axis, v if sign > 0 else u)
                square = xp.where(now.parallel, 1.0, cross @ cross)
                foot = xp.cross(v if sign > 0 else u, cross) / square
                vector = xp.where(now.parallel, axis, foot)
            else:
                vector = axis
            if held and place is None:
                place = sign * (original[j][:3, 3] - original[i][:3, 3]) @ pose[:3, feature.axis]
            ends.append((vector * (sign if held else 0.0), place / size if held else 0.0 * size))
        entries.append(
            (
                project,
                (kept if distance is None else distance) / size,
                along,
                together | ~now.parallel | plane,
                xp.stack([vector for vector, _ in ends]),
                xp.stack([xp.asarray(place) for _, place in ends]),
                xp.asarray(angle),
            )
        )
    columns = [xp.stack([xp.asarray(entry) for entry in column]) for column in zip(*entries, strict=True)]
    return _Pairs(*columns, weights=_movers(xp, layout, coincident))


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
    for _ in range(STEPS):
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
    return lax.while_loop(lambda carry: (carry[0] < STEPS) & (carry[2] > least), go, start)[1]


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
