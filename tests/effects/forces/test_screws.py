"""Twists of joints against those that the host finds for loops, and the virtual work of a screw; to rounding."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.forces.joint_screws import carried, chains
from jaxkin.effects.forces.places import places, twists_of_parts
from jaxkin.effects.forces.screws import Scale
from jaxkin.geometry.movements import MOVEMENTS, is_length
from jaxkin.geometry.pose import frame
from jaxkin.joints.joint import joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.screws import chain
from jaxkin.linkage.joint_motion import moving_parts
from reference.mechanisms import Z, cardan_shafts, planar_fourbar, rssr_linkage

SIZE, MIDDLE = 40.0, np.array([3.0, -20.0, 11.0])


STRAIGHT = [name for name, row in MOVEMENTS.items() if not any(each.law for each in row.elements)]
"""Movements that need no curve."""


@pytest.mark.long
@pytest.mark.parametrize("movements", [*((name,) for name in STRAIGHT), ("T_z_phi", "T_theta_phi_psi")])
def test_unit_twists_are_those_of_the_chain(movements):
    numbers = np.random.default_rng(7)
    frames = [frame(30 * numbers.normal(size=3), numbers.normal(size=3)) for _ in movements]
    made = joint("j", ("one", "two"), JointKind.REVOLUTE, movements, frames, pitch=5.0)
    q = numbers.normal(size=made.freedoms)
    reached, expected = chain(movements, made.frames_1, q, 5.0)
    scale = Scale(jnp.asarray(SIZE), jnp.asarray(MIDDLE))
    (own,) = chains([made], [jnp.asarray(q)[None]], scale)
    (found,) = carried([made], [own], [jnp.eye(4)[:3, :, None]], scale)
    np.testing.assert_allclose(own.displacement[..., 0], reached[:3], atol=1e-12)
    np.testing.assert_allclose(found.point[:, 0], ((reached @ frames[-1])[:3, 3] - MIDDLE) / SIZE, atol=1e-12)
    velocity = (expected[3:] + np.cross(expected[:3], MIDDLE, axisa=0, axisc=0)) / SIZE
    units = np.array([SIZE if is_length(name) else 1.0 for name in made.coordinates])
    every = np.array(found.coordinates(made)).reshape(made.freedoms, 6).T
    np.testing.assert_allclose(every, np.concatenate([expected[:3], velocity]) * units, atol=1e-12)


def cams():
    """A roller and a flat face on profiles, one after the other, on an open chain."""
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    profile = np.stack([(20 + 3 * np.sin(2 * angle)) * np.cos(angle), 18 * np.sin(angle)], axis=1)
    roller = {"profile": profile, "follower": "roller", "radius": 2.0, "point2": (0.0, 20.0, 0.0)}
    flat = {"profile": profile, "follower": "flat", "point2": (0.0, 18.0, 0.0), "direction2": (1.0, 0.0, 0.0)}
    return jk.Mechanism.build(
        fixed=["base"],
        joints=[jk.cam("J", "base", "one", **roller), jk.cam("K", "one", "two", **flat)],
    )


@pytest.mark.long
@pytest.mark.parametrize("name", ["four-bar", "RSSR", "Cardan", "nut", "cams"])
def test_twists_of_parts_are_derivatives_of_their_places(name):
    """[w] R = R', and v + w x r = r' for the velocity at the middle; the same once more for the derivative of both."""
    mechanism = {
        "four-bar": planar_fourbar,
        "RSSR": rssr_linkage,
        "Cardan": cardan_shafts,
        "cams": cams,
        "nut": lambda: jk.Mechanism.build(
            fixed=["base"],
            joints=[
                jk.screw("S", "nut", "base", point=(1, 2, 3), axis=(1, 0, 1), pitch=4.0),
                jk.universal("U", "nut", "arm", point=(4, 0, 0), axis1=(1, 0, 0), axis2=(0, 1, 0)),
            ],
        ),
    }[name]()
    linkage, numbers = mechanism.linkage, np.random.default_rng(5)
    q, first, second = (
        tuple(jnp.asarray(numbers.normal(size=(1, each.freedoms))) for each in linkage.joints) for _ in range(3)
    )

    def motion(t):
        return tuple(a + t * b + 0.5 * t * t * c for a, b, c in zip(q, first, second, strict=True))

    at = places(linkage, q, chords=False)
    twists, changes = twists_of_parts(linkage, at, first, second)
    size, middle = at.scale
    for part, place in at.parts.items():
        np.testing.assert_allclose(place, moving_parts(linkage.structure, linkage.joints, q)[part], atol=1e-12)

        def moved(t, part=part):
            return moving_parts(linkage.structure, linkage.joints, motion(t))[part][..., 0]

        def twist(t, moved=moved):
            """From the matrix T' T^-1 of the twist about the origin."""
            here, change = moved(t), jax.jacfwd(moved)(t)
            spin = change[:, :3] @ here[:, :3].T
            w = jnp.array([spin[2, 1], spin[0, 2], spin[1, 0]])
            return jnp.concatenate([w, (change[:, 3] - spin @ here[:, 3] + jnp.cross(w, middle)) / size])

        np.testing.assert_allclose(twists[part][:, 0], twist(0.0), atol=1e-10)
        np.testing.assert_allclose(changes[part][:, 0], jax.jacfwd(twist)(0.0), atol=1e-9)


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
