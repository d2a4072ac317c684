"""The implicit derivative of a closed pose against one made by hand, from the loop equation of a four-bar.

a exp(i theta) + b exp(i beta) = d + c exp(i psi), differentiated, times exp(-i beta), real part:
c sin(psi - beta) d psi = a sin(theta - beta) d theta - cos(theta - beta) d a - d b + cos(psi - beta) d c.
Tolerance 1e-12: rounding through the Jacobian, of which the smallest singular value is above 0.1.
"""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closure.closure import scaled_geometry
from jaxkin.solve.range.implicit_derivative import attach_derivative
from jaxkin.solve.system.state import State
from reference import planar
from reference.mechanisms import planar_fourbar

START, TURN = 1.0, np.linspace(0.0, 2.0, 7)
CRANK, COUPLER, ROCKER = 40.0, 120.0, 80.0


@pytest.fixture(scope="module")
def closed():
    """The one structure element of the four-bar, its joints, and its states by the closed form."""
    (element,) = plan_drive(planar_fourbar(START).linkage, ("A",)).loop_groups
    theta = START + np.concatenate([[0.0], TURN])
    at = planar.fourbar(theta)
    angles = {0: theta, 1: at.coupler - theta, 2: at.rocker - at.coupler, 3: at.rocker}
    rows = [angles[joint][1:] - angles[joint][0] for joint, _ in element.columns]
    state = State(jnp.asarray(np.stack(rows)), jnp.zeros((0, 4, len(TURN))))
    return element, state, theta[1:], at.coupler[1:], at.rocker[1:]


def rocker_rate(element, state, d_inputs, d_joints, closes=None):
    """Derivative of the rocker's displacement for changes of inputs and joints."""
    closes = jnp.ones(len(TURN), bool) if closes is None else closes
    joints = jax.tree.map(jnp.asarray, element.joints)
    found = _all_rates(element.system, state, joints, closes, jnp.asarray(d_inputs), d_joints)
    return found[element.columns.index((3, 0))]


@partial(jax.jit, static_argnums=0)
def _all_rates(system, state, joints, closes, d_inputs, d_joints):
    def coordinates(inputs, joints):
        geometry, _ = scaled_geometry(system, joints)
        return attach_derivative(system, geometry, inputs, state, closes).x

    return jax.jvp(coordinates, (jnp.asarray(TURN)[None], joints), (d_inputs, d_joints))[1]


def moved(element, joint, side, direction):
    """A change of the joints: the origin of one frame of one joint moves in a direction."""
    joints = jax.tree.map(lambda leaf: jnp.zeros_like(jnp.asarray(leaf)), element.joints)
    frames = list(getattr(joints, side))
    frames[joint] = frames[joint].at[0, :2, 3].set(direction)
    return joints._replace(**{side: tuple(frames)})


@pytest.mark.long
def test_with_respect_to_the_input(closed):
    element, state, theta, beta, psi = closed
    still = jax.tree.map(lambda leaf: jnp.zeros_like(jnp.asarray(leaf)), element.joints)
    found = rocker_rate(element, state, np.ones((1, len(TURN))), still)
    expected = CRANK * np.sin(theta - beta) / (ROCKER * np.sin(psi - beta))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("length", ["crank", "coupler", "rocker"])
def test_with_respect_to_a_length(closed, length):
    """The far end of each link moves along the link as it is in the assembled pose, on the link's own side only."""
    element, state, theta, beta, psi = closed
    start = planar.fourbar(np.array([START]))
    joint, side, angle, hand_made = {
        "crank": (1, "frames_1", START, -np.cos(theta - beta)),
        "coupler": (2, "frames_1", start.coupler[0], -np.ones(len(TURN))),
        "rocker": (2, "frames_2", start.rocker[0], np.cos(psi - beta)),
    }[length]
    change = moved(element, joint, side, [np.cos(angle), np.sin(angle)])
    found = rocker_rate(element, state, np.zeros((1, len(TURN))), change)
    np.testing.assert_allclose(found, hand_made / (ROCKER * np.sin(psi - beta)), rtol=1e-12, atol=1e-15)


def test_poses_that_did_not_close_have_none_and_spoil_no_other(closed):
    element, state, *_ = closed
    still = jax.tree.map(lambda leaf: jnp.zeros_like(jnp.asarray(leaf)), element.joints)
    d_inputs = np.ones((1, len(TURN)))
    closes = jnp.arange(len(TURN)) != 3
    broken = replace_pose(state, 3)
    found = rocker_rate(element, broken, d_inputs, still, closes)
    expected = rocker_rate(element, state, d_inputs, still)
    assert found[3] == 0
    np.testing.assert_array_equal(np.delete(found, 3), np.delete(expected, 3))


def replace_pose(state, number):
    """The state with NaN for one pose."""
    return state._replace(x=state.x.at[:, number].set(jnp.nan))
