"""Loops that turn about one direction (the subgroup of Schoenflies): four equations that say what six say."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.joints.pairs import cylindrical, revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.system.state import State
from reference.mechanisms import planar_fourbar, rssr_linkage, spherical_linkage
from reference.systems import loop_system


def air_cylinder():
    """Fig. 7 of the paper: five loops, of which only that through cylinder and linkage turns about two directions."""
    return jk.load(path("air_cylinder")).mechanism(fixed=("p4",))


def lifted():
    """A four-bar that is driven along its normal as well, so that its plane is no subgroup for it."""
    return planar_fourbar(1.0, cylindrical)


def systems(mechanism, driven):
    """The same loops in space with one equation of rotation where that is enough, and with three."""
    for changed in ({}, {"schoenflies": ()}):
        system, joints = loop_system(mechanism, driven, decoupled_plane=None, **changed)
        yield system, jax.jit(loop_geometry, static_argnums=0)(system, joints)[0]


@pytest.mark.parametrize(
    ("make", "driven", "equations"),
    [
        pytest.param(air_cylinder, [("p2-p10", 0)], (4 * 4 + 6, 5 * 6), marks=pytest.mark.long),
        (lifted, [("A", 1), ("B", 0)], (4, 6)),
    ],
)
def test_the_same_least_squares_problem(make, driven, equations):
    """Anywhere, closed or not: the rest of the six equations vanishes, with its derivatives."""
    (few, few_geometry), (all_, all_geometry) = systems(make(), driven)
    assert (few.equations, all_.equations) == equations
    x = np.random.default_rng(1).uniform(-0.5, 0.5, (few.columns, 20))
    state = State(jnp.asarray(x), jnp.zeros((0, 4, 20)))
    compiled = jax.jit(closure, static_argnums=0)
    one, other = compiled(few, few_geometry, state), compiled(all_, all_geometry, state)
    product = partial(np.einsum, "eip,ejp->ijp")
    # sums of some thirty products of numbers of order one
    np.testing.assert_allclose(product(one.jacobian, one.jacobian), product(other.jacobian, other.jacobian), atol=1e-13)
    gradients = [np.einsum("ecp,ep->cp", each.jacobian, each.residual) for each in (one, other)]
    np.testing.assert_allclose(*gradients, atol=1e-13)
    np.testing.assert_allclose(np.sum(one.residual**2, axis=0), np.sum(other.residual**2, axis=0), atol=1e-13)
    np.testing.assert_array_equal(one.residual_norm, other.residual_norm)


@pytest.mark.long
def test_a_four_bar_is_lifted_while_it_turns():
    turn, lift = np.linspace(0.0, 6.0, 9), np.linspace(0.0, 30.0, 9)
    motion = lifted().sweep({"A.phi": turn, "B.z": lift})
    plain = planar_fourbar(1.0).sweep({"A": turn})
    assert np.all(motion.closed) and np.all(plain.closed)
    # residuals of 1e-15 over singular values of some 0.1; lengths of up to 30 lose a digit more
    for joint in "BCD":
        np.testing.assert_allclose(motion.coordinates[joint][:, 1], plain.coordinates[joint][:, 0], atol=1e-12)
    # z_A + z_B + z_C = z_D, and of all that do the least: a third each
    for joint, share in (("A", -1 / 3), ("C", -1 / 3), ("D", 1 / 3)):
        np.testing.assert_allclose(motion.coordinates[joint][:, 0], share * lift, atol=1e-11)


def test_other_loops_keep_all_their_equations():
    assert rssr_linkage().linkage.classes[0].schoenflies == spherical_linkage().linkage.classes[0].schoenflies == ()
    pins = [
        revolute("A", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1)),
        revolute("B", "crank", "rod", point=(1, 0, 0), axis=(0, 1e-6, 1)),
        revolute("C", "rod", "ground", point=(2, 1, 0), axis=(0, 0, 1)),
    ]
    assert Mechanism.build(fixed=["ground"], joints=pins).linkage.classes[0].schoenflies == ()
