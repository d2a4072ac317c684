"""Find the cusps and crossings of a curve over one input, to rounding (host code).

At a cusp the point stands still while the input moves; at a crossing two inputs put it to the same place. Both are told
apart by the steps of the inputs, and refined by Newton's method: p' . p'' = 0 for a cusp, p(u) = p(v) for a crossing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin.effects.curve_range import CurveRange, Evaluate
from jaxkin.geometry.pose import Vector

NEWTON_STEPS = 12
"""Newton steps from the steps of the motion: from a few degrees, five reach rounding."""
ALONG_STEPS = 2.0
"""Steps of the motion that a crossing may be refined away from where its polygons cross: curves beside their chords
cross in the next step at most."""
BESIDE_CUSP = 1.0
"""Steps from a cusp within which both inputs of a crossing are only its two sides, which are nearer to each other than
can be told: as far as a motion tells crossings apart, and fifty times what is left of two steps after `NEWTON_STEPS`,
each of which leaves two thirds at a triple zero."""
BLOCK = 512
"""Steps of the curve that are compared with all others at once: some megabytes of numbers."""


class Cusp(NamedTuple):
    """A pose in which the point stands still and turns back."""

    input: float
    """Displacement of the drive."""
    point: Vector


class Crossing(NamedTuple):
    """A place through which the curve passes twice."""

    inputs: tuple[float, float]
    """Displacements of the drive."""
    point: Vector
    angle: float
    """Between the tangents, radians, 0 to pi/2."""


def cusps_of(evaluate: Evaluate, curve: CurveRange) -> tuple[Cusp, ...]:
    """Refine the least speeds of the point, and keep those that are zero."""
    inputs = curve.inputs[:-1] if curve.repeats else curve.inputs
    if len(inputs) < 2:
        return ()
    speed = np.sum(evaluate(inputs).slope ** 2, axis=1)
    if speed.max() == 0:
        return ()
    beside = np.pad(speed, 1, mode="wrap") if curve.repeats else np.pad(speed, 1, constant_values=np.inf)
    at = inputs[(speed <= beside[:-2]) & (speed <= beside[2:])]
    low, high = curve.around(at, 1.0)
    for _ in range(NEWTON_STEPS):
        found = evaluate(curve.within(at))
        # Gauss-Newton on the velocity, which is linear in the input beside a cusp
        square = np.sum(found.bend**2, axis=1)
        change = np.sum(found.slope * found.bend, axis=1) / np.where(square > 0, square, 1.0)
        at = np.clip(at - change, low, high)
    at = curve.within(at)
    found = evaluate(at)
    still = found.closed & (np.linalg.norm(found.slope, axis=1) <= curve.precision.stands_still * np.sqrt(speed.max()))
    cusps: list[Cusp] = []
    for u, point in zip(at[still], found.point[still], strict=True):
        if not any(curve.are_one(u, other.input) for other in cusps):
            cusps.append(Cusp(float(u), point))
    return tuple(sorted(cusps, key=lambda cusp: cusp.input))


def crossings_of(
    evaluate: Evaluate, axes: Float[np.ndarray, "2 3"], curve: CurveRange, extent: float, cusps: Sequence[Cusp]
) -> tuple[Crossing, ...]:
    """Find steps of the curve that cut each other, and refine where."""
    pairs = _cut_steps(curve.points @ axes.T, curve.repeats)
    if not len(pairs):
        return ()
    at = (curve.inputs[pairs] + 0.5 * np.diff(curve.inputs)[pairs]).T
    low, high = curve.around(at, ALONG_STEPS)
    for _ in range(NEWTON_STEPS):
        here = evaluate(curve.within(at).ravel())
        place, slope = ((each @ axes.T).reshape(2, -1, 2) for each in (here.point, here.slope))
        # slope(u) du - slope(v) dv = p(v) - p(u)
        apart, (a, b) = place[1] - place[0], slope
        area = -a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0]
        area = np.where(area == 0, np.inf, area)
        du = (-apart[:, 0] * b[:, 1] + apart[:, 1] * b[:, 0]) / area
        dv = (a[:, 0] * apart[:, 1] - a[:, 1] * apart[:, 0]) / area
        at = np.clip(at + np.stack([du, dv]), low, high)
    at = np.sort(curve.within(at), axis=0)
    here = evaluate(at.ravel())
    place, slope = (each.reshape(2, -1, 3) for each in (here.point, here.slope))
    good = here.closed.reshape(2, -1).all(axis=0)
    good &= np.linalg.norm(place[1] - place[0], axis=1) <= curve.precision.meets * extent
    good &= ~curve.are_one(at[0], at[1])
    # where the curve is drawn twice, two inputs are one pose
    lengths = np.linalg.norm(slope, axis=2)
    cosine = np.abs(np.sum(slope[0] * slope[1], axis=1)) / np.where(lengths.prod(axis=0) > 0, lengths.prod(axis=0), 1.0)
    good &= cosine < 1 - curve.precision.touches
    for cusp in cusps:
        good &= ~curve.are_one(at, cusp.input).any(axis=0)
        good &= ~(curve.steps_between(at, cusp.input) <= BESIDE_CUSP).all(axis=0)
    crossings: list[Crossing] = []
    for k in np.flatnonzero(good):
        u, v = map(float, at[:, k])
        if not any(np.all(curve.are_one(each.inputs, (u, v))) for each in crossings):
            crossings.append(Crossing((u, v), place[0, k], float(np.arccos(min(1.0, cosine[k])))))
    return tuple(sorted(crossings, key=lambda crossing: crossing.inputs))


def _cut_steps(points: Float[np.ndarray, "poses 2"], repeats: bool) -> np.ndarray:
    """List the pairs of steps of a polygon, not neighbours, that cut each other: (pairs, 2).

    The last step is a neighbour of the first one where the polygon `repeats` itself.
    """
    a, b = points[:-1], points[1:]
    found = []

    def side(p, q, r):
        return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])

    for first in range(0, len(a), BLOCK):
        p, q = a[first : first + BLOCK, None], b[first : first + BLOCK, None]
        cut = (side(p, q, a) * side(p, q, b) <= 0) & (side(a, b, p) * side(a, b, q) <= 0)
        rows, columns = np.nonzero(cut)
        rows = rows + first
        later = columns > rows + 1
        if repeats:
            later &= columns - rows < len(a) - 1
        found.append(np.stack([rows[later], columns[later]], axis=1))
    return np.concatenate(found)
