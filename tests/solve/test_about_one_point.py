"""Loops that turn about one point (the spherical subgroup): three equations that say what six say."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.system.state import State
from reference.mechanisms import bennett_linkage, cardan_shafts, planar_fourbar, rssr_linkage, spherical_linkage
from reference.rounding import spherical_wrist
from reference.systems import loop_system


def systems(mechanism, driven):
    """The same loops with three equations about their point, and with all six."""
    for changed in ({}, {"spherical": ()}):
        system, joints = loop_system(mechanism, [(name, 0) for name in driven], **changed)
        yield system, jax.jit(loop_geometry, static_argnums=0)(system, joints)[0]


@pytest.mark.long
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
    np.testing.assert_allclose(one.residual_norm, other.residual_norm, atol=1e-14)
    np.testing.assert_allclose(one.merit, other.merit, atol=1e-14)


@pytest.mark.long
def test_the_angles_of_a_spherical_wrist():
    """Three motors turn a platform about a point: each chain keeps the angle between its middle axis, which turns with
    the motor, and its last axis, which turns with the platform."""
    mechanism = spherical_wrist()
    t = np.linspace(0.0, 1.0, 9)
    motors = {f"a{k}": 0.3 * np.sin(2.0 * t + k) - 0.3 * np.sin(k) for k in range(3)}
    motion = mechanism.sweep(motors)
    assert np.all(motion.closed)
    platform = np.asarray(motion.transforms["platform"])
    np.testing.assert_allclose(platform[:, :3, 3], 0.0, atol=1e-14)  # lengths are of the order of a tenth
    for k, angles in enumerate(motors.values()):
        motor, middle, last = (mechanism.joints[f"{name}{k}"].frames_1[0][:3, 2] for name in "abc")
        turned = Rotation.from_rotvec(angles[:, None] * motor).apply(middle)
        # residuals of 1e-15, and sums of a few products of numbers of order one
        np.testing.assert_allclose(
            np.einsum("pi,pij,j->p", turned, platform[:, :3, :3], last), middle @ last, atol=1e-13
        )


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
    shifted = np.array(first.frames_2)
    shifted[..., :3, 3] += 1e-3 * shifted[..., :3, 2]
    moved = mechanism.linkage.with_joints([replace(first, frames_2=shifted), *others])
    assert moved.classes[0].spherical == ()


def test_an_axis_that_misses_the_point_is_told():
    directions = ((0, 0, 1), (0, 0.5, 1), (0.5, 0.5, 1), (0.5, 0, 1))
    bodies = ("ground", "crank", "coupler", "rocker")

    def linkage(miss):
        places = ((0, 0, 0), (0, 0, 0), (0, 0, 0), (miss, 0, 0))
        return Mechanism.build(
            fixed=["ground"],
            joints=[
                revolute(name, one, other, point=place, axis=axis)
                for name, one, other, place, axis in zip(
                    "ABCD", bodies, (*bodies[1:], bodies[0]), places, directions, strict=True
                )
            ],
            align=0,
        )

    assert linkage(0.0).linkage.classes[0].spherical == (0,)
    assert linkage(1e-3).linkage.classes[0].spherical == ()


def test_slides_alone_turn_about_no_point():
    slides = [jk.prismatic(name, "base", "table", axis=(1, 0, 0)) for name in "AB"]
    assert jk.Mechanism.build(fixed=["base"], joints=slides).linkage.classes[0].spherical == ()
