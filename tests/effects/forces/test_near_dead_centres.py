"""Reactions where forces are large against those that they hold: dead centres, flat wedges, fine threads.

Tolerance: rounding times the ratio of the forces, at most 1e5 here, and what the closure of poses leaves, 1e-12, times
its square.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk

X, Y, Z = np.eye(3)
CRANK, ROD = 0.1, 0.3


def _stroke(angle):
    return CRANK * np.cos(angle) + np.sqrt(ROD**2 - (CRANK * np.sin(angle)) ** 2)


def _slope(angle):
    return -CRANK * np.sin(angle) * (1 + CRANK * np.cos(angle) / np.sqrt(ROD**2 - (CRANK * np.sin(angle)) ** 2))


def _slider_crank(assembled: float) -> jk.Mechanism:
    pin = CRANK * np.array([np.cos(assembled), np.sin(assembled), 0])
    joints = [
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
        jk.revolute("B", "crank", "rod", point=pin, axis=Z),
        jk.revolute("C", "rod", "piston", point=(_stroke(assembled), 0, 0), axis=Z),
        jk.prismatic("D", "ground", "piston", point=(_stroke(assembled), 0, 0), axis=X),
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints, unit="m")


@pytest.mark.long
def test_a_piston_near_its_dead_centre_holds_a_torque_of_the_crank():
    """F dx/dangle = -T; the rod is a two-force member, F / cos(rod) along it."""
    angles = np.array([0.3, 0.03, 3e-3, 1e-3, 3e-4, 1e-4])
    motion = _slider_crank(0.5).sweep({"D": _stroke(angles) - _stroke(0.5)})
    applied = jk.joint_load("A", 1.0)
    found, forces = jk.reactions(motion, applied=applied), jk.drive_forces(motion, applied=applied).forces["D.z"]
    expected = -1.0 / _slope(angles)
    # virtual work squares the condition, which is 1e4 in the last pose
    np.testing.assert_allclose(found.drives["D.z"], forces, rtol=1e-9)
    np.testing.assert_allclose(found.drives["D.z"], expected, rtol=1e-7)
    cosine = np.sqrt(1 - (CRANK * np.sin(angles) / ROD) ** 2)
    np.testing.assert_allclose(np.linalg.norm(found.forces["B"], axis=1), expected / cosine, rtol=1e-7)
    assert "no drive" not in str(found)


@pytest.mark.long
@pytest.mark.parametrize("slope", [1e-1, 1e-3, 1e-4])
def test_a_flat_wedge_is_held_by_its_follower(slope):
    joints = [
        jk.prismatic("P", "ground", "wedge", point=(0, 0, 0), axis=X),
        jk.prismatic("W", "wedge", "follower", point=(0.1, 0.2, 0), axis=X + slope * Y),
        jk.prismatic("F", "ground", "follower", point=(0.3, 0.4, 0), axis=Y),
    ]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints, unit="m")
    found = jk.reactions(mechanism.sweep({"F": np.array([0.0, 1e-2 * slope])}), applied=jk.joint_load("P", 1.0))
    np.testing.assert_allclose(found.drives["F.z"], 1.0 / slope, rtol=1e-11)


def _spindle(height: float, lead: float) -> jk.Mechanism:
    """A nut on a slide, whose thread of `lead` a radian turns a spindle in its bearing at some height."""
    joints = [
        jk.prismatic("P", "ground", "nut", point=(0, 0, 0), axis=Z),
        jk.screw("S", "nut", "spindle", point=(0, 0, 0), axis=Z, pitch=2 * np.pi * lead),
        jk.revolute("R", "ground", "spindle", point=(0, 0, height), axis=Z),
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints, unit="m")


@pytest.mark.long
@pytest.mark.parametrize("height", [0.0, 1.0, 10.0])
def test_a_nut_holds_a_torque_of_its_spindle(height):
    lead = 1e-3
    motion = _spindle(height, lead).sweep({"P": np.array([0.0, lead])})
    found = jk.reactions(motion, applied=jk.joint_load("R", -0.1))
    np.testing.assert_allclose(found.drives["P.z"], -0.1 / lead, rtol=1e-11)
    assert "no drive" not in str(found)


@pytest.mark.long
@pytest.mark.parametrize("mu", [1e-3, 0.05, 0.2])
def test_a_spindle_drives_a_nut_against_the_friction_of_its_thread(mu):
    """F = T / (r tan(lead angle + angle of friction)), and what the slide gives up."""
    lead, radius, torque, speed = 1e-3, 0.01, 0.1, 1.0
    motion = _spindle(0.0, lead).sweep({"P": np.array([0.0, lead])})
    applied = [jk.joint_friction("S", mu, radius=radius), jk.joint_load("R", -torque)]
    given = dict(applied=applied, rates={"P": lead * speed})
    force = torque / (radius * np.tan(np.arctan(lead / radius) + np.arctan(mu)))
    forces, found = jk.drive_forces(motion, **given), jk.reactions(motion, **given)
    np.testing.assert_allclose(forces.forces["P.z"], -force, rtol=1e-9)
    np.testing.assert_allclose(found.drives["P.z"], -force, rtol=1e-9)
    np.testing.assert_allclose(forces.friction.losses["S"], (torque - force * lead) * speed, rtol=1e-9)


@pytest.mark.long
def test_derivatives_near_a_dead_centre_and_of_what_holds_an_idle_freedom():
    """Against central differences, whose error is the square of their steps, 1e-5 of the angle."""
    mechanism = _slider_crank(0.5)

    def pull(angle):
        return jk.reactions(mechanism.sweep({"D": angle[None]}), applied=jk.joint_load("A", 1.0)).forces["B"][0, 0]

    at, step = _stroke(0.01) - _stroke(0.5), 1e-9
    # values as the derivatives have them: without any there would be programs of their own
    below, here, above = (jax.vjp(pull, jnp.array(at + sign * step)) for sign in (-1, 0, 1))
    np.testing.assert_allclose(here[1](1.0)[0], (above[0] - below[0]) / (2 * step), rtol=1e-4)

    # a rod between two balls spins freely, which its weight beside their line would do
    joints = [
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
        jk.spherical("B", "crank", "rod", point=(0.1, 0, 0)),
        jk.spherical("C", "rod", "rocker", point=(0.3, 0.3, 0.2)),
        jk.revolute("D", "ground", "rocker", point=(0.4, 0, 0), axis=X + Y),
    ]
    rods = jk.Mechanism.build(fixed=["ground"], joints=joints, unit="m")
    masses = jk.masses(rods, given={"crank": 0, "rocker": 0, "rod": jk.Mass(1.0, (0.3, 0.1, 0.3))})

    def held(angle):
        found = jk.reactions(rods.sweep({"A": angle[None]}), masses)
        return jnp.stack([found.held["B"][0, 0], found.held["C"][0, 1], found.forces["D"][0, 2]])

    below, here, above = (jax.vjp(held, jnp.array(0.1 + sign * 1e-5)) for sign in (-1, 0, 1))
    expected = (above[0] - below[0]) / 2e-5
    assert float(jnp.min(jnp.abs(expected))) > 1e-3
    np.testing.assert_allclose(jax.vmap(here[1])(jnp.eye(3))[0], expected, rtol=1e-6)
