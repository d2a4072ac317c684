"""Constant velocity joints: shafts turn alike at any angle, as they do not behind a universal joint."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.joints.kinds import JointKind
from jaxkin.view.sticks import stick_parts
from reference import spatial
from reference.mechanisms import cardan_shafts

Z = (0.0, 0.0, 1.0)
TURN = np.linspace(0.0, 2 * np.pi, 25)


def shafts(angle):
    """Two shafts that meet at the origin at an angle, assembled so."""
    other = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("in", "ground", "shaft", point=(0, 0, -80), axis=Z),
            jk.constant_velocity("cv", "shaft", "output", point=(0, 0, 0), axis=Z, axis2=other),
            jk.revolute("out", "ground", "output", point=80 * other, axis=other),
        ],
    )


def swivel():
    """Two shafts assembled in line; the bearing of the second one tilts about y through their joint."""
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("in", "ground", "shaft", point=(0, 0, -80), axis=Z),
            jk.constant_velocity("cv", "shaft", "output", point=(0, 0, 0), axis=Z),
            jk.revolute("out", "carrier", "output", point=(0, 0, 80), axis=Z),
            jk.revolute("tilt", "ground", "carrier", point=(0, 0, 0), axis=(0, 1, 0)),
        ],
        unit="mm",
    )


def half_shaft():
    """A driveshaft: two joints and a slide between skew shafts."""
    one, other = np.array([0.0, 0.0, -30.0]), np.array([40.0, 25.0, 120.0])
    along = other - one
    far = np.array([0.3, -0.2, 1.0])
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("in", "ground", "gearbox", point=(0, 0, -80), axis=Z),
            jk.constant_velocity("inner", "gearbox", "tube", point=one, axis=Z, axis2=along),
            jk.prismatic("plunge", "tube", "rod", axis=along),
            jk.constant_velocity("outer", "rod", "hub", point=other, axis=along, axis2=far),
            jk.revolute("out", "ground", "hub", point=other + 50 * far, axis=far),
        ],
        unit="mm",
    )


def bend(turned, tilted):
    """theta and phi of the joint of `swivel`: it bends by `tilted` about (sin, cos) of `turned` in its own plane."""
    theta = jnp.arctan2(jnp.sin(tilted / 2) * jnp.sin(turned), jnp.cos(tilted / 2))
    return jnp.stack([theta, 2 * jnp.arcsin(jnp.sin(tilted / 2) * jnp.cos(turned))], axis=-1)


@pytest.mark.parametrize("angle", [0.5, pytest.param(1.4, marks=pytest.mark.long)])
def test_both_shafts_turn_alike(angle):
    mechanism = shafts(angle)
    motion = mechanism.sweep({"in": TURN}, throw=True)
    # rounding of a loop of three joints over a full turn
    np.testing.assert_allclose(motion.coordinates["out"][:, 0], TURN, atol=1e-13)
    found = mechanism.mobility()
    assert (found.freedoms, found.idle_freedoms) == (1, 0)
    assert "VR" in str(mechanism.plan(["in"]))


@pytest.mark.long
def test_a_universal_joint_does_not():
    motion = cardan_shafts(0.5).sweep({"in": TURN}, throw=True)
    out = np.asarray(motion.coordinates["out"])[:, 0]
    np.testing.assert_allclose(np.exp(1j * out), np.exp(1j * spatial.cardan(TURN, 0.5)), atol=1e-13)
    # it lags by up to arcsin(tan^2 (shafts / 2)), 3.7 degrees here; every 15 degrees comes near the largest
    assert np.abs(out - TURN).max() == pytest.approx(np.arcsin(np.tan(0.25) ** 2), rel=0.02)


@pytest.mark.long
def test_an_angle_that_changes_while_it_turns():
    mechanism = swivel()
    assert mechanism.mobility().freedoms == 2
    tilted = 1.2 * np.sin(TURN / 2)
    motion = mechanism.sweep({"in": 2 * TURN, "tilt": tilted}, throw=True)
    np.testing.assert_allclose(motion.coordinates["out"][:, 0], 2 * TURN, atol=1e-13)
    np.testing.assert_allclose(motion.coordinates["cv"], bend(2 * TURN, tilted), atol=1e-13)
    relative = np.linalg.inv(motion.transforms["shaft"]) @ motion.transforms["output"]
    vectors = Rotation.from_matrix(relative[:, :3, :3]).as_rotvec()
    np.testing.assert_allclose(vectors[:, 2], 0.0, atol=1e-14)  # it bends and does not twist


@pytest.mark.long
def test_rates_are_the_derivatives_of_the_closed_form():
    mechanism = swivel()
    turned, tilted = np.array([0.4, 2.0]), np.array([0.3, 0.7])
    motion = mechanism.sweep({"in": turned, "tilt": tilted}, throw=True)
    rates = jk.velocities(motion, {"in": 1.0, "tilt": -0.5})
    _, wanted = jax.jvp(bend, (turned, tilted), (np.ones(2), np.full(2, -0.5)))
    np.testing.assert_allclose(rates.coordinates["cv"], wanted, atol=1e-12)
    np.testing.assert_allclose(rates.coordinates["out"][:, 0], 1.0, atol=1e-12)


@pytest.mark.long
def test_derivative_with_respect_to_the_angle_of_the_shafts():
    def turned(angle):
        other = jnp.stack([jnp.sin(angle), 0.0, jnp.cos(angle)])
        shaft = jk.revolute("in", "ground", "shaft", point=(0, 0, -80), axis=Z)
        cross = jk.constant_velocity("cv", "shaft", "output", point=(0, 0, 0), axis=Z, axis2=other)
        out = jk.revolute("out", "ground", "output", point=80 * other, axis=other)
        motion = jk.Mechanism.build(fixed=["ground"], joints=[shaft, cross, out]).sweep({"in": jnp.array([1.0])})
        return jnp.stack([motion.coordinates["out"][0, 0], motion.transforms["output"][0, 0, 2]])

    found = jax.jacfwd(turned)(0.5)
    step = 1e-5
    wanted = (turned(0.5 + step) - turned(0.5 - step)) / (2 * step)
    np.testing.assert_allclose(found, wanted, atol=1e-9)  # central differences: step^2, and rounding over the step
    assert abs(float(found[0])) < 1e-12  # whatever the angle, it turns alike


@pytest.mark.long
def test_shafts_turn_alike_at_an_angle_that_was_changed():
    mechanism = shafts(0.5)
    assert not any("cv" in key and key[-1] == "angle" for key in mechanism.lengths)
    key = ("ground", "in", "out", "angle")
    assert mechanism.lengths[key] == pytest.approx(0.5, abs=1e-14)
    longer = mechanism.with_lengths({key: 0.9})
    motion = longer.sweep({"in": TURN}, throw=True)
    out = np.asarray(motion.coordinates["out"])[:, 0]
    np.testing.assert_allclose(out - out[0], TURN, atol=1e-12)


@pytest.mark.long
def test_a_driveshaft_between_skew_shafts():
    mechanism = half_shaft()
    motion = mechanism.sweep({"in": TURN}, throw=True)
    np.testing.assert_allclose(motion.coordinates["out"][:, 0], TURN, atol=1e-12)
    np.testing.assert_allclose(motion.coordinates["plunge"][:, 0], 0.0, atol=1e-10)  # its ends stay in place
    found = mechanism.mobility()
    assert (found.freedoms, found.redundant) == (1, 0)


@pytest.mark.long
def test_it_is_written_drawn_and_read_back(tmp_path):
    given = half_shaft()
    expected = given.sweep({"in": [0.0, 0.8]}, throw=True).transforms["rod"]
    jk.write_study(given, tmp_path / "study.toml")
    given.save(tmp_path / "m.json")
    for back in (jk.load_study(tmp_path / "study.toml").mechanism, jk.load(tmp_path / "m.json").mechanism()):
        assert back.joints["outer"].kind is JointKind.CONSTANT_VELOCITY
        np.testing.assert_allclose(back.sweep({"in": [0.0, 0.8]}, throw=True).transforms["rod"], expected, atol=1e-11)
    assert {part.name for part in stick_parts(given)} == set(given.parts)
    assert "constant velocity" in str(given)


@pytest.mark.long
def test_a_model_of_mujoco_turns_twice_by_one_coordinate(tmp_path):
    back = jk.load(jk.write_mjcf(shafts(0.5), tmp_path / "model.xml")).mechanism()
    assert back.mobility().freedoms == 1
    motion = back.sweep({"in": TURN[:9]}, throw=True)
    expected = shafts(0.5).sweep({"in": TURN[:9]}, throw=True)
    np.testing.assert_allclose(motion.transforms["output"], expected.transforms["output"], atol=1e-11)


@pytest.mark.long
def test_the_same_from_another_pose():
    given = swivel()
    motion = given.sweep({"in": [0.0, 0.7, 1.9], "tilt": [0.0, 0.5, 0.8]}, throw=True)
    again = given.at(motion, 1)
    # z of the joint bisects the shafts again: on each of them it leans by a quarter radian
    z = again.joints["cv"].frames_1[0, :3, 2]
    np.testing.assert_allclose(z, [np.sin(0.25), 0.0, np.cos(0.25)], atol=1e-12)
    moved = again.sweep({"in": [1.2], "tilt": [0.3]}, throw=True)
    np.testing.assert_allclose(moved.coordinates["out"][0], 1.2, atol=1e-12)
    relative = motion.transforms["output"][2] @ np.linalg.inv(motion.transforms["output"][1])
    np.testing.assert_allclose(moved.transforms["output"][0], relative, atol=1e-10)


def test_refused():
    with pytest.raises(ValueError, match="must both point from 'a' to 'b', but they are opposite"):
        jk.constant_velocity("j", "a", "b", point=(0, 0, 0), axis=Z, axis2=(0, 0, -2))
    with pytest.raises(ValueError, match="axis2 must be a direction, got the zero vector"):
        jk.constant_velocity("j", "a", "b", point=(0, 0, 0), axis=Z, axis2=(0, 0, 0))
    joints = list(swivel().all_joints)
    with pytest.raises(ValueError, match=r"'cv' .constant velocity. bends without an axis of its own; couple a joint"):
        jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=[jk.relation({"cv.phi": 1, "tilt": -1})])
