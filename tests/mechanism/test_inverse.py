"""The inverse problem against closed forms, against `sweep` where targets can be met, and against scipy elsewhere."""

import jax
import numpy as np
import pytest
from scipy.optimize import least_squares

import jaxkin as jk
from reference.catalogue import delta, fivebar

Z = (0.0, 0.0, 1.0)
TIP = (3.0, 0.0, 0.0)


def arm(joints=3, **limits):
    """Unit links along x, with hinges at the integers."""
    parts = ["base", *"abcdef"[:joints]]
    made = [
        jk.revolute(name, parts[k], parts[k + 1], point=(k, 0, 0), axis=Z, limits=limits.get(name))
        for k, name in enumerate("ABCDEF"[:joints])
    ]
    return jk.Mechanism.build(fixed=["base"], joints=made)


def angles(found, names="ABC"):
    return np.stack([np.asarray(found.motion.coordinates[name])[:, 0] for name in names], axis=1)


def tips(q):
    """The end of an arm of unit links whose hinges turn by q (poses, hinges), and derivatives (poses, 2, hinges)."""
    total = np.cumsum(q, axis=-1)
    steps = np.stack([np.cos(total), np.sin(total)], axis=-2)
    across = np.stack([-np.sin(total), np.cos(total)], axis=-2)
    return steps.sum(axis=-1), np.cumsum(across[..., ::-1], axis=-1)[..., ::-1]


def flat(points):
    return np.pad(np.asarray(points, float), ((0, 0), (0, 1)))


@pytest.mark.long
def test_with_fewer_targets_the_inputs_move_as_little_as_they_can():
    """At the least movement it is a combination of the rates of the targets: the gradient of Lagrange vanishes."""
    goals = np.array([[1.5, 1.5], [2.9, 0.3], [-0.5, 1.2], [1.0, -2.0]])
    found = jk.inverse(arm(), {jk.point("c", TIP): flat(goals)})
    assert found.reached.all()
    q = angles(found)
    there, slopes = tips(q)
    np.testing.assert_allclose(there, goals, atol=1e-12)
    for move, slope in zip(q, slopes, strict=True):
        left = move - slope.T @ np.linalg.lstsq(slope.T, move, rcond=None)[0]
        np.testing.assert_allclose(left, 0, atol=1e-12)  # the last step, 1e-13, becomes small linearly


@pytest.mark.long
def test_rest_is_where_movement_counts_from():
    start = np.array([0.5, 0.9, -0.7])
    goal = tips(start[None])[0]
    found = jk.inverse(arm(), {jk.point("c", TIP): flat(goal)}, rest=dict(zip("ABC", start, strict=True)))
    np.testing.assert_allclose(angles(found)[0], start, atol=1e-9)  # it needs no movement at all


@pytest.mark.long
def test_out_of_reach_the_arm_points_at_the_target():
    goals = np.array([[4.0, 1.0], [0.0, 5.0]])
    found = jk.inverse(arm(), {jk.point("c", TIP): flat(goals)})
    away = np.linalg.norm(goals, axis=1)
    assert not found.reached.any()
    assert np.asarray(found.motion.closed).all()
    np.testing.assert_allclose(found.errors, (away - 3) / found.size, atol=1e-12)
    # the error is flat there: it says the direction to the root of what it says itself
    np.testing.assert_allclose(found.motion.points("c", TIP)[:, :2], 3 * goals / away[:, None], atol=1e-6)


