"""What a sweep promises beside the right numbers: statuses, branches, units, order, only what is driven."""

from dataclasses import replace

import jax
import numpy as np
import pytest

from jaxkin.joints.pairs import prismatic, revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.status import Status
from reference import planar
from reference.mechanisms import planar_fourbar, rssr_linkage, slider_crank

NON_GRASHOF = {"ground": 40.0, "crank": 20.0, "coupler": 25.0, "rocker": 30.0}
LIMIT = np.arccos((40.0**2 + 20.0**2 - 55.0**2) / (2 * 40.0 * 20.0))
"""The crank of that four-bar reaches this angle, coupler and rocker in line, to either side."""


@pytest.mark.parametrize("poses", [200, pytest.param(3000, marks=pytest.mark.long)])
@pytest.mark.parametrize("direction", [1, -1])
def test_a_range_beyond_the_limits_is_unreachable_there_and_right_elsewhere(poses, direction):
    start = 1.0
    inputs = direction * np.linspace(0.0, 2 * np.pi, poses)
    motion = planar_fourbar(start, **NON_GRASHOF).sweep({"A": inputs})
    crank = (start + inputs + np.pi) % (2 * np.pi) - np.pi
    reachable = np.abs(crank) <= LIMIT
    expected = np.where(reachable, Status.CLOSED, Status.UNREACHABLE)
    np.testing.assert_array_equal(motion.status, expected)
    rocker = planar.fourbar(crank, **NON_GRASHOF).rocker - planar.fourbar(np.array([start]), **NON_GRASHOF).rocker
    error = (np.asarray(motion.coordinates["D"][:, 0]) - rocker + np.pi) % (2 * np.pi) - np.pi
    # the nearest pose is 1e-3 from the limit, where rounding grows by the inverse square root of that
    np.testing.assert_allclose(error[reachable], 0.0, atol=1e-12)
    assert f"{np.sum(~reachable)}  UNREACHABLE" in str(motion)


@pytest.mark.long
def test_where_not_all_poses_are_closed_the_text_says_between_which_values_of_the_drive_they_are():
    mechanism = planar_fourbar(1.0, **NON_GRASHOF)
    assert "closed from" not in str(mechanism.sweep({"A": np.linspace(-0.1, 0.1, 3)}))
    inputs = np.radians(np.arange(-150.0, 121.0, 5.0))
    told = str(mechanism.sweep({"A": inputs}))
    inside = np.degrees(inputs[np.abs(1.0 + inputs) <= LIMIT])
    assert f"  closed from {inside.min():.4g} to {inside.max():.4g} deg of A.phi\n" in told
    for mixed in (inputs[::-1], np.random.default_rng(0).permutation(inputs)):
        assert f"  closed from {inside.min():.4g} to {inside.max():.4g} deg" in str(mechanism.sweep({"A": mixed}))
    motion = mechanism.sweep({"A": np.array([0.0, 2.5, 0.1])})
    assert "  closed from 0 to 5.73 deg of A.phi\n" in str(motion)
    several = replace(motion, inputs=motion.inputs | {"D.phi": motion.inputs["A.phi"]})
    assert "  closed at pose 0 and at pose 2\n" in str(several)


@pytest.mark.parametrize("margin", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10])
def test_statuses_next_to_the_limit(margin):
    mechanism = planar_fourbar(1.0, **NON_GRASHOF)
    motion = mechanism.sweep({"A": np.array([LIMIT - 1.0 - margin, LIMIT - 1.0 + max(margin, 1e-8)])})
    assert list(motion.status) == [Status.CLOSED, Status.UNREACHABLE]


