"""Derivatives through a sweep against closed forms differentiated by complex steps and central differences."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.closed_form.formula_displacements import LONG_RANGE
from reference.mechanisms import planar_fourbar

NON_GRASHOF = {"ground": 40.0, "crank": 20.0, "coupler": 25.0, "rocker": 30.0}
INPUTS = jnp.linspace(-0.8, 2.0, 30)
START = 1.0


def rocker_angle(theta, ground, crank, coupler, rocker):
    """Freudenstein's equation in jax: the four-bar of the open branch."""
    x, y = ground - crank * jnp.cos(theta), -crank * jnp.sin(theta)
    square = x * x + y * y
    to_crank = jnp.arctan2(-y, -x)
    return to_crank - jnp.arccos((rocker**2 + square - coupler**2) / (2 * rocker * jnp.sqrt(square)))


@pytest.mark.long
def test_velocity_and_acceleration_along_the_drive():
    """Nested forward derivatives: the second one needs the first as a function of the pose."""
    mechanism = planar_fourbar(START)

    def rocker(inputs):
        return mechanism.sweep({"A": inputs}).coordinates["D"][:, 0]

    def velocity(inputs):
        return jax.jvp(rocker, (inputs,), (jnp.ones_like(inputs),))[1]

    first, second = jax.jvp(velocity, (INPUTS,), (jnp.ones_like(INPUTS),))
    closed = lambda theta: rocker_angle(theta, 100.0, 40.0, 120.0, 80.0)  # noqa: E731
    slope = jax.vmap(jax.grad(closed))
    np.testing.assert_allclose(first, slope(START + INPUTS), rtol=1e-9, atol=1e-11)
    np.testing.assert_allclose(second, jax.vmap(jax.grad(jax.grad(closed)))(START + INPUTS), rtol=1e-9, atol=1e-11)


@pytest.mark.long
def test_reverse_mode_with_respect_to_every_frame_of_a_mechanism():
    """Moving the coupler's end of pin B along the coupler changes its length only: the closed form's derivative."""
    mechanism = planar_fourbar(START)

    def loss(mechanism):
        return jnp.sum(mechanism.sweep({"A": INPUTS}).coordinates["D"][:, 0] ** 2)

    gradient = jax.grad(loss)(mechanism)
    pins = [np.asarray(mechanism.joints[name].frames_1[0][:3, 3]) for name in "BC"]
    along = (pins[1] - pins[0]) / np.linalg.norm(pins[1] - pins[0])
    found = -np.asarray(gradient.joints["B"].frames_2[0][:3, 3]) @ along

    def closed(coupler):
        # displacements are counted from the assembled pose, in which the joints' coordinates are zero
        at_rest = rocker_angle(START, 100.0, 40.0, 120.0, 80.0)
        return jnp.sum((rocker_angle(START + INPUTS, 100.0, 40.0, coupler, 80.0) - at_rest) ** 2)

    np.testing.assert_allclose(found, jax.grad(closed)(120.0), rtol=1e-9)


@pytest.mark.long
def test_gradient_of_a_built_mechanism_inside_jit():
    """Numbers that are traced go through `build`: the derivative with respect to a point of a joint."""
    base = planar_fourbar(START)
    point = jnp.asarray(base.joints["C"].frames_1[0][:3, 3])

    def loss(x):
        from jaxkin.joints.pairs import revolute
        from jaxkin.mechanism.mechanism import Mechanism

        joints = list(base.all_joints)
        joints[2] = revolute("C", "coupler", "rocker", point=x, axis=(0.0, 0.0, 1.0))
        moved = Mechanism.build(fixed=["ground"], joints=joints)
        return jnp.sum(moved.sweep({"A": INPUTS}).coordinates["D"] ** 2)

    gradient = jax.jit(jax.grad(loss))(point)
    step = 1e-5  # central differences: error about step^2, rounding about 1e-16 / step
    numeric = [(loss(point + step * e) - loss(point - step * e)) / (2 * step) for e in jnp.eye(3)]
    np.testing.assert_allclose(gradient, numeric, rtol=1e-7, atol=1e-8)
    assert abs(gradient[2]) < 1e-12  # along the axis nothing changes


@pytest.mark.long
def test_unreachable_poses_have_no_derivative_and_spoil_no_other():
    mechanism = planar_fourbar(START, **NON_GRASHOF)
    inputs = jnp.linspace(0.0, 3.0, 40)

    def rocker(inputs):
        return mechanism.sweep({"A": inputs}).coordinates["D"][:, 0]

    closed = np.asarray(mechanism.sweep({"A": inputs}).closed)
    assert 0 < closed.sum() < len(closed)
    slopes = np.asarray(jax.jvp(rocker, (inputs,), (jnp.ones_like(inputs),))[1])
    backward = np.asarray(jax.grad(lambda u: jnp.sum(rocker(u)))(inputs))
    exact = jax.vmap(jax.grad(lambda t: rocker_angle(t, 40.0, 20.0, 25.0, 30.0)))(START + inputs)
    np.testing.assert_allclose(slopes[closed], np.asarray(exact)[closed], rtol=1e-8)
    np.testing.assert_allclose(backward[closed], slopes[closed], rtol=1e-9)
    assert np.all(slopes[~closed] == 0) and np.all(backward[~closed] == 0)


@pytest.mark.long
def test_a_long_range_has_the_derivatives_of_its_parts():
    """Beyond `LONG_RANGE` poses derivatives are computed in groups, and again in the reverse pass."""
    mechanism, poses = planar_fourbar(1.0), LONG_RANGE + 1000
    inputs = jnp.linspace(0.0, 6.0, poses)
    weights = jnp.asarray(np.random.default_rng(3).normal(size=poses))

    def loss(length, inputs, weights):
        longer = mechanism.with_lengths({("coupler", "B", "C"): length})
        return jnp.sum(weights * longer.sweep({"A": inputs}).coordinates["D"][:, 0])

    half = poses // 2
    for derivative in (jax.grad, jax.jacfwd):
        of = jax.jit(derivative(loss))
        parts = of(121.0, inputs[:half], weights[:half]) + of(121.0, inputs[half:], weights[half:])
        # sums of 17,000 numbers of about one
        np.testing.assert_allclose(of(121.0, inputs, weights), parts, atol=1e-11)
