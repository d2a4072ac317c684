"""Least errors within limits, against scipy and closed forms; and errors that are stationary and not least."""

import numpy as np
import pytest
from scipy.optimize import least_squares, lsq_linear

import jaxkin as jk
from jaxkin.mechanism.inverse.bounded import Bounds, fit

Z = (0.0, 0.0, 1.0)
Y = (0.0, 1.0, 0.0)


def chain(joints, **options):
    return jk.Mechanism.build(fixed=["0"], joints=joints, **options)


def arm(count, limits=None, **options):
    """Unit links along x, with hinges named A, B, ... at the integers."""
    made = [
        jk.revolute(name, str(k), str(k + 1), point=(k, 0, 0), axis=Z, limits=(limits or {}).get(name))
        for k, name in enumerate("ABC"[:count])
    ]
    return chain(made, **options), jk.point(str(count), (count, 0, 0))


def turns(found, names):
    return np.stack([np.asarray(found.motion.coordinates[name])[:, 0] for name in names], axis=1)


def tips(q):
    total = np.cumsum(q, axis=-1)
    return np.stack([np.cos(total).sum(axis=-1), np.sin(total).sum(axis=-1)], axis=-1)


@pytest.mark.parametrize("rank", [2, 5])
def test_least_squares_within_bounds_are_those_of_scipy(rank):
    rng = np.random.default_rng(rank)
    matrix, values = rng.normal(size=(200, 5, rank)) @ rng.normal(size=(200, rank, 6)), 4 * rng.normal(size=(200, 5))
    bounds = Bounds(-rng.uniform(0, 1, (200, 6)), rng.uniform(0, 1, (200, 6)))
    free, begun = np.broadcast_to(np.eye(6), (200, 6, 6)), np.zeros((200, 6))
    found, _ = fit(matrix, values, np.zeros(200), free, begun, bounds)
    assert np.all((found >= bounds.low) & (found <= bounds.high))
    for k in range(200):
        best = lsq_linear(matrix[k], values[k], (bounds.low[k], bounds.high[k]), method="bvls", max_iter=1000)
        error = np.linalg.norm(matrix[k] @ found[k] - values[k])
        assert error <= np.sqrt(2 * best.cost) + 1e-9  # where scipy stops


def test_equations_that_say_the_same_as_limits_do_not_hold_coordinates():
    """Two coordinates with an equal sum are at their limits together, and neither can leave them alone."""
    free = np.eye(3) - np.outer([1, 1, 0], [1, 1, 0]) / 2
    bounds = Bounds(np.array([[0.0, -1.0, 0.0]]), np.array([[1.0, 0.0, 1.0]]))
    found, _ = fit(np.array([[[1.0, 0.0, 2.0]]]), np.array([[2.5]]), np.zeros(1), free[None], np.zeros((1, 3)), bounds)
    np.testing.assert_allclose(found @ [1.0, 0.0, 2.0], 2.5, atol=1e-12)
    np.testing.assert_allclose(found[0, 0] + found[0, 1], 0, atol=1e-12)


@pytest.mark.long
def test_sliders_are_box_bounded_least_squares():
    rng = np.random.default_rng(0)
    axes = rng.normal(size=(3, 4))
    axes /= np.linalg.norm(axes, axis=0)
    names = "abcd"
    sliders = chain(
        [jk.prismatic(n, str(k), str(k + 1), axis=tuple(axes[:, k]), limits=(-1, 1)) for k, n in enumerate(names)]
    )
    goals = 2 * rng.normal(size=(60, 3))
    found = jk.inverse(sliders, {jk.point("4", (0, 0, 0)): goals})
    x = turns(found, names)
    assert np.abs(x).max() <= 1 and found.stationary.all()
    for goal, own in zip(goals, x, strict=True):
        best = lsq_linear(axes, goal, (-1, 1), method="bvls", tol=1e-14)
        np.testing.assert_allclose(np.linalg.norm(axes @ own - goal), np.sqrt(2 * best.cost), atol=1e-9)


@pytest.mark.long
def test_no_release_of_a_limit_lessens_the_error():
    """The gradient of the closed form is zero for what is free, and points out of the limits that are met."""
    limits = {"B": (0.0, 2.5), "C": (-1.0, 1.0)}
    mechanism, tip = arm(3, limits)
    goals = np.random.default_rng(1).normal(size=(60, 2)) * 2.5
    found = jk.inverse(mechanism, {tip: np.pad(goals, ((0, 0), (0, 1)))})
    q, step = turns(found, "ABC"), 1e-6
    assert found.stationary.all() and (~found.reached).sum() > 20
    for own, goal in zip(q[~found.reached], goals[~found.reached], strict=True):
        moves = step * np.eye(3)
        falls = [np.sum((tips(own - each) - goal) ** 2) - np.sum((tips(own + each) - goal) ** 2) for each in moves]
        falls = np.array(falls) / (2 * step) / np.linalg.norm(tips(own) - goal)
        for k, name in enumerate("ABC"):
            low, high = limits.get(name, (-np.inf, np.inf))
            # 1e-3: ten times the cosine up to which a pose counts as stationary, for derivatives of order three
            assert falls[k] <= 1e-3 or own[k] >= high - 1e-9
            assert falls[k] >= -1e-3 or own[k] <= low + 1e-9