@pytest.mark.long
@pytest.mark.parametrize("rocker", [pytest.param(2.49, marks=pytest.mark.long), 2.499])
@pytest.mark.parametrize("poses", [361, pytest.param(3601, marks=pytest.mark.long)])
def test_behind_a_narrow_gap_poses_are_reached_the_other_way_round(rocker, poses):
    """The crank passes all of its turn but 0.09 to 0.2 rad where coupler and rocker would be stretched too far."""
    lengths = {"ground": 4.0, "crank": 1.5, "coupler": 3.0, "rocker": rocker}
    inputs = np.linspace(-np.pi, np.pi, poses)
    motion = planar_fourbar(np.pi / 2, **lengths).sweep({"A": inputs})
    reach = np.abs(4.0 - 1.5 * np.exp(1j * (np.pi / 2 + inputs)))
    np.testing.assert_array_equal(motion.status, np.where(reach < 3.0 + rocker, Status.CLOSED, Status.UNREACHABLE))
    assert np.sum(~motion.closed) >= 5


@pytest.mark.long
def test_far_beyond_the_limits_no_pose_closes():
    """A crank longer than coupler and rocker together: they do not reach it anywhere on the far side."""
    lengths = {"ground": 1.457442573711074, "crank": 1.886036060218882, "coupler": 0.353211887598004}
    mechanism = planar_fourbar(0.25, **lengths, rocker=0.303088357646203)
    motion = mechanism.sweep({"A": np.linspace(-np.pi, np.pi, 101)})
    away = np.abs(lengths["ground"] - lengths["crank"] * np.exp(1j * (0.25 + np.linspace(-np.pi, np.pi, 101))))
    np.testing.assert_array_equal(np.asarray(motion.status) == Status.UNREACHABLE, away > 0.656300245243)
    assert np.sum(motion.closed) > 5


@pytest.mark.long
@pytest.mark.parametrize("turns", [1, 2])
@pytest.mark.parametrize("shift", [0.0, 0.3, -0.25])
def test_behind_a_gap_on_another_circuit_is_jumped(turns, shift):
    """A crank-rocker driven by its rocker: the two circuits share the sign of the Jacobian, their ranges mirror."""
    start = np.pi / 3
    assembled = planar.fourbar(np.array([start])).rocker[0] % (2 * np.pi)
    dead_points = [np.arccos((100**2 + 80**2 - length**2) / (2 * 100 * 80)) for length in (120 - 40, 120 + 40)]
    inputs = np.linspace(-turns * np.pi, turns * np.pi, 91) + shift
    motion = planar_fourbar(start).sweep({"D": inputs})
    between = (assembled + inputs) % (2 * np.pi)  # angle of the rocker from the line of the ground
    own = (np.pi - between > dead_points[0]) & (np.pi - between < dead_points[1])
    mirrored = (between - np.pi > dead_points[0]) & (between - np.pi < dead_points[1])
    expected = np.select([own, mirrored], [Status.CLOSED, Status.JUMPED], Status.UNREACHABLE)
    np.testing.assert_array_equal(motion.status, expected)
    assert np.sum(own) > 5 and np.sum(mirrored) > 5


@pytest.mark.parametrize("poses", [50, pytest.param(721, marks=pytest.mark.long)])
@pytest.mark.parametrize("inputs", [(0.0, 2 * np.pi), (0.0, -2 * np.pi), (-1.0, 2 * np.pi - 1.0), (-1.0, 5 * np.pi)])
def test_a_parallelogram_stays_one_through_its_change_points(poses, inputs):
    """At crank angle 0 and pi both branches meet; the third grid starts on a change point exactly."""
    mechanism = planar_fourbar(1.0, ground=120.0, crank=50.0, coupler=120.0, rocker=50.0)
    range_ = np.linspace(*inputs, poses)
    motion = mechanism.sweep({"A": range_})
    assert np.all(motion.closed)
    # at a change point a residual of 1e-15 leaves the pose free by its square root
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], range_, atol=1e-7)


