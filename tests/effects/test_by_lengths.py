"""Derivatives of effects by a length, against differences of the effects of mechanisms of that length.

Tolerance: a central difference of 1e-4 of the length errs by some 1e-8 of the third derivative, and by the rounding of
1e-14 over 1e-4; of jerks, whose third derivatives are the largest, by less than 1e-6.
"""

import jax
import numpy as np
import pytest

import jaxkin as jk
from reference.energies import fourbar

STEPS = np.linspace(0.5, 1.4, 7)  # where the coupler turns
COUPLER = ("coupler", "B", "C")
SPEED, CHANGE, BEND = {"A": 2.0}, {"A": 0.7}, {"A": -0.4}
EFFECTS = {
    "velocities": lambda motion, masses: jk.velocities(motion, SPEED).coordinates["D"],
    "velocities of a part": lambda motion, masses: jk.velocities(motion, SPEED).transforms["coupler"],
    "accelerations": lambda motion, masses: jk.accelerations(motion, SPEED, CHANGE).coordinates["D"],
    "jerks": lambda motion, masses: jk.jerks(motion, SPEED, CHANGE, BEND).coordinates["D"],
    "transmission ratio": lambda motion, masses: jk.transmission(motion, "D").ratio,
    "mechanical advantage": lambda motion, masses: jk.transmission(motion, "D").advantage,
    "transmission angle": lambda motion, masses: jk.transmission(motion, "D").angle,
    "screw axes": lambda motion, masses: jk.screw_axes(jk.velocities(motion, SPEED), "coupler").point,
    "torque at rest": lambda motion, masses: jk.drive_forces(motion, masses, gravity=(0, -9.81, 0)).forces["A.phi"],
    "torque in motion": lambda motion, masses: jk.drive_forces(motion, masses, rates=SPEED).forces["A.phi"],
    "reactions": lambda motion, masses: jk.reactions(motion, masses, rates=SPEED, accelerations=CHANGE).forces["B"],
    "points": lambda motion, masses: motion.points("coupler", (1.0, 2.0, 0.0)),
    "singular value": lambda motion, masses: motion.sigma_min,
}


@pytest.mark.long
@pytest.mark.parametrize("effect", EFFECTS)
def test_a_derivative_by_a_length_is_a_difference(effect):
    mechanism = fourbar()
    given = {"crank": 0, "coupler": jk.Mass(1.5, centre=(1.0, 2.0, 0.0), inertia=1e-3), "rocker": 0}
    masses = jk.masses(mechanism, given=given)

    def found(length):
        return EFFECTS[effect](mechanism.with_lengths({COUPLER: length}).sweep({"A": STEPS}), masses)

    length = float(mechanism.lengths[COUPLER])
    value, slope = jax.jvp(found, (length,), (1.0,))
    step = 1e-4 * length
    difference = (np.asarray(found(length + step)) - np.asarray(found(length - step))) / (2 * step)
    assert np.isfinite(np.asarray(value)).all() and np.abs(difference).max() > 0
    scale = np.abs(difference).max()
    np.testing.assert_allclose(slope, difference, rtol=1e-6, atol=1e-6 * scale)
