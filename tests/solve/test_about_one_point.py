"""Loops that turn about one point (the spherical subgroup): three equations that say what six say."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.system.from_linkage import block_joints, block_system
from jaxkin.solve.system.state import State
from reference import spatial
from reference.hard_case import off_turns
from reference.mechanisms import bennett_linkage, cardan_shafts, planar_fourbar, rssr_linkage, spherical_linkage
from reference.rounding import spherical_wrist


def systems(mechanism, driven):
    """The same loops with three equations about their point, and with all six."""
    (block,), (loop_class,) = mechanism.structure.blocks, mechanism.linkage.classes
    names = [mechanism.all_joints[joint].name for joint in block.joints]
    places = tuple((block.joints[names.index(name)], 0) for name in driven)
    joints = jax.tree.map(jnp.asarray, block_joints(mechanism.all_joints, block))
    for chosen in (loop_class, loop_class._replace(spherical=())):
        system, _ = block_system(mechanism.linkage, block, places, chosen)
        yield system, loop_geometry(system, *joints)[0]


@pytest.mark.parametrize(("make", "driven"), [(spherical_linkage, ["A"]), (cardan_shafts, ["in"])])
def test_the_same_least_squares_problem(make, driven):
    """Anywhere, closed or not: the same normal equations, and the same residual of Eq. 12 over all twelve."""
    (few, few_geometry), (all_, all_geometry) = systems(make(), driven)
    assert (few.equations, all_.equations) == (3, 6)
    x = np.random.default_rng(1).uniform(-1.5, 1.5, (few.columns, 20))
    state = State(jnp.asarray(x), jnp.zeros((0, 4, 20)))
    compiled = jax.jit(closure, static_argnums=0)
    one, other = compiled(few, few_geometry, state), compiled(all_, all_geometry, state)
    normal = [np.einsum("eip,ejp->ijp", each.jacobian, each.jacobian) for each in (one, other)]
    gradients = [np.einsum("ecp,ep->cp", each.jacobian, each.residual) for each in (one, other)]
    # sums of some thirty products of numbers of order one
    np.testing.assert_allclose(*normal, atol=1e-13)
    np.testing.assert_allclose(*gradients, atol=1e-13)
    np.testing.assert_allclose(one.gap, other.gap, atol=1e-14)
    np.testing.assert_allclose(one.merit, other.merit, atol=1e-14)


def test_a_spherical_four_bar_turns_as_its_closed_form():
    theta = np.linspace(0.0, 2 * np.pi, 73)
    motion = spherical_linkage(0.4).sweep({"A": theta})
    expected = spatial.spherical_fourbar(0.4 + theta).rocker - spatial.spherical_fourbar(np.array([0.4])).rocker
    assert np.all(motion.closed)
    # residuals of 1e-15 over singular values of some 0.1
    assert np.max(np.abs(off_turns(np.asarray(motion.coordinates["D"])[:, 0] - expected))) < 1e-13


def test_which_loops_turn_about_one_point():
    for mechanism in (spherical_linkage(), cardan_shafts(), spherical_wrist()):
        (loop_class,) = mechanism.linkage.classes
        assert loop_class.spherical == tuple(range(len(mechanism.structure.loops)))
    for mechanism in (planar_fourbar(), rssr_linkage(), bennett_linkage()):
        assert mechanism.linkage.classes[0].spherical == ()


def test_a_joint_moved_along_its_axis_on_one_part_is_not_of_the_class():
    """All axes still meet in one point of the assembled pose, but that of the crank is another one once it turns."""
    mechanism = spherical_linkage()
    first, *others = mechanism.all_joints
    shifted = np.array(first.after)
    shifted[..., :3, 3] += 1e-3 * shifted[..., :3, 2]
    moved = mechanism.linkage.with_joints([replace(first, after=shifted), *others])
    assert moved.classes[0].spherical == ()


def test_an_axis_that_misses_the_point_is_told():
    directions = ((0, 0, 1), (0, 0.5, 1), (0.5, 0.5, 1), (0.5, 0, 1))
    bodies = ("ground", "crank", "coupler", "rocker", "ground")

    def linkage(miss):
        places = ((0, 0, 0), (0, 0, 0), (0, 0, 0), (miss, 0, 0))
        return Mechanism.build(
            fixed=["ground"],
            joints=[
                revolute(name, *pair, point=place, axis=axis)
                for name, *pair, place, axis in zip("ABCD", bodies, bodies[1:], places, directions, strict=True)
            ],
            align=0,
        )

    assert linkage(0.0).linkage.classes[0].spherical == (0,)
    assert linkage(1e-3).linkage.classes[0].spherical == ()