@pytest.mark.long
def test_a_gear_and_limits_that_are_met_together():
    """A hinge and the one that a gear turns with it are at their limits at the same time, and leave them together."""
    mechanism, tip = arm(3, {"B": (-0.5, 0.5), "C": (-0.25, 0.25)}, couplings=[jk.gear("B", "C", -0.5)])
    goals = np.random.default_rng(2).normal(size=(12, 2)) * 2
    found = jk.inverse(mechanism, {tip: np.pad(goals, ((0, 0), (0, 1)))}, starts=4)

    for goal, error in zip(goals, found.errors, strict=True):

        def off(q, goal=goal):
            return (tips(np.array([q[0], q[1], -0.5 * q[1]])) - goal) / 2

        begun = [[a, b] for a in (-2.0, 0.0, 2.0) for b in (-0.3, 0.3)]
        best = min(
            least_squares(off, each, bounds=([-np.inf, -0.5], [np.inf, 0.5]), xtol=1e-15, gtol=1e-15).cost
            for each in begun
        )
        assert error <= np.sqrt(2 * best) + 1e-7  # scipy stops a little short of limits


@pytest.mark.long
@pytest.mark.parametrize("count", [2, 3])
def test_a_straight_arm_shortens(count):
    """The error is stationary where it points at the target, or away from it."""
    mechanism, tip = arm(count)
    far = np.array([count - 0.5, count + 1.0, 1 - count, -count - 1.0])
    found = jk.inverse(mechanism, {tip: far[:, None] * [1.0, 0.0, 0.0]})
    np.testing.assert_allclose(found.errors * found.size, np.maximum(np.abs(far) - count, 0), atol=1e-9)
    again = jk.inverse(mechanism, {tip: far[:, None] * [1.0, 0.0, 0.0]})
    np.testing.assert_array_equal(turns(found, "ABC"[:count]), turns(again, "ABC"[:count]))


@pytest.mark.long
def test_a_straight_arm_shortens_within_limits():
    """The nearest to its shoulder that the hand gets is where elbow and wrist are at their limits."""
    mechanism, tip = arm(3, {"B": (0, 2.5), "C": (-1, 1)})
    found = jk.inverse(mechanism, {tip: [[2.0, 0, 0], [0.0, 0, 0], [-2.0, 0, 0]]})
    np.testing.assert_array_equal(found.reached, [True, False, True])
    np.testing.assert_allclose(found.errors[1] * found.size, np.hypot(*tips(np.array([0, 2.5, 1]))), atol=1e-9)


@pytest.mark.long
def test_a_robot_that_stands_upright_lowers_its_hand():
    heights, axes = [0, 0.3, 0.8, 1.1, 1.3, 1.4], [Z, Y, Y, Z, Y, Z]
    robot = chain([jk.revolute(f"j{k}", str(k), str(k + 1), point=(0, 0, heights[k]), axis=axes[k]) for k in range(6)])
    hand = jk.point("6", (0, 0, 1.5))
    found = jk.inverse(robot, {hand: [[0, 0, 1.2], [0, 0, 0.8], [0, 0, 2.0]]})
    np.testing.assert_allclose(found.errors * found.size, [0, 0, 0.5], atol=1e-9)
    np.testing.assert_array_equal(found.reached, [True, True, False])


@pytest.mark.long
def test_solutions_are_within_limits():
    """Of two ways to bend an elbow one needs the shoulder at 4.38, and not a turn less."""
    made = [
        jk.revolute("A", "0", "1", point=(0, 0, 0), axis=Z, limits=(-0.1, 6)),
        jk.revolute("B", "1", "2", point=(1, 0.3, 0), axis=Z, limits=(-3, 3)),
    ]
    found = jk.inverse(chain(made), {jk.point("2", (1.5, 1, 0)): [[-0.9, -1.0, 0]]}, starts=12)
    (solutions,) = found.solutions
    assert len(solutions) == 2
    assert np.all((solutions >= [-0.1, -3]) & (solutions <= [6, 3]))


def test_a_hinge_that_stops_gets_there_the_other_way_round():
    hinge = chain([jk.revolute("A", "0", "1", point=(0, 0, 0), axis=Z, limits=(-0.5, 5))])
    turn = np.array([[np.cos(4.5), -np.sin(4.5), 0], [np.sin(4.5), np.cos(4.5), 0], [0, 0, 1]])
    found = jk.inverse(hinge, {jk.orientation("1"): turn[None]})
    assert found.reached.all() and not found.at_limits
    np.testing.assert_allclose(found.motion.coordinates["A"], 4.5, atol=1e-9)


@pytest.mark.long
def test_an_arm_near_the_end_of_its_reach_keeps_the_target_that_it_met():
    """Where the inputs rest is far from there, and the way to it leads out of the target."""
    mechanism, tip = arm(3)
    goals = np.array([[1.37101363, -2.66281182, 0], [-2.93883976, 0.40018973, 0]])
    assert jk.inverse(mechanism, {tip: goals}).reached.all()


def test_a_sweep_of_a_straight_arm_names_the_target_and_not_a_coordinate_behind_it():
    mechanism, tip = arm(2)
    with pytest.raises(ValueError, match=r"^a direction of 2 \(2, 0, 0\) has no freedom left to it by the loops"):
        mechanism.sweep({tip: [[1.5, 0.0, 0.0]]})
