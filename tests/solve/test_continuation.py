"""Parts of the continuation, one by one: the order of its predictor, and the limits of a branch."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.continuation.branch import trace_branch
from jaxkin.solve.continuation.branch_samples import Sample, quintic_bend
from jaxkin.solve.continuation.fronts import ContinuationProblem
from jaxkin.solve.continuation.predictor import History, hermite, predict_state
from jaxkin.solve.continuation.step import NEAR_LIMIT
from jaxkin.solve.execution.compiler import jit_options
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import Status
from jaxkin.solve.system.state import State
from reference.mechanisms import planar_fourbar

STEPS = np.array([0.1, 0.05, 0.025])
NEVER = np.zeros(len(STEPS), bool)
PREDICT = jax.jit(predict_state)


def rocker(theta):
    """Angle of the rocker of the four-bar 100, 40, 120, 80 by the law of cosines."""
    x, y = 100 - 40 * jnp.cos(theta), -40 * jnp.sin(theta)
    square = x * x + y * y
    return jnp.arctan2(-y, -x) - jnp.arccos((80**2 + square - 120**2) / (160 * jnp.sqrt(square)))


@jax.jit
def pose(theta):
    """States of input and rocker, and their derivatives with respect to the input."""
    x = jnp.stack([theta, rocker(theta)])
    slope = jnp.stack([jnp.ones_like(theta), jax.vmap(jax.grad(rocker))(theta)])
    no_balls = jnp.zeros((0, 4, len(theta)))
    return State(x, no_balls), State(slope, no_balls)


def history(before, before_tangent, width, earlier=None):
    """The poses before the last; `earlier` is the slope of a third one and its distance from the second."""
    tangent, distance = earlier or (before_tangent, jnp.full_like(width, jnp.inf))
    return History(before, before_tangent, width, tangent, distance)


def assert_order(errors, order):
    """Halved steps divide the error by two to the order; the next order adds a few per cent at these steps."""
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), order, atol=0.15)


@pytest.mark.long
@pytest.mark.parametrize("slopes, order", [(2, 3), (3, 4)])
def test_the_error_of_a_prediction_falls_with_the_power_of_the_step_that_follows_its_slopes(slopes, order):
    """A polynomial through k slopes errs by the k-th power of the step, and its integral by one power more."""
    here, width = jnp.full(len(STEPS), 1.3), jnp.asarray(STEPS)
    _, earlier_tangent = pose(here - 2.5 * width)
    (state, tangent), (before, before_tangent) = pose(here), pose(here - width)
    passed = history(before, before_tangent, width, (earlier_tangent, 1.5 * width) if slopes == 3 else None)
    predicted, _ = PREDICT(state, tangent, passed, width, NEVER, NEVER)
    assert_order(np.abs(predicted.x[1] - rocker(here + width)), order)


def test_the_tangent_is_of_second_order_and_needs_no_pose_before():
    here = jnp.full(len(STEPS), 1.3)
    state, tangent = pose(here)
    nothing = jax.tree.map(jnp.zeros_like, state)
    passed = history(nothing, nothing, jnp.ones(len(STEPS)))
    predicted, _ = PREDICT(state, tangent, passed, jnp.asarray(STEPS), ~NEVER, NEVER)
    assert_order(np.abs(predicted.x[1] - rocker(here + STEPS)), 2)


def test_interpolation_between_samples_is_of_fourth_order():
    here, width = jnp.full(len(STEPS), 1.3), jnp.asarray(STEPS)
    (left, left_slope), (right, right_slope) = pose(here), pose(here + STEPS)
    middle = jax.jit(hermite)(left, left_slope, right, right_slope, width, jnp.full(len(STEPS), 0.5))
    assert_order(np.abs(middle.x[1] - rocker(here + 0.5 * STEPS)), 4)


@pytest.mark.parametrize("end", [-0.7, 2.5])
def test_a_quintic_is_interpolated_exactly_through_a_third_sample(end):
    """The third sample lies before the first one, or behind the second one; a cubic misses the quintic."""
    quintic, t = np.polynomial.Polynomial([0.3, 3.0, 0.5, 0.7, -1.1, 0.4]), jnp.linspace(0.0, 1.0, 5)
    begin, width, none = jnp.full(5, 0.2), jnp.full(5, 0.8), jnp.zeros((0, 4, 5))

    def sample(at):
        state, slope = (State(jnp.asarray(p(at))[None], none) for p in (quintic, quintic.deriv()))
        return Sample(at, state, slope, jnp.zeros(5, jnp.int32))

    left, right, third = sample(begin), sample(begin + width), sample(begin + end * width)
    cubic = hermite(left.state, left.slope, right.state, right.slope, width, t)
    bend = quintic_bend(left, right, third, jnp.full(5, end), t)
    expected = quintic(begin + t * width)
    np.testing.assert_allclose(cubic.x[0] + bend.x[0], expected, atol=1e-14)
    assert np.abs(cubic.x[0] - expected)[1:-1].min() > 1e-4


def test_where_a_slope_says_nothing_the_secant_is_taken():
    """At a change point the slope may be that of the other branch: here of the wrong sign."""
    state, before = (State(jnp.array([[x]]), jnp.zeros((0, 4, 1))) for x in (0.0, -0.1))
    wrong = State(jnp.array([[-1.0]]), jnp.zeros((0, 4, 1)))
    step = jnp.array([0.1])
    predicted, bent = PREDICT(state, wrong, history(before, wrong, step), step, NEVER[:1], ~NEVER[:1])
    np.testing.assert_allclose(predicted.x, 0.1, rtol=1e-15)
    assert not bent.any()


def test_where_the_slopes_agree_a_bend_is_followed_until_refused():
    """A coordinate about to turn back: the chord leads 0.25 too far, and the curve is right to the fourth power."""
    here, width = jnp.array([-0.1]), jnp.array([0.5])

    def place(at):
        return State(jnp.cos(at)[None], jnp.zeros((0, 4, 1))), State(-jnp.sin(at)[None], jnp.zeros((0, 4, 1)))

    (state, tangent), (before, before_tangent) = place(here), place(here - width)
    passed = history(before, before_tangent, width)
    predicted, bent = PREDICT(state, tangent, passed, width, NEVER[:1], ~NEVER[:1])
    np.testing.assert_allclose(predicted.x, jnp.cos(here + width)[None], atol=0.5**4 / 6)
    assert bent.all()
    chord, bent = PREDICT(state, tangent, passed, width, NEVER[:1], NEVER[:1])
    np.testing.assert_allclose(chord.x, 2 * state.x - before.x, rtol=1e-15)
    assert not bent.any()


def spun(angle, poses):
    """Quaternions of one ball that is turned about z, and their derivatives by the angle."""
    turn = [jnp.cos(angle / 2), jnp.zeros(poses), jnp.zeros(poses), jnp.sin(angle / 2)]
    rate = [-jnp.sin(angle / 2) / 2, jnp.zeros(poses), jnp.zeros(poses), jnp.cos(angle / 2) / 2]
    none = jnp.zeros((1, poses))
    return State(none, jnp.stack(turn)[None]), State(none, jnp.stack(rate)[None])


def test_balls_are_predicted_by_slopes_alone_to_the_fourth_order():
    """What an idle spin was before must not be extrapolated: no correction would bring it back."""
    here, width = jnp.full(len(STEPS), 1.3), jnp.asarray(STEPS)
    state, tangent = spun(here, len(STEPS))
    before, before_tangent = spun(here - width, len(STEPS))
    _, earlier_tangent = spun(here - 2.5 * width, len(STEPS))
    other_spin, _ = spun(here - width + 1e-3, len(STEPS))

    def predict(before):
        passed = history(before, before_tangent, width, (earlier_tangent, 1.5 * width))
        return PREDICT(state, tangent, passed, width, NEVER, NEVER)[0].turns

    expected, _ = spun(here + width, len(STEPS))
    errors = np.max(np.abs(predict(before) - expected.turns), axis=(0, 1))
    assert_order(errors, 4)
    np.testing.assert_array_equal(predict(before), predict(other_spin))


@pytest.fixture(scope="module")
def traced_rocker():
    """Samples of a double rocker 100, 95, 60, 80 that is assembled at 1 rad, over a full turn."""
    (element,) = plan_drive(planar_fourbar(1.0, crank=95.0, coupler=60.0).linkage, ("A",)).loop_groups
    geometry, _ = scaled_geometry(element.system, element.joints)

    @partial(jax.jit, **jit_options())
    def trace(geometry, values):
        path = lambda at: (at[None], jnp.ones_like(at)[None])  # noqa: E731
        return trace_branch(ContinuationProblem(element.system, geometry, SolverOptions(max_steps=200), path), values)

    return trace(geometry, jnp.linspace(0.0, 2 * np.pi, 9))


@pytest.mark.long
def test_a_branch_is_followed_to_its_limits(traced_rocker):
    """Coupler and rocker in line, stretched or folded, by the law of cosines; as near as is documented.

    A pose may close beyond the limit by its residual, at most 1e-12 of the size.
    """
    at, status = np.asarray(traced_rocker.at), np.asarray(traced_rocker.table[:, -1])
    at = at[np.isfinite(at) & (status == Status.CLOSED)]
    for reach, limit in ((60.0 + 80.0, at.max()), (80.0 - 60.0, at.min())):
        expected = np.arccos((95.0**2 + 100.0**2 - reach**2) / (2 * 95.0 * 100.0)) - 1.0
        assert -1e-11 <= abs(expected) - abs(limit) <= NEAR_LIMIT
    assert not traced_rocker.complete and not traced_rocker.repeats


@pytest.mark.long
def test_samples_are_in_order_and_begin_at_the_assembled_pose(traced_rocker):
    first, last = int(traced_rocker.first), int(traced_rocker.last)
    at = np.asarray(traced_rocker.at)
    assert np.all(np.diff(at[first : last + 1]) >= 0) and 0.0 in at[first : last + 1]
    assert np.all(np.isinf(at[:first])) and np.all(np.isinf(at[last + 1 :]))
