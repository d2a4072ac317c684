"""Planar loops in three equations: the same motion as in six, and no motion that leaves the plane."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.geometry.pose import rotation, unit
from jaxkin.joints.pairs import prismatic, revolute
from jaxkin.linkage.loop_class import LoopClass
from jaxkin.linkage.planes import plane_columns
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.closure.planar import MIN_UNROLLED_SUM_POSES
from jaxkin.solve.status import Status
from jaxkin.solve.system.from_linkage import group_joints, group_system
from jaxkin.solve.system.state import State
from reference.catalogue import jansen, oldham, scotch_yoke
from reference.mechanisms import planar_fourbar, rssr_linkage, slider_crank, spherical_linkage

PLANAR = [planar_fourbar, slider_crank, jansen, oldham, scotch_yoke]


def both(mechanism):
    """The same loops as planar ones and as loops in space, with their geometries."""
    (loop_group,), (loop_class,) = mechanism.structure.loop_groups, mechanism.linkage.classes
    for chosen in (loop_class, LoopClass()):
        system, _ = group_system(mechanism.linkage, loop_group, ((loop_group.joints[0], 0),), chosen)
        yield (
            system,
            loop_geometry(
                system, jax.tree.map(jnp.asarray, group_joints(mechanism.linkage, mechanism.all_joints, loop_group))
            )[0],
        )


@pytest.mark.long
@pytest.mark.parametrize("make", PLANAR, ids=lambda make: make.__name__)
def test_the_same_gap_merit_and_row_space_as_in_space(make):
    """Anywhere, closed or not: the three equations are those of the six that do not vanish."""
    (flat, flat_geometry), (space, space_geometry) = both(make())
    x = np.random.default_rng(1).uniform(-0.5, 0.5, (flat.columns, 20))
    state = State(jnp.asarray(x), jnp.zeros((0, 4, 20)))
    compiled = jax.jit(closure, static_argnums=0)  # much faster than one operation after the other
    one, other = compiled(flat, flat_geometry, state), compiled(space, space_geometry, state)
    # sums of some ten products of numbers of order one
    np.testing.assert_allclose(one.residual_norm, other.residual_norm, atol=1e-13)
    np.testing.assert_allclose(one.merit, other.merit, atol=1e-13)
    np.testing.assert_allclose(np.sum(one.residual**2, axis=0), np.sum(other.residual**2, axis=0), atol=1e-13)


@pytest.mark.long
@pytest.mark.parametrize("make", PLANAR, ids=lambda make: make.__name__)
def test_the_jacobian_is_the_derivative_of_the_residual_where_the_loops_close(make):
    (system, geometry), _ = both(make())
    directions = np.random.default_rng(2).normal(size=(3, system.columns, 1))
    rest = State(jnp.zeros((system.columns, 1)), jnp.zeros((0, 4, 1)))
    for direction in directions:
        _, found = jax.jvp(
            lambda x: closure(system, geometry, State(x, rest.turns)).residual, (rest.x,), (jnp.asarray(direction),)
        )
        expected = np.einsum("ecp,cp->ep", closure(system, geometry, rest).jacobian, direction)
        np.testing.assert_allclose(found, expected, atol=1e-13)


@pytest.mark.long
@pytest.mark.parametrize("make", [planar_fourbar, slider_crank, oldham], ids=lambda make: make.__name__)
def test_many_poses_have_the_jacobian_of_few(make):
    """Written out link by link for many poses at once, as a product of matrices for few."""
    (system, geometry), _ = both(make())
    x = jnp.asarray(np.random.default_rng(3).uniform(-2, 2, (system.columns, MIN_UNROLLED_SUM_POSES)))

    def jacobian(x):
        return closure(system, geometry, State(x, jnp.zeros((0, 4, x.shape[1])))).jacobian

    # sums of some ten products of numbers of order one
    np.testing.assert_allclose(jacobian(x)[..., :5], jacobian(x[:, :5]), atol=1e-14)


def test_which_structures_are_planar():
    assert all(make().linkage.classes[0].plane is not None for make in PLANAR)
    assert spherical_linkage().linkage.classes[0].plane is None and rssr_linkage().linkage.classes[0].plane is None


def test_a_tilted_hinge_makes_a_loop_spatial():
    joints = list(planar_fourbar().all_joints)
    assert plane_columns(joints) == (0, 1, 2, 3)
    tilt = np.eye(4)
    tilt[:3, :3] = rotation(np.array([1.0, 0.0, 0.0]), 1e-9)
    joints[2] = replace(joints[2], frames_1=joints[2].frames_1 @ tilt, frames_2=joints[2].frames_2 @ tilt)
    assert plane_columns(joints) is None


def test_a_slide_across_the_plane_makes_a_loop_spatial():
    hinges = [revolute(name, "a", "b", point=(x, 0, 0), axis=(0, 0, 1)) for name, x in (("A", 0.0), ("B", 10.0))]
    assert plane_columns([*hinges, prismatic("S", "a", "b", axis=(1, 2, 0))]) == (0, 1, 2)
    assert plane_columns([*hinges, prismatic("S", "a", "b", axis=(0, 0, 1))]) == (0, 1)  # idle, along the normal
    assert plane_columns([*hinges, prismatic("S", "a", "b", axis=(1, 0, 1))]) is None


@pytest.mark.long
def test_a_hinge_tilted_inside_jit_is_not_taken_for_planar():
    """The structure is known to be planar before the numbers are: what then leaves the plane must not close."""
    mechanism, turn = planar_fourbar(1.0), jnp.linspace(0.0, 1.0, 10)

    @jax.jit
    def status(angle):
        cos, sin = jnp.cos(angle), jnp.sin(angle)
        tilt = jnp.eye(4).at[1:3, 1:3].set(jnp.array([[cos, -sin], [sin, cos]]))
        moved = mechanism.with_frames({("coupler", "C"): mechanism.joints["C"].frames_1[0] @ tilt})
        return moved.sweep({"A": turn}).status

    assert np.all(np.asarray(status(0.0)) == Status.CLOSED)
    assert not np.any(np.asarray(status(0.01)) == Status.CLOSED)


def test_placed_anywhere_the_plane_is_found_and_the_motion_is_the_same():
    turn = np.linspace(0.0, 2 * np.pi, 50)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation(unit(np.array([1.0, 2.0, -0.5])), 1.1), (300.0, -20.0, 70.0)
    mechanism = planar_fourbar(1.0)
    joints = [
        replace(joint, frames_1=pose @ joint.frames_1, frames_2=pose @ joint.frames_2) for joint in mechanism.all_joints
    ]
    placed = Mechanism.build(joints=joints, fixed=["ground"])
    assert placed.linkage.classes == mechanism.linkage.classes
    expected = mechanism.sweep({"A": turn}).coordinates["D"]
    np.testing.assert_allclose(placed.sweep({"A": turn}).coordinates["D"], expected, atol=1e-13)
