"""Move the features of a part with three joints or more so that some lengths get new values and all others stay.

A feature is the point, axis or plane of a joint on the part. The formulas of `feature_geometry` change one length
between two features. With a third feature, the one that moves must also keep its lengths to the third, as a triangle is
given by its three sides. That makes a small system of equations for the positions of the features, which `placement`
solves.

`xp` is numpy on the host or jax.numpy for traced numbers, as in `feature_geometry`; no Python branch depends on a
number. In shapes, "features" is their number n, "pairs" is n (n - 1) / 2 in the order of `itertools.combinations`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from jax import lax

from jaxkin.dimensions.feature_geometry import Between, between
from jaxkin.dimensions.features import Feature, Quantity
from jaxkin.dimensions.placement import PairEquations, residuals, solve_positions, tiny

ROUNDINGS = 64
"""Components of unit vectors that count as zero, in units of the spacing of numbers near 1: several products."""


class Change(NamedTuple):
    """A length to be changed. Its new value is given separately (`targets`), so that a `Change` is static under jit."""

    first: int
    second: int
    """Indices of the two features; the second one moves."""
    quantity: Quantity


class Layout(NamedTuple):
    """The features of a part, and which lengths between them change: static under jit."""

    features: tuple[Feature, ...]
    changes: tuple[Change, ...]


def arrange(xp, layout: Layout, original, guess, targets) -> tuple[Any, Any]:
    """Solve for the poses of all features near a guess, such that the lengths in `layout.changes` get their targets.

    `original` and `guess` hold the poses of the features (features, 4, 4) in one frame of the part, in the unit of the
    mechanism; the guess has the new directions, and its origins are where the search for positions starts. `targets`
    holds a length or an angle in radians for each change. All lengths that do not change keep their values at
    `original`. The second feature of every change moves, and so do all that coincide with it; the others stay.

    Returns the poses (features, 4, 4) and the misfit, dimensionless: the norm of all residuals, with lengths over the
    size of the part (the root of the summed squared distances of the origins from their mean). The misfit is of
    rounding size where all lengths can hold, else a differentiable measure of their contradiction.
    """
    origins, least = original[:, :3, 3], tiny(original.dtype)
    size = xp.sqrt(xp.sum((origins - origins.mean(axis=0)) ** 2)) + least
    # In the axes of the first feature what its joints leave free is often one coordinate, which no equation moves by
    # rounding then: a slide in a plane stays in it.
    turn = guess[0, :3, :3] if xp is np else lax.stop_gradient(guess[0, :3, :3])
    pairs = _turned(xp, turn, _pairs(xp, layout, original, guess, targets, size))
    start = guess[:, :3, 3] @ turn / size
    positions = solve_positions(xp, pairs, _movable(layout), start)
    # the norm of the residuals is least at these positions, so its derivative by them is zero
    rows, _ = residuals(xp, pairs, positions if xp is np else lax.stop_gradient(positions))
    misfit = xp.sqrt(xp.sum(rows**2) + xp.sum(pairs.angle_errors**2) + least)
    moved = guess[:, :3, 3] + size * (positions - start) @ turn.T  # exactly zero for features that stay
    poses = xp.concatenate([guess[:, :3, :3], moved[:, :, None]], axis=2)
    return xp.concatenate([poses, guess[:, 3:]], axis=1), misfit


def _turned(xp, turn, pairs: PairEquations) -> PairEquations:
    """Refer equations to the axes in the columns of `turn`; components of rounding size become zero."""

    def exact(rows):
        small = xp.where(xp.abs(rows) < ROUNDINGS * float(np.finfo(rows.dtype).eps), rows, 0.0)
        return rows - (small if xp is np else lax.stop_gradient(small))  # derivatives stay

    return pairs._replace(
        project=exact(turn.T @ pairs.project @ turn),
        along=exact(pairs.along @ turn),
        offset_vectors=exact(pairs.offset_vectors @ turn),
    )


class _Pair(NamedTuple):
    """Two features of the part, measured at their original and at their guessed poses."""

    i: int
    j: int
    """Indices of the two features in `Layout.features`."""
    one: Feature
    two: Feature
    was: Between
    """Lengths between the two at the original poses."""
    now: Between
    """Lengths between the two at the guessed poses."""
    direction_1: Any
    direction_2: Any
    """(3,): unit vectors of the axis or normal of each feature at its guessed pose."""
    delta: Any
    """(3,): from the origin of the first to that of the second, at the original poses."""


def _pairs(xp, layout: Layout, original, guess, targets, size) -> PairEquations:
    """Collect the equations of all pairs of features; arguments as in `arrange`, lengths are divided by `size`."""
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
        same_place = (pair.was.distance == 0) & pair.was.parallel
        coincident[pair.i, pair.j] = coincident[pair.j, pair.i] = same_place
    entries = []
    for pair in pairs:
        project, along, linear = _distance_equation(xp, pair, wanted)
        vectors, offsets = zip(*_offset_equations(xp, pair, original, wanted, size), strict=True)
        distance = _distance(xp, pair, wanted, coincident) / size
        angle = xp.asarray(_angle_misfit(xp, pair, wanted))
        entries.append((project, distance, along, linear, xp.stack(vectors), xp.stack(offsets), angle))
    columns = [xp.stack([xp.asarray(entry) for entry in column]) for column in zip(*entries, strict=True)]
    return PairEquations(*columns, weights=_movers(xp, layout, coincident))


def _wanted(pair: _Pair, quantity: Quantity, wanted: Mapping[tuple[int, int, str], Any]) -> Any:
    """Look up the new length between two features, in either order; None where the length is kept."""
    return wanted.get((pair.i, pair.j, quantity), wanted.get((pair.j, pair.i, quantity)))


def _distance(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any], coincident: Mapping[tuple[int, int], Any]):
    """Find the distance that two features must get, in the unit of the mechanism.

    It is the target of the pair, or else the target of a pair whose two features coincide with these two, or else the
    distance at the original poses. `coincident` says for each two features whether they coincide.
    """
    if (asked := _wanted(pair, "distance", wanted)) is not None:
        return asked
    kept = pair.was.distance
    for (a, b, quantity), target in wanted.items():
        if quantity == "distance":
            same = (coincident[pair.i, a] & coincident[pair.j, b]) | (coincident[pair.i, b] & coincident[pair.j, a])
            kept = xp.where(same, target, kept)
    return kept


def _distance_equation(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any]) -> tuple[Any, Any, Any]:
    """Make the distance equation of a pair: `project` (3, 3), `along` (3,) and `linear` of `PairEquations`.

    The distance is measured between points in all directions, from a plane along its normal, between skew axes along
    their common normal, and else perpendicular to the axis.
    """
    one, two, u, v = pair.one, pair.two, pair.direction_1, pair.direction_2
    # where the distance is and stays zero the equation is `project d = 0`: the norm has no derivative at zero
    stays_zero = (pair.was.distance == 0) & (_wanted(pair, "distance", wanted) is None)
    plane = "plane" in (one.kind, two.kind)
    # d points from the first feature to the second, the distance from a plane out of the plane
    along = u if one.kind == "plane" else -v if two.kind == "plane" else pair.now.away
    across_axis = xp.eye(3) - xp.outer(v, v) if two.kind == "axis" else xp.eye(3) - xp.outer(u, u)
    if (one.kind, two.kind) == ("point", "point"):
        across_axis = xp.eye(3)
    along_normal = xp.outer(along, along)
    project = along_normal if plane else xp.where(pair.now.parallel, across_axis, along_normal)
    return project, along, stays_zero | ~pair.now.parallel | plane


def _angle_misfit(xp, pair: _Pair, wanted: Mapping[tuple[int, int, str], Any]) -> Any:
    """Compute the cosine of the angle of a pair at the guess less that wanted; zero where a feature is a point."""
    if "point" in (pair.one.kind, pair.two.kind):
        return 0.0
    target = _wanted(pair, "angle", wanted)
    return pair.direction_1 @ pair.direction_2 - xp.cos(pair.was.angle if target is None else target)


def _offset_equations(
    xp, pair: _Pair, original, wanted: Mapping[tuple[int, int, str], Any], size
) -> Iterator[tuple[Any, Any]]:
    """Make the equation `vector . d = offset` for the offset along the first feature, then along the second.

    Yields vector (3,) and offset (a scalar, over the size) for each; zeros where the pair has no such offset.
    """
    u, v = pair.direction_1, pair.direction_2
    for a, b, feature, other, axis, across, sign in (
        (pair.i, pair.j, pair.one, pair.two, u, v, 1.0),
        (pair.j, pair.i, pair.two, pair.one, v, u, -1.0),
    ):
        offset = wanted.get((a, b, "offset"))
        if offset is None and not (feature.marked and other.kind == "point"):
            yield 0.0 * axis, 0.0 * size
            continue
        vector = axis
        if other.kind == "axis":  # the foot of the common normal is linear in d
            cross = xp.cross(axis, across)
            square = xp.where(pair.now.parallel, 1.0, cross @ cross)
            vector = xp.where(pair.now.parallel, axis, xp.cross(across, cross) / square)
        if offset is None:
            offset = sign * pair.delta @ original[a][:3, feature.axis]
        yield sign * vector, xp.asarray(offset / size)


def _movable(layout: Layout) -> tuple[int, ...]:
    """List the features that may move: all but the first ones of changes that are not the second of another one."""
    moving, firsts = _moving(layout), {change.first for change in layout.changes}
    return tuple(i for i in range(len(layout.features)) if i in moving or i not in firsts)


def _moving(layout: Layout) -> list[int]:
    """List the second features of changes; at least one feature is not among them."""
    moving = sorted({change.second for change in layout.changes})
    return moving if len(moving) < len(layout.features) else moving[1:]


def _movers(xp, layout: Layout, coincident):
    """Make the weights (features,): 1 for features that move and those that coincide with them, 0 for the others."""
    moving = _moving(layout)
    firsts = {change.first for change in layout.changes}
    weights = []
    for i in range(len(layout.features)):
        moves = xp.asarray(i in moving)
        for j in moving if i not in firsts else ():
            moves = moves | coincident[i, j]
        weights.append(xp.where(moves, 1.0, 0.0))
    return xp.stack(weights)