@pytest.mark.long
def test_with_more_targets_than_freedoms_weighted_errors_are_least():
    """As scipy finds them from the closed form."""
    goals, turns = np.array([[1.2, 0.9], [0.8, 1.1]]), np.array([0.4, 1.0])
    rotations = np.zeros((2, 3, 3))
    rotations[:, 0, 0] = rotations[:, 1, 1] = np.cos(turns)
    rotations[:, 1, 0] = np.sin(turns)
    rotations[:, 0, 1] = -np.sin(turns)
    rotations[:, 2, 2] = 1
    place, turn = jk.point("b", (2.0, 0.0, 0.0)), jk.orientation("b")
    found = jk.inverse(arm(2), {place: flat(goals), turn: rotations}, weights={turn: 0.3, place: 2.0})

    for pose, q in enumerate(angles(found, "AB")):

        def errors(q, pose=pose):
            there = tips(q[None])[0][0]
            return [*2.0 * (goals[pose] - there) / found.size, 0.3 * (turns[pose] - q.sum())]

        best = least_squares(errors, q + 0.05, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        np.testing.assert_allclose(found.errors[pose], np.linalg.norm(best.fun), rtol=1e-9)
        np.testing.assert_allclose(q, best.x, atol=1e-6)  # scipy takes differences


@pytest.mark.long
def test_limits_stop_joints_and_are_told():
    goals = np.array([[1.5, 1.5], [2.9, 0.3], [0.2, 2.2]])
    limited = arm(B=(-0.5, 0.5), C=(-0.2, 2.0))
    found = jk.inverse(limited, {jk.point("c", TIP): flat(goals)})
    free = jk.inverse(limited, {jk.point("c", TIP): flat(goals)}, limits=False)
    q = angles(found)
    assert np.all(np.abs(q[:, 1]) <= 0.5 + 1e-12) and np.all(q[:, 2] >= -0.2 - 1e-12)
    assert found.at_limits["B.phi"].any() and not free.at_limits
    np.testing.assert_array_equal(found.reached[:2], True)  # another hinge makes up for it
    low, high = [-np.inf, -0.5, -0.2], [np.inf, 0.5, 2.0]
    for goal, error in zip(goals, found.errors, strict=True):
        best = least_squares(lambda q, goal=goal: (goal - tips(q[None])[0][0]) / 2, [0.1, 0.1, 0.1], bounds=(low, high))
        assert error <= np.linalg.norm(best.fun) + 1e-7  # scipy stops a little short of limits


@pytest.mark.long
def test_where_targets_can_be_met_it_is_the_sweep():
    pen, turn = jk.point("b", (1.5, 2, 0)), np.linspace(0, 2 * np.pi, 9)
    path = np.stack([1.5 + 0.4 * np.sin(turn), 2.3 - 0.3 * np.cos(turn), 0 * turn], axis=1)
    swept, found = fivebar().sweep({pen: path}, throw=True), jk.inverse(fivebar(), {pen: path})
    assert found.reached.all()
    for name in "ABCDE":
        np.testing.assert_allclose(found.motion.coordinates[name], swept.coordinates[name], atol=1e-9)
    back = fivebar().sweep({name: found.motion.coordinates[name][:, 0] for name in "AE"}, throw=True)
    np.testing.assert_allclose(back.points("b", pen.at), path, atol=1e-9)


@pytest.mark.long
def test_all_working_modes_from_many_starts():
    """Each of the two arms has two sides for its elbow."""
    pen = jk.point("b", (1.5, 2, 0))
    found = jk.inverse(fivebar(), {pen: np.array([[1.6, 2.1, 0.0]])}, starts=40)
    (solutions,) = found.solutions
    assert len(solutions) == 4
    elbows = set()
    for row in solutions:
        at = dict(zip(found.columns, row, strict=True))
        pose = fivebar().closure({name.removesuffix(".phi"): value for name, value in at.items()})
        np.testing.assert_allclose(pose.residual, 0, atol=1e-11)
        elbows.add((round(np.sin(at["A.phi"]), 6), round(np.sin(at["E.phi"]), 6)))
    assert len(elbows) == 4
    assert "up to 4 solutions" in str(found)


@pytest.mark.long
@pytest.mark.study
def test_a_delta_with_a_path_that_leaves_its_reach():
    start = np.array([20.0, -30.0, -420.0])
    target = jk.point("platform", start)
    down = start + np.outer(np.linspace(0, 600, 7), [0, 0, -1.0])
    found = jk.inverse(delta(tuple(start)), {target: down})
    swept = delta(tuple(start)).sweep({target: down})
    closed = np.asarray(swept.closed)
    np.testing.assert_array_equal(found.reached, closed)
    for k in range(3):
        np.testing.assert_allclose(
            found.motion.coordinates[f"motor {k}"][closed], swept.coordinates[f"motor {k}"][closed], atol=1e-9
        )
    assert np.asarray(found.motion.closed).all()  # stretched, and closed
    assert np.all(np.diff(found.errors[~closed]) > 0)


@pytest.mark.long
def test_couplings_hold():
    geared = arm().with_couplings([jk.gear("B", "C", -0.5)])
    found = jk.inverse(geared, {jk.point("c", TIP): flat([[1.5, 1.5], [2.0, -1.0]])})
    q = angles(found)
    assert found.reached.all()
    np.testing.assert_allclose(q[:, 2], -0.5 * q[:, 1], atol=1e-12)
    np.testing.assert_allclose(tips(q)[0], [[1.5, 1.5], [2.0, -1.0]], atol=1e-9)


def test_joints_and_targets_together():
    found = jk.inverse(arm(), {jk.point("c", TIP): flat([[1.5, 1.5]]), "C": [0.3]})
    q = angles(found)
    assert found.reached.all()
    np.testing.assert_allclose(q[0, 2], 0.3, atol=1e-12)


@pytest.mark.parametrize(
    ("targets", "options", "message"),
    [
        ({}, {}, "got {}"),
        ({jk.point("d", TIP): np.zeros((2, 3))}, {}, "no part 'd' that moves"),
        ({jk.point("base", TIP): np.zeros((2, 3))}, {}, "no part 'base' that moves"),
        ({jk.pose("c"): np.zeros((2, 3))}, {}, r"shape \(poses, 4, 4\)"),
        ({jk.point("c", TIP): np.full((2, 3), np.nan)}, {}, r"the target c \(.*\) has NaN"),
        ({jk.point("c", TIP): np.zeros((2, 3)), "A": [0.0]}, {}, "same number of poses"),
        ({"A": [0.0]}, {"weights": {"B": 1.0}}, "'B' is no target"),
        ({"A": [0.0]}, {"weights": {"A": -1.0}}, "zero or more"),
        ({"A": [0.0]}, {"weights": {"A": (1.0, 2.0)}}, "one number, zero or more"),
        ({jk.point("c", TIP): np.zeros((1, 3))}, {"weights": {jk.point("c", TIP): (1.0, 2.0)}}, "one number"),
        ({jk.pose("c"): np.eye(4)[None]}, {"weights": {jk.pose("c"): (1.0, -2.0)}}, r"\(place, orientation\)"),
        ({"A": [0.0]}, {"rest": {"K": 0.0}}, "K"),
        ({"A": [0.0]}, {"rest": {"A": 0.0}, "inputs": ["B"]}, r"'A', which is no input; the inputs are B\.phi"),
        ({"A": [0.0]}, {"inputs": ["K"]}, "K"),
        ({"A": [0.0]}, {"starts": 0}, "1 or more"),
    ],
)
def test_what_makes_no_problem_is_refused(targets, options, message):
    with pytest.raises(ValueError, match=message):
        jk.inverse(arm(), targets, **options)


@pytest.mark.long
def test_joints_that_disagree_have_poses_that_misfit_as_in_a_sweep():
    """A hinge is tilted by more than rounding: the loops that close are those of others, nearly as they were given."""
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "crank", "rod", point=(1, 0, 0), axis=(0, 2e-4, 1)),
            jk.revolute("C", "rod", "rocker", point=(3.2, 2.9, 0), axis=Z),
            jk.revolute("D", "ground", "rocker", point=(4, 0, 0), axis=Z),
        ],
    )
    angles = np.array([0.3, 0.6])
    found = jk.inverse(mechanism, {"A": angles})
    swept, projected = mechanism.sweep({"A": angles}), jk.project(mechanism, {"A": angles}, hold=["A"]).motion
    for motion in (found.motion, swept, projected):
        assert set(np.asarray(motion.status)) == {jk.Status.MISFIT}
    np.testing.assert_allclose(found.motion.coordinates["D"], projected.coordinates["D"], atol=1e-9)
    assert found.reached.all() and "do not close" not in str(found)


