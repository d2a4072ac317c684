"""Twists of joints against those that the host finds for loops, and the virtual work of a screw; to rounding."""

import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.forces.screws import joint_screws
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.geometry.pose import frame
from jaxkin.joints.joint import joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.screws import chain
from reference.mechanisms import Z

SIZE = 40.0


@pytest.mark.parametrize("movements", [*((name,) for name in MOVEMENTS), ("T_z_phi", "T_theta_phi_psi")])
def test_unit_twists_are_those_of_the_chain(movements):
    numbers = np.random.default_rng(7)
    frames = [frame(30 * numbers.normal(size=3), numbers.normal(size=3)) for _ in movements]
    made = joint("j", ("one", "two"), JointKind.REVOLUTE, movements, frames, pitch=5.0)
    q = numbers.normal(size=made.freedoms)
    reached, expected = chain(movements, made.frames_1, q, 5.0)
    driven = range(made.freedoms)
    place, found = joint_screws(made, jnp.asarray(q)[None], jnp.eye(4)[None], SIZE, driven)
    at = (reached @ frames[-1])[:3, 3]
    np.testing.assert_allclose(place[0], at, atol=1e-12)
    velocity = (expected[3:] + np.cross(expected[:3], at, axisa=0, axisc=0)) / SIZE
    scale = np.array([SIZE if is_length(name) else 1.0 for name in made.coordinates])
    np.testing.assert_allclose(found[0], np.concatenate([expected[:3], velocity]) * scale, atol=1e-12)


@pytest.mark.long
def test_a_jack_and_a_homokinetic_joint_pass_their_torque_on():
    jack = jk.Mechanism.build(
        fixed=["base"], unit="mm", joints=[jk.screw("S", "base", "nut", point=(0, 0, 0), axis=Z, pitch=4.0)]
    )
    found = jk.reactions(jack.sweep({"S": np.linspace(0, 3, 4)}), applied=jk.force("nut", (0, 0, 0), (0, 0, -500.0)))
    np.testing.assert_allclose(found.drives["S.phi"], 500 * 0.004 / (2 * np.pi), rtol=1e-9)
    other = np.array([np.sin(0.5), 0.0, np.cos(0.5)])
    shafts = jk.Mechanism.build(
        fixed=["ground"],
        unit="mm",
        joints=[
            jk.revolute("in", "ground", "shaft", point=(0, 0, -80.0), axis=Z),
            jk.constant_velocity("cv", "shaft", "output", point=(0, 0, 0), axis=Z, axis2=other),
            jk.revolute("out", "ground", "output", point=80 * other, axis=other),
        ],
    )
    motion = shafts.sweep({"in": np.linspace(0, 3, 7)})
    load = jk.torque("output", -2.0 * other)
    np.testing.assert_allclose(jk.drive_forces(motion, applied=load).forces["in.phi"], 2.0, rtol=1e-9)
    np.testing.assert_allclose(jk.reactions(motion, applied=load).drives["in.phi"], 2.0, rtol=1e-7)
