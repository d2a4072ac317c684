"""Weights at rest by their potential energy: the same as forces on the centres of the parts, which are another route.

Tolerance: rounding over the least singular value of the loops, 1e-10 of the largest force.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference import catalogue, mechanisms
from reference.mechanisms import Z, flat

GRAVITY = (1.3, -9.0, 2.5)
"""Along no axis, so that no mechanism is in balance by symmetry."""


def turned_round() -> jk.Mechanism:
    """A four-bar whose joints are given from part 2 to part 1, far from the origin: the tree passes them backwards."""
    at = np.array([3e5, -2e5, 1e5])
    points = {"A": (0, 0, 0), "B": (40, 10, 0), "C": (110, 70, 0), "D": (100, 0, 0)}
    parts = {"A": ("crank", "ground"), "B": ("coupler", "crank"), "C": ("rocker", "coupler"), "D": ("rocker", "ground")}
    joints = [jk.revolute(name, *parts[name], point=tuple(at + point), axis=Z) for name, point in points.items()]
    return jk.Mechanism.build(fixed=["ground"], unit="mm", joints=joints)


def jack() -> jk.Mechanism:
    """A screw that is passed backwards, with an arm on it."""
    joints = [
        jk.screw("S", "nut", "base", point=(3, 0, 0), axis=(0, 1, 1), pitch=4.0),
        jk.cylindrical("P", "nut", "arm", point=(30, 5, 0), axis=(1, 0, 2)),
    ]
    return jk.Mechanism.build(fixed=["base"], joints=joints)


CASES = {
    "four-bar, backwards": (turned_round, {"A": np.linspace(0.0, 0.6, 5)}),
    "jack": (jack, {"S": np.linspace(0.0, 5.0, 5), "P.z": np.linspace(0, 9, 5), "P.phi": np.linspace(1, 3, 5)}),
    "RSSR": (mechanisms.rssr_linkage, {"A": np.linspace(0.0, 1.0, 5)}),
    "cam": (mechanisms.cam, {"shaft": np.linspace(0.0, 2.0, 5)}),
    "two drives": (catalogue.fivebar, {"A": np.linspace(0.0, -0.1, 5), "E": np.linspace(0.0, 0.1, 5)}),
}


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_weights_are_forces_on_centres(name):
    make, drive = CASES[name]
    mechanism = make()
    motion = mechanism.sweep(drive).check()
    numbers = np.random.default_rng(5)
    origin = np.mean([np.asarray(joint.frames_1)[0, :3, 3] for joint in mechanism.all_joints], axis=0)
    moving = [part for part in mechanism.parts if part not in mechanism.fixed]
    given = {part: jk.Mass(numbers.uniform(1, 3), tuple(origin + numbers.normal(0, 20, 3))) for part in moving}
    found = jk.drive_forces(motion, jk.masses(mechanism, given=given), gravity=GRAVITY)
    weights = [jk.force(part, own.centre, own.mass * np.array(GRAVITY)) for part, own in given.items()]
    wanted = jk.drive_forces(motion, applied=weights)
    for key, forces in wanted.forces.items():
        scale = float(np.abs(forces).max())
        assert scale > 0
        np.testing.assert_allclose(found.forces[key], forces, rtol=0, atol=1e-10 * scale)
        assert np.all(found.powers[key] == 0)


@pytest.mark.long
def test_weights_and_forces_add_up_and_have_gradients():
    """By the angle, which moves the parts, and by a mass: against differences and against linearity."""
    mechanism = mechanisms.planar_fourbar(1.0)
    angles = np.linspace(0.2, 2.0, 4)
    push = jk.force("coupler", flat((30.0, 30.0)), (3.0, 4.0, 0.0))

    def torque(angles, mass, applied=()):
        own = jk.masses(mechanism, given={"coupler": jk.Mass(mass, (50.0, 40.0, 0.0)), "rocker": 0, "crank": 0})
        return jk.drive_forces(mechanism.sweep({"A": angles}), own, gravity=GRAVITY, applied=applied).forces["A.phi"]

    alone = jk.drive_forces(mechanism.sweep({"A": angles}), applied=push).forces["A.phi"]
    np.testing.assert_allclose(torque(angles, 2.0, push), torque(angles, 2.0) + alone, rtol=1e-12)
    by_mass = jax.jacfwd(lambda mass: torque(angles, mass))(2.0)
    np.testing.assert_allclose(2.0 * by_mass, torque(angles, 2.0), rtol=1e-12)
    step = 1e-5
    slope = jax.grad(lambda angles: jnp.sum(torque(angles, 2.0)))(jnp.asarray(angles))
    rise = (torque(angles + step, 2.0) - torque(angles - step, 2.0)) / (2 * step)
    np.testing.assert_allclose(slope, rise, rtol=1e-7)  # of central differences
