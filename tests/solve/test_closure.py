"""The closure kernel against the paper's matrices, and its Jacobian against automatic differentiation."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.movements import MOVEMENTS
from jaxkin.geometry.pose import rotation
from jaxkin.linkage.loop_class import LoopClass
from jaxkin.solve.closure import closure as module
from jaxkin.solve.closure import spatial
from jaxkin.solve.closure.joint_coordinates import as_state, joint_coordinates
from jaxkin.solve.system.joints import Joints
from jaxkin.solve.system.loop_system import LoopSystem
from jaxkin.solve.system.state import angles, assembled, from_angles, matrix, multiply, retract
from reference.movements import matrix as movement_matrix

closure = jax.jit(module.closure, static_argnums=0)
loop_geometry = jax.jit(module.loop_geometry, static_argnums=0)
travel = jax.jit(spatial._travel, static_argnums=0)

CHAINS = (
    ("T_z_phi",),
    ("T_xy_phi", "T_phi"),
    ("T_theta_phi_psi",),
    ("T_screw",),
    ("T_theta_phi",),
    ("I",),
    ("T_xy_phi", "T_theta_phi"),
    ("T_theta_phi", "T_theta_phi_psi"),
)


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
        CHAINS,
        (
            ((0, 1), (1, -1), (2, 1), (3, -1), (4, 1), (5, 1), (6, 1), (7, -1)),
            ((2, -1), (0, 1), (6, -1), (4, -1), (7, 1)),
        ),
        (0,),
        LoopClass(),
    )
    before = tuple(jnp.array([random_pose(rng) for _ in chain]) for chain in CHAINS)
    after = tuple(jnp.array([random_pose(rng) for _ in chain]) for chain in CHAINS)
    pitch = tuple(jnp.asarray(0.7 if chain == ("T_screw",) else 0.0) for chain in CHAINS)
    return system, before, after, pitch, jnp.asarray(rng.normal(size=(system.columns, 5)))


def displacement(system, before, after, pitch, q, index):
    """Of a joint: the product of the paper's matrices."""
    matrix = jnp.eye(4)
    for name, frame, column, _ in system.chains[index]:
        count = len(MOVEMENTS[name].coordinates)
        turn = movement_matrix(name, q[column : column + count], pitch[index])
        matrix = matrix @ before[index][frame] @ turn @ jnp.linalg.inv(after[index][frame])
    return matrix


@pytest.mark.long
def test_gap_is_equation_12_of_the_products_of_the_papers_matrices(loop):
    system, before, after, pitch, q = loop
    geometry, length = loop_geometry(system, Joints(before, after, pitch))
    lengths = jnp.where(jnp.array(system.is_length), length, 1.0)[:, None]
    state = as_state(system, before, after, q)
    found = closure(system, geometry, state._replace(x=state.x / lengths)).residual_norm

    def joint(index):
        return displacement(system, before, after, pitch, q, index)

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


@pytest.mark.long
def test_jacobian_is_the_derivative_of_the_residual_where_the_loops_close(loop):
    """Away from closure the columns are twists, so the loop is closed first, by a constant behind its last joint."""
    system, before, after, pitch, q = loop
    system = LoopSystem(system.movements, system.loops[:1], system.driven, LoopClass())
    geometry, _ = loop_geometry(system, Joints(before, after, pitch))
    state = as_state(system, before, after, q[:, :1])

    def end(delta):
        """The displacement of the end of the loop relative to where it is at delta = 0, as rotation and translation."""
        closed = closure(system, geometry_closed, retract(system, state, delta))
        return closed.residual[:, 0]

    geometry_closed = close_behind(system, geometry, state)
    np.testing.assert_allclose(closure(system, geometry_closed, state).residual_norm, 0.0, atol=1e-13)
    free = [column for column in range(system.columns)]
    jacobian = jax.jit(jax.jacfwd(end))(jnp.zeros((system.columns, 1)))[..., 0]
    found = closure(system, geometry_closed, state).jacobian[..., 0]
    np.testing.assert_allclose(found[:, free], jacobian[:, free], atol=1e-12)


def close_behind(system, geometry, state):
    """The geometry whose last constant closes the loop at this state."""
    loops = geometry.loops
    rotation, translation, _ = travel(system, loops, state)
    end = np.eye(4)
    end[:3, :3], end[:3, 3] = np.asarray(rotation)[..., 0, 0].T, np.asarray(translation)[:, 0, 0]
    return geometry._replace(loops=loops._replace(end=loops.end @ np.linalg.inv(end)))


