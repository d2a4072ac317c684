"""Keep samples of the branch, poses with slopes, and predict any pose between them by a cubic or a quintic.

An input that is an angle repeats after a full turn. If the mechanism repeats with it, one turn of samples serves all
turns. And an input beyond an unreachable interval that differs by whole turns from an input that was reached without
crossing one is the same pose as that one.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from jaxkin.geometry.trig import TURN
from jaxkin.solve.closure.closure import Geometry
from jaxkin.solve.closure.spatial_geometry import Spatial
from jaxkin.solve.continuation.fronts import Fronts
from jaxkin.solve.continuation.predictor import SMOOTH, hermite
from jaxkin.solve.continuation.step import NEAR_LIMIT
from jaxkin.solve.linear.blocks import is_costly
from jaxkin.solve.status import Status, closes_before_limits
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.scatter import scatter_rows
from jaxkin.solve.system.state import State, difference, rate, retract, select_poses, turning

EXTRAPOLATED = 1e-3
"""Distance beyond the first or last sample, radians or characteristic lengths, that predictions still cover. The end of
a range and the last sample may differ by rounding; a pose that is wrongly covered shows by its residual."""
APART = 0.1
"""Least distance of a third sample from two neighbours, over the distance between these, at which poses between these
are interpolated through it, too: the rounding of a nearer one is divided by the square of its distance. Of the paper's
Fig. 7 predictions have residuals of 5e-8 with the third sample and 6e-6 without, and close by one Newton step less."""
MEETING = (3.0 - TURN, 3.0)
"""Inputs at which the backward and the forward front meet, radians: a full turn apart, and near half a turn from the
assembled pose but not at half a turn, where change points are common in designs."""


class BranchSamples(NamedTuple):
    """Samples of the branch, sorted by distance along the path, with the assembled pose in the middle."""

    at: Float[Array, " samples"]
    """Distance along the path (the input itself if it is a single one); -inf before the first sample, inf behind the
    last one."""
    table: Float[Array, "samples entries"]
    """All numbers of a sample in one row, written and read by one operation: see `sample_rows`."""
    first: Int[Array, ""]
    """Row of the first sample."""
    last: Int[Array, ""]
    """Row of the last sample."""
    repeats: Bool[Array, ""]
    """Whether the mechanism repeats after a full turn of the input."""
    winding: Float[Array, " columns"]
    """Increase of each coordinate over a full turn of the input: a multiple of 2 pi, or of the length of a closed curve
    for its parameter."""
    complete: Bool[Array, ""]
    """Whether the samples cover the whole range, and the range has no limit."""


class Prediction(NamedTuple):
    """Predicted poses: where the correctors start."""

    state: State
    status: Int[Array, " poses"]
    """Status of each pose if it is corrected to closure near its prediction."""
    covered: Bool[Array, " poses"]
    """Whether the samples reach as far as the input of the pose."""


class Sample(NamedTuple):
    """Samples that were read from the table."""

    at: Float[Array, " samples"]
    state: State
    slope: State
    """Derivative of the state with respect to the distance."""
    status: Int[Array, " samples"]


def sample_rows(system: LoopSystem, fronts: Fronts) -> Float[Array, "fronts entries"]:
    """Write each front as a row: distance, coordinates, quaternions of balls, derivatives of both, and the status."""
    slope = rate(system, fronts.state, fronts.slope)
    which = _stored_columns(system)
    states = [part for x, turns in (fronts.state, slope) for part in (x[which], turns)]
    entries = [part.reshape(-1, part.shape[-1]) for part in (fronts.at, *states)]
    return jnp.concatenate([*entries, fronts.status[None].astype(fronts.residual_norm.dtype)]).T


def _stored_columns(system: LoopSystem) -> np.ndarray:
    """List the columns whose coordinates are stored: all but those of balls, whose rotations are quaternions."""
    return np.flatnonzero(~turning(system))


def _sample(system: LoopSystem, samples: BranchSamples, number: Int[Array, " poses"]) -> Sample:
    """Read the samples in the rows `number`, which must be within bounds."""
    at, column = jnp.split(samples.table.at[number].get(mode="promise_in_bounds").T, [1])
    which, balls = _stored_columns(system), len(system.turned_balls)
    half = len(which) + 4 * balls
    state, slope = (
        State(
            scatter_rows(part[: len(which)], which, system.columns),
            part[len(which) : half].reshape(balls, 4, number.shape[0]),
        )
        for part in (column, column[half:])
    )
    return Sample(at[0], state, slope, column[-1].astype(jnp.int32))


def winding(system: LoopSystem, geometry: Geometry, state: State) -> Float[Array, " columns"]:
    """Compute the whole turns that each coordinate of the second of two fronts has gained on the first.

    Radians; for the parameters of closed curves and surfaces, whole lengths of these.
    """
    gained = state.x[:, 1] - state.x[:, 0]
    turns = jnp.where(np.array(system.is_length), 0.0, TURN * jnp.round(gained / TURN))
    if isinstance(geometry.loops, Spatial):
        for (joint, frame), curve in zip(system.curves, geometry.loops.curves, strict=True):
            for column, whole in enumerate(curve.periods, start=system.chains[joint][frame].column):
                if whole is not None:
                    turns = turns.at[column].set(whole * jnp.round(gained[column] / whole))
    return turns


def predict(system: LoopSystem, samples: BranchSamples, values: Float[Array, " poses"]) -> Prediction:
    """Predict the poses at distances `values` along the path; the driven coordinates are not set to the inputs."""
    if system.periodic:
        values = _wrapped(samples, values)
        turns = jnp.where(samples.repeats, jnp.ceil((values - MEETING[1]) / TURN), 0.0)
        values = values - TURN * turns
    number = jnp.clip(jnp.searchsorted(samples.at, values, side="left") - 1, samples.first, samples.last - 1)
    left, right = _sample(system, samples, number), _sample(system, samples, number + 1)
    side = _trusted_side(left, right, values)
    nearest = select_poses(side.is_left, left.state, right.state)
    nearest = select_poses(side.beyond, _weighted(system, left, right, values), nearest)
    width, t = _fraction(left, right, values)
    curve = hermite(left.state, left.slope, right.state, right.slope, width, t)
    # a path of several inputs is bent anew at each pose: a quintic is no better there
    if len(system.driven) == 1 and is_costly(equation_blocks(system)):
        curve = _through_third(curve, left, right, _sample(system, samples, _third(samples, number, values)), t)
    state = select_poses(side.between, retract(system, curve, jnp.zeros_like(curve.x)), nearest)
    status = jnp.where(side.trusted, jnp.where(side.is_left, left.status, right.status), Status.JUMPED.value)
    if system.periodic:
        state = State(state.x + turns * samples.winding[:, None], state.turns)
    least, most = (samples.at.at[end].get(mode="promise_in_bounds") for end in (samples.first, samples.last))
    return Prediction(state, status, (values >= least - EXTRAPOLATED) & (values <= most + EXTRAPOLATED))


class _TrustedSide(NamedTuple):
    """From which of its two neighbouring samples each pose is predicted."""

    between: Bool[Array, " poses"]
    """Whether both neighbours are closed with one status, so that the pose is interpolated between them."""
    beyond: Bool[Array, " poses"]
    """Whether the pose is beyond a limit, and the outer neighbour too: poses of least residual lie between them."""
    is_left: Bool[Array, " poses"]
    """Whether a pose that is neither of these belongs to the left neighbour."""
    trusted: Bool[Array, " poses"]
    """Whether the pose gets the status of its neighbour; if not, it is JUMPED where it closes."""


def _trusted_side(left: Sample, right: Sample, values: Float[Array, " poses"]) -> _TrustedSide:
    """Choose the neighbouring samples from which the pose at each value is predicted.

    If the neighbours differ, there is a limit between them: the motion was followed to the inner neighbour, which is
    nearer to the assembled pose, and the loops may close again at the outer one.
    """
    left_closed, right_closed = closes_before_limits(left.status), closes_before_limits(right.status)
    between = left_closed & (left.status == right.status)
    rising = values >= 0
    outer_closed = jnp.where(rising, right_closed, left_closed)
    near_inner = jnp.abs(values - jnp.where(rising, left.at, right.at)) <= NEAR_LIMIT
    belongs_to_inner = near_inner | ~outer_closed
    from_left = belongs_to_inner == rising
    nearest_closed = jnp.where(from_left, left_closed, right_closed)
    trusted = between | (near_inner | ~belongs_to_inner) & nearest_closed
    inner_closed = jnp.where(rising, left_closed, right_closed)
    beyond = ~outer_closed & ~(inner_closed & near_inner)
    return _TrustedSide(between, beyond, from_left, trusted)


def _wrapped(samples: BranchSamples, values: Float[Array, " poses"]) -> Float[Array, " poses"]:
    """Wrap each value by multiples of 2 pi into the interval traced without a limit; keep it if that is impossible.

    An interval of more than a full turn has other poses a turn farther, as where the input drives a screw: a value
    beyond its limit is not reached a turn before it.
    """
    followed = (samples.table[:, -1] == Status.CLOSED.value) & jnp.isfinite(samples.at)
    least = jnp.min(jnp.where(followed, samples.at, jnp.inf))
    most = jnp.max(jnp.where(followed, samples.at, -jnp.inf))
    one_turn = most - least <= TURN + 2 * NEAR_LIMIT
    # the end of the range is not a limit if it was reached
    least = jnp.where(least <= samples.at[samples.first], -jnp.inf, least - NEAR_LIMIT)
    most = jnp.where(most >= samples.at[samples.last], jnp.inf, most + NEAR_LIMIT)
    down = values - TURN * jnp.ceil(jnp.maximum(values - most, 0.0) / TURN)
    back = down + TURN * jnp.ceil(jnp.maximum(least - down, 0.0) / TURN)
    return jnp.where(one_turn & (back >= least) & (back <= most), back, values)


def _weighted(system: LoopSystem, left: Sample, right: Sample, values: Float[Array, " poses"]) -> State:
    """Interpolate linearly between two samples of least residual, whose slopes are not known."""
    _, t = _fraction(left, right, values)
    state = jax.tree.map(lambda a, b: a + t * (b - a), left.state, right.state)
    return retract(system, state, jnp.zeros_like(state.x))


def _third(samples: BranchSamples, left: Int[Array, " poses"], values: Float[Array, " poses"]) -> Int[Array, " poses"]:
    """Choose a sample next to two neighbours, of which the left one is in the row `left`: that on the side of the
    value, unless it is too near to the neighbours or missing."""
    rows = [jnp.clip(left + step, samples.first, samples.last) for step in (-1, 0, 1, 2)]
    before, begin, end, behind = (samples.at.at[row].get(mode="promise_in_bounds") for row in rows)
    least = APART * (end - begin)
    first = (begin - before > least) & ((values - begin < end - values) | (behind - end <= least))
    return jnp.where(first, rows[0], rows[-1])


def _fraction(
    left: Sample, right: Sample, values: Float[Array, " poses"]
) -> tuple[Float[Array, " poses"], Float[Array, " poses"]]:
    """Compute the distance between two samples, and the fraction of that at which each value is."""
    width = right.at - left.at
    width = jnp.where(width > 0, width, 1.0)
    return width, (values - left.at) / width


def _through_third(cubic: State, left: Sample, right: Sample, third: Sample, t: Float[Array, " poses"]) -> State:
    """Replace the cubic through two samples by the quintic through a third one, too, where the two are near each other.

    The quintic is at most `SMOOTH` times as far from the cubic as that from its chord, and the third sample is of the
    same status, and not nearer than `APART`.
    """
    chord = jax.tree.map(lambda a, b: a + t * (b - a), left.state, right.state)
    end = (third.at - left.at) / (right.at - left.at)
    usable = ((end < -APART) | (end > 1 + APART)) & (third.status == left.status)
    quintic = jax.tree.map(jnp.add, cubic, quintic_bend(left, right, third, jnp.where(usable, end, 2.0), t))
    near = difference(quintic, cubic) <= SMOOTH * difference(cubic, chord)
    return select_poses(usable & near, quintic, cubic)


def quintic_bend(
    left: Sample, right: Sample, third: Sample, end: Float[Array, " poses"], t: Float[Array, " poses"]
) -> State:
    """Compute what the quintic through three samples with their slopes adds to the cubic through two of them.

    `t` is the fraction of the distance between those two, and `end` that of the third one. What is added is a line
    times `t^2 (1 - t)^2`, by which the cubic gets value and slope of the third sample.
    """
    width, square = right.at - left.at, (end * (1 - end)) ** 2

    def bend(a: Array, slope_a: Array, b: Array, slope_b: Array, c: Array, slope_c: Array) -> Array:
        first, last, rise = width * slope_a, width * slope_b, b - a
        second, cubed = 3 * rise - 2 * first - last, first + last - 2 * rise
        value = (c - a - end * (first + end * (second + end * cubed))) / square
        slope = (width * slope_c - first - end * (2 * second + 3 * end * cubed)) / square
        relative = 2 / end - 2 / (1 - end)  # derivative of the square over the square
        return (t * (1 - t)) ** 2 * (value + (slope - relative * value) * (t - end))

    return jax.tree.map(bend, left.state, left.slope, right.state, right.slope, third.state, third.slope)
