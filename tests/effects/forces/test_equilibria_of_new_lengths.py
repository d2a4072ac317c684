"""Equilibria of a mechanism with new lengths, so that the pose that was drawn is open; and their derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import Z, planar_fourbar

CRANK = ("crank", "A", "B")
RANGE = np.linspace(0.0, 6.0, 25)
GRAVITY = 9.81
PEN = (60.0, 60.0, 0.0)
WEIGHT = jk.force("coupler", PEN, (0.0, -GRAVITY, 0.0))


@pytest.mark.long
def test_the_potential_is_extreme_there():
    """They were refused, by an error about the mobility. The central difference of the height of what weighs errs by
    the square of its step, 1e-5, times the size."""
    found = jk.equilibrium(planar_fourbar().with_lengths({CRANK: 35.0}), {"A": RANGE}, applied=WEIGHT)
    assert len(found.values) == 2 and found.stable.sum() == 1 and not found.out_of_balance

    def height(turns):
        return np.asarray(found.motion.mechanism.sweep({"A": turns}).points("coupler", PEN))[:, 1]

    slope = (height(found.values + 1e-5) - height(found.values - 1e-5)) / 2e-5
    np.testing.assert_allclose(slope, 0.0, atol=1e-7)
    assert np.argmin(height(found.values)) == np.argmax(found.stable)


@pytest.mark.long
def test_a_freedom_without_a_drive_is_told_with_new_lengths_too():
    """A bob on the coupler, which hangs as it was drawn only."""
    joints = [*planar_fourbar().joints.values(), jk.revolute("E", "coupler", "bob", point=PEN, axis=Z)]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    load = jk.force("bob", (90.0, 60.0, 0.0), (0.0, -GRAVITY, 0.0))
    for each in (mechanism, mechanism.with_lengths({CRANK: 35.0})):
        assert set(jk.equilibrium(each, {"A": RANGE}, applied=load).out_of_balance) == {"E.phi"}


@pytest.mark.long
def test_one_step_of_newton_has_the_derivatives_of_an_equilibrium():
    """As the page of forces says: against differences of the equilibria themselves, which are right to 1e-12 of the
    range; the step of 1e-3 leaves 1e-9 of that, and its square."""

    def changed(numbers):
        return planar_fourbar().with_lengths({CRANK: numbers[0]}), jk.joint_spring("D", stiffness=numbers[1], rest=0.1)

    def found(numbers):
        mechanism, spring = changed(numbers)
        return jk.equilibrium(mechanism, {"A": RANGE}, applied=[WEIGHT, spring]).values

    numbers = jnp.array([40.0, 0.5])
    known = jnp.asarray(found(numbers))

    def stands(numbers):
        mechanism, spring = changed(numbers)

        def force(angles):
            motion = mechanism.sweep({"A": angles})
            return jk.drive_forces(motion, applied=[WEIGHT, spring]).forces["A.phi"]

        value, slope = jax.jvp(force, (known,), (jnp.ones_like(known),))
        step = known - value / slope
        return step, step

    derivatives, values = jax.jacfwd(stands, has_aux=True)(numbers)
    np.testing.assert_allclose(values, known, atol=1e-11)
    steps = 1e-3 * np.eye(2)
    differences = np.stack([(found(numbers + step) - found(numbers - step)) / 2e-3 for step in steps], axis=-1)
    np.testing.assert_allclose(derivatives, differences, rtol=1e-5, atol=1e-8)
