"""Projection of coordinates onto closed poses: nearest by brute force, its conditions, derivatives and statuses."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.catalogue import fivebar
from reference.mechanisms import bennett_linkage, planar_fourbar

FOURBAR = planar_fourbar()
RNG = np.random.default_rng(5)


def random_rows(mechanism, poses, width=0.15):
    return {
        joint.name: RNG.uniform(-width, width, (poses, joint.freedoms))
        for joint in mechanism.all_joints
        if joint.freedoms
    }


def apart(one, other):
    """Distances between rows of coordinates, both by name."""
    return np.sqrt(sum(np.sum((np.asarray(one[name]) - np.asarray(other[name])) ** 2, axis=-1) for name in one))


@pytest.mark.long
def test_no_pose_of_the_whole_motion_is_nearer():
    given = random_rows(FOURBAR, 40)
    found = jk.project(FOURBAR, given)
    assert np.all(found.motion.closed) and np.all(found.nearest)
    np.testing.assert_allclose(apart(given, found.motion.coordinates), found.distance, rtol=1e-12)
    every = FOURBAR.sweep({"A": np.linspace(-0.4, 0.4, 4001)})
    dense = {name: np.asarray(rows)[None] for name, rows in every.coordinates.items()}
    least = apart({name: rows[:, None] for name, rows in given.items()}, dense).min(axis=1)
    # steps of 2e-4: the nearest of them is farther by up to half the square of a step over the distance, 0.01 at least
    assert np.all(found.distance <= least + 1e-12)
    np.testing.assert_allclose(found.distance, least, rtol=1e-4)


@pytest.mark.long
def test_closed_poses_stay_and_held_coordinates_too():
    motion = FOURBAR.sweep({"A": np.linspace(0, 1, 7)})
    found = jk.project(FOURBAR, motion.coordinates)
    for name, rows in motion.coordinates.items():
        np.testing.assert_allclose(found.motion.coordinates[name], rows, atol=1e-13)  # rounding
    given = random_rows(FOURBAR, 7)
    held = jk.project(FOURBAR, given, hold=["A"])
    np.testing.assert_array_equal(held.motion.coordinates["A"], given["A"])
    swept = FOURBAR.sweep({"A": given["A"][:, 0]})  # one freedom: nothing is left to choose
    for name, rows in swept.coordinates.items():
        np.testing.assert_allclose(held.motion.coordinates[name], rows, atol=1e-11)


@pytest.mark.long
def test_a_heavy_coordinate_moves_as_if_it_were_held():
    given = random_rows(FOURBAR, 5)
    heavy = jk.project(FOURBAR, given, weights={"A.phi": 1e4})
    held = jk.project(FOURBAR, given, hold=["A"])
    np.testing.assert_allclose(heavy.motion.coordinates["D"], held.motion.coordinates["D"], atol=1e-6)  # 1 / 1e4^2


@pytest.mark.long  # each compiles a program
@pytest.mark.parametrize("make", [fivebar, bennett_linkage])
def test_what_moves_is_at_right_angles_to_the_closed_poses(make):
    """The condition of a nearest point, with a null space of all twelve equations that the solver does not use."""
    mechanism = make()
    given = random_rows(mechanism, 6, 0.05)
    found = jk.project(mechanism, given)
    assert np.all(found.nearest)
    for pose in range(6):
        at = {name: np.asarray(rows)[pose] for name, rows in found.motion.coordinates.items()}
        equations = mechanism.closure(at)
        assert np.linalg.norm(equations.residual) < 1e-12
        _, values, right = np.linalg.svd(equations.jacobian)
        tangent = right[int(np.sum(values > 1e-7 * values[0])) :]
        off = np.concatenate([given[joint.name][pose] - at[joint.name] for joint in mechanism.all_joints])
        assert len(tangent) == mechanism.mobility().freedoms
        assert np.abs(tangent @ off).max() < 1e-8  # steps end at 1e-9


@pytest.mark.long
def test_derivatives_are_those_of_the_nearest_pose():
    names = [joint.name for joint in FOURBAR.all_joints]
    start = RNG.uniform(-0.2, 0.2, (1, 4))  # far: the curvature of the closed poses counts

    def loss(row):
        found = jk.project(FOURBAR, {name: row[:, k] for k, name in enumerate(names)})
        return jnp.sin(found.motion.coordinates["B"]).sum() + found.motion.coordinates["D"].sum() ** 2

    slope = jax.grad(loss)(start)
    for k in range(4):
        step = np.zeros((1, 4))
        step[0, k] = 1e-5
        difference = (loss(start + step) - loss(start - step)) / 2e-5
        np.testing.assert_allclose(slope[0, k], difference, rtol=1e-6, atol=1e-8)  # central differences: 1e-10


@pytest.mark.long
def test_derivatives_by_a_held_coordinate_are_those_of_a_drive():
    """A four-bar whose crank is held has one pose: it moves with the crank as a sweep does."""
    by_holding = lambda angle: jk.project(FOURBAR, {"A": angle, "D": angle}, hold=["A"]).motion  # noqa: E731
    by_driving = lambda angle: FOURBAR.sweep({"A": angle})  # noqa: E731
    found, expected = (
        jax.jacrev(lambda angle, follow=follow: jnp.concatenate(follow(angle).displacements))(np.array([0.2]))
        for follow in (by_holding, by_driving)
    )
    np.testing.assert_allclose(found, expected, atol=1e-9)  # steps of the projection end at 1e-9


@pytest.mark.long
@pytest.mark.parametrize("hold", [["one.theta", "one.phi", "one.psi"], ["three.theta"]])
def test_derivatives_by_a_held_ball_are_differences(hold):
    points = {"one": (0, 0, 0), "two": (3, 2, 1), "three": (6, 1, -1), "four": (8, 0, 0)}
    parts = [("ground", "a"), ("a", "b"), ("b", "c"), ("ground", "c")]
    balls = [jk.spherical(name, *pair, point=points[name]) for name, pair in zip(points, parts, strict=True)]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=balls)

    def moved(rows):
        found = jk.project(mechanism, {name: rows[k][None] for k, name in enumerate(points)}, hold=hold)
        return jnp.concatenate(found.motion.displacements)

    given = RNG.uniform(-0.1, 0.1, (4, 3))
    along = RNG.normal(size=(4, 3))
    slope = jax.jvp(moved, (given,), (along,))[1]
    difference = (moved(given + 1e-4 * along) - moved(given - 1e-4 * along)) / 2e-4
    # central differences err by 1e-8 of the third derivative, and by the end of the steps, 1e-9, over 1e-4
    np.testing.assert_allclose(slope, difference, atol=1e-5)


@pytest.mark.long  # compiles two programs
def test_it_works_inside_jit_and_vmap():
    given = random_rows(FOURBAR, 3)
    found = jk.project(FOURBAR, given)
    again = jax.jit(lambda rows: jk.project(FOURBAR, rows))(given)
    np.testing.assert_allclose(again.distance, found.distance, rtol=1e-12)
    mapped = jax.vmap(lambda rows: jk.project(FOURBAR, {k: v[None] for k, v in rows.items()}).distance[0])(given)
    np.testing.assert_allclose(mapped, found.distance, rtol=1e-12)


def test_poses_that_are_no_numbers_or_cannot_close_are_data():
    given = random_rows(FOURBAR, 3)
    given["A"][1] = np.nan
    found = jk.project(FOURBAR, given)
    assert [jk.Status(int(each)).name for each in found.motion.status] == ["CLOSED", "NONFINITE", "CLOSED"]
    assert np.isnan(found.motion.coordinates["D"][1]).all() and np.isnan(found.distance[1])
    assert not found.nearest[1]
    assert "2 of 3 poses close" in str(found)
    # the crank held in line with the ground, outwards, lets a rocker of 20 between rod of 30 not close
    short = planar_fourbar(np.pi / 3, ground=100.0, crank=60.0, coupler=40.0, rocker=60.0)
    lost = jk.project(short, {"A": np.array([2.0])}, hold=["A"])
    assert jk.Status(int(lost.motion.status[0])) is jk.Status.UNREACHABLE
    assert not lost.nearest[0] and float(lost.motion.residual[0]) > 0.1


@pytest.mark.parametrize(
    ("given", "more", "message"),
    [
        ({"Q": [0.0]}, {}, "no joint 'Q'"),
        ({"A": np.zeros((2, 3))}, {}, r"joint 'A' has 1 coordinate \(phi\): expected an array"),
        ({"A": [0.0], "B": [0.0, 1.0]}, {}, "as many poses"),
        ({}, {}, "no coordinates are given"),
        ({"A": [0.0]}, {"weights": {"A": 0.0}}, "positive number"),
        ({"A": [0.0]}, {"hold": ["Z"]}, "Z"),
    ],
)
def test_wrong_coordinates_are_refused(given, more, message):
    with pytest.raises(ValueError, match=message):
        jk.project(FOURBAR, given, **more)


@pytest.mark.long
def test_a_mechanism_without_coordinates_is_refused():
    welded = jk.Mechanism.build(fixed=["base"], joints=[jk.fixed("weld", "base", "part")])
    with pytest.raises(ValueError, match="no joint of the mechanism has a coordinate"):
        jk.project(welded, {"weld": np.zeros((2, 0))})
