"""Numbers, drives and poses that leave a plane to which loops keep otherwise are those of the loops in space."""

from dataclasses import replace
from itertools import pairwise

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.geometry.pose import rotation, unit
from reference.cranes import IN_PLANE, STROKES, Z, crane, in_plane, in_space, rod_on_ball_and_cross


@pytest.mark.long
def test_a_drive_out_of_the_plane_is_solved_in_space():
    """The pin slides in both holes of the boom by what is asked for; the boom rests."""
    pin = jk.cylindrical("eye", "rod", "boom", point=(4, 0, 0), axis=Z)
    foot = jk.cylindrical("foot", "ground", "tube", point=(3, -4, 0), axis=Z)
    first, _, cylinder, _ = crane().all_joints
    mechanism = jk.Mechanism.build(joints=[first, foot, cylinder, pin], fixed=["ground"])
    assert in_plane(mechanism) == IN_PLANE
    slide = np.linspace(0, 1, 5)
    motion = mechanism.sweep({"eye.z": slide, "cylinder.z": np.zeros(5)})
    assert np.all(np.asarray(motion.closed))
    np.testing.assert_allclose(motion.coordinates["foot"][:, 0], -slide, atol=1e-12)
    np.testing.assert_allclose(motion.coordinates["boom"][:, 0], 0.0, atol=1e-12)


def test_poses_that_are_given_out_of_the_plane_are_projected_there():
    along = unit(np.array([1.0, 4.0, 0.0]))
    swivel = jk.revolute("swivel", "rod", "head", point=(4, 0, 0), axis=along)
    eye = jk.revolute("eye", "head", "boom", point=(4, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(joints=[*crane().all_joints[:3], swivel, eye], fixed=["ground"])
    found = jk.project(mechanism, {"cylinder": np.array([[0.0, 0.4]]), "swivel": np.array([-0.4])})
    assert float(found.distance[0]) < 1e-9  # the rod turned by 0.4 closes the loop
    np.testing.assert_allclose(found.motion.coordinates["cylinder"], [[0.0, 0.4]], atol=1e-9)


@pytest.mark.long
def test_lengths_that_jax_traces_may_leave_the_plane():
    """The eye is lifted along the hinge of the boom: the tube tilts on its cross, and the cylinder turns nothing."""
    mechanism = rod_on_ball_and_cross(height=1.0)
    assert in_plane(mechanism) is not None

    def swept(mechanism, lift):
        frame = jnp.asarray(mechanism.joints["eye"].frames_2[0]).at[2, 3].add(lift)
        return mechanism.with_frames({("boom", "eye"): frame}).sweep({"cylinder.z": STROKES})

    inside = jax.jit(lambda lift: swept(mechanism, lift).transforms["rod"])(0.2)
    motion = swept(mechanism, 0.2)
    assert np.all(np.asarray(motion.closed))
    np.testing.assert_allclose(inside, motion.transforms["rod"], atol=1e-11)
    # at the end of the rod, by differences of a step of 1e-5, whose square is the error
    height = jax.jit(jax.jacfwd(lambda lift: swept(mechanism, lift).points("rod", (4, 0, 1))))
    step = 1e-5
    one, other = (swept(mechanism, sign * step).points("rod", (4, 0, 1)) for sign in (1, -1))
    np.testing.assert_allclose(height(0.0), (np.asarray(one) - np.asarray(other)) / (2 * step), atol=1e-8)
    assert np.abs(np.asarray(height(0.0))[:, 2]).min() > 0.5


@pytest.mark.long
def test_rates_of_poses_out_of_the_plane_are_those_in_space():
    """A crank, and a coupler and a rocker on three balls, of which a point is pulled out of the plane."""
    points = {"B": (1, 0, 0), "C": (3, 2, 0), "D": (4, 0, 0)}
    parts = ["crank", "coupler", "rocker", "ground"]
    balls = [jk.spherical(name, *pair, point=points[name]) for name, pair in zip("BCD", pairwise(parts), strict=True)]
    crank = jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z)
    mechanism = jk.Mechanism.build(joints=[crank, *balls], fixed=["ground"])
    assert in_plane(mechanism) == {"A.phi", "B.psi", "C.psi", "D.psi"}
    motion = jk.inverse(mechanism, {jk.point("coupler", (3, 2, 0)): np.array([[2.9, 2.0, 0.3]])}).motion
    assert np.all(np.asarray(motion.closed)) and np.abs(motion.transforms["rocker"][0, 2, :2]).max() > 0.1
    found = jk.velocities(motion, {"A.phi": 1.0})
    expected = jk.velocities(replace(motion, mechanism=in_space(mechanism)), {"A.phi": 1.0})
    for one, other in zip(found.displacements, expected.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
    # the rocker turns about the point that its ball on the ground holds
    np.testing.assert_allclose(found.points("rocker", points["D"]), 0.0, atol=1e-9)
    np.testing.assert_allclose(motion.sigma_min, replace(motion, mechanism=in_space(mechanism)).sigma_min, rtol=1e-9)


@pytest.mark.long
def test_frames_that_are_turned_in_a_joint_leave_the_plane():
    """The rod is turned in its tube against its hinge: the cylinder turns back."""
    mechanism = crane()
    frame = mechanism.joints["cylinder"].frames_2[0]
    turn = np.eye(4)
    turn[:3, :3] = rotation(np.array([0.0, 0.0, 1.0]), 0.3)
    turned = mechanism.with_frames({("rod", "cylinder"): frame @ turn})
    assert in_plane(turned) is None
    motion = turned.sweep({"cylinder.z": STROKES})
    assert np.all(np.asarray(motion.closed))
    np.testing.assert_allclose(np.abs(motion.coordinates["cylinder"][:, 1]), 0.3, atol=1e-12)


@pytest.mark.long
def test_all_assembly_modes_are_found_with_an_idle_rod():
    """The boom on either side of the line from its hinge to the foot; the cross may be turned over as well."""
    modes = jk.assembly_modes(rod_on_ball_and_cross(height=1.0), {"cylinder.z": 0.3})
    length, boom = np.sqrt(17.0) + 0.3, np.arctan2(-4, 3)
    opening = np.arccos((16 + 25 - length**2) / 40)
    angles = {round(float(angle), 6) for angle in modes.motion.coordinates["boom"][:, 0]}
    assert angles == {round(boom + sign * opening, 6) for sign in (1, -1)}
    assert not modes.complete


@pytest.mark.long
def test_the_transmission_angle_is_that_in_the_plane_at_any_height():
    one, other = (jk.transmission(crane(height).sweep({"cylinder.z": STROKES}), "boom").angle for height in (0.0, 2.5))
    np.testing.assert_allclose(one, other, atol=1e-9)


@pytest.mark.long
def test_gradients_are_those_in_space():
    mechanism = crane()

    def squares(mechanism):
        return jnp.sum(mechanism.sweep({"cylinder.z": STROKES}).coordinates["boom"] ** 2)

    one, other = (jax.grad(squares)(each).linkage.joints for each in (mechanism, in_space(mechanism)))
    for a, b in zip(one, other, strict=True):
        for side in ("frames_1", "frames_2"):
            np.testing.assert_allclose(getattr(a, side), getattr(b, side), rtol=1e-9, atol=1e-9)
    assert np.abs(np.asarray(one[1].frames_1)[:, :2, 3]).max() > 0.1