@pytest.mark.long
def test_order_repetition_and_spacing_of_the_inputs_do_not_matter():
    mechanism = planar_fourbar(1.0)
    rng = np.random.default_rng(3)
    shuffled = rng.permutation(np.concatenate([rng.uniform(-7.0, 9.0, 300), np.zeros(5), np.full(5, 9.0)]))
    motion = mechanism.sweep({"A": shuffled})
    assert np.all(motion.closed)
    order = np.argsort(shuffled, kind="stable")
    ordered = mechanism.sweep({"A": shuffled[order]})
    np.testing.assert_allclose(motion.coordinates["D"][order], ordered.coordinates["D"], atol=1e-13)
    # full turns are counted: the rocker of a crank-rocker comes back, the coupler too
    crank_again = mechanism.sweep({"A": shuffled + 2 * np.pi})
    np.testing.assert_allclose(crank_again.coordinates["D"], motion.coordinates["D"], atol=1e-12)


@pytest.mark.parametrize("poses", [0, 1, 2])
def test_few_poses(poses):
    motion = planar_fourbar(1.0).sweep({"A": np.linspace(0.0, 3.0, poses)})
    assert len(motion) == poses
    assert motion.transforms["coupler"].shape == (poses, 4, 4)
    assert np.all(motion.closed)


@pytest.mark.long
@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1e3, 1e6])
def test_units_do_not_matter(scale):
    """The same mechanism in other units gives the same angles, to rounding."""
    range_ = np.linspace(0.0, 2 * np.pi, 100)
    original, scaled = slider_crank(1.0), slider_crank(1.0, 40.0 * scale, 120.0 * scale, -20.0 * scale)
    one, other = original.sweep({"A": range_}), scaled.sweep({"A": range_})
    np.testing.assert_allclose(other.coordinates["B"], one.coordinates["B"], atol=1e-13)
    np.testing.assert_allclose(other.coordinates["S"] / scale, one.coordinates["S"], atol=1e-11)
    np.testing.assert_allclose(other.residual, 0.0, atol=1e-13)


@pytest.mark.long
def test_driving_the_other_end_gives_the_same_poses():
    """The slider driven by the distances that the crank gave it: the crank turns as before."""
    range_ = np.linspace(0.0, 1.5, 40)
    forward = slider_crank(1.0).sweep({"A": range_})
    back = slider_crank(1.0).sweep({"S": forward.coordinates["S"][:, 0]})
    np.testing.assert_allclose(back.coordinates["A"][:, 0], range_, atol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("order", ["along a curve", "shuffled"])
def test_two_inputs_of_a_five_bar(order):
    """Two cranks place the tip of a five-bar: it is where circles about the crank pins meet."""
    from reference.planar import meet, polar

    a, b = np.linspace(0.0, -1.0, 60), np.linspace(0.0, 0.7, 60) + 0.1 * np.sin(np.linspace(0.0, 9.0, 60))
    b -= b[0]
    left, right = polar(30.0, 2.0 + a), np.array([60.0, 0.0]) + polar(30.0, 1.0 + b)
    tip = meet(left, 50.0, right, 45.0, 1)

    def pin(name, one, two, point):
        return revolute(name, one, two, point=(*point, 0.0), axis=(0.0, 0.0, 1.0))

    mechanism = Mechanism.build(
        fixed=["ground"],
        joints=[
            pin("A", "ground", "left crank", (0.0, 0.0)),
            pin("B", "ground", "right crank", (60.0, 0.0)),
            pin("C", "left crank", "left rod", left[0]),
            pin("D", "right crank", "right rod", right[0]),
            pin("E", "left rod", "right rod", tip[0]),
        ],
    )
    which = np.arange(60) if order == "along a curve" else np.random.default_rng(3).permutation(60)
    motion = mechanism.sweep({"A": a[which], "B": b[which]})
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.points("left rod", (*tip[0], 0.0))[:, :2], tip[which], atol=1e-11)
    np.testing.assert_allclose(motion.points("right rod", (*tip[0], 0.0))[:, :2], tip[which], atol=1e-11)