@pytest.mark.long
def test_what_is_read_off_is_what_was_put_in(loop):
    """However the frames of a chain lie to each other."""
    system, before, after, pitch, q = loop
    given = 0.3 * q  # farther away frames at random can lie so that two angles do not reach
    found = read(system, before, after, as_state(system, before, after, given))
    for index in range(len(CHAINS)):
        one, other = (displacement(system, before, after, pitch, x, index) for x in (found, given))
        np.testing.assert_allclose(one, other, atol=1e-13)  # of lengths of order one, some products


@pytest.mark.long
@pytest.mark.parametrize("off", [0.0, 1e-4])
def test_balls_roll_anywhere_and_are_read_off_right(off):
    """Long random ways of (d) and (p), frames as in Table 1 or a little off: lines of centres turn about themselves."""
    rng = np.random.default_rng(5)
    system = LoopSystem(CHAINS[-2:], (((0, 1), (1, 1)),), (), LoopClass())
    above = np.eye(4)
    above[2, 3] = 1.3
    before = tuple(
        jnp.array([place, place @ above @ nudge(rng, off)]) for place in (random_pose(rng), random_pose(rng))
    )
    state = assembled(system, 50, jnp.float64)
    step = jax.jit(retract, static_argnums=0)
    for _ in range(60):
        state = step(system, state, jnp.asarray(0.3 * rng.normal(size=(system.columns, 50))))
    again = as_state(system, before, before, read(system, before, before, state))
    geometry, _ = loop_geometry(system, Joints(before, before, (jnp.zeros(()),) * 2))
    one, other = (closure(system, geometry, each).residual_norm for each in (state, again))
    np.testing.assert_allclose(one, other, rtol=1e-13)


def read(system, before, after, state):
    return joint_coordinates(
        system, before, after, state.x, {ball: matrix(turn) for ball, turn in enumerate(state.turns)}
    )


def nudge(rng, size):
    """A displacement by about that much."""
    axis = rng.normal(size=3)
    pose = np.eye(4)
    pose[:3, :3] = rotation(axis / np.linalg.norm(axis), size)
    pose[:3, 3] = size * rng.normal(size=3)
    return pose


@pytest.mark.long
def test_angles_are_the_inverse_of_from_angles():
    rng = np.random.default_rng(1)
    given = jnp.asarray(rng.uniform([[-3.1], [-1.5], [-3.1]], [[3.1], [1.5], [3.1]], size=(3, 200)))
    np.testing.assert_allclose(angles(matrices(given)), given, atol=1e-13)  # cos(phi) is at least 0.07


@pytest.mark.long
def test_angles_at_the_lock_give_the_same_rotation():
    off = np.array([0.0, 1e-16, 3e-15, 1e-12, -1e-9, 1e-7, -1e-4])
    given = jnp.stack([0.3 + off, np.sign(off - 1e-8) * np.pi / 2 + off, 0.5 - 7 * off])
    np.testing.assert_allclose(matrices(angles(matrices(given))), matrices(given), atol=2e-15)  # some roundings


def matrices(given):
    return matrix(from_angles(given))


@pytest.mark.long
def test_a_ball_turns_half_a_turn_about_any_axis():
    """retract never locks: many small turns about a generic axis add up to the turn about that axis."""
    system = LoopSystem((("T_theta_phi_psi",),), (((0, 1),),), (), LoopClass())
    axes = np.random.default_rng(2).normal(size=(3, 20))
    axes /= np.linalg.norm(axes, axis=0)
    state = assembled(system, 20, jnp.float64)
    for _ in range(40):
        state = retract(system, state, jnp.asarray(axes * np.pi / 40))
    expected = np.concatenate([np.zeros((1, 20)), axes])
    np.testing.assert_allclose(state.turns[0], expected, atol=1e-14)
    identity = multiply(state.turns[0], state.turns[0])
    np.testing.assert_allclose(identity[0], -1.0, atol=1e-14)


@pytest.mark.long
@pytest.mark.parametrize("size", [1, 2])
def test_the_geometry_of_a_batch_is_that_of_each_design(loop, size):
    """Of one design too, which a compiler got wrong while blocks were written into products of matrices."""
    system, before, after, pitch, _ = loop
    alone, length = loop_geometry(system, Joints(before, after, pitch))
    batch = jax.tree.map(lambda leaf: jnp.stack([leaf] * size), Joints(before, after, pitch))
    found, lengths = jax.jit(jax.vmap(lambda joints: module.loop_geometry(system, joints)))(batch)
    np.testing.assert_allclose(lengths, np.full(size, length), rtol=1e-14)
    for many, one in zip(jax.tree.leaves(found), jax.tree.leaves(alone), strict=True):
        np.testing.assert_allclose(many, np.broadcast_to(one, many.shape), atol=1e-14)
