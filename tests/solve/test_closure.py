"""The closure kernel against the paper's matrices, and its Jacobian against automatic differentiation."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.motions import MOVEMENTS, movement_matrix
from jaxkin.solve import closure as module
from jaxkin.solve import spatial
from jaxkin.solve.state import angles, assembled, drive, from_angles, multiply, retract, rotation_matrix
from jaxkin.solve.system import Form, LoopSystem

closure = jax.jit(module.closure, static_argnums=0)
loop_geometry = jax.jit(module.loop_geometry, static_argnums=0)
travel = jax.jit(spatial._travel, static_argnums=0)

CHAINS = (("T_z_phi",), ("T_xy_phi", "T_phi"), ("T_theta_phi_psi",), ("T_screw",), ("T_theta_phi",), ("I",))


def random_pose(rng):
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    pose = np.eye(4)
    pose[:3, :3] = rotation * np.sign(np.linalg.det(rotation))
    pose[:3, 3] = rng.normal(size=3)
    return pose


@pytest.fixture
def loop():
    """A loop through every kind of movement, both ways round, with frames that differ on the two parts."""
    rng = np.random.default_rng(4)
    system = LoopSystem(
        CHAINS, (((0, 1), (1, -1), (2, 1), (3, -1), (4, 1), (5, 1)), ((2, -1), (0, 1), (4, -1))), (0,), Form()
    )
    before = tuple(jnp.array([random_pose(rng) for _ in chain]) for chain in CHAINS)
    after = tuple(jnp.array([random_pose(rng) for _ in chain]) for chain in CHAINS)
    pitch = tuple(jnp.asarray(0.7 if chain == ("T_screw",) else 0.0) for chain in CHAINS)
    return system, before, after, pitch, jnp.asarray(rng.normal(size=(system.columns, 5)))


def as_state(system, q):
    state = drive(system, assembled(system, q.shape[1], q.dtype), q[jnp.array(system.driven)])
    turns = jnp.stack([from_angles(q[first : first + 3]) for first in system.balls])
    return state._replace(x=q, turns=turns)


def test_gap_is_equation_12_of_the_products_of_the_papers_matrices(loop):
    system, before, after, pitch, q = loop
    geometry, length = loop_geometry(system, before, after, pitch)
    scaled = q / jnp.where(jnp.array(system.is_length), length, 1.0)[:, None]
    found = closure(system, geometry, as_state(system, scaled)).gap

    def joint(index):
        matrix = jnp.eye(4)
        for name, frame, column, _ in system.chains[index]:
            count = len(MOVEMENTS[name].coordinates)
            turn = movement_matrix(name, q[column : column + count].T, pitch[index])
            matrix = matrix @ before[index][frame] @ turn @ jnp.linalg.inv(after[index][frame])
        return matrix

    centre = jnp.mean(jnp.concatenate([frames[:, :3, 3] for frames in before]), axis=0)
    to_centre = jnp.eye(4).at[:3, 3].set(centre)
    square = 0.0
    for travelled in system.loops:
        product = jnp.linalg.inv(to_centre)
        for index, sign in travelled:
            product = product @ (joint(index) if sign > 0 else jnp.linalg.inv(joint(index)))
        equations = (product @ to_centre - jnp.eye(4))[:, :3] / jnp.array([1.0, 1.0, 1.0, length])
        square += jnp.sum(equations**2, axis=(1, 2))
    np.testing.assert_allclose(found, jnp.sqrt(square), rtol=1e-12)  # twenty products of numbers of order one


def test_jacobian_is_the_derivative_of_the_residual_where_the_loops_close(loop):
    """Away from closure the columns are twists, so the loop is closed first, by a constant behind its last joint."""
    system, before, after, pitch, q = loop
    system = LoopSystem(system.movements, system.loops[:1], system.driven, Form())
    geometry, _ = loop_geometry(system, before, after, pitch)
    state = as_state(system, q[:, :1])

    def end(delta):
        """The displacement of the end of the loop relative to where it is at delta = 0, as rotation and translation."""
        closed = closure(system, geometry_closed, retract(system, state, delta))
        return closed.residual[:, 0]

    geometry_closed = close_behind(system, geometry, state)
    np.testing.assert_allclose(closure(system, geometry_closed, state).gap, 0.0, atol=1e-13)
    free = [column for column in range(system.columns)]
    jacobian = jax.jit(jax.jacfwd(end))(jnp.zeros((system.columns, 1)))[..., 0]
    found = closure(system, geometry_closed, state).jacobian[..., 0]
    np.testing.assert_allclose(found[:, free], jacobian[:, free], atol=1e-12)


def close_behind(system, geometry, state):
    """The geometry whose last constant closes the loop at this state."""
    rotation, translation, _ = travel(system, geometry, state)
    end = np.eye(4)
    end[:3, :3], end[:3, 3] = np.asarray(rotation)[..., 0, 0].T, np.asarray(translation)[:, 0, 0]
    return geometry._replace(end=geometry.end @ np.linalg.inv(end))


def test_angles_are_the_inverse_of_from_angles():
    rng = np.random.default_rng(1)
    given = jnp.asarray(rng.uniform([[-3.1], [-1.5], [-3.1]], [[3.1], [1.5], [3.1]], size=(3, 200)))
    np.testing.assert_allclose(angles(from_angles(given)), given, atol=1e-13)  # cos(phi) is at least 0.07


def test_angles_at_the_lock_give_the_same_rotation():
    given = jnp.array([[0.3, -0.4], [np.pi / 2, -np.pi / 2], [0.5, 1.2]])
    read = angles(from_angles(given))
    for one, other in zip(rotation_columns(given), rotation_columns(read), strict=True):
        np.testing.assert_allclose(one, other, atol=2e-8)  # near the lock phi is known to the square root of rounding


def rotation_columns(given):
    return [jnp.stack(column) for column in rotation_matrix(from_angles(given))]


def test_a_ball_turns_half_a_turn_about_any_axis():
    """retract never locks: many small turns about a generic axis add up to the turn about that axis."""
    system = LoopSystem((("T_theta_phi_psi",),), (((0, 1),),), (), Form())
    axes = np.random.default_rng(2).normal(size=(3, 20))
    axes /= np.linalg.norm(axes, axis=0)
    state = assembled(system, 20, jnp.float64)
    for _ in range(40):
        state = retract(system, state, jnp.asarray(axes * np.pi / 40))
    expected = np.concatenate([np.zeros((1, 20)), axes])
    np.testing.assert_allclose(state.turns[0], expected, atol=1e-14)
    identity = multiply(state.turns[0], state.turns[0])
    np.testing.assert_allclose(identity[0], -1.0, atol=1e-14)