def test_an_open_chain_moves_without_being_solved():
    mechanism = Mechanism.build(
        fixed=["base"],
        joints=[
            revolute("turn", "base", "arm", point=(0, 0, 0), axis=(0, 0, 1)),
            prismatic("reach", "arm", "hand", axis=(1, 0, 0)),
        ],
    )
    motion = mechanism.sweep({"turn": [0.0, np.pi / 2], "reach": [0.0, 2.0]})
    np.testing.assert_allclose(motion.points("hand", (1.0, 0.0, 0.0)), [[1, 0, 0], [0, 3, 0]], atol=1e-15)
    assert np.all(motion.residual == 0)


@pytest.mark.long
def test_only_loops_that_are_driven_are_solved():
    """A second loop on its own, not driven, stays at rest exactly."""
    driven, other = planar_fourbar(1.0), planar_fourbar(2.0)
    renamed = [
        revolute(
            f"{j.name}2",
            *(p if p == "ground" else f"{p}2" for p in j.parts),
            point=j.frames_1[0][:3, 3],
            axis=(0, 0, 1),
        )
        for j in other.all_joints
    ]
    both = Mechanism.build(fixed=["ground"], joints=[*driven.all_joints, *renamed])
    motion = both.sweep({"A": np.linspace(0.0, 1.0, 10)})
    for joint in ("A2", "B2", "C2", "D2"):
        assert np.all(motion.coordinates[joint] == 0)
    alone = driven.sweep({"A": np.linspace(0.0, 1.0, 10)})
    np.testing.assert_array_equal(motion.coordinates["C"], alone.coordinates["C"])


def test_a_ball_driven_by_its_three_angles():
    mechanism = Mechanism.build(fixed=["base"], joints=[spherical("ball", "base", "stick", point=(0, 0, 0))])
    motion = mechanism.sweep({"ball.theta": [0.1], "ball.phi": [0.2], "ball.psi": [0.3]})
    np.testing.assert_allclose(
        motion.points("stick", (1, 0, 0))[0],
        [np.cos(0.3) * np.cos(0.2), np.sin(0.3) * np.cos(0.2), -np.sin(0.2)],
        atol=1e-15,
    )


@pytest.mark.long
def test_the_rod_of_an_rssr_does_not_spin():
    """Its idle freedom has no memory: each pose is the same by whatever way, and 1,000 turns leave nothing."""
    mechanism = rssr_linkage()
    back_and_forth = 2.0 * np.sin(np.linspace(0.0, 2 * np.pi, 99))
    motion = mechanism.sweep({"A": back_and_forth})
    for joint in "ABCD":
        angles = np.asarray(motion.coordinates[joint])
        np.testing.assert_allclose(angles[-1], 0.0, atol=1e-12)
        np.testing.assert_allclose(
            angles[:25], angles[49:24:-1], atol=1e-11
        )  # each input of the first half comes twice
    turns = mechanism.sweep({"A": 2 * np.pi * np.arange(-500, 500, 7)})
    assert np.all(turns.closed)
    for joint in "BCD":
        angles = np.asarray(turns.coordinates[joint])
        # a ball's angles count full turns too; 1e-12 of rounding in an input of 3000 rad
        np.testing.assert_allclose(angles - 2 * np.pi * np.round(angles / (2 * np.pi)), 0.0, atol=1e-11)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
def test_many_turns_close_as_nearly_as_their_angles_are_told_apart():
    """At 100 turns neighbouring angles of float32 are 6e-5 rad apart: so much is each of the three angles off, too."""
    inputs = np.linspace(0.0, 200 * np.pi, 2000).astype(np.float32)
    with jax.enable_x64(False):
        motion = planar_fourbar(1.0).sweep({"A": inputs})
        asked = planar_fourbar(1.0).sweep({"A": inputs}, tolerance=2e-6)
    assert np.all(motion.status == Status.CLOSED)
    assert np.any(asked.status == Status.STALLED)  # a tolerance that is asked for is kept
    crank = 1.0 + inputs.astype(float)
    rocker = planar.fourbar(crank).rocker - planar.fourbar(np.array([1.0])).rocker
    error = (np.asarray(motion.coordinates["D"][:, 0], float) - rocker + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(error, 0.0, atol=5 * 6e-5)  # the rocker turns by less than the crank
