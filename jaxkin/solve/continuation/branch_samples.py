"""Keep samples of the branch, poses with slopes, and predict any pose between them by cubic interpolation.

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
from jaxkin.solve.closure.spatial import Spatial
from jaxkin.solve.continuation.fronts import Fronts
from jaxkin.solve.continuation.predictor import hermite
from jaxkin.solve.continuation.step import NEAR_LIMIT
from jaxkin.solve.correctors.levenberg_marquardt import select_poses
from jaxkin.solve.status import Status, is_closed
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.scatter import scatter_rows
from jaxkin.solve.system.state import State, rate, retract, turning

EXTRAPOLATED = 1e-3
"""Distance beyond the first or last sample, radians or characteristic lengths, that predictions still cover. The end of
a range and the last sample may differ by rounding; a pose that is wrongly covered shows by its residual."""
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


class _Sample(NamedTuple):
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


def _sample(system: LoopSystem, samples: BranchSamples, number: Int[Array, " poses"]) -> _Sample:
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
    return _Sample(at[0], state, slope, column[-1].astype(jnp.int32))


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
    between, beyond, from_left, trusted = _trusted_side(left, right, values)
    nearest = select_poses(from_left, left.state, right.state)
    nearest = select_poses(beyond, _weighted(system, left, right, values), nearest)
    state = select_poses(between, _interpolated(system, left, right, values), nearest)
    status = jnp.where(trusted, jnp.where(from_left, left.status, right.status), Status.JUMPED.value)
    if system.periodic:
        state = State(state.x + turns * samples.winding[:, None], state.turns)
    least, most = (samples.at.at[end].get(mode="promise_in_bounds") for end in (samples.first, samples.last))
    return Prediction(state, status, (values >= least - EXTRAPOLATED) & (values <= most + EXTRAPOLATED))


def _trusted_side(
    left: _Sample, right: _Sample, values: Float[Array, " poses"]
) -> tuple[Bool[Array, " poses"], Bool[Array, " poses"], Bool[Array, " poses"], Bool[Array, " poses"]]:
    """Choose the neighbouring samples from which the pose at each value is predicted.

    Returns whether both neighbours are closed with one status, so that the pose is interpolated between them; whether
    the pose is beyond a limit, and the outer neighbour too, so that poses of least residual lie between them; whether
    the pose otherwise belongs to the left neighbour; and whether the pose gets the status of its neighbour (if not, it
    is JUMPED where it closes). If the neighbours differ, there is a limit between them: the motion was followed to the
    inner neighbour, which is nearer to the assembled pose, and the loops may close again at the outer one.
    """
    left_closed, right_closed = is_closed(left.status), is_closed(right.status)
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
    return between, beyond, from_left, trusted


def _wrapped(samples: BranchSamples, values: Float[Array, " poses"]) -> Float[Array, " poses"]:
    """Wrap each value by multiples of 2 pi into the interval traced without a limit; keep it if that is impossible."""
    followed = (samples.table[:, -1] == Status.CLOSED.value) & jnp.isfinite(samples.at)
    least = jnp.min(jnp.where(followed, samples.at, jnp.inf))
    most = jnp.max(jnp.where(followed, samples.at, -jnp.inf))
    # the end of the range is not a limit if it was reached
    least = jnp.where(least <= samples.at[samples.first], -jnp.inf, least - NEAR_LIMIT)
    most = jnp.where(most >= samples.at[samples.last], jnp.inf, most + NEAR_LIMIT)
    down = values - TURN * jnp.ceil(jnp.maximum(values - most, 0.0) / TURN)
    back = down + TURN * jnp.ceil(jnp.maximum(least - down, 0.0) / TURN)
    return jnp.where((back >= least) & (back <= most), back, values)


def _weighted(system: LoopSystem, left: _Sample, right: _Sample, values: Float[Array, " poses"]) -> State:
    """Interpolate linearly between two samples of least residual, whose slopes are not known."""
    width = right.at - left.at
    t = (values - left.at) / jnp.where(width > 0, width, 1.0)
    state = jax.tree.map(lambda a, b: a + t * (b - a), left.state, right.state)
    return retract(system, state, jnp.zeros_like(state.x))


def _interpolated(system: LoopSystem, left: _Sample, right: _Sample, values: Float[Array, " poses"]) -> State:
    """Interpolate between two samples by a cubic; the quaternions of balls are normalised."""
    width = right.at - left.at
    t = (values - left.at) / jnp.where(width > 0, width, 1.0)
    state = hermite(left.state, left.slope, right.state, right.slope, width, t)
    return retract(system, state, jnp.zeros_like(state.x))