def test_a_frame_without_freedoms_has_no_inverse():
    corners = {"A": ("ground", "left"), "B": ("left", "right"), "C": ("ground", "right")}
    joints = [
        jk.revolute(name, *parts, point=point, axis=(0, 0, 1))
        for (name, parts), point in zip(corners.items(), [(0, 0, 0), (1, 1, 0), (2, 0, 0)], strict=True)
    ]
    frame = jk.Mechanism.build(fixed=["ground"], joints=joints)
    with pytest.raises(ValueError, match="the mechanism has no freedom, so no target can move it"):
        jk.inverse(frame, {jk.point("left", (1, 1, 0)): [[1.0, 1.1, 0.0]]})


def test_targets_are_reached_where_jax_computes_in_float32():
    goal = tips(np.array([[0.5, 0.9, -0.7]]))[0]
    with jax.enable_x64(False):
        found = jk.inverse(arm(), {jk.point("c", TIP): flat(goal)})
    assert found.reached.all() and str(found) == "1 of 1 poses reach their targets"
    np.testing.assert_allclose(tips(angles(found))[0], goal, atol=1e-6)  # the joints are told in float32


@pytest.mark.long
def test_starts_turn_screws_as_far_as_slides_slide():
    """A toggle press on a screw: its ram is as high with the car on either side, 15 turns of the screw apart."""
    across, up, about, home = (1, 0, 0), (0, 1, 0), (0, 0, 1), (3, 0, 0)
    press = jk.Mechanism.build(
        fixed=["frame"],
        joints=[
            jk.screw("screw", "frame", "nut", point=(0, 0, 0), axis=across, pitch=0.5),
            jk.prismatic("way", "frame", "car", axis=across),
            jk.revolute("thrust", "nut", "car", point=home, axis=across),
            jk.revolute("foot", "car", "rod", point=home, axis=about),
            jk.revolute("top", "rod", "ram", point=(0, 4, 0), axis=about),
            jk.prismatic("ram", "frame", "ram", axis=up, point=(0, 4, 0)),
        ],
    )
    found = jk.inverse(press, {jk.point("ram", (0, 4, 0)): [[0, 4.5, 0]]}, starts=40)
    half = np.sqrt(5**2 - 4.5**2)  # of the rod, which is 5 long
    (solutions,) = found.solutions
    np.testing.assert_allclose(np.sort(solutions[:, 1]) + 3, [-half, half], atol=1e-8)  # of the way
