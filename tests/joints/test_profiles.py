"""Points of a profile are numbers of the mechanism: replaced, differentiated, designed."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.oval_cam import TURN, roller, swings


@pytest.fixture(scope="module")
def oval():
    return roller()


@pytest.fixture(scope="module")
def swung(oval):
    return swings(oval)


def test_a_profile_is_changed_by_its_points(oval, swung):
    points = np.asarray(oval.joints["contact"].curves[0].points)
    same = oval.with_points({("contact", "profile"): points})
    np.testing.assert_array_equal(swings(same), swung)
    larger = oval.with_points({("contact", "profile"): 1.02 * points})
    # what is swept from there is what is closed there, and what is built so
    closed = larger.close()
    assert closed.closed
    made = roller(1.02 * points)
    motion = larger.sweep({"shaft": TURN}, throw=True)
    assert np.all(np.asarray(motion.coordinates["pivot"])[:, 0] < swung)
    other = made.close().mechanism.sweep({"shaft": TURN}, throw=True)
    moved = float(made.close().coordinates["shaft"][0])
    again = larger.sweep({"shaft": TURN + moved}, throw=True)
    lifted = np.asarray(again.coordinates["pivot"])[:, 0] - np.asarray(again.coordinates["pivot"])[0, 0]
    np.testing.assert_allclose(other.coordinates["pivot"][:, 0], lifted, atol=1e-11)


@pytest.mark.parametrize(
    "points, message",
    [
        (np.zeros((59, 2)), r"as many as before, of shape \(60, 2\), got shape \(59, 2\)"),
        (np.full((60, 2), np.nan), "point 0 of profile is not finite"),
    ],
)
def test_points_that_make_no_profile_are_refused(oval, points, message):
    with pytest.raises(ValueError, match=message):
        oval.with_points({("contact", "profile"): points})
    with pytest.raises(ValueError, match="there is no profile2 of joint 'contact' \\(cam\\), which has 1 of them"):
        oval.with_points({("contact", "profile2"): points})


@pytest.mark.long
def test_derivatives_with_respect_to_the_profile_are_differences(oval):
    points = np.asarray(oval.joints["contact"].curves[0].points)
    direction = np.random.default_rng(2).normal(size=points.shape)
    angles = jnp.asarray(TURN[:5])

    def swing(points):
        motion = oval.with_points({("contact", "profile"): points}).sweep({"shaft": angles})
        return jnp.sum(motion.coordinates["pivot"][:, 0] ** 2)

    step = 1e-4  # of 28: the step squared over the radius of curvature squared
    found = float(jnp.sum(jax.grad(swing)(jnp.asarray(points)) * direction))
    difference = float(swing(points + step * direction) - swing(points - step * direction)) / (2 * step)
    assert found == pytest.approx(difference, rel=1e-6)


@pytest.mark.long
@pytest.mark.study
def test_a_profile_is_designed():
    """The points of a profile are variables of an optimiser: the law of another cam is found again."""
    wanted = roller()
    turn = np.linspace(0.0, 2 * np.pi, 60, endpoint=False)  # as many poses as points: fewer leave bumps between them
    target = wanted.sweep({"shaft": turn}).coordinates["pivot"][:, 0]
    points = np.asarray(wanted.joints["contact"].curves[0].points)
    start = wanted.with_points({("contact", "profile"): 0.97 * points})

    def loss(motion):
        return motion.coordinates["pivot"][:, 0] - jnp.asarray(target)

    profile = jk.design.Free(0.97 * points, points - 3, points + 3)
    best = jk.optimize(
        loss,
        start,
        drive={"shaft": turn},
        points={("contact", "profile"): profile},
        solver=jk.design.LevenbergMarquardt(),
        progress=False,
    )
    found = best.mechanism.sweep({"shaft": turn}, throw=True).coordinates["pivot"][:, 0]
    np.testing.assert_allclose(found, target, atol=1e-6)  # from 0.02 rad: a fit of 60 poses by 120 numbers is exact
